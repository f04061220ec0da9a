//! moorline as an FMI co-simulation FMU: all functions of FMI 2.0 and of FMI 3.0 in one library, over one safe
//! instance. Unsafe code is in [`ffi`], [`fmi2`] and [`fmi3`], and in [`moorline_boundary`].

mod ffi;
mod fmi2;
mod fmi3;
mod instance;
mod log;
mod resources;
mod saved;
mod symbols;
