//! Path of a coupled point or a vessel between communication points, axis by axis.
//!
//! A host sets the displacement x_k (and optionally the velocity v_k) at t_k and requests t_k + h. Setting the point to
//! x_k at that time would be a jump, the most common source of noise in coupled simulations. Instead, the point follows
//! one C1 curve: on every communication step a cubic Hermite segment from the end of the path to the predicted position.
//!
//! The prediction extrapolates the polynomial P through the newest samples. Its degree is the k = 0 … 3 with the smallest
//! expected error at the end of the step. This error is the remainder P[t_0 … t_{k+1}] (t − t_0) … (t − t_k), with the
//! divided differences of the last two sets of samples. Smooth motion gets the third degree (error O(h⁴)), noise and jumps
//! a low one. On equal steps the remainder is the error that each degree would have had at the last two samples. That
//! error is always used from rest, since a jump within a short step does not continue at its rate. A degree is kept until
//! the expected error of another is smaller by a given factor: two degrees are often equally good where a harmonic motion
//! is sampled symmetrically, and rounding of the host's times would then decide between them. If the host gives
//! velocities, the polynomial is fitted to them and integrated from x_k.
//!
//! On equal steps the velocity of the third degree at the end of the step has an error of (25/12) m/h, where the fourth difference m of the samples
//! is also the error of the position. A cubic with this velocity error at both ends has errors of acceleration of up to 12.5 m/h²: 18 % RMS with 40
//! steps per period, where the errors are 0.06 % in position and 0.4 % in velocity. The tension of a light line follows the acceleration of its
//! end. On equal steps the velocity is therefore that of the polynomial of degree four: the errors are then 1.7 % in acceleration and 0.07 % in
//! velocity, and noise in the samples has 1.3 times the effect. The term of degree four fades out as the ratio of the longest step to the shortest
//! grows to two: the position errors at the ends of uneven steps differ and disturb the path as much.
//!
//! The error of a prediction, e = path − P at t_k with its rate ė, is removed within the next step if that step is no
//! shorter than the last. A shorter step would move the path too fast: 1 ms after a step of 10 s that ended a metre from
//! the host's position, it would jump back by a metre. In that case e decays to zero along a cubic over a time T. T is the
//! length of the step that caused the error, less the time passed since, so that the path converges as on equal steps.
//! Once that step is no longer among the samples, T is at most the time that the decay takes with |ë| ≤ a:
//!
//! T = (√(ė² + 6a|e|) − |ė|)/a   where e ė < 0 and ė² ≤ 2a|e|,   else (2|ė| + √(4ė² + 6a|e|))/a
//!
//! from ë = −6e/T² − 4ė/T at the start and 6e/T² + 2ė/T at the end. With a = 0.2 m/s² (0.02 rad/s²), plus half the
//! mean acceleration of P over the step, the path has moved five metres 12 s after a step of several minutes.
//!
//! A host that has the motion in advance, or that steps the moving body first, sets the position at t_k + h instead
//! ([`Reconstruction::Interpolate`]): cubics through the samples then need no prediction. If the host gives no velocity, it follows from the newest
//! samples. The parabola through three of them has an error of h²/3 x⃛ at both ends of the step, which causes errors of acceleration of 31 % with 40
//! steps per period. The polynomial of degree four, used where the third degree predicts best, reduces them to 0.5 %.
//!
//! Source: divided differences and their remainder, e.g. Hairer, Nørsett & Wanner (1993), Solving Ordinary
//! Differential Equations I, eq. III.1.7; the choice of degree, and of T, is derived here. Valid for any sequence of
//! step lengths: of two samples closer together than a thirtieth of the longest step in the record, the older one is
//! skipped, and all samples are dropped when the host steps back in time.

mod differences;
mod extrapolation;
mod fading;

use std::array::from_fn;

use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

use crate::math::hermite::{self, Hermites};
use crate::math::lanes::{LANES, Lanes};
use crate::model::{Kinematics, Pose};
use crate::scene::Reconstruction;
use differences::{Differences, above};
pub use extrapolation::{Clock, Extrapolation};
use extrapolation::{DEGREE_MAX, Order, SAMPLES_MAX, Samples};
pub use fading::Fading;

