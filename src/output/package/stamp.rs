//! Author and date of an FMU, which do not belong to its scene.

/// Author and date in the description of an FMU; the instantiation token does not depend on them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Stamp {
    /// Author of the model; left out where absent.
    pub author: Option<String>,
    /// Time of generation, in UTC, such as `2026-11-25T23:45:00Z`; left out where absent, so that the same scene gives the same bytes.
    pub date: Option<String>,
}
