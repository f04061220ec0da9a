//! Seabed contact over a time step, with a spring that conserves energy.
//!
//! With the penetrations p₀ before and p₁ after a step Δt, the spring's force is the discrete gradient of its energy,
//!
//!   F = (V(p₁) − V(p₀))/(p₁ − p₀),   V(p) = ½ k max(p, 0)²,
//!
//! and the damper's force is c s(p̄) (p₁ − p₀)/Δt, with the mean p̄ and s as in `fading_damper`. Their sum can only push.
//!
//! Source: discrete gradients, Gonzalez (1996), J. Nonlinear Sci. 6, 449-467. Valid where `seabed` is.

use super::fading_damper::fade;
use super::seabed::ContactCoefficients;

/// Action of the seabed on a part of a segment over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactStep {
    /// Upward force [N].
    pub force: f64,
    /// Slope of the force with respect to p₁ [N/m].
    pub slope: f64,
    /// Part of the force from the spring [N].
    pub spring: f64,
}

/// Force over a step [s] from penetration `before` to `after` [m], with the damper fading in over ± `reach` [m].
#[inline]
pub fn contact_step(k: ContactCoefficients, [before, after]: [f64; 2], reach: f64, step: f64) -> ContactStep {
    let (spring, spring_slope) = spring(k.stiffness, before, after);
    let (fade, fade_slope) = fade(0.5 * (before + after), reach);
    let rate = (after - before) / step;
    let force = spring + k.damping * fade * rate;
    if force <= 0.0 {
        return ContactStep::default();
    }
    ContactStep {
        force,
        slope: spring_slope + k.damping * (fade / step + 0.5 * fade_slope * rate),
        spring,
    }
}

/// Discrete gradient of the spring's energy and its slope with respect to the final penetration.
fn spring(stiffness: f64, before: f64, after: f64) -> (f64, f64) {
    match (before > 0.0, after > 0.0) {
        (false, false) => (0.0, 0.0),
        (true, true) => (0.5 * stiffness * (before + after), 0.5 * stiffness),
        (low, _) => {
            let (inside, sign) = if low { (before, -1.0) } else { (after, 1.0) };
            let moved = after - before;
            let force = sign * 0.5 * stiffness * inside * inside / moved;
            (force, (stiffness * after.max(0.0) - force) / moved)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::central;
    use approx::assert_relative_eq;

    const K: ContactCoefficients = ContactCoefficients {
        stiffness: 100.0,
        damping: 7.0,
    };
    const PAIRS: [[f64; 2]; 6] = [
        [0.1, 0.2],
        [0.2, 0.05],
        [-0.1, 0.2],
        [0.2, -0.1],
        [-0.3, -0.1],
        [0.1, 0.1],
    ];

    #[test]
    fn the_spring_gives_back_exactly_what_it_took() {
        let energy = |p: f64| 0.5 * K.stiffness * p.max(0.0).powi(2);
        for [before, after] in PAIRS {
            let undamped = ContactCoefficients { damping: 0.0, ..K };
            let work = contact_step(undamped, [before, after], 0.0, 0.1).spring * (after - before);
            assert_relative_eq!(work, energy(after) - energy(before), epsilon = 1e-14);
        }
    }

    #[test]
    fn the_slope_equals_central_differences() {
        for [before, after] in PAIRS {
            let at = |after: f64| contact_step(K, [before, after], 0.15, 0.1);
            let difference = central(1e-6, |h| at(after + h).force);
            assert_relative_eq!(at(after).slope, difference, epsilon = 1e-3);
        }
    }

    #[test]
    fn the_seabed_never_pulls_and_its_damper_takes_energy() {
        for [before, after] in PAIRS {
            let at = contact_step(K, [before, after], 0.15, 0.01);
            assert!(at.force >= 0.0);
            assert!((at.force - at.spring) * (after - before) >= 0.0);
        }
    }
}
