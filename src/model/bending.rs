//! Bending of a line: joints at its nodes, clamps at its ends.

use nalgebra::Vector3;

use super::{End, Line, Model, PointState};
use crate::physics::bending::{Direction, Turn, compression_max, in_series, of_clamp};

/// Lumped bending stiffness: every node is a joint between the segments that meet there; a clamped end is a joint between the clamp and
/// its segment.
#[derive(Debug, Clone)]
pub struct Bending {
    /// EI per segment [N m²]; 0 for a segment whose joints are hinges.
    pub stiffness: Vec<f64>,
    /// B = EI/l̄ per node [N m]; 0 at hinges and pinned ends.
    pub joint: Vec<f64>,
    /// Length l̄ of a joint [m]: the sum of the unstretched halves of its segments, less at a clamp under tension.
    pub length: Vec<f64>,
    /// |κb| of the unstressed shape per node [-].
    pub rest: Vec<f64>,
    /// Maximum compressive force that a segment carries [N].
    pub compression_max: Vec<f64>,
    /// Damping of the joints [N m s], if a line type has it.
    pub damping: Option<Vec<f64>>,
    /// Direction from end A to end B of the clamp at each end [-]; `None` if the end is pinned.
    clamps: [Option<Vector3<f64>>; 2],
}

impl Bending {
    /// Joints from the length [m], EI [N m²] and stiffness-proportional damping β [s] of every segment, unstressed
    /// when straight.
    pub fn new(
        length: &[f64],
        stiffness: Vec<f64>,
        beta: &[f64],
        clamps: [Option<Vector3<f64>>; 2],
    ) -> Bending {
        let n = length.len();
        let half = |segment: usize, factor: f64| (length[segment], factor * stiffness[segment]);
        let joints = |factor: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let at = |node: usize| match node {
                0 => clamps[0].map_or(0.0, |_| 2.0 * factor(0) * stiffness[0] / length[0]),
                i if i == n => {
                    clamps[1].map_or(0.0, |_| 2.0 * factor(n - 1) * stiffness[n - 1] / length[n - 1])
                }
                i => in_series([half(i - 1, factor(i - 1)), half(i, factor(i))]),
            };
            (0..=n).map(at).collect()
        };
        let tributary = |node: usize| {
            let before = node.checked_sub(1).map_or(0.0, |i| length[i]);
            0.5 * (before + length.get(node).copied().unwrap_or(0.0))
        };
        Bending {
            joint: joints(&|_| 1.0),
            length: (0..=n).map(tributary).collect(),
            rest: vec![0.0; n + 1],
            compression_max: (0..n).map(|i| compression_max(stiffness[i], length[i])).collect(),
            damping: beta
                .iter()
                .any(|beta| *beta > 0.0)
                .then(|| joints(&|segment| beta[segment])),
            clamps,
            stiffness,
        }
    }

    /// Sets stiffness and damping of the clamp at an end for the tension [N] and the unstretched length [m] of the segment there; returns whether the end
    /// is clamped.
    pub fn stiffen_clamp(&mut self, end: End, tension: f64, length: f64) -> bool {
        let (node, segment) = match end {
            End::A => (0, 0),
            End::B => (self.joint.len() - 1, self.stiffness.len() - 1),
        };
        let is_clamped = self.joint[node] > 0.0;
        if is_clamped {
            let growth = of_clamp(self.stiffness[segment], length, tension) / self.joint[node];
            self.joint[node] *= growth;
            self.length[node] /= growth;
            if let Some(damping) = &mut self.damping {
                damping[node] *= growth;
            }
        }
        is_clamped
    }

    /// Curvature at a node [1/m] with a bend |κb| [-]; where EI changes, that of the softer side, under the moment of the joint.
    pub fn curvature(&self, node: usize, bend: f64) -> f64 {
        let last = self.stiffness.len() - 1;
        let [before, after] = [node.saturating_sub(1), node.min(last)].map(|segment| self.stiffness[segment]);
        let (length, rest) = (self.length[node], self.rest[node]);
        match before == after {
            true => bend / length,
            false => rest / length + self.joint[node] * (bend - rest) / before.min(after),
        }
    }

    /// Takes a shape of the line as the unstressed one.
    pub fn rest_at(&mut self, position: &[Vector3<f64>]) {
        for node in 0..position.len() {
            self.rest[node] = match joint(self.clamps, position, node) {
                Some(turn) => turn.bend(),
                None => 0.0,
            };
        }
    }
}

impl Line {
    /// Returns whether the moment-free shape of the line may be curved.
    pub fn may_rest_bent(&self) -> bool {
        let bent = |bending: &Bending| bending.rest.iter().any(|bend| *bend != 0.0);
        self.beam.is_some() || self.bending.as_ref().is_some_and(bent)
    }

    /// Direction from end A to end B of the clamp at an end whose point is `point` [-]; `None` if the end is pinned.
    /// No other function relates a clamp to its support.
    pub fn clamp(&self, end: End, point: &PointState) -> Option<Vector3<f64>> {
        let [a, b] = self.bending.as_ref()?.clamps;
        let reference = match end {
            End::A => a,
            End::B => b,
        };
        reference.map(|along| point.orientation * along)
    }

