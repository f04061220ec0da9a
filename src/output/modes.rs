//! Natural modes of a mooring about its equilibrium, as `moorline modes` prints and draws them. `docs/json.md` has the layout.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use serde::Serialize;

use crate::elements::{Workspace, node_tangent};
use crate::model::Line;
use crate::simulation::Simulation;
use crate::statics::modes::{Modes, ModesError};

/// Ratio of the horizontal length of a chord to the length of the line below which the line is vertical, with the plane y = 0 [-].
const VERTICAL: f64 = 1e-6;

/// The lowest natural modes of all lines.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NaturalModes {
    /// Title of the scene.
    pub title: String,
    /// Modes by frequency, lowest first.
    pub modes: Vec<Mode>,
}

/// A natural mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mode {
    /// Natural period [s]; `None` without a restoring force.
    pub period: Option<f64>,
    /// Natural frequency [Hz].
    pub frequency: f64,
    /// Modal mass for a greatest displacement of 1 [kg].
    pub modal_mass: f64,
    /// Position of the greatest displacement.
    pub greatest: Place,
    /// Main direction of motion of the line there.
    pub direction: Direction,
    /// Shares of the directions in the motion of that line; their sum is 1.
    pub shares: Shares,
    /// Shapes of the lines that move, scaled to a greatest displacement of 1.
    pub shapes: Vec<LineShape>,
}

/// A node of a line.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Place {
    /// Name of the line.
    pub line: String,
    /// Node, from 0 at end A.
    pub node: usize,
    /// Unstretched arc length from end A [m].
    pub s: f64,
    /// Name of the point there; `None` between the ends.
    pub point: Option<String>,
}

/// Direction of motion relative to the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Along the line.
    Axial,
    /// Across the line, in the vertical plane through its ends.
    Transverse,
    /// Normal to that plane.
    OutOfPlane,
}

/// Shares of the directions in the motion of a line, from squares of displacements summed over its length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Shares {
    /// Along the line [-].
    pub axial: f64,
    /// Across the line in its plane [-].
    pub transverse: f64,
    /// Normal to this plane [-].
    pub out_of_plane: f64,
}

/// Displacements of a line in a mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LineShape {
    /// Name of the line.
    pub line: String,
    /// Nodes from end A to end B.
    pub nodes: Vec<NodeShape>,
}

/// Displacement of a node in a mode.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct NodeShape {
    /// Unstretched arc length from end A [m].
    pub s: f64,
    /// Along x [-].
    pub x: f64,
    /// Along y [-].
    pub y: f64,
    /// Along z [-].
    pub z: f64,
    /// Along the line, towards end B [-].
    pub axial: f64,
    /// Across the line in its vertical plane, upwards [-].
    pub transverse: f64,
    /// Normal to this plane [-].
    pub out_of_plane: f64,
}

impl Direction {
    /// Returns the direction in words.
    pub fn words(self) -> &'static str {
        match self {
            Direction::Axial => "axial",
            Direction::Transverse => "transverse",
            Direction::OutOfPlane => "out of plane",
        }
    }
}

impl Shares {
    /// Returns the direction with the greatest share, and this share.
    pub fn greatest(&self) -> (Direction, f64) {
        let all = [
            (Direction::Transverse, self.transverse),
            (Direction::OutOfPlane, self.out_of_plane),
            (Direction::Axial, self.axial),
        ];
        let [first, rest @ ..] = all;
        rest.into_iter()
            .fold(first, |best, other| if other.1 > best.1 { other } else { best })
    }
}

impl NodeShape {
    /// Displacement in a direction [-].
    pub fn along(&self, direction: Direction) -> f64 {
        match direction {
            Direction::Axial => self.axial,
            Direction::Transverse => self.transverse,
            Direction::OutOfPlane => self.out_of_plane,
        }
    }
}

