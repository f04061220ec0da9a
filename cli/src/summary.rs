//! Short tables for the terminal.

use std::fmt;

use moorline::output::record::{LineRecord, Record, StaticLine};
use moorline::output::report::{difference, rounded};

/// Digits of a number in a table [-].
const DIGITS: usize = 7;

/// Table with a name in front of every row of numbers.
#[derive(Debug)]
pub(crate) struct Table {
    rows: Vec<Vec<String>>,
    /// True if the last column contains words.
    ends_in_words: bool,
}

impl Table {
    /// Creates a table with this header.
    pub(crate) fn new(head: &[&str]) -> Table {
        Table {
            rows: vec![head.iter().map(|cell| (*cell).to_string()).collect()],
            ends_in_words: false,
        }
    }

    /// Returns the table with words in the last column.
    pub(crate) fn ending_in_words(self) -> Table {
        Table {
            ends_in_words: true,
            ..self
        }
    }

    /// Adds a row of numbers.
    pub(crate) fn row(&mut self, name: &str, numbers: &[f64]) {
        let cells = numbers.iter().map(|&number| rounded(number, DIGITS));
        self.rows
            .push(std::iter::once(name.to_string()).chain(cells).collect());
    }

    /// Adds a row of text.
    pub(crate) fn text_row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| {
            let cells = self.rows.iter().filter_map(|row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        for row in &self.rows {
            let mut line = String::new();
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                line.push_str(&match column {
                    0 => format!("{cell:<width$}"),
                    last if self.ends_in_words && last + 1 == columns => format!("  {cell}"),
                    _ => format!("  {cell:>width$}"),
                });
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// Table of the lines that have an equilibrium, compared with the closed-form catenary.
pub(crate) fn static_table(record: &Record) -> Table {
    let mut table = Table::new(&["static equilibrium", "solved", "catenary", "difference"]);
    for line in &record.lines {
        let Some(equilibrium) = &line.equilibrium else {
            continue;
        };
        let closed = line.catenary.as_ref().map(|catenary| &catenary.figures);
        let mut add = |name: &str, figure: fn(&StaticLine) -> f64| {
            let solved = figure(equilibrium);
            let mut cells = vec![format!("{} {name}", line.name), rounded(solved, DIGITS)];
            if let Some(closed) = closed {
                cells.push(rounded(figure(closed), DIGITS));
                cells.push(difference(solved, figure(closed)));
            }
            table.text_row(cells);
        };
        add("tension at end B [N]", |line| line.tension_b);
        add("horizontal force at end B [N]", |line| line.horizontal);
        add("sag [m]", |line| line.sag);
        add("length on the seabed [m]", |line| line.laid_length);
        if let Some(bending) = &equilibrium.bending {
            for (name, value) in [
                ("greatest curvature [1/m]", bending.curvature),
                ("greatest moment [N m]", bending.moment),
            ] {
                table.row(&format!("{} {name}", line.name), &[value]);
            }
        }
    }
    table
}

/// Results of a run: ranges in time, and its cost.
pub(crate) fn run_summary(record: &Record) -> String {
    let mut table = Table::new(&["in time", "least", "mean", "greatest"]);
    for LineRecord { name, .. } in &record.lines {
        for (stem, label) in [("tension_b", "tension at end B [N]"), ("sag", "sag [m]")] {
            if let Some(range) = record.range(&format!("{name}.{stem}")) {
                table.row(&format!("{name} {label}"), &[range.min, range.mean, range.max]);
            }
        }
    }
    let counters = &record.course.counters;
    let cost = counters.real_time_factor().map_or(String::new(), |factor| {
        format!(
            "{} s simulated in {} s, {} internal steps: {} times real time\n",
            rounded(counters.simulated, 6),
            rounded(counters.wall.as_secs_f64(), 3),
            counters.substeps,
            rounded(factor, 3)
        )
    });
    let still = record.lines.iter().any(|line| line.equilibrium.is_some());
    let still = match still {
        true => static_table(record).to_string(),
        false => "no static equilibrium\n".to_string(),
    };
    format!("{still}\n{table}\n{cost}")
}
