//! What the tests of the dynamics share: scenes, histories and measures of error.
#![allow(dead_code)] // each test file uses a part

use moorline::elements::Workspace;
use moorline::model::{Model, PointState, State};
use moorline::scene::{InitialShape, Integrator, Scene};
use moorline::simulation::Simulation;
use moorline::statics::equilibrium;
use moorline::statics::modes::Modes;
use nalgebra::Vector3;

/// The five public scenes: name, duration of the window that errors are taken over [s].
pub const PUBLIC_SCENES: [(&str, f64); 5] = [
    ("oc3_catenary", 60.0),
    ("oc4_chain", 60.0),
    ("taut_polyester", 60.0),
    ("lindahl_fast", 12.5),
    ("lindahl_slow", 12.5),
];

/// A scene from TOML text.
pub fn scene(text: &str) -> Scene {
    Scene::from_toml(text).unwrap()
}

/// The model of a scene from TOML text.
pub fn model(text: &str) -> Model {
    Model::new(&scene(text)).unwrap()
}

/// Where the scene puts the points [m].
pub fn at_reference(model: &Model) -> Vec<Vector3<f64>> {
    model.points.iter().map(|point| point.reference).collect()
}

/// Points at rest at places [m].
pub fn resting(places: &[Vector3<f64>]) -> Vec<PointState> {
    places.iter().copied().map(PointState::at_rest).collect()
}

/// Equilibrium with the points where the scene puts them.
pub fn statics(model: &Model) -> State {
    let points = resting(&at_reference(model));
    equilibrium::solve(model, &points, 0.0, &mut Workspace::new(model)).unwrap()
}

/// A scene of the folder `scenes`.
pub fn shipped(name: &str) -> Scene {
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    scene(&std::fs::read_to_string(path).unwrap())
}

/// The same scene with `count` elements on every section.
pub fn with_elements(mut scene: Scene, count: usize) -> Scene {
    for section in scene.lines.iter_mut().flat_map(|line| &mut line.sections) {
        section.elements = Some(count);
    }
    scene
}

/// The same scene with an integrator and an upper limit of its step [s].
pub fn with_integrator(mut scene: Scene, integrator: Integrator, time_step_max: f64) -> Scene {
    scene.solver.integrator = integrator;
    scene.solver.time_step_max = time_step_max;
    scene
}

/// The same scene with its first line released from the given nodes.
pub fn released_from(mut scene: Scene, nodes: &[Vector3<f64>]) -> Scene {
    scene.lines[0].initial = InitialShape::Nodes(nodes.iter().map(|node| (*node).into()).collect());
    scene
}

/// A simulation whose coupled points follow the scene's own motion.
pub fn following(scene: &Scene) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.follow_scene().unwrap();
    simulation
}

/// Modes of the first network about the present state.
pub fn modes(simulation: &Simulation) -> Modes {
    let model: &Model = simulation.model();
    Modes::new(model, 0, simulation.state(), &mut Workspace::new(model)).unwrap()
}

/// What the first line did, sampled at every communication point.
#[derive(Default, Clone)]
pub struct History {
    /// Tension at end B [N].
    pub tension: Vec<f64>,
    /// Position of the node in the middle [m].
    pub middle: Vec<Vector3<f64>>,
    /// Internal steps, of all communication steps.
    pub substeps: usize,
    /// Force evaluations or linear solves, of all communication steps.
    pub solves: usize,
}

impl History {
    /// Steps a simulation `count` times by `step` [s], the start included as the first sample.
    pub fn record(simulation: &mut Simulation, step: f64, count: usize) -> History {
        let mut history = History::default();
        history.sample(simulation);
        for _ in 0..count {
            simulation.advance(step).unwrap();
            history.sample(simulation);
            history.substeps += simulation.counters().substeps;
            history.solves += simulation.counters().solves;
        }
        history
    }

    /// A sample of the present.
    pub fn sample(&mut self, simulation: &Simulation) {
        let nodes = &simulation.state().lines[0].position;
        self.tension.push(simulation.tension_b(0));
        self.middle.push(nodes[nodes.len() / 2]);
    }

    /// RMS(T − T_ref)/std(T_ref) over the last `count` samples [-].
    pub fn tension_error(&self, reference: &History, count: usize) -> f64 {
        let vectors = |history: &History| -> Vec<Vector3<f64>> {
            last(&history.tension, count)
                .iter()
                .map(|t| Vector3::new(*t, 0.0, 0.0))
                .collect()
        };
        relative_rms(&vectors(self), &vectors(reference))
    }

    /// The same of the middle node's position, as a vector [-].
    pub fn middle_error(&self, reference: &History, count: usize) -> f64 {
        relative_rms(last(&self.middle, count), last(&reference.middle, count))
    }
}

