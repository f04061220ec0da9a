//! Numbers and vectors that a pointwise law is written for: single ones, or those in the lanes of a vector of the machine.

use std::ops::{Add, Mul, Sub};

use nalgebra::Vector3;

use super::lanes::{Lanes, Vectors};

/// A number, or one in every lane.
pub trait Real: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same value in every lane.
    fn splat(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// 1/x.
    fn recip(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// The greater of two, lane by lane; `other` where either is not a number.
    fn max(self, other: Self) -> Self;
}

/// A vector in space, or one in every lane.
pub trait RealVector: Copy + Add<Output = Self> + Sub<Output = Self> {
    /// Components and products.
    type Real: Real;
    /// Scalar product. The name leaves nalgebra's `dot`, which takes a reference, unambiguous.
    fn inner(self, other: Self) -> Self::Real;
    /// The vector times a factor.
    fn scaled(self, factor: Self::Real) -> Self;
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
}
