//! Mooring systems of the kinds that are built: a riser hanging in a current, a catenary with a clump weight, a bridle with a free
//! plate, a lazy wave. Their equilibria are checked against a balance of forces drawn up here, from the scene's own words.
//!
//! ```text
//!    → ● hang_off     ● fairlead       port ●             ● hang_off
//!   → ╱                ╲                     ╲    _        ╲    ╭─╮ buoyant
//!    │                  ● clump        plate  ●──            ╲__╯  ╲
//!    ╰──● base           ╲___● anchor  stbd  ╱               ═══════╲___● seabed_end
//! ```

mod common;

use std::f64::consts::PI;

use common::*;
use moorline::model::{Contact, End};
use moorline::scene::{Current, Integrator, LineType, Point, PointKind, Scene};
use moorline::simulation::Simulation;
use nalgebra::Vector3;

const SYSTEMS: [&str; 4] = ["hanging_riser", "clump_weight", "bridle", "lazy_wave"];

/// A current that no symmetry of a system helps with.
const OBLIQUE: &str = "profile = [[0.0, 0.7, 0.5], [-60.0, 0.3, 0.4], [-200.0, 0.1, -0.1]]";

/// Every system as it is shipped, and in a current across it.
fn systems() -> Vec<(String, Scene)> {
    let both = |name: &str| {
        let (plain, mut drifting) = (shipped(name), shipped(name));
        let current: Current = moorline::scene::part(OBLIQUE).unwrap();
        drifting.water.as_mut().unwrap().current = Some(current);
        [
            (name.to_string(), plain),
            (format!("{name} in a current"), drifting),
        ]
    };
    SYSTEMS.into_iter().flat_map(both).collect()
}

/// The current at a height z [m/s], from the rows that the scene gives.
fn current(scene: &Scene, z: f64) -> Vector3<f64> {
    let water = scene.water.as_ref().unwrap();
    let Some(mut rows) = water.current.as_ref().and_then(|c| c.profile.clone()) else {
        return Vector3::zeros();
    };
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let z = z.clamp(rows[0][0], rows[rows.len() - 1][0]);
    let pair = rows.windows(2).find(|pair| z <= pair[1][0]).unwrap();
    let u = (z - pair[0][0]) / (pair[1][0] - pair[0][0]);
    Vector3::new(
        pair[0][1] + u * (pair[1][1] - pair[0][1]),
        pair[0][2] + u * (pair[1][2] - pair[0][2]),
        0.0,
    )
}

/// Weight less buoyancy of a line type [N/m].
fn wet_weight(scene: &Scene, kind: &LineType) -> f64 {
    let water = scene.water.as_ref().unwrap();
    let area = 0.25 * PI * kind.diameter.unwrap().powi(2);
    (kind.mass.unwrap() - water.density * area) * scene.gravity
}

/// Drag of the current on a length [m] of a line type that lies along `t` [N].
fn drag(scene: &Scene, kind: &LineType, length: f64, t: Vector3<f64>, z: f64) -> Vector3<f64> {
    let u = current(scene, z);
    let along = u.dot(&t) * t;
    let across = u - along;
    let half = 0.5 * scene.water.as_ref().unwrap().density * kind.diameter.unwrap() * length;
    half * (kind.drag_normal.unwrap_or(0.0) * across.norm() * across
        + PI * kind.drag_tangential.unwrap_or(0.0) * along.norm() * along)
}

/// Weight, buoyancy, drag of the current and push of the bed on every node of a line [N], end nodes with their half of a segment, and
/// the tensions of its segments [N]. The springs of the bed are those of the model.
fn loads(
    scene: &Scene,
    number: usize,
    nodes: &[Vector3<f64>],
    contact: Option<&Contact>,
) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
    let count = |section: &moorline::scene::Section| section.elements.unwrap();
    let kinds: Vec<(&LineType, f64)> = scene.lines[number]
        .sections
        .iter()
        .flat_map(|section| {
            let piece = section.length / count(section) as f64;
            vec![(&scene.line_types[&section.line_type], piece); count(section)]
        })
        .collect();
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
        for (i, force) in forces.iter_mut().enumerate() {
            force.z += contact.stiffness[i] * (contact.level[i] - nodes[i].z).max(0.0);
        }
    }
    (forces, pulls)
}

