//! Contact of the axial-implicit leapfrog with a seabed with a slope, soundings or friction.
//!
//! A node on the seabed obeys M (v − u) = Δt pull + λ_n n + λ_t. Its mass M includes the implicit parts of drag and damping, and u is its velocity
//! without tension and seabed. The node has one of three states, which are assumed before the system in T̄ is solved, and checked afterwards:
//!
//! ```text
//! off       λ = 0                                    v = u + M⁻¹ Δt pull
//! slides    λ_t from the last pass                   λ_n = a − b v_n eliminated by a rank-one update, as on a level seabed
//! sticks    v = v_n n                                v_n = (n·M u + a + Δt n·pull)/(n·M n + b): of rank one itself
//! ```
//!
//! a and b are those of [`crate::dynamics::leapfrog::contact`]. After a pass, the friction on every node on the seabed is revised by Coulomb's law
//! ([`crate::physics::friction`]), for the velocity along the seabed without friction and with the normal velocity of the pass. With the inverse mass W in
//! the axes of [`Footing`] and d the determinant of its block of n and a, this velocity is
//!
//! ```text
//! v⁰_a = u_a + (d Δt pull_a + W_na (v_n − u_n))/W_nn,   with the compliance d/W_nn to λ_a;   v⁰_b = u_b + W_bb Δt pull_b
//! ```
//!
//! The step is repeated until states and friction have converged. The first assumption follows in the same way from the velocities that the nodes
//! would have under the tensions expected from t_n, without friction. On a seabed without friction, nodes slide with λ_t = 0.

use super::AxialLine;
use super::rows::{NodeRow, Sizes, under};
use crate::dynamics::leapfrog::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::math::real::choose;
use crate::physics::friction::Friction;
use crate::physics::friction_step::Footing;
use crate::physics::slender::Slender;

/// Change of friction that requires another pass, relative to the larger of the push of the seabed and the largest tension [-].
const FRICTION_TOLERANCE: f64 = 1e-4;

/// State of a row of nodes on the seabed.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeabedRow {
    /// 1 for nodes that slide or, in `sticks`, stick; else −1.
    slides: Lanes,
    sticks: Lanes,
    /// Normal n of the seabed [-].
    normal: Vectors,
    /// Inverse mass without seabed [1/kg], W n [1/kg], and 1/(1 + b W_nn) [-].
    inverse: Slender<Lanes>,
    response: Vectors,
    softness: Lanes,
    /// Inverse mass in the axes of the seabed.
    rough: RoughRow,
    /// λ_t [N s].
    friction: Vectors,
}

/// Inverse mass of a row of nodes on a seabed with friction.
#[derive(Debug, Clone, Copy)]
struct RoughRow {
    footing: Footing<Vectors>,
    /// 1/W_nn [kg].
    upright: Lanes,
    /// 1/(W_aa + b d) [kg].
    stuck: Lanes,
}

impl RoughRow {
    /// Row of nodes with an inverse mass [1/kg], a tangent [-] and W_nn = `yields` [1/kg], on a seabed with a normal [-] and a resistance b [kg].
    #[inline(always)]
    fn new(
        inverse: Slender<Lanes>,
        [normal, tangent]: [Vectors; 2],
        [yields, resistance]: [Lanes; 2],
    ) -> RoughRow {
        let footing = Footing::new(inverse, normal, tangent, Lanes::splat(1.0));
        RoughRow {
            upright: yields.recip(),
            stuck: footing.stuck(resistance),
            footing,
        }
    }
}

impl SeabedRow {
    pub(super) fn new() -> SeabedRow {
        let ([zero, off], none) = ([0.0, -1.0].map(Lanes::splat), Vectors::zero());
        let inverse = Slender {
            across: zero,
            excess: zero,
        };
        SeabedRow {
            slides: off,
            sticks: off,
            normal: none,
            inverse,
            response: none,
            softness: zero,
            rough: RoughRow::new(inverse, [none; 2], [zero; 2]),
            friction: none,
        }
    }

    /// Sets normal and inverse mass of nodes that may touch the seabed.
    #[inline(always)]
    fn approach(&mut self, node: &NodeRow, normal: Vectors, has_friction: bool) {
        let inverse = Slender {
            across: node.across,
            excess: node.excess,
        };
        let response = inverse.times(normal, node.tangent);
        let (yields, resistance) = (normal.dot(response), node.contact.resistance);
        (self.normal, self.inverse, self.response) = (normal, inverse, response);
        self.softness = (Lanes::splat(1.0) + resistance * yields).recip();
        if has_friction {
            self.rough = RoughRow::new(inverse, [normal, node.tangent], [yields, resistance]);
        }
    }

