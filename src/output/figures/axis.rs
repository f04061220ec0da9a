//! Axes: their range, their ticks and the unit of their labels.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use super::chart::Curve;

/// Target number of ticks on an axis; one more or one fewer may fit better.
const TICKS: f64 = 7.0;
/// Ratio of a range to the magnitude of its values below which it is drawn as flat: it is due to round-off or convergence, not motion.
const FLAT: f64 = 1e-5;

/// Scale of an axis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    #[default]
    Linear,
    /// Decimal logarithmic; the values of the curves are logarithms.
    Decades,
}

/// Least and greatest of some values; without values, the least exceeds the greatest.
pub(super) fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), value| {
        (min.min(value), max.max(value))
    })
}

/// An axis of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name and unit.
    pub label: String,
    /// Scale of the values.
    pub scale: Scale,
    /// Lower end, in the label's unit.
    pub min: f64,
    /// Upper end, in the label's unit.
    pub max: f64,
}

impl Axis {
    /// Axis from the least to the greatest value of a component (0 or 1) of the curves, without a margin.
    pub fn fitting(curves: &[Curve], component: usize, label: String) -> Axis {
        let values = curves.iter().flat_map(|curve| &curve.points);
        let values = values.map(|point| point[component]);
        let (mut min, mut max) = ends(values.filter(|value| value.is_finite()));
        if min > max {
            (min, max) = (0.0, 1.0);
        }
        let size = min.abs().max(max.abs());
        if max - min <= FLAT * size {
            let margin = if size > 0.0 { 0.01 * size } else { 1.0 };
            (min, max) = (min - margin, max + margin);
        }
        Axis {
            label,
            scale: Scale::Linear,
            min,
            max,
        }
    }

    /// As [`Axis::fitting`], with a margin on both sides.
    pub fn around(curves: &[Curve], component: usize, label: String) -> Axis {
        let axis = Axis::fitting(curves, component, label);
        let margin = 0.05 * (axis.max - axis.min);
        Axis {
            min: axis.min - margin,
            max: axis.max + margin,
            ..axis
        }
    }

    /// As [`Axis::around`], for curves that hold decimal logarithms.
    pub fn decades(curves: &[Curve], component: usize, label: String) -> Axis {
        Axis {
            scale: Scale::Decades,
            ..Axis::around(curves, component, label)
        }
    }

    /// Widens the axis about its middle to this length, in the label's unit.
    pub fn widen(&mut self, length: f64) {
        let missing = 0.5 * (length - (self.max - self.min)).max(0.0);
        self.min -= missing;
        self.max += missing;
    }

    /// Round values on the axis, and the decimal places that distinguish them.
    pub fn ticks(&self) -> (Vec<f64>, usize) {
        if self.scale == Scale::Decades {
            return (decade_ticks(self.min, self.max), 0);
        }
        let wanted = (self.max - self.min) / TICKS;
        let decade = 10.0_f64.powi(wanted.log10().floor() as i32);
        let step = [1.0, 2.0, 2.5, 5.0, 10.0]
            .map(|factor| factor * decade)
            .into_iter()
            .find(|&step| step >= 0.8 * wanted)
            .unwrap_or(10.0 * decade);
        let (first, last) = ((self.min / step).ceil() as i64, (self.max / step).floor() as i64);
        let ticks = (first..=last).map(|i| i as f64 * step).collect();
        (ticks, decimals(step))
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        let part = (value - self.min) / (self.max - self.min);
        start + (part * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() {
            Vec::new()
        } else {
            self.ticks().0
        }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.min..self.max
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        match self.scale {
            Scale::Linear => label(*value, self.ticks().1),
            Scale::Decades => power_of_ten(*value),
        }
    }
}

/// Logarithms of the powers of ten from `min` to `max`, and of two and five times these if they are few.
fn decade_ticks(min: f64, max: f64) -> Vec<f64> {
    let within: &[f64] = if max - min > 3.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let decades = min.floor() as i32..=max.ceil() as i32;
    let ticks = decades.flat_map(|decade| within.iter().map(move |m| m.log10() + f64::from(decade)));
    ticks.filter(|tick| (min..=max).contains(tick)).collect()
}

/// Text of 10^x: plain from 10⁻³ to 10³, otherwise as a power.
fn power_of_ten(x: f64) -> String {
    let value = 10.0_f64.powf(x);
    let decade = (x + 1e-9).floor();
    let digits = (-decade).max(0.0) as usize;
    if decade.abs() <= 3.0 {
        return format!("{value:.digits$}");
    }
    let factor = (value / 10.0_f64.powf(decade)).round();
    let power: String = format!("{decade}")
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize - '0' as usize],
        })
        .collect();
    if factor == 1.0 {
        format!("10{power}")
    } else {
        format!("{factor}·10{power}")
    }
}

