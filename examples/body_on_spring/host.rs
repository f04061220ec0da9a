//! A body on a spring with a mooring line, and the masters that couple the two.
//!
//! The body of mass m hangs at the line's fairlead on a spring k with a moving foot. All masters step the body by the generalised-α method (Chung &
//! Hulbert 1993): with a, v and x at the end of a step h,
//!
//! x = x̃ + βh²a,   v = ṽ + γha,   m[(1−α_m) a + α_m a₀] = (1−α_f) f + α_f f₀.

use moorline::model::Body;
use moorline::scene::{ForceOutput, InterfaceOutput, Reconstruction, Scene};
use moorline::simulation::{EndMotion, Simulation};
use nalgebra::{Matrix3, Vector3};

/// Spectral radius of the body's integrator at infinite frequency [-].
const RADIUS: f64 = 0.8;
/// Maximum number of iterations of a step [-].
const ITERATIONS_MAX: usize = 100;
/// Displacement beyond which a run is unstable [m].
const LOST: f64 = 100.0;

/// Order in which body and mooring step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Master {
    /// Both at once, with the force and the motion of the last communication point.
    Jacobi,
    /// The body first, with the last force; the mooring then has the motion at the end of the step.
    BodyFirst,
    /// As `BodyFirst`, with the mass of the line end in the equation of the body.
    Mass,
    /// The body first, with the force of the coming step: mass, damping and stiffness of the line end in the equation of the body.
    Impedance,
    /// Repeated steps, each with the force of the previous one.
    FixedPoint,
    /// Repeated steps with the directional derivatives of the force.
    Newton,
}

/// Body, spring and steps.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Mass of the body [kg].
    pub mass: f64,
    /// Stiffness of the spring [N/m].
    pub spring: f64,
    /// Communication step [s].
    pub step: f64,
    /// Duration [s].
    pub duration: f64,
}

/// Displacements of the body [m] at all communication points, and the maximum number of iterations of a step [-].
pub type Run = (Vec<Vector3<f64>>, usize);

/// Motion of the spring's foot [m] at a time [s].
fn foot(t: f64) -> Vector3<f64> {
    let part = (t / 20.0).min(1.0);
    let ramp = part * part * (3.0 - 2.0 * part);
    let wave = |amplitude: f64, period: f64| ramp * amplitude * (std::f64::consts::TAU * t / period).sin();
    Vector3::new(wave(2.0, 10.0), 0.0, wave(1.0, 8.0))
}

/// Body and mooring with their master.
struct Host {
    simulation: Simulation,
    point: usize,
    case: Case,
    master: Master,
    /// Displacement, velocity and acceleration.
    motion: [Vector3<f64>; 3],
    /// Static force of the line, which the spring carries at rest [N].
    carried: Vector3<f64>,
    /// Forces on the body at the last communication point [N].
    before: Vector3<f64>,
}

/// Coefficients α_m, α_f, β, γ of the generalised-α method.
fn coefficients() -> [f64; 4] {
    let alpha_m = (2.0 * RADIUS - 1.0) / (RADIUS + 1.0);
    let alpha_f = RADIUS / (RADIUS + 1.0);
    let sum = 1.0 - alpha_m + alpha_f;
    [alpha_m, alpha_f, 0.25 * sum * sum, 0.5 - alpha_m + alpha_f]
}

/// Runs a scene with one coupled point, `point`. `None` if the run is unstable.
pub fn run(scene: &Scene, point: &str, master: Master, case: Case) -> Option<Run> {
    let mut scene = scene.clone();
    scene.solver.input_reconstruction = match master {
        Master::Jacobi => Reconstruction::Smooth,
        _ => Reconstruction::Interpolate,
    };
    match master {
        Master::Mass => scene.output.interface = Some(InterfaceOutput::Mass),
        Master::Impedance => scene.output.interface = Some(InterfaceOutput::Impedance),
        Master::Newton => scene.output.derivatives = true,
        _ => {}
    }
    if matches!(master, Master::Mass | Master::Impedance) {
        scene.output.force = ForceOutput::WithoutInertia;
    }
    scene.output.interval = case.step;
    let simulation = Simulation::new(&scene).ok()?;
    let point = simulation.model().point_index(point)?;
    let carried = force(&simulation, point);
    let mut host = Host {
        simulation,
        point,
        case,
        master,
        motion: [Vector3::zeros(); 3],
        carried,
        before: Vector3::zeros(),
    };
    let (mut path, mut most) = (vec![Vector3::zeros()], 0);
    for k in 0..(case.duration / case.step).round() as usize {
        most = most.max(host.step((k + 1) as f64 * case.step)?);
        path.push(host.motion[0]);
        if host.motion[0].norm() > LOST {
            return None;
        }
    }
    Some((path, most))
}

fn force(simulation: &Simulation, point: usize) -> Vector3<f64> {
    let &[x, y, z, ..] = simulation.host_force(Body::Point(point));
    Vector3::new(x, y, z)
}

