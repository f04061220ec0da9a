//! Quantities for a host that solves for the motion of a body together with its mooring: mass of the mooring's ends, forces of the coming step, and
//! derivatives of the forces with respect to the motion at the end of a step.
//!
//! **Why explicit coupling needs a heavy body.** A host that steps a body of mass m with the force of the last communication point feeds this force
//! back one step h late. The force consists of −M a of the half segment at the end, −Z v of the waves that the end radiates into the line, with Z =
//! √(EA m_t) along it, and −K x of the geometry. The delayed inertia requires m > M at any h (added-mass instability: Causin, Gerbeau & Nobile
//! (2005), Comput. Methods Appl. Mech. Eng. 194, 4506-4527); the delayed damper requires m > ½Zh, since v₊ = v − (h/m) Z v₋ has a root outside the
//! unit circle above h Z/m = 1 to 2, depending on the lag. On the OC3 line M is 950 kg and Z 170 t/s: above h = 0.01 s the impedance governs, not the
//! mass of the end, and moving only M to the host's side gains little.
//!
//! **The force of the coming step** ([`Simulation::impedance`]). The force at the end of a step is a function of the known state of the line and of
//! the position x and velocity v that the line end reaches; the cubic to them is that of
//! [`Reconstruction::Interpolate`](crate::scene::Reconstruction).
//! To first order
//!
//! F(t+h) = F₀ − C v − K x − M a,   K = −∂F'/∂x,   C = −∂F'/∂v,   F' = F + M a,
//!
//! where F₀ is F' + C v + K x of a trial step from the present velocity with the mean acceleration of the last step. The neglected terms are of
//! second order in the distance between this prediction and the motion, O(h³), except for the part of the end load that depends on the acceleration
//! of the end ([`reaction`]), O(h). A host that moves M, C and K to its own side, (m + M) a + C v + K x = f + F₀ with the Newmark or generalised-α
//! relations between a, v and x, solves body and line together, as a Rosenbrock method solves a system. If its own integration is stable, this is
//! stable for any mass, without iterations or repeated steps. The resulting position is then given for the true step. Interface conditions of this
//! kind are Robin conditions (Badia, Nobile & Vergara (2008), J. Comput. Phys. 227, 7027-7051) and, where K is zero and C is Z, those of
//! transmission-line modelling (Krus, Jansson & Palmberg (1991), Simulation of fluid power transmission lines).
//!
//! The inertia is a separate term because the acceleration at the end of the cubic, (6(x₀ − x) + h(2v₀ + 4v))/h², differs from the host's: it
//! multiplies differences of positions by 6M/h².
//!
//! **Derivatives** ([`Simulation::derivative`]). The last step is repeated from the state at its start, with the end of the path at x ± δ or v ± δ/h,
//! and the central difference quotient is taken. Every integrator, contact, friction and the seabed are thus differentiated as they were computed:
//! the result is the exact derivative of the discrete step, except for O(δ²) and rounding over δ. δ is 1e-8 of the longest line. Rounding of
//! positions is 1e-8 of δ. δ is small compared with ah²/6, the displacement that changes the acceleration at the end of the cubic by the acceleration
//! a of the motion itself, beyond which the load of the last element is not linear. Where a node lands, slackens or slips within δ, derivatives are
//! averages of the one-sided derivatives. Each component of motion to differentiate with respect to costs a pair of steps; without any, nothing is
//! computed.
//!
//! Before the first step, the force is static, and its derivatives are differences of further static solutions.
//!
//! Source: derived here.

mod trial;

use std::cell::OnceCell;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::Simulation;
use super::prescribed::MotionSource;
use crate::model::{Body, End, Model, PointState};
use crate::scene::Integrator;
pub(super) use trial::StepStart;
pub(super) use trial::distance;
use trial::{Sides, Trial};

/// Interval between the samples from which time derivatives are computed, as a fraction of the step [-].
const PART: f64 = 1e-3;
/// Message for a vessel without derivatives.
const NO_RATES: &str = "the pitch of the vessel is 90 degrees, where roll and yaw have no unique rates";

/// Component of the motion at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EndMotion {
    /// The body that moves.
    pub body: Body,
    /// Axis: x, y, z and of a vessel roll, pitch, yaw (of a velocity: rotation about x, y, z), 0 to 5.
    pub axis: usize,
    /// True for a change of velocity at constant displacement, false for a change of displacement at constant velocity.
    pub is_velocity: bool,
}

