//! Bodies, points and rods.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.
#![allow(non_snake_case)]

use std::ffi::{c_char, c_int, c_uint};

use moorline_system::Failure;

use crate::edge::{self, count, int};
use crate::handles::{MoorDynBody, MoorDynLine, MoorDynPoint, MoorDynRod};

const NO_RODS: &str = "the weight and drag of rods are not modelled: a rod only holds the ends of lines";

fn no_shape(what: &str) -> Failure {
    Failure::missing(format!(
        "{what} has no shape to write: MoorDyn_SaveVTK writes the lines"
    ))
}

fn no_attachment(index: c_uint, count: usize) -> Failure {
    Failure::value(format!(
        "there is no attachment {index}: the point has {count}, from 0"
    ))
}

/// Gets the number of a body, as in the deck.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyID(b: MoorDynBody, id: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyID", id, |system, index| {
            int(system.body(index)?.number)
        })
    }
}

/// Gets the kind of a body: -1 coupled, 0 free, 1 fixed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyType(b: MoorDynBody, t: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyType", t, |system, index| {
            system.body_type(index)
        })
    }
}

/// Gets the position [m] and angles [rad] of a body, and its velocity [m/s] and angular velocity [rad/s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyState(b: MoorDynBody, r: *mut f64, rd: *mut f64) -> c_int {
    edge::call(b, "MoorDyn_GetBodyState", |system, index| {
        let state = system.body_state(index)?;
        // SAFETY: two arrays of six values.
        unsafe {
            edge::put(r.cast(), state.place)?;
            edge::put(rd.cast(), state.rate)
        }
    })
}

/// Gets the position of a body [m].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyPos(b: MoorDynBody, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyPos", out.cast(), |system, index| {
            let [x, y, z, ..] = system.body_state(index)?.place;
            Ok([x, y, z])
        })
    }
}

/// Gets roll, pitch and yaw of a body [rad], for the rotation Rx Ry Rz.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyAngle(b: MoorDynBody, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyAngle", out.cast(), |system, index| {
            let [.., x, y, z] = system.body_state(index)?.place;
            Ok([x, y, z])
        })
    }
}

/// Gets the velocity of a body [m/s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyVel(b: MoorDynBody, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyVel", out.cast(), |system, index| {
            let [x, y, z, ..] = system.body_state(index)?.rate;
            Ok([x, y, z])
        })
    }
}

/// Gets the angular velocity of a body [rad/s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyAngVel(b: MoorDynBody, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyAngVel", out.cast(), |system, index| {
            let [.., x, y, z] = system.body_state(index)?.rate;
            Ok([x, y, z])
        })
    }
}

/// Gets the force [N] and moment [N m] of the lines on a coupled body, about its reference point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyForce(b: MoorDynBody, f: *mut f64) -> c_int {
    // SAFETY: the host's array of six values.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyForce", f.cast(), |system, index| {
            system.body_force(index)
        })
    }
}

/// Gets the mass matrix of the end nodes on a coupled body, added mass included, row by row [kg, kg m, kg m²].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyM(b: MoorDynBody, m: *mut [f64; 6]) -> c_int {
    // SAFETY: the host's array of six rows.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyM", m.cast(), |system, index| {
            system.body_mass(index)
        })
    }
}

/// Not supported: a body has no geometry.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SaveBodyVTK(b: MoorDynBody, _filename: *const c_char) -> c_int {
    edge::call(b, "MoorDyn_SaveBodyVTK", |_, _| Err(no_shape("a body")))
}

/// Gets the number of a point, as in the deck.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointID(point: MoorDynPoint, id: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(point, "MoorDyn_GetPointID", id, |system, index| {
            int(system.point_number(index)?)
        })
    }
}

/// Gets the kind of a point: -1 coupled, 0 free, 1 fixed or on a body.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointType(point: MoorDynPoint, t: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(point, "MoorDyn_GetPointType", t, |system, index| {
            system.point_type(index)
        })
    }
}

/// Gets the position of a point [m].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointPos(point: MoorDynPoint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(point, "MoorDyn_GetPointPos", out.cast(), |system, index| {
            Ok(<[f64; 3]>::from(system.point_state(index)?.position))
        })
    }
}

