//! Spring and damper of the seabed over a step of the leapfrogs.
//!
//! A step changes the velocity v⁻ of t_{n−½} to the v of t_{n+½}. A part of a segment ([`crate::physics::seabed`]) with the penetration p at t_n, which
//! leaves the bed at v_n, goes from p_a = p + (1−θ) Δt v⁻_n to p_b = p − θ Δt v_n. The impulse of spring and damper over the step is
//!
//! λ = Δt k (θ p_b⁺ + (1−θ) p_a⁺) + c (p_b⁺ − p_a⁺) ≥ 0,    only if p_b > 0,    p⁺ = max(p, 0).
//!
//! θ = ½ is the trapezoidal rule between t_{n−½} and t_{n+½}, of second order also for parts that land within the step: the damper acts on
//! the way below the bed only. It lets a bed ring that is hard over the step, so that
//!
//! θ = max(½, 1 − 1/r),    r = Δt (k Δt + c)/m,
//!
//! goes to backward Euler, which takes such a part to rest. On a bed softened to the mesh r is below 2 at all steps that the line allows.
//!
//! The velocity of a part depends on those of both nodes of its segment, which would couple all nodes on the bed. Two approximations avoid that: p_b > 0 is
//! decided with v⁻, and in the share of λ on a node every part changes its velocity by as much as that node. Each node then gets a force P − R v_n of its
//! own, with R the sum of the shares of −∂λ/∂v_n over the parts beside it: the consistent matrix, lumped by rows. The step stays stable for any k and c: on
//! a hard bed the shortest wave of nodes decays by a factor of 0.8 a step, and longer ones decay faster.
//!
//! Source: the θ-method, e.g. Hairer & Wanner (1996), Solving Ordinary Differential Equations II, section IV.3; row sums as a bound of a consistent matrix,
//! Hughes (2000), The Finite Element Method, section 7.3.2. Stable for any k and c.

use super::layout::{BottomArrays, ContactArrays, Layout};
use super::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::physics::seabed::PARTS;

/// Contact of nodes with the seabed in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeContact {
    /// Impulse on nodes at rest [N s].
    pub spring: Lanes,
    /// Decrease of the impulse with the velocity at which the nodes leave the bed [kg].
    pub resistance: Lanes,
}

impl NodeContact {
    /// None.
    pub(super) fn none() -> NodeContact {
        let zero = Lanes::splat(0.0);
        NodeContact {
            spring: zero,
            resistance: zero,
        }
    }

    /// Impulse [N s] on nodes that leave the bed at `rise` [m/s], were it to pull as well: positive where it pushes.
    #[inline(always)]
    pub(super) fn push(&self, rise: Lanes) -> Lanes {
        self.spring - self.resistance * rise
    }
}

/// Penetration of nodes [m], and velocity at which they leave the bed [m/s].
#[derive(Debug, Clone, Copy)]
struct Depth {
    penetration: Lanes,
    rise: Lanes,
    /// True if all nodes of the row are above the highest place of the seabed: the penetration is then an upper bound.
    is_bound: bool,
}

/// Spring and damper of the segments of a row over a step.
#[derive(Debug, Clone, Copy)]
struct ContactRule {
    /// Slope of the force with p_b [N/m].
    slope: Lanes,
    /// Slope of the force with p_a [N/m].
    start: Lanes,
    /// θ Δt and (1−θ) Δt [s].
    ahead: Lanes,
    behind: Lanes,
}

/// Forces of the seabed on the two nodes of the segments of a row at unchanged velocities [N], and their decrease with the velocity at which a node
/// leaves the bed [N s/m].
#[derive(Debug, Clone, Copy)]
struct Pressed {
    force: [Lanes; 2],
    resistance: [Lanes; 2],
}

