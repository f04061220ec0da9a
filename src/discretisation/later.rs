//! Notes on what happens in a run after its trials.

use crate::scene::{Note, Scene, instant};

/// Ratio of the RMS speed of a later part of a table of motion to that in the trials above which the trials are not representative [-].
const FASTER: f64 = 2.0;
/// Number of parts into which the evaluated time of the trials is divided; speeds are compared over parts of that length [-].
const PARTS: usize = 4;

/// Returns a note if a scene has a motion that becomes much faster, or a line that breaks, after the trials of this duration [s].
pub(super) fn note(scene: &Scene, duration: f64) -> Option<Note> {
    if duration == 0.0 || duration >= scene.output.duration {
        return None;
    }
    let tables = scene.motions().filter_map(|path| path.rows());
    let faster = tables.filter_map(|rows| fastest_later(rows, duration, scene.output.duration));
    let faster = faster
        .filter(|(ratio, _)| *ratio > FASTER)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let motion = faster.map(|(ratio, time)| match ratio.is_finite() {
        true => format!(
            "the motion is up to {ratio:.1} times as fast later, about {}",
            instant(time)
        ),
        false => format!("the motion begins later, about {}", instant(time)),
    });
    let breaks = scene.lines.iter().filter_map(|line| line.failure.as_ref()?.time);
    let later = breaks.filter(|time| *time > duration && *time < scene.output.duration);
    let broken = later
        .reduce(f64::min)
        .map(|time| format!("a line breaks at {}", instant(time)));
    let events: Vec<String> = motion.into_iter().chain(broken).collect();
    (!events.is_empty()).then(|| {
        let text = format!(
            "the trials cover the first {duration:.0} s of the run, but {}: the error from then on is unknown; compare with a run with more `elements`",
            events.join(", and ")
        );
        Note::new("solver.tolerance", text)
    })
}

/// Greatest ratio of the RMS speed in a part of a table after the trials of this duration [s], up to the end of a run [s], to that in their second half,
/// which is evaluated, and the time of that part [s].
fn fastest_later(rows: &[[f64; 7]], duration: f64, end: f64) -> Option<(f64, f64)> {
    let part = 0.5 * duration / PARTS as f64;
    let mean_square = |from: f64, to: f64| {
        let [first, last] = [
            rows.partition_point(|row| row[0] < from),
            rows.partition_point(|row| row[0] <= to),
        ];
        let squares = rows[first..last.max(first)].windows(2).map(|pair| {
            let moved = |axis: usize| pair[1][axis] - pair[0][axis];
            (1..4).map(|axis| moved(axis) * moved(axis)).sum::<f64>() / (pair[1][0] - pair[0][0])
        });
        squares.sum::<f64>() / (to - from)
    };
    let tried = mean_square(0.5 * duration, duration);
    let parts = (0..)
        .map(|k| duration + f64::from(k) * part)
        .take_while(|from| *from < end);
    let ratios = parts.map(|from| ((mean_square(from, from + part) / tried).sqrt(), from));
    ratios
        .filter(|(ratio, _)| !ratio.is_nan())
        .max_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Note on a line driven by a table with rows from `amplitude`, a function of time [s], for a run of 600 s after trials of 200 s.
    fn noted(amplitude: impl Fn(f64) -> f64, more: &str) -> Option<String> {
        let rows = (0..6000).map(|i| 0.1 * f64::from(i));
        let rows: Vec<String> = rows
            .map(|t| format!("[{t}, {}, 0.0, 0.0]", amplitude(t) * t.sin()))
            .collect();
        let text = format!(
            "line_types.rope = {{ mass = 1.0, axial_stiffness = 1e6 }}
            points = [{{ name = 'a', position = [0, 0, -10], kind = 'fixed' }}, {{ name = 'b', position = [0, 0, 0], kind = 'coupled' }}]
            lines = [{{ name = 'l', from = 'a', to = 'b', sections = [{{ type = 'rope', length = 9.9 }}] {more} }}]
            motion.b.table = [{}]
            output.duration = 600",
            rows.join(", ")
        );
        note(&Scene::from_toml(&text).unwrap(), 200.0).map(|note| note.text)
    }

    #[test]
    fn a_steady_motion_is_covered_by_its_trials() {
        assert_eq!(noted(|_| 0.1, ""), None);
        assert_eq!(noted(|t| 0.1 + 0.05 * (0.02 * t).sin(), ""), None);
    }

    #[test]
    fn a_motion_that_grows_or_begins_after_the_trials_and_a_later_break_are_noted() {
        let grown = noted(|t| if t < 300.0 { 0.02 } else { 0.08 }, "").unwrap();
        assert!(
            grown.contains("up to 4.0 times as fast later, about t = "),
            "{grown}"
        );
        let begun = noted(|t| if t < 300.0 { 0.0 } else { 0.08 }, "").unwrap();
        assert!(begun.contains("begins later, about t = "), "{begun}");
        let broken = noted(|_| 0.1, ", break = { at = 'b', time = 400.0 }").unwrap();
        assert!(broken.contains("but a line breaks at t = 400 s"), "{broken}");
    }
}
