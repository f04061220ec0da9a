//! Weight less buoyancy of a fully submerged line.
//!
//! w = (m − ρ π d²/4) g per unstretched length.
//!
//! Source: Archimedes; the volume is that of the unstretched line. Valid below the water surface.

/// Weight [N/m] of a line of `mass` [kg/m] and displaced fluid mass ρA `displaced` [kg/m]; negative when buoyant.
pub fn submerged_weight(mass: f64, displaced: f64, gravity: f64) -> f64 {
    (mass - displaced) * gravity
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn oc3_hywind_line_weighs_698_newtons_per_metre() {
        let displaced = 1025.0 * crate::math::circle::area(0.09);
        assert_relative_eq!(
            submerged_weight(77.7066, displaced, 9.80665),
            698.1,
            max_relative = 1e-4
        );
    }

    #[test]
    fn a_line_lighter_than_water_is_buoyant() {
        assert!(submerged_weight(1.0, 2.0, 9.81) < 0.0);
    }
}
