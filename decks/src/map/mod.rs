//! MAP++ input files.
//!
//! text -> [`deck`] (typed rows) -> [`build`] (a scene). MAP++ is quasi-static and leaves depth, density and gravity to its
//! host: its files contain no damping, drag or added mass that MAP++ uses.
//!
//! Rules: a header is a line that contains `---`; the two lines below it are not read; `#` before a number marks an unknown, found by
//! iteration; `depth` means the z of the seabed; options are `key value …`, and a line of options that begins with a blank is
//! a comment. Source: the MAP++ documentation, "Input File".

mod build;
mod deck;

use moorline::scene::AngleOrder;

use crate::Supplement;
use crate::draft::Draft;
use crate::findings::Findings;

pub(crate) use deck::is_deck;

/// Reads a deck; `supplement` contains the values that it leaves to its host.
pub(crate) fn read<'s>(text: &str, supplement: &'s Supplement) -> Draft<'s> {
    let mut findings = Findings::default();
    let deck = deck::read(text, &mut findings);
    let mut draft = Draft::new("MAP++", findings, supplement, AngleOrder::Zyx);
    if draft.findings.mistakes.is_empty() {
        build::build(&deck, &mut draft);
    }
    draft
}
