//! Handles, calls, and all code that uses a host's pointers.
//!
//! Guarantees of the host: a pointer that is not null points to as many values as the function requires, which stay valid and are not changed by
//! others during the call; a text ends with a zero byte. Null pointers, closed handles and handles of the wrong kind are refused. Any
//! thread may call; calls on one system are serialised.

use std::ffi::{c_char, c_int, c_uint};
use std::ops::{Deref, DerefMut};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use moorline_boundary::guard::guard;
use moorline_boundary::handles::{Denied, Handles};
use moorline_boundary::pointers;
use moorline_system::failure::Outcome;
use moorline_system::log::{ERROR, Log, MESSAGE, NONE};
use moorline_system::saved::{self, HEAD};
use moorline_system::settings::Settings;
use moorline_system::{Code, Failure, System};

use crate::handles::{Handle, Kind, MoorDyn, MoorDynLine};

/// Deck used if the host passes a null path.
const DEFAULT_DECK: &str = "Mooring/lines.txt";

/// All open systems.
static SYSTEMS: Handles<Held> = Handles::new();

/// True if the host of the first interface has disabled messages in the console.
static IS_CONSOLE_DISABLED: AtomicBool = AtomicBool::new(false);

/// The system of the first interface.
pub(crate) static THE_SYSTEM: TheSystem = TheSystem(AtomicUsize::new(0));

/// Storage for one handle.
pub(crate) struct TheSystem(AtomicUsize);

impl TheSystem {
    /// Returns the handle; null if there is none.
    pub(crate) fn get(&self) -> MoorDyn {
        MoorDyn::of(self.0.load(Ordering::Acquire))
    }

    /// Stores another handle and returns the previous one.
    pub(crate) fn replace(&self, system: MoorDyn) -> MoorDyn {
        MoorDyn::of(self.0.swap(system.number(), Ordering::AcqRel))
    }
}

/// A system with its own handle.
pub(crate) struct Held {
    system: System,
    handle: usize,
}

impl Deref for Held {
    type Target = System;

    fn deref(&self) -> &System {
        &self.system
    }
}

impl DerefMut for Held {
    fn deref_mut(&mut self) -> &mut System {
        &mut self.system
    }
}

/// Kinds of the parts of a system and the number of parts of each kind, in the order of their handles.
fn kinds(system: &System) -> [(Kind, usize); 7] {
    let lists = &system.deck.lists;
    [
        (Kind::System, 1),
        (Kind::Waves, 1),
        (Kind::Seafloor, 1),
        (Kind::Body, lists.bodies.len()),
        (Kind::Rod, lists.rods.len()),
        (Kind::Point, lists.points.len()),
        (Kind::Line, lists.lines.len()),
    ]
}

/// Returns the kind of a part and its row, from 0, by the number of the part.
fn row_of(system: &System, number: usize) -> Option<(Kind, usize)> {
    let mut first = 0;
    kinds(system).into_iter().find_map(|(kind, count)| {
        let row = number.checked_sub(first).filter(|row| *row < count);
        first += count;
        row.map(|row| (kind, row))
    })
}

/// Returns the number of a part by its kind and row, from 0.
fn number_of(system: &System, wanted: Kind, row: usize) -> Option<usize> {
    let mut first = 0;
    for (kind, count) in kinds(system) {
        if kind == wanted {
            return (row < count).then_some(first + row);
        }
        first += count;
    }
    None
}

/// Writes to the console an error that has no system, and therefore no log.
fn complain(message: &str) {
    let level = match IS_CONSOLE_DISABLED.load(Ordering::Relaxed) {
        true => NONE,
        false => MESSAGE,
    };
    Log::from_level(level).write(ERROR, message);
}

