//! Communication steps in parts: between parts, an FMI 3.0 host reads outputs, sets inputs and may end the step.
//!
//! Source: FMI 3.0.2 section 4.2.2, intermediate update mode and early return. A step longer than the output interval of the scene is divided into
//! equal parts no longer than this interval. The host must have announced all displacements and paid-out lengths, the velocities that it gives, and
//! all flow inputs if there are any: otherwise, a body that it does not move between parts would be at rest there. A step is not divided if the
//! inputs refer to its end.

use moorline::interface::{Binding, Interface};
use moorline::scene::Reconstruction;

use super::{Instance, Outcome, Refusal};
use crate::saved::{Phase, Snapshot};

/// Rounding error accepted in a quotient of times [-].
const ROUNDING: f64 = 1e-6;
/// Maximum number of parts of a communication step [-].
const PARTS_MAX: f64 = 1e6;

/// Communication step made in parts.
pub(crate) struct Parts {
    start: f64,
    length: f64,
    count: u32,
    done: u32,
    /// State before the first part; `None` if there is only one part.
    before: Option<Box<Snapshot>>,
}

impl Parts {
    /// Returns the time at the end of the first `parts` parts [s].
    fn at(&self, parts: u32) -> f64 {
        self.start + self.length * (f64::from(parts) / f64::from(self.count))
    }

    /// Returns whether the whole step is made.
    pub(crate) fn are_done(&self) -> bool {
        self.done == self.count
    }
}

impl Instance {
    /// Records the variables that the host accesses within steps.
    pub(crate) fn announce(&mut self, references: &[u32]) {
        self.announced = references.to_vec();
    }

    /// Returns whether the host updates all inputs that change within a step.
    fn is_updated(&self) -> bool {
        let changes = |binding: &Binding| match *binding {
            Binding::Displacement { .. } | Binding::LengthChange { .. } | Binding::Flow { .. } => true,
            Binding::Velocity { body, axis } => self.inputs.given().body(body).velocity[axis].is_some(),
            _ => false,
        };
        let mut rows = self.interface.variables().iter().enumerate();
        !self.announced.is_empty()
            && rows.all(|(index, variable)| {
                !changes(&variable.binding) || self.announced.contains(&Interface::reference(index))
            })
    }

    /// Divides the communication step of `length` [s] that begins at `start` [s].
    ///
    /// # Errors
    /// Refused during an update by the host.
    pub(crate) fn divide(&self, start: f64, length: f64) -> Result<Parts, Refusal> {
        self.expect_no_update()?;
        let parts = (length / self.scene.output.interval - ROUNDING).ceil();
        let divides = parts > 1.0
            && self.phase == Phase::Step
            && self.scene.solver.input_reconstruction != Reconstruction::Interpolate
            && self.is_updated();
        let count = match divides {
            true if parts.is_finite() => parts.clamp(1.0, PARTS_MAX) as u32,
            _ => 1,
        };
        Ok(Parts {
            start,
            length,
            count,
            done: 0,
            before: (count > 1).then(|| Box::new(self.snapshot())),
        })
    }

    /// Makes the next part; an error restores the state before the first one. Between parts only the host's update is allowed.
    pub(crate) fn make_part(&mut self, parts: &mut Parts) -> Outcome {
        if parts.done > 0 {
            self.phase = Phase::Step;
        }
        let at = parts.at(parts.done);
        let step = match parts.count {
            1 => parts.length,
            _ => parts.at(parts.done + 1) - at,
        };
        let made = self.do_step(at, step);
        if let (Err(_), Some(before)) = (&made, &parts.before) {
            self.restore(before)?;
        }
        made?;
        parts.done += 1;
        if !parts.are_done() {
            self.phase = Phase::Intermediate;
        }
        Ok(())
    }

    /// Ends the host's update without another part.
    pub(crate) fn end_early(&mut self) -> Outcome {
        self.phase = Phase::Step;
        Ok(())
    }

    pub(crate) fn expect_no_update(&self) -> Outcome {
        match self.phase {
            Phase::Intermediate => Err("out of order: not allowed in the host's intermediate update".into()),
            _ => Ok(()),
        }
    }
}
