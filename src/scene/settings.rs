//! Solver and output.

use toml::Value as Toml;

use super::SceneError;
use super::check::Findings;
use super::document::Node;
use super::line::ELEMENTS_MAX;
use super::table::{
    Key, Kind, MIXED, PLAIN, Value, Words, choice, choice_of_values, positive, table, within,
};

table! {
    /// Solver settings.
    pub struct Solver, "`[solver]`" {
        /// Target error of fairlead tension [-].
        pub tolerance: f64 = 0.02 => within(1e-12, 0.5).described("target error of fairlead tension; sets integrator and steps where the \
            scene leaves them open; elements stay those of the packaged scene"),
        /// Quantity whose RMS error, over its standard deviation, the selected mesh and step keep within the tolerance; the deviation of a tension
        /// counts as at least 1 % of its mean.
        pub tolerance_of: ToleranceOf = ToleranceOf::Tension,
        /// Number of elements of lines and sections without a number of their own [-]; of a network, that of its longest line. Selected for the tolerance by default.
        pub elements: Option<usize> => within(1.0, ELEMENTS_MAX).elsewhere(&["segments"]),
        /// Time integrator; `dynamics` is another name of the key.
        pub integrator: Integrator = Integrator::Auto => PLAIN.or_called("dynamics"),
        /// True if axial damping also acts in compression, so that tension may be negative, and the springs of lines that bend do not, as in other codes.
        pub negative_tension: bool = false,
        /// Upper limit of the internal time step [s].
        pub time_step_max: f64 = 0.05 => positive(1e4).elsewhere(&["dtm"]),
        /// Spectral radius at infinite frequency [-] of `generalised_alpha` (0 to 1, default 0.2) or `axial_implicit` (½ to 1, default 0.9); if
        /// `auto` selects the latter, values below ½ count as ½.
        pub spectral_radius: Option<f64> => MIXED.in_units("-"),
        /// Parameters of the integrator `bossak`; by default α = −0.3 and γ = 0.8.
        pub bossak: Option<Bossak>,
        /// Path of a coupled point between communication points.
        pub input_reconstruction: Reconstruction = Reconstruction::Smooth => PLAIN.described("path of a coupled point between communication \
            points: 0 smooth, 1 constant velocity with a jump, 2 cubics through inputs that hold for the end of the step, 3 smooth with a noise filter"),
        /// Number of threads that share the lines [-], 1 to 256, or `"auto"`. Results do not depend on it.
        pub threads: Threads = Threads::Auto,
    }
}

choice! {
    /// Quantity that a tolerance refers to.
    pub enum ToleranceOf {
        /// Tension at the driven end of every line.
        Tension = "tension",
        /// The same tension, low-passed: below five times the frequency of the fastest sine of the motion, or 0.5 Hz where it has none.
        LowPassedTension = "low_passed_tension",
        /// Positions of the points at a quarter, a half and three quarters of every line's length.
        Position = "position",
    }
}

impl ToleranceOf {
    /// Name of the quantity in a sentence.
    pub(super) fn in_words(self) -> &'static str {
        match self {
            ToleranceOf::Tension => "fairlead tension",
            ToleranceOf::LowPassedTension => "low-passed fairlead tension",
            ToleranceOf::Position => "positions along lines",
        }
    }
}

choice! {
    /// Time integrator.
    pub enum Integrator {
        /// Automatic, from the step limits.
        Auto = "auto",
        /// Explicit leapfrog.
        Leapfrog = "leapfrog",
        /// Leapfrog with the axial tension implicit.
        AxialImplicit = "axial_implicit",
        /// Chung and Hulbert's generalised-α, fully implicit.
        GeneralisedAlpha = "generalised_alpha",
        /// Wood, Bossak and Zienkiewicz, fully implicit.
        Bossak = "bossak",
        /// Energy- and momentum-conserving; every line is a beam.
        Beam = "beam",
        /// Static equilibrium at every communication point.
        QuasiStatic = "quasi_static",
    }
}

table! {
    /// Parameters of the Bossak scheme; β = (1 − α)²/4.
    #[derive(Copy)]
    pub struct Bossak, "`bossak`" {
        /// Weight of the old acceleration [-], −1/3 to 0.
        pub alpha: f64 => MIXED.in_units("-"),
        /// Newmark's γ [-]; second order needs ½ − α, the default.
        pub gamma: Option<f64> => within(0.5, 1.5),
    }
}

choice! {
    /// Path of a coupled point between communication points.
    pub enum Reconstruction {
        /// C1 cubic towards the predicted position: second order or better.
        Smooth = "smooth",
        /// Constant velocity from the position given by the host, as in other codes: the point jumps at communication points.
        Jump = "jump",
        /// Cubics through inputs that apply at the end of the communication step, without prediction: for hosts that know the motion, or that step the floating body first.
        Interpolate = "interpolate",
        /// As `smooth`, with a noise filter for displacements that are given without velocities. The memory of the filter follows from their scatter.
        Filtered = "filtered",
    }
}

