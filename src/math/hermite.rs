//! Cubic Hermite segment between two points with given slopes, and its derivatives.

/// p(t) on [t0, t0 + h] from values and slopes at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hermite {
    start: f64,
    span: f64,
    /// Coefficients of powers of u = (t − t0)/h.
    powers: [f64; 4],
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
    /// Through (time, value, slope) at both ends; the second time must be the later one.
    pub fn new((t0, p0, m0): Knot, (t1, p1, m1): Knot) -> Hermite {
        let span = t1 - t0;
        let (m0, m1) = (span * m0, span * m1);
        let rise = p1 - p0;
        Hermite {
            start: t0,
            span,
            powers: [p0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise],
        }
    }

    /// Coefficients of powers of the part of its span that is passed.
    pub fn powers(&self) -> [f64; 4] {
        self.powers
    }

    /// Value and derivatives at time `t`.
    pub fn at(&self, t: f64) -> Sample {
        let u = (t - self.start) / self.span;
        let [a, b, c, d] = self.powers;
        Sample {
            value: a + u * (b + u * (c + u * d)),
            slope: (b + u * (2.0 * c + 3.0 * u * d)) / self.span,
            curvature: (2.0 * c + 6.0 * u * d) / (self.span * self.span),
        }
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
}
