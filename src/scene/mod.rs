//! What the user wrote: plain data, SI units, nothing computed. What is absent is `None`.
//!
//! A scene comes from a TOML file ([`load`]) or from TOML text ([`Scene::from_toml`]); every mistake names its key, line and
//! column. [`Scene::notes`] says what is no mistake but may surprise, [`Scene::in_words`] what is modelled.
//! [`crate::model::Model::new`] is the one gate from here to the solver.

mod bathymetry_file;
pub mod channel;
mod check;
mod columns;
mod commented;
mod document;
mod drive;
mod error;
mod idle;
pub mod input_file;
pub mod keys;
mod motion_file;
pub mod nearest;
mod notes;
pub mod path;
mod places;
pub mod plausibility;
mod read;
pub mod rows;
mod seabed;
mod slips;
mod surface;
mod table_ends;
mod tension_strain;
mod threads;
mod time_function;
mod units;
mod water_file;
mod waves;
mod words;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use crate::math::attitude::Order as AngleOrder;
pub use drive::{Drive, RegularMotion};
pub use error::{LoadError, SceneError};
pub use notes::Note;
pub use places::Places;
pub use read::{LoadedScene, TOML, folder_of, is_toml, load, load_text, read_text};
pub use seabed::{ContactLaw, DepthGrid, Friction, Seabed};
pub use tension_strain::TensionStrain;
pub use threads::Threads;
pub use time_function::{HarmonicMotion, MotionFile, MotionPath, MotionRow, TimeFunction};
pub use waves::{RegularWave, Sea, SpectrumKind, WaveComponents, Waves};
pub(crate) use words::percent;

/// Standard gravity [m/s²], the default of [`Scene::gravity`].
pub const STANDARD_GRAVITY: f64 = 9.80665;
/// Elements of a line alone that a damping ratio refers to [-]: those that the default tolerance gives. The damping BA that follows is one
/// of the line and the same on every mesh, so that finer meshes have a limit.
pub const DAMPING_ELEMENTS: usize = 40;
/// Axial damping of a line whose type leaves it open, as a part of critical of one of [`DAMPING_ELEMENTS`] elements and of every longer one [-]. A line that slackens and snaps
/// without any is driven by the kink of its own tension law when the step is explicit; codes of that kind damp the
/// highest axial frequencies, which no mesh resolves, by as much (linear bulk viscosity).
pub const NUMERICAL_DAMPING_RATIO: f64 = 0.02;
/// Least spectral radius at infinite frequency of `axial_implicit` [-], at which it damps most.
pub const AXIAL_RADIUS_MIN: f64 = 0.5;

/// One mooring scene as the user described it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What the scene is, in a line.
    #[serde(default)]
    pub title: String,
    /// Gravitational acceleration [m/s²].
    #[serde(default = "standard_gravity")]
    pub gravity: f64,
    /// The water; without it there is no buoyancy, drag or added mass.
    pub water: Option<Water>,
    /// The seabed; without it there is no contact.
    pub seabed: Option<Seabed>,
    /// Line types by name.
    #[serde(default)]
    pub line_types: BTreeMap<String, LineType>,
    /// Points that lines end at.
    #[serde(default)]
    pub points: Vec<Point>,
    /// Lines between points.
    #[serde(default)]
    pub lines: Vec<Line>,
    /// Floating bodies that carry points, moved by the host.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vessels: Vec<Vessel>,
    /// How to solve.
    #[serde(default)]
    pub solver: Solver,
    /// What moves the coupled points and the vessels in `moorline run`, by name.
    #[serde(default)]
    pub motion: BTreeMap<String, MotionPath>,
    /// What `moorline run` and the FMU write.
    #[serde(default)]
    pub output: Output,
}

/// Water. Its surface is at z = 0 for free points and for lines that may come out of it; other lines are under water everywhere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Density [kg/m³].
    pub density: f64,
    /// How it flows; still where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub current: Option<Current>,
    /// Its waves; none where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waves: Option<Waves>,
    /// Whether lines lose buoyancy, drag and added mass above z = 0. Where absent, those do that have an end above it, or could float
    /// up to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<bool>,
}

