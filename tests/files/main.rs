//! Files and the program: decks with files beside them, motion from the command line, files broken in every way.

#[path = "../common/mod.rs"]
mod common;

mod decks;
mod drive;
mod garbage;
