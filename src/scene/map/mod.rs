//! MAP++ input files.
//!
//! text -> [`deck`] (typed rows) -> [`build`] (a scene). MAP++ is quasi-static and leaves depth, density and gravity to its
//! host: nothing in a file speaks of damping, drag or added mass that MAP++ would use.
//!
//! Rules: a header is a line that holds `---`; two lines below it are never read; a number may be preceded by `#` (found by
//! iteration); `depth` stands for the bed's z; options are `key value …`, and a line of options that begins with a blank is
//! a comment. Source: the MAP++ documentation, "Input File".

mod build;
mod deck;

use super::rows::Findings;
use super::{Places, Reading, Supplement};

pub(super) use deck::is_deck;

/// Reads a deck. What it leaves to its host comes from the supplement.
pub(super) fn read(text: &str, supplement: &Supplement) -> Reading {
    let mut findings = Findings::default();
    let mut places = Places::default();
    let deck = deck::read(text, &mut findings);
    let scene = if findings.mistakes.is_empty() {
        build::scene(&deck, supplement, &mut places, &mut findings)
    } else {
        None
    };
    Reading {
        format: "MAP++",
        scene,
        places,
        findings,
    }
}
