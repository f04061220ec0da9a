//! Free points of a network with implicit tension.
//!
//! For a given velocity v of the free point at an end, the tensions T̄ of a line are linear in s = d·v, with d = q at end B and −q at end A. The
//! right-hand side of the end segment in the system in T̄ is r s, with r the slope of T̄ with the stretching velocity. Hence
//!
//! T̄ = T⁰ + Σ_e g_e s_e,
//!
//! with T⁰ the tension for free points at rest, and g_e the solution for r at the end segment alone. The momentum equation of a point with the mass M,
//! which includes the half nodes of its lines, and the force f without tension,
//!
//! M (v − v⁻) = Δt [f − Σ_e d_e T̄_e],
//!
//! is then a symmetric positive definite system in the velocities of the points, with a block for every line between two of them: the graph of the
//! network. It is solved by sparse elimination ([`PointSystem`]). Seabed springs that push are included in M, and are checked together with the slack and
//! contact of the lines. Friction is the impulse that would stop the point, limited by Coulomb's law; friction and velocity are iterated to convergence.
//!
//! Source: static condensation of the lines to their ends (Guyan 1965, AIAA J. 3, 380) in the equations of [`super`].

use nalgebra::{Matrix3, Vector3};

use super::rows::{SegmentRow, Sizes};
use super::{AxialImplicit, AxialLine, PASSES_MAX, Stage};
use crate::dynamics::leapfrog::ENDS;
use crate::dynamics::leapfrog::layout::Layout;
use crate::dynamics::leapfrog::network::LeapfrogNetwork;
use crate::dynamics::leapfrog::point::{
    ContactSpring, Kicked, PointLoad, SeabedBelow, Sliding, load_in_water, load_over,
};
use crate::dynamics::leapfrog::step::Step;
use crate::math::block_banded::Pivots;
use crate::math::lanes::Lanes;
use crate::math::sparse_blocks::PointSystem;
use crate::model::{End, Model, Network};
use crate::physics::friction::Friction;
use crate::physics::slender::Slender;

/// Change of friction that requires another pass, relative to the push of the seabed [-].
const FRICTION_TOLERANCE: f64 = 1e-4;

/// Tensions of four segments as functions of the velocities of free points.
#[derive(Debug, Clone, Copy)]
pub(super) struct OpenRow {
    /// T⁰ [N].
    base: Lanes,
    /// g for ends A and B [N s/m].
    slopes: [Lanes; 2],
}

impl Default for OpenRow {
    fn default() -> OpenRow {
        let zero = Lanes::splat(0.0);
        OpenRow {
            base: zero,
            slopes: [zero; 2],
        }
    }
}

/// Tension of the segment at an end as a function of the velocities of the free points at both ends.
#[derive(Debug, Clone, Copy)]
struct EndTension {
    /// d [-].
    direction: Vector3<f64>,
    /// T⁰ [N].
    base: f64,
    /// Slopes with s at ends A and B [N s/m].
    slopes: [f64; 2],
}

/// Free points during a step.
#[derive(Debug, Clone, Default)]
pub struct Coupling {
    points: Vec<CoupledPoint>,
    system: Option<PointSystem>,
}

#[derive(Debug, Clone)]
struct CoupledPoint {
    load: PointLoad,
    /// Velocity before the step [m/s].
    last: Vector3<f64>,
    /// Velocity found by the last pass [m/s].
    velocity: Vector3<f64>,
    /// Springs of the seabed, and whether they push.
    springs: Vec<(ContactSpring, bool)>,
    /// Normal of the seabed [-].
    normal: Vector3<f64>,
    /// Impulse of friction [N s].
    friction: Vector3<f64>,
    /// Inverse of the diagonal block of the point [1/kg].
    inverse: Matrix3<f64>,
    /// 1 along the free axes of the point, else 0.
    free: Vector3<f64>,
}

