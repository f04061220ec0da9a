//! Solver and output.

use super::{Bounds, Findings, number, quantity, rules};
use crate::scene::channel::Channel;
use crate::scene::table::Choice;
use crate::scene::{AXIAL_RADIUS_MIN, Frames, Integrator, Scene};

/// Maximum number of output steps of a run.
const STEPS_MAX: f64 = 1e7;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    check_solver(scene, findings);
    check_output(scene, findings);
}

fn check_solver(scene: &Scene, findings: &mut Findings) {
    let solver = &scene.solver;
    let (integrator, word) = (solver.integrator, solver.integrator.word());
    if let Some(radius) = solver.spectral_radius {
        let least = match integrator {
            Integrator::AxialImplicit => AXIAL_RADIUS_MIN,
            _ => 0.0,
        };
        let takes_radius = [
            Integrator::Auto,
            Integrator::AxialImplicit,
            Integrator::GeneralisedAlpha,
        ];
        findings.number("solver.spectral_radius", radius, Bounds::Within(least, 1.0), "-");
        rules! { findings, "solver";
            "spectral_radius" if !takes_radius.contains(&integrator) =>
                "the integrator is \"{word}\", and a spectral radius belongs to \"generalised_alpha\" and \"axial_implicit\"";
        }
    }
    let implicit = [Integrator::GeneralisedAlpha, Integrator::Bossak].contains(&integrator);
    let mut types = scene.sections().filter_map(|section| scene.type_of(section));
    let viscoelastic = types.any(|kind| kind.dynamic_stiffness.is_some());
    rules! { findings, "solver";
        "negative_tension" if solver.negative_tension && implicit && viscoelastic =>
            "with the integrator \"{word}\", viscoelastic ropes carry no negative tension: leave this out, or use \"axial_implicit\"";
    }
    if let Some(bossak) = &solver.bossak {
        rules! { findings, "solver.bossak";
            "" if integrator != Integrator::Bossak =>
                "the integrator is \"{word}\": write integrator = \"bossak\" or leave these parameters out";
            // -1/3 as a decimal may be rounded either way.
            "alpha" if !(-1.0 / 3.0 - 1e-6..=0.0).contains(&bossak.alpha) =>
                "{} is not between -1/3 and 0", number(bossak.alpha);
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
    let [interval, duration] = [output.interval, output.duration].map(|time| quantity(time, "s"));
    let shapes = match output.frames {
        Some(Frames::Every(shapes)) if shapes > 0.0 => shapes,
        _ => output.interval,
    };
    let rows = shapes / output.interval;
    rules! { findings, "output";
        "frames.every" if rows < 0.5 || (rows - rows.round()).abs() > 1e-6 * rows =>
            "{} is not a multiple of the interval of {interval}: shapes are written with rows", quantity(shapes, "s");
        "interval" if output.interval > output.duration =>
            "{interval} is longer than the duration of {duration}";
        "interval" if output.duration / output.interval > STEPS_MAX =>
            "{duration} in steps of {interval} is more than 1e7 steps: give a longer interval or a shorter duration";
    }
}
