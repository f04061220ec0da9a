//! Explicit leapfrog.
//!
//! The stages of a step of a line are
//!
//! 1. segments: strain, lagged strain rate, tension T q;
//! 2. drag and damping, at the extrapolated velocity 1.5 v_{n−½} − 0.5 v_{n−3/2};
//! 3. nodes: v_{n+½} = v_{n−½} + Δt M⁻¹ f, with the anisotropic mass inverted in closed form. The seabed is implicit, node by node: by a rank-one update
//!    or, with a slope, soundings or friction, by [`crate::physics::friction_step`];
//! 4. r_{n+1} = r_n + Δt v_{n+½}; the ends are moved to their points.
//!
//! Stage 4 is part of the loop of stage 3 unless the energy balance is evaluated between them.
//!
//! The scheme needs one force evaluation per step. It is of second order, with axial damping of first order since its rate of strain is that at
//! t_{n−½}, and stable below [`crate::dynamics::limit::explicit_limit`] for any seabed.
//!
//! Source: Verlet's scheme as in Hairer, Lubich & Wanner (2003), Acta Numerica 12, 399-450; the inverse of
//! M_n I + (M_t − M_n) t tᵀ by Sherman & Morrison (1950); contact as in `leapfrog/contact`.

mod balance;
mod sweep;
mod winch;

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::layout::{Layout, interior};
use super::network::LeapfrogNetwork;
use super::point::{ContactSpring, PointLoad};
use super::step::Step;
use super::{ENDS, EndMotion, Kernel, LeapfrogLine};
use crate::dynamics::Choice;
use crate::dynamics::limit::{ExplicitLimit, expected_slope};
use crate::dynamics::motion::AxisPath;
use crate::dynamics::viscoelastic::Stretching;
use crate::math::lanes::{LANES, Lanes};
use crate::math::striping::{Column, Field, Slot};
use crate::model::{End, Kinematics, Line, LineState, Model, Network};
use crate::physics::morison::{self, DragCoefficients};
use crate::physics::slender::Slender;
use crate::physics::stretch::total_tension;
use sweep::{Drift, Pull, Sweep};
use winch::WinchWork;

pub(super) type ExplicitLine = LeapfrogLine<Explicit>;

/// Workspace of the explicit stages.
#[derive(Debug, Clone)]
pub struct Explicit {
    /// Force of a segment on its lower node, T q [N].
    pull: Field,
    /// Drag and mass damping at t_n [N].
    resistance: Field,
    /// Froude-Krylov force at t_n [N]; `None` without waves.
    froude_krylov: Option<Field>,
    /// Inverse square of the chord between the neighbours of a node at t_n [1/m²].
    inverse_square: Column,
    inverse_mass: Column,
    water: Option<WaterWork>,
    /// 1 for nodes between prescribed ends and at released ones, 0 elsewhere.
    interior: Column,
    /// Winch at end B; `None` if the line is not on a winch.
    winch: Option<Box<WinchWork>>,
    /// Largest ratio K |v| / M of the nodes after the last step [1/s]; `None` if it must be evaluated again.
    drag_rate: Option<f64>,
}

/// Coefficients of drag, and of a mass that differs along and across the line.
#[derive(Debug, Clone)]
struct WaterWork {
    drag_normal: Column,
    drag_tangent: Column,
    /// 1/M_t − 1/M_n [1/kg].
    inverse_mass_excess: Column,
    /// Drag coefficient over mass of a fully submerged node, across the line [1/m].
    drag_over_mass: Column,
    /// The same along the line [1/m]; `None` unless it is larger at some node.
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

/// [`ExplicitLine::survey_drag`] for the vector unit of the machine.
struct DragRate<'a>(&'a ExplicitLine);

impl NullaryFnOnce for DragRate<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        self.0.greatest_drag_rate()
    }
}

impl Kernel for Explicit {
    const SECANTS: bool = false;
    type Bound = ExplicitLimit;
    type Points = Vec<ContactSpring>;

    fn new(_: &Model, line: &Line, layout: &Layout) -> Explicit {
        let winch = WinchWork::new(line);
        let line = line.winch.as_ref().map_or(line, |winch| winch.longest());
        let inverse_mass: Vec<f64> = line.nodes.mass_normal.iter().map(|mass| 1.0 / mass).collect();
        Explicit {
            pull: Field::zeros(layout.striping),
            resistance: Field::zeros(layout.striping),
            froude_krylov: layout.waves.as_ref().map(|_| Field::zeros(layout.striping)),
            inverse_square: Column::new(layout.striping, 0.0),
            inverse_mass: layout.striping.column(&inverse_mass, 0.0),
            water: WaterWork::new(line, layout),
            interior: interior(layout.striping, layout.segment_count),
            winch,
            drag_rate: None,
        }
    }

    fn points(model: &Model, network: &Network) -> Vec<ContactSpring> {
        let attached = |&point: &usize| model.points[point].attached.len();
        let most = network.free_points.iter().map(attached).max();
        Vec::with_capacity(most.map_or(0, |ends| ends + 1))
    }

