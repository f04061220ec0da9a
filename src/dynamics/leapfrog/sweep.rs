//! A step of a line in one sweep over its rows, four nodes at a time.
//!
//! With the positions of three rows at hand, a row of nodes takes the pull of the segments after it from the chords to the next row, that of
//! the segments before it from the row that was swept last, and its tangent c/|c| from the chord c between the rows on both sides. It is
//! kicked and drifts on at once: nothing is stored that the next row would have to wait for. The first row needs the pull of the last,
//! which therefore comes first. What the ghosts repeat is taken before any node has moved, and after the last row the ends are put where
//! their points are.
//!
//! A row passes through a chain of some forty operations that wait for each other, with roots and quotients among them. Its first half,
//! pulls and what resists, knows nothing of the row below, and is begun before the second half of that, the kick: so the two chains
//! run side by side.
//!
//! Lines that are not plain have their pulls found beforehand, by [`LineWork::pull_beforehand`].

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::{LineWork, Step};
use crate::dynamics::layout::{
    CurrentNow, LENGTH2_MIN, Layout, WaveArrays, inverse_norm, water_flow,
};
use crate::math::lanes::{Lanes, Vectors};
use crate::model::End;

/// Where an end of a line goes.
#[derive(Debug, Clone, Copy)]
pub struct Placed {
    /// Position [m].
    pub position: Vector3<f64>,
    /// The velocity that the next step takes as lagged [m/s].
    pub velocity: Vector3<f64>,
}

/// What is around the nodes.
mod around {
    /// No water.
    pub const DRY: u8 = 0;
    /// Still water.
    pub const STILL: u8 = 1;
    /// Water that flows.
    pub const FLOWING: u8 = 2;
}

/// Speeds below this [m/s] are rounded to multiples of about 2⁻⁵³ of it. What comes to rest on the bed would else go on to squares that are
/// too small to be normal numbers, with which a machine is many times slower.
const STILLNESS: f64 = 1e-30;

/// A sweep for the vector unit of the machine.
pub(super) struct Sweep<'a> {
    pub work: &'a mut LineWork,
    pub size: &'a Step,
    pub ends: &'a [Placed; 2],
}

impl NullaryFnOnce for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let work = self.work;
        work.choose_sweep(self.size);
        if work.settling.is_none() {
            work.layout.place_ends(self.ends, work.parted);
        }
    }
}

/// [`Layout::drift`] for the vector unit of the machine.
pub(super) struct Drift<'a> {
    pub work: &'a mut LineWork,
    pub size: &'a Step,
    pub ends: &'a [Placed; 2],
}

impl NullaryFnOnce for Drift<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let layout = &mut self.work.layout;
        layout.drift(self.size.drift);
        layout.place_ends(self.ends, self.work.parted);
    }
}

impl Layout {
    /// Puts the ends that have not parted from their points where these are.
    #[inline(always)]
    pub(super) fn place_ends(&mut self, ends: &[Placed; 2], parted: [bool; 2]) {
        for end in [End::A, End::B] {
            let (side, at) = (end as usize, self.end_slot(end));
            if !parted[side] {
                // whole rows are written: a part of one would hold up the next sweep, which loads it at once
                let place = self.position.load(at.row);
                self.position
                    .store(place.with(at.lane, ends[side].position), at.row);
                let velocity = self.velocity.load(at.row);
                self.velocity
                    .store(velocity.with(at.lane, ends[side].velocity), at.row);
            }
        }
    }
}

/// Sizes of a step, in every lane.
#[derive(Clone, Copy)]
struct Sizes {
    kick: Lanes,
    drift: Lanes,
    extrapolation: Lanes,
}

/// What moves, row by row.
struct Moving<'a> {
    position: &'a mut [Vectors],
    velocity: &'a [Vectors],
    velocity_before: &'a mut [Vectors],
    pull: &'a mut [Vectors],
}

/// What the segments are made of, row by row.
struct SegmentRows<'a> {
    inverse_length: &'a [Lanes],
    stiffness: &'a [Lanes],
    damping: &'a [Lanes],
    negative_tension: bool,
}

/// What the nodes are made of, row by row.
struct NodeRows<'a> {
    weight: &'a [Lanes],
    inverse_mass: &'a [Lanes],
    interior: &'a [Lanes],
    mass_damping: Option<&'a [Lanes]>,
    water: WaterRows<'a>,
    current: Option<&'a CurrentNow>,
    waves: Option<&'a WaveArrays>,
    contact: ContactRows<'a>,
}

/// Drag coefficients and 1/M_t − 1/M_n; empty without water.
#[derive(Default)]
struct WaterRows<'a> {
    normal: &'a [Lanes],
    tangent: &'a [Lanes],
    excess: &'a [Lanes],
}

