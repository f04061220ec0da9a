//! Boundary of the FMU library and the C libraries: conversions between a host and safe Rust.
//!
//! * [`guard`]: a panic becomes a message;
//! * `aside`: worker threads that do not keep an unloaded library mapped;
//! * [`handles`]: numbers instead of pointers, so that a closed handle is refused and never dereferenced;
//! * [`pointers`]: slices and texts from the host's pointers.
//!
//! `aside` and [`pointers`] are the unsafe modules.
#![warn(unreachable_pub)]

#[cfg(unix)]
mod aside;
pub mod guard;
pub mod handles;
pub mod pointers;
