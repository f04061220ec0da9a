//! Water surface in the residual and tangent of a line: the buoyancy that its dry nodes lose.
//!
//! The missing buoyancy has an exact tangent, symmetric and positive semi-definite. Drag and added mass are proportional to the wet part of a node;
//! the tangent includes their slope with respect to the height of the node, but not with respect to the heights of its neighbours.

use nalgebra::{Matrix3, Vector3};

use super::LineWork;
use crate::model::{Dry, Line, WaterAlong};

impl LineWork {
    /// Finds the dry parts of a line at `position` [m] in the `water`, and adds the buoyancy they lose, times `force`, and its tangent, times
    /// `stiffness`. Segments with a radius below `breadth` [m] get that radius.
    pub(super) fn add_surface(
        &mut self,
        line: &Line,
        position: &[Vector3<f64>],
        water: WaterAlong,
        [force, stiffness]: [f64; 2],
        breadth: f64,
    ) {
        let Some(surface) = &line.surface else {
            return;
        };
        self.dry.fill(Dry::default());
        for i in 0..line.segment_count() {
            let heights = surface.heights(i, position, water);
            let Some(at) = surface.segment(i, heights, breadth) else {
                continue;
            };
            let buoyancy = surface.buoyancy[i];
            for end in 0..2 {
                let (node, share) = (i + end, surface.share[i][end]);
                let dry = &mut self.dry[node];
                dry.part += share * at.parts[end];
                dry.slope += share * at.slopes[2 * end];
                dry.weight += buoyancy * at.parts[end];
                self.residual[node].z += force * buoyancy * at.parts[end];
                self.diagonal[node][(2, 2)] += stiffness * buoyancy * at.slopes[2 * end];
            }
            self.coupling[i][(2, 2)] += stiffness * buoyancy * at.slopes[1];
        }
    }

    /// Effect of the surface on a node; none if the line does not meet it.
    #[inline(always)]
    pub(super) fn dry(&self, node: usize) -> Dry {
        self.dry.get(node).copied().unwrap_or_default()
    }
}

/// Slope of a force f(1 − p), with p the `dry` part, with respect to the height of the node: the third column of a tangent, for f [N].
#[inline(always)]
pub(super) fn by_height(dry: &Dry, force: Vector3<f64>) -> Matrix3<f64> {
    force * (-dry.slope * Vector3::z()).transpose()
}
