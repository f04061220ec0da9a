//! Speed against error: a scene run with a ladder of meshes, integrators and steps, each judged against a converged solution.
//!
//! Cost is processor time of the stepping thread per simulated second, without reading, statics and output; the median of a few
//! repetitions where a run is short. Errors are those of [`errors`], over the second half of the run. The converged solution's
//! own uncertainty is its distance from one of half its resolution: nothing below that is a statement.
//!
//! With peers, all codes solve the peers' equations, damping that acts in compression too
//! ([`crate::scene::Solver::negative_tension`]).

pub mod errors;
mod ladder;
mod peers;
mod timed;

use crate::scene::{Integrator, MotionPath, Scene};

pub use errors::{Errors, Histories, Judge, Metric};
pub use ladder::{Setting, TOLERANCES};
pub use peers::{PeerError, Peers};
use timed::{Timed, run};

/// Cut-off of the low-passed tension over the frequency of the fastest motion [-].
const CUT_OFF: f64 = 5.0;
/// Shortest period taken where the scene's motion is a table, or nothing moves [s].
const PERIOD: f64 = 10.0;

/// Who computed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Code {
    /// moorline with this integrator.
    Own(Integrator),
    /// moorline with what it chose itself.
    Chosen,
    /// Another code, by name.
    Peer(String),
}

impl Code {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Code::Chosen => "moorline, its own choice",
            Code::Own(Integrator::Leapfrog) => "moorline, leapfrog",
            Code::Own(Integrator::AxialImplicit) => "moorline, axial-implicit",
            Code::Own(Integrator::QuasiStatic) => "moorline, quasi-static",
            Code::Own(Integrator::Beam) => "moorline, beam",
            Code::Own(_) => "moorline, implicit",
            Code::Peer(name) => name,
        }
    }

    /// Whether it is moorline.
    pub fn is_own(&self) -> bool {
        !matches!(self, Code::Peer(_))
    }
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Who computed.
    pub code: Code,
    /// Mesh and step, in words.
    pub label: String,
    /// Processor time over simulated time [-].
    pub cost: f64,
    /// Against the converged solution.
    pub errors: Errors,
}

/// A run that gave no result, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failed {
    /// Who, with mesh and step.
    pub label: String,
    /// What it said.
    pub reason: String,
}

/// Speed against error of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Name of the scene.
    pub name: String,
    /// Title of the scene.
    pub title: String,
    /// Whether damping acts in compression, the peers' law.
    pub negative_tension: bool,
    /// Mesh and step of the converged solution, in words.
    pub converged: String,
    /// Its distance from one of half its resolution.
    pub uncertainty: Errors,
    /// All runs.
    pub runs: Vec<Run>,
    /// Runs without a result.
    pub failed: Vec<Failed>,
}

/// Why a scene cannot be studied.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// Nothing serves for a converged solution.
    #[error("no converged solution of {name}: {reason}")]
    NotConverged {
        /// The scene.
        name: String,
        /// What the last attempt said.
        reason: String,
    },
    /// Nothing happens in it.
    #[error(
        "{name}: nothing moves in it, so that there is no error of a history to judge; give it a motion"
    )]
    AtRest {
        /// The scene.
        name: String,
    },
}

