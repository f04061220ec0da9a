//! One run of a scene: its histories and their cost.
//!
//! A timed run is driven as by a host that reads the forces on the moving bodies after every communication step. Before the step, it gives their
//! displacements and velocities at the end of the step, computed beforehand, as for the peers; with default settings, it gives only the displacements
//! at the start of the step. The converged solution follows the scene's motion exactly.

use std::hint::black_box;

use cpu_time::ThreadTime;
use moorline::model::{Body, Line};
use moorline::scene::{Integrator, Reconstruction, Scene};
use moorline::simulation::Simulation;
use nalgebra::Vector3;

use moorline::scene::table::Choice;

use crate::errors::Histories;
use crate::ladder::Setting;

/// Greatest number of passes of one timing, of which the median is used, and total time [s] from which on no further pass is made.
const PASSES_MAX: usize = 9;
const PASSES_TIME: f64 = 0.08;
/// Tolerance for rounding of a number of steps [-].
const ROUNDING: f64 = 1e-9;

/// A run that can be repeated.
#[derive(Debug, Clone)]
pub(crate) struct Trial {
    pub(crate) start: Simulation,
    /// Inputs before every step, body by body, contiguous in memory, so that fetching them adds little to the solver's time. Empty if the scene's
    /// motion is followed exactly.
    pub(crate) inputs: Vec<Input>,
    /// Bodies that the host moves.
    pub(crate) bodies: Vec<Body>,
    /// Lengths paid out before every step [m], with the indices of their lines; empty if the scene is followed exactly.
    winches: Vec<Vec<(usize, f64)>>,
    /// Communication step [s].
    pub(crate) step: f64,
    count: usize,
    /// Interval [s] and number of the samples.
    interval: f64,
    samples: usize,
}

/// Displacement [m, rad] of a body, and its velocity [m/s, rad/s] if the host gives one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Input {
    pub displacement: [f64; 6],
    velocity: [Option<f64>; 6],
}

/// Results of a run.
#[derive(Debug, Clone)]
pub(crate) struct Timed {
    pub histories: Histories,
    /// Processor time over simulated time [-].
    pub cost: f64,
    /// Name of the integrator of the first network.
    pub integrator: String,
    /// Elements of all lines [-].
    pub elements: usize,
    /// Mean internal step [s].
    pub step: f64,
    /// Communication step [s], if it differs from the interval of the output.
    pub communication: Option<f64>,
}

