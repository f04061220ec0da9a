//! Static equilibrium of the assembled lines.
//!
//! Newton's method on the residual of [`crate::elements`], with two changes that make it insensitive to the stiffness of a line
//! and to the quality of the guess:
//!
//! * The geometric stiffness T/l is taken from a tension that the previous linear solve predicted,
//!   T ← N + dN/dl q·(δ_{i+1} − δ_i), not from the elastic force N of the present shape. That is Newton's method on positions and tensions together with
//!   the tensions eliminated; a stiff line then converges like an inextensible one. A segment whose predicted tension is
//!   negative is slack.
//! * Pseudo-transient relaxation: anchoring springs on every node and a minimum tension, both of which fade as the
//!   iteration proceeds. A straight unstressed line has no transverse stiffness without them.
//!
//! If this does not converge, the potential energy is minimised, which is convex for all measures that do not soften. The minimisation limits the
//! axial stiffness to a multiple of the loads and takes damped Newton steps whose length a directional derivative checks; the true stiffness is
//! approached from there. Where a softening measure would be stretched beyond the strain of its maximum force, the loads are applied in increments
//! instead, and every step must lie close to the previous one and have a positive definite tangent.
//!
//! Lines with bending stiffness are in `bending`, lines in a current in `current`, slack lines and those that float in `slack`, the friction of
//! the seabed in `friction`.
//!
//! A residual is accepted if it is at most 1e-11 of the largest force in the network (tension, nodal weight or load) plus the effect of rounding of
//! the positions on the stiffest segment.
//!
//! Source: Kelley & Keyes (1998), SIAM J. Numer. Anal. 35(2), 508-523 (pseudo-transient continuation); the elimination of
//! predicted tensions is derived here.

mod bending;
pub(crate) mod current;
mod friction;
mod slack;

use nalgebra::Vector3;

use super::StaticsError;
use super::guess;
use crate::elements::friction::{point_stick, remove_anchors};
use crate::elements::{StaticCase, Workspace, copy_network, free_points, place_ends};
use crate::model::{Kinematics, Line, LineState, Model, Network, PointState, State};
use crate::physics::friction::Friction;

/// Accepted out-of-balance force, relative to the largest force [-].
const FORCE_TOLERANCE: f64 = 1e-11;
/// Accepted last correction, relative to the longest line [-], unless three consecutive residuals are accepted.
const STEP_TOLERANCE: f64 = 1e-12;
/// Minimum tension, and minimum stiffness of the anchoring springs times the length, relative to the sum of the external forces [-].
const RELAXATION_MIN: f64 = 1e-12;
/// Maximum correction, relative to the longest line or, if that is more, the reach of the network [-].
const STEP_MAX: f64 = 0.2;
/// Maximum number of solves of one Newton iteration with predicted tensions.
const NEWTON_SOLVES_MAX: usize = 40;
/// The same if no segment may turn by much at once.
const CAUTIOUS_SOLVES_MAX: usize = 200;
/// Maximum number of solves of one minimisation.
const DESCENT_SOLVES_MAX: usize = 200;
/// Maximum number of linear solves times nodes in one search [-], about ten seconds.
const WORK_MAX: usize = 20_000_000;
/// Out-of-balance force that a minimisation leaves to Newton's method, relative to the sum of the loads; the second value applies where sticking
/// nodes must be distinguished from sliding ones [-].
const ROUGH_SHARE: f64 = 1e-6;
const FINE_SHARE: f64 = 1e-10;
/// Maximum number of cuts of one step of a minimisation.
const CUTS_MAX: usize = 12;
/// EA in the soft problem, relative to the sum of the loads [-].
const SOFT_STIFFNESS: f64 = 50.0;
/// Negative stiffness that counts as rounding, relative to the sum of the loads per length of the longest line [-].
const INSTABILITY: f64 = 1e-12;
/// Maximum number of load steps on a softening line.
const LOAD_STEPS_MAX: usize = 200;
/// Minimum growth factor that is tried for the part of a case [-].
const GROWTH_MIN: f64 = 1.1;
/// Ratio of strain to limit strain from which a failure is attributed to the limit [-].
const NEAR_LIMIT: f64 = 0.5;
/// Maximum growth of the ratio of strain to limit strain in one load step beyond the limit [-].
const JUMP_MAX: f64 = 0.1;
/// Minimum increment of the loads on a softening line [-].
const LOAD_INCREMENT_MIN: f64 = 1e-5;

