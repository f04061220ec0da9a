//! Semi-explicit leapfrog of lumped two-node segments: the default for cables without bending.
//!
//! Positions live at t_n, velocities at t_{n−½}. A step is
//!
//! 1. segments: strain, lagged strain rate, tension T q;
//! 2. nodes: v_{n+½} = v_{n−½} + Δt M⁻¹ f, with drag at the extrapolated velocity 1.5 v_{n−½} − 0.5 v_{n−3/2}, the
//!    anisotropic mass inverted in closed form and the seabed solved implicitly, node by node, by a rank-one update;
//! 3. r_{n+1} = r_n + Δt v_{n+½}; held ends are put where their path says.
//!
//! One force evaluation a step, second order, stable below [`super::limit::explicit_step`] whatever the seabed.
//!
//! Source: Verlet's scheme as in Hairer, Lubich & Wanner (2003), Acta Numerica 12, 399-450; the inverse of
//! M_n I + (M_t − M_n) t tᵀ by Sherman & Morrison (1950); contact: backward Euler on the penetrating spring and damper.
//!
mod winch;

use nalgebra::{Matrix3, Vector3};
use pulp::NullaryFnOnce;

use super::layout::{Layout, Water, interior};
use super::ledger::Flow;
use crate::math::fold::{Column, Field};
use crate::math::lanes::{Lanes, Vectors};
use crate::model::{End, Line, LineState, Parting, WaveSpan};
use crate::physics::friction_step::Landing;
use crate::physics::morison::{self, DragCoefficients};
use crate::physics::stretch::{StretchLaw, total_tension};
use winch::WinchWork;

/// A line and the scratch of its steps.
#[derive(Debug, Clone)]
pub struct LineWork {
    layout: Layout,
    damped: bool,
    /// Force of a segment on its lower node, T q [N].
    pull: Field,
    inverse_mass: Column,
    water: Option<WaterWork>,
    /// 1 for nodes between the ends, 0 elsewhere.
    interior: Column,
    /// Whether ends A and B are held, were none parted.
    tied: [bool; 2],
    /// Whether they have parted from their points.
    parted: [bool; 2],
    /// Energy lost, and given by held ends and by moving water, since the state was loaded [J].
    lost: Lanes,
    given: f64,
    given_by_current: Lanes,
    /// Force of water and damping on the nodes at t_n [N], and the energy lost to the bed [J], over a bed that slopes or rubs.
    settling: Option<Settling>,
    /// The winch at end B, where the line is on one.
    winch: Option<Box<WinchWork>>,
}

/// What a bed that slopes or rubs is worked out with, node by node.
#[derive(Debug, Clone)]
struct Settling {
    resistance: Field,
    lost: f64,
}

/// Whether the kernel knows a bed.
mod bed {
    /// None.
    pub const NONE: u8 = 0;
    /// A level one without friction.
    pub const LEVEL: u8 = 1;
    /// One that slopes or rubs, whose nodes [`super::LineWork::settle`] looks after.
    pub const BOTTOM: u8 = 2;
}

/// What needs a node's tangent: drag, and a mass that differs along and across the line.
#[derive(Debug, Clone)]
struct WaterWork {
    drag_normal: Column,
    drag_tangent: Column,
    /// 1/M_t − 1/M_n [1/kg].
    inverse_mass_excess: Column,
}

impl WaterWork {
    fn new(line: &Line, layout: &Layout) -> Option<WaterWork> {
        let nodes = &line.nodes;
        let zeros = Column::new(layout.fold, 0.0);
        let excess: Vec<f64> = nodes
            .mass_tangent
            .iter()
            .zip(&nodes.mass_normal)
            .map(|(t, n)| 1.0 / t - 1.0 / n)
            .collect();
        let wet = layout.drag.is_some()
            || layout.waves.is_some()
            || excess.iter().any(|excess| *excess != 0.0);
        let drag = layout.drag.as_ref();
        wet.then(|| WaterWork {
            drag_normal: drag.map_or(zeros.clone(), |drag| drag.normal.clone()),
            drag_tangent: drag.map_or(zeros, |drag| drag.tangent.clone()),
            inverse_mass_excess: layout.fold.column(&excess, 0.0),
        })
    }

