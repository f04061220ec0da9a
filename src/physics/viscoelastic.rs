//! Viscoelastic stretch of fibre ropes: a slow spring and damper in series with a fast spring and damper.
//!
//! The slow part takes the strain ε₁ and the fast one the rest, under one tension T:
//!
//!   T = EA₁ ε₁ + BA_s ε̇₁ = EA_d (ε − ε₁) + BA_d (ε̇ − ε̇₁),   1/EA_s = 1/EA₁ + 1/EA_d,
//!
//! so that the stiffness is EA_s in slow motion and EA_d in fast motion. With B = BA_s + BA_d the tension is linear in ε, ε̇ and the memory ε₁,
//!
//!   T = K ε + C ε̇ + G ε₁,  K = BA_s EA_d/B,  C = BA_s BA_d/B,  G = (BA_d EA₁ − BA_s EA_d)/B,
//!   B ε̇₁ = EA_d (ε − ε₁) − EA₁ ε₁ + BA_d ε̇.
//!
//! The trapezoidal rule closes a step Δt of the implicit integrators: ε₁' = ε₁ + [Δt (EA_d ε̄ − (EA_d + EA₁) ε₁) + BA_d Δε]/(B + ½Δt (EA_d + EA₁)),
//! ε̄ the mean strain. It accounts for the dissipation of the dampers exactly, but rings if Δt is many times the relaxation time τ = B/(EA_d + EA₁).
//! The leapfrogs, whose forces do not depend on the end of the step, use the exact solution for a constant strain rate. With z = Δt/τ, r = EA_d/(EA_d
//! + EA₁) and p = r + (BA_d/B − r)(1 − e⁻ᶻ)/z it is
//!
//!   ε₁' = e⁻ᶻ ε₁ + (r (1 − e⁻ᶻ) − p) ε + p ε'.
//!
//! A rope cannot push: where T would be negative it is zero, and the slow part contracts freely, BA_s ε̇₁ = −EA₁ ε₁. For BA_d = 0 this is the
//! standard linear solid: storage EA_d − (EA_d − EA_s)/(1 + ω²τ²) and loss (EA_d − EA_s) ωτ/(1 + ω²τ²) at the circular frequency ω.
//!
//! A segment of a line with bending stiffness carries a compression of up to P: T ≥ −P. The law of a rope holds for T + P if ε₁ and e = ε − ε₁ are
//! measured from their values at rest under −P.
//!
//! The slow spring stores ½EA₁ ε₁², the fast one ½EA_d e² with e = ε − ε₁ while it is stretched; the rest of the work is dissipated. The tension of the
//! fast part over a step is
//!
//!   T = max(½EA_d (e + e') + BA_d (e' − e)/Δt, T₀).
//!
//! T₀ is zero, but ½EA_d e'²/(e' − e) where the spring snaps from e < 0 to e' > 0, so that it stores no more than the work of T.
//!
//! Source: the law of MoorDyn's `EA_s|EA_d`, `BA_s|BA_d` line types, `source/Line.cpp` of MoorDyn-C, after Hall, Duong & Lozon (2023), IOWTC2023, on
//! semi-taut moorings with polyester ropes; closed forms derived here. Valid for small strain and EA_d > EA_s > 0, BA_s > 0.

use super::stretch_step::Mean;

/// Viscoelastic law of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscoelastic {
    /// Stiffness K of the strain at a given memory [N].
    pub stiffness: f64,
    /// Damping C of the strain rate at a given memory [N s].
    pub damping: f64,
    /// Stiffness G of the memory [N].
    pub memory: f64,
    /// Slow spring EA₁ [N].
    pub slow: f64,
    /// Fast spring EA_d [N].
    pub fast: f64,
    /// Fast damper BA_d [N s].
    pub fast_damping: f64,
    /// 1/B [1/(N s)]; 0 for a segment without memory.
    pub yielding: f64,
    /// Rate EA₁/BA_s at which the slow part contracts in a slack rope [1/s].
    pub contraction: f64,
    /// Greatest compression P that it carries [N].
    pub push: f64,
}

/// Result of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViscoelasticStep {
    /// Slow strain ε₁' at its end [-].
    pub slow: f64,
    /// Slope of ε₁' with respect to the strain at the end of the step [-].
    pub slow_slope: f64,
    /// Tension over the step, and the dissipation of the dampers.
    pub mean: Mean,
}

