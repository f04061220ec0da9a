//! Energy balance of the explicit leapfrog, over the steps since the state was loaded. It reads what a step leaves behind and changes no motion.
//!
//! Work on the free nodes in a step, with the velocities v of t_{n−½} and t_{n+½}:
//!
//!   ½ Δt Σ [−T_s q·Δ(v_{n−½} + v_{n+½}) + (p − w ẑ)·(v_{n−½} + v_{n+½})]
//!
//! with the tension T_s of the springs, the Froude-Krylov force p and the weight w. This and the work of the drag on the moving water is dissipated,
//! except for the kinetic energy at the end of the steps ([`crate::dynamics::energy_balance`]).

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::LineWork;
use crate::dynamics::energy_balance::Flow;
use crate::dynamics::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::model::End;

/// Work and dissipation since the state was loaded.
#[derive(Debug, Clone)]
pub(super) struct LineBalance {
    /// Work on the free nodes [J].
    work: Lanes,
    /// Work of moving water [J].
    water_work: Lanes,
    /// Work of prescribed ends, of releases and of the winch [J].
    external_work: f64,
    /// Work on dampers beside the ends, and of viscoelastic dampers; kinetic energy that external work has brought [J].
    dissipation: f64,
    /// Position of the ends at t_n − Δt/2 [m].
    half_places: [Vector3<f64>; 2],
    /// Force of the springs beside the ends on these at t_n [N].
    springs: [Vector3<f64>; 2],
}

impl Default for LineBalance {
    fn default() -> LineBalance {
        LineBalance {
            work: Lanes::splat(0.0),
            water_work: Lanes::splat(0.0),
            external_work: 0.0,
            dissipation: 0.0,
            half_places: [Vector3::zeros(); 2],
            springs: [Vector3::zeros(); 2],
        }
    }
}

impl LineBalance {
    /// Adds dissipation [J].
    pub fn dissipate(&mut self, energy: f64) {
        self.dissipation += energy;
    }

    /// Adds external work [J], of which a part is kinetic energy.
    pub fn supply(&mut self, [energy, kinetic]: [f64; 2]) {
        self.external_work += energy;
        self.dissipation += kinetic;
    }
}

/// [`LineWork::balance_nodes`] for the vector unit of the machine.
struct BalanceNodes<'a>(&'a mut LineWork, Step);

impl NullaryFnOnce for BalanceNodes<'_> {
    type Output = [Lanes; 2];

    #[inline(always)]
    fn call(self) -> [Lanes; 2] {
        self.0.work_on_nodes(self.1)
    }
}

impl LineWork {
    /// Flow of energy since the state was loaded, the kinetic energy included in the dissipation; zero without a balance.
    pub fn flow(&self) -> Flow {
        let Some(balance) = &self.balance else {
            return Flow::default();
        };
        let lifted = self.layout.surface.as_ref().map_or(0.0, |surface| surface.lifted);
        Flow {
            external_work: balance.external_work + balance.water_work.sum() + lifted,
            dissipation: balance.work.sum() + balance.dissipation,
            algorithmic_dissipation: 0.0,
        }
    }

    /// Starts at no flow, with the ends where they were `lag` [s] ago.
    pub(super) fn start_balance(&mut self, lag: f64) {
        self.clear_balance();
        self.set_out(lag);
    }

    /// Starts at no flow.
    pub(super) fn clear_balance(&mut self) {
        if let Some(balance) = &mut self.balance {
            let half_places = balance.half_places;
            *balance = LineBalance {
                half_places,
                ..LineBalance::default()
            };
        }
        if let Some(surface) = &mut self.layout.surface {
            surface.lifted = 0.0;
        }
    }

    /// Records the position of the ends `lag` [s] ago.
    pub(super) fn set_out(&mut self, lag: f64) {
        if let Some(balance) = &mut self.balance {
            let ends = [End::A, End::B].map(|end| self.layout.end_slot(end));
            balance.half_places = ends.map(|at| self.layout.place_before(at, lag));
        }
    }

    /// Adds the work on the nodes between t_{n−½} and t_{n+½}, the positions being those of t_n.
    pub(super) fn balance_nodes(&mut self, step: Step) {
        if self.balance.is_none() {
            return;
        }
        let unit = self.layout.vector_unit;
        let [work, water_work] = unit.dispatch(BalanceNodes(self, step));
        let springs = [End::A, End::B].map(|end| {
            let (at, sign) = self.layout.end_segment(end);
            sign * self.spring(at.row).get(at.lane)
        });
        if let Some(balance) = &mut self.balance {
            balance.work = balance.work + work;
            balance.water_work = balance.water_work + water_work;
            balance.springs = springs;
        }
    }

