//! Random choices from a seed, and files damaged by a disk or an editor.

use moorline::math::random::Random;

/// Random choices from a seed, the same every time.
pub struct Chance(Random);

impl Chance {
    pub fn new(seed: u64) -> Chance {
        Chance(Random::new(seed))
    }

    /// Returns a number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.0.bits() >> 33) as usize % count.max(1)
    }

    /// Returns an element of a list.
    pub fn one_of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// Returns a file truncated, scrambled or with a stray byte.
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

    /// Returns a text with two of its lines swapped.
    pub fn swapped(&mut self, text: &str) -> String {
        let mut lines: Vec<&str> = text.lines().collect();
        let (a, b) = (self.below(lines.len()), self.below(lines.len()));
        lines.swap(a, b);
        lines.join("\n")
    }
}
