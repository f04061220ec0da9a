//! A folded chain that falls, the whip at its end, and a line released during its motion.

use moorline::scene::Integrator;
use moorline::simulation::Simulation;
use nalgebra::Vector3;

use super::Case;
use super::run::Run;
use super::scenes::*;

/// Integrators that support released ends.
const FREE: [Integrator; 3] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
];
/// Fractions of the drop at which the fall is evaluated [-].
const PARTS: [f64; 5] = [0.3, 0.5, 0.7, 0.8, 0.9];

/// The folded chain at the times when its free end should have fallen by [`PARTS`], and the actual fractions [-].
fn falling(elements: usize, striping: usize, integrator: Integrator) -> (Run, Vec<f64>) {
    let scene = by(
        folded_chain(elements, striping),
        integrator,
        0.01 / elements as f64,
    );
    Run::watched(&scene, &PARTS.map(fall_time), |now| {
        -now.state().lines[0].position[0].z / CHAIN
    })
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_free_end_of_a_folded_chain_outruns_free_fall_as_its_energy_says() {
    for integrator in FREE {
        let mut last = [f64::INFINITY; 2];
        for (elements, bound) in [(20, 0.05), (40, 0.032), (80, 0.021), (160, 0.013)] {
            let (run, fallen) = falling(elements, 2, integrator);
            let case = Case(format!("fall of {elements}, {integrator:?}"));
            case.sound(&run, 8e-3, 34_000.0);
            let errors: Vec<f64> = fallen
                .iter()
                .zip(PARTS)
                .map(|(x, part)| (x - part).abs())
                .collect();
            let now = [errors[1], errors[4]];
            case.at_most(bound, "up to 0.9 of the drop", now[1]);
            for (part, (now, last)) in [0.5, 0.9].iter().zip(now.iter().zip(last)) {
                // not of full order: the fold is as wide as two elements, and narrows with them
                case.at_most(0.75 * last, &format!("at {part} of the drop"), *now);
            }
            last = now;
            let free = 0.5 * G * fall_time(0.9).powi(2) / CHAIN;
            assert!(fallen[4] > 1.2 * free, "{}: {} and {free}", case.0, fallen[4]);
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_fall_over_a_fold_of_half_a_metre_converges() {
    let run = |elements: usize| falling(elements, elements / 20, Integrator::GeneralisedAlpha).1;
    let fine = run(320);
    let mut last = f64::INFINITY;
    for elements in [40, 80, 160] {
        let pairs = run(elements).into_iter().zip(&fine);
        let error = pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        Case(format!("wide striping of {elements}")).at_most(last / 3.0, "fall", error);
        last = error;
    }
    assert!(last <= 4e-3, "wide striping of 160: {last}");
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_whip_crack_gains_2_permille_of_energy_at_most_and_8_percent_by_the_axial_implicit_leapfrog() {
    for (integrator, gain, balance) in [
        (Integrator::Leapfrog, 2e-3, 0.25),
        (Integrator::AxialImplicit, 0.08, 0.01),
        (Integrator::GeneralisedAlpha, 1e-3, 1e-6),
    ] {
        for elements in [40, 80] {
            let scene = by(folded_chain(elements, 2), integrator, 0.01 / elements as f64);
            let run = Run::of(&scene, 5.0, 0.005);
            let case = Case(format!("whip of {elements}, {integrator:?}"));
            case.sound(&run, balance, 17_500.0);
            case.at_most(gain, "gain", run.energy_gain());
        }
    }
}

/// Momentum [kg m/s], and angular momentum about the centre of mass [kg m²/s], of the first line in air. For the leapfrogs, velocities are those
/// at the half step before; velocities extrapolated to the time of the positions would differ by ½ Δt² Σ v × F in angular momentum.
fn momenta(simulation: &Simulation) -> [Vector3<f64>; 2] {
    let shape = &simulation.state().lines[0];
    let mass = &simulation.model().lines[0].nodes.mass;
    let velocity = match &shape.half_step.velocity {
        stepped if stepped.is_empty() => &shape.velocity,
        stepped => stepped,
    };
    let nodes = || mass.iter().zip(&shape.position).zip(velocity);
    let total: f64 = mass.iter().sum();
    let centre = nodes().map(|((m, r), _)| *m * r).sum::<Vector3<f64>>() / total;
    let linear = nodes().map(|((m, _), v)| *m * v).sum();
    let angular = nodes().map(|((m, r), v)| *m * (r - centre).cross(v)).sum();
    [linear, angular]
}

/// Last internal step of a simulation [s]; 0 if velocities refer to the current time.
fn last_step(simulation: &Simulation) -> f64 {
    let half_step = &simulation.state().lines[0].half_step;
    match half_step.velocity.is_empty() {
        true => 0.0,
        false => half_step.steps[0],
    }
}

#[test]
fn a_line_released_in_full_swing_whips_and_keeps_its_momenta() {
    for (integrator, bound) in [
        (Integrator::Leapfrog, 1e-12),
        (Integrator::AxialImplicit, 1e-12),
        (Integrator::GeneralisedAlpha, 1e-4),
    ] {
        let scene = by(released_in_swing(), integrator, 0.002);
        let run = |duration: f64| {
            let steps = (duration / 0.05).round() as usize;
            Run::hosted(&scene, std::iter::repeat_n(0.05, steps), release)
        };
        let (start, flight) = (run(RELEASE + 0.1), run(RELEASE + 4.1));
        let case = Case(format!("released in full swing, {integrator:?}"));
        case.sound(&flight, 5e-3, 800.0);
        let mass: f64 = flight.end.model().lines[0].nodes.mass.iter().sum();
        let [before, after] = [&start, &flight].map(|run| momenta(&run.end));
        // leapfrogs have velocities at the half step before, and their steps depend on the tension
        let [earlier, later] = [&start, &flight].map(|run| 0.5 * last_step(&run.end));
        let fallen = Vector3::new(0.0, 0.0, -(4.0 + earlier - later) * mass * G);
        let change = (after[0] - before[0] - fallen).norm() / fallen.norm();
        case.at_most(1e-12, "momentum", change);
        let turned = (after[1] - before[1]).norm() / before[1].norm();
        case.at_most(bound, "angular momentum", turned);
        case.at_most(1e-3, "gain", flight.energy_gain());
    }
}
