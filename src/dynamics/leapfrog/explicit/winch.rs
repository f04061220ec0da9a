//! A line on a winch: the length of its end segment changes with time.
//!
//! The winch is at end B, x_B, and prescribes the paid-out length ℓ(t). The unstretched length e of the end segment changes with ℓ,
//! and so do the lumped properties of its two nodes. With the stretch λ = l/e and the direction q, the velocity of the material at the winch is
//!
//!   V_B = ẋ_B − ℓ̇ λ q,      so that      λ̇ e = q·(V_B − v) = q·(ẋ_B − v) − λ ℓ̇,
//!
//! with v the velocity of the neighbour. The end node has the velocity V_B, which gives the strain rate of the end segment and the
//! velocity of a node that is inserted into it. The neighbour gains mass that moves with it: M v̇ = f with increasing M.
//!
//! Beyond the lengths given by [`Winch::passage`](crate::model::Winch::passage), the end segment splits in two, or merges with its
//! neighbour. A split interpolates position and velocity linearly. Lumped masses are linear in the adjacent lengths, so that mass and
//! momentum are conserved, including the half node at the winch, which moves with V_B. A merge gives the remaining momentum to the node before the
//! removed one; it reverses a split exactly. The energy that a split or a merge adds or removes counts as work of the winch.
//!
//! The winch supplies (W − T λ)·ℓ̇ to the line, with W the energy per unstretched length of the end segment, and the kinetic and
//! potential energy of the mass that the neighbour gains. The end force times V_B contains the part −T λ ℓ̇.
//!
//! Derivation: dE/dt of the segment energy e·W(λ − 1) with e(t) and l(t), W′ = T.
//! Valid for winches that are slow compared with axial waves. A merge replaces the curved line within the merged segments by their chord: a relative
//! error of tension of about (e κ)²/8 · EA/T at a curvature κ, once at every merge.

use nalgebra::Vector3;

use super::ExplicitLine;
use crate::dynamics::leapfrog::step::Step;
use crate::dynamics::motion::AxisPath;
use crate::math::striping::{Column, Field, Slot, Striping};
use crate::model::{End, Line, LineState, Passage, Winch, WinchState};

/// Number of segments, counted from the winch, whose energy a split or a merge can change.
const CHANGED: usize = 3;

#[derive(Debug, Clone)]
pub(super) struct WinchWork {
    line: Line,
    /// Paid-out length over time [m].
    path: AxisPath,
    winch_state: WinchState,
    /// State of the winch at t_{n+1}, used while the energy of a step is added to the balance.
    next: WinchState,
    /// Energy of the end segment at t_n per unstretched length [N].
    density: f64,
}

impl WinchWork {
    /// Allocates the workspace of a line; `None` if it is not on a winch.
    pub(super) fn new(line: &Line) -> Option<Box<WinchWork>> {
        line.winch.as_ref()?;
        Some(Box::new(WinchWork {
            line: line.clone(),
            path: AxisPath::at_rest(0.0),
            winch_state: WinchState::at_rest(0.0),
            next: WinchState::at_rest(0.0),
            density: 0.0,
        }))
    }

    fn winch(&self) -> &Winch {
        let winch = self.line.winch.as_ref();
        winch.expect("made for a line on a winch")
    }

    /// Unstretched length of the end segment [m] at a length change [m].
    fn end_length(&self, change: f64) -> f64 {
        self.winch().end_length(self.line.segment_count(), change)
    }

    /// Energy that the neighbour of the end gains from t_{n−½} to t_{n+½}, and its kinetic part, ½ M_n v² [J], from the velocities [m/s] and
    /// heights [m] at these times; `halves` are the length changes then [m].
    fn taken_up(&self, halves: [f64; 2], velocities: [Vector3<f64>; 2], heights: [f64; 2]) -> [f64; 2] {
        let (n, nodes) = (self.line.segment_count(), &self.line.nodes);
        let per_length = |values: &[f64]| 0.5 * values[n] / nodes.length[n];
        let [mass, weight] = [&nodes.mass_normal, &nodes.weight].map(|values| per_length(values));
        let grown = [
            self.winch_state.change - halves[0],
            halves[1] - self.winch_state.change,
        ];
        let motion = |side: usize| grown[side] * 0.5 * mass * velocities[side].norm_squared();
        let height = |side: usize| grown[side] * weight * heights[side];
        let kinetic = motion(0) + motion(1);
        [kinetic + height(0) + height(1), kinetic]
    }
}