/// Evolution of the memory over a step at a constant strain rate: ε₁' = `kept` ε₁ + `first` ε + `last` ε', or `slack` ε₁ in a slack rope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    /// e⁻ᶻ [-].
    pub kept: f64,
    /// Factor of the initial strain, r (1 − e⁻ᶻ) − p [-].
    pub first: f64,
    /// Factor of the final strain, p [-].
    pub last: f64,
    /// Factor of the memory in a slack rope [-].
    pub slack: f64,
}

/// Tension of the fast part over a step.
struct Pull {
    /// Tension [N].
    tension: f64,
    /// Slope of the tension with respect to the final strain [N].
    slope: f64,
}

/// Slow and fast parts over a step.
struct Series {
    /// Strains of the slow and of the fast part before the step [-].
    before: [f64; 2],
    /// BA_s/Δt [N].
    slow_damper: f64,
    /// The slow part pulls with `offset` + `pull` ε₁' over the step [N].
    offset: f64,
    pull: f64,
}

impl Series {
    fn of(law: &Viscoelastic, strain: f64, slow: f64, dt: f64) -> Series {
        let slow_damper = law.slow_damping() / dt;
        Series {
            before: [slow, strain - slow],
            slow_damper,
            offset: (0.5 * law.slow - slow_damper) * slow,
            pull: 0.5 * law.slow + slow_damper,
        }
    }

    /// Step at whose end the fast part has the strain `after` [-] and the tension `fast`.
    fn step(&self, law: &Viscoelastic, after: f64, fast: Pull) -> ViscoelasticStep {
        let slow = (fast.tension - self.offset) / self.pull;
        let slow_slope = fast.slope / (self.pull + fast.slope);
        let relaxed = slow - self.before[0];
        let taken_by_fast = law.taken_by_fast([self.before[1], after], fast.tension);
        ViscoelasticStep {
            slow,
            slow_slope,
            mean: Mean {
                tension: fast.tension,
                slope: self.pull * slow_slope,
                taken: self.slow_damper * relaxed * relaxed + taken_by_fast,
            },
        }
    }
}

/// Positive root of a x² − b x + c for a > 0, or 0 if there is none; c is not positive except for rounding.
fn positive_root([a, b, c]: [f64; 3]) -> f64 {
    let c = c.min(0.0);
    let greater = 0.5 * (b.abs() + (b * b - 4.0 * a * c).sqrt());
    match b < 0.0 {
        true => -c / greater,
        false => greater / a,
    }
}

impl Viscoelastic {
    /// Law from static and dynamic stiffness [N] and the damping of each [N s].
    pub fn new([static_ea, dynamic_ea]: [f64; 2], [slow_damping, fast_damping]: [f64; 2]) -> Self {
        let slow = dynamic_ea * static_ea / (dynamic_ea - static_ea);
        let yielding = 1.0 / (slow_damping + fast_damping);
        Viscoelastic {
            stiffness: slow_damping * dynamic_ea * yielding,
            damping: slow_damping * fast_damping * yielding,
            memory: (fast_damping * slow - slow_damping * dynamic_ea) * yielding,
            slow,
            fast: dynamic_ea,
            fast_damping,
            yielding,
            contraction: slow / slow_damping,
            push: 0.0,
        }
    }

    /// Law of a segment without memory, of stiffness EA [N] and damping BA [N s].
    pub fn plain(stiffness: f64, damping: f64) -> Self {
        Viscoelastic {
            stiffness,
            damping,
            memory: 0.0,
            slow: 0.0,
            fast: stiffness,
            fast_damping: damping,
            yielding: 0.0,
            contraction: 0.0,
            push: 0.0,
        }
    }

    /// Compressive strains of the segment and of its slow part at rest under −P [-].
    fn pushed(&self) -> [f64; 2] {
        let slow = match self.yielding {
            0.0 => 0.0,
            _ => self.push / self.slow,
        };
        [slow + self.push / self.fast, slow]
    }

    /// Applies a step of the law of a rope to T + P, in strains measured from those at rest under −P.
    fn above_push(
        &self,
        [before, after]: [f64; 2],
        slow: f64,
        step: impl Fn([f64; 2], f64) -> ViscoelasticStep,
    ) -> ViscoelasticStep {
        let [whole, part] = self.pushed();
        let mut done = step([before + whole, after + whole], slow + part);
        done.slow -= part;
        done.mean.tension -= self.push;
        done
    }

