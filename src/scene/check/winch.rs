//! Winches: lengths and speeds in range, and lines that a winch can serve.

use super::{Findings, quantity, rules};
use crate::scene::channel::LineEnd;
use crate::scene::{
    InitialShape, Integrator, Line, LineModel, LineType, PointKind, Scene, TimeFunction, Winch,
};

pub(super) fn check(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    let Some(winch) = &line.winch else {
        return;
    };
    let at = format!("{at}.winch");
    if let Some(path) = &winch.path {
        check_path(findings, &format!("{at}.path"), path, winch, line);
    }
    let mut refusals = refusals(line, winch, scene).into_iter();
    if let Some((_, problem)) = refusals.find(|(holds, _)| *holds) {
        findings.say(at, problem);
    }
}

fn check_path(findings: &mut Findings, at: &str, path: &TimeFunction, winch: &Winch, line: &Line) {
    let section = line.sections.last().map_or(0.0, |section| section.length);
    let beyond = |value: &f64| *value > winch.length_max || *value <= -section;
    if let Some(value) = path.corners().into_iter().find(beyond) {
        let [value, least, most] = [value, -section, winch.length_max].map(|length| quantity(length, "m"));
        let problem = format!(
            "{value} is not between {least}, where the section at the winch is used up, and length_max, {most}"
        );
        return findings.say(at, problem);
    }
    let (fastest, limit) = (path.rate_max(), winch.speed_max.unwrap_or(f64::INFINITY));
    rules! { findings, at;
        "" if fastest > limit =>
            "the path takes up to {}, and speed_max is {}", quantity(fastest, "m/s"), quantity(limit, "m/s");
    }
}

/// Conditions under which a winch is impossible or not modelled, each with its message.
fn refusals(line: &Line, winch: &Winch, scene: &Scene) -> [(bool, &'static str); 9] {
    let is_moved = scene
        .point(&line.to)
        .is_some_and(|point| point.kind == PointKind::Free);
    let breaks = line
        .failure
        .as_ref()
        .is_some_and(|failure| failure.at == LineEnd::B);
    let is_served = matches!(scene.solver.integrator, Integrator::Auto | Integrator::Leapfrog);
    let other =
        |kind: &LineType| kind.model == LineModel::Beam || kind.bends() || kind.dynamic_stiffness.is_some();
    [
        (
            winch.end == LineEnd::A,
            "a winch is at end \"b\": write the line the other way round",
        ),
        (
            is_moved,
            "a winch stands on a point that forces do not move: fixed, coupled, prescribed or on a vessel",
        ),
        (
            breaks || line.release == Some(LineEnd::B),
            "end B is on the winch, so that it can neither break off nor be released: leave one of them out",
        ),
        (
            !is_served,
            "winches are modelled by the integrators \"leapfrog\" and \"auto\"",
        ),
        (
            scene.waves().is_some(),
            "a line on a winch is not modelled in waves: leave out one of them",
        ),
        (
            scene.has_host_flow(),
            "a winch changes the number of nodes, at which the host gives the flow of the water: leave out one of them",
        ),
        (
            scene.meets_surface(line),
            "a line on a winch does not come out of the water: say water.surface = false to have it under water throughout",
        ),
        (
            matches!(line.initial, InitialShape::Nodes(_)),
            "a line on a winch starts \"static\" or \"straight\"",
        ),
        (
            scene.types_of(line).any(other),
            "a line on a winch has neither bending stiffness nor a viscoelastic section",
        ),
    ]
}
