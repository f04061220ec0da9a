//! A current: the velocity of the water as a function of height.
//!
//! u(z) = u₀ + Σ_j Δu_j · min(max((z − z_j)/h_j, 0), 1),   du/dz = Σ_j Δu_j/h_j over the layers j that z lies in
//!
//! linear between the given heights and constant below the lowest and above the highest, like the profiles that current meters and metocean reports
//! give. The same expression evaluates one height or four at once; results are identical bit for bit.
//!
//! Source: piecewise linear interpolation; relative velocity in Morison's formula as in Hall & Goupee (2015), Ocean Engineering 104,
//! 590-603, section 2. Valid for currents that change slowly: the force on a line due to the acceleration of the water, ρA(1 + C_a) ∂u/∂t,
//! is left out, as it vanishes in a steady current.

use nalgebra::Vector3;

use crate::math::lanes::{Lanes, Vectors};

/// Velocity of the water as a function of height, at one time or as a shape multiplied by a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Velocity at and below the lowest height [m/s].
    lowest: Vector3<f64>,
    layers: Vec<Layer>,
}

/// Water between two neighbouring heights.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Layer {
    /// z of its lower boundary [m].
    bottom: f64,
    /// 1/h [1/m].
    inverse_height: f64,
    /// Velocity at its upper boundary less that at its lower [m/s].
    change: Vector3<f64>,
}

impl Profile {
    /// Profile with the same velocity [m/s] at every height.
    pub fn uniform(velocity: Vector3<f64>) -> Profile {
        Profile {
            lowest: velocity,
            layers: Vec::new(),
        }
    }

    /// Profile through pairs of height [m] and velocity [m/s], in any order, no two of them at the same height.
    ///
    /// # Panics
    /// Panics if there is no pair, or if two have the same height.
    pub fn through(pairs: &[(f64, Vector3<f64>)]) -> Profile {
        let mut pairs = pairs.to_vec();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let layer = |pair: &[(f64, Vector3<f64>)]| {
            let [(bottom, lower), (top, upper)] = [pair[0], pair[1]];
            assert!(top > bottom, "two velocities at one height");
            Layer {
                bottom,
                inverse_height: 1.0 / (top - bottom),
                change: upper - lower,
            }
        };
        let (_, lowest) = *pairs.first().expect("a profile has a height");
        Profile {
            lowest,
            layers: pairs.windows(2).map(layer).collect(),
        }
    }

    /// Velocity at a height z [m], in [m/s].
    pub fn velocity(&self, z: f64) -> Vector3<f64> {
        let mut velocity = self.lowest;
        for layer in &self.layers {
            let part = (z - layer.bottom) * layer.inverse_height;
            let left = 1.0 - if part > 0.0 { part } else { 0.0 };
            velocity += (1.0 - if left > 0.0 { left } else { 0.0 }) * layer.change;
        }
        velocity
    }

    /// du/dz at a height z [m], in [1/s].
    pub fn shear(&self, z: f64) -> Vector3<f64> {
        let within = |layer: &&Layer| {
            let part = (z - layer.bottom) * layer.inverse_height;
            (0.0..1.0).contains(&part)
        };
        let layers = self.layers.iter().filter(within);
        layers.map(|layer| layer.inverse_height * layer.change).sum()
    }

    /// Velocities at four heights z [m], in [m/s].
    #[inline(always)]
    pub fn velocities(&self, z: Lanes) -> Vectors {
        let one = Lanes::splat(1.0);
        let splat = |v: &Vector3<f64>| Vectors {
            x: Lanes::splat(v.x),
            y: Lanes::splat(v.y),
            z: Lanes::splat(v.z),
        };
        let mut velocity = splat(&self.lowest);
        for layer in &self.layers {
            let part = (z - Lanes::splat(layer.bottom)) * Lanes::splat(layer.inverse_height);
            let part = one - (one - part.positive()).positive();
            velocity = velocity + splat(&layer.change).scale(part);
        }
        velocity
    }
}

/// Current at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stream<'a> {
    /// Shape over the height.
    pub profile: &'a Profile,
    /// Factor on the shape at this time [-].
    pub factor: f64,
}

impl Stream<'_> {
    /// Velocity at a height z [m], in [m/s].
    pub fn velocity(&self, z: f64) -> Vector3<f64> {
        self.factor * self.profile.velocity(z)
    }

    /// du/dz at a height z [m], in [1/s].
    pub fn shear(&self, z: f64) -> Vector3<f64> {
        self.factor * self.profile.shear(z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::central;

    fn sheared() -> Profile {
        let at = |z: f64, x: f64, y: f64| (z, Vector3::new(x, y, 0.0));
        Profile::through(&[at(0.0, 1.0, 0.2), at(-200.0, 0.3, -0.1), at(-50.0, 0.8, 0.0)])
    }

    #[test]
    fn a_profile_is_straight_between_its_heights_and_constant_outside() {
        let profile = sheared();
        assert_eq!(profile.velocity(-50.0), Vector3::new(0.8, 0.0, 0.0));
        assert!((profile.velocity(-25.0) - Vector3::new(0.9, 0.1, 0.0)).norm() < 1e-15);
        assert!((profile.velocity(-125.0) - Vector3::new(0.55, -0.05, 0.0)).norm() < 1e-15);
        assert_eq!(profile.velocity(-300.0), Vector3::new(0.3, -0.1, 0.0));
        assert!((profile.velocity(7.0) - Vector3::new(1.0, 0.2, 0.0)).norm() < 1e-15);
        let uniform = Profile::uniform(Vector3::x());
        assert_eq!(uniform.velocity(-1e4), Vector3::x());
    }

    #[test]
    fn the_shear_equals_central_differences() {
        let profile = sheared();
        for z in [-250.0, -199.0, -120.0, -51.0, -20.0, 3.0] {
            let difference = central(1e-3, |h| profile.velocity(z + h));
            assert!((profile.shear(z) - difference).norm() < 1e-12, "z = {z} m");
        }
    }

    #[test]
    fn four_heights_at_once_give_what_each_gives_bit_for_bit() {
        let profile = sheared();
        for heights in [[-250.0, -200.0, -173.3, -50.0], [-49.9, -12.7, -1e-9, 11.0]] {
            let four = profile.velocities(Lanes::load(&heights, 0));
            for (i, z) in heights.into_iter().enumerate() {
                let component = |lanes: Lanes| {
                    let mut values = [0.0; 4];
                    lanes.store(&mut values, 0);
                    values[i]
                };
                let found = Vector3::new(component(four.x), component(four.y), component(four.z));
                assert_eq!(found, profile.velocity(z));
            }
        }
    }
}
