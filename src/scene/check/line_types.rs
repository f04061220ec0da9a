//! Line types: keys that do not go together, and keys that are missing.

use super::{Findings, check_name, quantity};
use crate::scene::path::quoted;
use crate::scene::table::{Acts, Table};
use crate::scene::{FibreLaw, Integrator, LineModel, LineType, Rayleigh, Scene, Strain};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    for (name, line_type) in &scene.line_types {
        let at = format!("line_types.{}", quoted(name));
        check_name(findings, &at, name);
        check_mass(findings, &at, line_type, scene);
        check_diameter(findings, &at, name, line_type, scene);
        check_axial(findings, &at, line_type);
        if let Some(rayleigh) = &line_type.rayleigh {
            check_rayleigh(findings, &format!("{at}.rayleigh"), rayleigh);
        }
        check_bending(findings, &at, line_type);
        check_model(findings, &at, line_type, scene);
    }
}

fn check_mass(findings: &mut Findings, at: &str, line_type: &LineType, scene: &Scene) {
    let (mass, weight) = (line_type.mass, line_type.weight);
    let light = format!(
        "the mass would be weight/gravity, and {} is not positive: give `mass` [kg/m] too",
        quantity(weight.unwrap_or_default(), "N/m")
    );
    let of_weight = mass.is_none() && weight.is_some();
    let (weightless, lifted) = (scene.gravity == 0.0, weight.is_some_and(|weight| weight <= 0.0));
    findings.refuse(
        at,
        &[
            (
                "",
                mass.is_none() && weight.is_none(),
                "no mass: give `mass` [kg/m], or `weight` [N/m] (the mass is then weight/gravity)",
            ),
            (
                "weight",
                of_weight && weightless,
                "the mass would be weight/gravity, but gravity is 0: give `mass` [kg/m] too",
            ),
            ("weight", of_weight && !weightless && lifted, &light),
        ],
    );
}

/// Water and seabed act on a line by its diameter.
fn check_diameter(findings: &mut Findings, at: &str, name: &str, line_type: &LineType, scene: &Scene) {
    if line_type.diameter.is_some() {
        return;
    }
    let wet = scene.water.is_some();
    let buoyant = wet && line_type.weight.is_none() && line_type.mass.is_some();
    let mut sections = scene.lines.iter().flat_map(|line| &line.sections);
    let on_seabed = scene.seabed.is_some() && sections.any(|section| section.line_type == name);
    let needs_buoyancy =
        "no diameter: the buoyancy in the water needs `diameter` [m], or give the `weight` in water [N/m]";
    let needs_contact = "no diameter: the seabed's stiffness and damping are per metre of diameter; give `diameter` [m], or leave out \
                         `[seabed]` where no line touches it";
    let drag = "the water acts on the diameter: give `diameter` [m] too";
    findings.refuse(at, &[("", buoyant, needs_buoyancy)]);
    for (key, _) in line_type
        .entries()
        .filter(|(key, value)| key.rule.acts.in_water() && !value.is_absent())
    {
        findings.refuse(at, &[(key.name(), wet, drag)]);
    }
    findings.refuse(at, &[("", on_seabed, needs_contact)]);
}

/// Keys of a viscoelastic rope.
const VISCOELASTIC: [&str; 4] = [
    "static_stiffness",
    "dynamic_stiffness",
    "static_damping",
    "dynamic_damping",
];

/// The axial force follows from a stiffness, a table, or two stiffnesses with dampers.
fn check_axial(findings: &mut Findings, at: &str, line_type: &LineType) {
    let (axial_stiffness, axial_damping) = (line_type.axial_stiffness, line_type.axial_damping);
    let viscoelastic = VISCOELASTIC
        .iter()
        .any(|key| line_type.get(key).is_some_and(|value| !value.is_absent()));
    let table = line_type.tension_strain.is_some();
    let (beam, measured) = (
        line_type.model == LineModel::Beam,
        line_type.strain != Strain::Engineering,
    );
    let rope = "a viscoelastic rope stretches by `static_stiffness`, `dynamic_stiffness` and the damping of each: leave this out";
    let (ruled, plain) = (table && !viscoelastic, !table && !viscoelastic);
    let missing =
        "missing key `axial_stiffness` [N], or `tension_strain`, a table of strain [-] and tension [N]";
    findings.refuse(
        at,
        &[
            ("", plain && axial_stiffness.is_none(), missing),
            (
                "strain",
                ruled && measured,
                "a table has its own strain, the stretched length over the unstretched one less 1: leave `strain` out",
            ),
            ("tension_strain", ruled && beam, "a beam has one `axial_stiffness` [N], and no table"),
            ("axial_stiffness", viscoelastic && axial_stiffness.is_some(), rope),
            ("tension_strain", viscoelastic && table, rope),
            ("axial_damping", viscoelastic && axial_damping.is_some(), rope),
            ("rayleigh", viscoelastic && line_type.rayleigh.is_some(), rope),
            ("strain", viscoelastic && measured, rope),
            ("model", viscoelastic && beam, rope),
        ],
    );
    if viscoelastic {
        check_viscoelastic(findings, at, line_type);
    }
}

