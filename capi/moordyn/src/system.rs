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

/// Creates a system from a deck, by default `Mooring/lines.txt`; returns null and writes the reason to the console if the deck cannot be used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Create(infilename: *const c_char) -> MoorDyn {
    // SAFETY: the host's arguments.
    unsafe { edge::create(infilename) }
}

/// Gets the number of coupled degrees of freedom.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_NCoupledDOF(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_NCoupledDOF", n, |system, _| {
            count(system.deck.degrees_of_freedom())
        })
    }
}

/// Sets the lowest level of messages written to the console.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetVerbosity(system: MoorDyn, verbosity: c_int) -> c_int {
    edge::call(system, "MoorDyn_SetVerbosity", |system, _| {
        system.log.set_console(verbosity);
        Ok(())
    })
}

/// Writes messages to a file as well.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLogFile(system: MoorDyn, log_path: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_SetLogFile", |system, _| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(log_path) }?;
        system.log.set_file(path)
    })
}

/// Sets the lowest level of messages written to the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLogLevel(system: MoorDyn, verbosity: c_int) -> c_int {
    edge::call(system, "MoorDyn_SetLogLevel", |system, _| {
        system.log.set_file_level(verbosity);
        Ok(())
    })
}

/// Writes a message of the host to the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Log(system: MoorDyn, level: c_int, msg: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_Log", |system, _| {
        // SAFETY: the host's text.
        let message = unsafe { edge::text(msg) }?;
        system.log.write(level, message);
        Ok(())
    })
}

/// Starts in static equilibrium at the coupled positions `x` [m, rad], which move at `xd` [m/s, rad/s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Init(system: MoorDyn, x: *const f64, xd: *const f64) -> c_int {
    edge::call(system, "MoorDyn_Init", |system, _| {
        let count = system.deck.degrees_of_freedom();
        // SAFETY: the host's arrays have a value for each coupled degree of freedom.
        let (x, xd) = unsafe { (edge::slice(x, count)?, edge::slice(xd, count)?) };
        system.start(x, xd, false)
    })
}

/// Starts as `MoorDyn_Init` does, but on catenaries instead of the equilibrium, for a state that is loaded next.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Init_NoIC(system: MoorDyn, x: *const f64, xd: *const f64) -> c_int {
    edge::call(system, "MoorDyn_Init_NoIC", |system, _| {
        let count = system.deck.degrees_of_freedom();
        // SAFETY: the host's arrays have a value for each coupled degree of freedom.
        let (x, xd) = unsafe { (edge::slice(x, count)?, edge::slice(xd, count)?) };
        system.start(x, xd, true)
    })
}

/// Steps from `*t` by `*dt` [s] with the coupled positions `x` [m, rad] at the start of the step, which move at `xd` [m/s, rad/s]; gets the forces `f`
/// [N, N m] on the coupled objects at the end of the step, and its time. A step of 0 s gets the current forces.
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

/// Closes a system; its handle and those of its parts become invalid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Close(system: MoorDyn) -> c_int {
    edge::close(system)
}

/// Gets the internal time step set by the deck or the host [s]; moorline chooses its own steps.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetDt(system: MoorDyn, dt: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { edge::get(system, "MoorDyn_GetDt", dt, |system, _| Ok(system.dt)) }
}

/// Sets an upper limit on the internal time step [s], which takes effect at the next start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetDt(system: MoorDyn, dt: f64) -> c_int {
    edge::call(system, "MoorDyn_SetDt", |system, _| system.set_dt(dt))
}

/// Gets the Courant number set by the deck or the host [-]; moorline chooses its steps from the tolerance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetCFL(system: MoorDyn, cfl: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { edge::get(system, "MoorDyn_GetCFL", cfl, |system, _| Ok(system.cfl)) }
}

/// Stores a Courant number [-]; it has no effect.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetCFL(system: MoorDyn, cfl: f64) -> c_int {
    edge::call(system, "MoorDyn_SetCFL", |system, _| system.set_cfl(cfl))
}

/// Gets the name of the time scheme set by the deck or the host. With a null name, gets only the size that the name needs [bytes].
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

/// Stores the name of a time scheme; it has no effect.
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

/// Restores the state from a file; starts the system if it has not been started.
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

/// Restores the state from a file; starts the system if it has not been started.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_Load(system: MoorDyn, filepath: *const c_char) -> c_int {
    edge::call(system, "MoorDyn_Load", |system, _| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(filepath) }?;
        system.load(path)
    })
}

/// Gets the size of the state [bytes] and, unless `data` is null, the state in words of eight bytes.
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

/// Restores a state; starts the system if it has not been started.
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

/// Detaches a line from a point, from the next step on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_BreakLine(system: MoorDyn, point: MoorDynPoint, line: MoorDynLine) -> c_int {
    edge::call(system, "MoorDyn_BreakLine", |system, _| {
        let (point, line) = (edge::part(point, system)?, edge::part(line, system)?);
        system.break_line(point, line)
    })
}

/// Gets the horizontal and vertical forces at the fairleads and anchors of the first `*numLines` lines [N].
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

/// Gets the number of bodies.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetNumberBodies(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_GetNumberBodies", n, |system, _| {
            count(system.deck.lists.bodies.len())
        })
    }
}

/// Gets the number of rods.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetNumberRods(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_GetNumberRods", n, |system, _| {
            count(system.deck.lists.rods.len())
        })
    }
}

/// Gets the number of points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetNumberPoints(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_GetNumberPoints", n, |system, _| {
            count(system.deck.lists.points.len())
        })
    }
}

/// Gets the number of lines.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetNumberLines(system: MoorDyn, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(system, "MoorDyn_GetNumberLines", n, |system, _| {
            count(system.deck.lists.lines.len())
        })
    }
}

/// Returns the handle of a body by its number, from 1; null if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBody(system: MoorDyn, number: c_uint) -> MoorDynBody {
    edge::part_of(system, "MoorDyn_GetBody", Kind::Body, number)
}

/// Returns the handle of a rod by its number, from 1; null if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRod(system: MoorDyn, number: c_uint) -> MoorDynRod {
    edge::part_of(system, "MoorDyn_GetRod", Kind::Rod, number)
}

/// Returns the handle of a point by its number, from 1; null if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPoint(system: MoorDyn, number: c_uint) -> MoorDynPoint {
    edge::part_of(system, "MoorDyn_GetPoint", Kind::Point, number)
}

/// Returns the handle of a line by its number, from 1; null if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLine(system: MoorDyn, number: c_uint) -> MoorDynLine {
    edge::part_of(system, "MoorDyn_GetLine", Kind::Line, number)
}

/// Returns the handle of the water.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetWaves(system: MoorDyn) -> MoorDynWaves {
    edge::part_of(system, "MoorDyn_GetWaves", Kind::Waves, 1)
}

/// Returns the handle of the seabed; null if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetSeafloor(system: MoorDyn) -> MoorDynSeafloor {
    edge::part_of(system, "MoorDyn_GetSeafloor", Kind::Seafloor, 1)
}

/// Steps a system; the host's time changes only if the whole step succeeds.
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
