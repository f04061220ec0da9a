//! Static equilibrium of lines that meet at free points, each line one closed-form elastic catenary.
//!
//! The unknowns are the positions of the free points along their free axes. The residual at a point is
//!
//!   R = Σ F_line + F_load(t) − w ẑ,
//!
//! with w the weight less the buoyancy of the submerged part and F the end force of a catenary, which lies in the vertical plane through its ends. R
//! = 0 is solved by Newton's method. The stiffness of a line in free flight is exact (see [`catenary::in_flight`]), that of a line on the seabed is a
//! difference quotient of its closed form; across its plane a line has H/X. Steps are limited, and cut until the power R·δ does not change sign:
//! without friction the potential energy is convex in the positions of the points, so this finds the unique equilibrium. A point whose lines can
//! touch the seabed rests on it where it would otherwise sink.
//!
//! Valid for engineering strain, for which the closed form is derived, and where no end lies under the seabed. A line's friction on the seabed is
//! that of [`super::catenary`]: towards end A, as hauled at B, or the reverse. If it leaves no tension at a point on the seabed, any position of the
//! point within a range is an equilibrium, and the point keeps its position.
//!
//! Source: energy and convexity as for cables under gravity, Irvine (1981), Cable Structures, chapter 2; the rest is derived here.

use nalgebra::{Matrix2, Matrix3, Vector3};

use super::catenary::{self, Catenary};
use super::guess::{self, Plane};
use super::{StaticsError, equilibrium};
use crate::elements::{Workspace, free_points, place_ends};
use crate::math::block_banded::Pivots;
use crate::model::{ClosedForm, FreePoint, Line, Model, Network, PointState, State};

/// Accepted out-of-balance force, relative to the largest force [-].
const FORCE_TOLERANCE: f64 = 1e-12;
/// Maximum number of linear solves for one equilibrium.
const NEWTON_SOLVES_MAX: usize = 60;
/// Maximum number of cuts of one step.
const CUTS_MAX: usize = 12;
/// Maximum step, relative to the longest line [-].
const STEP_MAX: f64 = 0.2;
/// Power of opposite sign that a step may end with, relative to the power at its start [-].
const TURNED_MAX: f64 = 0.5;
/// Maximum and minimum stiffness that is added to every unknown, relative to forces per line length [-].
const RELAXATION: [f64; 2] = [1.0, 1e-13];
/// Displacement of the difference quotients, relative to the line length [-].
const DIFFERENCE: f64 = 1e-9;

/// Returns whether every line of a network has a closed form and no part of the network has drag in a current.
pub fn serves(model: &Model, network: &Network) -> bool {
    let mut lines = model.lines_of(network);
    let points = network.free_points.iter();
    let mut spheres = points.filter_map(|&point| model.points[point].free()?.sphere.as_ref());
    if model.current.is_some() && spheres.any(|sphere| sphere.drag > 0.0) {
        return false;
    }
    lines.all(|line| !line.bends() && !line.drifts(model) && line.has_catenary(model))
}

/// Finds the equilibrium like [`equilibrium::rest`], on closed-form catenaries where that is possible. A network
/// whose free points have no equilibrium on these is brought to rest on its elements first.
///
/// # Errors
/// Fails if no equilibrium is found, or none exists.
pub fn rest(
    model: &Model,
    number: usize,
    state: &mut State,
    work: &mut Workspace,
) -> Result<(), StaticsError> {
    let time = state.time;
    if !solve_network(model, number, state, time, work) {
        equilibrium::rest(model, number, state, work)?;
        solve_network(model, number, state, time, work);
    }
    Ok(())
}

/// Moves the free points of a network from their positions in `state` to those at rest at time `t` [s], and puts its lines on their catenaries. Held
/// points do not move. Returns false, with the state unchanged, if a line has no closed form, comes out of the water or has an end under the seabed,
/// or if no equilibrium is found in a bounded number of steps.
pub fn solve_network(model: &Model, number: usize, state: &mut State, t: f64, work: &mut Workspace) -> bool {
    let network = &model.networks[number];
    if !serves(model, network) {
        return false;
    }
    for &index in &network.free_points {
        work.points[index].before = state.points[index];
    }
    let problem = Problem::new(model, number, t);
    if !problem.newton(state, work) || problem.is_pierced(state, work) {
        for &index in &network.free_points {
            state.points[index] = work.points[index].before;
        }
        return false;
    }
    for &index in &network.lines {
        if let Some(solved) = &work.catenaries[index] {
            draw(&model.lines[index], solved, state, index);
        }
    }
    place_ends(model, network, state);
    true
}

