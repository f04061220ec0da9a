//! Verdicts of a study at a level of error: the codes that reach it, their costs, and the errors at which a peer is cheaper.

use crate::errors::Metric;
use crate::{Code, Run, Study, TOLERANCES};

/// Error levels of the verdicts [-].
pub const LEVELS: [f64; 5] = [0.05, 0.03, 0.02, 0.01, 0.005];
/// Level that moorline is held to offline on a seabed [-].
const LEVEL: f64 = 0.03;
/// Error beyond which a run is meaningless [-].
const ERROR_MAX: f64 = 1.0;

/// Cheapest runs that reach an error level.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict<'a> {
    /// Quantity that is compared.
    pub metric: Metric,
    /// Error level [-].
    pub level: f64,
    /// True if moorline is held to this level: 3 % of RMS tension and 1 % in position; without a seabed, also 1 % of RMS tension; in a host, the
    /// tolerances of its default settings, of RMS tension. The low-passed tension replaces the raw one at levels at which only the former is certain.
    pub key: bool,
    /// True if the converged solution is certain enough to judge this level.
    pub certain: bool,
    /// moorline's cheapest run.
    pub own: Option<&'a Run>,
    /// Every peer's cheapest run, if it has one.
    pub peers: Vec<(&'a str, Option<&'a Run>)>,
}

impl<'a> Verdict<'a> {
    /// The cheaper of the peers' runs.
    pub fn best_peer(&self) -> Option<&'a Run> {
        let runs = self.peers.iter().filter_map(|(_, run)| *run);
        runs.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// Cost of the better peer over moorline's [-].
    pub fn ratio(&self) -> Option<f64> {
        Some(self.best_peer()?.cost / self.own?.cost)
    }

    /// Least and greatest ratio [-] that the timings of both runs allow.
    pub fn ratio_range(&self) -> Option<[f64; 2]> {
        let ([own_min, own_max], [peer_min, peer_max]) = (self.own?.spread(), self.best_peer()?.spread());
        Some([peer_min / own_max, peer_max / own_min])
    }
}

/// A peer's run on its frontier, and moorline's cheapest run with no greater error.
#[derive(Debug, Clone, PartialEq)]
pub struct Duel<'a> {
    /// Quantity that is compared.
    pub metric: Metric,
    /// The peer's error, or the converged solution's uncertainty if that is greater [-].
    pub level: f64,
    /// moorline's run, if it has one.
    pub own: Option<&'a Run>,
    /// The peer's run.
    pub peer: &'a Run,
}

impl Duel<'_> {
    /// Cost of the peer over moorline's [-]; 0 if moorline does not reach the level.
    pub fn ratio(&self) -> f64 {
        self.own.map_or(0.0, |own| self.peer.cost / own.cost)
    }
}

