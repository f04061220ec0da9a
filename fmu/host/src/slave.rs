//! Co-simulation instance with the same calls for both versions of FMI.

use std::ffi::{CString, c_void};
use std::path::Path;
use std::ptr;

use crate::fmi2::{self, fmi2CallbackFunctions};
use crate::fmi3;
use crate::fmu::{Api, Loaded};
use crate::log::{Log, log_message, variadic_logger};
use crate::{Fmu, HostError, LogMessage, Status};

/// Co-simulation instance; freed when dropped.
#[derive(Debug)]
pub struct Slave {
    handle: *mut c_void,
    log: Box<Log>,
    /// Callbacks, to which the FMU may keep a pointer.
    _callbacks: Box<fmi2CallbackFunctions>,
    /// Keeps the library loaded.
    fmu: Fmu,
}

// SAFETY: FMI lets any thread call an instance as long as no two do at once (FMI 2.0 section 2.1.1, FMI 3.0 section
// 2.2.3); `&mut self` in every call ensures that. The log is behind a mutex.
unsafe impl Send for Slave {}

/// State saved by [`Slave::save_state`]; it belongs to the instance that saved it.
#[derive(Debug)]
pub struct SavedState(*mut c_void);

impl Slave {
    pub(crate) fn new(fmu: &Fmu, name: &str, token: &str, logging: bool) -> Result<Slave, HostError> {
        let log = Box::new(Log::default());
        let callbacks = Box::new(fmi2CallbackFunctions {
            logger: variadic_logger(),
            allocateMemory: None,
            freeMemory: None,
            stepFinished: None,
            componentEnvironment: log.environment(),
        });
        let resources = fmu.folder().join("resources");
        let (name, token) = (c_text(name)?, c_text(token)?);
        let loaded: &Loaded = &fmu.0;
        let handle = match &loaded.api {
            Api::Two(functions) => {
                let resources = c_text(&file_uri(&resources))?;
                // SAFETY: all texts end with a zero byte and outlive the call; callbacks and log live in boxes that the
                // slave keeps until after it has freed the instance.
                unsafe {
                    (functions.fmi2Instantiate)(
                        name.as_ptr(),
                        fmi2::fmi2CoSimulation,
                        token.as_ptr(),
                        resources.as_ptr(),
                        &raw const *callbacks,
                        0,
                        i32::from(logging),
                    )
                }
            }
            Api::Three(functions) => {
                let resources = c_text(&(resources.to_string_lossy() + "/"))?;
                // SAFETY: as above; no intermediate variables, so the null list has length 0.
                unsafe {
                    (functions.fmi3InstantiateCoSimulation)(
                        name.as_ptr(),
                        token.as_ptr(),
                        resources.as_ptr(),
                        false,
                        logging,
                        false,
                        false,
                        ptr::null(),
                        0,
                        log.environment(),
                        Some(log_message),
                        None,
                    )
                }
            }
        };
        if handle.is_null() {
            return Err(HostError::Instantiate(joined(&log.take())));
        }
        Ok(Slave {
            handle,
            log,
            _callbacks: callbacks,
            fmu: fmu.clone(),
        })
    }

