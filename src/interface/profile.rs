//! Node positions and tensions of a line as variables.

use super::rows::{AXES, row};
use super::{Binding, Causality, Layout, ProfileQuantity, Unit, Variable};
use crate::model::Model;
use crate::scene::Axis;
use crate::simulation::Simulation;

/// Rows of the profiles of all lines.
pub(super) fn push(variables: &mut Vec<Variable>, model: &Model, layout: Layout) {
    for (line, built) in model.lines.iter().enumerate() {
        let nodes = built.nodes_max();
        let mut push = |label: &str, meaning: &str, unit: Unit, quantity: ProfileQuantity| {
            let name = format!("{}.profile.{label}", built.name);
            let description = format!("{}: {meaning} at the nodes from end A to end B", built.name);
            let mut push = |name, description, node, dimension| {
                let binding = Binding::Profile { line, quantity, node };
                let mut variable = row(name, description, Causality::Output, unit, binding);
                variable.dimension = dimension;
                variables.push(variable);
            };
            match layout {
                Layout::Arrays => push(name, description, None, Some(nodes)),
                Layout::Scalars => {
                    for node in 0..nodes {
                        let number = node + 1;
                        let description = format!("{}: {meaning} at node {number} from end A", built.name);
                        push(format!("{name}[{number}]"), description, Some(node), None);
                    }
                }
            }
        };
        for (axis, label) in [Axis::X, Axis::Y, Axis::Z].into_iter().zip(AXES) {
            push(
                label,
                &format!("global {label}"),
                Unit::METRE,
                ProfileQuantity::Position(axis),
            );
        }
        push(
            "tension",
            "effective tension (at the ends the size of the line's force)",
            Unit::NEWTON,
            ProfileQuantity::Tension,
        );
        if built.bends() {
            push(
                "curvature",
                "curvature",
                Unit::PER_METRE,
                ProfileQuantity::Curvature,
            );
            push(
                "moment",
                "bending moment",
                Unit::NEWTON_METRE,
                ProfileQuantity::Moment,
            );
        }
    }
}

/// Writes the values of a profile variable; nodes that a winch has not paid out are at the winch.
pub(super) fn read(
    simulation: &Simulation,
    line: usize,
    quantity: ProfileQuantity,
    node: Option<usize>,
    values: &mut [f64],
) {
    let range = node.map_or(0..values.len(), |node| node..node + 1);
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
