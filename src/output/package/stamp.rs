//! Author and date of an FMU, which are not part of its scene.

/// Author and date in the description of an FMU; the instantiation token does not depend on them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Stamp {
    /// Author of the model; omitted if absent.
    pub author: Option<String>,
    /// Time of generation, in UTC, such as `2026-11-25T23:45:00Z`; omitted if absent, so that the same scene gives the same bytes.
    pub date: Option<String>,
}
