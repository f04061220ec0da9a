//! Output times of a run.

/// Output times: multiples of an interval, and the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Times {
    /// Interval [s].
    pub interval: f64,
    /// End [s].
    pub end: f64,
    /// Number of steps [-].
    pub count: usize,
}

impl Times {
    /// Times from 0 to `end` [s] every `interval` [s]; the last step is shorter if the end is not a multiple of the interval.
    pub fn new(end: f64, interval: f64) -> Times {
        // A remainder of a millionth of a step is due to rounding of the quotient and not counted.
        let count = (end / interval - 1e-6).ceil().max(0.0) as usize;
        Times { interval, end, count }
    }

    /// Time at the beginning of a step, or at the end [s].
    pub fn at(&self, index: usize) -> f64 {
        // 6 × 0.05 is 0.30000000000000004, but 6/20 is 0.3.
        let a_second = (1.0 / self.interval).round();
        if index == self.count {
            self.end
        } else if (a_second * self.interval - 1.0).abs() < 1e-12 {
            index as f64 / a_second
        } else {
            index as f64 * self.interval
        }
    }

    /// Length of a step [s]: exactly the interval, except for a shorter last step.
    pub fn step(&self, index: usize) -> f64 {
        let rest = self.end - index as f64 * self.interval;
        if index + 1 == self.count && rest < self.interval * (1.0 - 1e-6) {
            rest
        } else {
            self.interval
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_the_interval_to_the_last_bit_and_end_at_the_end() {
        let times = Times::new(60.0, 0.05);
        assert_eq!(times.count, 1200);
        assert!((0..1200).all(|i| times.step(i) == 0.05));
        assert_eq!(times.at(6), 0.3);
        assert_eq!(times.at(1200), 60.0);
    }

    #[test]
    fn a_last_step_is_shorter_where_the_interval_does_not_divide_the_duration() {
        let times = Times::new(1.0, 0.3);
        assert_eq!(times.count, 4);
        assert!((times.step(3) - 0.1).abs() < 1e-12);
        assert_eq!(times.at(4), 1.0);
    }

    #[test]
    fn an_interval_beyond_the_duration_is_one_step() {
        let times = Times::new(1.0, 5.0);
        assert_eq!((times.count, times.step(0)), (1, 1.0));
    }
}
