//! A step of a line in one sweep over its rows, four nodes at a time.
//!
//! With the positions of three rows at hand, a row of nodes takes the pull of the segments after it from the chords to the next row, that of
//! the segments before it from the row that was swept last, and its tangent from the rows on both sides. It is kicked and drifts on at once:
//! nothing is stored that the next row would have to load. The first row needs the pull of the last, which therefore comes first.
//! What the ghosts repeat is taken before any node has moved. After the last row the ends are put where their points are.
//!
//! A sweep costs about as long as its divisions and roots take, three of each to a row in water, on a unit that works at one of them at a time.

use std::mem::take;

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::{LineWork, Step, WaterWork};
use crate::dynamics::layout::{
    ContactArrays, CurrentNow, Layout, WaveArrays, inverse_norm, water_flow,
};
use crate::math::fold::Field;
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

/// What resists the motion of the nodes.
mod around {
    /// Nothing.
    pub const BARE: u8 = 0;
    /// Damping by mass.
    pub const DAMPED: u8 = 1;
    /// Still water, and damping by mass where there is any.
    pub const STILL: u8 = 2;
    /// Water that flows, and damping by mass where there is any.
    pub const FLOWING: u8 = 3;
}

/// A sweep for the vector unit of the machine.
pub(super) struct Sweep<'a> {
    pub work: &'a mut LineWork,
    pub step: Step,
    pub ends: [Placed; 2],
}

impl NullaryFnOnce for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (work, step) = (self.work, self.step);
        work.choose_sweep(step);
        if work.settling.is_none() {
            work.layout.place_ends(self.ends, work.parted);
        }
    }
}

/// [`Layout::drift`] for the vector unit of the machine.
pub(super) struct Drift<'a> {
    pub work: &'a mut LineWork,
    pub step: Step,
    pub ends: [Placed; 2],
}

impl NullaryFnOnce for Drift<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let layout = &mut self.work.layout;
        layout.drift(self.step.drift);
        layout.place_ends(self.ends, self.work.parted);
    }
}

impl Layout {
    /// Puts the ends that have not parted from their points where these are.
    #[inline(always)]
    fn place_ends(&mut self, ends: [Placed; 2], parted: [bool; 2]) {
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

/// What the segments are made of, row by row.
struct SegmentRows<'a> {
    inverse_length: &'a [Lanes],
    stiffness: &'a [Lanes],
    damping: &'a [Lanes],
    negative_tension: bool,
}

impl SegmentRows<'_> {
    #[inline(always)]
    fn of(line: &Layout) -> SegmentRows<'_> {
        let last = line.fold.rows();
        SegmentRows {
            inverse_length: &line.inverse_length.rows(last),
            stiffness: &line.axial_stiffness.rows(last),
            damping: &line.axial_damping.rows(last),
            negative_tension: line.negative_tension,
        }
    }

    /// T q of the segments of a row [N], and what their dampers take in a kick [J]; `rate` is how their chords [m] change [m/s].
    #[inline(always)]
    fn pull(&self, row: usize, chord: Vectors, rate: Vectors, kick: Lanes) -> (Vectors, Lanes) {
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
        let lost = (tension - spring) * stretching * kick;
        (chord.scale(tension * inverse_l), lost)
    }
}

/// What the nodes are made of and what surrounds them, row by row.
struct NodeRows<'a> {
    weight: &'a [Lanes],
    inverse_mass: &'a [Lanes],
    interior: &'a [Lanes],
    mass_damping: Option<&'a [Lanes]>,
    water: Option<&'a WaterWork>,
    current: Option<&'a CurrentNow>,
    waves: Option<&'a WaveArrays>,
    contact: Option<&'a ContactArrays>,
}

/// A row of nodes at t_n.
struct Row {
    /// Number of the row.
    number: usize,
    /// Heights [m].
    z: Lanes,
    velocity: Vectors,
    velocity_before: Vectors,
    /// Sum of the segments' pulls [N].
    pull: Vectors,
    /// From the nodes before to those after [m].
    chord: Vectors,
}