fn top(matrix: &nalgebra::Matrix6<f64>) -> Matrix3<f64> {
    matrix.fixed_view::<3, 3>(0, 0).into()
}

impl Host {
    /// Steps body and mooring to a time [s]; returns the number of iterations.
    fn step(&mut self, time: f64) -> Option<usize> {
        let held = force(&self.simulation, self.point);
        let body = Body::Point(self.point);
        let zero = Matrix3::zeros();
        match self.master {
            Master::Jacobi => {
                let next = self.solve(time, held, [zero; 3]);
                self.give(self.motion);
                self.simulation.advance(self.case.step).ok()?;
                self.accept(time, next, force(&self.simulation, self.point));
            }
            Master::BodyFirst | Master::Mass => {
                let mass = match self.master {
                    Master::Mass => top(&self.simulation.end_mass(body)),
                    _ => zero,
                };
                let next = self.solve(time, held, [mass, zero, zero]);
                self.give(next);
                self.simulation.advance(self.case.step).ok()?;
                self.accept(time, next, force(&self.simulation, self.point));
            }
            Master::Impedance => {
                let mass = top(&self.simulation.end_mass(body));
                let coming = self.simulation.impedance(body)?;
                let free = coming.free.fixed_rows::<3>(0).into_owned();
                let matrices = [mass, top(&coming.damping), top(&coming.stiffness)];
                let next = self.solve(time, free, matrices);
                self.give(next);
                self.simulation.advance(self.case.step).ok()?;
                self.accept(time, next, force(&self.simulation, self.point));
            }
            Master::FixedPoint | Master::Newton => return self.iterate(time, held),
        }
        Some(1)
    }

    /// Motion at a time [s] under the force F − C v − K x − M a of the line.
    fn solve(
        &self,
        time: f64,
        force: Vector3<f64>,
        [mass, damping, stiffness]: [Matrix3<f64>; 3],
    ) -> [Vector3<f64>; 3] {
        let [alpha_m, alpha_f, beta, gamma] = coefficients();
        let (h, [x, v, a]) = (self.case.step, self.motion);
        let (x, v) = (x + h * v + h * h * (0.5 - beta) * a, v + h * (1.0 - gamma) * a);
        let mass = mass + Matrix3::identity() * self.case.mass;
        let stiffness = stiffness + Matrix3::identity() * self.case.spring;
        let outside = force + self.case.spring * foot(time) - self.carried;
        let matrix =
            (1.0 - alpha_m) * mass + (1.0 - alpha_f) * (h * gamma * damping + h * h * beta * stiffness);
        let load = (1.0 - alpha_f) * (outside - damping * v - stiffness * x) + alpha_f * self.before
            - alpha_m * (mass * a);
        let a = matrix.lu().solve(&load).unwrap_or_default();
        [x + beta * h * h * a, v + gamma * h * a, a]
    }

    /// Passes the motion of the body to the mooring.
    fn give(&mut self, [x, v, _]: [Vector3<f64>; 3]) {
        self.simulation.set_displacement(self.point, x.into());
        self.simulation
            .set_velocity(self.point, [Some(v.x), Some(v.y), Some(v.z)]);
    }

    /// Ends a step with a motion and the force of the line there [N].
    fn accept(&mut self, time: f64, next: [Vector3<f64>; 3], force: Vector3<f64>) {
        self.motion = next;
        self.before = force + self.case.spring * (foot(time) - next[0]) - self.carried;
    }

    fn iterate(&mut self, time: f64, mut force_now: Vector3<f64>) -> Option<usize> {
        let start = self.simulation.snapshot().clone();
        let body = Body::Point(self.point);
        let zero = Matrix3::zeros();
        let mut next = self.motion;
        let (mut free, mut slopes) = (force_now, [zero; 2]);
        for iteration in 1..=ITERATIONS_MAX {
            let [stiffness, damping] = slopes;
            let found = self.solve(time, free, [zero, damping, stiffness]);
            let change = (found[0] - next[0]).norm();
            next = found;
            self.simulation.restore(start.clone());
            self.give(next);
            self.simulation.advance(self.case.step).ok()?;
            force_now = force(&self.simulation, self.point);
            if iteration > 1 && change < 1e-6 {
                self.accept(time, next, force_now);
                return Some(iteration - 1);
            }
            free = force_now;
            if self.master == Master::Newton {
                for (slope, is_velocity) in slopes.iter_mut().zip([false, true]) {
                    for axis in 0..3 {
                        let motion = EndMotion {
                            body,
                            axis,
                            is_velocity,
                        };
                        let read = |s: &Simulation| Ok(s.host_force(body)[..3].to_vec());
                        let column = self.simulation.derivative(motion, read).ok()?;
                        slope.set_column(axis, &-Vector3::from_column_slice(&column));
                    }
                }
                free += slopes[0] * next[0] + slopes[1] * next[1];
            }
        }
        None
    }
}
