//! Static equilibrium of assembled lines, against closed forms, discrete solutions and random scenes.

use crate::common::*;
use moorline::elements::{Counters, Workspace, end_force};
use moorline::model::{End, Model, State};
use moorline::statics::StaticsError;
use moorline::statics::equilibrium::solve;
use nalgebra::Vector3;

fn equilibrium(model: &Model) -> Result<(State, Counters), StaticsError> {
    let mut work = Workspace::new(model);
    let state = solve(model, &resting(&at_reference(model)), 0.0, &mut work)?;
    Ok((state, work.take_counters()))
}

/// The load fraction that can be carried according to an error, times `factor` [-].
fn carried(error: StaticsError, factor: f64) -> f64 {
    assert!(error.to_string().contains("limit"), "{error}");
    let StaticsError::LimitLoad { load_fraction, .. } = error else {
        panic!("{error}")
    };
    load_fraction * factor
}

// ------------------------------------------------------------------ cable with a point load

/// RamSeries validation case 2: two elements, EA 5000 N, 1 m between the supports, initially straight and unstressed; the load
/// pulls the middle down.
///
///   ●───────○───────●      L0/2 = 0.5 m each, λ = √(1 + 4u²/L0²), W = 4 (N/λ) u/L0
fn point_load(strain: &str, load: f64) -> Model {
    draft(format!(
        "line_types.cable = {{ mass = 0.0, axial_stiffness = 5000.0, strain = {strain} }}"
    ))
    .fixed("a", [0.0; 3])
    .free("middle", [0.5, 0.0, 0.0])
    .with(&format!("force = {{ z = {:e} }}", -load))
    .fixed("b", [1.0, 0.0, 0.0])
    .line("left", ["a", "middle"], "cable", 0.5, 1)
    .line("right", ["middle", "b"], "cable", 0.5, 1)
    .model()
}

/// Deflection [m] under a load [N], from the closed form below `limit` [m] with an axial force N(λ) [N].
fn deflection(load: f64, limit: f64, force: impl Fn(f64) -> f64) -> f64 {
    bisect([0.0, limit], |u| {
        let stretch = (1.0 + 4.0 * u * u).sqrt();
        4.0 * force(stretch) * u / stretch - load
    })
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
                "{strain}, W {load}: {u} for {expected}"
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
            let carried = carried(error, factor);
            assert!((carried - 1.0).abs() < 1e-3 * factor, "{factor}: {carried}");
        }
    }
}

#[test]
fn a_line_pulled_by_more_than_its_greatest_force_is_refused_instead_of_breaking_in_one_segment() {
    let pulled = |load: f64| {
        let cable = "{ mass = 0.0, axial_stiffness = 5000.0, strain = { logarithmic = 0.5 } }";
        let model = draft(format!("line_types.cable = {cable}"))
            .fixed("a", [0.0; 3])
            .free("b", [1.0, 0.0, 0.0])
            .with(&format!("force = {{ x = {load:e} }}"))
            .line("cable", ["a", "b"], "cable", 1.0, 10);
        equilibrium(&model.model())
    };
    let greatest = 5000.0 / std::f64::consts::E; // EA ln λ/λ at λ = e [N]
    let (state, _) = pulled(0.999 * greatest).unwrap();
    assert!(state.points[1].position.x < std::f64::consts::E);
    let carried = carried(pulled(1.001 * greatest).unwrap_err(), 1.001);
    assert!((carried - 1.0).abs() < 1e-3, "{carried}");
}

// ------------------------------------------------------------------ cable under its own weight

/// SeaFEM validation case 11: length = span = 14.1421 m, EA 2505 N, w 0.49 N/m.
fn hanging(elements: usize) -> Model {
    draft("line_types.cable = { weight = 0.49, axial_stiffness = 2505.0 }")
        .fixed("a", [0.0; 3])
        .fixed("b", [14.1421, 0.0, 0.0])
        .line("cable", ["a", "b"], "cable", 14.1421, elements)
        .model()
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
    assert_orders(
        2.0,
        &[10, 22, 50, 100].map(|n| {
            let (state, _) = equilibrium(&hanging(n)).unwrap();
            (
                1.0 / n as f64,
                -state.lines[0].position[n / 2].z - 0.717_777_465_4,
            )
        }),
    );
}

