//! Nodes of lines: positions, tensions and force contributions. Lines count from 0 in the deck's order, nodes from 0 at end A.

use moorline::dynamics::reaction;
use moorline::elements::shear;
use moorline::model::{End, Line, LineState, Model, WaterAlong};
use moorline::physics::morison;
use moorline::simulation::Simulation;
use nalgebra::Vector3;

use crate::failure::{Failure, Outcome};
use crate::objects::{node_mass, row, rows, tangent};
use crate::system::System;

/// Vector quantity of a node, in global axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Position [m].
    Position,
    /// Velocity [m/s].
    Velocity,
    /// Sum of all forces on the node except inertia [N].
    Force,
    /// Tension, towards end B [N].
    Tension,
    /// Bending force [N].
    Bending,
    /// Weight less buoyancy [N].
    Weight,
    /// Drag [N].
    Drag,
    /// Force of the accelerated water, added mass included [N].
    FroudeKrylov,
    /// Seabed force [N].
    Seabed,
    /// Velocity of the water [m/s].
    Water,
}

/// View of a line of a simulation: its model, state and water.
struct View<'a> {
    simulation: &'a Simulation,
    model: &'a Model,
    line: &'a Line,
    state: &'a LineState,
    water: WaterAlong<'a>,
}

impl<'a> View<'a> {
    fn new(simulation: &'a Simulation, index: usize) -> View<'a> {
        let (model, state) = (simulation.model(), simulation.state());
        View {
            simulation,
            model,
            line: &model.lines[index],
            state: &state.lines[index],
            water: model.water_along(state, index, state.time),
        }
    }

    fn last(&self) -> usize {
        self.line.segment_count()
    }

    /// Tension of a segment, damping included, along its direction from A to B [N].
    fn pull(&self, segment: usize) -> Vector3<f64> {
        let chord = self.state.position[segment + 1] - self.state.position[segment];
        let size = reaction::tension(self.line, self.state, segment, self.model.solver.negative_tension);
        size * chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
    }

    /// Nodal tension [N]: the tension of the segment at an end node, otherwise the mean of the two adjacent segments.
    fn tension(&self, node: usize) -> Vector3<f64> {
        match node {
            0 => self.pull(0),
            node if node == self.last() => self.pull(node - 1),
            node => 0.5 * (self.pull(node - 1) + self.pull(node)),
        }
    }

    /// Shear force of a segment on its node towards end B [N], with the clamp at the nearer line end.
    fn shear(&self, segment: usize) -> Vector3<f64> {
        if self.line.bending.is_none() {
            return Vector3::zeros();
        }
        let points = &self.simulation.state().points;
        let [a, b] = self.line.ends.map(|point| &points[point]);
        let nodes = [&*self.state.position, &*self.state.velocity];
        let time = self.simulation.state().time;
        let moments = self.model.end_moments(self.line, time);
        match 2 * segment < self.last() {
            true => -shear(self.line, nodes, segment, (End::A, a), moments),
            false => shear(self.line, nodes, segment, (End::B, b), moments),
        }
    }

    fn bending(&self, node: usize) -> Vector3<f64> {
        let before = (node > 0).then(|| self.shear(node - 1));
        let after = (node < self.last()).then(|| self.shear(node));
        before.unwrap_or_default() - after.unwrap_or_default()
    }

    fn dry(&self, node: usize) -> moorline::model::Dry {
        let surface = self.line.surface.as_ref();
        surface.map_or_else(Default::default, |surface| {
            surface.node_in(self.water, node, &self.state.position)
        })
    }

    fn weight(&self, node: usize) -> Vector3<f64> {
        -(self.line.nodes.weight[node] + self.dry(node).weight) * Vector3::z()
    }

    fn drag(&self, node: usize) -> Vector3<f64> {
        let Some(drag) = &self.line.nodes.drag else {
            return Vector3::zeros();
        };
        let flow = self.water.velocity(node, self.state.position[node].z);
        let wet = drag.at(node).times(1.0 - self.dry(node).part);
        let along = tangent(self.line, &self.state.position, node);
        morison::drag(wet, self.state.velocity[node] - flow, along)
    }

    fn froude_krylov(&self, node: usize) -> Vector3<f64> {
        let (Some(mass), Some(waves)) = (&self.line.nodes.froude_krylov, &self.water.waves) else {
            return Vector3::zeros();
        };
        let along = tangent(self.line, &self.state.position, node);
        (1.0 - self.dry(node).part) * mass.force(node, waves.at(node).acceleration, along)
    }

    fn seabed(&self, node: usize) -> Vector3<f64> {
        let contact = self.line.nodes.contact.as_ref();
        contact.map_or_else(Vector3::zeros, |contact| {
            contact.push(node, &self.state.position, |i| self.state.velocity[i])
        })
    }

    /// Sum of all forces on a node except inertia [N].
    fn force(&self, node: usize) -> Vector3<f64> {
        let before = (node > 0).then(|| self.pull(node - 1));
        let after = (node < self.last()).then(|| self.pull(node));
        let pulls = after.unwrap_or_default() - before.unwrap_or_default();
        let loads = [
            self.bending(node),
            self.weight(node),
            self.drag(node),
            self.froude_krylov(node),
            self.seabed(node),
        ];
        loads.iter().fold(pulls, |sum, load| sum + load)
    }

    fn vector(&self, node: usize, quantity: Quantity) -> Vector3<f64> {
        match quantity {
            Quantity::Position => self.state.position[node],
            Quantity::Velocity => self.state.velocity[node],
            Quantity::Force => self.force(node),
            Quantity::Tension => self.tension(node),
            Quantity::Bending => self.bending(node),
            Quantity::Weight => self.weight(node),
            Quantity::Drag => self.drag(node),
            Quantity::FroudeKrylov => self.froude_krylov(node),
            Quantity::Seabed => self.seabed(node),
            Quantity::Water => self.water.velocity(node, self.state.position[node].z),
        }
    }
}

/// Returns a quantity of a node of a line [m, m/s, N].
pub fn vector(simulation: &Simulation, line: usize, node: usize, quantity: Quantity) -> [f64; 3] {
    View::new(simulation, line).vector(node, quantity).into()
}

/// Returns the tension of a segment without its damping [N], the strain [-] and the strain rate [1/s]; `None` for a viscoelastic line.
pub fn stretch(simulation: &Simulation, line: usize, segment: usize) -> Option<[f64; 3]> {
    let view = View::new(simulation, line);
    if view.line.segments.viscoelastic.is_some() {
        return None;
    }
    let [from, to] = [segment, segment + 1].map(|node| view.state.position[node]);
    let [slow, fast] = [segment, segment + 1].map(|node| view.state.velocity[node]);
    let (chord, length) = (to - from, view.line.segments.length[segment]);
    let along = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let strain = chord.norm() / length - 1.0;
    let rate = (fast - slow).dot(&along) / length;
    Some([view.line.spring(segment, strain).tension, strain, rate])
}

/// Returns the damping force of a segment along its direction from A to B [N]; `None` for a viscoelastic line.
pub fn damping(simulation: &Simulation, line: usize, segment: usize) -> Option<[f64; 3]> {
    let [spring, ..] = stretch(simulation, line, segment)?;
    let view = View::new(simulation, line);
    let pull = view.pull(segment);
    let chord = view.state.position[segment + 1] - view.state.position[segment];
    let along = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    Some((pull - spring * along).into())
}

impl System {
    fn view(&self, line: usize) -> Outcome<View<'_>> {
        self.line(line)?;
        Ok(View::new(self.simulation()?, line))
    }

