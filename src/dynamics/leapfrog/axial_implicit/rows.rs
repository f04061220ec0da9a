//! Quantities of four segments and of four nodes in a step of the axial-implicit leapfrog.

use nalgebra::Vector3;

use crate::dynamics::leapfrog::contact::NodeContact;
use crate::dynamics::leapfrog::layout::Layout;
use crate::math::lanes::{LANES, Lanes, Vectors};
use crate::math::striped_tridiagonal::{Eliminated, Equations};
use crate::math::striping::Slot;
use crate::physics::stretch::StretchLaw;

/// Strain below which slack springs continue along their tangent [-]: at lower strains, strain measures become non-monotonic.
const SHORTEST: f64 = -0.2;

pub(super) mod springs {
    /// Engineering strain.
    pub(crate) const LINEAR: u8 = 0;
    /// Another strain measure, or a table.
    pub(crate) const CURVED: u8 = 1;
    pub(crate) const VISCOELASTIC: u8 = 2;
}

/// Kinds of seabed under the nodes.
pub(super) mod under {
    pub(crate) const NOTHING: u8 = 0;
    /// A level seabed without friction.
    pub(crate) const LEVEL: u8 = 1;
    /// A seabed with a slope, soundings or friction.
    pub(crate) const ROUGH: u8 = 2;
}

/// Time increments and weights of a step, in every lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    pub kick: Lanes,
    pub drift: Lanes,
    /// ½(1+θ) and ½(1−θ), the weights of the new and the old strain rate in the damping [-].
    pub damping: [Lanes; 2],
    /// ½θΔt, the weight of the centripetal acceleration of segments in their stretching velocity [s].
    pub turning: Lanes,
    /// 1 where dampers act in slack segments, else 0 [-].
    pub push: Lanes,
    /// Weights of T^{n+1}, T^n, T^{n−1} and T^{n−2} in T̄ [-].
    pub weights: [Lanes; 4],
}

/// Force of the springs of four segments divided by EA [-], and its slope with the strain [-].
#[inline(always)]
pub(super) fn pulled(law: &StretchLaw, strain: Lanes) -> [Lanes; 2] {
    let mut found = [Lanes::splat(0.0); 2];
    for lane in 0..LANES {
        let stretch = law.at(strain[lane]);
        (found[0][lane], found[1][lane]) = (stretch.force, stretch.slope);
    }
    found
}

/// Segments, each between the node of the same index and the next one.
#[derive(Debug, Clone, Copy)]
pub(super) struct SegmentRow {
    /// Length at which the spring tension is −P, equal to the unstretched length L where P is 0 [m]; EA/L [N/m] and BA/L [N s/m].
    pub unstretched_length: Lanes,
    pub axial_stiffness: Lanes,
    pub axial_damping: Lanes,
    /// Unit vectors q along the segments.
    pub direction: Vectors,
    /// Lengths l at t_n [m].
    pub length: Lanes,
    /// 1/max(l, L) with the unstretched lengths L [1/m]: slack segments of no length do not turn without bound.
    pub inverse: Lanes,
    /// q·(v_{i+1} − v_i) at t_{n−½} [m/s].
    pub along: Lanes,
    /// Part of the weighted stretching velocity that does not depend on the new velocities [m/s].
    pub earlier_rate: Lanes,
    /// dT̄/d(q·(v_{i+1} − v_i)) of the springs [N s/m].
    pub stiffness: Lanes,
    /// Part of T̄ from the linearised springs, at zero stretching velocity [N].
    pub elastic: Lanes,
    /// Part of it from the earlier tensions, up to t_n [N]; set if springs are nonlinear or [`super::AxialImplicit::forgets`] is true.
    pub memory: Lanes,
    /// Part of BA/L that acts in T̄ [N s/m].
    pub damping: Lanes,
    /// EA·b₁ times the strain due to transverse motion [N].
    pub curvature: Lanes,
    /// 1 where the segment is taut, −1 where it is slack.
    pub taut: Lanes,
    /// Tensions of the springs as if they also pushed, at t_{n−1} and t_{n−2} [N]; after a step is prepared, at t_n, t_{n−1} and t_{n−2}.
    pub history: [Lanes; 3],
    /// Pull of the damper, negative and positive, at which T̄ loses or gains one of the earlier tensions [N].
    pub margins: [Lanes; 2],
    /// Rows of the system in T̄ [N], and the rows after elimination.
    pub equations: Equations,
    pub eliminated: Eliminated,
    /// T̄ + P [N].
    pub tension: Lanes,
}

