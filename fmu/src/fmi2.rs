//! FMI 2.0: each function of the standard translates one call.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::ffi`]; nothing else is relied on.
#![allow(non_snake_case, non_upper_case_globals, clippy::too_many_arguments)]

use std::ffi::c_char;
use std::ptr;

use moorline::interface::Kind;
use moorline_host::fmi2::*;
use moorline_host::{FmiVersion, fmi2_functions};

use crate::ffi::{self, Sink};
use crate::instance::{Instance, Refusal};
use crate::symbols::{assert_complete, no_variables, refuse, transitions};

const VERSION: FmiVersion = FmiVersion::Two;

fmi2_functions!(assert_complete);

refuse! {
    "this FMU offers co-simulation, not model exchange";
    fmi2EnterEventMode();
    fmi2NewDiscreteStates(*mut fmi2EventInfo);
    fmi2EnterContinuousTimeMode();
    fmi2CompletedIntegratorStep(fmi2Boolean, *mut fmi2Boolean, *mut fmi2Boolean);
    fmi2SetTime(fmi2Real);
    fmi2SetContinuousStates(*const fmi2Real, usize);
    fmi2GetDerivatives(*mut fmi2Real, usize);
    fmi2GetEventIndicators(*mut fmi2Real, usize);
    fmi2GetContinuousStates(*mut fmi2Real, usize);
    fmi2GetNominalsOfContinuousStates(*mut fmi2Real, usize);
}

