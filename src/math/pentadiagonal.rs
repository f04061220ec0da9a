//! Direct solution of a chain of 3×3 blocks that couples second neighbours too, whose two ends hang on a small dense system.
//!
//! B_{i-1} x_{i-1} + D_i x_i + A_i x_{i+1} + F_{i-2}ᵀ x_{i-2} + F_i x_{i+2} = b_i: the next neighbour by the blocks above and
//! below the diagonal, the second neighbour by one block, transposed on the way back. [`Chain::eliminate`] removes the nodes
//! between the ends in order and leaves the ends' own 2 × 2 blocks, as [`super::block_tridiagonal`] does for chains that
//! couple neighbours only; the first end is a border that every node comes to couple with, the last end is the last node.
//!
//! Source: Golub & Van Loan (2013), Matrix Computations, 4th ed., section 4.3.5 (band Gaussian elimination), on blocks.
//! Row exchanges, where they are asked for, stay inside of blocks.

use nalgebra::{Matrix3, Vector3};

use super::block_tridiagonal::{Ends, Lu3, Pivots};

/// The blocks of a chain of n nodes.
#[derive(Debug, Clone, Copy)]
pub struct Blocks<'a> {
    /// D_i: n blocks of nodes on themselves.
    pub diagonal: &'a [Matrix3<f64>],
    /// A_i: n − 1 blocks in the row of node i and the column of node i + 1.
    pub above: &'a [Matrix3<f64>],
    /// B_i: n − 1 blocks in the row of node i + 1 and the column of node i.
    pub below: &'a [Matrix3<f64>],
    /// F_i: n − 2 blocks in the row of node i and the column of node i + 2.
    pub far: &'a [Matrix3<f64>],
}

/// Scratch of one chain; never read before it is written.
#[derive(Debug, Clone)]
pub struct Chain {
    /// D_i⁻¹ times the blocks on nodes i + 1, i + 2 and the first end.
    eliminated: Vec<[Matrix3<f64>; 3]>,
    /// D_i⁻¹ b_i, then the solution.
    solution: Vec<Vector3<f64>>,
    bordered: bool,
}

/// A row that is not eliminated yet, as far as earlier nodes have changed it.
#[derive(Clone, Copy)]
struct Row {
    /// On itself.
    own: Matrix3<f64>,
    /// On the next node.
    next: Matrix3<f64>,
    /// On the node before.
    last: Matrix3<f64>,
    /// On the first end.
    first: Matrix3<f64>,
    /// Of the first end on this node.
    border: Matrix3<f64>,
    /// Right-hand side.
    right: Vector3<f64>,
}

impl Row {
    /// Row `i` as it is given; nothing beyond the last.
    #[inline(always)]
    fn new(blocks: &Blocks, right: &[Vector3<f64>], i: usize) -> Row {
        let zero = Matrix3::zeros();
        let (first, border) = match i {
            1 => (blocks.below[0], blocks.above[0]),
            2 => (blocks.far[0].transpose(), blocks.far[0]),
            _ => (zero, zero),
        };
        let at = |blocks: &[Matrix3<f64>], i: usize| blocks.get(i).copied().unwrap_or(zero);
        Row {
            own: at(blocks.diagonal, i),
            next: at(blocks.above, i),
            last: at(blocks.below, i - 1),
            first,
            border,
            right: right.get(i).copied().unwrap_or_else(Vector3::zeros),
        }
    }
}

impl Chain {
    /// Scratch for a chain of `nodes` nodes, ends included.
    pub fn new(nodes: usize) -> Chain {
        Chain {
            eliminated: vec![[Matrix3::zeros(); 3]; nodes],
            solution: vec![Vector3::zeros(); nodes],
            bordered: false,
        }
    }

    /// Removes the nodes between the ends; `None` if a pivot cannot be taken. Where the first end is held
    /// (`first_free` false), only bb and b of the result are meaningful.
    pub fn eliminate(
        &mut self,
        blocks: Blocks,
        right: &[Vector3<f64>],
        first_free: bool,
        pivots: Pivots,
    ) -> Option<Ends> {
        let last = blocks.diagonal.len() - 1;
        self.bordered = first_free;
        let (mut corner, mut corner_right) = (blocks.diagonal[0], right[0]);
        let mut row = Row::new(&blocks, right, 1);
        let mut after = if last > 1 {
            Row::new(&blocks, right, 2)
        } else {
            row
        };
        for i in 1..last {
            let mut beyond = Row::new(&blocks, right, i + 2);
            let given = blocks.far.get(i).copied().unwrap_or_else(Matrix3::zeros);
            let back = given.transpose();
            let pivot = Lu3::new(&row.own, pivots)?;
            let (next, far) = (pivot.solve3(&row.next), pivot.solve3(&given));
            let solution = pivot.solve(row.right);
            after.own -= after.last * next;
            after.next -= after.last * far;
            after.right -= after.last * solution;
            beyond.last -= back * next;
            beyond.own -= back * far;
            beyond.right -= back * solution;
            if first_free {
                let first = pivot.solve3(&row.first);
                corner -= row.border * first;
                corner_right -= row.border * solution;
                after.first -= after.last * first;
                after.border -= row.border * next;
                beyond.first -= back * first;
                beyond.border -= row.border * far;
                self.eliminated[i][2] = first;
            }
            (self.eliminated[i][0], self.eliminated[i][1]) = (next, far);
            self.solution[i] = solution;
            (row, after) = (after, beyond);
        }
        Some(Ends {
            aa: corner,
            ab: row.border,
            ba: row.first,
            bb: row.own,
            a: corner_right,
            b: row.right,
        })
    }

