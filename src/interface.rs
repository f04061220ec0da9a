//! Table of a scene's inputs, outputs and parameters: names, units, roles and bindings.
//!
//! modelDescription.xml, the FMU's getters and setters, the CSV header and `moorline check` all read this table and therefore always agree. The value
//! reference of a variable is its position in the table, counted from 1.
//!
//! The table contains, in this order: inputs and forces of every coupled point and of every vessel, releases and winches, outputs of every line, the
//! solver's outputs, the calculated parameters, the parameters, the water flow if a host gives it, and the profiles if the scene requests them.

mod coupling;
mod dependencies;
mod derivatives;
mod flow;
mod host_inputs;
mod inputs;
mod parameters;
mod profile;
mod results;
mod rows;

use std::collections::BTreeSet;

use crate::model::{Body, Model};
use crate::scene::{Axis, PointKind, Scene, SceneError};
use crate::simulation::{Inputs, Simulation, reference_catenary};

pub use host_inputs::HostInputs;
pub use inputs::INPUT_MAX;
pub use parameters::{Parameter, Place};
pub use results::{LineResult, SolverResult};

/// Message for a value of an energy balance that the scene does not request.
const NO_BALANCE: &str = "the scene asks for no energy balance (`energy_balance` in [output])";

/// Reason why a variable has no value.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoValue {
    /// Undefined in this configuration, with the message.
    #[error("{0}")]
    Undefined(String),
    /// Not finite, with the message.
    #[error("{0}")]
    NotFinite(String),
}

impl From<NoValue> for String {
    fn from(reason: NoValue) -> String {
        reason.to_string()
    }
}

/// Role of a variable, named as in FMI.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Set by the host before every step.
    Input,
    /// Read by the host.
    Output,
    /// Follows from the parameters at initialization.
    CalculatedParameter,
    /// Settable by the host before the simulation starts.
    Parameter,
}

/// Times at which a variable may change, named as in FMI.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variability {
    /// Does not change after initialization.
    Fixed,
    /// Changes from step to step.
    Discrete,
    /// Changes with time.
    Continuous,
}

/// Type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Double precision.
    Float64,
    /// Integer.
    Int32,
    /// Truth value.
    Boolean,
}

/// A unit and its exponents in SI base units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unit {
    /// Name as written in the description.
    pub name: &'static str,
    /// Exponent of the kilogram.
    pub kg: i8,
    /// Exponent of the metre.
    pub m: i8,
    /// Exponent of the second.
    pub s: i8,
    /// Exponent of the radian.
    pub rad: i8,
}