    /// [`Line::clamp`] of both ends [-].
    pub fn clamps(&self, points: &[PointState]) -> [Option<Vector3<f64>>; 2] {
        let [a, b] = self.ends.map(|point| &points[point]);
        [self.clamp(End::A, a), self.clamp(End::B, b)]
    }

    /// Maximum compressive force that a segment carries [N]; 0 without bending stiffness.
    pub fn compression_max(&self, segment: usize) -> f64 {
        self.bending
            .as_ref()
            .map_or(0.0, |bending| bending.compression_max[segment])
    }

    /// Maximum compressive force that any of its segments carries [N].
    pub fn greatest_push(&self) -> f64 {
        let pushes = self.bending.iter().flat_map(|bending| &bending.compression_max);
        pushes.fold(0.0, |greatest, push| push.max(greatest))
    }
}

impl Model {
    /// Moments [N m] on ends A and B of a line at time `t` [s]: those of its points, if the line bends up to an end that is not clamped; otherwise zero.
    pub fn end_moments(&self, line: &Line, t: f64) -> [Vector3<f64>; 2] {
        let Some(bending) = &line.bending else {
            return [Vector3::zeros(); 2];
        };
        let last = bending.stiffness.len() - 1;
        [0, 1].map(|side| {
            let bends = bending.stiffness[side * last] > 0.0;
            match bends && bending.clamps[side].is_none() {
                true => self.points[line.ends[side]].moment_at(t),
                false => Vector3::zeros(),
            }
        })
    }
}

/// Turn at a node between its segments, or between a clamp and a segment; `None` at a pinned end.
#[inline(always)]
pub fn joint(clamps: [Option<Vector3<f64>>; 2], position: &[Vector3<f64>], node: usize) -> Option<Turn> {
    let segment = |i: usize| {
        let chord = position[i + 1] - position[i];
        Direction::new(chord, chord.norm())
    };
    joint_of_segments(clamps, [node, position.len() - 1], segment)
}

/// As [`joint`], for a line whose last node is `last`, from the directions of its segments.
#[inline(always)]
pub fn joint_of_segments(
    clamps: [Option<Vector3<f64>>; 2],
    [node, last]: [usize; 2],
    segment: impl Fn(usize) -> Direction,
) -> Option<Turn> {
    let clamp = |along: Vector3<f64>| Direction {
        along,
        per_length: 0.0,
    };
    Some(match node {
        0 => Turn::new(clamp(clamps[0]?), segment(0)),
        i if i == last => Turn::new(segment(i - 1), clamp(clamps[1]?)),
        i => Turn::new(segment(i - 1), segment(i)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn joints_are_stiff_over_their_halves_and_clamps_over_half_a_segment() {
        let clamps = [Some(Vector3::x()), None];
        let bending = Bending::new(&[1.0, 3.0, 2.0], vec![4.0, 4.0, 0.0], &[0.0; 3], clamps);
        assert_relative_eq!(bending.joint[0], 8.0);
        assert_relative_eq!(bending.joint[1], 2.0);
        assert_eq!(bending.joint[2..], [0.0, 0.0]); // a hinge and a pinned end
        assert_eq!(bending.length, [0.5, 2.0, 2.5, 1.0]);
        assert!(bending.damping.is_none());
        assert_eq!(bending.compression_max[2], 0.0);
    }

    #[test]
    fn tension_makes_a_clamp_stiffer_and_its_length_shorter_and_keeps_its_damping_in_proportion() {
        let clamps = [None, Some(Vector3::x())];
        let mut bending = Bending::new(&[1.0, 2.0], vec![4.0; 2], &[0.5; 2], clamps);
        assert!(!bending.stiffen_clamp(End::A, 100.0, 1.0));
        assert!(bending.stiffen_clamp(End::B, 0.0, 2.0));
        assert_eq!(
            (bending.joint[0], bending.joint[2], bending.length[2]),
            (0.0, 4.0, 1.0)
        );
        bending.stiffen_clamp(End::B, 4.0, 2.0); // as long as √(EI/T) twice
        assert_relative_eq!(
            bending.joint[2],
            2.0 * (2.0 + 2.0_f64.sqrt()),
            max_relative = 1e-14
        );
        assert_relative_eq!(bending.joint[2] * bending.length[2], 4.0);
        let damping = bending.damping.unwrap()[2];
        assert_relative_eq!(damping, 0.5 * bending.joint[2], max_relative = 1e-14);
    }

    #[test]
    fn a_shape_taken_as_unstressed_bends_nothing() {
        let nodes = [
            Vector3::zeros(),
            Vector3::new(1.0, 0.0, 0.0),
            Vector3::new(1.8, 0.6, 0.0),
        ];
        let mut bending = Bending::new(&[1.0, 1.0], vec![4.0; 2], &[0.0; 2], [None, None]);
        bending.rest_at(&nodes);
        let turn = joint([None, None], &nodes, 1).unwrap();
        assert_eq!(turn.energy(4.0, bending.rest[1]).energy, 0.0);
        assert_eq!(bending.rest[0], 0.0);
    }
}
