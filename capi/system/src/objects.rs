//! Bodies, points and rods, by their rows in the deck, counted from 0.

use moorline::model::{Body, Line, Model, PointState, Role};
use moorline::physics::slender::Slender;
use moorline::scene::AngleOrder;
use moorline::simulation::Simulation;
use moorline_decks::{BodyRow, Carrier, RodRow};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use crate::deck::Coupled;
use crate::failure::{Code, Failure, Outcome};
use crate::system::System;

/// Numbers of the kinds of motion, as in MoorDyn's interface.
pub mod kind {
    /// Moved by the host.
    pub const COUPLED: i32 = -1;
    /// Moved by forces.
    pub const FREE: i32 = 0;
    /// Fixed, or carried by a body.
    pub const FIXED: i32 = 1;
}

/// Pose and motion of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// Position [m] and Rx·Ry·Rz angles [rad].
    pub place: [f64; 6],
    /// Velocity [m/s] and angular velocity in global axes [rad/s].
    pub rate: [f64; 6],
}

/// Six-by-six mass matrix, row by row [kg, kg m, kg m²].
pub type BodyMass = [[f64; 6]; 6];

/// Returns the row of an object, or a refusal.
pub(crate) fn row<'a, T>(rows: &'a [T], index: usize, what: &str) -> Outcome<&'a T> {
    rows.get(index).ok_or_else(|| {
        let message = format!("there is no {what} {}: the deck has {}", index + 1, rows.len());
        Failure::new(Code::InvalidInput, message)
    })
}

impl System {
    /// Returns a body's row.
    ///
    /// # Errors
    /// No such body.
    pub fn body(&self, index: usize) -> Outcome<&BodyRow> {
        row(&self.deck.lists.bodies, index, "body")
    }

    /// Returns a rod's row.
    ///
    /// # Errors
    /// No such rod.
    pub fn rod(&self, index: usize) -> Outcome<&RodRow> {
        row(&self.deck.lists.rods, index, "rod")
    }

    /// Returns the number of a point in the deck.
    ///
    /// # Errors
    /// No such point.
    pub fn point_number(&self, index: usize) -> Outcome<usize> {
        row(&self.deck.lists.points, index, "point").copied()
    }

    /// Returns the index of a point in the scene.
    fn scene_point(&self, index: usize) -> Outcome<usize> {
        self.point_number(index)?;
        let missing = || {
            Failure::new(
                Code::Unhandled,
                format!("point {} is not in the scene", index + 1),
            )
        };
        self.deck.point(index).ok_or_else(missing)
    }

    /// Returns the kind of a body's motion.
    ///
    /// # Errors
    /// No such body.
    pub fn body_type(&self, index: usize) -> Outcome<i32> {
        Ok(match self.body(index)?.carrier {
            Carrier::Host => kind::COUPLED,
            Carrier::Free => kind::FREE,
            Carrier::Fixed | Carrier::Body(_) => kind::FIXED,
        })
    }

    /// Returns the pose and motion of a body as set by the host, extrapolated to the end of the last step; before the start, at rest as in the deck.
    ///
    /// # Errors
    /// No such body.
    pub fn body_state(&self, index: usize) -> Outcome<BodyState> {
        let body = self.body(index)?;
        let coupled = self
            .deck
            .coupled_body(index)
            .filter(|_| self.simulation.is_some());
        let Some(coupled) = coupled else {
            let ([x, y, z], [a, b, c]) = (body.position, body.angles);
            return Ok(BodyState {
                place: [x, y, z, a, b, c],
                rate: [0.0; 6],
            });
        };
        let part = |values: &[f64]| std::array::from_fn(|axis| values[coupled.first + axis]);
        Ok(BodyState {
            place: part(&self.motion[0]),
            rate: part(&self.motion[1]),
        })
    }

    /// Returns force [N] and moment [N m] about a coupled body's reference point.
    ///
    /// # Errors
    /// No such body, the body is not coupled, or the system was not started.
    pub fn body_force(&self, index: usize) -> Outcome<[f64; 6]> {
        self.body(index)?;
        let mut all = vec![0.0; self.deck.degrees_of_freedom()];
        self.forces(&mut all)?;
        let Some(coupled) = self.deck.coupled_body(index) else {
            return Err(Failure::missing(
                "the force on a fixed body is not found: read those of its points",
            ));
        };
        Ok(std::array::from_fn(|axis| all[coupled.first + axis]))
    }

