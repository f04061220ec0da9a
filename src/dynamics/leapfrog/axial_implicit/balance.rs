//! Energy balance of the axial-implicit leapfrog ([`crate::dynamics::leapfrog::balance`]): T̄ does work on the free nodes, and T̄ − S on the dampers,
//! with S the part of T̄ from the springs.
//!
//! The averaging dissipates the difference between the work of S and that of the discrete gradient of the energy of the springs from t_{n−½} to
//! t_{n+½}. For springs whose tension is proportional to strain, the gradient is ½(T₋ + T₊)(T₊ − T₋)/(U₊ − U₋), with U the tension as if they also
//! pushed: the mean of both tensions except in segments that slacken or snap taut. The averaging with ρ = 1 is this mean and does not dissipate.

use super::AxialLine;
use super::rows::{SegmentRow, Sizes, pulled};
use crate::dynamics::leapfrog::ENDS;
use crate::dynamics::leapfrog::step::Step;
use crate::dynamics::viscoelastic::Relaxed;
use crate::math::lanes::{Lanes, Vectors};

/// Change of strain above which the mean tension is evaluated from the difference of the energies [-].
const STRAIN_RESOLVED: f64 = 1e-9;

impl AxialLine {
    /// Adds a step. `velocity_before` must hold the new velocities; positions and rows must be those at t_n.
    #[inline(always)]
    pub(super) fn balance_step(&mut self, step: Step, sizes: &Sizes) {
        let Some(mut balance) = self.balance.take() else {
            return;
        };
        let half = Lanes::splat(0.5);
        for at in self.layout.rows() {
            balance.work =
                balance.work + half * (self.work_on_nodes(at, sizes) + self.work_on_dampers(at, sizes));
            if self.layout.viscoelastic.is_none() {
                balance.algorithmic = balance.algorithmic + half * self.averaged(at, step, sizes);
            }
            if self.kernel.rows.current.is_some() {
                let dragged = sizes.kick * self.water_power(at);
                balance.water_work = balance.water_work + dragged;
                balance.work = balance.work + dragged;
            }
        }
        for end in self.prescribed_ends() {
            let line = &self.layout;
            let (at, (segment, sign)) = (line.end_slot(end), line.end_segment(end));
            let after = 0.5 * step.drift;
            let way = after * line.velocity_before.get(at) + (step.kick - after) * line.velocity.get(at);
            let pull = sign * (self.kernel.rows.pull(segment) + self.shear(segment));
            balance.external_work += line.end_lack(end) * way.z - pull.dot(&way);
        }
        balance.external_work += step.kick * self.layout.bending_power();
        self.balance = Some(balance);
        if self.layout.surface.is_some() {
            let held = ENDS.map(|end| !self.layout.is_open(end));
            self.layout.balance_lift(step, held);
        }
    }

    /// Sum of old and new velocities of the free nodes of a row, and of the next nodes [m/s].
    #[inline(always)]
    fn both(&self, at: usize) -> [Vectors; 2] {
        let (line, nodes) = (&self.layout, &self.kernel.rows.nodes);
        let sum = |at: usize| line.velocity.load(at) + line.velocity_before.load(at);
        let free_after = match nodes.get(at) {
            Some(next) => next.free,
            None => nodes[0].free.moved_down_before(Lanes::splat(0.0)),
        };
        [sum(at).scale(nodes[at - 1].free), sum(at + 1).scale(free_after)]
    }

    /// Twice the work of tensions and weights on the free nodes of a row [J].
    #[inline(always)]
    fn work_on_nodes(&self, at: usize, sizes: &Sizes) -> Lanes {
        let segment = &self.kernel.rows.segments[at - 1];
        let [own, next] = self.both(at);
        let stretched = segment.tension * segment.direction.dot(next - own);
        let stretched = match &self.layout.joints {
            Some(joints) => stretched + joints.shear.load(at).dot(next - own),
            None => stretched,
        };
        Lanes::splat(0.0) - sizes.kick * (stretched + self.layout.weight.load(at) * own.z)
    }

    /// Twice the work on the dampers of a row of segments [J].
    #[inline(always)]
    fn work_on_dampers(&self, at: usize, sizes: &Sizes) -> Lanes {
        if self.layout.viscoelastic.is_some() {
            return Lanes::splat(0.0); // see `balance_viscoelastic`
        }
        let (segment, [along, moved]) = (&self.kernel.rows.segments[at - 1], self.stretching(at, sizes));
        (segment.tension - segment.spring(along).positive()) * moved
    }

    /// New stretching velocity [m/s], and twice the stretch over the step [m].
    #[inline(always)]
    fn stretching(&self, at: usize, sizes: &Sizes) -> [Lanes; 2] {
        let (velocity, segment) = (&self.layout.velocity_before, &self.kernel.rows.segments[at - 1]);
        let along = segment.direction.dot(velocity.load(at + 1) - velocity.load(at));
        [along, sizes.kick * (segment.along + along)]
    }