/// Finds the equilibrium of all lines at time `t` [s]. `points` contains the positions of prescribed points, with the orientations of clamped lines,
/// and a guess of those of free points. Lines start from their shape in the scene, else from their catenary.
///
/// # Errors
/// Fails if no equilibrium is found, or there is none.
pub fn solve(
    model: &Model,
    points: &[PointState],
    t: f64,
    work: &mut Workspace,
) -> Result<State, StaticsError> {
    let mut state = place(model, points, t)?;
    for number in 0..model.networks.len() {
        hang(model, number, &mut state, work);
        rest(model, number, &mut state, work)?;
    }
    Ok(state)
}

/// Returns the state at time `t` [s] with all points, without the nodes of lines.
///
/// # Errors
/// Fails if a position is not finite.
pub fn place(model: &Model, points: &[PointState], t: f64) -> Result<State, StaticsError> {
    check_finite(model, points)?;
    let lines = model.lines.iter();
    Ok(State {
        time: t,
        points: points.to_vec(),
        lines: lines.map(|_| LineState::at_rest(Vec::new())).collect(),
        waves: None,
    })
}

/// Puts the lines of a network between their points on their shape in the scene, else on their catenary.
pub fn hang(model: &Model, number: usize, state: &mut State, work: &mut Workspace) {
    for &index in &model.networks[number].lines {
        let line = &model.lines[index];
        let ends = line.ends.map(|point| state.points[point].position);
        let hung = guess::hang(model, line, ends, &mut work.lines[index].tension);
        let start = guess::start_shape(model, line, ends).unwrap_or(hung);
        state.lines[index] = LineState::at_rest(start);
    }
}

/// Brings one network to rest from the shape set by [`hang`]. Beams have a separate equilibrium.
///
/// # Errors
/// Fails if no equilibrium is found, or there is none.
pub fn rest(
    model: &Model,
    number: usize,
    state: &mut State,
    work: &mut Workspace,
) -> Result<(), StaticsError> {
    if model.beam_of(number).is_some() {
        return Ok(());
    }
    Problem::new(model, number, state.time, work).solve(state, work)
}

/// Moves the prescribed points of a network to their `held` positions and finds the equilibrium at time `t` [s] closest to `state`, without
/// allocating; velocities and accelerations become zero.
///
/// # Errors
/// Fails if no equilibrium is found, or there is none; the state is then unchanged.
pub fn continue_network(
    model: &Model,
    number: usize,
    state: &mut State,
    held: impl Fn(usize) -> Kinematics,
    t: f64,
    work: &mut Workspace,
) -> Result<(), StaticsError> {
    let problem = Problem::new(model, number, t, work);
    let network = &model.networks[number];
    let mut before = std::mem::take(&mut work.before);
    copy_network(model, network, state, &mut before);
    problem.remember_shape(state, work);
    for &index in &network.lines {
        for point in model.lines[index].ends {
            if model.points[point].free().is_none() {
                state.points[point] = PointState::held(&held(point));
            }
        }
        shift(state, &before, model, index);
    }
    for &index in &network.free_points {
        state.points[index] = PointState::at_rest(state.points[index].position);
    }
    place_ends(model, network, state);
    let result = problem.solve(state, work);
    if result.is_err() {
        copy_network(model, network, &before, state);
    }
    work.before = before;
    result
}

