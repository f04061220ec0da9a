//! A line laid out for the leapfrog kernels: padded arrays, four nodes or segments to a vector.
//!
//! Node i and segment i, which lies between nodes i and i + 1, stand at index [`FIRST`] + i. Padding has no stiffness, no
//! weight and no drag, so that it stays at rest and no loop has a remainder.

use std::sync::Arc;

use nalgebra::Vector3;
use pulp::{Arch, NullaryFnOnce};

use super::leapfrog::Step;
use super::surface::SurfaceNow;
use crate::math::lanes::{Components, LANES, Lanes, Vectors};
use crate::model::{Bottom, Contact, End, Line, LineState};
use crate::physics::flow::{Profile, Stream};
use crate::physics::friction::Friction;
use crate::physics::seabed::ContactCoefficients;
use crate::physics::stretch::StretchLaw;

/// Index of node 0 and of segment 0.
pub(super) const FIRST: usize = LANES;
/// Speed that only an unstable step reaches [m/s]: the fastest axial waves run at about this speed.
const SPEED_MAX: f64 = 1e4;
/// Keeps coincident nodes from dividing by zero [m²].
const LENGTH2_MIN: f64 = 1e-200;

/// Geometry, motion and coefficients of a line.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub segment_count: usize,
    /// The widest vectors of this machine; results do not depend on it.
    pub vector_unit: Arch,
    pub law: StretchLaw,
    pub negative_tension: bool,
    /// Node positions at t_n [m].
    pub position: Components,
    /// Velocities at t_{n−½} [m/s].
    pub velocity: Components,
    /// Velocities at t_{n−3/2} [m/s].
    pub velocity_before: Components,
    pub inverse_length: Vec<f64>,
    pub axial_stiffness: Vec<f64>,
    pub axial_damping: Vec<f64>,
    pub weight: Vec<f64>,
    pub drag: Option<DragArrays>,
    /// The current, where it acts on the line.
    pub current: Option<CurrentNow>,
    pub mass_damping: Option<Vec<f64>>,
    pub contact: Option<ContactArrays>,
    /// The water's surface, where the line may pierce it.
    pub surface: Option<SurfaceNow>,
}

/// Lumped drag coefficients [N s²/m²].
#[derive(Debug, Clone)]
pub(super) struct DragArrays {
    pub normal: Vec<f64>,
    pub tangent: Vec<f64>,
}

/// The current at t_n.
#[derive(Debug, Clone)]
pub(super) struct CurrentNow {
    pub profile: Profile,
    /// What multiplies it [-].
    pub factor: f64,
}

impl CurrentNow {
    fn stream(&self) -> Stream<'_> {
        Stream {
            profile: &self.profile,
            factor: self.factor,
        }
    }
}

/// Lumped contact coefficients [N/m, N s/m] and the z [m] below which they push; over a bed that slopes or rubs the height above it, along its normal.
#[derive(Debug, Clone)]
pub(super) struct ContactArrays {
    pub level: Vec<f64>,
    pub stiffness: Vec<f64>,
    pub damping: Vec<f64>,
    /// Where the bed is more than a level plane without friction.
    pub bottom: Option<BottomArrays>,
}

/// A bed that slopes or rubs.
#[derive(Debug, Clone)]
pub(super) struct BottomArrays {
    pub bottom: Arc<Bottom>,
    /// Stiffness along the bed of a node that sticks [N/m]; 0 without friction.
    pub stick: Vec<f64>,
    /// Friction on the nodes in the last step [N].
    pub rub: Components,
}

impl ContactArrays {
    fn new(contact: &Contact, keep: impl Fn(&[f64]) -> Vec<f64>) -> ContactArrays {
        let lifts = || (0..contact.level.len()).map(|i| contact.lift(i)).collect();
        let bottom = contact.bottom.as_ref();
        let level: Vec<f64> = bottom.map_or_else(|| contact.level.clone(), |_| lifts());
        let level = keep(&level);
        ContactArrays {
            bottom: bottom.map(|bottom| BottomArrays {
                bottom: bottom.clone(),
                stick: keep(&contact.stick),
                rub: Components::zeros(level.len()),
            }),
            level,
            stiffness: keep(&contact.stiffness),
            damping: keep(&contact.damping),
        }
    }

