//! Notes on likely mistakes in a run: ends that jump or leave the water, too few inputs, unrealistic strains, tables whose range is left.

mod left_tables;

use left_tables::LeftTables;
use nalgebra::Vector3;

use super::Simulation;
use crate::model::{End, Release};
use crate::scene::{Note, Scene, instant, metres};

/// Fraction of the unstretched length of a line by which its end may move in one communication step [-].
const JUMP: f64 = 0.1;

/// Depth below a seabed that is not level from which on a point is noted [m].
const BURIED: f64 = 0.01;

/// Depth below a seabed that is not level from which on a segment is noted, relative to its length [-]: four times that of a segment on the level.
const SUNK: f64 = 0.06;
/// Places along a segment at which its depth is examined [-].
const WITHIN: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Observes a simulation at its communication points; each note is given once.
#[derive(Debug, Clone)]
pub struct Watch {
    lines: Vec<Watched>,
    has_jumped: bool,
    has_risen: bool,
    has_noted_inputs: bool,
    tables: LeftTables,
    /// Notes on keys that have no effect with the chosen integrators, and on points under the seabed.
    at_start: Vec<Note>,
}

#[derive(Debug, Clone)]
struct Watched {
    /// Positions of the ends at the last communication point [m].
    ends: [Vector3<f64>; 2],
    /// Strain above which a note is given [-]; infinite after the note, or if large strains are intended.
    strain_max: f64,
    /// End and tension [N] at which the line breaks; `None` if there is none, or after the comparison with the first state.
    breaks_at: Option<(End, f64)>,
    /// True if the line is modelled as submerged at any height and the user has not been told.
    is_submerged: bool,
}

impl Watch {
    /// Begins to observe a simulation of a scene, in its present state.
    pub fn new(scene: &Scene, simulation: &Simulation) -> Watch {
        let lines = scene.lines.iter().enumerate();
        let watched = lines.map(|(index, line)| Watched {
            ends: ends(simulation, index),
            strain_max: scene.usual_strain(line),
            breaks_at: simulation.model.lines[index].release.and_then(breaking_tension),
            is_submerged: scene.submerges_silently(line, simulation.snapshot.follows_scene),
        });
        Watch {
            lines: watched.collect(),
            has_jumped: false,
            has_risen: false,
            has_noted_inputs: false,
            tables: LeftTables::new(scene),
            at_start: [
                scene.idle_with(simulation.choices().map(|choice| choice.integrator)),
                buried(simulation),
                sunk(simulation),
            ]
            .concat(),
        }
    }

    /// Continues from a state that was not reached by a step, such as a restored one.
    pub fn resume(&mut self, simulation: &Simulation) {
        for (index, watched) in self.lines.iter_mut().enumerate() {
            watched.ends = ends(simulation, index);
        }
    }

    /// Returns the notes on the present state that were not given before; nothing is allocated if there are none.
    pub fn look(&mut self, simulation: &Simulation) -> Vec<Note> {
        let mut notes = std::mem::take(&mut self.at_start);
        for (index, watched) in self.lines.iter_mut().enumerate() {
            let now = ends(simulation, index);
            let before = std::mem::replace(&mut watched.ends, now);
            if let Some(note) = jump(simulation, index, before, now).filter(|_| !self.has_jumped) {
                self.has_jumped = true;
                notes.push(note);
            }
            if watched.is_submerged && !self.has_risen {
                let note = risen(simulation, index, now);
                self.has_risen = note.is_some();
                notes.extend(note);
            }
            if let Some((end, tension)) = watched.breaks_at.take() {
                notes.extend(breaks_at_once(simulation, index, end, tension));
            }
            if watched.strain_max.is_finite() && exceeds_strain(simulation, index, watched.strain_max) {
                let strain = strain(simulation, index);
                notes.push(strained(simulation, index, strain, watched.strain_max));
                watched.strain_max = f64::INFINITY;
            }
        }
        if !self.has_noted_inputs
            && let Some(text) = simulation.input_warning()
        {
            self.has_noted_inputs = true;
            notes.push(Note::new("solver.input_error", text));
        }
        self.tables.look(simulation, &mut notes);
        notes
    }
}

/// Notes on points that are not free and lie below a seabed that is not level.
fn buried(simulation: &Simulation) -> Vec<Note> {
    let (model, points) = (&simulation.model, &simulation.snapshot.state.points);
    let Some(seabed) = model.seabed.as_ref().filter(|seabed| !seabed.level) else {
        return Vec::new();
    };
    let held = (0..points.len()).filter(|&point| model.points[point].free().is_none());
    let note = |point: usize| {
        let place = points[point].position;
        let height = seabed.ground.height(place.x, place.y);
        let text = format!(
            "{:.3} m below the seabed, which is at z = {height:.3} m there: nodes next to it are pushed up",
            height - place.z
        );
        (height - place.z > BURIED).then(|| Note::new(format!("points[{point}].position"), text))
    };
    held.filter_map(note).collect()
}

