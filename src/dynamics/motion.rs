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

/// When a host spoke, as far back as predictions look: at the same times of all that it moves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Newest first; the first `count` are in use [s].
    times: [f64; SAMPLES_MAX],
    count: usize,
}

/// What the time of a sample is to the samples before.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Order {
    /// Later.
    After,
    /// The same instant again: the newer word counts.
    Again,
    /// Earlier: what came before is no history of it.
    Before,
}

impl Clock {
    /// Begins at a time [s].
    pub fn new(time: f64) -> Clock {
        Clock {
            times: [time; SAMPLES_MAX],
            count: 1,
        }
    }

    /// A host speaks at a time [s] of a step from then on [s]: what all paths need to continue by it.
    pub fn tell(&mut self, time: f64, step: f64, reconstruction: Reconstruction) -> Foresight {
        let last_step = time - self.times[0];
        let order = if last_step == 0.0 {
            Order::Again
        } else if last_step < 0.0 {
            Order::Before
        } else {
            Order::After
        };
        match order {
            Order::After => {
                self.times.copy_within(0..SAMPLES_MAX - 1, 1);
                self.count = (self.count + 1).min(SAMPLES_MAX);
            }
            Order::Again => {}
            Order::Before => self.count = 1,
        }
        self.times[0] = time;
        Foresight::new(self, order, step, reconstruction)
    }
}

/// What the times of the samples make of a prediction, worked out once for all paths of a communication step.
#[derive(Debug, Clone)]
pub struct Foresight {
    order: Order,
    jumps: bool,
    /// Start and end of the step [s].
    span: [f64; 2],
    /// The samples that count, newest first; the first `count` are in use.
    picked: [usize; SAMPLES_MAX],
    count: usize,
    /// 1/(t_i − t_{i+k}) of the samples that count, by order k − 1 and place i [1/s].
    inverse: [[f64; SAMPLES_MAX - 1]; DEGREE_MAX + 1],
    /// Products of t_j − t_{j+1} … t_j − t_{j+k}, by order k − 1 and place j [s^k].
    reach: [[f64; JUDGED]; DEGREE_MAX + 1],
    /// Newton's polynomials of the newest samples at the end of the step, their slopes there and their integrals over it.
    value: [f64; DEGREE_MAX + 1],
    slope: [f64; DEGREE_MAX + 1],
    integral: [f64; DEGREE_MAX + 1],
}

impl Foresight {
    fn new(clock: &Clock, order: Order, step: f64, reconstruction: Reconstruction) -> Foresight {
        let start = clock.times[0];
        let end = start + step;
        let (picked, count) = spaced(&clock.times[..clock.count], step / STEP_RATIO_MAX);
        // what is not in use gets times that divide nothing by zero, and is not looked at
        let mut t = [0.0; SAMPLES_MAX];
        for (i, t) in t.iter_mut().enumerate() {
            *t = if i < count {
                clock.times[picked[i]]
            } else {
                start - (1.0 + i as f64) * step.max(f64::MIN_POSITIVE)
            };
        }
        let mut inverse = [[1.0; SAMPLES_MAX - 1]; DEGREE_MAX + 1];
        for (k, row) in inverse.iter_mut().enumerate() {
            for i in 0..SAMPLES_MAX - 1 - k {
                row[i] = t[i] - t[i + k + 1];
            }
        }
        let mut reach = [[0.0; JUDGED]; DEGREE_MAX + 1];
        let mut product = [1.0; JUDGED];
        for (row, differences) in reach.iter_mut().zip(&inverse) {
            for j in 0..JUDGED {
                product[j] *= differences[j];
                row[j] = product[j];
            }
        }
        for row in &mut inverse {
            row.iter_mut()
                .for_each(|difference| *difference = 1.0 / *difference);
        }
        let [h, e1, e2] = [end - t[0], end - t[1], end - t[2]];
        let [a, b] = [t[0] - t[1], t[0] - t[2]];
        Foresight {
            order,
            jumps: reconstruction == Reconstruction::Jump,
            span: [start, end],
            picked,
            count,
            inverse,
            reach,
            value: [1.0, h, h * e1, h * e1 * e2],
            slope: [0.0, 1.0, h + e1, h * e1 + (h + e1) * e2],
            integral: [
                h,
                h * h / 2.0,
                h * h * (h / 3.0 + a / 2.0),
                h * h * (h * h / 4.0 + (a + b) * h / 3.0 + a * b / 2.0),
            ],
        }
    }
}

