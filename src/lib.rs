//! Mooring-line dynamics.
#![forbid(unsafe_code)]

pub mod dynamics;
pub mod interface;
pub mod math;
pub mod model;
pub mod output;
pub mod physics;
pub mod scene;
pub mod simulation;
pub mod statics;
