//! Pass of the axial-implicit leapfrog: the system in T̄, the resulting velocities, and the check of the assumptions.
//!
//! Loops address the rows by index: with iterators the compiler would combine four rows and process them lane by lane.

use super::AxialLine;
use super::rows::{NodeRow, SegmentRow, Sizes, under};
use crate::math::lanes::{Lanes, Vectors};
use crate::math::striped_tridiagonal::Eliminated;
use crate::physics::stretch::StretchLaw;

/// Change of tension due to the true stretch that requires another pass, relative to the largest tension [-].
const STRETCH_TOLERANCE: f64 = 1e-3;
/// Squared ratio of transverse to axial length up to which the stretch due to transverse motion is approximated by its first term [-].
const FLAT: f64 = 1e-3;
/// Minimum ratio of the new length of a segment to its old length for this approximation [-].
const SHORT: f64 = 0.9;

/// Differences between the result of a pass and its assumptions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    /// Positive where the contact of nodes, or in `flipped` the slackness of segments, differs from that assumed.
    landed: Lanes,
    flipped: Lanes,
    /// 2·[`SHORT`] times the largest change of T̄ due to the true stretch [N], for segments with small rotations; `turned` is positive where one rotates more.
    bent: Lanes,
    turned: Lanes,
    /// Smallest margin of segments [N]: negative where T̄ includes the wrong earlier tensions.
    margin: Lanes,
    /// Largest T̄ [N].
    pub greatest: Lanes,
}

impl Found {
    fn new() -> Found {
        let zero = Lanes::splat(0.0);
        Found {
            landed: zero,
            flipped: zero,
            bent: zero,
            turned: zero,
            margin: Lanes::splat(f64::INFINITY),
            greatest: zero,
        }
    }
}

impl AxialLine {
    /// Computes the coefficients that couple the segments through their nodes.
    #[inline(always)]
    pub(super) fn weigh_nodes<const SEABED: u8>(&mut self) {
        let segments = &self.kernel.rows.segments[..self.kernel.rows.nodes.len()];
        let direction = |at: usize| segments[at].direction;
        let mut q = direction(segments.len() - 1).moved_up_after(Vectors::zero());
        for (at, node) in self.kernel.rows.nodes.iter_mut().enumerate() {
            if at > 0 {
                q = direction(at - 1);
            }
            node.weigh::<SEABED>(q, direction(at));
        }
    }

    #[inline(always)]
    pub(super) fn assemble(&mut self, sizes: &Sizes) {
        let nodes = &self.kernel.rows.nodes;
        let last = nodes.len() - 1;
        for (at, segment) in self.kernel.rows.segments.iter_mut().enumerate() {
            let (low, high) = (&nodes[at], &nodes[(at + 1).min(last)]);
            let relative = high.loose - low.loose;
            segment.assemble(relative, [low.forms, high.forms], sizes);
        }
        let (low, high) = (&nodes[last], &nodes[0]);
        // after the last row there is no node, or a prescribed end
        let zero = Lanes::splat(0.0);
        let behind = self.layout.velocity_before.load(nodes.len() + 1);
        let relative = high.loose.moved_down_before(behind) - low.loose;
        let forms = [low.forms, high.forms.map(|form| form.moved_down_before(zero))];
        self.kernel.rows.segments[last].assemble(relative, forms, sizes);
    }

    /// Solves for T̄, down the rows and up again. Returns T̄ of the segments before the first row [N].
    #[inline(always)]
    pub(super) fn solve_tensions(&mut self) -> Lanes {
        let segments = &mut self.kernel.rows.segments[..];
        let last = segments.len() - 1;
        let mut start = Eliminated::start();
        for at in 0..last {
            if at > 0 {
                start = segments[at - 1].eliminated;
            }
            segments[at].eliminated = start.eliminate(&segments[at].equations);
        }
        if last > 0 {
            start = segments[last - 1].eliminated;
        }
        let (before, mut tension) = start.close(&segments[last].equations);
        segments[last].tension = tension;
        for segment in segments[..last].iter_mut().rev() {
            tension = segment.eliminated.substitute(before, tension);
            segment.tension = tension;
        }
        before
    }

