//! Files of output channels in MoorDyn's format: one for the channels in OUTPUTS, and one for every line whose row has output letters.
//!
//! Two header lines with names and units, then a row every `dtOut`, in columns of fixed width: 10 characters for the time, 20 for every value.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use moorline::output::channels::Channels;
use moorline::output::{collect, vtk, write_file};
use moorline::simulation::Simulation;

use crate::deck::Deck;
use crate::failure::{Code, Failure, Outcome};
use crate::log::{Log, WARNING};
use crate::nodes::{Quantity, damping, stretch, vector};
use crate::system::System;

/// Interval after which buffered rows are flushed to the file.
const FLUSH_INTERVAL: Duration = Duration::from_secs(1);

/// Fraction of an interval by which a row may come early [-].
const EARLY: f64 = 1e-6;

/// Groups requested by the letters of a line's row, in the order of the columns: letter, group, suffix of the names, unit.
const LETTERS: [(char, Group, &str, &str); 10] = [
    ('p', Group::Node(Quantity::Position), "p", "(m)"),
    ('K', Group::Curvature, "Ku", "(1/m)"),
    ('v', Group::Node(Quantity::Velocity), "v", "(m/s)"),
    ('U', Group::Node(Quantity::Water), "U", "(m/s)"),
    ('D', Group::Node(Quantity::Drag), "D", "(N)"),
    ('t', Group::Stretch(0), "Te", "(N)"),
    ('c', Group::Damping, "c", "(N)"),
    ('s', Group::Stretch(1), "St", "(-)"),
    ('d', Group::Stretch(2), "dSt", "(-/s)"),
    ('b', Group::Node(Quantity::Seabed), "b", "(N)"),
];

/// Columns requested by one letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Group {
    /// Vector at every node.
    Node(Quantity),
    /// Curvature at every node.
    Curvature,
    /// Scalar of every segment, by index: 0 tension without damping, 1 strain, 2 strain rate.
    Stretch(usize),
    /// Damping force of every segment, a vector.
    Damping,
}

/// Table being written.
#[derive(Debug)]
struct Table {
    path: PathBuf,
    out: BufWriter<File>,
    line: String,
    flushed: Instant,
}

impl Table {
    fn create(deck: &Deck, path: PathBuf, names: &[String], units: &[String]) -> Outcome<Table> {
        let file = File::create(&path).map_err(|error| refusal(&path, &error))?;
        let mut table = Table {
            out: BufWriter::new(file),
            line: String::new(),
            flushed: Instant::now(),
            path,
        };
        table.head("Time", names)?;
        if deck
            .lists
            .option(&["WRITEUNITS"])
            .is_none_or(|value| value.trim() != "0")
        {
            table.head("(s)", units)?;
        }
        Ok(table)
    }

    fn head(&mut self, first: &str, words: &[String]) -> Outcome {
        let cells: String = words.iter().map(|word| format!("{word:>20}")).collect();
        let written = writeln!(self.out, "{first:>10}{cells}");
        written.map_err(|error| refusal(&self.path, &error))
    }

    fn row(&mut self, time: f64, values: impl Iterator<Item = f64>) -> Outcome {
        self.line.clear();
        let _ = write!(self.line, "{time:>10.4}"); // writing to a string does not fail
        for value in values {
            push_scientific(value, &mut self.line);
        }
        self.line.push('\n');
        let mut written = self.out.write_all(self.line.as_bytes());
        if self.flushed.elapsed() > FLUSH_INTERVAL {
            self.flushed = Instant::now();
            written = written.and_then(|()| self.out.flush());
        }
        written.map_err(|error| refusal(&self.path, &error))
    }
}

fn refusal(path: &Path, error: &std::io::Error) -> Failure {
    Failure::new(
        Code::InvalidOutputFile,
        format!("cannot write {}: {error}", path.display()),
    )
}

