//! Lines and buoys in waves: forces against closed forms, orbits, order, energy, saved states, refusals.
//!
//! ```text
//!   ~~~~~η~~~~~~●~~~~~~    claim: force of the water -> Morison's formula with the velocity and acceleration of Airy waves
//!      (○)     ╱           claim: a line that weighs as much as water moves as the water does
//!       (o)   ╱
//!        ·   ● anchor
//! ```

use std::f64::consts::{PI, TAU};

use crate::common::*;
use approx::assert_relative_eq;
use moorline::model::{End, Model};
use moorline::scene::{Integrator, LineModel, Note, RegularWave, Scene, Sea, WaveComponents, Waves};
use moorline::simulation::Simulation;
use nalgebra::{Rotation3, Vector3};

/// Sets the waves of a scene to a sum of seas.
fn set_waves(scene: &mut Scene, seas: Vec<Sea>) {
    scene.water.as_mut().unwrap().waves = Some(Waves { seas });
}

fn regular(amplitude: f64, period: f64, direction: f64, ramp: Option<f64>) -> Vec<Sea> {
    let wave = RegularWave {
        amplitude: Some(amplitude),
        period,
        direction,
        ..RegularWave::default()
    };
    vec![Sea {
        regular: Some(wave),
        ramp,
        ..Sea::default()
    }]
}

/// Sum of the forces of a line on its two ends [N].
fn on_both_ends(simulation: &Simulation) -> Vector3<f64> {
    simulation.line_end_force(0, End::A) + simulation.line_end_force(0, End::B)
}

/// A short, stiff, vertical line of one element, fixed at one end and coupled at the other.
fn piece(waves: &str) -> Scene {
    draft(format!(
        "water = {{ density = {RHO}, waves = {waves}, current = {{ velocity = [0.3, -0.2, 0.0] }} }}
        line_types.rod = {{ mass = 100.0, diameter = 0.3, axial_stiffness = 1e9, drag_normal = 1.1, added_mass_normal = 0.9,
          added_mass_tangential = 0.2 }}"
    ))
    .fixed("low", [7.0, 3.0, -12.0])
    .coupled("high", [7.0, 3.0, -10.0])
    .line("rod", ["low", "high"], "rod", 2.0, 1)
    .scene()
}

#[test]
fn the_force_of_waves_on_a_held_piece_is_that_of_morison_and_airy() {
    let (amplitude, period, direction) = (0.8, 8.0, 0.6);
    let height = 2.0 * amplitude;
    let scene = piece(&format!(
        "{{ regular = {{ height = {height}, period = {period}, direction = {direction} }} }}"
    ));
    let mut simulation = start(&scene);
    let mut calm = scene;
    calm.water.as_mut().unwrap().waves = None;
    calm.water.as_mut().unwrap().current = None;
    let still = on_both_ends(&start(&calm));
    let omega = TAU / period;
    let k = omega * omega / G;
    let along = Vector3::new(f64::cos(direction), f64::sin(direction), 0.0);
    let displaced = RHO * 0.25 * PI * 0.3 * 0.3; // [kg/m]
    let (mut most, mut error) = (0.0_f64, 0.0_f64);
    for _ in 0..90 {
        simulation.advance(0.1).unwrap();
        let found = on_both_ends(&simulation) - still;
        let angle = k * Vector3::new(7.0, 3.0, 0.0).dot(&along) - omega * simulation.time();
        let half_node = |z: f64| {
            let decay = (k * (z - amplitude * angle.cos())).exp();
            let water = amplitude * omega * decay;
            let velocity = water * angle.cos() * along + Vector3::new(0.3, -0.2, 0.0);
            let level = omega * water * angle.sin() * along;
            let upward = -omega * water * angle.cos() * Vector3::z();
            0.5 * RHO * 0.3 * 1.1 * velocity.norm() * velocity + displaced * (1.9 * level + 1.2 * upward)
        };
        let expected = half_node(-12.0) + half_node(-10.0); // of 1 m each
        error = error.max((found - expected).norm());
        most = most.max(expected.norm());
    }
    assert!(most > 100.0);
    // in between, the slopes of the stretched velocity are those of linear theory, which causes an error of the order of (ka)², 2.5e-3 here
    assert!(error < 2e-3 * most, "{error} N of {most} N");
}

