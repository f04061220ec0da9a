//! Stiffness of the mooring on a vessel: the 6×6 slope of its force with respect to the displacements of the vessel.
//!
//! The vessel moves by x, y and z [m] and by small rotations about the global axes through its origin [rad]. A point on it at the arm r [m] from the
//! origin moves by u = δ + ω × r, clamps turn by ω × d, and all free nodes and points move to their new equilibrium. With J the exact tangent of the
//! residual R at rest, x the unknowns and c the contribution of the turned clamps to R,
//!
//!   J (u − x) + c = 0 at every node between the ends and every free point,   δR = J (u − x) + c at the ends on the vessel,
//!
//! which takes six solves for the free points. Every line is condensed on its ends once; a turning clamp adds a right-hand side. The force of the
//! mooring is F = −R and its moment M = Σ r × F + m, so that
//!
//!   K δ = −δF = Σ δR,   −δM = Σ r × δR + (ω × r) × R − δm,
//!
//! where the second term arises because the arms rotate. The moment on a clamp of direction d is m = −d × g with g the slope of the energy of its
//! joint with respect to d, and −δm = (ω × d) × g + d × δg.
//!
//! In a network whose lines lie on closed-form catenaries, the stiffness of the catenaries, including seabed friction, replaces J. Other networks
//! have the stiffness of their elements: springs, weight, bending and the springs of the seabed; nodes that stick to it are held by friction, and
//! sliding nodes continue to slide. Drag, inertia and dampers are not included. Without friction the mooring is conservative: the parts of K that
//! concern displacements are symmetric, and K − Kᵀ of the rotations is ω ↦ M × ω, since finite rotations do not commute.
//!
//! Source: derived here. Valid where the equilibrium is stable. A line that lies slack on the seabed has no lateral
//! stiffness; anchoring springs of 10⁻¹⁵ to 10⁻⁹ of its axial stiffness then keep it in place. Beams have
//! no tangent here.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::catenary_network;
use crate::elements::{StaticCase, Workspace, friction};
use crate::math::block_banded::Pivots;
use crate::model::{Body, End, Line, Model, Network, State};
use crate::physics::bending::{Direction, Hessian, Turn};

/// Springs on every unknown, relative to the largest axial stiffness of a segment [-]; each is tried if the previous one did not suffice.
const ANCHORING: [f64; 4] = [0.0, 1e-15, 1e-12, 1e-9];

/// Negative slope of the force [N/m, N] and moment [N, N m] of the mooring on a vessel, about its `origin` [m], with respect to displacements along
/// and rotations about the global axes. `None` if the present state is not stable, a beam is attached, or a line is released from a point.
pub fn of_vessel(
    model: &Model,
    state: &State,
    vessel: usize,
    origin: Vector3<f64>,
    work: &mut Workspace,
) -> Option<Matrix6<f64>> {
    let mut sum = of_own_weights(model, state, vessel, origin);
    for &number in &model.vessels[vessel].networks {
        let problem = Problem {
            model,
            number,
            network: &model.networks[number],
            state,
            vessel,
            origin,
        };
        let released = |&line: &usize| state.lines[line].released != [false; 2];
        if model.beam_of(number).is_some() || problem.network.lines.iter().any(released) {
            return None;
        }
        work.serve(model, number);
        let lines = match lies_on_catenaries(problem.network, state) {
            true => problem.of_catenaries(work),
            false => ANCHORING.iter().find_map(|&part| problem.of_elements(part, work)),
        }?;
        let columns = Motion::ALL.map(|axis| problem.column(&lines, &Motion::along(axis), work));
        sum += Matrix6::from_columns(&columns);
        work.release(model, number);
    }
    Some(sum)
}

/// The same for the points that move with the vessel: their loads, and their weight less buoyancy.
fn of_own_weights(model: &Model, state: &State, vessel: usize, origin: Vector3<f64>) -> Matrix6<f64> {
    let mut sum = Matrix6::zeros();
    for &index in &model.vessels[vessel].points {
        let (point, at) = (&model.points[index], &state.points[index]);
        let own = point.own.as_ref().map(|own| own.at(at.position.z));
        let [weight, slope] = own.map_or([0.0; 2], |own| [own.weight, own.weight_slope]);
        let force = point.load_at(state.time) - weight * Vector3::z();
        let arm = at.position - origin;
        sum -= Matrix6::from_columns(&Motion::ALL.map(|axis| {
            let motion = Motion::along(axis);
            let change = -slope * motion.of(arm).z * Vector3::z();
            motion.at_origin(arm, force, change)
        }));
    }
    sum
}

/// Returns whether all lines of a network lie on closed-form catenaries.
fn lies_on_catenaries(network: &Network, state: &State) -> bool {
    let mut lines = network.lines.iter();
    lines.all(|&line| state.lines[line].closed_form.is_some())
}

/// One of the six motions of a vessel, of unit size.
struct Motion {
    /// Displacement of the origin [m].
    shift: Vector3<f64>,
    /// Rotation [rad].
    spin: Vector3<f64>,
}

