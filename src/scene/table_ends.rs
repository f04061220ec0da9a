//! Tables in time that end before the run, begin after its start, have a gap, or contain positions instead of displacements.

use super::check::quantity;
use super::notes::Note;
use super::path::quoted;
use super::{MotionPath, Scene, TimeFunction};

/// Returns the remarks on such tables.
pub(super) fn notes(scene: &Scene) -> Vec<Note> {
    let duration = scene.output.duration;
    let ends = motions(scene).filter_map(|(at, motion)| note_motion(at, motion, duration));
    let functions = functions(scene).filter_map(|(at, f)| note_function(at, f, duration));
    let gaps = motions(scene).filter_map(|(at, motion)| note_gap(at, motion.rows()?));
    let absolute = motions(scene).filter_map(|(at, motion)| note_absolute(scene, &at, motion.rows()?));
    ends.chain(functions).chain(gaps).chain(absolute).collect()
}

/// Minimum number of rows for a table to be treated as a record [-].
const RECORD_ROWS: usize = 20;
/// Shortest time between two rows that counts as a gap, relative to the median of the record [-].
const GAP: f64 = 10.0;
/// Distance between the first row and the position of the body, relative to the distance of that position from the origin, up to which the first
/// row is taken for that position [-].
const NEAR: f64 = 0.1;

/// Remark on a record whose values change across a gap.
fn note_gap(at: String, rows: &[[f64; 7]]) -> Option<Note> {
    if rows.len() < RECORD_ROWS {
        return None;
    }
    let mut steps: Vec<f64> = rows.windows(2).map(|pair| pair[1][0] - pair[0][0]).collect();
    let (_, median, _) = steps.select_nth_unstable_by(rows.len() / 2 - 1, f64::total_cmp);
    let limit = GAP * *median;
    let gap = |pair: &&[[f64; 7]]| pair[1][0] - pair[0][0] > limit && pair[0][1..] != pair[1][1..];
    let [before, after] = rows.windows(2).find(gap)? else {
        return None;
    };
    let [from, to, usual] = [before[0], after[0], limit / GAP].map(|time| quantity(time, "s"));
    let text = format!(
        "the table has no row between {from} and {to}, where most stand {usual} apart: the motion goes smoothly from one to the other"
    );
    Some(Note::new(at, text))
}

/// Remark on a table whose first row is about the position of the body: its rows are probably positions.
fn note_absolute(scene: &Scene, at: &str, rows: &[[f64; 7]]) -> Option<Note> {
    let name = at.strip_prefix("motion.")?.trim_matches('"');
    let vessel = scene.vessel(name).map(|vessel| vessel.position);
    let place = vessel.or_else(|| Some(scene.point(name)?.position))?;
    let [_, x, y, z, ..] = *rows.first()?;
    let norm = |[x, y, z]: [f64; 3]| x.hypot(y).hypot(z);
    let apart = norm([x - place[0], y - place[1], z - place[2]]);
    (norm(place) >= 1.0 && apart <= NEAR * norm(place)).then(|| {
        let [x, y, z] = [x, y, z].map(super::check::number);
        let text = format!(
            "the table begins at ({x}, {y}, {z}) m, about the position of {name}: its rows are displacements from there, and positions have to \
             be written without it"
        );
        Note::new(at, text)
    })
}

/// Motions of a scene by their key paths.
pub(super) fn motions(scene: &Scene) -> impl Iterator<Item = (String, &MotionPath)> {
    let driven = scene.motion.iter();
    let driven = driven.map(|(name, motion)| (format!("motion.{}", quoted(name)), motion));
    let points = scene.points.iter().enumerate();
    let own = points.filter_map(|(i, point)| Some((format!("points[{i}].motion"), point.motion.as_ref()?)));
    driven.chain(own)
}

fn functions(scene: &Scene) -> impl Iterator<Item = (String, &TimeFunction)> {
    let current = scene.current();
    let factor = current.and_then(|current| current.factor.as_ref());
    let factor = factor.map(|factor| ("water.current.factor".to_string(), factor));
    let loads = scene.points.iter().enumerate().flat_map(|(i, point)| {
        let axes = ["x", "y", "z"].into_iter();
        let force = point.force.iter().flat_map(|f| [&f.x, &f.y, &f.z]);
        let moment = point.moment.iter().flat_map(|m| [&m.x, &m.y, &m.z]);
        let force = axes.clone().zip(force).map(|(axis, f)| ("force", axis, f));
        let moment = axes.zip(moment).map(|(axis, f)| ("moment", axis, f));
        let all = force.chain(moment);
        all.filter_map(move |(key, axis, f)| Some((format!("points[{i}].{key}.{axis}"), f.as_ref()?)))
    });
    let winches = scene.lines.iter().enumerate().filter_map(|(i, line)| {
        let path = line.winch.as_ref()?.path.as_ref()?;
        Some((format!("lines[{i}].winch.path"), path))
    });
    factor.into_iter().chain(loads).chain(winches)
}

