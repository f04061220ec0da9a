//! The peers MoorDyn and CableDyn, run with the same scene in the same study and on the same core.
//!
//! The Python script `peers.py` drives the peers' packages and exchanges lines of JSON with this module: it reads the scene and writes its list of
//! planned runs, then makes the runs that are requested, with or without reading their results. The list contains each peer's best settings. Times
//! are processor times of the peer's loop alone.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use moorline::scene::Scene;
use nalgebra::Vector3;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::converged::Converged;
use crate::errors::{Errors, Histories, Metric};
use crate::{Code, Failed, How, Run, Study, system};

const SCRIPT: &str = include_str!("../peers.py");
/// Imports all that the script needs, and then prints [`READY`].
const PROBE: &str = "import numpy, cmoordyn, cabledyn; from cabledyn._lib import _lib; cmoordyn.create; cabledyn.CableDyn; print('ready')";
const READY: &str = "ready";

/// Ratio of an error to the least so far below which a finer mesh is an improvement [-].
const PAYS: f64 = 0.95;
/// Number of consecutive meshes without improvement after which their family of settings ends [-].
const IDLE_MAX: usize = 3;

/// A Python interpreter that can import the peers' packages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Peers {
    python: PathBuf,
    /// Path of the script, which starts itself again for every run.
    script: PathBuf,
}

/// Reason why the peers cannot run.
#[derive(Debug, thiserror::Error)]
pub enum PeerError {
    /// The interpreter does not exist.
    #[error("{}: no Python interpreter; give one, or the folder of a virtual environment", .0.display())]
    NoPython(PathBuf),
    /// The interpreter lacks the packages.
    #[error("{}: cannot import moordyn and cabledyn: {said}; install accuracy/peers-requirements.txt there", .python.display())]
    NoPackages {
        /// The interpreter.
        python: PathBuf,
        /// Message of the interpreter.
        said: String,
    },
    /// The script cannot be put into the folder.
    #[error("cannot write {}: {said}", .script.display())]
    NoScript {
        /// The script.
        script: PathBuf,
        /// Message of the operating system.
        said: String,
    },
}

/// First reply of the script.
#[derive(Debug, Deserialize)]
struct Ladder {
    runs: Vec<Planned>,
    left_out: Vec<LeftOut>,
}

/// A peer that cannot run the scene.
#[derive(Debug, Clone, Deserialize)]
struct LeftOut {
    peer: String,
    reason: String,
}

/// Run planned by the script.
#[derive(Debug, Clone, Deserialize)]
struct Planned {
    peer: String,
    label: String,
    /// Family of runs that differ only in their mesh, from coarse to fine.
    family: String,
    /// Communication step of a run in a host [s].
    host: Option<f64>,
    /// Elements of a run with the settings of decks [-].
    deck: Option<usize>,
}

/// Reply of the script for a run.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Answer {
    Run(Measured),
    Failed { failed: String },
}

/// Processor time of a run, and its histories if they are read.
#[derive(Debug, Deserialize)]
struct Measured {
    cpu_seconds: f64,
    /// Tension of every line with a driven end [N].
    #[serde(default)]
    tension: Vec<Vec<f64>>,
    /// Position half-way along every line [m].
    #[serde(default)]
    mid: Vec<Vec<[f64; 3]>>,
}

/// Running script with a scene.
#[derive(Debug)]
pub(crate) struct Conversation {
    child: Child,
    /// `None` after the script was made to end.
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    runs: Vec<Planned>,
    left_out: Vec<LeftOut>,
    simulated: f64,
}

impl Peers {
    /// Finds the peers' packages in an interpreter, or in the virtual environment in a folder; writes their script into `folder`.
    ///
    /// # Errors
    /// There is no interpreter, it lacks the packages, or the script cannot be written.
    pub fn find(place: &Path, folder: &Path) -> Result<Peers, PeerError> {
        let inside = ["bin/python", "Scripts/python.exe"].map(|file| place.join(file));
        let found = inside.into_iter().find(|file| file.is_file());
        let python = found.unwrap_or_else(|| place.to_path_buf());
        let asked = Command::new(&python)
            .args(["-c", PROBE])
            .output()
            .map_err(|_| PeerError::NoPython(python.clone()))?;
        let told = String::from_utf8_lossy(&asked.stdout);
        if !told.lines().any(|line| line == READY) {
            let said = String::from_utf8_lossy(&asked.stderr);
            return Err(match said.lines().last() {
                Some(said) if !asked.status.success() => PeerError::NoPackages {
                    python,
                    said: said.to_string(),
                },
                _ => PeerError::NoPython(python),
            });
        }
        let script = folder.join("peers.py");
        match std::fs::write(&script, SCRIPT) {
            Ok(()) => Ok(Peers { python, script }),
            Err(error) => Err(PeerError::NoScript {
                script,
                said: error.to_string(),
            }),
        }
    }

