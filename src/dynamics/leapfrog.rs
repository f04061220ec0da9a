//! Semi-explicit leapfrog of lumped two-node segments: the default for cables without bending.
//!
//! Positions live at t_n, velocities at t_{n−½}. The stages of a step are
//!
//! 1. segments: strain, lagged strain rate, tension T q;
//! 2. free points, which take the forces of the segments at them;
//! 3. nodes: v_{n+½} = v_{n−½} + Δt M⁻¹ f, with drag at the extrapolated velocity 1.5 v_{n−½} − 0.5 v_{n−3/2}, the
//!    anisotropic mass inverted in closed form and the seabed solved implicitly, node by node, by a rank-one update or, with a slope or friction, by
//!    [`crate::physics::friction_step`];
//! 4. r_{n+1} = r_n + Δt v_{n+½}; the ends are put where their points are.
//!
//! Stage 4 is part of the loop of stage 3 unless the energy balance is evaluated between them.
//!
//! One force evaluation a step, second order, stable below [`super::limit::explicit_limit`] whatever the seabed.
//!
//! Source: Verlet's scheme as in Hairer, Lubich & Wanner (2003), Acta Numerica 12, 399-450; the inverse of
//! M_n I + (M_t − M_n) t tᵀ by Sherman & Morrison (1950); contact: backward Euler on the penetrating spring and damper.

mod balance;
mod sweep;
mod winch;

use nalgebra::{Matrix3, Vector3};
use pulp::NullaryFnOnce;

use super::layout::{Layout, Water, interior};
use super::limit::expected_slope;
use super::step::Step;
use crate::math::lanes::{LANES, Lanes};
use crate::math::striping::{Column, Field, Slot};
use crate::model::{End, Line, LineState, Model, Release, WaveSpan};
use crate::physics::morison::{self, DragCoefficients};
use crate::physics::slender::Slender;
use crate::physics::stretch::{StretchLaw, total_tension};
use balance::LineBalance;
pub use sweep::Placed;
use sweep::{Drift, Pull, Sweep};
use winch::WinchWork;

/// Rows of nodes that vectors of eight numbers do not pay for [-].
const FEW_ROWS: usize = 5;

/// A line and the scratch of its steps.
#[derive(Debug, Clone)]
pub struct LineWork {
    layout: Layout,
    /// Force of a segment on its lower node, T q [N].
    pull: Field,
    /// Resistance of water and mass damping at t_n [N].
    resistance: Field,
    /// Force of water that waves accelerate at t_n [N], where there are waves.
    froude_krylov: Option<Field>,
    /// Inverse square of the chord between the nodes beside a node at t_n [1/m²].
    inverse_square: Column,
    inverse_mass: Column,
    water: Option<WaterWork>,
    /// 1 for nodes between prescribed ends and at released ones, 0 elsewhere.
    interior: Column,
    /// Whether ends A and B are held, were none released.
    tied: [bool; 2],
    /// Whether they are released from their points.
    released: [bool; 2],
    /// The energy balance, where the scene asks for it.
    balance: Option<LineBalance>,
    /// The winch at end B, where the line is on one.
    winch: Option<Box<WinchWork>>,
}

/// Coefficients of resistance, and of a mass that differs along and across the line.
#[derive(Debug, Clone)]
struct WaterWork {
    drag_normal: Column,
    drag_tangent: Column,
    /// 1/M_t − 1/M_n [1/kg].
    inverse_mass_excess: Column,
    /// Drag coefficient over mass of a node that is wholly in the water, across the line [1/m].
    drag_over_mass: Column,
    /// The same along the line, where it is greater at some node [1/m].
    drag_over_mass_along: Option<Column>,
}

