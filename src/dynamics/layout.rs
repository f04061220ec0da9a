//! A line laid out for the leapfrog kernels: folded into four lanes ([`crate::math::fold`]), padded and with ghosts.
//!
//! Node i and segment i, which lies between nodes i and i + 1, stand in the same slot. Padding has no stiffness, no weight and no drag, so
//! that it stays at rest and no loop has a remainder. Ghosts are renewed when the nodes that they repeat have moved.

use std::sync::Arc;

use nalgebra::Vector3;
use pulp::{Arch, NullaryFnOnce};

use super::creep::CreepArrays;
use super::leapfrog::Step;
use super::surface::SurfaceNow;
use crate::math::fold::{Column, Field, Fold, Slot};
use crate::math::hermite::Hermite;
use crate::math::lanes::{Lanes, Vectors};
use crate::math::unit;
use crate::model::{Bottom, Contact, End, Line, LineState, Model, WaveSpan};
use crate::physics::airy::{Orbit, cubics};
use crate::physics::flow::{Profile, Stream};
use crate::physics::friction::Friction;
use crate::physics::seabed::ContactCoefficients;
use crate::physics::stretch::{StretchLaw, total_tension};
use crate::scene::Solver;

/// Speed that only an unstable step reaches [m/s]: the fastest axial waves run at about this speed.
const SPEED_MAX: f64 = 1e4;
/// Speeds below this [m/s] are rounded to multiples of about 2⁻⁵³ of it. What comes to rest on the bed would else go on to squares that are
/// too small to be normal numbers, with which a machine is many times slower.
const STILLNESS: f64 = 1e-30;
/// Keeps coincident nodes from dividing by zero [m²].
pub(super) const LENGTH2_MIN: f64 = 1e-200;

/// Geometry, motion and coefficients of a line.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub segment_count: usize,
    /// Where the last node and the last segment stand.
    last: [Slot; 2],
    /// Where nodes and segments stand.
    pub fold: Fold,
    /// The vectors of the machine that kernels run with; results do not depend on it.
    pub vector_unit: Arch,
    /// Rows that vectors of eight numbers do not pay for [-].
    few_rows: usize,
    pub law: StretchLaw,
    pub negative_tension: bool,
    /// Whether steps are booked in the energy ledger.
    pub books: bool,
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
    /// The current, where it acts on the line.
    pub current: Option<CurrentNow>,
    /// The waves, where they act on the line.
    pub waves: Option<WaveArrays>,
    pub mass_damping: Option<Column>,
    pub contact: Option<ContactArrays>,
    /// Memory of viscoelastic segments, where the line has any.
    pub creep: Option<CreepArrays>,
    /// The water's surface, where the line may pierce it.
    pub surface: Option<SurfaceNow>,
}

/// Lumped drag coefficients [N s²/m²].
#[derive(Debug, Clone)]
pub(super) struct DragArrays {
    pub normal: Column,
    pub tangent: Column,
}

/// What moves the water around a line.
#[derive(Debug, Clone, Copy)]
pub struct Water<'a> {
    /// Shape of the current, where the water flows.
    pub profile: Option<&'a Profile>,
    /// Whether waves act on the line.
    pub waves: bool,
}

impl<'a> Water<'a> {
    /// Around a line of a model.
    pub fn around(model: &'a Model, line: &Line) -> Water<'a> {
        Water {
            profile: model.current.as_ref().map(|current| &current.profile),
            waves: line.heaves(model),
        }
    }
}

/// The current at t_n.
#[derive(Debug, Clone)]
pub(super) struct CurrentNow {
    pub profile: Profile,
    /// What multiplies it [-].
    pub factor: f64,
}

impl CurrentNow {
    fn stream(&self) -> Stream<'_> {
        Stream {
            profile: &self.profile,
            factor: self.factor,
        }
    }
}

