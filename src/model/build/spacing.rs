//! Data on which the mesh of a line depends: the lines it is joined to, its clamps, and its touchdown as its ends
//! move.

use nalgebra::Vector3;

use super::{LineLaw, Seabed, catenary_sections, line_law};
use crate::model::mesh::{Place, Refinement, line_elements};
use crate::model::{Line, Model, Point, Role, Vessel};
use crate::physics::catenary::{self, Catenary, FlatSeabed};
use crate::scene::{self, PointKind, Scene, metres, percent};

/// Error of the curvature at a clamp times the square of the number of elements per λ = √(EI/T) there [-], where the tension becomes 1.4 times that
/// at rest ([`crate::physics::bending`]).
const CURVATURE_ERROR: f64 = 0.02;
/// Minimum and maximum number of elements per √(EI/T) at a clamp [-].
const CLAMP_ELEMENTS: [f64; 2] = [0.6, 8.0];
/// Maximum length of an element at a clamp, relative to √(EI/T), for which the curvature there is within a few per cent of that of the line [-].
const CLAMP_LENGTH_MAX: f64 = 2.0;
/// Number of elements per √(EI/T) at the touchdown, where the moment rises without a step [-].
const TOUCHDOWN_ELEMENTS: f64 = 2.0;
/// Length of the fine mesh at a clamp and on both sides of the touchdown, relative to √(EI/T) [-].
const BENDS: f64 = 2.0;
/// Displacement of the touchdown to both sides that is assumed if the motion of the ends is not given, relative to the length
/// of the line [-].
const TOUCHDOWN_SHARE: f64 = 0.025;
/// Number of instants at which a given motion is evaluated [-].
const MOMENTS: usize = 400;

/// Fraction of the length of a line below which two arc lengths count as equal [-].
const ROUNDING: f64 = 1e-9;

/// Number of elements of every line [-]: the given number, otherwise that of a single line for the longest of the lines that meet at free
/// points, and a share in proportion to length for the others.
pub(super) fn elements(scene: &Scene) -> Vec<f64> {
    let alone = alone(scene);
    let pairs = lengths(scene).into_iter().zip(longest(scene));
    let lines = scene.lines.iter().zip(pairs);
    lines
        .map(|(line, (own, longest))| match line.elements {
            Some(elements) => elements as f64,
            None => alone * own / longest,
        })
        .collect()
}

/// Length of every line relative to the longest line that it is connected to by free points [-].
pub(super) fn shares(scene: &Scene) -> Vec<f64> {
    let pairs = lengths(scene).into_iter().zip(longest(scene));
    pairs.map(|(own, longest)| own / longest).collect()
}

/// Lengths of the segments that damping ratios refer to [m], one per section of every line.
pub(super) fn damping_lengths(scene: &Scene) -> Vec<Vec<f64>> {
    let of_section = |section: &scene::Section, longest: f64| match section.damping_elements {
        Some(elements) => section.length / elements as f64,
        None => longest / scene::DAMPING_ELEMENTS as f64,
    };
    let lines = scene.lines.iter().zip(longest(scene));
    lines
        .map(|(line, longest)| {
            let sections = line.sections.iter();
            sections.map(|section| of_section(section, longest)).collect()
        })
        .collect()
}

/// Unstretched lengths of all lines [m].
fn lengths(scene: &Scene) -> Vec<f64> {
    let length = |line: &scene::Line| line.sections.iter().map(|s| s.length).sum::<f64>();
    scene.lines.iter().map(length).collect()
}

/// Length [m] of the longest line that every line is connected to by free points, itself included.
fn longest(scene: &Scene) -> Vec<f64> {
    let mut longest = lengths(scene);
    let free: Vec<Vec<usize>> = scene
        .points
        .iter()
        .filter(|point| point.kind == PointKind::Free)
        .map(|point| {
            let lines = scene.lines.iter().enumerate();
            let tied = lines.filter(|(_, line)| line.from == point.name || line.to == point.name);
            tied.map(|(index, _)| index).collect()
        })
        .collect();
    for _ in 0..scene.lines.len() {
        let before = longest.clone();
        for tied in &free {
            let most = tied.iter().map(|&line| longest[line]).fold(0.0, f64::max);
            tied.iter().for_each(|&line| longest[line] = most);
        }
        if longest == before {
            break;
        }
    }
    longest
}

/// Number of elements of a single line [-].
fn alone(scene: &Scene) -> f64 {
    let solver = &scene.solver;
    let given = solver.elements.map(|elements| elements as f64);
    given.unwrap_or_else(|| line_elements(solver.tolerance))
}

