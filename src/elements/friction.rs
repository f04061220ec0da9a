//! Forces of a seabed with slope or friction on the nodes of lines and on free points, with their exact tangent.
//!
//! The spring and the damper act along the normal n of the seabed. Friction is a spring in the plane of the seabed, from the anchor a of a node, the
//! position of the node without friction, to the node itself. Its force is limited to the ellipse of Coulomb's law:
//!
//!   f* = k_t P (a − r),  P = I − n nᵀ,   f = the point of the ellipse of N closest to f*,   a ← r + f/k_t after every step.
//!
//! A node at rest therefore stays in place under any load inside the ellipse, at a distance f/k_t from its anchor. −∂f/∂r = k_t B S Bᵀ − B g ⊗ ∂N/∂r
//! with the axes B of the plane, the slope S of f with respect to f* and that with respect to N, g = (f − S f*)/N, since f is homogeneous in f* and
//! N.
//!
//! The tangent is exact on a plane, with the direction of the line frozen as for drag; on a curved seabed it leaves out the rotation of the axes.
//!
//! Source: the return mapping of Coulomb friction, Wriggers (2006), Computational Contact Mechanics, 2nd ed., chapter 5.

use nalgebra::{Matrix3, Vector3};

use super::contact::{Bearing, Stand};
use super::{LineWork, PointWork, StaticCase, Weights, node_tangent};
use crate::model::{Contact, FreePoint, Line, LineState, Model, Network, PointState, Seabed, State};
use crate::physics::fading_damper::FadingContact;
use crate::physics::friction::{Axes, Friction, node_friction};
use crate::physics::ground::Touch;

/// Fraction of the friction limit that statics uses [-]: nodes that slid to their positions of rest then stick in dynamics, and rounding does not
/// free them one by one.
pub(crate) const AT_REST: f64 = 1.0 - 1e-5;
/// Fraction of the friction limit at which nodes at [`AT_REST`] slide regardless of rounding [-].
pub(crate) const SLIDING: f64 = 1.0 - 1e-3;

/// Stiffness along the seabed of a sticking point, relative to its normal stiffness [-].
const POINT_STICK: f64 = 1e3;

/// Node or point on the seabed.
#[derive(Debug, Clone, Copy)]
pub struct Resting<'a> {
    /// Penetration and normal, relative to the level below which the seabed pushes.
    pub touch: Touch,
    /// Normal force with its slopes.
    pub bearing: Bearing,
    /// Normal of the seabed at the next node [-].
    pub normal_after: Vector3<f64>,
    /// Position [m].
    pub place: Vector3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Friction, if there is any.
    pub slip: Option<Slip<'a>>,
}

/// Friction of a node.
#[derive(Debug, Clone, Copy)]
pub struct Slip<'a> {
    /// Friction law.
    pub friction: &'a Friction,
    /// Direction of the line; any unit vector for a point.
    pub tangent: Vector3<f64>,
    /// Position of the node without friction [m].
    pub anchor: Vector3<f64>,
    /// k_t [N/m].
    pub stick: f64,
    /// Fraction of the friction limit in use [-].
    pub limit: f64,
    /// Constant normal force of the friction limit instead of the present one [N]: friction then has a convex potential.
    pub normal_force: Option<f64>,
}

/// Force of the seabed on a node, with its slopes.
#[derive(Debug, Clone, Copy)]
pub struct Push {
    /// Force [N].
    pub force: Vector3<f64>,
    /// Part of the force due to friction [N].
    pub friction: Vector3<f64>,
    /// Normal force [N].
    normal_force: f64,
    /// Minus the slopes of the normal contact force and of the friction with respect to position [N/m].
    stiffness: [Matrix3<f64>; 2],
    /// Minus their slopes with respect to velocity [N s/m].
    damping: [Matrix3<f64>; 2],
    /// Minus the slopes of the normal contact force with respect to position [N/m] and velocity [N s/m] of the next node.
    after: [Matrix3<f64>; 2],
}

