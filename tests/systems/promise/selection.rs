//! Selection of meshes by convergence trials: short sections, meshes that cannot be tried, copies of a line, packaged scenes, positions.

use super::scenes::{crowfoot, deep_polyester, moved};
use super::{CONVERGED, errors_between, recorded, settled, tensions};
use crate::common::*;
use moorline::discretisation::{self, Discretisation, discretised};
use moorline::scene::{Integrator, Scene, ToleranceOf};
use moorline::simulation::Simulation;

/// Notes on errors above the tolerance, one per line.
fn shortfalls(found: &Discretisation) -> String {
    let notes = found.shortfalls().into_iter().map(|note| note.text);
    notes.collect::<Vec<_>>().join("\n")
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
        [found.in_words().join("\n"), shortfalls(&found)]
    };
    let [said, short] = words(0.005);
    assert_says(
        &said,
        &["2 elements in short sections, which have one element on all meshes that were tried"],
    );
    assert_eq!(short, "");
    let [_, short] = words(2e-5);
    assert_says(&short, &["above solver.tolerance"]);
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
        &["the error of this mesh is unknown, since no trial could be run"],
    );
    assert_says(&shortfalls(&found), &["leg: the error of this mesh is unknown"]);
}

/// The tension of lines that slacken jumps. If a jump is shifted by the travel time through one element, the RMS error decreases only as n^-1/2.
#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_error_of_an_extrapolated_mesh_is_told_as_it_is_where_lines_snap() {
    let found = settled(&crowfoot([254.0, 197.0]), 0.02);
    let mesh = &found.meshes[0];
    println!("{:?}", mesh);
    assert!(!mesh.tried);
    assert!(mesh.error > 0.025, "{}, 0.029 against 1200 elements", mesh.error);
    assert_says(&shortfalls(&found), &["above solver.tolerance = 0.02"]);
}

/// A rope that snaps taut needs more elements than trials may take. The steps that the rule chooses for that mesh are off by 2.35 %.
#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_steps_of_an_extrapolated_mesh_keep_the_tolerance() {
    let scene = draft(
        "water.density = 1025.0
        seabed = { depth = 80.0, stiffness = 3e5, damping = 3e4 }
        line_types.rope = { mass = 20.0, diameter = 0.14, axial_stiffness = 1e6, axial_damping = 3e3, drag_normal = 1.2,
          drag_tangential = 0.05, added_mass_normal = 1.0 }
        motion.fairlead = { x = [[1.24, 5.14]], z = [[0.87, 5.14, 0.9]], ramp = 10.3 }
        output = { duration = 51.4, interval = 0.05 }",
    )
    .fixed("anchor", [0.0, 0.0, -80.0])
    .coupled("fairlead", [155.39, 0.0, -10.0])
    .line("line", ["anchor", "fairlead"], "rope", 174.442, None)
    .scene();
    let found = settled(&scene, 0.02);
    assert!(
        !found.meshes[0].tried && found.meshes[0].error < 0.02,
        "{:?}",
        found.meshes
    );
    assert_eq!(found.scene.solver.integrator, Integrator::AxialImplicit);
    assert!(!found.untried_steps);
    let explicit = with_integrator(found.scene.clone(), Integrator::Leapfrog, 0.05);
    let errors = errors_between(&tensions(&found.scene), &tensions(&explicit));
    println!("{errors:.4?}");
    assert!(errors[0] <= 0.015, "{errors:?}");
}

/// Meshes of 40 elements and less carry no waves across this line at 0.3 s: they agree with one another, and are off by 18 %.
#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn meshes_and_steps_carry_the_shortest_waves_of_the_motion() {
    let scene = draft(
        "water.density = 1025.0
        seabed.depth = 100.0
        line_types.rope = { mass = 40.0, diameter = 0.05, axial_stiffness = 2e7, axial_damping = 2e4, drag_normal = 1.2, added_mass_normal = 1.0 }
        motion.fairlead = { x = [[0.3, 12.0], [0.003, 0.3]], z = [[0.3, 10.0], [0.003, 0.3]], ramp = 10.0 }
        output = { duration = 60.0, interval = 0.02 }",
    )
    .fixed("anchor", [0.0, 0.0, -100.0])
    .coupled("fairlead", [290.0, 0.0, -10.0])
    .line("line", ["anchor", "fairlead"], "rope", 308.0, None)
    .scene();
    let found = settled(&scene, 0.05);
    let exact = with_integrator(with_elements(scene.clone(), 320), Integrator::Leapfrog, 0.05);
    let errors = errors_between(&tensions(&found.scene), &tensions(&exact));
    println!("{:?}, {errors:.4?}", found.meshes[0]);
    assert!(errors[0] <= 0.05, "{errors:?}");
}

