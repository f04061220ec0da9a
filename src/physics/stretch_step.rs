//! Tension of a segment over a time step, with a spring that conserves energy.
//!
//! With the strains ε before and ε' after a step, the tension is the discrete gradient of the energy per unstretched length,
//!
//!   T̄ = (W(ε') − W(ε))/(ε' − ε),
//!
//! along q̄ = (d + d')/(l + l'), with the chords d and d' of lengths l and l'. T̄ q̄·(d' − d) = T̄ (l' − l) is then the change of the spring's
//! energy, whether the segment turns, slackens or snaps within the step. The mean of the forces before and after conserves energy only if the law is
//! linear and nothing turns.
//!
//! Source: discrete gradients, Gonzalez (1996), J. Nonlinear Sci. 6, 449-467; of springs Greenspan (1984), J. Comput. Phys. 56, 28-48. Valid for any law with
//! an energy; its slope is not negative where W is convex.

use nalgebra::{Matrix3, Vector3};

/// Relative change of the strain below which the mean of both tensions replaces the discrete gradient [-]: the two
/// then differ by less than the rounding of the energy difference.
const SMALL: f64 = 1e-5;

/// Spring at a given strain.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spring {
    /// ε = l/L − 1 [-].
    pub strain: f64,
    /// Tension W' [N].
    pub tension: f64,
    /// Slope of the tension with respect to the strain [N].
    pub slope: f64,
    /// Energy W per unstretched length [N].
    pub energy: f64,
}

/// Segment before or after a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stretched {
    /// d, from one node to the next [m].
    pub chord: Vector3<f64>,
    /// l [m].
    pub length: f64,
    /// Direction of the chord [-]; zero where both nodes coincide.
    pub direction: Vector3<f64>,
    /// Spring of the segment.
    pub spring: Spring,
}

impl Stretched {
    /// Force of the spring [N].
    #[inline(always)]
    pub fn force(&self) -> Vector3<f64> {
        self.spring.tension * self.direction
    }
}

/// Tension over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Mean {
    /// T̄ [N].
    pub tension: f64,
    /// dT̄/dε' [N].
    pub slope: f64,
    /// Part of the work that the spring does not store, per unstretched length [N].
    pub taken: f64,
}

impl Mean {
    /// Mean tension of a spring: the discrete gradient of its energy.
    #[inline(always)]
    pub fn of_spring(before: &Spring, after: &Spring) -> Mean {
        let change = after.strain - before.strain;
        if change.abs() <= SMALL * (after.strain.abs() + before.strain.abs()) {
            return Mean::of_tensions(before, after);
        }
        let tension = (after.energy - before.energy) / change;
        Mean {
            tension,
            slope: (after.tension - tension) / change,
            taken: 0.0,
        }
    }

    /// Mean of both tensions, which is exact for a linear spring.
    #[inline(always)]
    pub fn of_tensions(before: &Spring, after: &Spring) -> Mean {
        Mean {
            tension: 0.5 * (before.tension + after.tension),
            slope: 0.5 * after.slope,
            taken: 0.0,
        }
    }
}

/// Force of a segment over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StretchStep {
    /// T̄.
    pub mean: Mean,
    /// q̄ [-].
    pub direction: Vector3<f64>,
    /// 1/(l + l') [1/m]; 0 where the nodes coincide before and after the step.
    per_length: f64,
}

impl StretchStep {
    /// Step between two states with the tension `mean`.
    #[inline(always)]
    pub fn new([before, after]: [&Stretched; 2], mean: Mean) -> StretchStep {
        let (chords, length) = (before.chord + after.chord, before.length + after.length);
        let per_length = if length > 0.0 { 1.0 / length } else { 0.0 };
        StretchStep {
            mean,
            direction: per_length * chords,
            per_length,
        }
    }

    /// T̄ q̄ [N].
    #[inline(always)]
    pub fn force(&self) -> Vector3<f64> {
        self.mean.tension * self.direction
    }

    /// ∂(T̄ q̄)/∂d' [N/m], for an unstretched length [m] and a direction `after` the step [-]; `across` [N] replaces the tension in the resistance to
    /// turning.
    #[inline(always)]
    pub fn stiffness(&self, unstretched: f64, after: Vector3<f64>, across: f64) -> Matrix3<f64> {
        let turning = across * self.per_length;
        let along = (self.mean.slope / unstretched - turning) * self.direction;
        Matrix3::from_diagonal_element(turning) + along * after.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::along;
    use approx::assert_relative_eq;

    const UNSTRETCHED: f64 = 0.5;

    /// Spring that cannot push, and stiffens with strain.
    fn spring(strain: f64) -> Spring {
        let ea = 2.0e4;
        let e = strain.max(0.0);
        Spring {
            strain,
            tension: ea * (e + 0.5 * e * e),
            slope: if strain > 0.0 { ea * (1.0 + e) } else { 0.0 },
            energy: ea * (0.5 * e * e + e * e * e / 6.0),
        }
    }

    fn stretched(chord: Vector3<f64>) -> Stretched {
        Stretched {
            chord,
            length: chord.norm(),
            direction: chord.try_normalize(0.0).unwrap_or_default(),
            spring: spring(chord.norm() / UNSTRETCHED - 1.0),
        }
    }

    fn step(before: Vector3<f64>, after: Vector3<f64>) -> StretchStep {
        let ends = [before, after].map(stretched);
        let mean = Mean::of_spring(&ends[0].spring, &ends[1].spring);
        StretchStep::new([&ends[0], &ends[1]], mean)
    }

    /// Pairs of chords [m]: taut, slackening, snapping, slack, hardly moved, and turned by a right angle and more.
    fn chords() -> Vec<[Vector3<f64>; 2]> {
        let taut = Vector3::new(0.4, 0.3, 0.05);
        let slack = Vector3::new(-0.1, 0.3, 0.2);
        let turned = Vector3::new(-0.35, 0.4, 0.02);
        let nearly = taut + Vector3::new(1e-9, -2e-9, 1e-9);
        vec![
            [taut, 1.1 * taut],
            [taut, slack],
            [slack, taut],
            [slack, 0.9 * slack],
            [taut, nearly],
            [taut, turned],
            [1.02 * turned, -0.9 * taut],
        ]
    }

    #[test]
    fn its_work_is_what_the_spring_comes_to_hold_and_it_pulls_both_ends_alike() {
        for [before, after] in chords() {
            let work = step(before, after).force().dot(&(after - before));
            let [old, new] = [before, after].map(|chord| stretched(chord).spring.energy);
            let held = (new - old) * UNSTRETCHED;
            assert_relative_eq!(work, held, max_relative = 1e-6, epsilon = 1e-9);
            // the force is along the mean chord, so that angular momentum is conserved
            assert!(step(before, after).force().cross(&(before + after)).norm() < 1e-9);
        }
    }

    #[test]
    fn its_stiffness_is_the_slope_of_its_force() {
        for [before, after] in chords() {
            let at = step(before, after);
            let direction = stretched(after).direction;
            let stiffness = at.stiffness(UNSTRETCHED, direction, at.mean.tension);
            for axis in 0..3 {
                let slope = along(axis, 1e-7, |by| step(before, after + by).force());
                let column = stiffness.column(axis).into_owned();
                assert_relative_eq!(column, slope, epsilon = 1e-3, max_relative = 1e-3);
            }
        }
    }
}
