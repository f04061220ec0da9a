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

/// Gives the number of a body in the deck.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyID(b: MoorDynBody, id: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyID", id, |system, index| {
            int(system.body(index)?.number)
        })
    }
}

/// Gives the kind of a body: -1 coupled, 0 free, 1 fixed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyType(b: MoorDynBody, t: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyType", t, |system, index| {
            system.body_type(index)
        })
    }
}

/// Gives position [m] and angles [rad] of a body, and their rates [m/s, rad/s].
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

/// Gives the position of a body [m].
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

/// Gives the roll, pitch and yaw of a body by Rx Ry Rz [rad].
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

/// Gives the velocity of a body [m/s].
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

/// Gives the angular velocity of a body [rad/s].
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

/// Gives force [N] and moment [N m] of the lines on a coupled body, about its reference point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyForce(b: MoorDynBody, f: *mut f64) -> c_int {
    // SAFETY: the host's array of six values.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyForce", f.cast(), |system, index| {
            system.body_force(index)
        })
    }
}

/// Gives the mass matrix of the end nodes on a coupled body, added mass included, by rows [kg, kg m, kg m²].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetBodyM(b: MoorDynBody, m: *mut [f64; 6]) -> c_int {
    // SAFETY: the host's array of six rows.
    unsafe {
        edge::get(b, "MoorDyn_GetBodyM", m.cast(), |system, index| {
            system.body_mass(index)
        })
    }
}

/// Is not modelled: a body has no shape.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SaveBodyVTK(b: MoorDynBody, _filename: *const c_char) -> c_int {
    edge::call(b, "MoorDyn_SaveBodyVTK", |_, _| Err(no_shape("a body")))
}

/// Gives the number of a point in the deck.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointID(point: MoorDynPoint, id: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(point, "MoorDyn_GetPointID", id, |system, index| {
            int(system.point_number(index)?)
        })
    }
}

/// Gives the kind of a point: -1 coupled, 0 free, 1 fixed or carried by a body.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointType(point: MoorDynPoint, t: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(point, "MoorDyn_GetPointType", t, |system, index| {
            system.point_type(index)
        })
    }
}

/// Gives the position of a point [m].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointPos(point: MoorDynPoint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(point, "MoorDyn_GetPointPos", out.cast(), |system, index| {
            Ok(<[f64; 3]>::from(system.point_state(index)?.position))
        })
    }
}

/// Gives the velocity of a point [m/s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointVel(point: MoorDynPoint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(point, "MoorDyn_GetPointVel", out.cast(), |system, index| {
            Ok(<[f64; 3]>::from(system.point_state(index)?.velocity))
        })
    }
}

/// Gives the force of the lines on a point and of the point itself [N].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointForce(point: MoorDynPoint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(point, "MoorDyn_GetPointForce", out.cast(), |system, index| {
            system.point_force(index)
        })
    }
}

/// Gives the mass matrix of a point and the end nodes on it, added mass included, by rows [kg].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointM(point: MoorDynPoint, m: *mut [f64; 3]) -> c_int {
    // SAFETY: the host's array of three rows.
    unsafe {
        edge::get(point, "MoorDyn_GetPointM", m.cast(), |system, index| {
            system.point_mass(index)
        })
    }
}

/// Gives the number of line ends at a point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetPointNAttached(point: MoorDynPoint, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(point, "MoorDyn_GetPointNAttached", n, |system, index| {
            count(system.point_attached(index)?.len())
        })
    }
}

/// Gives the handle of the line of attachment `i`, from 0, and its end there: 0 of A, 1 of B.
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

/// Is not modelled: a point has no shape.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SavePointVTK(point: MoorDynPoint, _filename: *const c_char) -> c_int {
    edge::call(point, "MoorDyn_SavePointVTK", |_, _| Err(no_shape("a point")))
}

/// Gives the number of a rod in the deck.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodID(rod: MoorDynRod, id: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodID", id, |system, index| {
            int(system.rod(index)?.number)
        })
    }
}

/// Gives the kind of a rod: 1, fixed or carried by a body, as moorline models no others.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodType(rod: MoorDynRod, t: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodType", t, |system, index| {
            system.rod(index).map(|_| 1)
        })
    }
}

/// Is not modelled: a rod only holds the ends of lines.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodForce(rod: MoorDynRod, _f: *mut f64) -> c_int {
    edge::call(rod, "MoorDyn_GetRodForce", |_, _| Err(Failure::missing(NO_RODS)))
}

/// Is not modelled: a rod only holds the ends of lines.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodM(rod: MoorDynRod, _m: *mut [f64; 6]) -> c_int {
    edge::call(rod, "MoorDyn_GetRodM", |_, _| Err(Failure::missing(NO_RODS)))
}

/// Gives the number of segments of a rod.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodN(rod: MoorDynRod, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodN", n, |system, index| {
            count(system.rod(index)?.segments)
        })
    }
}

/// Gives the number of nodes of a rod.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodNumberNodes(rod: MoorDynRod, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodNumberNodes", n, |system, index| {
            count(system.rod(index)?.segments + 1)
        })
    }
}

/// Gives the position [m] of a node of a rod, from end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodNodePos(rod: MoorDynRod, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodNodePos", out.cast(), |system, index| {
            Ok(system.rod_node(index, i as usize)?[0])
        })
    }
}

/// Gives the velocity [m/s] of a node of a rod, from end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetRodNodeVel(rod: MoorDynRod, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's array of three values.
    unsafe {
        edge::get(rod, "MoorDyn_GetRodNodeVel", out.cast(), |system, index| {
            Ok(system.rod_node(index, i as usize)?[1])
        })
    }
}

/// Is not modelled: a rod only holds the ends of lines.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SaveRodVTK(rod: MoorDynRod, _filename: *const c_char) -> c_int {
    edge::call(rod, "MoorDyn_SaveRodVTK", |_, _| Err(no_shape("a rod")))
}
