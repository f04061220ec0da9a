//! FMI 3.0: each function of the standard translates one call.
//!
//! Safety of every function here: the host keeps the promises listed in [`crate::ffi`]; nothing else is relied on.
#![allow(non_snake_case, clippy::too_many_arguments)]

use moorline::interface::Kind;
use moorline_host::fmi3::*;
use moorline_host::{FmiVersion, Status, fmi3_functions};

use crate::ffi::{self, Sink, Update};
use crate::instance::{Instance, Parts, Refusal};
use crate::symbols::{assert_complete, no_variables, refuse, transitions};

const VERSION: FmiVersion = FmiVersion::Three;

fmi3_functions!(assert_complete);

refuse! {
    "this FMU offers co-simulation, not model exchange";
    fmi3EnterContinuousTimeMode();
    fmi3CompletedIntegratorStep(fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean);
    fmi3SetTime(fmi3Float64);
    fmi3SetContinuousStates(*const fmi3Float64, usize);
    fmi3GetContinuousStateDerivatives(*mut fmi3Float64, usize);
    fmi3GetEventIndicators(*mut fmi3Float64, usize);
    fmi3GetContinuousStates(*mut fmi3Float64, usize);
    fmi3GetNominalsOfContinuousStates(*mut fmi3Float64, usize);
    fmi3GetNumberOfEventIndicators(*mut usize);
    fmi3GetNumberOfContinuousStates(*mut usize);
}

refuse! {
    "this FMU has no event mode";
    fmi3EnterEventMode();
    fmi3EnterStepMode();
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(
        *mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Float64
    );
}

refuse! {
    "this FMU has no structural parameters";
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
}

refuse! {
    "this FMU has no clocks";
    fmi3GetIntervalDecimal(*const fmi3ValueReference, usize, *mut fmi3Float64, *mut fmi3IntervalQualifier);
    fmi3GetIntervalFraction(
        *const fmi3ValueReference, usize, *mut fmi3UInt64, *mut fmi3UInt64, *mut fmi3IntervalQualifier
    );
    fmi3GetShiftDecimal(*const fmi3ValueReference, usize, *mut fmi3Float64);
    fmi3GetShiftFraction(*const fmi3ValueReference, usize, *mut fmi3UInt64, *mut fmi3UInt64);
    fmi3SetIntervalDecimal(*const fmi3ValueReference, usize, *const fmi3Float64);
    fmi3SetIntervalFraction(*const fmi3ValueReference, usize, *const fmi3UInt64, *const fmi3UInt64);
    fmi3SetShiftDecimal(*const fmi3ValueReference, usize, *const fmi3Float64);
    fmi3SetShiftFraction(*const fmi3ValueReference, usize, *const fmi3UInt64, *const fmi3UInt64);
    fmi3ActivateModelPartition(fmi3ValueReference, fmi3Float64);
}

