//! Motion tables in CSV files: a header row, then time, x, y, z, and for vessels roll, pitch, yaw.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use super::MotionRow;

/// Columns of a motion file, in order; the last three may be left out together.
const COLUMNS: [&str; 7] = ["time", "x", "y", "z", "roll", "pitch", "yaw"];

/// Columns of a motion without rotation.
const TRANSLATION: usize = 4;

/// Most rows that are read: a day at 100 Hz.
const ROWS_MAX: usize = 8_640_000;

/// Rows of time [s], displacement x, y, z [m] and rotation [rad].
///
/// # Errors
/// The file, the line and what would be right.
pub(super) fn read(path: &Path) -> Result<Vec<MotionRow>, String> {
    let name = path.display();
    if path.is_dir() {
        return Err(format!("{name} is a folder, not a CSV file"));
    }
    let file = File::open(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            format!("{name}: no such file (it is looked for beside the scene)")
        }
        _ => format!("{name} cannot be opened: {error}"),
    })?;
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(BufReader::new(file));
    let header = reader
        .headers()
        .map_err(|error| format!("{name}: {}", in_words(&error)))?;
    let columns = header.len();
    check_header(header).map_err(|problem| format!("{name}, line 1: {problem}"))?;
    let mut rows: Vec<MotionRow> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| format!("{name}: {}", in_words(&error)))?;
        let line = record.position().map_or(0, csv::Position::line);
        let row =
            row(&record, columns).map_err(|problem| format!("{name}, line {line}: {problem}"))?;
        if let Some(last) = rows.last()
            && row[0] <= last[0]
        {
            return Err(format!(
                "{name}, line {line}: time {} s does not come after {} s",
                row[0], last[0]
            ));
        }
        if rows.len() == ROWS_MAX {
            return Err(format!("{name}: more than {ROWS_MAX} rows"));
        }
        rows.push(row);
    }
    if rows.is_empty() {
        return Err(format!("{name}: no rows below the header"));
    }
    Ok(rows)
}

/// The first row must name the columns; units may follow the names, as in `x [m]`.
fn check_header(header: &csv::StringRecord) -> Result<(), String> {
    let named = |(column, wanted): (&str, &str)| {
        let first = column.split([' ', '[', '(', '/']).next().unwrap_or("");
        let first = first.trim_start_matches('\u{feff}').to_lowercase();
        first == wanted || (wanted == "time" && first == "t")
    };
    let complete = [TRANSLATION, COLUMNS.len()].contains(&header.len());
    if complete && header.iter().zip(COLUMNS).all(named) {
        return Ok(());
    }
    let found: Vec<&str> = header.iter().take(8).collect();
    Err(format!(
        "the header must be \"time,x,y,z\" [s, m] or \"time,x,y,z,roll,pitch,yaw\" [s, m, rad], found \"{}\"",
        found.join(",")
    ))
}

fn row(record: &csv::StringRecord, columns: usize) -> Result<MotionRow, String> {
    if record.len() != columns {
        return Err(format!(
            "expected {columns} numbers ({}), found {}",
            COLUMNS[..columns].join(", "),
            record.len()
        ));
    }
    let mut row = [0.0; 7];
    for ((value, field), column) in row.iter_mut().zip(record).zip(COLUMNS) {
        *value = match field.parse::<f64>() {
            Ok(value) if value.is_finite() => value,
            _ => {
                return Err(format!(
                    "column {column}: expected a finite number, found {field:?}"
                ));
            }
        };
    }
    Ok(row)
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
