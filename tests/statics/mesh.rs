//! Elements of lines for which a scene leaves them open.

use crate::common::*;
use approx::assert_relative_eq;
use moorline::discretisation;
use moorline::model::Model;
use moorline::scene::{InitialShape, Scene};
use moorline::simulation::Simulation;

#[test]
fn lines_that_meet_share_elements_by_length_and_lines_alone_have_all_of_them() {
    for (name, counts) in [
        ("bridle", &[3, 3, 40][..]),
        ("clump_weight", &[40, 21]),
        ("oc3_catenary", &[40]),
    ] {
        let model = Model::new(&open(shipped(name))).unwrap();
        let found: Vec<usize> = model.lines.iter().map(|line| line.segment_count()).collect();
        assert_eq!(found, counts);
    }
}

/// The power cable clamped at its hang-off in a direction other than that in which it would hang.
fn bent_cable() -> Scene {
    let mut scene = shipped("power_cable");
    scene.lines[0].clamped_b = Some([-0.5, 0.0, 0.866]);
    scene
}

/// Greatest curvature [1/m] of a cable at rest, and its number of elements.
fn curvature(scene: &Scene) -> (f64, usize) {
    let simulation = start(scene);
    let nodes = simulation.bending(0).unwrap();
    let most = greatest(nodes.iter().map(|node| node.curvature));
    (most, simulation.model().lines[0].segment_count())
}

#[test]
fn elements_that_are_short_where_a_cable_bends_find_its_curvature_with_few_of_them() {
    let mut fine = bent_cable();
    for (section, count) in fine.lines[0].sections.iter_mut().zip([400, 200, 1440]) {
        section.elements = Some(count);
    }
    let (exact, _) = curvature(&fine);
    let (found, count) = curvature(&open(bent_cable()));
    println!("{found} with {count} elements, {exact}");
    assert!((found / exact - 1.0).abs() < 0.03 && count < 204);
    let mut uniform = open(bent_cable());
    for section in &mut uniform.lines[0].sections {
        section.elements = Some((section.length / 240.0 * count as f64).round() as usize);
    }
    let (equal, _) = curvature(&uniform);
    assert!(
        (equal / exact - 1.0).abs() > 3.0 * (found / exact - 1.0).abs(),
        "{equal}"
    );
}

#[test]
fn the_mesh_is_described_with_its_reasons() {
    let words = |scene: &Scene| Model::new(scene).unwrap().mesh_in_words(scene);
    assert_eq!(
        words(&shipped("oc3_catenary")),
        ["line1: 40 elements of 22.55 m, as given"]
    );
    assert_eq!(
        words(&shipped("bridle"))[0],
        "leg_port: 3 elements of 8.333 m, by rules for a target error of 2 %, in proportion to the longest line that it is tied to"
    );
    let cable = &words(&open(bent_cable()))[0];
    println!("{cable}");
    assert_says(
        cable,
        &["at the clamp at end B for a bend of", "at the touchdown"],
    );
}

#[test]
fn a_line_at_rest_has_as_many_elements_as_its_static_tension_needs() {
    // a slack chain of 711 m; its top is 29 m above the seabed on which the rest lies
    let scene = draft(
        "seabed = { depth = 200.0, stiffness = 3e6, damping = 3e5 }
        line_types.chain = { mass = 100.0, weight = 860.0, diameter = 0.1, axial_stiffness = 5.4e8 }",
    )
    .fixed("anchor", [0.0, 0.0, -200.0])
    .coupled("top", [682.4, 0.0, -171.3])
    .line("line", ["anchor", "top"], "chain", 711.0, None)
    .scene();
    let tension_error = |scene: &Scene| {
        let simulation = start(scene);
        simulation.tension_b(0) / simulation.catenary(0).unwrap().tension_b() - 1.0
    };
    assert!(tension_error(&scene).abs() > 0.05); // 40 elements, from the rule
    let settled = discretisation::select(&scene).unwrap();
    assert!(tension_error(&settled.scene).abs() < 0.02);
    let mesh = &settled.meshes[0];
    let [before, after] = mesh.rest.unwrap().errors;
    assert!(before > 0.05 && after < 0.02 && mesh.elements > 40);
    assert_says(&settled.in_words()[0], &["at rest"]);
    let mut still = open(shipped("oc3_catenary"));
    still.motion.clear();
    assert!(discretisation::select(&still).is_none());
    let (found, at_rest) = discretisation::at_rest(&scene).unwrap();
    assert_eq!(found, Some(settled.clone()));
    assert_eq!(at_rest.snapshot(), start(&settled.scene).snapshot());
}

#[test]
fn an_equilibrium_alone_is_that_found_after_the_start() {
    for (name, initial) in [
        ("oc3_catenary", InitialShape::Static),
        ("bridle", InitialShape::Static),
        ("bridle", InitialShape::Straight),
        ("power_cable", InitialShape::Static),
    ] {
        let mut scene = shipped(name);
        scene.lines[0].initial = initial;
        let found = start(&scene).in_equilibrium().unwrap();
        let alone = Simulation::at_rest(&scene).unwrap();
        assert_eq!(alone.snapshot(), found.snapshot(), "{name}");
        assert_eq!(alone.tension_b(0), found.tension_b(0), "{name}");
    }
}

/// Asserts that the axial damping of every segment of a 100 m rope with a damping ratio of 0.1 is that for `elements` elements: ζ L/n √(EA m) [N s].
fn assert_damping(elements: f64, section: &str, solver: &str) {
    let model = model(&format!(
        "line_types.rope = {{ mass = 4.0, axial_stiffness = 1e6, damping_ratio = 0.1 }}
        points = [{{ name = 'a', position = [0.0, 0.0, 0.0], kind = 'fixed' }},
                  {{ name = 'b', position = [99.0, 0.0, 0.0], kind = 'coupled' }}]
        lines = [{{ name = 'line', from = 'a', to = 'b', sections = [{{ type = 'rope', length = 100.0{section} }}] }}]
        solver = {{ {solver} }}"
    ));
    for damping in &model.lines[0].segments.axial_damping {
        assert_relative_eq!(*damping, 0.1 * (100.0 / elements) * 2e3, max_relative = 1e-14);
    }
}

#[test]
fn a_damping_ratio_is_one_damping_on_every_mesh() {
    for (section, solver) in [
        ("", ""),
        ("", "tolerance = 0.005"),
        ("", "elements = 320"),
        (", elements = 7", ""),
    ] {
        assert_damping(40.0, section, solver);
    }
}

#[test]
fn a_damping_ratio_of_stated_elements_refers_to_those() {
    for elements in [5, 20, 80] {
        assert_damping(
            20.0,
            &format!(", elements = {elements}, damping_elements = 20"),
            "",
        );
    }
}
