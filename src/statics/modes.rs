//! Natural frequencies and mode shapes of a network of lines about a state at rest.
//!
//! K φ = ω² M φ over the nodes between the ends of every line and the free axes of free points. K is the assembled tangent of statics: axial,
//! geometric and bending stiffness of the lines, and the springs of the seabed and of the water surface where lines touch or pierce them. M is that
//! of dynamics: lumped, including added mass, M_n I + (M_t − M_n) t tᵀ at a node. M couples the axes of a node only, so that with the Cholesky
//! factors M = L Lᵀ of its blocks L⁻¹ K L⁻ᵀ y = ω² y is as sparse as K, φ = L⁻ᵀ y. Damping and drag are left out. Viscoelastic ropes have their
//! stiffness in fast motion, which is that of periods shorter than 2π times their relaxation time.
//!
//! Source: the linearised equation of motion of `elements`, reduced here; `tests/dynamics/analytic.rs` compares it with closed forms.
//! Valid for motion small enough that no segment slackens and no node lands or lifts off. A slack segment has no stiffness and
//! leaves modes of frequency 0. Beams have no tangent here.

use std::iter::once;

use nalgebra::{Matrix3, Vector3};

use crate::elements::{StaticCase, Workspace, node_tangent};
use crate::math::eigen::{Eigen, Entry};
use crate::model::{Line, Model, Network, State};
use crate::physics::slender::Slender;

/// Maximum number of unknowns for which the dense solver is used, for any number of modes [-].
const DENSE_MAX: usize = 300;

/// Reason why a network has no modes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ModesError {
    /// A line is a beam.
    #[error(
        "line \"{line}\": natural modes of beams are not computed; give the line `bending_stiffness` in place of beam properties"
    )]
    Beam {
        /// Name of the line.
        line: String,
    },
    /// A node that moves has no mass.
    #[error(
        "line \"{line}\", node {node}: no natural modes: this node moves and has no mass; give the line or the point a mass"
    )]
    NoMass {
        /// Name of a line that ends or runs there.
        line: String,
        /// Node, from 0 at end A.
        node: usize,
    },
    /// The stiffness is not positive semi-definite.
    #[error(
        "line \"{line}\": no natural modes: the equilibrium of this line and the lines joined to it is not stable"
    )]
    Unstable {
        /// Name of the network's first line.
        line: String,
    },
}

/// Modes of a network, lowest first.
#[derive(Debug, Clone)]
pub struct Modes {
    /// Circular natural frequencies [rad/s]; 0 without a restoring force.
    pub frequencies: Vec<f64>,
    nodes: Nodes,
    eigen: Eigen,
}

/// Moving nodes of a network.
#[derive(Debug, Clone)]
struct Nodes {
    /// Index of every moving node, by line of the network and node; `None` if its motion is prescribed.
    places: Vec<Vec<Option<usize>>>,
    /// Unknown of every axis of every moving node; `None` if its motion is prescribed.
    unknowns: Vec<[Option<usize>; 3]>,
    /// L⁻¹ of every moving node [1/√kg].
    scale: Vec<Matrix3<f64>>,
}

impl Modes {
    /// The `count` lowest modes of a network about `state`, or all if there are fewer.
    ///
    /// # Errors
    /// Fails for a beam, a moving node without mass, or an unstable equilibrium.
    pub fn lowest(
        model: &Model,
        network: usize,
        state: &State,
        count: usize,
        work: &mut Workspace,
    ) -> Result<Modes, ModesError> {
        let name = |line: usize| model.lines[line].name.clone();
        if let Some(line) = model.beam_of(network) {
            return Err(ModesError::Beam { line: name(line) });
        }
        let network = &model.networks[network];
        let nodes = Nodes::new(model, network, state, work)?;
        let case = StaticCase {
            vibrates: true,
            ..StaticCase::whole(state.time)
        };
        work.assemble_static(model, network, state, &case);
        let entries = nodes.stiffness(network, work);
        let size = nodes.unknowns.iter().flatten().flatten().count();
        let eigen = match size <= DENSE_MAX || 4 * count.min(size) > size {
            true => Some(Eigen::all(size, &entries)),
            false => Eigen::lowest(size, &entries, count),
        };
        let eigen = eigen.ok_or_else(|| ModesError::Unstable {
            line: name(network.lines[0]),
        })?;
        let squares = eigen.values.iter().take(count);
        Ok(Modes {
            frequencies: squares.map(|square| square.max(0.0).sqrt()).collect(),
            nodes,
            eigen,
        })
    }

    /// Mass-normalised displacements [1/√kg] of every node of a line in a mode; `line` is an index among the lines of the network.
    pub fn shape(&self, mode: usize, line: usize) -> Vec<Vector3<f64>> {
        let Nodes {
            places,
            unknowns,
            scale,
        } = &self.nodes;
        let along = |unknown: Option<usize>| unknown.map_or(0.0, |row| self.eigen.vector(mode, row));
        let at = |place: usize| scale[place].tr_mul(&Vector3::from(unknowns[place].map(along)));
        let places = places[line].iter();
        places.map(|place| place.map_or(Vector3::zeros(), at)).collect()
    }
}