    /// Slow damper BA_s [N s]; 0 for a segment without memory.
    pub fn slow_damping(&self) -> f64 {
        match self.contraction {
            0.0 => 0.0,
            contraction => self.slow / contraction,
        }
    }

    /// Slow strain [-] of a segment at rest at a strain [-].
    pub fn rest(&self, strain: f64) -> f64 {
        if self.yielding == 0.0 {
            return 0.0;
        }
        let [whole, part] = self.pushed();
        (strain + whole).max(0.0) * self.fast / (self.fast + self.slow) - part
    }

    /// Tension without the damper C, before it is clipped at zero [N].
    #[inline(always)]
    pub fn elastic(&self, strain: f64, slow: f64) -> f64 {
        self.stiffness * strain + self.memory * slow
    }

    /// Evolution of the memory in `dt` [s].
    pub fn relaxation(&self, dt: f64) -> Relaxation {
        let both = self.fast + self.slow;
        let z = dt * both * self.yielding;
        if z == 0.0 {
            return Relaxation {
                kept: 1.0,
                first: 0.0,
                last: 0.0,
                slack: 1.0,
            };
        }
        let (share, gone) = (self.fast / both, -(-z).exp_m1());
        let last = share + (self.fast_damping * self.yielding - share) * gone / z;
        Relaxation {
            kept: (-z).exp(),
            first: share * gone - last,
            last,
            slack: (-dt * self.contraction).exp(),
        }
    }

    /// Step of `dt` [s] between two strains [-].
    pub fn step(&self, strains: [f64; 2], slow: f64, dt: f64) -> ViscoelasticStep {
        self.above_push(strains, slow, |strains, slow| {
            self.pulling_step(strains, slow, dt)
        })
    }

    /// Step of a rope that cannot push.
    fn pulling_step(&self, strains: [f64; 2], slow: f64, dt: f64) -> ViscoelasticStep {
        let series = Series::of(self, strains[0], slow, dt);
        let [_, before] = series.before;
        let damper = self.fast_damping / dt;
        let half = 0.5 * dt * self.contraction;
        let contracted = (slow * (1.0 - half) / (1.0 + half)).max(0.0);
        // the slow part carries no tension while it contracts freely, unless it would contract beyond zero strain
        let resists = match contracted > 0.0 {
            true => 0.0,
            false => series.offset.max(0.0),
        };
        if self.pull([before, strains[1] - contracted], damper).tension <= resists {
            return self.slack(strains, [slow, contracted]);
        }
        if self.yielding == 0.0 {
            return self.without_memory(strains, self.pull(strains, damper));
        }
        let reach = series.offset + series.pull * strains[1]; // R
        let mut after = self.linear_end(&series, reach, damper);
        if before < 0.0 {
            // ½EA_d e'² = (R − P e') (e' − e)
            let squared = 0.5 * self.fast + series.pull;
            let snapped = positive_root([squared, reach + series.pull * before, before * reach]);
            after = after.min(snapped);
        }
        series.step(self, after, self.pull([before, after], damper))
    }

    /// Step as if the fast part could push without limit, which equals [`Viscoelastic::step`] where it does not reach its limit.
    pub fn held(&self, strains: [f64; 2], slow: f64, dt: f64) -> ViscoelasticStep {
        self.above_push(strains, slow, |strains, slow| self.linear_step(strains, slow, dt))
    }

    fn linear_step(&self, strains: [f64; 2], slow: f64, dt: f64) -> ViscoelasticStep {
        let damper = self.fast_damping / dt;
        if self.yielding == 0.0 {
            return self.without_memory(strains, self.linear_pull(strains, damper));
        }
        let series = Series::of(self, strains[0], slow, dt);
        let after = self.linear_end(&series, series.offset + series.pull * strains[1], damper);
        series.step(self, after, self.linear_pull([series.before[1], after], damper))
    }

    /// Strain [-] of the fast part at the end of a step in which it could push, from ½EA_d (e + e') + D (e' − e) = R − P e'.
    fn linear_end(&self, series: &Series, reach: f64, damper: f64) -> f64 {
        let (half, [_, before]) = (0.5 * self.fast, series.before);
        (reach - (half - damper) * before) / (series.pull + half + damper)
    }

    /// Tension of the fast part between two of its strains [-], with its damper BA_d/Δt [N], as if it could push.
    fn linear_pull(&self, [before, after]: [f64; 2], damper: f64) -> Pull {
        let half = 0.5 * self.fast;
        Pull {
            tension: half * (before + after) + damper * (after - before),
            slope: half + damper,
        }
    }

