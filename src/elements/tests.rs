//! The tangent is the slope of the residual, and forces are objective.

use approx::assert_relative_eq;
use nalgebra::{Matrix3, Rotation3, Unit};

use super::*;
use crate::draft::draft;
use crate::model::{Bending, LineState};

const FORCES: Weights = Weights {
    force: 1.0,
    friction: 1.0,
    inertia: 1.0,
    position: 0.0,
    velocity: 0.0,
    acceleration: 0.0,
    stretch: crate::elements::Stretch::Now,
    convex: false,
    span: 0.0,
};

/// Pseudo-random number in −1 … 1.
fn noise(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6364136223846793005)
        .wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn random_vector(seed: &mut u64, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| size * noise(seed))
}

/// Two lines that meet in a free point, with the given surroundings and line type.
fn network(surroundings: &str, line_type: &str) -> Model {
    draft(format!(
        "{surroundings}
        line_types.cable = {{ axial_stiffness = 4.0e4, axial_damping = 900.0, {line_type} }}"
    ))
    .fixed("a", [0.0; 3])
    .free("joint", [3.0, 0.0, 0.0])
    .with("mass = 5.0, force = { y = 3.0 }")
    .fixed("b", [6.0, 0.0, 0.0])
    .line("one", ["a", "joint"], "cable", 3.0, 4)
    .line("two", ["b", "joint"], "cable", 3.0, 3)
    .model()
}

/// State in which both lines are bent, stretched by about a tenth, and moving.
fn random_state(model: &Model, size: f64) -> State {
    let points = model.points.iter();
    let mut state = State {
        points: points.map(|point| PointState::at_rest(point.reference)).collect(),
        lines: model
            .lines
            .iter()
            .map(|_| LineState::at_rest(Vec::new()))
            .collect(),
        ..State::default()
    };
    let mut seed = 3;
    for (line, nodes) in model.lines.iter().zip(&mut state.lines) {
        let [a, b] = line.ends.map(|point| model.points[point].reference);
        *nodes = LineState::at_rest(vec![Vector3::zeros(); line.segment_count() + 1]);
        nodes.become_viscoelastic(line);
        for i in 0..nodes.position.len() {
            let along = line.nodes.arc[i] / line.unstretched_length();
            nodes.position[i] = a + 1.2 * along * (b - a) + random_vector(&mut seed, 0.1 * size);
            nodes.velocity[i] = random_vector(&mut seed, size);
            nodes.acceleration[i] = random_vector(&mut seed, size);
        }
        let last = nodes.position.len() - 1;
        let joint = &mut state.points[1];
        (joint.position, joint.velocity) = (Vector3::new(3.6, 0.1, -0.2), Vector3::new(0.2, -0.3, 0.4));
        (nodes.position[last], nodes.velocity[last]) = (joint.position, joint.velocity);
    }
    place_joint(model, &mut state);
    state
}

fn place_joint(model: &Model, state: &mut State) {
    state.points[0].position = state.lines[0].position[0];
    state.points[2].position = state.lines[1].position[0];
    place_ends(model, &model.networks[0], state);
}

/// R of all nodes and of the free point.
fn residual(model: &Model, state: &State, work: &mut Workspace) -> Vec<Vector3<f64>> {
    work.assemble_dynamic::<false>(model, &model.networks[0], state, 0.0, &FORCES);
    collect(work)
}

fn collect(work: &Workspace) -> Vec<Vector3<f64>> {
    let nodes = work.lines.iter().flat_map(|line| line.residual.iter().copied());
    nodes.chain([work.points[1].total]).collect()
}

/// Variable to be varied: r, v or a.
#[derive(Clone, Copy)]
enum Varied {
    Position,
    Velocity,
    Acceleration,
}

fn vary(nodes: &mut LineState, varied: Varied) -> &mut Vec<Vector3<f64>> {
    match varied {
        Varied::Position => &mut nodes.position,
        Varied::Velocity => &mut nodes.velocity,
        Varied::Acceleration => &mut nodes.acceleration,
    }
}

