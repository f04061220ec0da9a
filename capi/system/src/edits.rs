//! Changes of lines by the host: properties before the start, detachment at any time.

use moorline::dynamics::Choice;
use moorline::simulation::Simulation;

use crate::failure::{Code, Failure, Outcome};
use crate::system::{Start, System};

/// Names of time schemes without their order numbers.
const SCHEMES: [&str; 11] = [
    "Euler", "LEuler", "Heun", "RK", "AB", "LAB", "BEuler", "Midpoint", "ACA", "Wilson", "LRK",
];

impl System {
    fn check_not_started(&self, what: &str) -> Outcome {
        match self.simulation {
            None => Ok(()),
            Some(_) => Err(Failure::missing(format!(
                "{what} of a line in motion is not changed: set it between Create and Init"
            ))),
        }
    }

    /// Returns the unstretched length of a line [m].
    ///
    /// # Errors
    /// No such line.
    pub fn unstretched_length(&self, line: usize) -> Outcome<f64> {
        self.line(line)?;
        let sections = self.deck.scene.lines[line].sections.iter();
        Ok(sections.map(|section| section.length).sum())
    }

    /// Sets the unstretched length of a line [m]; only before the start.
    ///
    /// # Errors
    /// No such line, a length that is not positive, or the system was started.
    pub fn set_unstretched_length(&mut self, line: usize, length: f64) -> Outcome {
        let present = self.unstretched_length(line)?;
        if !(length.is_finite() && length > 0.0) {
            return Err(Failure::value(format!("the length {length} m is not positive")));
        }
        if length == present {
            return Ok(());
        }
        self.check_not_started("the length")?;
        match self.deck.scene.lines[line].sections.as_mut_slice() {
            [section] => section.length = length,
            sections => sections
                .iter_mut()
                .for_each(|section| section.length *= length / present),
        }
        Ok(())
    }

    /// Returns whether a line has a constant axial stiffness.
    ///
    /// # Errors
    /// No such line.
    pub fn has_constant_stiffness(&self, line: usize) -> Outcome<bool> {
        Ok(self.stiffness(line)?.is_some())
    }

    fn stiffness(&self, line: usize) -> Outcome<Option<f64>> {
        self.line(line)?;
        let section = &self.deck.scene.lines[line].sections[0];
        let line_type = &self.deck.scene.line_types[&section.line_type];
        Ok(line_type
            .axial_stiffness
            .filter(|_| line_type.tension_strain.is_none()))
    }

    /// Returns the axial stiffness EA of a line [N].
    ///
    /// # Errors
    /// No such line, or one whose stiffness is not constant.
    pub fn constant_stiffness(&self, line: usize) -> Outcome<f64> {
        let none = || Failure::value(format!("the stiffness of line {} is not constant", line + 1));
        self.stiffness(line)?.ok_or_else(none)
    }

    /// Sets the axial stiffness EA of a line [N]; only before the start.
    ///
    /// # Errors
    /// As [`System::constant_stiffness`], a stiffness that is not positive, or the system was started.
    pub fn set_constant_stiffness(&mut self, line: usize, stiffness: f64) -> Outcome {
        let present = self.constant_stiffness(line)?;
        if !(stiffness.is_finite() && stiffness > 0.0) {
            return Err(Failure::value(format!(
                "the stiffness {stiffness} N is not positive"
            )));
        }
        if stiffness == present {
            return Ok(());
        }
        self.check_not_started("the stiffness")?;
        let scene = &mut self.deck.scene;
        let section = &mut scene.lines[line].sections[0];
        let mut line_type = scene.line_types[&section.line_type].clone();
        line_type.axial_stiffness = Some(stiffness);
        let names = (0..).map(|number| format!("line{}_{number}", line + 1));
        let mut free = names.filter(|name| !scene.line_types.contains_key(name));
        section.line_type = free.next().unwrap_or_default();
        scene.line_types.insert(section.line_type.clone(), line_type);
        Ok(())
    }

    /// Sets an upper limit on the internal time step [s]; it takes effect at the next start.
    ///
    /// # Errors
    /// A step that is not positive.
    pub fn set_dt(&mut self, dt: f64) -> Outcome {
        if !(dt.is_finite() && dt > 0.0) {
            return Err(Failure::value(format!("the time step {dt} s is not positive")));
        }
        self.dt = dt;
        self.deck.scene.solver.time_step_max = dt.min(1e4);
        Ok(())
    }

    /// Stores a Courant number [-]; it has no effect.
    ///
    /// # Errors
    /// A number that is not positive.
    pub fn set_cfl(&mut self, cfl: f64) -> Outcome {
        if !(cfl.is_finite() && cfl > 0.0) {
            return Err(Failure::value(format!(
                "the Courant number {cfl} is not positive"
            )));
        }
        self.cfl = cfl;
        Ok(())
    }

    /// Stores the name of a time scheme; it has no effect.
    ///
    /// # Errors
    /// The name is not that of a known scheme.
    pub fn set_scheme(&mut self, name: &str) -> Outcome {
        let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
        if !SCHEMES.iter().any(|known| known.eq_ignore_ascii_case(stem)) {
            let known = SCHEMES.join(", ");
            return Err(Failure::value(format!(
                "there is no time scheme {name:?}: known are {known}, with a number where they have one"
            )));
        }
        self.scheme = name.to_string();
        Ok(())
    }

    /// Detaches a line from a point, both by their order in the deck, from the next step on.
    ///
    /// # Errors
    /// The line does not end at the point, the system was not started, or the release of the line requires another integrator than the current one.
    pub fn break_line(&mut self, point: usize, line: usize) -> Outcome {
        self.line(line)?;
        let attached = self.point_attached(point)?;
        let Some((_, end)) = attached.iter().find(|(other, _)| *other == line) else {
            let message = format!("line {} does not end at point {}", line + 1, point + 1);
            return Err(Failure::new(Code::InvalidInput, message));
        };
        let at_b = *end == 1;
        let released = self.simulation()?.released(line);
        if released[usize::from(at_b)] {
            return Ok(());
        }
        let is_loose = self.start.loose.contains(&(line, at_b));
        if !is_loose {
            self.loosen(line, at_b)?;
        }
        if let Some(simulation) = &mut self.simulation {
            simulation.set_release(line, true);
        }
        Ok(())
    }

    /// Rebuilds the simulation with a line end that can be released, and continues from the current state.
    fn loosen(&mut self, line: usize, at_b: bool) -> Outcome {
        if self.start.loose.iter().any(|(other, _)| *other == line) {
            return Err(Failure::missing(
                "a line that broke off one end cannot break off the other",
            ));
        }
        let integrators = |simulation: &Simulation| -> Vec<_> {
            simulation
                .choices()
                .map(|choice: &Choice| choice.integrator)
                .collect()
        };
        let present = self.simulation()?;
        let (before, snapshot) = (integrators(present), present.snapshot().clone());
        let mut start: Start = self.start.clone();
        start.loose.push((line, at_b));
        let mut next = self.simulation_of(&start)?;
        if integrators(&next) != before {
            return Err(Failure::missing(
                "breaking this line off needs another time integrator than the one that is running: write FAILURE-like breaks to a \
                 moorline scene instead",
            ));
        }
        next.restore(snapshot);
        self.simulation = Some(next);
        self.start = start;
        Ok(())
    }
}
