//! A host code coupled to a mooring through the library: a floating body that surges between two chains.
//!
//! ```text
//!   anchor ●══════╲___ stern ▇▇▇▇▇▇ bow ___╱══════● anchor        M x'' + C x' = F(t),  F the mooring's force along x
//! ```
//!
//! The body belongs to the host, which integrates it by the semi-implicit Euler method: the force at t gives the new velocity, and the new velocity
//! gives the new position. The mooring receives the positions of the fairleads at t and steps to t + h; the path in between is smooth. Released 6 m
//! from its position of rest, the body oscillates with the period that follows from the static stiffness of the mooring, and the drag on the chains
//! damps it.
//!
//! `cargo run --release --example couple_with_a_host_code`

use std::error::Error;
use std::f64::consts::TAU;

use moorline::scene::Scene;
use moorline::simulation::Simulation;

const SCENE: &str = r#"
title = "a floating body between two chains"

[water]
density = 1025.0

[seabed]
depth = 120.0

[line_types.chain]
mass = 126.0
diameter = 0.144
axial_stiffness = 5.5e8
axial_damping = 1.0e6
drag_normal = 1.3
drag_tangential = 0.3
added_mass_normal = 1.0
added_mass_tangential = 0.5

[[points]]
name = "anchor_ahead"
position = [430.0, 0.0, -120.0]
kind = "fixed"

[[points]]
name = "bow"
position = [25.0, 0.0, -10.0]
kind = "coupled"

[[points]]
name = "stern"
position = [-25.0, 0.0, -10.0]
kind = "coupled"

[[points]]
name = "anchor_astern"
position = [-430.0, 0.0, -120.0]
kind = "fixed"

[[lines]]
name = "ahead"
from = "anchor_ahead"
to = "bow"
sections = [{ type = "chain", length = 450.0, elements = 40 }]

[[lines]]
name = "astern"
from = "anchor_astern"
to = "stern"
sections = [{ type = "chain", length = 450.0, elements = 40 }]
"#;

/// Mass of the body, including its added mass in surge [kg].
const MASS: f64 = 4.0e6;
/// Linear damping of the body [N s/m].
const DAMPING: f64 = 1.0e4;
/// Surge at which the body is released [m].
const RELEASE: f64 = 6.0;
/// Communication step [s].
const STEP: f64 = 0.1;
/// Duration [s].
const DURATION: f64 = 400.0;

/// Mooring with the interface that the host uses: one surge in, one force out.
struct Mooring {
    simulation: Simulation,
    fairleads: [usize; 2],
}

impl Mooring {
    fn new() -> Result<Mooring, Box<dyn Error>> {
        let simulation = Simulation::new(&Scene::from_toml(SCENE)?)?;
        let fairlead = |name: &str| {
            simulation
                .model()
                .point_index(name)
                .ok_or(format!("no point {name}"))
        };
        let fairleads = [fairlead("bow")?, fairlead("stern")?];
        Ok(Mooring {
            simulation,
            fairleads,
        })
    }

    fn set_surge(&mut self, surge: f64) {
        for point in self.fairleads {
            self.simulation.set_displacement(point, [surge, 0.0, 0.0]);
        }
    }

    /// Force along x on the body [N].
    fn force(&self) -> f64 {
        self.fairleads
            .iter()
            .map(|&point| self.simulation.end_force(point)[0])
            .sum()
    }

    /// Force in static equilibrium at a surge [m]; the mooring then rests there.
    fn static_force(&mut self, surge: f64) -> Result<f64, Box<dyn Error>> {
        self.set_surge(surge);
        self.simulation.restart(0.0)?;
        Ok(self.force())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut mooring = Mooring::new()?;
    let stiffness = (mooring.static_force(-1.0)? - mooring.static_force(1.0)?) / 2.0; // [N/m]
    let mut force = mooring.static_force(RELEASE)?;
    let (mut surge, mut velocity) = (RELEASE, 0.0);
    let mut upward = Vec::new(); // times at which the body passes the middle towards positive surge [s]
    println!(
        "{:>7} {:>9} {:>11} {:>13} {:>14} {:>15}",
        "t [s]", "surge [m]", "force [kN]", "velocity [m/s]", "ahead T [kN]", "astern T [kN]"
    );
    for index in 0..=(DURATION / STEP).round() as usize {
        let time = index as f64 * STEP;
        if index % 200 == 0 {
            let [ahead, astern] = [0, 1].map(|line| 1e-3 * mooring.simulation.tension_b(line));
            println!(
                "{time:>7.1} {surge:>9.3} {:>11.2} {velocity:>13.4} {ahead:>14.1} {astern:>15.1}",
                1e-3 * force
            );
        }
        let before = surge;
        mooring.set_surge(surge);
        velocity += STEP * (force - DAMPING * velocity) / MASS;
        surge += STEP * velocity;
        mooring.simulation.advance(STEP)?;
        force = mooring.force();
        if before < 0.0 && surge >= 0.0 {
            upward.push(time + STEP * before / (before - surge));
        }
    }
    if let [first, .., last] = upward[..] {
        let period = (last - first) / (upward.len() - 1) as f64;
        println!(
            "\nperiod {period:.1} s over {} swings; 2π√(M/K) = {:.1} s with K = {:.1} kN/m at rest",
            upward.len() - 1,
            TAU * (MASS / stiffness).sqrt(),
            1e-3 * stiffness
        );
    }
    Ok(())
}
