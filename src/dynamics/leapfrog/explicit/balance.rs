//! Energy balance of the explicit leapfrog ([`crate::dynamics::leapfrog::balance`]), from the work of the elastic tension on the free nodes.

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::ExplicitLine;
use crate::dynamics::leapfrog::ENDS;
use crate::dynamics::leapfrog::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::model::End;

/// [`ExplicitLine::balance_nodes`] for the vector unit of the machine.
struct BalanceNodes<'a>(&'a mut ExplicitLine, Step);

impl NullaryFnOnce for BalanceNodes<'_> {
    type Output = [Lanes; 2];

    #[inline(always)]
    fn call(self) -> [Lanes; 2] {
        self.0.work_on_nodes(self.1)
    }
}

impl ExplicitLine {
    /// Adds the work on the nodes from t_{n−½} to t_{n+½}; the positions must be those at t_n, and the
    /// velocities of the ends those of their points at t_{n+½}.
    pub(super) fn balance_nodes(&mut self, step: Step) {
        if self.balance.is_none() {
            return;
        }
        let unit = self.layout.vector_unit;
        let [work, water_work] = unit.dispatch(BalanceNodes(self, step));
        let springs = ENDS.map(|end| {
            let (at, sign) = self.layout.end_segment(end);
            sign * self.spring(at.row).get(at.lane)
        });
        if let Some(balance) = &mut self.balance {
            balance.work = balance.work + work;
            balance.water_work = balance.water_work + water_work;
            balance.springs = springs;
            balance.external_work += step.kick * self.layout.bending_power();
        }
    }

    #[inline(always)]
    fn work_on_nodes(&mut self, step: Step) -> [Lanes; 2] {
        self.layout.velocity.wrap_after();
        self.layout.velocity_before.wrap_after();
        let (line, half) = (&self.layout, Lanes::splat(0.5 * step.kick));
        let both = |at: usize| {
            let sum = line.velocity.load(at) + line.velocity_before.load(at);
            sum.scale(self.kernel.interior.load(at))
        };
        let (mut work, mut water_work) = (Lanes::splat(0.0), Lanes::splat(0.0));
        for at in line.rows() {
            let (own, next) = (both(at), both(at + 1));
            work = work - half * (self.spring(at).dot(next - own) + line.weight.load(at) * own.z);
            if let Some(froude_krylov) = &self.kernel.froude_krylov {
                let froude_krylov = half * froude_krylov.load(at).dot(own);
                (work, water_work) = (work + froude_krylov, water_work + froude_krylov);
            }
            if line.flows() {
                let dragged = (half + half) * self.kernel.interior.load(at) * self.drag_power(at);
                (work, water_work) = (work - dragged, water_work - dragged);
            }
        }
        [work, water_work]
    }

    /// Force of the springs of a row of segments on their lower nodes [N]; for viscoelastic segments, including that of the dampers.
    #[inline(always)]
    fn spring(&self, at: usize) -> Vectors {
        match self.layout.viscoelastic {
            Some(_) => self.kernel.pull.load(at),
            None => self.layout.spring(at),
        }
    }

    /// Power of the drag at the velocity of the water [W].
    #[inline(always)]
    fn drag_power(&self, at: usize) -> Lanes {
        let mut drag = self.kernel.resistance.load(at);
        if let Some(damping) = &self.layout.mass_damping {
            drag = drag - self.layout.velocity_before.load(at).scale(damping.load(at));
        }
        drag.dot(self.layout.water_velocity(at))
    }

    /// Adds the work of the ends over a step, and the work on the dampers of the end segments.
    pub(super) fn balance_ends(&mut self, step: Step) {
        let Some(mut balance) = self.balance.take() else {
            return;
        };
        for end in ENDS {
            let side = end as usize;
            if self.is_released(end) {
                continue;
            }
            let way = self.end_way(end, step, &mut balance.half_places[side]);
            let (segment, sign) = self.layout.end_segment(end);
            let pull = sign * self.kernel.pull.get(segment);
            balance.dissipation += (balance.springs[side] - pull).dot(&way);
            if self.layout.tied[side] {
                balance.external_work += self.layout.end_lack(end) * way.z - pull.dot(&way);
            }
        }
        self.balance = Some(balance);
        if self.layout.surface.is_some() {
            self.layout.balance_lift(
                step,
                [0, 1].map(|side| self.layout.tied[side] && !self.layout.released[side]),
            );
        }
    }

    /// Displacement of an end from t_{n−½}, where it was at `half_place` [m], to t_{n+½} [m]. For a prescribed end, it is the difference of positions:
    /// velocities would give a wrong value where the acceleration jumps. The material at a winch moves with its velocities.
    fn end_way(&self, end: End, step: Step, half_place: &mut Vector3<f64>) -> Vector3<f64> {
        let at = self.layout.end_slot(end);
        let [before, after] = [&self.layout.velocity_before, &self.layout.velocity].map(|of| of.get(at));
        let place = self.layout.position.get(at) - 0.5 * step.drift * after;
        let gone = place - std::mem::replace(half_place, place);
        match self.layout.tied[end as usize] && self.kernel.winch.is_none() {
            true => gone,
            false => 0.5 * step.kick * (before + after),
        }
    }
}
