//! Free points in the assembled system.

use nalgebra::{Matrix3, Vector3};

use super::contact::SmoothContact;
use super::{StaticCase, Weights};
use crate::model::{Bottom, FreePoint, Model, Network, Point, PointState};
use crate::physics::flow::Stream;

/// Scratch of a point.
#[derive(Debug, Clone)]
pub(crate) struct PointWork {
    /// Index among the free points of its network.
    pub slot: Option<usize>,
    /// R of the point alone, without its lines [N].
    pub residual: Vector3<f64>,
    /// R with its lines [N]; zero along held axes.
    pub total: Vector3<f64>,
    /// J of the point alone.
    pub diagonal: Matrix3<f64>,
    /// Solution of the linear system.
    pub solution: Vector3<f64>,
    /// What the time integrator carries over from the last step [N].
    pub history: Vector3<f64>,
    /// Half the range of penetrations over which its seabed damper fades in [m].
    pub reach: f64,
    /// Friction of the bed at the last assembly [N].
    pub rubbed: Vector3<f64>,
}
impl PointWork {
    /// Scratch of a point that is held, until it gets a slot.
    pub(super) fn new() -> PointWork {
        PointWork {
            slot: None,
            residual: Vector3::zeros(),
            total: Vector3::zeros(),
            diagonal: Matrix3::zeros(),
            solution: Vector3::zeros(),
            history: Vector3::zeros(),
            reach: 0.0,
            rubbed: Vector3::zeros(),
        }
    }

    /// Residual and tangent of a point at rest, without its lines.
    pub(super) fn assemble_static(
        &mut self,
        point: &Point,
        free: &FreePoint,
        state: &PointState,
        stream: Option<Stream>,
        case: &StaticCase,
    ) {
        let (z, at) = (state.position.z, free.at(state.position.z));
        let mut force = point.load_at(case.time) - at.weight * Vector3::z();
        self.diagonal = Matrix3::from_diagonal_element(case.anchoring);
        self.diagonal[(2, 2)] += case.load * at.weight_slope;
        if let (Some(sphere), Some(stream)) = (&free.sphere, stream) {
            let past = -stream.velocity(z);
            force += sphere.drag(at.wetted, past);
            let by_height = sphere.drag_slope_with_height(at.wetted, past)
                - sphere.drag_slope(at.wetted, past) * stream.shear(z);
            self.diagonal
                .set_column(2, &(self.diagonal.column(2) + case.load * by_height));
        }
        self.residual = -case.load * force;
    }

    /// A level bed without friction under a point at rest at a height `z` [m].
    pub(super) fn add_bed_at_rest(&mut self, free: &FreePoint, z: f64) {
        if let Some((stiffness, push)) = free.bed_at_rest(z) {
            self.residual.z -= push;
            self.diagonal[(2, 2)] += stiffness;
        }
    }

    /// Residual and, if TANGENT, tangent of a moving point under a `load` [N], without its lines.
    pub(super) fn assemble_dynamic<const TANGENT: bool>(
        &mut self,
        free: &FreePoint,
        bottom: Option<&Bottom>,
        state: &PointState,
        load: Vector3<f64>,
        stream: Option<Stream>,
        weights: &Weights,
    ) {
        let (z, a) = (state.position.z, state.acceleration);
        let v = state.velocity;
        let past = v - stream.map_or(Vector3::zeros(), |stream| stream.velocity(z));
        let at = free.at(z);
        let mut force = load - at.weight * Vector3::z();
        self.diagonal = Matrix3::from_diagonal_element(weights.acceleration * at.mass);
        if let Some(sphere) = &free.sphere {
            force += sphere.drag(at.wetted, past);
            if TANGENT {
                let slope = sphere.drag_slope(at.wetted, past);
                self.diagonal += weights.velocity * slope;
                let mut by_height = sphere.drag_slope_with_height(at.wetted, past);
                by_height -= stream.map_or(Vector3::zeros(), |stream| slope * stream.shear(z));
                by_height.z += at.weight_slope;
                let by_height = weights.position * by_height + weights.inertia * at.mass_slope * a;
                self.diagonal
                    .set_column(2, &(self.diagonal.column(2) + by_height));
            }
        }
        if let (Some(contact), None) = (&free.contact, bottom)
            && let Some(bed) =
                SmoothContact::new(contact.coefficients, contact.level - z, v.z, self.reach)
        {
            force.z += bed.force;
            if TANGENT {
                self.diagonal[(2, 2)] +=
                    weights.position * bed.stiffness + weights.velocity * bed.damping;
            }
        }
        self.residual = weights.inertia * at.mass * a - weights.force * force;
        if let Some(bottom) = bottom {
            self.add_bottom::<TANGENT>(free, bottom, state, weights);
        }
    }
}
/// Visits the free points of a network.
pub(crate) fn for_free_points(
    model: &Model,
    network: &Network,
    mut visit: impl FnMut(usize, &FreePoint),
) {
    for &index in &network.free_points {
        if let Some(free) = model.points[index].free() {
            visit(index, free);
        }
    }
}
