//! Handles of a host: numbers that are never reused, so that a closed handle is refused.
//!
//! A handle crosses the boundary as a pointer that is never dereferenced. An item takes a range of handles: the first for the item itself, the
//! others for its parts (lines, points), which become invalid with it. Calls on one item are serialised, so that a host may call from any
//! thread. After a panic inside a call, the item can only be removed.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError, RwLock};

use crate::guard::guard;

/// Difference between consecutive handles [-]; handles differ from small integers and are aligned like pointers.
const STRIDE: usize = 64;

/// Reason why a call on a handle is refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Denied {
    /// The handle is null.
    Null,
    /// No open item has this handle.
    Unknown,
    /// An earlier call on the item panicked.
    Poisoned,
    /// This call panicked, with this message.
    Panicked(String),
}

struct Entry<T> {
    count: usize,
    item: Arc<Mutex<T>>,
}

/// Open items by their handles.
pub struct Handles<T> {
    entries: RwLock<BTreeMap<usize, Entry<T>>>,
    next: Mutex<usize>,
}

impl<T> Default for Handles<T> {
    fn default() -> Self {
        Handles::new()
    }
}

impl<T> Handles<T> {
    /// Returns an empty collection.
    pub const fn new() -> Handles<T> {
        Handles {
            entries: RwLock::new(BTreeMap::new()),
            next: Mutex::new(STRIDE),
        }
    }

    /// Inserts an item with `parts` parts and returns its handle.
    pub fn insert(&self, item: T, parts: usize) -> usize {
        let mut next = self.next.lock().unwrap_or_else(PoisonError::into_inner);
        let handle = *next;
        *next += (parts + 1) * STRIDE;
        let entry = Entry {
            count: parts + 1,
            item: Arc::new(Mutex::new(item)),
        };
        let mut entries = self.entries.write().unwrap_or_else(PoisonError::into_inner);
        entries.insert(handle, entry);
        handle
    }

    /// Returns the handle of part `number` of an item, counted from 1.
    pub fn part(handle: usize, number: usize) -> usize {
        handle + number * STRIDE
    }

    /// Closes an item; a call in progress completes first. Returns whether an item had this handle; a part is not an item.
    pub fn remove(&self, handle: usize) -> bool {
        let mut entries = self.entries.write().unwrap_or_else(PoisonError::into_inner);
        let removed = entries.remove(&handle);
        drop(entries);
        let is_known = removed.is_some();
        // a panic while dropping leaks the item, which the host no longer uses
        let _ = guard(move || drop(removed));
        is_known
    }

    /// Runs `body` on the item of a handle and the number of the part, 0 for the item itself.
    ///
    /// # Errors
    /// The handle is null, unknown or poisoned, or `body` panicked.
    pub fn with<R>(&self, handle: usize, body: impl FnOnce(&mut T, usize) -> R) -> Result<R, Denied> {
        if handle == 0 {
            return Err(Denied::Null);
        }
        let entries = self.entries.read().unwrap_or_else(PoisonError::into_inner);
        let (first, entry) = entries.range(..=handle).next_back().ok_or(Denied::Unknown)?;
        let (number, rest) = ((handle - first) / STRIDE, (handle - first) % STRIDE);
        if number >= entry.count || rest != 0 {
            return Err(Denied::Unknown);
        }
        let item = Arc::clone(&entry.item);
        drop(entries);
        guard(|| match item.lock() {
            Ok(mut item) => Ok(body(&mut item, number)),
            Err(_) => Err(Denied::Poisoned),
        })
        .unwrap_or_else(|message| Err(Denied::Panicked(message)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_handle_is_refused_and_never_given_again() {
        let handles = Handles::new();
        let first = handles.insert(1, 2);
        assert_eq!(handles.with(first, |item, part| (*item, part)), Ok((1, 0)));
        let part = Handles::<i32>::part(first, 2);
        assert_eq!(handles.with(part, |item, part| (*item, part)), Ok((1, 2)));
        let beyond = Handles::<i32>::part(first, 3);
        for wrong in [beyond, first + 1, first - 1, usize::MAX, 1] {
            assert_eq!(handles.with(wrong, |_, _| ()), Err(Denied::Unknown), "{wrong}");
        }
        assert_eq!(handles.with(0, |_, _| ()), Err(Denied::Null));
        assert!(!handles.remove(part) && handles.remove(first) && !handles.remove(first));
        assert_eq!(handles.with(first, |_, _| ()), Err(Denied::Unknown));
        assert_ne!(handles.insert(2, 0), first);
    }

    #[test]
    fn an_item_whose_call_panicked_can_only_be_closed() {
        let handles = Handles::new();
        let (one, other) = (handles.insert(1, 0), handles.insert(2, 0));
        let denied = handles.with(one, |_, _| panic!("broken"));
        assert!(matches!(denied, Err(Denied::Panicked(message)) if message.contains("broken")));
        assert_eq!(handles.with(one, |item, _| *item), Err(Denied::Poisoned));
        assert_eq!(handles.with(other, |item, _| *item), Ok(2));
        assert!(handles.remove(one));
    }
}
