//! 6×6 stiffness of vessels: compared with differences of the force, with symmetry, and with published moorings.

use crate::common::{Draft, draft, greatest, start};
use approx::assert_relative_eq;
use moorline::math::attitude::angle_rates;
use moorline::scene::{MotionPath, Scene, part};
use moorline::simulation::Simulation;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// A pose without symmetries [m, rad].
const POSE: [f64; 6] = [0.6, -0.4, 0.3, 0.05, -0.08, 0.3];

/// Three lines on a seabed.
struct Deck {
    /// Radius and depth of the anchors [m].
    anchor: [f64; 2],
    fairlead: [f64; 2],
    length: f64,
    /// Mass in air [kg/m], weight in water [N/m] and axial stiffness [N].
    chain: [f64; 3],
    friction: f64,
    /// Heading of the first line [rad].
    heading: f64,
}

/// OC3 Hywind: Jonkman (2010), NREL/TP-500-47535.
const OC3: Deck = Deck {
    anchor: [853.87, 320.0],
    fairlead: [5.2, 70.0],
    length: 902.2,
    chain: [77.7066, 698.094, 384.243e6],
    friction: 0.001,
    heading: 0.0,
};

/// OC4 DeepCwind: Robertson et al. (2014), NREL/TP-5000-60601.
const OC4: Deck = Deck {
    anchor: [837.6, 200.0],
    fairlead: [40.868, 14.0],
    length: 835.5,
    chain: [113.35, 1065.7, 753.6e6],
    friction: 0.0,
    heading: std::f64::consts::FRAC_PI_3,
};

impl Deck {
    fn scene(&self, elements: usize, solver: &str) -> Scene {
        let [mass, weight, stiffness] = self.chain;
        let diameter = (4.0 * (mass - weight / 9.80665) / 1025.0 / std::f64::consts::PI).sqrt();
        let mut deck = draft(format!(
            "water = {{ density = 1025.0 }}
            seabed = {{ depth = {}, stiffness = 3e6, friction = {} }}
            solver = {{ {solver} }}
            vessels = [{{ name = 'platform', position = [0.0, 0.0, 0.0] }}]
            line_types.chain = {{ mass = {mass}, diameter = {diameter:?}, axial_stiffness = {stiffness:?} }}",
            self.anchor[1], self.friction
        ));
        for number in 0..3 {
            let angle = self.heading + std::f64::consts::TAU * f64::from(number) / 3.0;
            let at = |[radius, depth]: [f64; 2]| [radius * angle.cos(), radius * angle.sin(), -depth];
            let [anchor, fairlead] = ["anchor", "fairlead"].map(|name| format!("{name}{number}"));
            deck = on(
                deck.fixed(&anchor, at(self.anchor)),
                "platform",
                &fairlead,
                at(self.fairlead),
            );
            let name = format!("line{number}");
            deck = deck.line(&name, [&anchor, &fairlead], "chain", self.length, elements);
        }
        deck.scene()
    }
}

/// Adds a point on a vessel.
fn on(draft: Draft, vessel: &str, name: &str, position: [f64; 3]) -> Draft {
    draft.coupled(name, position).with(&format!("on = '{vessel}'"))
}

/// A bridle of two ropes to a clump on a chain, and a chain with both ends on the vessel.
fn bridle(solver: &str) -> Scene {
    let points = draft(format!(
        "solver = {{ {solver} }}
        vessels = [{{ name = 'barge', position = [0.0, 0.0, 0.0] }}]
        line_types.chain = {{ mass = 20.0, axial_stiffness = 1e6 }}
        line_types.rope = {{ mass = 2.0, axial_stiffness = 2e5 }}"
    ))
    .fixed("anchor", [60.0, 5.0, -40.0])
    .fixed("pile", [-50.0, -10.0, -30.0])
    .free("clump", [30.0, 1.0, -20.0])
    .with("mass = 300.0");
    let barge = on(points, "barge", "port", [4.0, 5.0, -1.0]);
    let barge = on(barge, "barge", "starboard", [4.0, -5.0, -1.0]);
    on(barge, "barge", "stern", [-6.0, 1.0, 0.5])
        .line("leg", ["anchor", "clump"], "chain", 38.0, 12)
        .line("left", ["clump", "port"], "rope", 34.0, 10)
        .line("right", ["starboard", "clump"], "rope", 34.0, 10)
        .line("aft", ["pile", "stern"], "chain", 56.0, 12)
        .line("loop", ["stern", "port"], "chain", 30.0, 12)
        .scene()
}

