//! Points, their loads and their motions.

use super::{Findings, check_names, quantity, unknown};
use crate::scene::path::quoted;
use crate::scene::table::{Choice, Table};
use crate::scene::{LineType, Point, PointKind, Scene, Section};
use std::collections::BTreeMap;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    let mut taken = BTreeMap::new();
    let points = scene.points.iter().map(|point| point.name.as_str());
    check_names(findings, &mut taken, "points", points);
    let lines = scene.lines.iter().map(|line| line.name.as_str());
    check_names(findings, &mut taken, "lines", lines);
    let vessels = scene.vessels.iter().map(|vessel| vessel.name.as_str());
    check_names(findings, &mut taken, "vessels", vessels);
    for (i, point) in scene.points.iter().enumerate() {
        let at = format!("points[{i}]");
        check_place(findings, &at, point, scene);
        check_freedom(findings, &at, point);
        check_carrier(findings, &at, point, scene);
        check_load(findings, &at, point, scene);
        check_own_motion(findings, &at, point);
    }
    check_unconnected(scene, findings);
    check_run_motion(scene, findings);
}

fn check_place(findings: &mut Findings, at: &str, point: &Point, scene: &Scene) {
    let Some(seabed) = &scene.seabed else { return };
    if point.on.is_some() {
        return; // in the vessel's frame
    }
    let z = point.position[2];
    // Positions typed with few digits may miss the bed by a rounding.
    let rounding = 1e-9 * seabed.depth.abs().max(1.0);
    if seabed.is_level() && seabed.depth >= 0.0 && z < -seabed.depth - rounding {
        let problem = format!(
            "z = {} lies below the seabed at z = {}",
            quantity(z, "m"),
            quantity(-seabed.depth, "m")
        );
        findings.say(format!("{at}.position[2]"), problem);
    }
}

