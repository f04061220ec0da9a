//! moorline behind the C interface of MoorDyn: a library that its hosts load in place of `libmoordyn`.
//!
//! Every function is one translation to [`moorline_system`]; the unsafe code is the translation of pointers in [`edge`] and the functions
//! themselves. The headers `include/MoorDyn.h` and `include/MoorDyn2.h` are written by cbindgen from these files.
//!
//! Names and arguments: public headers of MoorDyn 2.7; the words are moorline's own.

pub mod codes;
mod edge;
mod first;
mod handles;
mod lines;
mod objects;
mod system;
mod water;
