//! Lines whose end B is on a winch: their elements at any length paid out.
//!
//! The longest line is the line at its maximum length, with segments of nominal lengths l_i. With n segments paid out, the last one has the length
//!
//!   e = S + ΔL − Σ_{i<n−1} l_i,
//!
//! where S is the length of the line at zero length change ΔL; all other segments have their nominal lengths. If the last segment grows
//! beyond [`LONGEST`]·l, it splits in two, of which the first has its nominal length; if it shrinks below [`SHORTEST`]·l, it
//! merges with its neighbour. The range exceeds l, so that an oscillating winch does not split and merge segments all
//! the time.
//!
//! The masses and coefficients of the nodes are linear in the adjacent lengths. Contact keeps the penetration of a
//! segment of nominal length.

use super::{Contact, Line, Nodes};
use crate::scene::TimeFunction;

/// Length of the end segment above which it splits, relative to its nominal length [-].
pub const LONGEST: f64 = 1.5;
/// Length of the end segment below which it merges with its neighbour, relative to its nominal length [-].
pub const SHORTEST: f64 = 0.4;
/// Minimum length of an end segment without a neighbour to merge with, relative to its nominal length [-].
const LAST: f64 = 0.1;
/// Minimum number of segments of a line.
const SEGMENTS_MIN: usize = 2;

/// The winch at end B of a line.
#[derive(Debug, Clone)]
pub struct Winch {
    /// The line at its maximum length.
    longest: Box<Line>,
    /// Unstretched length at zero length change [m].
    length: f64,
    /// Number of segments at zero length change.
    nominal: usize,
    /// Number of segments that cannot be hauled in.
    least: usize,
    /// Maximum length that is paid out [m].
    pub length_max: f64,
    /// Maximum speed [m/s].
    pub speed_max: Option<f64>,
    /// Length paid out in time [m] if the scene's motion is followed.
    pub path: Option<TimeFunction>,
}

/// Change of the end segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    /// The end segment splits in two.
    Split,
    /// The end segment merges with its neighbour.
    Merge,
}

impl Winch {
    /// Winch on the line `longest`, at its maximum length, of which `nominal` segments are paid out at zero length change;
    /// the last section begins at segment `first`.
    pub(super) fn new(longest: Line, [first, nominal]: [usize; 2], winch: &crate::scene::Winch) -> Winch {
        Winch {
            length: longest.nodes.arc[nominal],
            longest: Box::new(longest),
            nominal,
            least: SEGMENTS_MIN.max(first + 1),
            length_max: winch.length_max,
            speed_max: winch.speed_max,
            path: winch.path.clone(),
        }
    }

    /// The line at its maximum length.
    pub fn longest(&self) -> &Line {
        &self.longest
    }

    /// The line at its maximum length, for modification.
    pub(super) fn longest_mut(&mut self) -> &mut Line {
        &mut self.longest
    }

    /// Length change [m] at which nothing more can be hauled in.
    pub fn length_min(&self) -> f64 {
        let end = self.longest.segments.length[self.least - 1];
        self.longest.nodes.arc[self.least - 1] + SHORTEST * end - self.length
    }

    /// Checks that a length change [m] can be paid out; returns the reason why it cannot.
    pub fn check(&self, change: f64) -> Result<(), String> {
        let (least, most) = (self.length_min(), self.length_max);
        // a sum in the host may exceed the bounds by rounding
        let rounding = 1e-9 * (most - least);
        if change >= least - rounding && change <= most + rounding {
            return Ok(());
        }
        Err(format!(
            "the winch cannot change the length by {change} m, only by a value between {least} m, where finer elements would be needed to haul in more, \
             and length_max, {most} m"
        ))
    }

    /// Length [m] of the last of `count` segments at a length change [m].
    pub fn end_length(&self, count: usize, change: f64) -> f64 {
        let left = self.length + change - self.longest.nodes.arc[count - 1];
        left.max(LAST * self.longest.segments.length[count - 1])
    }

    /// Split or merge that is due for the last of `count` segments at a length change [m].
    pub fn passage(&self, count: usize, change: f64) -> Option<Passage> {
        let part = self.end_length(count, change) / self.longest.segments.length[count - 1];
        if part > LONGEST && count < self.longest.segment_count() {
            Some(Passage::Split)
        } else if part < SHORTEST && count > self.least {
            Some(Passage::Merge)
        } else {
            None
        }
    }

    /// Number of segments of a line at a length change [m].
    pub fn segments_at(&self, change: f64) -> usize {
        let mut count = self.nominal;
        while let Some(passage) = self.passage(count, change) {
            match passage {
                Passage::Split => count += 1,
                Passage::Merge => count -= 1,
            }
        }
        count
    }
}

