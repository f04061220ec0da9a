//! A geometrically exact beam at rest, from the laws of its sections to forces and moments on its nodes.
//!
//! The unknowns are position and spin of every node. With the gradient B of the strains (see [`crate::physics::section`]), the out-of-balance forces
//! and moments of the nodes are
//!
//!   R = Σ L Bᵀ S + w ẑ − contact − loads,   J = Σ (L Bᵀ C B + geometric part) + contact.
//!
//! The elements of a time step are the same, with the gradient at the mean of the states before and after it. Four elements are computed side by
//! side.
//!
//! A beam whose ends do not prevent its rotation about its axis has no resistance to it. Its first node then gets a resistance to rotation about d₃,
//! which changes the iteration but not the equilibrium.

use nalgebra::{Matrix3, Vector3};
use pulp::NullaryFnOnce;

use crate::math::lanes::{LANES, Lanes, Vectors};
use crate::math::pivoted_chain::{Block, BlockLanes, PivotedChain};
use crate::math::triad::{Triad, each};
use crate::math::unit::VectorUnit;
use crate::model::{BeamElement, FreePoint, Point};
use crate::physics::seabed::{PARTS, Part};
use crate::physics::section::{
    Mixture, Pair, Section, SectionLaw, Sextuple, Station, StepStrain, Stiffness, StrainGradient, join,
    split, strain_between,
};

/// Constraints and loads of an end of a beam; none by default.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BeamEnd {
    /// True for prescribed unknowns: x, y, z and the rotations about them.
    pub held: [bool; 6],
    /// Force [N] and moment [N m] on the end, along the global axes.
    pub load: Sextuple,
}

/// Constraints of an end at a point: the axes along which the point is not free, and the clamp.
pub(crate) fn end_hold(point: &Point, clamped: bool) -> BeamEnd {
    let [x, y, z] = point.free().map_or([false; 3], |free| free.axes);
    BeamEnd {
        held: [!x, !y, !z, clamped, clamped, clamped],
        load: Sextuple::zeros(),
    }
}

/// Beam with its constraints and loads.
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

/// Fractions of the loads that act [-].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LoadShare {
    /// Fraction of weight, buoyancy and forces.
    pub force: f64,
    /// Fraction of the moments on the ends.
    pub moment: f64,
}

impl LoadShare {
    pub(crate) const WHOLE: LoadShare = LoadShare {
        force: 1.0,
        moment: 1.0,
    };

    /// Acting load on an end.
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

/// Adds vertical forces on the two nodes of an element [N] and minus their slopes with respect to the heights of the nodes [N/m].
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
    /// Sets the system of a beam at `sections` under a `share` of its loads: tangent J, right-hand side −R. `four` is workspace.
    pub(crate) fn assemble(
        &self,
        chain: &mut PivotedChain,
        sections: &[Section],
        share: LoadShare,
        four: &mut Vec<FourElements>,
    ) {
        chain.clear();
        let still = Mixture {
            share: 1.0,
            rate: 0.0,
        };
        FourElements::gather(four, &self.elements, &self.rest, sections);
        add_elements(chain, four, sections, still, true);
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
            if let Some((stiffness, push)) = body.seabed_at_rest(height) {
                chain.right[node].z += push;
                chain.diagonal[node][(2, 2)] += stiffness;
            }
        }
    }

    /// Sets the changes of the prescribed unknowns to zero, and adds the resistance of the first node to rotation of the beam about its axis.
    pub(crate) fn constrain(&self, chain: &mut PivotedChain, sections: &[Section]) {
        let turns_freely = self.ends.iter().all(|end| end.held[3..].iter().all(|held| !held));
        if turns_freely {
            let element = &self.elements[0];
            let axis: Vector3<f64> = sections[0].frame.column(2).into_owned();
            let brake = element.law.torsion / element.length * axis * axis.transpose();
            for (row, column) in (0..9).map(|k| (k % 3, k / 3)) {
                chain.diagonal[0][(3 + row, 3 + column)] += brake[(row, column)];
            }
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
                let seabed = body.seabed_at_rest(position.z);
                add(seabed.map_or(0.0, |(stiffness, push)| 0.5 * push * push / stiffness));
            }
        }
        Energy { value, size }
    }
}

/// Cosine of the turn from node to node below which an element is refused [-]: 60°; its moment is largest at 56°.
const COSINE_MIN: f64 = 0.5;

/// Returns the lower node of the first element that turns by more than its strains can resolve.
pub(crate) fn folded(sections: &[Section]) -> Option<usize> {
    let cosine = |pair: &[Section]| 0.5 * (pair[0].frame.dot(&pair[1].frame) - 1.0);
    sections.windows(2).position(|pair| cosine(pair) < COSINE_MIN)
}

