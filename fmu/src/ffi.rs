//! Handles, texts, states and callbacks: all unsafe code of the FMU library except [`moorline_boundary`], with its safety arguments.
//!
//! Guarantees of the host (FMI 2.0.4 section 2.1, FMI 3.0.2 section 2.2): a handle was returned by instantiate and is
//! not used after free; no two calls use one handle at once; a pointer with a length points to that many values that
//! stay valid during the call; a text ends with a zero byte. Everything else is checked here.

use std::ffi::{CStr, CString, c_char, c_void};

use moorline_boundary::guard::guard;
use moorline_boundary::pointers;
pub(crate) use moorline_boundary::pointers::{slice, slice_mut};
use moorline_host::fmi2::{fmi2CallbackFunctions, fmi2CallbackLogger};
use moorline_host::fmi3::{fmi3IntermediateUpdateCallback, fmi3LogMessageCallback};
use moorline_host::{FmiVersion, Status};

use crate::instance::{Instance, Refusal};
use crate::log::Topic;
use crate::saved::Snapshot;

/// Target of a handle.
pub(crate) struct Handle {
    instance: Instance,
    version: FmiVersion,
    sink: Sink,
    /// The host's callback for intermediate updates.
    update: Option<Update>,
    /// True after a call has panicked; from then on only `free` is accepted.
    is_poisoned: bool,
    /// Text returned to the host; valid until the next one replaces it.
    text: CString,
}

/// Intermediate-update callback of a host.
#[derive(Clone, Copy)]
pub(crate) struct Update {
    pub(crate) callback: fmi3IntermediateUpdateCallback,
    pub(crate) environment: *mut c_void,
    /// True if the host may end the communication step during the callback.
    pub(crate) may_end: bool,
}

/// Calls the host at a time [s] within a communication step; returns whether the host ends the step.
///
/// # Safety
/// `handle` is null or a live handle that no other call is using; its instance is not borrowed, since the host calls it.
pub(crate) unsafe fn update(handle: *mut c_void, time: f64) -> bool {
    // SAFETY: by the caller's promise; the copy does not borrow the handle.
    let update = unsafe { handle.cast::<Handle>().as_ref() }.and_then(|handle| handle.update);
    let Some(Update {
        callback: Some(callback),
        environment,
        may_end,
    }) = update
    else {
        return false;
    };
    let (mut ends, mut at) = (false, time);
    // SAFETY: the host's callback and environment; both results live on this stack frame.
    unsafe {
        callback(
            environment,
            time,
            true,
            true,
            true,
            may_end,
            &raw mut ends,
            &raw mut at,
        );
    }
    may_end && ends
}

/// Destination of messages.
pub(crate) enum Sink {
    /// FMI 2.0: variadic logger, which requires the instance's name.
    Two {
        logger: fmi2CallbackLogger,
        environment: *mut c_void,
        name: CString,
    },
    /// FMI 3.0.
    Three {
        logger: fmi3LogMessageCallback,
        environment: *mut c_void,
    },
}

impl Sink {
    /// Copies the callbacks and the name of an FMI 2.0 host.
    ///
    /// # Safety
    /// `functions` is null or points to the host's callbacks; `name` is null or ends with a zero byte.
    pub(crate) unsafe fn two(functions: *const fmi2CallbackFunctions, name: *const c_char) -> Sink {
        // SAFETY: by the caller's promise.
        let (functions, name) = unsafe { (functions.as_ref(), text(name)) };
        Sink::Two {
            logger: functions.and_then(|f| f.logger),
            environment: functions.map_or(std::ptr::null_mut(), |f| f.componentEnvironment),
            name: c_text(name.unwrap_or("moorline")),
        }
    }

    fn send(&self, topic: Topic, message: &str) {
        let category = c_text(topic.category());
        let message = c_text(message);
        let status = topic.status() as u32;
        match self {
            Sink::Two {
                logger: Some(logger),
                environment,
                name,
            } => {
                // SAFETY: the host's own logger and environment; all texts live during the call. The message is an
                // argument and never the format, so that any character is safe.
                unsafe {
                    logger(
                        *environment,
                        name.as_ptr(),
                        status,
                        category.as_ptr(),
                        c"%s".as_ptr(),
                        message.as_ptr(),
                    );
                }
            }
            Sink::Three {
                logger: Some(logger),
                environment,
            } => {
                // SAFETY: the host's own logger and environment; both texts live during the call.
                unsafe { logger(*environment, status, category.as_ptr(), message.as_ptr()) }
            }
            Sink::Two { logger: None, .. } | Sink::Three { logger: None, .. } => {}
        }
    }
}

