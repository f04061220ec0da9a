//! Prediction of a motion from noisy displacements.
//!
//! A cubic is fitted to all previous samples x_k by least squares. The weight of a sample decreases by the factor θ with each later one: this is the
//! fading-memory polynomial filter. With z = (x, hẋ, h²ẍ/2, h³x⃛/6) predicted for the next sample, one step h after the last, and its residual r,
//!
//! z ← z + g r,   g = (1 − θ⁴, ⅙(1−θ)²(11 + 14θ + 11θ²), (1−θ)³(1+θ), ⅙(1−θ)⁴).
//!
//! θ = 0 is the cubic through the last four samples, the highest degree of `Smooth`, with an error of O(h⁴); a θ near 1 averages over about
//! 4/(1 − θ) samples. White noise of variance σ² causes residuals of variance σ² (1 + a(θ)), where a decreases with θ; the motion causes residuals
//! that increase with h⁴x⁗/(1−θ)⁴. Filters with several θ run in parallel. For each axis, the filter with the smallest mean square residual gives
//! the prediction. On smooth motion this is θ = 0, by orders of magnitude; on noisy motion the scatter of the samples decides. The path leads from
//! its end to the prediction, and does not return to the noisy sample. With θ = 0, the residual is the fourth difference of the samples, and the
//! velocity is that of the polynomial through five of them, as in `Smooth`.
//!
//! Source: Morrison (1969), Introduction to Sequential Smoothing and Prediction, chapter 13 (the filter); the choice of θ is derived here.
//! Valid for steps of about equal length: z is scaled to a different step, but the gains are those of equal steps. After a far shorter
//! step, the derivatives would change by the scatter of the samples divided by that step: a sample less than half a step after the last one is not used.

use std::array::from_fn;

use serde::{Deserialize, Serialize};

use super::extrapolation::{ROUNDING, evenness};
use crate::math::lanes::{LANES, Lanes};

/// Memory factors θ of the filters [-].
const MEMORIES: [f64; 8] = [0.0, 0.2, 0.4, 0.55, 0.7, 0.8, 0.87, 0.92];
/// Fraction of the mean square residual that is kept from sample to sample [-].
const KEPT: f64 = 0.9;

/// Minimum time between two samples in use, relative to the time between the two before [-].
const APART_MIN: f64 = 0.5;

/// Coefficient of the fourth difference in the velocity at the newest sample, times the step [-].
const NOW: f64 = 0.25;
/// The same one step later [-]: 1 + ½ + ⅓ + ¼.
const NEXT: f64 = 25.0 / 12.0;

/// Scaled derivatives of one filter along four axes [m, rad].
type Cubic = [Lanes; 4];

/// Filters of four axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Fading {
    /// Time of the last sample in use [s].
    time: f64,
    /// Step to which the cubics are scaled [s].
    step: f64,
    cubics: [Cubic; MEMORIES.len()],
    /// Mean squares of the residuals [m², rad²].
    residuals: [Lanes; MEMORIES.len()],
}

impl Fading {
    /// Filters at rest at a position [m, rad] from a time [s] on.
    pub fn at_rest(time: f64, position: Lanes) -> Fading {
        let zero = Lanes::splat(0.0);
        Fading {
            time,
            step: 0.0,
            cubics: [[position, zero, zero, zero]; MEMORIES.len()],
            residuals: [zero; MEMORIES.len()],
        }
    }

    /// Adds a sample [m, rad] at a time [s]; returns the filtered positions [m, rad] and velocities [m/s, rad/s] at that time, and those predicted one step
    /// [s] later. A sample that is not later than the last one restarts the filters at rest.
    pub fn predict(&mut self, time: f64, sample: Lanes, step: f64) -> [[Lanes; 2]; 2] {
        let passed = time - self.time;
        if passed <= 0.0 {
            *self = Fading::at_rest(time, sample);
            return [[sample, Lanes::splat(0.0)]; 2];
        }
        let missed = match passed < APART_MIN * (1.0 - ROUNDING) * self.step {
            true => Lanes::splat(0.0),
            false => self.add(time, sample, step),
        };
        let best: [usize; LANES] = from_fn(|axis| {
            let squares = self.residuals.map(|square| square[axis]);
            (1..squares.len()).fold(0, |best, i| if squares[i] < squares[best] { i } else { best })
        });
        [(0.0, NOW), (step, NEXT)].map(|(later, part)| {
            let steps = Lanes::splat((time - self.time + later) / self.step);
            let [mut position, mut change] = at(self.cubics[0], steps);
            change = change + Lanes::splat(part) * missed;
            for axis in (0..LANES).filter(|&axis| best[axis] > 0) {
                let of_best = at(self.cubics[best[axis]], steps);
                (position[axis], change[axis]) = (of_best[0][axis], of_best[1][axis]);
            }
            [position, Lanes::splat(1.0 / self.step) * change]
        })
    }