/// Appends a number in 20 characters: seven decimals and a signed exponent of at least two digits, as in C.
fn push_scientific(value: f64, line: &mut String) {
    let start = line.len();
    let _ = write!(line, "{value:.7e}"); // writing to a string does not fail
    if let Some(at) = line[start..].find('e').map(|at| start + at + 1) {
        let is_negative = line[at..].starts_with('-');
        let digits = at + usize::from(is_negative);
        if line.len() - digits < 2 {
            line.insert(digits, '0');
        }
        if !is_negative {
            line.insert(at, '+');
        }
    }
    const BLANKS: &str = "                    ";
    let missing = BLANKS.len().saturating_sub(line.len() - start);
    line.insert_str(start, &BLANKS[..missing]);
}

/// Channel files of a system.
#[derive(Debug)]
pub struct Files {
    interval: f64,
    main: Option<(Channels, Table)>,
    lines: Vec<(usize, Vec<Group>, Table)>,
}

impl Files {
    /// Creates the files that a deck requests; `None` if it disables output or requests none.
    ///
    /// # Errors
    /// The operating system refuses a file.
    pub fn create(deck: &Deck, simulation: &Simulation, log: &mut Log) -> Outcome<Option<Files>> {
        let is_set = |key: &str| deck.lists.option(&[key]).is_some_and(|value| value.trim() != "0");
        if is_set("DISABLEOUTPUT") {
            return Ok(None);
        }
        let interval = deck.lists.option(&["DTOUT"]).and_then(|text| text.parse().ok());
        let mut files = Files {
            interval: interval.unwrap_or(0.0),
            main: None,
            lines: Vec::new(),
        };
        files.main = main_table(deck, simulation)?;
        for (index, row) in deck.lists.lines.iter().enumerate() {
            let groups = groups(&row.outputs, row.number, simulation, log);
            if groups.is_empty() {
                continue;
            }
            let (names, units) = head(&groups, row.segments);
            let path = with_ending(deck, &format!("_Line{}.out", row.number));
            files
                .lines
                .push((index, groups, Table::create(deck, path, &names, &units)?));
        }
        let is_empty = files.main.is_none() && files.lines.is_empty();
        Ok((!is_empty).then_some(files))
    }

    /// Writes the row of a time [s] where an interval ended within the last step [s]. A step that the host repeats is written again, as by MoorDyn.
    ///
    /// # Errors
    /// The operating system refuses the write.
    pub fn row(&mut self, [time, step]: [f64; 2], simulation: &Simulation) -> Outcome {
        let ended = |time: f64| (time / self.interval + EARLY).floor();
        if self.interval > 0.0 && ended(time) == ended(time - step) {
            return Ok(());
        }
        if let Some((channels, table)) = &mut self.main {
            table.row(time, channels.values(simulation))?;
        }
        for (line, groups, table) in &mut self.lines {
            let values = groups.iter().flat_map(|group| values(*group, simulation, *line));
            table.row(time, values)?;
        }
        Ok(())
    }
}

fn with_ending(deck: &Deck, ending: &str) -> PathBuf {
    let mut path = deck.stem.clone().into_os_string();
    path.push(ending);
    path.into()
}

fn main_table(deck: &Deck, simulation: &Simulation) -> Outcome<Option<(Channels, Table)>> {
    if deck.scene.output.channels.is_empty() {
        return Ok(None);
    }
    let channels = Channels::new(&deck.scene, simulation.model())
        .map_err(|error| Failure::new(Code::InvalidInputFile, error.to_string()))?;
    let columns = || channels.columns();
    let names: Vec<String> = columns().map(|column| column.name).collect();
    let units: Vec<String> = columns().map(|column| column.unit).collect();
    let table = Table::create(deck, with_ending(deck, ".out"), &names, &units)?;
    Ok(Some((channels, table)))
}

