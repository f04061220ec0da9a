//! Derivatives of outputs: by the motion of the bodies at the end of the last step, and in time.
//!
//! Sources: FMI 2.0.4 section 2.1.9 and 4.2.2, FMI 3.0.2 section 2.2.11 and 4.2. An unknown is any output of type Float64; a known is a
//! displacement or a velocity of a point or vessel, at the end of the step just made, whether the host gave it for that time
//! (`input_reconstruction = "interpolate"`) or it was extrapolated.

use moorline::interface::{Binding, Causality, Interface, Kind, Variable};
use moorline::simulation::{EndMotion, Simulation};

use super::{Instance, Outcome, Refusal};
use crate::saved::Phase;

impl Instance {
    /// Derivative of unknowns in the direction `seed` of the knowns.
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

    /// Derivatives by the knowns of the sum of the unknowns times `seed`.
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

    /// First derivatives in time of outputs.
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
        let rows = self.outputs(references, values.len())?;
        let simulation = self.simulation.as_ref().ok_or(NO_SIMULATION)?;
        let rates = simulation.rates(|simulation| read(&rows, simulation))?;
        values.copy_from_slice(&rates);
        Ok(())
    }

    /// Gives the columns of the derivatives of unknowns, of `size` values, by each known to `take`.
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
            let motion = end_motion(Self::variable(&self.interface, known)?)?;
            let column = simulation.derivative(motion, |simulation| read(&rows, simulation))?;
            take(number, &column);
        }
        Ok(())
    }

    /// Outputs by their references, which have `size` values together.
    fn outputs(&self, references: &[u32], size: usize) -> Result<Vec<&Variable>, Refusal> {
        let row = |&reference: &u32| match Self::variable(&self.interface, reference)? {
            row if row.causality == Causality::Output && row.kind == Kind::Float64 => Ok(row),
            row => Err(Refusal(format!(
                "{}: only outputs of type Float64 have derivatives",
                row.name
            ))),
        };
        let rows: Vec<&Variable> = references.iter().map(row).collect::<Result<_, _>>()?;
        count("value", size, rows.iter().map(|row| row.size()).sum())?;
        Ok(rows)
    }
}

/// Reason for which there is nothing to differentiate.
const NO_SIMULATION: &str = "out of order: derivatives are available from initialization mode on";

/// Component of the motion that an input gives.
fn end_motion(variable: &Variable) -> Result<EndMotion, Refusal> {
    let (body, axis, is_velocity) = match variable.binding {
        Binding::Displacement { body, axis } => (body, axis, false),
        Binding::Velocity { body, axis } => (body, axis, true),
        _ => {
            return Err(Refusal(format!(
                "{}: derivatives are with respect to displacements and velocities of points and vessels",
                variable.name
            )));
        }
    };
    Ok(EndMotion {
        body,
        axis,
        is_velocity,
    })
}

/// Values of outputs, one after the other.
fn read(rows: &[&Variable], simulation: &Simulation) -> Result<Vec<f64>, String> {
    let mut values = vec![0.0; rows.iter().map(|row| row.size()).sum()];
    let mut rest = &mut values[..];
    for row in rows {
        let (own, others) = rest.split_at_mut(row.size());
        Interface::read(row, simulation, own)?;
        rest = others;
    }
    Ok(values)
}

/// Refuses another number of values than there are.
fn count(what: &str, given: usize, wanted: usize) -> Outcome {
    match given == wanted {
        true => Ok(()),
        false => Err(Refusal(format!(
            "the host gave {given} {what}s: {wanted} would be right"
        ))),
    }
}