/// Finds the catenaries of a network between the present positions of its points, with their stiffness, and solves the system of its free points,
/// ready for other right-hand sides. Returns false if a line has no catenary or the points are not stable.
pub(crate) fn linearise(model: &Model, number: usize, state: &State, work: &mut Workspace) -> bool {
    let problem = Problem::new(model, number, state.time);
    if !(serves(model, problem.network) && problem.evaluate(state, work)) {
        return false;
    }
    problem.assemble(state, work, 0.0);
    work.systems[number].solve(Pivots::Positive)
}

/// Sets the nodes and the closed-form tensions of a line at rest from its catenary.
fn draw(line: &Line, solved: &Catenary, state: &mut State, index: usize) {
    let plane = Plane::new(line.ends.map(|point| state.points[point].position));
    let shape = &mut state.lines[index];
    let closed_form = shape.closed_form.get_or_insert_with(ClosedForm::default);
    closed_form.tension.resize(line.nodes.arc.len(), 0.0);
    closed_form.horizontal.resize(line.nodes.arc.len(), 0.0);
    for (i, &s) in line.nodes.arc.iter().enumerate() {
        let point = solved.at(s);
        shape.position[i] = plane.place(&point);
        (closed_form.tension[i], closed_form.horizontal[i]) = (point.tension, point.horizontal);
    }
    let last = closed_form.tension.len() - 1;
    (closed_form.tension[0], closed_form.tension[last]) = (solved.tension_a(), solved.tension_b());
    closed_form.end_force = plane.end_forces(solved);
    closed_form.laid_length = solved.laid_length() + 0.0; // an empty sum is −0
    closed_form.stretched_length = solved.stretched_length();
    closed_form.sag = solved.sag();
    let energy = solved.energy();
    let weights = line.sections.iter();
    let weight: f64 = weights.map(|section| section.weight * section.length).sum();
    closed_form.axial_energy = energy.axial;
    closed_form.gravitational_energy = energy.gravitational + weight * plane.a.z;
    shape.velocity.fill(Vector3::zeros());
    shape.acceleration.fill(Vector3::zeros());
}

/// Slopes of the end forces H_A, V_A, H_B, V_B [N/m].
struct Slopes {
    by_span: [f64; 4],
    by_height_a: [f64; 4],
    by_height_b: [f64; 4],
}

impl Slopes {
    /// Slopes of a line in free flight.
    fn in_flight(stiffness: &Matrix2<f64>) -> Slopes {
        let both = |column: usize| {
            let [h, v] = [stiffness[(0, column)], stiffness[(1, column)]];
            [h, v, h, v]
        };
        Slopes {
            by_span: both(0),
            by_height_a: both(1).map(|slope| -slope),
            by_height_b: both(1),
        }
    }

    /// −∂F/∂r of the forces on A and B with respect to the positions of A and B [N/m]; `pulls` are the horizontal tensions [N].
    fn stiffness(&self, plane: &Plane, pulls: [f64; 2], length: f64) -> [[Matrix3<f64>; 2]; 2] {
        let (e, z) = (plane.along, Vector3::z());
        let sideways = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0)) - e * e.transpose();
        let row = |end: usize| {
            let vector = |slopes: &[f64; 4]| slopes[2 * end] * e + slopes[2 * end + 1] * z;
            // H/X tends to the slope where the span vanishes
            let swing = if plane.span > DIFFERENCE * length {
                pulls[end] / plane.span
            } else {
                self.by_span[2 * end]
            };
            let by_b = vector(&self.by_span) * e.transpose() + swing * sideways;
            let sign = if end == 0 { -1.0 } else { 1.0 };
            [
                sign * (vector(&self.by_height_a) * z.transpose() - by_b),
                sign * (vector(&self.by_height_b) * z.transpose() + by_b),
            ]
        };
        [row(0), row(1)]
    }
}

/// Equilibrium of one network at one time.
struct Problem<'a> {
    model: &'a Model,
    network: &'a Network,
    number: usize,
    time: f64,
    /// Sum of weights and loads [N], or 1 N without any.
    force: f64,
    /// Length of the longest line [m].
    length: f64,
}

