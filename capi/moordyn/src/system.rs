//! Systems: create, start, step, state, objects.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.
#![allow(non_snake_case)]

use std::ffi::{c_char, c_int, c_uint};

use moorline_system::System;
use moorline_system::failure::Outcome;

use crate::edge::{self, count};
use crate::handles::{
    Kind, MoorDyn, MoorDynBody, MoorDynLine, MoorDynPoint, MoorDynRod, MoorDynSeafloor, MoorDynWaves,
};

/// Creates a system from a deck, by default `Mooring/lines.txt`; null where the deck cannot be used, with the reason in the console.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Create(infilename: *const c_char) -> MoorDyn {
    // SAFETY: the host's arguments.
    unsafe { edge::create(infilename) }
}

/// Gives the number of coupled degrees of freedom.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_NCoupledDOF(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_NCoupledDOF", n, |system, _| {
            count(system.deck.degrees_of_freedom())
        })
    }
}

/// Sets the least level of messages in the console.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetVerbosity(system: MoorDyn, verbosity: c_int) -> c_int {
    edge::call(system, "MoorDyn_SetVerbosity", |system, _| {
        system.log.set_console(verbosity);
        Ok(())
    })
}

/// Writes messages to a file too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLogFile(system: MoorDyn, log_path: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_SetLogFile", |system, _| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(log_path) }?;
        system.log.set_file(path)
    })
}

/// Sets the least level of messages in the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLogLevel(system: MoorDyn, verbosity: c_int) -> c_int {
    edge::call(system, "MoorDyn_SetLogLevel", |system, _| {
        system.log.set_file_level(verbosity);
        Ok(())
    })
}

/// Writes a message of the host.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Log(system: MoorDyn, level: c_int, msg: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_Log", |system, _| {
        // SAFETY: the host's text.
        let message = unsafe { edge::text(msg) }?;
        system.log.write(level, message);
        Ok(())
    })
}

/// Starts in static equilibrium at coupled positions `x` [m, rad] that move by `xd` [m/s, rad/s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Init(system: MoorDyn, x: *const f64, xd: *const f64) -> c_int {
    edge::call(system, "MoorDyn_Init", |system, _| {
        let count = system.deck.degrees_of_freedom();
        // SAFETY: the host's arrays have a value for each coupled degree of freedom.
        let (x, xd) = unsafe { (edge::slice(x, count)?, edge::slice(xd, count)?) };
        system.start(x, xd, false)
    })
}

/// Starts as `MoorDyn_Init`, but on catenaries in place of the equilibrium, for a state that is loaded next.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Init_NoIC(system: MoorDyn, x: *const f64, xd: *const f64) -> c_int {
    edge::call(system, "MoorDyn_Init_NoIC", |system, _| {
        let count = system.deck.degrees_of_freedom();
        // SAFETY: the host's arrays have a value for each coupled degree of freedom.
        let (x, xd) = unsafe { (edge::slice(x, count)?, edge::slice(xd, count)?) };
        system.start(x, xd, true)
    })
}

/// Steps from `*t` by `*dt` [s] with coupled positions `x` [m, rad] at the start, which move by `xd` [m/s, rad/s]; gives the forces `f` [N, N m] on the
/// coupled objects at the end, and its time. A step of 0 s gives the present forces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Step(
    system: MoorDyn,
    x: *const f64,
    xd: *const f64,
    f: *mut f64,
    t: *mut f64,
    dt: *mut f64,
) -> c_int {
    edge::call(system, "MoorDyn_Step", |system, _| {
        // SAFETY: the host's arrays have a value for each coupled degree of freedom; two numbers.
        unsafe { step(system, [x, xd], f, [t, dt]) }
    })
}

/// Closes a system; its handles and those of its parts are refused from then on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Close(system: MoorDyn) -> c_int {
    edge::close(system)
}

/// Gives the internal time step of the deck or the host [s]; moorline chooses its own.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetDt(system: MoorDyn, dt: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { edge::get(system, "MoorDyn_GetDt", dt, |system, _| Ok(system.dt)) }
}

/// Sets an upper limit of the internal time step [s], which holds from the next start on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetDt(system: MoorDyn, dt: f64) -> c_int {
    edge::call(system, "MoorDyn_SetDt", |system, _| system.set_dt(dt))
}

/// Gives the Courant number of the deck or the host [-]; moorline chooses its steps by the tolerance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetCFL(system: MoorDyn, cfl: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { edge::get(system, "MoorDyn_GetCFL", cfl, |system, _| Ok(system.cfl)) }
}

/// Keeps a Courant number [-], which has no effect.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetCFL(system: MoorDyn, cfl: f64) -> c_int {
    edge::call(system, "MoorDyn_SetCFL", |system, _| system.set_cfl(cfl))
}

/// Gives the name of the time scheme of the deck or the host. With a null name, only the room that it needs [bytes].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetTimeScheme(
    system: MoorDyn,
    name: *mut c_char,
    name_len: *mut usize,
) -> c_int {
    edge::call(system, "MoorDyn_GetTimeScheme", |system, _| {
        // SAFETY: `name` is null or has room for `*name_len` bytes.
        unsafe { edge::copy_text(&system.scheme, name, name_len) }
    })
}

/// Keeps the name of a time scheme, which has no effect.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetTimeScheme(system: MoorDyn, name: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_SetTimeScheme", |system, _| {
        // SAFETY: the host's text.
        let name = unsafe { edge::text(name) }?;
        system.set_scheme(name)
    })
}

/// Writes the state to a file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SaveState(system: MoorDyn, filepath: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_SaveState", |system, _| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(filepath) }?;
        system.save(path)
    })
}