/// Motion of the water by waves over a span of time: coefficients of the powers of the part of the span that has passed.
#[derive(Debug, Clone)]
pub(super) struct WaveArrays {
    /// Of the velocity [m/s].
    velocity: [Field; 4],
    /// Of the acceleration [m/s²].
    acceleration: [Field; 4],
    /// Mass of the water that presses, across and along the line [kg].
    normal: Column,
    tangent: Column,
    /// Start and end of the span [s].
    times: [f64; 2],
    /// Part of the span that has passed at t_n [-].
    passed: f64,
    /// Elevation of the surface over the nodes, and its rate, at both ends of the span [m, m/s].
    surface: Vec<[[f64; 2]; 2]>,
}

impl WaveArrays {
    fn new(line: &Line, fold: Fold) -> WaveArrays {
        let zeros = || Field::zeros(fold);
        let pressed = line.nodes.pressed.as_ref();
        let mass = |of: fn(&crate::model::Pressed) -> &Vec<f64>| {
            let values = pressed.map_or(&[][..], |pressed| of(pressed));
            fold.column(values, 0.0)
        };
        WaveArrays {
            velocity: std::array::from_fn(|_| zeros()),
            acceleration: std::array::from_fn(|_| zeros()),
            normal: mass(|pressed| &pressed.normal),
            tangent: mass(|pressed| &pressed.tangent),
            times: [0.0; 2],
            passed: 0.0,
            surface: Vec::new(),
        }
    }

    /// Goes on in time [s].
    fn pass(&mut self, time: f64) {
        let [t0, t1] = self.times;
        if t1 > t0 {
            self.passed += time / (t1 - t0);
        }
    }

    /// Elevation of the surface over a node [m].
    fn elevation(&self, node: usize) -> f64 {
        let [[p0, m0], [p1, m1]] = self.surface[node];
        let [t0, t1] = self.times;
        if t1 <= t0 {
            return p0;
        }
        let cubic = Hermite::new((t0, p0, m0), (t1, p1, m1));
        cubic.at(t0 + self.passed * (t1 - t0)).value
    }

    /// Velocities of the water at the nodes at t_n [m/s].
    #[inline(always)]
    fn velocity(&self, at: usize) -> Vectors {
        polynomial(&self.velocity, self.passed, at)
    }

    /// Forces of the accelerated water on nodes with these unit tangents [N].
    #[inline(always)]
    pub fn press(&self, at: usize, tangent: Vectors) -> Vectors {
        let acceleration = polynomial(&self.acceleration, self.passed, at);
        let normal = self.normal.load(at);
        let excess = self.tangent.load(at) - normal;
        acceleration.scale(normal) + tangent.scale(excess * acceleration.dot(tangent))
    }

    /// Force of the accelerated water on a node with this unit tangent [N].
    pub fn press_of(&self, at: Slot, tangent: Vector3<f64>) -> Vector3<f64> {
        let acceleration = self.value(&self.acceleration, at);
        let excess = self.tangent[at] - self.normal[at];
        self.normal[at] * acceleration + excess * acceleration.dot(&tangent) * tangent
    }

    fn value(&self, powers: &[Field; 4], at: Slot) -> Vector3<f64> {
        let [p0, p1, p2, p3] = [0, 1, 2, 3].map(|power| powers[power].get(at));
        p0 + self.passed * (p1 + self.passed * (p2 + self.passed * p3))
    }
}

/// Velocities of the water at the nodes of a row at the heights z [m], in [m/s].
#[inline(always)]
pub(super) fn water_flow(
    current: Option<&CurrentNow>,
    waves: Option<&WaveArrays>,
    at: usize,
    z: Lanes,
) -> Vectors {
    // closures would not be compiled for the vector unit of the kernel
    let mut flow = Vectors::zero();
    if let Some(current) = current {
        let shape = current.profile.velocities(z);
        flow = shape.scale(Lanes::splat(current.factor));
    }
    match waves {
        Some(waves) => flow + waves.velocity(at),
        None => flow,
    }
}

/// Inverse of the norm of vectors with this square [1/m], finite if that is 0.
#[inline(always)]
pub(super) fn inverse_norm(square: Lanes) -> Lanes {
    (square + Lanes::splat(LENGTH2_MIN)).sqrt().recip()
}

/// The same of one vector.
pub(super) fn inverse_norm_of(square: f64) -> f64 {
    1.0 / (square + LENGTH2_MIN).sqrt()
}