fn note_motion(at: String, motion: &MotionPath, duration: f64) -> Option<Note> {
    let rows = motion.rows()?;
    let (first, last) = (rows.first()?[0], rows.last()?[0]);
    let [begin, end, run] = [first, last, duration].map(|time| quantity(time, "s"));
    let late = format!("the table begins at {begin}: until then it stays at its first row");
    let early = format!("the table ends at {end}, the run at {run}: in between it stays at its last row");
    let text = match (first > 0.0, last < duration) {
        (true, true) => format!("{late}; {early}"),
        (true, false) => late,
        (false, true) => early,
        (false, false) => return None,
    };
    Some(Note::new(at, text))
}

/// Remark on a function that begins after the start of the run or ends before its end. A function that is constant there, jumps there, or begins at zero is
/// taken as intended.
fn note_function(at: String, function: &TimeFunction, duration: f64) -> Option<Note> {
    let TimeFunction::Table(rows) = function else {
        return None;
    };
    let ([first, second, ..], [.., before, last]) = (rows.as_slice(), rows.as_slice()) else {
        return None;
    };
    let changes = |a: &[f64; 2], b: &[f64; 2]| a[0] != b[0] && a[1] != b[1];
    let [begin, end, run] = [first[0], last[0], duration].map(|time| quantity(time, "s"));
    let late = format!("the table begins at {begin}: until then its first value holds");
    let early = format!("the table ends at {end}, the run at {run}: in between its last value holds");
    let is_late = first[0] > 0.0 && first[1] != 0.0 && changes(first, second);
    let text = match (is_late, last[0] < duration && changes(before, last)) {
        (true, true) => format!("{late}; {early}"),
        (true, false) => late,
        (false, true) => early,
        (false, false) => return None,
    };
    Some(Note::new(at, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_table_that_does_not_cover_the_run_is_remarked_on() {
        let motion = |times: &[f64]| {
            MotionPath::Table(times.iter().map(|t| [*t, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).collect())
        };
        let said = |times: &[f64]| {
            let note = note_motion("motion.f".into(), &motion(times), 60.0);
            note.map(|note| note.to_string())
        };
        assert_eq!(said(&[0.0, 60.0]), None);
        assert_eq!(
            said(&[0.0, 30.0]).unwrap(),
            "motion.f: the table ends at 30 s, the run at 60 s: in between it stays at its last row"
        );
        assert_eq!(
            said(&[5.0, 90.0]).unwrap(),
            "motion.f: the table begins at 5 s: until then it stays at its first row"
        );
    }

    #[test]
    fn a_record_with_a_gap_is_remarked_on_and_a_table_that_holds_is_not() {
        let record = |gap: f64, moves: f64| -> Vec<[f64; 7]> {
            let row = |i: i32| {
                [
                    f64::from(i) + if i < 12 { 0.0 } else { gap },
                    moves * f64::from(i),
                    0.0,
                    0.0,
                    0.0,
                    0.0,
                    0.0,
                ]
            };
            (0..30).map(row).collect()
        };
        let said = |gap, moves| note_gap("motion.f".into(), &record(gap, moves)).map(|note| note.text);
        assert!(
            said(100.0, 0.1)
                .unwrap()
                .contains("no row between 11 s and 112 s")
        );
        assert_eq!([said(5.0, 0.1), said(100.0, 0.0)], [None, None]);
        let held = [[0.0; 7], [30.0; 7], [32.0; 7], [600.0; 7]];
        assert_eq!(note_gap("motion.f".into(), &held), None);
    }

    #[test]
    fn a_table_of_positions_in_place_of_displacements_is_remarked_on() {
        let mut scene = Scene::default();
        let place = [5.0, 0.0, -10.0];
        scene.points.push(super::super::Point::at(
            "f",
            place,
            super::super::PointKind::Coupled,
        ));
        let said = |x: f64, z: f64| note_absolute(&scene, "motion.f", &[[0.0, x, 0.0, z, 0.0, 0.0, 0.0]]);
        assert!(said(5.3, -10.2).unwrap().text.contains("about the position of f"));
        assert_eq!([said(0.0, 0.0), said(2.0, -1.0)], [None, None]);
    }

    #[test]
    fn a_load_that_ends_while_it_changes_is_remarked_on_and_one_at_rest_is_not() {
        let said = |rows: &[[f64; 2]]| {
            note_function("f".into(), &TimeFunction::Table(rows.to_vec()), 60.0).is_some()
        };
        assert!(said(&[[3.0, 0.5], [60.0, 1.0]]));
        assert!(!said(&[[3.0, 0.0], [60.0, 1.0]]));
        assert!(said(&[[0.0, 0.0], [30.0, 5.0]]));
        assert!(!said(&[[0.0, 0.0], [30.0, 5.0], [31.0, 5.0]]));
        assert!(!said(&[[2.5, 8.0], [2.5, 0.0]]));
        assert!(!said(&[[0.0, 0.0], [60.0, 5.0]]));
    }
}
