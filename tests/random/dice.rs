//! Source of the random numbers: a tape of genes that proptest draws and shrinks, read part by part.
//!
//! A gene of zero selects the simplest alternative, so that a failing scene shrinks to a simple one: first whole parts, then single genes.

use std::ops::Range;

use proptest::prelude::Rng;
use proptest::strategy::{NewTree, Strategy, ValueTree};
use proptest::test_runner::TestRunner;

/// Number of parts of a tape [-]. Draws in one part do not shift those in another.
const PARTS: usize = 48;
/// Number of genes of a part [-].
const GENES: usize = 64;

/// All random numbers of a scene and its drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Tape(Vec<u32>);

impl Tape {
    /// Returns the dice of a part; `wild` is the share of numbers drawn from the whole legal range.
    pub fn part(&self, number: usize, wild: f64) -> Dice<'_> {
        assert!(number < PARTS, "a tape has {PARTS} parts");
        Dice {
            genes: &self.0[number * GENES..(number + 1) * GENES],
            at: 0,
            wild,
        }
    }
}

/// Reads the genes of a part in turn, and again from the first after the last.
#[derive(Debug, Clone)]
pub struct Dice<'t> {
    genes: &'t [u32],
    at: usize,
    wild: f64,
}

impl Dice<'_> {
    /// Returns a number from 0 to just below 1.
    fn unit(&mut self) -> f64 {
        let gene = self.genes[self.at % self.genes.len()];
        self.at += 1;
        f64::from(gene) / (f64::from(u32::MAX) + 1.0)
    }

    /// Returns true with a probability of `share`.
    pub fn chance(&mut self, share: f64) -> bool {
        self.unit() > 1.0 - share
    }

    /// Returns a value with a probability of `share`.
    pub fn maybe<T>(&mut self, share: f64, value: impl FnOnce(&mut Self) -> T) -> Option<T> {
        self.chance(share).then(|| value(self))
    }

    /// Returns a number with uniform distribution between two bounds.
    pub fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.unit()
    }

    /// Returns a number with uniform magnitude up to `size` and random sign.
    pub fn within(&mut self, size: f64) -> f64 {
        let sign = if self.chance(0.5) { -1.0 } else { 1.0 };
        sign * self.between(0.0, size)
    }

    /// Returns a number with log-uniform distribution.
    pub fn log(&mut self, lower: f64, upper: f64) -> f64 {
        (lower * (upper / lower).powf(self.unit())).clamp(lower, upper)
    }

    /// Works like [`Self::log`] with the usual range, or occasionally the legal one.
    pub fn size(&mut self, usual: [f64; 2], legal: [f64; 2]) -> f64 {
        let [lower, upper] = if self.chance(self.wild) { legal } else { usual };
        self.log(lower, upper)
    }

    /// Returns a whole number, both bounds included.
    pub fn whole(&mut self, lower: usize, upper: usize) -> usize {
        lower + (self.unit() * (upper - lower + 1) as f64) as usize
    }

    /// Returns one of several values.
    pub fn pick<T: Clone>(&mut self, list: &[T]) -> T {
        list[self.whole(0, list.len() - 1)].clone()
    }

    /// Returns a seed for a separate generator.
    pub fn seed(&mut self) -> u64 {
        (self.unit() * 1e6) as u64
    }
}

/// Draws tapes.
#[derive(Debug, Clone, Copy)]
pub struct Tapes;

impl Strategy for Tapes {
    type Tree = TapeTree;
    type Value = Tape;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        let rng = runner.rng();
        let tape = Tape((0..PARTS * GENES).map(|_| rng.next_u32()).collect());
        let parts = (0..PARTS).map(|part| part * GENES..(part + 1) * GENES);
        let single = (0..PARTS * GENES).map(|gene| gene..gene + 1);
        Ok(TapeTree {
            tape,
            kept: None,
            rest: parts.chain(single).collect::<Vec<_>>().into_iter(),
        })
    }
}

/// A tape being simplified.
#[derive(Debug, Clone)]
pub struct TapeTree {
    tape: Tape,
    /// Genes that the last simplification set to zero.
    kept: Option<(Range<usize>, Vec<u32>)>,
    /// Ranges that have not been tried.
    rest: std::vec::IntoIter<Range<usize>>,
}

impl ValueTree for TapeTree {
    type Value = Tape;

    fn current(&self) -> Tape {
        self.tape.clone()
    }

    fn simplify(&mut self) -> bool {
        for range in self.rest.by_ref() {
            let genes = &mut self.tape.0[range.clone()];
            if genes.iter().any(|gene| *gene != 0) {
                self.kept = Some((range, genes.to_vec()));
                genes.fill(0);
                return true;
            }
        }
        false
    }

    fn complicate(&mut self) -> bool {
        if let Some((range, genes)) = self.kept.take() {
            self.tape.0[range].copy_from_slice(&genes);
        }
        self.simplify()
    }
}
