//! The bed under the nodes of a line in the assembled system.

use nalgebra::Vector3;

use super::{LineWork, Weights};
use crate::model::{Line, LineState};
use crate::physics::seabed::ContactCoefficients;

/// Half the range of penetrations over which the seabed damper fades in, in static penetrations of the node [-].
const DAMPER_FADE: f64 = 2.0;

/// Half the range of penetrations over which the damper of a resting node fades in [m].
pub(crate) fn damper_reach(stiffness: f64, weight: f64) -> f64 {
    if stiffness > 0.0 {
        DAMPER_FADE * weight.abs() / stiffness
    } else {
        0.0
    }
}

/// The contact of `physics::seabed` with a damper that fades in over ± `reach` of penetration instead of switching on at
/// touch: f = max(0, k max(p, 0) − c s(p) ż), s the cubic step. A switching damper breaks Newton; where nothing moves the
/// force is the same.
pub(super) struct SmoothContact {
    /// Upward force [N].
    pub force: f64,
    /// Its slope with penetration [N/m].
    pub stiffness: f64,
    /// Minus its slope with ż [N s/m].
    pub damping: f64,
}

impl SmoothContact {
    /// `None` where the bed does not act.
    #[inline(always)]
    pub(super) fn new(
        k: ContactCoefficients,
        penetration: f64,
        velocity: f64,
        reach: f64,
    ) -> Option<SmoothContact> {
        if penetration <= -reach {
            return None;
        }
        let u = if reach > 0.0 {
            (0.5 * (penetration / reach + 1.0)).min(1.0)
        } else {
            1.0
        };
        let (fade, slope) = (
            u * u * (3.0 - 2.0 * u),
            6.0 * u * (1.0 - u) / (2.0 * reach.max(f64::MIN_POSITIVE)),
        );
        let spring = if penetration > 0.0 { k.stiffness } else { 0.0 };
        let force = spring * penetration - k.damping * fade * velocity;
        (force > 0.0).then_some(SmoothContact {
            force,
            stiffness: spring - k.damping * slope * velocity,
            damping: k.damping * fade,
        })
    }
}

/// Upward force [N] of a level bed whose damper fades in over ± `reach` of penetration [m].
pub(crate) fn faded_push(
    k: ContactCoefficients,
    penetration: f64,
    velocity: f64,
    reach: f64,
) -> f64 {
    SmoothContact::new(k, penetration, velocity, reach).map_or(0.0, |bed| bed.force)
}

impl LineWork {
    /// The bed's springs under nodes at rest.
    pub(super) fn add_bed_at_rest(&mut self, line: &Line, position: &[Vector3<f64>]) {
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

    /// Dampers fade over what a node moves in a step of `dt` [s], at least over the range of a resting node.
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
            let Some(bed) = SmoothContact::new(k, penetration, velocity, self.reach[i]) else {
                continue;
            };
            self.residual[i].z -= weights.force * bed.force;
            if TANGENT {
                self.diagonal[i][(2, 2)] +=
                    weights.position * bed.stiffness + weights.velocity * bed.damping;
            }
        }
    }
}
