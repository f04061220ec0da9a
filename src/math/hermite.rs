//! Hermite segments between two points: cubics with given slopes, quintics with given slopes and curvatures.
//!
//! The quintic of a curve f deviates from it by f⁽⁶⁾ h⁶ u³(1 − u)³/720, with the sixth derivative at some point between the ends. The deviation is at
//! most max|f⁽⁶⁾| h⁶/46080, at mid-span.
//!
//! Source: the remainder of Hermite interpolation, e.g. Stoer & Bulirsch (2002), Introduction to Numerical Analysis, theorem 2.1.5.9.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::lanes::Lanes;

/// p(t) on [t0, t0 + h] from values and slopes at both ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Hermite {
    start: f64,
    /// Inverse span 1/h.
    rate: f64,
    /// Coefficients of powers of u = (t − t0)/h.
    powers: [f64; 4],
}

/// Four cubics side by side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Hermites {
    start: f64,
    /// Inverse span 1/h, 0 where the curves are constant.
    rate: f64,
    powers: [Lanes; 4],
}

/// Value and derivatives of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Value.
    pub value: f64,
    /// First derivative.
    pub slope: f64,
    /// Second derivative.
    pub curvature: f64,
}

type Knot = (f64, f64, f64);

impl Hermite {
    /// Cubic through (time, value, slope) at both ends; the second time must be the later one.
    pub fn new((t0, p0, m0): Knot, (t1, p1, m1): Knot) -> Hermite {
        let span = t1 - t0;
        let (m0, m1) = (span * m0, span * m1);
        let rise = p1 - p0;
        Hermite {
            start: t0,
            rate: 1.0 / span,
            powers: [p0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise],
        }
    }

    /// Coefficients of the powers of the elapsed fraction u of the span.
    pub fn powers(&self) -> [f64; 4] {
        self.powers
    }

    /// Value and derivatives at time `t`.
    #[inline]
    pub fn at(&self, t: f64) -> Sample {
        let u = (t - self.start) * self.rate;
        let [a, b, c, d] = self.powers;
        Sample {
            value: a + u * (b + u * (c + u * d)),
            slope: (b + u * (2.0 * c + 3.0 * u * d)) * self.rate,
            curvature: (2.0 * c + 6.0 * u * d) * (self.rate * self.rate),
        }
    }
}

impl Hermites {
    /// Cubics from time `start` over `span`, with the inverse span `rate`, through values and slopes at both ends.
    #[inline(always)]
    pub fn bridge([start, span, rate]: [f64; 3], [p0, m0]: [Lanes; 2], [p1, m1]: [Lanes; 2]) -> Hermites {
        let (two, three) = (Lanes::splat(2.0), Lanes::splat(3.0));
        let span = Lanes::splat(span);
        let (m0, m1) = (span * m0, span * m1);
        let rise = p1 - p0;
        Hermites {
            start,
            rate,
            powers: [p0, m0, three * rise - two * m0 - m1, m0 + m1 - two * rise],
        }
    }

    /// Mean slopes over the span, and the inverse span; both are 0 where the curves are constant.
    #[inline(always)]
    pub fn secant(&self) -> (Lanes, f64) {
        let [_, b, c, d] = self.powers;
        ((b + (c + d)) * Lanes::splat(self.rate), self.rate)
    }

    /// Curves that are constant in time.
    pub fn constant(values: Lanes) -> Hermites {
        let zero = Lanes::splat(0.0);
        Hermites {
            start: 0.0,
            rate: 0.0,
            powers: [values, zero, zero, zero],
        }
    }

    /// Values, first and second derivatives at time `t`.
    #[inline(always)]
    pub fn at(&self, t: f64) -> [Lanes; 3] {
        let u = Lanes::splat((t - self.start) * self.rate);
        let rate = Lanes::splat(self.rate);
        let [a, b, c, d] = self.powers;
        let (two_c, three_ud) = (c + c, Lanes::splat(3.0) * u * d);
        [
            a + u * (b + u * (c + u * d)),
            (b + u * (two_c + three_ud)) * rate,
            (two_c + Lanes::splat(2.0) * three_ud) * (rate * rate),
        ]
    }

