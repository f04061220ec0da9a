//! Result of a case, and the table of all results.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use moorline::output::record::{Column, Form};
use moorline::output::table::WholeTable;
use moorline::output::{OutputError, csv, write_file};
use moorline::scene::Format;
use serde::{Deserialize, Serialize};
use toml::Value;

use crate::case::{Case, Key};

/// File name of the table, without its extension.
pub const TABLE: &str = "cases";

/// A column of the results of a run.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Quantity {
    /// Name of the variable, such as `line1.tension_b`.
    pub name: String,
    /// Unit symbol.
    pub unit: String,
}

/// Mean, standard deviation, minimum and maximum of a quantity after the ramp, in its unit.
pub type Figures = [f64; 4];
/// Endings of the names of the columns of [`Figures`], with their descriptions.
const FIGURES: [(&str, &str); 4] = [
    ("mean", "mean over time"),
    ("std", "standard deviation over time"),
    ("min", "least value"),
    ("max", "greatest value"),
];

/// Results of a case that ran to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Results {
    /// The quantities.
    pub quantities: Arc<Vec<Quantity>>,
    /// Figures of each quantity.
    pub figures: Vec<Figures>,
}

/// Quantities and the figures of each, as sent to another process.
type Listed = (Vec<Quantity>, Vec<Figures>);

/// Result of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of the case, from 1.
    pub case: usize,
    /// Keys with their values, as in the case.
    pub values: Vec<(Arc<Key>, Option<Value>)>,
    /// Results, or the reason why there are none.
    pub results: Result<Results, String>,
    /// Remarks on the discretisation and on the run.
    pub notes: Vec<String>,
}

impl Row {
    pub(crate) fn of(case: &Case, results: Result<Results, String>, notes: Vec<String>) -> Row {
        Row {
            case: case.number,
            values: case.values.clone(),
            results,
            notes,
        }
    }

    /// The row as bytes for another process, without the values of its case.
    pub fn to_bytes(&self) -> Vec<u8> {
        let results = self.results.as_ref();
        let results = results.map(|found| (&*found.quantities, &found.figures));
        let ended = (self.case, results, &self.notes);
        postcard::to_stdvec(&ended).expect("every row can be written")
    }

    /// Reads the row of one of these cases; `None` if the bytes are not such a row.
    pub fn of_bytes(bytes: &[u8], cases: &[Case]) -> Option<Row> {
        let (number, results, notes): (usize, Result<Listed, String>, Vec<String>) =
            postcard::from_bytes(bytes).ok()?;
        let case = number.checked_sub(1).and_then(|index| cases.get(index))?;
        let results = results.map(|(quantities, figures)| Results {
            quantities: Arc::new(quantities),
            figures,
        });
        Some(Row::of(case, results, notes))
    }
}

/// Columns and rows of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The columns: number of the case, keys, reason of a failure, remarks, figures.
    pub columns: Vec<Column>,
    /// Rows with a value for every column, in its form and unit [N, m, …]: not a number if there is none.
    pub rows: Vec<Vec<f64>>,
}

