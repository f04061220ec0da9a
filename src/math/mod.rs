//! No physics: small fixed-size algebra, block-tridiagonal solve, interpolation.
pub mod hermite;
pub mod lanes;