#[inline(always)]
fn polynomial(powers: &[Field; 4], passed: f64, at: usize) -> Vectors {
    let u = Lanes::splat(passed);
    let [p0, p1, p2, p3] = powers;
    p0.load(at) + (p1.load(at) + (p2.load(at) + p3.load(at).scale(u)).scale(u)).scale(u)
}

/// Lumped contact coefficients [N/m, N s/m] and the z [m] below which they push; over a bed that slopes or rubs the height above it, along its normal.
#[derive(Debug, Clone)]
pub(super) struct ContactArrays {
    pub level: Column,
    pub stiffness: Column,
    pub damping: Column,
    /// Where the bed is more than a level plane without friction.
    pub bottom: Option<BottomArrays>,
}

/// A bed that slopes or rubs.
#[derive(Debug, Clone)]
pub(super) struct BottomArrays {
    pub bottom: Arc<Bottom>,
    /// Stiffness along the bed of a node that sticks [N/m]; 0 without friction.
    pub stick: Column,
    /// Friction on the nodes in the last step [N].
    pub rub: Field,
}

impl ContactArrays {
    /// Stiffness [N/m] and damping [N s/m] of a row.
    #[inline(always)]
    pub fn law(&self, at: usize) -> [Lanes; 2] {
        [self.stiffness.load(at), self.damping.load(at)]
    }

    fn new(contact: &Contact, fold: Fold) -> ContactArrays {
        let lifts = || (0..contact.level.len()).map(|i| contact.lift(i)).collect();
        let bottom = contact.bottom.as_ref();
        let level: Vec<f64> = bottom.map_or_else(|| contact.level.clone(), |_| lifts());
        let keep = |values: &[f64]| fold.column(values, 0.0);
        ContactArrays {
            bottom: bottom.map(|bottom| BottomArrays {
                bottom: bottom.clone(),
                stick: keep(&contact.stick),
                rub: Field::zeros(fold),
            }),
            level: keep(&level),
            stiffness: keep(&contact.stiffness),
            damping: keep(&contact.damping),
        }
    }

    /// Spring and damper of the node at `at`.
    pub fn coefficients(&self, at: Slot) -> ContactCoefficients {
        ContactCoefficients {
            stiffness: self.stiffness[at],
            damping: self.damping[at],
        }
    }
}

/// Whether [`Layout::soundness`] of all rows is positive, for the vector unit of the machine.
struct AreSound<'a>(&'a Layout);

impl NullaryFnOnce for AreSound<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let mut sound = Lanes::splat(1.0);
        for row in self.0.rows() {
            sound = sound.where_positive(self.0.soundness(row));
        }
        sound.all_positive()
    }
}

/// Nodes of a state: positions [m], velocities at the time of these, and half a step and one and a half steps before [m/s].
struct Nodes<'a> {
    position: &'a mut [Vector3<f64>],
    velocity: &'a mut [Vector3<f64>],
    half: &'a mut [Vector3<f64>],
    before: &'a mut [Vector3<f64>],
}

impl<'a> Nodes<'a> {
    /// So many of each, which the compiler is to see.
    #[inline(always)]
    fn first(self, count: usize) -> Nodes<'a> {
        Nodes {
            position: &mut self.position[..count],
            velocity: &mut self.velocity[..count],
            half: &mut self.half[..count],
            before: &mut self.before[..count],
        }
    }

    /// Takes over what a node has `of` these in a lane; nothing if it is padding.
    #[inline(always)]
    fn take(&mut self, node: usize, lane: usize, of: &[Vectors; 4]) {
        if node < self.position.len() {
            self.position[node] = of[0].get(lane);
            self.velocity[node] = of[1].get(lane);
            self.half[node] = of[2].get(lane);
            self.before[node] = of[3].get(lane);
        }
    }
}

/// [`Layout::store`] for the vector unit of the machine.
struct HandBack<'a>(&'a Layout, &'a mut LineState, [f64; 2]);

impl NullaryFnOnce for HandBack<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        self.0.hand_back(self.1, self.2)
    }
}

