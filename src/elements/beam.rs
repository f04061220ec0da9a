//! A geometrically exact beam at rest, from the laws of its sections to forces and moments on its nodes.
//!
//! Unknowns are position and spin of every node. With the gradient B of the strains (see [`crate::physics::section`]) the nodes' forces and
//! moments out of balance are
//!
//!   R = Σ L Bᵀ S + w ẑ − contact − loads,   J = Σ (L Bᵀ C B + geometric part) + contact.
//!
//! The elements of a step in time are the same with the gradient at the mean of both of its ends (`Span`).
//!
//! A beam whose ends do not prevent its rotation about its axis has no resistance to it: its first node then resists
//! a turn about d₃, which changes the iteration but not the equilibrium.

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::math::pivoted_chain::PivotedChain;
use crate::model::{BeamElement, FreePoint, Point};
use crate::physics::seabed::{PARTS, Part};
use crate::physics::section::{
    GeometricStiffness, Mixture, Section, Sextuple, StrainGradient, join, split, strain,
};

/// Constraints and loads of an end of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamEnd {
    /// Prescribed unknowns: x, y, z and the turns about them.
    pub held: [bool; 6],
    /// Force [N] and moment [N m] on the end, along the global axes.
    pub load: Sextuple,
}

impl BeamEnd {
    /// End without constraints and loads.
    pub fn free() -> BeamEnd {
        BeamEnd {
            held: [false; 6],
            load: Sextuple::zeros(),
        }
    }

    /// End fixed in place, free to turn.
    pub fn pinned() -> BeamEnd {
        BeamEnd {
            held: [true, true, true, false, false, false],
            ..BeamEnd::free()
        }
    }

    /// End fixed in place and attitude.
    pub fn clamped() -> BeamEnd {
        BeamEnd {
            held: [true; 6],
            ..BeamEnd::free()
        }
    }
}

/// Constraints of an end at a point: the axes on which the point is not free, and the clamp.
pub(crate) fn end_hold(point: &Point, clamped: bool) -> BeamEnd {
    let axes = point.free().map_or([false; 3], |free| free.axes);
    let mut held = [clamped; 6];
    for (held, free) in held.iter_mut().zip(axes) {
        *held = !free;
    }
    BeamEnd {
        held,
        ..BeamEnd::free()
    }
}

/// A beam with its constraints and loads.
#[derive(Debug, Clone)]
pub struct BeamCase<'a> {
    /// Elements.
    pub elements: Vec<BeamElement>,
    /// Strains of the elements without stress.
    pub rest: Vec<Sextuple>,
    /// Weight of the nodes [N].
    pub weight: Vec<f64>,
    /// Seabed under the elements; empty without contact.
    pub seabed: Vec<ElementSpring>,
    /// Constraints and loads of ends A and B.
    pub ends: [BeamEnd; 2],
    /// Free points at ends A and B: their weight, buoyancy and contact act on the beam.
    pub bodies: [Option<&'a FreePoint>; 2],
}

/// Spring of the seabed under an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementSpring {
    /// Heights below which it pushes, at both nodes [m].
    pub levels: [f64; 2],
    /// Stiffness [N/m].
    pub stiffness: f64,
}

/// Parts of the loads that act [-].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LoadShare {
    /// Part of weight, buoyancy and forces.
    pub force: f64,
    /// Part of the moments on the ends.
    pub moment: f64,
}

impl LoadShare {
    /// The whole load.
    pub(crate) const WHOLE: LoadShare = LoadShare {
        force: 1.0,
        moment: 1.0,
    };

    /// Load on an end.
    fn of_end(self, end: &BeamEnd) -> Sextuple {
        let (force, moment) = split(&end.load);
        join(self.force * force, self.moment * moment)
    }
}

impl ElementSpring {
    /// Parts of an element between two sections that are below the level of the spring, with their depths [m].
    fn pressed(&self, sections: &[Section]) -> impl Iterator<Item = (Part, f64)> + use<> {
        let [near, far] = [0, 1].map(|end| self.levels[end] - sections[end].position.z);
        let depths = PARTS.map(|part| (part, part.between(near, far)));
        depths.into_iter().filter(|(_, depth)| *depth > 0.0)
    }
}