/// Cables clamped to the vessel at end A and at end B, and to the ground.
fn cables() -> Scene {
    let float = draft(
        "vessels = [{ name = 'float', position = [0.0, 0.0, 0.0] }]
        line_types.cable = { mass = 3.0, axial_stiffness = 1e6, bending_stiffness = 400.0 }",
    );
    let float = on(float, "float", "bow", [2.0, 0.5, -1.0]);
    on(float, "float", "stern", [-2.0, 0.0, -1.0])
        .fixed("east", [14.0, 3.0, -3.0])
        .fixed("west", [-14.0, -1.0, -4.0])
        .line("a", ["bow", "east"], "cable", 15.0, 15)
        .with("clamped_a = [0.6, 0.0, -0.8]")
        .line("b", ["west", "stern"], "cable", 16.0, 15)
        .with("clamped_b = [0.6, 0.0, 0.8], clamped_a = [0.0, 0.0, -1.0]")
        .scene()
}

fn posed(scene: &Scene, pose: [f64; 6]) -> Simulation {
    let mut simulation = start(scene);
    simulation.set_pose(0, pose);
    simulation.restart(0.0).unwrap();
    simulation
}

fn matrix(rows: [[f64; 6]; 6]) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| rows[i][j])
}

/// Negative derivative of the force with respect to displacements and rotations about the global axes, from central differences of equilibria.
fn differences(scene: &Scene, pose: [f64; 6], step: f64) -> Matrix6<f64> {
    let mut simulation = posed(scene, pose);
    let angles = Vector3::new(pose[3], pose[4], pose[5]);
    let mut force = |axis: usize, step: f64| {
        let mut moved = pose;
        match axis.checked_sub(3) {
            None => moved[axis] += step,
            Some(about) => {
                let spin = Matrix3::identity().column(about) * step;
                let turn = angle_rates(angles, spin).unwrap();
                (0..3).for_each(|i| moved[3 + i] += turn[i]);
            }
        }
        simulation.set_pose(0, moved);
        simulation.restart(0.0).unwrap();
        Vector6::from(simulation.vessel_force(0))
    };
    Matrix6::from_columns(
        &[0, 1, 2, 3, 4, 5].map(|axis| (force(axis, -step) - force(axis, step)) / (2.0 * step)),
    )
}

/// Greatest difference of the blocks of force and moment against displacement and rotation, each relative to its own norm [-].
fn difference(a: &Matrix6<f64>, b: &Matrix6<f64>) -> f64 {
    let blocks = [(0, 0), (0, 3), (3, 0), (3, 3)];
    let error = |(i, j): (usize, usize)| {
        let [a, b] = [a, b].map(|m| m.fixed_view::<3, 3>(i, j).into_owned());
        (a - b).norm() / b.norm()
    };
    greatest(blocks.map(error))
}

fn assert_is_slope(scene: &Scene, step: f64, tolerance: f64) {
    for pose in [[0.0; 6], POSE] {
        let stiffness = matrix(posed(scene, pose).vessel_stiffness(0).unwrap());
        let slope = differences(scene, pose, step);
        let error = difference(&stiffness, &slope);
        assert!(error < tolerance, "{error:e}: {stiffness} {slope}");
    }
}

#[test]
fn the_stiffness_of_elements_is_the_slope_of_their_force() {
    let smooth = Deck { friction: 0.0, ..OC3 };
    assert_is_slope(&smooth.scene(20, ""), 1e-4, 1e-5);
    assert_is_slope(&bridle(""), 1e-4, 1e-5);
    // Every equilibrium lays the lines anew on a seabed with friction, whereas the stiffness keeps their nodes in place:
    // 1.9e-4.
    assert_is_slope(&OC3.scene(20, ""), 1e-4, 1e-3);
}

