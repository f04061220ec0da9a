//! Direct solution of a sparse system of 3×3 blocks with a symmetric pattern: the points at which chains meet, three
//! unknowns each.
//!
//! The points are eliminated in approximate minimum degree order. The order and the pattern of the factors are computed once (`Order`); a solve then
//! computes numbers only and does not allocate. With point k next in the order, U its blocks in the columns of the later points and L the blocks in
//! its column and their rows,
//!
//!   W_j = D_k⁻¹ U_kj,   y_k = D_k⁻¹ b_k,   A_ij ← A_ij − L_ik W_j,   b_i ← b_i − L_ik y_k,   at last x_k = y_k − Σ W_j x_j.
//!
//! Row exchanges stay within blocks, so that the signs of the pivots keep their meaning: a matrix is positive definite if all of them are positive,
//! see [`Pivots`]. Values need not be symmetric. The arithmetic is the same on every machine, for any vector width.
//!
//! Source: Davis (2006), Direct Methods for Sparse Linear Systems, chapters 4 (symbolic analysis) and 6 (LU with a symmetric pattern); Amestoy, Davis
//! & Duff (1996), SIAM J. Matrix Anal. Appl. 17, 886-905 (order). The crate faer computes order and pattern. Its numeric factors are not suitable
//! here: the Cholesky factors need symmetric values, the LU factors exchange rows between points, and the rounding of both depends on the vector unit
//! of the machine.

use std::sync::Arc;

use faer::sparse::SymbolicSparseColMat;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use nalgebra::{Matrix3, Vector3};

use super::block_banded::{Lu3, Pivots};

/// Order of elimination, and positions of the blocks of the factors.
#[derive(Debug, Default)]
struct Order {
    /// Position of every point in the order.
    place: Vec<usize>,
    /// Index of the first block below the diagonal in each column, then the total number of these blocks.
    start: Vec<usize>,
    /// Rows of the blocks below the diagonal, ascending in each column.
    rows: Vec<usize>,
    /// Index of the block that each pair of blocks in a column updates, column by column.
    targets: Vec<usize>,
}

impl Order {
    /// Order for `points` points that are coupled in `pairs`.
    fn new(points: usize, pairs: &[(usize, usize)]) -> Order {
        if points == 0 {
            return Order::default();
        }
        let pairs = pairs.iter().filter(|(a, b)| a != b);
        let upper = pairs.map(|&(a, b)| faer::sparse::Pair::new(a.min(b), a.max(b)));
        let entries: Vec<_> = upper.collect();
        let (matrix, _) = SymbolicSparseColMat::<usize>::try_new_from_indices(points, points, &entries)
            .expect("indices of points that exist");
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..Default::default()
        };
        let factor =
            factorize_symbolic_cholesky(matrix.as_ref(), faer::Side::Upper, SymmetricOrdering::Amd, params)
                .expect("memory for a pattern");
        let SymbolicCholeskyRaw::Simplicial(pattern) = factor.raw() else {
            unreachable!("a simplicial pattern is asked for");
        };
        let place = factor.perm().expect("an order").arrays().1.to_vec();
        let (mut start, mut rows) = (vec![0], Vec::new());
        for column in pattern.col_ptr().windows(2) {
            let column = &pattern.row_idx()[column[0]..column[1]];
            let own = start.len() - 1;
            rows.extend(column.iter().filter(|&&row| row != own));
            start.push(rows.len());
        }
        let mut order = Order {
            place,
            start,
            rows,
            targets: Vec::new(),
        };
        order.targets = order.find_targets();
        order
    }

    fn find_targets(&self) -> Vec<usize> {
        let mut targets = Vec::new();
        for column in self.start.windows(2) {
            let rows = &self.rows[column[0]..column[1]];
            for (i, &first) in rows.iter().enumerate() {
                targets.extend(rows[i + 1..].iter().map(|&second| self.block(second, first)));
            }
        }
        targets
    }

    /// Index of the block below the diagonal in a row and a column of the order.
    fn block(&self, row: usize, column: usize) -> usize {
        let [start, end] = [self.start[column], self.start[column + 1]];
        let found = self.rows[start..end].binary_search(&row);
        start + found.expect("a pair of points that the system was made for")
    }
}

/// System of the points at which chains meet, with three unknowns per point.
#[derive(Debug, Clone)]
pub struct PointSystem {
    order: Arc<Order>,
    /// Diagonal blocks in the order of elimination, and b, then the solution.
    diagonal: Vec<Matrix3<f64>>,
    right: Vec<Vector3<f64>>,
    /// Blocks below the diagonal, and the opposite blocks above it.
    lower: Vec<Matrix3<f64>>,
    upper: Vec<Matrix3<f64>>,
    /// Factors of the diagonal blocks at their elimination.
    pivots: Vec<Lu3>,
    /// Axes whose unknown is zero, in the order of elimination.
    held: Vec<[bool; 3]>,
}

