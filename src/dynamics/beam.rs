//! Energy- and momentum-conserving steps of a geometrically exact beam.
//!
//! From t to t + Δt the state of a node changes from (φ, v, Λ, W) to (φ₁, v₁, Λ₁, W₁): position, velocity, frame, angular velocity along its directors.
//! The unknowns are φ₁ and the Cayley vector θ of the rotation, Λ₁ = cay(θ) Λ; increments of θ follow from spins of Λ₁. They satisfy
//!
//!   M̄ (v₁ − v)/Δt = f̄,            ½(v + v₁) Δt = φ₁ − φ,
//!   (Λ₁J W₁ − ΛJ W)/Δt = m̄,       ½(W + W₁) Δt = Λᵀθ = Λ₁ᵀθ,
//!
//! where f̄ and m̄ are the sums of −L B̄ᵀS̄ of the elements, weight, loads, and the forces of water and seabed. B̄ is the
//! strain gradient at the mean of both ends of the step, and S̄ the mean stress. The strains are bilinear, so that B̄ is a
//! discrete gradient: without water, seabed and damping the energy ½ vᵀM v + ½ W·J W + Σ U + Σ w z changes by the work of
//! the loads alone, and both momenta by their impulses, to rounding.
//!
//! Loads are means over the step, so that an impulse is exact wherever the load jumps. Viscous damping adds D (E₁ − E)/Δt to S̄. Added mass
//! and drag use the tangent in the middle of the step, extrapolated with the angular velocity before it: this is of second order and not part of the
//! slopes. J is the lumped rotary inertia. Prescribed unknowns follow their points.
//!
//! The iteration starts from mean rates extrapolated from the last three steps ([`crate::model::Course`]) and reuses a factorised tangent stiffness
//! while the changes decrease quickly. If it does not converge, it restarts from the velocities before the step, with exact tangent stiffness.
//!
//! Source: Simo, Tarnow & Doblaré (1995), Int. J. Numer. Methods Eng. 38, 1431-1473 (momenta and Cayley update); Romero & Armero (2002), ibid.
//! 54, 1683-1716, and Betsch & Steinmann (2003), Multibody Syst. Dyn. 8, 367-391 (directors, discrete gradient). Valid for rotations below half a
//! turn per step.

mod body;
mod drive;
mod measures;
mod nodes;

use nalgebra::{Matrix3, Vector3};

use super::energy_balance::Flow;
use crate::elements::beam::{BeamEnd, FourElements, add_elements, add_lift, add_rise, folded};
use crate::math::lanes::LANES;
use crate::math::pivoted_chain::PivotedChain;
use crate::math::rotation::{cayley, cayley_vector};
use crate::math::unit::VectorUnit;
use crate::model::{Beam, LineState, Nodes};
use crate::physics::contact_step::{ContactStep, contact_step};
use crate::physics::fading_damper::damper_reach;
use crate::physics::morison::{DragCoefficients, drag, drag_slope};
use crate::physics::seabed::{PARTS, Part};
use crate::physics::section::{
    Mixture, Section, Sextuple, Station, StrainGradient, corrected, join, split, strain,
};
use crate::physics::slender::Slender;

pub use body::Body;
pub use drive::{Driven, attitude, drive, held};
pub use measures::{BeamView, Momentum};
use nodes::FourNodes;

/// Change of position relative to the beam's length, and change of θ, at which the iteration has converged [-].
const TOLERANCE: f64 = 1e-12;
/// Negligible sum of all further changes with the same tangent stiffness [-].
const REMAINDER: f64 = 0.01 * TOLERANCE;
/// Change below which a change that no longer decreases is rounding [-].
const ROUNDING: f64 = 1e-7;
/// Largest change after which the next correction reuses the tangent stiffness [-].
const REUSED_MAX: f64 = 0.1;
/// Ratio of successive changes above which the tangent stiffness is evaluated again [-].
const FALL: f64 = 0.1;
/// Maximum number of iterations of a step [-].
const SOLVES_MAX: usize = 30;
/// Maximum change of θ in an iteration [-].
const TURN_MAX: f64 = 1.0;
/// |θ| from which the rotation of a node in a step is refused [-]: 2 tan(α/2) for α = 150°.
const THETA_MAX: f64 = 7.5;

