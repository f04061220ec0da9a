//! Leapfrog with the axial tension implicit: the axial wave no longer limits the step.
//!
//! With geometry q = d/l lagged at t_n and G(x)_i = (x_{i+1} − x_i)/L_i, the tension that drives v_{n−½} -> v_{n+½} is
//!
//! T̄ = [T^{n+1} + (2ρ+b)T^n + (ρ²+2ρb)T^{n−1} + ρ²b T^{n−2}]/N,  b = (1−ρ)/(2ρ),  N = (1+ρ)²(1+b),
//!
//! second order and unconditionally stable with spectral radius ρ at infinite frequency (ρ = 1: ¼, ½, ¼). The new strain is
//! linear in the new velocity, ε^{n+1} = ε^n + κ + Δt q·G(v), κ = Δt²(|G(v⁻)|² − (q·G(v⁻))²)/(2|G(r)|), so that
//!
//! T̄ − k q·G(v) = EA b₁(ε^n + κ) + H + ½BA(1−θ) q·G(v⁻),  k = EA b₁Δt + ½BA(1+θ),  b₁ = 1/N,
//!
//! with the history terms H and θ = 0.2. A row is off where the total would be negative. Eliminating v by the nodes'
//! momentum leaves one scalar tridiagonal system in T̄. Drag is trapezoidal and folded into the node's mass, the seabed
//! too; flags of slack and contact are checked after the solve and the step repeated until they hold.
//!
//! Source: Stern & Grinspun (2009), Implicit-explicit variational integration of highly oscillatory problems, Multiscale
//! Model. Simul. 7, 1779-1794, with controllable dissipation added. The limit left is transverse:
//! [`super::limit::transverse_step`].

mod rubbing;

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::layout::{Layout, Water, interior};
use super::leapfrog::Step;
use super::ledger::Flow;
use crate::math::fold::{Column, Field};
use crate::math::lanes::{Lanes, Vectors};
use crate::model::{End, Line, LineState, Parting, WaveSpan};
use crate::physics::stretch::StretchLaw;
use rubbing::Rubbing;

/// Passes over slack and contact flags, at most [-].
const PASSES_MAX: usize = 8;
/// Weight of the new strain rate over the old one in the axial damping [-].
const DAMPING_SHIFT: f64 = 0.2; // θ
/// Change of tension by the true stretch, relative to the greatest tension, that asks for another pass [-].
const STRETCH_TOLERANCE: f64 = 1e-3;

/// Weights of T^{n+1}, T^n, T^{n−1}, T^{n−2} in T̄.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights([f64; 4]);

impl Weights {
    /// For the spectral radius ρ [-] at infinite frequency, 0 < ρ ≤ 1.
    pub fn new(rho: f64) -> Weights {
        let b = (1.0 - rho) / (2.0 * rho);
        let n = (1.0 + rho) * (1.0 + rho) * (1.0 + b);
        Weights([1.0, 2.0 * rho + b, rho * (rho + 2.0 * b), rho * rho * b].map(|weight| weight / n))
    }
}

/// A line and the scratch of its steps.
#[derive(Debug, Clone)]
pub struct AxialWork {
    layout: Layout,
    weights: Weights,
    segments: SegmentArrays,
    nodes: NodeArrays,
    rows: Rows,
    /// The moving water at the nodes, where it acts on the line.
    current: Option<CurrentArrays>,
    /// The bed under the nodes, where it is more than a level plane without friction.
    rubbing: Option<Rubbing>,
    /// 1 for nodes between the ends, 0 elsewhere.
    interior: Column,
    /// Whether ends A and B have parted from their points.
    parted: [bool; 2],
    /// Energy lost and given since the state was loaded [J].
    lost: Lanes,
    given: f64,
    tension_peak: f64,
}

/// What a step knows of the segments before it is solved.
#[derive(Debug, Clone)]
struct SegmentArrays {
    /// Unit vectors q along the segments.
    direction: Field,
    /// Lengths l at t_n [m].
    length: Column,
    /// dT̄/d(q·(v_{i+1} − v_i)): elastic and damping part [N s/m].
    stiffness: Column,
    damping: Column,
    /// Parts of T̄ known beforehand: elastic, and with damping [N].
    elastic: Column,
    known: Column,
    /// EA·b₁ times the stretch by transverse motion [N].
    curvature: Column,
    /// 1 where the segment is taut, −1 where it is slack.
    taut: Column,
    /// Elastic tensions at t_{n−1} and t_{n−2} [N].
    history: [Column; 2],
}

