//! Water and seabed.

use nalgebra::Vector3;

use crate::failure::{Failure, Outcome};
use crate::system::System;

/// Motion of the water at a position.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Flow {
    /// Velocity [m/s].
    pub velocity: [f64; 3],
    /// Acceleration [m/s²].
    pub acceleration: [f64; 3],
    /// Elevation of the surface [m].
    pub elevation: f64,
}

/// Message of every call that needs water kinematics from a host.
pub const NO_HOST_WATER: &str = "water kinematics that the host gives are not modelled: give waves and currents in the deck \
     (WaveKin 7 or 0, Currents 1 or 0)";

impl System {
    /// Returns the motion of the water at a position [m], from current and waves, at the current time.
    ///
    /// # Errors
    /// The system was not started, or the position is not finite.
    pub fn flow(&self, place: [f64; 3]) -> Outcome<Flow> {
        let simulation = self.simulation()?;
        if place.iter().any(|value| !value.is_finite()) {
            return Err(Failure::value("a place is not finite"));
        }
        let (model, time) = (simulation.model(), simulation.state().time);
        let mut velocity = Vector3::zeros();
        if let Some(stream) = model.stream(time) {
            velocity += stream.velocity(place[2]);
        }
        let Some(waves) = &model.waves else {
            return Ok(Flow {
                velocity: velocity.into(),
                ..Flow::default()
            });
        };
        let orbit = waves.orbit(Vector3::from(place), time);
        Ok(Flow {
            velocity: (velocity + orbit.velocity).into(),
            acceleration: orbit.acceleration.into(),
            elevation: waves.elevation(place[0], place[1], time),
        })
    }

    /// Returns the height z of the seabed at a horizontal position [m], negative below still water, as MoorDyn does.
    ///
    /// # Errors
    /// The system was not started, the position is not finite, or there is no seabed.
    pub fn depth_at(&self, x: f64, y: f64) -> Outcome<f64> {
        let model = self.simulation()?.model();
        if !x.is_finite() || !y.is_finite() {
            return Err(Failure::value("a place is not finite"));
        }
        match (&model.seabed, model.seabed_level) {
            (Some(seabed), _) if !seabed.level => Ok(seabed.ground.height(x, y)),
            (_, Some(seabed)) => Ok(seabed),
            (_, None) => Err(Failure::value("the deck has no seabed")),
        }
    }

    /// Returns the height z of the seabed at the mean and the least depth of the soundings [m], or that of a level seabed twice.
    ///
    /// # Errors
    /// The deck has no seabed.
    pub fn depths(&self) -> Outcome<[f64; 2]> {
        let seabed = self.deck.scene.seabed.as_ref();
        let seabed = seabed.ok_or_else(|| Failure::value("the deck has no seabed"))?;
        let Some(grid) = &seabed.grid else {
            return Ok([-seabed.depth; 2]);
        };
        let depths = || grid.depth.iter().flatten().copied();
        let count = depths().count().max(1) as f64;
        Ok([
            -depths().sum::<f64>() / count,
            -depths().fold(f64::INFINITY, f64::min),
        ])
    }
}
