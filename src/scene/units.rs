//! Units of the scene's numbers, so that a message can say "expected a number [m]".

/// (struct, key, unit) of every number and list of numbers in a scene.
const UNITS: &[(&str, &str, &str)] = &[
    ("Scene", "gravity", "m/s²"),
    ("Water", "density", "kg/m³"),
    ("Current", "velocity", "m/s"),
    ("Sea", "significant_height", "m"),
    ("Sea", "peak_period", "s"),
    ("Sea", "peakedness", "-"),
    ("Sea", "direction", "rad"),
    ("Sea", "spreading", "-"),
    ("Sea", "seed", "-"),
    ("Sea", "ramp", "s"),
    ("RegularWave", "height", "m"),
    ("RegularWave", "amplitude", "m"),
    ("RegularWave", "period", "s"),
    ("RegularWave", "direction", "rad"),
    ("RegularWave", "phase", "rad"),
    ("Seabed", "depth", "m"),
    ("Seabed", "stiffness", "Pa/m"),
    ("Seabed", "damping", "Pa s/m"),
    ("Seabed", "friction", "-"),
    ("Seabed", "slope", "-"),
    ("DepthGrid", "x", "m"),
    ("DepthGrid", "y", "m"),
    ("DepthGrid", "depth", "m"),
    ("Friction", "transverse", "-"),
    ("Friction", "axial", "-"),
    ("LineType", "mass", "kg/m"),
    ("LineType", "weight", "N/m"),
    ("LineType", "diameter", "m"),
    ("LineType", "axial_stiffness", "N"),
    ("LineType", "tension_strain", "- and N"),
    ("LineType", "axial_damping", "N s"),
    ("LineType", "static_stiffness", "N"),
    ("LineType", "dynamic_stiffness", "N"),
    ("LineType", "static_damping", "N s"),
    ("LineType", "dynamic_damping", "N s"),
    ("LineType", "damping_ratio", "-"),
    ("LineType", "drag_normal", "-"),
    ("LineType", "drag_tangential", "-"),
    ("LineType", "added_mass_normal", "-"),
    ("LineType", "added_mass_tangential", "-"),
    ("LineType", "bending_stiffness", "N m²"),
    ("LineType", "fibres", "-"),
    ("LineType", "shear_stiffness", "N"),
    ("LineType", "torsional_stiffness", "N m²"),
    ("LineType", "rotary_inertia", "kg m"),
    ("SolidSection", "diameter", "m"),
    ("SolidSection", "youngs_modulus", "Pa"),
    ("SolidSection", "poisson", "-"),
    ("Rayleigh", "ratios", "-"),
    ("Rayleigh", "frequencies", "rad/s"),
    ("Point", "position", "m"),
    ("Point", "mass", "kg"),
    ("Point", "volume", "m³"),
    ("Point", "drag_area", "m²"),
    ("Point", "added_mass", "-"),
    ("PointForce", "x", "N"),
    ("PointForce", "y", "N"),
    ("PointForce", "z", "N"),
    ("PointMoment", "x", "N m"),
    ("PointMoment", "y", "N m"),
    ("PointMoment", "z", "N m"),
    ("Vessel", "position", "m"),
    ("Vessel", "attitude", "rad"),
    ("Line", "clamped_a", "-"),
    ("Line", "clamped_b", "-"),
    ("Break", "tension", "N"),
    ("Break", "time", "s"),
    ("InitialShape", "parabola", "m"),
    ("InitialShape", "nodes", "m"),
    ("Strain", "logarithmic", "-"),
    ("Section", "length", "m"),
    ("Section", "damping_elements", "-"),
    ("Solver", "tolerance", "-"),
    ("Solver", "time_step_max", "s"),
    ("Solver", "spectral_radius", "-"),
    ("Solver", "threads", "-"),
    ("Bossak", "alpha", "-"),
    ("Bossak", "gamma", "-"),
    ("MotionText", "ramp", "s"),
    ("Output", "duration", "s"),
    ("Output", "interval", "s"),
];

/// Unit of a key of a struct, where it is a number.
pub(super) fn unit(owner: &str, key: &str) -> Option<&'static str> {
    UNITS
        .iter()
        .find(|(o, k, _)| *o == owner && *k == key)
        .map(|(_, _, unit)| *unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of the body of `pub struct name` in the source.
    fn body(source: &'static str, name: &str) -> Option<&'static str> {
        let start = source.find(&format!("pub struct {name} {{"))?;
        source[start..].split("\n}").next()
    }

    #[test]
    fn every_unit_said_in_a_message_stands_in_the_docs_of_its_key() {
        let source = concat!(
            include_str!("mod.rs"),
            include_str!("waves.rs"),
            include_str!("seabed.rs")
        );
        for (owner, key, unit) in UNITS {
            let Some(body) = body(source, owner) else {
                let elsewhere = ["MotionText", "InitialShape", "Strain"];
                assert!(elsewhere.contains(owner), "{owner} is not in mod.rs");
                continue;
            };
            let declaration = format!("pub {key}: ");
            let before = body.find(&declaration);
            let before = before.unwrap_or_else(|| panic!("{owner} has no key {key}"));
            let doc = body[..before].rsplit("pub ").next().unwrap();
            assert!(
                doc.contains(&format!("[{unit}]")),
                "{owner}.{key}: the docs do not say [{unit}]"
            );
        }
    }
}
