//! Time of a tridiagonal solve, striped over four lanes, with the best vectors of the machine and with portable ones, compared with Thomas's
//! elimination and its variant from both ends.

use std::hint::black_box;
use std::time::Instant;

use moorline::math::lanes::Lanes;
use moorline::math::random::Random;
use moorline::math::striped_tridiagonal::{Eliminated, Equations};
use moorline::math::striping::Striping;
use moorline::math::unit::VectorUnit;
use pulp::NullaryFnOnce;

/// Number of repetitions, of which the fastest counts, and of solves in each.
const REPETITIONS: usize = 300;
const SOLVES: usize = 200;

/// Striped system and workspace for its solution.
struct Folded {
    equations: Vec<Equations>,
    eliminated: Vec<Eliminated>,
    solution: Vec<Lanes>,
}

impl Folded {
    fn new(system: &System) -> Folded {
        let striping = Striping::new(system.right.len());
        let column = |values: &[f64], padding| striping.column(values, padding);
        let [lower, upper, right] =
            [&system.lower, &system.upper, &system.right].map(|values| column(values, 0.0));
        let diagonal = column(&system.diagonal, 1.0);
        let equation = |row| Equations {
            lower: lower.load(row),
            diagonal: diagonal.load(row),
            upper: upper.load(row),
            right: right.load(row),
        };
        Folded {
            equations: (1..=striping.rows()).map(equation).collect(),
            eliminated: vec![Eliminated::start(); striping.rows()],
            solution: vec![Lanes::splat(0.0); striping.rows()],
        }
    }
}

struct Solve<'a>(&'a mut Folded);

impl NullaryFnOnce for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Folded {
            equations,
            eliminated,
            solution,
        } = self.0;
        let last = equations.len() - 1;
        let mut above = Eliminated::start();
        for row in 0..last {
            if row > 0 {
                above = eliminated[row - 1];
            }
            eliminated[row] = above.eliminate(&equations[row]);
        }
        if last > 0 {
            above = eliminated[last - 1];
        }
        let (before, mut after) = above.close(&equations[last]);
        solution[last] = after;
        for (x, eliminated) in solution[..last].iter_mut().zip(eliminated.iter()).rev() {
            after = eliminated.substitute(before, after);
            *x = after;
        }
    }
}

/// System in the order of its equations.
struct System {
    lower: Vec<f64>,
    diagonal: Vec<f64>,
    upper: Vec<f64>,
    right: Vec<f64>,
}

fn thomas(system: &System, pivot: &mut [f64], x: &mut [f64]) {
    let count = x.len();
    let (lower, upper) = (&system.lower[..count], &system.upper[..count]);
    let (diagonal, right, pivot) = (
        &system.diagonal[..count],
        &system.right[..count],
        &mut pivot[..count],
    );
    (pivot[0], x[0]) = (1.0 / diagonal[0], right[0]);
    for i in 1..count {
        let factor = lower[i] * pivot[i - 1];
        pivot[i] = 1.0 / (diagonal[i] - factor * upper[i - 1]);
        x[i] = right[i] - factor * x[i - 1];
    }
    x[count - 1] *= pivot[count - 1];
    for i in (0..count - 1).rev() {
        x[i] = (x[i] - upper[i] * x[i + 1]) * pivot[i];
    }
}

/// [`thomas`] from both ends at once; for an even number of equations, at least four.
fn twisted(system: &System, pivot: &mut [f64], x: &mut [f64]) {
    let count = x.len();
    let (lower, upper) = (&system.lower[..count], &system.upper[..count]);
    let (diagonal, right, pivot) = (
        &system.diagonal[..count],
        &system.right[..count],
        &mut pivot[..count],
    );
    let (half, end) = (count / 2, count - 1);
    (pivot[0], x[0]) = (1.0 / diagonal[0], right[0]);
    (pivot[end], x[end]) = (1.0 / diagonal[end], right[end]);
    for i in 1..half {
        let (k, down, up) = (
            end - i,
            lower[i] * pivot[i - 1],
            upper[end - i] * pivot[end - i + 1],
        );
        pivot[i] = 1.0 / (diagonal[i] - down * upper[i - 1]);
        pivot[k] = 1.0 / (diagonal[k] - up * lower[k + 1]);
        (x[i], x[k]) = (right[i] - down * x[i - 1], right[k] - up * x[k + 1]);
    }
    let (a, b) = (half - 1, half);
    let (c, d) = (upper[a] * pivot[a], lower[b] * pivot[b]);
    let (p, q) = (x[a] * pivot[a], x[b] * pivot[b]);
    let inverse = 1.0 / (1.0 - c * d);
    (x[a], x[b]) = ((p - c * q) * inverse, (q - d * p) * inverse);
    for i in 1..half {
        let (i, k) = (a - i, b + i);
        x[i] = (x[i] - upper[i] * x[i + 1]) * pivot[i];
        x[k] = (x[k] - lower[k] * x[k - 1]) * pivot[k];
    }
}

/// Minimum time of a solve [ns].
fn time(mut solve: impl FnMut()) -> f64 {
    let run = |_| {
        let clock = Instant::now();
        (0..SOLVES).for_each(|_| solve());
        clock.elapsed().as_secs_f64()
    };
    1e9 / SOLVES as f64 * (0..REPETITIONS).map(run).fold(f64::INFINITY, f64::min)
}

fn main() {
    let mut random = Random::new(1);
    println!(
        "{:>5} {:>10} {:>10} {:>10} {:>10}",
        "n", "folded", "portable", "Thomas", "both ends"
    );
    for count in [20, 40, 80, 160, 320] {
        let mut numbers = |shift| (0..count).map(|_| shift - random.unit()).collect();
        let mut system = System {
            lower: numbers(0.0),
            diagonal: numbers(4.0),
            upper: numbers(0.0),
            right: numbers(0.0),
        };
        (system.lower[0], system.upper[count - 1]) = (0.0, 0.0);
        let mut folded = Folded::new(&system);
        let [widest, portable] = [VectorUnit::best(), VectorUnit::portable()]
            .map(|unit| time(|| unit.dispatch(Solve(black_box(&mut folded)))));
        let (mut pivot, mut x) = (vec![0.0; count], vec![0.0; count]);
        let from_one = time(|| thomas(black_box(&system), &mut pivot, black_box(&mut x)));
        let from_both = time(|| twisted(black_box(&system), &mut pivot, black_box(&mut x)));
        println!("{count:>5} {widest:>7.0} ns {portable:>7.0} ns {from_one:>7.0} ns {from_both:>7.0} ns");
    }
}
