//! Keys of the scene format: each of them acts or is refused, and the page of the format lists them all.

mod effect;
mod page;
