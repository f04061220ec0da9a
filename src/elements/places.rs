//! Locations in a network and their names for messages; copies of states.

use crate::model::{LineState, Model, Network, PointState, State};

/// Node between the ends of a line, or free point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Node of a line, by their indices.
    Node { line: usize, node: usize },
    /// Free point, by its index.
    Point(usize),
}

impl Place {
    /// Index of a line and a node at this location.
    pub(crate) fn node(self, model: &Model) -> (usize, usize) {
        match self {
            Place::Node { line, node } => (line, node),
            Place::Point(point) => {
                let (line, end) = model.points[point].attached[0];
                (line, model.lines[line].end_node(end))
            }
        }
    }

    /// Name for messages.
    pub(crate) fn name(self, model: &Model) -> String {
        match self {
            Place::Node { line, node } => {
                format!("line \"{}\", node {node}", model.lines[line].name)
            }
            Place::Point(point) => format!("point \"{}\"", model.points[point].name),
        }
    }
}
/// Puts the end nodes of a network's lines at their points, with the motion of the points.
pub(crate) fn place_ends(model: &Model, network: &Network, state: &mut State) {
    for &index in &network.lines {
        let line = &model.lines[index];
        let released = state.lines[index].released;
        let ends = line.ends.into_iter().zip([0, line.segment_count()]);
        for ((point, node), _) in ends.zip(released).filter(|(_, released)| !released) {
            let (point, nodes) = (&state.points[point], &mut state.lines[index]);
            nodes.position[node] = point.position;
            nodes.velocity[node] = point.velocity;
            nodes.acceleration[node] = point.acceleration;
        }
    }
}

/// Copies the points and nodes of a network from one state to another; allocates only the first time.
pub(crate) fn copy_network(model: &Model, network: &Network, from: &State, to: &mut State) {
    if to.lines.len() != from.lines.len() {
        to.lines
            .resize_with(from.lines.len(), || LineState::at_rest(Vec::new()));
        to.points.resize(from.points.len(), PointState::default());
    }
    for &index in &network.lines {
        let (from_line, to_line) = (&from.lines[index], &mut to.lines[index]);
        to_line.position.clone_from(&from_line.position);
        to_line.velocity.clone_from(&from_line.velocity);
        to_line.acceleration.clone_from(&from_line.acceleration);
        to_line.viscoelastic.clone_from(&from_line.viscoelastic);
        to_line.released = from_line.released;
        to_line.beam.clone_from(&from_line.beam);
        to_line.anchor.clone_from(&from_line.anchor);
        to_line.closed_form.clone_from(&from_line.closed_form);
        for point in model.lines[index].ends {
            to.points[point] = from.points[point];
        }
    }
}
