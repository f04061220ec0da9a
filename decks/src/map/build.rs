//! MAP++ deck -> Scene.

use moorline::scene::{
    self, Friction, Integrator, Point, PointKind, STANDARD_GRAVITY, Seabed, Solver, Water,
};

use super::deck::{Coordinate, Deck, Kind, Line, Node};
use crate::draft::{Draft, SEA_WATER, constant_force, coordinates, nonzero};
use crate::table::ROWS_MAX;

/// Height above the seabed up to which a node lies on it, relative to the depth [-].
const ON_SEABED: f64 = 1e-6;

/// Repetition of the deck.
#[derive(Clone, Copy)]
struct Turn {
    /// Number of preceding repetitions [-].
    number: usize,
    /// Angle about z [rad].
    angle: f64,
}

/// Builds the scene of a deck; mistakes concern values that the deck leaves to its host, or features that are not modelled.
pub(super) fn build(deck: &Deck, draft: &mut Draft<'_>) {
    draft.scene.title = deck.title.clone();
    draft.scene.water = Some(Water::still(SEA_WATER));
    draft.scene.solver = Solver {
        integrator: Integrator::QuasiStatic,
        ..Solver::default()
    };
    draft.check_given(std::iter::empty());
    needs_depth(deck, draft);
    line_types(deck, draft);
    numbers_out_of_order(deck, draft);
    for turn in turns(deck, draft) {
        for node in &deck.nodes {
            add_node(node, deck, turn, draft);
        }
        for line in &deck.lines {
            add_line(line, deck, turn, draft);
        }
    }
    seabed(deck, draft);
    remarks(deck, draft);
    draft.check_vessels();
}

/// Refuses the word `depth` if no depth is given.
fn needs_depth(deck: &Deck, draft: &mut Draft<'_>) {
    let mut coordinates = deck.nodes.iter().flat_map(|node| &node.position);
    let word = coordinates.find(|coordinate| coordinate.value == Coordinate::Depth);
    if let (None, Some(word)) = (draft.supplement.depth, word) {
        draft.findings.wrong(
            "NODE PROPERTIES, Z",
            word,
            "the host of MAP++ gives the water depth, and the file has none: add `--depth 320` to the command, or write the z of the \
             seabed in place of `depth`",
        );
    }
}

fn line_types(deck: &Deck, draft: &mut Draft<'_>) {
    for kind in &deck.line_types {
        let line_type = scene::LineType {
            mass: Some(kind.mass.value),
            diameter: Some(kind.diameter.value),
            axial_stiffness: Some(kind.stiffness.value),
            ..scene::LineType::default()
        };
        let parts = [
            ("mass", &kind.mass.span, "MassDenInAir"),
            ("diameter", &kind.diameter.span, "Diam"),
            ("axial_stiffness", &kind.stiffness.span, "EA"),
        ];
        draft.add_line_type(&kind.name, line_type, &parts);
    }
}

/// Returns the deck as written and its repetitions.
fn turns(deck: &Deck, draft: &mut Draft<'_>) -> Vec<Turn> {
    let most = deck.nodes.len().max(deck.lines.len());
    if let Some(last) = deck.repeat.last()
        && (deck.repeat.len() + 1) * most > ROWS_MAX
    {
        let problem = format!("repeated, the system has more than {ROWS_MAX} nodes or lines");
        draft.findings.wrong("repeat", last, problem);
        return Vec::new();
    }
    // MAP++ turns from y to x, clockwise as seen from above
    let angles = deck.repeat.iter().map(|angle| -angle.value.to_radians());
    let turns = std::iter::once(0.0).chain(angles).enumerate();
    turns.map(|(number, angle)| Turn { number, angle }).collect()
}

fn add_node(node: &Node, deck: &Deck, turn: Turn, draft: &mut Draft<'_>) {
    let depth = draft.supplement.depth.unwrap_or(0.0);
    let position = node.position.each_ref().map(|coordinate| match coordinate.value {
        Coordinate::Given(value) => value,
        Coordinate::Depth => -depth,
    });
    let name = point_name(deck, node.id.value, turn);
    let fixed = Point::at(name, turned(position, turn.angle), PointKind::Fixed);
    let free = Point {
        kind: PointKind::Free,
        mass: nonzero(node.mass.value),
        volume: nonzero(node.volume.value),
        ..fixed.clone()
    };
    let point = match node.kind {
        Kind::Fix => fixed,
        // the host's structure has the mass and the volume of a vessel node, as in MAP++
        Kind::Vessel => draft.aboard(fixed, draft.vessel_of_the_deck(), [0.0; 3], [0.0; 3]),
        Kind::Connect => Point {
            force: constant_force(turned(node.force, turn.angle)),
            ..free
        },
    };
    let [x, y, z] = coordinates(&node.position);
    let parts = [
        x,
        y,
        z,
        ("mass", &node.mass.span, "M"),
        ("volume", &node.volume.span, "B"),
    ];
    draft.add_point(point, &node.id.span, &format!("node {}", node.id.value), &parts);
}