/// Weight, buoyancy and drag of a free point deep in the water [N].
fn point_load(scene: &Scene, point: &Point, place: Vector3<f64>) -> Vector3<f64> {
    let density = scene.water.as_ref().unwrap().density;
    let u = current(scene, place.z);
    let lift = density * point.volume.unwrap_or(0.0) - point.mass.unwrap_or(0.0);
    lift * scene.gravity * Vector3::z() + 0.5 * density * point.drag_area.unwrap_or(0.0) * u.norm() * u
}

/// The scene with the elements that the model gave its sections written out.
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

/// Greatest force out of balance over the weight of all lines: at a node or free point, and of each line and of the whole as the
/// program reports their end forces.
struct Imbalance {
    node: f64,
    whole: f64,
}

fn imbalance(scene: &Scene, simulation: &Simulation) -> Imbalance {
    let (model, state) = (simulation.model(), simulation.state());
    let scene = &with_its_elements(scene.clone(), simulation);
    let weight: f64 = scene
        .lines
        .iter()
        .flat_map(|line| &line.sections)
        .map(|section| section.length * wet_weight(scene, &scene.line_types[&section.line_type]).abs())
        .sum();
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
        let simulation = Simulation::new(&scene).unwrap();
        let found = imbalance(&scene, &simulation);
        println!("{name}: {:.1e} {:.1e}", found.node, found.whole);
        // in a current, end forces take the drag along the last element as linear, where the nodes have it lumped
        let flows = scene.water.as_ref().is_some_and(|water| water.current.is_some());
        let whole = if flows { 2e-3 } else { 1e-8 };
        assert!(found.node < 1e-8 && found.whole < whole, "{name}");
    }
}

/// Greatest distance of a node from where it was after ten minutes, over the length of its line [-].
fn drift(scene: &Scene) -> f64 {
    let mut simulation = Simulation::new(scene).unwrap();
    let start = simulation.state().clone();
    while simulation.time() < 599.5 {
        simulation.advance(1.0).unwrap();
    }
    let lines = simulation.state().lines.iter().enumerate();
    let drifts = lines.map(|(line, shape)| {
        let pairs = shape.position.iter().zip(&start.lines[line].position);
        let far = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        far / simulation.model().lines[line].unstretched_length()
    });
    drifts.fold(0.0, f64::max)
}

/// Whether an integrator serves a scene: the axial-implicit leapfrog knows no free points.
fn serves(integrator: Integrator, scene: &Scene) -> bool {
    let free = |point: &Point| point.kind == PointKind::Free;
    integrator != Integrator::AxialImplicit || !scene.points.iter().any(free)
}

/// Claims that all systems which an integrator serves stay where they are.
fn assert_rest(integrator: Integrator) {
    for (name, mut scene) in systems() {
        if serves(integrator, &scene) {
            scene.solver.integrator = integrator;
            let drift = drift(&scene);
            println!("{name}, {integrator:?}: {drift:.1e}");
            assert!(drift < 1e-9, "{name}, {integrator:?}: {drift:e}");
        }
    }
}

#[test]
fn systems_at_rest_stay_at_rest_for_ten_minutes_by_the_integrator_that_is_chosen() {
    assert_rest(Integrator::Auto);
}

#[test]
fn systems_at_rest_stay_at_rest_for_ten_minutes_by_the_leapfrog() {
    assert_rest(Integrator::Leapfrog);
}

#[test]
fn systems_at_rest_stay_at_rest_for_ten_minutes_by_the_axial_implicit_leapfrog() {
    assert_rest(Integrator::AxialImplicit);
}

#[test]
fn systems_at_rest_stay_at_rest_for_ten_minutes_by_generalised_alpha() {
    assert_rest(Integrator::GeneralisedAlpha);
}

