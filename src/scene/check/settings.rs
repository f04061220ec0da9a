//! Solver and output.

use super::{Bounds, Findings, number, quantity};
use crate::scene::channel::Channel;
use crate::scene::{AXIAL_RADIUS_MIN, Integrator, Scene, Threads};

/// Most elements of a line alone [-].
const ELEMENTS_MAX: usize = 100_000;
/// Most threads [-].
const THREADS_MAX: usize = 256;
/// Most output steps of a run.
const STEPS_MAX: f64 = 1e7;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    check_solver(scene, findings);
    check_output(scene, findings);
}

fn check_solver(scene: &Scene, findings: &mut Findings) {
    let solver = &scene.solver;
    let tolerance = Bounds::Within(1e-12, 0.5);
    findings.number("solver.tolerance", solver.tolerance, tolerance, "-");
    if solver
        .elements
        .is_some_and(|elements| !(1..=ELEMENTS_MAX).contains(&elements))
    {
        let problem = format!("a line alone has 1 to {ELEMENTS_MAX} elements");
        findings.say("solver.elements", problem);
    }
    let step = Bounds::Positive(1e4);
    findings.number("solver.time_step_max", solver.time_step_max, step, "s");
    if let Threads::Number(number) = solver.threads
        && !(1..=THREADS_MAX).contains(&number)
    {
        let problem = format!("{number} is not between 1 and {THREADS_MAX}");
        findings.say("solver.threads", problem);
    }
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
                integrator_name(solver.integrator)
            );
            findings.say(at, problem);
        }
    }
    if let Some(bossak) = &solver.bossak {
        if solver.integrator != Integrator::Bossak {
            let problem = format!(
                "the integrator is \"{}\": write integrator = \"bossak\" or leave these parameters out",
                integrator_name(solver.integrator)
            );
            findings.say("solver.bossak", problem);
        }
        // -1/3 as a decimal may be rounded either way.
        if !(-1.0 / 3.0 - 1e-6..=0.0).contains(&bossak.alpha) {
            let problem = format!("{} is not between -1/3 and 0", number(bossak.alpha));
            findings.say("solver.bossak.alpha", problem);
        }
        let gamma = Bounds::Within(0.5, 1.5);
        findings.number_if("solver.bossak.gamma".into(), bossak.gamma, gamma, "-");
    }
}

/// The name of an integrator in a scene.
pub(in crate::scene) fn integrator_name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Auto => "auto",
        Integrator::Leapfrog => "leapfrog",
        Integrator::AxialImplicit => "axial_implicit",
        Integrator::GeneralisedAlpha => "generalised_alpha",
        Integrator::Bossak => "bossak",
        Integrator::Beam => "beam",
        Integrator::QuasiStatic => "quasi_static",
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
    let time = Bounds::Positive(1e9);
    let mut right = findings.number("output.duration", output.duration, time, "s");
    right &= findings.number("output.interval", output.interval, time, "s");
    if !right {
        return;
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
