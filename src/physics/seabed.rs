//! Normal contact with a horizontal seabed: a spring and a damper that only push.
//!
//! f = max(0, k·p − c·ż) for a penetration p = z_bed − z > 0, else 0.
//!
//! k = kbot·d and c = cbot·d per unstretched length. Regularised contact softens both together,
//!
//! k_eff = min(k, w/(δ d h)·d),    c_eff = max(c·k_eff/k, min(c, 2ζ √(k_eff m))),    m the mass across the line,
//!
//! so that a node at rest penetrates by δ times the segment length h: with the usual kbot of 3 MPa/m the static
//! penetration would be micrometres and every node that lands would ring. `model/build/resting.rs` sets the level of
//! the contact so that the suspended part is right. A damper that is softened like its spring becomes too weak: of
//! the chains in the tank 1 % of critical damping is left, and nodes that land ring for periods of the motion. The
//! damper therefore keeps the part ζ of critical damping, 2√(k m) of a mass on a spring, unless the damping of the
//! scene is less. Both tend to the values of the scene as the mesh is refined, and reach them where the spring does.
//!
//! Source: the spring and damper of Hall & Goupee (2015), Ocean Engineering 104, eq. 13, made unilateral (their damper
//! pulls on a rising node); the regularisation and its δ were chosen by the convergence study described in the README. On the public scenes
//! and ten variants, n = 14 to 40, δ = 0.01 and 0.005 have 4 and 8 % more RMS error of tension, and 24 and 37 % less of the position half-way
//! where that lies on the bed: a node rests 0.01 h deep, and that falls with h only. δh = c h²w/H, λ of constant elements, gives 1.01, 0.97
//! and 1.06 of the error of tension with c = ¼, ½ and 1. There the damper × 0 to × 3 changes nothing above 2 %, × 10 costs 6 %. ζ: on
//! lindahl_slow, 56, 80 and 160 elements, the RMS error of tension is 1.24, 1.30 and 0.55 % with the damper softened like the spring, and 1.03,
//! 0.85 and 0.39 % with ζ = 0.2.
//! Valid where penetrations are small compared with the segment length.

/// Static penetration of a resting node under regularised contact, per nodal length [-].
pub const REGULARISED_PENETRATION: f64 = 0.02;

/// Part of critical damping that a node on a softened spring keeps, if its damper as given has as much [-].
const REGULARISED_DAMPING: f64 = 0.2;

/// Static penetration of a point that rests with all of its weight, the stiffness being chosen for it [m].
pub const POINT_PENETRATION: f64 = 0.02;

/// Lumped contact coefficients of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactCoefficients {
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
}

/// Softens the contact of a node of `weight` [N] in water and `mass` across the line [kg], water included, whose neighbours are
/// `spacing` [m] away; buoyant nodes are left as they are.
pub fn regularised(
    contact: ContactCoefficients,
    [weight, mass]: [f64; 2],
    spacing: f64,
) -> ContactCoefficients {
    if weight <= 0.0 || contact.stiffness <= 0.0 {
        return contact;
    }
    let stiffness = contact
        .stiffness
        .min(weight / (REGULARISED_PENETRATION * spacing));
    let damping = contact.damping;
    let kept = 2.0 * REGULARISED_DAMPING * (stiffness * mass).sqrt();
    ContactCoefficients {
        stiffness,
        damping: (damping * stiffness / contact.stiffness).max(damping.min(kept)),
    }
}

/// Contact of a point of `weight` [N], which has no length or diameter for the bed's coefficients to refer to. Its
/// stiffness gives a penetration of [`POINT_PENETRATION`], with the bed's ratio of damping to stiffness `lag` [s].
pub fn under_point(weight: f64, lag: f64) -> ContactCoefficients {
    let stiffness = weight.abs() / POINT_PENETRATION;
    ContactCoefficients {
        stiffness,
        damping: lag * stiffness,
    }
}

/// Normal force [N], upwards, at a penetration [m] and vertical velocity ż [m/s].
#[inline]
pub fn normal_force(contact: ContactCoefficients, penetration: f64, velocity: f64) -> f64 {
    if penetration > 0.0 {
        (contact.stiffness * penetration - contact.damping * velocity).max(0.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const GIVEN: ContactCoefficients = ContactCoefficients {
        stiffness: 1e6,
        damping: 1e5,
    };

    #[test]
    fn the_bed_never_pulls() {
        assert_eq!(normal_force(GIVEN, 1e-3, 1.0), 0.0);
        assert_eq!(normal_force(GIVEN, -1e-3, -1.0), 0.0);
    }

    #[test]
    fn a_resting_node_sinks_by_the_stated_part_of_its_length() {
        let (weight, length) = (500.0, 4.0);
        let soft = regularised(GIVEN, [weight, 0.0], length);
        assert_relative_eq!(weight / soft.stiffness, REGULARISED_PENETRATION * length);
        assert_relative_eq!(soft.damping / soft.stiffness, GIVEN.damping / GIVEN.stiffness);
    }

    #[test]
    fn a_softened_damper_keeps_a_part_of_critical_damping_unless_the_given_one_has_less() {
        let (weight, mass, length) = (500.0, 60.0, 0.5);
        let given = |damping: f64| ContactCoefficients { damping, ..GIVEN };
        let part = |damping: f64| {
            let soft = regularised(given(damping), [weight, mass], length);
            soft.damping / (2.0 * (soft.stiffness * mass).sqrt())
        };
        assert_relative_eq!(part(1e4), REGULARISED_DAMPING, max_relative = 1e-12);
        let own = |damping: f64| damping / (2.0 * (weight / 0.01 * mass).sqrt());
        assert_relative_eq!(part(100.0), own(100.0), max_relative = 1e-12);
        assert_eq!(part(0.0), 0.0);
        assert_relative_eq!(part(1e6), own(1e6 * weight / 0.01 / 1e6), max_relative = 1e-12);
    }

    #[test]
    fn a_mesh_that_softens_nothing_leaves_the_damper_as_given() {
        let fine = regularised(GIVEN, [500.0, 1e9], 1e-3);
        assert_eq!(fine, GIVEN);
    }

    #[test]
    fn a_soft_bed_is_never_stiffened() {
        let soft = ContactCoefficients {
            stiffness: 1.0,
            damping: 0.0,
        };
        assert_eq!(regularised(soft, [500.0, 60.0], 4.0), soft);
    }
}
