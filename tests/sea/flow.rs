//! Water flow from the host: the flow at the nodes against built-in waves and currents, orders, saved states, refusals.
//!
//! ```text
//!   ~~~~~~~~~~~~~~~~~~~~~~
//!   hook ●              ● fairlead  claim: Airy's field given by a host -> the built-in waves, sampled alike
//!         ╲            ╱            claim: zero flow -> still water; a steady uniform flow -> that current
//!   sinker (○)·······
//! ```

use std::f64::consts::TAU;

use crate::common::*;
use moorline::dynamics::StepFailure;
use moorline::model::Body;
use moorline::physics::airy::Waves;
use moorline::scene::{Integrator, Scene};
use moorline::simulation::{EndMotion, FLOW_COMPONENTS, Simulation, WaterFlow};
use nalgebra::Vector3;

/// A ripple only a few centimetres deep that reaches no node; it makes the solver sample the built-in waves about every hundredth of a second.
const RIPPLE: &str = "[2.9e-5, 0.05, 0.0, 0.0]";
const RHO: f64 = 1025.0;

/// A line with a sinker near one end, taut in all these seas and therefore without snaps, in water with these keys of `[water]`.
fn mooring(water: &str, integrator: Integrator) -> Scene {
    let scene = draft(format!(
        "water = {{ density = {RHO}, surface = false, {water} }}
        seabed.depth = 18.0
        line_types.rope = {{ mass = 80.0, diameter = 0.12, axial_stiffness = 2e6, axial_damping = 2e4, drag_normal = 1.2,
          drag_tangential = 0.1, added_mass_normal = 1.0, added_mass_tangential = 0.2 }}
        solver = {{ input_reconstruction = 'interpolate' }}"
    ))
    .fixed("hook", [0.0, 0.0, -4.7])
    .free("sinker", [0.6, 0.0, -5.1])
    .with("mass = 2000.0, volume = 0.3, drag_area = 0.5, added_mass = 0.5")
    .coupled("fairlead", [25.0, 3.0, -4.7])
    .line("pennant", ["hook", "sinker"], "rope", 0.8, 2)
    .line("span", ["sinker", "fairlead"], "rope", 25.0, 8)
    .scene();
    with_integrator(scene, integrator, 0.01)
}

const SWELL: &str = "waves = [{ components = [[3.0, 9.0, 0.4, 0.7], RIPPLE], ramp = 5.0 }]";
const SEA: &str = "waves = [{ components = [[2.0, 11.0, 0.4, 0.7], [1.8, 9.0, 0.0, 2.0], [0.3, 7.0, -0.5, 4.0], RIPPLE], ramp = 5.0 }]";

fn waves(components: &str) -> String {
    components.replace("RIPPLE", RIPPLE)
}

/// Distance [m] at a node of a line.
type Distance<'a> = dyn Fn(usize, usize) -> Vector3<f64> + 'a;

/// A host that computes Airy waves.
struct Host {
    waves: Waves,
    flow: WaterFlow,
}

impl Host {
    /// Returns a host with the waves of a scene, for a simulation.
    fn new(waves: &Scene, simulation: &Simulation) -> Host {
        let model = moorline::model::Model::new(waves).unwrap();
        Host {
            waves: model.waves.unwrap(),
            flow: WaterFlow::still(simulation.model()),
        }
    }

    /// Sets the flow of a time [s] at the positions where it is required.
    fn give(&mut self, simulation: &mut Simulation, time: f64) {
        self.give_beside(simulation, time, &|_, _| Vector3::zeros());
    }

    /// Sets the flow of a time [s] at a distance [m] from the positions where it is required.
    fn give_beside(&mut self, simulation: &mut Simulation, time: f64, distance: &Distance) {
        for line in 0..simulation.model().lines.len() {
            for node in 0..self.flow.node_count(line) {
                let place = simulation.flow_place(line, node) + distance(line, node);
                let orbit = self.waves.orbit(place, time);
                self.flow
                    .set(line, node, orbit.velocity.into(), orbit.acceleration.into());
            }
        }
        simulation.inputs_mut().flow.clone_from(&self.flow);
    }
}

