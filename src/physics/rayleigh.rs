//! Rayleigh damping from two damping ratios.
//!
//! C = α M + β K gives the ratio ζ(ω) = α/(2ω) + βω/2. With ζ₁ at ω₁ and ζ₂ at ω₂:
//! α = 2ω₁ω₂(ζ₁ω₂ − ζ₂ω₁)/(ω₂² − ω₁²), β = 2(ζ₂ω₂ − ζ₁ω₁)/(ω₂² − ω₁²).
//!
//! Source: Clough & Penzien (1993), Dynamics of Structures, eq. 12-40 to 12-43. K is the material stiffness EA of the
//! segments (β·EA adds to BA): damping on the geometric stiffness would resist rigid rotation.

/// Coefficients of C = α M + β K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayleighCoefficients {
    /// α [1/s].
    pub mass: f64,
    /// β [s].
    pub stiffness: f64,
}

/// α and β from `ratios` [-] at the circular `frequencies` [rad/s], which must differ.
pub fn coefficients(ratios: [f64; 2], frequencies: [f64; 2]) -> RayleighCoefficients {
    let ([z1, z2], [w1, w2]) = (ratios, frequencies);
    let scale = 2.0 / (w2 * w2 - w1 * w1);
    RayleighCoefficients {
        mass: scale * w1 * w2 * (z1 * w2 - z2 * w1),
        stiffness: scale * (z2 * w2 - z1 * w1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn both_ratios_are_met() {
        let c = coefficients([0.05, 0.02], [3.0, 11.0]);
        for (ratio, w) in [(0.05, 3.0), (0.02, 11.0)] {
            assert_relative_eq!(0.5 * (c.mass / w + c.stiffness * w), ratio, max_relative = 1e-14);
        }
    }
}
