//! The immutable discrete model: every line a chain of two-node segments with lumped nodes, every end at a point.
//!
//! [`Model::new`] is the only conversion from the user's [`Scene`], which the solver does not read. Physics that the
//! scene does not contain is `None` here, not zero.

mod beam;
mod bending;
mod build;
mod initial;
pub(crate) mod mesh;
mod motion;
mod moving;
mod sea;
mod seabed;
mod state;
mod surface;
mod vessel;
mod winch;

use std::sync::Arc;

use nalgebra::Vector3;

use crate::physics::airy::{Orbit, Waves};
use crate::physics::catenary::Section;
use crate::physics::flow::{Profile, Stream};
use crate::physics::morison::DragCoefficients;
use crate::physics::point::{Sphere, Wetted};
use crate::physics::seabed::ContactCoefficients;
use crate::physics::slender::Slender;
use crate::physics::stretch::StretchLaw;
use crate::physics::stretch_step::Spring;
use crate::physics::viscoelastic::Viscoelastic;
use crate::scene::{ForceOutput, InitialShape, PointForce, PointMoment, Solver, TimeFunction};

pub use beam::{Beam, BeamElement, BeamState, Course};
pub use bending::{Bending, joint, joint_of_segments};
pub use build::line_shares;
pub use motion::{Derivatives, Kinematics, Motion, Pose};
pub use moving::Moving;
pub use sea::{WaterAlong, WaveSpan, WaveSpans, WavesAlong};
pub use seabed::Seabed;
pub use state::{ClosedForm, LineState, PointState, State, WinchState};
pub use surface::{Dry, Surface};
pub use vessel::{Frame, Vessel};
pub use winch::{LONGEST, Passage, SHORTEST, Winch};

/// Fraction of a property below which two values count as equal [-].
const ROUNDING: f64 = 1e-9;

/// Discretised scene. Immutable; shared by reference.
#[derive(Debug, Clone)]
pub struct Model {
    /// Gravitational acceleration [m/s²].
    pub gravity: f64,
    /// z of the seabed [m] if it is level; for others, z at the depth that the scene gives.
    pub seabed_level: Option<f64>,
    /// Coefficient of Coulomb friction of the seabed along a line [-].
    pub seabed_friction: f64,
    /// Shape and friction of the seabed; `None` for a level plane without friction.
    pub seabed: Option<Arc<Seabed>>,
    /// Current, if there is one.
    pub current: Option<Current>,
    /// Waves, if there are any.
    pub waves: Option<Waves>,
    /// True if a host gives velocity and acceleration of the water at the nodes.
    pub host_flow: bool,
    /// Points in the order of the scene.
    pub points: Vec<Point>,
    /// Lines in the order of the scene.
    pub lines: Vec<Line>,
    /// Vessels in the order of the scene.
    pub vessels: Vec<Vessel>,
    /// Sets of lines that share free points and so must be solved together.
    pub networks: Vec<Network>,
    /// Settings of the solver, as the scene gives them.
    pub solver: Solver,
    /// True if the scene requests the energy balance.
    pub energy_balance: bool,
    /// Force that the scene requests on coupled points and vessels.
    pub force: ForceOutput,
    /// True if the scene requests derivatives of the forces.
    pub derivatives: bool,
    /// Interval of communication of the scene [s].
    pub interval: f64,
}

/// A current.
#[derive(Debug, Clone)]
pub struct Current {
    /// Velocity of the current over the height.
    pub profile: Profile,
    /// Factor on the velocity in time.
    pub factor: Option<TimeFunction>,
}

impl Current {
    /// The current at time `t` [s].
    pub fn at(&self, t: f64) -> Stream<'_> {
        Stream {
            profile: &self.profile,
            factor: self.factor.as_ref().map_or(1.0, |factor| factor.at(t)),
        }
    }
}

/// A point that lines end at.
#[derive(Debug, Clone)]
pub struct Point {
    /// Name.
    pub name: String,
    /// Reference position [m].
    pub reference: Vector3<f64>,
    /// Source of its motion.
    pub role: Role,
    /// Load in time.
    pub load: Option<PointForce>,
    /// Moment in time, on the end of a line that bends.
    pub moment: Option<PointMoment>,
    /// Mass and submergence properties of a point that is not free; it moves along no axis and has no contact.
    pub own: Option<FreePoint>,
    /// (line, end) pairs that meet here.
    pub attached: Vec<(usize, End)>,
}

