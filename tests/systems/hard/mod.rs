//! Hard cases: scenes in which cable solvers lose energy, accuracy or convergence. Every case states its bounds: the
//! error of the energy balance, the deviation of tension or position from a closed form or a converged run, and the
//! number of internal steps.
//!
//! The scenes are those of the example `hard_cases`, which plots the figures of `docs/hard-cases.md`. `--nocapture`
//! prints the results.

#[allow(dead_code)] // the example uses items that the tests do not
#[path = "../../../examples/hard_cases/run.rs"]
mod run;
#[allow(dead_code)] // as above
#[path = "../../../examples/hard_cases/scenes.rs"]
mod scenes;

use moorline::scene::Integrator;

mod energy;
mod falls;
mod landing;
mod motion;
mod stiffness;

/// Name of a run under test.
struct Case(String);

/// Error of an energy balance caused by the tolerance of Newton's method, relative to the transferred energy [-].
const NEWTON: f64 = 1e-5;

impl Case {
    /// Asserts that a quantity of the case does not exceed a bound; prints both.
    fn at_most(&self, bound: f64, quantity: &str, value: f64) {
        let name = &self.0;
        println!("{name}, {quantity}: {value:.3e}, at most {bound:.3e}");
        assert!(
            value <= bound,
            "{name}, {quantity}: {value:.4e} exceeds {bound:.4e}"
        );
    }

    /// Asserts that a run is finite, that the error of its energy balance is at most `balance` of the transferred energy [-] (for an implicit integrator,
    /// that of Newton's method), and that it makes at most `steps` internal steps per second [1/s].
    fn sound(&self, run: &run::Run, balance: f64, steps: f64) {
        assert!(run.is_finite(), "{}", self.0);
        let balance = match run.chosen {
            Integrator::GeneralisedAlpha => balance.min(NEWTON),
            _ => balance,
        };
        self.at_most(balance, "balance", run.ledger_error());
        self.at_most(steps, "steps for a second", run.substeps_per_second());
    }
}