table! {
    /// Output of `moorline run` and of the FMU.
    pub struct Output, "`[output]`" {
        /// Duration of `moorline run` [s].
        pub duration: f64 = 60.0 => positive(1e9).elsewhere(&["tmax"]),
        /// Interval of output and communication [s].
        pub interval: f64 = 0.05 => positive(1e9).elsewhere(&["dtout", "dt"]),
        /// Node positions and tensions as variables too: `true` or `array` gives arrays in FMI 3.0, `scalar` one variable for each node in both versions.
        pub profile: Profile = Profile::None,
        /// True if the energy balance is evaluated, with `solver.energy_error` and `solver.power_residual`; explicit steps then cost 50 to
        /// 100 % more.
        pub energy_balance: bool = false,
        /// Force `fx` … of a coupled point or a vessel in the variables.
        pub force: ForceOutput = ForceOutput::Total,
        /// Additional variables for hosts that solve for a body together with its mooring; by default none.
        pub interface: Option<InterfaceOutput>,
        /// True if the quasi-static stiffness of the mooring on every vessel is a variable.
        pub stiffness: bool = false,
        /// True if forces have derivatives with respect to the motion at the end of a step, FMI's directional derivatives, and to time. The state at
        /// the start of each step is then kept.
        pub derivatives: bool = false,
        /// Additional columns of `moorline run`, by MoorDyn's names such as `FairTen1`.
        pub channels: Vec<String> = Vec::new(),
        /// Format of the tables of `moorline run`; by default `csv`.
        pub format: Option<Format>,
        /// Significant digits of the results in the tables of `moorline run` [-]; by default all. Times and counts keep theirs. In Parquet, 6 digits or
        /// fewer are stored as 32-bit numbers.
        pub digits: Option<usize> => within(1.0, DIGITS_MAX),
        /// Files that `moorline run` writes for ParaView; by default `overview`.
        pub frames: Option<Frames>,
    }
}

/// Form of node positions and tensions among the variables.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Profile {
    /// Node positions and tensions are not variables.
    #[default]
    None,
    /// Arrays in FMI 3.0; scalars in FMI 2.0, which has no arrays.
    Array,
    /// One scalar for each node.
    Scalar,
}

impl Profile {
    /// Words of the key, in addition to `true` and `false`.
    const WORDS: Words = Words {
        name: "Profile",
        words: &[
            (
                "array",
                "As arrays in FMI 3.0, which some hosts cannot read; FMI 2.0 gets scalars. `true` means the same.",
            ),
            ("scalar", "One variable for each node, in FMI 2.0 and 3.0."),
        ],
    };

    /// Returns whether nodes are among the variables.
    pub fn is_given(self) -> bool {
        self != Profile::None
    }
}

impl Value for Profile {
    fn kind() -> Kind {
        Kind::Words(Profile::WORDS)
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        *self = match (node.text(), node.truth()) {
            (Ok("array"), _) | (_, Ok(true)) => Profile::Array,
            (Ok("scalar"), _) => Profile::Scalar,
            (_, Ok(false)) => Profile::None,
            _ => return Err(node.expected("true, false, \"array\" or \"scalar\"")),
        };
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        Some(match self {
            Profile::None => false.into(),
            Profile::Array => true.into(),
            Profile::Scalar => "scalar".into(),
        })
    }
}

/// Number of digits with which every number is read back bit for bit [-].
const DIGITS_MAX: f64 = 17.0;

choice! {
    /// Force on coupled points and vessels.
    pub enum ForceOutput {
        /// Reaction with the inertia of the half elements at the end.
        Total = "total",
        /// Reaction without the mass of the end times its acceleration, for hosts that account for this mass.
        WithoutInertia = "without_inertia",
    }
}

choice! {
    /// Variables for hosts that solve for a body together with its mooring.
    pub enum InterfaceOutput {
        /// Mass of the line ends on the body.
        Mass = "mass",
        /// The mass, and force, stiffness and damping over the coming step.
        Impedance = "impedance",
    }
}

choice! {
    /// Format of tables.
    pub enum Format {
        /// Comma-separated values, with their units in `results.units.csv`.
        Csv = "csv",
        /// Apache Parquet, with the units in the metadata of the fields.
        Parquet = "parquet",
    }
}

choice_of_values! {
    /// Shapes for ParaView.
    #[derive(Copy)]
    pub enum Frames {
        /// About 240, evenly over the run, or all rows where there are fewer.
        Overview = "overview",
        /// None.
        None = "none";
        /// `{ every = interval }`: one every `interval` [s], a multiple of the output interval, and the last one.
        Every(f64) = "every" => positive(1e9).in_units("s"),
    }
}

/// Number of threads that share the lines of a system. Results do not depend on it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Threads {
    /// As many as shorten the run: one for a few lines.
    #[default]
    Auto,
    /// This number [-], or the number of networks of lines if that is less.
    Number(usize),
}

impl Value for Threads {
    fn kind() -> Kind {
        Kind::Count
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        *self = match node.text() {
            Ok("auto") => Threads::Auto,
            _ => Threads::Number(node.count("a number of threads, or \"auto\"")? as usize),
        };
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        match self {
            Threads::Auto => None,
            Threads::Number(number) => number.write(),
        }
    }

    fn check(&self, _: &Key, findings: &mut Findings) {
        if let Threads::Number(number) = self {
            findings.number("", *number as f64, within(1.0, 256.0).bounds, "-");
        }
    }
}