impl ContactRule {
    /// Rule of a stiffness [N/m] and a damping [N s/m] of segments that yield by 1/m [1/kg].
    #[inline(always)]
    fn new([stiffness, damping]: [Lanes; 2], yields: Lanes, step: Step) -> ContactRule {
        let (one, half) = (Lanes::splat(1.0), Lanes::splat(0.5));
        let (kick, drift) = (Lanes::splat(step.kick), Lanes::splat(step.drift));
        let before = Lanes::splat(step.last()); // the last step may have been of another length
        let even = Lanes::splat(1.0 / step.kick);
        let hardness = kick * (stiffness * drift + damping) * yields;
        let (theta, over) = if (hardness - one - one).any_positive() {
            let theta = (one - (hardness + Lanes::splat(f64::MIN_POSITIVE)).recip()).max(half);
            let over = if step.last() == step.drift {
                even
            } else {
                (theta * drift + (one - theta) * before).recip()
            };
            (theta, over)
        } else {
            (half, even)
        };
        let rate = damping * over;
        ContactRule {
            slope: stiffness * theta + rate,
            start: stiffness * (one - theta) - rate,
            ahead: theta * drift,
            behind: (one - theta) * before,
        }
    }

    /// Forces on the nodes of segments between two depths.
    #[inline(always)]
    fn press(&self, [low, high]: [Depth; 2]) -> Pressed {
        let zero = Lanes::splat(0.0);
        let mut pressed = Pressed {
            force: [zero; 2],
            resistance: [zero; 2],
        };
        let resistance = self.slope * self.ahead;
        for part in PARTS {
            let penetration = part.between(low.penetration, high.penetration);
            let rise = part.between(low.rise, high.rise);
            let after = penetration - self.ahead * rise;
            let before = (penetration + self.behind * rise).positive();
            let force = self.slope * after + self.start * before;
            let active = force.where_positive(after);
            let (force, resistance) = (active.positive(), resistance.where_positive(active));
            for (end, share) in part.shares.map(Lanes::splat).into_iter().enumerate() {
                pressed.force[end] = pressed.force[end] + share * force;
                pressed.resistance[end] = pressed.resistance[end] + share * resistance;
            }
        }
        pressed
    }
}

impl Layout {
    /// Finds spring and resistance of the seabed under the nodes over a step, and its normals where it is more than a level plane. The halo is that of t_n.
    #[inline(always)]
    pub(super) fn press_seabed(&mut self, step: Step) {
        let last = self.striping.rows();
        let (position, velocity) = (self.position.rows(last), self.velocity.rows(last));
        let Some(contact) = &mut self.contact else {
            return;
        };
        let zero = Lanes::splat(0.0);
        let mut low = contact.depth(0, position[0], velocity[0], step);
        let mut before = [zero; 2];
        for at in 0..=last {
            let mut high = contact.depth(at + 1, position[at + 1], velocity[at + 1], step);
            if low.is_bound != high.is_bound {
                low = contact.exact(low, at, position[at], velocity[at]);
                high = contact.exact(high, at + 1, position[at + 1], velocity[at + 1]);
            }
            let mut pressed = contact.press(at, [low, high], step);
            if at == 0 {
                // no segment precedes the first node
                (pressed.force[1][0], pressed.resistance[1][0]) = (0.0, 0.0);
            }
            let resistance = pressed.resistance[0] + before[1];
            let force = pressed.force[0] + before[0];
            contact.spring.store(force + resistance * low.rise, at);
            contact.resistance.store(resistance, at);
            before = [pressed.force[1], pressed.resistance[1]];
            low = high;
        }
    }
}

impl ContactArrays {
    /// Contact of a row of nodes over a step of `kick` [s].
    #[inline(always)]
    pub(super) fn over_step(&self, at: usize, kick: Lanes) -> NodeContact {
        NodeContact {
            spring: kick * self.spring.load(at),
            resistance: kick * self.resistance.load(at),
        }
    }

    /// Forces on the nodes of a row of segments.
    #[inline(always)]
    fn press(&self, at: usize, depths: [Depth; 2], step: Step) -> Pressed {
        let lands = |depth: &Depth| depth.penetration - Lanes::splat(step.drift) * depth.rise;
        let zero = Lanes::splat(0.0);
        if !lands(&depths[0]).max(lands(&depths[1])).any_positive() {
            return Pressed {
                force: [zero; 2],
                resistance: [zero; 2],
            };
        }
        let law = [self.stiffness.load(at), self.damping.load(at)];
        ContactRule::new(law, self.yields.load(at), step).press(depths)
    }

