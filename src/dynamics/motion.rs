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
//! With velocities the polynomial is fitted to them and integrated from x_k. What a prediction missed by is made up over as long a time as it was
//! for: after a step of 10 s that ends a metre beside the host, one of 1 ms must not leap back by a metre.
//!
//! Source: divided differences, e.g. Hairer, Nørsett & Wanner (1993), Solving Ordinary Differential Equations I, eq. III.1.7;
//! the choice of degree is made here. Valid for any sequence of step sizes: samples closer
//! together than half the coming step are passed over, and all are dropped when the host steps back.

use std::array::from_fn;

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
/// What multiplies the errors of the degrees that are not kept: where degree 0 is, and where another [-].
const HANDICAPS: [Terms; 2] = [
    [1.0 / BETTER_AT_REST; DEGREE_MAX + 1],
    [
        1.0 / BETTER_AT_REST,
        1.0 / BETTER,
        1.0 / BETTER,
        1.0 / BETTER,
    ],
];
/// Samples kept.
const SAMPLES_MAX: usize = DEGREE_MAX + 1 + JUDGED;
/// Samples closer together than the coming step over this are passed over [-].
const STEP_RATIO_MAX: f64 = 2.0;
/// Rounding of a host's times over its steps [-].
const ROUNDING: f64 = 1e-9;

/// When a host spoke, as far back as predictions look: at the same times of all that it moves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Newest first; the first `count` are in use [s].
    times: [f64; SAMPLES_MAX],
    count: usize,
    /// When all that was missed is to be made up [s].
    made_up: f64,
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

impl Order {
    /// Samples with one more, newest first.
    #[inline]
    fn push(self, samples: &[f64; SAMPLES_MAX], sample: f64) -> [f64; SAMPLES_MAX] {
        let [a, b, c, d, e, f] = *samples;
        match self {
            Order::After => [sample, a, b, c, d, e],
            Order::Again | Order::Before => [sample, b, c, d, e, f],
        }
    }
}

impl Clock {
    /// Begins at a time [s].
    pub fn new(time: f64) -> Clock {
        Clock {
            times: [time; SAMPLES_MAX],
            count: 1,
            made_up: time,
        }
    }

    /// A host speaks at a time [s] of a step from then on [s]: `foresight` becomes what all paths need to continue by it, whatever it was.
    pub fn tell(
        &mut self,
        time: f64,
        step: f64,
        reconstruction: Reconstruction,
        foresight: &mut Foresight,
    ) {
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
                self.count = (self.count + 1).min(SAMPLES_MAX);
                self.made_up = self.made_up.max(time + last_step);
            }
            Order::Again => {}
            Order::Before => (self.count, self.made_up) = (1, time),
        }
        self.times = order.push(&self.times, time);
        foresight.renew(self, order, step, reconstruction);
    }

    /// What is left after a step [s] of a distance and a velocity by which a path misses its host now: the cubic from both to none when all is
    /// made up. Rows of position [-, s] and velocity [1/s, -].
    fn left(&self, step: f64) -> [[f64; 2]; 2] {
        let time = self.made_up - self.times[0];
        if time <= step * (1.0 + ROUNDING) {
            return [[0.0; 2]; 2];
        }
        let s = step / time;
        let rest = 1.0 - s;
        [
            [rest * rest * (1.0 + 2.0 * s), step * rest * rest],
            [-6.0 * s * rest / time, rest * (1.0 - 3.0 * s)],
        ]
    }
}

/// What the times of the samples make of a prediction, worked out once for all paths of a communication step.
#[derive(Debug, Clone)]
pub struct Foresight {
    order: Order,
    jumps: bool,
    /// Start and end of the step [s].
    span: [f64; 2],
    /// What is left at the end of the step of what the path misses now, see [`Clock::left`].
    left: [[f64; 2]; 2],
    /// The samples that count, newest first; the first `count` are in use.
    picked: [usize; SAMPLES_MAX],
    count: usize,
    /// Whether all samples count.
    all: bool,
    /// 1/length of the step [1/s].
    rate: f64,
    /// Times of the samples that count [s].
    times: [f64; SAMPLES_MAX],
    /// 1/(t_i − t_{i+k}) of the samples that count.
    inverse: Reciprocals,
    /// Products of t_j − t_{j+1} … t_j − t_{j+k}, by place j and order k − 1 [s^k].
    reach: [Terms; JUDGED],
    /// Newton's polynomials of the newest samples at the end of the step, their slopes there and their integrals over it.
    value: Terms,
    slope: Terms,
    integral: Terms,
}

