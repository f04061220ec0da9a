//! Access to the variables of an instance: the host reads results, and sets inputs and parameters.

use moorline::interface::{Binding, Causality, INPUT_MAX, Interface, Kind, Variable};
use moorline::scene::Note;

use super::{Instance, Outcome, Refusal};
use crate::saved::Phase;

impl Instance {
    /// Returns the table row of a value reference.
    pub(super) fn variable(interface: &Interface, reference: u32) -> Result<&Variable, Refusal> {
        interface
            .variable(reference)
            .ok_or_else(|| unknown(interface, reference))
    }

    /// Returns the table row of a value reference that the host accesses as `kind`.
    #[inline]
    fn typed(interface: &Interface, kind: Kind, reference: u32) -> Result<&Variable, Refusal> {
        match interface.variable(reference) {
            Some(variable) if variable.kind == kind => Ok(variable),
            Some(variable) => Err(wrong_type(variable, &format!("{kind:?}"))),
            None => Err(unknown(interface, reference)),
        }
    }

    /// Reads variables of one type. An array contributes all its values.
    pub(crate) fn get(&mut self, kind: Kind, references: &[u32], values: &mut [f64]) -> Outcome {
        if self.phase == Phase::Initialization && self.asks_for_results(references) {
            self.solve_statics()?;
        }
        let (count, mut rest) = (values.len(), values);
        for &reference in references {
            if Some(reference) == self.time_reference && kind == Kind::Float64 {
                let (own, others) = rest
                    .split_first_mut()
                    .ok_or_else(|| self.wrong_count(references, count))?;
                (*own, rest) = (self.time, others);
                continue;
            }
            let variable = Self::typed(&self.interface, kind, reference)?;
            let split = rest.split_at_mut_checked(variable.size());
            let (own, others) = split.ok_or_else(|| self.wrong_count(references, count))?;
            rest = others;
            self.read(variable, own)?;
        }
        match rest.is_empty() {
            true => Ok(()),
            false => Err(self.wrong_count(references, count)),
        }
    }

    /// Reads a variable; `values` has its size.
    fn read(&self, variable: &Variable, values: &mut [f64]) -> Outcome {
        match (&variable.binding, variable.causality) {
            (Binding::Parameter(parameter), _) => {
                let value = parameter.value(&self.scene);
                values[0] = value.expect("the table has only parameters of the scene");
            }
            (_, Causality::Input) => {
                self.inputs.read(variable, values);
            }
            _ => {
                let simulation = self.simulation.as_ref().ok_or_else(|| {
                    Refusal(format!(
                        "out of order: {} has a value from initialization mode on",
                        variable.name
                    ))
                })?;
                Interface::read(variable, simulation, values).map_err(String::from)?;
            }
        }
        Ok(())
    }

    /// Reads integers or truth values, each made of the number that stands for it.
    pub(crate) fn get_as<T>(
        &mut self,
        kind: Kind,
        references: &[u32],
        values: &mut [T],
        made: impl Fn(f64) -> T,
    ) -> Outcome {
        let mut numbers = vec![0.0; values.len()];
        self.get(kind, references, &mut numbers)?;
        for (value, number) in values.iter_mut().zip(numbers) {
            *value = made(number);
        }
        Ok(())
    }

    /// Sets integers or truth values by the numbers that stand for them.
    pub(crate) fn set_from(
        &mut self,
        kind: Kind,
        references: &[u32],
        numbers: impl Iterator<Item = f64>,
    ) -> Outcome {
        self.set(kind, references, &numbers.collect::<Vec<f64>>())
    }

    fn asks_for_results(&self, references: &[u32]) -> bool {
        references.iter().any(|&reference| {
            self.interface.variable(reference).is_some_and(|variable| {
                matches!(
                    variable.causality,
                    Causality::Output | Causality::CalculatedParameter
                )
            })
        })
    }

    /// Returns the refusal of an access with a wrong number of values.
    #[cold]
    fn wrong_count(&self, references: &[u32], count: usize) -> Refusal {
        let size = |&reference: &u32| self.interface.variable(reference).map_or(1, Variable::size);
        let size: usize = references.iter().map(size).sum();
        Refusal(format!(
            "{} variables have {size} values, but the host gave room for {count}",
            references.len()
        ))
    }

    /// Refuses access by a type that none of the variables has.
    pub(crate) fn refuse_type(&self, kind: &str, references: &[u32]) -> Outcome {
        match references.first() {
            None => Ok(()),
            Some(&reference) => Err(wrong_type(Self::variable(&self.interface, reference)?, kind)),
        }
    }

    /// Sets variables of one type: all of them, or none if one is refused.
    pub(crate) fn set(&mut self, kind: Kind, references: &[u32], values: &[f64]) -> Outcome {
        if self.time_reference.is_some_and(|time| references.contains(&time)) {
            return Err("time is not to be set".into());
        }
        let (count, mut rest) = (values.len(), values);
        let mut has_parameters = false;
        for &reference in references {
            let variable = Self::typed(&self.interface, kind, reference)?;
            let split = rest.split_at_checked(variable.size());
            let (own, others) = split.ok_or_else(|| self.wrong_count(references, count))?;
            for &value in own {
                self.check_settable(variable, value)?;
            }
            rest = others;
            has_parameters |= variable.causality == Causality::Parameter;
        }
        if !rest.is_empty() {
            return Err(self.wrong_count(references, count));
        }
        if has_parameters {
            self.set_parameters(references, values)?;
        }
        self.set_inputs(references, values)
    }