/// Notes on lines that lie deep in a seabed that is not level: sunk into its softened springs over a ridge, or cutting through one between nodes.
fn sunk(simulation: &Simulation) -> Vec<Note> {
    let (model, lines) = (&simulation.model, &simulation.snapshot.state.lines);
    let Some(seabed) = model.seabed.as_ref().filter(|seabed| !seabed.level) else {
        return Vec::new();
    };
    let depth = |place: Vector3<f64>| seabed.ground.height(place.x, place.y) - place.z;
    let deepest = |line: usize| {
        let (lengths, nodes) = (&model.lines[line].segments.length, &lines[line].position);
        let segments = lengths.iter().zip(nodes.windows(2));
        let within = segments.flat_map(|(length, ends)| {
            WITHIN.map(|part| (depth(ends[0] + part * (ends[1] - ends[0])), *length))
        });
        within.max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))
    };
    let note = |line: usize| {
        model.lines[line].nodes.contact.as_ref()?;
        let (depth, length) = deepest(line).filter(|(depth, length)| *depth > SUNK * length)?;
        let text = format!(
            "{depth:.3} m inside the seabed at the start, with elements of {length:.2} m: they cut straight through a ridge or lie on softened \
             springs; more elements are more accurate"
        );
        Some(Note::new(format!("lines[{line}]"), text))
    };
    (0..lines.len()).filter_map(note).collect()
}

/// Positions of the points at the ends of a line [m].
fn ends(simulation: &Simulation, line: usize) -> [Vector3<f64>; 2] {
    let points = &simulation.snapshot.state.points;
    simulation.model.lines[line]
        .ends
        .map(|point| points[point].position)
}

/// Note on an end that a host or a given path moved by a large part of the line in one step.
fn jump(
    simulation: &Simulation,
    line: usize,
    before: [Vector3<f64>; 2],
    now: [Vector3<f64>; 2],
) -> Option<Note> {
    let (model, data) = (&simulation.model, &simulation.model.lines[line]);
    let length = data.unstretched_length();
    let moved = |end: usize| (now[end] - before[end]).norm();
    let prescribed = |end: &usize| model.points[data.ends[*end]].free().is_none();
    let mut jumps = [0, 1].into_iter().filter(prescribed);
    let end = jumps.find(|end| moved(*end) > JUMP * length)?;
    let text = format!(
        "at {}, {} has moved by {:.3} m in one communication step, more than a tenth of {} ({} long): paths without jumps, or shorter \
         steps, are usual; reported once",
        instant(simulation.time()),
        model.points[data.ends[end]].name,
        moved(end),
        data.name,
        metres(length)
    );
    Some(Note::new(format!("lines[{line}]"), text))
}

/// Note on an end that is above the water.
fn risen(simulation: &Simulation, line: usize, now: [Vector3<f64>; 2]) -> Option<Note> {
    let (model, data) = (&simulation.model, &simulation.model.lines[line]);
    let end = (0..2).find(|end| now[*end].z > 0.0)?;
    let text = format!(
        "at {}, {} is at z = {:.3} m, but {} is modelled as submerged there too: `surface = true` in [water] models the free surface, except \
         for beams; reported once",
        instant(simulation.time()),
        model.points[data.ends[end]].name,
        now[end].z,
        data.name
    );
    Some(Note::new("water.surface", text))
}

/// End that breaks off its point, and the tension at which it breaks [N]; `None` if no tension breaks an end.
fn breaking_tension(releases: [Release; 2]) -> Option<(End, f64)> {
    let ends = [End::A, End::B].into_iter().zip(releases);
    ends.filter_map(|(end, release)| Some((end, release.tension?)))
        .next()
}

/// Note on a line whose tension exceeds its breaking limit at the start.
fn breaks_at_once(simulation: &Simulation, line: usize, end: End, limit: f64) -> Option<Note> {
    let data = &simulation.model.lines[line];
    let node = match end {
        End::A => 0,
        End::B => data.segment_count(),
    };
    let tension = simulation.segment_tension(line, node);
    let text = format!(
        "{} breaks in its first step: its initial tension there is {tension:.0} N, and it breaks at {limit:.0} N",
        data.name
    );
    (tension >= limit).then(|| Note::new(format!("lines[{line}].break.tension"), text))
}

/// Squared stretched length [m²] and unstretched length [m] of a line's segments, except the segment that a winch changes.
fn lengths(simulation: &Simulation, line: usize) -> impl Iterator<Item = (f64, f64)> {
    let data = &simulation.model.lines[line];
    let nodes = &simulation.snapshot.state.lines[line].position;
    let lengths = &data.segments.length;
    let count = lengths.len() - usize::from(data.winch.is_some());
    let pairs = nodes.windows(2).zip(lengths).take(count);
    pairs.map(|(pair, length)| ((pair[1] - pair[0]).norm_squared(), *length))
}

/// Returns whether any segment of a line is strained beyond a limit [-].
fn exceeds_strain(simulation: &Simulation, line: usize, limit: f64) -> bool {
    lengths(simulation, line).any(|(square, length)| is_beyond(limit, square, length))
}

/// Returns whether a segment of a squared stretched length [m²] and an unstretched length [m] is strained beyond a limit [-]. Avoids square roots,
/// since all segments are compared at every communication point.
fn is_beyond(limit: f64, square: f64, length: f64) -> bool {
    square > ((1.0 + limit) * length).powi(2)
}

/// Greatest strain of a line's segments [-].
fn strain(simulation: &Simulation, line: usize) -> f64 {
    lengths(simulation, line)
        .map(|(square, length)| square.sqrt() / length - 1.0)
        .fold(0.0, f64::max)
}

fn strained(simulation: &Simulation, line: usize, strain: f64, limit: f64) -> Note {
    let text = format!(
        "at {}, {} is strained by {:.1} %: less than {:.0} % is usual, with EA in N and lengths in m; reported once",
        instant(simulation.time()),
        simulation.model.lines[line].name,
        100.0 * strain,
        100.0 * limit
    );
    Note::new(format!("lines[{line}]"), text)
}
