//! Speed against error: a scene is run with many meshes, integrators and steps, and each run is compared with a converged solution.
//!
//! Cost is processor time of the stepping thread per simulated second, without reading, statics and output. moorline is driven like the peers: a host
//! gives position and velocity of the fairlead in every communication step. The runs that the verdicts name are timed in several rounds, moorline's
//! and the peers' alternately. Errors are those of [`errors`], over the second half of the run. The converged solution is the best of a sequence of
//! fine meshes, and its uncertainty is the distance from the one with half its resolution: smaller errors are not meaningful.
//!
//! With peers, all codes solve the peers' equations, in which damping also acts in compression ([`moorline::scene::Solver::negative_tension`]), and
//! none computes an energy balance.

#![forbid(unsafe_code)]

mod converged;
pub mod errors;
pub mod frontier;
mod in_host;
mod ladder;
mod peers;
mod rounds;
mod slow;
mod system;
pub mod tables;
mod timed;
mod verdict;

use moorline::scene::{ContactLaw, Integrator, Scene};

use converged::Converged;
pub use errors::{Errors, Histories, Judge, Metric};
pub use in_host::Package;
pub use ladder::{HOST_STEPS, Setting, TOLERANCES};
use peers::Conversation;
pub use peers::{PeerError, Peers};
use rounds::Repeat;
pub use slow::Slow;
use timed::{Timed, Trial, run};
pub use verdict::{Duel, LEVELS, Verdict};

/// Integrators of moorline that are studied.
pub const INTEGRATORS: [Integrator; 4] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
    Integrator::QuasiStatic,
];

/// Code that computed a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Code {
    /// moorline with this integrator.
    Own(Integrator),
    /// moorline with default settings.
    ByDefault,
    /// Another code, by name.
    Peer(String),
}

impl Code {
    /// Name of the code.
    pub fn name(&self) -> &str {
        match self {
            Code::ByDefault => "moorline, default settings",
            Code::Own(Integrator::Leapfrog) => "moorline, leapfrog",
            Code::Own(Integrator::AxialImplicit) => "moorline, axial-implicit",
            Code::Own(Integrator::QuasiStatic) => "moorline, quasi-static",
            Code::Own(Integrator::Beam) => "moorline, beam",
            Code::Own(_) => "moorline, implicit",
            Code::Peer(name) => name,
        }
    }

    /// Returns the code with this name; a peer if it is not one of moorline's.
    pub fn named(name: &str) -> Code {
        let own = INTEGRATORS.into_iter().chain([Integrator::Beam]).map(Code::Own);
        let found = own.chain([Code::ByDefault]).find(|code| code.name() == name);
        found.unwrap_or_else(|| Code::Peer(name.to_string()))
    }

    /// Returns whether the code is moorline.
    pub fn is_own(&self) -> bool {
        !matches!(self, Code::Peer(_))
    }
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Code that computed a run.
    pub code: Code,
    /// Mesh and step, in words.
    pub label: String,
    /// Processor time over simulated time [-], the least of its timings.
    pub cost: f64,
    /// Errors against the converged solution.
    pub errors: Errors,
    /// Target error of moorline's default settings [-].
    pub tolerance: Option<f64>,
    /// Elements of a peer with the settings of its decks [-].
    pub deck: Option<usize>,
    /// All timings.
    costs: Vec<f64>,
    how: How,
}

/// Means to repeat a run.
#[derive(Debug, Clone, PartialEq)]
enum How {
    Own(Setting),
    /// By its index among the FMUs in a host.
    InHost(usize),
    /// By its index among the runs planned for the peers.
    Peer(usize),
    /// Not possible: the run was read from a table.
    Read,
}

impl Run {
    fn new(code: Code, label: String, cost: f64, errors: Errors, how: How) -> Run {
        Run {
            code,
            label,
            cost,
            errors,
            tolerance: None,
            deck: None,
            costs: vec![cost],
            how,
        }
    }

    /// Least and greatest of the timings, over simulated time [-].
    pub fn spread(&self) -> [f64; 2] {
        let ends = |[least, greatest]: [f64; 2], cost: &f64| [least.min(*cost), greatest.max(*cost)];
        self.costs.iter().fold([self.cost; 2], ends)
    }
}

