//! Tables of a deck: rows of cells with their columns and their places in the file.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::ops::Range;

use moorline::scene::nearest::nearest;
use moorline::scene::rows::{Field, Row, number, shown};
use moorline::scene::units::{differ, is_foreign};

use crate::findings::{Findings, Placed};

/// Maximum number of rows of a table [-]: more than any mooring needs, and few enough for every check.
pub(crate) const ROWS_MAX: usize = 5_000;

/// A column of a table.
#[derive(Debug)]
pub(crate) struct Column {
    /// Name in messages, as in the format's own documentation.
    pub name: &'static str,
    /// Unit of its numbers; "-" if they have none.
    unit: &'static str,
    /// Names in headers, in capitals, separated by blanks.
    pub spellings: &'static str,
}

/// Returns a column with its name, unit and spellings.
pub(crate) const fn column(name: &'static str, unit: &'static str, spellings: &'static str) -> Column {
    Column {
        name,
        unit,
        spellings,
    }
}

/// Returns whether a word is in a list of words separated by blanks, regardless of case.
pub(crate) fn is_one_of(word: &str, list: &str) -> bool {
    list.split(' ').any(|known| known.eq_ignore_ascii_case(word))
}

/// Reads the rows of a section whose number of cells equals that of one of the lists of columns, which are in ascending order, or exceeds the
/// last.
pub(crate) fn read_rows<T>(
    section: &str,
    rows: &[Row<'_>],
    lists: &[&'static [Column]],
    findings: &mut Findings,
    mut read: impl FnMut(&mut Cells<'_, '_>) -> T,
) -> Vec<T> {
    let mut table = Vec::new();
    for (index, row) in rows.iter().take(ROWS_MAX).enumerate() {
        let (fields, place) = (row.fields(), format!("{section}, row {}", index + 1));
        let widest = lists.last().filter(|list| list.len() < fields.len());
        match lists.iter().find(|list| list.len() == fields.len()).or(widest) {
            Some(columns) => table.push(read(&mut Cells {
                place,
                fields: &fields,
                columns,
                findings,
            })),
            None => {
                let problem = format!("{} columns, expected {}", fields.len(), in_words(lists));
                findings.mistake(place, row.span(), problem);
            }
        }
    }
    table
}

/// Describes lists of columns, for example `9 (ID Attachment …) or 12 (ID Type …)`.
fn in_words(lists: &[&'static [Column]]) -> String {
    let list = |columns: &&[Column]| {
        let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
        format!("{} ({})", columns.len(), names.join(" "))
    };
    lists.iter().map(list).collect::<Vec<_>>().join(" or ")
}

/// Row of a table, read cell by cell. Every wrong cell adds a mistake; the value returned for it only allows reading to continue.
pub(crate) struct Cells<'r, 't> {
    /// Section and row in messages, such as "LINES, row 2".
    pub place: String,
    pub fields: &'r [Field<'t>],
    pub columns: &'static [Column],
    pub findings: &'r mut Findings,
}

impl Cells<'_, '_> {
    /// Adds a mistake for a cell.
    pub(crate) fn wrong(&mut self, column: usize, problem: impl Into<String>) {
        let about = format!("{}, {}", self.place, self.columns[column].name);
        self.findings
            .mistake(about, self.fields[column].span.clone(), problem);
    }

    /// Returns a value with the byte range of a cell.
    pub(crate) fn placed<T>(&self, column: usize, value: T) -> Placed<T> {
        let span = self.fields[column].span.clone();
        Placed { value, span }
    }

    /// Returns the value of a cell; for an error, adds a mistake and returns the value `instead`.
    pub(crate) fn read<T>(&mut self, column: usize, value: Result<T, String>, instead: T) -> Placed<T> {
        let value = value.unwrap_or_else(|problem| {
            self.wrong(column, problem);
            instead
        });
        self.placed(column, value)
    }

    /// Returns the text of a cell.
    pub(crate) fn word(&self, column: usize) -> Placed<String> {
        self.placed(column, self.fields[column].text.to_string())
    }

    /// Reads a number, in the unit of its column.
    pub(crate) fn number(&mut self, column: usize) -> Placed<f64> {
        let value = number(self.fields[column].text).map_err(|problem| match self.columns[column].unit {
            "-" => problem,
            unit => problem.replacen("number,", &format!("number [{unit}],"), 1),
        });
        self.read(column, value, 0.0)
    }

    /// Reads three numbers from three columns.
    pub(crate) fn vector(&mut self, column: usize) -> [Placed<f64>; 3] {
        [0, 1, 2].map(|axis| self.number(column + axis))
    }

    /// Reads a whole number, at least `least`.
    pub(crate) fn count(&mut self, column: usize, least: usize) -> Placed<usize> {
        let text = self.fields[column].text;
        let value = text.parse::<usize>().ok().filter(|value| *value >= least);
        let value =
            value.ok_or_else(|| format!("expected a whole number from {least} on, found {}", shown(text)));
        self.read(column, value, least)
    }
}

/// Returns a word or row of the file with its byte range.
pub(crate) fn placed_text(text: &str, span: &Range<usize>) -> Placed<String> {
    let (value, span) = (text.to_string(), span.clone());
    Placed { value, span }
}

/// Joins the words above the first section to a title of one line.
pub(crate) fn title<'r, 't: 'r>(rows: impl Iterator<Item = &'r Row<'t>>) -> String {
    let words: Vec<&str> = rows.flat_map(Row::fields).map(|field| field.text).collect();
    let title = words.join(" ");
    title.chars().filter(|c| !c.is_control()).take(200).collect()
}

/// Adds a mistake for each number or name that an earlier row of the table already has.
pub(crate) fn check_unique<'d, T: Ord + Display + 'd>(
    names: impl Iterator<Item = &'d Placed<T>>,
    what: &str,
    findings: &mut Findings,
) {
    let mut seen = BTreeSet::new();
    for name in names {
        if !seen.insert(&name.value) {
            let problem = format!("a second {what} {}: take another", name.value);
            findings.wrong(format!("{what} {}", name.value), name, problem);
        }
    }
}

/// Returns whether a row begins a section: nothing is in front of its dashes `---` but marks, or the name of a section.
pub(crate) fn begins_section(row: &Row<'_>, is_known: impl Fn(&str) -> bool) -> bool {
    let Some((front, _)) = row.text.split_once("---") else {
        return false;
    };
    !front.contains(char::is_alphanumeric) || front.trim_start().starts_with("--") || is_known(front)
}

/// Refuses a line for the names or units of columns that is a row of the table, as it would not be read. Rows have a number in the column
/// `numbered`.
pub(crate) fn check_heading(section: &str, heading: &Row<'_>, numbered: usize, findings: &mut Findings) {
    let fields = heading.fields();
    let is_number = |field: &&Field<'_>| number(field.text).is_ok();
    let numbers = fields.iter().filter(is_number).count();
    let is_row = fields.get(numbered).as_ref().is_some_and(is_number);
    if fields.len() > 2 && (is_row || 2 * numbers > fields.len()) {
        findings.mistake(
            section,
            heading.span(),
            "the two lines below a section's header are the names and units of its columns and are never read, \
             and this one holds numbers: write both of them above the rows",
        );
    }
}

/// Returns the remark on an unknown option or flag, which is ignored.
pub(crate) fn left_out<'a>(
    what: &str,
    name: &str,
    known: impl IntoIterator<Item = &'a str> + Clone,
) -> String {
    let meant = nearest(name, known);
    let meant = meant.map_or(String::new(), |known| format!(", did you mean {known}?"));
    format!("the {what} {} is not known and left out{meant}", shown(name))
}

