//! Mathematics without physics: small fixed-size algebra, banded and sparse block systems, eigenvalues, interpolation, random numbers.
pub mod anderson;
pub mod attitude;
pub mod block_banded;
pub mod circle;
pub mod eigen;
pub mod elementary;
pub mod hermite;
pub mod lanes;
pub mod low_pass;
pub mod pivoted_chain;
pub mod random;
pub mod real;
pub mod rotation;
pub mod shape_preserving;
pub mod sparse_blocks;
pub mod striped_tridiagonal;
pub mod striping;
#[cfg(test)]
pub(crate) mod tests;
pub mod triad;
pub mod unit;
