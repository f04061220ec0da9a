//! Life cycle of a simulation: load, start, step, save.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.

use std::ffi::{c_char, c_int};
use std::path::Path;

use moorline_boundary::guard::guard;

use crate::codes::{MOORLINE_ABI_VERSION, MOORLINE_INTERNAL_ERROR, MOORLINE_OK};
use crate::edge::{self, moorline_simulation};
use crate::session::Session;

/// Returns the version of this interface: MOORLINE_ABI_VERSION of the header with which the library was built.
#[unsafe(no_mangle)]
pub extern "C" fn moorline_abi_version() -> u32 {
    MOORLINE_ABI_VERSION
}

/// Gets the message of the last call that failed on this thread. A text is copied with a zero byte into `room` bytes and truncated to fit; `needed`,
/// unless null, receives the size needed for the whole text. With room 0, `text` may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_message(text: *mut c_char, room: usize, needed: *mut usize) -> c_int {
    let given = guard(|| {
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&edge::message(), text, room, needed) }
    });
    match given {
        Ok(Ok(())) => MOORLINE_OK,
        Ok(Err(failure)) => failure.code,
        Err(_) => MOORLINE_INTERNAL_ERROR,
    }
}

/// Loads a scene, or a deck of MoorDyn or MAP++, from a file. `abi_version` is MOORLINE_ABI_VERSION.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_load(
    abi_version: u32,
    path: *const c_char,
    simulation: *mut moorline_simulation,
) -> c_int {
    // SAFETY: one handle, and the host's text.
    unsafe {
        edge::create("moorline_load", abi_version, simulation, || {
            Session::load(Path::new(edge::text(path)?))
        })
    }
}

/// Reads a scene from a TOML text that refers to no other files.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_read(
    abi_version: u32,
    toml: *const c_char,
    simulation: *mut moorline_simulation,
) -> c_int {
    // SAFETY: one handle, and the host's text.
    unsafe {
        edge::create("moorline_read", abi_version, simulation, || {
            Session::read(edge::text(toml)?)
        })
    }
}

/// Closes a simulation; its handle becomes invalid. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_close(simulation: moorline_simulation) -> c_int {
    edge::close(simulation)
}

/// Selects by convergence trials the values that the scene leaves open: elements, integrator and time step. Takes up to seconds; otherwise, rules choose
/// them. Only before start. Find the variables of profiles and flow after it, and set the flow for the nodes of the selected mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_select(simulation: moorline_simulation) -> c_int {
    edge::call(simulation, "moorline_select", |session| session.select())
}

/// Starts at a time [s], in the scene's initial shapes (static equilibrium by default) with the current inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_start(simulation: moorline_simulation, time: f64) -> c_int {
    edge::call(simulation, "moorline_start", |session| session.start(time))
}

/// Returns to the state before start; parameters and inputs are kept.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_reset(simulation: moorline_simulation) -> c_int {
    edge::call(simulation, "moorline_reset", |session| {
        session.reset();
        Ok(())
    })
}

/// Steps by a time [s]. Inputs refer to the start of the step, or to its end if the scene specifies that.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_step(simulation: moorline_simulation, step: f64) -> c_int {
    edge::call(simulation, "moorline_step", |session| session.step(step))
}

/// Gets the warnings on the scene, the start and the steps that have not been read yet, one per line; an empty text if there are none. A text that
/// does not fit into `room` is kept for the next call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_warnings(
    simulation: moorline_simulation,
    text: *mut c_char,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_warnings", |session| {
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&session.warnings, text, room, needed) }?;
        if room > session.warnings.len() {
            session.warnings.clear();
        }
        Ok(())
    })
}

/// Gets the time [s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_time(simulation: moorline_simulation, time: *mut f64) -> c_int {
    edge::call(simulation, "moorline_time", |session| {
        let value = session.simulation()?.time();
        // SAFETY: one value.
        unsafe { edge::put(time, value) }
    })
}

/// Gets the state as bytes. `needed`, unless null, receives their number; with room 0, `bytes` may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_save(
    simulation: moorline_simulation,
    bytes: *mut u8,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_save", |session| {
        let saved = session.save();
        // SAFETY: room for bytes, and one number.
        unsafe { edge::give_bytes(&saved, bytes, room, needed) }
    })
}

/// Restores a state of `moorline_save`; the simulation continues bit for bit. The state may come from another simulation of the same scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_restore(
    simulation: moorline_simulation,
    bytes: *const u8,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_restore", |session| {
        // SAFETY: the host's bytes.
        session.restore(unsafe { edge::slice(bytes, count) }?)
    })
}

/// Gets the static equilibrium of the scene at its reference positions as JSON, as `moorline statics --json`. The text is returned as by `moorline_message`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_statics(
    simulation: moorline_simulation,
    text: *mut c_char,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_statics", |session| {
        let value = session.statics()?;
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&value, text, room, needed) }
    })
}

/// Gets the scene with its current parameters as TOML. The text is returned as by `moorline_message`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_scene(
    simulation: moorline_simulation,
    text: *mut c_char,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_scene", |session| {
        let value = session.scene();
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&value, text, room, needed) }
    })
}
