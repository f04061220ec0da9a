//! Tables over strain, height and position whose range a simulation leaves: tension-strain curves, current profiles, soundings. Tables in time are
//! checked beforehand: [`crate::scene::Scene::notes`].

use std::collections::BTreeSet;

use nalgebra::Vector3;

use super::is_beyond;
use crate::scene::{Line, Note, Scene, Section, instant};
use crate::simulation::Simulation;

/// Fraction of the height of a current profile by which a line may leave the profile without a note, as a line on the seabed does [-].
const HEIGHT_MARGIN: f64 = 0.01;

/// The tables of a scene.
#[derive(Debug, Clone)]
pub(super) struct LeftTables {
    /// Sections of every line with tension-strain curves, by line.
    stretched: Vec<(usize, Vec<Stretched>)>,
    /// Heights of the lowest and highest row of the current profile [m].
    heights: Option<[f64; 2]>,
    /// Least and greatest x and y of the soundings [m].
    soundings: Option<[[f64; 2]; 2]>,
    /// Key paths of the tables that have been left.
    left: BTreeSet<String>,
}

/// A section of a line.
#[derive(Debug, Clone)]
struct Stretched {
    /// Arc length at the end of the section [m].
    end: f64,
    line_type: String,
    /// Strain of the last row [-]; infinite if there is no table, or after it was left.
    strain_max: f64,
}

impl LeftTables {
    /// Returns the tables of a scene, none of which has been left yet.
    pub(super) fn new(scene: &Scene) -> LeftTables {
        let lines = scene.lines.iter().enumerate();
        let stretched = lines.map(|(index, line)| (index, stretched(scene, line)));
        let finite = |section: &Stretched| section.strain_max.is_finite();
        let grid = scene.seabed.as_ref().and_then(|seabed| seabed.grid.as_ref());
        LeftTables {
            stretched: stretched
                .filter(|(_, sections)| sections.iter().any(finite))
                .collect(),
            heights: heights(scene),
            soundings: grid.map(|grid| [range(&grid.x), range(&grid.y)]),
            left: BTreeSet::new(),
        }
    }

    /// Adds notes on the tables that are left for the first time.
    pub(super) fn look(&mut self, simulation: &Simulation, notes: &mut Vec<Note>) {
        for (line, sections) in &mut self.stretched {
            look_at_strain(simulation, *line, sections, &mut self.left, notes);
        }
        let lines = 0..simulation.model.lines.len();
        if let Some(heights) = self.heights {
            let at = "water.current.profile";
            let mut lines = lines.clone().filter(|_| !self.left.contains(at));
            if let Some(text) = lines.find_map(|line| beyond_current(simulation, line, heights)) {
                say(&mut self.left, at.to_string(), text, notes);
            }
        }
        if let Some(soundings) = self.soundings {
            let at = "seabed.grid";
            let mut lines = lines.filter(|_| !self.left.contains(at));
            if let Some(text) = lines.find_map(|line| outside_soundings(simulation, line, soundings)) {
                say(&mut self.left, at.to_string(), text, notes);
            }
        }
    }
}

fn say(left: &mut BTreeSet<String>, at: String, text: String, notes: &mut Vec<Note>) {
    if left.insert(at.clone()) {
        notes.push(Note::new(at, text));
    }
}

fn stretched(scene: &Scene, line: &Line) -> Vec<Stretched> {
    let mut end = 0.0;
    let of_section = |section: &Section| {
        end += section.length;
        let kind = scene.line_types.get(&section.line_type);
        let table = kind.and_then(|kind| kind.tension_strain.as_ref());
        let last = table.and_then(|table| table.rows.last());
        Stretched {
            end,
            line_type: section.line_type.clone(),
            strain_max: last.map_or(f64::INFINITY, |[strain, _]| *strain),
        }
    };
    line.sections.iter().map(of_section).collect()
}

/// Adds notes on segments that are strained beyond their tables.
fn look_at_strain(
    simulation: &Simulation,
    line: usize,
    sections: &mut [Stretched],
    left: &mut BTreeSet<String>,
    notes: &mut Vec<Note>,
) {
    let (of, nodes) = (
        &simulation.model.lines[line],
        &simulation.snapshot.state.lines[line].position,
    );
    let last = sections.len() - 1;
    let limits = sections.iter().map(|section| section.strain_max);
    let least = limits.fold(f64::INFINITY, f64::min);
    let mut segments = nodes.windows(2).zip(&of.segments.length);
    if !segments.any(|(pair, length)| is_beyond(least, (pair[1] - pair[0]).norm_squared(), *length)) {
        return;
    }
    for (k, (pair, length)) in nodes.windows(2).zip(&of.segments.length).enumerate() {
        let middle = of.nodes.arc[k] + 0.5 * length;
        let number = sections.iter().position(|section| middle <= section.end);
        let section = &mut sections[number.unwrap_or(last)];
        let strain = (pair[1] - pair[0]).norm() / length - 1.0;
        if strain > section.strain_max {
            let text = format!(
                "{} is strained by {strain:.4} at {}, beyond the last row at {}: its tension continues with the last slope, where MoorDyn \
                 keeps the last tension",
                of.name,
                instant(simulation.time()),
                section.strain_max
            );
            let at = format!("line_types.{}.tension_strain", section.line_type);
            say(left, at, text, notes);
            section.strain_max = f64::INFINITY;
        }
    }
}

/// Note on a line above or below the rows of the current profile, given by its lowest and highest height [m].
fn beyond_current(simulation: &Simulation, line: usize, [low, high]: [f64; 2]) -> Option<String> {
    let margin = HEIGHT_MARGIN * (high - low);
    let heights = simulation.snapshot.state.lines[line].position.iter().map(|r| r.z);
    let mut beyond = heights.filter(|z| {
        let above = *z > high + margin && *z < 0.0; // no water above z = 0
        *z < low - margin || above
    });
    let z = beyond.next()?;
    let (side, row) = match z < low {
        true => ("below the lowest", low),
        false => ("above the highest", high),
    };
    Some(format!(
        "{} is at z = {z:.2} m at {}, {side} row at {row} m: the current is that of this row there",
        simulation.model.lines[line].name,
        instant(simulation.time())
    ))
}

/// Note on a line that lies on the seabed outside the soundings, whose least and greatest x and y [m] are given.
fn outside_soundings(simulation: &Simulation, line: usize, soundings: [[f64; 2]; 2]) -> Option<String> {
    let of = &simulation.model.lines[line];
    let contact = of.nodes.contact.as_ref()?;
    let outside = |[least, most]: [f64; 2], at: f64| least < most && !(least..=most).contains(&at);
    let lies = |node: usize, r: Vector3<f64>| {
        (outside(soundings[0], r.x) || outside(soundings[1], r.y)) && contact.stand(node, r).0 > 0.0
    };
    let nodes = &simulation.snapshot.state.lines[line].position;
    let (_, r) = nodes.iter().enumerate().find(|(node, r)| lies(*node, **r))?;
    Some(format!(
        "{} lies at ({:.2}, {:.2}) m at {}, outside the soundings: the seabed goes on as at their edge there",
        of.name,
        r.x,
        r.y,
        instant(simulation.time())
    ))
}

fn range(values: &[f64]) -> [f64; 2] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    [least, values.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
}

/// Heights of the lowest and highest row of a current that changes with height [m].
fn heights(scene: &Scene) -> Option<[f64; 2]> {
    let current = scene.water.as_ref()?.current.as_ref()?;
    let rows = current.profile.as_ref().filter(|rows| rows.len() > 1)?;
    let heights: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    Some(range(&heights))
}
