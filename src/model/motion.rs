//! Prescribed motion of a point or a vessel: displacement, velocity and acceleration in time.

use std::f64::consts::{PI, TAU};

use nalgebra::{UnitQuaternion, Vector3, Vector6};

use crate::math::hermite::Hermite;
use crate::math::shape_preserving::{End, slopes};
use crate::scene::{MotionPath, MotionRow};

/// Position and motion of a driven point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Kinematics {
    /// Position, or displacement from the reference position [m].
    pub position: Vector3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Acceleration [m/s²].
    pub acceleration: Vector3<f64>,
    /// Rotation from the reference attitude of the point's support [-], a unit quaternion.
    pub orientation: UnitQuaternion<f64>,
    /// Angular velocity of the point's support, in global axes [rad/s].
    pub spin: Vector3<f64>,
}

/// Displacement x, y, z [m] and roll, pitch, yaw [rad], with their rates per second and per second squared.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pose {
    /// Displacement [m] and angles [rad].
    pub value: Vector6<f64>,
    /// Their first derivatives [m/s, rad/s].
    pub rate: Vector6<f64>,
    /// Their second derivatives [m/s², rad/s²].
    pub acceleration: Vector6<f64>,
}

impl Pose {
    /// Translational part.
    pub fn kinematics(&self) -> Kinematics {
        let first = |six: &Vector6<f64>| Vector3::new(six[0], six[1], six[2]);
        Kinematics {
            position: first(&self.value),
            velocity: first(&self.rate),
            acceleration: first(&self.acceleration),
            ..Kinematics::default()
        }
    }
}

/// Displacement as a function of time.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// ramp(t)·Σ amplitude·sin(ωt + phase) per axis.
    Harmonic {
        /// Components of x, y, z, roll, pitch and yaw.
        axes: [Vec<Harmonic>; 6],
        /// Duration of the cosine ramp [s].
        ramp: Option<f64>,
    },
    /// Cubic through the rows of a table with the slopes of [`crate::math::shape_preserving`]; constant outside.
    Table(Vec<TableRow>),
}

/// Bounds Σ A (ω + π/ramp)^k of the derivatives of a motion, up to order k = 6; Σ A ω^k without a ramp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivatives {
    /// Bound of the sixth derivative of displacement [m/s⁶].
    sixth: f64,
    /// Bounds of the derivatives of the sum of the angles, from the first order on [rad/s^k].
    angles: [f64; 6],
}

impl Derivatives {
    /// Bound of the sixth derivative of displacement times the sixth power of a time span [s], in [m].
    pub fn shift(&self, span: f64) -> f64 {
        self.sixth * span.powi(6)
    }

    /// Bounds of the derivatives of the angles times the powers of a time span [s], in [rad].
    pub fn turn(&self, span: f64) -> [f64; 6] {
        let mut power = 1.0;
        self.angles.map(|bound| {
            power *= span;
            bound * power
        })
    }
}

/// One sine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Amplitude [m] or [rad].
    pub amplitude: f64,
    /// Circular frequency [rad/s].
    pub frequency: f64,
    /// Phase [rad].
    pub phase: f64,
}

/// One row of a motion table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableRow {
    /// Time [s].
    pub time: f64,
    /// Displacement [m] and angles [rad].
    pub displacement: Vector6<f64>,
    /// Slope of the curve at the row [m/s, rad/s].
    pub slope: Vector6<f64>,
}

impl Motion {
    /// Motion of a checked scene. A table starts from rest and ends at rest at its last row.
    pub fn new(path: &MotionPath) -> Motion {
        Motion::until(path, f64::INFINITY)
    }