/// Moves the nodes of a line along with its ends.
fn shift(state: &mut State, before: &State, model: &Model, index: usize) {
    let line = &model.lines[index];
    let [a, b] = line
        .ends
        .map(|point| state.points[point].position - before.points[point].position);
    let nodes = &mut state.lines[index];
    for (r, arc) in nodes.position.iter_mut().zip(&line.nodes.arc) {
        *r += a + (arc / line.unstretched_length()) * (b - a);
    }
    nodes.velocity.fill(Vector3::zeros());
    nodes.acceleration.fill(Vector3::zeros());
}

fn check_finite(model: &Model, points: &[PointState]) -> Result<(), StaticsError> {
    assert_eq!(points.len(), model.points.len(), "one state per point");
    for (point, state) in model.points.iter().zip(points) {
        for (axis, &value) in ["x", "y", "z"].into_iter().zip(&state.position) {
            if !value.is_finite() {
                let place = format!("point \"{}\", {axis}", point.name);
                return Err(StaticsError::NotFinite { place, value });
            }
        }
    }
    Ok(())
}

/// Largest EI/L² of a line, a force that bends it markedly; 0 if it is perfectly flexible [N].
fn stiffness_in_bending(line: &Line) -> f64 {
    let stiffness = line.bending.iter().flat_map(|bending| &bending.stiffness);
    stiffness.copied().fold(0.0, f64::max) / line.unstretched_length().powi(2)
}

/// Largest stiffness along the seabed of a sticking node [N/m].
fn stiffest_stick(line: &Line) -> f64 {
    let contact = line.nodes.contact.iter();
    let stick = contact.flat_map(|contact| &contact.stick);
    stick.copied().fold(0.0, f64::max)
}

/// Equilibrium of one network at one time.
struct Problem<'a> {
    model: &'a Model,
    network: &'a Network,
    number: usize,
    time: f64,
    /// Sum of the external forces [N]; without any, the largest EI/L² of the lines or, if they do not bend, 1 N.
    force: f64,
    /// Length of the longest line [m].
    length: f64,
    /// True if a line has bending stiffness that is not left out.
    bends: bool,
    /// Number of linear solves at which the search ends [-].
    solves_end: usize,
}