#[test]
fn the_stiffness_in_a_current_has_the_change_of_the_drag() {
    // a light umbilical in a current of 2 m/s
    let barge = draft(
        "water = { density = 1025.0, surface = false, current = { velocity = [2.0, 0.0, 0.0] } }
        vessels = [{ name = 'barge', position = [0.0, 0.0, 0.0], attitude = [0.05, -0.1, 0.4] }]
        line_types.umbilical = { mass = 10.0, diameter = 0.1, axial_stiffness = 1e7, drag_normal = 1.2 }",
    )
    .fixed("end", [0.0, 0.0, -100.0]);
    let umbilical = on(barge, "barge", "hang", [56.0, -22.0, -4.0]);
    let scene = umbilical
        .line("umbilical", ["end", "hang"], "umbilical", 150.0, 60)
        .scene();
    let stiffness = matrix(posed(&scene, [0.0; 6]).vessel_stiffness(0).unwrap());
    // with a level reference attitude, since `differences` adds nothing to its angles
    let mut level = scene.clone();
    level.vessels[0].attitude = [0.0; 3];
    assert_is_slope(&level, 1e-2, 1e-3);
    let force = |z: f64| posed(&scene, [0.0, 0.0, z, 0.0, 0.0, 0.0]).vessel_force(0)[0];
    let slope = (force(-0.05) - force(0.05)) / 0.1;
    assert_relative_eq!(stiffness[(0, 2)], slope, max_relative = 1e-3);
    // drag is not conservative
    assert!((stiffness[(0, 2)] - stiffness[(2, 0)]).abs() > 0.5 * stiffness[(2, 2)].abs());
}

/// Four tendons of 80 m, stretched by 31 mm: they slacken where the platform turns by a thousandth.
#[test]
fn a_weak_current_changes_nothing_in_the_stiffness_of_short_tendons() {
    let stiffness = |water: &str| {
        let mut platform = draft(format!(
            "water = {{ density = 1025.0, surface = false{water} }}
            vessels = [{{ name = 'platform', position = [0.0, 0.0, 0.0] }}]
            line_types.tendon = {{ mass = 50.0, diameter = 0.25, axial_stiffness = 1e9, drag_normal = 1.0 }}"
        ));
        for (number, [x, y]) in [[40.0, 0.0], [0.0, 40.0], [-40.0, 0.0], [0.0, -40.0]]
            .into_iter()
            .enumerate()
        {
            let [foot, head] = ["foot", "head"].map(|name| format!("{name}{number}"));
            let moored = platform.fixed(&foot, [x, y, -80.0]);
            let held = on(moored, "platform", &head, [x, y, 0.0]);
            platform = held.line(&format!("tendon{number}"), [&foot, &head], "tendon", 79.969, 8);
        }
        matrix(posed(&platform.scene(), [0.0; 6]).vessel_stiffness(0).unwrap())
    };
    let still = stiffness("");
    let current = stiffness(", current = { velocity = [0.01, 0.0, 0.0] }");
    for axis in 0..6 {
        assert_relative_eq!(current[(axis, axis)], still[(axis, axis)], max_relative = 1e-3);
    }
}

#[test]
fn the_stiffness_of_catenaries_is_the_slope_of_their_force() {
    let solver = "integrator = \"quasi_static\"";
    assert_is_slope(&OC3.scene(20, solver), 1e-3, 1e-5);
    assert_is_slope(&bridle(solver), 1e-4, 1e-5);
}

#[test]
fn the_stiffness_of_clamped_cables_has_the_moments_of_their_clamps() {
    assert_is_slope(&cables(), 1e-5, 1e-5);
}

#[test]
fn the_stiffness_is_symmetric_but_for_the_moment_that_rotations_turn() {
    for scene in [bridle(""), bridle("integrator = \"quasi_static\""), cables()] {
        let simulation = posed(&scene, POSE);
        let stiffness = matrix(simulation.vessel_stiffness(0).unwrap());
        let [.., x, y, z] = simulation.vessel_force(0);
        let mut expected = Matrix6::zeros();
        let cross = Vector3::new(x, y, z).cross_matrix();
        expected.fixed_view_mut::<3, 3>(3, 3).copy_from(&cross);
        let error = (stiffness - stiffness.transpose() - expected).norm() / stiffness.norm();
        assert!(error < 1e-8, "{error:e}");
    }
}

