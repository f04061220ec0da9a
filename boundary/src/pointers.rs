//! Slices and texts from a host's pointers.
//!
//! Guarantees of the host: a pointer with a length points to that many values that stay valid during the call, and no other thread changes
//! them; a text ends with a zero byte. Null, misaligned and over-long pointers are refused.

use std::ffi::{CStr, c_char};

/// Maximum length of a text of a host [bytes].
pub const TEXT_MAX: usize = 1 << 24;

/// Checks that `count` values of type T can be at `pointer`.
///
/// # Errors
/// The pointer is null, misaligned or over-long.
pub fn check<T>(pointer: *const T, count: usize) -> Result<(), String> {
    if pointer.is_null() {
        return Err("a pointer is null".to_string());
    }
    if !pointer.is_aligned() {
        return Err("a pointer is not aligned".to_string());
    }
    let bytes = count.checked_mul(size_of::<T>());
    match bytes.is_some_and(|bytes| isize::try_from(bytes).is_ok()) {
        true => Ok(()),
        false => Err(format!("{count} values are more than memory holds")),
    }
}

/// Returns the host's values as a slice; an empty one if `count` is 0.
///
/// # Safety
/// A pointer that is not null points to `count` values that nothing changes during `'a`.
///
/// # Errors
/// The pointer is null, misaligned or over-long.
pub unsafe fn slice<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], String> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer, count)?;
    // SAFETY: not null, aligned, of a possible length; the caller promises the rest.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// Returns the host's values as a mutable slice; an empty one if `count` is 0.
///
/// # Safety
/// A pointer that is not null points to `count` initialised values that nothing else uses during `'a`.
///
/// # Errors
/// The pointer is null, misaligned or over-long.
pub unsafe fn slice_mut<'a, T>(pointer: *mut T, count: usize) -> Result<&'a mut [T], String> {
    if count == 0 {
        return Ok(&mut []);
    }
    check(pointer, count)?;
    // SAFETY: not null, aligned, of a possible length; the caller promises the rest.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) })
}

/// Writes a value to the host.
///
/// # Safety
/// A pointer that is not null may be written to.
///
/// # Errors
/// The pointer is null or misaligned.
pub unsafe fn write<T>(pointer: *mut T, value: T) -> Result<(), String> {
    check(pointer, 1)?;
    // SAFETY: not null and aligned; the caller promises the rest.
    unsafe { pointer.write(value) };
    Ok(())
}

/// Returns a text of the host.
///
/// # Safety
/// A pointer that is not null points to a text that ends with a zero byte and stays as it is during `'a`.
///
/// # Errors
/// The pointer is null, or the text is longer than [`TEXT_MAX`] or not UTF-8.
pub unsafe fn text<'a>(pointer: *const c_char) -> Result<&'a str, String> {
    if pointer.is_null() {
        return Err("a text is null".to_string());
    }
    // SAFETY: not null; the caller promises the rest.
    let text = unsafe { CStr::from_ptr(pointer) };
    match text.count_bytes() > TEXT_MAX {
        true => Err(format!("a text is longer than {TEXT_MAX} bytes")),
        false => text.to_str().map_err(|_| "a text is not UTF-8".to_string()),
    }
}

/// Copies a text and a zero byte into a buffer of `room` bytes, truncated to fit, and returns the size needed for the whole text [bytes]. With `room` 0
/// nothing is copied, and the target may be null.
///
/// # Safety
/// A pointer that is not null points to `room` bytes that nothing else uses.
///
/// The target is null although `room` is not 0.
/// A null pointer with room.
pub unsafe fn copy_text(text: &str, target: *mut c_char, room: usize) -> Result<usize, String> {
    let bytes = text.as_bytes();
    let needed = bytes.len() + 1;
    if room == 0 {
        return Ok(needed);
    }
    check(target, room)?;
    let mut length = bytes.len().min(room - 1);
    while !text.is_char_boundary(length) {
        length -= 1;
    }
    // SAFETY: not null, and `length` + 1 bytes are at most `room`, which the caller promises. Zero bytes inside would only end the text early.
    unsafe {
        std::ptr::copy_nonoverlapping(bytes.as_ptr(), target.cast::<u8>(), length);
        target.add(length).write(0);
    }
    Ok(needed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_that_cannot_be_slices_are_refused() {
        let values = [1.0_f64, 2.0];
        // SAFETY: null, misaligned and over-long pointers are refused before they are used.
        unsafe {
            assert!(slice(std::ptr::null::<f64>(), 1).is_err());
            assert!(slice(values.as_ptr().byte_add(1), 1).is_err());
            assert!(slice(values.as_ptr(), usize::MAX / 4).is_err());
            assert!(write(std::ptr::null_mut::<f64>(), 1.0).is_err());
            assert!(text(std::ptr::null()).is_err() && text(c"\xff".as_ptr()).is_err());
            assert_eq!(slice(std::ptr::null::<f64>(), 0), Ok(&[][..]));
            assert_eq!(slice(values.as_ptr(), 2), Ok(&values[..]));
            assert_eq!(text(c"deck".as_ptr()), Ok("deck"));
        }
    }

    #[test]
    fn a_text_is_cut_to_its_room_at_a_whole_letter() {
        let mut room = [1 as c_char; 4];
        let room_of = room.len();
        // SAFETY: the room is that of the array; null is given with none.
        let needed = unsafe {
            assert_eq!(copy_text("Länge", std::ptr::null_mut(), 0), Ok(7));
            assert!(copy_text("Länge", std::ptr::null_mut(), 1).is_err());
            copy_text("abä", room.as_mut_ptr(), room_of)
        };
        assert_eq!(needed, Ok(5));
        assert_eq!(room, [b'a' as c_char, b'b' as c_char, 0, 1]);
    }
}