/// Goes back to the state of a file; a system that was not started then is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_LoadState(system: MoorDyn, filepath: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_LoadState", |system, _| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(filepath) }?;
        system.load(path)
    })
}

/// Writes the state to a file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Save(system: MoorDyn, filepath: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_Save", |system, _| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(filepath) }?;
        system.save(path)
    })
}

/// Goes back to the state of a file; a system that was not started then is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Load(system: MoorDyn, filepath: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_Load", |system, _| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(filepath) }?;
        system.load(path)
    })
}

/// Gives the number of bytes of the state and, unless `data` is null, the state in words of eight bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Serialize(system: MoorDyn, size: *mut usize, data: *mut u64) -> c_int {
    edge::call(system, "MoorDyn_Serialize", |system, _| {
        let words = system.serialize()?;
        // SAFETY: one number, and null or room for the bytes of an earlier call on the same state.
        unsafe {
            if !size.is_null() {
                edge::put(size, size_of_val(&*words))?;
            }
            edge::copy_words(&words, data)
        }
    })
}

/// Goes back to a state; a system that was not started then is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Deserialize(system: MoorDyn, data: *const u64) -> c_int {
    edge::call(system, "MoorDyn_Deserialize", |system, _| {
        // SAFETY: the words of a state, whose first ones give their number.
        let words = unsafe { edge::words(data) }?;
        system.deserialize(words)
    })
}

/// Writes the shape of all lines for ParaView.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SaveVTK(system: MoorDyn, filename: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_SaveVTK", |system, _| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(filename) }?;
        system.save_vtk(path, None)
    })
}

/// Breaks a line off a point, from the next step on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_BreakLine(system: MoorDyn, point: MoorDynPoint, line: MoorDynLine) -> c_int {
    edge::call(system, "MoorDyn_BreakLine", |system, _| {
        let (point, line) = (edge::part(point, system)?, edge::part(line, system)?);
        system.break_line(point, line)
    })
}

/// Gives horizontal and vertical forces at the fairleads and anchors of the first `*numLines` lines [N].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetFASTtens(
    system: MoorDyn,
    numLines: *const c_int,
    FairHTen: *mut f32,
    FairVTen: *mut f32,
    AnchHTen: *mut f32,
    AnchVTen: *mut f32,
) -> c_int {
    edge::call(system, "MoorDyn_GetFASTtens", |system, _| {
        // SAFETY: one number and four arrays of as many values.
        unsafe { edge::end_tensions(system, numLines, [FairHTen, FairVTen, AnchHTen, AnchVTen]) }
    })
}

/// Gives the number of bodies.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetNumberBodies(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_GetNumberBodies", n, |system, _| {
            count(system.deck.lists.bodies.len())
        })
    }
}

/// Gives the number of rods.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetNumberRods(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_GetNumberRods", n, |system, _| {
            count(system.deck.lists.rods.len())
        })
    }
}

/// Gives the number of points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetNumberPoints(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_GetNumberPoints", n, |system, _| {
            count(system.deck.lists.points.len())
        })
    }
}

/// Gives the number of lines.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetNumberLines(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_GetNumberLines", n, |system, _| {
            count(system.deck.lists.lines.len())
        })
    }
}

/// Returns the handle of a body by its number, from 1; null where there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBody(system: MoorDyn, number: c_uint) -> MoorDynBody {
    edge::part_of(system, "MoorDyn_GetBody", Kind::Body, number)
}

/// Returns the handle of a rod by its number, from 1; null where there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRod(system: MoorDyn, number: c_uint) -> MoorDynRod {
    edge::part_of(system, "MoorDyn_GetRod", Kind::Rod, number)
}

/// Returns the handle of a point by its number, from 1; null where there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPoint(system: MoorDyn, number: c_uint) -> MoorDynPoint {
    edge::part_of(system, "MoorDyn_GetPoint", Kind::Point, number)
}

/// Returns the handle of a line by its number, from 1; null where there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLine(system: MoorDyn, number: c_uint) -> MoorDynLine {
    edge::part_of(system, "MoorDyn_GetLine", Kind::Line, number)
}

/// Returns the handle of the water.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetWaves(system: MoorDyn) -> MoorDynWaves {
    edge::part_of(system, "MoorDyn_GetWaves", Kind::Waves, 1)
}

/// Returns the handle of the seabed; null where there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetSeafloor(system: MoorDyn) -> MoorDynSeafloor {
    edge::part_of(system, "MoorDyn_GetSeafloor", Kind::Seafloor, 1)
}

/// Steps a system; the host's numbers change only where all of it succeeds.
///
/// # Safety
/// The arrays have a value for each coupled degree of freedom.
unsafe fn step(
    system: &mut System,
    [x, xd]: [*const f64; 2],
    f: *mut f64,
    [t, dt]: [*mut f64; 2],
) -> Outcome {
    let count = system.deck.degrees_of_freedom();
    // SAFETY: by the caller's promise. The room for forces is only checked here, since the host may give that of its positions.
    let (x, xd, _) = unsafe {
        (
            edge::slice(x, count)?,
            edge::slice(xd, count)?,
            edge::slice(f, count)?,
        )
    };
    // SAFETY: two numbers, by the caller's promise.
    let [at, step] = unsafe { [*edge::one(t)?, *edge::one(dt)?] };
    let end = system.step(x, xd, at, step)?;
    // SAFETY: by the caller's promise; positions and velocities are not used any more.
    system.forces(unsafe { edge::slice_mut(f, count) }?)?;
    // SAFETY: a number, by the caller's promise.
    unsafe { edge::put(t, end) }
}
