//! Line types: properties of a line per unstretched length.

use super::check::number;
use super::table::{Acts, PLAIN, choice, choice_of_values, magnitude, not_negative, positive, table, within};
use super::{Integrator, Line, Scene, TensionStrain};
use crate::math::circle;

table! {
    /// Properties of a line per unstretched length. Give `mass` or `weight`, and `diameter` where there is water or a seabed.
    pub struct LineType, "`[line_types.NAME]`" {
        /// Model of the line's elements.
        pub model: LineModel = LineModel::Cable,
        /// Axial stiffness EA [N].
        pub axial_stiffness: Option<f64> => positive(1e15).elsewhere(&["ea"]).instead_of(&["tension_strain"]).parameter(),
        /// Tension over strain, instead of `axial_stiffness`: rows of strain [-] and tension [N] that begin at [0, 0] and rise, or the `file` with
        /// such rows.
        pub tension_strain: Option<TensionStrain> => PLAIN.in_units("- and N").label("tension"),
        /// Static stiffness of a viscoelastic rope [N]: EA_s, at rest and in slow motion.
        pub static_stiffness: Option<f64> => positive(1e15).elsewhere(&["ea_s"]).parameter(),
        /// Dynamic stiffness of a viscoelastic rope [N]: EA_d, in fast motion.
        pub dynamic_stiffness: Option<f64> => positive(1e15).elsewhere(&["ea_d"]).acts(Acts::InMotion).parameter(),
        /// Damping of the slow part of a viscoelastic rope [N s]: BA_s.
        pub static_damping: Option<f64> => positive(1e15).elsewhere(&["ba_s"]).acts(Acts::InMotion).parameter(),
        /// Damping of the fast part of a viscoelastic rope [N s]: BA_d.
        pub dynamic_damping: Option<f64> => not_negative(1e15).elsewhere(&["ba_d"]).acts(Acts::InMotion).parameter(),
        /// Bending stiffness EI of one solid section [N m²]; absent or 0, the line is perfectly flexible.
        pub bending_stiffness: Option<f64> => not_negative(1e15).elsewhere(&["ei"]).label("bending stiffness EI").parameter(),
        /// Shear stiffness GA of beams [N].
        pub shear_stiffness: Option<f64> => positive(1e15).elsewhere(&["ga"]).label("shear stiffness GA").parameter(),
        /// Torsional stiffness GJ of beams [N m²].
        pub torsional_stiffness: Option<f64> => positive(1e15).elsewhere(&["gj"]).label("torsional stiffness GJ").parameter(),
        /// Rotary inertia of a beam's section per unstretched length [kg m], about any axis.
        pub rotary_inertia: Option<f64> => positive(1e9).label("rotary inertia").acts(Acts::InMotion).parameter(),
        /// Mass in air per unstretched length [kg/m]; by default weight/gravity.
        pub mass: Option<f64> => not_negative(1e6).elsewhere(&["mass/l", "massden", "m"]).label("mass").parameter(),
        /// Weight in water, or in air without water, per unstretched length [N/m], reduced by buoyancy.
        pub weight: Option<f64> => magnitude(1e8).elsewhere(&["w"]).label("weight").parameter(),
        /// Volume-equivalent diameter [m].
        pub diameter: Option<f64> => positive(100.0).elsewhere(&["diam", "d"]).label("diameter").parameter(),
        /// Axial damping BA [N s].
        pub axial_damping: Option<f64> => not_negative(1e15).elsewhere(&["ba"]).acts(Acts::InMotion).parameter(),
        /// Axial damping as a ratio of the critical damping of each segment [-]; instead of `axial_damping`. It is converted to one BA for all
        /// meshes, see `damping_elements` of a section.
        pub damping_ratio: Option<f64> => RATIO.label("axial damping ratio").acts(Acts::InMotion)
            .instead_of(&["axial_damping", "dynamic_damping"]).parameter(),
        /// Rayleigh damping, in addition to the axial damping.
        pub rayleigh: Option<Rayleigh> => PLAIN.label("Rayleigh damping").acts(Acts::InMotion),
        /// Strain measure that EA multiplies.
        pub strain: Strain = Strain::Engineering,
        /// Normal drag coefficient on the diameter [-].
        pub drag_normal: Option<f64> => coefficient(Acts::InFlow).elsewhere(&["cd", "cdn"])
            .label("normal drag coefficient").absence("normal drag"),
        /// Tangential drag coefficient on pi times the diameter [-].
        pub drag_tangential: Option<f64> => coefficient(Acts::InFlow).elsewhere(&["cdax", "cdt"])
            .label("tangential drag coefficient").absence("tangential drag"),
        /// Normal added-mass coefficient on the displaced volume [-].
        pub added_mass_normal: Option<f64> => coefficient(Acts::InAccelerations).elsewhere(&["ca", "can"])
            .label("normal added-mass coefficient").absence("normal added mass"),
        /// Tangential added-mass coefficient on the displaced volume [-].
        pub added_mass_tangential: Option<f64> => coefficient(Acts::InAccelerations).elsewhere(&["caax", "cat"])
            .label("tangential added-mass coefficient").absence("tangential added mass"),
        /// Solid round section, from which EI = Eπd⁴/64 follows where it is not given, and GA, GJ and rotary inertia of beams.
        pub solid_section: Option<SolidSection> => PLAIN.label("solid round section"),
        /// Number of loose strands that share the section [-]; by default 1.
        pub fibres: Option<usize> => within(1.0, 1e9).label("number of fibres"),
        /// Law by which the bending stiffness falls with the number of fibres.
        pub fibre_law: FibreLaw = FibreLaw::Linear => PLAIN.label("fibre law"),
    }
}

