//! Reads a simulation into plain numbers for the writers.

use nalgebra::Vector3;

use super::json;
use super::record::{Catenary, Column, Flight, Frame, LineRecord, Node, Record, StaticLine, Surroundings};
use crate::model::{End, Line, Role};
use crate::scene::Scene;
use crate::scene::table::Choice;
use crate::simulation::{NodeBending, Simulation};

/// Number of points of a catenary's drawn shape [-].
const CATENARY_POINTS: usize = 201;

/// Returns the record of a simulation: lines, points and surroundings, with columns for a planned number of rows and no rows yet. `still` is the
/// simulation in static equilibrium, if there is one: see [`Simulation::in_equilibrium`].
pub fn record(
    scene: &Scene,
    simulation: &Simulation,
    still: Option<&Simulation>,
    (columns, planned): (Vec<Column>, usize),
) -> Record {
    let model = simulation.model();
    let mut record = Record::new(&scene.title, columns, planned);
    record.lines = (0..model.lines.len())
        .map(|line| line_record(simulation, still, line))
        .collect();
    let coupled = |point: &&crate::model::Point| matches!(point.role, Role::Coupled { .. });
    record.points = model
        .points
        .iter()
        .filter(coupled)
        .map(|point| point.name.clone())
        .collect();
    record.surroundings = Surroundings {
        water: scene.water.is_some(),
        seabed: model.seabed_level.filter(|_| model.seabed_is_level()),
    };
    record
}

fn line_record(simulation: &Simulation, still: Option<&Simulation>, line: usize) -> LineRecord {
    LineRecord {
        name: simulation.model().lines[line].name.clone(),
        equilibrium: still.map(|still| line_at_rest(still, line)),
        catenary: simulation.catenary(line).map(|catenary| Catenary {
            figures: StaticLine {
                tension_b: catenary.tension_b(),
                horizontal: catenary.horizontal(),
                sag: catenary.sag(),
                laid_length: catenary.laid_length(),
                bending: None,
            },
            profile: catenary_profile(simulation, line),
        }),
    }
}

fn line_at_rest(simulation: &Simulation, line: usize) -> StaticLine {
    let [x, y, _] = simulation.line_end_force(line, End::B).into();
    StaticLine {
        tension_b: simulation.tension_b(line),
        horizontal: x.hypot(y),
        sag: simulation.sag(line),
        laid_length: simulation.laid_length(line),
        bending: greatest_bending(simulation, line),
    }
}

/// Greatest curvature and moment of a line, if it has bending stiffness.
fn greatest_bending(simulation: &Simulation, line: usize) -> Option<NodeBending> {
    let nodes = simulation.bending(line)?;
    let greatest = |value: fn(&NodeBending) -> f64| nodes.iter().map(value).fold(0.0, f64::max);
    Some(NodeBending {
        curvature: greatest(|node| node.curvature),
        moment: greatest(|node| node.moment),
    })
}

/// Shape of the closed form between the line's reference ends, in global axes [m].
fn catenary_profile(simulation: &Simulation, line: usize) -> Vec<[f64; 3]> {
    let model = simulation.model();
    let Some(catenary) = simulation.catenary(line) else {
        return Vec::new();
    };
    let [a, b] = model.lines[line].ends.map(|end| model.points[end].reference);
    let chord = Vector3::new(b.x - a.x, b.y - a.y, 0.0);
    let direction = chord.try_normalize(0.0).unwrap_or(Vector3::x());
    let length = model.lines[line].unstretched_length();
    (0..CATENARY_POINTS)
        .map(|i| {
            let s = length * i as f64 / (CATENARY_POINTS - 1) as f64;
            let point = catenary.at(s);
            (a + direction * point.x + Vector3::z() * point.z).into()
        })
        .collect()
}

/// Present shapes of all lines, at `time` [s].
pub fn frame(simulation: &Simulation, time: f64) -> Frame {
    let nodes = |line| {
        let nodes = simulation.profile(line).into_iter().map(|node| Node {
            s: node.s,
            position: [node.x, node.y, node.z],
            tension: node.tension,
            bending: node.bending,
        });
        nodes.collect()
    };
    Frame {
        time,
        lines: (0..simulation.model().lines.len()).map(nodes).collect(),
    }
}

/// Energy and momenta of beams in free flight at the present time, `time` [s]; `None` if any line has a support or is not a beam.
pub fn flight(simulation: &Simulation, time: f64) -> Option<Flight> {
    let model = simulation.model();
    let free = |line: &Line| {
        let mut ends = line.ends.iter();
        line.beam.is_some() && ends.all(|&point| model.points[point].free().is_some())
    };
    if !model.lines.iter().all(free) {
        return None;
    }
    let energy = simulation.energy();
    Some(Flight {
        time,
        kinetic: energy.kinetic,
        strain: energy.axial + energy.bending + energy.shear + energy.torsion,
        gravitational: energy.gravitational,
        angular_momentum: simulation.momentum().angular.into(),
    })
}

/// Static equilibrium of a simulation.
pub fn statics(scene: &Scene, simulation: Simulation) -> json::Statics {
    json::Statics {
        title: scene.title.clone(),
        lines: (0..simulation.model().lines.len())
            .map(|line| static_line(&simulation, line))
            .collect(),
        points: (0..simulation.model().points.len())
            .map(|point| json::Point {
                name: scene.points[point].name.clone(),
                kind: scene.points[point].kind.word(),
                position: simulation.state().points[point].position.into(),
                force: simulation.end_force(point),
            })
            .collect(),
        vessels: static_vessels(simulation),
    }
}

fn static_vessels(simulation: Simulation) -> Vec<json::Vessel> {
    let holds = |simulation: &Simulation| {
        let stiffnesses = simulation.vessel_stiffnesses().into_iter().enumerate();
        let hold = |(vessel, stiffness)| json::Hold {
            force: simulation.vessel_force(vessel),
            stiffness,
        };
        stiffnesses.map(hold).collect::<Vec<_>>()
    };
    let vessels = simulation.model().vessels.iter();
    let names: Vec<String> = vessels.map(|vessel| vessel.name.clone()).collect();
    if names.is_empty() {
        return Vec::new();
    }
    let elements = holds(&simulation);
    let hung = holds(&simulation.on_catenaries());
    let vessels = names.into_iter().zip(hung).zip(elements);
    let vessel = |((name, hold), elements)| json::Vessel { name, hold, elements };
    vessels.map(vessel).collect()
}

fn static_line(simulation: &Simulation, line: usize) -> json::Line {
    let [x, y, z] = simulation.line_end_force(line, End::B).into();
    json::Line {
        name: simulation.model().lines[line].name.clone(),
        end_a: json::End {
            force: simulation.line_end_force(line, End::A).into(),
            tension: simulation.tension_a(line),
        },
        end_b: json::End {
            force: [x, y, z],
            tension: simulation.tension_b(line),
        },
        horizontal: x.hypot(y),
        vertical: -z,
        laid_length: simulation.laid_length(line),
        stretched_length: simulation.stretched_length(line),
        sag: simulation.sag(line),
        catenary: simulation.catenary(line).map(|closed| json::Catenary {
            tension_a: closed.tension_a(),
            tension_b: closed.tension_b(),
            horizontal: closed.horizontal(),
            vertical: closed.vertical_b(),
            laid_length: closed.laid_length() + 0.0, // an empty sum is −0
            sag: closed.sag(),
        }),
        profile: simulation.profile(line),
    }
}
