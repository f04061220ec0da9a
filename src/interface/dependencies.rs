//! Variables on which the static solution, and therefore every output during initialization, depends.
//!
//! Lines that share free points are one network. A network depends on the displacements of the coupled points at its ends and on the parameters of its
//! equilibrium. Velocities, rotary inertia and damping have no effect at rest. Drag has an effect in flowing water, and added mass in waves, whose load on
//! the last half segment is part of the end force from the start. The flow given by a host acts at that node. The closed-form catenary is that of
//! the reference configuration in still water, and so depends on no displacement. Mass and impedance of the mooring are those of the coming step, on
//! which every property has an effect.

use std::collections::{BTreeMap, BTreeSet};

use super::{Binding, Interface, LineResult, Parameter, Place, ProfileQuantity, Variable};
use crate::model::{Body, End, Line, Model};
use crate::scene::table::{Acts, Table};
use crate::scene::{LineType, Scene, Water};

/// Fills [`Variable::initial_dependencies`] of all outputs and calculated parameters.
pub(super) fn fill(variables: &mut [Variable], scene: &Scene, model: &Model) {
    let attached_to = |body: Body| -> Vec<usize> { attached(model, body).map(|(line, _)| line).collect() };
    let known = |(index, variable): (usize, &Variable)| {
        let moves = match variable.binding {
            Binding::Displacement { body, .. } => attached_to(body),
            Binding::LengthChange { .. } | Binding::Release { .. } | Binding::Parameter(_) => Vec::new(),
            _ => return None,
        };
        let (reference, binding) = (Interface::reference(index), variable.binding.clone());
        Some(Known {
            reference,
            binding,
            moves,
        })
    };
    let knowns: Vec<Known> = variables.iter().enumerate().filter_map(known).collect();
    let mut known_scopes: BTreeMap<(BTreeSet<usize>, Subject), Vec<u32>> = BTreeMap::new();
    for variable in &mut *variables {
        let (lines, subject) = match &variable.binding {
            Binding::EndForce { body, .. } => {
                (networks_of(model, attached_to(*body)), Subject::ForceOn(*body))
            }
            Binding::Interface { body, .. } => (networks_of(model, attached_to(*body)), Subject::Step),
            Binding::Line { line, result } if result.is_catenary() => {
                (BTreeSet::from([*line]), Subject::ClosedForm)
            }
            Binding::Line { line, .. } | Binding::Profile { line, .. } | Binding::FlowPlace { line, .. } => {
                (networks_of(model, [*line]), Subject::Lines)
            }
            _ => continue,
        };
        variable.initial_dependencies = known_scopes
            .entry((lines, subject))
            .or_insert_with_key(|(lines, subject)| {
                let scope = Scope {
                    scene,
                    model,
                    lines,
                    subject: *subject,
                };
                let of_scope = knowns.iter().filter(|known| scope.depends_on(known));
                of_scope.map(|known| known.reference).collect()
            })
            .clone();
    }
    add_flow(variables, model);
}

/// Adds the flow of the water given by a host. At rest it acts on the last half segment, whose load is part of the end force; in the coming step it
/// acts on whole networks.
fn add_flow(variables: &mut [Variable], model: &Model) {
    let flow = |(index, variable): (usize, &Variable)| match variable.binding {
        Binding::Flow {
            line,
            component,
            node,
        } => Some((Interface::reference(index), line, (component, node))),
        _ => None,
    };
    let flows: Vec<_> = variables.iter().enumerate().filter_map(flow).collect();
    let both = |line: usize| [End::A, End::B].map(|end| (line, Some(end)));
    for variable in variables {
        // ends of lines, or whole lines
        let reached: Vec<(usize, Option<End>)> = match variable.binding {
            Binding::EndForce { body, .. } => attached(model, body)
                .map(|(line, end)| (line, Some(end)))
                .collect(),
            Binding::Interface { body, quantity, .. } if quantity.is_of_a_step() => {
                let lines = networks_of(model, attached(model, body).map(|(line, _)| line));
                lines.into_iter().map(|line| (line, None)).collect()
            }
            Binding::Line { line, result } => match result {
                LineResult::TensionA => vec![(line, Some(End::A))],
                LineResult::TensionB => vec![(line, Some(End::B))],
                LineResult::TensionMax => both(line).into(),
                _ => continue,
            },
            Binding::Profile {
                line,
                quantity: ProfileQuantity::Tension,
                node,
            } => {
                let is_there = |end: End| node.is_none_or(|node| node == model.lines[line].end_node(end));
                let ends = both(line).into_iter();
                ends.filter(|(_, end)| end.is_some_and(is_there)).collect()
            }
            _ => continue,
        };
        let reaches = |line: usize, at: (usize, Option<usize>)| {
            let mut reached = reached.iter().filter(|(of, _)| *of == line);
            reached.any(|(_, end)| end.is_none_or(|end| acts_at(&model.lines[line], end, at)))
        };
        let known = flows.iter().filter(|(_, line, at)| reaches(*line, *at));
        let references = known.map(|(reference, ..)| reference);
        variable.initial_dependencies.extend(references);
    }
}

