//! A free point at the end of a beam over a step: mass, weight and buoyancy, drag, and contact with the seabed.
//!
//!   −w − B (1 − s̄)     weight w in water, buoyancy B of the submerged body, mean submergence s̄ along the path: the discrete
//!                      gradient of the potential, so that crossing the water surface conserves energy
//!   f(v̄, s)            drag at the mean velocity relative to the water, with the submergence s in the middle of the path
//!   F                  force of the seabed, as in `physics::contact_step`
//!
//! The mass over the step follows from the submergence at the extrapolated middle of the step.
//!
//! Source: as in `physics::point`; discrete gradients, Gonzalez (1996), J. Nonlinear Sci. 6, 449-467. Validity as in `physics::point`, in
//! water without waves.

use nalgebra::{Matrix3, Vector3};

use crate::dynamics::energy_balance::Flow;
use crate::model::FreePoint;
use crate::physics::contact_step::contact_step;
use crate::physics::fading_damper::damper_reach;

/// Body at a free end of a beam.
#[derive(Debug, Clone, Copy)]
pub struct Body<'a> {
    /// Free point.
    pub point: &'a FreePoint,
    /// Velocity of the water at the point over the step [m/s].
    pub water: Vector3<f64>,
}

/// Mean forces on a body over a step.
pub(super) struct BodyStep {
    /// Weight and buoyancy, positive upwards [N].
    lift: f64,
    /// Force of the water [N].
    drag: Vector3<f64>,
    /// Force of the seabed, positive upwards [N].
    push: f64,
    /// −∂f/∂φ₁ of all forces [N/m].
    pub(super) slope: Matrix3<f64>,
}

impl Body<'_> {
    /// Mean forces over a step of `length` [s] between two positions [m].
    pub(super) fn over(&self, [from, to]: [&Vector3<f64>; 2], length: f64) -> BodyStep {
        let mut step = BodyStep {
            lift: -self.point.weight,
            drag: Vector3::zeros(),
            push: 0.0,
            slope: Matrix3::zeros(),
        };
        if let Some(sphere) = &self.point.sphere {
            let way = sphere.wetted_between(from.z, to.z);
            step.lift -= sphere.buoyancy * (1.0 - way.part);
            step.slope[(2, 2)] -= sphere.buoyancy * way.slope;
            let middle = sphere.wetted(0.5 * (from.z + to.z));
            let velocity = (to - from) / length - self.water;
            step.drag = sphere.drag(middle, velocity);
            step.slope += sphere.drag_slope(middle, velocity) / length;
            let mut by_height = step.slope.column_mut(2);
            by_height += 0.5 * sphere.drag_slope_with_height(middle, velocity);
        }
        if let Some(contact) = &self.point.contact {
            let reach = damper_reach(contact.coefficients.stiffness, self.point.weight);
            let penetration = [from, to].map(|place| contact.level - place.z);
            let seabed = contact_step(contact.coefficients, penetration, reach, length);
            step.push = seabed.force;
            step.slope[(2, 2)] += seabed.slope;
        }
        step
    }

    /// Energy flow across the boundary of the body [J], for a displacement [m] over a step of `length` [s].
    pub(super) fn flow(&self, step: &BodyStep, moved: &Vector3<f64>, length: f64) -> Flow {
        let drift = length * self.water;
        Flow {
            external_work: step.drag.dot(&drift),
            dissipation: -step.drag.dot(&(moved - drift)) - step.push * moved.z,
            algorithmic_dissipation: 0.0,
        }
    }
}

impl BodyStep {
    pub(super) fn force(&self) -> Vector3<f64> {
        self.drag + (self.lift + self.push) * Vector3::z()
    }
}
