//! `moorline run`: a scene in time, without FMI.

use std::path::Path;
use std::time::{Duration, Instant};

use moorline::discretisation;
use moorline::output::files::RunFiles;
use moorline::output::record::Record;
use moorline::output::recorder::Recorder;
use moorline::output::state::{self, RunState};
use moorline::output::times::Times;
use moorline::output::{collect, write_report};
use moorline::scene::{Drive, LoadedScene, MotionPath, Note, Reconstruction, Scene};
use moorline::simulation::{Simulation, Watch};
use moorline_decks::load_with;

use crate::arguments::Input;
use crate::failure::Failure;
use crate::folder::{Folder, Listener, check_apart};
use crate::summary::run_summary;
use crate::terminal::{Progress, discretise, print, remark, remark_all, simulate};

/// Time between saved states of a run.
const SAVED_EVERY: Duration = Duration::from_secs(60);

/// Coupling of the motion to the mooring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stepping {
    /// The scene's motion is followed exactly.
    Scene,
    /// The scene's motion is set at communication points only, as by a host: before every step, the motion at its start, or at its end if the inputs
    /// have that meaning.
    Host {
        /// Communication step [s].
        step: f64,
        /// True if velocities are set too.
        velocities: bool,
    },
}

impl Stepping {
    /// Time between rows of the results [s].
    fn interval(self, scene: &Scene) -> f64 {
        match self {
            Stepping::Scene => scene.output.interval,
            Stepping::Host { step, .. } => step,
        }
    }
}

/// Course of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Course {
    /// Coupling of the motion to the mooring.
    pub stepping: Stepping,
    /// True if an interrupted run is continued.
    pub resume: bool,
    /// Time at which the run stops, to be continued [s].
    pub until: Option<f64>,
}

/// Runs a scene, with its own motion or with a given one, and writes all results into a folder.
pub(crate) fn run(input: &Input, drive: &Drive, folder: &Path, course: &Course) -> Result<(), Failure> {
    let stepping = course.stepping;
    let mut loaded = load_with(&input.scene, &input.host.supplement())?;
    if let Stepping::Host { .. } = stepping
        && let Some(packaged) = discretisation::frozen(&loaded.scene)
    {
        // The elements of the FMU do not depend on the motion and duration of this run.
        loaded.scene = packaged;
    }
    let before = loaded.scene.clone();
    check_inputs_stay(input, &before, drive, folder)?;
    let mut scene = before.clone();
    let motion = match drive.is_empty() {
        true => None,
        false => scene.drive(drive).map_err(Failure::Argument)?,
    };
    let notes = loaded.change(scene);
    loaded.notes.iter().for_each(|note| remark(&loaded.path, note));
    remark_driven(notes, &loaded, &before, drive);
    if let Stepping::Host { step, .. } = stepping {
        check_step(step, &loaded.scene)?;
    }
    let given = Given::of(&loaded.scene, stepping);
    let _open = Folder::open(folder)?;
    let saved = match course.resume {
        true => Some(given.saved_in(folder)?),
        false => None,
    };
    let done = saved
        .as_ref()
        .map_or(0.0, |saved| saved.course.counters.simulated);
    if let Some(until) = course.until.filter(|until| *until <= done) {
        let text = format!("--until {until}: the run has already reached t = {done} s");
        return Err(Failure::Argument(text));
    }
    match &saved {
        Some(saved) => loaded.scene = given.discretised(saved)?,
        None if stepping == Stepping::Scene => discretise(&mut loaded, discretisation::select),
        None => {}
    }
    let run = Run::start(&loaded, folder, course, given, saved)?;
    let (record, end) = run.finish()?;
    write_report(&record, &loaded.scene, folder)?;
    let now = record.course.counters.simulated;
    let whole = loaded.scene.output.duration;
    let continued = match end {
        End::Complete => String::new(),
        End::Until => format!("stopped at t = {now} s of {whole} s: --resume continues the run\n"),
        End::Interrupted => {
            return Err(Failure::Interrupted(format!(
                "at t = {now} s of {whole} s: {} holds the results up to there, and --resume continues the run",
                folder.display()
            )));
        }
    };
    print(&format!(
        "{}{}\n{continued}written to {}\n",
        motion.map_or(String::new(), |words| words + "\n"),
        run_summary(&record),
        folder.display()
    ))
}

/// Refuses to write the tables of a run over the motion files from which it reads.
fn check_inputs_stay(input: &Input, scene: &Scene, drive: &Drive, folder: &Path) -> Result<(), Failure> {
    let beside = input.scene.parent().unwrap_or(Path::new(""));
    let own = scene.points.iter().filter_map(|point| point.motion.as_ref());
    let files = scene
        .motion
        .values()
        .chain(own)
        .filter_map(|motion| match motion {
            MotionPath::File(motion) => Some(beside.join(&motion.file)),
            _ => None,
        });
    for read in files.chain(drive.file.clone()) {
        for table in ["results.csv", "profile.csv"] {
            check_apart(&read, &folder.join(table))?;
        }
    }
    Ok(())
}

