//! The kernels run with the widest vectors of the machine; what they find must not depend on it.

use crate::common::*;
use moorline::dynamics::axial_implicit::AxialWork;
use moorline::dynamics::network::NetworkWork;
use moorline::dynamics::step::Step;
use moorline::model::{End, Kinematics, LineState, State};
use moorline::scene::Integrator;
use nalgebra::Vector3;

/// The state after `steps` steps of the first network of a scene, whose held points sway by a metre.
fn swayed(name: &str, elements: usize, steps: usize, portable: bool) -> State {
    let mut scene = with_elements(shipped(name), elements);
    scene.solver.integrator = Integrator::Leapfrog;
    let mut simulation = start(&scene);
    simulation.advance(0.05).expect("a step");
    let size = 0.05 / simulation.substeps() as f64;
    let (model, mut state) = (simulation.model(), simulation.state().clone());
    let network = &model.networks[0];
    let mut work = NetworkWork::new(model, network).expect("one strain measure");
    work.set_portable(portable);
    work.load(network, &state);
    let start = state.clone();
    let held = |point: usize, t: f64| {
        let phase = t - start.time;
        Kinematics {
            position: start.points[point].position + phase.sin() * Vector3::x(),
            velocity: phase.cos() * Vector3::x(),
            acceleration: -phase.sin() * Vector3::x(),
            ..Kinematics::default()
        }
    };
    let step = Step::after([size; 2], size);
    work.put_ends(start.time, size, &held);
    for k in 0..steps {
        work.step(model, network, start.time + k as f64 * size, step, &held);
    }
    assert!(work.is_sound());
    work.store(network, &mut state, [size; 2]);
    state
}

#[test]
fn the_widest_vectors_and_portable_ones_agree_bit_for_bit() {
    for name in ["oc3_catenary", "taut_polyester"] {
        for elements in [2, 3, 10, 21, 40] {
            let [wide, portable] = [false, true].map(|portable| swayed(name, elements, 400, portable));
            assert!(wide.lines == portable.lines, "{name}, {elements} elements");
        }
    }
}

/// The state after `steps` axial-implicit steps of the first line of a scene, whose ends sway by a metre.
fn swayed_implicitly(name: &str, elements: usize, steps: usize, portable: bool) -> LineState {
    let mut scene = with_elements(shipped(name), elements);
    scene.solver.integrator = Integrator::AxialImplicit;
    let simulation = start(&scene);
    let (model, size) = (simulation.model(), 0.02);
    let line = &model.lines[0];
    let mut state = simulation.state().lines[0].clone();
    let mut work = AxialWork::new(model, line, 0.9).expect("one strain measure");
    work.set_portable(portable);
    work.load(&state);
    let start = line.ends.map(|point| simulation.state().points[point].position);
    let step = Step::after([size; 2], size);
    for end in [End::A, End::B] {
        work.put_end(end, start[end as usize], Vector3::zeros());
    }
    work.meet_surface();
    for k in 1..=steps {
        let phase = 2.0 * k as f64 * size;
        work.step(step, start.map(|at| at + phase.sin() * Vector3::x()));
    }
    assert_eq!(work.broken_node(), None);
    work.store(&mut state, [size; 2]);
    state
}

#[test]
fn implicit_tensions_are_the_same_with_the_widest_vectors_and_portable_ones() {
    for name in ["oc3_catenary", "taut_polyester", "lindahl_fast"] {
        for elements in [2, 3, 5, 10, 21, 40] {
            let [wide, portable] = [false, true].map(|by| swayed_implicitly(name, elements, 200, by));
            assert!(wide == portable, "{name}, {elements} elements");
        }
    }
}
