//! Record of a run: plain numbers, gathered step by step, for figures, report and summary.
//!
//! A [`Record`] does not depend on a solver, and its size does not depend on the duration: rows are written to the tables of [`super::files`], and
//! ranges and thinned histories are kept here. The driver of a simulation names the columns once, adds a row at every output time, and a frame
//! whenever the shape of the lines is required.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::trace::{Range, RangeSum, Trace};
use crate::simulation::NodeBending;

/// Column of the surface's elevation [m].
pub const ELEVATION: &str = "waves.elevation";
/// Last parts of the names of columns whose histories are drawn.
const DRAWN: [&str; 7] = [
    "tension_b",
    "fx",
    "fy",
    "fz",
    "curvature_max",
    "moment_max",
    "elevation",
];

/// Form of the values of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// A number.
    Real,
    /// A number with all of its digits, such as a time.
    Exact,
    /// A whole number, such as a count or a truth value.
    Whole,
    /// A number, or an empty cell if the value is NaN.
    Sparse,
    /// A name; the value is its index in the list.
    Name(Vec<String>),
}

/// A column of the results: one output variable in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the variable, such as `line1.tension_b`.
    pub name: String,
    /// Unit symbol, such as `N`; `1` if the number has none.
    pub unit: String,
    /// Description in a sentence.
    pub description: String,
    /// Form of its values.
    pub form: Form,
}

impl Column {
    /// Creates a column.
    pub fn new(name: &str, unit: &str, description: impl Into<String>, form: Form) -> Column {
        Column {
            name: name.to_string(),
            unit: unit.to_string(),
            description: description.into(),
            form,
        }
    }

    /// Time, the first column of every table.
    pub fn time() -> Column {
        Column::new("time", "s", "simulated time", Form::Exact)
    }
}

/// A line's node at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Unstretched arc length from end A [m].
    pub s: f64,
    /// Position, global axes, z up [m].
    pub position: [f64; 3],
    /// Effective tension [N].
    pub tension: f64,
    /// Curvature and moment, if the line has bending stiffness.
    pub bending: Option<NodeBending>,
}

/// The shapes of all lines at one instant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Time [s].
    pub time: f64,
    /// Nodes of every line from end A to end B, in the order of [`Record::lines`].
    pub lines: Vec<Vec<Node>>,
}

/// Energy and momenta of beams in free flight at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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

/// Static results of a line in its reference configuration.
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
    /// Greatest curvature and moment, if the line has bending stiffness.
    pub bending: Option<NodeBending>,
}

/// Closed-form elastic catenary of a line in its reference configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Catenary {
    /// Static results of the line.
    pub figures: StaticLine,
    /// Points of its shape from end A to end B [m].
    pub profile: Vec<[f64; 3]>,
}

/// A line of the record.
#[derive(Debug, Clone, PartialEq)]
pub struct LineRecord {
    /// Name, the stem of its variables.
    pub name: String,
    /// Static equilibrium of the discretised line; `None` if there is none, as for beams in free flight.
    pub equilibrium: Option<StaticLine>,
    /// Closed form for comparison; `None` if the line has none.
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
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Counters {
    /// Internal steps of the solver [-].
    pub substeps: u64,
    /// Simulated time [s].
    pub simulated: f64,
    /// Wall-clock time of the steps.
    pub wall: Duration,
}

impl Counters {
    /// Simulated seconds per second of wall-clock time [-]; `None` if no time was measured.
    pub fn real_time_factor(&self) -> Option<f64> {
        let wall = self.wall.as_secs_f64();
        (wall > 0.0).then(|| self.simulated / wall)
    }
}

/// Data kept of the rows and shapes of a run. Saved with the state of a run that is to be continued.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// Number of rows [-].
    pub rows: usize,
    /// Number of rows of the whole run [-].
    planned: usize,
    /// Range of every column after time, from the first row on.
    ranges: Vec<RangeSum>,
    /// Histories of the columns that are drawn.
    traces: Vec<Option<Trace>>,
    /// Shapes in time, ascending.
    pub frames: Vec<Frame>,
    /// Energy and momenta in time, if all lines are beams without supports.
    flight: Option<[Trace; 6]>,
    /// Cost of the run.
    pub counters: Counters,
}

/// Quantity of a flight that is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlightQuantity {
    /// Total energy [J].
    Total,
    /// Kinetic energy [J].
    Kinetic,
    /// Strain energy [J].
    Strain,
    /// Angular momentum about a global axis [N m s].
    Momentum(usize),
}

impl Course {
    /// Adds the energy and momenta of one instant.
    pub fn add_flight(&mut self, flight: &Flight) {
        let planned = self.planned;
        let traces = self
            .flight
            .get_or_insert_with(|| std::array::from_fn(|_| Trace::new(planned)));
        let [x, y, z] = flight.angular_momentum;
        let total = flight.kinetic + flight.strain + flight.gravitational;
        let values = [total, flight.kinetic, flight.strain, x, y, z];
        for (trace, value) in traces.iter_mut().zip(values) {
            trace.add([flight.time, value]);
        }
    }