/// A current: `{ velocity = [vx, vy, vz] }`, alike at all heights, or `{ profile = [[z, vx, vy], …] }`, straight between the rows
/// and constant outside; with `factor`, a function of time that multiplies it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Current {
    /// Velocity at all heights [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<[f64; 3]>,
    /// A file of MoorDyn's format that the profile stands in: below three lines of headings, rows of z [m] and vx, vy, vz [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Rows of height z [m] and horizontal velocity vx, vy [m/s], no two at one height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<Vec<[f64; 3]>>,
    /// What multiplies the velocity in time; 1 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<TimeFunction>,
}

impl Water {
    /// Still water of a density [kg/m³].
    pub fn still(density: f64) -> Water {
        Water {
            density,
            current: None,
            waves: None,
            surface: None,
        }
    }
}

/// Properties of a line per unstretched length. Give `mass` or `weight`, and `diameter` where there is water.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineType {
    /// What the line's elements resist.
    #[serde(default)]
    pub model: LineModel,
    /// Mass in air [kg/m].
    pub mass: Option<f64>,
    /// Weight in the scene's surroundings [N/m]; where given, buoyancy is not subtracted again.
    pub weight: Option<f64>,
    /// Volume-equivalent diameter [m].
    pub diameter: Option<f64>,
    /// Axial stiffness EA [N].
    pub axial_stiffness: Option<f64>,
    /// Tension over strain [- and N], instead of `axial_stiffness`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension_strain: Option<TensionStrain>,
    /// Static stiffness EA_s of a viscoelastic rope [N], instead of `axial_stiffness`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_stiffness: Option<f64>,
    /// Dynamic stiffness EA_d of a viscoelastic rope [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dynamic_stiffness: Option<f64>,
    /// Damping BA_s of the slow part of a viscoelastic rope [N s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_damping: Option<f64>,
    /// Damping BA_d of the fast part of a viscoelastic rope [N s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dynamic_damping: Option<f64>,
    /// Axial damping BA [N s].
    pub axial_damping: Option<f64>,
    /// Axial damping as a ratio of the critical damping of each segment [-]; instead of `axial_damping`.
    pub damping_ratio: Option<f64>,
    /// Rayleigh damping, in addition to the axial damping.
    pub rayleigh: Option<Rayleigh>,
    /// Strain measure that EA multiplies.
    #[serde(default)]
    pub strain: Strain,
    /// Normal drag coefficient [-], on the frontal area d·l.
    pub drag_normal: Option<f64>,
    /// Tangential drag coefficient [-], on the skin area π·d·l.
    pub drag_tangential: Option<f64>,
    /// Normal added-mass coefficient [-], on the displaced volume.
    pub added_mass_normal: Option<f64>,
    /// Tangential added-mass coefficient [-], on the displaced volume.
    pub added_mass_tangential: Option<f64>,
    /// Bending stiffness EI of one solid section [N m²]; absent or 0, the line is perfectly flexible.
    pub bending_stiffness: Option<f64>,
    /// Solid round section that stiffnesses not given otherwise follow from.
    pub solid_section: Option<SolidSection>,
    /// Number of loose strands that share the section [-]; 1 where absent.
    pub fibres: Option<usize>,
    /// How the bending stiffness falls with the number of fibres.
    #[serde(default)]
    pub fibre_law: FibreLaw,
    /// Shear stiffness GA [N], beams only.
    pub shear_stiffness: Option<f64>,
    /// Torsional stiffness GJ [N m²], beams only.
    pub torsional_stiffness: Option<f64>,
    /// Rotary inertia of the section per length, about any axis [kg m], beams only.
    pub rotary_inertia: Option<f64>,
}

impl LineType {
    /// Whether there is a bending stiffness: as given, else that of the solid section.
    pub fn bends(&self) -> bool {
        let of_section = self.solid_section.is_some();
        self.bending_stiffness.map_or(of_section, |ei| ei > 0.0)
    }

    /// Whether nothing is said of the axial damping, so that segments have [`NUMERICAL_DAMPING_RATIO`]; beams then have none.
    pub fn leaves_damping_open(&self) -> bool {
        self.axial_damping.is_none()
            && self.damping_ratio.is_none()
            && self.dynamic_damping.is_none()
            && self.rayleigh.is_none()
    }
}

