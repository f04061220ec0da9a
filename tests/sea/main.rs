//! Lines and free points in water and on the seabed: waves, current, the surface, friction, slopes, soundings.

#[path = "../common/mod.rs"]
mod common;

mod current;
mod flow;
mod points;
mod seabed;
mod surface;
mod waves;
