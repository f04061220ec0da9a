//! Properties per length.

use super::{Bounds, Findings, check_name, quantity};
use crate::scene::path::quoted;
use crate::scene::{
    FibreLaw, Integrator, LineModel, LineType, Rayleigh, Scene, SolidSection, Strain, TensionStrain,
};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    for (name, line_type) in &scene.line_types {
        let at = format!("line_types.{}", quoted(name));
        check_name(findings, &at, name);
        check_numbers(findings, &at, line_type);
        check_mass(findings, &at, line_type, scene);
        check_diameter(findings, &at, name, line_type, scene);
        check_stretch(findings, &at, line_type);
        check_bending(findings, &at, line_type, scene);
    }
}

fn check_numbers(findings: &mut Findings, at: &str, line_type: &LineType) {
    let coefficient = Bounds::NotNegative(1e3);
    let rows = [
        ("mass", line_type.mass, Bounds::NotNegative(1e6), "kg/m"),
        ("weight", line_type.weight, Bounds::Magnitude(1e8), "N/m"),
        ("diameter", line_type.diameter, Bounds::Positive(100.0), "m"),
        (
            "axial_stiffness",
            line_type.axial_stiffness,
            Bounds::Positive(1e15),
            "N",
        ),
        (
            "axial_damping",
            line_type.axial_damping,
            Bounds::NotNegative(1e15),
            "N s",
        ),
        (
            "damping_ratio",
            line_type.damping_ratio,
            Bounds::NotNegative(100.0),
            "-",
        ),
        ("drag_normal", line_type.drag_normal, coefficient, "-"),
        ("drag_tangential", line_type.drag_tangential, coefficient, "-"),
        ("added_mass_normal", line_type.added_mass_normal, coefficient, "-"),
        (
            "added_mass_tangential",
            line_type.added_mass_tangential,
            coefficient,
            "-",
        ),
    ];
    for (key, value, bounds, unit) in rows {
        findings.number_if(format!("{at}.{key}"), value, bounds, unit);
    }
}

fn check_mass(findings: &mut Findings, at: &str, line_type: &LineType, scene: &Scene) {
    match (line_type.mass, line_type.weight) {
        (None, None) => findings.say(
            at,
            "no mass: give `mass` [kg/m], or `weight` [N/m] (the mass is then weight/gravity)",
        ),
        (None, Some(_)) if scene.gravity == 0.0 => findings.say(
            format!("{at}.weight"),
            "the mass would be weight/gravity, but gravity is 0: give `mass` [kg/m] too",
        ),
        (None, Some(weight)) if weight <= 0.0 => findings.say(
            format!("{at}.weight"),
            format!(
                "the mass would be weight/gravity, and {} is not positive: give `mass` [kg/m] too",
                quantity(weight, "N/m")
            ),
        ),
        _ => {}
    }
}

/// Water and seabed act on a line by its diameter.
fn check_diameter(findings: &mut Findings, at: &str, name: &str, line_type: &LineType, scene: &Scene) {
    if line_type.diameter.is_some() {
        return;
    }
    if scene.water.is_some() {
        if line_type.weight.is_none() && line_type.mass.is_some() {
            let problem = "no diameter: the buoyancy in the water needs `diameter` [m], \
                           or give the `weight` in water [N/m]";
            findings.say(at, problem);
        }
        for (key, value) in coefficients(line_type) {
            if value.is_some() {
                let problem = "the water acts on the diameter: give `diameter` [m] too";
                findings.say(format!("{at}.{key}"), problem);
            }
        }
    }
    let on_seabed = scene.lines.iter().any(|line| {
        let mut sections = line.sections.iter();
        sections.any(|section| section.line_type == name)
    });
    if scene.seabed.is_some() && on_seabed {
        let problem = "no diameter: the seabed's stiffness and damping are per metre of diameter; \
                       give `diameter` [m], or leave out `[seabed]` where no line touches it";
        findings.say(at, problem);
    }
}

