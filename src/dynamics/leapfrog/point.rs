//! Free points of a network: loads, contact with the seabed, and their step with explicit tension.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::Kernel;
use super::explicit::{Explicit, ExplicitLine};
use super::network::LeapfrogNetwork;
use super::step::Step;
use crate::dynamics::limit::least_mass;
use crate::elements::friction::point_stick;
use crate::model::{End, FreePoint, Model, Network, Point, Seabed};
use crate::physics::airy::Orbit;
use crate::physics::friction::Axes;
use crate::physics::slender::Slender;

/// Loads and mass of a free point alone, or of the half node of a line tied to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointLoad {
    /// Force without contact [N].
    pub force: Vector3<f64>,
    /// Part of the force due to drag and damping [N].
    pub resistance: Vector3<f64>,
    /// Part of the force due to accelerated water [N].
    pub froude_krylov: Vector3<f64>,
    /// Power of the drag at the velocity of the water [W].
    pub current_power: f64,
    /// Decrease of that power with the change of velocity over the step [N].
    pub current_power_loss: Vector3<f64>,
    /// Mass matrix [kg], including the implicit part of the resistance.
    pub mass: Matrix3<f64>,
    /// Contact with the seabed; `None` if there is none.
    pub contact: Option<ContactSpring>,
}

/// Spring and damper of the seabed under a point alone, or under the half node of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSpring {
    /// Force at zero velocity [N].
    push: f64,
    /// Decrease of the force with the velocity at which the point leaves the seabed [N s/m].
    resistance: f64,
    /// Part of this decrease due to the displacement over the step [N s/m]; it determines whether the point lands.
    drift: f64,
}

impl<K: Kernel> LeapfrogNetwork<K> {
    /// Wave kinematics at a free point, by index in the network, at `t` [s].
    pub(super) fn waves_at(&self, free: usize, t: f64) -> Option<Orbit> {
        self.waves.get(free).map(|waves| waves.at_point(t))
    }

    /// Moves a free point, by index in the network, over a step from `t` [s] with its new velocity [m/s]; `load` and `friction` [N s] are those of the step.
    pub(super) fn move_point(
        &mut self,
        free: usize,
        model: &Model,
        load: &PointLoad,
        Kicked { velocity, friction }: Kicked,
        (t, step): (f64, Step),
    ) {
        let point = &model.points[self.point_numbers[free]];
        let state = &mut self.points[free];
        let last = state.half_step[0];
        if model.energy_balance {
            let way = step.kick * 0.5 * (last + velocity);
            let power = load.current_power - load.current_power_loss.dot(&(velocity - last));
            let by_water = load.froude_krylov.dot(&way) + step.kick * power;
            self.point_flow.external_work += load_over(point, t, step).dot(&way) + by_water;
            self.point_flow.dissipation += (load.force - load.resistance).dot(&way) + step.kick * power;
        }
        state.half_step = [velocity, last];
        state.acceleration = (velocity - last) / step.kick;
        state.position += step.drift * velocity;
        if let (Some(anchor), Some(law)) = (&mut state.anchor, point.free()) {
            *anchor = state.position + friction / (step.kick * point_stick(law));
        }
    }
}

impl LeapfrogNetwork<Explicit> {
    /// Largest ratio K |v| / M of all nodes and free points at time `t` [1/s], with v relative to the water.
    pub(super) fn drag_rate(&self, model: &Model, t: f64) -> f64 {
        let of_lines = self.lines.iter().map(ExplicitLine::drag_rate);
        let of_lines = of_lines.fold(0.0, f64::max);
        let points = self.points.iter().zip(&self.point_numbers).enumerate();
        points
            .filter_map(|(free, (point, &index))| {
                let sphere = model.points[index].free()?.sphere?;
                let stream = model.stream(t);
                let mut past = point.half_step[0];
                past -= stream.map_or(Vector3::zeros(), |now| now.velocity(point.position.z));
                past -= self.waves_at(free, t).map_or(Vector3::zeros(), |w| w.velocity);
                let rate = sphere.drag * past.norm();
                (rate > 0.0).then(|| rate / least_mass(model, index))
            })
            .fold(of_lines, f64::max)
    }

