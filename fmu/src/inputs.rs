//! Inputs as a host writes them.

use moorline::interface::{Binding, Variable};
use moorline::model::Body;
use moorline::simulation::{BodyInput, Inputs};
use serde::{Deserialize, Serialize};

/// Inputs of a simulation, with the velocities as the host has written them.
///
/// Hosts that write all inputs at every communication point write the start value 0 to unconnected ones. A velocity of 0 written before the first step is
/// therefore none, and neither are velocities that were never other than 0 for a body that has moved.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct HostInputs {
    given: Inputs,
    /// Of every point, then of every vessel.
    velocities: Vec<WrittenVelocity>,
}

/// Velocity that a host has written for a point, which has the first three axes, or for a vessel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct WrittenVelocity {
    /// Velocity [m/s] and angular velocity [rad/s]; 0 before one is written.
    value: [f64; 6],
    /// True if the host gives the velocity.
    is_given: [bool; 6],
    /// True if the body has moved since the start, along and about the axes.
    has_moved: [bool; 2],
    /// True if any velocity was ever non-zero, along and about the axes.
    has_speed: [bool; 2],
}

impl WrittenVelocity {
    /// Sets the velocities of an input along the axes, or with `kind` 1 about them.
    fn pass_on(&self, kind: usize, input: &mut BodyInput) {
        let gives = self.has_speed[kind] || !self.has_moved[kind];
        for axis in 3 * kind..3 * kind + 3 {
            input.velocity[axis] = (gives && self.is_given[axis]).then_some(self.value[axis]);
        }
    }
}

impl HostInputs {
    /// Inputs before a host writes any, those of a simulation `at_rest`.
    pub(crate) fn new(at_rest: &Inputs) -> HostInputs {
        HostInputs {
            velocities: vec![WrittenVelocity::default(); at_rest.bodies().len()],
            given: at_rest.clone(),
        }
    }

    /// Inputs of the simulation.
    pub(crate) fn given(&self) -> &Inputs {
        &self.given
    }

    /// Values of an input as written; returns whether the variable is an input.
    pub(crate) fn read(&self, variable: &Variable, values: &mut [f64]) -> bool {
        match variable.binding {
            Binding::Velocity { body, axis } => {
                values[0] = self.velocities[self.given.place(body)].value[axis];
                true
            }
            _ => variable.read_input(&self.given, values),
        }
    }

    /// Writes an input, before the first step or between two `steps`.
    pub(crate) fn write(&mut self, variable: &Variable, values: &[f64], steps: bool) {
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

    /// Writes the velocity of a body along or about an axis; 0 counts as a velocity where it `is_given`.
    pub(crate) fn write_velocity(&mut self, body: Body, axis: usize, value: f64, is_given: bool) {
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
    use moorline::interface::{Interface, Layout};
    use moorline::model::Model;
    use moorline::scene::Scene;

    #[test]
    fn zero_is_a_velocity_only_of_what_rests_or_was_ever_faster() {
        let scene = Scene::from_toml(include_str!("../../tests/scenes/hand.toml")).unwrap();
        let model = Model::new(&scene).unwrap();
        let interface = Interface::new(&scene, &model, Layout::Scalars).unwrap();
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
