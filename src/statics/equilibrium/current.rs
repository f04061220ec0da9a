//! Equilibrium in a current.
//!
//! The drag of the current on a node depends on the position of the node and on the direction of the line there, so it is part of the solution. The
//! drag F of all nodes is kept constant while the equilibrium of the network is found as under any dead load. The drag G(F) of the resulting shape
//! then replaces it until both agree, F = G(F), accelerated by [`Anderson`]; without acceleration light lines in a strong current would oscillate. If
//! the iteration does not converge, the current is raised in parts.
//!
//! The iteration is accepted when the difference on every node is of the size of the equilibrium's accepted residual.
//!
//! Source: the iteration is derived here; its acceleration by Walker & Ni (2011), SIAM J. Numer. Anal. 49(4), 1715-1735.

use nalgebra::Vector3;

use super::Problem;
use crate::elements::{Workspace, copy_network, node_tangent};
use crate::math::anderson::Anderson;
use crate::model::{Line, State};
use crate::physics::flow::Stream;
use crate::physics::morison::drag;
use crate::statics::StaticsError;

/// Maximum number of rounds of drag and equilibrium for each part of the current.
const ROUNDS_MAX: usize = 60;
/// Number of rounds that the acceleration uses.
const DEPTH: usize = 8;
/// Numbers of parts in which the current is raised, tried in turn [-].
const PARTS: [usize; 4] = [1, 4, 16, 64];

/// Drag of a current on a node at rest [N].
pub(crate) fn drag_at_rest(line: &Line, position: &[Vector3<f64>], i: usize, stream: Stream) -> Vector3<f64> {
    let Some(coefficients) = &line.nodes.drag else {
        return Vector3::zeros();
    };
    let surface = line.surface.as_ref();
    let dry = surface.map_or(0.0, |surface| surface.node(i, position).part);
    let past = -stream.velocity(position[i].z);
    drag(
        coefficients.at(i).times(1.0 - dry),
        past,
        node_tangent(position, i),
    )
}

impl Problem<'_> {
    /// Equilibrium under the drag of the current, from the shape in `state`.
    pub(super) fn solve_in_current(
        &self,
        stream: Stream,
        state: &mut State,
        work: &mut Workspace,
    ) -> Result<(), StaticsError> {
        let mut guess = std::mem::take(&mut work.hung);
        copy_network(self.model, self.network, state, &mut guess);
        let mut result = Ok(());
        for parts in PARTS {
            copy_network(self.model, self.network, &guess, state);
            result = (1..=parts).try_for_each(|part| {
                let share = Stream {
                    factor: stream.factor * part as f64 / parts as f64,
                    ..stream
                };
                self.drift(share, state, work)
            });
            if result.is_ok() {
                break;
            }
        }
        work.hung = guess;
        result
    }

    /// Iterates drag and equilibrium until both agree.
    fn drift(&self, stream: Stream, state: &mut State, work: &mut Workspace) -> Result<(), StaticsError> {
        let mut anderson = Anderson::new(DEPTH);
        let (mut loads, mut image) = (Vec::new(), Vec::new());
        let start = work.counters.solves;
        self.drag_of_shape(stream, state, &mut loads);
        for _ in 0..ROUNDS_MAX {
            let problem = Problem {
                force: self.force + self.put_loads(&loads, work),
                ..*self
            };
            problem.solve_loaded(state, work)?;
            self.drag_of_shape(stream, state, &mut image);
            let difference = loads
                .chunks(3)
                .zip(image.chunks(3))
                .map(|(a, b)| Vector3::from_column_slice(a).metric_distance(&Vector3::from_column_slice(b)));
            let greatest = difference.fold(0.0, f64::max);
            if greatest <= problem.tolerance(state, work, f64::INFINITY) {
                return Ok(());
            }
            anderson.step(&mut loads, &image);
        }
        self.put_loads(&image, work);
        Err(self.not_converged(state, work, start))
    }

    /// Drag of all nodes of the network at their present positions [N], three numbers per node.
    fn drag_of_shape(&self, stream: Stream, state: &State, loads: &mut Vec<f64>) {
        loads.clear();
        for &index in &self.network.lines {
            let (line, position) = (&self.model.lines[index], &state.lines[index].position);
            if !line.drifts(self.model) {
                continue;
            }
            for i in 0..position.len() {
                loads.extend(drag_at_rest(line, position, i, stream).iter());
            }
        }
    }

    /// Sets the loads of the assembly; returns the sum of their magnitudes [N].
    fn put_loads(&self, loads: &[f64], work: &mut Workspace) -> f64 {
        let mut nodes = loads.chunks(3).map(Vector3::from_column_slice);
        let mut sum = 0.0;
        for &index in &self.network.lines {
            for (own, load) in work.lines[index].load.iter_mut().zip(nodes.by_ref()) {
                *own = load;
                sum += load.norm();
            }
        }
        sum
    }
}