/// A rope along y with the weight of the displaced water, held only by a slack thread without hydrodynamic forces, at a depth [m].
fn drifter(depth: f64) -> Scene {
    let mass = RHO * 0.25 * PI * 0.2 * 0.2;
    draft(format!(
        "water = {{ density = {RHO} }}
        line_types.rope = {{ mass = {mass}, diameter = 0.2, axial_stiffness = 1e6, axial_damping = 1e4, drag_normal = 1.0,
          drag_tangential = 0.1, added_mass_normal = 1.0, added_mass_tangential = 0.3 }}
        line_types.thread = {{ mass = 1e-6, weight = 0.0, axial_stiffness = 1e-3 }}"
    ))
    .fixed("wall", [0.0, -105.0, -depth])
    .free("one", [0.0, -5.0, -depth])
    .free("two", [0.0, 5.0, -depth])
    .line("rope", ["one", "two"], "rope", 10.0, 5)
    .with("initial = 'straight'")
    .line("thread", ["wall", "one"], "thread", 110.0, 2)
    .with("initial = 'straight'")
    .scene()
}

#[test]
fn a_line_that_weighs_as_much_as_water_moves_in_the_orbits_of_the_water() {
    let (amplitude, period) = (0.6, 9.0);
    let k = (TAU / period).powi(2) / G;
    for integrator in JOINED {
        for depth in [8.0, 20.0, 40.0] {
            let mut scene = with_integrator(drifter(depth), integrator, 0.02);
            set_waves(&mut scene, regular(amplitude, period, 0.0, Some(4.0 * period)));
            let mut simulation = start(&scene);
            let mut places = Vec::new();
            while simulation.time() < 6.0 * period {
                simulation.advance(0.1).unwrap();
                if simulation.time() >= 5.0 * period {
                    places.push(nodes(&simulation)[2]);
                }
            }
            // without the Stokes drift, from the first position of a period to the last
            let drift = (places[places.len() - 1] - places[0]) / (places.len() - 1) as f64;
            let range = |axis: usize| {
                let values = places
                    .iter()
                    .enumerate()
                    .map(|(k, place)| place[axis] - k as f64 * drift[axis]);
                let most = values.clone().fold(f64::NEG_INFINITY, f64::max);
                0.5 * (most - values.fold(f64::INFINITY, f64::min))
            };
            let radius = amplitude * (-k * depth).exp();
            // the remaining drift and the stretching are of the order of ka, 3 % here
            for axis in [0, 2] {
                assert_relative_eq!(range(axis), radius, max_relative = 0.04);
            }
            assert!(range(1) < 1e-9);
        }
    }
}

/// A chain on a seabed, two legs of a bridle and a buoyant free point, in waves.
fn system(integrator: Integrator, waves: &str) -> Scene {
    let scene = draft(format!(
        "water = {{ density = {RHO}, waves = {waves} }}
        seabed = {{ depth = 100.0 }}
        line_types.chain = {{ mass = 120.0, diameter = 0.12, axial_stiffness = 2e8, drag_normal = 1.6, drag_tangential = 0.4,
          added_mass_normal = 1.0, added_mass_tangential = 1.0 }}
        line_types.rope = {{ mass = 20.0, diameter = 0.15, axial_stiffness = 3e7, drag_normal = 1.2, drag_tangential = 0.02,
          added_mass_normal = 1.0, added_mass_tangential = 1.0 }}"
    ))
    .fixed("anchor", [-260.0, 0.0, -100.0])
    .free("knot", [-30.0, 0.0, -40.0])
    .with("mass = 800.0, volume = 0.9, drag_area = 1.0, added_mass = 0.5")
    .coupled("left", [0.0, 15.0, -10.0])
    .coupled("right", [0.0, -15.0, -10.0])
    .line("chain", ["anchor", "knot"], "chain", 250.0, 24)
    .line("one", ["knot", "left"], "rope", 42.0, 8)
    .line("two", ["knot", "right"], "rope", 42.0, 8)
    .scene();
    with_integrator(scene, integrator, 0.02)
}

