//! The C library agrees with the Rust library, refuses unusable arguments with a code and a message, and accepts calls in any order.

use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr::{null, null_mut, without_provenance_mut};

use moorline::interface::{Interface, Layout};
use moorline::math::random::Random;
use moorline::scene::Scene;
use moorline::simulation::{Simulation, WaterFlow};
use moorline_c::codes::*;

type Handle = *mut c_void;

unsafe extern "C" {
    fn moorline_abi_version() -> u32;
    fn moorline_message(text: *mut c_char, room: usize, needed: *mut usize) -> c_int;
    fn moorline_load(version: u32, path: *const c_char, simulation: *mut Handle) -> c_int;
    fn moorline_read(version: u32, toml: *const c_char, simulation: *mut Handle) -> c_int;
    fn moorline_close(simulation: Handle) -> c_int;
    fn moorline_select(simulation: Handle) -> c_int;
    fn moorline_start(simulation: Handle, time: f64) -> c_int;
    fn moorline_reset(simulation: Handle) -> c_int;
    fn moorline_step(simulation: Handle, step: f64) -> c_int;
    fn moorline_warnings(simulation: Handle, text: *mut c_char, room: usize, needed: *mut usize) -> c_int;
    fn moorline_time(simulation: Handle, time: *mut f64) -> c_int;
    fn moorline_save(simulation: Handle, bytes: *mut u8, room: usize, needed: *mut usize) -> c_int;
    fn moorline_restore(simulation: Handle, bytes: *const u8, count: usize) -> c_int;
    fn moorline_statics(simulation: Handle, text: *mut c_char, room: usize, needed: *mut usize) -> c_int;
    fn moorline_find(simulation: Handle, name: *const c_char, reference: *mut u32) -> c_int;
    fn moorline_variable_count(simulation: Handle, count: *mut usize) -> c_int;
    fn moorline_variable_name(
        simulation: Handle,
        reference: u32,
        text: *mut c_char,
        room: usize,
        needed: *mut usize,
    ) -> c_int;
    fn moorline_set(simulation: Handle, references: *const u32, values: *const f64, count: usize) -> c_int;
    fn moorline_get(simulation: Handle, references: *const u32, values: *mut f64, count: usize) -> c_int;
    fn moorline_derivatives(
        simulation: Handle,
        outputs: *const u32,
        values: *mut f64,
        count: usize,
        input: u32,
    ) -> c_int;
    fn moorline_rates(simulation: Handle, outputs: *const u32, values: *mut f64, count: usize) -> c_int;
    fn moorline_output_count(simulation: Handle, count: *mut usize) -> c_int;
    fn moorline_get_outputs(simulation: Handle, values: *mut f64, count: usize) -> c_int;
    fn moorline_input_count(simulation: Handle, count: *mut usize) -> c_int;
    fn moorline_set_inputs(simulation: Handle, values: *const f64, count: usize) -> c_int;
    fn moorline_move(
        simulation: Handle,
        body: usize,
        place: *const f64,
        velocity: *const f64,
        size: usize,
    ) -> c_int;
    fn moorline_force(simulation: Handle, body: usize, force: *mut f64, size: usize) -> c_int;
    fn moorline_stiffness(simulation: Handle, body: usize, stiffness: *mut f64, count: usize) -> c_int;
    fn moorline_node_count(simulation: Handle, line: usize, count: *mut usize) -> c_int;
    fn moorline_node_positions(simulation: Handle, line: usize, positions: *mut f64, count: usize) -> c_int;
    fn moorline_flow_places(simulation: Handle, line: usize, places: *mut f64, count: usize) -> c_int;
    fn moorline_set_flow(
        simulation: Handle,
        line: usize,
        velocities: *const f64,
        accelerations: *const f64,
        count: usize,
    ) -> c_int;
}