/// Declares units: name in the crate, name in the description, exponents of kilogram, metre, second and radian.
macro_rules! units {
    ($($(#[doc = $doc:literal])+ $name:ident = $text:literal $kg:literal $m:literal $s:literal $rad:literal;)+) => {
        impl Unit {
            $($(#[doc = $doc])+
            pub(crate) const $name: Unit = Unit { name: $text, kg: $kg, m: $m, s: $s, rad: $rad };)+
            const ALL: &[Unit] = &[$(Unit::$name),+];
        }
    };
}

units! {
    /// Dimensionless.
    ONE = "1" 0 0 0 0;
    /// Metre.
    METRE = "m" 0 1 0 0;
    /// Second.
    SECOND = "s" 0 0 1 0;
    /// Metre per second.
    METRE_PER_SECOND = "m/s" 0 1 -1 0;
    /// Metre per second squared.
    METRE_PER_SECOND_SQUARED = "m/s2" 0 1 -2 0;
    /// Newton.
    NEWTON = "N" 1 1 -2 0;
    /// Newton per metre.
    NEWTON_PER_METRE = "N/m" 1 0 -2 0;
    /// One per metre.
    PER_METRE = "1/m" 0 -1 0 0;
    /// Newton metre.
    NEWTON_METRE = "N.m" 1 2 -2 0;
    /// Newton square metre.
    NEWTON_SQUARE_METRE = "N.m2" 1 3 -2 0;
    /// Kilogram.
    KILOGRAM = "kg" 1 0 0 0;
    /// Kilogram square metre.
    KILOGRAM_SQUARE_METRE = "kg.m2" 1 2 0 0;
    /// Newton second per metre.
    NEWTON_SECOND_PER_METRE = "N.s/m" 1 0 -1 0;
    /// Newton metre second.
    NEWTON_METRE_SECOND = "N.m.s" 1 2 -1 0;
    /// Newton second.
    NEWTON_SECOND = "N.s" 1 1 -1 0;
    /// Kilogram per metre.
    KILOGRAM_PER_METRE = "kg/m" 1 -1 0 0;
    /// Kilogram metre.
    KILOGRAM_METRE = "kg.m" 1 1 0 0;
    /// Kilogram per cubic metre.
    KILOGRAM_PER_CUBIC_METRE = "kg/m3" 1 -3 0 0;
    /// Joule.
    JOULE = "J" 1 2 -2 0;
    /// Watt.
    WATT = "W" 1 2 -3 0;
    /// Radian; hosts may show it in degrees.
    RADIAN = "rad" 0 0 0 1;
    /// Radian per second.
    RADIAN_PER_SECOND = "rad/s" 0 0 -1 1;
}

impl Unit {
    /// Returns the base units with non-zero exponents, and these exponents.
    pub(crate) fn exponents(&self) -> Vec<(&'static str, String)> {
        let exponents = [("kg", self.kg), ("m", self.m), ("s", self.s), ("rad", self.rad)];
        let present = exponents.into_iter().filter(|(_, exponent)| *exponent != 0);
        present
            .map(|(base, exponent)| (base, exponent.to_string()))
            .collect()
    }

    /// Returns the unit for a notation in a doc comment or the scene format, such as `N m²`; dimensionless if it is unknown.
    fn of_scene(text: &str) -> Unit {
        let name = text.replace(' ', ".").replace('²', "2").replace('³', "3");
        let found = Unit::ALL.iter().find(|unit| unit.name == name);
        *found.unwrap_or(&Unit::ONE)
    }
}

/// Quantity that a variable gets or sets. Points and lines are counted in the scene's order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Binding {
    /// Displacement of a coupled point or a vessel from its reference [m] or [rad].
    Displacement {
        /// The point or vessel.
        body: Body,
        /// Axis: x, y, z and of a vessel roll, pitch, yaw, 0 to 5.
        axis: usize,
    },
    /// Velocity of a coupled point or a vessel [m/s] or [rad/s].
    Velocity {
        /// The point or vessel.
        body: Body,
        /// Axis, 0 to 5.
        axis: usize,
    },
    /// Force of all lines on a coupled point or a vessel [N], and moment on a vessel [N m].
    EndForce {
        /// The point or vessel on which the lines pull.
        body: Body,
        /// Axis, 0 to 5.
        axis: usize,
    },
    /// A quantity for a host that solves for a body together with its mooring.
    Interface {
        /// The point or vessel.
        body: Body,
        /// The quantity.
        quantity: InterfaceQuantity,
        /// Axis of the force, 0 to 5.
        row: usize,
        /// Axis of the motion, 0 to 5; 0 for a force.
        column: usize,
    },
    /// Release of a line from a point.
    Release {
        /// The line.
        line: usize,
    },
    /// Length change of a line's winch [m].
    LengthChange {
        /// The line.
        line: usize,
    },
    /// Velocity [m/s] or acceleration [m/s²] of the water at a node of a line, or at all its nodes from end A to end B.
    Flow {
        /// The line.
        line: usize,
        /// Component of [`crate::simulation::FLOW_COMPONENTS`].
        component: usize,
        /// The node; all nodes if absent.
        node: Option<usize>,
    },
    /// Coordinate of the position for which the next flow must be given, at a node of a line or at all nodes from end A to end B [m].
    FlowPlace {
        /// The line.
        line: usize,
        /// Axis: x, y, z, 0 to 2.
        axis: usize,
        /// The node; all nodes if absent.
        node: Option<usize>,
    },
    /// A result of a line.
    Line {
        /// The line.
        line: usize,
        /// The result.
        result: LineResult,
    },
    /// A result of the solver.
    Solver(SolverResult),
    /// A parameter of the scene.
    Parameter(Parameter),
    /// One value of a line's profile for each node from end A to end B.
    Profile {
        /// The line.
        line: usize,
        /// The quantity at each node.
        quantity: ProfileQuantity,
        /// The only node, counted from 0; all nodes if absent.
        node: Option<usize>,
    },
}

/// Quantity for a host that solves for a body together with its mooring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InterfaceQuantity {
    /// Mass of the mooring's ends.
    Mass,
    /// Force at the end of the coming step for zero displacement, velocity and acceleration.
    Free,
    /// Force at the end of the coming step per velocity there, with the opposite sign.
    Damping,
    /// Force at the end of the coming step per displacement there, with the opposite sign.
    Stiffness,
    /// Quasi-static force per displacement, with the opposite sign.
    StaticStiffness,
}

impl InterfaceQuantity {
    /// Returns whether the quantity depends on the coming step.
    fn is_of_a_step(self) -> bool {
        !matches!(self, InterfaceQuantity::Mass | InterfaceQuantity::StaticStiffness)
    }
}

/// Quantity of a profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProfileQuantity {
    /// Position along a global axis [m].
    Position(Axis),
    /// Axial tension [N].
    Tension,
    /// Curvature [1/m].
    Curvature,
    /// Bending moment [N m].
    Moment,
}