#[test]
fn a_line_with_both_ends_on_a_vessel_holds_it_nowhere() {
    let crane = draft(
        "vessels = [{ name = 'crane', position = [1.0, 2.0, 3.0] }]
        line_types.chain = { mass = 20.0, axial_stiffness = 1e6 }",
    );
    let crane = on(crane, "crane", "left", [4.0, 0.0, 0.0]);
    let crane = on(crane, "crane", "right", [-4.0, 1.0, 2.0]);
    let simulation = crane.line("loop", ["left", "right"], "chain", 20.0, 10).start();
    let stiffness = matrix(simulation.vessel_stiffness(0).unwrap());
    let weight = 20.0 * 9.80665 * 20.0;
    let by_displacement = stiffness.fixed_columns::<3>(0).norm();
    assert!(by_displacement < 1e-6 * weight, "{by_displacement}");
    let yaw = stiffness.column(5).norm(); // a rotation about the vertical rotates the mooring as well
    let moment = Vector6::from(simulation.vessel_force(0))
        .fixed_rows::<3>(3)
        .norm();
    assert!(yaw < 1.001 * moment, "{yaw} {moment}");
}

#[test]
fn a_beam_pulls_a_vessel_with_the_force_of_its_elements() {
    let float = draft(
        "vessels = [{ name = 'float', position = [0.0, 0.0, 0.0] }]
        line_types.pipe = { model = 'beam', mass = 50.0, axial_stiffness = 1e8, diameter = 0.1,
          solid_section = { diameter = 0.05, youngs_modulus = 2.1e11, poisson = 0.3 } }",
    )
    .fixed("end", [100.0, 0.0, -30.0]);
    let scene = on(float, "float", "bow", [0.0; 3])
        .line("pipe", ["end", "bow"], "pipe", 110.0, 24)
        .scene();
    let simulation = start(&scene);
    let force = simulation.vessel_force(0);
    assert!(force[0] > 1e4 && force[2] < -1e4, "{force:?}");
    assert_eq!(simulation.on_catenaries().vessel_force(0), force);
}

#[test]
fn a_network_that_nothing_ties_to_a_vessel_does_not_hold_it() {
    let mut scene = OC3.scene(10, "");
    for point in &mut scene.points {
        point.on = None;
    }
    let simulation = start(&scene);
    assert_eq!(simulation.vessel_stiffness(0), Some([[0.0; 6]; 6]));
}

#[test]
fn the_stiffness_on_the_way_is_that_at_rest_where_lines_are_at_rest() {
    let scene = bridle("integrator = \"quasi_static\"");
    let mut simulation = start(&scene);
    simulation.set_pose(0, POSE);
    simulation.advance(1.0).unwrap();
    let rest = posed(&scene, POSE).vessel_stiffness(0).unwrap();
    let moved = simulation.vessel_stiffness(0).unwrap();
    let error = difference(&matrix(moved), &matrix(rest));
    assert!(error < 1e-8, "{error:e}");
}

#[test]
fn a_slack_line_holds_a_vessel_by_the_weight_that_heave_lifts() {
    let slack = Deck {
        anchor: [80.0, 50.0],
        fairlead: [10.0, 10.0],
        length: 180.0,
        chain: [77.7066, 698.094, 1e9],
        friction: 0.0,
        ..OC3
    };
    let simulation = start(&slack.scene(20, ""));
    let closed = simulation.clone().on_catenaries().vessel_stiffness(0).unwrap();
    assert_close(closed[2][2], 3.0 * slack.chain[1], 1e-3);
    assert!(closed[0][0].abs() < 1e-3 * closed[2][2]);
    let elements = matrix(simulation.vessel_stiffness(0).unwrap());
    assert!(elements.norm().is_finite());
}

#[test]
fn a_buoy_at_the_surface_stiffens_closed_forms_as_it_stiffens_elements() {
    let points = draft(
        "water = { density = 1025.0 }
        vessels = [{ name = 'barge', position = [0.0, 0.0, 0.0] }]
        line_types.chain = { mass = 20.0, diameter = 0.05, axial_stiffness = 5e7 }",
    )
    .fixed("anchor", [100.0, 0.0, -60.0])
    .free("buoy", [40.0, 0.0, -0.6])
    .with("mass = 9000.0, volume = 14.0");
    let scene = on(points, "barge", "fairlead", [0.0, 0.0, -2.0])
        .line("lower", ["anchor", "buoy"], "chain", 88.0, 60)
        .line("upper", ["buoy", "fairlead"], "chain", 41.0, 60)
        .scene();
    let simulation = start(&scene);
    let closed = simulation.clone().on_catenaries().vessel_stiffness(0);
    let [closed, solved] = [closed, simulation.vessel_stiffness(0)].map(|k| matrix(k.unwrap()));
    let error = difference(&closed, &solved);
    assert!(error < 2e-3, "{error:e}: {closed} {solved}");
}

