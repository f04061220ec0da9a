//! Flow of the water at the nodes of a line, which a host gives, and the places for which it gives it, as variables.

use std::ops::Range;

use super::rows::{AXES, at_nodes, row};
use super::{Binding, Causality, Layout, Unit, Variable};
use crate::model::Model;
use crate::simulation::{FLOW_COMPONENTS, Simulation};

/// Rows of all lines that take a flow.
pub(super) fn push(variables: &mut Vec<Variable>, model: &Model, layout: Layout) {
    for (line, built) in model.lines.iter().enumerate() {
        if !built.takes_flow(model) {
            continue;
        }
        let (nodes, owner) = ((layout, built.segment_count() + 1), &built.name);
        for (component, label) in FLOW_COMPONENTS.into_iter().enumerate() {
            let (what, unit) = match component {
                0..3 => ("velocity", Unit::METRE_PER_SECOND),
                _ => ("acceleration", Unit::METRE_PER_SECOND_SQUARED),
            };
            let along = AXES[component % 3];
            at_nodes(
                variables,
                nodes,
                &format!("{owner}.flow.{label}"),
                |name, place, node| {
                    let meaning =
                        format!("{owner}: {what} of the water along global {along} at {place} from end A");
                    let binding = Binding::Flow {
                        line,
                        component,
                        node,
                    };
                    row(name, meaning, Causality::Input, unit, binding)
                },
            );
        }
        for (axis, label) in AXES.into_iter().enumerate() {
            at_nodes(
                variables,
                nodes,
                &format!("{owner}.flow.{label}"),
                |name, place, node| {
                    let meaning = format!(
                        "{owner}: global {label} where the next flow is to be given, of {place} from end A"
                    );
                    let binding = Binding::FlowPlace { line, axis, node };
                    row(name, meaning, Causality::Output, Unit::METRE, binding)
                },
            );
        }
    }
}

/// Nodes of an array of values, or the only one.
pub fn range(node: Option<usize>, count: usize) -> Range<usize> {
    node.map_or(0..count, |node| node..node + 1)
}

/// Writes a component of the flow that was given.
pub(super) fn read(
    simulation: &Simulation,
    line: usize,
    component: usize,
    node: Option<usize>,
    values: &mut [f64],
) {
    let given = simulation.flow().component(line, component);
    values.copy_from_slice(&given[range(node, values.len())]);
}

/// Writes a coordinate of the places for which the next flow is to be given.
pub(super) fn read_place(
    simulation: &Simulation,
    line: usize,
    axis: usize,
    node: Option<usize>,
    values: &mut [f64],
) {
    let nodes = range(node, values.len());
    for (value, node) in values.iter_mut().zip(nodes) {
        *value = simulation.flow_place(line, node)[axis];
    }
}