/// Motion of the fairlead [m].
fn fairlead(t: f64) -> [f64; 3] {
    let ramp = (t / 5.0).min(1.0).powi(2);
    [
        0.4 * ramp * (TAU * t / 7.0).sin(),
        0.0,
        0.3 * ramp * (TAU * t / 9.0).cos(),
    ]
}

fn results(simulation: &Simulation) -> Vec<f64> {
    let points = ["hook", "fairlead"].map(|name| simulation.model().point_index(name).unwrap());
    let forces = points.into_iter().flat_map(|point| simulation.end_force(point));
    let sinker = place(simulation, "sinker");
    forces.chain(sinker.iter().copied()).collect()
}

/// Steps a simulation whose host gives the displacement at the end of every step; returns the results over time.
fn history(
    simulation: &mut Simulation,
    step: f64,
    count: usize,
    mut give: impl FnMut(&mut Simulation, f64),
) -> Vec<Vec<f64>> {
    let fairlead_point = simulation.model().point_index("fairlead").unwrap();
    let mut rows = Vec::new();
    for _ in 0..count {
        let end = simulation.time() + step;
        simulation.set_displacement(fairlead_point, fairlead(end));
        give(simulation, end);
        simulation.advance(step).unwrap();
        rows.push(results(simulation));
    }
    rows
}

/// Greatest difference of two histories, relative to the range of the second, over all results [-].
fn difference(found: &[Vec<f64>], wanted: &[Vec<f64>]) -> f64 {
    let columns = (0..wanted[0].len()).map(|column| {
        let of = |rows: &[Vec<f64>]| -> Vec<f64> { rows.iter().map(|row| row[column]).collect() };
        let (found, wanted) = (of(found), of(wanted));
        let [least, most] =
            [f64::min as fn(f64, f64) -> f64, f64::max].map(|of| wanted.iter().copied().reduce(of).unwrap());
        greatest(found.iter().zip(&wanted).map(|(a, b)| (a - b).abs())) / (most - least)
    });
    greatest(columns)
}

/// Difference between a run in built-in waves and one in the same field from a host, both sampled once per step, with internal steps of
/// at most `longest` [s].
fn difference_from_waves(sea: &str, integrator: Integrator, longest: f64) -> f64 {
    let (own, given) = (
        mooring(&waves(sea), integrator),
        mooring("flow = 'host'", integrator),
    );
    let [own, given] = [own, given].map(|scene| with_integrator(scene, integrator, longest));
    let mut simulation = start(&own);
    let field = simulation.model().waves.clone().unwrap();
    let step = field.interval_below(0.0);
    let highest = |simulation: &Simulation| {
        let lines = simulation.state().lines.iter();
        let heights = lines.map(|line| greatest(line.position.iter().map(|node| 100.0 + node.z)) - 100.0);
        heights.fold(0.0, f64::min)
    };
    let count = (25.0 / step) as usize;
    let mut lowest = 0.0_f64;
    let wanted = history(&mut simulation, step, count, |simulation, _| {
        lowest = lowest.min(highest(simulation))
    });
    assert_eq!(
        field.interval_below(lowest),
        step,
        "the waves are sampled once a step at all lines"
    );
    let mut hosted = start(&given);
    let mut host = Host::new(&own, &hosted);
    host.give(&mut hosted, 0.0);
    hosted.restart(0.0).unwrap();
    let mut before: Vec<Vec<Vector3<f64>>> = Vec::new();
    let found = history(&mut hosted, step, count, |simulation, end| {
        let lines = simulation.state().lines.clone();
        // from the straight path to the parabola on which the built-in waves are sampled
        let bend = |line: usize, node: usize| {
            let (now, rate) = (lines[line].position[node], lines[line].velocity[node]);
            before
                .get(line)
                .map_or(Vector3::zeros(), |before| step * rate - (now - before[node]))
        };
        host.give_beside(simulation, end, &bend);
        before = lines.into_iter().map(|line| line.position).collect();
    });
    difference(&found, &wanted)
}

