//! One chart: title, legend, axes, curves, as SVG.

use std::fmt::Write;

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::super::trace::Trace;
use super::axis::Axis;
use super::labels::{self, Label, Patch};

/// Units of the drawing per pixel: the backend rounds to whole units, which would show as steps in a curve.
const FINE: u32 = 4;
/// Space between the frame and the right and lower edge [px].
const MARGIN: u32 = 18;
/// Space between the left edge and the name of the vertical axis [px].
const EDGE: u32 = 8;
/// Width from the left edge to the frame: edge, name and ticks of the vertical axis [px].
const LABELS_LEFT: u32 = 80;
/// Height of the labels below the frame [px].
const LABELS_BELOW: u32 = 48;
/// Height of the title [px].
const TITLE: u32 = 34;
/// Height of a row of the legend [px].
const LEGEND_ROW: u32 = 20;
/// Width of a stroke sample in the legend [px].
const SAMPLE: u32 = 26;
/// Size of text [px].
const TEXT: u32 = 13;
/// Text size of labels at points [px].
const LABEL: f64 = 12.0;
/// Mean width of a letter relative to the text size, rounded up generously [-].
const LETTER: f64 = 0.58;
/// Least and greatest height of a chart to scale, without title and legend [px].
const TO_SCALE_HEIGHTS: [f64; 2] = [150.0, 560.0];
/// Ratio of the text size in the plotting library, which rounds layout to the size it is given, to that in the SVG.
const TEXT_SCALE: f64 = 1.24;

/// Stroke of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// A full line.
    Bold,
    /// Dashes.
    Dashed,
    /// A thin full line.
    Fine,
    /// A thin pale line.
    Faint,
    /// A straight level: still water, seabed.
    Level,
    /// Small rings at the points.
    Nodes,
    /// Discs at the points.
    Marks,
    /// The rectangle between the first two points.
    Band,
}

/// A curve of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Points, in the units of the axes.
    pub points: Vec<[f64; 2]>,
    /// Name in the legend; no entry if empty.
    pub name: String,
    /// Labels at the points; no labels if empty.
    labels: Vec<String>,
    behind: bool,
    colour: [u8; 3],
    stroke: Stroke,
}

impl Curve {
    /// Creates a curve without a name.
    pub fn new(points: Vec<[f64; 2]>, colour: [u8; 3], stroke: Stroke) -> Curve {
        Curve {
            points,
            name: String::new(),
            labels: Vec::new(),
            behind: matches!(stroke, Stroke::Faint | Stroke::Level | Stroke::Band),
            colour,
            stroke,
        }
    }

    /// Returns the curve with a name for the legend.
    pub fn named(mut self, name: &str) -> Curve {
        self.name = name.to_string();
        self
    }

    /// Returns the curve with labels at its points, in order.
    pub fn labelled(mut self, labels: Vec<String>) -> Curve {
        self.labels = labels;
        self
    }

    /// Returns the curve without non-finite values and with few points, so that a figure stays small.
    fn thinned(mut self) -> Curve {
        self.points = Trace::of(&self.points).points();
        self
    }

    fn style(&self) -> ShapeStyle {
        let [r, g, b] = self.colour;
        let (opacity, width) = match self.stroke {
            Stroke::Bold => (1.0, 1.8),
            Stroke::Dashed => (0.9, 1.4),
            Stroke::Fine => (1.0, 1.2),
            Stroke::Faint => (0.22, 1.0),
            Stroke::Level => (1.0, 1.4),
            Stroke::Nodes => (0.75, 1.0),
            Stroke::Marks => (0.85, 1.0),
            Stroke::Band => (0.10, 1.0),
        };
        RGBColor(r, g, b).mix(opacity).stroke_width(fine_f(width))
    }
}

/// A chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    title: String,
    x: Axis,
    y: Axis,
    curves: Vec<Curve>,
    /// Width [px].
    width: u32,
    /// Height of frame and axis labels, without title and legend [px].
    height: u32,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type DrawResult = Result<(), DrawingAreaErrorKind<std::io::Error>>;

fn fine(pixels: u32) -> i32 {
    (pixels * FINE) as i32
}

fn fine_f(pixels: f64) -> u32 {
    (pixels * f64::from(FINE)).round() as u32
}

impl Chart {
    /// Creates a chart of a given width [px]; `height` [px] is that of the frame with its axis labels.
    pub fn new(title: String, x: Axis, y: Axis, curves: Vec<Curve>, width: u32, height: u32) -> Chart {
        Chart {
            title,
            x,
            y,
            curves: curves.into_iter().map(Curve::thinned).collect(),
            width,
            height,
        }
    }

