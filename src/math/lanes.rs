//! Four numbers side by side, so that the compiler emits vector instructions for the kernels.
//!
//! A plain array with inlined element-wise operations: portable, without intrinsics, and compiled for the vector unit of the calling function.

use std::array::from_fn;
use std::ops::{Add, Index, IndexMut, Mul, Sub};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Number of lanes [-].
pub const LANES: usize = 4;

/// Four f64 side by side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[repr(align(32))]
pub struct Lanes([f64; LANES]);

impl Lanes {
    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(value: f64) -> Lanes {
        Lanes([value; LANES])
    }

    /// Lanes with four given numbers.
    #[inline(always)]
    pub fn new(values: [f64; LANES]) -> Lanes {
        Lanes(values)
    }

    /// `values[at..at + 4]`.
    #[inline(always)]
    pub fn load(values: &[f64], at: usize) -> Lanes {
        let chunk: &[f64; LANES] = values[at..at + LANES].try_into().expect("four lanes");
        Lanes(*chunk)
    }

    /// Writes `values[at..at + 4]`.
    #[inline(always)]
    pub fn store(self, values: &mut [f64], at: usize) {
        values[at..at + LANES].copy_from_slice(&self.0);
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Lanes {
        Lanes(from_fn(|i| self.0[i].sqrt()))
    }

    /// 1/x.
    #[inline(always)]
    pub fn recip(self) -> Lanes {
        Lanes(from_fn(|i| 1.0 / self.0[i]))
    }

    /// |x|.
    #[inline(always)]
    pub fn abs(self) -> Lanes {
        Lanes(from_fn(|i| self.0[i].abs()))
    }

    /// max(x, 0), and 0 where x is NaN.
    #[inline(always)]
    pub fn positive(self) -> Lanes {
        Lanes(from_fn(|i| if self.0[i] > 0.0 { self.0[i] } else { 0.0 }))
    }

    /// Secant slope of max(x, 0) between these values and `other`; 0 where they are equal.
    #[inline(always)]
    pub fn positive_secant(self, other: Lanes) -> Lanes {
        let least = Lanes::splat(f64::MIN_POSITIVE);
        let rise = (other.positive() - self.positive()).abs();
        rise * ((other - self).abs() + least).recip()
    }

    /// x where `gate` > 0, else 0.
    #[inline(always)]
    pub fn where_positive(self, gate: Lanes) -> Lanes {
        Lanes(from_fn(|i| if gate.0[i] > 0.0 { self.0[i] } else { 0.0 }))
    }

    /// `yes` where x > 0, else `no`.
    #[inline(always)]
    pub fn choose(self, yes: Lanes, no: Lanes) -> Lanes {
        Lanes(from_fn(|i| if self.0[i] > 0.0 { yes.0[i] } else { no.0[i] }))
    }

    /// The larger of two, lane by lane.
    #[inline(always)]
    pub fn max(self, other: Lanes) -> Lanes {
        Lanes(from_fn(|i| {
            if self.0[i] > other.0[i] {
                self.0[i]
            } else {
                other.0[i]
            }
        }))
    }

    /// The smaller of two, lane by lane.
    #[inline(always)]
    pub fn min(self, other: Lanes) -> Lanes {
        Lanes(from_fn(|i| {
            if self.0[i] < other.0[i] {
                self.0[i]
            } else {
                other.0[i]
            }
        }))
    }

    /// Largest lane, in all lanes.
    #[inline(always)]
    pub fn greatest(self) -> Lanes {
        let pairs = self.max(self.moved_up());
        pairs.max(pairs.moved_up().moved_up())
    }

    /// Returns whether any lane is > 0.
    #[inline(always)]
    pub fn any_positive(self) -> bool {
        self.positive_bits(0) != 0
    }

    /// Returns whether all lanes are > 0.
    #[inline(always)]
    pub fn all_positive(self) -> bool {
        self.positive_bits(1) == 0
    }

    /// One bit per lane, set where the lane is > 0, inverted if `flip` is 1. Compilers test in one instruction whether all bits are 0.
    #[inline(always)]
    fn positive_bits(self, flip: u8) -> u8 {
        let [a, b, c, d] = self.0.map(|value| u8::from(value > 0.0) ^ flip);
        a | b << 1 | c << 2 | d << 3
    }

    /// Applies a scalar function to every lane.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Lanes {
        Lanes(self.0.map(f))
    }

    /// Bits of every lane, plus `add`, shifted to the left by `left` bits.
    #[inline(always)]
    pub fn shifted_bits(self, add: u64, left: u32) -> [u64; LANES] {
        from_fn(|i| self.0[i].to_bits().wrapping_add(add) << left)
    }

    /// Numbers with these bits.
    #[inline(always)]
    pub fn from_bits(bits: [u64; LANES]) -> Lanes {
        Lanes(from_fn(|i| f64::from_bits(bits[i])))
    }

    /// Changes the sign of the lanes whose highest bit is set in `signs`; all other bits of `signs` must be 0.
    #[inline(always)]
    pub fn flip_signs(self, signs: [u64; LANES]) -> Lanes {
        Lanes(from_fn(|i| f64::from_bits(self.0[i].to_bits() ^ signs[i])))
    }

    /// Lane k takes the number of lane k − 1, and lane 0 that of lane 3.
    #[inline(always)]
    pub fn moved_up(self) -> Lanes {
        Lanes([self.0[3], self.0[0], self.0[1], self.0[2]])
    }

