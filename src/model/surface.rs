//! The water's surface over a line: the buoyancy that its nodes lose as they come out of the water.

use nalgebra::Vector3;

use super::build::SegmentPart;
use super::{Nodes, WaterAlong};
use crate::physics::surface::{self, Emerged, slope_max};

/// Radius [m] of a part without a diameter, on which the water does not act: it only locates the surface for a
/// neighbouring part.
const RADIUS_BARE: f64 = 5e-4;

/// A line that may pierce the water's surface.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Radius of the segments [m].
    pub radius: Vec<f64>,
    /// Buoyancy of half of every segment [N].
    pub buoyancy: Vec<f64>,
    /// Shares of the segments in the tributary lengths of their lower and upper nodes [-].
    pub share: Vec<[f64; 2]>,
}

/// Effect of the surface on a node.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Dry {
    /// Part of the node's tributary length that is out of the water [-].
    pub part: f64,
    /// Derivative of that part with respect to the node's height [1/m], not negative.
    pub slope: f64,
    /// Buoyancy that the node loses [N].
    pub weight: f64,
}

impl Surface {
    /// Surface over segments of displaced weight ρ g A [N/m], lumped to nodes of the given tributary lengths [m].
    pub(super) fn new(parts: &[SegmentPart], tributary: &[f64]) -> Surface {
        let halves = parts.iter().map(|part| 0.5 * part.length);
        let nodes = tributary.windows(2);
        Surface {
            radius: parts
                .iter()
                .map(|part| part.law.diameter.map_or(RADIUS_BARE, |d| 0.5 * d))
                .collect(),
            buoyancy: parts
                .iter()
                .map(|part| 0.5 * part.length * part.law.displaced_weight)
                .collect(),
            share: halves
                .zip(nodes)
                .map(|(half, pair)| [half / pair[0], half / pair[1]])
                .collect(),
        }
    }

    /// Height of a node at `position` [m] above the water at rest [m].
    #[inline]
    pub fn height(&self, position: &Vector3<f64>) -> f64 {
        position.z
    }

    /// Heights of the nodes of segment `i` above the water [m].
    #[inline]
    pub fn heights(&self, i: usize, position: &[Vector3<f64>], water: WaterAlong) -> [f64; 2] {
        [i, i + 1].map(|node| self.height(&position[node]) - water.elevation(node))
    }

    /// Part of segment `i` that is out of the water, with a radius of at least `breadth` [m], between ends at `heights` [m]
    /// above the water; `None` if the segment is fully submerged.
    #[inline]
    pub fn segment(&self, i: usize, heights: [f64; 2], breadth: f64) -> Option<Emerged> {
        surface::emerged(self.radius[i].max(breadth), heights)
    }

    /// Energy [J] of the buoyancy that segment `i` loses between ends at `heights` [m] above the water.
    pub fn energy(&self, i: usize, heights: [f64; 2]) -> f64 {
        2.0 * self.buoyancy[i] * surface::energy(self.radius[i], heights)
    }

    /// Effect of the surface on node `i` of a line with nodes at `position` [m] in calm water.
    pub fn node(&self, i: usize, position: &[Vector3<f64>]) -> Dry {
        self.node_in(WaterAlong::default(), i, position)
    }

    /// Effect of the surface on node `i` of a line with nodes at `position` [m] in the `water`.
    pub fn node_in(&self, water: WaterAlong, i: usize, position: &[Vector3<f64>]) -> Dry {
        let mut dry = Dry::default();
        let mut add = |segment: usize, end: usize| {
            let heights = self.heights(segment, position, water);
            if let Some(at) = self.segment(segment, heights, 0.0) {
                let share = self.share[segment][end];
                dry.part += share * at.parts[end];
                dry.slope += share * at.slopes[2 * end];
                dry.weight += self.buoyancy[segment] * at.parts[end];
            }
        };
        if i > 0 {
            add(i - 1, 1);
        }
        if i < self.radius.len() {
            add(i, 0);
        }
        dry
    }

    /// Returns whether any part of a line with nodes at `position` [m] is out of the water at rest.
    pub fn is_pierced(&self, position: &[Vector3<f64>]) -> bool {
        let mut segments = position.windows(2).zip(&self.radius);
        segments.any(|(pair, radius)| self.height(&pair[0]).max(self.height(&pair[1])) > -radius)
    }

    /// Maximum heave stiffness of a node due to the surface [N/m].
    pub fn stiffness_max(&self, node: usize) -> f64 {
        let of = |segment: usize| self.buoyancy[segment] * slope_max(self.radius[segment]);
        let below = node.checked_sub(1).map_or(0.0, of);
        let above = (node < self.radius.len()).then_some(node).map_or(0.0, of);
        below + above
    }
}

impl Nodes {
    /// Mass across and along the line [kg] of node `i`, of which the part `dry` [-] is out of the water.
    #[inline]
    pub fn masses(&self, i: usize, dry: f64) -> [f64; 2] {
        let air = self.mass[i];
        [self.mass_normal[i], self.mass_tangent[i]].map(|wet| wet - dry * (wet - air))
    }
}
