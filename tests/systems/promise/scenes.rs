//! Scenes on which the claim is tested: public ones and variants of them, networks, cables with bending stiffness, systems in waves, and other typical lines.

use crate::common::*;
use moorline::scene::{MotionPath, Scene};

/// Name and scene.
pub(super) type Case = (String, Scene);

pub(super) fn public() -> Vec<Case> {
    let names = PUBLIC_SCENES.iter();
    names
        .map(|(name, _)| (name.to_string(), open(shipped(name))))
        .collect()
}

/// A public scene with scaled amplitudes and periods of its motion.
pub(super) fn moved(name: &str, [amplitude, period]: [f64; 2]) -> Scene {
    let mut scene = open(shipped(name));
    for path in scene.motion.values_mut() {
        let MotionPath::Harmonic(motion) = path else {
            panic!("{name} moves by sines");
        };
        let axes = [&mut motion.x, &mut motion.y, &mut motion.z];
        for sine in axes.into_iter().flatten() {
            sine[0] *= amplitude;
            sine[1] *= period;
        }
    }
    scene
}

/// A public scene with another depth [m] and line length [m].
fn laid(name: &str, [depth, length]: [f64; 2]) -> Scene {
    let mut scene = open(shipped(name));
    scene.points[0].position[2] = -depth;
    scene.lines[0].sections[0].length = length;
    scene.seabed.as_mut().unwrap().depth = depth;
    scene
}

pub(super) fn variants() -> Vec<Case> {
    let mut slow = moved("oc3_catenary", [1.0, 5.0]);
    slow.output.duration = 240.0;
    named([
        ("mild", moved("oc3_catenary", [0.3, 1.0])),
        ("violent", moved("oc3_catenary", [1.8, 1.0])),
        ("slow", slow),
        ("deep", laid("oc3_catenary", [620.0, 1075.0])),
        ("shallow", laid("oc4_chain", [100.0, 815.0])),
        ("snapping", moved("oc4_chain", [1.5, 0.8])),
        ("short", laid("oc4_chain", [200.0, 824.0])),
        ("taut and fast", moved("taut_polyester", [0.5, 0.5])),
        ("taut and far", moved("taut_polyester", [2.0, 1.2])),
        ("tank", moved("lindahl_slow", [0.75, 2.0 / 3.5])),
    ])
}

/// Two floats 300 m apart, each with a line to an anchor, and a shared line between them with a buoy in its middle.
pub(super) fn farm() -> Scene {
    let mut farm = draft(
        "water.density = 1025.0
        seabed.depth = 120.0
        line_types.rope = { mass = 23.0, diameter = 0.16, axial_stiffness = 4.0e7, axial_damping = 1.0e5, drag_normal = 1.3,
          added_mass_normal = 1.0 }
        line_types.chain = { mass = 90.0, diameter = 0.12, axial_stiffness = 3.5e8, axial_damping = 1.0e6, drag_normal = 1.3,
          added_mass_normal = 1.0 }
        motion.float1 = { x = [[1.0, 11.0]], z = [[1.0, 9.0]], ramp = 11.0 }
        motion.float2 = { x = [[0.6, 11.0, 1.0]], z = [[0.8, 9.0, 2.0]], ramp = 11.0 }
        output = { duration = 66.0, interval = 0.05 }",
    );
    for (anchor, float, side) in [("anchor1", "float1", -1.0), ("anchor2", "float2", 1.0)] {
        farm = farm
            .fixed(anchor, [500.0 * side, 0.0, -120.0])
            .coupled(float, [150.0 * side, 0.0, -10.0]);
    }
    farm.free("buoy", [0.0, 0.0, -40.0])
        .with("mass = 1000.0, volume = 2.0, drag_area = 3.0, added_mass = 0.5")
        .line("leg1", ["anchor1", "float1"], "chain", 385.0, None)
        .line("leg2", ["anchor2", "float2"], "chain", 385.0, None)
        .line("shared1", ["float1", "buoy"], "rope", 156.0, None)
        .line("shared2", ["buoy", "float2"], "rope", 156.0, None)
        .scene()
}

/// One line of every cluster of the semi-submersible in storm waves.
pub(super) fn clusters() -> Scene {
    let mut scene = shipped("storm_moored_semi");
    scene
        .lines
        .retain(|line| ["line1", "line5", "line9"].contains(&&line.name[..]));
    let ends = scene
        .lines
        .iter()
        .flat_map(|line| [line.from.clone(), line.to.clone()]);
    let ends: Vec<String> = ends.collect();
    scene.points.retain(|point| ends.contains(&point.name));
    scene.output.duration = 160.0;
    scene
}