impl Layout {
    /// Arrays for a line, whose kernel has no use for vectors of eight numbers over `few_rows` or less; `None` where its sections have
    /// different strain measures, which the kernels do not mix.
    pub fn new(line: &Line, water: Water<'_>, solver: &Solver, few_rows: usize) -> Option<Layout> {
        let n = line.segment_count();
        let fold = Fold::new(n + 1);
        let keep = |values: &[f64]| fold.column(values, 0.0);
        let nodes = &line.nodes;
        let inverse_lengths: Vec<f64> = line.segments.length.iter().map(|l| 1.0 / l).collect();
        let creep = CreepArrays::new(line, fold);
        let (stiffness, damping) = match &creep {
            Some(creep) => (creep.stiffness.clone(), creep.damping.clone()),
            None => (
                keep(&line.segments.axial_stiffness),
                keep(&line.segments.axial_damping),
            ),
        };
        Some(Layout {
            segment_count: n,
            last: [n, n - 1].map(|i| fold.slot(i)),
            fold,
            vector_unit: unit::over_rows(fold.rows(), few_rows),
            few_rows,
            law: line.uniform_law()?,
            negative_tension: solver.negative_tension,
            books: solver.energy_ledger,
            position: padded_positions(fold),
            velocity: Field::zeros(fold),
            velocity_before: Field::zeros(fold),
            inverse_length: fold.column(&inverse_lengths, 1.0),
            axial_stiffness: stiffness,
            axial_damping: damping,
            weight: keep(&nodes.weight),
            drag: nodes.drag.as_ref().map(|drag| DragArrays {
                normal: keep(&drag.normal),
                tangent: keep(&drag.tangent),
            }),
            waves: water.waves.then(|| WaveArrays::new(line, fold)),
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
                .map(|contact| ContactArrays::new(contact, fold)),
            creep,
            surface: SurfaceNow::new(line),
        })
    }

    /// Runs the kernels as they are compiled for any machine of the target, or for the best vectors of this one.
    pub fn set_portable(&mut self, portable: bool) {
        self.vector_unit = match portable {
            true => Arch::Scalar,
            false => unit::over_rows(self.fold.rows(), self.few_rows),
        };
    }

    /// Takes over positions and velocities of a line; the ghosts are yet to be renewed. Padding starts anew: it may have met what a step
    /// that was too long made of the nodes beside it.
    pub fn load(&mut self, state: &LineState) {
        if let Some(creep) = &mut self.creep {
            creep.load(&state.creep);
        }
        let memory = &state.half_step;
        let fresh = memory.velocity.is_empty();
        let zero = Vector3::zeros();
        for (i, at) in self.fold.slots().enumerate() {
            let Some(position) = state.position.get(i) else {
                self.position.set(at, padding(i));
                self.velocity.set(at, zero);
                self.velocity_before.set(at, zero);
                continue;
            };
            self.position.set(at, *position);
            let (velocity, before) = if fresh {
                (state.velocity[i], state.velocity[i])
            } else {
                (memory.velocity[i], memory.velocity_before[i])
            };
            self.velocity.set(at, velocity);
            self.velocity_before.set(at, before);
        }
    }

    /// Rounds speeds far below [`STILLNESS`] to zero.
    pub fn still(&mut self) {
        for at in self.rows() {
            self.velocity
                .store(self.velocity.load(at).rounded(STILLNESS), at);
        }
    }

    /// Makes the ghosts repeat the nodes where they are now. Ends that have parted have no neighbour beyond them.
    #[inline(always)]
    pub fn renew_ghosts(&mut self, parted: [bool; 2]) {
        self.position.wrap();
        self.velocity.wrap();
        self.velocity_before.wrap();
        self.part_ghosts(parted);
    }

    /// The same, for what needs no more than the positions of the nodes beside a node and the velocity of the one after.
    #[inline(always)]
    pub fn renew_neighbours(&mut self, parted: [bool; 2]) {
        self.position.wrap();
        let first = self.velocity.load(1);
        self.velocity
            .store(first.moved_down(), self.fold.rows() + 1);
        self.part_ghosts(parted);
    }

    /// Puts the ghosts beyond ends that have parted where these ends are.
    #[inline(always)]
    pub fn part_ghosts(&mut self, parted: [bool; 2]) {
        for end in [End::A, End::B] {
            if parted[end as usize] {
                let at = self.end_slot(end);
                let beyond = if end == End::A {
                    at.before()
                } else {
                    at.after()
                };
                self.position.set(beyond, self.position.get(at));
            }
        }
    }

