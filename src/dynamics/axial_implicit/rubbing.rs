//! A bed that slopes or rubs, under the axial-implicit leapfrog.
//!
//! With what water and damping add to its mass folded into M, a node on the bed obeys M (v − u) = Δt pull + λ_n n + λ_t, u being where it
//! would go without tension and bed. It is in one of three states, which are assumed before the system in T̄ is solved and checked after:
//!
//! ```text
//! off       λ = 0                                    v = u + M⁻¹ Δt pull
//! slides    λ_t as the last pass found it            λ_n = a − b v_n eliminated by a rank-one update, as on a level bed
//! sticks    v = v_n n                                v_n = (n·M u + a + Δt n·pull)/(n·M n + b): of rank one itself
//! ```
//!
//! a and b are those of [`super::bed`]. After a pass every node on the bed takes the friction that Coulomb's law allows of what would stop it (`physics::friction`);
//! the step is repeated until states and friction hold. Frictionless beds slide with λ_t = 0.

use nalgebra::{Vector2, Vector3};

use super::AxialWork;
use super::bed::Bed;
use crate::dynamics::step::Step;
use crate::math::lanes::Lanes;
use crate::physics::friction::{Axes, held};

/// Change of friction over the push of the bed that asks for another pass [-].
const RUB_TOLERANCE: f64 = 1e-4;
/// Speed below which a node is first taken to stick [m/s].
const STILL: f64 = 1e-9;

/// What a node does on the bed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Off,
    Slides,
    Sticks,
}

/// What a step knows of the bed under the nodes, by their numbers.
#[derive(Debug, Clone)]
pub(super) struct Rubbing {
    nodes: Vec<Stand>,
}

/// How a node stands to the bed.
#[derive(Debug, Clone, Copy)]
struct Stand {
    mode: Mode,
    /// The bed, alike in all lanes.
    bed: Bed,
    /// Normal n of the bed.
    normal: Vector3<f64>,
    /// a and b of the inverse mass off the bed [1/kg].
    inverse: [f64; 2],
    /// λ_t of nodes that slide [N s].
    rub: Vector3<f64>,
}

impl Rubbing {
    /// For a line of `count` nodes.
    pub fn new(count: usize) -> Rubbing {
        let stand = Stand {
            mode: Mode::Off,
            bed: Bed::none(),
            normal: Vector3::zeros(),
            inverse: [0.0; 2],
            rub: Vector3::zeros(),
        };
        Rubbing {
            nodes: vec![stand; count],
        }
    }
}

/// A node as its equation has it.
struct Node {
    tangent: Vector3<f64>,
    normal: Vector3<f64>,
    /// Mass across the line, and what there is more along it [kg].
    mass: [f64; 2],
    /// Inverse mass across the line, and what there is more along it [1/kg].
    inverse: [f64; 2],
    /// Impulse of the bed at no velocity [N s], and what it loses with velocity [kg].
    spring: f64,
    resistance: f64,
}

impl Node {
    fn mass_times(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.mass[0] * x + self.mass[1] * self.tangent.dot(&x) * self.tangent
    }

    fn inverse_times(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.inverse[0] * x + self.inverse[1] * self.tangent.dot(&x) * self.tangent
    }

    /// The part of a vector in the plane of the bed.
    fn flat(&self, x: Vector3<f64>) -> Vector3<f64> {
        x - self.normal.dot(&x) * self.normal
    }
}

impl AxialWork {
    /// Numbers of the nodes that nothing holds: those between the ends, and ends that have parted.
    fn loose_nodes(&self) -> std::ops::Range<usize> {
        let [a, b] = self.parted;
        usize::from(!a)..self.layout.segment_count + usize::from(b)
    }

    /// New velocity of a node [m/s].
    fn new_velocity(&self, i: usize) -> Vector3<f64> {
        self.layout.velocity_before.get(self.layout.slot(i))
    }

    /// Finds out how the nodes stand to the bed, and what they are first taken to do there.
    pub(super) fn meet_bed(&mut self, step: Step) {
        for i in self.loose_nodes() {
            let at = self.layout.slot(i);
            let (penetration, normal) = self.layout.stand(at);
            let velocity = self.layout.velocity.get(at);
            let (Some(rubbing), Some(contact)) = (&mut self.rubbing, &self.layout.contact) else {
                return;
            };
            let law = [contact.stiffness[at], contact.damping[at]];
            let row = &self.rows.nodes[at.row - 1];
            let [across, excess] = [row.across, row.excess].map(|part| part[at.lane]);
            let upright = normal.dot(&row.tangent.get(at.lane));
            let yields = across + excess * upright * upright;
            let [penetration, rise, yields] = [penetration, normal.dot(&velocity), yields].map(Lanes::splat);
            let law = law.map(Lanes::splat);
            rubbing.nodes[i] = Stand {
                mode: Mode::Off,
                bed: Bed::new(law, penetration, rise, yields, step),
                normal,
                inverse: [across, excess],
                rub: Vector3::zeros(),
            };
            self.rest(i, velocity, step);
            self.settle_on(i);
        }
    }

    fn node(&self, i: usize) -> Option<Node> {
        let stand = &self.rubbing.as_ref()?.nodes[i];
        let at = self.layout.slot(i);
        let [across, excess] = stand.inverse;
        let mass = 1.0 / across;
        Some(Node {
            tangent: self.rows.nodes[at.row - 1].tangent.get(at.lane),
            normal: stand.normal,
            mass: [mass, 1.0 / (across + excess) - mass],
            inverse: stand.inverse,
            spring: stand.bed.spring[0],
            resistance: stand.bed.resistance[0],
        })
    }

