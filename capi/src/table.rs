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

/// Gives the number of variables; their references are 1 to this number.
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

/// Gives the reference of a variable by its name, such as `fairlead.x`.
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

/// Gives the name of a variable. `moorline_message` says how a text is given.
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

/// Gives the unit of a variable. `moorline_message` says how a text is given.
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

/// Gives the description of a variable in a sentence. `moorline_message` says how a text is given.
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

/// Gives the causality of a variable: MOORLINE_INPUT, MOORLINE_OUTPUT, MOORLINE_PARAMETER or MOORLINE_CALCULATED_PARAMETER.
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

/// Sets inputs, and parameters before start: all of them or, where one is refused, none. Displacements are from the reference positions [m, rad].
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

/// Gets variables. Results have values from start on.
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

/// Gives the derivatives of `count` outputs by an input, a displacement or a velocity, at the end of the last step. The scene asks for them with
/// `derivatives = true` in `[output]`.
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

/// Gives the rates of `count` outputs in time, per second, at the end of the last step. The scene asks for them with `derivatives = true` in
/// `[output]`.
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

/// Gives the number of inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_input_count(simulation: moorline_simulation, count: *mut usize) -> c_int {
    edge::call(simulation, "moorline_input_count", |session| {
        let value = session.references(Causality::Input).len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gives the number of outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moorline_output_count(simulation: moorline_simulation, count: *mut usize) -> c_int {
    edge::call(simulation, "moorline_output_count", |session| {
        let value = session.references(Causality::Output).len();
        // SAFETY: one value.
        unsafe { edge::put(count, value) }
    })
}

/// Gives the number of parameters.
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
