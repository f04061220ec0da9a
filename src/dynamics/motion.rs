//! The path of a coupled point or a vessel, axis by axis, between communication points.
//!
//! A host sets the displacement x_k (perhaps the velocity v_k) at t_k and asks for t_k + h. Stepping to x_k there and then
//! would jump, which is the commonest noise of coupled simulations. Instead the point follows one C1 curve: on every
//! communication step a cubic Hermite segment from where the path is to where the point is predicted to be.
//!
//! The prediction extrapolates the polynomial through the newest samples, of the degree 0 … 3 that would have predicted the
//! last two samples best from the older ones: smooth motion gets the third degree (error O(h⁴)), noise and jumps a low one. A degree
//! is kept until another would have been better by more than a factor: two of them often do equally well, where a harmonic motion is
//! sampled symmetrically, and rounding of the host's times would then choose between them.
//! With velocities the polynomial is fitted to them and integrated from x_k.
//!
//! Source: divided differences, e.g. Hairer, Nørsett & Wanner (1993), Solving Ordinary Differential Equations I, eq. III.1.7;
//! the choice of degree is made here. Valid for any sequence of step sizes: samples closer
//! together than half the coming step are passed over, and all are dropped when the host steps back.

use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

use crate::math::hermite::{self, Hermite};
use crate::model::{Kinematics, Pose};
use crate::scene::Reconstruction;

/// Highest degree of the extrapolated polynomial [-].
const DEGREE_MAX: usize = 3;
/// Samples that a degree is judged by: one alone can be met by chance, where the motion inflects.
const JUDGED: usize = 2;
/// Error of another degree over that of the present one, below which it takes over [-]. On harmonic motions anything from 0.3 to 0.9 but
/// ½, which symmetry makes exact, tells rounding from motion; 0.45 predicts them best.
const BETTER: f64 = 0.45;
/// The same to and from degree 0, so that what comes to rest, jumps or sets out is followed at once [-].
const BETTER_AT_REST: f64 = 0.9;
/// Samples kept.
const SAMPLES_MAX: usize = DEGREE_MAX + 1 + JUDGED;
/// Samples closer together than the coming step over this are passed over [-].
const STEP_RATIO_MAX: f64 = 2.0;

/// What the host said about one axis of a point at one time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Time [s].
    pub time: f64,
    /// Position [m].
    pub position: f64,
    /// Velocity [m/s], where the host gives it.
    pub velocity: Option<f64>,
}

/// The C1 path of a coupled point along one axis, and the samples it is predicted from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AxisPath {
    /// Newest last; the first `count` are in use.
    samples: [Sample; SAMPLES_MAX],
    count: usize,
    /// Degree that the last prediction was judged to need [-].
    degree: usize,
    /// Start and end of the present segment.
    from: Sample,
    to: Sample,
}

impl AxisPath {
    /// At rest at a position [m] at time [s].
    pub fn at_rest(time: f64, position: f64) -> AxisPath {
        let sample = Sample {
            time,
            position,
            velocity: None,
        };
        AxisPath {
            samples: [sample; SAMPLES_MAX],
            count: 1,
            degree: 0,
            from: sample,
            to: sample,
        }
    }

