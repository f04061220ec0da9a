//! Time to write a row of 30 columns to the tables of a run, by format, including ranges and histories of the record.

use moorline::output::files::RunFiles;
use moorline::output::record::{Column, Form, Frame, Record};
use moorline::output::times::Times;
use moorline::scene::{Format, Frames, Output};

const COLUMNS: usize = 30;
const ROWS: usize = 20_000;

fn main() {
    divan::main();
}

fn columns() -> Vec<Column> {
    let ends = ["x", "vx", "fx", "tension_b", "sag"];
    let name = |i: usize| format!("line{}.{}", i / ends.len(), ends[i % ends.len()]);
    let column = |i| Column::new(&name(i), "N", "", Form::Real);
    (1..COLUMNS).map(column).collect()
}

/// Rows of numbers with full precision, in the magnitudes of displacements and forces.
fn rows() -> Vec<[f64; COLUMNS]> {
    let size = [1.0, 0.1, 1e6, 1e6, 100.0];
    let row = |i: usize| {
        let time = 0.05 * i as f64;
        std::array::from_fn(|column| match column {
            0 => time,
            _ => size[column % 5] * (1.1 + (0.1 * time * column as f64).sin()),
        })
    };
    (0..ROWS).map(row).collect()
}

/// Options of the tables: format and digits.
#[divan::bench(args = ["csv", "csv, 6 digits", "parquet", "parquet, 6 digits"], sample_count = 20)]
fn rows_of_30_columns(bencher: divan::Bencher<'_, '_>, options: &str) {
    let mut output = Output {
        frames: Some(Frames::None),
        ..Output::default()
    };
    output.format = options.starts_with("parquet").then_some(Format::Parquet);
    output.digits = options.ends_with("6 digits").then_some(6);
    let (rows, times) = (rows(), Times::new(0.05 * (ROWS - 1) as f64, 0.05));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let shape = |time| Frame {
        time,
        lines: Vec::new(),
    };
    let bencher = bencher.counter(divan::counter::ItemsCount::new(ROWS));
    bencher.bench_local(|| {
        let mut record = Record::new("", columns(), ROWS);
        let files = RunFiles::create(folder.path(), &record, &output, &times, false);
        let mut files = files.expect("a folder that takes files");
        for (index, row) in rows.iter().enumerate() {
            files.add(&mut record, index, row, shape).expect("a file");
        }
        files.flush().expect("a file");
        record
    });
}
