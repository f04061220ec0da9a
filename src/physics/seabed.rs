//! Normal contact with a horizontal seabed: a spring and a damper that can only push, integrated along the segments of a line.
//!
//! f = max(0, k·p − c·ż) per unstretched length, for a penetration p = z_seabed − z > 0, else 0.
//!
//! A segment is straight between its nodes: p and ż are linear in ξ from 0 to 1. The integral of f over it is the sum over four equal parts, each
//! with f at its middle, and each node carries the work-equivalent share of it, Σ (1 − ξ) f h/4 and Σ ξ f h/4. A segment that is laid down therefore
//! takes up its load gradually. With contact at the nodes only, every node that lands causes an impact. The tension of a chain with 40 elements in a
//! storm then has noise of a quarter of its standard deviation, at the frequency at which nodes land.
//!
//! k = kbot·d and c = cbot·d. Regularised contact softens both together,
//!
//! k_eff = min(k, w/(δ d h)·d),    c_eff = max(c·k_eff/k, min(c, 2ζ √(k_eff m))),    m the mass across the line,
//!
//! so that a segment at rest penetrates by δ times its length h. With the usual kbot of 3 MPa/m the static penetration would be micrometres and every
//! part that lands would ring. `model/build/resting.rs` sets the level of the contact so that the suspended part is correct. A damper softened like
//! its spring becomes too weak: for the chains in the tank, 1 % of critical damping would be left. It therefore keeps the fraction ζ of the critical
//! damping 2√(k m) of a mass on a spring, unless the damping of the scene is lower. Both coefficients tend to the values of the scene as the mesh is
//! refined, and reach them where the spring does.
//!
//! Contact at the nodes only is the trapezoidal rule instead of the four parts. It is MoorDyn's law and serves for comparison with it.
//!
//! Source: the spring and damper of Hall & Goupee (2015), Ocean Engineering 104, eq. 13, made unilateral (their damper pulls on a rising node);
//! work-equivalent loads as in any finite element. Parts, δ and ζ were chosen on three chains in storms, `docs/hard-cases.md`: one or two parts are worse
//! and erratic, eight no better; δ = 0.05 is better in shallow water and worse in deep; a curved segment gains nothing.
//! Valid where penetrations are small compared with the segment length.

use crate::math::real::Real;

/// Static penetration of a resting segment under regularised contact, per segment length [-].
pub const REGULARISED_PENETRATION: f64 = 0.03;

/// Fraction of critical damping that a segment on a softened spring keeps, if its given damping is not lower [-].
const REGULARISED_DAMPING: f64 = 0.2;

/// Part of a segment, seen from one of its nodes.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// Distance of its middle from the node, per segment length [-].
    pub at: f64,
    /// Shares of the force on a uniformly loaded segment that this part adds to this node and to the other one [-].
    pub shares: [f64; 2],
}

/// Parts of a segment at which the contact is evaluated.
pub const PARTS: [Part; 4] = [part(0.125), part(0.375), part(0.625), part(0.875)];
/// Nodes of a segment, the only contact points in other codes; each occurs twice, as the end of two parts.
pub const ENDS: [Part; 4] = [part(0.0), part(0.0), part(1.0), part(1.0)];

const fn part(at: f64) -> Part {
    Part {
        at,
        shares: [0.25 * (1.0 - at), 0.25 * at],
    }
}

impl Part {
    /// Slopes of the forces on the two nodes (rows) with respect to both penetrations (columns) while this part is in contact, relative to the
    /// stiffness of the segment [-].
    #[inline(always)]
    pub fn products(self) -> [[f64; 2]; 2] {
        self.shares
            .map(|share| [share * (1.0 - self.at), share * self.at])
    }

    /// Value at the middle of the part of a quantity that is linear along the segment.
    #[inline(always)]
    pub fn between<R: Real>(self, near: R, far: R) -> R {
        near + R::splat(self.at) * (far - near)
    }
}

/// Static penetration of a point that rests with its whole weight, from which its contact stiffness follows [m].
pub const POINT_PENETRATION: f64 = 0.02;

/// Contact coefficients of a segment, or of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactCoefficients {
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
}

/// Softens the contact of a segment of `weight` [N] in water, `mass` across the line [kg], including that of the water, and `length` [m]; buoyant
/// segments are left unchanged.
pub fn regularised(
    contact: ContactCoefficients,
    [weight, mass]: [f64; 2],
    length: f64,
) -> ContactCoefficients {
    if weight <= 0.0 || contact.stiffness <= 0.0 {
        return contact;
    }
    let stiffness = contact.stiffness.min(weight / (REGULARISED_PENETRATION * length));
    let damping = contact.damping;
    let kept = 2.0 * REGULARISED_DAMPING * (stiffness * mass).sqrt();
    ContactCoefficients {
        stiffness,
        damping: (damping * stiffness / contact.stiffness).max(damping.min(kept)),
    }
}

/// Contact of a point of `weight` [N]. A point has no length or diameter to which the coefficients of the seabed could refer. Its stiffness gives a
/// penetration of [`POINT_PENETRATION`], with the seabed's ratio of damping to stiffness `lag` [s].
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
    fn the_seabed_never_pulls() {
        assert_eq!(normal_force(GIVEN, 1e-3, 1.0), 0.0);
        assert_eq!(normal_force(GIVEN, -1e-3, -1.0), 0.0);
    }

    #[test]
    fn parts_and_ends_carry_a_uniform_load_alike() {
        let nodes =
            |parts: &[Part]| [0, 1].map(|side| parts.iter().map(|part| part.shares[side]).sum::<f64>());
        assert_eq!(nodes(&PARTS), [0.5, 0.5]);
        assert_eq!(nodes(&ENDS), [0.5, 0.5]);
        assert_eq!(ENDS.map(|part| part.between(2.0, 3.0)), [2.0, 2.0, 3.0, 3.0]);
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
        let depth = REGULARISED_PENETRATION * length;
        let own = |damping: f64| damping / (2.0 * (weight / depth * mass).sqrt());
        assert_relative_eq!(part(100.0), own(100.0), max_relative = 1e-12);
        assert_eq!(part(0.0), 0.0);
        assert_relative_eq!(part(1e6), own(1e6 * weight / depth / 1e6), max_relative = 1e-12);
    }

    #[test]
    fn a_mesh_that_softens_nothing_leaves_the_damper_as_given() {
        let fine = regularised(GIVEN, [500.0, 1e9], 1e-3);
        assert_eq!(fine, GIVEN);
    }

    #[test]
    fn a_soft_seabed_is_never_stiffened() {
        let soft = ContactCoefficients {
            stiffness: 1.0,
            damping: 0.0,
        };
        assert_eq!(regularised(soft, [500.0, 60.0], 4.0), soft);
    }
}
