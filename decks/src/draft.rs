//! Scene under construction from a deck, with the values that a deck leaves to its host: depth of the water, positions of vessels.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use moorline::scene::name_problem;
use moorline::scene::path::quoted;
use moorline::scene::{
    AngleOrder, Line, LineType, Places, Point, PointForce, PointKind, Scene, Section, TimeFunction, Vessel,
};

use crate::Supplement;
use crate::findings::{Findings, Placed};

/// Density of sea water [kg/m³] for a deck that does not specify one.
pub(crate) const SEA_WATER: f64 = 1025.0;

/// Part of an object in a deck: key in the scene, byte range in the file, name of its column.
pub(crate) type Part<'p> = (&'static str, &'p Range<usize>, &'static str);

/// Scene under construction from a deck. It is complete if there are no mistakes.
pub(crate) struct Draft<'s> {
    /// Name of the format of the file.
    pub format: &'static str,
    pub scene: Scene,
    pub places: Places,
    pub findings: Findings,
    pub supplement: &'s Supplement,
    /// Order of the angles in the motions from hosts of such decks.
    pub motion_angles: AngleOrder,
    /// Names of the line types in the scene, by their names in the deck.
    types: BTreeMap<String, String>,
}

impl<'s> Draft<'s> {
    /// Returns an empty draft.
    pub(crate) fn new(
        format: &'static str,
        findings: Findings,
        supplement: &'s Supplement,
        motion_angles: AngleOrder,
    ) -> Draft<'s> {
        Draft {
            format,
            scene: Scene::default(),
            places: Places::default(),
            findings,
            supplement,
            motion_angles,
            types: BTreeMap::new(),
        }
    }

    /// Stores the place in the file of a key path and of the parts below it, with their name in the deck.
    pub(crate) fn place(&mut self, at: &str, span: &Range<usize>, words: &str, parts: &[Part<'_>]) {
        self.places.put(at, span, words);
        for (key, span, column) in parts {
            self.places
                .put(format!("{at}.{key}"), span, format!("{words}, {column}"));
        }
    }

    /// Adds a line type under a name that a scene accepts.
    pub(crate) fn add_line_type(&mut self, given: &Placed<String>, line_type: LineType, parts: &[Part<'_>]) {
        let name = type_name(&given.value, self.scene.line_types.keys().collect());
        if given.value != name {
            let text = format!("the line type {:?} is called {name} here", given.value);
            self.findings.remark(given, text);
        }
        let at = format!("line_types.{}", quoted(&name));
        self.place(&at, &given.span, &format!("line type {}", given.value), parts);
        self.types.insert(given.value.clone(), name.clone());
        self.scene.line_types.insert(name, line_type);
    }

    /// Adds a point; `words` are its name in the deck.
    pub(crate) fn add_point(&mut self, point: Point, span: &Range<usize>, words: &str, parts: &[Part<'_>]) {
        let at = format!("points[{}]", self.scene.points.len());
        self.place(&at, span, words, parts);
        self.scene.points.push(point);
    }

    /// Returns a line of one section between two points, with the number of its elements if the deck specifies it.
    pub(crate) fn line(
        &self,
        name: String,
        ends: [String; 2],
        line_type: &str,
        length: f64,
        elements: Option<usize>,
    ) -> Line {
        let [from, to] = ends;
        let section = Section {
            line_type: self.types[line_type].clone(),
            length,
            elements,
            damping_elements: None,
        };
        Line::between(name, from, to, vec![section])
    }

    /// Adds a line; `words` are its name in the deck.
    pub(crate) fn add_line(&mut self, line: Line, span: &Range<usize>, words: &str, parts: &[Part<'_>]) {
        let at = format!("lines[{}]", self.scene.lines.len());
        self.place(&at, span, words, parts);
        self.scene.lines.push(line);
    }

    /// Returns the depth of the seabed [m]: that of the deck, otherwise that of the supplement, otherwise that of the deepest fixed point, with a remark
    /// unless there are soundings. With soundings alone, it is 0.
    pub(crate) fn depth(&mut self, given: Option<f64>, is_sounded: bool) -> Option<f64> {
        if let Some(depth) = given {
            if let Some(other) = self.supplement.depth.filter(|other| *other != depth) {
                let text = format!("the depth of {depth} m in the file counts, not {other} m");
                self.findings.remark_on_all(text);
            }
            return Some(depth);
        }
        if self.supplement.depth.is_some() {
            return self.supplement.depth;
        }
        let deepest = self.deepest_anchor().map(|anchor| -anchor.position[2]);
        let deepest = deepest.filter(|depth| *depth > 0.0);
        if is_sounded {
            return deepest.or(Some(0.0));
        }
        self.findings.remark_on_all(match deepest {
            Some(depth) => format!(
                "no water depth in the file, for the host gives it: taken from the deepest fixed point, {depth} m"
            ),
            None => "no water depth in the file, and no fixed point below the water: no seabed".to_string(),
        });
        deepest
    }

    /// Returns the deepest fixed point; the first of several at the same depth.
    pub(crate) fn deepest_anchor(&self) -> Option<&Point> {
        let points = self.scene.points.iter();
        let anchors = points.filter(|point| point.kind == PointKind::Fixed);
        anchors.min_by(|a, b| a.position[2].total_cmp(&b.position[2]))
    }

    /// Returns the name of the vessel of a deck, which the deck does not specify.
    pub(crate) fn vessel_of_the_deck(&self) -> &'s str {
        self.supplement.vessel.as_deref().unwrap_or("vessel")
    }

    /// Returns whether the scene has a vessel of this name.
    pub(crate) fn has_vessel(&self, name: &str) -> bool {
        self.scene.vessels.iter().any(|vessel| vessel.name == name)
    }

    /// Puts a point on a vessel; a missing vessel is created at a position [m] and attitude [rad].
    pub(crate) fn aboard(
        &mut self,
        point: Point,
        vessel: &str,
        position: [f64; 3],
        attitude: [f64; 3],
    ) -> Point {
        if !self.has_vessel(vessel) {
            let given = self.supplement.positions.get(vessel).copied();
            self.scene.vessels.push(Vessel {
                name: vessel.to_string(),
                position: given.unwrap_or(position),
                attitude,
                motion_angles: self.motion_angles,
            });
        }
        Point {
            kind: PointKind::Coupled,
            on: Some(vessel.to_string()),
            ..point
        }
    }

    /// Checks that the vessel of all coupled points has a valid name, not one of `others` in the file, and no position in the supplement.
    pub(crate) fn check_given(&mut self, mut others: impl Iterator<Item = String>) {
        let Some(name) = &self.supplement.vessel else {
            return;
        };
        if let Some(problem) = name_problem(name) {
            self.findings
                .of_supplement
                .push(format!("the vessel given for all coupled points: {problem}"));
        }
        if others.any(|other| other == *name) {
            self.findings.of_supplement.push(taken(name));
        }
        if self.supplement.positions.contains_key(name) {
            let problem = format!(
                "`{name}` takes the coupled points where they are, with its origin at (0, 0, 0): give no position for it"
            );
            self.findings.of_supplement.push(problem);
        }
    }

    /// Checks that the scene has every vessel of the supplement, and that no point or line has the same name as the vessel of all coupled points.
    pub(crate) fn check_vessels(&mut self) {
        let vessels = self.scene.vessels.iter();
        let known: Vec<&str> = vessels.map(|vessel| vessel.name.as_str()).collect();
        let in_words = match known.is_empty() {
            true => "no vessel".to_string(),
            false => format!("the vessels {}", known.join(", ")),
        };
        if let Some(name) = &self.supplement.vessel {
            let points = self.scene.points.iter().map(|point| &point.name);
            let mut names = points.chain(self.scene.lines.iter().map(|line| &line.name));
            if names.any(|other| other == name) {
                self.findings.of_supplement.push(taken(name));
            } else if !known.contains(&name.as_str()) {
                let problem = format!(
                    "the vessel `{name}` is given for all coupled points, but the file has none: leave it out"
                );
                self.findings.of_supplement.push(problem);
            }
        }
        let placed = self.supplement.positions.keys();
        for name in placed.filter(|name| !known.contains(&name.as_str())) {
            let problem = format!("a position is given for `{name}`, but the file has {in_words}");
            self.findings.of_supplement.push(problem);
        }
    }
}

fn taken(name: &str) -> String {
    format!(
        "the vessel of all coupled points cannot be `{name}`, which the file has already: give it another name"
    )
}

/// Converts the name of a line type to a valid name in a scene, from which variables of the FMU are named.
fn type_name(given: &str, taken: BTreeSet<&String>) -> String {
    let letter = |c: char| match c {
        c if c.is_ascii_alphanumeric() || c == '-' => c,
        _ => '_',
    };
    let mut name: String = given.chars().map(letter).take(48).collect();
    let reserved = ["time", "solver"].contains(&name.as_str());
    if reserved || !name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        name = format!("type{name}");
    }
    let numbered = (2..).map(|number| format!("{name}_{number}"));
    let mut names = [name.clone()].into_iter().chain(numbered);
    names.find(|name| !taken.contains(name)).unwrap_or(name)
}

/// Returns a value of a deck in which zero means absence.
pub(crate) fn nonzero(value: f64) -> Option<f64> {
    (value != 0.0).then_some(value)
}

/// Returns a constant force [N] on a point; `None` if it is zero.
pub(crate) fn constant_force(force: [f64; 3]) -> Option<PointForce> {
    let [x, y, z] = force.map(|part| nonzero(part).map(TimeFunction::Constant));
    (force != [0.0; 3]).then_some(PointForce { x, y, z })
}

/// Parts of a point: its coordinates [m].
pub(crate) fn coordinates<T>(position: &[Placed<T>; 3]) -> [Part<'_>; 3] {
    let [x, y, z] = position;
    [
        ("position[0]", &x.span, "X"),
        ("position[1]", &y.span, "Y"),
        ("position[2]", &z.span, "Z"),
    ]
}
