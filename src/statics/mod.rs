//! Statics: what a mooring line does when nothing moves.
#![allow(rustdoc::broken_intra_doc_links)] // [m] and [N] are units, not links

pub mod catenary;
