//! Networks of a system are distributed over threads; results must not depend on the number of threads.

use crate::common::*;
use crate::copies::copies;
use moorline::model::Body;
use moorline::scene::{Integrator, Scene, Threads};
use moorline::simulation::{Simulation, Snapshot};

/// Twelve lines of a semi-submersible with `elements` elements each, with or without waves.
fn semi(elements: usize, waves: bool, integrator: Integrator) -> Scene {
    let mut scene = with_integrator(shipped("storm_moored_semi"), integrator, 0.05);
    scene.solver.elements = Some(elements);
    if let Some(water) = &mut scene.water {
        water.waves.iter_mut().for_each(|waves| waves.seas[0].ramp = None);
        water.waves = water.waves.take().filter(|_| waves);
    }
    scene
}

/// A simulation that follows the scene's motion on `threads` threads.
fn on_threads(scene: &Scene, threads: usize) -> Simulation {
    let mut scene = scene.clone();
    scene.solver.threads = Threads::Number(threads);
    following(&scene)
}

/// State after irregular communication steps on `threads` threads.
fn stepped(scene: &Scene, threads: usize) -> Snapshot {
    let mut simulation = on_threads(scene, threads);
    for step in [0.05, 0.05, 0.3, 0.01, 1.3, 0.05, 0.2, 0.05] {
        simulation.advance(step).unwrap();
    }
    simulation.snapshot().clone()
}

#[test]
fn any_number_of_threads_gives_the_same_state_bit_for_bit() {
    let mut scenes = vec![
        semi(9, true, Integrator::Leapfrog),
        semi(9, false, Integrator::AxialImplicit),
        semi(6, true, Integrator::GeneralisedAlpha),
        semi(6, false, Integrator::QuasiStatic),
        copies(&shipped("bridle"), 2, 1, 4000.0),
        with_integrator(
            copies(&shipped("bridle"), 2, 1, 4000.0),
            Integrator::GeneralisedAlpha,
            0.05,
        ),
    ];
    // networks with different integrators
    let mut mixed = semi(8, true, Integrator::Auto);
    mixed.line_types.get_mut("rope").expect("a rope").axial_stiffness = Some(1.6e11);
    mixed.lines[3]
        .sections
        .iter_mut()
        .for_each(|section| section.line_type = "chain".into());
    scenes.push(mixed);
    for (number, scene) in scenes.iter().enumerate() {
        let alone = stepped(scene, 1);
        for threads in [2, 3, 5, 16] {
            assert!(
                stepped(scene, threads) == alone,
                "scene {number}, {threads} threads"
            );
        }
    }
}

#[test]
fn a_state_that_is_put_back_goes_on_as_before_on_threads() {
    let scene = semi(9, true, Integrator::Leapfrog);
    let mut simulation = on_threads(&scene, 3);
    simulation.advance(0.4).unwrap();
    assert_replays(simulation.clone(), on_threads(&scene, 3), |simulation| {
        run(simulation, 0.07, 10)
    });
}

#[test]
fn a_step_that_fails_says_the_same_and_leaves_the_state_on_any_number_of_threads() {
    let mut scene = semi(6, false, Integrator::Leapfrog);
    scene.motion.clear();
    let fail = |threads: usize| {
        let mut scene = scene.clone();
        scene.solver.threads = Threads::Number(threads);
        let mut simulation = start(&scene);
        simulation.advance(0.05).unwrap();
        let away = [1e9, 0.0, 0.0, 0.0, 0.0, 0.0];
        simulation.set_body(Body::Vessel(0), away, [None; 6]);
        let before = simulation.snapshot().clone();
        let error = simulation.advance(0.05).expect_err("a jump beyond reach");
        assert!(*simulation.snapshot() == before, "{threads} threads");
        error
    };
    assert_eq!(fail(3), fail(1));
}

#[test]
fn many_simulations_with_threads_of_their_own_run_at_once() {
    let scene = semi(6, true, Integrator::Leapfrog);
    let alone = stepped(&scene, 1);
    std::thread::scope(|scope| {
        for threads in [1, 2, 3, 4] {
            let (scene, alone) = (&scene, &alone);
            scope.spawn(move || assert!(stepped(scene, threads) == *alone));
        }
    });
}

#[test]
fn a_line_alone_stays_on_one_thread_and_words_say_why_many_lines_do_too() {
    let said = |scene: &Scene, step: f64| {
        let simulation = start(scene);
        simulation.threads_in_words(step)
    };
    let alone = said(&shipped("oc4_chain"), 0.05);
    assert_eq!(alone, "one thread, since there is one network of lines");
    let few = said(&semi(6, false, Integrator::Leapfrog), 0.05);
    assert!(few.starts_with("one thread: 12 networks of lines"), "{few}");
    let mut asked = semi(6, false, Integrator::Leapfrog);
    asked.solver.threads = Threads::Number(4);
    assert_eq!(said(&asked, 0.05), "4 threads, as given");
}
