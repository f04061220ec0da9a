//! Error of the energy balance.

use moorline::simulation::Simulation;

/// Energy counted by a balance.
#[derive(Default)]
pub struct Balance {
    /// Sum of the magnitudes of external work and dissipation [J].
    turnover: f64,
    /// Greatest stored energy [J].
    held: f64,
    given: f64,
    lost: f64,
    numerical: f64,
}

impl Balance {
    /// Returns the balance at the start.
    pub fn new(simulation: &Simulation) -> Balance {
        let mut balance = Balance::default();
        balance.count(simulation);
        balance
    }

    /// Adds a communication step.
    pub fn count(&mut self, simulation: &Simulation) {
        let (energy, flow) = (simulation.energy(), simulation.energy_balance().unwrap().flow);
        self.turnover += (flow.external_work - self.given).abs() + (flow.dissipation - self.lost).abs();
        (self.given, self.lost, self.numerical) =
            (flow.external_work, flow.dissipation, flow.algorithmic_dissipation);
        let height = energy.gravitational;
        self.held = self.held.max(energy.total() - height + height.abs());
    }

    /// Energy added by algorithmic dissipation, relative to all counted energy; negative if it removed energy [-].
    pub fn created(&self) -> f64 {
        match self.numerical {
            0.0 => 0.0,
            numerical => -numerical / (self.turnover + self.held),
        }
    }

    /// Error of the energy balance, relative to all counted energy [-].
    pub fn imbalance(&self, simulation: &Simulation) -> f64 {
        match simulation.energy_balance().unwrap().error() {
            0.0 => 0.0,
            error => error / (self.turnover + self.held),
        }
    }
}
