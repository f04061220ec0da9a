//! Motion tables in CSV files: a header row, then time, x, y, z, and for vessels roll, pitch, yaw; or time and columns that say
//! what they move, such as `platform.x` and `buoy.z`.

use std::path::Path;

use super::MotionRow;
use super::input_file::{self, InputFile};

/// Columns of a motion file, in order; the last three may be left out together.
const COLUMNS: [&str; 7] = ["time", "x", "y", "z", "roll", "pitch", "yaw"];

/// Columns of a motion without rotation.
const TRANSLATION: usize = 4;

/// Most rows that are read: a day at 100 Hz.
const ROWS_MAX: usize = 8_640_000;

/// What a motion file moves.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Moves {
    /// One body, which the file does not name; whether it may turn.
    One {
        /// Rows of time [s], displacement x, y, z [m] and rotation [rad].
        rows: Vec<MotionRow>,
        /// Whether the file has columns of rotation.
        turns: bool,
    },
    /// Bodies by name, in the order of the file, with rows of time [s], displacement x, y, z [m] and rotation [rad].
    Named(Vec<(String, Vec<MotionRow>)>),
}

/// Rows of time [s], displacement x, y, z [m] and rotation [rad] of one body.
///
/// # Errors
/// The file, the line and what would be right.
pub(super) fn read(path: &Path) -> Result<Vec<MotionRow>, String> {
    match read_any(path, false)? {
        Moves::One { rows, .. } => Ok(rows),
        Moves::Named(_) => unreachable!("a header with names was refused"),
    }
}

/// The motion of one body, or of bodies that the header names.
///
/// # Errors
/// The file, the line and what would be right.
pub(super) fn read_moves(path: &Path) -> Result<Moves, String> {
    read_any(path, true)
}

fn read_any(path: &Path, names: bool) -> Result<Moves, String> {
    let name = path.display();
    let looked_for = match names {
        true => "",
        false => " (it is looked for beside the scene)",
    };
    let file = input_file::open(path, "a CSV file", input_file::MOTION_SIZE_MAX)
        .map_err(|unopened| unopened.at(path, looked_for))?;
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(file.by_rows());
    let header = reader
        .headers()
        .map_err(|error| format!("{name}: {}", in_words(&error)))?
        .clone();
    let bodies = if one_body(&header) {
        None
    } else if names {
        Some(named_columns(&header).map_err(|problem| format!("{name}, line 1: {problem}"))?)
    } else {
        return Err(format!("{name}, line 1: {}", wrong_header(&header, "")));
    };
    let rows = read_rows(&mut reader, &header).map_err(|problem| format!("{name}{problem}"))?;
    Ok(match bodies {
        None => Moves::One {
            turns: header.len() > TRANSLATION,
            rows: rows.iter().map(|row| motion_row(row)).collect(),
        },
        Some(columns) => Moves::Named(split(&columns, &rows)),
    })
}

/// Rows of numbers in ascending time, as many as the header has columns.
fn read_rows(
    reader: &mut csv::Reader<InputFile>,
    header: &csv::StringRecord,
) -> Result<Vec<Vec<f64>>, String> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| format!(": {}", in_words(&error)))?;
        let line = record.position().map_or(0, csv::Position::line);
        let row = row(&record, header).map_err(|problem| format!(", line {line}: {problem}"))?;
        if let Some(last) = rows.last()
            && row[0] <= last[0]
        {
            return Err(format!(
                ", line {line}: time {} s does not come after {} s",
                row[0], last[0]
            ));
        }
        if rows.len() == ROWS_MAX {
            return Err(format!(": more than {ROWS_MAX} rows"));
        }
        rows.push(row);
    }
    if rows.is_empty() {
        return Err(": no rows below the header".to_string());
    }
    Ok(rows)
}

/// Whether the header is that of one body; units may follow the names, as in `x [m]`.
fn one_body(header: &csv::StringRecord) -> bool {
    let complete = [TRANSLATION, COLUMNS.len()].contains(&header.len());
    complete
        && header
            .iter()
            .zip(COLUMNS)
            .all(|(column, wanted)| is_column(column, wanted))
}

fn is_column(column: &str, wanted: &str) -> bool {
    let first = without_unit(column).to_lowercase();
    first == wanted || (wanted == "time" && first == "t")
}

fn without_unit(column: &str) -> &str {
    let first = column.split([' ', '[', '(', '/']).next().unwrap_or("");
    first.trim_start_matches('\u{feff}')
}

fn wrong_header(header: &csv::StringRecord, more: &str) -> String {
    let found: Vec<&str> = header.iter().take(8).collect();
    format!(
        "the header must be \"time,x,y,z\" [s, m] or \"time,x,y,z,roll,pitch,yaw\" [s, m, rad]{more}, found \"{}\"",
        found.join(",")
    )
}

/// What every column after the time moves: a body by name, and along which of the six axes.
fn named_columns(header: &csv::StringRecord) -> Result<Vec<(String, usize)>, String> {
    let wrong = || {
        wrong_header(
            header,
            ", or the time and columns such as \"platform.x\" [m] and \"platform.pitch\" [rad]",
        )
    };
    if !header.get(0).is_some_and(|first| is_column(first, "time")) || header.len() < 2 {
        return Err(wrong());
    }
    let mut columns: Vec<(String, usize)> = Vec::new();
    for text in header.iter().skip(1) {
        let (body, axis) = without_unit(text).rsplit_once('.').ok_or_else(wrong)?;
        let column = (body.to_string(), axis_number(axis).ok_or_else(wrong)?);
        if body.is_empty() {
            return Err(wrong());
        }
        if columns.contains(&column) {
            return Err(format!("there are two columns {text}"));
        }
        columns.push(column);
    }
    Ok(columns)
}

/// The number of an axis by its name: x, y, z, roll, pitch, yaw.
pub(super) fn axis_number(name: &str) -> Option<usize> {
    COLUMNS[1..].iter().position(|axis| *axis == name)
}

/// A table by the bodies it moves.
fn split(columns: &[(String, usize)], rows: &[Vec<f64>]) -> Vec<(String, Vec<MotionRow>)> {
    let mut bodies: Vec<(String, Vec<MotionRow>)> = Vec::new();
    for (name, _) in columns {
        if bodies.iter().any(|(known, _)| known == name) {
            continue;
        }
        let of_body = rows.iter().map(|row| {
            let mut moved = [0.0; 7];
            moved[0] = row[0];
            for ((_, axis), value) in columns.iter().zip(&row[1..]).filter(|(c, _)| c.0 == *name) {
                moved[axis + 1] = *value;
            }
            moved
        });
        bodies.push((name.clone(), of_body.collect()));
    }
    bodies
}

fn motion_row(values: &[f64]) -> MotionRow {
    let mut row = [0.0; 7];
    row[..values.len()].copy_from_slice(values);
    row
}

fn row(record: &csv::StringRecord, header: &csv::StringRecord) -> Result<Vec<f64>, String> {
    if record.len() != header.len() {
        let names: Vec<&str> = header.iter().map(without_unit).collect();
        return Err(format!(
            "expected {} numbers ({}), found {}",
            header.len(),
            names.join(", "),
            record.len()
        ));
    }
    let number = |(field, column): (&str, &str)| match field.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!(
            "column {}: expected a finite number, found {field:?}",
            without_unit(column)
        )),
    };
    record.iter().zip(header).map(number).collect()
}

fn in_words(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::Utf8 { pos, .. } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            format!("line {line} is not UTF-8 text")
        }
        _ => error.to_string(),
    }
}
