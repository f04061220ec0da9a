//! The parameters of a scene: what a host may change before the simulation starts.

use super::rows::row;
use super::{Binding, Causality, Kind, Unit, Variable};
use crate::scene::{LineType, Reconstruction, Scene};

/// A parameter of the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Parameter {
    /// A property of a line type.
    LineType {
        /// The line type.
        name: String,
        /// The property.
        property: Property,
    },
    /// Unstretched length of a section [m].
    SectionLength {
        /// The line.
        line: usize,
        /// The section of the line.
        section: usize,
    },
    /// Density of the water [kg/m³].
    WaterDensity,
    /// Depth of the seabed [m].
    SeabedDepth,
    /// Gravitational acceleration [m/s²].
    Gravity,
    /// Target error of fairlead tension [-].
    Tolerance,
    /// How the path of a coupled point between communication points is built: 0 smooth, 1 jump.
    InputReconstruction,
}

/// A property of a line type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Property {
    /// Mass in air [kg/m].
    Mass,
    /// Weight in the scene's surroundings [N/m].
    Weight,
    /// Volume-equivalent diameter [m].
    Diameter,
    /// Axial stiffness EA [N].
    AxialStiffness,
    /// Bending stiffness EI of one solid section [N m²].
    BendingStiffness,
    /// Shear stiffness GA of a beam [N].
    ShearStiffness,
    /// Torsional stiffness GJ of a beam [N m²].
    TorsionalStiffness,
    /// Rotary inertia of a beam's section per length [kg m].
    RotaryInertia,
    /// Static stiffness EA_s of a viscoelastic rope [N].
    StaticStiffness,
    /// Dynamic stiffness EA_d of a viscoelastic rope [N].
    DynamicStiffness,
    /// Damping BA_s of the slow part of a viscoelastic rope [N s].
    StaticDamping,
    /// Damping BA_d of the fast part of a viscoelastic rope [N s].
    DynamicDamping,
    /// Axial damping BA [N s].
    AxialDamping,
    /// Axial damping as a ratio of the critical [-].
    DampingRatio,
    /// Normal drag coefficient [-].
    DragNormal,
    /// Tangential drag coefficient [-].
    DragTangential,
    /// Normal added-mass coefficient [-].
    AddedMassNormal,
    /// Tangential added-mass coefficient [-].
    AddedMassTangential,
}

/// Properties with key, unit and meaning.
const PROPERTIES: [(Property, &str, Unit, &str); 18] = [
    (
        Property::AxialStiffness,
        "axial_stiffness",
        Unit::NEWTON,
        "axial stiffness EA",
    ),
    (
        Property::StaticStiffness,
        "static_stiffness",
        Unit::NEWTON,
        "static stiffness of a viscoelastic rope",
    ),
    (
        Property::DynamicStiffness,
        "dynamic_stiffness",
        Unit::NEWTON,
        "dynamic stiffness of a viscoelastic rope",
    ),
    (
        Property::StaticDamping,
        "static_damping",
        Unit::NEWTON_SECOND,
        "damping of the slow part of a viscoelastic rope",
    ),
    (
        Property::DynamicDamping,
        "dynamic_damping",
        Unit::NEWTON_SECOND,
        "damping of the fast part of a viscoelastic rope",
    ),
    (
        Property::BendingStiffness,
        "bending_stiffness",
        Unit::NEWTON_SQUARE_METRE,
        "bending stiffness EI of one solid section",
    ),
    (
        Property::ShearStiffness,
        "shear_stiffness",
        Unit::NEWTON,
        "shear stiffness GA of beams",
    ),
    (
        Property::TorsionalStiffness,
        "torsional_stiffness",
        Unit::NEWTON_SQUARE_METRE,
        "torsional stiffness GJ of beams",
    ),
    (
        Property::RotaryInertia,
        "rotary_inertia",
        Unit::KILOGRAM_METRE,
        "rotary inertia of a beam's section per unstretched length",
    ),
    (
        Property::Mass,
        "mass",
        Unit::KILOGRAM_PER_METRE,
        "mass in air per unstretched length",
    ),
    (
        Property::Weight,
        "weight",
        Unit::NEWTON_PER_METRE,
        "weight in the surroundings per unstretched length",
    ),
    (
        Property::Diameter,
        "diameter",
        Unit::METRE,
        "volume-equivalent diameter",
    ),
    (
        Property::AxialDamping,
        "axial_damping",
        Unit::NEWTON_SECOND,
        "axial damping BA",
    ),
    (
        Property::DampingRatio,
        "damping_ratio",
        Unit::ONE,
        "axial damping as a ratio of the critical damping of each segment",
    ),
    (
        Property::DragNormal,
        "drag_normal",
        Unit::ONE,
        "normal drag coefficient on the diameter",
    ),
    (
        Property::DragTangential,
        "drag_tangential",
        Unit::ONE,
        "tangential drag coefficient on pi times the diameter",
    ),
    (
        Property::AddedMassNormal,
        "added_mass_normal",
        Unit::ONE,
        "normal added-mass coefficient on the displaced volume",
    ),
    (
        Property::AddedMassTangential,
        "added_mass_tangential",
        Unit::ONE,
        "tangential added-mass coefficient on the displaced volume",
    ),
];

