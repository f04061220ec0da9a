//! Tables over strain, height and place that a simulation leaves: tension-strain curves, current profiles, soundings.
//!
//! Looked at where results are written, not within steps. Tables in time are known beforehand: [`Scene::notes`].

use std::collections::BTreeSet;

use nalgebra::Vector3;

use crate::scene::{Note, Scene};
use crate::simulation::Simulation;

/// Part of the height of a current profile by which a line may leave it unnoticed, as a line does that lies on the seabed [-].
const HEIGHT_MARGIN: f64 = 0.01;

/// Watches the tables of a scene.
#[derive(Debug)]
pub struct LeftTables<'s> {
    scene: &'s Scene,
    /// Whether there are any.
    any: bool,
    /// Key paths of those that have been left.
    left: BTreeSet<String>,
}

impl<'s> LeftTables<'s> {
    /// Of a scene, none of them left as yet.
    pub fn new(scene: &'s Scene) -> LeftTables<'s> {
        let stretch = scene.line_types.values();
        let stretch = stretch.filter_map(|kind| kind.tension_strain.as_ref());
        let grid = scene.seabed.as_ref().and_then(|bed| bed.grid.as_ref());
        LeftTables {
            scene,
            any: stretch.count() > 0 || heights(scene).is_some() || grid.is_some(),
            left: BTreeSet::new(),
        }
    }

    /// Remarks on the tables that are left at a time [s] and were not before.
    pub fn look(&mut self, simulation: &Simulation, time: f64) -> Vec<Note> {
        if !self.any {
            return Vec::new();
        }
        let mut notes = Vec::new();
        for line in 0..simulation.model().lines.len() {
            self.look_at_strain(simulation, line, time, &mut notes);
            self.look_at_current(simulation, line, time, &mut notes);
            self.look_at_soundings(simulation, line, time, &mut notes);
        }
        notes
    }

    fn say(&mut self, at: String, text: String, notes: &mut Vec<Note>) {
        if self.left.insert(at.clone()) {
            notes.push(Note::new(at, text));
        }
    }

    fn look_at_strain(
        &mut self,
        simulation: &Simulation,
        line: usize,
        time: f64,
        notes: &mut Vec<Note>,
    ) {
        let scene = self.scene;
        let (of, nodes) = (
            &simulation.model().lines[line],
            &simulation.state().lines[line].position,
        );
        let sections = &scene.lines[line].sections;
        let mut ends = sections.iter().scan(0.0, |arc, section| {
            *arc += section.length;
            Some((*arc, &section.line_type))
        });
        let mut section = ends.next();
        for (k, (pair, length)) in nodes.windows(2).zip(&of.segments.length).enumerate() {
            while section.is_some_and(|(end, _)| of.nodes.arc[k] + 0.5 * length > end) {
                section = ends
                    .next()
                    .or(sections.last().map(|s| (f64::INFINITY, &s.line_type)));
            }
            let Some((_, name)) = section else { continue };
            let table = scene.line_types[name].tension_strain.as_ref();
            let Some([last, _]) = table.and_then(|table| table.rows.last()) else {
                continue;
            };
            let strain = (pair[1] - pair[0]).norm() / length - 1.0;
            if strain > *last {
                let text = format!(
                    "{} is strained by {strain:.4} at t = {time} s, beyond the last row at {last}: tension goes on with its last slope there, where \
                     MoorDyn stays at the last tension",
                    of.name
                );
                self.say(format!("line_types.{name}.tension_strain"), text, notes);
            }
        }
    }

    fn look_at_current(
        &mut self,
        simulation: &Simulation,
        line: usize,
        time: f64,
        notes: &mut Vec<Note>,
    ) {
        let Some([low, high]) = heights(self.scene) else {
            return;
        };
        let margin = HEIGHT_MARGIN * (high - low);
        let heights = simulation.state().lines[line].position.iter().map(|r| r.z);
        let mut beyond = heights.filter(|z| {
            let above = *z > high + margin && *z < 0.0; // there is no water further up
            *z < low - margin || above
        });
        if let Some(z) = beyond.next() {
            let (side, row) = match z < low {
                true => ("below the lowest", low),
                false => ("above the highest", high),
            };
            let name = &simulation.model().lines[line].name;
            let text = format!(
                "{name} is at z = {z:.2} m at t = {time} s, {side} row at {row} m: the current is that of this row there"
            );
            self.say("water.current.profile".to_string(), text, notes);
        }
    }

    fn look_at_soundings(
        &mut self,
        simulation: &Simulation,
        line: usize,
        time: f64,
        notes: &mut Vec<Note>,
    ) {
        let bed = self.scene.seabed.as_ref();
        let Some(grid) = bed.and_then(|bed| bed.grid.as_ref()) else {
            return;
        };
        let of = &simulation.model().lines[line];
        let Some(contact) = &of.nodes.contact else {
            return;
        };
        let Some(bottom) = &contact.bottom else {
            return;
        };
        let outside =
            |line: &[f64], at: f64| line.len() > 1 && (at < line[0] || at > line[line.len() - 1]);
        let lies = |node: usize, r: Vector3<f64>| {
            let lift = contact.lift(node);
            (outside(&grid.x, r.x) || outside(&grid.y, r.y))
                && bottom.touch(r, lift).penetration > 0.0
        };
        let nodes = simulation.state().lines[line].position.iter().enumerate();
        let found = nodes.into_iter().find(|(node, r)| lies(*node, **r));
        if let Some((_, r)) = found {
            let text = format!(
                "{} lies at ({:.2}, {:.2}) m at t = {time} s, outside the soundings: the seabed goes on as at their edge there",
                of.name, r.x, r.y
            );
            self.say("seabed.grid".to_string(), text, notes);
        }
    }
}

/// Lowest and highest row of a current that changes with height [m].
fn heights(scene: &Scene) -> Option<[f64; 2]> {
    let current = scene.water.as_ref()?.current.as_ref()?;
    let rows = current.profile.as_ref().filter(|rows| rows.len() > 1)?;
    let heights = rows.iter().map(|row| row[0]);
    let low = heights.clone().fold(f64::INFINITY, f64::min);
    Some([low, heights.fold(f64::NEG_INFINITY, f64::max)])
}
