//! A pass of the axial-implicit leapfrog: the system in T̄, the velocities that follow, and whether they are what was assumed.
//!
//! Loops name the rows by index: with iterators the compiler would see that it may take four rows at once, and take them lane by lane.

use super::AxialWork;
use super::rows::{NodeRow, SegmentRow};
use crate::dynamics::layout::Layout;
use crate::dynamics::leapfrog::Step;
use crate::math::folded_tridiagonal::{Elimination, Equations};
use crate::math::lanes::{Lanes, Vectors};

/// Change of tension by the true stretch, relative to the greatest tension, that asks for another pass [-].
const STRETCH_TOLERANCE: f64 = 1e-3;
/// Square of transverse over axial length up to which the stretch by transverse motion is told by its first term [-].
const FLAT: f64 = 1e-3;
/// Shortest that a segment may get, over its length, for the same [-].
const SHORT: f64 = 0.9;

/// What a pass found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    /// > 0 where the bed pushes other nodes than assumed, or other segments are slack.
    landed: Lanes,
    flipped: Lanes,
    /// Most that T̄ changes by the true stretch [N], told for segments that turn little; > 0 where one turns more.
    bent: Lanes,
    turned: Lanes,
    /// Greatest T̄ [N].
    greatest: Lanes,
    /// Energy lost, and dissipated by the averaging of tensions [J].
    pub lost: Lanes,
    pub numerical: Lanes,
}

impl Found {
    fn new() -> Found {
        let zero = Lanes::splat(0.0);
        Found {
            landed: zero,
            flipped: zero,
            bent: zero,
            turned: zero,
            greatest: zero,
            lost: zero,
            numerical: zero,
        }
    }

    /// Greatest T̄ [N].
    pub fn greatest(&self) -> f64 {
        (0..crate::math::lanes::LANES).fold(0.0, |a, lane| self.greatest[lane].max(a))
    }
}

impl AxialWork {
    /// 1 where dampers act in slack segments, else 0.
    #[inline(always)]
    fn push(&self) -> Lanes {
        Lanes::splat(f64::from(u8::from(self.layout.negative_tension)))
    }

    /// Finds what couples the segments through their nodes.
    #[inline(always)]
    pub(super) fn weigh_nodes<const RUBS: bool>(&mut self) {
        let segments = &self.rows.segments;
        let direction = |at: usize| segments[at].direction;
        let mut q = direction(segments.len() - 1).moved_up();
        for (at, node) in self.rows.nodes.iter_mut().enumerate() {
            if at > 0 {
                q = direction(at - 1);
            }
            node.forms = node.inverse_forms::<RUBS>(q, direction(at));
        }
    }

    /// Writes the rows of the system.
    #[inline(always)]
    pub(super) fn assemble(&mut self, step: Step) {
        let (kick, push) = (Lanes::splat(step.kick), self.push());
        let nodes = &self.rows.nodes;
        let last = nodes.len() - 1;
        for (at, segment) in self.rows.segments.iter_mut().enumerate() {
            let (low, high) = (&nodes[at], &nodes[(at + 1).min(last)]);
            let relative = high.loose - low.loose;
            segment.assemble(kick, push, relative, [low.forms, high.forms]);
        }
        let (low, high) = (&nodes[last], &nodes[0]);
        let relative = high.loose.moved_down() - low.loose;
        let forms = [low.forms, high.forms.map(Lanes::moved_down)];
        self.rows.segments[last].assemble(kick, push, relative, forms);
    }

    /// Solves for T̄: down the rows and up again.
    #[inline(always)]
    pub(super) fn solve_tensions(&mut self) {
        let Some((last, others)) = self.rows.segments.split_last_mut() else {
            return;
        };
        let mut elimination = Elimination::start();
        for segment in others.iter_mut() {
            segment.eliminated = elimination.eliminate(segment.equations);
        }
        let (before, mut tension) = elimination.close(last.equations);
        self.tension_before = before;
        last.tension = tension;
        for segment in others.iter_mut().rev() {
            tension = segment.eliminated.substitute(before, tension);
            segment.tension = tension;
        }
    }

