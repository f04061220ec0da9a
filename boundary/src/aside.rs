//! A system thread that creates the worker threads.
//!
//! [`std::thread`] registers a destructor on the thread that spawns another. On a thread of the host, this destructor would keep the library
//! mapped after it is unloaded, until the host's thread ends. A thread created here by the system call ends at once, and runs its
//! destructors then.
//!
//! Source: POSIX.1-2017, pthread_create and pthread_join; both succeed with 0.

use std::ffi::{c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

type Work<'a> = &'a mut (dyn FnMut() + Send);

unsafe extern "C" {
    fn pthread_create(
        thread: *mut usize,
        attributes: *const c_void,
        body: extern "C" fn(*mut c_void) -> *mut c_void,
        argument: *mut c_void,
    ) -> c_int;
    fn pthread_join(thread: usize, result: *mut *mut c_void) -> c_int;
}

/// Runs work on a separate thread and waits for its end; does nothing if the system cannot create a thread.
pub(crate) fn run(mut work: Work) {
    let mut thread = 0_usize; // pthread_t is as wide as a pointer
    // SAFETY: `work` outlives the thread, which is joined before this function returns, and no one else uses it meanwhile.
    unsafe {
        let argument = ptr::from_mut(&mut work).cast();
        if pthread_create(&mut thread, ptr::null(), body, argument) == 0 {
            pthread_join(thread, ptr::null_mut());
        }
    }
}

extern "C" fn body(work: *mut c_void) -> *mut c_void {
    // SAFETY: made in `run` of this type, alive until this thread has ended, and used here only.
    let work = unsafe { &mut *work.cast::<Work>() };
    // interrupted work leaves no result, which the caller of `run` detects
    let _ = catch_unwind(AssertUnwindSafe(work));
    ptr::null_mut()
}
