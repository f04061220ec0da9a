//! `moorline run`: a scene in time, without FMI.

use std::path::Path;
use std::time::{Duration, Instant};

use moorline::discretisation;
use moorline::interface::{Binding, Causality, Interface, Kind, Layout, Variable};
use moorline::model::{Body, Model, Moving};
use moorline::output::channels::Channels;
use moorline::output::figures::ELEVATION;
use moorline::output::record::{Column, Record};
use moorline::output::{collect, write_run};
use moorline::scene::{Drive, LoadedScene, MotionPath, Reconstruction, Scene};
use moorline::simulation::{Simulation, Watch};

use crate::arguments::Input;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::summary::run_summary;
use crate::terminal::{discretise, print, progress, read_scene, remark, remark_all, simulate};

/// Number of shapes kept of a run whose scene does not request all of them [-].
const FRAMES_MAX: usize = 240;

/// Coupling of the motion to the mooring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Pace {
    /// Exactly.
    Scene,
    /// The scene's motion as a host gives it, at communication points only: before every step where it starts, or where it ends if
    /// the inputs have that meaning.
    Host {
        /// Communication step [s].
        step: f64,
        /// Velocities are set too.
        velocities: bool,
    },
}

impl Pace {
    /// Time between rows of the results [s].
    fn interval(self, scene: &Scene) -> f64 {
        match self {
            Pace::Scene => scene.output.interval,
            Pace::Host { step, .. } => step,
        }
    }
}

/// Runs a scene, with its own motion or with a given one, and writes all results into a folder.
pub(crate) fn run(input: &Input, drive: &Drive, folder: &Path, pace: Pace) -> Result<(), Failure> {
    let mut loaded = read_scene(&input.scene, &input.host.supplement())?;
    if let Pace::Host { .. } = pace
        && let Some(packaged) = discretisation::frozen(&loaded.scene)
    {
        // The elements of the FMU do not depend on the motion and duration of this run.
        loaded.scene = packaged;
    }
    let mut motion = None;
    if !drive.is_empty() {
        let before = loaded.scene.clone();
        motion = loaded.scene.drive(drive).map_err(Failure::Argument)?;
        remark_driven(&loaded, &before, drive);
    }
    let _open = Folder::open(folder)?;
    if pace == Pace::Scene {
        discretise(&mut loaded, discretisation::select);
    }
    let mut simulation = simulate(&loaded)?;
    let expense = discretisation::expense(&loaded.scene, &simulation, pace.interval(&loaded.scene));
    remark_all(&loaded, expense.into_iter().collect());
    let still = simulation.in_equilibrium().ok();
    let start = match pace {
        Pace::Scene => simulation.follow_scene(),
        Pace::Host { velocities, .. } => {
            set_motion(&mut simulation, 0.0, velocities);
            simulation.restart(0.0)
        }
    };
    start.map_err(|error| Failure::of_simulation(error, &loaded))?;
    let interface = Interface::new(&loaded.scene, simulation.model(), Layout::Scalars)
        .map_err(|mistake| Failure::of_scene(mistake, &loaded))?;
    let channels = Channels::new(&loaded.scene, simulation.model())
        .map_err(|mistake| Failure::of_scene(mistake, &loaded))?;
    let recorder = Recorder {
        variables: recorded(&interface).collect(),
        channels,
    };
    let columns = recorder.columns(simulation.model());
    let record = collect::record(&loaded.scene, &simulation, still.as_ref(), columns);
    let mut watch = Watch::new(&loaded.scene, &simulation);
    let record = step_through(&loaded, &mut simulation, &recorder, pace, record, &mut watch)?;
    write_run(&record, &loaded.scene, folder)?;
    print(&format!(
        "{}{}\nwritten to {}\n",
        motion.map_or(String::new(), |words| words + "\n"),
        run_summary(&record),
        folder.display()
    ))
}