/// The rule of damping ratios.
const RATIO: super::table::Rule = not_negative(100.0).usual([0.0, 1.0], "0 to 1 is usual, 1 being critical");

/// Rule of drag and added-mass coefficients: 3.8 has been measured for model chains.
const fn coefficient(acts: Acts) -> super::table::Rule {
    not_negative(1e3)
        .usual([0.0, 5.0], "0 to 5 is usual")
        .acts(acts)
        .parameter()
}

impl LineType {
    /// Returns whether there is a bending stiffness: the given one, otherwise that of the solid section.
    pub fn bends(&self) -> bool {
        let of_section = self.solid_section.is_some();
        self.bending_stiffness.map_or(of_section, |ei| ei > 0.0)
    }

    /// Returns whether no key sets the axial damping, so that segments have [`super::NUMERICAL_DAMPING_RATIO`]; beams then have none.
    pub(crate) fn leaves_damping_open(&self) -> bool {
        self.axial_damping.is_none()
            && self.damping_ratio.is_none()
            && self.dynamic_damping.is_none()
            && self.rayleigh.is_none()
    }
}

impl Scene {
    /// Mass per unstretched length [kg/m]: the given one, otherwise weight/gravity.
    pub(super) fn mass(&self, line_type: &LineType) -> f64 {
        let of_weight = || line_type.weight.map(|weight| weight / self.gravity);
        line_type.mass.or_else(of_weight).unwrap_or(0.0)
    }

    /// Weight per unstretched length in the scene's surroundings [N/m].
    pub(super) fn weight(&self, line_type: &LineType) -> f64 {
        let displaced = match (&self.water, line_type.diameter) {
            (Some(water), Some(diameter)) => water.density * circle::area(diameter),
            _ => 0.0,
        };
        let wet = || (self.mass(line_type) - displaced) * self.gravity;
        line_type.weight.unwrap_or_else(wet)
    }

    /// Returns whether a line is a beam.
    pub(super) fn is_beam(&self, line: &Line) -> bool {
        self.types_of(line).any(|line_type| self.makes_beams(line_type))
    }

    /// Returns whether lines of a line type are beams: by its model, or because the integrator treats every line as a beam.
    pub(crate) fn makes_beams(&self, line_type: &LineType) -> bool {
        self.solver.integrator == Integrator::Beam || line_type.model == LineModel::Beam
    }

    /// Name of the first line type whose lines are beams and that meets a condition.
    pub(super) fn type_of_beams(&self, meets: impl Fn(&LineType) -> bool) -> Option<&str> {
        let mut types = self.line_types.iter();
        let found = types.find(|(_, line_type)| self.makes_beams(line_type) && meets(line_type));
        found.map(|(name, _)| name.as_str())
    }

    /// Returns whether all lines are beams.
    pub(super) fn all_beams(&self) -> bool {
        !self.lines.is_empty() && self.lines.iter().all(|line| self.is_beam(line))
    }
}

choice! {
    /// Model of the elements of a line.
    pub enum LineModel {
        /// Stretch, and bending where there is a bending stiffness.
        Cable = "cable",
        /// Stretch, shear, bending and torsion, with rotary inertia: the geometrically exact beam.
        Beam = "beam",
    }
}

table! {
    /// A solid round section of one material.
    #[derive(Copy)]
    pub struct SolidSection, "`solid_section`" {
        /// Diameter of the load-bearing section [m].
        pub diameter: f64 => positive(100.0),
        /// Young's modulus E [Pa].
        pub youngs_modulus: f64 => positive(1e15).elsewhere(&["e"])
            .usual([1e6, 1e13], "1e6 Pa and more is usual, and 2.1e11 Pa of steel"),
        /// Poisson's ratio ν [-], for shear and torsion.
        pub poisson: f64 = STEEL_POISSON => within(0.0, 0.5).elsewhere(&["nu"]),
    }
}

/// Poisson's ratio of steel [-].
pub(super) const STEEL_POISSON: f64 = 0.3;

choice! {
    /// Law by which bending stiffness falls with the number n of loose strands that share a section.
    pub enum FibreLaw {
        /// EI/n: n round strands of the same total area, each of 1/n² of the EI, bend side by side.
        Linear = "linear",
        /// EI/n²: the stiffness of a single strand.
        Squared = "squared",
    }
}

table! {
    /// Damping ratios at two circular frequencies, which fix C = α·M + β·K.
    #[derive(Copy)]
    pub struct Rayleigh, "`rayleigh`" {
        /// Damping ratios at the two frequencies [-].
        pub ratios: [f64; 2] => RATIO.label("ratios"),
        /// Circular frequencies [rad/s].
        pub frequencies: [f64; 2] => positive(1e9).label("at"),
    }
}

choice_of_values! {
    /// Strain measure.
    #[derive(Copy)]
    pub enum Strain {
        /// ε = λ − 1.
        Engineering = "engineering",
        /// Green-Lagrange, ε = (λ² − 1)/2.
        Green = "green";
        /// `{ logarithmic = ν }`: Hencky, ε = ln λ on the current area A·λ^(−2ν), with Poisson's ratio ν [-], 0 to ½.
        Logarithmic(f64) = "logarithmic" => within(0.0, 0.5).in_units("-"),
    }
}

impl Strain {
    /// Name in a sentence.
    pub(super) fn name(self) -> String {
        match self {
            Strain::Engineering => "engineering".to_string(),
            Strain::Green => "Green-Lagrange".to_string(),
            Strain::Logarithmic(poisson) => format!("logarithmic (Poisson's ratio {})", number(poisson)),
        }
    }
}