/// Checks a communication step [s] as the interval of the output.
fn check_step(step: f64, scene: &Scene) -> Result<(), Failure> {
    const OPTION: &str = "--communication-step";
    let mut coupled = scene.clone();
    coupled.output.interval = step;
    let mut mistakes = coupled.mistakes().into_iter();
    if let Some(mistake) = mistakes.find(|mistake| mistake.at == "output.interval") {
        return Err(Failure::Argument(format!("{OPTION}: {}", mistake.problem)));
    }
    let before = scene.notes();
    let notes = coupled.notes().into_iter().filter(|note| !before.contains(note));
    notes.for_each(|note| remark(Path::new(OPTION), &note));
    Ok(())
}

/// Writes remarks on a scene that a drive has changed. Remarks on motions of the drive name its file or argument.
fn remark_driven(notes: Vec<Note>, loaded: &LoadedScene, before: &Scene, drive: &Drive) {
    for note in notes {
        let body = note
            .at
            .strip_prefix("motion.")
            .and_then(|at| at.split('.').next());
        let of = |scene: &Scene| body.and_then(|body| scene.motion.get(body).cloned());
        let motion = of(&loaded.scene).filter(|motion| of(before).as_ref() != Some(motion));
        match (motion, &drive.file) {
            (Some(MotionPath::Table(_)), Some(file)) => remark(file, &note),
            (Some(_), _) => remark(Path::new("--move"), &note),
            (None, _) => remark_all(loaded, vec![note]),
        }
    }
}

/// Input that must be the same when an interrupted run continues.
struct Given {
    scene: String,
    coupling: String,
}

impl Given {
    /// The scene as given, with the motion of the command line.
    fn of(scene: &Scene, stepping: Stepping) -> Given {
        Given {
            scene: scene.to_toml(),
            coupling: match stepping {
                Stepping::Scene => "the motion of the scene".to_string(),
                Stepping::Host { step, velocities } => {
                    let velocities = if velocities { " --velocities" } else { "" };
                    format!("--communication-step {step}{velocities}")
                }
            },
        }
    }

    /// Reads the state of the interrupted run in a folder; refuses the state of another run.
    fn saved_in(&self, folder: &Path) -> Result<RunState, Failure> {
        let saved = RunState::read(folder)?;
        let refuse = |problem: String| {
            let file = folder.join(state::FILE);
            let text = format!("cannot continue from {}: {problem}", file.display());
            Err(Failure::Argument(text))
        };
        if saved.coupling != self.coupling {
            return refuse(format!(
                "the run was coupled to {}, not to {}",
                saved.coupling, self.coupling
            ));
        }
        if saved.scene != self.scene {
            let (mut then, mut now) = (saved.scene.lines(), self.scene.lines());
            let differ = std::iter::from_fn(|| Some((then.next(), now.next())))
                .take_while(|pair| *pair != (None, None))
                .find(|(then, now)| then != now);
            let (then, now) = differ.unwrap_or_default();
            let shown = |line: Option<&str>| line.map_or("nothing".to_string(), |line| format!("`{line}`"));
            return refuse(format!(
                "it belongs to another scene or motion: {} there, {} here; use the same scene and motion, or run from the start",
                shown(then),
                shown(now)
            ));
        }
        Ok(saved)
    }

    /// Returns the scene that the interrupted run simulates.
    fn discretised(&self, saved: &RunState) -> Result<Scene, Failure> {
        let read = Scene::from_toml(&saved.discretised);
        read.map_err(|mistake| Failure::Computation(format!("the saved scene cannot be read: {mistake}")))
    }
}

/// Reason why the steps end.
enum End {
    /// The duration is complete.
    Complete,
    /// The time to stop is reached.
    Until,
    /// A signal was received.
    Interrupted,
}

/// State of a run between two rows.
struct Run<'r> {
    loaded: &'r LoadedScene,
    folder: &'r Path,
    course: &'r Course,
    given: Given,
    times: Times,
    simulation: Simulation,
    recorder: Recorder,
    record: Record,
    files: RunFiles,
    watch: Watch,
}

