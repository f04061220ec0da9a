//! Beams in words.

use super::load_in_words;
use crate::scene::check::quantity;
use crate::scene::{Integrator, Line, LineModel, LineType, PointMoment, RestShape, Scene};

impl Scene {
    /// Whether a line is a beam.
    pub(in crate::scene) fn is_beam(&self, line: &Line) -> bool {
        let mut sections = line.sections.iter();
        self.solver.integrator == Integrator::Beam
            || sections.any(|section| {
                let line_type = self.line_types.get(&section.line_type);
                line_type.is_some_and(|t| t.model == LineModel::Beam)
            })
    }

    /// Whether all lines are beams.
    pub(in crate::scene) fn all_beams(&self) -> bool {
        !self.lines.is_empty() && self.lines.iter().all(|line| self.is_beam(line))
    }

    /// What a beam's section resists, and where that is from; nothing for a cable.
    pub(super) fn section_in_words(&self, line_type: &LineType) -> Option<String> {
        if line_type.model != LineModel::Beam && self.solver.integrator != Integrator::Beam {
            return None;
        }
        let rows = [
            ("EI", line_type.bending_stiffness, "N m²"),
            ("GA", line_type.shear_stiffness, "N"),
            ("GJ", line_type.torsional_stiffness, "N m²"),
            ("rotary inertia", line_type.rotary_inertia, "kg m"),
        ];
        let given = rows
            .iter()
            .filter_map(|(name, value, unit)| Some(format!("{name} {}", quantity((*value)?, unit))));
        let mut parts: Vec<String> = given.collect();
        let open = rows.iter().filter(|(_, value, _)| value.is_none());
        let open: Vec<&str> = open.map(|(name, _, _)| *name).collect();
        if let (Some(section), false) = (&line_type.solid_section, open.is_empty()) {
            parts.push(format!(
                "{} of a solid round section of {} with Young's modulus {} and Poisson's ratio {}",
                open.join(", "),
                quantity(section.diameter, "m"),
                quantity(section.youngs_modulus, "Pa"),
                section.poisson
            ));
        }
        Some(format!("a beam: {}", parts.join(", ")))
    }

    /// How a beam's ends are held and what shape is free of stress; nothing for a cable.
    pub(super) fn hold_in_words(&self, line: &Line) -> Option<String> {
        if !self.is_beam(line) {
            return None;
        }
        let end = |name: &str, clamp: Option<[f64; 3]>| match clamp {
            Some([x, y, z]) => format!("clamped at end {name} along ({x}, {y}, {z})"),
            None => format!("free to turn at end {name}"),
        };
        let rest = match line.rest_shape {
            RestShape::Straight => "straight",
            RestShape::Initial => "as it starts",
        };
        Some(format!(
            "a beam, {}, {}, without stress {rest}",
            end("A", line.clamped_a),
            end("B", line.clamped_b)
        ))
    }
}

/// A moment on the end of a line that bends.
pub(super) fn moment_in_words(moment: &PointMoment) -> String {
    let axes = [("x", &moment.x), ("y", &moment.y), ("z", &moment.z)];
    let said: Vec<String> = axes
        .iter()
        .filter_map(|(axis, function)| {
            let function = function.as_ref()?;
            Some(format!("{} about {axis}", load_in_words(function, "N m")))
        })
        .collect();
    format!("moment {}", said.join(" and "))
}
