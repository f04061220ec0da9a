//! Fully implicit dynamics.
use moorline::dynamics::implicit::{self, Scheme};
use moorline::model::{Kinematics, Model, State};
use moorline::scene::Scene;
use moorline::statics::assembly::Workspace;
use moorline::statics::equilibrium::solve;
use nalgebra::Vector3;

fn model(text: &str) -> Model {
    Model::new(&Scene::from_toml(text).unwrap()).unwrap()
}

fn at_reference(model: &Model) -> Vec<Vector3<f64>> {
    model.points.iter().map(|point| point.reference).collect()
}

/// The fairlead of these scenes: point "fairlead" swings, all others stay.
fn swing(model: &Model, amplitude: [f64; 2], period: f64) -> impl Fn(usize, f64) -> Kinematics {
    let reference = at_reference(model);
    let fairlead = model.point_index("fairlead");
    move |point, t| {
        let mut k = Kinematics {
            position: reference[point],
            ..Kinematics::default()
        };
        if Some(point) == fairlead {
            let w = std::f64::consts::TAU / period;
            let a = Vector3::new(amplitude[0], 0.0, amplitude[1]);
            // 1 − cos − ... starts with zero velocity and acceleration
            let (s, c) = (w * t).sin_cos();
            let (r, dr, ddr) = ((1.0 - c) / 2.0, w * s / 2.0, w * w * c / 2.0);
            let (r2, dr2, ddr2) = (r * r, 2.0 * r * dr, 2.0 * (dr * dr + r * ddr));
            k.position += a * r2;
            k.velocity = a * dr2;
            k.acceleration = a * ddr2;
        }
        k
    }
}

fn chain(n: usize, ea: f64, extra: &str) -> Model {
    model(&format!(
        r#"
{extra}
[water]
density = 1025.0
[line_types.chain]
mass = 77.7
diameter = 0.09
axial_stiffness = {ea:e}
axial_damping = {:e}
drag_normal = 1.6
drag_tangential = 0.1
added_mass_normal = 1.0
[[points]]
name = "anchor"
position = [853.87, 0.0, -320.0]
kind = "fixed"
[[points]]
name = "fairlead"
position = [5.2, 0.0, -70.0]
kind = "coupled"
[[lines]]
name = "line"
from = "anchor"
to = "fairlead"
sections = [{{ type = "chain", length = 902.2, elements = {n} }}]
"#,
        ea * 0.01
    ))
}

#[test]
fn scratch_order() {
    for bed in ["", "[seabed]\ndepth = 320.0\nstiffness=3e6\ndamping=3e5\n"] {
        let m = chain(20, 384.243e6, bed);
        let mut work = Workspace::new(&m);
        let start = solve(&m, &at_reference(&m), 0.0, &mut work).unwrap();
        let held = swing(&m, [8.0, 4.0], 10.0);
        let run = |scheme: Scheme, dt: f64| -> (State, moorline::statics::assembly::Counters) {
            let mut work = Workspace::new(&m);
            let mut s = start.clone();
            implicit::start(&m, 0, &mut s, &held, 0.0, &mut work);
            let c = implicit::advance(&m, 0, &mut s, &held, [0.0, 12.0], dt, &scheme, &mut work)
                .unwrap();
            (s, c)
        };
        for scheme in [
            Scheme::generalised_alpha(0.5),
            Scheme::bossak(-0.1, None),
            Scheme::generalised_alpha(1.0),
            Scheme::generalised_alpha(0.0),
        ] {
            let (fine, _) = run(scheme, 0.1 / 256.0);
            for k in 0..7 {
                let dt = 0.4 / 2f64.powi(k);
                let t0 = std::time::Instant::now();
                let (s, c) = run(scheme, dt);
                let e = s.lines[0]
                    .position
                    .iter()
                    .zip(&fine.lines[0].position)
                    .map(|(a, b)| (a - b).norm())
                    .fold(0.0, f64::max);
                println!(
                    "{dt} err {e:.3e} {c:?} ns/node/solve {}",
                    t0.elapsed().as_nanos() as f64 / c.solves as f64 / 20.0
                );
            }
        }
    }
}

#[test]
fn scratch_snap() {
    for (ea, rho) in [(1e4, 0.5), (1e6, 0.5), (1e6, 0.8), (1e6, 0.9), (1e8, 0.5)] {
        for contact in ["regularised", "as_given"] {
            let m = model(&format!(
                r#"
[water]
density = 1000.0
[seabed]
depth = 3.0
stiffness = 3e8
damping = 1e6
contact = "{contact}"
[line_types.chain]
mass = 0.0818
diameter = 0.0037
axial_stiffness = {ea:e}
drag_normal = 2.5
drag_tangential = 0.5
added_mass_normal = 3.8
[[points]]
name = "anchor"
position = [0.0, 0.0, -3.0]
kind = "fixed"
[[points]]
name = "fairlead"
position = [32.554, 0.0, -0.02]
kind = "coupled"
[[lines]]
name = "line"
from = "anchor"
to = "fairlead"
sections = [{{ type = "chain", length = 33.0, elements = 40 }}]
"#
            ));
            let mut work = Workspace::new(&m);
            let mut s = solve(&m, &at_reference(&m), 0.0, &mut work).unwrap();
            let held = swing(&m, [-0.4, 0.4], 1.25);
            implicit::start(&m, 0, &mut s, &held, 0.0, &mut work);
            let scheme = Scheme::generalised_alpha(rho);
            let mut vmax = 0.0f64;
            let mut zmax = f64::NEG_INFINITY;
            let mut total = moorline::statics::assembly::Counters::default();
            for i in 0..400 {
                match implicit::advance(
                    &m,
                    0,
                    &mut s,
                    &held,
                    [i as f64 * 0.05, (i + 1) as f64 * 0.05],
                    0.01,
                    &scheme,
                    &mut work,
                ) {
                    Ok(c) => total += c,
                    Err(e) => {
                        println!("{e}");
                        break;
                    }
                }
                vmax = s.lines[0]
                    .velocity
                    .iter()
                    .map(|v| v.norm())
                    .fold(vmax, f64::max);
                zmax = s.lines[0].position.iter().map(|v| v.z).fold(zmax, f64::max);
            }
            println!("ea {ea:e} rho {rho} {contact} {total:?} vmax {vmax} zmax {zmax}");
        }
    }
}