/// Run without a result, and the reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failed {
    /// Code, mesh and step.
    pub label: String,
    /// Message of the failure.
    pub reason: String,
}

/// Speed against error of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Name of the scene.
    pub name: String,
    /// Title of the scene.
    pub title: String,
    /// Communication step of the host [s]; `None` for an offline study.
    pub host_step: Option<f64>,
    /// True if damping acts in compression, as in the peers' law.
    pub negative_tension: bool,
    /// True if the scene has a seabed.
    pub on_seabed: bool,
    /// Mesh and step of the converged solution, in words.
    pub converged: String,
    /// Distance of the converged solution from one with half its resolution.
    pub uncertainty: Errors,
    /// All runs.
    pub runs: Vec<Run>,
    /// Runs without a result.
    pub failed: Vec<Failed>,
    /// Errors of the quasi-static mode in the scene's motion and slower ones.
    pub slow: Vec<Slow>,
}

/// Reason why a scene cannot be studied.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// No family of settings gives a converged solution.
    #[error("no converged solution of {name}: {reason}")]
    NotConverged {
        /// The scene.
        name: String,
        /// Message of the last attempt.
        reason: String,
    },
    /// Nothing moves in the scene.
    #[error("{name}: nothing moves in it, so that there is no error of a history to judge; give it a motion")]
    AtRest {
        /// The scene.
        name: String,
    },
}

/// Optional means of a study.
#[derive(Clone, Copy, Default)]
pub struct Means<'a> {
    /// The peers.
    pub peers: Option<&'a Peers>,
    /// Packages scenes as FMUs, for studies in a host.
    pub package: Option<&'a Package<'a>>,
}

/// Studies a scene offline and, if it can be packaged, in hosts; the offline study comes first. `progress` is called with the number of finished runs and
/// with the total.
///
/// # Errors
/// No converged solution can be found. Single runs that fail are listed in the study.
pub fn study(
    name: &str,
    scene: &Scene,
    means: &Means<'_>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Vec<Study>, StudyError> {
    let mut scene = scene.clone();
    scene.solver.negative_tension |= means.peers.is_some();
    let (mut conversation, refused) = match means.peers.map(|peers| peers.begin(name, &scene)) {
        Some(Ok(conversation)) => (Some(conversation), None),
        Some(Err(reason)) => (None, Some(reason)),
        None => (None, None),
    };
    let case = Case {
        settings: ladder::ladder(&scene, scene.shortest_period()),
        package: means.package.filter(|_| !ladder::is_quasi_static(&scene)),
        scene,
    };
    let counts = case.places().map(|place| {
        let of_peers = conversation.as_ref().map_or(0, |peers| peers.count(place));
        (place, case.count(place) + of_peers)
    });
    let counts: Vec<(Option<f64>, usize)> = counts.collect();
    // The converged solution takes much of the time, and so does repeated timing.
    let mut before = case.settings.len() / 4;
    let with_rounds = |runs: usize| runs + runs / 8 + 1;
    let total = before + counts.iter().map(|(_, runs)| with_rounds(*runs)).sum::<usize>();
    progress(0, total);
    let converged = Converged::find(name, &case.scene)?;
    let mut studies = Vec::new();
    for (place, runs) in counts {
        let mut study = Study::new((name, place), &case.scene, &converged);
        study.failed.extend(refused.iter().map(|reason| Failed {
            label: "peers".to_string(),
            reason: reason.clone(),
        }));
        let mut told = |done| progress(before + done, total);
        told(0);
        study.run(&case, &converged, conversation.as_mut(), &mut told);
        before += with_rounds(runs);
        studies.push(study);
    }
    progress(total, total);
    Ok(studies)
}

/// Data that all studies of a scene share.
struct Case<'a> {
    scene: Scene,
    /// Settings of the offline study.
    settings: Vec<Setting>,
    package: Option<&'a Package<'a>>,
}