refuse! {
    "no step is ever pending: steps are carried out in the call";
    fmi2CancelStep();
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetTypesPlatform() -> fmi2String {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetVersion() -> fmi2String {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Instantiate(
    instanceName: fmi2String,
    fmuType: fmi2Type,
    fmuGUID: fmi2String,
    fmuResourceLocation: fmi2String,
    functions: *const fmi2CallbackFunctions,
    _visible: fmi2Boolean,
    loggingOn: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: the host's callbacks and texts.
    unsafe {
        let sink = Sink::two(functions, instanceName);
        ffi::instantiate(VERSION, sink, None, || {
            if fmuType != fmi2CoSimulation {
                return Err("fmi2Instantiate: this FMU offers co-simulation, not model exchange".into());
            }
            Instance::new(
                VERSION,
                ffi::text(fmuGUID),
                ffi::location(fmuResourceLocation),
                loggingOn != 0,
            )
            .map_err(|Refusal(why)| Refusal(format!("fmi2Instantiate: {why}")))
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
    // SAFETY: the host's handle, not used again.
    unsafe { ffi::free(c) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetDebugLogging(
    c: fmi2Component,
    loggingOn: fmi2Boolean,
    nCategories: usize,
    categories: *const fmi2String,
) -> fmi2Status {
    // SAFETY: the host's handle and texts.
    unsafe {
        ffi::call(c, VERSION, "fmi2SetDebugLogging", |instance| {
            instance.set_debug_logging(loggingOn != 0, &ffi::texts(categories, nCategories)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetupExperiment(
    c: fmi2Component,
    toleranceDefined: fmi2Boolean,
    tolerance: fmi2Real,
    startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean,
    stopTime: fmi2Real,
) -> fmi2Status {
    // SAFETY: the host's handle.
    unsafe {
        ffi::call(c, VERSION, "fmi2SetupExperiment", |instance| {
            instance.set_up(
                (toleranceDefined != 0).then_some(tolerance),
                startTime,
                (stopTimeDefined != 0).then_some(stopTime),
            )
        })
    }
}

transitions! {
    fmi2EnterInitializationMode: enter_initialization;
    fmi2ExitInitializationMode: exit_initialization;
    fmi2Terminate: terminate;
    fmi2Reset: reset;
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetReal", |instance| {
            instance.get(Kind::Float64, ffi::slice(vr, nvr)?, ffi::slice_mut(value, nvr)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: fmi2Component,
    vUnknown_ref: *const fmi2ValueReference,
    nUnknown: usize,
    vKnown_ref: *const fmi2ValueReference,
    nKnown: usize,
    dvKnown: *const fmi2Real,
    dvUnknown: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetDirectionalDerivative", |instance| {
            instance.directional_derivative(
                ffi::slice(vUnknown_ref, nUnknown)?,
                ffi::slice(vKnown_ref, nKnown)?,
                ffi::slice(dvKnown, nKnown)?,
                ffi::slice_mut(dvUnknown, nUnknown)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetRealOutputDerivatives", |instance| {
            instance.output_derivatives(
                ffi::slice(vr, nvr)?,
                ffi::slice(order, nvr)?,
                ffi::slice_mut(value, nvr)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2SetReal", |instance| {
            instance.set(Kind::Float64, ffi::slice(vr, nvr)?, ffi::slice(value, nvr)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetInteger", |instance| {
            let values = ffi::slice_mut(value, nvr)?;
            instance.get_as(Kind::Int32, ffi::slice(vr, nvr)?, values, |number| number as i32)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Integer,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2SetInteger", |instance| {
            let numbers = ffi::slice(value, nvr)?.iter().map(|value| f64::from(*value));
            instance.set_from(Kind::Int32, ffi::slice(vr, nvr)?, numbers)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetBoolean", |instance| {
            let values = ffi::slice_mut(value, nvr)?;
            let made = |number| fmi2Boolean::from(number != 0.0);
            instance.get_as(Kind::Boolean, ffi::slice(vr, nvr)?, values, made)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Boolean,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2SetBoolean", |instance| {
            let numbers = ffi::slice(value, nvr)?
                .iter()
                .map(|value| f64::from(u8::from(*value != 0)));
            instance.set_from(Kind::Boolean, ffi::slice(vr, nvr)?, numbers)
        })
    }
}

no_variables! {
    fmi2GetString(*mut fmi2String): "String";
    fmi2SetString(*const fmi2String): "String";
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: the host's handle and state.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetFMUstate", |instance| {
            ffi::store_state(FMUstate, instance.snapshot())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status {
    // SAFETY: the host's handle and state.
    unsafe {
        ffi::call(c, VERSION, "fmi2SetFMUstate", |instance| {
            instance.restore(ffi::state(FMUstate)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeFMUstate(c: fmi2Component, FMUstate: *mut fmi2FMUstate) -> fmi2Status {
    // SAFETY: the host's handle and state.
    unsafe { ffi::call(c, VERSION, "fmi2FreeFMUstate", |_| ffi::free_state(FMUstate)) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    size: *mut usize,
) -> fmi2Status {
    // SAFETY: the host's handle, state and result.
    unsafe {
        ffi::call(c, VERSION, "fmi2SerializedFMUstateSize", |instance| {
            ffi::write(size, instance.serialize(ffi::state(FMUstate)?).len())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    serializedState: *mut fmi2Byte,
    size: usize,
) -> fmi2Status {
    // SAFETY: the host's handle, state and array.
    unsafe {
        ffi::call(c, VERSION, "fmi2SerializeFMUstate", |instance| {
            let bytes = instance.serialize(ffi::state(FMUstate)?);
            ffi::copy_state(&bytes, ffi::slice_mut(serializedState.cast::<u8>(), size)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    serializedState: *const fmi2Byte,
    size: usize,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the host's handle, array and state.
    unsafe {
        ffi::call(c, VERSION, "fmi2DeSerializeFMUstate", |instance| {
            let bytes = ffi::slice(serializedState.cast::<u8>(), size)?;
            ffi::store_state(FMUstate, instance.deserialize(bytes)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    order: *const fmi2Integer,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(c, VERSION, "fmi2SetRealInputDerivatives", |instance| {
            instance.set_input_derivatives(
                ffi::slice(vr, nvr)?,
                ffi::slice(order, nvr)?,
                ffi::slice(value, nvr)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2DoStep(
    c: fmi2Component,
    currentCommunicationPoint: fmi2Real,
    communicationStepSize: fmi2Real,
    _noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
) -> fmi2Status {
    // SAFETY: the host's handle.
    unsafe {
        ffi::call(c, VERSION, "fmi2DoStep", |instance| {
            instance.do_step(currentCommunicationPoint, communicationStepSize)
        })
    }
}

/// Returns the status of the last step. Steps are synchronous, so the last one is complete when the host queries it.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Status,
) -> fmi2Status {
    // SAFETY: the host's handle and result.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetStatus", |instance| match s {
            fmi2DoStepStatus => ffi::write(value, instance.step_status() as fmi2Status),
            _ => Err(no_status(s, "status")),
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the host's handle and result.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetRealStatus", |instance| match s {
            fmi2LastSuccessfulTime => ffi::write(value, instance.time()),
            _ => Err(no_status(s, "real")),
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetIntegerStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: the host's handle.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetIntegerStatus", |_| {
            Err(no_status(s, "integer"))
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBooleanStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    // SAFETY: the host's handle and result.
    unsafe {
        ffi::call(c, VERSION, "fmi2GetBooleanStatus", |_| match s {
            fmi2Terminated => ffi::write(value, 0),
            _ => Err(no_status(s, "Boolean")),
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetStringStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: the host's handle and result; the handle is not in use before or after the inner call.
    unsafe {
        let text: *const c_char = if s == fmi2PendingStatus {
            ffi::keep_text(c, "no step is pending")
        } else {
            ptr::null()
        };
        ffi::call(c, VERSION, "fmi2GetStringStatus", |_| match s {
            fmi2PendingStatus => ffi::write(value, text),
            _ => Err(no_status(s, "string")),
        })
    }
}

fn no_status(kind: fmi2StatusKind, kind_of_value: &str) -> Refusal {
    Refusal(format!("there is no {kind_of_value} status of kind {kind}"))
}
