//! Block-tridiagonal systems of 6×6 blocks, with row exchanges within the blocks that need them.
//!
//! Row i reads L_{i−1} x_{i−1} + D_i x_i + U_i x_{i+1} = b_i; blocks need not be symmetric. Elimination runs from the first node to the last: D_i ←
//! D_i − L_{i−1} D_{i−1}⁻¹ U_{i−1}. A block is inverted in place in vector operations, with the pivots on its diagonal. If a pivot is small compared
//! with its column, LU factors with partial pivoting give the inverse instead. An inverse takes one product per right-hand side; factors take two
//! substitutions of dependent steps.
//!
//! Source: block Thomas algorithm, e.g. Golub & Van Loan, Matrix Computations, section 4.5. Valid where all leading block minors are regular, as in
//! chains held at either end and in chains with mass.

use std::ops::{AddAssign, Index, IndexMut};

use nalgebra::Vector6;
use pulp::NullaryFnOnce;

use super::lanes::{LANES, Lanes};
use super::triad::each;
use super::unit::VectorUnit;

/// Largest multiple of a pivot row subtracted from another row without row exchanges [-].
const MULTIPLE_MAX: f64 = 1e3;

/// Block-tridiagonal system; contains the solution after [`PivotedChain::solve`].
#[derive(Debug, Clone, Default)]
pub struct PivotedChain {
    /// D: diagonal block of every node, then its inverse.
    pub diagonal: Vec<Block>,
    /// U: blocks in the row of a node and the column of the next one.
    pub upper: Vec<Block>,
    /// L: blocks in the row of the next node and the column of the one before.
    pub lower: Vec<Block>,
    /// Right-hand side, then solution.
    pub right: Vec<Vector6<f64>>,
}

/// Six numbers in two vectors; the last two lanes are 0.
type Column = [Lanes; 2];

/// A 6×6 block by columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block([Column; 6]);

/// Four 6×6 blocks side by side, by columns.
pub type BlockLanes = [[Lanes; 6]; 6];

impl Block {
    /// Block of zeros.
    pub fn zeros() -> Block {
        Block([[Lanes::splat(0.0); 2]; 6])
    }

    /// The block of one lane of [`BlockLanes`].
    #[inline(always)]
    pub fn of_lane(columns: &BlockLanes, lane: usize) -> Block {
        Block(each!(j in [0, 1, 2, 3, 4, 5] => {
            let [a, b, c, d, e, f] = each!(i in [0, 1, 2, 3, 4, 5] => columns[j][i][lane]);
            [Lanes::new([a, b, c, d]), Lanes::new([e, f, 0.0, 0.0])]
        }))
    }

    /// Product with a column of numbers.
    #[inline(always)]
    fn times(&self, x: &Column) -> Column {
        let [a, b, c, d, e, f] = each!(j in [0, 1, 2, 3, 4, 5] => {
            let factor = Lanes::splat(x[j / LANES][j % LANES]);
            [self.0[j][0] * factor, self.0[j][1] * factor]
        });
        each!(half in [0, 1] => {
            ((a[half] + b[half]) + (c[half] + d[half])) + (e[half] + f[half])
        })
    }

    #[inline(always)]
    fn product(&self, other: &Block) -> Block {
        Block(each!(j in [0, 1, 2, 3, 4, 5] => self.times(&other.0[j])))
    }

    /// Inverse; `None` where the block is singular.
    #[inline(always)]
    fn inverse(&self) -> Option<Block> {
        let mut inverse = *self;
        let mut multiple = Lanes::splat(0.0);
        let mut is_sound = inverse.pivot::<0>(&mut multiple);
        is_sound &= inverse.pivot::<1>(&mut multiple);
        is_sound &= inverse.pivot::<2>(&mut multiple);
        is_sound &= inverse.pivot::<3>(&mut multiple);
        is_sound &= inverse.pivot::<4>(&mut multiple);
        is_sound &= inverse.pivot::<5>(&mut multiple);
        let is_small = (Lanes::splat(MULTIPLE_MAX) - multiple).all_positive();
        if is_sound && is_small {
            return Some(inverse);
        }
        self.inverse_with_exchanges()
    }

    /// Step `K` of the inversion in place; raises `multiple` to the size of the entries below the pivot relative to the pivot. Returns whether the
    /// pivot has an inverse.
    #[inline(always)]
    fn pivot<const K: usize>(&mut self, multiple: &mut Lanes) -> bool {
        let inverse = 1.0 / self.0[K][K / LANES][K % LANES];
        let factor = Lanes::splat(inverse);
        let mut pivot = [self.0[K][0] * factor, self.0[K][1] * factor];
        for (half, scaled) in pivot.iter().enumerate() {
            let below = Lanes::new(each!(lane in [0, 1, 2, 3] => {
                if LANES * half + lane > K { scaled[lane] } else { 0.0 }
            }));
            *multiple = multiple.max(below.abs());
        }
        pivot[K / LANES][K % LANES] = inverse;
        for j in (0..6).filter(|&j| j != K) {
            let column = &mut self.0[j];
            let share = column[K / LANES][K % LANES];
            let lanes = Lanes::splat(share);
            *column = [column[0] - pivot[0] * lanes, column[1] - pivot[1] * lanes];
            column[K / LANES][K % LANES] = -share * inverse;
        }
        self.0[K] = pivot;
        inverse.is_finite()
    }