/// Remarks on a scene that a drive has changed, except those on the scene before. Remarks on motions of the drive name its file or argument.
fn remark_driven(loaded: &LoadedScene, before: &Scene, drive: &Drive) {
    let (known, mut notes) = (before.notes(), loaded.scene.notes());
    notes.retain(|note| !known.contains(note));
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

/// Steps from the start to the scene's duration, and adds a row and where wanted a shape at every step to the record; `watch` sees every row.
fn step_through(
    loaded: &LoadedScene,
    simulation: &mut Simulation,
    recorder: &Recorder<'_>,
    pace: Pace,
    mut record: Record,
    watch: &mut Watch,
) -> Result<Record, Failure> {
    let scene = &loaded.scene;
    let times = Times::new(scene.output.duration, pace.interval(scene));
    let ahead = usize::from(scene.solver.input_reconstruction == Reconstruction::Interpolate);
    let stride = times.frame_stride(scene.output.profile);
    record.add_row(0.0, recorder.row(simulation, 0.0));
    record.frames.push(collect::frame(simulation, 0.0));
    record.flight.extend(collect::flight(simulation, 0.0));
    let bar = progress(times.count as u64);
    remark_all(loaded, watch.look(simulation));
    let mut wall = Duration::ZERO;
    for index in 0..times.count {
        if let Pace::Host { velocities, .. } = pace {
            let told = times.at(index + ahead);
            set_motion(simulation, told, velocities);
        }
        let before = Instant::now();
        simulation.advance(times.step(index))?;
        wall += before.elapsed();
        record.counters.substeps += simulation.substeps() as u64;
        let now = times.at(index + 1);
        let row = recorder.row(simulation, now);
        check_finite(now, record.columns(), &row)?;
        record.add_row(now, row);
        let notes = watch.look(simulation);
        if !notes.is_empty() {
            bar.suspend(|| remark_all(loaded, notes));
        }
        record.flight.extend(collect::flight(simulation, now));
        if (index + 1) % stride == 0 || index + 1 == times.count {
            record.frames.push(collect::frame(simulation, now));
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    record.counters.wall = wall;
    record.counters.simulated = times.end;
    Ok(record)
}

/// Refuses a row with a value that is not finite.
fn check_finite(time: f64, columns: &[Column], row: &[f64]) -> Result<(), Failure> {
    // The first column is the time.
    let values = columns.iter().skip(1).zip(row);
    let lost = values.into_iter().find(|(_, value)| !value.is_finite());
    lost.map_or(Ok(()), |(column, value)| {
        Err(Failure::Computation(format!(
            "at t = {time} s, {}: {value} {} is no result; try a smaller solver.time_step_max, and look at the motion",
            column.name, column.unit
        )))
    })
}

/// Columns of the results: variables of the interface, then channels.
struct Recorder<'i> {
    variables: Vec<&'i Variable>,
    channels: Channels,
}

impl Recorder<'_> {
    fn columns(&self, model: &Model) -> Vec<Column> {
        let mut all = columns(&self.variables);
        all.extend(model.waves.as_ref().map(|_| Column {
            name: ELEVATION.to_string(),
            unit: "m".to_string(),
            description: "elevation of the surface at x = y = 0".to_string(),
            whole: false,
        }));
        all.extend(self.channels.columns());
        all
    }

    /// Values at `time` [s], each in its column's unit.
    fn row(&self, simulation: &Simulation, time: f64) -> Vec<f64> {
        let variables = self.variables.iter();
        let mut row: Vec<f64> = variables.map(|v| value(v, simulation, time)).collect();
        let waves = simulation.model().waves.as_ref();
        row.extend(waves.map(|waves| waves.elevation(0.0, 0.0, time)));
        row.extend(self.channels.values(simulation));
        row
    }
}

/// Output times: multiples of an interval, and the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Times {
    interval: f64,
    /// End [s].
    pub end: f64,
    /// Number of steps [-].
    pub count: usize,
}

impl Times {
    /// Times from 0 to `end` [s] every `interval` [s]; the last step is shorter where the interval does not divide the end.
    pub(crate) fn new(end: f64, interval: f64) -> Times {
        // A remainder of a millionth of a step is rounding of the quotient, not a step.
        let count = (end / interval - 1e-6).ceil().max(0.0) as usize;
        Times { interval, end, count }
    }

