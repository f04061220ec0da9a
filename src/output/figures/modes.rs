//! Shapes of the lowest natural modes along the lines that move most.

use super::axis::Axis;
use super::chart::{Chart, Curve, Stroke};
use super::{WIDTH, colour, with_title};
use crate::output::modes::{Mode, NaturalModes};
use crate::output::report::rounded;

/// Greatest number of modes drawn.
const SHAPES_MAX: usize = 6;
/// Height of the figure [px].
const HEIGHT: u32 = 420;

/// Displacement of the line that moves most in each of the lowest modes, in its main direction of motion, as SVG. `None` without modes.
pub fn modes(modes: &NaturalModes) -> Option<String> {
    let lowest = modes.modes.iter().take(SHAPES_MAX).enumerate();
    let curves: Vec<Curve> = lowest.filter_map(|(index, mode)| curve(index, mode)).collect();
    if curves.is_empty() {
        return None;
    }
    let title = with_title("Lowest natural modes", &modes.title);
    let x = Axis::around(&curves, 0, "s [m]".to_string());
    let y = Axis::around(&curves, 1, "displacement [-]".to_string());
    Some(Chart::new(title, x, y, curves, WIDTH, HEIGHT).svg())
}

fn curve(index: usize, mode: &Mode) -> Option<Curve> {
    let mut shapes = mode.shapes.iter();
    let shape = shapes.find(|shape| shape.line == mode.greatest.line)?;
    let points = shape
        .nodes
        .iter()
        .map(|node| [node.s, node.along(mode.direction)]);
    let period = mode.period.map_or("no period".to_string(), |period| {
        format!("{} s", rounded(period, 4))
    });
    let name = format!(
        "{}: {period}, {}, {}",
        index + 1,
        shape.line,
        mode.direction.words()
    );
    Some(Curve::new(points.collect(), colour(index), Stroke::Bold).named(&name))
}