impl<'a> Problem<'a> {
    fn new(model: &'a Model, number: usize, time: f64, work: &Workspace) -> Problem<'a> {
        let network = &model.networks[number];
        let lines = model.lines_of(network);
        let mut force: f64 = lines
            .clone()
            .flat_map(|line| &line.nodes.weight)
            .map(|w| w.abs())
            .sum();
        for (index, free) in free_points(model, network) {
            force += free.weight_max() + model.points[index].load_at(time).norm();
        }
        for line in lines.clone().filter(|line| line.bending.is_some()) {
            let moments = model.end_moments(line, time);
            force += moments.map(|moment| moment.norm()).iter().sum::<f64>() / line.unstretched_length();
        }
        if force == 0.0 {
            force = lines.clone().map(stiffness_in_bending).fold(0.0, f64::max);
        }
        let nodes: usize = lines.clone().map(|line| line.segment_count()).sum();
        Problem {
            model,
            network,
            number,
            time,
            solves_end: work.counters.solves + WORK_MAX / nodes.max(1),
            force: if force > 0.0 { force } else { 1.0 },
            bends: lines.clone().any(|line| line.bending.is_some()),
            length: lines.map(|line| line.unstretched_length()).fold(0.0, f64::max),
        }
    }

    fn full_case(&self) -> StaticCase {
        StaticCase {
            bends: self.bends,
            ..StaticCase::whole(self.time)
        }
    }

    /// Returns whether the search has used its maximum number of solves.
    fn is_spent(&self, work: &Workspace) -> bool {
        work.counters.solves >= self.solves_end
    }

    fn solve(&self, state: &mut State, work: &mut Workspace) -> Result<(), StaticsError> {
        place_ends(self.model, self.network, state);
        let mut lines = self.model.lines_of(self.network);
        match self.model.stream(self.time) {
            Some(stream) if lines.any(|line| line.drifts(self.model)) => {
                self.solve_in_current(stream, state, work)
            }
            _ => self.solve_loaded(state, work),
        }
    }

    /// Equilibrium under weight, point loads and a given drag.
    fn solve_loaded(&self, state: &mut State, work: &mut Workspace) -> Result<(), StaticsError> {
        let has_friction = self.has_friction();
        if has_friction {
            remove_anchors(self.network, state);
        }
        let mut guess = std::mem::take(&mut work.saved);
        copy_network(self.model, self.network, state, &mut guess);
        let result = if self.bends {
            self.solve_bent(&guess, state, work)
        } else {
            self.solve_from(&guess, state, work)
        };
        work.saved = guess;
        match result {
            Ok(()) if has_friction => self.add_friction(state, work),
            result => result,
        }
    }

    /// Tries Newton's method; then, if a line softens, increments of the loads; then a soft network and a taut one, the taut one first if lines may
    /// pierce the surface; and finally `thin_gradually`.
    fn solve_from(&self, guess: &State, state: &mut State, work: &mut Workspace) -> Result<(), StaticsError> {
        let start = work.counters.solves;
        let softens = self.softens();
        if self.newton(state, work, self.full_case()) && (!softens || self.strain_over_limit(state).0 <= 1.0)
        {
            return Ok(());
        }
        if softens {
            self.restart(guess, state, work);
            let reached = self.load_gradually(state, work);
            if reached >= 1.0 {
                return Ok(());
            }
            if let Some(error) = self.limit_load(state, reached) {
                return Err(error);
            }
        }
        for slackens in [self.meets_surface(), !self.meets_surface()] {
            self.restart(guess, state, work);
            let found = if slackens {
                self.slacken(state, work)
            } else {
                self.stiffen_gradually(state, work, self.full_case())
            };
            if found && self.strain_over_limit(state).0 <= 1.0 {
                return Ok(());
            }
        }
        self.restart(guess, state, work);
        if self.thin_gradually(state, work) && self.strain_over_limit(state).0 <= 1.0 {
            return Ok(());
        }
        Err(self.not_converged(state, work, start))
    }

    /// Returns to a guess, with the tensions of its shape.
    fn restart(&self, guess: &State, state: &mut State, work: &mut Workspace) {
        copy_network(self.model, self.network, guess, state);
        self.remember_shape(state, work);
    }

    /// Sets the predicted tensions to those of the present shape.
    fn remember_shape(&self, state: &State, work: &mut Workspace) {
        work.assemble_static(self.model, self.network, state, &self.full_case());
        self.remember_tensions(work);
    }

    fn not_converged(&self, state: &State, work: &mut Workspace, start: usize) -> StaticsError {
        work.assemble_static(self.model, self.network, state, &self.full_case());
        let (residual, place) = work.greatest_residual(self.network);
        let tolerance = self.tolerance(state, work, f64::INFINITY);
        let (iterations, advice) = (work.counters.solves - start, self.advice(work));
        match residual <= tolerance {
            true => StaticsError::Unstable {
                line: self.model.lines[self.network.lines[0]].name.clone(),
                iterations,
                advice,
            },
            false => StaticsError::NotConverged {
                place: place.name(self.model),
                residual,
                tolerance,
                iterations,
                advice,
            },
        }
    }

    /// Advice for a network whose equilibrium is not found.
    fn advice(&self, work: &Workspace) -> &'static str {
        if self.is_spent(work) {
            "use fewer elements: a search on this mesh takes too long"
        } else if !self.network.free_points.is_empty() {
            "bring the free points' reference positions closer to where they will rest, or use more elements"
        } else if self.has_friction() {
            "use another number of elements, or less friction of the seabed"
        } else {
            "use another number of elements"
        }
    }

