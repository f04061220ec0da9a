//! A seabed that is more than a level plane without friction.

use nalgebra::{Matrix3, Vector3};

use super::{Contact, Line, Model, PointContact};
use crate::physics::friction::Friction;
use crate::physics::ground::{Ground, Touch};
use crate::physics::seabed::{self, ContactCoefficients, ENDS, PARTS, Part};

/// Shape and friction of a seabed.
#[derive(Debug, Clone, PartialEq)]
pub struct Seabed {
    /// Shape of the seabed.
    pub ground: Ground,
    /// True if the shape is a level plane.
    pub level: bool,
    /// Friction, if there is any.
    pub friction: Option<Friction>,
}

impl Seabed {
    /// Position of a node at a place [m] relative to the level at which contact begins, `lift` [m] above the seabed along its
    /// normal.
    pub fn touch(&self, place: Vector3<f64>, lift: f64) -> Touch {
        let touch = self.ground.touch(place);
        Touch {
            penetration: touch.penetration + lift,
            ..touch
        }
    }

    /// Velocity at which a node leaves the seabed, along its normal [m/s].
    pub fn rise(&self, place: Vector3<f64>, velocity: Vector3<f64>) -> f64 {
        self.ground.normal(place.x, place.y).dot(&velocity)
    }
}

impl Contact {
    /// Height above the seabed at which contact with a node begins, along the normal [m].
    pub fn lift(&self, node: usize) -> f64 {
        self.level[node] - self.seabed_level
    }

    /// Spring and damper of a segment.
    pub fn coefficients(&self, segment: usize) -> ContactCoefficients {
        ContactCoefficients {
            stiffness: self.stiffness[segment],
            damping: self.damping[segment],
        }
    }

    /// Parts of a segment at which contact acts.
    pub fn parts(&self) -> &'static [Part; 4] {
        match self.at_nodes {
            true => &ENDS,
            false => &PARTS,
        }
    }

    /// Half of the stiffnesses of the segments next to a node [N/m].
    pub fn stiffness_under(&self, node: usize) -> f64 {
        let adjacent = self.adjacent(node);
        adjacent.map(|(segment, _)| 0.5 * self.stiffness[segment]).sum()
    }

    /// Segments next to a node, each with the node at its other end.
    pub fn adjacent(&self, node: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
        let before = node.checked_sub(1).map(|segment| (segment, segment));
        let after = (node < self.stiffness.len()).then_some((node, node + 1));
        before.into_iter().chain(after)
    }

    /// Position of a node at a place [m] relative to the level at which contact begins.
    pub fn touch(&self, node: usize, place: Vector3<f64>) -> Touch {
        match &self.seabed {
            Some(seabed) => seabed.touch(place, self.lift(node)),
            None => Touch {
                penetration: self.level[node] - place.z,
                normal: Vector3::z(),
                slope: -Vector3::z(),
                turning: Matrix3::zeros(),
            },
        }
    }

    /// Penetration of a node at a place [m] and the normal of the seabed there [-].
    pub fn stand(&self, node: usize, place: Vector3<f64>) -> (f64, Vector3<f64>) {
        match &self.seabed {
            Some(seabed) => {
                let (below, normal) = seabed.ground.stand(place);
                (below + self.lift(node), normal)
            }
            None => (self.level[node] - place.z, Vector3::z()),
        }
    }

    /// Force of springs and dampers [N] on a node, without friction, of a line with nodes at places [m] with velocities [m/s].
    pub fn push(
        &self,
        node: usize,
        place: &[Vector3<f64>],
        velocity: impl Fn(usize) -> Vector3<f64>,
    ) -> Vector3<f64> {
        let depth = |node: usize| {
            let (penetration, normal) = self.stand(node, place[node]);
            (penetration, normal.dot(&velocity(node)), normal)
        };
        let (near, rise, normal) = depth(node);
        let mut force = 0.0;
        for (segment, other) in self.adjacent(node) {
            let (k, (far, far_rise, _)) = (self.coefficients(segment), depth(other));
            for part in self.parts() {
                let at = [part.between(near, far), part.between(rise, far_rise)];
                force += part.shares[0] * seabed::normal_force(k, at[0], at[1]);
            }
        }
        force * normal
    }

    /// Part of the weight of a segment across the seabed that the springs carry [-], with the nodes of the line at places [m].
    pub fn laid_part(&self, segment: usize, place: &[Vector3<f64>]) -> f64 {
        if self.weight[segment] <= 0.0 {
            return 0.0;
        }
        let [(near, low), (far, high)] = [segment, segment + 1].map(|node| self.stand(node, place[node]));
        let (weight, stiffness) = (
            self.weight[segment] * 0.5 * (low.z + high.z),
            self.stiffness[segment],
        );
        let carried = |part: &Part| (stiffness * part.between(near, far) / weight).clamp(0.0, 1.0);
        0.25 * self.parts().iter().map(carried).sum::<f64>()
    }

    /// Load of a segment of a length [m] on soundings that it touches or nearly touches, under a tension [N] in a line at rest with nodes at places [m]:
    /// the weight, and the pull against the curvature of the ground, over an element to either side [N]. It is not negative, and the weight elsewhere.
    pub fn load_at_rest(&self, segment: usize, length: f64, place: &[Vector3<f64>], tension: f64) -> f64 {
        let weight = self.weight[segment];
        let ground = self.seabed.as_ref().map(|seabed| &seabed.ground);
        let Some(ground @ Ground::Grid(_)) = ground.filter(|_| weight > 0.0) else {
            return weight;
        };
        let ends = [place[segment], place[segment + 1]];
        let depths = [segment, segment + 1].map(|node| self.stand(node, place[node]).0);
        if depths[0].max(depths[1]) < -weight / self.stiffness[segment] {
            return weight;
        }
        let along = (ends[1] - ends[0]).xy().try_normalize(0.0).unwrap_or_default();
        let curvature = ground.curvature(0.5 * (ends[0] + ends[1]), length * along);
        (weight + tension * curvature * length).max(0.0)
    }

    /// z of the seabed under a place [m].
    pub fn height_under(&self, place: Vector3<f64>) -> f64 {
        match &self.seabed {
            Some(seabed) if !seabed.level => seabed.ground.height(place.x, place.y),
            _ => self.seabed_level,
        }
    }
}

impl PointContact {
    /// Height above the seabed at which contact with the point begins, along the normal [m].
    pub fn lift(&self) -> f64 {
        self.level - self.seabed_level
    }
}

impl Line {
    /// Contact and seabed of the line, if the seabed is more than a level plane without friction.
    pub fn seabed(&self) -> Option<(&Contact, &Seabed)> {
        let contact = self.nodes.contact.as_ref()?;
        Some((contact, contact.seabed.as_deref()?))
    }

    /// Friction of the seabed under the line, if there is any.
    pub fn friction(&self) -> Option<&Friction> {
        self.seabed()?.1.friction.as_ref()
    }
}

impl Model {
    /// Returns whether the seabed, if there is one, is a level plane.
    pub fn seabed_is_level(&self) -> bool {
        self.seabed.as_ref().is_none_or(|seabed| seabed.level)
    }

    /// Friction of the seabed, if there is any.
    pub fn friction(&self) -> Option<&Friction> {
        self.seabed.as_ref()?.friction.as_ref()
    }
}
