//! Handles, messages, and all code that uses a host's pointers.
//!
//! Guarantees of the host: a pointer that is not null points to as many values as the function requires, which stay valid and are not changed by
//! others during the call; a text ends with a zero byte. Null pointers, wrong lengths and closed handles are refused. Any thread may call; calls on
//! one simulation are serialised. Each thread has its own message of the last failure.

use std::cell::RefCell;
use std::ffi::{c_char, c_int};

use moorline_boundary::guard::guard;
use moorline_boundary::handles::{Denied, Handles};
use moorline_boundary::pointers;

use crate::codes::*;
use crate::session::{Failure, Outcome, Session};

/// Target of [`moorline_simulation`].
pub struct MoorlineSimulationTarget {
    _private: [u8; 0],
}

/// Handle of a simulation.
#[allow(non_camel_case_types, reason = "its name in C")]
pub type moorline_simulation = *mut MoorlineSimulationTarget;

static SESSIONS: Handles<Session> = Handles::new();

thread_local! {
    /// Message of the last call that failed on this thread.
    static MESSAGE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Stores the message of a failure and returns the code of the result.
fn report(function: &str, result: Outcome) -> c_int {
    match result {
        Ok(()) => MOORLINE_OK,
        Err(failure) => {
            MESSAGE.with_borrow_mut(|message| *message = format!("{function}: {}", failure.message));
            failure.code
        }
    }
}

/// Returns the message of the last failure on this thread.
pub(crate) fn message() -> String {
    MESSAGE.with_borrow(Clone::clone)
}

/// Creates a simulation and returns its handle through `target`.
///
/// # Safety
/// `target` is null or may be written to.
pub(crate) unsafe fn create(
    function: &str,
    version: u32,
    target: *mut moorline_simulation,
    make: impl FnOnce() -> Outcome<Session>,
) -> c_int {
    let made = guard(|| {
        if version != MOORLINE_ABI_VERSION {
            return Err(Failure::new(
                MOORLINE_WRONG_VERSION,
                format!(
                    "the host was built for version {version} of this interface, and this is {MOORLINE_ABI_VERSION}"
                ),
            ));
        }
        // SAFETY: by the caller's promise; a handle that cannot be given is not made.
        unsafe { put(target, std::ptr::null_mut()) }?;
        let handle = SESSIONS.insert(make()?, 0);
        // SAFETY: as above.
        unsafe { put(target, std::ptr::without_provenance_mut(handle)) }
    });
    report(
        function,
        made.unwrap_or_else(|panic| Err(Failure::new(MOORLINE_INTERNAL_ERROR, panic))),
    )
}

/// Closes a simulation; null is ignored.
pub(crate) fn close(simulation: moorline_simulation) -> c_int {
    let is_done = simulation.is_null() || SESSIONS.remove(simulation.addr());
    let unknown = || Failure::new(MOORLINE_INVALID_HANDLE, "the handle is closed, or none");
    report("moorline_close", if is_done { Ok(()) } else { Err(unknown()) })
}

/// Carries out a call on a simulation: checks the handle, catches a panic, stores the message of a failure and returns the code.
pub(crate) fn call(
    simulation: moorline_simulation,
    function: &str,
    body: impl FnOnce(&mut Session) -> Outcome,
) -> c_int {
    let served = SESSIONS.with(simulation.addr(), |session, _| body(session));
    let result = served.unwrap_or_else(|denied| {
        let (code, message) = match denied {
            Denied::Null => (MOORLINE_INVALID_HANDLE, "the handle is null".to_string()),
            Denied::Unknown => (
                MOORLINE_INVALID_HANDLE,
                "the handle is closed, or none".to_string(),
            ),
            Denied::Poisoned => (
                MOORLINE_INTERNAL_ERROR,
                "an earlier call failed inside: close the simulation".to_string(),
            ),
            Denied::Panicked(message) => (MOORLINE_INTERNAL_ERROR, message),
        };
        Err(Failure::new(code, message))
    });
    report(function, result)
}

/// Returns the host's values as a slice.
///
/// # Safety
/// As [`pointers::slice`].
pub(crate) unsafe fn slice<'a, T>(pointer: *const T, count: usize) -> Outcome<&'a [T]> {
    // SAFETY: by the caller's promise.
    unsafe { pointers::slice(pointer, count) }.map_err(Failure::argument)
}

/// Returns the host's values as a mutable slice.
///
/// # Safety
/// As [`pointers::slice_mut`].
pub(crate) unsafe fn slice_mut<'a, T>(pointer: *mut T, count: usize) -> Outcome<&'a mut [T]> {
    // SAFETY: by the caller's promise.
    unsafe { pointers::slice_mut(pointer, count) }.map_err(Failure::argument)
}

/// Writes a value to the host.
///
/// # Safety
/// As [`pointers::write`].
pub(crate) unsafe fn put<T>(target: *mut T, value: T) -> Outcome {
    // SAFETY: by the caller's promise.
    unsafe { pointers::write(target, value) }.map_err(Failure::argument)
}

/// Returns a text of the host.
///
/// # Safety
/// As [`pointers::text`].
pub(crate) unsafe fn text<'a>(pointer: *const c_char) -> Outcome<&'a str> {
    // SAFETY: by the caller's promise.
    unsafe { pointers::text(pointer) }.map_err(Failure::argument)
}

/// Copies a text to the host, truncated to `room` bytes, and returns the size needed for the whole text [bytes] through `needed` unless it is null.
///
/// # Safety
/// `target` is null or points to `room` bytes, `needed` is null or may be written to.
pub(crate) unsafe fn give_text(text: &str, target: *mut c_char, room: usize, needed: *mut usize) -> Outcome {
    // SAFETY: by the caller's promise.
    unsafe {
        let size = pointers::copy_text(text, target, room).map_err(Failure::argument)?;
        match needed.is_null() {
            true => Ok(()),
            false => put(needed, size),
        }
    }
}

/// Copies bytes to a host that has room for all of them, and returns their number; with room 0 only the number.
///
/// # Safety
/// `target` is null or points to `room` bytes, `needed` is null or may be written to.
pub(crate) unsafe fn give_bytes(bytes: &[u8], target: *mut u8, room: usize, needed: *mut usize) -> Outcome {
    // SAFETY: by the caller's promise.
    unsafe {
        if !needed.is_null() {
            put(needed, bytes.len())?;
        }
        if room == 0 {
            return Ok(());
        }
        if room < bytes.len() {
            return Err(Failure::argument(format!(
                "{} bytes are wanted, and there is room for {room}",
                bytes.len()
            )));
        }
        slice_mut(target, bytes.len())?.copy_from_slice(bytes);
    }
    Ok(())
}
