//! The current, in words.

use super::{number, quantity};
use crate::scene::{Current, Scene, TimeFunction};

/// "1 m/s along (1, 0, 0) at all heights".
pub(super) fn current_in_words(current: &Current) -> String {
    let triple = |v: [f64; 3]| {
        let speed = v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let [x, y, z] = v.map(number);
        let speed = quantity((1e6 * speed).round() / 1e6, "m/s");
        format!("({x}, {y}, {z}) m/s, a speed of {speed}, at all heights")
    };
    let shape = match (&current.velocity, &current.profile) {
        (_, Some(rows)) => profile_in_words(rows),
        (velocity, None) => triple(velocity.unwrap_or_default()),
    };
    let times = match &current.factor {
        None => ", steady".to_string(),
        Some(TimeFunction::Constant(factor)) => format!(", steady, times {}", number(*factor)),
        Some(_) => {
            ", times a function of time; the force of the water's own acceleration is left out"
                .to_string()
        }
    };
    shape + &times
}

/// "from (0.3, 0) m/s at z = -200 m to (1, 0) m/s at z = 0 m, straight between 3 heights and constant outside".
fn profile_in_words(rows: &[[f64; 3]]) -> String {
    let lower = rows.iter().min_by(|a, b| a[0].total_cmp(&b[0]));
    let upper = rows.iter().max_by(|a, b| a[0].total_cmp(&b[0]));
    let (Some(lower), Some(upper)) = (lower, upper) else {
        return "no rows".to_string();
    };
    let place = |[z, x, y]: &[f64; 3]| {
        format!(
            "({}, {}) m/s at z = {}",
            number(*x),
            number(*y),
            quantity(*z, "m")
        )
    };
    if rows.len() == 1 {
        return format!("{}, and at all other heights", place(lower));
    }
    format!(
        "from {} to {}, straight between {} heights and constant outside",
        place(lower),
        place(upper),
        rows.len()
    )
}

/// What the water of a scene does not do.
pub(super) fn absence_in_words(scene: &Scene) -> &'static str {
    let flows = scene.water.as_ref().is_some_and(|w| w.current.is_some());
    match (flows, scene.surface_matters()) {
        (true, true) => "waves and the water's surface over lines",
        (true, false) => "waves and the water's surface",
        (false, true) => "current, waves and the water's surface over lines",
        (false, false) => "current, waves and the water's surface",
    }
}
