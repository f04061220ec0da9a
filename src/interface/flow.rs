//! Variables for the flow of the water that a host gives at the nodes of a line, and for the positions at which the host must evaluate it.

use super::rows::{AXES, at_nodes, range, row};
use super::{Binding, Causality, Layout, Unit, Variable};
use crate::model::Model;
use crate::simulation::{FLOW_COMPONENTS, Simulation};

/// Adds the flow at the nodes of all lines on which it acts.
pub(super) fn push(variables: &mut Vec<Variable>, model: &Model, layout: Layout) {
    for (line, built) in model.lines.iter().enumerate() {
        let (count, owner) = (built.flow_count(model), &built.name);
        if count == 0 {
            continue;
        }
        for (component, label) in FLOW_COMPONENTS.into_iter().enumerate() {
            let (what, unit) = match component {
                0..3 => ("velocity", Unit::METRE_PER_SECOND),
                _ => ("acceleration", Unit::METRE_PER_SECOND_SQUARED),
            };
            let along = AXES[component % 3];
            let name = format!("{owner}.flow.{label}");
            at_nodes(variables, (layout, count), &name, |name, place, node| {
                let of = format!("{owner}: {what} of the water along global {along} at {place} from end A");
                let binding = Binding::Flow {
                    line,
                    component,
                    node,
                };
                row(name, of, Causality::Input, unit, binding)
            });
        }
        for (axis, label) in AXES.into_iter().enumerate() {
            let name = format!("{owner}.flow.{label}");
            at_nodes(variables, (layout, count), &name, |name, place, node| {
                let of = format!(
                    "{owner}: global {label} of the position at which the next flow is needed, at {place} from end A"
                );
                let binding = Binding::FlowPlace { line, axis, node };
                row(name, of, Causality::Output, Unit::METRE, binding)
            });
        }
    }
}

/// Writes a coordinate of the positions at which the next flow is needed.
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
