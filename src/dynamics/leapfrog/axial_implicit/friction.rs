//! A seabed with a slope, soundings or friction under the axial-implicit leapfrog.
//!
//! With the parts of water and damping in its mass M, a node on the seabed obeys M (v − u) = Δt pull + λ_n n + λ_t, u being its velocity
//! without tension and seabed. It is in one of three states, which are assumed before the system in T̄ is solved and checked after:
//!
//! ```text
//! off       λ = 0                                    v = u + M⁻¹ Δt pull
//! slides    λ_t from the last pass                   λ_n = a − b v_n eliminated by a rank-one update, as on a level seabed
//! sticks    v = v_n n                                v_n = (n·M u + a + Δt n·pull)/(n·M n + b): of rank one itself
//! ```
//!
//! a and b are those of [`crate::dynamics::leapfrog::contact`]. After a pass every node on the seabed takes the friction that Coulomb's law allows of the impulse that would stop it
//! ([`crate::physics::friction`]); the step is repeated until states and friction hold. The first assumption follows in the same way from the velocities that
//! the nodes would have under the tensions expected from t_n, without friction. Without friction nodes slide with λ_t = 0.

use super::AxialLine;
use super::rows::{NodeRow, Sizes, under};
use crate::dynamics::leapfrog::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::math::real::choose;
use crate::physics::friction::{Axes, Friction, slide};
use crate::physics::slender::Slender;

/// Change of friction that requires another pass, over the greater of the push of the seabed and the greatest tension [-].
const FRICTION_TOLERANCE: f64 = 1e-4;

/// State of a row of nodes on the seabed.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeabedRow {
    /// 1 where nodes slide or stick, else −1.
    slides: Lanes,
    sticks: Lanes,
    /// Normal n of the seabed [-].
    normal: Vectors,
    /// Inverse mass off the seabed [1/kg].
    inverse: Slender<Lanes>,
    /// λ_t of nodes that slide [N s].
    friction: Vectors,
}

impl SeabedRow {
    /// Nodes off a seabed with a normal, with an inverse mass [1/kg].
    #[inline(always)]
    fn off(normal: Vectors, inverse: Slender<Lanes>) -> SeabedRow {
        let off = Lanes::splat(-1.0);
        SeabedRow {
            slides: off,
            sticks: off,
            normal,
            inverse,
            friction: Vectors::zero(),
        }
    }

    /// Nodes without a seabed.
    pub(super) fn new() -> SeabedRow {
        let zero = Lanes::splat(0.0);
        SeabedRow::off(
            Vectors::zero(),
            Slender {
                across: zero,
                excess: zero,
            },
        )
    }

    /// Impulse of friction in the pass that gave the nodes a velocity [m/s] under an impulse of the segments [N s].
    #[inline(always)]
    fn needed(&self, node: &NodeRow, velocity: Vectors) -> Vectors {
        let moving = choose(self.slides, self.friction, Vectors::zero());
        if !self.sticks.any_positive() {
            return moving;
        }
        let mass = self.inverse.inverted();
        let momentum = mass.times(velocity - node.fall, node.tangent) - node.impulse;
        let holding = momentum - self.normal.scale(self.normal.dot(momentum));
        choose(self.sticks, holding, moving)
    }

    /// Revises states and friction from a velocity [m/s], under an impulse of the greatest tension [N s]; positive where they change.
    #[inline(always)]
    fn revise(
        &mut self,
        node: &NodeRow,
        velocity: Vectors,
        friction: Option<&Friction>,
        greatest: Lanes,
    ) -> Lanes {
        let [on, off] = [1.0, -1.0].map(Lanes::splat);
        let rise = self.normal.dot(velocity);
        let pushes = node.contact.push(rise).where_positive(node.free);
        let before = *self;
        (self.slides, self.sticks) = (pushes.choose(on, off), off);
        let mut changed = Lanes::splat(0.0);
        if let (Some(friction), true) = (friction, pushes.any_positive()) {
            let push = node.contact.push(rise);
            let needed = before.needed(node, velocity);
            let (axes, mass) = (Axes::new(self.normal, node.tangent), self.inverse.inverted());
            let along = mass.across + mass.excess * axes.share * axes.share;
            let yields = [along.recip(), self.inverse.across];
            let sliding = [axes.along.dot(velocity), axes.across.dot(velocity)];
            let holding = [
                axes.along.dot(needed) - sliding[0] * along,
                axes.across.dot(needed) - sliding[1] * mass.across,
            ];
            let found = slide(holding, yields, friction.limits(axes.share, push));
            let moves = pushes.choose(found.slides, off);
            self.slides = moves.choose(on, off);
            self.sticks = moves.choose(off, pushes.choose(on, off));
            self.friction = choose(moves, axes.combine(found.force), self.friction);
            let step = self.friction - before.friction;
            let more = step.dot(step).sqrt() - Lanes::splat(FRICTION_TOLERANCE) * push.max(greatest);
            changed = more.where_positive(moves);
        }
        let flips = off * (self.slides * before.slides).min(self.sticks * before.sticks);
        changed.max(flips)
    }
}

