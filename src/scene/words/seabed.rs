//! Shape and friction of the seabed.

use super::{number, quantity};
use crate::scene::Seabed;

/// What the bed's surface is.
pub(super) fn shape_in_words(bed: &Seabed) -> String {
    let depth = quantity(-bed.depth, "m");
    match (&bed.grid, bed.slope) {
        (Some(grid), _) => {
            let soundings = || grid.depth.iter().flatten().copied();
            let (least, most) = (
                soundings().fold(f64::INFINITY, f64::min),
                soundings().fold(f64::NEG_INFINITY, f64::max),
            );
            let span = |line: &[f64]| match line {
                [first, .., last] => format!("from {} to {}", number(*first), quantity(*last, "m")),
                _ => "alike everywhere".to_string(),
            };
            format!(
                "seabed through {} by {} soundings, x {}, y {}, from {} to {} deep, smooth between them and constant outside; closed-form \
                 catenaries know no such bed, elements are used instead",
                grid.x.len(),
                grid.y.len(),
                span(&grid.x),
                span(&grid.y),
                number(least),
                quantity(most, "m")
            )
        }
        (None, Some([x, y])) if !bed.is_level() => format!(
            "seabed on a plane through z = {depth} at the origin that rises by {} per metre of x and {} per metre of y; closed-form \
             catenaries know no such bed, elements are used instead",
            number(x),
            number(y)
        ),
        _ => format!("flat seabed at z = {depth}"),
    }
}

/// How it rubs.
pub(super) fn friction_in_words(bed: &Seabed) -> String {
    let friction = bed.friction;
    if !friction.acts() {
        return "no friction".to_string();
    }
    let coefficients = if friction.axial == friction.transverse {
        format!("Coulomb friction with the coefficient {}", number(friction.axial))
    } else {
        format!(
            "Coulomb friction with the coefficients {} along the line, {} across it and for points",
            number(friction.axial),
            number(friction.transverse)
        )
    };
    format!(
        "{coefficients}, which sticks and slides; at the start every line lies as one laid without tension from its end A, or from end B where only that is on the seabed, and hauled at the other end"
    )
}