impl SegmentRow {
    pub(super) fn new(line: &Layout, at: usize) -> SegmentRow {
        let zero = Lanes::splat(0.0);
        let inverse = line.inverse_length.load(at);
        let stiffness = line.axial_stiffness.load(at) * inverse;
        let softness = (stiffness + Lanes::splat(f64::MIN_POSITIVE)).recip();
        SegmentRow {
            unstretched_length: inverse.recip() + line.least_tension(at) * softness,
            axial_stiffness: stiffness,
            axial_damping: line.axial_damping.load(at) * inverse,
            direction: Vectors::zero(),
            length: zero,
            inverse: zero,
            along: zero,
            earlier_rate: zero,
            stiffness: zero,
            elastic: zero,
            memory: zero,
            damping: line.axial_damping.load(at) * inverse,
            curvature: zero,
            taut: zero,
            history: [zero; 3],
            margins: [zero; 2],
            equations: Equations::unit(),
            eliminated: Eliminated::start(),
            tension: zero,
        }
    }

    /// Writes the equations T̄ − r q·(v_{i+1} − v_i) = known, with the velocities eliminated by the momentum equations of the nodes: from the
    /// difference of the `loose` velocities of the nodes [m/s], and from the `forms` of both nodes.
    #[inline(always)]
    pub(super) fn assemble(
        &mut self,
        relative: Vectors,
        [[_, to_before, low], [high, to_after, _]]: [[Lanes; 3]; 2],
        sizes: &Sizes,
    ) {
        let (zero, one, push) = (Lanes::splat(0.0), Lanes::splat(1.0), sizes.push);
        let damped = self.damping * self.earlier_rate;
        let springs = self.elastic + self.curvature;
        let resistance = self.rate_slope(sizes);
        let known = self.taut.choose(springs + damped, push * damped);
        let k = resistance * sizes.kick;
        self.equations = Equations {
            lower: zero - k * to_before,
            diagonal: one + k * (low + high),
            upper: zero - k * to_after,
            right: known + resistance * self.direction.dot(relative),
        };
    }

    /// Slope of T̄ with the stretching velocity [N s/m].
    #[inline(always)]
    pub(super) fn rate_slope(&self, sizes: &Sizes) -> Lanes {
        let damping = self.damping * sizes.damping[0];
        self.taut.choose(self.stiffness + damping, sizes.push * damping)
    }

    /// Linearises the springs at the strain that is reached with a stretching velocity [m/s] in a step of `drift` [s]; `share` is b₁ and
    /// `inverse` is 1/L [1/m]. Returns their force in T̄ there [N].
    #[inline(always)]
    pub(super) fn follow(
        &mut self,
        law: &StretchLaw,
        along: Lanes,
        inverse: Lanes,
        [share, drift]: [Lanes; 2],
    ) -> Lanes {
        let least = Lanes::splat(f64::MIN_POSITIVE);
        let softness = (self.stiffness + least).recip();
        let bend = (self.curvature * softness).where_positive(self.stiffness);
        let strain = (self.length + drift * (along + bend)) * inverse - Lanes::splat(1.0);
        let (pulling, scale) = (strain.max(Lanes::splat(SHORTEST)), share * self.axial_stiffness);
        let [stretch, slope] = pulled(law, pulling);
        let stretch = stretch + slope * (strain - pulling);
        let force = self.memory + scale * self.unstretched_length * stretch;
        self.stiffness = scale * drift * slope;
        self.curvature = self.stiffness * bend;
        self.elastic = force - self.stiffness * (along + bend);
        force
    }

    /// Takes over the linearised springs of another row in the lanes where `gate` is positive.
    #[inline(always)]
    pub(super) fn adopt_spring(&mut self, other: &SegmentRow, gate: Lanes) {
        self.stiffness = gate.choose(other.stiffness, self.stiffness);
        self.curvature = gate.choose(other.curvature, self.curvature);
        self.elastic = gate.choose(other.elastic, self.elastic);
    }

    /// Force of the springs in T̄ [N] at a stretching velocity [m/s].
    #[inline(always)]
    pub(super) fn spring(&self, along: Lanes) -> Lanes {
        self.elastic + self.curvature + self.stiffness * along
    }