impl ExplicitLine {
    /// Loads the state of the winch, and updates the arrays of the line to its length.
    pub(super) fn load_winch(&mut self, state: &LineState) {
        let Some(winch) = &mut self.kernel.winch else {
            return;
        };
        winch.winch_state = state.winch_state.unwrap_or(WinchState::at_rest(0.0));
        let count = state.position.len() - 1;
        winch.line.pay_out(count, winch.winch_state.change);
        self.lay_out(0);
    }

    /// Stores the state of the winch, and resizes the arrays of the nodes.
    pub(super) fn store_winch(&self, state: &mut LineState) {
        if let Some(winch) = &self.kernel.winch {
            let nodes = self.layout.segment_count + 1;
            state.winch_state = Some(winch.winch_state);
            for values in [&mut state.position, &mut state.velocity, &mut state.acceleration] {
                values.resize(nodes, Vector3::zeros());
            }
            if !state.anchor.is_empty() {
                state.anchor.resize(nodes, Vector3::zeros());
            }
        }
    }

    /// Sets the path of the winch from `t` [s] on. The end must already have its position at that time. `fresh` is true before the first step from rest.
    pub(super) fn start_winch(&mut self, path: &AxisPath, (t, fresh): (f64, bool), step: Step) {
        let Some(winch) = &mut self.kernel.winch else {
            return;
        };
        winch.path = *path;
        if fresh {
            winch.winch_state.half_step = [winch.winch_state.change, path.at(t).slope];
        }
        let winch_state = winch.winch_state;
        self.transport(winch_state, step.lag());
    }

    /// Sets the velocity of the end to that of its material half a step, `lag` [s], before the time of the positions.
    fn transport(&mut self, winch_state: WinchState, lag: f64) {
        let Some(winch) = &self.kernel.winch else {
            return;
        };
        let [change, rate] = winch_state.half_step;
        let layout = &mut self.layout;
        let (end, near) = (layout.end_slot(End::B), layout.end_neighbour(End::B));
        let place = |at: Slot| layout.position.get(at) - lag * layout.velocity.get(at);
        let stretch = (place(end) - place(near)) / winch.end_length(change); // λ q
        let velocity = layout.velocity.get(end) - rate * stretch;
        layout.velocity.set(end, velocity);
    }

    /// Evaluates the energy density of the end segment at t_n for the energy balance.
    #[inline]
    pub fn weigh_end_segment(&mut self) {
        let (Some(winch), Some(_)) = (&mut self.kernel.winch, &self.balance) else {
            return;
        };
        let (layout, i) = (&self.layout, self.layout.segment_count - 1);
        let length = winch.line.segments.length[i];
        let ends = [layout.end_slot(End::B), layout.end_neighbour(End::B)];
        let [end, near] = ends.map(|at| layout.position.get(at));
        let chord = end - near;
        winch.density = winch.line.spring(i, chord.norm() / length - 1.0).energy;
    }

    /// Advances the winch to `t` [s], the end of a step: adds its work to the energy balance, and sets the velocity of the material at the end.
    /// The end must already have moved.
    pub(super) fn wind(&mut self, t: f64, step: Step) {
        let Some(winch) = &mut self.kernel.winch else {
            return;
        };
        let (now, path) = (winch.winch_state, winch.path.at(t));
        winch.next = WinchState {
            change: path.value,
            rate: path.slope,
            acceleration: path.curvature,
            half_step: [
                0.5 * (now.change + path.value),
                (path.value - now.change) / step.drift,
            ],
        };
        let halves = [now.half_step[0], winch.next.half_step[0]];
        let (layout, at) = (&self.layout, self.layout.end_neighbour(End::B));
        let velocities = [layout.velocity_before.get(at), layout.velocity.get(at)];
        let [before, after] = velocities.map(|velocity| velocity.z);
        let height = layout.position.get(at).z - step.drift * after; // at t_n
        let lag = step.lag();
        let heights = [height - lag * before, height + 0.5 * step.drift * after];
        let next = winch.next;
        let brought = [
            [winch.density * (halves[1] - halves[0]), 0.0],
            winch.taken_up(halves, velocities, heights),
        ];
        brought.into_iter().for_each(|energy| self.supply(energy));
        self.transport(next, 0.5 * step.drift);
    }

