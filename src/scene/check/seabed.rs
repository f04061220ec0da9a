//! Friction and shape of the seabed.

use super::{Findings, quantity};
use crate::scene::{DepthGrid, LineModel, Scene, Seabed};

/// Most soundings.
const SOUNDINGS_MAX: usize = 4_000_000;

pub(super) fn check_bed(scene: &Scene, bed: &Seabed, findings: &mut Findings) {
    if bed.file.is_some() && bed.slope.is_none() && bed.grid.is_none() {
        let problem = "the soundings of a file must be written out here: give them as `grid`";
        findings.say("seabed.file", problem);
    }
    if let Some(grid) = &bed.grid {
        check_grid(grid, findings);
    }
    let beams = scene
        .line_types
        .iter()
        .find(|(_, kind)| kind.model == LineModel::Beam);
    if let (Some((name, _)), false) = (beams, bed.is_level()) {
        let problem = format!(
            "line type {name:?} is a beam, and beams are modelled over a level bed only: use the cable model, whose lines may bend too, \
             or a level bed"
        );
        findings.say("seabed", problem);
    }
}

fn check_grid(grid: &DepthGrid, findings: &mut Findings) {
    let at = "seabed.grid";
    for (key, line) in [("x", &grid.x), ("y", &grid.y)] {
        if line.is_empty() {
            findings.say(
                format!("{at}.{key}"),
                format!("the grid has no {key}: write [{key}1, {key}2, …] [m]"),
            );
        }
        for (i, place) in line.iter().enumerate() {
            if let Some(before) = i.checked_sub(1).map(|i| line[i])
                && *place <= before
            {
                let problem = format!(
                    "{key} = {} does not come after {}: the lines of the grid must increase",
                    quantity(*place, "m"),
                    quantity(before, "m")
                );
                return findings.say(format!("{at}.{key}[{i}]"), problem);
            }
        }
    }
    let (wide, high) = (grid.x.len(), grid.y.len());
    if wide * high > SOUNDINGS_MAX {
        let problem = format!("{wide} by {high} soundings: more than {SOUNDINGS_MAX}");
        return findings.say(at, problem);
    }
    if grid.depth.len() != high {
        let problem = format!(
            "{} rows of depths for {high} values of y: write one row for each",
            grid.depth.len()
        );
        return findings.say(format!("{at}.depth"), problem);
    }
    for (j, row) in grid.depth.iter().enumerate() {
        if row.len() != wide {
            let problem = format!("{} depths for {wide} values of x: write one for each", row.len());
            return findings.say(format!("{at}.depth[{j}]"), problem);
        }
    }
}