    /// Spring and damper of the node at `at`.
    pub fn coefficients(&self, at: usize) -> ContactCoefficients {
        ContactCoefficients {
            stiffness: self.stiffness[at],
            damping: self.damping[at],
        }
    }
}

impl Layout {
    /// Arrays for a line; `None` where its sections have different strain measures, which the kernels do not mix.
    pub fn new(line: &Line, profile: Option<&Profile>, negative_tension: bool) -> Option<Layout> {
        let n = line.segment_count();
        let size = padded_size(n);
        let keep = |values: &[f64]| pad(n, values, 0.0);
        let nodes = &line.nodes;
        let lengths = pad(n, &line.segments.length, 1.0);
        Some(Layout {
            segment_count: n,
            vector_unit: Arch::new(),
            law: line.uniform_law()?,
            negative_tension,
            position: padded_positions(size),
            velocity: Components::zeros(size),
            velocity_before: Components::zeros(size),
            inverse_length: lengths.iter().map(|length| 1.0 / length).collect(),
            axial_stiffness: keep(&line.segments.axial_stiffness),
            axial_damping: keep(&line.segments.axial_damping),
            weight: keep(&nodes.weight),
            drag: nodes.drag.as_ref().map(|drag| DragArrays {
                normal: keep(&drag.normal),
                tangent: keep(&drag.tangent),
            }),
            current: profile
                .filter(|_| nodes.drag.is_some())
                .map(|profile| CurrentNow {
                    profile: profile.clone(),
                    factor: 1.0,
                }),
            mass_damping: nodes.mass_damping.as_ref().map(|damping| keep(damping)),
            contact: nodes
                .contact
                .as_ref()
                .map(|contact| ContactArrays::new(contact, keep)),
            surface: SurfaceNow::new(line),
        })
    }

    /// Takes over positions and velocities of a line.
    pub fn load(&mut self, state: &LineState) {
        let memory = &state.half_step;
        let fresh = memory.velocity.is_empty();
        for (i, position) in state.position.iter().enumerate() {
            self.position.set(FIRST + i, *position);
            let (velocity, before) = if fresh {
                (state.velocity[i], state.velocity[i])
            } else {
                (memory.velocity[i], memory.velocity_before[i])
            };
            self.velocity.set(FIRST + i, velocity);
            self.velocity_before.set(FIRST + i, before);
        }
    }

    /// Hands them back after steps of `steps` [s], with velocities extrapolated to the time of the positions.
    pub fn store(&self, state: &mut LineState, steps: [f64; 2]) {
        let memory = &mut state.half_step;
        let count = state.position.len();
        memory.velocity.resize(count, Vector3::zeros());
        memory.velocity_before.resize(count, Vector3::zeros());
        memory.steps = steps;
        let extrapolation = Step::after(steps, steps[0]).extrapolation;
        for i in 0..count {
            let (velocity, before) = (
                self.velocity.get(FIRST + i),
                self.velocity_before.get(FIRST + i),
            );
            state.position[i] = self.position.get(FIRST + i);
            state.velocity[i] = velocity + extrapolation * (velocity - before);
            memory.velocity[i] = velocity;
            memory.velocity_before[i] = before;
        }
        if let Some(bottom) = self.bottom() {
            for (i, anchor) in state.anchor.iter_mut().enumerate() {
                let rub = bottom.rub.get(FIRST + i) / bottom.stick[FIRST + i];
                *anchor = state.position[i] + rub;
            }
        }
    }

    /// The bed, where it is more than a level plane without friction.
    pub fn bottom(&self) -> Option<&BottomArrays> {
        self.contact.as_ref()?.bottom.as_ref()
    }

    /// The contact with a bed that slopes or rubs, and its friction.
    pub fn rubbing(&self) -> Option<(&ContactArrays, Option<&Friction>)> {
        let contact = self.contact.as_ref()?;
        let bottom = contact.bottom.as_ref()?;
        Some((contact, bottom.bottom.friction.as_ref()))
    }

