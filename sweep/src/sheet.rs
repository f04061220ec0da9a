//! Reads CASES, CSV or TOML: a list of values for every case, each with its place in the text.
//!
//! In CSV a row is a case, and the header names the keys, optionally with units: `lines.line1.length [km]`. Empty cells keep the value of the
//! base. In TOML every list is a list of values, and the cases are all combinations of the lists, the last list varying fastest; `[[cases]]`
//! are separate blocks of cases, each with the values above the blocks.

use std::ops::Range;
use std::path::{Path, PathBuf};

use moorline::scene::rows::{Row, number};
use moorline::scene::{LoadError, SceneError, is_toml, read_text};
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

/// Maximum number of cases of a sweep [-].
const CASES_MAX: usize = 1_000_000;
/// Key of the blocks of cases in TOML.
const BLOCKS: &str = "cases";

/// A value for a key in a case.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    /// Index of the column.
    pub column: usize,
    /// The value.
    pub value: Value,
    /// Bytes of the value in the text.
    pub span: Range<usize>,
}

/// A key that cases set.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Column {
    /// Key path as written.
    pub path: String,
    /// Unit in the heading.
    pub unit: Option<String>,
    /// Bytes of the key.
    pub span: Range<usize>,
}

/// Values of one case.
#[derive(Debug, Clone)]
pub(crate) struct Draft {
    /// Values in the order of the text.
    pub entries: Vec<Entry>,
    /// Bytes to which a mistake in the case as a whole refers.
    pub span: Range<usize>,
}

/// Content of CASES.
#[derive(Debug)]
pub(crate) struct Sheet {
    pub path: PathBuf,
    pub text: String,
    pub columns: Vec<Column>,
    pub cases: Vec<Draft>,
}

impl Sheet {
    pub(crate) fn read(path: &Path) -> Result<Sheet, LoadError> {
        let text = read_text(path, |_| false)?;
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        let in_toml = match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("toml") => true,
            Some("csv" | "tsv" | "txt") => false,
            _ => is_toml(&text),
        };
        let content = if in_toml { of_toml(&text) } else { of_csv(&text) };
        let path = path.to_path_buf();
        match content {
            Ok((columns, cases)) if !cases.is_empty() => Ok(Sheet {
                path,
                text,
                columns,
                cases,
            }),
            Ok(_) => Err(LoadError::Unreadable {
                path,
                problem: "holds no case: in CSV a row below the header is one, in TOML a key with a list of values makes one of each".into(),
            }),
            Err(mistakes) => Err(LoadError::Scene { path, text, mistakes }),
        }
    }
}

type Content = Result<(Vec<Column>, Vec<Draft>), Vec<SceneError>>;

/// A mistake at a place of CASES.
pub(crate) fn mistake(at: &str, problem: impl Into<String>, span: &Range<usize>) -> SceneError {
    SceneError {
        at: at.to_string(),
        problem: problem.into(),
        span: Some(span.clone()),
    }
}

fn of_csv(text: &str) -> Content {
    let mut rows = Row::all(text).filter(|row| !row.text.trim_start().starts_with('#'));
    let Some(header) = rows.next() else {
        return Ok((Vec::new(), Vec::new()));
    };
    let separator = [';', '\t']
        .into_iter()
        .find(|&c| header.text.contains(c))
        .unwrap_or(',');
    let mut mistakes = Vec::new();
    let columns: Vec<Column> = match cells(&header, separator) {
        Ok(cells) => cells
            .into_iter()
            .map(|(text, span)| heading(&text, span))
            .collect(),
        Err(mistake) => return Err(vec![mistake]),
    };
    for (i, column) in columns.iter().enumerate() {
        if column.path.is_empty() {
            mistakes.push(mistake(
                "",
                "a column without a key: the header names the key of every column",
                &column.span,
            ));
        } else if columns[..i].iter().any(|other| other.path == column.path) {
            mistakes.push(mistake(&column.path, "the column is given twice", &column.span));
        }
    }
    let mut cases = Vec::new();
    for row in rows {
        match draft(&row, separator, &columns) {
            Ok(draft) => cases.push(draft),
            Err(mistake) => mistakes.push(mistake),
        }
    }
    match mistakes.is_empty() {
        true => Ok((columns, cases)),
        false => Err(mistakes),
    }
}

