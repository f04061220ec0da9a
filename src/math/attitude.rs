//! Attitude of a rigid body by roll, pitch and yaw, with its angular velocity and acceleration.
//!
//! R = R_z(ψ) R_y(θ) R_x(φ) (Z-Y'-X'') takes body axes to global ones; in the other order R = R_x(φ) R_y(θ) R_z(ψ) (X-Y'-Z''). With the rotation axes
//! of the first order, u_ψ = ẑ, u_θ = R_z ŷ and u_φ = R_z R_y x̂, the angular velocity in global axes is
//!
//!   ω = ψ̇ u_ψ + θ̇ u_θ + φ̇ u_φ,   ω̇ = ψ̈ u_ψ + θ̈ u_θ + φ̈ u_φ + θ̇ ψ̇ u_ψ × u_θ + φ̇ (ψ̇ u_ψ + θ̇ u_θ) × u_φ,
//!
//! and in the second order the same with φ and ψ exchanged, u_φ = x̂, u_θ = R_x ŷ and u_ψ = R_x R_y ẑ.
//!
//! Source: Fossen (2011), Handbook of Marine Craft Hydrodynamics and Motion Control, section 2.2. Where |θ| = π/2 the rates of the first and the
//! last angle are not unique.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// Order of the rotations by roll, pitch and yaw, from body axes to global axes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// R = R_z(yaw) R_y(pitch) R_x(roll), the order of the FMU's variables.
    #[default]
    Zyx,
    /// R = R_x(roll) R_y(pitch) R_z(yaw), the order of MoorDyn.
    Xyz,
}

impl Order {
    /// Returns whether it is the order of the FMU's variables.
    pub fn is_zyx(&self) -> bool {
        *self == Order::Zyx
    }

    /// Indices of the rotation axes (x, y, z = 0, 1, 2), from the outermost rotation to the innermost.
    fn sequence(self) -> [usize; 3] {
        match self {
            Order::Zyx => [2, 1, 0],
            Order::Xyz => [0, 1, 2],
        }
    }

    /// Rotation from body axes to global axes by roll, pitch and yaw [rad].
    pub fn rotation(self, angles: Vector3<f64>) -> UnitQuaternion<f64> {
        match self {
            Order::Zyx => UnitQuaternion::from_euler_angles(angles.x, angles.y, angles.z),
            Order::Xyz => {
                let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
                about(Vector3::x_axis(), angles.x)
                    * about(Vector3::y_axis(), angles.y)
                    * about(Vector3::z_axis(), angles.z)
            }
        }
    }

    /// Roll, pitch and yaw [rad] of a rotation, each shifted by whole turns to the value nearest to `near` [rad].
    pub fn angles(self, rotation: &UnitQuaternion<f64>, near: Vector3<f64>) -> Vector3<f64> {
        let angles = match self {
            Order::Zyx => {
                let (roll, pitch, yaw) = rotation.euler_angles();
                Vector3::new(roll, pitch, yaw)
            }
            // the transpose of R_x(φ) R_y(θ) R_z(ψ) is R_z(−ψ) R_y(−θ) R_x(−φ)
            Order::Xyz => {
                let (roll, pitch, yaw) = rotation.inverse().euler_angles();
                -Vector3::new(roll, pitch, yaw)
            }
        };
        angles.zip_map(&near, |angle, near| angle + TAU * ((near - angle) / TAU).round())
    }
}

/// Attitude of a body with its rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attitude {
    /// Rotation from body axes to global axes.
    pub rotation: UnitQuaternion<f64>,
    /// Angular velocity ω in global axes [rad/s].
    pub spin: Vector3<f64>,
    /// Angular acceleration ω̇ in global axes [rad/s²].
    pub spin_rate: Vector3<f64>,
}

impl Attitude {
    /// Attitude from roll, pitch and yaw [rad] in the given order, their rates [rad/s] and second derivatives [rad/s²].
    pub fn new(order: Order, angles: Vector3<f64>, rates: Vector3<f64>, seconds: Vector3<f64>) -> Attitude {
        let axes = axes(order, angles);
        let sequence = order.sequence();
        let [outer, middle, inner] = sequence.map(|i| axes.column(i).into_owned());
        let [outer_rate, middle_rate, inner_rate] = sequence.map(|i| rates[i]);
        Attitude {
            rotation: order.rotation(angles),
            spin: axes * rates,
            spin_rate: axes * seconds
                + middle_rate * outer_rate * outer.cross(&middle)
                + inner_rate * (outer_rate * outer + middle_rate * middle).cross(&inner),
        }
    }
}