/// Force of the mooring at the end of the coming step, F = free − damping·v − stiffness·x − mass·a.
///
/// x and v are displacement and velocity of the body as inputs, a its acceleration, with the angular acceleration of a vessel. A point
/// has the first three rows and columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Impedance {
    /// Force [N] and moment [N m] at x = v = a = 0.
    pub free: Vector6<f64>,
    /// Force [N/m, N] and moment [N, N m] per displacement.
    pub stiffness: Matrix6<f64>,
    /// Force [N s/m, N s] and moment [N s, N m s] per velocity.
    pub damping: Matrix6<f64>,
}

/// Mass and impedance of the bodies, each evaluated when it is first read.
#[derive(Debug, Clone)]
pub(super) struct InterfaceValues {
    masses: Vec<OnceCell<Matrix6<f64>>>,
    impedances: Vec<OnceCell<Option<Impedance>>>,
    stiffnesses: Vec<OnceCell<Option<[[f64; 6]; 6]>>>,
}

impl InterfaceValues {
    /// Allocates the values for the bodies of a model.
    pub(super) fn new(model: &Model) -> InterfaceValues {
        let bodies = model.bodies().count();
        InterfaceValues {
            masses: vec![OnceCell::new(); bodies],
            impedances: vec![OnceCell::new(); bodies],
            stiffnesses: vec![OnceCell::new(); model.vessels.len()],
        }
    }
}

impl Simulation {
    fn interface_values(&self) -> &InterfaceValues {
        let values = &self.reactions.interface;
        values.get_or_init(|| InterfaceValues::new(&self.model))
    }

    /// Force [N] and moment [N m] on a body, plus [`Simulation::end_mass`] times its acceleration.
    pub fn force_without_inertia(&self, body: Body) -> Vector6<f64> {
        let (model, snapshot) = (&*self.model, &self.snapshot);
        let acceleration = match body {
            Body::Point(point) => {
                let a = snapshot.state.points[point].acceleration;
                Vector6::new(a.x, a.y, a.z, 0.0, 0.0, 0.0)
            }
            Body::Vessel(vessel) => {
                let at = MotionSource::new(model, &snapshot.paths, snapshot.follows_scene);
                let frame = at.frame(vessel, snapshot.state.time);
                joined(frame.origin.acceleration, frame.attitude.spin_rate)
            }
        };
        Vector6::from(self.total_force(body)) + self.end_mass(body) * acceleration
    }

    /// Mass of the mooring's ends on a body, −∂F/∂a at the present positions and velocities: force [kg, kg m] and moment [kg m, kg m²] in rows,
    /// acceleration and angular acceleration in columns. It includes added mass and the bodies of points. Zero in quasi-static runs.
    pub fn end_mass(&self, body: Body) -> Matrix6<f64> {
        let mass = &self.interface_values().masses[self.snapshot.inputs.place(body)];
        *mass.get_or_init(|| self.evaluate_end_mass(body))
    }

