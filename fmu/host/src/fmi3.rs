//! C types of FMI 3.0, named as in the standard's `fmi3PlatformTypes.h` and `fmi3FunctionTypes.h`.
//!
//! Source: Functional Mock-up Interface 3.0.2, sections 2.2 and 2.3. Enumerations are plain integers here: a host
//! may pass any value, and an `enum` must not hold an unknown one.
#![allow(non_camel_case_types, non_snake_case, non_upper_case_globals)]

use std::ffi::{c_char, c_uint, c_void};

/// An FMU instance.
pub type fmi3Instance = *mut c_void;
/// Pointer of the host, passed back in every callback.
pub type fmi3InstanceEnvironment = *mut c_void;
/// A saved state.
pub type fmi3FMUState = *mut c_void;
/// Handle of a variable.
pub type fmi3ValueReference = u32;
/// Real value, single precision.
pub type fmi3Float32 = f32;
/// Real value, double precision.
pub type fmi3Float64 = f64;
/// Integer value.
pub type fmi3Int8 = i8;
/// Integer value.
pub type fmi3UInt8 = u8;
/// Integer value.
pub type fmi3Int16 = i16;
/// Integer value.
pub type fmi3UInt16 = u16;
/// Integer value.
pub type fmi3Int32 = i32;
/// Integer value.
pub type fmi3UInt32 = u32;
/// Integer value.
pub type fmi3Int64 = i64;
/// Integer value.
pub type fmi3UInt64 = u64;
/// Boolean value. A host may pass only 0 and 1 (section 2.2.4, C99 `bool`).
pub type fmi3Boolean = bool;
/// UTF-8 text that ends with a zero byte.
pub type fmi3String = *const c_char;
/// One byte of a serialised state.
pub type fmi3Byte = u8;
/// Binary value.
pub type fmi3Binary = *const fmi3Byte;
/// Clock value.
pub type fmi3Clock = bool;

/// Status returned by a call.
pub type fmi3Status = c_uint;
/// Done.
pub const fmi3OK: fmi3Status = 0;
/// Done, with a remark in the log.
pub const fmi3Warning: fmi3Status = 1;
/// Not done; another step size may succeed.
pub const fmi3Discard: fmi3Status = 2;
/// Refused or failed.
pub const fmi3Error: fmi3Status = 3;
/// The instance is unusable.
pub const fmi3Fatal: fmi3Status = 4;

/// Kind of a variable's dependency on another.
pub type fmi3DependencyKind = c_uint;
/// Qualifier of a clock's interval.
pub type fmi3IntervalQualifier = c_uint;

/// Host's log function.
pub type fmi3LogMessageCallback =
    Option<unsafe extern "C" fn(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String)>;
/// Notifies the host of a clock tick (scheduled execution).
pub type fmi3ClockUpdateCallback = Option<unsafe extern "C" fn(fmi3InstanceEnvironment)>;
/// Called between communication points.
pub type fmi3IntermediateUpdateCallback = Option<
    unsafe extern "C" fn(
        fmi3InstanceEnvironment,
        fmi3Float64,
        fmi3Boolean,
        fmi3Boolean,
        fmi3Boolean,
        fmi3Boolean,
        *mut fmi3Boolean,
        *mut fmi3Float64,
    ),
>;
/// Guards a critical section (scheduled execution).
pub type fmi3LockPreemptionCallback = Option<unsafe extern "C" fn()>;
/// Ends a critical section (scheduled execution).
pub type fmi3UnlockPreemptionCallback = Option<unsafe extern "C" fn()>;

