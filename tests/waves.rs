//! Lines and buoys in waves: forces against closed forms, orbits, order, energy, saved states, refusals.
//!
//! ```text
//!   ~~~~~η~~~~~~●~~~~~~    claim: force of the water -> Morison's formula with the velocity and acceleration of Airy waves
//!      (○)     ╱           claim: what weighs as much as water moves as the water does
//!       (o)   ╱
//!        ·   ● anchor
//! ```

mod common;

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use common::*;
use moorline::model::End;
use moorline::scene::{Integrator, LineModel, RegularWave, Scene, Sea, WaveComponents, Waves};
use moorline::simulation::{Simulation, Snapshot};
use nalgebra::{Rotation3, Vector3};

const INTEGRATORS: [Integrator; 3] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
];

const DENSITY: f64 = 1025.0;
const GRAVITY: f64 = 9.80665;

/// Waves of a scene as a sum of seas.
fn set_waves(scene: &mut Scene, seas: Vec<Sea>) {
    scene.water.as_mut().unwrap().waves = Some(Waves { seas });
}

fn regular(amplitude: f64, period: f64, direction: f64, ramp: Option<f64>) -> Vec<Sea> {
    vec![Sea {
        regular: Some(RegularWave {
            amplitude: Some(amplitude),
            period,
            direction,
            ..RegularWave::default()
        }),
        ramp,
        ..Sea::default()
    }]
}

/// A stiff upright piece of line, held at both ends, of one element.
fn piece(waves: &str) -> Scene {
    scene(&format!(
        r#"
        water = {{ density = {DENSITY}, waves = {waves}, current = {{ velocity = [0.3, -0.2, 0.0] }} }}
        line_types.rod = {{ mass = 100.0, diameter = 0.3, axial_stiffness = 1e9, drag_normal = 1.1, added_mass_normal = 0.9, added_mass_tangential = 0.2 }}
        points = [
          {{ name = "low", position = [7.0, 3.0, -12.0], kind = "fixed" }},
          {{ name = "high", position = [7.0, 3.0, -10.0], kind = "coupled" }},
        ]
        lines = [{{ name = "rod", from = "low", to = "high", sections = [{{ type = "rod", length = 2.0, elements = 1 }}] }}]
        "#
    ))
}

#[test]
fn the_water_presses_a_held_piece_as_morison_and_airy_say() {
    let (amplitude, period, direction) = (0.8, 8.0, 0.6);
    let waves = format!(
        "{{ regular = {{ height = {}, period = {period}, direction = {direction} }} }}",
        2.0 * amplitude
    );
    let mut simulation = Simulation::new(&piece(&waves)).unwrap();
    let still = {
        let mut scene = piece(&waves);
        scene.water.as_mut().unwrap().waves = None;
        scene.water.as_mut().unwrap().current = None;
        let simulation = Simulation::new(&scene).unwrap();
        simulation.line_end_force(0, End::A) + simulation.line_end_force(0, End::B)
    };
    let omega = TAU / period;
    let k = omega * omega / GRAVITY;
    let along = Vector3::new(f64::cos(direction), f64::sin(direction), 0.0);
    let displaced = DENSITY * 0.25 * PI * 0.3 * 0.3; // [kg/m]
    let (mut greatest, mut error) = (0.0_f64, 0.0_f64);
    for _ in 0..90 {
        simulation.advance(0.1).unwrap();
        let found = simulation.line_end_force(0, End::A) + simulation.line_end_force(0, End::B) - still;
        let angle = k * Vector3::new(7.0, 3.0, 0.0).dot(&along) - omega * simulation.time();
        let half_node = |z: f64| {
            let decay = (k * (z - amplitude * angle.cos())).exp();
            let water = amplitude * omega * decay;
            let velocity = water * angle.cos() * along + Vector3::new(0.3, -0.2, 0.0);
            let level = omega * water * angle.sin() * along;
            let upward = -omega * water * angle.cos() * Vector3::z();
            0.5 * DENSITY * 0.3 * 1.1 * velocity.norm() * velocity + displaced * (1.9 * level + 1.2 * upward)
        };
        let expected = half_node(-12.0) + half_node(-10.0); // of 1 m each
        error = error.max((found - expected).norm());
        greatest = greatest.max(expected.norm());
    }
    assert!(greatest > 100.0);
    // the slopes of the stretched velocity are those of the linear theory: an error of the order of (ka)², 2.5e-3 here, in between
    assert!(error < 2e-3 * greatest, "{error} N of {greatest} N");
}

