//! Inputs among the variables.

use super::{Binding, Variable};
use crate::simulation::Inputs;

/// Maximum magnitude of an input [m, rad, m/s, rad/s, m/s²]; squares and cubes of greater ones would overflow.
pub const INPUT_MAX: f64 = 1e12;

impl Variable {
    /// Writes the values of an input into `values`, which has its size; a velocity derived from the displacements is 0. Returns whether the variable
    /// is an input.
    pub fn read_input(&self, inputs: &Inputs, values: &mut [f64]) -> bool {
        values[0] = match self.binding {
            Binding::Displacement { body, axis } => inputs.body(body).displacement[axis],
            Binding::Velocity { body, axis } => inputs.body(body).velocity[axis].unwrap_or(0.0),
            Binding::Release { line } => f64::from(u8::from(inputs.releases[line])),
            Binding::LengthChange { line } => inputs.length_changes[line],
            Binding::Flow {
                line,
                component,
                node,
            } => {
                let given = inputs.flow.component(line, component);
                values.copy_from_slice(node.map_or(given, |node| &given[node..=node]));
                return true;
            }
            _ => return false,
        };
        true
    }

    /// Sets an input to values of its size. Returns whether the variable is an input.
    pub fn set_input(&self, inputs: &mut Inputs, values: &[f64]) -> bool {
        match self.binding {
            Binding::Displacement { body, axis } => inputs.body_mut(body).displacement[axis] = values[0],
            Binding::Velocity { body, axis } => inputs.body_mut(body).velocity[axis] = Some(values[0]),
            Binding::Release { line } => inputs.releases[line] = values[0] != 0.0,
            Binding::LengthChange { line } => inputs.length_changes[line] = values[0],
            Binding::Flow {
                line,
                component,
                node,
            } => {
                let (given, first) = (inputs.flow.component_mut(line, component), node.unwrap_or(0));
                given[first..first + values.len()].copy_from_slice(values);
            }
            _ => return false,
        }
        true
    }
}