/// Key and unit of a heading such as `output.duration [min]`.
fn heading(text: &str, span: Range<usize>) -> Column {
    let split = text
        .trim()
        .strip_suffix(']')
        .and_then(|text| text.rsplit_once(" ["));
    let (path, unit) = match split {
        Some((path, unit)) => (path.trim(), Some(unit.trim().to_string())),
        None => (text.trim(), None),
    };
    Column {
        path: path.to_string(),
        unit,
        span,
    }
}

/// The case of a row.
fn draft(row: &Row<'_>, separator: char, columns: &[Column]) -> Result<Draft, SceneError> {
    let cells = cells(row, separator)?;
    if cells.len() != columns.len() {
        let problem = format!(
            "{} cells, but the header has {} columns; an empty cell leaves the value of the base, and text with a `{separator}` stands in \
             quotes",
            cells.len(),
            columns.len()
        );
        return Err(mistake("", problem, &row.span()));
    }
    let mut entries = Vec::new();
    for (column, (text, span)) in cells.into_iter().enumerate() {
        if !text.is_empty() {
            let value = value_of(&text, separator);
            entries.push(Entry { column, value, span });
        }
    }
    Ok(Draft {
        entries,
        span: row.span(),
    })
}

/// Cells of a row without surrounding blanks, each with its bytes; quotes may contain separators, and a doubled quote is a quote.
fn cells(row: &Row<'_>, separator: char) -> Result<Vec<(String, Range<usize>)>, SceneError> {
    let mut cells = Vec::new();
    let (mut cell, mut is_quoted, mut begin) = (String::new(), false, 0);
    let mut letters = row.text.char_indices().peekable();
    while let Some((at, c)) = letters.next() {
        match c {
            '"' if is_quoted && letters.peek().is_some_and(|next| next.1 == '"') => {
                letters.next();
                cell.push('"');
            }
            '"' if is_quoted => is_quoted = false,
            '"' if cell.trim().is_empty() => is_quoted = true,
            c if c == separator && !is_quoted => {
                cells.push((std::mem::take(&mut cell), begin..at));
                begin = at + c.len_utf8();
            }
            c => cell.push(c),
        }
    }
    if is_quoted {
        return Err(mistake(
            "",
            "a quote that begins a cell has no end in its row",
            &row.span(),
        ));
    }
    cells.push((cell, begin..row.text.len()));
    let placed = |(cell, span): (String, Range<usize>)| {
        let text = &row.text[span.clone()];
        let start = row.start + span.start + (text.len() - text.trim_start().len());
        let length = text.trim().len();
        (cell.trim().to_string(), start..start + length)
    };
    Ok(cells.into_iter().map(placed).collect())
}

/// Value of a cell: a TOML value, otherwise a number in another form, otherwise text.
fn value_of(text: &str, separator: char) -> Value {
    let begins = text.starts_with(|c: char| c.is_ascii_digit() || "+-.[{\"'".contains(c));
    let is_truth = text == "true" || text == "false";
    if let Some(value) = (begins || is_truth).then(|| parsed(text)).flatten() {
        return value;
    }
    let decimal = match separator {
        ';' => text.replace(',', "."),
        _ => text.to_string(),
    };
    match number(&decimal) {
        Ok(number) => Value::Float(number),
        Err(_) => Value::String(text.to_string()),
    }
}

/// Parses a TOML value.
fn parsed(text: &str) -> Option<Value> {
    let mut table: toml::Table = format!("value = {text}").parse().ok()?;
    let value = table.remove("value")?;
    (table.is_empty() && !matches!(value, Value::Datetime(_))).then_some(value)
}

/// A list of values for a key.
struct Choices {
    column: usize,
    values: Vec<(Value, Range<usize>)>,
}

