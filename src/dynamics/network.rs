//! A network of lines advanced by the explicit leapfrog: its lines, and the free points that join them.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::energy_balance::Flow;
use super::leapfrog::{EndLoad, LineWork, Placed};
use super::motion::AxisPath;
use super::step::Step;
use crate::elements::friction::point_stick;
use crate::model::{
    End, FreePoint, Kinematics, Model, Network, PointState, Role, State, WaveSpan, WaveSpans,
};
use crate::physics::airy::Orbit;
use crate::physics::friction::{Axes, Friction};

/// Scratch of a network: its lines laid out for the kernels, and its free points.
#[derive(Debug, Clone)]
pub struct NetworkWork {
    /// Lines, in the order of the network.
    pub lines: Vec<LineWork>,
    /// What holds the ends of the lines, and where that goes.
    ends: Vec<[LineEnd; 2]>,
    points: Vec<PointState>,
    /// Lines, by their place in the network, and ends at the free points.
    attached: Vec<Vec<(usize, End)>>,
    /// What waves do at the free points, where there are waves.
    waves: Vec<WaveSpan>,
    /// Springs of the bed under the point that is stepped.
    springs: Vec<Spring>,
    /// Flow of energy of the free points since the state was loaded.
    point_flow: Flow,
    /// Greatest ratio K |v| / M of the lines' nodes as they are held, where it is known [1/s].
    drag_rate: Option<f64>,
}

/// An end of a line.
#[derive(Debug, Clone, Copy)]
struct LineEnd {
    tie: Tie,
    /// Where the point is, or goes.
    placed: Placed,
}

/// What an end of a line is tied to.
#[derive(Debug, Clone, Copy)]
enum Tie {
    /// A point that never moves.
    Fixed,
    /// A point that is moved, by its number.
    Held(usize),
    /// A free point, by its place in the network.
    Free(usize),
}

impl LineEnd {
    fn new(model: &Model, network: &Network, point: usize) -> LineEnd {
        let free = network.free_points.iter().position(|&free| free == point);
        let tie = match (free, &model.points[point].role) {
            (Some(free), _) => Tie::Free(free),
            (None, Role::Fixed) => Tie::Fixed,
            (None, _) => Tie::Held(point),
        };
        let placed = Placed {
            position: model.points[point].reference,
            velocity: Vector3::zeros(),
        };
        LineEnd { tie, placed }
    }

    /// Finds where the point is at `t` [s], and its velocity half a step of `length` [s] earlier.
    #[inline]
    fn find(&mut self, points: &[PointState], t: f64, length: f64, held: &impl Fn(usize, f64) -> Kinematics) {
        self.placed = match self.tie {
            Tie::Fixed => return,
            Tie::Held(point) => {
                let k = held(point, t);
                Placed {
                    position: k.position,
                    velocity: k.velocity - 0.5 * length * k.acceleration,
                }
            }
            Tie::Free(free) => Placed {
                position: points[free].position,
                velocity: points[free].half_step[0],
            },
        };
    }
}

/// Spring and damper of the bed under a point: its own, or that of the half node of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spring {
    /// Stiffness [N/m].
    stiffness: f64,
    /// Stiffness times drift and damping [N s/m].
    resistance: f64,
    /// Force at no velocity [N].
    push: f64,
}

impl NetworkWork {
    /// Scratch for a network; `None` where a line mixes strain measures.
    pub fn new(model: &Model, network: &Network) -> Option<NetworkWork> {
        let lines = network
            .lines
            .iter()
            .map(|&line| {
                let held = model.lines[line]
                    .ends
                    .map(|point| model.points[point].free().is_none());
                LineWork::new(model, &model.lines[line], held)
            })
            .collect::<Option<Vec<LineWork>>>()?;
        let points = vec![PointState::at_rest(Vector3::zeros()); network.free_points.len()];
        let springs = network
            .free_points
            .iter()
            .map(|&point| model.points[point].attached.len() + 1)
            .max();
        let ends = |&line: &usize| {
            let points = model.lines[line].ends;
            points.map(|point| LineEnd::new(model, network, point))
        };
        Some(NetworkWork {
            lines,
            ends: network.lines.iter().map(ends).collect(),
            attached: network
                .free_points
                .iter()
                .map(|&point| attached(model, network, point))
                .collect(),
            points,
            waves: Vec::with_capacity(network.free_points.len()),
            springs: Vec::with_capacity(springs.unwrap_or(0)),
            point_flow: Flow::default(),
            drag_rate: None,
        })
    }

