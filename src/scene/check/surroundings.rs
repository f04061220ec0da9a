//! Title, water and seabed.

use super::seabed::check_seabed;
use super::{Bounds, Findings, quantity, rules};
use crate::scene::water::SPEED;
use crate::scene::{Current, LineType, Scene};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    rules! { findings, "";
        "title" if scene.title.chars().any(char::is_control) =>
            "the title holds a line break or another control character: write one line";
    }
    if let Some(current) = scene.current() {
        check_current(scene, current, findings);
    }
    if let Some(waves) = scene.waves() {
        super::waves::check(scene, waves, findings);
    }
    if scene.has_host_flow() {
        super::waves::check_flow(scene, findings);
    }
    if let Some(seabed) = &scene.seabed {
        check_seabed(scene, seabed, findings);
    }
}

fn check_current(scene: &Scene, current: &Current, findings: &mut Findings) {
    let at = "water.current";
    if current.file.is_some() {
        let problem = "a scene that comes as text cannot read files: write the rows as `profile`";
        return findings.say(format!("{at}.file"), problem);
    }
    let (velocity, profile) = (&current.velocity, &current.profile);
    rules! { findings, at;
        "" if velocity.is_none() && profile.is_none() =>
            "a current needs `velocity = [vx, vy, vz]` [m/s], or `profile = [[z, vx, vy], …]` [m, m/s]";
        "" if velocity.is_some() && profile.is_some() =>
            "`velocity` and `profile` cannot both be given: the profile covers all heights";
    }
    if let (None, Some(rows)) = (velocity, profile) {
        check_profile(rows, findings);
    }
    let drags = |line_type: &LineType| line_type.drag_normal.is_some() || line_type.drag_tangential.is_some();
    rules! { findings, at;
        "" given name = scene.type_of_beams(drags) =>
            "line type {name:?} is a beam, and beams are modelled in still water only: use the cable model, whose lines may bend \
             too, or leave out the current or the drag coefficients";
    }
}

fn check_profile(rows: &[[f64; 3]], findings: &mut Findings) {
    let at = "water.current.profile";
    rules! { findings, at;
        "" if rows.is_empty() => "the profile has no rows: write [[z, vx, vy], …]";
    }
    for (i, row) in rows.iter().enumerate() {
        let z = &row[0];
        let (height, speed) = (Bounds::Magnitude(1e5), (SPEED.bounds, "m/s"));
        findings.row(&format!("{at}[{i}]"), row, &[(height, "m"), speed, speed]);
        let twin = rows[..i].iter().position(|row| row[0] == *z);
        rules! { findings, at;
            "[{i}][0]" given twin = twin.filter(|_| height.accepts(*z)) =>
                "row {twin} is at {} too: every height has one velocity; put the heights of a jump 1 mm apart", quantity(*z, "m");
        }
    }
}
