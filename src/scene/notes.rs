//! What is no mistake but may surprise.

use std::f64::consts::PI;
use std::fmt;

use nalgebra::Vector3;

use super::check::{number, quantity};
use super::path::quoted;
use super::table_ends;
use super::{Integrator, Line, LineModel, LineType, Point, PointKind, Scene, Waves};
use crate::math::attitude::Order;

/// A remark on a scene that can be used as it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// Key path of what it is about.
    pub at: String,
    /// The remark.
    pub text: String,
    /// Line of the file [-], from 1, where the key has one.
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

/// Part of critical that the suggested axial damping damps the first axial mode of a line by [-].
const FIRST_MODE_RATIO: f64 = 0.01;

impl Scene {
    /// Says what is no mistake but may surprise; [`Scene::plausibility`] first.
    pub fn notes(&self) -> Vec<Note> {
        let mut notes = self.plausibility();
        for (name, line_type) in &self.line_types {
            note_line_type(self, name, line_type, &mut notes);
        }
        note_points(self, &mut notes);
        if let Some(waves) = self.water.as_ref().and_then(|water| water.waves.as_ref()) {
            note_waves(self, waves, &mut notes);
        }
        note_whole(self, &mut notes);
        notes.extend(self.idle());
        notes.extend(table_ends::notes(self));
        notes
    }

    /// Suggestions for keys that are left open, and keys that cannot be left out and change nothing, which only `moorline check` says.
    pub fn advice(&self) -> Vec<Note> {
        let mut notes = self.idle_by_need();
        if self.solver.integrator == Integrator::QuasiStatic {
            return notes;
        }
        for (name, line_type) in &self.line_types {
            let at = format!("line_types.{}", quoted(name));
            let longest = self.longest_of(name);
            if !line_type.leaves_damping_open() || longest == 0.0 {
                continue;
            }
            let text = match line_type.model {
                LineModel::Beam => "no damping within the line: waves along it ring on".to_string(),
                LineModel::Cable => {
                    let open = "no `axial_damping`: moorline's own fades as meshes get finer, so that waves along the line ring on and converge slowly";
                    match self.damping_of_first_mode(line_type, longest) {
                        Some(damping) => format!(
                            "{open}; `axial_damping = {damping:.1e}` [N s] would damp the first axial mode of {} by {} %",
                            quantity(longest, "m"),
                            number(100.0 * FIRST_MODE_RATIO)
                        ),
                        None => open.to_string(),
                    }
                }
            };
            say(&mut notes, at, text);
        }
        notes
    }

    /// Length of the longest line with a section of a line type [m]; 0 where there is none.
    fn longest_of(&self, name: &str) -> f64 {
        let has = |line: &&Line| line.sections.iter().any(|section| section.line_type == name);
        self.lines.iter().filter(has).map(length).fold(0.0, f64::max)
    }

    /// Damping BA [N s] that is [`FIRST_MODE_RATIO`] of critical in the first axial mode of a line of a length [m]: a quarter of a wave
    /// along it, ω = ½π√(EA/m)/L, BA = 2ζ·EA/ω.
    fn damping_of_first_mode(&self, line_type: &LineType, length: f64) -> Option<f64> {
        let (ea, mass) = (line_type.axial_stiffness?, self.mass(line_type));
        let damping = 4.0 * FIRST_MODE_RATIO / PI * length * (ea * mass).sqrt();
        (damping > 0.0 && damping.is_finite()).then_some(damping)
    }
}

fn say(notes: &mut Vec<Note>, at: impl Into<String>, text: impl Into<String>) {
    notes.push(Note::new(at, text));
}

fn note_line_type(scene: &Scene, name: &str, line_type: &LineType, notes: &mut Vec<Note>) {
    let at = format!("line_types.{}", quoted(name));
    let mut sections = scene.lines.iter().flat_map(|line| &line.sections);
    if sections.all(|section| section.line_type != name) {
        return say(notes, at, "no line uses this line type");
    }
    if scene.water.is_some() && line_type.drag_normal.is_none() {
        let flows = scene.water.as_ref().is_some_and(|w| w.current.is_some());
        let waves = scene.water.as_ref().is_some_and(|w| w.waves.is_some());
        let text = if waves {
            "no `drag_normal`: the waves drag no line across itself, and the water does not damp it"
        } else if flows {
            "no `drag_normal`: the current does not push the line across itself, and the water does not damp it"
        } else {
            "no `drag_normal`: the water does not damp the line's motion across itself"
        };
        say(notes, at.clone(), text);
    }
    if scene.seabed.is_some() && scene.weight(line_type) < 0.0 {
        let text = "lighter than the water: it floats up from the seabed";
        say(notes, at, text);
    }
}

