//! Semi-explicit leapfrog of lumped two-node segments: the default for cables without bending.
//!
//! Positions live at t_n, velocities at t_{n−½}. A step is
//!
//! 1. segments: strain, lagged strain rate, tension T q;
//! 2. nodes: v_{n+½} = v_{n−½} + Δt M⁻¹ f, with drag at the extrapolated velocity 1.5 v_{n−½} − 0.5 v_{n−3/2}, the
//!    anisotropic mass inverted in closed form and the seabed solved implicitly, node by node, by a rank-one update;
//! 3. r_{n+1} = r_n + Δt v_{n+½}; held ends are put where their path says.
//!
//! One force evaluation a step, second order, stable below [`super::limit::explicit_step`] whatever the seabed.
//!
//! Source: Verlet's scheme as in Hairer, Lubich & Wanner (2003), Acta Numerica 12, 399-450; the inverse of
//! M_n I + (M_t − M_n) t tᵀ by Sherman & Morrison (1950); contact: backward Euler on the penetrating spring and damper.
//!
//! The line lies in a [`LineWork`]: padded arrays, four nodes to a vector. Padding has no inverse mass, no stiffness and
//! no weight, so that it stays at rest and no loop has a remainder.

use nalgebra::{Matrix3, Vector3};

use crate::math::lanes::{Components, LANES, Lanes, Vectors};
use crate::model::{End, Line, LineState};
use crate::physics::morison::{self, DragCoefficients};
use crate::physics::stretch::{StretchLaw, total_tension};

/// Index of node 0, and of segment 0, which lies between nodes 0 and 1.
const FIRST: usize = LANES;
/// Keeps coincident nodes from dividing by zero [m²].
const LENGTH2_MIN: f64 = 1e-200;

/// A line laid out for the kernels.
#[derive(Debug, Clone)]
pub struct LineWork {
    segment_count: usize,
    law: StretchLaw,
    negative_tension: bool,
    damped: bool,

    /// Node positions at t_n [m].
    position: Components,
    /// Velocities at t_{n−½} [m/s].
    velocity: Components,
    /// Velocities at t_{n−3/2} [m/s]; after a step, at t_{n−½}.
    velocity_before: Components,
    /// Force of a segment on its lower node, T q [N].
    pull: Components,
    /// Tensions T [N].
    tension: Vec<f64>,

    inverse_length: Vec<f64>,
    axial_stiffness: Vec<f64>,
    axial_damping: Vec<f64>,

    inverse_mass: Vec<f64>,
    weight: Vec<f64>,
    water: Option<WaterWork>,
    mass_damping: Option<Vec<f64>>,
    contact: Option<ContactWork>,
}

/// What needs a node's tangent: drag, and a mass that differs along and across the line.
#[derive(Debug, Clone)]
struct WaterWork {
    drag_normal: Vec<f64>,
    drag_tangent: Vec<f64>,
    /// 1/M_t − 1/M_n [1/kg].
    inverse_mass_excess: Vec<f64>,
}

impl WaterWork {
    /// K_n |u_n| u_n + K_t |u_t| u_t.
    #[inline(always)]
    fn drag(&self, at: usize, velocity: Vectors, tangent: Vectors) -> Vectors {
        let along = velocity.dot(tangent);
        let across = velocity - tangent.scale(along);
        let normal = Lanes::load(&self.drag_normal, at) * across.dot(across).sqrt();
        let tangential = Lanes::load(&self.drag_tangent, at) * along.abs() * along;
        across.scale(normal) + tangent.scale(tangential)
    }
}

#[derive(Debug, Clone)]
struct ContactWork {
    bed: f64,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

/// Sizes of a step.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Δt of the positions, t_n to t_{n+1} [s].
    pub drift: f64,
    /// Δt of the velocities, t_{n−½} to t_{n+½}: the mean of this step and the one before [s].
    pub kick: f64,
    /// Weight of v_{n−½} − v_{n−3/2} in the velocity extrapolated to t_n [-].
    pub extrapolation: f64,
}

impl Step {
    /// A step of `drift` [s] after steps of `last` and, before it, `earlier` [s]; 0 where there was none.
    pub fn after([last, earlier]: [f64; 2], drift: f64) -> Step {
        let extrapolation = if last > 0.0 && earlier > 0.0 {
            last / (last + earlier)
        } else {
            0.0
        };
        Step {
            drift,
            kick: 0.5 * (last + drift),
            extrapolation,
        }
    }
}

