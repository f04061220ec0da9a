//! Bending stiffness of a line type's section: as given or of its solid round section, shared by its strands.

use super::{FibreLaw, LineModel, LineType, Scene};
use crate::physics::bending::{of_strands, solid_round};

impl LineType {
    /// EI of one solid section [N m²], where there is one.
    pub fn solid_stiffness(&self) -> Option<f64> {
        let of_section = || {
            let section = self.solid_section?;
            Some(solid_round(section.diameter, section.youngs_modulus))
        };
        self.bending_stiffness.or_else(of_section)
    }

    /// EI that a cable of this type bends with [N m²]; `None` for a perfectly flexible one, and for a beam.
    pub fn cable_stiffness(&self) -> Option<f64> {
        if self.model == LineModel::Beam {
            return None;
        }
        let power = match self.fibre_law {
            FibreLaw::Linear => 1,
            FibreLaw::Squared => 2,
        };
        let strands = self.fibres.unwrap_or(1).max(1);
        let shared = of_strands(self.solid_stiffness()?, strands, power);
        (shared > 0.0).then_some(shared)
    }
}

impl Scene {
    /// Whether a line has a section with bending stiffness.
    pub(super) fn bends(&self, line: &super::Line) -> bool {
        let types = line
            .sections
            .iter()
            .filter_map(|section| self.line_types.get(&section.line_type));
        types.into_iter().any(|t| t.cable_stiffness().is_some())
    }
}
