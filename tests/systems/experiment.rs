//! Comparison with an experiment: all conditions of Bergdahl et al. (2016) with one set of parameters, run by the
//! comparison example.

#[allow(dead_code)] // the example's own main
#[path = "../../examples/chain_experiment.rs"]
mod chain_experiment;

use std::sync::OnceLock;

use chain_experiment::{Errors, cases, errors, scene, sweep};
use moorline::scene::Scene;

fn errors_of(scene: &Scene) -> Errors {
    let cases = cases().unwrap();
    let found = errors(&cases, &sweep(scene, &cases).unwrap());
    println!("{found:?}");
    found
}

/// Errors of the shipped scene, computed once for all tests.
fn errors_as_shipped() -> Errors {
    static FOUND: OnceLock<Errors> = OnceLock::new();
    *FOUND.get_or_init(|| errors_of(&scene().unwrap()))
}

#[test]
fn the_experiment_has_thirty_conditions() {
    let cases = cases().unwrap();
    assert_eq!(cases.len(), 30);
    let mean = cases.iter().map(|case| case.measured).sum::<f64>() / 30.0;
    assert!((mean - 46.157).abs() < 0.01, "{mean}");
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_forces_of_a_chain_in_a_tank_are_those_measured_within_3_percent_on_the_mean() {
    let found = errors_as_shipped();
    assert!(found.rms < 1.5, "{found:?}");
    assert!(found.mean_relative < 0.03, "{found:?}");
    assert!(found.greatest_relative < 0.08, "{found:?}");
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn half_the_elements_agree_as_well_with_the_experiment() {
    let mut half = scene().unwrap();
    half.lines[0].sections[0].elements = Some(33);
    let (fine, coarse) = (errors_as_shipped(), errors_of(&half));
    assert!((fine.rms - coarse.rms).abs() < 0.1, "{fine:?} {coarse:?}");
    assert!((fine.mean_relative - coarse.mean_relative).abs() < 0.002);
}
