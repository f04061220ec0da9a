//! Lines that can reach the seabed; the others are built without contact.
//!
//! A line reaches below its lowest end that is not at a free point, by its length, stretched by half. A line between free
//! points reaches below the lowest such end of all lines connected to it, by the total length of these lines. Vessels
//! are assumed to keep their height. Other points that a host or a path moves, and lines that may be released, can
//! reach any place.

use crate::scene::{Line, Names, Point, PointKind, Scene};

/// Ratio of stretched to unstretched length that is assumed for the reach of a line [-].
const STRETCH_MAX: f64 = 1.5;

/// Returns whether a line could ever touch the seabed.
pub(super) fn may_touch_seabed(scene: &Scene, names: &Names, line: &Line) -> bool {
    let Some(seabed) = &scene.seabed else {
        return false;
    };
    let tied = tied(scene, names, line);
    let own = held_heights(names, &[line]);
    let (held, length) = match own.is_empty() {
        false => (own, length_max(line)),
        true => {
            let length = tied.iter().map(|line| length_max(line)).sum();
            (held_heights(names, &tied), length)
        }
    };
    let lowest = held.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let moves = held_heights(names, &tied).contains(&None);
    let parts = |line: &&Line| line.release.is_some() || line.failure.is_some();
    let reaches = held.is_empty() || lowest - STRETCH_MAX * length <= -seabed.depth;
    !seabed.is_level() || moves || reaches || tied.iter().any(parts)
}

/// Minimum heights [m] of the points at the ends of lines that are not free; `None` for a point that may reach any place.
fn held_heights(names: &Names, lines: &[&Line]) -> Vec<Option<f64>> {
    let ends = lines.iter().flat_map(|line| [&line.from, &line.to]);
    let points = ends.filter_map(|name| names.point(name));
    let held = points.filter(|point| point.kind != PointKind::Free);
    held.map(|point| height(names, point)).collect()
}

/// Minimum height [m] of a point that is fixed, or carried by a vessel, which keeps its height; `None` for a point that may
/// reach any place.
fn height(names: &Names, point: &Point) -> Option<f64> {
    let [x, y, z] = point.position;
    match (&point.kind, &point.on) {
        (PointKind::Fixed, _) => Some(z),
        (_, Some(name)) => {
            let vessel = names.vessel(name)?;
            Some(vessel.position[2] - x.hypot(y).hypot(z))
        }
        _ => None,
    }
}

/// Lines connected to a line by free points, itself included.
fn tied<'a>(scene: &'a Scene, names: &Names, line: &'a Line) -> Vec<&'a Line> {
    let is_free = |name: &str| {
        let point = names.point(name);
        point.is_some_and(|point| point.kind == PointKind::Free)
    };
    let mut tied = vec![line];
    let mut next = 0;
    while let Some(&line) = tied.get(next) {
        for shared in [&line.from, &line.to].into_iter().filter(|name| is_free(name)) {
            for other in &scene.lines {
                let meets = other.from == *shared || other.to == *shared;
                if meets && tied.iter().all(|line| line.name != other.name) {
                    tied.push(other);
                }
            }
        }
        next += 1;
    }
    tied
}

/// Maximum unstretched length of a line [m].
fn length_max(line: &Line) -> f64 {
    let sections: f64 = line.sections.iter().map(|section| section.length).sum();
    sections + line.winch.as_ref().map_or(0.0, |winch| winch.length_max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::{Draft, draft};

    const DEPTH: f64 = 100.0;

    /// A line of 20 m from a fixed point at z = −10 m, with more of the scene.
    fn hung([kind, end]: [&str; 2], line: &str, more: &str) -> Draft {
        draft(format!(
            "seabed = {{ depth = {DEPTH:?} }}
            line_types.rope = {{ mass = 5.0, diameter = 0.05, axial_stiffness = 1e6 }}
            {more}"
        ))
        .fixed("top", [0.0, 0.0, -10.0])
        .point(kind, "end", [5.0, 0.0, -15.0])
        .with(end)
        .line("line", ["top", "end"], "rope", 20.0, None)
        .with(line)
    }

    fn touches(scene: &Scene) -> bool {
        may_touch_seabed(scene, &Names::of(scene), &scene.lines[0])
    }

    const FIXED: [&str; 2] = ["fixed", ""];

    #[test]
    fn a_line_far_above_the_seabed_is_made_without_it() {
        assert!(!touches(&hung(FIXED, "", "").scene()));
        assert!(!touches(&hung(["free", ""], "", "").scene()));
        let vessel = "vessels = [{ name = 'barge', position = [0.0, 0.0, -5.0] }]";
        assert!(!touches(&hung(["coupled", "on = 'barge'"], "", vessel).scene()));
    }

    #[test]
    fn what_can_move_or_come_loose_may_touch_the_seabed() {
        assert!(touches(&hung(["coupled", ""], "", "").scene()));
        assert!(touches(&hung(FIXED, "release = 'b'", "").scene()));
        assert!(touches(
            &hung(FIXED, "break = { at = 'b', time = 1.0 }", "").scene()
        ));
    }

    #[test]
    fn a_line_reaches_as_far_as_those_it_hangs_together_with_and_what_a_winch_pays_out() {
        let joined = hung(["free", ""], "", "").free("low", [5.0, 0.0, -20.0]);
        let scene = joined.line("other", ["end", "low"], "rope", 50.0, None).scene();
        assert!(!touches(&scene) && may_touch_seabed(&scene, &Names::of(&scene), &scene.lines[1]));
        let winch = "winch = { end = 'b', length_max = 60.0 }";
        assert!(touches(&hung(FIXED, winch, "").scene()));
    }
}
