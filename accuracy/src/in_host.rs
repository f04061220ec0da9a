//! Default settings in a host: the FMU of the scene, driven through the C interface of FMI 2.0.
//!
//! Before every communication step the host sets the displacements of its bodies, but no velocities; after it, it reads the forces on them. Histories
//! are taken from the same simulation outside the FMU with the same inputs: the two agree bit for bit.

use std::hint::black_box;

use cpu_time::ThreadTime;
use moorline::interface::{Binding, Interface, Layout};
use moorline::scene::Scene;
use moorline_host::{Fmu, HostError};

use crate::converged::Converged;
use crate::ladder::{Setting, TOLERANCES};
use crate::timed::{Timed, Trial, median};
use crate::{Failed, How, Run, Study, code, described, label};

/// Packages a scene as an FMU and opens it; the error is a message.
pub type Package<'a> = dyn Fn(&Scene) -> Result<Fmu, String> + 'a;

/// An FMU with its inputs, so that a run can be repeated.
#[derive(Debug)]
pub(crate) struct Hosted {
    fmu: Fmu,
    /// Value references of the displacements and of the forces.
    inputs: Vec<u32>,
    outputs: Vec<u32>,
    /// Displacements before every step, step by step.
    displacements: Vec<f64>,
    /// Communication step [s].
    step: f64,
}

impl Hosted {
    fn new(fmu: Fmu, scene: &Scene, trial: &Trial) -> Result<Hosted, String> {
        let interface =
            Interface::new(scene, trial.start.model(), Layout::Scalars).map_err(|error| error.to_string())?;
        let reference = |name: &str| fmu.reference(name).map_err(|error| error.to_string());
        let (mut inputs, mut outputs, mut places) = (Vec::new(), Vec::new(), Vec::new());
        for variable in interface.variables() {
            match variable.binding {
                Binding::Displacement { body, axis } => {
                    if let Some(place) = trial.bodies.iter().position(|moved| *moved == body) {
                        inputs.push(reference(&variable.name)?);
                        places.push((place, axis));
                    }
                }
                Binding::EndForce { body, .. } if trial.bodies.contains(&body) => {
                    outputs.push(reference(&variable.name)?);
                }
                _ => {}
            }
        }
        if inputs.is_empty() {
            return Err(
                "the scene has no moving coupled point or vessel, so a host has nothing to drive".to_string(),
            );
        }
        let rows = trial.inputs.chunks_exact(trial.bodies.len());
        let displacements =
            rows.flat_map(|row| places.iter().map(|&(place, axis)| row[place].displacement[axis]));
        Ok(Hosted {
            displacements: displacements.collect(),
            step: trial.step,
            fmu,
            inputs,
            outputs,
        })
    }

    /// Processor time over simulated time [-]: the median of a few passes.
    pub(crate) fn cost(&self) -> Result<f64, String> {
        let steps = self.displacements.len() / self.inputs.len();
        let pass = || self.pass().map_err(|error| error.to_string());
        median(pass).map(|time| time / (self.step * steps as f64))
    }

    /// Steps a new instance to the end; returns the processor time of this thread without initialization [s].
    fn pass(&self) -> Result<f64, HostError> {
        let rows = self.displacements.chunks_exact(self.inputs.len());
        let mut slave = self.fmu.instantiate("mooring", false)?;
        slave.enter_initialization(0.0, None)?;
        slave.set_real(&self.inputs, &self.displacements[..self.inputs.len()])?;
        slave.exit_initialization()?;
        let mut forces = vec![0.0; self.outputs.len()];
        let before = ThreadTime::now();
        for (index, row) in rows.enumerate() {
            slave.set_real(&self.inputs, row)?;
            slave.do_step(index as f64 * self.step, self.step)?;
            slave.get_real(&self.outputs, &mut forces)?;
            black_box(&forces);
        }
        let elapsed = before.elapsed().as_secs_f64();
        slave.terminate()?;
        Ok(elapsed)
    }
}

impl Study {
    /// Runs the scenes with default settings, one for each of [`TOLERANCES`], in a host with a communication step [s]; returns their FMUs in the
    /// order of [`How::InHost`].
    pub(crate) fn run_in_host(
        &mut self,
        (scenes, step): (&[Scene], f64),
        package: &Package<'_>,
        converged: &Converged,
        done: &mut dyn FnMut(usize),
    ) -> Vec<Hosted> {
        let mut hosted = Vec::new();
        for (index, (tolerance, scene)) in TOLERANCES.into_iter().zip(scenes).enumerate() {
            let setting = Setting::by_default(tolerance);
            match run(scene, step, package) {
                Ok((timed, fmu)) => {
                    let errors = converged.errors(&timed.histories);
                    let (label, how) = (label(&setting, &timed, self.on_seabed), How::InHost(hosted.len()));
                    self.runs.push(Run {
                        tolerance: Some(tolerance),
                        ..Run::new(code(&setting), label, timed.cost, errors, how)
                    });
                    hosted.push(fmu);
                }
                Err(reason) => self.failed.push(Failed {
                    label: described(&setting),
                    reason,
                }),
            }
            done(index + 1);
        }
        hosted
    }
}

/// Runs a scene in a host with a communication step [s], and times its FMU.
fn run(scene: &Scene, step: f64, package: &Package<'_>) -> Result<(Timed, Hosted), String> {
    let trial = Trial::in_steps(scene, step)?;
    let hosted = Hosted::new(package(scene)?, scene, &trial)?;
    let (timed, _) = trial.recorded()?;
    let cost = hosted.cost()?;
    Ok((Timed { cost, ..timed }, hosted))
}