/// 1/(t_i − t_{i+k}) by place i, for the orders k from 1 on [1/s]. Written out, so that the compiler unrolls what is done with them.
#[derive(Debug, Clone)]
struct Reciprocals {
    first: [f64; SAMPLES_MAX - 1],
    second: [f64; SAMPLES_MAX - 2],
    third: [f64; SAMPLES_MAX - 3],
    fourth: [f64; SAMPLES_MAX - 4],
}

impl Reciprocals {
    /// Of these times [s].
    fn new(t: &[f64; SAMPLES_MAX]) -> Reciprocals {
        Reciprocals {
            first: from_fn(|i| 1.0 / (t[i] - t[i + 1])),
            second: from_fn(|i| 1.0 / (t[i] - t[i + 2])),
            third: from_fn(|i| 1.0 / (t[i] - t[i + 3])),
            fourth: from_fn(|i| 1.0 / (t[i] - t[i + 4])),
        }
    }

    /// The times [s] are those before, moved on by a place, and a new first one.
    fn push(&mut self, t: &[f64; SAMPLES_MAX]) {
        let [one, two, three, four] = [1, 2, 3, 4].map(|k| 1.0 / (t[0] - t[k]));
        let [a, b, c, d, _] = self.first;
        self.first = [one, a, b, c, d];
        let [a, b, c, _] = self.second;
        self.second = [two, a, b, c];
        let [a, b, _] = self.third;
        self.third = [three, a, b];
        let [a, _] = self.fourth;
        self.fourth = [four, a];
    }
}

/// A number for every term of a polynomial.
type Terms = [f64; DEGREE_MAX + 1];

impl Foresight {
    /// Of nothing, as it is before [`Clock::tell`].
    pub fn none() -> Foresight {
        let zeros = [0.0; DEGREE_MAX + 1];
        Foresight {
            order: Order::Before,
            jumps: false,
            span: [f64::NAN; 2],
            left: [[0.0; 2]; 2],
            picked: [0; SAMPLES_MAX],
            count: 0,
            all: false,
            rate: 0.0,
            times: [f64::NAN; SAMPLES_MAX],
            inverse: Reciprocals::new(&[f64::NAN; SAMPLES_MAX]),
            reach: [zeros; JUDGED],
            value: zeros,
            slope: zeros,
            integral: zeros,
        }
    }

    /// What holds of the samples of the last step is not worked out again, but moved on by a place.
    fn renew(&mut self, clock: &Clock, order: Order, step: f64, reconstruction: Reconstruction) {
        let start = clock.times[0];
        let end = start + step;
        let (picked, count) = spaced(&clock.times[..clock.count], step / STEP_RATIO_MAX);
        // what is not in use gets times that divide nothing by zero, and is not looked at
        let t: [f64; SAMPLES_MAX] = from_fn(|i| match i < count {
            true => clock.times[picked[i]],
            false => start - (1.0 + i as f64) * step.max(f64::MIN_POSITIVE),
        });
        let reach = |j: usize| {
            let [a, b, c, d] = [1, 2, 3, 4].map(|k| t[j] - t[j + k]);
            [a, a * b, a * b * c, a * b * c * d]
        };
        if t[1..] == self.times[..SAMPLES_MAX - 1] {
            self.inverse.push(&t);
            self.reach[1] = self.reach[0];
        } else {
            self.inverse = Reciprocals::new(&t);
            self.reach[1] = reach(1);
        }
        (self.reach[0], self.times) = (reach(0), t);
        let [h, e1, e2] = [end - t[0], end - t[1], end - t[2]];
        let [a, b] = [t[0] - t[1], t[0] - t[2]];
        (self.order, self.jumps) = (order, reconstruction == Reconstruction::Jump);
        (self.span, self.rate) = ([start, end], 1.0 / (end - start));
        self.left = clock.left(step);
        (self.picked, self.count, self.all) = (picked, count, count == clock.count);
        self.value = [1.0, h, h * e1, h * e1 * e2];
        self.slope = [0.0, 1.0, h + e1, h * e1 + (h + e1) * e2];
        self.integral = [
            h,
            h * h / 2.0,
            h * h * (h / 3.0 + a / 2.0),
            h * h * (h * h / 4.0 + (a + b) * h / 3.0 + a * b / 2.0),
        ];
    }