/// A rope along y that weighs as much as water, held by nothing but a slack thread that the water does not feel, at a depth [m].
fn drifter(depth: f64) -> Scene {
    let mass = DENSITY * 0.25 * PI * 0.2 * 0.2;
    scene(&format!(
        r#"
        water = {{ density = {DENSITY} }}
        line_types.rope = {{ mass = {mass}, diameter = 0.2, axial_stiffness = 1e6, axial_damping = 1e4, drag_normal = 1.0, drag_tangential = 0.1, added_mass_normal = 1.0, added_mass_tangential = 0.3 }}
        line_types.thread = {{ mass = 1e-6, weight = 0.0, axial_stiffness = 1e-3 }}
        points = [
          {{ name = "wall", position = [0.0, -105.0, -{depth}], kind = "fixed" }},
          {{ name = "one", position = [0.0, -5.0, -{depth}], kind = "free" }},
          {{ name = "two", position = [0.0, 5.0, -{depth}], kind = "free" }},
        ]
        lines = [
          {{ name = "rope", from = "one", to = "two", initial = "straight", sections = [{{ type = "rope", length = 10.0, elements = 5 }}] }},
          {{ name = "thread", from = "wall", to = "one", initial = "straight", sections = [{{ type = "thread", length = 110.0, elements = 2 }}] }},
        ]
        "#
    ))
}

#[test]
fn what_weighs_as_much_as_water_goes_round_as_the_water_does() {
    let (amplitude, period) = (0.6, 9.0);
    let k = (TAU / period).powi(2) / GRAVITY;
    for integrator in [Integrator::Leapfrog, Integrator::GeneralisedAlpha] {
        for depth in [8.0, 20.0, 40.0] {
            let mut scene = with_integrator(drifter(depth), integrator, 0.02);
            set_waves(&mut scene, regular(amplitude, period, 0.0, Some(4.0 * period)));
            let mut simulation = Simulation::new(&scene).unwrap();
            let mut places = Vec::new();
            while simulation.time() < 6.0 * period {
                simulation.advance(0.1).unwrap();
                if simulation.time() >= 5.0 * period {
                    places.push(simulation.state().lines[0].position[2]);
                }
            }
            // without the drift of Stokes, from the first place of a period to the last
            let drift = (places[places.len() - 1] - places[0]) / (places.len() - 1) as f64;
            let range = |axis: usize| {
                let way = |k: usize| k as f64 * drift[axis];
                let values = places.iter().enumerate();
                let values = values.map(|(k, place)| place[axis] - way(k));
                let most = values.clone().fold(f64::NEG_INFINITY, f64::max);
                0.5 * (most - values.fold(f64::INFINITY, f64::min))
            };
            let radius = amplitude * (-k * depth).exp();
            // what is left of the drift and the stretching are of the order of ka, 3 % here
            for axis in [0, 2] {
                assert_relative_eq!(range(axis), radius, max_relative = 0.04);
            }
            assert!(range(1) < 1e-9);
        }
    }
}

/// A chain on a bed, two legs of a bridle and a buoyant free point, in waves.
fn system(integrator: Integrator, waves: &str) -> Scene {
    let text = format!(
        r#"
        water = {{ density = {DENSITY}, waves = {waves} }}
        seabed = {{ depth = 100.0 }}
        line_types.chain = {{ mass = 120.0, diameter = 0.12, axial_stiffness = 2e8, drag_normal = 1.6, drag_tangential = 0.4, added_mass_normal = 1.0, added_mass_tangential = 1.0 }}
        line_types.rope = {{ mass = 20.0, diameter = 0.15, axial_stiffness = 3e7, drag_normal = 1.2, drag_tangential = 0.02, added_mass_normal = 1.0, added_mass_tangential = 1.0 }}
        points = [
          {{ name = "anchor", position = [-260.0, 0.0, -100.0], kind = "fixed" }},
          {{ name = "knot", position = [-30.0, 0.0, -40.0], kind = "free", mass = 800.0, volume = 0.9, drag_area = 1.0, added_mass = 0.5 }},
          {{ name = "left", position = [0.0, 15.0, -10.0], kind = "coupled" }},
          {{ name = "right", position = [0.0, -15.0, -10.0], kind = "coupled" }},
        ]
        lines = [
          {{ name = "chain", from = "anchor", to = "knot", sections = [{{ type = "chain", length = 250.0, elements = 24 }}] }},
          {{ name = "one", from = "knot", to = "left", sections = [{{ type = "rope", length = 42.0, elements = 8 }}] }},
          {{ name = "two", from = "knot", to = "right", sections = [{{ type = "rope", length = 42.0, elements = 8 }}] }},
        ]
        "#
    );
    with_integrator(scene(&text), integrator, 0.02)
}

