//! The bed under a line.

use std::sync::Arc;

use nalgebra::Vector3;

use super::Layout;
use crate::math::fold::{Column, Field, Fold, Slot};
use crate::math::lanes::Lanes;
use crate::model::{Bottom, Contact};
use crate::physics::friction::Friction;

/// Lumped contact coefficients [N/m, N s/m] and the z [m] below which they push; over a bed that slopes or rubs the height above it, along its normal.
#[derive(Debug, Clone)]
pub(in crate::dynamics) struct ContactArrays {
    pub level: Column,
    pub stiffness: Column,
    pub damping: Column,
    /// Where the bed is more than a level plane without friction.
    pub bottom: Option<BottomArrays>,
}

/// A bed that slopes or rubs.
#[derive(Debug, Clone)]
pub(in crate::dynamics) struct BottomArrays {
    pub bottom: Arc<Bottom>,
    /// Stiffness along the bed of a node that sticks [N/m]; 0 without friction.
    pub stick: Column,
    /// Friction on the nodes in the last step [N].
    pub rub: Field,
}

impl ContactArrays {
    /// Stiffness [N/m] and damping [N s/m] of a row.
    #[inline(always)]
    pub fn law(&self, at: usize) -> [Lanes; 2] {
        [self.stiffness.load(at), self.damping.load(at)]
    }

    pub(super) fn new(contact: &Contact, fold: Fold) -> ContactArrays {
        let lifts = || (0..contact.level.len()).map(|i| contact.lift(i)).collect();
        let bottom = contact.bottom.as_ref();
        let level: Vec<f64> = bottom.map_or_else(|| contact.level.clone(), |_| lifts());
        let keep = |values: &[f64]| fold.column(values, 0.0);
        ContactArrays {
            bottom: bottom.map(|bottom| BottomArrays {
                bottom: bottom.clone(),
                stick: keep(&contact.stick),
                rub: Field::zeros(fold),
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

    /// The contact with a bed that slopes or rubs, and its friction.
    pub fn rubbing(&self) -> Option<(&ContactArrays, Option<&Friction>)> {
        let contact = self.contact.as_ref()?;
        let bottom = contact.bottom.as_ref()?;
        Some((contact, bottom.bottom.friction.as_ref()))
    }

    /// Remembers the friction on a node [N].
    pub fn set_rub(&mut self, at: Slot, rub: Vector3<f64>) {
        if let Some(contact) = &mut self.contact
            && let Some(bottom) = &mut contact.bottom
        {
            bottom.rub.set(at, rub);
        }
    }

    /// How far the node at `at` is below the level from which the bed pushes it [m], and the bed's normal there; it must lie over a bed that
    /// slopes or rubs.
    #[inline]
    pub fn stand(&self, at: Slot) -> (f64, Vector3<f64>) {
        let contact = self.contact.as_ref().expect("asked over a bed only");
        let bottom = contact
            .bottom
            .as_ref()
            .expect("asked over a bed that slopes or rubs only");
        let (below, normal) = bottom.bottom.ground.stand(self.position.get(at));
        (below + contact.level[at], normal)
    }
}
