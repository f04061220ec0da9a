//! Zero-phase low-pass filter: second-order Butterworth, run forwards and backwards.
//!
//! H(s) = 1/(s² + √2 s + 1) by the bilinear transform with the cut-off pre-warped, K = tan(π f_c Δt):
//!
//!   b = K²/(1 + √2 K + K²) · [1, 2, 1],   a₁ = 2(K² − 1)/(1 + √2 K + K²),   a₂ = (1 − √2 K + K²)/(1 + √2 K + K²)
//!
//! Both passes together have zero phase, a gain of ½ at f_c and a fourth-order roll-off above it. Each pass starts from the steady state of its first
//! value.
//!
//! Source: Butterworth (1930), Experimental Wireless 7, 536-541; the transform as in Oppenheim & Schafer (2010), Discrete-Time Signal Processing, section
//! 7.2. Valid for f_c < 1/(2Δt); above, the signal is returned unchanged.

use std::f64::consts::{PI, SQRT_2};

/// Returns the signal, sampled every `interval` [s], with frequencies above `cut_off` [Hz] attenuated.
pub fn low_pass(signal: &[f64], interval: f64, cut_off: f64) -> Vec<f64> {
    if cut_off * interval >= 0.5 {
        return signal.to_vec();
    }
    let mut filtered = signal.to_vec();
    pass(&mut filtered, interval, cut_off);
    filtered.reverse();
    pass(&mut filtered, interval, cut_off);
    filtered.reverse();
    filtered
}

fn pass(signal: &mut [f64], interval: f64, cut_off: f64) {
    let Some(&start) = signal.first() else { return };
    let k = (PI * cut_off * interval).tan();
    let scale = 1.0 / (1.0 + SQRT_2 * k + k * k);
    let b = k * k * scale;
    let a1 = 2.0 * (k * k - 1.0) * scale;
    let a2 = (1.0 - SQRT_2 * k + k * k) * scale;
    let (mut inputs, mut outputs) = ([start; 2], [start; 2]);
    for value in signal {
        let input = *value;
        *value = b * (input + 2.0 * inputs[0] + inputs[1]) - a1 * outputs[0] - a2 * outputs[1];
        inputs = [input, inputs[0]];
        outputs = [*value, outputs[0]];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const INTERVAL: f64 = 0.01;

    /// Gain of the filter, with a cut-off of 1 Hz, for a sine of this frequency [Hz].
    fn gain(frequency: f64) -> f64 {
        let sine = |i: usize| (2.0 * PI * frequency * INTERVAL * i as f64).sin();
        let signal: Vec<f64> = (0..4000).map(sine).collect();
        let filtered = low_pass(&signal, INTERVAL, 1.0);
        let middle = 1000..3000;
        let square = |values: &[f64]| values[middle.clone()].iter().map(|v| v * v).sum::<f64>();
        (square(&filtered) / square(&signal)).sqrt()
    }

    #[test]
    fn a_constant_passes_unchanged() {
        for value in low_pass(&[3.0; 50], INTERVAL, 1.0) {
            assert_relative_eq!(value, 3.0, max_relative = 1e-12);
        }
    }

    #[test]
    fn the_gain_is_that_of_two_passes_of_second_order() {
        for frequency in [0.25_f64, 0.5, 1.0, 2.0] {
            let warped = (PI * frequency * INTERVAL).tan() / (PI * INTERVAL).tan();
            assert_relative_eq!(gain(frequency), 1.0 / (1.0 + warped.powi(4)), max_relative = 2e-3);
        }
    }

    #[test]
    fn a_slow_sine_is_not_delayed() {
        let sine = |i: usize| (2.0 * PI * 0.05 * INTERVAL * i as f64).sin();
        let signal: Vec<f64> = (0..8000).map(sine).collect();
        let filtered = low_pass(&signal, INTERVAL, 1.0);
        for i in 1000..7000 {
            assert!((filtered[i] - signal[i]).abs() < 1e-4);
        }
    }

    #[test]
    fn a_cut_off_beyond_the_samples_changes_nothing() {
        assert_eq!(low_pass(&[1.0, -1.0, 2.0], 0.1, 5.0), [1.0, -1.0, 2.0]);
    }
}
