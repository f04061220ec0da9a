//! Static equilibrium of assembled lines, against closed forms, discrete solutions and random scenes.

mod common;

use common::*;
use moorline::elements::{Counters, Workspace, end_force};
use moorline::model::{End, Model, State};
use moorline::statics::StaticsError;
use moorline::statics::equilibrium::{continue_from, solve};
use nalgebra::Vector3;

fn equilibrium(model: &Model) -> Result<(State, Counters), StaticsError> {
    let mut work = Workspace::new(model);
    let state = solve(model, &resting(&at_reference(model)), 0.0, &mut work)?;
    Ok((state, work.take_counters()))
}

fn point(name: &str, position: [f64; 3], rest: &str) -> String {
    let [x, y, z] = position;
    format!("[[points]]\nname = \"{name}\"\nposition = [{x:e}, {y:e}, {z:e}]\n{rest}\n")
}

fn line(name: &str, ends: [&str; 2], length: f64, elements: usize) -> String {
    let [from, to] = ends;
    format!(
        "[[lines]]\nname = \"{name}\"\nfrom = \"{from}\"\nto = \"{to}\"\n\
         sections = [{{ type = \"cable\", length = {length:e}, elements = {elements} }}]\n"
    )
}

const FIXED: &str = "kind = \"fixed\"";

// ------------------------------------------------------------------ cable with a point load

/// RamSeries validation case 2: two elements, EA 5000 N, 1 m between the supports, straight and unstressed at the start; the load
/// pulls the middle down.
///
///   ●───────○───────●      L0/2 = 0.5 m each, λ = √(1 + 4u²/L0²), W = 4 (N/λ) u/L0
fn point_load(strain: &str, load: f64) -> Model {
    let text = format!("[line_types.cable]\nmass = 0.0\naxial_stiffness = 5000.0\nstrain = {strain}\n")
        + &point("a", [0.0; 3], FIXED)
        + &point(
            "middle",
            [0.5, 0.0, 0.0],
            &format!("kind = \"free\"\nforce = {{ z = {:e} }}", -load),
        )
        + &point("b", [1.0, 0.0, 0.0], FIXED)
        + &line("left", ["a", "middle"], 0.5, 1)
        + &line("right", ["middle", "b"], 0.5, 1);
    model(&text)
}

/// Load that goes with a deflection u, for a force N(ln λ) [N].
fn load_at(u: f64, force: impl Fn(f64) -> f64) -> f64 {
    let stretch = (1.0 + 4.0 * u * u).sqrt();
    4.0 * force(stretch) * u / stretch
}

/// Deflection under a load [m], by bisection of the closed form below `limit`.
fn deflection(load: f64, limit: f64, force: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, limit);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if load_at(middle, &force) < load {
            low = middle
        } else {
            high = middle
        }
    }
    low
}

const LOADS: [f64; 11] = [
    0.625, 5.0, 40.0, 135.0, 320.0, 625.0, 1080.0, 1715.0, 5000.0, 16875.0, 40000.0,
];

#[test]
fn green_strain_gives_the_cubic_load_deflection_for_all_eleven_loads() {
    for load in LOADS {
        let (state, counters) = equilibrium(&point_load("\"green\"", load)).unwrap();
        let u = -state.points[1].position.z;
        let expected = 8.0 * 5000.0 * u.powi(3);
        assert!((expected / load - 1.0).abs() < 1e-9, "W {load}: u {u}");
        assert!(counters.solves <= 27, "W {load}: {counters:?}");
    }
}

#[test]
fn engineering_and_logarithmic_strain_give_their_closed_forms() {
    let engineering = |stretch: f64| 5000.0 * (stretch - 1.0);
    let logarithmic = |poisson: f64| move |stretch: f64| 5000.0 * stretch.ln() * stretch.powf(-2.0 * poisson);
    for load in LOADS {
        let check = |strain: &str, expected: f64| {
            let (state, _) = equilibrium(&point_load(strain, load)).unwrap();
            let u = -state.points[1].position.z;
            assert!(
                (u / expected - 1.0).abs() < 1e-8,
                "{strain}, W {load}: {u} instead of {expected}"
            );
        };
        check("\"engineering\"", deflection(load, 100.0, engineering));
        check("{ logarithmic = 0.0 }", deflection(load, 100.0, logarithmic(0.0)));
        if load < 6030.789 {
            check(
                "{ logarithmic = 0.3 }",
                deflection(load, 2.852_857_8, logarithmic(0.3)),
            );
        }
        if load < 3454.579 {
            check(
                "{ logarithmic = 0.5 }",
                deflection(load, 1.467_144_9, logarithmic(0.5)),
            );
        }
    }
}