/// What a kick makes of a row.
struct Kicked {
    /// At t_{n+½} [m/s].
    velocity: Vectors,
    /// What water and damping resist with at t_n [N].
    resistance: Vectors,
    /// Energy lost, and given by moving water [J].
    lost: Lanes,
    given: Lanes,
}

impl NodeRows<'_> {
    #[inline(always)]
    fn of(work: &LineWork) -> NodeRows<'_> {
        let (line, last) = (&work.layout, work.layout.fold.rows());
        NodeRows {
            weight: &line.weight.rows(last),
            inverse_mass: &work.inverse_mass.rows(last),
            interior: &work.interior.rows(last),
            mass_damping: line.mass_damping.as_ref().map(|damping| damping.rows(last)),
            water: work.water.as_ref(),
            current: line.current.as_ref(),
            waves: line.waves.as_ref(),
            contact: line.contact.as_ref(),
        }
    }

    #[inline(always)]
    fn kick<const AROUND: u8, const BED: bool>(&self, row: &Row, sizes: Sizes) -> Kicked {
        let (zero, half) = (Lanes::splat(0.0), Lanes::splat(0.5));
        let (at, kick, velocity) = (row.number, sizes.kick, row.velocity);
        let inverse_mass = self.inverse_mass[at];
        let mut force = row.pull;
        force.z = force.z - self.weight[at];
        let mut resistance = Vectors::zero();
        if AROUND != around::BARE
            && let Some(damping) = self.mass_damping
        {
            resistance = velocity.scale(damping[at]);
        }
        let (mut press, mut power) = (Vectors::zero(), zero);
        // M⁻¹f, and M⁻¹ẑ for the bed
        let (inverted, response) = if AROUND >= around::STILL {
            let water = self.water.expect("this kernel runs in water");
            let tangent = row.chord.scale(inverse_norm(row.chord.dot(row.chord)));
            let change = velocity - row.velocity_before;
            let mut past = velocity + change.scale(sizes.extrapolation);
            if AROUND == around::FLOWING {
                let flow = water_flow(self.current, self.waves, at, row.z);
                past = past - flow;
                let drag = water.drag(at, past, tangent);
                power = zero - drag.dot(flow);
                resistance = resistance + drag;
                if let Some(waves) = self.waves {
                    press = waves.press(at, tangent);
                }
                force = force - resistance + press;
            } else {
                resistance = resistance + water.drag(at, past, tangent);
                force = force - resistance;
            }
            water.inverted(at, inverse_mass, force, tangent)
        } else {
            if AROUND == around::DAMPED {
                force = force - resistance;
            }
            let mut response = Vectors::zero();
            response.z = inverse_mass;
            (force.scale(inverse_mass), response)
        };
        let mut kicked = velocity + inverted.scale(kick);
        let mut given_away = zero; // twice the energy that leaves the nodes
        if BED {
            let contact = self.contact.expect("this kernel runs over a bed");
            let impulse = contact.impulse(row, kicked.z, response.z, sizes);
            kicked = kicked + response.scale(impulse);
            given_away = given_away - impulse * (velocity.z + kicked.z);
        }
        if AROUND != around::BARE {
            given_away = given_away + resistance.dot(velocity + kicked) * kick;
        }
        let interior = self.interior[at];
        let (mut lost, mut given) = (half * interior * given_away, zero);
        if AROUND == around::FLOWING {
            let by_press = interior * press.dot(velocity + kicked) * kick * half;
            let by_drag = interior * power * kick;
            given = by_drag + by_press;
            lost = lost + by_drag;
        }
        Kicked {
            velocity: kicked,
            resistance,
            lost,
            given,
        }
    }
}

impl ContactArrays {
    /// Impulse Δt·F of the bed: F = k(p − Δt u') − c u' ≥ 0 with u' = u + Δt μ F, only if p − Δt u > 0.
    #[inline(always)]
    fn impulse(&self, row: &Row, velocity_z: Lanes, response_z: Lanes, sizes: Sizes) -> Lanes {
        let at = row.number;
        let (drift, kick) = (sizes.drift, sizes.kick);
        let penetration = self.level.load(at) - row.z;
        let lands = penetration - drift * velocity_z;
        if !lands.any_positive() {
            return Lanes::splat(0.0);
        }
        let stiffness = self.stiffness.load(at);
        let resistance = stiffness * drift + self.damping.load(at); // b = kΔt + c
        let push = stiffness * penetration - resistance * velocity_z;
        let yielding = Lanes::splat(1.0) + response_z * kick * resistance;
        (kick * push.positive() * yielding.recip()).where_positive(lands)
    }
}

