//! C types of FMI and a small host.
