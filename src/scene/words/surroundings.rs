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

/// "that fills all space", or which lines know its surface.
pub(super) fn surface_in_words(scene: &Scene) -> String {
    let named = |meet: bool| {
        let lines = scene.lines.iter();
        let lines = lines.filter(|line| scene.meets_surface(line) == meet);
        lines.map(|line| line.name.as_str()).collect::<Vec<_>>()
    };
    let (piercing, submerged) = (named(true), named(false));
    if piercing.is_empty() {
        return "that fills all space".to_string();
    }
    let mut said = format!(
        "with its surface at z = 0: above it {} no buoyancy, drag and added mass",
        have(&piercing)
    );
    if !submerged.is_empty() {
        said += &format!(", while {} them everywhere", have(&submerged));
    }
    said + "; closed-form catenaries take all of a line as under water"
}

/// "a, b and c have".
fn have(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => format!("{one} has"),
        [first @ .., last] => format!("{} and {last} have", first.join(", ")),
    }
}

/// What the water of a scene does not do.
pub(super) fn absence_in_words(scene: &Scene) -> &'static str {
    let flows = scene.water.as_ref().is_some_and(|w| w.current.is_some());
    let mut lines = scene.lines.iter();
    let all = !scene.lines.is_empty() && lines.clone().all(|line| scene.meets_surface(line));
    let any = lines.any(|line| scene.meets_surface(line)) || scene.surface_matters();
    match (flows, all, any) {
        (true, true, _) => "waves",
        (true, _, true) => "waves and the water's surface over some lines",
        (true, _, false) => "waves and the water's surface",
        (false, true, _) => "current and waves",
        (false, _, true) => "current, waves and the water's surface over some lines",
        (false, _, false) => "current, waves and the water's surface",
    }
}
