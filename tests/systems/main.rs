//! Whole mooring systems: kinds that are built, promised errors, an experiment, hosts at the edge, unfriendly scenes.

#[path = "../common/mod.rs"]
mod common;

mod experiment;
mod hard;
mod host_edge;
mod kinds;
mod promise;
mod robustness;