    /// Sets the end segment to its new length, and splits or merges it. The work of the ends must already be part of the energy balance.
    pub(super) fn renew_end_segment(&mut self, step: Step) {
        let Some(winch) = &mut self.kernel.winch else {
            return;
        };
        winch.winch_state = winch.next;
        let change = winch.winch_state.change;
        let passage = |work: &WinchWork| {
            let count = work.line.segment_count();
            work.winch().passage(count, change)
        };
        if passage(winch).is_none() {
            winch.line.set_length_change(change);
            let last = self.layout.segment_count - 1;
            return self.lay_out(last);
        }
        while let Some(passage) = self.kernel.winch.as_deref().and_then(passage) {
            self.pass(passage, 0.5 * step.drift);
        }
        if let Some(winch) = &mut self.kernel.winch {
            winch.line.set_length_change(change);
        }
        self.lay_out(0);
    }

    /// Splits or merges the end segment; the velocities are those `lag` [s] before the time of the positions.
    fn pass(&mut self, passage: Passage, lag: f64) {
        let Some(winch) = &mut self.kernel.winch else {
            return;
        };
        let (n, winch_state) = (self.layout.segment_count, winch.winch_state);
        let (first, striping) = (n.saturating_sub(CHANGED), self.layout.striping);
        winch.line.set_length_change(winch_state.half_step[0]); // the time of the energies
        let before = self.energy_from(first, lag);
        let layout = &mut self.layout;
        let Some(winch) = &mut self.kernel.winch else {
            return;
        };
        let motions = [
            &mut layout.position,
            &mut layout.velocity,
            &mut layout.velocity_before,
        ];
        let count = match passage {
            Passage::Split => {
                let nominal = winch.winch().longest().segments.length[n - 1];
                let part = nominal / winch.end_length(winch_state.change);
                for motion in motions {
                    split(motion, striping, n, part);
                }
                n + 1
            }
            Passage::Merge => {
                let [place, velocity, velocity_before] = motions;
                let old = last_masses(&winch.line, n - 2);
                winch.line.pay_out(n - 1, winch_state.half_step[0]);
                let new = last_masses(&winch.line, n - 2);
                for motion in [velocity, velocity_before] {
                    merge(motion, striping, n, old, new);
                }
                place.set(striping.slot(n - 1), place.get(striping.slot(n)));
                n - 1
            }
        };
        winch.line.pay_out(count, winch_state.half_step[0]);
        layout.set_segment_count(count);
        let after = self.energy_from(first, lag);
        self.supply([0, 1].map(|part| after[part] - before[part]));
    }

    /// Energy of the segments from `first` on and of the nodes between them, and its kinetic part [J], at the time of the velocities, `lag` [s] before
    /// that of the positions. The mass along the line is taken as equal to that across it. Zero without an energy balance.
    fn energy_from(&self, first: usize, lag: f64) -> [f64; 2] {
        let (Some(winch), Some(_)) = (&self.kernel.winch, &self.balance) else {
            return [0.0; 2];
        };
        let (layout, line) = (&self.layout, &winch.line);
        let n = layout.segment_count;
        let position = |i: usize| layout.position.get(layout.slot(i));
        let velocity = |i: usize| layout.velocity.get(layout.slot(i));
        let last = |i: usize| position(i) - position(i - 1);
        let [_, rate] = winch.winch_state.half_step;
        let stretch = last(n) / winch.end_length(winch.winch_state.change);
        let place = |i: usize| {
            let transport = if i == n { rate } else { 0.0 };
            position(i) - lag * (velocity(i) + transport * stretch)
        };
        let axial = |i: usize| {
            let strain = (place(i + 1) - place(i)).norm() / line.segments.length[i] - 1.0;
            line.spring(i, strain).energy * line.segments.length[i]
        };
        let height = |i: usize| line.nodes.weight[i] * place(i).z;
        let motion = |i: usize| 0.5 * line.nodes.mass_normal[i] * velocity(i).norm_squared();
        let kinetic: f64 = (first + 1..n).map(motion).sum();
        let rest = (first..n).map(axial).sum::<f64>() + (first + 1..n).map(height).sum::<f64>();
        [kinetic + rest, kinetic]
    }