refuse! {
    "this FMU tells dependencies in its description only";
    fmi3GetNumberOfVariableDependencies(fmi3ValueReference, *mut usize);
    fmi3GetVariableDependencies(
        fmi3ValueReference, *mut usize, *mut fmi3ValueReference, *mut usize, *mut fmi3DependencyKind, usize
    );
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetVersion() -> fmi3String {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateModelExchange(
    _instanceName: fmi3String,
    _instantiationToken: fmi3String,
    _resourcePath: fmi3String,
    _visible: fmi3Boolean,
    _loggingOn: fmi3Boolean,
    instanceEnvironment: fmi3InstanceEnvironment,
    logMessage: fmi3LogMessageCallback,
) -> fmi3Instance {
    refuse_kind("model exchange", instanceEnvironment, logMessage)
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _instanceName: fmi3String,
    _instantiationToken: fmi3String,
    _resourcePath: fmi3String,
    _visible: fmi3Boolean,
    _loggingOn: fmi3Boolean,
    instanceEnvironment: fmi3InstanceEnvironment,
    logMessage: fmi3LogMessageCallback,
    _clockUpdate: fmi3ClockUpdateCallback,
    _lockPreemption: fmi3LockPreemptionCallback,
    _unlockPreemption: fmi3UnlockPreemptionCallback,
) -> fmi3Instance {
    refuse_kind("scheduled execution", instanceEnvironment, logMessage)
}

fn refuse_kind(
    kind: &str,
    environment: fmi3InstanceEnvironment,
    logger: fmi3LogMessageCallback,
) -> fmi3Instance {
    let sink = Sink::Three { logger, environment };
    ffi::instantiate(VERSION, sink, None, || {
        Err(Refusal(format!("this FMU offers co-simulation, not {kind}")))
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _instanceName: fmi3String,
    instantiationToken: fmi3String,
    resourcePath: fmi3String,
    _visible: fmi3Boolean,
    loggingOn: fmi3Boolean,
    eventModeUsed: fmi3Boolean,
    earlyReturnAllowed: fmi3Boolean,
    requiredIntermediateVariables: *const fmi3ValueReference,
    nRequiredIntermediateVariables: usize,
    instanceEnvironment: fmi3InstanceEnvironment,
    logMessage: fmi3LogMessageCallback,
    intermediateUpdate: fmi3IntermediateUpdateCallback,
) -> fmi3Instance {
    let sink = Sink::Three {
        logger: logMessage,
        environment: instanceEnvironment,
    };
    let update = intermediateUpdate.map(|callback| Update {
        callback: Some(callback),
        environment: instanceEnvironment,
        may_end: earlyReturnAllowed,
    });
    // SAFETY: the host's texts and array.
    ffi::instantiate(VERSION, sink, update, || unsafe {
        if eventModeUsed {
            return Err("fmi3InstantiateCoSimulation: this FMU has no event mode".into());
        }
        let announced = ffi::slice(requiredIntermediateVariables, nRequiredIntermediateVariables)?;
        let (token, resources) = (ffi::text(instantiationToken), ffi::location(resourcePath));
        let mut instance = Instance::new(VERSION, token, resources, loggingOn)
            .map_err(|Refusal(why)| Refusal(format!("fmi3InstantiateCoSimulation: {why}")))?;
        if update.is_some() {
            instance.announce(announced);
        }
        Ok(instance)
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeInstance(instance: fmi3Instance) {
    // SAFETY: the host's handle, not used again.
    unsafe { ffi::free(instance) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetDebugLogging(
    instance: fmi3Instance,
    loggingOn: fmi3Boolean,
    nCategories: usize,
    categories: *const fmi3String,
) -> fmi3Status {
    // SAFETY: the host's handle and texts.
    unsafe {
        ffi::call(instance, VERSION, "fmi3SetDebugLogging", |instance| {
            instance.set_debug_logging(loggingOn, &ffi::texts(categories, nCategories)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: fmi3Instance,
    toleranceDefined: fmi3Boolean,
    tolerance: fmi3Float64,
    startTime: fmi3Float64,
    stopTimeDefined: fmi3Boolean,
    stopTime: fmi3Float64,
) -> fmi3Status {
    // SAFETY: the host's handle.
    unsafe {
        ffi::call(instance, VERSION, "fmi3EnterInitializationMode", |instance| {
            instance.set_up(
                toleranceDefined.then_some(tolerance),
                startTime,
                stopTimeDefined.then_some(stopTime),
            )?;
            instance.enter_initialization()
        })
    }
}

transitions! {
    fmi3ExitInitializationMode: exit_initialization;
    fmi3Terminate: terminate;
    fmi3Reset: reset;
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFloat64(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    values: *mut fmi3Float64,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(instance, VERSION, "fmi3GetFloat64", |instance| {
            instance.get(
                Kind::Float64,
                ffi::slice(valueReferences, nValueReferences)?,
                ffi::slice_mut(values, nValues)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetDirectionalDerivative(
    instance: fmi3Instance,
    unknowns: *const fmi3ValueReference,
    nUnknowns: usize,
    knowns: *const fmi3ValueReference,
    nKnowns: usize,
    seed: *const fmi3Float64,
    nSeed: usize,
    sensitivity: *mut fmi3Float64,
    nSensitivity: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(instance, VERSION, "fmi3GetDirectionalDerivative", |instance| {
            instance.directional_derivative(
                ffi::slice(unknowns, nUnknowns)?,
                ffi::slice(knowns, nKnowns)?,
                ffi::slice(seed, nSeed)?,
                ffi::slice_mut(sensitivity, nSensitivity)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetAdjointDerivative(
    instance: fmi3Instance,
    unknowns: *const fmi3ValueReference,
    nUnknowns: usize,
    knowns: *const fmi3ValueReference,
    nKnowns: usize,
    seed: *const fmi3Float64,
    nSeed: usize,
    sensitivity: *mut fmi3Float64,
    nSensitivity: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(instance, VERSION, "fmi3GetAdjointDerivative", |instance| {
            instance.adjoint_derivative(
                ffi::slice(unknowns, nUnknowns)?,
                ffi::slice(knowns, nKnowns)?,
                ffi::slice(seed, nSeed)?,
                ffi::slice_mut(sensitivity, nSensitivity)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetOutputDerivatives(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    orders: *const fmi3Int32,
    values: *mut fmi3Float64,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(instance, VERSION, "fmi3GetOutputDerivatives", |instance| {
            instance.output_derivatives(
                ffi::slice(valueReferences, nValueReferences)?,
                ffi::slice(orders, nValueReferences)?,
                ffi::slice_mut(values, nValues)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFloat64(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    values: *const fmi3Float64,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(instance, VERSION, "fmi3SetFloat64", |instance| {
            instance.set(
                Kind::Float64,
                ffi::slice(valueReferences, nValueReferences)?,
                ffi::slice(values, nValues)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetInt32(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    values: *mut fmi3Int32,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(instance, VERSION, "fmi3GetInt32", |instance| {
            let references = ffi::slice(valueReferences, nValueReferences)?;
            let values = ffi::slice_mut(values, nValues)?;
            instance.get_as(Kind::Int32, references, values, |number| number as i32)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetInt32(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    values: *const fmi3Int32,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(instance, VERSION, "fmi3SetInt32", |instance| {
            let references = ffi::slice(valueReferences, nValueReferences)?;
            let numbers = ffi::slice(values, nValues)?.iter().map(|value| f64::from(*value));
            instance.set_from(Kind::Int32, references, numbers)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetBoolean(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    values: *mut fmi3Boolean,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays.
    unsafe {
        ffi::call(instance, VERSION, "fmi3GetBoolean", |instance| {
            let references = ffi::slice(valueReferences, nValueReferences)?;
            let bytes = ffi::slice_mut(values.cast::<u8>(), nValues)?;
            instance.get_as(Kind::Boolean, references, bytes, |number| u8::from(number != 0.0))
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetBoolean(
    instance: fmi3Instance,
    valueReferences: *const fmi3ValueReference,
    nValueReferences: usize,
    values: *const fmi3Boolean,
    nValues: usize,
) -> fmi3Status {
    // SAFETY: the host's handle and arrays; as bytes, of which any value may be read.
    unsafe {
        ffi::call(instance, VERSION, "fmi3SetBoolean", |instance| {
            let references = ffi::slice(valueReferences, nValueReferences)?;
            let bytes = ffi::slice(values.cast::<u8>(), nValues)?;
            let numbers = bytes.iter().map(|byte| f64::from(u8::from(*byte != 0)));
            instance.set_from(Kind::Boolean, references, numbers)
        })
    }
}

no_variables! {
    fmi3GetFloat32(*mut fmi3Float32, usize): "Float32";
    fmi3GetInt8(*mut fmi3Int8, usize): "Int8";
    fmi3GetUInt8(*mut fmi3UInt8, usize): "UInt8";
    fmi3GetInt16(*mut fmi3Int16, usize): "Int16";
    fmi3GetUInt16(*mut fmi3UInt16, usize): "UInt16";
    fmi3GetUInt32(*mut fmi3UInt32, usize): "UInt32";
    fmi3GetInt64(*mut fmi3Int64, usize): "Int64";
    fmi3GetUInt64(*mut fmi3UInt64, usize): "UInt64";
    fmi3GetString(*mut fmi3String, usize): "String";
    fmi3GetBinary(*mut usize, *mut fmi3Binary, usize): "Binary";
    fmi3GetClock(*mut fmi3Clock): "Clock";
    fmi3SetFloat32(*const fmi3Float32, usize): "Float32";
    fmi3SetInt8(*const fmi3Int8, usize): "Int8";
    fmi3SetUInt8(*const fmi3UInt8, usize): "UInt8";
    fmi3SetInt16(*const fmi3Int16, usize): "Int16";
    fmi3SetUInt16(*const fmi3UInt16, usize): "UInt16";
    fmi3SetUInt32(*const fmi3UInt32, usize): "UInt32";
    fmi3SetInt64(*const fmi3Int64, usize): "Int64";
    fmi3SetUInt64(*const fmi3UInt64, usize): "UInt64";
    fmi3SetString(*const fmi3String, usize): "String";
    fmi3SetBinary(*const usize, *const fmi3Binary, usize): "Binary";
    fmi3SetClock(*const fmi3Clock): "Clock";
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFMUState(instance: fmi3Instance, FMUState: *mut fmi3FMUState) -> fmi3Status {
    // SAFETY: the host's handle and state.
    unsafe {
        ffi::call(instance, VERSION, "fmi3GetFMUState", |instance| {
            instance.expect_no_update()?;
            ffi::store_state(FMUState, instance.snapshot())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFMUState(instance: fmi3Instance, FMUState: fmi3FMUState) -> fmi3Status {
    // SAFETY: the host's handle and state.
    unsafe {
        ffi::call(instance, VERSION, "fmi3SetFMUState", |instance| {
            instance.restore(ffi::state(FMUState)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeFMUState(instance: fmi3Instance, FMUState: *mut fmi3FMUState) -> fmi3Status {
    // SAFETY: the host's handle and state.
    unsafe {
        ffi::call(instance, VERSION, "fmi3FreeFMUState", |_| {
            ffi::free_state(FMUState)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: fmi3Instance,
    FMUState: fmi3FMUState,
    size: *mut usize,
) -> fmi3Status {
    // SAFETY: the host's handle, state and result.
    unsafe {
        ffi::call(instance, VERSION, "fmi3SerializedFMUStateSize", |instance| {
            ffi::write(size, instance.serialize(ffi::state(FMUState)?).len())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializeFMUState(
    instance: fmi3Instance,
    FMUState: fmi3FMUState,
    serializedState: *mut fmi3Byte,
    size: usize,
) -> fmi3Status {
    // SAFETY: the host's handle, state and array.
    unsafe {
        ffi::call(instance, VERSION, "fmi3SerializeFMUState", |instance| {
            let bytes = instance.serialize(ffi::state(FMUState)?);
            ffi::copy_state(&bytes, ffi::slice_mut(serializedState, size)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: fmi3Instance,
    serializedState: *const fmi3Byte,
    size: usize,
    FMUState: *mut fmi3FMUState,
) -> fmi3Status {
    // SAFETY: the host's handle, array and state.
    unsafe {
        ffi::call(instance, VERSION, "fmi3DeserializeFMUState", |instance| {
            let bytes = ffi::slice(serializedState, size)?;
            ffi::store_state(FMUState, instance.deserialize(bytes)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: fmi3Instance,
    currentCommunicationPoint: fmi3Float64,
    communicationStepSize: fmi3Float64,
    _noSetFMUStatePriorToCurrentPoint: fmi3Boolean,
    eventHandlingNeeded: *mut fmi3Boolean,
    terminateSimulation: *mut fmi3Boolean,
    earlyReturn: *mut fmi3Boolean,
    lastSuccessfulTime: *mut fmi3Float64,
) -> fmi3Status {
    let mut parts = None;
    // SAFETY: the host's handle and results. No call borrows the instance while the host is called between parts.
    unsafe {
        loop {
            let status = ffi::call(instance, VERSION, "fmi3DoStep", |instance| {
                ffi::write(eventHandlingNeeded, false)?;
                ffi::write(terminateSimulation, false)?;
                ffi::write(earlyReturn, false)?;
                ffi::write(lastSuccessfulTime, instance.time())?;
                if parts.is_none() {
                    parts = Some(instance.divide(currentCommunicationPoint, communicationStepSize)?);
                }
                let made = parts.as_mut().map_or(Ok(()), |parts| instance.make_part(parts));
                ffi::write(lastSuccessfulTime, instance.time())?;
                made
            });
            if status != Status::Ok as u32 || parts.as_ref().is_none_or(Parts::are_done) {
                return status;
            }
            if ffi::update(instance, *lastSuccessfulTime) {
                return ffi::call(instance, VERSION, "fmi3DoStep", |instance| {
                    instance.end_early()?;
                    ffi::write(earlyReturn, true)
                });
            }
        }
    }
}