    /// Remembers the friction on a node [N].
    pub fn set_rub(&mut self, at: usize, rub: Vector3<f64>) {
        if let Some(contact) = &mut self.contact
            && let Some(bottom) = &mut contact.bottom
        {
            bottom.rub.set(at, rub);
        }
    }

    /// How far the node at `at` is below the level from which the bed pushes it [m], and the bed's normal there; it must lie over a bed that
    /// slopes or rubs.
    #[inline]
    pub fn stand(&self, at: usize) -> (f64, Vector3<f64>) {
        let contact = self.contact.as_ref().expect("asked over a bed only");
        let bottom = contact
            .bottom
            .as_ref()
            .expect("asked over a bed that slopes or rubs only");
        let (below, normal) = bottom.bottom.ground.stand(self.position.get(at));
        (below + contact.level[at], normal)
    }

    /// Unit vector along the chord of the nodes beside the one at `at`, which is none of the ends.
    pub fn tangent_of(&self, at: usize) -> Vector3<f64> {
        let chord = self.position.get(at + 1) - self.position.get(at - 1);
        chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
    }

    /// Finds where the surface crosses the line, and sets the weights of the nodes it crosses.
    pub fn find_surface(&mut self) {
        let Some(surface) = &mut self.surface else {
            return;
        };
        surface.find(&self.position.z);
        for i in surface.crossed() {
            let now = surface.node(i);
            self.weight[FIRST + i] = now.weight;
            if let Some(drag) = &mut self.drag {
                [drag.normal[FIRST + i], drag.tangent[FIRST + i]] = now.drag;
            }
        }
    }

    /// Books what joined with the water, except at ends that are held.
    pub fn book_surface(&mut self, held: [bool; 2]) {
        let Some(surface) = &mut self.surface else {
            return;
        };
        let [first, last] = held.map(usize::from);
        for i in first..=self.segment_count - last {
            surface.book(i, &self.velocity, &self.position);
        }
    }

    /// Forgets what joined with the water.
    pub fn clear_surface(&mut self) {
        if let Some(surface) = &mut self.surface {
            surface.joined = 0.0;
        }
    }

    /// Buoyancy that an end lacks at t_n [N].
    pub fn end_lack(&self, end: End) -> f64 {
        let node = self.end_index(end) - FIRST;
        let surface = self.surface.as_ref();
        surface.map_or(0.0, |surface| surface.lack(node))
    }

    /// Energy of motion that joined with the water since the state was loaded [J].
    pub fn joined(&self) -> f64 {
        self.surface.as_ref().map_or(0.0, |surface| surface.joined)
    }

    /// Sets what multiplies the current at t_n [-].
    pub fn set_current(&mut self, factor: f64) {
        if let Some(current) = &mut self.current {
            current.factor = factor;
        }
    }

    /// Velocities of the water at the nodes [m/s]; the line must lie in a current.
    #[inline(always)]
    pub fn water_velocity(&self, at: usize) -> Vectors {
        let current = self
            .current
            .as_ref()
            .expect("this kernel runs in a current");
        let z = Lanes::load(&self.position.z, at);
        let shape = current.profile.velocities(z);
        shape.scale(Lanes::splat(current.factor))
    }

    /// Velocity of the water at a node [m/s].
    pub fn water_velocity_of(&self, at: usize) -> Vector3<f64> {
        self.current.as_ref().map_or(Vector3::zeros(), |current| {
            current.stream().velocity(self.position.z[at])
        })
    }

    /// Puts an end at a position [m] with the velocity [m/s] that the next step takes as lagged.
    pub fn put_end(&mut self, end: End, position: Vector3<f64>, velocity: Vector3<f64>) {
        let at = self.end_index(end);
        self.position.set(at, position);
        self.velocity.set(at, velocity);
    }

    /// Index of the node at an end.
    pub fn end_index(&self, end: End) -> usize {
        match end {
            End::A => FIRST,
            End::B => FIRST + self.segment_count,
        }
    }