/// Makes the table of rows, in the order of their cases.
pub fn table(rows: &[Row]) -> Table {
    let mut rows: Vec<&Row> = rows.iter().collect();
    rows.sort_by_key(|row| row.case);
    let mut columns = vec![Column::new("case", "1", "number of the case", Form::Whole)];
    let mut values = vec![rows.iter().map(|row| row.case as f64).collect()];
    let keys = rows.first().map_or(0, |row| row.values.len());
    for index in 0..keys {
        let key = &rows[0].values[index].0;
        let (form, column) = of_values(rows.iter().map(|row| row.values[index].1.as_ref()));
        let unit = key.unit.as_deref().unwrap_or("1");
        columns.push(Column::new(&key.path, unit, "value of the case", form));
        values.push(column);
    }
    let failures = rows
        .iter()
        .map(|row| row.results.as_ref().err().cloned().unwrap_or_default());
    let notes = rows.iter().map(|row| row.notes.join("; "));
    let texts: [(&str, &str, Vec<String>); 2] = [
        (
            "failure",
            "reason why the case has no results",
            failures.collect(),
        ),
        ("notes", "remarks on the mesh and on the run", notes.collect()),
    ];
    for (name, description, texts) in texts {
        let (form, column) = of_texts(texts);
        columns.push(Column::new(name, "1", description, form));
        values.push(column);
    }
    let (quantities, places) = quantities(&rows);
    for quantity in &quantities {
        for (ending, words) in FIGURES {
            let name = format!("{}.{ending}", quantity.name);
            columns.push(Column::new(&name, &quantity.unit, words, Form::Sparse));
        }
    }
    let row = |index: usize| {
        let mut row: Vec<f64> = values.iter().map(|column| column[index]).collect();
        let results = rows[index].results.as_ref().ok();
        let first = row.len();
        row.resize(columns.len(), f64::NAN);
        for (quantity, figures) in results
            .iter()
            .flat_map(|results| results.quantities.iter().zip(&results.figures))
        {
            let at = first + FIGURES.len() * places[quantity];
            row[at..at + FIGURES.len()].copy_from_slice(figures);
        }
        row
    };
    let rows = (0..rows.len()).map(row).collect();
    Table { columns, rows }
}

/// Quantities of all rows in the order of their first appearance, with their indices.
fn quantities<'r>(rows: &[&'r Row]) -> (Vec<&'r Quantity>, HashMap<&'r Quantity, usize>) {
    let (mut list, mut places) = (Vec::new(), HashMap::new());
    let mut seen: Vec<&Arc<Vec<Quantity>>> = Vec::new();
    for results in rows.iter().filter_map(|row| row.results.as_ref().ok()) {
        if seen.iter().any(|seen| Arc::ptr_eq(seen, &results.quantities)) {
            continue;
        }
        seen.push(&results.quantities);
        for quantity in results.quantities.iter() {
            places.entry(quantity).or_insert_with(|| {
                list.push(quantity);
                list.len() - 1
            });
        }
    }
    (list, places)
}

/// Form and values of the column of a key: numbers, or texts if any value is not a number.
fn of_values<'v>(values: impl Iterator<Item = Option<&'v Value>> + Clone) -> (Form, Vec<f64>) {
    let number = |value: &Value| {
        value
            .as_float()
            .or(value.as_integer().map(|number| number as f64))
    };
    if values.clone().flatten().all(|value| number(value).is_some()) {
        let whole = values.clone().all(|value| value.is_some_and(Value::is_integer));
        let form = if whole { Form::Whole } else { Form::Sparse };
        return (
            form,
            values
                .map(|value| value.and_then(number).unwrap_or(f64::NAN))
                .collect(),
        );
    }
    let text = |value: Option<&Value>| match value {
        None => String::new(),
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
    };
    of_texts(values.map(text).collect())
}

/// Form and values of a column of texts.
fn of_texts(texts: Vec<String>) -> (Form, Vec<f64>) {
    let (mut names, mut places) = (Vec::new(), HashMap::new());
    let values = texts.into_iter().map(|text| {
        let place = *places.entry(text).or_insert_with_key(|text| {
            names.push(text.clone());
            names.len() - 1
        });
        place as f64
    });
    let values = values.collect();
    (Form::Name(names), values)
}

impl Table {
    /// Writes the table into a folder: `cases.csv` and `cases.parquet`, with `cases.units.csv` next to them.
    ///
    /// # Errors
    /// A file that cannot be written; the old file is then kept.
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        for (format, ending) in [(Format::Csv, "csv"), (Format::Parquet, "parquet")] {
            let path = folder.join(TABLE).with_extension(ending);
            let mut table = WholeTable::create(&path, format, &self.columns, None)?;
            for row in &self.rows {
                table.row(row)?;
            }
            table.finish()?;
        }
        let units = folder.join(format!("{TABLE}.units.csv"));
        write_file(&units, |out| csv::write_units(&self.columns, out))
    }
}
