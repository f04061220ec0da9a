//! Line ends that are released from their points: unknowns of their line, solved with it.

use nalgebra::{Matrix3, Vector3};

use super::LineWork;
use crate::math::block_banded::Ends;

/// Equations of a line condensed on its ends, for the released ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Released {
    ends: Ends,
    /// (aa)⁻¹ and (bb)⁻¹ of the ends at their elimination.
    inverse: [Matrix3<f64>; 2],
}

impl LineWork {
    /// Eliminates released ends from the condensed equations of the line; `None` if a block cannot be inverted.
    pub(super) fn eliminate_released(&mut self, mut ends: Ends) -> Option<Ends> {
        if self.released == [false; 2] {
            return Some(ends);
        }
        let mut inverse = [Matrix3::zeros(); 2];
        if self.released[1] {
            inverse[1] = ends.bb.try_inverse()?;
            ends.aa -= ends.ab * inverse[1] * ends.ba;
            ends.a -= ends.ab * inverse[1] * ends.b;
        }
        if self.released[0] {
            inverse[0] = ends.aa.try_inverse()?;
            if !self.released[1] {
                ends.bb -= ends.ba * inverse[0] * ends.ab;
                ends.b -= ends.ba * inverse[0] * ends.a;
            }
        }
        self.loose = Some(Released { ends, inverse });
        Some(ends)
    }

    /// Computes the full solution from the solution at the end points.
    pub(super) fn substitute_all(&mut self, a: Vector3<f64>, b: Vector3<f64>) {
        let (mut a, mut b) = (a, b);
        if let (Some(Released { ends, inverse }), true) = (self.loose, self.released != [false; 2]) {
            if self.released[0] {
                let tied = if self.released[1] { Vector3::zeros() } else { b };
                a = inverse[0] * (ends.a - ends.ab * tied);
            }
            if self.released[1] {
                // if end A has no unknown, its blocks are meaningless
                let pull = if a == Vector3::zeros() { a } else { ends.ba * a };
                b = inverse[1] * (ends.b - pull);
            }
        }
        self.substitute(a, b);
    }
}
