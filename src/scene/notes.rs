//! Remarks on scenes that can be used as they are.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt;

use super::check::{number, quantity, rules};
use super::names::Names;
use super::path::quoted;
use super::table_ends;
use super::{Integrator, Line, LineType, Point, PointKind, Scene, Waves};

/// A remark on a scene that can be used as it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// Key path.
    pub at: String,
    /// The remark.
    pub text: String,
    /// Line of the key in the file [-], from 1, if it is in a file.
    pub line: Option<usize>,
}

impl Note {
    /// A remark without a line of a file.
    pub fn new(at: impl Into<String>, text: impl Into<String>) -> Note {
        Note {
            at: at.into(),
            text: text.into(),
            line: None,
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.at, self.text)
    }
}

/// Least number of steps in a period of a motion without a note [-].
const STEPS_PER_PERIOD: f64 = 10.0;
/// Damping ratio of the first axial mode of a line with the suggested axial damping [-].
const FIRST_MODE_RATIO: f64 = 0.01;

impl Scene {
    /// Returns remarks on a scene that can be used as it is; those on unusual values first.
    pub fn notes(&self) -> Vec<Note> {
        let mut notes = self.plausibility();
        for (name, line_type) in &self.line_types {
            note_line_type(self, name, line_type, &mut notes);
        }
        let names = Names::of(self);
        for (i, point) in self.points.iter().enumerate() {
            note_point((self, &names), &format!("points[{i}]"), point, &mut notes);
        }
        for (i, line) in self.lines.iter().enumerate() {
            let is_loop = chord_between(self, names.ends(line))
                .is_some_and(|chord| chord <= ENDS_APART * line.length());
            let is_free =
                |end: usize| names.ends(line)[end].is_some_and(|point| point.kind == PointKind::Free);
            let in_space = "the point is free and does not turn: the clamp holds a direction in space, and its moment acts on no body";
            rules! { &mut notes, &format!("lines[{i}]");
                "" if is_loop => "both ends are at the same place: the line hangs in a loop";
                "clamped_a" if line.clamped_a.is_some() && is_free(0) => "{in_space}";
                "clamped_b" if line.clamped_b.is_some() && is_free(1) => "{in_space}";
            }
        }
        note_names(self, &mut notes);
        note_twins(self, &names, &mut notes);
        if let Some(waves) = self.waves() {
            note_waves(self, waves, &mut notes);
        }
        note_whole(self, &mut notes);
        notes.extend(self.idle());
        notes.extend(table_ends::notes(self));
        notes
    }

    /// Returns the remark on the inputs that a run without a host lacks.
    pub fn without_host(&self) -> Option<Note> {
        let remark = "no host gives the flow in this run: the water is at rest except for a current";
        self.has_host_flow().then(|| Note::new("water.flow", remark))
    }

    /// Returns suggestions for keys that are left open, and notes on required keys without effect; only `moorline check` prints them.
    pub fn advice(&self) -> Vec<Note> {
        let mut notes = self.idle_by_need();
        if self.solver.integrator == Integrator::QuasiStatic {
            return notes;
        }
        for (name, line_type) in &self.line_types {
            let has = |line: &&Line| line.sections.iter().any(|section| section.line_type == *name);
            let longest = self
                .lines
                .iter()
                .filter(has)
                .map(Line::length)
                .fold(0.0, f64::max);
            if line_type.leaves_damping_open() && longest > 0.0 {
                let at = format!("line_types.{}", quoted(name));
                notes.push(Note::new(at, self.advice_on_damping(line_type, longest)));
            }
        }
        notes
    }

    fn advice_on_damping(&self, line_type: &LineType, longest: f64) -> String {
        if self.makes_beams(line_type) {
            return "no structural damping: waves along the line are not damped".to_string();
        }
        let key = match line_type.dynamic_stiffness {
            Some(_) => "dynamic_damping",
            None => "axial_damping",
        };
        let open = format!(
            "no `{key}`: the default decreases on finer meshes, so that axial waves decay slowly and results converge slowly"
        );
        match self.damping_of_first_mode(line_type, longest) {
            Some(damping) => format!(
                "{open}; `{key} = {damping:.1e}` [N s] would damp the first axial mode of {} with {} % of critical",
                quantity(longest, "m"),
                number(100.0 * FIRST_MODE_RATIO)
            ),
            None => open,
        }
    }

