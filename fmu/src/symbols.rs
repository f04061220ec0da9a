//! Macros for the symbols of both versions that differ in their names alone. They use [`crate::ffi`] and the constant `VERSION` of the file that calls them.

/// Asserts at compile time that every function of the standard is defined with its standard signature.
macro_rules! assert_complete {
    ($($name:ident: $type:ident = fn($($argument:ty),*) -> $result:ty;)*) => {
        $(const _: $type = $name;)*
    };
}

/// Functions that the standard requires and this FMU does not offer.
macro_rules! refuse {
    ($why:literal; $($name:ident($($argument:ty),*);)*) => {
        $(
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $name(c: *mut std::ffi::c_void $(, _: $argument)*) -> std::ffi::c_uint {
                // SAFETY: the host's handle.
                unsafe { ffi::call(c, VERSION, stringify!($name), |_| Err($why.into())) }
            }
        )*
    };
}

/// Functions whose only argument is the handle.
macro_rules! transitions {
    ($($name:ident: $method:ident;)*) => {
        $(
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $name(c: *mut std::ffi::c_void) -> std::ffi::c_uint {
                // SAFETY: the host's handle.
                unsafe { ffi::call(c, VERSION, stringify!($name), crate::instance::Instance::$method) }
            }
        )*
    };
}

/// Access by types that no variable has; `rest` are the parameters after the references.
macro_rules! no_variables {
    ($($name:ident($($rest:ty),*): $kind:literal;)*) => {
        $(
            #[unsafe(no_mangle)]
            unsafe extern "C" fn $name(
                c: *mut std::ffi::c_void,
                references: *const u32,
                count: usize,
                $(_: $rest),*
            ) -> std::ffi::c_uint {
                // SAFETY: the host's handle and array.
                unsafe {
                    ffi::call(c, VERSION, stringify!($name), |instance| {
                        instance.refuse_type($kind, ffi::slice(references, count)?)
                    })
                }
            }
        )*
    };
}

pub(crate) use {assert_complete, no_variables, refuse, transitions};