#[test]
fn a_field_of_airy_from_the_host_is_the_built_in_waves_to_a_millionth() {
    for integrator in [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
        Integrator::Bossak,
    ] {
        for sea in [SWELL, SEA] {
            // between the samples the accelerations differ, because of slopes that the host does not set
            for (longest, limit) in [(0.0025, 1e-6), (0.01, 1e-9)] {
                if integrator == Integrator::Leapfrog && longest == 0.01 {
                    continue; // its steps are shorter anyway
                }
                let error = difference_from_waves(sea, integrator, longest);
                assert!(error < limit, "{integrator:?}, steps of {longest} s: {error:e}");
            }
        }
    }
}

/// A mooring with flow from a host in a swell, started, with its host.
fn hosted(integrator: Integrator) -> (Simulation, Host) {
    let simulation = start(&mooring("flow = 'host'", integrator));
    let host = Host::new(&mooring(&waves(SWELL), integrator), &simulation);
    (simulation, host)
}

#[test]
fn a_saved_state_replays_the_flow_of_the_host_bit_for_bit() {
    for integrator in [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
    ] {
        for reconstruction in ["interpolate", "smooth"] {
            let text = mooring("flow = 'host'", integrator)
                .to_toml()
                .replace("\"interpolate\"", &format!("\"{reconstruction}\""));
            let scene = Scene::from_toml(&text).unwrap();
            let mut simulation = start(&scene);
            let mut host = Host::new(&mooring(&waves(SWELL), integrator), &simulation);
            history(&mut simulation, 0.1, 40, |simulation, end| {
                host.give(simulation, end)
            });
            // the flow of the next step is set before the state is saved, and is part of it
            assert_replays(simulation, start(&scene), |simulation| {
                simulation.advance(0.1).unwrap();
                let mut host = Host::new(&mooring(&waves(SWELL), integrator), simulation);
                history(simulation, 0.1, 20, |simulation, end| host.give(simulation, end));
            });
        }
    }
}

#[test]
fn a_step_repeated_from_a_saved_state_is_made_in_the_flow_that_is_given_then() {
    for integrator in [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
    ] {
        let (mut simulation, mut host) = hosted(integrator);
        history(&mut simulation, 0.1, 10, |simulation, end| {
            host.give(simulation, end)
        });
        let saved = simulation.snapshot().clone();
        simulation.inputs_mut().flow.calm();
        simulation.advance(0.1).unwrap();
        let calm = results(&simulation);
        simulation.restore(saved.clone());
        host.give(&mut simulation, 3.0);
        simulation.advance(0.1).unwrap();
        let mut fresh = start(&mooring("flow = 'host'", integrator));
        fresh.restore(saved);
        host.give(&mut fresh, 3.0);
        fresh.advance(0.1).unwrap();
        assert_eq!(results(&simulation), results(&fresh), "{integrator:?}");
        assert_ne!(results(&simulation), calm, "{integrator:?}");
    }
}

