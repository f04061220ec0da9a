//! Equilibria: assembled elements, closed forms of lines and networks, meshes, vessel stiffness, random lines.

#[path = "../common/mod.rs"]
mod common;

mod catenary;
mod equilibrium;
mod mesh;
mod ordinary;
mod quasi_static;
mod vessel_stiffness;