/// Indices of four items from `first` on; those beyond `last` are replaced by it.
#[inline(always)]
pub(crate) fn four(first: usize, last: usize) -> [usize; LANES] {
    each!(i in [first, first + 1, first + 2, first + 3] => i.min(last))
}

/// Items at four indices.
#[inline(always)]
pub(crate) fn items<T>(of: &[T], [a, b, c, d]: [usize; LANES]) -> [&T; LANES] {
    [&of[a], &of[b], &of[c], &of[d]]
}

/// Numbers of four items side by side.
macro_rules! numbers {
    ($item:ident in $items:expr => $value:expr) => {{
        let [a, b, c, d] = $items;
        Lanes::new(each!($item in [a, b, c, d] => $value))
    }};
}
pub(crate) use numbers;

/// Vectors of four items side by side.
macro_rules! vectors {
    ($item:ident in $items:expr => $value:expr) => {{
        let [a, b, c, d] = $items;
        Vectors::new(each!($item in [a, b, c, d] => $value))
    }};
}
pub(crate) use vectors;

/// Columns of four matrices.
#[inline(always)]
pub(crate) fn triads(matrices: [&Matrix3<f64>; LANES]) -> Triad<Vectors> {
    Triad(each!(j in [0, 1, 2] => {
        vectors!(m in matrices => Vector3::new(m[(0, j)], m[(1, j)], m[(2, j)]))
    }))
}

/// Four sections.
#[inline(always)]
pub(crate) fn stations(sections: &[Section], at: [usize; LANES]) -> Station<Vectors> {
    let [a, b, c, d] = items(sections, at);
    Station {
        position: vectors!(section in [a, b, c, d] => section.position),
        directors: triads([&a.frame, &b.frame, &c.frame, &d.frame]),
    }
}

/// Four strains, or forces and moments.
#[inline(always)]
pub(crate) fn pairs(strains: &[Sextuple], at: [usize; LANES]) -> Pair<Vectors> {
    let strains = items(strains, at);
    each!(k in [0, 3] => vectors!(strain in strains => Vector3::new(strain[k], strain[k + 1], strain[k + 2])))
}

/// Factors of the strains of four elements in a law, as in [`SectionLaw::diagonal`].
#[inline(always)]
fn laws(laws: [&SectionLaw; LANES]) -> Pair<Vectors> {
    let shear = numbers!(law in laws => law.shear);
    let bending = numbers!(law in laws => law.bending);
    [
        Vectors {
            x: shear,
            y: shear,
            z: numbers!(law in laws => law.axial),
        },
        Vectors {
            x: bending,
            y: bending,
            z: numbers!(law in laws => law.torsion),
        },
    ]
}

/// Four elements side by side, before a step or at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FourElements {
    length: Lanes,
    laws: [Pair<Vectors>; 2],
    rest: Pair<Vectors>,
    sections: [Station<Vectors>; 2],
    strain: Pair<Vectors>,
}

impl FourElements {
    /// Replaces `into` by all elements, between the sections before a step or, at rest, between the present ones.
    pub(crate) fn gather(
        into: &mut Vec<FourElements>,
        elements: &[BeamElement],
        rest: &[Sextuple],
        sections: &[Section],
    ) {
        into.clear();
        let firsts = (0..elements.len()).step_by(LANES);
        into.extend(firsts.map(|first| {
            let at = four(first, elements.len() - 1);
            let [p, q, r, s] = items(elements, at);
            let [i, j, k, l] = at;
            let sections = [at, [i + 1, j + 1, k + 1, l + 1]].map(|at| stations(sections, at));
            let length = numbers!(element in [p, q, r, s] => element.length);
            FourElements {
                length,
                laws: [
                    laws([&p.law, &q.law, &r.law, &s.law]),
                    laws([&p.damping, &q.damping, &r.damping, &s.damping]),
                ],
                rest: pairs(rest, at),
                strain: strain_between(&sections[0], &sections[1], length),
                sections,
            }
        }));
    }
}

/// Operation of [`add_elements`] on a chain.
struct AddElements<'a> {
    chain: &'a mut PivotedChain,
    elements: &'a [FourElements],
    now: &'a [Section],
    mixture: Mixture,
    tangent: bool,
}

