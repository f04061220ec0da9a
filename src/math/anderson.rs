//! Anderson's acceleration of a fixed-point iteration x = g(x).
//!
//! With f_k = g(x_k) − x_k and the last m differences ΔX, ΔF of x and f,
//!
//! x_{k+1} = x_k + f_k − (ΔX + ΔF) γ,   γ = argmin |f_k − ΔF γ|,
//!
//! by modified Gram-Schmidt from the newest difference to the oldest; differences that add no direction are left out.
//!
//! Source: Walker & Ni (2011), SIAM J. Numer. Anal. 49(4), 1715-1735, section 2. On a linear problem the method is equivalent to GMRES and does not
//! require the plain iteration to converge.

/// Minimum norm of the part of a difference ΔF orthogonal to the newer ones, relative to |ΔF|, for which the difference is used [-].
const INDEPENDENT: f64 = 1e-9;

/// State of the iteration: the last iterate and the differences before it.
#[derive(Debug, Clone, Default)]
pub struct Anderson {
    /// x and f of the last call.
    last: Option<[Vec<f64>; 2]>,
    /// ΔX and ΔF, the newest last.
    differences: Vec<[Vec<f64>; 2]>,
    /// Maximum number of differences kept [-].
    depth: usize,
}

impl Anderson {
    /// Returns an accelerator that keeps at most `depth` differences [-].
    pub fn new(depth: usize) -> Anderson {
        Anderson {
            depth,
            ..Anderson::default()
        }
    }

    /// Replaces x by the next iterate; `image` is g(x).
    pub fn step(&mut self, x: &mut [f64], image: &[f64]) {
        let f: Vec<f64> = image.iter().zip(&*x).map(|(g, x)| g - x).collect();
        if let Some([x_last, f_last]) = &self.last {
            let less = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
            if self.differences.len() == self.depth {
                self.differences.remove(0);
            }
            self.differences.push([less(x, x_last), less(&f, f_last)]);
        }
        self.last = Some([x.to_vec(), f.clone()]);
        let mut basis: Vec<[Vec<f64>; 2]> = Vec::with_capacity(self.differences.len());
        let mut rest = f.clone();
        for difference in self.differences.iter().rev() {
            let [mut dx, mut df] = difference.clone();
            let size = norm(&df);
            for [along_x, along_f] in &basis {
                let share = dot(along_f, &df);
                subtract(&mut df, share, along_f);
                subtract(&mut dx, share, along_x);
            }
            let across = norm(&df);
            if across <= INDEPENDENT * size || across == 0.0 {
                continue;
            }
            for value in dx.iter_mut().chain(&mut df) {
                *value /= across;
            }
            let share = dot(&df, &rest);
            subtract(&mut rest, share, &df);
            subtract(x, share, &dx);
            basis.push([dx, df]);
        }
        for (x, rest) in x.iter_mut().zip(&rest) {
            *x += rest;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn subtract(from: &mut [f64], share: f64, what: &[f64]) {
    for (from, what) in from.iter_mut().zip(what) {
        *from -= share * what;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_iteration_that_diverges_is_solved_in_as_many_steps_as_it_has_unknowns_and_two() {
        // g(x) = A x + b with eigenvalues up to −6
        let rows = [[-6.0, 1.0, 0.0], [0.5, 3.0, -0.2], [0.0, 0.7, 0.4]];
        let b = [1.0, -2.0, 0.5];
        let image = |x: &[f64]| -> Vec<f64> {
            let row = |i: usize| dot(&rows[i], x) + b[i];
            (0..3).map(row).collect()
        };
        let (mut x, mut anderson) = (vec![0.0; 3], Anderson::new(5));
        for _ in 0..5 {
            let g = image(&x);
            anderson.step(&mut x, &g);
        }
        let g = image(&x);
        assert!(x.iter().zip(&g).all(|(x, g)| (x - g).abs() < 1e-9), "{x:?}");
    }

    #[test]
    fn a_fixed_point_stays() {
        let (mut x, mut anderson) = (vec![2.0, 3.0], Anderson::new(3));
        for _ in 0..4 {
            let image = x.clone();
            anderson.step(&mut x, &image);
        }
        assert_eq!(x, [2.0, 3.0]);
    }
}