    /// Takes a node that moves at `velocity` [m/s] to do what the bed makes of it; whether that is what it was taken to do.
    fn rest(&mut self, i: usize, velocity: Vector3<f64>, step: Step) -> bool {
        let Some(node) = self.node(i) else {
            return true;
        };
        let needed = self.needed(i, &node, velocity, step);
        let friction = self.layout.rubbing().and_then(|(_, friction)| friction).copied();
        let Some(rubbing) = &mut self.rubbing else {
            return true;
        };
        let stand = &mut rubbing.nodes[i];
        let (mode, before) = (stand.mode, stand.rub);
        let rise = node.normal.dot(&velocity);
        let push = node.spring - node.resistance * rise;
        if stand.bed.pushes(Lanes::splat(rise))[0] <= 0.0 {
            stand.mode = Mode::Off;
            return mode == Mode::Off;
        }
        let Some(friction) = friction else {
            stand.mode = Mode::Slides;
            return mode == Mode::Slides;
        };
        let axes = Axes::new(node.normal, node.tangent);
        let along = node.mass[0] + node.mass[1] * axes.share * axes.share;
        let slides = axes.components(&velocity);
        let stops = slides.component_mul(&Vector2::new(along, node.mass[0]));
        let holding = axes.components(&needed) - stops;
        let compliance = Vector2::new(1.0 / along, 1.0 / node.mass[0]);
        let held = held(holding, compliance, friction.limits(axes.share, push).into());
        let still = mode == Mode::Off && slides.norm() <= STILL;
        if held.multiplier.is_none() || still {
            stand.mode = Mode::Sticks;
            return mode == Mode::Sticks;
        }
        let rub = axes.vector(&held.force);
        stand.mode = Mode::Slides;
        stand.rub = rub;
        mode == Mode::Slides && (rub - before).norm() <= RUB_TOLERANCE * push
    }

    /// What the segments beside a node pull it by [N].
    fn pull_on(&self, i: usize) -> Vector3<f64> {
        let pull = |segment: usize| self.rows.pull(self.layout.slot(segment));
        let before = i.checked_sub(1).map_or(Vector3::zeros(), pull);
        match i < self.layout.segment_count {
            true => pull(i) - before,
            false => -before,
        }
    }

    /// The friction [N s] that a node moved with, in the pass that gave it `velocity` [m/s].
    fn needed(&self, i: usize, node: &Node, velocity: Vector3<f64>, step: Step) -> Vector3<f64> {
        let Some(rubbing) = &self.rubbing else {
            return Vector3::zeros();
        };
        let stand = &rubbing.nodes[i];
        match stand.mode {
            Mode::Off => Vector3::zeros(),
            Mode::Slides => stand.rub,
            Mode::Sticks => {
                let at = self.layout.slot(i);
                let impulse = step.kick * self.pull_on(i);
                let fall = self.rows.nodes[at.row - 1].fall.get(at.lane);
                node.flat(node.mass_times(velocity - fall) - impulse)
            }
        }
    }

    /// Puts the bed into the equation of a node.
    fn settle_on(&mut self, i: usize) {
        let Some(node) = self.node(i) else {
            return;
        };
        let Some(rubbing) = &self.rubbing else {
            return;
        };
        let Stand { mode, rub, .. } = rubbing.nodes[i];
        let at = self.layout.slot(i);
        let (row, lane) = (&mut self.rows.nodes[at.row - 1], at.lane);
        let fall = row.fall.get(lane);
        (row.across[lane], row.excess[lane]) = node.inverse.into();
        row.held[lane] = 0.0;
        match mode {
            Mode::Off => row.loose.set(lane, fall),
            Mode::Slides => {
                let response = node.inverse_times(node.normal);
                let fall = fall + node.inverse_times(rub);
                let share = 1.0 / (1.0 + node.resistance * node.normal.dot(&response));
                let push = (node.spring - node.resistance * node.normal.dot(&fall)) * share;
                row.held[lane] = node.resistance * share;
                row.response.set(lane, response);
                row.loose.set(lane, fall + push * response);
            }
            Mode::Sticks => {
                let mass = node.normal.dot(&node.mass_times(node.normal)) + node.resistance;
                let momentum = node.normal.dot(&node.mass_times(fall)) + node.spring;
                (row.across[lane], row.excess[lane]) = (0.0, 0.0);
                row.held[lane] = -1.0 / mass;
                row.response.set(lane, node.normal);
                row.loose.set(lane, momentum / mass * node.normal);
            }
        }
    }

    /// Compares what the nodes do with what they were taken to do; false if that asks for another pass.
    pub(super) fn check_bed(&mut self, step: Step) -> bool {
        let mut holds = true;
        for i in self.loose_nodes() {
            let velocity = self.new_velocity(i);
            if !self.rest(i, velocity, step) {
                self.settle_on(i);
                holds = false;
            }
        }
        holds
    }

    /// Remembers the friction of the step.
    pub(super) fn keep_rub(&mut self, step: Step) {
        for i in self.loose_nodes() {
            let Some(node) = self.node(i) else {
                return;
            };
            let rub = self.needed(i, &node, self.new_velocity(i), step);
            self.layout.set_rub(self.layout.slot(i), rub / step.kick);
        }
    }
}
