//! Time histories to which the tolerance of a scene refers: the tension at the driven end of a line, unfiltered or low-pass filtered, or the
//! positions of three of its points.

use crate::math::hermite::Hermite;
use crate::math::low_pass::low_pass;
use crate::math::shape_preserving::{End, smooth_slopes};
use crate::model::{self, Model};
use crate::scene::{Scene, ToleranceOf};
use crate::simulation::{STILL_TENSION, Simulation};

/// Least deviation of positions to which their errors are related, relative to the length of the line [-].
const STILL_POSITION: f64 = 1e-3;
/// Points of a line whose positions are compared, by unstretched length from end A relative to that of the line [-].
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];

/// History of a line in a trial.
#[derive(Debug, Clone)]
pub(super) struct History {
    kind: Kind,
    /// One series for the tension [N]; three coordinates [m] for each of [`PLACES`].
    series: Vec<Vec<f64>>,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    /// Tension at an end.
    Tension { end: model::End, filter: Option<Filter> },
    /// Positions on a line of a given length [m].
    Positions { length: f64 },
}

/// Filter of a history.
#[derive(Debug, Clone, Copy)]
struct Filter {
    /// Interval of the samples [s].
    interval: f64,
    /// Cut-off frequency [Hz].
    cut_off: f64,
}

impl History {
    /// Empty history of a line.
    pub(super) fn of(scene: &Scene, model: &Model, line: usize) -> History {
        let sections = scene.lines[line].sections.iter();
        let filter = Filter {
            interval: scene.output.interval,
            cut_off: scene.cut_off(),
        };
        let of_tension = |filter| Kind::Tension {
            end: model.driven_end(line),
            filter,
        };
        let (kind, count) = match scene.solver.tolerance_of {
            ToleranceOf::Tension => (of_tension(None), 1),
            ToleranceOf::LowPassedTension => (of_tension(Some(filter)), 1),
            ToleranceOf::Position => {
                let length = sections.map(|section| section.length).sum();
                (Kind::Positions { length }, 3 * PLACES.len())
            }
        };
        History {
            kind,
            series: vec![Vec::new(); count],
        }
    }

    /// Adds the present state of the line.
    pub(super) fn add(&mut self, simulation: &Simulation, line: usize) {
        match self.kind {
            Kind::Tension { end, .. } => self.series[0].push(simulation.tension_at(line, end)),
            Kind::Positions { .. } => {
                let series = self.series.iter_mut();
                series
                    .zip(positions(simulation, line))
                    .for_each(|(series, x)| series.push(x));
            }
        }
    }

    /// Filters the complete history if its kind requires it.
    pub(super) fn complete(&mut self) {
        if let Kind::Tension {
            filter: Some(Filter { interval, cut_off }),
            ..
        } = self.kind
        {
            self.series[0] = low_pass(&self.series[0], interval, cut_off);
        }
    }

    /// RMS of the difference from another history, in the history's unit.
    pub(super) fn difference(&self, other: &History) -> f64 {
        let both = self.series.iter().zip(&other.series);
        let squares = both.map(|(own, right)| mean_square(own.iter().zip(right).map(|(a, b)| a - b)));
        squares.sum::<f64>().sqrt()
    }

    /// Standard deviation, of positions in space, or the least value used if that is greater, in the history's unit.
    pub(super) fn deviation(&self) -> f64 {
        self.variation().max(self.least_deviation())
    }

    /// Returns whether the history varies so little that its errors are relative to the least deviation.
    pub(super) fn is_still(&self) -> bool {
        self.variation() < self.least_deviation()
    }

    /// Least deviation to which errors are relative, in the history's unit.
    fn least_deviation(&self) -> f64 {
        match self.kind {
            Kind::Tension { .. } => STILL_TENSION * mean(&self.series[0]).abs(),
            Kind::Positions { length } => STILL_POSITION * length,
        }
    }

    /// Standard deviation, of positions in space, in the history's unit.
    fn variation(&self) -> f64 {
        let squares = self.series.iter().map(|series| {
            let mean = mean(series);
            mean_square(series.iter().map(|value| value - mean))
        });
        squares.sum::<f64>().sqrt()
    }
}

/// Coordinates of the points of a line at [`PLACES`] [m], from cubics through its nodes.
fn positions(simulation: &Simulation, line: usize) -> Vec<f64> {
    let nodes = simulation.profile(line);
    let s: Vec<f64> = nodes.iter().map(|node| node.s).collect();
    let axes = [0, 1, 2].map(|axis| {
        let values: Vec<f64> = nodes.iter().map(|node| [node.x, node.y, node.z][axis]).collect();
        let slopes = smooth_slopes(&s, &values, [End::Open; 2]);
        (values, slopes)
    });
    let at = |place: &f64| {
        let wanted = place * s[s.len() - 1];
        let i = s.partition_point(|&s| s <= wanted).clamp(1, s.len() - 1) - 1;
        let of_axis = |(values, slopes): &(Vec<f64>, Vec<f64>)| {
            let knot = |i: usize| (s[i], values[i], slopes[i]);
            Hermite::new(knot(i), knot(i + 1)).at(wanted).value
        };
        [0, 1, 2].map(|axis| of_axis(&axes[axis]))
    };
    PLACES.iter().flat_map(at).collect()
}

fn mean(series: &[f64]) -> f64 {
    series.iter().sum::<f64>() / series.len() as f64
}

fn mean_square(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.map(|value| value * value).sum::<f64>() / count
}