    /// Sets how many of the segments that there is room for the line has.
    pub fn set_segment_count(&mut self, count: usize) {
        self.segment_count = count;
        self.last = [count, count - 1].map(|i| self.fold.slot(i));
    }

    /// (v·t)² of nodes whose neighbours are known [m²/s²].
    #[inline(always)]
    pub fn along_squared(&self, at: usize) -> Lanes {
        let chord = self.position.load(at + 1) - self.position.load(at - 1);
        let along = self.velocity.load(at).dot(chord);
        let square = chord.dot(chord) + Lanes::splat(LENGTH2_MIN);
        along * along * square.recip()
    }

    /// Where node `i` and segment `i` stand.
    pub fn slot(&self, i: usize) -> Slot {
        self.fold.slot(i)
    }

    /// Where the nodes stand, in their order.
    pub fn nodes(&self) -> impl Iterator<Item = Slot> + use<> {
        self.fold.slots().take(self.segment_count + 1)
    }

    /// Hands them back after steps of `steps` [s], with velocities extrapolated to the time of the positions. Whether all nodes have finite
    /// positions, and speeds that mooring lines reach.
    pub fn store(&self, state: &mut LineState, steps: [f64; 2]) -> bool {
        self.vector_unit.dispatch(HandBack(self, state, steps))
    }

    /// [`Self::store`], wherever it is compiled into.
    #[inline(always)]
    pub fn hand_back(&self, state: &mut LineState, steps: [f64; 2]) -> bool {
        if let Some(creep) = &self.creep {
            creep.store(&mut state.creep);
        }
        let memory = &mut state.half_step;
        let count = state.position.len();
        memory.velocity.resize(count, Vector3::zeros());
        memory.velocity_before.resize(count, Vector3::zeros());
        memory.steps = steps;
        let extrapolation = Lanes::splat(Step::after(steps, steps[0]).extrapolation);
        let nodes = Nodes {
            position: &mut state.position,
            velocity: &mut state.velocity,
            half: &mut memory.velocity,
            before: &mut memory.velocity_before,
        };
        let mut nodes = nodes.first(count);
        let (rows, mut sound) = (self.fold.rows(), Lanes::splat(1.0));
        for row in 0..rows {
            let at = row + 1;
            let (half, before) = (self.velocity.load(at), self.velocity_before.load(at));
            let velocity = half + (half - before).scale(extrapolation);
            let of = [self.position.load(at), velocity, half, before];
            sound = sound.where_positive(self.soundness(at));
            // a loop over lanes would be made one of vectors, which cannot be written so
            nodes.take(row, 0, &of);
            nodes.take(rows + row, 1, &of);
            nodes.take(2 * rows + row, 2, &of);
            nodes.take(3 * rows + row, 3, &of);
        }
        if let Some(bottom) = self.bottom() {
            let places = state.position.iter().zip(self.fold.slots());
            for (anchor, (position, at)) in state.anchor.iter_mut().zip(places) {
                *anchor = position + bottom.rub.get(at) / bottom.stick[at];
            }
        }
        sound.all_positive()
    }

    /// The bed, where it is more than a level plane without friction.
    pub fn bottom(&self) -> Option<&BottomArrays> {
        self.contact.as_ref()?.bottom.as_ref()
    }

    /// The contact with a bed that slopes or rubs, and its friction.
    pub fn rubbing(&self) -> Option<(&ContactArrays, Option<&Friction>)> {
        let contact = self.contact.as_ref()?;
        let bottom = contact.bottom.as_ref()?;
        Some((contact, bottom.bottom.friction.as_ref()))
    }

    /// Remembers the friction on a node [N].
    pub fn set_rub(&mut self, at: Slot, rub: Vector3<f64>) {
        if let Some(contact) = &mut self.contact
            && let Some(bottom) = &mut contact.bottom
        {
            bottom.rub.set(at, rub);
        }
    }

