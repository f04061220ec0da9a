//! Input and output of all commands: scenes, remarks, results, progress.

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use moorline::discretisation::{self, Discretisation};
use moorline::scene::{LoadedScene, Note, Scene};
use moorline::simulation::Simulation;
use moorline_decks::{Supplement, load_with};

use crate::failure::Failure;

/// Reads a scene file with the data that a deck leaves to its host; remarks on it go to standard error.
pub(crate) fn read_scene(path: &Path, supplement: &Supplement) -> Result<LoadedScene, Failure> {
    let loaded = load_with(path, supplement)?;
    loaded.notes.iter().for_each(|note| remark(path, note));
    Ok(loaded)
}

/// Writes a remark on a scene, or on another file, to standard error. A failure to write it does not end the command.
pub(crate) fn remark(path: &Path, note: &Note) {
    let _ = writeln!(io::stderr(), "{}", noted(path, note));
}

/// Text of a remark with its file and, if it has one, its line.
pub(crate) fn noted(path: &Path, note: &Note) -> String {
    match note.line {
        Some(line) => format!("note: {}:{line}: {note}", path.display()),
        None => format!("note: {}: {note}", path.display()),
    }
}

/// Writes remarks that were found after the scene was read.
pub(crate) fn remark_all(loaded: &LoadedScene, notes: Vec<Note>) {
    for note in notes {
        remark(&loaded.path, &loaded.locate_note(note));
    }
}

/// Selects the mesh, integrator and step that a scene leaves open, once for all parts of a command. Writes remarks if they are not expected to keep
/// the tolerance.
pub(crate) fn discretise(loaded: &mut LoadedScene, select: fn(&Scene) -> Option<Discretisation>) {
    if let Some(found) = select(&loaded.scene) {
        take(loaded, found);
    }
}

/// Selects the mesh that the equilibrium of a scene needs, and solves the equilibrium; writes remarks as [`discretise`] does.
pub(crate) fn at_rest(loaded: &mut LoadedScene) -> Result<Simulation, Failure> {
    match discretisation::at_rest(&loaded.scene) {
        Ok((found, simulation)) => {
            found.into_iter().for_each(|found| take(loaded, found));
            Ok(simulation)
        }
        Err(error) => Err(Failure::of_simulation(error, loaded)),
    }
}

fn take(loaded: &mut LoadedScene, found: Discretisation) {
    remark_all(loaded, found.shortfalls());
    loaded.scene = found.scene;
}

/// Returns the simulation of a scene, in static equilibrium.
pub(crate) fn simulate(loaded: &LoadedScene) -> Result<Simulation, Failure> {
    Simulation::new(&loaded.scene).map_err(|error| Failure::of_simulation(error, loaded))
}

/// Prints text to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(Failure::Print)
}

/// Progress bar of a command, shown on a terminal.
pub(crate) fn bar(steps: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left")
        .expect("the template is a constant that indicatif accepts");
    ProgressBar::new(steps as u64).with_style(style)
}

/// Time between progress lines if standard error is not a terminal.
pub(crate) const LINES_EVERY: Duration = Duration::from_secs(60);

/// Progress of a run on standard error: a bar on a terminal, otherwise a line per minute, both with the remaining time.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    lines: Option<Lines>,
}

impl Progress {
    /// Creates the progress of a run that ends at a time [s], after some of its steps are done.
    pub(crate) fn new(steps: usize, done: usize, end: f64) -> Progress {
        let bar = bar(steps).with_position(done as u64);
        bar.reset_eta();
        let lines = Lines::new([steps, done], end, Instant::now());
        Progress {
            bar,
            lines: (!io::stderr().is_terminal()).then_some(lines),
        }
    }

    /// Records a step that ends at a time [s].
    pub(crate) fn step(&mut self, time: f64) {
        match &mut self.lines {
            None => self.bar.inc(1),
            Some(lines) => {
                if let Some(line) = lines.step(time, Instant::now()) {
                    // a failure to write a line does not end the run
                    let _ = writeln!(io::stderr(), "{line}");
                }
            }
        }
    }

    /// Hides the bar while `write` writes to standard error.
    pub(crate) fn suspend(&self, write: impl FnOnce()) {
        self.bar.suspend(write);
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Progress as lines of text.
#[derive(Debug)]
struct Lines {
    steps: usize,
    /// Numbers of steps done before the start and up to now.
    done: [usize; 2],
    /// End of the run [s].
    end: f64,
    start: Instant,
    last: Instant,
}

impl Lines {
    fn new([steps, done]: [usize; 2], end: f64, now: Instant) -> Lines {
        Lines {
            steps,
            done: [done; 2],
            end,
            start: now,
            last: now,
        }
    }

    /// Records a step that ends at a time [s]; returns a line once a minute.
    fn step(&mut self, time: f64, now: Instant) -> Option<String> {
        self.done[1] += 1;
        if now - self.last < LINES_EVERY {
            return None;
        }
        self.last = now;
        let [before, done] = self.done;
        let share = (self.steps - done) as f64 / (done - before) as f64;
        let left = rounded((now - self.start).mul_f64(share));
        let percent = 100 * done / self.steps;
        Some(format!(
            "t = {time} s of {} s, {percent} %, {left} left",
            self.end
        ))
    }
}

/// Text of a remaining time.
pub(crate) fn rounded(left: Duration) -> String {
    match left.as_secs() {
        left @ 0..120 => format!("{left} s"),
        left @ 120..7200 => format!("{} min", (left + 30) / 60),
        left => format!("{:.1} h", left as f64 / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_progress_of_a_run_is_a_line_a_minute_with_the_time_that_remains() {
        let start = Instant::now();
        let mut lines = Lines::new([1000, 100], 100.0, start);
        let mut said = Vec::new();
        for step in 1..=900 {
            let now = start + Duration::from_millis(500) * step;
            said.extend(lines.step(f64::from(100 + step) * 0.1, now));
        }
        let expected = [
            "t = 22 s of 100 s, 22 %, 7 min left",
            "t = 34 s of 100 s, 34 %, 6 min left",
        ];
        assert_eq!(said[..2], expected);
        assert_eq!(said[6..], ["t = 94 s of 100 s, 94 %, 30 s left"]);
    }

    #[test]
    fn a_run_of_less_than_a_minute_is_silent() {
        let start = Instant::now();
        let mut lines = Lines::new([59, 0], 59.0, start);
        assert!((1..=59_u32).all(|step| {
            lines
                .step(f64::from(step), start + Duration::from_secs(1) * step)
                .is_none()
        }));
    }
}