impl Nodes {
    /// Numbers the axes that move: free points, then nodes between the ends line by line.
    fn new(model: &Model, network: &Network, state: &State, work: &Workspace) -> Result<Nodes, ModesError> {
        let (mut mass, mut axes) = (Vec::new(), Vec::new());
        for &point in &network.free_points {
            let height = state.points[point].position.z;
            let free = model.points[point].free();
            let own = free.map_or(0.0, |free| free.at(height).mass);
            mass.push(Matrix3::from_diagonal_element(own));
            axes.push(free.map_or([false; 3], |free| free.axes));
        }
        let mut places = Vec::with_capacity(network.lines.len());
        for &index in &network.lines {
            let line = &model.lines[index];
            let slots = line.ends.map(|point| work.points[point].slot);
            let inner = mass.len()..mass.len() + line.segment_count() - 1;
            mass.resize(inner.end, Matrix3::zeros());
            axes.resize(inner.end, [true; 3]);
            let inner = inner.map(Some);
            let own: Vec<_> = once(slots[0]).chain(inner).chain(once(slots[1])).collect();
            for (node, place) in own.iter().enumerate() {
                if let Some(place) = *place {
                    mass[place] += node_mass(line, &state.lines[index].position, node);
                }
            }
            places.push(own);
        }
        let mut scale = Vec::with_capacity(mass.len());
        for (place, (mass, axes)) in mass.iter().zip(&axes).enumerate() {
            let factor = inverse_factor(mass, *axes);
            scale.push(factor.ok_or_else(|| without_mass(model, network, &places, place))?);
        }
        let mut count = 0;
        let mut number = |moves: bool| {
            count += usize::from(moves);
            moves.then(|| count - 1)
        };
        let unknowns = axes.iter().map(|axes| axes.map(&mut number)).collect();
        Ok(Nodes {
            places,
            unknowns,
            scale,
        })
    }

    /// L⁻¹ K L⁻ᵀ of the assembled tangent [1/s²].
    fn stiffness(&self, network: &Network, work: &Workspace) -> Vec<Entry> {
        let mut entries = Vec::new();
        let mut add = |row: Option<usize>, column: Option<usize>, block: &Matrix3<f64>| {
            if let (Some(row), Some(column)) = (row, column) {
                self.add_block(&mut entries, row, column, block);
            }
        };
        for (&index, places) in network.lines.iter().zip(&self.places) {
            let line = &work.lines[index];
            for (&place, block) in places.iter().zip(&line.diagonal) {
                add(place, place, block);
            }
            let bending = line.bending.as_ref().filter(|bending| bending.active);
            let joints = bending.map_or([&[][..]; 2], |bending| [&bending.near[..], &bending.far]);
            for (step, blocks) in [(1, &line.coupling[..]), (1, joints[0]), (2, joints[1])] {
                for (i, block) in blocks.iter().enumerate() {
                    add(places[i], places[i + step], block);
                    add(places[i + step], places[i], &block.transpose());
                }
            }
        }
        for (place, &index) in network.free_points.iter().enumerate() {
            add(Some(place), Some(place), &work.points[index].diagonal);
        }
        entries
    }

    /// Adds the entries of a block of K that lie in the lower triangle.
    fn add_block(&self, entries: &mut Vec<Entry>, row: usize, column: usize, block: &Matrix3<f64>) {
        let scaled = self.scale[row] * block * self.scale[column].transpose();
        for (i, row) in self.unknowns[row].into_iter().enumerate() {
            for (k, column) in self.unknowns[column].into_iter().enumerate() {
                if let (Some(row), Some(column)) = (row, column)
                    && row >= column
                {
                    entries.push(Entry::new(row, column, scaled[(i, k)]));
                }
            }
        }
    }
}

/// L⁻¹ of the mass of a node on its free axes [1/√kg]; `None` if it has no mass.
fn inverse_factor(mass: &Matrix3<f64>, axes: [bool; 3]) -> Option<Matrix3<f64>> {
    let moves = |i: usize, k: usize| axes[i] && axes[k];
    let own = Matrix3::from_fn(|i, k| {
        if moves(i, k) {
            mass[(i, k)]
        } else {
            f64::from(u8::from(i == k))
        }
    });
    own.cholesky()?.l().try_inverse()
}

/// Error for a moving node without mass.
fn without_mass(model: &Model, network: &Network, places: &[Vec<Option<usize>>], place: usize) -> ModesError {
    let lines = network.lines.iter().zip(places);
    let mut found =
        lines.filter_map(|(&line, own)| Some((line, own.iter().position(|&at| at == Some(place))?)));
    let (line, node) = found.next().unwrap_or((network.lines[0], 0));
    ModesError::NoMass {
        line: model.lines[line].name.clone(),
        node,
    }
}

/// M_n I + (M_t − M_n) t tᵀ of a node [kg].
fn node_mass(line: &Line, position: &[Vector3<f64>], i: usize) -> Matrix3<f64> {
    let surface = line.surface.as_ref();
    let dry = surface.map_or(0.0, |surface| surface.node(i, position).part);
    Slender::new(line.nodes.masses(i, dry)).matrix(node_tangent(position, i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::draft;
    use crate::model::{LineState, PointState, Role};
    use approx::assert_relative_eq;

    /// A mass that slides along x between two springs of one element each.
    fn springs() -> Model {
        draft("gravity = 0.0\nline_types.spring = { mass = 0.3, axial_stiffness = 500.0 }")
            .fixed("left", [-1.5, 0.0, 0.0])
            .free("mass", [0.0; 3])
            .with("free = ['x'], mass = 2.0")
            .fixed("right", [3.0, 0.0, 0.0])
            .line("a", ["left", "mass"], "spring", 1.0, 1)
            .line("b", ["mass", "right"], "spring", 2.0, 1)
            .model()
    }

    fn modes(model: &Model) -> Result<Modes, ModesError> {
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
        Modes::lowest(model, 0, &state, usize::MAX, &mut Workspace::new(model))
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
        let error = modes(&model).unwrap_err();
        let line = "a".to_string();
        assert_eq!(error, ModesError::NoMass { line, node: 1 });
    }
}
