//! Remarks on entries that are valid in a deck but often meant differently.

use moorline::scene::plausibility::{DRAG_ON_BAR, MASS_PER_VOLUME, dense};

use super::deck::{Attachment, Deck, LineType, Property, Version};
use super::options::Meaning;
use super::sections::{Kind, Sections};
use super::tables::columns_of;
use crate::findings::Findings;
use crate::table::{check_units, compare_header};

/// BA [N s] below which a damping ratio without its minus sign is more likely.
const RATIO_LIKE: f64 = 10.0;

/// Adds remarks on a deck.
pub(super) fn remark(deck: &Deck, sections: &Sections<'_>, findings: &mut Findings) {
    headers(deck, sections, findings);
    for kind in &deck.line_types {
        ratio_or_damping(kind, sections, findings);
        chain_diameter(kind, findings);
    }
    if deck.version == Version::One {
        findings.remark_on_all(
            "read as MoorDyn v1: line types with nine columns, coefficients in the order Can Cat Cdn Cdt",
        );
    }
    findings.remark_on_all(
        "in MoorDyn, damping within a line acts in compression too, so that its tension can be negative; here a slack line \
         carries nothing, and `negative_tension = true` in [solver] gives MoorDyn's law",
    );
    unneeded_options(deck, findings);
    friction(deck, findings);
    line_files(deck, findings);
    masses_of_fixed_points(deck, findings);
    start(deck, findings);
}

fn headers(deck: &Deck, sections: &Sections<'_>, findings: &mut Findings) {
    for section in &sections.list {
        if let (Some(names), Some(columns)) = (&section.names, columns_of(section, deck)) {
            compare_header(names, columns, findings);
        }
        if let (Some(units), Some(columns)) = (&section.units, columns_of(section, deck)) {
            check_units(units, columns, &section.rows, findings);
        }
    }
}

/// Remarks on BA: a negative value is the ratio of critical damping of a segment, a positive one is BA itself; the header has no influence.
fn ratio_or_damping(kind: &LineType, sections: &Sections<'_>, findings: &mut Findings) {
    let Property::Number(value) = kind.damping.value else {
        return;
    };
    let name = &kind.name.value;
    let at = &kind.damping;
    if value < 0.0 {
        let ratio = -value;
        let text = format!(
            "{name}: BA/-zeta {value} is a damping ratio of {ratio}, of the critical damping of each segment, so BA \
             changes with NumSegs"
        );
        return findings.remark(at, text);
    }
    if value > 0.0 && value < RATIO_LIKE {
        let text = format!(
            "{name}: BA {value} N s is next to none; a damping ratio is written with a minus sign, -{value}"
        );
        findings.remark(at, text);
    }
    let section = sections.get(Kind::LineTypes);
    let units = section.and_then(|section| section.units.as_ref());
    let pascal = units.is_some_and(|units| units.text.to_lowercase().contains("pa-s"));
    if value >= RATIO_LIKE && pascal {
        let text = format!(
            "{name}: the header has Pa s above the damping, but {value} is read as BA [N s], as MoorDyn does: a \
             damping in Pa s must be multiplied by the area of the section"
        );
        findings.remark(at, text);
    }
}

/// Remarks on a chain whose diameter is that of the bar, although in a deck it is that of a cylinder with the line's volume, and whose drag
/// coefficient refers to the bar. For such a line the scene gives no note; the note on other lines is the scene's.
fn chain_diameter(kind: &LineType, findings: &mut Findings) {
    let (diameter, mass) = (kind.diameter.value, kind.mass.value);
    if diameter <= 0.0 || mass <= 0.0 || kind.drag_normal.value < DRAG_ON_BAR {
        return;
    }
    if let Some(text) = dense(diameter, mass, MASS_PER_VOLUME[1], "Diam") {
        let text = format!("{}: {text}", kind.name.value);
        findings.remark(&kind.diameter, text);
    }
}

fn unneeded_options(deck: &Deck, findings: &mut Findings) {
    let unneeded = &deck.options.unneeded;
    if let Some(first) = unneeded.first() {
        let keys: Vec<&str> = unneeded.iter().map(|key| key.value.as_str()).collect();
        let text = format!(
            "options without effect, since the steps and the initial state follow from the scene: {}",
            keys.join(", ")
        );
        findings.remark(first, text);
    }
}

fn friction(deck: &Deck, findings: &mut Findings) {
    let mut coefficients = deck.options.friction.iter();
    if let Some((_, coefficient)) = coefficients.find(|(_, coefficient)| coefficient.value > 0.0) {
        let text = "friction at rest: here every line lies as one that was laid from its end A, or from end B where only that is on \
                    the seabed, and hauled at the other end, with all the friction that holds against that, as in MAP++; a line \
                    at rest has none in MoorDyn";
        findings.remark(coefficient, text);
    }
    let numbers = &deck.options.numbers;
    if let Some(damping) = numbers.get(&Meaning::FrictionDamping) {
        let text = "here friction holds up to its limit and needs no damping; in MoorDyn a line at rest creeps against that damping";
        findings.remark(damping, text);
    }
    if let Some(scale) = numbers.get(&Meaning::StaticFriction)
        && scale.value != 1.0
    {
        let text = format!(
            "static friction of {} times the kinetic is not modelled: one coefficient holds and brakes",
            scale.value
        );
        findings.remark(scale, text);
    }
}

/// Remarks on the start: MoorDyn relaxes from the positions in the file, not at all if `TmaxIC` is 0, or reads a state from another file.
fn start(deck: &Deck, findings: &mut Findings) {
    let at_once = &deck.options.starts_at_once;
    let start = match at_once {
        Some(_) => {
            "TmaxIC 0: runs start with free points where the file has them and every line on its catenary between its ends, or \
             straight where it has none, as in MoorDyn, which also starts a line straight if it is longer than the sum of the horizontal \
             and vertical distances between its ends; leave it out to start from equilibrium"
        }
        None => "the run starts from equilibrium",
    };
    if let Some(file) = &deck.options.state_file {
        let text = format!("{}: the state in this file is not read; {start}", file.value);
        findings.remark(file, text);
    } else if let Some(at_once) = at_once {
        findings.remark(at_once, start);
    }
}

fn line_files(deck: &Deck, findings: &mut Findings) {
    let mut lines = deck.lines.iter();
    if let Some(line) = lines.find(|line| line.outputs.value.chars().any(char::is_alphabetic)) {
        findings.remark(
            &line.outputs,
            "no files of single lines are written: `profile = true` in [output] writes the nodes of all lines",
        );
    }
}

/// Remarks on mass, volume and drag of fixed points, which a scene does not have.
fn masses_of_fixed_points(deck: &Deck, findings: &mut Findings) {
    let is_fixed = |attachment: Attachment| match attachment {
        Attachment::Body(id) => deck.body(id).map(|body| body.attachment.value) == Some(Attachment::Fixed),
        other => other == Attachment::Fixed,
    };
    for point in deck
        .points
        .iter()
        .filter(|point| is_fixed(point.attachment.value))
    {
        let sizes = [&point.mass, &point.volume, &point.drag_area, &point.added_mass];
        if let Some(given) = sizes.into_iter().find(|size| size.value != 0.0) {
            let text = format!(
                "point {}: mass, volume and drag of a fixed point are left out of the force on the ground, which MoorDyn adds them to",
                point.id.value
            );
            findings.remark(given, text);
        }
    }
}
