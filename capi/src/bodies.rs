//! Bodies and lines.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.

use std::ffi::{c_char, c_int};

use crate::edge::{self, moorline_simulation};
use crate::session::{Failure, Outcome};

/// Copies values to a host that gives room for exactly as many.
fn copy(values: &[f64], target: &mut [f64]) -> Outcome {
    if values.len() != target.len() {
        let (wanted, given) = (values.len(), target.len());
        return Err(Failure::argument(format!(
            "{wanted} values are given, and there is room for {given}"
        )));
    }
    target.copy_from_slice(values);
    Ok(())
}

/// Gives the number of bodies that the host moves: coupled points, then vessels.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_body_count(simulation: moorline_simulation, count: *mut usize) -> c_int {
    edge::call(simulation, "moorline_body_count", |session| {
        let value = session.moved().len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gives the name of a body, counted from 0. `moorline_message` says how a text is given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_body_name(
    simulation: moorline_simulation,
    body: usize,
    text: *mut c_char,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_body_name", |session| {
        let value = session.body(body)?.name.clone();
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&value, text, room, needed) }
    })
}

/// Gives the degrees of freedom of a body: 3 of a point, 6 of a vessel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_body_size(
    simulation: moorline_simulation,
    body: usize,
    size: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_body_size", |session| {
        let value = session.body(body)?.size;
        // SAFETY: one value.
        unsafe { edge::put(size, value) }
    })
}

/// Sets the displacement of a body from its reference [m], with roll, pitch and yaw of a vessel added to those of its reference attitude [rad], body to
/// global by yaw, pitch, roll (Z-Y-X); and its velocity [m/s] and angular velocity in global axes [rad/s], which are derived where `velocity` is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_move(
    simulation: moorline_simulation,
    body: usize,
    place: *const f64,
    velocity: *const f64,
    size: usize,
) -> c_int {
    edge::call(simulation, "moorline_move", |session| {
        // SAFETY: an array of `size` values, and another or null.
        let (place, velocity) = unsafe {
            let velocity = (!velocity.is_null()).then(|| edge::slice(velocity, size));
            (edge::slice(place, size)?, velocity.transpose()?)
        };
        session.move_body(body, place, velocity)
    })
}

/// Gives the force of the mooring on a body [N] and, on a vessel, its moment about the vessel's origin [N m], in global axes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_force(
    simulation: moorline_simulation,
    body: usize,
    force: *mut f64,
    size: usize,
) -> c_int {
    edge::call(simulation, "moorline_force", |session| {
        let value = session.force(body)?;
        // SAFETY: an array of `size` values.
        copy(&value, unsafe { edge::slice_mut(force, size) }?)
    })
}

/// Gives the 36 values of the stiffness of the mooring on a vessel as it is now, by rows of force [N/m, N] and moment [N, N m].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_stiffness(
    simulation: moorline_simulation,
    body: usize,
    stiffness: *mut f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_stiffness", |session| {
        let value = session.stiffness(body)?;
        // SAFETY: an array of `count` values.
        copy(value.as_flattened(), unsafe {
            edge::slice_mut(stiffness, count)
        }?)
    })
}

/// Gives the number of lines.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_line_count(simulation: moorline_simulation, count: *mut usize) -> c_int {
    edge::call(simulation, "moorline_line_count", |session| {
        let value = session.line_count();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gives the name of a line, counted from 0. `moorline_message` says how a text is given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_line_name(
    simulation: moorline_simulation,
    line: usize,
    text: *mut c_char,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_line_name", |session| {
        let value = session.line(line)?.to_string();
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&value, text, room, needed) }
    })
}

/// Gives the number of nodes of a line, from start on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_node_count(
    simulation: moorline_simulation,
    line: usize,
    count: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_node_count", |session| {
        let value = session.nodes(line)?.len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gives x, y, z of every node of a line, from end A to end B [m]: three values a node.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_node_positions(
    simulation: moorline_simulation,
    line: usize,
    positions: *mut f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_node_positions", |session| {
        let value: Vec<f64> = session
            .nodes(line)?
            .into_iter()
            .flat_map(|(place, _)| place)
            .collect();
        // SAFETY: an array of `count` values.
        copy(&value, unsafe { edge::slice_mut(positions, count) }?)
    })
}

/// Gives the effective tension at every node of a line, from end A to end B [N].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_node_tensions(
    simulation: moorline_simulation,
    line: usize,
    tensions: *mut f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_node_tensions", |session| {
        let value: Vec<f64> = session
            .nodes(line)?
            .into_iter()
            .map(|(_, tension)| tension)
            .collect();
        // SAFETY: an array of `count` values.
        copy(&value, unsafe { edge::slice_mut(tensions, count) }?)
    })
}

/// Gives x, y, z of the places for which the flow of the water is due next, for the nodes of a line from end A to end B [m]: three values a node. These
/// are the places of the nodes now or, where inputs hold for the end of the step, the places they are expected to reach. From start on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_flow_places(
    simulation: moorline_simulation,
    line: usize,
    places: *mut f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_flow_places", |session| {
        let value = session.flow_places(line)?;
        // SAFETY: an array of `count` values.
        copy(value.as_flattened(), unsafe { edge::slice_mut(places, count) }?)
    })
}

/// Sets the velocity [m/s] and the acceleration [m/s2] of the water at those places, three values a node, in a scene with `flow = "host"` in [water].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_set_flow(
    simulation: moorline_simulation,
    line: usize,
    velocities: *const f64,
    accelerations: *const f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_set_flow", |session| {
        // SAFETY: two arrays of `count` values.
        let (velocities, accelerations) = unsafe {
            (
                edge::slice(velocities, count)?,
                edge::slice(accelerations, count)?,
            )
        };
        session.set_flow(line, velocities, accelerations)
    })
}
