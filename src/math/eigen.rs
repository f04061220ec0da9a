//! Eigenvalues of sparse symmetric matrices: all of them, or the lowest by inverse subspace iteration.
//!
//! A y = λ y. With a block Q of orthonormal vectors, more than are requested, and B = (A + σI)⁻¹ by sparse Cholesky factors, every iteration computes
//! Y = B Q, solves the small problem QᵀY v = μ v, and continues from the orthonormalised Y V; λ = 1/μ − σ. Each iteration reduces the error of the
//! k-th of p vectors by the factor (λ_k + σ)/(λ_{p+1} + σ). A block finds equal eigenvalues, which are common in symmetric systems; a single Krylov
//! sequence finds only one of them.
//!
//! The shift σ raises zero eigenvalues above rounding. Valid for matrices without negative eigenvalues beyond the largest shift.
//!
//! Source: Bathe & Wilson (1976), Numerical Methods in Finite Element Analysis, section 12.4 (subspace iteration). Sparse factors are computed by the
//! crate faer. All eigenvalues are computed by QR iteration, which resolves the low ones of a stiff chain. faer's divide and conquer leaves the
//! rounding error of the largest eigenvalue in all of them: 2e-4 of the lowest for a hanging chain of 160 elements.

use faer::Side;
use faer::prelude::{Mat, Solve, SparseColMat};
use faer::sparse::Triplet;
use nalgebra::{DMatrix, SymmetricEigen};

use super::random::Random;

/// Entry of the lower triangle of a matrix: row, column and value. Entries at the same position are summed.
pub type Entry = Triplet<usize, usize, f64>;

/// Shifts σ relative to the largest diagonal entry [-], tried in this order until the Cholesky factorisation succeeds.
const SHIFTS: [f64; 4] = [1e-14, 1e-12, 1e-10, 1e-8];
/// Convergence tolerances for the change of an eigenvalue, relative to itself and to the largest diagonal entry [-]; the two are added.
const TOLERANCE: [f64; 2] = [1e-12, 1e-15];
/// Maximum number of iterations.
const ITERATIONS_MAX: usize = 300;

/// Eigenvalues in ascending order, with eigenvectors of unit length.
#[derive(Debug, Clone)]
pub struct Eigen {
    /// λ, in the unit of the matrix.
    pub values: Vec<f64>,
    vectors: Mat<f64>,
}