/// Places of the times, newest first, that lie at least `spacing` [s] apart, and how many: what lies closer says more about noise than
/// about a long step.
fn spaced(times: &[f64], spacing: f64) -> ([usize; SAMPLES_MAX], usize) {
    let (mut picked, mut count) = ([0; SAMPLES_MAX], 0);
    let mut last = f64::INFINITY;
    for (place, &time) in times.iter().enumerate() {
        if last - time >= spacing * (1.0 - 1e-9) {
            picked[count] = place;
            count += 1;
            last = time;
        }
    }
    (picked, count)
}

/// The C1 path of a coupled point along one axis, and the samples it is predicted from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AxisPath {
    /// What the host said, newest first, at the times of the clock [m].
    positions: [f64; SAMPLES_MAX],
    /// The same of the velocity, as far as it did without a gap: the first `rated` are in use [m/s].
    velocities: [f64; SAMPLES_MAX],
    rated: usize,
    /// Degree that the last prediction was judged to need [-].
    degree: usize,
    /// The present segment.
    curve: Hermite,
    /// Where it ends [m], and at which velocity [m/s].
    end: [f64; 2],
}

impl AxisPath {
    /// At rest at a position [m].
    pub fn at_rest(position: f64) -> AxisPath {
        AxisPath {
            positions: [position; SAMPLES_MAX],
            velocities: [0.0; SAMPLES_MAX],
            rated: 0,
            degree: 0,
            curve: Hermite::constant(position),
            end: [position, 0.0],
        }
    }

    /// Continues the path by a communication step from a position [m] and perhaps a velocity [m/s] at its start.
    pub fn extend(&mut self, foresight: &Foresight, position: f64, velocity: Option<f64>) {
        self.remember(foresight.order, position, velocity);
        if foresight.jumps {
            let velocity = velocity.unwrap_or(0.0);
            let [start, end] = foresight.span;
            self.end = [position, velocity];
            return self.follow(
                foresight.span,
                [position + (end - start) * velocity, velocity],
            );
        }
        let to = self.predict(foresight);
        self.follow(foresight.span, to);
    }

    /// Continues the path over a span of time [s] to a position [m] and a velocity [m/s] that are known.
    pub fn follow(&mut self, [start, end]: [f64; 2], to: [f64; 2]) {
        let [position, velocity] = self.end;
        self.curve = Hermite::new((start, position, velocity), (end, to[0], to[1]));
        self.end = to;
    }

    /// Position, velocity and acceleration at time `t` [s] of the present segment.
    #[inline]
    pub fn at(&self, t: f64) -> hermite::Sample {
        self.curve.at(t)
    }

    fn remember(&mut self, order: Order, position: f64, velocity: Option<f64>) {
        match order {
            Order::After => {
                self.positions.copy_within(0..SAMPLES_MAX - 1, 1);
                self.velocities.copy_within(0..SAMPLES_MAX - 1, 1);
            }
            Order::Again => self.rated = self.rated.saturating_sub(1),
            Order::Before => (self.rated, self.degree) = (0, 0),
        }
        self.positions[0] = position;
        match velocity {
            Some(velocity) => {
                self.velocities[0] = velocity;
                self.rated = (self.rated + 1).min(SAMPLES_MAX);
            }
            None => self.rated = 0,
        }
    }

    /// Position [m] and velocity [m/s] predicted for the end of a step.
    fn predict(&mut self, foresight: &Foresight) -> [f64; 2] {
        let picked = &foresight.picked[..foresight.count];
        let with_velocity = picked
            .iter()
            .take_while(|&&place| place < self.rated)
            .count();
        if with_velocity > 0 {
            let rates = Differences::new(foresight, &self.velocities);
            let degree = rates.degree(with_velocity, &mut self.degree);
            let travelled = rates.sum(degree, &foresight.integral);
            return [
                self.positions[0] + travelled,
                rates.sum(degree, &foresight.value),
            ];
        }
        let positions = Differences::new(foresight, &self.positions);
        let degree = positions.degree(foresight.count, &mut self.degree);
        [&foresight.value, &foresight.slope].map(|basis| positions.sum(degree, basis))
    }
}

/// The paths of a coupled point along x, y and z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HostPath(pub [AxisPath; 3]);

impl HostPath {
    /// At rest at a position [m].
    pub fn at_rest(position: Vector3<f64>) -> HostPath {
        HostPath([0, 1, 2].map(|axis| AxisPath::at_rest(position[axis])))
    }