    /// New velocities from T̄, into `velocity_before`, and what they say about the assumptions.
    #[inline(always)]
    pub(super) fn find_velocities<const RUBS: bool>(&mut self, step: Step) -> Found {
        let mut found = Found::new();
        let segments = &self.rows.segments[..];
        let before = segments[segments.len() - 1].direction.moved_up();
        let force = segments[0].pull() - before.scale(self.tension_before);
        let [first, others @ ..] = &self.rows.nodes[..] else {
            return found;
        };
        found.move_nodes::<RUBS>(first, force, &mut self.layout, 1, step);
        for ((pair, node), at) in segments.windows(2).zip(others).zip(2..) {
            let force = pair[1].pull() - pair[0].pull();
            found.move_nodes::<RUBS>(node, force, &mut self.layout, at, step);
        }
        let (push, creeps) = (self.push(), self.layout.creep.is_some());
        let line = &mut self.layout;
        line.velocity_before.wrap();
        for (at, segment) in line.rows().zip(segments) {
            let relative = line.velocity_before.load(at + 1) - line.velocity_before.load(at);
            found.check(segment, relative, push, step);
            if !creeps {
                found.book_average(segment, relative, step);
            }
        }
        found
    }
}

impl SegmentRow {
    /// Writes equations in T̄, from the loose velocities of their nodes [m/s] and the forms of the inverse masses of both.
    #[inline(always)]
    fn assemble(
        &mut self,
        kick: Lanes,
        push: Lanes,
        relative: Vectors,
        [[_, to_before, low], [high, to_after, _]]: [[Lanes; 3]; 2],
    ) {
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        let (resistance, known) = self.law(push);
        let k = resistance * kick;
        self.equations = Equations {
            lower: zero - k * to_before,
            diagonal: one + k * (low + high),
            upper: zero - k * to_after,
            right: known + resistance * self.direction.dot(relative),
        };
    }
}

impl Found {
    /// Moves nodes under a force [N] of the segments; whether they are on the bed as they were taken to be.
    #[inline(always)]
    fn move_nodes<const RUBS: bool>(
        &mut self,
        node: &NodeRow,
        force: Vectors,
        line: &mut Layout,
        at: usize,
        step: Step,
    ) {
        let (old, kick) = (line.velocity.load(at), Lanes::splat(step.kick));
        let new = node.loose + node.inverse_mass::<RUBS>(force).scale(kick);
        line.velocity_before.store(new, at);
        if !RUBS && line.contact.is_some() {
            let touches = node.pushed(new.z);
            self.landed = self.landed.max(Lanes::splat(0.0) - touches * node.touches);
        }
        self.book(node, force, line.weight.load(at), [old, new], step);
    }

    /// What is left of the nodes' momentum beside tension and weight is what water, damping and bed took.
    #[inline(always)]
    fn book(
        &mut self,
        node: &NodeRow,
        pull: Vectors,
        weight: Lanes,
        [old, new]: [Vectors; 2],
        step: Step,
    ) {
        let mut impulse = pull;
        impulse.z = impulse.z - weight;
        let change = new - old;
        let excess = (node.mass_tangent - node.mass_normal) * node.tangent.dot(change);
        let momentum = change.scale(node.mass_normal) + node.tangent.scale(excess);
        let taken = (impulse.scale(Lanes::splat(step.kick)) - momentum).dot(old + new);
        // what the tangents gain by turning between the kicks
        let [before, after] = [node.tangent.dot(old), node.tangent.dot(new)];
        let turned = (node.mass_tangent - node.mass_normal) * (before * before - after * after);
        self.lost = self.lost + node.free * (taken - turned) * Lanes::splat(0.5);
    }

    /// What the averaging dissipates: the work of the springs' part of T̄ less that of the mean of the tensions half a step before t_n and half a
    /// step after it, the slopes being those of t_n. The averaging of ρ = 1 makes this mean, and dissipates nothing.
    #[inline(always)]
    fn book_average(&mut self, segment: &SegmentRow, relative: Vectors, step: Step) {
        let along = segment.direction.dot(relative);
        let across = relative.dot(relative) - along * along;
        let after = Lanes::splat(0.5 * step.drift);
        let before = Lanes::splat(step.kick - 0.5 * step.drift);
        // how much longer the segments are then
        let longer = |time: Lanes, along: Lanes, across: Lanes| {
            time * (along + Lanes::splat(0.5) * time * across * segment.inverse)
        };
        let stretched = [
            longer(Lanes::splat(0.0) - before, segment.along, segment.across),
            longer(after, along, across),
        ];
        let [low, high] = stretched
            .map(|stretched| (segment.spring_now + segment.spring_slope * stretched).positive());
        let average = segment.elastic + segment.curvature + segment.stiffness * along;
        let moved = Lanes::splat(0.5 * step.kick) * (segment.along + along);
        let centred = Lanes::splat(0.5) * (low + high);
        self.numerical = self.numerical + (average.positive() - centred) * moved;
    }