    /// Inverse by LU factors with partial pivoting; `None` where the block is singular.
    #[cold]
    #[inline(never)]
    fn inverse_with_exchanges(&self) -> Option<Block> {
        let mut rows: [[f64; 12]; 6] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                if j < 6 {
                    self[(i, j)]
                } else {
                    f64::from(u8::from(i + 6 == j))
                }
            })
        });
        for k in 0..6 {
            let greater = |a: usize, b: usize| if rows[b][k].abs() > rows[a][k].abs() { b } else { a };
            let greatest = (k + 1..6).fold(k, greater);
            rows.swap(k, greatest);
            let pivot = rows[k];
            if pivot[k] == 0.0 || !pivot[k].is_finite() {
                return None;
            }
            for row in &mut rows[k + 1..] {
                let factor = row[k] / pivot[k];
                (k..12).for_each(|j| row[j] -= factor * pivot[j]);
            }
        }
        let mut inverse = Block::zeros();
        for j in 0..6 {
            for i in (0..6).rev() {
                let known: f64 = (i + 1..6).map(|k| rows[i][k] * inverse[(k, j)]).sum();
                inverse[(i, j)] = (rows[i][6 + j] - known) / rows[i][i];
            }
        }
        Some(inverse)
    }

    fn clear_row(&mut self, row: usize) {
        (0..6).for_each(|column| self[(row, column)] = 0.0);
    }
}

#[inline(always)]
fn less(a: &Column, b: &Column) -> Column {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline(always)]
fn column(v: &Vector6<f64>) -> Column {
    [
        Lanes::new([v[0], v[1], v[2], v[3]]),
        Lanes::new([v[4], v[5], 0.0, 0.0]),
    ]
}

#[inline(always)]
fn vector(c: &Column) -> Vector6<f64> {
    Vector6::new(c[0][0], c[0][1], c[0][2], c[0][3], c[1][0], c[1][1])
}

impl Index<(usize, usize)> for Block {
    type Output = f64;
    #[inline(always)]
    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self.0[column][row / LANES][row % LANES]
    }
}

impl IndexMut<(usize, usize)> for Block {
    #[inline(always)]
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut f64 {
        &mut self.0[column][row / LANES][row % LANES]
    }
}

impl AddAssign for Block {
    #[inline(always)]
    fn add_assign(&mut self, other: Block) {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a = [a[0] + b[0], a[1] + b[1]];
        }
    }
}

impl PivotedChain {
    /// Zero system for a chain of `nodes` nodes.
    pub fn new(nodes: usize) -> PivotedChain {
        PivotedChain {
            diagonal: vec![Block::zeros(); nodes],
            upper: vec![Block::zeros(); nodes.saturating_sub(1)],
            lower: vec![Block::zeros(); nodes.saturating_sub(1)],
            right: vec![Vector6::zeros(); nodes],
        }
    }

    /// Sets everything to zero.
    pub fn clear(&mut self) {
        self.diagonal.fill(Block::zeros());
        self.upper.fill(Block::zeros());
        self.lower.fill(Block::zeros());
        self.clear_right();
    }

    /// Sets the right-hand side to zero.
    pub fn clear_right(&mut self) {
        self.right.fill(Vector6::zeros());
    }

    /// Fixes one unknown of a node at `value`.
    pub fn hold(&mut self, node: usize, unknown: usize, value: f64) {
        self.diagonal[node].clear_row(unknown);
        self.diagonal[node][(unknown, unknown)] = 1.0;
        self.right[node][unknown] = value;
        if let Some(upper) = self.upper.get_mut(node) {
            upper.clear_row(unknown);
        }
        if node > 0 {
            self.lower[node - 1].clear_row(unknown);
        }
    }

    /// Solves in place; returns false if a block is singular or the solution is not finite.
    pub fn solve(&mut self) -> bool {
        VectorUnit::best().dispatch(Solve {
            chain: self,
            factorise: true,
        })
    }

    /// Solves as [`PivotedChain::solve`] does, then corrects the solution once by its residual (iterative refinement). Inverted blocks that are much
    /// stiffer in some directions than in others, as in the statics of a slender beam, otherwise leave a residual well above rounding.
    pub fn solve_refined(&mut self) -> bool {
        let system = self.clone();
        if !self.solve() {
            return false;
        }
        let solution = std::mem::replace(&mut self.right, system.right);
        for i in 0..solution.len() {
            let x = column(&solution[i]);
            let mut left = less(&column(&self.right[i]), &system.diagonal[i].times(&x));
            if i > 0 {
                left = less(&left, &system.lower[i - 1].times(&column(&solution[i - 1])));
            }
            if let Some(upper) = system.upper.get(i) {
                left = less(&left, &upper.times(&column(&solution[i + 1])));
            }
            self.right[i] = vector(&left);
        }
        let is_finite = self.solve_again();
        self.right
            .iter_mut()
            .zip(&solution)
            .for_each(|(x, first)| *x += first);
        is_finite
    }