    /// Nodes of all lines in all shapes.
    pub(super) fn nodes(&self) -> impl Iterator<Item = &Node> + Clone {
        self.frames.iter().flat_map(|frame| frame.lines.iter().flatten())
    }

    /// Returns whether the run is a free flight of beams.
    pub fn is_flight(&self) -> bool {
        self.flight.is_some()
    }

    /// Thinned history of a quantity of the flight, as pairs of time [s] and value; empty if the run is not a free flight.
    pub fn flight(&self, quantity: FlightQuantity) -> Vec<[f64; 2]> {
        let place = match quantity {
            FlightQuantity::Total => 0,
            FlightQuantity::Kinetic => 1,
            FlightQuantity::Strain => 2,
            FlightQuantity::Momentum(axis) => 3 + axis,
        };
        self.flight
            .as_ref()
            .map_or(Vec::new(), |traces| traces[place].points())
    }
}

/// Record of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Description of the run, in a line.
    pub title: String,
    columns: Vec<Column>,
    /// Retained data of rows and shapes.
    pub course: Course,
    /// The lines.
    pub lines: Vec<LineRecord>,
    /// Names of the points whose force is recorded: the fairleads.
    pub points: Vec<String>,
    /// Surroundings of the lines.
    pub surroundings: Surroundings,
}

impl Record {
    /// Creates an empty record for `planned` rows, whose first column is time [s], followed by `columns`.
    pub fn new(title: impl Into<String>, columns: Vec<Column>, planned: usize) -> Record {
        let drawn = |column: &Column| {
            let last = column.name.rsplit('.').next();
            last.is_some_and(|last| DRAWN.contains(&last))
                .then(|| Trace::new(planned))
        };
        let course = Course {
            planned,
            traces: columns.iter().map(drawn).collect(),
            ..Course::default()
        };
        Record {
            title: title.into(),
            columns: std::iter::once(Column::time()).chain(columns).collect(),
            course,
            lines: Vec::new(),
            points: Vec::new(),
            surroundings: Surroundings::default(),
        }
    }

    /// Columns, time first.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Adds a row: the time [s] and one value for every further column, in its unit.
    ///
    /// # Panics
    /// If the number of values differs from the number of columns: a mistake of the caller.
    pub fn add_row(&mut self, row: &[f64]) {
        assert!(
            row.len() == self.columns.len(),
            "a row holds one value for every column"
        );
        let (course, time) = (&mut self.course, row[0]);
        let values = row[1..].iter();
        match course.rows {
            0 => course.ranges = values.map(|value| RangeSum::new([time, *value])).collect(),
            _ => values
                .zip(&mut course.ranges)
                .for_each(|(value, range)| range.add([time, *value])),
        }
        for (value, trace) in row[1..].iter().zip(&mut course.traces) {
            if let Some(trace) = trace {
                trace.add([time, *value]);
            }
        }
        course.rows += 1;
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.columns[1..].iter().position(|column| column.name == name)
    }

    /// Thinned history of a column that is drawn, as pairs of time [s] and value in the column's unit; `None` if no such column has this name.
    pub fn history(&self, name: &str) -> Option<Vec<[f64; 2]>> {
        let trace = self.course.traces[self.place(name)?].as_ref()?;
        Some(trace.points())
    }

    /// Range of a column's values; `None` if no column has this name or there are no rows.
    pub fn range(&self, name: &str) -> Option<Range> {
        let sum = self.course.ranges.get(self.place(name)?)?;
        Some(sum.range())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str) -> Column {
        Column::new(name, "N", "", Form::Real)
    }

    #[test]
    fn a_history_pairs_time_with_the_named_column_if_it_is_drawn() {
        let mut record = Record::new("", vec![column("a.sag"), column("b.tension_b")], 2);
        record.add_row(&[0.0, 1.0, 2.0]);
        record.add_row(&[0.5, 3.0, 4.0]);
        assert_eq!(record.history("b.tension_b"), Some(vec![[0.0, 2.0], [0.5, 4.0]]));
        assert_eq!((record.history("a.sag"), record.history("c")), (None, None));
        assert_eq!(record.range("a.sag").unwrap().mean, 2.0);
        assert_eq!((record.range("c"), record.range("time")), (None, None));
    }

    /// Counts the numbers kept, which bound the memory in use.
    #[test]
    fn a_record_of_ten_times_the_rows_keeps_no_more() {
        let kept = |rows: u32| {
            let mut record = Record::new("", vec![column("a.sag"), column("b.tension_b")], rows as usize);
            (0..rows).for_each(|i| record.add_row(&[f64::from(i), 1.0, f64::from(i % 13)]));
            let course = postcard::to_stdvec(&record.course).unwrap();
            (record.history("b.tension_b").unwrap().len(), course.len())
        };
        let (short, long) = (kept(20_000), kept(200_000));
        assert!(
            long.0 <= 2400 && long.1 <= short.1 + short.1 / 10,
            "{short:?} {long:?}"
        );
    }

    #[test]
    #[should_panic(expected = "a row holds one value for every column")]
    fn a_row_of_the_wrong_length_is_our_own_mistake() {
        Record::new("", vec![column("a")], 1).add_row(&[0.0, 1.0, 2.0]);
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