#[test]
fn without_interpolation_the_error_of_the_force_falls_with_the_square_of_the_step() {
    let scene = mooring("flow = 'host'", Integrator::GeneralisedAlpha);
    let smooth = Scene::from_toml(&scene.to_toml().replace("\"interpolate\"", "\"smooth\"")).unwrap();
    // a ramp that ends later, since the rate of the acceleration jumps at its end
    let field = mooring(
        &waves(SWELL).replace("ramp = 5.0", "ramp = 25.0"),
        Integrator::GeneralisedAlpha,
    );
    let run = |step: f64| -> Vec<Vec<f64>> {
        let mut simulation = start(&smooth);
        let mut host = Host::new(&field, &simulation);
        host.give(&mut simulation, 0.0);
        simulation.restart(0.0).unwrap();
        let each = (0.4 / step).round() as usize;
        let mut rows = Vec::new();
        for _ in 0..50 {
            for _ in 0..each {
                let time = simulation.time();
                host.give(&mut simulation, time);
                simulation.advance(step).unwrap();
            }
            rows.push(results(&simulation));
        }
        rows
    };
    let truth = run(0.0125);
    let steps = [0.4, 0.2, 0.1, 0.05];
    let errors = steps.map(|step| difference(&run(step), &truth));
    assert_order_at_least(2.0, &steps, &errors);
    assert!(errors[2] < 0.01, "{errors:?}");
}

#[test]
fn a_flow_of_zero_is_still_water() {
    for integrator in [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
    ] {
        let [still, hosted] = ["", "flow = 'host'"]
            .map(|water| history(&mut start(&mooring(water, integrator)), 0.1, 100, |_, _| {}));
        let error = difference(&hosted, &still);
        assert!(error < 1e-9, "{integrator:?}: {error:e}");
    }
}

#[test]
fn a_steady_uniform_flow_is_a_current_of_its_velocity_and_adds_to_one() {
    // on straight lines of given shape, which start equally: in equilibrium a current already exerts drag, whereas a flow does not
    let run = |water: &str, velocity: [f64; 3]| {
        let mut scene = mooring(water, Integrator::Leapfrog);
        for line in &mut scene.lines {
            line.initial = moorline::scene::InitialShape::Straight;
        }
        let mut simulation = start(&scene);
        let mut flow = WaterFlow::still(simulation.model());
        for line in 0..2 {
            for node in 0..flow.node_count(line) {
                flow.set(line, node, velocity, [0.0; 3]);
            }
        }
        simulation.inputs_mut().flow.clone_from(&flow);
        simulation.restart(0.0).unwrap();
        history(&mut simulation, 0.1, 100, |_, _| {})
    };
    let current = run("current = { velocity = [0.8, -0.5, 0.2] }", [0.0; 3]);
    let flow = run("flow = 'host'", [0.8, -0.5, 0.2]);
    let both = run(
        "flow = 'host', current = { velocity = [1.0, -0.5, 0.2] }",
        [-0.2, 0.0, 0.0],
    );
    for found in [flow, both] {
        let error = difference(&found, &current);
        assert!(error < 1e-9, "{error:e}");
    }
}

#[test]
fn a_flow_that_is_no_number_or_faster_than_any_water_is_refused_with_its_name() {
    let (mut simulation, mut host) = hosted(Integrator::Leapfrog);
    history(&mut simulation, 0.1, 3, |simulation, end| {
        host.give(simulation, end)
    });
    for (component, value, said) in [
        (0, f64::NAN, "span.flow.vx[3] = NaN m/s"),
        (2, 1e3, "span.flow.vz[3] = 1e3 m/s is beyond 100 m/s"),
        (4, -1e5, "span.flow.ay[3] = -1e5 m/s² is beyond 10000 m/s²"),
    ] {
        let mut flow = host.flow.clone();
        flow.component_mut(1, component)[2] = value;
        simulation.inputs_mut().flow.clone_from(&flow);
        let before = postcard::to_stdvec(simulation.snapshot()).unwrap();
        let error = simulation.advance(0.1).unwrap_err();
        assert!(
            matches!(&error.cause, StepFailure::Input(text) if text.starts_with(said)),
            "{error}"
        );
        assert_eq!((error.line.as_str(), error.node), ("span", 2));
        assert_eq!(postcard::to_stdvec(simulation.snapshot()).unwrap(), before);
        let refusal = simulation.restart(0.0).unwrap_err().to_string();
        assert!(
            refusal.contains(said),
            "{}: {refusal}",
            FLOW_COMPONENTS[component]
        );
    }
    host.give(&mut simulation, 0.4);
    let before = simulation.snapshot().clone();
    assert!(matches!(
        simulation.advance(1e9).unwrap_err().cause,
        StepFailure::TooManySteps { .. }
    ));
    assert!(
        *simulation.snapshot() == before,
        "a step that fails leaves the flow as it was"
    );
}

