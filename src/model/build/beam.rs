//! Construction of the beam properties of a line.
//!
//! Section properties that a line type leaves open follow from `solid_section`, a circle of diameter d with Young's modulus E and
//! Poisson's ratio ν: EI = E π d⁴/64, GJ = E/(2(1 + ν)) π d⁴/32, GA = κ E/(2(1 + ν)) π d²/4 with κ = 6(1 + ν)/(7 + 6ν), rotary inertia
//! m d²/16 about a diameter and m d²/8 about the axis. Fibres reduce only EI, by `fibre_law`.
//!
//! Source of κ: Cowper (1966), J. Appl. Mech. 33, 335-340, table 1.

use nalgebra::Vector3;

use super::LineLaw;
use crate::math::circle;
use crate::model::{Beam, BeamElement};
use crate::physics::bending::solid_round;
use crate::physics::rayleigh;
use crate::physics::section::SectionLaw;
use crate::scene::{
    FibreLaw, Integrator, Line, LineModel, LineType, RestShape, Scene, SceneError, SolidSection, Strain,
};

/// A section of a beam line, per unstretched length.
struct Part {
    law: SectionLaw,
    damping: SectionLaw,
    rotary_inertia: Vector3<f64>, // about the three directors [kg m]
}

/// Beam properties of line `index`; `None` if it is a cable. `laws` and the `lengths` of elements [m] are those of
/// its sections.
pub(super) fn build(
    scene: &Scene,
    index: usize,
    line: &Line,
    laws: &[LineLaw],
    lengths: &[Vec<f64>],
) -> Result<Option<Beam>, SceneError> {
    let types = || {
        line.sections
            .iter()
            .filter_map(|section| scene.line_types.get_key_value(&section.line_type))
    };
    let asked = scene.solver.integrator;
    let beams = types().filter(|(_, t)| t.model == LineModel::Beam).count();
    if beams == 0 && asked != Integrator::Beam {
        return Ok(None);
    }
    if beams < line.sections.len() && asked != Integrator::Beam {
        return Err(SceneError::new(
            format!("lines[{index}].sections"),
            "some sections are beams and some are cables: give all of their line types model = \"beam\", or none",
        ));
    }
    if !matches!(asked, Integrator::Auto | Integrator::Beam) {
        return Err(SceneError::new(
            "solver.integrator",
            format!(
                "line \"{}\" is a beam, which only \"beam\" and \"auto\" integrate",
                line.name
            ),
        ));
    }
    let parts = types()
        .zip(laws)
        .map(|((name, line_type), law)| part(name, line_type, law))
        .collect::<Result<Vec<Part>, SceneError>>()?;
    Ok(Some(assemble(line, &parts, lengths)))
}

fn assemble(line: &Line, parts: &[Part], lengths: &[Vec<f64>]) -> Beam {
    let mut beam = Beam {
        elements: Vec::new(),
        rotary_inertia: vec![Vector3::zeros()],
        clamped: [line.clamped_a, line.clamped_b]
            .map(|direction| direction.map(|d| Vector3::from(d).normalize())),
        rests_as_it_starts: line.rest_shape == RestShape::Initial,
    };
    for (part, lengths) in parts.iter().zip(lengths) {
        for &length in lengths {
            beam.elements.push(BeamElement {
                length,
                law: part.law,
                damping: part.damping,
            });
            let half = 0.5 * length * part.rotary_inertia;
            if let Some(last) = beam.rotary_inertia.last_mut() {
                *last += half;
            }
            beam.rotary_inertia.push(half);
        }
    }
    beam
}

fn part(name: &str, line_type: &LineType, law: &LineLaw) -> Result<Part, SceneError> {
    let at = |key: &str| format!("line_types.{name}.{key}");
    if line_type.strain != Strain::Engineering {
        return Err(SceneError::new(
            at("strain"),
            "a beam has engineering strain only: leave `strain` out",
        ));
    }
    if line_type.tension_strain.is_some() {
        return Err(SceneError::new(
            at("tension_strain"),
            "a beam has one `axial_stiffness` [N], and no table",
        ));
    }
    let solid = line_type.solid_section.as_ref();
    let stiffness = |key: &str, given: Option<f64>, of: fn(&SolidSection) -> f64| {
        let missing = format!("a beam needs `{key}`, or `solid_section` to have it from");
        given
            .or_else(|| solid.map(of))
            .ok_or_else(|| SceneError::new(at(key), missing))
    };
    let strands = strands(line_type);
    let section = SectionLaw {
        axial: law.axial_stiffness,
        shear: stiffness("shear_stiffness", line_type.shear_stiffness, shear)?,
        bending: stiffness("bending_stiffness", line_type.bending_stiffness, bending)? / strands,
        torsion: stiffness("torsional_stiffness", line_type.torsional_stiffness, torsion)?,
    };
    let slowed = line_type
        .rayleigh
        .map_or(0.0, |r| rayleigh::coefficients(r.ratios, r.frequencies).stiffness);
    Ok(Part {
        damping: SectionLaw {
            axial: law.axial_damping, // including Rayleigh damping and a damping ratio
            shear: slowed * section.shear,
            bending: slowed * section.bending,
            torsion: slowed * section.torsion,
        },
        law: section,
        rotary_inertia: rotary_inertia(name, line_type, law.mass)?,
    })
}

/// Ratio of the bending stiffness of a solid section to that of its fibres [-].
fn strands(line_type: &LineType) -> f64 {
    let fibres = line_type.fibres.unwrap_or(1) as f64;
    match line_type.fibre_law {
        FibreLaw::Linear => fibres,
        FibreLaw::Squared => fibres * fibres,
    }
}

fn rotary_inertia(name: &str, line_type: &LineType, mass: f64) -> Result<Vector3<f64>, SceneError> {
    if let Some(given) = line_type.rotary_inertia {
        return Ok(Vector3::repeat(given));
    }
    let solid = line_type.solid_section.as_ref().map(|solid| solid.diameter);
    let diameter = solid.or(line_type.diameter).ok_or_else(|| {
        SceneError::new(
            format!("line_types.{name}.rotary_inertia"),
            "a beam needs `rotary_inertia` [kg m], or `solid_section` or `diameter` to have it from",
        )
    })?;
    Ok(mass * diameter * diameter * Vector3::new(0.0625, 0.0625, 0.125))
}

fn shear_modulus(solid: &SolidSection) -> f64 {
    solid.youngs_modulus / (2.0 * (1.0 + solid.poisson))
}

fn shear(solid: &SolidSection) -> f64 {
    let nu = solid.poisson;
    let kappa = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu); // κ [-]
    kappa * shear_modulus(solid) * circle::area(solid.diameter)
}

fn bending(solid: &SolidSection) -> f64 {
    solid_round(solid.diameter, solid.youngs_modulus)
}

fn torsion(solid: &SolidSection) -> f64 {
    shear_modulus(solid) * 2.0 * circle::second_moment(solid.diameter)
}
