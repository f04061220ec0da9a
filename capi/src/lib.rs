//! moorline as a library for C: `moorline_c`, with the header `include/moorline.h` that cbindgen writes from these files.
//!
//! [`session`] is the mooring that a host drives, in safe code. Every function of C is one translation to it: [`life`] (load, start, step, save),
//! [`table`] (variables by name and number), [`bodies`] (bodies, lines, stiffness). [`edge`] holds handles, messages and pointers.

mod bodies;
pub mod codes;
mod edge;
mod life;
mod session;
mod table;