/// Diagonal of the closed-form stiffness, and the vertical force [N/m, N m/rad, N].
fn published(deck: &Deck) -> ([f64; 6], f64) {
    let hung = start(&deck.scene(20, "")).on_catenaries();
    let (force, stiffness) = (hung.vessel_force(0), hung.vessel_stiffness(0).unwrap());
    ([0, 1, 2, 3, 4, 5].map(|i| stiffness[i][i]), force[2])
}

fn assert_close(value: f64, expected: f64, tolerance: f64) {
    let error = value / expected - 1.0;
    assert!(error.abs() < tolerance, "{value} is {error:.4} off {expected}");
}

#[test]
fn oc3_hywind_has_its_published_stiffness() {
    // Jonkman (2010), NREL/TP-500-47535, without the yaw spring that represents the crowfoot
    let (diagonal, vertical) = published(&OC3);
    let expected = [41_180.0, 41_180.0, 11_940.0, 311.1e6, 311.1e6, 11.56e6];
    diagonal
        .into_iter()
        .zip(expected)
        .for_each(|(value, expected)| assert_close(value, expected, 0.005));
    assert_close(vertical, -1.607e6, 0.005);
}

#[test]
fn oc4_deepcwind_has_its_published_stiffness() {
    // Robertson et al. (2014), NREL/TP-5000-60601
    let (diagonal, _) = published(&OC4);
    let expected = [7.08e4, 7.08e4, 1.91e4, 8.73e7, 8.73e7, 1.17e8];
    diagonal
        .into_iter()
        .zip(expected)
        .for_each(|(value, expected)| assert_close(value, expected, 0.01));
}

#[test]
fn elements_converge_to_the_stiffness_of_the_closed_form() {
    let frictionless = Deck { friction: 0.0, ..OC3 };
    let errors = [20, 160, 640].map(|elements| {
        let simulation = start(&frictionless.scene(elements, ""));
        let closed = simulation.clone().on_catenaries().vessel_stiffness(0);
        let [closed, solved] = [closed, simulation.vessel_stiffness(0)].map(|k| matrix(k.unwrap()));
        difference(&solved, &closed)
    });
    // irregular, since the node at the touchdown is either on the seabed or off it
    assert!(
        errors[0] < 0.08 && errors[1] < 0.015 && errors[2] < 0.001,
        "{errors:?}"
    );
}

#[test]
fn the_stiffness_in_a_current_is_that_of_the_present_pose_whoever_moves_the_vessel() {
    let mut scene = OC3.scene(12, "integrator = 'quasi_static'");
    scene.water.as_mut().unwrap().current = Some(part("velocity = [1.0, 0.2, 0.0]").unwrap());
    let pose = [8.0, 2.0, -1.0, 0.02, -0.05, 0.1];
    let rows = [[0.0; 6], pose].into_iter().zip([0.0, 4.0]);
    let rows = rows.map(|(pose, time)| std::array::from_fn(|i| if i == 0 { time } else { pose[i - 1] }));
    scene
        .motion
        .insert("platform".to_string(), MotionPath::Table(rows.collect()));
    let wanted = matrix(posed(&scene, pose).vessel_stiffness(0).unwrap());
    let at_reference = matrix(posed(&scene, [0.0; 6]).vessel_stiffness(0).unwrap());
    assert!(difference(&at_reference, &wanted) > 0.1);
    let mut following = start(&scene);
    following.follow_scene().unwrap();
    let mut hosted = start(&scene);
    hosted.set_pose(0, pose);
    for _ in 0..5 {
        following.advance(1.0).unwrap();
        hosted.advance(1.0).unwrap();
    }
    for simulation in [following, hosted] {
        let found = matrix(simulation.vessel_stiffness(0).unwrap());
        assert!(difference(&found, &wanted) < 1e-6, "{found} {wanted}");
    }
}
