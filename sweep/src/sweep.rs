//! All cases of a sweep, on all cores, into a folder.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use moorline::output::OutputError;
use moorline::output::folder::{ResultsFolder, make_folder};
use moorline::scene::Note;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::SweepError;
use crate::case::Case;
use crate::journal::{Identity, Journal};
use crate::row::{Row, table};
use crate::run::{SERIES, run};

/// Time between tables during a run.
const TABLE_EVERY: Duration = Duration::from_secs(60);

/// Sweep into a folder, with the rows of earlier calls.
#[derive(Debug)]
pub struct Sweep {
    cases: Arc<[Case]>,
    folder: ResultsFolder,
    series: Option<PathBuf>,
    journal: Journal,
    rows: Vec<Row>,
    /// Time of the last table.
    written: Instant,
}

/// Progress of a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Number of cases that have ended [-].
    pub done: usize,
    /// Number of these that failed [-].
    pub failed: usize,
    /// Time spent in steps of simulations, in the cases of this call.
    pub stepping: Duration,
}

impl Sweep {
    /// Reads the rows of the cases that have ended in a folder. With `series`, all results in time of every case are also kept.
    ///
    /// # Errors
    /// The folder belongs to another sweep, or a file in it cannot be read or written.
    pub fn open(cases: &Arc<[Case]>, folder: ResultsFolder, series: bool) -> Result<Sweep, SweepError> {
        let (journal, rows) = Journal::open(folder.path(), &identity(cases, series)?, cases)?;
        let series = series.then(|| folder.path().join(SERIES));
        series.as_deref().map_or(Ok(()), make_folder)?;
        Ok(Sweep {
            cases: cases.clone(),
            folder,
            series,
            journal,
            rows,
            written: Instant::now(),
        })
    }

    /// Rows of the cases that have ended, in the order in which they ended.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Folder of the series, if they are kept.
    pub fn series(&self) -> Option<&Path> {
        self.series.as_deref()
    }

    /// Numbers of the cases that have not ended, in their order.
    pub fn left(&self) -> Vec<usize> {
        let done: BTreeSet<usize> = self.rows.iter().map(|row| row.case).collect();
        let numbers = self.cases.iter().map(|case| case.number);
        numbers.filter(|number| !done.contains(number)).collect()
    }

    /// Keeps the row of a case that has ended: in the journal and, once a minute, in the table.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn add(&mut self, mut row: Row) -> Result<(), SweepError> {
        self.journal.add(&mut row)?;
        self.rows.push(row);
        if self.written.elapsed() >= TABLE_EVERY {
            self.write_table()?;
        }
        Ok(())
    }

    /// Runs the remaining cases until `stops` returns true, and writes the table. `ended` is called at the end of each case. Returns the
    /// final state; the sweep is complete if all cases are done.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn run(
        &mut self,
        stops: &(dyn Fn() -> bool + Sync),
        ended: &(dyn Fn(&Row, Progress) + Sync),
    ) -> Result<Progress, SweepError> {
        let (cases, left) = (self.cases.clone(), self.left());
        let series = self.series.clone();
        let is_broken = AtomicBool::new(false);
        let ends = || stops() || is_broken.load(Ordering::Relaxed);
        let state = Mutex::new(State::new(self));
        // from a queue, so that a free core takes the next case
        left.into_iter().par_bridge().for_each(|number| {
            let case = &cases[number - 1];
            let outcome = match ends() {
                true => Ok(None),
                false => run(case, series.as_deref(), &ends),
            };
            let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
            let added = outcome.map_err(SweepError::from).and_then(|done| match done {
                Some(done) => state.add(done.row, done.stepping, ended),
                None => Ok(()),
            });
            if let Err(error) = added {
                is_broken.store(true, Ordering::Relaxed);
                state.error.get_or_insert(error);
            }
        });
        let state = state.into_inner().unwrap_or_else(PoisonError::into_inner);
        let progress = state.progress;
        if let Some(error) = state.error {
            return Err(error);
        }
        self.write_table()?;
        Ok(progress)
    }

    /// Writes the table of the cases that have ended.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_table(&mut self) -> Result<(), SweepError> {
        table(&self.rows).write(self.folder.path())?;
        self.written = Instant::now();
        Ok(())
    }
}

/// State of a sweep that is running.
struct State<'s> {
    sweep: &'s mut Sweep,
    progress: Progress,
    error: Option<SweepError>,
}

impl<'s> State<'s> {
    fn new(sweep: &'s mut Sweep) -> Self {
        let failed = sweep.rows.iter().filter(|row| row.results.is_err()).count();
        State {
            progress: Progress {
                done: sweep.rows.len(),
                failed,
                stepping: Duration::ZERO,
            },
            sweep,
            error: None,
        }
    }

    fn add(
        &mut self,
        row: Row,
        stepping: Duration,
        ended: &(dyn Fn(&Row, Progress) + Sync),
    ) -> Result<(), SweepError> {
        self.progress.done += 1;
        self.progress.failed += usize::from(row.results.is_err());
        self.progress.stepping += stepping;
        self.sweep.add(row)?;
        if let Some(row) = self.sweep.rows.last() {
            ended(row, self.progress);
        }
        Ok(())
    }
}

/// Fingerprint of cases with all files that they name; it is the same on two machines if both read the same content.
///
/// # Errors
/// A file that cannot be read.
pub fn fingerprint(cases: &[Case]) -> Result<[u8; 32], OutputError> {
    Ok(identity(cases, false)?.fingerprint())
}

fn identity(cases: &[Case], series: bool) -> Result<Identity, OutputError> {
    let (mut scenes, mut options) = (Sha256::new(), Sha256::new());
    let mut files: BTreeSet<PathBuf> = BTreeSet::new();
    options.update([u8::from(series)]);
    for case in cases {
        let motion = case
            .input
            .drive
            .file
            .as_ref()
            .map(|file| file.display().to_string());
        for text in [&case.input.document, &motion.unwrap_or_default()] {
            scenes.update((text.len() as u64).to_le_bytes());
            scenes.update(text);
        }
        options.update(case.from.to_le_bytes());
        files.extend(case.files());
    }
    Ok(Identity {
        cases: cases.len(),
        scenes: scenes.finalize().into(),
        files: content(&files)?,
        options: options.finalize().into(),
    })
}

/// Fingerprint of the content of files.
fn content(files: &BTreeSet<PathBuf>) -> Result<[u8; 32], OutputError> {
    let mut sum = Sha256::new();
    for path in files {
        let bytes = fs::read(path).map_err(|source| OutputError::File {
            path: path.clone(),
            source,
        })?;
        sum.update((bytes.len() as u64).to_le_bytes());
        sum.update(bytes);
    }
    Ok(sum.finalize().into())
}

/// Remarks on the scenes of the cases that do not apply to the base, each once with its first case.
pub fn remarks(cases: &[Case]) -> Vec<(&Case, &Note)> {
    let notes = cases
        .iter()
        .flat_map(|case| case.notes.iter().map(move |note| (case, note)));
    let mut known = BTreeSet::new();
    notes
        .filter(|(_, note)| known.insert((&note.at, &note.text)))
        .collect()
}

/// Remarks on the discretisations that this process has selected, each once with its first case.
pub fn shortfalls(cases: &[Case]) -> Vec<(&Case, &str)> {
    let notes = cases
        .iter()
        .flat_map(|case| case.kind.notes().iter().map(move |note| (case, note.as_str())));
    let mut known = BTreeSet::new();
    notes.filter(|(_, note)| known.insert(*note)).collect()
}
