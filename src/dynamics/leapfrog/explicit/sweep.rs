//! Stages of a step of a line over its rows, four nodes at a time.
//!
//! There are three loops: forces of the segments; drag and damping; and the kick, immediately followed by the drift of the nodes. A row is a chain of
//! about forty dependent operations, including roots and quotients. A processor can hold about one row of the whole chain at a time, but several rows of
//! a third of it: in three loops the operations of neighbouring rows overlap, and the operands of a loop fit into the registers.
//!
//! Halo rows are copied before any node has moved, and the ends are moved to their points last.

use pulp::NullaryFnOnce;

use super::ExplicitLine;
use crate::dynamics::leapfrog::EndMotion;
use crate::dynamics::leapfrog::layout::{
    CurrentNow, LENGTH2_MIN, Layout, WaveArrays, inverse_norm, water_flow,
};
use crate::dynamics::leapfrog::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::model::Seabed;
use crate::physics::friction_step::Landing;
use crate::physics::morison::DragCoefficients;
use crate::physics::slender::Slender;
use crate::physics::stretch::{StretchLaw, total_tension};

/// Water around the nodes.
mod around {
    pub(super) const DRY: u8 = 0;
    /// Still water, or mass damping.
    pub(super) const STILL: u8 = 1;
    pub(super) const FLOWING: u8 = 2;
}

/// Seabed under the nodes.
mod under {
    pub(super) const NOTHING: u8 = 0;
    /// Level seabed without friction.
    pub(super) const LEVEL: u8 = 1;
    /// Seabed with a slope, soundings or friction.
    pub(super) const ROUGH: u8 = 2;
}

/// Forces of the segments and of the seabed over a step for the vector unit of the machine.
pub(super) struct Pull<'a>(pub &'a mut ExplicitLine, pub Step);

impl NullaryFnOnce for Pull<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.pull_segments();
        self.0.pull_joints();
        self.0.layout.press_seabed(self.1);
    }
}

/// Drag and kick for the vector unit of the machine.
pub(super) struct Sweep<'a> {
    pub work: &'a mut ExplicitLine,
    pub size: &'a Step,
    /// True if the sweep also moves the nodes and the ends to t_{n+1}.
    pub drifts: bool,
    pub ends: [&'a EndMotion; 2],
}

impl NullaryFnOnce for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Sweep {
            work,
            size,
            drifts,
            ends,
        } = self;
        let drift = if drifts { size.drift } else { 0.0 };
        work.choose_sweep(size, drift);
        if drifts {
            work.layout.place_ends(ends);
        }
    }
}

/// [`Layout::drift`] for the vector unit of the machine.
pub(super) struct Drift<'a> {
    pub work: &'a mut ExplicitLine,
    pub size: &'a Step,
    pub ends: [&'a EndMotion; 2],
}

impl NullaryFnOnce for Drift<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let layout = &mut self.work.layout;
        layout.drift(self.size.drift);
        layout.place_ends(self.ends);
    }
}

/// Time increments and extrapolation weight of a step, in every lane.
#[derive(Clone, Copy)]
struct Sizes {
    kick: Lanes,
    per_kick: Lanes,
    extrapolation: Lanes,
}

struct Moving<'a> {
    position: &'a mut [Vectors],
    velocity: &'a [Vectors],
    velocity_before: &'a mut [Vectors],
    pull: &'a [Vectors],
    resistance: &'a mut [Vectors],
    inverse_square: &'a mut [Lanes],
    froude_krylov: &'a mut [Vectors],
    friction: &'a mut [Vectors],
}

struct NodeRows<'a> {
    weight: &'a [Lanes],
    inverse_mass: &'a [Lanes],
    mass_damping: Option<&'a [Lanes]>,
    water: WaterRows<'a>,
    current: Option<&'a CurrentNow>,
    waves: Option<&'a WaveArrays>,
    contact: ContactRows<'a>,
    seabed: Option<&'a Seabed>,
    /// 1 for nodes that move freely, 0 elsewhere.
    interior: &'a [Lanes],
}

/// Drag coefficients and 1/M_t − 1/M_n; empty without water.
#[derive(Default)]
struct WaterRows<'a> {
    normal: &'a [Lanes],
    tangent: &'a [Lanes],
    excess: &'a [Lanes],
}

