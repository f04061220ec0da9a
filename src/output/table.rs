//! Tables that appear under their name when they are whole.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::csv::CsvTable;
use super::growing::Growing;
use super::parquet::ParquetTable;
use super::record::Column;
use super::{OutputError, partial_name, target_of};
use crate::scene::Format;

/// A table that is written row by row under a temporary name.
#[derive(Debug)]
pub struct WholeTable {
    /// File that the name leads to.
    target: PathBuf,
    partial: PathBuf,
    rows: Rows,
}

#[derive(Debug)]
enum Rows {
    Csv(CsvTable),
    Parquet(Box<ParquetTable>),
}

impl WholeTable {
    /// Begins a table; the file of the name stays as it is until [`WholeTable::finish`].
    ///
    /// # Errors
    /// The name belongs to something other than a regular file, or the operating system refuses.
    pub fn create(
        path: &Path,
        format: Format,
        columns: &[Column],
        digits: Option<usize>,
    ) -> Result<WholeTable, OutputError> {
        let target = target_of(path).map_err(|source| failure(path, source))?;
        let partial = partial_name(&target);
        let file = Growing::create(&partial)?;
        Ok(WholeTable {
            target,
            partial,
            rows: match format {
                Format::Csv => Rows::Csv(CsvTable::create(file, columns, digits)?),
                Format::Parquet => Rows::Parquet(Box::new(ParquetTable::create(file, columns, digits)?)),
            },
        })
    }

    /// Adds a row: a value for every column.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn row(&mut self, values: &[f64]) -> Result<(), OutputError> {
        match &mut self.rows {
            Rows::Csv(table) => table.row(values),
            Rows::Parquet(table) => table.row(values),
        }
    }

    /// Gives the table its name, in place of an older file.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn finish(mut self) -> Result<(), OutputError> {
        match &mut self.rows {
            Rows::Csv(table) => table.flush()?,
            Rows::Parquet(table) => table.flush()?,
        }
        fs::rename(&self.partial, &self.target).map_err(|source| failure(&self.target, source))
    }
}

impl Drop for WholeTable {
    fn drop(&mut self) {
        // after `finish` there is none; one that cannot be removed does not look complete
        let _ = fs::remove_file(&self.partial);
    }
}

fn failure(path: &Path, source: io::Error) -> OutputError {
    OutputError::File {
        path: path.to_path_buf(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_that_is_not_finished_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cases.csv");
        fs::write(&path, "old").unwrap();
        let table = || WholeTable::create(&path, Format::Csv, &[Column::time()], None).unwrap();
        let mut dropped = table();
        dropped.row(&[1.0]).unwrap();
        drop(dropped);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        let mut whole = table();
        whole.row(&[1.0]).unwrap();
        whole.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"time\n1.0\n");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