impl<'a> Resting<'a> {
    /// Contact of node `i` of a line, given its bearing and the normal at the next node; at rest unless it `moves`.
    fn on(
        contact: &Contact,
        line: &'a Line,
        state: &LineState,
        i: usize,
        (bearing, normal_after): (Bearing, Vector3<f64>),
        moves: bool,
    ) -> Resting<'a> {
        let place = state.position[i];
        let friction = line.friction().zip(state.anchor.get(i));
        Resting {
            touch: contact.touch(i, place),
            bearing,
            normal_after,
            place,
            velocity: if moves {
                state.velocity[i]
            } else {
                Vector3::zeros()
            },
            slip: friction.map(|(friction, anchor)| Slip {
                friction,
                tangent: node_tangent(&state.position, i),
                anchor: *anchor,
                stick: contact.stick[i],
                limit: 1.0,
                normal_force: None,
            }),
        }
    }

    /// Contact with the fractions of stick stiffness and friction limit of a case, and the normal force `pressed` [N] if the case keeps it constant.
    fn at_rest(self, case: &StaticCase, pressed: f64) -> Resting<'a> {
        Resting {
            slip: self.slip.map(|slip| Slip {
                limit: case.limit,
                stick: case.stick * slip.stick,
                normal_force: case.keeps_pressure.then_some(pressed),
                ..slip
            }),
            ..self
        }
    }

    /// Returns the force of the seabed.
    pub fn push(&self) -> Push {
        let Touch {
            normal,
            slope,
            turning,
            ..
        } = self.touch;
        let seabed = self.bearing.seabed;
        let across = normal * self.normal_after.transpose();
        let by_place = seabed.stiffness * slope - seabed.damping * turning.transpose() * self.velocity;
        let by_velocity = -seabed.damping * normal;
        let mut push = Push {
            force: seabed.force * normal,
            friction: Vector3::zeros(),
            normal_force: seabed.force,
            stiffness: [
                -normal * by_place.transpose() - seabed.force * turning,
                Matrix3::zeros(),
            ],
            damping: [-normal * by_velocity.transpose(), Matrix3::zeros()],
            after: [self.bearing.stiffness_after, self.bearing.damping_after].map(|slope| slope * across),
        };
        if let Some(slip) = &self.slip {
            let axes = Axes::unit(normal, slip.tangent);
            let wanted = slip.stick * axes.components(&(slip.anchor - self.place));
            let normal_force = slip.normal_force.unwrap_or(seabed.force);
            let limits = slip.limit * slip.friction.limits(&axes, normal_force);
            let held = node_friction(wanted, [1.0, 1.0].into(), limits);
            let slope = held.slope(limits);
            let grows = match slip.normal_force {
                None => axes.vector(&(held.force - slope * wanted)) / seabed.force,
                Some(_) => Vector3::zeros(),
            };
            let [along, across] = [axes.along, axes.across];
            let sheared = along * (slope.m11 * along + slope.m12 * across).transpose()
                + across * (slope.m21 * along + slope.m22 * across).transpose();
            push.friction = axes.vector(&held.force);
            push.force += push.friction;
            push.stiffness[1] = slip.stick * sheared - grows * by_place.transpose();
            push.damping[1] = -grows * by_velocity.transpose();
        }
        push
    }
}

impl Push {
    fn weighted(&self, weights: &Weights) -> Vector3<f64> {
        weights.force * (self.force - self.friction) + weights.friction * self.friction
    }

    fn tangent(&self, weights: &Weights) -> Matrix3<f64> {
        let slope = |i: usize| weights.position * self.stiffness[i] + weights.velocity * self.damping[i];
        slope(0) + weights.friction / weights.force * slope(1)
    }

    /// Tangent with respect to the next node.
    fn tangent_after(&self, weights: &Weights) -> Matrix3<f64> {
        weights.position * self.after[0] + weights.velocity * self.after[1]
    }
}

/// Contact of a node of a line with the seabed. Dampers fade in over ± `reach` per segment [m]; without a `reach`, at rest, there are no dampers.
/// `None` where the seabed does not act.
pub fn resting_node<'a>(
    line: &'a Line,
    state: &LineState,
    i: usize,
    reach: Option<&[f64]>,
) -> Option<Resting<'a>> {
    let contact = line.nodes.contact.as_ref()?;
    let stand = |node: usize| Stand::new(contact, state, node, reach.is_some());
    let bearing = Bearing::new(contact, i, stand, |segment| {
        reach.map_or(0.0, |reach| reach[segment])
    })?;
    let after = stand((i + 1).min(state.position.len() - 1));
    Some(Resting::on(
        contact,
        line,
        state,
        i,
        (bearing, after.normal),
        reach.is_some(),
    ))
}

