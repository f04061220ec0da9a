//! Slopes of piecewise cubics through the rows of a table; the cubics leave the range of neighbouring rows only at smooth extrema.
//!
//! [`slopes`] applies to values that may rise and fall: displacements in time, soundings in x and in y. The slope at a row is that of the quartic
//! through the row and its two neighbours on either side, one order less for each missing neighbour; its error, like that of the cubics, is of the
//! order h⁴. The first and the last slope are given by [`End`]. An extremum of a cubic between two rows i and i + 1 is smooth if its excursion beyond
//! both satisfies, with the divided second differences d_k = (s_k − s_{k−1})/(h_k + h_{k−1}) of the secants s and spans h,
//!
//!   excursion ≤ ¾ min|d_k| min(h_i, 2h_{i−1}, 2h_{i+1})²,   k = i − 1 … i + 2, all d_k of one sign,
//!
//! which is three times the excursion of a parabola with the curvature 2d between equal rows. At the ends of the table three d_k suffice; fewer never
//! do. Any other extremum is not supported by the rows: both slopes are then limited to 0 … 3 minmod(s_{k−1}, s_k), with which the cubics at a row
//! are monotone from row to row. A harmonic of unit amplitude with 20 rows per period is reproduced within 3·10⁻⁵ (8 rows: 2·10⁻³) away from the
//! ends, and within 2·10⁻⁴ if the rows are shifted at random by up to 0.3 of their spacing.
//!
//! [`rising_slopes`] applies to values that rise from row to row, such as tension over strain, and keeps the curve rising by the weighted harmonic
//! mean
//!
//!   m_k = (w₁ + w₂)/(w₁/s_{k−1} + w₂/s_k),  w₁ = 2h_k + h_{k−1},  w₂ = h_k + 2h_{k−1},
//!
//! and at the ends the slope of the parabola through three rows, kept between s/10 and 3s.
//!
//! Source: condition 0 ≤ m ≤ 3s for a monotone cubic by Fritsch & Carlson (1980), SIAM J. Numer. Anal. 17, 238-246; quartic slopes, limited to
//! it, by Hyman (1983), SIAM J. Sci. Stat. Comput. 4, 645-654; distinction of smooth extrema, by second differences
//! of one sign, by Huynh (1993), SIAM J. Numer. Anal. 30, 57-100; the test above is derived here. Harmonic mean by
//! Fritsch & Butland (1984), SIAM J. Sci. Stat. Comput. 5, 300-304. Valid for ascending rows.

/// Slope of a curve at its first or last row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// 0: the curve is constant outside, with a continuous slope.
    Flat,
    /// Slope of the chord to the next row.
    Chord,
    /// Slope of the parabola through three rows, kept between 0 and three times the chord's: the curve ends there.
    Open,
}

/// Maximum excursion of a smooth extremum, relative to that of a parabola with the smallest curvature of the adjacent rows [-].
const EXCURSION_MAX: f64 = 3.0;
/// Maximum ratio of the span to the adjacent spans in this test [-]; a longer span is cut to it.
const SPAN_MAX: f64 = 2.0;
/// Maximum end slope of a monotone cubic relative to its secant [-].
const MONOTONE_MAX: f64 = 3.0;
/// Minimum end slope of a rising curve relative to the secant there [-].
const END_SLOPE_MIN: f64 = 0.1;

/// Slopes at ascending rows, in the unit of `values` over that of `at`.
pub fn slopes(at: &[f64], values: &[f64], ends: [End; 2]) -> Vec<f64> {
    let mut slopes = smooth_slopes(at, values, ends);
    Limiter::new(at, values).limit(&mut slopes);
    slopes
}

/// Slopes as from [`slopes`], but without limiting.
pub fn smooth_slopes(at: &[f64], values: &[f64], ends: [End; 2]) -> Vec<f64> {
    let last = at.len().saturating_sub(1);
    let end = |i: usize, chord: usize, end: End| match end {
        End::Flat => 0.0,
        End::Chord => secant(at, values, chord),
        End::Open => {
            let bound = MONOTONE_MAX * secant(at, values, chord);
            quartic_slope(at, values, i).clamp(bound.min(0.0), bound.max(0.0))
        }
    };
    let slope = |i: usize| match i {
        _ if last == 0 => 0.0,
        0 => end(0, 0, ends[0]),
        i if i == last => end(last, last - 1, ends[1]),
        _ => quartic_slope(at, values, i),
    };
    (0..at.len()).map(slope).collect()
}

