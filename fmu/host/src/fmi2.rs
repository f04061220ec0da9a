//! C types of FMI 2.0, named as in the standard's `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h`.
//!
//! Source: Functional Mock-up Interface for Model Exchange and Co-Simulation 2.0.4, sections 2.1, 3.2 and 4.2.
//! Enumerations are plain integers here: a host may pass any value, and an `enum` must not hold an unknown one.
#![allow(non_camel_case_types, non_snake_case, non_upper_case_globals)]

use std::ffi::{c_char, c_int, c_uint, c_void};

/// An FMU instance.
pub type fmi2Component = *mut c_void;
/// Pointer of the host, passed back in every callback.
pub type fmi2ComponentEnvironment = *mut c_void;
/// A saved state.
pub type fmi2FMUstate = *mut c_void;
/// Handle of a variable.
pub type fmi2ValueReference = c_uint;
/// Real value.
pub type fmi2Real = f64;
/// Integer value.
pub type fmi2Integer = c_int;
/// Boolean value, 0 or 1.
pub type fmi2Boolean = c_int;
/// UTF-8 text that ends with a zero byte.
pub type fmi2String = *const c_char;
/// One byte of a serialised state.
pub type fmi2Byte = c_char;

/// Status returned by a call.
pub type fmi2Status = c_uint;
/// Done.
pub const fmi2OK: fmi2Status = 0;
/// Done, with a remark in the log.
pub const fmi2Warning: fmi2Status = 1;
/// Not done; another step size may succeed.
pub const fmi2Discard: fmi2Status = 2;
/// Refused or failed.
pub const fmi2Error: fmi2Status = 3;
/// The instance is unusable.
pub const fmi2Fatal: fmi2Status = 4;
/// Not finished yet (asynchronous steps only).
pub const fmi2Pending: fmi2Status = 5;

/// Kind of an instance.
pub type fmi2Type = c_uint;
/// The host integrates.
pub const fmi2ModelExchange: fmi2Type = 0;
/// The FMU integrates.
pub const fmi2CoSimulation: fmi2Type = 1;

/// Kind of status requested by `fmi2Get…Status`.
pub type fmi2StatusKind = c_uint;
/// Status of the last step.
pub const fmi2DoStepStatus: fmi2StatusKind = 0;
/// Text on a pending step.
pub const fmi2PendingStatus: fmi2StatusKind = 1;
/// Time that the last successful step reached [s].
pub const fmi2LastSuccessfulTime: fmi2StatusKind = 2;
/// Whether the FMU has requested the end of the simulation.
pub const fmi2Terminated: fmi2StatusKind = 3;

/// Host's log function; `printf` format and arguments.
pub type fmi2CallbackLogger = Option<
    unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...),
>;
/// Host's `calloc`.
pub type fmi2CallbackAllocateMemory = Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>;
/// Host's `free`.
pub type fmi2CallbackFreeMemory = Option<unsafe extern "C" fn(*mut c_void)>;
/// Called at the end of an asynchronous step.
pub type fmi2StepFinished = Option<unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2Status)>;

/// The host's callbacks.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct fmi2CallbackFunctions {
    /// Log function, may be null.
    pub logger: fmi2CallbackLogger,
    /// Memory allocation.
    pub allocateMemory: fmi2CallbackAllocateMemory,
    /// Memory release.
    pub freeMemory: fmi2CallbackFreeMemory,
    /// End of an asynchronous step.
    pub stepFinished: fmi2StepFinished,
    /// Pointer passed back in the callbacks.
    pub componentEnvironment: fmi2ComponentEnvironment,
}

/// Event information (model exchange).
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct fmi2EventInfo {
    /// Another event iteration is needed.
    pub newDiscreteStatesNeeded: fmi2Boolean,
    /// The FMU requests the end of the simulation.
    pub terminateSimulation: fmi2Boolean,
    /// Nominal values changed.
    pub nominalsOfContinuousStatesChanged: fmi2Boolean,
    /// State values changed.
    pub valuesOfContinuousStatesChanged: fmi2Boolean,
    /// `nextEventTime` is set.
    pub nextEventTimeDefined: fmi2Boolean,
    /// Time of the next event [s].
    pub nextEventTime: fmi2Real,
}

