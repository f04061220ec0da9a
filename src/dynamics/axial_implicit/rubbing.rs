//! A bed that slopes or rubs, under the axial-implicit leapfrog.
//!
//! With what water and damping add to its mass folded into M, a node on the bed obeys M (v − u) = Δt pull + λ_n n + λ_t, u being where it
//! would go without tension and bed. It is in one of three states, which are assumed before the system in T̄ is solved and checked after:
//!
//! ```text
//! off       λ = 0                                    v = u + M⁻¹ Δt pull
//! slides    λ_t as the last pass found it            λ_n = Δt (k p + …) − b v_n eliminated by a rank-one update, as on a level bed
//! sticks    v = v_n n                                v_n = (n·M u + Δt (k p + …) + Δt n·pull)/(n·M n + b): of rank one itself
//! ```
//!
//! b = Δt (k Δt + c). After a pass every node on the bed takes the friction that Coulomb's law allows of what would stop it (`physics::friction`);
//! the step is repeated until states and friction hold. Frictionless beds slide with λ_t = 0.

use nalgebra::{Vector2, Vector3};

use super::AxialWork;
use crate::dynamics::leapfrog::Step;
use crate::math::fold::{Column, Field, Fold, Slot};
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

/// What a step knows of the bed under the nodes.
#[derive(Debug, Clone)]
pub(super) struct Rubbing {
    /// In the order of the nodes.
    mode: Vec<Mode>,
    /// Penetration p [m].
    penetration: Column,
    /// Normal n of the bed.
    normal: Field,
    /// a and b of the inverse mass off the bed [1/kg].
    across: Column,
    excess: Column,
    /// λ_t of nodes that slide [N s].
    rub: Field,
}

