//! Output channels by MoorDyn's names, as columns next to moorline's.
//!
//! Tensions are those of segments, as in MoorDyn-C: of the last one at an end, the mean of the two adjacent ones at an inner node. Positions
//! are global, and forces at a point are those of the lines on it.
//!
//! Source: MoorDyn-C, `Line.hpp`, `getNodeTen`.

use super::record::{Column, Form};
use crate::model::Model;
use crate::scene::channel::{Channel, LineEnd, NodePlace, Quantity, check_node};
use crate::scene::{Scene, SceneError};
use crate::simulation::Simulation;

/// Channels that a scene requests.
#[derive(Debug, Clone)]
pub struct Channels {
    list: Vec<(Column, Source)>,
}

/// Source of a channel's value, by the order of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Source {
    Node {
        line: usize,
        node: usize,
        quantity: Quantity,
    },
    Point {
        point: usize,
        quantity: Quantity,
    },
}

impl Channels {
    /// Finds the sources of a scene's channels in its model.
    ///
    /// # Errors
    /// The first channel whose name is unknown or refers to something that the model does not have.
    pub fn new(scene: &Scene, model: &Model) -> Result<Channels, SceneError> {
        let found = scene.output.channels.iter().enumerate().map(|(index, name)| {
            let source = Channel::parse(name).and_then(|channel| source(&channel, model));
            let source =
                source.map_err(|problem| SceneError::new(format!("output.channels[{index}]"), problem))?;
            Ok((column(name, source, model), source))
        });
        Ok(Channels {
            list: found.collect::<Result<_, _>>()?,
        })
    }

    /// A column for every channel.
    pub fn columns(&self) -> impl Iterator<Item = Column> {
        self.list.iter().map(|(column, _)| column.clone())
    }

    /// Present values of the channels, each in its column's unit.
    pub fn values(&self, simulation: &Simulation) -> impl Iterator<Item = f64> {
        let sources = self.list.iter();
        sources.map(|(_, source)| value(*source, simulation))
    }
}

fn source(channel: &Channel, model: &Model) -> Result<Source, String> {
    let of_node = |name: &str, place: NodePlace, quantity: Quantity| {
        let line = model.lines.iter().position(|line| line.name == *name);
        let line = line.ok_or_else(|| format!("no line is called `{name}`"))?;
        let last = model.lines[line].nodes_max() - 1;
        let node = match place {
            NodePlace::Number(node) => check_node(node, last).map(|()| node)?,
            NodePlace::End(LineEnd::A) => 0,
            NodePlace::End(LineEnd::B) => last,
        };
        Ok(Source::Node { line, node, quantity })
    };
    match channel {
        Channel::Node { line, node, quantity } => of_node(line, *node, *quantity),
        Channel::Point { point, quantity } => Ok(Source::Point {
            point: model
                .point_index(point)
                .ok_or_else(|| format!("no point is called `{point}`"))?,
            quantity: *quantity,
        }),
    }
}

fn column(name: &str, source: Source, model: &Model) -> Column {
    let (place, quantity) = match source {
        Source::Node { line, node, quantity } => {
            (format!("node {node} of {}", model.lines[line].name), quantity)
        }
        Source::Point { point, quantity } => (model.points[point].name.clone(), quantity),
    };
    let letter = |axis: usize| ["x", "y", "z"][axis];
    let (unit, what) = match quantity {
        Quantity::Position(axis) => ("m", format!("position along {}", letter(axis))),
        Quantity::Velocity(axis) => ("m/s", format!("velocity along {}", letter(axis))),
        Quantity::Force(axis) => ("N", format!("force of the lines along {}", letter(axis))),
        Quantity::Tension => match source {
            Source::Node { .. } => ("N", "tension of the segments next to it".to_string()),
            Source::Point { .. } => ("N", "size of the force of the lines".to_string()),
        },
    };
    Column::new(name, unit, format!("{what}, {place}"), Form::Real)
}