    /// Runs the kernels as they are compiled for any machine of the target, or for the best vectors of this one, as is the default.
    /// Results do not depend on it.
    pub fn set_portable(&mut self, portable: bool) {
        self.lines.iter_mut().for_each(|line| line.set_portable(portable));
    }

    /// Takes over the state.
    pub fn load(&mut self, network: &Network, state: &State) {
        self.drag_rate = None;
        for (work, &line) in self.lines.iter_mut().zip(&network.lines) {
            work.load(&state.lines[line]);
        }
        self.load_waves(network, state);
        self.load_points(network, state);
    }

    /// Goes on from the state that [`Self::store`] handed back last.
    pub fn resume(&mut self, network: &Network, state: &State) {
        if !self.lines.iter().all(LineWork::keeps_survey) {
            self.drag_rate = None;
        }
        for (work, &line) in self.lines.iter_mut().zip(&network.lines) {
            work.resume(&state.lines[line]);
        }
        if let Some(waves) = &state.waves {
            for (work, &line) in self.lines.iter_mut().zip(&network.lines) {
                let span = &waves.lines[line];
                if work.lacks_waves(span) {
                    work.load_waves(span);
                }
            }
            self.load_point_waves(network, waves);
        }
        self.load_points(network, state);
    }

    fn load_waves(&mut self, network: &Network, state: &State) {
        let Some(waves) = &state.waves else { return };
        for (work, &line) in self.lines.iter_mut().zip(&network.lines) {
            work.load_waves(&waves.lines[line]);
        }
        self.load_point_waves(network, waves);
    }

    fn load_point_waves(&mut self, network: &Network, waves: &WaveSpans) {
        self.waves
            .resize_with(network.free_points.len(), WaveSpan::default);
        for (own, &point) in self.waves.iter_mut().zip(&network.free_points) {
            own.clone_from(&waves.points[point]);
        }
    }

    fn load_points(&mut self, network: &Network, state: &State) {
        self.point_flow = Flow::default();
        for (point, &index) in self.points.iter_mut().zip(&network.free_points) {
            *point = state.points[index];
            if self.lines.is_empty() || state.lines[network.lines[0]].half_step.is_unset() {
                point.half_step = [point.velocity; 2];
            }
        }
    }

    /// Hands the state back after a step of size `steps[0]` [s], the one before being `steps[1]`.
    pub fn store(&self, network: &Network, state: &mut State, steps: [f64; 2]) {
        for (work, &line) in self.lines.iter().zip(&network.lines) {
            work.store(&mut state.lines[line], steps);
        }
        let extrapolation = Step::after(steps, steps[0]).extrapolation;
        for (point, &index) in self.points.iter().zip(&network.free_points) {
            let [last, before] = point.half_step;
            state.points[index] = PointState {
                velocity: last + extrapolation * (last - before),
                ..*point
            };
        }
    }

    /// How much stiffer than the limit of the step expects the stiffest segment is [-], at least 1.
    pub fn stiffening(&self) -> f64 {
        let lines = self.lines.iter().map(LineWork::stiffening);
        lines.fold(1.0, f64::max)
    }

    /// Greatest ratio K |v| / M of all nodes and free points at time `t` [s], v relative to the water [1/s].
    pub fn drag_rate(&self, model: &Model, network: &Network, t: f64) -> f64 {
        let of_lines = self.drag_rate.unwrap_or_else(|| {
            let surveys = self.lines.iter().map(LineWork::survey);
            surveys.fold(0.0, |rate: f64, line| rate.max(line.drag_rate))
        });
        let points = self.points.iter().zip(&network.free_points).enumerate();
        points
            .filter_map(|(free, (point, &index))| {
                let sphere = model.points[index].free()?.sphere?;
                let stream = model.stream(t);
                let mut past = point.half_step[0];
                past -= stream.map_or(Vector3::zeros(), |now| now.velocity(point.position.z));
                past -= self.waves_at(free, t).map_or(Vector3::zeros(), |w| w.velocity);
                let rate = sphere.drag * past.norm();
                (rate > 0.0).then(|| rate / tied_mass(model, index))
            })
            .fold(of_lines, f64::max)
    }

