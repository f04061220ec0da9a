//! No physics: small fixed-size algebra, block-tridiagonal solve, interpolation.
pub mod attitude;
pub mod block_tridiagonal;
pub mod hermite;
pub mod lanes;
