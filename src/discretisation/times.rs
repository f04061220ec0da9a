//! Duration and samples of the trials, by the periods of a scene's motion.

use crate::scene::{MotionPath, Scene, ToleranceOf};

/// Periods of the slowest sine that are tried, after the ramp [-].
const PERIODS: f64 = 20.0;
/// Time that is tried where the motion is a table, or of no period [s].
const DURATION: f64 = 200.0;
/// Samples in a period of the fastest sine, at least [-].
const SAMPLES: f64 = 25.0;
/// Samples of a low-passed tension in such a period [-]. With fewer, slaps would be aliased to frequencies that pass the filter.
const SAMPLES_TO_FILTER: f64 = 100.0;
/// Samples in a period that are dense enough for a snap at any phase [-]. Fewer samples have other phases in every period.
const PHASES: f64 = 100.0;
/// Fraction of the interval by which the samples move from one period to the next [-]: 1 − 1/golden ratio, which spreads them evenly.
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
    /// None for a scene that gives no motion.
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

    /// Interval of the samples [s] where that of the output is `interval` [s].
    pub(super) fn sample_interval(&self, interval: f64, tolerance_of: ToleranceOf) -> f64 {
        let samples = match tolerance_of {
            ToleranceOf::LowPassedTension => SAMPLES_TO_FILTER,
            ToleranceOf::Tension | ToleranceOf::Position => SAMPLES,
        };
        interval.min(self.shortest / samples)
    }

    /// Returns an interval of samples [s] that is a little shorter where so few samples would miss the same snap in every period.
    pub(super) fn spread(&self, interval: f64) -> f64 {
        let samples = self.shortest / interval;
        if samples < PHASES {
            self.shortest / (samples.ceil() + SHIFT)
        } else {
            interval
        }
    }
}
