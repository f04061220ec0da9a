//! Bending of cables in words.

use crate::scene::check::{number, quantity};
use crate::scene::{FibreLaw, Line, LineType, RestShape, Scene};

/// EI of a line type, where it comes from and who shares it; nothing for a flexible line.
pub(super) fn stiffness_in_words(line_type: &LineType) -> Option<String> {
    let stiffness = line_type.cable_stiffness()?;
    let source = match (line_type.bending_stiffness, line_type.solid_section) {
        (None, Some(section)) => format!(
            "of a solid round section of {} with Young's modulus {}",
            quantity(section.diameter, "m"),
            quantity(section.youngs_modulus, "Pa")
        ),
        _ => "as given".to_string(),
    };
    let said = quantity(stiffness, "N m²");
    let strands = match line_type.fibres {
        None | Some(0 | 1) => return Some(format!("bending stiffness EI {said} {source}")),
        Some(strands) => strands,
    };
    let solid = quantity(line_type.solid_stiffness()?, "N m²");
    let law = match line_type.fibre_law {
        FibreLaw::Linear => format!("EI/{strands}: strands that slide on each other side by side"),
        FibreLaw::Squared => format!("EI/{strands}²: that of a single strand"),
    };
    Some(format!(
        "bending stiffness {said}, which is EI {solid} {source} shared by {strands} fibres ({law})"
    ))
}

/// How the ends of a line that bends are held, and what shape bends nothing.
pub(super) fn ends_in_words(line: &Line) -> String {
    let end = |name: &str, clamp: Option<[f64; 3]>| match clamp {
        Some(along) => {
            let [x, y, z] = along.map(number);
            format!("clamped at end {name} along ({x}, {y}, {z})")
        }
        None => format!("free to turn at end {name}"),
    };
    let rest = match line.rest_shape {
        RestShape::Straight => "unstressed where straight",
        RestShape::Initial => "unstressed as it lies at the start",
    };
    format!(
        "bends; {}, {}; {rest}",
        end("A", line.clamped_a),
        end("B", line.clamped_b)
    )
}

/// What of bending, torsion and shear is left out.
pub(super) fn absence_in_words(scene: &Scene) -> &'static str {
    let bending = scene.lines.iter().filter(|line| scene.bends(line)).count();
    match bending {
        0 => "bending, torsion and shear of lines",
        n if n == scene.lines.len() => "torsion and shear of lines",
        _ => "bending of lines without bending stiffness, torsion and shear of all lines",
    }
}

/// What carries compression.
pub(super) fn compression_in_words(scene: &Scene) -> &'static str {
    if scene.lines.iter().any(|line| scene.bends(line)) {
        "tension is never negative where a line is flexible; where it has bending stiffness an element of length l pushes with \
         up to 4EI/l², beyond which it would buckle within itself"
    } else {
        "tension is never negative: a slack line carries nothing"
    }
}