/// Contact with the seabed; empty without a seabed.
#[derive(Default)]
struct ContactRows<'a> {
    spring: &'a [Lanes],
    resistance: &'a [Lanes],
    /// Normals of a seabed with a slope, soundings or friction.
    normal: &'a [Vectors],
}

impl ExplicitLine {
    /// Forces of the segments from positions at t_n and velocities at t_{n−½}.
    #[inline(always)]
    fn pull_segments(&mut self) {
        self.layout.renew_neighbours();
        match (&self.layout.viscoelastic, &self.layout.law) {
            (None, StretchLaw::Engineering) => {
                self.pull_by(|line, at, strain| line.axial_stiffness.load(at) * strain)
            }
            _ => {
                self.pull_by(Layout::elastic);
                self.layout.keep_strains();
            }
        }
    }

    /// The same, with the elastic force [N] of a row at a strain from `elastic`.
    #[inline(always)]
    fn pull_by(&mut self, elastic: impl Fn(&Layout, usize, Lanes) -> Lanes) {
        let line = &self.layout;
        let (positions, velocities) = (
            line.position.rows(line.striping.rows()),
            line.velocity.rows(line.striping.rows()),
        );
        for at in line.rows() {
            let chord = positions[at + 1] - positions[at];
            let square = chord.dot(chord);
            let inverse_l = inverse_norm(square);
            let inverse_length = line.inverse_length.load(at);
            let strain = square * inverse_l * inverse_length - Lanes::splat(1.0);
            let stretching = chord.dot(velocities[at + 1] - velocities[at]) * inverse_l;
            let damping = line.axial_damping.load(at) * stretching * inverse_length;
            let tension = total_tension(
                elastic(line, at, strain),
                damping,
                line.least_tension(at),
                line.negative_tension,
            );
            self.kernel.pull.store(chord.scale(tension * inverse_l), at);
        }
    }

    #[inline(always)]
    fn pull_joints(&mut self) {
        self.layout.bend(0.0);
        if let Some(joints) = &self.layout.joints {
            for at in self.layout.rows() {
                let pull = self.kernel.pull.load(at) + joints.shear.load(at);
                self.kernel.pull.store(pull, at);
            }
        }
    }

    #[inline(always)]
    fn cut(&mut self) -> Swept<'_> {
        let (last, line) = (self.layout.striping.rows(), &mut self.layout);
        let mut moving = Moving {
            position: line.position.rows_mut(last),
            velocity: line.velocity.rows(last),
            velocity_before: line.velocity_before.rows_mut(last),
            pull: self.kernel.pull.rows(last),
            resistance: self.kernel.resistance.rows_mut(last),
            inverse_square: self.kernel.inverse_square.rows_mut(last),
            froude_krylov: match &mut self.kernel.froude_krylov {
                Some(froude_krylov) => froude_krylov.rows_mut(last),
                None => &mut [],
            },
            friction: &mut [],
        };
        let mut nodes = NodeRows {
            weight: line.weight.rows(last),
            inverse_mass: self.kernel.inverse_mass.rows(last),
            mass_damping: line.mass_damping.as_ref().map(|damping| damping.rows(last)),
            water: WaterRows::default(),
            current: line.current.as_ref(),
            waves: line.waves.as_ref(),
            contact: ContactRows::default(),
            seabed: None,
            interior: self.kernel.interior.rows(last),
        };
        if let Some(water) = &self.kernel.water {
            nodes.water = WaterRows {
                normal: water.drag_normal.rows(last),
                tangent: water.drag_tangent.rows(last),
                excess: water.inverse_mass_excess.rows(last),
            };
        }
        if let Some(contact) = &mut line.contact {
            nodes.contact = ContactRows {
                spring: contact.spring.rows(last),
                resistance: contact.resistance.rows(last),
                normal: &[],
            };
            if let Some(rough) = &mut contact.seabed {
                nodes.contact.normal = rough.normal.rows(last);
                nodes.seabed = Some(&rough.seabed);
                moving.friction = rough.friction.rows_mut(last);
            }
        }
        Swept { moving, nodes }
    }
}