/// What an end of a line brings to the free point it is tied to.
#[derive(Debug, Clone, Copy)]
pub struct EndLoad {
    /// Force of the line on the point without contact [N].
    pub force: Vector3<f64>,
    /// Mass matrix of the half node [kg].
    pub mass: Matrix3<f64>,
    /// Contact stiffness [N/m] and damping [N s/m] of the half node.
    pub contact: [f64; 2],
}

impl LineWork {
    /// Arrays for a line; `None` where its sections have different strain measures, which the kernel does not mix.
    pub fn new(line: &Line, negative_tension: bool) -> Option<LineWork> {
        let n = line.segment_count();
        let size = FIRST + (n + 1).div_ceil(LANES) * LANES + LANES;
        let pad = |values: &[f64], map: &dyn Fn(f64) -> f64| {
            let mut padded = vec![0.0; size];
            padded[FIRST..FIRST + values.len()]
                .iter_mut()
                .zip(values)
                .for_each(|(p, v)| *p = map(*v));
            padded
        };
        let keep = |values: &[f64]| pad(values, &|value| value);
        let nodes = &line.nodes;
        let inverse_mass = pad(&nodes.mass_normal, &|mass| 1.0 / mass);
        let inverse_mass_along = pad(&nodes.mass_tangent, &|mass| 1.0 / mass);
        let excess: Vec<f64> = inverse_mass_along
            .iter()
            .zip(&inverse_mass)
            .map(|(t, n)| t - n)
            .collect();
        let wet = nodes.drag.is_some() || excess.iter().any(|excess| *excess != 0.0);
        let zeros = || vec![0.0; size];
        Some(LineWork {
            segment_count: n,
            law: line.uniform_law()?,
            negative_tension,
            damped: line
                .segments
                .axial_damping
                .iter()
                .any(|damping| *damping != 0.0),
            position: padded_positions(size),
            velocity: Components::zeros(size),
            velocity_before: Components::zeros(size),
            pull: Components::zeros(size),
            tension: vec![0.0; size],
            inverse_length: pad(&line.segments.length, &|length| 1.0 / length),
            axial_stiffness: keep(&line.segments.axial_stiffness),
            axial_damping: keep(&line.segments.axial_damping),
            inverse_mass,
            weight: keep(&nodes.weight),
            water: wet.then(|| WaterWork {
                drag_normal: nodes
                    .drag
                    .as_ref()
                    .map_or_else(zeros, |drag| keep(&drag.normal)),
                drag_tangent: nodes
                    .drag
                    .as_ref()
                    .map_or_else(zeros, |drag| keep(&drag.tangent)),
                inverse_mass_excess: excess,
            }),
            mass_damping: nodes.mass_damping.as_ref().map(|damping| keep(damping)),
            contact: nodes.contact.as_ref().map(|contact| ContactWork {
                bed: contact.bed,
                stiffness: keep(&contact.stiffness),
                damping: keep(&contact.damping),
            }),
        })
    }

    /// Takes over the state of a line.
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