/// What a step knows of the nodes: M⁻¹ x = a x + b (t·x) t − c (s·x) s, with s = (a I + b t tᵀ) ẑ.
#[derive(Debug, Clone)]
struct NodeArrays {
    mass_normal: Column,
    mass_tangent: Column,
    /// a, with drag folded in [1/kg].
    across: Column,
    /// b [1/kg].
    excess: Column,
    tangent: Field,
    /// s [1/kg].
    response: Field,
    /// c, 0 off the bed [kg].
    held: Column,
    /// 1 where the bed pushes, −1 elsewhere.
    touches: Column,
    /// Velocity without tension, without and with the bed [m/s].
    fall: Field,
    loose: Field,
}

/// What a step knows of the water that flows past the nodes.
#[derive(Debug, Clone)]
struct CurrentArrays {
    /// Velocity of the water [m/s].
    flow: Field,
    /// Drag over relative velocity, across and along the line [N s/m].
    across: Column,
    along: Column,
    /// Force of water that waves accelerate [N].
    press: Field,
}

/// The tridiagonal system in T̄.
#[derive(Debug, Clone)]
struct Rows {
    lower: Column,
    diagonal: Column,
    upper: Column,
    tension: Column,
}

impl AxialWork {
    /// Scratch for a line; `None` where its sections have different strain measures, which the kernel does not mix.
    pub fn new(
        line: &Line,
        water: Water<'_>,
        rho: f64,
        negative_tension: bool,
    ) -> Option<AxialWork> {
        let layout = Layout::new(line, water, negative_tension)?;
        let (n, fold) = (layout.segment_count, layout.fold);
        let (zeros, vectors) = (Column::new(fold, 0.0), Field::zeros(fold));
        Some(AxialWork {
            interior: interior(n),
            parted: [false; 2],
            current: layout.flows().then(|| CurrentArrays {
                flow: vectors.clone(),
                across: zeros.clone(),
                along: zeros.clone(),
                press: vectors.clone(),
            }),
            rubbing: layout.bottom().map(|_| Rubbing::new(fold)),
            lost: Lanes::splat(0.0),
            given: 0.0,
            tension_peak: 0.0,
            layout,
            weights: Weights::new(rho),
            segments: SegmentArrays {
                direction: vectors.clone(),
                length: zeros.clone(),
                stiffness: zeros.clone(),
                damping: zeros.clone(),
                elastic: zeros.clone(),
                known: zeros.clone(),
                curvature: zeros.clone(),
                taut: zeros.clone(),
                history: [zeros.clone(), zeros.clone()],
            },
            nodes: NodeArrays {
                mass_normal: fold.column(&line.nodes.mass_normal, 1.0),
                mass_tangent: fold.column(&line.nodes.mass_tangent, 1.0),
                across: zeros.clone(),
                excess: zeros.clone(),
                tangent: vectors.clone(),
                response: vectors.clone(),
                held: zeros.clone(),
                touches: zeros.clone(),
                fall: vectors.clone(),
                loose: vectors,
            },
            rows: Rows {
                lower: zeros.clone(),
                diagonal: Column::new(fold, 1.0),
                upper: zeros.clone(),
                tension: zeros,
            },
        })
    }

    /// Takes over the state of a line.
    pub fn load(&mut self, state: &LineState) {
        self.layout.load(state);
        self.parted = state.parted;
        self.layout.renew_ghosts(self.parted);
        for end in [End::A, End::B] {
            let at = self.layout.end_slot(end);
            self.interior[at] = f64::from(u8::from(self.parted[end as usize]));
        }
        (self.lost, self.given, self.tension_peak) = (Lanes::splat(0.0), 0.0, 0.0);
        let count = self.layout.segment_count;
        if state.half_step.tension[0].len() == count {
            for (own, kept) in self
                .segments
                .history
                .iter_mut()
                .zip(&state.half_step.tension)
            {
                own.assign(kept);
            }
            return;
        }
        for at in self.layout.rows() {
            let (chord, inverse_l) = self.layout.chord(at);
            let tension = match &self.layout.creep {
                None => {
                    let (force, _) = self.force_and_slope(at, chord.dot(chord) * inverse_l);
                    self.layout.axial_stiffness.load(at) * force.positive()
                }
                Some(creep) => creep.elastic(at, self.layout.strain(at)).positive(),
            };
            self.segments
                .history
                .iter_mut()
                .for_each(|history| history.store(tension, at));
        }
    }

