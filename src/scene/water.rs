//! Water, current and waves.

use toml::Value as Toml;

use super::check::{Bounds, Findings, rules};
use super::document::Node;
use super::table::{Key, Kind, MIXED, PLAIN, Rule, Table, Value, choice, magnitude, positive, table, within};
use super::{SceneError, TimeFunction};

table! {
    /// Water. The free surface is at z = 0 for free points and for lines that may come out of the water; other lines are always submerged.
    pub struct Water, "`[water]`" {
        /// Density of the water [kg/m³].
        pub density: f64 => positive(1e5).elsewhere(&["rho", "wtrdnsty", "rhow"])
            .usual([900.0, 1100.0], "1000 to 1030 kg/m³ is usual").parameter(),
        /// Current; by default still water.
        pub current: Option<Current>,
        /// Waves: one sea, or an array of seas that add up.
        pub waves: Option<Waves>,
        /// Velocity and acceleration of the water at every node, from the host instead of from `waves`. A `current` is added to them. The surface
        /// stays at z = 0.
        pub flow: Option<FlowSource> => PLAIN.instead_of(&["waves"]),
        /// True if lines lose buoyancy, drag and added mass above z = 0. By default, lines do that have an end above it, or that could float up to it.
        pub surface: Option<bool>,
    }
}

choice! {
    /// Source of the motion of the water at the nodes.
    pub enum FlowSource {
        /// The host that the mooring is coupled to, such as a CFD code; without a host the water is at rest.
        Host = "host",
    }
}

impl Water {
    /// Returns whether the water accelerates: in waves, or as the host gives it.
    pub fn accelerates(&self) -> bool {
        self.waves.is_some() || self.flow.is_some()
    }

    /// Still water of a density [kg/m³].
    pub fn still(density: f64) -> Water {
        Water {
            density,
            ..Water::default()
        }
    }
}

/// Bounds of the water velocity [m/s]; the strongest tidal streams reach 10 m/s.
pub(super) const SPEED: Rule = magnitude(100.0).usual(
    [-SPEED_USUAL, SPEED_USUAL],
    "less than 5 m/s in any direction is usual",
);
/// Fastest current that is usual for moorings [m/s].
pub(super) const SPEED_USUAL: f64 = 5.0;

table! {
    /// A current: a uniform `velocity`, or a `profile` over depth, which may be in a `file`; `factor` is a function of time that multiplies it.
    pub struct Current, "`current`" {
        /// Velocity, uniform over depth [m/s].
        pub velocity: Option<[f64; 3]> => SPEED,
        /// File in MoorDyn's format with the profile: three header lines, then rows of z [m] and vx, vy, vz [m/s].
        pub file: Option<String>,
        /// Rows of height z [m] and horizontal velocity vx, vy [m/s], no two at the same height; linear between rows and constant outside.
        pub profile: Option<Vec<[f64; 3]>> => MIXED.in_units("m, m/s"),
        /// Factor of the velocity in time [-]; by default 1.
        pub factor: Option<TimeFunction>,
    }
}

/// Seas that add up, such as swell and a wind sea.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Waves {
    /// The seas.
    pub seas: Vec<Sea>,
}

/// Periods of waves [s]: from ripples in a tank to tides.
const PERIOD: Rule = within(0.05, 1e5);
/// Directions and phases [rad].
const ANGLE: Rule = magnitude(1e6);
/// Wave heights [m]; the highest wave ever measured had 32 m.
const HEIGHT: Rule = positive(100.0);

table! {
    /// A sea: `regular`, rows of `components`, a `file` of them, or a `spectrum`, with a `ramp`.
    pub struct Sea, "`waves`, each sea" {
        /// One regular wave.
        pub regular: Option<RegularWave>,
        /// Rows of amplitude [m], period [s], direction [rad] and phase [rad]; or, of a spectrum, the number of components.
        pub components: Option<WaveComponents> => MIXED.in_units("m, s, rad, rad"),
        /// File in MoorDyn's format with the components: rows of ω [rad/s], real and imaginary part of the amplitude [m] of sin(ωt − kx) and
        /// direction [rad].
        pub file: Option<String>,
        /// Spectrum from which components are drawn.
        pub spectrum: Option<SpectrumKind>,
        /// Significant height of a spectrum [m], four standard deviations of the elevation.
        pub significant_height: Option<f64> => HEIGHT.elsewhere(&["hs", "wavehs"]),
        /// Period of a spectrum's peak [s].
        pub peak_period: Option<f64> => PERIOD.elsewhere(&["tp", "wavetp"]),
        /// Peakedness γ of a JONSWAP spectrum [-]; by default 3.3.
        pub peakedness: Option<f64> => within(1.0, 10.0).elsewhere(&["gamma"]),
        /// Mean direction in which a spectrum's waves travel, from x towards y [rad]; by default 0.
        pub direction: Option<f64> => ANGLE,
        /// Exponent s of the spread cos²ˢ(½(θ − direction)) of a spectrum's directions [-]; by default one direction.
        pub spreading: Option<f64> => within(0.0, 1000.0),
        /// Seed of the frequencies, phases and directions of a spectrum's components [-]; by default the index of the sea in the list, from 0.
        pub seed: Option<u64>,
        /// Duration of the cosine ramp ½(1 − cos(πt/ramp)) of all seas [s]; by default none.
        pub ramp: Option<f64> => positive(1e9),
    }
}

