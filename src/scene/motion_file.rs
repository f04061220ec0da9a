//! Motion tables in text files: a header row, then rows of time, x, y, z, and for vessels roll, pitch, yaw; or of time and columns that
//! name a body, such as `platform.x` and `buoy.z`; or the results of a run. Columns are separated by commas, semicolons, tabs or blanks.
//! Units are given in the header, in the row below it, or in a file `….units.csv` next to the table; columns without units are in SI units.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::columns::{DECIMAL_COMMAS, Heading, Lines, Separator, is_number};
use super::rows::shown;
use super::units::{self, Quantity};
use super::{MotionRow, input_file};

/// Axes of a motion, in order.
pub(super) const AXES: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];

/// Other names of the axes in headers, in lower case.
const SYNONYMS: [[&str; 2]; 6] = [
    ["surge", "ptfmsurge"],
    ["sway", "ptfmsway"],
    ["heave", "ptfmheave"],
    ["rx", "ptfmroll"],
    ["ry", "ptfmpitch"],
    ["rz", "ptfmyaw"],
];

/// Maximum number of rows: a day at 100 Hz.
const ROWS_MAX: usize = 8_640_000;

/// Motions in a file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Moves {
    /// Rows of time [s], displacement x, y, z [m] and rotation [rad] by body, in the order of the file; a single body without a name if the file
    /// names none.
    pub bodies: Vec<(Option<String>, Vec<MotionRow>)>,
    /// Description of the columns that were read.
    pub columns: String,
    /// True if the file has columns of rotation.
    pub turns: bool,
    /// True if the file holds the results of a run: its angles are Z-Y-X, and it may contain bodies that no host moves.
    pub is_recorded: bool,
}

/// Motion of one body in a file.
#[derive(Debug)]
pub(super) struct OneBody {
    pub rows: Vec<MotionRow>,
    /// Description of the columns that were read.
    pub columns: String,
    /// True if the file holds the results of a run, whose angles are Z-Y-X.
    pub is_recorded: bool,
}

/// Rows of time [s], displacement x, y, z [m] and rotation [rad] of one body, and a description of the columns.
///
/// # Errors
/// The file and line of the mistake, and its correction.
pub(super) fn read(path: &Path, body: &str) -> Result<OneBody, String> {
    let moves = read_moves(path, input_file::RELATIVE)?;
    let (columns, is_recorded) = (moves.columns, moves.is_recorded);
    let names: Vec<String> = moves.bodies.iter().filter_map(|(name, _)| name.clone()).collect();
    let is_meant = |name: &Option<String>| name.as_ref().is_none_or(|name| name == body);
    let (name, rows) = moves
        .bodies
        .into_iter()
        .find(|(name, _)| is_meant(name))
        .ok_or_else(|| {
            let (file, names) = (path.display(), names.join(", "));
            format!("{file}, line 1: no column moves `{body}`: there are columns of {names}")
        })?;
    let columns = match name {
        Some(_) => format!("those of {body} in {columns}"),
        None => columns,
    };
    Ok(OneBody {
        rows,
        columns,
        is_recorded,
    })
}

/// Returns the motions of all bodies in a file; the message on a missing file ends with `hint`.
///
/// # Errors
/// The file and line of the mistake, and its correction.
pub(super) fn read_moves(path: &Path, hint: &str) -> Result<Moves, String> {
    let file = input_file::open(path, "a CSV file", input_file::MOTION_SIZE_MAX)
        .map_err(|unopened| unopened.at(path, hint))?;
    let of_units_file = read_units(path)?;
    parse(BufReader::new(file), &of_units_file).map_err(|problem| format!("{}{problem}", path.display()))
}

/// Returns the motions in a text. Messages begin with a comma and the line number, or with a colon.
fn parse(input: impl BufRead, of_units_file: &BTreeMap<String, String>) -> Result<Moves, String> {
    let mut lines = Lines::new(input);
    let (line, first) = lines.next()?.unwrap_or((1, String::new()));
    let separator = Separator::of(&first);
    let bare = separator.cells(&first).iter().all(|cell| is_number(cell));
    let table = match bare {
        true => Table::without_header(separator, &first),
        false => Table::of_header(separator, &first, of_units_file),
    };
    let mut table = table.map_err(on_line(line))?;
    let mut row = if bare { Some((line, first)) } else { lines.next()? };
    if let Some((line, text)) = row.as_ref().filter(|_| !bare)
        && table.take_units(text).map_err(on_line(*line))?
    {
        row = lines.next()?;
    }
    let rows = table.rows(row, &mut lines)?;
    Ok(table.moves(&rows))
}

