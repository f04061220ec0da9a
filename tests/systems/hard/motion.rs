//! Long, fast and irregular motion, and communication steps of all sizes.

use moorline::scene::{Integrator, Scene};

use super::Case;
use super::run::Run;
use super::scenes::*;

#[test]
fn a_line_dragged_through_its_touchdown_at_10_metres_a_second_loses_what_it_should() {
    for friction in [0.0, 0.5] {
        let converged = {
            let scene = with_elements(dragged_through_touchdown(friction), 160);
            Run::of(&by(scene, Integrator::Leapfrog, 0.01), 20.0, 0.05)
        };
        for integrator in INTEGRATORS {
            let scene = by(dragged_through_touchdown(friction), integrator, 0.01);
            let run = Run::of(&scene, 20.0, 0.05);
            let case = Case(format!("dragged, friction {friction}, {integrator:?}"));
            case.sound(&run, 2e-2, 250.0);
            case.at_most(0.1, "tension", run.tension_error(&converged, 0.0));
            case.at_most(0.1, "slow tension", run.slow_tension_error(&converged, 0.0, 0.5));
            case.at_most(0.1, "peak", (run.peak() / converged.peak() - 1.0).abs());
        }
    }
}

/// The OC4 chain in irregular motion for `hours` hours.
fn storm(integrator: Integrator, hours: f64) {
    let scene = by(irregular(shipped("oc4_chain"), 6.0, 12.0), integrator, 0.05);
    let run = Run::of(&scene, 3600.0 * hours, 0.5);
    let case = Case(format!("{hours} h, {integrator:?}"));
    case.sound(&run, 2e-3, 200.0);
    // the error of the energy balance grows no faster than the transferred energy
    let share = run.error[run.error.len() - 1].abs() / run.flowed;
    case.at_most(2e-3, "drift", share);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn an_hour_of_irregular_motion_leaves_no_drift() {
    for integrator in [Integrator::Auto, Integrator::AxialImplicit] {
        storm(integrator, 1.0);
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn ten_hours_of_irregular_motion_leave_no_drift() {
    for integrator in [Integrator::Auto, Integrator::AxialImplicit] {
        storm(integrator, 10.0);
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn communication_steps_from_a_millisecond_to_ten_seconds_give_one_answer() {
    for integrator in INTEGRATORS {
        let scene = by(slowly_moved(), integrator, 0.1);
        let truth = Run::of(&scene, 200.0, 0.1);
        for (step, host) in [
            (0.001_f64, 1e-3),
            (0.01, 1e-3),
            (0.1, 1e-3),
            (1.0, 2e-3),
            (10.0, 0.2),
        ] {
            if integrator == Integrator::GeneralisedAlpha && step == 0.001 {
                continue; // 200 000 solves
            }
            let steps = vec![step; (200.0 / step).round() as usize];
            let case = Case(format!("steps of {step} s, {integrator:?}"));
            answers(&case, &scene, steps, &truth, host);
        }
        let case = Case(format!("irregular steps, {integrator:?}"));
        answers(&case, &scene, irregular_steps(200.0), &truth, 0.2);
    }
}

/// Asserts that a scene with these communication steps [s] follows its own motion to the same end as `truth`, and that with a host the
/// error relative to the standard deviation of the tension is at most `host` [-].
fn answers(case: &Case, scene: &Scene, steps: Vec<f64>, truth: &Run, host: f64) {
    let exact = Run::of_steps(scene, steps.iter().copied());
    let hosted = Run::hosted(scene, steps.into_iter(), say_slow);
    case.sound(&hosted, 2e-2, 1300.0);
    case.at_most(host, "host", hosted.tension_error(&exact, 50.0));
    let last = |run: &Run| run.tension[run.tension.len() - 1];
    let apart = (last(&exact) / last(truth) - 1.0).abs();
    case.at_most(1e-3, "end", apart);
}
