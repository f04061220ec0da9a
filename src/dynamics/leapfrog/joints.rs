//! Joints of a line that bends. Their forces are explicit in the leapfrogs: they depend on the positions at t_n.
//!
//! With the energy W_i of the joint at node i ([`crate::physics::bending`]) and the end-to-end vector e_i of segment i, the joints at both nodes of
//! the segment exert the couple of forces ± S_i on these nodes,
//!
//! S_i = ∂W_i/∂e_i + ∂W_{i+1}/∂e_i,
//!
//! which is added to the pull T q of the segment. A clamp is the direction of the segment before the first one, or after the last one.
//!
//! In the shortest wave, a zigzag, the joints of equal segments of length l are as stiff as a tension of 4EI/l², which is also the maximum compression P
//! of a segment. The step limits are those for a tension of T + P.

use nalgebra::Vector3;

use super::ENDS;
use super::layout::{Layout, inverse_norm};
use crate::math::lanes::{LANES, Lanes, Vectors};
use crate::math::striping::{Column, Field, Slot, Striping};
use crate::model::{Bending, End};
use crate::physics::bending::{Couple, Direction, Turn};

/// Joints of a line in striped layout.
#[derive(Debug, Clone)]
pub struct Joints {
    /// B of the nodes [N m].
    stiffness: Column,
    /// |κb| of the unstressed shape at the nodes [-].
    rest: Column,
    /// P of the segments [N].
    pub push: Column,
    /// S of the segments, and of those before the first row [N].
    pub shear: Field,
    /// Clamps at ends A and B; zero at pinned ends.
    pub clamps: [Clamp; 2],
    /// Moments on ends A and B [N m].
    pub moments: [Vector3<f64>; 2],
}

/// Clamp at an end.
#[derive(Debug, Clone, Copy, Default)]
pub struct Clamp {
    /// Direction, pointing from end A to end B [-].
    pub along: Vector3<f64>,
    /// Angular velocity of the support [rad/s].
    pub spin: Vector3<f64>,
}

impl Joints {
    /// Allocates the joints of a line.
    pub fn new(bending: &Bending, striping: Striping) -> Joints {
        let keep = |values: &[f64]| striping.column(values, 0.0);
        Joints {
            stiffness: keep(&bending.joint),
            rest: keep(&bending.rest),
            push: keep(&bending.compression_max),
            shear: Field::zeros(striping),
            clamps: [Clamp::default(); 2],
            moments: [Vector3::zeros(); 2],
        }
    }

    /// Shear forces of the adjacent segments on the nodes of a row [N].
    #[inline(always)]
    pub fn force(&self, at: usize) -> Vectors {
        self.shear.load(at) - self.shear.load(at - 1)
    }
}

impl Layout {
    /// Computes S of the segments at t_n, less `taken` times their maximum compression along the chord.
    #[inline(always)]
    pub fn bend(&mut self, taken: f64) {
        let Some(mut joints) = self.joints.take() else {
            return;
        };
        let (rows, taken) = (self.striping.rows(), Lanes::splat(taken));
        let [clamp_a, clamp_b] = joints.clamps.map(|clamp| clamp.along);
        let last = self.segments_along(rows);
        let mut before = Direction {
            along: last.along.moved_up_after(Vectors::new([clamp_a; LANES])),
            per_length: last.per_length.moved_up_after(Lanes::splat(0.0)),
        };
        let mut upper = Vectors::zero();
        for at in 1..=rows + 1 {
            let here = self.directions(at, clamp_b);
            let turn = Turn::new(before, here);
            let [lower, next] = turn.slope(joints.stiffness.load(at), joints.rest.load(at));
            joints.shear.store(upper + lower, at - 1);
            upper = next - here.along.scale(taken * joints.push.load(at));
            before = here;
        }
        for end in ENDS {
            let (segment, _) = self.end_segment(end);
            let couple = Couple::new(joints.moments[end as usize], self.end_chord(end));
            let shear = joints.shear.get(segment) - couple.force;
            joints.shear.set(segment, shear);
        }
        let last = joints.shear.load(rows);
        joints.shear.store(last.moved_up_after(Vectors::zero()), 0);
        self.joints = Some(joints);
    }

    /// Directions of a row of segments, or of the row after the last one. The clamp at end B is the direction of the segment after the last segment.
    #[inline(always)]
    fn directions(&self, at: usize, clamp_b: Vector3<f64>) -> Direction<Vectors> {
        let mut found = match at <= self.striping.rows() {
            true => self.segments_along(at),
            false => {
                let first = self.segments_along(1);
                Direction {
                    along: first.along.moved_down_before(Vectors::zero()),
                    per_length: first.per_length.moved_down_before(Lanes::splat(0.0)),
                }
            }
        };
        let end = self.end_slot(End::B);
        if at == end.row {
            found.along.set(end.lane, clamp_b);
            found.per_length[end.lane] = 0.0;
        }
        found
    }

    #[inline(always)]
    fn segments_along(&self, at: usize) -> Direction<Vectors> {
        let chord = self.position.load(at + 1) - self.position.load(at);
        let per_length = inverse_norm(chord.dot(chord));
        Direction {
            along: chord.scale(per_length),
            per_length,
        }
    }

    /// Chord of the end segment, from its lower to its upper node [m].
    fn end_chord(&self, end: End) -> Vector3<f64> {
        let (_, sign) = self.end_segment(end);
        sign * (self.position.get(self.end_neighbour(end)) - self.position.get(self.end_slot(end)))
    }

    /// Power of rotating clamps and of end moments on the line [W], with the mean of the velocities at t_{n−½} and t_{n+½}.
    pub fn bending_power(&self) -> f64 {
        let Some(joints) = &self.joints else {
            return 0.0;
        };
        let velocity = |at: Slot| 0.5 * (self.velocity.get(at) + self.velocity_before.get(at));
        let power = |end: End| {
            let (_, sign) = self.end_segment(end);
            let couple = Couple::new(joints.moments[end as usize], self.end_chord(end));
            let turning = sign * (velocity(self.end_neighbour(end)) - velocity(self.end_slot(end)));
            couple.force.dot(&turning) + self.clamp_power(joints, end)
        };
        ENDS.map(power).iter().sum()
    }

    /// Power of a rotating clamp on the line at t_n [W].
    fn clamp_power(&self, joints: &Joints, end: End) -> f64 {
        let Clamp { along, spin } = joints.clamps[end as usize];
        let (at, chord) = (self.end_slot(end), self.end_chord(end));
        let support = Direction {
            along,
            per_length: 0.0,
        };
        let turn = Turn::new(support, Direction::new(chord, chord.norm()));
        let moment = turn.moment_on_first(joints.stiffness[at], joints.rest[at]);
        -moment.dot(&spin)
    }
}