    /// Lane k takes the number of lane k − 1, and lane 0 that of lane 0 of `first`.
    #[inline(always)]
    pub fn moved_up_after(self, first: Lanes) -> Lanes {
        Lanes([first.0[0], self.0[0], self.0[1], self.0[2]])
    }

    /// Lane k takes the number of lane k + 1, and lane 3 that of lane 0.
    #[inline(always)]
    pub fn moved_down(self) -> Lanes {
        Lanes([self.0[1], self.0[2], self.0[3], self.0[0]])
    }

    /// Lane k takes the number of lane k + 1, and lane 3 that of lane 3 of `last`.
    #[inline(always)]
    pub fn moved_down_before(self, last: Lanes) -> Lanes {
        Lanes([self.0[1], self.0[2], self.0[3], last.0[3]])
    }

    /// The first three lanes.
    #[inline(always)]
    pub fn xyz(self) -> Vector3<f64> {
        Vector3::new(self.0[0], self.0[1], self.0[2])
    }

    /// Sum of the lanes.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        (self.0[0] + self.0[1]) + (self.0[2] + self.0[3])
    }
}

impl Index<usize> for Lanes {
    type Output = f64;
    #[inline(always)]
    fn index(&self, lane: usize) -> &f64 {
        &self.0[lane]
    }
}

impl IndexMut<usize> for Lanes {
    #[inline(always)]
    fn index_mut(&mut self, lane: usize) -> &mut f64 {
        &mut self.0[lane]
    }
}

impl Add for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn add(self, other: Lanes) -> Lanes {
        Lanes(from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn sub(self, other: Lanes) -> Lanes {
        Lanes(from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, other: Lanes) -> Lanes {
        Lanes(from_fn(|i| self.0[i] * other.0[i]))
    }
}

/// Three [`Lanes`]: four vectors side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vectors {
    /// x components.
    pub x: Lanes,
    /// y components.
    pub y: Lanes,
    /// z components.
    pub z: Lanes,
}

impl Vectors {
    /// Zero vectors.
    #[inline(always)]
    pub fn zero() -> Vectors {
        let zero = Lanes::splat(0.0);
        Vectors {
            x: zero,
            y: zero,
            z: zero,
        }
    }

    /// Four vectors.
    #[inline(always)]
    pub fn new([a, b, c, d]: [Vector3<f64>; LANES]) -> Vectors {
        Vectors {
            x: Lanes([a.x, b.x, c.x, d.x]),
            y: Lanes([a.y, b.y, c.y, d.y]),
            z: Lanes([a.z, b.z, c.z, d.z]),
        }
    }

    /// The vector in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vector3<f64> {
        Vector3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    /// Writes the vector in a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, vector: Vector3<f64>) {
        (self.x[lane], self.y[lane], self.z[lane]) = (vector.x, vector.y, vector.z);
    }

    /// Rounds components to multiples of about 1e-16 `size`, provided that they are smaller than `size`.
    #[inline(always)]
    pub fn rounded(self, size: f64) -> Vectors {
        let size = Lanes::splat(size);
        Vectors {
            x: (self.x + size) - size,
            y: (self.y + size) - size,
            z: (self.z + size) - size,
        }
    }

    /// As [`Lanes::moved_up`].
    #[inline(always)]
    pub fn moved_up(self) -> Vectors {
        Vectors {
            x: self.x.moved_up(),
            y: self.y.moved_up(),
            z: self.z.moved_up(),
        }
    }

    /// As [`Lanes::moved_up_after`].
    #[inline(always)]
    pub fn moved_up_after(self, first: Vectors) -> Vectors {
        Vectors {
            x: self.x.moved_up_after(first.x),
            y: self.y.moved_up_after(first.y),
            z: self.z.moved_up_after(first.z),
        }
    }

    /// As [`Lanes::moved_down_before`].
    #[inline(always)]
    pub fn moved_down_before(self, last: Vectors) -> Vectors {
        Vectors {
            x: self.x.moved_down_before(last.x),
            y: self.y.moved_down_before(last.y),
            z: self.z.moved_down_before(last.z),
        }
    }

    /// Scalar products.
    #[inline(always)]
    pub fn dot(self, other: Vectors) -> Lanes {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Every vector times its factor.
    #[inline(always)]
    pub fn scale(self, factor: Lanes) -> Vectors {
        Vectors {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }
}

impl Add for Vectors {
    type Output = Vectors;
    #[inline(always)]
    fn add(self, other: Vectors) -> Vectors {
        Vectors {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

impl Sub for Vectors {
    type Output = Vectors;
    #[inline(always)]
    fn sub(self, other: Vectors) -> Vectors {
        Vectors {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_and_all_ask_every_lane_and_numbers_that_are_none_are_not_positive() {
        let kinds = [1.0, 0.0, -0.0, -2.0, f64::NAN, f64::INFINITY];
        for code in 0..kinds.len().pow(4) {
            let values: [f64; LANES] =
                from_fn(|lane| kinds[code / kinds.len().pow(lane as u32) % kinds.len()]);
            let (lanes, count) = (Lanes::new(values), values.iter().filter(|x| **x > 0.0).count());
            assert_eq!(lanes.any_positive(), count > 0, "{values:?}");
            assert_eq!(lanes.all_positive(), count == LANES, "{values:?}");
        }
    }
}
