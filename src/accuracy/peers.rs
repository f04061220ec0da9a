//! The peers, MoorDyn and CableDyn, run on the same scene, in the same run and on the same core.
//!
//! A Python script beside this file drives the peers' packages: it reads one JSON document, the scene, and answers with a line
//! of JSON for every run. It finds each peer's best settings within its ladder; times are processor times of the peer's loop alone.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::errors::{Histories, Judge};
use super::{Code, Failed, Run, Study};
use crate::scene::{MotionPath, Point, PointKind, Scene};

const SCRIPT: &str = include_str!("peers.py");
/// Elements that the peers are tried with [-].
const ELEMENTS: [usize; 10] = [4, 6, 8, 10, 14, 20, 28, 40, 56, 80];
/// Those of them that a line on a seabed starts from: with fewer it means nothing.
const ELEMENTS_ON_BED: usize = 2;
/// Processor time that all passes of a single run of a peer may take [s].
const TIME_LIMIT: f64 = 60.0;

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
    #[error("{}: cannot import moordyn and cabledyn: {said}; install src/accuracy/peers-requirements.txt there", .python.display())]
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

/// A line of the script's answer.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Answer {
    Run {
        peer: String,
        label: String,
        cpu_seconds: f64,
        tension: Vec<f64>,
        mid: Vec<[f64; 3]>,
    },
    Failed {
        peer: String,
        label: String,
        failed: String,
    },
    Done {
        #[serde(rename = "done")]
        _done: bool,
    },
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
            .args(["-c", "import moordyn, cabledyn"])
            .output()
            .map_err(|_| PeerError::NoPython(python.clone()))?;
        if !asked.status.success() {
            let said = String::from_utf8_lossy(&asked.stderr);
            let said = said.lines().last().unwrap_or("no message").to_string();
            return Err(PeerError::NoPackages { python, said });
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

    /// Runs the peers on a scene and judges what they answer.
    pub(super) fn add_runs(
        &self,
        scene: &Scene,
        judge: &Judge,
        converged: &Histories,
        study: &mut Study,
    ) {
        let name = study.name.clone();
        let answers = question(&name, scene).and_then(|question| self.ask(&question));
        match answers {
            Ok(answers) => {
                for answer in answers {
                    study.take(answer, scene.output.duration, judge, converged);
                }
            }
            Err(reason) => study.failed.push(Failed {
                label: "peers".to_string(),
                reason,
            }),
        }
    }

    fn ask(&self, question: &Question<'_>) -> Result<Vec<Answer>, String> {
        let mut child = Command::new(&self.python)
            .arg(&self.script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| format!("{}: {error}", self.python.display()))?;
        let answers = answers(&mut child, question);
        let ended = child.wait().map_err(|error| error.to_string())?;
        match answers {
            Ok(answers) if ended.success() => Ok(answers),
            Ok(_) => Err(format!("the peers' script ended with {ended}")),
            Err(reason) => Err(reason),
        }
    }
}

fn answers(child: &mut Child, question: &Question<'_>) -> Result<Vec<Answer>, String> {
    let mut input = child.stdin.take().ok_or("the script has no input")?;
    let text = serde_json::to_string(question).map_err(|error| error.to_string())?;
    input
        .write_all(text.as_bytes())
        .map_err(|error| error.to_string())?;
    drop(input);
    let output = child.stdout.take().ok_or("the script has no output")?;
    let mut answers = Vec::new();
    for line in BufReader::new(output).lines() {
        let line = line.map_err(|error| error.to_string())?;
        match serde_json::from_str(&line) {
            Ok(Answer::Done { .. }) => break,
            Ok(answer) => answers.push(answer),
            Err(error) => return Err(format!("the peers' script answered {line:.80}: {error}")),
        }
    }
    Ok(answers)
}

impl Study {
    fn take(&mut self, answer: Answer, simulated: f64, judge: &Judge, converged: &Histories) {
        match answer {
            Answer::Run {
                peer,
                label,
                cpu_seconds,
                tension,
                mid,
            } => {
                let histories = Histories {
                    tension: vec![tension],
                    middle: vec![mid.into_iter().map(Vector3::from).collect()],
                };
                self.runs.push(Run {
                    code: Code::Peer(peer),
                    label,
                    cost: cpu_seconds / simulated,
                    errors: judge.errors(&histories, converged),
                });
            }
            Answer::Failed {
                peer,
                label,
                failed,
            } => self.failed.push(Failed {
                label: format!("{peer}, {label}"),
                reason: failed,
            }),
            Answer::Done { .. } => {}
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
    let line_type = scene
        .line_types
        .get(&section.line_type)
        .ok_or_else(refuse)?;
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