    /// Advances the free points over a step from `t` [s].
    pub(super) fn step_points(&mut self, model: &Model, t: f64, step: Step) {
        let mut springs = std::mem::take(&mut self.scratch);
        for free in 0..self.points.len() {
            let index = self.point_numbers[free];
            let [last, before] = self.points[free].half_step;
            let now = last + step.extrapolation * (last - before);
            let Some(law) = model.points[index].free() else {
                continue;
            };
            let height = self.points[free].position.z;
            let seabed = SeabedBelow::under(model, self.points[free].position);
            let waves = self.waves_at(free, t);
            let mut load = load_in_water((model, law), [height, t], now, waves, None);
            load.force += load_over(&model.points[index], t, step);
            springs.clear();
            springs.extend(ContactSpring::under_point(law, &seabed, step));
            for &(at, end) in &self.attached[free] {
                if self.lines[at].is_released(end) {
                    continue;
                }
                let share = self.lines[at].end_load(end, now);
                load.add(&share);
                springs.extend(share.contact);
            }
            let kicked = load.kicked(last, law.axes, &springs, &seabed, step);
            self.move_point(free, model, &load, kicked, (t, step));
        }
        self.scratch = springs;
    }
}

/// Lines, by index in the network, and their ends at a point.
pub(super) fn attached(model: &Model, network: &Network, point: usize) -> Vec<(usize, End)> {
    let place = |&(line, end): &(usize, End)| {
        let place = network.lines.iter().position(|&l| l == line)?;
        Some((place, end))
    };
    model.points[point].attached.iter().filter_map(place).collect()
}

/// Mean load on a point over the kick of a step from `t` [s], in [N], so that a short pulse is neither missed nor counted twice.
pub(super) fn load_over(point: &Point, t: f64, step: Step) -> Vector3<f64> {
    point.load_mean(t - step.lag(), t + 0.5 * step.drift)
}

/// Weight and water forces on a free point at a height [m] and a time [s], moving at a velocity [m/s]. If a step of `kick` [s] is given, the change
/// of the drag C|u|u over the step is implicit, with its slope C(|u| I + u uᵀ/|u|): trapezoidal, but limited where it exceeds inertia, so that it does not
/// reverse a velocity. The difference between the buoyancy and that in still water counts as Froude-Krylov force.
pub(super) fn load_in_water(
    (model, law): (&Model, &FreePoint),
    [height, t]: [f64; 2],
    velocity: Vector3<f64>,
    waves: Option<Orbit>,
    kick: Option<f64>,
) -> PointLoad {
    let surface = waves.map_or(0.0, |orbit| orbit.elevation);
    let at = law.at(height - surface);
    let stream = model.stream(t);
    let mut water = stream.map_or(Vector3::zeros(), |stream| stream.velocity(height));
    let (mut froude_krylov, mut weight) = (Vector3::zeros(), at.weight);
    if let Some(orbit) = &waves {
        water += orbit.velocity;
        weight = law.at(height).weight;
        froude_krylov = law.froude_krylov(at.wetted, orbit) + (weight - at.weight) * Vector3::z();
    }
    let past = velocity - water;
    let drag = law.drag(at.wetted, past);
    let mut implicit = Matrix3::zeros();
    if let (Some(kick), Some(along)) = (kick, past.try_normalize(0.0)) {
        let across = kick * drag.norm() / past.norm();
        let part = |impulse: f64| (0.5 * impulse).max(impulse - at.mass);
        implicit = Slender::new([part(across), part(2.0 * across)]).matrix(along);
    }
    PointLoad {
        force: drag - weight * Vector3::z() + froude_krylov,
        resistance: drag,
        froude_krylov,
        current_power: drag.dot(&water),
        current_power_loss: implicit * water / kick.unwrap_or(1.0),
        mass: at.mass * Matrix3::identity() + implicit,
        contact: None,
    }
}

