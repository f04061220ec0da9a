//! Physical laws, one per file, pointwise: value, exact slopes and energy; without scenes, indices or loops over nodes.

pub mod airy;
pub mod axial_wave;
pub mod bending;
pub mod catenary;
pub mod contact_step;
pub mod fading_damper;
pub mod flow;
pub mod friction;
pub mod friction_step;
pub mod ground;
pub mod morison;
pub mod point;
pub mod rayleigh;
pub mod seabed;
pub mod section;
pub mod slender;
pub mod spectrum;
pub mod stretch;
pub mod stretch_step;
pub mod surface;
pub mod tension_table;
pub mod viscoelastic;
pub mod weight;
