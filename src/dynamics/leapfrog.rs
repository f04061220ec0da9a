//! Semi-explicit leapfrog of lumped two-node segments: the default for cables without bending.
//!
//! Positions live at t_n, velocities at t_{n−½}. A step is a sweep over the line, in which
//!
//! 1. segments: strain, lagged strain rate, tension T q;
//! 2. nodes: v_{n+½} = v_{n−½} + Δt M⁻¹ f, with drag at the extrapolated velocity 1.5 v_{n−½} − 0.5 v_{n−3/2}, the
//!    anisotropic mass inverted in closed form and the seabed solved implicitly, node by node, by a rank-one update;
//! 3. r_{n+1} = r_n + Δt v_{n+½}; the ends are put where their points are.
//!
//! Before the sweep free points take the pull of the segments at them, and after it beds that slope or rub look after the nodes one by one.
//!
//! One force evaluation a step, second order, stable below [`super::limit::explicit_limit`] whatever the seabed.
//!
//! Source: Verlet's scheme as in Hairer, Lubich & Wanner (2003), Acta Numerica 12, 399-450; the inverse of
//! M_n I + (M_t − M_n) t tᵀ by Sherman & Morrison (1950); contact: backward Euler on the penetrating spring and damper.

mod sweep;
mod winch;

use nalgebra::{Matrix3, Vector3};
use pulp::NullaryFnOnce;

use super::layout::{Layout, Water, interior, inverse_norm_of};
use super::ledger::Flow;
use super::limit::expected_slope;
use super::step::Step;
use crate::math::fold::{Column, Field, Slot};
use crate::math::lanes::{LANES, Lanes};
use crate::model::{End, Line, LineState, Parting, WaveSpan};
use crate::physics::friction_step::Landing;
use crate::physics::morison::{self, DragCoefficients};
use crate::physics::slender::Slender;
use crate::physics::stretch::{StretchLaw, total_tension};
use crate::scene::Solver;
pub use sweep::Placed;
use sweep::{Drift, Sweep};
use winch::WinchWork;

/// Rows of nodes that vectors of eight numbers do not pay for [-].
const FEW_ROWS: usize = 5;

/// A line and the scratch of its steps.
#[derive(Debug, Clone)]
pub struct LineWork {
    layout: Layout,
    /// Whether the sweep can do all by itself: the strain is the engineering one, and there is neither creep, nor damping by mass, nor a bed
    /// that slopes or rubs.
    plain: bool,
    /// Force of a segment on its lower node, T q [N].
    pull: Field,
    /// The part of it that springs have; all of it where segments creep [N].
    spring: Field,
    /// Force that water and damping resist with at t_n [N]; where the bed slopes or rubs with the dampers beside the nodes.
    resistance: Field,
    /// Force of water that waves accelerate at t_n [N], where there are waves.
    press: Option<Field>,
    /// Inverse square of the chord between the nodes beside a node at t_n [1/m²].
    inverse_square: Column,
    inverse_mass: Column,
    /// M_n [kg].
    mass: Column,
    water: Option<WaterWork>,
    /// 1 for nodes between the ends, 0 elsewhere.
    interior: Column,
    /// Whether ends A and B are held, were none parted.
    tied: [bool; 2],
    /// Whether they have parted from their points.
    parted: [bool; 2],
    /// Where they were half a step before t_n [m].
    half_places: [Vector3<f64>; 2],
    /// Energy lost, and given by held ends and by moving water, since the state was loaded [J].
    lost: Lanes,
    given: f64,
    given_by_current: Lanes,
    /// What ½ vᵀMv had along the tangents beside what it had across them when the books were opened [J].
    turning: f64,
    /// Energy lost to the bed [J], where it slopes or rubs.
    settled: Option<f64>,
    /// The winch at end B, where the line is on one.
    winch: Option<Box<WinchWork>>,
}