    /// Returns the mass matrix of the end nodes on a coupled body, about its reference point. The body's own mass belongs to the host.
    ///
    /// # Errors
    /// As [`System::body_force`].
    pub fn body_mass(&self, index: usize) -> Outcome<BodyMass> {
        self.body(index)?;
        match self.deck.coupled_body(index) {
            Some(coupled) => self.carried_mass(coupled),
            None => Err(Failure::missing("a fixed body has no mass matrix")),
        }
    }

    /// Returns the mass matrix of the end nodes on a coupled body, about its reference point; zero for a point.
    pub(crate) fn carried_mass(&self, coupled: &Coupled) -> Outcome<BodyMass> {
        let mut sum = [[0.0; 6]; 6];
        for (mass, arm) in self.carried_nodes(coupled)? {
            add_mass(&mut sum, &mass, arm);
        }
        Ok(sum)
    }

    /// Returns −Σ m ω × (ω × r) of the end nodes on a coupled body that turns at ω [N].
    pub(crate) fn centrifugal_force(&self, coupled: &Coupled) -> Outcome<Vector3<f64>> {
        let turning = Vector3::from_row_slice(&self.motion[1][coupled.first + 3..coupled.first + 6]);
        let forces = self.carried_nodes(coupled)?;
        Ok(forces
            .map(|(mass, arm)| -mass * turning.cross(&turning.cross(&arm)))
            .sum())
    }

    /// Mass [kg] of the end nodes on every point of a coupled body, and its position relative to the body's reference point [m].
    fn carried_nodes(
        &self,
        coupled: &Coupled,
    ) -> Outcome<impl Iterator<Item = (Matrix3<f64>, Vector3<f64>)>> {
        let simulation = self.simulation()?;
        let (body, origin) = (
            coupled.body,
            Vector3::from_row_slice(&self.motion[0][coupled.first..][..3]),
        );
        let points = simulation.model().points.iter().enumerate();
        let carried = points.filter(move |(_, data)| match data.role {
            Role::Carried { vessel, .. } => Some(Body::Vessel(vessel)) == body,
            _ => false,
        });
        Ok(carried.map(move |(point, _)| {
            let at = simulation.state().points[point].position;
            (end_mass(simulation, point), at - origin)
        }))
    }

    /// Returns the kind of a point's motion; a point on a body counts as fixed.
    ///
    /// # Errors
    /// No such point.
    pub fn point_type(&self, index: usize) -> Outcome<i32> {
        let point = &self.deck.scene.points[self.scene_point(index)?];
        Ok(match (point.kind, &point.on) {
            (moorline::scene::PointKind::Free, _) => kind::FREE,
            (moorline::scene::PointKind::Coupled, None) => kind::COUPLED,
            _ => kind::FIXED,
        })
    }

    /// Returns the state of a point; before the start, at rest as in the deck.
    ///
    /// # Errors
    /// No such point.
    pub fn point_state(&self, index: usize) -> Outcome<PointState> {
        let point = self.scene_point(index)?;
        if let Some(simulation) = &self.simulation {
            return Ok(simulation.state().points[point]);
        }
        let scene = &self.deck.scene;
        let place = scene.reference_position(&scene.points[point]).unwrap_or_default();
        Ok(PointState::at_rest(place.into()))
    }

    /// Returns the force on a point from its lines and its own loads [N]. It excludes the inertia of nodes and point, unless the settings select
    /// reactions and the point is not free.
    ///
    /// # Errors
    /// No such point, or the system was not started.
    pub fn point_force(&self, index: usize) -> Outcome<[f64; 3]> {
        let (point, simulation) = (self.scene_point(index)?, self.simulation()?);
        Ok(match self.settings.force {
            crate::settings::Force::Nodal => simulation.nodal_force(point),
            crate::settings::Force::Reaction => simulation.end_force(point),
        })
    }

    /// Returns the mass matrix of a point and the end nodes of its lines, added mass included, row by row [kg].
    ///
    /// # Errors
    /// As [`System::point_force`].
    pub fn point_mass(&self, index: usize) -> Outcome<[[f64; 3]; 3]> {
        let point = self.scene_point(index)?;
        Ok(rows(&end_mass(self.simulation()?, point)))
    }

