//! Typical mooring systems: a riser hanging in a current, a catenary with a clump weight, a bridle with a free
//! plate, a lazy wave. Their equilibria are compared with a force balance computed here, directly from the scene.
//!
//! ```text
//!    → ● hang_off     ● fairlead       port ●             ● hang_off
//!   → ╱                ╲                     ╲    _        ╲    ╭─╮ buoyant
//!    │                  ● clump        plate  ●──            ╲__╯  ╲
//!    ╰──● base           ╲___● anchor  stbd  ╱               ═══════╲___● seabed_end
//! ```

use std::f64::consts::PI;

use crate::common::*;
use moorline::model::{Contact, End};
use moorline::scene::{Integrator, LineType, Point, PointKind, Scene, Section};
use moorline::simulation::Simulation;
use nalgebra::Vector3;

const SYSTEMS: [&str; 4] = ["hanging_riser", "clump_weight", "bridle", "lazy_wave"];

/// A current in a general direction, without any symmetry of a system.
const OBLIQUE: &str = "profile = [[0.0, 0.7, 0.5], [-60.0, 0.3, 0.4], [-200.0, 0.1, -0.1]]";

/// Every system as shipped, and with an oblique current.
fn systems() -> Vec<(String, Scene)> {
    let both = |name: &str| {
        let mut drifting = shipped(name);
        let current: moorline::scene::Current = moorline::scene::part(OBLIQUE).unwrap();
        drifting.water.as_mut().unwrap().current = Some(current);
        [
            (name.to_string(), shipped(name)),
            (format!("{name} in a current"), drifting),
        ]
    };
    SYSTEMS.into_iter().flat_map(both).collect()
}

/// Current at a height z [m/s], from the rows in the scene.
fn current(scene: &Scene, z: f64) -> Vector3<f64> {
    let water = scene.water.as_ref().unwrap();
    let Some(mut rows) = water.current.as_ref().and_then(|c| c.profile.clone()) else {
        return Vector3::zeros();
    };
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let z = z.clamp(rows[0][0], rows[rows.len() - 1][0]);
    let pair = rows.windows(2).find(|pair| z <= pair[1][0]).unwrap();
    let [low, high] = [pair[0], pair[1]].map(|[_, x, y]| Vector3::new(x, y, 0.0));
    low + (z - pair[0][0]) / (pair[1][0] - pair[0][0]) * (high - low)
}

/// Weight less buoyancy of a line type [N/m].
fn wet_weight(scene: &Scene, kind: &LineType) -> f64 {
    let water = scene.water.as_ref().unwrap();
    let area = 0.25 * PI * kind.diameter.unwrap().powi(2);
    (kind.mass.unwrap() - water.density * area) * scene.gravity
}

/// Drag of the current on a length [m] of a line type with unit tangent `t` [N].
fn drag(scene: &Scene, kind: &LineType, length: f64, t: Vector3<f64>, z: f64) -> Vector3<f64> {
    let u = current(scene, z);
    let along = u.dot(&t) * t;
    let across = u - along;
    let half = 0.5 * scene.water.as_ref().unwrap().density * kind.diameter.unwrap() * length;
    half * (kind.drag_normal.unwrap_or(0.0) * across.norm() * across
        + PI * kind.drag_tangential.unwrap_or(0.0) * along.norm() * along)
}

/// Weight, buoyancy, drag of the current and seabed force on every node of a line [N], with half a segment at end nodes, and
/// the tensions of its segments [N]. The stiffness of the seabed is that of the model.
fn loads(
    scene: &Scene,
    number: usize,
    nodes: &[Vector3<f64>],
    contact: Option<&Contact>,
) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
    let pieces = |section: &Section| {
        let count = section.elements.unwrap();
        vec![
            (
                &scene.line_types[&section.line_type],
                section.length / count as f64
            );
            count
        ]
    };
    let kinds: Vec<(&LineType, f64)> = scene.lines[number].sections.iter().flat_map(pieces).collect();
    let (mut forces, mut pulls) = (vec![Vector3::zeros(); nodes.len()], Vec::new());
    for (i, (kind, length)) in kinds.iter().enumerate() {
        let chord = nodes[i + 1] - nodes[i];
        let tension = kind.axial_stiffness.unwrap() * (chord.norm() / length - 1.0).max(0.0);
        pulls.push(tension * chord.normalize());
        for node in [i, i + 1] {
            let [before, after] = [node.saturating_sub(1), (node + 1).min(nodes.len() - 1)];
            let t = (nodes[after] - nodes[before]).normalize();
            forces[node].z -= 0.5 * length * wet_weight(scene, kind);
            forces[node] += drag(scene, kind, 0.5 * length, t, nodes[node].z);
        }
    }
    if let Some(contact) = contact {
        for (i, stiffness) in contact.stiffness.iter().enumerate() {
            let depth = |node: usize| contact.level[node] - nodes[node].z;
            for at in [0.125, 0.375, 0.625, 0.875] {
                let pressed = ((1.0 - at) * depth(i) + at * depth(i + 1)).max(0.0);
                forces[i].z += 0.25 * (1.0 - at) * stiffness * pressed;
                forces[i + 1].z += 0.25 * at * stiffness * pressed;
            }
        }
    }
    (forces, pulls)
}