impl Timed {
    /// Returns whether any tension changes.
    pub(crate) fn moves(&self) -> bool {
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

impl Trial {
    /// Prepares a run driven as by a host; the error is a message.
    pub(crate) fn new(scene: &Scene, setting: &Setting) -> Result<Trial, String> {
        let step = setting.communication as f64 * scene.output.interval;
        Trial::in_steps(&setting.apply(scene), step)
    }

    /// Prepares a run of a scene with its setting, driven in communication steps of a given length [s].
    pub(crate) fn in_steps(scene: &Scene, step: f64) -> Result<Trial, String> {
        let interval = scene.output.interval;
        let samples = samples(scene);
        let count = (samples as f64 * interval / step - ROUNDING).ceil() as usize;
        let mut start = Simulation::new(scene).map_err(|error| error.to_string())?;
        let ahead = start.model().solver.input_reconstruction == Reconstruction::Interpolate;
        let at = |time: f64| {
            let moving = start.model().moving(time).into_iter();
            moving.map(|moving| Input {
                displacement: moving.pose,
                velocity: moving.velocity.map(|velocity| ahead.then_some(velocity)),
            })
        };
        let first: Vec<Input> = at(0.0).collect();
        let times = (0..count).map(|index| (index + usize::from(ahead)) as f64 * step);
        let inputs = times.clone().flat_map(at).collect();
        let winches = times.map(|time| start.model().paid_out(time)).collect();
        let bodies: Vec<Body> = start
            .model()
            .moving(0.0)
            .into_iter()
            .map(|moving| moving.body)
            .collect();
        give(&mut start, &bodies, &first);
        for (line, change) in start.model().paid_out(0.0) {
            start.set_length_change(line, change);
        }
        start.restart(0.0).map_err(|error| error.to_string())?;
        Ok(Trial {
            start,
            inputs,
            bodies,
            winches,
            step,
            count,
            interval,
            samples,
        })
    }

    /// Prepares a run that follows the scene's motion exactly.
    pub(crate) fn exact(scene: &Scene, setting: &Setting) -> Result<Trial, String> {
        let mut start = Simulation::new(&setting.apply(scene)).map_err(|error| error.to_string())?;
        start.follow_scene().map_err(|error| error.to_string())?;
        let samples = samples(scene);
        Ok(Trial {
            start,
            inputs: Vec::new(),
            bodies: Vec::new(),
            winches: Vec::new(),
            step: scene.output.interval,
            count: samples,
            interval: scene.output.interval,
            samples,
        })
    }

    /// Integrator and planned number of steps in a communication step, by network: two runs with the same mesh and plan are equal.
    pub(crate) fn plan(&self) -> Vec<(Integrator, usize)> {
        let steps = |step_max: f64| (self.step / step_max - ROUNDING).ceil() as usize;
        let choices = self.start.choices();
        choices
            .map(|choice| (choice.integrator, steps(choice.step_max)))
            .collect()
    }

    /// Runs once and reads the histories. The time of a long pass is used as its cost, since reading takes a negligible part of it; short runs are
    /// timed again without reading.
    pub(crate) fn recorded(&self) -> Result<(Timed, Option<f64>), String> {
        let mut record = Record::new(&self.start, self.count);
        let mut steps = 0;
        let elapsed = self.step_through(|simulation| {
            steps += simulation.substeps();
            record.read(simulation);
        })?;
        let choice = self.start.choices().next();
        let lines = &self.start.model().lines;
        let timed = Timed {
            cost: f64::NAN,
            integrator: choice.map_or(String::new(), |choice| name(choice.integrator)),
            elements: lines.iter().map(Line::segment_count).sum(),
            step: self.step * self.count as f64 / steps.max(1) as f64,
            communication: (self.step != self.interval).then_some(self.step),
            histories: record.sampled(self.step, self.interval, self.samples),
        };
        let long = elapsed >= PASSES_TIME;
        Ok((timed, long.then(|| self.relative(elapsed))))
    }

    /// Processor time over simulated time [-]: the median of a few passes that read only the forces on the bodies.
    pub(crate) fn cost(&self) -> Result<f64, String> {
        let pass = || {
            self.step_through(|simulation| {
                for body in &self.bodies {
                    black_box(simulation.host_force(*body));
                }
            })
        };
        median(pass).map(|time| self.relative(time))
    }

    fn relative(&self, elapsed: f64) -> f64 {
        elapsed / (self.step * self.count as f64)
    }

    /// Steps from the start to the end; returns the processor time of this thread [s].
    fn step_through(&self, mut each: impl FnMut(&Simulation)) -> Result<f64, String> {
        let mut simulation = self.start.clone();
        let before = ThreadTime::now();
        for index in 0..self.count {
            let bodies = self.bodies.len();
            let inputs = &self.inputs[index * bodies..(index + 1) * bodies];
            give(&mut simulation, &self.bodies, inputs);
            for (line, change) in self.winches.get(index).into_iter().flatten() {
                simulation.set_length_change(*line, *change);
            }
            simulation.advance(self.step).map_err(|error| error.to_string())?;
            each(&simulation);
        }
        Ok(before.elapsed().as_secs_f64())
    }
}

fn give(simulation: &mut Simulation, bodies: &[Body], inputs: &[Input]) {
    for (body, input) in bodies.iter().zip(inputs) {
        simulation.set_body(*body, input.displacement, input.velocity);
    }
}

/// Median of the times [s] of a few passes.
pub(crate) fn median(mut pass: impl FnMut() -> Result<f64, String>) -> Result<f64, String> {
    let mut times = Vec::with_capacity(PASSES_MAX);
    while times.len() < PASSES_MAX && times.iter().sum::<f64>() < PASSES_TIME {
        times.push(pass()?);
    }
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}

/// Runs a trial and times it.
pub(crate) fn run(trial: &Trial) -> Result<Timed, String> {
    let (timed, cost) = trial.recorded()?;
    let cost = cost.map_or_else(|| trial.cost(), Ok)?;
    Ok(Timed { cost, ..timed })
}

/// Values read at every communication point, including the start.
struct Record {
    /// Lines with a driven end; all lines if there is none.
    driven: Vec<usize>,
    tension: Vec<Vec<f64>>,
    middle: Vec<Vec<Vector3<f64>>>,
}

impl Record {
    fn new(start: &Simulation, count: usize) -> Record {
        let model = start.model();
        let is_moved = |point: usize| model.points[point].is_moved();
        let is_driven = |line: &usize| model.lines[*line].ends.into_iter().any(is_moved);
        let lines = 0..model.lines.len();
        let mut driven: Vec<usize> = lines.clone().filter(is_driven).collect();
        if driven.is_empty() {
            driven.extend(lines);
        }
        let mut record = Record {
            tension: vec![Vec::with_capacity(count + 1); driven.len()],
            middle: vec![Vec::with_capacity(count + 1); model.lines.len()],
            driven,
        };
        record.read(start);
        record
    }

    fn read(&mut self, simulation: &Simulation) {
        for (tension, line) in self.tension.iter_mut().zip(&self.driven) {
            tension.push(simulation.tension_at(*line, simulation.model().driven_end(*line)));
        }
        for (line, middle) in self.middle.iter_mut().enumerate() {
            middle.push(half_way_of(simulation, line));
        }
    }

    /// Returns the histories at every interval [s] from the samples taken after every step [s].
    fn sampled(self, step: f64, interval: f64, samples: usize) -> Histories {
        let parts = step / interval;
        let tension = self.tension.into_iter();
        let middle = self.middle.into_iter();
        Histories {
            tension: tension.map(|all| resampled(&all, parts, samples)).collect(),
            middle: middle.map(|all| resampled(&all, parts, samples)).collect(),
        }
    }
}

/// Returns values at 1, 2, … `samples` from values with a spacing of `parts` that begin at 0, on cubics through four of them.
fn resampled<T>(values: &[T], parts: f64, samples: usize) -> Vec<T>
where
    T: Copy + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    if parts == 1.0 || values.len() < 4 {
        return values.iter().skip(1).take(samples).copied().collect();
    }
    let at = |sample: usize| {
        let place = sample as f64 / parts;
        let first = (place.floor() as usize).saturating_sub(1).min(values.len() - 4);
        let weights = cubic([0.0, 1.0, 2.0, 3.0], place - first as f64);
        let [a, b, c, d] = [0, 1, 2, 3].map(|point| values[first + point] * weights[point]);
        a + b + c + d
    };
    (1..=samples).map(at).collect()
}

fn samples(scene: &Scene) -> usize {
    (scene.output.duration / scene.output.interval).round().max(2.0) as usize
}

/// Name of the integrator, as in the scene format but with hyphens.
fn name(integrator: Integrator) -> String {
    integrator.word().replace('_', "-")
}

/// Position half-way along a line [m], on a cubic through four nodes, or on a chord if there are fewer.
fn half_way_of(simulation: &Simulation, line: usize) -> Vector3<f64> {
    let arc = &simulation.model().lines[line].nodes.arc;
    let profile = simulation.state().lines[line].position.as_slice();
    half_way(arc, profile)
}

fn half_way(arc: &[f64], profile: &[Vector3<f64>]) -> Vector3<f64> {
    let last = arc.len() - 1;
    let half = 0.5 * arc[last];
    let after = arc.partition_point(|s| *s < half).clamp(1, last);
    if last < 3 {
        let part = (half - arc[after - 1]) / (arc[after] - arc[after - 1]);
        return profile[after - 1] + part * (profile[after] - profile[after - 1]);
    }
    let nodes = [0, 1, 2, 3].map(|node| node + after.saturating_sub(2).min(last - 3));
    let weights = cubic(nodes.map(|node| arc[node]), half);
    let terms = nodes
        .iter()
        .zip(weights)
        .map(|(node, weight)| profile[*node] * weight);
    terms.sum()
}

/// Weights of the values at four positions in the value of their cubic at another position [-].
fn cubic(places: [f64; 4], at: f64) -> [f64; 4] {
    let share = |own: f64| {
        let others = places.iter().filter(|other| **other != own);
        others.map(|other| (at - other) / (own - other)).product()
    };
    places.map(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_resampled_exactly() {
        let cubic = |t: f64| 2.0 + t - 0.3 * t * t + 0.01 * t * t * t;
        let values: Vec<f64> = (0..8).map(|k| cubic(4.0 * f64::from(k))).collect();
        let fine = resampled(&values, 4.0, 26);
        assert_eq!(fine.len(), 26);
        for (index, value) in fine.iter().enumerate() {
            let right = cubic((index + 1) as f64);
            assert!((value - right).abs() < 1e-12 * right.abs().max(1.0));
        }
        assert_eq!(resampled(&values, 1.0, 7), values[1..]);
    }

    #[test]
    fn a_line_is_read_half_way_along_whatever_its_number_of_elements() {
        let curve = |s: f64| Vector3::new(s, 0.2 * s * s, 0.1 * s - 0.04 * s * s * s);
        for elements in 3..9 {
            let even = |node: usize| node as f64 / elements as f64;
            for uneven in [0.0, 0.3] {
                let arc: Vec<f64> = (0..=elements)
                    .map(|node| even(node) * (1.0 + uneven * (even(node) - 1.0)))
                    .collect();
                let profile: Vec<_> = arc.iter().map(|s| curve(*s)).collect();
                let lies = (half_way(&arc, &profile) - curve(0.5)).norm();
                assert!(lies < 1e-15, "{elements}: {lies:e}");
            }
        }
        let chord = half_way(&[0.0, 1.0], &[curve(0.0), curve(1.0)]);
        assert_eq!(chord, 0.5 * (curve(0.0) + curve(1.0)));
    }
}