    #[inline(always)]
    /// Starts of the vectors that cover all segments.
    pub fn segment_blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (FIRST..FIRST + self.segment_count).step_by(LANES)
    }

    #[inline(always)]
    /// Starts of the vectors that cover all nodes.
    pub fn node_blocks(&self) -> impl Iterator<Item = usize> + use<> {
        (FIRST..=FIRST + self.segment_count).step_by(LANES)
    }

    /// Unit vectors along the chord of the neighbouring nodes.
    #[inline(always)]
    pub fn tangent(&self, at: usize) -> Vectors {
        let chord = self.position.load(at + 1) - self.position.load(at - 1);
        chord.scale(
            (chord.dot(chord) + Lanes::splat(LENGTH2_MIN))
                .sqrt()
                .recip(),
        )
    }

    /// Vectors along the segments, and the inverse of their lengths.
    #[inline(always)]
    pub fn chord(&self, at: usize) -> (Vectors, Lanes) {
        let chord = self.position.load(at + 1) - self.position.load(at);
        (
            chord,
            (chord.dot(chord) + Lanes::splat(LENGTH2_MIN))
                .sqrt()
                .recip(),
        )
    }

    /// Velocities extrapolated to t_n [m/s].
    #[inline(always)]
    pub fn velocity_now(&self, at: usize, step: Step) -> Vectors {
        let velocity = self.velocity.load(at);
        velocity
            + (velocity - self.velocity_before.load(at)).scale(Lanes::splat(step.extrapolation))
    }

    /// Moves the nodes from t_n to t_{n+1}.
    pub fn drift(&mut self, drift: f64) {
        let unit = self.vector_unit;
        unit.dispatch(Drift(self, drift));
    }

    #[inline(always)]
    fn drift_nodes(&mut self, drift: f64) {
        let drift = Lanes::splat(drift);
        for at in self.node_blocks() {
            let position = self.position.load(at) + self.velocity.load(at).scale(drift);
            self.position.store(position, at);
        }
    }

    /// Greatest ratio K |v| / M of the nodes [1/s], v relative to the water: explicit drag wants Δt below its inverse.
    pub fn drag_rate(&self, line: &Line) -> f64 {
        let Some(drag) = &line.nodes.drag else {
            return 0.0;
        };
        let rate = |i: usize| {
            let coefficient = drag.normal[i].max(drag.tangent[i]);
            let relative = self.velocity.get(FIRST + i) - self.water_velocity_of(FIRST + i);
            relative.norm() * coefficient / line.nodes.mass_normal[i]
        };
        (0..=self.segment_count).map(rate).fold(0.0, f64::max)
    }

    /// Index of the first node that has no finite position, or a speed that no mooring line reaches.
    pub fn broken_node(&self) -> Option<usize> {
        let broken = |i: &usize| {
            let (position, velocity) = (self.position.get(FIRST + i), self.velocity.get(FIRST + i));
            !position.iter().all(|value| value.is_finite())
                || !velocity.norm_squared().is_finite()
                || velocity.norm() > SPEED_MAX
        };
        (0..=self.segment_count).find(broken)
    }
}

/// [`Layout::drift`] for the vector unit of the machine.
struct Drift<'a>(&'a mut Layout, f64);

impl NullaryFnOnce for Drift<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.drift_nodes(self.1);
    }
}

fn padded_size(segment_count: usize) -> usize {
    FIRST + (segment_count + 1).div_ceil(LANES) * LANES + LANES
}

/// `values` from [`FIRST`] on, with `padding` around, for a line of `segment_count` segments.
pub(super) fn pad(segment_count: usize, values: &[f64], padding: f64) -> Vec<f64> {
    let mut padded = vec![padding; padded_size(segment_count)];
    padded[FIRST..FIRST + values.len()].copy_from_slice(values);
    padded
}

/// 1 for nodes between the ends, 0 elsewhere.
pub(super) fn interior(segment_count: usize) -> Vec<f64> {
    let mut interior = vec![1.0; segment_count + 1];
    (interior[0], interior[segment_count]) = (0.0, 0.0);
    pad(segment_count, &interior, 0.0)
}

/// Padding far away and apart: its chords are never zero.
fn padded_positions(size: usize) -> Components {
    let mut position = Components::zeros(size);
    position
        .x
        .iter_mut()
        .enumerate()
        .for_each(|(i, x)| *x = i as f64);
    position
}