/// A line from an anchor to a vessel, and one to a coupled point.
const SCENE: &str = "
water.density = 1025.0
seabed.depth = 60.0
line_types.chain = { mass = 100.0, diameter = 0.1, axial_stiffness = 1.0e8, drag_normal = 1.6 }
points = [
    { name = \"left\", position = [-100.0, 0.0, -60.0], kind = \"fixed\" },
    { name = \"right\", position = [100.0, 0.0, -60.0], kind = \"fixed\" },
    { name = \"bow\", position = [3.0, 0.0, 0.0], kind = \"coupled\", on = \"hull\" },
    { name = \"buoy\", position = [-4.0, 0.0, -10.0], kind = \"coupled\" },
]
vessels = [{ name = \"hull\", position = [0.0, 0.0, -10.0] }]
lines = [
    { name = \"one\", from = \"left\", to = \"buoy\", sections = [{ type = \"chain\", length = 115.0, elements = 6 }] },
    { name = \"two\", from = \"right\", to = \"bow\", sections = [{ type = \"chain\", length = 115.0, elements = 6 }] },
]
";

/// The same scene with the water flow set by the host.
fn hosted() -> String {
    SCENE.replace("water.density", "water.flow = \"host\"\nwater.density")
}

fn read(text: &str) -> Handle {
    let (text, mut handle) = (CString::new(text).unwrap(), null_mut());
    // SAFETY: a text and a handle.
    let code = unsafe { moorline_read(MOORLINE_ABI_VERSION, text.as_ptr(), &raw mut handle) };
    assert_eq!(code, MOORLINE_OK, "{}", message());
    handle
}

fn message() -> String {
    let mut text = [0 as c_char; 1000];
    // SAFETY: room for the text.
    unsafe { moorline_message(text.as_mut_ptr(), text.len(), null_mut()) };
    let bytes: Vec<u8> = text.iter().take_while(|c| **c != 0).map(|c| *c as u8).collect();
    String::from_utf8(bytes).unwrap()
}

fn find(simulation: Handle, name: &str) -> u32 {
    let (name, mut reference) = (CString::new(name).unwrap(), 0);
    // SAFETY: a text and a number.
    assert_eq!(
        unsafe { moorline_find(simulation, name.as_ptr(), &raw mut reference) },
        MOORLINE_OK
    );
    reference
}

fn outputs(simulation: Handle) -> Vec<f64> {
    let mut count = 0;
    // SAFETY: room for the number, and then for the outputs.
    unsafe {
        assert_eq!(moorline_output_count(simulation, &raw mut count), MOORLINE_OK);
        let mut values = vec![0.0; count];
        assert_eq!(
            moorline_get_outputs(simulation, values.as_mut_ptr(), count),
            MOORLINE_OK,
            "{}",
            message()
        );
        values
    }
}

fn sway(simulation: Handle, from: usize, count: usize) -> Vec<Vec<f64>> {
    let row = |k: usize| {
        let size = 1.0 - (0.05 * k as f64).cos();
        let (buoy, hull) = ([size, 0.0, 0.0], [size, 0.0, 0.0, 0.05 * size, 0.0, 0.0]);
        // SAFETY: arrays of three and six values.
        unsafe {
            assert_eq!(
                moorline_move(simulation, 0, buoy.as_ptr(), null(), 3),
                MOORLINE_OK
            );
            assert_eq!(
                moorline_move(simulation, 1, hull.as_ptr(), null(), 6),
                MOORLINE_OK
            );
            assert_eq!(moorline_step(simulation, 0.05), MOORLINE_OK, "{}", message());
        }
        outputs(simulation)
    };
    (from..from + count).map(row).collect()
}

#[test]
fn forces_and_nodes_are_those_of_the_library_in_rust() {
    let simulation = read(SCENE);
    let mut mooring = Simulation::new(&Scene::from_toml(SCENE).unwrap()).unwrap();
    mooring.restart(0.0).unwrap();
    let (mut force, mut count, mut places) = ([0.0; 6], 0, [0.0; 21]);
    let mut stiffness = [0.0; 36];
    // SAFETY: arrays of the right lengths.
    unsafe {
        assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK);
        assert_eq!(
            moorline_stiffness(simulation, 1, stiffness.as_mut_ptr(), 36),
            MOORLINE_OK,
            "{}",
            message()
        );
    }
    assert_eq!(
        stiffness[..],
        *mooring.vessel_stiffness(0).unwrap().as_flattened()
    );
    sway(simulation, 0, 20);
    for k in 0..20 {
        let size = 1.0 - (0.05 * f64::from(k)).cos();
        mooring.set_displacement(3, [size, 0.0, 0.0]);
        mooring.set_pose(0, [size, 0.0, 0.0, 0.05 * size, 0.0, 0.0]);
        mooring.advance(0.05).unwrap();
    }
    // SAFETY: as above.
    unsafe {
        assert_eq!(moorline_force(simulation, 1, force.as_mut_ptr(), 6), MOORLINE_OK);
        assert_eq!(moorline_node_count(simulation, 1, &raw mut count), MOORLINE_OK);
        assert_eq!(
            moorline_node_positions(simulation, 1, places.as_mut_ptr(), 3 * count),
            MOORLINE_OK
        );
        assert_eq!(moorline_close(simulation), MOORLINE_OK);
    }
    assert_eq!(force, mooring.vessel_force(0));
    let profile = mooring.profile(1);
    assert!(
        places
            .chunks(3)
            .eq(profile.iter().map(|node| [node.x, node.y, node.z]))
    );
}

#[test]
fn the_force_on_a_body_excludes_the_inertia_of_the_ends_where_the_scene_asks_for_that() {
    let forces = [SCENE, &format!("output.force = \"without_inertia\"\n{SCENE}")].map(|scene| {
        let simulation = read(scene);
        let (mut force, mut variables) = ([0.0; 3], [0.0; 3]);
        // SAFETY: arrays of three values.
        unsafe {
            assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK, "{}", message());
            sway(simulation, 0, 5);
            let references = ["fx", "fy", "fz"].map(|axis| find(simulation, &format!("buoy.{axis}")));
            let values = variables.as_mut_ptr();
            assert_eq!(
                moorline_get(simulation, references.as_ptr(), values, 3),
                MOORLINE_OK
            );
            assert_eq!(moorline_force(simulation, 0, force.as_mut_ptr(), 3), MOORLINE_OK);
            moorline_close(simulation);
        }
        assert_eq!(force, variables);
        force
    });
    assert_ne!(forces[0], forces[1]);
}

#[test]
fn inputs_that_are_all_set_with_velocities_of_zero_are_displacements_alone() {
    let [by_body, by_variable] = [read(SCENE), read(SCENE)];
    let (mut count, mut by_all) = (0, Vec::new());
    // SAFETY: handles, a number, and arrays of as many values.
    unsafe {
        for simulation in [by_body, by_variable] {
            assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK, "{}", message());
        }
        assert_eq!(moorline_input_count(by_variable, &raw mut count), MOORLINE_OK);
        let names = ["buoy.x", "hull.x", "hull.roll"].map(|name| find(by_variable, name));
        for k in 0..20 {
            let size = 1.0 - (0.05 * f64::from(k)).cos();
            let zeros = vec![0.0; count];
            assert_eq!(
                moorline_set_inputs(by_variable, zeros.as_ptr(), count),
                MOORLINE_OK
            );
            let values = [size, size, 0.05 * size];
            assert_eq!(
                moorline_set(by_variable, names.as_ptr(), values.as_ptr(), 3),
                MOORLINE_OK
            );
            assert_eq!(moorline_step(by_variable, 0.05), MOORLINE_OK, "{}", message());
            by_all.push(outputs(by_variable));
        }
        assert!(sway(by_body, 0, 20) == by_all);
        for simulation in [by_body, by_variable] {
            moorline_close(simulation);
        }
    }
}

#[test]
fn derivatives_and_rates_are_those_of_the_library_in_rust() {
    let text = format!("{SCENE}\n[output]\nderivatives = true\n");
    let scene = Scene::from_toml(&text).unwrap();
    let (simulation, mut mooring) = (read(&text), Simulation::new(&scene).unwrap());
    mooring.restart(0.0).unwrap();
    let names = ["hull.fx", "hull.fz", "hull.my"];
    let references = names.map(|name| find(simulation, name));
    let (by, release) = (
        find(simulation, "hull.pitch"),
        find(simulation, "solver.substeps"),
    );
    let (mut derivatives, mut rates) = ([0.0; 3], [0.0; 3]);
    // SAFETY: arrays of three values.
    unsafe {
        assert_eq!(
            moorline_rates(simulation, references.as_ptr(), rates.as_mut_ptr(), 3),
            MOORLINE_WRONG_PHASE
        );
        assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK);
        sway(simulation, 0, 3);
        let (from, to) = (references.as_ptr(), derivatives.as_mut_ptr());
        assert_eq!(moorline_derivatives(simulation, from, to, 3, by), MOORLINE_OK);
        assert_eq!(
            moorline_rates(simulation, from, rates.as_mut_ptr(), 3),
            MOORLINE_OK
        );
        assert_eq!(
            moorline_derivatives(simulation, from, to, 3, release),
            MOORLINE_NOT_AVAILABLE
        );
        assert!(
            message().contains("displacements and velocities"),
            "{}",
            message()
        );
        assert_eq!(moorline_close(simulation), MOORLINE_OK);
    }
    for k in 0..3 {
        let size = 1.0 - (0.05 * f64::from(k)).cos();
        mooring.set_displacement(3, [size, 0.0, 0.0]);
        mooring.set_pose(0, [size, 0.0, 0.0, 0.05 * size, 0.0, 0.0]);
        mooring.advance(0.05).unwrap();
    }
    let interface = Interface::new(&scene, mooring.model(), Layout::Scalars).unwrap();
    let variable = |reference: u32| interface.variable(reference).unwrap();
    let outputs = references.map(variable);
    assert_eq!(
        derivatives[..],
        Interface::derivative(&outputs, variable(by), &mooring).unwrap()
    );
    assert_eq!(rates[..], Interface::rates(&outputs, &mooring).unwrap());
    assert!(derivatives.iter().all(|value| *value != 0.0), "{derivatives:?}");
}

#[test]
fn a_state_goes_on_bit_for_bit_also_in_another_simulation() {
    let (one, other) = (read(SCENE), read(SCENE));
    let (density, value) = (find(one, "water.density"), 1000.0);
    let mut needed = 0;
    // SAFETY: numbers, and room for the state.
    unsafe {
        assert_eq!(
            moorline_set(one, &raw const density, &raw const value, 1),
            MOORLINE_OK,
            "{}",
            message()
        );
        assert_eq!(moorline_start(one, 2.0), MOORLINE_OK);
        sway(one, 0, 5);
        assert_eq!(moorline_save(one, null_mut(), 0, &raw mut needed), MOORLINE_OK);
        let mut bytes = vec![0; needed];
        assert_eq!(
            moorline_save(one, bytes.as_mut_ptr(), needed - 1, null_mut()),
            MOORLINE_INVALID_ARGUMENT
        );
        assert_eq!(
            moorline_save(one, bytes.as_mut_ptr(), needed, null_mut()),
            MOORLINE_OK
        );
        let rest = sway(one, 5, 5);
        for simulation in [one, other] {
            assert_eq!(
                moorline_restore(simulation, bytes.as_ptr(), needed),
                MOORLINE_OK,
                "{}",
                message()
            );
            assert!(sway(simulation, 5, 5) == rest);
        }
        bytes[40] ^= 1;
        assert_eq!(
            moorline_restore(one, bytes.as_ptr(), needed),
            MOORLINE_INVALID_ARGUMENT
        );
        assert!(message().contains("damaged"), "{}", message());
        moorline_close(one);
        moorline_close(other);
    }
}

#[test]
fn the_flow_of_the_water_acts_as_in_the_library_in_rust_and_is_that_of_its_inputs() {
    let simulation = read(&hosted());
    let mut mooring = Simulation::new(&Scene::from_toml(&hosted()).unwrap()).unwrap();
    let mut flow = WaterFlow::still(mooring.model());
    let mut places = [[0.0; 3]; 7];
    // SAFETY: arrays of three values for each of the seven nodes.
    unsafe {
        assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK, "{}", message());
        for _ in 0..20 {
            let place = places.as_mut_ptr().cast();
            assert_eq!(moorline_flow_places(simulation, 0, place, 21), MOORLINE_OK);
            let velocities = places.map(|[x, _, z]| [0.02 * x, 0.01 * z, 0.1]);
            let accelerations = places.map(|[x, _, z]| [0.01 * z, 0.0, 0.01 * x]);
            let values = [&velocities, &accelerations].map(|vectors| vectors.as_ptr().cast());
            let given = moorline_set_flow(simulation, 0, values[0], values[1], 21);
            assert_eq!(given, MOORLINE_OK, "{}", message());
            for node in 0..7 {
                assert_eq!(places[node], <[f64; 3]>::from(mooring.flow_place(0, node)));
                flow.set(0, node, velocities[node], accelerations[node]);
            }
            mooring.inputs_mut().flow.clone_from(&flow);
            mooring.advance(0.1).unwrap();
            assert_eq!(moorline_step(simulation, 0.1), MOORLINE_OK, "{}", message());
        }
        let (mut force, mut value) = ([0.0; 3], 0.0);
        assert_eq!(moorline_force(simulation, 0, force.as_mut_ptr(), 3), MOORLINE_OK);
        assert_eq!(force, mooring.end_force(3));
        let reference = find(simulation, "one.flow.az[4]");
        assert_eq!(
            moorline_get(simulation, &raw const reference, &raw mut value, 1),
            MOORLINE_OK
        );
        assert_eq!(value, flow.component(0, 5)[3]);
        let slower = 0.5 * value;
        assert_eq!(
            moorline_set(simulation, &raw const reference, &raw const slower, 1),
            MOORLINE_OK
        );
        flow.component_mut(0, 5)[3] = slower;
        mooring.inputs_mut().flow.clone_from(&flow);
        mooring.advance(0.1).unwrap();
        assert_eq!(moorline_step(simulation, 0.1), MOORLINE_OK, "{}", message());
        assert_eq!(moorline_force(simulation, 0, force.as_mut_ptr(), 3), MOORLINE_OK);
        assert_eq!(force, mooring.end_force(3));
        moorline_close(simulation);
    }
}

#[test]
fn a_flow_that_is_not_asked_for_or_cannot_be_used_has_its_code_and_a_sentence() {
    let (still, flowing) = (read(SCENE), read(&hosted()));
    let (calm, wild, mut places) = ([0.0; 21], [f64::NAN; 21], [0.0; 21]);
    // SAFETY: arrays of the lengths passed.
    unsafe {
        refused(
            moorline_set_flow(still, 0, calm.as_ptr(), calm.as_ptr(), 21),
            MOORLINE_NOT_AVAILABLE,
            "`flow = \"host\"`",
        );
        refused(
            moorline_flow_places(flowing, 0, places.as_mut_ptr(), 21),
            MOORLINE_WRONG_PHASE,
            "start first",
        );
        refused(
            moorline_set_flow(flowing, 0, calm.as_ptr(), wild.as_ptr(), 21),
            MOORLINE_INVALID_ARGUMENT,
            "one: NaN",
        );
        refused(
            moorline_set_flow(flowing, 0, calm.as_ptr(), calm.as_ptr(), 7),
            MOORLINE_INVALID_ARGUMENT,
            "21 values",
        );
        moorline_close(still);
        moorline_close(flowing);
    }
}

#[test]
fn elements_are_selected_for_a_scene_whose_host_gives_the_flow() {
    let scene = hosted().replace(", elements = 6", "");
    let scene = format!(
        "{scene}motion.buoy = {{ x = [[1.0, 8.0]] }}\nsolver.tolerance = 0.1\noutput.duration = 20.0\n"
    );
    let simulation = read(&scene);
    // SAFETY: a simulation, and room for as many values as are given.
    unsafe {
        assert_eq!(moorline_select(simulation), MOORLINE_OK, "{}", message());
        assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK, "{}", message());
        let mut nodes = 0;
        assert_eq!(moorline_node_count(simulation, 0, &raw mut nodes), MOORLINE_OK);
        let values = vec![0.1; 3 * nodes];
        let given = moorline_set_flow(simulation, 0, values.as_ptr(), values.as_ptr(), values.len());
        assert_eq!(given, MOORLINE_OK, "{}", message());
        assert_eq!(moorline_step(simulation, 0.05), MOORLINE_OK, "{}", message());
        moorline_close(simulation);
    }
}

/// Asserts the code of a call and words of its message.
fn refused(code: c_int, expected: c_int, words: &str) {
    assert_eq!(code, expected, "{}", message());
    assert!(message().contains(words), "{}", message());
}

#[test]
fn what_cannot_be_used_has_its_code_and_a_sentence() {
    let mut handle = null_mut();
    // SAFETY: texts, numbers, null pointers that are refused, and handles that may be anything.
    unsafe {
        assert_eq!(moorline_abi_version(), MOORLINE_ABI_VERSION);
        let scene = CString::new(SCENE).unwrap();
        refused(
            moorline_read(7, scene.as_ptr(), &raw mut handle),
            MOORLINE_WRONG_VERSION,
            "version 7",
        );
        refused(
            moorline_read(1, null(), &raw mut handle),
            MOORLINE_INVALID_ARGUMENT,
            "null",
        );
        refused(
            moorline_read(1, scene.as_ptr(), null_mut()),
            MOORLINE_INVALID_ARGUMENT,
            "null",
        );
        refused(
            moorline_read(1, c"line = 3".as_ptr(), &raw mut handle),
            MOORLINE_SCENE_ERROR,
            "line",
        );
        refused(
            moorline_load(1, c"no/such/scene".as_ptr(), &raw mut handle),
            MOORLINE_SCENE_ERROR,
            "no/such",
        );
        assert!(handle.is_null());
        let one = read(SCENE);
        refused(moorline_step(one, 0.1), MOORLINE_WRONG_PHASE, "start first");
        assert_eq!(moorline_start(one, 0.0), MOORLINE_OK);
        refused(moorline_step(one, f64::NAN), MOORLINE_INVALID_ARGUMENT, "NaN");
        let (density, value) = (find(one, "water.density"), 1000.0);
        refused(
            moorline_set(one, &raw const density, &raw const value, 1),
            MOORLINE_WRONG_PHASE,
            "reset",
        );
        refused(
            moorline_force(one, 9, null_mut(), 3),
            MOORLINE_INVALID_ARGUMENT,
            "no body 9",
        );
        let mut force = [0.0; 6];
        refused(
            moorline_force(one, 1, force.as_mut_ptr(), 3),
            MOORLINE_INVALID_ARGUMENT,
            "room for 3",
        );
        refused(
            moorline_stiffness(one, 0, force.as_mut_ptr(), 36),
            MOORLINE_NOT_AVAILABLE,
            "buoy",
        );
        assert_eq!(moorline_close(one), MOORLINE_OK);
        refused(moorline_step(one, 0.1), MOORLINE_INVALID_HANDLE, "closed");
        refused(moorline_close(one), MOORLINE_INVALID_HANDLE, "closed");
        assert_eq!(moorline_close(null_mut()), MOORLINE_OK);
    }
}

fn warnings(simulation: Handle) -> String {
    let mut needed = 0;
    // SAFETY: a number, and then room for the text.
    unsafe {
        let asked = moorline_warnings(simulation, null_mut(), 0, &raw mut needed);
        assert_eq!(asked, MOORLINE_OK);
        let mut text = vec![0 as c_char; needed];
        let given = moorline_warnings(simulation, text.as_mut_ptr(), needed, null_mut());
        assert_eq!(given, MOORLINE_OK);
        let text = text.iter().take_while(|c| **c != 0);
        text.map(|c| char::from(*c as u8)).collect()
    }
}

#[test]
fn likely_mistakes_are_told_once() {
    let simulation = read(&SCENE.replace("1.0e8", "1.0e12"));
    let of_scene = warnings(simulation);
    assert!(
        of_scene.contains("axial_stiffness") && of_scene.ends_with('\n'),
        "{of_scene}"
    );
    // SAFETY: an array of three values.
    unsafe {
        assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK);
        assert_eq!(warnings(simulation), "");
        let buoy = [-12.0, 0.0, 0.0];
        assert_eq!(
            moorline_move(simulation, 0, buoy.as_ptr(), null(), 3),
            MOORLINE_OK
        );
        assert_eq!(moorline_step(simulation, 1.0), MOORLINE_OK, "{}", message());
        let of_step = warnings(simulation);
        assert!(of_step.contains("buoy has moved by 12.000 m"), "{of_step}");
        assert_eq!(moorline_step(simulation, 1.0), MOORLINE_OK, "{}", message());
        assert_eq!(warnings(simulation), "");
        moorline_close(simulation);
    }
}

#[test]
fn a_likely_mistake_in_a_parameter_is_told_at_the_start() {
    let simulation = read(SCENE);
    let before = warnings(simulation);
    let (reference, stiff) = (find(simulation, "chain.axial_stiffness"), 1e12);
    // SAFETY: arrays of one value.
    unsafe {
        let set = moorline_set(simulation, &raw const reference, &raw const stiff, 1);
        assert_eq!(set, MOORLINE_OK, "{}", message());
        assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK, "{}", message());
        let told = warnings(simulation);
        assert!(told.contains("axial_stiffness"), "{before} {told}");
        moorline_reset(simulation);
        assert_eq!(moorline_start(simulation, 0.0), MOORLINE_OK, "{}", message());
        assert_eq!(warnings(simulation), "");
        moorline_close(simulation);
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn elements_that_are_expected_to_miss_the_tolerance_are_told() {
    let open = SCENE.replace(", elements = 6", "");
    let motion =
        "motion.buoy = { x = [[2.0, 8.0]], ramp = 8.0 }\noutput.duration = 30.0\nsolver.tolerance = 1e-5\n";
    let simulation = read(&format!("{motion}{open}"));
    // SAFETY: a handle.
    unsafe {
        assert_eq!(moorline_select(simulation), MOORLINE_OK, "{}", message());
        let told = warnings(simulation);
        assert!(told.contains("above solver.tolerance = 0.00001"), "{told}");
        moorline_close(simulation);
    }
}

#[test]
fn the_equilibrium_is_written_as_json() {
    let simulation = read(SCENE);
    let mut needed = 0;
    // SAFETY: room for the text.
    unsafe {
        assert_eq!(
            moorline_statics(simulation, null_mut(), 0, &raw mut needed),
            MOORLINE_OK
        );
        let mut text = vec![0 as c_char; needed];
        assert_eq!(
            moorline_statics(simulation, text.as_mut_ptr(), needed, null_mut()),
            MOORLINE_OK
        );
        let text: String = text.iter().map(|c| char::from(*c as u8)).collect();
        assert!(text.starts_with('{') && text.contains("\"stiffness\""), "{text}");
        moorline_close(simulation);
    }
}

/// Makes calls in any order on handles that are open, closed or null, with arrays of any length up to their own.
fn assert_calm(sequences: usize, seed: u64) {
    let mut random = Random::new(seed);
    let mut below = move |count: usize| (random.unit() * count as f64) as usize;
    let mut handles = vec![null_mut(), without_provenance_mut(7)];
    let hosted = hosted();
    for _ in 0..sequences {
        handles.push(read(if below(2) == 0 { SCENE } else { &hosted }));
        for _ in 0..12 {
            let (handle, count, room) = (handles[below(handles.len())], below(8), below(64));
            let mut values = [0.01 * below(9) as f64; 64];
            values[below(64)] = [f64::NAN, 1e300, -1.0, 0.5][below(4)];
            let references: [u32; 64] = std::array::from_fn(|_| below(60) as u32);
            let (mut bytes, mut needed, mut text) = ([0_u8; 64], 0_usize, [0 as c_char; 64]);
            let out = if below(10) == 0 {
                null_mut()
            } else {
                values.as_mut_ptr()
            };
            // SAFETY: arrays have at least the lengths passed, or are null; handles may be anything.
            let code = unsafe {
                match below(16) {
                    0..=2 => moorline_start(handle, values[0]),
                    3 | 4 => moorline_step(handle, values[1]),
                    5 => moorline_set(handle, references.as_ptr(), out, count),
                    6 => moorline_get(handle, references.as_ptr(), out, count),
                    7 => moorline_set_inputs(handle, out, room),
                    8 => moorline_get_outputs(handle, out, room),
                    9 => moorline_move(handle, below(3), out, null(), count),
                    10 => moorline_force(handle, below(3), out, count),
                    11 => moorline_node_positions(handle, below(3), out, room),
                    12 => moorline_save(handle, bytes.as_mut_ptr(), below(64), &raw mut needed),
                    13 => moorline_restore(handle, bytes.as_ptr(), 64),
                    14 => moorline_variable_name(
                        handle,
                        references[0],
                        text.as_mut_ptr(),
                        room,
                        &raw mut needed,
                    ),
                    _ => match below(6) {
                        4 => moorline_flow_places(handle, below(3), out, room),
                        5 => moorline_set_flow(handle, below(3), out, values.as_ptr(), 21 + below(2)),
                        0 => moorline_reset(handle),
                        1 => moorline_time(handle, out),
                        2 => moorline_variable_count(handle, &raw mut needed),
                        _ => moorline_close(handle),
                    },
                }
            };
            assert!(
                (MOORLINE_OK..MOORLINE_INTERNAL_ERROR).contains(&code),
                "{code}: {}",
                message()
            );
        }
        if handles.len() > 6 {
            // SAFETY: handles may be anything.
            unsafe { moorline_close(handles.remove(2)) };
        }
    }
}

#[test]
fn random_sequences_of_calls_neither_panic_nor_crash() {
    assert_calm(200, 3);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn ten_thousand_random_sequences_of_calls_neither_panic_nor_crash() {
    assert_calm(10_000, 5);
}
