//! Beam with half as many elements, and the transfer of its sections to the finer beam.
//!
//! Two neighbouring elements become one. Each of its stiffnesses is that of both in series, l/k = l₁/k₁ + l₂/k₂, and its strain without stress is
//! their mean. Half of the weight of the node between them goes to each neighbour; the springs of the seabed are added. In the transfer back, the
//! node lies on the cubic through both neighbours along their directors d₃, turned by its part of the turn between them.

use nalgebra::Vector3;

use crate::elements::beam::{BeamCase, ElementSpring};
use crate::math::rotation::{cayley, cayley_vector};
use crate::model::BeamElement;
use crate::physics::section::{Section, SectionLaw, Sextuple};

/// Nodes of a beam with `elements` elements that the coarser one keeps.
pub(super) fn kept(elements: usize) -> Vec<usize> {
    (0..elements).step_by(2).chain([elements]).collect()
}

/// Beam on the nodes of [`kept`].
pub(super) fn coarser<'a>(case: &BeamCase<'a>) -> BeamCase<'a> {
    let pairs = || case.elements.chunks(2).zip(case.rest.chunks(2));
    BeamCase {
        elements: pairs().map(|(pair, _)| joined(pair)).collect(),
        rest: pairs().map(|(pair, rest)| mean_rest(pair, rest)).collect(),
        weight: gathered(&case.weight),
        seabed: case.seabed.chunks(2).map(joined_spring).collect(),
        ..case.clone()
    }
}

/// Element that replaces one or two consecutive elements.
fn joined(row: &[BeamElement]) -> BeamElement {
    let length: f64 = row.iter().map(|element| element.length).sum();
    let along = |stiffness: fn(&SectionLaw) -> f64| {
        let compliance = row.iter().map(|element| element.length / stiffness(&element.law));
        length / compliance.sum::<f64>()
    };
    let law = SectionLaw {
        shear: along(|law| law.shear),
        axial: along(|law| law.axial),
        bending: along(|law| law.bending),
        torsion: along(|law| law.torsion),
    };
    BeamElement {
        length,
        law,
        damping: row[0].damping,
    }
}

/// Mean strain without stress of consecutive elements.
fn mean_rest(row: &[BeamElement], rest: &[Sextuple]) -> Sextuple {
    let length: f64 = row.iter().map(|element| element.length).sum();
    let parts = row.iter().zip(rest);
    parts.map(|(element, rest)| element.length / length * rest).sum()
}

/// Values of the kept nodes, plus half the value of each neighbour that is not kept.
fn gathered(values: &[f64]) -> Vec<f64> {
    let kept = kept(values.len() - 1);
    let mut sums: Vec<f64> = kept.iter().map(|&node| values[node]).collect();
    for (i, pair) in kept.windows(2).enumerate() {
        for value in &values[pair[0] + 1..pair[1]] {
            sums[i] += 0.5 * value;
            sums[i + 1] += 0.5 * value;
        }
    }
    sums
}

/// Spring that replaces those under one or two consecutive elements.
fn joined_spring(row: &[ElementSpring]) -> ElementSpring {
    ElementSpring {
        levels: [row[0].levels[0], row[row.len() - 1].levels[1]],
        stiffness: row.iter().map(|spring| spring.stiffness).sum(),
    }
}

/// Sections on the `elements` of the finer beam from those of the coarser one.
pub(super) fn finer(coarse: &[Section], elements: &[BeamElement]) -> Vec<Section> {
    let mut sections = vec![coarse[0]];
    for (ends, row) in coarse.windows(2).zip(elements.chunks(2)) {
        if let [first, second] = row {
            let length = first.length + second.length;
            sections.push(between(&ends[0], &ends[1], length, first.length / length));
        }
        sections.push(ends[1]);
    }
    sections
}

/// Section at the fraction `part` of an element of this length [m].
fn between(a: &Section, b: &Section, length: f64, part: f64) -> Section {
    let turn = cayley_vector(&(b.frame * a.frame.transpose()));
    let along = |section: &Section| -> Vector3<f64> { length * section.frame.column(2) };
    let (p, q) = (part, 1.0 - part);
    Section {
        position: q * q * (1.0 + 2.0 * p) * a.position
            + p * p * (1.0 + 2.0 * q) * b.position
            + p * q * (q * along(a) - p * along(b)),
        frame: cayley(part * turn) * a.frame,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::beam::BeamEnd;
    use crate::math::rotation::turned_to;
    use crate::physics::section::straight;
    use approx::assert_relative_eq;
    use nalgebra::Matrix3;

    /// Quarter circle of radius 1 m with elements of unequal lengths, over a seabed.
    fn quarter(elements: usize) -> (BeamCase<'static>, Vec<Section>) {
        let angle = |i: usize| std::f64::consts::FRAC_PI_2 * (i as f64 / elements as f64).powf(1.2);
        let law = |i: usize| SectionLaw {
            shear: 1e3,
            axial: 1e4 * (1.0 + i as f64),
            bending: 2.0,
            torsion: 1.0,
        };
        let element = |i: usize| BeamElement {
            length: angle(i + 1) - angle(i),
            law: law(i),
            damping: law(i),
        };
        let section = |i: usize| {
            let (sin, cos) = angle(i).sin_cos();
            Section {
                position: Vector3::new(sin, 0.0, 1.0 - cos),
                frame: turned_to(&Matrix3::identity(), Vector3::new(cos, 0.0, sin)),
            }
        };
        let spring = |i: usize| ElementSpring {
            levels: [0.1; 2],
            stiffness: 1.0 + i as f64,
        };
        let case = BeamCase {
            elements: (0..elements).map(element).collect(),
            rest: vec![straight(); elements],
            weight: (0..=elements).map(|i| 2.0 + i as f64).collect(),
            seabed: (0..elements).map(spring).collect(),
            ends: [BeamEnd::default(); 2],
            bodies: [None; 2],
        };
        (case, (0..=elements).map(section).collect())
    }

    #[test]
    fn a_coarser_beam_keeps_length_weight_seabed_and_compliance() {
        for elements in [2, 5, 8] {
            let (fine, _) = quarter(elements);
            let coarse = coarser(&fine);
            assert_eq!(coarse.elements.len(), elements.div_ceil(2));
            let sums = |case: &BeamCase| {
                let compliance = |element: &BeamElement| element.length / element.law.axial;
                [
                    case.elements.iter().map(|element| element.length).sum::<f64>(),
                    case.elements.iter().map(compliance).sum(),
                    case.weight.iter().sum(),
                    case.seabed.iter().map(|spring| spring.stiffness).sum(),
                ]
            };
            for (coarse, fine) in sums(&coarse).into_iter().zip(sums(&fine)) {
                assert_relative_eq!(coarse, fine, max_relative = 1e-14);
            }
            assert!(coarse.rest.iter().all(|rest| (rest - straight()).norm() < 1e-15));
        }
    }

    #[test]
    fn the_sections_between_those_of_an_arc_lie_on_it_at_fourth_order() {
        let error = |elements: usize| {
            let (fine, exact) = quarter(elements);
            let coarse: Vec<Section> = kept(elements).into_iter().map(|node| exact[node]).collect();
            let found = finer(&coarse, &fine.elements);
            let errors = found.iter().zip(&exact).map(|(found, exact)| {
                (found.position - exact.position).norm() + (found.frame - exact.frame).norm()
            });
            errors.fold(0.0, f64::max)
        };
        let [coarse, fine] = [16, 32].map(error);
        assert!(coarse < 1e-3 && fine < coarse / 6.0, "{coarse} {fine}");
    }
}
