//! Hard cases: where cable solvers lose energy, accuracy, steps or themselves. Every case states what must hold: how far the energy ledger may be
//! from closing, how far tension or place from a closed form or a converged run, and how many internal steps it may take.
//!
//! The scenes are those of the example `hard_cases`, which draws the figures of `docs/hard-cases.md`. `--nocapture` prints what is found.

#[allow(dead_code)] // the example uses what the tests do not
#[path = "../../../examples/hard_cases/run.rs"]
mod run;
#[allow(dead_code)] // the same
#[path = "../../../examples/hard_cases/scenes.rs"]
mod scenes;

use moorline::scene::Integrator;

mod energy;
mod falls;
mod motion;
mod stiffness;

/// Claims that a quantity is no greater than a bound; prints both.
fn at_most(bound: f64, what: &str, value: f64) {
    println!("{what}: {value:.3e}, at most {bound:.3e}");
    assert!(value <= bound, "{what}: {value:.4e} exceeds {bound:.4e}");
}

/// Error that Newton's method leaves of a ledger, over the energy that flowed [-].
const NEWTON: f64 = 1e-5;

/// Claims that a run stayed finite, that its ledger closes to a share of the energy that flowed [-], by an implicit integrator to what Newton's method
/// leaves, and that it took no more than so many internal steps for a second [1/s].
fn sound(what: &str, run: &run::Run, ledger: f64, steps: f64) {
    assert!(run.is_finite(), "{what}");
    let ledger = match run.chosen {
        Integrator::GeneralisedAlpha => ledger.min(NEWTON),
        _ => ledger,
    };
    at_most(ledger, &format!("{what}, ledger"), run.ledger_error());
    at_most(
        steps,
        &format!("{what}, steps for a second"),
        run.substeps_per_second(),
    );
}
