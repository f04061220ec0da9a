//! Bending of cables in words.

use std::f64::consts::PI;

use crate::scene::check::{number, quantity};
use crate::scene::{FibreLaw, Line, LineModel, LineType, RestShape, Scene};

/// EI of one solid section [N m²]: as given, else Eπd⁴/64; `None` for flexible cables, and for beams.
fn solid_stiffness(line_type: &LineType) -> Option<f64> {
    let of_section = || {
        let section = line_type.solid_section?;
        Some(section.youngs_modulus * PI * section.diameter.powi(4) / 64.0)
    };
    let solid = line_type.bending_stiffness.or_else(of_section);
    solid.filter(|ei| *ei > 0.0 && line_type.model == LineModel::Cable)
}

/// Whether a cable has a section with bending stiffness.
pub(super) fn bends(scene: &Scene, line: &Line) -> bool {
    let mut types = line
        .sections
        .iter()
        .filter_map(|section| scene.line_types.get(&section.line_type));
    !scene.is_beam(line) && types.any(|line_type| solid_stiffness(line_type).is_some())
}

/// EI of a line type, where it comes from and who shares it; nothing for a flexible line.
pub(super) fn stiffness_in_words(line_type: &LineType) -> Option<String> {
    let solid = solid_stiffness(line_type)?;
    let source = match (line_type.bending_stiffness, line_type.solid_section) {
        (None, Some(section)) => format!(
            "of a solid round section of {} with Young's modulus {}",
            quantity(section.diameter, "m"),
            quantity(section.youngs_modulus, "Pa")
        ),
        _ => "as given".to_string(),
    };
    let said = quantity(solid, "N m²");
    let (strands, law, share) = match (line_type.fibres, line_type.fibre_law) {
        (None | Some(0 | 1), _) => return Some(format!("bending stiffness EI {said} {source}")),
        (Some(n), FibreLaw::Linear) => {
            let law = format!("EI/{n}: strands that slide on each other side by side");
            (n, law, solid / n as f64)
        }
        (Some(n), FibreLaw::Squared) => {
            let law = format!("EI/{n}²: that of a single strand");
            (n, law, solid / (n as f64).powi(2))
        }
    };
    Some(format!(
        "bending stiffness {}, which is EI {said} {source} shared by {strands} fibres ({law})",
        quantity(share, "N m²")
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
    let cables = || scene.lines.iter().filter(|line| !scene.is_beam(line));
    let bending = cables().filter(|line| bends(scene, line)).count();
    match bending {
        0 => "bending, torsion and shear of lines",
        n if n == cables().count() => "torsion and shear of lines",
        _ => "bending of lines without bending stiffness, torsion and shear of all lines",
    }
}

/// What carries compression.
pub(super) fn compression_in_words(scene: &Scene) -> &'static str {
    if scene.lines.iter().any(|line| bends(scene, line)) {
        "tension is never negative where a line is flexible; where it has bending stiffness an element of length l pushes with \
         up to 4EI/l², beyond which it would buckle within itself"
    } else {
        "tension is never negative: a slack line carries nothing"
    }
}