/// A line of two ropes with a clump between them, or a bridle with a plate, in water, driven at its held ends.
fn driven(bridle: bool, integrator: Integrator, step: f64) -> Scene {
    let rope = "mass = 120.0, diameter = 0.12, axial_stiffness = 4e6, axial_damping = 0.0, drag_normal = 1.6, drag_tangential = 0.4, added_mass_normal = 1.0";
    let swing = |name: &str, x: f64| {
        format!("{name} = {{ x = [[{x}, 6.0]], y = [[1.5, 5.0]], z = [[1.0, 4.0]], ramp = 4.0 }}")
    };
    let (held, lines, motion) = if bridle {
        (
            r#"{ name = "port", position = [0.0, 8.0, -10.0], kind = "coupled" },
               { name = "starboard", position = [0.0, -8.0, -10.0], kind = "coupled" },"#,
            r#"{ name = "one", from = "knot", to = "port", sections = [{ type = "rope", length = 47.0, elements = 8 }] },
               { name = "two", from = "knot", to = "starboard", sections = [{ type = "rope", length = 46.0, elements = 8 }] },"#,
            format!("{}, {}", swing("port", 2.0), swing("starboard", 1.0)),
        )
    } else {
        (
            r#"{ name = "fairlead", position = [0.0, 0.0, -10.0], kind = "coupled" },"#,
            r#"{ name = "top", from = "knot", to = "fairlead", sections = [{ type = "rope", length = 45.0, elements = 8 }] },"#,
            swing("fairlead", 2.0),
        )
    };
    let text = format!(
        r#"
        water.density = 1025.0
        line_types.rope = {{ {rope} }}
        points = [
          {{ name = "anchor", position = [-80.0, 0.0, -60.0], kind = "fixed" }},
          {{ name = "knot", position = [-30.0, 0.0, -50.0], kind = "free", mass = 4000.0, volume = 0.5, drag_area = 1.0, added_mass = 0.5 }},
          {held}
        ]
        lines = [
          {{ name = "bottom", from = "anchor", to = "knot", sections = [{{ type = "rope", length = 50.0, elements = 8 }}] }},
          {lines}
        ]
        motion = {{ {motion} }}
        "#
    );
    with_integrator(scene(&text), integrator, step)
}

#[test]
fn halving_the_time_step_quarters_the_error_of_a_clump_line_and_a_bridle() {
    for bridle in [false, true] {
        for (integrator, coarse) in [(Integrator::Leapfrog, 4e-3), (Integrator::GeneralisedAlpha, 4e-2)] {
            let steps = [1.0, 0.5, 0.25, 0.125, 1.0 / 32.0].map(|part| part * coarse);
            let places = steps.map(|step| {
                let mut simulation = following(&driven(bridle, integrator, step));
                for _ in 0..20 {
                    simulation.advance(0.4).unwrap();
                }
                let knot = simulation.model().point_index("knot").unwrap();
                simulation.state().points[knot].position
            });
            let errors = [0, 1, 2, 3].map(|i| (places[i] - places[4]).norm());
            println!("{bridle} {integrator:?}: {errors:?}");
            assert_order(2.0, &steps[..4], &errors);
        }
    }
}

