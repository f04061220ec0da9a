//! Text -> rows of fields that know their place: the ground of every reader whose format is a table in columns.

use std::ops::Range;

use super::{Note, SceneError, path};

/// Most mistakes that are told of one file: nobody reads more.
pub(super) const MISTAKES_MAX: usize = 50;

/// Most rows of a table: beyond any mooring, and short enough for every check.
pub(super) const ROWS_MAX: usize = 5_000;

/// A word of a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Field<'t> {
    pub text: &'t str,
    /// Bytes of the file.
    pub span: Range<usize>,
}

/// A line of the file that is not blank.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row<'t> {
    /// The line without its end, and without a byte order mark.
    pub text: &'t str,
    /// Byte of the file where `text` starts.
    pub start: usize,
}

impl<'t> Row<'t> {
    /// The lines of a text that hold more than blanks.
    pub(super) fn all(text: &'t str) -> impl Iterator<Item = Row<'t>> {
        let mut at = 0;
        text.split_inclusive(['\n', '\r']).filter_map(move |line| {
            let mut start = at;
            at += line.len();
            let mut line = line.trim_end();
            if let Some(rest) = line.strip_prefix('\u{feff}') {
                start += line.len() - rest.len();
                line = rest;
            }
            (!line.trim_start().is_empty()).then_some(Row { text: line, start })
        })
    }

    /// Bytes of the file, without blanks around the text.
    pub(super) fn span(&self) -> Range<usize> {
        let blanks = self.text.len() - self.text.trim_start().len();
        self.start + blanks..self.start + self.text.len()
    }

    /// The row without what stands behind the first `mark`.
    pub(super) fn before(&self, mark: char) -> Row<'t> {
        let end = self.text.find(mark).unwrap_or(self.text.len());
        Row {
            text: self.text[..end].trim_end(),
            start: self.start,
        }
    }

    /// The words of the row.
    pub(super) fn fields(&self) -> Vec<Field<'t>> {
        self.split(|c| c.is_whitespace())
    }

    /// The parts of the row between characters that separate them.
    pub(super) fn split(&self, separates: impl Fn(char) -> bool) -> Vec<Field<'t>> {
        let mut fields = Vec::new();
        let mut begin = None;
        let ends = self.text.char_indices().map(|(at, c)| (at, separates(c)));
        for (at, outside) in ends.chain([(self.text.len(), true)]) {
            match (begin, outside) {
                (None, false) => begin = Some(at),
                (Some(from), true) => {
                    fields.push(Field {
                        text: &self.text[from..at],
                        span: self.start + from..self.start + at,
                    });
                    begin = None;
                }
                _ => {}
            }
        }
        fields
    }
}

/// Reads a number in the forms of C and of Fortran (`1.0D5`).
///
/// # Errors
/// What it is instead.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let fortran = text.replace(['d', 'D'], "e");
    let plain = |text: &str| {
        let digits = text.bytes().any(|byte| byte.is_ascii_digit());
        digits.then(|| text.parse::<f64>().ok()).flatten()
    };
    match plain(text).or_else(|| plain(&fortran)) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(format!("{} is beyond all numbers", shown(text))),
        None => {
            let lower = text.trim_start_matches(['+', '-']).to_lowercase();
            let endless = ["nan", "inf", "infinity"].contains(&lower.as_str());
            let kind = if endless { "a finite number" } else { "a number" };
            Err(format!("expected {kind}, found {}", shown(text)))
        }
    }
}

/// A word of the file in quotes, shortened where it is long.
pub(super) fn shown(text: &str) -> String {
    if text.chars().count() <= 40 {
        return format!("{text:?}");
    }
    let beginning: String = text.chars().take(37).collect();
    format!("{:?}", beginning + "…")
}

/// What a reader has found so far: mistakes with their bytes, remarks with their lines.
#[derive(Debug, Default)]
pub(super) struct Findings {
    pub mistakes: Vec<SceneError>,
    pub remarks: Vec<Remark>,
}

/// A remark on a part of the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Remark {
    /// First byte of what it is about; `None` where it is the whole file.
    pub byte: Option<usize>,
    pub text: String,
}

impl Findings {
    /// Notes a mistake: what it is about, where, what would be right.
    pub(super) fn mistake(&mut self, at: impl Into<String>, span: Range<usize>, problem: impl Into<String>) {
        if self.mistakes.len() < MISTAKES_MAX {
            self.mistakes.push(SceneError {
                at: at.into(),
                problem: problem.into(),
                span: Some(span),
            });
        }
    }

    /// Remarks on the text at a byte.
    pub(super) fn remark(&mut self, byte: usize, text: impl Into<String>) {
        self.remarks.push(Remark {
            byte: Some(byte),
            text: text.into(),
        });
    }

    /// Remarks on the whole file.
    pub(super) fn remark_on_all(&mut self, text: impl Into<String>) {
        self.remarks.push(Remark {
            byte: None,
            text: text.into(),
        });
    }

