//! Errors of histories against those of a converged solution.
//!
//! Each error is evaluated over the window, for the line where it is greatest. Tensions are those at the driven ends of lines that have one:
//!
//! * RMS: √⟨(T − T_ref)²⟩ over the standard deviation of T_ref;
//! * low-passed: the same for both tensions after a zero-phase filter ([`moorline::math::low_pass`]);
//! * peak: |max T − max T_ref| over the range of T_ref;
//! * position: √⟨|r − r_ref|²⟩ of the point half-way along the line over the standard deviation of its motion.

use moorline::math::low_pass::low_pass;
use nalgebra::Vector3;

/// Quantity that is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Metric {
    /// Tension at the driven end, at every sample.
    Rms,
    /// Low-passed tension at the driven end.
    LowPassed,
    /// Greatest tension.
    Peak,
    /// Position half-way along the line.
    Position,
}

impl Metric {
    /// All metrics, in the order of [`Errors`].
    pub const ALL: [Metric; 4] = [Metric::Rms, Metric::LowPassed, Metric::Peak, Metric::Position];

    /// Name in words.
    pub fn title(self) -> &'static str {
        match self {
            Metric::Rms => "tension, RMS",
            Metric::LowPassed => "tension, low-passed RMS",
            Metric::Peak => "tension, peak",
            Metric::Position => "position half-way along the line, RMS",
        }
    }

    /// Key in tables.
    pub fn key(self) -> &'static str {
        match self {
            Metric::Rms => "tension_rms",
            Metric::LowPassed => "tension_low_passed",
            Metric::Peak => "tension_peak",
            Metric::Position => "position_rms",
        }
    }
}

/// Histories of a run, one sample after every output interval.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Histories {
    /// Tension at the driven end of every line that has one [N].
    pub tension: Vec<Vec<f64>>,
    /// Position half-way along every line [m].
    pub middle: Vec<Vec<Vector3<f64>>>,
}

/// Window and filter of a comparison of histories.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judge {
    /// Interval of the samples [s].
    pub interval: f64,
    /// Index of the first sample that is compared.
    pub from: usize,
    /// Cut-off of the low-passed tension [Hz].
    pub cut_off: f64,
}

/// Relative errors [-], in the order of [`Metric::ALL`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Errors([f64; 4]);

impl Errors {
    /// Returns the same error [-] for all metrics.
    pub fn all(error: f64) -> Errors {
        Errors([error; 4])
    }

    /// Returns the errors [-] in the order of [`Metric::ALL`].
    pub(crate) fn new(errors: [f64; 4]) -> Errors {
        Errors(errors)
    }

    /// Error by a metric [-].
    pub fn of(&self, metric: Metric) -> f64 {
        self.0[metric as usize]
    }
}

impl Judge {
    /// Errors of histories against those of a reference; infinite if a history is not finite or has another length.
    pub fn errors(&self, histories: &Histories, reference: &Histories) -> Errors {
        let tensions = || histories.tension.iter().zip(&reference.tension);
        let middles = histories.middle.iter().zip(&reference.middle);
        let filtered = |tension: &[f64]| low_pass(tension, self.interval, self.cut_off);
        Errors([
            worst(tensions().map(|(own, right)| self.rms(own, right))),
            worst(tensions().map(|(own, right)| self.rms(&filtered(own), &filtered(right)))),
            worst(tensions().map(|(own, right)| self.peak(own, right))),
            worst(middles.map(|(own, right)| self.relative(own, right))),
        ])
    }

    /// Uncertainty of a solution, from its distance to one on another mesh. Two greatest tensions may agree by chance although the histories do not.
    /// The uncertainty of the peak is therefore at least the RMS distance of the tension over its range.
    pub fn uncertainty(&self, coarse: &Histories, fine: &Histories) -> Errors {
        let mut errors = self.errors(coarse, fine);
        let tensions = coarse.tension.iter().zip(&fine.tension);
        let on_the_whole = worst(tensions.map(|(a, b)| self.rms(a, b) * self.deviation_over_range(b)));
        let peak = &mut errors.0[Metric::Peak as usize];
        *peak = peak.max(on_the_whole);
        errors
    }

    fn deviation_over_range(&self, tension: &[f64]) -> f64 {
        let tension = &tension[self.from..];
        let count = tension.len() as f64;
        let mean = tension.iter().sum::<f64>() / count;
        let square: f64 = tension.iter().map(|t| (t - mean).powi(2)).sum();
        (square / count).sqrt() / range(tension)
    }