    /// Newton's method with predicted tensions; returns whether it converged.
    fn newton(&self, state: &mut State, work: &mut Workspace, mut case: StaticCase) -> bool {
        case.predicted = true;
        let mut relaxation = self.first_relaxation(state, work, &case);
        let mut step = f64::INFINITY;
        let (mut balanced, mut refused) = (0, 0);
        let solves_max = match (self.bends, case.cautious) {
            (true, _) => bending::NEWTON_SOLVES_MAX,
            (_, true) => CAUTIOUS_SOLVES_MAX,
            _ => NEWTON_SOLVES_MAX,
        };
        for _ in 0..solves_max {
            case.tension_min = relaxation * self.force;
            case.anchoring = relaxation * self.force / self.length + self.rounding_stiffness(&case);
            work.assemble_static(self.model, self.network, state, &case);
            balanced = self.count_balanced(balanced, state, work, &case);
            if balanced >= 3 || (balanced > 0 && step <= STEP_TOLERANCE * self.length) {
                return true;
            }
            if self.is_spent(work) {
                return false;
            }
            if !work.solve(self.model, self.number) {
                relaxation = (10.0 * relaxation).min(1.0);
                refused += 1;
                if self.bends && refused > bending::REFUSALS_MAX {
                    return false;
                }
                continue;
            }
            step = work.greatest_solution(self.network);
            if !step.is_finite() {
                return false;
            }
            let mut part = (STEP_MAX * self.reach(state) / step).min(1.0);
            if self.bends || case.cautious {
                part = part.min(self.turning_part(state, work));
            }
            work.predict_tensions(self.model, self.network, part);
            self.advance(state, work, part);
            if part == 1.0 {
                relaxation = (0.1 * relaxation).max(RELAXATION_MIN);
            }
        }
        false
    }

    /// Counts the consecutive assemblies that are in balance, the last one after `balanced` others.
    fn count_balanced(&self, balanced: usize, state: &State, work: &Workspace, case: &StaticCase) -> usize {
        let (residual, _) = work.greatest_residual(self.network);
        let tolerance = self.tolerance(state, work, case.stiffness_max);
        match residual <= tolerance && self.no_push(work, tolerance) {
            true => balanced + 1,
            false => 0,
        }
    }

    /// Relaxation at the start of Newton's method [-]: the out-of-balance force relative to the sum of the external forces, so that anchoring hardly
    /// restrains a shape that is close to equilibrium. It is a power of ten, so that rounding of the residual does not change it.
    fn first_relaxation(&self, state: &State, work: &mut Workspace, case: &StaticCase) -> f64 {
        work.assemble_static(self.model, self.network, state, case);
        let (residual, _) = work.greatest_residual(self.network);
        let share = (residual / self.force).clamp(RELAXATION_MIN, 1.0);
        10.0_f64.powf(share.log10().ceil())
    }

    /// Returns whether the forces of a shape are in balance by themselves, without predicted tensions.
    fn is_balanced(&self, state: &State, work: &mut Workspace) -> bool {
        work.assemble_static(self.model, self.network, state, &self.full_case());
        let (residual, _) = work.greatest_residual(self.network);
        residual <= self.tolerance(state, work, f64::INFINITY)
    }

    /// Largest distance of a node from end A of its line, at least the length of the longest line [m].
    fn reach(&self, state: &State) -> f64 {
        let lines = self.network.lines.iter().map(|&line| &state.lines[line].position);
        let distances = lines.flat_map(|nodes| nodes.iter().map(|r| (r - nodes[0]).amax()));
        distances.fold(self.length, f64::max)
    }

    /// Anchoring stiffness that raises pivots above the rounding of the stiffest spring [N/m].
    fn rounding_stiffness(&self, case: &StaticCase) -> f64 {
        8.0 * f64::EPSILON * self.stiffest(case)
    }

    /// Largest stiffness of a spring in a case [N/m].
    fn stiffest(&self, case: &StaticCase) -> f64 {
        let spring = |line: &Line| {
            let spring = self.stiffest_spring(line, case.stiffness_max);
            spring.max(stiffest_stick(line))
        };
        self.model.lines_of(self.network).map(spring).fold(0.0, f64::max)
    }

