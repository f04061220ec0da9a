//! Leapfrog with implicit axial tension: axial waves do not limit the step.
//!
//! With geometry q = d/l lagged at t_n and G(x)_i = (x_{i+1} − x_i)/L_i, the tension that drives v_{n−½} -> v_{n+½} is
//!
//! T̄ = σ[T^{n+1} + (2ρ+b)T^n + (ρ²+2ρb)T^{n−1} + ρ²b T^{n−2}]/N + (1−σ)T^n,  b = (1−ρ)/(2ρ),  N = (1+ρ)²(1+b),
//!
//! of second order. With z, the shift by one step, the first part is (z + ρ)²(z + b)/(N z²) T^n: with full averaging, σ = 1, the motion is
//! multiplied by −ρ and −b at infinite frequency. The spectral radius is ρ for b ≤ ρ, that is from ρ = ½, which damps most, to ρ = 1 (weights
//! ¼, ½, ¼). Below ½ it increases again, and below ⅓ it exceeds 1. Averaging delays waves by (3σ−1)(ωΔt)²/24, and waves up to ωΔt = 2 are stable
//! without it. Therefore σ = max(⅓, 1 − 3.2/(ωΔt)²), with the highest axial frequency ω of the line; this is stable for all ρ from ½ to 1. σ is 1
//! if springs may stiffen or are viscoelastic, or if an end is released. The new strain is linear in the new velocity,
//! ε^{n+1} = ε^n + κ + Δt q·G(v), κ = Δt²(|G(v⁻)|² − (q·G(v⁻))²)/(2 max(|G(r)|, L)), so that
//!
//! S^{n+1} = EA(ε^n + κ + Δt q·G(v)),  C = ½BA[(1+θ) q·G(v) + (1−θ) q·G(v⁻)] + θ BA κ/Δt,  T̄ = b₁(S^{n+1} + C) + Σ h_i (S^i + C)⁺,
//!
//! with S the tension of the springs as if they also pushed, C that of the dampers over the step, b₁ = σ/N the weight of T^{n+1}, and h_i those of
//! the earlier tensions. Dampers pull before segments are taut, and max(0, S + C) is averaged: a spring in compression is included if the damper
//! pulls more. (Averaging max(0, S) and adding C would tend to b₁S + C there, even in short steps.) θ = 0.2 min(1, r/4), where
//! r = Δt max 2 (BA/L)(1/M_i + 1/M_{i+1}) is the stiffness of the dampers over a step: of second order for r < 4, and without ringing of stiffer
//! dampers, whose force then leads by 0.1 Δt. A row is inactive if its total would be negative. Eliminating v with the momentum equations of the
//! nodes leaves one scalar tridiagonal system in T̄.
//!
//! A segment of a line that bends carries a compression of up to P ([`super::joints`]). Its tensions S, T and T̄ are measured from −P, and −P q acts on
//! the nodes together with the forces of the joints. Since the weights sum to one, this is equivalent to a spring of a different length.
//!
//! Springs whose tension is not proportional to strain are linearised at the strain that the segments are expected to reach, and after each pass at the
//! strain that they have reached, until the tension there agrees with the curve. Linearised at t_n, a stiffening rope that snaps taut would only have
//! the initial slope of its curve.
//!
//! Drag across the line, C v, is included in the mass of the node as θΔt C, θ = max(½, 1 − M/(Δt C)): trapezoidal, but limited where it exceeds
//! inertia, so that it does not reverse a velocity; such reversals would not decay. Drag along the line, K|u|u, is balanced by T̄ and averaged
//! like T̄: it is the mean of the values at t_{n−½} and t_{n+½}, the latter from a tangent at the extrapolated u. Evaluated at t_n alone, its
//! short-period harmonics would appear 1/(1 − σ sin²(ωΔt/2)) times as large in T^n. The seabed is also included in the mass (`contact`). The
//! assumptions on slack, earlier tensions and contact are checked after the solve, and the step is repeated until they hold.
//!
//! A prescribed end moves with the secant velocity of its path, which is its v_{n+½}. Only at the start, from rest or after a jump, v_{n−½} is
//! V − ½Δt A, with the velocity V and the acceleration A of its path.
//!
//! A step passes over the rows of the striped line ([`crate::math::striping`]) once per stage: geometry, segments, drag, inverse masses and
//! contact (`prepare`), and couplings; then, until the assumptions hold, the equations, T̄ by [`crate::math::striped_tridiagonal`], and the
//! velocities with the check of the assumptions (`solve`). Each sweep computes little per row and stores the input of the next one: the
//! processor then overlaps the latencies of roots, quotients and sums of several rows, and the compiler vectorises the sweep, which it cannot
//! do where values depend on the previous row.
//!
//! The scheme is of second order in the step, except for that lead. The remaining error of the tension is that of the axial waves from a line that
//! snaps taut. In steps much longer than their periods, these waves are delayed by (ωΔt)²/12, as with every second-order scheme that is stable for any ωΔt. They extend to
//! frequencies at which the delay is a full turn, so that the RMS error decreases with Δt^1.2 to Δt^1.6.
//!
//! Source: Stern & Grinspun (2009), Implicit-explicit variational integration of highly oscillatory problems, Multiscale
//! Model. Simul. 7, 1779-1794, with controllable dissipation added. The remaining limit is transverse:
//! [`crate::dynamics::limit::transverse_step`].