#[test]
fn just_below_the_limit_load_there_is_an_equilibrium_and_above_it_a_clear_error() {
    let limits = [
        ("{ logarithmic = 0.5 }", 3_454.579_352_43),
        ("{ logarithmic = 0.3 }", 6_030.789_759_239),
    ];
    for (strain, limit) in limits {
        equilibrium(&point_load(strain, limit * (1.0 - 1e-6))).unwrap();
        for factor in [1.0 + 1e-6, 1.01, 2.0, 11.0] {
            let error = equilibrium(&point_load(strain, factor * limit)).unwrap_err();
            let StaticsError::LimitLoad { load_fraction, .. } = error else {
                panic!("{error}")
            };
            assert!(
                (load_fraction * factor - 1.0).abs() < 1e-3 * factor,
                "{factor}: {error}"
            );
            assert!(error.to_string().contains("limit"), "{error}");
        }
    }
}

#[test]
fn a_line_pulled_by_more_than_its_greatest_force_is_refused_instead_of_breaking_in_one_segment() {
    let pulled = |load: f64| {
        let text =
            "[line_types.cable]\nmass = 0.0\naxial_stiffness = 5000.0\nstrain = { logarithmic = 0.5 }\n"
                .to_string()
                + &point("a", [0.0; 3], FIXED)
                + &point(
                    "b",
                    [1.0, 0.0, 0.0],
                    &format!("kind = \"free\"\nforce = {{ x = {load:e} }}"),
                )
                + &line("cable", ["a", "b"], 1.0, 10);
        equilibrium(&model(&text))
    };
    let greatest = 5000.0 / std::f64::consts::E; // EA ln λ/λ at λ = e [N]
    let (state, _) = pulled(0.999 * greatest).unwrap();
    assert!(state.points[1].position.x < std::f64::consts::E);
    let error = pulled(1.001 * greatest).unwrap_err();
    let StaticsError::LimitLoad { load_fraction, .. } = error else {
        panic!("{error}")
    };
    assert!((load_fraction * 1.001 - 1.0).abs() < 1e-3, "{error}");
}

// ------------------------------------------------------------------ cable under its own weight

/// SeaFEM validation case 11: length = span = 14.1421 m, EA 2505 N, w 0.49 N/m.
fn hanging(elements: usize) -> Model {
    let text = "[line_types.cable]\nweight = 0.49\naxial_stiffness = 2505.0\n".to_string()
        + &point("a", [0.0; 3], FIXED)
        + &point("b", [14.1421, 0.0, 0.0], FIXED)
        + &line("cable", ["a", "b"], 14.1421, elements);
    model(&text)
}

#[test]
fn a_cable_of_22_elements_hangs_by_its_discrete_sag_and_pulls_by_half_its_weight() {
    let model = hanging(22);
    let (state, counters) = equilibrium(&model).unwrap();
    let sag = -state.lines[0].position[11].z;
    assert!((sag - 0.718_274_162_1).abs() < 1e-9, "{sag}");
    let mut work = Workspace::new(&model);
    for end in [End::A, End::B] {
        let force = end_force(&model, &state, 0, end, &mut work);
        assert!((force.z + 0.5 * 0.49 * 14.1421).abs() < 1e-10, "{force}");
    }
    assert!(counters.solves <= 8, "{counters:?}");
}

#[test]
fn the_sag_tends_to_the_catenary_at_second_order() {
    let elements = [10.0, 22.0, 50.0, 100.0];
    let errors = elements.map(|n| {
        let (state, _) = equilibrium(&hanging(n as usize)).unwrap();
        -state.lines[0].position[n as usize / 2].z - 0.717_777_465_4
    });
    let slope = order(&elements.map(|n| 1.0 / n), &errors);
    assert!((slope - 2.0).abs() < 0.1, "slope {slope}, errors {errors:?}");
}

// ------------------------------------------------------------------ sliding collar

/// MotionSolve's wire: 20 m, 0.2 kg/m, one end fixed, the other on a collar that slides along x under a load that rises to 20 N
/// in 5 s.
fn collar(elements: usize, axial_stiffness: f64) -> Model {
    let slider = "kind = \"free\"\nfree = [\"x\"]\nforce = { x = { step = [0.0, 0.0, 5.0, 20.0] } }";
    let text =
        format!("gravity = 9.81\n[line_types.cable]\nmass = 0.2\naxial_stiffness = {axial_stiffness:e}\n")
            + &point("fixed", [0.0; 3], FIXED)
            + &point("collar", [16.0, 0.0, 0.0], slider)
            + &line("wire", ["fixed", "collar"], 20.0, elements);
    model(&text)
}

