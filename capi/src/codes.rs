//! Codes that functions return, and the version of the interface.

use std::ffi::c_int;

/// Version of this interface, which a host passes to load and read; it changes with every incompatible change.
pub const MOORLINE_ABI_VERSION: u32 = 1;

/// The call succeeded.
pub const MOORLINE_OK: c_int = 0;
/// A handle is null, closed or unknown.
pub const MOORLINE_INVALID_HANDLE: c_int = 1;
/// An argument is null, of a wrong length, or has a value that cannot be used.
pub const MOORLINE_INVALID_ARGUMENT: c_int = 2;
/// The host was built for another version of this interface.
pub const MOORLINE_WRONG_VERSION: c_int = 3;
/// The scene or deck cannot be read, or contains mistakes.
pub const MOORLINE_SCENE_ERROR: c_int = 4;
/// No static equilibrium was found.
pub const MOORLINE_STATICS_ERROR: c_int = 5;
/// A step failed; the state is unchanged.
pub const MOORLINE_STEP_ERROR: c_int = 6;
/// The call is not allowed in this phase: before or after start.
pub const MOORLINE_WRONG_PHASE: c_int = 7;
/// moorline does not compute this result for the scene.
pub const MOORLINE_NOT_AVAILABLE: c_int = 8;
/// Internal fault of the library: the simulation can only be closed.
pub const MOORLINE_INTERNAL_ERROR: c_int = 9;

/// Causality of a variable: the host sets it before a step.
pub const MOORLINE_INPUT: c_int = 0;
/// Causality of a variable: the host reads it.
pub const MOORLINE_OUTPUT: c_int = 1;
/// Causality of a variable: the host may set it before start.
pub const MOORLINE_PARAMETER: c_int = 2;
/// Causality of a variable: it follows from the parameters at start.
pub const MOORLINE_CALCULATED_PARAMETER: c_int = 3;
