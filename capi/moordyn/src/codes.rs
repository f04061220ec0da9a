//! Codes that functions return, and levels of messages.

use std::ffi::c_int;

/// The call succeeded.
pub const MOORDYN_SUCCESS: c_int = 0;
/// The deck cannot be used.
pub const MOORDYN_INVALID_INPUT_FILE: c_int = -1;
/// A file cannot be written.
pub const MOORDYN_INVALID_OUTPUT_FILE: c_int = -2;
/// An argument is of the wrong kind.
pub const MOORDYN_INVALID_INPUT: c_int = -3;
/// The computation did not stay finite.
pub const MOORDYN_NAN_ERROR: c_int = -4;
/// Memory cannot be allocated.
pub const MOORDYN_MEM_ERROR: c_int = -5;
/// An argument has a value that cannot be used, such as null.
pub const MOORDYN_INVALID_VALUE: c_int = -6;
/// moorline does not model the requested feature.
pub const MOORDYN_NOT_IMPLEMENTED: c_int = -7;
/// Any other error.
pub const MOORDYN_UNHANDLED_ERROR: c_int = -255;

/// Level that disables all messages.
pub const MOORDYN_NO_OUTPUT: c_int = 4096;
/// Level of errors.
pub const MOORDYN_ERR_LEVEL: c_int = 3;
/// Level of warnings.
pub const MOORDYN_WRN_LEVEL: c_int = 2;
/// Level of messages.
pub const MOORDYN_MSG_LEVEL: c_int = 1;
/// Level of details.
pub const MOORDYN_DBG_LEVEL: c_int = 0;