/// Prefixes a problem with its line.
fn on_line(line: usize) -> impl Fn(String) -> String {
    move |problem| format!(", line {line}: {problem}")
}

/// Units of columns by name, from the file that a run writes next to its results; empty if there is no such file.
fn read_units(path: &Path) -> Result<BTreeMap<String, String>, String> {
    let path = path.with_extension("units.csv");
    if !path.is_file() {
        return Ok(BTreeMap::new());
    }
    let unreadable = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = input_file::read_table(&path, "a table of units")?;
    let text = String::from_utf8_lossy(&bytes);
    let mut table = csv::ReaderBuilder::new()
        .flexible(true)
        .from_reader(text.as_bytes());
    let mut units = BTreeMap::new();
    for record in table.records() {
        let record = record.map_err(|error| unreadable(&error))?;
        if let (Some(name), Some(unit)) = (record.get(0), record.get(1)) {
            units.insert(name.to_string(), unit.to_string());
        }
    }
    Ok(units)
}

/// A column that is read.
#[derive(Debug)]
struct Column {
    /// Index in a row, from 0.
    place: usize,
    /// Name in messages.
    name: String,
    /// Body that it moves, if the file names one.
    body: Option<String>,
    /// Index in a [`MotionRow`]: 0 for the time, 1 to 6 for the axes.
    entry: usize,
    /// Unit as written, or the SI unit.
    unit: String,
    /// Conversion factor from its unit to SI units.
    factor: f64,
}

impl Column {
    fn quantity(&self) -> Quantity {
        match self.entry {
            0 => Quantity::Time,
            1..=3 => Quantity::Length,
            _ => Quantity::Angle,
        }
    }

    fn set_unit(&mut self, unit: &str) -> Result<(), String> {
        let factor = units::factor(unit, self.quantity());
        self.factor = factor.map_err(|problem| format!("column {}: {problem}", self.name))?;
        self.unit = units::bare(unit).to_string();
        Ok(())
    }
}

/// Layout of a file.
#[derive(Debug)]
struct Table {
    separator: Separator,
    /// Columns that are read.
    columns: Vec<Column>,
    /// Number of columns in a row, including those that are not read.
    width: usize,
    has_header: bool,
    /// True if it holds the results of a run.
    is_recorded: bool,
    /// True if the header contains a unit.
    has_units: bool,
    /// True if the units are in a row below the header.
    has_unit_row: bool,
    /// Decimal mark of a file with semicolons, once one has been found.
    decimal: Option<char>,
}

impl Table {
    fn new(separator: Separator, width: usize, has_header: bool) -> Table {
        Table {
            separator,
            columns: Vec::new(),
            width,
            has_header,
            is_recorded: false,
            has_units: false,
            has_unit_row: false,
            decimal: None,
        }
    }

    fn add(&mut self, place: usize, name: &str, body: Option<&str>, entry: usize) {
        let mut column = Column {
            place,
            name: name.to_string(),
            body: body.map(str::to_string),
            entry,
            unit: String::new(),
            factor: 1.0,
        };
        column.unit = column.quantity().si().to_string();
        self.columns.push(column);
    }

    /// Layout of a file without a header: columns time, x, y, z and optionally roll, pitch, yaw, separated by blanks or tabs.
    fn without_header(separator: Separator, row: &str) -> Result<Table, String> {
        let width = separator.cells(row).len();
        let between_blanks = matches!(separator, Separator::Tab | Separator::Blank);
        if !between_blanks || ![4, 7].contains(&width) {
            return Err(wrong_header(row, ""));
        }
        let mut table = Table::new(separator, width, false);
        table.add(0, "time", None, 0);
        for (axis, name) in AXES.iter().enumerate().take(width - 1) {
            table.add(1 + axis, name, None, 1 + axis);
        }
        Ok(table)
    }

    fn of_header(
        separator: Separator,
        row: &str,
        of_units_file: &BTreeMap<String, String>,
    ) -> Result<Table, String> {
        let headings = separator.headings(row);
        if !headings.first().is_some_and(|first| is_time(&first.name)) {
            return Err(wrong_header(row, ""));
        }
        let mut table = Table::new(separator, headings.len(), true);
        table.is_recorded = headings.iter().any(|heading| heading.name == "solver.substeps");
        table.add(0, &headings[0].name, None, 0);
        for (place, Heading { name, .. }) in headings.iter().enumerate().skip(1) {
            let (body, axis) = match name.rsplit_once('.') {
                Some((body, axis)) if !body.is_empty() => (Some(body), axis_number(axis)),
                Some(_) => (None, None),
                None => (None, axis_of(name)),
            };
            match axis {
                Some(axis) => table.add(place, name, body, 1 + axis),
                None if table.is_recorded => {}
                None => return Err(unknown_column(row, body.is_some())),
            }
        }
        table.check(row)?;
        for column in &mut table.columns {
            let heading = &headings[column.place];
            if let Some(unit) = heading.unit.as_ref().or(of_units_file.get(&heading.name)) {
                column.set_unit(unit)?;
                table.has_units |= heading.unit.is_some();
            }
        }
        Ok(table)
    }

