//! Leapfrog with the axial tension implicit: the axial wave no longer limits the step.
//!
//! With geometry q = d/l lagged at t_n and G(x)_i = (x_{i+1} − x_i)/L_i, the tension that drives v_{n−½} -> v_{n+½} is
//!
//! T̄ = σ[T^{n+1} + (2ρ+b)T^n + (ρ²+2ρb)T^{n−1} + ρ²b T^{n−2}]/N + (1−σ)T^n,  b = (1−ρ)/(2ρ),  N = (1+ρ)²(1+b),
//!
//! second order. In z, which takes a step to the next, the first part is (z + ρ)²(z + b)/(N z²) T^n: averaged throughout, σ = 1, the motion
//! is multiplied by −ρ and −b at infinite frequency, and the spectral radius is ρ as long as b ≤ ρ, that is from ρ = ½, which damps most, to
//! ρ = 1 (¼, ½, ¼). Below ½ it rises again, and below ⅓ it is more than 1. Averaging makes waves late by (3σ−1)(ωΔt)²/24, and up to ωΔt = 2 they are stable
//! without. So σ is max(⅓, 1 − 3.2/(ωΔt)²) with the line's greatest axial frequency ω, which is stable for all ρ from ½ to 1; it is 1 where springs may stiffen
//! or viscoelastic, or an end is released. The new strain is linear in the new velocity, ε^{n+1} = ε^n + κ + Δt q·G(v), κ = Δt²(|G(v⁻)|² − (q·G(v⁻))²)/(2|G(r)|), so that
//!
//! S^{n+1} = EA(ε^n + κ + Δt q·G(v)),  C = ½BA[(1+θ) q·G(v) + (1−θ) q·G(v⁻)],  T̄ = b₁(S^{n+1} + C) + Σ h_i (S^i + C)⁺,
//!
//! S being the springs' tension as if they pushed too, C the dampers' over the step, b₁ = σ/N the weight of T^{n+1} and h_i those of the tensions before. Dampers
//! draw segments before they are taut, and what is averaged is max(0, S + C): a spring that pushes is remembered where the damper pulls more. (Averaging
//! max(0, S) and adding C goes to b₁S + C there, however short the steps are.) θ = 0.2 min(1, r/4), where r = Δt max 2 (BA/L)(1/M_i + 1/M_{i+1}) says how
//! hard the dampers are over a step: of second order, and no ringing of those that are. A row is off where the total would be negative. Eliminating v by
//! the nodes' momentum leaves one scalar tridiagonal system in T̄.
//!
//! Springs whose tension is not proportional to strain are laid along the tangent of their curve where the segments are about to come to, and after each pass
//! where they came to, until the tension there is that of the curve: along the tangent at t_n a rope that stiffens would be held, as it snaps taut, by the
//! slope of its first pull.
//!
//! Drag across the line, C v, is folded into the node's mass by θΔt C, θ = max(½, 1 − M/(Δt C)): trapezoidal, but where it outweighs inertia no
//! more than that no velocity changes its sign by it, which would go on for ever. Drag along the line, K|u|u, is what T̄ has to balance, and averaged as T̄ is:
//! the mean of those at t_{n−½} and t_{n+½}, the latter by a tangent at the extrapolated u. Taken at t_n alone, its harmonics of short periods appear
//! 1/(1 − σ sin²(ωΔt/2)) times as great in T^n. The seabed is folded in too (`bed`); flags of slack, memory and contact are checked after
//! the solve and the step repeated until they hold.
//!
//! A held end moves by the secant of its path, which so is its v_{n+½}. Only where it sets out, at rest or after a jump, v_{n−½} is
//! V − ½Δt A of its path.
//!
//! A step ([`AxialWork::step`]) goes over the rows of the folded line ([`crate::math::striping`]) once for each thing it finds out: geometry,
//! segments, drag, inverse masses, contact (`prepare`), couplings; then, until the assumptions hold, the equations, T̄ by
//! [`crate::math::striped_tridiagonal`], velocities and what they say about the assumptions (`solve`). Each sweep has little to do in a
//! row, and keeps in memory what the next one goes on with: the processor, which waits for roots, quotients and sums, then works on several rows at
//! once, and the compiler finds whole vectors, which it loses where much waits for much, or is carried from row to row.
//!
//! All of it is of second order in the step. What is left of the error of tension are axial waves that a line sends out when it snaps taut: in steps
//! much longer than theirs they run late by (ωΔt)²/12, as with every scheme of second order that is stable whatever ωΔt, and reach up to where
//! that is a turn, so that the RMS error falls with Δt^1.2 to Δt^1.6.
//!
//! Source: Stern & Grinspun (2009), Implicit-explicit variational integration of highly oscillatory problems, Multiscale
//! Model. Simul. 7, 1779-1794, with controllable dissipation added. The limit left is transverse:
//! [`super::limit::transverse_step`].

