//! Contents of a deck in its own terms: plain data with their places in the file, not interpreted.

use std::collections::BTreeMap;

use super::options::Meaning;
use crate::findings::Placed;

/// Version of the format of a deck.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Version {
    /// Line types with nine columns.
    One,
    /// Line types with ten columns or more.
    #[default]
    Two,
}

impl Version {
    pub(super) fn name(self) -> &'static str {
        match self {
            Version::One => "MoorDyn v1",
            Version::Two => "MoorDyn v2",
        }
    }
}

/// A whole deck.
#[derive(Debug, Default)]
pub(super) struct Deck {
    pub version: Version,
    pub title: String,
    pub line_types: Vec<LineType>,
    pub rod_types: Vec<RodType>,
    pub bodies: Vec<Body>,
    pub rods: Vec<Rod>,
    pub points: Vec<Point>,
    pub lines: Vec<Line>,
    /// Rows of FAILURE: conditions at which lines are released.
    pub failures: Vec<Placed<String>>,
    /// Rows of CONTROL: channels that change line lengths.
    pub controls: Vec<Placed<String>>,
    /// Rows of EXTERNAL LOADS.
    pub loads: Vec<Placed<String>>,
    pub options: Options,
    /// Names of output channels.
    pub outputs: Vec<Placed<String>>,
}

impl Deck {
    /// Returns the body with a number.
    pub(super) fn body(&self, id: usize) -> Option<&Body> {
        self.bodies.iter().find(|body| body.id.value == id)
    }

    /// Returns the numbers of the turbines that points are attached to.
    pub(super) fn turbines(&self) -> impl Iterator<Item = usize> {
        self.points
            .iter()
            .filter_map(|point| match point.attachment.value {
                Attachment::Turbine(number) => Some(number),
                _ => None,
            })
    }
}

/// Stiffness or damping: a number, or another entry that its column allows.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Property {
    /// A number, in the unit of its column.
    Number(f64),
    /// Numbers joined by bars: static, dynamic, and the factor of the mean tension in the dynamic one.
    Parts(Vec<f64>),
    /// Name of a file with a table, or of another law.
    Named(String),
}

/// A row of LINE TYPES.
#[derive(Debug)]
pub(super) struct LineType {
    pub name: Placed<String>,
    /// Diam [m].
    pub diameter: Placed<f64>,
    /// Mass per length [kg/m].
    pub mass: Placed<f64>,
    /// EA [N].
    pub stiffness: Placed<Property>,
    /// BA [N s], or −ζ [-].
    pub damping: Placed<Property>,
    /// EI [N m²]; absent in version 1.
    pub bending: Option<Placed<Property>>,
    /// Cd, across the line [-].
    pub drag_normal: Placed<f64>,
    /// Ca, across the line [-].
    pub added_mass_normal: Placed<f64>,
    /// CdAx, along the line [-].
    pub drag_tangential: Placed<f64>,
    /// CaAx, along the line [-].
    pub added_mass_tangential: Placed<f64>,
    /// Cl [-], lift coefficient of vortex-induced vibration.
    pub lift: Option<Placed<f64>>,
}

/// Row of ROD TYPES; its numbers are not used.
#[derive(Debug)]
pub(super) struct RodType {
    pub name: Placed<String>,
}

/// A row of BODIES.
#[derive(Debug)]
pub(super) struct Body {
    pub id: Placed<usize>,
    pub attachment: Placed<Attachment>,
    /// X0, Y0, Z0 [m].
    pub position: [Placed<f64>; 3],
    /// r0, p0, y0 [deg].
    pub attitude: [Placed<f64>; 3],
    /// Mass [kg].
    pub mass: Placed<f64>,
    /// Volume [m³].
    pub volume: Placed<f64>,
    /// CG [m], I [kg m²], CdA [m²], Ca [-]; one or several numbers each.
    pub parts: [Placed<Vec<f64>>; 4],
}

/// A row of RODS.
#[derive(Debug)]
pub(super) struct Rod {
    pub id: Placed<usize>,
    pub rod_type: Placed<String>,
    pub attachment: Placed<Attachment>,
    /// Ends A and B [m].
    pub ends: [[Placed<f64>; 3]; 2],
    /// NumSegs; 0 for a rod of zero length.
    pub segments: Placed<usize>,
}

/// A row of POINTS.
#[derive(Debug)]
pub(super) struct Point {
    pub id: Placed<usize>,
    pub attachment: Placed<Attachment>,
    /// X, Y, Z [m].
    pub position: [Placed<f64>; 3],
    /// Mass [kg].
    pub mass: Placed<f64>,
    /// Volume [m³].
    pub volume: Placed<f64>,
    /// FX, FY, FZ [N], in rows with twelve columns.
    pub force: Option<[Placed<f64>; 3]>,
    /// CdA [m²].
    pub drag_area: Placed<f64>,
    /// Ca [-].
    pub added_mass: Placed<f64>,
}

/// Attachment of a point, rod or body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Attachment {
    Fixed,
    /// Moved individually by the host.
    Coupled,
    /// Carried by the only vessel.
    Vessel,
    Free,
    /// Carried by a body.
    Body(usize),
    /// Carried by a turbine's platform, in a farm.
    Turbine(usize),
    /// Fixed but free to rotate (rods); on a body if a number is given.
    Pinned(Option<usize>),
    /// Moved by the host but free to rotate (rods and bodies).
    CoupledPinned,
}

/// A row of LINES.
#[derive(Debug)]
pub(super) struct Line {
    pub id: Placed<usize>,
    pub line_type: Placed<String>,
    /// Ends A and B.
    pub ends: [Placed<LineEnd>; 2],
    /// UnstrLen [m].
    pub length: Placed<f64>,
    /// NumSegs.
    pub segments: Placed<usize>,
    /// Letters that request an output file for this line.
    pub outputs: Placed<String>,
}

/// Object at the end of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LineEnd {
    Point(usize),
    /// End A (`false`) or B (`true`) of a rod.
    Rod(usize, bool),
}

/// OPTIONS with an effect; absent ones are `None`.
#[derive(Debug, Default)]
pub(super) struct Options {
    /// Numeric options, each in its own unit, such as g [m/s²].
    pub numbers: BTreeMap<Meaning, Placed<f64>>,
    /// WtrDpth [m].
    pub depth: Option<Placed<Property>>,
    /// Friction coefficients of the seabed [-], with their keys.
    pub friction: Vec<(String, Placed<f64>)>,
    /// File of seabed depths.
    pub soundings: Option<Placed<String>>,
    /// TmaxIC of 0: MoorDyn starts from the positions in the file, without dynamic relaxation.
    pub starts_at_once: Option<Placed<String>>,
    /// File with the initial state: key and value.
    pub state_file: Option<Placed<String>>,
    /// Waves and currents: key and value.
    pub surroundings: Vec<(String, Placed<String>)>,
    /// Keys that have no effect here.
    pub unneeded: Vec<Placed<String>>,
}
