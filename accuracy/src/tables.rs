//! Speed against error as tables: a row for every run, a row for every verdict, and a few lines for a page.

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::{Metric, Run, Study, TOLERANCES, Verdict};

/// Words for a level of error that the converged solution is too uncertain to judge.
pub const UNCERTAIN: &str = "within the converged solution's uncertainty";

/// Peers with the settings of their decks, and their elements [-].
const DECKS: [(&str, usize); 4] = [
    ("MoorDyn", 20),
    ("MoorDyn", 40),
    ("CableDyn", 20),
    ("CableDyn", 40),
];

/// Writes scene, communication step of the host (empty offline), code, setting, cost with its range, errors and the converged solution's uncertainty of every run of these studies;
/// `machine` names the processor.
///
/// # Errors
/// `out` refuses.
pub fn write_runs(machine: &str, studies: &[Study], out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let keys = Metric::ALL.map(Metric::key);
    let errors = keys.iter().map(|key| (*key).to_string());
    let uncertainties = keys.iter().map(|key| format!("{key}_uncertainty"));
    let head = "machine scene host_step code setting cost cost_least cost_greatest";
    let head = head.split(' ').map(str::to_string);
    table.write_record(head.chain(errors).chain(uncertainties))?;
    for study in studies {
        for run in &study.runs {
            let host = host_step(study);
            let words = [machine, &study.name, &host, run.code.name(), &run.label].map(str::to_string);
            let numbers = Metric::ALL.map(|metric| run.errors.of(metric));
            let limits = Metric::ALL.map(|metric| study.uncertainty.of(metric));
            let numbers = costs(run).into_iter().chain(numbers).chain(limits);
            table.write_record(words.into_iter().chain(numbers.map(number)))?;
        }
    }
    table.flush()
}

/// Writes, for every level of error, the cheapest run of moorline and of every peer, and the peer's cost over moorline's, empty where moorline has no run.
///
/// # Errors
/// `out` refuses.
pub fn write_verdicts(machine: &str, studies: &[Study], out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let head =
        "machine scene host_step metric level key certain code setting cost cost_least cost_greatest ratio";
    table.write_record(head.split(' '))?;
    for study in studies {
        for verdict in study.verdicts() {
            let own = verdict.own.map(|own| ("moorline", Some(own)));
            for (_, run) in own.into_iter().chain(verdict.peers.iter().copied()) {
                let Some(run) = run else { continue };
                let ratio = verdict
                    .own
                    .map_or(String::new(), |own| number(run.cost / own.cost));
                let words = [
                    machine.to_string(),
                    study.name.clone(),
                    host_step(study),
                    verdict.metric.key().to_string(),
                    verdict.level.to_string(),
                    verdict.key.to_string(),
                    verdict.certain.to_string(),
                    run.code.name().to_string(),
                    run.label.clone(),
                ];
                let costs = costs(run).map(number);
                table.write_record(words.into_iter().chain(costs).chain([ratio]))?;
            }
        }
    }
    table.flush()
}

fn costs(run: &Run) -> [f64; 3] {
    let [least, greatest] = run.spread();
    [run.cost, least, greatest]
}

fn number(number: f64) -> String {
    format!("{number:.4e}")
}

/// Communication step of the host [s]; empty offline.
fn host_step(study: &Study) -> String {
    study.host_step.map_or(String::new(), |step| step.to_string())
}

/// Tables in Markdown: the levels that moorline is held to, offline and in hosts, and what default settings cost in hosts.
pub fn summary(studies: &[Study]) -> String {
    let offline = |study: &&Study| study.host_step.is_none();
    let mut text = levels("offline, error", studies.iter().filter(offline));
    let hosted: Vec<&Study> = studies.iter().filter(|study| !offline(study)).collect();
    if hosted.is_empty() {
        return text;
    }
    text.push('\n');
    text.push_str(&levels("in a host, error", hosted.iter().copied()));
    let tolerances = TOLERANCES.map(|tolerance| format!("moorline, {}", percent(tolerance)));
    let decks = DECKS.map(|(peer, elements)| format!("{peer}, n = {elements}"));
    let head: Vec<String> = tolerances.into_iter().chain(decks).collect();
    let _ = writeln!(
        text,
        "\n| default settings in a host: cost, RMS error | {} |",
        head.join(" | ")
    );
    let _ = writeln!(text, "|---|{}", "---|".repeat(head.len()));
    hosted
        .into_iter()
        .for_each(|study| text.push_str(&defaults(study)));
    text
}

/// The levels that moorline is held to; `head` is the title of the first column.
fn levels<'a>(head: &str, studies: impl Iterator<Item = &'a Study>) -> String {
    let mut text = format!(
        "| {head} | moorline | MoorDyn | CableDyn | ratio to the better | moorline's setting |\n|---|---|---|---|---|---|\n"
    );
    for study in studies {
        for verdict in study.verdicts().iter().filter(|verdict| verdict.key) {
            text.push_str(&row(study, verdict));
        }
    }
    text
}

/// Cost and RMS error of moorline by default for each tolerance, and of the peers as decks set them.
fn defaults(study: &Study) -> String {
    let found = |is: &dyn Fn(&Run) -> bool| study.runs.iter().find(|run| is(run));
    let own = TOLERANCES.map(|tolerance| found(&|run| run.tolerance == Some(tolerance)));
    let decks =
        DECKS.map(|(peer, elements)| found(&|run| run.code.name() == peer && run.deck == Some(elements)));
    let limit = study.uncertainty.of(Metric::Rms);
    let error = |run: &Run| match run.errors.of(Metric::Rms) {
        error if error < limit => format!("{:.1e}, within {}", run.cost, percent(limit)),
        error => format!("{:.1e}, {}", run.cost, percent(error)),
    };
    let cell = |run: Option<&Run>| run.map_or("—".to_string(), error);
    let cells: Vec<String> = own.into_iter().chain(decks).map(cell).collect();
    format!("| {} | {} |\n", study.place(), cells.join(" | "))
}

fn row(study: &Study, verdict: &Verdict<'_>) -> String {
    let metric = match verdict.metric {
        Metric::Rms => "RMS tension",
        Metric::LowPassed => "low-passed tension",
        Metric::Position => "mid position",
        Metric::Peak => "greatest tension",
    };
    let place = format!("{}, {metric} {}", study.place(), percent(verdict.level));
    if !verdict.certain {
        return format!("| {place} | — | — | — | — | {UNCERTAIN} |\n");
    }
    let peer = |name: &str| {
        let found = verdict.peers.iter().find(|(peer, _)| *peer == name);
        cost(found.and_then(|(_, run)| *run))
    };
    let ratio = verdict.ratio().map_or("—".to_string(), |ratio| {
        let range = verdict.ratio_range().unwrap_or([ratio; 2]);
        format!("**{ratio:.0}** ({:.0}–{:.0})", range[0], range[1])
    });
    let setting = verdict.own.map_or("—".to_string(), |run| {
        format!("{}, {}", run.code.name().replace("moorline, ", ""), run.label)
    });
    format!(
        "| {place} | {} | {} | {} | {ratio} | {setting} |\n",
        cost(verdict.own),
        peer("MoorDyn"),
        peer("CableDyn"),
    )
}

fn cost(run: Option<&Run>) -> String {
    run.map_or("—".to_string(), |run| format!("{:.1e}", run.cost))
}

fn percent(error: f64) -> String {
    let text = format!("{:.2}", 100.0 * error);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}
