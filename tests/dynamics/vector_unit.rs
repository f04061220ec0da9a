//! The kernels use the widest vector instructions of the machine; the results must not depend on them.

use crate::common::*;
use moorline::dynamics::leapfrog::step::Step;
use moorline::dynamics::leapfrog::{AxialImplicit, Explicit, Kernel, LeapfrogNetwork};
use moorline::model::{Kinematics, LineState};
use moorline::scene::{Integrator, Scene};
use nalgebra::Vector3;

/// Lines of the first network of a scene after `steps` steps of `size` [s], in which prescribed points sway by a metre.
fn swayed<K: Kernel>(scene: &Scene, size: f64, steps: usize, portable: bool) -> Vec<LineState> {
    let simulation = start(scene);
    let (model, mut state) = (simulation.model(), simulation.state().clone());
    let mut work = LeapfrogNetwork::<K>::new(model, &model.networks[0]).expect("one strain measure");
    work.set_portable(portable);
    work.load(&state);
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
    work.set_out(start.time, size, false, &held);
    work.meet_surface();
    for k in 0..steps {
        let times = [k, k + 1].map(|k| start.time + k as f64 * size);
        work.step(model, times, step, &held);
    }
    assert!(work.store(&mut state, [size; 2]));
    state.lines
}

#[test]
fn the_best_vectors_and_portable_ones_agree_bit_for_bit() {
    for name in ["oc3_catenary", "taut_polyester"] {
        for elements in [2, 3, 10, 21, 40] {
            let scene = with_integrator(with_elements(shipped(name), elements), Integrator::Leapfrog, 0.05);
            let mut simulation = start(&scene);
            simulation.advance(0.05).expect("a step");
            let size = 0.05 / simulation.substeps() as f64;
            let [wide, portable] =
                [false, true].map(|portable| swayed::<Explicit>(&scene, size, 400, portable));
            assert!(wide == portable, "{name}, {elements} elements");
        }
    }
}

#[test]
fn implicit_tensions_are_the_same_with_the_best_vectors_and_portable_ones() {
    for name in ["oc3_catenary", "taut_polyester", "lindahl_fast"] {
        for elements in [2, 3, 5, 10, 21, 40] {
            let scene = with_elements(shipped(name), elements);
            let [wide, portable] =
                [false, true].map(|portable| swayed::<AxialImplicit>(&scene, 0.02, 200, portable));
            assert!(wide == portable, "{name}, {elements} elements");
        }
    }
}
