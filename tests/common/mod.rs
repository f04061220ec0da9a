//! Scenes, runs, histories, error measures and assertions shared by many tests.
#![allow(dead_code, unused_imports)] // each test binary uses some of it

mod chance;
pub mod draft;
mod text;

pub use chance::Chance;
pub use draft::{Draft, draft};
pub use text::{assert_answers, assert_says};

use moorline::dynamics::energy_balance::Flow;
use moorline::elements::Workspace;
use moorline::model::{Kinematics, Model, PointState, State};
use moorline::scene::{InitialShape, Integrator, Scene};
use moorline::simulation::{Simulation, Snapshot};
use moorline::statics::modes::Modes;
use moorline::statics::{StaticsError, equilibrium};
use nalgebra::Vector3;

/// Density of sea water [kg/m³].
pub const RHO: f64 = 1025.0;
/// Gravity [m/s²].
pub const G: f64 = 9.80665;

/// Integrators of single lines and of networks.
pub const INTEGRATORS: [Integrator; 3] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
];
/// Integrators of lines joined at free points.
pub const JOINED: [Integrator; 3] = INTEGRATORS;

/// Coarse steps [s] of the three integrators, from which errors decrease with the full order.
pub const COARSE_STEPS: [(Integrator, f64); 3] = [
    (Integrator::Leapfrog, 4e-3),
    (Integrator::AxialImplicit, 4e-2),
    (Integrator::GeneralisedAlpha, 4e-2),
];

/// The five public scenes: name, and duration of the window in which errors are evaluated [s].
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

/// Reference positions of the points [m].
pub fn at_reference(model: &Model) -> Vec<Vector3<f64>> {
    model.points.iter().map(|point| point.reference).collect()
}

/// Points at rest at these positions [m].
pub fn resting(places: &[Vector3<f64>]) -> Vec<PointState> {
    places.iter().copied().map(PointState::at_rest).collect()
}

/// Equilibrium with the points at their positions in the scene.
pub fn statics(model: &Model) -> State {
    let points = resting(&at_reference(model));
    equilibrium::solve(model, &points, 0.0, &mut Workspace::new(model)).unwrap()
}

/// Moves the prescribed points of the first network to positions [m] and finds the equilibrium at time `t` [s] closest to a state.
pub fn continue_from(
    model: &Model,
    state: &mut State,
    places: &[Vector3<f64>],
    t: f64,
    work: &mut Workspace,
) -> Result<(), StaticsError> {
    let held = |point: usize| Kinematics {
        position: places[point],
        ..Kinematics::default()
    };
    equilibrium::continue_network(model, 0, state, held, t, work)?;
    state.time = t;
    Ok(())
}

/// A scene from the folder `scenes`.
pub fn shipped(name: &str) -> Scene {
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    scene(&std::fs::read_to_string(path).unwrap())
}

/// The scene with `count` elements in every section.
pub fn with_elements(mut scene: Scene, count: usize) -> Scene {
    for section in scene.lines.iter_mut().flat_map(|line| &mut line.sections) {
        section.elements = Some(count);
    }
    scene
}

/// The scene with the elements of its lines left open.
pub fn open(mut scene: Scene) -> Scene {
    for section in scene.lines.iter_mut().flat_map(|line| &mut line.sections) {
        section.elements = None;
    }
    scene
}

/// The scene with an integrator and an upper limit of its time step [s].
pub fn with_integrator(mut scene: Scene, integrator: Integrator, time_step_max: f64) -> Scene {
    scene.solver.integrator = integrator;
    scene.solver.time_step_max = time_step_max;
    scene
}

/// The scene with its first line starting from the given nodes.
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

/// Sets the pose of every body to that of the scene's motion at a time [s], with or without velocities.
pub fn set_motion(simulation: &mut Simulation, time: f64, velocities: bool) {
    for moving in simulation.model().moving(time) {
        let velocity = moving.velocity.map(|rate| velocities.then_some(rate));
        simulation.set_body(moving.body, moving.pose, velocity);
    }
}

