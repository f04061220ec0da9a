//! Tables in the formats that a scene may choose, and tables that receive their name when they are complete.

use std::fs;
use std::path::{Path, PathBuf};

use super::csv::CsvTable;
use super::growing::{Growing, Mark};
use super::parquet::ParquetTable;
use super::record::Column;
use super::{OutputError, partial_name, target_of};
use crate::scene::Format;

/// A table that is written row by row, in one of the formats.
#[derive(Debug)]
pub(super) enum Table {
    Csv(CsvTable),
    Parquet(Box<ParquetTable>),
}

impl Table {
    /// Opens a table in a new file, without rows, or in a file that continues after its last row.
    pub(super) fn open(
        file: Growing,
        format: Format,
        columns: &[Column],
        digits: Option<usize>,
    ) -> Result<Table, OutputError> {
        Ok(match format {
            Format::Csv => Table::Csv(CsvTable::open(file, columns, digits)?),
            Format::Parquet => Table::Parquet(Box::new(ParquetTable::open(file, columns, digits)?)),
        })
    }

    /// Adds a row with a value for every column.
    pub(super) fn row(&mut self, values: &[f64]) -> Result<(), OutputError> {
        match self {
            Table::Csv(table) => table.row(values),
            Table::Parquet(table) => table.row(values),
        }
    }

    /// Writes the buffered rows.
    pub(super) fn flush(&mut self) -> Result<(), OutputError> {
        match self {
            Table::Csv(table) => table.flush(),
            Table::Parquet(table) => table.flush(),
        }
    }

    /// Writes the buffered rows and returns the mark of the file.
    pub(super) fn mark(&mut self) -> Result<Mark, OutputError> {
        self.flush()?;
        match self {
            Table::Csv(table) => table.file().mark(),
            Table::Parquet(table) => table.file().mark(),
        }
    }
}

/// A table that is written row by row under a temporary name.
#[derive(Debug)]
pub struct WholeTable {
    /// File to which the name leads.
    target: PathBuf,
    partial: PathBuf,
    table: Table,
}

impl WholeTable {
    /// Begins a table; an existing file of this name does not change until [`WholeTable::finish`].
    ///
    /// # Errors
    /// The name belongs to something other than a regular file, or the operating system refuses.
    pub fn create(
        path: &Path,
        format: Format,
        columns: &[Column],
        digits: Option<usize>,
    ) -> Result<WholeTable, OutputError> {
        let target = target_of(path).map_err(|source| OutputError::of_file(path, source))?;
        let partial = partial_name(&target);
        let table = Table::open(Growing::create(&partial)?, format, columns, digits)?;
        Ok(WholeTable {
            target,
            partial,
            table,
        })
    }

    /// Adds a row with a value for every column.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn row(&mut self, values: &[f64]) -> Result<(), OutputError> {
        self.table.row(values)
    }

    /// Gives the table its name, replacing an older file.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn finish(mut self) -> Result<(), OutputError> {
        self.table.flush()?;
        let renamed = fs::rename(&self.partial, &self.target);
        renamed.map_err(|source| OutputError::of_file(&self.target, source))
    }
}

impl Drop for WholeTable {
    fn drop(&mut self) {
        // after `finish` there is no such file; one that cannot be removed is recognisable by its name
        let _ = fs::remove_file(&self.partial);
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