    /// How many of the samples that count are among the `newest` of all.
    #[inline]
    fn known(&self, newest: usize) -> usize {
        if self.all {
            return self.count.min(newest);
        }
        let picked = self.picked.iter().take(self.count);
        picked.take_while(|place| **place < newest).count()
    }
}

/// Places of the times, newest first, that lie at least `spacing` [s] apart, and how many: what lies closer says more about noise than
/// about a long step.
fn spaced(times: &[f64], spacing: f64) -> ([usize; SAMPLES_MAX], usize) {
    let far = spacing * (1.0 - 1e-9);
    if let [a, b, c, d, e, f] = *times {
        let [ab, bc, cd, de, ef] = [a - b, b - c, c - d, d - e, e - f].map(|gap| gap >= far);
        if ab & bc & cd & de & ef {
            return (from_fn(|place| place), SAMPLES_MAX);
        }
    }
    let (mut picked, mut count) = ([0; SAMPLES_MAX], 0);
    let mut last = f64::INFINITY;
    for (place, &time) in times.iter().enumerate() {
        if last - time >= far {
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
        if foresight.order == Order::Before {
            (self.rated, self.degree) = (0, 0);
        }
        let to = match velocity {
            Some(velocity) => {
                self.positions = foresight.order.push(&self.positions, position);
                self.rate(foresight, position, velocity)
            }
            None => {
                self.rated = 0;
                self.predict(foresight, position)
            }
        };
        let [start, end] = foresight.span;
        if foresight.jumps {
            let velocity = velocity.unwrap_or(0.0);
            self.end = [position, velocity];
            return self.follow(
                foresight.span,
                [position + (end - start) * velocity, velocity],
            );
        }
        let missed = [self.end[0] - position, self.end[1] - to[1]];
        let left = foresight
            .left
            .map(|row| row[0] * missed[0] + row[1] * missed[1]);
        let to = [to[0] + left[0], to[1] + left[1]];
        self.curve = Hermite::bridge([start, end - start, foresight.rate], self.end, to);
        self.end = to;
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

    /// Remembers a position [m], and predicts position [m] and velocity [m/s] at the end of a step from what the host said of the position.
    #[inline]
    fn predict(&mut self, foresight: &Foresight, position: f64) -> [f64; 2] {
        let differences = Differences::new(foresight, &mut self.positions, position);
        let degree = differences.degree(foresight.count, &mut self.degree);
        [&foresight.value, &foresight.slope].map(|basis| differences.sum(degree, basis))
    }

    /// Remembers a velocity [m/s], and predicts from the velocities and the position [m] at the start of a step.
    #[inline]
    fn rate(&mut self, foresight: &Foresight, position: f64, velocity: f64) -> [f64; 2] {
        let again = usize::from(foresight.order == Order::Again);
        self.rated = (self.rated.saturating_sub(again) + 1).min(SAMPLES_MAX);
        let differences = Differences::new(foresight, &mut self.velocities, velocity);
        let degree = differences.degree(foresight.known(self.rated), &mut self.degree);
        [
            position + differences.sum(degree, &foresight.integral),
            differences.sum(degree, &foresight.value),
        ]
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
        let [x, y, z] = &self.0;
        let [x, y, z] = [x.at(t), y.at(t), z.at(t)];
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
    newest: Terms,
    /// By how much polynomials of every degree through the samples before would have missed the newest ones.
    miss: [Terms; JUDGED],
}

impl Differences {
    /// Of samples that a new one joins.
    #[inline(always)]
    fn new(foresight: &Foresight, samples: &mut [f64; SAMPLES_MAX], sample: f64) -> Differences {
        let pushed = foresight.order.push(samples, sample);
        *samples = pushed;
        // what was pushed is taken from registers: read again at once, at other places than it was written, it would hold up the step
        let zeroth = match foresight.all {
            true => pushed,
            false => foresight.picked.map(|place| samples[place]),
        };
        let by = &foresight.inverse;
        let first: [f64; SAMPLES_MAX - 1] = from_fn(|i| (zeroth[i] - zeroth[i + 1]) * by.first[i]);
        let second: [f64; SAMPLES_MAX - 2] = from_fn(|i| (first[i] - first[i + 1]) * by.second[i]);
        let third: [f64; SAMPLES_MAX - 3] = from_fn(|i| (second[i] - second[i + 1]) * by.third[i]);
        let fourth: [f64; SAMPLES_MAX - 4] = from_fn(|i| (third[i] - third[i + 1]) * by.fourth[i]);
        // the remainder of the polynomial of degree k is the difference of order k + 1 times its nodes' distances
        let miss = from_fn(|j| {
            let next = [first[j], second[j], third[j], fourth[j]];
            from_fn(|k| (next[k] * foresight.reach[j][k]).abs())
        });
        Differences {
            newest: [zeroth[0], first[0], second[0], third[0]],
            miss,
        }
    }

    /// The degree given, or the one that is set instead, because it would have predicted the newest samples clearly better from the ones
    /// older than each; of the `known` newest samples.
    #[inline(always)]
    fn degree(&self, known: usize, degree: &mut usize) -> usize {
        if known <= 2 {
            // two samples can judge no line, but a host that moves a point goes on moving it
            return known - 1;
        }
        let judged = JUDGED.min(known - 2);
        let highest = DEGREE_MAX.min(known - 1 - judged);
        let [newest, before] = &self.miss;
        let error: Terms = match judged {
            JUDGED => from_fn(|k| newest[k] + before[k]),
            _ => *newest,
        };
        let (kept, mut best, mut least) = match *degree {
            kept if kept <= highest => (kept, kept, error[kept]),
            _ => (0, 0, f64::INFINITY),
        };
        let handicaps = HANDICAPS[usize::from(kept > 0)];
        for (other, error) in error.into_iter().enumerate() {
            // over all degrees, so that the compiler unrolls it
            let handicapped = match other <= highest {
                true => error * handicaps[other],
                false => f64::INFINITY,
            };
            // what rests has no degree to keep
            if handicapped < least || (other == 0 && handicapped == 0.0) {
                (best, least) = (other, handicapped);
            }
        }
        *degree = best;
        best
    }

    /// Newton's polynomial of a degree, whose terms have the values `basis`.
    #[inline(always)]
    fn sum(&self, degree: usize, basis: &Terms) -> f64 {
        let term = |k: usize| match k <= degree {
            true => self.newest[k] * basis[k],
            false => 0.0,
        };
        (term(0) + term(1)) + (term(2) + term(3))
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
    struct Guided(Clock, AxisPath, Foresight);

    impl Guided {
        fn at_rest(time: f64, position: f64) -> Guided {
            Guided(
                Clock::new(time),
                AxisPath::at_rest(position),
                Foresight::none(),
            )
        }

        fn extend(&mut self, sample: Sample, step: f64, reconstruction: Reconstruction) {
            let foresight = &mut self.2;
            self.0.tell(sample.time, step, reconstruction, foresight);
            self.1.extend(foresight, sample.position, sample.velocity);
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

    #[test]
    fn what_is_foreseen_does_not_depend_on_what_was_foreseen_before() {
        let (mut clock, mut kept, mut time) = (Clock::new(0.0), Foresight::none(), 0.0);
        for k in 0..200 {
            // equal steps, short ones between them, the same instant again and leaps back
            let step = if k % 31 == 30 { 0.007 } else { 0.05 };
            let mut fresh = Foresight::none();
            clock
                .clone()
                .tell(time, step, Reconstruction::Smooth, &mut fresh);
            clock.tell(time, step, Reconstruction::Smooth, &mut kept);
            assert_eq!(format!("{kept:?}"), format!("{fresh:?}"), "at {time} s");
            time += match k {
                70 => 0.0,
                140 => -0.1,
                _ => step,
            };
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
    fn a_short_step_after_a_long_one_does_not_leap_back_to_the_host() {
        let mut path = Guided::at_rest(0.0, 0.0);
        let mut time = 0.0;
        for step in [10.0, 1e-3, 1e-3, 2.0, 1e-3, 4.0, 4.0, 4.0, 4.0, 4.0] {
            // at rest for 10 s as far as the path could know, and a metre off
            let there = if time > 0.0 { 1.0 } else { 0.0 };
            path.extend(sample(time, there), step, Reconstruction::Smooth);
            let fastest = (0..=100)
                .map(|k| path.at(time + 0.01 * step * f64::from(k)).slope.abs())
                .fold(0.0, f64::max);
            assert!(
                fastest < 0.6,
                "{fastest} m/s in a step of {step} s at {time} s"
            );
            time += step;
        }
        assert_relative_eq!(path.at(time).value, 1.0, epsilon = 1e-6);
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
