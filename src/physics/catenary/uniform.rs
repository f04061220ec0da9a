//! Uniform line held at its two ends without other contact: one scalar equation for every case.
//!
//! With W = wL, κ = |W|/2EA and the unknown λ > 0 (half the difference of asinh(V/H) between the ends):
//!
//! G(λ) = (X/L)² (1/d² − 1) + (Z/L)² (1/(1 + τ)² − 1) + (X² + Z² − L²)/L² = 0
//!
//! d = (λ + κ)/sinh λ,   τ = σ/EA = κ/tanh λ,   then   H = Xσ/(L(λ/tanh λ + τ)),   Vₘ = Zσ/(L(1 + τ)).
//!
//! G increases with λ, so the root is unique. The first two terms are sag (positive) less stretch, the third is the excess of
//! the chord over the line; each is computed without cancellation (the third in twice the precision), so forces keep
//! their digits from the taut light line of infinite stiffness to the deep U. Derivation: module above, "One equation".
//! Valid for w of either sign; w = 0 and X = 0 have their own closed forms.

use super::root;

/// Ratio of span to length below which the line is vertical to double precision [-].
const SPAN_SHARE_MIN: f64 = 1e-100;

/// λ at which sinh³λ nears the largest double [-].
const LAMBDA_MAX: f64 = 235.0;

/// Uniform line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Uniform {
    /// Unstretched length [m].
    pub length: f64,
    /// Weight per unstretched length [N/m].
    pub weight: f64,
    /// Axial stiffness EA [N].
    pub axial_stiffness: f64,
}

/// End forces of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct EndForces {
    /// Horizontal tension at A [N].
    pub horizontal_a: f64,
    /// Horizontal tension at B [N].
    pub horizontal_b: f64,
    /// Vertical tension at A [N], positive up going from A to B.
    pub vertical_a: f64,
    /// Vertical tension at B [N], positive up going from A to B.
    pub vertical_b: f64,
    /// Mobilised Coulomb friction coefficient on the seabed [-].
    pub friction: f64,
    /// Number of evaluations of the solved equation [-].
    pub steps: usize,
}

impl EndForces {
    /// End forces of the same line with its ends exchanged.
    pub(super) fn reversed(self) -> Self {
        EndForces {
            horizontal_a: self.horizontal_b,
            horizontal_b: self.horizontal_a,
            vertical_a: -self.vertical_b,
            vertical_b: -self.vertical_a,
            ..self
        }
    }

    fn suspended(horizontal: f64, vertical_mean: f64, weight_half: f64, steps: usize) -> Self {
        EndForces {
            horizontal_a: horizontal,
            horizontal_b: horizontal,
            vertical_a: vertical_mean - weight_half,
            vertical_b: vertical_mean + weight_half,
            friction: 0.0,
            steps,
        }
    }
}

/// (x² + z² − l²)/l² in twice the working precision: positive where the chord is longer than the line [-].
pub(super) fn excess(x: f64, z: f64, l: f64) -> f64 {
    let square = |a: f64| (a * a, a.mul_add(a, -(a * a)));
    let sum = |a: f64, b: f64| {
        let s = a + b;
        let part = s - a;
        (s, (a - (s - part)) + (b - part))
    };
    let ((x2, x_low), (z2, z_low), (l2, l_low)) = (square(x), square(z), square(l));
    let (first, first_low) = sum(x2, -l2);
    let (second, second_low) = sum(first, z2);
    (second + (first_low + second_low + (x_low + z_low - l_low))) / l2
}

/// sinh β − β for β ≥ 0, to full relative precision.
pub(super) fn sinh_less(beta: f64) -> f64 {
    if beta > 1.5 {
        return beta.sinh() - beta;
    }
    let square = beta * beta;
    let tail = [342.0, 272.0, 210.0, 156.0, 110.0, 72.0, 42.0, 20.0]
        .iter()
        .fold(1.0, |sum, d| 1.0 + square / d * sum);
    beta * square / 6.0 * tail
}

/// Tension [N] of a weightless line of unstretched length `l` and `flexibility` = Σ length/EA, whose ends are (x, z) apart.
pub(super) fn weightless_tension(x: f64, z: f64, l: f64, flexibility: f64) -> f64 {
    let excess = excess(x, z, l);
    // chord/L − 1 = e/(√(1 + e) + 1)
    (excess / ((1.0 + excess).sqrt() + 1.0)).max(0.0) * l / flexibility
}

impl Uniform {
    /// End forces of the line between ends `span` and `rise` apart [m], without other contact.
    pub(super) fn suspend(&self, span: f64, rise: f64) -> EndForces {
        let (l, w, ea) = (self.length, self.weight, self.axial_stiffness);
        let weight_half = 0.5 * w * l;
        if w == 0.0 {
            let chord = span.hypot(rise);
            let tension = weightless_tension(span, rise, l, l / ea);
            let per_chord = if chord > 0.0 { tension / chord } else { 0.0 };
            return EndForces::suspended(per_chord * span, per_chord * rise, 0.0, 0);
        }
        if span <= SPAN_SHARE_MIN * l {
            let taut = ea * (rise.abs() - l) / l;
            let sigma = taut.max(weight_half.abs());
            return EndForces::suspended(0.0, rise * sigma / (l * (1.0 + sigma / ea)), weight_half, 0);
        }
        let balance = Balance {
            a: (span / l) * (span / l),
            b: (rise / l) * (rise / l),
            kappa: weight_half.abs() / ea,
            excess: excess(span, rise, l),
        };
        let root = root::increasing_positive(
            |lambda| balance.at(lambda),
            balance.guess(),
            (f64::MIN_POSITIVE, LAMBDA_MAX),
            |lambda| lambda > 1.0,
        );
        let lambda = root.at;
        let tanh = lambda.tanh();
        let sigma = weight_half.abs() / tanh;
        let tau = sigma / ea;
        let horizontal = span * sigma / (l * (lambda / tanh + tau));
        EndForces::suspended(
            horizontal,
            rise * sigma / (l * (1.0 + tau)),
            weight_half,
            root.steps,
        )
    }
}