/// Compares the blocks of J with central differences of R, node by node.
fn assert_tangent(model: &Model, state: &State, varied: Varied) {
    let only = |wanted: fn(Varied) -> bool| if wanted(varied) { 1.0 } else { 0.0 };
    let weights = Weights {
        position: only(|v| matches!(v, Varied::Position)),
        velocity: only(|v| matches!(v, Varied::Velocity)),
        acceleration: only(|v| matches!(v, Varied::Acceleration)),
        ..FORCES
    };
    let mut work = Workspace::new(model);
    work.fade_dampers(model, &model.networks[0], state, 0.0);
    work.assemble_dynamic::<true>(model, &model.networks[0], state, 0.0, &weights);
    let tangent = work.lines.clone();
    let greatest = tangent
        .iter()
        .flat_map(|line| &line.residual)
        .map(|r| r.amax())
        .fold(0.0, f64::max);
    let h = 1e-6;
    for (index, line) in tangent.iter().enumerate() {
        for node in 0..line.diagonal.len() {
            for axis in 0..3 {
                let mut moved = |step: f64| {
                    let mut state = state.clone();
                    vary(&mut state.lines[index], varied)[node][axis] += step;
                    work.assemble_dynamic::<false>(model, &model.networks[0], &state, 0.0, &FORCES);
                    work.lines[index].residual.clone()
                };
                let (high, low) = (moved(h), moved(-h));
                let slope = |i: usize| (high[i] - low[i]) / (2.0 * h);
                // truncation, and the rounding of the residual over the step
                let scale = 1e-8 * line.diagonal[node].amax() + 8.0 * f64::EPSILON * greatest / h;
                for other in node.saturating_sub(2)..(node + 3).min(line.diagonal.len()) {
                    assert_relative_eq!(
                        slope(other),
                        block(line, other, node).column(axis).into_owned(),
                        epsilon = scale
                    );
                }
            }
        }
    }
}

/// J in the row of one node and the column of another.
fn block(line: &LineWork, row: usize, column: usize) -> Matrix3<f64> {
    let low = row.min(column);
    let turned = |m: Matrix3<f64>| if row < column { m } else { m.transpose() };
    let bent = |of: fn(&BendingWork) -> &[Matrix3<f64>]| {
        let joints = line.bending.as_ref().map(of);
        joints.map_or(Matrix3::zeros(), |joints| turned(joints[low]))
    };
    match row.abs_diff(column) {
        0 => line.diagonal[row],
        1 => line.coupling[low] + bent(|joints| &joints.near),
        _ => bent(|joints| &joints.far),
    }
}

/// Gives both lines damped bending stiffness, and clamps them at fixed points; they are taut enough not to be compressed.
fn stiffen(model: &mut Model) {
    for (line, along) in model.lines.iter_mut().zip([Vector3::x(), -Vector3::x()]) {
        let n = line.segment_count();
        line.bending = Some(Bending::new(
            &line.segments.length,
            vec![300.0; n],
            &vec![0.02; n],
            [Some(along), None],
        ));
    }
}

const WATER: &str = "water.density = 1025.0";
const SEABED: &str = "seabed = { depth = 0.05, stiffness = 2.0e4, damping = 900.0, contact = 'as_given' }";

#[test]
fn the_stiffness_is_the_slope_of_the_residual_stretched_and_on_the_seabed() {
    for law in ["'engineering'", "'green'", "{ logarithmic = 0.3 }"] {
        let line_type = format!("mass = 2.0, diameter = 0.05, strain = {law}");
        let model = network(SEABED, &line_type);
        assert!(model.lines.iter().all(|line| line.nodes.contact.is_some()));
        assert_tangent(&model, &random_state(&model, 1.0), Varied::Position);
    }
}

#[test]
fn the_stiffness_is_the_slope_of_the_residual_where_lines_bend_push_and_are_clamped() {
    let mut model = network("", "mass = 2.0, diameter = 0.05");
    stiffen(&mut model);
    for stretch in [1.0, 0.75] {
        let mut state = random_state(&model, 0.5);
        for nodes in &mut state.lines {
            nodes.velocity.fill(Vector3::zeros());
            nodes.position.iter_mut().for_each(|r| *r *= stretch);
        }
        assert_tangent(&model, &state, Varied::Position);
    }
}

#[test]
fn the_stiffness_is_the_slope_of_the_residual_where_a_moment_turns_an_end() {
    let mut model = network("", "mass = 2.0, diameter = 0.05");
    stiffen(&mut model);
    let about = |moment| Some(crate::scene::TimeFunction::Constant(moment));
    model.points[1].moment = Some(crate::scene::PointMoment {
        x: None,
        y: about(40.0),
        z: about(-25.0),
    });
    let mut state = random_state(&model, 0.5);
    for nodes in &mut state.lines {
        nodes.velocity.fill(Vector3::zeros());
        // in the plane normal to the moment, so that it has a potential and the blocks of J are symmetric
        nodes.position.iter_mut().for_each(|r| {
            let axis = Vector3::new(0.0, 40.0, -25.0).normalize();
            *r -= r.dot(&axis) * axis;
        });
    }
    assert_tangent(&model, &state, Varied::Position);
}