impl Case<'_> {
    /// Returns `None` for the offline study, then the communication step of each host [s].
    fn places(&self) -> impl Iterator<Item = Option<f64>> + use<'_> {
        let hosts = HOST_STEPS.into_iter().filter(|_| self.package.is_some());
        std::iter::once(None).chain(hosts.map(Some))
    }

    /// Returns the scene with default settings for every tolerance, selected with the communication step of the host [s] as its interval.
    fn by_default(&self, step: f64) -> [Scene; TOLERANCES.len()] {
        let mut stated = self.scene.clone();
        stated.output.interval = step;
        TOLERANCES.map(|tolerance| {
            let mut chosen = Setting::by_default(tolerance).apply(&stated);
            chosen.output.interval = self.scene.output.interval; // interval of the samples
            chosen
        })
    }

    /// Number of moorline's runs.
    fn count(&self, host_step: Option<f64>) -> usize {
        host_step.map_or(self.settings.len(), |_| TOLERANCES.len())
    }
}

/// Distance of the converged solution of a scene from one with half its resolution.
///
/// # Errors
/// There is no converged solution.
pub fn uncertainty(name: &str, scene: &Scene) -> Result<Errors, StudyError> {
    Converged::find(name, scene).map(|converged| converged.uncertainty)
}

impl Study {
    /// Creates a study without runs, offline or in a host with a communication step [s].
    fn new((name, host_step): (&str, Option<f64>), scene: &Scene, converged: &Converged) -> Study {
        let on_seabed = scene.seabed.is_some();
        Study {
            name: name.to_string(),
            title: scene.title.clone(),
            host_step,
            negative_tension: scene.solver.negative_tension,
            on_seabed,
            converged: label(&converged.setting, &converged.fine, on_seabed),
            uncertainty: converged.uncertainty,
            runs: Vec::new(),
            failed: Vec::new(),
            slow: match host_step.is_some() || ladder::is_quasi_static(scene) {
                true => Vec::new(),
                false => slow::slow(scene),
            },
        }
    }

    /// Runs moorline and the peers, and times the runs that the verdicts name in rounds; `done` is called with the number of finished runs.
    fn run(
        &mut self,
        case: &Case<'_>,
        converged: &Converged,
        mut peers: Option<&mut Conversation>,
        done: &mut dyn FnMut(usize),
    ) {
        let mut hosted = Vec::new();
        match (self.host_step, case.package) {
            (Some(step), Some(package)) => {
                hosted = self.run_in_host((&case.by_default(step), step), package, converged, done);
            }
            _ => self.climb(&case.scene, &case.settings, converged, done),
        }
        if let Some(peers) = &mut peers {
            let own = case.count(self.host_step);
            peers.add_runs(converged, self, &mut |of_peers| done(own + of_peers));
        }
        self.settle(Repeat {
            scene: &case.scene,
            hosted: &hosted,
            peers,
        });
    }

    /// Runs all settings except those equivalent to an earlier one.
    fn climb(
        &mut self,
        scene: &Scene,
        settings: &[Setting],
        converged: &Converged,
        done: &mut dyn FnMut(usize),
    ) {
        let mut plans = Vec::new();
        for (index, setting) in settings.iter().enumerate() {
            let trial = Trial::new(scene, setting);
            if let Ok(trial) = &trial {
                let plan = (
                    setting.elements,
                    setting.communication,
                    setting.contact,
                    trial.plan(),
                );
                if plans.contains(&plan) {
                    continue;
                }
                plans.push(plan);
            }
            match trial.and_then(|trial| run(&trial)) {
                Ok(timed) => self.runs.push(Run::new(
                    code(setting),
                    label(setting, &timed, self.on_seabed),
                    timed.cost,
                    converged.errors(&timed.histories),
                    How::Own(*setting),
                )),
                Err(reason) => self.failed.push(Failed {
                    label: described(setting),
                    reason,
                }),
            }
            done(index + 1);
        }
    }

    /// Name of the scene, and the host's communication step.
    pub fn place(&self) -> String {
        match self.host_step {
            Some(step) => format!("{}, {step} s", self.name),
            None => self.name.clone(),
        }
    }

