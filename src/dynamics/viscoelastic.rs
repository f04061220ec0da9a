//! Viscoelastic segments: tension and energy of single segments from a line's state, and internal variables of rows over the steps of the leapfrogs.

use nalgebra::Vector3;

use super::leapfrog::step::Step;
use crate::math::lanes::Lanes;
use crate::math::striping::{Column, Slot, Striping};
use crate::model::{Line, LineState};
use crate::physics::stretch::total_tension;
use crate::physics::viscoelastic::Viscoelastic;

#[derive(Debug, Clone, Copy)]
pub(super) struct ViscoelasticSegment {
    law: Viscoelastic,
    /// Strain of the slow part [-].
    slow: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Stretching {
    /// l/L − 1 [-].
    pub strain: f64,
    /// [1/s]
    pub rate: f64,
}

impl Stretching {
    /// Strain and strain rate of segment `i` from its chord [m] and the rate of its chord [m/s].
    pub(super) fn of(line: &Line, i: usize, chord: Vector3<f64>, rate: Vector3<f64>) -> Stretching {
        let unstretched = line.segments.length[i];
        let direction = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        Stretching {
            strain: chord.norm() / unstretched - 1.0,
            rate: direction.dot(&rate) / unstretched,
        }
    }
}

impl ViscoelasticSegment {
    /// Segment `i` of a line; `None` if the line is not viscoelastic, or its state has no slow strains.
    pub(super) fn of(line: &Line, state: &LineState, i: usize) -> Option<ViscoelasticSegment> {
        let law = line.segments.viscoelastic.as_ref()?[i];
        let slow = *state.viscoelastic.get(i)?;
        Some(ViscoelasticSegment { law, slow })
    }

    /// The same at the time of the velocities: half a step earlier with a leapfrog.
    pub(super) fn at_velocities(line: &Line, state: &LineState, i: usize) -> Option<ViscoelasticSegment> {
        let now = ViscoelasticSegment::of(line, state, i)?;
        let before = state.half_step.viscoelastic.get(i);
        let slow = before.copied().unwrap_or(now.slow);
        Some(ViscoelasticSegment { slow, ..now })
    }

    /// Energy per unstretched length [N] at a strain [-].
    pub(super) fn energy(&self, strain: f64) -> f64 {
        self.law.energy(strain, self.slow)
    }

    /// Elastic and damping force [N].
    pub(super) fn forces(&self, now: Stretching) -> (f64, f64) {
        let elastic = self.law.elastic(now.strain, self.slow);
        (elastic, self.law.damping * now.rate)
    }

    /// Tension [N] of a segment that carries at most `push` [N] in compression.
    pub(super) fn tension(&self, now: Stretching, push: f64, negative_tension: bool) -> f64 {
        let (elastic, damping) = self.forces(now);
        total_tension(elastic, damping, 0.0 - push, negative_tension)
    }
}

/// Laws and internal variables of a line's segments, in the striped layout of the leapfrog kernels; zero in the padding.
#[derive(Debug, Clone)]
pub struct ViscoelasticArrays {
    laws: Vec<Viscoelastic>,
    /// K [N] and C [N s].
    pub stiffness: Column,
    pub damping: Column,
    /// G [N].
    memory: Column,
    /// EA_d [N].
    fast_stiffness: Column,
    /// BA_s and BA_d [N s].
    slow_damping: Column,
    fast_damping: Column,
    /// Evolution of the slow strain over a step, and the length of that step [s].
    relaxation: Relaxing,
    step: f64,
    /// Strain at t_n [-].
    pub strain: Column,
    /// Slow strain at t_n [-].
    slow: Column,
    /// Strain and slow strain at t_{n−½} [-].
    half: [Column; 2],
}

/// [`Relaxation`] of the segments.
#[derive(Debug, Clone)]
struct Relaxing {
    kept: Column,
    first: Column,
    last: Column,
    slack: Column,
}

/// Tension and dissipation of viscoelastic segments from t_{n−½} to t_{n+½}.
#[derive(Debug, Clone, Copy)]
pub struct Relaxed {
    /// Tension [N].
    pub tension: Lanes,
    /// Dissipation of the dampers per unstretched length [N].
    pub taken: Lanes,
}

impl ViscoelasticArrays {
    /// Allocates the arrays of a line; `None` if it is not viscoelastic.
    pub fn new(line: &Line, striping: Striping) -> Option<ViscoelasticArrays> {
        let laws = line.segments.viscoelastic.as_deref()?;
        Some(ViscoelasticArrays::of(laws, striping))
    }

