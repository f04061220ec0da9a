//! Changes of a scene that must not change a result, and quantities that a result must conserve.

use crate::common::*;
use approx::assert_relative_eq;
use moorline::dynamics::energy_balance::Flow;
use moorline::model::{Body, Motion, State};
use moorline::scene::{Current, Integrator, MotionPath, Reconstruction, Scene};
use moorline::simulation::Simulation;
use nalgebra::{Rotation3, Vector3};

/// The OC4 chain on a coarse mesh, moved along all three axes, with one integrator.
fn chain(integrator: Integrator) -> Scene {
    let mut scene = with_integrator(with_elements(shipped("oc4_chain"), 20), integrator, 0.01);
    if let Some(MotionPath::Harmonic(motion)) = scene.motion.get_mut("fairlead") {
        motion.y = vec![vec![4.0, 11.0]];
        motion.ramp = Some(5.0);
    }
    scene
}

/// The state after `duration` [s] in steps of 0.05 s.
fn after(scene: &Scene, duration: f64) -> State {
    let mut simulation = following(scene);
    run(&mut simulation, 0.05, (duration / 0.05).round() as usize);
    simulation.state().clone()
}

#[test]
fn the_energy_balance_changes_no_bit_of_the_motion() {
    let mut in_current = shipped("oc4_chain");
    let current = Current {
        velocity: Some([0.6, 0.2, 0.0]),
        ..Current::default()
    };
    in_current.water.as_mut().unwrap().current = Some(current);
    for integrator in INTEGRATORS.into_iter().chain([Integrator::QuasiStatic]) {
        for (name, scene) in [
            ("a chain on its seabed", shipped("oc4_chain")),
            ("a rope", shipped("taut_polyester")),
            ("a chain in a current", in_current.clone()),
            ("lines at a free point", shipped("bridle")),
        ] {
            let mut scene = with_integrator(with_elements(scene, 20), integrator, 0.05);
            let mut without = following(&scene);
            run(&mut without, 0.05, 60);
            assert!(without.energy_balance().is_none() && without.power_residual().is_none());
            scene.output.energy_balance = true;
            assert_eq!(without.state(), &after(&scene, 3.0), "{name}, {integrator:?}");
        }
    }
}

/// Error of the energy balance, relative to all the energy that it counts, for a scene whose host moves the vessel or the
/// second point abruptly every 0.1 s for 10 s.
fn jumping_balance(mut scene: Scene) -> f64 {
    scene.solver.input_reconstruction = Reconstruction::Jump;
    let mut simulation = start(&balanced(scene.clone()));
    let body = if scene.vessels.is_empty() {
        Body::Point(1)
    } else {
        Body::Vessel(0)
    };
    let (mut counted, mut last): (f64, Flow) = (0.0, Flow::default());
    for step in 0..100 {
        let t = 0.1 * f64::from(step);
        let [x, y, z] = [(0.9 * t).sin(), 0.5 * (0.7 * t).sin(), -1.5 * t.sin()];
        simulation.set_body(body, [x, y, z, 0.0, 0.0, 0.0], [None; 6]);
        simulation.advance(0.1).unwrap();
        let flow = flow(&simulation);
        counted +=
            (flow.external_work - last.external_work).abs() + (flow.dissipation - last.dissipation).abs();
        last = flow;
    }
    balance_error(&simulation) / counted
}

#[test]
fn the_energy_balance_closes_where_held_points_jump() {
    let pierces = draft(
        "water = { density = 1025.0, surface = true, waves = [{ regular = { height = 2.0, period = 6.0 } }] }
        line_types.rope = { mass = 20.0, diameter = 0.12, static_stiffness = 2.0e6, dynamic_stiffness = 6.0e6,
          static_damping = 1.0e7, dynamic_damping = 1.0e4, drag_normal = 1.2, added_mass_normal = 1.0 }",
    )
    .fixed("anchor", [0.0, 0.0, -40.0])
    .coupled("fairlead", [40.0, 0.0, 8.0])
    .line("line1", ["anchor", "fairlead"], "rope", 66.0, None)
    .scene();
    // a jump makes waves as short as an element, which explicit steps resolve worst
    for (name, scene, explicit, axial_step) in [
        ("a chain on its seabed", shipped("oc4_chain"), 5e-3, 0.01),
        ("a rope", shipped("taut_polyester"), 1e-5, 0.01),
        // 4e-3 at 5 ms, where the two ropes are not resolved; 6e-4 at 2.5 ms
        ("lines at a free point", shipped("bridle"), 2e-3, 0.0025),
        ("a viscoelastic rope through the surface", pierces, 0.1, 0.01),
    ] {
        for integrator in INTEGRATORS {
            let step = if integrator == Integrator::AxialImplicit {
                axial_step
            } else {
                0.01
            };
            let scene = with_integrator(with_elements(scene.clone(), 20), integrator, step);
            let error = jumping_balance(scene);
            println!("{name}, {integrator:?}: {error:e}");
            let bound = match integrator {
                Integrator::Leapfrog => explicit,
                Integrator::AxialImplicit => 3e-3,
                _ => 1e-6,
            };
            assert!(error.abs() < bound, "{name}, {integrator:?}: {error:e}");
        }
    }
}

