//! moorline.

pub mod statics;
