//! Long, fast and irregular motion, and communication steps of all sizes.

use moorline::scene::{Integrator, Scene};

use super::run::Run;
use super::scenes::*;
use super::{at_most, sound};

#[test]
fn a_line_dragged_through_its_touchdown_at_10_metres_a_second_loses_what_it_should() {
    for friction in [0.0, 0.5] {
        let converged = {
            let scene = with_elements(dragged_through_touchdown(friction), 160);
            Run::of(&by(scene, Integrator::Leapfrog, 0.01), 20.0, 0.05)
        };
        for integrator in INTEGRATORS {
            let run = Run::of(
                &by(dragged_through_touchdown(friction), integrator, 0.01),
                20.0,
                0.05,
            );
            let what = format!("dragged, friction {friction}, {integrator:?}");
            sound(&what, &run, 2e-2, 250.0);
            at_most(
                0.1,
                &format!("{what}, tension"),
                run.tension_error(&converged, 0.0),
            );
            at_most(
                0.1,
                &format!("{what}, slow tension"),
                run.slow_tension_error(&converged, 0.0, 0.5),
            );
            at_most(
                0.1,
                &format!("{what}, peak"),
                (run.peak() / converged.peak() - 1.0).abs(),
            );
        }
    }
}

/// The OC4 chain in irregular motion for some hours.
fn storm(integrator: Integrator, hours: f64) {
    let scene = by(irregular(shipped("oc4_chain"), 6.0, 12.0), integrator, 0.05);
    let run = Run::of(&scene, 3600.0 * hours, 0.5);
    let what = format!("{hours} h, {integrator:?}");
    sound(&what, &run, 2e-3, 200.0);
    // the ledger's error grows no faster than the energy that flows
    let share = run.error[run.error.len() - 1].abs() / run.flowed;
    at_most(2e-3, &format!("{what}, drift"), share);
}

#[test]
fn an_hour_of_irregular_motion_leaves_no_drift() {
    for integrator in [Integrator::Auto, Integrator::AxialImplicit] {
        storm(integrator, 1.0);
    }
}

#[test]
#[ignore = "half a minute"]
fn ten_hours_of_irregular_motion_leave_no_drift() {
    for integrator in [Integrator::Auto, Integrator::AxialImplicit] {
        storm(integrator, 10.0);
    }
}

#[test]
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
            answers(
                &format!("steps of {step} s, {integrator:?}"),
                &scene,
                steps,
                &truth,
                host,
            );
        }
        let what = format!("irregular steps, {integrator:?}");
        answers(&what, &scene, irregular_steps(200.0), &truth, 0.2);
    }
}

/// Claims that a scene in these communication steps [s] follows its own motion to the same end as `truth`, and follows a host's words within
/// a part [-] of the standard deviation of its tension.
fn answers(what: &str, scene: &Scene, steps: Vec<f64>, truth: &Run, host: f64) {
    let exact = Run::of_steps(scene, steps.iter().copied());
    let hosted = Run::hosted(scene, steps.into_iter(), say_slow);
    sound(what, &hosted, 2e-2, 1300.0);
    at_most(host, &format!("{what}, host"), hosted.tension_error(&exact, 50.0));
    let last = |run: &Run| run.tension[run.tension.len() - 1];
    let apart = (last(&exact) / last(truth) - 1.0).abs();
    at_most(1e-3, &format!("{what}, end"), apart);
}