    /// Writes segments and nodes from `from` on to the arrays of the layout and the kernel, followed by padding.
    fn lay_out(&mut self, from: usize) {
        let Some(winch) = &self.kernel.winch else {
            return;
        };
        let (layout, segments, nodes) = (&mut self.layout, &winch.line.segments, &winch.line.nodes);
        let n = winch.line.segment_count();
        layout.set_segment_count(n);
        put(
            &mut layout.axial_stiffness,
            from,
            n,
            |i| segments.axial_stiffness[i],
            0.0,
        );
        put(
            &mut layout.axial_damping,
            from,
            n,
            |i| segments.axial_damping[i],
            0.0,
        );
        put(
            &mut layout.inverse_length,
            from,
            n,
            |i| 1.0 / segments.length[i],
            1.0,
        );
        put(&mut layout.weight, from, n + 1, |i| nodes.weight[i], 0.0);
        put(
            &mut self.kernel.inverse_mass,
            from,
            n + 1,
            |i| 1.0 / nodes.mass_normal[i],
            0.0,
        );
        let first = self.kernel.interior[layout.slot(0)];
        let interior = |i: usize| if i == 0 { first } else { 1.0 };
        put(&mut self.kernel.interior, from, n, interior, 0.0);
        if let (Some(into), Some(values)) = (&mut layout.mass_damping, &nodes.mass_damping) {
            put(into, from, n + 1, |i| values[i], 0.0);
        }
        if let (Some(into), Some(contact)) = (&mut layout.contact, &nodes.contact) {
            let level = |i: usize| match contact.seabed {
                Some(_) => contact.lift(i),
                None => contact.level[i],
            };
            put(&mut into.level, from, n + 1, level, 0.0);
            put(&mut into.stiffness, from, n, |i| contact.stiffness[i], 0.0);
            put(&mut into.damping, from, n, |i| contact.damping[i], 0.0);
            put(&mut into.yields, from, n, |i| 1.0 / contact.mass[i], 0.0);
            if let (Some(seabed), false) = (&mut into.seabed, contact.stick.is_empty()) {
                put(&mut seabed.stick, from, n + 1, |i| contact.stick[i], 0.0);
            }
        }
        for at in beyond(layout.striping, from, n + 1) {
            layout.velocity.set(at, Vector3::zeros());
            layout.velocity_before.set(at, Vector3::zeros());
        }
        self.lay_out_water(from);
    }

    fn lay_out_water(&mut self, from: usize) {
        let (Some(winch), Some(water)) = (&self.kernel.winch, &mut self.kernel.water) else {
            return;
        };
        let (nodes, n) = (&winch.line.nodes, winch.line.segment_count());
        if let Some(drag) = &nodes.drag {
            put(&mut water.drag_normal, from, n + 1, |i| drag.normal[i], 0.0);
            put(&mut water.drag_tangent, from, n + 1, |i| drag.tangent[i], 0.0);
        }
        let inverse = |i: usize| 1.0 / nodes.mass_tangent[i] - 1.0 / nodes.mass_normal[i];
        put(&mut water.inverse_mass_excess, from, n + 1, inverse, 0.0);
    }
}

/// Masses [kg] of up to three nodes from `first` on.
fn last_masses(line: &Line, first: usize) -> [f64; 3] {
    let masses = &line.nodes.mass_normal;
    [0, 1, 2].map(|k| masses.get(first + k).copied().unwrap_or(0.0))
}

/// Writes values `from` to `count` − 1, followed by padding.
fn put(into: &mut Column, from: usize, count: usize, value: impl Fn(usize) -> f64, padding: f64) {
    let striping = into.striping();
    (from..count).for_each(|i| into[striping.slot(i)] = value(i));
    beyond(striping, from, count).for_each(|at| into[at] = padding);
    into.wrap();
}

/// Slots after `count` nodes that must be reset to padding: all if `from` is 0, else none.
fn beyond(striping: Striping, from: usize, count: usize) -> impl Iterator<Item = Slot> {
    let end = if from == 0 { striping.room() } else { count };
    (count..end).map(move |i| striping.slot(i))
}