fn of_toml(text: &str) -> Content {
    let root = match DeTable::parse(text) {
        Ok(root) => root,
        Err(error) => {
            let problem = format!("not TOML: {}", error.message().replace('\n', ", "));
            return Err(vec![mistake("", problem, &error.span().unwrap_or(0..0))]);
        }
    };
    let mut reader = TomlReader {
        text,
        columns: Vec::new(),
        mistakes: Vec::new(),
    };
    let mut shared = Vec::new();
    reader.table(root.get_ref(), "", &mut shared);
    let mut cases = Vec::new();
    match root.get_ref().get(BLOCKS) {
        None => reader.multiply(&[&shared], &root.span(), &mut cases),
        Some(blocks) => {
            for block in reader.blocks(blocks) {
                let mut own = Vec::new();
                reader.table(
                    block.get_ref().as_table().expect("checked by `blocks`"),
                    "",
                    &mut own,
                );
                let twice = own
                    .iter()
                    .find(|own| shared.iter().any(|shared| shared.column == own.column));
                if let Some(choices) = twice {
                    let path = reader.columns[choices.column].path.clone();
                    let problem = "is given above the blocks too: a key stands in one of the two places";
                    reader.mistakes.push(mistake(&path, problem, &block.span()));
                }
                reader.multiply(&[&shared, &own], &block.span(), &mut cases);
            }
        }
    }
    match reader.mistakes.is_empty() {
        true => Ok((reader.columns, cases)),
        false => Err(reader.mistakes),
    }
}

struct TomlReader<'t> {
    text: &'t str,
    columns: Vec<Column>,
    mistakes: Vec<SceneError>,
}

