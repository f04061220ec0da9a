//! The rows of the table, one function for each part of a scene.

use super::{Binding, Causality, Kind, LineResult, SolverResult, Unit, Variability, Variable};
use crate::model::Body;
use crate::scene;
use crate::scene::channel::LineEnd;

pub(super) fn row(
    name: String,
    description: String,
    causality: Causality,
    unit: Unit,
    binding: Binding,
) -> Variable {
    Variable {
        name,
        description,
        causality,
        variability: match causality {
            Causality::Input | Causality::Output => Variability::Continuous,
            Causality::Parameter | Causality::CalculatedParameter => Variability::Fixed,
        },
        kind: Kind::Float64,
        unit,
        dimension: None,
        start: (causality == Causality::Input).then_some(0.0),
        initial_dependencies: Vec::new(),
        binding,
    }
}

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// What a velocity is that no host tells.
const UNTOLD: &str = "if never set but to 0, derived from displacements that change, or 0 where solver.input_reconstruction is 1";

pub(super) fn point(variables: &mut Vec<Variable>, point: usize, name: &str) {
    let body = Body::Point(point);
    for (axis, label) in AXES.iter().enumerate() {
        variables.push(row(
            format!("{name}.{label}"),
            format!("displacement of {name} from its reference position along global {label}"),
            Causality::Input,
            Unit::METRE,
            Binding::Displacement { body, axis },
        ));
    }
    for (axis, label) in AXES.iter().enumerate() {
        variables.push(row(
            format!("{name}.v{label}"),
            format!("velocity of {name} along global {label}; {UNTOLD}"),
            Causality::Input,
            Unit::METRE_PER_SECOND,
            Binding::Velocity { body, axis },
        ));
    }
    for (axis, label) in AXES.iter().enumerate() {
        variables.push(row(
            format!("{name}.f{label}"),
            format!(
                "force of all lines at {name}, and of its own mass and volume, on what carries it, along global {label}"
            ),
            Causality::Output,
            Unit::NEWTON,
            Binding::EndForce { body, axis },
        ));
    }
}

/// Rows of a vessel: its pose, its velocities, and what its moorings do to it.
pub(super) fn vessel(variables: &mut Vec<Variable>, vessel: usize, name: &str) {
    let body = Body::Vessel(vessel);
    for (axis, label) in ["x", "y", "z", "roll", "pitch", "yaw"].iter().enumerate() {
        let (meaning, unit) = match axis {
            0..3 => (
                format!("displacement of {name} from its reference position along global {label}"),
                Unit::METRE,
            ),
            _ => (
                format!(
                    "{label} of {name} from its reference attitude; body to global by yaw about z, pitch about y', roll about x''"
                ),
                Unit::RADIAN,
            ),
        };
        let binding = Binding::Displacement { body, axis };
        let name = format!("{name}.{label}");
        variables.push(row(name, meaning, Causality::Input, unit, binding));
    }
    for (axis, label) in ["vx", "vy", "vz", "wx", "wy", "wz"].iter().enumerate() {
        let (what, unit) = match axis {
            0..3 => ("velocity", Unit::METRE_PER_SECOND),
            _ => ("angular velocity", Unit::RADIAN_PER_SECOND),
        };
        let along = AXES[axis % 3];
        let meaning = format!("{what} of {name}, component {along} in global axes; {UNTOLD}");
        let binding = Binding::Velocity { body, axis };
        let name = format!("{name}.{label}");
        variables.push(row(name, meaning, Causality::Input, unit, binding));
    }
    for (axis, label) in ["fx", "fy", "fz", "mx", "my", "mz"].iter().enumerate() {
        let (what, unit) = match axis {
            0..3 => ("force", Unit::NEWTON),
            _ => ("moment about the origin", Unit::NEWTON_METRE),
        };
        let along = AXES[axis % 3];
        let meaning = format!("{what} of the mooring on {name}, component {along} in global axes");
        let binding = Binding::EndForce { body, axis };
        let name = format!("{name}.{label}");
        variables.push(row(name, meaning, Causality::Output, unit, binding));
    }
}

/// Inputs of lines that their scene declares.
pub(super) fn controls(variables: &mut Vec<Variable>, index: usize, line: &scene::Line) {
    if let Some(end) = line.release {
        let end = match end {
            LineEnd::A => "A",
            LineEnd::B => "B",
        };
        let name = &line.name;
        let mut variable = row(
            format!("{name}.release"),
            format!("{name}: true lets end {end} go of its point, for good"),
            Causality::Input,
            Unit::ONE,
            Binding::Release { line: index },
        );
        (variable.kind, variable.variability) = (Kind::Boolean, Variability::Discrete);
        variable.start = Some(0.0);
        variables.push(variable);
    }
}

