//! Kinds of lines: tension laws, bending stiffness, beams, winches, released ends.

#[path = "../common/mod.rs"]
mod common;

mod beam;
mod bending;
mod bending_against_beam;
mod line_laws;
mod release;
mod winch;