/// Input of one step of a beam.
#[derive(Debug, Clone, Copy)]
pub struct BeamStep<'a> {
    /// Elements of the beam.
    pub beam: &'a Beam,
    /// Lumped mass, weight, drag and contact of the nodes.
    pub nodes: &'a Nodes,
    /// Supports of ends A and B, and the mean loads on them over the step.
    pub ends: [BeamEnd; 2],
    /// Sections of ends A and B after the step; only their prescribed unknowns are used.
    pub targets: [Section; 2],
    /// Bodies at the free ends.
    pub bodies: [Option<Body<'a>>; 2],
    /// Length of the step [s].
    pub length: f64,
    /// True if the energy flow is evaluated.
    pub energy_balance: bool,
}

/// Failure of a step, with its node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stuck {
    /// Node of the failure.
    pub node: usize,
    /// Reason of the failure.
    pub reason: StuckReason,
}

/// Reasons for which a beam cannot complete a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum StuckReason {
    /// Newton's method found no solution.
    #[error("the beam's motion over the step could not be found")]
    Diverged,
    /// A node turns by nearly half a turn in a step.
    #[error("the beam turns by more than 150 degrees in a step")]
    Turned,
    /// An element bends or twists by more than its strains can resolve.
    #[error("the beam turns by more than 60 degrees from this node to the next")]
    Folded,
}

impl StuckReason {
    /// Returns a remedy.
    pub fn advice(self) -> &'static str {
        match self {
            StuckReason::Diverged | StuckReason::Turned => {
                "try a smaller solver.time_step_max, or some damping of the line"
            }
            StuckReason::Folded => "use more elements there, or a greater bending or torsional stiffness",
        }
    }
}

/// Initial guess of the sections after a step: the second is used if the first does not converge.
#[derive(Debug, Clone, Copy)]
enum Guess {
    /// Mean rates extrapolated from the last steps.
    Course,
    /// Velocities before the step; the tangent stiffness is evaluated in every iteration.
    Velocity,
}

/// Workspace of a beam. Each step writes all values before it reads them.
#[derive(Debug, Clone)]
pub struct BeamWork {
    chain: PivotedChain,
    before: Vec<Section>,
    now: Vec<Section>,
    theta: Vec<Vector3<f64>>,
    elements: Vec<FourElements>,
    nodes: Vec<FourNodes>,
    mass: Vec<Matrix3<f64>>,
    tangent: Vec<Vector3<f64>>,
}

impl BeamWork {
    /// Allocates the workspace for a beam of `nodes` nodes.
    pub fn new(nodes: usize) -> BeamWork {
        let section = Section {
            position: Vector3::zeros(),
            frame: Matrix3::identity(),
        };
        BeamWork {
            chain: PivotedChain::new(nodes),
            before: vec![section; nodes],
            now: vec![section; nodes],
            theta: vec![Vector3::zeros(); nodes],
            elements: Vec::with_capacity(nodes.div_ceil(LANES)),
            nodes: Vec::with_capacity(nodes.div_ceil(LANES)),
            mass: vec![Matrix3::zeros(); nodes],
            tangent: vec![Vector3::zeros(); nodes],
        }
    }

    /// Advances `shape` by one step; returns the number of factorised tangents and the energy flow across the boundary of the beam.
    ///
    /// # Errors
    /// The iteration did not converge; the shape is unchanged.
    pub fn step(&mut self, case: &BeamStep, shape: &mut LineState) -> Result<(usize, Flow), Stuck> {
        let solves = self
            .converge(case, shape, Guess::Course)
            .or_else(|_| self.converge(case, shape, Guess::Velocity))?;
        let flow = match case.energy_balance {
            true => self.flow(case, shape),
            false => Flow::default(),
        };
        self.store(case, shape);
        Ok((solves, flow))
    }

