//! How a line stretches, in words.

use super::{quantity, significant, strain_in_words};
use crate::scene::LineType;

/// What the axial force of a line of a mass [kg/m] follows from, and how fast its axial waves run.
pub(super) fn in_words(line_type: &LineType, mass: f64) -> String {
    let waves = |ea: f64| format!("axial waves at {} m/s", significant((ea / mass).sqrt()));
    if let Some(table) = &line_type.tension_strain {
        let last = table.rows.last().copied().unwrap_or_default();
        return format!(
            "tension from a table of {} rows up to {} at a strain of {}, smooth between them and straight beyond",
            table.rows.len(),
            quantity(last[1], "N"),
            significant(last[0])
        );
    }
    if let (Some(slow), Some(fast), Some(damping)) = (
        line_type.static_stiffness,
        line_type.dynamic_stiffness,
        line_type.static_damping,
    ) {
        let own = line_type.dynamic_damping.map_or_else(String::new, |damping| {
            format!(" and its damper {}", quantity(damping, "N s"))
        });
        return format!(
            "viscoelastic: EA {} at rest and in slow motion, {} in fast motion{own}, the slow part damped by {}, {}",
            quantity(slow, "N"),
            quantity(fast, "N"),
            quantity(damping, "N s"),
            waves(fast)
        );
    }
    let ea = line_type.axial_stiffness.unwrap_or(0.0); // EA [N]
    format!(
        "EA {} on the {} strain, {}",
        quantity(ea, "N"),
        strain_in_words(line_type.strain),
        waves(ea)
    )
}