    fn load(work: &mut ExplicitLine, state: &LineState) {
        work.load_winch(state);
        work.layout.still();
        work.kernel.drag_rate = None;
    }

    /// Reloads a line on a winch completely.
    fn resume(work: &mut ExplicitLine, state: &LineState) {
        if work.kernel.winch.is_some() {
            return work.load(state);
        }
        work.layout.still();
        work.clear_balance();
        if work.layout.flows() {
            work.kernel.drag_rate = None; // the water motion changes
        }
    }

    fn store(work: &mut ExplicitLine, state: &mut LineState, steps: [f64; 2]) -> bool {
        work.store_winch(state);
        work.layout.store(state, steps)
    }

    fn set_free(work: &mut ExplicitLine, end: End, free: bool) {
        let at = work.layout.end_slot(end);
        work.kernel.interior[at] = f64::from(u8::from(free));
        work.kernel.interior.wrap();
    }

    fn end_masses(work: &ExplicitLine, end: End) -> [f64; 2] {
        let at = work.layout.end_slot(end);
        let water = work.kernel.water.as_ref();
        let excess = water.map_or(0.0, |water| water.inverse_mass_excess[at]);
        let across = work.kernel.inverse_mass[at];
        [1.0 / across, 1.0 / (across + excess)]
    }

    fn meet_surface(work: &mut ExplicitLine) {
        let Some(surface) = &work.layout.surface else {
            return;
        };
        let kernel = &mut work.kernel;
        for i in surface.crossed() {
            let (at, now) = (work.layout.slot(i), surface.node(i));
            let [across, along] = now.masses.map(|mass| 1.0 / mass);
            kernel.inverse_mass[at] = across;
            if let Some(water) = &mut kernel.water {
                [water.drag_normal[at], water.drag_tangent[at]] = now.drag;
                water.inverse_mass_excess[at] = along - across;
            }
        }
    }

    fn starts(_: &ExplicitLine) -> bool {
        true
    }

    fn start_winch(work: &mut ExplicitLine, path: &AxisPath, start: (f64, bool), step: Step) {
        work.start_winch(path, start, step);
    }

    fn step(
        network: &mut LeapfrogNetwork<Explicit>,
        model: &Model,
        [t, after]: [f64; 2],
        step: Step,
        held: &impl Fn(usize, f64) -> Kinematics,
    ) -> usize {
        for line in &mut network.lines {
            line.layout.vector_unit.dispatch(Pull(line, step));
            line.weigh_end_segment();
        }
        network.step_points(model, t, step);
        network.find_ends(after, step.drift, held);
        for (line, ends) in network.lines_and_ends() {
            line.advance(after, step, ends);
        }
        1
    }

    /// The step is limited for the current stiffness of the springs and the drag at the current velocities.
    fn longest_step(
        network: &mut LeapfrogNetwork<Explicit>,
        model: &Model,
        choice: &Choice,
        [t, _]: [f64; 2],
    ) -> (f64, ExplicitLimit) {
        let lines = network.lines.iter().map(ExplicitLine::stiffening);
        let stiffening = lines.fold(1.0, f64::max);
        let limit = choice.explicit.stiffened(stiffening);
        let longest = choice.step_max / stiffening.sqrt();
        let rate = network.drag_rate(model, t);
        (longest.min(limit.with_drag(rate)), limit)
    }

    fn were_short(
        network: &mut LeapfrogNetwork<Explicit>,
        model: &Model,
        limit: &ExplicitLimit,
        [t, drift]: [f64; 2],
    ) -> bool {
        for line in &mut network.lines {
            line.kernel.drag_rate = Some(line.survey_drag());
        }
        limit.holds(network.drag_rate(model, t), drift)
    }
}

impl ExplicitLine {
    /// Advances the velocities to t_{n+½} and the positions to t_{n+1} = `t` [s].
    fn advance(&mut self, t: f64, step: Step, ends: [&EndMotion; 2]) {
        let (unit, size) = (self.layout.vector_unit, &step);
        let drifts = self.balance.is_none();
        unit.dispatch(Sweep {
            work: self,
            size,
            drifts,
            ends,
        });
        if !drifts {
            self.layout.set_end_velocities(ends);
            self.balance_nodes(step);
            unit.dispatch(Drift {
                work: self,
                size,
                ends,
            });
        }
        self.wind(t, step);
        self.relax_segments(step);
        self.balance_ends(step);
        self.layout.pass_waves(step);
        self.meet_surface();
        self.renew_end_segment(step);
    }

    fn relax_segments(&mut self, step: Step) {
        if self.layout.viscoelastic.is_none() {
            return;
        }
        self.layout.renew_halo();
        let rows = self.layout.rows();
        if let Some(viscoelastic) = &mut self.layout.viscoelastic {
            viscoelastic.prepare(step.drift);
        }
        let mut taken = Lanes::splat(0.0);
        for at in rows {
            taken = taken + self.layout.relax_segments(at, step).taken;
        }
        if let Some(balance) = &mut self.balance {
            balance.dissipation += taken.sum();
        }
    }