    fn rms(&self, own: &[f64], right: &[f64]) -> f64 {
        let along_x = |values: &[f64]| -> Vec<Vector3<f64>> {
            values
                .iter()
                .map(|value| Vector3::new(*value, 0.0, 0.0))
                .collect()
        };
        self.relative(&along_x(own), &along_x(right))
    }

    fn peak(&self, own: &[f64], right: &[f64]) -> f64 {
        if own.len() != right.len() {
            return f64::INFINITY;
        }
        let (own, right) = (&own[self.from..], &right[self.from..]);
        (greatest(own) - greatest(right)).abs() / range(right)
    }

    /// √⟨|own − right|²⟩ over the standard deviation of `right` [-].
    fn relative(&self, own: &[Vector3<f64>], right: &[Vector3<f64>]) -> f64 {
        if own.len() != right.len() {
            return f64::INFINITY;
        }
        let (own, right) = (&own[self.from..], &right[self.from..]);
        let mean = right.iter().sum::<Vector3<f64>>() / right.len() as f64;
        let wrong: f64 = own.iter().zip(right).map(|(a, b)| (a - b).norm_squared()).sum();
        let motion: f64 = right.iter().map(|b| (b - mean).norm_squared()).sum();
        (wrong / motion).sqrt()
    }
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

fn range(values: &[f64]) -> f64 {
    greatest(values) - values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Greatest of the errors; NaN counts as infinite.
fn worst(errors: impl Iterator<Item = f64>) -> f64 {
    let finite = |error: f64| {
        if error.is_finite() { error } else { f64::INFINITY }
    };
    errors.map(finite).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::TAU;

    const JUDGE: Judge = Judge {
        interval: 0.1,
        from: 200,
        cut_off: 0.5,
    };

    /// Ten periods of 4 s in the window: a tension that varies about 10 N with this amplitude [N], and a ripple of 2.5 Hz.
    fn histories(amplitude: f64, ripple: f64) -> Histories {
        let sample = |i: usize| {
            let t = 0.1 * i as f64;
            10.0 + amplitude * (TAU * t / 4.0).sin() + ripple * (TAU * 2.5 * t).sin()
        };
        let tension: Vec<f64> = (0..600).map(sample).collect();
        let middle = tension.iter().map(|t| Vector3::new(0.0, 3.0, *t)).collect();
        Histories {
            tension: vec![tension],
            middle: vec![middle],
        }
    }

    #[test]
    fn an_amplitude_wrong_by_a_hundredth_is_an_error_of_a_hundredth() {
        let errors = JUDGE.errors(&histories(1.01, 0.0), &histories(1.0, 0.0));
        assert_relative_eq!(errors.of(Metric::Rms), 0.01, max_relative = 1e-9);
        assert_relative_eq!(errors.of(Metric::Position), 0.01, max_relative = 1e-9);
        assert_relative_eq!(errors.of(Metric::LowPassed), 0.01, max_relative = 1e-3);
        // half of the range 2
        assert_relative_eq!(errors.of(Metric::Peak), 0.005, max_relative = 1e-9);
    }

    #[test]
    fn a_fast_ripple_counts_in_the_raw_tension_only() {
        let errors = JUDGE.errors(&histories(1.0, 0.1), &histories(1.0, 0.0));
        assert_relative_eq!(errors.of(Metric::Rms), 0.1, max_relative = 1e-6);
        // The gain is 1/626; the filter starts at the end of the record.
        assert!(errors.of(Metric::LowPassed) < 2e-3);
    }

    #[test]
    fn peaks_that_agree_by_chance_are_known_no_better_than_the_histories() {
        let (one, other) = (histories(-1.0, 0.0), histories(1.0, 0.0));
        assert!(JUDGE.errors(&one, &other).of(Metric::Peak) < 1e-12);
        let uncertainty = JUDGE.uncertainty(&one, &other);
        // the difference is 2 sin: its RMS is √2, over a range of 2
        let wanted = 0.5 * 2f64.sqrt();
        assert_relative_eq!(uncertainty.of(Metric::Peak), wanted, max_relative = 1e-9);
        assert_relative_eq!(uncertainty.of(Metric::Rms), 2.0, max_relative = 1e-9);
    }

    #[test]
    fn a_run_that_blew_up_is_infinitely_wrong() {
        let mut broken = histories(1.0, 0.0);
        broken.tension[0][300] = f64::NAN;
        let errors = JUDGE.errors(&broken, &histories(1.0, 0.0));
        assert_eq!(errors.of(Metric::Rms), f64::INFINITY);
    }
}
