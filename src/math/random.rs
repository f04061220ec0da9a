//! Pseudo-random numbers from a seed, the same on every machine.
//!
//! s ← s + 0x9e3779b97f4a7c15;   z = (s ⊕ s>>30)·0xbf58476d1ce4e5b9;   z = (z ⊕ z>>27)·0x94d049bb133111eb;   out z ⊕ z>>31
//!
//! on 64-bit numbers modulo 2⁶⁴. The upper 53 bits of a number make a double in [0, 1).
//!
//! Source: Steele, Lea & Flood (2014), Fast splittable pseudorandom number generators, OOPSLA '14, 453-472 (SplitMix64, with the constants of
//! its variant 13). Passes the usual statistical tests; not for cryptography.

/// Pseudo-random number generator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Generator with this seed [-].
    pub fn new(seed: u64) -> Random {
        Random { state: seed }
    }

    /// Returns the next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = self.state;
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns the next number, uniform in [0, 1) [-].
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_of_a_seed_are_those_of_the_published_generator() {
        // the first outputs of Vigna's splitmix64.c for the seed 1234567
        let mut random = Random::new(1_234_567);
        let found = [random.bits(), random.bits(), random.bits()];
        let published = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        assert_eq!(found, published);
    }

    #[test]
    fn the_numbers_fill_the_unit_interval_evenly() {
        let mut random = Random::new(0);
        let count = 100_000;
        let numbers: Vec<f64> = (0..count).map(|_| random.unit()).collect();
        assert!(numbers.iter().all(|x| (0.0..1.0).contains(x)));
        let mean = numbers.iter().sum::<f64>() / f64::from(count);
        let variance = numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(count);
        assert!((mean - 0.5).abs() < 3e-3 && (variance - 1.0 / 12.0).abs() < 1e-3);
        let neighbours = numbers.windows(2).map(|x| (x[0] - mean) * (x[1] - mean));
        assert!(neighbours.sum::<f64>().abs() / f64::from(count) < 1e-3);
    }
}