/// Slopes of a curve that rises from row to row, at two or more ascending rows.
pub fn rising_slopes(at: &[f64], values: &[f64]) -> Vec<f64> {
    let last = at.len() - 2;
    let span = |k: usize| at[k + 1] - at[k];
    let secant = |k: usize| secant(at, values, k);
    let end = |near: usize, next: usize| {
        if last == 0 {
            return secant(0);
        }
        let (h, slope) = (span(near), secant(near));
        let parabola = slope + h / (h + span(next)) * (slope - secant(next));
        parabola.clamp(END_SLOPE_MIN * slope, MONOTONE_MAX * slope)
    };
    let between = |k: usize| {
        let (before, after) = (span(k - 1), span(k));
        let weights = [2.0 * after + before, after + 2.0 * before];
        (weights[0] + weights[1]) / (weights[0] / secant(k - 1) + weights[1] / secant(k))
    };
    let inner = (1..=last).map(between);
    std::iter::once(end(0, 1.min(last)))
        .chain(inner)
        .chain([end(last, last.saturating_sub(1))])
        .collect()
}

fn secant(at: &[f64], values: &[f64], k: usize) -> f64 {
    (values[k + 1] - values[k]) / (at[k + 1] - at[k])
}

/// Slope at row i of the polynomial through it and up to two neighbours on either side; 0 where it is NaN.
fn quartic_slope(at: &[f64], values: &[f64], i: usize) -> f64 {
    let mut rows = [i; 5];
    let mut count = 0;
    for row in [
        Some(i),
        Some(i + 1),
        i.checked_sub(1),
        Some(i + 2),
        i.checked_sub(2),
    ] {
        if let Some(row) = row.filter(|row| *row < at.len()) {
            rows[count] = row;
            count += 1;
        }
    }
    let mut difference = rows.map(|row| values[row]); // divided differences of Newton's form
    for order in 1..count {
        for k in (order..count).rev() {
            difference[k] = (difference[k] - difference[k - 1]) / (at[rows[k]] - at[rows[k - order]]);
        }
    }
    let (mut slope, mut product) = (0.0, 1.0);
    for k in 1..count {
        slope += difference[k] * product;
        product *= at[i] - at[rows[k]];
    }
    if slope.is_finite() { slope } else { 0.0 }
}

/// Limiter that allows extrema of the cubics only where they are smooth.
struct Limiter<'a> {
    values: &'a [f64],
    spans: Vec<f64>,
    secants: Vec<f64>,
    /// d_k of the rows between the first and the last.
    bends: Vec<f64>,
}

