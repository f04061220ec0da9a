//! `moorline sweep`: a scene case by case, on all cores.

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use moorline_sweep::{Base, Case, Progress, Row, Sweep, SweepError, cases, remarks, shortfalls};

use crate::arguments::Input;
use crate::failure::Failure;
use crate::folder::{Folder, Listener};
use crate::terminal::{self, LINES_EVERY, print, remark, rounded};

/// Greatest number of failed cases that are listed [-].
const LISTED: usize = 10;

/// Choice of the results of a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Choice {
    /// Time from which results are evaluated [s]; the end of the ramps if absent.
    pub from: Option<f64>,
    /// True if all results in time are kept.
    pub series: bool,
}

/// Runs the cases of a file with a scene, and writes their table into a folder.
pub(crate) fn sweep(input: &Input, file: &Path, folder: &Path, choice: &Choice) -> Result<(), Failure> {
    let base = Base::load(&input.scene, &input.host.supplement())?;
    base.notes().iter().for_each(|note| remark(&input.scene, note));
    let cases = cases(&base, file, choice.from)?;
    for (case, note) in remarks(&cases) {
        // a failure to write a remark does not end the command
        let _ = writeln!(io::stderr(), "note: {}:{}: {note}", file.display(), case.line);
    }
    let mut open = Folder::open(folder)?;
    let mut sweep = Sweep::open(&cases, open.take(), choice.series)?;
    let before = sweep.rows().len();
    if before > 0 {
        print(&format!("{before} of {} cases are done already\n", cases.len()))?;
    }
    let (listener, start) = (Listener::new(), Instant::now());
    let shown = Mutex::new(Shown::new(cases.len(), before));
    let state = sweep.run(&|| listener.is_interrupted(), &|row, progress| {
        let mut shown = shown.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        shown.ended(row, progress);
    });
    drop(listener);
    shown
        .into_inner()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
        .bar
        .finish_and_clear();
    let state = state?;
    for (case, note) in shortfalls(&cases) {
        let _ = writeln!(
            io::stderr(),
            "note: {}, case {}: {note}",
            file.display(),
            case.number
        );
    }
    if state.done < cases.len() {
        return Err(Failure::Interrupted(format!(
            "after {} of {} cases: {} holds their table, and the same command goes on",
            state.done,
            cases.len(),
            folder.display()
        )));
    }
    print(&summary(&state, cases.len() - before, start.elapsed()))?;
    print(&format!("written to {}\n", folder.display()))?;
    match state.failed {
        0 => Ok(()),
        _ => Err(Failure::Computation(failures(&sweep, &cases, file))),
    }
}

fn summary(state: &Progress, ran: usize, wall: Duration) -> String {
    if ran == 0 {
        return format!("{} cases were done before\n", state.done);
    }
    let seconds = wall.as_secs_f64();
    format!(
        "{ran} cases in {seconds:.1} s, {:.2} a second; {:.1} s in steps on all cores together\n",
        ran as f64 / seconds,
        state.stepping.as_secs_f64()
    )
}

/// Lists the failed cases with their reasons.
fn failures(sweep: &Sweep, cases: &[Case], file: &Path) -> String {
    let mut failed: Vec<(usize, &String)> = sweep
        .rows()
        .iter()
        .filter_map(|row| Some((row.case, row.results.as_ref().err()?)))
        .collect();
    failed.sort_unstable();
    let mut text = format!(
        "{} of {} cases failed, the others have results",
        failed.len(),
        cases.len()
    );
    for (case, reason) in failed.iter().take(LISTED) {
        let line = cases[case - 1].line;
        text += &format!("\n  case {case} ({}:{line}): {reason}", file.display());
    }
    if failed.len() > LISTED {
        text += &format!("\n  and {} more, in the column `failure`", failed.len() - LISTED);
    }
    text
}

/// Progress on standard error: a bar on a terminal, otherwise a line per minute.
struct Shown {
    bar: ProgressBar,
    is_terminal: bool,
    cases: usize,
    before: usize,
    start: Instant,
    last: Instant,
}

impl Shown {
    fn new(cases: usize, before: usize) -> Shown {
        let bar = terminal::bar(cases).with_position(before as u64);
        bar.reset_eta();
        let now = Instant::now();
        Shown {
            bar,
            is_terminal: io::stderr().is_terminal(),
            cases,
            before,
            start: now,
            last: now,
        }
    }

    /// Shows the end of a case.
    fn ended(&mut self, row: &Row, progress: Progress) {
        if let Err(reason) = &row.results {
            let text = format!("case {} failed: {reason}", row.case);
            self.bar.suspend(|| {
                let _ = writeln!(io::stderr(), "{text}");
            });
        }
        self.bar.set_position(progress.done as u64);
        if !self.is_terminal && self.last.elapsed() >= LINES_EVERY {
            self.last = Instant::now();
            let Progress { done, failed, .. } = progress;
            let share = (self.cases - done) as f64 / (done - self.before) as f64;
            let left = rounded(self.start.elapsed().mul_f64(share));
            let _ = writeln!(
                io::stderr(),
                "{done} of {} cases, {failed} failed, {left} left",
                self.cases
            );
        }
    }
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Output(error) => error.into(),
            SweepError::Other { .. } => Failure::Argument(error.to_string()),
        }
    }
}