    /// Whether segments are as slack, and bent by as much, as they were taken to be; books what their dampers took.
    #[inline(always)]
    fn check(&mut self, segment: &SegmentRow, relative: Vectors, push: Lanes, step: Step) {
        let (zero, drift) = (Lanes::splat(0.0), Lanes::splat(step.drift));
        let along = segment.direction.dot(relative);
        let (spring, total) = segment.spring(along, push);
        let taut = total.choose(Lanes::splat(1.0), Lanes::splat(-1.0));
        self.flipped = self.flipped.max(zero - taut * segment.taut);
        // transverse stretch over Δt²: w²/2L (1 − O(Δt²w²/L²)/4), L the length without it
        let l = segment.length;
        let longer = l + drift * along;
        let across = relative.dot(relative) - along * along; // w²
        let square = drift * drift * across;
        let turned =
            (square - Lanes::splat(FLAT) * longer * longer).max(Lanes::splat(SHORT) * l - longer);
        self.turned = self.turned.max(turned.where_positive(taut));
        let slope = segment.stiffness * drift;
        let twice = segment.curvature * longer;
        let off =
            (slope * across - twice - twice).abs() + Lanes::splat(0.25 * FLAT) * slope * across;
        let bent = off * segment.inverse * Lanes::splat(0.5 / SHORT);
        self.bent = self.bent.max(bent.where_positive(taut));
        self.greatest = self.greatest.max(segment.tension);
        let moved = segment.along + along;
        let lost = (segment.tension - spring.positive()) * moved;
        self.lost = self.lost + lost * Lanes::splat(0.5 * step.kick);
    }
}

impl AxialWork {
    /// Corrects what a pass found not to be as assumed; false if another pass is needed.
    #[inline(always)]
    pub(super) fn holds(&mut self, found: &Found, step: Step) -> bool {
        let tolerance = STRETCH_TOLERANCE * found.greatest();
        let off = found.bent - Lanes::splat(tolerance);
        let stretched = off.max(found.flipped).max(found.turned).any_positive();
        let landed = found.landed.any_positive();
        if landed {
            self.revise_contact();
        }
        let revised = stretched && self.revise_segments(step, tolerance);
        !(landed || revised)
    }

    /// Takes the nodes to meet the bed as the last pass found.
    #[inline(always)]
    fn revise_contact(&mut self) {
        let velocity = &self.layout.velocity_before;
        for (row, node) in self.rows.nodes.iter_mut().enumerate() {
            node.touches = node.pushed(velocity.load(row + 1).z);
            node.settle();
        }
    }

    /// Takes the segments to be slack and bent as the last pass found, true stretch by transverse motion included; whether that asks for another pass.
    #[inline(always)]
    fn revise_segments(&mut self, step: Step, tolerance: f64) -> bool {
        let (zero, drift) = (Lanes::splat(0.0), Lanes::splat(step.drift));
        let (one, tolerance) = (Lanes::splat(1.0), Lanes::splat(tolerance));
        let push = self.push();
        let line = &self.layout;
        let mut revised = false;
        for (row, segment) in self.rows.segments.iter_mut().enumerate() {
            let velocity = &line.velocity_before;
            let relative = velocity.load(row + 2) - velocity.load(row + 1);
            let along = segment.direction.dot(relative);
            let (_, total) = segment.spring(along, push);
            let taut = total.choose(one, zero - one);
            // l1 − l0 less its part along the segment, exact: (2 l0 Δt a + Δt²|Δv|²)/(l0 + l1) − Δt a
            let l = segment.length;
            let square = drift * (l * along + l * along + drift * relative.dot(relative));
            let longer = (l * l + square).positive().sqrt();
            let transverse =
                square * (l + longer + Lanes::splat(f64::MIN_POSITIVE)).recip() - drift * along;
            let curvature = segment.stiffness * transverse * Lanes::splat(1.0 / step.drift);
            let off = (curvature - segment.curvature).abs() - tolerance;
            let again = (zero - taut * segment.taut).max(off.where_positive(taut));
            if again.any_positive() {
                (segment.curvature, segment.taut) = (curvature, taut);
                revised = true;
            }
        }
        revised
    }
}
