//! Motion of the water around a line, and the position of the water surface on it.

use nalgebra::Vector3;

use super::Layout;
use crate::dynamics::leapfrog::step::Step;
use crate::math::hermite::Hermite;
use crate::math::lanes::{Lanes, Vectors};
use crate::math::striping::{Column, Field, Slot, Striping};
use crate::model::{End, Line, Model, WaveSpan};
use crate::physics::airy::{Orbit, cubics};
use crate::physics::flow::{Profile, Stream};
use crate::physics::slender::Slender;

/// Sources of the motion of the water around a line.
#[derive(Debug, Clone, Copy)]
pub struct Water<'a> {
    /// Profile of the current; `None` without a current.
    pub profile: Option<&'a Profile>,
    /// True if waves act on the line.
    pub waves: bool,
}

impl<'a> Water<'a> {
    /// Sources around a line of a model.
    pub fn around(model: &'a Model, line: &Line) -> Water<'a> {
        Water {
            profile: model.current.as_ref().map(|current| &current.profile),
            waves: line.heaves(model),
        }
    }
}

/// Current at t_n.
#[derive(Debug, Clone)]
pub struct CurrentNow {
    pub profile: Profile,
    /// Factor on the velocity of the profile [-].
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

/// Wave kinematics over a time span, as polynomials in the elapsed fraction of the span.
#[derive(Debug, Clone)]
pub struct WaveArrays {
    /// Coefficients of the velocity [m/s].
    velocity: [Field; 4],
    /// Coefficients of the acceleration [m/s²].
    acceleration: [Field; 4],
    /// Mass in the Froude-Krylov force, across and along the line [kg].
    normal: Column,
    tangent: Column,
    /// Start and end of the span [s].
    times: [f64; 2],
    /// Elapsed fraction of the span at t_n [-].
    passed: f64,
    /// Surface elevation at the nodes [m] and its rate [m/s], at both ends of the span.
    surface: Vec<[[f64; 2]; 2]>,
}

impl WaveArrays {
    pub(super) fn new(line: &Line, striping: Striping) -> WaveArrays {
        let zeros = || Field::zeros(striping);
        let froude_krylov = line.nodes.froude_krylov.as_ref();
        let mass = |of: fn(&crate::model::FroudeKrylov) -> &Vec<f64>| {
            let values = froude_krylov.map_or(&[][..], |masses| of(masses));
            striping.column(values, 0.0)
        };
        WaveArrays {
            velocity: std::array::from_fn(|_| zeros()),
            acceleration: std::array::from_fn(|_| zeros()),
            normal: mass(|masses| &masses.normal),
            tangent: mass(|masses| &masses.tangent),
            times: [0.0; 2],
            passed: 0.0,
            surface: Vec::new(),
        }
    }

    /// Advances by a time [s].
    fn pass(&mut self, time: f64) {
        let [t0, t1] = self.times;
        if t1 > t0 {
            self.passed += time / (t1 - t0);
        }
    }

    /// Surface elevation at a node [m].
    fn elevation(&self, node: usize) -> f64 {
        let [[p0, m0], [p1, m1]] = self.surface[node];
        let [t0, t1] = self.times;
        if t1 <= t0 {
            return p0;
        }
        let cubic = Hermite::new((t0, p0, m0), (t1, p1, m1));
        cubic.at(t0 + self.passed * (t1 - t0)).value
    }

    /// Velocities of the water due to waves at the nodes at t_n [m/s].
    #[inline(always)]
    fn velocity(&self, at: usize) -> Vectors {
        polynomial(&self.velocity, self.passed, at)
    }

    /// Froude-Krylov forces on nodes with these tangents [N].
    #[inline(always)]
    pub fn froude_krylov(&self, at: usize, tangent: Vectors) -> Vectors {
        let acceleration = polynomial(&self.acceleration, self.passed, at);
        Slender::new([self.normal.load(at), self.tangent.load(at)]).times(acceleration, tangent)
    }

    /// Froude-Krylov force on a node with this tangent [N].
    pub fn froude_krylov_of(&self, at: Slot, tangent: Vector3<f64>) -> Vector3<f64> {
        let acceleration = self.value(&self.acceleration, at);
        Slender::new([self.normal[at], self.tangent[at]]).times(acceleration, tangent)
    }

