//! Duration and samples of the trials, from the periods of a scene's motion.

use crate::scene::{MotionPath, Scene, ToleranceOf};

/// Number of periods of the slowest sine that are tried, after the ramp [-].
const PERIODS: f64 = 20.0;
/// Duration of a trial if the motion is a table or has no period [s].
const DURATION: f64 = 200.0;
/// Least number of samples in a period of the fastest sine [-].
const SAMPLES: f64 = 25.0;
/// Least number of samples of a low-passed tension in this period [-]. With fewer, slaps would be aliased to frequencies that pass the filter.
const SAMPLES_TO_FILTER: f64 = 100.0;
/// Number of samples in a period from which on a snap is sampled at any phase [-]. If there are fewer, their phases change from period to period.
const PHASES: f64 = 100.0;
/// Fraction of the interval by which the samples shift from one period to the next [-]: 1 − 1/golden ratio, which spreads them evenly.
const SHIFT: f64 = 0.381_966;

/// Periods and duration of a scene's motion.
pub(super) struct MotionTimes {
    /// Shortest period [s].
    shortest: f64,
    /// Time after which the motion is fully developed [s].
    pub(super) ramp: f64,
    /// Time over which errors are evaluated [s].
    pub(super) duration: f64,
}

impl MotionTimes {
    /// Returns the times; `None` for a scene without a motion.
    pub(super) fn of(scene: &Scene) -> Option<MotionTimes> {
        scene.motions().next()?;
        let in_waves = scene.water.as_ref().is_some_and(|water| water.waves.is_some());
        let ramps = scene.motions().map(|path| match path {
            MotionPath::Harmonic(motion) => Some(motion.ramp.unwrap_or(0.0)),
            MotionPath::File(_) | MotionPath::Table(_) => None,
        });
        let ramps: Vec<Option<f64>> = ramps.collect();
        let ramp = ramps.iter().flatten().copied().fold(0.0, f64::max);
        let slowest = scene.periods().reduce(f64::max);
        let duration = match slowest {
            Some(period) if !in_waves && ramps.iter().all(Option::is_some) => PERIODS * period,
            _ => DURATION,
        };
        Some(MotionTimes {
            shortest: scene.periods().fold(f64::INFINITY, f64::min),
            ramp,
            duration: ramp + duration,
        })
    }

    /// Interval of the samples [s]; `interval` is that of the output [s].
    pub(super) fn sample_interval(&self, interval: f64, tolerance_of: ToleranceOf) -> f64 {
        let samples = match tolerance_of {
            ToleranceOf::LowPassedTension => SAMPLES_TO_FILTER,
            ToleranceOf::Tension | ToleranceOf::Position => SAMPLES,
        };
        interval.min(self.shortest / samples)
    }

    /// Returns a slightly shorter sample interval [s] if samples are so few that they would miss the same snap in every period.
    pub(super) fn spread(&self, interval: f64) -> f64 {
        let samples = self.shortest / interval;
        if samples < PHASES {
            self.shortest / (samples.ceil() + SHIFT)
        } else {
            interval
        }
    }
}
