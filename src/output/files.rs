//! Tables and shapes of a run, written during the run.
//!
//! The files of an interrupted run hold everything that was computed, up to the last complete row and shape. A run that continues from its [`Marks`]
//! writes the same rows as without the interruption.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::csv::write_units;
use super::folder::make_folder;
use super::growing::{Growing, Mark};
use super::record::{Column, Form, Frame, Record};
use super::table::Table;
use super::times::Times;
use super::{OutputError, figures, vtk, write_file};
use crate::scene::table::Choice;
use crate::scene::{Format, Frames, Output};

/// Approximate number of shapes of a run whose scene does not give their interval [-].
const FRAMES_MAX: usize = 240;

/// Opens the table with this file stem in the format of the scene: a new table, or one that continues after a mark.
fn open_table(
    stem: &Path,
    mark: Option<&Mark>,
    columns: &[Column],
    output: &Output,
) -> Result<Table, OutputError> {
    let format = output.format.unwrap_or(Format::Csv);
    let path = stem.with_extension(format.word());
    let file = match mark {
        None => Growing::create(&path)?,
        Some(mark) => Growing::reopen(&path, mark.clone())?,
    };
    Table::open(file, format, columns, output.digits)
}

/// Shapes for ParaView.
#[derive(Debug)]
struct Shapes {
    collection: Growing,
    written: usize,
}

/// Positions up to which the files of a run are written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Marks {
    results: Mark,
    profile: Option<Mark>,
    /// Position in the collection of shapes, and number of shapes.
    shapes: Option<(Mark, usize)>,
}

/// Rows from one shape to the next [-].
#[derive(Debug, Clone, Copy)]
struct Strides {
    /// Stride of the shapes in figures.
    figures: usize,
    /// Stride of the files for ParaView; `None` if there are none.
    files: Option<usize>,
}

/// Files of a run.
#[derive(Debug)]
pub struct RunFiles {
    folder: PathBuf,
    results: Table,
    profile: Option<Table>,
    shapes: Option<Shapes>,
    strides: Strides,
    last: usize,
    row: Vec<f64>,
}

impl RunFiles {
    /// Begins the files of a run in a folder, and removes those of an earlier one. `bends` is true if any line has bending stiffness.
    ///
    /// # Errors
    /// Names the first file or folder that the operating system refuses.
    pub fn create(
        folder: &Path,
        record: &Record,
        output: &Output,
        times: &Times,
        bends: bool,
    ) -> Result<RunFiles, OutputError> {
        make_folder(folder)?;
        remove_old(folder);
        let open = |stem: &str, columns: &[Column]| open_table(&folder.join(stem), None, columns, output);
        let results = open("results", record.columns())?;
        write_file(&folder.join("results.units.csv"), |w| {
            write_units(record.columns(), w)
        })?;
        let columns = profile_columns(record, bends);
        let profile = output.profile.is_given().then(|| open("profile", &columns));
        let shapes = strides(output, times).files.map(|_| Shapes::create(folder));
        let files = (results, profile.transpose()?, shapes.transpose()?);
        Ok(RunFiles::new(folder, files, output, times))
    }

    /// Continues the files of an interrupted run.
    ///
    /// # Errors
    /// A file differs from its mark, or the operating system refuses it.
    pub fn reopen(
        folder: &Path,
        record: &Record,
        output: &Output,
        times: &Times,
        (marks, bends): (&Marks, bool),
    ) -> Result<RunFiles, OutputError> {
        let open = |stem: &str, mark: &Mark, columns: &[Column]| {
            open_table(&folder.join(stem), Some(mark), columns, output)
        };
        let results = open("results", &marks.results, record.columns())?;
        let columns = profile_columns(record, bends);
        let profile = marks.profile.as_ref().map(|mark| open("profile", mark, &columns));
        let shapes = marks.shapes.as_ref().map(|(mark, written)| {
            let collection = Growing::reopen(&folder.join(COLLECTION_FILE), mark.clone())?;
            let written = *written;
            Ok(Shapes { collection, written })
        });
        let files = (results, profile.transpose()?, shapes.transpose()?);
        Ok(RunFiles::new(folder, files, output, times))
    }

    fn new(
        folder: &Path,
        (results, profile, shapes): (Table, Option<Table>, Option<Shapes>),
        output: &Output,
        times: &Times,
    ) -> RunFiles {
        RunFiles {
            folder: folder.to_path_buf(),
            results,
            profile,
            shapes,
            strides: strides(output, times),
            last: times.count,
            row: Vec::new(),
        }
    }

    /// Adds row `index` of the run, counted from 0, to the record and the table, and the shape of the lines if one is due.
    ///
    /// # Errors
    /// The operating system refuses a file.
    pub fn add(
        &mut self,
        record: &mut Record,
        index: usize,
        row: &[f64],
        shape: impl FnOnce(f64) -> Frame,
    ) -> Result<(), OutputError> {
        record.add_row(row);
        self.results.row(row)?;
        let due = |stride: usize| index.is_multiple_of(stride) || index == self.last;
        let drawn = due(self.strides.figures);
        let filed = self.strides.files.is_some_and(due);
        if !(drawn || filed || self.profile.is_some()) {
            return Ok(());
        }
        let frame = shape(row[0]);
        if let Some(profile) = &mut self.profile {
            add_nodes(profile, &frame, &mut self.row)?;
        }
        if let Some(shapes) = self.shapes.as_mut().filter(|_| filed) {
            shapes.add(&self.folder, &frame)?;
        }
        if drawn {
            record.course.frames.push(frame);
        }
        Ok(())
    }

