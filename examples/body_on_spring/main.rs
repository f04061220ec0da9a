//! Masters for a body on a spring with the OC3 line: error of each, by body mass and communication step.
//!
//! `cargo run --release --example body_on_spring` writes the table of `docs/coupling.md`. The error is the RMS difference of the body's displacement
//! from a run with the impedance of the coming step and a step of 1/80 s, relative to the RMS displacement of that run. `-` is an unstable run; the
//! maximum number of iterations of a step is in brackets.

mod host;

use host::{Case, Master, Run, run};
use moorline::scene::Scene;

const MASSES: [f64; 7] = [10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7];
const STEPS: [f64; 3] = [0.025, 0.05, 0.1];
const MASTERS: [(&str, Master); 6] = [
    ("Jacobi", Master::Jacobi),
    ("body first", Master::BodyFirst),
    ("body first, mass", Master::Mass),
    ("impedance", Master::Impedance),
    ("fixed point", Master::FixedPoint),
    ("Newton", Master::Newton),
];
/// Step of the reference [s].
const FINE: f64 = 0.0125;

fn main() {
    let scene =
        Scene::from_toml(include_str!("../../scenes/oc3_catenary.toml")).expect("a scene of this repository");
    let names: Vec<&str> = MASTERS.iter().map(|(name, _)| *name).collect();
    println!("| mass [kg] | h [s] | {} |", names.join(" | "));
    println!("|---|---|{}", "---|".repeat(names.len()));
    for mass in MASSES {
        let case = |step: f64| Case {
            mass,
            spring: 1e6,
            step,
            duration: 40.0,
        };
        let truth = run(&scene, "fairlead", Master::Impedance, case(FINE));
        let (truth, _) = truth.expect("the reference is stable");
        for step in STEPS {
            let cells = MASTERS.map(|(_, master)| cell(run(&scene, "fairlead", master, case(step)), &truth));
            println!("| {mass:e} | {step} | {} |", cells.join(" | "));
        }
    }
}

/// Table cell with the error of a run.
fn cell(found: Option<Run>, truth: &[nalgebra::Vector3<f64>]) -> String {
    let Some((path, iterations)) = found else {
        return "-".to_string();
    };
    let each = (truth.len() - 1) / (path.len() - 1);
    let pairs = || path.iter().zip(truth.iter().step_by(each));
    let missed: f64 = pairs().map(|(a, b)| (a - b).norm_squared()).sum();
    let whole: f64 = pairs().map(|(_, b)| b.norm_squared()).sum();
    let error = 100.0 * (missed / whole).sqrt();
    match iterations {
        1 => format!("{error:.2} %"),
        _ => format!("{error:.2} % ({iterations})"),
    }
}
