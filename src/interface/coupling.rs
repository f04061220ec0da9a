//! Variables for hosts that solve for a body together with its mooring.

use super::rows::{FORCES, POSES, component, row};
use super::{Binding, Causality, InterfaceQuantity, Unit, Variable};
use crate::model::Body;
use crate::scene::{InterfaceOutput, Scene};
use crate::simulation::Simulation;

/// Adds the variables of a body that the scene requests.
pub(super) fn push(variables: &mut Vec<Variable>, scene: &Scene, body: Body, name: &str) {
    let interface = scene.output.interface;
    if interface.is_some() {
        push_matrix(variables, body, name, InterfaceQuantity::Mass);
    }
    if interface == Some(InterfaceOutput::Impedance) {
        for row in 0..body.axes() {
            push_free(variables, body, name, row);
        }
        push_matrix(variables, body, name, InterfaceQuantity::Damping);
        push_matrix(variables, body, name, InterfaceQuantity::Stiffness);
    }
    if scene.output.stiffness && matches!(body, Body::Vessel(_)) {
        push_matrix(variables, body, name, InterfaceQuantity::StaticStiffness);
    }
}

fn push_free(variables: &mut Vec<Variable>, body: Body, name: &str, axis: usize) {
    let (of, unit) = match axis {
        0..3 => ("force", Unit::NEWTON),
        _ => ("moment", Unit::NEWTON_METRE),
    };
    let of = format!(
        "{of} of the mooring without inertia at the end of the coming step, for zero displacement and velocity, on"
    );
    let meaning = component(&of, name, POSES[axis % 3]);
    let binding = Binding::Interface {
        body,
        quantity: InterfaceQuantity::Free,
        row: axis,
        column: 0,
    };
    let label = format!("{name}.free_{}", FORCES[axis]);
    variables.push(row(label, meaning, Causality::Output, unit, binding));
}

fn push_matrix(variables: &mut Vec<Variable>, body: Body, name: &str, quantity: InterfaceQuantity) {
    let (label, [what, motion], units) = match quantity {
        InterfaceQuantity::Mass => (
            "mass",
            ["mass of the line ends", "acceleration"],
            [Unit::KILOGRAM, Unit::KILOGRAM_METRE, Unit::KILOGRAM_SQUARE_METRE],
        ),
        InterfaceQuantity::Damping => (
            "damping",
            ["damping over the coming step", "velocity at its end"],
            [
                Unit::NEWTON_SECOND_PER_METRE,
                Unit::NEWTON_SECOND,
                Unit::NEWTON_METRE_SECOND,
            ],
        ),
        InterfaceQuantity::Stiffness => (
            "stiffness",
            ["stiffness over the coming step", "displacement at its end"],
            [Unit::NEWTON_PER_METRE, Unit::NEWTON, Unit::NEWTON_METRE],
        ),
        _ => (
            "static_stiffness",
            ["quasi-static stiffness", "displacement"],
            [Unit::NEWTON_PER_METRE, Unit::NEWTON, Unit::NEWTON_METRE],
        ),
    };
    for i in 0..body.axes() {
        for j in 0..body.axes() {
            let between = if i < 3 && j < 3 { "" } else { "_" };
            let meaning = format!("{what} on {name}: -{} per {motion} in {}", FORCES[i], POSES[j]);
            let binding = Binding::Interface {
                body,
                quantity,
                row: i,
                column: j,
            };
            let label = format!("{name}.{label}_{}{between}{}", POSES[i], POSES[j]);
            let unit = units[i / 3 + j / 3];
            variables.push(row(label, meaning, Causality::Output, unit, binding));
        }
    }
}

/// Value of a quantity; `None` if there is none.
pub(super) fn read(
    simulation: &Simulation,
    body: Body,
    quantity: InterfaceQuantity,
    at: [usize; 2],
) -> Option<f64> {
    let [row, column] = at;
    Some(match (quantity, body) {
        (InterfaceQuantity::Mass, _) => simulation.end_mass(body)[(row, column)],
        (InterfaceQuantity::Free, _) => simulation.impedance(body)?.free[row],
        (InterfaceQuantity::Damping, _) => simulation.impedance(body)?.damping[(row, column)],
        (InterfaceQuantity::Stiffness, _) => simulation.impedance(body)?.stiffness[(row, column)],
        (InterfaceQuantity::StaticStiffness, Body::Vessel(vessel)) => {
            simulation.static_stiffness(vessel)?[row][column]
        }
        (InterfaceQuantity::StaticStiffness, Body::Point(_)) => return None,
    })
}

/// Reason why a quantity has no value.
pub(super) fn missing(name: &str, quantity: InterfaceQuantity) -> String {
    match quantity {
        InterfaceQuantity::StaticStiffness => {
            format!(
                "{name}: the stiffness is undefined if the equilibrium is unstable, or if a line is a beam or released"
            )
        }
        _ => format!("{name}: a step of the last length fails from the present state"),
    }
}
