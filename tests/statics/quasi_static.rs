//! Quasi-static stepping: closed-form catenaries joined at free points, compared with closed forms, force balances and the assembled
//! equilibrium.

use crate::common::*;
use moorline::elements::Workspace;
use moorline::model::{Body, End, Model, State};
use moorline::scene::{InitialShape, Note, PointKind, Reconstruction, Scene, Strain, part};
use moorline::simulation::Simulation;
use moorline::statics::catenary::{self, Catenary, FlatSeabed};
use moorline::statics::{catenary_network, equilibrium};
use nalgebra::Vector3;

// ------------------------------------------------------------------ sliding collar

/// Span and sag [m] of the inextensible wire at 20 N, g = 9.81 m/s².
const COLLAR: [f64; 2] = [17.693_670_564, 4.086_064_837];
/// Pull on the collar [N], and half the weight of the wire: 0.2 kg/m · 9.81 m/s² · 10 m.
const PULL: f64 = 20.0;
const HALF_WEIGHT: f64 = 19.62;

/// The shipped scene with another mesh and stiffness [N] at its end: the collar is pulled by 20 N within 5 s, 10 s in all.
fn drawn_out(elements: usize, axial_stiffness: f64) -> Simulation {
    let mut collar = with_elements(shipped("collar"), elements);
    collar.line_types.get_mut("wire").unwrap().axial_stiffness = Some(axial_stiffness);
    let mut simulation = start(&collar);
    let mut solves = 0;
    for _ in 0..100 {
        simulation.advance(0.1).unwrap();
        let counters = simulation.counters();
        assert!(counters.substeps == 1 && counters.solves <= 12, "{counters:?}");
        solves += counters.solves;
    }
    assert!(solves <= 320, "{solves}"); // about three solves of the wire per step
    simulation
}

fn span_and_sag(simulation: &Simulation) -> [f64; 2] {
    [place(simulation, "collar").x, simulation.sag(0)]
}

#[test]
fn the_collar_slides_to_the_inextensible_catenary_on_any_mesh() {
    // The shipped EA of 5.35e6 N lengthens the wire by 1e-4 m; 1e10 N by 5e-8 m.
    for (elements, axial_stiffness, tolerance) in [(20, 5.35e6, 1e-3), (20, 1e10, 1e-6), (200, 1e10, 1e-6)] {
        let simulation = drawn_out(elements, axial_stiffness);
        for (value, exact) in span_and_sag(&simulation).into_iter().zip(COLLAR) {
            assert!((value / exact - 1.0).abs() < tolerance, "{elements}: {value}");
        }
        let depth = greatest(nodes(&simulation).iter().map(|r| -r.z)); // of the lowest node
        assert!((depth / COLLAR[1] - 1.0).abs() < tolerance);
    }
}

#[test]
fn the_stretching_collar_wire_is_the_elastic_catenary() {
    let (weight, ea) = (1.962, 5.35e6);
    let tension = PULL.hypot(HALF_WEIGHT);
    let span = 2.0 * PULL / weight * (HALF_WEIGHT / PULL).asinh() + PULL * 20.0 / ea;
    let sag = (tension - PULL) / weight + HALF_WEIGHT * HALF_WEIGHT / (2.0 * weight * ea);
    let simulation = drawn_out(200, ea);
    for (value, exact) in span_and_sag(&simulation).into_iter().zip([span, sag]) {
        assert!((value - exact).abs() < 1e-11, "{value} {exact}");
    }
}

#[test]
fn the_wall_feels_the_pull_on_the_collar_and_half_the_weight_of_the_wire() {
    let simulation = drawn_out(20, 5.35e6);
    let exact = [PULL, 0.0, -HALF_WEIGHT];
    for (value, exact) in simulation.end_force(0).into_iter().zip(exact) {
        assert!((value - exact).abs() < 1e-10, "{value} {exact}");
    }
    let tension = PULL.hypot(HALF_WEIGHT);
    for value in [
        simulation.tension_a(0),
        simulation.tension_b(0),
        simulation.tension_max(0),
    ] {
        assert!((value - tension).abs() < 1e-10, "{value}");
    }
    let lowest = simulation.profile(0)[10];
    assert!((lowest.tension - PULL).abs() < 1e-10, "{lowest:?}");
    let chords: f64 = nodes(&simulation)
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).norm())
        .sum();
    assert!(simulation.stretched_length(0) > 20.0 && chords < 20.0);
}