    /// Energy given by the held ends and lost between them since [`Self::load`].
    pub fn flow(&self) -> Flow {
        Flow {
            given: self.given + self.layout.lifted(),
            lost: self.lost.sum() - self.layout.joined(),
        }
    }

    /// Hands the state back after steps of `steps` [s].
    pub fn store(&self, state: &mut LineState, steps: [f64; 2]) {
        state.parted = self.parted;
        self.layout.store(state, steps);
        let count = self.layout.segment_count;
        for (kept, history) in state
            .half_step
            .tension
            .iter_mut()
            .zip(&self.segments.history)
        {
            kept.clear();
            kept.extend(history.values(count));
        }
    }

    /// Takes over what waves do at the nodes of this line, by its number, over a span of time.
    pub fn load_waves(&mut self, span: Option<&WaveSpan>, line: usize) {
        self.layout.load_waves(span, line);
    }

    /// Meets the water's surface as it is at t_n. Where that is `after` a step, what joined with the water in it is booked.
    pub fn meet_surface(&mut self, after: Option<Step>) {
        if let Some(step) = after {
            self.layout
                .leave_surface(step, self.parted.map(|parted| !parted));
        }
        self.layout.find_surface();
        let Some(surface) = &self.layout.surface else {
            return;
        };
        for i in surface.crossed() {
            let [across, along] = surface.node(i).masses;
            let at = self.layout.slot(i);
            self.nodes.mass_normal[at] = across;
            self.nodes.mass_tangent[at] = along;
        }
        match after {
            Some(_) => self.layout.book_surface(self.parted.map(|parted| !parted)),
            None => self.layout.clear_surface(),
        }
    }

    /// Sets what multiplies the current at t_n [-].
    pub fn set_current(&mut self, factor: f64) {
        self.layout.set_current(factor);
    }

    /// Sets the waves to those of t_n [s].
    pub fn set_time(&mut self, t: f64) {
        self.layout.set_time(t);
    }

    /// Puts an end at a position [m] with the velocity [m/s] that the next step takes as lagged.
    pub fn put_end(&mut self, end: End, position: Vector3<f64>, velocity: Vector3<f64>) {
        if !self.parted[end as usize] {
            self.layout.put_end(end, position, velocity);
            self.layout.renew_ghosts(self.parted);
        }
    }

    /// Parts the ends from their points that the tensions of t_n, `t` [s], are too much for, or the time has come for.
    pub fn part_ends(&mut self, partings: &[Parting; 2], t: f64, step: Step) {
        for end in [End::A, End::B] {
            let (side, at) = (end as usize, self.layout.end_slot(end));
            let tension = self.layout.end_tension(end, step);
            if self.parted[side] || !partings[side].parts(tension, t) {
                continue;
            }
            let masses = [self.nodes.mass_normal[at], self.nodes.mass_tangent[at]];
            self.given += self.layout.joining_energy(end, masses, step);
            self.parted[side] = true;
            self.interior[at] = 1.0;
        }
    }

    /// Ends that a point holds.
    fn held_ends(&self) -> impl Iterator<Item = End> + use<> {
        let parted = self.parted;
        [End::A, End::B]
            .into_iter()
            .filter(move |&end| !parted[end as usize])
    }

    /// One step; `ends` are the positions [m] of both ends after it. Returns the passes it took.
    pub fn step(&mut self, step: Step, ends: [Vector3<f64>; 2]) -> usize {
        let unit = self.layout.vector_unit;
        unit.dispatch(AxialStep(self, step, ends))
    }

    #[inline(always)]
    fn choose_step(&mut self, step: Step, ends: [Vector3<f64>; 2]) -> usize {
        match self.current {
            None => self.step_vectors::<false>(step, ends),
            Some(_) => self.step_vectors::<true>(step, ends),
        }
    }