/// Returns whether a component of the flow at a node, or at all nodes, affects the force at an end of a line: the drag on a half node with linear load
/// depends on two velocities.
fn acts_at(line: &Line, end: End, (component, node): (usize, Option<usize>)) -> bool {
    let count = 1 + usize::from(component < 3 && line.linear_load[end as usize]);
    node.is_none_or(|node| node.abs_diff(line.end_node(end)) < count)
}

/// Lines with an end at a point of a body, each with that end.
fn attached(model: &Model, body: Body) -> impl Iterator<Item = (usize, End)> {
    let points = (0..model.points.len()).filter(move |&point| model.moves_with(point, body));
    points.flat_map(|point| model.points[point].attached.iter().copied())
}

impl Interface {
    /// Value references of the displacements and velocities of bodies on which an output of a step depends through the motion at its end.
    pub fn motions_of(&self, output: &Variable) -> Vec<u32> {
        let known = |index: usize| output.initial_dependencies.contains(&Interface::reference(index));
        let rows = || self.variables.iter().enumerate();
        let moved: BTreeSet<Body> = rows()
            .filter_map(|(index, row)| match row.binding {
                Binding::Displacement { body, .. } if known(index) => Some(body),
                _ => None,
            })
            .collect();
        let of_moved = |(index, row): (usize, &Variable)| match row.binding {
            Binding::Displacement { body, .. } | Binding::Velocity { body, .. } if moved.contains(&body) => {
                Some(Interface::reference(index))
            }
            _ => None,
        };
        rows().filter_map(of_moved).collect()
    }
}

/// All lines of the networks of the given lines.
fn networks_of(model: &Model, lines: impl IntoIterator<Item = usize>) -> BTreeSet<usize> {
    let networks = lines.into_iter().flat_map(|line| {
        let networks = model.networks.iter();
        networks.filter(move |network| network.lines.contains(&line))
    });
    networks
        .flat_map(|network| network.lines.iter().copied())
        .collect()
}

/// A variable that a host may set before the simulation starts.
struct Known {
    reference: u32,
    binding: Binding,
    /// Lines that end at the points that it moves.
    moves: Vec<usize>,
}

/// What a variable describes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Subject {
    /// The equilibrium of lines.
    Lines,
    /// The force on a body, with that of its own points.
    ForceOn(Body),
    /// The mass or the impedance of lines.
    Step,
    /// The closed form of a line.
    ClosedForm,
}

/// Lines on whose equilibrium or step a variable depends.
struct Scope<'a> {
    scene: &'a Scene,
    model: &'a Model,
    lines: &'a BTreeSet<usize>,
    subject: Subject,
}

