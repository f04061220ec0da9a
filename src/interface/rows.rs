//! The rows of the table, one function for each part of a scene.

use std::ops::Range;

use super::{Binding, Causality, Kind, Layout, SolverResult, Unit, Variability, Variable};
use crate::model::Body;
use crate::scene;
use crate::scene::table::Choice;

pub(super) fn row(
    name: String,
    description: String,
    causality: Causality,
    unit: Unit,
    binding: Binding,
) -> Variable {
    let (kind, variability) = match (&binding, causality) {
        (Binding::Release { .. }, _) => (Kind::Boolean, Variability::Discrete),
        (Binding::Solver(SolverResult::Substeps), _) => (Kind::Int32, Variability::Discrete),
        (_, Causality::Input | Causality::Output) => (Kind::Float64, Variability::Continuous),
        (_, Causality::Parameter | Causality::CalculatedParameter) => (Kind::Float64, Variability::Fixed),
    };
    let is_magnitude = matches!(
        binding,
        Binding::Line { .. } | Binding::Solver(SolverResult::Substeps | SolverResult::InputError)
    );
    Variable {
        name,
        description,
        causality,
        variability,
        kind,
        unit,
        dimension: None,
        start: (causality == Causality::Input).then_some(0.0),
        range: [is_magnitude.then_some(0.0), None],
        initial_dependencies: Vec::new(),
        binding,
    }
}

/// Adds a quantity at `count` nodes: an array, or a scalar for each node. `row` makes a variable from its name, the words for its place, which
/// precede "from end A" in the description, and the index of its node for a scalar.
pub(super) fn at_nodes(
    variables: &mut Vec<Variable>,
    (layout, count): (Layout, usize),
    name: &str,
    row: impl Fn(String, String, Option<usize>) -> Variable,
) {
    match layout {
        Layout::Arrays => {
            let mut array = row(name.to_string(), "the nodes".into(), None);
            array.description += " to end B";
            array.dimension = Some(count);
            variables.push(array);
        }
        Layout::Scalars => variables.extend((0..count).map(|node| {
            let number = node + 1;
            row(format!("{name}[{number}]"), format!("node {number}"), Some(node))
        })),
    }
}

/// Range of nodes of a quantity: one node, or all of them.
pub(super) fn range(node: Option<usize>, count: usize) -> Range<usize> {
    node.map_or(0..count, |node| node..node + 1)
}

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Sentences on a velocity and on an angular velocity that the host does not give.
const NOT_GIVEN: [&str; 2] = [
    "if never set to a non-zero value, it is derived from the displacements, or 0 if solver.input_reconstruction is 1",
    "if no component is ever set to a non-zero value, they are derived from the displacements, or 0 if solver.input_reconstruction is 1",
];

/// Displacements of a body; a point has the first three.
pub(super) const POSES: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];
/// Velocities of a body.
const RATES: [&str; 6] = ["vx", "vy", "vz", "wx", "wy", "wz"];
/// Forces and moments on a body.
pub(super) const FORCES: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

/// Adds the variables of a coupled point or a vessel: displacement, velocity, and force and moment of the moorings.
pub(super) fn body(variables: &mut Vec<Variable>, body: Body, name: &str) {
    let is_point = matches!(body, Body::Point(_));
    let axes = if is_point { 0..3 } else { 0..6 };
    let mut add = |label: &str, meaning: String, causality, unit, binding| {
        variables.push(row(format!("{name}.{label}"), meaning, causality, unit, binding));
    };
    for axis in axes.clone() {
        let label = POSES[axis];
        let meaning = match axis {
            0..3 => format!("displacement of {name} from its reference position along global {label}"),
            _ => format!(
                "{label} of {name} from its reference attitude; body to global by yaw about z, pitch about y', roll about x''"
            ),
        };
        let unit = [Unit::METRE, Unit::RADIAN][axis / 3];
        let binding = Binding::Displacement { body, axis };
        add(label, meaning, Causality::Input, unit, binding);
    }
    for axis in axes.clone() {
        let along = AXES[axis % 3];
        let meaning = match axis {
            _ if is_point => format!("velocity of {name} along global {along}"),
            0..3 => component("velocity of", name, along),
            _ => component("angular velocity of", name, along),
        };
        let unit = [Unit::METRE_PER_SECOND, Unit::RADIAN_PER_SECOND][axis / 3];
        let binding = Binding::Velocity { body, axis };
        let meaning = format!("{meaning}; {}", NOT_GIVEN[axis / 3]);
        add(RATES[axis], meaning, Causality::Input, unit, binding);
    }
    for axis in axes {
        let along = AXES[axis % 3];
        let meaning = match axis {
            _ if is_point => format!(
                "force of all lines at {name}, and of its own mass and volume, on the body that drives it, along global {along}"
            ),
            0..3 => component("force of the mooring on", name, along),
            _ => component("moment about the origin of the mooring on", name, along),
        };
        let unit = [Unit::NEWTON, Unit::NEWTON_METRE][axis / 3];
        let binding = Binding::EndForce { body, axis };
        add(FORCES[axis], meaning, Causality::Output, unit, binding);
    }
}

pub(super) fn component(of: &str, name: &str, along: &str) -> String {
    format!("{of} {name}, component {along} in global axes")
}

/// Adds the inputs of a line that the scene declares: release and winch.
pub(super) fn controls(variables: &mut Vec<Variable>, index: usize, line: &scene::Line) {
    let name = &line.name;
    let mut add = |label: &str, meaning: String, unit, binding| {
        let (label, meaning) = (format!("{name}.{label}"), format!("{name}: {meaning}"));
        variables.push(row(label, meaning, Causality::Input, unit, binding));
    };
    if let Some(end) = line.release {
        let meaning = format!(
            "true releases end {} from its point permanently",
            end.word().to_uppercase()
        );
        add("release", meaning, Unit::ONE, Binding::Release { line: index });
    }
    if line.winch.is_some() {
        let meaning = "length paid out by the winch at end B, negative if hauled in".into();
        add(
            "length_change",
            meaning,
            Unit::METRE,
            Binding::LengthChange { line: index },
        );
    }
}
