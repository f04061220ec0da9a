//! The seabed as the user described it: level, a slope, or soundings on a grid; its stiffness and its friction.

use serde::de::{self, MapAccess, Visitor, value::MapAccessDeserializer};
use serde::ser::SerializeStruct;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A seabed: z = −depth, unless `slope`, `grid` or `file` shape it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seabed {
    /// Depth below z = 0 [m]: of a level bed, of a slope at the origin; with soundings, the depth that counts where one number is asked for.
    pub depth: f64,
    /// Normal stiffness kbot [Pa/m], per metre of line and metre of diameter.
    #[serde(default = "default_stiffness")]
    pub stiffness: f64,
    /// Normal damping cbot [Pa s/m], per metre of line and metre of diameter.
    #[serde(default = "default_damping")]
    pub damping: f64,
    /// Slope dz/dx and dz/dy of a plane through (0, 0, −depth) [-].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope: Option<[f64; 2]>,
    /// File of soundings, a table in CSV or a bathymetry file of MoorDyn-F or MoorDyn-C, relative to the scene; read into `grid`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// How stiffness and damping are used.
    #[serde(default)]
    pub contact: ContactLaw,
    /// Coulomb friction: one number [-], or `{ transverse = 0.7, axial = 0.4 }`.
    #[serde(default)]
    pub friction: Friction,
    /// Soundings, `{ x = […], y = […], depth = [[…], …] }`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grid: Option<DepthGrid>,
}

/// Depths over lines of equal x and of equal y, smooth between them and constant outside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthGrid {
    /// x of the grid's lines [m], increasing.
    pub x: Vec<f64>,
    /// y of the grid's lines [m], increasing.
    pub y: Vec<f64>,
    /// Depths [m]: a row for every y, with one number for every x.
    pub depth: Vec<Vec<f64>>,
}

/// How seabed stiffness and damping reach the nodes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactLaw {
    /// Softened together until a resting node compresses its spring by a small part of its segment length; the spring begins
    /// that much above the bed, so that the node lies on it. The damper keeps a part of critical damping, where the given one has as much.
    #[default]
    Regularised,
    /// Exactly the given coefficients.
    AsGiven,
}

/// Coulomb friction between lines and bed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Friction {
    /// Across the line, and of points [-].
    pub transverse: f64,
    /// Along the line [-].
    pub axial: f64,
}

impl Friction {
    /// Alike in all directions [-].
    pub const fn isotropic(coefficient: f64) -> Friction {
        Friction {
            transverse: coefficient,
            axial: coefficient,
        }
    }

    /// Whether there is any.
    pub fn acts(&self) -> bool {
        self.transverse > 0.0 || self.axial > 0.0
    }
}

impl Seabed {
    /// A level bed at a depth [m], with the stiffness and damping that scenes have by default.
    pub fn level(depth: f64) -> Seabed {
        Seabed {
            depth,
            stiffness: default_stiffness(),
            damping: default_damping(),
            slope: None,
            file: None,
            contact: ContactLaw::default(),
            friction: Friction::default(),
            grid: None,
        }
    }

    /// Whether it is a horizontal plane.
    pub fn is_level(&self) -> bool {
        self.grid.is_none() && self.file.is_none() && self.slope.is_none_or(|slope| slope == [0.0; 2])
    }

    /// z of the bed at a place [m]: of a plane as it is, between soundings the lowest of those around.
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

    /// Whether stiffness and damping are those of a scene that gives none.
    pub fn has_default_stiffness(&self) -> bool {
        self.stiffness == default_stiffness() && self.damping == default_damping()
    }
}

fn default_stiffness() -> f64 {
    3.0e6
}

fn default_damping() -> f64 {
    3.0e5
}

impl Serialize for Friction {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.transverse == self.axial {
            return serializer.serialize_f64(self.axial);
        }
        let mut table = serializer.serialize_struct("Friction", 2)?;
        table.serialize_field("transverse", &self.transverse)?;
        table.serialize_field("axial", &self.axial)?;
        table.end()
    }
}

impl<'de> Deserialize<'de> for Friction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(FrictionVisitor)
    }
}

/// The table that tells the directions apart.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Friction")]
pub(super) struct Directions {
    transverse: f64,
    axial: f64,
}

struct FrictionVisitor;

impl<'de> Visitor<'de> for FrictionVisitor {
    type Value = Friction;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or { transverse = μ, axial = μ }")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Friction, E> {
        Ok(Friction::isotropic(value))
    }

    // Whole numbers arrive here.
    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Friction, E> {
        Ok(Friction::isotropic(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Friction, E> {
        Ok(Friction::isotropic(value as f64))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Friction, A::Error> {
        let Directions { transverse, axial } = Directions::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Friction { transverse, axial })
    }
}