/// What needs a node's tangent: drag, and a mass that differs along and across the line.
#[derive(Debug, Clone)]
struct WaterWork {
    drag_normal: Column,
    drag_tangent: Column,
    /// 1/M_t − 1/M_n [1/kg].
    inverse_mass_excess: Column,
    /// M_t − M_n [kg]; of ends as [`LineWork::set_mass_excess`] says.
    mass_excess: Column,
    /// Drag coefficient over mass of a node that is wholly in the water, across the line [1/m].
    drag_over_mass: Column,
    /// The same along the line, where it is greater at some node [1/m].
    drag_over_mass_along: Option<Column>,
}

impl WaterWork {
    fn new(line: &Line, layout: &Layout) -> Option<WaterWork> {
        let nodes = &line.nodes;
        let zeros = Column::new(layout.fold, 0.0);
        let masses = || nodes.mass_tangent.iter().zip(&nodes.mass_normal);
        let excess: Vec<f64> = masses().map(|(t, n)| 1.0 / t - 1.0 / n).collect();
        let mass_excess: Vec<f64> = masses().map(|(t, n)| t - n).collect();
        let wet =
            layout.drag.is_some() || layout.waves.is_some() || excess.iter().any(|excess| *excess != 0.0);
        let drag = layout.drag.as_ref();
        let over_mass = |drag: Option<&[f64]>, mass: &[f64]| -> Vec<f64> {
            let pairs = drag.unwrap_or_default().iter().zip(mass);
            pairs.map(|(drag, mass)| drag / mass).collect()
        };
        let given = nodes.drag.as_ref();
        let across = over_mass(given.map(|drag| &drag.normal[..]), &nodes.mass_normal);
        let along = over_mass(given.map(|drag| &drag.tangent[..]), &nodes.mass_tangent);
        let counts = along.iter().zip(&across).any(|(along, across)| along > across);
        wet.then(|| WaterWork {
            drag_over_mass: layout.fold.column(&across, 0.0),
            drag_over_mass_along: counts.then(|| layout.fold.column(&along, 0.0)),
            drag_normal: drag.map_or(zeros.clone(), |drag| drag.normal.clone()),
            drag_tangent: drag.map_or(zeros, |drag| drag.tangent.clone()),
            inverse_mass_excess: layout.fold.column(&excess, 0.0),
            mass_excess: layout.fold.column(&mass_excess, 0.0),
        })
    }
}

/// What a look over the nodes tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Survey {
    /// Greatest ratio K |v| / M [1/s], v relative to the water, or of its part along the line: explicit drag wants Δt below its inverse.
    pub drag_rate: f64,
    /// Whether all positions are finite, and all speeds such as mooring lines reach.
    pub is_sound: bool,
}

/// [`LineWork::survey`] for the vector unit of the machine.
struct SurveyRows<'a>(&'a LineWork);

impl NullaryFnOnce for SurveyRows<'_> {
    type Output = Survey;

    #[inline(always)]
    fn call(self) -> Survey {
        self.0.survey_rows()
    }
}

/// [`LineWork::pull_beforehand`] for the vector unit of the machine.
struct PullSegments<'a>(&'a mut LineWork);

impl NullaryFnOnce for PullSegments<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.choose_segment_pass();
    }
}

/// [`LineWork::turning_energy`] for the vector unit of the machine.
struct Turning<'a>(&'a mut LineWork);

impl NullaryFnOnce for Turning<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let LineWork { layout, water, .. } = self.0;
        layout.renew_neighbours([true; 2]); // ends of excess mass have no neighbour beyond them
        let mut sum = Lanes::splat(0.0);
        if let Some(water) = water {
            for at in layout.rows() {
                sum = sum + water.mass_excess.load(at) * layout.along_squared(at);
            }
        }
        0.5 * sum.sum()
    }
}

/// [`LineWork::put_ends`] for the vector unit of the machine.
struct PutEnds<'a>(&'a mut LineWork, [&'a Placed; 2]);

impl NullaryFnOnce for PutEnds<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let PutEnds(work, ends) = self;
        work.layout.place_ends(ends, work.parted);
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
    /// Its mass across the line [kg].
    pub across: f64,
    /// Contact stiffness [N/m] and damping [N s/m] of the half node, and its force at z = 0, or at no height over a bed that slopes or rubs [N].
    pub contact: [f64; 3],
}

