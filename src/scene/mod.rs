//! The scene as the user described it: plain data, SI units, nothing computed. Anything left out is `None`.
//!
//! A scene comes from a TOML file ([`load`]) or from TOML text ([`Scene::from_toml`]); every mistake names its key, line and
//! column. [`Scene::notes`] lists remarks on a scene that can be used as it is, [`Scene::in_words`] describes the model.
//! [`crate::model::Model::new`] builds the solver's model from a scene.
//!
//! # The property table
//!
//! Each key of the scene format has one entry, a field of a struct inside the macro `table!`:
//!
//! ```text
//! table! {
//!     /// Properties of a line per unstretched length.
//!     pub struct LineType, "`[line_types.NAME]`" {
//!         /// Normal drag coefficient on the diameter [-].
//!         pub drag_normal: Option<f64> => not_negative(1e3).usual([0.0, 5.0], "0 to 5 is usual").acts(Acts::InFlow)
//!             .elsewhere(&["cd", "cdn"]).label("normal drag coefficient").absence("normal drag").parameter(),
//!         /// Model of the line's elements.
//!         pub model: LineModel = LineModel::Cable,
//!     }
//! }
//! ```
//!
//! The doc comment is the text of the reference page. It also gives the unit of the number, and its beginning is the name of the property in
//! messages and in the FMU. A field of type `Option`, or with a default after `=`, may be left out. A [`table::Rule`] follows `=>`: bounds, the
//! range usual in moorings, names in other programs, the circumstances under which the property acts, and whether it is a parameter of the FMU.
//! The macro declares the struct and implements [`table::Table`] for it: a list of [`table::Key`]s and their values, each a [`table::Value`] that
//! reads, writes and checks itself. `choice!` declares choices of words in the same manner, and `choice_of_values!` those whose words hold
//! values. Everything else is a loop over keys and values:
//!
//! | loop | for |
//! |---|---|
//! | `Table::read` in [`table`] | reading, required and unknown keys, "did you mean" (with `nearest`), units in messages |
//! | `Table::write` | TOML; `commented` adds the units |
//! | `check_table` | bounds; `check/` adds the refusals that concern several keys |
//! | `plausibility` | notes on unusual values; the rules on several keys are next to it |
//! | `idle` | notes on keys without effect |
//! | `words` | sentences of `moorline check` |
//! | [`crate::interface`] | parameters of the FMU, and the results that depend on them |
//! | [`page`] | the reference in `docs/scene.md` |
//! | [`keys`] | the list of all keys, which tests iterate over |
//!
//! Refusals and notes that concern several keys are also in tables: each row of `rules!` is a key, a condition and a sentence.
//!
//! Values that are not single numbers (tension over strain, friction by direction, functions of time, motions, seas) implement
//! [`table::Value`] by hand next to their type; their keys are also declared by `table!`.

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
mod line;
mod line_type;
mod motion_file;
mod names;
pub mod nearest;
mod notes;
pub mod page;
pub mod path;
mod periods;
mod places;
pub mod plausibility;
mod point;
mod read;
pub mod rows;
mod seabed;
mod settings;
mod slips;
mod surface;
pub mod table;
mod table_ends;
mod tension_strain;
mod time_function;
pub mod units;
mod value;
mod water;
mod water_file;
mod words;

use std::collections::BTreeMap;

use nalgebra::Vector3;

pub use crate::math::attitude::Order as AngleOrder;
pub use check::name_problem;
pub use drive::{Drive, RegularMotion};
pub use error::{LoadError, SceneError};
pub use line::{Break, InitialShape, Line, LineEnd, RestShape, Section, Winch};
pub use line_type::{FibreLaw, LineModel, LineType, Rayleigh, SolidSection, Strain};
pub(crate) use names::Names;
pub use notes::Note;
pub use places::Places;
pub use point::{Axis, Point, PointForce, PointKind, PointMoment, Vessel};
pub use read::{LoadedScene, TOML, folder_of, is_toml, load, load_text, part, read_text};
pub use seabed::{ContactLaw, DepthGrid, Friction, Seabed};
pub use settings::{
    Bossak, ForceOutput, Format, Frames, Integrator, InterfaceOutput, Output, Profile, Reconstruction,
    Solver, Threads, ToleranceOf,
};
use table::{not_negative, table};
pub use tension_strain::TensionStrain;
pub use time_function::{HarmonicMotion, MotionFile, MotionPath, MotionRow, TimeFunction};
pub use water::{Current, FlowSource, RegularWave, Sea, SpectrumKind, Water, WaveComponents, Waves};
pub(crate) use words::{few, instant, metres, percent};

