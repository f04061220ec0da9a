//! Seabed under a line.

use std::sync::Arc;

use super::Layout;
use crate::math::lanes::{Lanes, Vectors};
use crate::math::striping::{Column, Field, Striping};
use crate::model::{Contact, Seabed};
use crate::physics::friction::Friction;
use crate::physics::ground::{Cell, Ground};
use crate::physics::seabed::Part;

/// Contact with the seabed.
#[derive(Debug, Clone)]
pub struct ContactArrays {
    /// z below which contact acts on the nodes [m]; for a seabed with a slope, soundings or friction, the height above it along its normal.
    pub level: Column,
    /// Stiffness of the segments [N/m].
    pub stiffness: Column,
    /// Damping of the segments [N s/m].
    pub damping: Column,
    /// Inverse masses of the segments across the line [1/kg].
    pub yields: Column,
    /// Force on the nodes over the step, at zero velocity [N].
    pub spring: Column,
    /// Decrease of that force with the velocity at which the nodes leave the seabed [N s/m].
    pub resistance: Column,
    /// Parts of a segment at which contact acts.
    pub parts: &'static [Part; 4],
    /// Seabed with a slope, soundings or friction; `None` for a level plane without friction.
    pub seabed: Option<SeabedArrays>,
}

/// Seabed with a slope, soundings or friction.
#[derive(Debug, Clone)]
pub struct SeabedArrays {
    pub seabed: Arc<Seabed>,
    /// Cells of the soundings under the nodes, row by row, each kept until a node leaves it; empty for a plane.
    pub cells: Vec<Cell<Lanes>>,
    /// Stiffness of sticking nodes along the seabed [N/m]; 0 without friction.
    pub stick: Column,
    /// Friction on the nodes in the last step [N].
    pub friction: Field,
    /// Normals at the nodes at t_n [-]; zero in rows above the highest point of the seabed.
    pub normal: Field,
    /// Penetrations of the nodes at t_n [m]; upper bounds in rows above the highest point of the seabed.
    pub penetration: Column,
    /// Velocities at which the nodes leave the seabed [m/s].
    pub rise: Column,
}

impl ContactArrays {
    pub(super) fn new(contact: &Contact, striping: Striping) -> ContactArrays {
        let lifts = || (0..contact.level.len()).map(|i| contact.lift(i)).collect();
        let seabed = contact.seabed.as_ref();
        let level: Vec<f64> = seabed.map_or_else(|| contact.level.clone(), |_| lifts());
        let keep = |values: &[f64]| striping.column(values, 0.0);
        ContactArrays {
            seabed: seabed.map(|seabed| SeabedArrays {
                seabed: seabed.clone(),
                cells: match seabed.ground {
                    Ground::Plane { .. } => Vec::new(),
                    Ground::Grid(_) => vec![Cell::nowhere(); striping.rows() + 2],
                },
                stick: keep(&contact.stick),
                friction: Field::zeros(striping),
                normal: Field::zeros(striping),
                penetration: Column::new(striping, 0.0),
                rise: Column::new(striping, 0.0),
            }),
            level: keep(&level),
            stiffness: keep(&contact.stiffness),
            damping: keep(&contact.damping),
            yields: keep(&contact.mass.iter().map(|mass| 1.0 / mass).collect::<Vec<_>>()),
            spring: Column::new(striping, 0.0),
            resistance: Column::new(striping, 0.0),
            parts: contact.parts(),
        }
    }
}

impl Layout {
    /// Seabed; `None` if it is a level plane without friction.
    pub fn seabed(&self) -> Option<&SeabedArrays> {
        self.contact.as_ref()?.seabed.as_ref()
    }

    /// Shape of the seabed; `None` if it is a level plane without friction.
    #[inline(always)]
    pub fn ground(&self) -> Option<&Ground> {
        Some(&self.seabed()?.seabed.ground)
    }

    /// Friction of the seabed.
    #[inline(always)]
    pub fn friction(&self) -> Option<&Friction> {
        self.seabed()?.seabed.friction.as_ref()
    }

    /// Stores the friction on a row of nodes [N].
    #[inline(always)]
    pub fn set_friction(&mut self, at: usize, friction: Vectors) {
        if let Some(contact) = &mut self.contact
            && let Some(seabed) = &mut contact.seabed
        {
            seabed.friction.store(friction, at);
        }
    }
}
