//! The peers, MoorDyn and CableDyn, run on the same scene, in the same run and on the same core.
//!
//! A Python script beside this file drives the peers' packages and is talked with in lines of JSON: it hears of the scene and answers with
//! its ladder, then makes the runs it is asked for, with or without reading their results. Its ladder holds each peer's best settings;
//! times are processor times of the peer's loop alone.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::errors::{Errors, Histories, Judge, Metric};
use super::{Code, Failed, How, Run, Study};
use moorline::scene::{MotionPath, Point, PointKind, Scene};

const SCRIPT: &str = include_str!("../peers.py");
/// Imports all that the script needs, and says [`READY`] where it has it.
const PROBE: &str = "import numpy, cmoordyn, cabledyn; from cabledyn._lib import _lib; cmoordyn.create; cabledyn.CableDyn; print('ready')";
const READY: &str = "ready";
/// Elements that the peers are tried with [-].
const ELEMENTS: [usize; 23] = [
    3, 4, 5, 6, 7, 8, 10, 12, 14, 17, 20, 24, 28, 34, 40, 44, 48, 52, 56, 62, 68, 74, 80,
];
/// Those of them that a line on a seabed starts from: with fewer it means nothing.
const ELEMENTS_ON_BED: usize = 5;
/// Processor time that all passes of a single run of a peer may take [s].
const TIME_LIMIT: f64 = 60.0;

/// A finer mesh pays as long as it lowers some error to less than this part of the least so far [-].
const PAYS: f64 = 0.95;
/// So many meshes in a row that do not pay end their family of settings [-].
const IDLE_MAX: usize = 3;

/// A Python interpreter that can import the peers' packages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Peers {
    python: PathBuf,
    /// Where the script lies: it starts itself again for every run.
    script: PathBuf,
}

/// Why the peers cannot run.
#[derive(Debug, thiserror::Error)]
pub enum PeerError {
    /// The interpreter is not there.
    #[error("{}: no Python interpreter; give one, or the folder of a virtual environment", .0.display())]
    NoPython(PathBuf),
    /// It does not know the packages.
    #[error("{}: cannot import moordyn and cabledyn: {said}; install accuracy/peers-requirements.txt there", .python.display())]
    NoPackages {
        /// The interpreter.
        python: PathBuf,
        /// What it said.
        said: String,
    },
    /// The script cannot be put into the folder.
    #[error("cannot write {}: {said}", .script.display())]
    NoScript {
        /// The script.
        script: PathBuf,
        /// What the operating system said.
        said: String,
    },
}

/// A scene as the script reads it.
#[derive(Debug, Serialize)]
struct Question<'a> {
    name: &'a str,
    gravity: f64,
    density: Option<f64>,
    depth: Option<f64>,
    bed: Option<Bed>,
    line: PeerLine,
    anchor: [f64; 3],
    fairlead: [f64; 3],
    harmonics: Harmonics<'a>,
    duration: f64,
    interval: f64,
    elements: &'a [usize],
    time_limit_seconds: f64,
}

#[derive(Debug, Serialize)]
struct Bed {
    stiffness: f64,
    damping: f64,
}

#[derive(Debug, Serialize)]
struct PeerLine {
    length: f64,
    mass: f64,
    diameter: f64,
    axial_stiffness: f64,
    axial_damping: f64,
    drag_normal: f64,
    drag_tangential: f64,
    added_mass_normal: f64,
    added_mass_tangential: f64,
}

#[derive(Debug, Serialize)]
struct Harmonics<'a> {
    x: &'a [Vec<f64>],
    y: &'a [Vec<f64>],
    z: &'a [Vec<f64>],
    ramp: f64,
}

/// The script's first answer.
#[derive(Debug, Deserialize)]
struct Ladder {
    runs: Vec<Planned>,
}

/// A run of the script's ladder.
#[derive(Debug, Clone, Deserialize)]
struct Planned {
    peer: String,
    label: String,
    /// Runs that differ in their mesh alone, from coarse to fine.
    family: String,
}

/// A run that the script is asked for.
#[derive(Debug, Serialize)]
struct Asked {
    run: usize,
    read: bool,
}

/// A line of the script's answer.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Answer {
    Run {
        cpu_seconds: f64,
        #[serde(default)]
        tension: Vec<f64>,
        #[serde(default)]
        mid: Vec<[f64; 3]>,
    },
    Failed {
        failed: String,
    },
}

/// The script at work on a scene.
#[derive(Debug)]
pub(crate) struct Conversation {
    child: Child,
    /// Absent once the script has been told to end.
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    runs: Vec<Planned>,
    simulated: f64,
}

impl Peers {
    /// The peers' packages in an interpreter, or in the virtual environment in a folder; their script goes into `folder`.
    ///
    /// # Errors
    /// Where there is no interpreter, it lacks the packages, or the script cannot be written.
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

    /// Tells the script of a scene, and hears of its ladder.
    pub(crate) fn begin(&self, name: &str, scene: &Scene) -> Result<Conversation, String> {
        let question = question(name, scene)?;
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
            simulated: scene.output.duration,
        };
        let ladder: Ladder = conversation.ask(&question)?;
        conversation.runs = ladder.runs;
        Ok(conversation)
    }
}

impl Drop for Conversation {
    fn drop(&mut self) {
        drop(self.input.take());
        // The script ends with its input; a status that cannot be had changes nothing.
        let _ = self.child.wait();
    }
}

/// How far a family of settings has come.
#[derive(Debug, Default)]
struct Family {
    name: String,
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
    /// Runs in the peers' ladder.
    pub(crate) fn count(&self) -> usize {
        self.runs.len()
    }