/// Gets the velocity of a point [m/s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointVel(point: MoorDynPoint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(point, "MoorDyn_GetPointVel", out.cast(), |system, index| {
            Ok(<[f64; 3]>::from(system.point_state(index)?.velocity))
        })
    }
}

/// Gets the force on a point [N]: from its lines and from its own loads.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointForce(point: MoorDynPoint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(point, "MoorDyn_GetPointForce", out.cast(), |system, index| {
            system.point_force(index)
        })
    }
}

/// Gets the mass matrix of a point and its end nodes, added mass included, row by row [kg].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointM(point: MoorDynPoint, m: *mut [f64; 3]) -> c_int {
    // SAFETY: the host's array of three rows.
    unsafe {
        edge::get(point, "MoorDyn_GetPointM", m.cast(), |system, index| {
            system.point_mass(index)
        })
    }
}

/// Gets the number of line ends attached to a point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointNAttached(point: MoorDynPoint, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(point, "MoorDyn_GetPointNAttached", n, |system, index| {
            count(system.point_attached(index)?.len())
        })
    }
}

/// Gets the line of attachment `i`, counted from 0, and the end of the line at the point: 0 for A, 1 for B.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointAttached(
    point: MoorDynPoint,
    i: c_uint,
    l: *mut MoorDynLine,
    e: *mut c_int,
) -> c_int {
    edge::call(point, "MoorDyn_GetPointAttached", |system, index| {
        let attached = system.point_attached(index)?;
        let (line, end) = attached
            .get(i as usize)
            .ok_or_else(|| no_attachment(i, attached.len()))?;
        let line = edge::line_handle(system, *line)?;
        // SAFETY: a handle and a number.
        unsafe {
            edge::put(l, line)?;
            edge::put(e, *end)
        }
    })
}

/// Not supported: a point has no geometry.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SavePointVTK(point: MoorDynPoint, _filename: *const c_char) -> c_int {
    edge::call(point, "MoorDyn_SavePointVTK", |_, _| Err(no_shape("a point")))
}

/// Gets the number of a rod, as in the deck.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodID(rod: MoorDynRod, id: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodID", id, |system, index| {
            int(system.rod(index)?.number)
        })
    }
}

/// Gets the kind of a rod: always 2, fixed or on a body, since moorline models no other rods.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodType(rod: MoorDynRod, t: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodType", t, |system, index| {
            system.rod(index).map(|_| 2)
        })
    }
}

/// Not supported: a rod only carries line ends.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodForce(rod: MoorDynRod, _f: *mut f64) -> c_int {
    edge::call(rod, "MoorDyn_GetRodForce", |_, _| Err(Failure::missing(NO_RODS)))
}

/// Not supported: a rod only carries line ends.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodM(rod: MoorDynRod, _m: *mut [f64; 6]) -> c_int {
    edge::call(rod, "MoorDyn_GetRodM", |_, _| Err(Failure::missing(NO_RODS)))
}

/// Gets the number of segments of a rod.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodN(rod: MoorDynRod, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodN", n, |system, index| {
            count(system.rod(index)?.segments)
        })
    }
}

/// Gets the number of nodes of a rod.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodNumberNodes(rod: MoorDynRod, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodNumberNodes", n, |system, index| {
            count(system.rod(index)?.segments + 1)
        })
    }
}

/// Gets the position [m] of node `i` of a rod, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodNodePos(rod: MoorDynRod, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodNodePos", out.cast(), |system, index| {
            Ok(system.rod_node(index, i as usize)?[0])
        })
    }
}

/// Gets the velocity [m/s] of node `i` of a rod, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodNodeVel(rod: MoorDynRod, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodNodeVel", out.cast(), |system, index| {
            Ok(system.rod_node(index, i as usize)?[1])
        })
    }
}

/// Not supported: a rod only carries line ends.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SaveRodVTK(rod: MoorDynRod, _filename: *const c_char) -> c_int {
    edge::call(rod, "MoorDyn_SaveRodVTK", |_, _| Err(no_shape("a rod")))
}
