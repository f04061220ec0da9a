//! Stiffness of the mooring on a vessel: the 6×6 slope of its force with the vessel's displacements.
//!
//! The vessel moves by x, y and z [m] and by small rotations about the global axes through its origin [rad]. A point
//! on it at the arm r [m] from the origin follows by u = δ + ω × r, clamps turn by ω × d, and all free nodes and
//! points move to their new equilibrium. With J the exact tangent of the residual R at rest, x the unknowns and c the
//! contribution of the turned clamps to R,
//!
//!   J (u − x) + c = 0 at every node between the ends and every free point,   δR = J (u − x) + c at the ends on the vessel,
//!
//! six solves of the linear system of statics. The force of the mooring is F = −R and its moment M = Σ r × F + m, so
//! that
//!
//!   K δ = −δF = Σ δR,   −δM = Σ r × δR + (ω × r) × R − δm,
//!
//! the second term because the arms turn. The moment on a clamp of direction d is m = −d × g with g the slope of the energy of its
//! joint with d, and −δm = (ω × d) × g + d × δg.
//!
//! A network whose lines lie on closed-form catenaries takes the stiffness of those, seabed friction included, in
//! place of J. Others have that of their elements: springs, weight, bending and the springs of the seabed; nodes that
//! stick to it hold by their friction, and sliding nodes continue to slide. Drag, inertia and dampers are not
//! included. Without friction the mooring is conservative: the parts of K that concern displacements are symmetric,
//! and K − Kᵀ of the rotations is ω ↦ M × ω, since finite rotations do not commute.
//!
//! Source: derived here. Valid where the equilibrium is stable. A line that lies slack on the seabed has no lateral
//! stiffness; anchoring springs of a part of 10⁻¹⁵ to 10⁻⁹ of its axial stiffness then keep it in place. Beams have
//! no tangent here.

use std::ops::SubAssign;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::catenary_network::{self, HungNetwork};
use crate::elements::{LineWork, StaticCase, Workspace, friction};
use crate::model::{Body, End, Line, Model, Network, Role, State};
use crate::physics::bending::{Direction, Hessian, Turn};

/// Springs on every unknown, over the greatest axial stiffness of a segment [-]; each is tried where the one before did not do.
const ANCHORING: [f64; 4] = [0.0, 1e-15, 1e-12, 1e-9];

/// Minus the change of force [N/m, N] and moment [N, N m] of the mooring on a vessel, about its `origin` [m], with displacement and
/// rotation along and about the global axes. `None` where the present state is not stable, a beam is attached, or a line
/// is released from a point.
pub fn of_vessel(
    model: &Model,
    state: &State,
    vessel: usize,
    origin: Vector3<f64>,
    work: &mut Workspace,
) -> Option<Matrix6<f64>> {
    let mut sum = of_own_weights(model, state, vessel, origin);
    for number in 0..model.networks.len() {
        let problem = Problem {
            model,
            number,
            network: &model.networks[number],
            state,
            vessel,
            origin,
        };
        if problem.ends().next().is_none() {
            continue;
        }
        let released = |&line: &usize| state.lines[line].released != [false; 2];
        if model.beam_of(number).is_some() || problem.network.lines.iter().any(released) {
            return None;
        }
        sum += if problem.on_catenaries() {
            problem.of_catenaries(work)?
        } else {
            let mut parts = ANCHORING.into_iter();
            parts.find_map(|part| problem.of_elements(part, work))?
        };
    }
    Some(sum)
}