fn check_viscoelastic(findings: &mut Findings, at: &str, line_type: &LineType) {
    for (key, value) in line_type.entries() {
        if VISCOELASTIC[..3].contains(&key.name()) && value.is_absent() {
            let unit = key.unit().unwrap_or_default();
            findings.say(
                at,
                format!("missing key `{}` [{unit}] of a viscoelastic rope", key.name()),
            );
        }
    }
    if let (Some(slow), Some(fast)) = (line_type.static_stiffness, line_type.dynamic_stiffness)
        && fast <= slow
    {
        let problem = format!(
            "{} is not above the static stiffness of {}: a rope is stiffer in fast motion",
            quantity(fast, "N"),
            quantity(slow, "N")
        );
        findings.say(format!("{at}.dynamic_stiffness"), problem);
    }
}

fn check_bending(findings: &mut Findings, at: &str, line_type: &LineType) {
    let fibres = line_type.fibres.is_some();
    findings.refuse(
        at,
        &[
            (
                "fibres",
                fibres && !line_type.bends() && line_type.fibres != Some(0),
                "fibres share a bending stiffness: give `bending_stiffness` [N m²] or `solid_section` too",
            ),
            (
                "fibre_law",
                !fibres && line_type.fibre_law != FibreLaw::Linear,
                "the law divides the bending stiffness by the number of `fibres`: give that too, or leave the law out",
            ),
        ],
    );
}

/// A beam resists everything, by a number of its own or by its solid section; a cable has neither shear nor torsion.
fn check_model(findings: &mut Findings, at: &str, line_type: &LineType, scene: &Scene) {
    let (beam, all_beams) = (
        line_type.model == LineModel::Beam,
        scene.solver.integrator == Integrator::Beam,
    );
    let why = match beam {
        true => "",
        false => ", and integrator = \"beam\" makes every line a beam",
    };
    for (key, value) in line_type.entries() {
        let (bending, name) = (key.name() == "bending_stiffness", key.name());
        if !bending && !["shear_stiffness", "torsional_stiffness", "rotary_inertia"].contains(&name) {
            continue;
        }
        let given = value.number().is_some_and(|number| !bending || number > 0.0);
        if !beam && !all_beams && !bending && given {
            let problem = "only a beam has it: write model = \"beam\" or leave it out";
            findings.say(format!("{at}.{name}"), problem);
        } else if (beam || all_beams) && !given && line_type.solid_section.is_none() {
            let unit = key.unit().unwrap_or_default();
            let problem =
                format!("a beam needs `{name}` [{unit}], or a `solid_section` that it follows from{why}");
            findings.say(at, problem);
        }
    }
    let measured = (beam || all_beams) && line_type.strain != Strain::Engineering;
    findings.refuse(
        at,
        &[(
            "strain",
            measured,
            "a beam stretches by the engineering strain: leave it out",
        )],
    );
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
    if slow_ratio * fast < fast_ratio * slow || fast_ratio * fast < slow_ratio * slow {
        let problem = format!(
            "the ratios ask for negative damping of mass or stiffness: their quotient must lie between {:.4} and {:.4}, \
             that of the frequencies and its inverse",
            slow / fast,
            fast / slow
        );
        findings.say(format!("{at}.ratios"), problem);
    }
}

impl Acts {
    /// Returns whether the property acts in water only.
    pub(in crate::scene) fn in_water(self) -> bool {
        matches!(self, Acts::InWater | Acts::InFlow | Acts::InAccelerations)
    }
}
