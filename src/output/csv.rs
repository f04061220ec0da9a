//! Tables as comma-separated values.
//!
//! `results.csv` has one plain header row (`time,fairlead.x,…`) and one row for every output time, as expected by `pandas.read_csv` and spreadsheets;
//! `results.units.csv` has a row `name,unit,description` for every column. `profile.csv` holds the shape of the lines in long form, with a row for
//! every time, line and node. Numbers have the fewest digits that read back to the same bits, or as many as the scene specifies.

use std::io::{self, Write};
use std::time::{Duration, Instant};

use super::OutputError;
use super::growing::Growing;
use super::record::{Column, Form};

/// Size of the text buffer [bytes].
const BUFFER: usize = 1 << 16;
/// Time since the last write after which a new row is written at once.
const DELAY: Duration = Duration::from_secs(1);

/// Table that is written row by row. Only whole rows are written: when the buffer is full, or with the first row that is added a second or more after
/// the last write.
#[derive(Debug)]
pub(super) struct CsvTable {
    file: Growing,
    text: RowText,
    buffer: Vec<u8>,
    written: Instant,
}

impl CsvTable {
    /// Opens a table in a new file, with its header row, or in a file that continues after its last row.
    pub(super) fn open(
        mut file: Growing,
        columns: &[Column],
        digits: Option<usize>,
    ) -> Result<CsvTable, OutputError> {
        if file.end() == 0 {
            file.append(&header(columns), Vec::new())?;
        }
        Ok(CsvTable {
            file,
            text: RowText::new(columns, digits),
            buffer: Vec::with_capacity(BUFFER + BUFFER / 8),
            written: Instant::now(),
        })
    }

    /// Adds a row with a value for every column.
    pub(super) fn row(&mut self, values: &[f64]) -> Result<(), OutputError> {
        self.text.push(values, &mut self.buffer);
        match self.buffer.len() >= BUFFER || self.written.elapsed() >= DELAY {
            true => self.flush(),
            false => Ok(()),
        }
    }

    /// Writes the buffered rows.
    pub(super) fn flush(&mut self) -> Result<(), OutputError> {
        self.written = Instant::now();
        self.file.append(&self.buffer, Vec::new())?;
        self.buffer.clear();
        Ok(())
    }

    /// File with the rows written so far.
    pub(super) fn file(&mut self) -> &mut Growing {
        &mut self.file
    }
}

/// Header row with the names of columns.
fn header(columns: &[Column]) -> Vec<u8> {
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    quoted(&names)
}

/// Row of texts, quoted if necessary, with its line end.
fn quoted(texts: &[&str]) -> Vec<u8> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let row = table.write_record(texts).and_then(|()| Ok(table.flush()?));
    row.expect("a vector takes any row");
    table.into_inner().expect("a vector takes any row")
}

/// Text of rows.
#[derive(Debug)]
struct RowText {
    forms: Vec<Form>,
    digits: Option<usize>,
    scratch: String,
}

impl RowText {
    fn new(columns: &[Column], digits: Option<usize>) -> RowText {
        let quoted_name = |name: &String| {
            if name.is_empty() {
                return String::new(); // alone in a row it would be quoted
            }
            let row = quoted(&[name]);
            String::from_utf8_lossy(&row[..row.len() - 1]).into_owned()
        };
        let form = |column: &Column| match &column.form {
            Form::Name(names) => Form::Name(names.iter().map(quoted_name).collect()),
            form => form.clone(),
        };
        RowText {
            forms: columns.iter().map(form).collect(),
            digits,
            scratch: String::new(),
        }
    }

    /// Appends a row with its line end.
    fn push(&mut self, values: &[f64], text: &mut Vec<u8>) {
        for (form, &value) in self.forms.iter().zip(values) {
            match (form, self.digits) {
                (Form::Whole, _) if value.is_finite() => push_whole(text, value),
                (Form::Sparse, _) if value.is_nan() => {}
                (Form::Name(names), _) => text.extend(names[value as usize].as_bytes()),
                (Form::Real | Form::Sparse, Some(digits)) => {
                    push_shortest(text, rounded(value, digits, &mut self.scratch));
                }
                _ => push_shortest(text, value),
            }
            text.push(b',');
        }
        text.pop();
        text.push(b'\n');
    }
}

