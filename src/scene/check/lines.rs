//! Lines, their sections, their start, and whether anything holds them.

use super::{Findings, unknown};
use crate::scene::{
    InitialShape, Integrator, Line, LineModel, LineType, PointKind, RestShape, Scene, Section,
};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    if scene.lines.is_empty() {
        findings.say("lines", "no line: a scene needs at least one `[[lines]]`");
    }
    for (i, line) in scene.lines.iter().enumerate() {
        let at = format!("lines[{i}]");
        check_ends(findings, &at, line, scene);
        check_sections(findings, &at, line, scene);
        check_start(findings, &format!("{at}.initial"), line, scene);
        check_clamps(findings, &at, line, scene);
        check_release(findings, &at, line, scene);
        super::winch::check(findings, &at, line, scene);
    }
    check_held(scene, findings);
}

fn check_ends(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    let points = scene.points.iter().map(|point| point.name.as_str());
    for (key, name) in [("from", &line.from), ("to", &line.to)] {
        if points.clone().all(|point| point != name) {
            let problem = unknown("point", "points", name, points.clone());
            findings.say(format!("{at}.{key}"), problem);
        }
    }
    if line.from == line.to {
        let problem = format!(
            "both ends are at `{}`: a line joins two points (which may have the same position)",
            line.to
        );
        findings.say(format!("{at}.to"), problem);
    }
}

fn check_sections(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    if line.sections.is_empty() {
        let problem = "no sections: write sections = [{ type = …, length = … }]";
        findings.say(format!("{at}.sections"), problem);
    }
    let all_given =
        !line.sections.is_empty() && line.sections.iter().all(|section| section.elements.is_some());
    findings.refuse(
        at,
        &[(
            "elements",
            line.elements.is_some() && all_given,
            "every section of the line has its own number of elements: leave this one out, or those",
        )],
    );
    for (i, section) in line.sections.iter().enumerate() {
        let at = format!("{at}.sections[{i}]");
        let Some(line_type) = scene.line_types.get(&section.line_type) else {
            let types = scene.line_types.keys().map(String::as_str);
            let problem = unknown("line type", "line types", &section.line_type, types);
            findings.say(format!("{at}.type"), problem);
            continue;
        };
        if section.damping_elements.is_some() && line_type.damping_ratio.is_none() {
            let problem = format!(
                "line type \"{}\" has no `damping_ratio`, which alone it acts on: leave it out",
                section.line_type
            );
            findings.say(format!("{at}.damping_elements"), problem);
        }
    }
}

/// Lines that are released or break off their points.
fn check_release(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    let Some(key) = line
        .failure
        .as_ref()
        .map(|_| "break")
        .or(line.release.map(|_| "release"))
    else {
        return;
    };
    let open = line
        .failure
        .as_ref()
        .is_some_and(|failure| failure.tension.is_none() && failure.time.is_none());
    let unmoved = matches!(
        scene.solver.integrator,
        Integrator::QuasiStatic | Integrator::Beam
    );
    let mut types = scene.types_of(line);
    let stiff = types.any(|kind| kind.model == LineModel::Beam || kind.bends());
    findings.refuse(
        at,
        &[
            (
                key,
                open,
                "nothing breaks the line: give `tension` [N], `time` [s] or both",
            ),
            (
                key,
                unmoved,
                "a released line falls: use a dynamic integrator of cables, or \"auto\"",
            ),
            (
                key,
                stiff,
                "lines with bending stiffness cannot be released: leave it out, or the bending stiffness",
            ),
        ],
    );
}

fn check_start(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    let ends = [&line.from, &line.to].map(|name| {
        let point = scene.point(name);
        point.map(|point| point.position)
    });
    match &line.initial {
        InitialShape::Static | InitialShape::Catenary => {
            if line.rest_shape == RestShape::Initial {
                let problem = "a line with rest_shape = \"initial\" needs a given shape, \"straight\", { parabola = sag } or { nodes = … }: \
                               an equilibrium is not free of bending, and follows from the shape that is";
                findings.say(at, problem);
            }
        }
        InitialShape::Straight => {
            if line.from != line.to && ends[0].is_some() && ends[0] == ends[1] {
                let problem = "the two ends have the same position, so no straight line joins them: \
                               write \"static\"";
                findings.say(at, problem);
            }
        }
        InitialShape::Parabola(_) => {}
        InitialShape::Nodes(nodes) => check_nodes(findings, &format!("{at}.nodes"), nodes, line, ends),
    }
}