impl Motion {
    const ALL: [usize; 6] = [0, 1, 2, 3, 4, 5];

    fn along(axis: usize) -> Motion {
        let unit = Vector6::ith(axis, 1.0);
        Motion {
            shift: unit.fixed_rows::<3>(0).into(),
            spin: unit.fixed_rows::<3>(3).into(),
        }
    }

    /// Displacement of a point of the vessel at an arm from the origin [m].
    fn of(&self, arm: Vector3<f64>) -> Vector3<f64> {
        self.shift + self.spin.cross(&arm)
    }

    /// Change of force [N] and moment [N m] about the origin, due to the `change` of a `force` at an arm [m].
    fn at_origin(&self, arm: Vector3<f64>, force: Vector3<f64>, change: Vector3<f64>) -> Vector6<f64> {
        joined(change, arm.cross(&change) + self.spin.cross(&arm).cross(&force))
    }
}

/// Clamp on the vessel, with the derivatives of the energy of its joint.
struct Clamp {
    /// Direction d from end A to end B [-].
    direction: Vector3<f64>,
    /// Slope g of the energy with respect to the direction [N m].
    slope: Vector3<f64>,
    /// Second derivatives with respect to the direction and the segment at this end.
    hessian: Hessian,
    /// End that it holds, 0 for A and 1 for B.
    side: usize,
    /// Segment at this end.
    segment: usize,
}

impl Clamp {
    /// Clamp of an end of a line; `None` if that end is pinned.
    fn new(line: &Line, state: &State, index: usize, end: End) -> Option<Clamp> {
        let bending = line.bending.as_ref()?;
        let (node, side) = (line.end_node(end), usize::from(end == End::B));
        let direction = line.clamp(end, &state.points[line.ends[side]])?;
        let position = &state.lines[index].position;
        let segment = node - side;
        let chord = position[segment + 1] - position[segment];
        // the clamp is a direction of unit length, free to change
        let mut pair = [Direction {
            along: direction,
            per_length: 1.0,
        }; 2];
        pair[1 - side] = Direction {
            along: chord.try_normalize(0.0)?,
            per_length: 1.0 / chord.norm(),
        };
        let turn = Turn::new(pair[0], pair[1]);
        let (stiffness, rest) = (bending.joint[node], bending.rest[node]);
        Some(Clamp {
            direction,
            slope: turn.energy(stiffness, rest).slope[side],
            hessian: turn.hessian(stiffness, rest),
            side,
            segment,
        })
    }

    /// Changes of the slopes of the energy with respect to the clamp and to the segment, due to changes of the clamp [-] and of the segment [m].
    fn slopes(&self, turned: Vector3<f64>, growth: Vector3<f64>) -> [Vector3<f64>; 2] {
        let mut changes = [growth; 2];
        changes[self.side] = turned;
        let slopes = self.hessian.product(changes);
        [slopes[self.side], slopes[1 - self.side]]
    }

    /// Adds c, for a turn ω of the clamp alone, to the change of a line's residual.
    fn add_push(&self, spin: &Vector3<f64>, change: &mut [Vector3<f64>]) {
        let [_, push] = self.slopes(spin.cross(&self.direction), Vector3::zeros());
        change[self.segment] -= push;
        change[self.segment + 1] += push;
    }

    /// −δm [N m] for a turn ω of the clamp, with the solution at the nodes of the line [m].
    fn moment(&self, spin: &Vector3<f64>, solution: &[Vector3<f64>]) -> Vector3<f64> {
        let turned = spin.cross(&self.direction);
        let growth = solution[self.segment] - solution[self.segment + 1];
        let [slope, _] = self.slopes(turned, growth);
        turned.cross(&self.slope) + self.direction.cross(&slope)
    }
}

/// Line condensed on its ends, both of them free.
struct CondensedLine {
    index: usize,
    /// Residual of the ends at rest [N].
    residual: [Vector3<f64>; 2],
    /// Slopes of the residual with respect to the positions of the ends [N/m].
    stiffness: [[Matrix3<f64>; 2]; 2],
    /// Clamps on the vessel.
    clamps: Vec<Clamp>,
}

