//! Figure of computed against measured values: one disc per condition, and the diagonal of equal values.

use super::axis::{Axis, ends};
use super::chart::{Chart, Curve, Stroke};
use super::{DARK, colour};

/// Width and height of the figure's frame [px].
const SIZE: [u32; 2] = [720, 600];

/// Values of one series of conditions.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Pairs of a measured and a computed value, in the figure's unit.
    pub pairs: Vec<[f64; 2]>,
}

/// Draws the figure as SVG; `quantity` names the measured quantity and its unit. `None` without values.
pub fn agreement(title: &str, quantity: &str, series: &[Series]) -> Option<String> {
    let values = series.iter().flat_map(|one| one.pairs.iter().flatten());
    let (low, high) = ends(values.copied());
    if low > high {
        return None;
    }
    let diagonal = Curve::new(vec![[low, low], [high, high]], DARK, Stroke::Fine).named("equal");
    let discs = series
        .iter()
        .enumerate()
        .map(|(index, one)| Curve::new(one.pairs.clone(), colour(index), Stroke::Marks).named(&one.name));
    let curves: Vec<Curve> = [diagonal].into_iter().chain(discs).collect();
    let x = Axis::around(&curves, 0, format!("{quantity}, measured"));
    let y = Axis::around(&curves, 1, format!("{quantity}, computed"));
    Some(Chart::new(title.to_string(), x, y, curves, SIZE[0], SIZE[1]).svg())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_is_a_disc_and_nothing_is_no_figure() {
        let series = Series {
            name: "T = 2 s".to_string(),
            pairs: vec![[30.0, 31.0], [40.0, 39.0], [50.0, 52.0]],
        };
        let svg = agreement("forces", "force [N]", &[series]).unwrap();
        assert!(svg.matches("<circle").count() >= 3);
        assert!(svg.contains("force [N], measured") && svg.contains("T = 2 s"));
        assert_eq!(agreement("forces", "force [N]", &[]), None);
    }
}