fn add_line(line: &Line, deck: &Deck, turn: Turn, draft: &mut Draft<'_>) {
    let numbers = deck.lines.iter().map(|line| line.id.value);
    let name = format!("line{}", repeated(line.id.value, turn, numbers));
    let ends = line.ends.each_ref().map(|end| point_name(deck, end.value, turn));
    let made = draft.line(name, ends, &line.line_type.value, line.length.value, None);
    let parts = [
        ("from", &line.ends[0].span, "NodeAnch"),
        ("to", &line.ends[1].span, "NodeFair"),
        ("sections[0].type", &line.line_type.span, "LineType"),
        ("sections[0].length", &line.length.span, "UnstrLen"),
    ];
    draft.add_line(made, &line.id.span, &format!("line {}", line.id.value), &parts);
}

/// Adds the seabed if all lines are in contact with it; refuses a deck in which only some are.
fn seabed(deck: &Deck, draft: &mut Draft<'_>) {
    let omitting: Vec<_> = deck
        .lines
        .iter()
        .filter_map(|line| line.omits_contact.as_ref())
        .collect();
    match omitting.last() {
        Some(flag) if omitting.len() < deck.lines.len() => draft.findings.wrong(
            "LINE PROPERTIES, flags",
            flag,
            "some lines that meet the seabed and some that do not are not modelled: flag all of them, or none",
        ),
        Some(_) => {}
        None => {
            let depth = draft.depth(None, false);
            let friction = Friction::isotropic(friction(deck, draft));
            draft.scene.seabed = depth.map(|depth| Seabed {
                friction,
                ..Seabed::level(depth)
            });
            if let Some(depth) = depth {
                anchors_above(deck, depth, draft);
            }
        }
    }
}

/// Adds a note on the first node whose number is not that of its row, by which MAP++ finds the ends of lines.
fn numbers_out_of_order(deck: &Deck, draft: &mut Draft<'_>) {
    let mut rows = (1..).zip(&deck.nodes);
    if let Some((row, node)) = rows.find(|(row, node)| node.id.value != *row) {
        let text = format!(
            "node {} is in row {row}: in MAP++ the ends of lines are numbers of rows, and here they are the numbers of nodes",
            node.id.value
        );
        draft.findings.remark(&node.id, text);
    }
}

/// Adds a note for each line whose fixed node lies above the seabed. In MAP++ every line has a separate level seabed, at its NodeAnch.
fn anchors_above(deck: &Deck, depth: f64, draft: &mut Draft<'_>) {
    for line in &deck.lines {
        let [anchor, _] = &line.ends;
        let mut nodes = deck.nodes.iter();
        let node = nodes.find(|node| node.id.value == anchor.value && node.kind == Kind::Fix);
        let Some(Coordinate::Given(z)) = node.map(|node| node.position[2].value) else {
            continue;
        };
        if z + depth > ON_SEABED * depth {
            let text = format!(
                "NodeAnch is at z = {z} m, and the seabed at z = {} m: in MAP++ the seabed of a line is at the level of its NodeAnch",
                -depth
            );
            draft.findings.remark(anchor, text);
        }
    }
}

/// Returns the friction coefficient [-], which must be the same for all line types in use.
fn friction(deck: &Deck, draft: &mut Draft<'_>) -> f64 {
    let used = |name: &str| deck.lines.iter().any(|line| line.line_type.value == name);
    let mut types = deck.line_types.iter().filter(|kind| used(&kind.name.value));
    let Some(first) = types.next() else {
        return 0.0;
    };
    if let Some(other) = types.find(|kind| kind.friction.value != first.friction.value) {
        let problem = format!(
            "friction {} here and {} on {}: the seabed has one coefficient, write the same CB for all",
            other.friction.value, first.friction.value, first.name.value
        );
        draft
            .findings
            .wrong("LINE DICTIONARY, CB", &other.friction, problem);
    }
    draft
        .places
        .put("seabed.friction", &first.friction.span, "LINE DICTIONARY, CB");
    first.friction.value
}

fn remarks(deck: &Deck, draft: &mut Draft<'_>) {
    draft.findings.remark_on_all(
        "quasi-static, as MAP++ is: an equilibrium at every communication point, without inertia, damping and drag; for dynamics \
         write another `integrator` in [solver] of the scene that `moorline convert` makes, and damping, drag and added mass of the \
         lines, for MAP++ uses neither CIntDamp, Ca, Cdn nor Cdt and they are left out",
    );
    draft.findings.remark_on_all(format!(
        "density and gravity are not in a MAP++ file: {SEA_WATER} kg/m³ and {STANDARD_GRAVITY} m/s² are taken"
    ));
    if let Some(first) = deck.unneeded.first() {
        let keys: Vec<&str> = deck.unneeded.iter().map(|key| key.value.as_str()).collect();
        let text = format!("options without effect: {}", keys.join(", "));
        draft.findings.remark(first, text);
    }
}

/// Returns the number of a node or line in a repetition: each repetition adds the highest number in the file.
fn repeated(number: usize, turn: Turn, numbers: impl Iterator<Item = usize>) -> usize {
    number.saturating_add(turn.number.saturating_mul(numbers.max().unwrap_or(0)))
}

fn point_name(deck: &Deck, number: usize, turn: Turn) -> String {
    let numbers = deck.nodes.iter().map(|node| node.id.value);
    format!("point{}", repeated(number, turn, numbers))
}

/// Rotates a vector about z by an angle [rad]; an angle of zero returns identical bits.
fn turned([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    if angle == 0.0 {
        return [x, y, z];
    }
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y, z]
}
