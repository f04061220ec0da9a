//! Central differences for checking the slopes of laws.

use std::fmt::Debug;
use std::ops::{Div, Sub};

use approx::{AbsDiffEq, assert_relative_eq};
use nalgebra::{Matrix3, Vector3};

/// Central difference, with a step h, of a function of a displacement.
pub(crate) fn central<T>(h: f64, f: impl Fn(f64) -> T) -> T
where
    T: Sub<Output = T> + Div<f64, Output = T> + Debug + AbsDiffEq,
{
    (f(h) - f(-h)) / (2.0 * h)
}

/// Central difference, with a step h, of a function of a displacement along an axis.
pub(crate) fn along<T>(axis: usize, h: f64, f: impl Fn(Vector3<f64>) -> T) -> T
where
    T: Sub<Output = T> + Div<f64, Output = T> + Debug + AbsDiffEq,
{
    central(h, |h| f(h * Vector3::ith(axis, 1.0)))
}

/// Asserts that the columns of a matrix are the central differences of a vector with respect to its argument.
pub(crate) fn assert_columns(
    slope: &Matrix3<f64>,
    h: f64,
    epsilon: f64,
    f: impl Fn(Vector3<f64>) -> Vector3<f64>,
) {
    for axis in 0..3 {
        assert_relative_eq!(
            slope.column(axis).into_owned(),
            along(axis, h, &f),
            epsilon = epsilon
        );
    }
}