/// Writes name, unit and description of every column.
///
/// # Errors
/// Writing to `out` fails.
pub fn write_units(columns: &[Column], out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["name", "unit", "description"])?;
    for column in columns {
        table.write_record([&column.name, &column.unit, &column.description])?;
    }
    table.flush()
}

/// Shortest text that reads back to the same bits, in scientific notation for values far from 1.
pub(super) fn shortest(value: f64) -> String {
    zmij::Buffer::new().format(value).to_string()
}

/// Rounds a value to a number of significant digits.
pub(super) fn rounded(value: f64, digits: usize, scratch: &mut String) -> f64 {
    use std::fmt::Write;
    scratch.clear();
    let written = write!(scratch, "{value:.*e}", digits - 1);
    written.expect("a string takes any text");
    scratch.parse().expect("a number that was just written")
}

/// Appends a whole number.
pub(super) fn push_whole(text: &mut Vec<u8>, value: f64) {
    let written = match value.abs() < 1e15 && value.is_sign_positive() {
        true => write!(text, "{}", value.round_ties_even() as u64),
        false => write!(text, "{value:.0}"),
    };
    written.expect("a vector takes any text");
}

/// Appends [`shortest`] of a value.
pub(super) fn push_shortest(text: &mut Vec<u8>, value: f64) {
    text.extend_from_slice(zmij::Buffer::new().format(value).as_bytes());
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    fn text(columns: &[Column], digits: Option<usize>, rows: &[Vec<f64>]) -> String {
        let mut bytes = header(columns);
        let mut text = RowText::new(columns, digits);
        rows.iter().for_each(|row| text.push(row, &mut bytes));
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn every_number_reads_back_to_the_same_bits() {
        for value in [0.1, 1.0 / 3.0, 5e-324, -0.0, f64::MAX, 17.008898550123456] {
            let back: f64 = shortest(value).parse().unwrap();
            assert_eq!(back.to_bits(), value.to_bits());
            assert!(shortest(value).len() <= 25);
        }
    }

    #[test]
    fn the_results_read_back_row_by_row() {
        let record = sample::record();
        let text = text(record.columns(), None, &sample::rows());
        let mut table = csv::Reader::from_reader(text.as_bytes());
        let names: Vec<_> = record.columns().iter().map(|c| c.name.clone()).collect();
        assert_eq!(table.headers().unwrap(), &csv::StringRecord::from(names));
        let rows: Vec<Vec<f64>> = table.deserialize().collect::<Result<_, _>>().unwrap();
        assert_eq!(rows, sample::rows());
    }

    fn columns() -> Vec<Column> {
        let names = ["line1".to_string(), "the \"other\", line".to_string()];
        vec![
            Column::time(),
            Column::new("steps", "1", "", Form::Whole),
            Column::new("x", "m", "", Form::Real),
            Column::new("line", "1", "", Form::Name(names.to_vec())),
            Column::new("moment", "N m", "", Form::Sparse),
        ]
    }

    #[test]
    fn counts_are_whole_numbers_and_names_are_quoted_and_missing_values_are_empty() {
        let rows = [
            vec![0.5, 15.0, 15.0, 1.0, f64::NAN],
            vec![1.0, 2.0, -0.0, 0.0, 8.0],
        ];
        let text = text(&columns(), None, &rows);
        let expected =
            "time,steps,x,line,moment\n0.5,15,15.0,\"the \"\"other\"\", line\",\n1.0,2,-0.0,line1,8.0\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn digits_round_results_and_neither_times_nor_counts() {
        let rows = [vec![10799.95, 1_234_567.0, 2_435_556.25, 0.0, 1.234_567e-9]];
        let text = text(&columns(), Some(3), &rows);
        assert_eq!(
            text.lines().nth(1),
            Some("10799.95,1234567,2440000.0,line1,1.23e-9")
        );
    }

    #[test]
    fn a_comma_in_a_description_is_quoted() {
        let mut bytes = Vec::new();
        write_units(sample::record().columns(), &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.starts_with("name,unit,description\ntime,s,simulated time\n"));
        assert!(text.contains("fairlead.fx,N,\"end force, on the vessel\"\n"));
    }
}
