//! Whole mooring systems: typical systems, error claims, an experiment, extreme hosts, difficult scenes.

#[path = "../common/mod.rs"]
mod common;

mod experiment;
mod hard;
mod host_edge;
mod kinds;
mod promise;
mod robustness;