const STORM: &str = "{ spectrum = \"jonswap\", significant_height = 5.0, peak_period = 9.0, spreading = 8.0, seed = 7, components = 60, ramp = 10.0 }";

/// A line of 16 elements from a fixed point to one near the surface, in waves along x and y.
fn riser(integrator: Integrator, step: f64) -> Scene {
    let scene = draft(format!(
        "water = {{ density = {RHO}, waves = [{{ regular = {{ height = 4.0, period = 8.0, direction = 0.4 }}, ramp = 6.0 }},
          {{ components = [[0.5, 6.0, 1.9, 0.3]] }}] }}
        line_types.riser = {{ mass = 120.0, weight = 400.0, diameter = 0.25, axial_stiffness = 4e7, damping_ratio = 0.1,
          drag_normal = 1.1, drag_tangential = 0.05, added_mass_normal = 1.0, added_mass_tangential = 1.0 }}"
    ))
    .fixed("well", [0.0, 0.0, -100.0])
    .coupled("top", [30.0, -10.0, -4.0])
    .line("riser", ["well", "top"], "riser", 103.0, 16)
    .scene();
    with_integrator(scene, integrator, step)
}

#[test]
fn halving_the_time_step_quarters_the_error_in_waves() {
    for (integrator, coarse) in COARSE_STEPS {
        assert_second_order_in_time(coarse, |step| {
            let mut simulation = start(&riser(integrator, step));
            run(&mut simulation, 0.4, 25);
            nodes(&simulation)[8]
        });
    }
}

#[test]
fn the_energy_balance_closes_in_waves_at_second_order_or_at_any_step() {
    for (integrator, coarse) in COARSE_STEPS {
        assert_balance_order(integrator, coarse, 1e-4, |step| {
            let mut simulation = start(&balanced(riser(integrator, step)));
            run(&mut simulation, 0.4, 40);
            let flow = flow(&simulation);
            assert!(flow.external_work > 1e3 && flow.dissipation > 1e3, "{flow:?}");
            error_of_given(&simulation)
        });
    }
}

#[test]
fn the_energy_balance_closes_with_free_points_in_waves() {
    for integrator in JOINED {
        let mut scene = with_integrator(system(integrator, STORM), integrator, 0.005);
        scene.points[1].position[2] = -1.0; // at the surface
        scene.points[1].volume = Some(4.0);
        let mut simulation = start(&balanced(scene));
        run(&mut simulation, 0.1, 200);
        let error = error_of_given(&simulation);
        assert!(error < 5e-3, "{integrator:?}: {error:e}");
    }
}

#[test]
fn a_state_put_back_goes_on_to_the_last_bit() {
    let risers = INTEGRATORS.map(|integrator| riser(integrator, 0.02));
    let systems = JOINED.map(|integrator| system(integrator, STORM));
    for scene in risers.into_iter().chain(systems) {
        let mut simulation = start(&scene);
        run(&mut simulation, 0.05, 31);
        assert_replays(simulation, start(&scene), |simulation| {
            for step in [0.05, 0.05, 0.3, 1.7, 0.05, 0.02] {
                simulation.advance(step).unwrap();
            }
        });
    }
}