    /// How far the node at `at` is below the level from which the bed pushes it [m], and the bed's normal there; it must lie over a bed that
    /// slopes or rubs.
    #[inline]
    pub fn stand(&self, at: Slot) -> (f64, Vector3<f64>) {
        let contact = self.contact.as_ref().expect("asked over a bed only");
        let bottom = contact
            .bottom
            .as_ref()
            .expect("asked over a bed that slopes or rubs only");
        let (below, normal) = bottom.bottom.ground.stand(self.position.get(at));
        (below + contact.level[at], normal)
    }

    /// Unit vector along the chord of the nodes beside node `i`, at an end along the segment.
    pub fn tangent_of(&self, i: usize) -> Vector3<f64> {
        let before = self.slot(i.saturating_sub(1));
        let after = self.slot((i + 1).min(self.segment_count));
        let chord = self.position.get(after) - self.position.get(before);
        chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
    }

    /// Finds where the surface crosses the line, and sets the weights of the nodes it crosses.
    pub fn find_surface(&mut self) {
        let Some(surface) = &mut self.surface else {
            return;
        };
        if let Some(waves) = &self.waves {
            for (i, level) in surface.level.iter_mut().enumerate() {
                *level = waves.elevation(i);
            }
            surface.find_calm(self.fold, &self.position);
        }
        surface.find(self.fold, &self.position);
        for i in surface.crossed() {
            let now = surface.node(i);
            let at = self.fold.slot(i);
            self.weight[at] = now.weight;
            if let Some(waves) = &mut self.waves {
                [waves.normal[at], waves.tangent[at]] = now.pressed;
            }
            if let Some(drag) = &mut self.drag {
                [drag.normal[at], drag.tangent[at]] = now.drag;
            }
        }
    }

    /// Books what joined with the water, except at ends that are held.
    pub fn book_surface(&mut self, held: [bool; 2]) {
        let Some(surface) = &mut self.surface else {
            return;
        };
        let [first, last] = held.map(usize::from);
        for i in first..=self.segment_count - last {
            surface.book(i, self.fold, &self.velocity);
        }
    }

    /// Goes on to the end of a step, and books what waves did with the buoyancy in it, except at ends that are held.
    pub fn leave_surface(&mut self, step: Step, held: [bool; 2]) {
        let (Some(surface), Some(waves)) = (&mut self.surface, &mut self.waves) else {
            return;
        };
        let [first, last] = held.map(usize::from);
        for i in first..=self.segment_count - last {
            let at = self.fold.slot(i);
            let velocities = self.velocity.get(at).z + self.velocity_before.get(at).z;
            surface.book_lift(i, 0.5 * step.kick * velocities);
        }
        waves.pass(step.drift);
    }

    /// Work of waves on the buoyancy since the state was loaded [J].
    pub fn lifted(&self) -> f64 {
        self.surface.as_ref().map_or(0.0, |surface| surface.lifted)
    }

    /// Forgets what joined with the water.
    pub fn clear_surface(&mut self) {
        if let Some(surface) = &mut self.surface {
            (surface.joined, surface.lifted) = (0.0, 0.0);
        }
    }

    /// Buoyancy that an end lacks at t_n [N].
    pub fn end_lack(&self, end: End) -> f64 {
        let node = self.end_node(end);
        let surface = self.surface.as_ref();
        surface.map_or(0.0, |surface| surface.lack(node, self.waves.is_some()))
    }

    /// Energy of motion that joined with the water since the state was loaded [J].
    pub fn joined(&self) -> f64 {
        self.surface.as_ref().map_or(0.0, |surface| surface.joined)
    }

    /// Sets what multiplies the current at t_n [-].
    pub fn set_current(&mut self, factor: f64) {
        if let Some(current) = &mut self.current {
            current.factor = factor;
        }
    }