impl Rubbing {
    pub fn new(fold: Fold) -> Rubbing {
        let zeros = || Column::new(fold, 0.0);
        Rubbing {
            mode: vec![Mode::Off; fold.room()],
            penetration: zeros(),
            normal: Field::zeros(fold),
            across: zeros(),
            excess: zeros(),
            rub: Field::zeros(fold),
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
    /// Numbers of the nodes between the ends, and where they stand.
    fn inner_nodes(&self) -> impl Iterator<Item = (usize, Slot)> + use<> {
        let count = self.layout.segment_count;
        self.layout.nodes().enumerate().take(count).skip(1)
    }

    /// Finds out how the nodes stand to the bed, and what they are first taken to do there.
    pub(super) fn meet_bed(&mut self, step: Step) {
        for (i, at) in self.inner_nodes() {
            let (penetration, normal) = self.layout.stand(at);
            let velocity = self.layout.velocity.get(at);
            let Some(rubbing) = &mut self.rubbing else {
                return;
            };
            rubbing.mode[i] = Mode::Off;
            rubbing.penetration[at] = penetration;
            rubbing.normal.set(at, normal);
            rubbing.across[at] = self.nodes.across[at];
            rubbing.excess[at] = self.nodes.excess[at];
            rubbing.rub.set(at, Vector3::zeros());
            self.rest((i, at), velocity, step);
            self.settle_on((i, at), step);
        }
    }

    fn node(&self, at: Slot, step: Step) -> Option<Node> {
        let rubbing = self.rubbing.as_ref()?;
        let contact = self.layout.contact.as_ref()?;
        let (across, excess) = (rubbing.across[at], rubbing.excess[at]);
        let (mass, penetration) = (1.0 / across, rubbing.penetration[at]);
        // the damper acts below the bed only
        let landing = contact.damping[at] * penetration.min(0.0) / step.drift;
        Some(Node {
            tangent: self.nodes.tangent.get(at),
            normal: rubbing.normal.get(at),
            mass: [mass, 1.0 / (across + excess) - mass],
            inverse: [across, excess],
            spring: step.kick * (contact.stiffness[at] * penetration + landing),
            resistance: step.kick * (contact.stiffness[at] * step.drift + contact.damping[at]),
        })
    }

    /// Takes a node that moves at `velocity` [m/s] to do what the bed makes of it; whether that is what it was taken to do.
    fn rest(&mut self, (i, at): (usize, Slot), velocity: Vector3<f64>, step: Step) -> bool {
        let Some(node) = self.node(at, step) else {
            return true;
        };
        let needed = self.needed((i, at), &node, velocity, step);
        let friction = self
            .layout
            .rubbing()
            .and_then(|(_, friction)| friction)
            .copied();
        let Some(rubbing) = &mut self.rubbing else {
            return true;
        };
        let (mode, before) = (rubbing.mode[i], rubbing.rub.get(at));
        let rise = node.normal.dot(&velocity);
        let lands = rubbing.penetration[at] - step.drift * rise > 0.0;
        let push = node.spring - node.resistance * rise;
        if !lands || push <= 0.0 {
            rubbing.mode[i] = Mode::Off;
            return mode == Mode::Off;
        }
        let Some(friction) = friction else {
            rubbing.mode[i] = Mode::Slides;
            return mode == Mode::Slides;
        };
        let axes = Axes::new(node.normal, node.tangent);
        let along = node.mass[0] + node.mass[1] * axes.share * axes.share;
        let slides = axes.components(&velocity);
        let stops = slides.component_mul(&Vector2::new(along, node.mass[0]));
        let holding = axes.components(&needed) - stops;
        let compliance = Vector2::new(1.0 / along, 1.0 / node.mass[0]);
        let held = held(holding, compliance, friction.limits(&axes, push));
        let still = mode == Mode::Off && slides.norm() <= STILL;
        if held.multiplier.is_none() || still {
            rubbing.mode[i] = Mode::Sticks;
            return mode == Mode::Sticks;
        }
        let rub = axes.vector(&held.force);
        rubbing.mode[i] = Mode::Slides;
        rubbing.rub.set(at, rub);
        mode == Mode::Slides && (rub - before).norm() <= RUB_TOLERANCE * push
    }

    /// The friction [N s] that a node moved with, in the pass that gave it `velocity` [m/s].
    fn needed(
        &self,
        (i, at): (usize, Slot),
        node: &Node,
        velocity: Vector3<f64>,
        step: Step,
    ) -> Vector3<f64> {
        let Some(rubbing) = &self.rubbing else {
            return Vector3::zeros();
        };
        match rubbing.mode[i] {
            Mode::Off => Vector3::zeros(),
            Mode::Slides => rubbing.rub.get(at),
            Mode::Sticks => {
                let pull = |at: Slot| self.rows.tension[at] * self.segments.direction.get(at);
                let impulse = step.kick * (pull(at) - pull(at.before()));
                node.flat(node.mass_times(velocity - self.nodes.fall.get(at)) - impulse)
            }
        }
    }

    /// Puts the bed into the equation of a node.
    fn settle_on(&mut self, (i, at): (usize, Slot), step: Step) {
        let Some(node) = self.node(at, step) else {
            return;
        };
        let Some(rubbing) = &self.rubbing else {
            return;
        };
        let (mode, rub) = (rubbing.mode[i], rubbing.rub.get(at));
        let nodes = &mut self.nodes;
        let fall = nodes.fall.get(at);
        [nodes.across[at], nodes.excess[at]] = node.inverse;
        nodes.held[at] = 0.0;
        match mode {
            Mode::Off => nodes.loose.set(at, fall),
            Mode::Slides => {
                let response = node.inverse_times(node.normal);
                let fall = fall + node.inverse_times(rub);
                let share = 1.0 / (1.0 + node.resistance * node.normal.dot(&response));
                let push = (node.spring - node.resistance * node.normal.dot(&fall)) * share;
                nodes.held[at] = node.resistance * share;
                nodes.response.set(at, response);
                nodes.loose.set(at, fall + push * response);
            }
            Mode::Sticks => {
                let mass = node.normal.dot(&node.mass_times(node.normal)) + node.resistance;
                let momentum = node.normal.dot(&node.mass_times(fall)) + node.spring;
                (nodes.across[at], nodes.excess[at]) = (0.0, 0.0);
                nodes.held[at] = -1.0 / mass;
                nodes.response.set(at, node.normal);
                nodes.loose.set(at, momentum / mass * node.normal);
            }
        }
    }

    /// Compares what the nodes do with what they were taken to do; false if that asks for another pass.
    pub(super) fn check_bed(&mut self, step: Step) -> bool {
        let mut holds = true;
        for (i, at) in self.inner_nodes() {
            let velocity = self.layout.velocity_before.get(at);
            if !self.rest((i, at), velocity, step) {
                self.settle_on((i, at), step);
                holds = false;
            }
        }
        holds
    }

    /// Remembers the friction of the step.
    pub(super) fn keep_rub(&mut self, step: Step) {
        for (i, at) in self.inner_nodes() {
            let velocity = self.layout.velocity_before.get(at);
            let Some(node) = self.node(at, step) else {
                return;
            };
            let rub = self.needed((i, at), &node, velocity, step);
            self.layout.set_rub(at, rub / step.kick);
        }
    }
}