mod balance;
mod bed;
mod friction;
mod prepare;
mod rows;
mod solve;

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::layout::{Layout, Water, interior};
use super::limit::{axial_frequency_squared, transverse_step};
use super::step::Step;
use crate::math::lanes::Lanes;
use crate::model::{End, Line, LineState, Model, Release, WaveSpan};
use crate::physics::stretch::StretchLaw;
use balance::LineBalance;
use friction::SeabedRow;
use rows::{CurrentRow, NodeRow, Rows, SegmentRow, Sizes, springs, under};

/// Passes over slack and contact flags, at most [-].
const PASSES_MAX: usize = 8;
/// Square of ωΔt up to which tensions need no averaging, 4, with some to spare [-].
const EXPLICIT_PART: f64 = 3.2;
/// Share of T̄ that is averaged at least: axial waves then run in time up to (ωΔt)⁴ [-].
const SHARE_MIN: f64 = 1.0 / 3.0;
/// Rows of nodes that vectors of eight numbers do not pay for [-].
const FEW_ROWS: usize = 2;
/// Ends in the order of the line.
const ENDS: [End; 2] = [End::A, End::B];

/// Weights of T^{n+1}, T^n, T^{n−1}, T^{n−2} in T̄.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights([f64; 4]);

impl Weights {
    /// For the spectral radius ρ [-] at infinite frequency, ½ to 1.
    pub fn new(rho: f64) -> Weights {
        let b = (1.0 - rho) / (2.0 * rho);
        let n = (1.0 + rho) * (1.0 + rho) * (1.0 + b);
        Weights([1.0, 2.0 * rho + b, rho * (rho + 2.0 * b), rho * rho * b].map(|weight| weight / n))
    }

    /// Those of a share σ [-] that is averaged, and the rest at the present.
    fn shared(&self, share: f64) -> Weights {
        let [new, now, last, before] = self.0.map(|weight| weight * share);
        Weights([new, now + (1.0 - share), last, before])
    }
}

/// Share σ of T̄ that is averaged in a step [-], axial waves having frequencies up to the one whose square is given [1/s²].
fn averaged_share(frequency_squared: f64, step: Step) -> f64 {
    let explicit = EXPLICIT_PART / (frequency_squared * step.kick * step.drift);
    (1.0 - explicit).max(SHARE_MIN)
}

/// Bound on the rate at which axial dampers would take the velocities of a line's nodes away, all of it being where it is at home, in
/// water or without any, by Gershgorin [1/s].
fn damping_rate(line: &Line) -> f64 {
    let (segments, nodes) = (&line.segments, &line.nodes);
    let mass = |i: usize| nodes.mass_tangent[i].min(nodes.mass_normal[i]);
    let rate = |i: usize| {
        let yields = 1.0 / mass(i) + 1.0 / mass(i + 1);
        2.0 * segments.in_motion(i).1 / segments.length[i] * yields
    };
    (0..line.segment_count()).map(rate).fold(0.0, f64::max)
}

/// A line and the scratch of its steps.
#[derive(Debug, Clone)]
pub struct AxialWork {
    layout: Layout,
    /// Longest step times √T [s √N].
    pub transverse: f64,
    /// Weights of the averaging, and those of the step.
    averaging: Weights,
    weights: Weights,
    /// Square of the greatest frequency of axial waves, both ends being held [1/s²].
    frequency_squared: f64,
    /// Greatest rate at which axial dampers would take velocities away [1/s].
    damping_rate: f64,
    rows: Rows,
    /// State of the nodes on a seabed with a slope, soundings or friction; empty without one.
    seabed: Vec<SeabedRow>,
    /// Whether ends A and B are released from their points.
    released: [bool; 2],
    /// The energy balance, where the scene asks for it.
    balance: Option<LineBalance>,
    /// Greatest T̄ since then [N].
    tension_peak: Lanes,
    /// Greatest tension of the springs, and greatest T̄, when the state was handed back last [N].
    tensions: [f64; 2],
    /// Whether the flags and the true stretch of all steps since then were found.
    settled: bool,
    /// Whether springs up to t_n may push, of which not all is in T̄ then.
    forgets: bool,
    /// Whether no step has been made yet.
    starts: bool,
}

