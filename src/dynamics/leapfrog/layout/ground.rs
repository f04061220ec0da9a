//! The bed under a line.

use std::sync::Arc;

use super::Layout;
use crate::math::lanes::{Lanes, Vectors};
use crate::math::striping::{Column, Field, Striping};
use crate::model::{Bottom, Contact};
use crate::physics::friction::Friction;
use crate::physics::ground::Ground;

/// Lumped contact coefficients [N/m, N s/m] and the z [m] below which they push; over a seabed with a slope, soundings or friction the height above it, along its normal.
#[derive(Debug, Clone)]
pub struct ContactArrays {
    pub level: Column,
    pub stiffness: Column,
    pub damping: Column,
    /// The seabed where it has a slope, soundings or friction.
    pub bottom: Option<BottomArrays>,
}

/// a seabed with a slope, soundings or friction.
#[derive(Debug, Clone)]
pub struct BottomArrays {
    pub bottom: Arc<Bottom>,
    /// Stiffness along the bed of a node that sticks [N/m]; 0 without friction.
    pub stick: Column,
    /// Friction on the nodes in the last step [N].
    pub friction: Field,
}

impl ContactArrays {
    /// Stiffness [N/m] and damping [N s/m] of a row.
    #[inline(always)]
    pub fn law(&self, at: usize) -> [Lanes; 2] {
        [self.stiffness.load(at), self.damping.load(at)]
    }

    pub(super) fn new(contact: &Contact, striping: Striping) -> ContactArrays {
        let lifts = || (0..contact.level.len()).map(|i| contact.lift(i)).collect();
        let bottom = contact.bottom.as_ref();
        let level: Vec<f64> = bottom.map_or_else(|| contact.level.clone(), |_| lifts());
        let keep = |values: &[f64]| striping.column(values, 0.0);
        ContactArrays {
            bottom: bottom.map(|bottom| BottomArrays {
                bottom: bottom.clone(),
                stick: keep(&contact.stick),
                friction: Field::zeros(striping),
            }),
            level: keep(&level),
            stiffness: keep(&contact.stiffness),
            damping: keep(&contact.damping),
        }
    }
}

impl Layout {
    /// The bed, where it is more than a level plane without friction.
    pub fn bottom(&self) -> Option<&BottomArrays> {
        self.contact.as_ref()?.bottom.as_ref()
    }

    /// Shape of the seabed, where it is more than a level plane without friction.
    #[inline(always)]
    pub fn ground(&self) -> Option<&Ground> {
        Some(&self.bottom()?.bottom.ground)
    }

    /// Friction of the seabed.
    #[inline(always)]
    pub fn friction(&self) -> Option<&Friction> {
        self.bottom()?.bottom.friction.as_ref()
    }

    /// Keeps the friction on a row of nodes [N].
    #[inline(always)]
    pub fn set_friction(&mut self, at: usize, friction: Vectors) {
        if let Some(contact) = &mut self.contact
            && let Some(bottom) = &mut contact.bottom
        {
            bottom.friction.store(friction, at);
        }
    }
}