const STORM: &str = "{ spectrum = \"jonswap\", significant_height = 5.0, peak_period = 9.0, spreading = 8.0, seed = 7, components = 60, ramp = 10.0 }";

/// A line from a fixed point to one near the surface, of 16 elements, in waves along x and y.
fn riser(integrator: Integrator, step: f64) -> Scene {
    let text = format!(
        r#"
        water = {{ density = {DENSITY}, waves = [{{ regular = {{ height = 4.0, period = 8.0, direction = 0.4 }}, ramp = 6.0 }}, {{ components = [[0.5, 6.0, 1.9, 0.3]] }}] }}
        line_types.riser = {{ mass = 120.0, weight = 400.0, diameter = 0.25, axial_stiffness = 4e7, damping_ratio = 0.1, drag_normal = 1.1, drag_tangential = 0.05, added_mass_normal = 1.0, added_mass_tangential = 1.0 }}
        points = [
          {{ name = "well", position = [0.0, 0.0, -100.0], kind = "fixed" }},
          {{ name = "top", position = [30.0, -10.0, -4.0], kind = "coupled" }},
        ]
        lines = [{{ name = "riser", from = "well", to = "top", sections = [{{ type = "riser", length = 103.0, elements = 16 }}] }}]
        "#
    );
    with_integrator(scene(&text), integrator, step)
}

#[test]
fn halving_the_time_step_quarters_the_error_in_waves() {
    for (integrator, coarse) in [
        (Integrator::Leapfrog, 4e-3),
        (Integrator::AxialImplicit, 4e-2),
        (Integrator::GeneralisedAlpha, 4e-2),
    ] {
        let steps = [1.0, 0.5, 0.25, 0.125, 1.0 / 32.0].map(|part| part * coarse);
        let middles = steps.map(|step| {
            let mut simulation = Simulation::new(&riser(integrator, step)).unwrap();
            for _ in 0..25 {
                simulation.advance(0.4).unwrap();
            }
            simulation.state().lines[0].position[8]
        });
        let errors: Vec<f64> = middles[..4].iter().map(|m| (m - middles[4]).norm()).collect();
        assert_order(2.0, &steps[..4], &errors);
    }
}

#[test]
fn the_ledger_closes_in_waves_at_second_order_or_at_any_step() {
    for (integrator, coarse) in [
        (Integrator::Leapfrog, 4e-3),
        (Integrator::AxialImplicit, 4e-2),
        (Integrator::GeneralisedAlpha, 4e-2),
    ] {
        let steps = [1.0, 0.5, 0.25, 0.125].map(|part| part * coarse);
        let errors = steps.map(|step| {
            let mut simulation = Simulation::new(&riser(integrator, step)).unwrap();
            for _ in 0..40 {
                simulation.advance(0.4).unwrap();
            }
            let flow = &simulation.ledger().flow;
            assert!(flow.given > 1e3 && flow.lost > 1e3, "{flow:?}");
            simulation.energy_error().abs() / flow.given
        });
        assert!(errors[3] < 1e-4, "{integrator:?}: {errors:?}");
        match integrator {
            Integrator::AxialImplicit => assert_order(2.0, &steps, &errors),
            Integrator::GeneralisedAlpha => assert!(errors[0] < 1e-8, "{errors:?}"), // what Newton's method leaves
            _ => {}
        }
    }
}

#[test]
fn the_ledger_closes_with_free_points_in_waves() {
    for integrator in [Integrator::Leapfrog, Integrator::GeneralisedAlpha] {
        let mut scene = with_integrator(system(integrator, STORM), integrator, 0.005);
        scene.points[1].position[2] = -1.0; // at the surface
        scene.points[1].volume = Some(4.0);
        let mut simulation = Simulation::new(&scene).unwrap();
        for _ in 0..200 {
            simulation.advance(0.1).unwrap();
        }
        let flow = &simulation.ledger().flow;
        let error = simulation.energy_error().abs() / flow.given;
        assert!(error < 5e-3, "{integrator:?}: {error:e} of {flow:?}");
    }
}

