//! What a step of the axial-implicit leapfrog knows of four segments, and of four nodes.

use nalgebra::Vector3;

use super::bed::Bed;
use crate::dynamics::layout::Layout;
use crate::math::fold::Slot;
use crate::math::folded_tridiagonal::{Eliminated, Equations};
use crate::math::lanes::{Lanes, Vectors};

/// Segments, each between its node and the one after.
#[derive(Debug, Clone, Copy)]
pub(super) struct SegmentRow {
    /// 1/L [1/m], axial stiffness [N] and damping [N s].
    pub inverse_length: Lanes,
    pub axial_stiffness: Lanes,
    pub axial_damping: Lanes,
    /// Unit vectors q along the segments.
    pub direction: Vectors,
    /// Lengths l at t_n [m], and 1/l.
    pub length: Lanes,
    pub inverse: Lanes,
    /// q·(v_{i+1} − v_i) at t_{n−½} [m/s], and the square of what else v_{i+1} − v_i has [m²/s²].
    pub along: Lanes,
    pub across: Lanes,
    /// dT̄/d(q·(v_{i+1} − v_i)): elastic and damping part [N s/m].
    pub stiffness: Lanes,
    pub damping: Lanes,
    /// Parts of T̄ known beforehand: elastic, and with damping [N].
    pub elastic: Lanes,
    pub known: Lanes,
    /// Tension of the springs at t_n as if they pushed too, and its slope with the length [N, N/m].
    pub spring_now: Lanes,
    pub spring_slope: Lanes,
    /// EA·b₁ times the strain by transverse motion [N].
    pub curvature: Lanes,
    /// 1 where the segment is taut, −1 where it is slack.
    pub taut: Lanes,
    /// Elastic tensions at t_{n−1} and t_{n−2} [N]; once a step is prepared, at t_n and t_{n−1}.
    pub history: [Lanes; 2],
    /// Rows of the system in T̄ [N], and what elimination makes of them.
    pub equations: Equations,
    pub eliminated: Eliminated,
    /// T̄ [N].
    pub tension: Lanes,
}

impl SegmentRow {
    /// Row `at` of a line.
    pub fn new(line: &Layout, at: usize) -> SegmentRow {
        let zero = Lanes::splat(0.0);
        SegmentRow {
            inverse_length: line.inverse_length.load(at),
            axial_stiffness: line.axial_stiffness.load(at),
            axial_damping: line.axial_damping.load(at),
            direction: Vectors::zero(),
            length: zero,
            inverse: zero,
            along: zero,
            across: zero,
            stiffness: zero,
            damping: zero,
            elastic: zero,
            known: zero,
            spring_now: zero,
            spring_slope: zero,
            curvature: zero,
            taut: zero,
            history: [zero; 2],
            equations: Equations::unit(),
            eliminated: Eliminated::zero(),
            tension: zero,
        }
    }

    /// Pulls T̄ q of the segments [N].
    #[inline(always)]
    pub fn pull(&self) -> Vectors {
        self.direction.scale(self.tension)
    }

    /// What resists stretching [N s/m] and is known [N] in T̄ − r q·(v_{i+1} − v_i) = known; `push` is 1 where dampers act in slack segments, else 0.
    #[inline(always)]
    pub fn law(&self, push: Lanes) -> (Lanes, Lanes) {
        let (stiffness, damping) = (self.stiffness, self.damping);
        let (known, elastic) = (self.known, self.elastic);
        let taut = known + self.curvature;
        (
            self.taut.choose(stiffness + damping, push * damping),
            self.taut.choose(taut, push * (known - elastic)),
        )
    }

    /// Force of the springs [N] at a stretching velocity [m/s], and what is > 0 where the segment is taut with it.
    #[inline(always)]
    pub fn spring(&self, along: Lanes, push: Lanes) -> (Lanes, Lanes) {
        let spring = self.elastic + self.curvature + self.stiffness * along;
        let damper = self.known - self.elastic + self.damping * along;
        (spring, spring + (Lanes::splat(1.0) - push) * damper)
    }
}