#[test]
fn long_and_short_communication_steps_meet_the_same_waves() {
    let after = |step: f64| {
        let mut simulation = start(&riser(Integrator::Leapfrog, 0.02));
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
    let range = greatest(short.iter().map(|b| (b - short[0]).abs()));
    for (a, b) in short.iter().zip(&long) {
        assert!((a - b).abs() < 0.01 * range, "{short:?} {long:?}");
    }
}

#[test]
fn small_waves_move_tensions_in_proportion_to_their_height() {
    let swing = |amplitude: f64| {
        let mut scene = riser(Integrator::AxialImplicit, 0.02);
        for kind in scene.line_types.values_mut() {
            (kind.drag_normal, kind.drag_tangential) = (None, None);
        }
        set_waves(&mut scene, regular(amplitude, 7.0, 0.4, Some(14.0)));
        let tension = History::record(&mut start(&scene), 0.1, 420).tension;
        tension
            .iter()
            .map(|t| (t - tension[0]) / amplitude)
            .collect::<Vec<_>>()
    };
    let (small, smaller) = (swing(2e-3), swing(1e-3));
    let most = greatest(small.iter().map(|a| a.abs()));
    assert!(most > 100.0, "{most} N/m");
    for (a, b) in small.iter().zip(&smaller) {
        assert!((a - b).abs() < 5e-3 * most, "{a} {b} N/m");
    }
}

#[test]
fn a_seed_gives_the_same_record_and_another_seed_another() {
    let record = |seed: u64| {
        let mut scene = system(Integrator::Leapfrog, STORM);
        scene.water.as_mut().unwrap().waves.as_mut().unwrap().seas[0].seed = Some(seed);
        History::record(&mut start(&scene), 0.25, 80).tension
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
            let mut simulation = start(scene);
            for k in 0..60 {
                let x = (0.05 * f64::from(k)).sin();
                simulation.set_displacement(1, [x, 0.3 * x, 0.1 * x]);
                simulation.advance(0.05).unwrap();
            }
            simulation.state().clone()
        };
        let still = swaying(&scene);
        let rows = WaveComponents::Rows(vec![[0.0, 6.0, 0.0, 0.0]]);
        set_waves(
            &mut scene,
            vec![Sea {
                components: Some(rows),
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
        let original = History::record(&mut start(&scene), 0.1, 100);
        for point in &mut scene.points {
            point.position = (turn * Vector3::from(point.position)).into();
        }
        let waves = scene.water.as_mut().unwrap().waves.as_mut().unwrap();
        waves.seas[0].regular.as_mut().unwrap().direction += 0.7;
        if let Some(WaveComponents::Rows(rows)) = &mut waves.seas[1].components {
            rows[0][2] += 0.7;
        }
        let turned = History::record(&mut start(&scene), 0.1, 100);
        let image: Vec<Vector3<f64>> = original.middle.iter().map(|place| turn * place).collect();
        assert!(gap(&image, &turned.middle) < 1e-7, "{integrator:?}");
    }
}

#[test]
fn waves_push_along_the_way_they_travel() {
    // a vertical line in waves along y sways in the plane of y and z
    let mut scene = riser(Integrator::Leapfrog, 0.02);
    scene.points[1].position = [0.0, 0.0, -1.0];
    set_waves(&mut scene, regular(2.0, 8.0, 0.5 * PI, Some(8.0)));
    let mut simulation = start(&scene);
    let (mut along, mut across) = (0.0_f64, 0.0_f64);
    for _ in 0..200 {
        simulation.advance(0.1).unwrap();
        along = along.max(greatest(nodes(&simulation).iter().map(|node| node.y.abs())));
        across = across.max(greatest(nodes(&simulation).iter().map(|node| node.x.abs())));
    }
    assert!(along > 0.05 && across < 1e-9 * along, "{along} {across}");
}

#[test]
fn a_ramp_begins_at_the_forces_of_still_water() {
    for integrator in INTEGRATORS {
        let scene = riser(integrator, 0.02);
        let mut calm = scene.clone();
        calm.water.as_mut().unwrap().waves = None;
        assert_eq!(start(&scene).end_force(1), start(&calm).end_force(1));
    }
}

#[test]
fn a_buoy_rides_on_long_waves() {
    let tether = draft(format!(
        "water = {{ density = {RHO} }}
        line_types.tether = {{ mass = 1.0, weight = 0.0, diameter = 0.02, axial_stiffness = 1e3, drag_normal = 1.0 }}"
    ))
    .fixed("anchor", [0.0, 0.0, -60.0])
    .free("buoy", [0.0; 3])
    .with("mass = 2000.0, volume = 4.0, drag_area = 2.0, added_mass = 0.5")
    .line("tether", ["anchor", "buoy"], "tether", 60.5, 8)
    .scene();
    for integrator in JOINED {
        let mut scene = with_integrator(tether.clone(), integrator, 0.02);
        let (amplitude, period) = (1.5, 16.0);
        set_waves(&mut scene, regular(amplitude, period, 0.0, Some(32.0)));
        let mut simulation = start(&scene);
        let rest = place(&simulation, "buoy").z;
        let (mut highest, mut lowest) = (0.0_f64, 0.0_f64);
        while simulation.time() < 80.0 {
            simulation.advance(0.1).unwrap();
            if simulation.time() > 60.0 {
                let z = place(&simulation, "buoy").z - rest;
                (highest, lowest) = (highest.max(z), lowest.min(z));
            }
        }
        assert_relative_eq!(0.5 * (highest - lowest), amplitude, max_relative = 0.08);
    }
}

/// A buoy of 5 m³ held 5 m below the surface by a tether, in a wave of 4 m and 7 s and these further components.
fn tethered(further: &str) -> Scene {
    draft(format!(
        "water.density = {RHO}
        water.waves = {{ components = [[2.0, 7.0, 0.0, 0.0]{further}], ramp = 8.0 }}
        line_types.tether = {{ mass = 15.0, diameter = 0.08, axial_stiffness = 3e6, axial_damping = 9e3, drag_normal = 1.2, added_mass_normal = 1.0 }}"
    ))
    .coupled("anchor", [0.0, 0.0, -15.0])
    .free("buoy", [0.0, 0.0, -5.0])
    .with("mass = 2500.0, volume = 5.0, drag_area = 2.0, added_mass = 0.5")
    .line("tether", ["anchor", "buoy"], "tether", 10.0, 12)
    .scene()
}

#[test]
fn components_that_cancel_do_not_move_a_tethered_buoy() {
    // they only make the waves be sampled more finely; with straight paths between the samples the force differed by 4 %
    let record = |further: &str| History::record(&mut following(&tethered(further)), 0.05, 800);
    let fine = record(", [0.05, 0.8, 0.3, 0.5], [0.05, 0.8, 0.3, 3.641592653589793]");
    let error = record("").tension_error(&fine, 400);
    assert!(error < 0.002, "{error}");
}

#[test]
fn scenes_with_waves_survive_being_written_and_read() {
    for waves in [
        STORM,
        "{ regular = { height = 4.0, period = 8.0 } }",
        "[{ regular = { amplitude = 4.0, period = 18.0, direction = 1.0, phase = 0.5 } }, { spectrum = \"pierson_moskowitz\", significant_height = 2.0, peak_period = 6.0 }]",
        "{ components = [[1.0, 8.0, 0.0, 0.0], [0.5, 5.0, 0.3, 1.0]], ramp = 20.0 }",
    ] {
        assert_written_and_read(&system(Integrator::Leapfrog, waves));
    }
}

#[test]
fn waves_do_not_act_on_beams_or_quasi_static_lines_and_say_so() {
    let says = |scene: &Scene, words: &str| {
        let mistakes = scene.mistakes();
        let mut found = mistakes.iter().filter(|mistake| mistake.at == "water.waves");
        assert!(
            found.any(|mistake| mistake.problem.contains(words)),
            "{mistakes:?}"
        );
    };
    let mut scene = riser(Integrator::QuasiStatic, 0.02);
    says(&scene, "waves move no line that is quasi-static");
    scene.solver.integrator = Integrator::Auto;
    scene
        .line_types
        .values_mut()
        .for_each(|kind| kind.model = LineModel::Beam);
    says(&scene, "beams are modelled in still water only");
    let mut dry = system(Integrator::Auto, STORM);
    for kind in dry.line_types.values_mut() {
        (kind.model, kind.diameter) = (LineModel::Beam, None);
    }
    says(&dry, "point \"knot\" is in the water at the end of a beam");
}

#[test]
fn check_says_which_waves_there_are_and_what_is_not_modelled() {
    let storm = in_words(&system(Integrator::Auto, STORM));
    assert_says(
        &storm,
        &[
            "linear (Airy) waves in a water depth of 100 m",
            "JONSWAP spectrum, peak enhancement 3.3, significant height 5 m, peak period 9 s",
            "60 components of equal energy, seed 7",
            "with a ramp of 10 s",
            "Wheeler stretching",
            "no drift, wave breaking or wave-current interaction",
        ],
    );
    assert!(!storm.contains("Not modelled: waves"), "{storm}");
    let two = in_words(&riser(Integrator::Auto, 0.02));
    assert_says(
        &two,
        &[
            "a regular wave of height 4 m and period 8 s",
            "of significant height in total",
        ],
    );
}

#[test]
fn waves_that_would_break_and_seas_without_a_ramp_are_remarked_on() {
    let mut scene = riser(Integrator::Auto, 0.02);
    set_waves(&mut scene, regular(5.0, 6.0, 0.0, None));
    let notes = scene.notes();
    for said in ["a height of 10 m and a period of 6 s breaks", "no `ramp`"] {
        assert!(notes.iter().any(|note| note.text.contains(said)), "{notes:?}");
    }
}

#[test]
fn a_piece_at_the_surface_is_wet_under_crests_and_dry_over_troughs() {
    for integrator in INTEGRATORS {
        let scene = draft(format!(
            "water = {{ density = {RHO}, waves = {{ regular = {{ amplitude = 1.0, period = 40.0 }} }} }}
            line_types.rod = {{ mass = 100.0, diameter = 0.3, axial_stiffness = 1e9, added_mass_normal = 0.9 }}"
        ))
        .fixed("left", [0.0, -1.0, 0.0])
        .coupled("right", [0.0, 1.0, 0.0])
        .line("rod", ["left", "right"], "rod", 2.0, 1)
        .with("initial = 'straight'")
        .scene();
        let mut simulation = start(&with_integrator(scene, integrator, 0.05));
        let lift = |simulation: &Simulation| on_both_ends(simulation).z;
        let displaced = RHO * 0.25 * PI * 0.3 * 0.3;
        let dry = -200.0 * G;
        let pressed = 2.0 * displaced * 1.9 * (TAU / 40.0_f64).powi(2);
        let wet = dry + 2.0 * displaced * G - pressed;
        assert_relative_eq!(lift(&simulation), wet, max_relative = 1e-3);
        run(&mut simulation, 0.5, 40);
        assert_relative_eq!(lift(&simulation), dry, max_relative = 1e-3);
    }
}

#[test]
fn the_energy_balance_closes_where_lines_pierce_the_surface_of_waves() {
    for integrator in INTEGRATORS {
        let errors = [0.01, 0.005].map(|step| {
            let mut scene = riser(integrator, step);
            scene.points[1].position = [30.0, -10.0, 3.0];
            scene.lines[0].sections[0].elements = Some(40);
            scene.lines[0].sections[0].length = 110.0;
            let mut simulation = start(&balanced(scene));
            assert!(simulation.model().lines[0].surface.is_some());
            run(&mut simulation, 0.4, 60);
            error_of_given(&simulation)
        });
        assert!(errors[1] < 2e-3, "{integrator:?}: {errors:?}");
    }
}

#[test]
fn spectra_without_a_seed_are_different_seas() {
    let sea = "spectrum = 'jonswap', significant_height = 3.0, peak_period = 8.0";
    let waves = |seas: &str| {
        let keys = format!(
            "water = {{ density = 1025.0, waves = {seas} }}\nline_types.rope = {{ mass = 1.0, diameter = 0.02, axial_stiffness = 1e4 }}"
        );
        draft(keys)
            .fixed("a", [0.0; 3])
            .coupled("b", [9.0, 0.0, 0.0])
            .line("l", ["a", "b"], "rope", 10.0, 4)
            .scene()
    };
    let height = |scene: &Scene, t: f64| Model::new(scene).unwrap().waves.unwrap().elevation(0.0, 0.0, t);
    let [one, both] = [
        format!("{{ {sea} }}"),
        format!("[{{ {sea} }}, {{ {sea}, direction = 1.57 }}]"),
    ];
    let alone = height(&waves(&one), 10.0);
    assert!((height(&waves(&both), 10.0) / alone - 2.0).abs() > 0.01);
    let same = waves(&format!("[{{ {sea} }}, {{ {sea}, direction = 1.57, seed = 0 }}]"));
    let note = |note: &&Note| note.at == "water.waves[1]" && note.text.contains("same seed as sea 0");
    assert_eq!(same.notes().iter().filter(note).count(), 1);
    assert_eq!(waves(&both).notes().iter().filter(note).count(), 0);
}