    /// Refuses duplicate columns, a mix of columns with and without names, and incomplete motions.
    fn check(&self, row: &str) -> Result<(), String> {
        for (i, column) in self.columns.iter().enumerate() {
            let same = |other: &&Column| other.entry == column.entry && other.body == column.body;
            if let Some(other) = self.columns[..i].iter().find(same) {
                return Err(match other.name == column.name {
                    true => format!("there are two columns {}", column.name),
                    false => format!("{} and {} are the same", other.name, column.name),
                });
            }
        }
        let moved = &self.columns[1..];
        let named = moved.iter().filter(|column| column.body.is_some()).count();
        if named == moved.len() && named > 0 {
            return Ok(());
        }
        let complete = [3, 6].contains(&moved.len());
        let translation = || moved.iter().all(|column| column.entry <= 3);
        match named == 0 && complete && (moved.len() == 6 || translation()) {
            true => Ok(()),
            false => Err(unknown_column(row, true)),
        }
    }

    /// Takes the units from the row below the header; returns false if that is not a row of units.
    fn take_units(&mut self, row: &str) -> Result<bool, String> {
        let cells = self.separator.cells(row);
        let is_units = cells.len() == self.width
            && cells.iter().all(|cell| !is_number(cell))
            && cells.iter().any(|cell| !cell.is_empty());
        if !is_units {
            return Ok(false);
        }
        for column in &mut self.columns {
            let before = (self.has_units && self.has_header).then_some(column.factor);
            column.set_unit(cells[column.place])?;
            if let Some(before) = before.filter(|before| *before != column.factor) {
                return Err(format!(
                    "column {}: the unit {} is not that of the header, {before} in SI units",
                    column.name, column.unit
                ));
            }
        }
        self.has_unit_row = true;
        Ok(true)
    }

    /// Rows of the columns that are read, in SI units and ascending time.
    fn rows(
        &mut self,
        mut row: Option<(usize, String)>,
        lines: &mut Lines<impl BufRead>,
    ) -> Result<Vec<Vec<f64>>, String> {
        let mut rows: Vec<Vec<f64>> = Vec::new();
        while let Some((line, text)) = row {
            let values = self.row(&text).map_err(on_line(line))?;
            if let Some([last, ..]) = rows.last().map(Vec::as_slice)
                && values[0] <= *last
            {
                let problem = format!("time {} s does not come after {last} s", values[0]);
                return Err(on_line(line)(problem));
            }
            if rows.len() == ROWS_MAX {
                return Err(format!(": more than {ROWS_MAX} rows"));
            }
            rows.push(values);
            row = lines.next()?;
        }
        if rows.is_empty() {
            return Err(": no rows below the header".to_string());
        }
        Ok(rows)
    }

    fn row(&mut self, text: &str) -> Result<Vec<f64>, String> {
        let cells = self.separator.cells(text);
        if cells.len() != self.width {
            let names: Vec<&str> = self.columns.iter().map(|column| column.name.as_str()).collect();
            let (wanted, names, found) = (self.width, names.join(", "), cells.len());
            let hint = match self.separator == Separator::Comma && found > wanted {
                true => DECIMAL_COMMAS,
                false => "",
            };
            return Err(format!(
                "expected {wanted} numbers ({names}), found {found}{hint}"
            ));
        }
        let separator = self.separator;
        let mut values = Vec::with_capacity(self.columns.len());
        for column in &self.columns {
            let cell = cells[column.place];
            let number = separator.number(cell).and_then(|value| {
                self.decimal = one_decimal(separator, self.decimal, cell)?;
                Ok(value)
            });
            let number = number.map_err(|problem| format!("column {}: {problem}", column.name))?;
            values.push(number * column.factor);
        }
        Ok(values)
    }

    /// "columns between semicolons: time [s], x [m], pitch [deg]; decimal commas".
    fn in_words(&self) -> String {
        let columns = self.columns.iter();
        let columns: Vec<String> = columns
            .map(|column| format!("{} [{}]", column.name, column.unit))
            .collect();
        let (separator, columns) = (self.separator.in_words(), columns.join(", "));
        let mut said = format!("columns between {separator}: {columns}");
        for (is_so, words) in [
            (!self.has_header, "; no header, so columns count by their places"),
            (self.has_unit_row, "; units from the row below the header"),
            (self.decimal == Some(','), "; decimal commas"),
            (
                self.is_recorded,
                "; results of a run, whose other columns are left out",
            ),
        ] {
            said.push_str(if is_so { words } else { "" });
        }
        said
    }

