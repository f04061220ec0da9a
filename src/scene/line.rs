//! Lines, their sections, and the devices at their ends.

use super::TimeFunction;
use super::table::{choice, choice_of_values, magnitude, not_negative, positive, table, within};

/// Maximum number of elements of a section, or of a line [-].
pub(super) const ELEMENTS_MAX: f64 = 1e5;

table! {
    /// A line from end A (anchor) to end B (fairlead).
    pub struct Line, "`[[lines]]`" {
        /// Name, the stem of the line's variables.
        pub name: String,
        /// Point of end A.
        pub from: String,
        /// Point of end B.
        pub to: String,
        /// Sections from A to B.
        pub sections: Vec<Section>,
        /// Number of elements of the whole line [-], instead of that of the solver; sections with a number of their own keep it.
        pub elements: Option<usize> => elements(),
        /// Shape at the start, at rest.
        pub initial: InitialShape = InitialShape::Static,
        /// Shape without bending and torsion; the line is unstretched at the lengths of its sections.
        pub rest_shape: RestShape = RestShape::Straight,
        /// Direction of the line from A to B at end A [-], if that end is clamped; pinned by default.
        pub clamped_a: Option<[f64; 3]> => magnitude(1e6),
        /// Direction of the line from A to B at end B [-], if that end is clamped; pinned by default.
        pub clamped_b: Option<[f64; 3]> => magnitude(1e6),
        /// End that is released from its point when the host's input `L.release` becomes true; by default there is no such input.
        pub release: Option<LineEnd>,
        /// Tension or time at which the line breaks from one of its points.
        pub failure: Option<Break> => super::table::PLAIN.called("break"),
        /// Winch that pays out and hauls in the line at end B.
        pub winch: Option<Winch>,
    }
}

/// Rule of a number of elements.
const fn elements() -> super::table::Rule {
    within(1.0, ELEMENTS_MAX).elsewhere(&["numsegs", "segments", "nodes"])
}

impl Line {
    /// Returns whether the number of elements of any of its sections is left open.
    pub(crate) fn is_open(&self) -> bool {
        self.elements.is_none() && self.sections.iter().any(|section| section.elements.is_none())
    }

    /// Returns whether one of its ends is at the point with this name.
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
            ..Line::default()
        }
    }

    /// Number of its elements [-], if every section specifies its own.
    pub(super) fn element_count(&self) -> Option<usize> {
        let mut counts = self.sections.iter().map(|section| section.elements);
        counts.try_fold(0_usize, |sum, count| sum.checked_add(count?))
    }

    /// Unstretched length [m].
    pub(super) fn length(&self) -> f64 {
        self.sections.iter().map(|section| section.length).sum()
    }
}

table! {
    /// A part of a line with one line type.
    pub struct Section, "`sections`, each" {
        /// Line type.
        pub line_type: String => super::table::PLAIN.called("type").elsewhere(&["line_type"]),
        /// Unstretched length [m].
        pub length: f64 => positive(1e6).elsewhere(&["unstrlen", "unstretched_length"]).parameter(),
        /// Number of elements [-]; selected for the tolerance by default.
        pub elements: Option<usize> => elements(),
        /// Number of elements to which the `damping_ratio` of the line type refers [-]; by default the share of the section in 40 elements of the
        /// longest line of its network.
        pub damping_elements: Option<usize> => within(1.0, 1e9),
    }
}

table! {
    /// A winch, which pays out line and hauls it in.
    pub struct Winch, "`winch`" {
        /// End of the line that is on the winch: `"b"`.
        pub end: LineEnd,
        /// Greatest length paid out, in addition to that of the section at its end [m].
        pub length_max: f64 => positive(1e6),
        /// Maximum speed [m/s]; if the host requests more, the winch lags behind. No limit by default.
        pub speed_max: Option<f64> => positive(1e3),
        /// Length paid out in time [m], negative where the line is hauled in, where the scene's own motion is followed.
        pub path: Option<TimeFunction>,
    }
}

table! {
    /// A break of a line: the earlier of a tension and a time.
    pub struct Break, "`break`" {
        /// End that breaks from its point.
        pub at: LineEnd,
        /// Tension of the end's segment that breaks it [N].
        pub tension: Option<f64> => positive(1e15),
        /// Time at which it breaks [s], at the end of the internal step that reaches it.
        pub time: Option<f64> => not_negative(1e9),
    }
}

choice! {
    /// An end of a line.
    pub enum LineEnd {
        /// End A, the anchor's.
        A = "a",
        /// End B, the fairlead's.
        B = "b",
    }
}

choice! {
    /// Shape of a line that is free of bending and torsion.
    pub enum RestShape {
        /// Straight.
        Straight = "straight",
        /// The shape at the start.
        Initial = "initial",
    }
}

choice_of_values! {
    /// Shape of a line at t = 0, at rest.
    pub enum InitialShape {
        /// Static equilibrium.
        Static = "static",
        /// The closed-form catenary of the line between its points at their positions in the scene, or a straight line if there is none.
        Catenary = "catenary",
        /// Straight between its ends.
        Straight = "straight";
        /// `{ parabola = sag }`: a parabola that hangs `sag` [m] below the middle of the chord.
        Parabola(f64) = "parabola" => positive(1e6).hint("a positive sag hangs below the chord").in_units("m"),
        /// `{ nodes = [[x, y, z], …] }`: node positions [m], one more than the line has elements.
        Nodes(Vec<[f64; 3]>) = "nodes" => magnitude(1e7).in_units("m"),
    }
}