#[test]
fn a_state_put_back_goes_on_to_the_last_bit() {
    let scenes = INTEGRATORS.map(|integrator| riser(integrator, 0.02));
    let joined = [Integrator::Leapfrog, Integrator::GeneralisedAlpha];
    for scene in scenes
        .into_iter()
        .chain(joined.map(|integrator| system(integrator, STORM)))
    {
        let mut simulation = Simulation::new(&scene).unwrap();
        for _ in 0..31 {
            simulation.advance(0.05).unwrap();
        }
        let saved = postcard::to_stdvec(simulation.snapshot()).unwrap();
        let on = |mut simulation: Simulation| {
            for step in [0.05, 0.05, 0.3, 1.7, 0.05, 0.02] {
                simulation.advance(step).unwrap();
            }
            simulation.snapshot().clone()
        };
        let straight = on(simulation.clone());
        let mut fresh = Simulation::new(&scene).unwrap();
        fresh.restore(postcard::from_bytes::<Snapshot>(&saved).unwrap());
        assert!(straight == on(fresh));
        let mut back = simulation.clone();
        back.restore(straight);
        back.restore(simulation.snapshot().clone());
        assert!(on(back) == on(simulation));
    }
}

#[test]
fn long_and_short_communication_steps_meet_the_same_waves() {
    let after = |step: f64| {
        let mut simulation = Simulation::new(&riser(Integrator::Leapfrog, 0.02)).unwrap();
        let mut tensions = Vec::new();
        for k in 1..=(24.0_f64 / step).round() as usize {
            simulation.advance(step).unwrap();
            if (k as f64 * step / 2.0).fract() < 1e-9 {
                tensions.push(simulation.tension_b(0));
            }
        }
        tensions
    };
    let (short, long) = (after(0.05), after(2.0));
    let range = short.iter().fold(0.0_f64, |a, b| a.max((b - short[0]).abs()));
    for (a, b) in short.iter().zip(&long) {
        assert!((a - b).abs() < 0.01 * range, "{short:?} {long:?}");
    }
}

#[test]
fn small_waves_move_tensions_in_proportion_to_their_height() {
    let swing = |amplitude: f64| {
        let mut scene = riser(Integrator::AxialImplicit, 0.02);
        scene.line_types.values_mut().for_each(|line_type| {
            (line_type.drag_normal, line_type.drag_tangential) = (None, None);
        });
        set_waves(&mut scene, regular(amplitude, 7.0, 0.4, Some(14.0)));
        let mut simulation = Simulation::new(&scene).unwrap();
        let rest = simulation.tension_b(0);
        let mut swing = Vec::new();
        for _ in 0..420 {
            simulation.advance(0.1).unwrap();
            swing.push((simulation.tension_b(0) - rest) / amplitude);
        }
        swing
    };
    let (small, smaller) = (swing(2e-3), swing(1e-3));
    let greatest = small.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    assert!(greatest > 100.0, "{greatest} N/m");
    for (a, b) in small.iter().zip(&smaller) {
        assert!((a - b).abs() < 5e-3 * greatest, "{a} {b} N/m");
    }
}

#[test]
fn a_seed_gives_the_same_record_and_another_seed_another() {
    let record = |seed: u64| {
        let mut scene = system(Integrator::Leapfrog, STORM);
        scene.water.as_mut().unwrap().waves.as_mut().unwrap().seas[0].seed = Some(seed);
        History::record(&mut Simulation::new(&scene).unwrap(), 0.25, 80).tension
    };
    let first = record(7);
    assert_eq!(first, record(7));
    assert_ne!(last(&first, 1), last(&record(8), 1));
}

#[test]
fn waves_of_no_height_are_still_water_bit_for_bit() {
    for integrator in INTEGRATORS {
        let mut scene = riser(integrator, 0.02);
        scene.water.as_mut().unwrap().waves = None;
        let swaying = |scene: &Scene| {
            let mut simulation = Simulation::new(scene).unwrap();
            for k in 0..60 {
                let x = (0.05 * f64::from(k)).sin();
                simulation.set_displacement(1, [x, 0.3 * x, 0.1 * x]);
                simulation.advance(0.05).unwrap();
            }
            simulation.state().clone()
        };
        let still = swaying(&scene);
        set_waves(
            &mut scene,
            vec![Sea {
                components: Some(WaveComponents::Rows(vec![[0.0, 6.0, 0.0, 0.0]])),
                ..Sea::default()
            }],
        );
        let calm = swaying(&scene);
        assert_eq!(still.lines, calm.lines, "{integrator:?}");
        assert_eq!(still.points, calm.points, "{integrator:?}");
    }
}

