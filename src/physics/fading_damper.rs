//! Contact with the seabed whose damper fades in with the penetration, instead of switching on at contact.
//!
//! f = max(0, k max(p, 0) − c s(p) ż),   s = 3u² − 2u³,   u = ½ (1 + p/r) between 0 and 1,
//!
//! so that the damper is off at p = −r, fully active from p = r on, and smooth in between. A damper that switches makes Newton's method fail: an
//! iterate that lifts a node releases it, and the next falls back. r is the larger of [`damper_reach`] (two static penetrations of the node) and the
//! displacement of the node in a step. At rest the force is that of `seabed`.
//!
//! Source: the cubic step as a C¹ switch; contact as in `seabed`. Valid where `seabed` is, for r well below the length of a segment.

use super::seabed::ContactCoefficients;

/// Half the range of penetrations over which the damper fades in, relative to the static penetration of the node [-].
const DAMPER_FADE: f64 = 2.0;

/// Half the range of penetrations over which the damper of a resting node fades in [m].
pub fn damper_reach(stiffness: f64, weight: f64) -> f64 {
    if stiffness > 0.0 {
        DAMPER_FADE * weight.abs() / stiffness
    } else {
        0.0
    }
}

/// s [-] at a penetration [m] and its slope [1/m].
#[inline(always)]
pub fn fade(penetration: f64, reach: f64) -> (f64, f64) {
    if reach <= 0.0 {
        return (f64::from(u8::from(penetration > 0.0)), 0.0);
    }
    let u = (0.5 * (penetration / reach + 1.0)).clamp(0.0, 1.0);
    (u * u * (3.0 - 2.0 * u), 3.0 * u * (1.0 - u) / reach)
}

/// Action on a node of a seabed with a fading damper.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FadingContact {
    /// Upward force [N].
    pub force: f64,
    /// Slope of the force with respect to penetration [N/m].
    pub stiffness: f64,
    /// Negative slope of the force with respect to ż [N s/m].
    pub damping: f64,
}

impl FadingContact {
    /// Contact at a penetration [m] and vertical velocity ż [m/s], with the damper fading in over ± `reach` [m]; `None`
    /// where the seabed does not act.
    #[inline(always)]
    pub fn new(k: ContactCoefficients, penetration: f64, velocity: f64, reach: f64) -> Option<FadingContact> {
        if penetration <= -reach {
            return None;
        }
        let (fade, slope) = fade(penetration, reach);
        let spring = if penetration > 0.0 { k.stiffness } else { 0.0 };
        let force = spring * penetration - k.damping * fade * velocity;
        (force > 0.0).then_some(FadingContact {
            force,
            stiffness: spring - k.damping * slope * velocity,
            damping: k.damping * fade,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::central;
    use crate::physics::seabed::normal_force;
    use approx::assert_relative_eq;

    const K: ContactCoefficients = ContactCoefficients {
        stiffness: 1e4,
        damping: 2e3,
    };
    const REACH: f64 = 0.01;

    fn force(penetration: f64, velocity: f64) -> f64 {
        FadingContact::new(K, penetration, velocity, REACH).map_or(0.0, |seabed| seabed.force)
    }

    #[test]
    fn the_damper_is_off_above_its_reach_and_whole_below() {
        assert_relative_eq!(damper_reach(K.stiffness, 50.0), REACH);
        assert_eq!(FadingContact::new(K, -REACH, -1.0, REACH), None);
        for penetration in [1.001 * REACH, 3.0 * REACH] {
            let whole = normal_force(K, penetration, -0.1);
            assert_relative_eq!(force(penetration, -0.1), whole, max_relative = 1e-12);
        }
        assert_eq!(fade(1e-9, 0.0), (1.0, 0.0));
        assert_eq!(fade(-1e-9, 0.0), (0.0, 0.0));
    }

    #[test]
    fn it_never_pulls_and_rests_as_without_a_damper() {
        assert_eq!(FadingContact::new(K, 0.5 * REACH, 1.0, REACH), None);
        assert_relative_eq!(force(0.5 * REACH, 0.0), 0.5 * REACH * K.stiffness);
    }

    #[test]
    fn the_slopes_equal_central_differences() {
        for penetration in [-0.5 * REACH, 0.3 * REACH, 3.0 * REACH] {
            let at = FadingContact::new(K, penetration, -0.1, REACH).expect("it pushes");
            let stiffness = central(1e-8, |h| force(penetration + h, -0.1));
            let damping = -central(1e-8, |h| force(penetration, -0.1 + h));
            assert_relative_eq!(stiffness, at.stiffness, max_relative = 1e-5);
            assert_relative_eq!(damping, at.damping, max_relative = 1e-5);
        }
    }
}
