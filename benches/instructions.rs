//! Instruction counts of fixed steps by valgrind, compared with a table; other programs on the machine hardly affect them.
//!
//! `cargo bench --bench instructions` prints the changes, and fails if the steps of a scene take over 3 % more than in the table. `-- --write` writes
//! a new table. The table applies to every x86-64 processor with AVX2, whose counts agree within 0.3 %; on other processors and without valgrind,
//! nothing is compared.
//!
//! Valgrind runs this program itself with the name of a scene and a number of steps. The difference between two runs of different length is the cost
//! of the steps between them, without the start.

mod common;

use std::env;
use std::fmt::Write;
use std::fs;
use std::process::{Command, ExitCode};

use moorline::simulation::Simulation;

/// Table of the counts on x86-64 with AVX2.
const TABLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/benches/tables/x86-64-avx2.instructions.csv"
);
/// Growth beyond which the bench fails [-].
const ALLOWED: f64 = 0.03;
/// Communication steps of the short and the long run [-].
const STEPS: [usize; 2] = [20, 120];

/// Scenes that together use every integrator except the quasi-static one.
const SCENES: [&str; 8] = [
    "oc3_catenary",
    "oc4_chain",
    "taut_polyester",
    "lindahl_fast",
    "bridle",
    "lazy_wave",
    "power_cable",
    "flying_spaghetti",
];

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = words
        .iter()
        .map(String::as_str)
        .filter(|word| *word != "--bench")
        .collect();
    match words[..] {
        [scene, steps] => {
            step(scene, steps.parse().expect("a number of steps"));
            ExitCode::SUCCESS
        }
        ["--write"] => write(),
        _ => compare(),
    }
}

/// Steps a scene by its output interval, with the motion of the scene.
fn step(name: &str, count: usize) {
    let scene = common::scene(name);
    let mut simulation = Simulation::new(&scene).expect("an equilibrium");
    simulation.follow_scene().expect("an equilibrium");
    for _ in 0..count {
        simulation.advance(scene.output.interval).expect("a step");
    }
}

/// Instructions that valgrind counts in a run; `None` without valgrind.
fn counted(scene: &str, steps: usize) -> Option<u64> {
    let program = env::current_exe().ok()?;
    let run = Command::new("valgrind")
        .args([
            "--tool=cachegrind",
            "--cache-sim=no",
            "--cachegrind-out-file=/dev/null",
        ])
        .arg(program)
        .args([scene, &steps.to_string()])
        .output()
        .ok()?;
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{scene}: {said}");
    let (_, count) = said.split_once("refs:")?;
    let count = count.lines().next()?.trim().replace(',', "");
    count.parse().ok()
}

/// Returns whether the table applies to this processor.
fn held() -> bool {
    #[cfg(target_arch = "x86_64")]
    return is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    return false;
}

/// Instructions of a communication step of every scene; `None` if they cannot be counted as those of the table.
fn counts() -> Option<Vec<(&'static str, u64)>> {
    if !held() {
        return None;
    }
    let [short, long] = STEPS;
    let count = |scene| {
        let between = counted(scene, long)? - counted(scene, short)?;
        Some((scene, between / (long - short) as u64))
    };
    SCENES.into_iter().map(count).collect()
}

fn write() -> ExitCode {
    let Some(counts) = counts() else {
        println!("no valgrind or no AVX2: instructions are not counted");
        return ExitCode::FAILURE;
    };
    let mut text = String::from("scene,instructions per communication step\n");
    for (scene, count) in counts {
        writeln!(text, "{scene},{count}").expect("a String takes all");
    }
    fs::write(TABLE, text).expect("the table can be written");
    ExitCode::SUCCESS
}

fn compare() -> ExitCode {
    let text = fs::read_to_string(TABLE).expect("the table of the counts");
    let Some(counts) = counts() else {
        println!("no valgrind or no AVX2: instructions are not counted");
        return ExitCode::SUCCESS;
    };
    let mut dearer = false;
    for (scene, now) in counts {
        let row = text
            .lines()
            .find_map(|line| line.strip_prefix(scene)?.strip_prefix(','));
        let Some(before) = row.and_then(|count| count.parse::<u64>().ok()) else {
            println!("{scene:<16} {now:>12}, not in the table");
            continue;
        };
        let change = now as f64 / before as f64 - 1.0;
        dearer |= change > ALLOWED;
        println!(
            "{scene:<16} {before:>12} before {now:>12} now {:+6.1} %",
            100.0 * change
        );
    }
    if dearer {
        println!(
            "steps take over {} % more instructions: where that is meant, write the table anew and say why",
            100.0 * ALLOWED
        );
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