    /// Creates a chart with the same scale in both directions: the axis with spare room is widened.
    pub fn to_scale(title: String, mut x: Axis, mut y: Axis, curves: Vec<Curve>) -> Chart {
        let frame_width = f64::from(super::WIDTH - LABELS_LEFT - MARGIN);
        let [lowest, highest] = TO_SCALE_HEIGHTS;
        let wanted = (y.max - y.min) / (x.max - x.min) * frame_width;
        let frame_height = wanted.clamp(lowest, highest).round();
        x.widen((y.max - y.min) / frame_height * frame_width);
        y.widen((x.max - x.min) / frame_width * frame_height);
        let height = frame_height as u32 + LABELS_BELOW;
        Chart::new(title, x, y, curves, super::WIDTH, height)
    }

    /// Returns the chart as an SVG document.
    pub fn svg(&self) -> String {
        stacked_svg(std::slice::from_ref(self))
    }

    /// Positions of the legend's entries: left edge [px] and row.
    fn legend(&self) -> Vec<(&Curve, u32, u32)> {
        let named = self.curves.iter().filter(|curve| !curve.name.is_empty());
        entries(named, self.width)
    }

    fn total_height(&self) -> u32 {
        let rows = self.legend().last().map_or(0, |&(_, _, row)| row + 1);
        TITLE + rows * LEGEND_ROW + 8 + self.height
    }

    fn draw(&self, area: &Area) -> DrawResult {
        let title = text_style(15.0).color(&RGBColor(20, 20, 20));
        area.draw_text(&self.short_title(), &title, (fine(LABELS_LEFT), fine(12)))?;
        for (curve, left, row) in self.legend() {
            draw_entry(area, curve, left, TITLE + row * LEGEND_ROW + LEGEND_ROW / 2)?;
        }
        self.draw_frame(area)
    }

    /// Title, shortened to fit into the figure.
    fn short_title(&self) -> String {
        let room = f64::from(self.width - LABELS_LEFT - MARGIN) / (LETTER * 15.0);
        if self.title.chars().count() as f64 <= room {
            return self.title.clone();
        }
        let kept: String = self.title.chars().take(room as usize - 1).collect();
        format!("{}…", kept.trim_end())
    }

    fn draw_frame(&self, area: &Area) -> DrawResult {
        let mut chart = ChartBuilder::on(area)
            .margin_top(fine(self.total_height() - self.height))
            .margin_right(fine(MARGIN))
            .margin_left(fine(EDGE))
            .set_label_area_size(LabelAreaPosition::Left, fine(LABELS_LEFT - EDGE))
            .set_label_area_size(LabelAreaPosition::Bottom, fine(LABELS_BELOW))
            .build_cartesian_2d(self.x.clone(), self.y.clone())?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .bold_line_style(RGBColor(225, 225, 225).stroke_width(fine_f(0.8)))
            .axis_style(RGBColor(110, 110, 110).stroke_width(fine_f(1.0)))
            .light_line_style(TRANSPARENT)
            .set_all_tick_mark_size(fine(5))
            .label_style(text_style(12.0).color(&RGBColor(70, 70, 70)))
            .axis_desc_style(text_style(f64::from(TEXT)).color(&RGBColor(20, 20, 20)))
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .draw()?;
        let (behind, before): (Vec<&Curve>, _) = self.curves.iter().partition(|c| c.behind);
        for curve in behind.into_iter().chain(before) {
            let points = || curve.points.iter().map(|&[x, y]| (x, y));
            let style = curve.style();
            match curve.stroke {
                Stroke::Bold | Stroke::Fine | Stroke::Faint | Stroke::Level => {
                    chart.draw_series(LineSeries::new(points(), style))?;
                }
                Stroke::Dashed => {
                    chart.draw_series(DashedLineSeries::new(points(), fine(7), fine(4), style))?;
                }
                Stroke::Nodes => {
                    chart.draw_series(points().map(|p| Circle::new(p, fine_f(2.2), style)))?;
                }
                Stroke::Marks => {
                    let disc = |p| Circle::new(p, fine_f(3.4), style.filled());
                    chart.draw_series(points().map(disc))?;
                }
                Stroke::Band => {
                    let corners: Vec<(f64, f64)> = points().take(2).collect();
                    if let [from, to] = corners[..] {
                        let rectangle = Rectangle::new([from, to], style.filled());
                        chart.draw_series([rectangle])?;
                    }
                }
            };
        }
        let place = |point: &[f64; 2]| chart.backend_coord(&(point[0], point[1]));
        let (width, height) = chart.plotting_area().dim_in_pixel();
        let (left, top) = chart.plotting_area().get_base_pixel();
        let frame = Patch {
            low: [left, top],
            high: [left + width as i32, top + height as i32],
        };
        self.draw_labels(area, &frame, |point| place(point).into())
    }