    /// Solves for the sections after the step from an initial guess; returns the number of factorised tangents.
    fn converge(&mut self, case: &BeamStep, shape: &LineState, guess: Guess) -> Result<usize, Stuck> {
        self.predict(case, shape, guess);
        let length: f64 = case.beam.elements.iter().map(|e| e.length).sum();
        let (mut last, mut solves, mut exact) = (f64::INFINITY, 0, true);
        for _ in 0..SOLVES_MAX {
            solves += usize::from(exact);
            if !self.solve(case, exact) {
                break;
            }
            let (change, turn) = self.correct(length);
            if turn >= THETA_MAX {
                return Err(Stuck {
                    node: self.most_changed(length),
                    reason: StuckReason::Turned,
                });
            }
            if change <= TOLERANCE || is_last(exact, [last, change]) {
                return match folded(&self.now) {
                    Some(node) => Err(Stuck {
                        node,
                        reason: StuckReason::Folded,
                    }),
                    None => Ok(solves),
                };
            }
            let falls = exact || change <= FALL * last;
            exact = change > REUSED_MAX || !falls || matches!(guess, Guess::Velocity);
            last = change;
        }
        Err(Stuck {
            node: self.most_changed(length),
            reason: StuckReason::Diverged,
        })
    }

    /// Copies the state before the step and sets the initial guess of the state after it.
    fn predict(&mut self, case: &BeamStep, shape: &LineState, guess: Guess) {
        let state = beam_state(shape);
        let dt = case.length;
        for i in 0..self.before.len() {
            let frame = state.frames[i];
            self.before[i] = Section {
                position: shape.position[i],
                frame,
            };
            let turning = frame * state.spins[i]; // angular velocity, global axes [rad/s]
            let (velocity, turn_rate) = match guess {
                Guess::Course => split(&state.course.predict(i, dt)),
                Guess::Velocity => (shape.velocity[i], state.spins[i]),
            };
            self.theta[i] = dt * (frame * turn_rate);
            self.now[i].position = shape.position[i] + dt * velocity;
            self.tangent[i] = cayley(0.5 * dt * turning) * frame.column(2);
            let height = shape.position[i].z + 0.5 * dt * shape.velocity[i].z;
            self.mass[i] = self.effective_mass(case, i, self.tangent[i], height);
        }
        let last = self.before.len() - 1;
        for (end, node) in [0, last].into_iter().enumerate() {
            let (held, target) = (&case.ends[end].held, &case.targets[end]);
            for axis in (0..3).filter(|&axis| held[axis]) {
                self.now[node].position[axis] = target.position[axis];
            }
            if held[3] {
                let turn = target.frame * self.before[node].frame.transpose();
                self.theta[node] = cayley_vector(&turn);
            }
        }
        FourElements::gather(&mut self.elements, &case.beam.elements, &state.rest, &self.before);
        FourNodes::gather(self, case, shape);
        self.chain.clear_right();
        VectorUnit::best().dispatch(nodes::Move {
            work: self,
            part: 0.0,
        });
    }

    /// Mass matrix of a node and of the body there with their added mass [kg], for a tangent [-] and a height [m].
    fn effective_mass(&self, case: &BeamStep, i: usize, tangent: Vector3<f64>, height: f64) -> Matrix3<f64> {
        let body = self.body(case, i);
        let own = body.map_or(0.0, |body| body.point.at(height).mass);
        Matrix3::from_diagonal_element(own) + node_mass(case.nodes, i, tangent)
    }