/// Body moved by a host: a coupled point along three axes, a vessel along and about all six.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Body {
    /// A coupled point, by its index.
    Point(usize),
    /// A vessel, by its index.
    Vessel(usize),
}

impl Body {
    /// Number of axes of the motion: x, y, z and, for a vessel, roll, pitch, yaw.
    pub fn axes(self) -> usize {
        match self {
            Body::Point(_) => 3,
            Body::Vessel(_) => 6,
        }
    }
}

/// Source of a point's motion.
#[derive(Debug, Clone)]
pub enum Role {
    /// Never moves.
    Fixed,
    /// The host moves it; the motion of the scene drives it in `moorline run`.
    Coupled {
        /// Motion given by the scene.
        motion: Option<Motion>,
    },
    /// Point fixed to a vessel, which the host moves.
    Carried {
        /// Index of the vessel.
        vessel: usize,
        /// Place in the vessel's axes [m].
        arm: Vector3<f64>,
    },
    /// Moves along its path.
    Prescribed(Motion),
    /// Moves under forces.
    Free(FreePoint),
}

/// Forces on a point with mass in moving water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointForces {
    /// Properties of the point at its height above the surface.
    pub at: PointAtHeight,
    /// Velocity relative to the water [m/s].
    pub past: Vector3<f64>,
    /// Load, weight, buoyancy, drag and the force of waves [N].
    pub sum: Vector3<f64>,
}

/// Properties of a point that moves under forces.
#[derive(Debug, Clone, PartialEq)]
pub struct FreePoint {
    /// Axes along which it moves.
    pub axes: [bool; 3],
    /// Mass of the point [kg].
    pub mass: f64,
    /// Weight less buoyancy of the point, fully submerged [N].
    pub weight: f64,
    /// Sphere of buoyancy, drag and added mass, if there is water and the point has a volume or a drag area.
    pub sphere: Option<Sphere>,
    /// Contact, if a seabed is in reach and the point has weight.
    pub contact: Option<PointContact>,
}

/// Contact of a free point with the seabed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointContact {
    /// z of the seabed [m].
    pub seabed_level: f64,
    /// z below which the spring acts [m], such that the point lies on the seabed when it rests with its full weight.
    pub level: f64,
    /// Spring and damper.
    pub coefficients: ContactCoefficients,
}

/// Properties of a free point at a height: its weight and its mass change where it pierces the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointAtHeight {
    /// Submergence of the point.
    pub wetted: Wetted,
    /// Weight less buoyancy [N].
    pub weight: f64,
    /// Slope of the weight with height [N/m], not negative.
    pub weight_slope: f64,
    /// Mass and added mass [kg].
    pub mass: f64,
    /// Slope of the mass with height [kg/m], not positive.
    pub mass_slope: f64,
}

/// An end of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// End A, the anchor's.
    A,
    /// End B, the fairlead's.
    B,
}

/// A line of n segments and n + 1 nodes; nodes 0 and n lie at its points.
#[derive(Debug, Clone)]
pub struct Line {
    /// Name.
    pub name: String,
    /// Indices of the points of ends A and B.
    pub ends: [usize; 2],
    /// n segments.
    pub segments: Segments,
    /// n + 1 lumped nodes.
    pub nodes: Nodes,
    /// Bending stiffness, if a line type has it.
    pub bending: Option<Bending>,
    /// The water's surface, if the line may pierce it.
    pub surface: Option<Surface>,
    /// Sections for the closed-form catenary.
    pub sections: Vec<Section>,
    /// Shape at the start.
    pub initial: InitialShape,
    /// Beam properties, if the line is a beam.
    pub beam: Option<Beam>,
    /// Conditions for the release of ends A and B, if one of them may be released.
    pub release: Option<[Release; 2]>,
    /// Winch at end B, if the line is on one; the line then has the elements that are paid out at present.
    pub winch: Option<Winch>,
    /// True for an end whose load is assumed to be linear to the next node: both nodes have the same properties per length, and neither a
    /// winch nor a clamp at the other end acts on the next node.
    pub linear_load: [bool; 2],
}