    /// The remarks with the numbers of their lines, in the order of the file; those on the whole file first.
    pub(super) fn notes(&self, source: &str) -> Vec<Note> {
        let note = |remark: &Remark| {
            let at = match remark.byte {
                Some(byte) => format!("file line {}", path::line_column(source, byte).0),
                None => "file".to_string(),
            };
            Note::new(at, &remark.text)
        };
        let mut remarks = self.remarks.clone();
        remarks.sort_by_key(|remark| remark.byte);
        remarks.iter().map(note).collect()
    }
}

/// A value and the bytes it was read from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Placed<T> {
    pub value: T,
    pub span: Range<usize>,
}

/// A column of a table.
#[derive(Debug)]
pub(super) struct Column {
    /// Its name in messages, as the format's own documentation has it.
    pub name: &'static str,
    /// Unit of its numbers; "-" where they have none.
    pub unit: &'static str,
    /// What headers call it, in capitals.
    pub spellings: &'static [&'static str],
}

/// A row of a table, cell by cell. Every wrong cell is noted; the value returned for it only keeps the reading going.
pub(super) struct Cells<'r, 't> {
    /// Section and row in messages, such as "LINES, row 2".
    pub place: String,
    pub fields: &'r [Field<'t>],
    pub columns: &'static [Column],
    pub findings: &'r mut Findings,
}

impl Cells<'_, '_> {
    fn about(&self, column: usize) -> String {
        format!("{}, {}", self.place, self.columns[column].name)
    }

    /// Bytes of a cell.
    pub(super) fn span(&self, column: usize) -> Range<usize> {
        self.fields[column].span.clone()
    }

    /// Notes a mistake in a cell.
    pub(super) fn wrong(&mut self, column: usize, problem: impl Into<String>) {
        let (about, span) = (self.about(column), self.span(column));
        self.findings.mistake(about, span, problem);
    }

    /// The cell as it stands.
    pub(super) fn word(&self, column: usize) -> Placed<String> {
        Placed {
            value: self.fields[column].text.to_string(),
            span: self.span(column),
        }
    }

    /// A number, in the unit of its column.
    pub(super) fn number(&mut self, column: usize) -> Placed<f64> {
        let value = number(self.fields[column].text).unwrap_or_else(|problem| {
            let unit = self.columns[column].unit;
            let with_unit = match unit {
                "-" => problem,
                unit => problem.replacen("number,", &format!("number [{unit}],"), 1),
            };
            self.wrong(column, with_unit);
            0.0
        });
        Placed {
            value,
            span: self.span(column),
        }
    }

    /// Three numbers in three columns.
    pub(super) fn vector(&mut self, column: usize) -> [Placed<f64>; 3] {
        [0, 1, 2].map(|axis| self.number(column + axis))
    }

    /// A whole number, one or more.
    pub(super) fn count(&mut self, column: usize, least: usize) -> Placed<usize> {
        let text = self.fields[column].text;
        let value = text.parse::<usize>().ok().filter(|value| *value >= least);
        Placed {
            value: value.unwrap_or_else(|| {
                let problem = format!("expected a whole number from {least} on, found {}", shown(text));
                self.wrong(column, problem);
                least
            }),
            span: self.span(column),
        }
    }
}

/// Says where the names above a table are those of other columns: readers go by the place of a column, not by its name.
pub(super) fn compare_header(header: &Row<'_>, columns: &[Column], findings: &mut Findings) {
    let names = header.fields();
    let is = |text: &str, column: &Column| {
        let upper = text.trim_matches(['(', ')', '*', '#']).to_uppercase();
        column.spellings.contains(&upper.as_str())
    };
    let wrong = names.iter().zip(columns).enumerate().find(|(_, (name, column))| {
        !is(name.text, column) && columns.iter().any(|other| is(name.text, other))
    });
    if let Some((place, (name, column))) = wrong {
        findings.remark(
            name.span.start,
            format!(
                "the header calls column {} {:?}, but columns count by their place, and this one is read as {}",
                place + 1,
                name.text,
                column.name
            ),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_know_their_bytes_across_all_ends_of_lines() {
        let text = "\u{feff}a b\r\n\r\n  ü\tc # d\rlast";
        let rows: Vec<Row<'_>> = Row::all(text).collect();
        assert_eq!(rows.len(), 3);
        for row in &rows {
            for field in row.fields() {
                assert_eq!(&text[field.span.clone()], field.text);
            }
        }
        let words = rows[1].before('#').fields();
        let words: Vec<&str> = words.iter().map(|field| field.text).collect();
        assert_eq!(words, ["ü", "c"]);
    }

    #[test]
    fn numbers_of_c_and_fortran_are_read_and_nothing_else_is() {
        for (text, value) in [("1.0D5", 1e5), ("-3.e-2", -0.03), ("+7", 7.0), (".5d+1", 5.0)] {
            assert_eq!(number(text), Ok(value));
        }
        for text in [
            "", "NaN", "inf", "1e400", "0,3", "main", "1.0.0", "--1", "0x10", "1_000", "d",
        ] {
            assert!(number(text).is_err(), "{text}");
        }
    }
}