    /// Takes over what waves do at the nodes of line number `line` over a span of time.
    pub fn load_waves(&mut self, span: Option<&WaveSpan>, line: usize) {
        let (Some(waves), Some(span)) = (&mut self.waves, span) else {
            return;
        };
        waves.times = span.times;
        let [before, after] = &span.ends;
        waves.surface.clear();
        if self.surface.is_some() {
            let of = |orbit: &Orbit| [orbit.elevation, orbit.rise];
            let nodes = before.lines[line].iter().zip(&after.lines[line]);
            waves.surface.extend(nodes.map(|(b, a)| [of(b), of(a)]));
        }
        let nodes = before.lines[line].iter().zip(&after.lines[line]);
        for (at, (before, after)) in self.fold.slots().zip(nodes) {
            let [velocity, acceleration] = cubics(before, after, span.times);
            for power in 0..4 {
                waves.velocity[power].set(at, velocity[power]);
                waves.acceleration[power].set(at, acceleration[power]);
            }
        }
    }

    /// Sets the waves to those of t_n [s].
    pub fn set_time(&mut self, t: f64) {
        if let Some(waves) = &mut self.waves {
            let [t0, t1] = waves.times;
            waves.passed = if t1 > t0 { (t - t0) / (t1 - t0) } else { 0.0 };
        }
    }

    /// Whether the water moves.
    pub fn flows(&self) -> bool {
        self.current.is_some() || self.waves.is_some()
    }

    /// Velocities of the water at the nodes [m/s].
    #[inline(always)]
    pub fn water_velocity(&self, at: usize) -> Vectors {
        let z = self.position.load(at).z;
        water_flow(self.current.as_ref(), self.waves.as_ref(), at, z)
    }

    /// Velocity of the water at a node [m/s].
    pub fn water_velocity_of(&self, at: Slot) -> Vector3<f64> {
        let flow = self.current.as_ref().map_or(Vector3::zeros(), |current| {
            current.stream().velocity(self.position.get(at).z)
        });
        match &self.waves {
            None => flow,
            Some(waves) => flow + waves.value(&waves.velocity, at),
        }
    }

    /// Puts an end at a position [m] with the velocity [m/s] that the next step takes as lagged.
    #[inline(always)]
    pub fn put_end(&mut self, end: End, position: Vector3<f64>, velocity: Vector3<f64>) {
        let at = self.end_slot(end);
        self.position.set(at, position);
        self.velocity.set(at, velocity);
    }

    /// The node at an end.
    pub fn end_node(&self, end: End) -> usize {
        match end {
            End::A => 0,
            End::B => self.segment_count,
        }
    }

    /// Where the node at an end stands.
    pub fn end_slot(&self, end: End) -> Slot {
        match end {
            End::A => Slot { row: 1, lane: 0 },
            End::B => self.last[0],
        }
    }

    /// Where the segment at an end stands, and what the sign of its pull on the end is.
    pub fn end_segment(&self, end: End) -> (Slot, f64) {
        match end {
            End::A => (self.end_slot(End::A), 1.0),
            End::B => (self.last[1], -1.0),
        }
    }

    /// Where the neighbour of the node at an end stands.
    pub fn end_neighbour(&self, end: End) -> Slot {
        match end {
            End::A => self.slot(1),
            End::B => self.last[1],
        }
    }

    /// Rows of nodes, and of segments.
    #[inline(always)]
    pub fn rows(&self) -> std::ops::RangeInclusive<usize> {
        1..=self.fold.rows()
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
        let elastic = match &self.creep {
            Some(creep) => creep.elastic_of(at, strain),
            None => self.axial_stiffness[at] * self.law.at(strain).force,
        };
        let rate = if l > 0.0 {
            chord.dot(&now) / l * inverse
        } else {
            0.0
        };
        total_tension(
            elastic,
            self.axial_damping[at] * rate,
            0.0,
            self.negative_tension,
        )
    }

    /// Energy [J] that the half node at an end of masses across and along the line [kg] brings to the line when it parts from what held it
    /// at t_n.
    pub fn joining_energy(&self, end: End, [across, along]: [f64; 2], step: Step) -> f64 {
        let (at, other) = (self.end_slot(end), self.end_neighbour(end));
        let velocity = self.velocity.get(at);
        let chord = self.position.get(other) - self.position.get(at);
        let tangent = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let lag = step.kick - 0.5 * step.drift; // from the velocities to the positions
        let height = self.position.get(at).z - lag * velocity.z;
        let axial = velocity.dot(&tangent).powi(2);
        let kinetic = 0.5 * (across * (velocity.norm_squared() - axial) + along * axial);
        // the surface holds the energy of the buoyancy that is lacking by itself
        let lack = self
            .surface
            .as_ref()
            .map_or(0.0, |surface| surface.lack(self.end_node(end), false));
        kinetic + (self.weight[at] - lack) * height
    }