impl<'a> Problem<'a> {
    fn new(model: &'a Model, number: usize, time: f64) -> Problem<'a> {
        let network = &model.networks[number];
        let lines = model.lines_of(network);
        let sections = lines.clone().flat_map(|line| &line.sections);
        let weights = sections.map(|section| (section.weight * section.length).abs());
        let mut force: f64 = weights.sum();
        for (index, free) in free_points(model, network) {
            force += free.weight_max() + model.points[index].load_at(time).norm();
        }
        Problem {
            model,
            network,
            number,
            time,
            force: if force > 0.0 { force } else { 1.0 },
            length: lines.map(Line::unstretched_length).fold(0.0, f64::max),
        }
    }

    fn newton(&self, state: &mut State, work: &mut Workspace) -> bool {
        for &index in &self.network.free_points {
            let point = &mut state.points[index];
            *point = PointState::at_rest(point.position);
            point.position.z = point.position.z.max(self.seabed_under(index));
        }
        if !self.evaluate(state, work) {
            return false;
        }
        let [mut relaxation, least] = RELAXATION;
        for _ in 0..NEWTON_SOLVES_MAX {
            let residual = self.greatest_residual(work);
            let tolerance = FORCE_TOLERANCE * self.greatest_force(work);
            if residual <= tolerance {
                return true;
            }
            let (stiffest, farthest) = self.assemble(state, work, relaxation * self.force / self.length);
            if residual <= tolerance + 4.0 * f64::EPSILON * stiffest * farthest {
                return true;
            }
            let whole = work.systems[self.number].solve(Pivots::Positive) && self.step(state, work);
            let [most, _] = RELAXATION;
            relaxation = if whole {
                (1e-3 * relaxation).max(least)
            } else {
                (10.0 * relaxation).min(most)
            };
        }
        false
    }

    /// Evaluates the catenaries of all lines and the residuals at all points; returns false if a line has no catenary.
    fn evaluate(&self, state: &State, work: &mut Workspace) -> bool {
        for (index, free) in free_points(self.model, self.network) {
            let weight = free.at(state.points[index].position.z).weight;
            let own = self.model.points[index].load_at(self.time) - weight * Vector3::z();
            work.points[index].residual = own;
        }
        for &index in &self.network.lines {
            let line = &self.model.lines[index];
            let plane = Plane::new(line.ends.map(|point| state.points[point].position));
            work.counters.solves += 1;
            let Some(solved) = guess::closed_form(self.model, line, &plane) else {
                return false;
            };
            for (point, force) in line.ends.into_iter().zip(plane.end_forces(&solved)) {
                if work.points[point].slot.is_some() {
                    work.points[point].residual += force;
                }
            }
            work.catenaries[index] = Some(solved);
        }
        for (index, free) in free_points(self.model, self.network) {
            let held = self.held(state, work, index, free);
            let point = &mut work.points[index];
            let moved = |axis: usize, _| if held[axis] { 0.0 } else { point.residual[axis] };
            point.total = Vector3::from_fn(moved);
        }
        true
    }

    /// Level z below which a point that moves vertically does not sink [m].
    fn seabed_under(&self, point: usize) -> f64 {
        let point = &self.model.points[point];
        let Some(free) = point.free().filter(|free| free.axes[2]) else {
            return f64::NEG_INFINITY;
        };
        let own = free.contact.map(|contact| contact.seabed_level);
        let lines = point.attached.iter().map(|(line, _)| &self.model.lines[*line]);
        lines
            .filter_map(|line| Some(line.nodes.contact.as_ref()?.seabed_level))
            .chain(own)
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns for each axis whether a free point cannot move along it: not free there, or pressed on the seabed.
    fn held(&self, state: &State, work: &Workspace, point: usize, free: &FreePoint) -> [bool; 3] {
        let pressed = work.points[point].residual.z <= 0.0
            && state.points[point].position.z <= self.seabed_under(point);
        let [x, y, z] = free.axes;
        [!x, !y, !z || pressed]
    }

    /// Sets up the stiffness of the lines and the linear system; returns the largest stiffness [N/m] and the largest coordinate of a point [m].
    fn assemble(&self, state: &State, work: &mut Workspace, anchoring: f64) -> (f64, f64) {
        work.systems[self.number].clear();
        let (mut stiffest, mut farthest) = (0.0_f64, 0.0_f64);
        for &index in &self.network.lines {
            let ends = self.model.lines[index].ends;
            work.stiffness[index] = self.line_stiffness(state, work, index);
            for (end, row) in ends.into_iter().zip(&work.stiffness[index]) {
                farthest = farthest.max(state.points[end].position.amax());
                for (other, block) in ends.into_iter().zip(row) {
                    if let (Some(row), Some(column)) = (work.points[end].slot, work.points[other].slot) {
                        work.systems[self.number].add_block(row, column, block);
                        stiffest = stiffest.max(block.amax());
                    }
                }
            }
        }
        let anchoring = Matrix3::from_diagonal_element(anchoring + 8.0 * f64::EPSILON * stiffest);
        for (slot, (index, free)) in free_points(self.model, self.network).enumerate() {
            let heave = free.at(state.points[index].position.z).weight_slope;
            let heave = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, heave));
            let held = self.held(state, work, index, free);
            let system = &mut work.systems[self.number];
            system.add_block(slot, slot, &anchoring);
            system.add_block(slot, slot, &heave);
            system.add_right(slot, work.points[index].total);
            for axis in (0..3).filter(|&axis| held[axis]) {
                system.hold(slot, axis);
            }
        }
        (stiffest, farthest)
    }