impl Scope<'_> {
    fn is_closed_form(&self) -> bool {
        self.subject == Subject::ClosedForm
    }

    fn depends_on(&self, known: &Known) -> bool {
        match &known.binding {
            Binding::Displacement { .. } => {
                !self.is_closed_form() && known.moves.iter().any(|line| self.lines.contains(line))
            }
            Binding::LengthChange { line } => !self.is_closed_form() && self.lines.contains(line),
            Binding::Release { line } => self.subject == Subject::Step && self.lines.contains(line),
            Binding::Parameter(parameter) => self.depends_on_parameter(parameter),
            _ => false,
        }
    }

    fn depends_on_parameter(&self, Parameter { place, key }: &Parameter) -> bool {
        let scene = self.scene;
        match (place, *key) {
            (Place::LineType(name), key) => {
                self.types().any(|used| used == name) && self.depends_on_property(name, key)
            }
            (Place::Section { line, .. }, _) => self.lines.contains(line),
            (Place::Water | Place::Scene, _) if self.subject == Subject::Step => true,
            (Place::Water, _) => {
                self.types()
                    .any(|name| self.is_buoyant(name) || self.is_pushed(name))
                    || self
                        .points()
                        .any(|point| point.volume.is_some() || (self.flows() && point.drag_area.is_some()))
            }
            (Place::Seabed, _) => true,
            (Place::Scene, _) => {
                self.types().any(|name| scene.line_types[name].weight.is_none())
                    || self.emerges()
                    || self.is_in_waves()
                    || self
                        .points()
                        .any(|point| point.mass.is_some() || point.volume.is_some())
            }
            (Place::Solver, "tolerance") => {
                !self.is_closed_form()
                    && scene.solver.elements.is_none()
                    && self.lines.iter().any(|&line| scene.lines[line].is_open())
            }
            (Place::Solver, _) => false,
        }
    }

    fn depends_on_property(&self, name: &str, key: &str) -> bool {
        match (LineType::SCHEMA.key(key).map(|key| key.rule.acts), key) {
            _ if self.subject == Subject::Step => true,
            (Some(Acts::InMotion), _) => false,
            (Some(Acts::InFlow), _) => self.flows(),
            (Some(Acts::InAccelerations), _) => self.is_in_waves(),
            (_, "mass") => self.scene.line_types[name].weight.is_none(),
            (_, "diameter") => {
                self.is_buoyant(name)
                    || self.is_pushed(name)
                    || (self.scene.seabed.is_some() && !self.is_closed_form())
            }
            (_, "bending_stiffness" | "shear_stiffness" | "torsional_stiffness") => !self.is_closed_form(),
            _ => true,
        }
    }

    /// Returns whether buoyancy is subtracted from the weight of a line type, under water or where a line emerges.
    fn is_buoyant(&self, name: &str) -> bool {
        let line_type = &self.scene.line_types[name];
        self.scene.water.is_some()
            && line_type.diameter.is_some()
            && (line_type.weight.is_none() || self.emerges())
    }

    /// Returns whether the water moves; closed forms are for still water.
    fn flows(&self) -> bool {
        let water = self.scene.water.as_ref();
        !self.is_closed_form() && water.is_some_and(|water| water.current.is_some() || water.accelerates())
    }

    fn is_in_waves(&self) -> bool {
        let water = self.scene.water.as_ref();
        !self.is_closed_form() && water.is_some_and(Water::accelerates)
    }

    /// Returns whether moving water exerts a force on a line type.
    fn is_pushed(&self, name: &str) -> bool {
        self.flows() && self.scene.line_types[name].diameter.is_some()
    }

    /// Returns whether a line may come out of the water; in closed forms, no line does.
    fn emerges(&self) -> bool {
        let mut lines = self.lines.iter();
        !self.is_closed_form() && lines.any(|&line| self.model.lines[line].surface.is_some())
    }

    /// Line types that the lines use.
    fn types(&self) -> impl Iterator<Item = &str> {
        self.lines
            .iter()
            .flat_map(|&line| &self.scene.lines[line].sections)
            .map(|section| section.line_type.as_str())
    }

    /// Free points that the lines share, and the points of the body whose force is described.
    fn points(&self) -> impl Iterator<Item = &crate::scene::Point> {
        let networks = self.model.networks.iter().filter(|network| {
            let mut lines = network.lines.iter();
            !self.is_closed_form() && lines.any(|line| self.lines.contains(line))
        });
        let free = networks.flat_map(|network| &network.free_points).copied();
        let own = (0..self.model.points.len()).filter(|&point| match self.subject {
            Subject::ForceOn(body) => self.model.moves_with(point, body),
            _ => false,
        });
        free.chain(own).map(|point| &self.scene.points[point])
    }
}
