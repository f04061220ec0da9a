//! The path of a coupled point between communication points.
//!
//! A host sets the displacement x_k (perhaps the velocity v_k) at t_k and asks for t_k + h. Stepping to x_k there and then
//! would jump, which is the commonest noise of coupled simulations. Instead the point follows one C1 curve: on every
//! communication step a cubic Hermite segment from where the path is to where the point is predicted to be.
//!
//! The prediction extrapolates the polynomial through the newest samples, of the degree 0 … 3 that would have predicted the
//! present sample best from the older ones: smooth motion gets the third degree (error O(h⁴)), noise and jumps a low one.
//! With velocities the polynomial is fitted to them and integrated from x_k.
//!
//! Source: divided differences, e.g. Hairer, Nørsett & Wanner (1993), Solving Ordinary Differential Equations I, eq. III.1.7;
//! the choice of degree is made here. Valid for any sequence of step sizes; samples are dropped when the host steps back
//! or changes h by more than a factor of 2.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::math::hermite::Hermite;
use crate::model::Kinematics;
use crate::scene::Reconstruction;

/// Highest degree of the extrapolated polynomial [-].
const DEGREE_MAX: usize = 3;
/// Samples kept: one more than the polynomial needs, to judge its degree.
const SAMPLES_MAX: usize = DEGREE_MAX + 2;
/// A change of the communication step by more than this factor drops the samples [-].
const STEP_RATIO_MAX: f64 = 2.0;

/// What the host said about a point at one time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Time [s].
    pub time: f64,
    /// Position [m].
    pub position: Vector3<f64>,
    /// Velocity [m/s], where the host gives it.
    pub velocity: Option<Vector3<f64>>,
}

/// The C1 path of a coupled point, and the samples it is predicted from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HostPath {
    /// Newest last.
    samples: Vec<Sample>,
    /// Start and end of the present segment.
    from: Sample,
    to: Sample,
}

impl HostPath {
    /// At rest at a position [m] at time [s].
    pub fn at_rest(time: f64, position: Vector3<f64>) -> HostPath {
        let sample = Sample {
            time,
            position,
            velocity: None,
        };
        let mut samples = Vec::with_capacity(SAMPLES_MAX);
        samples.push(sample);
        HostPath {
            samples,
            from: sample,
            to: sample,
        }
    }

    /// Continues the path from the time of `sample` to that time + `step` [s].
    pub fn extend(&mut self, sample: Sample, step: f64, reconstruction: Reconstruction) {
        self.remember(sample, step);
        let end = sample.time + step;
        let velocity = sample.velocity.unwrap_or_else(Vector3::zeros);
        if reconstruction == Reconstruction::Jump {
            self.from = Sample {
                velocity: Some(velocity),
                ..sample
            };
            let position = sample.position + step * velocity;
            self.to = Sample {
                time: end,
                position,
                velocity: Some(velocity),
            };
            return;
        }
        let (position, velocity) = predict(&self.samples, end);
        self.from = Sample {
            time: sample.time,
            ..self.to
        };
        self.to = Sample {
            time: end,
            position,
            velocity: Some(velocity),
        };
    }

    /// Position, velocity and acceleration at time `t` [s] of the present segment.
    pub fn at(&self, t: f64) -> Kinematics {
        let knot = |s: &Sample| {
            (
                s.time,
                s.position,
                s.velocity.unwrap_or_else(Vector3::zeros),
            )
        };
        if self.to.time <= self.from.time {
            return Kinematics {
                position: self.to.position,
                velocity: knot(&self.to).2,
                acceleration: Vector3::zeros(),
            };
        }
        Hermite::new(knot(&self.from), knot(&self.to)).at(t).into()
    }

    fn remember(&mut self, sample: Sample, step: f64) {
        if let Some(newest) = self.samples.last() {
            let last_step = sample.time - newest.time;
            let ratio = step / last_step;
            let irregular = ratio > STEP_RATIO_MAX || ratio * STEP_RATIO_MAX < 1.0;
            if last_step == 0.0 {
                self.samples.pop(); // the same instant again: the newer word counts
            } else if last_step < 0.0 || (irregular && self.samples.len() > 1) {
                self.samples.clear();
            }
        }
        if self.samples.len() == SAMPLES_MAX {
            self.samples.remove(0);
        }
        self.samples.push(sample);
    }
}

/// Position [m] and velocity [m/s] predicted at time `t` [s]; `samples` newest last, not empty.
fn predict(samples: &[Sample], t: f64) -> (Vector3<f64>, Vector3<f64>) {
    let newest = samples[samples.len() - 1];
    let with_velocity = samples
        .iter()
        .rev()
        .take_while(|sample| sample.velocity.is_some())
        .count();
    if with_velocity > 0 {
        let rates = Polynomial::best(&samples[samples.len() - with_velocity..], |sample| {
            sample.velocity.unwrap_or_else(Vector3::zeros)
        });
        return (
            newest.position + rates.integral(newest.time, t),
            rates.at(t),
        );
    }
    let positions = Polynomial::best(samples, |sample| sample.position);
    (positions.at(t), positions.slope(t))
}

/// Newton's interpolation polynomial through the newest samples.
struct Polynomial {
    degree: usize,
    /// Times, newest first.
    times: [f64; DEGREE_MAX + 1],
    /// Divided differences.
    differences: [Vector3<f64>; DEGREE_MAX + 1],
}