/// The same of the points themselves that ride on it: their loads, and their weight less buoyancy.
fn of_own_weights(model: &Model, state: &State, vessel: usize, origin: Vector3<f64>) -> Matrix6<f64> {
    let mut sum = Matrix6::zeros();
    let rides = |role: &Role| matches!(role, Role::Carried { vessel: carrier, .. } if *carrier == vessel);
    for (point, at) in model.points.iter().zip(&state.points) {
        if !rides(&point.role) {
            continue;
        }
        let own = point.own.as_ref().map(|own| own.at(at.position.z));
        let [weight, slope] = own.map_or([0.0; 2], |own| [own.weight, own.weight_slope]);
        let force = point.load_at(state.time) - weight * Vector3::z();
        let arm = at.position - origin;
        for axis in 0..6 {
            let motion = Motion::along(axis);
            let swing = motion.spin.cross(&arm);
            let change = -slope * (motion.shift + swing).z * Vector3::z();
            let turning = arm.cross(&change) + swing.cross(&force);
            let mut column = sum.column_mut(axis);
            column.fixed_rows_mut::<3>(0).sub_assign(change);
            column.fixed_rows_mut::<3>(3).sub_assign(turning);
        }
    }
    sum
}

/// One of the six motions of a vessel, of unit size.
struct Motion {
    /// Displacement of the origin [m].
    shift: Vector3<f64>,
    /// Rotation [rad].
    spin: Vector3<f64>,
}

impl Motion {
    fn along(axis: usize) -> Motion {
        let unit = |axis: usize| Vector3::from_fn(|i, _| f64::from(u8::from(i == axis)));
        match axis.checked_sub(3) {
            None => Motion {
                shift: unit(axis),
                spin: Vector3::zeros(),
            },
            Some(about) => Motion {
                shift: Vector3::zeros(),
                spin: unit(about),
            },
        }
    }
}

/// A clamp on the vessel, and how the energy of its joint changes.
struct Clamp {
    /// Direction d from end A to end B [-].
    direction: Vector3<f64>,
    /// Slope g of the energy with the direction [N m].
    slope: Vector3<f64>,
    /// Second derivatives with the direction and the end's segment.
    hessian: Hessian,
    /// The end it holds.
    stands: End,
}

impl Clamp {
    /// Of an end of a line; `None` where that is pinned.
    fn new(line: &Line, state: &State, index: usize, end: End) -> Option<Clamp> {
        let bending = line.bending.as_ref()?;
        let (node, at) = (line.end_node(end), line.ends[usize::from(end == End::B)]);
        let direction = line.clamp(end, &state.points[at])?;
        let position = &state.lines[index].position;
        let from = node.saturating_sub(usize::from(end == End::B));
        let chord = position[from + 1] - position[from];
        let segment = Direction {
            along: chord.try_normalize(0.0)?,
            per_length: 1.0 / chord.norm(),
        };
        // a direction of unit length, free to change
        let held = Direction {
            along: direction,
            per_length: 1.0,
        };
        let turn = match end {
            End::A => Turn::new(held, segment),
            End::B => Turn::new(segment, held),
        };
        let (stiffness, rest) = (bending.joint[node], bending.rest[node]);
        Some(Clamp {
            direction,
            slope: turn.energy(stiffness, rest).slope[usize::from(end == End::B)],
            hessian: turn.hessian(stiffness, rest),
            stands: end,
        })
    }

    /// Change of the slope of the energy with the segment for a turn ω of the clamp alone [N].
    fn push(&self, spin: &Vector3<f64>) -> Vector3<f64> {
        let turned = spin.cross(&self.direction);
        match self.stands {
            End::A => self.hessian.mixed.tr_mul(&turned),
            End::B => self.hessian.mixed * turned,
        }
    }

    /// −δm [N m] for a turn ω of the clamp and a change of the segment [m].
    fn moment(&self, spin: &Vector3<f64>, growth: Vector3<f64>) -> Vector3<f64> {
        let turned = spin.cross(&self.direction);
        let slope = match self.stands {
            End::A => self.hessian.product([turned, growth])[0],
            End::B => self.hessian.product([growth, turned])[1],
        };
        turned.cross(&self.slope) + self.direction.cross(&slope)
    }
}

/// One network and the vessel that moves its ends.
struct Problem<'a> {
    model: &'a Model,
    number: usize,
    network: &'a Network,
    state: &'a State,
    vessel: usize,
    origin: Vector3<f64>,
}

