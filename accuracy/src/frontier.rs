//! Figures of speed against error: cost over error, with a chart for each metric.

use moorline::output::figures::axis::Axis;
use moorline::output::figures::chart::{Chart, Curve, Stroke, grid_svg};
use moorline::output::figures::{DARK, WIDTH, colour};

use crate::{Code, INTEGRATORS, Metric, Study};

/// Peers in the order of their colours, which are the same in every chart.
const PEERS: [&str; 2] = ["MoorDyn", "CableDyn"];
/// Greatest error that is drawn, relative to the signal [-]: runs with greater errors are meaningless.
const ERROR_MAX: f64 = 0.5;
/// Least error that is drawn, relative to the converged solution's uncertainty [-].
const WITHIN: f64 = 0.4;
/// Least error that is drawn, for any uncertainty [-].
const ERROR_MIN: f64 = 2e-4;
/// Error levels at which moorline is compared with the better peer [-].
const LEVELS: [f64; 2] = [0.03, 0.01];
/// Size of a chart, without title [px].
const SIZE: [u32; 2] = [WIDTH / 2, 300];

/// Figure of a study, with a chart for each metric.
pub fn figure(study: &Study) -> String {
    let charts = Metric::ALL.map(|metric| chart(study, metric, true));
    grid(charts.into())
}

/// Figure of tension and position errors of several offline studies.
pub fn overview(studies: &[Study]) -> String {
    let offline = studies.iter().filter(|study| study.host_step.is_none());
    let charts = offline.flat_map(|study| {
        [study.tension_metric(), Metric::Position].map(|metric| chart(study, metric, false))
    });
    grid(charts.collect())
}

/// Figure of tension errors of several studies in hosts; `None` if there are none.
pub fn in_host(studies: &[Study]) -> Option<String> {
    let hosted = studies.iter().filter(|study| study.host_step.is_some());
    let charts: Vec<_> = hosted
        .map(|study| chart(study, study.tension_metric(), false))
        .collect();
    (!charts.is_empty()).then(|| grid(charts))
}

/// Charts in two columns below a common legend, which names every kind of curve once.
fn grid(charts: Vec<(Chart, Vec<Curve>)>) -> String {
    let mut legend: Vec<Curve> = Vec::new();
    let mut drawn = Vec::new();
    for (chart, named) in charts {
        for curve in named {
            if !legend.iter().any(|other| other.name == curve.name) {
                legend.push(curve);
            }
        }
        drawn.push(chart);
    }
    grid_svg(&legend, &drawn, 2)
}

/// Chart of a metric, and its curves for a legend; `runs_too` includes single runs.
fn chart(study: &Study, metric: Metric, runs_too: bool) -> (Chart, Vec<Curve>) {
    let mut curves = curves(study, metric, runs_too);
    curves.retain(|curve| !curve.points.is_empty());
    let y = Axis::decades(&curves, 1, "processor time / simulated time".to_string());
    let limit = percent(study, metric, study.uncertainty.of(metric));
    let edge = vec![[limit, y.min], [limit, y.max]];
    let short = match metric {
        Metric::Position => "mid position, RMS",
        other => other.title(),
    };
    let mut x = Axis::decades(&curves, 0, format!("error of {short} [%]"));
    x.max = (100.0 * ERROR_MAX).log10();
    let band = vec![[x.min.min(limit), y.min], [limit, y.max]];
    x.min = x.min.min(limit);
    curves.push(Curve::new(band, DARK, Stroke::Band));
    let name = "uncertainty of the converged solution";
    curves.push(Curve::new(edge, DARK, Stroke::Dashed).named(name));
    let named = curves.iter().filter(|curve| !curve.name.is_empty());
    let named = named.cloned().collect();
    for curve in &mut curves {
        curve.name.clear();
    }
    (Chart::new(study.place(), x, y, curves, SIZE[0], SIZE[1]), named)
}

