//! Which vectors of the machine a kernel is run with; results do not depend on it.
//!
//! The widest are not the best for everything. Where a machine has vectors of eight numbers, compilers put two of four together in them, which
//! pays over many rows. What has only just been written as two and is read again as one is held up until both are in the cache, though, and
//! over few rows there is nothing else to do meanwhile.

use pulp::Arch;

/// The best unit for so many rows, where vectors of eight numbers pay over more than `few`.
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