/// Acceleration that is always allowed for the removal of a prediction error [m/s²]: a fiftieth of g.
pub const EASE: f64 = 0.2;
/// The same for angles [rad/s²], with lever arms of some ten metres.
pub const EASE_OF_ANGLES: f64 = 0.02;
/// Fraction of the motion's mean acceleration that is allowed in addition [-].
const SHARE: f64 = 0.5;

/// Sample from a host for up to four axes.
#[derive(Debug, Clone, Copy)]
pub struct InputSample {
    /// Position along the axes [m, rad].
    pub position: Lanes,
    /// Velocity along the axes [m/s, rad/s].
    pub velocity: Lanes,
    /// 1 along the axes with a velocity from the host, else 0 [-].
    pub rated: Lanes,
    /// Acceleration that is always allowed for the removal of an error [m/s², rad/s²].
    ease: f64,
}

impl InputSample {
    /// Sample of N axes; the last one also fills the unused lanes.
    #[inline(always)]
    pub fn new<const N: usize>(position: [f64; N], velocity: [Option<f64>; N]) -> InputSample {
        let rated = velocity.map(|rate| f64::from(u8::from(rate.is_some())));
        let velocity = velocity.map(|rate| rate.unwrap_or(0.0));
        let last = |lane: usize| lane.min(N - 1);
        InputSample {
            position: Lanes::new(from_fn(|lane| position[last(lane)])),
            velocity: Lanes::new(from_fn(|lane| velocity[last(lane)])),
            rated: Lanes::new(from_fn(|lane| rated[last(lane)])),
            ease: EASE,
        }
    }
}

/// C1 path along four axes in lanes, with the samples from which it is predicted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AxesPath {
    /// Position samples from the host, newest first, at the times of the clock [m, rad].
    positions: Samples,
    /// Velocity samples, newest first [m/s, rad/s]; the first `times_rated` are along the axes that `rated` marks.
    velocities: Samples,
    /// 1 along the axes whose last sample has a velocity, else 0 [-].
    rated: Lanes,
    /// Number of successive samples with velocities along these axes [-].
    times_rated: usize,
    /// Degrees chosen by the last prediction [-].
    degree: Lanes,
    curve: Hermites,
    /// Positions [m, rad] and velocities [m/s, rad/s] at the end of the path.
    end: [Lanes; 2],
}

impl AxesPath {
    /// Path at rest at a position [m, rad].
    pub fn at_rest<const N: usize>(position: [f64; N]) -> AxesPath {
        let zero = Lanes::splat(0.0);
        let InputSample { position, .. } = InputSample::new(position, [None; N]);
        AxesPath {
            positions: [position; SAMPLES_MAX],
            velocities: [zero; SAMPLES_MAX],
            rated: zero,
            times_rated: 0,
            degree: zero,
            curve: Hermites::constant(position),
            end: [position, zero],
        }
    }

    /// Sets the path to `before`, continued over a communication step with the host's sample at its start, or at its end
    /// for [`Reconstruction::Interpolate`]. Returns the values of [`AxesPath::ends`]: reading them back immediately would
    /// stall the step on the stores.
    #[inline(always)]
    pub fn extend(
        &mut self,
        before: &AxesPath,
        extrapolation: &Extrapolation,
        sample: &InputSample,
    ) -> [[Lanes; 3]; 2] {
        if extrapolation.reconstruction == Reconstruction::Interpolate {
            return self.interpolate(before, extrapolation, sample);
        }
        let goes_on = extrapolation.order == Order::After && sample.rated == before.rated;
        if !goes_on || !extrapolation.all {
            self.turn(before, extrapolation, sample);
            return self.ends();
        }
        // arrays are destructured, so that they stay in registers
        let [a, b, c, d, e, _] = before.positions;
        let [v, w, x, y, z, _] = before.velocities;
        (self.rated, self.degree) = (before.rated, before.degree);
        self.positions = [sample.position, a, b, c, d, e];
        let to = if sample.rated.all_positive() {
            self.velocities = [sample.velocity, v, w, x, y, z];
            self.times_rated = (before.times_rated + 1).min(SAMPLES_MAX);
            self.rate(extrapolation, sample, [sample.velocity, v, w, x, y, z])
        } else if !sample.rated.any_positive() {
            self.velocities = before.velocities;
            self.times_rated = 0;
            self.predict(extrapolation, [sample.position, a, b, c, d, e])
        } else {
            self.turn(before, extrapolation, sample);
            return self.ends();
        };
        self.bridge(before, extrapolation, sample, to);
        self.ends()
    }