/// Snaps last a fraction of a period: 25 samples at the same phases of every period would miss some of them, or find all.
#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn few_samples_in_a_period_give_the_errors_of_trials_that_many_give() {
    for amplitude in [1.0, 1.5] {
        let few = moved("lindahl_fast", [amplitude, 1.0]);
        let mut many = few.clone();
        many.output.interval = few.shortest_period() / 200.0;
        let [few, many] = [few, many].map(|scene| settled(&scene, 0.05).meshes[0].trials.clone());
        // on finer meshes, some snaps are shorter than the interval of the few samples
        let coarse = few.iter().zip(&many).filter(|(few, _)| few.elements <= 56);
        for (few, many) in coarse {
            let ratio = few.error / many.error;
            println!("{amplitude}, {} elements: {ratio:.2}", few.elements);
            assert!(ratio > 0.8 && ratio < 1.25, "{amplitude}: {few:?} {many:?}");
        }
    }
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
        let is_said = settled
            .in_words()
            .join("\n")
            .contains("varies by less than 1 % of its mean");
        assert_eq!(is_said, settled.meshes[0].still);
        assert_eq!(is_said, amplitude < 0.01, "{amplitude}");
        settled.meshes[0].elements
    };
    let [little, less, still] = [0.1, 1e-3, 1e-6].map(elements);
    assert!(
        less as f64 <= 1.2 * little as f64 && still <= less,
        "{little}, {less}, {still}"
    );
}

/// Copies of a scene's only line along the seabed with the same motion, and one copy that is longer by a metre.
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

/// A line with a given mesh does not prevent the trials of the other line, which gets the mesh that it has alone.
#[test]
fn elements_given_for_a_line_leave_the_trials_of_another() {
    let alone = discretisation::select(&moved("taut_polyester", [1.0, 1.0])).unwrap();
    for given in [12, 60] {
        let mut scene = field("taut_polyester", 1);
        scene.lines[1].elements = Some(given);
        let selected = discretisation::select(&scene).unwrap();
        assert_eq!(selected.meshes.len(), 1);
        let mesh = &selected.meshes[0];
        assert!(mesh.tried && shortfalls(&selected).is_empty(), "{mesh:?}");
        assert!(!mesh.trials.is_empty());
        assert_eq!(mesh.elements, alone.meshes[0].elements);
        let counts = Simulation::new(&selected.scene).unwrap();
        let count = |line: usize| counts.model().lines[line].segment_count();
        assert_eq!([count(0), count(1)], [mesh.elements, given]);
    }
}

/// Beams are not tried: a riser modelled as a beam does not prevent the trials of a rope, and a note states that the error of its open mesh
/// is unknown.
#[test]
fn a_beam_leaves_the_trials_of_other_lines() {
    let rope = moved("taut_polyester", [1.0, 1.0]);
    let alone = discretisation::select(&rope).unwrap();
    let riser = r#"
[line_types.rod]
model = "beam"
mass = 200.0
diameter = 0.3
axial_stiffness = 7.0e8
shear_stiffness = 1.0e8
bending_stiffness = 1.0e5
torsional_stiffness = 1.0e5
rotary_inertia = 2.0

[[points]]
name = "foot"
position = [-5.0, 0.0, -150.0]
kind = "fixed"

[[points]]
name = "head"
position = [-5.0, 0.0, -10.0]
kind = "fixed"

[[lines]]
name = "riser"
from = "foot"
to = "head"
sections = [{ type = "rod", length = 139.5 }]
"#;
    let mut scene = Scene::from_toml(&(rope.to_toml() + riser)).unwrap();
    let selected = discretisation::select(&scene).unwrap();
    assert_eq!(selected.meshes[0], alone.meshes[0]);
    assert_says(
        &shortfalls(&selected),
        &["riser: the error of this mesh is unknown"],
    );
    scene.lines[1].elements = Some(10);
    let selected = discretisation::select(&scene).unwrap();
    assert_eq!(selected.meshes, alone.meshes);
    assert_eq!(shortfalls(&selected), "");
}

/// RMS error of the position of a line's middle node on the selected mesh, relative to its deviation from its mean [-].
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
        words[0].starts_with("5 elements for a target error of 2 %"),
        "{words:?}"
    );
}

/// RMS differences of tension and of the middle node's position between runs with successively doubled elements.
fn refined(name: &str, elements: &[usize]) -> Vec<[f64; 2]> {
    let scene = shipped(name);
    let step = scene.shortest_period() / CONVERGED.1;
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
