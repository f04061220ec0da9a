//! A step of a line in a sweep over its rows, four nodes at a time.
//!
//! It passes over them three times: pulls of the segments; what water and damping resist with; and the kick, after which the nodes drift on at
//! once. A row goes through a chain of some forty operations that wait for each other, with roots and quotients among them. A machine holds
//! no more than about one row of them at a time, but several rows of a third of them: so those of neighbouring rows run side by side, and
//! what a pass works with fits into the registers.
//!
//! What the ghosts repeat is taken before any node has moved, and in the end the ends are put where their points are.
//!
//! Lines that are not plain have their pulls found beforehand, by [`LineWork::pull_beforehand`].

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::LineWork;
use crate::dynamics::layout::{CurrentNow, LENGTH2_MIN, Layout, WaveArrays, inverse_norm, water_flow};
use crate::dynamics::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::model::End;
use crate::physics::morison::DragCoefficients;
use crate::physics::stretch::total_tension;

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

/// A sweep for the vector unit of the machine.
pub(super) struct Sweep<'a> {
    pub work: &'a mut LineWork,
    pub size: &'a Step,
    pub ends: [&'a Placed; 2],
}

impl NullaryFnOnce for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let work = self.work;
        work.choose_sweep(self.size);
        if work.settled.is_none() {
            work.layout.place_ends(self.ends, work.parted);
        }
    }
}

/// [`Layout::drift`] for the vector unit of the machine.
pub(super) struct Drift<'a> {
    pub work: &'a mut LineWork,
    pub size: &'a Step,
    pub ends: [&'a Placed; 2],
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
    pub(super) fn place_ends(&mut self, ends: [&Placed; 2], parted: [bool; 2]) {
        for end in [End::A, End::B] {
            if !parted[end as usize] {
                let Placed { position, velocity } = *ends[end as usize];
                self.put_end(end, position, velocity);
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
    spring: &'a mut [Vectors],
    resistance: &'a mut [Vectors],
    inverse_square: &'a mut [Lanes],
    press: &'a mut [Vectors],
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
    mass: &'a [Lanes],
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
            spring: self.spring.rows_mut(last),
            resistance: self.resistance.rows_mut(last),
            inverse_square: self.inverse_square.rows_mut(last),
            press: match &mut self.press {
                Some(press) => press.rows_mut(last),
                None => &mut [],
            },
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
            mass: self.mass.rows(last),
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
            given: zero,
            dragged: zero,
            left: zero,
        };
        Swept {
            moving,
            segments,
            nodes,
            sums,
        }
    }
}

impl SegmentRows<'_> {
    /// T q of the segments of a row and the part of it that springs have [N]; `rate` is how their chords [m] change [m/s].
    #[inline(always)]
    fn pull(&self, row: usize, chord: Vectors, rate: Vectors) -> (Vectors, Vectors) {
        let square = chord.dot(chord);
        let inverse_l = inverse_norm(square);
        let inverse_length = self.inverse_length[row];
        let strain = square * inverse_l * inverse_length - Lanes::splat(1.0);
        let elastic = self.stiffness[row] * strain;
        let spring = elastic.positive();
        let stretching = chord.dot(rate) * inverse_l;
        let damping = self.damping[row] * stretching * inverse_length;
        let tension = total_tension(elastic, damping, Lanes::splat(0.0), self.negative_tension);
        (chord.scale(tension * inverse_l), chord.scale(spring * inverse_l))
    }
}

/// What a sweep sums up over the rows.
#[derive(Clone, Copy)]
struct Sums {
    /// Power given by moving water [W], and what of it the drag takes.
    given: Lanes,
    dragged: Lanes,
    /// Twice the work of springs, weights and waves that is not left in ½ M_n v² [J]: dampers, water and bed took it, or ½ vᵀMv has it along the
    /// tangents, which is booked at both ends of an advance as those turn between the kicks.
    left: Lanes,
}

/// What a row is kicked by.
struct Kicking {
    /// Height of its nodes [m].
    z: Lanes,
    /// Sum of the pulls on them, and the part of it that springs have [N].
    pull: Vectors,
    spring: Vectors,
    /// What water and damping resist with [N].
    resistance: Vectors,
    /// What water presses with that waves accelerate [N].
    press: Vectors,
    /// From the nodes before to those after [m].
    chord: Vectors,
    /// Its square's inverse [1/m²].
    inverse_square: Lanes,
}

