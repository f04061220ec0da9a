//! Line types: keys that do not go together, and keys that are missing.

use super::{Findings, below, check_name, quantity, rules};
use crate::scene::path::quoted;
use crate::scene::table::{Acts, Table};
use crate::scene::{FibreLaw, LineModel, LineType, Rayleigh, Scene, Strain};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    for (name, line_type) in &scene.line_types {
        let at = format!("line_types.{}", quoted(name));
        check_name(findings, &at, name);
        check_mass(findings, &at, line_type, scene);
        check_diameter(findings, &at, name, line_type, scene);
        check_axial(findings, &at, line_type, scene);
        if let Some(rayleigh) = &line_type.rayleigh {
            check_rayleigh(findings, &format!("{at}.rayleigh"), rayleigh);
        }
        let fibres = line_type.fibres;
        rules! { findings, &at;
            "fibres" if fibres.is_some_and(|fibres| fibres > 0) && !line_type.bends() =>
                "fibres share a bending stiffness: give `bending_stiffness` [N m²] or `solid_section` too";
            "fibre_law" if fibres.is_none() && line_type.fibre_law != FibreLaw::Linear =>
                "the law divides the bending stiffness by the number of `fibres`: give that too, or leave the law out";
        }
        check_model(findings, &at, line_type, scene);
    }
}

fn check_mass(findings: &mut Findings, at: &str, line_type: &LineType, scene: &Scene) {
    let weight = line_type.weight.filter(|_| line_type.mass.is_none());
    let weightless = scene.gravity == 0.0;
    rules! { findings, at;
        "" if line_type.mass.is_none() && weight.is_none() =>
            "no mass: give `mass` [kg/m], or `weight` [N/m] (the mass is then weight/gravity)";
        "weight" if weight.is_some() && weightless =>
            "the mass would be weight/gravity, but gravity is 0: give `mass` [kg/m] too";
        "weight" given weight = weight.filter(|weight| !weightless && *weight <= 0.0) =>
            "the mass would be weight/gravity, and {} is not positive: give `mass` [kg/m] too", quantity(weight, "N/m");
    }
}

/// Water and seabed act on a line through its diameter.
fn check_diameter(findings: &mut Findings, at: &str, name: &str, line_type: &LineType, scene: &Scene) {
    if line_type.diameter.is_some() {
        return;
    }
    let wet = scene.water.is_some();
    let used = scene.sections().any(|section| section.line_type == name);
    rules! { findings, at;
        "" if wet && line_type.weight.is_none() && line_type.mass.is_some() =>
            "no diameter: the buoyancy in the water needs `diameter` [m], or give the `weight` in water [N/m]";
    }
    for (key, value) in line_type.entries() {
        let name = key.name();
        rules! { findings, at;
            "{name}" if wet && key.rule.acts.in_water() && !value.is_absent() =>
                "the water acts on the diameter: give `diameter` [m] too";
        }
    }
    rules! { findings, at;
        "" if scene.seabed.is_some() && used =>
            "no diameter: the seabed's stiffness and damping are per metre of diameter; give `diameter` [m], or leave out \
             `[seabed]` where no line touches it";
    }
}

/// Keys of a viscoelastic rope.
const VISCOELASTIC: [&str; 4] = [
    "static_stiffness",
    "dynamic_stiffness",
    "static_damping",
    "dynamic_damping",
];

/// Refusal of a key that a viscoelastic rope does not have.
const ROPE: &str = "a viscoelastic rope stretches by `static_stiffness`, `dynamic_stiffness` and the damping of each: leave this out";