#[test]
fn without_a_pull_the_wire_hangs_folded_below_the_wall_and_is_drawn_out_from_there() {
    let mut simulation = start(&shipped("collar"));
    let [mut span, sag] = span_and_sag(&simulation);
    assert!(span.abs() < 1e-9 && (sag - 10.0).abs() < 1e-3);
    assert!((simulation.tension_b(0) - HALF_WEIGHT).abs() < 1e-9);
    for _ in 0..50 {
        simulation.advance(0.1).unwrap();
        let x = place(&simulation, "collar").x;
        assert!(x > span && (simulation.state().points[1].velocity.x - (x - span) / 0.1).abs() < 1e-9);
        span = x;
    }
}

#[test]
fn a_saved_quasi_static_simulation_replays_bit_for_bit() {
    let scene = shipped("collar");
    let mut simulation = start(&scene);
    run(&mut simulation, 0.1, 20);
    assert_replays(simulation, start(&scene), |simulation| run(simulation, 0.1, 20));
}

// ------------------------------------------------------------------ lines on the seabed

/// Base of scenes with quasi-static lines of chain and rope over a seabed with a friction coefficient [-].
fn over_seabed(friction: f64) -> Draft {
    draft(format!(
        "seabed = {{ depth = 50.0, stiffness = 3.0e6, friction = {friction} }}
        line_types.chain = {{ mass = 80.0, diameter = 0.08, axial_stiffness = 4.0e8 }}
        line_types.rope = {{ mass = 6.0, diameter = 0.08, axial_stiffness = 2.0e7 }}
        solver.integrator = 'quasi_static'"
    ))
    .fixed("anchor", [0.0, 0.0, -50.0])
}

/// A chain and a rope above it, from an anchor on the seabed to a coupled point.
fn moored() -> Scene {
    let sections = [("chain", 150.0, Some(30)), ("rope", 60.0, Some(12))];
    let fairlead = over_seabed(0.6).coupled("fairlead", [190.0, 30.0, -5.0]);
    fairlead
        .sections("mooring", ["anchor", "fairlead"], &sections)
        .scene()
}

fn closed_form(model: &Model, state: &State) -> Catenary {
    let line = &model.lines[0];
    let [a, b] = line.ends.map(|point| state.points[point].position);
    let seabed = FlatSeabed {
        height: -50.0 - a.z,
        friction: model.seabed_friction,
    };
    catenary::solve(&line.sections, (b - a).xy().norm(), b.z - a.z, Some(seabed)).unwrap()
}

#[test]
fn a_line_on_a_seabed_with_friction_is_its_catenary_at_every_step_and_costs_one_solve() {
    let mut simulation = start(&moored());
    for step in 0..=40 {
        if step > 0 {
            let phase = 0.15 * f64::from(step);
            let away = [
                6.0 * phase.sin(),
                3.0 * (phase.cos() - 1.0),
                2.0 * (2.0 * phase).sin(),
            ];
            simulation.set_displacement(1, away);
            simulation.advance(1.0).unwrap();
            assert_eq!(simulation.counters().solves, 1);
        }
        let (model, state) = (simulation.model(), simulation.state());
        let exact = closed_form(model, state);
        let [a, b] = [0, 1].map(|point| state.points[point].position);
        let along = Vector3::new(b.x - a.x, b.y - a.y, 0.0).normalize();
        let up = Vector3::z();
        let pull = exact.tension_b();
        let forces = [
            exact.horizontal_a() * along + exact.vertical_a() * up,
            -(exact.horizontal() * along + exact.vertical_b() * up),
        ];
        for (end, force) in [End::A, End::B].into_iter().zip(forces) {
            assert!((simulation.line_end_force(0, end) - force).norm() <= 1e-14 * pull);
        }
        for (node, &s) in simulation.profile(0).iter().zip(&model.lines[0].nodes.arc) {
            let at = exact.at(s);
            let apart = Vector3::new(node.x, node.y, node.z) - (a + at.x * along + at.z * up);
            assert!(apart.norm() < 1e-10, "{node:?}");
            assert!((node.tension - at.tension).abs() <= 1e-12 * pull, "{node:?}");
        }
        assert_eq!(simulation.laid_length(0), exact.laid_length());
        assert_eq!(simulation.sag(0), exact.sag());
        assert!(simulation.laid_length(0) > 10.0 && exact.horizontal_a() < exact.horizontal());
    }
}