    /// Strain rate at t_n [1/s].
    #[inline(always)]
    pub fn strain_rate(&self, at: usize, direction: Vectors, step: Step) -> Lanes {
        let relative = self.velocity_now(at + 1, step) - self.velocity_now(at, step);
        direction.dot(relative) * self.inverse_length.load(at)
    }

    /// Strain of the segments [-].
    #[inline(always)]
    pub fn strain(&self, at: usize) -> Lanes {
        let (chord, inverse_l) = self.chord(at);
        let inverse_length = self.inverse_length.load(at);
        chord.dot(chord) * inverse_l * inverse_length - Lanes::splat(1.0)
    }

    /// Takes the memory of viscoelastic segments from t_n to t_{n+1}, `drift` [s] later, where the nodes now are.
    pub fn creep(&mut self, drift: f64) {
        if let Some(mut creep) = self.creep.take() {
            for at in self.rows() {
                creep.advance(at, self.strain(at), drift);
            }
            self.creep = Some(creep);
        }
    }

    /// Unit vectors along the chord of the neighbouring nodes.
    #[inline(always)]
    pub fn tangent(&self, at: usize) -> Vectors {
        let chord = self.position.load(at + 1) - self.position.load(at - 1);
        chord.scale(inverse_norm(chord.dot(chord)))
    }

    /// Vectors along the segments, and the inverse of their lengths.
    #[inline(always)]
    pub fn chord(&self, at: usize) -> (Vectors, Lanes) {
        let chord = self.position.load(at + 1) - self.position.load(at);
        (chord, inverse_norm(chord.dot(chord)))
    }

    /// Velocities extrapolated to t_n [m/s].
    #[inline(always)]
    pub fn velocity_now(&self, at: usize, step: Step) -> Vectors {
        let velocity = self.velocity.load(at);
        velocity
            + (velocity - self.velocity_before.load(at)).scale(Lanes::splat(step.extrapolation))
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

    /// > 0 for the nodes of a row that have a finite position, and a speed that mooring lines reach [m²/s²].
    #[inline(always)]
    pub fn soundness(&self, row: usize) -> Lanes {
        let (position, velocity) = (self.position.load(row), self.velocity.load(row));
        let zero = (position.x + position.y + position.z) * Lanes::splat(0.0); // or not a number
        let fastest = Lanes::splat(SPEED_MAX * SPEED_MAX);
        fastest + zero - velocity.dot(velocity)
    }

    /// Index of the node that moves fastest.
    pub fn fastest_node(&self) -> usize {
        let speeds = self.nodes().map(|at| self.velocity.get(at).norm_squared());
        let fastest = speeds.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
        fastest.map_or(0, |(node, _)| node)
    }

    /// Index of the first node that has no finite position, or a speed that no mooring line reaches.
    pub fn broken_node(&self) -> Option<usize> {
        let broken = |at: Slot| {
            let (position, velocity) = (self.position.get(at), self.velocity.get(at));
            let slow = velocity.norm_squared() < SPEED_MAX * SPEED_MAX;
            !slow || !position.iter().all(|value| value.is_finite())
        };
        match self.vector_unit.dispatch(AreSound(self)) {
            true => None,
            false => self.nodes().position(broken),
        }
    }
}

/// 1 for nodes between the ends, 0 elsewhere.
pub(super) fn interior(segment_count: usize) -> Column {
    let mut interior = vec![1.0; segment_count + 1];
    (interior[0], interior[segment_count]) = (0.0, 0.0);
    Fold::new(segment_count + 1).column(&interior, 0.0)
}

/// Padding far away and apart: its chords are never zero.
fn padded_positions(fold: Fold) -> Field {
    let mut position = Field::zeros(fold);
    for (i, at) in fold.slots().enumerate() {
        position.set(at, padding(i));
    }
    position
}

/// Where node `i` is if it is padding [m].
fn padding(i: usize) -> Vector3<f64> {
    i as f64 * Vector3::x()
}
