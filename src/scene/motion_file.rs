//! Motion tables in CSV files: a header row, then time, x, y, z.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Columns of a motion file, in order.
const COLUMNS: [&str; 4] = ["time", "x", "y", "z"];

/// Most rows that are read: a day at 100 Hz.
const ROWS_MAX: usize = 8_640_000;

/// Rows of time [s] and displacement x, y, z [m].
///
/// # Errors
/// The file, the line and what would be right.
pub(super) fn read(path: &Path) -> Result<Vec<[f64; 4]>, String> {
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
    check_header(header).map_err(|problem| format!("{name}, line 1: {problem}"))?;
    let mut rows: Vec<[f64; 4]> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| format!("{name}: {}", in_words(&error)))?;
        let line = record.position().map_or(0, csv::Position::line);
        let row = row(&record).map_err(|problem| format!("{name}, line {line}: {problem}"))?;
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
    if header.len() == COLUMNS.len() && header.iter().zip(COLUMNS).all(named) {
        return Ok(());
    }
    let found: Vec<&str> = header.iter().take(8).collect();
    Err(format!(
        "the header must be \"time,x,y,z\" [s, m], found \"{}\"",
        found.join(",")
    ))
}

fn row(record: &csv::StringRecord) -> Result<[f64; 4], String> {
    if record.len() != COLUMNS.len() {
        return Err(format!(
            "expected 4 numbers (time, x, y, z), found {}",
            record.len()
        ));
    }
    let mut row = [0.0; 4];
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