#[test]
fn a_line_with_an_end_under_the_seabed_rests_on_its_elements() {
    let mut simulation = start(&moored());
    assert!(simulation.state().lines[0].closed_form.is_some());
    simulation.set_displacement(1, [-2.0, 0.0, -45.1]);
    simulation.advance(1.0).unwrap();
    assert!(simulation.state().lines[0].closed_form.is_none());
    assert!(simulation.counters().solves > 1);
}

// ------------------------------------------------------------------ networks

/// Three lines, from two anchors and a coupled point above, joined at a heavy point.
fn bridle(elements: usize, stiffness: f64, more: &str) -> Scene {
    draft(format!(
        "line_types.rope = {{ mass = 6.0, diameter = 0.08, axial_stiffness = {stiffness:e} }}
        solver.integrator = 'quasi_static'
        {more}"
    ))
    .fixed("port", [0.0, 10.0, -40.0])
    .fixed("starboard", [-5.0, -12.0, -42.0])
    .coupled("buoy", [60.0, 0.0, -20.0])
    .free("knot", [20.0, 4.0, -35.0])
    .with("mass = 50.0")
    .line("one", ["port", "knot"], "rope", 30.0, elements)
    .line("two", ["knot", "starboard"], "rope", 34.0, elements)
    .line("three", ["knot", "buoy"], "rope", 40.0, elements)
    .scene()
}

/// Returns whether every line has a closed form.
fn all_closed(simulation: &Simulation) -> bool {
    simulation
        .state()
        .lines
        .iter()
        .all(|line| line.closed_form.is_some())
}

/// Unbalanced force at a free point of a mass [kg], relative to the greatest tension there [-].
fn imbalance(simulation: &Simulation, point: usize, mass: f64) -> f64 {
    let pull = Vector3::from(simulation.end_force(point)) - mass * simulation.model().gravity * Vector3::z();
    let lines = 0..simulation.model().lines.len();
    pull.norm() / greatest(lines.map(|line| simulation.tension_max(line)))
}

#[test]
fn the_lines_of_a_bridle_carry_the_weight_of_its_knot() {
    for stiffness in [1e4, 2e7, 1e10, 1e13] {
        let mut total = 0;
        let mut simulation = start(&bridle(10, stiffness, ""));
        for step in 0..=60 {
            let phase = 0.1 * f64::from(step);
            let away = [8.0 * phase.sin(), 6.0 * (1.0 - phase.cos()), 3.0 * phase.sin()];
            simulation.set_displacement(2, away);
            if step > 0 {
                simulation.advance(1.0).unwrap();
                let solves = simulation.counters().solves;
                total += solves;
                let most = if stiffness < 1e12 { 100 } else { 500 };
                assert!(solves <= most, "{stiffness}: {solves}");
            }
            let imbalance = imbalance(&simulation, 3, 50.0);
            assert!(imbalance < 1e-9, "{stiffness}, {step}: {imbalance}");
            assert!(all_closed(&simulation));
        }
        // five to eight solves per line and step, although the fairlead moves by 0.8 m between steps and pulls the lines taut
        assert!(total <= 60 * 27, "{stiffness}: {total}");
    }
}