struct Kicking {
    /// Sum of the forces of the segments [N].
    pull: Vectors,
    /// Drag and mass damping [N].
    resistance: Vectors,
    /// Froude-Krylov force [N].
    froude_krylov: Vectors,
    /// Chord from the previous to the next nodes [m].
    chord: Vectors,
    /// Inverse square of the chord [1/m²].
    inverse_square: Lanes,
}

impl NodeRows<'_> {
    /// Velocities of row `at` at t_{n+½} [m/s].
    #[inline(always)]
    fn kick<const AROUND: u8, const UNDER: u8>(
        &self,
        at: usize,
        by: &Kicking,
        velocity: Vectors,
        sizes: Sizes,
    ) -> Vectors {
        let mut force = by.pull;
        force.z = force.z - self.weight[at];
        if AROUND != around::DRY {
            force = force - by.resistance;
        }
        if AROUND == around::FLOWING {
            force = force + by.froude_krylov;
        }
        // Δt M⁻¹f, and Δt M⁻¹ẑ for the seabed
        let inverse_mass = self.inverse_mass[at] * sizes.kick;
        let (mut kick, mut response) = (force.scale(inverse_mass), Vectors::zero());
        if AROUND != around::DRY {
            let excess = self.water.excess[at] * by.inverse_square * sizes.kick;
            kick = kick + by.chord.scale(excess * force.dot(by.chord));
            response = by.chord.scale(excess * by.chord.z);
        }
        response.z = response.z + inverse_mass;
        let mut kicked = velocity + kick;
        if UNDER == under::LEVEL {
            let push = self.contact.push(at, [kicked.z, response.z]);
            kicked = kicked + response.scale(push);
        }
        kicked
    }

    /// Velocities of row `at` on a seabed with a slope, soundings or friction [m/s], and the friction [N]; `free` are the velocities without seabed [m/s].
    #[inline(always)]
    fn land(&self, at: usize, by: &Kicking, free: Vectors, sizes: Sizes) -> (Vectors, Vectors) {
        let none = (free, Vectors::zero());
        let (Some(seabed), interior) = (self.seabed, self.interior[at]) else {
            return none;
        };
        let resistance = self.contact.resistance[at] * interior;
        if !resistance.any_positive() {
            return none;
        }
        let excess = self.water.excess.get(at).copied().unwrap_or(Lanes::splat(0.0));
        let landing = Landing {
            inverse_mass: Slender {
                across: self.inverse_mass[at],
                excess,
            },
            chord: by.chord,
            inverse_square: by.inverse_square,
            normal: self.contact.normal[at],
            spring: sizes.kick * self.contact.spring[at] * interior,
            resistance: sizes.kick * resistance,
        };
        let landed = landing.solve(free, seabed.friction.as_ref());
        (landed.velocity, landed.friction.scale(sizes.per_kick))
    }
}

impl WaterRows<'_> {
    /// Resistance of the water at the nodes of a row, opposite to the drag [N].
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
    /// Force of the seabed F [N]: F = P − R u' ≥ 0 with u' = u + Δt μ F; `rise` is u [m/s], and `yields` Δt μ [s/kg].
    #[inline(always)]
    fn push(&self, at: usize, [rise, yields]: [Lanes; 2]) -> Lanes {
        let resistance = self.resistance[at];
        if !resistance.any_positive() {
            return Lanes::splat(0.0);
        }
        let yielding = Lanes::splat(1.0) + yields * resistance;
        (self.spring[at] - resistance * rise).positive() * yielding.recip()
    }
}

impl ExplicitLine {
    #[inline(always)]
    fn choose_sweep(&mut self, step: &Step, drift: f64) {
        match (&self.kernel.water, self.layout.flows()) {
            (None, _) => self.choose_seabed::<{ around::DRY }>(step, drift),
            (Some(_), false) => self.choose_seabed::<{ around::STILL }>(step, drift),
            (Some(_), true) => self.choose_seabed::<{ around::FLOWING }>(step, drift),
        }
    }

