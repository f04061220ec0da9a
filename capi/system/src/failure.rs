//! Reasons why a call fails, with the numbers of MoorDyn's interface.

/// Kind of a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum Code {
    /// Nothing failed.
    Success = 0,
    /// The deck cannot be used.
    InvalidInputFile = -1,
    /// A file cannot be written.
    InvalidOutputFile = -2,
    /// An argument is of the wrong kind, or the call comes at the wrong time.
    InvalidInput = -3,
    /// The computation did not stay finite.
    NotFinite = -4,
    /// Memory cannot be allocated.
    Memory = -5,
    /// An argument has a value that cannot be used, such as null.
    InvalidValue = -6,
    /// moorline does not model the requested feature.
    NotImplemented = -7,
    /// Any other error, including faults of the library.
    Unhandled = -255,
}

/// Failure with a message for the log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// Kind.
    pub code: Code,
    /// Message.
    pub message: String,
}

impl Failure {
    /// Returns a failure of a kind.
    pub fn new(code: Code, message: impl Into<String>) -> Failure {
        Failure {
            code,
            message: message.into(),
        }
    }

    /// Returns the failure for an argument whose value cannot be used.
    pub fn value(message: impl Into<String>) -> Failure {
        Failure::new(Code::InvalidValue, message)
    }

    /// Returns the failure for a feature that moorline does not model.
    pub fn missing(message: impl Into<String>) -> Failure {
        Failure::new(Code::NotImplemented, message)
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

/// Result of a call.
pub type Outcome<T = ()> = Result<T, Failure>;