/// Representation of profiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// As one scalar for each value (FMI 2.0, CSV).
    Scalars,
    /// As arrays (FMI 3.0).
    Arrays,
}

/// A row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name, with dots between its parts.
    pub name: String,
    /// Description in a sentence.
    pub description: String,
    /// Role.
    pub causality: Causality,
    /// Times at which it may change.
    pub variability: Variability,
    /// Type.
    pub kind: Kind,
    /// Unit.
    pub unit: Unit,
    /// Length of an array [-]; `None` is a scalar.
    pub dimension: Option<usize>,
    /// Value before the host sets one; inputs and parameters have one.
    pub start: Option<f64>,
    /// Least and greatest value, in its unit; `None` where only the type limits it.
    pub range: [Option<f64>; 2],
    /// Value references of the variables on which it depends during initialization; outputs and calculated parameters only. After initialization,
    /// outputs change only in a step and therefore do not depend on values set between two steps.
    pub initial_dependencies: Vec<u32>,
    /// Quantity that it gets or sets.
    pub binding: Binding,
}

impl Variable {
    /// Number of values [-].
    pub fn size(&self) -> usize {
        self.dimension.unwrap_or(1)
    }

    #[cold]
    fn not_finite(&self, value: f64, time: f64) -> NoValue {
        NoValue::NotFinite(format!(
            "{}: {value} at t = {time} s is no result; look at the inputs and the start time, or try a smaller solver.time_step_max",
            self.name
        ))
    }
}

/// The table.
#[derive(Debug, Clone, PartialEq)]
pub struct Interface {
    variables: Vec<Variable>,
    inputs: Inputs,
}

impl Interface {
    /// Builds the table of a scene.
    ///
    /// # Errors
    /// Two variables have the same name.
    pub fn new(scene: &Scene, model: &Model, layout: Layout) -> Result<Interface, SceneError> {
        let mut variables = Vec::new();
        for (index, point) in scene.points.iter().enumerate() {
            if point.kind == PointKind::Coupled && point.on.is_none() {
                rows::body(&mut variables, Body::Point(index), &point.name);
                coupling::push(&mut variables, scene, Body::Point(index), &point.name);
            }
        }
        for (index, vessel) in scene.vessels.iter().enumerate() {
            rows::body(&mut variables, Body::Vessel(index), &vessel.name);
            coupling::push(&mut variables, scene, Body::Vessel(index), &vessel.name);
        }
        for (index, line) in scene.lines.iter().enumerate() {
            rows::controls(&mut variables, index, line);
        }
        for (index, line) in scene.lines.iter().enumerate() {
            let bending = LineResult::OF_BENDING
                .iter()
                .filter(|_| model.lines[index].bends());
            let results = LineResult::OF_ALL.iter().chain(bending);
            variables.extend(results.map(|result| result.row(index, &line.name)));
        }
        variables.extend([SolverResult::Substeps, SolverResult::InputError].map(SolverResult::row));
        if scene.output.energy_balance {
            variables.extend([SolverResult::EnergyError, SolverResult::PowerResidual].map(SolverResult::row));
        }
        for (index, line) in model.lines.iter().enumerate() {
            if reference_catenary(model, line).is_some() {
                variables.extend(LineResult::OF_CATENARY.map(|result| result.row(index, &line.name)));
            }
        }
        variables.extend(parameters::variables(scene));
        flow::push(&mut variables, model, layout);
        if scene.output.profile.is_given() {
            profile::push(&mut variables, model, layout);
        }
        check_unique(&variables)?;
        dependencies::fill(&mut variables, scene, model);
        Ok(Interface {
            variables,
            inputs: Inputs::new(model),
        })
    }

