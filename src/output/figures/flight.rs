//! Beams in free flight: stroboscopic shapes, and the conserved quantities of such a flight.

use super::super::record::FlightQuantity;
use super::axis::{Axis, ends, plain};
use super::chart::{self, Chart, Curve, Stroke};
use super::{Record, TRACES_MAX, colour, in_time, with_title};

/// Ratio of the spread along an axis to the greatest spread below which views along this axis are omitted [-].
const VIEW_RATIO: f64 = 0.01;
/// First and last colour of the shapes.
const TIMES: [[u8; 3]; 2] = [[176, 205, 228], [0, 66, 112]];

/// Names of the axes.
const AXES: [&str; 3] = ["x [m]", "y [m]", "z [m]"];

/// Shapes at equal intervals of time, from pale to dark, with the paths of both ends, in at most two pairs of axes along which the beams spread.
/// `None` if the run is not a free flight.
pub(super) fn shapes(record: &Record) -> Option<String> {
    record.course.is_flight().then_some(())?;
    let spread = [0, 1, 2].map(|axis| {
        let (min, max) = ends(record.course.nodes().map(|node| node.position[axis]));
        max - min
    });
    let widest = spread.iter().copied().fold(0.0, f64::max);
    let seen = |axis: usize| spread[axis] > VIEW_RATIO * widest;
    let views = [[0, 1], [0, 2], [1, 2]];
    let charts: Vec<Chart> = views
        .into_iter()
        .filter(|&[across, up]| seen(across) && seen(up))
        .take(2)
        .map(|view| view_chart(record, view))
        .collect();
    (!charts.is_empty()).then(|| chart::stacked_svg(&charts))
}

fn view_chart(record: &Record, [across, up]: [usize; 2]) -> Chart {
    let view = |position: [f64; 3]| [position[across], position[up]];
    let stride = record.course.frames.len().div_ceil(TRACES_MAX).max(1);
    let drawn: Vec<_> = record.course.frames.iter().step_by(stride).collect();
    let mut curves = Vec::new();
    for (number, frame) in drawn.iter().enumerate() {
        let share = number as f64 / (drawn.len() - 1).max(1) as f64;
        for nodes in &frame.lines {
            let points = nodes.iter().map(|node| view(node.position)).collect();
            let curve = Curve::new(points, mixed(share), Stroke::Fine);
            let ends = number == 0 || number + 1 == drawn.len();
            let name = format!("t = {} s", plain(frame.time));
            curves.push(if ends { curve.named(&name) } else { curve });
        }
    }
    for (end, name) in ["end A", "end B"].into_iter().enumerate() {
        for line in 0..record.lines.len() {
            let path = record.course.frames.iter().filter_map(|frame| {
                let nodes = &frame.lines[line];
                let node = if end == 0 { nodes.first() } else { nodes.last() };
                node.map(|node| view(node.position))
            });
            let curve = Curve::new(path.collect(), colour(1 + end), Stroke::Dashed);
            curves.push(if line == 0 { curve.named(name) } else { curve });
        }
    }
    let interval = drawn.get(1).map_or(0.0, |frame| frame.time - drawn[0].time);
    let title = format!(
        "{}, every {} s",
        with_title("Flight", &record.title),
        plain(interval)
    );
    let x = Axis::around(&curves, 0, AXES[across].to_string());
    let y = Axis::around(&curves, 1, AXES[up].to_string());
    Chart::to_scale(title, x, y, curves)
}

/// Colour between the first and the last, by the share of the last [-].
fn mixed(share: f64) -> [u8; 3] {
    let [first, last] = TIMES;
    std::array::from_fn(|i| {
        (f64::from(first[i]) + share * (f64::from(last[i]) - f64::from(first[i]))).round() as u8
    })
}

/// Energy by kind and angular momentum in time. `None` if the run is not a free flight.
pub(super) fn balance(record: &Record) -> Option<String> {
    record.course.is_flight().then_some(())?;
    let energy = [
        history(record, "total", 6, FlightQuantity::Total),
        history(record, "motion", 0, FlightQuantity::Kinetic),
        history(record, "strain", 1, FlightQuantity::Strain),
    ];
    let momentum = ["about x", "about y", "about z"].into_iter().enumerate();
    let momentum = momentum.map(|(axis, name)| history(record, name, axis, FlightQuantity::Momentum(axis)));
    let charts = [
        (with_title("Energy", &record.title), "energy [J]", energy.to_vec()),
        (
            "Angular momentum about the origin".to_string(),
            "angular momentum [N m s]",
            momentum.collect(),
        ),
    ]
    .map(|(title, label, curves)| in_time(title, label.to_string(), curves));
    Some(chart::stacked_svg(&charts))
}

fn history(record: &Record, name: &str, hue: usize, quantity: FlightQuantity) -> Curve {
    Curve::new(record.course.flight(quantity), colour(hue), Stroke::Bold).named(name)
}

#[cfg(test)]
mod tests {
    use super::super::super::record::Flight;
    use super::super::super::sample;
    use super::*;

    fn flying() -> Record {
        let mut record = sample::record();
        for i in 0..10 {
            record.course.add_flight(&Flight {
                time: f64::from(i),
                kinetic: 1.0,
                strain: f64::from(i),
                gravitational: 0.0,
                angular_momentum: [0.0, 1.0, f64::from(i)],
            });
        }
        record
    }

    #[test]
    fn a_flight_in_one_plane_has_one_view_and_one_in_space_has_two() {
        let mut record = flying();
        let views = |record: &Record| shapes(record).unwrap().matches(" [m]").count() / 2;
        assert_eq!(views(&record), 1);
        for node in record
            .course
            .frames
            .iter_mut()
            .flat_map(|f| f.lines.iter_mut().flatten())
        {
            node.position[1] += 0.5 * node.position[0];
        }
        assert_eq!(views(&record), 2);
    }

    #[test]
    fn the_balance_names_what_it_shows() {
        let svg = balance(&flying()).unwrap();
        for label in ["energy [J]", "strain", "angular momentum [N m s]", "about z"] {
            assert!(svg.contains(label), "{label}");
        }
    }

    #[test]
    fn nothing_is_drawn_of_lines_that_do_not_fly() {
        assert_eq!(shapes(&sample::record()), None);
        assert_eq!(balance(&sample::record()), None);
    }
}