    /// Computes the new velocities from T̄, and stores them in `velocity_before`; `before` is T̄ of the segments before the first row [N].
    #[inline(always)]
    pub(super) fn find_velocities<const SEABED: u8>(&mut self, before: Lanes, sizes: &Sizes) {
        let (rows, kick) = (self.kernel.rows.nodes.len(), sizes.kick);
        let (segments, new) = (
            &self.kernel.rows.segments[..rows],
            self.layout.velocity_before.rows_mut(rows),
        );
        let pull = |at: usize| segments[at].direction.scale(kick * segments[at].tension);
        let last = segments[segments.len() - 1].direction;
        let mut below = last.moved_up_after(Vectors::zero()).scale(kick * before);
        for (at, node) in self.kernel.rows.nodes.iter_mut().enumerate() {
            if at > 0 {
                below = pull(at - 1);
            }
            let impulse = pull(at) - below;
            if SEABED == under::ROUGH {
                node.impulse = impulse;
            }
            new[at + 1] = node.loose + node.inverse_mass::<SEABED>(impulse);
        }
        self.layout.velocity_before.wrap();
    }

    #[inline(always)]
    pub(super) fn look_over<const SEABED: u8>(&mut self, sizes: &Sizes) -> Found {
        let mut found = Found::new();
        let (line, last) = (&self.layout, self.layout.striping.rows());
        let (segments, nodes) = (
            &self.kernel.rows.segments[..last],
            &self.kernel.rows.nodes[..last],
        );
        let new = line.velocity_before.rows(last);
        // an inclusive range would cost more in every row; accumulated results prevent the compiler from combining four rows
        for at in 1..last + 1 {
            found.check(&segments[at - 1], new[at + 1] - new[at], sizes);
        }
        if SEABED == under::LEVEL {
            for at in line.rows() {
                found.look_at(&nodes[at - 1], new[at]);
            }
        }
        found
    }
}

impl Found {
    #[inline(always)]
    fn look_at(&mut self, node: &NodeRow, velocity: Vectors) {
        let touches = node.pushed(velocity.z);
        self.landed = self.landed.max(Lanes::splat(0.0) - touches * node.touches);
    }

    /// Compares slackness and stretch due to transverse motion of a row of segments with those assumed.
    #[inline(always)]
    fn check(&mut self, segment: &SegmentRow, relative: Vectors, sizes: &Sizes) {
        let (zero, drift) = (Lanes::splat(0.0), sizes.drift);
        let along = segment.direction.dot(relative);
        let across = relative.dot(relative) - along * along; // w²
        let spring = segment.spring(along);
        let pull = segment.pull(segment.rate(along, sizes), sizes);
        let total = spring + pull;
        self.margin = self.margin.min(segment.margin(pull));
        self.flipped = self.flipped.max(zero - total * segment.taut);
        // transverse stretch over Δt²: w²/2L (1 − O(Δt²w²/L²)/4), L the length without it
        let l = segment.length;
        let longer = l + drift * along;
        let square = drift * drift * across;
        let turned = (square - Lanes::splat(FLAT) * longer * longer).max(Lanes::splat(SHORT) * l - longer);
        self.turned = self.turned.max(turned.where_positive(total));
        let push = segment.stiffness * drift * across;
        let twice = segment.curvature * longer;
        let off = (push - twice - twice).abs() + Lanes::splat(0.25 * FLAT) * push;
        self.bent = self.bent.max((off * segment.inverse).where_positive(total));
        self.greatest = self.greatest.max(segment.tension);
    }
}

impl AxialLine {
    /// Corrects the contact of the nodes where a pass contradicts the assumption; returns false if another pass is required.
    #[inline(always)]
    pub(super) fn contact_holds<const SEABED: u8>(&mut self, found: &Found, sizes: &Sizes) -> bool {
        if SEABED == under::ROUGH {
            return self.seabed_holds(found.greatest, sizes);
        }
        let landed = SEABED == under::LEVEL && found.landed.any_positive();
        if landed {
            self.revise_contact();
        }
        !landed
    }

