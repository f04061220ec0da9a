//! Error of the energy balance.

use moorline::simulation::Simulation;

/// Energy that a balance has counted.
#[derive(Default)]
pub struct Balance {
    /// Sum of external work and dissipation, all positive [J].
    turnover: f64,
    /// Most that was held [J].
    held: f64,
    given: f64,
    lost: f64,
    numerical: f64,
}

impl Balance {
    /// At the start.
    pub fn new(simulation: &Simulation) -> Balance {
        let mut balance = Balance::default();
        balance.count(simulation);
        balance
    }

    /// Counts a communication step.
    pub fn count(&mut self, simulation: &Simulation) {
        let (energy, flow) = (simulation.energy(), simulation.energy_balance().unwrap().flow);
        self.turnover += (flow.external_work - self.given).abs() + (flow.dissipation - self.lost).abs();
        (self.given, self.lost, self.numerical) =
            (flow.external_work, flow.dissipation, flow.algorithmic_dissipation);
        let height = energy.gravitational;
        self.held = self.held.max(energy.total() - height + height.abs());
    }

    /// Energy that the damping of the integrators brought in all, over all that was counted; negative where it took some [-].
    pub fn created(&self) -> f64 {
        match self.numerical {
            0.0 => 0.0,
            numerical => -numerical / (self.turnover + self.held),
        }
    }

    /// Error of the energy balance over all the energy that it has counted [-].
    pub fn imbalance(&self, simulation: &Simulation) -> f64 {
        match simulation.energy_balance().unwrap().error() {
            0.0 => 0.0,
            error => error / (self.turnover + self.held),
        }
    }
}