    #[inline(always)]
    fn step_vectors<const CURRENT: bool>(&mut self, step: Step, ends: [Vector3<f64>; 2]) -> usize {
        match self.layout.creep {
            None => self.prepare_segments::<false>(step),
            Some(_) => self.prepare_segments::<true>(step),
        }
        self.prepare_nodes::<CURRENT>(step);
        if self.rubbing.is_some() {
            self.meet_bed(step);
        }
        self.prepare_ends(step, ends);
        let mut passes = 0;
        loop {
            passes += 1;
            self.assemble_rows(step);
            let greatest = self.rows.solve(self.layout.segment_count);
            self.tension_peak = self.tension_peak.max(greatest);
            let bed_holds =
                self.find_velocities(step) && (self.rubbing.is_none() || self.check_bed(step));
            let slack_holds = self.check_segments(step, greatest);
            if bed_holds && slack_holds || passes == PASSES_MAX {
                break;
            }
        }
        if self.rubbing.is_some() {
            self.keep_rub(step);
        }
        self.book(step);
        if CURRENT {
            self.book_current(step);
        }
        std::mem::swap(&mut self.layout.velocity, &mut self.layout.velocity_before);
        self.layout.drift(step.drift);
        for end in self.held_ends() {
            let at = self.layout.end_slot(end);
            self.layout.position.set(at, ends[end as usize]);
        }
        self.layout.renew_ghosts(self.parted);
        self.layout.creep(step.drift);
        self.meet_surface(Some(step));
        passes
    }

    /// N(ε)/EA and its slope for segments of length `l` [m].
    #[inline(always)]
    fn force_and_slope(&self, at: usize, l: Lanes) -> (Lanes, Lanes) {
        let one = Lanes::splat(1.0);
        let strain = l * self.layout.inverse_length.load(at) - one;
        match &self.layout.law {
            StretchLaw::Engineering => (strain, one),
            law => (
                strain.map(|e| law.at(e).force),
                strain.map(|e| law.at(e).slope),
            ),
        }
    }

    #[inline(always)]
    fn prepare_segments<const CREEPS: bool>(&mut self, step: Step) {
        let [b1, h0, h1, h2] = self.weights.0.map(Lanes::splat);
        let drift = Lanes::splat(step.drift);
        for at in self.layout.rows() {
            let line = &self.layout;
            let (chord, inverse_l) = line.chord(at);
            let direction = chord.scale(inverse_l);
            let l = chord.dot(chord) * inverse_l;
            let inverse_length = line.inverse_length.load(at);
            let relative = line.velocity.load(at + 1) - line.velocity.load(at);
            let along = direction.dot(relative);
            let (force, slope) = self.force_and_slope(at, l);
            let ea = line.axial_stiffness.load(at);
            let mut tension = ea * force.positive();
            let (mut ahead, mut tangent) = (b1 * ea * force, b1 * ea * slope);
            if CREEPS {
                let (now, coming, stiffness) = self.creeping_forces(at, direction, step);
                tension = now.positive();
                (ahead, tangent) = (b1 * coming, b1 * stiffness);
            }
            let line = &self.layout;
            let segments = &mut self.segments;
            let [last, before] = &mut segments.history;
            let (t1, t2) = (last.load(at), before.load(at));
            last.store(tension, at);
            before.store(t1, at);
            let elastic = ahead + h0 * tension + h1 * t1 + h2 * t2;
            let damping = Lanes::splat(0.5) * line.axial_damping.load(at) * inverse_length;
            let stiffness = tangent * drift * inverse_length;
            let bend = relative.dot(relative) - along * along;
            let curvature = Lanes::splat(0.5) * stiffness * drift * bend * inverse_l;
            let known = elastic + damping * Lanes::splat(1.0 - DAMPING_SHIFT) * along;
            segments.direction.store(direction, at);
            segments.length.store(l, at);
            segments.stiffness.store(stiffness, at);
            segments
                .damping
                .store(damping * Lanes::splat(1.0 + DAMPING_SHIFT), at);
            segments.elastic.store(elastic, at);
            segments.known.store(known, at);
            segments.curvature.store(curvature, at);
            let taut = (known + curvature).choose(Lanes::splat(1.0), Lanes::splat(-1.0));
            segments.taut.store(taut, at);
        }
        self.segments.direction.wrap();
    }