impl<'a> Limiter<'a> {
    fn new(at: &[f64], values: &'a [f64]) -> Limiter<'a> {
        let spans: Vec<f64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let secants: Vec<f64> = (0..spans.len()).map(|k| secant(at, values, k)).collect();
        let bend = |k: usize| (secants[k] - secants[k - 1]) / (spans[k] + spans[k - 1]);
        Limiter {
            values,
            bends: (1..spans.len()).map(bend).collect(),
            spans,
            secants,
        }
    }

    /// Limits both slopes of every cubic with an unsupported extremum. A row is limited at most once. As this may create an extremum in the cubic
    /// before it, that cubic is checked again.
    fn limit(&self, slopes: &mut [f64]) {
        let mut limited = vec![false; slopes.len()];
        let mut k = 0;
        while k < self.spans.len() {
            let mut back = false;
            let settled = limited[k] && limited[k + 1];
            if !settled && !self.is_supported(k, [slopes[k], slopes[k + 1]]) {
                for row in [k, k + 1] {
                    back |= row == k && !limited[row];
                    limited[row] = true;
                    slopes[row] = self.monotone(row, slopes[row]);
                }
            }
            k = if back && k > 0 { k - 1 } else { k + 1 };
        }
    }

    /// Slope at a row, limited so that the cubics on both sides can be monotone.
    fn monotone(&self, row: usize, slope: f64) -> f64 {
        let inner = row > 0 && row < self.spans.len();
        if !inner {
            return slope;
        }
        let bound = MONOTONE_MAX * minmod(self.secants[row - 1], self.secants[row]);
        slope.clamp(bound.min(0.0), bound.max(0.0))
    }

    /// Returns whether the cubic from row k to the next, with the given end slopes, has no extremum or a smooth one.
    fn is_supported(&self, k: usize, slopes: [f64; 2]) -> bool {
        let (span, secant) = (self.spans[k], self.secants[k]);
        if is_monotone(secant, slopes) {
            return true;
        }
        let excursion = excursion([self.values[k], self.values[k + 1]], slopes.map(|m| m * span));
        excursion > 0.0 && excursion <= self.support(k)
    }

    /// Maximum excursion of a smooth extremum between row k and the next.
    fn support(&self, k: usize) -> f64 {
        // bends[j] belongs to row j + 1
        let around = &self.bends[k.saturating_sub(2)..(k + 2).min(self.bends.len())];
        if around.len() < 3 {
            return 0.0;
        }
        let least = around.iter().copied().reduce(minmod).map_or(0.0, f64::abs);
        let adjacent = &self.spans[k.saturating_sub(1)..(k + 2).min(self.spans.len())];
        let shortest = adjacent.iter().copied().fold(f64::INFINITY, f64::min);
        let span = self.spans[k].min(SPAN_MAX * shortest);
        EXCURSION_MAX * 0.25 * least * span * span
    }
}

/// The number of smaller magnitude if both have the same sign, else 0.
fn minmod(a: f64, b: f64) -> f64 {
    if a * b <= 0.0 {
        0.0
    } else if a.abs() < b.abs() {
        a
    } else {
        b
    }
}

/// Returns whether a cubic with these slopes at its ends is monotone: necessary and sufficient, Fritsch & Carlson's lemmas 1 and 2.
fn is_monotone(secant: f64, [start, end]: [f64; 2]) -> bool {
    if secant == 0.0 {
        return start == 0.0 && end == 0.0;
    }
    let (a, b) = (start / secant, end / secant);
    if !(a >= 0.0 && b >= 0.0) {
        return false;
    }
    let steep = a + b - 2.0;
    let least = a - (2.0 * a + b - 3.0).powi(2) / (3.0 * steep); // smallest slope in between, relative to the secant
    steep <= 0.0 || 2.0 * a + b <= 3.0 || a + 2.0 * b <= 3.0 || least >= 0.0
}

/// Excursion of a cubic beyond the range of its end values; `start` and `end` are its end slopes times the span.
fn excursion([low, high]: [f64; 2], [start, end]: [f64; 2]) -> f64 {
    let rise = high - low;
    let [b, c, d] = [start, 3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise];
    let root = (c * c - 3.0 * b * d).max(0.0).sqrt();
    let sum = -(c + root.copysign(c));
    let turns = [sum / (3.0 * d), b / sum];
    let within = turns.into_iter().filter(|u| (0.0..=1.0).contains(u));
    within
        .map(|u| u * (b + u * (c + u * d)))
        .map(|change| (change - rise.max(0.0)).max(rise.min(0.0) - change))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hermite::Hermite;
    use crate::math::random::Random;
    use std::f64::consts::TAU;

    /// Minimum and maximum of the curve between row k and the next.
    fn range(at: &[f64], values: &[f64], slopes: &[f64], k: usize) -> [f64; 2] {
        let knot = |i: usize| (at[i], values[i], slopes[i]);
        let cubic = Hermite::new(knot(k), knot(k + 1));
        let span = at[k + 1] - at[k];
        let samples = (0..=200).map(|i| cubic.at(at[k] + span * f64::from(i) / 200.0).value);
        samples.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], v| {
            [least.min(v), most.max(v)]
        })
    }

    /// Maximum error for a sine with `count` rows per period, moved by `shift`, without three rows at either end.
    fn error_of_sine(count: f64, phase: f64, mut shift: impl FnMut() -> f64) -> f64 {
        let at: Vec<f64> = (0..=(3.0 * count) as usize).map(|i| i as f64 + shift()).collect();
        let sine = |t: f64| (TAU * t / count + phase).sin();
        let values: Vec<f64> = at.iter().map(|t| sine(*t)).collect();
        let slopes = slopes(&at, &values, [End::Flat; 2]);
        let mut worst = 0.0_f64;
        for k in 3..at.len() - 4 {
            let knot = |i: usize| (at[i], values[i], slopes[i]);
            let cubic = Hermite::new(knot(k), knot(k + 1));
            for i in 0..20 {
                let t = at[k] + (at[k + 1] - at[k]) * f64::from(i) / 20.0;
                worst = worst.max((cubic.at(t).value - sine(t)).abs());
            }
        }
        worst
    }

    #[test]
    fn a_harmonic_of_twenty_rows_a_period_is_met_at_any_phase_its_peaks_included() {
        for i in 0..200 {
            let phase = TAU * f64::from(i) / 200.0;
            let error = error_of_sine(20.0, phase, || 0.0);
            assert!(error < 4e-5, "phase {phase} rad: {error:e}");
            let error = error_of_sine(8.0, phase, || 0.0);
            assert!(error < 3e-3, "8 rows a period, phase {phase} rad: {error:e}");
        }
    }

    #[test]
    fn a_harmonic_on_uneven_rows_is_met_at_any_phase_its_peaks_included() {
        let mut random = Random::new(7);
        for i in 0..200 {
            let phase = TAU * f64::from(i) / 200.0;
            let error = error_of_sine(20.0, phase, || 0.6 * random.unit() - 0.3);
            assert!(error < 3e-4, "phase {phase} rad: {error:e}");
        }
    }

    #[test]
    fn the_error_on_a_smooth_record_falls_with_the_fourth_power_of_the_distance_of_rows() {
        let errors = [16.0, 32.0, 64.0, 128.0].map(|count| error_of_sine(count, 0.3, || 0.0));
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 4.0).abs() < 0.3, "{errors:?}");
        }
    }

    fn is_convex_or_concave(at: &[f64], values: &[f64]) -> bool {
        let bend = |k: usize| secant(at, values, k) - secant(at, values, k - 1);
        let bends: Vec<f64> = (1..at.len() - 1).map(bend).collect();
        bends.len() > 2 && (bends.iter().all(|bend| *bend > 0.0) || bends.iter().all(|bend| *bend < 0.0))
    }

    #[test]
    fn rows_that_jump_are_left_by_no_more_than_a_twentieth_of_the_local_step() {
        let mut random = Random::new(3);
        for _ in 0..3000 {
            let count = 4 + (20.0 * random.unit()) as usize;
            let even = random.unit() < 0.3;
            let (mut t, mut v) = (0.0, 0.0);
            let (mut at, mut values) = (vec![], vec![]);
            for _ in 0..count {
                at.push(t);
                values.push(v);
                t += if even {
                    1.0
                } else {
                    10_f64.powf(4.0 * random.unit() - 2.0)
                };
                if random.unit() < 0.4 {
                    v += (random.unit() - 0.5) * 10_f64.powf(2.0 * random.unit());
                }
            }
            for ends in [[End::Flat; 2], [End::Chord; 2], [End::Flat, End::Open]] {
                let slopes = slopes(&at, &values, ends);
                for k in 0..count - 1 {
                    let [least, most] = range(&at, &values, &slopes, k);
                    let rows = k.saturating_sub(2)..(k + 4).min(count);
                    if is_convex_or_concave(&at[rows.clone()], &values[rows]) {
                        continue; // by chance a smooth extremum
                    }
                    let near = &values[k.saturating_sub(1)..(k + 3).min(count)];
                    let steps = near.windows(2).map(|pair| (pair[1] - pair[0]).abs());
                    let step = steps.fold(0.0, f64::max);
                    let (low, high) = (values[k].min(values[k + 1]), values[k].max(values[k + 1]));
                    let beyond = (most - high).max(low - least);
                    assert!(
                        beyond <= 0.05 * step + 1e-12,
                        "{at:?} {values:?}: {beyond} at {k}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_straight_line_and_a_parabola_are_met_exactly_inside() {
        let at = [0.0, 0.7, 1.0, 2.2, 3.0, 3.9, 5.0];
        let line = at.map(|t| 3.0 - 2.0 * t);
        for slope in slopes(&at, &line, [End::Chord; 2]) {
            assert!((slope + 2.0).abs() < 1e-14, "{slope}");
        }
        let parabola = at.map(|t| (t - 2.5) * (t - 2.5));
        let slopes = slopes(&at, &parabola, [End::Chord; 2]);
        for i in 1..6 {
            assert!((slopes[i] - 2.0 * (at[i] - 2.5)).abs() < 1e-13, "{slopes:?}");
        }
    }

    #[test]
    fn one_row_and_two_rows_have_the_slopes_of_their_ends() {
        assert_eq!(slopes(&[1.0], &[5.0], [End::Chord; 2]), [0.0]);
        assert_eq!(slopes(&[1.0, 2.0], &[5.0, 7.0], [End::Chord; 2]), [2.0, 2.0]);
        assert_eq!(slopes(&[1.0, 2.0], &[5.0, 7.0], [End::Flat; 2]), [0.0, 0.0]);
        assert!(slopes(&[], &[], [End::Flat; 2]).is_empty());
        assert_eq!(
            slopes(&[1.0, 2.0], &[5.0, 7.0], [End::Flat, End::Open]),
            [0.0, 2.0]
        );
    }
}