/// Where a point is in the reference configuration, global axes [m]; `None` on a vessel that there is not.
pub(super) fn reference_position(scene: &Scene, point: &Point) -> Option<[f64; 3]> {
    let Some(carrier) = &point.on else {
        return Some(point.position);
    };
    let vessel = scene.vessels.iter().find(|vessel| vessel.name == *carrier)?;
    let turn = Order::Zyx.rotation(vessel.attitude.into());
    Some((Vector3::from(vessel.position) + turn * Vector3::from(point.position)).into())
}

/// Distance between the ends of a line [m], where both are known.
pub(super) fn chord(scene: &Scene, line: &Line) -> Option<f64> {
    let position = |name: &str| {
        let point = scene.points.iter().find(|point| point.name == name)?;
        reference_position(scene, point)
    };
    let (a, b) = (position(&line.from)?, position(&line.to)?);
    Some((0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt())
}

/// Unstretched length of a line [m].
pub(super) fn length(line: &Line) -> f64 {
    line.sections.iter().map(|section| section.length).sum()
}

/// Depth under a seabed that is no level plane from which a point is told of [m].
const BURIED: f64 = 0.01;

fn note_points(scene: &Scene, notes: &mut Vec<Note>) {
    for (i, point) in scene.points.iter().enumerate() {
        let at = format!("points[{i}]");
        let mut lines = scene.lines.iter();
        if lines.all(|line| line.from != point.name && line.to != point.name) {
            say(notes, at.clone(), "no line ends at this point");
        }
        let above = reference_position(scene, point).is_some_and(|place| place[2] > 0.0);
        let mut lines = scene.lines.iter();
        let blind = lines
            .any(|line| (line.from == point.name || line.to == point.name) && !scene.meets_surface(line));
        if scene.water.is_some() && above && blind {
            let text = "above z = 0, but the water is taken to fill all space for its lines, so that they are submerged there too";
            say(notes, format!("{at}.position"), text);
        }
        let lifted = reference_position(scene, point).map_or(0.0, |place| place[2]);
        let lifted = lifted + scene.rise(point);
        let open = scene.water.as_ref().is_some_and(|w| w.surface.is_none());
        if open && !above && lifted > 0.0 && blind {
            let end = match scene.all_beams() {
                true => "",
                false => "; `surface = true` in [water] ends it at z = 0",
            };
            let text = format!(
                "the scene's motion takes it to z = {lifted:.3} m, but the water is taken to fill all space for its lines, so that they are submerged \
                 there too{end}"
            );
            say(notes, at.clone(), text);
        }
        let bed = scene.seabed.as_ref().filter(|bed| !bed.is_level());
        if let (Some(bed), Some([x, y, z])) = (bed, reference_position(scene, point))
            && z < bed.lowest_at([x, y]) - BURIED
        {
            let text = format!(
                "lies {} m below the seabed there: nodes beside it are pushed up",
                number(bed.lowest_at([x, y]) - z)
            );
            say(notes, format!("{at}.position"), text);
        }
        if point.force.is_some() && point.kind != PointKind::Free {
            let text = "a force on a point that the forces do not move only changes what holds it";
            say(notes, format!("{at}.force"), text);
        }
    }
}

fn note_waves(scene: &Scene, waves: &Waves, notes: &mut Vec<Note>) {
    let at = "water.waves";
    if waves.ramp().is_none() {
        let text = "no `ramp`: lines at rest are in the full sea from the start, and swing in";
        say(notes, at, text);
    }
    let bare = |line_type: &LineType| line_type.diameter.is_none();
    for (name, _) in scene.line_types.iter().filter(|(_, kind)| bare(kind)) {
        let at = format!("line_types.{}", quoted(name));
        say(notes, at, "no `diameter`: the waves do nothing to it");
    }
    if let Some(ramp) = waves.ramp().filter(|ramp| *ramp > scene.output.duration) {
        let text = format!("the ramp of {} is longer than the run", quantity(ramp, "s"));
        say(notes, at, text);
    }
}

fn note_whole(scene: &Scene, notes: &mut Vec<Note>) {
    if scene.gravity == 0.0 {
        say(notes, "gravity", "0: lines and points are weightless");
    }
    let beams = || {
        scene
            .line_types
            .values()
            .any(|kind| kind.model == LineModel::Beam)
    };
    if let Some(seabed) = &scene.seabed
        && seabed.friction.acts()
        && beams()
    {
        let text = "beams lie on the seabed without friction: for them `friction` changes nothing";
        say(notes, "seabed.friction", text);
    }
    let output = &scene.output;
    let steps = output.duration / output.interval;
    if (steps - steps.round()).abs() > 1e-6 * steps {
        let text = format!(
            "the duration of {} s is not a whole number of intervals: the last one is shorter",
            number(output.duration)
        );
        say(notes, "output.interval", text);
    }
}