    /// Weighted stretching velocity of the damper in a step that ends with the stretching velocity `along` [m/s].
    #[inline(always)]
    pub(super) fn rate(&self, along: Lanes, sizes: &Sizes) -> Lanes {
        sizes.damping[0] * along + self.earlier_rate
    }

    /// Part of T̄ from the earlier tensions, up to t_n [N], and the share of the damper in T̄ [-], if the damper pulls with `pull` [N]. A
    /// spring with a larger compression contributes nothing, and neither does the damper with its weight.
    #[inline(always)]
    fn remembered(&self, pull: Lanes, sizes: &Sizes) -> [Lanes; 2] {
        let [mut share, weights @ ..] = sizes.weights;
        let mut memory = Lanes::splat(0.0);
        for (weight, tension) in weights.into_iter().zip(self.history) {
            let total = tension + pull;
            memory = memory + (weight * tension).where_positive(total);
            share = share + weight.where_positive(total);
        }
        [memory, share.max(sizes.push)]
    }

    /// Part of T̄ from the earlier tensions if no spring is in compression [N].
    #[inline(always)]
    pub(super) fn all_remembered(&self, sizes: &Sizes) -> Lanes {
        let [_, h0, h1, h2] = sizes.weights;
        let [now, last, before] = self.history;
        h0 * now + h1 * last + h2 * before
    }

    /// Includes the earlier tensions, with the damper at a stretching velocity [m/s].
    #[inline(always)]
    pub(super) fn remember(&mut self, rate: Lanes, sizes: &Sizes) {
        let pull = (Lanes::splat(1.0) - sizes.push) * self.axial_damping * rate;
        let [memory, share] = self.remembered(pull, sizes);
        self.elastic = self.elastic + (memory - self.memory);
        (self.memory, self.damping) = (memory, share * self.axial_damping);
        let (zero, most) = (Lanes::splat(0.0), Lanes::splat(f64::INFINITY));
        let mut margins = [most; 2];
        for tension in self.history {
            let total = tension + pull;
            margins[0] = margins[0].min(total.choose(tension, most));
            margins[1] = margins[1].min(total.choose(most, zero - tension));
        }
        self.margins = margins.map(|margin| share * margin);
    }

    /// Margin [N], negative where T̄ includes the wrong earlier tensions for a pull of the damper of `pull` [N].
    #[inline(always)]
    pub(super) fn margin(&self, pull: Lanes) -> Lanes {
        let [less, more] = self.margins;
        (less + pull).min(more - pull)
    }

    /// Contribution of the damper, at a stretching velocity [m/s], to the force that determines whether the segment is taut [N].
    #[inline(always)]
    pub(super) fn pull(&self, rate: Lanes, sizes: &Sizes) -> Lanes {
        (Lanes::splat(1.0) - sizes.push) * self.damping * rate
    }

    /// Force that is positive where the segment is taut at a stretching velocity [m/s], and the contribution of earlier tensions and of the damper to T̄ in
    /// excess of that included [N].
    #[inline(always)]
    pub(super) fn total(&self, along: Lanes, sizes: &Sizes) -> [Lanes; 2] {
        let (zero, rate) = (Lanes::splat(0.0), self.rate(along, sizes));
        let pull = self.pull(rate, sizes);
        let total = self.spring(along) + pull;
        if !(zero - self.margin(pull)).any_positive() {
            return [total, zero];
        }
        let all = (Lanes::splat(1.0) - sizes.push) * self.axial_damping * rate;
        let [memory, share] = self.remembered(all, sizes);
        let more = memory - self.memory + (share * all - pull);
        [total + more, more]
    }
}

/// Nodes: M⁻¹ x = a x + b (t·x) t − c (s·x) s, with s = (a I + b t tᵀ) ẑ over a level seabed.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeRow {
    /// Masses across and along the line [kg].
    pub mass_normal: Lanes,
    pub mass_tangent: Lanes,
    /// 1 for free nodes, 0 for prescribed ends and padding.
    pub free: Lanes,
    /// Drag divided by relative velocity [N s/m]: across the line in the middle of the step, and along it after the step; and the rest of the drag
    /// along the line [N].
    pub drag: [Lanes; 2],
    pub drag_rest: Lanes,
    /// a, including drag [1/kg].
    pub across: Lanes,
    /// b [1/kg].
    pub excess: Lanes,
    /// t.
    pub tangent: Vectors,
    /// s of nodes on a seabed with a slope, soundings or friction [1/kg].
    pub response: Vectors,
    /// c, zero off the seabed [kg].
    pub held: Lanes,
    /// Contact with the seabed.
    pub contact: NodeContact,
    /// 1 where the level seabed pushes, −1 elsewhere.
    pub touches: Lanes,
    /// Velocity after the step without tension: without and with the seabed [m/s].
    pub fall: Vectors,
    pub loose: Vectors,
    /// Impulse of the segments on nodes over a seabed with a slope, soundings or friction [N s].
    pub impulse: Vectors,
    /// qᵀM⁻¹q, qᵀM⁻¹q′ and q′ᵀM⁻¹q′ of the segments before and after [1/kg].
    pub forms: [Lanes; 3],
}