    /// Largest stiffness of a segment of at most this EA [N], of the seabed under a node, or of a joint [N/m].
    fn stiffest_spring(&self, line: &Line, stiffness_max: f64) -> f64 {
        let segments = line.segments.axial_stiffness.iter().zip(&line.segments.length);
        let axial = segments.map(|(ea, length)| ea.min(stiffness_max) / length);
        let contact = line.nodes.contact.iter();
        let seabed = contact.flat_map(|contact| &contact.stiffness).copied();
        let spring = seabed.chain(axial).fold(0.0, f64::max);
        match self.bends {
            true => spring.max(bending::stiffest_joint(line)),
            false => spring,
        }
    }

    /// Accepted out-of-balance force [N] at the last assembly.
    fn tolerance(&self, state: &State, work: &Workspace, stiffness_max: f64) -> f64 {
        let (mut force, mut rounding, mut stuck) = (0.0_f64, 0.0_f64, 0.0_f64);
        for &index in &self.network.lines {
            let line = &self.model.lines[index];
            let nodes = state.lines[index].position.iter();
            let far = nodes.map(|r| r.amax()).fold(0.0, f64::max);
            for i in 0..line.segment_count() {
                force = force
                    .max(work.lines[index].elastic[i])
                    .max(line.nodes.weight[i].abs());
            }
            if let Some(surface) = &line.surface
                && surface.is_pierced(&state.lines[index].position)
            {
                force = surface.buoyancy.iter().copied().fold(force, f64::max);
            }
            if let (Some(joints), true) = (&work.lines[index].bending, self.bends) {
                force = force.max(joints.greatest);
            }
            rounding = rounding.max(far * self.stiffest_spring(line, stiffness_max));
            stuck = stuck.max(far * stiffest_stick(line));
        }
        for (index, free) in free_points(self.model, self.network) {
            let load = self.model.points[index].load_at(self.time).norm();
            force = force.max(load).max(free.weight_max());
            if let Some(contact) = &free.contact {
                rounding = rounding.max(contact.seabed_level.abs() * contact.coefficients.stiffness);
                stuck = stuck.max(state.points[index].position.amax() * point_stick(free));
            }
        }
        let friction = self.model.friction().map_or(0.0, Friction::greatest);
        let rounding = 4.0 * f64::EPSILON * rounding;
        let stuck = (4.0 * f64::EPSILON * stuck).min(friction * force);
        FORCE_TOLERANCE * force + rounding.max(stuck)
    }

    /// Returns whether no segment that the last assembly treated as taut is in compression.
    fn no_push(&self, work: &Workspace, tolerance: f64) -> bool {
        self.network.lines.iter().all(|&line| {
            let line = &work.lines[line];
            let segments = line.elastic.iter().zip(&line.tension);
            segments.enumerate().all(|(i, (&elastic, &tension))| {
                let least = 0.0 - line.push[i];
                tension <= least || elastic >= least - tolerance
            })
        })
    }

    /// Adds a `part` of the correction, the negative of the solution, to the positions.
    fn advance(&self, state: &mut State, work: &Workspace, part: f64) {
        for &index in &self.network.lines {
            let nodes = state.lines[index].position.iter_mut();
            for (r, x) in nodes.zip(work.lines[index].solution()) {
                *r -= part * x;
            }
        }
        for &index in &self.network.free_points {
            state.points[index].position -= part * work.points[index].solution;
        }
        place_ends(self.model, self.network, state);
    }