impl CondensedLine {
    /// Change of the residual of the ends due to their displacements [m].
    fn change(&self, moved: [Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
        self.stiffness.map(|[a, b]| a * moved[0] + b * moved[1])
    }

    /// Change of the residual of the ends due to the turned clamps [N].
    fn pushed(&self, motion: &Motion, work: &mut Workspace) -> [Vector3<f64>; 2] {
        if self.clamps.is_empty() {
            return [Vector3::zeros(); 2];
        }
        let line = &mut work.lines[self.index];
        line.residual.fill(Vector3::zeros());
        for clamp in &self.clamps {
            clamp.add_push(&motion.spin, &mut line.residual);
        }
        line.eliminate_right()
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
    fn rides(&self, point: usize) -> bool {
        self.model.moves_with(point, Body::Vessel(self.vessel))
    }

    fn arm(&self, point: usize) -> Vector3<f64> {
        self.state.points[point].position - self.origin
    }

    /// Displacement of a point with the vessel [m]; zero if it is not on the vessel.
    fn moved(&self, point: usize, motion: &Motion) -> Vector3<f64> {
        match self.rides(point) {
            true => motion.of(self.arm(point)),
            false => Vector3::zeros(),
        }
    }

    /// Condenses the lines on their catenaries and solves the system of the free points.
    fn of_catenaries(&self, work: &mut Workspace) -> Option<Vec<CondensedLine>> {
        if !catenary_network::linearise(self.model, self.number, self.state, work) {
            return None;
        }
        let condensed = |&index: &usize| {
            let closed_form = self.state.lines[index].closed_form.as_ref()?;
            Some(CondensedLine {
                index,
                residual: closed_form.end_force.map(|force| -force),
                stiffness: work.stiffness[index],
                clamps: Vec::new(),
            })
        };
        self.network.lines.iter().map(condensed).collect()
    }

    /// Condenses the lines on their elements, with springs on every unknown of a `part` of the largest axial stiffness [-], and solves the system of
    /// the free points.
    fn of_elements(&self, part: f64, work: &mut Workspace) -> Option<Vec<CondensedLine>> {
        let mut lines = self.model.lines_of(self.network);
        let springs = lines.clone().flat_map(|line| {
            let segments = &line.segments;
            let axial = segments.axial_stiffness.iter().zip(&segments.length);
            axial.map(|(ea, length)| ea / length)
        });
        let case = StaticCase {
            anchoring: part * springs.fold(0.0, f64::max),
            bends: lines.any(|line| line.bending.is_some()),
            limit: friction::SLIDING,
            ..StaticCase::whole(self.state.time)
        };
        work.assemble_static(self.model, self.network, self.state, &case);
        for &point in &self.network.free_points {
            work.points[point].residual = Vector3::zeros();
        }
        work.systems[self.number].clear();
        let lines = self.network.lines.iter();
        let lines = lines
            .map(|&line| self.condensed(line, work))
            .collect::<Option<_>>()?;
        let solved = work.solve_points(self.model, self.number, Pivots::Positive);
        solved.then_some(lines)
    }

    /// Condenses a line on its ends, after an assembly, and adds it to the system of the free points.
    fn condensed(&self, index: usize, work: &mut Workspace) -> Option<CondensedLine> {
        let (line, line_work) = (&self.model.lines[index], &mut work.lines[index]);
        let residual = [End::A, End::B].map(|end| line_work.residual[line.end_node(end)]);
        line_work.residual.fill(Vector3::zeros());
        let ends = line_work.eliminate(true, Pivots::Positive)?;
        work.add_condensed(self.model, self.number, index, &ends);
        let aboard = [End::A, End::B].into_iter().zip(line.ends);
        let aboard = aboard.filter(|(_, point)| self.rides(*point));
        let clamps = aboard.filter_map(|(end, _)| Clamp::new(line, self.state, index, end));
        Some(CondensedLine {
            index,
            residual,
            stiffness: [[ends.aa, ends.ab], [ends.ba, ends.bb]],
            clamps: clamps.collect(),
        })
    }

    /// −δ of force and moment of the network for a motion of the vessel.
    fn column(&self, lines: &[CondensedLine], motion: &Motion, work: &mut Workspace) -> Vector6<f64> {
        work.systems[self.number].clear_right();
        let mut pushes = Vec::with_capacity(lines.len());
        for line in lines {
            let ends = self.model.lines[line.index].ends;
            let pushed = line.pushed(motion, work);
            let change = line.change(ends.map(|point| self.moved(point, motion)));
            for ((point, pushed), change) in ends.into_iter().zip(pushed).zip(change) {
                if let Some(slot) = work.points[point].slot {
                    work.systems[self.number].add_right(slot, pushed + change);
                }
            }
            pushes.push(pushed);
        }
        work.systems[self.number].solve_again();
        work.take_solution(self.network, self.number);
        let lines = lines.iter().zip(pushes);
        lines
            .map(|(line, pushed)| self.of_line(line, motion, pushed, work))
            .sum()
    }

    /// −δ of force and moment of one line, from the solution at the free points and the change of its residual by turned clamps [N].
    fn of_line(
        &self,
        line: &CondensedLine,
        motion: &Motion,
        pushed: [Vector3<f64>; 2],
        work: &mut Workspace,
    ) -> Vector6<f64> {
        let ends = self.model.lines[line.index].ends;
        let moved = ends.map(|point| self.moved(point, motion) - work.solution_at(point));
        let change = line.change(moved);
        let mut sum = Vector6::zeros();
        for (side, point) in ends.into_iter().enumerate() {
            if self.rides(point) {
                let change = pushed[side] + change[side];
                sum += motion.at_origin(self.arm(point), line.residual[side], change);
            }
        }
        if !line.clamps.is_empty() {
            work.lines[line.index].substitute(-moved[0], -moved[1]);
        }
        for clamp in &line.clamps {
            let moment = clamp.moment(&motion.spin, work.lines[line.index].solution());
            sum += joined(Vector3::zeros(), moment);
        }
        sum
    }
}

fn joined(force: Vector3<f64>, moment: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}
