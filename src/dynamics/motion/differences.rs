//! Polynomials through the newest samples, and the degree with the smallest expected error.

use super::extrapolation::{
    DEGREE_MAX, Extrapolation, JUDGED, Reciprocals, SAMPLES_MAX, Samples, Terms, VelocityTerms,
};
use crate::math::lanes::{LANES, Lanes};

/// Ratio of the error of another degree to that of the current one, below which it replaces the current one [-]. On harmonic motions any
/// value from 0.3 to 0.9 separates rounding from motion, except ½, which occurs exactly by symmetry; 0.45 predicts them best.
const BETTER: f64 = 0.45;
/// The same for a change to and from degree 0 [-], so that a point that comes to rest, jumps or starts moving is followed
/// at once.
const BETTER_AT_REST: f64 = 0.9;
/// Factors on the errors of all degrees except the current one [-]: where that is 0, and where it is another.
const HANDICAPS: [Terms; 2] = [
    [1.0 / BETTER_AT_REST; DEGREE_MAX + 1],
    [1.0 / BETTER_AT_REST, 1.0 / BETTER, 1.0 / BETTER, 1.0 / BETTER],
];
/// Ratio of the step to the time between the first two samples, above which they do not determine a line [-].
const UNJUDGED_MAX: f64 = 2.0;

pub(super) struct Differences {
    /// Differences of the newest samples, by order from 0 on.
    newest: [Lanes; DEGREE_MAX + 1],
    /// Difference of the next order.
    next: Lanes,
    /// Errors at the newest samples of the polynomials of each degree through earlier samples.
    miss: [[Lanes; DEGREE_MAX + 1]; JUDGED],
    /// Factors from these errors to those at the end of the step; `None` on equal steps.
    stretch: Option<[Terms; JUDGED]>,
}

impl Differences {
    #[inline(always)]
    pub(super) fn new(extrapolation: &Extrapolation, [a, b, c, d, e, f]: Samples) -> Differences {
        let Reciprocals {
            first: [ab, bc, cd, de, ef],
            second: [ac, bd, ce, df],
            third: [ad, be, cf],
            fourth: [ae, bf],
        } = extrapolation.inverse;
        let over = |change: Lanes, inverse: f64| change * Lanes::splat(inverse);
        let (p, q, r) = (over(a - b, ab), over(b - c, bc), over(c - d, cd));
        let (s, t) = (over(d - e, de), over(e - f, ef));
        let (pq, qr, rs, st) = (over(p - q, ac), over(q - r, bd), over(r - s, ce), over(s - t, df));
        let (pr, qs, rt) = (over(pq - qr, ad), over(qr - rs, be), over(rs - st, cf));
        let (ps, qt) = (over(pr - qs, ae), over(qs - rt, bf));
        // the remainder of the polynomial of degree k is the difference of order k + 1 times its nodes' distances
        let [[r0, r1, r2, r3], [s0, s1, s2, s3]] = extrapolation.reach;
        let miss = |next: Lanes, reach: f64| over(next, reach).abs();
        let newest = miss(ps, r3);
        // where a sample is skipped, there is no second difference of fourth order
        let before = if extrapolation.all { miss(qt, s3) } else { newest };
        Differences {
            newest: [a, p, pq, pr],
            next: ps,
            miss: [
                [miss(p, r0), miss(pq, r1), miss(pr, r2), newest],
                [miss(q, s0), miss(qr, s1), miss(qs, s2), before],
            ],
            stretch: (!extrapolation.even).then_some(extrapolation.stretch),
        }
    }

