//! Direct solution of a chain of 3×3 blocks whose two ends hang on a small dense system.
//!
//! The chain couples node i to i − 1 and i + 1 only, and by the same block in both directions:
//! C_{i-1} x_{i-1} + D_i x_i + C_i x_{i+1} = b_i. [`Chain::eliminate`] removes the nodes between the ends (block Thomas)
//! and leaves the ends' own 2 × 2 blocks, which add up over all chains that meet in a point; [`DenseSystem`] solves these
//! points; [`Chain::substitute`] gives the nodes between.
//!
//! Source: Golub & Van Loan (2013), Matrix Computations, 4th ed., section 4.5.1 (block tridiagonal) and 3.2 (LU).
//! Matrices that are positive definite, or close to it where damping makes them unsymmetric, need no row exchanges, and a pivot that is not
//! positive is reported; others are eliminated with row exchanges inside of blocks, see [`Pivots`].

use nalgebra::{Matrix3, Vector3};

/// Which pivots an elimination takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pivots {
    /// Positive ones, as they come; any other is reported.
    Positive,
    /// Of either sign, the greatest of the rows of a block; only one that is zero is reported.
    Any,
}

/// Scratch of one chain; never read before it is written.
#[derive(Debug, Clone)]
pub struct Chain {
    /// D_i⁻¹ C_i of the eliminated nodes.
    next: Vec<Matrix3<f64>>,
    /// D_i⁻¹ times the block that couples node i to the first end.
    first: Vec<Matrix3<f64>>,
    /// D_i⁻¹ b_i, then the solution.
    solution: Vec<Vector3<f64>>,
    bordered: bool,
}

/// What remains of a chain on its two ends: [[aa, ab], [ba, bb]] (x_a, x_b) = (a, b).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ends {
    /// First end on itself.
    pub aa: Matrix3<f64>,
    /// Last end on the first.
    pub ab: Matrix3<f64>,
    /// First end on the last.
    pub ba: Matrix3<f64>,
    /// Last end on itself.
    pub bb: Matrix3<f64>,
    /// Right-hand side of the first end.
    pub a: Vector3<f64>,
    /// Right-hand side of the last end.
    pub b: Vector3<f64>,
}

impl Chain {
    /// Scratch for a chain of `nodes` nodes, ends included.
    pub fn new(nodes: usize) -> Chain {
        Chain {
            next: vec![Matrix3::zeros(); nodes],
            first: vec![Matrix3::zeros(); nodes],
            solution: vec![Vector3::zeros(); nodes],
            bordered: false,
        }
    }

    /// Removes the nodes between the ends; `None` if a pivot cannot be taken. Where the first end is held
    /// (`first_free` false), only bb and b of the result are meaningful.
    pub fn eliminate(
        &mut self,
        diagonal: &[Matrix3<f64>],
        coupling: &[Matrix3<f64>],
        right: &[Vector3<f64>],
        first_free: bool,
        pivots: Pivots,
    ) -> Option<Ends> {
        let last = diagonal.len() - 1;
        self.bordered = first_free;
        let mut ends = Ends {
            aa: diagonal[0],
            ab: coupling[0],
            ba: coupling[0],
            bb: diagonal[1],
            a: right[0],
            b: right[1],
        };
        for i in 1..last {
            let pivot = Lu3::new(&ends.bb, pivots)?;
            let c = &coupling[i];
            let next = pivot.solve3(c);
            let solution = pivot.solve(ends.b);
            if first_free {
                let first = pivot.solve3(&ends.ba);
                ends.aa -= ends.ab * first;
                ends.a -= ends.ab * solution;
                ends.ab = -(ends.ab * next);
                ends.ba = -(c * first);
                self.first[i] = first;
            }
            ends.bb = diagonal[i + 1] - c * next;
            ends.b = right[i + 1] - c * solution;
            self.next[i] = next;
            self.solution[i] = solution;
        }
        Some(ends)
    }

    /// The whole solution, ends included, from that of the ends; after [`Chain::eliminate`].
    pub fn substitute(&mut self, a: Vector3<f64>, b: Vector3<f64>) {
        let last = self.solution.len() - 1;
        self.solution[0] = a;
        self.solution[last] = b;
        for i in (1..last).rev() {
            let mut x = self.solution[i] - self.next[i] * self.solution[i + 1];
            if self.bordered {
                x -= self.first[i] * a;
            }
            self.solution[i] = x;
        }
    }