impl Problem<'_> {
    /// Ends of the network's lines on the vessel.
    fn ends(&self) -> impl Iterator<Item = (usize, End)> + '_ {
        let lines = self.network.lines.iter();
        let both = lines.flat_map(|&line| [(line, End::A), (line, End::B)]);
        both.filter(|&(line, end)| self.rides(self.point(line, end)))
    }

    fn point(&self, line: usize, end: End) -> usize {
        self.model.lines[line].ends[usize::from(end == End::B)]
    }

    fn rides(&self, point: usize) -> bool {
        self.model.moves_with(point, Body::Vessel(self.vessel))
    }

    fn arm(&self, point: usize) -> Vector3<f64> {
        self.state.points[point].position - self.origin
    }

    /// Displacement of a point with the vessel [m]; zero where it is not on it.
    fn moved(&self, point: usize, motion: &Motion) -> Vector3<f64> {
        if self.rides(point) {
            motion.shift + motion.spin.cross(&self.arm(point))
        } else {
            Vector3::zeros()
        }
    }

    fn on_catenaries(&self) -> bool {
        let mut lines = self.network.lines.iter();
        lines.all(|&line| self.state.lines[line].closed_form.is_some())
    }

    /// −δ of force and moment of one end, from its residual R and the change of that [N].
    fn at_origin(
        &self,
        point: usize,
        motion: &Motion,
        residual: Vector3<f64>,
        change: Vector3<f64>,
    ) -> Vector6<f64> {
        let arm = self.arm(point);
        let moment = arm.cross(&change) + motion.spin.cross(&arm).cross(&residual);
        joined(change, moment)
    }

    fn of_catenaries(&self, work: &mut Workspace) -> Option<Matrix6<f64>> {
        let (model, number) = (self.model, self.number);
        let hung = catenary_network::hung(model, number, self.state, work)?;
        let mut stiffness = Matrix6::zeros();
        for axis in 0..6 {
            let motion = Motion::along(axis);
            let held = |point: usize| self.moved(point, &motion);
            let column: Vector6<f64> = match hung.respond(model, number, held, work) {
                Some(moved) => self.catenary_column(&hung, &motion, &moved),
                None => return None,
            };
            stiffness.set_column(axis, &column);
        }
        Some(stiffness)
    }

    fn catenary_column(
        &self,
        hung: &HungNetwork,
        motion: &Motion,
        moved: &[[Vector3<f64>; 2]],
    ) -> Vector6<f64> {
        let lines = self.network.lines.iter().zip(&hung.lines).zip(moved);
        let mut column = Vector6::zeros();
        for ((&line, hung), moved) in lines {
            for (end, (row, force)) in [End::A, End::B]
                .into_iter()
                .zip(hung.stiffness.iter().zip(&hung.end_force))
            {
                let point = self.point(line, end);
                if self.rides(point) {
                    let change = row[0] * moved[0] + row[1] * moved[1];
                    column += self.at_origin(point, motion, -force, change);
                }
            }
        }
        column
    }

    /// From the elements, with springs of a `part` of their greatest axial stiffness [-] on every unknown.
    fn of_elements(&self, part: f64, work: &mut Workspace) -> Option<Matrix6<f64>> {
        let lines = || self.network.lines.iter().map(|&line| &self.model.lines[line]);
        let springs = lines().flat_map(|line| {
            let segments = &line.segments;
            let axial = segments.axial_stiffness.iter().zip(&segments.length);
            axial.map(|(ea, length)| ea / length)
        });
        let case = StaticCase {
            anchoring: part * springs.fold(0.0, f64::max),
            bends: lines().any(|line| line.bending.is_some()),
            limit: friction::SLIDING,
            ..StaticCase::whole(self.state.time)
        };
        work.assemble_static(self.model, self.network, self.state, &case);
        let at_rest = |(line, end): (usize, End)| {
            let node = self.model.lines[line].end_node(end);
            work.lines[line].residual[node]
        };
        let residuals: Vec<Vector3<f64>> = self.ends().map(at_rest).collect();
        for &point in &self.network.free_points {
            work.points[point].residual = Vector3::zeros();
        }
        let mut stiffness = Matrix6::zeros();
        for axis in 0..6 {
            let column = self.element_column(&Motion::along(axis), &residuals, work)?;
            stiffness.set_column(axis, &column);
        }
        Some(stiffness)
    }

    fn element_column(
        &self,
        motion: &Motion,
        residuals: &[Vector3<f64>],
        work: &mut Workspace,
    ) -> Option<Vector6<f64>> {
        for &index in &self.network.lines {
            let line = &self.model.lines[index];
            let mut moved = vec![Vector3::zeros(); line.segment_count() + 1];
            for (end, point) in [End::A, End::B].into_iter().zip(line.ends) {
                moved[line.end_node(end)] = self.moved(point, motion);
            }
            let mut right = product(&work.lines[index], &moved);
            for clamp in self.clamps(index) {
                clamp.add_push(&motion.spin, &mut right);
            }
            work.lines[index].residual.copy_from_slice(&right);
        }
        if !work.solve(self.model, self.network, self.number) {
            return None;
        }
        let mut column = Vector6::zeros();
        for ((index, end), residual) in self.ends().zip(residuals) {
            let (line, line_work) = (&self.model.lines[index], &work.lines[index]);
            let mut moved: Vec<Vector3<f64>> = line_work.solution().iter().map(|x| -x).collect();
            for (end, point) in [End::A, End::B].into_iter().zip(line.ends) {
                moved[line.end_node(end)] += self.moved(point, motion);
            }
            let mut change = product(line_work, &moved);
            for clamp in self.clamps(index) {
                clamp.add_push(&motion.spin, &mut change);
            }
            let (node, point) = (line.end_node(end), self.point(index, end));
            column += self.at_origin(point, motion, *residual, change[node]);
            if let Some(clamp) = Clamp::new(line, self.state, index, end) {
                let from = node.saturating_sub(usize::from(end == End::B));
                let moment = clamp.moment(&motion.spin, moved[from + 1] - moved[from]);
                column += joined(Vector3::zeros(), moment);
            }
        }
        Some(column)
    }

    /// Clamps of a line on the vessel.
    fn clamps(&self, index: usize) -> impl Iterator<Item = Clamp> + '_ {
        let aboard = move |&end: &End| self.rides(self.point(index, end));
        let ends = [End::A, End::B].into_iter().filter(aboard);
        let line = &self.model.lines[index];
        ends.filter_map(move |end| Clamp::new(line, self.state, index, end))
    }
}