    #[inline(always)]
    fn work_on_nodes(&mut self, step: Step) -> [Lanes; 2] {
        self.layout.velocity.wrap_after();
        self.layout.velocity_before.wrap_after();
        let (line, half) = (&self.layout, Lanes::splat(0.5 * step.kick));
        let both = |at: usize| {
            let sum = line.velocity.load(at) + line.velocity_before.load(at);
            sum.scale(self.interior.load(at))
        };
        let (mut work, mut water_work) = (Lanes::splat(0.0), Lanes::splat(0.0));
        for at in line.rows() {
            let (own, next) = (both(at), both(at + 1));
            work = work - half * (self.spring(at).dot(next - own) + line.weight.load(at) * own.z);
            if let Some(froude_krylov) = &self.froude_krylov {
                let froude_krylov = half * froude_krylov.load(at).dot(own);
                (work, water_work) = (work + froude_krylov, water_work + froude_krylov);
            }
            if line.flows() {
                let dragged = (half + half) * self.interior.load(at) * self.drag_power(at);
                (work, water_work) = (work - dragged, water_work - dragged);
            }
        }
        [work, water_work]
    }

    /// Force of the springs of a row of segments on their lower nodes [N]; of viscoelastic segments that of the dampers included.
    #[inline(always)]
    fn spring(&self, at: usize) -> Vectors {
        match self.layout.viscoelastic {
            Some(_) => self.pull.load(at),
            None => self.layout.spring(at),
        }
    }

    /// Power of the resistance of the water on its own velocity [W].
    #[inline(always)]
    fn drag_power(&self, at: usize) -> Lanes {
        let mut drag = self.resistance.load(at);
        if let Some(damping) = &self.layout.mass_damping {
            drag = drag - self.layout.velocity_before.load(at).scale(damping.load(at));
        }
        drag.dot(self.layout.water_velocity(at))
    }

    /// Adds the work of the ends over a step, and that on the dampers beside them.
    pub(super) fn balance_ends(&mut self, step: Step) {
        let Some(mut balance) = self.balance.take() else {
            return;
        };
        for end in [End::A, End::B] {
            let side = end as usize;
            if self.is_released(end) {
                continue;
            }
            let way = self.end_way(end, step, &mut balance.half_places[side]);
            let (segment, sign) = self.layout.end_segment(end);
            let pull = sign * self.pull.get(segment);
            balance.dissipation += (balance.springs[side] - pull).dot(&way);
            if self.tied[side] {
                balance.external_work += self.layout.end_lack(end) * way.z - pull.dot(&way);
            }
        }
        self.balance = Some(balance);
        if self.layout.surface.is_some() {
            self.layout
                .balance_lift(step, [End::A, End::B].map(|end| self.is_prescribed(end)));
        }
    }

    /// Displacement of an end from half a step before t_n, where it was at `half_place` [m], to half a step after it [m]. That of a prescribed end is
    /// the difference of its positions: where its acceleration jumps, no velocity gives it. The material at a winch moves with its velocities.
    fn end_way(&self, end: End, step: Step, half_place: &mut Vector3<f64>) -> Vector3<f64> {
        let at = self.layout.end_slot(end);
        let [before, after] = [&self.layout.velocity_before, &self.layout.velocity].map(|of| of.get(at));
        let place = self.layout.position.get(at) - 0.5 * step.drift * after;
        let gone = place - std::mem::replace(half_place, place);
        match self.tied[end as usize] && self.winch.is_none() {
            true => gone,
            false => 0.5 * step.kick * (before + after),
        }
    }

    /// Adds the energy that the half node at a prescribed end brings when it is released at t_n.
    pub(super) fn balance_release(&mut self, end: End, step: Step) {
        let at = self.layout.end_slot(end);
        let excess = self.water.as_ref().map_or(0.0, |w| w.inverse_mass_excess[at]);
        let across = self.inverse_mass[at];
        let masses = [1.0 / across, 1.0 / (across + excess)];
        let energy = self.layout.joining_energy(end, masses, step);
        if let Some(balance) = &mut self.balance {
            balance.supply(energy);
        }
    }
}
