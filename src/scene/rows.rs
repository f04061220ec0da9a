//! Splits text into rows and fields with their positions, for all readers of tables in columns.

use std::ops::Range;

/// A word of a row.
#[derive(Debug, Clone, PartialEq)]
pub struct Field<'t> {
    /// The word itself.
    pub text: &'t str,
    /// Bytes of the file.
    pub span: Range<usize>,
}

/// A line of the file that is not blank.
#[derive(Debug, Clone, PartialEq)]
pub struct Row<'t> {
    /// The line without its end, and without a byte order mark.
    pub text: &'t str,
    /// Byte of the file where `text` starts.
    pub start: usize,
}

impl<'t> Row<'t> {
    /// Lines of a text that are not blank.
    pub fn all(text: &'t str) -> impl Iterator<Item = Row<'t>> {
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
    pub fn span(&self) -> Range<usize> {
        let blanks = self.text.len() - self.text.trim_start().len();
        self.start + blanks..self.start + self.text.len()
    }

    /// The row up to the first of the `marks`.
    pub fn before(&self, marks: &[char]) -> Row<'t> {
        let end = self.text.find(marks).unwrap_or(self.text.len());
        Row {
            text: self.text[..end].trim_end(),
            start: self.start,
        }
    }

    /// The words of the row.
    pub fn fields(&self) -> Vec<Field<'t>> {
        self.split(|c| c.is_whitespace())
    }

    /// Parts of the row between separators.
    pub fn split(&self, separates: impl Fn(char) -> bool) -> Vec<Field<'t>> {
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

/// Parses a number [-] in the notation of C or of Fortran (`1.0D5`).
///
/// # Errors
/// A description of the word that was found instead.
pub fn number(text: &str) -> Result<f64, String> {
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

/// A word of the file in quotes, shortened if it is long.
pub fn shown(text: &str) -> String {
    if text.chars().count() <= 40 {
        return format!("{text:?}");
    }
    let beginning: String = text.chars().take(37).collect();
    format!("{:?}", beginning + "…")
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
        let words = rows[1].before(&['#']).fields();
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
