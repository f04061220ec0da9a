//! When a line lets go of a point, in words.

use super::quantity;
use crate::scene::Line;
use crate::scene::channel::LineEnd;

/// `; end B lets go of fairlead when its input line1.release becomes true`; nothing where the line holds for ever.
pub(super) fn in_words(line: &Line) -> String {
    let end = |end: LineEnd| match end {
        LineEnd::A => ("A", line.from.as_str()),
        LineEnd::B => ("B", line.to.as_str()),
    };
    let mut said = String::new();
    if let Some(released) = line.release {
        let (end, point) = end(released);
        said += &format!(
            "; end {end} lets go of {point} when the input {}.release becomes true",
            line.name
        );
    }
    if let Some(parting) = &line.parting {
        let (end, point) = end(parting.at);
        let tension = parting
            .tension
            .map(|tension| format!("under {}", quantity(tension, "N")));
        let time = parting.time.map(|time| format!("at t = {}", quantity(time, "s")));
        let when: Vec<String> = tension.into_iter().chain(time).collect();
        said += &format!("; end {end} breaks off {point} {}", when.join(" or "));
    }
    said
}
