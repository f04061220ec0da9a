//! Uniform part of a line in free flight, loaded between its ends by its own weight only.
//!
//! With H the horizontal tension, V₀ the vertical tension at the start, W = wℓ, Vₘ = V₀ + W/2, σ the mean of the two end
//! tensions and ε = W/2σ (derived in the module above, section "One stretch"):
//!
//! x = Hℓ (α/σ + 1/EA),   z = Vₘℓ (1/σ + 1/EA),   α = atanh(ε)/ε,   ∫T ds = ½ℓ (σ + (Vₘ² + αH²)/σ)
//!
//! No term subtracts nearly equal numbers; W = 0 and W < 0 need no separate case, and H = 0 is the vertical line.

use super::Section;

/// Value of ε below which λ is computed from tanh λ = ε; above, it is computed from sinh λ, whose formula does not contain 1 − ε.
const STEEP: f64 = 0.75;

/// Uniform part of a line in free flight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flight {
    /// Horizontal tension [N], at least 0.
    pub horizontal: f64,
    /// Vertical tension at the start [N].
    pub vertical: f64,
    /// Unstretched length [m].
    pub length: f64,
    /// Weight per unstretched length [N/m].
    pub weight: f64,
    /// Axial stiffness EA [N].
    pub axial_stiffness: f64,
}

/// Rise of a flight with its derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rise {
    /// z at the end relative to the start [m].
    pub z: f64,
    /// ∂z/∂V at fixed H [m/N].
    pub by_vertical: f64,
    /// ∂z/∂H at fixed V [m/N].
    pub by_horizontal: f64,
}

impl Flight {
    /// Flight of `length` metres of `section`.
    pub(super) fn of(section: &Section, length: f64, horizontal: f64, vertical: f64) -> Self {
        Flight {
            horizontal,
            vertical,
            length,
            weight: section.weight,
            axial_stiffness: section.axial_stiffness,
        }
    }

    /// Vertical tension at the end [N].
    pub(super) fn vertical_end(&self) -> f64 {
        self.vertical + self.weight * self.length
    }

    fn vertical_mean(&self) -> f64 {
        self.vertical + 0.5 * self.weight * self.length
    }

    fn tensions(&self) -> (f64, f64) {
        let tension = |v: f64| (self.horizontal * self.horizontal + v * v).sqrt();
        (tension(self.vertical), tension(self.vertical_end()))
    }

    /// α = λ/ε: ratio of the geometric span to Hℓ/σ.
    fn alpha(&self, tension_a: f64, tension_b: f64, sigma: f64) -> f64 {
        let epsilon = (0.5 * self.weight * self.length / sigma).abs();
        if epsilon < 1e-4 {
            return 1.0 + epsilon * epsilon * (1.0 / 3.0 + epsilon * epsilon / 5.0);
        }
        if epsilon < STEEP {
            return epsilon.atanh() / epsilon;
        }
        let (h, va, vb) = (self.horizontal, self.vertical, self.vertical_end());
        let (tensions, verticals) = (tension_a * tension_b, va * vb);
        // sinh²λ = ε²(σ² − Vₘ²)/H², and 2(σ² − Vₘ²) = H² + T_a T_b − V_a V_b
        let sinh = if verticals > 0.0 {
            epsilon * (0.5 + 0.5 * (h * h + va * va + vb * vb) / (tensions + verticals)).sqrt()
        } else {
            epsilon * (0.5 * (h * h + tensions - verticals)).sqrt() / h
        };
        sinh.asinh() / epsilon
    }

    /// Position of the end relative to the start, x and z [m].
    pub(super) fn advance(&self) -> (f64, f64) {
        let (ta, tb) = self.tensions();
        let sigma = 0.5 * (ta + tb);
        if sigma == 0.0 {
            return (0.0, 0.0);
        }
        let flexibility = 1.0 / self.axial_stiffness;
        let x = match self.horizontal {
            0.0 => 0.0,
            h => h * self.length * (self.alpha(ta, tb, sigma) / sigma + flexibility),
        };
        (
            x,
            self.vertical_mean() * self.length * (1.0 / sigma + flexibility),
        )
    }