/// Converts a text for C; zero bytes, which a C string cannot contain, become spaces.
fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// Creates an instance and returns its handle; a refused instance gives null and a message. The message is sent even if
/// logging is off: without an instance there is no other way to report the reason.
pub(crate) fn instantiate(
    version: FmiVersion,
    sink: Sink,
    update: Option<Update>,
    make: impl FnOnce() -> Result<Instance, Refusal>,
) -> *mut c_void {
    match guard(make) {
        Ok(Ok(instance)) => Box::into_raw(Box::new(Handle {
            instance,
            version,
            sink,
            update,
            is_poisoned: false,
            text: CString::default(),
        }))
        .cast(),
        Ok(Err(Refusal(message))) => {
            sink.send(Topic::Error, &message);
            std::ptr::null_mut()
        }
        Err(message) => {
            sink.send(Topic::Fatal, &message);
            std::ptr::null_mut()
        }
    }
}

/// Frees an instance in any state; null is ignored.
///
/// # Safety
/// `handle` is null or came from [`instantiate`] and is not used again.
pub(crate) unsafe fn free(handle: *mut c_void) {
    if handle.is_null() {
        return;
    }
    // SAFETY: came from `Box::into_raw` and is freed once, by the caller's promise.
    let handle = unsafe { Box::from_raw(handle.cast::<Handle>()) };
    // A panic while dropping leaks the instance, which the host no longer uses.
    let _ = guard(move || drop(handle));
}

/// Carries out one call on an instance: catches a panic, sends the log messages and returns the status.
///
/// # Safety
/// `handle` is null or a live handle that no other call is using.
pub(crate) unsafe fn call(
    handle: *mut c_void,
    version: FmiVersion,
    function: &str,
    body: impl FnOnce(&mut Instance) -> Result<(), Refusal>,
) -> u32 {
    // SAFETY: by the caller's promise the pointer is null or valid, and this is the only reference.
    let Some(handle) = (unsafe { handle.cast::<Handle>().as_mut() }) else {
        return Status::Error as u32;
    };
    handle.call(version, function, body) as u32
}

impl Handle {
    fn call(
        &mut self,
        version: FmiVersion,
        function: &str,
        body: impl FnOnce(&mut Instance) -> Result<(), Refusal>,
    ) -> Status {
        if self.is_poisoned {
            return Status::Fatal;
        }
        let own = self.version;
        let instance = &mut self.instance;
        let result = guard(|| {
            if own == version {
                body(instance)
            } else {
                Err(Refusal(format!("this instance speaks FMI {own}")))
            }
        });
        let (topic, message) = match result {
            Ok(Ok(())) => {
                self.send_log();
                return Status::Ok;
            }
            Ok(Err(Refusal(message))) => (Topic::Error, message),
            Err(message) => {
                self.is_poisoned = true;
                (Topic::Fatal, message)
            }
        };
        self.instance.log.push(topic, || format!("{function}: {message}"));
        self.send_log();
        topic.status()
    }

    fn send_log(&mut self) {
        if self.instance.log.is_empty() {
            return;
        }
        for (topic, message) in self.instance.log.take() {
            self.sink.send(topic, &message);
        }
    }
}

/// Stores a text in the handle and returns its address.
///
/// # Safety
/// As for [`call`].
pub(crate) unsafe fn keep_text(handle: *mut c_void, text: &str) -> *const c_char {
    // SAFETY: by the caller's promise.
    let Some(handle) = (unsafe { handle.cast::<Handle>().as_mut() }) else {
        return std::ptr::null();
    };
    handle.text = c_text(text);
    handle.text.as_ptr()
}

/// Writes one result to the host's pointer.
///
/// # Safety
/// A pointer that is not null may be written to.
pub(crate) unsafe fn write<T>(pointer: *mut T, value: T) -> Result<(), Refusal> {
    // SAFETY: by the caller's promise.
    Ok(unsafe { pointers::write(pointer, value) }?)
}

/// Returns a text of the host; `None` if it is null or not UTF-8.
///
/// # Safety
/// A pointer that is not null points to a text that ends with a zero byte and lives during `'a`.
pub(crate) unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a str> {
    // SAFETY: by the caller's promise.
    unsafe { pointers::text(pointer) }.ok()
}

/// Returns a path or URI of the host, in any encoding; `None` if it is null.
///
/// # Safety
/// As for [`text`].
pub(crate) unsafe fn location<'a>(pointer: *const c_char) -> Option<&'a [u8]> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: not null; the caller promises the rest.
    Some(unsafe { CStr::from_ptr(pointer) }.to_bytes())
}

/// Returns the host's list of texts.
///
/// # Safety
/// As for [`slice`] and [`text`].
pub(crate) unsafe fn texts<'a>(pointer: *const *const c_char, count: usize) -> Result<Vec<&'a str>, Refusal> {
    // SAFETY: by the caller's promise.
    let pointers = unsafe { slice(pointer, count) }?;
    pointers
        .iter()
        .map(|&pointer| {
            // SAFETY: by the caller's promise.
            unsafe { text(pointer) }.ok_or_else(|| "a text is null or not UTF-8".into())
        })
        .collect()
}

