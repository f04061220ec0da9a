//! Mooring-line dynamics.
#![forbid(unsafe_code)]

pub mod scene;
