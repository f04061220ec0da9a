//! Title, gravity, water, seabed.

use super::seabed::check_bed;
use super::time::{Load, check_load_in_time};
use super::{Bounds, Findings, quantity};
use crate::scene::{Current, Integrator, LineModel, Scene};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    if scene.title.chars().any(char::is_control) {
        findings.say(
            "title",
            "the title holds a line break or another control character: write one line",
        );
    }
    if scene.gravity < 0.0 {
        let problem = format!(
            "{} is negative: gravity is a magnitude, downwards along z",
            quantity(scene.gravity, "m/s²")
        );
        findings.say("gravity", problem);
    } else {
        let gravity = Bounds::NotNegative(1e3);
        findings.number("gravity", scene.gravity, gravity, "m/s²");
    }
    if let Some(water) = &scene.water {
        findings.number("water.density", water.density, Bounds::Positive(1e5), "kg/m³");
        if let Some(current) = &water.current {
            check_current(scene, current, findings);
        }
        if let Some(waves) = &water.waves {
            super::waves::check(scene, waves, findings);
        }
    }
    if let Some(seabed) = &scene.seabed {
        if seabed.depth < 0.0 {
            let problem = format!(
                "{} is negative: the depth counts downwards from z = 0",
                quantity(seabed.depth, "m")
            );
            findings.say("seabed.depth", problem);
        } else {
            findings.number("seabed.depth", seabed.depth, Bounds::NotNegative(1e5), "m");
        }
        let stiff = Bounds::Positive(1e12);
        findings.number("seabed.stiffness", seabed.stiffness, stiff, "Pa/m");
        let damping = Bounds::NotNegative(1e12);
        findings.number("seabed.damping", seabed.damping, damping, "Pa s/m");
        check_bed(scene, seabed, findings);
    }
}

/// Fastest water [m/s]; the strongest tidal streams reach 10 m/s.
const SPEED: Bounds = Bounds::Magnitude(100.0);

fn check_current(scene: &Scene, current: &Current, findings: &mut Findings) {
    let at = "water.current";
    if current.file.is_some() {
        let problem = "a scene that comes as text cannot read files: write the rows as `profile`";
        return findings.say(format!("{at}.file"), problem);
    }
    match (&current.velocity, &current.profile) {
        (None, None) => findings.say(
            at,
            "a current needs `velocity = [vx, vy, vz]` [m/s], or `profile = [[z, vx, vy], …]` [m, m/s]",
        ),
        (Some(_), Some(_)) => {
            findings.say(
                at,
                "`velocity` and `profile` cannot both be given: the profile says all",
            );
        }
        (Some(velocity), None) => {
            for (axis, value) in velocity.iter().enumerate() {
                findings.number(format!("{at}.velocity[{axis}]"), *value, SPEED, "m/s");
            }
        }
        (None, Some(rows)) => check_profile(rows, findings),
    }
    if let Some(factor) = &current.factor {
        check_load_in_time(findings, &format!("{at}.factor"), factor, Load::FACTOR);
    }
    let all_beams = scene.solver.integrator == Integrator::Beam;
    for (name, line_type) in &scene.line_types {
        let drags = line_type.drag_normal.is_some() || line_type.drag_tangential.is_some();
        if (all_beams || line_type.model == LineModel::Beam) && drags {
            let problem = format!(
                "line type {name:?} is a beam, and beams are modelled in still water only: use the cable model, whose lines may bend \
                 too, or leave out the current or the drag coefficients"
            );
            return findings.say(at, problem);
        }
    }
}

fn check_profile(rows: &[[f64; 3]], findings: &mut Findings) {
    let at = "water.current.profile";
    if rows.is_empty() {
        findings.say(at, "the profile has no rows: write [[z, vx, vy], …]");
    }
    for (i, [z, vx, vy]) in rows.iter().enumerate() {
        let right = findings.number(format!("{at}[{i}][0]"), *z, Bounds::Magnitude(1e5), "m");
        findings.number(format!("{at}[{i}][1]"), *vx, SPEED, "m/s");
        findings.number(format!("{at}[{i}][2]"), *vy, SPEED, "m/s");
        if let Some(twin) = rows[..i].iter().position(|row| row[0] == *z)
            && right
        {
            let problem = format!(
                "row {twin} is at {} too: every height has one velocity; put the heights of a jump 1 mm apart",
                quantity(*z, "m")
            );
            findings.say(format!("{at}[{i}][0]"), problem);
        }
    }
}