impl NodeRow {
    /// Puts the seabed into the equations of the nodes.
    #[inline(always)]
    fn settle_on(&mut self, seabed: &SeabedRow) {
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        (self.across, self.excess) = (seabed.inverse.across, seabed.inverse.excess);
        (self.held, self.loose) = (zero, self.fall);
        if !seabed.slides.max(seabed.sticks).any_positive() {
            return;
        }
        let (inverse, normal) = (seabed.inverse, seabed.normal);
        let (spring, resistance) = (self.contact.spring, self.contact.resistance);
        // sliding
        let response = inverse.times(normal, self.tangent);
        let fall = self.fall + inverse.times(seabed.friction, self.tangent);
        let share = (one + resistance * normal.dot(response)).recip();
        let push = (spring - resistance * normal.dot(fall)) * share;
        // sticking
        let mass = inverse.inverted();
        let softness = (normal.dot(mass.times(normal, self.tangent)) + resistance).recip();
        let momentum = normal.dot(mass.times(self.fall, self.tangent)) + spring;
        let (slides, sticks) = (seabed.slides, seabed.sticks);
        self.across = sticks.choose(zero, self.across);
        self.excess = sticks.choose(zero, self.excess);
        self.held = sticks.choose(zero - softness, (resistance * share).where_positive(slides));
        self.response = choose(sticks, normal, response);
        let slid = choose(slides, fall + response.scale(push), self.fall);
        self.loose = choose(sticks, normal.scale(momentum * softness), slid);
    }
}

impl AxialLine {
    /// Finds the nodes on the seabed, and the state and the friction that they are first assumed to have.
    #[inline(always)]
    pub(super) fn meet_seabed(&mut self, sizes: &Sizes) {
        let line = &self.layout;
        let (Some(contact), Some(seabed)) = (&line.contact, line.seabed()) else {
            return;
        };
        for at in line.rows() {
            let (node, row) = (
                &mut self.kernel.rows.nodes[at - 1],
                &mut self.kernel.seabed[at - 1],
            );
            let (normal, velocity) = (seabed.normal.load(at), line.velocity.load(at));
            node.contact = contact.over_step(at, sizes.kick);
            let inverse = Slender {
                across: node.across,
                excess: node.excess,
            };
            *row = SeabedRow::off(normal, inverse);
            row.slides = node.contact.push(normal.dot(velocity)).where_positive(node.free);
            node.settle_on(row);
        }
        if self.layout.friction().is_some() {
            let greatest = self.expect_tensions(sizes);
            self.seabed_holds(greatest, sizes);
        }
    }

    /// Finds the velocities under the tensions that follow from t_n at unchanged stretching velocities. Returns the greatest tension in each lane [N].
    #[inline(always)]
    fn expect_tensions(&mut self, sizes: &Sizes) -> Lanes {
        let mut greatest = Lanes::splat(0.0);
        for segment in &mut self.kernel.rows.segments {
            let along = segment.along;
            let total = segment.spring(along) + segment.pull(segment.rate(along, sizes), sizes);
            segment.tension = total.positive();
            greatest = greatest.max(segment.tension);
        }
        let segments = &self.kernel.rows.segments;
        let before = segments[segments.len() - 1].tension.moved_up();
        self.find_velocities::<{ under::ROUGH }>(before, sizes);
        greatest
    }

    /// Compares the states with those assumed, under a greatest tension in the lanes [N]; false if that requires another pass.
    #[inline(always)]
    pub(super) fn seabed_holds(&mut self, greatest: Lanes, sizes: &Sizes) -> bool {
        let (line, friction) = (&self.layout, self.layout.friction());
        let mut changed = Lanes::splat(0.0);
        let greatest = sizes.kick * greatest.greatest();
        for at in line.rows() {
            let (node, seabed) = (
                &mut self.kernel.rows.nodes[at - 1],
                &mut self.kernel.seabed[at - 1],
            );
            let change = seabed.revise(node, line.velocity_before.load(at), friction, greatest);
            if change.any_positive() {
                node.settle_on(seabed);
            }
            changed = changed.max(change);
        }
        !changed.any_positive()
    }

    /// Keeps the friction of the step for the state.
    #[inline(always)]
    pub(super) fn keep_friction(&mut self, step: Step) {
        let per_kick = Lanes::splat(1.0 / step.kick);
        for at in self.layout.rows() {
            let needed = self.kernel.seabed[at - 1].needed(
                &self.kernel.rows.nodes[at - 1],
                self.layout.velocity_before.load(at),
            );
            self.layout.set_friction(at, needed.scale(per_kick));
        }
    }
}
