//! Sine, cosine and exponential of four numbers at once, without branches, so that loops over them vectorise.
//!
//! sin x = (−1)ⁿ sin r,  cos x = (−1)ⁿ cos r,  x = nπ + r;     exp x = 2ⁿ exp r,  x = n ln 2 + r
//!
//! with minimax polynomials in r, and n rounded by adding and subtracting 1.5·2⁵². The absolute error of sine and cosine is below 2e-12 for |x| ≤
//! 1e5, the relative error of the exponential below 2e-12 for −708 ≤ x ≤ 708. Sums over waves, which leave out contributions of up to 1e-4, need no
//! more. Results are the same on every machine, bit for bit.
//!
//! Source: Cody & Waite (1980), Software Manual for the Elementary Functions, chapters 6 and 8 (reduction in parts); coefficients by the Remez
//! exchange algorithm.

use super::lanes::Lanes;

/// Rounds a number to an integer when added to it: the lowest bits of the sum are the integer.
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²
/// π in two parts; the first ends in zero bits, so that its product with n is exact.
const PI_PARTS: [f64; 2] = [3.141_592_653_468_251_2, 1.215_420_101_301_238_4e-10];
/// ln 2 in two parts.
const LN_2_PARTS: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
/// Largest magnitude of the exponential's argument.
const EXPONENT_MAX: f64 = 708.0;

/// (sin r − r)/r³ for |r| ≤ π/2, in powers of r²; the error of the sine is 5e-14.
const SINE: [f64; 6] = [
    -0.166_666_666_664_021_66,
    0.008_333_333_316_509_723,
    -0.000_198_412_660_093_807_06,
    2.755_690_132_874_359e-6,
    -2.502_845_764_070_504_3e-8,
    1.538_736_678_026_43e-10,
];
/// (cos r − 1)/r² for |r| ≤ π/2, in powers of r²; the error of the cosine is 8e-13.
const COSINE: [f64; 6] = [
    -0.499_999_999_979_371_8,
    0.041_666_666_503_885_195,
    -0.001_388_888_461_060_653_6,
    2.480_107_001_650_692e-5,
    -2.752_565_460_072_348_3e-7,
    1.991_985_758_235_505_5e-9,
];
/// (exp r − 1 − r)/r² for |r| ≤ ½ ln 2, in powers of r; the relative error of the exponential is 1.2e-12.
const EXPONENTIAL: [f64; 7] = [
    0.500_000_000_042_715_2,
    0.166_666_667_845_117_52,
    0.041_666_664_403_697_96,
    0.008_333_281_787_646_384,
    0.001_388_919_725_868_410_3,
    0.000_199_089_523_904_247_5,
    2.470_826_742_787_697e-5,
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

/// exp x for |x| ≤ 708; arguments outside this range are clamped to it.
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

    /// Numbers between −`limit` and `limit`, four at a time.
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
        for (limit, error) in [(3.0, 1e-12), (100.0, 1e-12), (1e5, 2e-12)] {
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
                    assert!(relative.abs() < 2e-12, "exp {x}: {relative:e}");
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
