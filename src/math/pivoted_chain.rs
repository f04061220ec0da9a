//! Block-tridiagonal systems of 6×6 blocks, with row exchanges inside the blocks.
//!
//! Row i reads L_{i−1} x_{i−1} + D_i x_i + U_i x_{i+1} = b_i; blocks need not be symmetric. Elimination runs from the first node
//! to the last: D_i ← D_i − L_{i−1} D_{i−1}⁻¹ U_{i−1}, each D_i by LU factors with partial pivoting.
//!
//! Source: block Thomas algorithm, e.g. Golub & Van Loan, Matrix Computations, section 4.5. Valid where all leading block minors
//! are regular: chains held from either end, and chains with mass, are of that kind.

use nalgebra::{Matrix6, Vector6};

/// A system, and after [`PivotedChain::solve`] its solution.
#[derive(Debug, Clone, Default)]
pub struct PivotedChain {
    /// D: blocks of every node on itself.
    pub diagonal: Vec<Matrix6<f64>>,
    /// U: in the row of a node, the column of the next one.
    pub upper: Vec<Matrix6<f64>>,
    /// L: in the row of the next node, the column of the one before.
    pub lower: Vec<Matrix6<f64>>,
    /// Right-hand side, then solution.
    pub right: Vec<Vector6<f64>>,
    factors: Vec<Lu6>,
}

/// LU factors of a 6×6 block with row exchanges.
#[derive(Debug, Clone, Copy, Default)]
struct Lu6 {
    /// Rows of the factors: L below the diagonal, the inverse pivots on it, U above.
    rows: [[f64; 6]; 6],
    /// Rows of the block in the order of the factors.
    order: [usize; 6],
}

impl Lu6 {
    /// Factors of a block; `None` where it is singular.
    fn new(block: &Matrix6<f64>) -> Option<Lu6> {
        let mut rows = rows(block);
        let mut order = [0, 1, 2, 3, 4, 5];
        for k in 0..6 {
            let greater = |a: usize, b: usize| if rows[b][k].abs() > rows[a][k].abs() { b } else { a };
            let greatest = (k + 1..6).fold(k, greater);
            rows.swap(k, greatest);
            order.swap(k, greatest);
            let pivot = rows[k][k];
            if pivot == 0.0 || !pivot.is_finite() {
                return None;
            }
            rows[k][k] = 1.0 / pivot;
            let above = rows[k];
            for row in &mut rows[k + 1..] {
                let factor = row[k] * above[k];
                row[k] = factor;
                for j in k + 1..6 {
                    row[j] -= factor * above[j];
                }
            }
        }
        Some(Lu6 { rows, order })
    }

    /// Solves for rows of right-hand sides.
    #[inline(always)]
    fn solve<const N: usize>(&self, b: &[[f64; N]; 6]) -> [[f64; N]; 6] {
        let mut x = [[0.0; N]; 6];
        for i in 0..6 {
            let mut row = b[self.order[i]];
            for (factor, known) in self.rows[i][..i].iter().zip(&x) {
                subtract(&mut row, *factor, known);
            }
            x[i] = row;
        }
        for i in (0..6).rev() {
            let mut row = x[i];
            for (factor, known) in self.rows[i].iter().zip(&x).skip(i + 1) {
                subtract(&mut row, *factor, known);
            }
            x[i] = row.map(|x| x * self.rows[i][i]);
        }
        x
    }

    fn solve_vector(&self, b: &Vector6<f64>) -> Vector6<f64> {
        let mut rows = [[0.0]; 6];
        for (row, b) in rows.iter_mut().zip(b.iter()) {
            row[0] = *b;
        }
        let x = self.solve(&rows);
        Vector6::new(x[0][0], x[1][0], x[2][0], x[3][0], x[4][0], x[5][0])
    }

    fn solve_block(&self, block: &mut Matrix6<f64>) {
        let x = self.solve(&rows(block));
        for (i, row) in x.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                block[(i, j)] = *x;
            }
        }
    }
}

#[inline(always)]
fn subtract<const N: usize>(row: &mut [f64; N], factor: f64, other: &[f64; N]) {
    for (x, y) in row.iter_mut().zip(other) {
        *x -= factor * y;
    }
}

/// Rows of a block.
#[inline(always)]
fn rows(block: &Matrix6<f64>) -> [[f64; 6]; 6] {
    let mut rows = [[0.0; 6]; 6];
    for (i, row) in rows.iter_mut().enumerate() {
        for (j, x) in row.iter_mut().enumerate() {
            *x = block[(i, j)];
        }
    }
    rows
}

impl PivotedChain {
    /// Room for a chain of `nodes` nodes.
    pub fn new(nodes: usize) -> PivotedChain {
        PivotedChain {
            diagonal: vec![Matrix6::zeros(); nodes],
            upper: vec![Matrix6::zeros(); nodes.saturating_sub(1)],
            lower: vec![Matrix6::zeros(); nodes.saturating_sub(1)],
            right: vec![Vector6::zeros(); nodes],
            factors: vec![Lu6::default(); nodes],
        }
    }

