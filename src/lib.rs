//! Mooring-line dynamics.
#![forbid(unsafe_code)]

pub mod dynamics;
pub mod math;
pub mod model;
pub mod physics;
pub mod scene;
pub mod statics;