impl Line {
    /// Maximum number of nodes of the line.
    pub fn nodes_max(&self) -> usize {
        let winch = self.winch.as_ref();
        winch.map_or(self.nodes.arc.len(), |winch| winch.longest.nodes.arc.len())
    }

    /// Lays out a line on a winch with `count` segments at a length change [m].
    pub fn pay_out(&mut self, count: usize, change: f64) {
        let Some(winch) = self.winch.take() else {
            return;
        };
        let longest = winch.longest();
        let keep = |values: &mut Vec<f64>, of: &[f64], count: usize| {
            values.clear();
            values.extend_from_slice(&of[..count]);
        };
        let (segments, full) = (&mut self.segments, &longest.segments);
        keep(&mut segments.length, &full.length, count);
        keep(&mut segments.axial_stiffness, &full.axial_stiffness, count);
        keep(&mut segments.axial_damping, &full.axial_damping, count);
        segments.law.clone_from(&full.law);
        segments.law.truncate(count);
        keep(&mut self.nodes.arc, &longest.nodes.arc, count + 1);
        for (values, of) in extensive(&mut self.nodes, &longest.nodes) {
            keep(values, of, count + 1);
        }
        if let (Some(contact), Some(full)) = (&mut self.nodes.contact, &longest.nodes.contact) {
            keep(&mut contact.level, &full.level, count + 1);
            contact.level[count] = full.level[longest.segment_count()];
            for (values, of) in of_segments(contact, full) {
                keep(values, of, count);
            }
            keep(&mut contact.stick, &full.stick, full.stick.len().min(count + 1));
        }
        self.winch = Some(winch);
        self.set_length_change(change);
    }

    /// Sets the length of the last segment from the length change of a winch [m].
    pub fn set_length_change(&mut self, change: f64) {
        let Some(winch) = self.winch.take() else {
            return;
        };
        let (count, longest) = (self.segment_count(), winch.longest());
        let end = winch.end_length(count, change);
        let (last, nominal) = (longest.segment_count(), longest.segments.length[count - 1]);
        self.segments.length[count - 1] = end;
        self.nodes.arc[count] = self.nodes.arc[count - 1] + end;
        for (values, of) in extensive(&mut self.nodes, &longest.nodes) {
            let density = of[last] / longest.nodes.length[last]; // the end node of the longest line has half a segment of the section at the winch
            values[count - 1] = of[count - 1] + 0.5 * (end - nominal) * density;
            values[count] = 0.5 * end * density;
        }
        if let (Some(contact), Some(full)) = (&mut self.nodes.contact, &longest.nodes.contact) {
            for (values, of) in of_segments(contact, full) {
                values[count - 1] = end / nominal * of[count - 1];
            }
        }
        let before: f64 = self.sections.iter().rev().skip(1).map(|s| s.length).sum();
        if let Some(section) = self.sections.last_mut() {
            section.length = self.nodes.arc[count] - before;
        }
        self.winch = Some(winch);
    }
}

/// Quantities proportional to the tributary length of a node, with those of the longest line.
fn extensive<'a>(
    nodes: &'a mut Nodes,
    longest: &'a Nodes,
) -> impl Iterator<Item = (&'a mut Vec<f64>, &'a Vec<f64>)> {
    let (drag, froude_krylov) = (&mut nodes.drag, &mut nodes.froude_krylov);
    let drag = drag.as_mut().zip(longest.drag.as_ref());
    let froude_krylov = froude_krylov.as_mut().zip(longest.froude_krylov.as_ref());
    let always = [
        (&mut nodes.length, &longest.length),
        (&mut nodes.mass, &longest.mass),
        (&mut nodes.mass_normal, &longest.mass_normal),
        (&mut nodes.mass_tangent, &longest.mass_tangent),
        (&mut nodes.weight, &longest.weight),
    ];
    let drag = drag.map(|(a, b)| [(&mut a.normal, &b.normal), (&mut a.tangent, &b.tangent)]);
    let froude_krylov =
        froude_krylov.map(|(a, b)| [(&mut a.normal, &b.normal), (&mut a.tangent, &b.tangent)]);
    let damping = nodes.mass_damping.as_mut().zip(longest.mass_damping.as_ref());
    let pairs = drag.into_iter().chain(froude_krylov).flatten();
    always.into_iter().chain(pairs).chain(damping)
}

/// Quantities of the contact with the seabed in proportion to the length of a segment, with those of the longest line.
fn of_segments<'a>(contact: &'a mut Contact, longest: &'a Contact) -> [(&'a mut Vec<f64>, &'a Vec<f64>); 4] {
    [
        (&mut contact.stiffness, &longest.stiffness),
        (&mut contact.damping, &longest.damping),
        (&mut contact.weight, &longest.weight),
        (&mut contact.mass, &longest.mass),
    ]
}