#[test]
fn the_assembled_equilibrium_of_a_bridle_tends_to_the_catenaries_at_second_order() {
    let counts = [8.0, 16.0, 32.0, 64.0];
    let errors = counts.map(|n| {
        let model = Model::new(&bridle(n as usize, 2e7, "")).unwrap();
        let places = resting(&at_reference(&model));
        let mut work = Workspace::new(&model);
        let assembled = equilibrium::solve(&model, &places, 0.0, &mut work).unwrap();
        let mut exact = assembled.clone();
        catenary_network::rest(&model, 0, &mut exact, &mut work).unwrap();
        (exact.points[3].position - assembled.points[3].position).norm()
    });
    for pair in errors.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.1, "{errors:?}");
    }
}

#[test]
fn a_line_split_at_a_free_point_hangs_as_the_whole_one() {
    // friction low enough that tension remains at the joint: without tension, friction holds it anywhere within a range
    let ends = over_seabed(0.05).coupled("fairlead", [190.0, 30.0, -5.0]);
    // joined in suspension, at the touchdown, and on the seabed
    for first in [180.0, 120.0, 60.0, 20.0] {
        let parts = [("chain", first, Some(10)), ("chain", 210.0 - first, Some(20))];
        let mut whole = ends
            .clone()
            .sections("whole", ["anchor", "fairlead"], &parts)
            .start();
        let split = ends.clone().free("joint", [150.0, 20.0, -30.0]);
        let split = split.line("lower", ["anchor", "joint"], "chain", first, 10);
        let mut split = split
            .line("upper", ["joint", "fairlead"], "chain", 210.0 - first, 20)
            .start();
        for step in 0..20 {
            let phase = 0.3 * f64::from(step);
            for simulation in [&mut whole, &mut split] {
                simulation.set_displacement(1, [5.0 * phase.sin(), 0.0, 2.0 * phase.sin()]);
                simulation.advance(1.0).unwrap();
                assert!(all_closed(simulation));
            }
            let force = whole.line_end_force(0, End::B);
            let gap = (split.line_end_force(1, End::B) - force).norm() / force.norm();
            assert!(gap < 1e-9, "{first} {step}: {gap} {:?}", split.counters());
        }
    }
}

#[test]
fn a_heavy_free_point_rests_on_the_seabed_and_is_lifted_by_a_load() {
    let mut simulation = over_seabed(0.6)
        .free("clump", [120.0, 0.0, -48.0])
        .with("mass = 5000.0, force = { z = { step = [0.0, 0.0, 10.0, 2.0e5] } }")
        .fixed("fairlead", [190.0, 0.0, -5.0])
        .line("lower", ["anchor", "clump"], "chain", 130.0, 20)
        .line("upper", ["clump", "fairlead"], "rope", 90.0, 20)
        .start();
    assert_eq!(simulation.state().points[1].position.z, -50.0);
    let (mut lifted, mut count) = (-50.0, 0);
    for step in 1..=20 {
        simulation.advance(0.5).unwrap();
        let z = simulation.state().points[1].position.z;
        assert!(z >= lifted, "{step}: {z}");
        lifted = z;
        if z > -50.0 {
            let load = simulation.model().points[1].load_at(simulation.time());
            let pull = Vector3::from(simulation.end_force(1)) + load
                - 5000.0 * simulation.model().gravity * Vector3::z();
            assert!(pull.norm() < 1e-9 * load.norm(), "{step}: {pull}");
            count += 1;
        }
    }
    assert!(count > 5 && lifted > -45.0, "{count} {lifted}");
}

