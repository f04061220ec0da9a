use moorline::{scene::*, simulation::*};
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).unwrap();
    let mut scene = Scene::from_toml(&text).unwrap();
    let n: usize = args[2].parse().unwrap();
    scene.lines[0].sections[0].elements = Some(n);
    scene.solver.integrator = match args[3].as_str() {
        "lf" => Integrator::Leapfrog,
        "ai" => Integrator::AxialImplicit, "ga" => Integrator::GeneralisedAlpha, "qs" => Integrator::QuasiStatic,
        _ => Integrator::Auto,
    };
    scene.solver.negative_tension = args.iter().any(|a| a == "peers");
    if let Some(a) = args.iter().find_map(|a| a.strip_prefix("dt=")) {
        scene.solver.time_step_max = a.parse().unwrap();
    }
    let mut sim = Simulation::new(&scene).unwrap();
    sim.follow_scene().unwrap();
    for c in sim.choices() {
        eprintln!("{c:?}");
    }
    eprintln!("static T {}", sim.tension_b(0));
    let (mut steps, mut passes) = (0, 0);
    let t0 = Instant::now();
    let mut rows = vec![];
    while sim.time() < scene.output.duration - 1e-9 {
        sim.advance(scene.output.interval).unwrap();
        steps += sim.counters().substeps;
        passes += sim.counters().solves;
        let mid = &sim.state().lines[0].position[n / 2];
        rows.push((sim.time(), sim.tension_b(0), mid.x, mid.z));
    }
    let s = t0.elapsed().as_secs_f64();
    eprintln!(
        "n {n} steps {steps} passes {passes} time {s:.4} s  {:.1} ns/node/step  {:.2e} s/s",
        1e9 * s / (steps * n) as f64,
        s / scene.output.duration
    );
    eprintln!("{:?} error {:.4e} W {:.3e}", sim.ledger(), sim.energy_error(), sim.power_residual());
    for r in rows {
        println!("{} {} {} {}", r.0, r.1, r.2, r.3);
    }
}
