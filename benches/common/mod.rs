//! Timing of fixed steps from a saved state: the minimum of many repetitions, which noise cannot lower.
#![allow(dead_code)] // each bench uses a part

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use moorline::scene::Scene;
use moorline::simulation::Simulation;

/// Number of repetitions; the fastest counts.
const REPETITIONS: usize = 40;
/// Time before the timed steps, for the ramp to pass [s].
const WARM_UP: f64 = 30.0;
/// Timed span [s].
const SPAN: f64 = 5.0;

/// Cost of one scene.
pub struct Cost {
    /// CPU time per node and internal step [ns].
    pub node_step: f64,
    /// CPU time per simulated second [s/s].
    pub second: f64,
    /// Internal steps per simulated second [1/s].
    pub steps: f64,
}

/// Reads a scene of `scenes/`.
pub fn scene(name: &str) -> Scene {
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("a scene of the repository");
    Scene::from_toml(&text).expect("a scene that passes its checks")
}

/// Path of a table of this processor, `benches/tables/<processor>.<name>.csv`; `None` if the name of the processor is not known.
pub fn table(name: &str) -> Option<PathBuf> {
    let known = fs::read_to_string("/proc/cpuinfo").ok()?;
    let processor = known.lines().find_map(|line| line.strip_prefix("model name"))?;
    let processor = processor.trim_start_matches([' ', '\t', ':']).to_lowercase();
    let words = processor.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/tables");
    Some(folder.join(format!("{}.{name}.csv", words.join("-"))))
}

/// Writes a table of this processor; returns whether the name of the processor is known.
pub fn write_table(name: &str, text: &str) -> bool {
    let Some(path) = table(name) else {
        return false;
    };
    let folder = path.parent().expect("a table is in a folder");
    fs::create_dir_all(folder).expect("the folder of the tables");
    fs::write(&path, text).expect("the table can be written");
    true
}

/// Times communication steps of the output interval, with the motion of the scene.
pub fn measure(scene: &Scene) -> Cost {
    let interval = scene.output.interval;
    let mut simulation = Simulation::new(scene).expect("an equilibrium");
    simulation.follow_scene().expect("an equilibrium");
    while simulation.time() < WARM_UP {
        simulation.advance(interval).expect("a step");
    }
    let start = simulation.snapshot().clone();
    let count = (SPAN / interval).round() as usize;
    let (mut best, mut substeps) = (f64::INFINITY, 0);
    for _ in 0..REPETITIONS {
        simulation.restore(start.clone());
        substeps = 0;
        let clock = Instant::now();
        for _ in 0..count {
            simulation.advance(interval).expect("a step");
            substeps += simulation.substeps();
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    let nodes: usize = simulation
        .model()
        .lines
        .iter()
        .map(|line| line.segment_count() + 1)
        .sum();
    Cost {
        node_step: 1e9 * best / (nodes * substeps) as f64,
        second: best / SPAN,
        steps: substeps as f64 / SPAN,
    }
}