    /// What the water resists with at t_n, what it presses with, and the power of the drag on the water's way.
    #[inline(always)]
    fn drag_now<const CURRENT: bool>(
        &self,
        line: &Layout,
        at: usize,
        tangent: Vectors,
        step: Step,
    ) -> (Vectors, Vectors, Lanes) {
        let velocity = line.velocity_now(at, step);
        let still = Lanes::splat(0.0);
        if CURRENT {
            let flow = line.water_velocity(at);
            let drag = self.drag(at, velocity - flow, tangent);
            let press = match &line.waves {
                Some(waves) => waves.press(at, tangent),
                None => Vectors::zero(),
            };
            (drag, press, still - drag.dot(flow))
        } else {
            (self.drag(at, velocity, tangent), Vectors::zero(), still)
        }
    }

    /// M⁻¹f, and M⁻¹ẑ for the bed.
    #[inline(always)]
    fn inverted(
        &self,
        at: usize,
        inverse_mass: Lanes,
        force: Vectors,
        tangent: Vectors,
    ) -> (Vectors, Vectors) {
        let excess = self.inverse_mass_excess.load(at);
        let response = tangent.scale(excess * tangent.z);
        (
            force.scale(inverse_mass) + tangent.scale(excess * force.dot(tangent)),
            Vectors {
                z: response.z + inverse_mass,
                ..response
            },
        )
    }

    /// K_n |u_n| u_n + K_t |u_t| u_t.
    #[inline(always)]
    fn drag(&self, at: usize, velocity: Vectors, tangent: Vectors) -> Vectors {
        let along = velocity.dot(tangent);
        let across = velocity - tangent.scale(along);
        let normal = self.drag_normal.load(at) * across.dot(across).sqrt();
        let tangential = self.drag_tangent.load(at) * along.abs() * along;
        across.scale(normal) + tangent.scale(tangential)
    }
}

/// [`LineWork::pull_segments`] for the vector unit of the machine.
struct PullSegments<'a>(&'a mut LineWork, Step);

impl NullaryFnOnce for PullSegments<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.choose_segment_pass(self.1);
    }
}

/// [`LineWork::kick_nodes`] for the vector unit of the machine.
struct KickNodes<'a>(&'a mut LineWork, Step);

impl NullaryFnOnce for KickNodes<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.choose_node_pass(self.1);
    }
}

/// Sizes of a step.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Δt of the positions, t_n to t_{n+1} [s].
    pub drift: f64,
    /// Δt of the velocities, t_{n−½} to t_{n+½}: the mean of this step and the one before [s].
    pub kick: f64,
    /// Weight of v_{n−½} − v_{n−3/2} in the velocity extrapolated to t_n [-].
    pub extrapolation: f64,
}

impl Step {
    /// A step of `drift` [s] after steps of `last` and, before it, `earlier` [s]; 0 where there was none.
    pub fn after([last, earlier]: [f64; 2], drift: f64) -> Step {
        let extrapolation = if last > 0.0 && earlier > 0.0 {
            last / (last + earlier)
        } else {
            0.0
        };
        Step {
            drift,
            kick: 0.5 * (last + drift),
            extrapolation,
        }
    }
}

/// What an end of a line brings to the free point it is tied to.
#[derive(Debug, Clone, Copy)]
pub struct EndLoad {
    /// Force of the line on the point without contact [N].
    pub force: Vector3<f64>,
    /// The part of it that water and damping resist with [N].
    pub resistance: Vector3<f64>,
    /// The part of it that accelerated water presses with [N].
    pub press: Vector3<f64>,
    /// Power of the drag on the water's way [W].
    pub current_power: f64,
    /// Mass matrix of the half node [kg].
    pub mass: Matrix3<f64>,
    /// Contact stiffness [N/m] and damping [N s/m] of the half node, and its force at z = 0, or at no height over a bed that slopes or rubs [N].
    pub contact: [f64; 3],
}