    /// [`AxesPath::extend`] to the host's sample at the end of the step.
    #[inline(always)]
    fn interpolate(
        &mut self,
        before: &AxesPath,
        extrapolation: &Extrapolation,
        sample: &InputSample,
    ) -> [[Lanes; 3]; 2] {
        self.positions = extrapolation.order.push(&before.positions, sample.position);
        (self.rated, self.degree) = (sample.rated, before.degree);
        let mut velocity = sample.velocity;
        if !sample.rated.all_positive() {
            let derived = self.derive(before, extrapolation);
            velocity = sample.rated.choose(sample.velocity, derived);
        }
        let curve = Hermites::bridge(extrapolation.span, before.end, [sample.position, velocity]);
        (self.curve, self.end) = (curve, [sample.position, velocity]);
        let [start, [.., curvature]] = curve.ends();
        [start, [sample.position, velocity, curvature]]
    }

    /// Velocity at the newest sample [m/s, rad/s]: that of the polynomial of degree four where the third degree predicts the samples best, else that
    /// of the parabola through the last three positions.
    #[inline(never)]
    fn derive(&mut self, before: &AxesPath, extrapolation: &Extrapolation) -> Lanes {
        let differences = Differences::new(extrapolation, extrapolation.pick(&self.positions));
        let degree = differences.degree(extrapolation.count, &mut self.degree);
        let smooth = differences.velocity(degree, &extrapolation.slope_before);
        let [_, length, rate] = extrapolation.span;
        let (slope_before, rate_before) = before.curve.secant();
        let slope = (self.positions[0] - before.end[0]) * Lanes::splat(rate);
        let bend = length * rate_before / (1.0 + length * rate_before);
        let parabola = slope + Lanes::splat(bend) * (slope - slope_before);
        above(degree, DEGREE_MAX).choose(smooth * Lanes::splat(extrapolation.unit[1]), parabola)
    }

    /// [`AxesPath::extend`] where the host goes back in time, where samples are dropped, or where the set of axes with
    /// a velocity changes or is incomplete.
    #[cold]
    #[inline(never)]
    fn turn(&mut self, before: &AxesPath, extrapolation: &Extrapolation, sample: &InputSample) {
        let (order, forgets) = (extrapolation.order, extrapolation.order == Order::Before);
        let again = usize::from(matches!(order, Order::Instead | Order::Again));
        let known = match forgets || sample.rated != before.rated {
            true => 0,
            false => before.times_rated.saturating_sub(again),
        };
        *self = *before;
        self.rated = sample.rated;
        self.times_rated = (known + 1).min(SAMPLES_MAX);
        self.positions = order.push(&before.positions, sample.position);
        self.velocities = order.push(&before.velocities, sample.velocity);
        if forgets {
            self.degree = Lanes::splat(0.0);
        }
        let degree = self.degree;
        let predicted = self.predict(extrapolation, extrapolation.pick(&self.positions));
        let judged = std::mem::replace(&mut self.degree, degree);
        let rated = self.rate(extrapolation, sample, extrapolation.pick(&self.velocities));
        self.degree = sample.rated.choose(self.degree, judged);
        let to = from_fn(|k| sample.rated.choose(rated[k], predicted[k]));
        self.bridge(before, extrapolation, sample, to);
    }

