//! Derivatives of outputs with respect to the motion of the bodies at the end of the last step, and to time.
//!
//! Sources: FMI 2.0.4 section 2.1.9 and 4.2.2, FMI 3.0.2 section 2.2.11 and 4.2. Unknowns and knowns are the outputs and inputs of
//! [`Interface::derivative`].

use moorline::interface::{Interface, Variable};

use super::{Instance, Outcome, Refusal};
use crate::saved::Phase;

impl Instance {
    /// Computes the derivative of the unknowns in the direction `seed` of the knowns.
    pub(crate) fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Outcome {
        count("seed", seed.len(), knowns.len())?;
        let mut sum = vec![0.0; sensitivity.len()];
        self.for_columns(unknowns, knowns, sensitivity.len(), |known, column| {
            for (sum, value) in sum.iter_mut().zip(column) {
                *sum += seed[known] * value;
            }
        })?;
        sensitivity.copy_from_slice(&sum);
        Ok(())
    }

    /// Computes the derivatives of the `seed`-weighted sum of the unknowns with respect to the knowns.
    pub(crate) fn adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Outcome {
        count("sensitivity", sensitivity.len(), knowns.len())?;
        let mut found = vec![0.0; sensitivity.len()];
        self.for_columns(unknowns, knowns, seed.len(), |known, column| {
            found[known] = column.iter().zip(seed).map(|(value, seed)| value * seed).sum();
        })?;
        sensitivity.copy_from_slice(&found);
        Ok(())
    }

    /// Computes the first time derivatives of outputs.
    pub(crate) fn output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [f64],
    ) -> Outcome {
        count("order", orders.len(), references.len())?;
        if let Some(order) = orders.iter().find(|&&order| order != 1) {
            return Err(Refusal(format!(
                "outputs have derivatives of order 1, not of order {order}"
            )));
        }
        if self.phase == Phase::Initialization {
            self.solve_statics()?;
        }
        let rows = self.outputs(references, values.len())?;
        let simulation = self.simulation.as_ref().ok_or(NO_SIMULATION)?;
        values.copy_from_slice(&Interface::rates(&rows, simulation)?);
        Ok(())
    }

    /// Passes to `take` the derivatives of the unknowns, `size` values in total, with respect to each known in turn.
    fn for_columns(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        size: usize,
        mut take: impl FnMut(usize, &[f64]),
    ) -> Outcome {
        self.expect_phase(&[Phase::Initialization, Phase::Step, Phase::Terminated])?;
        if self.phase == Phase::Initialization {
            self.solve_statics()?;
        }
        let rows = self.outputs(unknowns, size)?;
        let simulation = self.simulation.as_ref().ok_or(NO_SIMULATION)?;
        for (number, &known) in knowns.iter().enumerate() {
            let known = Self::variable(&self.interface, known)?;
            take(number, &Interface::derivative(&rows, known, simulation)?);
        }
        Ok(())
    }

    /// Returns the variables with these references; refuses variables that do not have `size` values in total.
    fn outputs(&self, references: &[u32], size: usize) -> Result<Vec<&Variable>, Refusal> {
        let row = |&reference: &u32| Self::variable(&self.interface, reference);
        let rows: Vec<&Variable> = references.iter().map(row).collect::<Result<_, _>>()?;
        count("value", size, rows.iter().map(|row| row.size()).sum())?;
        Ok(rows)
    }
}

/// Error message before the simulation exists.
const NO_SIMULATION: &str = "out of order: derivatives are available from initialization mode on";

/// Refuses a wrong number of values.
fn count(what: &str, given: usize, wanted: usize) -> Outcome {
    match given == wanted {
        true => Ok(()),
        false => Err(Refusal(format!(
            "the host gave {given} {what}s: {wanted} would be right"
        ))),
    }
}