    /// Returns the cheapest run of the codes that `codes` admits with an error of at most `level` [-].
    pub fn cheapest(&self, metric: Metric, level: f64, codes: impl Fn(&Code) -> bool) -> Option<&Run> {
        let good = self.within(metric, level, codes);
        good.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// Returns the runs of the codes that `codes` admits with an error of at most `level` [-].
    fn within(
        &self,
        metric: Metric,
        level: f64,
        codes: impl Fn(&Code) -> bool,
    ) -> impl Iterator<Item = &Run> {
        let good = self.runs.iter().filter(move |run| codes(&run.code));
        good.filter(move |run| run.errors.of(metric) <= level)
    }

    /// Returns the runs of the codes that `codes` admits that no other of these runs beats in both cost and error, in order of cost.
    pub fn frontier(&self, metric: Metric, codes: impl Fn(&Code) -> bool) -> Vec<&Run> {
        let mut runs: Vec<&Run> = self.runs.iter().filter(|run| codes(&run.code)).collect();
        runs.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let mut best = f64::INFINITY;
        runs.retain(|run| {
            let better = run.errors.of(metric) < best;
            best = best.min(run.errors.of(metric));
            better
        });
        runs
    }

    /// Names of the peers that have a run.
    pub fn peers(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for run in &self.runs {
            if let Code::Peer(name) = &run.code
                && !names.contains(&name.as_str())
            {
                names.push(name);
            }
        }
        names
    }
}

/// Code that computes with a setting.
fn code(setting: &Setting) -> Code {
    match setting.integrator {
        Integrator::Auto => Code::ByDefault,
        integrator => Code::Own(integrator),
    }
}

/// Mesh and step of a run in words, with the treatment of the seabed if there is one.
fn label(setting: &Setting, timed: &Timed, on_seabed: bool) -> String {
    let communication = timed.communication.filter(|_| setting.tolerance.is_none());
    let communication = communication.map_or(String::new(), |step| {
        format!(", communication step {}", seconds(step))
    });
    let seabed = match setting.contact {
        Some(ContactLaw::AsGiven) if on_seabed => ", seabed as given",
        _ => "",
    };
    let step = format!("step {}{communication}{seabed}", seconds(timed.step));
    match setting.tolerance {
        Some(tolerance) => format!(
            "tolerance {} %: {}, n = {}, {step}",
            100.0 * tolerance,
            timed.integrator,
            timed.elements
        ),
        None => format!("n = {}, {step}", timed.elements),
    }
}

/// Describes a setting in words, before its run.
fn described(setting: &Setting) -> String {
    let elements = setting.elements.map_or(String::new(), |n| format!(", n = {n}"));
    let step = setting.time_step_max.map(seconds);
    let step = step.map_or(String::new(), |step| format!(", step {step}"));
    let tolerance = setting.tolerance.map_or(String::new(), |tolerance| {
        format!(", tolerance {} %", 100.0 * tolerance)
    });
    format!("{}{elements}{step}{tolerance}", code(setting).name())
}

/// Text of a time [s] in a suitable multiple of the second.
fn seconds(time: f64) -> String {
    match time {
        t if t >= 0.1 => format!("{t:.2} s"),
        t if t >= 1e-3 => format!("{:.3} ms", 1e3 * t),
        t => format!("{:.2} µs", 1e6 * t),
    }
}

fn judge(scene: &Scene, converged: &Histories) -> Judge {
    let samples = converged.tension.first().map_or(0, Vec::len);
    Judge {
        interval: scene.output.interval,
        from: samples / 2,
        cut_off: scene.cut_off(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Study of these runs with an uncertainty of 0.1 %.
    pub(crate) fn study_of(runs: Vec<Run>) -> Study {
        Study {
            name: "scene".to_string(),
            title: "a scene".to_string(),
            host_step: None,
            negative_tension: true,
            on_seabed: true,
            converged: String::new(),
            uncertainty: Errors::all(0.001),
            runs,
            failed: Vec::new(),
            slow: Vec::new(),
        }
    }

    fn run_of(code: Code, cost: f64, error: f64) -> Run {
        let how = How::Peer(0);
        Run::new(code, format!("at {error}"), cost, Errors::all(error), how)
    }

    /// A run of moorline with the same error [-] by all metrics.
    pub(crate) fn own(cost: f64, error: f64) -> Run {
        run_of(Code::Own(Integrator::Leapfrog), cost, error)
    }

    /// A run of a peer with the same error [-] by all metrics.
    pub(crate) fn peer(name: &str, cost: f64, error: f64) -> Run {
        run_of(Code::Peer(name.to_string()), cost, error)
    }

    #[test]
    fn a_run_is_as_dear_as_its_best_timing_and_shows_its_worst() {
        let mut run = own(3.0, 0.1);
        run.costs.extend([2.0, 5.0]);
        run.cost = 2.0;
        assert_eq!(run.spread(), [2.0, 5.0]);
    }
}