    /// Appends the segments from the end of the path `before` to the prediction.
    #[inline(always)]
    fn bridge(
        &mut self,
        before: &AxesPath,
        extrapolation: &Extrapolation,
        sample: &InputSample,
        to: Prediction,
    ) {
        let jumps = extrapolation.reconstruction == Reconstruction::Jump;
        if jumps || extrapolation.late.is_some() {
            return self.bridge_over(before, extrapolation, sample, to);
        }
        let [position, velocity, _] = to;
        self.end = [position, velocity];
        self.curve = Hermites::bridge(extrapolation.span, before.end, self.end);
    }

    /// [`AxesPath::bridge`] where the path jumps to the host's sample, or where its error is removed over more than one
    /// step.
    #[cold]
    #[inline(never)]
    fn bridge_over(
        &mut self,
        before: &AxesPath,
        extrapolation: &Extrapolation,
        sample: &InputSample,
        [position, velocity, velocity_before]: Prediction,
    ) {
        if extrapolation.reconstruction == Reconstruction::Jump {
            let [_, length, _] = extrapolation.span;
            let reached = sample.position + Lanes::splat(length) * sample.velocity;
            self.end = [reached, sample.velocity];
            let from = [sample.position, sample.velocity];
            self.curve = Hermites::bridge(extrapolation.span, from, self.end);
            return;
        }
        let motion = [[sample.position, velocity_before], [position, velocity]];
        self.lead(before, extrapolation, motion, sample.ease);
    }

    /// Continues the path over a span of time [s] to given positions [m, rad] and velocities [m/s, rad/s].
    pub fn follow(&mut self, [start, end]: [f64; 2], to: [Lanes; 2]) {
        let length = end - start;
        self.curve = Hermites::bridge([start, length, 1.0 / length], self.end, to);
        self.end = to;
    }

    /// Sets the path to `before`, continued over a step towards a motion: positions [m, rad] and velocities [m/s, rad/s] at the start and at the end of the
    /// step. A difference at the start is removed over more than one step where the extrapolation requires it, with an acceleration of at least `ease`
    /// [m/s², rad/s²].
    pub fn lead(
        &mut self,
        before: &AxesPath,
        extrapolation: &Extrapolation,
        [now, to]: [[Lanes; 2]; 2],
        ease: f64,
    ) {
        self.end = to;
        if let Some(late) = extrapolation.late {
            let [_, length, _] = extrapolation.span;
            let missed = [before.end[0] - now[0], before.end[1] - now[1]];
            for axis in 0..LANES {
                let change = (to[1][axis] - now[1][axis]).abs();
                let acceleration = ease + SHARE * change / length;
                let missed = missed.map(|lanes| lanes[axis]);
                let left = left(missed, length, late, acceleration);
                self.end[0][axis] += left[0];
                self.end[1][axis] += left[1];
            }
        }
        self.curve = Hermites::bridge(extrapolation.span, before.end, self.end);
    }

    /// Newest position sample from the host [m, rad]; `None` if the sample has a velocity along any axis.
    pub fn unrated(&self) -> Option<Lanes> {
        (!self.rated.any_positive()).then_some(self.positions[0])
    }

    /// Sets the path to parabolas from a time [s] over a length [s], from positions [m, rad] at velocities [m/s, rad/s] with accelerations [m/s², rad/s²].
    pub fn glide(&mut self, [start, length]: [f64; 2], from: [Lanes; 2], acceleration: Lanes) {
        let ([position, velocity], h) = (from, Lanes::splat(length));
        let gained = h * acceleration;
        let mean = velocity + Lanes::splat(0.5) * gained;
        self.end = [position + h * mean, velocity + gained];
        self.curve = Hermites::bridge([start, length, 1.0 / length], from, self.end);
    }

    /// Mean accelerations over the current segments [m/s², rad/s²], which are `length` [s] long.
    pub fn mean_acceleration(&self, length: f64) -> Lanes {
        let [[_, slope, _], _] = self.curve.ends();
        Lanes::splat(1.0 / length) * (self.end[1] - slope)
    }

    /// Changes the positions [m, rad] and velocities [m/s, rad/s] at the end of the current segments, which start at a time [s] and last `length` [s].
    pub fn shift_end(&mut self, [start, length]: [f64; 2], [distance, velocity]: [Lanes; 2]) {
        let [[position, slope, _], _] = self.curve.ends();
        self.end = [self.end[0] + distance, self.end[1] + velocity];
        self.curve = Hermites::bridge([start, length, 1.0 / length], [position, slope], self.end);
    }