impl Eigen {
    /// All eigenvalues of a `size` × `size` matrix.
    pub fn all(size: usize, entries: &[Entry]) -> Eigen {
        let mut matrix = DMatrix::<f64>::zeros(size, size);
        for entry in entries {
            matrix[(entry.row, entry.col)] += entry.val;
        }
        let found = SymmetricEigen::new(matrix); // reads the lower triangle
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&i, &k| found.eigenvalues[i].total_cmp(&found.eigenvalues[k]));
        Eigen {
            values: order.iter().map(|&i| found.eigenvalues[i]).collect(),
            vectors: Mat::from_fn(size, size, |row, k| found.eigenvectors[(row, order[k])]),
        }
    }

    /// The `count` lowest eigenvalues; `None` if there are negative ones or the iteration does not converge.
    pub fn lowest(size: usize, entries: &[Entry], count: usize) -> Option<Eigen> {
        let diagonal = entries.iter().filter(|entry| entry.row == entry.col);
        let greatest = diagonal.map(|entry| entry.val.abs()).fold(0.0, f64::max);
        let factors = |part: f64| {
            let shift = (0..size).map(|i| Triplet::new(i, i, part * greatest));
            let entries: Vec<Entry> = entries.iter().copied().chain(shift).collect();
            let matrix = SparseColMat::try_new_from_triplets(size, size, &entries).ok()?;
            Some((part * greatest, matrix.sp_cholesky(Side::Lower).ok()?))
        };
        let (shift, factors) = SHIFTS.into_iter().find_map(factors)?;
        let block = (2 * count).max(count + 8).min(size);
        let mut random = Random::new(1);
        let mut vectors = Mat::from_fn(size, block, |_, _| random.unit() - 0.5);
        let mut before = vec![f64::INFINITY; count.min(size)];
        for _ in 0..ITERATIONS_MAX {
            let basis = vectors.qr().compute_thin_Q();
            vectors = basis.clone();
            factors.solve_in_place(&mut vectors);
            let small = (basis.transpose() * &vectors)
                .self_adjoint_eigen(Side::Lower)
                .ok()?;
            let inverse = small.S().column_vector().iter().rev();
            let values: Vec<f64> = inverse.map(|mu| 1.0 / mu - shift).take(before.len()).collect();
            let turned = small.U().reverse_cols();
            let mut pairs = values.iter().zip(&before);
            if pairs.all(|(now, before)| {
                (now - before).abs() <= TOLERANCE[0] * now.abs() + TOLERANCE[1] * greatest
            }) {
                let vectors = basis * turned.subcols(0, values.len());
                return Some(Eigen { values, vectors });
            }
            vectors = vectors * turned;
            before = values;
        }
        None
    }

    /// Component `row` of the eigenvector of eigenvalue number `value` [-].
    pub fn vector(&self, value: usize, row: usize) -> f64 {
        self.vectors[(row, value)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plane grid of springs held at its rim, with eigenvalues in closed form, most of them double.
    fn grid(count: usize) -> (Vec<Entry>, Vec<f64>) {
        let mut entries = Vec::new();
        for (i, k) in (0..count).flat_map(|i| (0..count).map(move |k| (i, k))) {
            let own = i * count + k;
            entries.push(Triplet::new(own, own, 4.0));
            if i > 0 {
                entries.push(Triplet::new(own, own - count, -1.0));
            }
            if k > 0 {
                entries.push(Triplet::new(own, own - 1, -1.0));
            }
        }
        let part = |i: usize| {
            let angle = std::f64::consts::PI * (i + 1) as f64 / (2 * (count + 1)) as f64;
            4.0 * angle.sin().powi(2)
        };
        let mut exact: Vec<f64> = (0..count * count)
            .map(|i| part(i / count) + part(i % count))
            .collect();
        exact.sort_by(f64::total_cmp);
        (entries, exact)
    }

    #[test]
    fn all_eigenvalues_of_a_grid_are_those_of_the_closed_form() {
        let (entries, exact) = grid(7);
        let found = Eigen::all(49, &entries);
        for (found, exact) in found.values.iter().zip(&exact) {
            assert!((found - exact).abs() < 1e-13, "{found} {exact}");
        }
    }

    #[test]
    fn the_lowest_eigenvalues_are_found_with_their_multiplicity() {
        let (entries, exact) = grid(30);
        let found = Eigen::lowest(900, &entries, 12).unwrap();
        assert_eq!(found.values.len(), 12);
        for (found, exact) in found.values.iter().zip(&exact) {
            assert!((found - exact).abs() < 1e-11 * exact, "{found} {exact}");
        }
        let unit: f64 = (0..900).map(|row| found.vector(3, row).powi(2)).sum();
        assert!((unit - 1.0).abs() < 1e-12, "{unit}");
    }

    #[test]
    fn a_matrix_without_stiffness_somewhere_has_an_eigenvalue_of_zero() {
        let chain = |i: usize| {
            [
                Triplet::new(i, i, 1.0),
                Triplet::new(i + 1, i + 1, 1.0),
                Triplet::new(i + 1, i, -1.0),
            ]
        };
        let entries: Vec<Entry> = (0..199).flat_map(chain).collect();
        let found = Eigen::lowest(200, &entries, 3).unwrap();
        assert!(
            found.values[0].abs() < 1e-12 && found.values[1] > 1e-5,
            "{:?}",
            found.values
        );
    }

    #[test]
    fn a_matrix_with_a_negative_eigenvalue_is_refused() {
        let (mut entries, _) = grid(10);
        entries.push(Triplet::new(50, 50, -5.0));
        assert!(Eigen::lowest(100, &entries, 3).is_none());
    }
}
