//! Direct solution of a tridiagonal system that is striped over lanes; all lanes eliminate their pieces at the same time.
//!
//! l_i x_{i−1} + d_i x_i + u_i x_{i+1} = b_i for i = 0 … 4m − 1. Equation i is in row i mod m, lane i / m, so that a lane holds m consecutive
//! equations and the next lane continues at its end. In the downward pass, with p the last unknown of the previous piece, every equation becomes
//!
//! x_r = g_r − s_r p − c_r x_{r+1},  c_r = u_r/δ,  s_r = −l_r s_{r−1}/δ,  g_r = (b_r − l_r g_{r−1})/δ,  δ = d_r − l_r c_{r−1},
//!
//! from x_{−1} = p. The first unknown of the piece is updated in the same pass: x_0 = G − F p + E x_r. The last equation of every piece, with these
//! two, couples the last unknowns of three pieces: a system of four, which one step of cyclic reduction splits into pairs for Cramer's rule. The x_r
//! then follow from the last row up. Systems of other sizes are padded with rows x = 0.
//!
//! The elimination has no pivoting. A = 1 + K S with a diagonal K ≥ 0 and S positive semi-definite is similar to 1 + √K S √K, whose pivots are ≥ 1 in
//! any order of elimination, and a diagonal similarity does not change pivots. In diagonally dominant matrices, the other intended kind, |δ| ≥ |d| −
//! |l|.
//!
//! Source: Wang (1981), A parallel method for tridiagonal equations, ACM Trans. Math. Softw. 7, 170-183 (partition); Polizzi & Sameh
//! (2006), A parallel hybrid banded system solver: the SPIKE algorithm, Parallel Computing 32, 177-194 (spikes, reduced system).

use super::lanes::Lanes;

/// Four equations l x_{r−1} + d x_r + u x_{r+1} = b, one of every piece. In the whole system the last u must be 0, and so must the first l unless the
/// last equation is x = 0.
#[derive(Debug, Clone, Copy)]
pub struct Equations {
    /// l [-].
    pub lower: Lanes,
    /// d [-].
    pub diagonal: Lanes,
    /// u [-].
    pub upper: Lanes,
    /// b, in the unit of x.
    pub right: Lanes,
}

impl Equations {
    /// Equations x = 0.
    pub fn unit() -> Equations {
        let zero = Lanes::splat(0.0);
        Equations {
            lower: zero,
            diagonal: Lanes::splat(1.0),
            upper: zero,
            right: zero,
        }
    }
}

/// Result of the elimination for four equations: x_r = g − s p − c x_{r+1}; and of the first unknowns of their
/// pieces, x_0 = G − F p + E x_r.
///
/// A row continues from the stored row above, because values carried from row to row in registers are not compiled to whole vectors.
#[derive(Debug, Clone, Copy)]
pub struct Eliminated {
    /// g, in the unit of x.
    known: Lanes,
    /// s [-].
    before: Lanes,
    /// c [-].
    after: Lanes,
    /// G, F and −E.
    first: [Lanes; 3],
}

impl Eliminated {
    /// State above the first row; also the initial value of workspaces, which are written before they are read.
    #[inline(always)]
    pub fn start() -> Eliminated {
        let (zero, minus) = (Lanes::splat(0.0), Lanes::splat(-1.0));
        Eliminated {
            known: zero,
            before: minus,
            after: zero,
            first: [zero, zero, minus],
        }
    }

    /// Advances to the row below, which is not the last.
    #[inline(always)]
    pub fn eliminate(&self, row: &Equations) -> Eliminated {
        let zero = Lanes::splat(0.0);
        let inverse = (row.diagonal - row.lower * self.after).recip();
        let lower = row.lower * inverse;
        let known = row.right * inverse - lower * self.known;
        let before = zero - lower * self.before;
        let after = row.upper * inverse;
        let [first_known, first_before, first_after] = self.first;
        let share = zero - first_after; // E
        Eliminated {
            known,
            before,
            after,
            first: [
                first_known + share * known,
                first_before + share * before,
                share * after,
            ],
        }
    }

    /// Advances to the last row. Returns the last unknowns of the previous pieces, and of the pieces themselves.
    #[inline(always)]
    pub fn close(&self, row: &Equations) -> (Lanes, Lanes) {
        let zero = Lanes::splat(0.0);
        let [next_known, next_before, next_after] = self.first.map(Lanes::moved_down);
        let diagonal = row.diagonal - row.lower * self.after - row.upper * next_before;
        let right = row.right - row.lower * self.known - row.upper * next_known;
        let inverse = diagonal.recip();
        let l = zero - row.lower * self.before * inverse;
        let u = zero - row.upper * next_after * inverse;
        let own = solve_four(l, u, right * inverse);
        (own.moved_up(), own)
    }