/// A simulation of a scene at its start.
pub fn start(scene: &Scene) -> Simulation {
    Simulation::new(scene).unwrap()
}

/// Makes `count` communication steps of `step` [s].
pub fn run(simulation: &mut Simulation, step: f64, count: usize) {
    (0..count).for_each(|_| simulation.advance(step).unwrap());
}

/// Nodes of the first line [m].
pub fn nodes(simulation: &Simulation) -> &[Vector3<f64>] {
    &simulation.state().lines[0].position
}

/// Position of a point by name [m].
pub fn place(simulation: &Simulation, name: &str) -> Vector3<f64> {
    simulation.state().points[simulation.model().point_index(name).unwrap()].position
}

/// Greatest distance between corresponding nodes of two lines [m].
pub fn gap(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    greatest(a.iter().zip(b).map(|(a, b)| (a - b).norm()))
}

/// The greatest of several numbers, at least 0.
pub fn greatest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

/// Greatest distance of the first line's nodes from their current positions [m] after any of `count` steps of `step` [s].
pub fn drift(simulation: &mut Simulation, step: f64, count: usize) -> f64 {
    let start = nodes(simulation).to_vec();
    greatest((0..count).map(|_| {
        simulation.advance(step).unwrap();
        gap(nodes(simulation), &start)
    }))
}

/// Greatest displacement of a node of any line after `count` steps of 1 s, relative to the length of its line [-].
pub fn relative_drift(scene: &Scene, count: usize) -> f64 {
    let mut simulation = start(scene);
    let first = simulation.state().clone();
    run(&mut simulation, 1.0, count);
    let lines = simulation.state().lines.iter().zip(&first.lines).enumerate();
    greatest(lines.map(|(line, (now, then))| {
        gap(&now.position, &then.position) / simulation.model().lines[line].unstretched_length()
    }))
}

/// The scene with the energy balance enabled.
pub fn balanced(mut scene: Scene) -> Scene {
    scene.output.energy_balance = true;
    scene
}

/// Error of the energy balance [J].
pub fn balance_error(simulation: &Simulation) -> f64 {
    simulation.energy_balance().unwrap().error()
}

/// External work and dissipation of the lines since the start [J].
pub fn flow(simulation: &Simulation) -> Flow {
    simulation.energy_balance().unwrap().flow
}

/// Error of the energy balance relative to the external work [-].
pub fn error_of_given(simulation: &Simulation) -> f64 {
    balance_error(simulation).abs() / flow(simulation).external_work
}

/// Error of the energy balance relative to the dissipation [-].
pub fn error_of_lost(simulation: &Simulation) -> f64 {
    balance_error(simulation).abs() / flow(simulation).dissipation
}

/// Asserts that a simulation continues bit for bit from its restored snapshot, and so does another simulation of the scene
/// from the snapshot's bytes.
pub fn assert_replays(mut simulation: Simulation, mut other: Simulation, go_on: impl Fn(&mut Simulation)) {
    let saved = simulation.snapshot().clone();
    let bytes = postcard::to_stdvec(&saved).unwrap();
    go_on(&mut simulation);
    let first = simulation.snapshot().clone();
    simulation.restore(saved);
    go_on(&mut simulation);
    assert!(
        *simulation.snapshot() == first,
        "the same simulation goes on otherwise"
    );
    other.restore(postcard::from_bytes::<Snapshot>(&bytes).unwrap());
    go_on(&mut other);
    assert!(*other.snapshot() == first, "a new simulation goes on otherwise");
    assert_eq!(
        postcard::to_stdvec(other.snapshot()).unwrap(),
        postcard::to_stdvec(&first).unwrap()
    );
    for point in 0..other.model().points.len() {
        assert_eq!(other.end_force(point), simulation.end_force(point));
    }
}

