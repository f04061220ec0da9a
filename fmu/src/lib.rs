//! moorline as an FMU for co-simulation: all functions of FMI 2.0 and FMI 3.0 in one library, over one safe
//! instance. Unsafe code is in [`ffi`], [`fmi2`] and [`fmi3`], and in [`moorline_boundary`].

mod ffi;
mod fmi2;
mod fmi3;
mod instance;
mod log;
mod resources;
mod saved;
mod symbols;