/// Two knots, sinking or floating, over a seabed in water: each tied to an anchor, to a point above and to the other, slack to taut.
fn tangle(seed: &mut u64) -> Simulation {
    let mut tangle = draft(
        "seabed = { depth = 30.0, stiffness = 1.0e6 }\nwater.density = 1025.0\nsolver.integrator = 'quasi_static'",
    );
    for (name, heaviest) in [("chain", 60.0), ("rope", 10.0)] {
        let (mass, stiffness) = (
            1.0 + heaviest * random(seed),
            10_f64.powf(4.0 + 5.0 * random(seed)),
        );
        let keys = format!("mass = {mass:?}, diameter = 0.05, axial_stiffness = {stiffness:e}");
        tangle = tangle.and(&format!("line_types.{name} = {{ {keys} }}"));
    }
    let names = ["south", "north", "pile", "vessel", "left", "right"];
    let mut places = Vec::new();
    for name in names {
        let z = match name {
            "south" | "north" => -30.0,
            "pile" | "vessel" => -20.0 * random(seed),
            _ => -30.0 * random(seed),
        };
        let place = [40.0 * random(seed), 40.0 * random(seed), z];
        let knot = format!(
            "mass = {:?}, volume = {:?}",
            500.0 * random(seed),
            0.3 * random(seed)
        );
        tangle = match name {
            "left" | "right" => tangle.free(name, place).with(&knot),
            "vessel" => tangle.coupled(name, place),
            _ => tangle.fixed(name, place),
        };
        places.push(Vector3::from(place));
    }
    for (number, [a, b]) in [[0, 4], [1, 5], [4, 5], [4, 2], [5, 3]].into_iter().enumerate() {
        let length = (0.95 + 0.5 * random(seed)) * (places[b] - places[a]).norm();
        let chain = (0.1 + 0.8 * random(seed)) * length;
        let sections = [("chain", chain, Some(5)), ("rope", length - chain, Some(5))];
        tangle = tangle.sections(&format!("line{number}"), [names[a], names[b]], &sections);
    }
    tangle.start()
}

#[test]
fn random_networks_rest_on_their_catenaries_in_balance() {
    let (mut seed, mut on_elements) = (11, 0);
    for case in 0..200 {
        let mut simulation = tangle(&mut seed);
        for step in 0..5 {
            let shift = (0.3 * f64::from(step)).sin();
            simulation.set_displacement(3, [2.0 * shift, shift, shift]);
            simulation.advance(0.5).unwrap();
            if simulation.state().lines[0].closed_form.is_none() {
                on_elements += 1;
                continue;
            }
            let tension = greatest((0..5).map(|line| simulation.tension_max(line)));
            for knot in [4, 5] {
                let z = simulation.state().points[knot].position.z;
                let own = simulation.model().points[knot].free().unwrap().at(z).weight;
                let mut pull = Vector3::from(simulation.end_force(knot)) - own * Vector3::z();
                if z <= -30.0 + 0.02 {
                    pull.z = pull.z.max(0.0); // the remainder is carried by the seabed
                }
                assert!(pull.norm() < 1e-9 * tension, "{case} {step}: {pull} {tension}");
            }
        }
    }
    assert!(on_elements <= 20, "{on_elements}");
}

// ------------------------------------------------------------------ where there is no closed form

#[test]
fn a_cable_of_green_strain_rests_on_its_elements() {
    let mut simulation = start(&shipped("point_load"));
    let networks = &simulation.model().networks;
    assert!(!catenary_network::serves(simulation.model(), &networks[0]));
    for step in 0..=10 {
        let load = -simulation.model().points[1].load_at(f64::from(step)).z;
        let exact = (load / (8.0 * 5000.0)).cbrt(); // W = 8·EA·u³/L³
        let deflection = -simulation.state().points[1].position.z;
        assert!(
            (deflection / exact - 1.0).abs() < 1e-9,
            "{load} N: {deflection} m"
        );
        assert!(
            simulation
                .state()
                .lines
                .iter()
                .all(|line| line.closed_form.is_none())
        );
        simulation.advance(1.0).unwrap();
    }
}

/// The moored line with another strain measure, which has no closed form, and an axial damping [N s].
fn on_elements(axial_damping: f64) -> Simulation {
    let mut scene = moored();
    for kind in scene.line_types.values_mut() {
        kind.strain = Strain::Green;
        kind.axial_damping = Some(axial_damping);
        kind.drag_normal = Some(1.2);
        kind.added_mass_normal = Some(1.0);
    }
    start(&scene)
}