impl LineWork {
    /// Scratch for a line; `None` where its sections have different strain measures, which the kernel does not mix.
    pub fn new(
        line: &Line,
        water: Water<'_>,
        held: [bool; 2],
        negative_tension: bool,
    ) -> Option<LineWork> {
        let winch = WinchWork::new(line);
        let line = line.winch.as_ref().map_or(line, |winch| winch.reel());
        let layout = Layout::new(line, water, negative_tension)?;
        let inverse_mass: Vec<f64> = line
            .nodes
            .mass_normal
            .iter()
            .map(|mass| 1.0 / mass)
            .collect();
        Some(LineWork {
            damped: line
                .segments
                .axial_damping
                .iter()
                .any(|damping| *damping != 0.0),
            pull: Field::zeros(layout.fold),
            inverse_mass: layout.fold.column(&inverse_mass, 0.0),
            water: WaterWork::new(line, &layout),
            interior: interior(layout.segment_count),
            tied: held,
            parted: [false; 2],
            lost: Lanes::splat(0.0),
            given: 0.0,
            given_by_current: Lanes::splat(0.0),
            settling: layout.bottom().map(|_| Settling {
                resistance: Field::zeros(layout.fold),
                lost: 0.0,
            }),
            layout,
            winch,
        })
    }

    /// Takes over the state of a line.
    pub fn load(&mut self, state: &LineState) {
        self.load_reel(state);
        self.layout.load(state);
        self.parted = state.parted;
        for end in [End::A, End::B] {
            let at = self.layout.end_slot(end);
            self.interior[at] = f64::from(u8::from(self.is_parted(end)));
        }
        self.renew_ghosts();
        self.clear_flow();
    }

    /// Goes on from the state that [`Self::store`] handed back last; a line on a winch is laid out anew.
    pub fn resume(&mut self, state: &LineState) {
        match self.winch {
            None => self.clear_flow(),
            Some(_) => self.load(state),
        }
    }

    fn clear_flow(&mut self) {
        (self.lost, self.given) = (Lanes::splat(0.0), 0.0);
        self.given_by_current = Lanes::splat(0.0);
        if let Some(settling) = &mut self.settling {
            settling.lost = 0.0;
        }
    }

    /// Meets the water's surface as it is at t_n. Where that is `after` a step, what joined with the water in it is booked.
    pub fn meet_surface(&mut self, after: Option<Step>) {
        if let Some(step) = after {
            self.layout.leave_surface(step, self.held());
        }
        self.layout.find_surface();
        let Some(surface) = &self.layout.surface else {
            return;
        };
        for i in surface.crossed() {
            let (at, now) = (self.layout.slot(i), surface.node(i));
            let [across, along] = now.masses.map(|mass| 1.0 / mass);
            self.inverse_mass[at] = across;
            if let Some(water) = &mut self.water {
                [water.drag_normal[at], water.drag_tangent[at]] = now.drag;
                water.inverse_mass_excess[at] = along - across;
            }
        }
        match after {
            Some(_) => self.layout.book_surface(self.held()),
            None => self.layout.clear_surface(),
        }
    }

    /// Energy given by held ends and the current and lost between them since [`Self::load`].
    pub fn flow(&self) -> Flow {
        Flow {
            given: self.given
                + self.given_by_current.sum()
                + self.layout.lifted()
                + self.winch.as_ref().map_or(0.0, |winch| winch.given()),
            lost: self.lost.sum() + self.settling.as_ref().map_or(0.0, |bed| bed.lost)
                - self.layout.joined(),
        }
    }

    /// Takes over what waves do at the nodes of this line, by its number, over a span of time.
    pub fn load_waves(&mut self, span: Option<&WaveSpan>, line: usize) {
        self.layout.load_waves(span, line);
    }

    /// Sets what multiplies the current at t_n [-].
    pub fn set_current(&mut self, factor: f64) {
        self.layout.set_current(factor);
    }

    /// Sets the waves to those of t_n [s].
    pub fn set_time(&mut self, t: f64) {
        self.layout.set_time(t);
    }