    /// Groups the rows by body.
    fn moves(&self, rows: &[Vec<f64>]) -> Moves {
        let of = |body: Option<&str>| {
            let columns = self.columns.iter().enumerate();
            let own = columns.filter(|(_, column)| column.entry == 0 || column.body.as_deref() == body);
            let own: Vec<(usize, usize)> = own.map(|(i, column)| (i, column.entry)).collect();
            let motion = |row: &Vec<f64>| {
                let mut motion = [0.0; 7];
                own.iter().for_each(|(i, entry)| motion[*entry] = row[*i]);
                motion
            };
            rows.iter().map(motion).collect::<Vec<MotionRow>>()
        };
        let mut names: Vec<Option<&str>> = Vec::new();
        for column in self.columns.iter().filter(|column| column.entry > 0) {
            let body = column.body.as_deref();
            if !names.contains(&body) {
                names.push(body);
            }
        }
        let bodies = names.into_iter().map(|name| (name.map(str::to_string), of(name)));
        Moves {
            bodies: bodies.collect(),
            columns: self.in_words(),
            turns: self.columns.iter().any(|column| column.entry > 3),
            is_recorded: self.is_recorded,
        }
    }
}

/// Decimal mark of a file, once a cell has contained one.
///
/// # Errors
/// A cell with the other mark, which may be a thousands separator.
fn one_decimal(separator: Separator, known: Option<char>, cell: &str) -> Result<Option<char>, String> {
    if separator != Separator::Semicolon {
        return Ok(None);
    }
    let own = cell.chars().find(|c| [',', '.'].contains(c));
    match (known, own) {
        (Some(known), Some(own)) if known != own => Err(format!(
            "{} has a decimal {own:?}, and the numbers before it have {known:?}",
            shown(cell)
        )),
        _ => Ok(known.or(own)),
    }
}

fn is_time(name: &str) -> bool {
    ["time", "t"].contains(&name.to_lowercase().as_str())
}

fn wrong_header(row: &str, more: &str) -> String {
    let found: String = row.chars().take(80).collect();
    format!(
        "the header must be \"time,x,y,z\" [s, m] or \"time,x,y,z,roll,pitch,yaw\" [s, m, rad]{more}, found \"{found}\""
    )
}

/// Returns the refusal of columns that do not form a motion.
fn unknown_column(row: &str, named: bool) -> String {
    wrong_header(
        row,
        match named {
            true => ", or the time and columns such as \"platform.x\" [m] and \"platform.pitch\" [rad]",
            false => "",
        },
    )
}

/// Index of an axis from its name: x, y, z, roll, pitch, yaw.
pub(super) fn axis_number(name: &str) -> Option<usize> {
    AXES.iter().position(|axis| *axis == name)
}