    /// Load and mass of the half node at an end tied to a free point, after [`Pull`]; `velocity` is that of the point at t_n [m/s].
    pub(super) fn end_load(&self, end: End, velocity: Vector3<f64>) -> PointLoad {
        let line = &self.layout;
        let (at, other) = (line.end_slot(end), line.end_neighbour(end));
        let (segment, sign) = line.end_segment(end);
        let chord = line.position.get(other) - line.position.get(at);
        let tangent = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let (mut resistance, mut current_power) = (Vector3::zeros(), 0.0);
        let force = sign * self.kernel.pull.get(segment) - line.weight[at] * Vector3::z();
        let mut excess = 0.0;
        if let Some(water) = &self.kernel.water {
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
        let inverse = self.kernel.inverse_mass[at];
        let mass = Slender::inverse([inverse, inverse + excess]);
        let contact = line.contact.as_ref();
        let contact = contact.and_then(|c| ContactSpring::of_line([c.spring[at], c.resistance[at]]));
        PointLoad {
            force: force + resistance + froude_krylov,
            resistance,
            froude_krylov,
            current_power,
            current_power_loss: Vector3::zeros(),
            mass: mass.matrix(tangent),
            contact,
        }
    }

    /// Ratio of the highest segment stiffness to that assumed by the step limit [-], at least 1.
    pub(super) fn stiffening(&self) -> f64 {
        let line = &self.layout;
        if !line.law.may_stiffen() {
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

    /// Largest ratio K |v| / M of the nodes [1/s], from the last step if available.
    pub(super) fn drag_rate(&self) -> f64 {
        self.kernel.drag_rate.unwrap_or_else(|| self.survey_drag())
    }

    /// Largest ratio K |v| / M across or along the line [1/s], with v relative to the water: explicit drag is stable for Δt up to half of its inverse.
    fn survey_drag(&self) -> f64 {
        match self.kernel.water {
            Some(_) => self.layout.vector_unit.dispatch(DragRate(self)),
            None => 0.0,
        }
    }

    #[inline(always)]
    fn greatest_drag_rate(&self) -> f64 {
        let (line, flows) = (&self.layout, self.layout.flows());
        let Some(water) = &self.kernel.water else {
            return 0.0;
        };
        let mut greatest = Lanes::splat(0.0);
        for row in line.rows() {
            let mut past = line.velocity.load(row);
            if flows {
                past = past - line.water_velocity(row);
            }
            let rate = past.scale(water.drag_over_mass.load(row) * self.kernel.interior.load(row));
            greatest = rate.dot(rate).max(greatest);
        }
        let square = (0..LANES).fold(0.0, |sum: f64, lane| sum.max(greatest[lane]));
        let ends = ENDS.map(|end| self.drag_rate_at(end, water));
        let across = ends.into_iter().fold(square.sqrt(), f64::max);
        across.max(self.drag_rate_along(water))
    }

    /// Ratio K |v| / M at an open end [1/s], with v relative to the water; zero at a prescribed end, where drag does not change the motion.
    fn drag_rate_at(&self, end: End, water: &WaterWork) -> f64 {
        let (line, at) = (&self.layout, self.layout.end_slot(end));
        match line.is_open(end) {
            true => water.drag_over_mass[at] * (line.velocity.get(at) - line.water_velocity_of(at)).norm(),
            false => 0.0,
        }
    }

    /// Largest ratio K |v·t| / M along the line [1/s]; zero if it cannot exceed that across the line.
    fn drag_rate_along(&self, water: &WaterWork) -> f64 {
        let Some(over_mass) = &water.drag_over_mass_along else {
            return 0.0;
        };
        let line = &self.layout;
        let rate = |(i, at): (usize, Slot)| {
            let past = line.velocity.get(at) - line.water_velocity_of(at);
            over_mass[at] * past.dot(&line.tangent_of(i)).abs()
        };
        let prescribed = ENDS.map(|end| (!line.is_open(end)).then(|| line.end_slot(end)));
        let nodes = line.nodes().enumerate();
        let moving = nodes.filter(|(_, at)| !prescribed.contains(&Some(*at)));
        moving.map(rate).fold(0.0, f64::max)
    }
}

/// Tension [N] of one segment, by the law of the kernel.
pub(in crate::dynamics) fn segment_tension(
    line: &Line,
    segment: usize,
    now: Stretching,
    negative_tension: bool,
) -> f64 {
    let segments = &line.segments;
    total_tension(
        segments.axial_stiffness[segment] * segments.law[segment].at(now.strain).force,
        segments.axial_damping[segment] * now.rate,
        0.0 - line.compression_max(segment),
        negative_tension,
    )
}
