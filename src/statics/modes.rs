//! Natural frequencies and mode shapes of a network of lines about a state at rest.
//!
//! K φ = ω² M φ over the nodes between the ends of every line and the free axes of free points. K is the assembled tangent
//! of statics: axial, geometric and bending stiffness of the lines, the bed's springs where they touch, and the surface's where it is pierced. M is that of dynamics:
//! lumped, added mass included, M_n I + (M_t − M_n) t tᵀ at a node. With the Cholesky factor M = L Lᵀ the symmetric problem
//! L⁻¹ K L⁻ᵀ y = ω² y is solved densely, φ = L⁻ᵀ y. Damping and drag are left out.
//!
//! Source: the linearised equation of motion of `elements`, reduced here; `tests/dynamics/analytic.rs` holds it against closed forms.
//! Valid for motion small enough that no segment slackens and no node lands or lifts off. A slack segment has no stiffness and
//! leaves modes of frequency 0.

use nalgebra::{Cholesky, DMatrix, Dyn, Matrix3, SymmetricEigen, Vector3};

use crate::elements::{BendingWork, StaticCase, Workspace, node_tangent};
use crate::model::{Line, Model, Network, State};
use crate::physics::slender::Slender;

/// The modes of a network, lowest first.
#[derive(Debug, Clone)]
pub struct Modes {
    /// Circular natural frequencies [rad/s]; 0 where nothing restores.
    pub frequencies: Vec<f64>,
    /// Unknown of every axis of every node, by line of the network and node; `None` where it is held.
    unknowns: Vec<Vec<[Option<usize>; 3]>>,
    /// Mass-normalised shapes by column [1/√kg].
    shapes: DMatrix<f64>,
}

impl Modes {
    /// Modes of a network about `state`; `None` where a node that moves has no mass.
    pub fn new(model: &Model, network: usize, state: &State, work: &mut Workspace) -> Option<Modes> {
        let network = &model.networks[network];
        let (unknowns, count) = number_unknowns(model, network);
        let case = StaticCase::whole(state.time);
        work.assemble_static(model, network, state, &case);
        let mut stiffness = DMatrix::zeros(count, count);
        let mut mass = DMatrix::zeros(count, count);
        for (&index, nodes) in network.lines.iter().zip(&unknowns) {
            let (line, tangent) = (&model.lines[index], &work.lines[index]);
            for (i, &node) in nodes.iter().enumerate() {
                add_block(&mut stiffness, node, node, &tangent.diagonal[i]);
                add_block(
                    &mut mass,
                    node,
                    node,
                    &node_mass(line, &state.lines[index].position, i),
                );
            }
            for (pair, coupling) in nodes.windows(2).zip(&tangent.coupling) {
                add_block(&mut stiffness, pair[0], pair[1], coupling);
                add_block(&mut stiffness, pair[1], pair[0], &coupling.transpose());
            }
            if let Some(bending) = &tangent.bending {
                add_second_neighbours(&mut stiffness, nodes, bending);
            }
        }
        for &index in &network.free_points {
            let height = state.points[index].position.z;
            let own = model.points[index].free();
            let own = own.map_or(0.0, |free| free.at(height).mass);
            let point = point_unknowns(model, network, &unknowns, index);
            add_block(&mut stiffness, point, point, &work.points[index].diagonal);
            add_block(&mut mass, point, point, &Matrix3::from_diagonal_element(own));
        }
        let mut modes = solve(stiffness, Cholesky::new(mass)?);
        modes.unknowns = unknowns;
        Some(modes)
    }

    /// Mass-normalised displacements [1/√kg] of every node of a line in a mode; `line` counts the lines of the network.
    pub fn shape(&self, mode: usize, line: usize) -> Vec<Vector3<f64>> {
        let along = |unknown: Option<usize>| unknown.map_or(0.0, |row| self.shapes[(row, mode)]);
        let nodes = self.unknowns[line].iter();
        nodes.map(|node| Vector3::from(node.map(along))).collect()
    }
}

/// Numbers the axes that move: nodes between the ends line by line, then free points. Also how many there are.
fn number_unknowns(model: &Model, network: &Network) -> (Vec<Vec<[Option<usize>; 3]>>, usize) {
    let mut count = 0;
    let mut next = |moves: bool| {
        count += usize::from(moves);
        moves.then(|| count - 1)
    };
    let mut unknowns: Vec<Vec<[Option<usize>; 3]>> = Vec::with_capacity(network.lines.len());
    for &index in &network.lines {
        let last = model.lines[index].segment_count();
        let node = |i: usize| [i > 0 && i < last; 3].map(&mut next);
        unknowns.push((0..=last).map(node).collect());
    }
    for &index in &network.free_points {
        let axes = model.points[index].free().map_or([false; 3], |free| free.axes);
        let numbers = axes.map(&mut next);
        for (line, nodes) in network.lines.iter().zip(&mut unknowns) {
            let last = nodes.len() - 1;
            for (node, &point) in [0, last].into_iter().zip(&model.lines[*line].ends) {
                if point == index {
                    nodes[node] = numbers;
                }
            }
        }
    }
    (unknowns, count)
}