    /// Motion of a run that ends at a time [s]. A table that extends to the end of the run does not come to rest at its last row.
    pub fn until(path: &MotionPath, end: f64) -> Motion {
        match path {
            MotionPath::Harmonic(motion) => Motion::Harmonic {
                axes: motion
                    .axes()
                    .map(|(_, components)| components.iter().map(|c| harmonic(c)).collect()),
                ramp: motion.ramp.filter(|ramp| *ramp > 0.0),
            },
            MotionPath::File(file) => Motion::Table(table(&file.rows, end)),
            MotionPath::Table(rows) => Motion::Table(table(rows, end)),
        }
    }

    /// No motion: the reference position.
    pub fn none() -> Motion {
        Motion::Harmonic {
            axes: Default::default(),
            ramp: None,
        }
    }

    /// Bounds of its derivatives; `None` if it is piecewise cubic.
    pub fn derivatives(&self) -> Option<Derivatives> {
        let Motion::Harmonic { axes, ramp } = self else {
            return None;
        };
        // |dᵏ(r f)| ≤ A (ω + π/ramp)ᵏ, since the ramp r is no more than 1 and its derivatives no more than those of a sine
        let ramp = ramp.map_or(0.0, |ramp| PI / ramp);
        let sum = |axes: &[Vec<Harmonic>], order: i32| -> f64 {
            let components = axes.iter().flatten();
            components
                .map(|h| h.amplitude.abs() * (h.frequency.abs() + ramp).powi(order))
                .sum()
        };
        Some(Derivatives {
            sixth: sum(&axes[..3], 6),
            angles: [1, 2, 3, 4, 5, 6].map(|order| sum(&axes[3..], order)),
        })
    }

    /// Returns whether the path has no kink in a time span [s], excluding its start and including its end, from which
    /// [`Self::pose`] follows the next piece.
    pub fn is_smooth(&self, [start, end]: [f64; 2]) -> bool {
        let within = |kink: f64| kink > start && kink <= end;
        match self {
            Motion::Harmonic { ramp: None, .. } => true,
            Motion::Harmonic { ramp: Some(ramp), .. } => !within(0.0) && !within(*ramp),
            Motion::Table(rows) => {
                let next = rows.partition_point(|row| row.time <= start);
                rows.get(next).is_none_or(|row| row.time > end)
            }
        }
    }

    /// Displacement of a point and its derivatives at time `t` [s].
    pub fn at(&self, t: f64) -> Kinematics {
        self.pose(t).kinematics()
    }

    /// Displacement and angles of a vessel and their derivatives at time `t` [s].
    pub fn pose(&self, t: f64) -> Pose {
        match self {
            Motion::Harmonic { axes, ramp } => {
                let mut sum = Pose::default();
                for (axis, components) in axes.iter().enumerate() {
                    for h in components {
                        let (sin, cos) = (h.frequency * t + h.phase).sin_cos();
                        sum.value[axis] += h.amplitude * sin;
                        sum.rate[axis] += h.amplitude * h.frequency * cos;
                        sum.acceleration[axis] -= h.amplitude * h.frequency * h.frequency * sin;
                    }
                }
                match ramp {
                    Some(ramp) if t < *ramp => ramped(sum, t, *ramp),
                    _ => sum,
                }
            }
            Motion::Table(rows) => interpolate(rows, t),
        }
    }
}

fn harmonic(component: &[f64]) -> Harmonic {
    Harmonic {
        amplitude: component[0],
        frequency: TAU / component[1],
        phase: component.get(2).copied().unwrap_or(0.0),
    }
}

/// Product of a motion with r(t) = ½(1 − cos(πt/ramp)), 0 before t = 0.
fn ramped(k: Pose, t: f64, ramp: f64) -> Pose {
    if t <= 0.0 {
        let rate2 = if t == 0.0 { 0.5 * (PI / ramp).powi(2) } else { 0.0 };
        return Pose {
            acceleration: rate2 * k.value,
            ..Pose::default()
        };
    }
    let w = PI / ramp;
    let (sin, cos) = (w * t).sin_cos();
    let (r, dr, ddr) = (0.5 * (1.0 - cos), 0.5 * w * sin, 0.5 * w * w * cos);
    Pose {
        value: r * k.value,
        rate: r * k.rate + dr * k.value,
        acceleration: r * k.acceleration + 2.0 * dr * k.rate + ddr * k.value,
    }
}