    /// Hands the state back, with velocities extrapolated to the time of the positions.
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
    }

    /// Step 1: tensions from positions at t_n and velocities at t_{n−½}.
    pub fn pull_segments(&mut self) {
        match (self.law, self.damped) {
            (StretchLaw::Engineering, false) => self.segment_pass::<false>(|strain| strain),
            (StretchLaw::Engineering, true) => self.segment_pass::<true>(|strain| strain),
            (law, _) => self.segment_pass::<true>(|strain| strain.map(|e| law.at(e).force)),
        }
    }

    #[inline(always)]
    fn segment_pass<const DAMPED: bool>(&mut self, law: impl Fn(Lanes) -> Lanes) {
        let one = Lanes::splat(1.0);
        for at in (FIRST..FIRST + self.segment_count).step_by(LANES) {
            let d = self.position.load(at + 1) - self.position.load(at);
            let inverse_l = (d.dot(d) + Lanes::splat(LENGTH2_MIN)).sqrt().recip();
            let inverse_length = Lanes::load(&self.inverse_length, at);
            let strain = d.dot(d) * inverse_l * inverse_length - one;
            let elastic = Lanes::load(&self.axial_stiffness, at) * law(strain);
            let tension = if DAMPED {
                let rate = self.velocity.load(at + 1) - self.velocity.load(at);
                let strain_rate = d.dot(rate) * inverse_l * inverse_length;
                let damping = Lanes::load(&self.axial_damping, at) * strain_rate;
                if self.negative_tension {
                    elastic.positive() + damping
                } else {
                    (elastic + damping).positive()
                }
            } else {
                elastic.positive()
            };
            tension.store(&mut self.tension, at);
            self.pull.store(d.scale(tension * inverse_l), at);
        }
    }

    /// Step 2: velocities from t_{n−½} to t_{n+½}.
    pub fn kick_nodes(&mut self, step: Step) {
        match (
            self.water.is_some(),
            self.contact.is_some(),
            self.mass_damping.is_some(),
        ) {
            (false, false, false) => self.node_pass::<false, false, false>(step),
            (false, false, true) => self.node_pass::<false, false, true>(step),
            (false, true, false) => self.node_pass::<false, true, false>(step),
            (false, true, true) => self.node_pass::<false, true, true>(step),
            (true, false, false) => self.node_pass::<true, false, false>(step),
            (true, false, true) => self.node_pass::<true, false, true>(step),
            (true, true, false) => self.node_pass::<true, true, false>(step),
            (true, true, true) => self.node_pass::<true, true, true>(step),
        }
    }

    fn node_pass<const WATER: bool, const BED: bool, const MASS_DAMPING: bool>(
        &mut self,
        step: Step,
    ) {
        let kick = Lanes::splat(step.kick);
        for at in (FIRST..=FIRST + self.segment_count).step_by(LANES) {
            let velocity = self.velocity.load(at);
            let inverse_mass = Lanes::load(&self.inverse_mass, at);
            let mut force = self.pull.load(at) - self.pull.load(at - 1);
            force.z = force.z - Lanes::load(&self.weight, at);
            if MASS_DAMPING {
                let damping = self.mass_damping.as_deref().unwrap_or_default();
                force = force - velocity.scale(Lanes::load(damping, at));
            }
            // M⁻¹f, and M⁻¹ẑ for the bed
            let (inverted, response) = if WATER {
                let tangent = self.tangent(at);
                let before = self.velocity_before.load(at);
                let now = velocity + (velocity - before).scale(Lanes::splat(step.extrapolation));
                let water = self.water.as_ref().expect("this kernel runs in water");
                force = force - water.drag(at, now, tangent);
                let excess = Lanes::load(&water.inverse_mass_excess, at);
                let response = tangent.scale(excess * tangent.z);
                (
                    force.scale(inverse_mass) + tangent.scale(excess * force.dot(tangent)),
                    Vectors {
                        z: response.z + inverse_mass,
                        ..response
                    },
                )
            } else {
                let zero = Lanes::splat(0.0);
                (
                    force.scale(inverse_mass),
                    Vectors {
                        x: zero,
                        y: zero,
                        z: inverse_mass,
                    },
                )
            };
            let mut kicked = velocity + inverted.scale(kick);
            if BED {
                let impulse = self.contact_impulse(at, kicked.z, response.z, step);
                kicked = kicked + response.scale(impulse);
            }
            self.velocity_before.store(kicked, at); // v_{n−3/2} has been read
        }
        std::mem::swap(&mut self.velocity, &mut self.velocity_before);
    }

    /// Unit vectors along the chord of the neighbouring nodes.
    #[inline(always)]
    fn tangent(&self, at: usize) -> Vectors {
        let chord = self.position.load(at + 1) - self.position.load(at - 1);
        chord.scale(
            (chord.dot(chord) + Lanes::splat(LENGTH2_MIN))
                .sqrt()
                .recip(),
        )
    }

    /// Impulse Δt·F of the bed: F = k(p − Δt u') − c u' ≥ 0 with u' = u + Δt μ F, only if p − Δt u > 0.
    #[inline(always)]
    fn contact_impulse(
        &self,
        at: usize,
        velocity_z: Lanes,
        response_z: Lanes,
        step: Step,
    ) -> Lanes {
        let contact = self.contact.as_ref().expect("this kernel runs over a bed");
        let (drift, kick) = (Lanes::splat(step.drift), Lanes::splat(step.kick));
        let stiffness = Lanes::load(&contact.stiffness, at);
        let resistance = stiffness * drift + Lanes::load(&contact.damping, at); // b = kΔt + c
        let penetration = Lanes::splat(contact.bed) - Lanes::load(&self.position.z, at);
        let push = stiffness * penetration - resistance * velocity_z;
        let yielding = Lanes::splat(1.0) + response_z * kick * resistance;
        let lands = penetration - drift * velocity_z;
        (kick * push.positive() * yielding.recip()).where_positive(lands)
    }

    /// Step 3: positions from t_n to t_{n+1}.
    pub fn drift_nodes(&mut self, step: Step) {
        let drift = Lanes::splat(step.drift);
        for at in (FIRST..=FIRST + self.segment_count).step_by(LANES) {
            let position = self.position.load(at) + self.velocity.load(at).scale(drift);
            self.position.store(position, at);
        }
    }

    /// Puts an end at a position [m] with the velocity [m/s] that the next step takes as lagged.
    pub fn put_end(&mut self, end: End, position: Vector3<f64>, velocity: Vector3<f64>) {
        let at = self.end_index(end);
        self.position.set(at, position);
        self.velocity.set(at, velocity);
    }

    /// What the end brings to a free point, after [`Self::pull_segments`]; `velocity` [m/s] is the point's at t_n.
    pub fn end_load(&self, end: End, velocity: Vector3<f64>) -> EndLoad {
        let at = self.end_index(end);
        let (segment, other, sign) = match end {
            End::A => (at, at + 1, 1.0),
            End::B => (at - 1, at - 1, -1.0),
        };
        let chord = self.position.get(other) - self.position.get(at);
        let tangent = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let mut force = sign * self.pull.get(segment) - self.weight[at] * Vector3::z();
        let mut excess = 0.0;
        if let Some(water) = &self.water {
            let coefficients = DragCoefficients {
                normal: water.drag_normal[at],
                tangent: water.drag_tangent[at],
            };
            force += morison::drag(coefficients, velocity, tangent);
            excess = water.inverse_mass_excess[at];
        }
        if let Some(damping) = &self.mass_damping {
            force -= damping[at] * velocity;
        }
        let mass_normal = 1.0 / self.inverse_mass[at];
        let mass_tangent = 1.0 / (self.inverse_mass[at] + excess);
        let mass = mass_normal * Matrix3::identity()
            + (mass_tangent - mass_normal) * tangent * tangent.transpose();
        let contact = self
            .contact
            .as_ref()
            .map_or([0.0; 2], |c| [c.stiffness[at], c.damping[at]]);
        EndLoad {
            force,
            mass,
            contact,
        }
    }

    /// Greatest ratio K_n |v| / M_n of the nodes [1/s]: explicit drag wants Δt below its inverse.
    pub fn drag_rate(&self) -> f64 {
        let Some(water) = &self.water else {
            return 0.0;
        };
        let rate = |at: usize| {
            let drag = water.drag_normal[at].max(water.drag_tangent[at]);
            self.velocity.get(at).norm() * drag * self.inverse_mass[at]
        };
        (FIRST..=FIRST + self.segment_count)
            .map(rate)
            .fold(0.0, f64::max)
    }

    /// Index of the first node whose position or velocity is not finite.
    pub fn broken_node(&self) -> Option<usize> {
        (0..=self.segment_count).find(|i| {
            let sum = self.position.get(FIRST + i) + self.velocity.get(FIRST + i);
            !sum.iter().all(|value| value.is_finite())
        })
    }

    fn end_index(&self, end: End) -> usize {
        match end {
            End::A => FIRST,
            End::B => FIRST + self.segment_count,
        }
    }
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

/// Tension [N] of one segment from its end positions [m] and velocities [m/s]: the pointwise law of the kernel.
pub fn segment_tension(
    line: &Line,
    segment: usize,
    [low, high]: [Vector3<f64>; 2],
    [low_velocity, high_velocity]: [Vector3<f64>; 2],
    negative_tension: bool,
) -> f64 {
    let segments = &line.segments;
    let (chord, length) = (high - low, segments.length[segment]);
    let l = chord.norm();
    let elastic =
        segments.axial_stiffness[segment] * segments.law[segment].at(l / length - 1.0).force;
    let rate = if l > 0.0 {
        chord.dot(&(high_velocity - low_velocity)) / (l * length)
    } else {
        0.0
    };
    total_tension(
        elastic,
        segments.axial_damping[segment] * rate,
        negative_tension,
    )
}
