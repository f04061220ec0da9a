//! Number and vector types of pointwise laws: single values, or one value in every lane of a machine vector.

use std::ops::{Add, Mul, Sub};

use nalgebra::Vector3;

use super::lanes::{Lanes, Vectors};

/// Single number, or a number in every lane.
pub trait Real: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same value in every lane.
    fn splat(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// 1/x.
    fn recip(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// The larger of two, lane by lane; `other` where either is NaN.
    fn max(self, other: Self) -> Self;
    /// `yes` where this is positive, else `no`.
    fn choose(self, yes: Self, no: Self) -> Self;
    /// Returns whether any lane is positive.
    fn any_positive(self) -> bool;
}

/// Single vector in space, or a vector in every lane.
pub trait RealVector: Copy + Add<Output = Self> + Sub<Output = Self> {
    /// Type of components and products.
    type Real: Real;
    /// Scalar product, named to avoid ambiguity with nalgebra's `dot`, which takes a reference.
    fn inner(self, other: Self) -> Self::Real;
    /// The vector times a factor.
    fn scaled(self, factor: Self::Real) -> Self;
    /// Vector product.
    fn crossed(self, other: Self) -> Self;
    /// Components along x, y and z.
    fn components(self) -> [Self::Real; 3];
    /// Vector with these components along x, y and z.
    fn of(components: [Self::Real; 3]) -> Self;
}

/// `yes` where the gate is positive, else `no`.
#[inline(always)]
pub fn choose<V: RealVector>(gate: V::Real, yes: V, no: V) -> V {
    let (yes, no) = (yes.components(), no.components());
    V::of([
        gate.choose(yes[0], no[0]),
        gate.choose(yes[1], no[1]),
        gate.choose(yes[2], no[2]),
    ])
}

impl Real for f64 {
    #[inline(always)]
    fn splat(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn recip(self) -> f64 {
        f64::recip(self)
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }

    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn choose(self, yes: f64, no: f64) -> f64 {
        if self > 0.0 { yes } else { no }
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        self > 0.0
    }
}

impl RealVector for Vector3<f64> {
    type Real = f64;

    #[inline(always)]
    fn inner(self, other: Vector3<f64>) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Vector3<f64> {
        self * factor
    }

    #[inline(always)]
    fn crossed(self, other: Vector3<f64>) -> Vector3<f64> {
        self.cross(&other)
    }

    #[inline(always)]
    fn components(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    #[inline(always)]
    fn of(components: [f64; 3]) -> Vector3<f64> {
        components.into()
    }
}

impl Real for Lanes {
    #[inline(always)]
    fn splat(value: f64) -> Lanes {
        Lanes::splat(value)
    }

    #[inline(always)]
    fn sqrt(self) -> Lanes {
        Lanes::sqrt(self)
    }

    #[inline(always)]
    fn recip(self) -> Lanes {
        Lanes::recip(self)
    }

    #[inline(always)]
    fn abs(self) -> Lanes {
        Lanes::abs(self)
    }

    #[inline(always)]
    fn max(self, other: Lanes) -> Lanes {
        Lanes::max(self, other)
    }

    #[inline(always)]
    fn choose(self, yes: Lanes, no: Lanes) -> Lanes {
        Lanes::choose(self, yes, no)
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        Lanes::any_positive(self)
    }
}

impl RealVector for Vectors {
    type Real = Lanes;

    #[inline(always)]
    fn inner(self, other: Vectors) -> Lanes {
        Vectors::dot(self, other)
    }

    #[inline(always)]
    fn scaled(self, factor: Lanes) -> Vectors {
        Vectors::scale(self, factor)
    }

    #[inline(always)]
    fn crossed(self, other: Vectors) -> Vectors {
        Vectors {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    #[inline(always)]
    fn components(self) -> [Lanes; 3] {
        [self.x, self.y, self.z]
    }

    #[inline(always)]
    fn of([x, y, z]: [Lanes; 3]) -> Vectors {
        Vectors { x, y, z }
    }
}
