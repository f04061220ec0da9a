//! Loading of a line's state before the steps, and its check and storage after them.

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::Layout;
use crate::dynamics::leapfrog::step::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::math::striping::{Field, Slot, Striping};
use crate::model::LineState;

/// Speed that only unstable steps reach [m/s]: about that of the fastest axial waves.
const SPEED_MAX: f64 = 1e4;

/// Nodes of a state: positions [m]; velocities at the same time, half a step earlier, and one and a half steps earlier [m/s].
struct Nodes<'a> {
    position: &'a mut [Vector3<f64>],
    velocity: &'a mut [Vector3<f64>],
    half: &'a mut [Vector3<f64>],
    before: &'a mut [Vector3<f64>],
}

impl<'a> Nodes<'a> {
    /// Returns the first `count` values of each, so that the compiler omits bounds checks.
    #[inline(always)]
    fn first(self, count: usize) -> Nodes<'a> {
        Nodes {
            position: &mut self.position[..count],
            velocity: &mut self.velocity[..count],
            half: &mut self.half[..count],
            before: &mut self.before[..count],
        }
    }

    /// Copies the values of a node from a lane of `of`; does nothing if the node is padding.
    #[inline(always)]
    fn take(&mut self, node: usize, lane: usize, of: &[Vectors; 4]) {
        if node < self.position.len() {
            self.position[node] = of[0].get(lane);
            self.velocity[node] = of[1].get(lane);
            self.half[node] = of[2].get(lane);
            self.before[node] = of[3].get(lane);
        }
    }
}

/// [`Layout::store`] for the vector unit of the machine.
struct HandBack<'a>(&'a Layout, &'a mut LineState, [f64; 2]);

impl NullaryFnOnce for HandBack<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        self.0.hand_back(self.1, self.2)
    }
}

/// Returns whether [`Layout::soundness`] of all rows is positive, for the vector unit of the machine.
struct AreSound<'a>(&'a Layout);

impl NullaryFnOnce for AreSound<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let mut sound = Lanes::splat(1.0);
        for row in self.0.rows() {
            sound = sound.where_positive(self.0.soundness(row));
        }
        sound.all_positive()
    }
}

/// Padding nodes at different positions: their chords are never zero.
pub(super) fn padded_positions(striping: Striping) -> Field {
    let mut position = Field::zeros(striping);
    for (i, at) in striping.slots().enumerate() {
        position.set(at, padding(i));
    }
    position
}

/// Position of node `i` as padding [m].
fn padding(i: usize) -> Vector3<f64> {
    i as f64 * Vector3::x()
}

impl Layout {
    /// Loads the state of a line; the halo must be renewed afterwards. Padding is reset: a step that was too long may have affected it through
    /// its neighbours.
    pub fn load(&mut self, state: &LineState) {
        self.released = state.released;
        let memory = &state.half_step;
        let fresh = memory.is_unset();
        if let Some(viscoelastic) = &mut self.viscoelastic {
            let half = match fresh {
                true => &state.viscoelastic,
                false => &memory.viscoelastic,
            };
            let chords = state.chords_before();
            let slots = chords.zip(self.striping.slots());
            let strains = slots.map(|(l, at)| l.norm() * self.inverse_length[at] - 1.0);
            viscoelastic.load([&state.viscoelastic, half], strains);
        }
        let zero = Vector3::zeros();
        for (i, at) in self.striping.slots().enumerate() {
            let Some(position) = state.position.get(i) else {
                self.position.set(at, padding(i));
                self.velocity.set(at, zero);
                self.velocity_before.set(at, zero);
                continue;
            };
            self.position.set(at, *position);
            let (velocity, before) = if fresh {
                (state.velocity[i], state.velocity[i])
            } else {
                (memory.velocity[i], memory.velocity_before[i])
            };
            self.velocity.set(at, velocity);
            self.velocity_before.set(at, before);
        }
    }