    /// Elastic force of viscoelastic segments now [N], after the step without further strain [N], and its slope with the strain then
    /// [N]; books what is lost in the step.
    #[inline(always)]
    fn creeping_forces(
        &mut self,
        at: usize,
        direction: Vectors,
        step: Step,
    ) -> (Lanes, Lanes, Lanes) {
        let strain = self.layout.strain(at);
        let rate = self.layout.strain_rate(at, direction, step);
        let creep = self.layout.creep.as_mut().expect("this line creeps");
        creep.strain.store(strain, at);
        let now = creep.elastic(at, strain);
        let loss = creep.loss(at, strain, rate, now.positive());
        let length = self.layout.inverse_length.load(at).recip();
        self.lost = self.lost + loss * length * Lanes::splat(step.kick);
        let creep = self.layout.creep.as_ref().expect("this line creeps");
        let (coming, stiffness) = creep.ahead(at, strain, step.drift);
        (now, coming, stiffness)
    }

    #[inline(always)]
    fn prepare_nodes<const CURRENT: bool>(&mut self, step: Step) {
        let kick = Lanes::splat(step.kick);
        let half = Lanes::splat(0.5) * kick;
        for at in self.layout.rows() {
            let line = &self.layout;
            let velocity = line.velocity.load(at);
            let tangent = line.tangent(at);
            let mut mass_normal = self.nodes.mass_normal.load(at);
            let mut mass_tangent = self.nodes.mass_tangent.load(at);
            let zero = Lanes::splat(0.0);
            let weight = zero - line.weight.load(at);
            let mut force = Vectors {
                x: zero,
                y: zero,
                z: weight,
            };
            if let Some(drag) = &line.drag {
                let (mut now, mut last) = (line.velocity_now(at, step), velocity);
                if CURRENT {
                    let flow = line.water_velocity(at);
                    (now, last) = (now - flow, last - flow);
                    let current = self
                        .current
                        .as_mut()
                        .expect("this kernel runs in moving water");
                    current.flow.store(flow, at);
                }
                let speed = now.dot(tangent);
                let across = now - tangent.scale(speed);
                let normal = drag.normal.load(at) * across.dot(across).sqrt();
                let along = drag.tangent.load(at) * speed.abs();
                mass_normal = mass_normal + half * normal;
                mass_tangent = mass_tangent + half * along;
                force = force
                    - last.scale(normal)
                    - tangent.scale((along - normal) * last.dot(tangent));
                if CURRENT {
                    let current = self
                        .current
                        .as_mut()
                        .expect("this kernel runs in moving water");
                    current.across.store(normal, at);
                    current.along.store(along, at);
                }
            }
            if CURRENT && let Some(waves) = &line.waves {
                let press = waves.press(at, tangent);
                force = force + press;
                let current = self.current.as_mut();
                let current = current.expect("this kernel runs in moving water");
                current.press.store(press, at);
            }
            if let Some(damping) = &line.mass_damping {
                let damping = damping.load(at);
                mass_normal = mass_normal + half * damping;
                mass_tangent = mass_tangent + half * damping;
                force = force - velocity.scale(damping);
            }
            self.invert_mass(at, tangent, [mass_normal, mass_tangent], force, kick);
            if self.layout.contact.is_some() && self.rubbing.is_none() {
                let touches = self.touches(at, velocity.z, step);
                self.nodes.touches.store(touches, at);
                self.settle(at, step);
            }
        }
    }

    /// The inverse mass of nodes, and how they fall under a force without tension.
    #[inline(always)]
    fn invert_mass(
        &mut self,
        at: usize,
        tangent: Vectors,
        [mass_normal, mass_tangent]: [Lanes; 2],
        force: Vectors,
        kick: Lanes,
    ) {
        let velocity = self.layout.velocity.load(at);
        let across = mass_normal.recip();
        let excess = mass_tangent.recip() - across;
        let response = tangent.scale(excess * tangent.z);
        let inverted = force.scale(across) + tangent.scale(excess * force.dot(tangent));
        let nodes = &mut self.nodes;
        nodes.across.store(across, at);
        nodes.excess.store(excess, at);
        nodes.tangent.store(tangent, at);
        nodes.response.store(
            Vectors {
                z: response.z + across,
                ..response
            },
            at,
        );
        nodes.fall.store(velocity + inverted.scale(kick), at);
        nodes.loose.store(velocity + inverted.scale(kick), at);
    }

    /// Held ends move by the secant of their path and yield to no force.
    #[inline(always)]
    fn prepare_ends(&mut self, step: Step, ends: [Vector3<f64>; 2]) {
        for end in self.held_ends() {
            let (at, position) = (self.layout.end_slot(end), ends[end as usize]);
            let secant = (position - self.layout.position.get(at)) / step.drift;
            let nodes = &mut self.nodes;
            (nodes.across[at], nodes.excess[at], nodes.held[at]) = (0.0, 0.0, 0.0);
            nodes.touches[at] = -1.0;
            nodes.response.set(at, Vector3::zeros());
            nodes.loose.set(at, secant);
            nodes.fall.set(at, secant);
        }
    }

