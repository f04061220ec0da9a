//! Inputs as written by a host.

use serde::{Deserialize, Serialize};

use super::{Binding, Variable};
use crate::model::Body;
use crate::simulation::{BodyInput, Inputs, WaterFlow};

/// Inputs of a simulation, with the velocities as a host has written them, one variable at a time.
///
/// Hosts that write all inputs at every communication point write the start value 0 to unconnected inputs. A velocity of 0 therefore does not count
/// as given if it is written before the first step, or if the body has moved and no velocity other than 0 has ever been written.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct HostInputs {
    given: Inputs,
    /// Velocities of every point, then of every vessel.
    velocities: Vec<WrittenVelocity>,
}

/// Velocity that a host has written for a point, which has the first three axes, or for a vessel, which has six.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct WrittenVelocity {
    /// Velocity [m/s] and angular velocity [rad/s]; 0 before the host writes one.
    value: [f64; 6],
    /// True if the host gives the velocity.
    is_given: [bool; 6],
    /// True if the body has moved since the start, in translation and in rotation.
    has_moved: [bool; 2],
    /// True if a velocity has ever been non-zero, in translation and in rotation.
    has_speed: [bool; 2],
}

impl WrittenVelocity {
    /// Sets the velocities of an input: translational (`kind` 0) or angular (`kind` 1).
    fn pass_on(&self, kind: usize, input: &mut BodyInput) {
        let gives = self.has_speed[kind] || !self.has_moved[kind];
        for axis in 3 * kind..3 * kind + 3 {
            input.velocity[axis] = (gives && self.is_given[axis]).then_some(self.value[axis]);
        }
    }
}

impl HostInputs {
    /// Inputs before a host has written any: those of a simulation `at_rest`.
    pub fn new(at_rest: &Inputs) -> HostInputs {
        HostInputs {
            velocities: vec![WrittenVelocity::default(); at_rest.bodies().len()],
            given: at_rest.clone(),
        }
    }

    /// Inputs of the simulation.
    pub fn given(&self) -> &Inputs {
        &self.given
    }

    /// Flow of the water, for modification.
    pub fn flow_mut(&mut self) -> &mut WaterFlow {
        &mut self.given.flow
    }

    /// Sets the displacement and the velocity of a body exactly as given; an absent velocity is derived from the displacements.
    pub fn set_body(&mut self, body: Body, input: BodyInput) {
        let written = &mut self.velocities[self.given.place(body)];
        written.value = input.velocity.map(|velocity| velocity.unwrap_or(0.0));
        written.is_given = input.velocity.map(|velocity| velocity.is_some());
        written.has_speed = [0, 3].map(|first| written.is_given[first]); // 0 is a velocity too
        *self.given.body_mut(body) = input;
    }

    /// Reads the values of an input as written; returns whether the variable is an input.
    pub fn read(&self, variable: &Variable, values: &mut [f64]) -> bool {
        match variable.binding {
            Binding::Velocity { body, axis } => {
                values[0] = self.velocities[self.given.place(body)].value[axis];
                true
            }
            _ => variable.read_input(&self.given, values),
        }
    }

    /// Writes the values of an input. From the start of stepping `steps` is true; a written 0 then counts as the velocity of a body at rest.
    pub fn write(&mut self, variable: &Variable, values: &[f64], steps: bool) {
        match variable.binding {
            Binding::Velocity { body, axis } => self.write_velocity(body, axis, values[0], steps),
            Binding::Displacement { body, axis } => {
                let (place, input) = (self.given.place(body), self.given.body_mut(body));
                let before = std::mem::replace(&mut input.displacement[axis], values[0]);
                let (written, kind) = (&mut self.velocities[place], axis / 3);
                if steps && values[0] != before && !written.has_moved[kind] {
                    written.has_moved[kind] = true;
                    written.pass_on(kind, input);
                }
            }
            _ => {
                variable.set_input(&mut self.given, values);
            }
        }
    }

    /// Writes the velocity of a body along or about an axis; with `is_given`, 0 counts as a velocity too.
    pub fn write_velocity(&mut self, body: Body, axis: usize, value: f64, is_given: bool) {
        let (place, input) = (self.given.place(body), self.given.body_mut(body));
        let written = &mut self.velocities[place];
        written.value[axis] = value;
        written.is_given[axis] |= is_given || value != 0.0;
        written.has_speed[axis / 3] |= value != 0.0;
        written.pass_on(axis / 3, input);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::draft;
    use crate::interface::{Interface, Layout};

    #[test]
    fn zero_is_a_velocity_only_of_what_rests_or_was_ever_faster() {
        let rope = "line_types.rope = { mass = 1.0, axial_stiffness = 1e4 }";
        let drawn = draft(rope)
            .fixed("anchor", [0.0; 3])
            .coupled("hand", [10.0, 0.0, 0.0]);
        let drawn = drawn.sections("rope", ["anchor", "hand"], &[("rope", 11.0, Some(4))]);
        let interface = Interface::new(&drawn.scene(), &drawn.model(), Layout::Scalars).unwrap();
        let mut inputs = HostInputs::new(interface.inputs());
        let row = |name: &str| {
            let mut rows = interface.variables().iter();
            rows.find(|row| row.name == format!("hand.{name}")).unwrap()
        };
        let Binding::Velocity { body, .. } = row("vx").binding else {
            panic!("a velocity");
        };
        let given = |inputs: &HostInputs| inputs.given().body(body).velocity;
        inputs.write(row("vx"), &[0.0], false);
        assert_eq!(given(&inputs), [None; 6]);
        inputs.write(row("vx"), &[0.0], true);
        inputs.write(row("vy"), &[0.0], true);
        assert_eq!(given(&inputs)[..3], [Some(0.0), Some(0.0), None]);
        inputs.write(row("x"), &[0.1], true);
        assert_eq!(given(&inputs), [None; 6]);
        inputs.write(row("vx"), &[0.5], true);
        inputs.write(row("vx"), &[0.0], true);
        assert_eq!(given(&inputs)[..3], [Some(0.0), Some(0.0), None]);
    }
}