#[test]
fn a_scene_turned_about_the_vertical_with_its_waves_moves_alike() {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7);
    for integrator in INTEGRATORS {
        let mut scene = riser(integrator, 0.02);
        let original = History::record(&mut Simulation::new(&scene).unwrap(), 0.1, 100);
        for point in &mut scene.points {
            point.position = (turn * Vector3::from(point.position)).into();
        }
        let waves = scene.water.as_mut().unwrap().waves.as_mut().unwrap();
        waves.seas[0].regular.as_mut().unwrap().direction += 0.7;
        if let Some(WaveComponents::Rows(rows)) = &mut waves.seas[1].components {
            rows[0][2] += 0.7;
        }
        let turned = History::record(&mut Simulation::new(&scene).unwrap(), 0.1, 100);
        for (old, new) in original.middle.iter().zip(&turned.middle) {
            assert!((turn * old - new).norm() < 1e-7, "{integrator:?}");
        }
    }
}

#[test]
fn waves_push_along_the_way_they_travel() {
    // a line that hangs along z in waves along y sways in the plane of y and z
    let mut scene = riser(Integrator::Leapfrog, 0.02);
    scene.points[1].position = [0.0, 0.0, -1.0];
    set_waves(&mut scene, regular(2.0, 8.0, 0.5 * PI, Some(8.0)));
    let mut simulation = Simulation::new(&scene).unwrap();
    let (mut along, mut across) = (0.0_f64, 0.0_f64);
    for _ in 0..200 {
        simulation.advance(0.1).unwrap();
        for node in &simulation.state().lines[0].position {
            along = along.max(node.y.abs());
            across = across.max(node.x.abs());
        }
    }
    assert!(along > 0.05 && across < 1e-9 * along, "{along} {across}");
}

#[test]
fn a_ramp_begins_at_the_forces_of_still_water() {
    for integrator in INTEGRATORS {
        let scene = riser(integrator, 0.02);
        let mut calm = scene.clone();
        calm.water.as_mut().unwrap().waves = None;
        let (waves, still) = (Simulation::new(&scene).unwrap(), Simulation::new(&calm).unwrap());
        assert_eq!(waves.end_force(1), still.end_force(1));
    }
}

#[test]
fn a_buoy_rides_on_long_waves() {
    for integrator in [Integrator::Leapfrog, Integrator::GeneralisedAlpha] {
        let text = format!(
            r#"
            water = {{ density = {DENSITY} }}
            line_types.tether = {{ mass = 1.0, weight = 0.0, diameter = 0.02, axial_stiffness = 1e3, drag_normal = 1.0 }}
            points = [
              {{ name = "anchor", position = [0.0, 0.0, -60.0], kind = "fixed" }},
              {{ name = "buoy", position = [0.0, 0.0, 0.0], kind = "free", mass = 2000.0, volume = 4.0, drag_area = 2.0, added_mass = 0.5 }},
            ]
            lines = [{{ name = "tether", from = "anchor", to = "buoy", sections = [{{ type = "tether", length = 60.5, elements = 8 }}] }}]
            "#
        );
        let mut scene = with_integrator(scene(&text), integrator, 0.02);
        let (amplitude, period) = (1.5, 16.0);
        set_waves(&mut scene, regular(amplitude, period, 0.0, Some(32.0)));
        let mut simulation = Simulation::new(&scene).unwrap();
        let rest = simulation.state().points[1].position.z;
        let mut highest = 0.0_f64;
        let mut lowest = 0.0_f64;
        while simulation.time() < 80.0 {
            simulation.advance(0.1).unwrap();
            if simulation.time() > 60.0 {
                let z = simulation.state().points[1].position.z - rest;
                (highest, lowest) = (highest.max(z), lowest.min(z));
            }
        }
        assert_relative_eq!(0.5 * (highest - lowest), amplitude, max_relative = 0.08);
    }
}

