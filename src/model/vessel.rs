//! A vessel: a rigid frame that the host moves, and the points that it carries.

use nalgebra::{UnitQuaternion, Vector3};

use super::{Kinematics, Motion, Pose};
use crate::math::attitude::{Attitude, Order};

/// Frame that carries points.
#[derive(Debug, Clone)]
pub struct Vessel {
    /// Name.
    pub name: String,
    /// Reference position of its origin [m].
    pub position: Vector3<f64>,
    /// Reference roll, pitch and yaw [rad].
    pub attitude: Vector3<f64>,
    /// Points that it carries.
    pub points: Vec<usize>,
    /// Networks with a line that ends at one of these points.
    pub networks: Vec<usize>,
    /// Motion given by the scene.
    motion: Option<Motion>,
    /// Order of the angles of that motion.
    order: Order,
    /// Rotation [-] from body axes to global ones in the reference attitude, a unit quaternion.
    reference_rotation: UnitQuaternion<f64>,
}

/// Position and motion of a vessel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Origin of the vessel.
    pub origin: Kinematics,
    /// Attitude and angular velocity of the vessel.
    pub attitude: Attitude,
}

impl Vessel {
    /// Vessel at a reference position [m], with reference roll, pitch and yaw [rad].
    pub fn new(
        name: String,
        position: Vector3<f64>,
        attitude: Vector3<f64>,
        motion: Option<(Motion, Order)>,
    ) -> Vessel {
        let (motion, order) = motion.unzip();
        Vessel {
            name,
            position,
            attitude,
            points: Vec::new(),
            networks: Vec::new(),
            motion,
            order: order.unwrap_or_default(),
            reference_rotation: Order::Zyx.rotation(attitude),
        }
    }

    /// Motion given by the scene, if any.
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// Frame displaced by a pose of a host: x, y, z [m] from the reference position; roll, pitch and yaw [rad] in the
    /// order Z-Y-X, added to the reference angles.
    pub fn frame(&self, pose: &Pose) -> Frame {
        self.turned(Order::Zyx, self.attitude, pose)
    }

    /// Frame displaced by a pose of the scene's motion. The angles of the pose, and the reference angles to which they are added, have the order
    /// of that motion, Z-Y-X or X-Y-Z.
    pub fn frame_of_motion(&self, pose: &Pose) -> Frame {
        let reference = match self.order {
            Order::Zyx => self.attitude,
            order => order.angles(&self.reference_rotation, self.attitude),
        };
        self.turned(self.order, reference, pose)
    }

    /// Displacement [m] and angles [rad] of a host that are equivalent to this pose and frame of the scene's motion.
    pub fn pose_for_host(&self, pose: &Pose, frame: &Frame) -> [f64; 6] {
        let mut value = pose.value;
        if self.order != Order::Zyx {
            let near = self.attitude + value.fixed_rows::<3>(3);
            let angles = Order::Zyx.angles(&frame.attitude.rotation, near);
            value.fixed_rows_mut::<3>(3).copy_from(&(angles - self.attitude));
        }
        value.into()
    }

    fn turned(&self, order: Order, reference: Vector3<f64>, pose: &Pose) -> Frame {
        let turn = |six: &nalgebra::Vector6<f64>| Vector3::new(six[3], six[4], six[5]);
        let moved = pose.kinematics();
        Frame {
            origin: Kinematics {
                position: self.position + moved.position,
                ..moved
            },
            attitude: Attitude::new(
                order,
                reference + turn(&pose.value),
                turn(&pose.rate),
                turn(&pose.acceleration),
            ),
        }
    }

    /// Position [m] of a point of the body at `arm` [m] in body axes, with the vessel at its reference position and attitude.
    pub fn reference_place(&self, arm: Vector3<f64>) -> Vector3<f64> {
        self.position + self.reference_rotation * arm
    }

    /// Kinematics of a point of the body at `arm` [m] in body axes; its orientation is relative to the reference attitude.
    pub fn carry(&self, frame: &Frame, arm: Vector3<f64>) -> Kinematics {
        let Frame { origin, attitude } = frame;
        let arm = attitude.rotation * arm;
        let swing = attitude.spin.cross(&arm);
        Kinematics {
            position: origin.position + arm,
            velocity: origin.velocity + swing,
            acceleration: origin.acceleration + attitude.spin_rate.cross(&arm) + attitude.spin.cross(&swing),
            orientation: attitude.rotation * self.reference_rotation.inverse(),
            spin: attitude.spin,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Vector6;

    fn vessel() -> Vessel {
        Vessel::new(
            "platform".into(),
            Vector3::new(100.0, -20.0, 3.0),
            Vector3::new(0.0, 0.1, 0.8),
            None,
        )
    }

    fn pose(t: f64) -> Pose {
        let rate = Vector6::new(0.3, -0.2, 0.5, 0.4, 0.1, -0.3);
        Pose {
            value: t * rate,
            rate,
            acceleration: Vector6::zeros(),
        }
    }

    #[test]
    fn a_carried_point_moves_as_its_place_changes() {
        let (vessel, arm, h) = (vessel(), Vector3::new(30.0, 5.0, -12.0), 1e-4);
        let at = |t: f64| vessel.carry(&vessel.frame(&pose(t)), arm);
        let [low, now, high] = [-h, 0.0, h].map(at);
        let (velocity, acceleration) = (
            (high.position - low.position) / (2.0 * h),
            (high.velocity - low.velocity) / (2.0 * h),
        );
        assert_relative_eq!(now.position, vessel.reference_place(arm), epsilon = 1e-12);
        assert_relative_eq!(now.velocity, velocity, epsilon = 1e-6);
        assert_relative_eq!(now.acceleration, acceleration, epsilon = 1e-6);
        assert_relative_eq!(now.orientation.angle(), 0.0, epsilon = 1e-7);
    }
}
