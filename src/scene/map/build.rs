//! MAP++ deck -> Scene.

use std::collections::{BTreeMap, BTreeSet};

use super::deck::{Coordinate, Deck, Kind, Node};
use crate::scene::from_deck::{self, SEA_WATER, Vessels};
use crate::scene::rows::{Findings, Placed, ROWS_MAX};
use crate::scene::{
    self, AngleOrder, Friction, Integrator, Places, Point, PointForce, PointKind, Scene, Seabed, Section,
    Solver, Supplement, TimeFunction, Water,
};

/// A deck on its way to a scene.
struct Builder<'d> {
    deck: &'d Deck,
    scene: Scene,
    vessels: Vessels<'d>,
    places: &'d mut Places,
    findings: &'d mut Findings,
    /// Line types by the name in the deck.
    types: BTreeMap<&'d str, String>,
}

/// A repetition of the deck.
#[derive(Clone, Copy)]
struct Turn {
    /// How many have been before it.
    number: usize,
    /// About z [rad].
    angle: f64,
}

/// The scene of a deck; `None` where something it leaves to its host is missing, or cannot be modelled.
pub(super) fn scene(
    deck: &Deck,
    supplement: &Supplement,
    places: &mut Places,
    findings: &mut Findings,
) -> Option<Scene> {
    let mut builder = Builder {
        deck,
        scene: Scene {
            title: deck.title.clone(),
            water: Some(Water::still(SEA_WATER)),
            solver: Solver {
                integrator: Integrator::QuasiStatic,
                ..Solver::default()
            },
            ..Scene::default()
        },
        vessels: Vessels {
            supplement,
            motion_angles: AngleOrder::Zyx,
        },
        places,
        findings,
        types: BTreeMap::new(),
    };
    builder.vessels.check_given(std::iter::empty(), builder.findings);
    builder.needs_depth();
    builder.line_types();
    for turn in builder.turns() {
        builder.points(turn);
        builder.lines(turn);
    }
    builder.seabed();
    builder.remarks();
    let Builder {
        scene,
        vessels,
        findings,
        ..
    } = builder;
    vessels.check(&scene, findings);
    findings.mistakes.is_empty().then_some(scene)
}