    /// Calls the function of the FMU's version and converts its status to a result.
    fn call(
        &mut self,
        names: [&'static str; 2],
        two: impl FnOnce(&fmi2::Functions, *mut c_void) -> u32,
        three: impl FnOnce(&fmi3::Functions, *mut c_void) -> u32,
    ) -> Result<Status, HostError> {
        let (function, status) = match &self.fmu.0.api {
            Api::Two(functions) => (names[0], two(functions, self.handle)),
            Api::Three(functions) => (names[1], three(functions, self.handle)),
        };
        let status = Status::from_c(status);
        if status <= Status::Warning {
            return Ok(status);
        }
        Err(HostError::Call {
            function,
            status,
            log: joined(&self.log.take()),
        })
    }

    /// Returns the messages since the last call of this function; the messages of a failed call are in its error instead.
    pub fn take_log(&mut self) -> Vec<LogMessage> {
        self.log.take()
    }

    /// Returns the FMU of this instance.
    pub fn fmu(&self) -> &Fmu {
        &self.fmu
    }

    /// Returns the C handle, for functions outside the standard; valid during the lifetime of the slave.
    pub fn handle(&self) -> *mut c_void {
        self.handle
    }

    /// Sets the start time [s] and, if known, the end time [s], and enters initialization mode.
    ///
    /// # Errors
    /// Errors of the FMU.
    pub fn enter_initialization(&mut self, start: f64, stop: Option<f64>) -> Result<Status, HostError> {
        let (defined, stop) = (stop.is_some(), stop.unwrap_or(0.0));
        self.call(
            ["fmi2SetupExperiment", ""],
            // SAFETY: the handle is live until drop; here and in all calls below.
            |f, handle| unsafe { (f.fmi2SetupExperiment)(handle, 0, 0.0, start, i32::from(defined), stop) },
            |_, _| 0,
        )?;
        self.call(
            ["fmi2EnterInitializationMode", "fmi3EnterInitializationMode"],
            // SAFETY: see above.
            |f, handle| unsafe { (f.fmi2EnterInitializationMode)(handle) },
            // SAFETY: see above.
            |f, handle| unsafe { (f.fmi3EnterInitializationMode)(handle, false, 0.0, start, defined, stop) },
        )
    }

    /// Leaves initialization mode.
    ///
    /// # Errors
    /// Errors of the FMU.
    pub fn exit_initialization(&mut self) -> Result<Status, HostError> {
        self.call(
            ["fmi2ExitInitializationMode", "fmi3ExitInitializationMode"],
            // SAFETY: the handle is live.
            |f, handle| unsafe { (f.fmi2ExitInitializationMode)(handle) },
            // SAFETY: the handle is live.
            |f, handle| unsafe { (f.fmi3ExitInitializationMode)(handle) },
        )
    }

    /// Sets real variables; an array takes all its values.
    ///
    /// # Errors
    /// Errors of the FMU; in FMI 2.0, different numbers of references and values.
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<Status, HostError> {
        self.check_lengths(references.len(), values.len())?;
        self.call(
            ["fmi2SetReal", "fmi3SetFloat64"],
            // SAFETY: the handle is live; pointer and length come from one slice, equal lengths were checked.
            |f, handle| unsafe {
                (f.fmi2SetReal)(handle, references.as_ptr(), references.len(), values.as_ptr())
            },
            // SAFETY: the handle is live; pointer and length come from one slice.
            |f, handle| unsafe {
                (f.fmi3SetFloat64)(
                    handle,
                    references.as_ptr(),
                    references.len(),
                    values.as_ptr(),
                    values.len(),
                )
            },
        )
    }

    /// Reads real variables; an array fills all its values.
    ///
    /// # Errors
    /// Errors of the FMU; in FMI 2.0, different numbers of references and values.
    pub fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<Status, HostError> {
        self.check_lengths(references.len(), values.len())?;
        let (target, length) = (values.as_mut_ptr(), values.len());
        self.call(
            ["fmi2GetReal", "fmi3GetFloat64"],
            // SAFETY: the handle is live; pointer and length come from one slice, equal lengths were checked.
            |f, handle| unsafe { (f.fmi2GetReal)(handle, references.as_ptr(), references.len(), target) },
            // SAFETY: the handle is live; pointer and length come from one slice.
            |f, handle| unsafe {
                (f.fmi3GetFloat64)(handle, references.as_ptr(), references.len(), target, length)
            },
        )
    }

    /// Reads one integer variable.
    ///
    /// # Errors
    /// Errors of the FMU, or no such variable.
    pub fn integer(&mut self, name: &str) -> Result<i32, HostError> {
        let reference = self.fmu.reference(name)?;
        let mut value = 0;
        let target = &raw mut value;
        self.call(
            ["fmi2GetInteger", "fmi3GetInt32"],
            // SAFETY: the handle is live; one reference, one value.
            |f, handle| unsafe { (f.fmi2GetInteger)(handle, &raw const reference, 1, target) },
            // SAFETY: the handle is live; one reference, one value.
            |f, handle| unsafe { (f.fmi3GetInt32)(handle, &raw const reference, 1, target, 1) },
        )?;
        Ok(value)
    }

    /// Reads one real variable by name; for frequent access, look up the reference once and use [`Slave::get_real`].
    ///
    /// # Errors
    /// Errors of the FMU, or no such variable.
    pub fn real(&mut self, name: &str) -> Result<f64, HostError> {
        let reference = self.fmu.reference(name)?;
        let mut value = [0.0];
        self.get_real(&[reference], &mut value)?;
        Ok(value[0])
    }

    /// Advances from `time` [s] to `time + step` [s].
    ///
    /// # Errors
    /// Errors of the FMU.
    pub fn do_step(&mut self, time: f64, step: f64) -> Result<Status, HostError> {
        self.call(
            ["fmi2DoStep", "fmi3DoStep"],
            // SAFETY: the handle is live.
            |f, handle| unsafe { (f.fmi2DoStep)(handle, time, step, 1) },
            |f, handle| {
                let (mut event, mut terminate, mut early, mut reached) = (false, false, false, 0.0);
                // SAFETY: the handle is live; the four results live on this stack frame.
                unsafe {
                    (f.fmi3DoStep)(
                        handle,
                        time,
                        step,
                        true,
                        &raw mut event,
                        &raw mut terminate,
                        &raw mut early,
                        &raw mut reached,
                    )
                }
            },
        )
    }

    /// Ends the simulation.
    ///
    /// # Errors
    /// Errors of the FMU.
    pub fn terminate(&mut self) -> Result<Status, HostError> {
        self.call(
            ["fmi2Terminate", "fmi3Terminate"],
            // SAFETY: the handle is live.
            |f, handle| unsafe { (f.fmi2Terminate)(handle) },
            // SAFETY: the handle is live.
            |f, handle| unsafe { (f.fmi3Terminate)(handle) },
        )
    }

    /// Returns to the state after instantiation.
    ///
    /// # Errors
    /// Errors of the FMU.
    pub fn reset(&mut self) -> Result<Status, HostError> {
        self.call(
            ["fmi2Reset", "fmi3Reset"],
            // SAFETY: the handle is live.
            |f, handle| unsafe { (f.fmi2Reset)(handle) },
            // SAFETY: the handle is live.
            |f, handle| unsafe { (f.fmi3Reset)(handle) },
        )
    }

    /// Saves the whole state. Free it with [`Slave::free_state`].
    ///
    /// # Errors
    /// Errors of the FMU.
    pub fn save_state(&mut self) -> Result<SavedState, HostError> {
        let mut state = ptr::null_mut();
        let target = &raw mut state;
        self.call(
            ["fmi2GetFMUstate", "fmi3GetFMUState"],
            // SAFETY: the handle is live; a null state requests a new one.
            |f, handle| unsafe { (f.fmi2GetFMUstate)(handle, target) },
            // SAFETY: as above.
            |f, handle| unsafe { (f.fmi3GetFMUState)(handle, target) },
        )?;
        Ok(SavedState(state))
    }

    /// Restores a saved state.
    ///
    /// # Errors
    /// Errors of the FMU.
    pub fn restore_state(&mut self, state: &SavedState) -> Result<Status, HostError> {
        self.call(
            ["fmi2SetFMUstate", "fmi3SetFMUState"],
            // SAFETY: the handle is live; the state came from this FMU and is freed only by `free_state`, by value.
            |f, handle| unsafe { (f.fmi2SetFMUstate)(handle, state.0) },
            // SAFETY: as above.
            |f, handle| unsafe { (f.fmi3SetFMUState)(handle, state.0) },
        )
    }

    /// Frees a saved state.
    ///
    /// # Errors
    /// Errors of the FMU.
    pub fn free_state(&mut self, mut state: SavedState) -> Result<Status, HostError> {
        let target = &raw mut state.0;
        self.call(
            ["fmi2FreeFMUstate", "fmi3FreeFMUState"],
            // SAFETY: the handle is live; the state is not used again.
            |f, handle| unsafe { (f.fmi2FreeFMUstate)(handle, target) },
            // SAFETY: as above.
            |f, handle| unsafe { (f.fmi3FreeFMUState)(handle, target) },
        )
    }

    /// Refuses unequal lengths in FMI 2.0, which has one value per reference.
    fn check_lengths(&self, references: usize, values: usize) -> Result<(), HostError> {
        if references == values || matches!(self.fmu.0.api, Api::Three(_)) {
            return Ok(());
        }
        Err(HostError::Argument(format!(
            "{references} value references, but {values} values"
        )))
    }
}

impl Drop for Slave {
    fn drop(&mut self) {
        // SAFETY: the handle came from this library, is freed once, here; log, callbacks and library are dropped after.
        unsafe {
            match &self.fmu.0.api {
                Api::Two(functions) => (functions.fmi2FreeInstance)(self.handle),
                Api::Three(functions) => (functions.fmi3FreeInstance)(self.handle),
            }
        }
    }
}

fn c_text(text: &str) -> Result<CString, HostError> {
    CString::new(text).map_err(|_| HostError::Argument(format!("\"{text}\" contains a zero character")))
}

fn joined(messages: &[LogMessage]) -> String {
    if messages.is_empty() {
        return "no message, logging is off".to_string();
    }
    let texts: Vec<&str> = messages.iter().map(|m| m.text.as_str()).collect();
    texts.join("; ")
}

/// Converts a path to the URI that FMI 2.0 requires (RFC 3986: all characters are escaped except unreserved ones, `/` and `:`).
fn file_uri(path: &Path) -> String {
    let path = path.to_string_lossy().replace('\\', "/");
    let mut uri = String::from(if path.starts_with('/') {
        "file://"
    } else {
        "file:///"
    });
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' | b':' => {
                uri.push(char::from(byte));
            }
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_with_spaces_and_accents_becomes_an_escaped_uri() {
        assert_eq!(
            file_uri(Path::new("/data/sp dir ø {x}")),
            "file:///data/sp%20dir%20%C3%B8%20%7Bx%7D"
        );
    }
}