    /// 1 where the bed pushes nodes that rise at `rise` [m/s], else −1: they would be below the bed, and not leave it
    /// faster than the damper lets go.
    #[inline(always)]
    fn touches(&self, at: usize, rise: Lanes, step: Step) -> Lanes {
        let contact = self.layout.contact.as_ref().expect("asked over a bed only");
        let drift = Lanes::splat(step.drift);
        let penetration = contact.level.load(at) - self.layout.position.load(at).z;
        let next = penetration - drift * rise;
        let push = contact.stiffness.load(at) * next * drift
            + contact.damping.load(at) * (next - penetration.positive());
        let (yes, no) = (Lanes::splat(1.0), Lanes::splat(-1.0));
        let free = self.interior.load(at); // held ends yield to no bed
        free.choose(next.choose(push.choose(yes, no), no), no)
    }

    /// Adds the bed to the nodes it pushes: a rank-one update of the inverse mass, and its impulse.
    #[inline(always)]
    fn settle(&mut self, at: usize, step: Step) {
        let contact = self.layout.contact.as_ref().expect("asked over a bed only");
        let (kick, drift) = (Lanes::splat(step.kick), Lanes::splat(step.drift));
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        let touches = self.nodes.touches.load(at);
        let stiffness = contact.stiffness.load(at);
        let damping = contact.damping.load(at);
        let penetration = contact.level.load(at) - self.layout.position.load(at).z;
        let above = penetration - penetration.positive(); // the damper acts below the bed only
        let landing = damping * above * Lanes::splat(1.0 / step.drift);
        let resistance = kick * (stiffness * drift + damping);
        let response = self.nodes.response.load(at);
        let fall = self.nodes.fall.load(at);
        let share = (one + resistance * response.z).recip();
        let impulse = (kick * (stiffness * penetration + landing) - resistance * fall.z) * share;
        let held = touches.choose(resistance * share, zero);
        self.nodes.held.store(held, at);
        let loose = fall + response.scale(touches.choose(impulse, zero));
        self.nodes.loose.store(loose, at);
    }

    #[inline(always)]
    fn assemble_rows(&mut self, step: Step) {
        let kick = Lanes::splat(step.kick);
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        self.nodes.renew_ghosts();
        let (nodes, segments, rows) = (&self.nodes, &self.segments, &mut self.rows);
        for at in self.layout.rows() {
            let direction = segments.direction.load(at);
            let taut = segments.taut.load(at);
            let elastic = taut.choose(segments.stiffness.load(at), zero);
            let damping = segments.damping.load(at);
            let known = segments.known.load(at);
            let taut_known = known + segments.curvature.load(at);
            let (resistance, known) = if self.layout.negative_tension {
                (
                    elastic + damping,
                    taut.choose(taut_known, known - segments.elastic.load(at)),
                )
            } else {
                (
                    taut.choose(elastic + damping, zero),
                    taut.choose(taut_known, zero),
                )
            };
            let k = resistance * kick;
            let low = nodes.inverse_mass(at, direction);
            let high = nodes.inverse_mass(at + 1, direction);
            let relative = nodes.loose.load(at + 1) - nodes.loose.load(at);
            let [before, after] = [at - 1, at + 1].map(|at| segments.direction.load(at));
            rows.diagonal.store(one + k * direction.dot(low + high), at);
            rows.lower.store(zero - k * low.dot(before), at);
            rows.upper.store(zero - k * high.dot(after), at);
            rows.tension
                .store(known + resistance * direction.dot(relative), at);
        }
    }

    /// New velocities from T̄, into `velocity_before`; false if the bed pushes other nodes than assumed.
    #[inline(always)]
    fn find_velocities(&mut self, step: Step) -> bool {
        let kick = Lanes::splat(step.kick);
        let mut holds = true;
        for at in self.layout.rows() {
            let pull = |at: usize| {
                self.segments
                    .direction
                    .load(at)
                    .scale(self.rows.tension.load(at))
            };
            let moved = self
                .nodes
                .inverse_mass(at, pull(at) - pull(at - 1))
                .scale(kick);
            let velocity = self.nodes.loose.load(at) + moved;
            self.layout.velocity_before.store(velocity, at);
            if self.layout.contact.is_some() && self.rubbing.is_none() {
                let touches = self.touches(at, velocity.z, step);
                let assumed = self.nodes.touches.load(at);
                let changed = Lanes::splat(0.0) - touches * assumed;
                if changed.any_positive() {
                    self.nodes.touches.store(touches, at);
                    self.settle(at, step);
                    holds = false;
                }
            }
        }
        self.layout.velocity_before.wrap();
        holds
    }