/// Equation G(λ) = 0 as a balance of positive terms.
struct Balance {
    /// (X/L)² [-].
    a: f64,
    /// (Z/L)² [-].
    b: f64,
    /// |W|/2EA [-].
    kappa: f64,
    /// (X² + Z² − L²)/L² [-].
    excess: f64,
}

impl Balance {
    /// Logarithm of the ratio of the terms that grow with λ to those that fall, and its derivative with respect to ln λ. It is zero where G is, and
    /// nearly linear in ln λ (λ < 1) or λ.
    fn at(&self, lambda: f64) -> (f64, f64) {
        let (sinh, tanh) = (lambda.sinh(), lambda.tanh());
        let (y, q) = (lambda / sinh, self.kappa / sinh);
        let (d, tau) = (y + q, self.kappa / tanh);
        let sag = sinh_less(lambda) / sinh; // 1 − y
        let square = d * d;
        let (shape, vertical) = ((1.0 + d) / square, 1.0 + tau);
        // slopes in ln λ
        let y_slope = if lambda < 0.02 {
            -y * lambda * lambda / 3.0
        } else {
            y * (1.0 - lambda / tanh)
        };
        let q_slope = -q * lambda / tanh;
        let tau_slope = -tau * lambda / (tanh * lambda.cosh() * lambda.cosh());
        let shape_slope = -(2.0 + d) / (square * d) * (y_slope + q_slope);
        let mut more = self.a * sag * shape;
        let mut less = self.a * q * shape + self.b * tau * (1.0 + vertical) / (vertical * vertical);
        let more_slope = self.a * (sag * shape_slope - y_slope * shape);
        let less_slope = self.a * (q * shape_slope + q_slope * shape)
            + 2.0 * self.b * tau_slope / (vertical * vertical * vertical);
        if self.excess > 0.0 {
            more += self.excess
        } else {
            less -= self.excess
        }
        ((more / less).ln(), more_slope / more - less_slope / less)
    }

    /// First guess of λ from the leading terms: sag against slack length, or stretch against excess, or sag against stretch.
    fn guess(&self) -> f64 {
        let elastic = (6.0 * self.kappa * (self.a + self.b) / self.a).cbrt();
        if self.excess > 0.0 {
            return elastic.min(2.0 * self.kappa / self.excess).min(LAMBDA_MAX);
        }
        // X sinh λ/λ = √(L² − Z²), with ratio² − 1 = −excess/a
        let deficit = -self.excess / self.a;
        let slack = if deficit < 3.0 {
            (6.0 * deficit / (1.0 + (1.0 + deficit).sqrt())).sqrt()
        } else {
            let log = (1.0 + deficit).ln() * 0.5 + std::f64::consts::LN_2;
            log + log.ln()
        };
        let stretched = if elastic < 1.0 {
            elastic
        } else {
            (1.0 + elastic).ln()
        };
        slack.max(stretched).min(LAMBDA_MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::{Uniform, excess, sinh_less};

    #[test]
    fn sinh_less_its_argument_keeps_its_digits() {
        // 60-digit values
        for (beta, exact) in [
            (1e-8, 1.666_666_666_666_666_7e-25),
            (0.5, 0.021_095_305_493_747_36),
            (1.5, 0.629_279_455_094_817_5),
            (1.6, 0.775_567_953_200_229_8),
        ] {
            assert!(
                (sinh_less(beta) / exact - 1.0).abs() < 1e-15,
                "{beta}: {}",
                sinh_less(beta)
            );
        }
    }

    #[test]
    fn the_excess_of_the_chord_survives_cancellation() {
        // 1 + (2⁻¹⁵)² − (1 + 2⁻³⁰)² = −2⁻³⁰ − 2⁻⁶⁰
        let small = 2.0_f64.powi(-30);
        let exact = -small - small * small;
        let computed = excess(1.0, 2.0_f64.powi(-15), 1.0 + small);
        assert!((computed * (1.0 + small).powi(2) / exact - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_taut_line_tends_to_the_stiffness_times_its_strain() {
        for weight in [1.0, 1e-3, 1e-6, -1e-6] {
            let line = Uniform {
                length: 100.0,
                weight,
                axial_stiffness: 1e6,
            };
            let held = line.suspend(60.6, 80.8);
            let tension = held.horizontal_b.hypot(held.vertical_b);
            assert!((tension - 1e4).abs() < weight.abs() * 100.0 + 1e-9, "{tension}");
        }
    }

    #[test]
    fn a_vertical_line_is_the_limit_of_a_narrow_one() {
        let line = Uniform {
            length: 10.0,
            weight: 3.0,
            axial_stiffness: 500.0,
        };
        for rise in [-12.0, -10.3, -4.0, 0.0, 9.9, 10.31, 14.0] {
            let (vertical, narrow) = (line.suspend(0.0, rise), line.suspend(1e-13, rise));
            assert!(
                (vertical.vertical_b - narrow.vertical_b).abs() < 1e-9,
                "{rise}: {vertical:?} {narrow:?}"
            );
            assert_eq!(vertical.horizontal_b, 0.0);
        }
    }
}
