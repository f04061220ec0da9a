//! Tables in time that end before the run does, or begin after it.

use super::check::quantity;
use super::notes::Note;
use super::path::quoted;
use super::{MotionPath, Scene, TimeFunction};

/// Remarks on them, one a table.
pub(super) fn notes(scene: &Scene) -> Vec<Note> {
    let duration = scene.output.duration;
    let motions = motions(scene).filter_map(|(at, motion)| note_motion(at, motion, duration));
    let functions = functions(scene).filter_map(|(at, f)| note_function(at, f, duration));
    motions.chain(functions).collect()
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

/// One that has come to rest when it ends, or ends with a jump, is meant so.
fn note_function(at: String, function: &TimeFunction, duration: f64) -> Option<Note> {
    let TimeFunction::Table(rows) = function else {
        return None;
    };
    let [.., before, last] = rows.as_slice() else {
        return None;
    };
    let is_meant = last[0] >= duration || before[0] == last[0] || before[1] == last[1];
    let [end, run] = [last[0], duration].map(|time| quantity(time, "s"));
    let text = format!("the table ends at {end}, the run at {run}: in between its last value holds");
    (!is_meant).then(|| Note::new(at, text))
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
    fn a_load_that_ends_while_it_changes_is_remarked_on_and_one_at_rest_is_not() {
        let said = |rows: &[[f64; 2]]| {
            note_function("f".into(), &TimeFunction::Table(rows.to_vec()), 60.0).is_some()
        };
        assert!(said(&[[0.0, 0.0], [30.0, 5.0]]));
        assert!(!said(&[[0.0, 0.0], [30.0, 5.0], [31.0, 5.0]]));
        assert!(!said(&[[2.5, 8.0], [2.5, 0.0]]));
        assert!(!said(&[[0.0, 0.0], [60.0, 5.0]]));
    }
}
