//! Semantics of MoorDyn's interface: order of degrees of freedom, angles, forces, states, refusals.

use std::path::PathBuf;

use approx::assert_relative_eq;
use moorline_system::log::{Log, NONE};
use moorline_system::nodes::Quantity;
use moorline_system::objects::kind;
use moorline_system::settings::{Force, Path, Settings};
use moorline_system::{Code, System};

/// One coupled point, one coupled body with two points and one fixed body with one point; a free point between two lines.
const DECK: &str = "\
three lines
--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
- m kg/m N N-s N-m2 - - - -
chain 0.1 100 1E8 -0.8 0 1.6 1.0 0.1 0.0
--- BODIES ---
ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca
- - m m m deg deg deg kg m kg-m2 m3 m2 -
1 Fixed 100 0 -60 0 0 0 0 0 0 0 0 0
2 Coupled 0 0 -10 0 0 0 0 0 0 0 0 0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
- - m m m kg m3 m2 -
1 Body1 0 0 0 0 0 0 0
2 Coupled -4 0 -10 0 0 0 0
3 Body2 3 0 0 0 0 0 0
4 Fixed -100 0 -60 0 0 0 0
5 Free -50 0 -58 500 0.1 0 0
6 Body2 0 4 0 0 0 0 0
7 Fixed 0 100 -60 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
- - - - m - -
1 chain 1 3 115 8 -
2 chain 4 5 55 4 -
3 chain 5 2 68 4 -
4 chain 7 6 115 8 -
--- OPTIONS ---
60 WtrDpth
0.004 dtM
RK4 tScheme
--- end ---
";
const PLACE: [f64; 9] = [0.0, 0.0, -10.0, 0.0, 0.0, 0.0, -4.0, 0.0, -10.0];

struct Case {
    folder: tempfile::TempDir,
    system: System,
}