    /// Writes all buffered rows and returns the marks of the files.
    ///
    /// # Errors
    /// The operating system refuses a file.
    pub fn mark(&mut self) -> Result<Marks, OutputError> {
        let profile = self.profile.as_mut().map(Table::mark);
        let shapes = self.shapes.as_mut().map(|shapes| {
            let mark = shapes.collection.mark()?;
            Ok((mark, shapes.written))
        });
        Ok(Marks {
            results: self.results.mark()?,
            profile: profile.transpose()?,
            shapes: shapes.transpose()?,
        })
    }

    /// Writes all buffered rows.
    ///
    /// # Errors
    /// The operating system refuses a file.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        self.results.flush()?;
        self.profile.as_mut().map_or(Ok(()), Table::flush)
    }
}

/// File that lists the shapes for ParaView.
const COLLECTION_FILE: &str = "lines.pvd";

impl Shapes {
    fn create(folder: &Path) -> Result<Shapes, OutputError> {
        make_folder(&folder.join(vtk::FRAME_FOLDER))?;
        let mut collection = Growing::create(&folder.join(COLLECTION_FILE))?;
        collection.append(vtk::COLLECTION.as_bytes(), vtk::COLLECTION_END.into())?;
        Ok(Shapes {
            collection,
            written: 0,
        })
    }

    /// Writes a shape, and then its entry in the collection.
    fn add(&mut self, folder: &Path, frame: &Frame) -> Result<(), OutputError> {
        let path = folder.join(vtk::frame_name(self.written));
        write_file(&path, |w| vtk::write_frame(frame, w))?;
        let entry = vtk::collected(self.written, frame.time);
        self.collection
            .append(entry.as_bytes(), vtk::COLLECTION_END.into())?;
        self.written += 1;
        Ok(())
    }
}

fn strides(output: &Output, times: &Times) -> Strides {
    let overview = times.count.div_ceil(FRAMES_MAX).max(1);
    let files = match output.frames {
        None | Some(Frames::Overview) => Some(overview),
        Some(Frames::None) => None,
        Some(Frames::Every(interval)) => Some(((interval / times.interval).round() as usize).max(1)),
    };
    Strides {
        figures: overview,
        files,
    }
}

/// Columns of the profile: unstretched arc length, position and effective tension of every node, and curvature and moment if any line bends.
fn profile_columns(record: &Record, bends: bool) -> Vec<Column> {
    let names = record.lines.iter().map(|line| line.name.clone()).collect();
    let real = |name: &str, unit: &str, text: &str| Column::new(name, unit, text, Form::Real);
    let mut columns = vec![
        Column::time(),
        Column::new("line", "1", "name of the line", Form::Name(names)),
        Column::new("node", "1", "number of the node from end A", Form::Whole),
        real("s", "m", "unstretched arc length from end A"),
        real("x", "m", "position"),
        real("y", "m", "position"),
        real("z", "m", "position"),
        real("tension", "N", "effective tension"),
    ];
    if bends {
        columns.push(Column::new("curvature", "1/m", "curvature", Form::Sparse));
        columns.push(Column::new("moment", "N.m", "bending moment", Form::Sparse));
    }
    columns
}

/// Adds a row for every node of every line.
fn add_nodes(profile: &mut Table, frame: &Frame, row: &mut Vec<f64>) -> Result<(), OutputError> {
    for (line, nodes) in frame.lines.iter().enumerate() {
        for (index, node) in nodes.iter().enumerate() {
            let [x, y, z] = node.position;
            let bending = node.bending.map(|bending| [bending.curvature, bending.moment]);
            row.clear();
            row.extend([
                frame.time,
                line as f64,
                index as f64,
                node.s,
                x,
                y,
                z,
                node.tension,
            ]);
            row.extend(bending.unwrap_or([f64::NAN; 2]));
            profile.row(row)?;
        }
    }
    Ok(())
}

/// Removes the results of an earlier run, so that they are not mixed with those of this one. Anything other than a file is left, and writing a file
/// of its name then fails.
fn remove_old(folder: &Path) {
    let tables =
        ["results", "profile"].map(|stem| ["csv", "parquet"].map(|ending| format!("{stem}.{ending}")));
    let figures = figures::STEMS.iter().map(|stem| format!("{stem}.svg"));
    let others = ["report.html", COLLECTION_FILE, super::state::FILE].map(String::from);
    let shapes = fs::read_dir(folder.join(vtk::FRAME_FOLDER)).into_iter();
    let shapes = shapes.flatten().flatten().filter_map(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        vtk::is_frame(&name).then(|| format!("{}/{name}", vtk::FRAME_FOLDER))
    });
    let names = tables.into_iter().flatten().chain(figures);
    let names = names.chain(others).chain(shapes);
    for path in names.map(|name| folder.join(name)) {
        // a link stays, and its target is replaced
        if fs::symlink_metadata(&path).is_ok_and(|found| found.is_file()) {
            let _ = fs::remove_file(path);
        }
    }
}
