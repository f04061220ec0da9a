//! moorline behind the C interface of MoorDyn: a library that hosts load instead of `libmoordyn`.
//!
//! Every function translates one call to [`moorline_system`]; the unsafe code is the translation of pointers in [`edge`] and the functions
//! themselves. cbindgen generates the header `include/MoorDyn2.h` from these files; `include/MoorDyn.h` includes it.
//!
//! Source of names and arguments: public headers of MoorDyn 2.7; the descriptions are moorline's own.

pub mod codes;
mod edge;
mod first;
mod handles;
mod lines;
mod objects;
mod system;
mod water;
