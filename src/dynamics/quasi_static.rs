//! Quasi-static stepping: at the end of every step the lines are in equilibrium.
//!
//! Positions are the equilibrium for the held points and the loads at that time, found from the one before; velocities are
//! differences over the step, and there is no acceleration. Flexible lines of engineering strain are closed-form catenaries, joined at
//! free points; others, and those that find no rest that way, are chains of elements. Valid where motions are slow beside the lowest natural period
//! and drag is small beside weight.

use super::StepError;
use crate::model::{Kinematics, Model, Network, PointState, State};
use crate::statics::assembly::{Counters, Workspace, copy_network, place_ends};
use crate::statics::catenary_network::solve_network;
use crate::statics::equilibrium::continue_network;
use crate::statics::{StaticsError, catenary_network};

/// Parts that a step may be cut into by halving: six halvings.
const PARTS_MAX: usize = 64;

/// Advances one network from its state at `t0` to the equilibrium at `t1` [s]; `held` gives the positions of the points that forces do
/// not move. `state.time` is left to the caller.
///
/// # Errors
/// There is no equilibrium at some time of the step; the state is then as it was.
pub fn advance<K: Fn(usize, f64) -> Kinematics>(
    model: &Model,
    number: usize,
    state: &mut State,
    held: &K,
    [t0, t1]: [f64; 2],
    work: &mut Workspace,
) -> Result<Counters, StepError> {
    let network = &model.networks[number];
    let mut start = std::mem::take(&mut work.start);
    copy_network(model, network, state, &mut start);
    work.counters = Counters::default();
    let mut result = Ok(());
    if catenary_network::serves(model, network) && hang(model, number, state, held, [t0, t1], work)
    {
        work.counters.steps += 1;
    } else {
        copy_network(model, network, &start, state);
        result = continue_elements(model, number, state, held, [t0, t1], work);
        match &result {
            Ok(()) => lay_down(model, number, state, t1, work),
            Err(_) => copy_network(model, network, &start, state),
        }
    }
    if result.is_ok() {
        difference(model, network, &start, state, t1 - t0);
    }
    work.start = start;
    result.map(|()| work.take_counters())
}

/// Puts a network on its catenaries at `t1` [s], its free points guessed to have moved on as before; whether that was possible.
fn hang<K: Fn(usize, f64) -> Kinematics>(
    model: &Model,
    number: usize,
    state: &mut State,
    held: &K,
    [t0, t1]: [f64; 2],
    work: &mut Workspace,
) -> bool {
    let network = &model.networks[number];
    for point in network
        .lines
        .iter()
        .flat_map(|&line| model.lines[line].ends)
    {
        if model.points[point].free().is_none() {
            state.points[point] = PointState::held(&held(point, t1));
        }
    }
    for &point in &network.free_points {
        let point = &mut state.points[point];
        point.position += (t1 - t0) * point.velocity;
    }
    solve_network(model, number, state, t1, work)
}

/// Takes a network that rests on its elements at time `t` [s] to its catenaries, which lie close by, where it has them.
fn lay_down(model: &Model, number: usize, state: &mut State, t: f64, work: &mut Workspace) {
    if !solve_network(model, number, state, t, work) {
        for &line in &model.networks[number].lines {
            state.lines[line].closed_form = None;
        }
    }
}

/// Follows the equilibrium of a network's elements from `t0` to `t1` [s], in parts where it must.
fn continue_elements<K: Fn(usize, f64) -> Kinematics>(
    model: &Model,
    number: usize,
    state: &mut State,
    held: &K,
    [t0, t1]: [f64; 2],
    work: &mut Workspace,
) -> Result<(), StepError> {
    let (mut done, mut parts) = (0, PARTS_MAX);
    while done < PARTS_MAX {
        let time = t0 + (t1 - t0) * (done + parts) as f64 / PARTS_MAX as f64;
        match continue_network(model, number, state, |point| held(point, time), time, work) {
            Ok(()) => {
                work.counters.steps += 1;
                done += parts;
                if done % (2 * parts) == 0 && parts < PARTS_MAX {
                    parts *= 2;
                }
            }
            Err(error) if parts == 1 => {
                return Err(failure(model, &model.networks[number], time, &error));
            }
            Err(_) => {
                work.counters.halvings += 1;
                parts /= 2;
            }
        }
    }
    Ok(())
}

fn failure(model: &Model, network: &Network, time: f64, error: &StaticsError) -> StepError {
    let (line, node) = match error {
        StaticsError::LimitLoad { line, segment, .. } => (line.clone(), *segment),
        _ => (model.lines[network.lines[0]].name.clone(), 0),
    };
    StepError {
        time,
        line,
        node,
        reason: error.to_string(),
        advice: "lower solver.time_step_max, or use a dynamic integrator if the lines lose their hold here",
    }
}

/// Velocities over a step of `dt` [s].
fn difference(model: &Model, network: &Network, before: &State, state: &mut State, dt: f64) {
    for &index in &network.lines {
        let (old, new) = (&before.lines[index], &mut state.lines[index]);
        for ((v, r), r_old) in new
            .velocity
            .iter_mut()
            .zip(&new.position)
            .zip(&old.position)
        {
            *v = (r - r_old) / dt;
        }
        for point in model.lines[index].ends {
            let (old, new) = (&before.points[point], &mut state.points[point]);
            new.velocity = (new.position - old.position) / dt;
        }
    }
    place_ends(model, network, state);
}
