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
        let current: Current = toml::from_str(OBLIQUE).unwrap();
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
        let tension = kind.axial_stiffness * (chord.norm() / length - 1.0).max(0.0);
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
    lift * scene.gravity * Vector3::z()
        + 0.5 * density * point.drag_area.unwrap_or(0.0) * u.norm() * u
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
        .map(|section| {
            section.length * wet_weight(scene, &scene.line_types[&section.line_type]).abs()
        })
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
        assert!(found.node < 1e-8 && found.whole < 1e-8, "{name}");
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

#[test]
fn systems_at_rest_stay_at_rest_for_ten_minutes() {
    for (name, mut scene) in systems() {
        for integrator in [
            Integrator::Auto,
            Integrator::Leapfrog,
            Integrator::AxialImplicit,
            Integrator::GeneralisedAlpha,
        ] {
            if !serves(integrator, &scene) {
                continue;
            }
            scene.solver.integrator = integrator;
            let drift = drift(&scene);
            println!("{name}, {integrator:?}: {drift:.1e}");
            assert!(drift < 1e-9, "{name}, {integrator:?}: {drift:e}");
        }
    }
}