/// Unknowns of a free point, as the lines that end there have them.
fn point_unknowns(
    model: &Model,
    network: &Network,
    unknowns: &[Vec<[Option<usize>; 3]>],
    point: usize,
) -> [Option<usize>; 3] {
    let ends = network.lines.iter().zip(unknowns).flat_map(|(&line, nodes)| {
        let [a, b] = model.lines[line].ends;
        [(a, nodes[0]), (b, nodes[nodes.len() - 1])]
    });
    let mut found = ends.filter(|(end, _)| *end == point).map(|(_, numbers)| numbers);
    found.next().unwrap_or([None; 3])
}

fn add_block(
    matrix: &mut DMatrix<f64>,
    rows: [Option<usize>; 3],
    columns: [Option<usize>; 3],
    block: &Matrix3<f64>,
) {
    for (i, row) in rows.into_iter().enumerate() {
        for (j, column) in columns.into_iter().enumerate() {
            if let (Some(row), Some(column)) = (row, column) {
                matrix[(row, column)] += block[(i, j)];
            }
        }
    }
}

/// What the joints of a line couple.
fn add_second_neighbours(stiffness: &mut DMatrix<f64>, nodes: &[[Option<usize>; 3]], bending: &BendingWork) {
    for (step, blocks) in [(1, &bending.near), (2, &bending.far)] {
        for (i, block) in blocks.iter().enumerate() {
            let (row, column) = (nodes[i], nodes[i + step]);
            add_block(stiffness, row, column, block);
            add_block(stiffness, column, row, &block.transpose());
        }
    }
}

/// M_n I + (M_t − M_n) t tᵀ of a node [kg].
fn node_mass(line: &Line, position: &[Vector3<f64>], i: usize) -> Matrix3<f64> {
    let surface = line.surface.as_ref();
    let dry = surface.map_or(0.0, |surface| surface.node(i, position).part);
    Slender::new(line.nodes.masses(i, dry)).matrix(node_tangent(position, i))
}

fn solve(mut stiffness: DMatrix<f64>, mass: Cholesky<f64, Dyn>) -> Modes {
    let factor = mass.l();
    factor.solve_lower_triangular_mut(&mut stiffness);
    stiffness.transpose_mut();
    factor.solve_lower_triangular_mut(&mut stiffness);
    let eigen = SymmetricEigen::new(stiffness);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let mut shapes = eigen.eigenvectors.select_columns(&order);
    factor.tr_solve_lower_triangular_mut(&mut shapes);
    Modes {
        frequencies: order
            .iter()
            .map(|&i| eigen.eigenvalues[i].max(0.0).sqrt())
            .collect(),
        unknowns: Vec::new(),
        shapes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{LineState, PointState, Role};
    use crate::scene::Scene;
    use approx::assert_relative_eq;

    /// A mass that slides along x between two springs of one element each.
    const SPRINGS: &str = r#"
        gravity = 0.0
        line_types.spring = { mass = 0.3, axial_stiffness = 500.0 }
        points = [
          { name = "left", position = [-1.5, 0.0, 0.0], kind = "fixed" },
          { name = "mass", position = [0.0, 0.0, 0.0], kind = "free", free = ["x"], mass = 2.0 },
          { name = "right", position = [3.0, 0.0, 0.0], kind = "fixed" },
        ]
        lines = [
          { name = "a", from = "left", to = "mass", sections = [{ type = "spring", length = 1.0, elements = 1 }] },
          { name = "b", from = "mass", to = "right", sections = [{ type = "spring", length = 2.0, elements = 1 }] },
        ]
    "#;

    fn springs() -> Model {
        Model::new(&Scene::from_toml(SPRINGS).unwrap()).unwrap()
    }

    fn modes(model: &Model) -> Option<Modes> {
        let points: Vec<PointState> = model
            .points
            .iter()
            .map(|p| PointState::at_rest(p.reference))
            .collect();
        let straight = |line: &Line| {
            let [a, b] = line.ends.map(|point| points[point].position);
            let along = |arc: &f64| a + (b - a) * (arc / line.unstretched_length());
            LineState::at_rest(line.nodes.arc.iter().map(along).collect())
        };
        let lines = model.lines.iter().map(straight).collect();
        let state = State {
            time: 0.0,
            points,
            lines,
            waves: None,
        };
        Modes::new(model, 0, &state, &mut Workspace::new(model))
    }

    #[test]
    fn a_mass_between_two_springs_has_one_mode() {
        let modes = modes(&springs()).unwrap();
        let (k, m) = (500.0 / 1.0 + 500.0 / 2.0, 2.0 + 0.5 * 0.3 * 3.0_f64); // [N/m], [kg]
        assert_eq!(modes.frequencies.len(), 1);
        assert_relative_eq!(modes.frequencies[0], (k / m).sqrt(), max_relative = 1e-14);
        assert_relative_eq!(modes.shape(0, 0)[1].x.abs(), 1.0 / m.sqrt(), max_relative = 1e-14);
        assert_eq!(modes.shape(0, 1)[0], modes.shape(0, 0)[1]);
    }

    #[test]
    fn a_node_without_mass_has_no_modes() {
        let mut model = springs();
        for line in &mut model.lines {
            line.nodes.mass_normal.fill(0.0);
            line.nodes.mass_tangent.fill(0.0);
        }
        if let Role::Free(free) = &mut model.points[1].role {
            free.mass = 0.0;
        }
        assert!(modes(&model).is_none());
    }
}