    /// Time at the beginning of a step, or the end [s].
    pub(crate) fn at(&self, index: usize) -> f64 {
        // Six times 0.05 is 0.30000000000000004, six twentieths are 0.3.
        let a_second = (1.0 / self.interval).round();
        if index == self.count {
            self.end
        } else if (a_second * self.interval - 1.0).abs() < 1e-12 {
            index as f64 / a_second
        } else {
            index as f64 * self.interval
        }
    }

    /// Length of a step [s]: the interval to the last bit, save for a shorter last one.
    pub(crate) fn step(&self, index: usize) -> f64 {
        let rest = self.end - index as f64 * self.interval;
        if index + 1 == self.count && rest < self.interval * (1.0 - 1e-6) {
            rest
        } else {
            self.interval
        }
    }

    /// Every how many steps a shape is kept [-].
    pub(crate) fn frame_stride(&self, all: bool) -> usize {
        if all {
            1
        } else {
            self.count.div_ceil(FRAMES_MAX).max(1)
        }
    }
}

/// Inputs and outputs, without profiles: these have a file of their own.
pub(crate) fn recorded(interface: &Interface) -> impl Iterator<Item = &Variable> {
    interface.variables().iter().filter(|variable| {
        matches!(variable.causality, Causality::Input | Causality::Output)
            && !matches!(variable.binding, Binding::Profile { .. })
    })
}

/// Columns of these variables.
pub(crate) fn columns(variables: &[&Variable]) -> Vec<Column> {
    variables
        .iter()
        .map(|variable| Column {
            name: variable.name.clone(),
            unit: variable.unit.name.to_string(),
            description: variable.description.clone(),
            whole: variable.kind != Kind::Float64,
        })
        .collect()
}

/// A variable's value now, in its unit; inputs as the scene moves the points at `time` [s].
fn value(variable: &Variable, simulation: &Simulation, time: f64) -> f64 {
    scene_input(variable, simulation.model(), time).unwrap_or_else(|| {
        let mut value = [f64::NAN];
        // An output that cannot be computed is no number; the table marks it so.
        let _ = Interface::read(variable, simulation, &mut value);
        value[0]
    })
}

/// An input by the scene's motion at `time` [s], in its unit; `None` of an output.
pub(crate) fn scene_input(variable: &Variable, model: &Model, time: f64) -> Option<f64> {
    let of = |body: Body, part: fn(&Moving) -> [f64; 6], axis: usize| {
        let moving = model.moving(time);
        let found = moving.iter().find(|moving| moving.body == body);
        Some(found.map_or(0.0, |moving| part(moving)[axis]))
    };
    match variable.binding {
        Binding::Displacement { body, axis } => of(body, |moving| moving.pose, axis),
        Binding::Velocity { body, axis } => of(body, |moving| moving.velocity, axis),
        Binding::LengthChange { line } => {
            let winch = model.lines[line].winch.as_ref();
            let path = winch.and_then(|winch| winch.path.as_ref());
            Some(path.map_or(0.0, |path| path.at(time)))
        }
        _ => None,
    }
}

fn set_motion(simulation: &mut Simulation, time: f64, velocities: bool) {
    for moving in simulation.model().moving(time) {
        let velocity = moving.velocity.map(|rate| velocities.then_some(rate));
        simulation.set_body(moving.body, moving.pose, velocity);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_the_interval_to_the_last_bit_and_end_at_the_end() {
        let times = Times::new(60.0, 0.05);
        assert_eq!(times.count, 1200);
        assert!((0..1200).all(|i| times.step(i) == 0.05));
        assert_eq!(times.at(6), 0.3);
        assert_eq!(times.at(1200), 60.0);
    }

    #[test]
    fn a_last_step_is_shorter_where_the_interval_does_not_divide_the_duration() {
        let times = Times::new(1.0, 0.3);
        assert_eq!(times.count, 4);
        assert!((times.step(3) - 0.1).abs() < 1e-12);
        assert_eq!(times.at(4), 1.0);
    }

    #[test]
    fn an_interval_beyond_the_duration_is_one_step() {
        let times = Times::new(1.0, 5.0);
        assert_eq!((times.count, times.step(0)), (1, 1.0));
    }
}
