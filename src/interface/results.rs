//! Results of lines and of the solver. One entry contains the description of a result with its unit, its name and its value.

use super::{Binding, Causality, Unit, Variable, rows};
use crate::scene::table::{meaning, unit};
use crate::simulation::{NodeBending, Simulation};

/// Declares results: an enum, and for each variant the name of the variable and the function of a simulation and a line index that gives its
/// value. The doc comment of a variant is the description of the variable.
macro_rules! results {
    ($(#[doc = $about:literal])+ pub enum $name:ident {
        $($(#[doc = $doc:literal])+ $variant:ident = $label:literal => $read:expr,)+
    }) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl $name {
            /// Name of the variable and lines of its description.
            fn entry(self) -> (&'static str, &'static [&'static str]) {
                match self { $($name::$variant => ($label, &[$($doc),+]),)+ }
            }

            /// Value in the unit of the variable; `None` if there is none.
            pub(super) fn read(self, simulation: &Simulation, line: usize) -> Option<f64> {
                let read: fn(&Simulation, usize) -> Option<f64> = match self { $($name::$variant => $read,)+ };
                read(simulation, line)
            }
        }
    };
}

results! {
    /// Results of a line.
    pub enum LineResult {
        /// Magnitude of the line's force at end B [N], including weight, drag and inertia of the last half segment.
        TensionB = "tension_b" => |simulation, line| Some(simulation.tension_b(line)),
        /// Magnitude of the line's force at end A [N], including weight, drag and inertia of the first half segment.
        TensionA = "tension_a" => |simulation, line| Some(simulation.tension_a(line)),
        /// Greatest of the axial tension along the line and the forces at its ends [N].
        TensionMax = "tension_max" => |simulation, line| Some(simulation.tension_max(line)),
        /// Unstretched length that lies on the seabed [m].
        LaidLength = "laid_length" => |simulation, line| Some(simulation.laid_length(line)),
        /// Greatest vertical distance below the chord between the ends [m].
        Sag = "sag" => |simulation, line| Some(simulation.sag(line)),
        /// Greatest curvature along the line [1/m].
        CurvatureMax = "curvature_max" => |simulation, line| greatest(simulation, line, |node| node.curvature),
        /// Greatest bending moment along the line [N m].
        MomentMax = "moment_max" => |simulation, line| greatest(simulation, line, |node| node.moment),
        /// Bending moment at end A [N m].
        MomentA = "moment_a" => |simulation, line| moment(nodes(simulation, line).first()),
        /// Bending moment at end B [N m].
        MomentB = "moment_b" => |simulation, line| moment(nodes(simulation, line).last()),
        /// Sag [m] of the closed-form elastic catenary in the reference configuration.
        CatenarySag = "catenary_sag" => |simulation, line| Some(simulation.catenary(line)?.sag()),
        /// Horizontal tension [N] of the closed-form elastic catenary in the reference configuration.
        CatenaryHorizontal = "catenary_horizontal" => |simulation, line| Some(simulation.catenary(line)?.horizontal()),
        /// Tension at end B [N] of the closed-form elastic catenary in the reference configuration.
        CatenaryTensionB = "catenary_tension_b" => |simulation, line| Some(simulation.catenary(line)?.tension_b()),
    }
}

results! {
    /// Results of the solver.
    pub enum SolverResult {
        /// Internal steps of the last communication step [-].
        Substeps = "substeps" => |simulation, _| Some(simulation.substeps() as f64),
        /// Estimated error of tension [-], over its standard deviation, caused by the path between communication points.
        InputError = "input_error" => |simulation, _| Some(simulation.input_error()),
        /// Energy that the time integration has produced (positive) or lost since the start [J].
        EnergyError = "energy_error" => |simulation, _| simulation.energy_balance().map(|balance| balance.error()),
        /// Energy error divided by the time since the start [W].
        PowerResidual = "power_residual" => |simulation, _| simulation.power_residual(),
    }
}

/// Bending at the nodes of a line; empty if the host has set the bending stiffness to zero.
fn nodes(simulation: &Simulation, line: usize) -> &[NodeBending] {
    simulation.bending(line).unwrap_or_default()
}

fn greatest(simulation: &Simulation, line: usize, of: fn(&NodeBending) -> f64) -> Option<f64> {
    Some(nodes(simulation, line).iter().map(of).fold(0.0, f64::max))
}

fn moment(node: Option<&NodeBending>) -> Option<f64> {
    Some(node.map_or(0.0, |node| node.moment))
}

impl LineResult {
    /// Results of every line.
    pub(super) const OF_ALL: [LineResult; 5] = [
        LineResult::TensionB,
        LineResult::TensionA,
        LineResult::TensionMax,
        LineResult::LaidLength,
        LineResult::Sag,
    ];
    /// Results of lines that bend.
    pub(super) const OF_BENDING: [LineResult; 4] = [
        LineResult::CurvatureMax,
        LineResult::MomentMax,
        LineResult::MomentA,
        LineResult::MomentB,
    ];
    /// Results of the closed-form catenary.
    pub(super) const OF_CATENARY: [LineResult; 3] = [
        LineResult::CatenarySag,
        LineResult::CatenaryHorizontal,
        LineResult::CatenaryTensionB,
    ];

    /// Returns whether the result belongs to the closed-form catenary, which depends on parameters only.
    pub(super) fn is_catenary(self) -> bool {
        LineResult::OF_CATENARY.contains(&self)
    }

    /// Row of the result of a line.
    pub(super) fn row(self, line: usize, name: &str) -> Variable {
        let (label, doc) = self.entry();
        let causality = match self.is_catenary() {
            true => Causality::CalculatedParameter,
            false => Causality::Output,
        };
        let (label, meaning) = (format!("{name}.{label}"), format!("{name}: {}", meaning(doc)));
        let binding = Binding::Line { line, result: self };
        rows::row(label, meaning, causality, unit_of(doc), binding)
    }
}

impl SolverResult {
    /// Row of the result.
    pub(super) fn row(self) -> Variable {
        let (label, doc) = self.entry();
        let (label, binding) = (format!("solver.{label}"), Binding::Solver(self));
        rows::row(label, meaning(doc), Causality::Output, unit_of(doc), binding)
    }
}

fn unit_of(doc: &[&'static str]) -> Unit {
    unit(doc).map_or(Unit::ONE, Unit::of_scene)
}