    /// Continues the path from the time of `sample` to that time + `step` [s].
    pub fn extend(&mut self, sample: Sample, step: f64, reconstruction: Reconstruction) {
        self.remember(sample);
        let end = sample.time + step;
        let velocity = sample.velocity.unwrap_or(0.0);
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
        let spaced = self.spaced(step / STEP_RATIO_MAX);
        let (position, velocity) = predict(spaced.as_slice(), end, &mut self.degree);
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

    /// Continues the path to a place that is known.
    pub fn follow(&mut self, to: Sample) {
        self.from = self.to;
        self.to = to;
    }

    /// Position, velocity and acceleration at time `t` [s] of the present segment.
    pub fn at(&self, t: f64) -> hermite::Sample {
        let knot = |s: &Sample| (s.time, s.position, s.velocity.unwrap_or(0.0));
        if self.to.time <= self.from.time {
            let (_, value, slope) = knot(&self.to);
            return hermite::Sample {
                value,
                slope,
                curvature: 0.0,
            };
        }
        Hermite::new(knot(&self.from), knot(&self.to)).at(t)
    }

    /// The samples at least `spacing` [s] apart, newest last: what lies closer says more about noise than about a long step.
    fn spaced(&self, spacing: f64) -> Spaced {
        let mut spaced = Spaced {
            samples: self.samples,
            count: 0,
        };
        let mut last = f64::INFINITY;
        for sample in self.samples[..self.count].iter().rev() {
            if last - sample.time >= spacing * (1.0 - 1e-9) {
                spaced.samples[spaced.count] = *sample;
                spaced.count += 1;
                last = sample.time;
            }
        }
        spaced.samples[..spaced.count].reverse();
        spaced
    }

    fn remember(&mut self, sample: Sample) {
        let last_step = sample.time - self.samples[self.count - 1].time;
        if last_step == 0.0 {
            self.count -= 1; // the same instant again: the newer word counts
        } else if last_step < 0.0 {
            (self.count, self.degree) = (0, 0);
        }
        if self.count == SAMPLES_MAX {
            self.samples.rotate_left(1);
            self.count -= 1;
        }
        self.samples[self.count] = sample;
        self.count += 1;
    }
}

/// The paths of a coupled point along x, y and z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HostPath(pub [AxisPath; 3]);

impl HostPath {
    /// At rest at a position [m] at a time [s].
    pub fn at_rest(time: f64, position: Vector3<f64>) -> HostPath {
        HostPath([0, 1, 2].map(|axis| AxisPath::at_rest(time, position[axis])))
    }

    /// Position, velocity and acceleration at time `t` [s].
    pub fn at(&self, t: f64) -> Kinematics {
        let [x, y, z] = self.0.map(|axis| axis.at(t));
        Kinematics {
            position: Vector3::new(x.value, y.value, z.value),
            velocity: Vector3::new(x.slope, y.slope, z.slope),
            acceleration: Vector3::new(x.curvature, y.curvature, z.curvature),
            ..Kinematics::default()
        }
    }
}

/// The paths of a vessel's displacement [m] along x, y and z and of its roll, pitch and yaw [rad].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct VesselPath(pub [AxisPath; 6]);

impl VesselPath {
    /// At rest at a pose [m, rad] at a time [s].
    pub fn at_rest(time: f64, pose: [f64; 6]) -> VesselPath {
        VesselPath(pose.map(|value| AxisPath::at_rest(time, value)))
    }

    /// Pose and its derivatives at time `t` [s].
    pub fn at(&self, t: f64) -> Pose {
        let axes = self.0.map(|axis| axis.at(t));
        Pose {
            value: Vector6::from_fn(|i, _| axes[i].value),
            rate: Vector6::from_fn(|i, _| axes[i].slope),
            acceleration: Vector6::from_fn(|i, _| axes[i].curvature),
        }
    }
}

/// Position [m] and velocity [m/s] predicted at time `t` [s]; `samples` newest last, not empty. `degree` is that of the prediction before,
/// then of this one.
fn predict(samples: &[Sample], t: f64, degree: &mut usize) -> (f64, f64) {
    let newest = samples[samples.len() - 1];
    let with_velocity = samples
        .iter()
        .rev()
        .take_while(|sample| sample.velocity.is_some())
        .count();
    if with_velocity > 0 {
        let samples = &samples[samples.len() - with_velocity..];
        let rates = Polynomial::best(samples, degree, |sample| sample.velocity.unwrap_or(0.0));
        return (
            newest.position + rates.integral(newest.time, t),
            rates.at(t),
        );
    }
    let positions = Polynomial::best(samples, degree, |sample| sample.position);
    (positions.at(t), positions.slope(t))
}

/// Samples picked for a prediction.
struct Spaced {
    samples: [Sample; SAMPLES_MAX],
    count: usize,
}

impl Spaced {
    fn as_slice(&self) -> &[Sample] {
        &self.samples[..self.count]
    }
}

/// Newton's interpolation polynomial through the newest samples.
struct Polynomial {
    degree: usize,
    /// Times, newest first.
    times: [f64; DEGREE_MAX + 1],
    /// Divided differences.
    differences: [f64; DEGREE_MAX + 1],
}

impl Polynomial {
    /// Of the `degree` given, or of the one that is set instead, because it would have predicted the newest samples clearly better from
    /// the ones older than each.
    fn best(samples: &[Sample], degree: &mut usize, value: impl Fn(&Sample) -> f64) -> Polynomial {
        let known = samples.len();
        if known <= 2 {
            // two samples can judge no line, but a host that moves a point goes on moving it
            return Polynomial::through(samples, known - 1, &value);
        }
        let judged = JUDGED.min(known - 2);
        let miss = |degree: usize, newest: usize| {
            let guess = Polynomial::through(&samples[..newest], degree, &value);
            (guess.at(samples[newest].time) - value(&samples[newest])).abs()
        };
        let error = |degree: usize| -> f64 {
            let newest = known - judged..known;
            newest.map(|newest| miss(degree, newest)).sum()
        };
        let highest = DEGREE_MAX.min(known - 1 - judged);
        let (kept, mut best, mut least) = match *degree {
            kept if kept <= highest => (kept, kept, error(kept)),
            _ => (0, 0, f64::INFINITY),
        };
        for other in 0..=highest {
            let factor = match (kept, other) {
                (0, _) | (_, 0) => BETTER_AT_REST,
                _ => BETTER,
            };
            let handicapped = error(other) / factor;
            // what rests has no degree to keep
            if handicapped < least || (other == 0 && handicapped == 0.0) {
                (best, least) = (other, handicapped);
            }
        }
        *degree = best;
        Polynomial::through(samples, best, &value)
    }