// ------------------------------------------------------------------ sliding collar

/// Span and sag [m] of MotionSolve's wire: 20 m, 0.2 kg/m, one end fixed, the other on a collar that slides along x under a load that increases
/// to 20 N within 5 s.
fn collar(elements: usize, axial_stiffness: f64) -> [f64; 2] {
    let wire = format!("{{ mass = 0.2, axial_stiffness = {axial_stiffness:e} }}");
    let model = draft(format!("gravity = 9.81\nline_types.cable = {wire}"))
        .fixed("fixed", [0.0; 3])
        .free("collar", [16.0, 0.0, 0.0])
        .with("free = ['x'], force = { x = { step = [0.0, 0.0, 5.0, 20.0] } }")
        .line("wire", ["fixed", "collar"], "cable", 20.0, elements)
        .model();
    let reference = at_reference(&model);
    let mut work = Workspace::new(&model);
    let mut state = solve(&model, &resting(&reference), 0.0, &mut work).unwrap();
    work.take_counters();
    for step in 1..=100 {
        continue_from(&model, &mut state, &reference, 0.1 * step as f64, &mut work).unwrap();
    }
    let total = work.take_counters();
    assert!(total.solves <= 1000, "{total:?}");
    [
        state.points[1].position.x,
        greatest(state.lines[0].position.iter().map(|r| -r.z)),
    ]
}

const COLLAR: [f64; 2] = [17.693_670_564, 4.086_064_837];

#[test]
fn a_collar_pulled_by_20_newtons_slides_to_the_inextensible_catenary() {
    let values = collar(20, 5.35e6);
    for (value, exact) in values.into_iter().zip(COLLAR) {
        assert!((value / exact - 1.0).abs() < 1e-3, "{values:?}");
    }
}

#[test]
fn the_collar_tends_to_the_inextensible_catenary_at_second_order_and_extrapolates_to_a_micrometre() {
    // An EA of 5.35e6 N would stretch the wire by 1e-4 m; 1e10 N by 6e-8 m.
    let elements = [24, 50, 100, 200];
    let values = elements.map(|n| collar(n, 1e10));
    for (axis, exact) in COLLAR.into_iter().enumerate() {
        let errors = values.map(|value| value[axis] - exact);
        assert_order(2.0, &elements.map(|n| 1.0 / n as f64), &errors);
        assert!(errors[3] / exact < 7e-6, "{errors:?}");
        let extrapolated = values[3][axis] + (values[3][axis] - values[2][axis]) / 3.0;
        assert!((extrapolated - exact).abs() < 1e-6, "{extrapolated}");
    }
}

// ------------------------------------------------------------------ invariants

/// A line of 12 elements above a seabed, in one piece or in two joined at a free point.
fn piece_or_pieces(split: bool, reversed: bool) -> Model {
    let ends = |a: &'static str, b: &'static str| if reversed { [b, a] } else { [a, b] };
    let seabed = draft(
        "seabed = { depth = 3.0, stiffness = 2.0e5, contact = 'as_given' }
        line_types.cable = { mass = 30.0, diameter = 0.05, axial_stiffness = 1.0e6 }",
    )
    .fixed("a", [0.0, 0.0, -3.0])
    .fixed("b", [10.0, 0.0, 0.0]);
    let lines = match split {
        true => seabed
            .free("joint", [5.0, 0.0, -2.0])
            .line("upper", ends("joint", "b"), "cable", 4.0, 4)
            .line("lower", ends("a", "joint"), "cable", 8.0, 8),
        false => seabed.line("whole", ends("a", "b"), "cable", 12.0, 12),
    };
    lines.model()
}

#[test]
fn splitting_a_line_at_a_free_point_or_reversing_it_changes_nothing() {
    let [whole, reversed, split] = [(false, false), (false, true), (true, false)]
        .map(|(split, reversed)| equilibrium(&piece_or_pieces(split, reversed)).unwrap().0);
    let nodes = &whole.lines[0].position;
    let backwards: Vec<Vector3<f64>> = reversed.lines[0].position.iter().rev().copied().collect();
    assert!(gap(&backwards, nodes) < 1e-9);
    assert!(gap(&split.lines[1].position, &nodes[..9]) < 1e-9);
    assert!(gap(&split.lines[0].position, &nodes[8..]) < 1e-9);
    assert!((split.points[2].position - nodes[8]).norm() < 1e-9);
}

