//! Approximate cost of steps, for the choices that depend on it: the cheapest integrator of a network, and the use of
//! threads.
//!
//! Times per node, as the bench `step` measures them on whole communication steps of short lines; choices need their
//! ratios and orders of magnitude only.

use crate::model::{Line, Model, Network};
use crate::scene::Integrator;
use crate::statics::catenary_network;

/// Time of an explicit step at a node [ns].
const EXPLICIT: f64 = 12.0;
/// Time of an axial-implicit step at a node [ns].
const AXIAL_IMPLICIT: f64 = 36.0;
/// Time of a fully implicit step at a node [ns].
const IMPLICIT: f64 = 600.0;
/// Time of a step of a beam at a node [ns].
const BEAM: f64 = 4000.0;
/// Time of an equilibrium at a node, where there is no closed form [ns].
const EQUILIBRIUM: f64 = 1500.0;
/// Time of a closed-form catenary at a node [ns].
const CATENARY: f64 = 100.0;

/// Cost of a step of generalised-α over that of an explicit one [-].
pub const IMPLICIT_COST: f64 = IMPLICIT / EXPLICIT;
/// Cost of an axial-implicit step over that of an explicit one for choices without trials, which cannot judge the error of longer steps [-].
pub(super) const AXIAL_IMPLICIT_COST: f64 = AXIAL_IMPLICIT / EXPLICIT;
/// Cost of an axial-implicit step over that of an explicit one as measured, of lines over a seabed and of others [-].
const AXIAL_IMPLICIT_COSTS: [f64; 2] = [2.4, 3.0];
/// Time to sum a wave component at a node [ns].
pub(super) const COMPONENT: f64 = 5.0;

/// Cost of an axial-implicit step of lines over that of an explicit one as measured [-]. Contact with the seabed costs both about the same.
pub fn axial_implicit_cost<'a>(mut lines: impl Iterator<Item = &'a Line>) -> f64 {
    let [over_seabed, without] = AXIAL_IMPLICIT_COSTS;
    match lines.any(|line| line.nodes.contact.is_some()) {
        true => over_seabed,
        false => without,
    }
}

/// Time of a step at a node of a network [ns].
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
