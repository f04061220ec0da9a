//! Vector unit of the machine on which a kernel runs; results do not depend on it.
//!
//! The kernels compute with four numbers at a time. On machines with vectors of eight, compilers combine two vectors of four. A load that combines
//! two vectors just written then waits until both are in the cache. Vectors of eight are 5 to 20 % slower than those of four on an Intel Xeon
//! (Sapphire Rapids), and 3 to 8 % faster on lines of forty elements on Zen 5. They would make up a third of the compiled code and are not used.

use pulp::NullaryFnOnce;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V3;

/// Vector unit for which kernels are compiled.
#[derive(Debug, Clone, Copy)]
pub struct VectorUnit {
    /// AVX2 and FMA; `None` for the vectors that every machine of the target has.
    #[cfg(target_arch = "x86_64")]
    of_four: Option<V3>,
}

impl VectorUnit {
    /// Best vector unit of this machine.
    pub fn best() -> VectorUnit {
        VectorUnit {
            #[cfg(target_arch = "x86_64")]
            of_four: V3::try_new(),
        }
    }

    /// Vector unit that every machine of the target has.
    pub fn portable() -> VectorUnit {
        VectorUnit {
            #[cfg(target_arch = "x86_64")]
            of_four: None,
        }
    }

    /// Runs `kernel`, which is compiled for this unit as far as it is inlined.
    #[inline(always)]
    pub fn dispatch<K: NullaryFnOnce>(self, kernel: K) -> K::Output {
        #[cfg(target_arch = "x86_64")]
        if let Some(unit) = self.of_four {
            return unit.vectorize(kernel);
        }
        kernel.call()
    }
}