/// What the elements of a line resist.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LineModel {
    /// Stretch, and bending where there is a bending stiffness.
    #[default]
    Cable,
    /// Stretch, shear, bending and torsion, with rotary inertia: the geometrically exact beam.
    Beam,
}

/// A solid round section of one material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidSection {
    /// Diameter of the load-bearing section [m].
    pub diameter: f64,
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio ν [-], for shear and torsion.
    #[serde(default = "steel_poisson")]
    pub poisson: f64,
}

/// How bending stiffness falls with the number n of loose strands that share a section.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FibreLaw {
    /// EI/n: n round strands of the same total area, each of 1/n² of the EI, bend side by side.
    #[default]
    Linear,
    /// EI/n²: the stiffness of a single strand.
    Squared,
}

/// Damping ratios at two circular frequencies; they fix C = α·M + β·K.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// Damping ratios at the two frequencies [-].
    pub ratios: [f64; 2],
    /// Circular frequencies [rad/s].
    pub frequencies: [f64; 2],
}

/// Strain measure.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Strain {
    /// ε = λ − 1.
    #[default]
    Engineering,
    /// Green-Lagrange, ε = (λ² − 1)/2.
    Green,
    /// Hencky, ε = ln λ on the current area A·λ^(−2ν); the value is Poisson's ratio ν [-], 0 to ½.
    Logarithmic(f64),
}

/// A point that lines end at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Name, the stem of its variables.
    pub name: String,
    /// Reference position [m].
    pub position: [f64; 3],
    /// Who moves it.
    pub kind: PointKind,
    /// Vessel that a coupled point rides on; its position [m] is then in the vessel's frame.
    pub on: Option<String>,
    /// Axes along which a free point may move; all where absent.
    pub free: Option<Vec<Axis>>,
    /// Own mass [kg]; not of fixed points. Of points that are not free it adds to the force on what holds them.
    pub mass: Option<f64>,
    /// Own displaced volume [m³]; not of fixed points.
    pub volume: Option<f64>,
    /// Drag coefficient times area CdA [m²]; not of fixed points.
    pub drag_area: Option<f64>,
    /// Added-mass coefficient Ca [-], on the displaced volume; not of fixed points.
    pub added_mass: Option<f64>,
    /// Point load in time.
    pub force: Option<PointForce>,
    /// Moment in time, on the end of a line that bends at a free point.
    pub moment: Option<PointMoment>,
    /// Its prescribed displacement in time, `kind = "prescribed"` only.
    pub motion: Option<MotionPath>,
}

/// Who moves a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointKind {
    /// Never moves.
    Fixed,
    /// The host moves it: a fairlead.
    Coupled,
    /// Its own path in time moves it, in every host.
    Prescribed,
    /// The forces on it move it.
    Free,
}

/// A global axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Global x.
    X,
    /// Global y.
    Y,
    /// Global z, up.
    Z,
}

/// A point load [N] along the global axes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointForce {
    /// Along x [N].
    pub x: Option<TimeFunction>,
    /// Along y [N].
    pub y: Option<TimeFunction>,
    /// Along z [N].
    pub z: Option<TimeFunction>,
}

/// A moment [N m] about the global axes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointMoment {
    /// About x [N m].
    pub x: Option<TimeFunction>,
    /// About y [N m].
    pub y: Option<TimeFunction>,
    /// About z [N m].
    pub z: Option<TimeFunction>,
}

/// A floating body that the host moves: a frame that carries points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vessel {
    /// Name, the stem of its variables.
    pub name: String,
    /// Reference position of its origin [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Reference attitude: roll, pitch, yaw [rad], body to global by yaw about z, then pitch about y', then roll about x''.
    #[serde(default)]
    pub attitude: [f64; 3],
    /// Order of the rotations by roll, pitch and yaw in the motion that a run gives it, `[motion]` or beside the scene.
    #[serde(default, skip_serializing_if = "AngleOrder::is_zyx")]
    pub motion_angles: AngleOrder,
}