    fn view_of_node(&self, line: usize, node: usize) -> Outcome<View<'_>> {
        let view = self.view(line)?;
        match node > view.last() {
            true => Err(Failure::value(format!(
                "line {} has no node {node}: its nodes are 0 to {}",
                line + 1,
                view.last()
            ))),
            false => Ok(view),
        }
    }

    /// Returns a line's row.
    ///
    /// # Errors
    /// No such line.
    pub fn line(&self, line: usize) -> Outcome<&moorline_decks::LineRow> {
        row(&self.deck.lists.lines, line, "line")
    }

    /// Returns a quantity of a node of a line [m, m/s, N].
    ///
    /// # Errors
    /// No such line or node, or the system was not started.
    pub fn node_vector(&self, line: usize, node: usize, quantity: Quantity) -> Outcome<[f64; 3]> {
        let view = self.view_of_node(line, node)?;
        Ok(view.vector(node, quantity).into())
    }

    /// Returns the curvature of a line at a node [1/m]; 0 if the line has no bending stiffness.
    ///
    /// # Errors
    /// As [`System::node_vector`].
    pub fn node_curvature(&self, line: usize, node: usize) -> Outcome<f64> {
        let view = self.view_of_node(line, node)?;
        let bending = view.simulation.bending(line);
        Ok(bending.map_or(0.0, |nodes| nodes[node].curvature))
    }

    /// Returns the mass matrix of a node, added mass included, row by row [kg].
    ///
    /// # Errors
    /// As [`System::node_vector`].
    pub fn node_mass(&self, line: usize, node: usize) -> Outcome<[[f64; 3]; 3]> {
        let view = self.view_of_node(line, node)?;
        Ok(rows(&node_mass(view.model, view.simulation, (line, node))))
    }

    /// Returns the tension of the last segment, at end B [N].
    ///
    /// # Errors
    /// No such line, or the system was not started.
    pub fn fairlead_tension(&self, line: usize) -> Outcome<f64> {
        let view = self.view(line)?;
        Ok(view.tension(view.last()).norm())
    }

    /// Returns the greatest nodal tension of a line [N].
    ///
    /// # Errors
    /// As [`System::fairlead_tension`].
    pub fn greatest_tension(&self, line: usize) -> Outcome<f64> {
        let view = self.view(line)?;
        Ok((0..=view.last())
            .map(|node| view.tension(node).norm())
            .fold(0.0, f64::max))
    }

    /// Returns the horizontal and vertical forces [N] at the fairlead and at the anchor of a line, as in OpenFAST's first interface: the forces on
    /// the end nodes; the vertical one includes the weight of the nodal mass with its added mass.
    ///
    /// # Errors
    /// As [`System::fairlead_tension`].
    pub fn end_tensions(&self, line: usize) -> Outcome<[f64; 4]> {
        let view = self.view(line)?;
        let at = |node: usize| {
            let force = view.force(node);
            let mass = node_mass(view.model, view.simulation, (line, node))[(0, 0)];
            [force.x.hypot(force.y), force.z - mass * view.model.gravity]
        };
        let ([fair_h, fair_v], [anchor_h, anchor_v]) = (at(view.last()), at(0));
        Ok([fair_h, fair_v, anchor_h, anchor_v])
    }
}