/// Three lines from corners to a loaded joint; `order` is the order of the lines and `mirror` the sign of y.
fn star(order: [usize; 3], mirror: f64) -> Model {
    let corners = [[-30.0, 5.0, 4.0], [25.0, 22.0, -3.0], [10.0, -31.0, 7.0]];
    let mut star = draft("line_types.cable = { mass = 8.0, axial_stiffness = 2.0e6 }");
    for (i, [x, y, z]) in corners.into_iter().enumerate() {
        star = star.fixed(&format!("corner{i}"), [x, mirror * y, z]);
    }
    let load = format!("mass = 40.0, force = {{ x = 900.0, y = {:e} }}", mirror * 300.0);
    star = star.free("joint", [0.0, mirror * 1.0, -3.0]).with(&load);
    for i in order {
        let ends = [&format!("corner{i}"), "joint"];
        star = star.line(
            &format!("leg{i}"),
            ends,
            "cable",
            [35.0, 36.0, 33.0][i],
            6 + 3 * i,
        );
    }
    star.model()
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
    let cable = "{ mass = 1.0, axial_stiffness = 5000.0, strain = { logarithmic = 0.5 } }";
    let model = draft(format!("line_types.cable = {cable}"))
        .fixed("a", [0.0; 3])
        .coupled("b", [10.0, 0.0, 0.0])
        .line("cable", ["a", "b"], "cable", 10.0, 10)
        .model();
    let mut work = Workspace::new(&model);
    let mut state = statics(&model);
    let before = state.clone();
    let places = [60.0, f64::NAN].map(|x| [Vector3::zeros(), Vector3::new(x, 0.0, 0.0)]);
    let error = continue_from(&model, &mut state, &places[0], 1.0, &mut work).unwrap_err();
    assert_says(&error.to_string(), &["line \"cable\""]);
    assert_eq!(state, before);
    let error = solve(&model, &resting(&places[1]), 1.0, &mut work).unwrap_err();
    assert_says(&error.to_string(), &["point \"b\", x"]);
}

// ------------------------------------------------------------------ random scenes

/// A cable of a weight [N/m] and EA [N], over a seabed with these keys if given.
fn cable(weight: f64, ea: f64, seabed: Option<String>) -> Draft {
    let seabed = seabed.map_or(String::new(), |keys| format!("seabed = {{ {keys} }}\n"));
    let keys = format!("weight = {weight:e}, mass = 1.0, diameter = 0.1, axial_stiffness = {ea:e}");
    draft(format!("{seabed}line_types.cable = {{ {keys} }}"))
}

/// Slack to over-stretched, light to heavy, buoyant and weightless lines, EA 1e4 to 1e13 N, half of them over a seabed.
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
    let seabed = class
        .is_multiple_of(2)
        .then(|| format!("depth = {depth:e}, contact = '{contact}'"));
    cable(weight, ea, seabed)
        .fixed("a", [0.0; 3])
        .fixed("b", [x, 0.0, z])
        .line("cable", ["a", "b"], "cable", length, (2.0 + 60.0 * u()) as usize)
        .model()
}

/// Two to four lines from random corners joined at a free point, loaded or not, some on a slider, half of them over a seabed.
fn random_network(seed: &mut u64, class: usize) -> Model {
    let mut u = || random(seed);
    let scale = 10f64.powf(1.0 + 1.5 * u());
    let (ea, weight) = (10f64.powf(4.0 + 8.0 * u()), 10f64.powf(3.0 * u()));
    let mut network = cable(
        weight,
        ea,
        (u() < 0.5).then(|| format!("depth = {:e}", 1.2 * scale)),
    );
    let corners: Vec<Vector3<f64>> = (0..2 + class % 3)
        .map(|_| Vector3::from_fn(|_, _| scale * (2.0 * u() - 1.0)))
        .collect();
    let middle: Vector3<f64> = corners.iter().sum::<Vector3<f64>>() / corners.len() as f64;
    let joint = middle + Vector3::from_fn(|_, _| 0.3 * scale * (u() - 0.5));
    let load = if u() < 0.5 { 0.0 } else { weight * scale * u() };
    let axes = if class.is_multiple_of(7) {
        "free = ['x', 'y']"
    } else {
        ""
    };
    let mass = 0.1 * weight * scale * u();
    network = network.free("joint", joint.into());
    network = network
        .with(&format!("mass = {mass:e}, force = {{ x = {load:e} }}"))
        .with(axes);
    for (i, corner) in corners.iter().enumerate() {
        let name = &format!("corner{i}");
        let ends = if i % 2 == 0 {
            [name, "joint"]
        } else {
            ["joint", name]
        };
        let length = (joint - corner).norm() * (0.8 + 0.8 * u());
        let elements = (1.0 + 30.0 * u()) as usize;
        network = network.fixed(name, (*corner).into());
        network = network.line(&format!("leg{i}"), ends, "cable", length, elements);
    }
    network.model()
}

