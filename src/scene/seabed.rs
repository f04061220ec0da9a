//! The seabed as the user described it: level, a slope, or soundings on a grid; its stiffness and its friction.

use toml::Value as Toml;

use super::SceneError;
use super::check::Findings;
use super::document::Node;
use super::table::{Key, Kind, PLAIN, Table, Value, choice, magnitude, not_negative, positive, table};

/// Default normal stiffness [Pa/m].
const STIFFNESS: f64 = 3.0e6;
/// Usual stiffness, from soft mud to the concrete floor under the chain of a model [Pa/m].
const STIFFNESS_USUAL: [f64; 2] = [1e4, 2e9];
/// Default normal damping [Pa s/m].
const DAMPING: f64 = 3.0e5;

table! {
    /// A seabed: z = −depth, unless `slope`, `grid` or `file` shape it.
    pub struct Seabed, "`[seabed]`" {
        /// Depth of the seabed below z = 0 [m]; of a slope, the depth at the origin; with soundings, the depth for waves.
        pub depth: f64 => not_negative(1e5).hint("the depth counts downwards from z = 0").elsewhere(&["wtrdpth"]).parameter(),
        /// Normal stiffness [Pa/m], per metre of line and metre of diameter.
        pub stiffness: f64 = STIFFNESS => positive(1e12).usual(STIFFNESS_USUAL, "1e4 to 2e9 Pa/m is usual")
            .elsewhere(&["kbot"]),
        /// Normal damping [Pa s/m], per metre of line and metre of diameter.
        pub damping: f64 = DAMPING => not_negative(1e12).elsewhere(&["cbot"]),
        /// Slope dz/dx and dz/dy of a plane through (0, 0, −depth) [-].
        pub slope: Option<[f64; 2]> => magnitude(SLOPE_MAX)
            .usual([-1.0, 1.0], "-1 to 1 is usual, a slope being a rise over a length and no angle in degrees")
            .hint("steeper than any seabed; the slope is dz/dx and dz/dy, 0.1 rises by 1 m in 10 m"),
        /// File of soundings, a table in CSV or a bathymetry file of MoorDyn-F or MoorDyn-C, relative to the scene.
        pub file: Option<String> => PLAIN.instead_of(&["slope", "grid"]),
        /// Use of stiffness and damping.
        pub contact: ContactLaw = ContactLaw::Regularised,
        /// Coefficient of Coulomb friction [-], or one across and one along the line.
        pub friction: Friction = Friction::isotropic(0.0) => not_negative(10.0).elsewhere(&["frictioncoefficient", "mu_kt"]),
        /// Soundings, smooth between the lines of the grid and constant outside.
        pub grid: Option<DepthGrid> => PLAIN.instead_of(&["slope"]),
    }
}

/// Maximum slope of a seabed [-]: 63 degrees.
const SLOPE_MAX: f64 = 2.0;

table! {
    /// Depths over lines of equal x and of equal y.
    pub struct DepthGrid, "`grid`" {
        /// x of the grid's lines [m], increasing.
        pub x: Vec<f64> => magnitude(1e7),
        /// y of the grid's lines [m], increasing.
        pub y: Vec<f64> => magnitude(1e7),
        /// Depths [m]: a row for every y, with one number for every x.
        pub depth: Vec<Vec<f64>> => not_negative(1e5).hint("depths count downwards from z = 0"),
    }
}

choice! {
    /// Use of the seabed's stiffness and damping at the nodes.
    pub enum ContactLaw {
        /// Both are reduced until a node at rest compresses its spring by a small fraction of its segment length; a line at rest lies half of that below the seabed, where its suspended part is most accurate. The damper keeps a fraction of critical damping if the given one has as much.
        Regularised = "regularised",
        /// The given coefficients.
        AsGiven = "as_given",
        /// The given coefficients at the nodes only, not along the segments between them, as in MoorDyn. Beams have them along their elements.
        AtNodes = "at_nodes",
    }
}

/// Coulomb friction between lines and seabed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Friction {
    /// Coefficient across the line, and for points [-].
    pub transverse: f64,
    /// Coefficient along the line [-].
    pub axial: f64,
}

impl Friction {
    /// Friction with the same coefficient [-] in all directions.
    pub const fn isotropic(coefficient: f64) -> Friction {
        Friction {
            transverse: coefficient,
            axial: coefficient,
        }
    }

    /// Returns whether one of the coefficients is above zero.
    pub fn acts(&self) -> bool {
        self.transverse > 0.0 || self.axial > 0.0
    }
}

impl Seabed {
    /// A level seabed at a depth [m], with the default stiffness and damping.
    pub fn level(depth: f64) -> Seabed {
        Seabed {
            depth,
            ..Seabed::default()
        }
    }

    /// Returns whether the seabed is a horizontal plane.
    pub fn is_level(&self) -> bool {
        self.grid.is_none() && self.file.is_none() && self.slope.is_none_or(|slope| slope == [0.0; 2])
    }

    /// Height of the seabed at a place [m]; between soundings, the lowest of the surrounding ones.
    pub(super) fn lowest_at(&self, [x, y]: [f64; 2]) -> f64 {
        let around = |line: &[f64], place: f64| {
            let next = line.partition_point(|known| *known <= place);
            [next.saturating_sub(1), next.min(line.len().saturating_sub(1))]
        };
        let Some(grid) = &self.grid else {
            let [along_x, along_y] = self.slope.unwrap_or_default();
            return along_x * x + along_y * y - self.depth;
        };
        let rows = around(&grid.y, y);
        let depths = rows.into_iter().filter_map(|j| grid.depth.get(j));
        let corners = around(&grid.x, x);
        let deepest = depths.flat_map(|row| corners.into_iter().filter_map(|i| row.get(i)));
        -deepest.copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns whether stiffness and damping have their default values.
    pub(crate) fn has_default_stiffness(&self) -> bool {
        self.stiffness == STIFFNESS && self.damping == DAMPING
    }
}

table! {
    /// Friction by direction.
    struct Directions, "`friction`" {
        /// Coefficient across the line, and of points [-].
        transverse: f64 => not_negative(10.0),
        /// Coefficient along the line [-].
        axial: f64 => not_negative(10.0),
    }
}

impl Value for Friction {
    fn kind() -> Kind {
        Kind::NumberOrTable(Directions::SCHEMA)
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        if node.entries().is_none() {
            *self = Friction::isotropic(node.number("a number or { transverse = μ, axial = μ }")?);
            return Ok(());
        }
        let Directions { transverse, axial } = node.read()?;
        *self = Friction { transverse, axial };
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        let Friction { transverse, axial } = *self;
        match transverse == axial {
            true => axial.write(),
            false => Directions { transverse, axial }.write(),
        }
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        let Friction { transverse, axial } = *self;
        if axial == transverse || axial.is_nan() && transverse.is_nan() {
            axial.check(key, findings);
        } else {
            Directions { transverse, axial }.check(key, findings);
        }
    }
}