/// Places where a line with bending stiffness needs short elements, according to its closed-form catenary.
pub(super) fn refinements(
    scene: &Scene,
    line: &scene::Line,
    ends: [&Point; 2],
    vessels: &[Vessel],
    laws: &[LineLaw],
) -> Vec<Refinement> {
    if laws.iter().all(|law| law.bending_stiffness == 0.0) {
        return Vec::new();
    }
    let seabed = seabed_below(scene);
    let (shapes, known) = shapes(scene, ends, vessels, |a, b| hang(line, laws, seabed(a), b - a));
    let total: f64 = line.sections.iter().map(|section| section.length).sum();
    let mut wanted = Vec::new();
    let greatest = |of: fn(&Catenary) -> f64| shapes.iter().map(of).fold(0.0, f64::max);
    let clamps = [
        (
            line.clamped_a,
            Place::ClampA,
            laws.first(),
            greatest(Catenary::tension_a),
        ),
        (
            line.clamped_b,
            Place::ClampB,
            laws.last(),
            greatest(Catenary::tension_b),
        ),
    ];
    let [least, most] = CLAMP_ELEMENTS;
    let at_clamp = (CURVATURE_ERROR / scene.solver.tolerance)
        .sqrt()
        .clamp(least, most);
    for (clamp, place, law, tension) in clamps {
        let stiffness = law.map_or(0.0, |law| law.bending_stiffness);
        if clamp.is_none() || stiffness == 0.0 || tension == 0.0 {
            continue;
        }
        let bend = (stiffness / tension).sqrt();
        let reach = (BENDS * bend).min(total);
        let (from, to) = match place {
            Place::ClampA => (0.0, reach),
            _ => (total - reach, total),
        };
        wanted.push(Refinement {
            from,
            to,
            size: bend / at_clamp,
            bend,
            place,
        });
    }
    let spread = if known { 0.0 } else { TOUCHDOWN_SHARE * total };
    for [from, to] in touchdowns(&shapes, total) {
        let stiffness = section_at(line, laws, 0.5 * (from + to)).bending_stiffness;
        let tension = greatest(Catenary::horizontal);
        if stiffness > 0.0 && tension > 0.0 {
            let bend = (stiffness / tension).sqrt();
            wanted.push(Refinement {
                from: (from - spread - BENDS * bend).max(0.0),
                to: (to + spread + BENDS * bend).min(total),
                size: bend / TOUCHDOWN_ELEMENTS,
                bend,
                place: Place::Touchdown,
            });
        }
    }
    wanted
}

/// Flat seabed for the catenary below a place [m], at the local height of the seabed; `None` without a seabed.
fn seabed_below(scene: &Scene) -> impl Fn(Vector3<f64>) -> Option<FlatSeabed> {
    let seabed = scene.seabed.as_ref();
    let shape = seabed.and_then(super::seabed);
    move |place| {
        let height = match &shape {
            Some(Seabed {
                ground, level: false, ..
            }) => ground.height(place.x, place.y),
            _ => -seabed?.depth,
        };
        let friction = seabed?.friction.axial;
        let height = height - place.z;
        Some(FlatSeabed { height, friction })
    }
}

/// Closed-form catenaries by `hang` between the ends of a line, at their reference positions and during the scene's motion; true if a motion is given.
fn shapes(
    scene: &Scene,
    ends: [&Point; 2],
    vessels: &[Vessel],
    hang: impl Fn(Vector3<f64>, Vector3<f64>) -> Option<Catenary>,
) -> (Vec<Catenary>, bool) {
    let paths = ends.map(|point| path(scene, vessels, point));
    let [a, b] = ends.map(|point| point.reference);
    let known = paths.iter().any(|path| path.len() > 1);
    let mut shapes = vec![hang(a, b)];
    for k in 0..if known { MOMENTS } else { 0 } {
        let [a, b] = [0, 1].map(|end| paths[end][k.min(paths[end].len() - 1)]);
        shapes.push(hang(a, b));
    }
    (shapes.into_iter().flatten().collect(), known)
}

/// Positions of a point [m] during the scene's motion; only its reference position if there is no motion.
fn path(scene: &Scene, vessels: &[Vessel], point: &Point) -> Vec<Vector3<f64>> {
    let place = |t: f64| match &point.role {
        Role::Coupled { motion: Some(motion) } | Role::Prescribed(motion) => {
            Some(point.reference + motion.at(t).position)
        }
        Role::Carried { vessel, arm } => {
            let vessel = &vessels[*vessel];
            let pose = vessel.motion()?.pose(t);
            Some(vessel.carry(&vessel.frame_of_motion(&pose), *arm).position)
        }
        _ => None,
    };
    let step = scene.output.duration / MOMENTS as f64;
    let places: Option<Vec<_>> = (1..=MOMENTS).map(|k| place(step * k as f64)).collect();
    places.unwrap_or_else(|| vec![point.reference])
}

