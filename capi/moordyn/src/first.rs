//! First interface of MoorDyn: one system per process.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.
#![allow(non_snake_case)]

use std::ffi::{c_char, c_int};

use moorline_system::nodes::Quantity;
use moorline_system::water::NO_HOST_WATER;
use moorline_system::{Code, Failure};

use crate::edge::{self, THE_SYSTEM};
use crate::system::{MoorDyn_GetFASTtens, MoorDyn_Init, MoorDyn_Step};

/// Creates and starts the system of the first interface; it replaces an earlier one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDynInit(x: *const f64, xd: *const f64, infilename: *const c_char) -> c_int {
    // SAFETY: the host's text and arrays.
    unsafe {
        let system = edge::create(infilename);
        if system.is_null() {
            return Code::InvalidInputFile as c_int;
        }
        let code = MoorDyn_Init(system, x, xd);
        if code == 0 {
            let _ = edge::close(THE_SYSTEM.replace(system));
        } else {
            let _ = edge::close(system);
        }
        code
    }
}

/// Steps the system as `MoorDyn_Step`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDynStep(
    x: *const f64,
    xd: *const f64,
    f: *mut f64,
    t: *mut f64,
    dt: *mut f64,
) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { MoorDyn_Step(THE_SYSTEM.get(), x, xd, f, t, dt) }
}

/// Closes the system.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDynClose() -> c_int {
    edge::close(THE_SYSTEM.replace(std::ptr::null_mut()))
}

/// Turns messages in the console on, or off if `disable` is not 0; also applies to systems created later.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SetDisableConsole(disable: c_int) {
    edge::disable_console(THE_SYSTEM.get(), disable != 0);
}

/// Returns the tension of the last segment [N] of a line by its number, from 1; NaN if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetFairTen(l: c_int) -> f64 {
    let mut tension = f64::NAN;
    edge::call(THE_SYSTEM.get(), "GetFairTen", |system, _| {
        tension = system.fairlead_tension(edge::index(l)?)?;
        Ok(())
    });
    tension
}

/// Gets the tensions of the first `*numLines` lines [N] as `MoorDyn_GetFASTtens` does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetFASTtens(
    numLines: *const c_int,
    FairHTen: *mut f32,
    FairVTen: *mut f32,
    AnchHTen: *mut f32,
    AnchVTen: *mut f32,
) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { MoorDyn_GetFASTtens(THE_SYSTEM.get(), numLines, FairHTen, FairVTen, AnchHTen, AnchVTen) }
}

/// Gets the position of a point [m] by its number, from 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetPointPos(l: c_int, pos: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(THE_SYSTEM.get(), "GetPointPos", pos.cast(), |system, _| {
            Ok(<[f64; 3]>::from(system.point_state(edge::index(l)?)?.position))
        })
    }
}

/// Gets the force on a point [N] by its number, from 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetPointForce(l: c_int, force: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(THE_SYSTEM.get(), "GetPointForce", force.cast(), |system, _| {
            system.point_force(edge::index(l)?)
        })
    }
}

/// Gets the position [m] of a node, counted from 0, of a line, counted from 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetNodePos(LineNum: c_int, NodeNum: c_int, pos: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(THE_SYSTEM.get(), "GetNodePos", pos.cast(), |system, _| {
            let node = edge::number(NodeNum)?;
            system.node_vector(edge::index(LineNum)?, node, Quantity::Position)
        })
    }
}

/// Not supported: moorline does not model water kinematics from the host.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn externalWaveKinInit() -> c_int {
    edge::call(THE_SYSTEM.get(), "externalWaveKinInit", |_, _| {
        Err(Failure::missing(NO_HOST_WATER))
    })
}

/// Not supported, as `externalWaveKinInit`; writes an error to the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn getWaveKinCoordinates(_r: *mut f64) {
    edge::call(THE_SYSTEM.get(), "getWaveKinCoordinates", |_, _| {
        Err(Failure::missing(NO_HOST_WATER))
    });
}

/// Not supported, as `externalWaveKinInit`; writes an error to the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn setWaveKin(_U: *const f64, _Ud: *const f64, _t: f64) {
    edge::call(THE_SYSTEM.get(), "setWaveKin", |_, _| {
        Err(Failure::missing(NO_HOST_WATER))
    });
}

/// Does nothing: `MoorDynStep` writes the output channels to their files.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn AllOutput(_t: f64, _dt: f64) {}
