//! Uniform heavy line that lies partly on a flat seabed: one scalar equation in the horizontal tension.
//!
//! A flight that leaves the seabed (V = 0) under H and rises by D has the vertical tension V at its upper end:
//!
//! T − H + V²/2EA = wD   ⇒   V² = 2wD(wD + 2H) / (1 + c/EA + √(1 + 2c/EA + H²/EA²)),   c = wD + H
//!
//! The excess of the flight's length over its geometric span is E(H) = (H/w)(sinh β − β), sinh β = V/H. The ends are
//! the span X apart where
//!
//! Σ E(H) + (X − L) = ∫ H ds / EA
//!
//! with the sum over one flight (A on the seabed) or two (A above it). The left side falls with H and the right side rises, so there is one root.
//! Friction lowers the tension on the seabed by μw per metre towards A, not below 0, which enters the integral on the right. At H = 0 the flights
//! hang vertically; any line left over even then is slack. Every term is positive and computed without cancellation, and the logarithm of the ratio
//! of the two sides is nearly linear in ln H, so Newton's method needs four or five steps. Derived here (module above, "The seabed"). Valid for w > 0
//! and, with friction, for A on the seabed.

use super::root;
use super::uniform::{EndForces, Uniform, sinh_less};

/// Horizontal tension treated as zero, relative to the weight of the line [-].
const HORIZONTAL_SHARE_MIN: f64 = 1e-40;

/// Ends of a line that touches down.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touchdown {
    /// Horizontal distance of the ends [m].
    pub span: f64,
    /// Height of A above the seabed [m].
    pub height_a: f64,
    /// Height of B above the seabed [m].
    pub height_b: f64,
    /// Coulomb friction μ [-].
    pub friction: f64,
}

/// Flight from the seabed under a given H.
struct Lift {
    /// Vertical tension at its upper end [N].
    vertical: f64,
    /// Excess of its length over its geometric span [m].
    excess: f64,
    /// ∂V/∂H [-].
    vertical_slope: f64,
    /// ∂E/∂H [m/N].
    excess_slope: f64,
}

impl Uniform {
    fn lift(&self, h: f64, height: f64) -> Lift {
        if height <= 0.0 {
            return Lift {
                vertical: 0.0,
                excess: 0.0,
                vertical_slope: 0.0,
                excess_slope: 0.0,
            };
        }
        let (w, ea) = (self.weight, self.axial_stiffness);
        let wd = w * height;
        let (hs, cs) = (h / ea, (wd + h) / ea);
        let vertical = (2.0 * wd * (wd + 2.0 * h) / (1.0 + cs + (1.0 + 2.0 * cs + hs * hs).sqrt())).sqrt();
        if h == 0.0 {
            return Lift {
                vertical,
                excess: vertical / w,
                vertical_slope: 0.0,
                excess_slope: 0.0,
            };
        }
        let tension = (h * h + vertical * vertical).sqrt();
        let beta = (vertical / h).asinh();
        let sine = vertical / tension;
        let rest = sine * vertical / (tension + h); // 1 − H/T
        let vertical_slope = rest / (sine + vertical / ea);
        // tanh β − β, by its series where the difference would lose digits
        let bend = if beta < 0.05 {
            -beta * beta * beta / 3.0 * (1.0 - 0.4 * beta * beta)
        } else {
            sine - beta
        };
        Lift {
            vertical,
            excess: h / w * sinh_less(beta),
            vertical_slope,
            excess_slope: (vertical_slope * rest + bend) / w,
        }
    }

    /// End forces of the line, which must touch the seabed.
    pub(super) fn touch_down(&self, at: &Touchdown) -> EndForces {
        let (l, w, ea) = (self.length, self.weight, self.axial_stiffness);
        let hanging = (
            self.lift(0.0, at.height_a).vertical,
            self.lift(0.0, at.height_b).vertical,
        );
        let longer = at.span - l; // negative: the line is longer than the span
        if longer + (hanging.0 + hanging.1) / w <= 0.0 {
            return EndForces {
                horizontal_a: 0.0,
                horizontal_b: 0.0,
                vertical_a: -hanging.0,
                vertical_b: hanging.1,
                friction: at.friction,
                steps: 1,
            };
        }
        let balance = |h: f64| {
            let (a, b) = (self.lift(h, at.height_a), self.lift(h, at.height_b));
            let (stretch, stretch_slope) = self.stretch(h, &a, &b, at.friction);
            let falling = a.excess + b.excess + longer.max(0.0);
            let rising = stretch + (-longer).max(0.0);
            let slope = stretch_slope / rising - (a.excess_slope + b.excess_slope) / falling;
            ((rising / falling).ln(), h * slope)
        };
        let knee = 0.1 * w * at.height_a.max(at.height_b);
        let lowest = HORIZONTAL_SHARE_MIN * w * l;
        let root = root::increasing_positive(balance, self.guess(at), (lowest, f64::INFINITY), |h| h < knee);
        let h = root.at;
        let (a, b) = (self.lift(h, at.height_a), self.lift(h, at.height_b));
        let laid = (l - (a.vertical + b.vertical) / w).max(0.0);
        debug_assert!(ea > 0.0 && h.is_finite(), "touchdown found no horizontal tension");
        EndForces {
            horizontal_a: (h - at.friction * w * laid).max(0.0),
            horizontal_b: h,
            vertical_a: -a.vertical,
            vertical_b: b.vertical,
            friction: at.friction,
            steps: root.steps,
        }
    }