    /// Sets the parameters among the given variables.
    fn set_parameters(&mut self, references: &[u32], values: &[f64]) -> Outcome {
        let mut scene = self.scene.clone();
        for (variable, own) in with_values(&self.interface, references, values) {
            if let Binding::Parameter(parameter) = &variable.binding {
                let set = parameter.set(&mut scene, own[0]);
                set.map_err(|problem| format!("{}: {problem}", variable.name))?;
            }
        }
        // the model is built once, when results are needed, however many calls set parameters
        scene.check().map_err(|e| e.to_string())?;
        self.scene = scene;
        self.simulation = None;
        Ok(())
    }

    /// Sets the inputs among the given variables; inputs that change the equilibrium invalidate the statics during initialization.
    fn set_inputs(&mut self, references: &[u32], values: &[f64]) -> Outcome {
        let steps = matches!(self.phase, Phase::Step | Phase::Intermediate);
        for (variable, own) in with_values(&self.interface, references, values) {
            self.inputs.write(variable, own, steps);
            let acts_at_start = matches!(
                variable.binding,
                Binding::Displacement { .. }
                    | Binding::LengthChange { .. }
                    | Binding::Flow { .. }
                    | Binding::Release { .. }
            );
            if acts_at_start && self.phase == Phase::Initialization {
                self.simulation = None;
            }
        }
        Ok(())
    }

    /// Refuses a value out of range, or a variable that cannot be set in this phase.
    #[inline]
    fn check_settable(&self, variable: &Variable, value: f64) -> Outcome {
        let is_in_range = match (variable.causality, self.phase) {
            (Causality::Input, phase) if phase != Phase::Terminated => value.abs() <= INPUT_MAX,
            (Causality::Parameter, Phase::Instantiated | Phase::Initialization) => value.is_finite(),
            _ => false,
        };
        match is_in_range {
            true => Ok(()),
            false => Err(self.not_settable(variable, value)),
        }
    }

    #[cold]
    fn not_settable(&self, variable: &Variable, value: f64) -> Refusal {
        let allowed: &[Phase] = match variable.causality {
            Causality::Input => &[
                Phase::Instantiated,
                Phase::Initialization,
                Phase::Step,
                Phase::Intermediate,
            ],
            Causality::Parameter => &[Phase::Instantiated, Phase::Initialization],
            Causality::Output | Causality::CalculatedParameter => &[],
        };
        let problem = match self.expect_phase(allowed) {
            _ if allowed.is_empty() => "an output or calculated parameter is not to be set".to_string(),
            Err(Refusal(phase)) => phase,
            Ok(()) if !value.is_finite() => format!("{value} is not a finite number; nothing was set"),
            Ok(()) => format!("{value} is beyond {INPUT_MAX:e}; nothing was set"),
        };
        Refusal(format!("{}: {problem}", variable.name))
    }

    /// Sets time derivatives of inputs (FMI 2.0). The first derivative of a displacement is its velocity. Derivatives of velocities are accepted but
    /// not used, since the path through the communication points defines the acceleration. Derivatives of the water flow are not used either, since its
    /// accelerations are inputs.
    pub(crate) fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Outcome {
        self.expect_phase(&[Phase::Instantiated, Phase::Initialization, Phase::Step])?;
        if references.len() != values.len() {
            return Err(self.wrong_count(references, values.len()));
        }
        let (mut targets, mut unused) = (Vec::with_capacity(references.len()), Vec::new());
        for ((&reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = Self::typed(&self.interface, Kind::Float64, reference)?;
            let named = |problem: String| Refusal(format!("{}: {problem}", variable.name));
            if variable.causality != Causality::Input {
                return Err(named("only inputs have derivatives to set".into()));
            }
            if order != 1 {
                return Err(named(format!(
                    "derivatives of order {order} are not used: order 1 would be right"
                )));
            }
            self.check_settable(variable, value)?;
            match variable.binding {
                // The rates of roll, pitch and yaw are not the angular velocity, which the path through the poses defines.
                Binding::Displacement { body, axis } if axis < 3 => targets.push((body, axis, value)),
                Binding::Displacement { .. } | Binding::LengthChange { .. } => {
                    unused.push(variable.name.clone());
                }
                _ => {}
            }
        }
        for (body, axis, value) in targets {
            self.inputs.write_velocity(body, axis, value, true);
        }
        for name in unused {
            let text =
                "its time derivative is not used, since the path through the communication points defines it";
            self.warn_once(Note::new(name, text));
        }
        Ok(())
    }
}

/// Pairs variables with their values; the caller has checked both counts.
fn with_values<'a>(
    interface: &'a Interface,
    references: &'a [u32],
    values: &'a [f64],
) -> impl Iterator<Item = (&'a Variable, &'a [f64])> {
    let mut rest = values;
    references.iter().map(move |&reference| {
        let variable = interface.variable(reference).expect("checked before");
        let (own, others) = rest.split_at(variable.size());
        rest = others;
        (variable, own)
    })
}

/// Returns the refusal of a value reference that no variable has.
#[cold]
fn unknown(interface: &Interface, reference: u32) -> Refusal {
    Refusal(format!(
        "no variable has the value reference {reference}: 1 to {} would be right",
        interface.variables().len()
    ))
}

#[cold]
fn wrong_type(variable: &Variable, asked: &str) -> Refusal {
    Refusal(format!(
        "{} is of type {:?}, not {asked}",
        variable.name, variable.kind
    ))
}