    /// Inputs before the host sets any.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Refuses a model whose numbers of nodes differ from those of the table. Parameters may change these numbers.
    ///
    /// # Errors
    /// Names the first line whose number of nodes differs.
    pub fn check_nodes(&self, model: &Model) -> Result<(), String> {
        for variable in &self.variables {
            let (line, count, fits) = match variable.binding {
                Binding::Profile { line, node, .. } => {
                    let count = model.lines[line].nodes_max();
                    let fits = variable.dimension.is_none_or(|length| length == count);
                    (line, count, fits && node.is_none_or(|node| node < count))
                }
                Binding::Flow { line, .. } => {
                    let count = model.lines[line].flow_count(model);
                    (line, count, count == self.inputs.flow.node_count(line))
                }
                _ => continue,
            };
            if !fits {
                return Err(format!(
                    "with these parameters {} would have {count} nodes, which the interface cannot follow: \
                     give the sections of the line their number of elements in the scene",
                    model.lines[line].name
                ));
            }
        }
        Ok(())
    }

    /// Rows of the table, in order.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Value reference of the row at `index`.
    pub fn reference(index: usize) -> u32 {
        u32::try_from(index + 1).expect("a table of more than 4e9 rows does not fit in memory")
    }

    /// Row with this value reference.
    #[inline]
    pub fn variable(&self, reference: u32) -> Option<&Variable> {
        let index = usize::try_from(reference).ok()?.checked_sub(1)?;
        self.variables.get(index)
    }

    /// The outputs, in their order.
    pub fn outputs(&self) -> impl Iterator<Item = &Variable> {
        self.variables
            .iter()
            .filter(|variable| variable.causality == Causality::Output)
    }

    /// Writes the values of a variable other than a parameter to `values`, which has the length [`Variable::size`].
    ///
    /// # Errors
    /// The closed-form catenary of a line or the impedance of a body does not exist, or a value is not finite.
    pub fn read(variable: &Variable, simulation: &Simulation, values: &mut [f64]) -> Result<(), NoValue> {
        assert_eq!(values.len(), variable.size(), "one place for each value");
        match variable.binding {
            Binding::EndForce { body, axis } => values[0] = simulation.host_force(body)[axis],
            Binding::Interface {
                body,
                quantity,
                row,
                column,
            } => {
                let value = coupling::read(simulation, body, quantity, [row, column]);
                values[0] =
                    value.ok_or_else(|| NoValue::Undefined(coupling::missing(&variable.name, quantity)))?;
            }
            Binding::Line { line, result } => {
                let missing = || {
                    let problem = "the reference configuration has no closed-form catenary";
                    NoValue::Undefined(format!("{}: {problem}", variable.name))
                };
                values[0] = result.read(simulation, line).ok_or_else(missing)?;
            }
            Binding::FlowPlace { line, axis, node } => flow::read_place(simulation, line, axis, node, values),
            Binding::Solver(result) => {
                let missing = || NoValue::Undefined(NO_BALANCE.to_string());
                values[0] = result.read(simulation, 0).ok_or_else(missing)?;
            }
            Binding::Profile { line, quantity, node } => {
                profile::read(simulation, line, quantity, node, values)
            }
            _ => {
                let is_input = variable.read_input(simulation.inputs(), values);
                assert!(is_input, "a simulation has no parameters");
            }
        }
        match values.iter().find(|value| !value.is_finite()) {
            None => Ok(()),
            Some(value) => Err(variable.not_finite(*value, simulation.time())),
        }
    }
}