/// Contact of a free point with the seabed. Its damper fades in over ± `reach` [m]; without a `reach`, at rest, there is no damper. `None` where the
/// seabed does not act.
pub fn resting_point<'a>(
    free: &FreePoint,
    seabed: &'a Seabed,
    state: &PointState,
    reach: Option<f64>,
) -> Option<Resting<'a>> {
    let contact = free.contact.as_ref()?;
    let place = state.position;
    let friction = seabed.friction.as_ref().zip(state.anchor);
    let touch = seabed.touch(place, contact.lift());
    let velocity = reach.map_or(Vector3::zeros(), |_| state.velocity);
    let rise = touch.normal.dot(&velocity);
    let seabed = FadingContact::new(
        contact.coefficients,
        touch.penetration,
        rise,
        reach.unwrap_or(0.0),
    )?;
    Some(Resting {
        touch,
        bearing: Bearing {
            seabed,
            ..Bearing::default()
        },
        normal_after: touch.normal,
        place,
        velocity,
        slip: friction.map(|(friction, anchor)| Slip {
            friction,
            tangent: Vector3::z(), // for a point, every direction is across
            anchor,
            stick: POINT_STICK * contact.coefficients.stiffness,
            limit: 1.0,
            normal_force: None,
        }),
    })
}

/// Stiffness along the seabed of a sticking free point [N/m].
pub fn point_stick(free: &FreePoint) -> f64 {
    free.contact
        .map_or(0.0, |contact| POINT_STICK * contact.coefficients.stiffness)
}

impl LineWork {
    /// Adds the springs and the friction of the seabed under a line at rest.
    pub(super) fn add_contact_at_rest(&mut self, line: &Line, state: &LineState, case: &StaticCase) {
        let Some(contact) = &line.nodes.contact else {
            return;
        };
        self.find_bearings(contact, state, false);
        for i in 0..state.position.len() {
            let pressed = self.pressed.get(i).copied().unwrap_or(0.0);
            let push = self.resting(contact, line, state, i, false);
            let push = push.map(|resting| resting.at_rest(case, pressed).push());
            if let (Some(pressed), false) = (self.pressed.get_mut(i), case.keeps_pressure) {
                *pressed = push.map_or(0.0, |push| push.normal_force);
            }
            self.keep_friction(i, push.as_ref());
            let Some(push) = push else { continue };
            self.residual[i] -= push.force;
            self.diagonal[i] += push.stiffness[0] + push.stiffness[1];
            if let Some(coupling) = self.coupling.get_mut(i) {
                *coupling += push.after[0];
            }
        }
    }

    /// Adds the seabed under a moving line.
    pub(super) fn add_contact<const TANGENT: bool>(
        &mut self,
        line: &Line,
        state: &LineState,
        weights: &Weights,
    ) {
        let Some(contact) = &line.nodes.contact else {
            return;
        };
        self.find_bearings(contact, state, true);
        for i in 0..state.position.len() {
            let push = self
                .resting(contact, line, state, i, true)
                .map(|node| node.push());
            self.keep_friction(i, push.as_ref());
            let Some(push) = push else { continue };
            self.residual[i] -= push.weighted(weights);
            if TANGENT {
                self.diagonal[i] += push.tangent(weights);
                if let Some(coupling) = self.coupling.get_mut(i) {
                    *coupling += push.tangent_after(weights);
                }
            }
        }
    }

    /// Contact of node `i` with the bearing found before; `None` where the seabed does not act.
    fn resting<'a>(
        &self,
        contact: &Contact,
        line: &'a Line,
        state: &LineState,
        i: usize,
        moves: bool,
    ) -> Option<Resting<'a>> {
        let bearing = self.bearing[i];
        let after = self.stand[(i + 1).min(self.stand.len() - 1)].normal;
        (bearing.seabed.force > 0.0).then(|| Resting::on(contact, line, state, i, (bearing, after), moves))
    }

    /// Stores the friction on a node, unless the seabed is a level plane without friction.
    fn keep_friction(&mut self, node: usize, push: Option<&Push>) {
        if let Some(rubbed) = self.rubbed.get_mut(node) {
            *rubbed = push.map_or(Vector3::zeros(), |push| push.friction);
        }
    }
}