/// The bed; empty without one.
#[derive(Default)]
struct ContactRows<'a> {
    level: &'a [Lanes],
    stiffness: &'a [Lanes],
    damping: &'a [Lanes],
}

impl LineWork {
    /// Everything that a sweep needs, cut to the rows of the line.
    #[inline(always)]
    fn cut(&mut self) -> Swept<'_> {
        let (last, line) = (self.layout.fold.rows(), &mut self.layout);
        let moving = Moving {
            position: line.position.rows_mut(last),
            velocity: line.velocity.rows(last),
            velocity_before: line.velocity_before.rows_mut(last),
            pull: self.pull.rows_mut(last),
        };
        let segments = SegmentRows {
            inverse_length: line.inverse_length.rows(last),
            stiffness: line.axial_stiffness.rows(last),
            damping: line.axial_damping.rows(last),
            negative_tension: line.negative_tension,
        };
        let mut nodes = NodeRows {
            weight: line.weight.rows(last),
            inverse_mass: self.inverse_mass.rows(last),
            interior: self.interior.rows(last),
            mass_damping: None,
            water: WaterRows::default(),
            current: line.current.as_ref(),
            waves: line.waves.as_ref(),
            contact: ContactRows::default(),
        };
        if let Some(damping) = &line.mass_damping {
            nodes.mass_damping = Some(damping.rows(last));
        }
        if let Some(water) = &self.water {
            nodes.water = WaterRows {
                normal: water.drag_normal.rows(last),
                tangent: water.drag_tangent.rows(last),
                excess: water.inverse_mass_excess.rows(last),
            };
        }
        if let Some(contact) = &line.contact {
            nodes.contact = ContactRows {
                level: contact.level.rows(last),
                stiffness: contact.stiffness.rows(last),
                damping: contact.damping.rows(last),
            };
        }
        let zero = Lanes::splat(0.0);
        let sums = Sums {
            lost: zero,
            left: zero,
            given: zero,
        };
        Swept {
            moving,
            segments,
            nodes,
            sums,
        }
    }
}

/// What is known of a row before it is kicked.
#[derive(Clone, Copy)]
struct Row {
    /// Pull of the segments after the nodes [N].
    pull: Vectors,
    /// From the nodes before to those after [m].
    chord: Vectors,
    /// Its square's inverse [1/m²].
    inverse_square: Lanes,
    /// What water and damping resist with [N].
    resistance: Vectors,
    flow: Flow,
}

/// What moving water does to a row.
#[derive(Clone, Copy)]
struct Flow {
    /// Power of the drag on the way of the water [W].
    on_drag: Lanes,
    /// What it presses with where waves accelerate it [N].
    press: Vectors,
}

impl SegmentRows<'_> {
    /// T q of the segments of a row [N], and the power that their dampers take [W]; `rate` is how their chords [m] change [m/s].
    #[inline(always)]
    fn pull(&self, row: usize, chord: Vectors, rate: Vectors) -> (Vectors, Lanes) {
        let square = chord.dot(chord);
        let inverse_l = inverse_norm(square);
        let inverse_length = self.inverse_length[row];
        let strain = square * inverse_l * inverse_length - Lanes::splat(1.0);
        let elastic = self.stiffness[row] * strain;
        let spring = elastic.positive();
        let stretching = chord.dot(rate) * inverse_l;
        let damping = self.damping[row] * stretching * inverse_length;
        let tension = if self.negative_tension {
            spring + damping
        } else {
            (elastic + damping).positive()
        };
        (
            chord.scale(tension * inverse_l),
            (tension - spring) * stretching,
        )
    }
}

/// What a sweep sums up over the rows: power lost, twice the power that leaves the nodes, and power given by moving water [W].
#[derive(Clone, Copy)]
struct Sums {
    lost: Lanes,
    left: Lanes,
    given: Lanes,
}

