//! Speed against error as a table: a row for every run.

use std::io::{self, Write};

use crate::accuracy::{Metric, Study};

/// Writes scene, code, setting, cost, errors and the converged solution's uncertainty of every run of these studies.
///
/// # Errors
/// Where `out` refuses.
pub fn write_runs(studies: &[Study], out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let keys = Metric::ALL.map(Metric::key);
    let errors = keys.iter().map(|key| (*key).to_string());
    let uncertainties = keys.iter().map(|key| format!("{key}_uncertainty"));
    let head = ["scene", "code", "setting", "cost"].map(str::to_string);
    table.write_record(head.into_iter().chain(errors).chain(uncertainties))?;
    for study in studies {
        for run in &study.runs {
            let words = [&study.name, run.code.name(), &run.label].map(str::to_string);
            let numbers = Metric::ALL.map(|metric| run.errors.of(metric));
            let limits = Metric::ALL.map(|metric| study.uncertainty.of(metric));
            let numbers = [run.cost].into_iter().chain(numbers).chain(limits);
            let numbers = numbers.map(|number| format!("{number:.4e}"));
            table.write_record(words.into_iter().chain(numbers))?;
        }
    }
    table.flush()
}
