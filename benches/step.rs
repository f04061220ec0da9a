//! Cost of a step, by scene, integrator and mesh: ns per node and step, CPU seconds per simulated second.

mod common;

use moorline::scene::Integrator;

fn main() {
    println!(
        "{:<16} {:<15} {:>5} {:>10} {:>14} {:>12} {:>10}",
        "scene", "integrator", "n", "steps/s", "ns/node/step", "s/s", "real-time"
    );
    for name in [
        "oc3_catenary",
        "oc4_chain",
        "taut_polyester",
        "lindahl_fast",
    ] {
        for integrator in [Integrator::Leapfrog, Integrator::AxialImplicit] {
            for elements in [20, 40, 80, 160] {
                let mut scene = common::scene(name);
                scene.solver.integrator = integrator;
                scene.lines[0].sections[0].elements = Some(elements);
                let cost = common::measure(&scene);
                println!(
                    "{name:<16} {:<15} {elements:>5} {:>10.0} {:>14.1} {:>12.2e} {:>10.0}",
                    format!("{integrator:?}"),
                    cost.steps,
                    cost.node_step,
                    cost.second,
                    1.0 / cost.second
                );
            }
        }
    }
}
