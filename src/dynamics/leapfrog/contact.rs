//! Spring and damper of the seabed over a step of the leapfrogs.
//!
//! A step changes the velocity v⁻ at t_{n−½} to v at t_{n+½}. The subscript n denotes the component normal to the seabed, positive away from it. The
//! penetration of a part of a segment ([`crate::physics::seabed`]), p at t_n, changes from p_a = p + (1−θ) Δt v⁻_n to p_b = p − θ Δt v_n. The impulse of
//! spring and damper over the step is
//!
//! λ = Δt k (θ p_b⁺ + (1−θ) p_a⁺) + c (p_b⁺ − p_a⁺) ≥ 0,    only if p_b > 0,    p⁺ = max(p, 0).
//!
//! θ = ½ is the trapezoidal rule between t_{n−½} and t_{n+½}. It is of second order even for parts that land within the step: the damper acts only on
//! the path below the seabed. On a seabed that is stiff over the step, it would leave undamped oscillations. Therefore
//!
//! θ = max(½, 1 − 1/r),    r = Δt (k Δt + c)/m,
//!
//! which tends to backward Euler and brings such a part to rest. On a seabed softened to the mesh, r is below 2 at all steps that the line allows.
//!
//! The velocity of a part depends on those of both nodes of its segment, which would couple all nodes on the seabed. Two approximations avoid that: p_b > 0
//! is decided with v⁻, and in the share of λ on a node the velocity of every part changes by as much as that of the node. Each node then has a separate
//! force P − R v_n. R is the sum of the shares of −∂λ/∂v_n over the adjacent parts: the consistent matrix, lumped by rows. The step is stable for any k
//! and c: on a hard seabed the shortest wave of nodes decays by a factor of 0.8 per step, and longer ones decay faster.
//!
//! Source: the θ-method, e.g. Hairer & Wanner (1996), Solving Ordinary Differential Equations II, section IV.3; row sums as a bound on a consistent matrix,
//! Hughes (2000), The Finite Element Method, section 7.3.2. Valid for any k and c.

use super::layout::{ContactArrays, Layout, SeabedArrays};
use super::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::physics::ground::{Ground, stand_on_plane};
use crate::physics::seabed::Part;

#[derive(Debug, Clone, Copy)]
pub(super) struct NodeContact {
    /// Impulse on nodes at rest [N s].
    pub spring: Lanes,
    /// Decrease of the impulse with the velocity at which the nodes leave the seabed [kg].
    pub resistance: Lanes,
}

impl NodeContact {
    pub(super) fn none() -> NodeContact {
        let zero = Lanes::splat(0.0);
        NodeContact {
            spring: zero,
            resistance: zero,
        }
    }

    /// Impulse [N s] on nodes that leave the seabed at `rise` [m/s], positive if the seabed pushes; it is not limited to positive values.
    #[inline(always)]
    pub(super) fn push(&self, rise: Lanes) -> Lanes {
        self.spring - self.resistance * rise
    }
}