impl PointWork {
    /// Adds the seabed under a point at rest.
    pub(super) fn add_static_seabed(
        &mut self,
        free: &FreePoint,
        seabed: &Seabed,
        state: &PointState,
        case: &StaticCase,
    ) {
        let push = resting_point(free, seabed, state, None)
            .map(|resting| resting.at_rest(case, self.pressed).push());
        self.rubbed = push.map_or(Vector3::zeros(), |push| push.friction);
        if !case.keeps_pressure {
            self.pressed = push.map_or(0.0, |push| push.normal_force);
        }
        if let Some(push) = push {
            self.residual -= push.force;
            self.diagonal += push.stiffness[0] + push.stiffness[1];
        }
    }

    /// Adds the seabed under a moving point.
    pub(super) fn add_seabed<const TANGENT: bool>(
        &mut self,
        free: &FreePoint,
        seabed: &Seabed,
        state: &PointState,
        weights: &Weights,
    ) {
        let push = resting_point(free, seabed, state, Some(self.reach)).map(|point| point.push());
        self.rubbed = push.map_or(Vector3::zeros(), |push| push.friction);
        if let Some(push) = push {
            self.residual -= push.weighted(weights);
            if TANGENT {
                self.diagonal += push.tangent(weights);
            }
        }
    }
}

/// Moves the anchors of those nodes of a network that slid in the last assembly.
pub(super) fn move_anchors(model: &Model, network: &Network, state: &mut State, work: &super::Workspace) {
    for &index in &network.lines {
        let (line, shape, work) = (&model.lines[index], &mut state.lines[index], &work.lines[index]);
        if line.friction().is_none() {
            continue;
        }
        let Some((contact, _)) = line.seabed() else {
            continue;
        };
        for (i, anchor) in shape.anchor.iter_mut().enumerate() {
            *anchor = shape.position[i] + stretch(work.rubbed[i], contact.stick[i]);
        }
    }
    for (index, free) in super::free_points(model, network) {
        let point = &mut state.points[index];
        if point.anchor.is_some() {
            let held = stretch(work.points[index].rubbed, point_stick(free));
            point.anchor = Some(point.position + held);
        }
    }
}

/// Moves the anchors of a network at rest at time `t` [s] to positions at which every node starts its motion within the friction limit.
pub(crate) fn hold_at_rest(
    model: &Model,
    network: &Network,
    state: &mut State,
    t: f64,
    work: &mut super::Workspace,
) {
    if model.friction().is_none() {
        return;
    }
    let case = StaticCase::whole(t);
    work.assemble_static(model, network, state, &case);
    work.move_anchors(model, network, state);
}

/// Displacement of a spring under a force.
fn stretch(force: Vector3<f64>, stiffness: f64) -> Vector3<f64> {
    if stiffness > 0.0 {
        force / stiffness
    } else {
        Vector3::zeros()
    }
}

/// Sets an anchor at the position of every node and point that friction may hold, unless it has one.
pub fn drop_anchors(model: &Model, state: &mut State) {
    for (line, shape) in model.lines.iter().zip(&mut state.lines) {
        if line.friction().is_some() && shape.anchor.len() != shape.position.len() {
            shape.anchor.clone_from(&shape.position);
        }
    }
    if model.friction().is_none() {
        return;
    }
    for (point, state) in model.points.iter().zip(&mut state.points) {
        if point.free().is_some_and(|free| free.contact.is_some()) {
            state.anchor.get_or_insert(state.position);
        }
    }
}

