//! Status shared by both versions of FMI.

/// Status returned by a call; the same numbers in FMI 2.0 and 3.0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Done, with a remark in the log.
    Warning = 1,
    /// Not done; another step size may succeed.
    Discard = 2,
    /// Refused or failed.
    Error = 3,
    /// The instance is unusable.
    Fatal = 4,
}

impl Status {
    /// Converts a C status; an unknown one is treated as fatal.
    pub fn from_c(status: u32) -> Status {
        match status {
            0 => Status::Ok,
            1 => Status::Warning,
            2 => Status::Discard,
            3 => Status::Error,
            _ => Status::Fatal,
        }
    }
}