/// What the host says to the winch of a line.
pub(super) fn winch(variables: &mut Vec<Variable>, index: usize, line: &scene::Line) {
    if line.winch.is_some() {
        let name = &line.name;
        variables.push(row(
            format!("{name}.length_change"),
            format!("{name}: length that the winch at end B has paid out, negative where it has hauled in"),
            Causality::Input,
            Unit::METRE,
            Binding::LengthChange { line: index },
        ));
    }
}

pub(super) fn line(variables: &mut Vec<Variable>, line: usize, name: &str) {
    let results = [
        (
            "tension_b",
            "size of the line's force at end B, with weight, drag and inertia of the last half segment",
            LineResult::TensionB,
        ),
        (
            "tension_a",
            "size of the line's force at end A, with weight, drag and inertia of the last half segment",
            LineResult::TensionA,
        ),
        (
            "tension_max",
            "greatest of the axial tension along the line and the forces at its ends",
            LineResult::TensionMax,
        ),
        (
            "laid_length",
            "unstretched length that lies on the seabed",
            LineResult::LaidLength,
        ),
        (
            "sag",
            "greatest vertical distance below the chord between the ends",
            LineResult::Sag,
        ),
    ];
    for (label, meaning, result) in results {
        let unit = match result {
            LineResult::LaidLength | LineResult::Sag => Unit::METRE,
            _ => Unit::NEWTON,
        };
        variables.push(row(
            format!("{name}.{label}"),
            format!("{name}: {meaning}"),
            Causality::Output,
            unit,
            Binding::Line { line, result },
        ));
    }
}

pub(super) fn bending(variables: &mut Vec<Variable>, line: usize, name: &str) {
    let results = [
        (
            "curvature_max",
            "greatest curvature along the line",
            Unit::PER_METRE,
            LineResult::CurvatureMax,
        ),
        (
            "moment_max",
            "greatest bending moment along the line",
            Unit::NEWTON_METRE,
            LineResult::MomentMax,
        ),
        (
            "moment_a",
            "bending moment at end A",
            Unit::NEWTON_METRE,
            LineResult::MomentA,
        ),
        (
            "moment_b",
            "bending moment at end B",
            Unit::NEWTON_METRE,
            LineResult::MomentB,
        ),
    ];
    for (label, meaning, unit, result) in results {
        variables.push(row(
            format!("{name}.{label}"),
            format!("{name}: {meaning}"),
            Causality::Output,
            unit,
            Binding::Line { line, result },
        ));
    }
}

pub(super) fn catenary(variables: &mut Vec<Variable>, line: usize, name: &str) {
    let results = [
        ("catenary_sag", "sag", Unit::METRE, LineResult::CatenarySag),
        (
            "catenary_horizontal",
            "horizontal tension",
            Unit::NEWTON,
            LineResult::CatenaryHorizontal,
        ),
        (
            "catenary_tension_b",
            "tension at end B",
            Unit::NEWTON,
            LineResult::CatenaryTensionB,
        ),
    ];
    for (label, meaning, unit, result) in results {
        variables.push(row(
            format!("{name}.{label}"),
            format!("{name}: {meaning} of the closed-form elastic catenary in the reference configuration"),
            Causality::CalculatedParameter,
            unit,
            Binding::Line { line, result },
        ));
    }
}

pub(super) fn solver(variables: &mut Vec<Variable>) {
    let mut substeps = row(
        "solver.substeps".into(),
        "internal steps of the last communication step".into(),
        Causality::Output,
        Unit::ONE,
        Binding::Solver(SolverResult::Substeps),
    );
    substeps.kind = Kind::Int32;
    substeps.variability = Variability::Discrete;
    variables.push(substeps);
    variables.push(row(
        "solver.input_error".into(),
        "estimated error of tension, over its variation, from extrapolating the displacements between communication points".into(),
        Causality::Output,
        Unit::ONE,
        Binding::Solver(SolverResult::InputError),
    ));
}

pub(super) fn energy_balance(variables: &mut Vec<Variable>) {
    let results = [
        (
            "solver.energy_error",
            "energy that the time integration has produced (positive) or lost since the start",
            Unit::JOULE,
            SolverResult::EnergyError,
        ),
        (
            "solver.power_residual",
            "energy error over the time since the start",
            Unit::WATT,
            SolverResult::PowerResidual,
        ),
    ];
    for (name, meaning, unit, result) in results {
        variables.push(row(
            name.into(),
            meaning.into(),
            Causality::Output,
            unit,
            Binding::Solver(result),
        ));
    }
}