impl AxialWork {
    /// Scratch for a line of a model, with the spectral radius ρ [-]; `None` where its sections have different strain measures, which the
    /// kernel does not mix.
    pub fn new(model: &Model, line: &Line, rho: f64) -> Option<AxialWork> {
        let water = Water::around(model, line);
        let layout = Layout::new(model, (line, water), FEW_ROWS, true)?;
        let count = layout.rows().count();
        let column = |values: &[f64]| layout.striping.column(values, 1.0);
        let masses = [&line.nodes.mass_normal, &line.nodes.mass_tangent].map(|m| column(m));
        let free = interior(layout.striping, layout.segment_count);
        let node = |at: usize| NodeRow {
            mass_normal: masses[0].load(at),
            mass_tangent: masses[1].load(at),
            free: free.load(at),
            ..NodeRow::new()
        };
        Some(AxialWork {
            transverse: transverse_step(line, 1.0),
            averaging: Weights::new(rho),
            weights: Weights::new(rho),
            frequency_squared: axial_frequency_squared(line),
            damping_rate: damping_rate(line),
            rows: Rows {
                segments: layout.rows().map(|at| SegmentRow::new(&layout, at)).collect(),
                nodes: layout.rows().map(node).collect(),
                current: layout.flows().then(|| vec![CurrentRow::new(); count]),
            },
            released: [false; 2],
            seabed: vec![SeabedRow::new(); if layout.bottom().is_some() { count } else { 0 }],
            balance: layout.energy_balance.then(LineBalance::default),
            tension_peak: Lanes::splat(0.0),
            tensions: [0.0; 2],
            settled: true,
            forgets: false,
            starts: true,
            layout,
        })
    }

    /// Runs the kernel as it is compiled for any machine of the target, or for the best vectors of this one, as is the default.
    /// Results do not depend on it.
    pub fn set_portable(&mut self, portable: bool) {
        self.layout.set_portable(portable);
    }

    /// Takes over the state of a line.
    pub fn load(&mut self, state: &LineState) {
        self.layout.load(state);
        self.released = state.released;
        for end in ENDS {
            self.set_free(end, self.released[end as usize]);
        }
        self.resume();
        self.starts = state.half_step.is_unset();
        let count = self.layout.segment_count;
        if state.half_step.tension[0].len() == count {
            let [now, before] = &state.half_step.tension;
            for row in &mut self.rows.segments {
                row.history = [Lanes::splat(0.0); 3]; // of padding
            }
            for (at, tensions) in self.layout.striping.slots().zip(now.iter().zip(before)) {
                let [own, own_before, _] = &mut self.rows.segments[at.row - 1].history;
                (own[at.lane], own_before[at.lane]) = (*tensions.0, *tensions.1);
            }
            return;
        }
        self.layout.renew_halo(self.released);
        for at in self.layout.rows() {
            let strain = self.layout.strain(at);
            let tension = match &self.layout.viscoelastic {
                None => {
                    let force = strain.map(|strain| self.layout.law.at(strain).force);
                    self.layout.axial_stiffness.load(at) * force
                }
                Some(viscoelastic) => viscoelastic.elastic(at, strain),
            };
            self.rows.segments[at - 1].history = [tension; 3];
        }
    }

    /// Goes on from the state that [`Self::store`] handed back last.
    pub fn resume(&mut self) {
        self.clear_balance();
        (self.tension_peak, self.settled) = (Lanes::splat(0.0), true);
        self.starts = false;
    }

    /// Whether no step has been made yet, so that the ends are yet to be put where they set out.
    pub fn starts(&self) -> bool {
        self.starts
    }

    fn set_free(&mut self, end: End, free: bool) {
        let at = self.layout.end_slot(end);
        if self.layout.has_row(at) {
            self.rows.nodes[at.row - 1].free[at.lane] = f64::from(u8::from(free));
        }
    }

