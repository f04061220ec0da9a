//! Lines, their sections, their start, and their support.

use super::{Findings, below, rules, unknown};
use crate::scene::names::Names;
use crate::scene::{
    InitialShape, Integrator, Line, LineModel, LineType, PointKind, RestShape, Scene, Section,
};

pub(super) fn check(scene: &Scene, names: &Names, findings: &mut Findings) {
    rules! { findings, "lines";
        "" if scene.lines.is_empty() => "no line: a scene needs at least one `[[lines]]`";
    }
    for (i, line) in scene.lines.iter().enumerate() {
        let at = format!("lines[{i}]");
        check_ends(findings, &at, line, (scene, names));
        check_sections(findings, &at, line, scene);
        check_start(findings, &format!("{at}.initial"), line, names);
        check_clamps(findings, &at, line, scene);
        check_release(findings, &at, line, scene);
        super::winch::check(findings, &at, line, scene);
    }
    check_held(scene, names, findings);
}

fn check_ends(findings: &mut Findings, at: &str, line: &Line, (scene, names): (&Scene, &Names)) {
    for (key, name) in [("from", &line.from), ("to", &line.to)] {
        if names.point(name).is_none() {
            let points = scene.points.iter().map(|point| point.name.as_str());
            findings.say(below(at, key), unknown("point", "points", name, points));
        }
    }
    rules! { findings, at;
        "to" if line.from == line.to =>
            "both ends are at `{}`: a line joins two points (which may have the same position)", line.to;
    }
}

fn check_sections(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    let none = line.sections.is_empty();
    let all_given = line.sections.iter().all(|section| section.elements.is_some());
    rules! { findings, at;
        "sections" if none => "no sections: write sections = [{{ type = …, length = … }}]";
        "elements" if line.elements.is_some() && all_given && !none =>
            "every section of the line has its own number of elements: leave this one out, or those";
    }
    for (i, section) in line.sections.iter().enumerate() {
        let name = &section.line_type;
        let Some(line_type) = scene.type_of(section) else {
            let types = scene.line_types.keys().map(String::as_str);
            let problem = unknown("line type", "line types", name, types);
            findings.say(format!("{at}.sections[{i}].type"), problem);
            continue;
        };
        rules! { findings, at;
            "sections[{i}].damping_elements" if section.damping_elements.is_some() && line_type.damping_ratio.is_none() =>
                "line type \"{name}\" has no `damping_ratio`, which alone it acts on: leave it out";
        }
    }
}

/// Checks lines that are released or break from their points.
fn check_release(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    let key = match (&line.failure, line.release) {
        (Some(_), _) => "break",
        (None, Some(_)) => "release",
        (None, None) => return,
    };
    let failure = line.failure.as_ref();
    let stiff = |kind: &LineType| kind.model == LineModel::Beam || kind.bends();
    rules! { findings, &below(at, key);
        "" if failure.is_some_and(|failure| failure.tension.is_none() && failure.time.is_none()) =>
            "nothing breaks the line: give `tension` [N], `time` [s] or both";
        "" if matches!(scene.solver.integrator, Integrator::QuasiStatic | Integrator::Beam) =>
            "a released line falls: use a dynamic integrator of cables, or \"auto\"";
        "" if scene.types_of(line).any(stiff) =>
            "lines with bending stiffness cannot be released: leave it out, or the bending stiffness";
    }
}

fn check_start(findings: &mut Findings, at: &str, line: &Line, names: &Names) {
    let ends = [&line.from, &line.to].map(|name| names.point(name).map(|point| point.position));
    let settles = matches!(line.initial, InitialShape::Static | InitialShape::Catenary);
    let straight = line.initial == InitialShape::Straight && line.from != line.to;
    rules! { findings, at;
        "" if settles && line.rest_shape == RestShape::Initial =>
            "a line with rest_shape = \"initial\" needs a given shape, \"straight\", {{ parabola = sag }} or {{ nodes = … }}: \
             an equilibrium is not free of bending, and follows from the shape that is";
        "" if straight && ends[0].is_some() && ends[0] == ends[1] =>
            "the two ends have the same position, so no straight line joins them: write \"static\"";
    }
    if let InitialShape::Nodes(nodes) = &line.initial {
        check_nodes(findings, &below(at, "nodes"), nodes, line, ends);
    }
}