impl Property {
    fn value(self, line_type: &LineType) -> Option<f64> {
        match self {
            Property::Mass => line_type.mass,
            Property::Weight => line_type.weight,
            Property::Diameter => line_type.diameter,
            Property::AxialStiffness => line_type.axial_stiffness,
            Property::BendingStiffness => line_type.bending_stiffness,
            Property::ShearStiffness => line_type.shear_stiffness,
            Property::TorsionalStiffness => line_type.torsional_stiffness,
            Property::RotaryInertia => line_type.rotary_inertia,
            Property::StaticStiffness => line_type.static_stiffness,
            Property::DynamicStiffness => line_type.dynamic_stiffness,
            Property::StaticDamping => line_type.static_damping,
            Property::DynamicDamping => line_type.dynamic_damping,
            Property::AxialDamping => line_type.axial_damping,
            Property::DampingRatio => line_type.damping_ratio,
            Property::DragNormal => line_type.drag_normal,
            Property::DragTangential => line_type.drag_tangential,
            Property::AddedMassNormal => line_type.added_mass_normal,
            Property::AddedMassTangential => line_type.added_mass_tangential,
        }
    }

    fn set(self, line_type: &mut LineType, value: f64) {
        let target = match self {
            Property::AxialStiffness => &mut line_type.axial_stiffness,
            Property::Mass => &mut line_type.mass,
            Property::Weight => &mut line_type.weight,
            Property::Diameter => &mut line_type.diameter,
            Property::BendingStiffness => &mut line_type.bending_stiffness,
            Property::ShearStiffness => &mut line_type.shear_stiffness,
            Property::TorsionalStiffness => &mut line_type.torsional_stiffness,
            Property::RotaryInertia => &mut line_type.rotary_inertia,
            Property::StaticStiffness => &mut line_type.static_stiffness,
            Property::DynamicStiffness => &mut line_type.dynamic_stiffness,
            Property::StaticDamping => &mut line_type.static_damping,
            Property::DynamicDamping => &mut line_type.dynamic_damping,
            Property::AxialDamping => &mut line_type.axial_damping,
            Property::DampingRatio => &mut line_type.damping_ratio,
            Property::DragNormal => &mut line_type.drag_normal,
            Property::DragTangential => &mut line_type.drag_tangential,
            Property::AddedMassNormal => &mut line_type.added_mass_normal,
            Property::AddedMassTangential => &mut line_type.added_mass_tangential,
        };
        *target = Some(value);
    }
}

impl Parameter {
    /// Its value in a scene that has it; `None` in a scene that has not.
    pub fn value(&self, scene: &Scene) -> Option<f64> {
        match self {
            Parameter::LineType { name, property } => property.value(scene.line_types.get(name)?),
            Parameter::SectionLength { line, section } => {
                Some(scene.lines.get(*line)?.sections.get(*section)?.length)
            }
            Parameter::WaterDensity => Some(scene.water.as_ref()?.density),
            Parameter::SeabedDepth => Some(scene.seabed.as_ref()?.depth),
            Parameter::Gravity => Some(scene.gravity),
            Parameter::Tolerance => Some(scene.solver.tolerance),
            Parameter::InputReconstruction => Some(match scene.solver.input_reconstruction {
                Reconstruction::Smooth => 0.0,
                Reconstruction::Jump => 1.0,
                Reconstruction::Interpolate => 2.0,
            }),
        }
    }