    /// The whole solution, ends included, from that of the ends; after [`Chain::eliminate`].
    pub fn substitute(&mut self, a: Vector3<f64>, b: Vector3<f64>) {
        let last = self.solution.len() - 1;
        (self.solution[0], self.solution[last]) = (a, b);
        for i in (1..last).rev() {
            let [next, far, first] = &self.eliminated[i];
            let mut x = self.solution[i] - next * self.solution[i + 1];
            if i + 2 <= last {
                x -= far * self.solution[i + 2];
            }
            if self.bordered {
                x -= first * a;
            }
            self.solution[i] = x;
        }
    }

    /// The solution, one block per node.
    pub fn solution(&self) -> &[Vector3<f64>] {
        &self.solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::block_tridiagonal::DenseSystem;
    use approx::assert_relative_eq;

    /// A repeatable number in −1 … 1.
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    struct System {
        diagonal: Vec<Matrix3<f64>>,
        above: Vec<Matrix3<f64>>,
        below: Vec<Matrix3<f64>>,
        far: Vec<Matrix3<f64>>,
        right: Vec<Vector3<f64>>,
    }

    impl System {
        fn random(nodes: usize) -> System {
            let mut seed = 11;
            let mut matrix = || Matrix3::from_fn(|_, _| noise(&mut seed));
            let mut matrices = |count: usize| (0..count).map(|_| matrix()).collect::<Vec<_>>();
            System {
                above: matrices(nodes - 1),
                below: matrices(nodes - 1),
                far: matrices(nodes.saturating_sub(2)),
                right: matrices(nodes).iter().map(|m| m.column(0).into_owned()).collect(),
                diagonal: matrices(nodes)
                    .iter()
                    .map(|m| m + Matrix3::identity() * 14.0)
                    .collect(),
            }
        }

        fn blocks(&self) -> Blocks<'_> {
            Blocks {
                diagonal: &self.diagonal,
                above: &self.above,
                below: &self.below,
                far: &self.far,
            }
        }

        /// The whole chain as one dense system.
        fn dense(&self) -> DenseSystem {
            let mut dense = DenseSystem::new(self.diagonal.len());
            for (i, block) in self.diagonal.iter().enumerate() {
                dense.add_block(i, i, block);
                dense.add_right(i, self.right[i]);
            }
            for (i, (above, below)) in self.above.iter().zip(&self.below).enumerate() {
                dense.add_block(i, i + 1, above);
                dense.add_block(i + 1, i, below);
            }
            for (i, block) in self.far.iter().enumerate() {
                dense.add_block(i, i + 2, block);
                dense.add_block(i + 2, i, &block.transpose());
            }
            dense
        }
    }

    #[test]
    fn elimination_equals_the_dense_solution_with_free_ends() {
        for nodes in [2, 3, 4, 5, 12] {
            let system = System::random(nodes);
            let mut reference = system.dense();
            assert!(reference.solve(Pivots::Positive));
            let mut chain = Chain::new(nodes);
            let ends = chain
                .eliminate(system.blocks(), &system.right, true, Pivots::Positive)
                .unwrap();
            let mut points = DenseSystem::new(2);
            for (row, column, block) in [(0, 0, ends.aa), (0, 1, ends.ab), (1, 0, ends.ba), (1, 1, ends.bb)] {
                points.add_block(row, column, &block);
            }
            points.add_right(0, ends.a);
            points.add_right(1, ends.b);
            assert!(points.solve(Pivots::Positive));
            chain.substitute(points.solution(0), points.solution(1));
            for i in 0..nodes {
                assert_relative_eq!(chain.solution()[i], reference.solution(i), epsilon = 1e-13);
            }
        }
    }

    #[test]
    fn elimination_equals_the_dense_solution_with_held_ends() {
        for nodes in [3, 4, 9] {
            let system = System::random(nodes);
            let mut reference = system.dense();
            for axis in 0..3 {
                reference.hold(0, axis);
                reference.hold(nodes - 1, axis);
            }
            assert!(reference.solve(Pivots::Positive));
            let mut chain = Chain::new(nodes);
            assert!(
                chain
                    .eliminate(system.blocks(), &system.right, false, Pivots::Positive)
                    .is_some()
            );
            chain.substitute(Vector3::zeros(), Vector3::zeros());
            for i in 0..nodes {
                assert_relative_eq!(chain.solution()[i], reference.solution(i), epsilon = 1e-13);
            }
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_is_reported() {
        let mut system = System::random(6);
        system.diagonal[3] = -Matrix3::identity();
        let mut chain = Chain::new(6);
        assert!(
            chain
                .eliminate(system.blocks(), &system.right, true, Pivots::Positive)
                .is_none()
        );
    }
}
