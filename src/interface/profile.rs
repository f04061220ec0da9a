//! Node positions and tensions of a line as variables.

use super::rows::{AXES, at_nodes, range, row};
use super::{Binding, Causality, Layout, ProfileQuantity, Unit, Variable};
use crate::model::Model;
use crate::scene::Axis;
use crate::simulation::Simulation;

/// Adds the profiles of all lines.
pub(super) fn push(variables: &mut Vec<Variable>, model: &Model, layout: Layout) {
    for (line, built) in model.lines.iter().enumerate() {
        let (nodes, owner) = (built.nodes_max(), &built.name);
        for (label, meaning, unit, quantity) in quantities(built.bends()) {
            let name = format!("{owner}.profile.{label}");
            at_nodes(variables, (layout, nodes), &name, |name, place, node| {
                let description = format!("{owner}: {meaning} at {place} from end A");
                let binding = Binding::Profile { line, quantity, node };
                row(name, description, Causality::Output, unit, binding)
            });
        }
    }
}

/// Label, meaning, unit and binding of the quantities at the nodes of a line.
fn quantities(bends: bool) -> Vec<(&'static str, String, Unit, ProfileQuantity)> {
    let axes = [Axis::X, Axis::Y, Axis::Z].into_iter().zip(AXES);
    let position = |(axis, label)| {
        (
            label,
            format!("global {label}"),
            Unit::METRE,
            ProfileQuantity::Position(axis),
        )
    };
    let mut quantities: Vec<_> = axes.map(position).collect();
    let tension = "effective tension (at the ends the magnitude of the line's force)".into();
    quantities.push(("tension", tension, Unit::NEWTON, ProfileQuantity::Tension));
    if bends {
        quantities.push((
            "curvature",
            "curvature".into(),
            Unit::PER_METRE,
            ProfileQuantity::Curvature,
        ));
        quantities.push((
            "moment",
            "bending moment".into(),
            Unit::NEWTON_METRE,
            ProfileQuantity::Moment,
        ));
    }
    quantities
}

/// Writes the values of a profile variable; nodes that a winch has not paid out are at the winch.
pub(super) fn read(
    simulation: &Simulation,
    line: usize,
    quantity: ProfileQuantity,
    node: Option<usize>,
    values: &mut [f64],
) {
    let range = range(node, values.len());
    match quantity {
        ProfileQuantity::Position(axis) => {
            let axis = axis as usize;
            let positions = &simulation.state().lines[line].position;
            for (value, node) in values.iter_mut().zip(range) {
                *value = positions[node.min(positions.len() - 1)][axis];
            }
        }
        ProfileQuantity::Tension => {
            let tensions = simulation.tensions(line);
            for (value, node) in values.iter_mut().zip(range) {
                *value = tensions[node.min(tensions.len() - 1)];
            }
        }
        ProfileQuantity::Curvature | ProfileQuantity::Moment => {
            let nodes = simulation.bending(line).unwrap_or_default();
            for (value, node) in values.iter_mut().zip(range) {
                let node = nodes.get(node).copied().unwrap_or_default();
                *value = match quantity {
                    ProfileQuantity::Curvature => node.curvature,
                    _ => node.moment,
                };
            }
        }
    }
}
