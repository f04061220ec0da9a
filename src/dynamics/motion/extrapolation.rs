//! Times of a host's samples, and the factors of predictions that follow from them, shared by all points that the host
//! moves.

use std::array::from_fn;

use serde::{Deserialize, Serialize};

use crate::math::lanes::Lanes;
use crate::scene::Reconstruction;

/// Highest degree of the extrapolated polynomial [-].
pub(super) const DEGREE_MAX: usize = 3;
/// Number of samples by which a degree is assessed: a single one can be matched by chance at an inflection of the motion.
pub(super) const JUDGED: usize = 2;
pub(super) const SAMPLES_MAX: usize = DEGREE_MAX + 1 + JUDGED;
/// Ratio of the longest step in the record to the time between two samples, above which only one of them is used [-]. A step
/// h amplifies noise ε in samples δ apart to ε(h/δ)ᵏ; but one sample fewer is one degree fewer. On `oc3_catenary`, a value
/// of 12 makes the error in tension up to four times as large where steps vary by a factor of 20. A value of 100 does not
/// reduce it, and amplifies a noise of 1 µm three times as much in a step of 3 s after steps of 0.05 s.
const STEP_RATIO_MAX: f64 = 30.0;
/// Time between two samples, in steps, from which both are always used [-]: a host that continues in short steps after a
/// long one then soon has a complete record.
const STEPS_PASSED_MAX: f64 = 4.0;
/// Tolerance for rounding of a host's times, relative to its steps [-].
pub(super) const ROUNDING: f64 = 1e-9;

/// Samples of four axes, newest first.
pub(super) type Samples = [Lanes; SAMPLES_MAX];

/// Times of a host's samples, as far back as predictions need, shared by all that the host moves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Newest first; the first `count` are in use [s].
    times: [f64; SAMPLES_MAX],
    count: usize,
    /// Time by which the error of the path is removed [s].
    made_up: f64,
    /// Time between samples [s], equal except for rounding in the `even` newest pairs of neighbours.
    gap: f64,
    even: usize,
}

/// Order of a sample's time relative to the earlier samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Order {
    /// Later.
    After,
    /// Later; the sample replaces the previous one, which is too close to the one before it.
    Instead,
    /// At the same time; the sample replaces the previous one.
    Again,
    /// Earlier; all previous samples are discarded.
    Before,
}

impl Order {
    /// Returns the samples with a new one, newest first.
    #[inline(always)]
    pub(super) fn push<T: Copy>(self, samples: &[T; SAMPLES_MAX], sample: T) -> [T; SAMPLES_MAX] {
        let [a, b, c, d, e, f] = *samples;
        match self {
            Order::After => [sample, a, b, c, d, e],
            Order::Instead | Order::Again | Order::Before => [sample, b, c, d, e, f],
        }
    }
}

impl Clock {
    /// Clock that starts at a time [s].
    pub fn new(time: f64) -> Clock {
        Clock {
            times: [time; SAMPLES_MAX],
            count: 1,
            made_up: time,
            gap: 0.0,
            even: 0,
        }
    }

    /// Times from the second newest sample to the newest, and from the third to the second [s]; `None` unless all are known and in order.
    pub fn gaps(&self) -> Option<[f64; 2]> {
        let [newest, last, second, ..] = self.times;
        let gaps = [newest - last, last - second];
        (self.count > 2 && gaps.iter().all(|&gap| gap > 0.0)).then_some(gaps)
    }

    /// Adds the sample of a step of length `step` [s] from `time` [s], taken at its end with [`Reconstruction::Interpolate`], else at its start. Sets
    /// `extrapolation` for the continuation of the paths over the step; its previous content is not used.
    pub fn add_sample(
        &mut self,
        time: f64,
        step: f64,
        reconstruction: Reconstruction,
        extrapolation: &mut Extrapolation,
    ) {
        let taken = match reconstruction {
            Reconstruction::Interpolate => time + step,
            _ => time,
        };
        let last_step = taken - self.times[0];
        let order = if last_step > 0.0 {
            self.made_up = self.made_up.max(taken + last_step);
            self.follow(taken, last_step, step)
        } else if last_step < 0.0 {
            (self.count, self.made_up, self.even) = (1, taken, 0);
            Order::Before
        } else {
            Order::Again
        };
        self.times = order.push(&self.times, taken);
        extrapolation.renew(self, order, step, reconstruction);
        extrapolation.span = [time, step, 1.0 / step];
    }

    /// Adds a time [s], `last_step` [s] after the newest one and `step` [s] before the next.
    fn follow(&mut self, time: f64, last_step: f64, step: f64) -> Order {
        if self.crowds(last_step.max(step)) {
            (self.gap, self.even) = (time - self.times[1], 1);
            return Order::Instead;
        }
        self.count = (self.count + 1).min(SAMPLES_MAX);
        if self.keeps(last_step) {
            self.even = (self.even + 1).min(SAMPLES_MAX - 1);
        } else {
            (self.gap, self.even) = (last_step, 1);
        }
        Order::After
    }