#[test]
fn scenes_with_waves_survive_being_written_and_read() {
    for waves in [
        STORM,
        "{ regular = { height = 4.0, period = 8.0 } }",
        "[{ regular = { amplitude = 4.0, period = 18.0, direction = 1.0, phase = 0.5 } }, { spectrum = \"pierson_moskowitz\", significant_height = 2.0, peak_period = 6.0 }]",
        "{ components = [[1.0, 8.0, 0.0, 0.0], [0.5, 5.0, 0.3, 1.0]], ramp = 20.0 }",
    ] {
        let original = system(Integrator::Leapfrog, waves);
        let text = original.to_toml();
        assert_eq!(Scene::from_toml(&text).unwrap(), original, "{text}");
    }
}

fn refused(waves: &str, place: &str, problem: &str) {
    let text = system(Integrator::Auto, STORM).to_toml();
    let start = text.find("[water.waves]").unwrap();
    let end = start + text[start..].find("\n[").unwrap_or(text.len() - start);
    let text = format!("{}{}", &text[..start], &text[end..]);
    let text = text.replacen(
        "density = 1025.0",
        &format!("density = 1025.0\nwaves = {waves}"),
        1,
    );
    let message = Scene::from_toml(&text).unwrap_err().to_string();
    assert!(message.contains(place) && message.contains(problem), "{message}");
}

#[test]
fn every_mistake_in_waves_is_refused_with_its_place() {
    refused("{}", "water.waves", "a sea needs");
    refused("[]", "water.waves", "no sea in the array");
    refused("3.0", "water.waves", "expected a sea");
    refused(
        "{ regular = { height = 1.0, period = 0.0 } }",
        "water.waves.regular.period",
        "is not between 0.05",
    );
    refused(
        "{ regular = { height = -1.0, period = 5.0 } }",
        "water.waves.regular.height",
        "is not positive",
    );
    refused(
        "{ regular = { period = 5.0 } }",
        "water.waves.regular",
        "either its `height` or its `amplitude`",
    );
    refused(
        "{ regular = { height = 1.0, amplitude = 0.5, period = 5.0 } }",
        "water.waves.regular",
        "either",
    );
    refused("{ regular = { height = 1.0 } }", "regular", "period");
    refused(
        "{ components = [[1.0, 5.0, 0.0]] }",
        "water.waves.components[0]",
        "an array of 4 numbers",
    );
    refused(
        "{ components = [[1.0, -5.0, 0.0, 0.0]] }",
        "water.waves.components[0][1]",
        "is not between",
    );
}

#[test]
fn every_mistake_in_a_spectrum_is_refused_with_its_place() {
    let spectrum = |rest: &str| format!("{{ spectrum = \"jonswap\", {rest} }}");
    refused("{ components = 50 }", "water.waves", "a sea needs");
    refused(
        &spectrum("significant_height = 2.0"),
        "water.waves",
        "missing key `peak_period` [s]",
    );
    refused(
        &spectrum("significant_height = 2.0, peak_period = 8.0, peakedness = 12.0"),
        "water.waves.peakedness",
        "is not between 1 and 10",
    );
    refused(
        &spectrum("significant_height = 2.0, peak_period = 8.0, components = 0"),
        "water.waves.components",
        "is not between 1 and 100000",
    );
    refused(
        &spectrum("significant_height = 2.0, peak_period = 8.0, ramp = 0.0"),
        "water.waves.ramp",
        "is not positive",
    );
    refused(
        "{ spectrum = \"pierson_moskowitz\", significant_height = 2.0, peak_period = 8.0, peakedness = 2.0 }",
        "water.waves.peakedness",
        "only a JONSWAP",
    );
    refused(
        "{ spectrum = \"bretschneider\", significant_height = 2.0, peak_period = 8.0 }",
        "water.waves.spectrum",
        "pierson_moskowitz",
    );
    refused(
        "{ regular = { height = 1.0, period = 5.0 }, seed = 4 }",
        "water.waves.seed",
        "belongs to a spectrum",
    );
    refused(
        "[{ regular = { height = 1.0, period = 5.0 }, ramp = 4.0 }, { regular = { height = 1.0, period = 9.0 }, ramp = 5.0 }]",
        "water.waves[1].ramp",
        "write one ramp",
    );
    refused("{ swell = 1.0 }", "swell", "unknown key");
}