    /// −∂F/∂r of the forces on A and B with respect to the positions of A and B [N/m].
    fn line_stiffness(&self, state: &State, work: &mut Workspace, index: usize) -> [[Matrix3<f64>; 2]; 2] {
        let line = &self.model.lines[index];
        let Some(solved) = &work.catenaries[index] else {
            return [[Matrix3::zeros(); 2]; 2];
        };
        let ends = line.ends.map(|point| state.points[point].position);
        let (plane, length) = (Plane::new(ends), line.unstretched_length());
        let slopes = if solved.laid().next().is_none() {
            Slopes::in_flight(&catenary::in_flight(&line.sections, solved))
        } else {
            work.counters.solves += 3;
            let step = DIFFERENCE * length.max(ends[0].amax()).max(ends[1].amax());
            self.slopes_on_seabed(line, solved, &plane, step)
        };
        let pulls = [solved.horizontal_a(), solved.horizontal()];
        slopes.stiffness(&plane, pulls, length)
    }

    /// Slopes of a line that touches the seabed, by difference quotients over a `step` [m].
    fn slopes_on_seabed(&self, line: &Line, solved: &Catenary, plane: &Plane, step: f64) -> Slopes {
        let forces = |c: &Catenary| [c.horizontal_a(), c.vertical_a(), c.horizontal(), c.vertical_b()];
        let base = forces(solved);
        let slope = |span: f64, up_a: f64, up_b: f64| {
            let moved = Plane {
                a: plane.a + up_a * Vector3::z(),
                along: plane.along,
                span: plane.span + span,
                rise: plane.rise + up_b - up_a,
            };
            let moved = guess::closed_form(self.model, line, &moved);
            let moved = moved.map_or(base, |moved| forces(&moved));
            std::array::from_fn(|i| (moved[i] - base[i]) / step)
        };
        Slopes {
            by_span: slope(step, 0.0, 0.0),
            by_height_a: slope(0.0, step, 0.0),
            by_height_b: slope(0.0, 0.0, step),
        }
    }

    /// Returns whether a line on its catenary comes out of the water, which the closed form does not model.
    fn is_pierced(&self, state: &State, work: &Workspace) -> bool {
        self.network.lines.iter().any(|&index| {
            let (line, solved) = (&self.model.lines[index], work.catenaries[index].as_ref());
            let a = state.points[line.ends[0]].position;
            solved.is_some_and(|solved| guess::is_pierced(line, solved, a))
        })
    }

    /// Moves the free points along the solution, as far as the power does not change sign; returns whether that was the whole step.
    fn step(&self, state: &mut State, work: &mut Workspace) -> bool {
        let (mut longest, mut before, balance) = (0.0_f64, 0.0, self.greatest_residual(work));
        for (slot, &index) in self.network.free_points.iter().enumerate() {
            let point = &mut work.points[index];
            point.solution = work.systems[self.number].solution(slot);
            longest = longest.max(point.solution.norm());
            before += point.solution.dot(&point.total);
            point.start = state.points[index].position;
        }
        if !(longest.is_finite() && before > 0.0) {
            return false;
        }
        let mut part = (STEP_MAX * self.length / longest).min(1.0);
        for _ in 0..CUTS_MAX {
            self.place(state, work, part);
            if !self.evaluate(state, work) {
                self.place(state, work, 0.0);
                self.evaluate(state, work);
                return false;
            }
            let points = self.network.free_points.iter().map(|&index| &work.points[index]);
            let after: f64 = points.map(|point| point.solution.dot(&point.total)).sum();
            if after >= -TURNED_MAX * before || self.greatest_residual(work) <= 0.5 * balance {
                return part == 1.0;
            }
            part *= (before / (before - after)).clamp(0.1, 0.7);
        }
        false
    }

    /// Moves the free points to a `part` of the solution from the start of the step.
    fn place(&self, state: &mut State, work: &Workspace, part: f64) {
        for &index in &self.network.free_points {
            let mut moved = work.points[index].start + part * work.points[index].solution;
            moved.z = moved.z.max(self.seabed_under(index));
            state.points[index].position = moved;
        }
    }

    fn greatest_residual(&self, work: &Workspace) -> f64 {
        let points = self.network.free_points.iter();
        let residuals = points.map(|&index| work.points[index].total.norm());
        residuals.fold(0.0, f64::max)
    }

    /// Largest tension, weight or load [N].
    fn greatest_force(&self, work: &Workspace) -> f64 {
        let lines = self.network.lines.iter();
        let solved = lines.filter_map(|&index| work.catenaries[index].as_ref());
        let tensions = solved.map(|line| line.tension_a().max(line.tension_b()));
        let mut force = tensions.fold(0.0, f64::max);
        for (index, free) in free_points(self.model, self.network) {
            force = force
                .max(free.weight_max())
                .max(self.model.points[index].load_at(self.time).norm());
        }
        force
    }
}