    #[inline(always)]
    fn choose_seabed<const AROUND: u8>(&mut self, step: &Step, drift: f64) {
        match (&self.layout.contact, self.layout.seabed()) {
            (None, _) => self.sweep::<AROUND, { under::NOTHING }>(step, drift),
            (Some(_), None) => self.sweep::<AROUND, { under::LEVEL }>(step, drift),
            (Some(_), Some(_)) => self.sweep::<AROUND, { under::ROUGH }>(step, drift),
        }
    }

    #[inline(always)]
    fn sweep<const AROUND: u8, const UNDER: u8>(&mut self, step: &Step, drift: f64) {
        let sizes = Sizes {
            kick: Lanes::splat(step.kick),
            per_kick: Lanes::splat(1.0 / step.kick),
            extrapolation: Lanes::splat(step.extrapolation),
        };
        let mut swept = self.cut();
        if AROUND != around::DRY {
            swept.resist::<AROUND>(sizes);
        }
        swept.kick::<AROUND, UNDER>(sizes, Lanes::splat(drift));
        let line = &mut self.layout;
        std::mem::swap(&mut line.velocity, &mut line.velocity_before);
    }
}

/// Inverse square of a chord [1/m²].
#[inline(always)]
fn inverse_square(chord: Vectors) -> Lanes {
    (chord.dot(chord) + Lanes::splat(LENGTH2_MIN)).recip()
}

struct Swept<'a> {
    moving: Moving<'a>,
    nodes: NodeRows<'a>,
}

impl Swept<'_> {
    /// Index of the last row before the halo.
    #[inline(always)]
    fn last(&self) -> usize {
        self.moving.position.len() - 2
    }

    #[inline(always)]
    fn resist<const AROUND: u8>(&mut self, sizes: Sizes) {
        for at in 1..=self.last() {
            let (moving, nodes) = (&mut self.moving, &self.nodes);
            let velocity = moving.velocity[at];
            let chord = moving.position[at + 1] - moving.position[at - 1];
            let inverse_square = inverse_square(chord);
            let change = velocity - moving.velocity_before[at];
            let mut now = velocity + change.scale(sizes.extrapolation);
            moving.inverse_square[at] = inverse_square;
            if AROUND == around::FLOWING {
                now = now - water_flow(nodes.current, nodes.waves, at, moving.position[at].z);
                if let Some(waves) = nodes.waves {
                    moving.froude_krylov[at] = waves.froude_krylov(at, chord.scale(inverse_square.sqrt()));
                }
            }
            let mut resistance = nodes.water.drag(at, now, chord, inverse_square);
            if let Some(damping) = nodes.mass_damping {
                resistance = resistance + velocity.scale(damping[at]);
            }
            moving.resistance[at] = resistance;
        }
    }

    /// Advances the velocities of the nodes, and then their positions by `drift` [s].
    #[inline(always)]
    fn kick<const AROUND: u8, const UNDER: u8>(&mut self, sizes: Sizes, drift: Lanes) {
        let last = self.last();
        let mut low = self.moving.position[0];
        let mut pull_low = self.moving.pull[last].moved_up_after(Vectors::zero());
        for at in 1..=last {
            let (moving, nodes) = (&mut self.moving, &self.nodes);
            let (here, velocity) = (moving.position[at], moving.velocity[at]);
            let pull = moving.pull[at];
            let chord = moving.position[at + 1] - low;
            let inverse_square = match AROUND {
                around::DRY if UNDER == under::ROUGH => inverse_square(chord),
                _ => moving.inverse_square[at],
            };
            let mut by = Kicking {
                pull: pull - pull_low,
                resistance: moving.resistance[at],
                froude_krylov: Vectors::zero(),
                chord,
                inverse_square,
            };
            if AROUND == around::FLOWING && nodes.waves.is_some() {
                by.froude_krylov = moving.froude_krylov[at];
            }
            let mut kicked = nodes.kick::<AROUND, UNDER>(at, &by, velocity, sizes);
            if UNDER == under::ROUGH {
                (kicked, moving.friction[at]) = nodes.land(at, &by, kicked, sizes);
            }
            moving.velocity_before[at] = kicked; // v_{n−3/2} has been read
            moving.position[at] = here + kicked.scale(drift);
            (low, pull_low) = (here, pull);
        }
    }
}
