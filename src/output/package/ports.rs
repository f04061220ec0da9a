//! Coupled points and vessels of a scene, each with the variables of its motion and its force.

use crate::interface::{Binding, Interface, Variable};
use crate::model::Body;

/// A coupled point or vessel.
pub(super) struct Port<'i> {
    pub(super) name: &'i str,
    /// Displacements [m] and angles [rad], by axis.
    pub(super) displacements: Vec<&'i Variable>,
    /// Velocities [m/s] and angular velocities [rad/s], by axis.
    pub(super) velocities: Vec<&'i Variable>,
    /// Forces [N] and moments [N m] of the mooring, by axis.
    pub(super) forces: Vec<&'i Variable>,
}

impl<'i> Port<'i> {
    /// All variables, in the order of the table.
    pub(super) fn variables(&self) -> impl Iterator<Item = &'i Variable> {
        let all = [&self.displacements, &self.velocities, &self.forces];
        all.into_iter().flatten().copied()
    }

    /// Returns whether the port is a vessel.
    pub(super) fn turns(&self) -> bool {
        self.displacements.len() > 3
    }

    /// Name of one of the port's variables, without the name of the port.
    pub(super) fn member(&self, variable: &'i Variable) -> &'i str {
        let rest = variable.name.strip_prefix(self.name);
        rest.and_then(|rest| rest.strip_prefix('.'))
            .unwrap_or(&variable.name)
    }
}

/// Coupled points, then vessels, in the order of the table.
pub(super) fn ports(interface: &Interface) -> Vec<Port<'_>> {
    let mut ports: Vec<(Body, Port<'_>)> = Vec::new();
    for variable in interface.variables() {
        let (Binding::Displacement { body, .. }
        | Binding::Velocity { body, .. }
        | Binding::EndForce { body, .. }) = variable.binding
        else {
            continue;
        };
        if ports.last().is_none_or(|(last, _)| *last != body) {
            let name = variable.name.rsplit_once('.').map_or("", |(name, _)| name);
            let (displacements, velocities, forces) = (Vec::new(), Vec::new(), Vec::new());
            let port = Port {
                name,
                displacements,
                velocities,
                forces,
            };
            ports.push((body, port));
        }
        if let Some((_, port)) = ports.last_mut() {
            match variable.binding {
                Binding::Displacement { .. } => port.displacements.push(variable),
                Binding::Velocity { .. } => port.velocities.push(variable),
                _ => port.forces.push(variable),
            }
        }
    }
    ports.into_iter().map(|(_, port)| port).collect()
}
