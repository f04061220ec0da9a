//! What a line is made of where it is a geometrically exact beam, and what of it changes.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::physics::section::{self, Section, SectionLaw, Sextuple, StrainEnergy};

/// A line as a beam: two-node elements, one per segment, and lumped rotary inertia.
#[derive(Debug, Clone)]
pub struct Beam {
    /// One per segment.
    pub elements: Vec<BeamElement>,
    /// Rotary inertia of the nodes about their three directors [kg m²].
    pub rotary_inertia: Vec<Vector3<f64>>,
    /// Direction of the line at ends A and B where they are clamped, with the point as it stands in the scene [-].
    pub clamped: [Option<Vector3<f64>>; 2],
    /// Whether the shape the line starts from is free of stress; else the straight line is.
    pub rests_as_it_starts: bool,
}

/// A two-node beam element.
#[derive(Debug, Clone, Copy)]
pub struct BeamElement {
    /// Unstretched length [m].
    pub length: f64,
    /// Stiffness of its section.
    pub law: SectionLaw,
    /// Viscous damping of its section, along the same axes.
    pub damping: SectionLaw,
}

/// State of a beam: what its nodes have beside positions and velocities.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BeamState {
    /// Orthonormal frames of the nodes, d₁ d₂ d₃ as columns [-].
    pub frames: Vec<Matrix3<f64>>,
    /// Angular velocities along those directors [rad/s].
    pub spins: Vec<Vector3<f64>>,
    /// Starred strains of the elements without stress [-], [1/m].
    pub rest: Vec<Sextuple>,
}

impl BeamElement {
    /// Strain from rest between two sections.
    #[inline(always)]
    pub fn strain(&self, a: &Section, b: &Section, rest: &Sextuple) -> Sextuple {
        section::corrected(&section::strain(a, b, self.length), self.length) - rest
    }

    /// Energy at a strain from rest.
    pub fn energy(&self, strain: &Sextuple) -> StrainEnergy {
        self.law.energy(strain, self.length)
    }
}

impl Beam {
    /// Whether neither end is held from turning about the line itself.
    pub fn turns_freely(&self) -> bool {
        self.clamped.iter().all(Option::is_none)
    }
}

impl Clone for BeamState {
    fn clone(&self) -> Self {
        BeamState {
            frames: self.frames.clone(),
            spins: self.spins.clone(),
            rest: self.rest.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.frames.clone_from(&source.frames);
        self.spins.clone_from(&source.spins);
        self.rest.clone_from(&source.rest);
    }
}
