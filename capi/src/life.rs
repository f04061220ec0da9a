//! Life of a simulation: load, start, step, save.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.

use std::ffi::{c_char, c_int};
use std::path::Path;

use moorline_boundary::guard::guard;

use crate::codes::{MOORLINE_ABI_VERSION, MOORLINE_INTERNAL_ERROR, MOORLINE_OK};
use crate::edge::{self, moorline_simulation};
use crate::session::Session;

/// Returns the version of this interface; it is MOORLINE_ABI_VERSION of the header that the library was built with.
#[unsafe(no_mangle)]
pub extern "C" fn moorline_abi_version() -> u32 {
    MOORLINE_ABI_VERSION
}

/// Gives the message of the last call of this thread that failed. A text is written with a zero byte into `room` bytes and cut to them; `needed`,
/// unless it is null, becomes the room of the whole text. With room 0, `text` may be null.
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

/// Reads a scene from a text in TOML, which names no other files.
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

/// Closes a simulation; its handle is refused from then on. Null is nothing to close.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_close(simulation: moorline_simulation) -> c_int {
    edge::close(simulation)
}

/// Selects by trials what the scene leaves open: elements, integrator and time step. Takes up to seconds; without it, rules choose. Before start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_select(simulation: moorline_simulation) -> c_int {
    edge::call(simulation, "moorline_select", |session| session.select())
}

/// Starts at a time [s], in the scene's initial shapes (static equilibrium by default) at the present inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_start(simulation: moorline_simulation, time: f64) -> c_int {
    edge::call(simulation, "moorline_start", |session| session.start(time))
}

/// Goes back to before start; parameters and inputs stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_reset(simulation: moorline_simulation) -> c_int {
    edge::call(simulation, "moorline_reset", |session| {
        session.reset();
        Ok(())
    })
}

/// Steps by a time [s]. Inputs hold for the start of the step, or for its end where the scene says so.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_step(simulation: moorline_simulation, step: f64) -> c_int {
    edge::call(simulation, "moorline_step", |session| session.step(step))
}

/// Gives the warnings on the scene, the start and the steps that were not given before, a line each; an empty text where there are none. A text that
/// does not fit into `room` is given again.
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

/// Gives the time [s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_time(simulation: moorline_simulation, time: *mut f64) -> c_int {
    edge::call(simulation, "moorline_time", |session| {
        let value = session.simulation()?.time();
        // SAFETY: one value.
        unsafe { edge::put(time, value) }
    })
}

/// Gives the state as bytes. `needed`, unless it is null, becomes their number; with room 0, `bytes` may be null.
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

/// Goes back to a state of `moorline_save`, from which it goes on bit for bit. A state may be that of another simulation of the same scene.
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

/// Gives the static equilibrium of the scene at its reference positions as JSON, as `moorline statics --json` does. `moorline_message` says how a text is given.
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

/// Gives the scene with its present parameters as TOML. `moorline_message` says how a text is given.
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