    /// Whether every step since [`Self::load`] found which segments are slack, where the bed pushes and how far stiff segments stretch.
    /// Where one did not, its tension is wrong by more than the tolerance: the steps were too long.
    pub fn is_settled(&self) -> bool {
        self.settled
    }

    /// Hands the state back after steps of `steps` [s]. Whether all nodes have finite positions, and speeds that mooring lines reach.
    pub fn store(&mut self, state: &mut LineState, steps: [f64; 2]) -> bool {
        state.released = self.released;
        let unit = self.layout.vector_unit;
        let is_sound;
        (is_sound, self.tensions) = unit.dispatch(HandBack(self, state, steps));
        is_sound
    }

    /// Takes over what waves do at the nodes of this line, by its number, over a span of time.
    pub fn load_waves(&mut self, span: &WaveSpan) {
        self.layout.load_waves(span);
    }

    /// Finds the nodes at the water's surface at t_n and sets their coefficients.
    #[inline]
    pub fn meet_surface(&mut self) {
        if self.layout.surface.is_some() {
            self.pierce_surface();
        }
    }

    /// [`Self::meet_surface`] of a line that may pierce it.
    fn pierce_surface(&mut self) {
        self.layout.find_surface();
        let Some(surface) = &self.layout.surface else {
            return;
        };
        for i in surface.crossed() {
            let at = self.layout.slot(i);
            let node = &mut self.rows.nodes[at.row - 1];
            [node.mass_normal[at.lane], node.mass_tangent[at.lane]] = surface.node(i).masses;
        }
    }

    /// Sets what multiplies the current at t_n [-].
    pub fn set_current(&mut self, factor: f64) {
        self.layout.set_current(factor);
    }

    /// Sets the waves to those of t_n [s].
    pub fn set_time(&mut self, t: f64) {
        self.layout.set_time(t);
    }

    /// Puts an end at a position [m] with the velocity [m/s] that the next step takes as lagged.
    pub fn put_end(&mut self, end: End, position: Vector3<f64>, velocity: Vector3<f64>) {
        if self.released[end as usize] {
            return;
        }
        self.layout.put_end(end, position, velocity);
    }

    /// Makes viscoelastic segments at the ends take these to have come as they go on, from where they were `lag` [s] ago.
    pub fn set_out_anew(&mut self, lag: f64) {
        self.layout.set_out_anew(lag);
    }

    /// Releases the ends whose tension at t_n, `t` [s], or time is due.
    pub fn release_ends(&mut self, releases: &[Release; 2], t: f64, step: Step) {
        for end in ENDS {
            let (side, at) = (end as usize, self.layout.end_slot(end));
            if self.released[side] {
                continue;
            }
            let tension = self.layout.end_tension(end, step);
            if !releases[side].is_due(tension, t) {
                continue;
            }
            let node = &self.rows.nodes[at.row - 1];
            let masses = [node.mass_normal[at.lane], node.mass_tangent[at.lane]];
            if let Some(balance) = &mut self.balance {
                balance.supply(self.layout.joining_energy(end, masses, step));
            }
            self.released[side] = true;
            self.set_free(end, true);
        }
    }

    /// Ends that a point holds.
    fn held_ends(&self) -> impl Iterator<Item = End> + use<> {
        let released = self.released;
        ENDS.into_iter().filter(move |&end| !released[end as usize])
    }

    /// One step; `ends` are the positions [m] of both ends after it. Returns the passes it took.
    pub fn step(&mut self, step: Step, ends: [Vector3<f64>; 2]) -> usize {
        let unit = self.layout.vector_unit;
        unit.dispatch(AxialStep(self, &step, &ends))
    }

    #[inline(always)]
    fn choose_step(&mut self, step: &Step, ends: &[Vector3<f64>; 2]) -> usize {
        use under::{LEVEL, NOTHING, ROUGH};
        match (self.rows.current.is_some(), self.bed_under()) {
            (false, NOTHING) => self.step_vectors::<false, NOTHING>(step, ends),
            (false, LEVEL) => self.step_vectors::<false, LEVEL>(step, ends),
            (false, _) => self.step_vectors::<false, ROUGH>(step, ends),
            (true, NOTHING) => self.step_vectors::<true, NOTHING>(step, ends),
            (true, LEVEL) => self.step_vectors::<true, LEVEL>(step, ends),
            (true, _) => self.step_vectors::<true, ROUGH>(step, ends),
        }
    }