/// Adds vertical forces on the two nodes of an element [N] and minus their slopes with the heights of these [N/m].
pub(crate) fn add_rise(chain: &mut PivotedChain, element: usize, force: [f64; 2], slope: [[f64; 2]; 2]) {
    add_lift(chain, element, force);
    for (end, slope) in slope.into_iter().enumerate() {
        chain.diagonal[element + end][(2, 2)] += slope[end];
    }
    chain.upper[element][(2, 2)] += slope[0][1];
    chain.lower[element][(2, 2)] += slope[1][0];
}

/// Adds vertical forces on the two nodes of an element [N].
pub(crate) fn add_lift(chain: &mut PivotedChain, element: usize, force: [f64; 2]) {
    for (end, force) in force.into_iter().enumerate() {
        chain.right[element + end].z += force;
    }
}

/// Potential energy of a beam.
pub(crate) struct Energy {
    /// Sum of its parts [J].
    pub value: f64,
    /// Sum of the magnitudes of its parts [J].
    pub size: f64,
}

impl BeamCase<'_> {
    /// Sets the system of a beam at `sections` under a part of its loads: tangent J, right-hand side −R. `unit` holds one identity per node.
    pub(crate) fn assemble(
        &self,
        chain: &mut PivotedChain,
        sections: &[Section],
        share: LoadShare,
        unit: &[Matrix3<f64>],
    ) {
        chain.clear();
        let span = Span {
            mean: sections,
            now: sections,
            strain_before: None,
            spin: unit,
        };
        let still = Mixture {
            share: 1.0,
            rate: 0.0,
        };
        add_elements(chain, &self.elements, &self.rest, &span, still, true);
        for (i, weight) in self.weight.iter().enumerate() {
            chain.right[i].z -= share.force * weight;
        }
        for (i, spring) in self.seabed.iter().enumerate() {
            for (part, depth) in spring.pressed(&sections[i..]) {
                let force = part.shares.map(|share| share * spring.stiffness * depth);
                let slope = part
                    .products()
                    .map(|row| row.map(|product| product * spring.stiffness));
                add_rise(chain, i, force, slope);
            }
        }
        let ends = self.ends.iter().zip(&self.bodies);
        for ((end, body), node) in ends.zip([0, sections.len() - 1]) {
            chain.right[node] += share.of_end(end);
            let Some(body) = body else {
                continue;
            };
            let height = sections[node].position.z;
            let at = body.at(height);
            chain.right[node].z -= share.force * at.weight;
            chain.diagonal[node][(2, 2)] += share.force * at.weight_slope;
            if let Some((stiffness, push)) = body.bed_at_rest(height) {
                chain.right[node].z += push;
                chain.diagonal[node][(2, 2)] += stiffness;
            }
        }
    }

    /// Sets the changes of the prescribed unknowns to zero, and adds the resistance of the first node to the turn of a beam about itself.
    pub(crate) fn constrain(&self, chain: &mut PivotedChain, sections: &[Section]) {
        let turns_freely = self.ends.iter().all(|end| end.held[3..].iter().all(|held| !held));
        if turns_freely {
            let element = &self.elements[0];
            let axis: Vector3<f64> = sections[0].frame.column(2).into_owned();
            let brake = element.law.torsion / element.length * axis * axis.transpose();
            let mut turn = chain.diagonal[0].fixed_view_mut::<3, 3>(3, 3);
            turn += brake;
        }
        for (node, end) in [0, sections.len() - 1].into_iter().zip(&self.ends) {
            (0..6)
                .filter(|&unknown| end.held[unknown])
                .for_each(|unknown| chain.hold(node, unknown, 0.0));
        }
    }

    /// Potential energy of strain, weight, contact and the forces at the ends; moments on ends have no potential and are left out.
    pub(crate) fn energy(&self, sections: &[Section]) -> Energy {
        let (mut value, mut size) = (0.0, 0.0);
        let mut add = |part: f64| {
            value += part;
            size += part.abs();
        };
        for (i, element) in self.elements.iter().enumerate() {
            let strain = element.strain(&sections[i], &sections[i + 1], &self.rest[i]);
            add(element.energy(&strain).total());
        }
        for (weight, section) in self.weight.iter().zip(sections) {
            add(weight * section.position.z);
        }
        for (spring, sections) in self.seabed.iter().zip(sections.windows(2)) {
            for (part, depth) in spring.pressed(sections) {
                let share: f64 = part.shares.iter().sum();
                add(0.5 * share * spring.stiffness * depth * depth);
            }
        }
        for (end, node) in [0, sections.len() - 1].into_iter().enumerate() {
            let position = &sections[node].position;
            add(-split(&self.ends[end].load).0.dot(position));
            if let Some(body) = self.bodies[end] {
                add(body.potential(position.z));
                let bed = body.bed_at_rest(position.z);
                add(bed.map_or(0.0, |(stiffness, push)| 0.5 * push * push / stiffness));
            }
        }
        Energy { value, size }
    }
}

