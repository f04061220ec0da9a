//! Sine, cosine and exponential of four numbers at once, without a branch, so that loops over them become vector code.
//!
//! sin x = (−1)ⁿ sin r,  cos x = (−1)ⁿ cos r,  x = nπ + r;     exp x = 2ⁿ exp r,  x = n ln 2 + r
//!
//! with the series of Taylor in r and n rounded by adding and subtracting 1.5·2⁵². Absolute error of sine and cosine below 1e-15 for
//! |x| ≤ 100 and 2e-15 for |x| ≤ 1e5; relative error of the exponential below 5e-16 for −708 ≤ x ≤ 708. Results are the same on every
//! machine, bit for bit.
//!
//! Source: Cody & Waite (1980), Software Manual for the Elementary Functions, chapters 6 and 8 (reduction in two and three parts).

use super::lanes::Lanes;

/// Rounds to whole numbers when it is added: the lowest bits of the sum are the whole number.
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²
/// π in three parts, the first two with zeros at their ends so that n times them is exact.
const PI_PARTS: [f64; 3] = [
    3.141_592_653_468_251_2,
    1.215_420_101_260_793_2e-10,
    4.044_532_497_591_901e-21,
];
/// ln 2 in two parts.
const LN_2_PARTS: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
/// Least and greatest argument of the exponential.
const EXPONENT_MAX: f64 = 708.0;

/// 1/n! with alternating sign for the sine, from r³ on.
const SINE: [f64; 9] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
    -1.0 / 121_645_100_408_832_000.0,
];
/// The same for the cosine, from r² on.
const COSINE: [f64; 10] = [
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
    -1.0 / 6_402_373_705_728_000.0,
    1.0 / 2_432_902_008_176_640_000.0,
];
/// 1/n! for the exponential, from r² on.
const EXPONENTIAL: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// c₀ + x c₁ + x² c₂ + …
#[inline(always)]
fn series<const N: usize>(coefficients: &[f64; N], x: Lanes) -> Lanes {
    let mut sum = Lanes::splat(coefficients[N - 1]);
    for coefficient in coefficients[..N - 1].iter().rev() {
        sum = sum * x + Lanes::splat(*coefficient);
    }
    sum
}

/// sin x and cos x.
#[inline(always)]
pub fn sin_cos(x: Lanes) -> (Lanes, Lanes) {
    let shifted = x * Lanes::splat(std::f64::consts::FRAC_1_PI) + Lanes::splat(ROUND);
    let n = shifted - Lanes::splat(ROUND);
    let mut r = x;
    for part in PI_PARTS {
        r = r - n * Lanes::splat(part);
    }
    let square = r * r;
    let sine = r + r * square * series(&SINE, square);
    let cosine = Lanes::splat(1.0) + square * series(&COSINE, square);
    let odd = shifted.shifted_bits(0, 63);
    (sine.flip_signs(odd), cosine.flip_signs(odd))
}

/// exp x for |x| ≤ 708; beyond, the value at that limit.
#[inline(always)]
pub fn exp(x: Lanes) -> Lanes {
    let (least, most) = (Lanes::splat(-EXPONENT_MAX), Lanes::splat(EXPONENT_MAX));
    let x = (most - x).choose(x, most);
    let x = (x - least).choose(x, least);
    let shifted = x * Lanes::splat(std::f64::consts::LOG2_E) + Lanes::splat(ROUND);
    let n = shifted - Lanes::splat(ROUND);
    let mut r = x;
    for part in LN_2_PARTS {
        r = r - n * Lanes::splat(part);
    }
    let power = Lanes::splat(1.0) + r + r * r * series(&EXPONENTIAL, r);
    power * Lanes::from_bits(shifted.shifted_bits(1023, 52))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::lanes::LANES;

    fn values(lanes: Lanes) -> [f64; LANES] {
        let mut values = [0.0; LANES];
        lanes.store(&mut values, 0);
        values
    }

    /// Numbers on both sides of zero up to a limit, four at a time.
    fn numbers(limit: f64) -> impl Iterator<Item = [f64; LANES]> {
        let golden = 0.618_033_988_749_894_9;
        (0..50_000_u32).map(move |i| {
            std::array::from_fn(|lane| {
                let part = (f64::from(i) * golden + 0.25 * lane as f64).fract();
                limit * (2.0 * part - 1.0)
            })
        })
    }

    #[test]
    fn sine_and_cosine_are_right_to_the_error_that_is_stated() {
        for (limit, error) in [(3.0, 1e-15), (100.0, 1e-15), (1e5, 2e-15)] {
            for four in numbers(limit) {
                let (sine, cosine) = sin_cos(Lanes::load(&four, 0));
                for (x, (s, c)) in four.iter().zip(values(sine).iter().zip(values(cosine))) {
                    assert!((s - x.sin()).abs() < error, "sin {x}: {:e}", s - x.sin());
                    assert!((c - x.cos()).abs() < error, "cos {x}: {:e}", c - x.cos());
                }
            }
        }
    }

    #[test]
    fn the_exponential_is_right_to_the_error_that_is_stated() {
        for limit in [0.3, 1.0, 20.0, 708.0] {
            for four in numbers(limit) {
                for (x, found) in four.iter().zip(values(exp(Lanes::load(&four, 0)))) {
                    let relative = found / x.exp() - 1.0;
                    assert!(relative.abs() < 5e-16, "exp {x}: {relative:e}");
                }
            }
        }
        assert_eq!(
            values(exp(Lanes::splat(-1e9)))[0],
            values(exp(Lanes::splat(-708.0)))[0]
        );
        assert_eq!(values(exp(Lanes::splat(0.0)))[0], 1.0);
    }
}