/// Keys that only some kinds of points may have.
fn check_freedom(findings: &mut Findings, at: &str, point: &Point) {
    if point.kind == PointKind::Fixed {
        let taken = ["mass", "volume", "drag_area", "added_mass", "force"];
        let given = point
            .entries()
            .filter(|(key, value)| taken.contains(&key.name()) && !value.is_absent());
        for key in given.map(|(key, _)| key.name()) {
            let problem = format!(
                "a fixed point has no `{key}`, which would act on the ground alone: leave it out or write kind = \"free\""
            );
            findings.say(format!("{at}.{key}"), problem);
        }
    }
    if point.kind != PointKind::Free {
        if point.free.is_some() {
            let problem = format!(
                "only a free point has `free`, and this one is {}: leave it out or write kind = \"free\"",
                point.kind.word()
            );
            findings.say(format!("{at}.free"), problem);
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

/// The vessel that a point rides on.
fn check_carrier(findings: &mut Findings, at: &str, point: &Point, scene: &Scene) {
    let Some(carrier) = &point.on else { return };
    let vessels = scene.vessels.iter().map(|vessel| vessel.name.as_str());
    if vessels.clone().all(|vessel| vessel != carrier) {
        let problem = unknown("vessel", "vessels", carrier, vessels);
        findings.say(format!("{at}.on"), problem);
    }
    if point.kind != PointKind::Coupled {
        let problem = format!(
            "a point on a vessel moves with it, and this one is {}: write kind = \"coupled\"",
            point.kind.word()
        );
        findings.say(format!("{at}.on"), problem);
    }
}

fn check_load(findings: &mut Findings, at: &str, point: &Point, scene: &Scene) {
    if point
        .force
        .as_ref()
        .is_some_and(|force| force.entries().all(|(_, axis)| axis.is_absent()))
    {
        findings.say(format!("{at}.force"), "no force along `x`, `y` or `z`");
    }
    if let Some(moment) = &point.moment {
        let at = format!("{at}.moment");
        if moment.entries().all(|(_, axis)| axis.is_absent()) {
            findings.say(&at, "no moment about `x`, `y` or `z`");
        }
        if let Some(problem) = untaken(point, scene) {
            findings.say(at, problem);
        }
    }
}

/// Why nothing at a point takes its moment.
fn untaken(point: &Point, scene: &Scene) -> Option<String> {
    if point.kind != PointKind::Free {
        return Some(format!(
            "a moment turns the end of a line that bends at a free point, and this one is {}",
            point.kind.word()
        ));
    }
    let bends = |section: Option<&Section>| {
        let line_type = section.and_then(|section| scene.line_types.get(&section.line_type));
        line_type.is_some_and(LineType::bends)
    };
    let ends = scene.lines.iter().flat_map(|line| {
        let [first, last] = [line.sections.first(), line.sections.last()];
        [
            (line, "A", &line.from, first, line.clamped_a),
            (line, "B", &line.to, last, line.clamped_b),
        ]
    });
    let mut taking = ends.filter(|(line, _, name, section, _)| {
        **name == point.name && (scene.is_beam(line) || bends(*section))
    });
    match (taking.next(), taking.next()) {
        (None, _) => Some(
            "no line that bends ends at this point: give the type of one a `bending_stiffness` [N m²], or leave the moment out"
                .into(),
        ),
        (Some((one, ..)), Some((other, ..))) => Some(format!(
            "`{}` and `{}` both bend and end at this point, each free to turn: a moment turns the end of one line, so put it on a point of that alone",
            one.name, other.name
        )),
        (Some((line, end, .., Some(_))), None) => Some(format!(
            "end {end} of `{}` is clamped, and does not turn: leave out the clamp or the moment",
            line.name
        )),
        (Some(_), None) => None,
    }
}

fn check_own_motion(findings: &mut Findings, at: &str, point: &Point) {
    match (&point.motion, point.kind) {
        (Some(motion), PointKind::Prescribed) if motion.turns() => findings.say(
            format!("{at}.motion"),
            "a point does not turn: only vessels have `roll`, `pitch` and `yaw`",
        ),
        (Some(_), PointKind::Prescribed) => {}
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
                kind.word()
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

/// `[motion]` drives coupled points and vessels only.
fn check_run_motion(scene: &Scene, findings: &mut Findings) {
    let coupled = scene
        .points
        .iter()
        .filter(|point| point.kind == PointKind::Coupled && point.on.is_none())
        .map(|point| point.name.as_str());
    let vessels = scene.vessels.iter().map(|vessel| vessel.name.as_str());
    for (name, motion) in &scene.motion {
        let at = format!("motion.{}", quoted(name));
        if vessels.clone().any(|vessel| vessel == name) {
            continue;
        }
        match scene.point(name) {
            None => {
                findings.say(at.clone(), nothing_driven(name, coupled.clone(), vessels.clone()));
            }
            Some(point) if point.kind != PointKind::Coupled => {
                let problem = format!(
                    "`{name}` is {}, and [motion] moves coupled points and vessels only",
                    point.kind.word()
                );
                findings.say(at.clone(), problem);
            }
            Some(Point { on: Some(vessel), .. }) => {
                let problem = format!("`{name}` rides on the vessel `{vessel}`: write the motion of that");
                findings.say(at.clone(), problem);
            }
            Some(_) if motion.turns() => {
                let problem = "a point does not turn: only vessels have `roll`, `pitch` and `yaw`";
                findings.say(at.clone(), problem);
            }
            Some(_) => {}
        }
    }
}

/// "no vessel or coupled point is called `platform`; there is `semi`", with the near one first.
fn nothing_driven<'a>(
    name: &str,
    coupled: impl Iterator<Item = &'a str> + Clone,
    vessels: impl Iterator<Item = &'a str> + Clone,
) -> String {
    let known: Vec<&str> = vessels.chain(coupled).collect();
    let what = "vessel or coupled point";
    match known[..] {
        [] => {
            format!("no {what} is called `{name}`, and there is none: nothing is moved by a host")
        }
        [one] => format!("no {what} is called `{name}`; there is `{one}`"),
        _ => unknown(what, "vessels and coupled points", name, known.iter().copied()),
    }
}
