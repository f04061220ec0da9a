//! Free points in the assembled system.

use nalgebra::{Matrix3, Vector3};

use super::{StaticCase, Weights};
use crate::model::{FreePoint, Model, Network, Point, PointForces, PointState, Seabed};
use crate::physics::airy::Orbit;
use crate::physics::fading_damper::FadingContact;
use crate::physics::flow::Stream;

/// Workspace of a point, which is prescribed unless it has a slot.
#[derive(Debug, Clone, Default)]
pub(crate) struct PointWork {
    /// Index among the free points of its network.
    pub slot: Option<usize>,
    /// R of the point alone, without its lines [N].
    pub residual: Vector3<f64>,
    /// R with its lines [N]; zero along prescribed axes.
    pub total: Vector3<f64>,
    /// J of the point alone.
    pub diagonal: Matrix3<f64>,
    /// Solution of the linear system.
    pub solution: Vector3<f64>,
    /// State before a search for the equilibrium on catenaries.
    pub before: PointState,
    /// Position from which a step of that search begins [m].
    pub start: Vector3<f64>,
    /// Terms that the time integrator carries over from the last step [N].
    pub history: Vector3<f64>,
    /// Half the range of penetrations over which the point's seabed damper fades in [m].
    pub reach: f64,
    /// Friction of the seabed at the last assembly [N].
    pub rubbed: Vector3<f64>,
    /// Normal force that limits friction at rest [N].
    pub pressed: f64,
}
impl PointWork {
    /// Assembles residual and tangent of a point at rest, without its lines.
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
            force += free.drag_at_rest(z, stream);
            let by_height = sphere.drag_slope_with_height(at.wetted, past)
                - sphere.drag_slope(at.wetted, past) * stream.shear(z);
            self.diagonal
                .set_column(2, &(self.diagonal.column(2) + case.load * by_height));
        }
        self.residual = -case.load * force;
    }

    /// Adds a level seabed without friction under a point at rest at the height `z` [m].
    pub(super) fn add_seabed_at_rest(&mut self, free: &FreePoint, z: f64) {
        if let Some((stiffness, push)) = free.seabed_at_rest(z) {
            self.residual.z -= push;
            self.diagonal[(2, 2)] += stiffness;
        }
    }

    /// Assembles the residual and, if TANGENT, the tangent of a moving point under a `load` [N], without its lines.
    pub(super) fn assemble_dynamic<const TANGENT: bool>(
        &mut self,
        free: &FreePoint,
        seabed: Option<&Seabed>,
        state: &PointState,
        load: Vector3<f64>,
        water: (Option<Stream>, Option<Orbit>),
        weights: &Weights,
    ) {
        let (z, a) = (state.position.z, state.acceleration);
        let (v, stream) = (state.velocity, water.0);
        let PointForces {
            at,
            past,
            sum: mut force,
        } = free.forces(load, state, water);
        self.diagonal = Matrix3::from_diagonal_element(weights.acceleration * at.mass);
        if let (Some(sphere), true) = (&free.sphere, TANGENT) {
            let slope = sphere.drag_slope(at.wetted, past);
            self.diagonal += weights.velocity * slope;
            let mut by_height = sphere.drag_slope_with_height(at.wetted, past);
            by_height -= stream.map_or(Vector3::zeros(), |stream| slope * stream.shear(z));
            by_height.z += at.weight_slope;
            let by_height = weights.position * by_height + weights.inertia * at.mass_slope * a;
            self.diagonal
                .set_column(2, &(self.diagonal.column(2) + by_height));
        }
        if let (Some(contact), None) = (&free.contact, seabed)
            && let Some(seabed) = FadingContact::new(contact.coefficients, contact.level - z, v.z, self.reach)
        {
            force.z += seabed.force;
            if TANGENT {
                self.diagonal[(2, 2)] +=
                    weights.position * seabed.stiffness + weights.velocity * seabed.damping;
            }
        }
        self.residual = weights.inertia * at.mass * a - weights.force * force;
        if let Some(seabed) = seabed {
            self.add_seabed::<TANGENT>(free, seabed, state, weights);
        }
    }
}
/// Free points of a network with their indices, in the order of its system.
pub(crate) fn free_points<'a>(
    model: &'a Model,
    network: &'a Network,
) -> impl Iterator<Item = (usize, &'a FreePoint)> {
    let points = network.free_points.iter();
    points.filter_map(|&index| Some((index, model.points[index].free()?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::draft;
    use approx::assert_relative_eq;

    /// Buoy on a line, over a seabed and in a sheared current, which may pierce the surface and touch the seabed at
    /// once.
    fn model() -> Model {
        draft(
            "water = { density = 1025.0, current = { profile = [[1.0, 0.9, -0.4], [-3.0, 0.1, 0.3]], factor = 1.3 } }
            seabed = { depth = 1.0, stiffness = 2e4, damping = 900.0 }
            line_types.rope = { mass = 2.0, diameter = 0.05, axial_stiffness = 4e4 }",
        )
        .fixed("anchor", [0.0, 0.0, -1.0])
        .free("buoy", [0.3, 0.0, 0.2])
        .with("mass = 300.0, volume = 1.5, drag_area = 1.2, added_mass = 0.5")
        .line("rope", ["anchor", "buoy"], "rope", 3.0, 4)
        .model()
    }

    fn at(z: f64) -> PointState {
        let mut state = PointState::at_rest(Vector3::new(0.3, -0.1, z));
        state.velocity = Vector3::new(0.4, -1.1, -0.7);
        state.acceleration = Vector3::new(-0.6, 0.2, 1.3);
        state
    }

    /// Compares the columns of J with central differences of R as position, velocity and acceleration move together.
    fn assert_columns(
        residual: impl Fn(&PointState) -> (Vector3<f64>, Matrix3<f64>),
        state: &PointState,
        [by_position, by_velocity, by_acceleration]: [f64; 3],
    ) {
        let (_, tangent) = residual(state);
        let step = 1e-6;
        for axis in 0..3 {
            let moved = |h: f64| {
                let mut moved = *state;
                moved.position[axis] += by_position * h;
                moved.velocity[axis] += by_velocity * h;
                moved.acceleration[axis] += by_acceleration * h;
                residual(&moved).0
            };
            let slope = (moved(step) - moved(-step)) / (2.0 * step);
            let column = tangent.column(axis).into_owned();
            assert_relative_eq!(column, slope, epsilon = 1e-6 * tangent.amax());
        }
    }

    /// Heights of the buoy: deep, touching the seabed, half in the water, touching the surface from below and out of it; no kink nearby.
    const HEIGHTS: [f64; 5] = [-0.995, -0.9, 0.1, 0.6, 2.0];

    #[test]
    fn the_tangent_of_a_point_at_rest_is_the_slope_of_its_residual() {
        let model = model();
        let (point, free) = (&model.points[1], model.points[1].free().unwrap());
        assert!(free.contact.is_some());
        let case = StaticCase {
            load: 0.7,
            limit: 1.0,
            ..StaticCase::whole(0.0)
        };
        for z in HEIGHTS {
            let residual = |state: &PointState| {
                let mut work = PointWork::default();
                work.assemble_static(point, free, state, model.stream(0.0), &case);
                (work.residual, work.diagonal)
            };
            assert_columns(residual, &at(z), [1.0, 0.0, 0.0]);
        }
    }

    #[test]
    fn the_tangent_of_a_moving_point_is_the_slope_of_its_residual_alone_and_as_an_implicit_step_moves_it() {
        let model = model();
        let free = model.points[1].free().unwrap();
        let load = Vector3::new(30.0, -20.0, 10.0);
        for moves in [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 40.0, 900.0],
        ] {
            let weights = Weights {
                friction: 1.0,
                force: 0.8,
                inertia: 0.8,
                position: 0.8 * moves[0],
                velocity: 0.8 * moves[1],
                acceleration: 0.8 * moves[2],
                stretch: crate::elements::Stretch::Now,
                convex: false,
                span: 0.0,
            };
            for z in HEIGHTS {
                let residual = |state: &PointState| {
                    let mut work = PointWork {
                        reach: 0.05,
                        ..PointWork::default()
                    };
                    let stream = model.stream(0.0);
                    work.assemble_dynamic::<true>(free, None, state, load, (stream, None), &weights);
                    (work.residual, work.diagonal)
                };
                // where only the velocity changes, the terms that depend on height stay in J and must not be included
                let mut state = at(z);
                if moves[0] == 0.0 {
                    state.acceleration = Vector3::zeros();
                }
                assert_columns(residual, &state, moves);
            }
        }
    }
}