    /// Whether all nodes have finite positions and speeds such as mooring lines reach.
    pub fn is_sound(&mut self) -> bool {
        let (mut rate, mut is_sound) = (0.0_f64, true);
        for line in &self.lines {
            let survey = line.survey();
            rate = rate.max(survey.drag_rate);
            is_sound &= survey.is_sound;
        }
        self.drag_rate = Some(rate);
        is_sound
    }

    /// The first line, by its place in the network, and node whose position is not finite, or whose speed is one that no mooring line reaches;
    /// where there is none, the fastest node of the first line whose energy is not finite.
    pub fn broken_node(&self) -> (usize, usize) {
        let mut lines = self.lines.iter().enumerate();
        let broken = lines.find_map(|(line, work)| Some((line, work.broken_node()?)));
        broken.unwrap_or_else(|| {
            let mut lines = self.lines.iter();
            let grown = lines.position(|work| !work.flow().is_finite()).unwrap_or(0);
            (grown, self.lines[grown].fastest_node())
        })
    }

    /// One step from `t` [s]. `held` tells where held points are.
    pub fn step(
        &mut self,
        model: &Model,
        network: &Network,
        t: f64,
        step: Step,
        held: &impl Fn(usize, f64) -> Kinematics,
    ) {
        self.set_current(model, t);
        for (work, &line) in self.lines.iter_mut().zip(&network.lines) {
            if let Some(releases) = &model.lines[line].release {
                work.release_ends(releases, t, step);
            }
            work.pull();
            work.weigh_end_segment();
        }
        if !self.points.is_empty() {
            self.step_points(model, network, t, step);
        }
        let after = t + step.drift;
        for (work, ends) in self.lines.iter_mut().zip(&mut self.ends) {
            for end in ends.iter_mut() {
                end.find(&self.points, after, step.drift, held);
            }
            work.advance(after, step, [&ends[0].placed, &ends[1].placed]);
        }
    }

    /// Sets the paths of the winches, by the line they pay out, from `t` [s] on; after [`Self::put_ends`].
    pub fn start_winches(&mut self, network: &Network, state: &State, paths: &[AxisPath], step: Step) {
        for (work, &line) in self.lines.iter_mut().zip(&network.lines) {
            let fresh = state.lines[line].half_step.is_unset();
            work.start_winch(paths.get(line), state.time, fresh, step);
        }
    }

    /// Finds the nodes at the water's surface before the first step.
    pub fn begin(&mut self) {
        self.lines.iter_mut().for_each(LineWork::meet_surface);
    }

    /// Sets current and waves to those of `t` [s].
    #[inline]
    pub fn set_current(&mut self, model: &Model, t: f64) {
        if model.waves.is_some() {
            self.lines.iter_mut().for_each(|line| line.set_time(t));
        }
        if let Some(stream) = model.stream(t) {
            self.lines
                .iter_mut()
                .for_each(|line| line.set_current(stream.factor));
        }
    }

    /// Flow of energy since the state was loaded, the kinetic energy included in the dissipation; zero without a balance.
    pub fn flow(&self) -> Flow {
        let mut flow = self.point_flow;
        self.lines.iter().for_each(|line| flow.add(line.flow()));
        flow
    }

    /// Puts every line's ends where their points are at `t` [s], with velocities half of the last step [s] earlier, as those of the nodes are.
    pub fn put_ends(&mut self, t: f64, last: f64, held: &impl Fn(usize, f64) -> Kinematics) {
        for (work, ends) in self.lines.iter_mut().zip(&mut self.ends) {
            for end in ends.iter_mut() {
                end.find(&self.points, t, last, held);
            }
            work.put_ends([&ends[0].placed, &ends[1].placed]);
        }
    }

    /// As [`LineWork::set_out_anew`].
    pub fn set_out_anew(&mut self, last: f64) {
        let lines = self.lines.iter_mut();
        lines.for_each(|line| line.set_out_anew(last));
    }

    /// Motion of the water by waves at a free point, by its place in the network, at `t` [s].
    fn waves_at(&self, free: usize, t: f64) -> Option<Orbit> {
        self.waves.get(free).map(|waves| waves.at_point(t))
    }

