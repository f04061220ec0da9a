//! Types of the handles.
//!
//! A handle is a number with the type of a pointer: it is never dereferenced, and a closed one is refused.

/// Kind of a handle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A whole system.
    System,
    /// The water of a system.
    Waves,
    /// The seabed of a system.
    Seafloor,
    /// A body.
    Body,
    /// A rod.
    Rod,
    /// A point.
    Point,
    /// A line.
    Line,
}

/// Handle of one kind.
pub(crate) trait Handle: Copy {
    /// Kind of the part that the handle must refer to.
    const KIND: Kind;
    /// Returns the number of the handle.
    fn number(self) -> usize;
    /// Returns the handle with a number.
    fn of(number: usize) -> Self;
}

macro_rules! handle {
    ($target:ident, $name:ident, $kind:ident) => {
        impl Handle for $name {
            const KIND: Kind = Kind::$kind;

            fn number(self) -> usize {
                self.addr()
            }

            fn of(number: usize) -> Self {
                std::ptr::without_provenance_mut::<$target>(number)
            }
        }
    };
}

/// Target of [`MoorDyn`].
pub struct MoorDynSystemTarget {
    _private: [u8; 0],
}
/// Handle of a system.
pub type MoorDyn = *mut MoorDynSystemTarget;
handle!(MoorDynSystemTarget, MoorDyn, System);

/// Target of [`MoorDynWaves`].
pub struct MoorDynWavesTarget {
    _private: [u8; 0],
}
/// Handle of the water of a system.
pub type MoorDynWaves = *mut MoorDynWavesTarget;
handle!(MoorDynWavesTarget, MoorDynWaves, Waves);

/// Target of [`MoorDynSeafloor`].
pub struct MoorDynSeafloorTarget {
    _private: [u8; 0],
}
/// Handle of the seabed of a system.
pub type MoorDynSeafloor = *mut MoorDynSeafloorTarget;
handle!(MoorDynSeafloorTarget, MoorDynSeafloor, Seafloor);

/// Target of [`MoorDynBody`].
pub struct MoorDynBodyTarget {
    _private: [u8; 0],
}
/// Handle of a body.
pub type MoorDynBody = *mut MoorDynBodyTarget;
handle!(MoorDynBodyTarget, MoorDynBody, Body);

/// Target of [`MoorDynRod`].
pub struct MoorDynRodTarget {
    _private: [u8; 0],
}
/// Handle of a rod.
pub type MoorDynRod = *mut MoorDynRodTarget;
handle!(MoorDynRodTarget, MoorDynRod, Rod);

/// Target of [`MoorDynPoint`].
pub struct MoorDynPointTarget {
    _private: [u8; 0],
}
/// Handle of a point.
pub type MoorDynPoint = *mut MoorDynPointTarget;
handle!(MoorDynPointTarget, MoorDynPoint, Point);

/// Target of [`MoorDynLine`].
pub struct MoorDynLineTarget {
    _private: [u8; 0],
}
/// Handle of a line.
pub type MoorDynLine = *mut MoorDynLineTarget;
handle!(MoorDynLineTarget, MoorDynLine, Line);
