//! Attitude of a rigid body by yaw, pitch and roll (Z-Y'-X''), and how it turns.
//!
//! R = R_z(ψ) R_y(θ) R_x(φ) takes body axes to global ones. With the axes that the angles turn about, u_ψ = ẑ, u_θ = R_z ŷ and
//! u_φ = R_z R_y x̂, the angular velocity in global axes is
//!
//!   ω = ψ̇ u_ψ + θ̇ u_θ + φ̇ u_φ,   ω̇ = ψ̈ u_ψ + θ̈ u_θ + φ̈ u_φ + θ̇ ψ̇ u_ψ × u_θ + φ̇ (ψ̇ u_ψ + θ̇ u_θ) × u_φ.
//!
//! Source: Fossen (2011), Handbook of Marine Craft Hydrodynamics and Motion Control, section 2.2. Where |θ| = π/2 the rates of yaw and roll
//! are not unique.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// A body's attitude and how it changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attitude {
    /// From body axes to global axes.
    pub rotation: UnitQuaternion<f64>,
    /// Angular velocity ω in global axes [rad/s].
    pub spin: Vector3<f64>,
    /// Angular acceleration ω̇ in global axes [rad/s²].
    pub spin_rate: Vector3<f64>,
}

impl Attitude {
    /// From roll, pitch and yaw [rad], their rates [rad/s] and second derivatives [rad/s²].
    pub fn new(angles: Vector3<f64>, rates: Vector3<f64>, seconds: Vector3<f64>) -> Attitude {
        let axes = axes(angles);
        let [roll, pitch, yaw] = [0, 1, 2].map(|i| axes.column(i).into_owned());
        Attitude {
            rotation: UnitQuaternion::from_euler_angles(angles.x, angles.y, angles.z),
            spin: axes * rates,
            spin_rate: axes * seconds
                + rates.y * rates.z * yaw.cross(&pitch)
                + rates.x * (rates.z * yaw + rates.y * pitch).cross(&roll),
        }
    }
}

/// Rates of roll, pitch and yaw [rad/s] of a body with these angles [rad] that turns by `spin` [rad/s] in global axes; `None` where
/// pitch is a right angle.
pub fn angle_rates(angles: Vector3<f64>, spin: Vector3<f64>) -> Option<Vector3<f64>> {
    let axes = axes(angles);
    (axes.determinant().abs() > 1e-9)
        .then(|| axes.try_inverse().map(|inverse| inverse * spin))
        .flatten()
}

/// Axes that roll, pitch and yaw turn about, as columns.
fn axes(angles: Vector3<f64>) -> Matrix3<f64> {
    let ((sin_p, cos_p), (sin_y, cos_y)) = (angles.y.sin_cos(), angles.z.sin_cos());
    let roll = Vector3::new(cos_y * cos_p, sin_y * cos_p, -sin_p);
    let pitch = Vector3::new(-sin_y, cos_y, 0.0);
    Matrix3::from_columns(&[roll, pitch, Vector3::z()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const ANGLES: [f64; 3] = [0.3, -0.4, 1.1];
    const RATES: [f64; 3] = [0.7, 0.2, -0.5];
    const SECONDS: [f64; 3] = [-0.1, 0.6, 0.4];

    /// The attitude `t` [s] after the one of the constants.
    fn after(t: f64) -> Attitude {
        let [a, b, c] = [ANGLES, RATES, SECONDS].map(Vector3::from);
        Attitude::new(a + t * b + 0.5 * t * t * c, b + t * c, c)
    }

    #[test]
    fn spin_is_the_rate_of_the_rotation() {
        let h = 1e-4;
        let turned = after(h).rotation * after(-h).rotation.inverse();
        assert_relative_eq!(
            turned.scaled_axis() / (2.0 * h),
            after(0.0).spin,
            epsilon = 1e-7
        );
    }

    #[test]
    fn spin_rate_is_the_rate_of_spin() {
        let h = 1e-4;
        let slope = (after(h).spin - after(-h).spin) / (2.0 * h);
        assert_relative_eq!(slope, after(0.0).spin_rate, epsilon = 1e-7);
    }

    #[test]
    fn the_rates_of_the_angles_come_back_from_the_spin() {
        let rates = angle_rates(Vector3::from(ANGLES), after(0.0).spin).unwrap();
        assert_relative_eq!(rates, Vector3::from(RATES), epsilon = 1e-13);
        let upright = Vector3::new(0.2, std::f64::consts::FRAC_PI_2, 0.0);
        assert_eq!(angle_rates(upright, Vector3::x()), None);
    }
}
