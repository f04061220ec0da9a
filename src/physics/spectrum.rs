//! Random seas from a spectrum: JONSWAP and Pierson-Moskowitz, with all waves in one direction or spread.
//!
//!   S(ω) ∝ ω⁻⁵ exp(−5/4 (ω/ω_p)⁻⁴) γ^exp(−½((ω − ω_p)/(σω_p))²),   σ = 0.07 up to ω_p, 0.09 above,   ∫S dω = m₀ = H_s²/16
//!
//! with γ = 1 for Pierson-Moskowitz. The leading factor is found by integration from ½ω_p to 5ω_p, which leaves out 0.2 % of the energy with γ = 1.
//! An approximation of it, 5/16 H_s² ω_p⁴ (1 − 0.287 ln γ), is accurate to 2 % for 1 ≤ γ ≤ 7.
//!
//! N components of equal amplitude √(2m₀/N) represent the spectrum: the range is cut into N bands of equal energy. The frequency of each is drawn
//! within its band in proportion to the energy there, so that no record repeats itself. Phases are drawn uniformly from a whole turn. Directions are
//! drawn from D(θ) ∝ cos²ˢ(½(θ − θ₀)), component by component. The same seed gives the same sea, except for rounding on another machine.
//!
//! Source: Hasselmann et al. (1973), Deutsche Hydrographische Zeitschrift A8(12); Pierson & Moskowitz (1964), J. Geophys. Res. 69, 5181-5190;
//! DNV-RP-C205 (2010), Environmental Conditions and Environmental Loads, sections 3.5.5 and 3.5.8; spreading after Longuet-Higgins, Cartwright &
//! Smith (1963), Ocean Wave Spectra, 111-136. Valid for a single wind sea or swell with one peak in deep water.

use std::f64::consts::{PI, TAU};

use super::airy::Component;
use crate::math::random::Random;

/// Lowest and highest frequency, relative to the peak frequency [-].
const RANGE: [f64; 2] = [0.5, 5.0];
/// Number of intervals in the integration of a distribution [-].
const PIECES: usize = 9000;

/// Sea with one spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Significant height H_s [m].
    pub significant_height: f64,
    /// Peak period 2π/ω_p [s].
    pub peak_period: f64,
    /// Peakedness γ [-].
    pub peakedness: f64,
    /// Mean direction of travel θ₀ [rad].
    pub direction: f64,
    /// Exponent s of the spreading [-]; if absent, all waves have the same direction.
    pub spreading: Option<f64>,
}

impl Spectrum {
    /// Draws `count` components with a seed [-].
    pub fn draw(&self, count: usize, seed: u64) -> Vec<Component> {
        let peak = TAU / self.peak_period;
        let energies = Distribution::new(RANGE, |x| self.shape(x));
        let directions = self
            .spreading
            .map(|s| Distribution::new([-PI, PI], |theta| (0.5 * theta).cos().abs().powf(2.0 * s)));
        let variance = self.significant_height * self.significant_height / 16.0;
        let amplitude = (2.0 * variance / count as f64).sqrt();
        let mut random = Random::new(seed);
        let component = |band: usize| {
            let part = (band as f64 + random.unit()) / count as f64;
            let phase = TAU * random.unit();
            let aside = random.unit(); // drawn with and without spreading, so that both have the same phases
            Component {
                amplitude,
                frequency: peak * energies.quantile(part),
                direction: self.direction + directions.as_ref().map_or(0.0, |d| d.quantile(aside)),
                phase,
            }
        };
        (0..count).map(component).collect()
    }

    /// S at ω = x ω_p, without the leading factor [-].
    fn shape(&self, x: f64) -> f64 {
        let sigma = if x <= 1.0 { 0.07 } else { 0.09 };
        let near = (-0.5 * ((x - 1.0) / sigma).powi(2)).exp();
        x.powi(-5) * (-1.25 * x.powi(-4)).exp() * self.peakedness.powf(near)
    }
}

/// Distribution on an interval, integrated by Simpson's rule.
struct Distribution {
    start: f64,
    width: f64,
    /// Integral from the start to the end of each piece, from 0 to 1.
    sums: Vec<f64>,
}

impl Distribution {
    fn new([start, end]: [f64; 2], density: impl Fn(f64) -> f64) -> Distribution {
        let width = (end - start) / PIECES as f64;
        let at = |halves: usize| density(start + 0.5 * width * halves as f64);
        let mut sums = vec![0.0];
        for piece in 0..PIECES {
            let area = at(2 * piece) + 4.0 * at(2 * piece + 1) + at(2 * piece + 2);
            sums.push(sums[piece] + area);
        }
        let whole = sums[PIECES];
        sums.iter_mut().for_each(|sum| *sum /= whole);
        Distribution { start, width, sums }
    }

