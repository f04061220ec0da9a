//! Guard that catches a panic before it leaves the library.

use std::any::Any;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

use moorline::dynamics::is_worker;

thread_local! {
    /// True while this thread is inside the guard. Without a destructor, so that the library can be unloaded.
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Key shared by all worker threads of simulations; a guard also reports their panics.
const WORKER: usize = 0;

/// Source locations of guarded panics by thread, until their guards report them.
static PLACES: Mutex<BTreeMap<usize, String>> = Mutex::new(BTreeMap::new());

fn places() -> MutexGuard<'static, BTreeMap<usize, String>> {
    PLACES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns a number unique among the living threads: the address of this thread's flag.
fn thread_number() -> usize {
    IS_GUARDED.with(|flag| std::ptr::from_ref(flag).addr())
}

/// Prepares the library at its first call: a separate thread creates worker threads, and guarded panics are not printed; others go to the
/// previous panic hook.
fn prepare() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        #[cfg(unix)]
        moorline::dynamics::make_threads_aside(crate::aside::run);
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            let is_worker = is_worker();
            if !is_worker && !IS_GUARDED.get() {
                return before(info);
            }
            if let Some(place) = info.location() {
                let thread = if is_worker { WORKER } else { thread_number() };
                places().insert(thread, place.to_string());
            }
        }));
    });
}

/// Runs `body` and converts a panic to its message.
///
/// # Errors
/// Message and source location of the panic.
pub fn guard<T>(body: impl FnOnce() -> T) -> Result<T, String> {
    prepare();
    let outer = IS_GUARDED.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(body));
    IS_GUARDED.set(outer);
    result.map_err(|payload| {
        let mut places = places();
        let place = places.remove(&thread_number());
        let place = place.or_else(|| places.remove(&WORKER));
        drop(places);
        let text = text_of(payload.as_ref());
        // A payload with a destructor that panics must not do so here.
        std::mem::forget(payload);
        format!(
            "internal fault at {}: {text}; close this instance and please report it",
            place.as_deref().unwrap_or("an unknown place")
        )
    })
}

fn text_of(payload: &(dyn Any + Send)) -> String {
    let fixed = payload.downcast_ref::<&str>().map(ToString::to_string);
    let text = fixed.or_else(|| payload.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "no message".to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use moorline::dynamics::as_worker;

    #[test]
    fn a_panic_becomes_its_message_and_place() {
        let message = guard(|| -> u32 { panic!("node {} lost", 7) }).unwrap_err();
        assert!(
            message.contains("node 7 lost") && message.contains("guard.rs"),
            "{message}"
        );
        assert_eq!(guard(|| 42), Ok(42));
        let message = guard(|| -> u32 { panic::panic_any(42_u8) }).unwrap_err();
        assert!(message.contains("no message"), "{message}");
    }

    #[test]
    fn a_panic_of_a_worker_becomes_its_message_and_place() {
        let message = guard(|| {
            let worker = std::thread::spawn(|| as_worker(|| panic!("line {} lost", 3)));
            worker
                .join()
                .unwrap_or_else(|payload| panic::resume_unwind(payload))
        });
        let message = message.unwrap_err();
        assert!(
            message.contains("line 3 lost") && message.contains("guard.rs"),
            "{message}"
        );
    }

    #[test]
    fn panics_in_many_threads_keep_their_own_messages_and_places() {
        let here = |k: u32| {
            let message = guard(|| -> u32 { panic!("number {k}") }).unwrap_err();
            assert!(message.contains(&format!("number {k}")), "{message}");
            assert!(message.contains("guard.rs"), "{message}");
        };
        std::thread::scope(|scope| {
            for k in 0..8 {
                scope.spawn(move || (0..200).for_each(|_| here(k)));
            }
        });
    }
}