/// Greatest distance between the first line's nodes in two states [m], after mapping the second.
fn distance(found: &State, other: &State, image: impl Fn(Vector3<f64>) -> Vector3<f64>) -> f64 {
    let images: Vec<Vector3<f64>> = other.lines[0].position.iter().map(|r| image(*r)).collect();
    gap(&found.lines[0].position, &images)
}

/// The scene in another frame: a linear map of all points and harmonic motions, whose components must have the same periods.
fn mapped(mut scene: Scene, map: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Scene {
    for point in &mut scene.points {
        point.position = map(Vector3::from(point.position)).into();
    }
    for path in scene.motion.values_mut() {
        let motion = Motion::new(path);
        let rows = (0..=400).map(|k| {
            let t = 0.05 * k as f64;
            let u = map(motion.at(t).position);
            [t, u.x, u.y, u.z, 0.0, 0.0, 0.0]
        });
        *path = MotionPath::Table(rows.collect());
    }
    scene
}

#[test]
fn the_mirror_image_of_a_scene_moves_as_the_mirror_image() {
    for integrator in INTEGRATORS {
        let scene = mapped(chain(integrator), |r| r);
        let original = after(&scene, 15.0);
        for flip in [Vector3::new(-1.0, 1.0, 1.0), Vector3::new(1.0, -1.0, 1.0)] {
            let image = after(&mapped(scene.clone(), |r| r.component_mul(&flip)), 15.0);
            let apart = distance(&image, &original, |r| r.component_mul(&flip));
            assert_eq!(apart, 0.0, "{integrator:?}");
        }
    }
}

#[test]
fn a_scene_turned_about_the_vertical_moves_alike() {
    for integrator in INTEGRATORS {
        let scene = mapped(chain(integrator), |r| r);
        let original = after(&scene, 10.0);
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7);
        let image = after(&mapped(scene.clone(), |r| turn * r), 10.0);
        let apart = distance(&image, &original, |r| turn * r);
        assert!(apart < 1e-8, "{integrator:?}: {apart:e} m");
    }
}

#[test]
fn the_order_of_lines_and_points_changes_nothing() {
    for integrator in INTEGRATORS {
        let mut scene = chain(integrator);
        let mut second = scene.lines[0].clone();
        second.name = "line2".into();
        second.from = "anchor2".into();
        let mut anchor = scene.points[0].clone();
        anchor.name = "anchor2".into();
        anchor.position = [-760.0, 20.0, -200.0];
        scene.points.push(anchor);
        scene.lines.push(second);
        let forward = after(&scene, 10.0);
        scene.lines.reverse();
        scene.points.reverse();
        let backward = after(&scene, 10.0);
        assert_eq!(forward.lines[0], backward.lines[1]);
        assert_eq!(forward.lines[1], backward.lines[0]);
        assert_eq!(forward.points[0], backward.points[2]);
    }
}

#[test]
fn a_line_of_two_sections_of_one_type_is_that_line() {
    for integrator in INTEGRATORS {
        let mut scene = chain(integrator);
        scene.lines[0].sections[0].length = 835.0;
        let whole = after(&scene, 10.0);
        let section = &mut scene.lines[0].sections[0];
        (section.length, section.elements) = (835.0 / 4.0, Some(5));
        let mut rest = section.clone();
        (rest.length, rest.elements) = (835.0 * 0.75, Some(15));
        scene.lines[0].sections.push(rest);
        let split = after(&scene, 10.0);
        let apart = distance(&split, &whole, |r| r);
        assert!(apart < 1e-9, "{integrator:?}: {apart:e} m");
    }
}

#[test]
fn water_without_density_is_no_water() {
    for integrator in INTEGRATORS {
        let mut scene = chain(integrator);
        scene.water.as_mut().unwrap().density = 1e-12;
        let wet = after(&scene, 10.0);
        scene.water = None;
        let dry = after(&scene, 10.0);
        let apart = distance(&wet, &dry, |r| r);
        assert!(apart < 1e-8, "{integrator:?}: {apart:e} m");
    }
}