    /// ∫ H ds/EA over the whole line for H at B [m], and its derivative with respect to H.
    fn stretch(&self, h: f64, a: &Lift, b: &Lift, friction: f64) -> (f64, f64) {
        let (l, w, ea) = (self.length, self.weight, self.axial_stiffness);
        if friction == 0.0 {
            return (h * l / ea, l / ea);
        }
        let flown = (b.vertical / w).min(l);
        let flown_slope = if flown < l { b.vertical_slope / w } else { 0.0 };
        let laid = l - flown;
        let fall = friction * w; // tension lost per metre
        let (area, area_slope) = if fall * laid < h {
            (
                h * laid - 0.5 * fall * laid * laid,
                laid - (h - fall * laid) * flown_slope,
            )
        } else {
            (0.5 * h * h / fall, h / fall)
        };
        debug_assert!(a.vertical == 0.0, "with friction A lies on the seabed");
        (
            (h * flown + area) / ea,
            (flown + h * flown_slope + area_slope) / ea,
        )
    }

    /// First guess of H from the leading terms: parabola E = (2D)^1.5 √w/(6√H) against slack or stretch.
    fn guess(&self, at: &Touchdown) -> f64 {
        let (l, w, ea) = (self.length, self.weight, self.axial_stiffness);
        let heights = at.height_a.max(0.0).powf(1.5) + at.height_b.max(0.0).powf(1.5);
        let bow = 8.0_f64.sqrt() * heights * w.sqrt() / 6.0; // E = bow/√H
        let elastic = (bow * ea / l).powf(2.0 / 3.0);
        let longer = at.span - l;
        let guess = if longer > 0.0 {
            elastic.max(ea * longer / l)
        } else {
            elastic.min((bow / longer).powi(2))
        };
        guess
            .max(1e-3 * w * at.height_a.max(at.height_b))
            .max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::{Touchdown, Uniform};
    use crate::math::tests::central;

    const LINE: Uniform = Uniform {
        length: 100.0,
        weight: 50.0,
        axial_stiffness: 2e4,
    };

    #[test]
    fn a_lift_meets_the_equation_it_was_solved_from() {
        for h in [1e-6, 3.0, 700.0, 1e6] {
            let lift = LINE.lift(h, 12.0);
            let tension = h.hypot(lift.vertical);
            let rise = lift.vertical * lift.vertical / (tension + h) + lift.vertical * lift.vertical / 4e4;
            assert!((rise - 600.0).abs() < 1e-10, "{h}: {rise}");
        }
    }

    #[test]
    fn the_slopes_of_a_lift_and_of_the_stretch_are_their_central_differences() {
        for h in [3.0, 700.0, 2e4, 1e6] {
            let close = |slope: f64, found: f64| (slope / found - 1.0).abs() < 1e-5;
            let (step, here, ground) = (1e-5 * h, LINE.lift(h, 12.0), LINE.lift(h, 0.0));
            let lift = |by: f64| LINE.lift(h + by, 12.0);
            assert!(
                close(here.vertical_slope, central(step, |by| lift(by).vertical)),
                "{h}"
            );
            assert!(
                close(here.excess_slope, central(step, |by| lift(by).excess)),
                "{h}"
            );
            for friction in [0.0, 0.4, 9.0] {
                let stretch = |by: f64| LINE.stretch(h + by, &ground, &lift(by), friction);
                assert!(
                    close(stretch(0.0).1, central(step, |by| stretch(by).0)),
                    "{h} {friction}"
                );
            }
        }
    }

    #[test]
    fn a_line_pulled_straight_along_the_seabed_stretches_as_a_bar() {
        let at = Touchdown {
            span: 101.0,
            height_a: 0.0,
            height_b: 0.0,
            friction: 0.0,
        };
        let held = LINE.touch_down(&at);
        assert!((held.horizontal_b - 200.0).abs() < 1e-10);
        let slack = LINE.touch_down(&Touchdown { span: 99.0, ..at });
        assert_eq!(slack.horizontal_b, 0.0);
    }
}