#[test]
fn the_damping_is_the_slope_of_the_residual_where_lines_bend() {
    let mut model = network("", "mass = 2.0, diameter = 0.05");
    stiffen(&mut model);
    assert_tangent(&model, &random_state(&model, 1.0), Varied::Velocity);
}

#[test]
fn the_convex_tangent_of_a_bent_line_has_positive_pivots() {
    let mut model = network("", "mass = 2.0, diameter = 0.05");
    stiffen(&mut model);
    let state = random_state(&model, 1.0);
    let mut work = Workspace::new(&model);
    let weights = Weights {
        position: 1.0,
        acceleration: 1e-3,
        convex: true,
        ..FORCES
    };
    let network = &model.networks[0];
    work.assemble_dynamic::<true>(&model, network, &state, 0.0, &weights);
    assert!(work.solve(&model, 0));
    let line = &work.lines[0];
    let x = line.solution().iter().take(5).enumerate();
    let sum: Vector3<f64> = x.map(|(j, x)| block(line, 2, j) * x).sum();
    assert_relative_eq!(sum, line.residual[2], epsilon = 1e-6);
}

#[test]
fn the_damping_is_the_slope_of_the_residual_in_water_and_on_the_seabed() {
    let line_type = "mass = 2.0, diameter = 0.05, drag_normal = 1.2, drag_tangential = 0.3, \
                     rayleigh = { ratios = [0.02, 0.02], frequencies = [1.0, 9.0] }";
    let model = network(&format!("{WATER}\n{SEABED}"), line_type);
    assert_tangent(&model, &random_state(&model, 1.0), Varied::Velocity);
}

#[test]
fn the_damping_is_the_slope_of_the_residual_in_a_sheared_current() {
    let line_type = "mass = 2.0, diameter = 0.05, drag_normal = 1.2, drag_tangential = 0.3";
    let current = "water.current = { profile = [[1.0, 0.9, -0.4], [-1.0, 0.1, 0.3]], factor = 1.3 }";
    let model = network(&format!("{WATER}\n{current}"), line_type);
    assert_tangent(&model, &random_state(&model, 1.0), Varied::Velocity);
}

#[test]
fn the_mass_is_the_slope_of_the_residual_with_unequal_added_mass() {
    let line_type = "mass = 2.0, diameter = 0.05, added_mass_normal = 1.0, added_mass_tangential = 0.1";
    let model = network(WATER, line_type);
    assert_tangent(&model, &random_state(&model, 1.0), Varied::Acceleration);
}

/// Water with a surface at z = 0 that the lines of [`network`] cross.
const SURFACE: &str = "water = { density = 1025.0, surface = true }";

#[test]
fn the_stiffness_is_the_slope_of_the_residual_where_lines_pierce_the_surface() {
    let model = network(SURFACE, "mass = 2.0, diameter = 0.2");
    let mut state = random_state(&model, 1.0);
    for nodes in &mut state.lines {
        nodes.velocity.fill(Vector3::zeros());
        nodes.acceleration.fill(Vector3::zeros());
    }
    assert_tangent(&model, &state, Varied::Position);
    let mut work = Workspace::new(&model);
    residual(&model, &state, &mut work);
    let parts: Vec<f64> = work.lines[0].dry.iter().map(|dry| dry.part).collect();
    assert!(parts.iter().any(|part| (0.1..0.9).contains(part)), "{parts:?}");
}

#[test]
fn damping_and_mass_are_slopes_of_the_residual_where_lines_pierce_the_surface() {
    let line_type = "mass = 2.0, diameter = 0.2, drag_normal = 1.2, drag_tangential = 0.3, \
                     added_mass_normal = 1.0, added_mass_tangential = 0.1";
    let model = network(SURFACE, line_type);
    assert_tangent(&model, &random_state(&model, 1.0), Varied::Velocity);
    assert_tangent(&model, &random_state(&model, 1.0), Varied::Acceleration);
}