/// Conditions for the release of an end from its point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Release {
    /// Tension of the end's segment at which it is released [N].
    pub tension: Option<f64>,
    /// Time of its release [s].
    pub time: Option<f64>,
    /// True if the host's input releases the end.
    pub on_release: bool,
}

impl Release {
    /// Returns whether the end can be released.
    pub fn may_release(&self) -> bool {
        self.tension.is_some() || self.time.is_some() || self.on_release
    }

    /// Returns whether an end under a tension [N] at time `t` [s] is released by its limit of tension or its time. The time of a run is a sum of rounded
    /// steps: eight steps of 0.05 s end just before 0.4 s.
    pub fn is_due(&self, tension: f64, t: f64) -> bool {
        let is_reached = |time: f64| t >= time - 1e-9 * (1.0 + time.abs());
        self.tension.is_some_and(|most| tension >= most) || self.time.is_some_and(is_reached)
    }
}

/// Properties of the segments, one entry each.
#[derive(Debug, Clone)]
pub struct Segments {
    /// Unstretched length [m].
    pub length: Vec<f64>,
    /// Axial stiffness EA [N].
    pub axial_stiffness: Vec<f64>,
    /// Axial damping BA [N s].
    pub axial_damping: Vec<f64>,
    /// Strain measure.
    pub law: Vec<StretchLaw>,
    /// Viscoelastic law instead of stiffness and damping in motion, if the line has a viscoelastic section; EA is
    /// then the static one.
    pub viscoelastic: Option<Vec<Viscoelastic>>,
}

/// Lumped properties of the nodes: per-length properties times half of each neighbouring segment.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// Unstretched arc length from end A [m].
    pub arc: Vec<f64>,
    /// Tributary unstretched length [m].
    pub length: Vec<f64>,
    /// Mass in air [kg].
    pub mass: Vec<f64>,
    /// Mass with the added mass across the line [kg].
    pub mass_normal: Vec<f64>,
    /// Mass with the added mass along the line [kg].
    pub mass_tangent: Vec<f64>,
    /// Weight less buoyancy [N].
    pub weight: Vec<f64>,
    /// Drag, if there is water and a coefficient.
    pub drag: Option<Drag>,
    /// Froude-Krylov force of accelerated water.
    pub froude_krylov: Option<FroudeKrylov>,
    /// Contact, if a seabed is in reach.
    pub contact: Option<Contact>,
    /// Mass-proportional damping α·m [N s/m], if a line type has it.
    pub mass_damping: Option<Vec<f64>>,
}

/// Lumped drag coefficients of the nodes.
#[derive(Debug, Clone)]
pub struct Drag {
    /// Across the line [N s²/m²].
    pub normal: Vec<f64>,
    /// Along the line [N s²/m²].
    pub tangent: Vec<f64>,
}

/// Mass of the water whose acceleration acts on a node: that of the displaced water, by the pressure of the
/// undisturbed wave (Froude and Krylov), and the added mass. Across the line ρA(1 + C_an)l, along it ρA(1 + C_at)l,
/// since the pressure that the effective tension leaves out acts along the line too.
#[derive(Debug, Clone)]
pub struct FroudeKrylov {
    /// Across the line [kg].
    pub normal: Vec<f64>,
    /// Along the line [kg].
    pub tangent: Vec<f64>,
}

impl Drag {
    /// Coefficients of a node.
    #[inline]
    pub fn at(&self, node: usize) -> DragCoefficients {
        DragCoefficients {
            normal: self.normal[node],
            tangent: self.tangent[node],
        }
    }
}

impl FroudeKrylov {
    /// Force [N] on a node whose unit tangent is `tangent` [-], by water of an acceleration [m/s²].
    #[inline]
    pub fn force(&self, node: usize, acceleration: Vector3<f64>, tangent: Vector3<f64>) -> Vector3<f64> {
        Slender::new(self.masses(node, 0.0)).times(acceleration, tangent)
    }

    /// Mass across and along the line [kg] of a node, of which the part `dry` [-] is out of the water.
    #[inline]
    pub fn masses(&self, node: usize, dry: f64) -> [f64; 2] {
        [&self.normal, &self.tangent].map(|masses| (1.0 - dry) * masses[node])
    }
}

