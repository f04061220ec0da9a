//! The keys of the scene format: each of them acts or is refused, and the page of the format has them all.

mod effect;
mod page;
