//! Leapfrog integrators of cables, on lumped two-node segments.
//!
//! Positions are defined at t_n, velocities at t_{n−½}. A step of a network has the stages
//!
//! 1. tension of the segments and forces of the joints at t_n, and release of ends;
//! 2. motion of the free points under the forces of their lines;
//! 3. prescribed points at t_{n+1};
//! 4. velocities of the nodes at t_{n+½}, with water and seabed, and positions at t_{n+1}.
//!
//! A [`Kernel`] implements the stages of a line: [`Explicit`], or [`AxialImplicit`], which solves for the tension in stage 4. The striped layout,
//! release of ends, water surface, loading and storing of the state, and the energy balance are common to both.

mod axial_implicit;
mod balance;
mod contact;
mod explicit;
mod joints;
mod layout;
mod network;
mod point;
pub mod step;
mod surface;

use std::fmt::Debug;

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::Choice;
use super::motion::AxisPath;
use crate::model::{End, Kinematics, Line, LineState, Model, Network, Release, WaveSpan};
use balance::LineBalance;
use layout::{Layout, Water};
use step::Step;

pub use axial_implicit::AxialImplicit;
pub use explicit::Explicit;
pub(super) use explicit::segment_tension;
pub use network::LeapfrogNetwork;

/// Ends in the order of the nodes.
const ENDS: [End; 2] = [End::A, End::B];

/// Prescribed motion of an end of a line.
#[derive(Debug, Clone, Copy)]
pub struct EndMotion {
    /// Position [m].
    pub position: Vector3<f64>,
    /// Velocity half a step earlier [m/s].
    pub velocity: Vector3<f64>,
}

/// Stages of a step of a line that depend on the treatment of its tension.
pub trait Kernel: Debug + Clone + Sized {
    /// True if prescribed ends move with the secant velocities of their paths.
    const SECANTS: bool;
    /// Quantities at the start of the steps that limit their length.
    type Bound;

    /// Workspace of the free points of a network.
    type Points: Debug + Clone + Default;

    /// Allocates the kernel of a line in its striped layout.
    fn new(model: &Model, line: &Line, layout: &Layout) -> Self;

    /// Allocates the workspace of the free points of a network.
    fn points(model: &Model, network: &Network) -> Self::Points;

    /// Loads the quantities of a line that are not part of the layout.
    fn load(work: &mut LeapfrogLine<Self>, state: &LineState);

    /// Continues from the state that was stored last.
    fn resume(work: &mut LeapfrogLine<Self>, state: &LineState);

    /// Stores the state after steps of `steps` [s], newest first. Returns whether all nodes have finite positions and physically possible speeds.
    fn store(work: &mut LeapfrogLine<Self>, state: &mut LineState, steps: [f64; 2]) -> bool;

    /// Sets whether the node at an end moves like the interior nodes.
    fn set_free(work: &mut LeapfrogLine<Self>, end: End, free: bool);

    /// Mass of the half node at an end across and along the line [kg].
    fn end_masses(work: &LeapfrogLine<Self>, end: End) -> [f64; 2];

    /// Sets the coefficients of the nodes at the water surface.
    fn meet_surface(work: &mut LeapfrogLine<Self>);

    /// Returns whether the ends must be moved to their points at the start of a communication step.
    fn starts(work: &LeapfrogLine<Self>) -> bool;

    /// Sets the path of the winch from a time [s] on. The end must already have its position at that time. `fresh` is true before the first step from rest.
    fn start_winch(_: &mut LeapfrogLine<Self>, _: &AxisPath, (_t, _fresh): (f64, bool), _: Step) {}

    /// Takes a step of a network between two times [s], after its water is set and its ends are released. Returns the number of solves.
    fn step(
        network: &mut LeapfrogNetwork<Self>,
        model: &Model,
        times: [f64; 2],
        step: Step,
        held: &impl Fn(usize, f64) -> Kinematics,
    ) -> usize;

    /// Longest step [s] of a network in a communication step, whose start and length [s] are `span`.
    fn longest_step(
        network: &mut LeapfrogNetwork<Self>,
        model: &Model,
        choice: &Choice,
        span: [f64; 2],
    ) -> (f64, Self::Bound);

    /// Returns whether the steps were short enough; `at` is the end of the last one and their length [s].
    fn were_short(
        network: &mut LeapfrogNetwork<Self>,
        model: &Model,
        bound: &Self::Bound,
        at: [f64; 2],
    ) -> bool;
}

/// Workspace of a line.
#[derive(Debug, Clone)]
pub struct LeapfrogLine<K> {
    layout: Layout,
    /// Energy balance; `None` if the scene does not include it.
    balance: Option<LineBalance>,
    kernel: K,
}

/// [`LeapfrogLine::put_ends`] for the vector unit of the machine.
struct PutEnds<'a>(&'a mut Layout, [&'a EndMotion; 2]);

impl NullaryFnOnce for PutEnds<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let PutEnds(layout, ends) = self;
        layout.place_ends(ends);
    }
}

impl<K: Kernel> LeapfrogLine<K> {
    /// Allocates the workspace of a line; `None` if its sections have different strain measures, which the kernels do not mix.
    fn new(model: &Model, line: &Line, tied: [bool; 2]) -> Option<LeapfrogLine<K>> {
        let water = Water::around(model, line);
        let longest = line.winch.as_ref().map_or(line, |winch| winch.longest());
        let layout = Layout::new(model, (longest, water), tied)?;
        Some(LeapfrogLine {
            kernel: K::new(model, line, &layout),
            balance: layout.energy_balance.then(LineBalance::default),
            layout,
        })
    }

    fn load(&mut self, state: &LineState) {
        self.layout.load(state);
        K::load(self, state);
        for end in ENDS {
            K::set_free(self, end, self.is_released(end));
        }
        self.clear_balance();
        self.set_out(0.5 * state.half_step.steps[0]);
    }

    fn is_released(&self, end: End) -> bool {
        self.layout.released[end as usize]
    }

    /// Finds the nodes at the water surface at t_n and sets their coefficients.
    fn meet_surface(&mut self) {
        if self.layout.surface.is_some() {
            self.layout.find_surface();
            K::meet_surface(self);
        }
    }

    /// Loads the water motion due to waves over a time span, unless it is already loaded.
    fn load_waves(&mut self, span: &WaveSpan) {
        if self.layout.lacks_waves(span) {
            self.layout.load_waves(span);
        }
    }

    /// Releases the ends that have reached their release tension or time at t_n, `t` [s].
    fn release_ends(&mut self, releases: &[Release; 2], t: f64, step: Step) {
        for end in ENDS {
            let side = end as usize;
            let is_due = || releases[side].is_due(self.layout.end_tension(end, step), t);
            if self.layout.released[side] || !is_due() {
                continue;
            }
            if self.layout.tied[side] && self.balance.is_some() {
                let energy = self.layout.joining_energy(end, K::end_masses(self, end), step);
                self.supply(energy);
            }
            self.layout.released[side] = true;
            K::set_free(self, end, true);
        }
    }

    /// Moves the ends that are not released from their points.
    fn put_ends(&mut self, ends: [&EndMotion; 2]) {
        self.layout.vector_unit.dispatch(PutEnds(&mut self.layout, ends));
    }

    /// Restarts viscoelastic segments and the work of the ends after a jump, from the positions that the current velocities give half the `last` step
    /// [s] ago.
    fn set_out_anew(&mut self, last: f64) {
        let lag = 0.5 * last;
        self.set_out(lag);
        self.layout.set_out_anew(lag);
    }
}