/// Penetration of nodes [m], and velocity at which they leave the seabed [m/s].
#[derive(Debug, Clone, Copy)]
struct Depth {
    penetration: Lanes,
    rise: Lanes,
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

/// Forces of the seabed on the lower and upper nodes of a row of segments at unchanged velocities [N], and their decrease with the velocity at which
/// the nodes leave the seabed [N s/m].
#[derive(Debug, Clone, Copy)]
struct Pressed {
    force: [Lanes; 2],
    resistance: [Lanes; 2],
}

impl ContactRule {
    /// Rule for the stiffness [N/m], damping [N s/m] and inverse mass `yields` [1/kg] of segments.
    #[inline(always)]
    fn new([stiffness, damping]: [Lanes; 2], yields: Lanes, step: Step) -> ContactRule {
        let (one, half) = (Lanes::splat(1.0), Lanes::splat(0.5));
        let (kick, drift) = (Lanes::splat(step.kick), Lanes::splat(step.drift));
        let before = Lanes::splat(step.last()); // the last step may have had a different length
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

    /// Forces on the nodes of segments, from the depths of both nodes, with contact at four parts of a segment.
    #[inline(always)]
    fn press(&self, parts: &[Part; 4], [low, high]: [Depth; 2]) -> Pressed {
        let zero = Lanes::splat(0.0);
        let after = low.penetration - self.ahead * low.rise;
        let before = low.penetration + self.behind * low.rise;
        let after_change = high.penetration - self.ahead * high.rise - after;
        let before_change = high.penetration + self.behind * high.rise - before;
        let stiff = self.slope * self.ahead;
        let (mut force, mut force_high) = (zero, zero);
        let (mut resistance, mut resistance_high) = (zero, zero);
        for part in parts {
            let at = Lanes::splat(part.at);
            let after = after + at * after_change;
            let before = before + at * before_change;
            let push = (self.slope * after + self.start * before.positive()).where_positive(after);
            let (push, stiff) = (push.positive(), stiff.where_positive(push));
            force = force + push;
            force_high = force_high + at * push;
            resistance = resistance + stiff;
            resistance_high = resistance_high + at * stiff;
        }
        let share = Lanes::splat(0.25);
        Pressed {
            force: [share * (force - force_high), share * force_high],
            resistance: [share * (resistance - resistance_high), share * resistance_high],
        }
    }
}

impl Layout {
    /// Computes spring and resistance of the seabed under the nodes over a step, and its normals unless it is a level plane without friction. The halo must
    /// be that of t_n.
    #[inline(always)]
    pub(super) fn press_seabed(&mut self, step: Step) {
        let last = self.striping.rows();
        let (position, velocity) = (self.position.rows(last), self.velocity.rows(last));
        let Some(contact) = &mut self.contact else {
            return;
        };
        let level = contact.level.rows(last);
        let segments = SegmentRows {
            stiffness: contact.stiffness.rows(last),
            damping: contact.damping.rows(last),
            yields: contact.yields.rows(last),
            parts: contact.parts,
            step,
        };
        let found = [contact.spring.rows_mut(last), contact.resistance.rows_mut(last)];
        match &mut contact.seabed {
            None => segments.press(found, |at| Depth {
                penetration: level[at] - position[at].z,
                rise: velocity[at].z,
            }),
            Some(seabed) => {
                seabed.find_depths(level, [position, velocity], step);
                let (penetration, rise) = (seabed.penetration.rows(last), seabed.rise.rows(last));
                segments.press(found, |at| Depth {
                    penetration: penetration[at],
                    rise: rise[at],
                });
            }
        }
    }
}

struct SegmentRows<'a> {
    stiffness: &'a [Lanes],
    damping: &'a [Lanes],
    yields: &'a [Lanes],
    /// Parts of a segment at which contact acts.
    parts: &'static [Part; 4],
    step: Step,
}

impl SegmentRows<'_> {
    /// Writes spring and resistance of all rows of nodes; `depth` returns the depths of a row.
    #[inline(always)]
    fn press(&self, [spring, resistance]: [&mut [Lanes]; 2], depth: impl Fn(usize) -> Depth) {
        let (zero, last) = (Lanes::splat(0.0), spring.len() - 2);
        let before = self.press_row(last, [depth(last), depth(last + 1)]);
        let [mut force_before, mut resistance_before] =
            [before.force[1], before.resistance[1]].map(|of| of.moved_up_after(zero));
        let mut low = depth(1);
        for at in 1..=last {
            let high = depth(at + 1);
            let pressed = self.press_row(at, [low, high]);
            let total = pressed.resistance[0] + resistance_before;
            spring[at] = pressed.force[0] + force_before + total * low.rise;
            resistance[at] = total;
            (force_before, resistance_before) = (pressed.force[1], pressed.resistance[1]);
            low = high;
        }
    }

    #[inline(always)]
    fn press_row(&self, at: usize, [low, high]: [Depth; 2]) -> Pressed {
        let lands = |depth: Depth| depth.penetration - Lanes::splat(self.step.drift) * depth.rise;
        let zero = Lanes::splat(0.0);
        if !lands(low).max(lands(high)).any_positive() {
            return Pressed {
                force: [zero; 2],
                resistance: [zero; 2],
            };
        }
        let law = [self.stiffness[at], self.damping[at]];
        ContactRule::new(law, self.yields[at], self.step).press(self.parts, [low, high])
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
}

impl SeabedArrays {
    /// Computes the depths of all rows of nodes, whose contact begins at `lift` [m] above the seabed, and the normals there. A row that is above the
    /// highest point of the seabed, and whose neighbours are, gets a bound on its penetration and no normal.
    #[inline(always)]
    fn find_depths(&mut self, lift: &[Lanes], [position, velocity]: [&[Vectors]; 2], step: Step) {
        let rows = lift.len();
        let mut depths = DepthRows {
            normal: self.normal.rows_mut(rows - 2),
            penetration: self.penetration.rows_mut(rows - 2),
            rise: self.rise.rows_mut(rows - 2),
        };
        let grid = match &self.seabed.ground {
            Ground::Plane { height, slope } => {
                for at in 0..rows {
                    let (below, normal) = stand_on_plane(*height, *slope, position[at]);
                    depths.write(at, [below + lift[at], normal.dot(velocity[at])], normal);
                }
                return;
            }
            Ground::Grid(grid) => grid,
        };
        let above = Above {
            highest: Lanes::splat(grid.highest()),
            square: Lanes::splat(step.drift * step.drift),
            lift,
            position,
            velocity,
        };
        let cells = &mut self.cells[..rows];
        let mut near = [false, above.reached(0), above.reached(1)];
        for at in 0..rows {
            if near.contains(&true) {
                grid.find_cells(position[at], &mut cells[at]);
                let (below, normal) = cells[at].stand(position[at]);
                depths.write(at, [below + lift[at], normal.dot(velocity[at])], normal);
            } else {
                depths.write(at, [above.bound(at), Lanes::splat(0.0)], Vectors::zero());
            }
            near = [near[1], near[2], at + 2 < rows && above.reached(at + 2)];
        }
    }
}

struct DepthRows<'a> {
    normal: &'a mut [Vectors],
    penetration: &'a mut [Lanes],
    rise: &'a mut [Lanes],
}

