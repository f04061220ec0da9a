//! Quasi-static stepping: at the end of every step the lines are in equilibrium.
//!
//! Positions are the equilibrium for the held points and the loads at that time, found from the one before; velocities are
//! differences over the step, and there is no acceleration. Valid where motions are slow beside the lowest natural period
//! and drag is small beside weight.

use super::StepError;
use crate::model::{Kinematics, Model, Network, State};
use crate::statics::StaticsError;
use crate::statics::assembly::{Counters, Workspace, copy_network, place_ends};
use crate::statics::equilibrium::continue_network;

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
    let (mut done, mut parts) = (0, PARTS_MAX);
    let mut result = Ok(());
    while done < PARTS_MAX {
        let time = t0 + (t1 - t0) * (done + parts) as f64 / PARTS_MAX as f64;
        match continue_network(
            model,
            number,
            state,
            |point| held(point, time).position,
            time,
            work,
        ) {
            Ok(()) => {
                work.counters.steps += 1;
                done += parts;
                if done % (2 * parts) == 0 && parts < PARTS_MAX {
                    parts *= 2;
                }
            }
            Err(error) if parts == 1 => {
                result = Err(failure(model, network, time, &error));
                copy_network(model, network, &start, state);
                break;
            }
            Err(_) => {
                work.counters.halvings += 1;
                parts /= 2;
            }
        }
    }
    if result.is_ok() {
        difference(model, network, &start, state, t1 - t0);
    }
    work.start = start;
    result.map(|()| work.take_counters())
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