/// A line from end A (anchor) to end B (fairlead).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Name, the stem of its variables.
    pub name: String,
    /// Point of end A.
    pub from: String,
    /// Point of end B.
    pub to: String,
    /// Sections from A to B.
    pub sections: Vec<Section>,
    /// Number of elements [-] of the whole line, in place of the solver's; sections that have a number of their own keep it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<usize>,
    /// Shape at the start.
    #[serde(default)]
    pub initial: InitialShape,
    /// Shape that bends nothing.
    #[serde(default)]
    pub rest_shape: RestShape,
    /// Direction of the line from A to B at end A [-], where that end is clamped; pinned where absent.
    pub clamped_a: Option<[f64; 3]>,
    /// Direction of the line from A to B at end B [-], where that end is clamped; pinned where absent.
    pub clamped_b: Option<[f64; 3]>,
    /// End that lets go of its point when the host's input `L.release` becomes true; there is no such input where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release: Option<channel::LineEnd>,
    /// When the line parts from one of its points by itself.
    #[serde(default, rename = "break", skip_serializing_if = "Option::is_none")]
    pub parting: Option<Break>,
    /// What pays out and hauls in the line at one of its ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub winch: Option<Winch>,
}

impl Line {
    /// Whether the number of elements of any of its sections is left open.
    pub fn is_open(&self) -> bool {
        self.elements.is_none() && self.sections.iter().any(|section| section.elements.is_none())
    }
}

/// A winch: `{ end = "b", length_max = 40.0, speed_max = 0.5, path = { ramp = [10.0, 0.0, 60.0, 20.0] } }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Winch {
    /// The end of the line that is on the winch.
    pub end: channel::LineEnd,
    /// Greatest length that it pays out beyond the length of the section at its end [m].
    pub length_max: f64,
    /// Greatest speed [m/s]; where a host asks for more, the winch lags behind. No limit where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_max: Option<f64>,
    /// Length paid out in time [m], negative where it is hauled in, where the scene's own motion is followed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<TimeFunction>,
}

/// When a line breaks: `{ at = "b", tension = 4.0e6, time = 100.0 }`, at the first of both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Break {
    /// The end that parts from its point.
    pub at: channel::LineEnd,
    /// Tension of the end's segment that breaks it [N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension: Option<f64>,
    /// Time at which it breaks [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
}

/// The shape of a line that is free of bending and torsion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RestShape {
    /// Straight.
    #[default]
    Straight,
    /// As it lies at the start.
    Initial,
}

/// A part of a line with one line type.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Line type.
    #[serde(rename = "type")]
    pub line_type: String,
    /// Unstretched length [m].
    pub length: f64,
    /// Number of elements; chosen from the tolerance where absent.
    pub elements: Option<usize>,
    /// Number of elements that the line type's `damping_ratio` refers to [-]; where absent, the section's share of
    /// [`DAMPING_ELEMENTS`] of the longest line of its network.
    pub damping_elements: Option<usize>,
}

/// Shape of a line at t = 0, at rest.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InitialShape {
    /// Static equilibrium.
    #[default]
    Static,
    /// On its own closed-form catenary between its points where the scene has them, straight where it has none.
    Catenary,
    /// Straight between its ends.
    Straight,
    /// A parabola that hangs this far [m] below the middle of the chord.
    Parabola(f64),
    /// Given node positions [m], one more than the line has elements.
    Nodes(Vec<[f64; 3]>),
}

/// How to solve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Solver {
    /// Target error of fairlead tension [-].
    pub tolerance: f64,
    /// Elements of a line alone [-], where its sections leave their number open; chosen from the tolerance where absent.
    pub elements: Option<usize>,
    /// Time integrator; `dynamics` is another name of the key.
    #[serde(alias = "dynamics")]
    pub integrator: Integrator,
    /// The peers' law: axial damping acts in compression too.
    pub negative_tension: bool,
    /// Whether the energy that crosses the borders of a scene is booked, which a fifth of an explicit step's time goes into.
    pub energy_ledger: bool,
    /// Upper limit of the internal time step [s].
    pub time_step_max: f64,
    /// Spectral radius at infinite frequency [-] of `generalised_alpha` (0 to 1, default 0.2) or `axial_implicit` (½ to 1, default 0.9);
    /// where `auto` chooses the latter, less than ½ counts as ½.
    pub spectral_radius: Option<f64>,
    /// Parameters of `bossak`.
    pub bossak: Option<Bossak>,
    /// How the path of a coupled point between communication points is built.
    pub input_reconstruction: Reconstruction,
    /// Threads that share the lines of a system [-].
    #[serde(skip_serializing_if = "Threads::is_auto")]
    pub threads: Threads,
}

