//! Nodes of a beam over a step, four in lanes: their frames, inertia, weight and mass damping.

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::{BeamStep, BeamWork, beam_state};
use crate::elements::beam::{blocks, four, items, numbers, pairs, stations, triads, vectors};
use crate::math::lanes::{LANES, Lanes, Vectors};
use crate::math::pivoted_chain::{Block, BlockLanes};
use crate::math::rotation::{cayley_of_spin, turned_by_cayley};
use crate::math::triad::{Triad, componentwise, each, repeated};
use crate::model::LineState;
use crate::physics::section::{Pair, Section, Sextuple, Station, join};

/// State of four nodes before a step, in lanes.
#[derive(Debug, Clone, Copy)]
pub(super) struct FourNodes {
    section: Station<Vectors>,
    velocity: Vectors,
    /// Angular velocity along the directors [rad/s].
    spin: Vectors,
    /// Angular momentum along the global axes [N m s].
    momentum: Vectors,
    mass: Triad<Vectors>,
    rotary_inertia: Vectors,
    weight: Lanes,
    damping: Lanes,
}

impl FourNodes {
    pub(super) fn gather(work: &mut BeamWork, case: &BeamStep, shape: &LineState) {
        let (state, nodes, last) = (beam_state(shape), case.nodes, work.before.len() - 1);
        work.nodes.clear();
        for first in (0..=last).step_by(LANES) {
            let at = four(first, last);
            let section = stations(&work.before, at);
            let spin = vectors!(spin in items(&state.spins, at) => *spin);
            let inertia = vectors!(inertia in items(&case.beam.rotary_inertia, at) => *inertia);
            let damping = match &nodes.mass_damping {
                Some(damping) => numbers!(damping in items(damping, at) => *damping),
                None => Lanes::splat(0.0),
            };
            work.nodes.push(FourNodes {
                velocity: vectors!(velocity in items(&shape.velocity, at) => *velocity),
                momentum: section.directors.times(componentwise(inertia, spin)),
                mass: triads(items(&work.mass, at)),
                weight: numbers!(weight in items(&nodes.weight, at) => *weight),
                rotary_inertia: inertia,
                section,
                spin,
                damping,
            });
        }
    }

    /// Minus the slopes of the forces and moments with position and spin, for the directors and angular momenta [N m s] after a step with rotation θ.
    /// `per_step` is the inverse of the step length [1/s].
    #[inline(always)]
    fn slopes(&self, now: &Triad<Vectors>, momentum: Vectors, theta: Vectors, per_step: Lanes) -> BlockLanes {
        let twice = per_step + per_step;
        let shift = self.mass.scaled(twice * per_step) + Triad::diagonal(repeated(self.damping * per_step));
        let (back, before) = (Vectors::zero() - theta, &self.section.directors);
        let turned = Triad(each!(i in [0, 1, 2] => cayley_of_spin(back, before.0[i])));
        let inertia = now.weighted(self.rotary_inertia.scale(twice));
        let turn = (Triad::outer(&inertia, &turned) - Triad::skew(momentum)).scaled(per_step);
        let zero = Triad([Vectors::zero(); 3]);
        blocks([&shift, &zero, &zero, &turn])
    }
}

/// Converts the spins in the solution of the linear system to changes of θ; returns the squares of the largest changes of position [m²] and of θ [-].
pub(super) struct Changes<'a>(pub &'a mut BeamWork);

impl NullaryFnOnce for Changes<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn call(self) -> [f64; 2] {
        let BeamWork { chain, theta, .. } = self.0;
        let (last, zero) = (theta.len() - 1, Lanes::splat(0.0));
        let (mut moved, mut turned) = (zero, zero);
        for first in (0..=last).step_by(LANES) {
            let at = four(first, last);
            let [position, spin] = pairs(&chain.right, at);
            let change = cayley_of_spin(vectors!(theta in items(theta, at) => *theta), spin);
            moved = moved.max(position.dot(position));
            turned = turned.max(change.dot(change));
            set_right(&mut chain.right[first..], &[position, change]);
        }
        [moved.greatest()[0], turned.greatest()[0]]
    }
}