impl NodeRows<'_> {
    /// The velocities at t_{n+½} [m/s] of row number `at`; with `BOOKS`, books the step.
    #[inline(always)]
    fn kick<const AROUND: u8, const BED: bool, const PLAIN: bool, const BOOKS: bool>(
        &self,
        at: usize,
        by: &Kicking,
        velocity: Vectors,
        sizes: Sizes,
        sums: &mut Sums,
    ) -> Vectors {
        let (mut force, mut driven) = (by.pull, by.spring);
        force.z = force.z - self.weight[at];
        driven.z = driven.z - self.weight[at];
        if AROUND != around::DRY || !PLAIN {
            force = force - by.resistance;
        }
        if AROUND == around::FLOWING {
            force = force + by.press;
            driven = driven + by.press;
        }
        // Δt M⁻¹f, and Δt M⁻¹ẑ for the bed
        let inverse_mass = self.inverse_mass[at] * sizes.kick;
        let (mut kick, mut response) = (force.scale(inverse_mass), Vectors::zero());
        if AROUND != around::DRY {
            let excess = self.water.excess[at] * by.inverse_square * sizes.kick;
            kick = kick + by.chord.scale(excess * force.dot(by.chord));
            response = by.chord.scale(excess * by.chord.z);
        }
        response.z = response.z + inverse_mass;
        let mut kicked = velocity + kick;
        if BED {
            let push = self.contact.push(at, by.z, [kicked.z, response.z], sizes);
            kicked = kicked + response.scale(push);
        }
        if BOOKS {
            let (both, interior) = (velocity + kicked, self.interior[at]);
            let left = driven.scale(sizes.kick) - (kicked - velocity).scale(self.mass[at]);
            sums.left = sums.left + interior * left.dot(both);
            if AROUND == around::FLOWING {
                let pressed = Lanes::splat(0.5) * by.press.dot(both);
                sums.given = sums.given + interior * pressed;
            }
        }
        kicked
    }
}