/// Removes the anchors of a network, and thereby its friction.
pub(crate) fn remove_anchors(network: &Network, state: &mut State) {
    for &index in &network.lines {
        state.lines[index].anchor.clear();
    }
    for &index in &network.free_points {
        state.points[index].anchor = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::ground::{Grid, Ground};
    use crate::physics::seabed::ContactCoefficients;
    use approx::assert_relative_eq;

    const ROUGH: Friction = Friction {
        axial: 0.4,
        transverse: 0.7,
    };

    fn seabed(ground: Ground) -> Seabed {
        Seabed {
            ground,
            level: false,
            friction: Some(ROUGH),
        }
    }

    fn slope() -> Seabed {
        seabed(Ground::Plane {
            height: -5.0,
            slope: [0.3, -0.2],
        })
    }

    fn hill() -> Seabed {
        let rows = vec![
            vec![-5.0, -4.6, -5.3],
            vec![-5.2, -4.2, -4.9],
            vec![-5.0, -4.8, -5.1],
        ];
        let lines = [-2.0, 0.5, 2.0];
        seabed(Ground::Grid(Grid::new(&lines, &lines, &rows).unwrap()))
    }

    /// Moving node slightly below the seabed, `slid` from its anchor.
    fn resting(
        seabed: &Seabed,
        shift: Vector3<f64>,
        velocity: Vector3<f64>,
        slid: Option<Vector3<f64>>,
    ) -> Resting<'_> {
        let under = Vector3::new(0.2, -0.1, seabed.ground.height(0.2, -0.1) - 0.01);
        let place = under + shift;
        let (touch, k) = (
            seabed.touch(place, 0.0),
            ContactCoefficients {
                stiffness: 1e4,
                damping: 50.0,
            },
        );
        let seabed = FadingContact::new(k, touch.penetration, touch.normal.dot(&velocity), 0.03);
        Resting {
            touch,
            bearing: Bearing {
                seabed: seabed.expect("the node is under the seabed"),
                ..Bearing::default()
            },
            normal_after: touch.normal,
            place,
            velocity,
            slip: slid.map(|slid| Slip {
                friction: &ROUGH,
                tangent: Vector3::new(0.8, 0.5, 0.1).normalize(),
                anchor: under - slid,
                stick: 2e5,
                limit: 1.0,
                normal_force: None,
            }),
        }
    }

    fn assert_tangent(seabed: &Seabed, slid: Option<Vector3<f64>>) {
        let (zero, velocity) = (Vector3::zeros(), Vector3::new(0.05, -0.1, -0.2));
        let push = resting(seabed, zero, velocity, slid).push();
        for axis in 0..3 {
            let step = 1e-7 * Vector3::from_fn(|i, _| f64::from(u8::from(i == axis)));
            let force = |shift, velocity| resting(seabed, shift, velocity, slid).push().force;
            let by_place = (force(-step, velocity) - force(step, velocity)) / 2e-7;
            let by_velocity = (force(zero, velocity - step) - force(zero, velocity + step)) / 2e-7;
            let stiffness = push.stiffness[0] + push.stiffness[1];
            let damping = push.damping[0] + push.damping[1];
            let scale = stiffness.amax();
            assert_relative_eq!(
                stiffness.column(axis).into_owned(),
                by_place,
                epsilon = 1e-6 * scale
            );
            assert_relative_eq!(damping.column(axis).into_owned(), by_velocity, epsilon = 1e-4);
        }
    }

    #[test]
    fn the_tangent_of_contact_and_friction_on_a_slope_equals_central_differences() {
        for slid in [
            None,
            Some([1e-5, 2e-5, 0.0]),
            Some([0.1, 0.05, 0.03]),
            Some([-0.02, 0.3, 0.0]),
        ] {
            assert_tangent(&slope(), slid.map(Vector3::from));
        }
    }

    #[test]
    fn the_tangent_of_contact_over_soundings_equals_central_differences() {
        assert_tangent(&hill(), None);
    }

    #[test]
    fn friction_pulls_towards_the_anchor_in_the_plane_of_the_seabed_up_to_its_limit() {
        let seabed = slope();
        let still = Vector3::zeros();
        let slid = Vector3::new(0.4, -0.3, 0.1);
        let node = resting(&seabed, still, still, Some(slid));
        let push = node.push();
        assert_relative_eq!(push.friction.dot(&node.touch.normal), 0.0, epsilon = 1e-10);
        assert!(push.friction.dot(&slid) < 0.0);
        let normal = (push.force - push.friction).norm();
        let size = push.friction.norm();
        assert!(size > 0.4 * normal && size < 0.7 * normal);
    }
}
