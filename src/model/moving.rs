//! Motions in the scene, in the form of a host's input at a communication point.

use super::{Body, Line, Model, Role};

/// A moving coupled point or vessel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moving {
    /// Body that moves.
    pub body: Body,
    /// Displacement [m] and angles [rad] from the reference, those of a vessel in the order Z-Y-X.
    pub pose: [f64; 6],
    /// Velocity [m/s] and angular velocity [rad/s].
    pub velocity: [f64; 6],
}

impl Model {
    /// Lengths [m] that the winches with a path in the scene have paid out at `time` [s], each with the index of its line.
    pub fn paid_out(&self, time: f64) -> Vec<(usize, f64)> {
        let path = |(line, data): (usize, &Line)| Some((line, data.winch.as_ref()?.path.as_ref()?.at(time)));
        self.lines.iter().enumerate().filter_map(path).collect()
    }

    /// Every coupled point and vessel that the scene moves, at `time` [s].
    pub fn moving(&self, time: f64) -> Vec<Moving> {
        let points = self.points.iter().enumerate();
        let points = points.filter_map(|(index, point)| match &point.role {
            Role::Coupled { motion: Some(motion) } => {
                let pose = motion.pose(time);
                Some(Moving {
                    body: Body::Point(index),
                    pose: pose.value.into(),
                    velocity: pose.rate.into(),
                })
            }
            _ => None,
        });
        let vessels = self.vessels.iter().enumerate();
        let vessels = vessels.filter_map(|(index, vessel)| {
            let pose = vessel.motion()?.pose(time);
            let frame = vessel.frame_of_motion(&pose);
            let (v, w) = (frame.origin.velocity, frame.attitude.spin);
            Some(Moving {
                body: Body::Vessel(index),
                pose: vessel.pose_for_host(&pose, &frame),
                velocity: [v.x, v.y, v.z, w.x, w.y, w.z],
            })
        });
        points.chain(vessels).collect()
    }
}