    /// Returns whether the newest two samples are too close together for both to be used in a step [s].
    fn crowds(&self, step: f64) -> bool {
        if self.count < 2 || (self.even == SAMPLES_MAX - 1 && self.keeps(step)) {
            return false;
        }
        let least = (self.longest(step) / STEP_RATIO_MAX).min(STEPS_PASSED_MAX * step);
        self.times[0] - self.times[1] < least * (1.0 - ROUNDING)
    }

    /// Longest time between two successive samples [s], or the step [s] if it is longer.
    fn longest(&self, step: f64) -> f64 {
        let pairs = self.times[..self.count].windows(2);
        pairs.map(|pair| pair[0] - pair[1]).fold(step, f64::max)
    }

    /// Returns whether a step [s] is as long as the previous ones, except for rounding.
    fn keeps(&self, step: f64) -> bool {
        (step - self.gap).abs() <= ROUNDING * self.gap
    }
}

/// Factors of a prediction that follow from the times of the samples, evaluated once for all paths of a communication
/// step.
///
/// If the host keeps its step, the samples and the end of the step are taken as exactly equidistant, regardless of
/// rounding. The factors are then the same for every step.
#[derive(Debug, Clone)]
pub struct Extrapolation {
    pub(super) order: Order,
    pub(super) reconstruction: Reconstruction,
    /// Start of the step [s], its length [s] and 1/length [1/s].
    pub(super) span: [f64; 3],
    /// Shortest and longest time in which the current error of the path is removed [s]; `None` if it is removed within the
    /// step.
    pub(super) late: Option<[f64; 2]>,
    /// Number of samples by which a degree can be assessed.
    pub(super) count: usize,
    /// True if all samples are used; otherwise the second newest is skipped.
    pub(super) all: bool,
    /// True if the host keeps its step.
    pub(super) even: bool,
    /// Unit of the times in the following fields [s], and its inverse [1/s]: the step if the host keeps it, else 1 s.
    pub(super) unit: [f64; 2],
    /// 1/(t_i − t_{i+k}) of the samples that are used.
    pub(super) inverse: Reciprocals,
    /// Products (t_j − t_{j+1}) … (t_j − t_{j+k}), by sample j and k − 1.
    pub(super) reach: [Terms; JUDGED],
    /// Products of the times from the newest k samples to the end of the step, divided by `reach`.
    pub(super) stretch: [Terms; JUDGED],
    /// Terms of Newton's polynomial of the newest samples at the end of the step, their slopes there and at the newest sample, and their integrals over
    /// the step.
    pub(super) value: VelocityTerms,
    pub(super) slope: VelocityTerms,
    pub(super) slope_before: VelocityTerms,
    pub(super) integral: Terms,
}

/// 1/(t_i − t_{i+k}) by sample i, for the orders k from 1 to 4. Separate fields allow the compiler to unroll the loops over
/// them.
#[derive(Debug, Clone)]
pub(super) struct Reciprocals {
    pub(super) first: [f64; SAMPLES_MAX - 1],
    pub(super) second: [f64; SAMPLES_MAX - 2],
    pub(super) third: [f64; SAMPLES_MAX - 3],
    pub(super) fourth: [f64; SAMPLES_MAX - 4],
}

impl Reciprocals {
    fn new(t: &[f64; SAMPLES_MAX]) -> Reciprocals {
        Reciprocals {
            first: from_fn(|i| 1.0 / (t[i] - t[i + 1])),
            second: from_fn(|i| 1.0 / (t[i] - t[i + 2])),
            third: from_fn(|i| 1.0 / (t[i] - t[i + 3])),
            fourth: from_fn(|i| 1.0 / (t[i] - t[i + 4])),
        }
    }
}

/// Returns 1 for equal steps [s], 0 if the longest is at least twice the shortest, and a linear function of their ratio in between [-].
pub(super) fn evenness(steps: &[f64]) -> f64 {
    let shortest = steps.iter().fold(f64::INFINITY, |least, &step| least.min(step));
    let longest = steps.iter().fold(0.0, |most: f64, &step| most.max(step));
    (2.0 - longest / shortest).clamp(0.0, 1.0)
}

pub(super) type Terms = [f64; DEGREE_MAX + 1];
/// [`Terms`] for velocities, with one more term; it is 0 on uneven steps.
pub(super) type VelocityTerms = [f64; DEGREE_MAX + 2];