impl Study {
    /// Verdicts at all levels, metric by metric.
    pub fn verdicts(&self) -> Vec<Verdict<'_>> {
        let of_metric = |metric: Metric| LEVELS.map(|level| self.verdict(metric, level));
        Metric::ALL.into_iter().flat_map(of_metric).collect()
    }

    /// Metric of the tension at 3 %.
    pub fn tension_metric(&self) -> Metric {
        self.tension_metric_at(LEVEL)
    }

    /// Metric of the tension at a level [-]: RMS of the raw tension, or of the low-passed one if only that is certain.
    fn tension_metric_at(&self, level: f64) -> Metric {
        let is_certain = |metric: Metric| level >= self.uncertainty.of(metric);
        match is_certain(Metric::LowPassed) && !is_certain(Metric::Rms) {
            true => Metric::LowPassed,
            false => Metric::Rms,
        }
    }

    /// Returns the verdict at a level [-].
    pub fn verdict(&self, metric: Metric, level: f64) -> Verdict<'_> {
        let of_peer = |name| {
            let its_runs = move |code: &Code| matches!(code, Code::Peer(peer) if peer == name);
            (name, self.cheapest(metric, level, its_runs))
        };
        let holds_tension = match self.host_step {
            Some(_) => TOLERANCES.contains(&level),
            None => level == LEVEL || (level == 0.01 && !self.on_seabed),
        };
        Verdict {
            metric,
            level,
            key: match metric {
                Metric::Rms | Metric::LowPassed => holds_tension && metric == self.tension_metric_at(level),
                Metric::Position => self.host_step.is_none() && level == 0.01,
                Metric::Peak => false,
            },
            certain: level >= self.uncertainty.of(metric),
            own: self.cheapest(metric, level, Code::is_own),
            peers: self.peers().into_iter().map(of_peer).collect(),
        }
    }

    /// Compares every run on a peer's frontier with moorline: since cost is a step function of the error, a peer is cheaper somewhere if and only if
    /// it is cheaper at one of these runs.
    pub fn duels<'a>(&'a self, metric: Metric) -> Vec<Duel<'a>> {
        let of_peer = |name: &str| {
            let its_runs = |code: &Code| matches!(code, Code::Peer(peer) if peer == name);
            self.frontier(metric, its_runs)
        };
        let runs = self.peers().into_iter().flat_map(of_peer);
        let runs = runs.filter(|run| run.errors.of(metric) <= ERROR_MAX);
        let duel = |peer: &'a Run| {
            let level = peer.errors.of(metric).max(self.uncertainty.of(metric));
            Duel {
                metric,
                level,
                own: self.cheapest(metric, level, Code::is_own),
                peer,
            }
        };
        runs.map(duel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::errors::Errors;
    use super::super::tests::{own, peer, study_of};
    use super::*;

    #[test]
    fn a_verdict_sets_the_cheaper_peer_against_the_cheapest_own_run() {
        let study = study_of(vec![
            own(1.0, 0.02),
            own(4.0, 0.004),
            peer("A", 40.0, 0.03),
            peer("B", 30.0, 0.025),
            peer("A", 100.0, 0.01),
        ]);
        let verdict = study.verdict(Metric::Rms, 0.03);
        assert!(verdict.key && verdict.certain);
        assert_eq!(verdict.ratio(), Some(30.0));
        assert_eq!(study.verdict(Metric::Rms, 0.01).ratio(), Some(25.0));
        assert_eq!(study.verdict(Metric::Rms, 0.005).ratio(), None);
        assert_eq!(study.verdicts().len(), 20);
    }

    #[test]
    fn a_peer_that_is_cheaper_at_one_level_alone_is_found() {
        let study = study_of(vec![
            own(1.0, 0.02),
            own(9.0, 0.004),
            peer("A", 7.0, 0.015),
            peer("A", 90.0, 0.003),
        ]);
        let ratios: Vec<f64> = study.duels(Metric::Rms).iter().map(Duel::ratio).collect();
        // At 1.5 % moorline needs its costly run; at 0.3 % it has none.
        assert_eq!(ratios, [7.0 / 9.0, 0.0]);
    }

    #[test]
    fn what_a_peer_reaches_within_the_uncertainty_counts_as_the_uncertainty() {
        let mut study = study_of(vec![own(1.0, 0.009), peer("A", 50.0, 0.001)]);
        study.uncertainty = Errors::all(0.01);
        assert_eq!(study.duels(Metric::Rms)[0].ratio(), 50.0);
        assert!(!study.verdict(Metric::Rms, 0.005).certain);
    }

    #[test]
    fn the_low_passed_tension_counts_where_the_raw_one_is_uncertain() {
        let mut study = study_of(vec![own(1.0, 0.02), peer("A", 50.0, 0.02)]);
        let keys =
            |study: &Study| [Metric::Rms, Metric::LowPassed].map(|metric| study.verdict(metric, 0.03).key);
        assert_eq!(keys(&study), [true, false]);
        study.uncertainty = Errors::new([0.07, 0.003, 0.1, 0.05]);
        assert_eq!(keys(&study), [false, true]);
        study.uncertainty = Errors::all(0.07);
        assert_eq!(keys(&study), [true, false]);
    }
}