    fn of(laws: &[Viscoelastic], striping: Striping) -> ViscoelasticArrays {
        let each = |value: fn(&Viscoelastic) -> f64| {
            let values: Vec<f64> = laws.iter().map(value).collect();
            striping.column(&values, 0.0)
        };
        let zero = || striping.column(&[], 0.0);
        ViscoelasticArrays {
            laws: laws.to_vec(),
            stiffness: each(|law| law.stiffness),
            damping: each(|law| law.damping),
            memory: each(|law| law.memory),
            fast_stiffness: each(|law| law.fast),
            slow_damping: each(|law| law.slow_damping()),
            fast_damping: each(|law| law.fast_damping),
            relaxation: Relaxing {
                kept: zero(),
                first: zero(),
                last: zero(),
                slack: zero(),
            },
            step: 0.0,
            strain: zero(),
            slow: zero(),
            half: [zero(), zero()],
        }
    }

    /// Prepares the evolution of the slow strain for steps of `dt` [s].
    #[inline]
    pub fn prepare(&mut self, dt: f64) {
        if dt != self.step {
            self.relax(dt);
        }
    }

    fn relax(&mut self, dt: f64) {
        self.step = dt;
        let of = &mut self.relaxation;
        for (at, law) in self.strain.striping().slots().zip(&self.laws) {
            let relaxation = law.relaxation(dt);
            of.kept[at] = relaxation.kept;
            of.first[at] = relaxation.first;
            of.last[at] = relaxation.last;
            of.slack[at] = relaxation.slack;
        }
    }

    /// Loads the slow strains of a line at t_n and at t_{n−½} [-], and its strains at t_{n−½} [-].
    pub fn load(&mut self, [slow, half]: [&[f64]; 2], strains: impl Iterator<Item = f64>) {
        for (column, values) in [(&mut self.slow, slow), (&mut self.half[1], half)] {
            column.fill(0.0);
            column.assign(values);
        }
        self.half[0].fill(0.0);
        for (at, strain) in self.half[0].striping().slots().zip(strains) {
            self.half[0][at] = strain;
        }
    }

    /// Sets the strain of a segment at t_{n−½} [-].
    pub fn set_out(&mut self, at: Slot, strain: f64) {
        self.half[0][at] = strain;
    }

    /// Copies the slow strains at t_n and t_{n−½} to the state.
    pub fn store(&self, slow: &mut Vec<f64>, half: &mut Vec<f64>) {
        for (values, column) in [(slow, &self.slow), (half, &self.half[1])] {
            values.clear();
            values.extend(column.values(self.laws.len()));
        }
    }

    /// [`Viscoelastic::elastic`] at t_n.
    #[inline(always)]
    pub fn elastic(&self, at: usize, strain: Lanes) -> Lanes {
        let load = |values: &Column| values.load(at);
        load(&self.stiffness) * strain + load(&self.memory) * load(&self.slow)
    }

    /// The same for one segment.
    pub fn elastic_of(&self, at: Slot, strain: f64) -> f64 {
        self.stiffness[at] * strain + self.memory[at] * self.slow[at]
    }

    /// Elastic force [N] after the step if the strain remains that of t_n, and its slope with the strain after the step [N].
    #[inline(always)]
    pub fn ahead(&self, at: usize, strain: Lanes) -> (Lanes, Lanes) {
        let load = |values: &Column| values.load(at);
        let (of, memory) = (&self.relaxation, load(&self.memory));
        let last = load(&of.last);
        let relaxed = load(&of.kept) * load(&self.slow) + (load(&of.first) + last) * strain;
        let stiffness = load(&self.stiffness);
        (stiffness * strain + memory * relaxed, stiffness + memory * last)
    }

    /// Advances the slow strain from t_n to t_{n+1} by [`Viscoelastic::relaxation`]; `strains` are those at t_{n+½} and t_{n+1}.
    /// Returns tension and dissipation from t_{n−½} to t_{n+½}.
    #[inline(always)]
    pub fn advance(&mut self, at: usize, strains: [Lanes; 2], step: Step) -> Relaxed {
        let load = |values: &Column| values.load(at);
        let (of, half) = (&self.relaxation, Lanes::splat(0.5));
        let (slow, before, now) = (load(&self.slow), load(&self.strain), strains[1]);
        let relaxed = load(&of.kept) * slow + load(&of.first) * before + load(&of.last) * now;
        let twice = load(&self.stiffness) * (before + now) + load(&self.memory) * (slow + relaxed);
        let impulse = half * Lanes::splat(step.drift) * twice + load(&self.damping) * (now - before);
        let slack = (load(&of.slack) * slow).positive();
        let after = impulse.choose(relaxed, slack);
        self.slow.store(after, at);
        self.pass_half(at, [strains[0], half * (slow + after)], step.kick)
    }

