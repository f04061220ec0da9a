//! Inputs as written by a host.

use serde::{Deserialize, Serialize};

use super::{Binding, Variable};
use crate::model::Body;
use crate::simulation::{BodyInput, Inputs, WaterFlow};

/// Inputs of a simulation, with the velocities as a host has written them, one variable at a time.
///
/// Hosts that write all inputs at every communication point write the start value 0 to unconnected inputs. A velocity of 0 therefore does not count
/// as given if it is written before the first step, or if the body has moved along its axis and no velocity other than 0 has ever been written for it. The
/// three angular velocities count together, since roll, pitch and yaw turn about other axes.
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
    /// True if the body has moved along or about an axis since the start.
    has_moved: [bool; 6],
    /// True if a velocity has ever been non-zero.
    has_speed: [bool; 6],
}

impl WrittenVelocity {
    /// Sets the velocity of an input along an axis; about an axis, all angular velocities.
    fn pass_on(&self, axis: usize, input: &mut BodyInput) {
        let axes = if axis < 3 { axis..axis + 1 } else { 3..6 };
        let any = |flags: &[bool; 6]| flags[axes.clone()].contains(&true);
        let gives = any(&self.has_speed) || !any(&self.has_moved);
        for axis in axes {
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
        let before = self.given.body(body).displacement;
        let written = &mut self.velocities[self.given.place(body)];
        for (axis, before) in before.iter().enumerate() {
            written.has_moved[axis] |= input.displacement[axis] != *before;
        }
        written.value = input.velocity.map(|velocity| velocity.unwrap_or(0.0));
        written.is_given = input.velocity.map(|velocity| velocity.is_some());
        written.has_speed = written.is_given; // 0 is a velocity too
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
                let written = &mut self.velocities[place];
                if steps && values[0] != before && !written.has_moved[axis] {
                    written.has_moved[axis] = true;
                    written.pass_on(axis, input);
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
        written.has_speed[axis] |= value != 0.0;
        written.pass_on(axis, input);
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
        assert_eq!(given(&inputs)[..3], [None, Some(0.0), None]);
        inputs.write(row("vx"), &[0.5], true);
        inputs.write(row("vx"), &[0.0], true);
        assert_eq!(given(&inputs)[..3], [Some(0.0), Some(0.0), None]);
        inputs.write(row("y"), &[0.1], true);
        assert_eq!(given(&inputs)[..3], [Some(0.0), None, None]);
        let moved = BodyInput {
            displacement: [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
            velocity: [None; 6],
        };
        inputs.set_body(body, moved);
        inputs.write(row("vx"), &[0.0], true);
        assert_eq!(given(&inputs), [None; 6]);
    }
}
