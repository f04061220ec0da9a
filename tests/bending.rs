//! Cables with bending stiffness against closed forms, published figures and each other.

mod common;

use common::{modes, order_of, scene, shipped, with_elements};
use moorline::interface::{Interface, Layout};
use moorline::scene::{FibreLaw, Integrator, Scene};
use moorline::simulation::Simulation;
use nalgebra::Vector3;

// ------------------------------------------------------------------ MotionSolve's collar

/// The shipped collar scene with another stiffness EI [N m²], gravity [m/s²] and mesh, all but inextensible, at the end of its pull.
fn collar(bending_stiffness: f64, gravity: f64, elements: usize) -> Simulation {
    let mut collar = with_elements(shipped("collar"), elements);
    collar.gravity = gravity;
    for line_type in collar.line_types.values_mut() {
        line_type.axial_stiffness = Some(1e10);
        line_type.bending_stiffness = Some(bending_stiffness);
    }
    drawn_out(&collar)
}

fn drawn_out(collar: &Scene) -> Simulation {
    let mut simulation = Simulation::new(collar).unwrap();
    for _ in 0..10 {
        simulation.advance(1.0).unwrap();
    }
    simulation
}

fn span_and_sag(simulation: &Simulation) -> [f64; 2] {
    let collar = simulation.model().point_index("collar").unwrap();
    [simulation.state().points[collar].position.x, simulation.sag(0)]
}

fn assert_close(found: [f64; 2], wanted: [f64; 2], tolerance: f64) {
    for (found, wanted) in found.into_iter().zip(wanted) {
        assert!((found - wanted).abs() <= tolerance, "{found} is not {wanted}");
    }
}

/// EI [N m²], span [m] and sag [m] of the inextensible wire with moment-free ends, g = 9.81, from a boundary-value solution of the elastica
/// with weight.
const COLLAR: [(f64, [f64; 2]); 3] = [
    (10.85, [17.7404, 4.0520]),
    (1.0, [17.69804, 4.08295]),
    (0.1, [17.69411, 4.08576]),
];

#[test]
fn the_collar_slides_to_the_heavy_elastica() {
    for (bending_stiffness, wanted) in COLLAR {
        let found = span_and_sag(&collar(bending_stiffness, 9.81, 200));
        assert_close(found, wanted, 5e-5);
    }
}

#[test]
fn fifty_elements_meet_the_heavy_elastica_within_half_a_millimetre() {
    for (bending_stiffness, wanted) in COLLAR {
        let error = |elements| {
            let found = span_and_sag(&collar(bending_stiffness, 9.81, elements));
            (found[0] - wanted[0]).abs().max((found[1] - wanted[1]).abs())
        };
        assert!(error(50) <= 5e-4 && error(40) > 5e-4);
    }
}

#[test]
fn twenty_elements_give_the_published_digits_of_one_fibre() {
    let [span, sag] = span_and_sag(&collar(10.85, 9.81, 20));
    assert_eq!(
        (format!("{span:.2}"), format!("{sag:.2}")),
        ("17.74".into(), "4.05".into())
    );
}

/// The shipped collar as a solid steel rod of 5.6955 mm in so many loose strands, g = 9.80665.
fn strands(fibres: usize, law: FibreLaw) -> [f64; 2] {
    let mut collar = with_elements(shipped("collar"), 400);
    collar.gravity = 9.80665;
    for line_type in collar.line_types.values_mut() {
        line_type.axial_stiffness = Some(1e10);
        line_type.solid_section = Some(moorline::scene::SolidSection {
            diameter: 5.6955e-3,
            youngs_modulus: 2.1e11,
            poisson: 0.3,
        });
        line_type.fibres = Some(fibres);
        line_type.fibre_law = law;
    }
    span_and_sag(&drawn_out(&collar))
}