mod balance;
mod coupling;
mod friction;
mod prepare;
mod rows;
mod solve;

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::layout::{Layout, interior};
use super::network::LeapfrogNetwork;
use super::step::Step;
use super::{ENDS, Kernel, LeapfrogLine};
use crate::dynamics::Choice;
use crate::dynamics::limit::{axial_frequency_squared, end_shares, transverse_step};
use crate::math::lanes::Lanes;
use crate::math::striping::Slot;
use crate::model::{End, Kinematics, Line, LineState, Model, Network};
use crate::physics::stretch::StretchLaw;
use crate::scene::AXIAL_RADIUS_MIN;
use coupling::OpenRow;
use friction::SeabedRow;
use rows::{CurrentRow, NodeRow, Rows, SegmentRow, Sizes, springs, under};

/// Maximum number of passes of a step until the assumptions hold [-].
const PASSES_MAX: usize = 8;
/// Square of ωΔt up to which tensions need no averaging [-]: 4, reduced by a margin.
const EXPLICIT_PART: f64 = 3.2;
/// Minimum share of T̄ that is averaged [-]: the delay of axial waves is then of order (ωΔt)⁴.
const SHARE_MIN: f64 = 1.0 / 3.0;
/// Default spectral radius at infinite frequency [-].
const SPECTRAL_RADIUS: f64 = 0.9;
/// Tension that may arise within a communication step, relative to the largest one before it [-].
const SNAP_GROWTH: f64 = 1.5;

pub(super) type AxialLine = LeapfrogLine<AxialImplicit>;

/// Weights of T^{n+1}, T^n, T^{n−1}, T^{n−2} in T̄.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weights([f64; 4]);

impl Weights {
    /// Weights for a spectral radius ρ [-] at infinite frequency, ½ to 1.
    pub(super) fn new(rho: f64) -> Weights {
        let b = (1.0 - rho) / (2.0 * rho);
        let n = (1.0 + rho) * (1.0 + rho) * (1.0 + b);
        Weights([1.0, 2.0 * rho + b, rho * (rho + 2.0 * b), rho * rho * b].map(|weight| weight / n))
    }

    /// Weights if a share σ [-] is averaged and the rest is T^n.
    fn shared(&self, share: f64) -> Weights {
        let [new, now, last, before] = self.0.map(|weight| weight * share);
        Weights([new, now + (1.0 - share), last, before])
    }
}

/// Share σ of T̄ that is averaged in a step [-], for the squared highest circular frequency of axial waves [1/s²].
fn averaged_share(frequency_squared: f64, step: Step) -> f64 {
    let explicit = EXPLICIT_PART / (frequency_squared * step.kick * step.drift);
    (1.0 - explicit).max(SHARE_MIN)
}