impl Polynomial {
    /// Of the degree that would have predicted the newest sample best from the older ones.
    fn best(samples: &[Sample], value: impl Fn(&Sample) -> Vector3<f64>) -> Polynomial {
        let (newest, older) = samples.split_last().expect("at least one sample");
        let mut best = (0, f64::INFINITY);
        for degree in 0..=DEGREE_MAX.min(older.len().saturating_sub(1)) {
            if older.is_empty() {
                break;
            }
            let guess = Polynomial::through(older, degree, &value).at(newest.time);
            let error = (guess - value(newest)).norm();
            if error < best.1 {
                best = (degree, error);
            }
        }
        // two samples can judge no line, but a host that moves a point goes on moving it
        let degree = if samples.len() == 2 { 1 } else { best.0 };
        Polynomial::through(samples, degree, &value)
    }

    fn through(
        samples: &[Sample],
        degree: usize,
        value: &impl Fn(&Sample) -> Vector3<f64>,
    ) -> Polynomial {
        let mut times = [0.0; DEGREE_MAX + 1];
        let mut differences = [Vector3::zeros(); DEGREE_MAX + 1];
        for (i, sample) in samples.iter().rev().take(degree + 1).enumerate() {
            (times[i], differences[i]) = (sample.time, value(sample));
        }
        for order in 1..=degree {
            for i in (order..=degree).rev() {
                differences[i] =
                    (differences[i] - differences[i - 1]) / (times[i] - times[i - order]);
            }
        }
        Polynomial {
            degree,
            times,
            differences,
        }
    }

    fn at(&self, t: f64) -> Vector3<f64> {
        self.value_and_slope(t).0
    }

    fn slope(&self, t: f64) -> Vector3<f64> {
        self.value_and_slope(t).1
    }

    fn value_and_slope(&self, t: f64) -> (Vector3<f64>, Vector3<f64>) {
        let (mut value, mut slope) = (self.differences[self.degree], Vector3::zeros());
        for i in (0..self.degree).rev() {
            slope = value + (t - self.times[i]) * slope;
            value = self.differences[i] + (t - self.times[i]) * value;
        }
        (value, slope)
    }

    /// ∫ from `t0` to `t1`, exact to the third degree by Gauss's two points.
    fn integral(&self, t0: f64, t1: f64) -> Vector3<f64> {
        let (middle, half) = (0.5 * (t0 + t1), 0.5 * (t1 - t0));
        let offset = half / 3.0_f64.sqrt();
        half * (self.at(middle - offset) + self.at(middle + offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn position(t: f64) -> Vector3<f64> {
        Vector3::new(5.0 * (0.5 * t).sin(), 0.3 * t, 2.0 * (0.7 * t).cos())
    }

    fn velocity(t: f64) -> Vector3<f64> {
        Vector3::new(2.5 * (0.5 * t).cos(), 0.3, -1.4 * (0.7 * t).sin())
    }

    /// Greatest distance between path and truth after a start-up, at a communication step h.
    fn path_error(h: f64, with_velocity: bool) -> f64 {
        let mut path = HostPath::at_rest(0.0, position(0.0));
        let mut worst: f64 = 0.0;
        for k in 0..(20.0 / h) as usize {
            let time = k as f64 * h;
            let velocity = with_velocity.then(|| velocity(time));
            path.extend(
                Sample {
                    time,
                    position: position(time),
                    velocity,
                },
                h,
                Reconstruction::Smooth,
            );
            if time > 5.0 {
                let middle = time + 0.5 * h;
                worst = worst.max((path.at(middle).position - position(middle)).norm());
            }
        }
        worst
    }

    #[test]
    fn the_path_converges_at_third_order_or_better() {
        for with_velocity in [false, true] {
            let errors: Vec<f64> = [0.4, 0.2, 0.1, 0.05]
                .map(|h| path_error(h, with_velocity))
                .into();
            for pair in errors.windows(2) {
                assert!((pair[0] / pair[1]).log2() > 2.9, "{errors:?}");
            }
        }
    }

    #[test]
    fn position_and_velocity_are_continuous_at_communication_points() {
        let mut path = HostPath::at_rest(0.0, Vector3::zeros());
        let mut before = path.at(0.0);
        for (k, x) in [0.0, 0.0, 1.0, 1.0, 1.0, -0.3, 0.2].into_iter().enumerate() {
            let time = 0.1 * k as f64;
            let sample = Sample {
                time,
                position: Vector3::new(x, 0.0, 0.0),
                velocity: None,
            };
            path.extend(sample, 0.1, Reconstruction::Smooth);
            assert_relative_eq!(path.at(time).position, before.position, epsilon = 1e-12);
            assert_relative_eq!(path.at(time).velocity, before.velocity, epsilon = 1e-11);
            before = path.at(time + 0.1);
        }
    }

    #[test]
    fn a_jump_is_not_overshot() {
        let mut path = HostPath::at_rest(0.0, Vector3::zeros());
        for k in 0..20 {
            let x = if k < 6 { 0.0 } else { 1.0 };
            let sample = Sample {
                time: 0.1 * k as f64,
                position: Vector3::new(x, 0.0, 0.0),
                velocity: None,
            };
            path.extend(sample, 0.1, Reconstruction::Smooth);
            assert!(path.at(sample.time + 0.1).position.x <= 1.0 + 1e-12);
        }
        assert_relative_eq!(path.at(2.0).position.x, 1.0, epsilon = 1e-12);
    }

    #[test]
    fn irregular_steps_stay_close_to_the_motion() {
        let mut path = HostPath::at_rest(0.0, position(0.0));
        let mut time = 0.0;
        for k in 0..400 {
            let step = [0.05, 0.08, 0.06, 0.3, 0.01][k % 5];
            path.extend(
                Sample {
                    time,
                    position: position(time),
                    velocity: None,
                },
                step,
                Reconstruction::Smooth,
            );
            time += step;
            assert!(
                (path.at(time).position - position(time)).norm() < 0.9,
                "{time}"
            );
        }
    }
}
