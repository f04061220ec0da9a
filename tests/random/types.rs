//! Line types.

use std::f64::consts::PI;

use moorline::scene::{
    FibreLaw, Integrator, LineModel, LineType, Rayleigh, SolidSection, Strain, TensionStrain,
};

use crate::dice::Dice;
use crate::plan::{Plan, Resists};

/// Explicit time step that lines with explicit integration should allow [s]; shorter steps exceed the cost limit of a scene.
const EXPLICIT_STEP: f64 = 1e-3;
/// Greatest speed of axial waves, except in wild lines [m/s]: twenty times that in steel.
const AXIAL_SPEED: f64 = 1e5;

/// Returns a line type for lines of about the plan's size.
pub fn line_type(dice: &mut Dice, plan: &Plan) -> LineType {
    let mass = dice.size([1e-2, 1e3], [1e-15, 1e6]);
    let density = 8000.0 / dice.log(1.0, 20.0); // from chain to foam [kg/m³]
    let round = (4.0 * mass / (PI * density)).sqrt().clamp(1e-9, 100.0);
    let diameter = dice.size([round, round], [1e-15, 100.0]);
    let mut kind = LineType {
        mass: Some(mass),
        diameter: Some(diameter),
        ..LineType::default()
    };
    if dice.chance(0.1) {
        let weight = mass * plan.gravity * dice.between(-0.5, 1.0);
        kind.weight = Some(weight);
    }
    stretch(dice, plan, &mut kind, mass);
    if plan.wet {
        let mut coefficient = |usual: [f64; 2]| {
            let given = dice.chance(0.8);
            let value = dice.size(usual, [1e-15, 1e3]);
            given.then_some(value)
        };
        kind.drag_normal = coefficient([0.1, 3.0]);
        kind.drag_tangential = coefficient([0.01, 1.0]);
        kind.added_mass_normal = coefficient([0.1, 4.0]);
        kind.added_mass_tangential = coefficient([0.01, 1.0]);
        if plan.resists == Resists::Torsion && dice.chance(0.5) {
            (kind.drag_normal, kind.drag_tangential) = (None, None);
        }
    }
    bending(dice, plan, &mut kind, diameter);
    kind
}

/// Sets the axial stiffness, from 1 kN to 10 TN, a table or a viscoelastic law; and the damping.
fn stretch(dice: &mut Dice, plan: &Plan, kind: &mut LineType, mass: f64) {
    let beam = plan.resists == Resists::Torsion;
    let hanging = if beam { 5e3 } else { 5.0 } * mass * plan.gravity * plan.size;
    let least = hanging.clamp(1e3, 1e12);
    let speed = match plan.integrator == Integrator::Leapfrog || plan.winch {
        true => (plan.size / 40.0 / EXPLICIT_STEP).min(AXIAL_SPEED),
        false => AXIAL_SPEED,
    };
    let most = (mass * speed * speed).clamp(2.0 * least, 1e13);
    let stiffness = dice.size([least, most], [1e-15, 1e15]);
    let number = match plan.law {
        Some(law) if !beam && !plan.winch => law,
        Some(_) => 0,
        None => dice.whole(0, 8),
    };
    match number {
        8 => {
            let [kink, factor] = [dice.log(1e-3, 0.1), dice.log(1.0, 20.0)];
            let knee = stiffness * kink;
            let rows = vec![[0.0, 0.0], [kink, knee], [2.0 * kink, (1.0 + factor) * knee]];
            kind.tension_strain = Some(TensionStrain { file: None, rows });
        }
        9 => {
            let stiffness = stiffness.min(1e14);
            kind.static_stiffness = Some(stiffness);
            kind.dynamic_stiffness = Some(stiffness * dice.log(1.1, 8.0));
            kind.static_damping = Some((stiffness * dice.log(1e-3, 1e3)).min(1e15));
            kind.dynamic_damping = dice.maybe(0.5, |dice| stiffness * dice.log(1e-6, 1e-2));
            return;
        }
        number => {
            kind.axial_stiffness = Some(stiffness);
            kind.strain = match number {
                6 => Strain::Green,
                7 => Strain::Logarithmic(plan.poisson),
                _ => Strain::Engineering,
            };
        }
    }
    match dice.whole(0, 4) {
        0 => {}
        1 => kind.axial_damping = Some((stiffness * dice.log(1e-7, 0.3)).clamp(1e-15, 1e15)),
        2 => kind.axial_damping = Some(0.0),
        3 => kind.damping_ratio = Some(dice.size([1e-3, 2.0], [1e-15, 100.0])),
        // leapfrogs do not allow damped joints
        _ if plan.resists == Resists::Bending && plan.is_leapfrog() => {}
        _ => {
            let ratio = dice.log(1e-3, 0.5);
            let frequency = dice.log(0.05, 5.0);
            kind.rayleigh = Some(Rayleigh {
                ratios: [ratio; 2],
                frequencies: [frequency, frequency * dice.log(1.5, 100.0)],
            });
        }
    }
}

/// Sets the bending stiffness, and for beams the torsional and shear stiffness.
fn bending(dice: &mut Dice, plan: &Plan, kind: &mut LineType, diameter: f64) {
    let axial = kind.axial_stiffness.or(kind.static_stiffness).unwrap_or(1e6);
    let rod = axial * diameter * diameter / 16.0; // EI of a solid rod [N m²]
    match plan.resists {
        Resists::Stretch => {}
        Resists::Bending if dice.chance(0.3) => {
            kind.solid_section = Some(solid(dice, diameter, axial));
            kind.fibres = dice.maybe(0.5, |dice| dice.whole(1, 200));
            let law = dice.pick(&[FibreLaw::Linear, FibreLaw::Squared]);
            kind.fibre_law = kind.fibres.map_or(FibreLaw::Linear, |_| law);
        }
        Resists::Bending => {
            let most = if plan.is_leapfrog() { 1e-3 } else { 1.0 };
            let stiffness = (rod * dice.log(1e-4 * most, most)).clamp(1e-15, 1e15);
            kind.bending_stiffness = dice.pick(&[Some(stiffness), Some(stiffness), None]);
        }
        Resists::Torsion => {
            kind.model = LineModel::Beam;
            let chunky = plan.size * dice.log(0.01, 0.05);
            kind.solid_section = Some(solid(dice, chunky, axial));
            kind.rotary_inertia = dice.maybe(0.3, |dice| {
                kind.mass.unwrap_or(1.0) * chunky * chunky * dice.log(0.1, 10.0)
            });
        }
    }
}

/// Returns a rod with a diameter [m] and an axial stiffness [N].
fn solid(dice: &mut Dice, diameter: f64, axial: f64) -> SolidSection {
    let area = 0.25 * PI * diameter * diameter;
    SolidSection {
        diameter,
        youngs_modulus: (axial / area).clamp(1e-15, 1e15),
        poisson: dice.between(0.0, 0.5),
    }
}
