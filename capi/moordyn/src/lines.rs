//! Lines and their nodes.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.
#![allow(non_snake_case)]

use std::ffi::{c_char, c_int, c_uint};

use moorline_system::Failure;
use moorline_system::nodes::Quantity;

use crate::edge::{self, count, int};
use crate::handles::MoorDynLine;

const NO_WINCH: &str = "lines that are paid out or hauled in while they move are not driven through this interface: a moorline scene has winches";
const NO_PRESSURE: &str = "bending by the pressure inside a line is not modelled";

/// Gets a vector quantity of a node.
///
/// # Safety
/// `out` is null or has room for three values.
unsafe fn vector(
    l: MoorDynLine,
    function: &str,
    node: c_uint,
    (quantity, out): (Quantity, *mut f64),
) -> c_int {
    // SAFETY: by the caller's promise.
    unsafe {
        edge::get(l, function, out.cast(), |system, index| {
            system.node_vector(index, node as usize, quantity)
        })
    }
}

/// Gets the number of a line, as in the deck.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineID(l: MoorDynLine, id: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_GetLineID", id, |system, index| {
            int(system.line(index)?.number)
        })
    }
}

/// Gets the number of segments of a line.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineN(l: MoorDynLine, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_GetLineN", n, |system, index| {
            count(system.line(index)?.segments)
        })
    }
}

/// Gets the number of nodes of a line.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNumberNodes(l: MoorDynLine, n: *mut c_uint) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_GetLineNumberNodes", n, |system, index| {
            count(system.line(index)?.segments + 1)
        })
    }
}

/// Gets the unstretched length of a line [m].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineUnstretchedLength(l: MoorDynLine, ul: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_GetLineUnstretchedLength", ul, |system, index| {
            system.unstretched_length(index)
        })
    }
}

/// Sets the unstretched length of a line [m]; only before the start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLineUnstretchedLength(l: MoorDynLine, ul: f64) -> c_int {
    edge::call(l, "MoorDyn_SetLineUnstretchedLength", |system, index| {
        system.set_unstretched_length(index, ul)
    })
}

/// Refuses a rate of the unstretched length [m/s] other than 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLineUnstretchedLengthVel(l: MoorDynLine, v: f64) -> c_int {
    edge::call(l, "MoorDyn_SetLineUnstretchedLengthVel", |_, _| {
        edge::only_zero(v, NO_WINCH)
    })
}

/// Gets 1 if a line has a constant axial stiffness, otherwise 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_IsLineConstantEA(l: MoorDynLine, b: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_IsLineConstantEA", b, |system, index| {
            Ok(c_int::from(system.has_constant_stiffness(index)?))
        })
    }
}

/// Gets the axial stiffness of a line [N].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineConstantEA(l: MoorDynLine, EA: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_GetLineConstantEA", EA, |system, index| {
            system.constant_stiffness(index)
        })
    }
}

/// Sets the axial stiffness of a line [N]; only before the start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLineConstantEA(l: MoorDynLine, EA: f64) -> c_int {
    edge::call(l, "MoorDyn_SetLineConstantEA", |system, index| {
        system.set_constant_stiffness(index, EA)
    })
}

/// Gets 0: bending by internal pressure is not modelled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_IsLinePressBend(l: MoorDynLine, b: *mut c_int) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_IsLinePressBend", b, |system, index| {
            system.line(index).map(|_| 0)
        })
    }
}

/// Refuses to enable bending by internal pressure, which is not modelled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLinePressBend(l: MoorDynLine, b: c_int) -> c_int {
    edge::call(l, "MoorDyn_SetLinePressBend", |_, _| {
        edge::only_zero(f64::from(b), NO_PRESSURE)
    })
}

/// Not supported: bending by internal pressure is not modelled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SetLinePressInt(l: MoorDynLine, _p: *const f64) -> c_int {
    edge::call(l, "MoorDyn_SetLinePressInt", |_, _| {
        Err(Failure::missing(NO_PRESSURE))
    })
}

/// Gets the position [m] at node `i` of a line, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodePos(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { vector(l, "MoorDyn_GetLineNodePos", i, (Quantity::Position, out)) }
}

/// Gets the velocity [m/s] at node `i` of a line, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeVel(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { vector(l, "MoorDyn_GetLineNodeVel", i, (Quantity::Velocity, out)) }
}

/// Gets the sum of all forces except inertia [N] on node `i` of a line, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeForce(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { vector(l, "MoorDyn_GetLineNodeForce", i, (Quantity::Force, out)) }
}

/// Gets the tension [N] at node `i` of a line, counted from 0 at end A, as a vector towards end B.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeTen(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { vector(l, "MoorDyn_GetLineNodeTen", i, (Quantity::Tension, out)) }
}

/// Gets the bending force [N] on node `i` of a line, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeBendStiff(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { vector(l, "MoorDyn_GetLineNodeBendStiff", i, (Quantity::Bending, out)) }
}

/// Gets the weight less buoyancy [N] of node `i` of a line, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeWeight(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { vector(l, "MoorDyn_GetLineNodeWeight", i, (Quantity::Weight, out)) }
}

/// Gets the drag force [N] on node `i` of a line, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeDrag(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { vector(l, "MoorDyn_GetLineNodeDrag", i, (Quantity::Drag, out)) }
}

/// Gets the force of the accelerated water [N] on node `i` of a line, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeFroudeKrilov(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        vector(
            l,
            "MoorDyn_GetLineNodeFroudeKrilov",
            i,
            (Quantity::FroudeKrylov, out),
        )
    }
}

/// Gets the seabed force [N] on node `i` of a line, counted from 0 at end A.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeSeabedForce(l: MoorDynLine, i: c_uint, out: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe { vector(l, "MoorDyn_GetLineNodeSeabedForce", i, (Quantity::Seabed, out)) }
}

/// Gets the curvature of a line at a node [1/m]; 0 without bending stiffness.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeCurv(l: MoorDynLine, i: c_uint, curv: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_GetLineNodeCurv", curv, |system, index| {
            system.node_curvature(index, i as usize)
        })
    }
}

/// Gets the mass matrix of a node of a line, added mass included, row by row [kg].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineNodeM(l: MoorDynLine, i: c_uint, m: *mut [f64; 3]) -> c_int {
    // SAFETY: the host's array of three rows.
    unsafe {
        edge::get(l, "MoorDyn_GetLineNodeM", m.cast(), |system, index| {
            system.node_mass(index, i as usize)
        })
    }
}

/// Gets the tension of the last segment of a line at end B [N].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineFairTen(l: MoorDynLine, t: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_GetLineFairTen", t, |system, index| {
            system.fairlead_tension(index)
        })
    }
}

/// Gets the greatest nodal tension of a line [N].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_GetLineMaxTen(l: MoorDynLine, t: *mut f64) -> c_int {
    // SAFETY: the host's arguments.
    unsafe {
        edge::get(l, "MoorDyn_GetLineMaxTen", t, |system, index| {
            system.greatest_tension(index)
        })
    }
}

/// Writes the shape of a line for ParaView.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn MoorDyn_SaveLineVTK(l: MoorDynLine, filename: *const c_char) -> c_int {
    edge::call(l, "MoorDyn_SaveLineVTK", |system, index| {
        // SAFETY: the host's text.
        let path = unsafe { edge::path(filename) }?;
        system.save_vtk(path, Some(index))
    })
}