/// Free points of 800 kg at `knots`, anchored by chains to a ring of three anchors, held up by a rope to a buoy's place in the middle.
fn joints(knots: &[[f64; 3]], lines: &[(&str, &str, f64)]) -> Scene {
    let turned = |radius: f64, z: f64, turn: f64| {
        let angle = 2.0 * PI * turn / 3.0;
        format!("[{}, {}, {z}]", radius * angle.cos(), radius * angle.sin())
    };
    let mut points = format!(
        r#"{{ name = "top", position = {}, kind = "coupled" }},"#,
        "[0.0, 0.0, -5.0]"
    );
    for i in 0..3 {
        let (anchor, vessel) = (turned(220.0, -90.0, i as f64), turned(12.0, -5.0, i as f64));
        points += &format!(r#"{{ name = "a{i}", position = {anchor}, kind = "fixed" }},"#);
        points += &format!(r#"{{ name = "v{i}", position = {vessel}, kind = "coupled" }},"#);
    }
    for (i, place) in knots.iter().enumerate() {
        points += &format!(
            r#"{{ name = "k{i}", position = {place:?}, kind = "free", mass = 800.0, volume = 0.1, drag_area = 0.5, added_mass = 0.5 }},"#
        );
    }
    let lines: String = lines
        .iter()
        .map(|(from, to, length)| {
            format!(r#"{{ name = "{from}{to}", from = "{from}", to = "{to}", sections = [{{ type = "chain", length = {length}, elements = {} }}] }},"#,
                (length / 12.0_f64).ceil().max(4.0))
        })
        .collect();
    scene(&format!(
        r#"
        water.density = 1025.0
        seabed.depth = 90.0
        line_types.chain = {{ mass = 60.0, diameter = 0.1, axial_stiffness = 3e8, axial_damping = 1e6, drag_normal = 1.3, drag_tangential = 0.3, added_mass_normal = 1.0 }}
        points = [{points}]
        lines = [{lines}]
        "#
    ))
}

/// Three lines at one point.
fn y_joint() -> Scene {
    joints(
        &[[0.0, 0.0, -40.0]],
        &[
            ("a0", "k0", 240.0),
            ("a1", "k0", 240.0),
            ("a2", "k0", 240.0),
            ("k0", "top", 35.5),
        ],
    )
}

/// Three points tied to each other, each to an anchor and to the vessel.
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
fn y_and_delta_joints_are_in_balance_turn_with_their_symmetry_and_stay_at_rest() {
    for (name, mut scene) in [("Y", y_joint()), ("delta", delta_joint())] {
        let simulation = Simulation::new(&scene).unwrap();
        let found = imbalance(&scene, &simulation);
        println!("{name}: {:.1e} {:.1e}", found.node, found.whole);
        assert!(found.node < 1e-8 && found.whole < 1e-8, "{name}");
        let (model, state) = (simulation.model(), simulation.state());
        let force = |name: &str| simulation.end_force(model.point_index(name).unwrap());
        let [first, second] = ["a0", "a1"].map(|name| Vector3::from(force(name)));
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 2.0 * PI / 3.0);
        assert!((turn * first - second).norm() < 1e-7 * first.norm());
        let knot = state.points[model.point_index("k0").unwrap()].position;
        assert!(knot.y.abs() < 1e-8 && knot.z > -89.0, "{knot}");
        for integrator in [Integrator::Leapfrog, Integrator::GeneralisedAlpha] {
            scene.solver.integrator = integrator;
            let drift = drift(&scene);
            println!("{name}, {integrator:?}: {drift:.1e}");
            assert!(drift < 1e-9, "{name}, {integrator:?}: {drift:e}");
        }
    }
}

/// A clump on `count` equal wires from one anchor and on as many to one fairlead, all together always the same wire. In the dry.
fn strands(count: usize, integrator: Integrator) -> Scene {
    let part = 1.0 / count as f64;
    let lines: String = (0..count)
        .flat_map(|i| [("anchor", "clump", 32.0, i), ("clump", "fairlead", 30.0, i)])
        .map(|(from, to, length, i)| {
            format!(r#"{{ name = "{from}{i}", from = "{from}", to = "{to}", sections = [{{ type = "wire", length = {length}, elements = 6 }}] }},"#)
        })
        .collect();
    let text = format!(
        r#"
        line_types.wire = {{ mass = {}, axial_stiffness = {}, axial_damping = {} }}
        points = [
          {{ name = "anchor", position = [0.0, 0.0, -20.0], kind = "fixed" }},
          {{ name = "clump", position = [30.0, 0.0, -20.0], kind = "free", mass = 500.0 }},
          {{ name = "fairlead", position = [50.0, 0.0, 0.0], kind = "coupled" }},
        ]
        lines = [{lines}]
        motion.fairlead = {{ x = [[1.0, 6.0]], y = [[1.0, 5.0]], ramp = 3.0 }}
        "#,
        24.0 * part,
        6e6 * part,
        6e3 * part
    );
    with_integrator(scene(&text), integrator, 0.002)
}

#[test]
fn many_lines_at_one_point_are_one_line_of_their_sum() {
    for integrator in [Integrator::Leapfrog, Integrator::GeneralisedAlpha] {
        let path = |count: usize| {
            let mut simulation = following(&strands(count, integrator));
            let clump = simulation.model().point_index("clump").unwrap();
            let fairlead = simulation.model().point_index("fairlead").unwrap();
            let sample = |simulation: &Simulation| {
                let force = Vector3::from(simulation.end_force(fairlead));
                (simulation.state().points[clump].position, force)
            };
            let mut path = vec![sample(&simulation)];
            for _ in 0..20 {
                simulation.advance(0.25).unwrap();
                path.push(sample(&simulation));
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