    /// Updates and returns the degrees: each is kept unless the expected error of another is clearly smaller. Uses the `known`
    /// newest samples.
    #[inline(always)]
    pub(super) fn degree(&self, known: usize, degree: &mut Lanes) -> Lanes {
        if known < SAMPLES_MAX || self.stretch.is_some() {
            return self.degree_of_any(known, degree);
        }
        let [newest, before] = &self.miss;
        let error = |k: usize| newest[k] + before[k];
        let error = [error(0), error(1), error(2), error(3)];
        let kept = *degree;
        let low = above(kept, 1).choose(error[1], error[0]);
        let high = above(kept, 3).choose(error[3], error[2]);
        let own = above(kept, 2).choose(high, low);
        let factor = |better: f64| Lanes::splat(1.0 / better);
        let moves = above(kept, 1).choose(factor(BETTER), factor(BETTER_AT_REST));
        let other = error[1].min(error[2]).min(error[3]) * moves;
        let other = other.min(error[0] * factor(BETTER_AT_REST));
        // another degree is clearly better, or the point rests and its degree is not 0
        let rests = kept - error[0] * Lanes::splat(f64::MAX);
        if (own - other).any_positive() || rests.any_positive() {
            (0..LANES).for_each(|axis| degree[axis] = self.judge(SAMPLES_MAX, kept[axis], axis));
        }
        *degree
    }

    /// [`Differences::degree`] for any number of samples at any times.
    #[cold]
    #[inline(never)]
    fn degree_of_any(&self, known: usize, degree: &mut Lanes) -> Lanes {
        if known <= 2 {
            // two samples cannot assess degree 1, but a host that moves a point usually continues to do so: degree 1 is
            // used unless the step is too long
            let far = |stretch: &[Terms; JUDGED]| stretch[0][0] > UNJUDGED_MAX;
            let line = known == 2 && !self.stretch.as_ref().is_some_and(far);
            return Lanes::splat(f64::from(u8::from(line)));
        }
        (0..LANES).for_each(|axis| degree[axis] = self.judge(known, degree[axis], axis));
        *degree
    }

    /// Degree along an axis with the smallest expected error; `degree` is the current one.
    #[cold]
    #[inline(never)]
    fn judge(&self, known: usize, degree: f64, axis: usize) -> f64 {
        let judged = JUDGED.min(known - 2);
        let highest = DEGREE_MAX.min(known - 1 - judged);
        let kept = degree as usize;
        // a point at rest that jumps within a short step does not continue like that over a longer one
        let stretch = self.stretch.filter(|_| kept > 0);
        let stretch = stretch.unwrap_or([[1.0; DEGREE_MAX + 1]; JUDGED]);
        let error = |k: usize| -> f64 {
            let errors = self.miss.iter().zip(&stretch).take(judged);
            errors.map(|(miss, stretch)| miss[k][axis] * stretch[k]).sum()
        };
        let (kept, mut best, mut least) = match kept <= highest {
            true => (kept, kept, error(kept)),
            false => (0, 0, f64::INFINITY),
        };
        let handicaps = HANDICAPS[usize::from(kept > 0)];
        for (other, handicap) in handicaps.into_iter().enumerate().take(highest + 1) {
            let handicapped = error(other) * handicap;
            // a point at rest always gets degree 0
            if handicapped < least || (other == 0 && handicapped == 0.0) {
                (best, least) = (other, handicapped);
            }
        }
        best as f64
    }

    /// Sums of Newton's polynomials of these degrees; `basis` holds the values of the terms.
    #[inline(always)]
    pub(super) fn sum<const N: usize>(&self, degree: Lanes, basis: &[f64; N]) -> Lanes {
        let term = |k: usize| {
            let term = self.newest[k] * Lanes::splat(basis[k]);
            term.where_positive(above(degree, k))
        };
        (term(0) + term(1)) + (term(2) + term(3))
    }

    /// Velocities of polynomials of these degrees; those of the highest degree have one more term. `basis` holds the velocities of the terms.
    #[inline(always)]
    pub(super) fn velocity(&self, degree: Lanes, basis: &VelocityTerms) -> Lanes {
        let next = self.next * Lanes::splat(basis[DEGREE_MAX + 1]);
        self.sum(degree, basis) + next.where_positive(above(degree, DEGREE_MAX))
    }
}

/// Positive where a degree is at least k.
#[inline(always)]
pub(super) fn above(degree: Lanes, k: usize) -> Lanes {
    degree - Lanes::splat(k as f64 - 0.5)
}
