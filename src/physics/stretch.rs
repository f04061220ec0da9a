//! Axial force of a stretched cable, for three strain measures or from a table.
//!
//! With the stretch λ = l/L and the strain ε = λ − 1, the force N = ∂W/∂l per unstretched cross-section is
//!
//! * engineering: N = EA·ε
//! * Green-Lagrange: N = EA·λ·(λ² − 1)/2 (second Piola-Kirchhoff stress proportional to the Green strain)
//! * logarithmic: N = EA·ln λ·λ^(−2ν) (Cauchy stress proportional to ln λ, on the contracted area A·λ^(−2ν))
//! * tabulated: N given at some strains ε, see [`super::tension_table`]; EA is then its steepest slope
//!
//! Source: derived here from W(λ) per unstretched length, N = dW/dλ; the Green and logarithmic forms are those of
//! Crisfield (1991), Non-linear Finite Element Analysis of Solids and Structures, vol. 1, section 3.1-3.2.
//! Valid for λ > 0. The logarithmic measure with ν > 0 softens and has a limit load.
//!
//! A cable does not push, unless it has bending stiffness: the total tension is clipped, see [`total_tension`].

use super::tension_table::TensionTable;
use crate::math::real::Real;

/// Strain measure with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum StretchLaw {
    /// ε = λ − 1.
    Engineering,
    /// ε = (λ² − 1)/2.
    Green,
    /// ε = ln λ on the area A·λ^(−2ν).
    Logarithmic {
        /// Poisson's ratio ν [-].
        poisson: f64,
    },
    /// Tension tabulated over ε = λ − 1.
    Tabulated(TensionTable),
}

/// Value, slope and energy of N(ε)/EA.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// N/EA [-].
    pub force: f64,
    /// d(N/EA)/dε [-].
    pub slope: f64,
    /// W/EA, energy per unstretched length over EA [-].
    pub energy: f64,
}

impl StretchLaw {
    /// Evaluates the law at the strain ε = λ − 1 [-].
    #[inline(always)]
    pub fn at(&self, strain: f64) -> Stretch {
        let stretch = 1.0 + strain; // λ
        match *self {
            StretchLaw::Engineering => Stretch {
                force: strain,
                slope: 1.0,
                energy: 0.5 * strain * strain,
            },
            StretchLaw::Green => {
                let green = strain * (1.0 + 0.5 * strain); // (λ² − 1)/2
                Stretch {
                    force: stretch * green,
                    slope: 1.0 + 3.0 * green,
                    energy: 0.5 * green * green,
                }
            }
            StretchLaw::Logarithmic { poisson } => {
                let log = strain.ln_1p();
                let area = (-2.0 * poisson * log).exp(); // A/A₀
                Stretch {
                    force: log * area,
                    slope: area / stretch * (1.0 - 2.0 * poisson * log),
                    energy: logarithmic_energy(log, 1.0 - 2.0 * poisson),
                }
            }
            StretchLaw::Tabulated(ref table) => table.at(strain),
        }
    }

    /// Returns whether the slope may exceed 1, so that a segment is stiffer than its EA.
    pub fn may_stiffen(&self) -> bool {
        matches!(self, StretchLaw::Green | StretchLaw::Logarithmic { .. })
    }

    /// Strain [-] at which the force is largest, if there is one: N' = 0 at ln λ = 1/(2ν).
    pub fn limit_strain(&self) -> Option<f64> {
        match *self {
            StretchLaw::Logarithmic { poisson } if poisson > 0.0 => Some((0.5 / poisson).exp_m1()),
            _ => None,
        }
    }
}

/// ∫ ln x · x^(a−1) dx from 1 to λ, with `log` = ln λ.
fn logarithmic_energy(log: f64, a: f64) -> f64 {
    let y = a * log;
    if y.abs() < 1e-3 {
        // series of (y·eʸ − eʸ + 1)/y², free of cancellation
        return log * log * (0.5 + y / 3.0 + y * y / 8.0 + y * y * y / 30.0);
    }
    (y * y.exp() - y.exp_m1()) / (a * a)
}

/// Tension [N] of a segment from its elastic force and its damping force.
///
/// By default the total is never negative, max(0, N + C): with damping acting in compression a slack cable is ill-posed. MoorDyn's law, max(0, N) +
/// C, is kept for comparison. `least` is minus the compression that bending stiffness lets the segment carry, 0 without bending stiffness.
#[inline(always)]
pub fn total_tension<R: Real>(elastic: R, damping: R, least: R, negative_tension: bool) -> R {
    if negative_tension {
        elastic.max(least) + damping
    } else {
        (elastic + damping).max(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::central;
    use approx::assert_relative_eq;

    const LAWS: [StretchLaw; 5] = [
        StretchLaw::Engineering,
        StretchLaw::Green,
        StretchLaw::Logarithmic { poisson: 0.0 },
        StretchLaw::Logarithmic { poisson: 0.3 },
        StretchLaw::Logarithmic { poisson: 0.5 },
    ];

    #[test]
    fn force_is_the_slope_of_the_energy_and_slope_that_of_the_force() {
        for law in LAWS {
            for strain in [-0.2, -1e-3, 1e-4, 0.01, 0.3, 2.0] {
                let h = 1e-5 * (1.0 + f64::abs(strain));
                let (at, by) = (law.at(strain), |h| law.at(strain + h));
                let (force, slope) = (central(h, |h| by(h).energy), central(h, |h| by(h).force));
                assert_relative_eq!(force, at.force, max_relative = 1e-7, epsilon = 1e-9);
                assert_relative_eq!(slope, at.slope, max_relative = 1e-7, epsilon = 1e-9);
            }
        }
    }

    #[test]
    fn all_measures_agree_for_small_strain() {
        for law in LAWS {
            assert_relative_eq!(law.at(1e-9).force, 1e-9, max_relative = 1e-8);
            assert_eq!(law.at(0.0).force, 0.0);
        }
    }

    #[test]
    fn the_logarithmic_force_is_greatest_at_its_limit_strain() {
        let law = StretchLaw::Logarithmic { poisson: 0.5 };
        let limit = law.limit_strain().unwrap();
        assert_relative_eq!(law.at(limit).slope, 0.0, epsilon = 1e-15);
    }

    #[test]
    fn a_slack_rope_carries_no_tension_however_fast_it_shortens() {
        assert_eq!(total_tension(-5.0, -3.0, 0.0, false), 0.0);
        assert_eq!(total_tension(5.0, -30.0, 0.0, false), 0.0);
        assert_eq!(total_tension(-5.0, -3.0, 0.0, true), -3.0);
    }
}
