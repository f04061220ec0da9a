//! Friction and shape of the seabed.

use super::{Bounds, Findings, quantity};
use crate::scene::{DepthGrid, LineModel, Scene, Seabed};

/// Steepest bed [-]: 63 degrees.
const SLOPE_MAX: f64 = 2.0;
/// Most soundings.
const SOUNDINGS_MAX: usize = 4_000_000;

pub(super) fn check_bed(scene: &Scene, bed: &Seabed, findings: &mut Findings) {
    let friction = Bounds::NotNegative(10.0);
    let (axial, transverse) = (bed.friction.axial, bed.friction.transverse);
    if axial == transverse || axial.is_nan() && transverse.is_nan() {
        findings.number("seabed.friction", axial, friction, "-");
    } else {
        findings.number("seabed.friction.axial", axial, friction, "-");
        findings.number("seabed.friction.transverse", transverse, friction, "-");
    }
    let shapes = [
        ("slope", bed.slope.is_some()),
        ("grid", bed.grid.is_some()),
        ("file", bed.file.is_some()),
    ];
    let given: Vec<&str> = shapes
        .iter()
        .filter(|(_, given)| *given)
        .map(|(key, _)| *key)
        .collect();
    if let [first, second, ..] = given[..] {
        let problem = format!("`{first}` and `{second}` cannot both be given: the bed has one shape");
        return findings.say("seabed", problem);
    }
    if bed.file.is_some() {
        let problem = "the soundings of a file must be written out here: give them as `grid`";
        findings.say("seabed.file", problem);
    }
    for (axis, slope) in bed.slope.iter().flatten().enumerate() {
        let at = format!("seabed.slope[{axis}]");
        if slope.is_finite() && slope.abs() > SLOPE_MAX {
            let problem = format!(
                "{} is steeper than any bed: the slope is dz/dx and dz/dy, 0.1 rises by 1 m in 10 m",
                quantity(*slope, "-")
            );
            findings.say(at, problem);
        } else {
            findings.number(at, *slope, Bounds::Magnitude(SLOPE_MAX), "-");
        }
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
            let right = findings.number(format!("{at}.{key}[{i}]"), *place, Bounds::Magnitude(1e7), "m");
            if let Some(before) = i.checked_sub(1).map(|i| line[i])
                && right
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
        for (i, depth) in row.iter().enumerate() {
            let bounds = Bounds::Magnitude(1e5);
            if !findings.number(format!("{at}.depth[{j}][{i}]"), *depth, bounds, "m") {
                return; // a grid of nothing but these would be told number by number
            }
        }
    }
}
