//! Chains whose touchdown moves in a storm: the seabed adds no noise.

use moorline::scene::{Integrator, Scene};

use crate::common::*;

/// Number of evaluated samples at intervals of 0.05 s [-]: three periods of the slower motion.
const WINDOW: usize = 700;

/// A chain of `elements` elements in water of a depth [m], whose fairlead moves by `surge` and `heave` [m].
fn chain([depth, span, length]: [f64; 3], [surge, heave]: [f64; 2], elements: usize) -> Scene {
    let fairlead = format!("x = [[{surge}, 11.5]], z = [[{heave}, 7.4]], ramp = 15.0");
    let chain = draft(format!(
        "water.density = 1025.0
        seabed.depth = {depth}
        line_types.chain = {{ mass = 80.0, diameter = 0.114, axial_stiffness = 3.4e8, axial_damping = 1.0e6, drag_normal = 1.2,
          drag_tangential = 0.1, added_mass_normal = 1.0 }}
        motion.fairlead = {{ {fairlead} }}"
    ))
    .fixed("anchor", [0.0, 0.0, -depth])
    .coupled("fairlead", [span, 0.0, -0.05 * depth])
    .line("line", ["anchor", "fairlead"], "chain", length, elements);
    with_integrator(chain.scene(), Integrator::AxialImplicit, 0.005)
}

fn history(elements: usize) -> History {
    let scene = chain([50.0, 150.0, 175.0], [2.9, 1.7], elements);
    History::record(&mut following(&scene), 0.05, 1000)
}

#[test]
fn a_touchdown_that_wanders_makes_no_noise() {
    // with contact at nodes only, such chains have errors of 16 to 30 % with 40 elements
    let reference = history(320);
    let errors = [40, 80, 160].map(|elements| history(elements).tension_error(&reference, WINDOW));
    println!("RMS error of tension with 40, 80 and 160 elements: {errors:?}");
    assert!(
        errors[0] < 0.085 && errors[1] < 0.07 && errors[2] < 0.06,
        "{errors:?}"
    );
    let peak = |history: &History| greatest(last(&history.tension, WINDOW).iter().copied());
    let off = peak(&history(60)) / peak(&reference) - 1.0;
    println!("greatest tension with 60 elements off by {off}");
    assert!(off.abs() < 0.03, "{off}");
}
