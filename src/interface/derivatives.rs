//! Derivatives of outputs with respect to the motion of the bodies at the end of the last step, and to time.
//!
//! Outputs of type Float64 have derivatives with respect to displacements and velocities of points and vessels at the end of the last step. These were
//! given by the host for that time (`input_reconstruction = "interpolate"`), or extrapolated.

use super::{Binding, Causality, Interface, Kind, Variable};
use crate::simulation::{EndMotion, Simulation};

impl Interface {
    /// Derivatives of the values of outputs, one after another, with respect to an input.
    ///
    /// # Errors
    /// An output without derivatives, an input that is neither a displacement nor a velocity, or an error of [`Simulation::derivative`].
    pub fn derivative(
        outputs: &[&Variable],
        input: &Variable,
        simulation: &Simulation,
    ) -> Result<Vec<f64>, String> {
        expect_differentiable(outputs)?;
        simulation.derivative(end_motion(input)?, |simulation| values(outputs, simulation))
    }

    /// Time derivatives of the values of outputs, one after another.
    ///
    /// # Errors
    /// An output without derivatives, or an error of [`Simulation::rates`].
    pub fn rates(outputs: &[&Variable], simulation: &Simulation) -> Result<Vec<f64>, String> {
        expect_differentiable(outputs)?;
        simulation.rates(|simulation| values(outputs, simulation))
    }
}

fn expect_differentiable(outputs: &[&Variable]) -> Result<(), String> {
    let has_derivatives =
        |variable: &Variable| variable.causality == Causality::Output && variable.kind == Kind::Float64;
    match outputs.iter().find(|variable| !has_derivatives(variable)) {
        None => Ok(()),
        Some(variable) => Err(format!(
            "{}: only outputs of type Float64 have derivatives",
            variable.name
        )),
    }
}

/// Component of the motion that an input sets.
fn end_motion(input: &Variable) -> Result<EndMotion, String> {
    let (body, axis, is_velocity) = match input.binding {
        Binding::Displacement { body, axis } => (body, axis, false),
        Binding::Velocity { body, axis } => (body, axis, true),
        _ => {
            return Err(format!(
                "{}: derivatives are with respect to displacements and velocities of points and vessels",
                input.name
            ));
        }
    };
    Ok(EndMotion {
        body,
        axis,
        is_velocity,
    })
}

/// Values of outputs, one after another.
fn values(outputs: &[&Variable], simulation: &Simulation) -> Result<Vec<f64>, String> {
    let mut values = vec![0.0; outputs.iter().map(|output| output.size()).sum()];
    let mut rest = &mut values[..];
    for output in outputs {
        let (own, others) = rest.split_at_mut(output.size());
        Interface::read(output, simulation, own)?;
        rest = others;
    }
    Ok(values)
}
