//! Output channels with MoorDyn's names, in columns next to those of moorline.
//!
//! Tensions of nodes are those of MoorDyn: at an end, the magnitude of the force on the point with the weight and drag of half a segment; at an inner
//! node, that of the mean of the two adjacent tension vectors. Positions are global. Forces at a point include its own load, but no inertia.
//!
//! Source: MoorDyn 2.7.2, files and functions compared on one deck (`python_tests/test_libmoordyn.py`).

use nalgebra::Vector3;

use super::record::{Column, Form};
use crate::model::{End, Model};
use crate::scene::channel::{Channel, LineEnd, NodePlace, Quantity, check_node};
use crate::scene::{Scene, SceneError};
use crate::simulation::Simulation;

const ON_POINT: &str = "force of the lines and of the point itself, without inertia,";

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
    /// Names the first channel whose name is unknown or refers to a part that the model does not have.
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

    /// Columns of the channels.
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
        Quantity::Force(axis) => ("N", format!("{ON_POINT} along {}", letter(axis))),
        Quantity::Tension => match source {
            Source::Node { line, node, .. } if node == 0 || node == model.lines[line].nodes_max() - 1 => (
                "N",
                "magnitude of the force on the point, without inertia".to_string(),
            ),
            Source::Node { .. } => ("N", "tension of the segments next to it".to_string()),
            Source::Point { .. } => ("N", format!("magnitude of the {ON_POINT}")),
        },
    };
    Column::new(name, unit, format!("{what}, {place}"), Form::Real)
}

fn value(source: Source, simulation: &Simulation) -> f64 {
    let state = simulation.state();
    match source {
        Source::Node { line, node, quantity } => {
            let shape = &state.lines[line];
            let last = shape.position.len() - 1;
            let node = node.min(last); // nodes that a winch has not paid out are at the winch
            let at_end = |end: End| simulation.line_nodal_force(line, end).norm();
            match quantity {
                Quantity::Position(axis) => shape.position[node][axis],
                Quantity::Velocity(axis) => shape.velocity[node][axis],
                Quantity::Tension | Quantity::Force(_) => match node {
                    0 => at_end(End::A),
                    node if node == last => at_end(End::B),
                    node => simulation.segment_tension(line, node),
                },
            }
        }
        Source::Point { point, quantity } => {
            let force = || simulation.nodal_force(point);
            match quantity {
                Quantity::Position(axis) => state.points[point].position[axis],
                Quantity::Velocity(axis) => state.points[point].velocity[axis],
                Quantity::Force(axis) => force()[axis],
                Quantity::Tension => Vector3::from(force()).norm(),
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
        let force = simulation.nodal_force(1);
        let expected = [
            simulation.line_nodal_force(0, End::B).norm(),
            simulation.line_nodal_force(0, End::A).norm(),
            profile[4].z,
            15.0,
            simulation.segment_tension(0, 4),
            force[0],
            Vector3::from(force).norm(),
            0.0,
        ];
        assert!(channels.values(&simulation).eq(expected));
        let units: Vec<String> = channels.columns().map(|column| column.unit).collect();
        assert_eq!(units, ["N", "N", "m", "m", "N", "N", "N", "m/s"]);
        let first = channels.columns().next().unwrap();
        assert_eq!(
            first.description,
            "magnitude of the force on the point, without inertia, node 10 of line1"
        );
    }

    /// A taut rope hanging straight down: T(z) is the weight below, so that the tension of the last segment is less than the force on the point above
    /// it by half a segment's weight.
    #[test]
    fn a_tension_at_an_end_is_the_force_on_the_point_and_one_between_that_of_the_segments() {
        let (mut scene, _) = simulation(&["FairTen1", "AnchTen1", "L1N1T", "L1N9T", "L1N10T"]);
        scene.points[1].position = [0.0, 0.0, 21.0];
        let simulation = Simulation::new(&scene).unwrap();
        let channels = Channels::new(&scene, simulation.model()).unwrap();
        let values: Vec<f64> = channels.values(&simulation).collect();
        let (above, below) = (simulation.tension_b(0), simulation.tension_a(0));
        let segment = 0.2 * 2.0 * scene.gravity; // weight [N]
        let close = |value: f64, expected: f64| {
            assert!((value / expected - 1.0).abs() < 1e-9, "{value} {expected}");
        };
        close(values[0], above);
        close(values[1], below);
        close(values[2], below + segment);
        close(values[3], above - segment);
        assert_eq!(values[4], values[0]);
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