    /// Stores the state after steps of `steps` [s], newest first, with velocities extrapolated to the time of the positions. Returns whether all
    /// nodes have finite positions and physically possible speeds.
    pub fn store(&self, state: &mut LineState, steps: [f64; 2]) -> bool {
        self.vector_unit.dispatch(HandBack(self, state, steps))
    }

    /// [`Self::store`], inlined into its caller.
    #[inline(always)]
    pub fn hand_back(&self, state: &mut LineState, steps: [f64; 2]) -> bool {
        state.released = self.released;
        if let Some(viscoelastic) = &self.viscoelastic {
            viscoelastic.store(&mut state.viscoelastic, &mut state.half_step.viscoelastic);
        }
        let memory = &mut state.half_step;
        let count = state.position.len();
        memory.velocity.resize(count, Vector3::zeros());
        memory.velocity_before.resize(count, Vector3::zeros());
        memory.steps = steps;
        let extrapolation = Lanes::splat(Step::after(steps, steps[0]).extrapolation);
        let nodes = Nodes {
            position: &mut state.position,
            velocity: &mut state.velocity,
            half: &mut memory.velocity,
            before: &mut memory.velocity_before,
        };
        let mut nodes = nodes.first(count);
        let (rows, mut sound) = (self.striping.rows(), Lanes::splat(1.0));
        for row in 0..rows {
            let values = self.motion(row + 1, extrapolation);
            sound = sound.where_positive(self.soundness(row + 1));
            // not a loop over lanes: the compiler would vectorise it, which does not suit these stores
            nodes.take(row, 0, &values);
            nodes.take(rows + row, 1, &values);
            nodes.take(2 * rows + row, 2, &values);
            nodes.take(3 * rows + row, 3, &values);
        }
        if count > 4 * rows {
            // the node after the last row
            nodes.take(4 * rows, 3, &self.motion(rows + 1, extrapolation));
        }
        if let Some(seabed) = self.seabed() {
            let places = state.position.iter().zip(self.striping.slots());
            for (anchor, (position, at)) in state.anchor.iter_mut().zip(places) {
                *anchor = position + seabed.friction.get(at) / seabed.stick[at];
            }
        }
        sound.all_positive()
    }

    /// Positions of the nodes of a row [m], and their velocities at the same time, half a step and one and a half steps earlier [m/s].
    #[inline(always)]
    fn motion(&self, row: usize, extrapolation: Lanes) -> [Vectors; 4] {
        let (half, before) = (self.velocity.load(row), self.velocity_before.load(row));
        let velocity = half + (half - before).scale(extrapolation);
        [self.position.load(row), velocity, half, before]
    }

    /// Positive for nodes of a row that have a finite position and a physically possible speed [m²/s²].
    #[inline(always)]
    pub fn soundness(&self, row: usize) -> Lanes {
        let (position, velocity) = (self.position.load(row), self.velocity.load(row));
        let zero = (position.x + position.y + position.z) * Lanes::splat(0.0); // NaN unless finite
        let fastest = Lanes::splat(SPEED_MAX * SPEED_MAX);
        fastest + zero - velocity.dot(velocity)
    }

    /// Index of the fastest node.
    pub fn fastest_node(&self) -> usize {
        let speeds = self.nodes().map(|at| self.velocity.get(at).norm_squared());
        let fastest = speeds.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
        fastest.map_or(0, |(node, _)| node)
    }

    /// Index of the first node whose position is not finite or whose speed is physically impossible.
    pub fn broken_node(&self) -> Option<usize> {
        let broken = |at: Slot| {
            let (position, velocity) = (self.position.get(at), self.velocity.get(at));
            let slow = velocity.norm_squared() < SPEED_MAX * SPEED_MAX;
            !slow || !position.iter().all(|value| value.is_finite())
        };
        match self.vector_unit.dispatch(AreSound(self)) {
            true => None,
            false => self.nodes().position(broken),
        }
    }
}