impl PointSystem {
    /// Zero system for `points` points that are coupled in `pairs`.
    pub fn new(points: usize, pairs: &[(usize, usize)]) -> PointSystem {
        let order = Order::new(points, pairs);
        let blocks = vec![Matrix3::zeros(); order.rows.len()];
        PointSystem {
            order: Arc::new(order),
            diagonal: vec![Matrix3::zeros(); points],
            right: vec![Vector3::zeros(); points],
            lower: blocks.clone(),
            upper: blocks,
            pivots: vec![Lu3::default(); points],
            held: vec![[false; 3]; points],
        }
    }

    /// Sets everything to zero.
    pub fn clear(&mut self) {
        for blocks in [&mut self.diagonal, &mut self.lower, &mut self.upper] {
            blocks.fill(Matrix3::zeros());
        }
        self.right.fill(Vector3::zeros());
        self.held.fill([false; 3]);
    }

    /// Adds a block in the rows of point `row` and the columns of point `column`, which are the same point or one of the pairs.
    pub fn add_block(&mut self, row: usize, column: usize, block: &Matrix3<f64>) {
        let [row, column] = [row, column].map(|point| self.order.place[point]);
        match row.cmp(&column) {
            std::cmp::Ordering::Equal => self.diagonal[row] += block,
            std::cmp::Ordering::Greater => self.lower[self.order.block(row, column)] += block,
            std::cmp::Ordering::Less => self.upper[self.order.block(column, row)] += block,
        }
    }

    /// Adds to the right-hand side of point `row`.
    pub fn add_right(&mut self, row: usize, right: Vector3<f64>) {
        self.right[self.order.place[row]] += right;
    }

    /// Holds one axis of a point: its unknown becomes zero.
    pub fn hold(&mut self, point: usize, axis: usize) {
        self.held[self.order.place[point]][axis] = true;
    }

    /// Sets the right-hand side to zero, for another solution with the same blocks.
    pub fn clear_right(&mut self) {
        self.right.fill(Vector3::zeros());
    }

    /// Solves in place; returns false if a pivot is not accepted.
    pub fn solve(&mut self, pivots: Pivots) -> bool {
        self.apply_holds();
        let order = &self.order;
        let mut targets = order.targets.iter();
        for k in 0..self.diagonal.len() {
            let Some(pivot) = Lu3::new(&self.diagonal[k], pivots) else {
                return false;
            };
            self.pivots[k] = pivot;
            let column = order.start[k]..order.start[k + 1];
            for block in &mut self.upper[column.clone()] {
                *block = pivot.solve3(block);
            }
            let (lower, later_lower) = self.lower.split_at_mut(column.end);
            let (upper, later_upper) = self.upper.split_at_mut(column.end);
            let (rows, lower, upper) = (
                &order.rows[column.clone()],
                &lower[column.clone()],
                &upper[column.clone()],
            );
            for (i, &row) in rows.iter().enumerate() {
                self.diagonal[row] -= lower[i] * upper[i];
                for (j, target) in (i + 1..rows.len()).zip(&mut targets) {
                    let target = target - column.end;
                    later_lower[target] -= lower[j] * upper[i];
                    later_upper[target] -= lower[i] * upper[j];
                }
            }
        }
        self.solve_again();
        true
    }

    /// Solves for another right-hand side, after [`PointSystem::solve`] with the same blocks.
    pub fn solve_again(&mut self) {
        let order = &self.order;
        for (right, held) in self.right.iter_mut().zip(&self.held) {
            for axis in (0..3).filter(|&axis| held[axis]) {
                right[axis] = 0.0;
            }
        }
        for k in 0..self.diagonal.len() {
            let known = self.pivots[k].solve_dividing(self.right[k]);
            self.right[k] = known;
            for block in order.start[k]..order.start[k + 1] {
                self.right[order.rows[block]] -= self.lower[block] * known;
            }
        }
        for k in (0..self.diagonal.len()).rev() {
            let mut x = self.right[k];
            for block in order.start[k]..order.start[k + 1] {
                x -= self.upper[block] * self.right[order.rows[block]];
            }
            self.right[k] = x;
        }
    }

    fn apply_holds(&mut self) {
        let order = &self.order;
        for k in 0..self.held.len() {
            let own = self.held[k];
            for block in order.start[k]..order.start[k + 1] {
                let other = self.held[order.rows[block]];
                mask(&mut self.lower[block], other, own);
                mask(&mut self.upper[block], own, other);
            }
            mask(&mut self.diagonal[k], own, own);
            for axis in (0..3).filter(|&axis| own[axis]) {
                self.diagonal[k][(axis, axis)] = 1.0;
            }
        }
    }

    /// Solution at a point, after [`PointSystem::solve`].
    pub fn solution(&self, point: usize) -> Vector3<f64> {
        self.right[self.order.place[point]]
    }
}