/// The axial force follows from a stiffness, a table, or two stiffnesses with dampers.
fn check_axial(findings: &mut Findings, at: &str, line_type: &LineType, scene: &Scene) {
    let is_given = |key: &&str| line_type.get(key).is_some_and(|value| !value.is_absent());
    let viscoelastic = VISCOELASTIC.iter().any(is_given);
    let table = line_type.tension_strain.is_some();
    let beam = scene.makes_beams(line_type);
    let measured = line_type.strain != Strain::Engineering;
    if !viscoelastic {
        rules! { findings, at;
            "" if !table && line_type.axial_stiffness.is_none() =>
                "missing key `axial_stiffness` [N], or `tension_strain`, a table of strain [-] and tension [N]";
            "strain" if table && measured =>
                "a table has its own strain, the stretched length over the unstretched one less 1: leave `strain` out";
            "tension_strain" if table && beam => "a beam has one `axial_stiffness` [N], and no table";
        }
        return;
    }
    let others = ["axial_stiffness", "tension_strain", "axial_damping", "rayleigh"];
    for key in others.iter().filter(|key| is_given(key)) {
        findings.say(below(at, key), ROPE);
    }
    rules! { findings, at;
        "strain" if measured => "{ROPE}";
        "model" if beam => "{ROPE}";
    }
    for (key, value) in line_type.entries() {
        let (name, unit) = (key.name(), key.unit().unwrap_or_default());
        rules! { findings, at;
            "" if VISCOELASTIC[..3].contains(&name) && value.is_absent() =>
                "missing key `{name}` [{unit}] of a viscoelastic rope";
        }
    }
    if let (Some(slow), Some(fast)) = (line_type.static_stiffness, line_type.dynamic_stiffness) {
        rules! { findings, at;
            "dynamic_stiffness" if fast <= slow =>
                "{} is not above the static stiffness of {}: a rope is stiffer in fast motion",
                quantity(fast, "N"), quantity(slow, "N");
        }
    }
}

/// A beam needs every stiffness and its rotary inertia, by its own key or from its solid section; a cable has neither shear nor torsion.
fn check_model(findings: &mut Findings, at: &str, line_type: &LineType, scene: &Scene) {
    let beam = scene.makes_beams(line_type);
    let why = match line_type.model {
        LineModel::Beam => "",
        LineModel::Cable => ", and integrator = \"beam\" makes every line a beam",
    };
    for (key, value) in line_type.entries() {
        let (bending, name) = (key.name() == "bending_stiffness", key.name());
        if !bending && !["shear_stiffness", "torsional_stiffness", "rotary_inertia"].contains(&name) {
            continue;
        }
        let unit = key.unit().unwrap_or_default();
        let given = value.number().is_some_and(|number| !bending || number > 0.0);
        rules! { findings, at;
            "{name}" if !beam && !bending && given =>
                "only a beam has it: write model = \"beam\" or leave it out";
            "" if beam && !given && line_type.solid_section.is_none() =>
                "a beam needs `{name}` [{unit}], or a `solid_section` that it follows from{why}";
        }
    }
    rules! { findings, at;
        "strain" if beam && line_type.strain != Strain::Engineering =>
            "a beam stretches by the engineering strain: leave it out";
    }
}

fn check_rayleigh(findings: &mut Findings, at: &str, rayleigh: &Rayleigh) {
    let ([ratio_1, ratio_2], [frequency_1, frequency_2]) = (rayleigh.ratios, rayleigh.frequencies);
    if !(ratio_1.min(ratio_2) >= 0.0 && frequency_1.min(frequency_2) > 0.0) {
        return; // out of bounds
    }
    if frequency_1 == frequency_2 {
        let problem = "the two circular frequencies are equal: the ratios hold at two different ones";
        return findings.say(format!("{at}.frequencies"), problem);
    }
    let ((slow, slow_ratio), (fast, fast_ratio)) = if frequency_1 < frequency_2 {
        ((frequency_1, ratio_1), (frequency_2, ratio_2))
    } else {
        ((frequency_2, ratio_2), (frequency_1, ratio_1))
    };
    // α = 2ω₁ω₂(ζ₁ω₂ − ζ₂ω₁)/(ω₂² − ω₁²) and β = 2(ζ₂ω₂ − ζ₁ω₁)/(ω₂² − ω₁²), both at least 0.
    rules! { findings, at;
        "ratios" if slow_ratio * fast < fast_ratio * slow || fast_ratio * fast < slow_ratio * slow =>
            "the ratios ask for negative damping of mass or stiffness: their quotient must lie between {:.4} and {:.4}, \
             that of the frequencies and its inverse", slow / fast, fast / slow;
    }
}

impl Acts {
    /// Returns whether the property acts in water only.
    pub(in crate::scene) fn in_water(self) -> bool {
        matches!(self, Acts::InWater | Acts::InFlow | Acts::InAccelerations)
    }
}