/// Closed-form catenary of a line with a chord [m] from end A, if there is one.
fn hang(
    line: &scene::Line,
    laws: &[LineLaw],
    seabed: Option<FlatSeabed>,
    chord: Vector3<f64>,
) -> Option<Catenary> {
    let sections = catenary_sections(line, laws);
    catenary::solve(&sections, chord.xy().norm(), chord.z, seabed).ok()
}

/// Ranges of arc length [m] over which the ends of the part on the seabed move, excluding the ends of the line.
fn touchdowns(shapes: &[Catenary], total: f64) -> Vec<[f64; 2]> {
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    for shape in shapes {
        let mut ends: Vec<f64> = Vec::new();
        for (from, to) in shape.laid() {
            match ends.last_mut() {
                Some(last) if from <= *last + ROUNDING * total => *last = to,
                _ => ends.extend([from, to]),
            }
        }
        ends.retain(|s| (ROUNDING * total..=(1.0 - ROUNDING) * total).contains(s));
        ranges.extend(ends.iter().skip(ranges.len()).map(|&s| [s, s]));
        for (range, s) in ranges.iter_mut().zip(ends) {
            *range = [range[0].min(s), range[1].max(s)];
        }
    }
    ranges
}

/// Properties of a line at an arc length [m].
fn section_at<'a>(line: &scene::Line, laws: &'a [LineLaw], s: f64) -> &'a LineLaw {
    let mut end = 0.0;
    let at = line.sections.iter().position(|section| {
        end += section.length;
        s <= end
    });
    &laws[at.unwrap_or(laws.len() - 1)]
}

/// Number and lengths of the elements of a scene's lines with the reasons: one sentence per line.
pub(super) fn in_words(scene: &Scene, model: &Model) -> Vec<String> {
    let shares = elements(scene);
    let lines = scene.lines.iter().zip(&model.lines).zip(shares);
    lines
        .map(|((line, built), share)| {
            let lengths = &built.segments.length;
            let least = lengths.iter().copied().fold(f64::INFINITY, f64::min);
            let most = lengths.iter().copied().fold(0.0, f64::max);
            let range = if most - least <= 1e-6 * most {
                metres(least)
            } else {
                format!("{} to {}", metres(least).trim_end_matches(" m"), metres(most))
            };
            let plural = if lengths.len() == 1 { "" } else { "s" };
            let count = format!("{}: {} element{plural} of {range}", line.name, lengths.len());
            let reasons = reasons(scene, model, line, built, share);
            [vec![count], reasons].concat().join(", ")
        })
        .collect()
}

fn reasons(scene: &Scene, model: &Model, line: &scene::Line, built: &Line, share: f64) -> Vec<String> {
    if line.sections.iter().all(|section| section.elements.is_some()) {
        return vec!["as given".to_string()];
    }
    let is_in_proportion = line.elements.is_none() && share < alone(scene);
    let mut reasons = Vec::new();
    match line.elements.or(scene.solver.elements) {
        None => reasons.push(format!(
            "by rules for a target error of {}",
            percent(scene.solver.tolerance)
        )),
        Some(_) if is_in_proportion => {}
        Some(elements) if elements == built.segment_count() => {}
        Some(elements) => reasons.push(format!("{elements} rounded to its sections")),
    }
    if is_in_proportion {
        reasons.push("in proportion to the longest line that it is tied to".to_string());
    }
    let types = line
        .sections
        .iter()
        .map(|section| scene.line_types.get(&section.line_type));
    let laws = types.flatten().map(|kind| line_law(scene, kind, 0.0)); // damping does not matter here
    let laws: Vec<LineLaw> = laws.collect();
    if laws.len() < line.sections.len() || built.beam.is_some() {
        return reasons;
    }
    let ends = built.ends.map(|end| &model.points[end]);
    for wanted in refinements(scene, line, ends, &model.vessels, &laws) {
        let place = match wanted.place {
            Place::ClampA => "the clamp at end A",
            Place::ClampB => "the clamp at end B",
            Place::Touchdown => "the touchdown",
        };
        let (arc, lengths) = (&built.nodes.arc, &built.segments.length);
        let inside = arc.windows(2).zip(lengths);
        let inside = inside.filter(|(arc, _)| arc[1] > wanted.from && arc[0] < wanted.to);
        let found = inside.map(|(_, length)| *length).fold(0.0, f64::max);
        let bend = wanted.bend;
        let resolved = match wanted.place {
            Place::Touchdown => bend,
            Place::ClampA | Place::ClampB => CLAMP_LENGTH_MAX * bend,
        };
        let coarse = if found > resolved {
            ", which they do not resolve"
        } else {
            ""
        };
        let [found, bend] = [found, bend].map(metres);
        reasons.push(format!("{found} at {place} for a bend of {bend}{coarse}"));
    }
    reasons
}