/// Index of an axis from any of its names, ignoring case.
fn axis_of(name: &str) -> Option<usize> {
    let name = name.to_lowercase();
    let synonym = || SYNONYMS.iter().position(|names| names.contains(&name.as_str()));
    axis_number(&name).or_else(synonym)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::assert_answers;
    use approx::assert_relative_eq;
    use std::fs;

    fn of(text: &str) -> Result<Moves, String> {
        parse(text.as_bytes(), &BTreeMap::new())
    }

    fn one(text: &str) -> (Vec<MotionRow>, String) {
        let moves = of(text).unwrap();
        let [(None, rows)] = &moves.bodies[..] else {
            panic!("{text}: {moves:?}");
        };
        (rows.clone(), moves.columns)
    }

    #[test]
    fn the_same_motion_is_read_in_every_layout_and_each_is_named() {
        let wanted = [
            [0.0, 0.5, 0.0, -1.25, 0.0, 0.1, 0.0],
            [0.1, 0.75, 0.0, -1.5, 0.0, 0.2, 0.0],
        ];
        for (text, said) in [
            (
                "time,x,y,z,roll,pitch,yaw\n0,.5,0,-1.25,0,.1,0\n.1,.75,0,-1.5,0,.2,0\n",
                "between commas: time [s], x [m]",
            ),
            (
                "Time,Surge,Sway,Heave,Roll,Pitch,Yaw\n0,.5,0,-1.25,0,.1,0\n.1,.75,0,-1.5,0,.2,0\n",
                "Surge [m], Sway [m]",
            ),
            (
                "T;Z;X;Y;Yaw;Pitch;Roll\n0;-1,25;0,5;0;0;0,1;0\n0,1;-1,5;0,75;0;0;0,2;0\n",
                "between semicolons: T [s], Z [m], X [m], Y [m], Yaw [rad], Pitch [rad], Roll [rad]; decimal commas",
            ),
            (
                "0 .5 0 -1.25 0 .1 0\n.1 .75 0 -1.5 0 .2 0\n",
                "between blanks: time [s], x [m], y [m], z [m], roll [rad], pitch [rad], yaw [rad]; no header",
            ),
            (
                "# t x\n0\t.5\t0\t-1.25\t0\t.1\t0\n\n.1\t.75\t0\t-1.5\t0\t.2\t0\n",
                "between tabs",
            ),
            ("time\tPtfm Surge\n", ""),
            (
                "time x y z roll pitch yaw\n(s) (mm) (m) (cm) (rad) (mrad) (deg)\n0 500 0 -125 0 100 0\n.1 750 0 -150 0 200 0\n",
                "z [cm], roll [rad], pitch [mrad], yaw [deg]; units from the row below the header",
            ),
            (
                "time [ms];x [m];y;z;roll;pitch;yaw\n0;0.5;0;-1.25;0;0.1;0\n100;0.75;0;-1.5;0;0.2;0\n",
                "time [ms]",
            ),
        ] {
            if said.is_empty() {
                assert!(of(text).unwrap_err().contains("line 1: "));
                continue;
            }
            let (rows, words) = one(text);
            for (row, wanted) in rows.iter().flatten().zip(wanted.iter().flatten()) {
                assert_relative_eq!(*row, *wanted, max_relative = 1e-14);
            }
            assert!(words.contains(said), "{text}: {words}");
        }
    }

    #[test]
    fn degrees_in_a_header_are_degrees() {
        for text in [
            "time,x,y,z,roll,pitch [deg],yaw\n0,0,0,0,0,5,0\n",
            "t,surge,sway,heave,roll/deg,pitch/deg,yaw/deg\n0,0,0,0,0,5,0\n",
            "t;x;y;z;roll;pitch;yaw\ns;m;m;m;deg;deg;deg\n0;0;0;0;0;5;0\n",
            "t;x;y;z;roll (deg);pitch (deg);yaw (deg)\ns;m;m;m;deg;deg;deg\n0;0;0;0;0;5;0\n",
        ] {
            let pitch = one(text).0[0][5];
            assert_relative_eq!(pitch, 5.0_f64.to_radians(), max_relative = 1e-15);
        }
        let moves = of("t [s],barge.pitch [deg]\n0,5\n").unwrap();
        let (name, rows) = &moves.bodies[0];
        assert_eq!(name.as_deref(), Some("barge"));
        assert_relative_eq!(rows[0][5], 5.0_f64.to_radians(), max_relative = 1e-15);
        assert!(moves.columns.contains("barge.pitch [deg]"));
    }

    #[test]
    fn broken_files_are_refused_with_their_line_and_what_would_be_right() {
        assert_answers("", include_str!("../../tests/scene/motion_files.txt"), |text| {
            of(text).err().unwrap_or_default()
        });
    }

    #[test]
    fn the_results_of_a_run_move_the_body_in_question() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.csv");
        let text = "time,barge.x,barge.vx,barge.pitch,buoy.z,line1.tension_b,solver.substeps\n0,1,9,2,3,1e5,4\n1,2,9,3,4,1e5,4\n";
        fs::write(&path, text).unwrap();
        let OneBody {
            rows, columns: said, ..
        } = read(&path, "barge").unwrap();
        assert_eq!(rows[1], [1.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0]);
        assert!(
            said.starts_with("those of barge in columns between commas: time [s], barge.x [m]"),
            "{said}"
        );
        assert!(said.contains("results of a run"), "{said}");
        fs::write(
            folder.path().join("results.units.csv"),
            "name,unit,description\ntime,s,time\nbarge.pitch,deg,\"pitch, in degrees\"\n",
        )
        .unwrap();
        let OneBody {
            rows, columns: said, ..
        } = read(&path, "barge").unwrap();
        assert_relative_eq!(rows[0][5], 2.0_f64.to_radians(), max_relative = 1e-15);
        assert!(said.contains("barge.pitch [deg]"), "{said}");
        let problem = read(&path, "fairlead").unwrap_err();
        assert!(
            problem.ends_with("line 1: no column moves `fairlead`: there are columns of barge, buoy"),
            "{problem}"
        );
    }
}