    fn value(&self, powers: &[Field; 4], at: Slot) -> Vector3<f64> {
        let [p0, p1, p2, p3] = [0, 1, 2, 3].map(|power| powers[power].get(at));
        p0 + self.passed * (p1 + self.passed * (p2 + self.passed * p3))
    }
}

/// Velocities of the water [m/s] at the nodes of a row at heights `z` [m].
#[inline(always)]
pub(in crate::dynamics::leapfrog) fn water_flow(
    current: Option<&CurrentNow>,
    waves: Option<&WaveArrays>,
    at: usize,
    z: Lanes,
) -> Vectors {
    // closures would not be compiled for the vector unit of the kernel
    let mut flow = Vectors::zero();
    if let Some(current) = current {
        let shape = current.profile.velocities(z);
        flow = shape.scale(Lanes::splat(current.factor));
    }
    match waves {
        Some(waves) => flow + waves.velocity(at),
        None => flow,
    }
}

#[inline(always)]
fn polynomial(powers: &[Field; 4], passed: f64, at: usize) -> Vectors {
    let u = Lanes::splat(passed);
    let [p0, p1, p2, p3] = powers;
    p0.load(at) + (p1.load(at) + (p2.load(at) + p3.load(at).scale(u)).scale(u)).scale(u)
}

impl Layout {
    /// Finds the surface-piercing nodes at t_n, and sets their weight, Froude-Krylov mass and drag.
    pub fn find_surface(&mut self) {
        let Some(surface) = &mut self.surface else {
            return;
        };
        if let Some(waves) = &self.waves {
            surface.set_level(|node| waves.elevation(node));
            surface.find_calm(self.striping, &self.position);
        }
        surface.find(self.striping, &self.position);
        for i in surface.crossed() {
            let now = surface.node(i);
            let at = self.striping.slot(i);
            self.weight[at] = now.weight;
            if let Some(waves) = &mut self.waves {
                [waves.normal[at], waves.tangent[at]] = now.froude_krylov;
            }
            if let Some(drag) = &mut self.drag {
                [drag.normal[at], drag.tangent[at]] = now.drag;
            }
        }
    }

    /// Advances the waves to the end of a step.
    pub fn pass_waves(&mut self, step: Step) {
        if let (Some(_), Some(waves)) = (&self.surface, &mut self.waves) {
            waves.pass(step.drift);
        }
    }

    /// Adds the work of the difference in buoyancy between waves and still water over a step, except at prescribed ends, which `held` marks.
    pub fn balance_lift(&mut self, step: Step, held: [bool; 2]) {
        let (Some(surface), Some(_)) = (&mut self.surface, &self.waves) else {
            return;
        };
        let [first, last] = held.map(usize::from);
        for i in first..=self.segment_count - last {
            let at = self.striping.slot(i);
            let velocities = self.velocity.get(at).z + self.velocity_before.get(at).z;
            surface.lift(i, 0.5 * step.kick * velocities);
        }
    }

    /// Buoyancy that an end loses at t_n [N]; in waves, that which it would lose in still water.
    pub fn end_lack(&self, end: End) -> f64 {
        let node = self.end_node(end);
        let surface = self.surface.as_ref();
        surface.map_or(0.0, |surface| surface.lack(node, self.waves.is_some()))
    }

    /// Sets the factor of the current at t_n [-].
    pub fn set_current(&mut self, factor: f64) {
        if let Some(current) = &mut self.current {
            current.factor = factor;
        }
    }

    /// Returns whether the loaded waves are those of another time span.
    pub fn lacks_waves(&self, span: &WaveSpan) -> bool {
        let waves = self.waves.as_ref();
        waves.is_some_and(|waves| waves.times != span.times)
    }

    /// Loads the wave kinematics at the nodes over a time span.
    pub fn load_waves(&mut self, span: &WaveSpan) {
        let Some(waves) = &mut self.waves else {
            return;
        };
        waves.times = span.times;
        let [before, after] = &span.ends;
        waves.surface.clear();
        if self.surface.is_some() {
            let of = |orbit: &Orbit| [orbit.elevation, orbit.rise];
            let nodes = before.iter().zip(after);
            waves.surface.extend(nodes.map(|(b, a)| [of(b), of(a)]));
        }
        let nodes = before.iter().zip(after);
        for (at, (before, after)) in self.striping.slots().zip(nodes) {
            let [velocity, acceleration] = cubics(before, after, span.times);
            for power in 0..4 {
                waves.velocity[power].set(at, velocity[power]);
                waves.acceleration[power].set(at, acceleration[power]);
            }
        }
    }

    /// Sets the waves to those at time `t` [s].
    pub fn set_time(&mut self, t: f64) {
        if let Some(waves) = &mut self.waves {
            let [t0, t1] = waves.times;
            waves.passed = if t1 > t0 { (t - t0) / (t1 - t0) } else { 0.0 };
        }
    }

    /// Returns whether the water moves.
    pub fn flows(&self) -> bool {
        self.current.is_some() || self.waves.is_some()
    }

    /// Velocities of the water at the nodes [m/s].
    #[inline(always)]
    pub fn water_velocity(&self, at: usize) -> Vectors {
        let z = self.position.load(at).z;
        water_flow(self.current.as_ref(), self.waves.as_ref(), at, z)
    }

    /// Velocity of the water at a node [m/s].
    pub fn water_velocity_of(&self, at: Slot) -> Vector3<f64> {
        let flow = self.current.as_ref().map_or(Vector3::zeros(), |current| {
            current.stream().velocity(self.position.get(at).z)
        });
        match &self.waves {
            None => flow,
            Some(waves) => flow + waves.value(&waves.velocity, at),
        }
    }
}
