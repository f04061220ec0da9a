//! MAP++ deck -> Scene.

use std::collections::{BTreeMap, BTreeSet};

use super::deck::{Coordinate, Deck, Kind, Node};
use crate::scene::from_deck::{self, SEA_WATER, Vessels, bed};
use crate::scene::rows::{Findings, Placed, ROWS_MAX};
use crate::scene::{
    self, Places, Point, PointForce, PointKind, Scene, Section, Supplement, TimeFunction, Water,
};

/// The scene of a deck; `None` where something it leaves to its host is missing, or cannot be modelled.
pub(super) fn scene(
    deck: &Deck,
    supplement: &Supplement,
    places: &mut Places,
    findings: &mut Findings,
) -> Option<Scene> {
    let mut scene = Scene {
        title: deck.title.clone(),
        water: Some(Water { density: SEA_WATER }),
        ..Scene::default()
    };
    let depth = known_depth(deck, supplement, findings)?;
    let types = line_types(deck, &mut scene, places, findings);
    let vessels = Vessels { supplement };
    let turns = turns(deck, findings)?;
    for (turn, angle) in turns.iter().enumerate() {
        for node in &deck.nodes {
            let point = point(deck, node, turn, *angle, depth, &mut scene, &vessels, places);
            scene.points.push(point);
        }
        lines(deck, turn, &types, &mut scene, places);
    }
    if contact(deck, findings)? {
        let depth = from_deck::depth(depth, supplement, &scene.points, findings);
        scene.seabed = depth.map(bed);
        if let Some(seabed) = &mut scene.seabed {
            seabed.friction = friction(deck, places, findings)?;
        }
    }
    remarks(deck, findings);
    vessels.check(&scene, findings);
    findings.mistakes.is_empty().then_some(scene)
}

/// The depth [m] that the word `depth` needs: `Some(None)` where no node says it.
#[expect(clippy::option_option, reason = "without a value, or with a mistake instead of one")]
fn known_depth(
    deck: &Deck,
    supplement: &Supplement,
    findings: &mut Findings,
) -> Option<Option<f64>> {
    let mut coordinates = deck.nodes.iter().flat_map(|node| &node.position);
    let word = coordinates.find(|coordinate| coordinate.value == Coordinate::Depth);
    match (supplement.depth, word) {
        (None, Some(word)) => {
            findings.mistake(
                "NODE PROPERTIES, Z",
                word.span.clone(),
                "the host of MAP++ gives the water depth, and the file has none: say it with `moorline convert FILE \
                 --depth 320 -o scene.toml`, or write the z of the bed in place of `depth`",
            );
            None
        }
        (depth, _) => Some(depth),
    }
}

fn line_types<'d>(
    deck: &'d Deck,
    scene: &mut Scene,
    places: &mut Places,
    findings: &mut Findings,
) -> BTreeMap<&'d str, String> {
    let mut types = BTreeMap::new();
    let mut taken = BTreeSet::new();
    for kind in &deck.line_types {
        let name = from_deck::type_name(&kind.name.value, &taken);
        from_deck::remark_on_name(&kind.name, &name, findings);
        taken.insert(name.clone());
        let at = format!("line_types.{}", scene::path::quoted(&name));
        let words = format!("line type {}", kind.name.value);
        places.put(at.clone(), &kind.name.span, words.clone());
        for (key, cell, column) in [
            ("mass", &kind.mass, "MassDenInAir"),
            ("diameter", &kind.diameter, "Diam"),
            ("axial_stiffness", &kind.stiffness, "EA"),
        ] {
            places.put(format!("{at}.{key}"), &cell.span, format!("{words}, {column}"));
        }
        types.insert(kind.name.value.as_str(), name.clone());
        let line_type = scene::LineType {
            mass: Some(kind.mass.value),
            diameter: Some(kind.diameter.value),
            axial_stiffness: kind.stiffness.value,
            ..scene::LineType::default()
        };
        scene.line_types.insert(name, line_type);
    }
    types
}

/// Angles [rad] at which the system stands: as written, then repeated.
fn turns(deck: &Deck, findings: &mut Findings) -> Option<Vec<f64>> {
    let most = deck.nodes.len().max(deck.lines.len());
    if let Some(last) = deck.repeat.last()
        && (deck.repeat.len() + 1) * most > ROWS_MAX
    {
        let problem = format!("repeated, the system has more than {ROWS_MAX} nodes or lines");
        findings.mistake("repeat", last.span.clone(), problem);
        return None;
    }
    let angles = deck.repeat.iter().map(|angle| angle.value.to_radians());
    Some(std::iter::once(0.0).chain(angles).collect())
}

/// Number of a node or line in a repetition: the highest number of the file is added for each.
fn repeated(id: usize, turn: usize, ids: impl Iterator<Item = usize>) -> usize {
    id.saturating_add(turn.saturating_mul(ids.max().unwrap_or(0)))
}

fn point_name(deck: &Deck, id: usize, turn: usize) -> String {
    let ids = deck.nodes.iter().map(|node| node.id.value);
    format!("point{}", repeated(id, turn, ids))
}