impl Extrapolation {
    /// Empty extrapolation, before the first sample.
    pub fn none() -> Extrapolation {
        let zeros = [0.0; DEGREE_MAX + 1];
        Extrapolation {
            order: Order::Before,
            reconstruction: Reconstruction::Smooth,
            span: [f64::NAN; 3],
            late: None,
            count: 0,
            all: false,
            even: false,
            unit: [1.0; 2],
            inverse: Reciprocals::new(&[f64::NAN; SAMPLES_MAX]),
            reach: [zeros; JUDGED],
            stretch: [zeros; JUDGED],
            value: [0.0; DEGREE_MAX + 2],
            slope: [0.0; DEGREE_MAX + 2],
            slope_before: [0.0; DEGREE_MAX + 2],
            integral: zeros,
        }
    }

    /// Evaluates the factors of a prediction over a step [s] from the newest sample. With [`Reconstruction::Interpolate`] this sample is the end
    /// of the path, and only the choice of the degree and the slopes at the sample are used.
    fn renew(&mut self, clock: &Clock, order: Order, step: f64, reconstruction: Reconstruction) {
        let (was_even, start) = (self.even, clock.times[0]);
        let rate = 1.0 / step;
        (self.order, self.reconstruction) = (order, reconstruction);
        let late = clock.made_up - start;
        let is_late = late > step * (1.0 + ROUNDING);
        self.late = is_late.then(|| [clock.longest(step).min(late), late]);
        self.even = clock.even == SAMPLES_MAX - 1 && clock.keeps(step);
        if self.even {
            self.unit = [step, rate];
            if !was_even {
                (self.count, self.all) = (SAMPLES_MAX, true);
                self.evaluate(&from_fn(|i| -(i as f64)), 1.0);
            }
            return;
        }
        self.unit = [1.0; 2];
        self.all = !clock.crowds(step);
        self.count = self.usable(clock.count);
        let times = self.pick(&clock.times);
        let known = clock.count - usize::from(!self.all);
        // unused entries get distinct times, which avoid a division by zero; they are not read
        let t: [f64; SAMPLES_MAX] = from_fn(|i| match i < known {
            true => times[i],
            false => times[known - 1] - (1.0 + i as f64) * step.max(f64::MIN_POSITIVE),
        });
        self.evaluate(&t, start + step);
    }

    /// Evaluates the factors for samples at the times `t` and a step that ends at `end`.
    fn evaluate(&mut self, t: &[f64; SAMPLES_MAX], end: f64) {
        self.inverse = Reciprocals::new(t);
        let [h, e1, e2, e3] = [end - t[0], end - t[1], end - t[2], end - t[3]];
        let [a, b] = [t[0] - t[1], t[0] - t[2]];
        self.reach = from_fn(|j| {
            let [a, b, c, d] = [1, 2, 3, 4].map(|k| t[j] - t[j + k]);
            [a, a * b, a * b * c, a * b * c * d]
        });
        let ahead = [h, h * e1, h * e1 * e2, h * e1 * e2 * e3];
        self.stretch = self.reach.map(|reach| from_fn(|k| ahead[k] / reach[k]));
        if !self.all {
            self.stretch[1][DEGREE_MAX] = self.stretch[0][DEGREE_MAX];
        }
        let third = h * e1 + (h + e1) * e2;
        let next = evenness(&[h, a, t[1] - t[2], t[2] - t[3], t[3] - t[4]]);
        self.value = [1.0, h, h * e1, h * e1 * e2, next * h * e1 * e2 * e3];
        self.slope = [0.0, 1.0, h + e1, third, next * (third * e3 + h * e1 * e2)];
        self.slope_before = [0.0, 1.0, a, a * b, next * a * b * (t[0] - t[3])];
        self.integral = [
            h,
            h * h / 2.0,
            h * h * (h / 3.0 + a / 2.0),
            h * h * (h * h / 4.0 + (a + b) * h / 3.0 + a * b / 2.0),
        ];
    }

    /// Returns the samples that are used, newest first, followed by unused values.
    pub(super) fn pick<T: Copy>(&self, &[a, b, c, d, e, f]: &[T; SAMPLES_MAX]) -> [T; SAMPLES_MAX] {
        match self.all {
            true => [a, b, c, d, e, f],
            false => [a, c, d, e, f, f],
        }
    }

    /// Number of samples by which a degree can be assessed, if only the `newest` ones are available.
    #[inline(always)]
    pub(super) fn known(&self, newest: usize) -> usize {
        self.count.min(self.usable(newest))
    }

    /// The same for a record of `newest` samples. If one sample of a complete record is skipped, the highest degree is
    /// assessed by one sample instead of two.
    fn usable(&self, newest: usize) -> usize {
        let passed_over = !self.all && (2..SAMPLES_MAX).contains(&newest);
        newest - usize::from(passed_over)
    }
}
