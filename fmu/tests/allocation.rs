//! A step does not allocate: an allocator that counts its calls verifies this.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use moorline::scene::{FlowSource, Integrator, Reconstruction, Scene, Threads};
use moorline::simulation::{Simulation, WaterFlow};

struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is forwarded unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller fulfils the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller fulfils the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_step_of_a_beam_allocates_nothing() {
    let scene = Scene::from_toml(include_str!("../../scenes/flying_spaghetti_3d.toml")).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.advance(0.1).unwrap();
    let before = COUNT.with(Cell::get);
    (0..99).for_each(|_| simulation.advance(0.1).unwrap());
    assert_eq!(COUNT.with(Cell::get) - before, 0);
}

/// Integrators of cables.
const INTEGRATORS: [Integrator; 4] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
    Integrator::Bossak,
];

/// Counts the allocations in steps driven by a host, which also sets the water flow if the scene requires it.
fn allocations_of_a_host(scene: &Scene) -> usize {
    let mut simulation = Simulation::new(scene).unwrap();
    let fairlead = simulation.model().point_index("fairlead").unwrap();
    let mut flow = WaterFlow::still(simulation.model());
    let mut drive = |steps: std::ops::Range<u32>| {
        for step in steps {
            let time = 0.05 * f64::from(step);
            simulation.set_displacement(fairlead, [3.0 * (0.5 * time).sin(), 0.0, 0.0]);
            for node in 0..flow.node_count(0) {
                flow.set(0, node, [time.sin(), 0.0, 0.0], [time.cos(), 0.0, 0.0]);
            }
            simulation.inputs_mut().flow.clone_from(&flow);
            simulation.advance(0.05).unwrap();
        }
    };
    drive(0..5); // buffers grow to their final sizes
    let before = COUNT.with(Cell::get);
    drive(5..200);
    COUNT.with(Cell::get) - before
}

#[test]
fn a_step_allocates_nothing() {
    for integrator in INTEGRATORS {
        let mut scene = Scene::from_toml(include_str!("../../scenes/oc4_chain.toml")).unwrap();
        scene.solver.integrator = integrator;
        assert_eq!(allocations_of_a_host(&scene), 0, "{integrator:?}");
    }
}

#[test]
fn a_step_in_the_flow_of_a_host_allocates_nothing() {
    for integrator in INTEGRATORS {
        for reconstruction in [Reconstruction::Smooth, Reconstruction::Interpolate] {
            let mut scene = Scene::from_toml(include_str!("../../scenes/oc4_chain.toml")).unwrap();
            scene.solver.integrator = integrator;
            scene.solver.input_reconstruction = reconstruction;
            scene.water.as_mut().unwrap().flow = Some(FlowSource::Host);
            assert_eq!(
                allocations_of_a_host(&scene),
                0,
                "{integrator:?}, {reconstruction:?}"
            );
        }
    }
}

/// Counts the allocations in 100 steps of a scene with its own motion, after 100 steps in which buffers grow to their final sizes.
fn allocations(text: &str, elements: Option<usize>) -> usize {
    let mut scene = Scene::from_toml(text).unwrap();
    scene.solver.elements = elements;
    scene.solver.threads = Threads::Number(1);
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.follow_scene().unwrap();
    let mut advance = |steps: usize| (0..steps).for_each(|_| simulation.advance(0.05).unwrap());
    advance(100); // past a boundary between spans of wave samples
    let before = COUNT.with(Cell::get);
    advance(100);
    COUNT.with(Cell::get) - before
}

#[test]
fn a_step_of_many_lines_on_one_thread_allocates_nothing() {
    let storm = include_str!("../../scenes/storm_moored_semi.toml");
    assert_eq!(allocations(storm, Some(8)), 0);
}

#[test]
fn a_step_of_a_cable_that_bends_allocates_nothing() {
    let cable = include_str!("../../scenes/power_cable.toml");
    assert_eq!(allocations(cable, None), 0);
}
