//! Boundary of the FMU library and the C libraries: what crosses from a host to safe Rust and back.
//!
//! * [`guard`]: a panic becomes a message;
//! * `aside`: worker threads that do not keep an unloaded library mapped;
//! * [`handles`]: numbers in place of pointers, so that a handle that was closed is refused and never followed;
//! * [`pointers`]: slices and texts from the host's pointers.
//!
//! `aside` and [`pointers`] are the unsafe modules.
#![warn(unreachable_pub)]

#[cfg(unix)]
mod aside;
pub mod guard;
pub mod handles;
pub mod pointers;