/// Sets rows and columns of a block to zero.
fn mask(block: &mut Matrix3<f64>, rows: [bool; 3], columns: [bool; 3]) {
    for i in (0..3).filter(|&i| rows[i]) {
        block.row_mut(i).fill(0.0);
    }
    for i in (0..3).filter(|&i| columns[i]) {
        block.column_mut(i).fill(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use nalgebra::{DMatrix, DVector};

    /// Sparse system and the same system as a dense one.
    struct Both {
        sparse: PointSystem,
        matrix: DMatrix<f64>,
        right: DVector<f64>,
    }

    impl Both {
        /// A net of `count` by `count` points, neighbours coupled, with `own` on the diagonal.
        fn net(count: usize, own: f64) -> Both {
            let mut random = Random::new(5);
            let mut block =
                |own| Matrix3::from_fn(|_, _| 2.0 * random.unit() - 1.0) + Matrix3::identity() * own;
            let points = count * count;
            let along = (0..points).filter(|i| i % count + 1 < count).map(|i| (i, i + 1));
            let across = (0..points - count).map(|i| (i + count, i));
            let pairs: Vec<_> = along.chain(across).collect();
            let mut both = Both {
                sparse: PointSystem::new(points, &pairs),
                matrix: DMatrix::zeros(3 * points, 3 * points),
                right: DVector::zeros(3 * points),
            };
            for i in 0..points {
                both.add(i, i, block(own));
                let right = block(0.0).column(0).into_owned();
                both.sparse.add_right(i, right);
                both.right.fixed_rows_mut::<3>(3 * i).copy_from(&right);
            }
            for &(a, b) in &pairs {
                both.add(a, b, block(0.0));
                both.add(b, a, block(0.0));
            }
            both
        }

        fn add(&mut self, row: usize, column: usize, block: Matrix3<f64>) {
            self.sparse.add_block(row, column, &block);
            let mut view = self.matrix.fixed_view_mut::<3, 3>(3 * row, 3 * column);
            view += block;
        }

        fn hold(&mut self, point: usize, axis: usize) {
            self.sparse.hold(point, axis);
            let row = 3 * point + axis;
            self.matrix.row_mut(row).fill(0.0);
            self.matrix.column_mut(row).fill(0.0);
            self.matrix[(row, row)] = 1.0;
            self.right[row] = 0.0;
        }

        /// Maximum difference between both solutions.
        fn error(&mut self, pivots: Pivots) -> f64 {
            assert!(self.sparse.solve(pivots));
            let exact = self
                .matrix
                .clone()
                .lu()
                .solve(&self.right)
                .expect("a regular matrix");
            let points = 0..self.right.len() / 3;
            let difference = points.map(|i| self.sparse.solution(i) - exact.fixed_rows::<3>(3 * i));
            difference.map(|d| d.amax()).fold(0.0, f64::max) / exact.amax()
        }
    }

    #[test]
    fn a_net_is_solved_as_by_a_dense_solver() {
        for count in [1, 2, 3, 5, 9] {
            for pivots in [Pivots::Positive, Pivots::Any] {
                let error = Both::net(count, 14.0).error(pivots);
                assert!(error < 1e-14, "{count}: {error}");
            }
        }
    }

    #[test]
    fn a_system_is_solved_again_after_it_is_cleared() {
        let mut both = Both::net(4, 14.0);
        both.sparse.hold(3, 1);
        assert!(both.sparse.solve(Pivots::Positive));
        both.sparse.clear();
        let fresh = Both::net(4, 14.0);
        for (i, k) in (0..16).flat_map(|i| (0..16).map(move |k| (i, k))) {
            let block = fresh.matrix.fixed_view::<3, 3>(3 * i, 3 * k).into_owned();
            if block != Matrix3::zeros() {
                both.sparse.add_block(i, k, &block);
            }
        }
        (0..16).for_each(|i| {
            both.sparse
                .add_right(i, fresh.right.fixed_rows::<3>(3 * i).into_owned())
        });
        assert!(both.error(Pivots::Positive) < 1e-14);
    }

    #[test]
    fn a_held_axis_does_not_move_and_the_rest_is_solved() {
        let mut both = Both::net(5, 14.0);
        for (point, axis) in [(0, 0), (12, 0), (12, 1), (12, 2), (13, 1), (24, 2)] {
            both.hold(point, axis);
        }
        assert!(both.error(Pivots::Positive) < 1e-14);
        assert_eq!(both.sparse.solution(12), Vector3::zeros());
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_reported() {
        for point in 0..16 {
            let mut both = Both::net(4, 14.0);
            both.add(
                point,
                point,
                Matrix3::from_diagonal(&Vector3::new(0.0, -30.0, 0.0)),
            );
            assert!(!both.sparse.clone().solve(Pivots::Positive), "{point}");
            assert!(both.error(Pivots::Any) < 1e-12);
        }
    }
}