    /// Solves for another right-hand side, after [`PivotedChain::solve`]; returns false if the solution is not finite.
    pub fn solve_again(&mut self) -> bool {
        VectorUnit::best().dispatch(Solve {
            chain: self,
            factorise: false,
        })
    }

    /// Inverts the diagonal blocks and replaces those above by D⁻¹ U; returns false if a block is singular.
    #[inline(always)]
    fn factorise(&mut self) -> bool {
        for i in 0..self.diagonal.len() {
            if i > 0 {
                let known = self.lower[i - 1].product(&self.upper[i - 1]);
                for (own, known) in self.diagonal[i].0.iter_mut().zip(&known.0) {
                    *own = less(own, known);
                }
            }
            let Some(inverse) = self.diagonal[i].inverse() else {
                return false;
            };
            self.diagonal[i] = inverse;
            if let Some(upper) = self.upper.get_mut(i) {
                *upper = inverse.product(upper);
            }
        }
        true
    }

    /// Solves with the inverses; returns false if the solution is not finite.
    #[inline(always)]
    fn substitute(&mut self) -> bool {
        let nodes = self.diagonal.len();
        let mut last: Column = [Lanes::splat(0.0); 2];
        for i in 0..nodes {
            let mut right = column(&self.right[i]);
            if i > 0 {
                right = less(&right, &self.lower[i - 1].times(&last));
            }
            last = self.diagonal[i].times(&right);
            self.right[i] = vector(&last);
        }
        for i in (0..nodes.saturating_sub(1)).rev() {
            last = less(&column(&self.right[i]), &self.upper[i].times(&last));
            self.right[i] = vector(&last);
        }
        self.right.iter().all(|block| block.iter().all(|x| x.is_finite()))
    }
}

/// Kernel that solves a chain, with new factors or the existing ones.
struct Solve<'a> {
    chain: &'a mut PivotedChain,
    factorise: bool,
}

impl NullaryFnOnce for Solve<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        (!self.factorise || self.chain.factorise()) && self.chain.substitute()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::{DMatrix, DVector};

    fn filled(mut number: impl FnMut() -> f64) -> Block {
        let mut block = Block::zeros();
        (0..36).for_each(|k| block[(k % 6, k / 6)] = number());
        block
    }

    /// Pseudo-random number in −1 … 1.
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn random(nodes: usize) -> PivotedChain {
        let mut seed = 3;
        let mut chain = PivotedChain::new(nodes);
        let mut block = || filled(|| noise(&mut seed));
        chain.upper.iter_mut().for_each(|u| *u = block());
        chain.lower.iter_mut().for_each(|l| *l = block());
        chain.diagonal.iter_mut().for_each(|d| *d = block());
        chain.right.iter_mut().for_each(|b| *b = vector(&block().0[0]));
        for d in &mut chain.diagonal {
            d[(0, 0)] = 0.0; // requires a row exchange
        }
        chain
    }

    fn dense(chain: &PivotedChain) -> (DMatrix<f64>, DVector<f64>) {
        let nodes = chain.diagonal.len();
        let mut matrix = DMatrix::zeros(6 * nodes, 6 * nodes);
        let mut right = DVector::zeros(6 * nodes);
        for i in 0..nodes {
            right.fixed_rows_mut::<6>(6 * i).copy_from(&chain.right[i]);
            let mut copy = |row: usize, column: usize, block: &Block| {
                for (r, c) in (0..36).map(|k| (k % 6, k / 6)) {
                    matrix[(6 * row + r, 6 * column + c)] = block[(r, c)];
                }
            };
            copy(i, i, &chain.diagonal[i]);
            if i + 1 < nodes {
                copy(i, i + 1, &chain.upper[i]);
                copy(i + 1, i, &chain.lower[i]);
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
    fn a_refined_solution_is_exact_in_directions_of_small_stiffness() {
        let mut chain = random(8);
        let axis = Vector6::new(0.6, -0.2, 0.5, 0.3, -0.4, 0.1).normalize();
        for block in &mut chain.diagonal {
            for (i, j) in (0..36).map(|k| (k % 6, k / 6)) {
                block[(i, j)] += 1e10 * axis[i] * axis[j];
            }
        }
        let (matrix, right) = dense(&chain);
        let error = |chain: &PivotedChain| {
            let found = chain.right.iter().flat_map(|block| block.iter().copied());
            let found = DVector::from_iterator(48, found);
            (&right - &matrix * &found).amax() / (1e10 * found.amax())
        };
        let mut plain = chain.clone();
        assert!(plain.solve() && chain.solve_refined());
        assert!(error(&plain) > 4.0 * f64::EPSILON);
        assert!(error(&chain) < 4.0 * f64::EPSILON);
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
        chain.diagonal[0] = Block::zeros();
        assert!(!chain.solve());
    }
}
