//! Lines in words.

use super::{significant, triple};
use crate::scene::check::quantity;
use crate::scene::notes::chord;
use crate::scene::table::Choice;
use crate::scene::{InitialShape, Line, LineEnd, RestShape, Scene, Section};

impl Scene {
    pub(super) fn line_in_words(&self, line: &Line) -> String {
        let (name, from, to) = (&line.name, &line.from, &line.to);
        let sections: Vec<String> = line.sections.iter().map(section_in_words).collect();
        let start = match &line.initial {
            InitialShape::Static => "in static equilibrium".to_string(),
            InitialShape::Catenary => {
                "on the catenary between its ends (straight if there is none), at rest".to_string()
            }
            InitialShape::Straight => "straight, at rest".to_string(),
            InitialShape::Parabola(sag) => {
                format!("as a parabola with a sag of {}, at rest", quantity(*sag, "m"))
            }
            InitialShape::Nodes(_) => "at the given nodes, at rest".to_string(),
        };
        let mut parts = vec![
            format!("from {from} to {to}, {}", sections.join(", ")),
            fit_in_words(line.length(), chord(self, line).unwrap_or(0.0)),
            format!("starts {start}"),
        ];
        match (self.is_beam(line), self.bends(line)) {
            (true, _) => parts.push(format!("a beam, {}", ends_in_words(line))),
            (_, true) => parts.push(format!("has bending stiffness; {}", ends_in_words(line))),
            _ => {}
        }
        parts.extend(release_in_words(line));
        parts.extend(break_in_words(line));
        parts.extend(winch_in_words(line));
        format!("{name}: {}", parts.join("; "))
    }
}

fn section_in_words(section: &Section) -> String {
    let elements = match section.elements {
        Some(1) => " in 1 element".to_string(),
        Some(n) => format!(" in {n} elements"),
        None => String::new(),
    };
    let (length, kind) = (quantity(section.length, "m"), &section.line_type);
    format!("{length} of {kind}{elements}")
}

/// Sentence on the difference between the length of a line and the distance between its ends, both in metres.
fn fit_in_words(length: f64, chord: f64) -> String {
    let (slack, apart) = (length - chord, significant(chord));
    if slack.abs() < 1e-9 * length {
        return format!("as long as the distance between its ends, {apart} m");
    }
    let longer = if slack > 0.0 { "longer" } else { "shorter" };
    let slack = significant(slack.abs());
    format!("{slack} m {longer} than the distance between its ends, {apart} m")
}

/// Sentence on the support of the ends of a line that bends, and on its shape without bending.
fn ends_in_words(line: &Line) -> String {
    let end = |name: &str, clamp: Option<[f64; 3]>| match clamp {
        Some(along) => format!("clamped at end {name} along {}", triple(along)),
        None => format!("pinned at end {name}"),
    };
    let rest = match line.rest_shape {
        RestShape::Straight => "unbent when straight",
        RestShape::Initial => "unbent in its initial shape",
    };
    let [a, b] = [("A", line.clamped_a), ("B", line.clamped_b)].map(|(name, clamp)| end(name, clamp));
    format!("{a}, {b}; {rest}")
}

/// "end B", and the name of the point there.
fn end_of(line: &Line, end: LineEnd) -> (String, &str) {
    let point = match end {
        LineEnd::A => &line.from,
        LineEnd::B => &line.to,
    };
    (format!("end {}", end.word().to_uppercase()), point)
}

fn release_in_words(line: &Line) -> Option<String> {
    let (end, point) = end_of(line, line.release?);
    let name = &line.name;
    Some(format!(
        "{end} is released from {point} when the input {name}.release becomes true"
    ))
}

fn break_in_words(line: &Line) -> Option<String> {
    let failure = line.failure.as_ref()?;
    let (end, point) = end_of(line, failure.at);
    let tension = failure.tension.map(|tension| quantity(tension, "N"));
    let tension = tension.map(|tension| format!("at a tension of {tension}"));
    let time = failure.time.map(|time| format!("at t = {}", quantity(time, "s")));
    let when: Vec<String> = tension.into_iter().chain(time).collect();
    Some(format!("{end} breaks from {point} {}", when.join(" or ")))
}

fn winch_in_words(line: &Line) -> Option<String> {
    let winch = line.winch.as_ref()?;
    let (name, to, most) = (&line.name, &line.to, quantity(winch.length_max, "m"));
    let speed = winch.speed_max.map(|speed| quantity(speed, "m/s"));
    let speed = speed.map_or(String::new(), |speed| format!(", at no more than {speed}"));
    let path = match winch.path {
        Some(_) => " (in `run` it follows its own path)",
        None => "",
    };
    Some(format!(
        "end B is on a winch at {to}, which the input {name}.length_change drives and which pays out up to {most}{speed}{path}"
    ))
}
