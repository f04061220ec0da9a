//! When a host spoke, and what that makes of predictions: the same for all that it moves.

use std::array::from_fn;

use serde::{Deserialize, Serialize};

use crate::math::lanes::Lanes;
use crate::scene::Reconstruction;

/// Highest degree of the extrapolated polynomial [-].
pub(super) const DEGREE_MAX: usize = 3;
/// Samples that a degree is judged by: one alone can be met by chance, where the motion inflects.
pub(super) const JUDGED: usize = 2;
/// Samples kept.
pub(super) const SAMPLES_MAX: usize = DEGREE_MAX + 1 + JUDGED;
/// Samples closer together than the coming step over this are passed over [-].
const STEP_RATIO_MAX: f64 = 2.0;
/// Rounding of a host's times over its steps [-].
const ROUNDING: f64 = 1e-9;

/// Of four axes, newest first.
pub(super) type Samples = [Lanes; SAMPLES_MAX];

/// When a host spoke, as far back as predictions look: at the same times of all that it moves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Newest first; the first `count` are in use [s].
    times: [f64; SAMPLES_MAX],
    count: usize,
    /// When all that was missed is to be made up [s].
    made_up: f64,
    /// The time between two samples [s] that the `even` newest pairs of neighbours are apart, but for rounding.
    gap: f64,
    even: usize,
}

/// What the time of a sample is to the samples before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Order {
    /// Later.
    After,
    /// The same instant again: the newer word counts.
    Again,
    /// Earlier: what came before is no history of it.
    Before,
}

impl Order {
    /// Samples with one more, newest first.
    #[inline(always)]
    pub(super) fn push<T: Copy>(self, samples: &[T; SAMPLES_MAX], sample: T) -> [T; SAMPLES_MAX] {
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
            gap: 0.0,
            even: 0,
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
        let order = if last_step > 0.0 {
            self.count = (self.count + 1).min(SAMPLES_MAX);
            self.made_up = self.made_up.max(time + last_step);
            if self.keeps(last_step) {
                self.even = (self.even + 1).min(SAMPLES_MAX - 1);
            } else {
                (self.gap, self.even) = (last_step, 1);
            }
            Order::After
        } else if last_step < 0.0 {
            (self.count, self.made_up, self.even) = (1, time, 0);
            Order::Before
        } else {
            Order::Again
        };
        self.times = order.push(&self.times, time);
        foresight.renew(self, order, step, reconstruction);
    }

    /// Whether a step [s] is as long as the ones before, but for rounding.
    fn keeps(&self, step: f64) -> bool {
        (step - self.gap).abs() <= ROUNDING * self.gap
    }

    /// What is left after a step [s] of a distance and a velocity by which a path misses its host now, where anything is: the cubic from both
    /// to none when all is made up. Rows of position [-, s] and velocity [1/s, -].
    fn left(&self, step: f64) -> Option<[[f64; 2]; 2]> {
        let time = self.made_up - self.times[0];
        if time <= step * (1.0 + ROUNDING) {
            return None;
        }
        let s = step / time;
        let rest = 1.0 - s;
        Some([
            [rest * rest * (1.0 + 2.0 * s), step * rest * rest],
            [-6.0 * s * rest / time, rest * (1.0 - 3.0 * s)],
        ])
    }
}

/// What the times of the samples make of a prediction, worked out once for all paths of a communication step.
///
/// A host that keeps its step is taken at its word: its samples and the end of the step are evenly apart, whatever rounding says. What
/// follows from that is then the same for every step.
#[derive(Debug, Clone)]
pub struct Foresight {
    pub(super) order: Order,
    pub(super) reconstruction: Reconstruction,
    /// Start of the step [s], its length [s] and 1/length [1/s].
    pub(super) span: [f64; 3],
    /// What is left at the end of the step of what the path misses now, see [`Clock::left`].
    pub(super) left: Option<[[f64; 2]; 2]>,
    /// The samples that count, newest first; the first `count` are in use.
    pub(super) picked: [usize; SAMPLES_MAX],
    pub(super) count: usize,
    /// Whether all samples count.
    pub(super) all: bool,
    /// Whether the host keeps its step.
    pub(super) even: bool,
    /// Unit of the times that follow [s], and its inverse [1/s]: the step where it is kept.
    pub(super) unit: [f64; 2],
    /// 1/(t_i − t_{i+k}) of the samples that count.
    pub(super) inverse: Reciprocals,
    /// Products of t_j − t_{j+1} … t_j − t_{j+k}, by place j and order k − 1.
    pub(super) reach: [Terms; JUDGED],
    /// Newton's polynomials of the newest samples at the end of the step, their slopes there and their integrals over it.
    pub(super) value: Terms,
    pub(super) slope: Terms,
    pub(super) integral: Terms,
}

