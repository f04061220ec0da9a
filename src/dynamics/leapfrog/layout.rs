//! Striped layout of a line for the leapfrog kernels: four lanes ([`crate::math::striping`]), padded and with a halo.
//!
//! Node i and segment i, which lies between nodes i and i + 1, are in the same slot. Padding has no stiffness, no weight and no drag, so
//! that it stays at rest and no loop has a remainder. The halo is renewed when the nodes that it copies have moved.

mod ground;
mod handover;
mod water;

use nalgebra::Vector3;

use super::joints::Joints;
use super::step::Step;
use super::surface::SurfaceNow;
use super::{ENDS, EndMotion};
use crate::dynamics::viscoelastic::{Relaxed, ViscoelasticArrays};
use crate::math::lanes::{Lanes, Vectors};
use crate::math::striping::{Column, Field, Slot, Striping};
use crate::math::unit::VectorUnit;
use crate::model::{End, Line, Model};
use crate::physics::slender::Slender;
use crate::physics::stretch::{StretchLaw, total_tension};
pub(super) use ground::{ContactArrays, SeabedArrays};
use handover::padded_positions;
pub(super) use water::Water;
pub(super) use water::{CurrentNow, WaveArrays, water_flow};

/// Speed below which speeds are rounded to multiples of about 2⁻⁵³ of it [m/s]. The squared speeds of nodes that come to rest on the
/// seabed would otherwise become subnormal numbers, with which processors are many times slower.
const STILLNESS: f64 = 1e-30;
/// Offset that prevents a division by zero at coincident nodes [m²].
pub(super) const LENGTH2_MIN: f64 = 1e-200;

/// Geometry, motion and coefficients of a line.
#[derive(Debug, Clone)]
pub struct Layout {
    pub segment_count: usize,
    /// Slots of the last node and the last segment.
    last: [Slot; 2],
    /// Slots of nodes and segments.
    pub striping: Striping,
    /// Vector unit that the kernels use; results do not depend on it.
    pub vector_unit: VectorUnit,
    pub law: StretchLaw,
    pub negative_tension: bool,
    /// True if the energy balance is evaluated.
    pub energy_balance: bool,
    /// True for ends A and B at prescribed points, even if released from them.
    pub tied: [bool; 2],
    /// True for ends A and B that are released from their points.
    pub released: [bool; 2],
    /// Node positions at t_n [m].
    pub position: Field,
    /// Velocities at t_{n−½} [m/s].
    pub velocity: Field,
    /// Velocities at t_{n−3/2} [m/s].
    pub velocity_before: Field,
    pub inverse_length: Column,
    pub axial_stiffness: Column,
    pub axial_damping: Column,
    pub weight: Column,
    pub drag: Option<DragArrays>,
    /// Current; `None` if it does not act on the line.
    pub current: Option<CurrentNow>,
    /// Waves; `None` if they do not act on the line.
    pub waves: Option<WaveArrays>,
    pub mass_damping: Option<Column>,
    pub contact: Option<ContactArrays>,
    /// Joints; `None` unless the line bends.
    pub joints: Option<Joints>,
    /// Viscoelastic segments; `None` unless the line is viscoelastic.
    pub viscoelastic: Option<ViscoelasticArrays>,
    /// Water surface; `None` unless the line may pierce it.
    pub surface: Option<SurfaceNow>,
}

/// Lumped drag coefficients [N s²/m²].
#[derive(Debug, Clone)]
pub struct DragArrays {
    pub normal: Column,
    pub tangent: Column,
}

/// Inverse of the norm of vectors, from the squared norm [m²]; finite for zero vectors [1/m].
#[inline(always)]
pub(super) fn inverse_norm(square: Lanes) -> Lanes {
    (square + Lanes::splat(LENGTH2_MIN)).sqrt().recip()
}