impl<'r> Run<'r> {
    /// Builds the simulation and the files, with the first row; or restores them after their last row.
    fn start(
        loaded: &'r LoadedScene,
        folder: &'r Path,
        course: &'r Course,
        given: Given,
        saved: Option<RunState>,
    ) -> Result<Run<'r>, Failure> {
        let (scene, stepping) = (&loaded.scene, course.stepping);
        let mut simulation = simulate(loaded)?;
        let expense = discretisation::expense(scene, &simulation, stepping.interval(scene));
        remark_all(loaded, expense.into_iter().chain(scene.without_host()).collect());
        let still = simulation.in_equilibrium().ok();
        let start = match stepping {
            Stepping::Scene => simulation.follow_scene(),
            Stepping::Host { velocities, .. } => {
                set_motion(&mut simulation, 0.0, velocities);
                simulation.restart(0.0)
            }
        };
        start.map_err(|error| Failure::of_simulation(error, loaded))?;
        let recorder =
            Recorder::new(scene, simulation.model()).map_err(|mistake| Failure::of_scene(mistake, loaded))?;
        let times = Times::new(scene.output.duration, stepping.interval(scene));
        let columns = (recorder.columns()[1..].to_vec(), times.count + 1);
        let mut record = collect::record(scene, &simulation, still.as_ref(), columns);
        let mut watch = Watch::new(scene, &simulation);
        remark_all(loaded, watch.look(&simulation));
        let bends = (0..scene.lines.len()).any(|line| simulation.bending(line).is_some());
        let files = match saved {
            None => RunFiles::create(folder, &record, &scene.output, &times, bends)?,
            Some(saved) => {
                simulation.restore(saved.snapshot);
                watch.resume(&simulation);
                record.course = saved.course;
                RunFiles::reopen(folder, &record, &scene.output, &times, (&saved.marks, bends))?
            }
        };
        let mut run = Run {
            loaded,
            folder,
            course,
            given,
            times,
            simulation,
            recorder,
            record,
            files,
            watch,
        };
        if run.record.course.rows == 0 {
            run.add_row(0)?;
        }
        Ok(run)
    }

    /// Steps until the end of the run, an interruption or the time to stop, and adds a row at every step.
    fn finish(mut self) -> Result<(Record, End), Failure> {
        let listener = Listener::new();
        let (count, first) = (self.times.count, self.record.course.rows);
        let mut progress = Progress::new(count, first - 1, self.times.end);
        let mut saved = Instant::now();
        let mut end = End::Complete;
        for index in first..=count {
            let stepped = self.step(index, &progress);
            if let Err(failure) = stepped {
                progress.finish();
                self.files.flush()?;
                return Err(failure);
            }
            progress.step(self.times.at(index));
            if index == count {
                break;
            }
            if listener.is_interrupted() {
                end = End::Interrupted;
                break;
            }
            if self
                .course
                .until
                .is_some_and(|until| self.times.at(index) >= until)
            {
                end = End::Until;
                break;
            }
            if saved.elapsed() >= SAVED_EVERY {
                self.save()?;
                saved = Instant::now();
            }
        }
        progress.finish();
        match end {
            End::Complete => {
                self.files.flush()?;
                RunState::remove(self.folder);
            }
            End::Until | End::Interrupted => self.save()?,
        }
        Ok((self.record, end))
    }

    /// Makes the step that ends with row `index`, and adds the row.
    fn step(&mut self, index: usize, progress: &Progress) -> Result<(), Failure> {
        let Run {
            times, simulation, ..
        } = self;
        if let Stepping::Host { velocities, .. } = self.course.stepping {
            let solver = &self.loaded.scene.solver;
            let ahead = usize::from(solver.input_reconstruction == Reconstruction::Interpolate);
            set_motion(simulation, times.at(index - 1 + ahead), velocities);
        }
        let before = Instant::now();
        simulation.advance(times.step(index - 1))?;
        let counters = &mut self.record.course.counters;
        counters.wall += before.elapsed();
        counters.substeps += simulation.substeps() as u64;
        self.add_row(index)?;
        let notes = self.watch.look(&self.simulation);
        if !notes.is_empty() {
            progress.suspend(|| remark_all(self.loaded, notes));
        }
        Ok(())
    }

    /// Adds the row of the present state.
    fn add_row(&mut self, index: usize) -> Result<(), Failure> {
        let (simulation, record) = (&self.simulation, &mut self.record);
        let now = self.times.at(index);
        let row = self.recorder.row(simulation, now).map_err(Failure::Computation)?;
        let shape = |time| collect::frame(simulation, time);
        self.files.add(record, index, row, shape)?;
        if let Some(flight) = collect::flight(simulation, now) {
            record.course.add_flight(&flight);
        }
        record.course.counters.simulated = now;
        Ok(())
    }

    /// Writes all buffered rows, and saves the state.
    fn save(&mut self) -> Result<(), Failure> {
        let state = RunState {
            scene: self.given.scene.clone(),
            coupling: self.given.coupling.clone(),
            discretised: self.loaded.scene.to_toml(),
            snapshot: self.simulation.snapshot().clone(),
            marks: self.files.mark()?,
            course: self.record.course.clone(),
        };
        Ok(state.write(self.folder)?)
    }
}

fn set_motion(simulation: &mut Simulation, time: f64, velocities: bool) {
    for moving in simulation.model().moving(time) {
        let velocity = moving.velocity.map(|rate| velocities.then_some(rate));
        simulation.set_body(moving.body, moving.pose, velocity);
    }
    for (line, change) in simulation.model().paid_out(time) {
        simulation.set_length_change(line, change);
    }
}
