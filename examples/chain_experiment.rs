//! A sweep over load cases: the 30 conditions of an experiment on a chain in a tank, run in parallel on all processors and compared with the measured
//! forces.
//!
//! The upper end of the chain moves round a circle; where the circle is wide and the period short, the chain slackens and snaps once per turn. Every
//! case is the scene `scenes/bergdahl_chain.toml`, which names the experiment and its parameters, with another circle: twelve turns, of which the
//! first three grow and the last five count. The mean of their maximum forces is compared.
//!
//! `cargo run --release --example chain_experiment` prints the table, and writes the figure `chain_experiment.svg` if a folder is given:
//! `cargo run --release --example chain_experiment -- FOLDER`

use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use moorline::output::figures::agreement::{Series, agreement};
use moorline::scene::{HarmonicMotion, MotionPath, Scene};
use moorline::simulation::Simulation;

const SCENE: &str = include_str!("../scenes/bergdahl_chain.toml");
const MEASURED: &str = include_str!("../tests/reference/bergdahl_2016.csv");

/// Number of turns of a case [-].
const TURNS: usize = 12;
/// Number of turns over which the motion grows [-].
const TURNS_GROWING: f64 = 3.0;
/// Number of last turns whose maximum forces count [-].
const TURNS_COUNTED: usize = 5;
/// Number of force samples per turn [-].
const SAMPLES: usize = 200;

/// Condition of the experiment with its force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// Period of a turn [s].
    pub period: f64,
    /// Radius of the circle [m].
    pub radius: f64,
    /// Mean of the maximum forces of the turns, measured [N].
    pub measured: f64,
}

/// Errors of the computed forces of all cases relative to the measured ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Root mean square error [N].
    pub rms: f64,
    /// Mean of the error magnitudes relative to the measured forces [-].
    pub mean_relative: f64,
    /// Mean error [N].
    pub bias: f64,
    /// Maximum error magnitude relative to the measured force [-].
    pub greatest_relative: f64,
}

/// Conditions of the experiment.
///
/// # Errors
/// Fails if a row is not a condition.
pub fn cases() -> Result<Vec<Case>, Box<dyn Error + Send + Sync>> {
    let rows = MEASURED.lines().filter(|line| !line.starts_with('#'));
    rows.skip(1)
        .map(|row| {
            let numbers: Vec<f64> = row.split(',').map(str::parse).collect::<Result<_, _>>()?;
            let [period, radius, measured] = numbers[..] else {
                return Err(format!("{row:?} is no condition").into());
            };
            Ok(Case {
                period,
                radius,
                measured,
            })
        })
        .collect()
}

/// Scene that all cases share.
///
/// # Errors
/// Fails if the scene is not valid.
pub fn scene() -> Result<Scene, Box<dyn Error + Send + Sync>> {
    Ok(Scene::from_toml(SCENE)?)
}

/// Mean of the maximum forces of the counted turns of a case [N].
///
/// # Errors
/// Fails if the scene is not valid, or if an equilibrium or a step is not found.
pub fn force(scene: &Scene, case: &Case) -> Result<f64, Box<dyn Error + Send + Sync>> {
    let circle = HarmonicMotion {
        x: vec![vec![case.radius, case.period]],
        z: vec![vec![case.radius, case.period, FRAC_PI_2]],
        ramp: Some(TURNS_GROWING * case.period),
        ..HarmonicMotion::default()
    };
    let mut scene = scene.clone();
    scene
        .motion
        .insert("fairlead".to_string(), MotionPath::Harmonic(circle));
    let mut simulation = Simulation::new(&scene)?;
    simulation.follow_scene()?;
    let mut greatest = [0.0_f64; TURNS];
    for turn in &mut greatest {
        for _ in 0..SAMPLES {
            simulation.advance(case.period / SAMPLES as f64)?;
            *turn = turn.max(simulation.tension_b(0));
        }
    }
    let counted = &greatest[TURNS - TURNS_COUNTED..];
    Ok(counted.iter().sum::<f64>() / TURNS_COUNTED as f64)
}

/// Forces of all cases [N], computed on all processors; a free thread takes the next case.
///
/// # Errors
/// Fails with the error of the first case that fails.
pub fn sweep(scene: &Scene, cases: &[Case]) -> Result<Vec<f64>, Box<dyn Error + Send + Sync>> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            done.push((*case, force(scene, case)));
        }
        done
    };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let done: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        let joined = threads.into_iter().map(|thread| thread.join());
        joined
            .flat_map(|one| one.expect("a case that fails says so and does not panic"))
            .collect()
    });
    let mut forces = vec![f64::NAN; cases.len()];
    for (case, force) in done {
        let place = cases.iter().position(|known| *known == case);
        forces[place.expect("the case came from the list")] = force?;
    }
    Ok(forces)
}

/// Errors of the computed forces [N].
pub fn errors(cases: &[Case], forces: &[f64]) -> Errors {
    let count = cases.len() as f64;
    let error = || {
        cases
            .iter()
            .zip(forces)
            .map(|(case, force)| (force - case.measured, case.measured))
    };
    let relative = || error().map(|(error, measured)| (error / measured).abs());
    Errors {
        rms: (error().map(|(error, _)| error * error).sum::<f64>() / count).sqrt(),
        mean_relative: relative().sum::<f64>() / count,
        bias: error().map(|(error, _)| error).sum::<f64>() / count,
        greatest_relative: relative().fold(0.0, f64::max),
    }
}

/// Figure of computed against measured forces, with a series for each period.
fn figure(cases: &[Case], forces: &[f64]) -> Option<String> {
    let mut series: Vec<Series> = Vec::new();
    for (case, force) in cases.iter().zip(forces) {
        let name = format!("period {} s", case.period);
        if series.last().is_none_or(|last| last.name != name) {
            series.push(Series {
                name,
                pairs: Vec::new(),
            });
        }
        if let Some(last) = series.last_mut() {
            last.pairs.push([case.measured, *force]);
        }
    }
    agreement(
        "Mean greatest force of a turn, Bergdahl et al. (2016)",
        "force [N]",
        &series,
    )
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let (scene, cases) = (scene()?, cases()?);
    let forces = sweep(&scene, &cases)?;
    println!("period [s]  radius [m]  measured [N]  computed [N]  error [%]");
    for (case, force) in cases.iter().zip(&forces) {
        println!(
            "{:10.2}  {:10.3}  {:12.1}  {force:12.1}  {:9.1}",
            case.period,
            case.radius,
            case.measured,
            100.0 * (force / case.measured - 1.0)
        );
    }
    let errors = errors(&cases, &forces);
    println!(
        "root mean square {:.2} N, mean relative {:.2} %, bias {:+.2} N, greatest {:.1} %",
        errors.rms,
        100.0 * errors.mean_relative,
        errors.bias,
        100.0 * errors.greatest_relative
    );
    if let Some(folder) = std::env::args().nth(1) {
        let file = Path::new(&folder).join("chain_experiment.svg");
        let svg = figure(&cases, &forces).ok_or("no case, no figure")?;
        std::fs::write(&file, svg)?;
        println!("written to {}", file.display());
    }
    Ok(())
}
