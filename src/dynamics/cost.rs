//! Approximate cost of steps, on which the choice of a network's integrator and the use of threads depend.
//!
//! The times per node are those of the bench `step`, measured on whole communication steps of short lines. The choices need
//! only their ratios and orders of magnitude.

use crate::model::{Line, Model, Network};
use crate::scene::Integrator;
use crate::statics::catenary_network;

/// Time of an explicit step per node [ns].
const EXPLICIT: f64 = 12.0;
/// Time of an axial-implicit step per node [ns].
const AXIAL_IMPLICIT: f64 = 36.0;
/// Time of a fully implicit step per node [ns].
const IMPLICIT: f64 = 600.0;
/// Time of a beam step per node [ns].
const BEAM: f64 = 4000.0;
/// Time of an equilibrium without closed form, per node [ns].
const EQUILIBRIUM: f64 = 1500.0;
/// Time of a closed-form catenary per node [ns].
const CATENARY: f64 = 100.0;

/// Cost of a generalised-α step relative to an explicit one [-].
pub const IMPLICIT_COST: f64 = IMPLICIT / EXPLICIT;
/// Cost of an axial-implicit step relative to an explicit one [-]. Used without convergence trials, which would judge the error of longer steps.
pub(super) const AXIAL_IMPLICIT_COST: f64 = AXIAL_IMPLICIT / EXPLICIT;
/// Measured cost of an axial-implicit step relative to an explicit one, for lines over a seabed and for others [-].
const AXIAL_IMPLICIT_COSTS: [f64; 2] = [2.4, 3.0];
/// Time to add a wave component at a node [ns].
pub(super) const COMPONENT: f64 = 5.0;

/// Measured cost of an axial-implicit step of lines relative to an explicit one [-]. Seabed contact adds about the same cost to both.
pub fn axial_implicit_cost<'a>(mut lines: impl Iterator<Item = &'a Line>) -> f64 {
    let [over_seabed, without] = AXIAL_IMPLICIT_COSTS;
    match lines.any(|line| line.nodes.contact.is_some()) {
        true => over_seabed,
        false => without,
    }
}

/// Time of a step of a network per node [ns].
pub fn node_time(model: &Model, network: &Network, integrator: Integrator) -> f64 {
    match integrator {
        Integrator::Leapfrog | Integrator::Auto => EXPLICIT,
        Integrator::AxialImplicit => AXIAL_IMPLICIT,
        Integrator::GeneralisedAlpha | Integrator::Bossak => IMPLICIT,
        Integrator::Beam => BEAM,
        Integrator::QuasiStatic if catenary_network::serves(model, network) => CATENARY,
        Integrator::QuasiStatic => EQUILIBRIUM,
    }
}
