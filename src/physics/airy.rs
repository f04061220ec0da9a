//! Airy waves: velocity and acceleration of the water under a sum of small waves.
//!
//! Component j of amplitude a, circular frequency ω, direction θ and phase φ over a depth h (or deep water) has
//!
//!   η = a cos ψ,   ψ = k (x cos θ + y sin θ) − ωt + φ,   ω² = g k tanh kh,
//!   u = a ω C(z) cos ψ,   w = a ω S(z) sin ψ,   C = cosh k(z + h)/sinh kh,   S = sinh k(z + h)/sinh kh,
//!
//! u along θ, w upwards; the accelerations are ∂/∂t of these, as the theory is linear. Above and below z = 0 the
//! argument is stretched as Wheeler does, z' = h (z − η)/(h + η) with the elevation η of all components (deep water: z − η), so that the water
//! moves at the surface as the linear theory says of z = 0; there is no water above η. The ramp ½(1 − cos πt/t_r) multiplies
//! the amplitudes up to the time t_r; its own rate is left out of the acceleration.
//!
//! Source: Airy (1845) as in Dean & Dalrymple (1991), Water Wave Mechanics for Engineers and Scientists, chapter 3; Wheeler (1970), J.
//! Petroleum Technology 22(3), 359-367. Valid for ka ≪ 1. The dispersion relation is solved by Newton's method from the
//! guess k = ω²/g · (1 − exp(−(ω²h/g)^(5/4)))^(−2/5) (Guo, 2002, Coastal Engineering 45, 71-74), which is right to 0.75 %.

use std::f64::consts::PI;

use nalgebra::Vector3;

/// Newton steps of the dispersion relation, at most [-]; from a guess right to 1 % three are enough.
const NEWTON_STEPS_MAX: usize = 20;
/// kh above which cosh and sinh are exponentials to rounding [-].
const DEEP: f64 = 20.0;

/// One wave train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    /// Amplitude, half the height [m].
    pub amplitude: f64,
    /// Circular frequency ω [rad/s].
    pub frequency: f64,
    /// Direction it travels to, from x towards y [rad].
    pub direction: f64,
    /// Phase φ [rad].
    pub phase: f64,
}

/// Motion of the water at a place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Orbit {
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Acceleration ∂u/∂t [m/s²].
    pub acceleration: Vector3<f64>,
}

/// A sum of wave trains.
#[derive(Debug, Clone, PartialEq)]
pub struct Waves {
    trains: Vec<(Component, f64)>,
    depth: Option<f64>,
    ramp: Option<f64>,
}

/// Wave number k [1/m] of a circular frequency ω > 0 [rad/s] over a depth [m], deep water where none, under gravity [m/s²].
pub fn wave_number(frequency: f64, depth: Option<f64>, gravity: f64) -> f64 {
    let deep = frequency * frequency / gravity;
    let Some(depth) = depth else { return deep };
    let mu = deep * depth; // ω²h/g = κ tanh κ
    let mut kappa = mu * (-(-mu.powf(1.25)).exp_m1()).powf(-0.4);
    for _ in 0..NEWTON_STEPS_MAX {
        let tanh = kappa.tanh();
        let step = (kappa * tanh - mu) / (tanh + kappa * (1.0 - tanh * tanh));
        kappa -= step;
        if step.abs() <= 4.0 * f64::EPSILON * kappa {
            break;
        }
    }
    kappa / depth
}

impl Waves {
    /// Wave trains over a depth [m], deep water where none, under gravity [m/s²], that grow over a ramp [s].
    pub fn new(
        components: &[Component],
        depth: Option<f64>,
        ramp: Option<f64>,
        gravity: f64,
    ) -> Waves {
        let train = |c: &Component| (*c, wave_number(c.frequency, depth, gravity));
        Waves {
            trains: components.iter().map(train).collect(),
            depth,
            ramp,
        }
    }

    /// Elevation of the surface at x, y [m] and time t [s], in [m].
    pub fn elevation(&self, x: f64, y: f64, t: f64) -> f64 {
        let sum: f64 = self
            .trains
            .iter()
            .map(|(c, k)| c.amplitude * c.angle(*k, x, y, t).cos())
            .sum();
        self.growth(t) * sum
    }

    /// Motion of the water at a place [m] and time t [s]; none above the surface.
    pub fn orbit(&self, place: Vector3<f64>, t: f64) -> Option<Orbit> {
        let elevation = self.elevation(place.x, place.y, t);
        if place.z > elevation {
            return None;
        }
        let stretched = match self.depth {
            Some(h) => h * (place.z - elevation) / (h + elevation),
            None => place.z - elevation,
        };
        let growth = self.growth(t);
        let mut orbit = Orbit::default();
        for (c, k) in &self.trains {
            let [level, upward] = self.decay(*k, stretched);
            let (sin, cos) = c.angle(*k, place.x, place.y, t).sin_cos();
            let speed = growth * c.amplitude * c.frequency;
            let along = Vector3::new(c.direction.cos(), c.direction.sin(), 0.0);
            orbit.velocity += speed * (level * cos * along + upward * sin * Vector3::z());
            orbit.acceleration +=
                speed * c.frequency * (level * sin * along - upward * cos * Vector3::z());
        }
        Some(orbit)
    }

