//! moorline as a C library: `moorline_c`, with the header `include/moorline.h`, which cbindgen generates from these files.
//!
//! [`session`] is the mooring that a host drives, in safe code. Every C function translates one call to it: [`life`] (load, start, step, save),
//! [`table`] (variables by name and reference), [`bodies`] (bodies, lines, stiffness). [`edge`] contains handles, messages and pointers.

mod bodies;
pub mod codes;
mod edge;
mod life;
mod session;
mod table;