    /// Draws labels at points, within the frame and clear of each other, of marks and, if there is room, of bold curves.
    fn draw_labels(&self, area: &Area, frame: &Patch, place: impl Fn(&[f64; 2]) -> [i32; 2]) -> DrawResult {
        let marks = self.curves.iter().filter(|c| c.stroke == Stroke::Marks);
        let marks = marks.flat_map(|curve| &curve.points);
        let mut marks: Vec<Patch> = marks
            .map(|point| Patch::around(place(point), [fine(4); 2]))
            .collect();
        for curve in self.curves.iter().filter(|c| c.stroke == Stroke::Bold) {
            let points: Vec<[i32; 2]> = curve.points.iter().map(&place).collect();
            marks.extend(labels::along(&points, fine(2)));
        }
        let words: Vec<(&Curve, &[f64; 2], &String)> = self
            .curves
            .iter()
            .flat_map(|curve| {
                let words = curve.points.iter().zip(&curve.labels);
                words.map(move |(point, label)| (curve, point, label))
            })
            .filter(|(_, _, label)| !label.is_empty())
            .collect();
        let labels: Vec<Label> = words
            .iter()
            .map(|(_, point, label)| {
                // One letter more: × and % are wide, and words side by side need a gap.
                let letters = (label.chars().count() + 1) as f64;
                Label {
                    point: place(point),
                    size: [fine_f(LETTER * LABEL * letters) as i32, fine(14)],
                }
            })
            .collect();
        let places = labels::placed(frame, &marks, &labels, fine(6));
        for ((curve, _, label), patch) in words.into_iter().zip(&places) {
            draw_label(area, label, curve.colour, patch)?;
        }
        Ok(())
    }
}

/// Draws a label on white, so that curves do not run through its text.
fn draw_label(area: &Area, label: &str, colour: [u8; 3], patch: &Patch) -> DrawResult {
    let (left, top) = area.get_base_pixel();
    let [low, high] = [patch.low, patch.high].map(|[x, y]| (x - left, y - top));
    area.draw(&Rectangle::new([low, high], WHITE.mix(0.7).filled()))?;
    let [r, g, b] = colour;
    let colour = RGBColor(r, g, b);
    let text = text_behind(LABEL, &colour);
    let middle = (low.1 + high.1) / 2;
    area.draw_text(label, &text, (low.0 + fine(1), middle))
}

/// Positions of the entries of a legend of a given width [px]: left edge [px] and row.
fn entries<'a>(curves: impl Iterator<Item = &'a Curve>, wide: u32) -> Vec<(&'a Curve, u32, u32)> {
    let (mut left, mut row) = (LABELS_LEFT, 0);
    let mut places = Vec::new();
    for curve in curves {
        let letters = curve.name.chars().count() as f64;
        let width = SAMPLE + 6 + (letters * LETTER * f64::from(TEXT)) as u32 + 14;
        if left + width > wide && left > LABELS_LEFT {
            (left, row) = (LABELS_LEFT, row + 1);
        }
        places.push((curve, left, row));
        left += width;
    }
    places
}

fn text_style(pixels: f64) -> TextStyle<'static> {
    let size = pixels * f64::from(FINE) * TEXT_SCALE;
    TextStyle::from(("sans-serif", size).into_font())
}

/// Style of text that begins at a point and is centred on it vertically.
fn text_behind(pixels: f64, colour: &RGBColor) -> TextStyle<'_> {
    let text = text_style(pixels).color(colour);
    text.pos(Pos::new(HPos::Left, VPos::Center))
}

fn draw_entry(area: &Area, curve: &Curve, left: u32, middle: u32) -> DrawResult {
    let style = curve.style();
    let (x0, x1, y) = (fine(left), fine(left + SAMPLE), fine(middle));
    match curve.stroke {
        Stroke::Bold | Stroke::Fine | Stroke::Faint | Stroke::Level => {
            area.draw(&PathElement::new([(x0, y), (x1, y)], style))?;
        }
        Stroke::Dashed => {
            let ends = [(x0, y), (x1, y)];
            area.draw(&DashedPathElement::new(ends, fine(7), fine(4), style))?;
        }
        Stroke::Nodes => {
            area.draw(&Circle::new(((x0 + x1) / 2, y), fine_f(2.6), style))?;
        }
        Stroke::Marks => {
            let disc = Circle::new(((x0 + x1) / 2, y), fine_f(3.4), style.filled());
            area.draw(&disc)?;
        }
        Stroke::Band => {
            let corners = [(x0, y - fine(5)), (x1, y + fine(5))];
            area.draw(&Rectangle::new(corners, style.filled()))?;
        }
    }
    let text = text_behind(f64::from(TEXT), &RGBColor(40, 40, 40));
    area.draw_text(&curve.name, &text, (fine(left + SAMPLE + 6), y))
}