    /// Depth of a row of nodes.
    #[inline(always)]
    fn depth(&mut self, at: usize, place: Vectors, velocity: Vectors, step: Step) -> Depth {
        let level = self.level.load(at);
        let Some(bottom) = &mut self.bottom else {
            return Depth {
                penetration: level - place.z,
                rise: velocity.z,
                is_bound: false,
            };
        };
        let highest = Lanes::splat(bottom.bottom.ground.highest()) + level - place.z;
        let moves = Lanes::splat(step.drift) * velocity.dot(velocity).sqrt();
        if (highest + moves).any_positive() {
            return bottom.depth(at, level, place, velocity);
        }
        bottom.normal.store(Vectors::zero(), at);
        Depth {
            penetration: highest,
            rise: Lanes::splat(0.0),
            is_bound: true,
        }
    }

    /// Depth of a row of nodes, with a bound replaced by the penetration itself.
    #[inline(always)]
    fn exact(&mut self, depth: Depth, at: usize, place: Vectors, velocity: Vectors) -> Depth {
        match &mut self.bottom {
            Some(bottom) if depth.is_bound => bottom.depth(at, self.level.load(at), place, velocity),
            _ => depth,
        }
    }
}

impl BottomArrays {
    /// Depth of a row of nodes whose contact begins at a height above the bed [m].
    #[inline(always)]
    fn depth(&mut self, at: usize, lift: Lanes, place: Vectors, velocity: Vectors) -> Depth {
        let (below, normal) = self.bottom.ground.stand_of_four(place);
        self.normal.store(normal, at);
        Depth {
            penetration: below + lift,
            rise: normal.dot(velocity),
            is_bound: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const STEP: Step = Step {
        kick: 0.1,
        drift: 0.1,
        extrapolation: 0.5,
    };

    /// A level segment of 1 kg.
    fn depths(penetration: f64, rise: f64) -> [Depth; 2] {
        let depth = Depth {
            penetration: Lanes::splat(penetration),
            rise: Lanes::splat(rise),
            is_bound: false,
        };
        [depth; 2]
    }

    /// Impulse [N s] on a level segment of 1 kg that left a bed at `before` and leaves it at `after` [m/s].
    fn impulse(k: f64, c: f64, penetration: f64, [before, after]: [f64; 2]) -> f64 {
        let law = [k, c].map(Lanes::splat);
        let pressed = ContactRule::new(law, Lanes::splat(1.0), STEP).press(depths(penetration, before));
        let node = |end: usize| {
            let resistance = pressed.resistance[end][0];
            pressed.force[end][0] + resistance * (before - after)
        };
        STEP.kick * (node(0) + node(1)).max(0.0)
    }

    #[test]
    fn a_soft_bed_pushes_by_the_trapezoidal_rule() {
        let [before, after] = [-0.3, -0.1];
        let mean = 0.05 - 0.25 * STEP.drift * (after - before);
        let damper = -0.5 * (before + after);
        let expected = STEP.kick * (4.0 * mean + 2.0 * damper);
        assert_relative_eq!(
            impulse(4.0, 2.0, 0.05, [before, after]),
            expected,
            max_relative = 1e-12
        );
    }

    #[test]
    fn a_hard_bed_takes_a_segment_to_rest() {
        let (k, c, penetration, before) = (1e9, 1e4, 1e-3, -2.0);
        // v = v⁻ + λ(v), λ linear
        let at = |v: f64| impulse(k, c, penetration, [before, v]);
        let slope = at(-1.0) - at(-2.0);
        let after = (before + at(-1.0) + slope) / (1.0 - slope);
        assert!((penetration - STEP.drift * after).abs() < 1e-5, "{after}");
    }

    #[test]
    fn a_damper_acts_on_the_way_below_the_bed_only() {
        let expected = 3.0 * (-0.01 + 0.5 * STEP.drift * 0.4); // c p_b
        assert_relative_eq!(
            impulse(0.0, 3.0, -0.01, [-0.4, -0.4]),
            expected,
            max_relative = 1e-12
        );
    }

    #[test]
    fn the_bed_pushes_no_segment_above_it_and_pulls_none() {
        assert_eq!(impulse(10.0, 1.0, -0.1, [-0.4, -0.4]), 0.0);
        assert_eq!(impulse(10.0, 9.0, 0.1, [0.4, 0.9]), 0.0);
    }
}