impl LineWork {
    #[inline(always)]
    fn choose_sweep(&mut self, step: Step) {
        let damped = self.layout.mass_damping.is_some();
        match (&self.water, self.layout.flows()) {
            (None, _) if damped => self.choose_bed::<{ around::DAMPED }>(step),
            (None, _) => self.choose_bed::<{ around::BARE }>(step),
            (Some(_), false) => self.choose_bed::<{ around::STILL }>(step),
            (Some(_), true) => self.choose_bed::<{ around::FLOWING }>(step),
        }
    }

    /// A bed that slopes or rubs is looked after by [`LineWork::settle`].
    #[inline(always)]
    fn choose_bed<const AROUND: u8>(&mut self, step: Step) {
        let level = self.layout.contact.is_some() && self.settling.is_none();
        match (level, self.pulls_beforehand()) {
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

    /// The sweep; where segments have been `PULLED` before, their pulls are taken from there.
    #[inline(always)]
    fn sweep<const AROUND: u8, const BED: bool, const PULLED: bool>(&mut self, step: Step) {
        self.prepare_ghosts();
        let last = self.layout.fold.rows();
        let sizes = Sizes {
            kick: Lanes::splat(step.kick),
            drift: Lanes::splat(step.drift),
            extrapolation: Lanes::splat(step.extrapolation),
        };
        // what is settled afterwards drifts afterwards
        let settles = self.settling.is_some();
        let drift = Lanes::splat(if settles { 0.0 } else { step.drift });
        let [mut place, velocity, mut before, mut pull] = self.take_motion();
        let mut settling = self.settling.take();
        let (position, before_rows) = (place.rows_mut(last), before.rows_mut(last));
        let (moving, pulls) = (velocity.rows(last), pull.rows_mut(last));
        let (segments, nodes) = (SegmentRows::of(&self.layout), NodeRows::of(self));
        let (mut lost, mut given) = (self.lost, self.given_by_current);
        if !PULLED {
            let chord = position[last + 1] - position[last];
            let rate = moving[last + 1] - moving[last];
            let loss;
            (pulls[last], loss) = segments.pull(last, chord, rate, sizes.kick);
            lost = lost + loss;
        }
        let (mut low, mut here, mut pull_low) = (position[0], position[1], pulls[last].moved_up());
        for row in 1..=last {
            let high = position[row + 1];
            if !PULLED && row < last {
                let rate = moving[row + 1] - moving[row];
                let (pull, loss) = segments.pull(row, high - here, rate, sizes.kick);
                lost = lost + loss;
                pulls[row] = pull;
            }
            let pull = pulls[row];
            let row_now = Row {
                number: row,
                z: here.z,
                velocity: moving[row],
                velocity_before: before_rows[row],
                pull: pull - pull_low,
                chord: high - low,
            };
            let kicked = nodes.kick::<AROUND, BED>(&row_now, sizes);
            before_rows[row] = kicked.velocity; // v_{n−3/2} has been read
            position[row] = here + kicked.velocity.scale(drift);
            if let Some(settling) = &mut settling {
                settling.resistance.store(kicked.resistance, row);
            }
            (lost, given) = (lost + kicked.lost, given + kicked.given);
            (low, here, pull_low) = (here, high, pull);
        }
        (self.lost, self.given_by_current, self.settling) = (lost, given, settling);
        (self.layout.position, self.pull) = (place, pull);
        (self.layout.velocity, self.layout.velocity_before) = (before, velocity);
    }

    /// Lends out positions, velocities, velocities before and pulls.
    #[inline(always)]
    fn take_motion(&mut self) -> [Field; 4] {
        let line = &mut self.layout;
        [
            take(&mut line.position),
            take(&mut line.velocity),
            take(&mut line.velocity_before),
            take(&mut self.pull),
        ]
    }
}