impl DepthRows<'_> {
    /// Writes penetration [m], rise [m/s] and normal of a row.
    #[inline(always)]
    fn write(&mut self, at: usize, [penetration, rise]: [Lanes; 2], normal: Vectors) {
        self.normal[at] = normal;
        (self.penetration[at], self.rise[at]) = (penetration, rise);
    }
}

/// Test of nodes against the highest point of the soundings.
struct Above<'a> {
    /// Height of that point [m].
    highest: Lanes,
    /// Square of the drift of a step [s²].
    square: Lanes,
    /// Height above the seabed at which contact begins [m].
    lift: &'a [Lanes],
    position: &'a [Vectors],
    velocity: &'a [Vectors],
}

impl Above<'_> {
    /// Upper bound on the penetration of a row of nodes [m].
    #[inline(always)]
    fn bound(&self, at: usize) -> Lanes {
        self.highest + self.lift[at] - self.position[at].z
    }

    /// Returns whether a node of a row may reach that height within a step, plus the height at which contact begins.
    #[inline(always)]
    fn reached(&self, at: usize) -> bool {
        let (bound, velocity) = (self.bound(at), self.velocity[at]);
        let drift_squared = self.square * velocity.dot(velocity);
        bound.max(drift_squared - bound * bound).any_positive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::seabed::{ENDS, PARTS};
    use approx::assert_relative_eq;

    const STEP: Step = Step {
        kick: 0.1,
        drift: 0.1,
        extrapolation: 0.5,
    };

    fn depths(penetration: f64, rise: f64) -> [Depth; 2] {
        let depth = Depth {
            penetration: Lanes::splat(penetration),
            rise: Lanes::splat(rise),
        };
        [depth; 2]
    }

    /// Impulse [N s] on a level segment of 1 kg that leaves the seabed at `before` [m/s] before the step and at `after` [m/s] after it.
    fn impulse(k: f64, c: f64, penetration: f64, [before, after]: [f64; 2]) -> f64 {
        let law = [k, c].map(Lanes::splat);
        let rule = ContactRule::new(law, Lanes::splat(1.0), STEP);
        let [pressed, at_nodes] = [
            rule.press(&PARTS, depths(penetration, before)),
            rule.press(&ENDS, depths(penetration, before)),
        ];
        for end in 0..2 {
            assert_relative_eq!(
                at_nodes.force[end][0],
                pressed.force[end][0],
                max_relative = 1e-12
            );
            assert_relative_eq!(
                at_nodes.resistance[end][0],
                pressed.resistance[end][0],
                max_relative = 1e-12
            );
        }
        let node = |end: usize| {
            let resistance = pressed.resistance[end][0];
            pressed.force[end][0] + resistance * (before - after)
        };
        STEP.kick * (node(0) + node(1)).max(0.0)
    }

    #[test]
    fn a_soft_seabed_pushes_by_the_trapezoidal_rule() {
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
    fn a_hard_seabed_takes_a_segment_to_rest() {
        let (k, c, penetration, before) = (1e9, 1e4, 1e-3, -2.0);
        // v = v⁻ + λ(v), λ linear
        let at = |v: f64| impulse(k, c, penetration, [before, v]);
        let slope = at(-1.0) - at(-2.0);
        let after = (before + at(-1.0) + slope) / (1.0 - slope);
        assert!((penetration - STEP.drift * after).abs() < 1e-5, "{after}");
    }

    #[test]
    fn a_damper_acts_on_the_way_below_the_seabed_only() {
        let expected = 3.0 * (-0.01 + 0.5 * STEP.drift * 0.4); // c p_b
        assert_relative_eq!(
            impulse(0.0, 3.0, -0.01, [-0.4, -0.4]),
            expected,
            max_relative = 1e-12
        );
    }

    #[test]
    fn the_seabed_pushes_no_segment_above_it_and_pulls_none() {
        assert_eq!(impulse(10.0, 1.0, -0.1, [-0.4, -0.4]), 0.0);
        assert_eq!(impulse(10.0, 9.0, 0.1, [0.4, 0.9]), 0.0);
    }
}