/// Contact of the segments with the seabed.
#[derive(Debug, Clone)]
pub struct Contact {
    /// z of the seabed [m].
    pub seabed_level: f64,
    /// z below which the springs act, per node [m]: the seabed, or with regularised contact the level at which a line at rest lies on
    /// the seabed.
    pub level: Vec<f64>,
    /// Stiffness, per segment [N/m].
    pub stiffness: Vec<f64>,
    /// Damping, per segment [N s/m].
    pub damping: Vec<f64>,
    /// Weight less buoyancy, per segment [N].
    pub weight: Vec<f64>,
    /// Mass across the line with the added mass, per segment [kg].
    pub mass: Vec<f64>,
    /// Basis of regularised contact; `None` if stiffness and damping are those of the scene.
    pub regularised: Option<Regularised>,
    /// True if contact acts at the nodes only.
    pub at_nodes: bool,
    /// Shape and friction of the seabed; `None` for a level plane without friction.
    pub seabed: Option<Arc<Seabed>>,
    /// Stiffness along the seabed of a node that sticks [N/m]; empty without friction.
    pub stick: Vec<f64>,
}

/// Basis of regularised contact, per segment.
#[derive(Debug, Clone, PartialEq)]
pub struct Regularised {
    /// Stiffness and damping of the scene.
    pub given: Vec<ContactCoefficients>,
    /// Load at rest [N]: the weight less buoyancy, more over a ridge of soundings and less on its flanks. Springs are sized for this load, but at least
    /// for the weight.
    pub load: Vec<f64>,
}

/// Lines that share free points.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Network {
    /// Lines of the network.
    pub lines: Vec<usize>,
    /// Free points of the network.
    pub free_points: Vec<usize>,
}

impl Segments {
    /// Stiffness [N] and damping [N s] of a segment in fast motion.
    pub fn in_motion(&self, i: usize) -> (f64, f64) {
        match &self.viscoelastic {
            Some(laws) => (laws[i].fast, laws[i].damping),
            None => (self.axial_stiffness[i], self.axial_damping[i]),
        }
    }
}

impl Nodes {
    /// Returns whether two nodes have the same mass, weight and drag per length.
    fn is_alike(&self, i: usize, k: usize) -> bool {
        let (one, other) = (1.0 / self.length[i], 1.0 / self.length[k]);
        let same = |values: &[f64]| {
            let (a, b) = (one * values[i], other * values[k]);
            (a - b).abs() <= ROUNDING * a.abs()
        };
        let dragged = |drag: &Drag| same(&drag.normal) && same(&drag.tangent);
        [&self.mass, &self.mass_normal, &self.mass_tangent, &self.weight]
            .into_iter()
            .all(|values| same(values))
            && self.drag.as_ref().is_none_or(dragged)
    }
}

impl Line {
    /// Returns [`Line::linear_load`] of a line that is not on a winch.
    fn has_linear_load(&self, end: End) -> bool {
        let (count, node) = (self.segment_count(), self.end_node(end));
        let (next, far) = match end {
            End::A => (1, count),
            End::B => (count - 1, 0),
        };
        let is_clamped = |bending: &Bending| bending.joint[far] > 0.0 && next.abs_diff(far) < 2;
        count > 1 && !self.bending.as_ref().is_some_and(is_clamped) && self.nodes.is_alike(node, next)
    }

    /// Number of segments n.
    pub fn segment_count(&self) -> usize {
        self.segments.length.len()
    }

    /// Unstretched length [m].
    pub fn unstretched_length(&self) -> f64 {
        self.sections.iter().map(|section| section.length).sum()
    }

    /// Returns whether the line resists bending, as a cable or as a beam.
    pub fn bends(&self) -> bool {
        self.bending.is_some() || self.beam.is_some()
    }

    /// Returns whether the closed-form catenary applies to the line: engineering strain, and a level seabed if any is in reach.
    pub fn has_catenary(&self, model: &Model) -> bool {
        let mut laws = self.segments.law.iter();
        laws.all(|law| *law == StretchLaw::Engineering)
            && (model.seabed_is_level() || self.nodes.contact.is_none())
    }

    /// Returns whether a current acts on the line.
    pub fn drifts(&self, model: &Model) -> bool {
        self.nodes.drag.is_some() && model.current.is_some()
    }