/// Nodes: M⁻¹ x = a x + b (t·x) t − c (s·x) s, with s = (a I + b t tᵀ) ẑ over a level bed.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeRow {
    /// Masses across and along the line [kg].
    pub mass_normal: Lanes,
    pub mass_tangent: Lanes,
    /// 1 for nodes that nothing holds, 0 for held ends and padding.
    pub free: Lanes,
    /// Drag over relative velocity, across and along the line [N s/m].
    pub drag: [Lanes; 2],
    /// a, with drag folded in [1/kg].
    pub across: Lanes,
    /// b [1/kg].
    pub excess: Lanes,
    /// t.
    pub tangent: Vectors,
    /// s of nodes on a bed that slopes or rubs [1/kg].
    pub response: Vectors,
    /// c, 0 off the bed [kg].
    pub held: Lanes,
    /// The level bed.
    pub bed: Bed,
    /// 1 where the level bed pushes, −1 elsewhere.
    pub touches: Lanes,
    /// Velocity without tension, without and with the bed [m/s].
    pub fall: Vectors,
    pub loose: Vectors,
    /// qᵀM⁻¹q, qᵀM⁻¹q′ and q′ᵀM⁻¹q′ of the segments before and after [1/kg].
    pub forms: [Lanes; 3],
}

impl NodeRow {
    /// Padding, which stays where it is.
    pub fn new() -> NodeRow {
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        NodeRow {
            mass_normal: one,
            mass_tangent: one,
            free: zero,
            drag: [zero; 2],
            across: zero,
            excess: zero,
            tangent: Vectors::zero(),
            response: Vectors::zero(),
            held: zero,
            bed: Bed::none(),
            touches: Lanes::splat(-1.0),
            fall: Vectors::zero(),
            loose: Vectors::zero(),
            forms: [zero; 3],
        }
    }

    /// b t_z, which makes s = a ẑ + b t_z t over a level bed [1/kg].
    #[inline(always)]
    pub fn lift(&self) -> Lanes {
        self.excess * self.tangent.z
    }

    /// s·x [1/kg], and t·x, of a vector x.
    #[inline(always)]
    fn shares<const RUBS: bool>(&self, x: Vectors) -> [Lanes; 2] {
        let along = self.tangent.dot(x);
        let rise = if RUBS {
            self.response.dot(x)
        } else {
            self.across * x.z + self.lift() * along
        };
        [rise, along]
    }

    /// M⁻¹ x.
    #[inline(always)]
    pub fn inverse_mass<const RUBS: bool>(&self, x: Vectors) -> Vectors {
        let [rise, along] = self.shares::<RUBS>(x);
        let (across, along, held) = (x.scale(self.across), self.excess * along, self.held * rise);
        if RUBS {
            return across + self.tangent.scale(along) - self.response.scale(held);
        }
        let mut inverted = across + self.tangent.scale(along - self.lift() * held);
        inverted.z = inverted.z - self.across * held;
        inverted
    }

    /// The forms qᵀM⁻¹q, qᵀM⁻¹q′ and q′ᵀM⁻¹q′ of unit vectors [1/kg].
    #[inline(always)]
    pub fn inverse_forms<const RUBS: bool>(&self, q: Vectors, other: Vectors) -> [Lanes; 3] {
        let [rise, along] = self.shares::<RUBS>(q);
        let [other_rise, other_along] = self.shares::<RUBS>(other);
        let (excess, held) = (self.excess * along, self.held * rise);
        [
            self.across + excess * along - held * rise,
            self.across * q.dot(other) + excess * other_along - held * other_rise,
            self.across + self.excess * other_along * other_along
                - self.held * other_rise * other_rise,
        ]
    }
}

/// Water that flows past nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurrentRow {
    /// Velocity of the water [m/s].
    pub flow: Vectors,
    /// Force of water that waves accelerate [N].
    pub press: Vectors,
}

impl CurrentRow {
    pub fn new() -> CurrentRow {
        CurrentRow {
            flow: Vectors::zero(),
            press: Vectors::zero(),
        }
    }
}

/// The rows of a line; row 1 of the layout is the first.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    pub segments: Vec<SegmentRow>,
    pub nodes: Vec<NodeRow>,
    /// Where the water moves.
    pub current: Option<Vec<CurrentRow>>,
}

impl Rows {
    /// T̄ q of a segment [N].
    pub fn pull(&self, at: Slot) -> Vector3<f64> {
        let segment = &self.segments[at.row - 1];
        segment.tension[at.lane] * segment.direction.get(at.lane)
    }
}
