//! Refusals of features of decks that moorline does not model: one function per feature, so that each can be removed on its own.

use moorline::scene::rows::shown;

use super::build::water_file;
use super::deck::{Attachment, Deck, Property};
use crate::findings::{Findings, Placed};

/// Finds everything in a deck that is not modelled.
pub(super) fn check(deck: &Deck, findings: &mut Findings) {
    laws_of_line_types(deck, findings);
    bodies(deck, findings);
    points(deck, findings);
    rods(deck, findings);
    waves_and_currents(deck, findings);
    whole_sections(deck, findings);
}

fn laws_of_line_types(deck: &Deck, findings: &mut Findings) {
    for kind in &deck.line_types {
        let at = |column: &str| format!("line type {}, {column}", kind.name.value);
        if let Some(problem) = stiffness_law(&kind.stiffness.value) {
            findings.wrong(at("EA"), &kind.stiffness, problem);
        }
        let visco = matches!(kind.stiffness.value, Property::Parts(_));
        if let Some(problem) = damping_law(&kind.damping.value, visco) {
            findings.wrong(at("BA/-zeta"), &kind.damping, problem);
        }
        let table = |bending: &&Placed<Property>| !matches!(bending.value, Property::Number(_));
        if let Some(bending) = kind.bending.as_ref().filter(table) {
            let problem = "only a constant EI [N m²] is modelled: write it as a number";
            findings.wrong(at("EI"), bending, problem);
        }
        if let Some(lift) = kind.lift.as_ref().filter(|lift| lift.value != 0.0) {
            findings.wrong(
                at("Cl"),
                lift,
                "vortex-induced vibration is not modelled: write 0",
            );
        }
    }
}

/// Refuses a viscoelastic EA that depends on the load.
fn stiffness_law(stiffness: &Property) -> Option<&'static str> {
    match stiffness {
        Property::Parts(parts) if parts.len() != 2 => Some(
            "a dynamic stiffness that grows with the mean tension (static|alpha|beta) is not modelled: write static|dynamic [N], \
             the dynamic one at the mean tension expected",
        ),
        _ => None,
    }
}

/// Refuses BA from a table, a damping ratio for a viscoelastic line, and a viscoelastic BA with a single EA.
fn damping_law(damping: &Property, visco: bool) -> Option<String> {
    let problem = match damping {
        Property::Number(value) if *value < 0.0 && visco => {
            "a damping ratio has no meaning for the slow part of a viscoelastic line: write static|dynamic [N s]"
        }
        Property::Number(_) => return None,
        Property::Parts(parts) if parts.len() == 2 && visco && parts[0] > 0.0 => return None,
        Property::Parts(_) => {
            "two dampings belong to a viscoelastic line: write BA as static|dynamic [N s], the first above 0, beside EA as \
             static|dynamic [N]"
        }
        Property::Named(name) => {
            return Some(format!(
                "a damping from {} is not modelled: write BA [N s] as a number, or a ratio with a minus sign",
                shown(name)
            ));
        }
    };
    Some(problem.to_string())
}

/// Refuses bodies that are moved by forces, and mass, volume and drag of bodies that the host moves.
fn bodies(deck: &Deck, findings: &mut Findings) {
    for body in &deck.bodies {
        let at = || format!("body {}", body.id.value);
        let what = match body.attachment.value {
            Attachment::Fixed => continue,
            Attachment::Coupled | Attachment::Vessel => {
                let drag: f64 = body.parts[2].value.iter().map(|part| part.abs()).sum();
                for (what, size) in [
                    ("mass", &body.mass),
                    ("volume", &body.volume),
                    ("drag", &body.parts[2].with(drag)),
                ] {
                    if size.value != 0.0 {
                        let problem = format!(
                            "the {what} of a coupled body belongs to the host that moves it: give it there, and write 0 here"
                        );
                        findings.wrong(at(), size, problem);
                    }
                }
                continue;
            }
            Attachment::Body(_) | Attachment::Pinned(_) => {
                findings.wrong(at(), &body.attachment, "a body is Fixed, Coupled or Vessel");
                continue;
            }
            Attachment::Free => "a free body",
            Attachment::CoupledPinned => "a body that is coupled but free to turn",
            Attachment::Turbine(_) => "a body on a turbine of a farm",
        };
        let problem = format!(
            "{what} is not modelled: a free point carries mass, volume and drag without turning, a coupled body is moved by \
             the host, and points can be attached to a turbine by themselves"
        );
        findings.wrong(at(), &body.attachment, problem);
    }
}

