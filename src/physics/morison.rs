//! Morison drag and added mass on a slender cylinder.
//!
//! f = −K_n |u_n| u_n − K_t |u_t| u_t,  K_n = ½ρ d C_dn,  K_t = ½ρ π d C_dt,
//!
//! with u the line's velocity relative to the water, split along the tangent t: u_t = (u·t) t, u_n = u − u_t.
//! The added mass is ρA·C_an across and ρA·C_at along the line, so that a node's mass is M_n I + (M_t − M_n) t tᵀ.
//!
//! Source: Morison, O'Brien, Johnson & Schaaf (1950), J. Petroleum Technology 2(5), 149-154, in the vector form of
//! Hall & Goupee (2015), Ocean Engineering 104, 590-603, section 2. Valid for d ≪ wavelength. The slope of |u|u at u = 0
//! is 0 and continuous.

use nalgebra::{Matrix3, Vector3};

use crate::math::real::{Real, RealVector};

/// Lumped coefficients of a node: K times the node's length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DragCoefficients<R = f64> {
    /// ½ρ d C_dn times length [N s²/m²].
    pub normal: R,
    /// ½ρ π d C_dt times length [N s²/m²].
    pub tangent: R,
}

impl DragCoefficients {
    /// These coefficients times a factor [-].
    #[inline]
    pub fn times(self, factor: f64) -> DragCoefficients {
        DragCoefficients {
            normal: factor * self.normal,
            tangent: factor * self.tangent,
        }
    }
}

/// Drag coefficients K_n, K_t per unstretched length [N s²/m³] of a line of diameter d [m] in water of density ρ [kg/m³].
pub fn drag_per_length(
    density: f64,
    diameter: f64,
    drag_normal: f64,
    drag_tangential: f64,
) -> DragCoefficients {
    let half_rho_d = 0.5 * density * diameter;
    DragCoefficients {
        normal: half_rho_d * drag_normal,
        tangent: half_rho_d * std::f64::consts::PI * drag_tangential,
    }
}

impl<R: Real> DragCoefficients<R> {
    /// Resistance −f [N] of a node that moves at the velocity `relative` [m/s] to the water. `chord` [m] points along the line and `inverse_square`
    /// [1/m²] is the inverse of its square, so that a kernel needs no unit tangent.
    #[inline(always)]
    pub fn resistance<V: RealVector<Real = R>>(self, relative: V, chord: V, inverse_square: R) -> V {
        let along = relative.inner(chord); // u·c
        let part = along * inverse_square;
        let across = relative - chord.scaled(part);
        let normal = self.normal * across.inner(across).sqrt();
        let tangent = self.tangent * (along.abs() * inverse_square.sqrt()) * part;
        across.scaled(normal) + chord.scaled(tangent)
    }
}

/// Drag force [N] on a node that moves with `velocity` [m/s] relative to the water, for the unit `tangent`.
#[inline(always)]
pub fn drag(k: DragCoefficients, velocity: Vector3<f64>, tangent: Vector3<f64>) -> Vector3<f64> {
    -k.resistance(velocity, tangent, 1.0)
}

/// Slope −∂f/∂u of [`drag`] [N s/m]: symmetric, positive semi-definite.
#[inline(always)]
pub fn drag_slope(k: DragCoefficients, velocity: Vector3<f64>, tangent: Vector3<f64>) -> Matrix3<f64> {
    let along = velocity.dot(&tangent);
    let across = velocity - along * tangent;
    let speed = across.norm();
    let tt = tangent * tangent.transpose();
    let mut slope = 2.0 * k.tangent * along.abs() * tt;
    if speed > 0.0 {
        slope +=
            k.normal * speed * (Matrix3::identity() - tt) + (k.normal / speed) * across * across.transpose();
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::assert_columns;
    use approx::assert_relative_eq;

    const K: DragCoefficients = DragCoefficients {
        normal: 3.0,
        tangent: 0.7,
    };

    #[test]
    fn slope_equals_central_differences() {
        let tangent = Vector3::new(0.6, 0.0, 0.8);
        let velocity = Vector3::new(0.3, -1.2, 0.5);
        let slope = drag_slope(K, velocity, tangent);
        assert_columns(&slope, 1e-6, 1e-8, |by| -drag(K, velocity + by, tangent));
    }

    #[test]
    fn drag_takes_energy_and_vanishes_at_rest() {
        let tangent = Vector3::new(0.0, 1.0, 0.0);
        let velocity = Vector3::new(1.0, 2.0, -3.0);
        assert!(drag(K, velocity, tangent).dot(&velocity) < 0.0);
        assert_eq!(drag(K, Vector3::zeros(), tangent), Vector3::zeros());
        assert_eq!(drag_slope(K, Vector3::zeros(), tangent), Matrix3::zeros());
    }

    #[test]
    fn a_cylinder_across_the_flow_feels_half_rho_d_c_u_squared() {
        let k = drag_per_length(1025.0, 0.1, 1.2, 0.0);
        let force = drag(k, Vector3::new(2.0, 0.0, 0.0), Vector3::z());
        assert_relative_eq!(force.x, -0.5 * 1025.0 * 0.1 * 1.2 * 4.0, max_relative = 1e-15);
    }
}