fn check_unique(variables: &[Variable]) -> Result<(), SceneError> {
    let mut seen = BTreeSet::new();
    for variable in variables {
        if !seen.insert(variable.name.as_str()) {
            return Err(SceneError::new(
                variable.name.clone(),
                "two variables of the interface would have this name: rename the point, line or line type that it starts with",
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::draft;

    /// Two-section line from a coupled point to a free point that hangs on another line, and a span between two coupled points.
    fn scene() -> Scene {
        let upper = [("wire", 5.0, None), ("rope", 4.0, Some(4))];
        draft(
            "seabed.depth = 50.0
            line_types.rope = { mass = 2.0, diameter = 0.05, axial_stiffness = 1.0e6 }
            line_types.wire = { weight = 3.0, diameter = 0.02, axial_stiffness = 1.0e7, damping_ratio = 0.1 }
            output.profile = true",
        )
        .fixed("anchor", [0.0; 3])
        .free("knot", [8.0, 0.0, -2.0])
        .coupled("left", [16.0, 0.0, 0.0])
        .coupled("right", [30.0, 0.0, 0.0])
        .line("lower", ["anchor", "knot"], "rope", 9.0, 4)
        .sections("upper", ["knot", "left"], &upper)
        .line("span", ["left", "right"], "wire", 15.0, 4)
        .scene()
    }

    fn interface_of(scene: &Scene, layout: Layout) -> Interface {
        Interface::new(scene, &Model::new(scene).unwrap(), layout).unwrap()
    }

    fn interface(layout: Layout) -> Interface {
        interface_of(&scene(), layout)
    }

    fn dependencies(interface: &Interface, name: &str) -> Vec<String> {
        let variables = interface.variables();
        let variable = variables.iter().find(|v| v.name == name).unwrap();
        let references = variable.initial_dependencies.iter();
        references
            .map(|reference| interface.variable(*reference).unwrap().name.clone())
            .collect()
    }

    #[test]
    fn a_value_reference_is_a_position_counted_from_one() {
        let interface = interface(Layout::Scalars);
        for (index, variable) in interface.variables().iter().enumerate() {
            let reference = Interface::reference(index);
            assert_eq!(interface.variable(reference), Some(variable));
        }
        assert_eq!(interface.variable(0), None);
        let count = interface.variables().len();
        assert_eq!(interface.variable(Interface::reference(count)), None);
    }

    #[test]
    fn a_line_depends_on_what_its_network_hangs_on_and_on_nothing_beyond_a_driven_point() {
        let interface = interface(Layout::Arrays);
        let upper = dependencies(&interface, "upper.tension_b");
        let names = "left.x rope.mass wire.weight lower.length upper.section1.length seabed.depth gravity solver.tolerance";
        for name in names.split(' ') {
            assert!(upper.iter().any(|known| known == name), "{name}");
        }
        for name in ["right.x", "left.vx", "span.length", "wire.damping_ratio"] {
            assert!(upper.iter().all(|known| known != name), "{name}");
        }
        let span = "left.x left.y left.z right.x right.y right.z \
                    wire.axial_stiffness wire.weight wire.diameter span.length seabed.depth";
        assert_eq!(dependencies(&interface, "span.tension_b").join(" "), span);
        let both = dependencies(&interface, "left.fx");
        for name in ["lower.length", "span.length", "right.z"] {
            assert!(both.iter().any(|known| known == name), "{name}");
        }
    }

    #[test]
    fn only_lines_with_held_ends_have_a_closed_form_catenary() {
        let interface = interface(Layout::Scalars);
        let has = |name: &str| interface.variables().iter().any(|v| v.name == name);
        assert!(has("span.catenary_sag") && !has("lower.catenary_sag") && !has("upper.catenary_sag"));
        assert!(!dependencies(&interface, "span.catenary_sag").contains(&"left.x".to_string()));
    }

    #[test]
    fn profiles_stand_last_and_move_no_other_variable() {
        let mut plain = scene();
        plain.output.profile = crate::scene::Profile::None;
        let without = interface_of(&plain, Layout::Scalars);
        for layout in [Layout::Scalars, Layout::Arrays] {
            let with = interface(layout);
            let count = without.variables().len();
            assert_eq!(with.variables()[..count], *without.variables());
            let profiles = &with.variables()[count..];
            let nodes = |line: &str| -> usize {
                profiles
                    .iter()
                    .filter(|v| v.name.starts_with(&format!("{line}.profile.z")))
                    .map(Variable::size)
                    .sum()
            };
            assert_eq!((nodes("lower"), nodes("span")), (5, 5));
        }
    }

    #[test]
    fn every_parameter_can_be_set_and_read_back() {
        let mut scene = scene();
        for variable in interface(Layout::Scalars).variables() {
            if let Binding::Parameter(parameter) = &variable.binding {
                let other = match variable.kind {
                    Kind::Int32 => 1.0,
                    _ => 1.5 * variable.start.unwrap(),
                };
                parameter.set(&mut scene, other).unwrap();
                assert_eq!(parameter.value(&scene), Some(other), "{}", variable.name);
            }
        }
        let choice = Parameter {
            place: Place::Solver,
            key: "input_reconstruction",
        };
        let message = choice.set(&mut scene, 0.5);
        assert!(message.unwrap_err().contains("neither"));
    }

    #[test]
    fn two_variables_of_one_name_are_a_clear_error() {
        let binding = Binding::Solver(SolverResult::Substeps);
        let one = rows::row("a.b".into(), String::new(), Causality::Output, Unit::ONE, binding);
        let error = check_unique(&[one.clone(), one]).unwrap_err();
        assert!(error.to_string().starts_with("a.b: two variables"), "{error}");
    }
}