impl WaterWork {
    fn new(line: &Line, layout: &Layout) -> Option<WaterWork> {
        let nodes = &line.nodes;
        let zeros = Column::new(layout.striping, 0.0);
        let masses = || nodes.mass_tangent.iter().zip(&nodes.mass_normal);
        let excess: Vec<f64> = masses().map(|(t, n)| 1.0 / t - 1.0 / n).collect();
        let needed = layout.drag.is_some()
            || layout.waves.is_some()
            || layout.mass_damping.is_some()
            || excess.iter().any(|excess| *excess != 0.0);
        let drag = layout.drag.as_ref();
        let over_mass = |drag: Option<&[f64]>, mass: &[f64]| -> Vec<f64> {
            let pairs = drag.unwrap_or_default().iter().zip(mass);
            pairs.map(|(drag, mass)| drag / mass).collect()
        };
        let given = nodes.drag.as_ref();
        let across = over_mass(given.map(|drag| &drag.normal[..]), &nodes.mass_normal);
        let along = over_mass(given.map(|drag| &drag.tangent[..]), &nodes.mass_tangent);
        let counts = along.iter().zip(&across).any(|(along, across)| along > across);
        needed.then(|| WaterWork {
            drag_over_mass: layout.striping.column(&across, 0.0),
            drag_over_mass_along: counts.then(|| layout.striping.column(&along, 0.0)),
            drag_normal: drag.map_or(zeros.clone(), |drag| drag.normal.clone()),
            drag_tangent: drag.map_or(zeros, |drag| drag.tangent.clone()),
            inverse_mass_excess: layout.striping.column(&excess, 0.0),
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

/// [`LineWork::put_ends`] for the vector unit of the machine.
struct PutEnds<'a>(&'a mut LineWork, [&'a Placed; 2]);

impl NullaryFnOnce for PutEnds<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let PutEnds(work, ends) = self;
        work.layout.place_ends(ends, work.released);
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
    pub froude_krylov: Vector3<f64>,
    /// Power of the drag on the water's way [W].
    pub current_power: f64,
    /// Mass matrix of the half node [kg].
    pub mass: Matrix3<f64>,
    /// Contact stiffness [N/m] and damping [N s/m] of the half node, and its force at z = 0, or at no height over a seabed with a slope, soundings or friction [N].
    pub contact: [f64; 3],
}

impl LineWork {
    /// Scratch for a line; `None` where its sections have different strain measures, which the kernel does not mix.
    pub fn new(model: &Model, line: &Line, held: [bool; 2]) -> Option<LineWork> {
        let winch = WinchWork::new(line);
        let is_held = held[1] && winch.is_none();
        let water = Water::around(model, line);
        let line = line.winch.as_ref().map_or(line, |winch| winch.longest());
        let layout = Layout::new(model, (line, water), FEW_ROWS, is_held)?;
        let inverse_mass: Vec<f64> = line.nodes.mass_normal.iter().map(|mass| 1.0 / mass).collect();
        Some(LineWork {
            pull: Field::zeros(layout.striping),
            resistance: Field::zeros(layout.striping),
            froude_krylov: layout.waves.as_ref().map(|_| Field::zeros(layout.striping)),
            inverse_square: Column::new(layout.striping, 0.0),
            inverse_mass: layout.striping.column(&inverse_mass, 0.0),
            water: WaterWork::new(line, &layout),
            interior: interior(layout.striping, layout.segment_count),
            tied: held,
            released: [false; 2],
            balance: layout.energy_balance.then(LineBalance::default),
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
        self.load_winch(state);
        self.layout.load(state);
        self.released = state.released;
        for end in [End::A, End::B] {
            let at = self.layout.end_slot(end);
            self.interior[at] = f64::from(u8::from(self.is_released(end)));
        }
        self.interior.wrap();
        self.layout.still();
        self.start_balance(0.5 * state.half_step.steps[0]);
    }

    /// Goes on from the state that [`Self::store`] handed back last; a line on a winch is laid out anew.
    pub fn resume(&mut self, state: &LineState) {
        match self.winch {
            None => {
                self.layout.still();
                self.clear_balance();
            }
            Some(_) => self.load(state),
        }
    }

    /// Finds the nodes at the water's surface at t_n and sets their coefficients.
    pub fn meet_surface(&mut self) {
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
        state.released = self.released;
        self.store_winch(state);
        self.layout.store(state, steps);
    }

    /// Whether an end is released from its point.
    pub fn is_released(&self, end: End) -> bool {
        self.released[end as usize]
    }

    /// Returns true for an end that moves as its point is prescribed to.
    fn is_prescribed(&self, end: End) -> bool {
        self.tied[end as usize] && !self.released[end as usize]
    }

    /// Releases the ends whose tension at t_n, `t` [s], or time is due.
    pub fn release_ends(&mut self, releases: &[Release; 2], t: f64, step: Step) {
        for end in [End::A, End::B] {
            let side = end as usize;
            let layout = &self.layout;
            if self.released[side] || !releases[side].is_due(layout.end_tension(end, step), t) {
                continue;
            }
            if self.tied[side] {
                self.balance_release(end, step);
            }
            self.released[side] = true;
            let at = self.layout.end_slot(end);
            self.interior[at] = 1.0;
            self.interior.wrap();
        }
    }

    /// Evaluates the forces of the segments from positions at t_n and velocities at t_{n−½}.
    #[inline]
    pub fn pull(&mut self) {
        self.layout.vector_unit.dispatch(Pull(self));
    }

    /// Takes the memory of viscoelastic segments to t_{n+1}.
    fn relax_segments(&mut self, step: Step) {
        if self.layout.viscoelastic.is_none() {
            return;
        }
        self.layout.renew_halo(self.released);
        let rows = self.layout.rows();
        if let Some(viscoelastic) = &mut self.layout.viscoelastic {
            viscoelastic.prepare(step.drift);
        }
        let mut taken = Lanes::splat(0.0);
        for at in rows {
            taken = taken + self.layout.relax_segments(at, step).taken;
        }
        if let Some(balance) = &mut self.balance {
            balance.dissipate(taken.sum());
        }
    }

    /// A step from t_n to `t` [s], with the ends going where `ends` says; after [`Self::pull`].
    pub fn advance(&mut self, t: f64, step: Step, ends: [&Placed; 2]) {
        let (unit, size) = (self.layout.vector_unit, &step);
        let drifts = self.balance.is_none();
        unit.dispatch(Sweep {
            work: self,
            size,
            drifts,
            ends,
        });
        if !drifts {
            self.balance_nodes(step);
            unit.dispatch(Drift {
                work: self,
                size,
                ends,
            });
        }
        if self.winch.is_some() {
            self.wind(t, step);
        }
        self.relax_segments(step);
        self.balance_ends(step);
        if self.layout.surface.is_some() {
            self.layout.pass_waves(step);
            self.meet_surface();
        }
        if self.winch.is_some() {
            self.renew_end_segment(step);
        }
    }

    /// Puts the ends somewhere that are not released from their points.
    pub fn put_ends(&mut self, ends: [&Placed; 2]) {
        self.layout.vector_unit.dispatch(PutEnds(self, ends));
    }

    /// Makes viscoelastic segments and the work of the ends start from the present place and velocity of the ends, half the `last` step [s] ago: a jump
    /// is not part of their motion.
    pub fn set_out_anew(&mut self, last: f64) {
        let lag = 0.5 * last;
        self.set_out(lag);
        self.layout.set_out_anew(lag);
    }

    /// What the end brings to a free point, after [`Self::pull`]; `velocity` [m/s] is the point's at t_n.
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
        let froude_krylov = line.waves.as_ref();
        let froude_krylov =
            froude_krylov.map_or(Vector3::zeros(), |waves| waves.froude_krylov_of(at, tangent));
        let inverse = self.inverse_mass[at];
        let mass = Slender::inverse([inverse, inverse + excess]);
        let contact = line.contact.as_ref().map_or([0.0; 3], |c| {
            [c.stiffness[at], c.damping[at], c.stiffness[at] * c.level[at]]
        });
        EndLoad {
            force: force + resistance + froude_krylov,
            resistance,
            froude_krylov,
            current_power,
            mass: mass.matrix(tangent),
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
            let rate = past.scale(water.drag_over_mass.load(row) * self.interior.load(row));
            greatest = rate.dot(rate).max(greatest);
        }
        let ends = [End::A, End::B].map(|end| self.drag_rate_at(end).powi(2));
        let square = (0..LANES)
            .map(|lane| greatest[lane])
            .chain(ends)
            .fold(0.0, f64::max);
        let along = self
            .water
            .as_ref()
            .map_or(0.0, |water| self.drag_rate_along(water));
        Survey {
            drag_rate: square.sqrt().max(along),
            is_sound: sound.all_positive(),
        }
    }

    /// Ratio K |v| / M at an end on a free point [1/s], v relative to the water; zero at a prescribed end, whose motion no drag changes.
    fn drag_rate_at(&self, end: End) -> f64 {
        let Some(water) = self.water.as_ref().filter(|_| !self.is_prescribed(end)) else {
            return 0.0;
        };
        let (line, at) = (&self.layout, self.layout.end_slot(end));
        water.drag_over_mass[at] * (line.velocity.get(at) - line.water_velocity_of(at)).norm()
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
        let prescribed = [End::A, End::B].map(|end| self.is_prescribed(end).then(|| line.end_slot(end)));
        let moving = line
            .nodes()
            .enumerate()
            .filter(|(_, at)| !prescribed.contains(&Some(*at)));
        moving.map(rate).fold(0.0, f64::max)
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