/// Cosine of the turn from node to node below which an element is refused [-]: 60°; its moment is greatest at 56°.
const COSINE_MIN: f64 = 0.5;

/// Returns the lower node of the first element that turns by more than its strains can resolve.
pub(crate) fn folded(sections: &[Section]) -> Option<usize> {
    let cosine = |pair: &[Section]| 0.5 * (pair[0].frame.dot(&pair[1].frame) - 1.0);
    sections.windows(2).position(|pair| cosine(pair) < COSINE_MIN)
}

/// Sections of a beam at the mean of a step and after it; both are the same in statics.
pub(crate) struct Span<'a> {
    pub mean: &'a [Section],
    pub now: &'a [Section],
    /// Plain strains before the step; `None` in statics.
    pub strain_before: Option<&'a [Sextuple]>,
    /// T of every node: spin over change of its rotational unknown.
    pub spin: &'a [Matrix3<f64>],
}

/// Subtracts the forces of all elements from the right-hand side and, with a `tangent`, adds their slopes to the matrix.
pub(crate) fn add_elements(
    chain: &mut PivotedChain,
    elements: &[BeamElement],
    rest: &[Sextuple],
    span: &Span,
    mixture: Mixture,
    tangent: bool,
) {
    for (i, element) in elements.iter().enumerate() {
        let (now, mean) = (
            [&span.now[i], &span.now[i + 1]],
            [&span.mean[i], &span.mean[i + 1]],
        );
        let after = strain(now[0], now[1], element.length);
        let before = span.strain_before.map_or(after, |strains| strains[i]);
        let step = element.over_step([&before, &after], &rest[i], mixture);
        let (stress, gradient) = (
            step.stress(),
            StrainGradient::new(mean[0], mean[1], element.length),
        );
        for (node, action) in [i, i + 1].into_iter().zip(gradient.tr_mul(&stress)) {
            chain.right[node] -= element.length * action;
        }
        if tangent {
            let after = StrainGradient::new(now[0], now[1], element.length);
            let material = gradient.stiffness(&step.slope(), &after);
            let geometric = GeometricStiffness::new(mean, now, &stress, mixture.share);
            let block = |row: usize, column: usize| {
                let (material, geometric) = (material.block(row, column), geometric.block(row, column));
                let spin = &span.spin[i + column];
                let mut whole = Matrix6::zeros();
                for part in 0..2 {
                    let shift = element.length * material[part][0] + geometric[part][0];
                    let turn = (element.length * material[part][1] + geometric[part][1]) * spin;
                    whole.fixed_view_mut::<3, 3>(3 * part, 0).copy_from(&shift);
                    whole.fixed_view_mut::<3, 3>(3 * part, 3).copy_from(&turn);
                }
                whole
            };
            chain.diagonal[i] += block(0, 0);
            chain.diagonal[i + 1] += block(1, 1);
            chain.upper[i] = block(0, 1);
            chain.lower[i] = block(1, 0);
        }
    }
}
