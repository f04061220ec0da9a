//! Repeated timing of moorline's and the peers' runs alternately, as the basis of the verdicts.
//!
//! The cost of a cheapest run is the least of many timings and therefore biased low, and the load of the machine changes from minute to minute. Every
//! run named by a verdict or with default settings is therefore timed in several rounds, each of which takes moorline and peers alternately. The cost
//! is the least of the rounds, and the spread is their range. A run that was slowed down in its first timing is not named; at the levels that
//! moorline is held to, runs that cost little more than the cheapest of their code are therefore timed in rounds too.

use moorline::scene::Scene;

use crate::errors::Metric;
use crate::in_host::Hosted;
use crate::peers::Conversation;
use crate::timed::Trial;
use crate::{Code, How, Run, Study};

/// Number of timings of a run that a verdict names [-].
const ROUNDS: usize = 3;
/// Greatest number of passes over the named runs [-]: a new timing may make another run the cheapest.
const PASSES_MAX: usize = 8;
/// Ratio of a run's cost to that of the cheapest of its code up to which it might be the cheapest itself [-].
const CONTENDER_COST: f64 = 1.5;

/// Data needed to time the runs of a study again.
pub(crate) struct Repeat<'a> {
    pub scene: &'a Scene,
    pub hosted: &'a [Hosted],
    pub peers: Option<&'a mut Conversation>,
}

impl Repeat<'_> {
    /// Processor time of a run over simulated time [-]; `None` if it cannot be repeated.
    fn cost(&mut self, how: &How) -> Option<f64> {
        match how {
            How::Own(setting) => Trial::new(self.scene, setting).ok()?.cost().ok(),
            How::InHost(number) => self.hosted.get(*number)?.cost().ok(),
            How::Peer(number) => self.peers.as_mut()?.time(*number),
            How::Read => None,
        }
    }
}

impl Study {
    /// Times the runs that the verdicts name in rounds.
    pub(crate) fn settle(&mut self, mut repeat: Repeat<'_>) {
        for _ in 0..PASSES_MAX {
            let open = self.unsettled();
            if open.is_empty() {
                return;
            }
            for index in open {
                let cost = repeat.cost(&self.runs[index].how);
                // A run that cannot be repeated keeps its cost.
                let run = &mut self.runs[index];
                let cost = cost.unwrap_or(run.cost);
                run.costs.push(cost);
                run.cost = run.cost.min(cost);
            }
        }
    }

    /// Indices of the runs that are named by the verdicts and were timed in fewer than all rounds, with moorline's and the peers' next to one
    /// another.
    fn unsettled(&self) -> Vec<usize> {
        let mut named = Vec::new();
        for verdict in self.verdicts() {
            let peers = verdict.peers.iter().filter_map(|(_, run)| *run);
            for run in verdict.own.into_iter().chain(peers) {
                named.push(run);
                if verdict.key {
                    named.extend(self.contenders(run, verdict.metric, verdict.level));
                }
            }
        }
        named.extend(self.runs.iter().filter(|run| run.tolerance.is_some()));
        let mut indices = Vec::new();
        for run in named {
            let index = self.runs.iter().position(|other| std::ptr::eq(run, other));
            let index = index.filter(|index| !indices.contains(index));
            indices.extend(index.filter(|_| run.costs.len() < ROUNDS));
        }
        indices
    }

    /// Returns the runs of the same code as a given one that also reach a level [-] of a metric, at little more than its cost: after another timing
    /// they might be the cheapest.
    fn contenders(&self, of: &Run, metric: Metric, level: f64) -> impl Iterator<Item = &Run> {
        let (code, most) = (of.code.clone(), CONTENDER_COST * of.cost);
        let alike = move |other: &Code| match &code {
            Code::Peer(_) => *other == code,
            _ => other.is_own(),
        };
        self.within(metric, level, alike)
            .filter(move |run| run.cost <= most)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{own, peer, study_of};

    #[test]
    fn what_costs_little_more_than_the_cheapest_is_timed_in_rounds_too() {
        let study = study_of(vec![
            own(1.0, 0.02),
            own(1.4, 0.001), // the cheapest at finer levels, and perhaps here
            own(1.6, 0.02),
            peer("A", 30.0, 0.02),
            peer("A", 40.0, 0.02),
            peer("A", 50.0, 0.02),
            peer("B", 41.0, 0.02),
        ]);
        let mut open = study.unsettled();
        open.sort_unstable();
        assert_eq!(open, [0, 1, 3, 4, 6]);
    }
}