    fn step_points(&mut self, model: &Model, network: &Network, t: f64, step: Step) {
        for (free, &index) in network.free_points.iter().enumerate() {
            let [last, before] = self.points[free].half_step;
            let now = last + step.extrapolation * (last - before);
            let point = &model.points[index];
            let Some(law) = point.free() else { continue };
            let height = self.points[free].position.z;
            let bed = Bed::under(model, self.points[free].position);
            let waves = self.waves_at(free, t);
            let mut load = load_in_water(model, index, law, [height, t], now, waves);
            self.springs.clear();
            self.springs.extend(Spring::new(load.contact, bed.height, step));
            for &(at, end) in &self.attached[free] {
                if self.lines[at].is_released(end) {
                    continue;
                }
                let brought = self.lines[at].end_load(end, now);
                load.add(&brought);
                self.springs
                    .extend(Spring::new(brought.contact, bed.height, step));
            }
            let kicked = load.kicked(last, law.axes, &self.springs, &bed, step);
            let Kicked { velocity, .. } = kicked;
            if model.energy_balance {
                let way = step.kick * 0.5 * (last + velocity);
                let by_water = load.froude_krylov.dot(&way) + step.kick * load.current_power;
                self.point_flow.external_work += point.load_at(t).dot(&way) + by_water;
                self.point_flow.dissipation +=
                    (load.force - load.resistance).dot(&way) + step.kick * load.current_power;
            }
            let state = &mut self.points[free];
            state.half_step = [velocity, last];
            state.acceleration = (velocity - last) / step.kick;
            state.position += step.drift * velocity;
            if state.anchor.is_some() {
                let held = kicked.friction / (step.kick * point_stick(law));
                state.anchor = Some(state.position + held);
            }
        }
    }
}

/// Lines, by their place in a network, and ends at a point of it.
fn attached(model: &Model, network: &Network, point: usize) -> Vec<(usize, End)> {
    let place = |&(line, end): &(usize, End)| {
        let place = network.lines.iter().position(|&l| l == line)?;
        Some((place, end))
    };
    model.points[point].attached.iter().filter_map(place).collect()
}

/// Weight, load and water of a free point at a height [m] and a time [s] that moves at `now` [m/s]. The difference between its buoyancy and that in
/// still water counts as Froude-Krylov force.
fn load_in_water(
    model: &Model,
    index: usize,
    law: &FreePoint,
    [height, t]: [f64; 2],
    now: Vector3<f64>,
    waves: Option<Orbit>,
) -> EndLoad {
    let point = &model.points[index];
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
    let drag = law.drag(at.wetted, now - water);
    EndLoad {
        force: point.load_at(t) - weight * Vector3::z() + drag + froude_krylov,
        resistance: drag,
        froude_krylov,
        current_power: drag.dot(&water),
        mass: at.mass * Matrix3::identity(),
        contact: law.contact.map_or([0.0; 3], |contact| {
            let k = contact.coefficients;
            let level = match model.bottom {
                Some(_) => contact.lift(),
                None => contact.level,
            };
            [k.stiffness, k.damping, k.stiffness * level]
        }),
    }
}

/// Mass of a free point and of the half nodes tied to it, at least [kg].
fn tied_mass(model: &Model, point: usize) -> f64 {
    let point = &model.points[point];
    let tied = point.attached.iter().map(|&(line, end)| {
        let line = &model.lines[line];
        let node = line.end_node(end);
        line.least_mass(node)
    });
    point.free().map_or(0.0, |free| free.mass) + tied.sum::<f64>()
}

impl Spring {
    /// The spring of stiffness, damping and force at no height under a point at `height` [m]; `None` where there is none.
    fn new([stiffness, damping, force_at_zero]: [f64; 3], height: f64, step: Step) -> Option<Spring> {
        (stiffness > 0.0).then_some(Spring {
            stiffness,
            resistance: stiffness * step.drift + damping,
            push: force_at_zero - stiffness * height,
        })
    }

    /// Whether the point would be in the bed after a step with the velocity ż [m/s].
    fn lands(&self, velocity: f64, step: Step) -> bool {
        self.push - self.stiffness * step.drift * velocity > 0.0
    }
}

impl EndLoad {
    fn add(&mut self, other: &EndLoad) {
        self.force += other.force;
        self.resistance += other.resistance;
        self.froude_krylov += other.froude_krylov;
        self.current_power += other.current_power;
        self.mass += other.mass;
    }

