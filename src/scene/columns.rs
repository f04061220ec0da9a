//! Tables of numbers in text files: separators, headers, units and decimal commas, inferred from their content. Blank lines and lines that begin with # are
//! skipped.

use std::io::{BufRead, Read};

use super::rows::shown;
use super::units;

/// Maximum length of a line [bytes].
const LINE_MAX: u64 = 1 << 20;

/// Hint on numbers with decimal commas that are separated by commas, tabs or blanks.
pub(super) const DECIMAL_COMMAS: &str = "; decimal commas are read where `;` stands between the columns";

/// Separator of the columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    Comma,
    Semicolon,
    /// Tabs in a header, whose names may contain blanks.
    Tab,
    Blank,
}

impl Separator {
    /// Infers the separator from a row.
    pub(super) fn of(row: &str) -> Separator {
        if row.contains(';') {
            Separator::Semicolon
        } else if row.contains(',') {
            Separator::Comma
        } else if row.trim().contains('\t') {
            Separator::Tab
        } else {
            Separator::Blank
        }
    }

    /// Name in a sentence.
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Separator::Comma => "commas",
            Separator::Semicolon => "semicolons",
            Separator::Tab => "tabs",
            Separator::Blank => "blanks",
        }
    }

    /// The cells of a row of numbers or units.
    pub(super) fn cells(self, row: &str) -> Vec<&str> {
        let clean = |cell| str::trim_matches(str::trim(cell), '"').trim();
        match self {
            Separator::Comma => row.split(',').map(clean).collect(),
            Separator::Semicolon => row.split(';').map(clean).collect(),
            Separator::Tab | Separator::Blank => row.split_whitespace().map(clean).collect(),
        }
    }

    /// The names of a header with their units.
    pub(super) fn headings(self, row: &str) -> Vec<Heading> {
        if self == Separator::Tab {
            let cells = row.trim().split('\t').map(str::trim);
            return cells.map(|cell| Heading::of(cell.trim_matches('"'))).collect();
        }
        let mut joined: Vec<String> = Vec::new();
        for cell in self.cells(row) {
            match joined.last_mut() {
                Some(last) if self == Separator::Blank && cell.starts_with(['[', '(']) => {
                    *last = format!("{last} {cell}");
                }
                _ => joined.push(cell.to_string()),
            }
        }
        joined.iter().map(|cell| Heading::of(cell)).collect()
    }

    /// Reads a finite number from a cell; decimal commas are accepted if semicolons separate the columns.
    ///
    /// # Errors
    /// The cell that was found instead of a number.
    pub(super) fn number(self, cell: &str) -> Result<f64, String> {
        let plain = |text: &str| text.parse::<f64>().ok().filter(|value| value.is_finite());
        let comma = self == Separator::Semicolon && cell.matches(',').count() == 1;
        let value = match comma && !cell.contains('.') {
            true => plain(&cell.replace(',', ".")),
            false => plain(cell),
        };
        value.ok_or_else(|| {
            let hint = match cell.contains(',') && self != Separator::Semicolon {
                true => DECIMAL_COMMAS,
                false => "",
            };
            format!("expected a finite number, found {}{hint}", shown(cell))
        })
    }
}

/// Returns whether a cell holds a number, finite or not.
pub(super) fn is_number(cell: &str) -> bool {
    cell.replacen(',', ".", 1).parse::<f64>().is_ok()
}

/// Name in a header, and its unit if it has one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Heading {
    pub name: String,
    pub unit: Option<String>,
}

impl Heading {
    /// Reads `pitch [deg]`, `pitch (deg)`, `pitch/deg` or `pitch deg`.
    fn of(cell: &str) -> Heading {
        let cell = cell.trim().trim_start_matches('\u{feff}');
        let end = cell.find([' ', '[', '(', '/']).unwrap_or(cell.len());
        let rest = &cell[end..];
        let bracket = rest.find(['[', '(']).map_or(rest, |at| &rest[at..]);
        let unit = units::bare(bracket.trim().trim_start_matches('/'));
        Heading {
            name: cell[..end].to_string(),
            unit: (!unit.is_empty()).then(|| unit.to_string()),
        }
    }
}

/// Lines of a file with their numbers, except blank lines and comments.
pub(super) struct Lines<R> {
    input: R,
    /// Number of the last line [-], from 1.
    line: usize,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(input: R) -> Lines<R> {
        Lines { input, line: 0 }
    }

    /// The next line and its number; `None` at the end.
    ///
    /// # Errors
    /// A line that cannot be read, with its number.
    pub(super) fn next(&mut self) -> Result<Option<(usize, String)>, String> {
        loop {
            let mut bytes = Vec::new();
            let mut limited = self.input.by_ref().take(LINE_MAX);
            let count = limited
                .read_until(b'\n', &mut bytes)
                .map_err(|error| format!(": {error}"))?;
            if count == 0 {
                return Ok(None);
            }
            self.line += 1;
            let line = self.line;
            if count as u64 == LINE_MAX {
                return Err(format!(", line {line} is longer than {} KiB", LINE_MAX >> 10));
            }
            let text = String::from_utf8(bytes).map_err(|_| format!(": line {line} is not UTF-8 text"))?;
            let text = text.trim_start_matches('\u{feff}').trim();
            if !text.is_empty() && !text.starts_with('#') {
                return Ok(Some((line, text.to_string())));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_have_units_in_every_form() {
        let heading = |name: &str, unit: Option<&str>| Heading {
            name: name.to_string(),
            unit: unit.map(str::to_string),
        };
        for (row, separator) in [
            ("t [s],pitch (deg),x/mm,y", Separator::Comma),
            ("t [s]; \"pitch deg\" ;x [mm];y", Separator::Semicolon),
            ("t [s] pitch(deg) x [mm] y", Separator::Blank),
            ("t [s]\tpitch (deg)\tx mm\ty", Separator::Tab),
        ] {
            assert_eq!(Separator::of(row), separator);
            assert_eq!(
                separator.headings(row),
                [
                    heading("t", Some("s")),
                    heading("pitch", Some("deg")),
                    heading("x", Some("mm")),
                    heading("y", None)
                ],
                "{row}"
            );
        }
    }

    #[test]
    fn a_file_without_line_ends_is_refused() {
        let text = vec![b'x'; LINE_MAX as usize + 2];
        let problem = Lines::new(text.as_slice()).next().unwrap_err();
        assert_eq!(problem, ", line 1 is longer than 1024 KiB");
    }

    #[test]
    fn a_decimal_comma_is_read_between_semicolons_only() {
        assert_eq!(Separator::Semicolon.number("1,5e-1"), Ok(0.15));
        assert_eq!(Separator::Semicolon.number("1.5"), Ok(1.5));
        assert!(Separator::Semicolon.number("1.234,5").is_err());
        assert!(Separator::Semicolon.number("1,234,5").is_err());
        let problem = Separator::Blank.number("1,5").unwrap_err();
        assert!(problem.contains("decimal commas"), "{problem}");
    }
}