    /// Damping BA [N s] with a ratio of [`FIRST_MODE_RATIO`] in the first axial mode of a line of a length [m], a quarter wave: ω = ½π√(EA/m)/L,
    /// BA = 2ζ·EA/ω.
    fn damping_of_first_mode(&self, line_type: &LineType, length: f64) -> Option<f64> {
        let (ea, mass) = (line_type.axial_stiffness?, self.mass(line_type));
        let damping = 4.0 * FIRST_MODE_RATIO / PI * length * (ea * mass).sqrt();
        (damping > 0.0 && damping.is_finite()).then_some(damping)
    }
}

fn note_line_type(scene: &Scene, name: &str, line_type: &LineType, notes: &mut Vec<Note>) {
    let used = scene.sections().any(|section| section.line_type == name);
    let drags = !used || scene.water.is_none() || line_type.drag_normal.is_some();
    let pushing = match (scene.waves(), scene.current()) {
        (Some(_), _) => Some("waves exert"),
        _ if scene.has_host_flow() => Some("flow exerts"),
        (None, current) => current.map(|_| "current exerts"),
    };
    let moves = scene.solver.integrator != Integrator::QuasiStatic;
    rules! { notes, &format!("line_types.{}", quoted(name));
        "" if !used => "no line uses this line type";
        "" given pushing = pushing.filter(|_| !drags) =>
            "no `drag_normal`: the {pushing} no normal drag on the line, and transverse motion is not damped by the water";
        "" if !drags && pushing.is_none() && moves =>
            "no `drag_normal`: transverse motion is not damped by the water";
        "" if used && scene.seabed.is_some() && scene.weight(line_type) < 0.0 =>
            "lighter than water: it floats off the seabed";
    }
}

/// Distance between the ends of a line [m], if both are known.
pub(super) fn chord(scene: &Scene, line: &Line) -> Option<f64> {
    chord_between(scene, [&line.from, &line.to].map(|name| scene.point(name)))
}