impl Coupling {
    pub(super) fn new(model: &Model, network: &Network) -> Coupling {
        let points = &network.free_points;
        if points.is_empty() {
            return Coupling::default();
        }
        let place = |point: usize| points.iter().position(|&free| free == point);
        let pair = |&line: &usize| {
            let [a, b] = model.lines[line].ends;
            Some((place(a)?, place(b)?))
        };
        let pairs: Vec<(usize, usize)> = network.lines.iter().filter_map(pair).collect();
        let point = |&point: &usize| {
            let zero = Vector3::zeros();
            let axes = model.points[point].free().map_or([true; 3], |free| free.axes);
            CoupledPoint {
                load: PointLoad::none(),
                last: zero,
                velocity: zero,
                springs: Vec::with_capacity(model.points[point].attached.len() + 1),
                normal: Vector3::z(),
                friction: zero,
                inverse: Matrix3::zeros(),
                free: axes.map(|free| f64::from(u8::from(free))).into(),
            }
        };
        Coupling {
            points: points.iter().map(point).collect(),
            system: Some(PointSystem::new(points.len(), &pairs)),
        }
    }
}

/// Takes a step of a network with free points from `t` [s]. Returns the number of passes.
pub(super) fn step(network: &mut LeapfrogNetwork<AxialImplicit>, model: &Model, t: f64, step: Step) -> usize {
    for (line, ends) in network.lines_and_ends() {
        let ends = &ends.map(|end| end.position);
        line.run(Prepare { step, ends });
    }
    let mut coupling = std::mem::take(&mut network.scratch);
    for (free, point) in coupling.points.iter_mut().enumerate() {
        point.prepare(network, free, model, (t, step));
    }
    let friction = model.seabed.as_ref().and_then(|seabed| seabed.friction.as_ref());
    let mut passes = 0;
    loop {
        passes += 1;
        network
            .lines
            .iter_mut()
            .for_each(|line| line.run(Tensions { step }));
        coupling.solve(network, step);
        let mut holds = true;
        for point in &mut coupling.points {
            holds &= point.seabed_holds(friction, step);
        }
        for number in 0..network.lines.len() {
            let velocities = network
                .free_ends(number)
                .map(|free| free.map_or(Vector3::zeros(), |free| coupling.points[free].velocity));
            holds &= network.lines[number].run(Settle { step, velocities });
        }
        if holds || passes == PASSES_MAX {
            network.lines[0].kernel.settled &= holds;
            break;
        }
    }
    for (free, point) in coupling.points.iter_mut().enumerate() {
        let (velocity, friction) = (point.velocity, point.friction);
        let mut load = point.load;
        load.force -= network.pull_on(free);
        network.move_point(free, model, &load, Kicked { velocity, friction }, (t, step));
    }
    network.scratch = coupling;
    network.find_free_ends();
    for (line, ends) in network.lines_and_ends() {
        let ends = &ends.map(|end| end.position);
        line.run(Finish { step, ends });
    }
    passes
}

impl LeapfrogNetwork<AxialImplicit> {
    /// Ends of lines at a free point that are not released.
    fn ends_at(&self, free: usize) -> impl Iterator<Item = (&AxialLine, End)> {
        let ends = self.attached[free]
            .iter()
            .map(|&(line, end)| (&self.lines[line], end));
        ends.filter(|(line, end)| !line.is_released(*end))
    }

    /// Sum of d T̄ over the ends of lines at a free point [N].
    fn pull_on(&self, free: usize) -> Vector3<f64> {
        let pull = |(line, end): (&AxialLine, End)| {
            let (segment, sign) = line.layout.end_segment(end);
            -sign * line.kernel.rows.pull(segment)
        };
        self.ends_at(free).map(pull).sum()
    }
}

