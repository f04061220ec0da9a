//! Shape of the seabed: soundings, and a level seabed under beams.

use super::{Findings, quantity, rules};
use crate::scene::{DepthGrid, Scene, Seabed};

/// Maximum number of soundings.
const SOUNDINGS_MAX: usize = 4_000_000;

pub(super) fn check_seabed(scene: &Scene, seabed: &Seabed, findings: &mut Findings) {
    rules! { findings, "seabed";
        "file" if seabed.file.is_some() && seabed.slope.is_none() && seabed.grid.is_none() =>
            "the soundings of a file must be written out here: give them as `grid`";
    }
    if let Some(grid) = &seabed.grid {
        check_grid(grid, findings);
    }
    let beam = scene.type_of_beams(|_| true);
    rules! { findings, "seabed";
        "" given name = beam.filter(|_| !seabed.is_level()) =>
            "line type {name:?} is a beam, and beams are modelled over a level seabed only: use the cable model, whose lines may bend \
             too, or a level seabed";
    }
}

fn check_grid(grid: &DepthGrid, findings: &mut Findings) {
    let at = "seabed.grid";
    for (key, line) in [("x", &grid.x), ("y", &grid.y)] {
        rules! { findings, at;
            "{key}" if line.is_empty() => "the grid has no {key}: write [{key}1, {key}2, …] [m]";
        }
        if let Some(before) = line.windows(2).position(|pair| pair[1] <= pair[0]) {
            let [place, last] = [line[before + 1], line[before]].map(|place| quantity(place, "m"));
            let problem =
                format!("{key} = {place} does not come after {last}: the lines of the grid must increase");
            return findings.say(format!("{at}.{key}[{}]", before + 1), problem);
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
