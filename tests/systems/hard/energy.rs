//! Snaps, damping, jumps and resonance: energy transferred in bursts.

use moorline::scene::{Integrator, Reconstruction};

use super::Case;
use super::run::Run;
use super::scenes::*;

/// Time step of generalised-α [s].
const IMPLICIT_STEP: f64 = 0.002;
/// Period of the circular fairlead motion of Lindahl's chain [s].
const TURN: f64 = 1.25;

/// Lindahl's chain over the first 12 periods.
fn snapping(elements: usize, integrator: Integrator, damping: f64) -> Run {
    let scene = with_elements(shipped("lindahl_fast"), elements);
    let scene = more_damped(by(scene, integrator, IMPLICIT_STEP), damping);
    Run::of(&scene, 12.0 * TURN, 0.005)
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn snaps_after_slack_peak_as_in_a_converged_run() {
    let converged = snapping(160, Integrator::Leapfrog, 1.0);
    for integrator in INTEGRATORS {
        let case = Case(format!("snap, {integrator:?}"));
        let run = snapping(40, integrator, 1.0);
        case.sound(&run, 1e-2, 1300.0);
        for turn in 6..12 {
            let span = [turn, turn + 1].map(|turn| TURN * f64::from(turn));
            let peak = run.peak_between(span[0], span[1]);
            let truth = converged.peak_between(span[0], span[1]);
            case.at_most(0.02, &format!("peak of turn {turn}"), (peak / truth - 1.0).abs());
            let turn = |t: &f64| (span[0]..span[1]).contains(t);
            let samples = run.time.iter().zip(&run.tension).filter(|(t, _)| turn(t));
            let slack = samples.filter(|(_, tension)| **tension < 0.02 * truth).count();
            assert!(slack > 0, "{}: slack in every turn", case.0);
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn ten_times_the_damping_and_none_keep_the_energy_balance() {
    for integrator in INTEGRATORS {
        for (damping, balance, steps) in [(10.0, 1e-2, 9000.0), (0.0, 6e-2, 1300.0)] {
            let run = snapping(40, integrator, damping);
            let case = Case(format!("damping × {damping}, {integrator:?}"));
            case.sound(&run, balance, steps);
            case.at_most(1e-4, "gain", run.energy_gain());
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn undamped_ropes_that_slacken_gain_no_energy() {
    for elements in [20, 40, 80] {
        for integrator in INTEGRATORS {
            let scene = by(undamped_swing(elements), integrator, 0.005);
            let run = Run::of(&scene, 60.0, 0.1);
            let case = Case(format!("undamped swing of {elements}, {integrator:?}"));
            case.sound(&run, 2e-2, 1000.0);
            case.at_most(1e-3, "gain", run.energy_gain());
        }
    }
}

/// A line whose fairlead jumps by 1 m after a second, for one minute.
fn jump(name: &str, integrator: Integrator, reconstruction: Reconstruction) -> Run {
    let mut scene = by(shipped(name), integrator, 0.01);
    scene.solver.input_reconstruction = reconstruction;
    Run::hosted(&scene, std::iter::repeat_n(JUMP[1], 2400), jumped)
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_fairlead_that_jumps_by_a_metre_leaves_a_line_that_settles() {
    for name in ["oc3_catenary", "taut_polyester"] {
        let mut moved = shipped(name);
        moved.points[1].position[0] += 1.0;
        let rest = Run::of(&moved, 0.0, 1.0).tension[0];
        for integrator in INTEGRATORS {
            for reconstruction in [Reconstruction::Smooth, Reconstruction::Jump] {
                let run = jump(name, integrator, reconstruction);
                let case = Case(format!("jump, {name}, {integrator:?}, {reconstruction:?}"));
                // a jump makes waves as short as an element, which explicit steps resolve worst
                let balance = match reconstruction {
                    Reconstruction::Jump => 0.1,
                    _ => 0.02,
                };
                case.sound(&run, balance, 250.0);
                case.at_most(3.0, "peak over the start", run.peak() / run.tension[0]);
                let last = run.tension[run.tension.len() - 1];
                case.at_most(2e-3, "settled", (last / rest - 1.0).abs());
            }
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn resonance_at_the_axial_frequency_is_limited_as_in_a_damped_rod() {
    let omega = rod_frequency();
    for integrator in INTEGRATORS {
        let mut scene = by(resonant_rod(40, omega), integrator, 0.001);
        if integrator == Integrator::AxialImplicit {
            scene.solver.time_step_max = 0.0025;
        }
        let run = Run::of(&scene, 40.0, 0.005);
        let case = Case(format!("resonance, {integrator:?}"));
        case.sound(&run, 2e-2, 1500.0);
        let exact = rod_amplitude(omega);
        case.at_most(0.01, "amplitude", (run.last_amplitude() / exact - 1.0).abs());
    }
}
