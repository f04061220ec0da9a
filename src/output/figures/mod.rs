//! Figures of a run as SVG: profile against the static catenary, plan, tension, end force and bending in time; for beams in free flight, their shapes
//! and conserved quantities.
//!
//! Text uses the viewer's sans-serif font, so that drawing needs no font files.

pub mod agreement;
pub mod axis;
pub mod chart;
pub mod compared;
mod flight;
mod labels;
pub mod modes;

use axis::{Axis, ends, force_unit};
use chart::{Chart, Curve, Stroke};

use super::record::{ELEVATION, Node, Record};

/// Widest figure [px].
pub const WIDTH: u32 = 900;
/// Height of a chart of one history [px].
const HISTORY_HEIGHT: u32 = 340;
/// Greatest number of shapes drawn faintly to show how far the lines move.
const TRACES_MAX: usize = 24;
/// Greatest number of lines with a dashed level of their static catenary in the tension history: more would hide the histories.
const LEVELS_MAX: usize = 3;
/// Ratio of the width of a system across its principal direction to its length above which a plan is drawn [-].
const PLAN_RATIO: f64 = 0.01;

/// Okabe and Ito's palette without its yellow, which is too pale for a line: distinguishable with every kind of
/// colour vision.
/// Source: Okabe & Ito 2008, "Color Universal Design".
const PALETTE: [[u8; 3]; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [0, 0, 0],
];
/// Colour of the reference of a comparison.
pub const DARK: [u8; 3] = [40, 40, 40];
const SEABED: [u8; 3] = [139, 110, 70];
const WATER: [u8; 3] = [86, 140, 190];

/// Colour of a curve by its number.
pub fn colour(index: usize) -> [u8; 3] {
    PALETTE[index % PALETTE.len()]
}

/// Stems of the files of all figures.
pub(super) const STEMS: [&str; 8] = [
    "profile", "plan", "tension", "force", "bending", "waves", "flight", "balance",
];

/// Draws every figure for which the record has data; returns file stems and SVG.
pub fn all(record: &Record) -> Vec<(&'static str, String)> {
    if record.course.is_flight() {
        let figures = [
            ("flight", flight::shapes(record)),
            ("balance", flight::balance(record)),
        ];
        return drawn(figures.into());
    }
    drawn(vec![
        ("profile", profile(record)),
        ("plan", plan(record)),
        ("tension", tension(record)),
        ("force", force(record)),
        ("bending", bending(record)),
        ("waves", waves(record)),
    ])
}

