//! Boundary of the C libraries: what crosses from a host to safe Rust and back.
//!
//! * [`guard`]: a panic becomes a message;
//! * [`handles`]: numbers in place of pointers, so that a handle that was closed is refused and never followed;
//! * [`pointers`]: slices and texts from the host's pointers. This is the only unsafe module.
#![warn(unreachable_pub)]

pub mod guard;
pub mod handles;
pub mod pointers;
