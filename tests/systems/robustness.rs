//! Coarse runs of difficult lines. None may diverge.

use crate::common::*;
use moorline::scene::{Integrator, MotionPath, Scene};

/// A change that makes a scene more difficult.
type Change = fn(&mut Scene);

fn scale_seabed(scene: &mut Scene) {
    if let Some(seabed) = &mut scene.seabed {
        seabed.stiffness *= 100.0;
        seabed.damping *= 100.0;
    }
}

/// Multiplies the axial stiffness of all line types.
fn scale_stiffness(scene: &mut Scene, factor: f64) {
    let types = scene.line_types.values_mut();
    types
        .flat_map(|kind| &mut kind.axial_stiffness)
        .for_each(|stiffness| *stiffness *= factor);
}

/// Multiplies the axial damping of all line types.
fn scale_damping(scene: &mut Scene, factor: f64) {
    for line_type in scene.line_types.values_mut() {
        line_type.axial_damping = line_type.axial_damping.map(|damping| factor * damping);
    }
}

/// Multiplies both drag coefficients of all line types.
fn scale_drag(scene: &mut Scene, factor: f64) {
    for line_type in scene.line_types.values_mut() {
        line_type.drag_normal = line_type.drag_normal.map(|drag| factor * drag);
        line_type.drag_tangential = line_type.drag_tangential.map(|drag| factor * drag);
    }
}

fn double_motion(scene: &mut Scene) {
    for path in scene.motion.values_mut() {
        let MotionPath::Harmonic(motion) = path else {
            continue;
        };
        let axes = [&mut motion.x, &mut motion.y, &mut motion.z];
        axes.into_iter().flatten().for_each(|sine| sine[0] *= 2.0);
    }
}

const CHANGES: [(&str, Change); 9] = [
    ("as it is", |_| ()),
    ("seabed × 100", scale_seabed),
    ("EA × 0.1", |scene| scale_stiffness(scene, 0.1)),
    ("EA × 10", |scene| scale_stiffness(scene, 10.0)),
    ("BA = 0", |scene| scale_damping(scene, 0.0)),
    ("BA × 10", |scene| scale_damping(scene, 10.0)),
    ("no drag", |scene| scale_drag(scene, 0.0)),
    ("drag × 5", |scene| scale_drag(scene, 5.0)),
    ("motion × 2", double_motion),
];

/// Greatest tension in a coarse run, relative to the static tension at the fairlead [-].
fn greatest_tension(scene: &Scene, duration: f64) -> f64 {
    let mut simulation = following(scene);
    let at_rest = simulation.tension_b(0);
    let mut greatest: f64 = 0.0;
    for _ in 0..(duration / 0.05) as usize {
        simulation.advance(0.05).unwrap();
        greatest = greatest.max(simulation.tension_max(0));
        assert!(nodes(&simulation).iter().all(|r| r.norm() < 2000.0));
    }
    greatest / at_rest
}

/// Runs every public scene with every change and 10 to 80 elements, except those that `spared` excludes.
fn none_blows_up(integrator: Integrator, spared: impl Fn(&str, &str, usize) -> bool) {
    for (name, _) in PUBLIC_SCENES {
        let duration = if name.starts_with("lindahl") { 10.0 } else { 30.0 };
        for (what, change) in CHANGES {
            for n in [10, 20, 40, 80] {
                if spared(name, what, n) {
                    continue;
                }
                let mut scene = with_elements(shipped(name), n);
                scene.solver.integrator = integrator;
                change(&mut scene);
                let greatest = greatest_tension(&scene, duration);
                assert!(greatest < 16.0, "{name}, {what}, {n} elements: {greatest}");
            }
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn no_hard_scene_blows_up_by_the_leapfrog() {
    none_blows_up(Integrator::Leapfrog, |_, what, n| what == "BA × 10" && n == 80); // steps of 10 µs
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn no_hard_scene_blows_up_by_the_integrator_chosen_for_it() {
    none_blows_up(Integrator::Auto, |name, what, n| {
        name == "lindahl_fast" && what == "EA × 10" && n >= 40
    });
}

#[test]
fn a_snap_of_eleven_times_the_static_tension_does_not_blow_up() {
    for n in [40, 80] {
        let mut scene = with_elements(shipped("lindahl_fast"), n);
        scale_stiffness(&mut scene, 10.0);
        let greatest = greatest_tension(&scene, 10.0);
        assert!(
            greatest < 16.0,
            "{n} elements: {greatest} times the static tension"
        );
    }
}

#[test]
fn a_mass_on_a_stiff_line_of_one_element_hangs_still() {
    let mut simulation = draft("line_types.wire = { mass = 0.1, axial_stiffness = 1e7 }")
        .fixed("pivot", [0.0; 3])
        .free("bob", [0.0, 0.0, -10.0])
        .with("mass = 1.0")
        .line("wire", ["pivot", "bob"], "wire", 10.0, 1)
        .start();
    let first = place(&simulation, "bob");
    run(&mut simulation, 0.05, 400);
    assert!((place(&simulation, "bob") - first).norm() < 1e-9);
}

#[test]
fn the_axial_implicit_leapfrog_moves_free_points() {
    let wire = draft(
        "line_types.wire = { mass = 1.0, axial_stiffness = 1e5 }\nsolver.integrator = 'axial_implicit'",
    )
    .fixed("pivot", [0.0; 3])
    .free("end", [5.0, 0.0, -8.0])
    .line("wire", ["pivot", "end"], "wire", 10.0, 10)
    .with("initial = 'straight'");
    let mut simulation = wire.start();
    simulation.advance(1.0).unwrap();
    assert!(place(&simulation, "end").z < -8.1);
}
