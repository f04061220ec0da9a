//! MAP++ input files.
//!
//! text -> [`deck`] (typed rows) -> [`build`] (a scene). MAP++ is quasi-static and leaves depth, density and gravity to its
//! host: nothing in a file speaks of damping, drag or added mass that MAP++ would use.
//!
//! Rules: a header is a line that holds `---`; two lines below it are never read; a number may be preceded by `#` (found by
//! iteration); `depth` stands for the seabed's z; options are `key value …`, and a line of options that begins with a blank is
//! a comment. Source: the MAP++ documentation, "Input File".

mod build;
mod deck;

use moorline::scene::AngleOrder;

use crate::Supplement;
use crate::draft::Draft;
use crate::findings::Findings;

pub(crate) use deck::is_deck;

/// Reads a deck with what it leaves to its host.
pub(crate) fn read<'s>(text: &str, supplement: &'s Supplement) -> Draft<'s> {
    let mut findings = Findings::default();
    let deck = deck::read(text, &mut findings);
    let mut draft = Draft::new("MAP++", findings, supplement, AngleOrder::Zyx);
    if draft.findings.mistakes.is_empty() {
        build::build(&deck, &mut draft);
    }
    draft
}
