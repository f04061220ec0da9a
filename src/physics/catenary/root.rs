//! Roots of one increasing function of one variable, safeguarded: the bracket never widens, and every loop is bounded.

/// Maximum number of steps of any search; bisection of the whole range of doubles needs fewer.
const STEPS_MAX: usize = 200;

/// Number of steps after which a bracket is halved regardless of Newton's method, which may cycle.
const HALVE_EVERY: usize = 12;

/// Number of steps towards a root below the start before its existence is checked.
const STEPS_DOWN_MAX: usize = 4;

/// Root with the cost of finding it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Root {
    /// Argument at which the function is zero, in the unit of the argument [-].
    pub at: f64,
    /// Evaluations of the function [-].
    pub steps: usize,
}

/// Root of `function` (value, slope), increasing over (lower, upper), which may be infinite: Newton within the bracket.
///
/// The function bends on the scale `bend` about 0, so brackets are halved on asinh(x/bend). `reach` is the longest accepted step from a point,
/// `tolerance` the value that counts as zero.
pub(super) fn increasing(
    mut function: impl FnMut(f64) -> (f64, f64),
    start: f64,
    (mut lower, mut upper): (f64, f64),
    (bend, reach): (f64, impl Fn(f64) -> f64),
    tolerance: f64,
) -> Root {
    let halfway = |a: f64, b: f64| {
        if a * b > 0.0 && a / b < 4.0 && b / a < 4.0 {
            return 0.5 * (a + b);
        }
        bend * (0.5 * ((a / bend).asinh() + (b / bend).asinh())).sinh()
    };
    let mut at = start.clamp(lower, upper);
    let mut width_before = f64::INFINITY;
    for steps in 1..=STEPS_MAX {
        let (value, slope) = function(at);
        if value.abs() <= tolerance {
            return Root { at, steps };
        }
        if value < 0.0 {
            lower = at
        } else {
            upper = at
        }
        let reach = reach(at);
        // rounding may change the sign of a vanishing slope; the sign of the value then gives the direction
        let step = if slope > 0.0 {
            (-value / slope).clamp(-reach, reach)
        } else {
            -reach.copysign(value)
        };
        let (mut next, close) = (at + step, 2.0 * f64::EPSILON * at.abs());
        // a bracket that hardly shrinks is halved: Newton's method may advance slowly along a kink
        let width = upper - lower;
        if step.abs() <= close || width <= close {
            return Root {
                at: next.clamp(lower, upper),
                steps,
            };
        }
        let creeps = steps % 4 == 0 && width.is_finite() && width > 0.5 * width_before;
        if steps % 4 == 0 {
            width_before = width;
        }
        if !(next > lower && next < upper) || creeps {
            next = halfway(lower, upper);
        }
        at = next;
    }
    Root { at, steps: STEPS_MAX }
}

/// Root of `function` (value only), increasing in x > 0 and searched on ln x from `start` outwards; `lowest` if the root is below it.
pub(super) fn increasing_by_ratio(
    mut function: impl FnMut(f64) -> f64,
    start: f64,
    lowest: f64,
    tolerance: f64,
) -> Root {
    // searched on ln(x/start), which resolves the neighbourhood of a good start to the last digit
    let mut value_at = |t: f64| function(start * t.exp());
    let floor = (lowest / start).ln();
    let (mut a, mut fa) = (0.0_f64, value_at(0.0));
    let mut stride = 0.05;
    for steps in 2..=STEPS_MAX {
        if fa.abs() <= tolerance {
            return Root {
                at: start * a.exp(),
                steps,
            };
        }
        let mut b = (a - stride * fa.signum()).max(floor);
        if fa > 0.0 && steps > STEPS_DOWN_MAX {
            b = floor;
        }
        let fb = value_at(b);
        if b <= floor && fb >= 0.0 {
            return Root { at: lowest, steps };
        }
        if fa.signum() != fb.signum() {
            let inner = between(value_at, (a, fa), (b, fb), (tolerance, 0.5));
            return Root {
                at: start * inner.at.exp(),
                steps: steps + inner.steps,
            };
        }
        // distance to the root of the secant, lengthened a little to pass the root
        let secant = 1.2 * (b - a) * fb / (fa - fb);
        stride = if secant.is_finite() {
            secant.abs().clamp(1e-9, 8.0 * stride).min(5.0)
        } else {
            5.0
        };
        (a, fa) = (b, fb);
    }
    Root {
        at: start * a.exp(),
        steps: STEPS_MAX,
    }
}

