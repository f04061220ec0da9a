//! Direct solution of a chain of 3×3 blocks whose two ends couple to a system of points.
//!
//! B_{i−1} x_{i−1} + D_i x_i + A_i x_{i+1} + F_{i−2}ᵀ x_{i−2} + F_i x_{i+2} = b_i: segments couple a node to the next one, by the blocks above and below
//! the diagonal; joints, which involve three nodes, also couple it to the one after that, by one block and its transpose. [`Chain::eliminate`] removes the
//! nodes between the ends in order and leaves the ends' own 2 × 2 blocks, which add up over all chains that meet at a point; [`super::sparse_blocks`]
//! solves these points; [`Chain::substitute`] gives the nodes between. The first end is a border to which every node becomes coupled, the last end is the
//! last node.
//!
//! Source: Golub & Van Loan (2013), Matrix Computations, 4th ed., sections 4.3.5 (band Gaussian elimination), 4.5.1 (block tridiagonal) and 3.2 (LU).
//! Matrices that are positive definite, or close to it where damping makes them unsymmetric, need no row exchanges, and elimination fails at a pivot
//! that is not positive. Other matrices are eliminated with row exchanges within blocks, see [`Pivots`].

use nalgebra::{Matrix3, Vector3};

/// Pivots that an elimination accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pivots {
    /// Positive pivots in the given order; elimination fails at any other pivot.
    Positive,
    /// Pivots of either sign, found by row exchanges within a block; elimination fails only at a zero pivot.
    Any,
}

/// Blocks of a chain of n nodes.
#[derive(Debug, Clone, Copy)]
pub struct Blocks<'a> {
    /// D_i: n diagonal blocks.
    pub diagonal: &'a [Matrix3<f64>],
    /// A_i: n − 1 blocks in the row of node i and the column of node i + 1.
    pub above: &'a [Matrix3<f64>],
    /// B_i: n − 1 blocks in the row of node i + 1 and the column of node i.
    pub below: &'a [Matrix3<f64>],
    /// F_i: n − 2 blocks in the row of node i and the column of node i + 2; not read unless the chain is `FAR`.
    pub far: &'a [Matrix3<f64>],
}

/// Workspace of one chain, never read before it is written. In a chain that is `FAR`, nodes are also coupled to their second neighbours.
#[derive(Debug, Clone, Default)]
pub struct Chain<const FAR: bool> {
    /// Factors of the eliminated D_i; the blocks in their columns, in the rows of node i + 1 and of the first end.
    pivots: Vec<Lu3>,
    last: Vec<Matrix3<f64>>,
    border: Vec<Matrix3<f64>>,
    /// D_i⁻¹ times the blocks in the rows of the eliminated nodes, in the columns of nodes i + 1 and i + 2 and of the first end.
    next: Vec<Matrix3<f64>>,
    far: Vec<Matrix3<f64>>,
    first: Vec<Matrix3<f64>>,
    /// D_i⁻¹ b_i, then the solution.
    solution: Vec<Vector3<f64>>,
    bordered: bool,
}

/// Condensed system of a chain on its two ends: [[aa, ab], [ba, bb]] (x_a, x_b) = (a, b).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ends {
    /// Block in the row and column of the first end.
    pub aa: Matrix3<f64>,
    /// Block in the row of the first end and the column of the last.
    pub ab: Matrix3<f64>,
    /// Block in the row of the last end and the column of the first.
    pub ba: Matrix3<f64>,
    /// Block in the row and column of the last end.
    pub bb: Matrix3<f64>,
    /// Right-hand side of the first end.
    pub a: Vector3<f64>,
    /// Right-hand side of the last end.
    pub b: Vector3<f64>,
}

/// Row that is not yet eliminated, updated by the elimination of earlier nodes.
#[derive(Clone, Copy)]
struct Row {
    /// Diagonal block.
    own: Matrix3<f64>,
    /// Block in the column of the next node.
    next: Matrix3<f64>,
    /// Block in the column of the previous node.
    last: Matrix3<f64>,
    /// Block in the column of the first end.
    first: Matrix3<f64>,
    /// Block in the row of the first end and the column of this node.
    border: Matrix3<f64>,
    /// Right-hand side.
    right: Vector3<f64>,
}