    /// x_r from the last unknowns of the previous pieces and x_{r+1}.
    #[inline(always)]
    pub fn substitute(&self, before: Lanes, after: Lanes) -> Lanes {
        self.known - self.before * before - self.after * after
    }
}

/// Solves l_i x_{i−1} + x_i + u_i x_{i+1} = b_i for the lanes i, with u_3 = 0, and l_0 = 0 or x_3 = 0.
#[inline(always)]
fn solve_four(l: Lanes, u: Lanes, b: Lanes) -> Lanes {
    let zero = Lanes::splat(0.0);
    // eliminating the adjacent unknowns leaves one other in every lane, x* two lanes further: e x + c x* = f
    let e = Lanes::splat(1.0) - l * u.moved_up() - u * l.moved_down();
    let f = b - l * b.moved_up() - u * b.moved_down();
    let c = zero - l * l.moved_up() - u * u.moved_down();
    let other = |x: Lanes| x.moved_up().moved_up();
    (f * other(e) - c * other(f)) * (e * other(e) - c * other(c)).recip()
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::math::lanes::LANES;
    use crate::math::random::Random;

    /// [l, d, u, b] of every equation.
    type System = Vec<[f64; 4]>;

    /// System of `count` equations, without couplings beyond its ends.
    fn system(count: usize, equation: impl FnMut(usize) -> [f64; 4]) -> System {
        let mut system: System = (0..count).map(equation).collect();
        (system[0][0], system[count - 1][2]) = (0.0, 0.0);
        system
    }

    fn folded(system: &System) -> Vec<f64> {
        let rows = system.len().div_ceil(LANES);
        let row = |r: usize| {
            let of = |k: usize| {
                let fill = if k == 1 { 1.0 } else { 0.0 };
                let value = |lane: usize| system.get(lane * rows + r).map_or(fill, |row| row[k]);
                Lanes::new(std::array::from_fn(value))
            };
            Equations {
                lower: of(0),
                diagonal: of(1),
                upper: of(2),
                right: of(3),
            }
        };
        let mut eliminated = vec![Eliminated::start()];
        for r in 0..rows - 1 {
            let next = eliminated[r].eliminate(&row(r));
            eliminated.push(next);
        }
        let (before, own) = eliminated[rows - 1].close(&row(rows - 1));
        let mut solution = vec![own; rows];
        for r in (0..rows - 1).rev() {
            solution[r] = eliminated[r + 1].substitute(before, solution[r + 1]);
        }
        let value = |i: usize| solution[i % rows][i / rows];
        (0..system.len()).map(value).collect()
    }

    fn dense(system: &System) -> DVector<f64> {
        let n = system.len();
        let matrix = DMatrix::from_fn(n, n, |i, k| match k + 1 {
            k if k == i => system[i][0],
            k if k == i + 1 => system[i][1],
            k if k == i + 2 => system[i][2],
            _ => 0.0,
        });
        let right = DVector::from_fn(n, |i, _| system[i][3]);
        matrix.lu().solve(&right).expect("a regular matrix")
    }

    fn error(system: &System) -> f64 {
        let exact = dense(system);
        let found = DVector::from_vec(folded(system));
        (found - &exact).amax() / exact.amax()
    }

    #[test]
    fn dominant_systems_of_any_size_are_solved_as_a_dense_solver_does() {
        let mut random = Random::new(1);
        let mut uniform = || 2.0 * random.unit() - 1.0;
        for n in 1..=200 {
            let equation = |_: usize| {
                let (l, u, b) = (uniform(), uniform(), uniform());
                [l, l.abs() + u.abs() + 0.01 + uniform().abs(), u, b]
            };
            let system = system(n, equation);
            assert!(error(&system) < 1e-13, "n = {n}: {}", error(&system));
        }
    }

    #[test]
    fn stiff_rows_among_switched_off_ones_need_no_pivot() {
        let mut random = Random::new(2);
        for n in 1..=200 {
            // 1 + K S, S the tridiagonal matrix of a chain of unit masses whose elements turn by up to 60 degrees
            let turn: Vec<f64> = (0..=n).map(|_| 0.5 + 0.5 * random.unit()).collect();
            let equation = |i: usize| {
                let k = [0.0, 1.0, 1e3, 1e6][(4.0 * random.unit()) as usize % 4];
                let b = (k + 1.0) * random.unit();
                [-k * turn[i], 1.0 + 2.0 * k, -k * turn[i + 1], b]
            };
            let system = system(n, equation);
            assert!(error(&system) < 1e-10, "n = {n}: {}", error(&system));
        }
    }

    #[test]
    fn what_lies_beyond_a_system_with_filling_is_zero() {
        let inner: System = vec![[7.0, 4.0, -1.0, 2.0]; 15];
        let mut ends = inner.clone();
        (ends[0][0], ends[14][2]) = (0.0, 0.0);
        assert_eq!(folded(&inner), folded(&ends));
    }
}