    /// The solution, one block per node.
    pub fn solution(&self) -> &[Vector3<f64>] {
        &self.solution
    }
}

/// LU factors of a 3×3 matrix; the pivots are stored inverted.
pub(super) struct Lu3 {
    /// Which rows of the matrix its rows are.
    rows: [usize; 3],
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
        let d0 = positive(m[(0, 0)])?;
        let (l10, l20) = (m[(1, 0)] * d0, m[(2, 0)] * d0);
        let (u01, u02) = (m[(0, 1)], m[(0, 2)]);
        let d1 = positive(m[(1, 1)] - l10 * u01)?;
        let u12 = m[(1, 2)] - l10 * u02;
        let l21 = (m[(2, 1)] - l20 * u01) * d1;
        let d2 = positive(m[(2, 2)] - l20 * u02 - l21 * u12)?;
        Some(Lu3 {
            rows: [0, 1, 2],
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

/// 1/pivot, if it has one.
fn nonzero(pivot: f64) -> Option<f64> {
    (pivot != 0.0 && pivot.is_finite()).then(|| 1.0 / pivot)
}

/// The dense system of the points that chains meet in, three unknowns each.
#[derive(Debug, Clone)]
pub struct DenseSystem {
    size: usize,
    matrix: Vec<f64>,
    right: Vec<f64>,
}

impl DenseSystem {
    /// Room for `points` points.
    pub fn new(points: usize) -> DenseSystem {
        let size = 3 * points;
        DenseSystem {
            size,
            matrix: vec![0.0; size * size],
            right: vec![0.0; size],
        }
    }

    /// Sets everything to zero.
    pub fn clear(&mut self) {
        self.matrix.fill(0.0);
        self.right.fill(0.0);
    }

    /// Adds a block in the rows of point `row` and the columns of point `column`.
    pub fn add_block(&mut self, row: usize, column: usize, block: &Matrix3<f64>) {
        for i in 0..3 {
            for j in 0..3 {
                self.matrix[(3 * row + i) * self.size + 3 * column + j] += block[(i, j)];
            }
        }
    }

    /// Adds to the right-hand side of point `row`.
    pub fn add_right(&mut self, row: usize, right: Vector3<f64>) {
        for i in 0..3 {
            self.right[3 * row + i] += right[i];
        }
    }

    /// Holds one axis of a point: its unknown becomes zero.
    pub fn hold(&mut self, point: usize, axis: usize) {
        let (held, size) = (3 * point + axis, self.size);
        for j in 0..size {
            self.matrix[held * size + j] = 0.0;
            self.matrix[j * size + held] = 0.0;
        }
        self.matrix[held * size + held] = 1.0;
        self.right[held] = 0.0;
    }

    /// Solves in place; false if a pivot cannot be taken.
    pub fn solve(&mut self, pivots: Pivots) -> bool {
        let n = self.size;
        for k in 0..n {
            let inverse = match pivots {
                Pivots::Positive => positive(self.matrix[k * n + k]),
                Pivots::Any => {
                    self.exchange(k);
                    nonzero(self.matrix[k * n + k])
                }
            };
            let Some(inverse) = inverse else {
                return false;
            };
            for i in k + 1..n {
                let factor = self.matrix[i * n + k] * inverse;
                if factor != 0.0 {
                    for j in k + 1..n {
                        self.matrix[i * n + j] -= factor * self.matrix[k * n + j];
                    }
                    self.right[i] -= factor * self.right[k];
                }
            }
        }
        for k in (0..n).rev() {
            let mut sum = self.right[k];
            for j in k + 1..n {
                sum -= self.matrix[k * n + j] * self.right[j];
            }
            self.right[k] = sum / self.matrix[k * n + k];
        }
        true
    }

    /// Brings the row with the greatest entry of column `k` to row `k`, of those from there on.
    fn exchange(&mut self, k: usize) {
        let n = self.size;
        let entry = |row: usize| self.matrix[row * n + k].abs();
        let greatest = (k..n).max_by(|&a, &b| entry(a).total_cmp(&entry(b)));
        let Some(greatest) = greatest.filter(|&row| row != k) else {
            return;
        };
        for column in k..n {
            self.matrix.swap(k * n + column, greatest * n + column);
        }
        self.right.swap(k, greatest);
    }

    /// Solution at a point, after [`DenseSystem::solve`].
    pub fn solution(&self, point: usize) -> Vector3<f64> {
        Vector3::from_column_slice(&self.right[3 * point..3 * point + 3])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
        coupling: Vec<Matrix3<f64>>,
        right: Vec<Vector3<f64>>,
    }

    fn random(nodes: usize) -> System {
        let mut seed = 7;
        let mut matrix = || Matrix3::from_fn(|_, _| noise(&mut seed));
        let coupling: Vec<_> = (1..nodes).map(|_| matrix()).collect();
        let diagonal = (0..nodes).map(|_| matrix() + Matrix3::identity() * 9.0).collect();
        let right = (0..nodes).map(|_| matrix().column(0).into_owned()).collect();
        System {
            diagonal,
            coupling,
            right,
        }
    }

    /// The whole chain as one dense system.
    fn dense(system: &System) -> DenseSystem {
        let mut dense = DenseSystem::new(system.diagonal.len());
        for (i, block) in system.diagonal.iter().enumerate() {
            dense.add_block(i, i, block);
            dense.add_right(i, system.right[i]);
        }
        for (i, block) in system.coupling.iter().enumerate() {
            dense.add_block(i, i + 1, block);
            dense.add_block(i + 1, i, block);
        }
        dense
    }

    #[test]
    fn elimination_equals_the_dense_solution_with_free_ends() {
        for nodes in [2, 3, 4, 9] {
            let system = random(nodes);
            let mut reference = dense(&system);
            assert!(reference.solve(Pivots::Positive));
            let mut chain = Chain::new(nodes);
            let ends = chain
                .eliminate(
                    &system.diagonal,
                    &system.coupling,
                    &system.right,
                    true,
                    Pivots::Positive,
                )
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
        let system = random(6);
        let mut reference = dense(&system);
        for (point, axis) in [0, 5].into_iter().flat_map(|p| (0..3).map(move |axis| (p, axis))) {
            reference.hold(point, axis);
        }
        assert!(reference.solve(Pivots::Positive));
        let mut chain = Chain::new(6);
        chain
            .eliminate(
                &system.diagonal,
                &system.coupling,
                &system.right,
                false,
                Pivots::Positive,
            )
            .unwrap();
        chain.substitute(Vector3::zeros(), Vector3::zeros());
        for i in 0..6 {
            assert_relative_eq!(chain.solution()[i], reference.solution(i), epsilon = 1e-13);
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_is_reported() {
        let mut system = random(5);
        system.diagonal[2] = -Matrix3::identity();
        let mut chain = Chain::new(5);
        assert!(
            chain
                .eliminate(
                    &system.diagonal,
                    &system.coupling,
                    &system.right,
                    false,
                    Pivots::Positive
                )
                .is_none()
        );
    }

    #[test]
    fn with_row_exchanges_indefinite_systems_are_solved_too() {
        let mut system = random(5);
        for block in &mut system.diagonal {
            *block -= Matrix3::from_diagonal(&Vector3::new(9.0, 18.0, 9.5));
        }
        let ends = |pivots| {
            let mut chain = Chain::new(5);
            let System {
                diagonal,
                coupling,
                right,
            } = &system;
            let ends = chain.eliminate(diagonal, coupling, right, true, pivots);
            ends.map(|ends| (chain, ends))
        };
        assert!(ends(Pivots::Positive).is_none());
        let (mut chain, ends) = ends(Pivots::Any).unwrap();
        let mut points = DenseSystem::new(2);
        points.add_block(0, 0, &ends.aa);
        points.add_block(0, 1, &ends.ab);
        points.add_block(1, 0, &ends.ba);
        points.add_block(1, 1, &ends.bb);
        points.add_right(0, ends.a);
        points.add_right(1, ends.b);
        assert!(points.solve(Pivots::Any));
        chain.substitute(points.solution(0), points.solution(1));
        let x = chain.solution();
        for i in 0..5 {
            let mut sum = system.diagonal[i] * x[i] - system.right[i];
            if i > 0 {
                sum += system.coupling[i - 1] * x[i - 1];
            }
            if i < 4 {
                sum += system.coupling[i] * x[i + 1];
            }
            assert!(sum.norm() < 1e-10, "{i}: {sum}");
        }
    }
}