fn check_nodes(
    findings: &mut Findings,
    at: &str,
    nodes: &[[f64; 3]],
    line: &Line,
    ends: [Option<[f64; 3]>; 2],
) {
    let elements: Option<usize> = line
        .sections
        .iter()
        .map(|section| section.elements)
        .try_fold(0_usize, |sum, n| sum.checked_add(n?));
    let Some(elements) = elements else {
        let problem = "given nodes need `elements` in every section of the line";
        return findings.say(at, problem);
    };
    if nodes.len() != elements + 1 {
        let problem = format!(
            "{} nodes, but a line of {elements} elements has {}",
            nodes.len(),
            elements + 1
        );
        return findings.say(at, problem);
    }
    let length = line.length();
    let last = nodes.len() - 1;
    for (i, end) in [(0, ends[0]), (last, ends[1])] {
        let Some(end) = end else { continue };
        let far = (0..3).any(|axis| (nodes[i][axis] - end[axis]).abs() > 1e-6 * length);
        if far {
            let problem = format!(
                "the node is not at the line's end, [{}, {}, {}] m",
                end[0], end[1], end[2]
            );
            findings.say(format!("{at}[{i}]"), problem);
        }
    }
}

/// Directions of clamped ends, which only lines that bend can have.
fn check_clamps(findings: &mut Findings, at: &str, line: &Line, scene: &Scene) {
    let of_section = |section: &Section| scene.line_types.get(&section.line_type);
    let mut types = line.sections.iter().map(of_section);
    if line.rest_shape != RestShape::Straight
        && types.all(|line_type| line_type.is_some_and(|line_type| !line_type.bends()))
    {
        let problem = "every shape of a perfectly flexible line bends nothing: leave it out, or give a type of the line a `bending_stiffness` [N m²]";
        findings.say(format!("{at}.rest_shape"), problem);
    }
    let sections = [line.sections.first(), line.sections.last()];
    let ends = [("clamped_a", line.clamped_a), ("clamped_b", line.clamped_b)];
    for ((key, direction), section) in ends.into_iter().zip(sections) {
        let Some(direction) = direction else { continue };
        let line_type = section.and_then(|section| scene.line_types.get(&section.line_type));
        findings.refuse(
            at,
            &[
                (key, direction == [0.0; 3], "[0, 0, 0] is no direction"),
                (
                    key,
                    !line_type.is_none_or(LineType::bends),
                    "a perfectly flexible line cannot be clamped: give its type a `bending_stiffness` [N m²]",
                ),
            ],
        );
    }
}

/// Returns whether a line flies where nothing holds it: a beam, whose shape at the start is given.
fn flies(line: &Line, scene: &Scene) -> bool {
    let all_beams = scene.solver.integrator == Integrator::Beam;
    let beams = all_beams || scene.types_of(line).all(|kind| kind.model == LineModel::Beam);
    line.initial != InitialShape::Static && beams
}

/// Every line must hang, over other lines, on something that does not just fall.
fn check_held(scene: &Scene, findings: &mut Findings) {
    let place = |name: &str| scene.points.iter().position(|point| point.name == name);
    let mut held: Vec<bool> = scene
        .points
        .iter()
        .map(|point| point.kind != PointKind::Free)
        .collect();
    let joins: Vec<Option<(usize, usize)>> = scene
        .lines
        .iter()
        .map(|line| place(&line.from).zip(place(&line.to)))
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
        if let Some((a, b)) = join
            && a != b
            && !held[*a]
            && !flies(&scene.lines[i], scene)
        {
            let problem = "nothing holds this line: neither it nor the lines joined to it end at a \
                           fixed, coupled or prescribed point (a beam flies freely if its `initial` shape is given)";
            findings.say(format!("lines[{i}]"), problem);
        }
    }
}