#[test]
fn what_rests_stays_at_rest() {
    for (name, _) in PUBLIC_SCENES {
        for integrator in INTEGRATORS {
            let mut scene = shipped(name);
            scene.motion.clear();
            scene.solver.integrator = integrator;
            let mut simulation = start(&scene);
            let (first, force) = (simulation.state().clone(), Vector3::from(simulation.end_force(1)));
            run(&mut simulation, 0.25, 400);
            let drift = distance(simulation.state(), &first, |r| r);
            assert!(drift < 1e-10, "{name}, {integrator:?}: {drift:e} m");
            let change = (Vector3::from(simulation.end_force(1)) - force).norm() / force.norm();
            assert!(change < 1e-10, "{name}, {integrator:?}: {change:e}");
        }
    }
}

#[test]
fn a_snapshot_put_back_replays_bit_for_bit() {
    for integrator in INTEGRATORS {
        let scene = chain(integrator);
        let motion = Motion::new(&scene.motion["fairlead"]);
        let mut simulation = start(&scene);
        let fairlead = simulation.model().point_index("fairlead").unwrap();
        let drive = |simulation: &mut Simulation, steps: std::ops::Range<usize>| {
            for k in steps {
                let step = [0.05, 0.08, 0.02][k % 3]; // deliberately irregular
                simulation.set_displacement(fairlead, motion.at(simulation.time()).position.into());
                simulation.advance(step).unwrap();
            }
        };
        drive(&mut simulation, 0..100);
        assert_replays(simulation, start(&scene), |simulation| {
            drive(simulation, 100..200)
        });
    }
}

/// If the nodes fill all lanes, the segment beyond the free end has zero length: the logarithm of its stretch must not affect the line.
#[test]
fn a_rope_of_logarithmic_strain_that_snaps_replays_whatever_its_elements() {
    for elements in 5..10 {
        let scene = format!(
            "line_types.rope = {{ mass = 2.0, axial_stiffness = 1.0e5, axial_damping = 300.0, strain = {{ logarithmic = 0.49 }} }}
            points = [
                {{ name = 'weight', position = [0.0, 0.0, -20.0], kind = 'free', mass = 50.0 }},
                {{ name = 'top', position = [0.0, 0.0, 0.0], kind = 'coupled' }},
            ]
            lines = [{{ name = 'rope', from = 'top', to = 'weight', sections = [{{ type = 'rope', length = 20.0, elements = {elements} }}] }}]
            solver.integrator = 'axial_implicit'
            motion.top = {{ x = [[1.0, 3.1]], z = [[3.0, 2.0]], ramp = 2.0 }}"
        );
        let scene = Scene::from_toml(&scene).unwrap_or_else(|error| panic!("{error}"));
        let mut straight = following(&scene);
        let mut put_back = straight.clone();
        for step in 0..200 {
            straight.advance(0.05).unwrap();
            put_back.restore(put_back.snapshot().clone());
            put_back.advance(0.05).unwrap();
            assert!(
                *straight.snapshot() == *put_back.snapshot(),
                "{elements} elements, step {step}"
            );
        }
    }
}

#[test]
fn a_step_goes_on_as_if_its_state_were_put_back_before_it() {
    for name in ["oc4_chain", "clump_weight", "storm_moored_semi"] {
        let mut straight = following(&shipped(name));
        let mut put_back = straight.clone();
        for step in [0.05, 0.05, 0.08, 0.3, 0.02, 0.05, 0.05] {
            straight.advance(step).unwrap();
            put_back.restore(put_back.snapshot().clone());
            put_back.advance(step).unwrap();
            assert!(straight.snapshot() == put_back.snapshot(), "{name}");
        }
    }
}

#[test]
fn a_step_that_fails_leaves_state_and_future_as_they_were() {
    for integrator in [Integrator::Leapfrog, Integrator::AxialImplicit] {
        let mut simulation = start(&chain(integrator));
        let fairlead = simulation.model().point_index("fairlead").unwrap();
        simulation.advance(0.05).unwrap();
        let mut spared = simulation.clone();
        simulation.set_displacement(fairlead, [3e5, 0.0, 0.0]);
        simulation.advance(0.05).unwrap_err();
        for simulation in [&mut simulation, &mut spared] {
            simulation.set_displacement(fairlead, [0.1, 0.0, 0.0]);
            simulation.advance(0.05).unwrap();
        }
        assert!(simulation.snapshot() == spared.snapshot(), "{integrator:?}");
    }
}

#[test]
fn a_step_of_no_length_changes_nothing() {
    for integrator in INTEGRATORS {
        let mut simulation = following(&chain(integrator));
        run(&mut simulation, 0.05, 50);
        let before = simulation.snapshot().clone();
        simulation.advance(0.0).unwrap();
        assert_eq!(*simulation.snapshot(), before);
    }
}