#[test]
fn waves_do_not_act_on_beams_or_quasi_static_lines_and_say_so() {
    let mut scene = riser(Integrator::QuasiStatic, 0.02);
    let said = |scene: &Scene, words: &str| {
        let mistakes = scene.mistakes();
        assert!(
            mistakes
                .iter()
                .any(|m| m.at == "water.waves" && m.problem.contains(words)),
            "{mistakes:?}"
        );
    };
    said(&scene, "waves move no line that is quasi-static");
    scene.solver.integrator = Integrator::Auto;
    scene
        .line_types
        .values_mut()
        .for_each(|line_type| line_type.model = LineModel::Beam);
    said(&scene, "beams are modelled in still water only");
    let mut dry = system(Integrator::Auto, STORM);
    for line_type in dry.line_types.values_mut() {
        (line_type.model, line_type.diameter) = (LineModel::Beam, None);
    }
    said(&dry, "point \"knot\" is in the water at the end of a beam");
}

#[test]
fn check_tells_the_waves_and_what_is_left_out() {
    let words = |scene: &Scene| {
        let words = scene.in_words();
        words.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let storm = words(&system(Integrator::Auto, STORM));
    for said in [
        "linear waves (Airy) over a depth of 100 m",
        "a JONSWAP spectrum of peakedness 3.3, significant height 5 m, peak period 9 s",
        "60 wave trains of equal energy drawn with the seed 7",
        "growing over a ramp of 10 s",
        "stretched to the surface as Wheeler does",
        "no drift, no breaking",
    ] {
        assert!(storm.contains(said), "{said}: {storm}");
    }
    assert!(!storm.contains("Not modelled: waves"), "{storm}");
    let two = words(&riser(Integrator::Auto, 0.02));
    assert!(
        two.contains("a regular wave of height 4 m and period 8 s"),
        "{two}"
    );
    assert!(two.contains("together of a significant height of"), "{two}");
}

#[test]
fn waves_that_would_break_and_seas_without_a_ramp_are_remarked_on() {
    let mut scene = riser(Integrator::Auto, 0.02);
    set_waves(&mut scene, regular(5.0, 6.0, 0.0, None));
    let notes = scene.notes();
    for said in ["a wave of 10 m and 6 s breaks", "no `ramp`"] {
        assert!(notes.iter().any(|note| note.text.contains(said)), "{notes:?}");
    }
}

/// A MoorDyn deck of a buoyed line that asks for waves and a current, with files of these beside it.
fn deck(folder: &std::path::Path, waves: &str, current: &str) -> std::path::PathBuf {
    let deck = include_str!("decks/moordyn_v1.dat");
    let options = "80     WtrDpth\n7  WaveKin\n1  Currents";
    let path = folder.join("mooring.dat");
    std::fs::write(&path, deck.replace("80     WtrDpth", options)).unwrap();
    std::fs::write(folder.join("wave_frequencies.txt"), waves).unwrap();
    std::fs::write(folder.join("current_profile.txt"), current).unwrap();
    path
}

const DECK_WAVES: &str = "0.0 0.0 0.0\n0.6 0.0 1.2\n0.9 0.4 0.0 0.5\n";
const DECK_CURRENT: &str = "--- steady currents ---\nprofile\nz ux uy uz\n-80.0 0.1 0.0 0\n0.0 0.7 0.2 0\n";

#[test]
fn a_deck_of_moordyn_brings_its_waves_and_current_from_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = deck(folder.path(), DECK_WAVES, DECK_CURRENT);
    let loaded = moorline::scene::load(&path).unwrap();
    let water = loaded.scene.water.as_ref().unwrap();
    let current = water.current.as_ref().unwrap();
    let profile = vec![[-80.0, 0.1, 0.0], [0.0, 0.7, 0.2]];
    assert_eq!(current.profile.as_ref().unwrap(), &profile);
    let mut simulation = Simulation::new(&loaded.scene).unwrap();
    let waves = simulation.model().waves.clone().unwrap();
    for t in [0.0, 2.0, 31.0] {
        // MoorDyn's sum: |A| sin(ωt + arg A) at the origin
        let expected = 1.2 * (0.6 * t + 0.5 * PI).sin() + 0.4 * (0.9_f64 * t).sin();
        assert_relative_eq!(waves.elevation(0.0, 0.0, t), expected, epsilon = 1e-12);
    }
    simulation.advance(0.1).unwrap();
    let text = loaded.to_commented_toml();
    assert_eq!(Scene::from_toml(&text).unwrap(), loaded.scene, "{text}");
    assert!(
        loaded
            .notes
            .iter()
            .any(|note| note.text.contains("wave_frequencies.txt"))
    );
}