impl TomlReader<'_> {
    /// The blocks of cases.
    fn blocks<'v>(&mut self, value: &'v Spanned<DeValue<'v>>) -> Vec<&'v Spanned<DeValue<'v>>> {
        let list = value.get_ref().as_array();
        let is_table = |block: &Spanned<DeValue<'_>>| block.get_ref().as_table().is_some();
        match list {
            Some(list) if list.iter().all(is_table) => list.iter().collect(),
            _ => {
                let problem = "expected blocks of cases: write [[cases]] above the keys of each";
                self.mistakes.push(mistake(BLOCKS, problem, &value.span()));
                Vec::new()
            }
        }
    }

    /// Adds the values of a table, and of those below it, in the order of the text.
    fn table(&mut self, table: &DeTable<'_>, above: &str, found: &mut Vec<Choices>) {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        for (key, value) in entries {
            let name: &str = key.get_ref();
            let path = match above {
                "" if name == BLOCKS => continue,
                "" => name.to_string(),
                _ if name.starts_with('[') => format!("{above}{name}"),
                _ => format!("{above}.{name}"),
            };
            match value.get_ref() {
                DeValue::Table(below) => self.table(below, &path, found),
                DeValue::Array(list) if list.is_empty() => {
                    self.mistakes.push(mistake(
                        &path,
                        "a list without a value makes no case",
                        &value.span(),
                    ));
                }
                DeValue::Array(list) => {
                    let values = list.iter().map(|value| self.value(value)).collect();
                    let column = self.column(path, key.span());
                    found.push(Choices { column, values });
                }
                _ => {
                    let values = vec![self.value(value)];
                    let column = self.column(path, key.span());
                    found.push(Choices { column, values });
                }
            }
        }
    }

    fn value(&self, value: &Spanned<DeValue<'_>>) -> (Value, Range<usize>) {
        let span = value.span();
        let read = parsed(&self.text[span.clone()]);
        let as_text = || Value::String(self.text[span.clone()].to_string());
        (read.unwrap_or_else(as_text), span.clone())
    }

    /// Index of the column of a path, which is added if it is new.
    fn column(&mut self, path: String, span: Range<usize>) -> usize {
        let known = self.columns.iter().position(|column| column.path == path);
        known.unwrap_or_else(|| {
            self.columns.push(Column {
                path,
                unit: None,
                span,
            });
            self.columns.len() - 1
        })
    }

    /// Adds a case for every combination of the values.
    fn multiply(&mut self, parts: &[&Vec<Choices>], span: &Range<usize>, cases: &mut Vec<Draft>) {
        let choices: Vec<&Choices> = parts.iter().flat_map(|part| part.iter()).collect();
        let count = choices
            .iter()
            .try_fold(1, |count: usize, one| count.checked_mul(one.values.len()));
        let fits = count.is_some_and(|count| count + cases.len() <= CASES_MAX);
        let Some(count) = count.filter(|_| fits) else {
            let problem =
                format!("more than {CASES_MAX} cases: lists multiply; divide them among several sweeps");
            self.mistakes.push(mistake("", problem, span));
            return;
        };
        if choices.is_empty() {
            return;
        }
        for case in 0..count {
            let mut rest = case;
            let mut entries: Vec<Entry> = choices
                .iter()
                .rev()
                .map(|choices| {
                    let (value, span) = choices.values[rest % choices.values.len()].clone();
                    rest /= choices.values.len();
                    Entry {
                        column: choices.column,
                        value,
                        span,
                    }
                })
                .collect();
            entries.reverse();
            let span = entries[0].span.clone();
            cases.push(Draft { entries, span });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(content: Content) -> Vec<Vec<(String, String)>> {
        let (columns, cases) = content.unwrap();
        let of_case = |case: &Draft| {
            let entries = case.entries.iter();
            entries
                .map(|entry| (columns[entry.column].path.clone(), entry.value.to_string()))
                .collect()
        };
        cases.iter().map(of_case).collect()
    }

    fn pairs(list: &[(&str, &str)]) -> Vec<(String, String)> {
        list.iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect()
    }

    #[test]
    fn a_row_of_csv_is_a_case_and_an_empty_cell_leaves_the_base() {
        let text = "# heights\n a.b , c,d [km],e\n1, jonswap, 1.5e3 ,\"[1, 2]\"\n\n,,-2,true\n";
        let expected = [
            pairs(&[
                ("a.b", "1"),
                ("c", "\"jonswap\""),
                ("d", "1500.0"),
                ("e", "[1, 2]"),
            ]),
            pairs(&[("d", "-2"), ("e", "true")]),
        ];
        assert_eq!(values(of_csv(text)), expected);
        let (columns, _) = of_csv(text).unwrap();
        assert_eq!(
            (columns[2].path.as_str(), columns[2].unit.as_deref()),
            ("d", Some("km"))
        );
        assert_eq!(&text[columns[2].span.clone()], "d [km]");
    }

    #[test]
    fn cells_know_their_bytes() {
        let text = "a,b\n x ,\"q, \"\"r\"\"\"\n";
        let (_, cases) = of_csv(text).unwrap();
        let entries = &cases[0].entries;
        assert_eq!(&text[entries[0].span.clone()], "x");
        assert_eq!(entries[1].value.as_str(), Some("q, \"r\""));
    }

    #[test]
    fn lists_of_toml_multiply_and_the_last_is_the_fastest() {
        let text = "seed = [1, 2]\n[water.waves]\npeak_period = 9.0\nsignificant_height = [4.0, 6.0]\n";
        let case = |seed: &str, height: &str| {
            let names = [
                "seed",
                "water.waves.peak_period",
                "water.waves.significant_height",
            ];
            names
                .map(String::from)
                .into_iter()
                .zip([seed, "9.0", height].map(String::from))
                .collect::<Vec<_>>()
        };
        let expected = [
            case("1", "4.0"),
            case("1", "6.0"),
            case("2", "4.0"),
            case("2", "6.0"),
        ];
        assert_eq!(values(of_toml(text)), expected);
    }

    #[test]
    fn blocks_of_toml_stand_beside_one_another_with_what_is_above_them() {
        let text = "x = 1\n[[cases]]\ny = [2, 3]\n[[cases]]\nz = 4\n";
        let expected = [
            pairs(&[("x", "1"), ("y", "2")]),
            pairs(&[("x", "1"), ("y", "3")]),
            pairs(&[("x", "1"), ("z", "4")]),
        ];
        assert_eq!(values(of_toml(text)), expected);
    }

    #[test]
    fn what_makes_no_case_is_refused_at_its_place() {
        let problem = |content: Content| content.unwrap_err()[0].clone();
        let lists = ["a", "b", "c"].map(|key| format!("{key} = [{}]", "1, ".repeat(200)));
        let many = problem(of_toml(&lists.join("\n")));
        assert!(many.problem.contains("more than 1000000 cases"), "{many}");
        assert_eq!(problem(of_toml("a = []")).span, Some(4..6));
        assert!(
            problem(of_csv("a,b\n1\n"))
                .problem
                .contains("1 cells, but the header has 2 columns")
        );
        assert!(problem(of_csv("a,a\n1,2\n")).problem.contains("twice"));
        assert!(problem(of_csv("a\n\"1\n")).problem.contains("quote"));
    }
}
