//! Depth at which a line rests in a seabed whose contact is softened to suit the mesh.
//!
//! A line of weight w under the horizontal tension H, on springs that deflect by δ under its weight, leaves the seabed
//! smoothly over the length λ = √(Hδ/w). With u measured from the point where the springs lose contact, at
//! z = δ above the line at rest, the free part is
//!
//!   z = δ + (δ/λ)u + (w/2H)u² = (w/2H)(u + λ)² + δ/2:
//!
//! the catenary over a rigid seabed δ/2 above the line at rest. A line therefore rests δ/2 below the seabed, and its
//! suspended part is then accurate to the next order in the mesh; for a line at rest on the seabed surface, the suspended
//! part is δ/2 too high, an error of 0.2 % in tension with 40 elements.
//! Towards an end that is fixed on the seabed the line rises to the seabed over a length R of a few elements, so that the
//! end is not pulled down: the line follows a smooth step as long as R > √3 λ, and λ is at most one element of the meshes
//! in use. R is three elements: with five, the step reaches the touchdown of a line with a short part on the seabed, and
//! the tension error is 1.4 times as great on a slowly moved oc3_catenary (n = 14 to 40); with two, it is hardly
//! smaller. A line with bending stiffness follows the step only if the step is longer than the length ℓ = (4EI/k)^¼ over
//! which a beam on springs of stiffness k per length settles; its curvature is then that of the step. R grows up to five
//! elements as ℓ approaches an element.
//!
//! Over a ridge of soundings a line under the tension T presses on the seabed with w + Tκ per length, and on the flanks with less than w. On springs sized
//! for w it would sink in at the crest and lie high on the flanks, and be shorter than the ridge by far more than its stretch.
//! [`Line::adapt_contact`] sizes the springs for the load at rest, if it exceeds the weight, and lowers the level where it is less than the weight, so that
//! laid nodes are δ/2 below the seabed everywhere. κ is taken over an element to either side, and T in the first equilibrium.
//!
//! Source: beam without bending stiffness on Winkler's foundation, here solved for the level.

use nalgebra::Vector3;

use crate::model::{Contact, Line, Nodes, Point, Regularised, Role};
use crate::physics::seabed::{REGULARISED_PENETRATION, regularised};

/// Depth at which the line rests, relative to the static compression of the contact [-].
const SUNK: f64 = 0.5;
/// Number of elements over which the line rises to an end on the seabed [-].
const RISE: f64 = 3.0;
/// Length of the rise relative to ℓ for a line with bending stiffness, where ℓ counts up to an element [-].
const RISE_BENT: f64 = 5.0;
/// Least change of the load of a segment to which the contact is adapted, relative to the weight [-].
const CHANGE_MIN: f64 = 1e-3;

/// Sizes regularised springs and dampers for the loads of the segments, of the given lengths [m], but at least for their weights, and sets the level so
/// that a line with these loads lies on the seabed.
pub(super) fn size(contact: &mut Contact, length: &[f64]) {
    let mut sinks = vec![0.0; length.len()]; // compression of softened contact under the load [m]
    if let Some(Regularised { given, load }) = &contact.regularised {
        for (i, given) in given.iter().enumerate() {
            let load = load[i].max(contact.weight[i]);
            let soft = regularised(*given, [load, contact.mass[i]], length[i]);
            if soft.stiffness < given.stiffness {
                sinks[i] = load / soft.stiffness;
            }
            (contact.stiffness[i], contact.damping[i]) = (soft.stiffness, soft.damping);
        }
    }
    for (i, level) in contact.level.iter_mut().enumerate() {
        *level = mean_at_node(&sinks, i) + contact.seabed_level;
    }
}

/// Mean at a node of the values of the adjacent segments.
fn mean_at_node(of_segments: &[f64], node: usize) -> f64 {
    let adjacent = &of_segments[node.saturating_sub(1)..(node + 1).min(of_segments.len())];
    adjacent.iter().sum::<f64>() / adjacent.len() as f64
}

