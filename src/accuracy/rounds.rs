//! Timing again, own runs and peers' in turn, what the verdicts rest on.
//!
//! A cheapest run is the least of many timings and so the luckiest; and what shares the machine changes from minute to minute. Every run
//! that a verdict or the tool's own choice names is therefore timed in several rounds, each of which takes moorline and peers in turn.
//! Its cost is the least of its rounds, its spread their range.

use super::ladder::Setting;
use super::peers::Conversation;
use super::timed::Trial;
use super::{Code, How, Study};
use crate::scene::Scene;

/// Timings of a run that a verdict names [-].
const ROUNDS: usize = 3;
/// Passes over the named runs at most [-]: a new timing may make another run the cheapest.
const PASSES_MAX: usize = 8;

impl Study {
    /// Times in rounds what the verdicts name.
    pub(super) fn settle(&mut self, scene: &Scene, mut peers: Option<&mut Conversation>) {
        for _ in 0..PASSES_MAX {
            let open = self.unsettled();
            if open.is_empty() {
                return;
            }
            for index in open {
                let cost = match &self.runs[index].how {
                    How::Own(setting) => timed_again(scene, setting),
                    How::Peer(number) => peers.as_mut().and_then(|peers| peers.time(*number)),
                };
                // A run that cannot be repeated keeps the cost it has.
                let run = &mut self.runs[index];
                let cost = cost.unwrap_or(run.cost);
                run.costs.push(cost);
                run.cost = run.cost.min(cost);
            }
        }
    }

    /// Indices of the runs that the verdicts name and that were timed in fewer than all rounds: moorline's and the peers' next to
    /// one another.
    fn unsettled(&self) -> Vec<usize> {
        let mut named = Vec::new();
        for verdict in self.verdicts() {
            named.extend(verdict.own);
            named.extend(verdict.peers.iter().filter_map(|(_, run)| *run));
        }
        named.extend(self.runs.iter().filter(|run| run.code == Code::Chosen));
        let mut indices = Vec::new();
        for run in named {
            let index = self.runs.iter().position(|other| std::ptr::eq(run, other));
            let index = index.filter(|index| !indices.contains(index));
            indices.extend(index.filter(|_| run.costs.len() < ROUNDS));
        }
        indices
    }
}

fn timed_again(scene: &Scene, setting: &Setting) -> Option<f64> {
    Trial::new(scene, setting).ok()?.cost().ok()
}