    fn ask<A: for<'a> Deserialize<'a>>(&mut self, question: &impl Serialize) -> Result<A, String> {
        let mut text = serde_json::to_string(question).map_err(|error| error.to_string())?;
        text.push('\n');
        let input = self.input.as_mut().ok_or("the script has no input")?;
        input
            .write_all(text.as_bytes())
            .and_then(|()| input.flush())
            .map_err(|error| format!("the peers' script has ended: {error}"))?;
        let mut line = String::new();
        self.output
            .read_line(&mut line)
            .map_err(|error| error.to_string())?;
        serde_json::from_str(&line).map_err(|error| format!("the peers' script answered {line:.80}: {error}"))
    }

    /// Runs the peers' ladder and judges what they answer. A family of settings ends where finer meshes no longer pay; `done` is
    /// told how much of the ladder is done.
    pub(crate) fn add_runs(
        &mut self,
        judge: &Judge,
        converged: &Histories,
        study: &mut Study,
        done: &mut dyn FnMut(usize),
    ) {
        let mut families: Vec<Family> = Vec::new();
        for number in 0..self.runs.len() {
            let Planned { peer, label, family } = self.runs[number].clone();
            let index = families.iter().position(|one| one.name == family);
            let index = index.unwrap_or(families.len());
            if index == families.len() {
                families.push(Family {
                    name: family,
                    ..Family::default()
                });
            }
            if families[index].idle >= IDLE_MAX {
                continue;
            }
            let asked = Asked {
                run: number,
                read: true,
            };
            let failed = match self.ask(&asked) {
                Ok(Answer::Run {
                    cpu_seconds,
                    tension,
                    mid,
                }) => {
                    let histories = Histories {
                        tension: vec![tension],
                        middle: vec![mid.into_iter().map(Vector3::from).collect()],
                    };
                    let errors = judge.errors(&histories, converged);
                    families[index].take(&errors);
                    let cost = cpu_seconds / self.simulated;
                    let how = How::Peer(number);
                    let run = Run::new(Code::Peer(peer), label, cost, errors, how);
                    study.runs.push(run);
                    None
                }
                Ok(Answer::Failed { failed }) => Some(failed),
                Err(reason) => Some(reason),
            };
            study.failed.extend(failed.map(|reason| Failed {
                label: format!("{}, {}", self.runs[number].peer, self.runs[number].label),
                reason,
            }));
            done(number + 1);
        }
    }

    /// Times a run of the peers' ladder again: processor time over simulated time [-]. `None` where it fails.
    pub(crate) fn time(&mut self, number: usize) -> Option<f64> {
        let asked = Asked {
            run: number,
            read: false,
        };
        match self.ask(&asked) {
            Ok(Answer::Run { cpu_seconds, .. }) => Some(cpu_seconds / self.simulated),
            _ => None,
        }
    }
}

/// The scene in the script's words; the peers are asked about one uniform line from a fixed anchor to a driven fairlead.
fn question<'a>(name: &'a str, scene: &'a Scene) -> Result<Question<'a>, String> {
    const WANTED: &str = "peers run on scenes of one uniform line from a fixed anchor to a coupled fairlead in harmonic motion";
    let refuse = || WANTED.to_string();
    let [line] = scene.lines.as_slice() else {
        return Err(refuse());
    };
    let [section] = line.sections.as_slice() else {
        return Err(refuse());
    };
    let end = |name: &str| scene.points.iter().find(|point| point.name == name);
    let kind = |point: &&Point, kind: PointKind| point.kind == kind;
    let anchor = end(&line.from).filter(|point| kind(point, PointKind::Fixed));
    let fairlead = end(&line.to).filter(|point| kind(point, PointKind::Coupled));
    let (anchor, fairlead) = anchor.zip(fairlead).ok_or_else(refuse)?;
    let Some(MotionPath::Harmonic(motion)) = scene.motion.get(&fairlead.name) else {
        return Err(refuse());
    };
    let line_type = scene.line_types.get(&section.line_type).ok_or_else(refuse)?;
    let (mass, diameter) = line_type.mass.zip(line_type.diameter).ok_or_else(refuse)?;
    let axial_stiffness = line_type.axial_stiffness.ok_or_else(refuse)?;
    let or_zero = |value: Option<f64>| value.unwrap_or(0.0);
    Ok(Question {
        name,
        gravity: scene.gravity,
        density: scene.water.as_ref().map(|water| water.density),
        depth: scene.seabed.as_ref().map(|bed| bed.depth),
        bed: scene.seabed.as_ref().map(|bed| Bed {
            stiffness: bed.stiffness,
            damping: bed.damping,
        }),
        line: PeerLine {
            length: section.length,
            mass,
            diameter,
            axial_stiffness,
            axial_damping: or_zero(line_type.axial_damping),
            drag_normal: or_zero(line_type.drag_normal),
            drag_tangential: or_zero(line_type.drag_tangential),
            added_mass_normal: or_zero(line_type.added_mass_normal),
            added_mass_tangential: or_zero(line_type.added_mass_tangential),
        },
        anchor: anchor.position,
        fairlead: fairlead.position,
        harmonics: Harmonics {
            x: &motion.x,
            y: &motion.y,
            z: &motion.z,
            ramp: or_zero(motion.ramp),
        },
        duration: scene.output.duration,
        interval: scene.output.interval,
        elements: match scene.seabed {
            Some(_) => &ELEMENTS[ELEMENTS_ON_BED..],
            None => &ELEMENTS,
        },
        time_limit_seconds: TIME_LIMIT,
    })
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