/// Refuses a unit above a column with numbers other than 0 if it differs from the column's unit of the same quantity, and remarks on one that
/// is no unit of this quantity. The programs that use such decks do not read units either.
pub(crate) fn check_units(units: &Row<'_>, columns: &[Column], rows: &[Row<'_>], findings: &mut Findings) {
    for (place, (unit, column)) in units.fields().iter().zip(columns).enumerate() {
        let counts = |row: &Row<'_>| {
            row.fields()
                .get(place)
                .is_some_and(|cell| number(cell.text) != Ok(0.0))
        };
        if !rows.iter().take(ROWS_MAX).any(counts) {
            continue;
        }
        if differ(unit.text, column.unit) {
            let problem = format!(
                "the header has {} over {}, but numbers there are read in {}, whatever stands above them: convert them, and write that unit",
                unit.text, column.name, column.unit
            );
            findings.mistake("", unit.span.clone(), problem);
        } else if is_foreign(unit.text, column.unit) && !column.unit.contains(',') {
            // A column whose numbers have several meanings has separate remarks.
            let (word, name, read) = (shown(unit.text), column.name, column.unit);
            let text = format!("the header has {word} over {name}, but numbers there are read in {read}");
            findings.remark_at(unit.span.start, text);
        }
    }
}

/// Remarks on a name above a column that belongs to another column: columns are identified by position, not by name.
pub(crate) fn compare_header(header: &Row<'_>, columns: &[Column], findings: &mut Findings) {
    let names = header.fields();
    let is =
        |text: &str, column: &Column| is_one_of(text.trim_matches(['(', ')', '*', '#']), column.spellings);
    let wrong = names.iter().zip(columns).enumerate().find(|(_, (name, column))| {
        !is(name.text, column) && columns.iter().any(|other| is(name.text, other))
    });
    if let Some((place, (name, column))) = wrong {
        let text = format!(
            "the header calls column {} {:?}, but columns count by their place, and this one is read as {}",
            place + 1,
            name.text,
            column.name
        );
        findings.remark_at(name.span.start, text);
    }
}
