//! Record of a run: plain numbers, gathered step by step, that every writer of this module reads.
//!
//! A [`Record`] does not depend on a solver. The driver of a simulation names the columns once, adds a row at every
//! output time and a frame where the shape of the lines is required.

use std::time::Duration;

use crate::simulation::NodeBending;

/// A column of the results: one output variable in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the variable, such as `line1.tension_b`.
    pub name: String,
    /// Unit symbol, such as `N`; `1` where the number has none.
    pub unit: String,
    /// Description in a sentence.
    pub description: String,
    /// True if its values are whole numbers: counts and truth values.
    pub whole: bool,
}

/// A line's node at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Unstretched arc length from end A [m].
    pub s: f64,
    /// Position, global axes, z up [m].
    pub position: [f64; 3],
    /// Effective tension [N].
    pub tension: f64,
    /// Curvature and moment, where the line has bending stiffness.
    pub bending: Option<NodeBending>,
}

/// The shapes of all lines at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Time [s].
    pub time: f64,
    /// Nodes of every line from end A to end B, in the order of [`Record::lines`].
    pub lines: Vec<Vec<Node>>,
}

/// Energy and momenta of beams in free flight at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    /// Time [s].
    pub time: f64,
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Strain energy [J].
    pub strain: f64,
    /// Potential energy of weight, above z = 0 [J].
    pub gravitational: f64,
    /// Angular momentum about the origin [N m s].
    pub angular_momentum: [f64; 3],
}

/// Static figures of a line in its reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticLine {
    /// Tension at end B [N].
    pub tension_b: f64,
    /// Horizontal force at end B [N].
    pub horizontal: f64,
    /// Greatest vertical distance below the chord [m].
    pub sag: f64,
    /// Unstretched length that lies on the seabed [m].
    pub laid_length: f64,
    /// Greatest curvature and moment, where the line has bending stiffness.
    pub bending: Option<NodeBending>,
}

/// The closed-form elastic catenary of a line in its reference configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Catenary {
    /// Figures of the line.
    pub figures: StaticLine,
    /// Points of its shape from end A to end B [m].
    pub profile: Vec<[f64; 3]>,
}

/// A line of the record.
#[derive(Debug, Clone, PartialEq)]
pub struct LineRecord {
    /// Name, the stem of its variables.
    pub name: String,
    /// The discretised line in static equilibrium; `None` where the lines have none, such as beams in free flight.
    pub equilibrium: Option<StaticLine>,
    /// Closed form for comparison; `None` where the line has none.
    pub catenary: Option<Catenary>,
}

/// Surroundings of the lines that a figure shows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Surroundings {
    /// True if there is water, with its surface at z = 0.
    pub water: bool,
    /// Height of the seabed [m]; `None` without one.
    pub seabed: Option<f64>,
}

/// Cost of the run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Counters {
    /// Internal steps of the solver [-].
    pub substeps: u64,
    /// Simulated time [s].
    pub simulated: f64,
    /// Wall-clock time of the steps.
    pub wall: Duration,
}

impl Counters {
    /// Simulated seconds per second of wall-clock time [-]; `None` where no time was measured.
    pub fn real_time_factor(&self) -> Option<f64> {
        let wall = self.wall.as_secs_f64();
        (wall > 0.0).then(|| self.simulated / wall)
    }
}

/// All results of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Description of the run, in a line.
    pub title: String,
    columns: Vec<Column>,
    values: Vec<f64>,
    /// Shapes in time, ascending.
    pub frames: Vec<Frame>,
    /// The lines.
    pub lines: Vec<LineRecord>,
    /// Energy and momenta in time, where all lines are beams without supports.
    pub flight: Vec<Flight>,
    /// Names of the points whose force is recorded: the fairleads.
    pub points: Vec<String>,
    /// Surroundings of the lines.
    pub surroundings: Surroundings,
    /// Cost of the run.
    pub counters: Counters,
}

