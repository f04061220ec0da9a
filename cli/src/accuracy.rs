//! `moorline accuracy`: speed against error on this machine.

use std::fs::File;
use std::path::{Path, PathBuf};

use moorline::output::fmi::FmiVersion;
use moorline::output::package::{Container, Stamp, write_package};
use moorline::output::report::rounded;
use moorline::output::write_file;
use moorline::scene::{Drive, Scene};
use moorline_accuracy::tables::{UNCERTAIN, read_runs, summary, write_runs, write_verdicts};
use moorline_accuracy::{
    Code, Duel, Errors, INTEGRATORS, LEVELS, Means, Metric, Peers, Run, Slow, Study, Verdict, frontier, study,
};
use moorline_decks::Supplement;
use moorline_host::Fmu;

use crate::Library;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::summary::Table;
use crate::terminal::{bar, print, read_scene, remark_all};

/// A scene of the repository, built in.
macro_rules! built_in {
    ($name:literal) => {
        ($name, include_str!(concat!("../../scenes/", $name, ".toml")))
    };
}

/// Scenes that are studied if none is given.
const PUBLIC: [(&str, &str); 11] = [
    built_in!("oc3_catenary"),
    built_in!("oc4_chain"),
    built_in!("taut_polyester"),
    built_in!("lindahl_fast"),
    built_in!("lindahl_slow"),
    built_in!("storm_chain_shallow"),
    built_in!("storm_chain_deep"),
    built_in!("clump_weight"),
    built_in!("power_cable"),
    built_in!("volturnus_semi"),
    built_in!("shared_mooring"),
];
/// Error of RMS tension up to which the quasi-static mode is sufficient [-].
const ENOUGH: f64 = 0.02;

/// Folder with the results of a study.
pub(crate) struct Results<'a> {
    /// The folder.
    pub folder: &'a Path,
    /// True if the results of other scenes in it are kept.
    pub add: bool,
}

/// Studies scenes, with their own motion or with a given one, prints the cost of each level of error and writes tables and figures into
/// a folder.
pub(crate) fn accuracy(
    paths: &[PathBuf],
    supplement: &Supplement,
    drive: &Drive,
    Results { folder, add }: Results<'_>,
    (python, library): (Option<&Path>, Library<'_>),
) -> Result<(), Failure> {
    let scenes = scenes(paths, supplement, drive)?;
    let machine = processor();
    let mut studies = match add {
        true => studied(&machine, folder)?,
        false => Vec::new(),
    };
    studies.retain(|study| !scenes.iter().any(|(name, _)| *name == study.name));
    let _open = Folder::open(folder)?;
    let peers = python.map(|python| Peers::find(python, folder)).transpose();
    let peers = peers.map_err(|error| Failure::Argument(error.to_string()))?;
    stay_on_one_core();
    // Results are written even if standard output is closed by its reader.
    let mut printed = print(&format!("on {machine}\n\n"));
    let kept = studies.len();
    for (name, scene) in &scenes {
        let bar = bar(1);
        let means = Means {
            peers: peers.as_ref(),
            package: Some(&|scene| opened(scene, library)),
        };
        let done = study(name, scene, &means, &mut |done, total| {
            bar.set_length(total as u64);
            bar.set_position(done as u64);
        });
        bar.finish_and_clear();
        let done = done.map_err(|error| Failure::Computation(error.to_string()))?;
        let text: String = done.iter().map(report).collect();
        if let Some(offline) = done.first() {
            let figure = frontier::figure(offline);
            write_file(&folder.join(format!("{name}.svg")), |w| {
                w.write_all(figure.as_bytes())
            })?;
        }
        studies.extend(done);
        // Written after every scene: an interrupted run keeps the finished ones.
        write_studies(&machine, &studies, folder)?;
        printed = printed.and_then(|()| print(&text));
    }
    printed = printed.and_then(|()| print(&format!("written to {}\n", folder.display())));
    if python.is_some() && studies[kept..].iter().all(|study| study.peers().is_empty()) {
        let text = "no peer gave a result: the reasons stand at \"no result\" above";
        return Err(Failure::Computation(text.to_string()));
    }
    printed
}

/// Reads the studies in a folder, which must be of this machine; empty if there are none.
fn studied(machine: &str, folder: &Path) -> Result<Vec<Study>, Failure> {
    let path = folder.join("accuracy.csv");
    let fault = |text: String| Failure::Argument(format!("{}: {text}", path.display()));
    if !path.exists() {
        return Ok(Vec::new());
    }
    let file = File::open(&path).map_err(|error| fault(error.to_string()))?;
    let (other, studies) = read_runs(file).map_err(fault)?;
    if other != machine {
        let text =
            format!("costs on {other} do not compare with those on this {machine}: give another folder");
        return Err(fault(text));
    }
    Ok(studies)
}

/// Packages a scene as an FMU and opens it; the error is a message.
fn opened(scene: &Scene, library: Library<'_>) -> Result<Fmu, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let (target, text) = (folder.path().join("scene.fmu"), scene.to_toml());
    let binaries = library.find().map_err(|error| error.to_string())?;
    let plain = (Container::Fmu, &Stamp::default());
    write_package((scene, &text), FmiVersion::Two, plain, &binaries, &target)
        .map_err(|error| error.to_string())?;
    Fmu::open(&target).map_err(|error| error.to_string())
}

fn write_studies(machine: &str, studies: &[Study], folder: &Path) -> Result<(), Failure> {
    let file = |name: &str| folder.join(name);
    write_file(&file("accuracy.csv"), |w| write_runs(machine, studies, w))?;
    write_file(&file("verdicts.csv"), |w| write_verdicts(machine, studies, w))?;
    let mut texts = vec![
        ("summary.md".to_string(), summary(studies)),
        ("overview.svg".to_string(), frontier::overview(studies)),
    ];
    texts.extend(frontier::in_host(studies).map(|figure| ("in_host.svg".to_string(), figure)));
    for (name, text) in texts {
        write_file(&file(&name), |w| w.write_all(text.as_bytes()))?;
    }
    Ok(())
}

fn scenes(
    paths: &[PathBuf],
    supplement: &Supplement,
    drive: &Drive,
) -> Result<Vec<(String, Scene)>, Failure> {
    let mut scenes: Vec<(String, Scene)> = Vec::new();
    let moved = |name: &str, scene: &mut Scene| {
        let words = scene.drive(drive);
        words.map_err(|problem| Failure::Argument(format!("{name}: {problem}")))
    };
    if paths.is_empty() {
        if !supplement.is_empty() {
            let text = "the public scenes leave nothing to a host: give the deck that --depth, --at and --vessel are for";
            return Err(Failure::Argument(text.to_string()));
        }
        for (name, text) in PUBLIC {
            let mut scene = Scene::from_toml(text).expect("the public scenes are tested");
            moved(name, &mut scene)?;
            scenes.push((name.to_string(), scene));
        }
    }
    for path in paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if scenes.iter().any(|(other, _)| *other == name) {
            let text = format!("two scenes are called {name}: results have the names of their files");
            return Err(Failure::Argument(text));
        }
        let mut loaded = read_scene(path, supplement)?;
        let mut scene = loaded.scene.clone();
        moved(&name, &mut scene)?;
        let notes = loaded.change(scene);
        remark_all(&loaded, notes);
        scenes.push((name.into_owned(), loaded.scene));
    }
    Ok(scenes)
}