    /// Follows the equilibrium from a soft network, whose energy is minimised, to that of the `full` case.
    fn stiffen_gradually(&self, state: &mut State, work: &mut Workspace, full: StaticCase) -> bool {
        let mut stiffness = SOFT_STIFFNESS * self.force;
        let lines = self.model.lines_of(self.network);
        let stiffnesses = lines.flat_map(|line| &line.segments.axial_stiffness);
        let stiffest = stiffnesses.copied().fold(0.0, f64::max);
        loop {
            let soft = StaticCase {
                stiffness_max: stiffness,
                ..full
            };
            self.descend(state, work, soft);
            self.remember_tensions(work);
            let mut trial = std::mem::take(&mut work.trial);
            copy_network(self.model, self.network, state, &mut trial);
            let found = self.newton(state, work, full);
            if !found {
                copy_network(self.model, self.network, &trial, state);
            }
            work.trial = trial;
            if found || stiffness >= stiffest {
                return found;
            }
            stiffness *= 10.0;
        }
    }

    /// Follows the equilibrium of a case that grows from its `first` part to the whole, by a factor of `growth` or, if that fails, a smaller one.
    /// Returns whether the whole was reached. The state is that of the last part that was found.
    fn raise(
        &self,
        state: &mut State,
        work: &mut Workspace,
        [first, growth]: [f64; 2],
        case: impl Fn(f64) -> StaticCase,
    ) -> bool {
        let mut found = std::mem::take(&mut work.trial);
        copy_network(self.model, self.network, state, &mut found);
        let (mut reached, mut factor) = (first / growth, growth);
        while reached < 1.0 && factor >= GROWTH_MIN {
            let part = (factor * reached).min(1.0);
            if self.newton(state, work, case(part)) {
                reached = part;
                factor = factor.powf(1.5).min(growth);
                copy_network(self.model, self.network, state, &mut found);
            } else {
                factor = factor.sqrt();
                self.restart(&found, state, work);
            }
        }
        work.trial = found;
        reached >= 1.0
    }

    fn remember_tensions(&self, work: &mut Workspace) {
        for &index in &self.network.lines {
            let line = &mut work.lines[index];
            line.tension.copy_from_slice(&line.elastic);
        }
    }

    /// Minimises the potential energy approximately by damped Newton steps; `case` keeps its stiffness.
    fn descend(&self, state: &mut State, work: &mut Workspace, mut case: StaticCase) {
        let mut relaxation: f64 = 1.0;
        for _ in 0..DESCENT_SOLVES_MAX {
            case.anchoring = relaxation * self.force / self.length + self.rounding_stiffness(&case);
            work.assemble_static(self.model, self.network, state, &case);
            let accepted = if case.keeps_pressure {
                let tolerance = self.tolerance(state, work, case.stiffness_max);
                tolerance.max(FINE_SHARE * self.force)
            } else {
                ROUGH_SHARE * self.force
            };
            if work.greatest_residual(self.network).0 <= accepted || self.is_spent(work) {
                return;
            }
            if !work.solve(self.model, self.number) {
                relaxation *= 10.0;
                continue;
            }
            let step = work.greatest_solution(self.network);
            let longest = (STEP_MAX * self.reach(state) / step).min(1.0);
            let part = self.cut(state, work, &case, longest);
            relaxation *= if part >= 1.0 {
                0.1
            } else if part < 0.1 {
                4.0
            } else {
                1.0
            };
            relaxation = relaxation.clamp(1e-9, 1e6);
        }
    }

    /// Moves along the correction as long as the energy falls; returns the fraction that was taken.
    fn cut(&self, state: &mut State, work: &mut Workspace, case: &StaticCase, longest: f64) -> f64 {
        let case = StaticCase {
            anchoring: 0.0,
            ..*case
        };
        let before = self.power(work);
        let (mut part, mut taken) = (longest, 0.0);
        for _ in 0..CUTS_MAX {
            self.advance(state, work, part - taken);
            taken = part;
            work.assemble_static(self.model, self.network, state, &case);
            let after = self.power(work);
            if after <= 0.5 * before.abs() {
                break;
            }
            part *= (before / (before - after)).clamp(0.1, 0.7);
        }
        taken
    }

