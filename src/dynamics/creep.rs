//! Viscoelastic segments one by one: tension, energy and loss from a line's state.

use nalgebra::Vector3;

use crate::math::fold::{Column, Fold, Slot};
use crate::math::lanes::Lanes;
use crate::model::{Line, LineState};
use crate::physics::stretch::total_tension;
use crate::physics::viscoelastic::Viscoelastic;

/// A viscoelastic segment in motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Creeping {
    law: Viscoelastic,
    /// Strain of the slow part [-].
    slow: f64,
}

/// Strain of a segment and how it changes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretching {
    /// l/L − 1 [-].
    pub strain: f64,
    /// [1/s]
    pub rate: f64,
}

impl Stretching {
    /// From positions [m] and velocities [m/s] of the ends of segment `i`.
    pub fn of(
        line: &Line,
        i: usize,
        [low, high]: [Vector3<f64>; 2],
        [low_velocity, high_velocity]: [Vector3<f64>; 2],
    ) -> Stretching {
        let (chord, unstretched) = (high - low, line.segments.length[i]);
        let direction = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        Stretching {
            strain: chord.norm() / unstretched - 1.0,
            rate: direction.dot(&(high_velocity - low_velocity)) / unstretched,
        }
    }
}

impl Creeping {
    /// Segment `i` of a line; `None` where the line is not viscoelastic, or at rest.
    pub fn of(line: &Line, state: &LineState, i: usize) -> Option<Creeping> {
        let law = line.segments.viscoelastic.as_ref()?[i];
        let slow = *state.creep.get(i)?;
        Some(Creeping { law, slow })
    }

    /// Elastic and damping force [N].
    pub fn forces(&self, now: Stretching) -> (f64, f64) {
        let elastic = self.law.elastic(now.strain, self.slow);
        (elastic, self.law.damping * now.rate)
    }

    /// Tension [N] of a segment that pushes with `push` [N] at most.
    pub fn tension(&self, now: Stretching, push: f64, negative_tension: bool) -> f64 {
        let (elastic, damping) = self.forces(now);
        total_tension(elastic, damping, 0.0 - push, negative_tension)
    }

    /// Energy per unstretched length [N] at a strain [-] that was passed `lag` [s] ago.
    pub fn energy(&self, strain: f64, now: Stretching, lag: f64) -> f64 {
        let rate = self.law.creep_rate(now.strain, now.rate, self.slow);
        self.law.energy(strain, self.slow - lag * rate)
    }
}

/// Laws and memory of a line's segments, laid out for the leapfrog kernels; padding has none.
#[derive(Debug, Clone)]
pub(super) struct CreepArrays {
    /// Number of segments.
    count: usize,
    /// K [N] and C [N s].
    pub stiffness: Column,
    pub damping: Column,
    /// G [N].
    memory: Column,
    /// EA₁ and EA_d [N].
    slow_stiffness: Column,
    fast_stiffness: Column,
    /// BA_d [N s].
    fast_damping: Column,
    /// 1/B [1/(N s)].
    yielding: Column,
    /// EA₁/BA_s [1/s].
    contraction: Column,
    /// Strain at t_n [-].
    pub strain: Column,
    /// Slow strain at t_n [-].
    slow: Column,
}

impl CreepArrays {
    /// For a line; `None` where it is not viscoelastic.
    pub fn new(line: &Line, fold: Fold) -> Option<CreepArrays> {
        let laws = line.segments.viscoelastic.as_deref()?;
        Some(CreepArrays::of(laws, fold))
    }

    fn of(laws: &[Viscoelastic], fold: Fold) -> CreepArrays {
        let each = |value: fn(&Viscoelastic) -> f64| {
            let values: Vec<f64> = laws.iter().map(value).collect();
            fold.column(&values, 0.0)
        };
        CreepArrays {
            count: laws.len(),
            stiffness: each(|law| law.stiffness),
            damping: each(|law| law.damping),
            memory: each(|law| law.memory),
            slow_stiffness: each(|law| law.slow),
            fast_stiffness: each(|law| law.fast),
            fast_damping: each(|law| law.fast_damping),
            yielding: each(|law| law.yielding),
            contraction: each(|law| law.contraction),
            strain: each(|_| 0.0),
            slow: each(|_| 0.0),
        }
    }

    /// Takes over the slow strains of a line.
    pub fn load(&mut self, slow: &[f64]) {
        self.slow.fill(0.0);
        self.slow.assign(slow);
    }

    /// Hands them back.
    pub fn store(&self, slow: &mut Vec<f64>) {
        slow.clear();
        slow.extend(self.slow.values(self.count));
    }

    /// [`Viscoelastic::elastic`] at t_n.
    #[inline(always)]
    pub fn elastic(&self, at: usize, strain: Lanes) -> Lanes {
        let load = |values: &Column| values.load(at);
        load(&self.stiffness) * strain + load(&self.memory) * load(&self.slow)
    }