fn check_nodes(
    findings: &mut Findings,
    at: &str,
    nodes: &[[f64; 3]],
    line: &Line,
    ends: [Option<[f64; 3]>; 2],
) {
    let Some(elements) = line.element_count() else {
        return findings.say(at, "given nodes need `elements` in every section of the line");
    };
    let (count, wanted) = (nodes.len(), elements + 1);
    if count != wanted {
        let problem = format!("{count} nodes, but a line of {elements} elements has {wanted}");
        return findings.say(at, problem);
    }
    let length = line.length();
    for (i, end) in [(0, ends[0]), (count - 1, ends[1])] {
        let Some([x, y, z]) = end else { continue };
        let apart = nodes[i]
            .iter()
            .zip([x, y, z])
            .map(|(node, end)| (node - end).abs());
        rules! { findings, at;
            "[{i}]" if apart.into_iter().any(|apart| apart > 1e-6 * length) =>
                "the node is not at the line's end, [{x}, {y}, {z}] m";
        }
    }
}

/// Checks the rest shape and the directions of clamped ends, which only lines with bending stiffness can have.
fn check_clamps(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    let flexible = |section: &Section| scene.type_of(section).is_some_and(|kind| !kind.bends());
    rules! { findings, at;
        "rest_shape" if line.rest_shape != RestShape::Straight && line.sections.iter().all(flexible) =>
            "every shape of a perfectly flexible line bends nothing: leave it out, or give a type of the line a `bending_stiffness` [N m²]";
    }
    let sections = [line.sections.first(), line.sections.last()];
    let ends = [("clamped_a", line.clamped_a), ("clamped_b", line.clamped_b)];
    for ((key, direction), section) in ends.into_iter().zip(sections) {
        rules! { findings, at;
            "{key}" if direction == Some([0.0; 3]) => "[0, 0, 0] is no direction";
            "{key}" if direction.is_some() && section.is_some_and(flexible) =>
                "a perfectly flexible line cannot be clamped: give its type a `bending_stiffness` [N m²]";
        }
    }
}

/// Returns whether a line may fly freely: a beam whose shape at the start is given.
fn flies(line: &Line, scene: &Scene) -> bool {
    line.initial != InitialShape::Static && scene.is_beam(line)
}

/// Refuses lines that are not connected, directly or through other lines, to a point that is not free, except beams in free flight.
fn check_held(scene: &Scene, names: &Names, findings: &mut Findings) {
    let mut held: Vec<bool> = scene
        .points
        .iter()
        .map(|point| point.kind != PointKind::Free)
        .collect();
    let joins: Vec<Option<(usize, usize)>> = scene
        .lines
        .iter()
        .map(|line| names.point_index(&line.from).zip(names.point_index(&line.to)))
        .collect();
    // Each pass but the last reaches at least one more point.
    for _ in 0..scene.points.len() {
        let mut changed = false;
        for (a, b) in joins.iter().flatten() {
            changed |= held[*a] != held[*b];
            let either = held[*a] || held[*b];
            held[*a] = either;
            held[*b] = either;
        }
        if !changed {
            break;
        }
    }
    for (i, join) in joins.iter().enumerate() {
        let Some((a, b)) = join else { continue };
        rules! { findings, "lines";
            "[{i}]" if a != b && !held[*a] && !flies(&scene.lines[i], scene) =>
                "nothing holds this line: neither it nor the lines joined to it end at a \
                 fixed, coupled or prescribed point (a beam flies freely if its `initial` shape is given)";
        }
    }
}