impl Clamp {
    /// Adds c of the clamp's turn to the change of a line's residual.
    fn add_push(&self, spin: &Vector3<f64>, change: &mut [Vector3<f64>]) {
        let (push, last) = (self.push(spin), change.len() - 1);
        let (lower, upper) = match self.stands {
            End::A => (0, 1),
            End::B => (last - 1, last),
        };
        change[lower] -= push;
        change[upper] += push;
    }
}

/// J of a line, as last assembled, times a motion of its nodes [N].
fn product(line: &LineWork, moved: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let own = line.diagonal.iter().zip(moved);
    let mut sum: Vec<Vector3<f64>> = own.map(|(block, x)| block * x).collect();
    let mut couple = |row: usize, column: usize, block: &Matrix3<f64>| {
        sum[row] += block * moved[column];
        sum[column] += block.tr_mul(&moved[row]);
    };
    for (i, block) in line.coupling.iter().enumerate() {
        couple(i, i + 1, block);
    }
    if let Some(bending) = line.bending.as_ref().filter(|bending| bending.active) {
        for (i, block) in bending.near.iter().enumerate() {
            couple(i, i + 1, block);
        }
        for (i, block) in bending.far.iter().enumerate() {
            couple(i, i + 2, block);
        }
    }
    sum
}

fn joined(force: Vector3<f64>, moment: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}