impl CoupledPoint {
    /// Evaluates loads and contact at the start of a step from `t` [s].
    fn prepare(
        &mut self,
        network: &LeapfrogNetwork<AxialImplicit>,
        free: usize,
        model: &Model,
        (t, step): (f64, Step),
    ) {
        let (state, index) = (&network.points[free], network.point_numbers[free]);
        let Some(law) = model.points[index].free() else {
            return;
        };
        let last = state.half_step[0];
        let seabed = SeabedBelow::under(model, state.position);
        let (waves, place) = (network.waves_at(free, t), [state.position.z, t]);
        let mut load = load_in_water((model, law), place, last, waves, Some(step.kick));
        load.force += load_over(&model.points[index], t, step);
        let rise = seabed.normal.dot(&last);
        self.springs.clear();
        let with_state = |spring: ContactSpring| (spring, spring.pushes(rise).is_some());
        let own = ContactSpring::under_point(law, &seabed, step);
        self.springs.extend(own.map(with_state));
        for (line, end) in network.ends_at(free) {
            let share = line.end_share(end, step);
            load.add(&share);
            self.springs.extend(share.contact.map(with_state));
        }
        (self.load, self.last, self.velocity) = (load, last, last);
        self.normal = seabed.normal;
        self.friction = Vector3::zeros();
    }

    /// Revises contact and friction for the velocity found by a pass; returns false if another pass is required.
    fn seabed_holds(&mut self, friction: Option<&Friction>, step: Step) -> bool {
        let rise = self.normal.dot(&self.velocity);
        let (mut push, mut holds) = (0.0, true);
        for (spring, pushes) in &mut self.springs {
            let now = spring.pushes(rise);
            holds &= now.is_some() == *pushes;
            *pushes = now.is_some();
            push += step.kick * now.unwrap_or(0.0);
        }
        let Some(law) = friction.filter(|_| push > 0.0) else {
            holds &= self.friction == Vector3::zeros();
            self.friction = Vector3::zeros();
            return holds;
        };
        let sliding = Sliding::new(self.normal, &self.inverse, &self.free);
        let without = self.velocity - self.inverse * self.friction.component_mul(&self.free);
        let change = sliding.friction(without, self.friction, law.transverse * push);
        if change.norm() > FRICTION_TOLERANCE * push {
            self.friction += change;
            return false;
        }
        holds
    }
}

impl Coupling {
    /// Solves for the velocities of the points, from the tensions of the lines as functions of these velocities.
    fn solve(&mut self, network: &LeapfrogNetwork<AxialImplicit>, step: Step) {
        let Some(system) = &mut self.system else {
            return;
        };
        system.clear();
        for (free, point) in self.points.iter_mut().enumerate() {
            let (mut own, mut right) = (point.load.mass, point.load.mass * point.last);
            right += step.kick * point.load.force + point.friction;
            for (spring, _) in point.springs.iter().filter(|(_, pushes)| *pushes) {
                let [push, resistance] = spring.law();
                own += step.kick * resistance * point.normal * point.normal.transpose();
                right += step.kick * push * point.normal;
            }
            for &(line, end) in &network.attached[free] {
                if network.lines[line].is_released(end) {
                    continue;
                }
                let EndTension {
                    direction,
                    base,
                    slopes,
                } = network.lines[line].end_tension(end);
                right -= step.kick * base * direction;
                for other in ENDS {
                    let Some(column) = network.free_ends(line)[other as usize] else {
                        continue;
                    };
                    if network.lines[line].is_released(other) {
                        continue;
                    }
                    let across = network.lines[line].outward(other);
                    let block = step.kick * slopes[other as usize] * direction * across.transpose();
                    match column == free {
                        true => own += block,
                        false => system.add_block(free, column, &block),
                    }
                }
            }
            for axis in (0..3).filter(|&axis| point.free[axis] == 0.0) {
                system.hold(free, axis);
            }
            system.add_block(free, free, &own);
            system.add_right(free, right);
            let masked = own.component_mul(&(point.free * point.free.transpose()));
            let held = Matrix3::from_diagonal(&point.free.map(|free| 1.0 - free));
            point.inverse = (masked + held).try_inverse().unwrap_or_else(Matrix3::zeros);
        }
        let is_solved = system.solve(Pivots::Positive);
        for (free, point) in self.points.iter_mut().enumerate() {
            point.velocity = match is_solved {
                true => system.solution(free),
                false => Vector3::repeat(f64::NAN), // the step ends in an error
            };
        }
    }
}