    /// Spring of segment `segment` at a strain [-], by its law alone, without its limit in compression.
    #[inline(always)]
    pub fn uncut_spring(&self, segment: usize, strain: f64) -> Spring {
        let ea = self.segments.axial_stiffness[segment];
        let at = self.segments.law[segment].at(strain);
        Spring {
            strain,
            tension: ea * at.force,
            slope: ea * at.slope,
            energy: ea * at.energy,
        }
    }

    /// Spring of segment `segment` at a strain [-]: its law in tension, and its limit in compression.
    #[inline(always)]
    pub fn spring(&self, segment: usize, strain: f64) -> Spring {
        let push = self.compression_max(segment);
        let uncut = self.uncut_spring(segment, strain);
        if strain > 0.0 || uncut.tension > -push {
            return uncut;
        }
        let stiffness = self.uncut_spring(segment, 0.0).slope; // the limit is reached along the slope at zero strain
        let limit = -push / stiffness;
        Spring {
            strain,
            tension: 0.0 - push,
            slope: 0.0,
            energy: 0.5 * push * push / stiffness + push * (limit - strain),
        }
    }

    /// Returns whether an end is held: its point is not free, and the end is not released from it.
    pub fn is_held(&self, model: &Model, state: &LineState, end: End) -> bool {
        let side = usize::from(end == End::B);
        model.points[self.ends[side]].free().is_none() && !state.released[side]
    }

    /// Returns whether waves, or the flow that a host gives, act on the line.
    pub fn heaves(&self, model: &Model) -> bool {
        model.water_accelerates() && (self.nodes.drag.is_some() || self.nodes.froude_krylov.is_some())
    }

    /// Number of nodes at which a host gives the flow [-]: all if it acts on the line, or on the body of a point at an end, otherwise 0.
    pub fn flow_count(&self, model: &Model) -> usize {
        let on_end = || self.ends.iter().any(|&point| model.points[point].heaves());
        match model.host_flow && (self.heaves(model) || on_end()) {
            true => self.segment_count() + 1,
            false => 0,
        }
    }

    /// Index of the node at an end.
    pub fn end_node(&self, end: End) -> usize {
        match end {
            End::A => 0,
            End::B => self.segment_count(),
        }
    }

    /// Returns whether the leapfrogs can integrate the line: one strain measure, mass on every node and, if it bends, engineering
    /// strain without Rayleigh damping or viscoelastic sections.
    pub fn serves_leapfrog(&self) -> bool {
        self.uniform_law().is_some()
            && self
                .bending
                .as_ref()
                .is_none_or(|bending| self.joints_serve_leapfrog(bending))
            && self.nodes.mass_normal.iter().all(|mass| *mass > 0.0)
            && (self.surface.is_none() || self.nodes.mass.iter().all(|mass| *mass > 0.0))
    }

    /// Returns whether a leapfrog can integrate the joints of the line and the compression of its segments.
    fn joints_serve_leapfrog(&self, bending: &Bending) -> bool {
        let proportional = self.uniform_law() == Some(StretchLaw::Engineering);
        proportional && self.segments.viscoelastic.is_none() && bending.damping.is_none()
    }

    /// Minimum mass of a node along any direction [kg]: in air if the line may pierce the water's surface.
    pub fn least_mass(&self, node: usize) -> f64 {
        let nodes = &self.nodes;
        match &self.surface {
            None => nodes.mass_tangent[node].min(nodes.mass_normal[node]),
            Some(_) => nodes.mass[node],
        }
    }

    /// Strain measure, if all segments share one.
    pub fn uniform_law(&self) -> Option<StretchLaw> {
        let first = &self.segments.law[0];
        self.segments
            .law
            .iter()
            .all(|law| law == first)
            .then(|| first.clone())
    }
}

impl FreePoint {
    /// Properties of the point at a height z [m].
    #[inline]
    pub fn at(&self, z: f64) -> PointAtHeight {
        let Some(sphere) = &self.sphere else {
            let wetted = Wetted {
                part: 0.0,
                slope: 0.0,
            };
            return PointAtHeight {
                wetted,
                weight: self.weight,
                weight_slope: 0.0,
                mass: self.mass,
                mass_slope: 0.0,
            };
        };
        let wetted = sphere.wetted(z);
        PointAtHeight {
            wetted,
            weight: self.weight + sphere.buoyancy * (1.0 - wetted.part),
            weight_slope: -sphere.buoyancy * wetted.slope,
            mass: self.mass + sphere.added_mass * wetted.part,
            mass_slope: sphere.added_mass * wetted.slope,
        }
    }