impl Builder<'_> {
    /// The word `depth` needs a depth.
    fn needs_depth(&mut self) {
        let mut coordinates = self.deck.nodes.iter().flat_map(|node| &node.position);
        let word = coordinates.find(|coordinate| coordinate.value == Coordinate::Depth);
        if let (None, Some(word)) = (self.vessels.supplement.depth, word) {
            self.findings.mistake(
                "NODE PROPERTIES, Z",
                word.span.clone(),
                "the host of MAP++ gives the water depth, and the file has none: say it with `moorline convert FILE \
                 --depth 320 -o scene.toml`, or write the z of the bed in place of `depth`",
            );
        }
    }

    fn line_types(&mut self) {
        let mut taken = BTreeSet::new();
        for kind in &self.deck.line_types {
            let name = from_deck::type_name(&kind.name.value, &taken);
            from_deck::remark_on_name(&kind.name, &name, self.findings);
            taken.insert(name.clone());
            let at = format!("line_types.{}", scene::path::quoted(&name));
            let words = format!("line type {}", kind.name.value);
            self.places.put(at.clone(), &kind.name.span, words.clone());
            for (key, cell, column) in [
                ("mass", &kind.mass, "MassDenInAir"),
                ("diameter", &kind.diameter, "Diam"),
                ("axial_stiffness", &kind.stiffness, "EA"),
            ] {
                let words = format!("{words}, {column}");
                self.places.put(format!("{at}.{key}"), &cell.span, words);
            }
            self.types.insert(kind.name.value.as_str(), name.clone());
            let line_type = scene::LineType {
                mass: Some(kind.mass.value),
                diameter: Some(kind.diameter.value),
                axial_stiffness: Some(kind.stiffness.value),
                ..scene::LineType::default()
            };
            self.scene.line_types.insert(name, line_type);
        }
    }

    /// As written, then repeated.
    fn turns(&mut self) -> Vec<Turn> {
        let deck = self.deck;
        let most = deck.nodes.len().max(deck.lines.len());
        if let Some(last) = deck.repeat.last()
            && (deck.repeat.len() + 1) * most > ROWS_MAX
        {
            let problem = format!("repeated, the system has more than {ROWS_MAX} nodes or lines");
            self.findings.mistake("repeat", last.span.clone(), problem);
            return Vec::new();
        }
        let angles = deck.repeat.iter().map(|angle| angle.value.to_radians());
        let turns = std::iter::once(0.0).chain(angles).enumerate();
        turns.map(|(number, angle)| Turn { number, angle }).collect()
    }

    fn points(&mut self, turn: Turn) {
        for node in &self.deck.nodes {
            let at = format!("points[{}]", self.scene.points.len());
            let words = format!("node {}", node.id.value);
            self.places.put(at.clone(), &node.id.span, words.clone());
            for (axis, (coordinate, letter)) in node.position.iter().zip(["X", "Y", "Z"]).enumerate() {
                let words = format!("{words}, {letter}");
                self.places
                    .put(format!("{at}.position[{axis}]"), &coordinate.span, words);
            }
            self.places
                .put(format!("{at}.mass"), &node.mass.span, format!("{words}, M"));
            self.places
                .put(format!("{at}.volume"), &node.volume.span, format!("{words}, B"));
            let point = self.point(node, turn);
            self.scene.points.push(point);
        }
    }

    fn point(&mut self, node: &Node, turn: Turn) -> Point {
        let depth = self.vessels.supplement.depth.unwrap_or(0.0);
        let position = node.position.each_ref().map(|coordinate| match coordinate.value {
            Coordinate::Given(value) => value,
            Coordinate::Depth => -depth,
        });
        let name = point_name(self.deck, node.id.value, turn);
        let fixed = Point::at(name, turned(position, turn.angle), PointKind::Fixed);
        match node.kind.value {
            Kind::Fix => fixed,
            Kind::Vessel => Point {
                mass: (node.mass.value != 0.0).then_some(node.mass.value),
                volume: (node.volume.value != 0.0).then_some(node.volume.value),
                kind: PointKind::Coupled,
                on: Some(
                    self.vessels
                        .board(&mut self.scene, self.vessels.of_the_deck(), [0.0; 3], [0.0; 3]),
                ),
                ..fixed
            },
            Kind::Connect => Point {
                kind: PointKind::Free,
                mass: (node.mass.value != 0.0).then_some(node.mass.value),
                volume: (node.volume.value != 0.0).then_some(node.volume.value),
                force: force(&node.force, turn.angle),
                ..fixed
            },
        }
    }

    fn lines(&mut self, turn: Turn) {
        for line in &self.deck.lines {
            let at = format!("lines[{}]", self.scene.lines.len());
            let words = format!("line {}", line.id.value);
            for (key, span, column) in [
                ("", &line.id.span, ""),
                (".from", &line.ends[0].span, ", NodeAnch"),
                (".to", &line.ends[1].span, ", NodeFair"),
                (".sections[0].type", &line.line_type.span, ", LineType"),
                (".sections[0].length", &line.length.span, ", UnstrLen"),
            ] {
                self.places
                    .put(format!("{at}{key}"), span, format!("{words}{column}"));
            }
            let section = Section {
                line_type: self.types[line.line_type.value.as_str()].clone(),
                length: line.length.value,
                elements: None,
                damping_elements: None,
            };
            let ids = self.deck.lines.iter().map(|line| line.id.value);
            let name = format!("line{}", repeated(line.id.value, turn, ids));
            let [from, to] = line
                .ends
                .each_ref()
                .map(|end| point_name(self.deck, end.value, turn));
            self.scene
                .lines
                .push(scene::Line::between(name, from, to, vec![section]));
        }
    }

    /// The bed that all lines meet, or none of them.
    fn seabed(&mut self) {
        let mut omitting = self
            .deck
            .lines
            .iter()
            .filter_map(|line| line.omits_contact.as_ref());
        let count = omitting.clone().count();
        match omitting.next_back() {
            Some(flag) if count < self.deck.lines.len() => {
                let problem = "some lines that meet the bed and some that do not are not modelled: flag all of them, or none";
                self.findings
                    .mistake("LINE PROPERTIES, flags", flag.span.clone(), problem);
            }
            Some(_) => {}
            None => {
                let supplement = self.vessels.supplement;
                let depth = from_deck::depth(None, supplement, &self.scene.points, self.findings);
                self.scene.seabed = depth.map(Seabed::level);
                let friction = self.friction();
                if let Some(seabed) = &mut self.scene.seabed {
                    seabed.friction = Friction::isotropic(friction);
                }
            }
        }
    }

    /// The one friction coefficient [-] of all line types that lines use.
    fn friction(&mut self) -> f64 {
        let used = |name: &str| self.deck.lines.iter().any(|line| line.line_type.value == name);
        let mut types = self.deck.line_types.iter().filter(|kind| used(&kind.name.value));
        let Some(first) = types.next() else {
            return 0.0;
        };
        if let Some(other) = types.find(|kind| kind.friction.value != first.friction.value) {
            let problem = format!(
                "friction {} here and {} on {}: the bed has one coefficient, write the same CB for all",
                other.friction.value, first.friction.value, first.name.value
            );
            self.findings
                .mistake("LINE DICTIONARY, CB", other.friction.span.clone(), problem);
        }
        self.places
            .put("seabed.friction", &first.friction.span, "LINE DICTIONARY, CB");
        first.friction.value
    }

    fn remarks(&mut self) {
        self.findings.remark_on_all(
            "quasi-static, as MAP++ is: an equilibrium at every communication point, without inertia, damping and drag; for dynamics \
             write another `integrator` in [solver] of the scene that `moorline convert` makes, and damping, drag and added mass of the \
             lines, for MAP++ uses neither CIntDamp, Ca, Cdn nor Cdt and they are left out",
        );
        self.findings.remark_on_all(format!(
            "density and gravity are not in a MAP++ file: {SEA_WATER} kg/m³ and {} m/s² are taken",
            scene::STANDARD_GRAVITY
        ));
        if let Some(first) = self.deck.unneeded.first() {
            let keys: Vec<&str> = self.deck.unneeded.iter().map(|key| key.value.as_str()).collect();
            let text = format!("options that nothing here needs: {}", keys.join(", "));
            self.findings.remark(first.span.start, text);
        }
    }
}

/// Number of a node or line in a repetition: the highest number of the file is added for each.
fn repeated(id: usize, turn: Turn, ids: impl Iterator<Item = usize>) -> usize {
    id.saturating_add(turn.number.saturating_mul(ids.max().unwrap_or(0)))
}

fn point_name(deck: &Deck, id: usize, turn: Turn) -> String {
    let ids = deck.nodes.iter().map(|node| node.id.value);
    format!("point{}", repeated(id, turn, ids))
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
