//! Points, their loads and their motions.

use super::{Findings, below, check_names, quantity, rules, unknown};
use crate::scene::names::Names;
use crate::scene::path::quoted;
use crate::scene::table::{Choice, Table};
use crate::scene::{LineType, Point, PointKind, Scene, Section};

pub(super) fn check(scene: &Scene, names: &Names, findings: &mut Findings) {
    check_names(scene, findings);
    for (i, point) in scene.points.iter().enumerate() {
        let at = format!("points[{i}]");
        check_place(findings, &at, point, scene);
        check_freedom(findings, &at, point);
        check_carrier(findings, &at, point, (scene, names));
        check_load(findings, &at, point, scene);
        check_own_motion(findings, &at, point);
    }
    check_unconnected(scene, findings);
    check_run_motion(scene, findings);
}

fn check_place(findings: &mut Findings, at: &str, point: &Point, scene: &Scene) {
    let Some(seabed) = &scene.seabed else { return };
    let Some([_, _, z]) = scene.reference_position(point) else {
        return;
    };
    // Positions typed with few digits may miss the seabed by a rounding.
    let rounding = 1e-9 * seabed.depth.abs().max(1.0);
    rules! { findings, at;
        "position[2]" if seabed.is_level() && seabed.depth >= 0.0 && z < -seabed.depth - rounding =>
            "z = {} lies below the seabed at z = {}", quantity(z, "m"), quantity(-seabed.depth, "m");
    }
}

/// Checks keys that only some kinds of points may have.
fn check_freedom(findings: &mut Findings, at: &str, point: &Point) {
    let kind = point.kind.word();
    let taken = ["mass", "volume", "drag_area", "added_mass", "force"];
    for (key, value) in point.entries() {
        let key = key.name();
        rules! { findings, at;
            "{key}" if point.kind == PointKind::Fixed && taken.contains(&key) && !value.is_absent() =>
                "a fixed point has no `{key}`, which would act on the ground alone: leave it out or write kind = \"free\"";
        }
    }
    let Some(axes) = &point.free else { return };
    let free = point.kind == PointKind::Free;
    rules! { findings, at;
        "free" if !free =>
            "only a free point has `free`, and this one is {kind}: leave it out or write kind = \"free\"";
        "free" if free && axes.is_empty() => "free along no axis: write kind = \"fixed\"";
    }
    for (i, axis) in axes.iter().enumerate() {
        rules! { findings, at;
            "free[{i}]" if free && axes[..i].contains(axis) => "the axis is given twice";
        }
    }
}

/// Checks the vessel that carries a point.
fn check_carrier(findings: &mut Findings, at: &str, point: &Point, (scene, names): (&Scene, &Names)) {
    let Some(carrier) = &point.on else { return };
    if names.vessel(carrier).is_none() {
        let vessels = scene.vessels.iter().map(|vessel| vessel.name.as_str());
        findings.say(below(at, "on"), unknown("vessel", "vessels", carrier, vessels));
    }
    rules! { findings, at;
        "on" if point.kind != PointKind::Coupled =>
            "a point on a vessel moves with it, and this one is {}: write kind = \"coupled\"",
            point.kind.word();
    }
}

fn check_load(findings: &mut Findings, at: &str, point: &Point, scene: &Scene) {
    let force = point.force.as_ref();
    let moment = point.moment.as_ref();
    rules! { findings, at;
        "force" if force.is_some_and(|force| force.entries().all(|(_, axis)| axis.is_absent())) =>
            "no force along `x`, `y` or `z`";
        "moment" if moment.is_some_and(|moment| moment.entries().all(|(_, axis)| axis.is_absent())) =>
            "no moment about `x`, `y` or `z`";
    }
    if let Some(problem) = moment.and_then(|_| untaken(point, scene)) {
        findings.say(below(at, "moment"), problem);
    }
}

/// Returns the reason why the moment on a point is refused, if it is.
fn untaken(point: &Point, scene: &Scene) -> Option<String> {
    if point.kind != PointKind::Free {
        return Some(format!(
            "a moment turns the end of a line that bends at a free point, and this one is {}",
            point.kind.word()
        ));
    }
    let bends = |section: Option<&Section>| {
        let line_type = section.and_then(|section| scene.type_of(section));
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

/// Refusal of a rotation.
const TURNS: &str = "a point does not turn: only vessels have `roll`, `pitch` and `yaw`";

fn check_own_motion(findings: &mut Findings, at: &str, point: &Point) {
    let (kind, word) = (point.kind, point.kind.word());
    let Some(motion) = &point.motion else {
        rules! { findings, at;
            "" if kind == PointKind::Prescribed =>
                "a prescribed point needs its `motion`; one that never moves is kind = \"fixed\"";
        }
        return;
    };
    rules! { findings, at;
        "motion" if kind == PointKind::Prescribed && motion.turns() => "{TURNS}";
        "motion" if kind == PointKind::Coupled =>
            "the host moves a coupled point; for `run` write it under [motion] as `{} = …`, or write kind = \"prescribed\"",
            quoted(&point.name);
        "motion" if matches!(kind, PointKind::Fixed | PointKind::Free) =>
            "a {word} point has no motion of its own: write kind = \"prescribed\"";
    }
}

fn check_unconnected(scene: &Scene, findings: &mut Findings) {
    for (i, point) in scene.points.iter().enumerate() {
        let connected = || scene.lines.iter().any(|line| line.joins(&point.name));
        rules! { findings, "points";
            "[{i}]" if point.kind == PointKind::Free && !connected() =>
                "no line ends at this free point, so nothing holds it";
        }
    }
}

/// `[motion]` drives coupled points and vessels only.
fn check_run_motion(scene: &Scene, findings: &mut Findings) {
    for (name, motion) in &scene.motion {
        let at = format!("motion.{}", quoted(name));
        if scene.vessel(name).is_some() {
            continue;
        }
        let Some(point) = scene.point(name) else {
            findings.say(at, nothing_driven(name, &scene.moved_by_a_host()));
            continue;
        };
        let is_coupled = point.kind == PointKind::Coupled;
        rules! { findings, &at;
            "" if !is_coupled =>
                "`{name}` is {}, and [motion] moves coupled points and vessels only", point.kind.word();
            "" given carrier = point.on.as_ref().filter(|_| is_coupled) =>
                "`{name}` rides on the vessel `{carrier}`: write the motion of that";
            "" if is_coupled && point.on.is_none() && motion.turns() => "{TURNS}";
        }
    }
}

/// "no vessel or coupled point is called `platform`; there is `semi`", with the nearest name first.
fn nothing_driven(name: &str, known: &[&str]) -> String {
    let what = "vessel or coupled point";
    match *known {
        [] => {
            format!("no {what} is called `{name}`, and there is none: nothing is moved by a host")
        }
        [one] => format!("no {what} is called `{name}`; there is `{one}`"),
        _ => unknown(what, "vessels and coupled points", name, known.iter().copied()),
    }
}
