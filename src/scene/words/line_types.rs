//! Line types in words.

use super::{given, significant};
use crate::math::circle;
use crate::scene::check::{number, quantity};
use crate::scene::table::Table;
use crate::scene::{DAMPING_ELEMENTS, FibreLaw, Line, LineModel, LineType, NUMERICAL_DAMPING_RATIO, Scene};

impl Scene {
    pub(super) fn line_type_in_words(&self, name: &str, line_type: &LineType) -> String {
        let mass = self.mass(line_type);
        let weight = significant(self.weight(line_type));
        let origin = match (line_type.weight, &self.water) {
            (Some(_), _) => "as given",
            (None, Some(_)) => "in water",
            (None, None) => "in air",
        };
        let mut parts = vec![
            format!("mass {} kg/m", significant(mass)),
            format!("weight {weight} N/m {origin}"),
        ];
        parts.extend(given(line_type, &["model", "mass", "weight", "strain"]));
        if let Some(ea) = line_type.axial_stiffness.or(line_type.dynamic_stiffness) {
            parts.push(format!("{} strain", line_type.strain.name()));
            parts.push(format!("axial waves at {} m/s", significant((ea / mass).sqrt())));
        }
        parts.extend(bending_in_words(line_type));
        parts.extend(self.damping_in_words(name, line_type));
        if self.water.is_some() {
            let within = line_type.weight.map_or("", |_| " included in the weight");
            parts.push(format!("buoyancy{within}"));
            let left_out = line_type.entries().filter(|(_, value)| value.is_absent());
            let absent = left_out.filter_map(|(key, _)| key.rule.absence);
            parts.extend(absent.map(|effect| format!("no {effect}")));
        }
        let model = match self.makes_beams(line_type) {
            true => "a beam: ",
            false => "",
        };
        format!("{name}: {model}{}", parts.join(", "))
    }

    /// Sentence on axial damping that the type leaves open, or on the mesh that a damping ratio refers to.
    fn damping_in_words(&self, name: &str, line_type: &LineType) -> Option<String> {
        let sections = self.sections();
        let own = sections.filter(|section| section.line_type == name);
        let mut elements: Vec<usize> = own
            .map(|section| section.damping_elements.unwrap_or(DAMPING_ELEMENTS))
            .collect();
        elements.sort_unstable();
        elements.dedup();
        let elements: Vec<String> = elements.iter().map(usize::to_string).collect();
        let elements = elements.join(" or ");
        if line_type.damping_ratio.is_some() {
            return Some(format!(
                "the ratio refers to one of {elements} elements of a line and gives the same damping on every mesh"
            ));
        }
        let open = line_type.leaves_damping_open();
        match self.makes_beams(line_type) {
            false if open => Some(format!(
                "axial damping {} of critical in each segment, at least that with {elements} elements (default)",
                number(NUMERICAL_DAMPING_RATIO)
            )),
            true if open => Some("no structural damping".to_string()),
            _ => None,
        }
    }

    /// Returns whether a cable has a section with bending stiffness.
    pub(super) fn bends(&self, line: &Line) -> bool {
        let mut types = self.types_of(line);
        !self.is_beam(line) && types.any(|line_type| solid_stiffness(line_type).is_some())
    }

    /// Names of the effects of bending, torsion and shear that are not modelled.
    pub(super) fn absence_of_bending(&self) -> String {
        let cables = || self.lines.iter().filter(|line| !self.is_beam(line));
        let absences = match cables().filter(|line| self.bends(line)).count() {
            0 => "bending, torsion and shear of lines",
            n if n == cables().count() => "torsion and shear of lines",
            _ => "bending of lines without bending stiffness, torsion and shear of lines",
        };
        match cables().count() == self.lines.len() {
            true => absences.to_string(),
            false => format!("{absences} other than beams"),
        }
    }

    /// Sentence on whether and how cables carry compression.
    pub(super) fn compression_in_words(&self) -> &'static str {
        if self.lines.iter().any(|line| self.bends(line)) {
            "flexible lines carry no compression; lines with bending stiffness carry up to 4EI/l² in an element of length l, above which the \
             element would buckle"
        } else {
            "lines carry no compression: the tension of a slack line is zero"
        }
    }
}

/// EI of one solid section [N m²]: as given, otherwise Eπd⁴/64; `None` for flexible cables, and for beams.
fn solid_stiffness(line_type: &LineType) -> Option<f64> {
    let of_section = || {
        let section = line_type.solid_section?;
        Some(section.youngs_modulus * circle::second_moment(section.diameter))
    };
    let solid = line_type.bending_stiffness.or_else(of_section);
    solid.filter(|ei| *ei > 0.0 && line_type.model == LineModel::Cable)
}

/// Sentence on the bending stiffness of a cable, if it follows from the solid section or is divided among fibres.
fn bending_in_words(line_type: &LineType) -> Option<String> {
    let solid = solid_stiffness(line_type)?;
    let source = match line_type.bending_stiffness {
        None => "of the solid section",
        Some(_) => "as given",
    };
    let fibres = line_type.fibres.unwrap_or(1).max(1);
    let (n, of_one) = (fibres as f64, quantity(solid, "N m²"));
    if fibres == 1 {
        let follows = line_type.bending_stiffness.is_none();
        return follows.then(|| format!("bending stiffness EI {of_one} {source}"));
    }
    let (share, law) = match line_type.fibre_law {
        FibreLaw::Linear => (
            solid / n,
            format!("EI/{fibres}: strands side by side that slide without friction"),
        ),
        FibreLaw::Squared => (
            solid / n.powi(2),
            format!("EI/{fibres}²: that of a single strand"),
        ),
    };
    let share = quantity(share, "N m²");
    Some(format!(
        "bending stiffness {share}: EI {of_one} {source}, divided among {fibres} fibres ({law})"
    ))
}