/// Subtracts the forces of all elements, with the sections `now` after a step or at rest, from the right-hand side. With a `tangent`, adds their
/// slopes with respect to positions and spins to the matrix, where the off-diagonal blocks are overwritten.
pub(crate) fn add_elements(
    chain: &mut PivotedChain,
    elements: &[FourElements],
    now: &[Section],
    mixture: Mixture,
    tangent: bool,
) {
    VectorUnit::best().dispatch(AddElements {
        chain,
        elements,
        now,
        mixture,
        tangent,
    });
}

impl NullaryFnOnce for AddElements<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        for (k, four) in self.elements.iter().enumerate() {
            self.add_four(LANES * k, four);
        }
    }
}

impl AddElements<'_> {
    /// Adds four elements, from the element `first` on.
    #[inline(always)]
    fn add_four(&mut self, first: usize, elements: &FourElements) {
        let last = self.now.len() - 2;
        let [i, j, k, l] = four(first, last);
        let ends = [[i, j, k, l], [i + 1, j + 1, k + 1, l + 1]];
        let now = each!(end in [0, 1] => stations(self.now, ends[end]));
        let mean = each!(end in [0, 1] => elements.sections[end].mean(&now[end]));
        let length = elements.length;
        let step = StepStrain {
            laws: elements.laws,
            length,
            strains: [elements.strain, strain_between(&now[0], &now[1], length)],
            rest: elements.rest,
            mixture: self.mixture,
        };
        let (stress, gradient) = (step.stress(), StrainGradient::new(&mean[0], &mean[1]));
        let count = LANES.min(last + 1 - first);
        subtract_actions(&mut self.chain.right[first..], count, &gradient.tr_times(stress));
        if self.tangent {
            let end = StrainGradient::new(&now[0], &now[1]);
            let mut stiffness = gradient.stiffness(&step.slope(), &end, length);
            let ([a, b], [c, d]) = (&mean, &now);
            stiffness.add_geometric([a, b], [c, d], stress, self.mixture.share);
            self.add_stiffness(first, count, &stiffness);
        }
    }

    /// Adds the tangent of `count` elements from the element `first` on.
    #[inline(always)]
    fn add_stiffness(&mut self, first: usize, count: usize, stiffness: &Stiffness<Vectors>) {
        let Stiffness {
            shift,
            pulled,
            swept,
            turned,
        } = stiffness;
        let minus = Lanes::splat(-1.0);
        let back = shift.scaled(minus);
        let pulled_back = each!(y in [0, 1] => pulled[y].scaled(minus));
        let swept_back = each!(x in [0, 1] => swept[x].scaled(minus));
        let at_a = blocks([shift, &pulled_back[0], &swept_back[0], &turned[0][0]]);
        let at_b = blocks([shift, &pulled[1], &swept[1], &turned[1][1]]);
        let upper = blocks([&back, &pulled_back[1], &swept[0], &turned[0][1]]);
        let lower = blocks([&back, &pulled[0], &swept_back[1], &turned[1][0]]);
        add_blocks(self.chain, first, count, &[at_a, at_b, upper, lower]);
    }
}

/// Subtracts forces and moments of elements from those on their nodes. Not inlined, so that the vectors of the caller are not split into scalars.
#[inline(never)]
fn subtract_actions(right: &mut [Sextuple], count: usize, actions: &[Pair<Vectors>; 2]) {
    for (side, [force, moment]) in actions.iter().enumerate() {
        for (lane, right) in right[side..].iter_mut().take(count).enumerate() {
            *right -= join(force.get(lane), moment.get(lane));
        }
    }
}

/// Adds the blocks of `count` elements, from the element `first` on. Not inlined for the same reason as [`subtract_actions`].
#[inline(never)]
fn add_blocks(
    chain: &mut PivotedChain,
    first: usize,
    count: usize,
    [at_a, at_b, upper, lower]: &[BlockLanes; 4],
) {
    for lane in 0..count {
        let i = first + lane;
        chain.diagonal[i] += Block::of_lane(at_a, lane);
        chain.diagonal[i + 1] += Block::of_lane(at_b, lane);
        chain.upper[i] = Block::of_lane(upper, lane);
        chain.lower[i] = Block::of_lane(lower, lane);
    }
}

/// Blocks [[a, b], [c, d]] of four nodes.
#[inline(always)]
pub(crate) fn blocks([a, b, c, d]: [&Triad<Vectors>; 4]) -> BlockLanes {
    let [[a0, a1, a2], [b0, b1, b2]] = each!(columns in [[a, c], [b, d]] => {
        each!(j in [0, 1, 2] => {
            let (upper, lower) = (columns[0].0[j], columns[1].0[j]);
            [upper.x, upper.y, upper.z, lower.x, lower.y, lower.z]
        })
    });
    [a0, a1, a2, b0, b1, b2]
}