/// Passes every function of FMI 2.0, with the name and signature of its type, to the given macro.
#[macro_export]
macro_rules! fmi2_functions {
    ($callback:ident) => {
        $callback! {
            fmi2GetTypesPlatform: fmi2GetTypesPlatformTYPE = fn() -> fmi2String;
            fmi2GetVersion: fmi2GetVersionTYPE = fn() -> fmi2String;
            fmi2SetDebugLogging: fmi2SetDebugLoggingTYPE =
                fn(fmi2Component, fmi2Boolean, usize, *const fmi2String) -> fmi2Status;
            fmi2Instantiate: fmi2InstantiateTYPE =
                fn(fmi2String, fmi2Type, fmi2String, fmi2String, *const fmi2CallbackFunctions, fmi2Boolean, fmi2Boolean)
                    -> fmi2Component;
            fmi2FreeInstance: fmi2FreeInstanceTYPE = fn(fmi2Component) -> ();
            fmi2SetupExperiment: fmi2SetupExperimentTYPE =
                fn(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real) -> fmi2Status;
            fmi2EnterInitializationMode: fmi2EnterInitializationModeTYPE = fn(fmi2Component) -> fmi2Status;
            fmi2ExitInitializationMode: fmi2ExitInitializationModeTYPE = fn(fmi2Component) -> fmi2Status;
            fmi2Terminate: fmi2TerminateTYPE = fn(fmi2Component) -> fmi2Status;
            fmi2Reset: fmi2ResetTYPE = fn(fmi2Component) -> fmi2Status;
            fmi2GetReal: fmi2GetRealTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *mut fmi2Real) -> fmi2Status;
            fmi2GetInteger: fmi2GetIntegerTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *mut fmi2Integer) -> fmi2Status;
            fmi2GetBoolean: fmi2GetBooleanTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *mut fmi2Boolean) -> fmi2Status;
            fmi2GetString: fmi2GetStringTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *mut fmi2String) -> fmi2Status;
            fmi2SetReal: fmi2SetRealTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *const fmi2Real) -> fmi2Status;
            fmi2SetInteger: fmi2SetIntegerTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *const fmi2Integer) -> fmi2Status;
            fmi2SetBoolean: fmi2SetBooleanTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *const fmi2Boolean) -> fmi2Status;
            fmi2SetString: fmi2SetStringTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *const fmi2String) -> fmi2Status;
            fmi2GetFMUstate: fmi2GetFMUstateTYPE = fn(fmi2Component, *mut fmi2FMUstate) -> fmi2Status;
            fmi2SetFMUstate: fmi2SetFMUstateTYPE = fn(fmi2Component, fmi2FMUstate) -> fmi2Status;
            fmi2FreeFMUstate: fmi2FreeFMUstateTYPE = fn(fmi2Component, *mut fmi2FMUstate) -> fmi2Status;
            fmi2SerializedFMUstateSize: fmi2SerializedFMUstateSizeTYPE =
                fn(fmi2Component, fmi2FMUstate, *mut usize) -> fmi2Status;
            fmi2SerializeFMUstate: fmi2SerializeFMUstateTYPE =
                fn(fmi2Component, fmi2FMUstate, *mut fmi2Byte, usize) -> fmi2Status;
            fmi2DeSerializeFMUstate: fmi2DeSerializeFMUstateTYPE =
                fn(fmi2Component, *const fmi2Byte, usize, *mut fmi2FMUstate) -> fmi2Status;
            fmi2GetDirectionalDerivative: fmi2GetDirectionalDerivativeTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *const fmi2ValueReference, usize, *const fmi2Real,
                    *mut fmi2Real) -> fmi2Status;
            fmi2EnterEventMode: fmi2EnterEventModeTYPE = fn(fmi2Component) -> fmi2Status;
            fmi2NewDiscreteStates: fmi2NewDiscreteStatesTYPE = fn(fmi2Component, *mut fmi2EventInfo) -> fmi2Status;
            fmi2EnterContinuousTimeMode: fmi2EnterContinuousTimeModeTYPE = fn(fmi2Component) -> fmi2Status;
            fmi2CompletedIntegratorStep: fmi2CompletedIntegratorStepTYPE =
                fn(fmi2Component, fmi2Boolean, *mut fmi2Boolean, *mut fmi2Boolean) -> fmi2Status;
            fmi2SetTime: fmi2SetTimeTYPE = fn(fmi2Component, fmi2Real) -> fmi2Status;
            fmi2SetContinuousStates: fmi2SetContinuousStatesTYPE =
                fn(fmi2Component, *const fmi2Real, usize) -> fmi2Status;
            fmi2GetDerivatives: fmi2GetDerivativesTYPE = fn(fmi2Component, *mut fmi2Real, usize) -> fmi2Status;
            fmi2GetEventIndicators: fmi2GetEventIndicatorsTYPE = fn(fmi2Component, *mut fmi2Real, usize) -> fmi2Status;
            fmi2GetContinuousStates: fmi2GetContinuousStatesTYPE =
                fn(fmi2Component, *mut fmi2Real, usize) -> fmi2Status;
            fmi2GetNominalsOfContinuousStates: fmi2GetNominalsOfContinuousStatesTYPE =
                fn(fmi2Component, *mut fmi2Real, usize) -> fmi2Status;
            fmi2SetRealInputDerivatives: fmi2SetRealInputDerivativesTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *const fmi2Integer, *const fmi2Real) -> fmi2Status;
            fmi2GetRealOutputDerivatives: fmi2GetRealOutputDerivativesTYPE =
                fn(fmi2Component, *const fmi2ValueReference, usize, *const fmi2Integer, *mut fmi2Real) -> fmi2Status;
            fmi2DoStep: fmi2DoStepTYPE = fn(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean) -> fmi2Status;
            fmi2CancelStep: fmi2CancelStepTYPE = fn(fmi2Component) -> fmi2Status;
            fmi2GetStatus: fmi2GetStatusTYPE = fn(fmi2Component, fmi2StatusKind, *mut fmi2Status) -> fmi2Status;
            fmi2GetRealStatus: fmi2GetRealStatusTYPE = fn(fmi2Component, fmi2StatusKind, *mut fmi2Real) -> fmi2Status;
            fmi2GetIntegerStatus: fmi2GetIntegerStatusTYPE =
                fn(fmi2Component, fmi2StatusKind, *mut fmi2Integer) -> fmi2Status;
            fmi2GetBooleanStatus: fmi2GetBooleanStatusTYPE =
                fn(fmi2Component, fmi2StatusKind, *mut fmi2Boolean) -> fmi2Status;
            fmi2GetStringStatus: fmi2GetStringStatusTYPE =
                fn(fmi2Component, fmi2StatusKind, *mut fmi2String) -> fmi2Status;
        }
    };
}

fmi2_functions!(function_table);