table! {
    /// One regular wave, η = a cos(k·x − ωt + phase). Give its `height` or its `amplitude`.
    pub struct RegularWave, "`regular`" {
        /// Height from trough to crest [m].
        pub height: Option<f64> => HEIGHT,
        /// Half the height [m].
        pub amplitude: Option<f64> => HEIGHT,
        /// Period [s].
        pub period: f64 => PERIOD,
        /// Direction of travel, from x towards y [rad].
        pub direction: f64 = 0.0 => ANGLE,
        /// Phase [rad]; with 0 a crest is at x = y = 0 at t = 0.
        pub phase: f64 = 0.0 => ANGLE,
    }
}

choice! {
    /// Shape of a spectrum.
    pub enum SpectrumKind {
        /// A growing sea (Hasselmann et al. 1973).
        Jonswap = "jonswap",
        /// A fully developed sea (Pierson & Moskowitz 1964).
        PiersonMoskowitz = "pierson_moskowitz",
    }
}

/// Components as a list, or their number.
#[derive(Debug, Clone, PartialEq)]
pub enum WaveComponents {
    /// Rows of amplitude [m], period [s], direction [rad], phase [rad].
    Rows(Vec<[f64; 4]>),
    /// Number of components that are drawn from a spectrum [-].
    Number(u64),
}

/// Default number of components drawn from a spectrum [-].
const COMPONENTS: u64 = 100;
/// Default peakedness of a JONSWAP spectrum [-], the mean of the measurements.
const PEAKEDNESS: f64 = 3.3;

impl Sea {
    /// Number of components that are drawn from the spectrum [-].
    pub fn number(&self) -> u64 {
        match self.components {
            Some(WaveComponents::Number(number)) => number,
            _ => COMPONENTS,
        }
    }

    /// Seed of a spectrum [-], at a place in the list of seas; `None` for other seas.
    pub fn spectrum_seed(&self, place: u64) -> Option<u64> {
        self.spectrum.as_ref().map(|_| self.seed.unwrap_or(place))
    }

    /// Variance of the elevation [m²].
    pub fn variance(&self) -> f64 {
        if let Some(regular) = &self.regular {
            return 0.5 * regular.half_height().unwrap_or_default().powi(2);
        }
        match &self.components {
            Some(WaveComponents::Rows(rows)) => rows.iter().map(|row| 0.5 * row[0] * row[0]).sum(),
            _ => (0.25 * self.significant_height.unwrap_or_default()).powi(2),
        }
    }

    /// Peakedness γ of the spectrum [-]; 1 for a Pierson-Moskowitz spectrum.
    pub fn gamma(&self) -> f64 {
        match self.spectrum {
            Some(SpectrumKind::PiersonMoskowitz) => 1.0,
            _ => self.peakedness.unwrap_or(PEAKEDNESS),
        }
    }
}

impl RegularWave {
    /// Half the height [m]; `None` unless either the height or the amplitude is given.
    pub(crate) fn half_height(&self) -> Option<f64> {
        match (self.height, self.amplitude) {
            (Some(height), None) => Some(0.5 * height),
            (None, amplitude) => amplitude,
            (Some(_), Some(_)) => None,
        }
    }
}

impl Waves {
    /// Standard deviation of the elevation [m].
    pub fn deviation(&self) -> f64 {
        self.seas.iter().map(Sea::variance).sum::<f64>().sqrt()
    }

    /// Duration of the ramp [s], if one of the seas has one.
    pub fn ramp(&self) -> Option<f64> {
        self.seas.iter().find_map(|sea| sea.ramp)
    }
}

impl Waves {
    /// Key path of a sea.
    pub(super) fn path(&self, index: usize) -> String {
        match self.seas.len() {
            1 => "water.waves".to_string(),
            _ => format!("water.waves[{index}]"),
        }
    }
}

impl Value for Waves {
    fn kind() -> Kind {
        Kind::Table(Sea::SCHEMA)
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        if node.elements().is_some() {
            return self.seas.read(node);
        }
        if node.entries().is_none() {
            return Err(node.expected(
                "a sea, { regular = { height, period } }, { components = [[amplitude, period, direction, phase], …] } or \
                 { spectrum = \"jonswap\", significant_height, peak_period }, or an array of seas",
            ));
        }
        self.seas = vec![node.read()?];
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        match self.seas.as_slice() {
            [sea] => sea.write(),
            _ => self.seas.write(),
        }
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        match self.seas.as_slice() {
            [sea] => sea.check(key, findings),
            _ => self.seas.check(key, findings),
        }
    }
}

impl Default for WaveComponents {
    fn default() -> WaveComponents {
        WaveComponents::Rows(Vec::new())
    }
}

impl Value for WaveComponents {
    fn kind() -> Kind {
        Kind::Numbers
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        let expected =
            "rows [[amplitude, period, direction, phase], …], or the number of components of a spectrum";
        *self = match node.elements() {
            Some(_) => WaveComponents::Rows(node.read()?),
            None => WaveComponents::Number(node.count(expected)?),
        };
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        match self {
            WaveComponents::Rows(rows) => rows.write(),
            WaveComponents::Number(number) => number.write(),
        }
    }

    fn check(&self, _: &Key, findings: &mut Findings) {
        let rows = match self {
            WaveComponents::Rows(rows) => rows,
            WaveComponents::Number(number) => {
                findings.number("", *number as f64, within(1.0, 1e5).bounds, "-");
                return;
            }
        };
        rules! { findings, "";
            "" if rows.is_empty() => "there are no rows: write [[amplitude, period, direction, phase], …]";
        }
        let columns = [
            (Bounds::Magnitude(100.0), "m"),
            (PERIOD.bounds, "s"),
            (ANGLE.bounds, "rad"),
            (ANGLE.bounds, "rad"),
        ];
        for (i, row) in rows.iter().enumerate() {
            findings.row(&format!("[{i}]"), row, &columns);
        }
    }
}