#[test]
fn a_scene_names_files_of_waves_and_current_as_a_deck_does() {
    let folder = tempfile::tempdir().unwrap();
    deck(folder.path(), DECK_WAVES, DECK_CURRENT);
    let path = folder.path().join("scene.toml");
    let original = system(Integrator::Auto, "{ regular = { height = 1.0, period = 5.0 } }");
    let text = original.to_toml().replace(
        "[water.waves.regular]",
        "[water.current]\nfile = \"current_profile.txt\"\n[water.waves]\nfile = \"wave_frequencies.txt\"\n[nothing]",
    );
    let start = text.find("[nothing]").unwrap();
    let end = start + text[start..].find("\n[").unwrap();
    std::fs::write(&path, format!("{}{}", &text[..start], &text[end..])).unwrap();
    let scene = moorline::scene::load(&path).unwrap().scene;
    let water = scene.water.as_ref().unwrap();
    assert_eq!(water.current.as_ref().unwrap().profile.as_ref().unwrap().len(), 2);
    assert_eq!(
        Simulation::new(&scene)
            .unwrap()
            .model()
            .waves
            .as_ref()
            .unwrap()
            .components()
            .len(),
        2
    );
    std::fs::remove_file(folder.path().join("wave_frequencies.txt")).unwrap();
    let refusal = format!("{:?}", moorline::scene::load(&path).unwrap_err());
    assert!(refusal.contains("no such file"), "{refusal}");
}

#[test]
fn a_deck_whose_files_are_wrong_is_refused_with_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = deck(folder.path(), "0.6 0.0\n", DECK_CURRENT);
    let refusal = format!("{:?}", moorline::scene::load(&path).unwrap_err());
    assert!(
        refusal.contains("wave_frequencies.txt, line 1: expected 3 or 4 numbers"),
        "{refusal}"
    );
}

#[test]
fn a_piece_at_the_surface_is_wet_under_crests_and_dry_over_troughs() {
    for integrator in INTEGRATORS {
        let scene = scene(&format!(
            r#"
            water = {{ density = {DENSITY}, waves = {{ regular = {{ amplitude = 1.0, period = 40.0 }} }} }}
            solver = {{ integrator = "leapfrog" }}
            line_types.rod = {{ mass = 100.0, diameter = 0.3, axial_stiffness = 1e9, added_mass_normal = 0.9 }}
            points = [
              {{ name = "left", position = [0.0, -1.0, 0.0], kind = "fixed" }},
              {{ name = "right", position = [0.0, 1.0, 0.0], kind = "coupled" }},
            ]
            lines = [{{ name = "rod", from = "left", to = "right", initial = "straight", sections = [{{ type = "rod", length = 2.0, elements = 1 }}] }}]
            "#
        ));
        let mut simulation = Simulation::new(&with_integrator(scene, integrator, 0.05)).unwrap();
        let lift = |simulation: &Simulation| {
            simulation.line_end_force(0, End::A).z + simulation.line_end_force(0, End::B).z
        };
        let displaced = DENSITY * 0.25 * PI * 0.3 * 0.3;
        let dry = -200.0 * GRAVITY;
        let pressed = 2.0 * displaced * 1.9 * (TAU / 40.0_f64).powi(2);
        assert_relative_eq!(
            lift(&simulation),
            dry + 2.0 * displaced * GRAVITY - pressed,
            max_relative = 1e-3
        );
        for _ in 0..40 {
            simulation.advance(0.5).unwrap();
        }
        assert_relative_eq!(lift(&simulation), dry, max_relative = 1e-3);
    }
}

#[test]
fn the_ledger_closes_where_lines_pierce_the_surface_of_waves() {
    for integrator in INTEGRATORS {
        let errors = [0.01, 0.005].map(|step| {
            let mut scene = riser(integrator, step);
            scene.points[1].position = [30.0, -10.0, 3.0];
            scene.lines[0].sections[0].elements = Some(40);
            scene.lines[0].sections[0].length = 110.0;
            let mut simulation = Simulation::new(&scene).unwrap();
            assert!(simulation.model().lines[0].surface.is_some());
            for _ in 0..60 {
                simulation.advance(0.4).unwrap();
            }
            simulation.energy_error().abs() / simulation.ledger().flow.given
        });
        assert!(errors[1] < 2e-3, "{integrator:?}: {errors:?}");
    }
}