/// Returns the groups for a line's letters; letters whose output is not available are logged.
fn groups(letters: &str, number: usize, simulation: &Simulation, log: &mut Log) -> Vec<Group> {
    let lines = &simulation.model().lines;
    let line = lines.iter().find(|line| line.name == format!("line{number}"));
    let is_viscoelastic = line.is_some_and(|line| line.segments.viscoelastic.is_some());
    let known = |letter: char| {
        let group = LETTERS.iter().find(|(known, ..)| *known == letter)?.1;
        let is_of_segments = matches!(group, Group::Stretch(_) | Group::Damping);
        (!(is_viscoelastic && is_of_segments)).then_some(group)
    };
    for letter in letters.chars().filter(|letter| letter.is_alphabetic()) {
        if known(letter).is_none() {
            let text = format!("outputs {letter:?} of line {number} are not written");
            log.write(WARNING, &text);
        }
    }
    let wanted = LETTERS.iter().filter(|(letter, ..)| letters.contains(*letter));
    wanted.filter_map(|(letter, ..)| known(*letter)).collect()
}

/// Returns names and units of the columns for a line with `segments` segments.
fn head(groups: &[Group], segments: usize) -> (Vec<String>, Vec<String>) {
    let (mut names, mut units) = (Vec::new(), Vec::new());
    for (_, group, ending, unit) in LETTERS.iter().filter(|(_, group, ..)| groups.contains(group)) {
        let axes: &[&str] = match group {
            Group::Node(_) | Group::Damping => &["x", "y", "z"],
            Group::Curvature | Group::Stretch(_) => &[""],
        };
        let places: Vec<String> = match group {
            Group::Node(_) | Group::Curvature => (0..=segments).map(|node| format!("Node{node}")).collect(),
            Group::Stretch(_) | Group::Damping => {
                (1..=segments).map(|segment| format!("Seg{segment}")).collect()
            }
        };
        for place in places {
            names.extend(axes.iter().map(|axis| format!("{place}{ending}{axis}")));
            units.extend(axes.iter().map(|_| unit.to_string()));
        }
    }
    (names, units)
}

/// Returns the values of a group, in the order of [`head`].
fn values(group: Group, simulation: &Simulation, line: usize) -> Vec<f64> {
    let count = simulation.model().lines[line].segment_count();
    match group {
        Group::Node(quantity) => (0..=count)
            .flat_map(|node| vector(simulation, line, node, quantity))
            .collect(),
        Group::Curvature => match simulation.bending(line) {
            Some(nodes) => nodes.iter().map(|node| node.curvature).collect(),
            None => vec![0.0; count + 1],
        },
        Group::Stretch(part) => (0..count)
            .map(|segment| stretch(simulation, line, segment).map_or(f64::NAN, |parts| parts[part]))
            .collect(),
        Group::Damping => (0..count)
            .flat_map(|segment| damping(simulation, line, segment).unwrap_or([f64::NAN; 3]))
            .collect(),
    }
}

impl System {
    /// Writes the shape of all lines, or of one line by its row in the deck, in ParaView format.
    ///
    /// # Errors
    /// No such line, the system was not started, or the operating system refuses the file.
    pub fn save_vtk(&self, path: &Path, line: Option<usize>) -> Outcome {
        if let Some(line) = line {
            self.line(line)?;
        }
        let simulation = self.simulation()?;
        let mut frame = collect::frame(simulation, self.time()?);
        if let Some(line) = line {
            frame.lines = vec![frame.lines.swap_remove(line)];
        }
        write_file(path, |out| vtk::write_frame(&frame, out))
            .map_err(|error| Failure::new(Code::InvalidOutputFile, error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_c_writes_them() {
        let mut line = String::from("|");
        for value in [0.0, -1.5, 1.0e100, 839_376.28, 1e-9] {
            push_scientific(value, &mut line);
        }
        let expected = "|       0.0000000e+00      -1.5000000e+00      1.0000000e+100       8.3937628e+05       1.0000000e-09";
        assert_eq!(line, expected);
    }
}
