//! The seabed under the segments of a line in the assembled system.
//!
//! The force on a node is the sum over the parts of the two segments beside it ([`crate::physics::seabed`]); it has slopes with the penetration of
//! the node and with those of its neighbours.

use super::LineWork;
use crate::model::{Contact, Line, LineState};
use crate::physics::fading_damper::{FadingContact, damper_reach};
use crate::physics::seabed::PARTS;

/// Seabed under the segments beside a node.
#[derive(Debug, Clone, Copy, Default)]
pub struct Bearing {
    /// Force on the node, and its slopes with the penetration and the velocity of the node.
    pub bed: FadingContact,
    /// Slope of the force with the penetration of the node after [N/m].
    pub stiffness_after: f64,
    /// Negative slope of the force with the velocity ż of the node after [N s/m].
    pub damping_after: f64,
}

impl Bearing {
    /// Sum over the parts of the segments beside a node, from the penetrations [m] and the velocities ż [m/s] of nodes; the damper of a segment
    /// fades in over ± `reach` [m]. `None` where the seabed does not act.
    pub fn new(
        contact: &Contact,
        node: usize,
        depth: impl Fn(usize) -> [f64; 2],
        reach: impl Fn(usize) -> f64,
    ) -> Option<Bearing> {
        let (mut sum, [near, rise]) = (Bearing::default(), depth(node));
        for (segment, other) in contact.beside(node) {
            let (k, [far, far_rise], reach) = (contact.coefficients(segment), depth(other), reach(segment));
            if near.max(far) <= -reach {
                continue;
            }
            for part in PARTS {
                let [penetration, rise] = [part.between(near, far), part.between(rise, far_rise)];
                let Some(bed) = FadingContact::new(k, penetration, rise, reach) else {
                    continue;
                };
                sum.bed.force += part.shares[0] * bed.force;
                let [[own, after], _] = part.products();
                sum.bed.stiffness += own * bed.stiffness;
                sum.bed.damping += own * bed.damping;
                if other > node {
                    sum.stiffness_after += after * bed.stiffness;
                    sum.damping_after += after * bed.damping;
                }
            }
        }
        (sum.bed.force > 0.0).then_some(sum)
    }
}

impl LineWork {
    /// Fades the dampers over the displacement of a segment in a step of `dt` [s], at least over the range of a resting
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