#[test]
fn drag_and_added_mass_have_their_own_slope_with_a_nodes_height() {
    // equal along and across, so that the frozen tangent of the line has no effect
    let line_type = "mass = 2.0, diameter = 0.2, added_mass_normal = 1.0, added_mass_tangential = 1.0";
    let model = network(SURFACE, line_type);
    let mut state = random_state(&model, 1.0);
    for nodes in &mut state.lines {
        nodes.velocity.fill(Vector3::zeros());
    }
    let weights = Weights {
        position: 1.0,
        ..FORCES
    };
    let mut work = Workspace::new(&model);
    work.assemble_dynamic::<true>(&model, &model.networks[0], &state, 0.0, &weights);
    let tangent = work.lines[0].diagonal.clone();
    let h = 1e-6;
    for (node, tangent) in tangent.iter().enumerate() {
        let mut moved = |step: f64| {
            let mut state = state.clone();
            state.lines[0].position[node].z += step;
            work.assemble_dynamic::<false>(&model, &model.networks[0], &state, 0.0, &FORCES);
            work.lines[0].residual[node]
        };
        let slope = (moved(h) - moved(-h)) / (2.0 * h);
        assert_relative_eq!(tangent.column(2).into_owned(), slope, epsilon = 1e-3);
    }
}

#[test]
fn tensions_of_a_line_sum_to_zero() {
    let model = network("gravity = 0.0", "mass = 0.0");
    let state = random_state(&model, 1.0);
    let mut work = Workspace::new(&model);
    residual(&model, &state, &mut work);
    for line in &work.lines {
        let sum: Vector3<f64> = line.residual.iter().sum();
        let greatest = line.residual.iter().map(|r| r.amax()).fold(0.0, f64::max);
        assert_relative_eq!(sum, Vector3::zeros(), epsilon = 1e-14 * greatest);
    }
}

#[test]
fn rotating_the_world_rotates_the_forces() {
    let line_type = "mass = 2.0, weight = 0.0, diameter = 0.05, drag_normal = 1.2, drag_tangential = 0.3, \
                     added_mass_normal = 1.0, added_mass_tangential = 0.1";
    let mut model = network(WATER, line_type);
    let mut state = random_state(&model, 1.0);
    let mut work = Workspace::new(&model);
    if let crate::model::Role::Free(free) = &mut model.points[1].role {
        free.weight = 0.0;
    }
    model.points[1].load = None;
    let before = residual(&model, &state, &mut work);
    let axis = Unit::new_normalize(Vector3::new(1.0, -2.0, 0.5));
    let turn = Rotation3::from_axis_angle(&axis, 0.8);
    for nodes in &mut state.lines {
        for varied in [Varied::Position, Varied::Velocity, Varied::Acceleration] {
            vary(nodes, varied).iter_mut().for_each(|x| *x = turn * *x);
        }
    }
    for point in &mut state.points {
        point.acceleration = turn * point.acceleration;
    }
    let after = residual(&model, &state, &mut work);
    let greatest = before.iter().map(|r| r.amax()).fold(0.0, f64::max);
    for (before, after) in before.iter().zip(&after) {
        assert_relative_eq!(turn * before, *after, epsilon = 1e-13 * greatest);
    }
}

#[test]
fn the_linear_solution_satisfies_the_system_of_both_lines_and_the_point() {
    let model = network(SEABED, "mass = 2.0, diameter = 0.05");
    let state = random_state(&model, 1.0);
    let mut work = Workspace::new(&model);
    let weights = Weights {
        position: 1.0,
        velocity: 40.0,
        acceleration: 900.0,
        ..FORCES
    };
    let network = &model.networks[0];
    work.assemble_dynamic::<true>(&model, network, &state, 0.0, &weights);
    assert!(work.solve(&model, 0));
    let mut joint = work.points[1].diagonal * work.points[1].solution - work.points[1].residual;
    for line in &work.lines {
        let x = line.solution();
        let last = x.len() - 1;
        let row = |i: usize| {
            let mut sum = line.diagonal[i] * x[i] - line.residual[i];
            if i > 0 {
                sum += line.coupling[i - 1] * x[i - 1];
            }
            if i < last {
                sum += line.coupling[i] * x[i + 1];
            }
            sum
        };
        for i in 1..last {
            assert_relative_eq!(row(i), Vector3::zeros(), epsilon = 1e-9);
        }
        joint += row(last);
    }
    assert_relative_eq!(joint, Vector3::zeros(), epsilon = 1e-9);
}