fn value(source: Source, simulation: &Simulation) -> f64 {
    let state = simulation.state();
    match source {
        Source::Node { line, node, quantity } => {
            let shape = &state.lines[line];
            let node = node.min(shape.position.len() - 1); // nodes that a winch has not paid out are at the winch
            match quantity {
                Quantity::Position(axis) => shape.position[node][axis],
                Quantity::Velocity(axis) => shape.velocity[node][axis],
                Quantity::Tension | Quantity::Force(_) => simulation.segment_tension(line, node),
            }
        }
        Source::Point { point, quantity } => {
            let force = || simulation.end_force(point);
            match quantity {
                Quantity::Position(axis) => state.points[point].position[axis],
                Quantity::Velocity(axis) => state.points[point].velocity[axis],
                Quantity::Force(axis) => force()[axis],
                Quantity::Tension => force().iter().map(|part| part * part).sum::<f64>().sqrt(),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::draft;

    fn simulation(channels: &[&str]) -> (Scene, Simulation) {
        let wire = draft("line_types.wire = { mass = 0.2, axial_stiffness = 5.35e6 }");
        let ends = wire.fixed("point1", [0.0; 3]).coupled("point2", [15.0, 0.0, 2.0]);
        let mut scene = ends.line("line1", ["point1", "point2"], "wire", 20.0, 10).scene();
        scene.output.channels = channels.iter().map(|name| (*name).to_string()).collect();
        let simulation = Simulation::new(&scene).unwrap();
        (scene, simulation)
    }

    #[test]
    fn channels_are_what_the_simulation_says_of_the_same_places() {
        let names = [
            "FairTen1",
            "AnchTen1",
            "L1N4Pz",
            "Line1NBPx",
            "L1N4T",
            "Con2Fx",
            "P2T",
            "Point1Vz",
        ];
        let (scene, simulation) = simulation(&names);
        let channels = Channels::new(&scene, simulation.model()).unwrap();
        let profile = simulation.profile(0);
        let force = simulation.end_force(1);
        let expected = [
            simulation.segment_tension(0, 10),
            simulation.segment_tension(0, 0),
            profile[4].z,
            15.0,
            simulation.segment_tension(0, 4),
            force[0],
            simulation.tension_b(0),
            0.0,
        ];
        assert!(channels.values(&simulation).eq(expected));
        let units: Vec<String> = channels.columns().map(|column| column.unit).collect();
        assert_eq!(units, ["N", "N", "m", "m", "N", "N", "N", "m/s"]);
        let first = channels.columns().next().unwrap();
        assert_eq!(
            first.description,
            "tension of the segments next to it, node 10 of line1"
        );
    }

    /// A taut rope hanging straight down: T(z) is the weight below, so that the last segment has half a segment's weight less than the
    /// point above it.
    #[test]
    fn a_tension_at_an_end_is_that_of_the_last_segment_and_not_the_force_on_the_point() {
        let (mut scene, _) = simulation(&["FairTen1", "AnchTen1", "L1N1T", "L1N10T"]);
        scene.points[1].position = [0.0, 0.0, 21.0];
        let simulation = Simulation::new(&scene).unwrap();
        let channels = Channels::new(&scene, simulation.model()).unwrap();
        let values: Vec<f64> = channels.values(&simulation).collect();
        let (above, below) = (simulation.tension_b(0), simulation.tension_a(0));
        let segment = 0.2 * 2.0 * scene.gravity; // weight [N]
        let close = |value: f64, expected: f64| {
            assert!((value / expected - 1.0).abs() < 1e-9, "{value} {expected}");
        };
        close(values[0], above - 0.5 * segment);
        close(values[1], below + 0.5 * segment);
        close(values[2], below + segment);
        assert_eq!(values[3], values[0]);
    }

    #[test]
    fn a_node_that_only_the_mesh_decides_about_is_checked_against_it() {
        let (mut scene, _) = simulation(&[]);
        scene.lines[0].sections[0].elements = None;
        scene.output.channels = vec!["FairTen1".into(), "L1N5000T".into()];
        let model = Model::new(&scene).unwrap();
        let mistake = Channels::new(&scene, &model).unwrap_err();
        assert_eq!(mistake.at, "output.channels[1]");
        assert!(mistake.problem.starts_with("node 5000 of a line of"), "{mistake}");
    }
}
