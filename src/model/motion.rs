//! Prescribed motion of a point: displacement, velocity and acceleration in time.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use crate::math::hermite::Hermite;
use crate::scene::{HarmonicMotion, MotionPath};

/// Where a driven point is, and how it moves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Kinematics {
    /// Position, or displacement from the reference position [m].
    pub position: Vector3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Acceleration [m/s²].
    pub acceleration: Vector3<f64>,
}

/// A displacement in time.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// ramp(t)·Σ amplitude·sin(ωt + phase) per axis.
    Harmonic {
        /// Components of x, y and z.
        axes: [Vec<Harmonic>; 3],
        /// Duration of the cosine ramp [s].
        ramp: Option<f64>,
    },
    /// Cubic through the rows of a table, with slopes by the parabola through three neighbours; constant outside.
    Table(Vec<TableRow>),
}

/// One sine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Amplitude [m].
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
    /// Displacement [m].
    pub displacement: Vector3<f64>,
    /// Slope of the curve at the row [m/s].
    pub slope: Vector3<f64>,
}

impl Motion {
    /// The motion that a checked scene describes.
    pub fn new(path: &MotionPath) -> Motion {
        match path {
            MotionPath::Harmonic(HarmonicMotion { x, y, z, ramp }) => Motion::Harmonic {
                axes: [x, y, z].map(|components| components.iter().map(|c| harmonic(c)).collect()),
                ramp: ramp.filter(|ramp| *ramp > 0.0),
            },
            MotionPath::File(file) => Motion::Table(table(&file.rows)),
            MotionPath::Table(rows) => Motion::Table(table(rows)),
        }
    }

    /// Displacement and its derivatives at time `t` [s].
    pub fn at(&self, t: f64) -> Kinematics {
        match self {
            Motion::Harmonic { axes, ramp } => {
                let mut sum = Kinematics::default();
                for (axis, components) in axes.iter().enumerate() {
                    for h in components {
                        let (sin, cos) = (h.frequency * t + h.phase).sin_cos();
                        sum.position[axis] += h.amplitude * sin;
                        sum.velocity[axis] += h.amplitude * h.frequency * cos;
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
fn ramped(k: Kinematics, t: f64, ramp: f64) -> Kinematics {
    if t <= 0.0 {
        let rate2 = if t == 0.0 {
            0.5 * (PI / ramp).powi(2)
        } else {
            0.0
        };
        return Kinematics {
            acceleration: rate2 * k.position,
            ..Kinematics::default()
        };
    }
    let w = PI / ramp;
    let (sin, cos) = (w * t).sin_cos();
    let (r, dr, ddr) = (0.5 * (1.0 - cos), 0.5 * w * sin, 0.5 * w * w * cos);
    Kinematics {
        position: r * k.position,
        velocity: r * k.velocity + dr * k.position,
        acceleration: r * k.acceleration + 2.0 * dr * k.velocity + ddr * k.position,
    }
}

fn table(rows: &[[f64; 4]]) -> Vec<TableRow> {
    let point = |row: &[f64; 4]| (row[0], Vector3::new(row[1], row[2], row[3]));
    (0..rows.len())
        .map(|i| {
            let (time, displacement) = point(&rows[i]);
            let slope = if i == 0 || i + 1 == rows.len() {
                Vector3::zeros()
            } else {
                let ((t0, p0), (t2, p2)) = (point(&rows[i - 1]), point(&rows[i + 1]));
                let (h0, h1) = (time - t0, t2 - time);
                ((displacement - p0) * (h1 / h0) + (p2 - displacement) * (h0 / h1)) / (h0 + h1)
            };
            TableRow {
                time,
                displacement,
                slope,
            }
        })
        .collect()
}

fn interpolate(rows: &[TableRow], t: f64) -> Kinematics {
    let after = rows.partition_point(|row| row.time <= t);
    if after == 0 || after == rows.len() {
        let held = if after == 0 {
            rows.first()
        } else {
            rows.last()
        };
        return Kinematics {
            position: held.map_or(Vector3::zeros(), |row| row.displacement),
            ..Kinematics::default()
        };
    }
    let (low, high) = (rows[after - 1], rows[after]);
    let mut kinematics = Kinematics::default();
    for axis in 0..3 {
        let knot = |row: &TableRow| (row.time, row.displacement[axis], row.slope[axis]);
        let sample = Hermite::new(knot(&low), knot(&high)).at(t);
        kinematics.position[axis] = sample.value;
        kinematics.velocity[axis] = sample.slope;
        kinematics.acceleration[axis] = sample.curvature;
    }
    kinematics
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn swinging(ramp: Option<f64>) -> Motion {
        Motion::new(&MotionPath::Harmonic(HarmonicMotion {
            x: vec![vec![5.0, 12.0], vec![1.0, 3.0, 0.4]],
            y: vec![],
            z: vec![vec![2.0, 9.0]],
            ramp,
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
        let rows: Vec<[f64; 4]> = (0..50)
            .map(|i| 0.1 * i as f64)
            .map(|t| [t, t.sin(), 0.0, 1.0 - t])
            .collect();
        let motion = Motion::Table(table(&rows));
        assert_relative_eq!(motion.at(2.0).position.x, f64::sin(2.0), epsilon = 1e-14);
        assert_relative_eq!(motion.at(2.04).position.x, f64::sin(2.04), epsilon = 1e-5);
        assert_derivatives(&motion, 2.05, 1e-5);
    }
}