    /// Adds a sample [m, rad] at a time [s] to the cubics; returns the fourth difference of the samples [m, rad], faded out as the steps and the coming
    /// `step` [s] become uneven.
    fn add(&mut self, time: f64, sample: Lanes, step: f64) -> Lanes {
        let passed = time - self.time;
        let last = if self.step > 0.0 { self.step } else { passed };
        let mut missed = Lanes::splat(0.0);
        let filters = MEMORIES.iter().zip(&mut self.cubics).zip(&mut self.residuals);
        for ((&memory, cubic), square) in filters {
            let mut there = shifted(scaled(*cubic, passed / last));
            let residual = sample - there[0];
            if memory == 0.0 {
                missed = residual;
            }
            for (part, gain) in there.iter_mut().zip(gains(memory)) {
                *part = *part + Lanes::splat(gain) * residual;
            }
            *square = Lanes::splat(KEPT) * *square + Lanes::splat(1.0 - KEPT) * residual * residual;
            *cubic = there;
        }
        (self.time, self.step) = (time, passed);
        Lanes::splat(evenness(&[step, passed, last])) * missed
    }
}

/// Gains of the filter with a memory factor [-].
fn gains(memory: f64) -> [f64; 4] {
    let rest = 1.0 - memory;
    [
        1.0 - memory.powi(4),
        rest.powi(2) * (11.0 + 14.0 * memory + 11.0 * memory * memory) / 6.0,
        rest.powi(3) * (1.0 + memory),
        rest.powi(4) / 6.0,
    ]
}

/// Rescales a cubic to a step that is longer by a factor [-].
fn scaled([x, v, a, j]: Cubic, by: f64) -> Cubic {
    let by = Lanes::splat(by);
    [x, by * v, by * by * a, by * by * by * j]
}

/// Position [m, rad], and velocity times the step to which a cubic is scaled [m, rad], after a number of such steps.
fn at([x, v, a, j]: Cubic, steps: Lanes) -> [Lanes; 2] {
    let (two, three) = (Lanes::splat(2.0), Lanes::splat(3.0));
    [
        x + steps * (v + steps * (a + steps * j)),
        v + steps * (two * a + three * steps * j),
    ]
}

/// Shifts a cubic by one step.
fn shifted([x, v, a, j]: Cubic) -> Cubic {
    let (two, three) = (Lanes::splat(2.0), Lanes::splat(3.0));
    [x + v + a + j, v + two * a + three * j, a + three * j, j]
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.05;

    /// RMS errors of predicted position [m] and velocity [m/s], for a sine of amplitude 2 m and period 10 s with noise of RMS `noise` [m], sampled every
    /// `step` [s].
    fn errors(noise: f64, step: f64) -> [f64; 2] {
        let rate = std::f64::consts::TAU / 10.0;
        let mut fading = Fading::at_rest(-step, Lanes::splat(0.0));
        let (mut seed, mut sums, mut count) = (1_u64, [0.0; 2], 0.0);
        for k in 0..(100.0 / step) as usize {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let scatter = (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
            let time = k as f64 * step;
            let sample = 2.0 * (rate * time).sin() + noise * 12.0_f64.sqrt() * scatter;
            let [_, [position, velocity]] = fading.predict(time, Lanes::splat(sample), step);
            if time > 20.0 {
                let (sin, cos) = (rate * (time + step)).sin_cos();
                sums[0] += (position[0] - 2.0 * sin).powi(2);
                sums[1] += (velocity[0] - 2.0 * rate * cos).powi(2);
                count += 1.0;
            }
        }
        sums.map(|sum: f64| (sum / count).sqrt())
    }

    #[test]
    fn smooth_motion_keeps_the_fourth_order_of_the_cubic_through_the_samples() {
        let found = [0.2, 0.1, 0.05].map(|step| errors(0.0, step)[0]);
        for pair in found.windows(2) {
            assert!(((pair[0] / pair[1]).log2() - 4.0).abs() < 0.1, "{found:?}");
        }
    }

    #[test]
    fn the_velocity_of_smooth_motion_has_the_fourth_order_of_five_samples() {
        let found = [0.1, 0.05, 0.025].map(|step| errors(0.0, step)[1]);
        for pair in found.windows(2) {
            assert!(((pair[0] / pair[1]).log2() - 4.0).abs() < 0.1, "{found:?}");
        }
    }

    #[test]
    fn a_far_shorter_step_leaves_the_prediction_as_accurate_as_before() {
        let place = |time: f64| 2.0 * (std::f64::consts::TAU / 10.0 * time).sin();
        for short in [1e-5, 1e-3, 0.02] {
            let (mut fading, mut time, mut worst) = (Fading::at_rest(-STEP, Lanes::splat(0.0)), 0.0, 0.0_f64);
            for k in 0..400 {
                let step = if k % 20 == 19 { short } else { STEP };
                let [_, [position, _]] = fading.predict(time, Lanes::splat(place(time)), step);
                time += step;
                if time > 10.0 {
                    worst = worst.max((position[0] - place(time)).abs());
                }
            }
            assert!(worst < 0.01, "{short} s: {worst} m");
        }
    }

    #[test]
    fn noise_of_samples_is_not_amplified_by_the_extrapolation() {
        let [position, velocity] = errors(1e-4, STEP);
        // a cubic through four samples amplifies the noise 8.3 times, and 12/step times in its velocity
        assert!(
            position < 2.5e-4 && velocity < 2.0 * 1e-4 / STEP,
            "{position} {velocity}"
        );
    }
}