#[test]
fn a_slack_chain_above_its_anchor_weighs_what_hangs_though_segments_on_the_seabed_have_no_length() {
    let scene = draft(
        "water = { density = 1025.0 }
        seabed = { depth = 60.0 }
        solver = { integrator = 'axial_implicit' }
        line_types.chain = { mass = 126.0, diameter = 0.144, axial_stiffness = 5.5e8, drag_normal = 1.3, added_mass_normal = 1.0 }
        motion.fairlead = { x = [[1.0, 8.0]], z = [[0.5, 6.0]], ramp = 4.0 }",
    )
    .fixed("anchor", [0.0, 0.0, -60.0])
    .coupled("fairlead", [0.0, 0.0, -5.0])
    .line("line", ["anchor", "fairlead"], "chain", 60.0, 320)
    .scene();
    let mut chain = following(&scene);
    let weight = chain.tension_b(0);
    for _ in 0..120 {
        chain.advance(0.05).unwrap();
        let ratio = chain.tension_b(0) / weight;
        assert!((0.9..1.1).contains(&ratio), "{ratio}"); // its inertia is 5 %
    }
}

#[test]
fn one_long_communication_step_is_many_short_ones() {
    for integrator in INTEGRATORS {
        let scene = chain(integrator);
        let (mut long, mut short) = (following(&scene), following(&scene));
        run(&mut long, 1.0, 15);
        run(&mut short, 0.05, 300);
        let apart = distance(long.state(), short.state(), |r| r);
        assert!(apart < 1e-8, "{integrator:?}: {apart:e} m");
        assert_relative_eq!(long.end_force(1)[0], short.end_force(1)[0], max_relative = 1e-5);
    }
}

/// Energy of the first line [J]: kinetic, gravitational and elastic.
fn energy(simulation: &Simulation) -> f64 {
    let (model, state) = (simulation.model(), &simulation.state().lines[0]);
    let line = &model.lines[0];
    let node = |i: usize| {
        0.5 * line.nodes.mass[i] * state.velocity[i].norm_squared()
            + line.nodes.weight[i] * state.position[i].z
    };
    let segment = |i: usize| {
        let length = line.segments.length[i];
        let strain = (state.position[i + 1] - state.position[i]).norm() / length - 1.0;
        0.5 * line.segments.axial_stiffness[i] * length * strain.max(0.0).powi(2)
    };
    let nodes: f64 = (0..state.position.len()).map(node).sum();
    nodes + (0..line.segment_count()).map(segment).sum::<f64>()
}

#[test]
fn an_undamped_swing_keeps_its_energy_for_a_thousand_seconds() {
    let rope = draft("line_types.rope = { mass = 5.0, axial_stiffness = 1e6 }")
        .fixed("left", [0.0; 3])
        .fixed("right", [90.0, 0.0, 0.0])
        .line("rope", ["left", "right"], "rope", 100.0, 10);
    let rest = rope.start();
    let tilt = Rotation3::from_axis_angle(&Vector3::x_axis(), 0.2); // 11° out of its plane
    let tilted: Vec<Vector3<f64>> = nodes(&rest).iter().map(|r| tilt * r).collect();
    for (integrator, radius) in [
        (Integrator::Leapfrog, None),
        (Integrator::AxialImplicit, Some(1.0)),
        (Integrator::GeneralisedAlpha, Some(1.0)),
    ] {
        let mut scene = with_integrator(released_from(rope.scene(), &tilted), integrator, 0.05);
        scene.solver.spectral_radius = radius;
        let mut simulation = start(&scene);
        let first = energy(&simulation);
        let mut change: f64 = 0.0;
        for _ in 0..1000 {
            simulation.advance(1.0).unwrap();
            change = change.max((energy(&simulation) - first).abs());
        }
        let swing = first - energy(&rest);
        assert!(change < 5e-3 * swing, "{integrator:?}: {change} J of {swing} J");
    }
}

#[test]
fn forces_on_all_points_balance_weight_and_seabed() {
    for (name, _) in PUBLIC_SCENES {
        let simulation = start(&shipped(name));
        let line = &simulation.model().lines[0];
        let total: Vector3<f64> = [0, 1]
            .map(|point| Vector3::from(simulation.end_force(point)))
            .iter()
            .sum();
        let shape = &simulation.state().lines[0].position;
        let seabed: f64 = line.nodes.contact.as_ref().map_or(0.0, |contact| {
            let push = |i: usize| contact.push(i, shape, |_| Vector3::zeros()).z;
            (0..shape.len()).map(push).sum()
        });
        let weight: f64 = line.nodes.weight.iter().sum();
        assert_relative_eq!(total.z, seabed - weight, max_relative = 1e-9);
        assert_relative_eq!(total.xy().norm(), 0.0, epsilon = 1e-9 * weight.abs());
    }
}
