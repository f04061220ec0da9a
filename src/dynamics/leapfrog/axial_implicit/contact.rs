//! Spring and damper of the bed over a step of the axial-implicit leapfrog.
//!
//! A step changes the velocity v⁻ of t_{n−½} to the v of t_{n+½}. With the penetration p at t_n and the velocity v_n at which a node leaves the bed, it goes
//! from p_a = p + (1−θ) Δt v⁻_n to p_b = p − θ Δt v_n, and what spring and damper push in that time is
//!
//! λ = Δt k (θ p_b⁺ + (1−θ) p_a⁺) + c (p_b⁺ − p_a⁺) ≥ 0,    only if p_b > 0,    p⁺ = max(p, 0).
//!
//! θ = ½ is the trapezoidal rule between t_{n−½} and t_{n+½}, of second order also for nodes that land within the step: the damper acts on
//! the way below the bed only. It lets a bed ring that is hard over the step, so that
//!
//! θ = max(½, 1 − 1/r),    r = Δt (k Δt + c) n·M⁻¹n,
//!
//! goes to backward Euler, which takes such a node to rest. On a bed softened to the mesh r is below 2 at all steps that the line allows.
//!
//! Source: the θ-method, e.g. Hairer & Wanner (1996), Solving Ordinary Differential Equations II, section IV.3. Stable for any k and c.

use crate::dynamics::leapfrog::step::Step;
use crate::math::lanes::Lanes;

/// Normal contact of nodes with the seabed in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalContact {
    /// Penetration p [m].
    penetration: Lanes,
    /// θ Δt [s].
    ahead: Lanes,
    /// λ of nodes that do not leave the bed [N s], and what it loses with the speed at which they do [kg].
    pub spring: Lanes,
    pub resistance: Lanes,
}

impl NormalContact {
    /// None.
    pub(super) fn none() -> NormalContact {
        let zero = Lanes::splat(0.0);
        NormalContact {
            penetration: zero,
            ahead: zero,
            spring: zero,
            resistance: zero,
        }
    }

    /// A bed of stiffness k [N/m] and damping c [N s/m] under nodes that left it at `rise` [m/s] in the last step and yield to it by n·M⁻¹n [1/kg].
    #[inline(always)]
    pub(super) fn new(
        [stiffness, damping]: [Lanes; 2],
        penetration: Lanes,
        rise: Lanes,
        yields: Lanes,
        step: Step,
    ) -> NormalContact {
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
        let (ahead, rest) = (theta * drift, one - theta);
        let start = (penetration + rest * before * rise).positive();
        let rate = damping * over;
        let slope = stiffness * theta + rate;
        NormalContact {
            penetration,
            ahead,
            spring: kick * (slope * penetration + (stiffness * rest - rate) * start),
            resistance: kick * slope * ahead,
        }
    }

    /// Impulse [N s] on nodes that leave the bed at `rise` [m/s], were it to pull as well.
    #[inline(always)]
    pub(super) fn push(&self, rise: Lanes) -> Lanes {
        self.spring - self.resistance * rise
    }

    /// Number that is positive where the seabed pushes nodes that leave it at `rise` [m/s].
    #[inline(always)]
    pub(super) fn pushes(&self, rise: Lanes) -> Lanes {
        (self.penetration - self.ahead * rise).where_positive(self.push(rise))
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

    /// Impulse [N s] on 1 kg that left a bed at `before` and leaves it at `after` [m/s].
    fn impulse(k: f64, c: f64, penetration: f64, [before, after]: [f64; 2]) -> f64 {
        let lanes = Lanes::splat;
        let bed = NormalContact::new(
            [lanes(k), lanes(c)],
            lanes(penetration),
            lanes(before),
            lanes(1.0),
            STEP,
        );
        let push = bed.push(lanes(after)).where_positive(bed.pushes(lanes(after)));
        push[0]
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
    fn a_hard_bed_takes_a_node_to_rest() {
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
    fn the_bed_pushes_no_node_above_it_and_pulls_none() {
        assert_eq!(impulse(10.0, 1.0, -0.1, [-0.4, -0.4]), 0.0);
        assert_eq!(impulse(10.0, 9.0, 0.1, [0.4, 0.9]), 0.0);
    }
}
