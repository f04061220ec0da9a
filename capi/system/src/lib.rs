//! Mooring behind the interface of MoorDyn, based on moorline's simulation.
//!
//! [`System`] reads a deck and numbers bodies, rods, points and lines as the deck does. Its coupled degrees of freedom are six for
//! every coupled body, then three for every coupled point, in the deck's order. Angles follow MoorDyn: the rotation of a body is
//! R = Rx(roll) Ry(pitch) Rz(yaw). No physics is computed here: positions, tensions and forces come from [`moorline`].
//!
//! Source of names and meaning: headers and documentation of MoorDyn 2.7; of its behaviour: runs of the package `moordyn`.
//!
//! | module | content |
//! |---|---|
//! | [`deck`] | deck → scene with the laws of such codes; objects and degrees of freedom in the deck's order |
//! | [`system`] | create, start, step |
//! | [`objects`], [`nodes`], [`water`] | quantities of bodies, points and rods; of the nodes of lines; of water and seabed |
//! | [`edits`] | changes of lines before the start, and their detachment |
//! | [`saved`] | state as bytes and files |
//! | [`channels`] | files of output channels |
//! | [`log`] | messages to console and file |
#![warn(unreachable_pub)]

pub mod channels;
pub mod deck;
pub mod edits;
pub mod failure;
pub mod log;
pub mod nodes;
pub mod objects;
pub mod saved;
pub mod settings;
pub mod system;
pub mod water;

pub use failure::{Code, Failure};
pub use system::System;