impl Record {
    /// Empty record whose first column is time [s], with `columns` behind it.
    pub fn new(title: impl Into<String>, columns: Vec<Column>) -> Record {
        let time = Column {
            name: "time".to_string(),
            unit: "s".to_string(),
            description: "simulated time".to_string(),
            whole: false,
        };
        Record {
            title: title.into(),
            columns: std::iter::once(time).chain(columns).collect(),
            values: Vec::new(),
            frames: Vec::new(),
            lines: Vec::new(),
            flight: Vec::new(),
            points: Vec::new(),
            surroundings: Surroundings::default(),
            counters: Counters::default(),
        }
    }

    /// Columns, time first.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Adds a row: the time [s] and one value for every further column, in its unit.
    ///
    /// # Panics
    /// The number of values is not the number of columns after time: a mistake of the caller.
    pub fn add_row(&mut self, time: f64, values: impl IntoIterator<Item = f64>) {
        self.values.push(time);
        self.values.extend(values);
        assert!(
            self.values.len().is_multiple_of(self.columns.len()),
            "a row holds one value for every column"
        );
    }

    /// Rows, each as long as [`Record::columns`], each value in its column's unit.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.values.chunks_exact(self.columns.len())
    }

    /// A column's history, as pairs of time [s] and value in the column's unit; `None` where no column has the name.
    pub fn history(&self, name: &str) -> Option<Vec<[f64; 2]>> {
        let index = self.columns.iter().position(|c| c.name == name)?;
        Some(self.rows().map(|row| [row[0], row[index]]).collect())
    }
}

/// Smallest, mean and greatest value of a history, in its unit. The mean is over time, by the trapezoidal rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest value, in the history's unit.
    pub min: f64,
    /// Mean over time, in the history's unit.
    pub mean: f64,
    /// Greatest value, in the history's unit.
    pub max: f64,
}

impl Range {
    /// Range of pairs of time [s] and value; `None` of no pairs.
    pub fn of(history: &[[f64; 2]]) -> Option<Range> {
        let [first, .., last] = history else {
            return history.first().map(|&[_, value]| Range {
                min: value,
                mean: value,
                max: value,
            });
        };
        let area: f64 = history
            .windows(2)
            .map(|pair| 0.5 * (pair[0][1] + pair[1][1]) * (pair[1][0] - pair[0][0]))
            .sum();
        let values = history.iter().map(|&[_, value]| value);
        Some(Range {
            min: values.clone().fold(f64::INFINITY, f64::min),
            mean: area / (last[0] - first[0]),
            max: values.fold(f64::NEG_INFINITY, f64::max),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str) -> Column {
        Column {
            name: name.to_string(),
            unit: "N".to_string(),
            description: String::new(),
            whole: false,
        }
    }

    #[test]
    fn a_history_pairs_time_with_the_named_column() {
        let mut record = Record::new("", vec![column("a"), column("b")]);
        record.add_row(0.0, [1.0, 2.0]);
        record.add_row(0.5, [3.0, 4.0]);
        assert_eq!(record.history("b"), Some(vec![[0.0, 2.0], [0.5, 4.0]]));
        assert_eq!(record.history("c"), None);
        assert_eq!(record.rows().len(), 2);
    }

    #[test]
    #[should_panic(expected = "a row holds one value for every column")]
    fn a_row_of_the_wrong_length_is_our_own_mistake() {
        Record::new("", vec![column("a")]).add_row(0.0, [1.0, 2.0]);
    }

    #[test]
    fn the_mean_is_over_time_and_not_over_rows() {
        let range = Range::of(&[[0.0, 0.0], [1.0, 2.0], [4.0, 2.0]]).unwrap();
        assert_eq!((range.min, range.mean, range.max), (0.0, 7.0 / 4.0, 2.0));
    }

    #[test]
    fn a_single_row_is_its_own_mean_and_none_has_no_range() {
        assert_eq!(Range::of(&[[3.0, 5.0]]).unwrap().mean, 5.0);
        assert_eq!(Range::of(&[]), None);
    }

    #[test]
    fn the_real_time_factor_is_simulated_over_wall_time() {
        let counters = Counters {
            substeps: 10,
            simulated: 30.0,
            wall: Duration::from_millis(1500),
        };
        assert_eq!(counters.real_time_factor(), Some(20.0));
        assert_eq!(Counters::default().real_time_factor(), None);
    }
}
