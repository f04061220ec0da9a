//! `OspModelDescription.xml`: motion and force as the variable groups of the Open Simulation Platform.
//!
//! Source: OSP Interface Specification 1.0, schema `OspModelDescription-1.0.0.xsd`: groups by kind in a fixed order, each of three variables along x,
//! y and z with unique names. Force and velocity of a point form a `LinearMechanicalPort`, moment and angular velocity of a vessel an
//! `AngularMechanicalPort`; displacements form separate groups, since a variable may be in one port only.

use std::io;

use super::ports::Port;
use crate::interface::Variable;
use crate::output::xml::{Xml, document, empty, within};

/// Path in an FMU.
pub(super) const FILE: &str = "extra/com.open-simulation-platform/OspModelDescription.xml";

const NAMESPACE: &str = "https://open-simulation-platform.com/OspModelDescription/1.0.0";

/// Kind of a port: its name, its first axis, and the groups in it.
struct Kind {
    port: &'static str,
    first: usize,
    effort: [&'static str; 2],
    flow: [&'static str; 2],
}

const LINEAR: Kind = Kind {
    port: "LinearMechanicalPort",
    first: 0,
    effort: ["Force", "force"],
    flow: ["LinearVelocity", "velocity"],
};
const ANGULAR: Kind = Kind {
    port: "AngularMechanicalPort",
    first: 3,
    effort: ["Torque", "moment"],
    flow: ["AngularVelocity", "angular_velocity"],
};

/// Text of the file.
pub(super) fn text(ports: &[Port<'_>]) -> String {
    let turning = || ports.iter().filter(|port| port.turns());
    document(|xml| {
        let root = [("xmlns", NAMESPACE), ("version", "1.0")];
        within(xml, "OspModelDescription", &root, |xml| {
            within(xml, "VariableGroups", &[], |xml| {
                for port in ports {
                    let name = format!("{}.displacement", port.name);
                    group(xml, "LinearDisplacement", &name, &port.displacements[..3])?;
                }
                for port in turning() {
                    let name = format!("{}.rotation", port.name);
                    group(xml, "AngularDisplacement", &name, &port.displacements[3..])?;
                }
                ports.iter().try_for_each(|port| write_port(xml, port, &LINEAR))?;
                turning().try_for_each(|port| write_port(xml, port, &ANGULAR))
            })
        })
    })
}

fn write_port(xml: &mut Xml, port: &Port<'_>, kind: &Kind) -> io::Result<()> {
    let named = |last: &str| format!("{}.{last}", port.name);
    let axes = kind.first..kind.first + 3;
    let name = named(if kind.first == 0 { "linear" } else { "angular" });
    within(xml, kind.port, &[("name", &name)], |xml| {
        let [element, last] = kind.effort;
        group(xml, element, &named(last), &port.forces[axes.clone()])?;
        let [element, last] = kind.flow;
        group(xml, element, &named(last), &port.velocities[axes])
    })
}

fn group(xml: &mut Xml, element: &str, name: &str, variables: &[&Variable]) -> io::Result<()> {
    within(xml, element, &[("name", name)], |xml| {
        variables
            .iter()
            .try_for_each(|variable| empty(xml, "Variable", &[("ref", &variable.name)]))
    })
}