    /// Updates slack flags and the true stretch; false if either asks for another pass.
    #[inline(always)]
    fn check_segments(&mut self, step: Step, greatest: f64) -> bool {
        let drift = Lanes::splat(step.drift);
        let one = Lanes::splat(1.0);
        let tolerance = Lanes::splat(STRETCH_TOLERANCE * greatest);
        let mut changed = false;
        for at in self.layout.rows() {
            let line = &self.layout;
            let segments = &mut self.segments;
            let relative = line.velocity_before.load(at + 1) - line.velocity_before.load(at);
            let direction = segments.direction.load(at);
            let along = direction.dot(relative);
            let stiffness = segments.stiffness.load(at);
            let curvature = segments.curvature.load(at);
            let stretching = stiffness * along + curvature;
            let total = if line.negative_tension {
                segments.elastic.load(at) + stretching
            } else {
                segments.known.load(at) + stretching + segments.damping.load(at) * along
            };
            let taut = total.choose(one, Lanes::splat(-1.0));
            let flips = Lanes::splat(0.0) - taut * segments.taut.load(at);
            // l1 − l0 less its part along the segment, exact: (2 l0 Δt a + Δt²|Δv|²)/(l0 + l1) − Δt a
            let l = segments.length.load(at);
            let square = drift * (l * along + l * along + drift * relative.dot(relative));
            let longer = (l * l + square).positive().sqrt();
            let transverse =
                square * (l + longer + Lanes::splat(f64::MIN_POSITIVE)).recip() - drift * along;
            let true_curvature = stiffness * transverse * Lanes::splat(1.0 / step.drift);
            let off = (true_curvature - curvature).abs() - tolerance;
            let again = flips.max(taut.choose(off, Lanes::splat(-1.0)));
            if again.any_positive() {
                segments.curvature.store(true_curvature, at);
                segments.taut.store(taut, at);
                changed = true;
            }
        }
        !changed
    }

    /// Books what was given and lost in the step; `velocity_before` holds the new velocities.
    #[inline(always)]
    fn book(&mut self, step: Step) {
        let kick = Lanes::splat(step.kick);
        let half = Lanes::splat(0.5);
        let line = &self.layout;
        for at in line.rows() {
            let direction = self.segments.direction.load(at);
            let relative =
                |velocity: &Field| direction.dot(velocity.load(at + 1) - velocity.load(at));
            let (old, new) = (relative(&line.velocity), relative(&line.velocity_before));
            let stiffness = self.segments.stiffness.load(at);
            let spring =
                self.segments.elastic.load(at) + self.segments.curvature.load(at) + stiffness * new;
            let tension = self.rows.tension.load(at);
            self.lost = self.lost + (tension - spring.positive()) * half * (old + new) * kick;
        }
        for at in line.rows() {
            let (old, new) = (line.velocity.load(at), line.velocity_before.load(at));
            // what is left of the node's momentum beside tension and weight is what water, damping and bed took
            let pull = |at: usize| {
                self.segments
                    .direction
                    .load(at)
                    .scale(self.rows.tension.load(at))
            };
            let mut impulse = (pull(at) - pull(at - 1)).scale(kick);
            impulse.z = impulse.z - line.weight.load(at) * kick;
            let tangent = self.nodes.tangent.load(at);
            let change = new - old;
            let mass_normal = self.nodes.mass_normal.load(at);
            let excess = self.nodes.mass_tangent.load(at) - mass_normal;
            let momentum = change.scale(mass_normal) + tangent.scale(excess * tangent.dot(change));
            let taken = (impulse - momentum).dot(old + new) * half;
            self.lost = self.lost + self.interior.load(at) * taken;
        }
        for end in self.held_ends() {
            let line = &self.layout;
            let node = line.end_slot(end);
            let (segment, sign) = line.end_segment(end);
            let pull = self.rows.tension[segment] * self.segments.direction.get(segment);
            let velocities = line.velocity.get(node) + line.velocity_before.get(node);
            self.given -= sign * 0.5 * step.kick * pull.dot(&velocities);
            self.given += 0.5 * step.kick * line.end_lack(end) * velocities.z;
        }
    }

