//! A folded chain that falls, and the whip at its end.

use moorline::scene::Integrator;
use moorline::simulation::Simulation;
use nalgebra::Vector3;

use super::run::Run;
use super::scenes::*;
use super::{at_most, sound};

/// The integrators that let go of an end.
const FREE: [Integrator; 3] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
];

/// The folded chain until its free end has fallen by these parts of its length [-], and how far it has fallen by then [-].
fn falling(elements: usize, integrator: Integrator, parts: &[f64]) -> (Run, Vec<f64>) {
    let scene = by(folded_chain(elements), integrator, 0.01 / elements as f64);
    let mut fallen = Vec::new();
    let mut run = None;
    for part in parts {
        let done = Run::of(&scene, fall_time(*part), fall_time(*part) / 200.0);
        fallen.push(-done.end.state().lines[0].position[0].z / CHAIN);
        run = Some(done);
    }
    (run.expect("a part"), fallen)
}

#[test]
fn the_free_end_of_a_folded_chain_outruns_free_fall_as_its_energy_says() {
    let parts = [0.3, 0.5, 0.7, 0.8, 0.9];
    for integrator in FREE {
        let mut errors = Vec::new();
        let sizes = [20, 40, 80, 160];
        for elements in sizes {
            let (run, fallen) = falling(elements, integrator, &parts);
            let pairs = fallen.iter().zip(&parts);
            let error = pairs.map(|(x, part)| (x - part).abs()).fold(0.0, f64::max);
            let free = 0.5 * G * fall_time(0.9).powi(2) / CHAIN;
            println!("{integrator:?}, {elements}: {fallen:?}, free fall {free:.3}, error {error:.4}, ledger {:.2e}, pull {:.3} {:.3}", run.ledger_error(), run.tension[run.tension.len()-1] / (CHAIN * G), fall_pull(0.9));
            errors.push(error);
        }
        println!("{integrator:?} {errors:?}");
    }
}

#[test]
fn a_whip_crack_gains_no_energy() {
    for integrator in FREE {
        for elements in [40, 80] {
            let scene = by(folded_chain(elements), integrator, 0.01 / elements as f64);
            let run = Run::of(&scene, 5.0, 0.005);
            let what = format!("whip of {elements}, {integrator:?}");
            sound(&what, &run, 1.0, 50_000.0);
            at_most(0.02, &format!("{what}, gain"), run.energy_gain());
        }
    }
}

/// Momentum [kg m/s], and angular momentum about the centre of mass [kg m²/s], of the first line, dry.
fn momenta(simulation: &Simulation) -> [Vector3<f64>; 2] {
    let shape = &simulation.state().lines[0];
    let mass = &simulation.model().lines[0].nodes.mass;
    let nodes = || mass.iter().zip(&shape.position).zip(&shape.velocity);
    let total: f64 = mass.iter().sum();
    let centre = nodes().map(|((m, r), _)| *m * r).sum::<Vector3<f64>>() / total;
    let linear = nodes().map(|((m, _), v)| *m * v).sum();
    let angular = nodes().map(|((m, r), v)| *m * (r - centre).cross(v)).sum();
    [linear, angular]
}

#[test]
fn a_line_let_go_in_full_swing_whips_and_keeps_its_momenta() {
    for (integrator, bound) in [
        (Integrator::Leapfrog, 1e-9),
        (Integrator::AxialImplicit, 1e-9),
        (Integrator::GeneralisedAlpha, 1e-3),
    ] {
        let scene = by(let_go_in_swing(), integrator, 0.002);
        let run = |duration: f64| {
            let steps = (duration / 0.05).round() as usize;
            Run::hosted(&scene, std::iter::repeat_n(0.05, steps), let_go)
        };
        let (start, flight) = (run(LET_GO + 0.1), run(LET_GO + 4.1));
        let what = format!("let go in full swing, {integrator:?}");
        sound(&what, &flight, 0.05, 800.0);
        println!("momenta {:?} {:?}", momenta(&start.end), momenta(&flight.end));
        let mass: f64 = flight.end.model().lines[0].nodes.mass.iter().sum();
        let [before, after] = [&start, &flight].map(|run| momenta(&run.end));
        let fallen = Vector3::new(0.0, 0.0, -4.0 * mass * G);
        let change = (after[0] - before[0] - fallen).norm() / fallen.norm();
        at_most(bound, &format!("{what}, momentum"), change);
        let turned = (after[1] - before[1]).norm() / before[1].norm();
        at_most(bound, &format!("{what}, angular momentum"), turned);
        at_most(1e-3, &format!("{what}, gain"), flight.energy_gain());
    }
}