impl NodeRows<'_> {
    /// What resists the motion of row number `at`, whose nodes are at the heights `z` [m].
    #[inline(always)]
    fn resist<const AROUND: u8, const PLAIN: bool>(
        &self,
        (at, z): (usize, Lanes),
        row: &mut Row,
        [velocity, velocity_before]: [Vectors; 2],
        sizes: Sizes,
    ) {
        if AROUND != around::DRY {
            let chord = row.chord;
            row.inverse_square = (chord.dot(chord) + Lanes::splat(LENGTH2_MIN)).recip();
            let change = velocity - velocity_before;
            let now = velocity + change.scale(sizes.extrapolation);
            if AROUND == around::FLOWING {
                let water = water_flow(self.current, self.waves, at, z);
                row.resistance = self.water.drag(at, now - water, row);
                row.flow.on_drag = Lanes::splat(0.0) - row.resistance.dot(water);
                if let Some(waves) = self.waves {
                    let tangent = chord.scale(row.inverse_square.sqrt());
                    row.flow.press = waves.press(at, tangent);
                }
            } else {
                row.resistance = self.water.drag(at, now, row);
            }
        }
        if !PLAIN && let Some(damping) = self.mass_damping {
            row.resistance = row.resistance + velocity.scale(damping[at]);
        }
    }

    /// The velocities at t_{n+½} [m/s] of row number `at`, whose nodes are at the heights `z` [m]; `pull` is the sum of the pulls on them [N].
    #[inline(always)]
    fn kick<const AROUND: u8, const BED: bool, const PLAIN: bool>(
        &self,
        (at, z): (usize, Lanes),
        (row, pull): (&Row, Vectors),
        velocity: Vectors,
        sizes: Sizes,
        sums: &mut Sums,
    ) -> Vectors {
        let resists = AROUND != around::DRY || !PLAIN;
        let mut force = pull;
        force.z = force.z - self.weight[at];
        if resists {
            force = force - row.resistance;
        }
        if AROUND == around::FLOWING {
            force = force + row.flow.press;
        }
        // Δt M⁻¹f, and Δt M⁻¹ẑ for the bed
        let inverse_mass = self.inverse_mass[at] * sizes.kick;
        let (mut change, mut response) = (force.scale(inverse_mass), Vectors::zero());
        if AROUND != around::DRY {
            let excess = self.water.excess[at] * row.inverse_square * sizes.kick;
            change = change + row.chord.scale(excess * force.dot(row.chord));
            response = row.chord.scale(excess * row.chord.z);
        }
        response.z = response.z + inverse_mass;
        let mut kicked = velocity + change;
        let mut left = Lanes::splat(0.0);
        if BED {
            let push = self.contact.push(at, z, [kicked.z, response.z], sizes);
            kicked = kicked + response.scale(push);
            left = left - push * (velocity.z + kicked.z);
        }
        kicked = kicked.rounded(STILLNESS);
        let (both, interior) = (velocity + kicked, self.interior[at]);
        if resists {
            left = left + row.resistance.dot(both);
        }
        if resists || BED {
            sums.left = sums.left + interior * left;
        }
        if AROUND == around::FLOWING {
            let pressed = Lanes::splat(0.5) * row.flow.press.dot(both);
            sums.given = sums.given + interior * (row.flow.on_drag + pressed);
            sums.lost = sums.lost + interior * row.flow.on_drag;
        }
        kicked
    }
}

impl WaterRows<'_> {
    /// K_n |u_n| u_n + K_t |u_t| u_t, with c the chord, u_t = (u·c) c/c².
    #[inline(always)]
    fn drag(&self, at: usize, past: Vectors, row: &Row) -> Vectors {
        let along = past.dot(row.chord); // u·c
        let part = along * row.inverse_square;
        let across = past - row.chord.scale(part);
        let normal = self.normal[at] * across.dot(across).sqrt();
        let tangent = self.tangent[at] * (along.abs() * row.inverse_square.sqrt()) * part;
        across.scale(normal) + row.chord.scale(tangent)
    }
}

impl ContactRows<'_> {
    /// Force of the bed: F = k(p − Δt u') − c u' ≥ 0 with u' = u + Δt μ F, only if p − Δt u > 0; `rise` is u [m/s], and `yields` Δt μ [s/kg].
    #[inline(always)]
    fn push(&self, at: usize, z: Lanes, [rise, yields]: [Lanes; 2], sizes: Sizes) -> Lanes {
        let drift = sizes.drift;
        let penetration = self.level[at] - z;
        let lands = penetration - drift * rise;
        if !lands.any_positive() {
            return Lanes::splat(0.0);
        }
        let stiffness = self.stiffness[at];
        let resistance = stiffness * drift + self.damping[at]; // b = kΔt + c
        let push = stiffness * penetration - resistance * rise;
        let yielding = Lanes::splat(1.0) + yields * resistance;
        (push.positive() * yielding.recip()).where_positive(lands)
    }
}

impl LineWork {
    #[inline(always)]
    fn choose_sweep(&mut self, step: &Step) {
        match (&self.water, self.layout.flows()) {
            (None, _) => self.choose_bed::<{ around::DRY }>(step),
            (Some(_), false) => self.choose_bed::<{ around::STILL }>(step),
            (Some(_), true) => self.choose_bed::<{ around::FLOWING }>(step),
        }
    }

    /// A bed that slopes or rubs is looked after by [`LineWork::settle`].
    #[inline(always)]
    fn choose_bed<const AROUND: u8>(&mut self, step: &Step) {
        let level = self.layout.contact.is_some() && self.settling.is_none();
        match (level, self.plain) {
            (false, false) => self.sweep::<AROUND, false, false>(step),
            (false, true) => self.sweep::<AROUND, false, true>(step),
            (true, false) => self.sweep::<AROUND, true, false>(step),
            (true, true) => self.sweep::<AROUND, true, true>(step),
        }
    }