/// Asserts that this many random models have an equilibrium, with at most `solves` solves each on average.
fn assert_solved(mut seed: u64, count: usize, solves: usize, model: fn(&mut u64, usize) -> Model) {
    let mut total = 0;
    for class in 0..count {
        let model = model(&mut seed, class);
        match equilibrium(&model) {
            Ok((_, counters)) => total += counters.solves,
            Err(error) => panic!("{class}: {error}\n{model:?}"),
        }
    }
    assert!(total <= solves * count, "{total} solves in all");
}

#[test]
fn two_thousand_random_lines_are_all_solved_in_few_solves() {
    assert_solved(1, 2000, 10, random_line);
}

#[test]
fn a_thousand_random_networks_are_all_solved() {
    assert_solved(5, 1000, 27, random_network);
}

#[test]
fn a_bridle_shares_its_load_between_two_legs() {
    let model = draft("line_types.cable = { mass = 0.0, axial_stiffness = 1.0e9 }")
        .fixed("left", [0.0, -3.0, 0.0])
        .fixed("right", [0.0, 3.0, 0.0])
        .free("apex", [5.0, 1.0, 0.0])
        .free("tow", [30.0, 0.0, 0.0])
        .with("force = { x = 8000.0 }")
        .line("port", ["left", "apex"], "cable", 5.0, 5)
        .line("starboard", ["apex", "right"], "cable", 5.0, 4)
        .line("main", ["apex", "tow"], "cable", 20.0, 10)
        .model();
    let (state, _) = equilibrium(&model).unwrap();
    let apex = state.points[2].position;
    assert!((apex - Vector3::new(4.0, 0.0, 0.0)).norm() < 1e-4, "{apex}");
    let leg = end_force(&model, &state, 0, End::A, &mut Workspace::new(&model));
    assert!((leg.norm() - 5000.0).abs() < 0.1, "{leg}");
}

// ------------------------------------------------------------------ friction under a hanging end

/// Where end A hangs above the seabed, a line laid without tension hangs straight down from it.
#[test]
fn friction_acts_on_a_line_from_a_raised_anchor_as_in_the_closed_form() {
    for (height, span, friction) in [
        (0.0, 400.0, 0.5),
        (0.3, 400.0, 0.5),
        (1.0, 400.0, 0.5),
        (10.0, 392.0, 0.7),
    ] {
        let simulation = draft(format!(
            "water.density = 1000.0
            seabed = {{ depth = 130.0, friction = {friction} }}
            line_types.chain = {{ mass = 126.0, diameter = 0.144, axial_stiffness = 5.5e8 }}"
        ))
        .fixed("anchor", [span, 0.0, height - 130.0])
        .coupled("fairlead", [0.0, 0.0, -10.0])
        .line("line", ["anchor", "fairlead"], "chain", 450.0, 90)
        .start();
        let exact = simulation.catenary(0).unwrap();
        let at_a = exact.horizontal_a().hypot(exact.vertical_a());
        let [a, b] = [End::A, End::B].map(|end| simulation.line_end_force(0, end).norm());
        assert!(
            (b - exact.tension_b()).abs() < 0.01 * b,
            "{height} m: {b} {}",
            exact.tension_b()
        );
        assert!((a - at_a).abs() < 0.02 * b, "{height} m: {a} {at_a} {b}");
    }
}