impl AxialLine {
    /// d of an end: the direction in which a velocity of the end stretches the line [-].
    fn outward(&self, end: End) -> Vector3<f64> {
        let (segment, sign) = self.layout.end_segment(end);
        -sign
            * self.kernel.rows.segments[segment.row - 1]
                .direction
                .get(segment.lane)
    }

    fn end_tension(&self, end: End) -> EndTension {
        let (segment, _) = self.layout.end_segment(end);
        let row = &self.kernel.open[segment.row - 1];
        EndTension {
            direction: self.outward(end),
            base: row.base[segment.lane],
            slopes: row.slopes.map(|slope| slope[segment.lane]),
        }
    }

    /// Ends at free points.
    fn open_ends(&self) -> impl Iterator<Item = End> + use<> {
        let layout = &self.layout;
        let open = ENDS.map(|end| !layout.tied[end as usize] && !layout.released[end as usize]);
        ENDS.into_iter().filter(move |&end| open[end as usize])
    }

    /// Load and mass of the half node at an end without tension, and its contact. The drag is implicit, as at the other nodes.
    fn end_share(&self, end: End, step: Step) -> PointLoad {
        let layout: &Layout = &self.layout;
        let at = layout.end_slot(end);
        let node = &self.kernel.rows.nodes[at.row - 1];
        let lane = at.lane;
        let (tangent, velocity) = (node.tangent.get(lane), layout.velocity.get(at));
        let mut share = PointLoad::none();
        let current = self.kernel.rows.current.as_ref().map(|rows| &rows[at.row - 1]);
        let flow = current.map_or(Vector3::zeros(), |current| current.flow.get(lane));
        let kick = Lanes::splat(step.kick);
        let masses = |damping| {
            node.effective_masses(layout.drag.is_some(), damping, kick)
                .map(|mass| mass[lane])
        };
        if layout.drag.is_some() {
            let [normal, along] = node.drag.map(|drag| drag[lane]);
            let past = velocity - flow;
            let speed = past.dot(&tangent);
            let drag_along = along * speed + node.drag_rest[lane];
            share.resistance = -normal * (past - speed * tangent) - drag_along * tangent;
            share.current_power = share.resistance.dot(&flow);
            let [across, along] = masses(None);
            let implicit = Slender::new([across - node.mass_normal[lane], along - node.mass_tangent[lane]]);
            share.current_power_loss = implicit.times(flow, tangent) / step.kick;
        }
        if let Some(damping) = &layout.mass_damping {
            share.resistance -= damping[at] * velocity;
        }
        if let (Some(current), true) = (current, layout.waves.is_some()) {
            share.froude_krylov = current.froude_krylov.get(lane);
        }
        let (segment, sign) = layout.end_segment(end);
        let bent = sign * self.shear(segment);
        share.force = share.resistance + share.froude_krylov + bent - layout.weight[at] * Vector3::z();
        let damping = layout.mass_damping.as_ref().map(|damping| damping.load(at.row));
        share.mass = Slender::new(masses(damping)).matrix(tangent);
        if let Some(contact) = &layout.contact {
            share.contact = ContactSpring::of_line([contact.spring[at], contact.resistance[at]]);
        }
        share
    }

    fn set_end_velocity(&mut self, end: End, velocity: Vector3<f64>) {
        let at = self.layout.end_slot(end);
        let node = &mut self.kernel.rows.nodes[at.row - 1];
        node.fall.set(at.lane, velocity);
        node.loose.set(at.lane, velocity);
    }