/// Runs the ladder of a scene; `progress` is told how many runs are done, of how many.
///
/// # Errors
/// Where no converged solution can be had. Single runs that fail are listed in the study.
pub fn study(
    name: &str,
    scene: &Scene,
    peers: Option<&Peers>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Study, StudyError> {
    let mut scene = scene.clone();
    scene.solver.negative_tension |= peers.is_some();
    let period = shortest_period(&scene);
    let settings = ladder::ladder(period);
    let total = settings.len() + 2 + usize::from(peers.is_some());
    let (setting, converged, coarser) = converged(name, &scene, period)?;
    progress(2, total);
    let judge = judge(&scene, period, &converged.histories);
    let mut study = Study {
        name: name.to_string(),
        title: scene.title.clone(),
        negative_tension: scene.solver.negative_tension,
        converged: label(&setting, &converged),
        uncertainty: judge.errors(&coarser.histories, &converged.histories),
        runs: Vec::new(),
        failed: Vec::new(),
    };
    for (index, setting) in settings.iter().enumerate() {
        study.add(setting, run(&setting.apply(&scene)), &judge, &converged);
        progress(index + 3, total);
    }
    if let Some(peers) = peers {
        peers.add_runs(&scene, &judge, &converged.histories, &mut study);
        progress(total, total);
    }
    Ok(study)
}

/// The converged solution: its setting, itself, and the coarser one that judges it.
fn converged(
    name: &str,
    scene: &Scene,
    period: f64,
) -> Result<(Setting, Timed, Timed), StudyError> {
    let mut reason = String::new();
    for [fine, coarse] in ladder::converged(period) {
        match (run(&fine.apply(scene)), run(&coarse.apply(scene))) {
            (Ok(converged), Ok(coarser)) => {
                if !converged.moves() {
                    return Err(StudyError::AtRest {
                        name: name.to_string(),
                    });
                }
                return Ok((fine, converged, coarser));
            }
            (Err(said), _) | (_, Err(said)) => reason = said,
        }
    }
    Err(StudyError::NotConverged {
        name: name.to_string(),
        reason,
    })
}

impl Study {
    fn add(
        &mut self,
        setting: &Setting,
        outcome: Result<Timed, String>,
        judge: &Judge,
        converged: &Timed,
    ) {
        match outcome {
            Ok(timed) => self.runs.push(Run {
                code: match setting.integrator {
                    Integrator::Auto => Code::Chosen,
                    integrator => Code::Own(integrator),
                },
                label: label(setting, &timed),
                cost: timed.cost,
                errors: judge.errors(&timed.histories, &converged.histories),
            }),
            Err(reason) => self.failed.push(Failed {
                label: described(setting),
                reason,
            }),
        }
    }

    /// The cheapest run among those that `codes` admits whose error is at most `level` [-].
    pub fn cheapest(
        &self,
        metric: Metric,
        level: f64,
        codes: impl Fn(&Code) -> bool,
    ) -> Option<&Run> {
        let good = self.runs.iter().filter(|run| codes(&run.code));
        let good = good.filter(|run| run.errors.of(metric) <= level);
        good.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// Runs of a code that none of its other runs beats in both cost and error, from the cheapest on.
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

/// Mesh and step of a run, in words.
fn label(setting: &Setting, timed: &Timed) -> String {
    let step = format!("step {}", seconds(timed.step));
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

/// A setting in words, before it has run.
fn described(setting: &Setting) -> String {
    let code = match setting.integrator {
        Integrator::Auto => Code::Chosen,
        integrator => Code::Own(integrator),
    };
    let elements = setting
        .elements
        .map_or(String::new(), |n| format!(", n = {n}"));
    let step = setting.time_step_max.map(seconds);
    let step = step.map_or(String::new(), |step| format!(", step {step}"));
    format!("{}{elements}{step}", code.name())
}

/// A time [s] in the multiple of the second that fits.
fn seconds(time: f64) -> String {
    match time {
        t if t >= 0.1 => format!("{t:.2} s"),
        t if t >= 1e-3 => format!("{:.3} ms", 1e3 * t),
        t => format!("{:.2} µs", 1e6 * t),
    }
}

fn judge(scene: &Scene, period: f64, converged: &Histories) -> Judge {
    let samples = converged.tension.first().map_or(0, Vec::len);
    Judge {
        interval: scene.output.interval,
        from: samples / 2,
        cut_off: CUT_OFF / period,
    }
}

/// The shortest period [s] with which anything moves.
fn shortest_period(scene: &Scene) -> f64 {
    let own = scene
        .points
        .iter()
        .filter_map(|point| point.motion.as_ref());
    let paths = scene.motion.values().chain(own);
    let periods = paths.filter_map(|path| match path {
        MotionPath::Harmonic(motion) => Some(motion),
        _ => None,
    });
    let shortest = periods
        .flat_map(|motion| motion.axes().map(|(_, sines)| sines.clone()))
        .flatten()
        .map(|sine| sine[1])
        .fold(f64::INFINITY, f64::min);
    if shortest.is_finite() {
        shortest
    } else {
        PERIOD
    }
}
