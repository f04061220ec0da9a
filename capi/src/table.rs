//! Variables: inputs, outputs and parameters, with the names of the FMU.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::edge`]; nothing else is relied on.

use std::ffi::{c_char, c_int};

use moorline::interface::Causality;

use crate::codes::{MOORLINE_CALCULATED_PARAMETER, MOORLINE_INPUT, MOORLINE_OUTPUT, MOORLINE_PARAMETER};
use crate::edge::{self, moorline_simulation};

fn causality_code(causality: Causality) -> c_int {
    match causality {
        Causality::Input => MOORLINE_INPUT,
        Causality::Output => MOORLINE_OUTPUT,
        Causality::Parameter => MOORLINE_PARAMETER,
        Causality::CalculatedParameter => MOORLINE_CALCULATED_PARAMETER,
    }
}

/// Gets the number of variables, which is also the greatest reference; references count from 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_variable_count(
    simulation: moorline_simulation,
    count: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_variable_count", |session| {
        let value = session.variables().len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gets the reference of a variable by its name, for example `fairlead.x`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_find(
    simulation: moorline_simulation,
    name: *const c_char,
    reference: *mut u32,
) -> c_int {
    edge::call(simulation, "moorline_find", |session| {
        // SAFETY: the host's text, and one value.
        unsafe {
            let found = session.find(edge::text(name)?)?;
            edge::put(reference, found)
        }
    })
}

/// Gets the name of a variable. The text is returned as by `moorline_message`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_variable_name(
    simulation: moorline_simulation,
    reference: u32,
    text: *mut c_char,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_variable_name", |session| {
        let value = session.variable(reference)?.name.clone();
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&value, text, room, needed) }
    })
}

/// Gets the unit of a variable. The text is returned as by `moorline_message`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_variable_unit(
    simulation: moorline_simulation,
    reference: u32,
    text: *mut c_char,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_variable_unit", |session| {
        let value = session.variable(reference)?.unit.name.to_string();
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&value, text, room, needed) }
    })
}

/// Gets the description of a variable, one sentence. The text is returned as by `moorline_message`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_variable_description(
    simulation: moorline_simulation,
    reference: u32,
    text: *mut c_char,
    room: usize,
    needed: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_variable_description", |session| {
        let value = session.variable(reference)?.description.clone();
        // SAFETY: room for a text, and one number.
        unsafe { edge::give_text(&value, text, room, needed) }
    })
}

/// Gets the causality of a variable: MOORLINE_INPUT, MOORLINE_OUTPUT, MOORLINE_PARAMETER or MOORLINE_CALCULATED_PARAMETER.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_variable_causality(
    simulation: moorline_simulation,
    reference: u32,
    causality: *mut c_int,
) -> c_int {
    edge::call(simulation, "moorline_variable_causality", |session| {
        let value = causality_code(session.variable(reference)?.causality);
        // SAFETY: one value.
        unsafe { edge::put(causality, value) }
    })
}

/// Sets inputs, and before start parameters: all of them, or none if one is refused. Displacements are relative to the reference positions [m, rad].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_set(
    simulation: moorline_simulation,
    references: *const u32,
    values: *const f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_set", |session| {
        // SAFETY: two arrays of `count` values.
        let (references, values) = unsafe { (edge::slice(references, count)?, edge::slice(values, count)?) };
        session.set(references, values)
    })
}

/// Gets the values of variables. Results are available after start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_get(
    simulation: moorline_simulation,
    references: *const u32,
    values: *mut f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_get", |session| {
        // SAFETY: two arrays of `count` values.
        let (references, values) =
            unsafe { (edge::slice(references, count)?, edge::slice_mut(values, count)?) };
        session.get(references, values)
    })
}

/// Gets the derivatives of `count` outputs with respect to an input, a displacement or a velocity, at the end of the last step. Requires
/// `derivatives = true` in `[output]` of the scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_derivatives(
    simulation: moorline_simulation,
    outputs: *const u32,
    values: *mut f64,
    count: usize,
    input: u32,
) -> c_int {
    edge::call(simulation, "moorline_derivatives", |session| {
        // SAFETY: two arrays of `count` values.
        let (outputs, values) = unsafe { (edge::slice(outputs, count)?, edge::slice_mut(values, count)?) };
        session.derivatives(outputs, input, values)
    })
}

/// Gets the time derivatives of `count` outputs [per second] at the end of the last step. Requires `derivatives = true` in `[output]` of the scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_rates(
    simulation: moorline_simulation,
    outputs: *const u32,
    values: *mut f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_rates", |session| {
        // SAFETY: two arrays of `count` values.
        let (outputs, values) = unsafe { (edge::slice(outputs, count)?, edge::slice_mut(values, count)?) };
        session.rates(outputs, values)
    })
}

/// Gets the number of inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_input_count(simulation: moorline_simulation, count: *mut usize) -> c_int {
    edge::call(simulation, "moorline_input_count", |session| {
        let value = session.references(Causality::Input).len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gets the number of outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_output_count(simulation: moorline_simulation, count: *mut usize) -> c_int {
    edge::call(simulation, "moorline_output_count", |session| {
        let value = session.references(Causality::Output).len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gets the number of parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_parameter_count(
    simulation: moorline_simulation,
    count: *mut usize,
) -> c_int {
    edge::call(simulation, "moorline_parameter_count", |session| {
        let value = session.references(Causality::Parameter).len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Sets all inputs, in the order of their references.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_set_inputs(
    simulation: moorline_simulation,
    values: *const f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_set_inputs", |session| {
        // SAFETY: an array of `count` values.
        let values = unsafe { edge::slice(values, count) }?;
        let references = session.references(Causality::Input);
        session.set(&references, values)
    })
}

/// Gets all outputs, in the order of their references.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_get_outputs(
    simulation: moorline_simulation,
    values: *mut f64,
    count: usize,
) -> c_int {
    edge::call(simulation, "moorline_get_outputs", |session| {
        // SAFETY: an array of `count` values.
        let values = unsafe { edge::slice_mut(values, count) }?;
        let references = session.references(Causality::Output);
        session.get(&references, values)
    })
}