fn span_and_sag(model: &Model) -> [f64; 2] {
    let reference = at_reference(model);
    let mut work = Workspace::new(model);
    let mut state = solve(model, &resting(&reference), 0.0, &mut work).unwrap();
    work.take_counters();
    for step in 1..=100 {
        continue_from(model, &mut state, &reference, 0.1 * step as f64, &mut work).unwrap();
    }
    let total = work.take_counters();
    assert!(total.solves <= 1000, "{total:?}");
    let lowest = state.lines[0].position.iter().map(|r| r.z).fold(0.0, f64::min);
    [state.points[1].position.x, -lowest]
}

const COLLAR: [f64; 2] = [17.693_670_564, 4.086_064_837];

#[test]
fn a_collar_pulled_by_20_newtons_slides_to_the_inextensible_catenary() {
    let values = span_and_sag(&collar(20, 5.35e6));
    for (value, exact) in values.into_iter().zip(COLLAR) {
        assert!((value / exact - 1.0).abs() < 1e-3, "{values:?}");
    }
}

#[test]
fn the_collar_tends_to_the_inextensible_catenary_at_second_order_and_extrapolates_to_a_micrometre() {
    // An EA of 5.35e6 N would stretch the wire by 1e-4 m; 1e10 N by 6e-8 m.
    let elements = [24.0, 50.0, 100.0, 200.0];
    let values = elements.map(|n| span_and_sag(&collar(n as usize, 1e10)));
    for (axis, exact) in COLLAR.into_iter().enumerate() {
        let errors = values.map(|value| value[axis] - exact);
        let slope = order(&elements.map(|n| 1.0 / n), &errors);
        assert!((slope - 2.0).abs() < 0.1, "slope {slope}, errors {errors:?}");
        assert!(errors[3] / exact < 7e-6, "{errors:?}");
        let extrapolated = values[3][axis] + (values[3][axis] - values[2][axis]) / 3.0;
        assert!((extrapolated - exact).abs() < 1e-6, "{extrapolated}");
    }
}

// ------------------------------------------------------------------ invariants

/// A line of 12 elements with a bed below, in one piece or in two that meet in a free point.
fn piece_or_pieces(split: bool, reversed: bool) -> Model {
    let ends = |a: &'static str, b: &'static str| if reversed { [b, a] } else { [a, b] };
    let mut text = "[seabed]\ndepth = 3.0\nstiffness = 2.0e5\ncontact = \"as_given\"\n\
                    [line_types.cable]\nmass = 30.0\ndiameter = 0.05\naxial_stiffness = 1.0e6\n"
        .to_string()
        + &point("a", [0.0, 0.0, -3.0], FIXED)
        + &point("b", [10.0, 0.0, 0.0], FIXED);
    if split {
        text += &point("joint", [5.0, 0.0, -2.0], "kind = \"free\"");
        text += &line("upper", ends("joint", "b"), 4.0, 4);
        text += &line("lower", ends("a", "joint"), 8.0, 8);
    } else {
        text += &line("whole", ends("a", "b"), 12.0, 12);
    }
    model(&text)
}

#[test]
fn splitting_a_line_at_a_free_point_or_reversing_it_changes_nothing() {
    let (whole, _) = equilibrium(&piece_or_pieces(false, false)).unwrap();
    let (reversed, _) = equilibrium(&piece_or_pieces(false, true)).unwrap();
    let nodes = &whole.lines[0].position;
    let gap = |a: &Vector3<f64>, b: &Vector3<f64>| assert!((a - b).norm() < 1e-9, "{a} {b}");
    reversed.lines[0]
        .position
        .iter()
        .rev()
        .zip(nodes)
        .for_each(|(a, b)| gap(a, b));
    let (split, _) = equilibrium(&piece_or_pieces(true, false)).unwrap();
    split.lines[1]
        .position
        .iter()
        .zip(&nodes[..9])
        .for_each(|(a, b)| gap(a, b));
    split.lines[0]
        .position
        .iter()
        .zip(&nodes[8..])
        .for_each(|(a, b)| gap(a, b));
    gap(&split.points[2].position, &nodes[8]);
}

