//! What a deck can ask for and moorline cannot model: a function for every feature, so that each can be opened by itself.

use std::ops::Range;

use super::build::water_file;
use super::deck::{Attachment, Deck, Property};
use crate::scene::rows::{Findings, Placed, shown};

/// Finds everything in a deck that is not modelled.
pub(super) fn check(deck: &Deck, findings: &mut Findings) {
    stiffness_laws(deck, findings);
    damping_laws(deck, findings);
    bending_laws(deck, findings);
    vortex_induced_vibration(deck, findings);
    bodies_in_motion(deck, findings);
    bodies_with_mass(deck, findings);
    points_that_turn(deck, findings);
    rods(deck, findings);
    waves_and_currents(deck, findings);
    line_failures(deck, findings);
    controlled_lengths(deck, findings);
    external_loads(deck, findings);
}

fn refuse(findings: &mut Findings, at: impl Into<String>, span: &Range<usize>, problem: String) {
    findings.mistake(at, span.clone(), problem);
}

/// Viscoelastic EA that depends on the load.
fn stiffness_laws(deck: &Deck, findings: &mut Findings) {
    for kind in &deck.line_types {
        let problem = match &kind.stiffness.value {
            Property::Number(_) | Property::Named(_) => continue,
            Property::Parts(parts) if parts.len() == 2 => continue,
            Property::Parts(_) => {
                "a dynamic stiffness that grows with the mean tension (static|alpha|beta) is not modelled: write \
                 static|dynamic [N], the dynamic one at the mean tension expected"
                    .to_string()
            }
        };
        refuse(
            findings,
            about_type(&kind.name, "EA"),
            &kind.stiffness.span,
            problem,
        );
    }
}

/// BA from a table, viscoelastic BA beside one EA.
fn damping_laws(deck: &Deck, findings: &mut Findings) {
    for kind in &deck.line_types {
        let visco = matches!(kind.stiffness.value, Property::Parts(_));
        let problem = match &kind.damping.value {
            Property::Number(value) if *value < 0.0 && visco => {
                "a damping ratio has no meaning for the slow part of a viscoelastic line: write static|dynamic [N s]"
                    .to_string()
            }
            Property::Number(_) => continue,
            Property::Parts(parts) if parts.len() == 2 && visco && parts[0] > 0.0 => continue,
            Property::Parts(_) => {
                "two dampings belong to a viscoelastic line: write BA as static|dynamic [N s], the first above 0, beside EA as \
                 static|dynamic [N]"
                    .to_string()
            }
            Property::Named(name) => format!(
                "a damping from {} is not modelled: write BA [N s] as a number, or a ratio with a minus sign",
                shown(name)
            ),
        };
        refuse(
            findings,
            about_type(&kind.name, "BA/-zeta"),
            &kind.damping.span,
            problem,
        );
    }
}

/// EI from a table.
fn bending_laws(deck: &Deck, findings: &mut Findings) {
    for kind in &deck.line_types {
        let Some(bending) = &kind.bending else {
            continue;
        };
        if !matches!(bending.value, Property::Number(_)) {
            let problem = "only a constant EI [N m²] is modelled: write it as a number".to_string();
            refuse(findings, about_type(&kind.name, "EI"), &bending.span, problem);
        }
    }
}

fn vortex_induced_vibration(deck: &Deck, findings: &mut Findings) {
    for kind in &deck.line_types {
        if let Some(lift) = &kind.lift
            && lift.value != 0.0
        {
            let problem = "vortex-induced vibration is not modelled: write 0".to_string();
            refuse(findings, about_type(&kind.name, "Cl"), &lift.span, problem);
        }
    }
}

/// Bodies that the forces move.
fn bodies_in_motion(deck: &Deck, findings: &mut Findings) {
    for body in &deck.bodies {
        let what = match body.attachment.value {
            Attachment::Free => "a free body",
            Attachment::CoupledPinned => "a body that is coupled but free to turn",
            Attachment::Fixed | Attachment::Coupled | Attachment::Vessel => continue,
            Attachment::Turbine(_) => "a body on a turbine of a farm",
            Attachment::Body(_) | Attachment::Pinned(_) => {
                let problem = "a body is Fixed, Coupled, Vessel or Free".to_string();
                refuse(
                    findings,
                    about("body", body.id.value),
                    &body.attachment.span,
                    problem,
                );
                continue;
            }
        };
        let problem = format!(
            "{what} is not modelled: a free point carries mass, volume and drag without turning, a coupled body is moved by \
             the host, and points can be attached to a turbine by themselves"
        );
        refuse(
            findings,
            about("body", body.id.value),
            &body.attachment.span,
            problem,
        );
    }
}

