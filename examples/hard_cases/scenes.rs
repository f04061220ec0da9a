//! The hard cases: their scenes, their excitation, and the closed forms for comparison.
//!
//! Shared by the test that asserts the bounds, `tests/systems/hard`, and the example that draws the figures of
//! `docs/hard-cases.md`.

use std::f64::consts::{PI, TAU};

use moorline::math::random::Random;
use moorline::physics::airy::Component;
use moorline::physics::spectrum::Spectrum;
use moorline::scene::channel::LineEnd;
use moorline::scene::{Break, Friction, HarmonicMotion, InitialShape, Integrator, MotionPath, Scene};
use moorline::simulation::Simulation;
use nalgebra::Complex;

/// Gravity of the scenes that are defined here [m/s²].
pub const G: f64 = 9.80665;

/// Integrators that apply to a single cable.
pub const INTEGRATORS: [Integrator; 4] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
    Integrator::Auto,
];

/// Scene from the folder `scenes`.
pub fn shipped(name: &str) -> Scene {
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    written(&text)
}

/// Scene from valid text.
fn written(text: &str) -> Scene {
    Scene::from_toml(text).unwrap_or_else(|error| panic!("{error}"))
}

/// Scene with these keys and one line between two points.
fn single(keys: &str, [a, b]: [&str; 2], line: &str) -> Scene {
    written(&format!(
        "points = [{{ {a} }}, {{ {b} }}]\nlines = [{{ {line} }}]\n{keys}"
    ))
}

/// Keys of a point of a kind at a position [m].
fn end(name: &str, kind: &str, position: [f64; 3]) -> String {
    format!("name = '{name}', kind = '{kind}', position = {position:?}")
}

/// Section of a line type, with its length [m] and number of elements.
fn piece(line_type: &str, length: f64, elements: usize) -> String {
    format!("{{ type = '{line_type}', length = {length:?}, elements = {elements} }}")
}

/// The same scene with `count` elements on every section.
pub fn with_elements(mut scene: Scene, count: usize) -> Scene {
    for section in scene.lines.iter_mut().flat_map(|line| &mut line.sections) {
        section.elements = Some(count);
    }
    scene
}

/// The same scene with an integrator. The implicit one, whose step has no limit, gets the maximum step `implicit_step` [s].
pub fn by(mut scene: Scene, integrator: Integrator, implicit_step: f64) -> Scene {
    scene.solver.integrator = integrator;
    if integrator == Integrator::GeneralisedAlpha {
        scene.solver.time_step_max = implicit_step;
    }
    scene
}

/// The same scene with the axial stiffness of all lines multiplied by a factor [-].
pub fn stiffer(mut scene: Scene, factor: f64) -> Scene {
    let types = scene.line_types.values_mut();
    types
        .flat_map(|kind| &mut kind.axial_stiffness)
        .for_each(|stiffness| *stiffness *= factor);
    scene
}

/// The same scene with the axial damping of all lines multiplied by a factor [-].
pub fn more_damped(mut scene: Scene, factor: f64) -> Scene {
    let types = scene.line_types.values_mut();
    types
        .flat_map(|kind| &mut kind.axial_damping)
        .for_each(|damping| *damping *= factor);
    scene
}

/// The same scene over a seabed whose spring and damper are multiplied by a factor [-].
pub fn harder_seabed(mut scene: Scene, factor: f64) -> Scene {
    if let Some(seabed) = &mut scene.seabed {
        seabed.stiffness *= factor;
        seabed.damping *= factor;
    }
    scene
}

/// OC4 chain on a seabed with friction [-]. Its fairlead moves 40 m towards the anchor and back at 10 m/s, reached in a second, and is at rest again
/// after 10 s.
pub fn dragged_through_touchdown(friction: f64) -> Scene {
    let mut scene = shipped("oc4_chain");
    if let Some(seabed) = &mut scene.seabed {
        seabed.friction = Friction::isotropic(friction);
    }
    let rows = (0..=1000).map(|k| {
        let t = 0.1 * f64::from(k);
        [t, dragged_by(t), 0.0, 0.0, 0.0, 0.0, 0.0]
    });
    let path = MotionPath::Table(rows.collect());
    scene.motion.insert("fairlead".into(), path);
    scene
}

