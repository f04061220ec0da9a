//! Speed against error as tables: a row for every run, a row for every verdict, and a few lines for a page.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::{self, Read, Write};
use std::str::FromStr;

use crate::{Code, Errors, How, Metric, Run, Study, TOLERANCES, Verdict};

/// Text for an error level below the uncertainty of the converged solution.
pub const UNCERTAIN: &str = "within the converged solution's uncertainty";

/// Peers with the settings of their decks, and their elements [-].
const DECKS: [(&str, usize); 4] = [
    ("MoorDyn", 20),
    ("MoorDyn", 40),
    ("CableDyn", 20),
    ("CableDyn", 40),
];

/// Columns of the table of runs before the errors.
const HEAD: [&str; 11] = [
    "machine",
    "scene",
    "on_seabed",
    "host_step",
    "code",
    "setting",
    "tolerance",
    "deck",
    "cost",
    "cost_least",
    "cost_greatest",
];
/// Suffix of the names of columns with the uncertainty of the converged solution.
const UNCERTAINTY: &str = "_uncertainty";

/// Writes every run of these studies in a row; `machine` names the processor. The columns are scene, whether it has a seabed, communication step of the host
/// (empty offline), code, setting, tolerance of default settings, elements of a peer's deck, cost with its range, errors, and the uncertainty of the converged
/// solution.
///
/// # Errors
/// Writing to `out` fails.
pub fn write_runs(machine: &str, studies: &[Study], out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let keys = Metric::ALL.map(Metric::key);
    let uncertainties = keys.map(|key| format!("{key}{UNCERTAINTY}"));
    let head = HEAD.into_iter().chain(keys).map(str::to_string);
    table.write_record(head.chain(uncertainties))?;
    for study in studies {
        for run in &study.runs {
            let words = [
                machine.to_string(),
                study.name.clone(),
                study.on_seabed.to_string(),
                host_step(study),
                run.code.name().to_string(),
                run.label.clone(),
                run.tolerance
                    .map_or(String::new(), |tolerance| tolerance.to_string()),
                run.deck.map_or(String::new(), |elements| elements.to_string()),
            ];
            let numbers = Metric::ALL.map(|metric| run.errors.of(metric));
            let limits = Metric::ALL.map(|metric| study.uncertainty.of(metric));
            let numbers = costs(run).into_iter().chain(numbers).chain(limits);
            table.write_record(words.into_iter().chain(numbers.map(number)))?;
        }
    }
    table.flush()
}

/// Reads a table of [`write_runs`]: the processor of its first row and the studies, whose runs cannot be repeated. Data that the table does not
/// contain are empty.
///
/// # Errors
/// A row differs from the format of [`write_runs`]; the message gives its number and the column.
pub fn read_runs(input: impl Read) -> Result<(String, Vec<Study>), String> {
    let (mut machine, mut studies) = (String::new(), Vec::<Study>::new());
    let mut table = csv::Reader::from_reader(input);
    for (index, row) in table.deserialize::<HashMap<String, String>>().enumerate() {
        let in_row = |reason: String| format!("row {}: {reason}", index + 2);
        let row = row.map_err(|error| in_row(error.to_string()))?;
        let row = Row(&row);
        let (study, run) = row.read().map_err(in_row)?;
        if machine.is_empty() {
            machine = row.word("machine").map_err(in_row)?.to_string();
        }
        let same = |other: &&mut Study| other.name == study.name && other.host_step == study.host_step;
        match studies.iter_mut().find(same) {
            Some(study) => study.runs.push(run),
            None => studies.push(Study {
                runs: vec![run],
                ..study
            }),
        }
    }
    Ok((machine, studies))
}

/// Row of the table of runs, by the names of its columns.
struct Row<'a>(&'a HashMap<String, String>);

impl Row<'_> {
    /// Returns the study of the row, without runs, and the run.
    fn read(&self) -> Result<(Study, Run), String> {
        let errors = |end: &str| -> Result<Errors, String> {
            let [rms, low_passed, peak, position] =
                Metric::ALL.map(|metric| self.number(&format!("{}{end}", metric.key())));
            Ok(Errors::new([rms?, low_passed?, peak?, position?]))
        };
        let study = Study {
            name: self.word("scene")?.to_string(),
            title: String::new(),
            host_step: self.optional("host_step")?,
            negative_tension: false,
            on_seabed: self.number("on_seabed")?,
            converged: String::new(),
            uncertainty: errors(UNCERTAINTY)?,
            runs: Vec::new(),
            failed: Vec::new(),
            slow: Vec::new(),
        };
        let run = Run {
            code: Code::named(self.word("code")?),
            label: self.word("setting")?.to_string(),
            cost: self.number("cost")?,
            errors: errors("")?,
            tolerance: self.optional("tolerance")?,
            deck: self.optional("deck")?,
            costs: vec![self.number("cost_least")?, self.number("cost_greatest")?],
            how: How::Read,
        };
        Ok((study, run))
    }

    fn word(&self, column: &str) -> Result<&str, String> {
        let cell = self.0.get(column).ok_or_else(|| format!("no column {column}"))?;
        Ok(cell)
    }

    fn number<T: FromStr>(&self, column: &str) -> Result<T, String> {
        let cell = self.word(column)?;
        cell.parse().map_err(|_| format!("{column} is {cell:?}"))
    }

    /// Number in a cell; `None` if the cell is empty.
    fn optional<T: FromStr>(&self, column: &str) -> Result<Option<T>, String> {
        match self.word(column)? {
            "" => Ok(None),
            _ => self.number(column).map(Some),
        }
    }
}