/// Three lines from corners to a loaded joint; `order` is the order of the lines, `mirror` the sign of y.
fn star(order: [usize; 3], mirror: f64) -> Model {
    let corners = [[-30.0, 5.0, 4.0], [25.0, 22.0, -3.0], [10.0, -31.0, 7.0]];
    let mut text = "[line_types.cable]\nmass = 8.0\naxial_stiffness = 2.0e6\n".to_string();
    for (i, [x, y, z]) in corners.into_iter().enumerate() {
        text += &point(&format!("corner{i}"), [x, mirror * y, z], FIXED);
    }
    let load = format!(
        "kind = \"free\"\nmass = 40.0\nforce = {{ x = 900.0, y = {:e} }}",
        mirror * 300.0
    );
    text += &point("joint", [0.0, mirror * 1.0, -3.0], &load);
    for i in order {
        text += &line(
            &format!("leg{i}"),
            [&format!("corner{i}"), "joint"],
            [35.0, 36.0, 33.0][i],
            6 + 3 * i,
        );
    }
    model(&text)
}

#[test]
fn the_order_of_lines_is_irrelevant_and_mirrored_scenes_have_mirrored_answers() {
    let joint = |model: &Model| equilibrium(model).unwrap().0.points[3].position;
    let reference = joint(&star([0, 1, 2], 1.0));
    assert!((joint(&star([2, 0, 1], 1.0)) - reference).norm() < 1e-9);
    let mirrored = joint(&star([0, 1, 2], -1.0));
    assert!((Vector3::new(mirrored.x, -mirrored.y, mirrored.z) - reference).norm() < 1e-9);
}

#[test]
fn continuing_from_a_state_finds_the_same_equilibrium_as_starting_anew() {
    let model = star([0, 1, 2], 1.0);
    let mut work = Workspace::new(&model);
    let mut points = at_reference(&model);
    let mut state = solve(&model, &resting(&points), 0.0, &mut work).unwrap();
    points[0] += Vector3::new(-1.0, 2.0, -3.0);
    continue_from(&model, &mut state, &points, 0.0, &mut work).unwrap();
    let anew = solve(&model, &resting(&points), 0.0, &mut work).unwrap();
    assert!((state.points[3].position - anew.points[3].position).norm() < 1e-8);
}

#[test]
fn a_failure_leaves_the_state_as_it_was() {
    let text = "[line_types.cable]\nmass = 1.0\naxial_stiffness = 5000.0\nstrain = { logarithmic = 0.5 }\n"
        .to_string()
        + &point("a", [0.0; 3], FIXED)
        + &point("b", [10.0, 0.0, 0.0], "kind = \"coupled\"")
        + &line("cable", ["a", "b"], 10.0, 10);
    let model = model(&text);
    let mut work = Workspace::new(&model);
    let mut state = statics(&model);
    let before = state.clone();
    let far = [Vector3::zeros(), Vector3::new(60.0, 0.0, 0.0)];
    let error = continue_from(&model, &mut state, &far, 1.0, &mut work).unwrap_err();
    assert!(error.to_string().contains("line \"cable\""), "{error}");
    assert_eq!(state, before);
    let nowhere = [Vector3::zeros(), Vector3::new(f64::NAN, 0.0, 0.0)];
    let error = continue_from(&model, &mut state, &nowhere, 1.0, &mut work).unwrap_err();
    assert!(error.to_string().contains("point \"b\", x"), "{error}");
    assert_eq!(state, before);
}

// ------------------------------------------------------------------ whatever comes

/// Slack to over-stretched, light to heavy, buoyant and weightless, EA 1e4 to 1e13 N, half of them over a bed.
fn random_line(seed: &mut u64, class: usize) -> Model {
    let mut u = || random(seed);
    let length = 10f64.powf(1.0 + 2.0 * u());
    let stretch = match class % 4 {
        0 => 0.2 * u(),
        1 => u(),
        2 => 0.95 + 0.1 * u(),
        _ => 1.0 + u(),
    };
    let angle = std::f64::consts::FRAC_PI_2 * (2.0 * u() - 1.0);
    let (x, z) = (stretch * length * angle.cos(), stretch * length * angle.sin());
    let sign = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, -1.0, 0.0][(8.0 * u()) as usize];
    let (weight, ea) = (sign * 10f64.powf(5.0 * u() - 1.0), 10f64.powf(4.0 + 9.0 * u()));
    let contact = if u() < 0.5 { "regularised" } else { "as_given" };
    let depth = -z.min(0.0) + if u() < 0.5 { 0.0 } else { 0.2 * length * u() };
    let mut text = String::new();
    if class.is_multiple_of(2) {
        text += &format!("[seabed]\ndepth = {depth:e}\ncontact = \"{contact}\"\n");
    }
    text += &format!(
        "[line_types.cable]\nweight = {weight:e}\nmass = 1.0\ndiameter = 0.1\naxial_stiffness = {ea:e}\n"
    );
    text += &point("a", [0.0; 3], FIXED);
    text += &point("b", [x, 0.0, z], FIXED);
    text += &line("cable", ["a", "b"], length, (2.0 + 60.0 * u()) as usize);
    model(&text)
}