    /// Argument below which the fraction `part` of the distribution lies [-].
    fn quantile(&self, part: f64) -> f64 {
        let after = self.sums.partition_point(|sum| *sum <= part);
        let piece = after.clamp(1, PIECES) - 1;
        let [low, high] = [self.sums[piece], self.sums[piece + 1]];
        let within = if high > low {
            (part - low) / (high - low)
        } else {
            0.5
        };
        self.start + self.width * (piece as f64 + within.clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn storm(peakedness: f64) -> Spectrum {
        Spectrum {
            significant_height: 6.0,
            peak_period: 12.0,
            peakedness,
            direction: 0.4,
            spreading: None,
        }
    }

    #[test]
    fn the_variance_is_that_of_the_significant_height() {
        for (count, seed) in [(1, 0), (37, 5), (100, 7), (1000, 1)] {
            let sea = storm(3.3).draw(count, seed);
            let variance: f64 = sea.iter().map(|c| 0.5 * c.amplitude.powi(2)).sum();
            assert_relative_eq!(variance, 36.0 / 16.0, max_relative = 1e-12);
        }
    }

    #[test]
    fn most_energy_lies_at_the_peak_period() {
        for peakedness in [1.0, 3.3, 7.0] {
            let sea = storm(peakedness).draw(20_000, 3);
            let mut counts = [0; 90];
            for component in &sea {
                let x = component.frequency * 12.0 / TAU;
                counts[(20.0 * x) as usize % 90] += 1;
            }
            let most = (0..90).max_by_key(|&bin| counts[bin]).unwrap();
            assert!((19..=20).contains(&most), "γ = {peakedness}: bin {most}");
        }
    }

    #[test]
    fn moments_are_those_of_the_formula_in_the_recommended_practice() {
        // m₀/m₁ over 1/ω_p of JONSWAP with γ = 3.3: T₁ = 0.834 T_p; of Pierson-Moskowitz 0.772 T_p
        for (peakedness, ratio) in [(3.3, 0.834), (1.0, 0.772)] {
            let sea = storm(peakedness).draw(20_000, 3);
            let mean = sea.iter().map(|c| c.frequency).sum::<f64>() / 20_000.0;
            assert_relative_eq!(TAU / mean, ratio * 12.0, max_relative = 0.015);
        }
        let factor = |gamma: f64| {
            let (sum, ones) = [gamma, 1.0]
                .map(|peakedness| {
                    let spectrum = storm(peakedness);
                    (0..45_000)
                        .map(|i| spectrum.shape(0.5 + 1e-4 * f64::from(i)))
                        .sum::<f64>()
                })
                .into();
            ones / sum
        };
        for gamma in [1.0, 2.0, 3.3, 5.0, 7.0] {
            assert_relative_eq!(factor(gamma), 1.0 - 0.287 * f64::ln(gamma), max_relative = 0.02);
        }
    }

    #[test]
    fn a_seed_gives_one_sea_and_another_seed_another() {
        let (sea, same, other) = (
            storm(3.3).draw(50, 11),
            storm(3.3).draw(50, 11),
            storm(3.3).draw(50, 12),
        );
        assert_eq!(sea, same);
        assert!(sea.iter().zip(&other).all(|(a, b)| a.phase != b.phase));
        // values of this seed on every machine
        assert_relative_eq!(
            sea[0].phase,
            TAU * {
                let mut random = Random::new(11);
                random.unit();
                random.unit()
            }
        );
    }

    #[test]
    fn frequencies_share_no_period() {
        let sea = storm(3.3).draw(100, 2);
        let gaps: Vec<f64> = sea.windows(2).map(|c| c[1].frequency - c[0].frequency).collect();
        assert!(gaps.iter().all(|gap| *gap > 0.0));
        let mean = gaps.iter().sum::<f64>() / 99.0;
        assert!(
            gaps.iter()
                .filter(|gap| (*gap - mean).abs() < 1e-3 * mean)
                .count()
                < 5
        );
    }

    #[test]
    fn directions_spread_by_the_power_of_the_cosine() {
        for s in [1.0, 4.0, 15.0] {
            let spread = Spectrum {
                spreading: Some(s),
                ..storm(3.3)
            };
            let sea = spread.draw(40_000, 9);
            let mean = |f: fn(f64) -> f64| sea.iter().map(|c| f(c.direction - 0.4)).sum::<f64>() / 40_000.0;
            // the mean of cos θ under cos²ˢ ½θ is s/(s + 1)
            assert!((mean(f64::cos) - s / (s + 1.0)).abs() < 0.01, "s = {s}");
            assert!(mean(f64::sin).abs() < 0.01);
        }
        assert!(storm(3.3).draw(9, 1).iter().all(|c| c.direction == 0.4));
    }
}