    /// v_{n+½} of a point that moves along `axes` only, and the impulse of the bed, which is implicit: friction is sought that agrees with
    /// the push of the springs, and a push that agrees with the friction.
    fn kicked(
        &self,
        last: Vector3<f64>,
        axes: [bool; 3],
        springs: &[Spring],
        bed: &Bed,
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
        let response = inverse * bed.normal.component_mul(&free);
        let mut push = pushed(velocity, response, springs, bed, step);
        let mut friction = zero;
        if let (Some(law), true) = (bed.friction, push > 0.0) {
            let sliding = Sliding::new(bed.normal, &inverse, &free);
            let scale = push;
            for _ in 0..ROUNDS_MAX {
                let before = push;
                friction += sliding.friction(velocity + response * push, friction, law.transverse * push);
                push = pushed(
                    velocity + inverse * friction.component_mul(&free),
                    response,
                    springs,
                    bed,
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

/// Rounds of push and friction on a point in a step.
const ROUNDS_MAX: usize = 50;

/// What a point leaves a step with.
struct Kicked {
    /// v_{n+½} [m/s].
    velocity: Vector3<f64>,
    /// Impulse of friction [N s].
    friction: Vector3<f64>,
}

/// The bed under a point.
struct Bed<'a> {
    /// Height of the point over z = 0; over a seabed with a slope, soundings or friction, over that along its normal [m].
    height: f64,
    /// Unit normal of the bed, upwards.
    normal: Vector3<f64>,
    friction: Option<&'a Friction>,
}

impl Bed<'_> {
    fn under(model: &Model, place: Vector3<f64>) -> Bed<'_> {
        match model.bottom.as_deref() {
            None => Bed {
                height: place.z,
                normal: Vector3::z(),
                friction: None,
            },
            Some(bottom) => {
                let touch = bottom.ground.touch(place);
                Bed {
                    height: -touch.penetration,
                    normal: touch.normal,
                    friction: bottom.friction.as_ref(),
                }
            }
        }
    }
}

/// Impulse of the springs on a point that would have the velocity `velocity` [m/s] without it. The sum of springs that
/// only push is convex in the velocity, so that Newton's method from above finds it in as many iterations as there are springs.
fn pushed(velocity: Vector3<f64>, response: Vector3<f64>, springs: &[Spring], bed: &Bed, step: Step) -> f64 {
    let (rise, yielding) = (bed.normal.dot(&velocity), bed.normal.dot(&response));
    let mut impulse = 0.0;
    for _ in 0..springs.len() {
        let rising = rise + yielding * impulse;
        let (mut push, mut resistance) = (0.0, 0.0);
        for spring in springs.iter().filter(|spring| spring.lands(rise, step)) {
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

/// How a point slides along the bed.
struct Sliding {
    /// Axes of the plane of the bed, along those of the point that are free.
    axes: [Vector3<f64>; 2],
    /// Inverse of what the point yields by in the plane [kg].
    mass: Matrix2<f64>,
}

impl Sliding {
    fn new(normal: Vector3<f64>, inverse: &Matrix3<f64>, free: &Vector3<f64>) -> Sliding {
        let Axes { along, across, .. } = Axes::new(normal, normal);
        let axes = [along, across];
        let mut yielding = Matrix2::from_fn(|i, j| axes[i].dot(&(inverse * axes[j].component_mul(free))));
        // A point on a rail yields along that alone: the rest is held, and must not be divided by.
        let least = 1e-12 * yielding.trace();
        yielding += Matrix2::from_diagonal_element(least);
        Sliding {
            axes,
            mass: yielding.try_inverse().unwrap_or_else(Matrix2::zeros),
        }
    }

    /// What must be added to the impulse `friction` so that the point stops, or the impulse is at its limit [N s]; `velocity` [m/s] is without any.
    fn friction(&self, velocity: Vector3<f64>, friction: Vector3<f64>, limit: f64) -> Vector3<f64> {
        let slides = Vector2::from_fn(|i, _| self.axes[i].dot(&velocity));
        let wanted = -self.mass * slides;
        let size = wanted.norm();
        let part = if size > limit { limit / size } else { 1.0 };
        part * (wanted.x * self.axes[0] + wanted.y * self.axes[1]) - friction
    }
}