/// The coefficients of drag and added mass, by key.
pub(in crate::scene) fn coefficients(line_type: &LineType) -> [(&'static str, Option<f64>); 4] {
    [
        ("drag_normal", line_type.drag_normal),
        ("drag_tangential", line_type.drag_tangential),
        ("added_mass_normal", line_type.added_mass_normal),
        ("added_mass_tangential", line_type.added_mass_tangential),
    ]
}

/// What the axial force follows from: a stiffness, a table, or two stiffnesses with dampers.
fn check_axial(findings: &mut Findings, at: &str, line_type: &LineType) {
    if viscoelastic(line_type).iter().any(|(_, value)| value.is_some()) {
        check_viscoelastic(findings, at, line_type);
        return;
    }
    let Some(table) = &line_type.tension_strain else {
        if line_type.axial_stiffness.is_none() {
            findings.say(
                at,
                "missing key `axial_stiffness` [N], or `tension_strain`, a table of strain [-] and tension [N]",
            );
        }
        return;
    };
    let at_table = format!("{at}.tension_strain");
    if line_type.axial_stiffness.is_some() {
        findings.say(
            format!("{at}.axial_stiffness"),
            "`tension_strain` is given too: give one of them",
        );
    }
    if line_type.strain != Strain::Engineering {
        findings.say(
            format!("{at}.strain"),
            "a table has its own strain, the stretched length over the unstretched one less 1: leave `strain` out",
        );
    }
    if line_type.model == LineModel::Beam {
        findings.say(&at_table, "a beam has one `axial_stiffness` [N], and no table");
    }
    check_table(findings, &at_table, table);
}

/// The keys of a viscoelastic rope.
fn viscoelastic(line_type: &LineType) -> [(&'static str, Option<f64>); 4] {
    [
        ("static_stiffness", line_type.static_stiffness),
        ("dynamic_stiffness", line_type.dynamic_stiffness),
        ("static_damping", line_type.static_damping),
        ("dynamic_damping", line_type.dynamic_damping),
    ]
}

/// A viscoelastic rope has two stiffnesses and two dampings, and nothing else that resists stretch.
fn check_viscoelastic(findings: &mut Findings, at: &str, line_type: &LineType) {
    for (key, value) in viscoelastic(line_type) {
        let unit = if key.ends_with("stiffness") { "N" } else { "N s" };
        let bounds = match key {
            "dynamic_damping" => Bounds::NotNegative(1e15),
            _ => Bounds::Positive(1e15),
        };
        findings.number_if(format!("{at}.{key}"), value, bounds, unit);
        if value.is_none() && key != "dynamic_damping" {
            findings.say(at, format!("missing key `{key}` [{unit}] of a viscoelastic rope"));
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
    let others = [
        ("axial_stiffness", line_type.axial_stiffness.is_some()),
        ("tension_strain", line_type.tension_strain.is_some()),
        ("axial_damping", line_type.axial_damping.is_some()),
        ("rayleigh", line_type.rayleigh.is_some()),
        ("strain", line_type.strain != Strain::Engineering),
        ("model", line_type.model == LineModel::Beam),
    ];
    for (key, _) in others.iter().filter(|(_, given)| *given) {
        let problem = "a viscoelastic rope stretches by `static_stiffness`, `dynamic_stiffness` and the damping of each: \
                       leave this out";
        findings.say(format!("{at}.{key}"), problem);
    }
    if line_type.dynamic_damping.is_some() && line_type.damping_ratio.is_some() {
        let problem = "`dynamic_damping` is given too: give one of them";
        findings.say(format!("{at}.damping_ratio"), problem);
    }
}

/// Rows of a table of strain and tension.
fn check_table(findings: &mut Findings, at: &str, table: &TensionStrain) {
    for (number, row) in table.rows.iter().enumerate() {
        let at = format!("{at}[{number}]");
        let strain = findings.number(&at, row[0], Bounds::Magnitude(10.0), "-");
        let tension = findings.number(&at, row[1], Bounds::Magnitude(1e15), "N");
        if !strain || !tension {
            return;
        }
        let before = number.checked_sub(1).map(|before| table.rows[before]);
        let problem = match before {
            None if *row != [0.0, 0.0] => "a table begins with no tension at no strain: [0.0, 0.0]",
            Some([strain, _]) if row[0] <= strain => "strain must rise from row to row",
            Some([_, tension]) if row[1] <= tension => "tension must rise with strain",
            _ => continue,
        };
        findings.say(at, problem);
        return;
    }
    if table.rows.len() < 2 {
        let problem = match &table.file {
            Some(file) if table.rows.is_empty() => {
                format!("{file} was not read: write its rows here")
            }
            _ => "a table has two rows [strain, tension] or more".to_string(),
        };
        findings.say(at, problem);
    }
}

fn check_stretch(findings: &mut Findings, at: &str, line_type: &LineType) {
    check_axial(findings, at, line_type);
    if line_type.axial_damping.is_some() && line_type.damping_ratio.is_some() {
        findings.say(
            format!("{at}.damping_ratio"),
            "`axial_damping` is given too: give one of them",
        );
    }
    if let Strain::Logarithmic(poisson_ratio) = line_type.strain {
        let at = format!("{at}.strain.logarithmic");
        findings.number(at, poisson_ratio, Bounds::Within(0.0, 0.5), "-");
    }
    if let Some(rayleigh) = &line_type.rayleigh {
        check_rayleigh(findings, &format!("{at}.rayleigh"), rayleigh);
    }
}

/// A solid section that stiffnesses follow from.
fn check_solid_section(findings: &mut Findings, at: &str, section: &SolidSection) {
    let rows = [
        ("diameter", section.diameter, Bounds::Positive(100.0), "m"),
        (
            "youngs_modulus",
            section.youngs_modulus,
            Bounds::Positive(1e15),
            "Pa",
        ),
        ("poisson", section.poisson, Bounds::Within(0.0, 0.5), "-"),
    ];
    for (key, value, bounds, unit) in rows {
        findings.number(format!("{at}.{key}"), value, bounds, unit);
    }
}

/// Bending of cables, and what beams need beside it.
fn check_bending(findings: &mut Findings, at: &str, line_type: &LineType, scene: &Scene) {
    check_stiffnesses(findings, at, line_type);
    let bends = line_type.bends();
    match line_type.fibres {
        Some(0) => findings.say(
            format!("{at}.fibres"),
            "0 fibres: a section has 1 or more of them",
        ),
        Some(_) if !bends => findings.say(
            format!("{at}.fibres"),
            "fibres share a bending stiffness: give `bending_stiffness` [N m²] or `solid_section` too",
        ),
        None if line_type.fibre_law != FibreLaw::Linear => findings.say(
            format!("{at}.fibre_law"),
            "the law divides the bending stiffness by the number of `fibres`: give that too, or leave the law out",
        ),
        _ => {}
    }
    if line_type.model == LineModel::Beam || scene.solver.integrator == Integrator::Beam {
        check_beam(findings, at, line_type);
        return;
    }
    let beam_only = [
        ("shear_stiffness", line_type.shear_stiffness),
        ("torsional_stiffness", line_type.torsional_stiffness),
        ("rotary_inertia", line_type.rotary_inertia),
    ];
    for (key, value) in beam_only {
        if value.is_some() {
            let problem = "only a beam has it: write model = \"beam\" or leave it out";
            findings.say(format!("{at}.{key}"), problem);
        }
    }
}

/// Numbers that bending, shear and torsion follow from.
fn check_stiffnesses(findings: &mut Findings, at: &str, line_type: &LineType) {
    if let Some(section) = &line_type.solid_section {
        check_solid_section(findings, &format!("{at}.solid_section"), section);
    }
    let stiff = Bounds::Positive(1e15);
    let rows = [
        (
            "bending_stiffness",
            line_type.bending_stiffness,
            Bounds::NotNegative(1e15),
            "N m²",
        ),
        ("shear_stiffness", line_type.shear_stiffness, stiff, "N"),
        (
            "torsional_stiffness",
            line_type.torsional_stiffness,
            stiff,
            "N m²",
        ),
        (
            "rotary_inertia",
            line_type.rotary_inertia,
            Bounds::Positive(1e9),
            "kg m",
        ),
    ];
    for (key, value, bounds, unit) in rows {
        findings.number_if(format!("{at}.{key}"), value, bounds, unit);
    }
}

/// A beam resists everything, by a number of its own or by its solid section.
fn check_beam(findings: &mut Findings, at: &str, line_type: &LineType) {
    let needed = [
        (
            "bending_stiffness",
            line_type.bending_stiffness.filter(|ei| *ei > 0.0),
            "N m²",
        ),
        ("shear_stiffness", line_type.shear_stiffness, "N"),
        ("torsional_stiffness", line_type.torsional_stiffness, "N m²"),
        ("rotary_inertia", line_type.rotary_inertia, "kg m"),
    ];
    for (key, value, unit) in needed {
        if value.is_none() && line_type.solid_section.is_none() {
            let why = match line_type.model {
                LineModel::Beam => "",
                LineModel::Cable => ", and integrator = \"beam\" makes every line a beam",
            };
            let problem =
                format!("a beam needs `{key}` [{unit}], or a `solid_section` that it follows from{why}");
            findings.say(at, problem);
        }
    }
    if line_type.strain != Strain::Engineering {
        findings.say(
            format!("{at}.strain"),
            "a beam stretches by the engineering strain: leave it out",
        );
    }
}

fn check_rayleigh(findings: &mut Findings, at: &str, rayleigh: &Rayleigh) {
    let mut right = true;
    for i in 0..2 {
        let ratio = Bounds::NotNegative(100.0);
        right &= findings.number(format!("{at}.ratios[{i}]"), rayleigh.ratios[i], ratio, "-");
        let frequency = Bounds::Positive(1e9);
        let value = rayleigh.frequencies[i];
        right &= findings.number(format!("{at}.frequencies[{i}]"), value, frequency, "rad/s");
    }
    if !right {
        return;
    }
    let ([ratio_1, ratio_2], [frequency_1, frequency_2]) = (rayleigh.ratios, rayleigh.frequencies);
    if frequency_1 == frequency_2 {
        findings.say(
            format!("{at}.frequencies"),
            "the two circular frequencies are equal: the ratios hold at two different ones",
        );
        return;
    }
    let ((slow, slow_ratio), (fast, fast_ratio)) = if frequency_1 < frequency_2 {
        ((frequency_1, ratio_1), (frequency_2, ratio_2))
    } else {
        ((frequency_2, ratio_2), (frequency_1, ratio_1))
    };
    // α = 2ω₁ω₂(ζ₁ω₂ − ζ₂ω₁)/(ω₂² − ω₁²) and β = 2(ζ₂ω₂ − ζ₁ω₁)/(ω₂² − ω₁²), both at least 0.
    if slow_ratio * fast < fast_ratio * slow || fast_ratio * fast < slow_ratio * slow {
        let problem = format!(
            "the ratios ask for negative damping of mass or stiffness: their quotient must lie between {} and {}, \
             that of the frequencies and its inverse",
            number_short(slow / fast),
            number_short(fast / slow)
        );
        findings.say(format!("{at}.ratios"), problem);
    }
}

fn number_short(value: f64) -> String {
    format!("{value:.4}")
}