/// Mass, volume and drag of a body that the host moves.
fn bodies_with_mass(deck: &Deck, findings: &mut Findings) {
    for body in &deck.bodies {
        if !matches!(body.attachment.value, Attachment::Coupled | Attachment::Vessel) {
            continue; // fixed, or refused as it moves
        }
        let [_, _, drag, _] = &body.parts;
        let drag = drag.value.iter().fold(0.0, |sum: f64, part| sum + part.abs());
        let sizes = [
            ("mass", body.mass.value, &body.mass.span),
            ("volume", body.volume.value, &body.volume.span),
            ("drag", drag, &body.parts[2].span),
        ];
        for (what, _, span) in sizes.iter().filter(|(_, size, _)| *size != 0.0) {
            let problem = format!(
                "the {what} of a coupled body belongs to the host that moves it: give it there, and write 0 here"
            );
            refuse(findings, about("body", body.id.value), span, problem);
        }
    }
}

/// Points know no pins.
fn points_that_turn(deck: &Deck, findings: &mut Findings) {
    for point in &deck.points {
        match point.attachment.value {
            Attachment::Pinned(_) | Attachment::CoupledPinned => {
                let problem = "a point does not turn: write Fixed, Coupled or Body1".to_string();
                refuse(
                    findings,
                    about("point", point.id.value),
                    &point.attachment.span,
                    problem,
                );
            }
            Attachment::Body(id) if deck.bodies.iter().all(|body| body.id.value != id) => {
                let problem = format!("no body has the number {id}");
                refuse(
                    findings,
                    about("point", point.id.value),
                    &point.attachment.span,
                    problem,
                );
            }
            _ => {}
        }
    }
}

/// Rods, save those that only hold the end of a line: fixed ones, and ones of no length on what the host moves.
fn rods(deck: &Deck, findings: &mut Findings) {
    for rod in &deck.rods {
        let at = about("rod", rod.id.value);
        let problem = match rod.attachment.value {
            Attachment::Fixed => None,
            Attachment::Body(id) => match deck.bodies.iter().find(|body| body.id.value == id) {
                None => Some(format!("no body has the number {id}")),
                Some(body) if body.attachment.value == Attachment::Fixed => None,
                Some(_) => carried(rod.segments.value),
            },
            Attachment::Vessel | Attachment::Turbine(_) => carried(rod.segments.value),
            Attachment::Coupled => {
                Some("a rod that is coupled by itself is not modelled: put it on a coupled body".to_string())
            }
            Attachment::Free | Attachment::Pinned(_) | Attachment::CoupledPinned => Some(
                "a rod that can move is not modelled: a free point carries mass and volume, and a line type with EI \
                 bends"
                    .to_string(),
            ),
        };
        if let Some(problem) = problem {
            refuse(findings, at.clone(), &rod.attachment.span, problem);
        }
        if deck
            .rod_types
            .iter()
            .all(|kind| kind.name.value != rod.rod_type.value)
        {
            let problem = format!("no rod type is called {}", shown(&rod.rod_type.value));
            refuse(findings, at, &rod.rod_type.span, problem);
        }
    }
}

fn carried(segments: usize) -> Option<String> {
    (segments > 0).then(|| {
        "the weight and drag of a rod on a moving body are not modelled: give them in the host, and write 0 segments here"
            .to_string()
    })
}

/// Waves and currents from options and files.
fn waves_and_currents(deck: &Deck, findings: &mut Findings) {
    for (key, value) in &deck.options.surroundings {
        if water_file(key, &value.value).is_some() {
            continue;
        }
        let what = "only WaveKin 7 (components of wave_frequencies.txt) and Currents 1 (steady, current_profile.txt) are read of a deck: \
                    write one of them or 0, and give other waves and currents in the scene";
        refuse(findings, format!("OPTIONS, {key}"), &value.span, what.to_string());
    }
}

fn line_failures(deck: &Deck, findings: &mut Findings) {
    for row in &deck.failures {
        let problem = "breaks are not read from decks: take the section FAILURE out, and write `break = { at = …, tension = …, time = … }` \
                       to the lines of the scene that `moorline convert` makes"
            .to_string();
        refuse(findings, "FAILURE", &row.span, problem);
    }
}

fn controlled_lengths(deck: &Deck, findings: &mut Findings) {
    for row in &deck.controls {
        let problem =
            "lines whose length a controller changes are not modelled: take the section CONTROL out"
                .to_string();
        refuse(findings, "CONTROL", &row.span, problem);
    }
}

fn external_loads(deck: &Deck, findings: &mut Findings) {
    for row in &deck.loads {
        let problem =
            "external loads are not read: a scene has loads on free points (`force`), the host has those on \
                       vessels"
                .to_string();
        refuse(findings, "EXTERNAL LOADS", &row.span, problem);
    }
}

fn about(what: &str, id: usize) -> String {
    format!("{what} {id}")
}

fn about_type(name: &Placed<String>, column: &str) -> String {
    format!("line type {}, {column}", name.value)
}