/// Refuses pinned points, and points on bodies that do not exist.
fn points(deck: &Deck, findings: &mut Findings) {
    for point in &deck.points {
        let problem = match point.attachment.value {
            Attachment::Pinned(_) | Attachment::CoupledPinned => {
                "a point does not turn: write Fixed, Coupled or Body1".to_string()
            }
            Attachment::Body(id) if deck.body(id).is_none() => no_body(id),
            _ => continue,
        };
        findings.wrong(format!("point {}", point.id.value), &point.attachment, problem);
    }
}

fn no_body(id: usize) -> String {
    format!("no body has the number {id}")
}

/// Refuses rods except those that only hold the end of a line: fixed rods, and rods of zero length on objects that the host moves.
fn rods(deck: &Deck, findings: &mut Findings) {
    for rod in &deck.rods {
        let at = format!("rod {}", rod.id.value);
        let carried = (rod.segments.value > 0).then(|| {
            "the weight and drag of a rod on a moving body are not modelled: give them in the host, and write 0 segments here"
                .to_string()
        });
        let problem = match rod.attachment.value {
            Attachment::Fixed => None,
            Attachment::Body(id) => match deck.body(id) {
                None => Some(no_body(id)),
                Some(body) if body.attachment.value == Attachment::Fixed => None,
                Some(_) => carried,
            },
            Attachment::Vessel | Attachment::Turbine(_) => carried,
            Attachment::Coupled => {
                Some("a rod that is coupled by itself is not modelled: put it on a coupled body".to_string())
            }
            Attachment::Free | Attachment::Pinned(_) | Attachment::CoupledPinned => Some(
                "a rod that can move is not modelled: a free point carries mass and volume, and a line type with EI bends"
                    .to_string(),
            ),
        };
        if let Some(problem) = problem {
            findings.wrong(at.clone(), &rod.attachment, problem);
        }
        let mut types = deck.rod_types.iter();
        if types.all(|kind| kind.name.value != rod.rod_type.value) {
            let problem = format!("no rod type is called {}", shown(&rod.rod_type.value));
            findings.wrong(at, &rod.rod_type, problem);
        }
    }
}

/// Refuses waves and currents that are not read from decks.
fn waves_and_currents(deck: &Deck, findings: &mut Findings) {
    let surroundings = deck.options.surroundings.iter();
    for (key, value) in surroundings.filter(|(key, value)| water_file(key, &value.value).is_none()) {
        let problem = "only WaveKin 7 (components of wave_frequencies.txt) and Currents 1 (steady, current_profile.txt) are read \
                       of a deck: write one of them or 0, and give other waves and currents in the scene";
        findings.wrong(format!("OPTIONS, {key}"), value, problem);
    }
}

/// Refuses the rows of sections that are not modelled at all.
fn whole_sections(deck: &Deck, findings: &mut Findings) {
    for (section, rows, problem) in [
        (
            "FAILURE",
            &deck.failures,
            "breaks are not read from decks: take the section FAILURE out, and write `break = { at = …, tension = …, time = … }` \
             to the lines of the scene that `moorline convert` makes",
        ),
        (
            "CONTROL",
            &deck.controls,
            "lines whose length a controller changes are not modelled: take the section CONTROL out",
        ),
        (
            "EXTERNAL LOADS",
            &deck.loads,
            "external loads are not read: a scene has loads on free points (`force`), the host has those on vessels",
        ),
    ] {
        for row in rows {
            findings.wrong(section, row, problem);
        }
    }
}