    /// Books the work of the drag on the water's way and that of the water's press, which [`Self::book`] took off what was lost.
    #[inline(always)]
    fn book_current(&mut self, step: Step) {
        let current = self
            .current
            .as_ref()
            .expect("this kernel runs in moving water");
        let half = Lanes::splat(0.5);
        let line = &self.layout;
        let mut sum = Lanes::splat(0.0);
        for at in line.rows() {
            let flow = current.flow.load(at);
            let mean = (line.velocity.load(at) + line.velocity_before.load(at)).scale(half);
            let tangent = self.nodes.tangent.load(at);
            let (past, across) = (flow - mean, current.across.load(at));
            let excess = current.along.load(at) - across;
            let power = across * past.dot(flow) + excess * past.dot(tangent) * flow.dot(tangent);
            let pressing = current.press.load(at).dot(mean);
            sum = sum + self.interior.load(at) * (power + pressing);
        }
        let work = sum * Lanes::splat(step.kick);
        self.given += work.sum();
        self.lost = self.lost + work;
    }

    /// Greatest T̄ [N] since the state was loaded.
    pub fn tension_peak(&self) -> f64 {
        self.tension_peak
    }

    /// Index of the first node that has no finite position, or a speed that no mooring line reaches.
    pub fn broken_node(&self) -> Option<usize> {
        self.layout.broken_node()
    }
}

/// [`AxialWork::step`] for the vector unit of the machine.
struct AxialStep<'a>(&'a mut AxialWork, Step, [Vector3<f64>; 2]);

impl NullaryFnOnce for AxialStep<'_> {
    type Output = usize;

    #[inline(always)]
    fn call(self) -> usize {
        self.0.choose_step(self.1, self.2)
    }
}

impl NodeArrays {
    /// Makes the ghosts repeat what the inverse masses and velocities are now.
    #[inline(always)]
    fn renew_ghosts(&mut self) {
        self.across.wrap();
        self.excess.wrap();
        self.held.wrap();
        self.tangent.wrap();
        self.response.wrap();
        self.loose.wrap();
    }

    /// M⁻¹ x of the nodes from `at` on.
    #[inline(always)]
    fn inverse_mass(&self, at: usize, x: Vectors) -> Vectors {
        let (tangent, response) = (self.tangent.load(at), self.response.load(at));
        let excess = self.excess.load(at) * tangent.dot(x);
        let held = self.held.load(at) * response.dot(x);
        x.scale(self.across.load(at)) + tangent.scale(excess) - response.scale(held)
    }
}

impl Rows {
    /// Thomas's elimination; the matrix is diagonally dominant, so that no pivoting is needed. Returns the greatest T̄ [N].
    fn solve(&mut self, count: usize) -> f64 {
        let (diagonal, tension) = (&mut self.diagonal, &mut self.tension);
        let fold = tension.fold();
        // the diagonal is replaced by the pivots' inverses
        let mut last = fold.slot(0);
        diagonal[last] = 1.0 / diagonal[last];
        for at in fold.slots().take(count).skip(1) {
            let factor = self.lower[at] * diagonal[last];
            diagonal[at] = 1.0 / (diagonal[at] - factor * self.upper[last]);
            tension[at] -= factor * tension[last];
            last = at;
        }
        tension[last] *= diagonal[last];
        let mut greatest = tension[last];
        for i in (0..count - 1).rev() {
            let at = fold.slot(i);
            tension[at] = (tension[at] - self.upper[at] * tension[last]) * diagonal[at];
            greatest = greatest.max(tension[at]);
            last = at;
        }
        tension.wrap();
        greatest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_weights_sum_to_one_and_are_centred_at_the_present() {
        for rho in [0.5, 0.9, 1.0] {
            let Weights([new, now, last, before]) = Weights::new(rho);
            assert_relative_eq!(new + now + last + before, 1.0, max_relative = 1e-15);
            assert_relative_eq!(new - last - 2.0 * before, 0.0, epsilon = 1e-15);
        }
        assert_eq!(Weights::new(1.0), Weights([0.25, 0.5, 0.25, 0.0]));
    }
}