/// Creates a system from the deck at a path; [`DEFAULT_DECK`] if the path is null.
///
/// # Safety
/// The path is null or ends with a zero byte.
pub(crate) unsafe fn create(path: *const c_char) -> MoorDyn {
    let made = guard(|| {
        // SAFETY: by the caller's promise.
        let given = (!path.is_null()).then(|| unsafe { self::path(path) });
        let path = given.unwrap_or(Ok(Path::new(DEFAULT_DECK)))?;
        let settings = Settings::read(|name| std::env::var(name).ok())?;
        let level = match IS_CONSOLE_DISABLED.load(Ordering::Relaxed) {
            true => NONE,
            false => MESSAGE,
        };
        System::create(path, settings, Log::from_level(level))
    });
    match made {
        Ok(Ok(system)) => {
            let parts = kinds(&system).iter().map(|(_, count)| count).sum::<usize>() - 1;
            let handle = SYSTEMS.insert(Held { system, handle: 0 }, parts);
            let _ = SYSTEMS.with(handle, |held, _| held.handle = handle);
            MoorDyn::of(handle)
        }
        Ok(Err(failure)) => {
            complain(&format!("MoorDyn_Create: {failure}"));
            MoorDyn::of(0)
        }
        Err(panic) => {
            complain(&format!("MoorDyn_Create: {panic}"));
            MoorDyn::of(0)
        }
    }
}

/// Closes a system.
pub(crate) fn close(system: MoorDyn) -> c_int {
    match SYSTEMS.remove(system.number()) {
        true => Code::Success as c_int,
        false => {
            complain("MoorDyn_Close: the handle is null, closed, or no system");
            Code::InvalidValue as c_int
        }
    }
}

/// Carries out a call on a system or a part: checks handle and kind, catches a panic, logs a failure and returns the code. `body` receives the
/// row of the part, from 0.
pub(crate) fn call<H: Handle>(
    handle: H,
    function: &str,
    body: impl FnOnce(&mut Held, usize) -> Outcome,
) -> c_int {
    let served = SYSTEMS.with(handle.number(), |held, number| {
        let result = match row_of(held, number) {
            Some((kind, row)) if kind == H::KIND => body(held, row),
            _ => Err(Failure::new(
                Code::InvalidInput,
                format!("the handle is not that of a {:?}", H::KIND),
            )),
        };
        result.map_err(|failure| {
            held.log.write(ERROR, &format!("{function}: {failure}"));
            failure.code
        })
    });
    match served {
        Ok(Ok(())) => Code::Success as c_int,
        Ok(Err(code)) => code as c_int,
        Err(denied) => {
            let (code, message) = match denied {
                Denied::Null => (Code::InvalidValue, "the handle is null".to_string()),
                Denied::Unknown => (Code::InvalidValue, "the handle is closed, or none".to_string()),
                Denied::Poisoned => (
                    Code::Unhandled,
                    "an earlier call failed inside: close the system".to_string(),
                ),
                Denied::Panicked(message) => (Code::Unhandled, message),
            };
            complain(&format!("{function}: {message}"));
            code as c_int
        }
    }
}

/// Carries out a call that returns one value.
///
/// # Safety
/// `target` is null or may be written to.
pub(crate) unsafe fn get<H: Handle, T>(
    handle: H,
    function: &str,
    target: *mut T,
    value: impl FnOnce(&Held, usize) -> Outcome<T>,
) -> c_int {
    call(handle, function, |held, row| {
        let value = value(held, row)?;
        // SAFETY: by the caller's promise.
        unsafe { put(target, value) }
    })
}

/// Returns the handle of a part by its kind and number, from 1; null if there is none.
pub(crate) fn part_of<H: Handle>(system: MoorDyn, function: &str, kind: Kind, number: c_uint) -> H {
    let mut part = 0;
    let _ = call(system, function, |held, _| {
        let row = (number as usize).checked_sub(1);
        let has_part = kind != Kind::Seafloor || held.deck.scene.seabed.is_some();
        let found = row
            .filter(|_| has_part)
            .and_then(|row| number_of(held, kind, row));
        let missing = || Failure::new(Code::InvalidInput, format!("there is no {kind:?} {number}"));
        part = Handles::<Held>::part(held.handle, found.ok_or_else(missing)?);
        Ok(())
    });
    H::of(part)
}

/// Returns the row, from 0, of a part that must belong to the system.
pub(crate) fn part<H: Handle>(handle: H, held: &Held) -> Outcome<usize> {
    let all = kinds(held).iter().map(|(_, count)| count).sum();
    let mut numbers =
        (0..all).filter(|number| Handles::<Held>::part(held.handle, *number) == handle.number());
    let found = numbers.next().and_then(|number| row_of(held, number));
    match found {
        Some((kind, row)) if kind == H::KIND => Ok(row),
        _ => Err(Failure::new(
            Code::InvalidInput,
            format!("a handle is not that of a {:?} of this system", H::KIND),
        )),
    }
}