    /// Returns for each attachment of a point the line, by its order in the deck, and the end: 0 for A, 1 for B.
    ///
    /// # Errors
    /// No such point.
    pub fn point_attached(&self, index: usize) -> Outcome<Vec<(usize, i32)>> {
        let name = &self.deck.scene.points[self.scene_point(index)?].name;
        let mut found = Vec::new();
        for (line, data) in self.deck.scene.lines.iter().enumerate() {
            let ends = [&data.from, &data.to].into_iter().zip([0, 1]);
            found.extend(ends.filter(|(end, _)| *end == name).map(|(_, end)| (line, end)));
        }
        Ok(found)
    }

    /// Returns the position [m] and velocity [m/s] of a node of a rod, counted from 0 at end A.
    ///
    /// # Errors
    /// No such rod or node, or the system was not started.
    pub fn rod_node(&self, index: usize, node: usize) -> Outcome<[[f64; 3]; 2]> {
        let rod = self.rod(index)?;
        self.simulation()?;
        let count = rod.segments.max(1);
        if node > rod.segments {
            let message = format!(
                "rod {} has no node {node}: it has {} segments",
                rod.number, rod.segments
            );
            return Err(Failure::value(message));
        }
        let share = node as f64 / count as f64;
        let [a, b] = rod.ends.map(Vector3::from);
        let arm = a + share * (b - a);
        let Carrier::Body(number) = rod.carrier else {
            return Ok([arm.into(), [0.0; 3]]);
        };
        let body = self
            .deck
            .lists
            .bodies
            .iter()
            .position(|body| body.number == number);
        let state = self.body_state(body.unwrap_or(usize::MAX))?;
        let (place, rate) = (state.place, state.rate);
        let turned = rotation(&place) * arm;
        let spin = Vector3::from_row_slice(&rate[3..]);
        let position = Vector3::from_row_slice(&place[..3]) + turned;
        let velocity = Vector3::from_row_slice(&rate[..3]) + spin.cross(&turned);
        Ok([position.into(), velocity.into()])
    }
}

fn rotation(place: &[f64; 6]) -> UnitQuaternion<f64> {
    AngleOrder::Xyz.rotation(Vector3::from_row_slice(&place[3..]))
}

/// Rows of a matrix, in the same unit.
pub(crate) fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[(row, column)]))
}

/// Mass matrix of a point and the end nodes on it [kg].
fn end_mass(simulation: &Simulation, point: usize) -> Matrix3<f64> {
    let (model, state) = (simulation.model(), simulation.state());
    let data = &model.points[point];
    let height = state.points[point].position.z;
    let own = data.body().map_or(0.0, |own| own.at(height).mass);
    let attached = data.attached.iter();
    let ends = attached.filter(|(line, end)| !state.lines[*line].released[*end as usize]);
    let of_ends = ends.map(|&(line, end)| {
        let node = model.lines[line].end_node(end);
        node_mass(model, simulation, (line, node))
    });
    of_ends.fold(own * Matrix3::identity(), |sum, mass| sum + mass)
}

/// Mass matrix of a node of a line, added mass included [kg].
pub(crate) fn node_mass(
    model: &Model,
    simulation: &Simulation,
    (line, node): (usize, usize),
) -> Matrix3<f64> {
    let (data, shape) = (&model.lines[line], &simulation.state().lines[line]);
    let surface = data.surface.as_ref();
    let water = || model.water_along(simulation.state(), line, simulation.state().time);
    let dry = surface.map_or(0.0, |surface| {
        surface.node_in(water(), node, &shape.position).part
    });
    Slender::new(data.nodes.masses(node, dry)).matrix(tangent(data, &shape.position, node))
}

/// Unit tangent of a line at a node [-]: the mean direction of the adjacent segments.
pub(crate) fn tangent(line: &Line, position: &[Vector3<f64>], node: usize) -> Vector3<f64> {
    let direction = |segment: usize| {
        let chord = position[segment + 1] - position[segment];
        chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
    };
    let last = line.segment_count();
    let both = match node {
        0 => direction(0),
        node if node >= last => direction(last - 1),
        node => direction(node - 1) + direction(node),
    };
    both.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
}

/// Adds a mass matrix [kg] with a lever arm [m] to a matrix about another point.
fn add_mass(sum: &mut BodyMass, mass: &Matrix3<f64>, arm: Vector3<f64>) {
    let cross = arm.cross_matrix();
    let [coupling, turning] = [mass * cross.transpose(), cross * mass * cross.transpose()];
    for row in 0..3 {
        for column in 0..3 {
            sum[row][column] += mass[(row, column)];
            sum[row][column + 3] += coupling[(row, column)];
            sum[column + 3][row] += coupling[(row, column)];
            sum[row + 3][column + 3] += turning[(row, column)];
        }
    }
}
