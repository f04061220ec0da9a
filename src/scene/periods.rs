//! Periods of a scene's motions, and the cut-off frequency of its low-passed tension.

use super::{MotionPath, Scene};

/// Ratio of the cut-off of the low-passed tension to the frequency of the fastest sine of the motion [-].
const CUT_OFF: f64 = 5.0;
/// Period that is assumed for motions without sines [s]: that of common waves.
const PERIOD: f64 = 10.0;

impl Scene {
    /// Motions of vessels and points.
    pub fn motions(&self) -> impl Iterator<Item = &MotionPath> {
        let own = self.points.iter().filter_map(|point| point.motion.as_ref());
        self.motion.values().chain(own)
    }

    /// Periods [s] of all sines of the motions.
    pub fn periods(&self) -> impl Iterator<Item = f64> {
        let harmonic = self.motions().filter_map(|path| match path {
            MotionPath::Harmonic(motion) => Some(motion),
            MotionPath::File(_) | MotionPath::Table(_) => None,
        });
        let axes = harmonic.flat_map(|motion| motion.axes().map(|(_, sines)| sines));
        axes.flatten().map(|sine| sine[1])
    }

    /// Shortest period of the motions [s]; 10 s if they have no sines.
    pub fn shortest_period(&self) -> f64 {
        self.periods().reduce(f64::min).unwrap_or(PERIOD)
    }

    /// Cut-off of the low-passed tension [Hz]: five times the frequency of the fastest sine of the motions, or 0.5 Hz if they have no sines.
    pub fn cut_off(&self) -> f64 {
        CUT_OFF / self.shortest_period()
    }
}
