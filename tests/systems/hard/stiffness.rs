//! Widely different magnitudes: stiffness, lengths and masses that differ by orders of magnitude.

use moorline::scene::{ContactLaw, Integrator};

use super::Case;
use super::run::Run;
use super::scenes::*;

/// Difference of two runs of a nearly inextensible line below 0.5 Hz: the shocks of nodes that touch down are never the same [-]. Rounding alone
/// changes the reference, a mean of four runs of generalised-α: the order of one product in the inertia of a node changed the difference of one
/// and the same axial-implicit run from 0.18 to 0.23.
const SHOCKS: f64 = 0.3;

/// The OC3 line for 40 s, its axial stiffness scaled by `factor`.
fn stiff(integrator: Integrator, factor: f64) -> Run {
    let scene = stiffer(shipped("oc3_catenary"), factor);
    Run::of(&by(scene, integrator, 0.02), 40.0, 0.05)
}

/// The nearly inextensible line: mean tension of runs that differ only in their steps, and whose shocks therefore
/// differ.
fn inextensible() -> Run {
    let [mut mean, others @ ..] = [0.005, 0.0025, 0.00125, 0.000625].map(|step| {
        let scene = stiffer(shipped("oc3_catenary"), 1e4);
        Run::of(&by(scene, Integrator::GeneralisedAlpha, step), 40.0, 0.05)
    });
    let count = (1 + others.len()) as f64;
    for (i, tension) in mean.tension.iter_mut().enumerate() {
        let sum = *tension + others.iter().map(|run| run.tension[i]).sum::<f64>();
        *tension = sum / count;
    }
    mean
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_stiffer_line_tends_to_an_inextensible_one_in_steps_that_stay_affordable() {
    let inextensible = inextensible();
    for integrator in INTEGRATORS {
        for (factor, steps) in [(1.0, 170.0), (100.0, 1200.0), (1e4, 300.0)] {
            if integrator == Integrator::Leapfrog && factor > 100.0 {
                continue; // 11 000 steps per second
            }
            let case = Case(format!("EA × {factor}, {integrator:?}"));
            let run = stiff(integrator, factor);
            case.sound(&run, 1e-2, steps);
            let (bound, apart) = (
                if factor == 1.0 { 0.7 } else { SHOCKS },
                run.slow_tension_error(&inextensible, 20.0, 0.5),
            );
            case.at_most(bound, "low-passed tension from the inextensible one", apart);
        }
    }
    let chosen = [1.0, 1e4].map(|factor| stiff(Integrator::Auto, factor).chosen);
    assert_eq!(chosen[0], Integrator::Leapfrog);
    assert_ne!(chosen[1], Integrator::Leapfrog);
}

#[test]
fn a_hundred_times_harder_seabed_takes_the_same_steps_to_the_same_answers() {
    for integrator in INTEGRATORS {
        for (contact, bound) in [(ContactLaw::Regularised, 1e-9), (ContactLaw::AsGiven, 0.12)] {
            let run = |factor: f64| {
                let mut scene = harder_seabed(shipped("oc3_catenary"), factor);
                if let Some(seabed) = &mut scene.seabed {
                    seabed.contact = contact;
                }
                Run::of(&by(scene, integrator, 0.02), 40.0, 0.05)
            };
            let (given, harder) = (run(1.0), run(100.0));
            let case = Case(format!("seabed × 100, {contact:?}, {integrator:?}"));
            case.sound(&harder, 2e-2, 170.0);
            case.at_most(1.03, "steps", harder.substeps as f64 / given.substeps as f64);
            case.at_most(bound, "tension", harder.tension_error(&given, 20.0));
            case.at_most(
                bound,
                "low-passed tension",
                harder.slow_tension_error(&given, 20.0, 0.5),
            );
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_segment_1000_times_shorter_than_its_neighbours_changes_nothing_but_the_steps() {
    let run = |ratio: f64, integrator| Run::of(&by(short_segment(ratio), integrator, 0.01), 30.0, 0.05);
    let plain = run(0.0, Integrator::Leapfrog);
    let fine = Run::of(&with_elements(short_segment(0.0), 240), 30.0, 0.05);
    let slow = |run: &Run| run.slow_tension_error(&fine, 10.0, 0.5);
    for (integrator, steps) in [
        (Integrator::Leapfrog, 19_000.0),
        (Integrator::AxialImplicit, 500.0),
        (Integrator::GeneralisedAlpha, 110.0),
        (Integrator::Auto, 500.0),
    ] {
        let graded = run(1000.0, integrator);
        let case = Case(format!("segment of 5 mm, {integrator:?}"));
        case.sound(&graded, 5e-3, steps);
        let excess = slow(&graded) / slow(&plain);
        case.at_most(1.25, "error over that without it", excess);
        let peak = (graded.peak() / plain.peak() - 1.0).abs();
        case.at_most(5e-3, "peak", peak);
    }
}

/// Integrators of lines that end at a free point.
const JOINED: [Integrator; 4] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
    Integrator::Auto,
];

#[test]
fn a_tonne_on_a_light_rope_swings_as_a_pendulum() {
    for integrator in JOINED {
        let angle = 1.0;
        let run = Run::of(&by(clump(10, 0.0, angle), integrator, 0.005), 20.0, 0.01);
        let case = Case(format!("pendulum, {integrator:?}"));
        case.sound(&run, 1e-3, 5000.0);
        let exact = swing_pulls(angle, 0.01, 2000);
        let peak = (run.peak() / exact.iter().copied().fold(0.0, f64::max) - 1.0).abs();
        case.at_most(5e-3, "peak", peak);
        let pairs = run.tension.iter().zip(&exact);
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        case.at_most(0.02 * CLUMP * G, "tension at any time", apart);
    }
}

#[test]
fn a_tonne_dropped_into_a_light_rope_is_caught_with_its_energy() {
    let fall = 1.0;
    let exact = caught_pull(fall);
    for (integrator, balance) in JOINED.into_iter().zip([5e-3, 5e-3, 0.05, 5e-3]) {
        let run = Run::of(&by(clump(10, fall, 0.0), integrator, 0.001), 2.0, 0.01);
        let case = Case(format!("dropped clump, {integrator:?}"));
        case.sound(&run, balance, 5000.0);
        case.at_most(0.03, "tension", (run.peak() / exact - 1.0).abs());
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_line_almost_without_mass_pulls_as_it_should() {
    for wet in [true, false] {
        for mass in [1e-3, 1e-5] {
            let scene = || nearly_massless(mass, wet);
            let truth = Run::of(&by(scene(), Integrator::GeneralisedAlpha, 0.002), 12.0, 0.05);
            // `auto` makes steps as long as the host's if the line is at rest in every step; the sums of the energy balance have as many terms
            for (integrator, balance, steps) in [
                (Integrator::Leapfrog, 1e-4, 120_000.0), // in water, half as many again, because of the tangential drag
                (Integrator::AxialImplicit, 1e-4, 10_000.0),
                (Integrator::GeneralisedAlpha, 1e-4, 110.0),
                (Integrator::Auto, 2e-4, 4000.0),
            ] {
                let run = Run::of(&by(scene(), integrator, 0.01), 12.0, 0.05);
                let case = Case(format!("{mass} kg/m, wet {wet}, {integrator:?}"));
                case.sound(&run, balance, steps);
                case.at_most(1e-5, "tension", run.tension_error(&truth, 4.0));
            }
        }
    }
}
