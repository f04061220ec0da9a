//! Bodies and lines.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.

use std::ffi::{c_char, c_int};

use crate::edge::{self, moorline_simulation};
use crate::session::{Failure, Outcome};

/// Copies values to a host's array, which must have the same length.
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

/// Gets the number of bodies that the host moves: coupled points, then vessels.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_body_count(simulation: moorline_simulation, count: *mut usize) -> c_int {
    edge::call(simulation, "moorline_body_count", |session| {
        let value = session.moved().len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gets the name of a body, counted from 0. The text is returned as by `moorline_message`.
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

/// Gets the number of degrees of freedom of a body: 3 for a point, 6 for a vessel.
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

/// Sets the displacement of a body from its reference position [m] and, for a vessel, roll, pitch and yaw relative to its reference attitude
/// [rad] (body to global by yaw, pitch, roll, Z-Y-X); and its velocity [m/s] and angular velocity in global axes [rad/s], which are derived if
/// `velocity` is null.
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

/// Gets the force of the mooring on a body [N] and, for a vessel, the moment about the vessel's origin [N m], in global axes.
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

/// Gets the 36 values of the current stiffness of the mooring on a vessel, row by row: force [N/m, N] and moment [N, N m].
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

/// Gets the number of lines.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_line_count(simulation: moorline_simulation, count: *mut usize) -> c_int {
    edge::call(simulation, "moorline_line_count", |session| {
        let value = session.line_count();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gets the name of a line, counted from 0. The text is returned as by `moorline_message`.
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

/// Gets the number of nodes of a line; only after start.
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

/// Gets x, y, z of every node of a line, from end A to end B [m]: three values per node.
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

/// Gets the effective tension at every node of a line, from end A to end B [N].
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

/// Gets x, y, z of the positions at which the water flow is required next, for the nodes of a line from end A to end B [m]: three values per
/// node. These are the current positions of the nodes or, if inputs refer to the end of the step, their expected positions there. Only after start.
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

/// Sets velocity [m/s] and acceleration [m/s2] of the water at those positions, three values per node, in a scene with `flow = "host"` in [water].
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