/// Stacks charts in one SVG document.
pub fn stacked_svg(charts: &[Chart]) -> String {
    grid_svg(&[], charts, 1)
}

/// Arranges charts of one size in `columns` columns below a common legend, in one SVG document.
pub fn grid_svg(legend: &[Curve], charts: &[Chart], columns: usize) -> String {
    let rows = || charts.chunks(columns.max(1));
    let sum = |row: &[Chart]| row.iter().map(|chart| chart.width).sum();
    let width = rows().map(sum).max().unwrap_or(0);
    let legend = entries(legend.iter(), width);
    let head = legend
        .last()
        .map_or(0, |&(_, _, row)| (row + 1) * LEGEND_ROW + MARGIN);
    let height: u32 = head + rows().map(row_height).sum::<u32>();
    let mut svg = String::new();
    draw_grid(&mut svg, &legend, rows(), [width, height, head]).expect("drawing into a string does not fail");
    // The drawing is FINE times as large as the figure; round joins prevent spikes at sharp peaks.
    let end_of_head = svg.find('>').map_or(0, |end| end + 1);
    let mut head = String::new();
    write!(
        head,
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {} {}" "#,
        width * FINE,
        height * FINE
    )
    .expect("writing into a string does not fail");
    head.push_str(r#"role="img" stroke-linejoin="round" stroke-linecap="round">"#);
    svg.replace_range(..end_of_head, &head);
    svg
}

fn row_height(row: &[Chart]) -> u32 {
    row.iter().map(Chart::total_height).max().unwrap_or(0)
}

/// Draws rows of charts below a legend; the last three numbers are width, height and height of the legend [px].
fn draw_grid<'a>(
    svg: &mut String,
    legend: &[(&Curve, u32, u32)],
    rows: impl Iterator<Item = &'a [Chart]>,
    [width, height, head]: [u32; 3],
) -> DrawResult {
    let root = SVGBackend::with_string(svg, (width * FINE, height * FINE)).into_drawing_area();
    root.fill(&WHITE)?;
    for &(curve, left, row) in legend {
        draw_entry(&root, curve, left, MARGIN + row * LEGEND_ROW)?;
    }
    let (_, mut rest) = root.split_vertically(fine(head));
    for row in rows {
        let (mut line, below) = rest.split_vertically(fine(row_height(row)));
        for chart in row {
            let (left, right) = line.split_horizontally(fine(chart.width));
            chart.draw(&left)?;
            line = right;
        }
        rest = below;
    }
    root.present()
}

#[cfg(test)]
mod tests {
    use super::super::axis::Scale;
    use super::*;

    #[test]
    fn a_thinned_history_keeps_its_peaks() {
        let mut points: Vec<[f64; 2]> = (0..100_000).map(|i| [f64::from(i), 0.0]).collect();
        points[54_321][1] = 9.0;
        points[12_345][1] = -7.0;
        points[3][1] = f64::NAN;
        let curve = Curve::new(points, [0; 3], Stroke::Bold).thinned();
        assert!(curve.points.len() <= crate::output::trace::POINTS_MAX);
        assert!(curve.points.contains(&[54_321.0, 9.0]));
        assert!(curve.points.contains(&[12_345.0, -7.0]));
        assert!(curve.points.is_sorted_by(|a, b| a[0] < b[0]));
    }

    #[test]
    fn a_chart_to_scale_has_one_scale() {
        let axis = |min, max| Axis {
            label: String::new(),
            scale: Scale::Linear,
            min,
            max,
        };
        for (x, y) in [(14.14, 0.72), (0.01, 100.0), (800.0, 200.0), (1.0, 1.0)] {
            let chart = Chart::to_scale(String::new(), axis(0.0, x), axis(-y, 0.0), vec![]);
            let frame = [
                f64::from(chart.width - LABELS_LEFT - MARGIN),
                f64::from(chart.height - LABELS_BELOW),
            ];
            let scale_x = frame[0] / (chart.x.max - chart.x.min);
            let scale_y = frame[1] / (chart.y.max - chart.y.min);
            assert!((scale_x / scale_y - 1.0).abs() < 1e-9, "{scale_x} {scale_y}");
            assert!(chart.x.max >= x && chart.y.min <= -y);
        }
    }
}