    /// What is under the nodes.
    #[inline(always)]
    fn bed_under(&self) -> u8 {
        match (&self.layout.contact, self.seabed.is_empty()) {
            (None, _) => under::NOTHING,
            (Some(_), true) => under::LEVEL,
            (Some(_), false) => under::ROUGH,
        }
    }

    #[inline(always)]
    fn step_vectors<const CURRENT: bool, const BED: u8>(
        &mut self,
        step: &Step,
        ends: &[Vector3<f64>; 2],
    ) -> usize {
        let step = *step;
        self.choose_weights(step);
        let sizes = self.sizes(step);
        self.choose_springs(step, &sizes);
        self.prepare_drag::<CURRENT>(step);
        self.prepare_nodes::<CURRENT>(&sizes);
        self.prepare_ends(step, ends);
        match BED {
            under::NOTHING => {}
            under::LEVEL => self.prepare_contact(step),
            _ => self.meet_seabed(step),
        }
        self.weigh_nodes::<BED>();
        let mut passes = 0;
        loop {
            passes += 1;
            self.assemble(&sizes);
            let before = self.solve_tensions();
            self.find_velocities::<BED>(before, &sizes);
            let found = self.look_over::<BED>(&sizes);
            self.tension_peak = self.tension_peak.max(found.greatest);
            let bed_holds = self.bed_holds::<BED>(&found);
            let holds = self.segments_hold(&found, &sizes) && bed_holds;
            if holds || passes == PASSES_MAX {
                self.settled &= holds;
                break;
            }
            if !bed_holds {
                self.weigh_nodes::<BED>();
            }
        }
        if BED == under::ROUGH {
            self.keep_friction(step);
        }
        if self.balance.is_some() {
            self.balance_step(step, &sizes);
        }
        std::mem::swap(&mut self.layout.velocity, &mut self.layout.velocity_before);
        self.move_on(step, ends);
        passes
    }

    /// Weights of as much averaging as the step needs.
    #[inline(always)]
    fn choose_weights(&mut self, step: Step) {
        let share = match self.released {
            [false, false] => averaged_share(self.frequency_squared, step),
            _ => 1.0,
        };
        self.weights = self.averaging.shared(share);
    }

    #[inline(always)]
    fn choose_springs(&mut self, step: Step, sizes: &Sizes) {
        let line = &mut self.layout;
        if let Some(viscoelastic) = &mut line.viscoelastic {
            viscoelastic.prepare(step.drift);
            line.renew_halo(self.released);
            self.prepare_geometry();
            return self.prepare_segments::<{ springs::VISCOELASTIC }>(sizes);
        }
        line.renew_neighbours(self.released);
        self.prepare_geometry();
        match self.layout.law {
            StretchLaw::Engineering => self.prepare_segments::<{ springs::LINEAR }>(sizes),
            _ => self.prepare_segments::<{ springs::CURVED }>(sizes),
        }
    }

    /// Moves nodes and all that goes with them from t_n to t_{n+1}.
    #[inline(always)]
    fn move_on(&mut self, step: Step, ends: &[Vector3<f64>; 2]) {
        self.layout.drift(step.drift);
        for end in self.held_ends() {
            let at = self.layout.end_slot(end);
            self.layout.position.set(at, ends[end as usize]);
        }
        if self.layout.viscoelastic.is_some() {
            self.layout.position.wrap();
            self.relax_segments(step);
        }
        self.layout.pass_waves(step);
        self.meet_surface();
    }

    /// Takes the memory of viscoelastic segments to t_{n+1}, where the nodes now are.
    #[inline(always)]
    fn relax_segments(&mut self, step: Step) {
        for at in self.layout.rows() {
            let relaxed = self.layout.relax_segments(at, step);
            if self.balance.is_some() {
                self.balance_viscoelastic(at, relaxed, step);
            }
        }
    }

    /// Greatest T̄ [N] between the last time the state was loaded and [`Self::store`].
    pub fn tension_peak(&self) -> f64 {
        self.tensions[1]
    }

    /// Greatest tension [N] that [`Self::store`] handed back as that of t − Δt.
    pub fn tension_before(&self) -> f64 {
        self.tensions[0]
    }

