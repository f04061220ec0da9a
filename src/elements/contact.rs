//! The seabed under the nodes of a line in the assembled system.

use nalgebra::Vector3;

use super::{LineWork, Weights};
use crate::model::{Line, LineState};
use crate::physics::fading_damper::{FadingContact, damper_reach};
use crate::physics::seabed::ContactCoefficients;

impl LineWork {
    /// Adds the seabed's springs under nodes at rest.
    pub(super) fn add_seabed_at_rest(&mut self, line: &Line, position: &[Vector3<f64>]) {
        let Some(contact) = &line.nodes.contact else {
            return;
        };
        for (i, r) in position.iter().enumerate() {
            let penetration = contact.level[i] - r.z;
            if penetration > 0.0 {
                self.residual[i].z -= contact.stiffness[i] * penetration;
                self.diagonal[i][(2, 2)] += contact.stiffness[i];
            }
        }
    }

    /// Fades the dampers over the displacement of a node in a step of `dt` [s], at least over the range of a resting
    /// node.
    pub(super) fn fade_dampers(&mut self, line: &Line, state: &LineState, dt: f64) {
        let Some(contact) = &line.nodes.contact else {
            return;
        };
        for (i, reach) in self.reach.iter_mut().enumerate() {
            let resting = damper_reach(contact.stiffness[i], line.nodes.weight[i]);
            let rise = match &contact.bottom {
                None => state.velocity[i].z,
                Some(bottom) => bottom.rise(state.position[i], state.velocity[i]),
            };
            *reach = resting.max(rise.abs() * dt);
        }
    }

    pub(super) fn add_contact<const TANGENT: bool>(
        &mut self,
        line: &Line,
        state: &LineState,
        weights: &Weights,
    ) {
        if line.bottom().is_some() {
            return self.add_bottom::<TANGENT>(line, state, weights);
        }
        let Some(contact) = &line.nodes.contact else {
            return;
        };
        for i in 0..contact.stiffness.len() {
            let k = ContactCoefficients {
                stiffness: contact.stiffness[i],
                damping: contact.damping[i],
            };
            let penetration = contact.level[i] - state.position[i].z;
            let velocity = state.velocity[i].z;
            let Some(bed) = FadingContact::new(k, penetration, velocity, self.reach[i]) else {
                continue;
            };
            self.residual[i].z -= weights.force * bed.force;
            if TANGENT {
                self.diagonal[i][(2, 2)] += weights.position * bed.stiffness + weights.velocity * bed.damping;
            }
        }
    }
}