/// Text of a tick; a negative zero loses its sign.
fn label(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let zero = text
        .trim_start_matches('-')
        .bytes()
        .all(|b| b == b'0' || b == b'.');
    if zero {
        text.trim_start_matches('-').to_string()
    } else {
        text.replace('-', "−")
    }
}

/// Number of decimal places of a step.
fn decimals(step: f64) -> usize {
    (0..15)
        .find(|&digits| {
            let shifted = step * 10.0_f64.powi(digits);
            (shifted - shifted.round()).abs() < 1e-6 * shifted
        })
        .unwrap_or(15) as usize
}

/// Returns symbol and size [N] of the multiple of the newton in which `greatest` [N] has one to four digits before the decimal point.
pub fn force_unit(greatest: f64) -> (&'static str, f64) {
    match greatest {
        v if v >= 1e7 => ("MN", 1e6),
        v if v >= 5e3 => ("kN", 1e3),
        _ => ("N", 1.0),
    }
}

/// Number for a label, with at most three decimal places and no trailing zeros.
pub fn plain(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(min: f64, max: f64) -> Axis {
        Axis {
            label: String::new(),
            scale: Scale::Linear,
            min,
            max,
        }
    }

    #[test]
    fn ticks_of_decades_are_powers_and_few() {
        let axis = Axis {
            scale: Scale::Decades,
            ..axis(-5.2, 0.3)
        };
        let texts: Vec<String> = axis.ticks().0.iter().map(|tick| power_of_ten(*tick)).collect();
        assert_eq!(texts, ["10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1"]);
        let texts: Vec<String> = decade_ticks(-0.4, 1.1).into_iter().map(power_of_ten).collect();
        assert_eq!(texts, ["0.5", "1", "2", "5", "10"]);
        assert_eq!(power_of_ten(-4.0 + 5.0_f64.log10()), "5·10⁻⁴");
    }

    #[test]
    fn ticks_are_round_and_between_the_ends() {
        for (min, max) in [
            (0.0, 60.0),
            (-200.0, 13.0),
            (911.01, 911.02),
            (-1e-4, 3e-4),
            (0.0, 1e7),
        ] {
            let (ticks, digits) = axis(min, max).ticks();
            assert!((4..=9).contains(&ticks.len()), "{ticks:?}");
            for tick in ticks {
                assert!(tick >= min && tick <= max);
                let shown: f64 = format!("{tick:.digits$}").parse().unwrap();
                assert!(
                    (shown - tick).abs() < 1e-6 * (max - min),
                    "{tick} shown as {shown}"
                );
            }
        }
    }

    #[test]
    fn sixty_seconds_are_ticked_in_tens() {
        let (ticks, digits) = axis(0.0, 60.0).ticks();
        assert_eq!(
            (ticks, digits),
            (vec![0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0], 0)
        );
    }

    #[test]
    fn a_number_in_a_label_has_no_idle_digits() {
        assert_eq!(plain(60.0), "60");
        assert_eq!(plain(0.25), "0.25");
        assert_eq!(plain(100.0004), "100");
    }

    #[test]
    fn a_tick_at_zero_has_no_sign() {
        assert_eq!(label(-0.0, 1), "0.0");
        assert_eq!(label(-1e-17, 0), "0");
        assert_eq!(label(-2.5, 1), "−2.5");
    }
}
