//! `documentation/index.html`: figure of the scene in equilibrium, table of variables, and description of the model.

use quick_xml::escape::escape;

use crate::interface::{Causality, Interface, Variable};
use crate::output::report::{self, STYLE};
use crate::output::xml::number;
use crate::output::{collect, figures};
use crate::scene::Scene;
use crate::simulation::Simulation;

/// Path in an FMU.
pub(super) const FILE: &str = "documentation/index.html";
/// Path of the licences in an FMU.
pub(super) const LICENSE_FILE: &str = "documentation/licenses/license.txt";

/// Licences of the library in the FMU. The scene and everything made from it belong to their author.
pub(super) fn license() -> String {
    format!(
        "The library in this FMU is moorline, licensed under the MIT License or the Apache License 2.0, at your choice.\n\
         The scene in this FMU belongs to its author.\n\n{}\n\n{}",
        include_str!("../../../LICENSE-MIT"),
        include_str!("../../../LICENSE-APACHE")
    )
}

/// Page of an FMU. `title` is the name of its model.
pub(super) fn html(title: &str, scene: &Scene, simulation: &Simulation, interface: &Interface) -> String {
    let mut record = collect::record(scene, simulation, Some(simulation), (Vec::new(), 0));
    record.course.frames.push(collect::frame(simulation, 0.0));
    let figures = [figures::profile(&record), figures::plan(&record)];
    let figures = report::shown(figures.iter().flatten());
    let title = escape(title);
    let tables: String = [
        ("Inputs", Causality::Input),
        ("Outputs", Causality::Output),
        ("Calculated parameters", Causality::CalculatedParameter),
        ("Parameters", Causality::Parameter),
    ]
    .into_iter()
    .map(|(heading, causality)| table(heading, interface.variables(), causality))
    .collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
         <style>{STYLE}td {{ text-align: left; vertical-align: top; }}</style>\n</head>\n<body>\n<h1>{title}</h1>\n\
         <p>Mooring lines for co-simulation: displacements of the fairleads in, forces of the mooring out. SI units, global axes, \
         z up, z = 0 at still water. <a href=\"licenses/license.txt\">Licences</a></p>\n\
         <h2>Static equilibrium</h2>\n{figures}{tables}<h2>What is modelled</h2>\n<pre>{}</pre>\n\
         <p>moorline {}</p>\n</body>\n</html>\n",
        escape(scene.in_words().trim_end()),
        env!("CARGO_PKG_VERSION"),
    )
}

/// Table of the variables of one role with a heading; empty if there are none.
fn table(heading: &str, variables: &[Variable], causality: Causality) -> String {
    let variables = variables
        .iter()
        .filter(|variable| variable.causality == causality);
    let rows = variables.map(|variable| {
        let name = match variable.dimension {
            Some(length) => format!("{}[{length}]", variable.name),
            None => variable.name.clone(),
        };
        let start = variable.start.map_or_else(String::new, number);
        vec![
            name,
            variable.unit.name.to_string(),
            start,
            variable.description.clone(),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return String::new();
    }
    let table = report::table("", &["name", "unit", "start", "meaning"], &rows);
    format!("<h2>{heading}</h2>\n{table}")
}