/// Returns the handle of a line by its row, from 0.
pub(crate) fn line_handle(held: &Held, row: usize) -> Outcome<MoorDynLine> {
    let number = number_of(held, Kind::Line, row);
    let number = number.ok_or_else(|| Failure::new(Code::Unhandled, "the line has no handle"))?;
    Ok(MoorDynLine::of(Handles::<Held>::part(held.handle, number)))
}

/// Converts a count to C's unsigned int.
pub(crate) fn count(number: usize) -> Outcome<c_uint> {
    c_uint::try_from(number)
        .map_err(|_| Failure::value(format!("{number} is more than C's unsigned int holds")))
}

/// Converts a number to C's int.
pub(crate) fn int(number: usize) -> Outcome<c_int> {
    c_int::try_from(number).map_err(|_| Failure::value(format!("{number} is more than C's int holds")))
}

/// Converts a number of C that counts from 0.
pub(crate) fn number(number: c_int) -> Outcome<usize> {
    usize::try_from(number).map_err(|_| Failure::value(format!("{number} is negative")))
}

/// Converts a number of C that counts from 1 to a row, from 0.
pub(crate) fn index(number: c_int) -> Outcome<usize> {
    let row = number.checked_sub(1).and_then(|row| usize::try_from(row).ok());
    row.ok_or_else(|| Failure::value(format!("there is no number {number}: they begin with 1")))
}

/// Refuses a value other than zero, with a message.
pub(crate) fn only_zero(value: f64, problem: &str) -> Outcome {
    match value == 0.0 {
        true => Ok(()),
        false => Err(Failure::missing(problem)),
    }
}

/// Returns the wave number [1/m] for a circular frequency [rad/s]; NaN if the frequency, gravity [m/s²] or depth [m] is not positive.
pub(crate) fn wave_number(frequency: f64, gravity: f64, depth: f64) -> f64 {
    let is_usable = [frequency, gravity, depth]
        .iter()
        .all(|value| value.is_finite() && *value > 0.0);
    let found =
        is_usable.then(|| guard(|| moorline::physics::airy::wave_number(frequency, Some(depth), gravity)));
    found.and_then(Result::ok).unwrap_or(f64::NAN)
}

/// Turns messages in the console off or on, for a system and for systems created later.
pub(crate) fn disable_console(system: MoorDyn, is_disabled: bool) {
    IS_CONSOLE_DISABLED.store(is_disabled, Ordering::Relaxed);
    let level = if is_disabled { NONE } else { MESSAGE };
    let _ = SYSTEMS.with(system.number(), |held, _| held.log.set_console(level));
}

/// Returns the host's values as a slice.
///
/// # Safety
/// As [`pointers::slice`].
pub(crate) unsafe fn slice<'a, T>(pointer: *const T, count: usize) -> Outcome<&'a [T]> {
    // SAFETY: by the caller's promise.
    unsafe { pointers::slice(pointer, count) }.map_err(Failure::value)
}

/// Returns the host's values as a mutable slice.
///
/// # Safety
/// As [`pointers::slice_mut`].
pub(crate) unsafe fn slice_mut<'a, T>(pointer: *mut T, count: usize) -> Outcome<&'a mut [T]> {
    // SAFETY: by the caller's promise.
    unsafe { pointers::slice_mut(pointer, count) }.map_err(Failure::value)
}

/// Returns one value of the host.
///
/// # Safety
/// As [`pointers::slice`].
pub(crate) unsafe fn one<'a, T>(pointer: *const T) -> Outcome<&'a T> {
    // SAFETY: by the caller's promise.
    let values = unsafe { slice(pointer, 1) }?;
    values.first().ok_or_else(|| Failure::value("a pointer is null"))
}

/// Writes a value to the host.
///
/// # Safety
/// As [`pointers::write`].
pub(crate) unsafe fn put<T>(target: *mut T, value: T) -> Outcome {
    // SAFETY: by the caller's promise.
    unsafe { pointers::write(target, value) }.map_err(Failure::value)
}

