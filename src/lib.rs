//! Mooring-line dynamics: elastic catenary statics, cable dynamics, and the library behind the moorline FMU.
//!
//! A line is a chain of two-node segments with lumped nodes. With unit vectors q along the segments, every node obeys
//!
//! ```text
//! M_i(t) a_i = T_i q_i − T_{i−1} q_{i−1} − w_i ẑ + drag + contact,     T = max(0, EA·N(ε) + BA·ε̇)
//! M = M_n I + (M_t − M_n) t tᵀ,                                        t along the line
//! ```
//!
//! If a line has bending stiffness, every node is also a joint: −∂/∂x_i of Σ ½ (EI/l̄) |κb|² is added, where κb is the discrete curvature between the
//! unit vectors of two adjacent segments ([`physics::bending`]). A line may instead be a geometrically exact beam with shear, torsion and rotary
//! inertia ([`physics::section`]). Points may be carried by vessels that a host moves.
//!
//! SI units throughout. z points up, z = 0 is the still water level, the seabed lies at z = −depth. Lines run from end A (the
//! anchor) to end B (the fairlead), and arc length counts unstretched metres from A. Forces at points are those that the
//! mooring applies to the point's support.
//!
//! Each layer uses only the layers before it:
//!
//! ```text
//! math, physics, scene, model, elements, statics, dynamics, simulation, discretisation, interface, output
//! ```
//!
//! The packages of the workspace use the library: `moorline-decks` reads the input files of other programs, `moorline-accuracy` measures speed
//! against error, `moorline-cli` is the program, and `moorline-fmu` is the library inside FMUs.
//!
//! ```
//! use moorline::scene::Scene;
//! use moorline::simulation::Simulation;
//!
//! let scene = Scene::from_toml(
//!     r#"
//!     [line_types.wire]
//!     mass = 0.2
//!     axial_stiffness = 5.35e6
//!
//!     [[points]]
//!     name = "anchor"
//!     position = [0.0, 0.0, 0.0]
//!     kind = "fixed"
//!
//!     [[points]]
//!     name = "fairlead"
//!     position = [15.0, 0.0, 0.0]
//!     kind = "coupled"
//!
//!     [[lines]]
//!     name = "line"
//!     from = "anchor"
//!     to = "fairlead"
//!     sections = [{ type = "wire", length = 20.0, elements = 20 }]
//!     "#,
//! )?;
//! let mut mooring = Simulation::new(&scene)?; // in static equilibrium
//! let fairlead = mooring.model().point_index("fairlead").unwrap();
//! for step in 0..100 {
//!     let time = 0.01 * f64::from(step);
//!     mooring.set_displacement(fairlead, [0.1 * time.sin(), 0.0, 0.0]);
//!     mooring.advance(0.01)?;
//! }
//! let [x, _, z] = mooring.end_force(fairlead);
//! assert!(x < 0.0 && z < 0.0); // the line pulls the fairlead back and down
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![warn(unreachable_pub)]
#![forbid(unsafe_code)]

pub mod discretisation;
pub mod dynamics;
pub mod elements;
pub mod interface;
pub mod math;
pub mod model;
pub mod output;
pub mod physics;
pub mod scene;
pub mod simulation;
pub mod statics;

#[cfg(test)]
extern crate self as moorline; // `draft` and `text` are files of the outer tests and refer to the crate by its name
#[cfg(test)]
#[expect(unreachable_pub, reason = "a file of the outer tests")]
#[path = "../tests/common/draft.rs"]
mod draft;
#[cfg(test)]
#[expect(unreachable_pub, reason = "a file of the outer tests")]
#[path = "../tests/common/text.rs"]
mod text;
