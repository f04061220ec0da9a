//! One run of a scene: its histories and what they cost.

use cpu_time::ThreadTime;
use nalgebra::Vector3;

use super::errors::Histories;
use crate::model::{Line, Model, Role};
use crate::scene::Scene;
use crate::simulation::Simulation;

/// Timed passes of a run, the median of which counts: at most this many, and no more once they add up to this time [s].
const PASSES_MAX: usize = 9;
const PASSES_TIME: f64 = 0.4;

/// A run.
#[derive(Debug, Clone)]
pub(super) struct Timed {
    pub histories: Histories,
    /// Processor time over simulated time [-].
    pub cost: f64,
    /// Name of the integrator of the first network.
    pub integrator: String,
    /// Elements of all lines [-].
    pub elements: usize,
    /// Mean internal step [s].
    pub step: f64,
}

impl Timed {
    /// Whether any tension changes.
    pub fn moves(&self) -> bool {
        let changes = |tension: &Vec<f64>| {
            let (first, last) = (tension.first(), tension.len() / 2);
            let scale = first.map_or(0.0, |t| t.abs());
            tension[last..]
                .iter()
                .any(|t| (t - tension[last]).abs() > 1e-6 * scale)
        };
        self.histories.tension.iter().any(changes)
    }
}

/// Runs a scene with its own motion; a failure is told in words. A first pass keeps the histories and is not timed, further
/// ones take the same steps and read nothing.
pub(super) fn run(scene: &Scene) -> Result<Timed, String> {
    let mut simulation = Simulation::new(scene).map_err(|error| error.to_string())?;
    simulation
        .follow_scene()
        .map_err(|error| error.to_string())?;
    let mut timed = recorded(simulation.clone(), scene)?;
    let mut times = Vec::with_capacity(PASSES_MAX);
    while times.len() < PASSES_MAX && times.iter().sum::<f64>() < PASSES_TIME {
        times.push(stepped(simulation.clone(), scene)?);
    }
    times.sort_by(f64::total_cmp);
    timed.cost = times[times.len() / 2] / (scene.output.interval * samples(scene) as f64);
    Ok(timed)
}

fn samples(scene: &Scene) -> usize {
    (scene.output.duration / scene.output.interval)
        .round()
        .max(2.0) as usize
}

/// Processor time of all steps [s].
fn stepped(mut simulation: Simulation, scene: &Scene) -> Result<f64, String> {
    let before = ThreadTime::now();
    for _ in 0..samples(scene) {
        simulation
            .advance(scene.output.interval)
            .map_err(|error| error.to_string())?;
    }
    Ok(before.elapsed().as_secs_f64())
}

fn recorded(mut simulation: Simulation, scene: &Scene) -> Result<Timed, String> {
    let (interval, samples) = (scene.output.interval, samples(scene));
    let count = simulation.model().lines.len();
    let mut histories = Histories {
        tension: vec![Vec::with_capacity(samples); count],
        middle: vec![Vec::with_capacity(samples); count],
    };
    let mut steps = 0;
    for _ in 0..samples {
        simulation
            .advance(interval)
            .map_err(|error| error.to_string())?;
        steps += simulation.substeps();
        for line in 0..count {
            histories.tension[line].push(driven_tension(&simulation, line));
            histories.middle[line].push(middle(&simulation, line));
        }
    }
    let choice = simulation.choices().next();
    Ok(Timed {
        cost: f64::NAN,
        integrator: choice.map_or(String::new(), |choice| name(choice.integrator)),
        elements: simulation
            .model()
            .lines
            .iter()
            .map(Line::segment_count)
            .sum(),
        step: interval * samples as f64 / steps.max(1) as f64,
        histories,
    })
}

/// The integrator as the scene format spells it.
fn name(integrator: crate::scene::Integrator) -> String {
    serde_json::to_value(integrator)
        .ok()
        .and_then(|value| value.as_str().map(str::to_string))
        .unwrap_or_default()
        .replace('_', "-")
}

/// Tension at the end of a line that is moved, end B where both or none are [N].
fn driven_tension(simulation: &Simulation, line: usize) -> f64 {
    let model = simulation.model();
    let [a, b] = model.lines[line].ends;
    if moved(model, a) && !moved(model, b) {
        simulation.tension_a(line)
    } else {
        simulation.tension_b(line)
    }
}

fn moved(model: &Model, point: usize) -> bool {
    matches!(
        model.points[point].role,
        Role::Coupled { .. } | Role::Carried { .. } | Role::Prescribed(_)
    )
}

/// Position half-way along a line [m].
fn middle(simulation: &Simulation, line: usize) -> Vector3<f64> {
    let arc = &simulation.model().lines[line].nodes.arc;
    let profile = simulation.state().lines[line].position.as_slice();
    let half = 0.5 * arc[arc.len() - 1];
    let after = arc.partition_point(|s| *s < half).clamp(1, arc.len() - 1);
    let part = (half - arc[after - 1]) / (arc[after] - arc[after - 1]);
    profile[after - 1] + part * (profile[after] - profile[after - 1])
}