/// Rates of roll, pitch and yaw [rad/s], in the order Z-Y'-X'', of a body with these angles [rad] and the angular velocity `spin` [rad/s] in global
/// axes; `None` where pitch is a right angle.
pub fn angle_rates(angles: Vector3<f64>, spin: Vector3<f64>) -> Option<Vector3<f64>> {
    let axes = axes(Order::Zyx, angles);
    (axes.determinant().abs() > 1e-9)
        .then(|| axes.try_inverse().map(|inverse| inverse * spin))
        .flatten()
}

/// Axes of rotation of roll, pitch and yaw, as columns.
fn axes(order: Order, angles: Vector3<f64>) -> Matrix3<f64> {
    let [(sin_r, cos_r), (sin_p, cos_p), (sin_y, cos_y)] = [angles.x, angles.y, angles.z].map(f64::sin_cos);
    match order {
        Order::Zyx => {
            let roll = Vector3::new(cos_y * cos_p, sin_y * cos_p, -sin_p);
            let pitch = Vector3::new(-sin_y, cos_y, 0.0);
            Matrix3::from_columns(&[roll, pitch, Vector3::z()])
        }
        Order::Xyz => {
            let pitch = Vector3::new(0.0, cos_r, sin_r);
            let yaw = Vector3::new(sin_p, -sin_r * cos_p, cos_r * cos_p);
            Matrix3::from_columns(&[Vector3::x(), pitch, yaw])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const ANGLES: [f64; 3] = [0.3, -0.4, 1.1];
    const RATES: [f64; 3] = [0.7, 0.2, -0.5];
    const SECONDS: [f64; 3] = [-0.1, 0.6, 0.4];

    const ORDERS: [Order; 2] = [Order::Zyx, Order::Xyz];

    /// Attitude `t` [s] after the one given by the constants.
    fn after(order: Order, t: f64) -> Attitude {
        let [a, b, c] = [ANGLES, RATES, SECONDS].map(Vector3::from);
        Attitude::new(order, a + t * b + 0.5 * t * t * c, b + t * c, c)
    }

    #[test]
    fn spin_is_the_rate_of_the_rotation() {
        let h = 1e-4;
        for order in ORDERS {
            let turned = after(order, h).rotation * after(order, -h).rotation.inverse();
            assert_relative_eq!(
                turned.scaled_axis() / (2.0 * h),
                after(order, 0.0).spin,
                epsilon = 1e-7
            );
        }
    }

    #[test]
    fn spin_rate_is_the_rate_of_spin() {
        let h = 1e-4;
        for order in ORDERS {
            let slope = (after(order, h).spin - after(order, -h).spin) / (2.0 * h);
            assert_relative_eq!(slope, after(order, 0.0).spin_rate, epsilon = 1e-7);
        }
    }

    #[test]
    fn the_two_orders_are_products_of_the_same_rotations() {
        let [roll, pitch, yaw] = ANGLES;
        let about = |axis: Vector3<f64>, angle: f64| nalgebra::Rotation3::new(angle * axis).into_inner();
        let [x, y, z] = [
            about(Vector3::x(), roll),
            about(Vector3::y(), pitch),
            about(Vector3::z(), yaw),
        ];
        for (order, product) in [(Order::Zyx, z * y * x), (Order::Xyz, x * y * z)] {
            let rotation = order.rotation(Vector3::from(ANGLES));
            let matrix = rotation.to_rotation_matrix().into_inner();
            assert_relative_eq!(matrix, product, epsilon = 1e-14);
        }
    }

    #[test]
    fn angles_come_back_from_the_rotation_on_the_turn_that_is_near() {
        let angles = Vector3::new(2.9, -0.4, 7.5);
        for order in ORDERS {
            let found = order.angles(&order.rotation(angles), angles + Vector3::repeat(0.3));
            assert_relative_eq!(found, angles, epsilon = 1e-12);
        }
    }

    #[test]
    fn the_rates_of_the_angles_come_back_from_the_spin() {
        let spin = after(Order::Zyx, 0.0).spin;
        let rates = angle_rates(Vector3::from(ANGLES), spin).unwrap();
        assert_relative_eq!(rates, Vector3::from(RATES), epsilon = 1e-13);
        let upright = Vector3::new(0.2, std::f64::consts::FRAC_PI_2, 0.0);
        assert_eq!(angle_rates(upright, Vector3::x()), None);
    }
}