impl ContactSpring {
    /// Spring and damper under a free point alone; `None` without a seabed spring.
    pub(super) fn under_point(law: &FreePoint, seabed: &SeabedBelow, step: Step) -> Option<ContactSpring> {
        let contact = law
            .contact
            .filter(|contact| contact.coefficients.stiffness > 0.0)?;
        let (k, level) = match seabed.seabed {
            Some(_) => (contact.coefficients, contact.lift()),
            None => (contact.coefficients, contact.level),
        };
        let drift = k.stiffness * step.drift;
        Some(ContactSpring {
            push: k.stiffness * (level - seabed.height),
            resistance: drift + k.damping,
            drift,
        })
    }

    /// Contact of the half node of a line over the step, from the force at zero velocity [N] and its decrease with velocity [N s/m]; `None` if there is none.
    pub fn of_line([push, resistance]: [f64; 2]) -> Option<ContactSpring> {
        (resistance > 0.0).then_some(ContactSpring {
            push,
            resistance,
            drift: resistance,
        })
    }

    /// Force at zero velocity [N], and its decrease with the velocity at which the point leaves the seabed [N s/m].
    pub fn law(&self) -> [f64; 2] {
        [self.push, self.resistance]
    }

    /// Force [N] on a point that leaves the seabed at `rise` [m/s]; `None` if the seabed does not push.
    pub fn pushes(&self, rise: f64) -> Option<f64> {
        let force = self.push - self.resistance * rise;
        (self.lands(rise) && force > 0.0).then_some(force)
    }

    /// Returns whether the point would be below the seabed after a step in which it leaves the seabed at `velocity` [m/s].
    fn lands(&self, velocity: f64) -> bool {
        self.push - self.drift * velocity > 0.0
    }
}

impl PointLoad {
    pub(super) fn none() -> PointLoad {
        let zero = Vector3::zeros();
        PointLoad {
            force: zero,
            resistance: zero,
            froude_krylov: zero,
            current_power: 0.0,
            current_power_loss: zero,
            mass: Matrix3::zeros(),
            contact: None,
        }
    }

    pub(super) fn add(&mut self, other: &PointLoad) {
        self.force += other.force;
        self.resistance += other.resistance;
        self.froude_krylov += other.froude_krylov;
        self.current_power += other.current_power;
        self.current_power_loss += other.current_power_loss;
        self.mass += other.mass;
    }

    /// Velocity v_{n+½} of a point that is free along `axes` only, and the impulse of friction. The impulse of the seabed is implicit: friction and
    /// the push of the springs are iterated to convergence.
    fn kicked(
        &self,
        last: Vector3<f64>,
        axes: [bool; 3],
        springs: &[ContactSpring],
        seabed: &SeabedBelow,
        step: Step,
    ) -> Kicked {
        let zero = Vector3::zeros();
        let free = Vector3::from(axes.map(|free| f64::from(u8::from(free))));
        let mut mass = self.mass.component_mul(&(free * free.transpose()));
        for axis in (0..3).filter(|&axis| !axes[axis]) {
            mass[(axis, axis)] = 1.0;
        }
        let Some(inverse) = mass.try_inverse() else {
            return Kicked {
                velocity: last,
                friction: zero,
            };
        };
        let velocity = last + step.kick * inverse * self.force.component_mul(&free);
        let response = inverse * seabed.normal.component_mul(&free);
        let mut push = pushed(velocity, response, springs, seabed, step);
        let mut friction = zero;
        if let (Some(law), true) = (
            seabed.seabed.and_then(|seabed| seabed.friction.as_ref()),
            push > 0.0,
        ) {
            let sliding = Sliding::new(seabed.normal, &inverse, &free);
            let scale = push;
            for _ in 0..ROUNDS_MAX {
                let before = push;
                friction += sliding.friction(velocity + response * push, friction, law.transverse * push);
                push = pushed(
                    velocity + inverse * friction.component_mul(&free),
                    response,
                    springs,
                    seabed,
                    step,
                );
                if (push - before).abs() <= 4.0 * f64::EPSILON * scale {
                    break;
                }
            }
        }
        Kicked {
            velocity: velocity + response * push + inverse * friction.component_mul(&free),
            friction,
        }
    }
}