    /// cosh k(z + h)/sinh kh and sinh k(z + h)/sinh kh [-].
    fn decay(&self, k: f64, z: f64) -> [f64; 2] {
        match self.depth {
            Some(h) if k * h < DEEP => {
                let (argument, sinh) = (k * (z + h).max(0.0), (k * h).sinh());
                [argument.cosh() / sinh, argument.sinh() / sinh]
            }
            _ => [(k * z).exp(); 2],
        }
    }

    fn growth(&self, t: f64) -> f64 {
        match self.ramp {
            Some(ramp) if t < ramp => 0.5 * (1.0 - (PI * (t / ramp).max(0.0)).cos()),
            _ => 1.0,
        }
    }
}

impl Component {
    /// ψ [rad].
    fn angle(&self, k: f64, x: f64, y: f64, t: f64) -> f64 {
        let (sin, cos) = self.direction.sin_cos();
        k * (x * cos + y * sin) - self.frequency * t + self.phase
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const GRAVITY: f64 = 9.80665;

    fn sea(depth: Option<f64>) -> Waves {
        let component = |amplitude, frequency, direction, phase| Component {
            amplitude,
            frequency,
            direction,
            phase,
        };
        let components = [
            component(1e-4, 0.6, 0.3, 0.2),
            component(5e-5, 1.1, -0.9, 2.0),
            component(8e-5, 0.35, 2.0, -1.0),
        ];
        Waves::new(&components, depth, None, GRAVITY)
    }

    #[test]
    fn the_wave_number_satisfies_the_dispersion_relation_from_shallow_to_deep() {
        for depth in [0.1, 1.0, 20.0, 200.0, 5000.0] {
            for frequency in [1e-4, 0.01, 0.1, 0.5, 1.0, 3.0, 20.0] {
                let k = wave_number(frequency, Some(depth), GRAVITY);
                let found = GRAVITY * k * (k * depth).tanh();
                assert_relative_eq!(found, frequency * frequency, max_relative = 1e-13);
            }
        }
        let shallow = wave_number(1e-3, Some(2.0), GRAVITY);
        assert_relative_eq!(shallow, 1e-3 / (GRAVITY * 2.0).sqrt(), max_relative = 1e-6);
        assert_relative_eq!(wave_number(2.0, None, GRAVITY), 4.0 / GRAVITY);
    }

    #[test]
    fn small_waves_keep_the_volume_of_the_water_and_do_not_turn_it() {
        for depth in [Some(30.0), None] {
            let (waves, place, t, d) = (sea(depth), Vector3::new(3.0, -7.0, -8.0), 4.0, 1e-2);
            let slope = |axis: usize| {
                let mut step = Vector3::zeros();
                step[axis] = d;
                let at = |r| waves.orbit(r, t).unwrap().velocity;
                (at(place + step) - at(place - step)) / (2.0 * d)
            };
            let [x, y, z] = [slope(0), slope(1), slope(2)];
            // what stretching adds is of second order in the amplitude
            assert!((x.x + y.y + z.z).abs() < 1e-3 * x.norm());
            assert!((z.x - x.z).abs() < 1e-3 * x.norm() && (x.y - y.x).abs() < 1e-3 * x.norm());
        }
    }

    #[test]
    fn the_surface_rises_as_fast_as_the_water_and_nothing_crosses_the_bed() {
        let waves = sea(Some(30.0));
        let (x, y, t, d) = (5.0, 2.0, 7.0, 1e-3);
        let surface = waves.elevation(x, y, t);
        let rise = (waves.elevation(x, y, t + d) - waves.elevation(x, y, t - d)) / (2.0 * d);
        let water = waves.orbit(Vector3::new(x, y, surface), t).unwrap();
        assert_relative_eq!(water.velocity.z, rise, max_relative = 1e-6);
        let bed = waves.orbit(Vector3::new(x, y, -30.0), t).unwrap();
        assert!(bed.velocity.z.abs() < 1e-18 && bed.velocity.x != 0.0);
        assert!(waves.orbit(Vector3::new(x, y, surface + 1e-9), t).is_none());
    }

    #[test]
    fn the_acceleration_is_the_rate_of_the_velocity() {
        let (waves, place, t, d) = (sea(None), Vector3::new(3.0, -7.0, -8.0), 4.0, 1e-3);
        let at = |t| waves.orbit(place, t).unwrap();
        let rate = (at(t + d).velocity - at(t - d).velocity) / (2.0 * d);
        assert!((rate - at(t).acceleration).norm() < 1e-4 * rate.norm());
    }

    #[test]
    fn a_ramp_grows_from_rest_to_the_full_sea() {
        let mut waves = sea(Some(30.0));
        let full = waves.elevation(1.0, 2.0, 50.0);
        waves.ramp = Some(20.0);
        assert_eq!(waves.elevation(1.0, 2.0, 0.0), 0.0);
        assert_eq!(waves.elevation(1.0, 2.0, 50.0), full);
        assert_relative_eq!(waves.growth(10.0), 0.5);
    }
}
