//! No physics: small fixed-size algebra, block-tridiagonal and block-pentadiagonal solves, interpolation, random numbers.
pub mod anderson;
pub mod attitude;
pub mod block_tridiagonal;
pub mod elementary;
pub mod fold;
pub mod folded_tridiagonal;
pub mod hermite;
pub mod lanes;
pub mod low_pass;
pub mod pentadiagonal;
pub mod pivoted_chain;
pub mod random;
pub mod real;
pub mod rotation;
pub mod shape_preserving;
#[cfg(test)]
pub(crate) mod tests;
pub mod unit;
