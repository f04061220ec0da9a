//! `SystemStructure.ssd`: the mooring as a component, with connectors for a body.
//!
//! Source: System Structure and Parameterization 1.0, schema `SystemStructureDescription.xsd`. The body is not in the package: its motion is an input
//! and the force on it an output of the system, to which a host or an enclosing system connects the body.

use std::io;

use crate::interface::{Causality, Interface, Kind, Variable};
use crate::output::description;
use crate::output::xml::{Xml, document, empty, number, texts, within};
use crate::scene::Scene;

/// Path in the package.
pub(super) const FILE: &str = "SystemStructure.ssd";

/// Name of the component.
const COMPONENT: &str = "mooring";

/// Text of the file. `fmu` is the path of the FMU in the package, `name` that of the model.
pub(super) fn text(scene: &Scene, interface: &Interface, name: &str, fmu: &str) -> String {
    let connected: Vec<&Variable> = interface
        .variables()
        .iter()
        .filter(|variable| matches!(variable.causality, Causality::Input | Causality::Output))
        .filter(|variable| variable.dimension.is_none())
        .collect();
    let tool = format!("moorline {}", env!("CARGO_PKG_VERSION"));
    let root = [
        (
            "xmlns:ssd",
            "http://ssp-standard.org/SSP1/SystemStructureDescription",
        ),
        ("xmlns:ssc", "http://ssp-standard.org/SSP1/SystemStructureCommon"),
        ("version", "1.0"),
        ("name", name),
        ("generationTool", &tool),
    ];
    let component = [
        ("name", COMPONENT),
        ("type", "application/x-fmu-sharedlibrary"),
        ("source", fmu),
    ];
    let end = number(scene.output.duration);
    document(|xml| {
        within(xml, "ssd:SystemStructureDescription", &root, |xml| {
            within(xml, "ssd:System", &[("name", "moored")], |xml| {
                connectors(xml, &connected)?;
                within(xml, "ssd:Elements", &[], |xml| {
                    within(xml, "ssd:Component", &component, |xml| {
                        connectors(xml, &connected)
                    })
                })?;
                within(xml, "ssd:Connections", &[], |xml| {
                    connected
                        .iter()
                        .try_for_each(|variable| connection(xml, variable))
                })
            })?;
            within(xml, "ssd:Units", &[], |xml| units(xml, &connected))?;
            empty(
                xml,
                "ssd:DefaultExperiment",
                &[("startTime", "0.0"), ("stopTime", &end)],
            )
        })
    })
}

fn connectors(xml: &mut Xml, variables: &[&Variable]) -> io::Result<()> {
    within(xml, "ssd:Connectors", &[], |xml| {
        variables.iter().try_for_each(|variable| {
            let kind = match variable.causality {
                Causality::Input => "input",
                _ => "output",
            };
            let attributes = [("name", variable.name.as_str()), ("kind", kind)];
            within(xml, "ssd:Connector", &attributes, |xml| match variable.kind {
                Kind::Float64 => empty(xml, "ssc:Real", &[("unit", variable.unit.name)]),
                Kind::Int32 => empty(xml, "ssc:Integer", &[]),
                Kind::Boolean => empty(xml, "ssc:Boolean", &[]),
            })
        })
    })
}

/// Connection of a variable of the component to the system's connector of the same name.
fn connection(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let name = variable.name.as_str();
    let component = match variable.causality {
        Causality::Input => "endElement",
        _ => "startElement",
    };
    let attributes = [
        (component, COMPONENT),
        ("startConnector", name),
        ("endConnector", name),
    ];
    empty(xml, "ssd:Connection", &attributes)
}

fn units(xml: &mut Xml, variables: &[&Variable]) -> io::Result<()> {
    let units = description::units(variables.iter().copied());
    units.iter().try_for_each(|unit| {
        within(xml, "ssc:Unit", &[("name", unit.name)], |xml| {
            empty(xml, "ssc:BaseUnit", &texts(&unit.exponents()))
        })
    })
}
