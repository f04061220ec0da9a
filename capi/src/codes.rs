//! Codes that functions return, and the version of the interface.

use std::ffi::c_int;

/// Version of this interface, which a host gives to load and read; it changes with every change that breaks a host.
pub const MOORLINE_ABI_VERSION: u32 = 1;

/// The call succeeded.
pub const MOORLINE_OK: c_int = 0;
/// A handle is null, closed, or none.
pub const MOORLINE_INVALID_HANDLE: c_int = 1;
/// An argument is null, of a wrong length, or has a value that cannot be used.
pub const MOORLINE_INVALID_ARGUMENT: c_int = 2;
/// The host was built for another version of this interface.
pub const MOORLINE_WRONG_VERSION: c_int = 3;
/// The scene or deck cannot be read, or has mistakes.
pub const MOORLINE_SCENE_ERROR: c_int = 4;
/// There is no static equilibrium.
pub const MOORLINE_STATICS_ERROR: c_int = 5;
/// A step failed; the state is that before it.
pub const MOORLINE_STEP_ERROR: c_int = 6;
/// The call comes too early or too late: before or after start.
pub const MOORLINE_WRONG_PHASE: c_int = 7;
/// moorline does not find it for this scene.
pub const MOORLINE_NOT_AVAILABLE: c_int = 8;
/// A fault inside the library: the simulation serves nothing but close any more.
pub const MOORLINE_INTERNAL_ERROR: c_int = 9;

/// Causality of a variable: the host sets it before a step.
pub const MOORLINE_INPUT: c_int = 0;
/// Causality of a variable: the host reads it.
pub const MOORLINE_OUTPUT: c_int = 1;
/// Causality of a variable: the host may set it before start.
pub const MOORLINE_PARAMETER: c_int = 2;
/// Causality of a variable: it follows from the parameters at start.
pub const MOORLINE_CALCULATED_PARAMETER: c_int = 3;