    fn body<'a>(&self, case: &BeamStep<'a>, i: usize) -> Option<Body<'a>> {
        let last = self.before.len() - 1;
        let [a, b] = case.bodies;
        match i {
            0 => a,
            i if i == last => b,
            _ => None,
        }
    }

    /// Applies the solution of the linear system to a beam of `length` [m]; returns the largest change [-] and the largest |θ| [-].
    fn correct(&mut self, length: f64) -> (f64, f64) {
        let [moved, turned] = VectorUnit::best().dispatch(nodes::Changes(self)).map(f64::sqrt);
        let part = (TURN_MAX / turned).min(1.0);
        let turn = VectorUnit::best().dispatch(nodes::Move { work: self, part });
        ((moved / length).max(turned), turn.sqrt())
    }

    /// Node with the largest change of position relative to `length` [m], or of θ.
    fn most_changed(&self, length: f64) -> usize {
        let size = |change: &Sextuple| {
            let (position, theta) = split(change);
            (position.norm() / length).max(theta.norm())
        };
        let changes = self.chain.right.iter().map(size).enumerate();
        let greater = |most: (usize, f64), next: (usize, f64)| if next.1 > most.1 { next } else { most };
        changes.fold((0, 0.0), greater).0
    }

    /// Solves for the changes of positions and the spins, with the `exact` tangent stiffness or the last one; returns false if there is no solution.
    fn solve(&mut self, case: &BeamStep, exact: bool) -> bool {
        self.assemble(case, exact);
        if exact {
            self.chain.solve()
        } else {
            self.chain.solve_again()
        }
    }

    /// Assembles the residual forces and, if `tangent` is true, minus their slopes.
    fn assemble(&mut self, case: &BeamStep, tangent: bool) {
        VectorUnit::best().dispatch(nodes::SetNodes {
            work: self,
            length: case.length,
            tangent,
        });
        add_elements(
            &mut self.chain,
            &self.elements,
            &self.now,
            mixture(case.length),
            tangent,
        );
        if case.nodes.drag.is_some() {
            (0..self.now.len()).for_each(|i| self.add_drag(case, tangent, i));
        }
        for i in [0, self.now.len() - 1] {
            self.add_body(case, tangent, i);
        }
        if case.nodes.contact.is_some() {
            self.add_seabed(case, tangent);
        }
        let last = self.now.len() - 1;
        for (node, end) in [0, last].into_iter().zip(&case.ends) {
            self.chain.right[node] += end.load;
            for unknown in (0..6).filter(|&unknown| end.held[unknown]) {
                if tangent {
                    self.chain.hold(node, unknown, 0.0);
                } else {
                    self.chain.right[node][unknown] = 0.0;
                }
            }
        }
    }

    fn add_drag(&mut self, case: &BeamStep, tangent: bool, i: usize) {
        let Some(k) = drag_of(case.nodes, i) else {
            return;
        };
        let velocity = (self.now[i].position - self.before[i].position) / case.length;
        let slope = || drag_slope(k, velocity, self.tangent[i]) / case.length;
        let (force, slope) = (drag(k, velocity, self.tangent[i]), tangent.then(slope));
        self.add_at_node(i, force, slope);
    }

    fn add_body(&mut self, case: &BeamStep, tangent: bool, i: usize) {
        if let Some(body) = self.body(case, i) {
            let step = body.over(self.places(i), case.length);
            self.add_at_node(i, step.force(), tangent.then_some(step.slope));
        }
    }

    /// Adds a force [N] on a node and minus its slope with the position of the node [N/m].
    fn add_at_node(&mut self, i: usize, force: Vector3<f64>, slope: Option<Matrix3<f64>>) {
        let mut right = self.chain.right[i].fixed_rows_mut::<3>(0);
        right += force;
        for (row, column) in (0..9).map(|k| (k % 3, k / 3)) {
            if let Some(slope) = &slope {
                self.chain.diagonal[i][(row, column)] += slope[(row, column)];
            }
        }
    }

    /// Positions of a node before and after the step [m].
    fn places(&self, i: usize) -> [&Vector3<f64>; 2] {
        [&self.before[i].position, &self.now[i].position]
    }

    /// Seabed contact of the four parts of an element over the step.
    fn contact(&self, case: &BeamStep, element: usize) -> [(Part, ContactStep); 4] {
        PARTS.map(|part| {
            let Some(contact) = &case.nodes.contact else {
                return (part, ContactStep::default());
            };
            let k = contact.coefficients(element);
            let depths = |i: usize| self.places(i).map(|place| contact.level[i] - place.z);
            let (near, far) = (depths(element), depths(element + 1));
            let depth = [0, 1].map(|end| part.between(near[end], far[end]));
            let reach = damper_reach(k.stiffness, contact.weight[element]);
            (part, contact_step(k, depth, reach, case.length))
        })
    }

    fn add_seabed(&mut self, case: &BeamStep, tangent: bool) {
        for element in 0..case.beam.elements.len() {
            for (part, seabed) in self.contact(case, element) {
                let force = part.shares.map(|share| share * seabed.force);
                if tangent {
                    let slope = part
                        .products()
                        .map(|row| row.map(|product| product * seabed.slope));
                    add_rise(&mut self.chain, element, force, slope);
                } else {
                    add_lift(&mut self.chain, element, force);
                }
            }
        }
    }

    /// Energy flow across the boundary of the beam over the step [J].
    fn flow(&self, case: &BeamStep, shape: &LineState) -> Flow {
        let mut flow = Flow::default();
        let (dt, last) = (case.length, self.now.len() - 1);
        for (i, element) in case.beam.elements.iter().enumerate() {
            let after = strain(&self.now[i], &self.now[i + 1], element.length);
            let before = strain(&self.before[i], &self.before[i + 1], element.length);
            let [start, end] = [before, after].map(|strain| corrected(&strain, element.length));
            let rate = (end - start) / dt;
            let damping = element.damping.diagonal();
            flow.dissipation += dt * element.length * rate.dot(&damping.component_mul(&rate));
        }
        for (end, node) in [0, last].into_iter().enumerate() {
            flow.external_work += self.end_work(case, shape, end, node);
        }
        for i in 0..=last {
            let held = match i {
                0 => &case.ends[0].held,
                i if i == last => &case.ends[1].held,
                _ => &[false; 6],
            };
            if !held[..3].iter().all(|held| *held) {
                flow.dissipation += self.node_loss(case, shape, i);
            }
            if let Some(body) = self.body(case, i) {
                let step = body.over(self.places(i), dt);
                let moved = self.now[i].position - self.before[i].position;
                flow.add(body.flow(&step, &moved, dt));
            }
        }
        flow
    }

    /// Mean force [N] and moment [N m] over the step that balance the stress of the end element at an end of the beam.
    fn end_pull(&self, case: &BeamStep, shape: &LineState, end: usize) -> Sextuple {
        let i = end * (case.beam.elements.len() - 1);
        let (element, rest) = (&case.beam.elements[i], &beam_state(shape).rest[i]);
        let after = strain(&self.now[i], &self.now[i + 1], element.length);
        let before = strain(&self.before[i], &self.before[i + 1], element.length);
        let step = element.over_step([&before, &after], rest, mixture(case.length));
        let [a, b] = [i, i + 1].map(|node| Station::from(&self.before[node]).mean(&(&self.now[node]).into()));
        let [force, moment] = StrainGradient::new(&a, &b).tr_times(step.stress())[end];
        join(force, moment)
    }

    /// Work of the loads on the free unknowns of an end, and of the reactions at the prescribed ones [J].
    fn end_work(&self, case: &BeamStep, shape: &LineState, end: usize, node: usize) -> f64 {
        let moved = self.now[node].position - self.before[node].position;
        let change = join(moved, self.theta[node]);
        let pull = self.end_pull(case, shape, end);
        let BeamEnd { held, load } = &case.ends[end];
        (0..6)
            .map(|unknown| change[unknown] * if held[unknown] { pull } else { *load }[unknown])
            .sum()
    }

    /// Energy dissipated by water, seabed and mass damping at a node [J].
    fn node_loss(&self, case: &BeamStep, shape: &LineState, i: usize) -> f64 {
        let moved = self.now[i].position - self.before[i].position;
        let mut lost = 0.0;
        if let Some(k) = drag_of(case.nodes, i) {
            lost -= drag(k, moved / case.length, self.tangent[i]).dot(&moved);
        }
        if let Some(contact) = &case.nodes.contact {
            for (element, _) in contact.adjacent(i) {
                let seabeds = self.contact(case, element).into_iter();
                let push: f64 = seabeds
                    .map(|(part, seabed)| part.shares[i - element] * seabed.force)
                    .sum();
                lost -= push * moved.z;
            }
        }
        if let Some(damping) = &case.nodes.mass_damping {
            lost += damping[i] / case.length * moved.norm_squared();
        }
        // The effective mass is constant within a step: the kinetic energy that its change leaves out is added here. The mass
        // changes where added mass turns with the line or enters the water.
        let before = shape.velocity[i];
        let after = 2.0 / case.length * moved - before;
        let turned = |section: &Section, v: Vector3<f64>| {
            let (tangent, height) = (section.frame.column(2).into_owned(), section.position.z);
            let mass = self.effective_mass(case, i, tangent, height);
            0.5 * v.dot(&((mass - self.mass[i]) * v))
        };
        lost + turned(&self.before[i], before) - turned(&self.now[i], after)
    }

    fn store(&self, case: &BeamStep, shape: &mut LineState) {
        let (dt, last) = (case.length, self.now.len() - 1);
        for i in 0..=last {
            let held = match i {
                0 => case.ends[0].held,
                i if i == last => case.ends[1].held,
                _ => [false; 6],
            };
            let moved = self.now[i].position - self.before[i].position;
            let before = shape.velocity[i];
            for axis in 0..3 {
                let mean = moved[axis] / dt;
                shape.velocity[i][axis] = if held[axis] {
                    mean
                } else {
                    2.0 * mean - before[axis]
                };
            }
            shape.acceleration[i] = (shape.velocity[i] - before) / dt;
            shape.position[i] = self.now[i].position;
            let Some(state) = &mut shape.beam else {
                continue;
            };
            let mean = self.before[i].frame.tr_mul(&self.theta[i]) / dt;
            state.spins[i] = if held[3] {
                mean
            } else {
                2.0 * mean - state.spins[i]
            };
            state.frames[i] = self.now[i].frame;
            state.course.follow(i, join(moved / dt, mean), dt);
        }
        if let Some(state) = &mut shape.beam {
            state.course.end_step(dt);
        }
    }
}

