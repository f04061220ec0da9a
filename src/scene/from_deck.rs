//! What the readers of decks share on the way to a scene: names, the bed, vessels.

use std::collections::BTreeSet;

use super::rows::{Findings, Placed};
use super::{AngleOrder, Places, Point, PointKind, Scene, Supplement, Vessel};

/// Density of sea water [kg/m³] of a deck that gives none.
pub(super) const SEA_WATER: f64 = 1025.0;

/// A name of a line type as a scene takes it: variables of the FMU are called after it.
pub(super) fn type_name(given: &str, taken: &BTreeSet<String>) -> String {
    let letter = |c: char| {
        if c.is_ascii_alphanumeric() || c == '_' || c == '-' {
            c
        } else {
            '_'
        }
    };
    let mut name: String = given.chars().map(letter).take(48).collect();
    let first = name.chars().next();
    let reserved = ["time", "solver"].contains(&name.as_str());
    if reserved || !first.is_some_and(|c| c.is_ascii_alphabetic() || c == '_') {
        name = format!("type{name}");
    }
    let mut unique = name.clone();
    let mut number = 2;
    while taken.contains(&unique) {
        unique = format!("{name}_{number}");
        number += 1;
    }
    unique
}

/// Remarks on a line type that has another name in the scene.
pub(super) fn remark_on_name(given: &Placed<String>, name: &str, findings: &mut Findings) {
    if given.value != name {
        let text = format!("the line type {:?} is called {name} here", given.value);
        findings.remark(given.span.start, text);
    }
}

/// Depth of the bed [m]: what the deck says, what is said for it, else that of the deepest fixed point, with a remark.
pub(super) fn depth(
    given: Option<f64>,
    supplement: &Supplement,
    points: &[Point],
    findings: &mut Findings,
) -> Option<f64> {
    if let Some(depth) = given {
        if let Some(other) = supplement.depth.filter(|other| *other != depth) {
            let text = format!("the depth of {depth} m in the file counts, not {other} m");
            findings.remark_on_all(text);
        }
        return Some(depth);
    }
    if supplement.depth.is_some() {
        return supplement.depth;
    }
    let fixed = points.iter().filter(|point| point.kind == PointKind::Fixed);
    let deepest = fixed
        .map(|point| -point.position[2])
        .fold(f64::NEG_INFINITY, f64::max);
    if deepest > 0.0 {
        let text = format!(
            "no water depth in the file, for the host gives it: taken from the deepest fixed point, {deepest} m"
        );
        findings.remark_on_all(text);
        return Some(deepest);
    }
    findings.remark_on_all("no water depth in the file, and no fixed point below the water: no seabed");
    None
}

/// Puts vessels into a scene, each once, where the supplement or else the deck has them.
pub(super) struct Vessels<'s> {
    pub supplement: &'s Supplement,
    /// Order of the angles of motions that such decks are given.
    pub motion_angles: AngleOrder,
}

impl Vessels<'_> {
    /// The vessel that takes all coupled points, where one is given.
    pub(super) fn of_all(&self) -> Option<&str> {
        self.supplement.vessel.as_deref()
    }

    /// The vessel that a deck means where it speaks of one without a name.
    pub(super) fn of_the_deck(&self) -> &str {
        self.of_all().unwrap_or("vessel")
    }

    /// The vessel of all coupled points has a name of its own and a place that is known.
    pub(super) fn check_given(&self, mut others: impl Iterator<Item = String>, findings: &mut Findings) {
        let Some(name) = self.of_all() else { return };
        if others.any(|other| other == name) {
            let problem = format!(
                "the vessel of all coupled points cannot be `{name}`, which the file has already: give it another name"
            );
            findings.mistake("", 0..0, problem);
        }
        if self.supplement.positions.contains_key(name) {
            let problem = format!(
                "`{name}` takes the coupled points where they are, with its origin at (0, 0, 0): give no position for it"
            );
            findings.mistake("", 0..0, problem);
        }
    }

    /// The vessel of a name, made where it is missing at a position [m] and attitude [rad].
    pub(super) fn board(
        &self,
        scene: &mut Scene,
        name: &str,
        position: [f64; 3],
        attitude: [f64; 3],
    ) -> String {
        if scene.vessels.iter().all(|vessel| vessel.name != name) {
            let position = self.supplement.positions.get(name).copied().unwrap_or(position);
            scene.vessels.push(Vessel {
                name: name.to_string(),
                position,
                attitude,
                motion_angles: self.motion_angles,
            });
        }
        name.to_string()
    }

    /// Positions of vessels that the deck does not have are slips, and so is a vessel that nothing rides on.
    pub(super) fn check(&self, scene: &Scene, findings: &mut Findings) {
        let has = |name: &str| scene.vessels.iter().any(|vessel| vessel.name == *name);
        if let Some(name) = self.of_all().filter(|name| !has(name)) {
            let problem = format!(
                "the vessel `{name}` is given for all coupled points, but the file has none: leave it out"
            );
            findings.mistake("", 0..0, problem);
        }
        for name in self.supplement.positions.keys() {
            if !has(name) {
                let known: Vec<&str> = scene.vessels.iter().map(|vessel| vessel.name.as_str()).collect();
                let problem = format!(
                    "a position is given for `{name}`, but the file has {}",
                    if known.is_empty() {
                        "no vessel".to_string()
                    } else {
                        format!("the vessels {}", known.join(", "))
                    }
                );
                findings.mistake("", 0..0, problem);
            }
        }
    }
}

/// Keeps the places of the coordinates of a point.
pub(super) fn place_position(places: &mut Places, at: &str, words: &str, position: &[Placed<f64>; 3]) {
    for (axis, (coordinate, letter)) in position.iter().zip(["X", "Y", "Z"]).enumerate() {
        let words = format!("{words}, {letter}");
        places.put(format!("{at}.position[{axis}]"), &coordinate.span, words);
    }
}