/// 1/(t_i − t_{i+k}) by place i, for the orders k from 1 on. Written out, so that the compiler unrolls what is done with them.
#[derive(Debug, Clone)]
pub(super) struct Reciprocals {
    pub(super) first: [f64; SAMPLES_MAX - 1],
    pub(super) second: [f64; SAMPLES_MAX - 2],
    pub(super) third: [f64; SAMPLES_MAX - 3],
    pub(super) fourth: [f64; SAMPLES_MAX - 4],
}

impl Reciprocals {
    /// Of these times.
    fn new(t: &[f64; SAMPLES_MAX]) -> Reciprocals {
        Reciprocals {
            first: from_fn(|i| 1.0 / (t[i] - t[i + 1])),
            second: from_fn(|i| 1.0 / (t[i] - t[i + 2])),
            third: from_fn(|i| 1.0 / (t[i] - t[i + 3])),
            fourth: from_fn(|i| 1.0 / (t[i] - t[i + 4])),
        }
    }
}

/// A number for every term of a polynomial.
pub(super) type Terms = [f64; DEGREE_MAX + 1];

impl Foresight {
    /// Of nothing, as it is before [`Clock::tell`].
    pub fn none() -> Foresight {
        let zeros = [0.0; DEGREE_MAX + 1];
        Foresight {
            order: Order::Before,
            reconstruction: Reconstruction::Smooth,
            span: [f64::NAN; 3],
            left: None,
            picked: [0; SAMPLES_MAX],
            count: 0,
            all: false,
            even: false,
            unit: [1.0; 2],
            inverse: Reciprocals::new(&[f64::NAN; SAMPLES_MAX]),
            reach: [zeros; JUDGED],
            value: zeros,
            slope: zeros,
            integral: zeros,
        }
    }

    /// Of a step from a time [s] on whose end a host tells, so that nothing is predicted; its length is in [s].
    #[inline]
    pub fn reach(&mut self, start: f64, step: f64) {
        self.reconstruction = Reconstruction::Interpolate;
        self.span = [start, step, 1.0 / step];
    }

    fn renew(&mut self, clock: &Clock, order: Order, step: f64, reconstruction: Reconstruction) {
        let (was_even, start) = (self.even, clock.times[0]);
        let rate = 1.0 / step;
        (self.order, self.reconstruction) = (order, reconstruction);
        self.span = [start, step, rate];
        self.left = clock.left(step);
        self.even = clock.even == SAMPLES_MAX - 1 && clock.keeps(step);
        if self.even {
            self.unit = [step, rate];
            if !was_even {
                (self.picked, self.count) = (from_fn(|place| place), SAMPLES_MAX);
                self.all = true;
                self.foresee(&from_fn(|i| -(i as f64)), 1.0);
            }
            return;
        }
        self.unit = [1.0; 2];
        (self.picked, self.count) = spaced(&clock.times[..clock.count], step / STEP_RATIO_MAX);
        self.all = self.count == clock.count;
        // what is not in use gets times that divide nothing by zero, and is not looked at
        let t: [f64; SAMPLES_MAX] = from_fn(|i| match i < self.count {
            true => clock.times[self.picked[i]],
            false => start - (1.0 + i as f64) * step.max(f64::MIN_POSITIVE),
        });
        self.foresee(&t, start + step);
    }

    /// From samples at the times `t` to an end.
    fn foresee(&mut self, t: &[f64; SAMPLES_MAX], end: f64) {
        self.inverse = Reciprocals::new(t);
        self.reach = from_fn(|j| {
            let [a, b, c, d] = [1, 2, 3, 4].map(|k| t[j] - t[j + k]);
            [a, a * b, a * b * c, a * b * c * d]
        });
        let [h, e1, e2] = [end - t[0], end - t[1], end - t[2]];
        let [a, b] = [t[0] - t[1], t[0] - t[2]];
        self.value = [1.0, h, h * e1, h * e1 * e2];
        self.slope = [0.0, 1.0, h + e1, h * e1 + (h + e1) * e2];
        self.integral = [
            h,
            h * h / 2.0,
            h * h * (h / 3.0 + a / 2.0),
            h * h * (h * h / 4.0 + (a + b) * h / 3.0 + a * b / 2.0),
        ];
    }

    /// The samples that count.
    pub(super) fn pick(&self, samples: &Samples) -> Samples {
        self.picked.map(|place| samples[place])
    }

    /// How many of the samples that count are among the `newest` of all.
    #[inline(always)]
    pub(super) fn known(&self, newest: usize) -> usize {
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