/// Root of `function` between two points whose values differ in sign: inverse quadratic interpolation where it is safe, else bisection; to rounding
/// of the larger of the root and `resolution` (test of Chandrupatla 1997, Advances in Engineering Software 28, 145).
pub(super) fn between(
    mut function: impl FnMut(f64) -> f64,
    (mut a, mut fa): (f64, f64),
    (mut b, mut fb): (f64, f64),
    (tolerance, resolution): (f64, f64),
) -> Root {
    let mut fraction = fa / (fa - fb);
    for steps in 1..=STEPS_MAX {
        let at = a + fraction * (b - a);
        let value = function(at);
        let (c, fc);
        if value.signum() == fa.signum() {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (at, value);
        let (best, residual) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        let close = f64::EPSILON * best.abs().max(resolution);
        if residual.abs() <= tolerance || (b - a).abs() <= 2.0 * close {
            return Root { at: best, steps };
        }
        let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        fraction = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        } else {
            0.5
        };
        let margin = close / (b - a).abs();
        fraction = fraction.clamp(margin, 1.0 - margin);
    }
    Root {
        at: if fa.abs() < fb.abs() { a } else { b },
        steps: STEPS_MAX,
    }
}

/// Root of `function` (value, slope in ln x), increasing in x over (0, `upper`): Newton on x where `linear`, else on ln x.
pub(super) fn increasing_positive(
    mut function: impl FnMut(f64) -> (f64, f64),
    start: f64,
    (lowest, mut upper): (f64, f64),
    linear: impl Fn(f64) -> bool,
) -> Root {
    let mut at = start.clamp(lowest, upper.min(f64::MAX));
    let mut lower = 0.0_f64;
    for steps in 1..=STEPS_MAX {
        let (value, slope) = function(at);
        if value == 0.0 || (at <= lowest && value > 0.0) || (at >= upper && value < 0.0) {
            return Root { at, steps };
        }
        if value < 0.0 {
            lower = at
        } else {
            upper = at
        }
        let relative = -value / slope;
        let mut next = if linear(at) {
            at + at * relative
        } else {
            at * relative.exp()
        };
        if (next - at).abs() <= 1e-9 * at {
            // quadratic convergence: the step after this one would be below rounding
            return Root { at: next, steps };
        }
        let outside = !(next > lower && next < upper);
        if outside || (steps % HALVE_EVERY == 0 && lower > 0.0 && upper.is_finite()) {
            next = match (lower > 0.0, upper.is_finite()) {
                (true, true) => (lower * upper).sqrt(),
                (false, _) => 0.03 * at,
                (true, false) => 30.0 * at,
            };
        }
        next = next.max(lowest);
        if upper.is_finite() && upper - lower <= 2.0 * f64::EPSILON * upper {
            return Root { at: next, steps };
        }
        at = next;
    }
    Root { at, steps: STEPS_MAX }
}

#[cfg(test)]
mod tests {
    use super::{between, increasing, increasing_by_ratio, increasing_positive};

    #[test]
    fn every_search_finds_the_root_of_a_stiff_sigmoid_from_far_away() {
        let sigmoid = |x: f64| (x - 3.7) / (1e-6 + (x - 3.7).abs()) + 1e-9 * (x - 3.7);
        let slope = |x: f64| 1e-6 / (1e-6 + (x - 3.7).abs()).powi(2) + 1e-9;
        for start in [1e-9, 1.0, 3.6, 5e5] {
            let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
            let newton = increasing(
                |x| (sigmoid(x), slope(x)),
                start,
                everywhere,
                (1.0, |x: f64| 1.0 + x.abs()),
                0.0,
            );
            assert!((newton.at - 3.7).abs() < 1e-14, "{newton:?}");
            let ratio = increasing_by_ratio(sigmoid, start, 1e-30, 0.0);
            assert!((ratio.at - 3.7).abs() < 1e-13, "{ratio:?}");
            let positive = increasing_positive(
                |x| (sigmoid(x), x * slope(x)),
                start,
                (1e-30, f64::INFINITY),
                |_| false,
            );
            // the last step, 1e-9 of the root, leaves an error of 1e-11: its square over the 1e-6 on which this function bends
            assert!((positive.at - 3.7).abs() < 1e-10, "{positive:?}");
        }
        let halved = between(sigmoid, (-9.0, sigmoid(-9.0)), (1e4, sigmoid(1e4)), (0.0, 1.0));
        assert!((halved.at - 3.7).abs() < 1e-14, "{halved:?}");
    }

    #[test]
    fn a_search_that_meets_no_root_stops_at_the_lowest_value() {
        assert_eq!(
            increasing_positive(|x| (1.0 + x, x), 2.0, (1e-30, f64::INFINITY), |_| false).at,
            1e-30
        );
        assert_eq!(increasing_by_ratio(|x| 1.0 + x, 2.0, 1e-30, 0.0).at, 1e-30);
    }
}