    /// Index of the node that moves fastest.
    pub fn fastest_node(&self) -> usize {
        self.layout.fastest_node()
    }

    /// Index of the first node that has no finite position, or a speed that no mooring line reaches.
    pub fn broken_node(&self) -> Option<usize> {
        self.layout.broken_node()
    }
}

/// [`AxialWork::step`] for the vector unit of the machine.
struct AxialStep<'a>(&'a mut AxialWork, &'a Step, &'a [Vector3<f64>; 2]);

impl NullaryFnOnce for AxialStep<'_> {
    type Output = usize;

    #[inline(always)]
    fn call(self) -> usize {
        self.0.choose_step(self.1, self.2)
    }
}

/// [`AxialWork::store`] for the vector unit of the machine; gives the greatest tensions too.
struct HandBack<'a>(&'a AxialWork, &'a mut LineState, [f64; 2]);

impl NullaryFnOnce for HandBack<'_> {
    type Output = (bool, [f64; 2]);

    #[inline(always)]
    fn call(self) -> (bool, [f64; 2]) {
        let HandBack(work, state, steps) = self;
        let is_sound = work.layout.hand_back(state, steps);
        let (count, rows) = (work.layout.segment_count, work.rows.segments.len());
        let [now, before] = &mut state.half_step.tension;
        now.resize(count, 0.0);
        before.resize(count, 0.0);
        let (now, before) = (&mut now[..count], &mut before[..count]);
        let mut tensions = Tensions { now, before };
        let mut greatest = Lanes::splat(0.0);
        for (row, segment) in work.rows.segments.iter().enumerate() {
            let of = &segment.history;
            greatest = of[0].max(greatest);
            tensions.take(row, 0, of);
            tensions.take(rows + row, 1, of);
            tensions.take(2 * rows + row, 2, of);
            tensions.take(3 * rows + row, 3, of);
        }
        let peak = work.tension_peak.greatest()[0];
        (is_sound, [greatest.greatest()[0], peak])
    }
}

/// Tensions of the segments of a state at t − Δt and t − 2Δt [N].
struct Tensions<'a> {
    now: &'a mut [f64],
    before: &'a mut [f64],
}

impl Tensions<'_> {
    /// Takes over what a segment has `of` these in a lane; nothing if it is padding.
    #[inline(always)]
    fn take(&mut self, segment: usize, lane: usize, of: &[Lanes; 3]) {
        if segment < self.now.len() {
            (self.now[segment], self.before[segment]) = (of[0][lane], of[1][lane]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::AXIAL_RADIUS_MIN;
    use approx::assert_relative_eq;

    /// Size of an oscillation after many steps with ωΔt = 10⁴, over that at its start [-].
    fn stiff_oscillation(rho: f64) -> f64 {
        let Weights([new, now, last, before]) = Weights::new(rho);
        let (mut x, mut v) = ([1.0, 1.0, 1.0], 0.0);
        for _ in 0..200 {
            // v' = v − ω²Δt T̄ with the new x = x + Δt v', in units of Δt = 1
            let old = (new + now) * x[0] + last * x[1] + before * x[2];
            v = (v - 1e8 * old) / (1.0 + 1e8 * new);
            x = [x[0] + v, x[0], x[1]];
        }
        x[0].hypot(v)
    }

    #[test]
    fn the_least_radius_damps_a_stiff_oscillation_most_and_one_below_a_third_feeds_it() {
        let least = stiff_oscillation(AXIAL_RADIUS_MIN);
        for rho in [0.4, 0.6, 0.7, 0.9] {
            let other = stiff_oscillation(rho);
            assert!(least < other && other < 1e-6, "{rho}: {other:e}, {least:e}");
        }
        assert!(stiff_oscillation(0.3) > 1.0);
    }

    #[test]
    fn the_weights_sum_to_one_and_are_centred_at_the_present() {
        for rho in [0.5, 0.9, 1.0] {
            let Weights([new, now, last, before]) = Weights::new(rho);
            assert_relative_eq!(new + now + last + before, 1.0, max_relative = 1e-15);
            assert_relative_eq!(new - last - 2.0 * before, 0.0, epsilon = 1e-15);
        }
        assert_eq!(Weights::new(1.0), Weights([0.25, 0.5, 0.25, 0.0]));
    }
}
