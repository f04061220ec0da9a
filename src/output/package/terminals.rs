//! `terminalsAndIcons.xml`: motion and force of each coupled point and vessel as one terminal.
//!
//! Source: FMI 3.0.2 section 2.4.9, and its schema `fmi3TerminalsAndIcons.xsd`. FMUs of FMI 2.0 contain the same file of FMI 3.0.

use super::ports::Port;
use crate::output::xml::{self, document, empty, within};

/// Path in an FMU.
pub(super) const FILE: &str = "terminalsAndIcons/terminalsAndIcons.xml";

/// Half the side of the square that the icon fills [-].
const HALF_SIDE: f64 = 100.0;
/// Size of a unit of the coordinates [mm].
const SCALE: f64 = 0.1;

/// Text of the file.
pub(super) fn text(ports: &[Port<'_>]) -> String {
    let [low, high, scale] = [-HALF_SIDE, HALF_SIDE, SCALE].map(xml::number);
    let corners = [
        ("x1", low.as_str()),
        ("y1", low.as_str()),
        ("x2", high.as_str()),
        ("y2", high.as_str()),
    ];
    let scaled = [&corners[..], &[("suggestedScalingFactorTo_mm", scale.as_str())]].concat();
    document(|xml| {
        within(xml, "fmiTerminalsAndIcons", &[("fmiVersion", "3.0")], |xml| {
            within(xml, "GraphicalRepresentation", &[], |xml| {
                empty(xml, "CoordinateSystem", &scaled)?;
                empty(xml, "Icon", &corners)
            })?;
            if ports.is_empty() {
                return Ok(());
            }
            within(xml, "Terminals", &[], |xml| {
                ports.iter().try_for_each(|port| terminal(xml, port))
            })
        })
    })
}

fn terminal(xml: &mut xml::Xml, port: &Port<'_>) -> std::io::Result<()> {
    let (kind, what) = match port.turns() {
        true => (
            "moorline.vessel",
            "motion of the vessel, and force and moment of the mooring on it",
        ),
        false => (
            "moorline.point",
            "motion of the coupled point, and force of the mooring on it",
        ),
    };
    let attributes = [
        ("name", port.name),
        ("matchingRule", "plug"),
        ("terminalKind", kind),
        ("description", what),
    ];
    within(xml, "Terminal", &attributes, |xml| {
        port.variables().try_for_each(|variable| {
            let member = [
                ("variableName", variable.name.as_str()),
                ("memberName", port.member(variable)),
                ("variableKind", "signal"),
            ];
            empty(xml, "TerminalMemberVariable", &member)
        })
    })
}