/// Standard gravity [m/s²], the default of [`Scene::gravity`].
pub const STANDARD_GRAVITY: f64 = 9.80665;
/// Number of elements of a single line that a damping ratio refers to [-], as given by the default tolerance. The resulting damping BA is a
/// property of the line and the same on every mesh, so that results converge as the mesh is refined.
pub(crate) const DAMPING_ELEMENTS: usize = 40;
/// Axial damping ratio [-] of a line whose type leaves the damping open, relative to critical damping of one of [`DAMPING_ELEMENTS`] elements, or
/// of the actual element if that is longer. Without damping, the kink of the tension law drives a line that slackens and snaps when the step is
/// explicit; explicit codes damp the highest axial frequencies, which no mesh resolves, by the same amount (linear bulk viscosity).
pub(crate) const NUMERICAL_DAMPING_RATIO: f64 = 0.02;
/// Smallest spectral radius at infinite frequency of `axial_implicit` [-], which gives the strongest damping.
pub const AXIAL_RADIUS_MIN: f64 = 0.5;

table! {
    /// One mooring scene as the user described it.
    pub struct Scene, "the scene" {
        /// Title, in a line.
        pub title: String = String::new(),
        /// Gravitational acceleration [m/s²].
        pub gravity: f64 = STANDARD_GRAVITY => not_negative(1e3).elsewhere(&["g", "grav"])
            .hint("gravity is a magnitude, downwards along z")
            .usual([9.0, 10.0], "9.80665 m/s² is usual, and 0 without gravity").parameter(),
        /// Water; without it there is no buoyancy, drag or added mass.
        pub water: Option<Water>,
        /// Seabed; without it there is no contact.
        pub seabed: Option<Seabed>,
        /// Line types by name.
        pub line_types: BTreeMap<String, LineType> = BTreeMap::new() => table::PLAIN.elsewhere(&["rope"]),
        /// Points that lines end at.
        pub points: Vec<Point> = Vec::new() => table::PLAIN.elsewhere(&["nodes"]),
        /// Lines between points.
        pub lines: Vec<Line> = Vec::new(),
        /// Floating bodies that carry points, driven by the host.
        pub vessels: Vec<Vessel> = Vec::new(),
        /// Solver settings.
        pub solver: Solver = Solver::default(),
        /// Motions of the coupled points and the vessels in `moorline run`, by name.
        pub motion: BTreeMap<String, MotionPath> = BTreeMap::new(),
        /// Output of `moorline run` and of the FMU.
        pub output: Output = Output::default(),
    }
}

impl Scene {
    /// Current, if the scene has one.
    fn current(&self) -> Option<&Current> {
        self.water.as_ref()?.current.as_ref()
    }

    /// Returns whether the host gives the flow of the water.
    fn has_host_flow(&self) -> bool {
        self.water.as_ref().is_some_and(|water| water.flow.is_some())
    }

    /// Position of a point in the reference configuration, global axes [m]; `None` if its vessel is missing.
    pub fn reference_position(&self, point: &Point) -> Option<[f64; 3]> {
        let Some(carrier) = &point.on else {
            return Some(point.position);
        };
        let vessel = self.vessel(carrier)?;
        let turn = AngleOrder::Zyx.rotation(vessel.attitude.into());
        Some((Vector3::from(vessel.position) + turn * Vector3::from(point.position)).into())
    }

    /// Waves, if the scene has any.
    fn waves(&self) -> Option<&Waves> {
        self.water.as_ref()?.waves.as_ref()
    }

    /// The point with this name.
    fn point(&self, name: &str) -> Option<&Point> {
        self.points.iter().find(|point| point.name == name)
    }

    /// Points that move under forces.
    fn free_points(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(|point| point.kind == PointKind::Free)
    }

    /// The vessel with this name.
    fn vessel(&self, name: &str) -> Option<&Vessel> {
        self.vessels.iter().find(|vessel| vessel.name == name)
    }

    /// Names of points, lines and vessels, which share the namespace of the FMU's variables, each with the key path of its owner.
    fn names(&self) -> impl Iterator<Item = (String, &str)> {
        let points = self.points.iter().enumerate();
        let points = points.map(|(i, point)| (format!("points[{i}]"), &point.name[..]));
        let lines = self.lines.iter().enumerate();
        let lines = lines.map(|(i, line)| (format!("lines[{i}]"), &line.name[..]));
        let vessels = self.vessels.iter().enumerate();
        let vessels = vessels.map(|(i, vessel)| (format!("vessels[{i}]"), &vessel.name[..]));
        points.chain(lines).chain(vessels)
    }

    /// Sections of all lines.
    fn sections(&self) -> impl Iterator<Item = &Section> {
        self.lines.iter().flat_map(|line| &line.sections)
    }

    /// Line types of the sections of a line; sections without a line type in the scene are skipped.
    fn types_of(&self, line: &Line) -> impl Iterator<Item = &LineType> {
        line.sections.iter().filter_map(|section| self.type_of(section))
    }

    /// Line type of a section, if the scene has it.
    fn type_of(&self, section: &Section) -> Option<&LineType> {
        self.line_types.get(&section.line_type)
    }
}
