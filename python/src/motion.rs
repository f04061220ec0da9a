//! Motion of a scene from columns in memory, which are named as in a motion file.

use std::collections::BTreeMap;

use moorline::scene::{MotionPath, MotionRow, Scene};

use crate::errors::Failure;
use crate::parameters;

/// Axes of a body, as in the last part of a column's name.
const AXES: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];
/// Column of the time [s].
const TIME: &str = "time";

/// Returns the scene with the motion in columns such as `time` and `fairlead.x`, which replaces the scene's motions of these bodies.
/// The run lasts until `duration` [s], or until the last time.
///
/// # Errors
/// The failure names the column, the mistake and a correction.
pub(crate) fn with_columns(
    mut scene: Scene,
    columns: &[(String, Vec<f64>)],
    duration: Option<f64>,
) -> Result<Scene, Failure> {
    let time = columns.iter().find(|(name, _)| name == TIME);
    let refuse = |name: &str, problem: String| Err(Failure::of_argument(name, problem));
    let Some((_, time)) = time else {
        return refuse(
            TIME,
            "the motion has no such column: it holds the times of the rows [s]".to_string(),
        );
    };
    let mut bodies: BTreeMap<&str, Vec<MotionRow>> = BTreeMap::new();
    for (name, values) in columns {
        if values.len() != time.len() {
            let (rows, times) = (values.len(), time.len());
            return refuse(name, format!("{rows} rows, but there are {times} times"));
        }
        if let Some(row) = values.iter().position(|value| !value.is_finite()) {
            return refuse(name, format!("row {row}: {} is not a finite number", values[row]));
        }
        if name == TIME {
            continue;
        }
        let place = name.rsplit_once('.');
        let place =
            place.and_then(|(body, axis)| Some((body, AXES.iter().position(|known| *known == axis)?)));
        let Some((body, axis)) = place else {
            let wanted = "a column is named after a coupled point or a vessel and an axis, such as fairlead.x or platform.pitch; \
                          velocities follow from the displacements";
            return refuse(name, wanted.to_string());
        };
        let rows = bodies.entry(body).or_insert_with(|| {
            let row = |&time: &f64| [time, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            time.iter().map(row).collect()
        });
        for (row, value) in rows.iter_mut().zip(values) {
            row[axis + 1] = *value;
        }
    }
    if bodies.is_empty() {
        return refuse(
            "motion",
            "no column moves anything: add one such as fairlead.x".to_string(),
        );
    }
    for (body, rows) in bodies {
        scene.motion.insert(body.to_string(), MotionPath::Table(rows));
    }
    let end = time.last().copied().filter(|end| *end > 0.0);
    scene.output.duration = duration.or(end).unwrap_or(scene.output.duration);
    parameters::check(scene)
}