/// Returns the `count` lowest modes of all networks of a simulation in equilibrium.
///
/// # Errors
/// As [`Modes::lowest`].
pub fn natural_modes(title: &str, simulation: &Simulation, count: usize) -> Result<NaturalModes, ModesError> {
    let model = simulation.model();
    let mut work = Workspace::new(model);
    let mut found = Vec::new();
    let mut networks = Vec::with_capacity(model.networks.len());
    for network in 0..model.networks.len() {
        let modes = Modes::lowest(model, network, simulation.state(), count, &mut work)?;
        let numbered = modes.frequencies.iter().enumerate().take(count);
        found.extend(numbered.map(|(mode, &frequency)| (frequency, network, mode)));
        networks.push(modes);
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.truncate(count);
    let modes = found.into_iter();
    Ok(NaturalModes {
        title: title.to_string(),
        modes: modes
            .map(|(frequency, network, mode)| {
                let lines = model.networks[network].lines.iter().enumerate();
                let shapes = lines.map(|(own, &line)| (line, networks[network].shape(mode, own)));
                Mode::new(simulation, frequency, shapes.collect())
            })
            .collect(),
    })
}

impl Mode {
    /// Returns the mode with the mass-normalised shapes [1/√kg] of the lines of a network.
    fn new(simulation: &Simulation, frequency: f64, shapes: Vec<(usize, Vec<Vector3<f64>>)>) -> Mode {
        let model = simulation.model();
        let sizes = shapes.iter().flat_map(|(line, nodes)| {
            let nodes = nodes.iter().enumerate();
            nodes.map(move |(node, shape)| (shape.norm(), *line, node))
        });
        let (size, line, node) =
            sizes.fold(
                (0.0, shapes[0].0, 0),
                |best, other| if other.0 > best.0 { other } else { best },
            );
        let drawn: Vec<LineShape> = shapes
            .iter()
            .filter(|(_, nodes)| nodes.iter().any(|shape| *shape != Vector3::zeros()))
            .map(|(line, nodes)| LineShape::new(simulation, *line, nodes, 1.0 / size))
            .collect();
        let data = &model.lines[line];
        let shares = Shares::of(data, drawn.iter().find(|shape| shape.line == data.name));
        let ends = [0, data.segment_count()].into_iter().zip(data.ends);
        let mut point = ends
            .filter(|(end, _)| *end == node)
            .map(|(_, point)| model.points[point].name.clone());
        let hertz = frequency / TAU;
        Mode {
            period: (hertz > 0.0).then(|| 1.0 / hertz),
            frequency: hertz,
            modal_mass: size.powi(-2),
            greatest: Place {
                line: data.name.clone(),
                node,
                s: data.nodes.arc[node],
                point: point.next(),
            },
            direction: shares.greatest().0,
            shares,
            shapes: drawn,
        }
    }
}

impl Shares {
    fn of(line: &Line, shape: Option<&LineShape>) -> Shares {
        let nodes = shape.map_or(&[][..], |shape| &shape.nodes);
        let sum = |direction: Direction| -> f64 {
            let squares = nodes.iter().zip(&line.nodes.length);
            squares
                .map(|(node, length)| length * node.along(direction).powi(2))
                .sum()
        };
        let [axial, transverse, out_of_plane] =
            [Direction::Axial, Direction::Transverse, Direction::OutOfPlane].map(sum);
        let whole = axial + transverse + out_of_plane;
        let share = |part: f64| if whole > 0.0 { part / whole } else { 0.0 };
        Shares {
            axial: share(axial),
            transverse: share(transverse),
            out_of_plane: share(out_of_plane),
        }
    }
}

impl LineShape {
    fn new(simulation: &Simulation, line: usize, nodes: &[Vector3<f64>], scale: f64) -> LineShape {
        let (data, position) = (
            &simulation.model().lines[line],
            &simulation.state().lines[line].position,
        );
        let chord = position[position.len() - 1] - position[0];
        let level = Vector3::new(chord.x, chord.y, 0.0);
        let along = match level.norm() > VERTICAL * data.unstretched_length() {
            true => level.normalize(),
            false => Vector3::x(),
        };
        let node = |(i, shape): (usize, &Vector3<f64>)| {
            let shape = scale * shape;
            let tangent = node_tangent(position, i);
            let sideways = Vector3::z().cross(&along);
            let across = sideways - sideways.dot(&tangent) * tangent;
            let across = across.try_normalize(0.0).unwrap_or(sideways);
            NodeShape {
                s: data.nodes.arc[i],
                x: shape.x,
                y: shape.y,
                z: shape.z,
                axial: shape.dot(&tangent),
                transverse: shape.dot(&tangent.cross(&across)),
                out_of_plane: shape.dot(&across),
            }
        };
        LineShape {
            line: data.name.clone(),
            nodes: nodes.iter().enumerate().map(node).collect(),
        }
    }
}