    /// Hands the state back after steps of `steps` [s].
    pub fn store(&self, state: &mut LineState, steps: [f64; 2]) {
        state.parted = self.parted;
        self.store_reel(state);
        self.layout.store(state, steps);
    }

    /// Whether ends A and B are held.
    fn held(&self) -> [bool; 2] {
        [0, 1].map(|side| self.tied[side] && !self.parted[side])
    }

    /// Whether an end has parted from its point.
    pub fn is_parted(&self, end: End) -> bool {
        self.parted[end as usize]
    }

    /// Parts the ends from their points that the tensions of t_n, `t` [s], are too much for, or the time has come for.
    pub fn part_ends(&mut self, partings: &[Parting; 2], t: f64, step: Step) {
        for end in [End::A, End::B] {
            let side = end as usize;
            let layout = &self.layout;
            if self.parted[side] || !partings[side].parts(layout.end_tension(end, step), t) {
                continue;
            }
            let at = layout.end_slot(end);
            if self.tied[side] {
                let excess = self
                    .water
                    .as_ref()
                    .map_or(0.0, |w| w.inverse_mass_excess[at]);
                let across = self.inverse_mass[at];
                let masses = [1.0 / across, 1.0 / (across + excess)];
                self.given += layout.joining_energy(end, masses, step);
            }
            self.parted[side] = true;
            self.interior[at] = 1.0;
        }
    }

    /// Step 1: tensions from positions at t_n and velocities at t_{n−½}.
    pub fn pull_segments(&mut self, step: Step) {
        self.layout.vector_unit.dispatch(PullSegments(self, step));
    }

    #[inline(always)]
    fn choose_segment_pass(&mut self, step: Step) {
        match (&self.layout.law, self.damped) {
            _ if self.layout.creep.is_some() => self.creeping_segment_pass(step),
            (StretchLaw::Engineering, false) => self.segment_pass::<false>(step, |strain| strain),
            (StretchLaw::Engineering, true) => self.segment_pass::<true>(step, |strain| strain),
            (law, _) => {
                let law = law.clone();
                self.segment_pass::<true>(step, |strain| strain.map(|e| law.at(e).force));
            }
        }
    }

    #[inline(always)]
    fn segment_pass<const DAMPED: bool>(&mut self, step: Step, law: impl Fn(Lanes) -> Lanes) {
        let line = &self.layout;
        let kick = Lanes::splat(step.kick);
        let one = Lanes::splat(1.0);
        for at in line.rows() {
            let (chord, inverse_l) = line.chord(at);
            let inverse_length = line.inverse_length.load(at);
            let strain = chord.dot(chord) * inverse_l * inverse_length - one;
            let elastic = line.axial_stiffness.load(at) * law(strain);
            let mut tension = elastic.positive();
            if DAMPED {
                let rate = line.velocity.load(at + 1) - line.velocity.load(at);
                let stretching = chord.dot(rate) * inverse_l;
                let damping = line.axial_damping.load(at) * stretching * inverse_length;
                let total = if line.negative_tension {
                    tension + damping
                } else {
                    (elastic + damping).positive()
                };
                self.lost = self.lost + (total - tension) * stretching * kick;
                tension = total;
            }
            self.pull.store(chord.scale(tension * inverse_l), at);
        }
        self.pull.wrap();
    }

    /// [`LineWork::segment_pass`] of a line with viscoelastic segments.
    #[inline(always)]
    fn creeping_segment_pass(&mut self, step: Step) {
        let mut creep = self.layout.creep.take().expect("this line creeps");
        let line = &self.layout;
        for at in line.rows() {
            let (chord, inverse_l) = line.chord(at);
            let direction = chord.scale(inverse_l);
            let inverse_length = line.inverse_length.load(at);
            let strain = line.strain(at);
            creep.strain.store(strain, at);
            let relative = line.velocity.load(at + 1) - line.velocity.load(at);
            let rate = direction.dot(relative) * inverse_length;
            let elastic = creep.elastic(at, strain);
            let damping = line.axial_damping.load(at) * rate;
            let tension = if line.negative_tension {
                elastic.positive() + damping
            } else {
                (elastic + damping).positive()
            };
            let now = line.strain_rate(at, direction, step);
            let loss = creep.loss(at, strain, now, tension);
            self.lost = self.lost + loss * Lanes::splat(step.kick) * inverse_length.recip();
            self.pull.store(direction.scale(tension), at);
        }
        self.pull.wrap();
        self.layout.creep = Some(creep);
    }

