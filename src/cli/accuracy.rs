//! `moorline accuracy`: speed against error on this machine.

use std::path::{Path, PathBuf};

use moorline::accuracy::{Code, Metric, Peers, Run, Study, study};
use moorline::output::accuracy::write_runs;
use moorline::output::figures::frontier;
use moorline::output::{make_folder, write_file};
use moorline::scene::{Scene, Supplement};

use super::failure::Failure;
use super::summary::Table;
use super::{print, progress, read_scene};

/// The public scenes, built in.
const PUBLIC: [(&str, &str); 5] = [
    (
        "oc3_catenary",
        include_str!("../../scenes/oc3_catenary.toml"),
    ),
    ("oc4_chain", include_str!("../../scenes/oc4_chain.toml")),
    (
        "taut_polyester",
        include_str!("../../scenes/taut_polyester.toml"),
    ),
    (
        "lindahl_fast",
        include_str!("../../scenes/lindahl_fast.toml"),
    ),
    (
        "lindahl_slow",
        include_str!("../../scenes/lindahl_slow.toml"),
    ),
];
/// Error levels of the table [-].
const LEVELS: [f64; 5] = [0.05, 0.03, 0.02, 0.01, 0.005];

/// Studies scenes, prints what each level of error costs and writes table and figures into a folder.
pub fn accuracy(paths: &[PathBuf], folder: &Path, python: Option<&Path>) -> Result<(), Failure> {
    let scenes = scenes(paths)?;
    make_folder(folder)?;
    let peers = python.map(|python| Peers::find(python, folder)).transpose();
    let peers = peers.map_err(|error| Failure::Argument(error.to_string()))?;
    stay_on_one_core();
    let mut studies = Vec::new();
    for (name, scene) in &scenes {
        let bar = progress(1);
        let done = study(name, scene, peers.as_ref(), &mut |done, total| {
            bar.set_length(total as u64);
            bar.set_position(done as u64);
        });
        bar.finish_and_clear();
        let done = done.map_err(|error| Failure::Computation(error.to_string()))?;
        print(&told(&done))?;
        let svg = frontier::figure(&done);
        write_file(&folder.join(format!("{name}.svg")), |w| {
            w.write_all(svg.as_bytes())
        })?;
        studies.push(done);
        // After every scene: an interrupted run keeps what it has.
        write_file(&folder.join("accuracy.csv"), |w| write_runs(&studies, w))?;
    }
    print(&format!("written to {}\n", folder.display()))
}

fn scenes(paths: &[PathBuf]) -> Result<Vec<(String, Scene)>, Failure> {
    if paths.is_empty() {
        let built_in = PUBLIC.iter().map(|(name, text)| {
            let scene = Scene::from_toml(text).expect("the public scenes are tested");
            ((*name).to_string(), scene)
        });
        return Ok(built_in.collect());
    }
    let read = |path: &PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok((
            name.into_owned(),
            read_scene(path, &Supplement::default())?.scene,
        ))
    };
    paths.iter().map(read).collect()
}

/// Keeps this thread, and the peers that it starts, on one core; where the system does not let it, the times still count.
fn stay_on_one_core() {
    if let Some(core) = core_affinity::get_core_ids().and_then(|cores| cores.last().copied()) {
        core_affinity::set_for_current(core);
    }
}

/// A study in a table: cost and setting that reach each level.
fn told(study: &Study) -> String {
    let mut text = format!("{}: {}\n", study.name, study.title);
    text.push_str(&format!("converged solution: {}; ", study.converged));
    let limits = Metric::ALL.map(|m| format!("{} {:.2} %", m.title(), percent(study, m)));
    text.push_str(&format!("its uncertainty: {}\n", limits.join(", ")));
    for metric in Metric::ALL {
        text.push_str(&format!("\n{}\n{}", metric.title(), levels(study, metric)));
    }
    text.push_str(&format!("\nits own choice\n{}", choices(study)));
    for failed in &study.failed {
        text.push_str(&format!("no result: {}: {}\n", failed.label, failed.reason));
    }
    text.push('\n');
    text
}

fn percent(study: &Study, metric: Metric) -> f64 {
    100.0 * study.uncertainty.of(metric)
}

/// The cheapest way to each level of error, and how many times dearer the peers' is.
fn levels(study: &Study, metric: Metric) -> Table {
    let peers = study.peers();
    let names = peers.iter().map(|peer| format!("{peer}, cost"));
    let head = ["error", "cost"]
        .map(str::to_string)
        .into_iter()
        .chain(names);
    let head: Vec<String> = head.chain(["setting".to_string()]).collect();
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let mut table = Table::new(&head).ending_in_words();
    for level in LEVELS {
        let own = study.cheapest(metric, level, Code::is_own);
        let own_cost = own.map_or("—".to_string(), |run| cost(run.cost));
        let mut row = vec![format!("{:.1} %", 100.0 * level), own_cost];
        for peer in &peers {
            let of_peer = |code: &Code| *code == Code::Peer((*peer).to_string());
            let its = study.cheapest(metric, level, of_peer);
            row.push(its.map_or("—".to_string(), |its| beside(its, own)));
        }
        row.push(match own {
            _ if level < study.uncertainty.of(metric) => {
                "within the converged solution's uncertainty".to_string()
            }
            Some(run) => format!("{}, {}", run.code.name(), run.label),
            None => "not reached".to_string(),
        });
        table.text_row(row);
    }
    table
}

/// A peer's cost, and its ratio to ours.
fn beside(its: &Run, own: Option<&Run>) -> String {
    let ratio = own.map_or(String::new(), |own| {
        format!(" ({:.1} x)", its.cost / own.cost)
    });
    format!("{}{ratio}", cost(its.cost))
}

/// What moorline chose for each tolerance, and what came of it.
fn choices(study: &Study) -> Table {
    let titles = Metric::ALL.map(Metric::title);
    let head: Vec<&str> = ["setting", "cost"].into_iter().chain(titles).collect();
    let mut table = Table::new(&head);
    for run in study.runs.iter().filter(|run| run.code == Code::Chosen) {
        let errors = Metric::ALL.map(|metric| format!("{:.2} %", 100.0 * run.errors.of(metric)));
        let mut row = vec![run.label.clone(), cost(run.cost)];
        row.extend(errors);
        table.text_row(row);
    }
    table
}

fn cost(cost: f64) -> String {
    format!("{cost:.2e}")
}