    /// Values, first and second derivatives at both ends.
    #[inline(always)]
    pub fn ends(&self) -> [[Lanes; 3]; 2] {
        let rate = Lanes::splat(self.rate);
        let [a, b, c, d] = self.powers;
        let (two_c, three_d) = (c + c, Lanes::splat(3.0) * d);
        let curvature = |two_c: Lanes| two_c * (rate * rate);
        [
            [a, b * rate, curvature(two_c)],
            [
                a + (b + (c + d)),
                (b + (two_c + three_d)) * rate,
                curvature(two_c + Lanes::splat(2.0) * three_d),
            ],
        ]
    }
}

/// Maximum error of a quintic relative to the sixth derivative times the sixth power of its span [-].
pub const QUINTIC_ERROR: f64 = 1.0 / 46080.0;

/// Value, first and second derivative of a curve in space.
pub type Motion = [Vector3<f64>; 3];

/// Quintic p(u), 0 ≤ u ≤ 1, in space, as coefficients of the powers of u.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quintic([Vector3<f64>; 6]);

impl Quintic {
    /// Quintic through values, slopes and curvatures at two ends, `span` apart in time.
    pub fn new([r0, v0, a0]: Motion, [r1, v1, a1]: Motion, span: f64) -> Quintic {
        let (slope, half_curvature) = (span * v0, 0.5 * span * span * a0);
        let rise = r1 - r0 - slope - half_curvature;
        let steeper = span * v1 - slope - 2.0 * half_curvature;
        let bend = 0.5 * span * span * a1 - half_curvature;
        Quintic([
            r0,
            slope,
            half_curvature,
            10.0 * rise - 4.0 * steeper + bend,
            7.0 * steeper - 15.0 * rise - 2.0 * bend,
            6.0 * rise - 3.0 * steeper + bend,
        ])
    }

    /// Value and derivatives at the fraction u of the span, whose inverse is `rate`.
    #[inline]
    pub fn at(&self, u: f64, rate: f64) -> Motion {
        let [a, b, c, d, e, f] = self.0;
        [
            a + u * (b + u * (c + u * (d + u * (e + u * f)))),
            (b + u * (2.0 * c + u * (3.0 * d + u * (4.0 * e + 5.0 * u * f)))) * rate,
            (2.0 * c + u * (6.0 * d + u * (12.0 * e + 20.0 * u * f))) * (rate * rate),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_cubic_is_reproduced_with_its_derivatives() {
        let p = |t: f64| 1.0 + t - 2.0 * t * t * t;
        let dp = |t: f64| 1.0 - 6.0 * t * t;
        let curve = Hermite::new((0.5, p(0.5), dp(0.5)), (2.0, p(2.0), dp(2.0)));
        let sample = curve.at(1.3);
        assert_relative_eq!(sample.value, p(1.3), epsilon = 1e-13);
        assert_relative_eq!(sample.slope, dp(1.3), epsilon = 1e-13);
        assert_relative_eq!(sample.curvature, -12.0 * 1.3, epsilon = 1e-12);
    }
    /// Test curve with its first two derivatives at time `t`.
    fn wave(t: f64) -> Motion {
        let (x, y) = ((1.3 * t).sin_cos(), (0.7 * t).sin_cos());
        [
            Vector3::new(x.0, y.1, t),
            Vector3::new(1.3 * x.1, -0.7 * y.0, 1.0),
            Vector3::new(-1.69 * x.0, -0.49 * y.1, 0.0),
        ]
    }

    #[test]
    fn a_quintic_misses_a_curve_by_no_more_than_its_remainder() {
        for span in [0.5, 0.25, 0.125] {
            let start = 0.5 * (std::f64::consts::PI / 1.3 - span); // the sixth derivative of x is largest at mid-span
            let curve = Quintic::new(wave(start), wave(start + span), span);
            let bound = 1.3_f64.powi(6) * span.powi(6) * QUINTIC_ERROR;
            let miss = |u: f64| (curve.at(u, 1.0 / span)[0] - wave(start + u * span)[0]).x.abs();
            let worst = (0..=20).map(|k| miss(0.05 * f64::from(k))).fold(0.0, f64::max);
            assert!(
                worst <= bound + 1e-15 && worst > 0.9 * bound,
                "{worst} of {bound}"
            );
        }
    }

    #[test]
    fn a_quintic_meets_value_slope_and_curvature_at_its_ends() {
        let curve = Quintic::new(wave(2.0), wave(2.5), 0.5);
        for (u, t) in [(0.0, 2.0), (1.0, 2.5)] {
            for (is, should) in curve.at(u, 2.0).into_iter().zip(wave(t)) {
                assert_relative_eq!(is, should, epsilon = 1e-12);
            }
        }
    }
}