    /// Slope of the energy along the correction [J].
    fn power(&self, work: &Workspace) -> f64 {
        let mut sum = 0.0;
        for &index in &self.network.lines {
            let (x, r) = (work.lines[index].solution(), &work.lines[index].residual);
            let last = r.len() - 1;
            sum -= (1..last).map(|i| x[i].dot(&r[i])).sum::<f64>();
        }
        for &index in &self.network.free_points {
            sum -= work.points[index].solution.dot(&work.points[index].total);
        }
        sum
    }

    fn softens(&self) -> bool {
        let lines = self.model.lines_of(self.network);
        let mut laws = lines.flat_map(|line| &line.segments.law);
        laws.any(|law| law.limit_strain().is_some())
    }

    /// Returns whether the tangent of a converged state is positive definite.
    fn stable(&self, state: &State, work: &mut Workspace, case: StaticCase) -> bool {
        let least = match self.bends {
            true => bending::INSTABILITY,
            false => INSTABILITY,
        };
        let lines = self.model.lines_of(self.network);
        let longest = lines.map(Line::segment_count).fold(8, usize::max);
        // the rounding of the pivots adds up along a line
        let rounding = longest as f64 * f64::EPSILON * self.stiffest(&case);
        let anchoring = rounding + least * self.force / self.length;
        let case = StaticCase {
            anchoring,
            predicted: false,
            ..case
        };
        work.assemble_static(self.model, self.network, state, &case);
        work.solve(self.model, self.number)
    }

    /// Largest ratio of strain to the limit strain of its measure [-], with line, segment and strain [-]; below the limits of all measures the energy
    /// is convex and an equilibrium is unique.
    fn strain_over_limit(&self, state: &State) -> (f64, usize, usize, f64) {
        let mut worst = (0.0, self.network.lines[0], 0, 0.0);
        for &index in &self.network.lines {
            let segments = &self.model.lines[index].segments;
            let position = &state.lines[index].position;
            for (i, law) in segments.law.iter().enumerate() {
                let Some(limit) = law.limit_strain() else {
                    continue;
                };
                let strain = (position[i + 1] - position[i]).norm() / segments.length[i] - 1.0;
                if strain / limit > worst.0 {
                    worst = (strain / limit, index, i, strain);
                }
            }
        }
        worst
    }

    /// Loads a softening network in increments, from zero; returns the part of the loads that was reached. Beyond the limit strain the shape must
    /// change little from step to step: a jump means that a segment breaks.
    fn load_gradually(&self, state: &mut State, work: &mut Workspace) -> f64 {
        let mut increment: f64 = 0.25;
        let mut case = StaticCase {
            load: 0.0,
            ..self.full_case()
        };
        let mut reached = std::mem::take(&mut work.trial);
        copy_network(self.model, self.network, state, &mut reached);
        let (mut done, mut stretched) = (0.0_f64, 1.0_f64);
        for _ in 0..LOAD_STEPS_MAX {
            if done >= 1.0 || increment < LOAD_INCREMENT_MIN {
                break;
            }
            case.load = (done + increment).min(1.0);
            let found = self.newton(state, work, case);
            let over_limit = self.strain_over_limit(state).0;
            if found && over_limit <= stretched + JUMP_MAX && self.stable(state, work, case) {
                done = case.load;
                stretched = over_limit.max(1.0);
                increment = (2.0 * increment).min(0.25);
                copy_network(self.model, self.network, state, &mut reached);
            } else {
                increment *= 0.5;
            }
            self.restart(&reached, state, work);
        }
        work.trial = reached;
        done
    }

    /// Error for a network that reached this part of the loads, if a segment is near its limit.
    fn limit_load(&self, state: &State, load_fraction: f64) -> Option<StaticsError> {
        let (over_limit, line, segment, strain) = self.strain_over_limit(state);
        let line = &self.model.lines[line];
        let limit_strain = line.segments.law[segment].limit_strain()?;
        (over_limit >= NEAR_LIMIT).then(|| StaticsError::LimitLoad {
            line: line.name.clone(),
            segment,
            strain,
            limit_strain,
            load_fraction,
        })
    }
}