    /// Drag [N] at a velocity relative to the water [m/s].
    #[inline]
    pub fn drag(&self, wetted: Wetted, velocity: Vector3<f64>) -> Vector3<f64> {
        let sphere = self.sphere.as_ref();
        sphere.map_or(Vector3::zeros(), |sphere| sphere.drag(wetted, velocity))
    }

    /// Force [N] of the water accelerated by waves on the submerged part of the point.
    #[inline]
    pub fn froude_krylov(&self, wetted: Wetted, orbit: &Orbit) -> Vector3<f64> {
        let sphere = self.sphere.as_ref();
        let mass = sphere.map_or(0.0, |sphere| sphere.displaced + sphere.added_mass);
        mass * wetted.part * orbit.acceleration
    }

    /// Forces on the point in a `state` under a `load` [N], in a current and waves.
    pub fn forces(
        &self,
        load: Vector3<f64>,
        state: &PointState,
        (stream, waves): (Option<Stream>, Option<Orbit>),
    ) -> PointForces {
        let z = state.position.z;
        let mut past = state.velocity - stream.map_or(Vector3::zeros(), |stream| stream.velocity(z));
        let at = self.at(z - waves.map_or(0.0, |orbit| orbit.elevation));
        let mut sum = load - at.weight * Vector3::z();
        if let Some(orbit) = &waves {
            past -= orbit.velocity;
            sum += self.froude_krylov(at.wetted, orbit);
        }
        if let Some(sphere) = &self.sphere {
            sum += sphere.drag(at.wetted, past);
        }
        PointForces { at, past, sum }
    }

    /// Energy of weight and buoyancy at a height z [m], in [J].
    pub fn potential(&self, z: f64) -> f64 {
        match &self.sphere {
            None => self.weight * z,
            Some(sphere) => (self.weight + sphere.buoyancy) * z + sphere.energy(z),
        }
    }

    /// Maximum magnitude of the weight, the buoyancy and the difference of the two [N].
    pub fn weight_max(&self) -> f64 {
        let buoyancy = self.sphere.map_or(0.0, |sphere| sphere.buoyancy);
        (self.weight + buoyancy)
            .abs()
            .max(self.weight.abs())
            .max(buoyancy.abs())
    }

    /// Drag [N] of a current at a height z [m], at rest.
    pub fn drag_at_rest(&self, z: f64, stream: Stream) -> Vector3<f64> {
        self.drag(self.at(z).wetted, -stream.velocity(z))
    }

    /// Stiffness [N/m] and upward force [N] of the seabed's spring at a height z [m], at rest; `None` without contact.
    pub fn seabed_at_rest(&self, z: f64) -> Option<(f64, f64)> {
        let contact = self.contact.as_ref()?;
        let (stiffness, penetration) = (contact.coefficients.stiffness, contact.level - z);
        (penetration > 0.0).then_some((stiffness, stiffness * penetration))
    }
}

impl Point {
    /// Properties of the point, if it is free.
    pub fn free(&self) -> Option<&FreePoint> {
        match &self.role {
            Role::Free(free) => Some(free),
            _ => None,
        }
    }

    /// Returns whether a host or the scene's motion may move the point.
    pub fn is_moved(&self) -> bool {
        matches!(
            self.role,
            Role::Coupled { .. } | Role::Carried { .. } | Role::Prescribed(_)
        )
    }

    /// Returns whether waves would act on the body of the point.
    pub fn heaves(&self) -> bool {
        self.body().is_some_and(|body| body.sphere.is_some())
    }

    /// Mass and submergence properties of the point, whether it is free or not.
    pub fn body(&self) -> Option<&FreePoint> {
        self.free().or(self.own.as_ref())
    }

    /// Force [N] of the point without its lines: its load, weight and buoyancy, drag, the force of waves, the spring of the seabed under a free point,
    /// and inertia.
    pub fn own_force(
        &self,
        state: &PointState,
        t: f64,
        water: (Option<Stream>, Option<Orbit>),
    ) -> Vector3<f64> {
        let load = self.load_at(t);
        let Some(body) = self.body() else { return load };
        let forces = body.forces(load, state, water);
        let seabed = self.free().and_then(|free| free.seabed_at_rest(state.position.z));
        let push = seabed.map_or(0.0, |(_, push)| push) * Vector3::z();
        forces.sum + push - forces.at.mass * state.acceleration
    }