    /// Position, velocity and acceleration at time `t` [s].
    #[inline]
    pub fn at(&self, t: f64) -> Kinematics {
        let [x, y, z] = self.0.each_ref().map(|axis| axis.at(t));
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
    /// At rest at a pose [m, rad].
    pub fn at_rest(pose: [f64; 6]) -> VesselPath {
        VesselPath(pose.map(AxisPath::at_rest))
    }

    /// Pose and its derivatives at time `t` [s].
    pub fn at(&self, t: f64) -> Pose {
        let axes = self.0.each_ref().map(|axis| axis.at(t));
        Pose {
            value: Vector6::from_fn(|i, _| axes[i].value),
            rate: Vector6::from_fn(|i, _| axes[i].slope),
            acceleration: Vector6::from_fn(|i, _| axes[i].curvature),
        }
    }
}

/// Divided differences of the samples that count.
struct Differences {
    /// Of the newest samples, by order from 0 on.
    newest: [f64; DEGREE_MAX + 1],
    /// By how much polynomials of every degree through the samples before would have missed the newest ones.
    miss: [[f64; JUDGED]; DEGREE_MAX + 1],
}

impl Differences {
    fn new(foresight: &Foresight, samples: &[f64; SAMPLES_MAX]) -> Differences {
        let mut differences = foresight.picked.map(|place| samples[place]);
        let mut newest = [differences[0]; DEGREE_MAX + 1];
        let mut miss = [[0.0; JUDGED]; DEGREE_MAX + 1];
        for k in 0..=DEGREE_MAX {
            for i in 0..SAMPLES_MAX - 1 - k {
                differences[i] = (differences[i] - differences[i + 1]) * foresight.inverse[k][i];
            }
            // the remainder of the polynomial of degree k is the difference of order k + 1 times its nodes' distances
            for (j, miss) in miss[k].iter_mut().enumerate() {
                *miss = (differences[j] * foresight.reach[k][j]).abs();
            }
            if k < DEGREE_MAX {
                newest[k + 1] = differences[0];
            }
        }
        Differences { newest, miss }
    }

    /// The degree given, or the one that is set instead, because it would have predicted the newest samples clearly better from the ones
    /// older than each; of the `known` newest samples.
    fn degree(&self, known: usize, degree: &mut usize) -> usize {
        if known <= 2 {
            // two samples can judge no line, but a host that moves a point goes on moving it
            return known - 1;
        }
        let judged = JUDGED.min(known - 2);
        let error = |degree: usize| -> f64 { self.miss[degree][..judged].iter().sum() };
        let highest = DEGREE_MAX.min(known - 1 - judged);
        let (kept, mut best, mut least) = match *degree {
            kept if kept <= highest => (kept, kept, error(kept)),
            _ => (0, 0, f64::INFINITY),
        };
        for other in 0..=highest {
            let handicap = match (kept, other) {
                (0, _) | (_, 0) => 1.0 / BETTER_AT_REST,
                _ => 1.0 / BETTER,
            };
            let handicapped = error(other) * handicap;
            // what rests has no degree to keep
            if handicapped < least || (other == 0 && handicapped == 0.0) {
                (best, least) = (other, handicapped);
            }
        }
        *degree = best;
        best
    }

    /// Newton's polynomial of a degree, whose terms have the values `basis`.
    fn sum(&self, degree: usize, basis: &[f64; DEGREE_MAX + 1]) -> f64 {
        let terms = self.newest.iter().zip(basis).take(degree + 1);
        terms.map(|(difference, term)| difference * term).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// What the host said about one axis of a point at one time.
    struct Sample {
        time: f64,
        position: f64,
        velocity: Option<f64>,
    }

    /// A path and its clock.
    struct Guided(Clock, AxisPath);

    impl Guided {
        fn at_rest(time: f64, position: f64) -> Guided {
            Guided(Clock::new(time), AxisPath::at_rest(position))
        }

        fn extend(&mut self, sample: Sample, step: f64, reconstruction: Reconstruction) {
            let foresight = self.0.tell(sample.time, step, reconstruction);
            self.1.extend(&foresight, sample.position, sample.velocity);
        }

        fn at(&self, t: f64) -> hermite::Sample {
            self.1.at(t)
        }
    }

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
        let mut path = Guided::at_rest(0.0, position(0.0));
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
        let mut path = Guided::at_rest(0.0, 0.0);
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
        let mut path = Guided::at_rest(0.0, 0.0);
        let degree = |k: usize| {
            let rounding = noise * ((k * 7919) % 101) as f64 / 50.0 - noise;
            let time = k as f64 * step;
            let said = sample(time * (1.0 + rounding), motion(time));
            path.extend(said, step, Reconstruction::Smooth);
            path.1.degree
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
        let mut path = Guided::at_rest(0.0, position(0.0));
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
        assert_eq!(path.1.degree, 0);
    }

    #[test]
    fn a_jump_is_not_overshot() {
        let mut path = Guided::at_rest(0.0, 0.0);
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
        let mut path = Guided::at_rest(0.0, position(0.0));
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
        let mut path = Guided::at_rest(0.0, 0.0);
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
