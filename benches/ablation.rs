//! Cost of each piece of physics: one scene, with one feature after another taken out of it.

mod common;

use moorline::scene::{Integrator, Scene};

fn main() {
    let full = || {
        let mut scene = common::scene("oc3_catenary");
        scene.solver.integrator = Integrator::Leapfrog;
        scene
    };
    let chain = |scene: &mut Scene, change: &dyn Fn(&mut moorline::scene::LineType)| {
        scene.line_types.values_mut().for_each(change);
    };
    let mut cases: Vec<(&str, Scene)> = vec![("all of it", full())];
    let mut without = |name, change: &dyn Fn(&mut Scene)| {
        let mut scene = full();
        change(&mut scene);
        cases.push((name, scene));
    };
    without("no seabed", &|scene| scene.seabed = None);
    without("no axial damping", &|scene| {
        chain(scene, &|line| line.axial_damping = Some(0.0))
    });
    without("no drag", &|scene| {
        chain(scene, &|line| {
            (line.drag_normal, line.drag_tangential) = (None, None)
        });
    });
    let dry = |scene: &mut Scene| {
        let weight = 698.0; // as in water: the shape stays
        scene.water = None;
        chain(scene, &|line| line.weight = Some(weight));
    };
    without("no water", &dry);
    without("no water, no seabed, no damping", &|scene| {
        dry(scene);
        scene.seabed = None;
        chain(scene, &|line| line.axial_damping = Some(0.0));
    });
    println!(
        "{:<34} {:>14} {:>10}",
        "oc3_catenary, n = 40, leapfrog", "ns/node/step", "of all"
    );
    let mut all = None;
    for (name, scene) in cases {
        let cost = common::measure(&scene).node_step;
        println!(
            "{name:<34} {cost:>14.2} {:>9.0}%",
            100.0 * cost / *all.get_or_insert(cost)
        );
    }
}
