//! Log messages of the FMU, received through the callbacks of both versions.

use std::ffi::{CStr, c_char, c_void};
use std::sync::Mutex;

use crate::Status;
use crate::fmi2::{fmi2CallbackLogger, fmi2Status};
use crate::fmi3::fmi3Status;

/// A line of an FMU's log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogMessage {
    /// Severity.
    pub status: Status,
    /// Category, one of those in the description.
    pub category: String,
    /// Text.
    pub text: String,
}

/// Collects messages; its address is the environment pointer of the callbacks.
#[derive(Debug, Default)]
pub(crate) struct Log(Mutex<Vec<LogMessage>>);

impl Log {
    fn push(&self, message: LogMessage) {
        if let Ok(mut messages) = self.0.lock() {
            messages.push(message);
        }
    }

    pub(crate) fn take(&self) -> Vec<LogMessage> {
        self.0
            .lock()
            .map(|mut messages| std::mem::take(&mut *messages))
            .unwrap_or_default()
    }

    pub(crate) fn environment(&self) -> *mut c_void {
        std::ptr::from_ref(self).cast_mut().cast()
    }
}

/// Copies a text of the FMU.
///
/// # Safety
/// `text` is null or ends with a zero byte and lives during the call.
pub(crate) unsafe fn text(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: not null; the caller promises the rest.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

/// `fmi3LogMessageCallback`.
pub(crate) unsafe extern "C" fn log_message(
    environment: *mut c_void,
    status: fmi3Status,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the environment is the `Log` handed over at instantiation, which outlives the instance; the texts live
    // during the call (FMI 3.0, section 2.3.1).
    unsafe {
        let log = &*environment.cast::<Log>();
        log.push(LogMessage {
            status: Status::from_c(status),
            category: text(category),
            text: text(message),
        });
    }
}

/// Fixed arguments of an `fmi2CallbackLogger` call, and the first variable argument.
#[cfg(not(all(target_vendor = "apple", target_arch = "aarch64")))]
unsafe extern "C" fn logger(
    environment: *mut c_void,
    _instance: *const c_char,
    status: fmi2Status,
    category: *const c_char,
    format: *const c_char,
    argument: *const c_char,
) {
    // SAFETY: as in `log_message`. The argument is read only where the format is "%s", which promises a text there.
    unsafe {
        let message = if text(format) == "%s" { argument } else { format };
        log_message(environment, status, category, message);
    }
}

/// As above for a platform that passes variable arguments on the stack, where they cannot be read: the message is the format alone.
#[cfg(all(target_vendor = "apple", target_arch = "aarch64"))]
unsafe extern "C" fn logger(
    environment: *mut c_void,
    _instance: *const c_char,
    status: fmi2Status,
    category: *const c_char,
    format: *const c_char,
) {
    // SAFETY: as in `log_message`.
    unsafe {
        log_message(environment, status, category, format);
    }
}

/// Returns the logger with the variadic type of FMI 2.0.
pub(crate) fn variadic_logger() -> fmi2CallbackLogger {
    // SAFETY: stable Rust cannot define a variadic function. On the platforms of the six-argument form a variadic call
    // passes pointers and integers where a call with fixed arguments does (System V x86-64, Windows x64, AAPCS64), and
    // reading an argument that was not passed yields a stale register or stack word, which `logger` then leaves alone.
    let logger = unsafe {
        std::mem::transmute::<
            *const (),
            unsafe extern "C" fn(*mut c_void, *const c_char, fmi2Status, *const c_char, *const c_char, ...),
        >(logger as *const ())
    };
    Some(logger)
}