/// Moves positions and θ by a fraction `part` of their changes, and rotates the frames before the step by θ; returns the largest |θ|² [-].
pub(super) struct Move<'a> {
    pub work: &'a mut BeamWork,
    pub part: f64,
}

impl NullaryFnOnce for Move<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let BeamWork {
            chain,
            nodes,
            now,
            theta,
            ..
        } = self.work;
        let (last, part) = (theta.len() - 1, Lanes::splat(self.part));
        let mut greatest = Lanes::splat(0.0);
        for (k, nodes) in nodes.iter().enumerate() {
            let (first, at) = (LANES * k, four(LANES * k, last));
            let [position, change] = pairs(&chain.right, at);
            let position = vectors!(section in items(now, at) => section.position) + position.scale(part);
            let turn = vectors!(theta in items(theta, at) => *theta) + change.scale(part);
            greatest = greatest.max(turn.dot(turn));
            let directors = turned_by_cayley(turn, &nodes.section.directors);
            let section = Station { position, directors };
            set_sections(&mut now[first..], &mut theta[first..], &section, &turn);
        }
        greatest.greatest()[0]
    }
}

/// Sets the residual forces at the nodes to those of inertia, weight and mass damping over a step of `length` [s] and, if `tangent` is true, the
/// diagonal blocks to minus their slopes with position and spin.
pub(super) struct SetNodes<'a> {
    pub work: &'a mut BeamWork,
    pub length: f64,
    pub tangent: bool,
}

impl NullaryFnOnce for SetNodes<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let BeamWork {
            chain,
            nodes,
            now,
            theta,
            ..
        } = self.work;
        let per_step = Lanes::splat(1.0 / self.length);
        let twice = per_step + per_step;
        for (k, nodes) in nodes.iter().enumerate() {
            let (first, at) = (LANES * k, four(LANES * k, now.len() - 1));
            let after = stations(now, at);
            let theta = vectors!(theta in items(theta, at) => *theta);
            let rate = (after.position - nodes.section.position).scale(per_step);
            let acceleration = (rate - nodes.velocity).scale(twice);
            let mut force = Vectors::zero() - nodes.mass.times(acceleration) - rate.scale(nodes.damping);
            force.z = force.z - nodes.weight;
            let spin = nodes.section.directors.tr_times(theta).scale(twice) - nodes.spin;
            let momentum = after.directors.times(componentwise(nodes.rotary_inertia, spin));
            let moment = (nodes.momentum - momentum).scale(per_step);
            set_right(&mut chain.right[first..], &[force, moment]);
            if self.tangent {
                let slopes = nodes.slopes(&after.directors, momentum, theta, per_step);
                set_diagonal(&mut chain.diagonal[first..], &slopes);
            }
        }
    }
}

/// Sets forces and moments on nodes. Not inlined, so that the vectors of the caller are not split into scalars.
#[inline(never)]
fn set_right(right: &mut [Sextuple], [force, moment]: &Pair<Vectors>) {
    for (lane, right) in right.iter_mut().take(LANES).enumerate() {
        *right = join(force.get(lane), moment.get(lane));
    }
}

/// Sets diagonal blocks; not inlined, as [`set_right`].
#[inline(never)]
fn set_diagonal(diagonal: &mut [Block], blocks: &BlockLanes) {
    for (lane, block) in diagonal.iter_mut().take(LANES).enumerate() {
        *block = Block::of_lane(blocks, lane);
    }
}

/// Sets sections and their θ; not inlined, as [`set_right`].
#[inline(never)]
fn set_sections(sections: &mut [Section], theta: &mut [Vector3<f64>], to: &Station<Vectors>, turn: &Vectors) {
    for (lane, (section, theta)) in sections.iter_mut().zip(theta).take(LANES).enumerate() {
        section.position = to.position.get(lane);
        for (j, column) in to.directors.0.iter().enumerate() {
            section.frame.set_column(j, &column.get(lane));
        }
        *theta = turn.get(lane);
    }
}