    /// Computes T⁰ and g of the ends tied to free points.
    #[inline(always)]
    fn find_open_tensions(&mut self, sizes: &Sizes) {
        self.open_ends()
            .for_each(|end| self.set_end_velocity(end, Vector3::zeros()));
        self.assemble(sizes);
        self.solve_tensions();
        let zero = Lanes::splat(0.0);
        for (row, segment) in self.kernel.open.iter_mut().zip(&self.kernel.rows.segments) {
            *row = OpenRow {
                base: segment.tension,
                slopes: [zero; 2],
            };
        }
        for end in self.open_ends() {
            let (at, _) = self.layout.end_segment(end);
            for segment in &mut self.kernel.rows.segments {
                segment.equations.right = zero;
            }
            let segment: &mut SegmentRow = &mut self.kernel.rows.segments[at.row - 1];
            segment.equations.right[at.lane] = segment.rate_slope(sizes)[at.lane];
            self.solve_tensions();
            for (row, segment) in self.kernel.open.iter_mut().zip(&self.kernel.rows.segments) {
                row.slopes[end as usize] = segment.tension;
            }
        }
    }

    /// Sets T̄ from the velocities of the free points at the ends [m/s]. Returns T̄ of the segments before the first row [N].
    #[inline(always)]
    fn combine_tensions(&mut self, velocities: [Vector3<f64>; 2]) -> Lanes {
        let mut speeds = [Lanes::splat(0.0); 2];
        for end in self.open_ends() {
            let velocity = velocities[end as usize];
            speeds[end as usize] = Lanes::splat(self.outward(end).dot(&velocity));
            self.set_end_velocity(end, velocity);
        }
        let segments = &mut self.kernel.rows.segments[..];
        for (row, segment) in self.kernel.open.iter().zip(&mut *segments) {
            segment.tension = row.base + row.slopes[0] * speeds[0] + row.slopes[1] * speeds[1];
        }
        segments
            .last()
            .map_or(Lanes::splat(0.0), |last| last.tension.moved_up())
    }
}

struct Prepare<'a> {
    step: Step,
    ends: &'a [Vector3<f64>; 2],
}

impl Stage for Prepare<'_> {
    type Found = ();

    #[inline(always)]
    fn run<const SEABED: u8>(self, line: &mut AxialLine) {
        line.prepare::<SEABED>(self.step, self.ends);
    }
}

/// Tensions of a line as functions of the velocities of free points at its ends.
struct Tensions {
    step: Step,
}

impl Stage for Tensions {
    type Found = ();

    #[inline(always)]
    fn run<const SEABED: u8>(self, line: &mut AxialLine) {
        let sizes = line.sizes(self.step);
        if line.kernel.open.is_empty() {
            return;
        }
        line.find_open_tensions(&sizes);
    }
}

/// Velocities of a line, from those of the free points at its ends [m/s]. Returns whether the assumptions hold.
struct Settle {
    step: Step,
    velocities: [Vector3<f64>; 2],
}

impl Stage for Settle {
    type Found = bool;

    #[inline(always)]
    fn run<const SEABED: u8>(self, line: &mut AxialLine) -> bool {
        let sizes = line.sizes(self.step);
        let before = match line.kernel.open.is_empty() {
            true => {
                line.assemble(&sizes);
                line.solve_tensions()
            }
            false => line.combine_tensions(self.velocities),
        };
        line.pass::<SEABED>(before, &sizes)
    }
}

/// Motion of the nodes to t_{n+1}, with the ends at given positions [m].
struct Finish<'a> {
    step: Step,
    ends: &'a [Vector3<f64>; 2],
}

impl Stage for Finish<'_> {
    type Found = ();

    #[inline(always)]
    fn run<const SEABED: u8>(self, line: &mut AxialLine) {
        let sizes = line.sizes(self.step);
        line.finish::<SEABED>(self.step, self.ends, &sizes);
    }
}