/// Displacement of that fairlead [m] at a time [s].
fn dragged_by(t: f64) -> f64 {
    let there = |t: f64| match t {
        t if t < 1.0 => 5.0 * t * t,
        t if t < 4.0 => 10.0 * t - 5.0,
        t => 40.0 - 5.0 * (5.0 - t) * (5.0 - t),
    };
    match t {
        t if t <= 5.0 => there(t),
        t if t <= 10.0 => there(10.0 - t),
        _ => 0.0,
    }
}

/// Time at which the fairlead of [`jumped`] jumps [s], and the communication step of the jump [s].
pub const JUMP: [f64; 2] = [1.0, 0.05];

/// Input of a host that moves the fairlead by 1 m along x from one communication point to the next.
pub fn jumped(simulation: &mut Simulation) {
    let fairlead = simulation.model().point_index("fairlead");
    let x = f64::from(u8::from(simulation.time() > JUMP[0] - 0.5 * JUMP[1]));
    simulation.set_displacement(fairlead.expect("a fairlead"), [x, 0.0, 0.0]);
}

/// OC3 line whose fairlead oscillates by 5 m along x, with a period of 100 s, and by 2 m along z, with a period of 70 s.
pub fn slowly_moved() -> Scene {
    let mut scene = shipped("oc3_catenary");
    let motion = HarmonicMotion {
        x: vec![vec![5.0, SLOW[0]]],
        z: vec![vec![2.0, SLOW[1]]],
        ..HarmonicMotion::default()
    };
    let path = MotionPath::Harmonic(motion);
    scene.motion.insert("fairlead".into(), path);
    scene
}

/// Periods of that motion [s].
const SLOW: [f64; 2] = [100.0, 70.0];

/// Input of a host of [`slowly_moved`]: position and velocity of the fairlead.
pub fn say_slow(simulation: &mut Simulation) {
    let fairlead = simulation.model().point_index("fairlead");
    let fairlead = fairlead.expect("a fairlead");
    let t = simulation.time();
    let [x, z] = [0, 1].map(|axis| {
        let omega = TAU / SLOW[axis];
        let amplitude = [5.0, 2.0][axis];
        [
            amplitude * (omega * t).sin(),
            amplitude * omega * (omega * t).cos(),
        ]
    });
    simulation.set_displacement(fairlead, [x[0], 0.0, z[0]]);
    simulation.set_velocity(fairlead, [Some(x[1]), Some(0.0), Some(z[1])]);
}

/// Random communication steps from 1 ms to 10 s [s], evenly distributed over the decades.
pub fn irregular_steps(duration: f64) -> Vec<f64> {
    let mut random = Random::new(14);
    let (mut left, mut steps) = (duration, Vec::new());
    while left > 1e-3 {
        let step = 10.0_f64.powf(4.0 * random.unit() - 3.0).min(left);
        steps.push(step);
        left -= step;
    }
    steps
}

/// Rope of 100 m between points 90 m apart, in air, without damping, released 40° out of its plane.
pub fn undamped_swing(elements: usize) -> Scene {
    let mut scene = single(
        "line_types.rope = { mass = 5.0, axial_stiffness = 1.0e6, axial_damping = 0.0 }",
        [
            &end("left", "fixed", [0.0; 3]),
            &end("right", "fixed", [90.0, 0.0, 0.0]),
        ],
        &format!(
            "name = 'rope', from = 'left', to = 'right', sections = [{}]",
            piece("rope", 100.0, elements)
        ),
    );
    let rest = Simulation::new(&scene).expect("the rope hangs");
    let (sin, cos) = 0.7_f64.sin_cos();
    let nodes = rest.state().lines[0].position.iter();
    let tilted = nodes.map(|r| [r.x, -sin * r.z, cos * r.z]);
    scene.lines[0].initial = InitialShape::Nodes(tilted.collect());
    scene
}