    /// Tension of the fast part between two of its strains [-], with its damper BA_d/Δt [N].
    fn pull(&self, strains: [f64; 2], damper: f64) -> Pull {
        let [before, after] = strains;
        let linear = self.linear_pull(strains, damper);
        let mut least = Pull {
            tension: 0.0,
            slope: 0.0,
        };
        if before < 0.0 && after > 0.0 {
            let moved = after - before;
            least.tension = 0.5 * self.fast * after * after / moved;
            least.slope = (self.fast * after - least.tension) / moved;
        }
        if linear.tension > least.tension {
            linear
        } else {
            least
        }
    }

    /// Dissipation per unstretched length [N] of the fast part under a tension [N] between two of its strains [-].
    fn taken_by_fast(&self, strains: [f64; 2], tension: f64) -> f64 {
        let [before, after] = strains.map(|strain| strain.max(0.0));
        let stored = 0.5 * self.fast * (after + before) * (after - before);
        tension * (strains[1] - strains[0]) - stored
    }

    /// Step without memory under a tension.
    fn without_memory(&self, strains: [f64; 2], pull: Pull) -> ViscoelasticStep {
        ViscoelasticStep {
            slow: 0.0,
            slow_slope: 0.0,
            mean: Mean {
                tension: pull.tension,
                slope: pull.slope,
                taken: self.taken_by_fast(strains, pull.tension),
            },
        }
    }

    /// Step without tension, between two strains of the rope and of its slow part [-].
    fn slack(&self, [before, after]: [f64; 2], slow: [f64; 2]) -> ViscoelasticStep {
        ViscoelasticStep {
            slow: slow[1],
            slow_slope: 0.0,
            mean: Mean {
                tension: 0.0,
                slope: 0.0,
                taken: self.pulling_energy(before, slow[0]) - self.pulling_energy(after, slow[1]),
            },
        }
    }

    /// Stored energy per unstretched length [N].
    #[inline(always)]
    pub fn energy(&self, strain: f64, slow: f64) -> f64 {
        let [whole, part] = self.pushed();
        self.pulling_energy(strain + whole, slow + part) - self.push * (strain + 0.5 * whole)
    }

