//! Tables of tension over strain: rows in a scene, or a file of two columns.

use std::path::Path;

use toml::Value as Toml;

use super::check::{Findings, quantity};
use super::document::Node;
use super::rows::{Field, Row, number, shown};
use super::table::{Key, Kind, Table, Value, magnitude, table};
use super::units::{self, Quantity};
use super::value::entry;
use super::words::significant;
use super::{SceneError, input_file};

/// Tension over strain: `[[strain, tension], …]` or `{ file = "rope.csv" }`, a path relative to the scene's folder.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TensionStrain {
    /// Path of the file, if there is one.
    pub file: Option<String>,
    /// Rows of strain [-] and tension [N]; those of a file are filled in by the reader.
    pub rows: Vec<[f64; 2]>,
}

impl TensionStrain {
    /// Table in a file that has not been read.
    pub fn from_file(file: &str) -> TensionStrain {
        TensionStrain {
            file: Some(file.to_string()),
            rows: Vec::new(),
        }
    }
}

table! {
    /// A table of tension over strain in a file.
    struct TensionFile, "`tension_strain`" {
        /// File with two columns, strain [-] and tension [N], relative to the scene.
        file: String,
    }
}

impl Value for TensionStrain {
    fn kind() -> Kind {
        Kind::NumberOrTable(TensionFile::SCHEMA)
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        if node.elements().is_some() {
            return self.rows.read(node);
        }
        if node.entries().is_none() {
            return Err(node.expected("[[strain, tension], …] or { file = \"…\" }"));
        }
        let TensionFile { file } = node.read()?;
        self.file = Some(file);
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        match &self.file {
            Some(file) if self.rows.is_empty() => Some(entry("file", file.clone())),
            _ => self.rows.write(),
        }
    }

    fn check(&self, _: &Key, findings: &mut Findings) {
        for (number, row) in self.rows.iter().enumerate() {
            let at = format!("[{number}]");
            let strain = findings.number(&at, row[0], magnitude(10.0).bounds, "-");
            if !strain || !findings.number(&at, row[1], magnitude(1e15).bounds, "N") {
                return;
            }
            let before = number.checked_sub(1).map(|before| self.rows[before]);
            let problem = match before {
                None if *row != [0.0, 0.0] => "a table begins with no tension at no strain: [0.0, 0.0]",
                Some([strain, _]) if row[0] <= strain => "strain must rise from row to row",
                Some([_, tension]) if row[1] <= tension => "tension must rise with strain",
                _ => continue,
            };
            return findings.say(at, problem);
        }
        match &self.file {
            Some(file) if self.rows.is_empty() => {
                findings.say("", format!("{file} was not read: write its rows here"));
            }
            _ if self.rows.len() < 2 => findings.say("", "a table has two rows [strain, tension] or more"),
            _ => {}
        }
    }

    fn in_words(&self, _: &Key) -> Option<String> {
        let [strain, tension] = self.rows.last().copied().unwrap_or_default();
        Some(format!(
            "from a table of {} rows up to {} at a strain of {}, smooth between them and straight beyond",
            self.rows.len(),
            quantity(tension, "N"),
            significant(strain)
        ))
    }
}

/// Reads rows of strain [-] and tension [N] from a file: two columns separated by blanks, commas or semicolons. Lines above them that do not begin
/// with a number are headings; two units in brackets in the last heading, such as `(-) (kN)`, apply to the columns.
///
/// # Errors
/// The file and line of the mistake, and its correction.
pub(super) fn read(path: &Path) -> Result<Vec<[f64; 2]>, String> {
    let name = path.display();
    let bytes = input_file::read_table(path, "a table of strain and tension")?;
    let text = String::from_utf8_lossy(&bytes);
    let mut rows: Vec<[f64; 2]> = Vec::new();
    let mut heading = (1, "");
    for row in Row::all(&text) {
        let line = text[..row.span().start].matches('\n').count() + 1;
        let row = row.before(&['#']);
        // with semicolons between the columns, a comma is the decimal mark
        let decimal = row.text.contains(';');
        let cells = row.split(|c| c.is_whitespace() || c == if decimal { ';' } else { ',' });
        let value = |cell: &Field<'_>| match decimal {
            true => number(&cell.text.replacen(',', ".", 1)),
            false => number(cell.text),
        };
        let numbers: Vec<Result<f64, String>> = cells.iter().map(value).collect();
        match numbers.as_slice() {
            [] => {}
            [Ok(strain), Ok(tension)] => rows.push([*strain, *tension]),
            [Err(_), ..] if rows.is_empty() => heading = (line, row.text),
            _ => {
                return Err(format!(
                    "{name}, line {line}: {} is no row of strain [-] and tension [N]",
                    shown(row.text)
                ));
            }
        }
    }
    if rows.is_empty() {
        return Err(format!("{name}: no rows of strain [-] and tension [N]"));
    }
    in_units_of(heading.1, &mut rows).map_err(|problem| format!("{name}, line {}: {problem}", heading.0))?;
    Ok(rows)
}

/// Converts rows from the units in a heading to SI units.
fn in_units_of(heading: &str, rows: &mut [[f64; 2]]) -> Result<(), String> {
    let found = units::bracketed(heading);
    let [strain, tension] = found[..] else {
        return match found.iter().any(|text| units::is_converted(text)) {
            true => {
                Err("a heading has a unit for each of its two columns, such as (-) (kN), or none".to_string())
            }
            false => Ok(()),
        };
    };
    let factors = [
        units::factor(strain, Quantity::Number)?,
        units::factor(tension, Quantity::Force)?,
    ];
    for row in rows {
        *row = [row[0] * factors[0], row[1] * factors[1]];
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_below_its_headings() {
        let path = std::env::temp_dir().join(format!("tension-strain-{}.txt", std::process::id()));
        let text = "----Polyester----\nStrain Tension\n(-) (N)\n0.0 0.0\n1.0D-2, 4e5 # first\n\n0.02\t9e5\n";
        std::fs::write(&path, text).unwrap();
        assert_eq!(read(&path).unwrap(), [[0.0, 0.0], [0.01, 4e5], [0.02, 9e5]]);
        std::fs::write(&path, "strain [%]; tension [kN]\n0;0\n1,0;400\n2;900,0\n").unwrap();
        assert_eq!(read(&path).unwrap(), [[0.0, 0.0], [0.01, 4e5], [0.02, 9e5]]);
        std::fs::write(&path, "strain tension\n(-) (lbf)\n0 0\n1 2\n").unwrap();
        let unknown = read(&path).unwrap_err();
        assert!(unknown.contains("line 2: unknown unit \"lbf\""), "{unknown}");
        for heading in ["strain tension[kN]", "strain [%] tension", "(%) (kN) (test)"] {
            std::fs::write(&path, format!("{heading}\n0 0\n1 2\n")).unwrap();
            let single = read(&path).unwrap_err();
            assert!(
                single.contains("line 1: a heading has a unit for each"),
                "{single}"
            );
        }
        std::fs::write(&path, "Polyester (wet)\nstrain (-) tension\n0 0\n1 2\n").unwrap();
        assert_eq!(read(&path).unwrap(), [[0.0, 0.0], [1.0, 2.0]]);
        std::fs::write(&path, "0 0\n0.1 five\n").unwrap();
        let problem = read(&path).unwrap_err();
        std::fs::remove_file(&path).unwrap();
        assert!(problem.contains("line 2"), "{problem}");
        assert!(read(&path).unwrap_err().contains("no such file"));
    }
}
