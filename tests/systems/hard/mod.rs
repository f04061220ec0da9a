//! Hard cases: scenes in which cable solvers lose energy, accuracy or convergence. Every case states its bounds: the
//! error of the energy balance, the distance of tension or place from a closed form or a converged run, and the
//! number of internal steps.
//!
//! The scenes are those of the example `hard_cases`, which draws the figures of `docs/hard-cases.md`. `--nocapture`
//! prints the results.

#[allow(dead_code)] // the example uses what the tests do not
#[path = "../../../examples/hard_cases/run.rs"]
mod run;
#[allow(dead_code)] // the same
#[path = "../../../examples/hard_cases/scenes.rs"]
mod scenes;

use moorline::scene::Integrator;

mod energy;
mod falls;
mod landing;
mod motion;
mod stiffness;

/// A run that claims are made of, by name.
struct Case(String);

/// Error that Newton's method leaves of an energy balance, over the energy that flowed [-].
const NEWTON: f64 = 1e-5;

impl Case {
    /// Claims that a quantity of the case is no greater than a bound; prints both.
    fn at_most(&self, bound: f64, quantity: &str, value: f64) {
        let name = &self.0;
        println!("{name}, {quantity}: {value:.3e}, at most {bound:.3e}");
        assert!(
            value <= bound,
            "{name}, {quantity}: {value:.4e} exceeds {bound:.4e}"
        );
    }

    /// Claims that a run stayed finite, that its energy balance closes to a share of the energy that flowed [-], by an implicit integrator to the error that Newton's
    /// method leaves, and that it took no more than a number of internal steps for a second [1/s].
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