#[test]
fn two_thousand_random_lines_are_all_solved_in_few_solves() {
    let mut seed = 1;
    let mut total = 0;
    for class in 0..2000 {
        let model = random_line(&mut seed, class);
        match equilibrium(&model) {
            Ok((_, counters)) => total += counters.solves,
            Err(error) => panic!("line {class}: {error}\n{model:?}"),
        }
    }
    assert!(total <= 10 * 2000, "{total} solves in all");
}

/// Two to four lines from random corners that meet in a free point, loaded or not, some on a slider, half of them over a bed.
fn random_network(seed: &mut u64, class: usize) -> Model {
    let mut u = || random(seed);
    let scale = 10f64.powf(1.0 + 1.5 * u());
    let (ea, weight) = (10f64.powf(4.0 + 8.0 * u()), 10f64.powf(3.0 * u()));
    let mut text = String::new();
    if u() < 0.5 {
        text += &format!("[seabed]\ndepth = {:e}\n", 1.2 * scale);
    }
    text += &format!(
        "[line_types.cable]\nweight = {weight:e}\nmass = 1.0\ndiameter = 0.1\naxial_stiffness = {ea:e}\n"
    );
    let corners: Vec<Vector3<f64>> = (0..2 + class % 3)
        .map(|_| Vector3::from_fn(|_, _| scale * (2.0 * u() - 1.0)))
        .collect();
    let middle: Vector3<f64> = corners.iter().sum::<Vector3<f64>>() / corners.len() as f64;
    let joint = middle + Vector3::from_fn(|_, _| 0.3 * scale * (u() - 0.5));
    let load = if u() < 0.5 { 0.0 } else { weight * scale * u() };
    let axes = if class.is_multiple_of(7) {
        "free = [\"x\", \"y\"]"
    } else {
        ""
    };
    let joint_rest = format!(
        "kind = \"free\"\nmass = {:e}\nforce = {{ x = {load:e} }}\n{axes}",
        0.1 * weight * scale * u()
    );
    text += &point("joint", joint.into(), &joint_rest);
    for (i, corner) in corners.iter().enumerate() {
        let name = format!("corner{i}");
        text += &point(&name, (*corner).into(), FIXED);
        let ends = if i % 2 == 0 {
            [name.as_str(), "joint"]
        } else {
            ["joint", name.as_str()]
        };
        let length = (joint - corner).norm() * (0.8 + 0.8 * u());
        text += &line(&format!("leg{i}"), ends, length, (1.0 + 30.0 * u()) as usize);
    }
    model(&text)
}

#[test]
fn a_thousand_random_networks_are_all_solved() {
    let mut seed = 5;
    let mut total = 0;
    for class in 0..1000 {
        let model = random_network(&mut seed, class);
        match equilibrium(&model) {
            Ok((_, counters)) => total += counters.solves,
            Err(error) => panic!("network {class}: {error}\n{model:?}"),
        }
    }
    assert!(total <= 27 * 1000, "{total} solves in all");
}

#[test]
fn a_bridle_shares_its_load_between_two_legs() {
    let text = "[line_types.cable]\nmass = 0.0\naxial_stiffness = 1.0e9\n".to_string()
        + &point("left", [0.0, -3.0, 0.0], FIXED)
        + &point("right", [0.0, 3.0, 0.0], FIXED)
        + &point("apex", [5.0, 1.0, 0.0], "kind = \"free\"")
        + &point("tow", [30.0, 0.0, 0.0], "kind = \"free\"\nforce = { x = 8000.0 }")
        + &line("port", ["left", "apex"], 5.0, 5)
        + &line("starboard", ["apex", "right"], 5.0, 4)
        + &line("main", ["apex", "tow"], 20.0, 10);
    let model = model(&text);
    let (state, _) = equilibrium(&model).unwrap();
    let apex = state.points[2].position;
    assert!((apex - Vector3::new(4.0, 0.0, 0.0)).norm() < 1e-4, "{apex}");
    let mut work = Workspace::new(&model);
    let leg = end_force(&model, &state, 0, End::A, &mut work);
    assert!((leg.norm() - 5000.0).abs() < 0.1, "{leg}");
}
