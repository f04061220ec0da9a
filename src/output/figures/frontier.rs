//! Speed against error of a scene: cost over error, a chart for each way to measure the error.

use crate::accuracy::{Code, Metric, Study};
use crate::scene::Integrator;

use super::axis::Axis;
use super::chart::{Chart, Curve, Stroke, stacked_svg};
use super::{DARK, HISTORY_HEIGHT, WIDTH, colour};

/// Errors beyond this part of the signal are left out: such a run shows nothing [-].
const ERROR_MAX: f64 = 1.0;
/// Errors below this are drawn there [-].
const ERROR_MIN: f64 = 1e-6;
/// moorline's integrators that have runs of their own, in the order of their colours.
const INTEGRATORS: [Integrator; 4] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
    Integrator::QuasiStatic,
];

/// The figure of a study.
pub fn figure(study: &Study) -> String {
    let charts: Vec<Chart> = Metric::ALL
        .iter()
        .map(|metric| chart(study, *metric))
        .collect();
    stacked_svg(&charts)
}

fn chart(study: &Study, metric: Metric) -> Chart {
    let mut curves = Vec::new();
    for (index, integrator) in INTEGRATORS.into_iter().enumerate() {
        let code = Code::Own(integrator);
        let points = runs(study, metric, &code);
        curves.push(Curve::new(points, colour(index), Stroke::Nodes).named(code.name()));
    }
    let own = frontier(study, metric, Code::is_own);
    curves.push(Curve::new(own, DARK, Stroke::Fine).named("moorline, cheapest"));
    let chosen = runs(study, metric, &Code::Chosen);
    let name = "moorline, its own choice for 5, 2, 1, 0.5 %";
    curves.push(Curve::new(chosen, DARK, Stroke::Nodes).named(name));
    for (index, peer) in study.peers().into_iter().enumerate() {
        let of_peer = |code: &Code| *code == Code::Peer(peer.to_string());
        let colour = colour(INTEGRATORS.len() + index);
        let all = runs(study, metric, &Code::Peer(peer.to_string()));
        curves.push(Curve::new(all, colour, Stroke::Nodes));
        let best = frontier(study, metric, of_peer);
        curves.push(Curve::new(best, colour, Stroke::Bold).named(peer));
    }
    curves.retain(|curve| !curve.points.is_empty());
    let y = Axis::decades(&curves, 1, "processor time / simulated time".to_string());
    let limit = percent(study.uncertainty.of(metric));
    let edge = vec![[limit, y.min], [limit, y.max]];
    let name = "uncertainty of the converged solution";
    curves.push(Curve::new(edge, DARK, Stroke::Dashed).named(name));
    let x = Axis::decades(&curves, 0, format!("error of {} [%]", metric.title()));
    let law = if study.negative_tension {
        ", damping in compression"
    } else {
        ""
    };
    let title = format!("{}: {}{law}", study.name, metric.title());
    Chart::new(title, x, y, curves, WIDTH, HISTORY_HEIGHT)
}

fn runs(study: &Study, metric: Metric, code: &Code) -> Vec<[f64; 2]> {
    let runs = study.runs.iter().filter(|run| run.code == *code);
    let points = runs.map(|run| (run.errors.of(metric), run.cost));
    shown(points)
}

fn frontier(study: &Study, metric: Metric, codes: impl Fn(&Code) -> bool) -> Vec<[f64; 2]> {
    let runs = study.frontier(metric, codes);
    shown(runs.iter().map(|run| (run.errors.of(metric), run.cost)))
}

/// Logarithms of error [%] and cost [-].
fn shown(points: impl Iterator<Item = (f64, f64)>) -> Vec<[f64; 2]> {
    points
        .filter(|(error, _)| *error <= ERROR_MAX)
        .map(|(error, cost)| [percent(error), cost.log10()])
        .collect()
}

/// Logarithm of an error [-] in percent.
fn percent(error: f64) -> f64 {
    (100.0 * error.max(ERROR_MIN)).log10()
}