fn deck(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deck.txt");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

fn case_with(text: &str, settings: Settings) -> Case {
    let (folder, path) = deck(text);
    let system = System::create(&path, settings, Log::from_level(NONE)).unwrap();
    Case { folder, system }
}

fn case(text: &str) -> Case {
    case_with(text, Settings::default())
}

fn started() -> Case {
    let mut case = case(DECK);
    case.system.start(&PLACE, &[0.0; 9], false).unwrap();
    case
}

fn forces(system: &System) -> [f64; 9] {
    let mut forces = [0.0; 9];
    system.forces(&mut forces).unwrap();
    forces
}

/// Makes `count` steps of 0.02 s with a swaying and turning body and a swaying point; returns the forces [N, N m].
fn sway(system: &mut System, from: usize, count: usize) -> Vec<[f64; 9]> {
    let step = 0.02;
    let row = |k: usize| {
        let t = k as f64 * step;
        let (mut x, mut v) = (PLACE, [0.0; 9]);
        for (axis, size) in [(0, 0.5), (3, 0.05), (5, 0.04), (6, 0.4)] {
            x[axis] += size * (1.0 - t.cos());
            v[axis] = size * t.sin();
        }
        system.step(&x, &v, t, step).unwrap();
        forces(system)
    };
    (from..from + count).map(row).collect()
}

#[test]
fn bodies_come_before_points_in_the_order_of_degrees_of_freedom() {
    let case = started();
    let system = &case.system;
    assert_eq!(system.deck.degrees_of_freedom(), 9);
    assert_eq!(
        [0, 1].map(|body| system.body_type(body).unwrap()),
        [kind::FIXED, kind::COUPLED]
    );
    let kinds: Vec<i32> = (0..7).map(|point| system.point_type(point).unwrap()).collect();
    assert_eq!(
        kinds,
        [
            kind::FIXED,
            kind::COUPLED,
            kind::FIXED,
            kind::FIXED,
            kind::FREE,
            kind::FIXED,
            kind::FIXED
        ]
    );
    let all = forces(system);
    assert_eq!(system.body_force(1).unwrap(), all[..6]);
    assert_eq!(system.point_force(1).unwrap(), all[6..]);
    assert!(all[0] > 0.0 && all[6] < 0.0); // line 1 pulls to +x, line 3 to -x
    assert_eq!(system.point_attached(4).unwrap(), [(1, 1), (2, 0)]);
}

#[test]
fn before_the_start_points_and_bodies_are_where_the_deck_has_them_and_forces_are_refused() {
    let mut case = case(DECK);
    let places = |system: &System| [1, 2, 5].map(|point| system.point_state(point).unwrap());
    let (points, body) = (places(&case.system), case.system.body_state(1).unwrap());
    assert!(case.system.point_force(1).is_err());
    case.system.start(&PLACE, &[0.0; 9], false).unwrap();
    assert_eq!(
        points.map(|point| point.position),
        places(&case.system).map(|point| point.position)
    );
    assert_eq!(body, case.system.body_state(1).unwrap());
}

#[test]
fn the_force_on_a_body_has_the_inertia_of_the_nodes_that_it_carries() {
    let mut case = case(DECK);
    let step = 0.02;
    case.system.start(&PLACE, &[0.0; 9], false).unwrap();
    let (mut place, mut rate) = (PLACE, [0.0; 9]);
    for (k, faster) in [0.01, 0.03].into_iter().enumerate() {
        rate = rate.map(|rate| rate + faster);
        case.system.step(&place, &rate, k as f64 * step, step).unwrap();
        place = std::array::from_fn(|axis| place[axis] + step * rate[axis]);
    }
    let system = &case.system;
    let mut expected = nalgebra::Vector6::zeros();
    let turning = nalgebra::Vector3::new(rate[3], rate[4], rate[5]);
    for point in [2, 5] {
        let force = nalgebra::Vector3::from(system.point_force(point).unwrap());
        let arm = system.point_state(point).unwrap().position
            - nalgebra::Vector3::new(place[0], place[1], place[2]);
        let moment = arm.cross(&force);
        let mass = nalgebra::Matrix3::from(system.point_mass(point).unwrap()).transpose();
        let force = force - mass * turning.cross(&turning.cross(&arm)); // as in MoorDyn, without its moment
        expected += nalgebra::Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
    }
    let mass = nalgebra::Matrix6::from_fn(|row, column| system.body_mass(1).unwrap()[row][column]);
    let inertia = mass * nalgebra::Vector6::repeat(0.03 / step);
    expected -= inertia;
    let found = nalgebra::Vector6::from(system.body_force(1).unwrap());
    assert!((found - expected).norm() < 1e-9 * expected.norm());
    assert!(inertia.norm() > 1e-3 * expected.norm());
}

#[test]
fn the_moment_on_a_body_is_that_of_its_points_forces_at_turned_arms() {
    let mut case = case(DECK);
    let mut place = PLACE;
    (place[3], place[4], place[5]) = (0.2, -0.3, 0.4);
    case.system.start(&place, &[0.0; 9], false).unwrap();
    let system = &case.system;
    let [fx, fy, fz, mx, my, mz] = system.body_force(1).unwrap();
    let mut sum = nalgebra::Vector6::zeros();
    for point in [2, 5] {
        let force = nalgebra::Vector3::from(system.point_force(point).unwrap());
        let arm = system.point_state(point).unwrap().position - nalgebra::Vector3::new(0.0, 0.0, -10.0);
        let moment = arm.cross(&force);
        sum += nalgebra::Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
    }
    assert_relative_eq!(
        sum,
        nalgebra::Vector6::new(fx, fy, fz, mx, my, mz),
        max_relative = 1e-9
    );
    // R = Rx Ry Rz of (3, 0, 0): its first column times three
    let (b, c) = (place[4], place[5]);
    let arm = system.point_state(2).unwrap().position.x;
    assert_relative_eq!(arm, 3.0 * b.cos() * c.cos(), max_relative = 1e-12);
    assert_eq!(system.body_state(1).unwrap().place, place[..6]);
}

/// A cable clamped to the rod of a coupled body that is pitched by `pitch` [deg].
fn clamped_deck(pitch: f64) -> String {
    format!(
        "\
a clamped cable
--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
- m kg/m N N-s N-m2 - - - -
cable 0.2 80 5E7 -0.8 3E5 1.2 1.0 0.05 0.0
--- ROD TYPES ---
Name Diam Mass Cd Ca CdEnd CaEnd
- m kg/m - - - -
bar 0.25 100 0 0 0 0
--- BODIES ---
ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca
- - m m m deg deg deg kg m kg-m2 m3 m2 -
1 Coupled 0 0 -20 0 {pitch} 0 0 0 0 0 0 0
--- RODS ---
ID Type Attachment Xa Ya Za Xb Yb Zb NumSegs Outputs
- - - m m m m m m - -
1 bar Body1 0 0 0 1 0 0 0 -
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
- - m m m kg m3 m2 -
1 Fixed 60 0 -60 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
- - - - m - -
1 cable 1 R1B 75 20 -
--- OPTIONS ---
60 WtrDpth
--- end ---
"
    )
}

#[test]
fn a_clamp_turns_with_its_body_from_the_angles_of_the_deck_to_those_of_the_host() {
    let pitch = 20.0_f64;
    let place = [0.0, 0.0, -20.0, 0.1, pitch.to_radians(), 0.0];
    let force = |deck_pitch: f64| {
        let mut case = case(&clamped_deck(deck_pitch));
        case.system.start(&place, &[0.0; 6], false).unwrap();
        case.system.body_force(0).unwrap()
    };
    let [level, pitched] = [force(0.0), force(pitch)];
    for (one, other) in level.into_iter().zip(pitched) {
        assert!(
            (one - other).abs() < 1e-6 * pitched[0].abs(),
            "{level:?} {pitched:?}"
        );
    }
}

#[test]
fn a_smooth_path_of_a_turning_body_ends_where_its_angular_velocity_takes_it() {
    let settings = Settings {
        path: Path::Smooth,
        ..Settings::default()
    };
    let mut case = case_with(DECK, settings);
    let turn = nalgebra::UnitQuaternion::from_euler_angles;
    let mut place = PLACE;
    (place[3], place[4]) = (0.4, 0.3);
    case.system.start(&place, &[0.0; 9], false).unwrap();
    let mut rate = [0.0; 9];
    rate[3..6].copy_from_slice(&[0.2, -0.1, 0.3]); // [rad/s]
    let step = 0.1;
    case.system.step(&place, &rate, 0.0, step).unwrap();
    // R = Rx Ry Rz, turned about global axes
    let start = turn(0.4, 0.0, 0.0) * turn(0.0, 0.3, 0.0);
    let way = nalgebra::UnitQuaternion::from_scaled_axis(step * nalgebra::Vector3::new(0.2, -0.1, 0.3));
    for (point, arm) in [
        (2, nalgebra::Vector3::new(3.0, 0.0, 0.0)),
        (5, nalgebra::Vector3::new(0.0, 4.0, 0.0)),
    ] {
        let expected = nalgebra::Vector3::new(0.0, 0.0, -10.0) + way * start * arm;
        let found = case.system.point_state(point).unwrap().position;
        assert!((found - expected).norm() < 1e-9, "{found} {expected}");
    }
}

/// A chain with BA/EA = 0.02 s: axial damping carries the strain of a jump through several segments in a step of the host.
const DAMPED: &str = "\
a damped chain
--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
- m kg/m N N-s N-m2 - - - -
chain 0.17 183.4 4.39E8 8.75E6 0 2.4 0.7 0 0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
- - m m m kg m3 m2 -
1 Fixed 61.5 75.2 -40 0 0 0 0
2 Coupled 1.4 1.75 -9.9 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
- - - - m - -
1 chain 1 2 102.9 24 -
--- OPTIONS ---
40 WtrDpth
--- end ---
";

/// Forces on the fairlead of [`DAMPED`] [N] in the second half of a run with steps of `step` [s], at a tolerance.
fn damped(tolerance: f64, step: f64) -> Vec<f64> {
    let settings = Settings {
        tolerance,
        ..Settings::default()
    };
    let mut case = case_with(DAMPED, settings);
    let place = [1.4, 1.75, -9.9];
    case.system.start(&place, &[0.0; 3], false).unwrap();
    let count = (20.0 / step) as usize;
    let row = |k: usize| {
        let t = k as f64 * step;
        let (mut x, mut v) = (place, [0.0; 3]);
        for (axis, size, period) in [(0, 0.8, 10.0), (1, 0.6, 9.0), (2, 0.7, 11.0)] {
            let omega = 2.0 * std::f64::consts::PI / period;
            x[axis] += size * (1.0 - (omega * t).cos());
            v[axis] = size * omega * (omega * t).sin();
        }
        case.system.step(&x, &v, t, step).unwrap();
        let mut force = [0.0; 3];
        case.system.forces(&mut force).unwrap();
        nalgebra::Vector3::from(force).norm()
    };
    let all: Vec<f64> = (0..count).map(row).collect();
    all[count / 2..].to_vec()
}

#[test]
fn a_heavily_damped_line_keeps_the_tolerance_where_velocities_jump() {
    for step in [0.005, 0.01, 0.02] {
        let [default, exact] = [Settings::default().tolerance, 5e-5].map(|tolerance| damped(tolerance, step));
        let count = exact.len() as f64;
        let mean = exact.iter().sum::<f64>() / count;
        let square = |values: &mut dyn Iterator<Item = f64>| values.map(|x| x * x).sum::<f64>() / count;
        let deviation = square(&mut exact.iter().map(|x| x - mean));
        let error = square(&mut default.iter().zip(&exact).map(|(a, b)| a - b));
        let error = (error / deviation).sqrt();
        assert!(error < 0.005, "{step} s: {error}");
    }
}

#[test]
fn the_forces_on_a_node_add_up_to_its_mass_times_its_acceleration() {
    let mut case = started();
    sway(&mut case.system, 0, 40);
    let before = case.system.node_vector(0, 4, Quantity::Velocity).unwrap();
    let force = case.system.node_vector(0, 4, Quantity::Force).unwrap();
    sway(&mut case.system, 40, 1);
    let after = case.system.node_vector(0, 4, Quantity::Velocity).unwrap();
    let mass = case.system.node_mass(0, 4).unwrap();
    let weight = case.system.node_vector(0, 4, Quantity::Weight).unwrap()[2].abs();
    for axis in 0..3 {
        let inertia: f64 = (0..3)
            .map(|i| mass[axis][i] * (after[i] - before[i]) / 0.02)
            .sum();
        assert!(
            (force[axis] - inertia).abs() < 0.02 * weight,
            "{axis}: {} {inertia}",
            force[axis]
        );
    }
}

#[test]
fn a_coupled_point_is_where_constant_velocity_takes_it() {
    for path in [Path::Jump, Path::Smooth] {
        let settings = Settings {
            path,
            ..Settings::default()
        };
        let mut case = case_with(DECK, settings);
        case.system.start(&PLACE, &[0.0; 9], false).unwrap();
        let mut velocity = [0.0; 9];
        velocity[6] = 0.3;
        case.system.step(&PLACE, &velocity, 0.0, 0.1).unwrap();
        let place = case.system.point_state(1).unwrap().position;
        assert_relative_eq!(place.x, -4.0 + 0.03, max_relative = 1e-12);
    }
}

#[test]
fn a_reaction_has_the_inertia_of_the_end_nodes_and_a_nodal_force_has_not() {
    let of = |force| {
        let settings = Settings {
            force,
            path: Path::Smooth,
            ..Settings::default()
        };
        let mut case = case_with(DECK, settings);
        case.system.start(&PLACE, &[0.0; 9], false).unwrap();
        sway(&mut case.system, 0, 50).pop().unwrap()
    };
    let (nodal, reaction) = (of(Force::Nodal), of(Force::Reaction));
    let mean = 68.0 / 8.0 * 100.0; // mass of half a segment [kg]
    let difference = (nodal[6] - reaction[6]).abs();
    let acceleration = 0.4; // upper bound for the point [m/s²]
    assert!(
        difference > 0.0 && difference < 5.0 * mean * acceleration,
        "{difference}"
    );
}

#[test]
fn a_state_goes_on_bit_for_bit_in_this_system_and_in_another_one() {
    let mut case = started();
    sway(&mut case.system, 0, 10);
    let words = case.system.serialize().unwrap();
    let path = case.folder.path().join("state");
    case.system.save(&path).unwrap();
    let first = sway(&mut case.system, 10, 10);
    case.system.deserialize(&words).unwrap();
    assert!(sway(&mut case.system, 10, 10) == first);
    let mut other = System::create(
        &case.folder.path().join("deck.txt"),
        Settings::default(),
        Log::from_level(NONE),
    )
    .unwrap();
    other.load(&path).unwrap();
    assert!(sway(&mut other, 10, 10) == first);
    let mut elsewhere = System::create(
        &case.folder.path().join("deck.txt"),
        Settings::default(),
        Log::from_level(NONE),
    )
    .unwrap();
    elsewhere
        .start(&PLACE.map(|value| value + 0.01), &[0.0; 9], true)
        .unwrap();
    elsewhere.load(&path).unwrap();
    assert!(sway(&mut elsewhere, 10, 10) == first);
}

#[test]
fn a_state_of_another_deck_and_damaged_words_are_refused_and_change_nothing() {
    let mut case = started();
    sway(&mut case.system, 0, 3);
    let words = case.system.serialize().unwrap();
    for (at, bit) in [(0, 3), (1, 2), (2, 0), (10, 17)] {
        let mut damaged = words.clone();
        damaged[at] ^= 1 << bit;
        let failure = case.system.deserialize(&damaged).unwrap_err();
        assert_eq!(failure.code, Code::InvalidInput, "{failure}");
    }
    assert_eq!(case.system.serialize().unwrap(), words);
    let mut longer = self::case(&DECK.replace("115 8", "116 8"));
    longer.system.start(&PLACE, &[0.0; 9], false).unwrap();
    let failure = longer.system.deserialize(&words).unwrap_err();
    assert!(failure.message.contains("another deck"), "{failure}");
}

#[test]
fn a_line_that_breaks_off_pulls_no_more() {
    let mut case = started();
    sway(&mut case.system, 0, 5);
    let before = forces(&case.system)[6];
    let wrong = case.system.break_line(1, 0).unwrap_err();
    assert_eq!(wrong.code, Code::InvalidInput);
    case.system.break_line(1, 2).unwrap();
    let after = sway(&mut case.system, 5, 5);
    assert!(
        before < -1000.0 && after.iter().all(|force| force[6] == 0.0),
        "{before}"
    );
    let words = case.system.serialize().unwrap();
    let rest = sway(&mut case.system, 10, 3);
    case.system.deserialize(&words).unwrap();
    assert!(sway(&mut case.system, 10, 3) == rest);
}

#[test]
fn lines_are_changed_before_the_start_and_refused_after_it() {
    let mut case = case(DECK);
    let system = &mut case.system;
    system.set_unstretched_length(0, 118.0).unwrap();
    system.set_constant_stiffness(0, 2e8).unwrap();
    assert_eq!(system.unstretched_length(0).unwrap(), 118.0);
    assert_eq!(
        [0, 1].map(|line| system.constant_stiffness(line).unwrap()),
        [2e8, 1e8]
    );
    system.start(&PLACE, &[0.0; 9], false).unwrap();
    assert_eq!(
        system.set_unstretched_length(0, 119.0).unwrap_err().code,
        Code::NotImplemented
    );
    system.set_unstretched_length(0, 118.0).unwrap(); // no change
    assert_eq!(
        system.set_constant_stiffness(0, -1.0).unwrap_err().code,
        Code::InvalidValue
    );
}

#[test]
fn what_is_not_modelled_and_what_is_no_deck_is_refused_with_a_sentence() {
    for (from, to, code, words) in [
        (
            "2 Coupled 0 0 -10",
            "2 Free 0 0 -10",
            Code::InvalidInputFile,
            "a free body is not modelled",
        ),
        (
            "60 WtrDpth",
            "1 WaveKin\n60 WtrDpth",
            Code::InvalidInputFile,
            "WaveKin",
        ),
        ("2 Coupled -4", "2 Turbine1 -4", Code::NotImplemented, "farm"),
        (
            "chain 0.1 100",
            "chain 0.1 heavy",
            Code::InvalidInputFile,
            "heavy",
        ),
    ] {
        let (_folder, path) = deck(&DECK.replace(from, to));
        let failure = System::create(&path, Settings::default(), Log::from_level(NONE)).unwrap_err();
        assert_eq!(failure.code, code, "{failure}");
        assert!(failure.message.contains(words), "{failure}");
    }
}

#[test]
fn vessel_points_are_coupled_points_with_degrees_of_freedom_of_their_own() {
    let case = case(&DECK.replace("2 Coupled -4", "2 Vessel -4"));
    assert_eq!(case.system.deck.degrees_of_freedom(), 9);
    assert_eq!(case.system.point_type(1).unwrap(), kind::COUPLED);
}

#[test]
fn arguments_that_cannot_be_used_leave_the_state() {
    let mut case = started();
    let words = case.system.serialize().unwrap();
    let mut wrong = PLACE;
    wrong[2] = f64::NAN;
    for (x, v, t, dt) in [
        (&PLACE[..8], &[0.0; 9][..], 0.0, 0.1),
        (&wrong[..], &[0.0; 9][..], 0.0, 0.1),
        (&PLACE[..], &[0.0; 9][..], f64::NAN, 0.1),
        (&PLACE[..], &[0.0; 9][..], 0.0, -0.1),
    ] {
        assert_eq!(
            case.system.step(x, v, t, dt).unwrap_err().code,
            Code::InvalidValue
        );
    }
    assert_eq!(case.system.serialize().unwrap(), words);
    let present = forces(&case.system);
    case.system.step(&PLACE, &[0.0; 9], 0.0, 0.0).unwrap();
    assert_eq!(forces(&case.system), present);
}

#[test]
fn the_host_may_begin_at_any_time() {
    let mut case = started();
    let end = case.system.step(&PLACE, &[0.0; 9], 100.0, 0.1).unwrap();
    assert_relative_eq!(end, 100.1, max_relative = 1e-12);
    assert_relative_eq!(case.system.time().unwrap(), 100.1, max_relative = 1e-12);
}

#[test]
fn a_coupled_point_that_jumps_is_noted_once_in_the_log() {
    let (folder, path) = deck(DECK);
    let log = folder.path().join("log.txt");
    let mut system = System::create(&path, Settings::default(), Log::from_level(NONE)).unwrap();
    system.log.set_file(&log).unwrap();
    system.start(&PLACE, &[0.0; 9], false).unwrap();
    let mut place = PLACE;
    place[6] -= 14.0;
    let mut velocity = [0.0; 9];
    velocity[6] = -14.0;
    system.step(&PLACE, &velocity, 0.0, 1.0).unwrap();
    system.step(&place, &[0.0; 9], 1.0, 1.0).unwrap();
    let log = std::fs::read_to_string(log).unwrap();
    assert_eq!(
        log.matches("has moved by 14.000 m in one communication step")
            .count(),
        1,
        "{log}"
    );
}

#[test]
fn samples_too_few_for_a_path_that_jumps_are_noted_with_the_variable_that_sets_the_path() {
    let (folder, path) = deck(DECK);
    let log = folder.path().join("log.txt");
    let mut system = System::create(&path, Settings::default(), Log::from_level(NONE)).unwrap();
    system.log.set_file(&log).unwrap();
    system.start(&PLACE, &[0.0; 9], false).unwrap();
    let (rate, step) = (std::f64::consts::TAU / 10.0, 0.4);
    for k in 0..200 {
        let time = f64::from(k) * step;
        let (mut place, mut velocity) = (PLACE, [0.0; 9]);
        place[6] += 0.5 * (1.0 - (rate * time).cos());
        velocity[6] = 0.5 * rate * (rate * time).sin();
        system.step(&place, &velocity, time, step).unwrap();
    }
    let log = std::fs::read_to_string(log).unwrap();
    for words in [
        "are too few for a path that jumps at each of them",
        "set MOORLINE_PATH=smooth",
    ] {
        assert_eq!(log.matches(words).count(), 1, "{log}");
    }
}

#[test]
fn a_line_that_breaks_off_before_the_first_step_stays_off_where_the_host_begins_later() {
    let (folder, path) = deck(&DECK.replace("60 WtrDpth", "60 WtrDpth\n7 WaveKin"));
    std::fs::write(
        folder.path().join("wave_frequencies.txt"),
        "0.0 0.0 0.0\n0.6 0.0 0.5\n",
    )
    .unwrap();
    let mut system = System::create(&path, Settings::default(), Log::from_level(NONE)).unwrap();
    system.start(&PLACE, &[0.0; 9], false).unwrap();
    system.break_line(1, 2).unwrap();
    system.step(&PLACE, &[0.0; 9], 5.0, 0.1).unwrap();
    assert_eq!(forces(&system)[6], 0.0);
}

#[test]
fn a_step_that_the_host_repeats_is_written_again_as_by_moordyn() {
    let channels = "--- OUTPUTS ---\nFairTen3\n--- OPTIONS ---\n0.1 dtOut\n0 WriteUnits";
    let (folder, path) = deck(&DECK.replace("--- OPTIONS ---", channels));
    let mut system = System::create(&path, Settings::default(), Log::from_level(NONE)).unwrap();
    system.start(&PLACE, &[0.0; 9], false).unwrap();
    let (mut place, mut last) = (PLACE, Vec::new());
    for k in 0..3 {
        let state = system.serialize().unwrap();
        let mut rate = [0.0; 9];
        rate[6] = -2.0;
        system.step(&place, &rate, 0.1 * f64::from(k), 0.1).unwrap();
        system.deserialize(&state).unwrap();
        rate[6] = -0.5;
        system.step(&place, &rate, 0.1 * f64::from(k), 0.1).unwrap();
        place[6] -= 0.05;
        let [x, _, z] = [6, 7, 8].map(|axis| forces(&system)[axis]);
        last.push(x.hypot(z));
    }
    drop(system);
    let table = std::fs::read_to_string(folder.path().join("deck.out")).unwrap();
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|row| row.split_whitespace().map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 0.1, 0.1, 0.2, 0.2, 0.3, 0.3]);
    for (k, tension) in last.into_iter().enumerate() {
        assert_relative_eq!(rows[2 * k + 2][1], tension, max_relative = 1e-6);
        assert!((rows[2 * k + 1][1] / tension - 1.0).abs() > 1e-3);
    }
}

#[test]
fn the_force_on_a_free_point_at_rest_is_zero_with_its_own_weight_and_the_seabed() {
    let case = started();
    let force = case.system.point_force(4).unwrap();
    let weight = (500.0 - 0.1 * 1025.0) * 9.81;
    assert!(force.iter().all(|part| part.abs() < 1e-4 * weight), "{force:?}");
}

#[test]
fn the_seabed_has_heights_that_are_negative_below_still_water() {
    let system = started().system;
    assert_eq!(system.depth_at(1.0, 2.0).unwrap(), -60.0);
    assert_eq!(system.depths().unwrap(), [-60.0; 2]);
}
