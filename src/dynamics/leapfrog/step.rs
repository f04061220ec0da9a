//! The steps of the leapfrogs, each of which may have a different length: positions at t_n, velocities halfway between.

/// Sizes of a step.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Δt of the positions, t_n to t_{n+1} [s].
    pub drift: f64,
    /// Δt of the velocities, t_{n−½} to t_{n+½}: the mean of this step and the one before [s].
    pub kick: f64,
    /// Weight of v_{n−½} − v_{n−3/2} in the velocity extrapolated to t_n [-].
    pub extrapolation: f64,
}

impl Step {
    /// A step of `drift` [s] after steps of `last` and, before it, `earlier` [s]; 0 where there was none.
    pub fn after([last, earlier]: [f64; 2], drift: f64) -> Step {
        let extrapolation = if last > 0.0 && earlier > 0.0 {
            last / (last + earlier)
        } else {
            0.0
        };
        Step {
            drift,
            kick: 0.5 * (last + drift),
            extrapolation,
        }
    }

    /// Length of the step before [s].
    #[inline(always)]
    pub fn last(&self) -> f64 {
        2.0 * self.kick - self.drift
    }

    /// Time from the velocities v_{n−½} to the positions at t_n [s].
    #[inline(always)]
    pub fn lag(&self) -> f64 {
        self.kick - 0.5 * self.drift
    }
}
