//! MoorDyn input files, version 1 and 2, in the styles of OpenFAST and of MoorDyn-C.
//!
//! text -> [`sections`] (rows under headers) -> [`tables`], [`options`] (typed cells) -> [`deck`] -> [`build`] (a scene).
//! [`refusals`] holds what a deck can say and moorline cannot model, a function for every feature; [`traps`] what is often
//! misread. Each stage reports all of its mistakes, and the next begins only where there are none.
//!
//! Rules: a header is a line that holds `---`, told by the words in it; two lines below the header of a table name columns
//! and units and are never read; columns count by their place; `#` begins a comment; options are `value key`.
//! Source: the parsers of OpenFAST (`modules/moordyn/src/MoorDyn.f90`) and MoorDyn-C (`source/MoorDyn2.cpp`), and the input
//! file documentation of MoorDyn v2.

mod build;
mod deck;
mod options;
mod refusals;
mod sections;
mod tables;
mod traps;

use std::ops::Range;

use super::rows::Findings;
use super::{Places, Reading, Supplement};

/// Whether a text is a MoorDyn file: it has a header of such files.
pub(super) fn is_deck(text: &str) -> bool {
    first_header(text).is_some()
}

/// Bytes of the first header, of the file or of a section.
pub(super) fn first_header(text: &str) -> Option<Range<usize>> {
    sections::first_header(text).map(|row| row.span())
}

/// Reads a deck. What it does not say, but its host would, comes from the supplement.
pub(super) fn read(text: &str, supplement: &Supplement) -> Reading {
    let mut findings = Findings::default();
    let mut places = Places::default();
    let sections = sections::split(text, &mut findings);
    let deck = tables::read(&sections, &mut findings);
    let mut scene = None;
    if findings.mistakes.is_empty() {
        refusals::check(&deck, &mut findings);
    }
    if findings.mistakes.is_empty() {
        traps::remark(&deck, &sections, &mut findings);
        scene = build::scene(&deck, supplement, &mut places, &mut findings);
    }
    Reading {
        format: deck.version.name(),
        scene,
        places,
        findings,
    }
}