impl LineWork {
    /// Scratch for a line; `None` where its sections have different strain measures, which the kernel does not mix.
    pub fn new(line: &Line, water: Water<'_>, held: [bool; 2], solver: &Solver) -> Option<LineWork> {
        let winch = WinchWork::new(line);
        let is_held = held[1] && winch.is_none();
        let line = line.winch.as_ref().map_or(line, |winch| winch.reel());
        let layout = Layout::new(line, water, solver, FEW_ROWS, is_held)?;
        let inverse_mass: Vec<f64> = line.nodes.mass_normal.iter().map(|mass| 1.0 / mass).collect();
        Some(LineWork {
            plain: layout.law == StretchLaw::Engineering
                && layout.creep.is_none()
                && layout.mass_damping.is_none()
                && layout.bottom().is_none(),
            pull: Field::zeros(layout.fold),
            resistance: Field::zeros(layout.fold),
            press: layout.waves.as_ref().map(|_| Field::zeros(layout.fold)),
            inverse_square: Column::new(layout.fold, 0.0),
            inverse_mass: layout.fold.column(&inverse_mass, 0.0),
            mass: layout.fold.column(&line.nodes.mass_normal, 0.0),
            water: WaterWork::new(line, &layout),
            spring: Field::zeros(layout.fold),
            turning: 0.0,
            interior: interior(layout.fold, layout.segment_count),
            tied: held,
            parted: [false; 2],
            half_places: [Vector3::zeros(); 2],
            lost: Lanes::splat(0.0),
            given: 0.0,
            given_by_current: Lanes::splat(0.0),
            settled: layout.bottom().map(|_| 0.0),
            layout,
            winch,
        })
    }

    /// As [`super::network::NetworkWork::set_portable`].
    pub fn set_portable(&mut self, portable: bool) {
        self.layout.set_portable(portable);
    }

    /// Takes over the state of a line.
    pub fn load(&mut self, state: &LineState) {
        self.load_reel(state);
        self.layout.load(state);
        self.parted = state.parted;
        for end in [End::A, End::B] {
            let at = self.layout.end_slot(end);
            self.interior[at] = f64::from(u8::from(self.is_parted(end)));
            self.set_mass_excess(end);
        }
        self.set_out(0.5 * state.half_step.steps[0]);
        self.layout.still();
        self.clear_flow();
    }

    /// Goes on from the state that [`Self::store`] handed back last; a line on a winch is laid out anew.
    pub fn resume(&mut self, state: &LineState) {
        match self.winch {
            None => {
                self.layout.still();
                self.clear_flow();
            }
            Some(_) => self.load(state),
        }
    }

    /// Sets by how much an end is heavier along the line than across it: not at all where it is held.
    fn set_mass_excess(&mut self, end: End) {
        let (at, held) = (self.layout.end_slot(end), self.held()[end as usize]);
        let across = self.inverse_mass[at];
        if let Some(water) = &mut self.water {
            let along = across + water.inverse_mass_excess[at];
            let excess = 1.0 / along - 1.0 / across;
            water.mass_excess[at] = if held { 0.0 } else { excess };
        }
    }

    fn clear_flow(&mut self) {
        (self.lost, self.given) = (Lanes::splat(0.0), 0.0);
        self.given_by_current = Lanes::splat(0.0);
        if let Some(lost) = &mut self.settled {
            *lost = 0.0;
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
            (self.inverse_mass[at], self.mass[at]) = (across, now.masses[0]);
            if let Some(water) = &mut self.water {
                [water.drag_normal[at], water.drag_tangent[at]] = now.drag;
                water.inverse_mass_excess[at] = along - across;
                water.mass_excess[at] = now.masses[1] - now.masses[0];
            }
        }
        for end in [End::A, End::B] {
            self.set_mass_excess(end);
        }
        match after {
            Some(_) => self.layout.book_surface(self.held()),
            None => self.layout.clear_surface(),
        }
    }

    /// Starts the books of the steps to come, the ends and the surface being where they are.
    pub fn open_books(&mut self) {
        if self.layout.books {
            self.turning = self.turning_energy();
        }
    }

    /// Σ ½ (M_t − M_n)(v·t)² of all nodes but held ends, the velocities being those of t_{n−½} [J].
    fn turning_energy(&mut self) -> f64 {
        if self.water.is_none() {
            return 0.0;
        }
        let unit = self.layout.vector_unit;
        unit.dispatch(Turning(self))
    }

