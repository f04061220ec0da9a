//! The keys of the scene format: the page of the format has them all.

mod page;
