//! Networks of lines joined at free points, with implicit axial tension.

use crate::common::*;
use moorline::scene::{Integrator, MotionPath, Scene};

const IMPLICIT: Integrator = Integrator::AxialImplicit;

/// A 40 m rope in air between a fixed and a swaying point, whole or divided in the middle by a massless free point.
fn rope(cut: bool) -> Draft {
    let rope = draft(
        "line_types.rope = { mass = 20.0, axial_stiffness = 1e6, axial_damping = 2e3 }
        motion.high = { x = [[1.0, 3.0]], z = [[0.5, 2.0]], ramp = 4.0 }
        solver = { integrator = 'axial_implicit', time_step_max = 0.005 }",
    )
    .fixed("low", [0.0, 0.0, -20.0])
    .coupled("high", [34.0, 0.0, 0.0]);
    match cut {
        false => rope.line("rope", ["low", "high"], "rope", 40.0, 8),
        true => rope
            .free("middle", [17.0, 0.0, -11.0])
            .line("lower", ["low", "middle"], "rope", 20.0, 4)
            .line("upper", ["middle", "high"], "rope", 20.0, 4),
    }
}

#[test]
fn a_dry_rope_cut_by_a_free_point_without_mass_moves_as_the_whole() {
    let [mut whole, mut cut] = [false, true].map(|cut| following(&rope(cut).scene()));
    let (mut apart, mut peak) = (0.0_f64, 0.0_f64);
    for _ in 0..400 {
        run(&mut whole, 0.05, 1);
        run(&mut cut, 0.05, 1);
        let [one, other] = [whole.tension_b(0), cut.tension_b(1)];
        (apart, peak) = (apart.max((one - other).abs()), peak.max(one));
    }
    // iterations end if the tension changes by less than a thousandth of the greatest tension of a line
    assert!(apart < 1e-5 * peak, "{apart} N of {peak} N");
}

/// The clump weight on its lines without a seabed, with a fifth of its motion.
fn clump(step: f64) -> Scene {
    let mut scene = with_integrator(with_elements(shipped("clump_weight"), 10), IMPLICIT, step);
    scene.seabed = None;
    scene.lines.swap(0, 1); // a history records the tension of the first line, at its fairlead
    if let Some(MotionPath::Harmonic(motion)) = scene.motion.get_mut("fairlead") {
        for sine in motion.x.iter_mut().chain(&mut motion.z) {
            sine[0] *= 0.2;
        }
    }
    scene
}

#[test]
fn halving_the_step_of_a_line_with_a_clump_weight_quarters_the_error_at_least() {
    let steps = [0.025, 0.0125, 0.00625, 0.003125];
    let record = |step: f64| History::record(&mut following(&clump(step)), 0.05, 1200);
    let reference = record(0.05 / 256.0);
    let errors = steps.map(|step| record(step).tension_error(&reference, 400));
    assert!(errors[0] < 1e-3, "{errors:?}");
    assert_order_at_least(2.0, &steps, &errors);
}

#[test]
fn a_clump_weight_takes_a_twentieth_of_the_explicit_steps_and_has_the_same_tension() {
    let record = |integrator| {
        let scene = with_elements(shipped("clump_weight"), 20);
        let mut simulation = following(&with_integrator(scene, integrator, 0.05));
        let history = History::record(&mut simulation, 0.05, 1200);
        (history, simulation.substeps())
    };
    let ((explicit, many), (implicit, few)) = (record(Integrator::Leapfrog), record(IMPLICIT));
    let error = implicit.tension_error(&explicit, 400);
    assert!(error < 5e-3, "{error}");
    assert!(20 * few <= many, "{few} steps, {many} explicit ones");
}
