//! A seabed that is more than a level plane without friction.

use nalgebra::Vector3;

use super::{Contact, Line, Model, PointContact};
use crate::physics::friction::Friction;
use crate::physics::ground::{Ground, Touch};
use crate::physics::seabed::{self, ContactCoefficients};

/// Shape and friction of a seabed.
#[derive(Debug, Clone, PartialEq)]
pub struct Bottom {
    /// Shape of the seabed.
    pub ground: Ground,
    /// True if the shape is a level plane.
    pub level: bool,
    /// Friction, where there is any.
    pub friction: Option<Friction>,
}

impl Bottom {
    /// Position of a node at a place [m] relative to the level from which the bed pushes it, `lift` [m] above the bed
    /// along its normal.
    pub fn touch(&self, place: Vector3<f64>, lift: f64) -> Touch {
        let touch = self.ground.touch(place);
        Touch {
            penetration: touch.penetration + lift,
            ..touch
        }
    }

    /// Velocity at which a node leaves the bed, along its normal [m/s].
    pub fn rise(&self, place: Vector3<f64>, velocity: Vector3<f64>) -> f64 {
        self.ground.normal(place.x, place.y).dot(&velocity)
    }
}

impl Contact {
    /// Height above the bed at which contact with a node begins, along the normal [m].
    pub fn lift(&self, node: usize) -> f64 {
        self.level[node] - self.bed
    }

    /// Spring and damper of a node.
    pub fn coefficients(&self, node: usize) -> ContactCoefficients {
        ContactCoefficients {
            stiffness: self.stiffness[node],
            damping: self.damping[node],
        }
    }

    /// Force of spring and damper [N] on a node at a place [m] with a velocity [m/s]; friction is not in it.
    pub fn push(&self, node: usize, place: Vector3<f64>, velocity: Vector3<f64>) -> Vector3<f64> {
        let (penetration, normal) = match &self.bottom {
            None => (self.level[node] - place.z, Vector3::z()),
            Some(bottom) => {
                let touch = bottom.touch(place, self.lift(node));
                (touch.penetration, touch.normal)
            }
        };
        let rise = normal.dot(&velocity);
        seabed::normal_force(self.coefficients(node), penetration, rise) * normal
    }

    /// z of the bed under a place [m].
    pub fn height_under(&self, place: Vector3<f64>) -> f64 {
        match &self.bottom {
            Some(bottom) if !bottom.level => bottom.ground.height(place.x, place.y),
            _ => self.bed,
        }
    }
}

impl PointContact {
    /// Height above the bed at which contact with the point begins, along the normal [m].
    pub fn lift(&self) -> f64 {
        self.level - self.bed
    }
}

impl Line {
    /// The bed under the line, where it is more than a level plane without friction.
    pub fn bottom(&self) -> Option<(&Contact, &Bottom)> {
        let contact = self.nodes.contact.as_ref()?;
        Some((contact, contact.bottom.as_deref()?))
    }

    /// The bed under the line, where it is a level plane without friction.
    pub fn level_bed(&self) -> Option<&Contact> {
        let contact = self.nodes.contact.as_ref()?;
        contact.bottom.is_none().then_some(contact)
    }

    /// The friction under the line.
    pub fn friction(&self) -> Option<&Friction> {
        self.bottom()?.1.friction.as_ref()
    }
}

impl Model {
    /// Returns whether the seabed, if there is one, is a level plane.
    pub fn bed_is_level(&self) -> bool {
        self.bottom.as_ref().is_none_or(|bottom| bottom.level)
    }

    /// The friction of the seabed.
    pub fn friction(&self) -> Option<&Friction> {
        self.bottom.as_ref()?.friction.as_ref()
    }
}