    /// The same of one segment.
    pub fn elastic_of(&self, at: Slot, strain: f64) -> f64 {
        self.stiffness[at] * strain + self.memory[at] * self.slow[at]
    }

    /// [`Viscoelastic::loss`] at t_n.
    #[inline(always)]
    pub fn loss(&self, at: usize, strain: Lanes, rate: Lanes, tension: Lanes) -> Lanes {
        let load = |values: &Column| values.load(at);
        let (slow, slow_stiffness) = (load(&self.slow), load(&self.slow_stiffness));
        let fast_stiffness = load(&self.fast_stiffness);
        let total = self.elastic(at, strain) + load(&self.damping) * rate;
        let pull = fast_stiffness * (strain - slow) - slow_stiffness * slow;
        let yielding = load(&self.yielding) * (pull + load(&self.fast_damping) * rate);
        let slack = Lanes::splat(0.0) - load(&self.contraction) * slow;
        let creep = total.choose(yielding, slack);
        let fast = fast_stiffness * (strain - slow).positive();
        tension * rate - slow_stiffness * slow * creep - fast * (rate - creep)
    }

    /// Elastic force [N] after a step of `dt` [s] at the strain of t_n, and its slope with the strain then [N].
    #[inline(always)]
    pub fn ahead(&self, at: usize, strain: Lanes, dt: f64) -> (Lanes, Lanes) {
        let load = |values: &Column| values.load(at);
        let (slow, memory) = (load(&self.slow), load(&self.memory));
        let share = self.share(at, dt);
        let both = load(&self.fast_stiffness) + load(&self.slow_stiffness);
        let pull = load(&self.fast_stiffness) * strain - both * slow;
        let crept = slow + share * Lanes::splat(dt) * pull;
        let half = Lanes::splat(0.5 * dt);
        let slope = share * (half * load(&self.fast_stiffness) + load(&self.fast_damping));
        let stiffness = load(&self.stiffness);
        (
            stiffness * strain + memory * crept,
            stiffness + memory * slope,
        )
    }

    /// 1/(B + ½Δt (EA_d + EA₁)) [1/(N s)].
    #[inline(always)]
    fn share(&self, at: usize, dt: f64) -> Lanes {
        let load = |values: &Column| values.load(at);
        let yielding = load(&self.yielding);
        let both = load(&self.fast_stiffness) + load(&self.slow_stiffness);
        yielding * (Lanes::splat(1.0) + Lanes::splat(0.5 * dt) * both * yielding).recip()
    }

    /// [`Viscoelastic::creep`] from t_n to the strain after a step of `dt` [s].
    #[inline(always)]
    pub fn advance(&mut self, at: usize, now: Lanes, dt: f64) {
        let load = |values: &Column| values.load(at);
        let (slow, before) = (load(&self.slow), load(&self.strain));
        let (half, step, one) = (Lanes::splat(0.5), Lanes::splat(dt), Lanes::splat(1.0));
        let (mean, change) = (half * (before + now), now - before);
        let both = load(&self.fast_stiffness) + load(&self.slow_stiffness);
        let pull = load(&self.fast_stiffness) * mean - both * slow;
        let moved = step * pull + load(&self.fast_damping) * change;
        let crept = slow + self.share(at, dt) * moved;
        let elastic = load(&self.stiffness) * mean + load(&self.memory) * half * (slow + crept);
        let impulse = step * elastic + load(&self.damping) * change;
        let part = half * step * load(&self.contraction);
        let slack = (slow * (one - part) * (one + part).recip()).positive();
        self.slow.store(impulse.choose(crept, slack), at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernels_take_the_same_step_as_the_law() {
        let laws = [
            Viscoelastic::new([1.4e8, 1.6e8], [4.0e9, 1.1e7]),
            Viscoelastic::plain(1.0e8, 1.0e5),
            Viscoelastic::new([1.0e8, 3.0e8], [1.0e8, 0.0]),
        ];
        for (before, now, rate) in [(0.01, 0.012, 0.1), (-0.01, -0.02, -0.5), (0.003, 0.01, 0.0)] {
            let fold = Fold::new(laws.len() + 1); // one row
            let mut arrays = CreepArrays::of(&laws, fold);
            arrays.strain.fill(before);
            let slow = [0.002, 0.0, 0.001];
            arrays.load(&slow);
            let (now_lanes, rate_lanes) = (Lanes::splat(now), Lanes::splat(rate));
            let tension = Lanes::splat(1.0e5);
            let loss = arrays.loss(1, now_lanes, rate_lanes, tension);
            arrays.advance(1, now_lanes, 0.02);
            for (i, law) in laws.iter().enumerate() {
                let creep = law.step([before, now], slow[i], 0.02);
                approx::assert_relative_eq!(
                    arrays.slow[fold.slot(i)],
                    creep.slow,
                    max_relative = 1e-13
                );
                let exact = law.loss(now, rate, slow[i], 1.0e5);
                approx::assert_relative_eq!(loss[i], exact, max_relative = 1e-12);
            }
        }
    }
}
