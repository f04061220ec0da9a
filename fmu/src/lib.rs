//! FMI entry points.
