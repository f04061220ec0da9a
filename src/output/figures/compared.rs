//! Comparisons of curves, such as histories of several runs, closed forms and shapes, in stacked charts.

use super::axis::Axis;
use super::chart::{Chart, Curve, Stroke, stacked_svg};
use super::{DARK, HISTORY_HEIGHT, WIDTH, colour};

/// Style of a series.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Look {
    /// A full line in a separate colour.
    #[default]
    Line,
    /// Dashes in dark grey: the reference of the comparison.
    Reference,
    /// Discs in a separate colour.
    Discs,
    /// A pale line in the colour of the previous series, without a name.
    Trace,
}

/// One curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Name in the legend; no entry if empty.
    pub name: String,
    /// Points, in the units of the panel's axes.
    pub points: Vec<[f64; 2]>,
    /// Style of the series.
    pub look: Look,
}

/// One chart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// Names and units of the horizontal and the vertical axis.
    pub axes: [String; 2],
    /// True if both axes have the same scale.
    pub to_scale: bool,
    /// Curves.
    pub series: Vec<Series>,
}

/// Stacks the charts in an SVG document. `None` without charts, or if a chart has no finite point.
pub fn compared(panels: &[Panel]) -> Option<String> {
    let charts: Option<Vec<Chart>> = panels.iter().map(chart).collect();
    charts
        .filter(|charts| !charts.is_empty())
        .map(|charts| stacked_svg(&charts))
}

fn chart(panel: &Panel) -> Option<Chart> {
    let points = || panel.series.iter().flat_map(|series| &series.points);
    if !points().any(|point| point.iter().all(|value| value.is_finite())) {
        return None;
    }
    let mut coloured = 0;
    let curves: Vec<Curve> = panel
        .series
        .iter()
        .map(|series| {
            if matches!(series.look, Look::Line | Look::Discs) {
                coloured += 1;
            }
            let own = colour(coloured.max(1) - 1);
            let (colour, stroke) = match series.look {
                Look::Line => (own, Stroke::Bold),
                Look::Reference => (DARK, Stroke::Dashed),
                Look::Discs => (own, Stroke::Marks),
                Look::Trace => (own, Stroke::Faint),
            };
            Curve::new(series.points.clone(), colour, stroke).named(&series.name)
        })
        .collect();
    let [x, y] = panel.axes.clone();
    let vertical = Axis::around(&curves, 1, y);
    let title = panel.title.clone();
    Some(if panel.to_scale {
        Chart::to_scale(title, Axis::around(&curves, 0, x), vertical, curves)
    } else {
        let horizontal = Axis::fitting(&curves, 0, x);
        Chart::new(title, horizontal, vertical, curves, WIDTH, HISTORY_HEIGHT)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(points: Vec<[f64; 2]>) -> Panel {
        Panel {
            title: "pull of a chain".to_string(),
            axes: ["time [s]", "pull [N]"].map(str::to_string),
            series: vec![Series {
                name: "leapfrog".to_string(),
                points,
                look: Look::Line,
            }],
            ..Panel::default()
        }
    }

    #[test]
    fn every_panel_has_its_title_axes_and_names_and_an_empty_one_is_no_figure() {
        let full = panel(vec![[0.0, 1.0], [1.0, 3.0]]);
        let svg = compared(&[full.clone(), full.clone()]).unwrap();
        for text in ["pull of a chain", "time [s]", "pull [N]", "leapfrog"] {
            assert_eq!(svg.matches(text).count(), 2, "{text}");
        }
        assert_eq!(compared(&[full, panel(vec![])]), None);
        assert_eq!(compared(&[]), None);
    }
}