    /// Sets it in a scene that has it.
    ///
    /// # Errors
    /// What would be right, for a number that stands for no choice. Ranges are left to [`Scene::check`].
    pub fn set(&self, scene: &mut Scene, value: f64) -> Result<(), String> {
        match self {
            Parameter::LineType { name, property } => {
                if let Some(line_type) = scene.line_types.get_mut(name) {
                    property.set(line_type, value);
                }
            }
            Parameter::SectionLength { line, section } => {
                scene.lines[*line].sections[*section].length = value;
            }
            Parameter::WaterDensity => {
                if let Some(water) = &mut scene.water {
                    water.density = value;
                }
            }
            Parameter::SeabedDepth => {
                if let Some(seabed) = &mut scene.seabed {
                    seabed.depth = value;
                }
            }
            Parameter::Gravity => scene.gravity = value,
            Parameter::Tolerance => scene.solver.tolerance = value,
            Parameter::InputReconstruction => {
                scene.solver.input_reconstruction = match value {
                    0.0 => Reconstruction::Smooth,
                    1.0 => Reconstruction::Jump,
                    2.0 => Reconstruction::Interpolate,
                    _ => {
                        let known = "0 (smooth), 1 (jump) nor 2 (interpolate)";
                        return Err(format!("{value} is neither {known}"));
                    }
                };
            }
        }
        Ok(())
    }
}

/// Rows of all parameters that the scene gives.
pub(super) fn variables(scene: &Scene) -> Vec<Variable> {
    let mut rows = Rows {
        scene,
        variables: Vec::new(),
    };
    rows.push_line_types();
    rows.push_lengths();
    rows.push_globals();
    rows.variables
}

/// Rows in the making.
struct Rows<'a> {
    scene: &'a Scene,
    variables: Vec<Variable>,
}

impl Rows<'_> {
    /// Adds a row if the scene has the parameter.
    fn push(&mut self, name: String, description: String, unit: Unit, parameter: Parameter) {
        let Some(start) = parameter.value(self.scene) else {
            return;
        };
        let kind = match parameter {
            Parameter::InputReconstruction => Kind::Int32,
            _ => Kind::Float64,
        };
        let binding = Binding::Parameter(parameter);
        let mut variable = row(name, description, Causality::Parameter, unit, binding);
        variable.kind = kind;
        variable.start = Some(start);
        self.variables.push(variable);
    }

    fn push_line_types(&mut self) {
        for name in self.scene.line_types.keys() {
            for (property, key, unit, meaning) in PROPERTIES {
                let parameter = Parameter::LineType {
                    name: name.clone(),
                    property,
                };
                self.push(
                    format!("{name}.{key}"),
                    format!("{name}: {meaning}"),
                    unit,
                    parameter,
                );
            }
        }
    }

    fn push_lengths(&mut self) {
        for (line, described) in self.scene.lines.iter().enumerate() {
            let name = &described.name;
            for section in 0..described.sections.len() {
                let number = section + 1;
                let (key, part) = if described.sections.len() == 1 {
                    ("length".to_string(), String::new())
                } else {
                    (
                        format!("section{number}.length"),
                        format!(" of section {number}, counted from end A"),
                    )
                };
                self.push(
                    format!("{name}.{key}"),
                    format!("{name}: unstretched length{part}"),
                    Unit::METRE,
                    Parameter::SectionLength { line, section },
                );
            }
        }
    }

    fn push_globals(&mut self) {
        let rows = [
            (
                "water.density",
                "density of the water",
                Unit::KILOGRAM_PER_CUBIC_METRE,
                Parameter::WaterDensity,
            ),
            (
                "seabed.depth",
                "depth of the seabed below z = 0",
                Unit::METRE,
                Parameter::SeabedDepth,
            ),
            (
                "gravity",
                "gravitational acceleration",
                Unit::METRE_PER_SECOND_SQUARED,
                Parameter::Gravity,
            ),
            (
                "solver.tolerance",
                "target error of fairlead tension; sets integrator and steps where the scene leaves them open; elements stay those of the packaged scene",
                Unit::ONE,
                Parameter::Tolerance,
            ),
            (
                "solver.input_reconstruction",
                "path of a coupled point between communication points: 0 smooth, 1 constant velocity with a jump, 2 cubics through inputs that hold for the end of the step",
                Unit::ONE,
                Parameter::InputReconstruction,
            ),
        ];
        for (name, description, unit, parameter) in rows {
            self.push(name.to_string(), description.to_string(), unit, parameter);
        }
    }
}