/// Time integrator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Chosen from the step limits.
    #[default]
    Auto,
    /// Explicit leapfrog.
    Leapfrog,
    /// Leapfrog with the axial tension implicit.
    AxialImplicit,
    /// Chung and Hulbert's generalised-α, fully implicit.
    GeneralisedAlpha,
    /// Wood, Bossak and Zienkiewicz, fully implicit.
    Bossak,
    /// Energy- and momentum-conserving; every line is a beam.
    Beam,
    /// Static equilibrium at every communication point.
    QuasiStatic,
}

/// Parameters of the Bossak scheme [-]; β = (1 − α)²/4.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bossak {
    /// Weight of the old acceleration [-], −1/3 to 0.
    pub alpha: f64,
    /// Newmark's γ [-]; second order needs ½ − α, the default.
    pub gamma: Option<f64>,
}

/// How the path of a coupled point between communication points is built.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reconstruction {
    /// C1 cubic towards the predicted position: second order or better.
    #[default]
    Smooth,
    /// Constant velocity from where the host says the point is, as the peers do: jumps at communication points.
    Jump,
    /// Cubics through what the host says, which holds for the end of the communication step: nothing is predicted. For hosts that know
    /// the motion, or step what moves the point first.
    Interpolate,
}

/// What `moorline run` and the FMU write.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Duration of `moorline run` [s].
    pub duration: f64,
    /// Interval of output and communication [s].
    pub interval: f64,
    /// Node positions and tensions as variables too.
    pub profile: bool,
    /// Further columns of `moorline run`, by MoorDyn's names such as `FairTen1`.
    pub channels: Vec<String>,
}

impl Default for Scene {
    fn default() -> Self {
        Scene {
            title: String::new(),
            gravity: STANDARD_GRAVITY,
            water: None,
            seabed: None,
            line_types: BTreeMap::new(),
            points: Vec::new(),
            lines: Vec::new(),
            vessels: Vec::new(),
            solver: Solver::default(),
            motion: BTreeMap::new(),
            output: Output::default(),
        }
    }
}

impl Point {
    /// A point with nothing but a name, a reference position [m] and what moves it.
    pub fn at(name: impl Into<String>, position: [f64; 3], kind: PointKind) -> Point {
        Point {
            name: name.into(),
            position,
            kind,
            on: None,
            free: None,
            mass: None,
            volume: None,
            drag_area: None,
            added_mass: None,
            force: None,
            moment: None,
            motion: None,
        }
    }
}

impl Line {
    /// Whether one of its ends is at the point of a name.
    pub fn joins(&self, point: &str) -> bool {
        self.from == point || self.to == point
    }

    /// A line between two points that starts in equilibrium.
    pub fn between(
        name: impl Into<String>,
        from: impl Into<String>,
        to: impl Into<String>,
        sections: Vec<Section>,
    ) -> Line {
        Line {
            name: name.into(),
            from: from.into(),
            to: to.into(),
            sections,
            elements: None,
            initial: InitialShape::Static,
            rest_shape: RestShape::Straight,
            clamped_a: None,
            clamped_b: None,
            release: None,
            parting: None,
            winch: None,
        }
    }
}

fn standard_gravity() -> f64 {
    STANDARD_GRAVITY
}

fn steel_poisson() -> f64 {
    0.3
}

impl Default for Solver {
    fn default() -> Self {
        Solver {
            tolerance: 0.02,
            elements: None,
            integrator: Integrator::Auto,
            negative_tension: false,
            energy_ledger: true,
            time_step_max: 0.05,
            spectral_radius: None,
            bossak: None,
            input_reconstruction: Reconstruction::Smooth,
            threads: Threads::Auto,
        }
    }
}

impl Default for Output {
    fn default() -> Self {
        Output {
            duration: 60.0,
            interval: 0.05,
            profile: false,
            channels: Vec::new(),
        }
    }
}