    /// After the ends were put where they are at t_{n+1}: takes the memory of viscoelastic segments there.
    pub fn creep(&mut self, step: Step) {
        self.layout.creep(step.drift);
    }

    /// Step 2: velocities from t_{n−½} to t_{n+½}.
    pub fn kick_nodes(&mut self, step: Step) {
        self.layout.vector_unit.dispatch(KickNodes(self, step));
        if self.settling.is_some() {
            self.settle(step);
        }
    }

    #[inline(always)]
    fn choose_node_pass(&mut self, step: Step) {
        match (&self.water, self.layout.flows()) {
            (None, _) => self.choose_dry_pass::<false, false>(step),
            (Some(_), false) => self.choose_dry_pass::<true, false>(step),
            (Some(_), true) => self.choose_dry_pass::<true, true>(step),
        }
    }

    /// What is chosen beside the water.
    #[inline(always)]
    fn choose_dry_pass<const WATER: bool, const CURRENT: bool>(&mut self, step: Step) {
        match (&self.layout.contact, self.settling.is_some()) {
            (None, _) => self.choose_damped_pass::<WATER, CURRENT, { bed::NONE }>(step),
            (Some(_), false) => self.choose_damped_pass::<WATER, CURRENT, { bed::LEVEL }>(step),
            (Some(_), true) => self.choose_damped_pass::<WATER, CURRENT, { bed::BOTTOM }>(step),
        }
    }

    #[inline(always)]
    fn choose_damped_pass<const WATER: bool, const CURRENT: bool, const BED: u8>(
        &mut self,
        step: Step,
    ) {
        match self.layout.mass_damping {
            None => self.node_pass::<WATER, CURRENT, BED, false>(step),
            Some(_) => self.node_pass::<WATER, CURRENT, BED, true>(step),
        }
    }

    #[inline(always)]
    fn node_pass<
        const WATER: bool,
        const CURRENT: bool,
        const BED: u8,
        const MASS_DAMPING: bool,
    >(
        &mut self,
        step: Step,
    ) {
        let line = &mut self.layout;
        let kick = Lanes::splat(step.kick);
        for at in line.rows() {
            let velocity = line.velocity.load(at);
            let inverse_mass = self.inverse_mass.load(at);
            let mut force = self.pull.load(at) - self.pull.load(at - 1);
            force.z = force.z - line.weight.load(at);
            let zero = Lanes::splat(0.0);
            let mut resistance = Vectors::zero();
            if MASS_DAMPING {
                let damping = line.mass_damping.as_ref().expect("this kernel damps");
                resistance = velocity.scale(damping.load(at));
            }
            let (mut press, mut power) = (Vectors::zero(), zero);
            // M⁻¹f, and M⁻¹ẑ for the bed
            let (inverted, response) = if WATER {
                let water = self.water.as_ref().expect("this kernel runs in water");
                let tangent = line.tangent(at);
                let drag;
                (drag, press, power) = water.drag_now::<CURRENT>(line, at, tangent, step);
                resistance = resistance + drag;
                force = force - resistance;
                force = if CURRENT { force + press } else { force };
                water.inverted(at, inverse_mass, force, tangent)
            } else {
                force = force - resistance;
                let mut response = Vectors::zero();
                response.z = inverse_mass;
                (force.scale(inverse_mass), response)
            };
            let mut kicked = velocity + inverted.scale(kick);
            let mut given_away = zero; // twice the energy that leaves the nodes
            if BED == bed::LEVEL {
                let impulse = contact_impulse(line, at, kicked.z, response.z, step);
                kicked = kicked + response.scale(impulse);
                given_away = given_away - impulse * (velocity.z + kicked.z);
            }
            if WATER || MASS_DAMPING {
                given_away = given_away + resistance.dot(velocity + kicked) * kick;
            }
            if WATER || MASS_DAMPING || BED == bed::LEVEL {
                let half = Lanes::splat(0.5) * self.interior.load(at);
                self.lost = self.lost + half * given_away;
            }
            if CURRENT {
                let part = self.interior.load(at);
                let by_press = part * press.dot(velocity + kicked) * kick * Lanes::splat(0.5);
                let given = part * power * kick;
                self.given_by_current = self.given_by_current + given + by_press;
                self.lost = self.lost + given;
            }
            if let (bed::BOTTOM, Some(settling)) = (BED, &mut self.settling) {
                settling.resistance.store(resistance, at);
            }
            line.velocity_before.store(kicked, at); // v_{n−3/2} has been read
        }
        std::mem::swap(&mut line.velocity, &mut line.velocity_before);
    }