/// Gershgorin's bound on the rate at which axial dampers alone would reduce velocities [1/s], from the smaller mass of each node.
fn damping_rate(line: &Line) -> f64 {
    let (segments, nodes) = (&line.segments, &line.nodes);
    let mass = |i: usize| nodes.mass_tangent[i].min(nodes.mass_normal[i]);
    let rate = |i: usize| {
        let yields = 1.0 / mass(i) + 1.0 / mass(i + 1);
        2.0 * segments.in_motion(i).1 / segments.length[i] * yields
    };
    (0..line.segment_count()).map(rate).fold(0.0, f64::max)
}

/// Workspace of the stages with implicit tension.
#[derive(Debug, Clone)]
pub struct AxialImplicit {
    /// Longest step times √(T + P) [s √N].
    transverse: f64,
    /// Largest P [N].
    push_max: f64,
    /// Weights of full averaging, and those of the step.
    averaging: Weights,
    weights: Weights,
    /// [`axial_frequency_squared`] [1/s²].
    frequency_squared: f64,
    /// Bound on the rate at which axial dampers alone would reduce velocities [1/s].
    damping_rate: f64,
    rows: Rows,
    /// State of the nodes on a seabed with a slope, soundings or friction; empty for other seabeds.
    seabed: Vec<SeabedRow>,
    /// Tensions as functions of the velocities of free points at the ends; empty between prescribed ends.
    open: Vec<OpenRow>,
    /// Largest T̄ in the communication step [N], per lane.
    tension_peak: Lanes,
    /// Largest tension of the springs, and largest T̄, when the state was last stored [N].
    tensions: [f64; 2],
    /// True if slack, contact and true stretch have converged in all steps of the communication step.
    settled: bool,
    /// True if springs may be in compression, so that T̄ contains only a part of the earlier tensions.
    forgets: bool,
    /// True if no step has been taken yet.
    starts: bool,
}

impl Kernel for AxialImplicit {
    const SECANTS: bool = true;
    /// Empty: each line has a separate limit.
    type Bound = ();
    type Points = coupling::Coupling;

    fn new(model: &Model, line: &Line, layout: &Layout) -> AxialImplicit {
        let radius = model.solver.spectral_radius.unwrap_or(SPECTRAL_RADIUS);
        let averaging = Weights::new(radius.max(AXIAL_RADIUS_MIN));
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
        let shares = end_shares(model, line);
        AxialImplicit {
            transverse: transverse_step(line, 1.0, shares),
            push_max: line.greatest_push(),
            averaging,
            weights: averaging,
            frequency_squared: axial_frequency_squared(line, shares),
            open: match layout.tied {
                [true, true] => Vec::new(),
                _ => vec![OpenRow::default(); count],
            },
            damping_rate: damping_rate(line),
            rows: Rows {
                segments: layout.rows().map(|at| SegmentRow::new(layout, at)).collect(),
                nodes: layout.rows().map(node).collect(),
                current: layout.flows().then(|| vec![CurrentRow::new(); count]),
            },
            seabed: vec![SeabedRow::new(); if layout.seabed().is_some() { count } else { 0 }],
            tension_peak: Lanes::splat(0.0),
            tensions: [0.0; 2],
            settled: true,
            forgets: false,
            starts: true,
        }
    }

    fn points(model: &Model, network: &Network) -> coupling::Coupling {
        coupling::Coupling::new(model, network)
    }

    fn load(work: &mut AxialLine, state: &LineState) {
        let memory = &state.half_step;
        let fresh = memory.tension[0].len() != work.layout.segment_count;
        match fresh {
            true => work.start_tensions(),
            false => work.kernel.load_tensions(&work.layout, &memory.tension),
        }
        let kernel = &mut work.kernel;
        kernel.restart();
        kernel.starts = memory.is_unset();
        kernel.tensions[0] = memory.tension[0]
            .iter()
            .fold(0.0, |a, &b| if b > a { b } else { a });
    }

    fn resume(work: &mut AxialLine, _: &LineState) {
        work.clear_balance();
        work.kernel.restart();
    }