/// A cable with bending stiffness that hangs from a float to the seabed.
pub(super) fn umbilical() -> Scene {
    draft(
        "water.density = 1025.0
        seabed = { depth = 120.0, stiffness = 1.0e6, damping = 1.0e5 }
        line_types.umbilical = { mass = 60.0, diameter = 0.2, axial_stiffness = 5.0e8, bending_stiffness = 2.0e4, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        motion.float = { x = [[2.0, 11.0]], z = [[1.5, 9.0]], ramp = 15.0 }
        output = { duration = 103.0, interval = 0.05 }",
    )
    .fixed("seabed_end", [190.0, 0.0, -120.0])
    .coupled("float", [0.0, 0.0, -12.0])
    .line("umbilical", ["seabed_end", "float"], "umbilical", 250.0, None)
    .scene()
}

/// The umbilical, clamped to the float.
pub(super) fn clamped_umbilical() -> Scene {
    let mut scene = umbilical();
    scene.lines[0].clamped_b = Some([-0.1, 0.0, 1.0]);
    scene
}

/// A lazy wave in a tank at a scale of 1:40, whose motion is fast relative to the maximum time step.
pub(super) fn tank_cable() -> Scene {
    draft(
        "water.density = 1000.0
        seabed = { depth = 2.5, stiffness = 6.0e4, damping = 600.0 }
        line_types.cable = { mass = 0.025, diameter = 0.00375, axial_stiffness = 6250.0, bending_stiffness = 1.0e-4, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        line_types.buoyant = { mass = 0.0388, diameter = 0.008, axial_stiffness = 6250.0, bending_stiffness = 1.0e-4, drag_normal = 1.2,
          drag_tangential = 0.2, added_mass_normal = 1.0 }
        motion.float = { x = [[0.05, 1.9]], z = [[0.0375, 1.42]], ramp = 3.0 }
        output = { duration = 18.0, interval = 0.05 }",
    )
    .fixed("seabed_end", [4.5, 0.0, -2.5])
    .coupled("float", [0.0, 0.0, -0.375])
    .sections(
        "cable",
        ["seabed_end", "float"],
        &[("cable", 2.5, None), ("buoyant", 1.25, None), ("cable", 2.25, None)],
    )
    .scene()
}

/// A cable between two floats, with a buoyant section in its middle.
pub(super) fn cable_between_floats() -> Scene {
    draft(
        "water.density = 1025.0
        line_types.cable = { mass = 40.0, diameter = 0.15, axial_stiffness = 4.0e8, bending_stiffness = 1.0e4, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        line_types.buoyant = { mass = 62.0, diameter = 0.32, axial_stiffness = 4.0e8, bending_stiffness = 1.0e4, drag_normal = 1.2,
          drag_tangential = 0.2, added_mass_normal = 1.0 }
        motion.float1 = { x = [[1.5, 11.0]], z = [[1.0, 9.0]], ramp = 15.0 }
        motion.float2 = { x = [[1.2, 11.0, 1.0]], z = [[1.0, 9.0, 2.0]], ramp = 15.0 }
        output = { duration = 103.0, interval = 0.05 }",
    )
    .coupled("float1", [-150.0, 0.0, -15.0])
    .coupled("float2", [150.0, 0.0, -15.0])
    .sections(
        "cable",
        ["float1", "float2"],
        &[("cable", 140.0, None), ("buoyant", 60.0, None), ("cable", 140.0, None)],
    )
    .scene()
}

/// A taut polyester rope between two short chains.
pub(super) fn deep_polyester() -> Scene {
    draft(
        "water.density = 1025.0
        seabed = { depth = 2000.0, stiffness = 3.0e6, damping = 3.0e5 }
        line_types.chain = { mass = 113.35, diameter = 0.0766, axial_stiffness = 7.5e8, axial_damping = 2.0e6, drag_normal = 2.0,
          drag_tangential = 0.4, added_mass_normal = 0.8, added_mass_tangential = 0.25 }
        line_types.polyester = { mass = 38.0, diameter = 0.22, axial_stiffness = 2.0e8, damping_ratio = 0.05, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        motion.fairlead = { x = [[4.0, 14.0]], z = [[2.0, 10.0]], ramp = 20.0 }
        output = { duration = 132.0, interval = 0.05 }",
    )
    .fixed("anchor", [1800.0, 0.0, -2000.0])
    .coupled("fairlead", [0.0, 0.0, -15.0])
    .sections(
        "leg",
        ["anchor", "fairlead"],
        &[("chain", 150.0, None), ("polyester", 2400.0, None), ("chain", 100.0, None)],
    )
    .scene()
}

/// A float with one leg: chain from the anchor to a submerged buoy, then rope.
fn buoyed_leg() -> Scene {
    draft(
        "water.density = 1025.0
        seabed = { depth = 150.0, stiffness = 3.0e6, damping = 3.0e5 }
        line_types.chain = { mass = 60.0, diameter = 0.1, axial_stiffness = 2.6e8, axial_damping = 5.0e5, drag_normal = 1.3,
          drag_tangential = 0.3, added_mass_normal = 1.0, added_mass_tangential = 0.5 }
        line_types.rope = { mass = 8.5, diameter = 0.1, axial_stiffness = 2.0e7, damping_ratio = 0.05, drag_normal = 1.2,
          drag_tangential = 0.05, added_mass_normal = 1.0 }
        motion.float = { x = [[2.0, 10.0]], y = [[0.8, 13.0, 0.5]], z = [[1.5, 8.0]], ramp = 15.0 }
        output = { duration = 80.0, interval = 0.05 }",
    )
    .fixed("anchor", [260.0, 0.0, -150.0])
    .free("buoy", [120.0, 0.0, -60.0])
    .with("mass = 3000.0, volume = 12.0, drag_area = 4.0, added_mass = 0.5")
    .coupled("float", [0.0, 0.0, -10.0])
    .line("chain", ["anchor", "buoy"], "chain", 180.0, None)
    .line("rope", ["buoy", "float"], "rope", 128.0, None)
    .scene()
}

/// Two chain legs from the seabed to a ring, and a wire from the ring to the fairlead, with these lengths [m]; with less than 2 m of slack, all slacken in
/// every period.
pub(super) fn crowfoot([leg, wire]: [f64; 2]) -> Scene {
    draft(
        "water.density = 1025.0
        seabed = { depth = 100.0, stiffness = 3.0e6, damping = 3.0e5 }
        line_types.chain = { mass = 126.0, diameter = 0.144, axial_stiffness = 5.5e8, axial_damping = 1.0e6, drag_normal = 1.3,
          drag_tangential = 0.3, added_mass_normal = 1.0, added_mass_tangential = 0.5 }
        line_types.wire = { mass = 22.0, diameter = 0.07, axial_stiffness = 3.2e8, axial_damping = 5.0e5, drag_normal = 1.2,
          drag_tangential = 0.02, added_mass_normal = 1.0 }
        motion.fairlead = { x = [[1.5, 12.0]], y = [[1.0, 15.0, 0.7]], z = [[1.2, 9.0]], ramp = 15.0 }
        output = { duration = 80.0, interval = 0.05 }",
    )
    .fixed("anchor1", [400.0, 120.0, -100.0])
    .fixed("anchor2", [400.0, -120.0, -100.0])
    .free("ring", [180.0, 0.0, -85.0])
    .with("mass = 1500.0, volume = 0.2, drag_area = 1.0, added_mass = 0.5")
    .coupled("fairlead", [0.0, 0.0, -10.0])
    .line("leg1", ["anchor1", "ring"], "chain", leg, None)
    .line("leg2", ["anchor2", "ring"], "chain", leg, None)
    .line("wire", ["ring", "fairlead"], "wire", wire, None)
    .scene()
}

/// A tendon of steel tube that holds a platform down, with drift and wave motion.
fn tendon() -> Scene {
    draft(
        "water.density = 1025.0
        line_types.tube = { mass = 520.0, diameter = 0.8, axial_stiffness = 1.2e10, damping_ratio = 0.02, drag_normal = 1.0,
          added_mass_normal = 1.0 }
        motion.porch = { x = [[6.0, 80.0], [1.5, 10.0]], z = [[0.03, 10.0, 1.0], [0.01, 5.0]], ramp = 20.0 }
        output = { duration = 180.0, interval = 0.05 }",
    )
    .fixed("pile", [0.0, 0.0, -400.0])
    .coupled("porch", [5.0, 0.0, -25.0])
    .line("tendon", ["pile", "porch"], "tube", 374.73, None)
    .scene()
}

/// A wave-energy buoy on three nylon hawsers with chain on the seabed, without waves or with those given.
fn hawsers(waves: &str) -> Scene {
    let mut buoy = draft(
        "water.density = 1025.0
        seabed = { depth = 45.0, stiffness = 3.0e6, damping = 3.0e5 }
        line_types.chain = { mass = 60.0, diameter = 0.1, axial_stiffness = 2.6e8, axial_damping = 5.0e5, drag_normal = 1.3,
          drag_tangential = 0.3, added_mass_normal = 1.0, added_mass_tangential = 0.5 }
        line_types.nylon = { mass = 6.0, diameter = 0.09, axial_stiffness = 1.2e6, damping_ratio = 0.05, drag_normal = 1.2,
          drag_tangential = 0.05, added_mass_normal = 1.0 }
        vessels = [{ name = 'buoy' }]
        motion.buoy = { x = [[1.2, 8.0], [1.5, 60.0]], y = [[0.4, 7.0, 0.4]], z = [[1.0, 7.0, 1.3]], pitch = [[0.08, 8.0, 1.1]], ramp = 20.0 }
        output = { duration = 110.0, interval = 0.05 }",
    )
    .and(waves);
    for (leg, angle) in [("leg1", 0.0), ("leg2", 2.1), ("leg3", -2.1_f64)] {
        let at = |radius: f64, z: f64| [radius * angle.cos(), radius * angle.sin(), z];
        let [anchor, fairlead] = ["anchor", "fairlead"].map(|end| format!("{end}_of_{leg}"));
        buoy = buoy
            .fixed(&anchor, at(120.0, -45.0))
            .coupled(&fairlead, at(4.0, -3.0))
            .with("on = 'buoy'")
            .sections(
                leg,
                [&anchor, &fairlead],
                &[("chain", 70.0, None), ("nylon", 52.0, None)],
            );
    }
    buoy.scene()
}

/// A shipped scene with waves, its elements left open.
fn in_waves(name: &str, waves: &str) -> Scene {
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut scene = open(Scene::from_toml(&format!("{text}\n[water.waves]\n{waves}")).unwrap());
    scene.output.duration = 110.0;
    scene
}

/// Pairs scenes with their names.
fn named<const N: usize>(scenes: [(&str, Scene); N]) -> Vec<Case> {
    scenes.map(|(name, scene)| (name.to_string(), scene)).into()
}

/// The public scenes, and variants with periods × 0.7 and × 1.4 and amplitudes × 1.5.
pub(super) fn public_and_moved() -> Vec<Case> {
    let changes = [
        ("", [1.0, 1.0]),
        (", periods × 0.7", [1.0, 0.7]),
        (", periods × 1.4", [1.0, 1.4]),
        (", amplitudes × 1.5", [1.5, 1.0]),
    ];
    let of_scene = |name: &'static str| {
        changes.map(|(change, factors)| (format!("{name}{change}"), moved(name, factors)))
    };
    PUBLIC_SCENES
        .iter()
        .flat_map(|(name, _)| of_scene(name))
        .collect()
}

/// Networks of lines joined at free points.
pub(super) fn networks() -> Vec<Case> {
    named([
        ("farm", farm()),
        ("bridle", open(shipped("bridle"))),
        ("clump_weight", open(shipped("clump_weight"))),
        ("buoyed leg", buoyed_leg()),
        ("crowfoot", crowfoot([262.0, 200.0])),
    ])
}

/// Cables with bending stiffness.
pub(super) fn cables() -> Vec<Case> {
    named([
        ("umbilical", umbilical()),
        ("tank cable", tank_cable()),
        ("cable between floats", cable_between_floats()),
        ("clamped umbilical", clamped_umbilical()),
        ("power_cable", open(shipped("power_cable"))),
    ])
}

/// Systems in waves.
pub(super) fn systems_in_waves() -> Vec<Case> {
    let jonswap = |height: f64, period: f64| {
        format!("spectrum = 'jonswap'\nsignificant_height = {height}\npeak_period = {period}\nramp = 20.0")
    };
    let regular = "regular = { height = 5.0, period = 9.0 }\nramp = 15.0";
    named([
        ("semi-submersible in waves", clusters()),
        ("lazy_wave in waves", in_waves("lazy_wave", regular)),
        ("oc4_chain in waves", in_waves("oc4_chain", &jonswap(6.0, 10.0))),
        ("bridle in waves", in_waves("bridle", &jonswap(4.0, 9.0))),
        (
            "hawsers in waves",
            hawsers(&format!("[water.waves]\n{}", jonswap(3.0, 8.0))),
        ),
    ])
}

/// Other typical lines: taut and deep ropes, hawsers, risers.
pub(super) fn others() -> Vec<Case> {
    named([
        ("deep polyester", deep_polyester()),
        ("tendon", tendon()),
        ("hawsers", hawsers("")),
        ("lazy_wave", open(shipped("lazy_wave"))),
        ("hanging_riser", open(shipped("hanging_riser"))),
    ])
}