/// Asserts that halving a step quarters the error of a position [m], from a coarse step [s] on, against a 32nd of that step.
pub fn assert_second_order_in_time(coarse: f64, place: impl Fn(f64) -> Vector3<f64>) {
    let steps = [1.0, 0.5, 0.25, 0.125, 1.0 / 32.0].map(|part| part * coarse);
    let places = steps.map(place);
    let errors = [0, 1, 2, 3].map(|i| (places[i] - places[4]).norm());
    assert_order(2.0, &steps[..4], &errors);
}

/// Asserts that the error of the energy balance relative to the external work is below `bound` [-] at 0.125 of the coarse step; that it decreases at second
/// order for the axial-implicit integrator; and that it is that of Newton's method for generalised-α.
pub fn assert_balance_order(integrator: Integrator, coarse: f64, bound: f64, error: impl Fn(f64) -> f64) {
    let steps = [1.0, 0.5, 0.25, 0.125].map(|part| part * coarse);
    let errors = steps.map(error);
    assert!(errors[3] < bound, "{integrator:?}: {errors:?}");
    match integrator {
        Integrator::AxialImplicit => assert_order(2.0, &steps, &errors),
        Integrator::GeneralisedAlpha => assert!(errors[0] < 1e-8, "{errors:?}"),
        _ => {}
    }
}

/// Asserts that a scene written as TOML is read back unchanged.
pub fn assert_written_and_read(scene: &Scene) {
    let text = scene.to_toml();
    assert_eq!(Scene::from_toml(&text).unwrap(), *scene, "{text}");
}