impl Row {
    /// Row `i` ≥ 1 before elimination; zero beyond the last node.
    #[inline(always)]
    fn new<const FAR: bool>(blocks: &Blocks, right: &[Vector3<f64>], i: usize) -> Row {
        let zero = Matrix3::zeros();
        let (first, border) = match i {
            1 => (blocks.below[0], blocks.above[0]),
            2 if FAR => (blocks.far[0].transpose(), blocks.far[0]),
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

impl<const FAR: bool> Chain<FAR> {
    /// Workspace for a chain of `nodes` nodes, including the ends.
    pub fn new(nodes: usize) -> Chain<FAR> {
        let zeros = |count: usize| vec![Matrix3::zeros(); count];
        Chain {
            pivots: vec![Lu3::default(); nodes],
            last: zeros(nodes),
            border: zeros(nodes),
            next: zeros(nodes),
            far: zeros(if FAR { nodes } else { 0 }),
            first: zeros(nodes),
            solution: vec![Vector3::zeros(); nodes],
            bordered: false,
        }
    }

    /// Eliminates the nodes between the ends; `None` if a pivot is not accepted. Where the first end is held (`first_free` false), only bb and b of
    /// the result are meaningful.
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
        let mut row = Row::new::<FAR>(&blocks, right, 1);
        let mut after = row;
        if FAR && last > 1 {
            after = Row::new::<FAR>(&blocks, right, 2);
        }
        for i in 1..last {
            if !FAR {
                after = Row::new::<FAR>(&blocks, right, i + 1);
            }
            let pivot = Lu3::new(&row.own, pivots)?;
            let next = pivot.solve3(&row.next);
            let solution = pivot.solve(row.right);
            after.own -= after.last * next;
            after.right -= after.last * solution;
            if first_free {
                let first = pivot.solve3(&row.first);
                corner -= row.border * first;
                corner_right -= row.border * solution;
                after.first -= after.last * first;
                after.border -= row.border * next;
                self.first[i] = first;
            }
            (self.next[i], self.solution[i]) = (next, solution);
            (self.pivots[i], self.last[i], self.border[i]) = (pivot, after.last, row.border);
            if FAR {
                let mut beyond = Row::new::<FAR>(&blocks, right, i + 2);
                let given = blocks.far.get(i).copied().unwrap_or_else(Matrix3::zeros);
                let (back, far) = (given.transpose(), pivot.solve3(&given));
                after.next -= after.last * far;
                beyond.last -= back * next;
                beyond.own -= back * far;
                beyond.right -= back * solution;
                if first_free {
                    beyond.first -= back * self.first[i];
                    beyond.border -= row.border * far;
                }
                self.far[i] = far;
                (row, after) = (after, beyond);
            } else {
                row = after;
            }
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

    /// Right-hand sides of the condensed system for another right-hand side of the chain, after [`Chain::eliminate`] with the same blocks `far`.
    pub fn eliminate_right(&mut self, far: &[Matrix3<f64>], right: &[Vector3<f64>]) -> [Vector3<f64>; 2] {
        let last = right.len() - 1;
        let at = |i: usize| right.get(i).copied().unwrap_or_else(Vector3::zeros);
        let (mut corner, mut row, mut after) = (right[0], right[1], at(2));
        for i in 1..last {
            let solution = self.pivots[i].solve(row);
            after -= self.last[i] * solution;
            let mut beyond = at(i + 2);
            if let (true, Some(far)) = (FAR, far.get(i)) {
                beyond -= far.tr_mul(&solution);
            }
            if self.bordered {
                corner -= self.border[i] * solution;
            }
            self.solution[i] = solution;
            (row, after) = (after, beyond);
        }
        [corner, row]
    }

    /// Computes the whole solution from the solution at the ends, `a` and `b`, after [`Chain::eliminate`].
    pub fn substitute(&mut self, a: Vector3<f64>, b: Vector3<f64>) {
        let last = self.solution.len() - 1;
        (self.solution[0], self.solution[last]) = (a, b);
        for i in (1..last).rev() {
            let mut x = self.solution[i] - self.next[i] * self.solution[i + 1];
            if FAR && i + 2 <= last {
                x -= self.far[i] * self.solution[i + 2];
            }
            if self.bordered {
                x -= self.first[i] * a;
            }
            self.solution[i] = x;
        }
    }

    /// Solution, one vector per node.
    pub fn solution(&self) -> &[Vector3<f64>] {
        &self.solution
    }
}

/// LU factors of a 3×3 matrix, with the pivots and their inverses.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lu3 {
    /// Rows of the original matrix in the order of the factors.
    rows: [usize; 3],
    pivots: [f64; 3],
    inverse: [f64; 3],
    l: [f64; 3], // l10, l20, l21
    u: [f64; 3], // u01, u02, u12
}

impl Lu3 {
    #[inline(always)]
    pub(super) fn new(m: &Matrix3<f64>, pivots: Pivots) -> Option<Lu3> {
        match pivots {
            Pivots::Positive => Lu3::positive(m),
            Pivots::Any => Lu3::pivoted(m),
        }
    }

    #[inline(always)]
    fn positive(m: &Matrix3<f64>) -> Option<Lu3> {
        let p0 = m[(0, 0)];
        let d0 = positive(p0)?;
        let (l10, l20) = (m[(1, 0)] * d0, m[(2, 0)] * d0);
        let (u01, u02) = (m[(0, 1)], m[(0, 2)]);
        let p1 = m[(1, 1)] - l10 * u01;
        let d1 = positive(p1)?;
        let u12 = m[(1, 2)] - l10 * u02;
        let l21 = (m[(2, 1)] - l20 * u01) * d1;
        let p2 = m[(2, 2)] - l20 * u02 - l21 * u12;
        let d2 = positive(p2)?;
        Some(Lu3 {
            rows: [0, 1, 2],
            pivots: [p0, p1, p2],
            inverse: [d0, d1, d2],
            l: [l10, l20, l21],
            u: [u01, u02, u12],
        })
    }

    #[cold]
    fn pivoted(m: &Matrix3<f64>) -> Option<Lu3> {
        let (mut m, mut rows) = (*m, [0, 1, 2]);
        let mut inverse = [0.0; 3];
        for k in 0..3 {
            let greatest = (k..3).max_by(|&a, &b| m[(a, k)].abs().total_cmp(&m[(b, k)].abs()))?;
            m.swap_rows(k, greatest);
            rows.swap(k, greatest);
            inverse[k] = nonzero(m[(k, k)])?;
            for i in k + 1..3 {
                m[(i, k)] *= inverse[k];
                for j in k + 1..3 {
                    m[(i, j)] -= m[(i, k)] * m[(k, j)];
                }
            }
        }
        Some(Lu3 {
            rows,
            pivots: m.diagonal().into(),
            inverse,
            l: [m[(1, 0)], m[(2, 0)], m[(2, 1)]],
            u: [m[(0, 1)], m[(0, 2)], m[(1, 2)]],
        })
    }

    #[inline(always)]
    pub(super) fn solve(&self, b: Vector3<f64>) -> Vector3<f64> {
        let [l10, l20, l21] = self.l;
        let [u01, u02, u12] = self.u;
        let [y0, b1, b2] = self.rows.map(|row| b[row]);
        let y1 = b1 - l10 * y0;
        let y2 = b2 - l20 * y0 - l21 * y1;
        let z = y2 * self.inverse[2];
        let y = (y1 - u12 * z) * self.inverse[1];
        Vector3::new((y0 - u01 * y - u02 * z) * self.inverse[0], y, z)
    }

    /// Solves like `solve`, but divides by the pivots instead of multiplying by their reciprocals, which saves one rounding.
    pub(super) fn solve_dividing(&self, b: Vector3<f64>) -> Vector3<f64> {
        let [l10, l20, l21] = self.l;
        let [u01, u02, u12] = self.u;
        let [y0, b1, b2] = self.rows.map(|row| b[row]);
        let y1 = b1 - l10 * y0;
        let z = (b2 - l20 * y0 - l21 * y1) / self.pivots[2];
        let y = (y1 - u12 * z) / self.pivots[1];
        Vector3::new((y0 - u01 * y - u02 * z) / self.pivots[0], y, z)
    }

    #[inline(always)]
    pub(super) fn solve3(&self, b: &Matrix3<f64>) -> Matrix3<f64> {
        let column = |i: usize| self.solve(b.column(i).into_owned());
        Matrix3::from_columns(&[column(0), column(1), column(2)])
    }
}

/// 1/pivot, if the pivot is positive.
#[inline(always)]
fn positive(pivot: f64) -> Option<f64> {
    (pivot > 0.0 && pivot.is_finite()).then(|| 1.0 / pivot)
}

/// 1/pivot, if the pivot is not zero.
fn nonzero(pivot: f64) -> Option<f64> {
    (pivot != 0.0 && pivot.is_finite()).then(|| 1.0 / pivot)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use nalgebra::{DMatrix, DVector};

    /// A chain with random blocks.
    struct System<const FAR: bool> {
        diagonal: Vec<Matrix3<f64>>,
        above: Vec<Matrix3<f64>>,
        below: Vec<Matrix3<f64>>,
        far: Vec<Matrix3<f64>>,
        right: Vec<Vector3<f64>>,
    }

    impl<const FAR: bool> System<FAR> {
        fn random(nodes: usize) -> System<FAR> {
            let mut random = Random::new(11);
            let mut matrices = |count: usize, own: f64| -> Vec<Matrix3<f64>> {
                let mut matrix = || Matrix3::from_fn(|_, _| 2.0 * random.unit() - 1.0);
                (0..count).map(|_| matrix() + Matrix3::identity() * own).collect()
            };
            System {
                above: matrices(nodes - 1, 0.0),
                below: matrices(nodes - 1, 0.0),
                far: matrices(if FAR { nodes - 2 } else { 0 }, 0.0),
                right: matrices(nodes, 0.0)
                    .iter()
                    .map(|m| m.column(0).into_owned())
                    .collect(),
                diagonal: matrices(nodes, 14.0),
            }
        }

        fn eliminate(&self, chain: &mut Chain<FAR>, first_free: bool, pivots: Pivots) -> Option<Ends> {
            let blocks = Blocks {
                diagonal: &self.diagonal,
                above: &self.above,
                below: &self.below,
                far: &self.far,
            };
            chain.eliminate(blocks, &self.right, first_free, pivots)
        }

        /// The whole chain as one dense system.
        fn dense(&self) -> (DMatrix<f64>, DVector<f64>) {
            let nodes = self.diagonal.len();
            let mut matrix = DMatrix::zeros(3 * nodes, 3 * nodes);
            let mut put = |row: usize, column: usize, block: &Matrix3<f64>| {
                let mut view = matrix.fixed_view_mut::<3, 3>(3 * row, 3 * column);
                view.copy_from(block);
            };
            for (i, block) in self.diagonal.iter().enumerate() {
                put(i, i, block);
            }
            for (i, (above, below)) in self.above.iter().zip(&self.below).enumerate() {
                put(i, i + 1, above);
                put(i + 1, i, below);
            }
            for (i, far) in self.far.iter().enumerate() {
                put(i, i + 2, far);
                put(i + 2, i, &far.transpose());
            }
            let right = self.right.iter().flat_map(|block| block.iter().copied());
            (matrix, DVector::from_iterator(3 * nodes, right))
        }

        /// Maximum difference from the dense solution, with both ends free or both held.
        fn error(&self, free: bool, pivots: Pivots) -> f64 {
            let (mut matrix, mut right) = self.dense();
            let (size, nodes) = (right.len(), self.diagonal.len());
            let mut chain = Chain::new(nodes);
            let ends = self.eliminate(&mut chain, free, pivots).expect("pivots");
            let (mut a, mut b) = (Vector3::zeros(), Vector3::zeros());
            if free {
                let mut corners = DMatrix::zeros(6, 6);
                for (row, column, block) in
                    [(0, 0, ends.aa), (0, 3, ends.ab), (3, 0, ends.ba), (3, 3, ends.bb)]
                {
                    corners.fixed_view_mut::<3, 3>(row, column).copy_from(&block);
                }
                let rights = ends.a.iter().chain(ends.b.iter()).copied();
                let solved = corners
                    .lu()
                    .solve(&DVector::from_iterator(6, rights))
                    .expect("a regular matrix");
                (a, b) = (solved.fixed_rows::<3>(0).into(), solved.fixed_rows::<3>(3).into());
            } else {
                for held in [0, 1, 2, size - 3, size - 2, size - 1] {
                    matrix.row_mut(held).fill(0.0);
                    matrix[(held, held)] = 1.0;
                    right[held] = 0.0;
                }
            }
            chain.substitute(a, b);
            let exact = matrix.lu().solve(&right).expect("a regular matrix");
            let found = chain.solution().iter().enumerate();
            let difference = found.map(|(i, x)| (x - exact.fixed_rows::<3>(3 * i)).amax());
            difference.fold(0.0, f64::max) / exact.amax().max(f64::MIN_POSITIVE)
        }
    }

    fn assert_equals_the_dense_solution<const FAR: bool>(free: bool) {
        for nodes in [2, 3, 4, 5, 9, 12] {
            let error = System::<FAR>::random(nodes).error(free, Pivots::Positive);
            assert!(error < 1e-13, "{FAR}, {nodes} nodes: {error}");
        }
    }

    #[test]
    fn elimination_equals_the_dense_solution_with_free_ends() {
        assert_equals_the_dense_solution::<false>(true);
        assert_equals_the_dense_solution::<true>(true);
    }

    #[test]
    fn elimination_equals_the_dense_solution_with_held_ends() {
        assert_equals_the_dense_solution::<false>(false);
        assert_equals_the_dense_solution::<true>(false);
    }

    #[test]
    fn another_right_hand_side_is_solved_with_the_same_factors() {
        fn check<const FAR: bool>(free: bool) {
            for nodes in [2, 3, 4, 9] {
                let system = System::<FAR>::random(nodes);
                let other: Vec<_> = system.right.iter().rev().map(|b| 3.0 * b).collect();
                let changed = System {
                    right: other.clone(),
                    ..System::<FAR>::random(nodes)
                };
                let mut chains = [Chain::new(nodes), Chain::new(nodes)];
                system.eliminate(&mut chains[0], free, Pivots::Positive).unwrap();
                let ends = changed.eliminate(&mut chains[1], free, Pivots::Positive).unwrap();
                let [a, b] = chains[0].eliminate_right(&system.far, &other);
                assert!(!free || a == ends.a, "{FAR}, {nodes} nodes");
                assert_eq!(b, ends.b, "{FAR}, {nodes} nodes");
                for chain in &mut chains {
                    chain.substitute(ends.a, ends.b);
                }
                assert_eq!(chains[0].solution(), chains[1].solution());
            }
        }
        for free in [false, true] {
            check::<false>(free);
            check::<true>(free);
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_is_reported() {
        fn check<const FAR: bool>(free: bool) {
            let mut system = System::<FAR>::random(6);
            system.diagonal[3] = -Matrix3::identity();
            assert!(
                system
                    .eliminate(&mut Chain::new(6), free, Pivots::Positive)
                    .is_none()
            );
        }
        check::<false>(false);
        check::<true>(true);
    }

    #[test]
    fn with_row_exchanges_indefinite_systems_are_solved_too() {
        fn check<const FAR: bool>() {
            let mut system = System::<FAR>::random(5);
            for block in &mut system.diagonal {
                *block -= Matrix3::from_diagonal(&Vector3::new(14.0, 23.0, 14.5));
            }
            assert!(
                system
                    .eliminate(&mut Chain::new(5), true, Pivots::Positive)
                    .is_none()
            );
            let error = system.error(true, Pivots::Any);
            assert!(error < 1e-10, "{FAR}: {error}");
        }
        check::<false>();
        check::<true>();
    }
}