impl Layout {
    /// Allocates the arrays of a line; `tied` is true for ends at prescribed points. Returns `None` if the sections have different strain measures, which
    /// the kernels do not mix.
    pub fn new(model: &Model, (line, water): (&Line, Water<'_>), tied: [bool; 2]) -> Option<Layout> {
        let n = line.segment_count();
        let striping = match tied[1] && is_plain_at_b(line) {
            true => Striping::without_last(n + 1),
            false => Striping::new(n + 1),
        };
        let keep = |values: &[f64]| striping.column(values, 0.0);
        let nodes = &line.nodes;
        let inverse_lengths: Vec<f64> = line.segments.length.iter().map(|l| 1.0 / l).collect();
        let viscoelastic = ViscoelasticArrays::new(line, striping);
        let (stiffness, damping) = match &viscoelastic {
            Some(viscoelastic) => (viscoelastic.stiffness.clone(), viscoelastic.damping.clone()),
            None => (
                keep(&line.segments.axial_stiffness),
                keep(&line.segments.axial_damping),
            ),
        };
        Some(Layout {
            segment_count: n,
            last: [n, n - 1].map(|i| striping.slot(i)),
            striping,
            vector_unit: VectorUnit::best(),
            law: line.uniform_law()?,
            negative_tension: model.solver.negative_tension,
            energy_balance: model.energy_balance,
            tied,
            released: [false; 2],
            position: padded_positions(striping),
            velocity: Field::zeros(striping),
            velocity_before: Field::zeros(striping),
            inverse_length: striping.column(&inverse_lengths, 1.0),
            axial_stiffness: stiffness,
            axial_damping: damping,
            weight: keep(&nodes.weight),
            drag: nodes.drag.as_ref().map(|drag| DragArrays {
                normal: keep(&drag.normal),
                tangent: keep(&drag.tangent),
            }),
            waves: water.waves.then(|| WaveArrays::new(line, striping)),
            current: water
                .profile
                .filter(|_| nodes.drag.is_some())
                .map(|profile| CurrentNow {
                    profile: profile.clone(),
                    factor: 1.0,
                }),
            mass_damping: nodes.mass_damping.as_ref().map(|damping| keep(damping)),
            contact: nodes
                .contact
                .as_ref()
                .map(|contact| ContactArrays::new(contact, striping)),
            joints: line
                .bending
                .as_ref()
                .map(|bending| Joints::new(bending, striping)),
            viscoelastic,
            surface: SurfaceNow::new(line, striping),
        })
    }

    /// Selects the kernels compiled for every machine of the target, or those for the best vector unit of this machine.
    pub fn set_portable(&mut self, portable: bool) {
        self.vector_unit = match portable {
            true => VectorUnit::portable(),
            false => VectorUnit::best(),
        };
    }

    /// Rounds speeds far below [`STILLNESS`] to zero.
    pub fn still(&mut self) {
        for at in self.rows() {
            self.velocity.store(self.velocity.load(at).rounded(STILLNESS), at);
        }
    }

    /// Copies the nodes to the halo, and closes it at open ends ([`Self::close_halo`]).
    #[inline(always)]
    pub fn renew_halo(&mut self) {
        self.position.wrap();
        self.velocity.wrap();
        self.velocity_before.wrap();
        self.close_halo();
    }

    /// The same, without the velocities of the previous step.
    #[inline(always)]
    pub fn renew_neighbours(&mut self) {
        self.position.wrap();
        self.velocity.wrap();
        self.close_halo();
    }

    /// Sets the halo beyond open ends to the positions of these ends.
    #[inline(always)]
    pub fn close_halo(&mut self) {
        for end in ENDS {
            let at = self.end_slot(end);
            if self.is_open(end) && self.has_row(at) {
                let beyond = if end == End::A { at.before() } else { at.after() };
                self.position.set(beyond, self.position.get(at));
            }
        }
    }

    /// Returns whether an end is open: released, or at a free point.
    #[inline(always)]
    pub fn is_open(&self, end: End) -> bool {
        self.released[end as usize] || !self.tied[end as usize]
    }

    /// Sets the number of segments of the line, up to the number allocated.
    pub fn set_segment_count(&mut self, count: usize) {
        self.segment_count = count;
        self.last = [count, count - 1].map(|i| self.striping.slot(i));
    }

    /// Slot of node `i` and segment `i`.
    pub fn slot(&self, i: usize) -> Slot {
        self.striping.slot(i)
    }

    /// Slots of the nodes, in their order.
    pub fn nodes(&self) -> impl Iterator<Item = Slot> + use<> {
        self.striping.slots().take(self.segment_count + 1)
    }

    /// Tangent at node `i` [-]: unit vector along the chord of its neighbours, or along the segment at an end.
    pub fn tangent_of(&self, i: usize) -> Vector3<f64> {
        let before = self.slot(i.saturating_sub(1));
        let after = self.slot((i + 1).min(self.segment_count));
        let chord = self.position.get(after) - self.position.get(before);
        chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
    }

    /// Moves the ends that are not released to their points.
    #[inline(always)]
    pub fn place_ends(&mut self, ends: [&EndMotion; 2]) {
        for end in ENDS {
            if !self.released[end as usize] {
                let EndMotion { position, velocity } = *ends[end as usize];
                let at = self.end_slot(end);
                self.position.set(at, position);
                self.velocity.set(at, velocity);
            }
        }
    }

    /// Gives the ends that are not released the velocities of their points at t_{n+½}.
    pub fn set_end_velocities(&mut self, ends: [&EndMotion; 2]) {
        for end in ENDS {
            if !self.released[end as usize] {
                self.velocity.set(self.end_slot(end), ends[end as usize].velocity);
            }
        }
    }

    /// Position of a node `lag` [s] ago, extrapolated with its velocity [m].
    pub fn place_before(&self, at: Slot, lag: f64) -> Vector3<f64> {
        self.position.get(at) - lag * self.velocity.get(at)
    }

    /// Restarts the viscoelastic segments at the ends from the positions that the current velocities give `lag` [s] ago: a jump does not act on
    /// dampers.
    pub fn set_out_anew(&mut self, lag: f64) {
        let Some(mut viscoelastic) = self.viscoelastic.take() else {
            return;
        };
        for end in ENDS {
            let (segment, _) = self.end_segment(end);
            let places = [self.end_slot(end), self.end_neighbour(end)];
            let [place, near] = places.map(|at| self.place_before(at, lag));
            viscoelastic.set_out(
                segment,
                (near - place).norm() * self.inverse_length[segment] - 1.0,
            );
        }
        self.viscoelastic = Some(viscoelastic);
    }

    /// Index of the node at an end.
    pub fn end_node(&self, end: End) -> usize {
        match end {
            End::A => 0,
            End::B => self.segment_count,
        }
    }

    /// Returns whether a node is in a row; a node without a row is stored after the last row.
    #[inline(always)]
    pub fn has_row(&self, at: Slot) -> bool {
        at.row <= self.striping.rows()
    }

    /// Slot of the node at an end.
    pub fn end_slot(&self, end: End) -> Slot {
        match end {
            End::A => Slot { row: 1, lane: 0 },
            End::B => self.last[0],
        }
    }

    /// Slot of the segment at an end, and the sign of its pull on the end.
    pub fn end_segment(&self, end: End) -> (Slot, f64) {
        match end {
            End::A => (self.end_slot(End::A), 1.0),
            End::B => (self.last[1], -1.0),
        }
    }

    /// Slot of the neighbour of the node at an end.
    pub fn end_neighbour(&self, end: End) -> Slot {
        match end {
            End::A => self.slot(1),
            End::B => self.last[1],
        }
    }

    /// Indices of the rows of nodes and segments.
    #[inline(always)]
    pub fn rows(&self) -> std::ops::RangeInclusive<usize> {
        1..=self.striping.rows()
    }

    /// Tension [N] of the segment at an end at t_n.
    pub fn end_tension(&self, end: End, step: Step) -> f64 {
        let (at, sign) = self.end_segment(end);
        let nodes = [self.end_slot(end), self.end_neighbour(end)];
        let change = |of: &Field| sign * (of.get(nodes[1]) - of.get(nodes[0]));
        let chord = change(&self.position);
        let relative = change(&self.velocity);
        let before = change(&self.velocity_before);
        let now = relative + step.extrapolation * (relative - before);
        let (l, inverse) = (chord.norm(), self.inverse_length[at]);
        let strain = l * inverse - 1.0;
        let elastic = match &self.viscoelastic {
            Some(viscoelastic) => viscoelastic.elastic_of(at, strain),
            None => self.axial_stiffness[at] * self.law.at(strain).force,
        };
        let rate = if l > 0.0 {
            chord.dot(&now) / l * inverse
        } else {
            0.0
        };
        let least = self.joints.as_ref().map_or(0.0, |joints| 0.0 - joints.push[at]);
        total_tension(
            elastic,
            self.axial_damping[at] * rate,
            least,
            self.negative_tension,
        )
    }

    /// Energy of the half node at an end that is released at t_n, and its kinetic part [J]; `masses` are across and along the line [kg].
    pub fn joining_energy(&self, end: End, masses: [f64; 2], step: Step) -> [f64; 2] {
        let (at, other) = (self.end_slot(end), self.end_neighbour(end));
        let velocity = self.velocity.get(at);
        let chord = self.position.get(other) - self.position.get(at);
        let tangent = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let height = self.position.get(at).z - step.lag() * velocity.z;
        let kinetic = 0.5 * Slender::new(masses).square(velocity, tangent);
        // the energy of the lost buoyancy is part of the energy of the surface
        let lack = self
            .surface
            .as_ref()
            .map_or(0.0, |surface| surface.lack(self.end_node(end), false));
        [kinetic + (self.weight[at] - lack) * height, kinetic]
    }

    /// Elastic force of the segments at a strain [N], negative in compression.
    #[inline(always)]
    pub fn elastic(&self, at: usize, strain: Lanes) -> Lanes {
        let stiffness = self.axial_stiffness.load(at);
        match (&self.viscoelastic, &self.law) {
            (Some(viscoelastic), _) => viscoelastic.elastic(at, strain),
            (None, StretchLaw::Engineering) => stiffness * strain,
            // a segment beyond an end has no stiffness and may have zero length: the logarithm of its stretch would be infinite
            (None, law) => {
                let strain = strain.where_positive(stiffness);
                stiffness * strain.map(|strain| law.at(strain).force)
            }
        }
    }

    /// Minimum tension of the segments [N]: minus the compression that they carry if the line bends, else zero.
    #[inline(always)]
    pub fn least_tension(&self, at: usize) -> Lanes {
        let zero = Lanes::splat(0.0);
        self.joints
            .as_ref()
            .map_or(zero, |joints| zero - joints.push.load(at))
    }

    /// Force of the springs of the segments and of the joints on the lower nodes [N].
    #[inline(always)]
    pub fn spring(&self, at: usize) -> Vectors {
        let (chord, inverse_l) = self.chord(at);
        let tension = self.elastic(at, self.strain(at)).max(self.least_tension(at));
        let pull = chord.scale(tension * inverse_l);
        match &self.joints {
            Some(joints) => pull + joints.shear.load(at),
            None => pull,
        }
    }

    /// Strain of the segments [-].
    #[inline(always)]
    pub fn strain(&self, at: usize) -> Lanes {
        let (chord, inverse_l) = self.chord(at);
        let inverse_length = self.inverse_length.load(at);
        chord.dot(chord) * inverse_l * inverse_length - Lanes::splat(1.0)
    }

    /// Advances viscoelastic segments from t_n to t_{n+1}, the time of the positions, with the velocities of the step. Returns their tension [N] and
    /// the dissipation of their dampers [J], both from t_{n−½} to t_{n+½}.
    #[inline(always)]
    pub fn relax_segments(&mut self, at: usize, step: Step) -> Relaxed {
        let lag = Lanes::splat(0.5 * step.drift);
        let (chord, inverse_l) = self.chord(at);
        let half = chord - (self.velocity.load(at + 1) - self.velocity.load(at)).scale(lag);
        let inverse = self.inverse_length.load(at);
        let strain = |length: Lanes| length * inverse - Lanes::splat(1.0);
        let strains = [
            strain(half.dot(half).sqrt()),
            strain(chord.dot(chord) * inverse_l),
        ];
        let viscoelastic = self.viscoelastic.as_mut().expect("this line is viscoelastic");
        let relaxed = viscoelastic.advance(at, strains, step);
        Relaxed {
            taken: relaxed.taken * inverse.recip(),
            ..relaxed
        }
    }

    /// Stores the strains of viscoelastic segments at t_n for the next step.
    #[inline(always)]
    pub fn keep_strains(&mut self) {
        let Some(mut viscoelastic) = self.viscoelastic.take() else {
            return;
        };
        for at in self.rows() {
            viscoelastic.strain.store(self.strain(at), at);
        }
        self.viscoelastic = Some(viscoelastic);
    }

    /// Chords of the segments [m], and the inverse of their lengths [1/m].
    #[inline(always)]
    pub fn chord(&self, at: usize) -> (Vectors, Lanes) {
        let chord = self.position.load(at + 1) - self.position.load(at);
        (chord, inverse_norm(chord.dot(chord)))
    }

    /// Moves the nodes from t_n to t_{n+1}.
    #[inline(always)]
    pub fn drift(&mut self, drift: f64) {
        let drift = Lanes::splat(drift);
        for at in self.rows() {
            let position = self.position.load(at) + self.velocity.load(at).scale(drift);
            self.position.store(position, at);
        }
    }
}

/// Returns whether the node at end B of a line needs no row if its point is prescribed: it is never released, and the line has no winch, no water
/// surface, no seabed with slope, soundings or friction, and no viscoelastic segments.
fn is_plain_at_b(line: &Line) -> bool {
    let may_release = line.release.is_some_and(|[_, b]| b.may_release());
    let has_surroundings = line.surface.is_some() || line.seabed().is_some() || line.winch.is_some();
    !may_release && !has_surroundings && line.segments.viscoelastic.is_none()
}

/// 1 for nodes between the ends, 0 elsewhere.
pub(super) fn interior(striping: Striping, segment_count: usize) -> Column {
    let mut interior = vec![1.0; segment_count + 1];
    (interior[0], interior[segment_count]) = (0.0, 0.0);
    striping.column(&interior, 0.0)
}
