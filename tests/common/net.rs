//! Many lines: a net hung from its rim, and copies of a scene beside each other, for tests and benches.
#![allow(dead_code)] // each program uses a part

use moorline::scene::Scene;

#[path = "draft.rs"]
mod draft;

/// Mesh width of the net [m].
const WIDTH: f64 = 10.0;

/// A square net of `count` by `count` free points, 10 m apart and 50 m under water. Neighbours are joined by ropes 2 % longer than that,
/// of `elements` elements each; the outermost points hang on fixed anchors, those of the first column on coupled points that sway.
pub fn net(count: usize, elements: usize) -> Scene {
    let mut net = draft::draft(
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

/// `count` copies of a scene that have nothing in common, each farther from the first along an axis by a distance [m].
pub fn copies(one: &Scene, count: usize, axis: usize, distance: f64) -> Scene {
    let mut scene = one.clone();
    (scene.vessels, scene.points, scene.lines) = (Vec::new(), Vec::new(), Vec::new());
    scene.motion.clear();
    for unit in 0..count {
        let named = |name: &str| format!("{name}_{unit}");
        let moved = |mut place: [f64; 3]| {
            place[axis] += distance * unit as f64;
            place
        };
        for mut vessel in one.vessels.clone() {
            (vessel.name, vessel.position) = (named(&vessel.name), moved(vessel.position));
            scene.vessels.push(vessel);
        }
        for mut point in one.points.clone() {
            if point.on.is_none() {
                point.position = moved(point.position);
            }
            (point.name, point.on) = (named(&point.name), point.on.as_deref().map(named));
            scene.points.push(point);
        }
        for mut line in one.lines.clone() {
            (line.name, line.from, line.to) = (named(&line.name), named(&line.from), named(&line.to));
            scene.lines.push(line);
        }
        let motion = one.motion.iter().map(|(name, path)| (named(name), path.clone()));
        scene.motion.extend(motion);
    }
    scene
}