/// Passes every function of FMI 3.0, with the name and signature of its type, to the given macro.
#[macro_export]
macro_rules! fmi3_functions {
    ($callback:ident) => {
        $callback! {
            fmi3GetVersion: fmi3GetVersionTYPE = fn() -> fmi3String;
            fmi3SetDebugLogging: fmi3SetDebugLoggingTYPE =
                fn(fmi3Instance, fmi3Boolean, usize, *const fmi3String) -> fmi3Status;
            fmi3InstantiateModelExchange: fmi3InstantiateModelExchangeTYPE =
                fn(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean, fmi3InstanceEnvironment,
                    fmi3LogMessageCallback) -> fmi3Instance;
            fmi3InstantiateCoSimulation: fmi3InstantiateCoSimulationTYPE =
                fn(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean, fmi3Boolean, fmi3Boolean,
                    *const fmi3ValueReference, usize, fmi3InstanceEnvironment, fmi3LogMessageCallback,
                    fmi3IntermediateUpdateCallback) -> fmi3Instance;
            fmi3InstantiateScheduledExecution: fmi3InstantiateScheduledExecutionTYPE =
                fn(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean, fmi3InstanceEnvironment,
                    fmi3LogMessageCallback, fmi3ClockUpdateCallback, fmi3LockPreemptionCallback,
                    fmi3UnlockPreemptionCallback) -> fmi3Instance;
            fmi3FreeInstance: fmi3FreeInstanceTYPE = fn(fmi3Instance) -> ();
            fmi3EnterInitializationMode: fmi3EnterInitializationModeTYPE =
                fn(fmi3Instance, fmi3Boolean, fmi3Float64, fmi3Float64, fmi3Boolean, fmi3Float64) -> fmi3Status;
            fmi3ExitInitializationMode: fmi3ExitInitializationModeTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3EnterEventMode: fmi3EnterEventModeTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3Terminate: fmi3TerminateTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3Reset: fmi3ResetTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3GetFloat32: fmi3GetFloat32TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Float32, usize) -> fmi3Status;
            fmi3GetFloat64: fmi3GetFloat64TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Float64, usize) -> fmi3Status;
            fmi3GetInt8: fmi3GetInt8TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Int8, usize) -> fmi3Status;
            fmi3GetUInt8: fmi3GetUInt8TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3UInt8, usize) -> fmi3Status;
            fmi3GetInt16: fmi3GetInt16TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Int16, usize) -> fmi3Status;
            fmi3GetUInt16: fmi3GetUInt16TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3UInt16, usize) -> fmi3Status;
            fmi3GetInt32: fmi3GetInt32TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Int32, usize) -> fmi3Status;
            fmi3GetUInt32: fmi3GetUInt32TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3UInt32, usize) -> fmi3Status;
            fmi3GetInt64: fmi3GetInt64TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Int64, usize) -> fmi3Status;
            fmi3GetUInt64: fmi3GetUInt64TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3UInt64, usize) -> fmi3Status;
            fmi3GetBoolean: fmi3GetBooleanTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Boolean, usize) -> fmi3Status;
            fmi3GetString: fmi3GetStringTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3String, usize) -> fmi3Status;
            fmi3GetBinary: fmi3GetBinaryTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut usize, *mut fmi3Binary, usize) -> fmi3Status;
            fmi3GetClock: fmi3GetClockTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Clock) -> fmi3Status;
            fmi3SetFloat32: fmi3SetFloat32TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Float32, usize) -> fmi3Status;
            fmi3SetFloat64: fmi3SetFloat64TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Float64, usize) -> fmi3Status;
            fmi3SetInt8: fmi3SetInt8TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Int8, usize) -> fmi3Status;
            fmi3SetUInt8: fmi3SetUInt8TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3UInt8, usize) -> fmi3Status;
            fmi3SetInt16: fmi3SetInt16TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Int16, usize) -> fmi3Status;
            fmi3SetUInt16: fmi3SetUInt16TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3UInt16, usize) -> fmi3Status;
            fmi3SetInt32: fmi3SetInt32TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Int32, usize) -> fmi3Status;
            fmi3SetUInt32: fmi3SetUInt32TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3UInt32, usize) -> fmi3Status;
            fmi3SetInt64: fmi3SetInt64TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Int64, usize) -> fmi3Status;
            fmi3SetUInt64: fmi3SetUInt64TYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3UInt64, usize) -> fmi3Status;
            fmi3SetBoolean: fmi3SetBooleanTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Boolean, usize) -> fmi3Status;
            fmi3SetString: fmi3SetStringTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3String, usize) -> fmi3Status;
            fmi3SetBinary: fmi3SetBinaryTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const usize, *const fmi3Binary,
                    usize) -> fmi3Status;
            fmi3SetClock: fmi3SetClockTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Clock) -> fmi3Status;
            fmi3GetNumberOfVariableDependencies: fmi3GetNumberOfVariableDependenciesTYPE =
                fn(fmi3Instance, fmi3ValueReference, *mut usize) -> fmi3Status;
            fmi3GetVariableDependencies: fmi3GetVariableDependenciesTYPE =
                fn(fmi3Instance, fmi3ValueReference, *mut usize, *mut fmi3ValueReference, *mut usize,
                    *mut fmi3DependencyKind, usize) -> fmi3Status;
            fmi3GetFMUState: fmi3GetFMUStateTYPE = fn(fmi3Instance, *mut fmi3FMUState) -> fmi3Status;
            fmi3SetFMUState: fmi3SetFMUStateTYPE = fn(fmi3Instance, fmi3FMUState) -> fmi3Status;
            fmi3FreeFMUState: fmi3FreeFMUStateTYPE = fn(fmi3Instance, *mut fmi3FMUState) -> fmi3Status;
            fmi3SerializedFMUStateSize: fmi3SerializedFMUStateSizeTYPE =
                fn(fmi3Instance, fmi3FMUState, *mut usize) -> fmi3Status;
            fmi3SerializeFMUState: fmi3SerializeFMUStateTYPE =
                fn(fmi3Instance, fmi3FMUState, *mut fmi3Byte, usize) -> fmi3Status;
            fmi3DeserializeFMUState: fmi3DeserializeFMUStateTYPE =
                fn(fmi3Instance, *const fmi3Byte, usize, *mut fmi3FMUState) -> fmi3Status;
            fmi3GetDirectionalDerivative: fmi3GetDirectionalDerivativeTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3ValueReference, usize,
                    *const fmi3Float64, usize, *mut fmi3Float64, usize) -> fmi3Status;
            fmi3GetAdjointDerivative: fmi3GetAdjointDerivativeTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3ValueReference, usize,
                    *const fmi3Float64, usize, *mut fmi3Float64, usize) -> fmi3Status;
            fmi3EnterConfigurationMode: fmi3EnterConfigurationModeTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3ExitConfigurationMode: fmi3ExitConfigurationModeTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3GetIntervalDecimal: fmi3GetIntervalDecimalTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Float64,
                    *mut fmi3IntervalQualifier) -> fmi3Status;
            fmi3GetIntervalFraction: fmi3GetIntervalFractionTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3UInt64, *mut fmi3UInt64,
                    *mut fmi3IntervalQualifier) -> fmi3Status;
            fmi3GetShiftDecimal: fmi3GetShiftDecimalTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3Float64) -> fmi3Status;
            fmi3GetShiftFraction: fmi3GetShiftFractionTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *mut fmi3UInt64, *mut fmi3UInt64) -> fmi3Status;
            fmi3SetIntervalDecimal: fmi3SetIntervalDecimalTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Float64) -> fmi3Status;
            fmi3SetIntervalFraction: fmi3SetIntervalFractionTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3UInt64,
                    *const fmi3UInt64) -> fmi3Status;
            fmi3SetShiftDecimal: fmi3SetShiftDecimalTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Float64) -> fmi3Status;
            fmi3SetShiftFraction: fmi3SetShiftFractionTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3UInt64,
                    *const fmi3UInt64) -> fmi3Status;
            fmi3EvaluateDiscreteStates: fmi3EvaluateDiscreteStatesTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3UpdateDiscreteStates: fmi3UpdateDiscreteStatesTYPE =
                fn(fmi3Instance, *mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean,
                    *mut fmi3Boolean, *mut fmi3Float64) -> fmi3Status;
            fmi3EnterContinuousTimeMode: fmi3EnterContinuousTimeModeTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3CompletedIntegratorStep: fmi3CompletedIntegratorStepTYPE =
                fn(fmi3Instance, fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean) -> fmi3Status;
            fmi3SetTime: fmi3SetTimeTYPE = fn(fmi3Instance, fmi3Float64) -> fmi3Status;
            fmi3SetContinuousStates: fmi3SetContinuousStatesTYPE =
                fn(fmi3Instance, *const fmi3Float64, usize) -> fmi3Status;
            fmi3GetContinuousStateDerivatives: fmi3GetContinuousStateDerivativesTYPE =
                fn(fmi3Instance, *mut fmi3Float64, usize) -> fmi3Status;
            fmi3GetEventIndicators: fmi3GetEventIndicatorsTYPE =
                fn(fmi3Instance, *mut fmi3Float64, usize) -> fmi3Status;
            fmi3GetContinuousStates: fmi3GetContinuousStatesTYPE =
                fn(fmi3Instance, *mut fmi3Float64, usize) -> fmi3Status;
            fmi3GetNominalsOfContinuousStates: fmi3GetNominalsOfContinuousStatesTYPE =
                fn(fmi3Instance, *mut fmi3Float64, usize) -> fmi3Status;
            fmi3GetNumberOfEventIndicators: fmi3GetNumberOfEventIndicatorsTYPE =
                fn(fmi3Instance, *mut usize) -> fmi3Status;
            fmi3GetNumberOfContinuousStates: fmi3GetNumberOfContinuousStatesTYPE =
                fn(fmi3Instance, *mut usize) -> fmi3Status;
            fmi3EnterStepMode: fmi3EnterStepModeTYPE = fn(fmi3Instance) -> fmi3Status;
            fmi3GetOutputDerivatives: fmi3GetOutputDerivativesTYPE =
                fn(fmi3Instance, *const fmi3ValueReference, usize, *const fmi3Int32, *mut fmi3Float64,
                    usize) -> fmi3Status;
            fmi3DoStep: fmi3DoStepTYPE =
                fn(fmi3Instance, fmi3Float64, fmi3Float64, fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean,
                    *mut fmi3Boolean, *mut fmi3Float64) -> fmi3Status;
            fmi3ActivateModelPartition: fmi3ActivateModelPartitionTYPE =
                fn(fmi3Instance, fmi3ValueReference, fmi3Float64) -> fmi3Status;
        }
    };
}

fmi3_functions!(function_table);