/// Returns whether no correction is needed after two successive changes [-], the second with the `exact` tangent stiffness or that of the first. Changes
/// with the same tangent stiffness continue to decrease at the same ratio; small changes that do not decrease are rounding.
fn is_last(exact: bool, [before, change]: [f64; 2]) -> bool {
    match exact {
        true => change <= ROUNDING && change >= 0.5 * before,
        false => change < before && change * change <= REMAINDER * (before - change),
    }
}

/// Mixture that gives the mean stress over a step [s].
fn mixture(step: f64) -> Mixture {
    Mixture {
        share: 0.5,
        rate: 1.0 / step,
    }
}

fn beam_state(shape: &LineState) -> &crate::model::BeamState {
    shape
        .beam
        .as_ref()
        .expect("a line that is integrated as a beam has a beam's state")
}

/// Mass matrix of a submerged node with its added mass [kg], for a tangent [-].
fn node_mass(nodes: &Nodes, i: usize, tangent: Vector3<f64>) -> Matrix3<f64> {
    Slender::new(nodes.masses(i, 0.0)).matrix(tangent)
}

fn drag_of(nodes: &Nodes, i: usize) -> Option<DragCoefficients> {
    Some(nodes.drag.as_ref()?.at(i))
}

#[cfg(test)]
mod tests;
