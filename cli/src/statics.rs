//! `moorline statics`: the static equilibrium as a table or as JSON.

use std::fmt::Write;

use moorline::output::{collect, json};
use moorline::scene::{InitialShape, Integrator, Note};
use moorline::simulation::Watch;

use crate::arguments::Input;
use crate::failure::Failure;
use crate::summary::{Table, static_table};
use crate::terminal::{at_rest, print, read_scene, remark_all};

/// Solves the equilibrium and prints it.
pub(crate) fn statics(input: &Input, as_json: bool) -> Result<(), Failure> {
    let mut loaded = read_scene(&input.scene, &input.host.supplement())?;
    if let Some(water) = &mut loaded.scene.water {
        water.waves = None; // the equilibrium is that in still water
    }
    let simulation = at_rest(&mut loaded)?;
    remark_all(&loaded, Watch::new(&loaded.scene, &simulation).look(&simulation));
    for (index, line) in loaded.scene.lines.iter().enumerate() {
        if line.initial != InitialShape::Static && loaded.scene.solver.integrator != Integrator::QuasiStatic {
            let at = format!("lines[{index}].initial");
            let text = "runs start on this shape, not in the equilibrium that is shown";
            remark_all(&loaded, vec![Note::new(at, text)]);
        }
        let path = line.winch.as_ref().and_then(|winch| winch.path.as_ref());
        if path.is_some_and(|path| path.at(0.0) != 0.0) {
            let at = format!("lines[{index}].winch.path");
            let text = "runs start with the length that the path gives; the equilibrium shown has the length of the scene";
            remark_all(&loaded, vec![Note::new(at, text)]);
        }
    }
    let record = collect::record(&loaded.scene, &simulation, Some(&simulation), (Vec::new(), 0));
    let statics = collect::statics(&loaded.scene, simulation);
    let seabed = loaded.scene.seabed.as_ref();
    let has_friction = seabed.is_some_and(|seabed| seabed.friction.transverse > 0.0);
    if has_friction && !statics.vessels.is_empty() && statics.lines.iter().any(|line| line.laid_length > 0.0)
    {
        let text = "the stiffness shown takes every line as freshly laid; in small motions friction holds the part on the seabed, \
                    as in the stiffness from the elements: `elements` in --json";
        remark_all(&loaded, vec![Note::new("seabed.friction", text)]);
    }
    if as_json {
        return print(&json::text(&statics));
    }
    let mut points = Table::new(&["force of the mooring [N]", "x", "y", "z"]);
    for point in &statics.points {
        points.row(&point.name, &point.force);
    }
    let vessels: String = statics.vessels.iter().map(vessel_tables).collect();
    let mut text = String::new();
    if !statics.title.is_empty() {
        writeln!(text, "{}\n", statics.title).expect("a string takes any text");
    }
    print(&format!("{text}{}\n{points}{vessels}", static_table(&record)))
}

/// Force and stiffness of the mooring on a vessel.
fn vessel_tables(vessel: &json::Vessel) -> String {
    let name = &vessel.name;
    let head = format!("{name}: force [N] and moment [N m] of the lines");
    let mut force = Table::new(&[&head, "x", "y", "z", "roll", "pitch", "yaw"]);
    force.row("closed form where there is one", &vessel.hold.force);
    force.row("elements", &vessel.elements.force);
    let Some(stiffness) = &vessel.hold.stiffness else {
        return format!("\n{force}\n{name}: no stiffness, for a beam holds it or nothing holds the lines\n");
    };
    let head = format!("{name}: stiffness [N/m, N/rad, N, N m/rad]");
    let mut table = Table::new(&[&head, "x", "y", "z", "roll", "pitch", "yaw"]);
    for (row, name) in stiffness.iter().zip(["x", "y", "z", "roll", "pitch", "yaw"]) {
        table.row(name, row);
    }
    format!("\n{force}\n{table}")
}
