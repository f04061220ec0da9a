//! Integrators: closed forms of cable dynamics, orders of convergence, invariants, failed steps, threads and vector widths.

#[path = "../common/mod.rs"]
mod common;

mod analytic;
mod convergence;
mod coupling;
mod implicit;
mod invariants;
#[path = "../common/net.rs"]
mod net;
mod shorter_steps;
mod threads;
mod vector_unit;
