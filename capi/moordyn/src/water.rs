//! Water and seabed.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.
#![allow(non_snake_case, clippy::too_many_arguments)]

use std::ffi::{c_int, c_uint};

use moorline_system::Failure;
use moorline_system::water::NO_HOST_WATER;

use crate::edge;
use crate::handles::{MoorDyn, MoorDynSeafloor, MoorDynWaves};

/// Gets velocity `U` [m/s], acceleration `Ud` [m/s²], surface elevation [m] and dynamic pressure [Pa] of the water at a position [m]. The pressure of
/// waves is not computed: with waves, pass null for it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetWavesKin(
    waves: MoorDynWaves,
    x: f64,
    y: f64,
    z: f64,
    U: *mut f64,
    Ud: *mut f64,
    zeta: *mut f64,
    PDyn: *mut f64,
    _seafloor: MoorDynSeafloor,
) -> c_int {
    edge::call(waves, "MoorDyn_GetWavesKin", |system, _| {
        // SAFETY: two arrays of three values and two numbers, each of which may be null.
        unsafe { edge::flow(system, [x, y, z], [U, Ud], [zeta, PDyn]) }
    })
}

/// Returns the wave number [1/m] for a circular frequency [rad/s], gravity `g` [m/s²] and depth `h` [m]; NaN if one of them is not positive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn WaveNumber(Omega: f64, g: f64, h: f64) -> f64 {
    edge::wave_number(Omega, g, h)
}

/// Gets the height z of the seabed at a horizontal position [m], negative below still water.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetDepthAt(
    seafloor: MoorDynSeafloor,
    x: f64,
    y: f64,
    depth: *mut f64,
) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(seafloor, "MoorDyn_GetDepthAt", depth, |system, _| {
            system.depth_at(x, y)
        })
    }
}

/// Gets the mean height z of the soundings [m].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetAverageDepth(seafloor: MoorDynSeafloor, avgDepth: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(seafloor, "MoorDyn_GetAverageDepth", avgDepth, |system, _| {
            Ok(system.depths()?[0])
        })
    }
}

/// Gets the height z of the shallowest sounding [m].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetMinDepth(seafloor: MoorDynSeafloor, minDepth: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(seafloor, "MoorDyn_GetMinDepth", minDepth, |system, _| {
            Ok(system.depths()?[1])
        })
    }
}

/// Not supported: moorline does not model water kinematics from the host; sets `n` to 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_ExternalWaveKinInit(system: MoorDyn, n: *mut c_uint) -> c_int {
    edge::call(system, "MoorDyn_ExternalWaveKinInit", |_, _| {
        // SAFETY: one number.
        unsafe { edge::put(n, 0) }?;
        Err(Failure::missing(NO_HOST_WATER))
    })
}

/// Not supported, as `MoorDyn_ExternalWaveKinInit`; sets `n` to 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_ExternalWaveKinGetN(system: MoorDyn, n: *mut c_uint) -> c_int {
    edge::call(system, "MoorDyn_ExternalWaveKinGetN", |_, _| {
        // SAFETY: one number.
        unsafe { edge::put(n, 0) }?;
        Err(Failure::missing(NO_HOST_WATER))
    })
}

/// Not supported, as `MoorDyn_ExternalWaveKinInit`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_ExternalWaveKinGetCoordinates(system: MoorDyn, _r: *mut f64) -> c_int {
    edge::call(system, "MoorDyn_ExternalWaveKinGetCoordinates", |_, _| {
        Err(Failure::missing(NO_HOST_WATER))
    })
}

/// Not supported, as `MoorDyn_ExternalWaveKinInit`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_ExternalWaveKinSet(
    system: MoorDyn,
    _U: *const f64,
    _Ud: *const f64,
    _t: f64,
) -> c_int {
    edge::call(system, "MoorDyn_ExternalWaveKinSet", |_, _| {
        Err(Failure::missing(NO_HOST_WATER))
    })
}