#[test]
fn a_line_on_its_elements_is_at_rest_however_fast_it_was_moved_there() {
    let mut lines = [0.0, 1e7].map(on_elements);
    for step in 0..8 {
        let phase = 0.8 * f64::from(step + 1);
        let away = [3.0 * phase.sin(), 1.0, 2.0 * phase.cos() - 2.0, 0.0, 0.0, 0.0];
        for simulation in &mut lines {
            simulation.set_body(Body::Point(1), away, [Some(0.0); 6]);
            simulation.advance(0.1).unwrap();
        }
        let [plain, damped] = &lines;
        for end in [End::A, End::B] {
            assert_eq!(plain.line_end_force(0, end), damped.line_end_force(0, end));
        }
        assert_eq!(plain.tensions(0), damped.tensions(0));
        assert!(plain.state().lines[0].velocity.iter().all(|v| v.norm() == 0.0));
    }
}

// ------------------------------------------------------------------ energy

/// Error of the energy balance relative to the work transferred at the ends [-] after 12 s, in which a point moves around within a reach [m] in `parts`
/// communication steps per second; and the number of equilibria solved.
fn imbalance_of(scene: &Scene, point: usize, reach: f64, parts: usize) -> (f64, usize) {
    let mut scene = scene.clone();
    scene.solver.input_reconstruction = Reconstruction::Interpolate;
    let mut simulation = start(&balanced(scene));
    let (mut turnover, mut given, mut substeps) = (0.0, 0.0, 0);
    for number in 1..=12 * parts {
        let phase = 0.9 * number as f64 / parts as f64;
        let away = [phase.sin(), 0.4 * (phase.cos() - 1.0), 0.3 * phase.sin()].map(|a| reach * a);
        simulation.set_displacement(point, away);
        simulation.advance(1.0 / parts as f64).unwrap();
        let now = flow(&simulation).external_work;
        turnover += (now - given).abs();
        given = now;
        substeps += simulation.counters().substeps;
    }
    (balance_error(&simulation).abs() / turnover, substeps)
}

#[test]
fn the_energy_balance_of_a_line_with_friction_on_the_seabed_closes_in_short_steps_and_in_long_ones() {
    for (reach, parts, bound) in [(0.5, 1, 2e-3), (12.0, 16, 0.02), (12.0, 1, 0.02)] {
        let (error, equilibria) = imbalance_of(&moored(), 1, reach, parts);
        assert!(
            error < bound && equilibria == 12 * parts,
            "{error:e}, {equilibria}"
        );
    }
}

/// The bridle in a current that acts only on its knot.
fn bridle_in_current() -> Scene {
    let mut scene = bridle(
        8,
        2e7,
        "water = { density = 1025.0, current = { velocity = [1.5, 0.0, 0.0] } }",
    );
    scene.points[3].drag_area = Some(4.0);
    scene
}

#[test]
fn a_free_point_feels_a_current_that_its_lines_do_not() {
    let simulation = start(&bridle_in_current());
    let push = 0.5 * 1025.0 * 4.0 * 1.5 * 1.5; // ½ρ C_d A u² [N]
    let knot = Vector3::from(simulation.end_force(3));
    assert!((knot.x + push).abs() < 1e-6 * push, "{knot}");
    let (error, _) = imbalance_of(&bridle_in_current(), 2, 3.0, 1);
    assert!(error < 0.02, "{error:e}");
}

#[test]
fn a_quasi_static_line_is_in_equilibrium_from_the_start_whatever_its_initial_shape() {
    let mut scene = moored();
    let force = start(&scene).end_force(1);
    scene.lines[0].initial = InitialShape::Straight;
    assert_eq!(start(&scene).end_force(1), force);
    let note = |note: &Note| note.at == "lines[0]" && note.text == "quasi-static: `initial` changes nothing";
    assert!(scene.notes().iter().any(note));
}

#[test]
fn the_equilibrium_of_a_scene_has_its_prescribed_points_at_their_reference_positions() {
    let still = moored();
    let mut moving = still.clone();
    moving.points[1].kind = PointKind::Prescribed;
    moving.points[1].motion = Some(part("x = [[-5.0, 9.0, 1.5708]]").unwrap());
    let [still, moving] = [still, moving].map(|scene| Simulation::at_rest(&scene).unwrap());
    assert_eq!(moving.end_force(1), still.end_force(1));
    let catenary = moving.catenary(0).unwrap().tension_b();
    assert!((moving.tension_b(0) / catenary - 1.0).abs() < 0.01);
}