    fn evaluate_end_mass(&self, body: Body) -> Matrix6<f64> {
        let (model, state) = (&*self.model, &self.snapshot.state);
        let mut sum = Matrix6::zeros();
        if model.solver.integrator == Integrator::QuasiStatic {
            return sum;
        }
        let origin = match body {
            Body::Point(point) => state.points[point].position,
            Body::Vessel(vessel) => self.vessel_origin(vessel),
        };
        for point in (0..model.points.len()).filter(|&point| model.moves_with(point, body)) {
            let mass = self.point_mass(point);
            let arm = (state.points[point].position - origin).cross_matrix();
            // a of the point is a + α × arm, the moment arm × F
            let by_spin = -mass * arm;
            let blocks = [[mass, by_spin], [arm * mass, arm * by_spin]];
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let mut block = sum.fixed_view_mut::<3, 3>(3 * i, 3 * j);
                block += blocks[i][j];
            }
        }
        if let Body::Point(_) = body {
            sum.fixed_view_mut::<3, 3>(3, 3).fill(0.0);
        }
        sum
    }

    /// Mass matrix of a point [kg]: the masses of the line ends attached to it and its own mass.
    fn point_mass(&self, point: usize) -> Matrix3<f64> {
        let at = self.snapshot.state.points[point];
        let of_line = |&(line, end): &(usize, End)| self.at_end(line, end, &at).mass();
        let of_lines: Matrix3<f64> = self.model.points[point].attached.iter().map(of_line).sum();
        let pushed = |acceleration| {
            self.own_force(point, |state| PointState {
                acceleration,
                ..state
            })
        };
        let still = pushed(Vector3::zeros());
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        of_lines + Matrix3::from_columns(&axes.map(|axis| still - pushed(axis)))
    }

    /// Force of the mooring on a body in the coming step. The step is taken as long as the last one; the first is as long as the scene's interval.
    /// `None` if the step fails or the attitude of a vessel has no unique rates.
    pub fn impedance(&self, body: Body) -> Option<&Impedance> {
        let impedance = &self.interface_values().impedances[self.snapshot.inputs.place(body)];
        impedance.get_or_init(|| self.evaluate_impedance(body)).as_ref()
    }

    fn evaluate_impedance(&self, body: Body) -> Option<Impedance> {
        let mut trial = Trial::of_coming_step(self)?;
        let force = |simulation: &Simulation| simulation.force_without_inertia(body);
        let mut slopes = [Matrix6::zeros(); 2];
        for (slope, is_velocity) in slopes.iter_mut().zip([false, true]) {
            for axis in 0..body.axes() {
                let motion = EndMotion {
                    body,
                    axis,
                    is_velocity,
                };
                let Sides { values, apart } = trial.both_sides(motion, force).ok()?;
                let [below, above] = values;
                slope.set_column(axis, &((below - above) / apart));
            }
        }
        let [stiffness, damping] = slopes;
        let [x, v] = trial.end_of(body);
        Some(Impedance {
            free: force(trial.run(trial.length).ok()?) + damping * v + stiffness * x,
            stiffness,
            damping,
        })
    }

    /// Returns [`Simulation::vessel_stiffness`], evaluated once in a state.
    pub fn static_stiffness(&self, vessel: usize) -> Option<&[[f64; 6]; 6]> {
        let stiffness = &self.interface_values().stiffnesses[vessel];
        stiffness.get_or_init(|| self.vessel_stiffness(vessel)).as_ref()
    }

    /// Returns the derivatives of the values that `read` returns with respect to a component of the motion at the end of the last step, from
    /// differences of repeated steps (see the module). Before the first step, these are the derivatives of the static values.
    ///
    /// # Errors
    /// A sentence with the reason.
    pub fn derivative(
        &self,
        motion: EndMotion,
        read: impl Fn(&Simulation) -> Result<Vec<f64>, String>,
    ) -> Result<Vec<f64>, String> {
        let Sides { values, apart } = match Trial::of_last_step(self)? {
            Some(mut trial) => trial.both_sides(motion, read)?,
            None if motion.is_velocity => return Ok(vec![0.0; read(self)?.len()]),
            None => trial::both_sides_of_statics(self, motion, read)?,
        };
        let [below, above] = values;
        let pairs = above?.into_iter().zip(below?);
        Ok(pairs.map(|(above, below)| (above - below) / apart).collect())
    }

    /// Returns the time derivatives of the values that `read` returns, at the end of the last step: the slope of the parabola through the values at
    /// the end and one and two thousandths of the step earlier, along the same path.
    ///
    /// # Errors
    /// As [`Simulation::derivative`].
    pub fn rates(&self, read: impl Fn(&Simulation) -> Result<Vec<f64>, String>) -> Result<Vec<f64>, String> {
        let last = read(self)?;
        let Some(mut trial) = Trial::of_last_step(self)? else {
            return Ok(vec![0.0; last.len()]);
        };
        let part = PART * trial.length;
        let mut before = |parts: f64| read(trial.run(trial.length - parts * part)?);
        let (first, second) = (before(1.0)?, before(2.0)?);
        let values = last.iter().zip(first.iter().zip(&second));
        Ok(values
            .map(|(a, (b, c))| (3.0 * a - 4.0 * b + c) / (2.0 * part))
            .collect())
    }
}

/// Joins two vectors into one of six components.
fn joined(first: Vector3<f64>, second: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(first.x, first.y, first.z, second.x, second.y, second.z)
}
