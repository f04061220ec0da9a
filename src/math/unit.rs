//! Vector unit of the machine on which a kernel runs; results do not depend on it.
//!
//! The widest vectors are not the best for every kernel. On a machine with vectors of eight numbers, compilers
//! combine two of four, which is faster over many rows. Values that were just written as two vectors and are read
//! again as one stall until both are in the cache, and over few rows no other work hides that time.

use pulp::Arch;

/// Best unit for this number of rows, where vectors of eight numbers are faster over more than `few`.
pub fn over_rows(rows: usize, few: usize) -> Arch {
    if rows > few { Arch::new() } else { of_four() }
}

/// Vectors of no more than four numbers.
pub fn of_four() -> Arch {
    #[cfg(target_arch = "x86_64")]
    if let Some(unit) = pulp::x86::V3::try_new() {
        return Arch::V3(unit);
    }
    Arch::new()
}
