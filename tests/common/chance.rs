//! Choices from a seed, and files that a disk or an editor has spoilt.

use moorline::math::random::Random;

/// Choices from a seed: the same ones every time.
pub struct Chance(Random);

impl Chance {
    pub fn new(seed: u64) -> Chance {
        Chance(Random::new(seed))
    }

    /// A number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.0.bits() >> 33) as usize % count.max(1)
    }

    /// An element of a list.
    pub fn one_of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// A file cut off, scrambled or with a stray byte.
    pub fn damaged(&mut self, mut bytes: Vec<u8>) -> Vec<u8> {
        let at = self.below(bytes.len());
        match self.below(3) {
            0 => bytes.truncate(at),
            1 => {
                for _ in 0..=self.below(20) {
                    let at = self.below(bytes.len());
                    bytes[at] = u8::try_from(self.below(256)).unwrap();
                }
            }
            _ => bytes.insert(at, *self.one_of(b"\0\xff\xc3[]{}\"=#\n.")),
        }
        bytes
    }

    /// The lines of a text with two of them swapped.
    pub fn swapped(&mut self, text: &str) -> String {
        let mut lines: Vec<&str> = text.lines().collect();
        let (a, b) = (self.below(lines.len()), self.below(lines.len()));
        lines.swap(a, b);
        lines.join("\n")
    }
}
