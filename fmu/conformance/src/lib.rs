//! Comparison of the ABI of every FMI function with the standard's C headers, as read by bindgen in `fmi-sys`.
//!
//! Each function that the FMU exports has the type of the same name in `moorline-host` (asserted in `fmu/src/fmi2.rs` and
//! `fmi3.rs`). Here each of those types must equal the one in `fmi-sys`, so a wrong argument fails to compile.
//! Without the feature `fmi-sys` this package is empty.
#![cfg(feature = "fmi-sys")]

use std::mem::{align_of, offset_of, size_of};

use fmi_sys::fmi2 as standard;
use moorline_host::{fmi2 as own, fmi2_functions, fmi3_functions};

/// Asserts that the types of all functions are those of the C headers. Two functions of FMI 2.0 take a structure that
/// both packages declare separately; they are compared below.
macro_rules! assert_same_fmi2 {
    () => {};
    (fmi2Instantiate: $type:ident = fn($($a:ty),*) -> $r:ty; $($rest:tt)*) => {
        assert_same_fmi2!($($rest)*);
    };
    (fmi2NewDiscreteStates: $type:ident = fn($($a:ty),*) -> $r:ty; $($rest:tt)*) => {
        assert_same_fmi2!($($rest)*);
    };
    ($name:ident: $type:ident = fn($($a:ty),*) -> $r:ty; $($rest:tt)*) => {
        const _: fn(own::$type) -> standard::$type = |function| Some(function);
        assert_same_fmi2!($($rest)*);
    };
}
fmi2_functions!(assert_same_fmi2);

macro_rules! assert_same_fmi3 {
    ($($name:ident: $type:ident = fn($($a:ty),*) -> $r:ty;)*) => {
        $(const _: fn(moorline_host::fmi3::$type) -> fmi_sys::fmi3::$type = |function| Some(function);)*
    };
}
fmi3_functions!(assert_same_fmi3);

/// Type of `fmi2Instantiate` with the callbacks of either package and otherwise the types of `fmi-sys`.
type Instantiate<Callbacks> = unsafe extern "C" fn(
    standard::fmi2String,
    standard::fmi2Type,
    standard::fmi2String,
    standard::fmi2String,
    *const Callbacks,
    standard::fmi2Boolean,
    standard::fmi2Boolean,
) -> standard::fmi2Component;
const _: fn(own::fmi2InstantiateTYPE) -> Instantiate<own::fmi2CallbackFunctions> = |f| f;
const _: fn(Instantiate<standard::fmi2CallbackFunctions>) -> standard::fmi2InstantiateTYPE = |f| Some(f);

/// Type of `fmi2NewDiscreteStates` with the event information of either package.
type NewDiscreteStates<Info> =
    unsafe extern "C" fn(standard::fmi2Component, *mut Info) -> standard::fmi2Status;
const _: fn(own::fmi2NewDiscreteStatesTYPE) -> NewDiscreteStates<own::fmi2EventInfo> = |f| f;
const _: fn(NewDiscreteStates<standard::fmi2EventInfo>) -> standard::fmi2NewDiscreteStatesTYPE = |f| Some(f);

/// Asserts that two structures have the same size, alignment, field types and field offsets.
macro_rules! assert_same_structure {
    ($name:ident: $($field:ident)*) => {
        const _: () = {
            assert!(size_of::<own::$name>() == size_of::<standard::$name>());
            assert!(align_of::<own::$name>() == align_of::<standard::$name>());
            $(assert!(offset_of!(own::$name, $field) == offset_of!(standard::$name, $field));)*
        };
        const _: fn(own::$name) -> standard::$name = |s| standard::$name { $($field: s.$field),* };
    };
}
assert_same_structure!(fmi2CallbackFunctions: logger allocateMemory freeMemory stepFinished componentEnvironment);
assert_same_structure!(fmi2EventInfo:
    newDiscreteStatesNeeded terminateSimulation nominalsOfContinuousStatesChanged valuesOfContinuousStatesChanged
    nextEventTimeDefined nextEventTime);

/// Asserts that constants have the values of the C headers; bindgen prefixes them with the name of the enumeration.
macro_rules! assert_same_numbers {
    ($($own:ident = $standard:ident)*) => { $(const _: () = assert!(own::$own == standard::$standard);)* };
}
assert_same_numbers! {
    fmi2OK = fmi2Status_fmi2OK
    fmi2Warning = fmi2Status_fmi2Warning
    fmi2Discard = fmi2Status_fmi2Discard
    fmi2Error = fmi2Status_fmi2Error
    fmi2Fatal = fmi2Status_fmi2Fatal
    fmi2Pending = fmi2Status_fmi2Pending
    fmi2ModelExchange = fmi2Type_fmi2ModelExchange
    fmi2CoSimulation = fmi2Type_fmi2CoSimulation
    fmi2DoStepStatus = fmi2StatusKind_fmi2DoStepStatus
    fmi2PendingStatus = fmi2StatusKind_fmi2PendingStatus
    fmi2LastSuccessfulTime = fmi2StatusKind_fmi2LastSuccessfulTime
    fmi2Terminated = fmi2StatusKind_fmi2Terminated
}