/// Relative time after the last row of a table that counts as the time of that row [-]: the time of a run is a sum of steps.
const ROUNDING: f64 = 1e-9;

fn table(rows: &[MotionRow], end: f64) -> Vec<TableRow> {
    let column = |axis: usize| -> Vec<f64> { rows.iter().map(|row| row[axis]).collect() };
    let times = column(0);
    let ends_with_run = times
        .last()
        .is_some_and(|last| end <= last + ROUNDING * last.abs());
    let ends = [End::Flat, if ends_with_run { End::Open } else { End::Flat }];
    let slopes: [Vec<f64>; 6] = std::array::from_fn(|axis| slopes(&times, &column(1 + axis), ends));
    let row = |(i, row): (usize, &MotionRow)| TableRow {
        time: row[0],
        displacement: Vector6::from_column_slice(&row[1..]),
        slope: Vector6::from_fn(|axis, _| slopes[axis][i]),
    };
    rows.iter().enumerate().map(row).collect()
}

fn interpolate(rows: &[TableRow], t: f64) -> Pose {
    let mut after = rows.partition_point(|row| row.time <= t);
    let is_at = |row: &TableRow| t - row.time <= ROUNDING * row.time.abs();
    let ends = after > 1 && after == rows.len() && is_at(&rows[after - 1]);
    if ends {
        after -= 1; // the end of the last piece belongs to it, also where the time of a run is rounded up
    }
    if after == 0 || after == rows.len() {
        let held = if after == 0 { rows.first() } else { rows.last() };
        return Pose {
            value: held.map_or(Vector6::zeros(), |row| row.displacement),
            ..Pose::default()
        };
    }
    let (low, high) = (&rows[after - 1], &rows[after]);
    let mut pose = Pose::default();
    for axis in 0..6 {
        let knot = |row: &TableRow| (row.time, row.displacement[axis], row.slope[axis]);
        let sample = Hermite::new(knot(low), knot(high)).at(t);
        pose.value[axis] = sample.value;
        pose.rate[axis] = sample.slope;
        pose.acceleration[axis] = sample.curvature;
    }
    if ends {
        (pose.value, pose.rate) = (high.displacement, high.slope); // exact to the last bit
    }
    pose
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::HarmonicMotion;
    use approx::assert_relative_eq;

    fn swinging(ramp: Option<f64>) -> Motion {
        Motion::new(&MotionPath::Harmonic(HarmonicMotion {
            x: vec![vec![5.0, 12.0], vec![1.0, 3.0, 0.4]],
            y: vec![],
            z: vec![vec![2.0, 9.0]],
            ramp,
            ..HarmonicMotion::default()
        }))
    }

    fn assert_derivatives(motion: &Motion, t: f64, tolerance: f64) {
        let h = 1e-4;
        let (low, at, high) = (motion.at(t - h), motion.at(t), motion.at(t + h));
        assert_relative_eq!(
            (high.position - low.position) / (2.0 * h),
            at.velocity,
            epsilon = tolerance
        );
        assert_relative_eq!(
            (high.velocity - low.velocity) / (2.0 * h),
            at.acceleration,
            epsilon = tolerance
        );
    }

    #[test]
    fn velocity_and_acceleration_are_the_derivatives_of_position() {
        for t in [0.5, 3.0, 19.0, 21.0, 100.0] {
            assert_derivatives(&swinging(Some(20.0)), t, 1e-6);
            assert_derivatives(&swinging(None), t, 1e-6);
        }
    }

    #[test]
    fn a_table_is_met_at_its_rows_and_smooth_between() {
        let rows: Vec<MotionRow> = (0..50)
            .map(|i| 0.1 * i as f64)
            .map(|t| [t, t.sin(), 0.0, 1.0 - t, 0.0, 0.0, 0.0])
            .collect();
        let motion = Motion::Table(table(&rows, f64::INFINITY));
        assert_relative_eq!(motion.at(2.0).position.x, f64::sin(2.0), epsilon = 1e-14);
        assert_relative_eq!(motion.at(2.04).position.x, f64::sin(2.04), epsilon = 1e-5);
        assert_derivatives(&motion, 2.05, 1e-5);
    }

    #[test]
    fn a_run_whose_time_is_rounded_up_ends_on_the_last_piece_of_its_table() {
        let rows: Vec<MotionRow> = (0..=400)
            .map(|i| 0.05 * f64::from(i))
            .map(|t| [t, t.sin(), 0.0, 0.0, 0.0, 0.0, 0.0])
            .collect();
        let motion = Motion::Table(table(&rows, 20.0));
        let time = (0..400).fold(0.0, |time, _| time + 0.05);
        assert!(time > 20.0, "{time}");
        let end = motion.at(time);
        assert_relative_eq!(end.velocity.x, f64::cos(20.0), epsilon = 1e-3);
        assert_relative_eq!(end.acceleration.x, -f64::sin(20.0), epsilon = 0.1);
    }

    #[test]
    fn a_table_comes_to_rest_at_its_end_only_where_the_run_goes_on() {
        let rows: Vec<MotionRow> = (0..=47)
            .map(|i| 0.05 * f64::from(i))
            .map(|t| [t, (TAU * t).sin(), 0.0, 0.0, 0.0, 0.0, 0.0])
            .collect();
        let error = |end: f64| {
            let motion = Motion::until(&MotionPath::Table(rows.clone()), end);
            let last = motion.at(2.35).velocity.x;
            let greatest = (0..50).map(|k| 2.3 + 0.001 * f64::from(k));
            let missed = greatest.map(|t| (motion.at(t).position.x - (TAU * t).sin()).abs());
            (last, missed.fold(0.0, f64::max))
        };
        let (speed, missed) = error(2.35);
        assert!((speed - TAU * (TAU * 2.35).cos()).abs() < 0.25, "{speed} m/s");
        assert!(missed < 2e-3, "{missed} m");
        assert!(error(10.0).0.abs() < 1e-12);
    }

    #[test]
    fn a_table_that_holds_moves_and_holds_stays_between_its_rows() {
        let row = |t: f64, x: f64| [t, x, 0.0, 0.0, 0.0, 0.0, 0.0];
        let rows = [row(0.0, 0.0), row(30.0, 0.0), row(32.0, 5.0), row(60.0, 5.0)];
        let motion = Motion::Table(table(&rows, f64::INFINITY));
        for i in -10..=7000 {
            let x = motion.at(0.01 * f64::from(i)).position.x;
            assert!((0.0..=5.0).contains(&x), "{x} m");
        }
        for t in [29.0, 30.0, 31.0, 32.0, 33.0] {
            let (low, high) = (motion.at(t - 1e-9).velocity, motion.at(t + 1e-9).velocity);
            assert_relative_eq!(low, high, epsilon = 1e-7);
        }
    }

    #[test]
    fn a_span_that_ends_in_a_kink_is_not_smooth_and_one_that_starts_there_is() {
        let row = |t: f64| [t, t, 0.0, 0.0, 0.0, 0.0, 0.0];
        let motion = Motion::Table(table(&[0.0, 0.5, 1.0, 1.5].map(row), f64::INFINITY));
        assert!(motion.is_smooth([0.5, 0.9]) && !motion.is_smooth([0.5, 1.0]));
        let motion = swinging(Some(20.0));
        assert!(motion.is_smooth([20.0, 21.0]) && !motion.is_smooth([19.0, 20.0]));
    }
}