    /// Stored energy per unstretched length of a rope that cannot push [N].
    fn pulling_energy(&self, strain: f64, slow: f64) -> f64 {
        let fast = (strain - slow).max(0.0);
        0.5 * (self.slow * slow * slow + self.fast * fast * fast)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Polyester rope of a published semi-taut mooring.
    fn rope(fast_damping: f64) -> Viscoelastic {
        Viscoelastic::new([1.424e8, 1.586e8], [4.0e9, fast_damping])
    }

    /// Complex modulus (storage, loss) [N] at the circular frequency ω [rad/s]: both parts in series.
    fn modulus([slow, fast]: [[f64; 2]; 2], omega: f64) -> [f64; 2] {
        let compliance = |[ea, ba]: [f64; 2]| {
            let imaginary = omega * ba;
            let square = ea * ea + imaginary * imaginary;
            [ea / square, -imaginary / square]
        };
        let ([a, b], [c, d]) = (compliance(slow), compliance(fast));
        let (real, imaginary) = (a + c, b + d);
        let square = real * real + imaginary * imaginary;
        [real / square, -imaginary / square]
    }

    /// Storage and loss modulus [N] of a rope in a steady sine of `steps` steps per period.
    fn measured(law: &Viscoelastic, omega: f64, steps: usize) -> [f64; 2] {
        let period = 2.0 * std::f64::consts::PI / omega;
        let dt = period / steps as f64;
        let (mean, amplitude) = (0.02, 0.005);
        let strain = |k: usize| mean + amplitude * (omega * k as f64 * dt).sin();
        let mut slow = law.rest(mean);
        let [mut storage, mut loss] = [0.0; 2];
        let settled = (40.0 / (omega * 2.0)).ceil() as usize + 3;
        for k in 0..(settled + 1) * steps {
            let relaxed = law.step([strain(k), strain(k + 1)], slow, dt).slow;
            let rate = (strain(k + 1) - strain(k)) / dt;
            let tension =
                law.elastic(0.5 * (strain(k) + strain(k + 1)), 0.5 * (slow + relaxed)) + law.damping * rate;
            if k >= settled * steps {
                let phase = omega * (k as f64 + 0.5) * dt;
                storage += 2.0 / steps as f64 / amplitude * tension * phase.sin();
                loss += 2.0 / steps as f64 / amplitude * tension * phase.cos();
            }
            slow = relaxed;
        }
        [storage, loss]
    }

    #[test]
    fn storage_and_loss_are_those_of_two_parts_in_series_to_second_order() {
        for fast_damping in [0.0, 1.1e7, 4.0e8] {
            let law = rope(fast_damping);
            let parts = [[law.slow, 4.0e9], [law.fast, fast_damping]];
            for omega in [0.03, 0.2, 0.5, 1.5] {
                let exact = modulus(parts, omega);
                let [coarse, fine] = [60, 240].map(|steps| measured(&law, omega, steps));
                for part in 0..2 {
                    let scale = exact[part];
                    let (first, last) = (coarse[part] - exact[part], fine[part] - exact[part]);
                    assert!(last.abs() < 1e-3 * scale, "{part} {omega}: {fine:?} {exact:?}");
                    let order = (first / last).abs().ln() / 4.0_f64.ln();
                    assert!((order - 2.0).abs() < 0.1 || last.abs() < 1e-7 * scale, "{order}");
                }
            }
        }
    }

    #[test]
    fn at_rest_the_tension_is_that_of_the_static_stiffness() {
        let law = rope(1.1e7);
        assert_relative_eq!(
            law.elastic(0.02, law.rest(0.02)),
            0.02 * 1.424e8,
            max_relative = 1e-12
        );
        let rest = law.rest(0.02);
        assert_relative_eq!(law.step([0.02; 2], rest, 1.0).slow, rest, max_relative = 1e-12);
    }

    #[test]
    fn a_held_stretch_relaxes_exponentially_from_the_dynamic_to_the_static_stiffness() {
        let law = rope(0.0);
        let (strain, dt) = (0.01, 0.01);
        let tau = 4.0e9 / (law.fast + law.slow);
        let mut slow = 0.0;
        assert_relative_eq!(law.elastic(strain, slow), 0.01 * 1.586e8, max_relative = 1e-12);
        for k in 1..=2000 {
            slow = law.step([strain, strain], slow, dt).slow;
            let fading = (-(k as f64) * dt / tau).exp();
            let exact = strain * (1.424e8 + (1.586e8 - 1.424e8) * fading);
            assert_relative_eq!(law.elastic(strain, slow), exact, max_relative = 1e-6);
        }
    }

    /// Ropes with all, one and none of the dampers, and segments that carry compression; steps that stay taut, slacken, snap and stay slack, with the
    /// memory of a slack rope.
    fn all_steps() -> impl Iterator<Item = (Viscoelastic, [f64; 2], f64, f64)> {
        let laws = [0.0, 1.1e7, 4.0e8].map(rope).into_iter();
        let laws = laws.chain([Viscoelastic::plain(1.0e8, 1.0e5)]);
        let laws = laws.flat_map(|law| [0.0, 2.0e5].map(|push| Viscoelastic { push, ..law }));
        let strains = [-0.05, -1e-3, -1e-7, 0.0, 1e-7, 1e-3, 2e-3, 0.05];
        laws.flat_map(move |law| {
            strains.into_iter().flat_map(move |before| {
                let steps = [1e-5, 0.01, 5.0].into_iter();
                let slows: &[f64] = if law.yielding > 0.0 { &[0.0, 1e-3] } else { &[0.0] };
                steps.flat_map(move |dt| {
                    slows
                        .iter()
                        .flat_map(move |&slow| strains.map(move |after| (law, [before, after], slow, dt)))
                })
            })
        })
    }

    #[test]
    fn what_a_step_gives_is_held_or_taken_and_nothing_is_made() {
        for (law, strains, slow, dt) in all_steps() {
            let step = law.step(strains, slow, dt);
            let [before, after] = [(strains[0], slow), (strains[1], step.slow)];
            let held = law.energy(after.0, after.1) - law.energy(before.0, before.1);
            let given = step.mean.tension * (strains[1] - strains[0]);
            let scale = law.energy(after.0, after.1) + law.energy(before.0, before.1) + given.abs();
            let (case, pushed) = ((law, strains, slow, dt, step), law.push * law.push / law.fast);
            let rounding = 1e-9 * scale + 1e-12 * pushed;
            assert!((given - held - step.mean.taken).abs() <= rounding, "{case:?}");
            assert!(step.mean.tension >= -law.push, "{case:?}");
            assert!(step.mean.taken >= -rounding, "{case:?}");
        }
    }

    #[test]
    fn the_tension_of_a_short_step_is_that_of_both_parts_with_their_dampers_where_it_is_positive() {
        let dt = 1e-6;
        for law in [rope(1.1e7), rope(4.0e8), Viscoelastic::plain(1.0e8, 1.0e7)] {
            for (strain, slow) in [(0.01, 0.002), (0.01, 0.0), (1e-3, 2e-3), (-0.01, 0.0)] {
                let slow = if law.yielding > 0.0 { slow } else { 0.0 };
                for rate in [-10.0, -0.5, -0.05, 0.0, 0.05, 0.5, 10.0] {
                    let exact = (law.elastic(strain, slow) + law.damping * rate).max(0.0);
                    let step = law.step([strain, strain + rate * dt], slow, dt);
                    assert_relative_eq!(step.mean.tension, exact, max_relative = 1e-3, epsilon = 1.0);
                }
            }
        }
    }

    #[test]
    fn slopes_of_a_step_are_those_of_what_it_comes_to() {
        for (law, [before, after], slow, dt) in all_steps() {
            let h = 1e-7 * f64::abs(after).max(1e-4);
            let at = |part: f64| law.step([before, after + part * h], slow, dt);
            let [low, middle, high] = [-1.0, 0.0, 1.0].map(at);
            let sides = [low, high].map(|side| (side.mean.slope, side.slow_slope));
            let rate = |difference: f64| difference / (2.0 * h);
            for (slope, measured, least, most) in [
                (
                    middle.mean.slope,
                    rate(high.mean.tension - low.mean.tension),
                    sides[0].0.min(sides[1].0),
                    sides[0].0.max(sides[1].0),
                ),
                (
                    middle.slow_slope,
                    rate(high.slow - low.slow),
                    sides[0].1.min(sides[1].1),
                    sides[0].1.max(sides[1].1),
                ),
            ] {
                let scale = 1e-3 * most.abs().max(slope.abs()) + 1e-6;
                assert!(
                    measured > least - scale && measured < most + scale,
                    "{before} {after} {slow} {dt}: {slope} {measured} {low:?} {high:?}"
                );
            }
        }
    }

    #[test]
    fn the_memory_of_a_constant_strain_rate_is_what_many_short_steps_come_to() {
        let (before, after, slow) = (0.01, 0.013, 0.002);
        for (fast_damping, dt) in [(0.0, 5.0), (1.1e7, 5.0), (4.0e8, 60.0), (1.1e7, 1e4)] {
            let law = rope(fast_damping);
            let of_parts = |parts: usize| {
                let strain = |k: usize| before + (after - before) * k as f64 / parts as f64;
                (0..parts).fold(slow, |slow, k| {
                    law.step([strain(k), strain(k + 1)], slow, dt / parts as f64).slow
                })
            };
            let relaxed = law.relaxation(dt);
            let exact = relaxed.kept * slow + relaxed.first * before + relaxed.last * after;
            assert_relative_eq!(exact, of_parts(20_000), max_relative = 1e-6);
            assert!((of_parts(200) - exact).abs() < 1e-2 * exact);
        }
    }

    #[test]
    fn a_memory_far_faster_than_a_step_follows_and_does_not_ring() {
        let law = Viscoelastic::new([1.4e8, 2.0e8], [1.0e3, 0.0]);
        let relaxed = law.relaxation(0.05);
        assert!(relaxed.kept < 1e-100);
        let rest = law.rest(0.01);
        assert_relative_eq!((relaxed.first + relaxed.last) * 0.01, rest, max_relative = 1e-12);
    }

    #[test]
    fn a_slack_rope_contracts_by_itself() {
        let law = rope(1.1e7);
        let mut slow = 0.001;
        for _ in 0..100 {
            slow = law.step([-0.01, -0.01], slow, 0.01).slow;
        }
        let exact = 0.001 * (-law.slow / 4.0e9_f64).exp();
        assert_relative_eq!(slow, exact, max_relative = 1e-5);
    }

    #[test]
    fn a_segment_without_memory_is_a_spring_and_a_damper() {
        let law = Viscoelastic::plain(1.0e8, 1.0e5);
        assert_eq!(law.step([0.01, 0.02], 0.0, 0.1).slow, 0.0);
        assert_eq!(law.elastic(0.01, law.rest(0.01)), 1.0e6);
    }
}