/// Time at which both ends of [`released_in_swing`] are released [s].
pub const RELEASE: f64 = 2.0;

/// Rope of [`undamped_swing`] with the default damping, released at both ends in full swing.
pub fn released_in_swing() -> Scene {
    let mut scene = undamped_swing(40);
    for line_type in scene.line_types.values_mut() {
        line_type.axial_damping = None;
    }
    scene.lines[0].release = Some(LineEnd::B);
    scene.lines[0].failure = Some(Break {
        at: LineEnd::A,
        tension: None,
        time: Some(RELEASE),
    });
    scene
}

/// Input of a host of [`released_in_swing`].
pub fn release(simulation: &mut Simulation) {
    let now = simulation.time() > RELEASE - 1e-6;
    simulation.set_release(0, now);
}

/// Chain over a seabed whose middle element is `ratio` times shorter than its neighbours; without that element if `ratio` is 0.
pub fn short_segment(ratio: f64) -> Scene {
    let piece = |length, elements| piece("chain", length, elements);
    let sections = if ratio > 0.0 {
        let short = 5.0 / ratio;
        let half = 75.0 - 0.5 * short;
        [piece(half, 15), piece(short, 1), piece(half, 15)].join(", ")
    } else {
        piece(150.0, 30)
    };
    single(
        "water.density = 1025.0
        seabed.depth = 60.0
        line_types.chain = { mass = 50.0, diameter = 0.08, axial_stiffness = 1.0e8, drag_normal = 1.2, drag_tangential = 0.1,
          added_mass_normal = 1.0 }
        motion.fairlead = { x = [[1.5, 8.0]], z = [[1.0, 6.0]], ramp = 8.0 }",
        [&end("anchor", "fixed", [120.0, 0.0, -60.0]), &end("fairlead", "coupled", [0.0, 0.0, -5.0])],
        &format!("name = 'line1', from = 'anchor', to = 'fairlead', sections = [{sections}]"),
    )
}

/// Mass of the clump [kg].
pub const CLUMP: f64 = 1000.0;
/// Length of its rope [m].
pub const ROPE: f64 = 20.0;
/// EA of its rope [N].
pub const ROPE_STIFFNESS: f64 = 2.0e6;

/// Clump of 1 t on 20 m of rope of 0.1 kg/m, in air, released `lift` metres above the straight rope's position, or at `angle` [rad] to it.
pub fn clump(elements: usize, lift: f64, angle: f64) -> Scene {
    let reach = ROPE * (1.0 + CLUMP * G * angle.cos() / ROPE_STIFFNESS);
    let (x, z) = if lift > 0.0 {
        (0.0, lift - ROPE)
    } else {
        (reach * angle.sin(), -reach * angle.cos())
    };
    let held = end("clump", "free", [x, 0.0, z]);
    let mut scene = single(
        &format!("line_types.rope = {{ mass = 0.1, axial_stiffness = {ROPE_STIFFNESS:e} }}"),
        [
            &format!("{held}, mass = {CLUMP}"),
            &end("pivot", "fixed", [0.0; 3]),
        ],
        &format!(
            "name = 'rope', from = 'clump', to = 'pivot', sections = [{}]",
            piece("rope", ROPE, elements)
        ),
    );
    // a slack rope is bent into two straight halves, with its middle between them
    let beside = (0.25 * (ROPE * ROPE - x * x - z * z)).max(0.0).sqrt();
    let node = |i: usize| {
        let part = 1.0 - i as f64 / elements as f64;
        let middle = 1.0 - (2.0 * part - 1.0).abs();
        [part * x + middle * beside, 0.0, part * z]
    };
    scene.lines[0].initial = InitialShape::Nodes((0..=elements).map(node).collect());
    scene
}