/// Writes, for every level of error, the cheapest run of moorline and of every peer, and the peer's cost over moorline's, which is empty if moorline
/// has no run.
///
/// # Errors
/// Writing to `out` fails.
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

/// Tables in Markdown: the levels that moorline is held to, offline and in hosts, and the cost of default settings in hosts.
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
        "\n| default settings in a host: cost, error of tension | {} |",
        head.join(" | ")
    );
    let _ = writeln!(text, "|---|{}", "---|".repeat(head.len()));
    hosted
        .into_iter()
        .for_each(|study| text.push_str(&defaults(study)));
    text
}

/// Table of the levels that moorline is held to; `head` is the title of the first column.
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

/// Cost and error of tension of moorline's default settings for each tolerance, and of the peers with the settings of their decks.
fn defaults(study: &Study) -> String {
    let found = |is: &dyn Fn(&Run) -> bool| study.runs.iter().find(|run| is(run));
    let own = TOLERANCES.map(|tolerance| found(&|run| run.tolerance == Some(tolerance)));
    let decks =
        DECKS.map(|(peer, elements)| found(&|run| run.code.name() == peer && run.deck == Some(elements)));
    let metric = study.tension_metric();
    let limit = study.uncertainty.of(metric);
    let error = |run: &Run| match run.errors.of(metric) {
        error if error < limit => format!("{:.1e}, within {}", run.cost, percent(limit)),
        error => format!("{:.1e}, {}", run.cost, percent(error)),
    };
    let cell = |run: Option<&Run>| run.map_or("—".to_string(), error);
    let cells: Vec<String> = own.into_iter().chain(decks).map(cell).collect();
    format!(
        "| {}, {} | {} |\n",
        study.place(),
        quantity(metric),
        cells.join(" | ")
    )
}

/// Name of the quantity of a metric.
fn quantity(metric: Metric) -> &'static str {
    match metric {
        Metric::Rms => "RMS tension",
        Metric::LowPassed => "low-passed tension",
        Metric::Position => "mid position",
        Metric::Peak => "greatest tension",
    }
}

fn row(study: &Study, verdict: &Verdict<'_>) -> String {
    let metric = quantity(verdict.metric);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{own, peer, study_of};

    /// The table of two studies of a scene, offline and in a host.
    fn table() -> String {
        let mut offline = study_of(vec![own(1.0, 0.02), own(0.5, 0.04), peer("MoorDyn", 30.0, 0.02)]);
        offline.runs[0].costs.extend([2.0, 1.5]);
        let mut by_default = Run {
            code: Code::ByDefault,
            tolerance: Some(0.02),
            ..own(3.0, 0.01)
        };
        by_default.label = "n = 20, \"as chosen\"".to_string();
        let mut deck = peer("CableDyn", 40.0, 0.1);
        deck.deck = Some(20);
        let mut hosted = study_of(vec![by_default, deck]);
        hosted.host_step = Some(0.05);
        hosted.on_seabed = false;
        written("a processor", &[offline, hosted])
    }

    fn written(machine: &str, studies: &[Study]) -> String {
        let mut table = Vec::new();
        write_runs(machine, studies, &mut table).unwrap();
        String::from_utf8(table).unwrap()
    }

    #[test]
    fn a_table_that_was_read_is_written_to_the_last_digit_and_judged_alike() {
        let (machine, studies) = read_runs(table().as_bytes()).unwrap();
        assert_eq!((machine.as_str(), studies.len()), ("a processor", 2));
        assert_eq!(written(&machine, &studies), table());
        assert_eq!(
            studies[0].cheapest(Metric::Rms, 0.05, Code::is_own).unwrap().cost,
            0.5
        );
        assert!(summary(&studies).contains("scene, 0.05 s"));
        let deck = studies[1].runs.iter().find(|run| run.deck == Some(20));
        assert_eq!(deck.unwrap().code.name(), "CableDyn");
    }

    #[test]
    fn a_table_that_is_none_is_refused_with_its_row_and_column() {
        for (from, to, fault) in [
            ("3.0000e1", "cheap", "row 4: cost is \"cheap\""),
            ("tension_peak,", "peak,", "row 2: no column tension_peak"),
            (",2.0000e-2", "", "row 2: "),
        ] {
            let reason = read_runs(table().replace(from, to).as_bytes()).unwrap_err();
            assert!(reason.contains(fault), "{reason}");
        }
    }
}