    fn store(work: &mut AxialLine, state: &mut LineState, steps: [f64; 2]) -> bool {
        let unit = work.layout.vector_unit;
        let is_sound;
        (is_sound, work.kernel.tensions) = unit.dispatch(Store(work, state, steps));
        is_sound
    }

    fn set_free(work: &mut AxialLine, end: End, free: bool) {
        let at = work.layout.end_slot(end);
        if work.layout.has_row(at) {
            work.kernel.rows.nodes[at.row - 1].free[at.lane] = f64::from(u8::from(free));
        }
    }

    fn end_masses(work: &AxialLine, end: End) -> [f64; 2] {
        let at = work.layout.end_slot(end);
        let node = &work.kernel.rows.nodes[at.row - 1];
        [node.mass_normal[at.lane], node.mass_tangent[at.lane]]
    }

    fn meet_surface(work: &mut AxialLine) {
        let Some(surface) = &work.layout.surface else {
            return;
        };
        for i in surface.crossed() {
            let at = work.layout.slot(i);
            let node = &mut work.kernel.rows.nodes[at.row - 1];
            [node.mass_normal[at.lane], node.mass_tangent[at.lane]] = surface.node(i).masses;
        }
    }

    fn starts(work: &AxialLine) -> bool {
        work.kernel.starts
    }

    fn step(
        network: &mut LeapfrogNetwork<AxialImplicit>,
        model: &Model,
        [t, after]: [f64; 2],
        step: Step,
        held: &impl Fn(usize, f64) -> Kinematics,
    ) -> usize {
        network.find_ends(after, step.drift, held);
        if !network.points.is_empty() {
            return coupling::step(network, model, t, step);
        }
        let mut passes = 0;
        for (line, ends) in network.lines_and_ends() {
            let ends = &ends.map(|end| end.position);
            passes = passes.max(line.run(Whole { step, ends }));
        }
        passes
    }

    /// The step is limited by transverse waves, under one and a half times the largest tension of the last step.
    fn longest_step(
        network: &mut LeapfrogNetwork<AxialImplicit>,
        _: &Model,
        choice: &Choice,
        [_, length]: [f64; 2],
    ) -> (f64, ()) {
        let mut longest = choice.longest;
        for AxialImplicit {
            transverse,
            push_max,
            tensions,
            ..
        } in network.lines.iter().map(|line| &line.kernel)
        {
            let expected = SNAP_GROWTH * tensions[0] - (SNAP_GROWTH - 1.0) * push_max;
            // most limits exceed the whole communication step, and need no root or quotient
            if length * length * expected > transverse * transverse {
                longest = longest.min(transverse / expected.sqrt());
            }
        }
        (longest, ())
    }

    fn were_short(
        network: &mut LeapfrogNetwork<AxialImplicit>,
        _: &Model,
        _: &(),
        [_, drift]: [f64; 2],
    ) -> bool {
        let mut lines = network.lines.iter().map(|line| &line.kernel);
        lines
            .all(|line| line.settled && drift * drift * line.tensions[1] <= line.transverse * line.transverse)
    }
}

impl AxialImplicit {
    fn restart(&mut self) {
        (self.tension_peak, self.settled) = (Lanes::splat(0.0), true);
        self.starts = false;
    }

    /// Loads the tensions of the segments at t_{n−1} and t_{n−2} [N].
    fn load_tensions(&mut self, layout: &Layout, [now, before]: &[Vec<f64>; 2]) {
        for row in &mut self.rows.segments {
            row.history = [Lanes::splat(0.0); 3]; // for padding
        }
        for (at, tensions) in layout.striping.slots().zip(now.iter().zip(before)) {
            let [own, own_before, _] = &mut self.rows.segments[at.row - 1].history;
            (own[at.lane], own_before[at.lane]) = (*tensions.0, *tensions.1);
        }
    }
}

impl AxialLine {
    fn start_tensions(&mut self) {
        self.layout.renew_halo();
        for at in self.layout.rows() {
            let strain = self.layout.strain(at);
            let segment = &mut self.kernel.rows.segments[at - 1];
            segment.history = [self.layout.elastic(at, strain) - self.layout.least_tension(at); 3];
        }
    }