impl WaterRows<'_> {
    /// Resistance of the water at the nodes of a row [N].
    #[inline(always)]
    fn drag(&self, at: usize, past: Vectors, chord: Vectors, inverse_square: Lanes) -> Vectors {
        let k = DragCoefficients {
            normal: self.normal[at],
            tangent: self.tangent[at],
        };
        k.resistance(past, chord, inverse_square)
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
        let level = self.layout.contact.is_some() && self.settled.is_none();
        match (level, self.plain) {
            (false, false) => self.sweep::<AROUND, false, false>(step),
            (false, true) => self.sweep::<AROUND, false, true>(step),
            (true, false) => self.sweep::<AROUND, true, false>(step),
            (true, true) => self.sweep::<AROUND, true, true>(step),
        }
    }

    #[inline(always)]
    fn sweep<const AROUND: u8, const BED: bool, const PLAIN: bool>(&mut self, step: &Step) {
        self.layout.renew_neighbours(self.parted);
        let sizes = Sizes {
            kick: Lanes::splat(step.kick),
            drift: Lanes::splat(step.drift),
            extrapolation: Lanes::splat(step.extrapolation),
        };
        // what is settled afterwards drifts afterwards
        let drift = match self.settled {
            None => sizes.drift,
            Some(_) => Lanes::splat(0.0),
        };
        let books = self.layout.books;
        let mut swept = self.cut();
        match (PLAIN, books) {
            (true, true) => swept.pull::<true>(),
            (true, false) => swept.pull::<false>(),
            (false, _) => {}
        }
        if AROUND != around::DRY || !PLAIN {
            swept.resist::<AROUND, PLAIN>(sizes);
        }
        // lines that are not plain book in passing
        match books || !PLAIN {
            true => swept.kick::<AROUND, BED, PLAIN, true>(sizes, drift),
            false => swept.kick::<AROUND, BED, PLAIN, false>(sizes, drift),
        }
        let Sums { given, dragged, left } = swept.sums;
        self.lost = self.lost + Lanes::splat(0.5) * left - dragged * sizes.kick;
        self.given_by_current = self.given_by_current + given * sizes.kick;
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
    /// The last of the rows that are no ghosts.
    #[inline(always)]
    fn last(&self) -> usize {
        self.moving.position.len() - 2
    }

    /// Finds the pulls of the segments, and with `BOOKS` what of them springs have.
    #[inline(always)]
    fn pull<const BOOKS: bool>(&mut self) {
        for at in 1..=self.last() {
            let moving = &mut self.moving;
            let chord = moving.position[at + 1] - moving.position[at];
            let rate = moving.velocity[at + 1] - moving.velocity[at];
            let (pull, spring) = self.segments.pull(at, chord, rate);
            moving.pull[at] = pull;
            if BOOKS {
                moving.spring[at] = spring;
            }
        }
    }

    /// Finds what resists the motion of the nodes, and what else moving water does to them.
    #[inline(always)]
    fn resist<const AROUND: u8, const PLAIN: bool>(&mut self, sizes: Sizes) {
        for at in 1..=self.last() {
            let (moving, nodes, sums) = (&mut self.moving, &self.nodes, &mut self.sums);
            let velocity = moving.velocity[at];
            let mut resistance = Vectors::zero();
            if AROUND != around::DRY {
                let chord = moving.position[at + 1] - moving.position[at - 1];
                let inverse_square = (chord.dot(chord) + Lanes::splat(LENGTH2_MIN)).recip();
                let change = velocity - moving.velocity_before[at];
                let now = velocity + change.scale(sizes.extrapolation);
                moving.inverse_square[at] = inverse_square;
                if AROUND == around::FLOWING {
                    let z = moving.position[at].z;
                    let water = water_flow(nodes.current, nodes.waves, at, z);
                    resistance = nodes.water.drag(at, now - water, chord, inverse_square);
                    // power of the drag on the way of the water
                    let on_drag = nodes.interior[at] * resistance.dot(water);
                    sums.given = sums.given - on_drag;
                    sums.dragged = sums.dragged + on_drag;
                    if let Some(waves) = nodes.waves {
                        moving.press[at] = waves.press(at, chord.scale(inverse_square.sqrt()));
                    }
                } else {
                    resistance = nodes.water.drag(at, now, chord, inverse_square);
                }
            }
            if !PLAIN && let Some(damping) = nodes.mass_damping {
                resistance = resistance + velocity.scale(damping[at]);
            }
            moving.resistance[at] = resistance;
        }
    }

    /// Kicks the nodes, which then move for `drift` [s]; with `BOOKS`, books the step.
    #[inline(always)]
    fn kick<const AROUND: u8, const BED: bool, const PLAIN: bool, const BOOKS: bool>(
        &mut self,
        sizes: Sizes,
        drift: Lanes,
    ) {
        let last = self.last();
        let mut low = self.moving.position[0];
        let none = Vectors::zero();
        let mut pull_low = self.moving.pull[last].moved_up_after(none);
        let mut spring_low = self.moving.spring[last].moved_up_after(none);
        for at in 1..=last {
            let (moving, nodes) = (&mut self.moving, &self.nodes);
            let (here, velocity) = (moving.position[at], moving.velocity[at]);
            let pull = moving.pull[at];
            let spring = if BOOKS { moving.spring[at] } else { pull };
            let mut by = Kicking {
                z: here.z,
                pull: pull - pull_low,
                spring: spring - spring_low,
                resistance: moving.resistance[at],
                press: Vectors::zero(),
                chord: moving.position[at + 1] - low,
                inverse_square: moving.inverse_square[at],
            };
            if AROUND == around::FLOWING && nodes.waves.is_some() {
                by.press = moving.press[at];
            }
            let sums = &mut self.sums;
            let kicked = nodes.kick::<AROUND, BED, PLAIN, BOOKS>(at, &by, velocity, sizes, sums);
            moving.velocity_before[at] = kicked; // v_{n−3/2} has been read
            moving.position[at] = here + kicked.scale(drift);
            if !PLAIN {
                // with the dampers, for what is settled afterwards
                moving.resistance[at] = by.resistance - (by.pull - by.spring);
            }
            (low, pull_low, spring_low) = (here, pull, spring);
        }
    }
}