    /// Twice the energy dissipated by the averaging on a row of segments [J].
    #[inline(always)]
    fn averaged(&self, at: usize, step: Step, sizes: &Sizes) -> Lanes {
        let (segment, [along, moved]) = (&self.kernel.rows.segments[at - 1], self.stretching(at, sizes));
        let line = &self.layout;
        let relative = [&line.velocity, &line.velocity_before].map(|of| of.load(at + 1) - of.load(at));
        let gradient = match self.is_curved() {
            true => self.curved_gradient(at, relative, step),
            false => segment.linear_gradient(relative, step),
        };
        (segment.spring(along).positive() - gradient) * moved
    }

    /// Discrete gradient of the energy of curved springs [N].
    #[inline(always)]
    fn curved_gradient(&self, at: usize, relative: [Vectors; 2], step: Step) -> Lanes {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(Lanes::splat);
        let (law, segment) = (&self.layout.law, &self.kernel.rows.segments[at - 1]);
        let chord = segment.direction.scale(segment.length);
        let inverse = self.layout.inverse_length.load(at);
        let strain = |moved: Vectors| {
            let chord = chord + moved;
            chord.dot(chord).sqrt() * inverse - one
        };
        let before = strain(relative[0].scale(Lanes::splat(-step.lag())));
        let after = strain(relative[1].scale(Lanes::splat(0.5 * step.drift)));
        let [held, holds] = [before, after].map(|e| e.map(|e| law.at(e.max(0.0)).energy));
        let stretched = after - before;
        let resolved = stretched.abs() - Lanes::splat(STRAIN_RESOLVED);
        let mut secant = (holds - held) * resolved.choose(stretched, one).recip();
        if (zero - resolved).any_positive() {
            let [force, _] = pulled(law, (half * (before + after)).positive());
            secant = resolved.choose(secant, force);
        }
        segment.axial_stiffness * segment.unstretched_length * secant
    }

    /// Power of the drag at the velocity of the water, and of the Froude-Krylov force, on a row of nodes [W].
    #[inline(always)]
    fn water_power(&self, at: usize) -> Lanes {
        let (line, node) = (&self.layout, &self.kernel.rows.nodes[at - 1]);
        let Some(current) = self.kernel.rows.current.as_ref().map(|rows| &rows[at - 1]) else {
            return Lanes::splat(0.0);
        };
        let mean = (line.velocity.load(at) + line.velocity_before.load(at)).scale(Lanes::splat(0.5));
        let (flow, tangent) = (current.flow, node.tangent);
        let past = flow - mean;
        let [across, along] = node.drag;
        let after = flow - line.velocity_before.load(at);
        let drawn = along * after.dot(tangent) - node.drag_rest;
        let power = across * past.dot(flow) + (drawn - across * past.dot(tangent)) * flow.dot(tangent);
        node.free * (power + current.froude_krylov.dot(mean))
    }

    /// Adds the dissipation of the dampers of viscoelastic segments, and that of the averaging: the work of T̄ less that of the viscoelastic
    /// tension over the step. `velocity` must hold the new velocities.
    #[inline(always)]
    pub(super) fn balance_viscoelastic(&mut self, at: usize, relaxed: Relaxed, step: Step) {
        let (velocity, row) = (&self.layout.velocity, &self.kernel.rows.segments[at - 1]);
        let along = row.direction.dot(velocity.load(at + 1) - velocity.load(at));
        let moved = Lanes::splat(0.5 * step.kick) * (row.along + along);
        let averaged = (row.tension - relaxed.tension) * moved;
        if let Some(balance) = &mut self.balance {
            balance.work = balance.work + relaxed.taken;
            balance.algorithmic = balance.algorithmic + averaged;
        }
    }
}

impl SegmentRow {
    /// Discrete gradient of the energy of springs whose tension is proportional to strain [N]; `relative` are the old and new velocities of their upper
    /// nodes relative to the lower ones [m/s].
    #[inline(always)]
    fn linear_gradient(&self, relative: [Vectors; 2], step: Step) -> Lanes {
        let half = Lanes::splat(0.5);
        let [now, ..] = self.history;
        let tension = |relative: Vectors, time: f64| {
            let (time, along) = (Lanes::splat(time), self.direction.dot(relative));
            let across = relative.dot(relative) - along * along;
            now + self.axial_stiffness * time * (along + half * time * across * self.inverse)
        };
        let [before, after] = [
            tension(relative[0], -step.lag()),
            tension(relative[1], 0.5 * step.drift),
        ];
        let kinks = Lanes::splat(0.0) - before * after;
        let mean = half * (before.positive() + after.positive());
        if kinks.any_positive() {
            return kinks.choose(mean * before.positive_secant(after), mean);
        }
        mean
    }
}
