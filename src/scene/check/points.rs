//! Points, their loads and their motions.

use std::collections::BTreeMap;

use super::time::{check_force, check_motion};
use super::{Bounds, Findings, check_names, quantity, unknown};
use crate::scene::path::quoted;
use crate::scene::{Point, PointKind, Scene};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    let mut taken = BTreeMap::new();
    let points = scene.points.iter().map(|point| point.name.as_str());
    check_names(findings, &mut taken, "points", points);
    let lines = scene.lines.iter().map(|line| line.name.as_str());
    check_names(findings, &mut taken, "lines", lines);
    for (i, point) in scene.points.iter().enumerate() {
        let at = format!("points[{i}]");
        check_place(findings, &at, point, scene);
        check_freedom(findings, &at, point);
        check_load(findings, &at, point);
        check_own_motion(findings, &at, point);
    }
    check_unconnected(scene, findings);
    check_run_motion(scene, findings);
}

fn check_place(findings: &mut Findings, at: &str, point: &Point, scene: &Scene) {
    let mut right = true;
    for (axis, value) in point.position.iter().enumerate() {
        let place = format!("{at}.position[{axis}]");
        right &= findings.number(place, *value, Bounds::Magnitude(1e7), "m");
    }
    let Some(seabed) = &scene.seabed else { return };
    let z = point.position[2];
    // Positions typed with few digits may miss the bed by a rounding.
    let rounding = 1e-9 * seabed.depth.abs().max(1.0);
    if right && seabed.depth >= 0.0 && z < -seabed.depth - rounding {
        let problem = format!(
            "z = {} lies below the seabed at z = {}",
            quantity(z, "m"),
            quantity(-seabed.depth, "m")
        );
        findings.say(format!("{at}.position[2]"), problem);
    }
}

/// Keys that only a free point may have.
fn check_freedom(findings: &mut Findings, at: &str, point: &Point) {
    findings.number_if(
        format!("{at}.mass"),
        point.mass,
        Bounds::NotNegative(1e12),
        "kg",
    );
    findings.number_if(
        format!("{at}.volume"),
        point.volume,
        Bounds::NotNegative(1e9),
        "m³",
    );
    findings.number_if(
        format!("{at}.drag_area"),
        point.drag_area,
        Bounds::NotNegative(1e9),
        "m²",
    );
    findings.number_if(
        format!("{at}.added_mass"),
        point.added_mass,
        Bounds::NotNegative(1e3),
        "-",
    );
    if point.kind != PointKind::Free {
        let given = [
            ("free", point.free.is_some()),
            ("mass", point.mass.is_some()),
            ("volume", point.volume.is_some()),
            ("drag_area", point.drag_area.is_some()),
            ("added_mass", point.added_mass.is_some()),
        ];
        for (key, _) in given.iter().filter(|(_, given)| *given) {
            let problem = format!(
                "only a free point has `{key}`, and this one is {}: leave it out or write kind = \"free\"",
                kind_in_words(point.kind)
            );
            findings.say(format!("{at}.{key}"), problem);
        }
        return;
    }
    let Some(axes) = &point.free else { return };
    if axes.is_empty() {
        let problem = "free along no axis: write kind = \"fixed\"";
        findings.say(format!("{at}.free"), problem);
    }
    for (i, axis) in axes.iter().enumerate() {
        if axes[..i].contains(axis) {
            findings.say(format!("{at}.free[{i}]"), "the axis is given twice");
        }
    }
}

fn kind_in_words(kind: PointKind) -> &'static str {
    match kind {
        PointKind::Fixed => "fixed",
        PointKind::Coupled => "coupled",
        PointKind::Prescribed => "prescribed",
        PointKind::Free => "free",
    }
}

fn check_load(findings: &mut Findings, at: &str, point: &Point) {
    let Some(force) = &point.force else { return };
    for (axis, function) in [("x", &force.x), ("y", &force.y), ("z", &force.z)] {
        if let Some(function) = function {
            check_force(findings, &format!("{at}.force.{axis}"), function);
        }
    }
    if force.x.is_none() && force.y.is_none() && force.z.is_none() {
        findings.say(format!("{at}.force"), "no force along `x`, `y` or `z`");
    }
}

fn check_own_motion(findings: &mut Findings, at: &str, point: &Point) {
    match (&point.motion, point.kind) {
        (Some(motion), PointKind::Prescribed) => {
            check_motion(findings, &format!("{at}.motion"), motion);
        }
        (Some(_), PointKind::Coupled) => findings.say(
            format!("{at}.motion"),
            format!(
                "the host moves a coupled point; for `run` write it under [motion] as `{} = …`, \
                 or write kind = \"prescribed\"",
                quoted(&point.name)
            ),
        ),
        (Some(_), kind) => findings.say(
            format!("{at}.motion"),
            format!(
                "a {} point has no motion of its own: write kind = \"prescribed\"",
                kind_in_words(kind)
            ),
        ),
        (None, PointKind::Prescribed) => findings.say(
            at,
            "a prescribed point needs its `motion`; one that never moves is kind = \"fixed\"",
        ),
        (None, _) => {}
    }
}

fn check_unconnected(scene: &Scene, findings: &mut Findings) {
    for (i, point) in scene.points.iter().enumerate() {
        let mut lines = scene.lines.iter();
        let connected = lines.any(|line| line.from == point.name || line.to == point.name);
        if point.kind == PointKind::Free && !connected {
            let problem = "no line ends at this free point, so nothing holds it";
            findings.say(format!("points[{i}]"), problem);
        }
    }
}

/// `[motion]` drives coupled points only.
fn check_run_motion(scene: &Scene, findings: &mut Findings) {
    let coupled = scene
        .points
        .iter()
        .filter(|point| point.kind == PointKind::Coupled)
        .map(|point| point.name.as_str());
    for (name, motion) in &scene.motion {
        let at = format!("motion.{}", quoted(name));
        match scene.points.iter().find(|point| point.name == *name) {
            None => {
                let problem = unknown("coupled point", "coupled points", name, coupled.clone());
                findings.say(at.clone(), problem);
            }
            Some(point) if point.kind != PointKind::Coupled => {
                let problem = format!(
                    "`{name}` is {}, and [motion] moves coupled points only",
                    kind_in_words(point.kind)
                );
                findings.say(at.clone(), problem);
            }
            Some(_) => {}
        }
        check_motion(findings, &at, motion);
    }
}