    #[inline]
    fn run<S: Stage>(&mut self, stage: S) -> S::Found {
        let unit = self.layout.vector_unit;
        unit.dispatch(Run(self, stage))
    }

    /// Force of the joints on the lower node of a segment, less P along the segment [N].
    fn shear(&self, at: Slot) -> Vector3<f64> {
        let joints = self.layout.joints.as_ref();
        joints.map_or(Vector3::zeros(), |joints| joints.shear.get(at))
    }

    /// Ends at prescribed points.
    fn prescribed_ends(&self) -> impl Iterator<Item = End> + use<> {
        let open = ENDS.map(|end| self.layout.is_open(end));
        ENDS.into_iter().filter(move |&end| !open[end as usize])
    }

    #[inline(always)]
    fn seabed_under(&self) -> u8 {
        match (&self.layout.contact, self.kernel.seabed.is_empty()) {
            (None, _) => under::NOTHING,
            (Some(_), true) => under::LEVEL,
            (Some(_), false) => under::ROUGH,
        }
    }

    /// Evaluates all quantities of a step that do not depend on T̄.
    #[inline(always)]
    fn prepare<const SEABED: u8>(&mut self, step: Step, ends: &[Vector3<f64>; 2]) -> Sizes {
        self.choose_weights(step);
        let sizes = self.sizes(step);
        self.choose_springs(step, &sizes);
        self.layout.bend(1.0);
        match self.kernel.rows.current.is_some() {
            true => self.prepare_nodes::<true>(step, &sizes),
            false => self.prepare_nodes::<false>(step, &sizes),
        }
        self.prepare_ends(step, ends);
        self.layout.press_seabed(step);
        match SEABED {
            under::NOTHING => {}
            under::LEVEL => self.prepare_contact(&sizes),
            _ => self.meet_seabed(&sizes),
        }
        self.weigh_nodes::<SEABED>();
        sizes
    }

    /// Computes the velocities from T̄; `before` is T̄ of the segments before the first row [N]. Returns whether the velocities agree with the assumptions,
    /// and corrects the assumptions if not.
    #[inline(always)]
    fn pass<const SEABED: u8>(&mut self, before: Lanes, sizes: &Sizes) -> bool {
        self.find_velocities::<SEABED>(before, sizes);
        let found = self.look_over::<SEABED>(sizes);
        self.kernel.tension_peak = self.kernel.tension_peak.max(found.greatest);
        let contact_holds = self.contact_holds::<SEABED>(&found, sizes);
        let holds = self.segments_hold(&found, sizes) && contact_holds;
        if !contact_holds {
            self.weigh_nodes::<SEABED>();
        }
        holds
    }

    /// Adds the step to the energy balance, stores friction, and moves the nodes to t_{n+1}.
    #[inline(always)]
    fn finish<const SEABED: u8>(&mut self, step: Step, ends: &[Vector3<f64>; 2], sizes: &Sizes) {
        if SEABED == under::ROUGH {
            self.keep_friction(step);
        }
        if self.balance.is_some() {
            self.balance_step(step, sizes);
        }
        std::mem::swap(&mut self.layout.velocity, &mut self.layout.velocity_before);
        self.move_on(step, ends);
    }

    #[inline(always)]
    fn choose_weights(&mut self, step: Step) {
        let share = match self.layout.released {
            [false, false] => averaged_share(self.kernel.frequency_squared, step),
            _ => 1.0,
        };
        self.kernel.weights = self.kernel.averaging.shared(share);
    }

    #[inline(always)]
    fn choose_springs(&mut self, step: Step, sizes: &Sizes) {
        let line = &mut self.layout;
        if let Some(viscoelastic) = &mut line.viscoelastic {
            viscoelastic.prepare(step.drift);
            line.renew_halo();
            self.prepare_geometry();
            return self.prepare_segments::<{ springs::VISCOELASTIC }>(sizes);
        }
        line.renew_neighbours();
        self.prepare_geometry();
        match self.layout.law {
            StretchLaw::Engineering => self.prepare_segments::<{ springs::LINEAR }>(sizes),
            _ => self.prepare_segments::<{ springs::CURVED }>(sizes),
        }
    }

