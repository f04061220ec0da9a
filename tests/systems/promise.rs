//! The promise of `solver.tolerance`: the RMS error of the fairlead's tension over the second half of a run, at little more than the least cost.
//!
//! claim: on five public scenes and ten variants of them, whose elements, integrator and step are left open,
//! tolerances of 5, 2, 1 and 0.5 % are kept against a converged solution of 640 elements; on networks, systems in waves, light lines and cables
//! that bend every line keeps 5 and 2 %, most 0.5 % too, against three times the elements.
//! `tests/reference/promise.csv` holds the cost; for an intended change of cost write it again with `cargo test
//! --release --test systems -- --ignored write_the_reference_work` and give the reason.
//!
//! `cargo test --release --features slow-tests --test systems promise -- --nocapture` prints the errors.

use std::path::PathBuf;

use crate::common::*;
use moorline::discretisation::{self, discretised};
use moorline::math::low_pass::low_pass;
use moorline::model::Role;
use moorline::scene::{Integrator, MotionPath, Scene, ToleranceOf};
use moorline::simulation::Simulation;

const TOLERANCES: [f64; 4] = [0.05, 0.02, 0.01, 0.005];
/// Elements of the converged solution, and its steps to the shortest period [-].
const CONVERGED: (usize, f64) = (640, 4000.0);
/// Cut-off of the low-passed tension over the frequency of the fastest motion [-].
const CUT_OFF: f64 = 5.0;
/// Cost that may be more than before, over that [-]: runs that slacken are not the same on every machine.
const DEARER: f64 = 1.3;
/// Cost of an axial-implicit step over that of an explicit one [-].
const AXIAL_IMPLICIT_COST: f64 = 3.0;