    /// Sets everything to zero.
    pub fn clear(&mut self) {
        self.diagonal.fill(Matrix6::zeros());
        self.upper.fill(Matrix6::zeros());
        self.lower.fill(Matrix6::zeros());
        self.right.fill(Vector6::zeros());
    }

    /// Holds one unknown of a node: it takes the value `value`.
    pub fn hold(&mut self, node: usize, unknown: usize, value: f64) {
        self.diagonal[node].row_mut(unknown).fill(0.0);
        self.diagonal[node][(unknown, unknown)] = 1.0;
        self.right[node][unknown] = value;
        if let Some(upper) = self.upper.get_mut(node) {
            upper.row_mut(unknown).fill(0.0);
        }
        if node > 0 {
            self.lower[node - 1].row_mut(unknown).fill(0.0);
        }
    }

    /// Solves in place; false where a block is singular or the solution is not finite.
    pub fn solve(&mut self) -> bool {
        for i in 0..self.diagonal.len() {
            if i > 0 {
                self.diagonal[i] -= self.lower[i - 1] * self.upper[i - 1];
            }
            let Some(factors) = Lu6::new(&self.diagonal[i]) else {
                return false;
            };
            self.factors[i] = factors;
            if let Some(upper) = self.upper.get_mut(i) {
                factors.solve_block(upper);
            }
        }
        self.solve_again()
    }

    /// Solves for another right-hand side, after [`PivotedChain::solve`]; false where the solution is not finite.
    pub fn solve_again(&mut self) -> bool {
        let nodes = self.diagonal.len();
        for i in 0..nodes {
            if i > 0 {
                let known = self.right[i - 1];
                self.right[i] -= self.lower[i - 1] * known;
            }
            self.right[i] = self.factors[i].solve_vector(&self.right[i]);
        }
        for i in (0..nodes.saturating_sub(1)).rev() {
            let next = self.right[i + 1];
            self.right[i] -= self.upper[i] * next;
        }
        self.right.iter().all(|block| block.iter().all(|x| x.is_finite()))
    }

    /// Sets the right-hand side to zero.
    pub fn clear_right(&mut self) {
        self.right.fill(Vector6::zeros());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::{DMatrix, DVector};

    /// A repeatable number in −1 … 1.
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn random(nodes: usize) -> PivotedChain {
        let mut seed = 3;
        let mut chain = PivotedChain::new(nodes);
        let mut block = || Matrix6::from_fn(|_, _| noise(&mut seed));
        chain.upper.iter_mut().for_each(|u| *u = block());
        chain.lower.iter_mut().for_each(|l| *l = block());
        chain.diagonal.iter_mut().for_each(|d| *d = block());
        chain
            .right
            .iter_mut()
            .for_each(|b| *b = block().column(0).into_owned());
        for d in &mut chain.diagonal {
            d[(0, 0)] = 0.0; // only an exchange of rows gets past it
        }
        chain
    }

    fn dense(chain: &PivotedChain) -> (DMatrix<f64>, DVector<f64>) {
        let nodes = chain.diagonal.len();
        let mut matrix = DMatrix::zeros(6 * nodes, 6 * nodes);
        let mut right = DVector::zeros(6 * nodes);
        for i in 0..nodes {
            matrix
                .fixed_view_mut::<6, 6>(6 * i, 6 * i)
                .copy_from(&chain.diagonal[i]);
            right.fixed_rows_mut::<6>(6 * i).copy_from(&chain.right[i]);
            if i + 1 < nodes {
                matrix
                    .fixed_view_mut::<6, 6>(6 * i, 6 * i + 6)
                    .copy_from(&chain.upper[i]);
                matrix
                    .fixed_view_mut::<6, 6>(6 * i + 6, 6 * i)
                    .copy_from(&chain.lower[i]);
            }
        }
        (matrix, right)
    }

    fn assert_solves(mut chain: PivotedChain) -> PivotedChain {
        let (matrix, right) = dense(&chain);
        let reference = matrix.lu().solve(&right).unwrap();
        assert!(chain.solve());
        for (i, block) in chain.right.iter().enumerate() {
            assert_relative_eq!(
                *block,
                reference.fixed_rows::<6>(6 * i).into_owned(),
                epsilon = 1e-10
            );
        }
        chain
    }

    #[test]
    fn unsymmetric_blocks_with_zeros_on_the_diagonal_are_solved() {
        for nodes in [1, 2, 3, 8] {
            assert_solves(random(nodes));
        }
    }

    #[test]
    fn a_held_unknown_takes_its_value() {
        let mut chain = random(4);
        chain.hold(0, 3, 0.25);
        chain.hold(2, 1, -0.5);
        let chain = assert_solves(chain);
        assert_relative_eq!(chain.right[0][3], 0.25, epsilon = 1e-14);
        assert_relative_eq!(chain.right[2][1], -0.5, epsilon = 1e-14);
    }

    #[test]
    fn a_singular_block_is_reported() {
        let mut chain = random(3);
        chain.diagonal[0].fill(0.0);
        assert!(!chain.solve());
    }
}
