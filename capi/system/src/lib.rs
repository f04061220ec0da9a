//! A mooring as the hosts of MoorDyn see it, on moorline's simulation.
//!
//! [`System`] reads a deck and counts bodies, rods, points and lines as the deck does. Its coupled degrees of freedom are, in this order, six
//! of every coupled body and three of every coupled point, each kind in the deck's order. Angles are those of MoorDyn: a body is turned by
//! R = Rx(roll) Ry(pitch) Rz(yaw). Nothing here computes physics: positions, tensions and forces are those of [`moorline`].
//!
//! Source: headers and documentation of MoorDyn 2.7 for names and meaning; its behaviour as the package `moordyn` shows it.
//!
//! | module | content |
//! |---|---|
//! | [`deck`] | deck → scene with the laws of such codes; objects and degrees of freedom in the deck's order |
//! | [`system`] | create, start, step |
//! | [`objects`], [`nodes`], [`water`] | quantities of bodies, points and rods; of the nodes of lines; of water and seabed |
//! | [`edits`] | changes of lines before the start, and their breaking off |
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