    /// Revises states and friction for a velocity [m/s]; `greatest` is the impulse of the largest tension [N s]. Returns a positive value where they change.
    #[inline(always)]
    fn revise(
        &mut self,
        node: &NodeRow,
        velocity: Vectors,
        friction: Option<&Friction>,
        greatest: Lanes,
    ) -> Lanes {
        let [zero, on, off] = [0.0, 1.0, -1.0].map(Lanes::splat);
        let rise = self.normal.dot(velocity);
        let pushes = node.contact.push(rise).where_positive(node.free);
        let before = [self.slides, self.sticks];
        (self.slides, self.sticks) = (pushes.choose(on, off), off);
        let mut changed = zero;
        if let Some(friction) = friction {
            let (old, mut moves) = (self.friction, off);
            self.friction = Vectors::zero();
            if pushes.any_positive() {
                let (slides, found) = self.friction_on(node, rise, friction, pushes);
                moves = pushes.choose(slides, off);
                self.slides = moves.choose(on, off);
                self.sticks = moves.choose(off, pushes.choose(on, off));
                self.friction = choose(pushes, found, self.friction);
            }
            let step = self.friction - old;
            let allowed = Lanes::splat(FRICTION_TOLERANCE) * pushes.max(greatest);
            changed = (step.dot(step) - allowed * allowed).where_positive(moves);
        }
        let flips = off * (self.slides * before[0]).min(self.sticks * before[1]);
        changed.max(flips)
    }

    /// Impulse of friction [N s] on nodes that leave the seabed at `rise` [m/s] under the impulse `push` of the seabed [N s]. The first value is positive for
    /// nodes that slide.
    #[inline(always)]
    fn friction_on(&self, node: &NodeRow, rise: Lanes, friction: &Friction, push: Lanes) -> (Lanes, Vectors) {
        let RoughRow { footing, upright, .. } = &self.rough;
        let axes = &footing.axes;
        let sunk = rise - self.normal.dot(node.fall);
        let pulled = footing.determinant * axes.along.dot(node.impulse) + footing.coupling[1] * sunk;
        let sliding = [
            axes.along.dot(node.fall) + pulled * *upright,
            axes.across.dot(node.fall) + footing.yields[1] * axes.across.dot(node.impulse),
        ];
        let found = footing.slide(sliding, footing.determinant * *upright, friction, push);
        let against = Lanes::splat(-1.0);
        let grip = [against * found.grip[0], against * found.grip[1]];
        (found.slides, footing.combine(sliding, grip))
    }
}

impl NodeRow {
    /// Adds the seabed to the equations of motion of the nodes.
    #[inline(always)]
    fn settle_on(&mut self, seabed: &SeabedRow, has_friction: bool) {
        let (zero, slides) = (Lanes::splat(0.0), seabed.slides);
        let (spring, resistance) = (self.contact.spring, self.contact.resistance);
        let (inverse, normal) = (seabed.inverse, seabed.normal);
        let mut fall = self.fall;
        if has_friction {
            fall = fall + inverse.times(seabed.friction, self.tangent);
        }
        let push = (spring - resistance * normal.dot(fall)) * seabed.softness;
        self.held = (resistance * seabed.softness).where_positive(slides);
        self.loose = choose(slides, fall + seabed.response.scale(push), self.fall);
        self.response = seabed.response;
        if !has_friction {
            return;
        }
        let (sticks, RoughRow { footing, stuck, .. }) = (seabed.sticks, seabed.rough);
        let sinking = footing.sinking(self.fall, normal, spring, stuck);
        self.across = sticks.choose(zero, inverse.across);
        self.excess = sticks.choose(zero, inverse.excess);
        self.held = sticks.choose(zero - footing.determinant * stuck, self.held);
        self.response = choose(sticks, normal, self.response);
        self.loose = choose(sticks, normal.scale(sinking), self.loose);
    }
}

impl AxialLine {
    /// Finds the nodes on the seabed, and sets their first assumptions of state and friction.
    #[inline(always)]
    pub(super) fn meet_seabed(&mut self, sizes: &Sizes) {
        let line = &self.layout;
        let (Some(contact), Some(seabed)) = (&line.contact, line.seabed()) else {
            return;
        };
        let has_friction = seabed.seabed.friction.is_some();
        for at in line.rows() {
            let (node, row) = (
                &mut self.kernel.rows.nodes[at - 1],
                &mut self.kernel.seabed[at - 1],
            );
            let off = Lanes::splat(-1.0);
            node.contact = contact.over_step(at, sizes.kick);
            (row.slides, row.sticks, row.friction) = (off, off, Vectors::zero());
            if !node.contact.resistance.any_positive() {
                continue;
            }
            let normal = seabed.normal.load(at);
            row.approach(node, normal, has_friction);
            let pushes = node.contact.push(normal.dot(line.velocity.load(at)));
            row.slides = pushes.where_positive(node.free).choose(Lanes::splat(1.0), off);
            if row.slides.any_positive() {
                node.settle_on(row, has_friction);
            }
        }
        if has_friction {
            let greatest = self.expect_tensions(sizes);
            self.seabed_holds(greatest, sizes);
        }
    }

    /// Computes the velocities under the tensions expected from t_n at unchanged stretching velocities. Returns the largest tension in each lane [N].
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

    /// Revises the assumed states; `greatest` is the largest tension in each lane [N]. Returns false if another pass is required.
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
            if !node.contact.resistance.any_positive() {
                continue;
            }
            let change = seabed.revise(node, line.velocity_before.load(at), friction, greatest);
            if change.any_positive() {
                node.settle_on(seabed, friction.is_some());
            }
            changed = changed.max(change);
        }
        !changed.any_positive()
    }

    #[inline(always)]
    pub(super) fn keep_friction(&mut self, step: Step) {
        if self.layout.friction().is_none() {
            return;
        }
        let per_kick = Lanes::splat(1.0 / step.kick);
        for at in self.layout.rows() {
            let friction = self.kernel.seabed[at - 1].friction;
            self.layout.set_friction(at, friction.scale(per_kick));
        }
    }
}