/// Maximum number of iterations of push and friction on a point in a step.
const ROUNDS_MAX: usize = 50;

pub(super) struct Kicked {
    /// v_{n+½} [m/s].
    pub velocity: Vector3<f64>,
    /// Impulse of friction [N s].
    pub friction: Vector3<f64>,
}

pub(super) struct SeabedBelow<'a> {
    /// Height of the point above z = 0 [m]; for a seabed with a slope, soundings or friction, the height above it along its normal.
    pub height: f64,
    /// Unit normal of the seabed, positive upwards [-].
    pub normal: Vector3<f64>,
    /// Seabed with a slope, soundings or friction; `None` for a level plane without friction.
    pub seabed: Option<&'a Seabed>,
}

impl SeabedBelow<'_> {
    pub(super) fn under(model: &Model, place: Vector3<f64>) -> SeabedBelow<'_> {
        let seabed = model.seabed.as_deref();
        let (height, normal) = seabed.map_or((place.z, Vector3::z()), |seabed| {
            let (below, normal) = seabed.ground.stand(place);
            (-below, normal)
        });
        SeabedBelow {
            height,
            normal,
            seabed,
        }
    }
}

/// Impulse of the springs [N s] on a point whose velocity without this impulse is `velocity` [m/s]. The sum of springs that
/// only push is convex in the velocity, so that Newton's method from above converges in as many iterations as there are
/// springs.
fn pushed(
    velocity: Vector3<f64>,
    response: Vector3<f64>,
    springs: &[ContactSpring],
    seabed: &SeabedBelow,
    step: Step,
) -> f64 {
    let (rise, yielding) = (seabed.normal.dot(&velocity), seabed.normal.dot(&response));
    let mut impulse = 0.0;
    for _ in 0..springs.len() {
        let rising = rise + yielding * impulse;
        let (mut push, mut resistance) = (0.0, 0.0);
        for spring in springs.iter().filter(|spring| spring.lands(rise)) {
            let force = spring.push - spring.resistance * rising;
            if force > 0.0 {
                push += force;
                resistance += spring.resistance;
            }
        }
        let excess = step.kick * push - impulse;
        impulse += excess / (1.0 + yielding * step.kick * resistance);
    }
    impulse
}

/// Response of a point in the plane of the seabed.
pub(super) struct Sliding {
    /// Unit vectors that span the plane of the seabed [-].
    axes: [Vector3<f64>; 2],
    /// Inverse compliance of the point in the plane [kg].
    mass: Matrix2<f64>,
}

impl Sliding {
    pub(super) fn new(normal: Vector3<f64>, inverse: &Matrix3<f64>, free: &Vector3<f64>) -> Sliding {
        let Axes { along, across, .. } = Axes::unit(normal, normal);
        let axes = [along, across];
        let mut yielding = Matrix2::from_fn(|i, j| axes[i].dot(&(inverse * axes[j].component_mul(free))));
        // A point on a rail yields along the rail only: without an offset, the matrix would be singular.
        let least = 1e-12 * yielding.trace();
        yielding += Matrix2::from_diagonal_element(least);
        Sliding {
            axes,
            mass: yielding.try_inverse().unwrap_or_else(Matrix2::zeros),
        }
    }

    /// Change of the impulse `friction` that stops the point or brings the impulse to its `limit` [N s]; `velocity` [m/s] is that without friction.
    pub(super) fn friction(
        &self,
        velocity: Vector3<f64>,
        friction: Vector3<f64>,
        limit: f64,
    ) -> Vector3<f64> {
        let slides = Vector2::from_fn(|i, _| self.axes[i].dot(&velocity));
        let wanted = -self.mass * slides;
        let size = wanted.norm();
        let part = if size > limit { limit / size } else { 1.0 };
        part * (wanted.x * self.axes[0] + wanted.y * self.axes[1]) - friction
    }
}