    fn through(samples: &[Sample], degree: usize, value: &impl Fn(&Sample) -> f64) -> Polynomial {
        let mut times = [0.0; DEGREE_MAX + 1];
        let mut differences = [0.0; DEGREE_MAX + 1];
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

    fn at(&self, t: f64) -> f64 {
        self.value_and_slope(t).0
    }

    fn slope(&self, t: f64) -> f64 {
        self.value_and_slope(t).1
    }

    fn value_and_slope(&self, t: f64) -> (f64, f64) {
        let (mut value, mut slope) = (self.differences[self.degree], 0.0);
        for i in (0..self.degree).rev() {
            slope = value + (t - self.times[i]) * slope;
            value = self.differences[i] + (t - self.times[i]) * value;
        }
        (value, slope)
    }

    /// ∫ from `t0` to `t1`, exact to the third degree by Gauss's two points.
    fn integral(&self, t0: f64, t1: f64) -> f64 {
        let (middle, half) = (0.5 * (t0 + t1), 0.5 * (t1 - t0));
        let offset = half / 3.0_f64.sqrt();
        half * (self.at(middle - offset) + self.at(middle + offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn position(t: f64) -> f64 {
        5.0 * (0.5 * t).sin() + 2.0 * (0.7 * t).cos()
    }

    fn velocity(t: f64) -> f64 {
        2.5 * (0.5 * t).cos() - 1.4 * (0.7 * t).sin()
    }

    fn sample(time: f64, position: f64) -> Sample {
        Sample {
            time,
            position,
            velocity: None,
        }
    }

    /// Greatest distance between path and truth after a start-up, at a communication step h.
    fn path_error(h: f64, with_velocity: bool) -> f64 {
        let mut path = AxisPath::at_rest(0.0, position(0.0));
        let mut worst: f64 = 0.0;
        for k in 0..(20.0 / h) as usize {
            let time = k as f64 * h;
            let velocity = with_velocity.then(|| velocity(time));
            path.extend(
                Sample {
                    velocity,
                    ..sample(time, position(time))
                },
                h,
                Reconstruction::Smooth,
            );
            if time > 5.0 {
                let middle = time + 0.5 * h;
                worst = worst.max((path.at(middle).value - position(middle)).abs());
            }
        }
        worst
    }

    #[test]
    fn the_path_converges_at_third_order_or_better() {
        for with_velocity in [false, true] {
            let errors = [0.4, 0.2, 0.1, 0.05].map(|h| path_error(h, with_velocity));
            for pair in errors.windows(2) {
                assert!((pair[0] / pair[1]).log2() > 2.9, "{errors:?}");
            }
        }
    }

    #[test]
    fn position_and_velocity_are_continuous_at_communication_points() {
        let mut path = AxisPath::at_rest(0.0, 0.0);
        let mut before = path.at(0.0);
        for (k, x) in [0.0, 0.0, 1.0, 1.0, 1.0, -0.3, 0.2].into_iter().enumerate() {
            let time = 0.1 * k as f64;
            path.extend(sample(time, x), 0.1, Reconstruction::Smooth);
            assert_relative_eq!(path.at(time).value, before.value, epsilon = 1e-12);
            assert_relative_eq!(path.at(time).slope, before.slope, epsilon = 1e-11);
            before = path.at(time + 0.1);
        }
    }

    /// Degrees chosen for a motion of amplitude 1 m and a period [s] that grows over 20 s, told every `step` [s] at times rounded by `noise` [-].
    fn degrees(period: f64, step: f64, noise: f64) -> Vec<usize> {
        let motion = |t: f64| {
            let grown = 0.5 * (1.0 - (std::f64::consts::PI * t.min(20.0) / 20.0).cos());
            grown * (std::f64::consts::TAU * t / period).sin()
        };
        let mut path = AxisPath::at_rest(0.0, 0.0);
        let degree = |k: usize| {
            let rounding = noise * ((k * 7919) % 101) as f64 / 50.0 - noise;
            let time = k as f64 * step;
            let said = sample(time * (1.0 + rounding), motion(time));
            path.extend(said, step, Reconstruction::Smooth);
            path.degree
        };
        (0..(120.0 / step) as usize).map(degree).collect()
    }

    #[test]
    fn rounding_of_the_times_does_not_change_the_degree() {
        for period in [12.0, 9.0, 10.0, 8.0, 1.25] {
            for step in [0.4, 0.2, 0.1, 0.05] {
                let exact = degrees(period, step, 0.0);
                assert!(exact.contains(&DEGREE_MAX) || period < 2.0);
                for noise in [1e-15, 1e-13, 1e-12] {
                    let rounded = degrees(period, step, noise);
                    assert_eq!(exact, rounded, "{period} s every {step} s, {noise}");
                }
            }
        }
    }

    #[test]
    fn a_motion_that_comes_to_rest_forgets_its_degree() {
        let mut path = AxisPath::at_rest(0.0, position(0.0));
        for k in 0..200 {
            let time = 0.1 * f64::from(k);
            let moved = if k < 100 {
                position(time)
            } else if k < 150 {
                3.0
            } else {
                4.0
            };
            path.extend(sample(time, moved), 0.1, Reconstruction::Smooth);
            if k >= 106 {
                assert!(path.at(time + 0.1).value <= 4.0 + 1e-12, "{time} s");
            }
        }
        assert_eq!(path.degree, 0);
    }

    #[test]
    fn a_jump_is_not_overshot() {
        let mut path = AxisPath::at_rest(0.0, 0.0);
        for k in 0..20 {
            let time = 0.1 * k as f64;
            path.extend(
                sample(time, if k < 6 { 0.0 } else { 1.0 }),
                0.1,
                Reconstruction::Smooth,
            );
            assert!(path.at(time + 0.1).value <= 1.0 + 1e-12);
        }
        assert_relative_eq!(path.at(2.0).value, 1.0, epsilon = 1e-12);
    }

    #[test]
    fn irregular_steps_stay_close_to_the_motion() {
        let mut path = AxisPath::at_rest(0.0, position(0.0));
        let mut time = 0.0;
        for k in 0..400 {
            let step = [0.05, 0.08, 0.06, 0.3, 0.01][k % 5];
            path.extend(sample(time, position(time)), step, Reconstruction::Smooth);
            time += step;
            assert!((path.at(time).value - position(time)).abs() < 0.9, "{time}");
        }
    }

    #[test]
    fn the_jump_option_restarts_where_the_host_says() {
        let mut path = AxisPath::at_rest(0.0, 0.0);
        path.extend(
            Sample {
                velocity: Some(2.0),
                ..sample(0.0, 1.0)
            },
            0.5,
            Reconstruction::Jump,
        );
        assert_eq!((path.at(0.0).value, path.at(0.5).value), (1.0, 2.0));
    }
}