fn drawn(figures: Vec<(&'static str, Option<String>)>) -> Vec<(&'static str, String)> {
    let figures = figures.into_iter();
    figures.filter_map(|(stem, svg)| Some((stem, svg?))).collect()
}

/// Lines seen from the side, with the same scale in both directions: the closed-form catenary dashed, the equilibrium, the last shape, and faint
/// traces of the motion between them. `None` without frames.
pub fn profile(record: &Record) -> Option<String> {
    let (cos, sin) = principal_direction(record);
    let view = |[x, y, z]: [f64; 3]| [x * cos + y * sin, z];
    let mut curves = shapes(record, view)?;
    let x = Axis::around(&curves, 0, direction_label(cos, sin));
    for (height, label, colour) in levels(record, &curves) {
        let ends = [[x.min, height], [x.max, height]];
        curves.push(Curve::new(ends.to_vec(), colour, Stroke::Level).named(label));
    }
    let y = Axis::around(&curves, 1, "z [m]".to_string());
    let title = with_title("Line profile", &record.title);
    Some(Chart::to_scale(title, x, y, curves).svg())
}

/// Lines seen from above. `None` if they lie in one vertical plane or there are no frames.
pub fn plan(record: &Record) -> Option<String> {
    let (cos, sin) = principal_direction(record);
    let spread = |along: [f64; 2]| {
        let nodes = record.course.nodes();
        let (min, max) = ends(nodes.map(|n| n.position[0] * along[0] + n.position[1] * along[1]));
        max - min
    };
    if spread([-sin, cos]) <= PLAN_RATIO * spread([cos, sin]) {
        return None;
    }
    let curves = shapes(record, |[x, y, _]| [x, y])?;
    let x = Axis::around(&curves, 0, "x [m]".to_string());
    let y = Axis::around(&curves, 1, "y [m]".to_string());
    Some(Chart::to_scale(with_title("Plan", &record.title), x, y, curves).svg())
}

/// Tension at end B of every line in time, with the static catenary's as a dashed level. `None` without a history.
pub fn tension(record: &Record) -> Option<String> {
    let mut curves = of_lines(record, "tension_b", |index| match index < PALETTE.len() {
        true => Stroke::Bold,
        false => Stroke::Dashed,
    });
    if record.lines.len() <= LEVELS_MAX {
        for (index, line) in record.lines.iter().enumerate() {
            if let (Some(catenary), [[start, ..], .., [end, ..]]) =
                (&line.catenary, curves.first()?.points.as_slice())
            {
                let level = catenary.figures.tension_b;
                let ends = vec![[*start, level], [*end, level]];
                let name = format!("{}, static catenary", line.name);
                curves.push(Curve::new(ends, colour(index), Stroke::Dashed).named(&name));
            }
        }
    }
    let title = with_title("Tension at end B", &record.title);
    Some(in_newtons(title, |unit| format!("tension [{unit}]"), curves)?.svg())
}

/// Components of the end force on the vessel in time, a chart for every fairlead. `None` without a history.
pub fn force(record: &Record) -> Option<String> {
    let chart = |point: &String| {
        let components = ["fx", "fy", "fz"].iter().enumerate();
        let curves = components.filter_map(|(index, component)| {
            let history = record.history(&format!("{point}.{component}"))?;
            Some(Curve::new(history, colour(index), Stroke::Bold).named(component))
        });
        let title = format!("Force of the mooring on the vessel at {point}");
        in_newtons(title, |unit| format!("force [{unit}]"), curves.collect())
    };
    let charts: Vec<Chart> = record.points.iter().filter_map(chart).collect();
    (!charts.is_empty()).then(|| chart::stacked_svg(&charts))
}

/// Greatest curvature and bending moment along every line that bends, in time. `None` if no line bends.
pub fn bending(record: &Record) -> Option<String> {
    let histories = |result: &str| of_lines(record, result, |_| Stroke::Bold);
    let curves = histories("curvature_max");
    if curves.is_empty() {
        return None;
    }
    let title = with_title("Greatest curvature", &record.title);
    let curvature = in_time(title, "curvature [1/m]".to_string(), curves);
    let title = "Greatest bending moment".to_string();
    let label = |unit: &str| format!("moment [{unit} m]");
    let moment = in_newtons(title, label, histories("moment_max"))?;
    Some(chart::stacked_svg(&[curvature, moment]))
}

/// Curves of a result for every line that has it; `stroke` returns the stroke for the index of a line.
fn of_lines(record: &Record, result: &str, stroke: impl Fn(usize) -> Stroke) -> Vec<Curve> {
    let lines = record.lines.iter().enumerate();
    let curves = lines.filter_map(|(index, line)| {
        let history = record.history(&format!("{}.{result}", line.name))?;
        Some(Curve::new(history, colour(index), stroke(index)).named(&line.name))
    });
    curves.collect()
}

/// Elevation of the surface in time. `None` without waves.
pub fn waves(record: &Record) -> Option<String> {
    let history = record.history(ELEVATION)?;
    let curves = vec![Curve::new(history, WATER, Stroke::Bold)];
    let title = with_title("Surface at x = y = 0", &record.title);
    Some(in_time(title, "elevation [m]".to_string(), curves).svg())
}

/// Chart of forces [N] or moments [N m] in time [s], in a suitable multiple of the newton, whose name is passed to `label`. `None` without a finite value.
fn in_newtons(title: String, label: impl Fn(&str) -> String, mut curves: Vec<Curve>) -> Option<Chart> {
    let values = curves.iter().flat_map(|c| &c.points).map(|p| p[1].abs());
    let greatest = values.filter(|v| v.is_finite()).fold(f64::NAN, f64::max);
    if greatest.is_nan() {
        return None;
    }
    let (unit, size) = force_unit(greatest);
    for point in curves.iter_mut().flat_map(|c| &mut c.points) {
        point[1] /= size;
    }
    Some(in_time(title, label(unit), curves))
}

fn in_time(title: String, label: String, curves: Vec<Curve>) -> Chart {
    let x = Axis::fitting(&curves, 0, "time [s]".to_string());
    let y = Axis::around(&curves, 1, label);
    Chart::new(title, x, y, curves, WIDTH, HISTORY_HEIGHT)
}

fn with_title(what: &str, title: &str) -> String {
    match title {
        "" => what.to_string(),
        title => format!("{what}: {title}"),
    }
}

/// Curves of the lines' shapes, projected by `view`. `None` without frames.
fn shapes(record: &Record, view: impl Fn([f64; 3]) -> [f64; 2]) -> Option<Vec<Curve>> {
    let (first, last) = (record.course.frames.first()?, record.course.frames.last()?);
    let seen = |nodes: &[Node]| nodes.iter().map(|n| view(n.position)).collect::<Vec<_>>();
    let mut curves = Vec::new();
    let stride = record.course.frames.len().div_ceil(TRACES_MAX);
    for frame in record.course.frames.iter().step_by(stride) {
        for (index, nodes) in frame.lines.iter().enumerate() {
            curves.push(Curve::new(seen(nodes), colour(index), Stroke::Faint));
        }
    }
    for (index, (line, nodes)) in record.lines.iter().zip(&last.lines).enumerate() {
        let name = format!("{}, t = {} s", line.name, axis::plain(last.time));
        curves.push(Curve::new(seen(nodes), colour(index), Stroke::Bold).named(&name));
    }
    for (index, nodes) in first.lines.iter().enumerate() {
        let name = if index == 0 { "nodes at t = 0" } else { "" };
        curves.push(Curve::new(seen(nodes), DARK, Stroke::Nodes).named(name));
    }
    for (index, line) in record.lines.iter().enumerate() {
        let Some(catenary) = &line.catenary else {
            continue;
        };
        let points = catenary.profile.iter().map(|&point| view(point)).collect();
        let name = if index == 0 { "static catenary" } else { "" };
        curves.push(Curve::new(points, DARK, Stroke::Dashed).named(name));
    }
    Some(curves)
}

/// Still water and seabed, if the lines are near them: height [m], label, colour.
fn levels(record: &Record, curves: &[Curve]) -> Vec<(f64, &'static str, [u8; 3])> {
    let y = Axis::around(curves, 1, String::new());
    let near = |height: f64| {
        let margin = 0.25 * (y.max - y.min);
        (y.min - margin..=y.max + margin).contains(&height)
    };
    let water = record.surroundings.water.then_some((0.0, "still water", WATER));
    let seabed = record.surroundings.seabed.map(|z| (z, "seabed", SEABED));
    water
        .into_iter()
        .chain(seabed)
        .filter(|level| near(level.0))
        .collect()
}

/// Direction (cos, sin) in plan along which the lines extend furthest, towards +x: the principal axis of the first frame's nodes. The direction is x
/// for a system with equal extent in all directions.
fn principal_direction(record: &Record) -> (f64, f64) {
    let Some(frame) = record.course.frames.first() else {
        return (1.0, 0.0);
    };
    let nodes = || frame.lines.iter().flatten().map(|n| n.position);
    let count = nodes().count().max(1) as f64;
    let mean = |axis: usize| nodes().map(|p| p[axis]).sum::<f64>() / count;
    let (x0, y0) = (mean(0), mean(1));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for [x, y, _] in nodes() {
        xx += (x - x0) * (x - x0);
        xy += (x - x0) * (y - y0);
        yy += (y - y0) * (y - y0);
    }
    // If half the difference of the two principal moments is small, no direction is distinguished.
    if (0.5 * (xx - yy)).hypot(xy) <= 1e-6 * (xx + yy) {
        return (1.0, 0.0);
    }
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    (angle.cos(), angle.sin())
}

fn direction_label(cos: f64, sin: f64) -> String {
    if sin.abs() < 1e-6 {
        return "x [m]".to_string();
    }
    if cos.abs() < 1e-6 {
        return if sin > 0.0 { "y [m]" } else { "-y [m]" }.to_string();
    }
    let degrees = sin.atan2(cos).to_degrees();
    format!("horizontal distance at {degrees:.1}° from x [m]")
}

#[cfg(test)]
mod tests {
    use super::super::record::{Column, Form};
    use super::super::sample;
    use super::*;
    use quick_xml::{Reader, events::Event};

    /// Fails unless the SVG is well-formed XML; returns its texts.
    fn texts(svg: &str) -> Vec<String> {
        let mut reader = Reader::from_str(svg);
        let mut texts = Vec::new();
        loop {
            match reader.read_event().unwrap() {
                Event::Text(text) => {
                    let text = text.trim().to_string();
                    texts.extend((!text.is_empty()).then_some(text));
                }
                Event::Eof => return texts,
                _ => {}
            }
        }
    }

    #[test]
    fn every_figure_is_well_formed_and_names_its_quantities_and_units() {
        let record = sample::record();
        let labels = |svg: Option<String>| texts(&svg.unwrap());
        let profile = labels(profile(&record));
        for label in [
            "x [m]",
            "z [m]",
            "seabed",
            "still water",
            "static catenary",
            "line1, t = 60 s",
        ] {
            assert!(profile.iter().any(|t| t == label), "{label} in {profile:?}");
        }
        let tension = labels(tension(&record));
        for label in [
            "time [s]",
            "tension [kN]",
            "line1",
            "line2",
            "line2, static catenary",
        ] {
            assert!(tension.iter().any(|t| t == label), "{label} in {tension:?}");
        }
        let force = labels(force(&record));
        for label in ["force [kN]", "fx", "fy", "fz"] {
            assert!(force.iter().any(|t| t == label), "{label} in {force:?}");
        }
    }

    #[test]
    fn lines_that_bend_have_a_figure_of_it_and_others_none() {
        let sample = sample::record();
        assert_eq!(bending(&sample), None);
        let names = ["line1.curvature_max", "line1.moment_max"];
        let columns = names.map(|name| Column::new(name, "", "", Form::Real));
        let mut record = Record::new("", columns.into(), 2);
        record.lines = sample.lines;
        record.add_row(&[0.0, 0.1, 8e3]);
        record.add_row(&[1.0, 0.2, 16e3]);
        let labels = texts(&bending(&record).unwrap());
        for label in ["curvature [1/m]", "moment [kN m]", "line1"] {
            assert!(labels.iter().any(|t| t == label), "{label} in {labels:?}");
        }
    }

    #[test]
    fn waves_have_a_figure_and_still_water_has_none() {
        assert_eq!(waves(&sample::record()), None);
        let column = Column::new(ELEVATION, "m", "", Form::Real);
        let mut record = Record::new("", vec![column], 2);
        record.add_row(&[0.0, 1.5]);
        record.add_row(&[1.0, -0.5]);
        let labels = texts(&waves(&record).unwrap());
        assert!(labels.iter().any(|t| t == "elevation [m]"), "{labels:?}");
    }

    #[test]
    fn lines_in_one_vertical_plane_need_no_plan() {
        let mut record = sample::record();
        assert_eq!(plan(&record), None);
        for node in record.course.frames[0].lines[1].iter_mut() {
            node.position[1] += 0.5 * node.position[0];
        }
        assert!(plan(&record).is_some());
    }

    #[test]
    fn a_line_is_seen_across_its_own_plane() {
        let mut record = sample::record();
        record.lines.truncate(1);
        for frame in &mut record.course.frames {
            frame.lines.truncate(1);
            for node in &mut frame.lines[0] {
                let [x, _, z] = node.position;
                node.position = [0.6 * x, 0.8 * x, z];
            }
        }
        let (cos, sin) = principal_direction(&record);
        assert!((cos - 0.6).abs() < 1e-9 && (sin - 0.8).abs() < 1e-9);
        assert_eq!(
            direction_label(cos, sin),
            "horizontal distance at 53.1° from x [m]"
        );
    }

    #[test]
    fn an_empty_record_has_no_figures() {
        assert!(all(&Record::new("", vec![], 0)).is_empty());
    }

    #[test]
    fn a_name_with_markup_stays_text() {
        let mut record = sample::record();
        record.title = "<script>&\"".to_string();
        let svg = profile(&record).unwrap();
        assert!(!svg.contains("<script>"));
        assert!(
            texts(&svg)
                .iter()
                .any(|t| t.contains("&lt;script&gt;") || t.contains("script"))
        );
    }
}
