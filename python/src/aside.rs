//! Work on another thread, while the Python thread reports progress and checks for Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Interval between checks for signals.
const LISTEN_EVERY: Duration = Duration::from_millis(50);

/// State shared by the two threads.
#[derive(Debug, Default)]
pub(crate) struct Control {
    stops: AtomicBool,
    done: AtomicUsize,
    total: AtomicUsize,
}

impl Control {
    /// Returns whether the work is to stop because its result is no longer needed.
    pub(crate) fn stops(&self) -> bool {
        self.stops.load(Ordering::Relaxed)
    }

    /// Adds steps to be made to the total.
    pub(crate) fn expect(&self, steps: usize) {
        self.total.fetch_add(steps, Ordering::Relaxed);
    }

    /// Counts one step as made.
    pub(crate) fn step(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Returns the number of steps made, and the total number of steps known so far [-].
    fn steps(&self) -> (usize, usize) {
        (
            self.done.load(Ordering::Relaxed),
            self.total.load(Ordering::Relaxed),
        )
    }
}

/// Runs `work` on another thread, without the interpreter lock, and returns its result. `progress` is called with the number of steps
/// made and the total.
///
/// # Errors
/// An exception from a signal, such as `KeyboardInterrupt`, or from `progress`: the work stops at its next check of the [`Control`] and is not waited
/// for. A panic of the work becomes a `RuntimeError`.
pub(crate) fn aside<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Control) -> T + Send + 'static,
) -> PyResult<T> {
    let control = Arc::new(Control::default());
    let (sender, receiver) = channel();
    let worker = thread::Builder::new().name("moorline".to_string()).spawn({
        let control = control.clone();
        // sending fails if the work was abandoned and the receiver is gone
        move || drop(sender.send(work(&control)))
    })?;
    let mut receiver = receiver;
    loop {
        let (got, back) = py.detach(move || (receiver.recv_timeout(LISTEN_EVERY), receiver));
        receiver = back;
        let listened = py.check_signals().and_then(|()| match progress {
            Some(progress) => progress.call1(control.steps()).map(drop),
            None => Ok(()),
        });
        if let Err(exception) = listened {
            control.stops.store(true, Ordering::Relaxed);
            return Err(exception);
        }
        match got {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                let reason = worker.join().err().map(|panic| {
                    let text = panic.downcast_ref::<String>().cloned();
                    text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string))
                });
                let reason = reason.flatten().unwrap_or_default();
                return Err(PyRuntimeError::new_err(format!(
                    "an error in moorline itself: {reason}"
                )));
            }
        }
    }
}
