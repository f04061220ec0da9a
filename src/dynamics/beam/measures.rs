//! Energy, momenta, reactions, curvature and moments of a beam at one time.

use nalgebra::Vector3;

use super::{beam_state, drag_of, node_mass};
use crate::dynamics::energy_balance::Energy;
use crate::model::{Beam, End, Line, LineState, Nodes, PointState};
use crate::physics::morison::drag;
use crate::physics::section::{Mixture, Pair, Section, StrainEnergy, StrainGradient, split, strain};

/// Linear and angular momentum of a beam.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Momentum {
    /// Linear momentum [N s].
    pub linear: Vector3<f64>,
    /// Angular momentum about the origin of the scene [N m s].
    pub angular: Vector3<f64>,
}

/// A beam and its state at one time.
#[derive(Debug, Clone, Copy)]
pub struct BeamView<'a> {
    /// Elements of the beam.
    pub beam: &'a Beam,
    /// Lumped properties of the nodes.
    pub nodes: &'a Nodes,
    /// State of the beam.
    pub shape: &'a LineState,
}

impl<'a> BeamView<'a> {
    /// Returns the view of a line; `None` if it is not a beam.
    pub fn of(line: &'a Line, shape: &'a LineState) -> Option<BeamView<'a>> {
        let beam = line.beam.as_ref()?;
        shape.beam.is_some().then_some(BeamView {
            beam,
            nodes: &line.nodes,
            shape,
        })
    }

    fn section(&self, i: usize) -> Section {
        Section {
            position: self.shape.position[i],
            frame: beam_state(self.shape).frames[i],
        }
    }

    /// Energy [J], without that of the prescribed unknowns at ends A and B, which `held` marks.
    pub fn energy(&self, held: [[bool; 6]; 2]) -> Energy {
        let state = beam_state(self.shape);
        let last = self.shape.position.len() - 1;
        let mut strained = StrainEnergy::default();
        let mut energy = Energy::default();
        for (i, element) in self.beam.elements.iter().enumerate() {
            let strain = element.strain(&self.section(i), &self.section(i + 1), &state.rest[i]);
            strained.add(element.energy(&strain));
        }
        (energy.axial, energy.bending) = (strained.axial, strained.bending);
        (energy.shear, energy.torsion) = (strained.shear, strained.torsion);
        for i in 0..=last {
            let held = match i {
                0 => held[0],
                i if i == last => held[1],
                _ => [false; 6],
            };
            let free = |axis: usize| f64::from(u8::from(!held[axis]));
            let velocity = self.shape.velocity[i];
            let velocity = velocity.component_mul(&Vector3::new(free(0), free(1), free(2)));
            let mass = node_mass(self.nodes, i, self.tangent(i));
            energy.kinetic += 0.5 * velocity.dot(&(mass * velocity));
            let spin = free(3) * state.spins[i];
            energy.kinetic += 0.5 * spin.dot(&self.beam.rotary_inertia[i].component_mul(&spin));
            energy.gravitational += free(2) * self.nodes.weight[i] * self.shape.position[i].z;
        }
        energy
    }

    /// Momenta of the mass in air and of rotary inertia.
    pub fn momentum(&self) -> Momentum {
        let state = beam_state(self.shape);
        let mut momentum = Momentum::default();
        for i in 0..self.shape.position.len() {
            let linear = self.nodes.mass[i] * self.shape.velocity[i];
            let spin = self.beam.rotary_inertia[i].component_mul(&state.spins[i]);
            momentum.linear += linear;
            momentum.angular += self.shape.position[i].cross(&linear) + state.frames[i] * spin;
        }
        momentum
    }

    /// Tangent d₃ of a node [-].
    fn tangent(&self, i: usize) -> Vector3<f64> {
        beam_state(self.shape).frames[i].column(2).into_owned()
    }

    /// Stress of an element conjugate to the uncorrected strains, with or without damping [N], [N m].
    fn stress(&self, i: usize, damped: bool) -> Pair<Vector3<f64>> {
        let (element, state) = (&self.beam.elements[i], beam_state(self.shape));
        let (a, b) = (self.section(i), self.section(i + 1));
        let now = strain(&a, &b, element.length);
        let still = Mixture {
            share: 1.0,
            rate: 0.0,
        };
        let strained = element.over_step([&now, &now], &state.rest[i], still);
        if !damped {
            return strained.stress();
        }
        let moving = [i, i + 1].map(|node| {
            let [velocity, spin] = self.rates(node);
            [velocity, state.frames[node] * spin]
        });
        let rate = StrainGradient::new(&(&a).into(), &(&b).into()).times(moving);
        strained.stress_at_rate(rate.map(|rate| rate / element.length))
    }

    /// Velocity [m/s] and angular velocity along the directors [rad/s] of a node, without the oscillation from step to step that dampers would
    /// amplify.
    fn rates(&self, node: usize) -> [Vector3<f64>; 2] {
        let state = beam_state(self.shape);
        let reached = state.course.reached(node);
        reached.map_or([self.shape.velocity[node], state.spins[node]], |rates| {
            split(&rates).into()
        })
    }

    /// Effective tension of an element [N]: the component along its chord of the force at its upper end.
    pub fn tension(&self, i: usize) -> f64 {
        let force = self.end_stress(i, 1, true).0;
        let chord = self.shape.position[i + 1] - self.shape.position[i];
        let along = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        force.dot(&along)
    }

    /// Force [N] and moment [N m] that balance the stress of an element at its lower (0) or upper (1) end.
    fn end_stress(&self, i: usize, side: usize, damped: bool) -> (Vector3<f64>, Vector3<f64>) {
        let gradient = StrainGradient::new(&(&self.section(i)).into(), &(&self.section(i + 1)).into());
        gradient.tr_times(self.stress(i, damped))[side].into()
    }

    /// Bending moment at a node [N m], from the elastic stress of the adjacent elements: the mean of both sides, which differ
    /// by the moment on the node.
    pub fn bending_moment(&self, node: usize) -> f64 {
        let last = self.beam.elements.len();
        let upper = (node < last).then(|| -self.end_stress(node, 0, false).1);
        let lower = (node > 0).then(|| self.end_stress(node - 1, 1, false).1);
        let moment = match (lower, upper) {
            (Some(lower), Some(upper)) => 0.5 * (lower + upper),
            (lower, upper) => lower.or(upper).unwrap_or_else(Vector3::zeros),
        };
        let tangent = self.tangent(node);
        (moment - moment.dot(&tangent) * tangent).norm()
    }

    /// Curvature at a node relative to the stress-free shape [1/m]: bending moment divided by bending stiffness, that of the softer side where it changes.
    pub fn curvature(&self, node: usize) -> f64 {
        let last = self.beam.elements.len() - 1;
        let adjacent = [node.saturating_sub(1), node.min(last)];
        let [before, after] = adjacent.map(|i| self.beam.elements[i].law.bending);
        self.bending_moment(node) * (1.0 / before.min(after))
    }

    /// Force [N] and moment [N m] of the beam on the point at one of its ends: those of the end element and the half node.
    pub fn end_action(&self, end: End, point: &PointState) -> (Vector3<f64>, Vector3<f64>) {
        let last = self.beam.elements.len();
        let (node, element, side) = match end {
            End::A => (0, 0, 0),
            End::B => (last, last - 1, 1),
        };
        let (pull, moment) = self.end_stress(element, side, true);
        let tangent = self.tangent(node);
        let mut force = -pull - node_mass(self.nodes, node, tangent) * point.acceleration;
        force.z -= self.nodes.weight[node];
        if let Some(k) = drag_of(self.nodes, node) {
            force += drag(k, point.velocity, tangent);
        }
        if let Some(damping) = &self.nodes.mass_damping {
            force -= damping[node] * point.velocity;
        }
        if let Some(contact) = &self.nodes.contact {
            let velocity = |i: usize| {
                if i == node {
                    point.velocity
                } else {
                    self.shape.velocity[i]
                }
            };
            force += contact.push(node, &self.shape.position, velocity);
        }
        (force, -moment)
    }
}
