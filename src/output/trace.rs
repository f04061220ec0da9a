//! Histories of bounded length for figures, and ranges in time, both gathered row by row.

use serde::{Deserialize, Serialize};

/// Greatest number of points kept of a history [-].
pub const POINTS_MAX: usize = 2400;

/// History whose length does not grow with the run: the first, the least, the greatest and the last point of every group of neighbours are kept, in
/// order. Non-finite values are omitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    /// Number of points in a group [-]; 1 if all are kept.
    group: usize,
    kept: Vec<[f64; 2]>,
    open: Option<Group>,
}

/// Incomplete group.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Group {
    count: usize,
    /// The first, the least, the greatest and the last point, each with its index in the group.
    marks: [(usize, [f64; 2]); 4],
}

impl Group {
    fn add(&mut self, point: [f64; 2]) {
        let (place, [_, least, greatest, last]) = (self.count, &mut self.marks);
        if point[1].total_cmp(&least.1[1]).is_lt() {
            *least = (place, point);
        }
        if point[1].total_cmp(&greatest.1[1]).is_ge() {
            *greatest = (place, point);
        }
        *last = (place, point);
        self.count += 1;
    }

    fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        let mut marks = self.marks;
        marks.sort_unstable_by_key(|(place, _)| *place);
        let isolated = move |i: &usize| *i == 0 || marks[*i].0 != marks[*i - 1].0;
        (0..marks.len()).filter(isolated).map(move |i| marks[i].1)
    }
}

impl Trace {
    /// Creates an empty history for a number of points.
    pub fn new(planned: usize) -> Trace {
        let group = match planned {
            ..=POINTS_MAX => 1,
            _ => planned.div_ceil(POINTS_MAX / 4),
        };
        Trace {
            group,
            kept: Vec::new(),
            open: None,
        }
    }

    /// Returns the history of these points.
    pub fn of(points: &[[f64; 2]]) -> Trace {
        let finite = || points.iter().filter(|point| is_finite(point));
        let mut trace = Trace::new(finite().count());
        finite().for_each(|point| trace.add(*point));
        trace
    }

    /// Adds a point: its time and its value.
    pub fn add(&mut self, point: [f64; 2]) {
        if !is_finite(&point) {
            return;
        }
        if self.group == 1 {
            self.kept.push(point);
            return;
        }
        match &mut self.open {
            Some(group) => group.add(point),
            none => {
                *none = Some(Group {
                    count: 1,
                    marks: [(0, point); 4],
                })
            }
        }
        if let Some(group) = self.open.take_if(|group| group.count == self.group) {
            self.kept.extend(group.points());
        }
    }

    /// Returns the points that are kept, in order.
    pub fn points(&self) -> Vec<[f64; 2]> {
        let open = self.open.iter().flat_map(Group::points);
        self.kept.iter().copied().chain(open).collect()
    }
}

fn is_finite([x, y]: &[f64; 2]) -> bool {
    x.is_finite() && y.is_finite()
}

/// Smallest, mean and greatest value of a history and its standard deviation, in its unit. Mean and deviation are over time, by the
/// trapezoidal rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest value, in the history's unit.
    pub min: f64,
    /// Mean over time, in the history's unit.
    pub mean: f64,
    /// Greatest value, in the history's unit.
    pub max: f64,
    /// Standard deviation over time, in the history's unit.
    pub deviation: f64,
}

/// Sums from which a [`Range`] follows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RangeSum {
    start: f64,
    last: [f64; 2],
    /// First value, relative to which the values are integrated to reduce cancellation.
    origin: f64,
    /// Integrals over time of the value and of its square, relative to the first value.
    areas: [f64; 2],
    least: f64,
    greatest: f64,
}

impl RangeSum {
    /// Returns the sums of one pair of time [s] and value.
    pub fn new([time, value]: [f64; 2]) -> RangeSum {
        RangeSum {
            start: time,
            last: [time, value],
            origin: value,
            areas: [0.0; 2],
            least: f64::INFINITY.min(value),
            greatest: f64::NEG_INFINITY.max(value),
        }
    }

    /// Adds a pair of time [s] and value; a value that is not a number is left out.
    pub fn add(&mut self, [time, value]: [f64; 2]) {
        if value.is_nan() {
            return;
        }
        if self.origin.is_nan() {
            *self = RangeSum::new([time, value]);
            return;
        }
        let [before, now] = [self.last[1] - self.origin, value - self.origin];
        let half = 0.5 * (time - self.last[0]);
        self.areas[0] += half * (before + now);
        self.areas[1] += half * (before * before + now * now);
        self.last = [time, value];
        self.least = self.least.min(value);
        self.greatest = self.greatest.max(value);
    }

    /// Returns the range of all pairs; for a single pair, this is its value.
    pub fn range(&self) -> Range {
        let span = self.last[0] - self.start;
        let [mean, square] = match span {
            0.0 => [0.0; 2],
            _ => self.areas.map(|area| area / span),
        };
        Range {
            min: self.least,
            mean: self.origin + mean,
            max: self.greatest,
            deviation: (square - mean * mean).max(0.0).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_history_keeps_its_peaks_and_a_bounded_number_of_points() {
        for count in [2_401_u32, 50_000, 100_000] {
            let mut trace = Trace::new(count as usize);
            for i in 0..count {
                let value = match i {
                    1_234 => -7.0,
                    2_345 => 9.0,
                    3 => f64::NAN,
                    _ => 0.0,
                };
                trace.add([f64::from(i), value]);
            }
            let points = trace.points();
            assert!(points.len() <= POINTS_MAX && trace.kept.capacity() <= 2 * POINTS_MAX);
            assert!(points.contains(&[2_345.0, 9.0]) && points.contains(&[1_234.0, -7.0]));
            assert!(points.is_sorted_by(|a, b| a[0] < b[0]));
            assert_eq!(points.last(), Some(&[f64::from(count - 1), 0.0]));
            assert_eq!(Trace::of(&points).points(), points);
        }
    }

    #[test]
    fn a_short_history_is_kept_whole() {
        let points: Vec<[f64; 2]> = (0..2_400).map(|i| [f64::from(i), f64::from(i % 7)]).collect();
        assert_eq!(Trace::of(&points).points(), points);
    }

    fn range(pairs: &[[f64; 2]]) -> Range {
        let mut sum = RangeSum::new(pairs[0]);
        pairs[1..].iter().for_each(|pair| sum.add(*pair));
        sum.range()
    }

    #[test]
    fn the_mean_is_over_time_and_not_over_rows() {
        let range = range(&[[0.0, 0.0], [1.0, 2.0], [4.0, 2.0]]);
        assert_eq!((range.min, range.mean, range.max), (0.0, 7.0 / 4.0, 2.0));
    }

    #[test]
    fn a_single_row_is_its_own_mean() {
        let range = range(&[[3.0, 5.0]]);
        assert_eq!((range.mean, range.deviation), (5.0, 0.0));
    }

    #[test]
    fn the_deviation_of_a_sine_is_its_amplitude_over_the_root_of_two_on_any_mean() {
        for mean in [0.0, 1e6] {
            let pairs: Vec<[f64; 2]> = (0..=1000)
                .map(|i| 0.01 * f64::from(i))
                .map(|t| [t, mean + 3.0 * (std::f64::consts::TAU * t).sin()])
                .collect();
            let range = range(&pairs);
            assert!((range.deviation - 3.0 / 2.0_f64.sqrt()).abs() < 1e-6, "{range:?}");
            assert!((range.mean - mean).abs() < 1e-6, "{range:?}");
        }
    }
}
