//! Rows of the results of a run: inputs from the scene's motion, outputs, wave elevation, channels.

use super::channels::Channels;
use super::record::{Column, ELEVATION, Form};
use crate::interface::{Binding, Causality, Interface, Kind, Layout, Variable};
use crate::model::{Body, Model, Moving};
use crate::scene::{Scene, SceneError};
use crate::simulation::Simulation;

/// Results of a run, row by row: time, variables of the interface, then channels.
#[derive(Debug, Clone)]
pub struct Recorder {
    variables: Vec<Variable>,
    channels: Channels,
    /// False if inputs and wave elevation are omitted.
    has_inputs: bool,
    columns: Vec<Column>,
    row: Vec<f64>,
}

impl Recorder {
    /// Creates the columns of a scene's runs.
    ///
    /// # Errors
    /// A name or a channel cannot be a column.
    pub fn new(scene: &Scene, model: &Model) -> Result<Recorder, SceneError> {
        Recorder::of(scene, model, true)
    }

    /// Creates only the columns determined by the lines: outputs and channels, without inputs and wave elevation.
    ///
    /// # Errors
    /// As [`Recorder::new`].
    pub fn of_outputs(scene: &Scene, model: &Model) -> Result<Recorder, SceneError> {
        Recorder::of(scene, model, false)
    }

    fn of(scene: &Scene, model: &Model, has_inputs: bool) -> Result<Recorder, SceneError> {
        let interface = Interface::new(scene, model, Layout::Scalars)?;
        let is_kept = |variable: &&Variable| has_inputs || variable.causality == Causality::Output;
        let variables: Vec<Variable> = recorded(&interface).filter(is_kept).cloned().collect();
        let channels = Channels::new(scene, model)?;
        let mut all = vec![Column::time()];
        all.extend(columns(&variables));
        let elevation = "elevation of the surface at x = y = 0";
        let waves = model.waves.as_ref().filter(|_| has_inputs);
        all.extend(waves.map(|_| Column::new(ELEVATION, "m", elevation, Form::Real)));
        all.extend(channels.columns());
        Ok(Recorder {
            variables,
            channels,
            has_inputs,
            columns: all,
            row: Vec::new(),
        })
    }

    /// Columns, time first.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Returns the row of the time [s] and the values then, each in its column's unit.
    ///
    /// # Errors
    /// A value that is not finite: the time, the column and a remedy.
    pub fn row(&mut self, simulation: &Simulation, time: f64) -> Result<&[f64], String> {
        let (row, model) = (&mut self.row, simulation.model());
        row.clear();
        row.push(time);
        let moving = match self.has_inputs {
            true => model.moving(time),
            false => Vec::new(),
        };
        for variable in &self.variables {
            row.push(match input_of(variable, model, &moving, time) {
                Some(input) => input,
                None => output_of(variable, simulation),
            });
        }
        let waves = model.waves.as_ref().filter(|_| self.has_inputs);
        row.extend(waves.map(|waves| waves.elevation(0.0, 0.0, time)));
        row.extend(self.channels.values(simulation));
        let mut values = self.columns.iter().zip(&self.row);
        let is_result =
            |column: &Column, value: f64| value.is_finite() || value.is_nan() && column.form == Form::Sparse;
        match values.find(|(column, value)| !is_result(column, **value)) {
            None => Ok(&self.row),
            Some((column, value)) => Err(format!(
                "at t = {time} s, {}: {value} {} is no result; try a smaller solver.time_step_max, and look at the motion",
                column.name, column.unit
            )),
        }
    }
}

/// Inputs and outputs, without values at nodes: profiles have a separate file, and no host gives a flow in a run.
pub fn recorded(interface: &Interface) -> impl Iterator<Item = &Variable> {
    interface.variables().iter().filter(|variable| {
        matches!(variable.causality, Causality::Input | Causality::Output)
            && !matches!(
                variable.binding,
                Binding::Profile { .. } | Binding::Flow { .. } | Binding::FlowPlace { .. }
            )
    })
}

/// Columns of these variables.
pub fn columns<'v>(variables: impl IntoIterator<Item = &'v Variable>) -> Vec<Column> {
    let column = |variable: &Variable| {
        let form = match (variable.kind, &variable.binding) {
            (Kind::Float64, Binding::Interface { .. }) => Form::Sparse,
            (Kind::Float64, _) => Form::Real,
            (Kind::Int32 | Kind::Boolean, _) => Form::Whole,
        };
        let (unit, description) = (variable.unit.name, variable.description.as_str());
        Column::new(&variable.name, unit, description, form)
    };
    variables.into_iter().map(column).collect()
}

/// Present value of an output, in its unit.
fn output_of(variable: &Variable, simulation: &Simulation) -> f64 {
    let mut value = [f64::NAN];
    // an output without a value remains non-finite in the row, and the table marks it
    let _ = Interface::read(variable, simulation, &mut value);
    value[0]
}

/// Value of an input at `time` [s] of the scene's motion, in its unit, given the `moving` bodies at this time; `None` for an output.
pub fn input_of(variable: &Variable, model: &Model, moving: &[Moving], time: f64) -> Option<f64> {
    let of = |body: Body, part: fn(&Moving) -> [f64; 6], axis: usize| {
        let found = moving.iter().find(|moving| moving.body == body);
        Some(found.map_or(0.0, |moving| part(moving)[axis]))
    };
    match variable.binding {
        Binding::Displacement { body, axis } => of(body, |moving| moving.pose, axis),
        Binding::Velocity { body, axis } => of(body, |moving| moving.velocity, axis),
        Binding::LengthChange { line } => {
            let winch = model.lines[line].winch.as_ref();
            let path = winch.and_then(|winch| winch.path.as_ref());
            Some(path.map_or(0.0, |path| path.at(time)))
        }
        _ => None,
    }
}
