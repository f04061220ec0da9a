//! Points at the ends of lines, and the vessels that carry them.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::table::{Acts, MIXED, PLAIN, choice, magnitude, not_negative, table};
use super::{AngleOrder, MotionPath, MotionRow, Scene, TimeFunction};

table! {
    /// A point that lines end at.
    pub struct Point, "`[[points]]`" {
        /// Name, the stem of the point's variables.
        pub name: String,
        /// Reference position [m]; of a point on a vessel, in the vessel's frame.
        pub position: [f64; 3] => magnitude(1e7),
        /// Motion of the point.
        pub kind: PointKind,
        /// Vessel that carries a coupled point, whose position is then in the vessel's frame.
        pub on: Option<String>,
        /// List of the axes along which a free point may move, such as `["x"]`; by default all.
        pub free: Option<Vec<Axis>>,
        /// Own mass [kg]; not for fixed points. At points that are not free it adds to the force on the structure that holds them.
        pub mass: Option<f64> => not_negative(1e12).label("mass"),
        /// Own displaced volume [m³]; not for fixed points.
        pub volume: Option<f64> => not_negative(1e9).label("volume").acts(Acts::InWater),
        /// Drag coefficient times area CdA [m²]; not for fixed points.
        pub drag_area: Option<f64> => not_negative(1e9).elsewhere(&["cda"]).label("drag area").acts(Acts::InFlow),
        /// Added-mass coefficient Ca on the displaced volume [-]; not for fixed points.
        pub added_mass: Option<f64> => not_negative(1e3).elsewhere(&["ca"]).usual([0.0, 5.0], "0 to 5 is usual")
            .label("added-mass coefficient").acts(Acts::InAccelerations),
        /// Point load in time.
        pub force: Option<PointForce> => PLAIN.label("force"),
        /// Moment in time, on the end of a line that bends at a free point.
        pub moment: Option<PointMoment> => PLAIN.label("moment"),
        /// Prescribed displacement in time, with `kind = "prescribed"` only.
        pub motion: Option<MotionPath> => MIXED.label("it"),
    }
}

impl Point {
    /// Point with a name, a reference position [m] and a kind only.
    pub fn at(name: impl Into<String>, position: [f64; 3], kind: PointKind) -> Point {
        Point {
            name: name.into(),
            position,
            kind,
            ..Point::default()
        }
    }
}

choice! {
    /// Motion of a point.
    pub enum PointKind {
        /// Does not move.
        Fixed = "fixed",
        /// Driven by the host: a fairlead.
        Coupled = "coupled",
        /// Moves along its own path in time, in every host.
        Prescribed = "prescribed",
        /// Moves under the forces on it.
        Free = "free",
    }
}

choice! {
    /// A global axis.
    pub enum Axis {
        /// Global x.
        X = "x",
        /// Global y.
        Y = "y",
        /// Global z, up.
        Z = "z",
    }
}

table! {
    /// A point load along the global axes.
    pub struct PointForce, "`force`" {
        /// Force along x [N].
        pub x: Option<TimeFunction> => PLAIN.label("along x"),
        /// Force along y [N].
        pub y: Option<TimeFunction> => PLAIN.label("along y"),
        /// Force along z [N].
        pub z: Option<TimeFunction> => PLAIN.label("along z"),
    }
}

table! {
    /// A moment about the global axes.
    pub struct PointMoment, "`moment`" {
        /// Moment about x [N m].
        pub x: Option<TimeFunction> => PLAIN.label("about x"),
        /// Moment about y [N m].
        pub y: Option<TimeFunction> => PLAIN.label("about y"),
        /// Moment about z [N m].
        pub z: Option<TimeFunction> => PLAIN.label("about z"),
    }
}

table! {
    /// A floating body driven by the host: a frame that carries points.
    pub struct Vessel, "`[[vessels]]`" {
        /// Name, the stem of the vessel's variables.
        pub name: String,
        /// Reference position of its origin [m].
        pub position: [f64; 3] = [0.0; 3] => magnitude(1e7),
        /// Reference attitude: roll, pitch, yaw [rad], body to global by yaw about z, then pitch about y', then roll about x''.
        pub attitude: [f64; 3] = [0.0; 3] => magnitude(TAU),
        /// Order of the rotations by roll, pitch and yaw in the motion of a run, in `[motion]` or given with the run.
        pub motion_angles: AngleOrder = AngleOrder::Zyx,
    }
}

impl Vessel {
    /// Converts rows of a motion with Z-Y-X angles, as in the results of a run, to the order of angles of this vessel's motions [rad].
    pub(super) fn in_own_order(&self, mut rows: Vec<MotionRow>) -> Vec<MotionRow> {
        if self.motion_angles.is_zyx() {
            return rows;
        }
        let attitude = Vector3::from(self.attitude);
        let reference = self
            .motion_angles
            .angles(&AngleOrder::Zyx.rotation(attitude), attitude);
        let mut angles = reference;
        for row in &mut rows {
            let recorded = attitude + Vector3::from_row_slice(&row[4..]);
            angles = self
                .motion_angles
                .angles(&AngleOrder::Zyx.rotation(recorded), angles);
            row[4..].copy_from_slice((angles - reference).as_slice());
        }
        rows
    }
}

impl Scene {
    /// As [`Vessel::in_own_order`], for the body with this name; the rows of a point are returned unchanged.
    pub(super) fn in_own_order(&self, body: &str, rows: Vec<MotionRow>) -> Vec<MotionRow> {
        match self.vessel(body) {
            Some(vessel) => vessel.in_own_order(rows),
            None => rows,
        }
    }
}
