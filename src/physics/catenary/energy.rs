//! Energy of a line on its elastic catenary: strain energy, and potential energy of its weight above end A.
//!
//! For a flight of length h that starts at a height z₀ with the vertical tension V₀, V₁ = V₀ + wh, and the horizontal tension H,
//!
//!   ∫ T²/2EA ds = h (H² + (V₀² + V₀V₁ + V₁²)/3) / 2EA,
//!   w ∫ z ds    = w z₀ h + (∫ T ds − T₀ h) + w h² (2V₀ + V₁)/6EA,
//!
//! since w dz = dT + V dV/EA along it: no term is divided by the weight, which may be zero. On the seabed T = T₀ + g s at constant height.
//!
//! Source: integrals of the elastic catenary, derived here, checked by sums and by the work of the end forces. Valid where the catenary is.

use std::iter::Sum;

use super::flight::Flight;
use super::shape::{Kind, Piece};

/// Energy of a line on its catenary.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CatenaryEnergy {
    /// Strain energy, ∫ T²/2EA ds [J].
    pub axial: f64,
    /// Potential energy of the weight, ∫ w z ds with z from end A up [J].
    pub gravitational: f64,
}

impl Sum for CatenaryEnergy {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        parts.fold(Self::default(), |sum, part| CatenaryEnergy {
            axial: sum.axial + part.axial,
            gravitational: sum.gravitational + part.gravitational,
        })
    }
}

impl Piece {
    pub(super) fn energy(&self) -> CatenaryEnergy {
        match self.kind {
            Kind::Flight(flight) => flight.energy(self.z),
            Kind::Laid {
                tension,
                growth,
                weight,
                axial_stiffness,
            } => {
                let end = tension + growth * self.length;
                let squares = self.length * mean_square(tension, end);
                CatenaryEnergy {
                    axial: squares / (2.0 * axial_stiffness),
                    gravitational: weight * self.length * self.z,
                }
            }
            Kind::Slack { z, weight, .. } => CatenaryEnergy {
                axial: 0.0,
                gravitational: weight * self.length * (self.z + 0.5 * z * self.length),
            },
        }
    }
}

impl Flight {
    /// Energy of this flight, which starts at a height [m] above end A.
    fn energy(&self, start: f64) -> CatenaryEnergy {
        let (h, ea, w) = (self.length, self.axial_stiffness, self.weight);
        let (v0, v1) = (self.vertical, self.vertical_end());
        let squares = h * (self.horizontal * self.horizontal + mean_square(v0, v1));
        let bow = ea * self.elongation() - h * self.horizontal.hypot(v0); // ∫ T ds − T₀ h
        CatenaryEnergy {
            axial: squares / (2.0 * ea),
            gravitational: w * h * start + bow + w * h * h * (2.0 * v0 + v1) / (6.0 * ea),
        }
    }
}

/// Mean square of a quantity that grows linearly from one value to another.
fn mean_square(from: f64, to: f64) -> f64 {
    (from * from + from * to + to * to) / 3.0
}

#[cfg(test)]
mod tests {
    use super::super::{FlatSeabed, Section, solve};
    use super::*;
    use approx::assert_relative_eq;

    const CHAIN: Section = Section {
        length: 30.0,
        weight: 4.0,
        axial_stiffness: 900.0,
    };
    const WEIGHTLESS: Section = Section {
        length: 8.0,
        weight: 0.0,
        axial_stiffness: 300.0,
    };
    const BUOYANT: Section = Section {
        length: 12.0,
        weight: -3.0,
        axial_stiffness: 700.0,
    };

    #[test]
    fn a_flight_holds_the_sum_over_its_shape() {
        for weight in [3.0, -2.0, 0.0] {
            let flight = Flight {
                length: 8.0,
                weight,
                axial_stiffness: 400.0,
                horizontal: 5.0,
                vertical: -7.0,
            };
            let count = 200_000;
            let step = flight.length / f64::from(count);
            let (mut height, mut stretch, mut weighed) = (1.5, 0.0, 0.0);
            for i in 0..count {
                let v = flight.vertical + weight * step * (f64::from(i) + 0.5);
                let tension = flight.horizontal.hypot(v);
                let rise = step * (1.0 + tension / flight.axial_stiffness) * v / tension;
                stretch += step * tension * tension / (2.0 * flight.axial_stiffness);
                weighed += step * weight * (height + 0.5 * rise);
                height += rise;
            }
            let energy = flight.energy(1.5);
            assert_relative_eq!(energy.axial, stretch, max_relative = 1e-8);
            assert_relative_eq!(energy.gravitational, weighed, epsilon = 1e-9, max_relative = 1e-8);
        }
    }

    #[test]
    fn the_work_of_an_end_is_what_the_line_gains() {
        let seabed = FlatSeabed {
            height: -10.0,
            friction: 0.0,
        };
        let lines: [(&[Section], Option<FlatSeabed>); 4] = [
            (&[CHAIN], None),
            (&[CHAIN], Some(seabed)),
            (&[CHAIN, BUOYANT, WEIGHTLESS, CHAIN], Some(seabed)),
            (&[WEIGHTLESS, BUOYANT], None),
        ];
        for (sections, seabed) in lines {
            let length: f64 = sections.iter().map(|section| section.length).sum();
            for (span, rise) in [(0.8, 0.1), (0.6, 0.5), (0.95, 0.4), (0.4, -0.1)] {
                let (span, rise, step) = (span * length, rise * length, 1e-4);
                let at = |part: f64| {
                    let place = (span + part * step, rise - 0.7 * part * step);
                    solve(sections, place.0, place.1, seabed).unwrap()
                };
                let [low, high] = [at(-1.0), at(1.0)].map(|line| {
                    let energy = line.energy();
                    energy.axial + energy.gravitational
                });
                let force = at(0.0);
                let work = 2.0 * step * (force.horizontal() - 0.7 * force.vertical_b());
                assert_relative_eq!(high - low, work, epsilon = 1e-7, max_relative = 1e-6);
            }
        }
    }
}