impl Line {
    /// Adapts regularised contact to soundings, which press on the segments with a load other than their weight: w + Tκ per length. `place` are the nodes
    /// at rest [m], and `tension` the tensions of the segments [N]. Returns whether the load of any segment changed by more than a thousandth of its weight.
    pub fn adapt_contact(&mut self, points: &[Point], place: &[Vector3<f64>], tension: &[f64]) -> bool {
        let Some(contact) = self.nodes.contact.as_mut().filter(|_| self.winch.is_none()) else {
            return false; // the nodes of a line on a winch move along it
        };
        let length = &self.segments.length;
        let load = |i: usize| contact.load_at_rest(i, length[i], place, tension[i]);
        let loads: Vec<f64> = (0..length.len()).map(load).collect();
        let weight = contact.weight.clone();
        let Some(Regularised { load, .. }) = &mut contact.regularised else {
            return false;
        };
        let changes = load.iter().zip(&loads).zip(&weight);
        if !changes
            .clone()
            .any(|((before, now), weight)| (now - before).abs() > CHANGE_MIN * weight)
        {
            return false;
        }
        load.clone_from(&loads);
        size(contact, length);
        sink(self, points);
        if let Some(contact) = &mut self.nodes.contact {
            let spared = |i: usize| (weight[i] - loads[i]).max(0.0) / contact.stiffness[i];
            let spared: Vec<f64> = (0..loads.len()).map(spared).collect(); // less compression than under the weight [m]
            for (node, level) in contact.level.iter_mut().enumerate() {
                *level -= mean_at_node(&spared, node);
            }
        }
        true
    }
}

/// Lowers the level below which softened contact acts, from the level at which a line would rest on the seabed to the level
/// that makes its suspended part accurate.
pub(super) fn sink(line: &mut Line, points: &[Point]) {
    if let Some(winch) = &mut line.winch {
        sink(winch.longest_mut(), points);
    }
    let (length, stiffness) = (line.unstretched_length(), greatest_stiffness(line));
    let Nodes {
        arc,
        length: spacing,
        contact: Some(contact),
        ..
    } = &mut line.nodes
    else {
        return;
    };
    let springs: Vec<f64> = (0..arc.len()).map(|i| contact.stiffness_under(i)).collect();
    let lies = line.ends.map(|end| lies_on(contact, &points[end], spacing[0]));
    for (i, level) in contact.level.iter_mut().enumerate() {
        let compression = *level - contact.seabed_level; // δ
        let element = compression / REGULARISED_PENETRATION;
        let settles = (4.0 * stiffness * spacing[i] / springs[i]).powf(0.25); // ℓ
        let bent = RISE_BENT * settles.min(element);
        let rise = bent.max(RISE * element); // R
        let near = |distance: f64| {
            if rise > 0.0 {
                step(1.0 - distance / rise)
            } else {
                0.0
            }
        };
        let from_ends = [arc[i], length - arc[i]].into_iter().zip(lies);
        let near = from_ends
            .filter(|(_, lies)| *lies)
            .map(|(distance, _)| near(distance));
        *level -= SUNK * compression * (1.0 - near.fold(0.0, f64::max));
    }
}

/// Maximum bending stiffness EI of the segments of a line [N m²].
fn greatest_stiffness(line: &Line) -> f64 {
    let cable = line.bending.iter().flat_map(|bending| &bending.stiffness);
    let beam = line.beam.iter().flat_map(|beam| &beam.elements);
    let beam = beam.map(|element| element.law.bending);
    cable.copied().chain(beam).fold(0.0, f64::max)
}

/// Returns whether a point that is not free lies on the seabed, to the resolution of an element of `length` [m].
fn lies_on(contact: &Contact, point: &Point, length: f64) -> bool {
    let held = !matches!(point.role, Role::Free(_));
    let height = point.reference.z - contact.height_under(point.reference);
    held && height <= REGULARISED_PENETRATION * length
}

/// Smooth step from 0 to 1 [-].
fn step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