    /// Makes the ghosts repeat the nodes; an end that has parted has no neighbour beyond it.
    #[inline(always)]
    fn prepare_ghosts(&mut self) {
        let (last, line) = (self.layout.fold.rows(), &mut self.layout);
        let first = line.position.load(1);
        let mut low = line.position.load(last).moved_up();
        if self.parted[End::A as usize] {
            low = low.with(0, first.get(0));
        }
        line.position.store(low, 0);
        line.position.store(first.moved_down(), last + 1);
        let first = line.velocity.load(1);
        line.velocity.store(first.moved_down(), last + 1);
        if self.parted[End::B as usize] {
            let end = line.end_slot(End::B);
            let beyond = line.position.load(end.row + 1);
            let place = line.position.get(end);
            line.position
                .store(beyond.with(end.lane, place), end.row + 1);
        }
    }

    /// The sweep. What can be known of a row before its kick is found before the row below it is kicked.
    #[inline(always)]
    fn sweep<const AROUND: u8, const BED: bool, const PLAIN: bool>(&mut self, step: &Step) {
        self.prepare_ghosts();
        let last = self.layout.fold.rows();
        let sizes = Sizes {
            kick: Lanes::splat(step.kick),
            drift: Lanes::splat(step.drift),
            extrapolation: Lanes::splat(step.extrapolation),
        };
        let mut settling = if PLAIN { None } else { self.settling.take() };
        // what is settled afterwards drifts afterwards
        let settles = settling.is_some();
        let drift = Lanes::splat(if settles { 0.0 } else { step.drift });
        let mut swept = self.cut();
        if PLAIN {
            swept.pull(last);
        }
        let mut pull_low = swept.moving.pull[last].moved_up();
        let mut row = swept.row::<AROUND, PLAIN>(1, swept.moving.position[0], sizes);
        for at in 1..=last {
            let (here, mut next) = (swept.moving.position[at], row);
            if at < last {
                next = swept.row::<AROUND, PLAIN>(at + 1, here, sizes);
            }
            let Swept {
                moving,
                nodes,
                sums,
                ..
            } = &mut swept;
            let (place, pulled) = ((at, here.z), (&row, row.pull - pull_low));
            let velocity = moving.velocity[at];
            let kicked = nodes.kick::<AROUND, BED, PLAIN>(place, pulled, velocity, sizes, sums);
            moving.velocity_before[at] = kicked; // v_{n−3/2} has been read
            moving.position[at] = here + kicked.scale(drift);
            if let Some(settling) = &mut settling {
                settling.resistance.store(row.resistance, at);
            }
            (row, pull_low) = (next, row.pull);
        }
        let Sums { lost, left, given } = swept.sums;
        let half = Lanes::splat(0.5);
        self.lost = self.lost + (lost + half * left) * sizes.kick;
        self.given_by_current = self.given_by_current + given * sizes.kick;
        if !PLAIN {
            self.settling = settling;
        }
        let line = &mut self.layout;
        std::mem::swap(&mut line.velocity, &mut line.velocity_before);
    }
}

/// What a sweep works on.
struct Swept<'a> {
    moving: Moving<'a>,
    segments: SegmentRows<'a>,
    nodes: NodeRows<'a>,
    sums: Sums,
}

impl Swept<'_> {
    /// Finds the pull of a row of segments.
    #[inline(always)]
    fn pull(&mut self, row: usize) {
        let moving = &mut self.moving;
        let chord = moving.position[row + 1] - moving.position[row];
        let rate = moving.velocity[row + 1] - moving.velocity[row];
        let (pull, lost) = self.segments.pull(row, chord, rate);
        moving.pull[row] = pull;
        self.sums.lost = self.sums.lost + lost;
    }

    /// What is known of row number `at` before it is kicked; `low` is where the nodes before are [m].
    #[inline(always)]
    fn row<const AROUND: u8, const PLAIN: bool>(
        &mut self,
        at: usize,
        low: Vectors,
        sizes: Sizes,
    ) -> Row {
        let zero = Lanes::splat(0.0);
        let moving = &self.moving;
        let mut row = Row {
            pull: Vectors::zero(),
            chord: moving.position[at + 1] - low,
            inverse_square: zero,
            resistance: Vectors::zero(),
            flow: Flow {
                on_drag: zero,
                press: Vectors::zero(),
            },
        };
        let place = (at, moving.position[at].z);
        let velocities = [moving.velocity[at], moving.velocity_before[at]];
        let nodes = &self.nodes;
        nodes.resist::<AROUND, PLAIN>(place, &mut row, velocities, sizes);
        // the last row was pulled before the first
        if PLAIN && at + 2 < self.moving.position.len() {
            self.pull(at);
        }
        row.pull = self.moving.pull[at];
        row
    }
}