/// Keeps this thread, and the peers that it starts, on one core if the system permits it.
fn stay_on_one_core() {
    if let Some(core) = core_affinity::get_core_ids().and_then(|cores| cores.last().copied()) {
        core_affinity::set_for_current(core);
    }
}

/// Name of the processor, or its architecture if the system does not give the name.
fn processor() -> String {
    let processors = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = processors.lines().find(|line| line.starts_with("model name"));
    let name = model.and_then(|line| line.split_once(':'));
    name.map_or(std::env::consts::ARCH, |(_, name)| name.trim())
        .to_string()
}

/// Tables of a study: the cheapest runs at each level and the cost of the peers over moorline's; offline, settings of each integrator and the periods
/// for which equilibria are sufficient; in a host, default settings.
fn report(study: &Study) -> String {
    let title = match study.title.as_str() {
        "" => String::new(),
        title => format!(": {title}"),
    };
    let limits = Metric::ALL.into_iter().zip(percents(&study.uncertainty));
    let limits: Vec<String> = limits
        .map(|(metric, limit)| format!("{} {limit}", metric.title()))
        .collect();
    let failed = study.failed.iter();
    let failed: String = failed
        .map(|failed| format!("no result: {}: {}\n", failed.label, failed.reason))
        .collect();
    if let Some(step) = study.host_step {
        let head = format!(
            "{} in a host, steps of {step} s, displacements only: moorline with default settings\n",
            study.name
        );
        let cheapest = format!("cheapest runs\n{}", verdicts(study));
        let defaults = format!("default settings\n{}{failed}\n", defaults(study));
        return [head, cheapest, defaults].join("\n");
    }
    let blocks = [
        format!(
            "{}{title}\nconverged solution: {}; its uncertainty: {}\n",
            study.name,
            study.converged,
            limits.join(", ")
        ),
        format!("cheapest runs\n{}{}", verdicts(study), lost(study)),
        format!(
            "settings that reach an error of {}\n{}",
            Metric::Rms.title(),
            settings(study)
        ),
        format!("{}{failed}\n", slower(&study.slow)),
    ];
    blocks.join("\n")
}

/// Errors in per cent, in the order of [`Metric::ALL`].
fn percents(errors: &Errors) -> [String; 4] {
    Metric::ALL.map(|metric| format!("{:.2} %", 100.0 * errors.of(metric)))
}