/// Returns a text of the host.
///
/// # Safety
/// As [`pointers::text`].
pub(crate) unsafe fn text<'a>(pointer: *const c_char) -> Outcome<&'a str> {
    // SAFETY: by the caller's promise.
    unsafe { pointers::text(pointer) }.map_err(Failure::value)
}

/// Returns a path of the host.
///
/// # Safety
/// As [`pointers::text`].
pub(crate) unsafe fn path<'a>(pointer: *const c_char) -> Outcome<&'a Path> {
    // SAFETY: by the caller's promise.
    Ok(Path::new(unsafe { text(pointer) }?))
}

/// Copies a text to the host's buffer of `*room` bytes and sets `*room` to the size needed. A null target only gets the size.
///
/// # Safety
/// A target that is not null points to `*room` bytes.
pub(crate) unsafe fn copy_text(text: &str, target: *mut c_char, room: *mut usize) -> Outcome {
    // SAFETY: by the caller's promise.
    unsafe {
        let given = match target.is_null() {
            true => 0,
            false => match room.is_null() {
                true => text.len() + 1, // such hosts allocate the size that they have requested before
                false => *one(room)?,
            },
        };
        let needed = pointers::copy_text(text, target, given).map_err(Failure::value)?;
        match room.is_null() {
            true => Ok(()),
            false => put(room, needed),
        }
    }
}

/// Copies words to a host that has requested their number before; a null target gets none.
///
/// # Safety
/// A target that is not null has room for them.
pub(crate) unsafe fn copy_words(words: &[u64], target: *mut u64) -> Outcome {
    if target.is_null() {
        return Ok(());
    }
    // SAFETY: by the caller's promise.
    unsafe { slice_mut(target, words.len()) }?.copy_from_slice(words);
    Ok(())
}

/// Returns the words of a saved state, the first of which defines its length.
///
/// # Safety
/// A pointer that is not null points to words of a state; if the first ones are not those of a state of moorline, no others are read.
pub(crate) unsafe fn words<'a>(pointer: *const u64) -> Outcome<&'a [u64]> {
    // SAFETY: by the caller's promise.
    let head = unsafe { slice(pointer, HEAD) }?;
    let head = head.first_chunk::<HEAD>().copied().unwrap_or_default();
    // SAFETY: as above; the first word defines their number.
    unsafe { slice(pointer, saved::length(head)?) }
}

/// Writes the end forces of the first `*count` lines [N]: horizontal and vertical at the fairleads, then horizontal and vertical at the anchors.
///
/// # Safety
/// `count` points to a number, `targets` to as many values each.
pub(crate) unsafe fn end_tensions(held: &Held, count: *const c_int, targets: [*mut f32; 4]) -> Outcome {
    // SAFETY: by the caller's promise.
    let count = number(unsafe { *one(count)? })?;
    let lines = held.deck.lists.lines.len();
    if count > lines {
        return Err(Failure::value(format!(
            "{count} lines are asked for: the deck has {lines}"
        )));
    }
    for (part, target) in targets.into_iter().enumerate() {
        // SAFETY: by the caller's promise.
        let target = unsafe { slice_mut(target, count) }?;
        for (line, value) in target.iter_mut().enumerate() {
            *value = held.end_tensions(line)?[part] as f32;
        }
    }
    Ok(())
}

/// Writes the motion of the water at a position [m]; null targets are skipped.
///
/// # Safety
/// Targets that are not null have room for three values, and for one.
pub(crate) unsafe fn flow(
    held: &Held,
    place: [f64; 3],
    vectors: [*mut f64; 2],
    scalars: [*mut f64; 2],
) -> Outcome {
    let flow = held.flow(place)?;
    let [elevation, pressure] = scalars;
    if !pressure.is_null() && held.simulation()?.model().waves.is_some() {
        return Err(Failure::missing(
            "the dynamic pressure of waves is not found: give null for it",
        ));
    }
    for (target, vector) in vectors.into_iter().zip([flow.velocity, flow.acceleration]) {
        if !target.is_null() {
            // SAFETY: by the caller's promise.
            unsafe { put(target.cast(), vector) }?;
        }
    }
    for (target, value) in [(elevation, flow.elevation), (pressure, 0.0)] {
        if !target.is_null() {
            // SAFETY: by the caller's promise.
            unsafe { put(target, value) }?;
        }
    }
    Ok(())
}
