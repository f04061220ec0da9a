//! Tables as comma-separated values.
//!
//! `results.csv` has one plain header row (`time,fairlead.x,…`) and one row for every output time, as `pandas.read_csv` and
//! spreadsheets expect; `results.units.csv` has a row `name,unit,description` for every column. `profile.csv` holds
//! the shape of the lines in long form, a row for every time, line and node; where any line has bending stiffness there are columns
//! for curvature and moment, empty for the others. Numbers have the fewest digits that read back to
//! the same bits.

use std::io::{self, Write};

use super::record::{Column, Record};

/// Header of `profile.csv`.
const PROFILE_HEADER: [&str; 8] = ["time", "line", "node", "s", "x", "y", "z", "tension"];

/// Writes the results: a header row of names, then a row for every output time, each value in its column's unit.
///
/// # Errors
/// Writing to `out` fails.
pub fn write_results(record: &Record, out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(record.columns().iter().map(|column| &column.name))?;
    let written = |(column, &value): (&Column, &f64)| match column.whole && value.is_finite() {
        true => format!("{value:.0}"),
        false => shortest(value),
    };
    for row in record.rows() {
        table.write_record(record.columns().iter().zip(row).map(written))?;
    }
    table.flush()
}

/// Writes name, unit and description of every column of the results.
///
/// # Errors
/// Writing to `out` fails.
pub fn write_units(record: &Record, out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["name", "unit", "description"])?;
    for column in record.columns() {
        table.write_record([&column.name, &column.unit, &column.description])?;
    }
    table.flush()
}

/// Additional columns of lines with bending stiffness.
const BENDING_HEADER: [&str; 2] = ["curvature", "moment"];

/// Writes the shapes of the lines: time [s], line, node, unstretched arc length s [m], x, y, z [m], effective tension [N], and
/// curvature [1/m] and moment [N m] where a line bends.
///
/// # Errors
/// Writing to `out` fails.
pub fn write_profile(record: &Record, out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let mut nodes = record
        .frames
        .iter()
        .flat_map(|frame| frame.lines.iter().flatten());
    let bends = nodes.any(|node| node.bending.is_some());
    let more = if bends { &BENDING_HEADER[..] } else { &[] };
    table.write_record(PROFILE_HEADER.iter().chain(more))?;
    for frame in &record.frames {
        for (line, nodes) in record.lines.iter().zip(&frame.lines) {
            for (index, node) in nodes.iter().enumerate() {
                let [x, y, z] = node.position;
                table.write_field(shortest(frame.time))?;
                table.write_field(&line.name)?;
                table.write_field(index.to_string())?;
                let numbers = [node.s, x, y, z, node.tension].map(shortest);
                let bending = match node.bending {
                    Some(bending) => [bending.curvature, bending.moment].map(shortest),
                    None => [String::new(), String::new()],
                };
                let more = if bends { &bending[..] } else { &[] };
                table.write_record(numbers.iter().chain(more))?;
            }
        }
    }
    table.flush()
}

/// The fewest digits that read back to the same bits, in scientific notation where it is far from one.
pub(super) fn shortest(value: f64) -> String {
    format!("{value:?}")
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn every_number_reads_back_to_the_same_bits() {
        for value in [0.1, 1.0 / 3.0, 5e-324, -0.0, f64::MAX, 17.008898550123456] {
            let back: f64 = shortest(value).parse().unwrap();
            assert_eq!(back.to_bits(), value.to_bits());
            assert!(shortest(value).len() <= 25);
        }
    }

    #[test]
    fn the_results_read_back_row_by_row() {
        let record = sample::record();
        let mut bytes = Vec::new();
        write_results(&record, &mut bytes).unwrap();
        let mut table = csv::Reader::from_reader(bytes.as_slice());
        let names: Vec<_> = record.columns().iter().map(|c| c.name.clone()).collect();
        assert_eq!(table.headers().unwrap(), &csv::StringRecord::from(names));
        let rows: Vec<Vec<f64>> = table.deserialize().collect::<Result<_, _>>().unwrap();
        assert!(rows.iter().map(Vec::as_slice).eq(record.rows()));
    }

    #[test]
    fn a_count_is_written_as_a_whole_number() {
        let column = |name: &str, whole: bool| Column {
            name: name.to_string(),
            unit: "1".to_string(),
            description: String::new(),
            whole,
        };
        let mut record = Record::new("", vec![column("steps", true), column("x", false)]);
        record.add_row(0.5, [15.0, 15.0]);
        let mut bytes = Vec::new();
        write_results(&record, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text, "time,steps,x\n0.5,15,15.0\n");
    }

    #[test]
    fn a_comma_in_a_description_is_quoted() {
        let mut record = sample::record();
        record.title = String::new();
        let mut bytes = Vec::new();
        write_units(&record, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.starts_with("name,unit,description\ntime,s,simulated time\n"));
        assert!(text.contains("fairlead.fx,N,\"end force, on the vessel\"\n"));
    }

    #[test]
    fn a_line_that_bends_has_its_curvature_and_moment_in_the_profile() {
        let mut record = sample::record();
        record.frames[0].lines[1][2].bending = Some(crate::simulation::NodeBending {
            curvature: 0.25,
            moment: 8.0,
        });
        let mut bytes = Vec::new();
        write_profile(&record, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(
            text.lines()
                .next()
                .unwrap()
                .ends_with(",tension,curvature,moment")
        );
        assert_eq!(text.lines().filter(|row| row.ends_with(",0.25,8.0")).count(), 1);
        assert!(text.lines().nth(1).unwrap().ends_with(",,"));
    }

    #[test]
    fn the_profile_has_a_row_for_every_time_line_and_node() {
        let record = sample::record();
        let mut bytes = Vec::new();
        write_profile(&record, &mut bytes).unwrap();
        let mut table = csv::Reader::from_reader(bytes.as_slice());
        let nodes: usize = record.frames.iter().flat_map(|f| &f.lines).map(Vec::len).sum();
        let rows: Vec<_> = table.records().collect::<Result<_, _>>().unwrap();
        assert_eq!(rows.len(), nodes);
        assert_eq!(&rows[1][1], "line1");
        assert_eq!(&rows[1][2], "1");
    }
}