/// Cheapest runs of moorline and of the peers at each level of error; levels that moorline is held to are starred.
fn verdicts(study: &Study) -> Table {
    let peers = study.peers();
    let mut head = vec!["", "error", "cost"];
    head.extend(peers.iter().copied());
    if !peers.is_empty() {
        head.extend(["ratio", "least to greatest"]);
    }
    head.push("settings");
    let mut table = Table::new(&head).ending_in_words();
    for verdict in study.verdicts() {
        let star = if verdict.key { " *" } else { "" };
        let mut row = vec![
            format!("{}{star}", verdict.metric.title()),
            format!("{:.1} %", 100.0 * verdict.level),
            cost(verdict.own),
        ];
        row.extend(verdict.peers.iter().map(|(_, run)| cost(*run)));
        if !peers.is_empty() {
            row.push(verdict.ratio().map_or("—".to_string(), times));
            let range = verdict.ratio_range();
            row.push(range.map_or("—".to_string(), |[least, greatest]| {
                format!("{least:.1} … {greatest:.1}")
            }));
        }
        row.push(how(&verdict));
        table.text_row(row);
    }
    table
}

/// Settings of moorline and of the better peer.
fn how(verdict: &Verdict<'_>) -> String {
    if !verdict.certain {
        return UNCERTAIN.to_string();
    }
    let named = |run: &Run| format!("{}, {}", run.code.name(), run.label);
    let own = verdict.own.map_or("not reached".to_string(), named);
    let peer = verdict.best_peer().map(named);
    peer.map_or(own.clone(), |peer| format!("{own} | {peer}"))
}

/// Errors at which a peer is cheaper than moorline, or else the error at which it comes closest; empty without a peer.
fn lost(study: &Study) -> String {
    let described = |duel: &Duel<'_>| {
        format!(
            "{} at {:.2} %, {} ({})",
            times(duel.ratio()),
            100.0 * duel.level,
            duel.peer.code.name(),
            duel.peer.label
        )
    };
    let of_metric = |metric: Metric| {
        let mut duels = study.duels(metric);
        duels.sort_by(|a, b| a.ratio().total_cmp(&b.ratio()));
        let closest = described(duels.first()?);
        let lost = duels.iter().take_while(|duel| duel.ratio() <= 1.0).map(described);
        let lost: Vec<String> = lost.collect();
        let sentence = match lost.is_empty() {
            true => format!("no peer is cheaper anywhere; closest {closest}"),
            false => format!("a peer is cheaper: {}", lost.join("; ")),
        };
        Some(format!("{}: {sentence}\n", metric.title()))
    };
    Metric::ALL.into_iter().filter_map(of_metric).collect()
}

/// Settings that every integrator needs for each level of RMS tension.
fn settings(study: &Study) -> Table {
    let head = ["", "error", "cost", "setting"];
    let mut table = Table::new(&head).ending_in_words();
    for integrator in INTEGRATORS {
        let code = Code::Own(integrator);
        let runs = |other: &Code| *other == code;
        for level in LEVELS {
            if let Some(run) = study.cheapest(Metric::Rms, level, runs) {
                let level = format!("{:.1} %", 100.0 * level);
                let row = [code.name().into(), level, cost(Some(run)), run.label.clone()];
                table.text_row(row.into());
            }
        }
    }
    table
}

/// Default settings for each tolerance and those of the peers' decks, and their errors.
fn defaults(study: &Study) -> Table {
    let titles = Metric::ALL.map(Metric::title);
    let head: Vec<&str> = ["", "setting", "cost"].into_iter().chain(titles).collect();
    let mut table = Table::new(&head);
    let by_default = |run: &&Run| run.tolerance.is_some() || run.deck.is_some();
    for run in study.runs.iter().filter(by_default) {
        let row = [run.code.name().to_string(), run.label.clone(), cost(Some(run))];
        table.text_row(row.into_iter().chain(percents(&run.errors)).collect());
    }
    table
}

/// Table of the quasi-static mode, and the periods from which on it is sufficient.
fn slower(slow: &[Slow]) -> String {
    let Some(last) = slow.last() else {
        return "the quasi-static mode was not compared with dynamics: the scene is quasi-static itself, or no sum of sines in still water\n"
            .to_string();
    };
    let head = ["quasi-static, periods", "shortest"];
    let titles = Metric::ALL.map(Metric::title);
    let head: Vec<&str> = head.into_iter().chain(titles).collect();
    let mut table = Table::new(&head);
    for one in slow {
        let row = [format!("{} times as long", one.factor), period(one)];
        table.text_row(row.into_iter().chain(percents(&one.errors)).collect());
    }
    let enough = slow.iter().find(|one| one.errors.of(Metric::Rms) <= ENOUGH);
    let sentence = match enough {
        Some(one) if one.factor == 1.0 => "the quasi-static mode is enough here".to_string(),
        Some(one) => format!(
            "the quasi-static mode is enough for {} % of RMS tension from periods {} times as long on, {}",
            100.0 * ENOUGH,
            one.factor,
            period(one)
        ),
        None => format!(
            "the quasi-static mode is not enough for {} % of RMS tension, not even with periods of {}",
            100.0 * ENOUGH,
            period(last)
        ),
    };
    format!("{table}{sentence}\n")
}

fn period(slow: &Slow) -> String {
    format!("{} s", rounded(slow.period, 5))
}

fn cost(run: Option<&Run>) -> String {
    run.map_or("—".to_string(), |run| format!("{:.2e}", run.cost))
}

fn times(ratio: f64) -> String {
    format!("{ratio:.1} x")
}
