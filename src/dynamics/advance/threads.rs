//! A communication step whose networks are shared among threads, each of which takes the next that no other has begun.

use std::sync::Mutex;

use super::Done;
use super::communication::{Communication, Solver};
use crate::dynamics::crew::{Crew, Queue, lock};
use crate::dynamics::{Choice, StepError};
use crate::elements;
use crate::model::{Kinematics, State};

/// What became of a network in a step that threads shared.
pub(super) type Outcome = Option<Result<Done, StepError>>;

/// Scratch of the threads that help.
#[derive(Debug, Default)]
pub(super) struct Helpers(Vec<Mutex<Helper>>);

impl Clone for Helpers {
    /// None yet.
    fn clone(&self) -> Helpers {
        Helpers::default()
    }
}

/// Scratch of a thread that helps.
#[derive(Debug)]
pub(super) struct Helper {
    implicit: elements::Workspace,
    next: State,
    /// Networks that it brought to the end of the step.
    made: Vec<usize>,
}

impl Helpers {
    /// So many, ready for a step whose state is built in `next`.
    pub(super) fn of<K>(&mut self, count: usize, step: &Communication<K>, next: &State) -> &[Mutex<Helper>] {
        while self.0.len() < count {
            self.0.push(Mutex::new(Helper {
                implicit: elements::Workspace::new(step.model),
                next: next.clone(),
                made: Vec::with_capacity(step.model.networks.len()),
            }));
        }
        for helper in &self.0[..count] {
            lock(helper).next.waves.clone_from(&next.waves);
        }
        &self.0[..count]
    }
}

impl<K: Fn(usize, f64) -> Kinematics + Sync> Communication<'_, K> {
    /// All networks, each on the thread that takes it; `next` becomes what it would be on one thread.
    pub(super) fn on_threads(
        &self,
        crew: &mut Crew,
        helpers: &[Mutex<Helper>],
        (networks, outcomes): (&mut [(Choice, Solver)], &mut Vec<Outcome>),
        (implicit, next): (&mut elements::Workspace, &mut State),
    ) {
        let count = networks.len();
        outcomes.clear();
        outcomes.resize_with(count, || None);
        let size = count.div_ceil(helpers.len() + 1);
        for (number, helper) in helpers.iter().enumerate() {
            let first = ((number + 1) * size).min(count);
            self.exchange(first..(first + size).min(count), next, &mut lock(helper).next);
        }
        let parts = networks.chunks_mut(size).zip(outcomes.chunks_mut(size));
        let queue = Queue::new(parts.enumerate().map(|(part, (networks, outcomes))| {
            let numbers = part * size..part * size + networks.len();
            numbers.zip(networks.iter_mut().zip(outcomes))
        }));
        let help = |number: usize, helper: &mut Helper| {
            helper.made.clear();
            while let Some((network, (solver, outcome))) = queue.take(number + 1) {
                let (implicit, next) = (&mut helper.implicit, &mut helper.next);
                *outcome = Some(self.network_alone(network, solver, implicit, next));
                helper.made.push(network);
            }
        };
        let lead = || {
            while let Some((network, (solver, outcome))) = queue.take(0) {
                *outcome = Some(self.network_alone(network, solver, implicit, next));
            }
        };
        crew.run(helpers, help, lead);
        for helper in helpers {
            let helper = &mut *lock(helper);
            self.exchange(helper.made.drain(..), next, &mut helper.next);
        }
    }

    /// Exchanges networks between two states.
    fn exchange(&self, networks: impl Iterator<Item = usize>, one: &mut State, other: &mut State) {
        for number in networks {
            let network = &self.model.networks[number];
            for &line in &network.lines {
                std::mem::swap(&mut one.lines[line], &mut other.lines[line]);
            }
            for &point in &network.free_points {
                std::mem::swap(&mut one.points[point], &mut other.points[point]);
            }
        }
    }

    /// What one network does over the step.
    fn network_alone(
        &self,
        number: usize,
        network: &mut (Choice, Solver),
        implicit: &mut elements::Workspace,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let mut done = Done::default();
        self.network(number, network, implicit, next, &mut done)?;
        Ok(done)
    }
}
