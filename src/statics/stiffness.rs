//! Stiffness of the mooring on a vessel: the 6×6 slope of its force with the vessel's displacements.
//!
//! The vessel moves by x, y and z [m] and by small rotations about the global axes through its origin [rad]. A point
//! on it at the arm r [m] from the origin follows by u = δ + ω × r, clamps turn by ω × d, and all free nodes and
//! points move to their new equilibrium. With J the exact tangent of the residual R at rest, x the unknowns and c the
//! contribution of the turned clamps to R,
//!
//!   J (u − x) + c = 0 at every node between the ends and every free point,   δR = J (u − x) + c at the ends on the vessel,
//!
//! six solves for the free points. Every line is condensed on its ends: once, or for every motion where one of its clamps turns. The force of the mooring is F = −R and
//! its moment M = Σ r × F + m, so that
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

use nalgebra::{Matrix6, Vector3, Vector6};

use super::catenary_network::{self, HungNetwork};
use crate::elements::{StaticCase, Workspace, friction};
use crate::math::block_banded::{Ends, Pivots};
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
        sum += if lies_on_catenaries(problem.network, state) {
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

/// Scratch for the stiffness on any vessel, at a state.
pub(crate) fn scratch(model: &Model, state: &State) -> Workspace {
    Workspace::serving(model, |number| {
        !lies_on_catenaries(&model.networks[number], state)
    })
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

/// A line condensed on its ends, both of them free.
struct CondensedLine {
    index: usize,
    /// Residual of the ends at rest [N].
    residual: [Vector3<f64>; 2],
    ends: Ends,
    /// Clamps on the vessel.
    clamps: Vec<Clamp>,
}

impl CondensedLine {
    /// Condensed equations with the effect of the turned clamps on the right.
    fn with_turned_clamps(&self, motion: &Motion, work: &mut Workspace) -> Option<Ends> {
        if self.clamps.is_empty() {
            return Some(self.ends);
        }
        let line = &mut work.lines[self.index];
        line.residual.fill(Vector3::zeros());
        for clamp in &self.clamps {
            clamp.add_push(&motion.spin, &mut line.residual);
        }
        line.eliminate(true, Pivots::Positive)
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
        for &point in &self.network.free_points {
            work.points[point].residual = Vector3::zeros();
        }
        let lines = self.network.lines.iter();
        let lines: Option<Vec<_>> = lines.map(|&line| self.condensed(line, work)).collect();
        let lines = lines?;
        let mut stiffness = Matrix6::zeros();
        for axis in 0..6 {
            stiffness.set_column(axis, &self.element_column(&Motion::along(axis), &lines, work)?);
        }
        Some(stiffness)
    }

    /// A line condensed on its ends, after an assembly.
    fn condensed(&self, index: usize, work: &mut Workspace) -> Option<CondensedLine> {
        let (line, line_work) = (&self.model.lines[index], &mut work.lines[index]);
        let residual = [End::A, End::B].map(|end| line_work.residual[line.end_node(end)]);
        line_work.residual.fill(Vector3::zeros());
        Some(CondensedLine {
            index,
            residual,
            ends: line_work.eliminate(true, Pivots::Positive)?,
            clamps: self.clamps(index).collect(),
        })
    }

    fn element_column(
        &self,
        motion: &Motion,
        lines: &[CondensedLine],
        work: &mut Workspace,
    ) -> Option<Vector6<f64>> {
        work.systems[self.number].clear();
        let mut moved = Vec::with_capacity(lines.len());
        for line in lines {
            let [a, b] = self.model.lines[line.index]
                .ends
                .map(|point| self.moved(point, motion));
            let ends = line.with_turned_clamps(motion, work)?;
            let ends = Ends {
                a: ends.a + ends.aa * a + ends.ab * b,
                b: ends.b + ends.ba * a + ends.bb * b,
                ..ends
            };
            work.add_condensed(self.model, self.number, line.index, &ends);
            moved.push((ends, [a, b]));
        }
        if !work.solve_points(self.model, self.number, Pivots::Positive) {
            return None;
        }
        let lines = lines.iter().zip(moved);
        Some(
            lines
                .map(|(line, moved)| self.of_line(line, motion, moved, work))
                .sum(),
        )
    }

    /// −δ of force and moment of one line, from its condensed equations with the motion of its ends [m] on the right.
    fn of_line(
        &self,
        line: &CondensedLine,
        motion: &Motion,
        (ends, moved): (Ends, [Vector3<f64>; 2]),
        work: &mut Workspace,
    ) -> Vector6<f64> {
        let points = self.model.lines[line.index].ends;
        let [a, b] = points.map(|point| work.solution_at(point));
        let change = [
            ends.a - ends.aa * a - ends.ab * b,
            ends.b - ends.ba * a - ends.bb * b,
        ];
        let mut sum = Vector6::zeros();
        for (side, point) in points
            .into_iter()
            .enumerate()
            .filter(|(_, point)| self.rides(*point))
        {
            sum += self.at_origin(point, motion, line.residual[side], change[side]);
        }
        if !line.clamps.is_empty() {
            work.lines[line.index].substitute(a - moved[0], b - moved[1]);
        }
        let solution = work.lines[line.index].solution();
        for clamp in &line.clamps {
            let from = match clamp.stands {
                End::A => 0,
                End::B => solution.len() - 2,
            };
            let moment = clamp.moment(&motion.spin, solution[from] - solution[from + 1]);
            sum += joined(Vector3::zeros(), moment);
        }
        sum
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

fn joined(force: Vector3<f64>, moment: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}
