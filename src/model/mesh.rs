//! How many elements a section gets when the scene leaves it open.
//!
//! The lumped two-node line carries about 0.8/n of relative error in the RMS of a fairlead tension (4 % at n = 20, 1.8 % at
//! n = 40 on a 900 m catenary), so n = 0.8/tolerance over the line, shared by length.

use crate::scene::Line;

/// RMS tension error times the number of elements of a line [-].
const ERROR_TIMES_ELEMENTS: f64 = 0.8;
const LINE_ELEMENTS_MIN: f64 = 10.0;
const LINE_ELEMENTS_MAX: f64 = 400.0;

/// Elements of each section of a line for a target error of fairlead tension [-].
pub fn section_elements(line: &Line, tolerance: f64) -> Vec<usize> {
    let total: f64 = line.sections.iter().map(|section| section.length).sum();
    let wanted = (ERROR_TIMES_ELEMENTS / tolerance).clamp(LINE_ELEMENTS_MIN, LINE_ELEMENTS_MAX);
    line.sections
        .iter()
        .map(|section| {
            section
                .elements
                .unwrap_or_else(|| ((wanted * section.length / total).round() as usize).max(1))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{InitialShape, RestShape, Section};

    fn section(length: f64, elements: Option<usize>) -> Section {
        Section {
            line_type: "chain".into(),
            length,
            elements,
        }
    }

    #[test]
    fn elements_are_shared_by_length_and_a_given_number_is_kept() {
        let line = Line {
            name: "line".into(),
            from: "a".into(),
            to: "b".into(),
            sections: vec![
                section(300.0, None),
                section(1.0, None),
                section(99.0, Some(7)),
            ],
            initial: InitialShape::Static,
            rest_shape: RestShape::Straight,
            clamped_a: None,
            clamped_b: None,
            release: None,
            parting: None,
        };
        assert_eq!(section_elements(&line, 0.02), vec![30, 1, 7]);
    }
}