#[test]
fn the_end_of_a_released_line_leaves_the_sinker_in_the_flow_of_the_other() {
    let (calm, stream) = (0.0, 1.5);
    let run = |lower: f64| {
        let mut scene = mooring("flow = 'host'", Integrator::Leapfrog);
        scene.lines[0].release = Some(moorline::scene::channel::LineEnd::B);
        let mut simulation = start(&scene);
        simulation.set_release(0, true);
        simulation.advance(0.1).unwrap();
        let mut flow = WaterFlow::still(simulation.model());
        flow.component_mut(0, 0)[2] = lower;
        simulation.inputs_mut().flow.clone_from(&flow);
        run(&mut simulation, 0.1, 10);
        place(&simulation, "sinker")
    };
    assert_eq!(run(calm), run(stream));
}

#[test]
fn derivatives_and_the_impedance_of_a_step_are_those_of_steps_in_the_flow() {
    let scene = mooring("flow = 'host'", Integrator::Leapfrog);
    let mut scene = scene;
    scene.output.derivatives = true;
    let mut simulation = start(&scene);
    let mut host = Host::new(&mooring(&waves(SWELL), Integrator::Leapfrog), &simulation);
    host.give(&mut simulation, 0.0);
    simulation.restart(0.0).unwrap();
    history(&mut simulation, 0.1, 60, |simulation, end| {
        host.give(simulation, end)
    });
    let point = simulation.model().point_index("fairlead").unwrap();
    let body = Body::Point(point);
    let predicted = simulation.impedance(body).unwrap().clone();
    let (before, end) = (simulation.snapshot().clone(), simulation.time() + 0.1);
    host.give(&mut simulation, end);
    let flow = simulation.inputs().flow.clone();
    let mut step = |by: f64| {
        simulation.restore(before.clone());
        simulation.inputs_mut().flow.clone_from(&flow);
        let [x, y, z] = fairlead(end);
        simulation.set_displacement(point, [x + by, y, z]);
        let h = 1e-4;
        let velocity: [f64; 3] =
            std::array::from_fn(|axis| (fairlead(end + h)[axis] - fairlead(end - h)[axis]) / (2.0 * h));
        simulation.set_velocity(point, velocity.map(Some));
        simulation.advance(0.1).unwrap();
        (Vector3::from(simulation.end_force(point)), simulation.clone())
    };
    let ([below, above], (force, stepped)) = ([step(-1e-6).0, step(1e-6).0], step(0.0));
    let motion = EndMotion {
        body,
        axis: 0,
        is_velocity: false,
    };
    let found = stepped
        .derivative(motion, |simulation| Ok(simulation.end_force(point).to_vec()))
        .unwrap();
    let by_hand = (above - below) / 2e-6;
    assert!(
        (Vector3::from_row_slice(&found) - by_hand).norm() < 1e-4 * by_hand.norm(),
        "{found:?} {by_hand}"
    );
    let input = stepped.inputs().body(body);
    let velocity = input.velocity.map(|velocity| velocity.unwrap_or(0.0));
    let [x, v] = [input.displacement, velocity].map(nalgebra::Vector6::from);
    let linear = predicted.free - predicted.damping * v - predicted.stiffness * x;
    let inertialess = stepped.force_without_inertia(body);
    let error = (linear - inertialess).norm();
    assert!(error < 0.01 * force.norm(), "{error} N of {} N", force.norm());
}