    /// Point load at time `t` [s], in [N].
    pub fn load_at(&self, t: f64) -> Vector3<f64> {
        self.load_axes().map(|f| f.map_or(0.0, |f| f.at(t))).into()
    }

    /// Mean point load from `from` to `to` [s], in [N].
    pub fn load_mean(&self, from: f64, to: f64) -> Vector3<f64> {
        let mean = |f: Option<&TimeFunction>| f.map_or(0.0, |f| f.mean(from, to));
        self.load_axes().map(mean).into()
    }

    /// Mean point load over `span` [s] about the time `t` [s], in [N].
    pub fn load_about(&self, t: f64, span: f64) -> Vector3<f64> {
        self.load_mean(t - 0.5 * span, t + 0.5 * span)
    }

    /// Moment at time `t` [s], in [N m].
    pub fn moment_at(&self, t: f64) -> Vector3<f64> {
        self.moment_axes().map(|f| f.map_or(0.0, |f| f.at(t))).into()
    }

    /// Mean moment from `from` to `to` [s], in [N m].
    pub fn moment_mean(&self, from: f64, to: f64) -> Vector3<f64> {
        let mean = |f: Option<&TimeFunction>| f.map_or(0.0, |f| f.mean(from, to));
        self.moment_axes().map(mean).into()
    }

    fn load_axes(&self) -> [Option<&TimeFunction>; 3] {
        let load = self.load.as_ref();
        load.map_or([None; 3], |f| [f.x.as_ref(), f.y.as_ref(), f.z.as_ref()])
    }

    fn moment_axes(&self) -> [Option<&TimeFunction>; 3] {
        let moment = self.moment.as_ref();
        moment.map_or([None; 3], |m| [m.x.as_ref(), m.y.as_ref(), m.z.as_ref()])
    }
}

impl Model {
    /// Beam of a network, if it consists of one.
    pub fn beam_of(&self, network: usize) -> Option<usize> {
        let line = self.networks[network].lines[0];
        self.lines[line].beam.is_some().then_some(line)
    }

    /// The lines of a network.
    pub fn lines_of<'a>(&'a self, network: &'a Network) -> impl Iterator<Item = &'a Line> + Clone {
        network.lines.iter().map(|&line| &self.lines[line])
    }

    /// Returns whether a network starts in static equilibrium, as it does if any of its lines does.
    pub fn starts_at_rest(&self, network: usize) -> bool {
        let mut lines = self.lines_of(&self.networks[network]);
        lines.any(|line| line.initial == InitialShape::Static)
    }

    /// Index of the line called `name`.
    pub fn line_index(&self, name: &str) -> Option<usize> {
        self.lines.iter().position(|line| line.name == name)
    }

    /// Current at time `t` [s], if there is one.
    pub fn stream(&self, t: f64) -> Option<Stream<'_>> {
        self.current.as_ref().map(|current| current.at(t))
    }

    /// All points followed by all vessels.
    pub fn bodies(&self) -> impl Iterator<Item = Body> {
        (0..self.points.len() + self.vessels.len()).map(|index| self.body(index))
    }

    /// The body at an index in the list of all points followed by all vessels.
    pub fn body(&self, index: usize) -> Body {
        match index.checked_sub(self.points.len()) {
            None => Body::Point(index),
            Some(vessel) => Body::Vessel(vessel),
        }
    }

    /// Returns whether a point is the body or is fixed to it.
    pub fn moves_with(&self, point: usize, body: Body) -> bool {
        match (body, &self.points[point].role) {
            (Body::Point(driven), _) => point == driven,
            (Body::Vessel(carrier), Role::Carried { vessel, .. }) => *vessel == carrier,
            (Body::Vessel(_), _) => false,
        }
    }

    /// End of a line that is moved; B where both or none are.
    pub fn driven_end(&self, line: usize) -> End {
        match self.lines[line].ends.map(|point| self.points[point].is_moved()) {
            [true, false] => End::A,
            _ => End::B,
        }
    }

    /// Index of the point called `name`.
    pub fn point_index(&self, name: &str) -> Option<usize> {
        self.points.iter().position(|point| point.name == name)
    }
}