/// Returns the sentences of `check` on a scene, in one line.
pub fn in_words(scene: &Scene) -> String {
    scene.in_words().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Modes of the first network about the current state.
pub fn modes(simulation: &Simulation) -> Modes {
    let model: &Model = simulation.model();
    let mut work = Workspace::new(model);
    Modes::lowest(model, 0, simulation.state(), usize::MAX, &mut work).unwrap()
}

/// Record of the first line, sampled at every communication point.
#[derive(Default, Clone)]
pub struct History {
    /// Tension at end B [N].
    pub tension: Vec<f64>,
    /// Position of the middle node [m].
    pub middle: Vec<Vector3<f64>>,
    /// Number of internal steps in all communication steps [-].
    pub substeps: usize,
    /// Number of force evaluations or linear solves in all communication steps [-].
    pub solves: usize,
}

impl History {
    /// Makes `count` steps of `step` [s]; the start is the first sample.
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

    /// Samples the current state.
    pub fn sample(&mut self, simulation: &Simulation) {
        let nodes = &simulation.state().lines[0].position;
        self.tension.push(simulation.tension_b(0));
        self.middle.push(nodes[nodes.len() / 2]);
    }

    /// RMS(T − T_ref)/std(T_ref) over the last `count` samples [-].
    pub fn tension_error(&self, reference: &History, count: usize) -> f64 {
        let vector = |t: &f64| Vector3::new(*t, 0.0, 0.0);
        let vectors = |of: &History| last(&of.tension, count).iter().map(vector).collect::<Vec<_>>();
        relative_rms(&vectors(self), &vectors(reference))
    }

    /// The same error for the position of the middle node, a vector [-].
    pub fn middle_error(&self, reference: &History, count: usize) -> f64 {
        relative_rms(last(&self.middle, count), last(&reference.middle, count))
    }
}

/// The last `count` entries.
pub fn last<T>(values: &[T], count: usize) -> &[T] {
    &values[values.len() - count..]
}

/// RMS of the difference, relative to the standard deviation of the reference [-].
pub fn relative_rms(values: &[Vector3<f64>], reference: &[Vector3<f64>]) -> f64 {
    let mean = reference.iter().sum::<Vector3<f64>>() / reference.len() as f64;
    let spread: f64 = reference.iter().map(|r| (r - mean).norm_squared()).sum();
    let pairs = values.iter().zip(reference);
    let error: f64 = pairs.map(|(v, r)| (v - r).norm_squared()).sum();
    (error / spread).sqrt()
}

/// Slope of log(error) against log(size), by least squares [-].
pub fn order(sizes: &[f64], errors: &[f64]) -> f64 {
    assert!(sizes.len() >= 4 && sizes.len() == errors.len());
    let pairs = sizes.iter().zip(errors);
    let logs: Vec<(f64, f64)> = pairs.map(|(h, e)| (h.ln(), e.abs().ln())).collect();
    let mean = |part: fn(&(f64, f64)) -> f64| logs.iter().map(part).sum::<f64>() / logs.len() as f64;
    let (x, y) = (mean(|log| log.0), mean(|log| log.1));
    let slopes = logs
        .iter()
        .map(|log| ((log.0 - x) * (log.1 - y), (log.0 - x).powi(2)));
    let (rise, run) = slopes.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    rise / run
}

/// [`order`] of pairs of size and error [-].
pub fn order_of(pairs: &[(f64, f64)]) -> f64 {
    let (sizes, errors): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    order(&sizes, &errors)
}

/// Asserts that errors decrease with the resolution at an order ± 0.1.
pub fn assert_order(claimed: f64, sizes: &[f64], errors: &[f64]) {
    let fitted = order(sizes, errors);
    assert!(
        (fitted - claimed).abs() <= 0.1,
        "order {fitted:.3} instead of {claimed}: {errors:?} at {sizes:?}"
    );
}

/// [`assert_order`] of pairs of size and error.
pub fn assert_orders(claimed: f64, pairs: &[(f64, f64)]) {
    let (sizes, errors): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    assert_order(claimed, &sizes, &errors);
}

/// Asserts that errors decrease with the resolution at an order of at least the claimed one − 0.1.
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

/// Sets velocities [m/s] of the nodes of the first line and of the points at its ends.
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

/// Mean time between sign changes of samples taken every `step` [s], from the first change to the last [s].
pub fn half_period(samples: &[f64], step: f64) -> f64 {
    let crossings = zero_crossings(samples, step);
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64
}

/// Cosine and sine of the angle from the horizontal [-] of a cable of a weight [N/m], diameter [m] and normal and tangential drag coefficients that
/// trails behind its upper end, and the slope of its tension [N/m], in a flow of a speed [m/s].
///
///   w cos φ = R_n sin²φ: cos φ = ½(√(a² + 4) − a), a = w/R_n; dT/ds = w sin φ + R_t cos²φ
pub fn streaming_cable([w, d, normal, tangential]: [f64; 4], speed: f64) -> [f64; 3] {
    let a = w / (0.5 * RHO * d * normal * speed * speed);
    let cos = 0.5 * ((a * a + 4.0).sqrt() - a);
    let sin = (1.0 - cos * cos).sqrt();
    let along = 0.5 * RHO * std::f64::consts::PI * d * tangential * speed * speed * cos * cos;
    [cos, sin, w * sin + along]
}

/// Arithmetic-geometric mean.
pub fn agm(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

/// Root of an increasing function in a range, by bisection.
pub fn bisect([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        match value(middle) < 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

/// Times [s] of sign changes of samples taken every `step` [s] from 0, by linear interpolation.
pub fn zero_crossings(samples: &[f64], step: f64) -> Vec<f64> {
    let pairs = samples.windows(2).enumerate();
    let crossing = |(k, pair): (usize, &[f64])| {
        (pair[0] * pair[1] < 0.0).then(|| step * (k as f64 + pair[0] / (pair[0] - pair[1])))
    };
    pairs.filter_map(crossing).collect()
}

/// Returns a number in 0 … 1 and advances the seed: upper bits of a linear congruential generator with Knuth's multiplier and increment.
pub fn random(seed: &mut u64) -> f64 {
    let multiplied = seed.wrapping_mul(6_364_136_223_846_793_005);
    *seed = multiplied.wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}
