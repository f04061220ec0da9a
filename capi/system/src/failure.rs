//! Reasons why a call fails, with the numbers that such hosts use.

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
    /// An argument is of the wrong kind, or comes at the wrong time.
    InvalidInput = -3,
    /// The computation did not stay finite.
    NotFinite = -4,
    /// Memory.
    Memory = -5,
    /// An argument has a value that cannot be used; null is one.
    InvalidValue = -6,
    /// moorline does not model it.
    NotImplemented = -7,
    /// Anything else, faults of the library included.
    Unhandled = -255,
}

/// Failure with a sentence for the log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// Kind.
    pub code: Code,
    /// Sentence.
    pub message: String,
}

impl Failure {
    /// A failure of a kind.
    pub fn new(code: Code, message: impl Into<String>) -> Failure {
        Failure {
            code,
            message: message.into(),
        }
    }

    /// An argument whose value cannot be used.
    pub fn value(message: impl Into<String>) -> Failure {
        Failure::new(Code::InvalidValue, message)
    }

    /// Something that moorline does not model.
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
