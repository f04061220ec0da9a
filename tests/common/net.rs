//! A net suspended from its rim: networks of any size for tests and benches.

use moorline::scene::Scene;

use super::draft::draft;

/// Mesh width of the net [m].
const WIDTH: f64 = 10.0;

/// A square net of `count` by `count` free points, 10 m apart and 50 m below the surface. Neighbours are joined by ropes that are 2 % longer,
/// with `elements` elements each; the outermost points are attached to fixed anchors, those of the first column to coupled points that sway.
pub fn net(count: usize, elements: usize) -> Scene {
    let mut net = draft(
        "water.density = 1025.0
        line_types.rope = { mass = 5.0, diameter = 0.05, axial_stiffness = 2e6, axial_damping = 2e4, drag_normal = 1.2,
          drag_tangential = 0.05, added_mass_normal = 1.0 }
        solver = { integrator = 'generalised_alpha', time_step_max = 0.02 }",
    );
    let name = |i: usize, k: usize| format!("p{i}_{k}");
    let rim = |i: usize| i == 0 || i > count;
    for i in 0..count + 2 {
        for k in (0..count + 2).filter(|&k| !(rim(i) && rim(k))) {
            let (name, [x, y]) = (name(i, k), [i, k].map(|place| WIDTH * place as f64));
            let kind = match (i, rim(i) || rim(k)) {
                (0, _) => "coupled",
                (_, true) => "fixed",
                _ => "free",
            };
            net = net.point(kind, &name, [x, y, -50.0]);
            net = net.with(if kind == "free" { "mass = 2.0" } else { "" });
            if kind == "coupled" {
                net = net.and(&format!(
                    "motion.{name} = {{ x = [[0.3, 6.0]], z = [[0.5, 8.0]], ramp = 4.0 }}"
                ));
            }
        }
    }
    for i in 1..=count {
        for k in 0..=count {
            for [from, to] in [[name(i, k), name(i, k + 1)], [name(k, i), name(k + 1, i)]] {
                net = net.line(
                    &format!("{from}__{to}"),
                    [&from, &to],
                    "rope",
                    1.02 * WIDTH,
                    elements,
                );
            }
        }
    }
    net.scene()
}