/// Tension of the rope of [`clump`] released at `angle` [rad], every `interval` [s] [N]: the mass on a massless spring, by the Runge-Kutta method in
/// steps of a tenth of the interval.
pub fn swing_pulls(angle: f64, interval: f64, count: usize) -> Vec<f64> {
    let pull = |x: f64, z: f64| ROPE_STIFFNESS * (x.hypot(z) / ROPE - 1.0).max(0.0);
    let rates = |[x, z, vx, vz]: [f64; 4]| {
        let share = pull(x, z) / (CLUMP * x.hypot(z));
        [vx, vz, -share * x, -share * z - G]
    };
    let reach = ROPE * (1.0 + CLUMP * G * angle.cos() / ROPE_STIFFNESS);
    let mut now = [reach * angle.sin(), -reach * angle.cos(), 0.0, 0.0];
    let h = 0.1 * interval;
    let mut pulls = vec![pull(now[0], now[1])];
    for _ in 0..count {
        for _ in 0..10 {
            let after = |k: [f64; 4], part: f64| [0, 1, 2, 3].map(|i| now[i] + part * h * k[i]);
            let k1 = rates(now);
            let k2 = rates(after(k1, 0.5));
            let k3 = rates(after(k2, 0.5));
            let k4 = rates(after(k3, 1.0));
            now = [0, 1, 2, 3].map(|i| now[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        pulls.push(pull(now[0], now[1]));
    }
    pulls
}

/// Maximum tension of the rope that catches [`clump`] dropped by `lift` [m] [N]: m g (h + δ) = EA δ²/2L.
pub fn caught_pull(lift: f64) -> f64 {
    let weight = CLUMP * G;
    weight * (1.0 + (1.0 + 2.0 * lift * ROPE_STIFFNESS / (weight * ROPE)).sqrt())
}

/// Taut line of 100 m of `mass` [kg/m], EA 1 MN, strained by 1 %, in water or in air, driven along and across the line.
pub fn nearly_massless(mass: f64, wet: bool) -> Scene {
    let water = if wet { "water.density = 1025.0" } else { "" };
    single(
        &format!(
            "{water}
            line_types.thread = {{ mass = {mass:e}, diameter = 0.02, axial_stiffness = 1.0e6, drag_normal = 1.2,
              drag_tangential = 0.02, added_mass_normal = 1.0 }}
            motion.fairlead = {{ x = [[0.5, 8.0]], z = [[1.0, 6.0]], ramp = 4.0 }}"
        ),
        [&end("anchor", "fixed", [0.0, 0.0, -100.0]), &end("fairlead", "coupled", [101.0, 0.0, -100.0])],
        &format!("name = 'line1', from = 'anchor', to = 'fairlead', sections = [{}]", piece("thread", 100.0, 10)),
    )
}

/// Length of the folded chain [m].
pub const CHAIN: f64 = 10.0;

/// Chain of 10 m, folded so that both ends are at the same height, `striping` elements apart; one end is released. Node 0 is the free end.
pub fn folded_chain(elements: usize, striping: usize) -> Scene {
    let h = CHAIN / elements as f64;
    let gap = striping as f64 * h;
    let pieces = piece("chain", CHAIN, elements);
    let mut scene = single(
        &format!("gravity = {G}\nline_types.chain = {{ mass = 1.0, axial_stiffness = 1.0e6 }}"),
        [
            &end("hand", "fixed", [gap, 0.0, 0.0]),
            &end("fairlead", "fixed", [0.0; 3]),
        ],
        &format!(
            "name = 'chain', from = 'hand', to = 'fairlead', break = {{ at = 'a', time = 0.0 }}, sections = [{pieces}]"
        ),
    );
    // two arms, and a bottom with as many elements as the gap is wide
    let arm = (elements - striping) / 2;
    let node = |i: usize| {
        let down = i.min(elements - i).min(arm);
        let x = (arm + striping).saturating_sub(i.max(arm)) as f64;
        [x * h, 0.0, -(down as f64) * h]
    };
    scene.lines[0].initial = InitialShape::Nodes((0..=elements).map(node).collect());
    scene
}

/// Time at which the free end of the folded chain has fallen by `part` of its length [s], from v² = g x (2L − x)/(L − x), the energy balance of the
/// one-dimensional chain: with x = L s², t = 2 √(L/g) ∫ √((1 − s²)/(2 − s²)) ds.
///
/// Source: Calkin & March (1989), Am. J. Phys. 57, 154.
pub fn fall_time(part: f64) -> f64 {
    let rate = |s: f64| ((1.0 - s * s) / (2.0 - s * s)).sqrt();
    let (end, count) = (part.sqrt(), 400);
    let h = end / f64::from(count);
    let simpson: f64 = (0..count)
        .map(|i| {
            let s = f64::from(i) * h;
            (rate(s) + 4.0 * rate(s + 0.5 * h) + rate(s + h)) * h / 6.0
        })
        .sum();
    2.0 * (CHAIN / G).sqrt() * simpson
}

/// Force of that chain on its support relative to its weight, after its free end has fallen by `part` of its length [-].
pub fn fall_pull(part: f64) -> f64 {
    0.25 * (2.0 + 2.0 * part - 3.0 * part * part) / (1.0 - part)
}

/// Rod: length [m], EA [N], mass [kg/m], BA [N s], tension [N], amplitude of the driven end [m].
pub const ROD: [f64; 6] = [100.0, 1.0e7, 10.0, 1.0e4, 2.0e5, 1.0e-3];

/// First axial frequency of the rod between fixed ends, π c/L [rad/s].
pub fn rod_frequency() -> f64 {
    let [length, ea, mass, ..] = ROD;
    PI / length * (ea / mass).sqrt()
}

/// Taut rod with one end driven along it at a circular frequency [rad/s]; negligible gravity.
pub fn resonant_rod(elements: usize, omega: f64) -> Scene {
    let [length, ea, mass, ba, tension, amplitude] = ROD;
    let span = length * (1.0 + tension / ea);
    let period = TAU / omega;
    single(
        &format!(
            "gravity = 1.0e-9
            line_types.rod = {{ mass = {mass}, axial_stiffness = {ea:e}, axial_damping = {ba:e} }}
            motion.fairlead = {{ x = [[{amplitude}, {period}]] }}"
        ),
        [
            &end("anchor", "fixed", [0.0; 3]),
            &end("fairlead", "coupled", [span, 0.0, 0.0]),
        ],
        &format!(
            "name = 'rod', from = 'anchor', to = 'fairlead', sections = [{}]",
            piece("rod", length, elements)
        ),
    )
}

/// Amplitude of the tension at the driven end of the damped rod [N]: |(EA + iωBA) k cot kL| a, k = ω √(m/(EA + iωBA)).
pub fn rod_amplitude(omega: f64) -> f64 {
    let [length, ea, mass, ba, _, amplitude] = ROD;
    let stiffness = Complex::new(ea, omega * ba);
    let k = (Complex::from(mass) / stiffness).sqrt() * omega;
    let angle = k * length;
    (stiffness * k * angle.cos() / angle.sin()).norm() * amplitude
}

/// The same scene with its fairlead moved along x and z by two records of 40 sines each, of a JONSWAP spectrum with a significant height [m] and a
/// peak period [s].
pub fn irregular(mut scene: Scene, significant_height: f64, peak_period: f64) -> Scene {
    let spectrum = Spectrum {
        significant_height,
        peak_period,
        peakedness: 3.3,
        direction: 0.0,
        spreading: None,
    };
    let record = |seed: u64| -> Vec<Vec<f64>> {
        let row = |wave: Component| vec![wave.amplitude, TAU / wave.frequency, wave.phase];
        spectrum.draw(40, seed).into_iter().map(row).collect()
    };
    let motion = HarmonicMotion {
        x: record(1),
        z: record(2),
        ramp: Some(60.0),
        ..HarmonicMotion::default()
    };
    let path = MotionPath::Harmonic(motion);
    scene.motion.insert("fairlead".into(), path);
    scene
}