    /// Positions [m, rad] and velocities [m/s, rad/s] at the end of the current segments.
    pub fn end(&self) -> [Lanes; 2] {
        self.end
    }

    /// Positions, velocities and accelerations at time `t` [s] of the current segments.
    #[inline(always)]
    pub fn at(&self, t: f64) -> [Lanes; 3] {
        self.curve.at(t)
    }

    /// The same at both ends of the current segments; the end is bit-identical to the start of the next segments.
    #[inline(always)]
    pub fn ends(&self) -> [[Lanes; 3]; 2] {
        let [start, [.., curvature]] = self.curve.ends();
        let [position, velocity] = self.end;
        [start, [position, velocity, curvature]]
    }

    /// Newest three position samples along the first three axes [m, rad].
    pub fn newest(&self) -> [Vector3<f64>; 3] {
        let [newest, last, second, ..] = &self.positions;
        [newest.xyz(), last.xyz(), second.xyz()]
    }

    /// Magnitude of the acceleration jump along the first three axes from this path to its continuation `after` [m/s², rad/s²].
    pub fn jump(&self, after: &AxesPath) -> f64 {
        let ([_, [.., last]], [[.., first], _]) = (self.ends(), after.ends());
        (first - last).xyz().norm()
    }

    #[inline(always)]
    fn predict(&mut self, extrapolation: &Extrapolation, samples: Samples) -> Prediction {
        let differences = Differences::new(extrapolation, samples);
        let degree = differences.degree(extrapolation.count, &mut self.degree);
        let rate = Lanes::splat(extrapolation.unit[1]);
        [
            differences.sum(degree, &extrapolation.value),
            differences.velocity(degree, &extrapolation.slope) * rate,
            differences.sum(degree, &extrapolation.slope_before) * rate,
        ]
    }

    /// Predicts from the velocities of the host, and the position [m, rad] at the start of a step.
    #[inline(always)]
    fn rate(&mut self, extrapolation: &Extrapolation, sample: &InputSample, samples: Samples) -> Prediction {
        let differences = Differences::new(extrapolation, samples);
        let degree = differences.degree(extrapolation.known(self.times_rated), &mut self.degree);
        let rise = differences.sum(degree, &extrapolation.integral);
        [
            sample.position + rise * Lanes::splat(extrapolation.unit[0]),
            differences.velocity(degree, &extrapolation.value),
            sample.velocity,
        ]
    }
}

/// Position [m, rad] and velocity [m/s, rad/s] at the end of a step, and the velocity at its start.
type Prediction = [Lanes; 3];

/// Remainder after a step [s] of an error in position [m, rad] and velocity [m/s, rad/s]. The error decays to zero along a
/// cubic, over the shortest time between `soon` and `late` [s] for which an acceleration [m/s², rad/s²] suffices.
fn left(missed: [f64; 2], step: f64, [soon, late]: [f64; 2], acceleration: f64) -> [f64; 2] {
    let time = time_to_meet(missed, acceleration).max(soon).min(late);
    if time <= step {
        return [0.0; 2];
    }
    let ([distance, velocity], s) = (missed, step / time);
    let rest = 1.0 - s;
    [
        rest * rest * ((1.0 + 2.0 * s) * distance + step * velocity),
        rest * ((1.0 - 3.0 * s) * velocity - 6.0 * s / time * distance),
    ]
}

/// Time in which a cubic brings a distance and a velocity to zero with accelerations of at most `most`.
fn time_to_meet([distance, velocity]: [f64; 2], most: f64) -> f64 {
    let (reach, speed) = (6.0 * most * distance.abs(), velocity.abs());
    if distance * velocity < 0.0 && 3.0 * speed * speed <= reach {
        // approaching, and able to brake: the acceleration is largest at the end, 6d/T² + 2v/T
        return ((speed * speed + reach).sqrt() - speed) / most;
    }
    // the acceleration at the start, −6d/T² − 4v/T, is largest if d and v have the same sign
    (2.0 * speed + (4.0 * speed * speed + reach).sqrt()) / most
}