#[test]
fn words_say_the_stiffness_and_where_it_comes_from() {
    let mut collar = shipped("collar");
    let line_type = collar.line_types.get_mut("wire").unwrap();
    line_type.bending_stiffness = Some(10.0);
    line_type.fibres = Some(20);
    let said = |scene: &Scene| {
        let words = scene.in_words();
        words.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let words = said(&collar);
    assert!(
        words.contains("bending stiffness 0.5 N m², which is EI 10 N m² as given shared by 20 fibres (EI/20"),
        "{words}"
    );
    assert!(
        words.contains("not modelled torsion and shear of lines"),
        "{words}"
    );
    collar.line_types.get_mut("wire").unwrap().fibre_law = FibreLaw::Squared;
    assert!(said(&collar).contains("0.025 N m², which is EI 10 N m² as given"));
    let simulation = Simulation::new(&collar).unwrap();
    let joints = simulation.model().lines[0].bending.as_ref().unwrap();
    assert_eq!(joints.stiffness[0], 0.025);
    assert!(said(&shipped("power_cable")).contains("clamped at end A along (-1, 0, 0)"));
}

/// Published: 17.70 and 4.09 for twenty fibres.
#[test]
fn the_published_twenty_fibres_are_the_squared_reading() {
    let digits = |[span, sag]: [f64; 2]| (format!("{span:.2}"), format!("{sag:.2}"));
    let published = ("17.70".to_string(), "4.09".to_string());
    let squared = strands(20, FibreLaw::Squared);
    assert_close(squared, [17.69503, 4.08500], 1e-4);
    let linear = strands(20, FibreLaw::Linear);
    assert_close(linear, [17.6972, 4.0834], 1e-4);
    assert_eq!(digits(linear).1, "4.08");
    // 4.08500 stands on the edge between 4.08 and 4.09: the mesh of twenty elements falls on the published side
    assert_eq!(
        digits(span_and_sag(&collar(10.85 / 400.0, 9.80665, 20))),
        published
    );
    assert_eq!(
        digits(span_and_sag(&collar(10.85 / 20.0, 9.80665, 20))),
        published
    );
}

// ------------------------------------------------------------------ cantilevers

/// A weightless cantilever along x with a load at its tip.
struct Cantilever {
    elements: usize,
    /// Force on the tip [N].
    load: [f64; 3],
    /// Direction that its root is clamped to.
    clamp: [f64; 3],
    /// Further lines of the scene's solver table.
    solver: &'static str,
}

const EI: f64 = 3.0; // [N m²]
const LENGTH: f64 = 2.0; // [m]
const MASS: f64 = 0.7; // [kg/m]

impl Cantilever {
    fn scene(&self) -> Scene {
        let [x, y, z] = self.load;
        let [a, b, c] = self.clamp;
        scene(&format!(
            r#"
            gravity = 0.0
            line_types.rod = {{ mass = {MASS}, axial_stiffness = 1e7, bending_stiffness = {EI} }}
            solver = {{ time_step_max = 0.05, {} }}
            [[points]]
            name = "root"
            position = [0.0, 0.0, 0.0]
            kind = "fixed"
            [[points]]
            name = "tip"
            position = [{LENGTH}, 0.0, 0.0]
            kind = "free"
            force = {{ x = {x}, y = {y}, z = {z} }}
            [[lines]]
            name = "rod"
            from = "root"
            to = "tip"
            sections = [{{ type = "rod", length = {LENGTH}, elements = {} }}]
            clamped_a = [{a}, {b}, {c}]
            "#,
            self.solver, self.elements
        ))
    }

    fn at_rest(&self) -> Simulation {
        Simulation::new(&self.scene()).unwrap()
    }
}

fn bent_down(alpha: f64, elements: usize) -> Simulation {
    let load = alpha * EI / (LENGTH * LENGTH);
    Cantilever {
        elements,
        load: [0.0, 0.0, -load],
        clamp: [1.0, 0.0, 0.0],
        solver: "",
    }
    .at_rest()
}

fn tip(simulation: &Simulation) -> [f64; 3] {
    simulation.state().points[1].position.into()
}

/// PL²/EI [-], deflection over L [-], shortening over L [-]: inextensible elastica with a dead load across its tip, from elliptic
/// integrals in high precision.
const ELASTICA: [(f64, f64, f64); 4] = [
    (0.5, 0.16214357565836962, 0.015918962470837496),
    (1.0, 0.30172077379981355, 0.05643323628337688),
    (5.0, 0.7137915236119128, 0.38762836072442985),
    (10.0, 0.8106090248802964, 0.5549955977537513),
];

#[test]
fn a_loaded_cantilever_tends_to_the_elastica_at_second_order() {
    for (alpha, deflection, shortening) in ELASTICA {
        let errors = [40, 80, 160, 320].map(|elements| {
            let [x, _, z] = tip(&bent_down(alpha, elements));
            let error = (-z / LENGTH - deflection).hypot(1.0 - x / LENGTH - shortening);
            (1.0 / elements as f64, error)
        });
        let order = order_of(&errors);
        assert!((order - 2.0).abs() < 0.1, "{alpha}: order {order}, {errors:?}");
        assert!(errors[3].1 < 1e-4);
    }
}

#[test]
fn the_root_of_a_cantilever_feels_the_load_and_its_moment() {
    let rod = bent_down(5.0, 30);
    let load = 5.0 * EI / (LENGTH * LENGTH);
    let [x, y, z] = rod.end_force(0);
    assert!(x.abs() < 1e-6 && y.abs() < 1e-6 && (z + load).abs() < 1e-6 * load);
    let moments = rod.bending(0).unwrap();
    let root = moments[0].moment;
    assert!((root / (load * tip(&rod)[0]) - 1.0).abs() < 0.02, "{root}");
    assert_eq!(moments.last().unwrap().moment, 0.0);
    assert!((moments[0].curvature * EI / root - 1.0).abs() < 1e-12);
}

// ------------------------------------------------------------------ moments on free ends

/// A weightless cantilever along x under a moment about y [N m] at its tip, in time.
fn turned(moment: &str, elements: usize, solver: &'static str) -> Simulation {
    let rod = Cantilever {
        elements,
        load: [0.0; 3],
        clamp: [1.0, 0.0, 0.0],
        solver,
    };
    let mut rod = rod.scene();
    rod.points[1].force = None;
    rod.points[1].moment = Some(moorline::scene::part(&format!("y = {moment}")).unwrap());
    Simulation::new(&rod).unwrap()
}

#[test]
fn a_moment_on_the_free_end_bends_a_cable_to_a_circle_at_second_order() {
    // at large angles an end without torsion turns out of the plane, towards the axis of its moment
    for angle in [0.3, 0.9, 1.5] {
        let curvature = angle / LENGTH;
        let errors = [10, 20, 40, 80].map(|elements| {
            let rod = turned(&(curvature * EI).to_string(), elements, "");
            let nodes = rod.bending(0).unwrap();
            for node in &nodes {
                let error = node.curvature / curvature - 1.0;
                let step = angle / elements as f64;
                assert!(error.abs() <= 0.3 * step * step, "{angle}: {error}");
            }
            let free = nodes.last().unwrap();
            assert!((free.moment / (curvature * EI) - 1.0).abs() < 1e-9);
            let [x, _, z] = tip(&rod);
            let exact = [angle.sin() / curvature, (angle.cos() - 1.0) / curvature];
            (1.0 / elements as f64, (x - exact[0]).hypot(z - exact[1]))
        });
        let order = order_of(&errors);
        assert!((order - 2.0).abs() < 0.1, "{angle}: order {order}, {errors:?}");
    }
}

#[test]
fn the_root_of_a_cantilever_feels_the_moment_on_its_tip_and_no_force() {
    let rod = turned("2.0", 40, "");
    let moment = rod.end_moment(0);
    assert!((moment.y - 2.0).abs() < 2e-9, "{moment}");
    for point in [0, 1] {
        for force in rod.end_force(point) {
            assert!(force.abs() < 1e-8, "{force} N");
        }
    }
}

#[test]
fn a_cable_at_rest_under_an_end_moment_stays_there_in_every_integrator_that_bends_lines() {
    for solver in [
        "integrator = 'generalised_alpha'",
        "integrator = 'bossak'",
        "integrator = 'quasi_static'",
        "",
    ] {
        let mut rod = turned("2.0", 20, solver);
        let start = tip(&rod);
        assert!(start[2] < -0.3 * LENGTH);
        for _ in 0..20 {
            rod.advance(0.05).unwrap();
        }
        for (now, then) in tip(&rod).into_iter().zip(start) {
            assert!((now - then).abs() < 1e-8, "{solver}: {now}, {then}");
        }
    }
}

#[test]
fn the_work_of_an_end_moment_is_in_the_ledger() {
    for (solver, tolerance) in [
        ("integrator = 'generalised_alpha'", 2e-3),
        ("integrator = 'bossak'", 2e-3),
        ("integrator = 'quasi_static'", 1e-3),
    ] {
        let mut rod = turned("{ ramp = [0.0, 0.0, 2.0, 2.0] }", 20, solver);
        for _ in 0..400 {
            rod.advance(0.005).unwrap();
        }
        let (given, error) = (rod.ledger().flow.given, rod.energy_error());
        let bent = rod.energy().bending;
        assert!(bent > 0.5 * 2.0 * 2.0 * LENGTH / EI * 0.8, "{solver}: {bent} J");
        assert!(given > 0.9 * bent, "{solver}: {given} of {bent} J");
        assert!(error.abs() < tolerance * given, "{solver}: {error} of {given} J");
    }
}

#[test]
fn the_part_of_a_moment_along_a_cable_does_nothing_and_check_says_so() {
    let mut rod = Cantilever {
        elements: 10,
        load: [0.0; 3],
        clamp: [1.0, 0.0, 0.0],
        solver: "",
    }
    .scene();
    rod.points[1].force = None;
    rod.points[1].moment = Some(moorline::scene::part("x = 2.0").unwrap());
    assert!(rod.in_words().replace("\n", " ").contains("no torsion"));
    let rod = Simulation::new(&rod).unwrap();
    let [x, y, z] = tip(&rod);
    assert!((x - LENGTH).abs() < 1e-9 && y.abs() < 1e-9 && z.abs() < 1e-9);
    assert_eq!(rod.bending(0).unwrap().last().unwrap().moment, 0.0);
}

/// A column clamped at its foot buckles at π²EI/(4L²).
#[test]
fn a_column_stands_below_its_euler_load_and_bends_above() {
    let column = |alpha: f64| {
        let load = alpha * EI / (LENGTH * LENGTH);
        tip(&Cantilever {
            elements: 40,
            load: [0.0, 0.0, -load],
            clamp: [0.0, 0.0, 1.0],
            solver: "",
        }
        .at_rest())
    };
    let [x, y, z] = column(2.4);
    assert!(x.hypot(y) < 1e-6 && (z - LENGTH).abs() < 1e-5);
    let [x, y, _] = column(2.6);
    assert!(x.hypot(y) > 0.3 * LENGTH);
}

/// A cantilever on a vessel, along x in its reference attitude, its tip under a load.
fn carried(solver: &str, load: f64) -> Simulation {
    let carried = scene(&format!(
        r#"
        gravity = 0.0
        line_types.rod = {{ mass = {MASS}, axial_stiffness = 1e7, bending_stiffness = {EI} }}
        solver = {{ {solver} }}
        [[vessels]]
        name = "floater"
        position = [0.0, 0.0, 0.0]
        [[points]]
        name = "root"
        position = [3.0, 0.0, 0.0]
        kind = "coupled"
        on = "floater"
        [[points]]
        name = "tip"
        position = [{}, 0.0, 0.0]
        kind = "free"
        force = {{ z = {load} }}
        [[lines]]
        name = "rod"
        from = "root"
        to = "tip"
        sections = [{{ type = "rod", length = {LENGTH}, elements = 20 }}]
        clamped_a = [1.0, 0.0, 0.0]
        "#,
        3.0 + LENGTH
    ));
    Simulation::new(&carried).unwrap()
}

#[test]
fn a_clamp_turns_with_its_vessel() {
    let mut rod = carried("integrator = \"quasi_static\"", 0.0);
    for i in 1..=20 {
        rod.set_pose(0, [0.0, 0.0, 0.0, 0.0, 0.0, 0.05 * f64::from(i)]);
        rod.advance(1.0).unwrap();
    }
    let root = rod.state().points[0].position;
    let [x, y, z] = tip(&rod);
    assert!(root.y > 2.0 && z.abs() < 1e-9);
    let ratio = (3.0 + LENGTH) / 3.0;
    assert!((x - ratio * root.x).hypot(y - ratio * root.y) < 1e-5, "{x} {y}");
    assert!(rod.energy().bending < 1e-9);
}

#[test]
fn a_vessel_feels_the_moment_of_what_is_clamped_to_it() {
    let rod = carried("", -2.0);
    let [fx, fy, fz, mx, my, mz] = rod.vessel_force(0);
    let [x, ..] = tip(&rod);
    assert!(fx.abs() < 1e-6 && fy.abs() < 1e-6 && (fz + 2.0).abs() < 1e-6);
    assert!((my - 2.0 * x).abs() < 1e-6, "{my} is not {}", 2.0 * x);
    assert!(mx.abs() < 1e-6 && mz.abs() < 1e-6);
}

#[test]
fn the_work_of_a_clamp_that_turns_is_in_the_ledger() {
    let errors = [0.02, 0.01, 0.005, 0.0025].map(|step| {
        let solver = format!("integrator = \"generalised_alpha\", time_step_max = {step}");
        let mut rod = carried(&solver, 0.0);
        for i in 0..100 {
            let angle = |t: f64| 0.2 * (1.5 * t).sin().powi(3);
            rod.set_pose(0, [0.0, 0.0, 0.0, 0.0, angle(0.04 * f64::from(i)), 0.0]);
            rod.advance(0.04).unwrap();
        }
        assert!(rod.ledger().flow.given > 0.05);
        (step, rod.energy_error().abs())
    });
    assert!(order_of(&errors) > 1.5, "{errors:?}");
}

// ------------------------------------------------------------------ vibration

/// A beam along x: (βL)², the circular frequencies over √(EI/mL⁴), of its first three modes.
fn frequencies(ends: &str, clamps: &str, tension: f64, elements: usize) -> [f64; 3] {
    let stiffness = 1e9; // [N]
    let span = LENGTH * (1.0 + tension / stiffness);
    let beam = scene(&format!(
        r#"
        gravity = 0.0
        line_types.rod = {{ mass = {MASS}, axial_stiffness = {stiffness}, bending_stiffness = {EI} }}
        points = [
          {{ name = "a", position = [0.0, 0.0, 0.0], kind = "fixed" }},
          {{ name = "b", position = [{span}, 0.0, 0.0], kind = "{ends}" }},
        ]
        [[lines]]
        name = "rod"
        from = "a"
        to = "b"
        sections = [{{ type = "rod", length = {LENGTH}, elements = {elements} }}]
        {clamps}
        "#
    ));
    let found = modes(&Simulation::new(&beam).unwrap()).frequencies;
    let scale = (EI / MASS / LENGTH.powi(4)).sqrt();
    [0, 2, 4].map(|mode| found[mode] / scale) // each comes in two planes
}

fn assert_second_order(exact: [f64; 3], found: impl Fn(usize) -> [f64; 3]) {
    let meshes = [20, 40, 80, 160].map(|elements| (elements, found(elements)));
    for mode in 0..3 {
        let errors =
            meshes.map(|(elements, found)| (1.0 / elements as f64, (found[mode] / exact[mode] - 1.0).abs()));
        let order = order_of(&errors);
        assert!(
            (order - 2.0).abs() < 0.1,
            "mode {mode}: order {order}, {errors:?}"
        );
        assert!(errors[3].1 < 1e-3);
    }
}

/// βL: roots of cos βL cosh βL = −1, of cos βL cosh βL = 1, and multiples of π.
#[test]
fn frequencies_of_beams_have_second_order() {
    let square = |roots: [f64; 3]| roots.map(|root| root * root);
    let held = "clamped_a = [1.0, 0.0, 0.0]";
    let both = "clamped_a = [1.0, 0.0, 0.0]\nclamped_b = [1.0, 0.0, 0.0]";
    let pi = std::f64::consts::PI;
    assert_second_order(
        square([1.8751040687119611, 4.694091132974175, 7.854757438237613]),
        |n| frequencies("free", held, 0.0, n),
    );
    assert_second_order(
        square([4.730040744862704, 7.853204624095838, 10.995607838001671]),
        |n| frequencies("fixed", both, 0.0, n),
    );
    assert_second_order(square([pi, 2.0 * pi, 3.0 * pi]), |n| {
        frequencies("fixed", "", 0.0, n)
    });
}

/// ω² = (EI k⁴ + T k²)/m with k = iπ/L between pinned ends.
#[test]
fn frequencies_of_a_tensioned_beam_have_second_order() {
    let tension = 7.0;
    let exact = [1.0, 2.0, 3.0].map(|i: f64| {
        let k = i * std::f64::consts::PI;
        (k.powi(4) + tension * LENGTH * LENGTH / EI * k * k).sqrt()
    });
    assert_second_order(exact, |n| frequencies("fixed", "", tension, n));
}

/// A cantilever let go from under a small load.
fn let_go(solver: &'static str) -> Simulation {
    let rod = Cantilever {
        elements: 30,
        load: [0.0, 0.0, 0.0],
        clamp: [1.0, 0.0, 0.0],
        solver,
    };
    let mut rod = rod.scene();
    rod.points[1].force = scene_force(-0.05);
    Simulation::new(&rod).unwrap()
}

/// A load along z [N] that is gone after t = 0.
fn scene_force(z: f64) -> Option<moorline::scene::PointForce> {
    let text = format!("z = {{ table = [[0.0, {z}], [1e-9, 0.0]] }}");
    Some(moorline::scene::part(&text).unwrap())
}

#[test]
fn a_cantilever_let_go_swings_with_its_first_natural_period() {
    let exact = 1.8751040687119611_f64.powi(2) * (EI / MASS / LENGTH.powi(4)).sqrt();
    let mut rod = let_go("spectral_radius = 0.8");
    let (step, mut crossings, mut last) = (0.01, Vec::new(), tip(&rod)[2]);
    for i in 1..=2000 {
        rod.advance(step).unwrap();
        let now = tip(&rod)[2];
        if last < 0.0 && now >= 0.0 {
            crossings.push(step * (f64::from(i) - now / (now - last)));
        }
        last = now;
    }
    let periods = crossings.len() - 1;
    let period = (crossings[periods] - crossings[0]) / periods as f64;
    let found = std::f64::consts::TAU / period;
    assert!((found / exact - 1.0).abs() < 5e-3, "{found} is not {exact}");
}

// ------------------------------------------------------------------ energy

#[test]
fn the_energy_of_a_swinging_cantilever_stays_and_moves_between_its_kinds() {
    let mut rod = let_go("spectral_radius = 1.0");
    let start = rod.energy();
    assert!(start.bending > 0.0 && start.kinetic == 0.0 && start.gravitational == 0.0);
    let (mut worst, mut fastest) = (0.0_f64, 0.0_f64);
    for _ in 0..500 {
        rod.advance(0.005).unwrap();
        worst = worst.max(rod.energy_error().abs());
        fastest = fastest.max(rod.energy().kinetic);
    }
    assert!(worst < 2e-3 * start.bending, "{worst} of {}", start.bending);
    assert!(fastest > 0.9 * start.bending);
}

#[test]
fn the_ledger_of_a_driven_cable_closes_at_any_step() {
    for step in [0.04, 0.02, 0.01] {
        let mut cable = with_elements(shipped("power_cable"), 12);
        cable.solver.integrator = Integrator::GeneralisedAlpha;
        cable.solver.time_step_max = step;
        cable.seabed = None;
        let mut simulation = Simulation::new(&cable).unwrap();
        simulation.follow_scene().unwrap();
        for _ in 0..100 {
            simulation.advance(0.2).unwrap();
        }
        let (error, given) = (simulation.energy_error(), simulation.ledger().flow.given);
        assert!(error.abs() < 1e-7 * given.abs(), "{step}: {error} of {given} J");
    }
}

#[test]
fn a_quasi_static_pull_balances_its_energy() {
    for bending_stiffness in [None, Some(10.85)] {
        let mut scene = shipped("collar");
        for line_type in scene.line_types.values_mut() {
            line_type.bending_stiffness = bending_stiffness;
        }
        let mut simulation = Simulation::new(&scene).unwrap();
        let errors = [50, 200].map(|steps| {
            simulation.restart(0.0).unwrap();
            for _ in 0..steps {
                simulation.advance(10.0 / f64::from(steps)).unwrap();
            }
            simulation.energy_error()
        });
        let given = simulation.ledger().flow.given;
        assert!(given > 50.0);
        assert!(errors[1].abs() < 2e-3 * given, "{errors:?} of {given}");
    }
}

// ------------------------------------------------------------------ hard cases

#[test]
fn stiffness_from_a_millionth_to_a_hundred_million_times_a_wires_finds_rest() {
    for exponent in -6..=8 {
        let bending_stiffness = 10.85 * 10.0_f64.powi(exponent);
        for elements in [2, 20, 200] {
            let mut collar = with_elements(shipped("collar"), elements);
            for line_type in collar.line_types.values_mut() {
                // a radius of gyration of 0.1 m at most
                let stiffness = &mut line_type.axial_stiffness;
                *stiffness = stiffness.map(|ea| ea.max(100.0 * bending_stiffness));
                line_type.bending_stiffness = Some(bending_stiffness);
            }
            let [span, sag] = span_and_sag(&drawn_out(&collar));
            assert!(
                span > 17.6 && span < 20.001,
                "{bending_stiffness}, {elements}: {span}"
            );
            assert!(
                (0.0..4.5).contains(&sag),
                "{bending_stiffness}, {elements}: {sag}"
            );
        }
    }
}

/// 100 m of cable on the bed between ends 95 m apart, pushed together by 3 m and back within 20 s.
fn slack(bending_stiffness: f64, elements: usize) -> Scene {
    scene(&format!(
        r#"
        [water]
        density = 1025.0
        [seabed]
        depth = 50.0
        stiffness = 1e5
        damping = 1e4
        [line_types.cable]
        mass = 30.0
        diameter = 0.12
        axial_stiffness = 5e7
        bending_stiffness = {bending_stiffness:e}
        drag_normal = 1.2
        added_mass_normal = 1.0
        [[points]]
        name = "a"
        position = [0.0, 0.0, -50.0]
        kind = "fixed"
        [[points]]
        name = "b"
        position = [95.0, 0.0, -49.9]
        kind = "prescribed"
        motion = {{ x = [[-3.0, 20.0]], ramp = 5.0 }}
        [[lines]]
        name = "cable"
        from = "a"
        to = "b"
        sections = [{{ type = "cable", length = 100.0, elements = {elements} }}]
        clamped_a = [1.0, 0.0, 0.0]
        "#
    ))
}

#[test]
fn a_slack_cable_on_the_seabed_buckles_and_goes_on() {
    for exponent in [-3, 0, 2, 4, 6, 9] {
        for elements in [10, 100] {
            let scene = slack(10.0_f64.powi(exponent), elements);
            let mut cable =
                Simulation::new(&scene).unwrap_or_else(|error| panic!("1e{exponent}, {elements}: {error}"));
            for _ in 0..100 {
                cable
                    .advance(0.2)
                    .unwrap_or_else(|error| panic!("1e{exponent}, {elements}: {error}"));
            }
            let nodes = &cable.state().lines[0].position;
            assert!(nodes.iter().all(|r| r.amax() < 150.0));
            assert!(cable.energy_error().is_finite());
        }
    }
}

#[test]
fn a_line_that_hardly_bends_rests_on_the_bed_like_one_that_does_not_bend() {
    let rest = |bending_stiffness: Option<f64>| {
        let mut cable = slack(1.0, 10);
        (cable.lines[0].clamped_a, cable.points[1].position) = (None, [70.0, 0.0, -20.0]);
        for line_type in cable.line_types.values_mut() {
            line_type.bending_stiffness = bending_stiffness;
        }
        Simulation::new(&cable).unwrap().state().lines[0].position.clone()
    };
    let flexible = rest(None);
    for stiffness in [0.0, 1e-9, 1e-3] {
        let apart = |(a, b): (&Vector3<f64>, &Vector3<f64>)| (a - b).norm();
        let nodes = rest(Some(stiffness));
        let most = flexible.iter().zip(&nodes).map(apart).fold(0.0, f64::max);
        // EI/(lH) with elements of 10 m and a horizontal tension of some 100 N
        assert!(
            most <= 1e-9 + 1e-3 * stiffness,
            "EI = {stiffness} N m²: {most:.1e} m"
        );
    }
}

/// A heavy rod clamped at one end, its other end free.
fn heavy_rod(bending_stiffness: f64, elements: usize, clamp: &str) -> Scene {
    scene(&format!(
        r#"
        solver = {{ time_step_max = 0.02 }}
        line_types.rod = {{ mass = 1.0, axial_stiffness = 1e7, bending_stiffness = {bending_stiffness:e} }}
        points = [
          {{ name = "root", position = [0.0, 0.0, 0.0], kind = "fixed" }},
          {{ name = "tip", position = [5.0, 0.0, 0.0], kind = "free" }},
        ]
        [[lines]]
        name = "rod"
        from = "root"
        to = "tip"
        sections = [{{ type = "rod", length = 5.0, elements = {elements} }}]
        clamped_a = {clamp}
        "#
    ))
}

/// Without bending stiffness all of these hang straight down, some of them folded back at the clamp.
#[test]
fn a_heavy_cantilever_comes_to_rest_whichever_way_it_is_clamped() {
    for clamp in [
        "[1.0, 0.0, 0.0]",
        "[0.3, 0.2, 1.0]",
        "[0.0, 0.0, 1.0]",
        "[0.0, 0.0, -1.0]",
    ] {
        for exponent in [-4, -2, 0, 2, 4, 6] {
            for elements in [5, 50] {
                let scene = heavy_rod(10.0_f64.powi(exponent), elements, clamp);
                let mut rod =
                    Simulation::new(&scene).unwrap_or_else(|error| panic!("1e{exponent}, {clamp}: {error}"));
                let before = nalgebra::Vector3::from(tip(&rod));
                for _ in 0..20 {
                    rod.advance(0.1).unwrap();
                }
                let drift = (nalgebra::Vector3::from(tip(&rod)) - before).norm();
                assert!(drift < 1e-6, "1e{exponent}, {clamp}: {drift} m");
            }
        }
    }
}

#[test]
fn a_section_without_bending_stiffness_is_a_hinge() {
    let mut chain = shipped("power_cable");
    chain.line_types.get_mut("buoyant").unwrap().bending_stiffness = None;
    let cable = Simulation::new(&chain).unwrap();
    let nodes = cable.bending(0).unwrap();
    assert!(nodes[100..=150].iter().all(|node| node.moment == 0.0));
    assert!(nodes[151..].iter().any(|node| node.moment > 0.0));
}

#[test]
fn a_line_split_into_sections_of_one_type_is_the_same_line() {
    let mut split = shipped("power_cable");
    split.line_types.get_mut("buoyant").unwrap().mass = Some(70.0);
    let mut parts = split.clone();
    let first = parts.lines[0].sections[0].clone();
    let half = |length, elements| moorline::scene::Section {
        length,
        elements: Some(elements),
        ..first.clone()
    };
    parts.lines[0]
        .sections
        .splice(0..1, [half(30.0, 30), half(70.0, 70)]);
    let [whole, parts] = [split, parts].map(|scene| Simulation::new(&scene).unwrap());
    let pairs = whole
        .bending(0)
        .unwrap()
        .into_iter()
        .zip(parts.bending(0).unwrap());
    for (a, b) in pairs {
        assert!((a.moment - b.moment).abs() < 1e-6);
    }
}

#[test]
fn a_line_that_is_unstressed_as_it_lies_stays_there() {
    let mut rod = heavy_rod(40.0, 20, "[1.0, 0.0, 0.0]");
    rod.gravity = 0.0;
    rod.lines[0].initial = moorline::scene::InitialShape::Nodes(
        (0..=20)
            .map(|i| 0.25 * f64::from(i) / 4.0)
            .map(|angle| [4.0 * angle.sin(), 4.0 * (1.0 - angle.cos()), 0.0])
            .collect(),
    );
    rod.lines[0].sections[0].length = 20.0 * 8.0 * (0.5 * 0.0625_f64).sin(); // the chords
    rod.points[1].position = [4.0 * 1.25_f64.sin(), 4.0 * (1.0 - 1.25_f64.cos()), 0.0];
    let moments = |scene: &Scene| Simulation::new(scene).unwrap().bending(0).unwrap();
    let straight = moments(&rod);
    assert!((straight[10].moment / (40.0 / 4.0) - 1.0).abs() < 0.01);
    rod.lines[0].rest_shape = moorline::scene::RestShape::Initial;
    assert!(moments(&rod).iter().all(|node| node.moment == 0.0));
    let mut rod = Simulation::new(&rod).unwrap();
    let before = tip(&rod);
    for _ in 0..20 {
        rod.advance(0.1).unwrap();
    }
    let after = tip(&rod);
    assert!(
        (0..3).all(|axis| (after[axis] - before[axis]).abs() < 1e-6),
        "{after:?}"
    );
}

#[test]
fn a_line_that_bends_needs_two_elements() {
    let message = Simulation::new(&heavy_rod(1.0, 1, "[1.0, 0.0, 0.0]")).unwrap_err();
    assert!(message.to_string().starts_with("lines[0].sections"), "{message}");
}

#[test]
fn a_leapfrog_is_refused_where_lines_bend() {
    for integrator in [Integrator::Leapfrog, Integrator::AxialImplicit] {
        let mut cable = shipped("power_cable");
        cable.solver.integrator = integrator;
        let message = Simulation::new(&cable).unwrap_err().to_string();
        assert!(message.starts_with("solver.integrator"), "{message}");
        assert!(message.contains("bending stiffness"), "{message}");
    }
}

#[test]
fn a_network_that_bends_is_integrated_implicitly() {
    let cable = Simulation::new(&shipped("power_cable")).unwrap();
    let chosen = cable.choices().next().unwrap().integrator;
    assert_eq!(chosen, Integrator::GeneralisedAlpha);
}

// ------------------------------------------------------------------ power cable

#[test]
fn the_power_cable_rests_in_a_lazy_wave() {
    let cable = Simulation::new(&shipped("power_cable")).unwrap();
    let weight: f64 = cable.model().lines[0].nodes.weight.iter().sum();
    let nodes = &cable.state().lines[0].position;
    let (arch, sag) = (nodes[150].z, nodes[170..].iter().map(|r| r.z).fold(0.0, f64::min));
    assert!(arch > sag + 2.0, "arch {arch}, sag {sag}");
    assert!(cable.laid_length(0) > 10.0);
    let [_, _, lift] = cable.end_force(1);
    assert!(-lift < weight, "{lift} of {weight}");
    let curvature = |simulation: &Simulation| {
        let nodes = simulation.bending(0).unwrap();
        nodes.iter().map(|node| node.curvature).fold(0.0, f64::max)
    };
    assert!((0.01..1.0).contains(&curvature(&cable)));
}

#[test]
fn curvature_and_moment_are_outputs_of_lines_that_bend() {
    let scene = shipped("power_cable");
    let cable = Simulation::new(&scene).unwrap();
    let table = Interface::new(&scene, cable.model(), Layout::Arrays).unwrap();
    let read = |name: &str| {
        let mut rows = table.variables().iter();
        let row = rows.find(|row| row.name == name).unwrap();
        let mut values = vec![f64::NAN; row.size()];
        Interface::read(row, &cable, &mut values).unwrap();
        values
    };
    let moments = read("cable.profile.moment");
    let greatest = moments.iter().copied().fold(0.0, f64::max);
    assert_eq!(read("cable.moment_max"), [greatest]);
    assert_eq!(read("cable.moment_b"), [moments[240]]);
    assert_eq!(read("cable.moment_a"), [moments[0]]);
    let stiffness = greatest / read("cable.curvature_max")[0];
    assert!((stiffness / 1e4 - 1.0).abs() < 1e-9, "{stiffness}");
    let plain = shipped("collar");
    let model = moorline::model::Model::new(&plain).unwrap();
    let table = Interface::new(&plain, &model, Layout::Scalars).unwrap();
    let bends = |name: &str| name.contains("moment") || name.contains("curvature");
    assert!(!table.variables().iter().any(|row| bends(&row.name)));
}

#[test]
fn the_power_cable_at_rest_stays_at_rest() {
    let mut cable = Simulation::new(&shipped("power_cable")).unwrap();
    let before = cable.state().lines[0].position.clone();
    for _ in 0..60 {
        cable.advance(1.0).unwrap();
    }
    let drift = |(a, b): (&nalgebra::Vector3<f64>, &nalgebra::Vector3<f64>)| (a - b).norm();
    let after = &cable.state().lines[0].position;
    let drift = before.iter().zip(after).map(drift).fold(0.0, f64::max);
    assert!(drift < 1e-7, "{drift} m");
}