    /// Starts the script with a scene, and reads its list of planned runs.
    pub(crate) fn begin(&self, name: &str, scene: &Scene) -> Result<Conversation, String> {
        let question = system::described(name, scene)?;
        let mut child = Command::new(&self.python)
            .arg(&self.script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| format!("{}: {error}", self.python.display()))?;
        let input = child.stdin.take();
        let output = child.stdout.take().ok_or("the script has no output")?;
        let mut conversation = Conversation {
            child,
            input,
            output: BufReader::new(output),
            runs: Vec::new(),
            left_out: Vec::new(),
            simulated: scene.output.duration,
        };
        let ladder: Ladder = conversation.ask(&question)?;
        conversation.runs = ladder.runs;
        conversation.left_out = ladder.left_out;
        Ok(conversation)
    }
}

impl Drop for Conversation {
    fn drop(&mut self) {
        drop(self.input.take());
        // The script ends when its input is closed; its exit status is not needed.
        let _ = self.child.wait();
    }
}

/// Progress of a family of settings.
#[derive(Debug, Default)]
struct Family {
    least: Option<[f64; 4]>,
    idle: usize,
}

impl Family {
    fn take(&mut self, errors: &Errors) {
        let errors = Metric::ALL.map(|metric| errors.of(metric));
        let least = self.least.get_or_insert([f64::INFINITY; 4]);
        let mut pays = false;
        for (least, error) in least.iter_mut().zip(errors) {
            pays |= error < PAYS * *least;
            *least = least.min(error);
        }
        self.idle = if pays { 0 } else { self.idle + 1 };
    }
}

impl Conversation {
    /// Number of runs for a host with a communication step [s], or offline.
    pub(crate) fn count(&self, host: Option<f64>) -> usize {
        self.runs.iter().filter(|run| run.host == host).count()
    }

    fn ask<A: DeserializeOwned>(&mut self, question: &Value) -> Result<A, String> {
        let input = self.input.as_mut().ok_or("the script has no input")?;
        writeln!(input, "{question}")
            .and_then(|()| input.flush())
            .map_err(|error| format!("the peers' script has ended: {error}"))?;
        let mut line = String::new();
        let read = self.output.read_line(&mut line);
        read.map_err(|error| error.to_string())?;
        serde_json::from_str(&line).map_err(|error| format!("the peers' script answered {line:.80}: {error}"))
    }

    /// Makes a planned run, with or without its histories.
    fn run(&mut self, number: usize, read: bool) -> Result<Measured, String> {
        match self.ask(&json!({ "run": number, "read": read }))? {
            Answer::Run(measured) => Ok(measured),
            Answer::Failed { failed } => Err(failed),
        }
    }

    /// Makes the runs planned for the host of a study, or offline, and evaluates their errors. A family of settings ends when finer meshes bring no
    /// further improvement; `done` is called with the number of finished runs.
    pub(crate) fn add_runs(&mut self, converged: &Converged, study: &mut Study, done: &mut dyn FnMut(usize)) {
        let mut families: BTreeMap<String, Family> = BTreeMap::new();
        let mut made = 0;
        study.failed.extend(self.left_out.iter().map(|left_out| Failed {
            label: left_out.peer.clone(),
            reason: left_out.reason.clone(),
        }));
        for number in 0..self.runs.len() {
            let planned = self.runs[number].clone();
            let Planned {
                peer,
                label,
                family,
                host,
                deck,
            } = planned;
            let family = families.entry(family).or_default();
            if host != study.host_step || family.idle >= IDLE_MAX {
                continue;
            }
            match self.run(number, true) {
                Ok(measured) => {
                    let middle = |line: Vec<[f64; 3]>| line.into_iter().map(Vector3::from).collect();
                    let histories = Histories {
                        tension: measured.tension,
                        middle: measured.mid.into_iter().map(middle).collect(),
                    };
                    let errors = converged.errors(&histories);
                    family.take(&errors);
                    let cost = measured.cpu_seconds / self.simulated;
                    let run = Run::new(Code::Peer(peer), label, cost, errors, How::Peer(number));
                    study.runs.push(Run { deck, ..run });
                }
                Err(reason) => {
                    let label = format!("{peer}, {label}");
                    study.failed.push(Failed { label, reason });
                }
            }
            made += 1;
            done(made);
        }
    }

    /// Times a planned run again: processor time over simulated time [-]. `None` if it fails.
    pub(crate) fn time(&mut self, number: usize) -> Option<f64> {
        Some(self.run(number, false).ok()?.cpu_seconds / self.simulated)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_ends_where_no_error_falls_any_more() {
        let mut family = Family::default();
        let mut idle = |error: f64| {
            family.take(&Errors::all(error));
            family.idle
        };
        assert_eq!([0.1, 0.05, 0.049, 0.06, 0.02].map(&mut idle), [0, 0, 1, 2, 0]);
    }
}
