//! MoorDyn input files, version 1 and 2, in the styles of OpenFAST and of MoorDyn-C.
//!
//! text -> [`sections`] (rows under headers) -> [`tables`], [`options`] (typed cells) -> [`deck`] -> [`build`] (a scene).
//! [`refusals`] reports features that moorline does not model, [`traps`] entries that are often misread. Each stage reports all its mistakes,
//! and the next one runs only if there are none.
//!
//! Rules: a header is a line that contains `---`, identified by its words; the two lines below the header of a table name columns
//! and units and are not read; columns are identified by position; `#` starts a comment; options are `value key`.
//! Source: the parsers of OpenFAST (`modules/moordyn/src/MoorDyn.f90`) and MoorDyn-C (`source/MoorDyn2.cpp`), and the input
//! file documentation of MoorDyn v2.

mod build;
mod deck;
pub(crate) mod lists;
mod options;
mod refusals;
mod sections;
mod tables;
mod traps;

use moorline::scene::AngleOrder;

use crate::Supplement;
use crate::draft::Draft;
use crate::findings::Findings;

pub(crate) use sections::is_deck;

/// Reads a deck; `supplement` contains the values that it leaves to its host.
pub(crate) fn read<'s>(text: &str, supplement: &'s Supplement) -> Draft<'s> {
    let mut findings = Findings::default();
    let sections = sections::split(text, &mut findings);
    let deck = tables::read(&sections, &mut findings);
    if findings.mistakes.is_empty() {
        refusals::check(&deck, &mut findings);
    }
    let mut draft = Draft::new(deck.version.name(), findings, supplement, AngleOrder::Xyz);
    if draft.findings.mistakes.is_empty() {
        traps::remark(&deck, &sections, &mut draft.findings);
        build::build(&deck, &mut draft);
    }
    draft
}
