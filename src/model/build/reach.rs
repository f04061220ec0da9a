//! Which lines could ever meet the seabed: the others are made without contact.
//!
//! Every node of lines that hang together by free points is within their length of each fixed point that holds them, stretched by half. What
//! a host or a path moves, and what may come loose, can get anywhere.

use crate::scene::{Line, PointKind, Scene};

/// Stretched over unstretched length that a line is taken to reach at most [-].
const STRETCH_MAX: f64 = 1.5;

/// Whether a line could ever touch the bed.
pub(super) fn may_touch_bed(scene: &Scene, line: &Line) -> bool {
    let Some(bed) = &scene.seabed else {
        return false;
    };
    let tied = tied(scene, line);
    let ends = tied.iter().flat_map(|line| [&line.from, &line.to]);
    let points = ends.filter_map(|name| scene.points.iter().find(|point| point.name == *name));
    let (mut moves, mut reach) = (false, f64::NEG_INFINITY);
    let length: f64 = tied.iter().map(|line| length_max(line)).sum();
    for point in points {
        match point.kind {
            PointKind::Free => {}
            PointKind::Fixed => reach = reach.max(point.position[2] - STRETCH_MAX * length),
            PointKind::Coupled | PointKind::Prescribed => moves = true,
        }
    }
    let parts = |line: &&Line| line.release.is_some() || line.parting.is_some();
    !bed.is_level() || moves || tied.iter().any(parts) || reach <= -bed.depth
}

/// A line and all that hang together with it by free points.
fn tied<'a>(scene: &'a Scene, line: &'a Line) -> Vec<&'a Line> {
    let is_free = |name: &str| {
        let point = scene.points.iter().find(|point| point.name == name);
        point.is_some_and(|point| point.kind == PointKind::Free)
    };
    let mut tied = vec![line];
    let mut next = 0;
    while let Some(&line) = tied.get(next) {
        for shared in [&line.from, &line.to]
            .into_iter()
            .filter(|name| is_free(name))
        {
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

/// Greatest unstretched length of a line [m].
fn length_max(line: &Line) -> f64 {
    let sections: f64 = line.sections.iter().map(|section| section.length).sum();
    sections + line.winch.as_ref().map_or(0.0, |winch| winch.length_max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEPTH: f64 = 100.0;

    /// A line of 20 m from a fixed point at z = −10 m, with more of the scene.
    fn hung(end: &str, line: &str, more: &str) -> Scene {
        let text = format!(
            "seabed = {{ depth = {DEPTH:?} }}
            line_types.rope = {{ mass = 5.0, diameter = 0.05, axial_stiffness = 1e6 }}
            points = [{{ name = 'top', position = [0.0, 0.0, -10.0], kind = 'fixed' }},
                      {{ name = 'end', position = [5.0, 0.0, -15.0], {end} }}]
            [[lines]]
            name = 'line'
            from = 'top'
            to = 'end'
            sections = [{{ type = 'rope', length = 20.0 }}]
            {line}
            {more}"
        );
        Scene::from_toml(&text).unwrap()
    }

    fn touches(scene: &Scene) -> bool {
        may_touch_bed(scene, &scene.lines[0])
    }

    #[test]
    fn a_line_far_above_the_bed_is_made_without_it() {
        assert!(!touches(&hung("kind = 'fixed'", "", "")));
        assert!(!touches(&hung("kind = 'free'", "", "")));
    }

    #[test]
    fn what_can_move_or_come_loose_may_touch_the_bed() {
        assert!(touches(&hung("kind = 'coupled'", "", "")));
        assert!(touches(&hung("kind = 'fixed'", "release = 'b'", "")));
        assert!(touches(&hung(
            "kind = 'fixed'",
            "break = { at = 'b', time = 1.0 }",
            ""
        )));
    }

    #[test]
    fn a_line_reaches_as_far_as_those_it_hangs_together_with_and_what_a_winch_pays_out() {
        let longer = "[[lines]]\nname = 'other'\nfrom = 'end'\nto = 'top'\nsections = [{ type = 'rope', length = 50.0 }]";
        assert!(touches(&hung("kind = 'free'", "", longer)));
        let winch = "winch = { end = 'b', length_max = 60.0 }";
        assert!(touches(&hung("kind = 'fixed'", winch, "")));
    }
}
