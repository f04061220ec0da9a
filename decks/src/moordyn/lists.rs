//! Lists of a deck in its own order, for hosts that number objects and degrees of freedom as MoorDyn does.

use super::deck::{Attachment, Deck};
use super::sections::{self, Kind};
use super::tables;
use crate::findings::{Findings, Placed};

/// Origin of the motion of a body or rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carrier {
    /// Fixed in space.
    Fixed,
    /// Moved by the host.
    Host,
    /// Moved by the forces on it.
    Free,
    /// Carried by the body with this number.
    Body(usize),
}

/// A rod of a deck.
#[derive(Debug, Clone, PartialEq)]
pub struct RodRow {
    /// Number in the deck.
    pub number: usize,
    /// Origin of its motion.
    pub carrier: Carrier,
    /// Ends A and B [m].
    pub ends: [[f64; 3]; 2],
    /// Number of segments [-]; 0 for a rod of zero length.
    pub segments: usize,
}

/// A line of a deck.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineRow {
    /// Number in the deck.
    pub number: usize,
    /// Number of segments [-].
    pub segments: usize,
    /// Letters that request an output file for this line.
    pub outputs: String,
}

/// A body of a deck.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyRow {
    /// Number in the deck.
    pub number: usize,
    /// Origin of its motion.
    pub carrier: Carrier,
    /// Reference position [m].
    pub position: [f64; 3],
    /// Reference roll, pitch and yaw in the order R_x R_y R_z [rad].
    pub angles: [f64; 3],
}

/// Lists of a deck.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Lists {
    /// Bodies.
    pub bodies: Vec<BodyRow>,
    /// Rods.
    pub rods: Vec<RodRow>,
    /// Numbers of the points.
    pub points: Vec<usize>,
    /// Lines.
    pub lines: Vec<LineRow>,
    /// Rows of OPTIONS: key in capitals, and value. The last row with a key counts.
    pub options: Vec<(String, String)>,
    /// True if a point, rod or body is carried by a turbine of a farm.
    pub is_of_farm: bool,
}

impl Lists {
    /// Returns the value of an option; `keys` are its spellings in capitals.
    pub fn option(&self, keys: &[&str]) -> Option<&str> {
        let mut options = self.options.iter().rev();
        let found = options.find(|(key, _)| keys.contains(&key.as_str()));
        found.map(|(_, value)| value.as_str())
    }
}

/// Returns the lists of a deck. Those of a deck with mistakes, which [`load`](crate::load) reports, are incomplete.
pub fn lists(text: &str) -> Lists {
    let mut findings = Findings::default();
    let sections = sections::split(text, &mut findings);
    let deck = tables::read(&sections, &mut findings);
    let rows = sections.rows(Kind::Options).iter();
    let options = rows.filter_map(|row| {
        let fields = row.fields();
        let [value, key, ..] = fields.as_slice() else {
            return None;
        };
        Some((key.text.to_uppercase(), value.text.to_string()))
    });
    Lists {
        bodies: bodies(&deck),
        rods: rods(&deck),
        points: deck.points.iter().map(|point| point.id.value).collect(),
        lines: lines(&deck),
        options: options.collect(),
        is_of_farm: deck.turbines().next().is_some(),
    }
}

fn carrier(attachment: Attachment) -> Carrier {
    match attachment {
        Attachment::Fixed | Attachment::Pinned(None) => Carrier::Fixed,
        Attachment::Free => Carrier::Free,
        Attachment::Body(body) | Attachment::Pinned(Some(body)) => Carrier::Body(body),
        Attachment::Coupled | Attachment::Vessel | Attachment::Turbine(_) | Attachment::CoupledPinned => {
            Carrier::Host
        }
    }
}

fn values(place: &[Placed<f64>; 3]) -> [f64; 3] {
    place.each_ref().map(|coordinate| coordinate.value)
}

fn bodies(deck: &Deck) -> Vec<BodyRow> {
    let row = |body: &super::deck::Body| BodyRow {
        number: body.id.value,
        carrier: carrier(body.attachment.value),
        position: values(&body.position),
        angles: values(&body.attitude).map(f64::to_radians),
    };
    deck.bodies.iter().map(row).collect()
}

fn rods(deck: &Deck) -> Vec<RodRow> {
    let row = |rod: &super::deck::Rod| RodRow {
        number: rod.id.value,
        carrier: carrier(rod.attachment.value),
        ends: rod.ends.each_ref().map(values),
        segments: rod.segments.value,
    };
    deck.rods.iter().map(row).collect()
}

fn lines(deck: &Deck) -> Vec<LineRow> {
    let row = |line: &super::deck::Line| LineRow {
        number: line.id.value,
        segments: line.segments.value,
        outputs: line.outputs.value.clone(),
    };
    deck.lines.iter().map(row).collect()
}