    /// Advances from t_{n−½} by `kick` [s] to the strain and slow strain `after` at t_{n+½}. The tension is that of [`Viscoelastic::step`].
    #[inline(always)]
    fn pass_half(&mut self, at: usize, after: [Lanes; 2], kick: f64) -> Relaxed {
        let load = |values: &Column| values.load(at);
        let (half, rate) = (Lanes::splat(0.5), Lanes::splat(1.0 / kick));
        let before = self.half.each_ref().map(load);
        let relaxed = after[1] - before[1];
        let fast = [before, after].map(|[strain, slow]| strain - slow);
        let [pulled, pulls] = fast.map(Lanes::positive);
        let (change, pull) = (fast[1] - fast[0], pulls - pulled);
        let mean = half * load(&self.fast_stiffness) * (pulled + pulls);
        let linear = half * load(&self.fast_stiffness) * (fast[0] + fast[1]);
        let snapping = mean * fast[0].positive_secant(fast[1]);
        let least = fast[0].choose(Lanes::splat(0.0), snapping);
        let tension = (linear + load(&self.fast_damping) * change * rate).max(least);
        let of_slow = load(&self.slow_damping) * relaxed * relaxed * rate;
        for (column, value) in self.half.iter_mut().zip(after) {
            column.store(value, at);
        }
        Relaxed {
            tension,
            taken: of_slow + tension * change - mean * pull,
        }
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
        let step = Step::after([0.02; 2], 0.02);
        for (before, now) in [(0.01, 0.012), (-0.01, -0.02), (0.003, 0.01)] {
            let striping = Striping::new(laws.len() + 1); // one row
            let mut arrays = ViscoelasticArrays::of(&laws, striping);
            arrays.strain.fill(before);
            let slow = [0.002, 0.0, 0.001];
            arrays.load([&slow; 2], [before; 3].into_iter());
            let halfway = 0.5 * (before + now);
            arrays.prepare(step.drift);
            arrays.advance(1, [halfway, now].map(Lanes::splat), step);
            for (i, law) in laws.iter().enumerate() {
                let of = law.relaxation(0.02);
                let relaxed = of.kept * slow[i] + of.first * before + of.last * now;
                let exact = if now > 0.0 { relaxed } else { of.slack * slow[i] };
                approx::assert_relative_eq!(arrays.slow[striping.slot(i)], exact, max_relative = 1e-13);
            }
        }
    }

    #[test]
    fn what_halves_of_steps_pull_by_is_held_or_taken_however_fast_the_rope_relaxes() {
        for damping in [[4.0e9, 1.1e7], [1.0e6, 0.0], [1.0e2, 1.0e3]] {
            let law = [Viscoelastic::new([1.4e8, 2.0e8], damping)];
            let mut arrays = ViscoelasticArrays::of(&law, Striping::new(2));
            let strain = |k: f64| 0.01 + 1e-4 * k;
            let rest = [law[0].rest(strain(0.0))];
            arrays.load([&rest; 2], [strain(0.0)].into_iter());
            let (mut steps, mut held) = ([0.0; 2], law[0].energy(strain(0.0), rest[0]));
            for k in 0..20 {
                let step = Step::after(steps, 0.02);
                arrays.strain.fill(strain(k as f64));
                let before = arrays.half.each_ref().map(|of| of.load(1)[0]);
                let ahead = [0.5, 1.0].map(|part| Lanes::splat(strain(k as f64 + part)));
                arrays.prepare(step.drift);
                let relaxed = arrays.advance(1, ahead, step);
                let after = arrays.half.each_ref().map(|of| of.load(1)[0]);
                let given = relaxed.tension[0] * (after[0] - before[0]);
                let now = law[0].energy(after[0], after[1]);
                if k > 1 {
                    let off = given - relaxed.taken[0] - (now - held);
                    assert!(off.abs() < 1e-6 * given, "{damping:?}, {k}: {off} of {given}");
                    assert!(relaxed.taken[0] > 0.0);
                }
                (steps, held) = ([0.02, steps[0]], now);
            }
        }
    }
}
