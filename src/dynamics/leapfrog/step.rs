//! Steps of the leapfrogs, which may differ in length: positions at t_n, velocities halfway between.

/// Time increments of a step.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Δt of the positions, t_n to t_{n+1} [s].
    pub drift: f64,
    /// Δt of the velocities, t_{n−½} to t_{n+½}: the mean of this step and the previous one [s].
    pub kick: f64,
    /// Weight of v_{n−½} − v_{n−3/2} in the velocity extrapolated to t_n [-].
    pub extrapolation: f64,
}

impl Step {
    /// Step of `drift` [s] after a step of `last` [s], and one of `earlier` [s] before that; 0 if there was none.
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

    /// Length of the previous step [s].
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
