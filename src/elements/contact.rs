//! Seabed under the segments of a line in the assembled system.
//!
//! The force on a node is the sum over the parts of the two adjacent segments ([`crate::physics::seabed`]); it depends on the penetrations of the
//! node and of its neighbours.

use nalgebra::Vector3;

use super::LineWork;
use crate::model::{Contact, Line, LineState};
use crate::physics::fading_damper::{FadingContact, damper_reach};
use crate::physics::seabed::{ContactCoefficients, Part};

/// Seabed under the segments adjacent to a node.
#[derive(Debug, Clone, Copy, Default)]
pub struct Bearing {
    /// Force on the node, and its slopes with respect to the penetration and the velocity of the node.
    pub seabed: FadingContact,
    /// Slope of the force with respect to the penetration of the next node [N/m].
    pub stiffness_after: f64,
    /// Negative slope of the force with respect to the velocity ż of the next node [N s/m].
    pub damping_after: f64,
}

/// Position of a node relative to the seabed.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Stand {
    /// Penetration [m], and velocity ż along the normal [m/s].
    depth: [f64; 2],
    /// Normal of the seabed [-].
    pub normal: Vector3<f64>,
}

impl Stand {
    /// Position of a node of a line in a state, at rest unless it `moves`.
    pub(super) fn new(contact: &Contact, state: &LineState, node: usize, moves: bool) -> Stand {
        let (penetration, normal) = contact.stand(node, state.position[node]);
        let rise = if moves {
            normal.dot(&state.velocity[node])
        } else {
            0.0
        };
        Stand {
            depth: [penetration, rise],
            normal,
        }
    }
}

impl Bearing {
    /// Sum over the parts of the segments adjacent to a node, from the positions of nodes; the damper of a segment fades in over ± `reach` [m].
    /// `None` where the seabed does not act.
    pub(super) fn new(
        contact: &Contact,
        node: usize,
        stand: impl Fn(usize) -> Stand,
        reach: impl Fn(usize) -> f64,
    ) -> Option<Bearing> {
        let mut sum = Bearing::default();
        for (segment, _) in contact.adjacent(node) {
            let ends = [stand(segment), stand(segment + 1)];
            let (k, parts) = (contact.coefficients(segment), contact.parts());
            if let Some(both) = Bearing::of_segment(k, parts, ends, reach(segment)) {
                sum.add(&both[node - segment]);
            }
        }
        (sum.seabed.force > 0.0).then_some(sum)
    }

    /// Bearing of both nodes of a segment whose damper fades in over ± `reach` [m]; `None` where the seabed does not act.
    #[inline(always)]
    fn of_segment(
        k: ContactCoefficients,
        parts: &[Part; 4],
        [low, high]: [Stand; 2],
        reach: f64,
    ) -> Option<[Bearing; 2]> {
        let ([low, low_rise], [high, high_rise]) = (low.depth, high.depth);
        if low.max(high) <= -reach {
            return None;
        }
        let mut ends = [Bearing::default(); 2];
        for part in parts {
            let [penetration, rise] = [part.between(low, high), part.between(low_rise, high_rise)];
            let Some(seabed) = FadingContact::new(k, penetration, rise, reach) else {
                continue;
            };
            let products = part.products();
            for (side, end) in ends.iter_mut().enumerate() {
                end.seabed.force += part.shares[side] * seabed.force;
                end.seabed.stiffness += products[side][side] * seabed.stiffness;
                end.seabed.damping += products[side][side] * seabed.damping;
            }
            ends[0].stiffness_after += products[0][1] * seabed.stiffness;
            ends[0].damping_after += products[0][1] * seabed.damping;
        }
        Some(ends)
    }

    #[inline(always)]
    fn add(&mut self, other: &Bearing) {
        self.seabed.force += other.seabed.force;
        self.seabed.stiffness += other.seabed.stiffness;
        self.seabed.damping += other.seabed.damping;
        self.stiffness_after += other.stiffness_after;
        self.damping_after += other.damping_after;
    }
}

impl LineWork {
    /// Finds the position of every node relative to the seabed and the bearing of its adjacent segments; at rest, velocities and fading ranges are
    /// zero.
    pub(super) fn find_bearings(&mut self, contact: &Contact, state: &LineState, moves: bool) {
        self.bearing.fill(Bearing::default());
        for (node, stand) in self.stand.iter_mut().enumerate() {
            *stand = Stand::new(contact, state, node, moves);
        }
        for i in 0..self.reach.len() {
            let reach = if moves { self.reach[i] } else { 0.0 };
            let ends = [self.stand[i], self.stand[i + 1]];
            let (k, parts) = (contact.coefficients(i), contact.parts());
            if let Some([low, high]) = Bearing::of_segment(k, parts, ends, reach) {
                self.bearing[i].add(&low);
                self.bearing[i + 1].add(&high);
            }
        }
    }

    /// Sets the range over which each damper fades to the displacement of its segment in a step of `dt` [s], but at least to the range of a resting
    /// segment.
    pub(super) fn fade_dampers(&mut self, line: &Line, state: &LineState, dt: f64) {
        let Some(contact) = &line.nodes.contact else {
            return;
        };
        let rise = |node: usize| {
            let (_, normal) = contact.stand(node, state.position[node]);
            normal.dot(&state.velocity[node]).abs()
        };
        let mut low = rise(0);
        for (i, reach) in self.reach.iter_mut().enumerate() {
            let resting = damper_reach(contact.stiffness[i], contact.weight[i]);
            let high = rise(i + 1);
            *reach = resting.max(low.max(high) * dt);
            low = high;
        }
    }
}
