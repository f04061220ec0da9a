//! Statics: equilibrium, stiffness and natural modes of a mooring.

pub mod beam;
pub use crate::physics::catenary;
pub mod catenary_network;
pub mod equilibrium;
pub(crate) mod guess;
pub mod modes;
pub mod stiffness;

/// Reason why no equilibrium was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StaticsError {
    /// A softening strain measure carries no more load.
    #[error(
        "line \"{line}\", segment {segment}: no stable equilibrium above {percent:.4} % of the loads: the stretch reaches \
         strain {strain:.4}, and this logarithmic measure carries less and less beyond strain {limit_strain:.4}; lower the load, \
         or raise axial_stiffness, or use a strain measure without a limit",
        percent = 100.0 * load_fraction
    )]
    LimitLoad {
        /// Name of the line.
        line: String,
        /// Most stretched segment, from 0 at end A.
        segment: usize,
        /// Strain of that segment at the maximum load with an equilibrium [-].
        strain: f64,
        /// Strain at which the force of the measure is largest [-].
        limit_strain: f64,
        /// Maximum load with an equilibrium, relative to the full load [-].
        load_fraction: f64,
    },
    /// The iteration ended without an equilibrium.
    #[error(
        "{place}: no equilibrium found in {iterations} solves: {residual:.3e} N are out of balance, {tolerance:.3e} N would be \
         allowed; {advice}"
    )]
    NotConverged {
        /// Location of the largest imbalance: line and node, or point.
        place: String,
        /// Out-of-balance force there [N].
        residual: f64,
        /// Accepted out-of-balance force [N].
        tolerance: f64,
        /// Linear solves spent [-].
        iterations: usize,
        /// Advice.
        advice: &'static str,
    },
    /// The iteration ended in a shape that is in balance but not stable.
    #[error(
        "line \"{line}\": no stable equilibrium found in {iterations} solves: the last shape is in balance, but any disturbance moves it away; \
         {advice}"
    )]
    Unstable {
        /// Name of the line, or of the first line of its network.
        line: String,
        /// Linear solves spent [-].
        iterations: usize,
        /// Advice.
        advice: &'static str,
    },
    /// The search for the equilibrium of a beam ended without one.
    #[error(
        "line \"{line}\", node {node}: no equilibrium of the beam found in {iterations} solves, {residual:.3e} N are out of balance; \
         use more elements, start it from a shape closer to rest, hold its ends, or `run` it from its `initial` shape"
    )]
    BeamNotConverged {
        /// Name of the line.
        line: String,
        /// Node with the largest imbalance, from 0 at end A.
        node: usize,
        /// Out-of-balance force there [N].
        residual: f64,
        /// Linear solves spent [-].
        iterations: usize,
    },
    /// Forces act on a beam that is not held.
    #[error(
        "line \"{line}\": no equilibrium: nothing holds this beam, and {residual:.3e} N are out of balance; hold an end of it, or `run` it \
         from its `initial` shape"
    )]
    BeamFlies {
        /// Name of the line.
        line: String,
        /// Largest out-of-balance force [N].
        residual: f64,
    },
    /// A moment on the end of a beam has an axial part, and no end is clamped.
    #[error(
        "line \"{line}\": no equilibrium was found: the moment on its ends has a part of {torque:.3e} N m along the beam, which turns it about its axis, since \
         neither end is clamped; clamp one, give a moment across the beam, or `run` it from its `initial` shape"
    )]
    BeamSpins {
        /// Name of the line.
        line: String,
        /// Axial part of the moments [N m].
        torque: f64,
    },
    /// The equilibrium of a beam bends or twists an element beyond the angle that an element resolves.
    #[error(
        "line \"{line}\", node {node}: at rest the beam turns by more than 60 degrees from this node to the next; use more elements \
         there, or a greater bending or torsional stiffness"
    )]
    BeamFolded {
        /// Name of the line.
        line: String,
        /// Node at the lower end of the element, from 0 at end A.
        node: usize,
    },
    /// An input is not a finite number.
    #[error("{place}: {value} m is not a finite position")]
    NotFinite {
        /// Name of the input.
        place: String,
        /// Value [m].
        value: f64,
    },
}
