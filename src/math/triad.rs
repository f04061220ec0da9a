//! Three vectors as the columns of a 3×3 matrix, single or one in every lane.

use std::ops::{Add, Sub};

use super::real::{Real, RealVector};

/// A 3×3 matrix, or one in every lane, by its columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triad<V>(pub [V; 3]);

/// Array of the values of an expression for each item. Large closures passed to `map` are compiled as separate functions, without the vector
/// instructions of the calling function.
macro_rules! each {
    ($item:ident in [$($value:expr),+] => $result:expr) => {
        [$({
            let $item = $value;
            $result
        }),+]
    };
}
pub(crate) use each;

/// Products of the components of two vectors.
#[inline(always)]
pub fn componentwise<V: RealVector>(a: V, b: V) -> V {
    let (a, b) = (a.components(), b.components());
    V::of([a[0] * b[0], a[1] * b[1], a[2] * b[2]])
}

impl<V: RealVector> Triad<V> {
    /// Σ u_i ⊗ v_i = U Vᵀ.
    #[inline(always)]
    pub fn outer(u: &Triad<V>, v: &Triad<V>) -> Triad<V> {
        let rows = each!(i in [0, 1, 2] => v.0[i].components());
        Triad(each!(j in [0, 1, 2] => u.times(V::of([rows[0][j], rows[1][j], rows[2][j]]))))
    }

    /// u ⊗ v.
    #[inline(always)]
    pub fn dyad(u: V, v: V) -> Triad<V> {
        let v = v.components();
        Triad([u.scaled(v[0]), u.scaled(v[1]), u.scaled(v[2])])
    }

    /// Matrix with the components of a vector on its diagonal.
    #[inline(always)]
    pub fn diagonal(v: V) -> Triad<V> {
        let ([x, y, z], zero) = (v.components(), V::Real::splat(0.0));
        Triad([
            V::of([x, zero, zero]),
            V::of([zero, y, zero]),
            V::of([zero, zero, z]),
        ])
    }

    /// v̂, the matrix of v ×.
    #[inline(always)]
    pub fn skew(v: V) -> Triad<V> {
        let ([x, y, z], zero) = (v.components(), V::Real::splat(0.0));
        Triad([
            V::of([zero, z, zero - y]),
            V::of([zero - z, zero, x]),
            V::of([y, zero - x, zero]),
        ])
    }

    /// M x.
    #[inline(always)]
    pub fn times(&self, x: V) -> V {
        let x = x.components();
        self.0[0].scaled(x[0]) + self.0[1].scaled(x[1]) + self.0[2].scaled(x[2])
    }

    /// Mᵀ x.
    #[inline(always)]
    pub fn tr_times(&self, x: V) -> V {
        V::of([self.0[0].inner(x), self.0[1].inner(x), self.0[2].inner(x)])
    }

    /// M N.
    #[inline(always)]
    pub fn product(&self, other: &Triad<V>) -> Triad<V> {
        Triad(each!(j in [0, 1, 2] => self.times(other.0[j])))
    }

    /// M times a number.
    #[inline(always)]
    pub fn scaled(&self, factor: V::Real) -> Triad<V> {
        self.weighted(repeated(factor))
    }

    /// Columns times the components of a vector: M diag(v).
    #[inline(always)]
    pub fn weighted(&self, v: V) -> Triad<V> {
        let v = v.components();
        Triad(each!(i in [0, 1, 2] => self.0[i].scaled(v[i])))
    }
}

/// Vector with equal components.
#[inline(always)]
pub fn repeated<V: RealVector>(a: V::Real) -> V {
    V::of([a; 3])
}

impl<V: RealVector> Add for Triad<V> {
    type Output = Triad<V>;
    #[inline(always)]
    fn add(self, other: Triad<V>) -> Triad<V> {
        Triad(each!(i in [0, 1, 2] => self.0[i] + other.0[i]))
    }
}

impl<V: RealVector> Sub for Triad<V> {
    type Output = Triad<V>;
    #[inline(always)]
    fn sub(self, other: Triad<V>) -> Triad<V> {
        Triad(each!(i in [0, 1, 2] => self.0[i] - other.0[i]))
    }
}