/// Weight, buoyancy and drag of a free point in deep water [N].
fn point_load(scene: &Scene, point: &Point, place: Vector3<f64>) -> Vector3<f64> {
    let density = scene.water.as_ref().unwrap().density;
    let u = current(scene, place.z);
    let lift = density * point.volume.unwrap_or(0.0) - point.mass.unwrap_or(0.0);
    lift * scene.gravity * Vector3::z() + 0.5 * density * point.drag_area.unwrap_or(0.0) * u.norm() * u
}

/// The scene with the element numbers that the model gave its sections.
fn with_its_elements(mut scene: Scene, simulation: &Simulation) -> Scene {
    for (line, built) in scene.lines.iter_mut().zip(&simulation.model().lines) {
        let mut lengths = built.segments.length.iter();
        for section in &mut line.sections {
            let (mut count, mut reached) = (0, 0.0);
            while reached < section.length * (1.0 - 1e-9) {
                reached += lengths.next().unwrap();
                count += 1;
            }
            section.elements = Some(count);
        }
    }
    scene
}

/// Greatest unbalanced force relative to the weight of all lines: at nodes and free points, and for each line and the whole system, from the
/// reported end forces.
struct Imbalance {
    node: f64,
    whole: f64,
}

fn imbalance(scene: &Scene, simulation: &Simulation) -> Imbalance {
    let (model, state) = (simulation.model(), simulation.state());
    let scene = &with_its_elements(scene.clone(), simulation);
    let of = |section: &Section| wet_weight(scene, &scene.line_types[&section.line_type]).abs();
    let sections = scene.lines.iter().flat_map(|line| &line.sections);
    let weight: f64 = sections.map(|section| section.length * of(section)).sum();
    let (mut node, mut whole) = (0.0_f64, 0.0_f64);
    let mut at_points = vec![Vector3::zeros(); model.points.len()];
    let mut reported = vec![Vector3::zeros(); model.points.len()];
    let mut total = Vector3::zeros();
    for (number, line) in model.lines.iter().enumerate() {
        let nodes = &state.lines[number].position;
        let (forces, pulls) = loads(scene, number, nodes, line.nodes.contact.as_ref());
        let last = nodes.len() - 1;
        for i in 1..last {
            node = node.max((forces[i] + pulls[i] - pulls[i - 1]).norm());
        }
        at_points[line.ends[0]] += forces[0] + pulls[0];
        at_points[line.ends[1]] += forces[last] - pulls[last - 1];
        let sum: Vector3<f64> = forces.iter().sum();
        let ends = [End::A, End::B].map(|end| simulation.line_end_force(number, end));
        whole = whole.max((sum - ends[0] - ends[1]).norm());
        reported[line.ends[0]] += ends[0];
        reported[line.ends[1]] += ends[1];
        total += sum;
    }
    for (index, point) in scene.points.iter().enumerate() {
        if point.kind == PointKind::Free {
            let load = point_load(scene, point, state.points[index].position);
            node = node.max((at_points[index] + load).norm());
            whole = whole.max((reported[index] + load).norm());
            total += load;
        } else {
            whole = whole.max((reported[index] - at_points[index]).norm());
            total -= reported[index];
        }
    }
    whole = whole.max(total.norm());
    Imbalance {
        node: node / weight,
        whole: whole / weight,
    }
}

#[test]
fn systems_at_rest_are_in_balance_node_by_node_and_as_a_whole() {
    for (name, scene) in systems() {
        let simulation = start(&scene);
        let found = imbalance(&scene, &simulation);
        println!("{name}: {:.1e} {:.1e}", found.node, found.whole);
        // in a current, end forces contain the drag along the last element as linear, whereas the nodes have it lumped
        let flows = scene.water.as_ref().is_some_and(|water| water.current.is_some());
        let whole = if flows { 2e-3 } else { 1e-8 };
        assert!(found.node < 1e-8 && found.whole < whole, "{name}");
    }
}