    /// What a bed that slopes or rubs makes of the velocities at t_{n+½}.
    fn settle(&mut self, step: Step) {
        let line = &mut self.layout;
        let Some(settling) = &mut self.settling else {
            return;
        };
        for (i, at) in line.nodes().enumerate() {
            if self.interior[at] == 0.0 {
                continue; // tied to its point
            }
            let (penetration, normal) = line.stand(at);
            let free = line.velocity.get(at);
            if penetration <= step.drift * normal.dot(&free) {
                line.set_rub(at, Vector3::zeros());
                continue;
            }
            let excess = self
                .water
                .as_ref()
                .map_or(0.0, |w| w.inverse_mass_excess[at]);
            let inverse_mass = self.inverse_mass[at];
            let tangent = line.tangent_of(i);
            let Some((contact, friction)) = line.rubbing() else {
                return;
            };
            let node = Landing {
                mass: [1.0 / inverse_mass, 1.0 / (inverse_mass + excess)],
                tangent,
                normal,
                penetration,
                coefficients: contact.coefficients(at),
                steps: [step.kick, step.drift],
            };
            let Some(landed) = node.solve(free, friction) else {
                line.set_rub(at, Vector3::zeros());
                continue;
            };
            let passed = line.velocity_before.get(at) + landed.velocity;
            let resisted = settling.resistance.get(at).dot(&(landed.velocity - free));
            settling.lost += 0.5 * (step.kick * resisted - landed.impulse.dot(&passed));
            line.velocity.set(at, landed.velocity);
            line.set_rub(at, landed.rub / step.kick);
        }
    }

    /// Step 3: positions from t_n to t_{n+1}.
    pub fn drift_nodes(&mut self, step: Step) {
        self.layout.drift(step.drift);
    }

    /// Books the work of the ends in a step, after [`Self::put_end`] has told how they move on; ends at free points do no
    /// work that the line loses.
    pub fn book_ends(&mut self, step: Step) {
        let held = self.held();
        for end in [End::A, End::B]
            .into_iter()
            .filter(|&end| held[end as usize])
        {
            let at = self.layout.end_slot(end);
            let (segment, sign) = self.layout.end_segment(end);
            let pull = sign * self.pull.get(segment);
            let velocities = self.layout.velocity_before.get(at) + self.layout.velocity.get(at);
            self.given -= 0.5 * step.kick * pull.dot(&velocities);
            self.given += 0.5 * step.kick * self.layout.end_lack(end) * velocities.z;
        }
    }

    /// Puts an end at a position [m] with the velocity [m/s] that the next step takes as lagged, unless it has parted from its point.
    pub fn put_end(&mut self, end: End, position: Vector3<f64>, velocity: Vector3<f64>) {
        if !self.is_parted(end) {
            self.layout.put_end(end, position, velocity);
        }
    }