impl NodeRow {
    /// Padding, which does not move.
    pub(super) fn new() -> NodeRow {
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        NodeRow {
            mass_normal: one,
            mass_tangent: one,
            free: zero,
            drag: [zero; 2],
            drag_rest: zero,
            across: zero,
            excess: zero,
            tangent: Vectors::zero(),
            response: Vectors::zero(),
            held: zero,
            contact: NodeContact::none(),
            touches: Lanes::splat(-1.0),
            fall: Vectors::zero(),
            loose: Vectors::zero(),
            impulse: Vectors::zero(),
            forms: [zero; 3],
        }
    }

    /// b t_z, so that s = a ẑ + b t_z t over a level seabed [1/kg].
    #[inline(always)]
    pub(super) fn lift(&self) -> Lanes {
        self.excess * self.tangent.z
    }

    /// s·x over a seabed, and t·x, for a vector x.
    #[inline(always)]
    fn shares<const SEABED: u8>(&self, x: Vectors) -> [Lanes; 2] {
        let along = self.tangent.dot(x);
        let rise = match SEABED {
            under::NOTHING => Lanes::splat(0.0),
            under::LEVEL => self.across * x.z + self.lift() * along,
            _ => self.response.dot(x),
        };
        [rise, along]
    }

    /// M⁻¹ x.
    #[inline(always)]
    pub(super) fn inverse_mass<const SEABED: u8>(&self, x: Vectors) -> Vectors {
        let [rise, along] = self.shares::<SEABED>(x);
        let (across, along) = (x.scale(self.across), self.excess * along);
        if SEABED == under::NOTHING {
            return across + self.tangent.scale(along);
        }
        let held = self.held * rise;
        if SEABED == under::ROUGH {
            return across + self.tangent.scale(along) - self.response.scale(held);
        }
        let mut inverted = across + self.tangent.scale(along - self.lift() * held);
        inverted.z = inverted.z - self.across * held;
        inverted
    }

    /// Computes the forms for the unit vectors q and q′ of the segments before and after the nodes.
    #[inline(always)]
    pub(super) fn weigh<const SEABED: u8>(&mut self, q: Vectors, other: Vectors) {
        let [rise, along] = self.shares::<SEABED>(q);
        let [other_rise, other_along] = self.shares::<SEABED>(other);
        let (excess, other_excess) = (self.excess * along, self.excess * other_along);
        self.forms = [
            self.across + excess * along,
            self.across * q.dot(other) + excess * other_along,
            self.across + other_excess * other_along,
        ];
        if SEABED != under::NOTHING {
            let (held, other_held) = (self.held * rise, self.held * other_rise);
            let [own, both, others] = self.forms;
            self.forms = [
                own - held * rise,
                both - held * other_rise,
                others - other_held * other_rise,
            ];
        }
    }
}

#[derive(Debug, Clone, Copy)]
pub(super) struct CurrentRow {
    /// Velocity of the water [m/s].
    pub flow: Vectors,
    /// Froude-Krylov force [N].
    pub froude_krylov: Vectors,
}

impl CurrentRow {
    pub(super) fn new() -> CurrentRow {
        CurrentRow {
            flow: Vectors::zero(),
            froude_krylov: Vectors::zero(),
        }
    }
}

/// Rows of a line; the first is row 1 of the layout.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    pub segments: Vec<SegmentRow>,
    pub nodes: Vec<NodeRow>,
    /// Rows of moving water; `None` in still water.
    pub current: Option<Vec<CurrentRow>>,
}

impl Rows {
    /// (T̄ + P) q of a segment [N].
    pub(super) fn pull(&self, at: Slot) -> Vector3<f64> {
        let segment = &self.segments[at.row - 1];
        segment.tension[at.lane] * segment.direction.get(at.lane)
    }
}