/// A scene, by name.
type Case = (&'static str, Scene);

/// Limits of the promise: on a chain that slackens in every period and lies on the seabed for half of its length the RMS
/// error of the raw tension falls as slowly as 1/n, and 400 elements, the most that are chosen, leave more than 0.5
/// %. Listed are scene, tolerance, and the bound that is kept instead; the low-passed tension keeps the tolerance.
const ROUGH: [(&str, f64, f64); 1] = [("shallow", 0.005, 0.009)];

fn public() -> Vec<Case> {
    let names = PUBLIC_SCENES.iter();
    names.map(|(name, _)| (*name, open(shipped(name)))).collect()
}

/// A public scene with its motion's amplitudes and periods multiplied.
fn moved(name: &str, [amplitude, period]: [f64; 2]) -> Scene {
    let mut scene = open(shipped(name));
    for path in scene.motion.values_mut() {
        let MotionPath::Harmonic(motion) = path else {
            panic!("{name} moves by sines");
        };
        let axes = [&mut motion.x, &mut motion.y, &mut motion.z];
        for sine in axes.into_iter().flatten() {
            sine[0] *= amplitude;
            sine[1] *= period;
        }
    }
    scene
}

/// A public scene in another depth [m], with another length of line [m].
fn laid(name: &str, [depth, length]: [f64; 2]) -> Scene {
    let mut scene = open(shipped(name));
    scene.points[0].position[2] = -depth;
    scene.lines[0].sections[0].length = length;
    scene.seabed.as_mut().unwrap().depth = depth;
    scene
}

fn variants() -> Vec<Case> {
    let mut slow = moved("oc3_catenary", [1.0, 5.0]);
    slow.output.duration = 240.0;
    vec![
        ("mild", moved("oc3_catenary", [0.3, 1.0])),
        ("violent", moved("oc3_catenary", [1.8, 1.0])),
        ("slow", slow),
        ("deep", laid("oc3_catenary", [620.0, 1075.0])),
        ("shallow", laid("oc4_chain", [100.0, 815.0])),
        ("snapping", moved("oc4_chain", [1.5, 0.8])),
        ("short", laid("oc4_chain", [200.0, 824.0])),
        ("taut and fast", moved("taut_polyester", [0.5, 0.5])),
        ("taut and far", moved("taut_polyester", [2.0, 1.2])),
        ("tank", moved("lindahl_slow", [0.75, 2.0 / 3.5])),
    ]
}

/// The shortest period of a scene's motion [s].
fn shortest_period(scene: &Scene) -> f64 {
    let paths = scene.motion.values();
    let sines = paths.flat_map(|path| match path {
        MotionPath::Harmonic(motion) => motion.axes().map(|(_, sines)| sines.clone()).concat(),
        _ => Vec::new(),
    });
    sines.map(|sine| sine[1]).fold(f64::INFINITY, f64::min)
}

fn recorded(scene: &Scene) -> (History, Simulation) {
    let mut simulation = following(&discretised(scene));
    let output = &scene.output;
    let count = (output.duration / output.interval).round() as usize;
    let history = History::record(&mut simulation, output.interval, count);
    (history, simulation)
}

fn converged(scene: &Scene) -> History {
    let (elements, steps) = CONVERGED;
    let step = shortest_period(scene) / steps;
    let fine = with_elements(scene.clone(), elements);
    recorded(&with_integrator(fine, Integrator::AxialImplicit, step)).0
}

/// Result of a tolerance.
struct Outcome {
    name: &'static str,
    tolerance: f64,
    /// RMS errors of the raw and of the low-passed tension [-].
    errors: [f64; 2],
    /// Cost in explicit steps of an element to a second [-].
    work: f64,
    words: String,
}

impl Outcome {
    fn new((name, scene): &Case, tolerance: f64, reference: &History) -> Outcome {
        let mut scene = scene.clone();
        scene.solver.tolerance = tolerance;
        let (history, simulation) = recorded(&scene);
        let window = history.tension.len() / 2;
        let cut_off = CUT_OFF / shortest_period(&scene);
        let smooth = |history: &History| History {
            tension: low_pass(&history.tension, scene.output.interval, cut_off),
            ..History::default()
        };
        let choice = simulation.choices().next().unwrap();
        let cost = match choice.integrator {
            Integrator::Leapfrog => 1.0,
            _ => AXIAL_IMPLICIT_COST,
        };
        let elements = simulation.model().lines[0].segment_count();
        Outcome {
            name,
            tolerance,
            errors: [
                history.tension_error(reference, window),
                smooth(&history).tension_error(&smooth(reference), window),
            ],
            work: cost * (history.solves * elements) as f64 / scene.output.duration,
            words: format!("{elements} elements, {}", choice.in_words()),
        }
    }

    /// Promised error of the raw tension [-].
    fn promised(&self) -> f64 {
        let mut rough = ROUGH.iter();
        let found = rough.find(|(name, tolerance, _)| *name == self.name && *tolerance == self.tolerance);
        found.map_or(self.tolerance, |(_, _, kept)| *kept)
    }
}

/// Results of all tolerances on a scene.
fn outcomes(case: &Case) -> Vec<Outcome> {
    let reference = converged(&case.1);
    let outcomes = TOLERANCES.map(|tolerance| Outcome::new(case, tolerance, &reference));
    for outcome in &outcomes {
        let (name, words) = (outcome.name, &outcome.words);
        let [tolerance, raw, smooth] =
            [outcome.tolerance, outcome.errors[0], outcome.errors[1]].map(|e| 100.0 * e);
        print!("{name:15} {tolerance:4.1} %: {raw:5.2} %, low-passed {smooth:5.2} %");
        println!(", work {:8.0}/s: {words}", outcome.work);
    }
    outcomes.into()
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference/promise.csv")
}

/// Work of before.
fn known(outcome: &Outcome) -> f64 {
    let text = std::fs::read_to_string(path()).unwrap();
    let start = format!("{},{},", outcome.name, outcome.tolerance);
    let line = text.lines().find_map(|line| line.strip_prefix(&start));
    line.unwrap().parse().unwrap()
}

fn keep(cases: &[Case]) {
    for outcome in cases.iter().flat_map(outcomes) {
        let (name, tolerance) = (outcome.name, outcome.tolerance);
        let [raw, smooth] = outcome.errors;
        assert!(raw <= outcome.promised(), "{name}, {tolerance}: {raw}");
        assert!(smooth <= tolerance, "{name}, {tolerance}: {smooth} low-passed");
        let (known, work) = (known(&outcome), outcome.work);
        assert!(
            work <= DEARER * known,
            "{name}, {tolerance}: {work}/s, {known}/s before"
        );
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_stated_error_is_kept_on_the_public_scenes() {
    keep(&public());
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_stated_error_is_kept_on_variants_in_depth_length_period_and_amplitude() {
    keep(&variants());
}

/// Two floats 300 m apart, each on a line to an anchor, with a shared line between them that carries a buoy in its middle.
fn farm() -> Scene {
    let mut farm = draft(
        "water.density = 1025.0
        seabed.depth = 120.0
        line_types.rope = { mass = 23.0, diameter = 0.16, axial_stiffness = 4.0e7, axial_damping = 1.0e5, drag_normal = 1.3,
          added_mass_normal = 1.0 }
        line_types.chain = { mass = 90.0, diameter = 0.12, axial_stiffness = 3.5e8, axial_damping = 1.0e6, drag_normal = 1.3,
          added_mass_normal = 1.0 }
        motion.float1 = { x = [[1.0, 11.0]], z = [[1.0, 9.0]], ramp = 11.0 }
        motion.float2 = { x = [[0.6, 11.0, 1.0]], z = [[0.8, 9.0, 2.0]], ramp = 11.0 }
        output = { duration = 66.0, interval = 0.05 }",
    );
    for (anchor, float, side) in [("anchor1", "float1", -1.0), ("anchor2", "float2", 1.0)] {
        farm = farm
            .fixed(anchor, [500.0 * side, 0.0, -120.0])
            .coupled(float, [150.0 * side, 0.0, -10.0]);
    }
    farm.free("buoy", [0.0, 0.0, -40.0])
        .with("mass = 1000.0, volume = 2.0, drag_area = 3.0, added_mass = 0.5")
        .line("leg1", ["anchor1", "float1"], "chain", 385.0, None)
        .line("leg2", ["anchor2", "float2"], "chain", 385.0, None)
        .line("shared1", ["float1", "buoy"], "rope", 156.0, None)
        .line("shared2", ["buoy", "float2"], "rope", 156.0, None)
        .scene()
}

/// One line of every cluster of the semi-submersible in the sea of a storm.
fn clusters() -> Scene {
    let mut scene = shipped("storm_moored_semi");
    scene
        .lines
        .retain(|line| ["line1", "line5", "line9"].contains(&&line.name[..]));
    let ends = scene
        .lines
        .iter()
        .flat_map(|line| [line.from.clone(), line.to.clone()]);
    let ends: Vec<String> = ends.collect();
    scene.points.retain(|point| ends.contains(&point.name));
    scene.output.duration = 160.0;
    scene
}

/// A cable that hangs from a float to the seabed.
fn umbilical() -> Scene {
    draft(
        "water.density = 1025.0
        seabed = { depth = 120.0, stiffness = 1.0e6, damping = 1.0e5 }
        line_types.umbilical = { mass = 60.0, diameter = 0.2, axial_stiffness = 5.0e8, bending_stiffness = 2.0e4, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        motion.float = { x = [[2.0, 11.0]], z = [[1.5, 9.0]], ramp = 15.0 }
        output = { duration = 103.0, interval = 0.05 }",
    )
    .fixed("seabed_end", [190.0, 0.0, -120.0])
    .coupled("float", [0.0, 0.0, -12.0])
    .line("umbilical", ["seabed_end", "float"], "umbilical", 250.0, None)
    .scene()
}

/// The same, clamped to the float.
fn clamped_umbilical() -> Scene {
    let mut scene = umbilical();
    scene.lines[0].clamped_b = Some([-0.1, 0.0, 1.0]);
    scene
}

/// A lazy wave in a tank, at a scale of 1:40, whose motion is fast compared with the longest step that is allowed.
fn tank_cable() -> Scene {
    draft(
        "water.density = 1000.0
        seabed = { depth = 2.5, stiffness = 6.0e4, damping = 600.0 }
        line_types.cable = { mass = 0.025, diameter = 0.00375, axial_stiffness = 6250.0, bending_stiffness = 1.0e-4, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        line_types.buoyant = { mass = 0.0388, diameter = 0.008, axial_stiffness = 6250.0, bending_stiffness = 1.0e-4, drag_normal = 1.2,
          drag_tangential = 0.2, added_mass_normal = 1.0 }
        motion.float = { x = [[0.05, 1.9]], z = [[0.0375, 1.42]], ramp = 3.0 }
        output = { duration = 18.0, interval = 0.05 }",
    )
    .fixed("seabed_end", [4.5, 0.0, -2.5])
    .coupled("float", [0.0, 0.0, -0.375])
    .sections(
        "cable",
        ["seabed_end", "float"],
        &[("cable", 2.5, None), ("buoyant", 1.25, None), ("cable", 2.25, None)],
    )
    .scene()
}

/// A cable with buoyancy in its middle between two floats.
fn cable_between_floats() -> Scene {
    draft(
        "water.density = 1025.0
        line_types.cable = { mass = 40.0, diameter = 0.15, axial_stiffness = 4.0e8, bending_stiffness = 1.0e4, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        line_types.buoyant = { mass = 62.0, diameter = 0.32, axial_stiffness = 4.0e8, bending_stiffness = 1.0e4, drag_normal = 1.2,
          drag_tangential = 0.2, added_mass_normal = 1.0 }
        motion.float1 = { x = [[1.5, 11.0]], z = [[1.0, 9.0]], ramp = 15.0 }
        motion.float2 = { x = [[1.2, 11.0, 1.0]], z = [[1.0, 9.0, 2.0]], ramp = 15.0 }
        output = { duration = 103.0, interval = 0.05 }",
    )
    .coupled("float1", [-150.0, 0.0, -15.0])
    .coupled("float2", [150.0, 0.0, -15.0])
    .sections(
        "cable",
        ["float1", "float2"],
        &[("cable", 140.0, None), ("buoyant", 60.0, None), ("cable", 140.0, None)],
    )
    .scene()
}

/// A taut rope of polyester between two short lengths of chain.
fn deep_polyester() -> Scene {
    draft(
        "water.density = 1025.0
        seabed = { depth = 2000.0, stiffness = 3.0e6, damping = 3.0e5 }
        line_types.chain = { mass = 113.35, diameter = 0.0766, axial_stiffness = 7.5e8, axial_damping = 2.0e6, drag_normal = 2.0,
          drag_tangential = 0.4, added_mass_normal = 0.8, added_mass_tangential = 0.25 }
        line_types.polyester = { mass = 38.0, diameter = 0.22, axial_stiffness = 2.0e8, damping_ratio = 0.05, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        motion.fairlead = { x = [[4.0, 14.0]], z = [[2.0, 10.0]], ramp = 20.0 }
        output = { duration = 132.0, interval = 0.05 }",
    )
    .fixed("anchor", [1800.0, 0.0, -2000.0])
    .coupled("fairlead", [0.0, 0.0, -15.0])
    .sections(
        "leg",
        ["anchor", "fairlead"],
        &[("chain", 150.0, None), ("polyester", 2400.0, None), ("chain", 100.0, None)],
    )
    .scene()
}

/// Tensions of every line at the end that moves, over the second half of a run [N].
fn tensions(scene: &Scene) -> Vec<Vec<f64>> {
    let mut simulation = following(&discretised(scene));
    let model = simulation.model();
    let moves = |point: usize| {
        let role = &model.points[point].role;
        matches!(role, Role::Coupled { .. } | Role::Carried { .. })
    };
    let lines = model.lines.iter();
    let at_a: Vec<bool> = lines
        .map(|line| moves(line.ends[0]) && !moves(line.ends[1]))
        .collect();
    let mut tensions = vec![Vec::new(); at_a.len()];
    let count = (scene.output.duration / scene.output.interval).round() as usize;
    for sample in 0..count {
        simulation.advance(scene.output.interval).unwrap();
        for (line, &at_a) in at_a.iter().enumerate().filter(|_| 2 * sample >= count) {
            let ends = [simulation.tension_b(line), simulation.tension_a(line)];
            tensions[line].push(ends[usize::from(at_a)]);
        }
    }
    tensions
}

/// A scene at a tolerance as it is run, and with three times the elements, in steps of a third; with the elements of the first.
fn coarse_and_fine(scene: &Scene, tolerance: f64) -> ([Scene; 2], Vec<usize>) {
    let mut chosen = scene.clone();
    chosen.solver.tolerance = tolerance;
    let settled = discretisation::select(&chosen).unwrap();
    let elements = settled.meshes.iter().map(|mesh| mesh.elements).collect();
    let mut fine = settled.scene.clone();
    fine.solver = chosen.solver.clone();
    fine.solver.tolerance = 0.1 * tolerance;
    fine.solver.time_step_max = settled.scene.solver.time_step_max / 3.0;
    fine.solver.elements = settled.scene.solver.elements.map(|elements| 3 * elements);
    for line in &mut fine.lines {
        line.elements = line.elements.map(|elements| 3 * elements);
    }
    ([settled.scene, fine], elements)
}

/// RMS error of the tension of every line over its standard deviation [-], at a tolerance.
fn errors_of_lines(name: &str, scene: &Scene, tolerance: f64) -> Vec<f64> {
    let (scenes, elements) = coarse_and_fine(scene, tolerance);
    let [found, exact] = scenes.map(|scene| tensions(&scene));
    let errors = errors_between(&found, &exact);
    println!("{name}, {tolerance}: {elements:?} elements, {errors:.4?}");
    errors
}

/// Greatest curvature of the first line in the second half of a run [1/m].
fn greatest_curvature(scene: &Scene) -> f64 {
    let (mut simulation, output) = (following(scene), &scene.output);
    simulation.advance(0.5 * output.duration).unwrap();
    let curvatures = (0..(0.5 * output.duration / output.interval) as usize).map(|_| {
        simulation.advance(output.interval).unwrap();
        let nodes = simulation.bending(0).unwrap().iter();
        nodes.map(|node| node.curvature).fold(0.0, f64::max)
    });
    curvatures.fold(0.0, f64::max)
}

/// RMS error of every tension over the standard deviation of the right one [-].
fn errors_between(found: &[Vec<f64>], exact: &[Vec<f64>]) -> Vec<f64> {
    let lines = found.iter().zip(exact);
    let errors = lines.map(|(own, right)| {
        let mean = right.iter().sum::<f64>() / right.len() as f64;
        let square = |values: f64, x: f64| values + x * x;
        let wrong = own.iter().zip(right).map(|(a, b)| a - b).fold(0.0, square);
        (wrong / right.iter().map(|b| b - mean).fold(0.0, square)).sqrt()
    });
    errors.collect()
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn every_line_of_a_system_keeps_the_stated_error_in_waves_and_with_free_points() {
    let (farm, clusters) = (farm(), clusters());
    for (name, scene, tolerance) in [
        ("farm", &farm, 0.05),
        ("semi-submersible", &clusters, 0.05),
        ("semi-submersible", &clusters, 0.02),
    ] {
        let errors = errors_of_lines(name, scene, tolerance);
        assert!(
            errors.iter().all(|error| *error <= tolerance),
            "{name}, {tolerance}: {errors:?}"
        );
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn cables_that_bend_keep_the_stated_error() {
    for (name, scene) in [
        ("umbilical", umbilical()),
        ("tank cable", tank_cable()),
        ("cable between floats", cable_between_floats()),
        ("clamped umbilical", clamped_umbilical()),
        ("power_cable", open(shipped("power_cable"))),
    ] {
        for tolerance in [0.05, 0.02, 0.005] {
            let errors = errors_of_lines(name, &scene, tolerance);
            assert!(errors[0] <= tolerance, "{name}, {tolerance}: {errors:?}");
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_greatest_curvature_at_a_clamp_keeps_the_stated_error() {
    for (name, scene) in [
        ("clamped umbilical", clamped_umbilical()),
        ("power_cable", open(shipped("power_cable"))),
    ] {
        for tolerance in [0.05, 0.02, 0.005] {
            let (scenes, _) = coarse_and_fine(&scene, tolerance);
            let [found, exact] = scenes.map(|scene| greatest_curvature(&scene));
            let error = found / exact - 1.0;
            println!("{name}, {tolerance}: {found:.4} 1/m, {error:+.4}");
            assert!(error.abs() <= tolerance, "{name}, {tolerance}: {error}");
        }
    }
}

/// A shipped scene in waves, its elements left open.
fn in_waves(name: &str, waves: &str) -> Scene {
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut scene = open(Scene::from_toml(&format!("{text}\n[water.waves]\n{waves}")).unwrap());
    scene.output.duration = 110.0;
    scene
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn light_lines_and_networks_keep_the_stated_error_with_and_without_waves() {
    let jonswap = |height: f64, period: f64| {
        format!("spectrum = 'jonswap'\nsignificant_height = {height}\npeak_period = {period}\nramp = 20.0")
    };
    let regular = "regular = { height = 5.0, period = 9.0 }\nramp = 15.0";
    for (name, scene) in [
        ("lazy_wave", open(shipped("lazy_wave"))),
        ("hanging_riser", open(shipped("hanging_riser"))),
        ("bridle", open(shipped("bridle"))),
        ("clump_weight", open(shipped("clump_weight"))),
        ("lazy_wave in waves", in_waves("lazy_wave", regular)),
        ("oc4_chain in waves", in_waves("oc4_chain", &jonswap(6.0, 10.0))),
        ("bridle in waves", in_waves("bridle", &jonswap(4.0, 9.0))),
    ] {
        for tolerance in [0.05, 0.02] {
            let errors = errors_of_lines(name, &scene, tolerance);
            assert!(
                errors.iter().all(|error| *error <= tolerance),
                "{name}, {tolerance}: {errors:?}"
            );
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn short_sections_keep_the_stated_error() {
    let scene = deep_polyester();
    let mut fine = scene.clone();
    fine.solver.tolerance = 5e-4;
    for (section, elements) in fine.lines[0].sections.iter_mut().zip([12, 60, 12]) {
        section.elements = Some(elements);
    }
    let exact = tensions(&fine);
    for tolerance in [0.02, 0.005] {
        let mut chosen = scene.clone();
        chosen.solver.tolerance = tolerance;
        let found = discretised(&chosen);
        let elements = found.lines[0].sections.iter().map(|section| section.elements);
        let errors = errors_between(&tensions(&chosen), &exact);
        println!(
            "{tolerance}: {:?} elements, {errors:.4?}",
            elements.collect::<Vec<_>>()
        );
        assert!(errors[0] <= tolerance, "{tolerance}: {errors:?}");
    }
    let words = |tolerance: f64| {
        let mut chosen = scene.clone();
        chosen.solver.tolerance = tolerance;
        let found = discretisation::select(&chosen).unwrap();
        [found.in_words(), found.shortfalls()].map(|words| words.join("\n"))
    };
    let [said, short] = words(0.005);
    assert_says(
        &said,
        &["2 elements in sections that are one element on coarse and fine meshes alike"],
    );
    assert_eq!(short, "");
    let [_, short] = words(2e-5);
    assert_says(&short, &["more than solver.tolerance"]);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_mesh_of_which_no_trial_could_be_run_is_told() {
    let mut scene = deep_polyester();
    scene.lines[0].sections[1].length = 2498.0;
    scene.lines[0].sections[2].length = 0.02; // axial waves cross it in a fraction of a millisecond
    scene.line_types.get_mut("polyester").unwrap().damping_ratio = None;
    scene.solver.tolerance = 0.002;
    let found = discretisation::select(&scene).unwrap();
    assert_says(
        &found.in_words().join("\n"),
        &["no trial of this mesh could be run"],
    );
    assert_says(
        &found.shortfalls().join("\n"),
        &["leg: the error with this mesh is unknown"],
    );
}

#[test]
#[ignore = "writes tests/reference/promise.csv"]
fn write_the_reference_work() {
    let mut text = format!(
        "# moorline {}: cargo test --release --test systems -- --ignored write_the_reference_work\n\
         # explicit steps of an element to a simulated second, an axial-implicit one counting {AXIAL_IMPLICIT_COST}\nscene,tolerance,work\n",
        env!("CARGO_PKG_VERSION"),
    );
    for outcome in public().iter().chain(&variants()).flat_map(outcomes) {
        text += &format!("{},{},{:.0}\n", outcome.name, outcome.tolerance, outcome.work);
    }
    std::fs::write(path(), text).unwrap();
}

#[test]
fn a_packaged_scene_keeps_its_mesh_whatever_is_set_later() {
    let scene = moved("taut_polyester", [1.0, 1.0]);
    let mut frozen = discretisation::frozen(&scene).unwrap();
    let count = |scene: &Scene| Simulation::new(scene).unwrap().model().lines[0].segment_count();
    let before = count(&frozen);
    assert_eq!(count(&discretised(&scene)), before);
    frozen.solver.tolerance = 0.002;
    frozen.lines[0].sections[0].length *= 1.01;
    assert_eq!(count(&frozen), before);
    let mut still = scene;
    still.motion.clear();
    let mut frozen = discretisation::frozen(&still).unwrap();
    frozen.solver.tolerance = 0.002;
    assert_eq!(count(&frozen), 40);
    assert_eq!(discretisation::frozen(&shipped("oc3_catenary")), None);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_line_that_hardly_moves_takes_hardly_more_elements_than_one_that_does() {
    let elements = |amplitude: f64| {
        let settled = discretisation::select(&moved("oc3_catenary", [amplitude, 1.0])).unwrap();
        println!("{amplitude}: {:?}", settled.meshes[0].trials);
        settled.meshes[0].elements
    };
    let [little, less, still] = [0.1, 1e-3, 1e-6].map(elements);
    assert!(
        less as f64 <= 1.2 * little as f64 && still <= less,
        "{little}, {less}, {still}"
    );
}

/// Copies of a scene's only line along the seabed, all moved alike, and one that is longer by a metre.
fn field(name: &str, copies: usize) -> Scene {
    let mut scene = moved(name, [1.0, 1.0]);
    let (line, [from, to]) = (
        scene.lines[0].clone(),
        [0, 1].map(|end| scene.points[end].clone()),
    );
    let motion = scene.motion[&to.name].clone();
    for copy in 1..=copies {
        let along = [700.0 * copy as f64, -300.0 * copy as f64];
        let named = |name: &str| format!("{name}_{copy}");
        for point in [&from, &to] {
            let [x, y, z] = point.position;
            let mut point = point.clone();
            point.position = [x + along[0], y + along[1], z];
            point.name = named(&point.name);
            scene.points.push(point);
        }
        let mut line = line.clone();
        line.name = named(&line.name);
        (line.from, line.to) = (named(&line.from), named(&line.to));
        line.sections[0].length += if copy == copies { 1.0 } else { 0.0 };
        scene.lines.push(line);
        scene.motion.insert(named(&to.name), motion.clone());
    }
    scene
}

#[test]
fn of_lines_that_are_copies_one_is_tried() {
    let alone = discretisation::select(&moved("taut_polyester", [1.0, 1.0])).unwrap();
    let field = field("taut_polyester", 4);
    let selected = discretisation::select(&field).unwrap();
    assert_eq!(selected.meshes.len(), field.lines.len());
    let [one, copy, .., longer] = &selected.meshes[..] else {
        panic!("{:?}", selected.meshes);
    };
    assert_eq!(
        (&one.trials, one.elements),
        (&alone.meshes[0].trials, alone.meshes[0].elements)
    );
    assert_eq!((&copy.trials, copy.elements), (&one.trials, one.elements));
    assert_ne!(longer.trials, one.trials);
}

/// RMS error of the position of the middle of a scene's line on the mesh selected, over its deviation from its mean [-].
fn error_of_middle(scene: &Scene) -> f64 {
    let middle = |scene: &Scene| {
        let mut simulation = following(scene);
        let count = (scene.output.duration / scene.output.interval).round() as usize;
        let mut places: Vec<[f64; 3]> = Vec::new();
        for _ in 0..count {
            simulation.advance(scene.output.interval).unwrap();
            let nodes = simulation.profile(0);
            let middle = nodes[nodes.len() / 2];
            places.push([middle.x, middle.y, middle.z]);
        }
        places.split_off(count / 2)
    };
    let mut selected = discretised(scene).into_owned();
    selected.solver.elements = selected.solver.elements.map(|elements| elements + elements % 2);
    let mut fine = scene.clone();
    fine.solver.elements = Some(4 * selected.solver.elements.unwrap());
    fine.solver.tolerance = 1e-3;
    let (own, right) = (middle(&selected), middle(&fine));
    let count = right.len() as f64;
    let mean = [0, 1, 2].map(|axis| right.iter().map(|place| place[axis]).sum::<f64>() / count);
    let square = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>();
    let wrong: f64 = own.iter().zip(&right).map(|(a, b)| square(a, b)).sum();
    let scale: f64 = right.iter().map(|place| square(place, &mean)).sum();
    (wrong / scale).sqrt()
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_error_of_positions_is_kept_where_the_tolerance_is_of_position() {
    for name in ["oc3_catenary", "taut_polyester"] {
        let mut scene = moved(name, [1.0, 1.0]);
        scene.solver.tolerance_of = ToleranceOf::Position;
        let error = error_of_middle(&scene);
        println!("{name}: {error:.4}");
        assert!(error <= scene.solver.tolerance, "{name}: {error}");
    }
}

#[test]
fn the_trials_are_described_in_words() {
    let selected = discretisation::select(&moved("taut_polyester", [1.0, 1.0])).unwrap();
    let words = selected.in_words();
    assert!(
        words[0].starts_with("5 elements a line alone for the target error of 2 %"),
        "{words:?}"
    );
}

/// RMS difference of tension, and of the middle's position, of runs with twice the elements each time.
fn refined(name: &str, elements: &[usize]) -> Vec<[f64; 2]> {
    let scene = shipped(name);
    let step = shortest_period(&scene) / CONVERGED.1;
    let fine = |n: &usize| {
        let fine = with_elements(scene.clone(), *n);
        recorded(&with_integrator(fine, Integrator::AxialImplicit, step)).0
    };
    let runs: Vec<History> = elements.iter().map(fine).collect();
    let window = runs[0].tension.len() / 2;
    let errors = |coarse: &History, fine: &History| {
        [
            coarse.tension_error(fine, window),
            coarse.middle_error(fine, window),
        ]
    };
    let found: Vec<[f64; 2]> = runs.windows(2).map(|pair| errors(&pair[0], &pair[1])).collect();
    println!("{name}, {elements:?}: {found:?}");
    found
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn successive_refinement_converges_under_the_default_law() {
    for name in ["oc3_catenary", "oc4_chain"] {
        let found = refined(name, &[160, 320, 640, 1280]);
        assert!(
            found.is_sorted_by(|a, b| a[0] > b[0] && a[1] > b[1]),
            "{name}: {found:?}"
        );
        let [tension, position] = found[2];
        assert!(tension < 2e-3 && position < 1e-3, "{name}: {tension} {position}");
        assert!(found[1][1] < 1e-3, "{name}: {found:?}");
    }
}