/// Distance between two points [m], if both are known.
pub(super) fn chord_between(scene: &Scene, ends: [Option<&Point>; 2]) -> Option<f64> {
    let [a, b] = ends.map(|end| scene.reference_position(end?));
    let (a, b) = (a?, b?);
    Some((0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt())
}

fn note_point((scene, names): (&Scene, &Names), at: &str, point: &Point, notes: &mut Vec<Note>) {
    let mut joined = scene
        .lines
        .iter()
        .filter(|line| line.joins(&point.name))
        .peekable();
    let alone = joined.peek().is_none();
    let place = scene.reference_position(point);
    let height = place.map_or(0.0, |place| place[2]);
    let lifted = scene.highest(point);
    let water = scene
        .water
        .as_ref()
        .filter(|_| joined.any(|line| !scene.meets_surface_between(line, names.ends(line))));
    let open = water.is_some_and(|water| water.surface.is_none());
    let everywhere = "but its lines are modelled as submerged there too";
    let end = match scene.all_beams() {
        true => "",
        false => "; `surface = true` in [water] models the free surface at z = 0",
    };
    rules! { notes, at;
        "" if alone => "no line ends at this point";
        "position" if water.is_some() && height > 0.0 => "above z = 0, {everywhere}";
        "" if open && height <= 0.0 && lifted > 0.0 =>
            "the scene's motion takes it to z = {lifted:.3} m, {everywhere}{end}";
        "force" if point.force.is_some() && point.kind != PointKind::Free =>
            "a force on a point that is not free changes only the reaction of its support";
        "" if point.kind == PointKind::Prescribed && (point.mass.is_some() || point.volume.is_some()) =>
            "the mass and volume of a prescribed point change only the reaction of its support, which a run reports in channels alone";
    }
}

/// Distance below which two ends count as coincident, relative to the length of the line [-].
const ENDS_APART: f64 = 1e-6;

/// Notes lines with the same sections between the same positions, to a micrometre: they usually come from a row that was entered twice.
fn note_twins(scene: &Scene, names: &Names, notes: &mut Vec<Note>) {
    let mut known: BTreeMap<[[i64; 3]; 2], &Line> = BTreeMap::new();
    for (i, line) in scene.lines.iter().enumerate() {
        let ends = names.ends(line).map(|end| scene.reference_position(end?));
        let [Some(a), Some(b)] = ends else { continue };
        let micrometres = |x: f64| (1e6 * x).round() as i64;
        let first = known
            .entry([a, b].map(|end| end.map(micrometres)))
            .or_insert(line);
        let is_twin = first.name != line.name && first.sections == line.sections;
        rules! { notes, &format!("lines[{i}]");
            "" if is_twin => "same ends and sections as {}: their forces add up", first.name;
        }
    }
}

/// Notes names of points, lines and vessels that differ only in case.
fn note_names(scene: &Scene, notes: &mut Vec<Note>) {
    let mut known = BTreeMap::new();
    for (at, name) in scene.names() {
        let first = known.entry(name.to_lowercase()).or_insert(name);
        rules! { notes, &at;
            "name" if *first != name => "\"{name}\" and \"{first}\" differ only in case";
        }
    }
}

fn note_waves(scene: &Scene, waves: &Waves, notes: &mut Vec<Note>) {
    let seeds = || {
        waves
            .seas
            .iter()
            .zip(0..)
            .map(|(sea, place)| sea.spectrum_seed(place))
    };
    for (i, seed) in seeds().enumerate().filter(|(_, seed)| seed.is_some()) {
        let same = seeds().take(i).position(|other| other == seed);
        rules! { notes, "water.waves";
            "[{i}]" given sea = same =>
                "same seed as sea {sea}: both have the same phases, and their waves add up; give each spectrum a different seed";
        }
    }
    rules! { notes, "water.waves";
        "" if waves.ramp().is_none() =>
            "no `ramp`: lines at rest meet the full sea at the start, and a transient follows";
    }
    for (name, line_type) in &scene.line_types {
        rules! { notes, &format!("line_types.{}", quoted(name));
            "" if line_type.diameter.is_none() => "no `diameter`: the waves have no effect on it";
        }
    }
    let ramp = waves.ramp().unwrap_or(0.0);
    rules! { notes, "water.waves";
        "" if ramp > scene.output.duration => "the ramp of {} is longer than the run", quantity(ramp, "s");
    }
}

fn note_whole(scene: &Scene, notes: &mut Vec<Note>) {
    let slides = scene.seabed.as_ref().is_some_and(|seabed| seabed.friction.acts());
    let mut types = scene.line_types.values();
    let steps = scene.output.duration / scene.output.interval;
    let longest = scene.solver.time_step_max.min(scene.output.interval);
    let follows_steps = !matches!(
        scene.solver.integrator,
        Integrator::Auto | Integrator::Leapfrog | Integrator::QuasiStatic
    );
    let period = scene.periods().reduce(f64::min).filter(|_| follows_steps);
    let mut lines = scene.lines.iter();
    let comes_off = lines.any(|line| line.release.is_some() || line.failure.is_some());
    rules! { notes, "";
        "solver.integrator" given period = period.filter(|period| *period < STEPS_PER_PERIOD * longest) =>
            "steps of up to {} do not resolve the motion with a period of {}; steps of {} would give {STEPS_PER_PERIOD} per period",
            quantity(longest, "s"), quantity(period, "s"), quantity(period / STEPS_PER_PERIOD, "s");
        "output.stiffness" if scene.output.stiffness && !scene.vessels.is_empty() && comes_off =>
            "once a line is released or broken, the stiffness of its vessel has no value: hosts that read all outputs together then get an error";
        "gravity" if scene.gravity == 0.0 => "0: lines and points are weightless";
        "seabed.friction" if slides && types.any(|line_type| scene.makes_beams(line_type)) =>
            "beams have no friction on the seabed: for them `friction` changes nothing";
        "output.interval" if (steps - steps.round()).abs() > 1e-6 * steps =>
            "the duration of {} s is not a whole number of intervals: the last interval is shorter",
            number(scene.output.duration);
    }
}