/// The last `count` entries.
pub fn last<T>(values: &[T], count: usize) -> &[T] {
    &values[values.len() - count..]
}

/// RMS of the difference over the standard deviation of the reference [-].
pub fn relative_rms(values: &[Vector3<f64>], reference: &[Vector3<f64>]) -> f64 {
    let mean = reference.iter().sum::<Vector3<f64>>() / reference.len() as f64;
    let spread: f64 = reference.iter().map(|r| (r - mean).norm_squared()).sum();
    let error: f64 = values
        .iter()
        .zip(reference)
        .map(|(v, r)| (v - r).norm_squared())
        .sum();
    (error / spread).sqrt()
}

/// Slope of log(error) over log(size), by least squares [-].
pub fn order(sizes: &[f64], errors: &[f64]) -> f64 {
    assert!(sizes.len() >= 4 && sizes.len() == errors.len());
    let logs: Vec<(f64, f64)> = sizes
        .iter()
        .zip(errors)
        .map(|(h, e)| (h.ln(), e.abs().ln()))
        .collect();
    let count = logs.len() as f64;
    let (x, y) = (
        logs.iter().map(|l| l.0).sum::<f64>() / count,
        logs.iter().map(|l| l.1).sum::<f64>() / count,
    );
    logs.iter().map(|l| (l.0 - x) * (l.1 - y)).sum::<f64>()
        / logs.iter().map(|l| (l.0 - x).powi(2)).sum::<f64>()
}

/// [`order`] of pairs of size and error [-].
pub fn order_of(pairs: &[(f64, f64)]) -> f64 {
    let (sizes, errors): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    order(&sizes, &errors)
}

/// Claims that errors fall with the resolution at an order ± 0.1.
pub fn assert_order(claimed: f64, sizes: &[f64], errors: &[f64]) {
    let fitted = order(sizes, errors);
    assert!(
        (fitted - claimed).abs() <= 0.1,
        "order {fitted:.3} instead of {claimed}: {errors:?} at {sizes:?}"
    );
}

/// Claims that errors fall with the resolution at an order − 0.1 or a higher one.
pub fn assert_order_at_least(claimed: f64, sizes: &[f64], errors: &[f64]) {
    let fitted = order(sizes, errors);
    assert!(
        fitted >= claimed - 0.1,
        "order {fitted:.3}, less than {claimed}: {errors:?} at {sizes:?}"
    );
}

/// Circular frequency [rad/s] of one harmonic sampled every `step` [s]: q_{k+1} + q_{k−1} = 2 cos(ωh) q_k, by least squares.
pub fn sampled_frequency(samples: &[f64], step: f64) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for s in samples.windows(3) {
        product += s[1] * (s[0] + s[2]);
        square += s[1] * s[1];
    }
    (0.5 * product / square).acos() / step
}

/// Gives the nodes of the first line, and the points at its ends, velocities [m/s].
pub fn set_node_velocities(simulation: &mut Simulation, velocities: &[Vector3<f64>]) {
    let [a, b] = simulation.model().lines[0].ends;
    let mut snapshot = serde_json::to_value(simulation.snapshot()).unwrap();
    let state = &mut snapshot["state"];
    let ends = [(a, velocities[0]), (b, velocities[velocities.len() - 1])];
    for (point, velocity) in ends {
        state["points"][point]["velocity"] = serde_json::to_value(velocity).unwrap();
    }
    state["lines"][0]["velocity"] = serde_json::to_value(velocities).unwrap();
    simulation.restore(serde_json::from_value(snapshot).unwrap());
}

/// Times [s] at which samples taken every `step` [s] from 0 change sign, by linear interpolation.
pub fn zero_crossings(samples: &[f64], step: f64) -> Vec<f64> {
    let pairs = samples.windows(2).enumerate();
    let crossing = |(k, pair): (usize, &[f64])| {
        (pair[0] * pair[1] < 0.0).then(|| step * (k as f64 + pair[0] / (pair[0] - pair[1])))
    };
    pairs.filter_map(crossing).collect()
}

/// A number in 0 … 1, and the next seed.
pub fn random(seed: &mut u64) -> f64 {
    let mut chance = Chance(*seed);
    chance.next();
    *seed = chance.0;
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

/// A generator of numbers from a seed: Knuth's multiplier and increment of the linear congruential kind, upper bits.
pub struct Chance(pub u64);

impl Chance {
    fn next(&mut self) {
        let multiplied = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = multiplied.wrapping_add(1_442_695_040_888_963_407);
    }

    /// A number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        self.next();
        ((self.0 >> 33) as usize) % count.max(1)
    }

    /// An element of a list.
    pub fn one_of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}
