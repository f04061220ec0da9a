//! Winches, in words.

use super::quantity;
use crate::scene::Line;

/// `; end B is on a winch at fairlead, which pays out up to 40 m by its input line1.length_change`; nothing where there is none.
pub(super) fn in_words(line: &Line) -> String {
    let Some(winch) = &line.winch else {
        return String::new();
    };
    let speed = winch.speed_max.map_or(String::new(), |speed| {
        format!(", at no more than {}", quantity(speed, "m/s"))
    });
    let path = winch
        .path
        .as_ref()
        .map_or("", |_| " (its own path where the scene moves itself)");
    format!(
        "; end B is on a winch at {}, which pays out up to {} and hauls in by the input {}.length_change{speed}{path}",
        line.to,
        quantity(winch.length_max, "m"),
        line.name
    )
}
