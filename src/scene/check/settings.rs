//! Solver and output.

use super::{Bounds, Findings, number, quantity};
use crate::scene::channel::Channel;
use crate::scene::table::Choice;
use crate::scene::{AXIAL_RADIUS_MIN, Integrator, Scene};

/// Most output steps of a run.
const STEPS_MAX: f64 = 1e7;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    check_solver(scene, findings);
    check_output(scene, findings);
}

fn check_solver(scene: &Scene, findings: &mut Findings) {
    let solver = &scene.solver;
    if let Some(radius) = solver.spectral_radius {
        let at = "solver.spectral_radius";
        let least = match solver.integrator {
            Integrator::AxialImplicit => AXIAL_RADIUS_MIN,
            _ => 0.0,
        };
        findings.number(at, radius, Bounds::Within(least, 1.0), "-");
        if !matches!(
            solver.integrator,
            Integrator::Auto | Integrator::AxialImplicit | Integrator::GeneralisedAlpha
        ) {
            let problem = format!(
                "the integrator is \"{}\", and a spectral radius belongs to \"generalised_alpha\" and \"axial_implicit\"",
                solver.integrator.word()
            );
            findings.say(at, problem);
        }
    }
    if let Some(bossak) = &solver.bossak {
        if solver.integrator != Integrator::Bossak {
            let problem = format!(
                "the integrator is \"{}\": write integrator = \"bossak\" or leave these parameters out",
                solver.integrator.word()
            );
            findings.say("solver.bossak", problem);
        }
        // -1/3 as a decimal may be rounded either way.
        if !(-1.0 / 3.0 - 1e-6..=0.0).contains(&bossak.alpha) {
            let problem = format!("{} is not between -1/3 and 0", number(bossak.alpha));
            findings.say("solver.bossak.alpha", problem);
        }
    }
}

fn check_output(scene: &Scene, findings: &mut Findings) {
    let output = &scene.output;
    for (i, name) in output.channels.iter().enumerate() {
        let at = format!("output.channels[{i}]");
        if let Err(problem) = Channel::parse(name).and_then(|channel| channel.check(scene)) {
            findings.say(at, problem);
        } else if output.channels[..i].contains(name) {
            findings.say(at, format!("the channel `{name}` is given twice"));
        }
    }
    if output.interval <= 0.0 || output.duration <= 0.0 {
        return; // out of bounds
    }
    if output.interval > output.duration {
        let problem = format!(
            "{} is longer than the duration of {}",
            quantity(output.interval, "s"),
            quantity(output.duration, "s")
        );
        findings.say("output.interval", problem);
    } else if output.duration / output.interval > STEPS_MAX {
        let problem = format!(
            "{} in steps of {} is more than 1e7 steps: give a longer interval or a shorter duration",
            quantity(output.duration, "s"),
            quantity(output.interval, "s")
        );
        findings.say("output.interval", problem);
    }
}
