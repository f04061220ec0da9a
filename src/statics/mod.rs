//! Statics: what a mooring line does when nothing moves.

pub mod catenary;