#[expect(clippy::too_many_arguments, reason = "what a node needs of its surroundings, once")]
fn point(
    deck: &Deck,
    node: &Node,
    turn: usize,
    angle: f64,
    depth: Option<f64>,
    scene: &mut Scene,
    vessels: &Vessels<'_>,
    places: &mut Places,
) -> Point {
    let at = format!("points[{}]", scene.points.len());
    let words = format!("node {}", node.id.value);
    places.put(at.clone(), &node.id.span, words.clone());
    for (axis, (coordinate, letter)) in node.position.iter().zip(["X", "Y", "Z"]).enumerate() {
        let words = format!("{words}, {letter}");
        places.put(format!("{at}.position[{axis}]"), &coordinate.span, words);
    }
    places.put(format!("{at}.mass"), &node.mass.span, format!("{words}, M"));
    places.put(format!("{at}.volume"), &node.volume.span, format!("{words}, B"));
    let position = node.position.each_ref().map(|coordinate| match coordinate.value {
        Coordinate::Given(value) => value,
        Coordinate::Depth => -depth.unwrap_or(0.0),
    });
    let position = turned(position, angle);
    let name = point_name(deck, node.id.value, turn);
    let fixed = Point::at(name, position, PointKind::Fixed);
    match node.kind.value {
        Kind::Fix => fixed,
        Kind::Vessel => Point {
            kind: PointKind::Coupled,
            on: Some(vessels.board(scene, "vessel", [0.0; 3], [0.0; 3])),
            ..fixed
        },
        Kind::Connect => Point {
            kind: PointKind::Free,
            mass: (node.mass.value != 0.0).then_some(node.mass.value),
            volume: (node.volume.value != 0.0).then_some(node.volume.value),
            force: force(&node.force, angle),
            ..fixed
        },
    }
}

/// Turned about z by an angle [rad]; exactly as it was by none.
fn turned([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    if angle == 0.0 {
        return [x, y, z];
    }
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y, z]
}

fn force(given: &[Placed<f64>; 3], angle: f64) -> Option<PointForce> {
    let force = turned(given.each_ref().map(|part| part.value), angle);
    let [x, y, z] = force.map(|part| (part != 0.0).then_some(TimeFunction::Constant(part)));
    let some = x.is_some() || y.is_some() || z.is_some();
    some.then_some(PointForce { x, y, z })
}

fn lines(
    deck: &Deck,
    turn: usize,
    types: &BTreeMap<&str, String>,
    scene: &mut Scene,
    places: &mut Places,
) {
    for line in &deck.lines {
        let at = format!("lines[{}]", scene.lines.len());
        let words = format!("line {}", line.id.value);
        for (key, span, column) in [
            ("", &line.id.span, ""),
            (".from", &line.ends[0].span, ", NodeAnch"),
            (".to", &line.ends[1].span, ", NodeFair"),
            (".sections[0].type", &line.line_type.span, ", LineType"),
            (".sections[0].length", &line.length.span, ", UnstrLen"),
        ] {
            places.put(format!("{at}{key}"), span, format!("{words}{column}"));
        }
        let section = Section {
            line_type: types[line.line_type.value.as_str()].clone(),
            length: line.length.value,
            elements: None,
        };
        let ids = deck.lines.iter().map(|line| line.id.value);
        let name = format!("line{}", repeated(line.id.value, turn, ids));
        let [from, to] = line.ends.each_ref().map(|end| point_name(deck, end.value, turn));
        scene.lines.push(scene::Line::between(name, from, to, vec![section]));
    }
}

/// Whether the lines meet the bed: all of them do, or none.
fn contact(deck: &Deck, findings: &mut Findings) -> Option<bool> {
    let omitting = deck.lines.iter().filter_map(|line| line.omits_contact.as_ref());
    let count = omitting.clone().count();
    match omitting.last() {
        Some(flag) if count < deck.lines.len() => {
            let problem = "some lines that meet the bed and some that do not are not modelled: flag all of them, or none";
            findings.mistake("LINE PROPERTIES, flags", flag.span.clone(), problem);
            None
        }
        Some(_) => Some(false),
        None => Some(true),
    }
}

/// The one friction coefficient [-] of all line types that lines use.
fn friction(deck: &Deck, places: &mut Places, findings: &mut Findings) -> Option<f64> {
    let used = |name: &str| deck.lines.iter().any(|line| line.line_type.value == name);
    let mut types = deck.line_types.iter().filter(|kind| used(&kind.name.value));
    let first = types.next()?;
    if let Some(other) = types.find(|kind| kind.friction.value != first.friction.value) {
        let problem = format!(
            "friction {} here and {} on {}: the bed has one coefficient, write the same CB for all",
            other.friction.value, first.friction.value, first.name.value
        );
        findings.mistake("LINE DICTIONARY, CB", other.friction.span.clone(), problem);
        return None;
    }
    places.put("seabed.friction", &first.friction.span, "LINE DICTIONARY, CB");
    Some(first.friction.value)
}

fn remarks(deck: &Deck, findings: &mut Findings) {
    findings.remark_on_all(
        "MAP++ uses neither CIntDamp, Ca, Cdn nor Cdt, and they are left out: a run in time needs the damping, drag and \
         added mass of the lines in the scene",
    );
    findings.remark_on_all(format!(
        "density and gravity are not in a MAP++ file: {SEA_WATER} kg/m³ and {} m/s² are taken",
        scene::STANDARD_GRAVITY
    ));
    if let Some(first) = deck.unneeded.first() {
        let keys: Vec<&str> = deck.unneeded.iter().map(|key| key.value.as_str()).collect();
        let text = format!("options that nothing here needs: {}", keys.join(", "));
        findings.remark(first.span.start, text);
    }
}