    /// What the end brings to a free point, after [`Self::pull_segments`]; `velocity` [m/s] is the point's at t_n.
    pub fn end_load(&self, end: End, velocity: Vector3<f64>) -> EndLoad {
        let line = &self.layout;
        let (at, other) = (line.end_slot(end), line.end_neighbour(end));
        let (segment, sign) = line.end_segment(end);
        let chord = line.position.get(other) - line.position.get(at);
        let tangent = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let (mut resistance, mut current_power) = (Vector3::zeros(), 0.0);
        let force = sign * self.pull.get(segment) - line.weight[at] * Vector3::z();
        let mut excess = 0.0;
        if let Some(water) = &self.water {
            let coefficients = DragCoefficients {
                normal: water.drag_normal[at],
                tangent: water.drag_tangent[at],
            };
            let flow = line.water_velocity_of(at);
            resistance += morison::drag(coefficients, velocity - flow, tangent);
            current_power = resistance.dot(&flow);
            excess = water.inverse_mass_excess[at];
        }
        if let Some(damping) = &line.mass_damping {
            resistance -= damping[at] * velocity;
        }
        let press = line.waves.as_ref();
        let press = press.map_or(Vector3::zeros(), |waves| waves.press_of(at, tangent));
        let mass_normal = 1.0 / self.inverse_mass[at];
        let mass_tangent = 1.0 / (self.inverse_mass[at] + excess);
        let mass = mass_normal * Matrix3::identity()
            + (mass_tangent - mass_normal) * tangent * tangent.transpose();
        let contact = line.contact.as_ref().map_or([0.0; 3], |c| {
            [
                c.stiffness[at],
                c.damping[at],
                c.stiffness[at] * c.level[at],
            ]
        });
        EndLoad {
            force: force + resistance + press,
            resistance,
            press,
            current_power,
            mass,
            contact,
        }
    }

    /// After the ends were put in their places: makes the ghosts of the layout repeat the nodes.
    pub fn renew_ghosts(&mut self) {
        self.layout.renew_ghosts(self.parted);
    }

    /// Greatest ratio K |v| / M of the nodes [1/s]: explicit drag wants Δt below its inverse.
    pub fn drag_rate(&self, line: &Line) -> f64 {
        self.layout.drag_rate(line)
    }

    /// Index of the first node that has no finite position, or a speed that no mooring line reaches.
    pub fn broken_node(&self) -> Option<usize> {
        self.layout.broken_node()
    }
}

/// Impulse Δt·F of the bed: F = k(p − Δt u') − c u' ≥ 0 with u' = u + Δt μ F, only if p − Δt u > 0.
#[inline(always)]
fn contact_impulse(
    line: &Layout,
    at: usize,
    velocity_z: Lanes,
    response_z: Lanes,
    step: Step,
) -> Lanes {
    let contact = line.contact.as_ref().expect("this kernel runs over a bed");
    let (drift, kick) = (Lanes::splat(step.drift), Lanes::splat(step.kick));
    let stiffness = contact.stiffness.load(at);
    let resistance = stiffness * drift + contact.damping.load(at); // b = kΔt + c
    let penetration = contact.level.load(at) - line.position.load(at).z;
    let push = stiffness * penetration - resistance * velocity_z;
    let yielding = Lanes::splat(1.0) + response_z * kick * resistance;
    let lands = penetration - drift * velocity_z;
    (kick * push.positive() * yielding.recip()).where_positive(lands)
}

/// Tension [N] of one segment from its end positions [m] and velocities [m/s]: the pointwise law of the kernel.
pub fn segment_tension(
    line: &Line,
    segment: usize,
    [low, high]: [Vector3<f64>; 2],
    [low_velocity, high_velocity]: [Vector3<f64>; 2],
    negative_tension: bool,
) -> f64 {
    let segments = &line.segments;
    let (chord, length) = (high - low, segments.length[segment]);
    let l = chord.norm();
    let elastic =
        segments.axial_stiffness[segment] * segments.law[segment].at(l / length - 1.0).force;
    let rate = if l > 0.0 {
        chord.dot(&(high_velocity - low_velocity)) / (l * length)
    } else {
        0.0
    };
    total_tension(
        elastic,
        segments.axial_damping[segment] * rate,
        0.0 - line.compression_max(segment),
        negative_tension,
    )
}