    /// Advances nodes, viscoelastic segments, waves and water surface from t_n to t_{n+1}.
    #[inline(always)]
    fn move_on(&mut self, step: Step, ends: &[Vector3<f64>; 2]) {
        self.layout.drift(step.drift);
        for end in ENDS
            .into_iter()
            .filter(|&end| !self.layout.released[end as usize])
        {
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

    /// Advances the internal variables of viscoelastic segments to t_{n+1}, the time of the positions.
    #[inline(always)]
    fn relax_segments(&mut self, step: Step) {
        for at in self.layout.rows() {
            let relaxed = self.layout.relax_segments(at, step);
            if self.balance.is_some() {
                self.balance_viscoelastic(at, relaxed, step);
            }
        }
    }
}

trait Stage {
    type Found;

    /// Runs the stage for a kind of seabed.
    fn run<const SEABED: u8>(self, line: &mut AxialLine) -> Self::Found;
}

/// Stage for the vector unit of the machine.
struct Run<'a, S>(&'a mut AxialLine, S);

impl<S: Stage> NullaryFnOnce for Run<'_, S> {
    type Output = S::Found;

    #[inline(always)]
    fn call(self) -> S::Found {
        use under::{LEVEL, NOTHING, ROUGH};
        let Run(line, stage) = self;
        match line.seabed_under() {
            NOTHING => stage.run::<NOTHING>(line),
            LEVEL => stage.run::<LEVEL>(line),
            _ => stage.run::<ROUGH>(line),
        }
    }
}

/// Whole step of a line without free points. Returns the number of passes.
struct Whole<'a> {
    step: Step,
    ends: &'a [Vector3<f64>; 2],
}

impl Stage for Whole<'_> {
    type Found = usize;

    #[inline(always)]
    fn run<const SEABED: u8>(self, line: &mut AxialLine) -> usize {
        let Whole { step, ends } = self;
        let sizes = line.prepare::<SEABED>(step, ends);
        let mut passes = 0;
        loop {
            passes += 1;
            line.assemble(&sizes);
            let before = line.solve_tensions();
            let holds = line.pass::<SEABED>(before, &sizes);
            if holds || passes == PASSES_MAX {
                line.kernel.settled &= holds;
                break;
            }
        }
        line.finish::<SEABED>(step, ends, &sizes);
        passes
    }
}

/// [`AxialImplicit::store`] for the vector unit of the machine; also returns the largest tensions.
struct Store<'a>(&'a AxialLine, &'a mut LineState, [f64; 2]);

impl NullaryFnOnce for Store<'_> {
    type Output = (bool, [f64; 2]);

    #[inline(always)]
    fn call(self) -> (bool, [f64; 2]) {
        let Store(work, state, steps) = self;
        let is_sound = work.layout.hand_back(state, steps);
        let (count, rows) = (work.layout.segment_count, work.kernel.rows.segments.len());
        let [now, before] = &mut state.half_step.tension;
        now.resize(count, 0.0);
        before.resize(count, 0.0);
        let (now, before) = (&mut now[..count], &mut before[..count]);
        let mut tensions = Tensions { now, before };
        let mut greatest = Lanes::splat(0.0);
        for (row, segment) in work.kernel.rows.segments.iter().enumerate() {
            let of = &segment.history;
            greatest = of[0].max(greatest);
            tensions.take(row, 0, of);
            tensions.take(rows + row, 1, of);
            tensions.take(2 * rows + row, 2, of);
            tensions.take(3 * rows + row, 3, of);
        }
        let peak = work.kernel.tension_peak.greatest()[0];
        (is_sound, [greatest.greatest()[0], peak])
    }
}

/// Tensions of the segments of a state at t − Δt and t − 2Δt [N].
struct Tensions<'a> {
    now: &'a mut [f64],
    before: &'a mut [f64],
}

impl Tensions<'_> {
    /// Copies the tensions of a segment from a lane of `of`; does nothing if the segment is padding.
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

    /// Amplitude of an oscillation after many steps with ωΔt = 10⁴, relative to its initial amplitude [-].
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