/// Path along one axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AxisPath(AxesPath);

impl AxisPath {
    /// Path at rest at a position [m].
    pub fn at_rest(position: f64) -> AxisPath {
        AxisPath(AxesPath::at_rest([position]))
    }

    /// Continues the path over a communication step with a position [m] and optionally a velocity [m/s], sampled as in [`AxesPath::extend`].
    pub fn extend(&mut self, extrapolation: &Extrapolation, position: f64, velocity: Option<f64>) {
        let before = self.0;
        self.0
            .extend(&before, extrapolation, &InputSample::new([position], [velocity]));
    }

    /// Continues the path over a span of time [s] to a given position [m] and velocity [m/s].
    pub fn follow(&mut self, span: [f64; 2], to: [f64; 2]) {
        self.0.follow(span, to.map(Lanes::splat));
    }

    /// Position, velocity and acceleration at time `t` [s] of the current segment.
    #[inline]
    pub fn at(&self, t: f64) -> hermite::Sample {
        let [value, slope, curvature] = self.0.at(t).map(|lanes| lanes[0]);
        hermite::Sample {
            value,
            slope,
            curvature,
        }
    }
}

/// Path of a coupled point along x, y and z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HostPath(pub AxesPath);

impl HostPath {
    /// Path at rest at a position [m].
    pub fn at_rest(position: Vector3<f64>) -> HostPath {
        HostPath(AxesPath::at_rest(position.into()))
    }

    /// Position, velocity and acceleration at time `t` [s].
    #[inline(always)]
    pub fn at(&self, t: f64) -> Kinematics {
        HostPath::kinematics(&self.0.at(t))
    }

    /// Kinematics of position [m], velocity [m/s] and acceleration [m/s²] along x, y and z, without rotation.
    #[inline(always)]
    pub fn kinematics(motion: &[Lanes; 3]) -> Kinematics {
        let [position, velocity, acceleration] = motion.map(|lanes| lanes.xyz());
        Kinematics {
            position,
            velocity,
            acceleration,
            ..Kinematics::default()
        }
    }
}

/// Paths of a vessel's displacement [m] along x, y and z, and of its roll, pitch and yaw [rad].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct VesselPath(pub [AxesPath; 2]);

impl VesselPath {
    /// Path at rest at a pose [m, rad].
    pub fn at_rest([x, y, z, roll, pitch, yaw]: [f64; 6]) -> VesselPath {
        VesselPath([
            AxesPath::at_rest([x, y, z]),
            AxesPath::at_rest([roll, pitch, yaw]),
        ])
    }

    /// Sets the path to `before`, continued over a communication step with a pose [m, rad] and optionally its rates
    /// [m/s, rad/s], sampled as in [`AxesPath::extend`].
    #[inline(always)]
    pub fn extend(
        &mut self,
        before: &VesselPath,
        extrapolation: &Extrapolation,
        [x, y, z, roll, pitch, yaw]: [f64; 6],
        [vx, vy, vz, wx, wy, wz]: [Option<f64>; 6],
    ) {
        let place = InputSample::new([x, y, z], [vx, vy, vz]);
        let angles = InputSample {
            ease: EASE_OF_ANGLES,
            ..InputSample::new([roll, pitch, yaw], [wx, wy, wz])
        };
        let paths = self.0.iter_mut().zip(&before.0);
        for ((path, before), sample) in paths.zip([place, angles]) {
            path.extend(before, extrapolation, &sample);
        }
    }

    /// Pose and its derivatives at time `t` [s].
    pub fn at(&self, t: f64) -> Pose {
        let [place, angles] = self.0.each_ref().map(|path| path.at(t));
        let six = |order: usize| {
            let (place, angles) = (place[order], angles[order]);
            Vector6::from_fn(|i, _| if i < 3 { place[i] } else { angles[i - 3] })
        };
        Pose {
            value: six(0),
            rate: six(1),
            acceleration: six(2),
        }
    }
}

#[cfg(test)]
mod tests;
