//! Cost of each physical feature: one scene, with one feature after another removed; and the cost of laws that are more expensive than those of a
//! plain line.

mod common;

use moorline::scene::{DepthGrid, Friction, Integrator, LineType, Scene, Seabed, Strain, TensionStrain};

fn main() {
    taken_out();
    for integrator in [Integrator::Leapfrog, Integrator::AxialImplicit] {
        other_laws(integrator);
    }
}

/// Named changes of a scene.
type Changes = Vec<(&'static str, Box<dyn Fn(&mut Scene)>)>;

/// Measures laws that are more expensive than those of a plain line, one after another.
fn other_laws(integrator: Integrator) {
    let plain = || {
        let mut scene = common::scene("oc3_catenary");
        scene.solver.integrator = integrator;
        scene.solver.time_step_max = 0.0125;
        scene
    };
    let mut cases = vec![("plain", plain())];
    for (name, change) in other_seabeds().into_iter().chain(other_ropes()) {
        let mut scene = plain();
        change(&mut scene);
        cases.push((name, scene));
    }
    table(&format!("oc3_catenary, n = 40, {integrator:?}"), cases);
}

/// Seabeds that are not level planes without friction.
fn other_seabeds() -> Changes {
    let seabed = |change: fn(&mut Seabed)| -> Box<dyn Fn(&mut Scene)> {
        Box::new(move |scene| scene.seabed.iter_mut().for_each(change))
    };
    vec![
        (
            "friction",
            seabed(|seabed| seabed.friction = Friction::isotropic(0.5)),
        ),
        ("slope", seabed(|seabed| seabed.slope = Some([0.01, 0.01]))),
        (
            "slope and friction",
            seabed(|seabed| (seabed.slope, seabed.friction) = (Some([0.01, 0.01]), Friction::isotropic(0.5))),
        ),
        (
            "soundings",
            seabed(|seabed| {
                let line: Vec<f64> = (-10..=10).map(|i| 100.0 * f64::from(i)).collect();
                let depth = |y: &f64| {
                    line.iter()
                        .map(|x| seabed.depth + 0.5 * (0.01 * (x + y)).sin())
                        .collect()
                };
                let depth = line.iter().map(depth).collect();
                seabed.grid = Some(DepthGrid {
                    x: line.clone(),
                    y: line,
                    depth,
                });
            }),
        ),
    ]
}

/// Ropes whose tension is not proportional to strain, and one that may come out of the water.
fn other_ropes() -> Changes {
    let rope = |change: fn(&mut LineType)| -> Box<dyn Fn(&mut Scene)> {
        Box::new(move |scene| scene.line_types.values_mut().for_each(change))
    };
    vec![
        ("Green strain", rope(|line| line.strain = Strain::Green)),
        (
            "table",
            rope(|line| {
                let stiffness = line.axial_stiffness.take().expect("a stiffness");
                let row = |strain: f64| [strain, stiffness * strain * (1.0 + strain)];
                let rows = (0..=10).map(|i| row(0.01 * f64::from(i))).collect();
                line.tension_strain = Some(TensionStrain { file: None, rows });
            }),
        ),
        (
            "viscoelastic",
            rope(|line| {
                let stiffness = line.axial_stiffness.take().expect("a stiffness");
                (line.axial_damping, line.damping_ratio) = (None, None);
                (line.static_stiffness, line.dynamic_stiffness) = (Some(stiffness), Some(2.0 * stiffness));
                (line.static_damping, line.dynamic_damping) = (Some(stiffness), Some(1e-3 * stiffness));
            }),
        ),
        (
            "may pierce the surface",
            Box::new(|scene| {
                scene
                    .water
                    .iter_mut()
                    .for_each(|water| water.surface = Some(true))
            }),
        ),
    ]
}

/// Measures the scene with one feature after another removed.
fn taken_out() {
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
        let weight = 698.0; // as in water, so that the shape does not change
        scene.water = None;
        chain(scene, &|line| line.weight = Some(weight));
    };
    without("no water", &dry);
    without("no water, no seabed, no damping", &|scene| {
        dry(scene);
        scene.seabed = None;
        chain(scene, &|line| line.axial_damping = Some(0.0));
    });
    table("oc3_catenary, n = 40, leapfrog", cases);
}

/// Prints the cost of scenes, compared with the first.
fn table(title: &str, cases: Vec<(&str, Scene)>) {
    println!("{title:<34} {:>14} {:>10}", "ns/node/step", "of first");
    let mut first = None;
    for (name, scene) in cases {
        let cost = common::measure(&scene).node_step;
        println!(
            "{name:<34} {cost:>14.2} {:>9.0}%",
            100.0 * cost / *first.get_or_insert(cost)
        );
    }
}