    /// Corrects the assumptions on the segments that a pass contradicts; returns false if another pass is required.
    #[inline(always)]
    pub(super) fn segments_hold(&mut self, found: &Found, sizes: &Sizes) -> bool {
        let tolerance = Lanes::splat(STRETCH_TOLERANCE) * found.greatest.greatest();
        let off = found.bent - Lanes::splat(2.0 * SHORT) * tolerance;
        let stretched = off.max(found.flipped).max(found.turned).any_positive();
        let recalls = (Lanes::splat(0.0) - found.margin).any_positive();
        if recalls && !self.kernel.forgets {
            for segment in &mut self.kernel.rows.segments {
                segment.memory = segment.all_remembered(sizes);
            }
            self.kernel.forgets = true;
        }
        let revised = (stretched || recalls) && self.revise_segments(sizes, tolerance);
        let curved = self.is_curved() && self.follow_curve(sizes, tolerance);
        !(revised || curved)
    }

    /// Returns whether the springs are nonlinear in the strain and not viscoelastic.
    #[inline(always)]
    pub(super) fn is_curved(&self) -> bool {
        self.layout.law != StretchLaw::Engineering && self.layout.viscoelastic.is_none()
    }

    /// Linearises the tension of the springs at the strains found by the last pass; returns whether another pass is required.
    #[inline(always)]
    fn follow_curve(&mut self, sizes: &Sizes, tolerance: Lanes) -> bool {
        let (velocity, law) = (&self.layout.velocity_before, &self.layout.law);
        let share = Lanes::splat(self.kernel.weights.0[0]);
        let mut again = Lanes::splat(0.0);
        for (row, segment) in self.kernel.rows.segments.iter_mut().enumerate() {
            let relative = velocity.load(row + 2) - velocity.load(row + 1);
            let along = segment.direction.dot(relative);
            let inverse = self.layout.inverse_length.load(row + 1);
            let spring = segment.spring(along);
            let mut laid = *segment;
            let curve = laid.follow(law, along, inverse, [share, sizes.drift]);
            let off = (curve.positive() - spring.positive()).abs() - tolerance;
            let off = off.where_positive(segment.taut);
            if off.any_positive() {
                segment.adopt_spring(&laid, off); // unchanged otherwise, so that the energy balance uses the law of the step
            }
            again = again.max(off);
        }
        again.any_positive()
    }

    /// Sets the contact of the nodes to that found by the last pass.
    #[inline(always)]
    fn revise_contact(&mut self) {
        let velocity = &self.layout.velocity_before;
        for (row, node) in self.kernel.rows.nodes.iter_mut().enumerate() {
            node.touches = node.pushed(velocity.load(row + 1).z);
            node.settle();
        }
    }

    /// Sets slackness and true stretch due to transverse motion of the segments to those found by the last pass, and includes the earlier tensions according
    /// to the pull of the dampers; returns whether another pass is required.
    #[inline(always)]
    fn revise_segments(&mut self, sizes: &Sizes, tolerance: Lanes) -> bool {
        let (zero, one, drift) = (Lanes::splat(0.0), Lanes::splat(1.0), sizes.drift);
        let per_drift = drift.recip();
        let velocity = &self.layout.velocity_before;
        let mut revised = false;
        for (row, segment) in self.kernel.rows.segments.iter_mut().enumerate() {
            let relative = velocity.load(row + 2) - velocity.load(row + 1);
            let along = segment.direction.dot(relative);
            let [total, more] = segment.total(along, sizes);
            let taut = total.choose(one, zero - one);
            // l1 − l0 less its part along the segment, exact: (2 l0 Δt a + Δt²|Δv|²)/(l0 + l1) − Δt a
            let l = segment.length;
            let square = drift * (l * along + l * along + drift * relative.dot(relative));
            let longer = (l * l + square).positive().sqrt();
            let transverse = square * (l + longer + Lanes::splat(f64::MIN_POSITIVE)).recip() - drift * along;
            let curvature = segment.stiffness * transverse * per_drift;
            let off = (curvature - segment.curvature).abs().max(more.abs()) - tolerance;
            let again = (zero - taut * segment.taut).max(off.where_positive(taut));
            if again.any_positive() {
                if self.kernel.forgets {
                    segment.remember(segment.rate(along, sizes), sizes);
                }
                // by lane: which segments share a row must not matter
                segment.curvature = again.choose(curvature, segment.curvature);
                segment.taut = again.choose(taut, segment.taut);
                revised = true;
            }
        }
        revised
    }
}