    /// Energy given by held ends and the current and lost between them since [`Self::open_books`]; none where it is not booked.
    pub fn flow(&mut self) -> Flow {
        if !self.layout.books {
            return Flow::default();
        }
        let turned = self.turning_energy() - self.turning;
        Flow {
            numerical: 0.0,
            given: self.given
                + self.given_by_current.sum()
                + self.layout.lifted()
                + self.winch.as_ref().map_or(0.0, |winch| winch.given()),
            lost: self.lost.sum() + self.settled.unwrap_or(0.0) - self.layout.joined() - turned,
        }
    }

    /// Takes over what waves do at the nodes of this line, by its number, over a span of time.
    pub fn load_waves(&mut self, span: &WaveSpan) {
        self.layout.load_waves(span);
    }

    /// Whether it holds another span of time than this.
    pub fn lacks_waves(&self, span: &WaveSpan) -> bool {
        self.layout.lacks_waves(span)
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
                let excess = self.water.as_ref().map_or(0.0, |w| w.inverse_mass_excess[at]);
                let across = self.inverse_mass[at];
                let masses = [1.0 / across, 1.0 / (across + excess)];
                self.given += layout.joining_energy(end, masses, step);
            }
            self.parted[side] = true;
            self.interior[at] = 1.0;
            self.set_mass_excess(end);
            if let (Some(water), true) = (&self.water, self.tied[side]) {
                let along = self
                    .layout
                    .velocity
                    .get(at)
                    .dot(&self.layout.tangent_of(self.layout.end_node(end)));
                self.turning += 0.5 * water.mass_excess[at] * along * along;
            }
        }
    }

    /// Tensions from positions at t_n and velocities at t_{n−½}, where they must be known before the sweep: of lines that are not
    /// plain, and of segments at free points.
    #[inline]
    pub fn pull_beforehand(&mut self) {
        let sweep_does = self.plain && self.tied == [true; 2];
        if !sweep_does {
            self.pull_first();
        }
    }

    fn pull_first(&mut self) {
        if !self.plain {
            self.layout.renew_ghosts(self.parted);
            self.layout.vector_unit.dispatch(PullSegments(self));
            return;
        }
        for end in [End::A, End::B] {
            if !self.tied[end as usize] && !self.is_parted(end) {
                self.pull_end(end);
            }
        }
    }

    /// The pull of the segment at an end, as the sweep will find it.
    fn pull_end(&mut self, end: End) {
        let line = &self.layout;
        let ((at, sign), near) = (line.end_segment(end), line.end_neighbour(end));
        let far = line.end_slot(end);
        let change = |of: &Field| sign * (of.get(near) - of.get(far));
        let (chord, rate) = (change(&line.position), change(&line.velocity));
        let square = chord.dot(&chord);
        let inverse_l = inverse_norm_of(square);
        let strain = square * inverse_l * line.inverse_length[at] - 1.0;
        let stretching = chord.dot(&rate) * inverse_l;
        let tension = total_tension(
            line.axial_stiffness[at] * strain,
            line.axial_damping[at] * stretching * line.inverse_length[at],
            0.0,
            line.negative_tension,
        );
        self.pull.set(at, chord * (tension * inverse_l));
    }

    #[inline(always)]
    fn choose_segment_pass(&mut self) {
        if self.layout.creep.is_some() {
            return self.creeping_segment_pass();
        }
        let line = &self.layout;
        for at in line.rows() {
            let (chord, inverse_l) = line.chord(at);
            let stiffness = line.axial_stiffness.load(at);
            let elastic = stiffness * line.strain(at).map(|strain| line.law.at(strain).force);
            let rate = line.velocity.load(at + 1) - line.velocity.load(at);
            let stretching = chord.dot(rate) * inverse_l;
            let damping = line.axial_damping.load(at) * stretching * line.inverse_length.load(at);
            let spring = elastic.positive();
            let tension = total_tension(elastic, damping, Lanes::splat(0.0), line.negative_tension);
            self.pull.store(chord.scale(tension * inverse_l), at);
            self.spring.store(chord.scale(spring * inverse_l), at);
        }
    }

    /// [`LineWork::choose_segment_pass`] of a line with viscoelastic segments.
    #[inline(always)]
    fn creeping_segment_pass(&mut self) {
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
            let tension = total_tension(elastic, damping, Lanes::splat(0.0), line.negative_tension);
            self.pull.store(direction.scale(tension), at);
            self.spring.store(direction.scale(tension), at);
        }
        self.layout.creep = Some(creep);
    }

    /// Takes the memory of viscoelastic segments to t_{n+1}, and books what their dampers took.
    fn creep(&mut self, step: Step) {
        if self.layout.creep.is_none() {
            return;
        }
        self.layout.renew_ghosts(self.parted);
        let rows = self.layout.rows();
        if let Some(creep) = &mut self.layout.creep {
            creep.prepare(step.drift);
        }
        for at in rows {
            self.lost = self.lost + self.layout.creep(at, step).taken;
        }
    }

    /// A step from t_n to `t` [s], with the ends going where `ends` says.
    pub fn advance(&mut self, t: f64, step: Step, ends: [&Placed; 2]) {
        let (unit, work, size) = (self.layout.vector_unit, self, &step);
        unit.dispatch(Sweep { work, size, ends });
        if work.settled.is_some() {
            work.settle(step);
            unit.dispatch(Drift { work, size, ends });
        }
        if work.winch.is_some() {
            work.wind(t, step);
        }
        work.creep(step);
        if work.layout.books {
            work.book_ends(step);
        }
        if work.layout.surface.is_some() {
            work.meet_surface(Some(step));
        }
        if work.winch.is_some() {
            work.renew_reel(step);
        }
    }

    /// What a bed that slopes or rubs makes of the velocities at t_{n+½}.
    fn settle(&mut self, step: Step) {
        let line = &mut self.layout;
        let Some(lost) = &mut self.settled else {
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
            let excess = self.water.as_ref().map_or(0.0, |w| w.inverse_mass_excess[at]);
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
            let resisted = self.resistance.get(at).dot(&(landed.velocity - free));
            *lost += 0.5 * (step.kick * resisted - landed.impulse.dot(&passed));
            if let Some(water) = &self.water {
                let squares = [free, landed.velocity].map(|v| v.dot(&tangent).powi(2));
                *lost += 0.5 * water.mass_excess[at] * (squares[1] - squares[0]);
            }
            line.velocity.set(at, landed.velocity);
            line.set_rub(at, landed.rub / step.kick);
        }
    }

    /// Books the work of the ends in a step, and that of the dampers beside them on the ends.
    fn book_ends(&mut self, step: Step) {
        let held = self.held();
        for end in [End::A, End::B] {
            if self.is_parted(end) {
                continue;
            }
            let way = self.end_way(end, step);
            if way == Vector3::zeros() {
                continue; // as of anchors
            }
            let (segment, sign) = self.layout.end_segment(end);
            let pull = sign * self.pull.get(segment);
            self.lost[0] += (sign * self.spring.get(segment) - pull).dot(&way);
            if held[end as usize] {
                self.given += self.layout.end_lack(end) * way.z - pull.dot(&way);
            }
        }
    }

    /// How far an end went from half a step before t_n to half a step after it [m]. A held end goes from place to place: where its acceleration
    /// jumps no velocity tells how far. The material at a winch goes with its velocities.
    fn end_way(&mut self, end: End, step: Step) -> Vector3<f64> {
        let (at, side) = (self.layout.end_slot(end), end as usize);
        let [before, after] = [&self.layout.velocity_before, &self.layout.velocity].map(|of| of.get(at));
        let place = self.layout.position.get(at) - 0.5 * step.drift * after;
        let gone = place - self.half_places[side];
        self.half_places[side] = place;
        match self.held()[side] && self.winch.is_none() {
            true => gone,
            false => 0.5 * step.kick * (before + after),
        }
    }

    /// Puts the ends somewhere that have not parted from their points.
    pub fn put_ends(&mut self, ends: [&Placed; 2]) {
        self.layout.vector_unit.dispatch(PutEnds(self, ends));
    }

    /// Makes the ends take their ways from where they were half the `last` step [s] ago, as they go on now: how they came there is no part of them.
    pub fn set_out_anew(&mut self, last: f64) {
        let lag = 0.5 * last;
        self.set_out(lag);
        self.layout.set_out_anew(lag);
    }

    /// Notes where the ends were `lag` [s] ago.
    fn set_out(&mut self, lag: f64) {
        let ends = [End::A, End::B].map(|end| self.layout.end_slot(end));
        self.half_places = ends.map(|at| self.layout.place_before(at, lag));
    }

    /// What the end brings to a free point, after [`Self::pull_beforehand`]; `velocity` [m/s] is the point's at t_n.
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
        let inverse = self.inverse_mass[at];
        let mass = Slender::inverse([inverse, inverse + excess]);
        let contact = line.contact.as_ref().map_or([0.0; 3], |c| {
            [c.stiffness[at], c.damping[at], c.stiffness[at] * c.level[at]]
        });
        EndLoad {
            force: force + resistance + press,
            resistance,
            press,
            current_power,
            mass: mass.matrix(tangent),
            across: mass.across,
            contact,
        }
    }

    /// How much stiffer than the limit of the step expects the stiffest segment is [-], at least 1.
    pub fn stiffening(&self) -> f64 {
        let line = &self.layout;
        if line.law == StretchLaw::Engineering {
            return 1.0;
        }
        let slope = |i: usize| {
            let [low, high] = [i, i + 1].map(|node| line.position.get(line.slot(node)));
            let strain = (high - low).norm() * line.inverse_length[line.slot(i)] - 1.0;
            line.law.at(strain).slope
        };
        let greatest = (0..line.segment_count).map(slope).fold(0.0, f64::max);
        (greatest / expected_slope(&line.law)).max(1.0)
    }

    /// Looks over the nodes.
    pub fn survey(&self) -> Survey {
        self.layout.vector_unit.dispatch(SurveyRows(self))
    }

    #[inline(always)]
    fn survey_rows(&self) -> Survey {
        let (line, flows) = (&self.layout, self.layout.flows());
        let (mut greatest, mut sound) = (Lanes::splat(0.0), Lanes::splat(1.0));
        for row in line.rows() {
            sound = sound.where_positive(line.soundness(row));
            let Some(water) = &self.water else { continue };
            let mut past = line.velocity.load(row);
            if flows {
                past = past - line.water_velocity(row);
            }
            let rate = past.scale(water.drag_over_mass.load(row));
            greatest = rate.dot(rate).max(greatest);
        }
        let square = (0..LANES).fold(0.0, |sum: f64, lane| sum.max(greatest[lane]));
        let along = self
            .water
            .as_ref()
            .map_or(0.0, |water| self.drag_rate_along(water));
        Survey {
            drag_rate: square.sqrt().max(along),
            is_sound: sound.all_positive(),
        }
    }

    /// Greatest ratio K |v·t| / M along the line [1/s], where that may exceed the one across it.
    fn drag_rate_along(&self, water: &WaterWork) -> f64 {
        let Some(over_mass) = &water.drag_over_mass_along else {
            return 0.0;
        };
        let line = &self.layout;
        let rate = |(i, at): (usize, Slot)| {
            let past = line.velocity.get(at) - line.water_velocity_of(at);
            over_mass[at] * past.dot(&line.tangent_of(i)).abs()
        };
        line.nodes().enumerate().map(rate).fold(0.0, f64::max)
    }

    /// Whether its nodes move as they did when they were surveyed last and [`Self::resume`] went on from there, and nothing else matters to a survey.
    pub fn keeps_survey(&self) -> bool {
        !self.layout.flows() && self.winch.is_none()
    }

    /// Index of the node that moves fastest.
    pub fn fastest_node(&self) -> usize {
        self.layout.fastest_node()
    }

    /// Index of the first node that has no finite position, or a speed that no mooring line reaches.
    pub fn broken_node(&self) -> Option<usize> {
        self.layout.broken_node()
    }
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
    let elastic = segments.axial_stiffness[segment] * segments.law[segment].at(l / length - 1.0).force;
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