/// Saves the state into `*target`; an earlier state that the host passes is overwritten.
///
/// # Safety
/// A `target` that is not null points to null or to a state of [`store_state`] that was not freed.
pub(crate) unsafe fn store_state(target: *mut *mut c_void, snapshot: Snapshot) -> Result<(), Refusal> {
    pointers::check(target, 1)?;
    // SAFETY: not null and aligned; the caller promises that it may be read and what it points to.
    unsafe {
        match (*target).cast::<Snapshot>().as_mut() {
            Some(old) => *old = snapshot,
            None => *target = Box::into_raw(Box::new(snapshot)).cast(),
        }
    }
    Ok(())
}

/// Returns a saved state.
///
/// # Safety
/// A pointer that is not null came from [`store_state`] and was not freed.
pub(crate) unsafe fn state<'a>(state: *mut c_void) -> Result<&'a Snapshot, Refusal> {
    // SAFETY: by the caller's promise.
    unsafe { state.cast::<Snapshot>().as_ref() }.ok_or_else(|| "the saved state is null".into())
}

/// Frees a saved state and sets the host's pointer to null; null is ignored.
///
/// # Safety
/// As for [`store_state`].
pub(crate) unsafe fn free_state(target: *mut *mut c_void) -> Result<(), Refusal> {
    if target.is_null() {
        return Ok(());
    }
    pointers::check(target, 1)?;
    // SAFETY: not null and aligned; the caller promises where it comes from, and null keeps it from being freed again.
    unsafe {
        if !(*target).is_null() {
            drop(Box::from_raw((*target).cast::<Snapshot>()));
            *target = std::ptr::null_mut();
        }
    }
    Ok(())
}

/// Copies a serialised state to the host; refuses a target of another length.
pub(crate) fn copy_state(bytes: &[u8], target: &mut [u8]) -> Result<(), Refusal> {
    if bytes.len() != target.len() {
        return Err(Refusal(format!(
            "the serialised state has {} bytes, but the host gave room for {}",
            bytes.len(),
            target.len()
        )));
    }
    target.copy_from_slice(bytes);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instance::tests::instance;

    /// Categories and texts of messages.
    type Messages = Vec<[String; 2]>;

    /// Logger of a host; stores the messages in the environment, which is a [`Messages`].
    unsafe extern "C" fn keep(
        environment: *mut c_void,
        _: u32,
        category: *const c_char,
        message: *const c_char,
    ) {
        // SAFETY: the environment of the sink below, and texts of C.
        let (messages, [category, message]) = unsafe {
            (
                &mut *environment.cast::<Messages>(),
                [text(category), text(message)],
            )
        };
        messages.push([category, message].map(|text| text.unwrap().to_string()));
    }

    /// Function of the interface that panics.
    unsafe extern "C" fn provoke(handle: *mut c_void) -> u32 {
        // SAFETY: a live handle.
        unsafe { call(handle, FmiVersion::Three, "provoke", |_| panic!("provoked")) }
    }

    #[test]
    fn a_panic_is_fatal_for_the_instance_and_harmless_for_the_host() {
        let mut messages = Messages::new();
        let environment = (&raw mut messages).cast();
        let handle = || {
            let sink = Sink::Three {
                logger: Some(keep),
                environment,
            };
            let make = || Ok(instance(FmiVersion::Three));
            let handle = instantiate(FmiVersion::Three, sink, None, make);
            assert!(!handle.is_null());
            handle
        };
        let start = |instance: &mut Instance| {
            instance.enter_initialization()?;
            instance.exit_initialization()
        };
        let step = |instance: &mut Instance| instance.do_step(0.0, 0.05);
        let [lost, other] = [handle(), handle()];
        // SAFETY: live handles, each freed once.
        unsafe {
            for handle in [lost, other] {
                let started = call(handle, FmiVersion::Three, "start", start);
                assert_eq!(started, Status::Ok as u32);
            }
            assert_eq!(provoke(lost), Status::Fatal as u32);
            let stepped = call(lost, FmiVersion::Three, "step", step);
            assert_eq!(stepped, Status::Fatal as u32);
            free(lost);
            let stepped = call(other, FmiVersion::Three, "step", step);
            assert_eq!(stepped, Status::Ok as u32);
            free(other);
        }
        let mut fatal = messages
            .iter()
            .filter(|[category, _]| category == "logStatusFatal");
        let [_, message] = fatal.next().unwrap();
        assert!(
            message.contains("provoked") && message.contains("ffi.rs"),
            "{message}"
        );
    }

    #[test]
    fn a_text_with_a_zero_byte_is_carried_with_a_space() {
        assert_eq!(c_text("a\0b").to_str(), Ok("a b"));
    }

    #[test]
    fn null_is_no_text_and_no_handle() {
        // SAFETY: null is allowed in all of these.
        unsafe {
            assert_eq!(text(std::ptr::null()), None);
            free(std::ptr::null_mut());
            let status = call(std::ptr::null_mut(), FmiVersion::Two, "x", |_| Ok(()));
            assert_eq!(status, Status::Error as u32);
            assert!(free_state(std::ptr::null_mut()).is_ok());
        }
    }
}
