//! A net hung from its rim, written as a scene: networks of any size for tests and benches.

use std::fmt::Write;

/// Mesh width of the net [m].
const WIDTH: f64 = 10.0;

/// A square net of `count` by `count` free points, 10 m apart and 50 m under water. Neighbours are joined by ropes 2 % longer than that,
/// of `elements` elements each; the outermost points hang on fixed anchors, those of the first column on coupled points that sway.
pub fn net(count: usize, elements: usize) -> String {
    let mut text = String::from(
        "water = { density = 1025.0 }\n\
         line_types.rope = { mass = 5.0, diameter = 0.05, axial_stiffness = 2e6, axial_damping = 2e4, drag_normal = 1.2, drag_tangential = 0.05, added_mass_normal = 1.0 }\n\
         solver = { integrator = \"generalised_alpha\", time_step_max = 0.02 }\n",
    );
    let name = |i: usize, k: usize| format!("p{i}_{k}");
    let rim = |i: usize| i == 0 || i > count;
    let (mut lines, mut moved) = (String::new(), Vec::new());
    for i in 0..count + 2 {
        for k in (0..count + 2).filter(|&k| !(rim(i) && rim(k))) {
            let kind = match (i, rim(i) || rim(k)) {
                (0, _) => "coupled",
                (_, true) => "fixed",
                _ => "free",
            };
            let [x, y] = [i, k].map(|place| WIDTH * place as f64);
            let name = name(i, k);
            let mass = if kind == "free" { ", mass = 2.0" } else { "" };
            writeln!(
                text,
                "[[points]]\nname = \"{name}\"\nposition = [{x:?}, {y:?}, -50.0]\nkind = \"{kind}\"{}",
                mass.replace(", ", "\n")
            )
            .expect("a string takes any text");
            if kind == "coupled" {
                moved.push(name);
            }
        }
    }
    let mut rope = |from: String, to: String| {
        writeln!(
            lines,
            "[[lines]]\nname = \"{from}__{to}\"\nfrom = \"{from}\"\nto = \"{to}\"\n\
             sections = [{{ type = \"rope\", length = {:?}, elements = {elements} }}]",
            1.02 * WIDTH
        )
        .expect("a string takes any text");
    };
    for i in 1..=count {
        for k in 0..=count {
            rope(name(i, k), name(i, k + 1));
            rope(name(k, i), name(k + 1, i));
        }
    }
    text.push_str(&lines);
    text.push_str("[motion]\n");
    for name in moved {
        writeln!(
            text,
            "{name} = {{ x = [[0.3, 6.0]], z = [[0.5, 8.0]], ramp = 4.0 }}"
        )
        .expect("a string takes any text");
    }
    text
}