    /// Rise of the end above the start, with its derivatives with respect to V and H.
    pub(super) fn rise(&self) -> Rise {
        let (ta, tb) = self.tensions();
        let sigma = 0.5 * (ta + tb);
        let flexibility = 1.0 / self.axial_stiffness;
        if sigma == 0.0 {
            return Rise {
                z: 0.0,
                by_vertical: self.length * flexibility,
                by_horizontal: 0.0,
            };
        }
        let v = self.vertical_mean();
        let ratio = |force: f64, tension: f64| if tension > 0.0 { force / tension } else { 0.0 };
        let sigma_v = 0.5 * (ratio(self.vertical, ta) + ratio(self.vertical_end(), tb));
        let sigma_h = 0.5 * (ratio(self.horizontal, ta) + ratio(self.horizontal, tb));
        Rise {
            z: v * self.length * (1.0 / sigma + flexibility),
            by_vertical: self.length * ((1.0 - v / sigma * sigma_v) / sigma + flexibility),
            by_horizontal: -v / sigma * sigma_h * self.length / sigma,
        }
    }

    /// Elongation ∫T/EA ds [m].
    pub(super) fn elongation(&self) -> f64 {
        let (ta, tb) = self.tensions();
        let sigma = 0.5 * (ta + tb);
        if sigma == 0.0 {
            return 0.0;
        }
        let (h, v) = (self.horizontal, self.vertical_mean());
        let bow = if h > 0.0 {
            self.alpha(ta, tb, sigma) * h * h
        } else {
            0.0
        };
        0.5 * self.length * (sigma + (v * v + bow) / sigma) / self.axial_stiffness
    }

    /// Unstretched distance from the start at which the vertical tension is `vertical` [m]; `None` if it is not within this flight.
    pub(super) fn where_vertical_is(&self, vertical: f64) -> Option<f64> {
        let at = (vertical - self.vertical) / self.weight;
        (at.is_finite() && at > 0.0 && at < self.length).then_some(at)
    }

    /// The first `length` metres of this flight.
    pub(super) fn first(&self, length: f64) -> Self {
        Flight { length, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::Flight;
    use crate::math::tests::central;

    fn flight([horizontal, vertical]: [f64; 2], [length, weight, axial_stiffness]: [f64; 3]) -> Flight {
        Flight {
            horizontal,
            vertical,
            length,
            weight,
            axial_stiffness,
        }
    }

    fn textbook(flight: &Flight) -> (f64, f64) {
        let (h, va, length) = (flight.horizontal, flight.vertical, flight.length);
        let (w, ea) = (flight.weight, flight.axial_stiffness);
        let vb = va + w * length;
        let x = h / w * ((vb / h).asinh() - (va / h).asinh()) + h * length / ea;
        let z = (h.hypot(vb) - h.hypot(va)) / w + length * (va + 0.5 * w * length) / ea;
        (x, z)
    }

    #[test]
    fn a_flight_advances_as_the_textbook_formula_says_where_that_one_is_accurate() {
        for h in [0.03, 1.0, 40.0] {
            for v in [-9.0, -5.0, -0.1, 0.0, 2.0, 11.0] {
                for weight in [-2.0, 0.9, 3.0] {
                    let flight = flight([h, v], [3.0, weight, 200.0]);
                    let ((x, z), (x_book, z_book)) = (flight.advance(), textbook(&flight));
                    let most = (x - x_book).abs().max((z - z_book).abs());
                    assert!(most < 1e-13, "{flight:?}");
                }
            }
        }
    }

    #[test]
    fn a_flight_cut_in_two_ends_at_the_same_place_and_is_as_long() {
        for h in [1e-9, 0.2, 1e6] {
            let whole = flight([h, -4.0], [7.0, 1.5, 90.0]);
            let first = whole.first(2.9);
            let second = Flight {
                vertical: first.vertical_end(),
                length: 7.0 - 2.9,
                ..whole
            };
            let ((x, z), (x1, z1), (x2, z2)) = (whole.advance(), first.advance(), second.advance());
            let scale = 1.0 + x.abs();
            assert!((x - x1 - x2).abs() < 4e-15 * scale && (z - z1 - z2).abs() < 4e-15 * scale);
            let parts = first.elongation() + second.elongation();
            assert!((whole.elongation() - parts).abs() < 1e-14 * parts);
        }
    }

    #[test]
    fn the_slopes_of_the_rise_are_its_central_differences() {
        let rise = |dh: f64, dv: f64| flight([2.0 + dh, -3.0 + dv], [5.0, 1.1, 60.0]).rise();
        let slope = rise(0.0, 0.0);
        assert!((central(1e-5, |by| rise(0.0, by).z) - slope.by_vertical).abs() < 1e-8);
        assert!((central(1e-5, |by| rise(by, 0.0).z) - slope.by_horizontal).abs() < 1e-8);
    }
}
