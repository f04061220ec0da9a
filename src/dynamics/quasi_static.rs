//! Quasi-static stepping: at the end of every step the lines are in equilibrium.
//!
//! The equilibrium is that for the prescribed points and the loads at that time, computed from the previous equilibrium. Nodes
//! have neither velocity nor acceleration, so there is no damping, no inertia and no drag except that of a current.
//! Flexible lines with engineering strain are closed-form catenaries, joined at free points; others, and those without
//! such a solution, are chains of elements. Valid where motions are slow compared with the lowest natural period
//! and drag is small compared with weight.
//!
//! A step has one equilibrium at its end, and is halved if none is found. If the scene has an energy balance and the mean of the forces before and
//! after a step is too inaccurate for the work, equilibria in between are computed for the balance alone.

use nalgebra::Vector3;

use super::StepError;
use super::energy_balance::{Flow, energy, work_at_rest};
use crate::elements::{Counters, Workspace, copy_network};
use crate::model::{Kinematics, Model, Network, PointState, State};
use crate::statics::catenary_network::solve_network;
use crate::statics::equilibrium::continue_network;
use crate::statics::{StaticsError, catenary_network};

/// Maximum number of parts of a step: six halvings.
const PARTS_MAX: usize = 64;
/// Maximum number of halvings of a step for its energy flow.
const FLOW_HALVINGS: usize = 6;
/// Largest error of the energy balance of a step, relative to its work [-].
const OPEN_MAX: f64 = 0.1;
/// Energy error due to rounding, relative to the stored energy [-].
const ROUNDING: f64 = 1e-9;

struct Path<'a, K> {
    model: &'a Model,
    number: usize,
    network: &'a Network,
    held: &'a K,
}

/// Advances one network from its state at `t0` to the equilibrium at `t1` [s]; `held` returns the kinematics of the
/// prescribed points. The caller sets `state.time`. Returns the computational work and the energy flow.
///
/// # Errors
/// No equilibrium was found at some time in the step; the state is then the last equilibrium found.
pub fn advance<K: Fn(usize, f64) -> Kinematics>(
    model: &Model,
    number: usize,
    state: &mut State,
    held: &K,
    [t0, t1]: [f64; 2],
    work: &mut Workspace,
) -> Result<(Counters, Flow), StepError> {
    let path = Path {
        model,
        number,
        network: &model.networks[number],
        held,
    };
    let mut before = std::mem::take(&mut work.start);
    copy_network(model, path.network, state, &mut before);
    work.counters = Counters::default();
    let mut flow = Flow::default();
    let (mut done, mut parts) = (0, PARTS_MAX);
    let mut result = Ok(());
    while done < PARTS_MAX {
        let [from, to] = [done, done + parts].map(|part| part as f64 / PARTS_MAX as f64);
        let times = [t0 + (t1 - t0) * from, t1 - (t1 - t0) * (1.0 - to)];
        match path.rest(&before, state, times, work) {
            Ok(()) => {
                if model.energy_balance {
                    let counters = work.counters;
                    flow.add(path.flow([&before, state], times, FLOW_HALVINGS, work));
                    work.counters = counters;
                }
                path.stop(&before, state, times[1] - times[0]);
                copy_network(model, path.network, state, &mut before);
                work.counters.steps += 1;
                done += parts;
                if done % (2 * parts) == 0 && parts < PARTS_MAX {
                    parts *= 2;
                }
            }
            Err(error) if parts == 1 => {
                result = Err(path.failure(times[1], &error));
                break;
            }
            _ => {
                copy_network(model, path.network, &before, state);
                work.counters.halvings += 1;
                parts /= 2;
            }
        }
    }
    work.start = before;
    result.map(|()| (work.take_counters(), flow))
}

impl<K: Fn(usize, f64) -> Kinematics> Path<'_, K> {
    /// Moves `state`, equal to the equilibrium `before`, to the equilibrium at the end of a part of the step, between two times [s].
    fn rest(
        &self,
        before: &State,
        state: &mut State,
        times: [f64; 2],
        work: &mut Workspace,
    ) -> Result<(), StaticsError> {
        if catenary_network::serves(self.model, self.network) && self.hang(state, times, work) {
            return Ok(());
        }
        copy_network(self.model, self.network, before, state);
        let ([_, end], held) = (times, self.held);
        continue_network(
            self.model,
            self.number,
            state,
            |point| held(point, end),
            end,
            work,
        )?;
        self.lay_down(state, end, work);
        Ok(())
    }

    /// Sets the network to closed-form catenaries, starting from extrapolated positions of its free points; returns whether
    /// the solution was found.
    fn hang(&self, state: &mut State, [start, end]: [f64; 2], work: &mut Workspace) -> bool {
        let model = self.model;
        for point in self.network.lines.iter().flat_map(|&line| model.lines[line].ends) {
            if model.points[point].free().is_none() {
                state.points[point] = PointState::held(&(self.held)(point, end));
            }
        }
        for &point in &self.network.free_points {
            let point = &mut state.points[point];
            point.position += (end - start) * point.velocity;
        }
        solve_network(model, self.number, state, end, work)
    }

    /// Replaces the equilibrium on elements at time `t` [s] by closed-form catenaries nearby, if there is such a solution.
    fn lay_down(&self, state: &mut State, t: f64, work: &mut Workspace) {
        if !solve_network(self.model, self.number, state, t, work) {
            for &line in &self.network.lines {
                state.lines[line].closed_form = None;
            }
        }
    }

    /// Energy flow between two equilibria [J]; the step is halved if the error of the energy balance is large.
    fn flow(&self, states: [&State; 2], times: [f64; 2], halvings: usize, work: &mut Workspace) -> Flow {
        let mut flow = work_at_rest(self.model, self.network, states, times);
        let [before, after] = states.map(|state| energy(self.model, self.network, state));
        let open = after.at_rest() - before.at_rest() - flow.external_work + flow.dissipation;
        let turnover = flow.external_work.abs() + flow.dissipation.abs();
        let stored = after.at_rest() - after.gravitational + after.gravitational.abs();
        if halvings == 0 || open.abs() <= OPEN_MAX * turnover + ROUNDING * stored {
            return flow;
        }
        let (mut middle, half) = (states[0].clone(), 0.5 * (times[0] + times[1]));
        if self.rest(states[0], &mut middle, [times[0], half], work).is_ok() {
            self.stop(states[0], &mut middle, half - times[0]);
            flow = self.flow([states[0], &middle], [times[0], half], halvings - 1, work);
            flow.add(self.flow([&middle, states[1]], [half, times[1]], halvings - 1, work));
        }
        flow
    }

    /// Sets the nodes at rest after a part of the step of `dt` [s]. Free points get their mean velocity, for the next extrapolation.
    fn stop(&self, before: &State, state: &mut State, dt: f64) {
        for &point in &self.network.free_points {
            let way = state.points[point].position - before.points[point].position;
            state.points[point].velocity = way / dt;
        }
        for &line in &self.network.lines {
            state.lines[line].velocity.fill(Vector3::zeros());
            state.lines[line].acceleration.fill(Vector3::zeros());
        }
    }

    fn failure(&self, time: f64, error: &StaticsError) -> StepError {
        let (line, node) = match error {
            StaticsError::LimitLoad { line, segment, .. } => (line.clone(), *segment),
            _ => (self.model.lines[self.network.lines[0]].name.clone(), 0),
        };
        StepError {
            time,
            line,
            node,
            cause: error.clone().into(),
        }
    }
}