/// Inserts a node into the last segment, which ends at node `end`, at a fraction `part` [-] of its length.
fn split(motion: &mut Field, striping: Striping, end: usize, part: f64) {
    let [near, far] = [end - 1, end].map(|i| motion.get(striping.slot(i)));
    motion.set(striping.slot(end), near + part * (far - near));
    motion.set(striping.slot(end + 1), far);
}

/// Removes the neighbour of the end and conserves momentum; `old` are the masses of the last three nodes, `new` those of the two that remain [kg].
fn merge(velocity: &mut Field, striping: Striping, end: usize, old: [f64; 3], new: [f64; 3]) {
    let last = [end - 2, end - 1, end].map(|i| striping.slot(i));
    let [before, near, far] = last.map(|at| velocity.get(at));
    let momentum = old[0] * before + old[1] * near + (old[2] - new[1]) * far;
    velocity.set(last[0], momentum / new[0]);
    velocity.set(last[1], far);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::draft;
    use approx::assert_relative_eq;

    /// Line with an end segment of 6.2 m, in irregular motion.
    fn work() -> ExplicitLine {
        let rope = draft("line_types.rope = { mass = 20.0, axial_stiffness = 1.0e6 }");
        let ends = rope
            .fixed("low", [0.0, 0.0, -20.0])
            .fixed("high", [30.0, 0.0, 0.0]);
        let line = ends.line("rope", ["low", "high"], "rope", 40.0, 10);
        let model = line.with("winch = { end = 'b', length_max = 20.0 }").model();
        let mut work = ExplicitLine::new(&model, &model.lines[0], [true; 2]).unwrap();
        let wild = |i: usize, k: f64| {
            let i = i as f64;
            Vector3::new((3.0 * i + k).sin(), (5.0 * i * k).cos(), (i + 2.0 * k).sin())
        };
        let mut state = LineState::at_rest(
            (0..=10)
                .map(|i| 4.0 * i as f64 * Vector3::x() + wild(i, 0.1))
                .collect(),
        );
        state.half_step.velocity = (0..=10).map(|i| wild(i, 1.0)).collect();
        state.half_step.velocity_before = (0..=10).map(|i| wild(i, 2.0)).collect();
        state.winch_state = Some(WinchState {
            change: 2.2,
            rate: 0.7,
            acceleration: 0.0,
            half_step: [2.2, 0.7],
        });
        work.load(&state);
        work
    }

    /// Mass [kg] and momenta [kg m/s] of all nodes, including the half node at the winch.
    fn content(work: &ExplicitLine) -> (f64, [Vector3<f64>; 2]) {
        let nodes = &work.kernel.winch.as_ref().unwrap().line.nodes;
        let motions = [&work.layout.velocity, &work.layout.velocity_before];
        let momenta = motions.map(|motion| {
            let nodes = nodes.mass.iter().enumerate();
            nodes
                .map(|(i, mass)| *mass * motion.get(work.layout.slot(i)))
                .sum()
        });
        (nodes.mass.iter().sum(), momenta)
    }

    #[test]
    fn a_split_and_a_merge_keep_mass_and_momentum() {
        let mut work = work();
        let (mass, momenta) = content(&work);
        assert_relative_eq!(mass, 20.0 * 42.2, max_relative = 1e-14);
        let motion = [work.layout.velocity.clone(), work.layout.velocity_before.clone()];
        for passage in [Passage::Split, Passage::Merge, Passage::Merge, Passage::Merge] {
            work.pass(passage, 1e-3);
            let (kept_mass, kept) = content(&work);
            assert_relative_eq!(kept_mass, mass, max_relative = 1e-14);
            for (kept, was) in kept.iter().zip(&momenta) {
                assert_relative_eq!(*kept, *was, epsilon = 1e-11);
            }
        }
        assert_eq!(work.layout.segment_count, 8);
        let mut again = self::work();
        again.pass(Passage::Split, 1e-3);
        again.pass(Passage::Merge, 1e-3);
        for (motion, was) in [&again.layout.velocity, &again.layout.velocity_before]
            .iter()
            .zip(&motion)
        {
            for i in 0..=10 {
                let at = again.layout.slot(i);
                assert_relative_eq!(motion.get(at), was.get(at), epsilon = 1e-12);
            }
        }
    }
}