/// Returns whether an integrator supports a scene: here, the axial-implicit leapfrog is not used with free points.
fn serves(integrator: Integrator, scene: &Scene) -> bool {
    let free = |point: &Point| point.kind == PointKind::Free;
    integrator != Integrator::AxialImplicit || !scene.points.iter().any(free)
}

/// Asserts that a system remains at rest for ten minutes.
fn assert_rest(name: &str, mut scene: Scene, integrator: Integrator) {
    scene.solver.integrator = integrator;
    let drift = relative_drift(&scene, 600);
    println!("{name}, {integrator:?}: {drift:.1e}");
    assert!(drift < 1e-9, "{name}, {integrator:?}: {drift:e}");
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn systems_at_rest_stay_at_rest_for_ten_minutes_by_every_integrator_and_the_one_that_is_chosen() {
    for integrator in INTEGRATORS.into_iter().chain([Integrator::Auto]) {
        for (name, scene) in systems()
            .into_iter()
            .filter(|(_, scene)| serves(integrator, scene))
        {
            assert_rest(&name, scene, integrator);
        }
    }
}

/// Two ropes with a clump between them, or a bridle with a plate, in water, driven at the prescribed ends.
fn driven(bridle: bool, integrator: Integrator, step: f64) -> Scene {
    let swing = |name: &str, x: f64| {
        format!("\nmotion.{name} = {{ x = [[{x}, 6.0]], y = [[1.5, 5.0]], z = [[1.0, 4.0]], ramp = 4.0 }}")
    };
    let knot = draft(
        "water.density = 1025.0
        line_types.rope = { mass = 120.0, diameter = 0.12, axial_stiffness = 4e6, axial_damping = 0.0, drag_normal = 1.6,
          drag_tangential = 0.4, added_mass_normal = 1.0 }",
    )
    .fixed("anchor", [-80.0, 0.0, -60.0])
    .free("knot", [-30.0, 0.0, -50.0])
    .with("mass = 4000.0, volume = 0.5, drag_area = 1.0, added_mass = 0.5")
    .line("bottom", ["anchor", "knot"], "rope", 50.0, 8);
    let held = match bridle {
        true => knot
            .coupled("port", [0.0, 8.0, -10.0])
            .coupled("starboard", [0.0, -8.0, -10.0])
            .line("one", ["knot", "port"], "rope", 47.0, 8)
            .line("two", ["knot", "starboard"], "rope", 46.0, 8)
            .and(&(swing("port", 2.0) + &swing("starboard", 1.0))),
        false => knot
            .coupled("fairlead", [0.0, 0.0, -10.0])
            .line("top", ["knot", "fairlead"], "rope", 45.0, 8)
            .and(&swing("fairlead", 2.0)),
    };
    with_integrator(held.scene(), integrator, step)
}

#[test]
fn halving_the_time_step_quarters_the_error_of_a_clump_line_and_a_bridle() {
    for bridle in [false, true] {
        for (integrator, coarse) in [(Integrator::Leapfrog, 4e-3), (Integrator::GeneralisedAlpha, 4e-2)] {
            assert_second_order_in_time(coarse, |step| {
                let mut simulation = following(&driven(bridle, integrator, step));
                run(&mut simulation, 0.4, 20);
                place(&simulation, "knot")
            });
        }
    }
}

/// Free points of 800 kg at `knots`, a ring of three anchors, and coupled points above in the middle and on a small ring; `lines` of chain join them.
fn joints(knots: &[[f64; 3]], lines: &[(&str, &str, f64)]) -> Scene {
    let turned = |radius: f64, z: f64, turn: usize| {
        let angle = 2.0 * PI * turn as f64 / 3.0;
        [radius * angle.cos(), radius * angle.sin(), z]
    };
    let mut joints = draft(
        "water.density = 1025.0
        seabed.depth = 90.0
        line_types.chain = { mass = 60.0, diameter = 0.1, axial_stiffness = 3e8, axial_damping = 1e6, drag_normal = 1.3,
          drag_tangential = 0.3, added_mass_normal = 1.0 }",
    )
    .coupled("top", [0.0, 0.0, -5.0]);
    for i in 0..3 {
        joints = joints.fixed(&format!("a{i}"), turned(220.0, -90.0, i));
        joints = joints.coupled(&format!("v{i}"), turned(12.0, -5.0, i));
    }
    for (i, place) in knots.iter().enumerate() {
        let knot = joints.free(&format!("k{i}"), *place);
        joints = knot.with("mass = 800.0, volume = 0.1, drag_area = 0.5, added_mass = 0.5");
    }
    for (from, to, length) in lines {
        let elements = (length / 12.0_f64).ceil().max(4.0) as usize;
        joints = joints.line(&format!("{from}{to}"), [from, to], "chain", *length, elements);
    }
    joints.scene()
}

/// Three legs and a line to the middle, joined at one point.
fn y_joint() -> Scene {
    let legs = [
        ("a0", "k0", 240.0),
        ("a1", "k0", 240.0),
        ("a2", "k0", 240.0),
        ("k0", "top", 35.5),
    ];
    joints(&[[0.0, 0.0, -40.0]], &legs)
}

/// Three interconnected points, each with a line to an anchor and one to the vessel.
fn delta_joint() -> Scene {
    let knots = [[30.0, 0.0, -25.0], [-15.0, 26.0, -25.0], [-15.0, -26.0, -25.0]];
    let mut lines = Vec::new();
    for (anchor, knot, vessel) in [("a0", "k0", "v0"), ("a1", "k1", "v1"), ("a2", "k2", "v2")] {
        lines.push((anchor, knot, 205.0));
        lines.push((knot, vessel, 27.0));
    }
    lines.extend([("k0", "k1", 52.5), ("k1", "k2", 52.5), ("k2", "k0", 52.5)]);
    joints(&knots, &lines)
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn y_and_delta_joints_are_in_balance_turn_with_their_symmetry_and_stay_at_rest() {
    for (name, scene) in [("Y", y_joint()), ("delta", delta_joint())] {
        let simulation = start(&scene);
        let found = imbalance(&scene, &simulation);
        println!("{name}: {:.1e} {:.1e}", found.node, found.whole);
        assert!(found.node < 1e-8 && found.whole < 1e-8, "{name}");
        let force = |name: &str| simulation.end_force(simulation.model().point_index(name).unwrap());
        let [first, second] = ["a0", "a1"].map(|name| Vector3::from(force(name)));
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 2.0 * PI / 3.0);
        assert!((turn * first - second).norm() < 1e-7 * first.norm());
        let knot = place(&simulation, "k0");
        assert!(knot.y.abs() < 1e-8 && knot.z > -89.0, "{knot}");
        for integrator in JOINED {
            assert_rest(name, scene.clone(), integrator);
        }
    }
}

/// A clump on `count` equal wires from one anchor and as many to one fairlead, equivalent to the same wire for any count. In air.
fn strands(count: usize, integrator: Integrator) -> Scene {
    let part = 1.0 / count as f64;
    let mut strands = draft(format!(
        "line_types.wire = {{ mass = {}, axial_stiffness = {}, axial_damping = {} }}
        motion.fairlead = {{ x = [[1.0, 6.0]], y = [[1.0, 5.0]], ramp = 3.0 }}",
        24.0 * part,
        6e6 * part,
        6e3 * part
    ))
    .fixed("anchor", [0.0, 0.0, -20.0])
    .free("clump", [30.0, 0.0, -20.0])
    .with("mass = 500.0")
    .coupled("fairlead", [50.0, 0.0, 0.0]);
    for i in 0..count {
        strands = strands.line(&format!("anchor{i}"), ["anchor", "clump"], "wire", 32.0, 6);
        strands = strands.line(&format!("clump{i}"), ["clump", "fairlead"], "wire", 30.0, 6);
    }
    with_integrator(strands.scene(), integrator, 0.002)
}

#[test]
fn many_lines_at_one_point_are_one_line_of_their_sum() {
    for integrator in JOINED {
        let path = |count: usize| {
            let mut simulation = following(&strands(count, integrator));
            let fairlead = simulation.model().point_index("fairlead").unwrap();
            let mut path = Vec::new();
            for sample in 0..=20 {
                run(&mut simulation, 0.25, sample.min(1));
                path.push((
                    place(&simulation, "clump"),
                    Vector3::from(simulation.end_force(fairlead)),
                ));
            }
            path
        };
        let (one, many) = (path(1), path(12));
        for ((place, force), (place_many, force_many)) in one.iter().zip(&many) {
            assert!((place - place_many).norm() < 1e-7, "{integrator:?}");
            assert!(
                (force - force_many).norm() < 1e-6 * force.norm(),
                "{integrator:?}"
            );
        }
    }
}