fn curves(study: &Study, metric: Metric, runs_too: bool) -> Vec<Curve> {
    let mut curves = Vec::new();
    if runs_too {
        for (index, integrator) in INTEGRATORS.into_iter().enumerate() {
            let code = Code::Own(integrator);
            let points = shown_runs(study, metric, &code);
            curves.push(Curve::new(points, colour(index), Stroke::Nodes).named(code.name()));
        }
    }
    for peer in study.peers() {
        let code = Code::Peer(peer.to_string());
        let number = PEERS.iter().position(|name| *name == peer).unwrap_or(PEERS.len());
        let colour = colour(INTEGRATORS.len() + number);
        if runs_too {
            let all = shown_runs(study, metric, &code);
            curves.push(Curve::new(all, colour, Stroke::Nodes));
        }
        let best = frontier(study, metric, |other| *other == code);
        curves.push(Curve::new(best, colour, Stroke::Bold).named(peer));
    }
    let own = frontier(study, metric, Code::is_own);
    curves.push(Curve::new(own, DARK, Stroke::Bold).named("moorline, cheapest"));
    curves.push(by_default(study, metric));
    for level in LEVELS {
        curves.extend(duel(study, metric, level));
    }
    curves
}

/// Runs with default settings, labelled with the tolerance.
fn by_default(study: &Study, metric: Metric) -> Curve {
    let runs = study.runs.iter().filter_map(|run| Some((run, run.tolerance?)));
    let runs = runs.filter(|(run, _)| run.errors.of(metric) <= ERROR_MAX);
    let (mut points, mut labels) = (Vec::new(), Vec::new());
    for (run, tolerance) in runs {
        points.push(place(study, metric, run.errors.of(metric), run.cost));
        labels.push(format!("{} %", 100.0 * tolerance));
    }
    Curve::new(points, [213, 30, 30], Stroke::Marks)
        .named("moorline, default settings for a tolerance")
        .labelled(labels)
}

/// Line from moorline's cheapest run to the better peer's at a level, labelled with the ratio of their costs.
fn duel(study: &Study, metric: Metric, level: f64) -> Option<Curve> {
    let verdict = study.verdict(metric, level);
    let (own, peer) = verdict.own.zip(verdict.best_peer())?;
    let ratio = verdict.ratio().filter(|_| verdict.certain)?;
    let at = |cost: f64| place(study, metric, level, cost);
    let middle = (own.cost * peer.cost).sqrt();
    let points = vec![at(own.cost), at(middle), at(peer.cost)];
    let star = if verdict.key { " *" } else { "" };
    let labels = vec![String::new(), format!("{}×{star}", times(ratio)), String::new()];
    Some(Curve::new(points, DARK, Stroke::Fine).labelled(labels))
}

/// Text of a ratio [-] with about two digits.
fn times(ratio: f64) -> String {
    match ratio {
        r if r < 1.0 => format!("{r:.2}"),
        r if r < 10.0 => format!("{r:.1}"),
        r => format!("{r:.0}"),
    }
}

fn shown_runs(study: &Study, metric: Metric, code: &Code) -> Vec<[f64; 2]> {
    let runs = study.runs.iter().filter(|run| run.code == *code);
    let runs = runs.filter(|run| run.errors.of(metric) <= ERROR_MAX);
    runs.map(|run| place(study, metric, run.errors.of(metric), run.cost))
        .collect()
}

/// Staircase of a frontier: the least cost at every error.
fn frontier(study: &Study, metric: Metric, codes: impl Fn(&Code) -> bool) -> Vec<[f64; 2]> {
    let runs = study.frontier(metric, codes);
    let runs = runs.into_iter().filter(|run| run.errors.of(metric) <= ERROR_MAX);
    let mut steps: Vec<[f64; 2]> = Vec::new();
    for run in runs {
        let next = place(study, metric, run.errors.of(metric), run.cost);
        if let Some([error, _]) = steps.last().copied() {
            steps.push([error, next[1]]);
        }
        steps.push(next);
    }
    steps
}

/// Logarithms of error [%] and cost [-].
fn place(study: &Study, metric: Metric, error: f64, cost: f64) -> [f64; 2] {
    [percent(study, metric, error), cost.log10()]
}

/// Logarithm of an error [-] in percent.
fn percent(study: &Study, metric: Metric, error: f64) -> f64 {
    let least = (WITHIN * study.uncertainty.of(metric)).max(ERROR_MIN);
    (100.0 * error.max(least)).log10()
}
