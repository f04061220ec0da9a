//! A free point in the water: buoyancy, drag and added mass of a sphere that may pierce the surface.
//!
//! With the sphere's radius R, the height z of its centre above the surface and u = (R − z)/2R, kept within 0 and 1,
//!
//!   s = u²(3 − 2u),   ds/dz = −3u(1 − u)/R                 submerged part of its volume V
//!   B = ρ g V s,      ∫ B dz = −2R ρ g V (u³ − u⁴/2)        buoyancy, and its potential
//!   f = −½ ρ CdA s |v| v,   M = ρ V Ca s I                  v the velocity relative to the water
//!
//! In waves the height is measured from the elevation of the surface, v is relative to the moving water and f
//! includes ρV (1 + Ca) s ∂u/∂t, the Froude-Krylov force and that of the added mass.
//!
//! s is exact: it is the volume of a spherical cap. Drag and added mass are taken in proportion to it. A point with a
//! drag area and no volume is submerged like the sphere of that cross-section.
//!
//! Where s changes, the equation of motion is M a = f without the impulse Ṁ v, so that a point that enters the water loses ½ Ṁ v² and regains it when
//! it leaves. Slamming is not modelled.
//!
//! Source: the cap's volume πh²(3R − h)/3 by Archimedes; drag and added mass after Morison, O'Brien, Johnson & Schaaf (1950), J. Petroleum Technology
//! 2(5), 149-154, without a direction. Valid for bodies that are small compared with the waves and too slow to make waves. Proportion to s is exact
//! only deep below and far above the surface.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

/// Sphere in water: buoyancy, added mass and drag of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Radius R [m], positive.
    pub radius: f64,
    /// Mass ρ V of the water that the whole sphere displaces [kg].
    pub displaced: f64,
    /// Buoyancy ρ g V of the whole sphere [N].
    pub buoyancy: f64,
    /// Added mass ρ V Ca of the whole sphere [kg].
    pub added_mass: f64,
    /// ½ ρ CdA of the whole sphere [N s²/m²].
    pub drag: f64,
}

/// Submergence of a sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wetted {
    /// Submerged part of the volume s [-].
    pub part: f64,
    /// Slope ds/dz of the submerged part with respect to height [1/m], not positive.
    pub slope: f64,
}

impl Sphere {
    /// Sphere of `volume` [m³], drag area CdA `drag_area` [m²] and added-mass coefficient `added_mass` [-] in water of `density` [kg/m³] under
    /// `gravity` [m/s²]; `None` if the water exerts no force on it.
    pub fn new([volume, drag_area, added_mass]: [f64; 3], density: f64, gravity: f64) -> Option<Sphere> {
        let radius = if volume > 0.0 {
            (0.75 * volume / PI).cbrt()
        } else {
            (drag_area / PI).sqrt()
        };
        let displaced = density * volume;
        (density > 0.0 && radius > 0.0).then_some(Sphere {
            radius,
            displaced,
            buoyancy: displaced * gravity,
            added_mass: displaced * added_mass,
            drag: 0.5 * density * drag_area,
        })
    }

    /// Submergence of the sphere with its centre at `height` [m] above the surface.
    #[inline]
    pub fn wetted(&self, height: f64) -> Wetted {
        if height <= -self.radius {
            return Wetted {
                part: 1.0,
                slope: 0.0,
            };
        }
        let u = self.depth(height);
        Wetted {
            part: u * u * (3.0 - 2.0 * u),
            slope: -3.0 * u * (1.0 - u) / self.radius,
        }
    }

    /// Submergence on the path from one height to another [m]: the mean of s, and its slope with respect to the final height. The mean is exact:
    /// times the path length it is the change of ∫ s dz.
    pub fn wetted_between(&self, from: f64, to: f64) -> Wetted {
        let [low, high] = [from, to].map(|height| 0.5 * (1.0 - height / self.radius));
        let [a, b] = [low, high].map(|u| u.clamp(0.0, 1.0));
        let under = |u: f64| (u - 1.0).max(0.0);
        // the divided difference of u³ − ½u⁴ between a and b
        let mean = a * a + a * b + b * b - 0.5 * (a + b) * (a * a + b * b);
        let part = match low == high {
            true => mean,
            false => (mean * (b - a) + under(high) - under(low)) / (high - low),
        };
        // ∫ t s' dt along the path, 0 ≤ t ≤ 1, by Simpson's rule
        let slope = |height: f64| self.wetted(height).slope;
        Wetted {
            part,
            slope: (2.0 * slope(0.5 * (from + to)) + slope(to)) / 6.0,
        }
    }

    /// u [-].
    fn depth(&self, height: f64) -> f64 {
        (0.5 * (1.0 - height / self.radius)).clamp(0.0, 1.0)
    }

    /// Potential energy of the buoyancy [J] at `height` [m] above the surface; 0 out of the water.
    pub fn energy(&self, height: f64) -> f64 {
        if height <= -self.radius {
            return -self.buoyancy * height;
        }
        let u = self.depth(height);
        2.0 * self.radius * self.buoyancy * u.powi(3) * (1.0 - 0.5 * u)
    }

    /// Maximum hydrostatic stiffness in heave, 3ρgV/4R [N/m].
    pub fn stiffness_max(&self) -> f64 {
        0.75 * self.buoyancy.abs() / self.radius
    }

    /// Drag [N] at a `velocity` [m/s] relative to the water.
    #[inline]
    pub fn drag(&self, wetted: Wetted, velocity: Vector3<f64>) -> Vector3<f64> {
        -self.drag * wetted.part * velocity.norm() * velocity
    }

    /// Slope −∂f/∂v of the drag [N s/m]: symmetric, positive semi-definite.
    pub fn drag_slope(&self, wetted: Wetted, velocity: Vector3<f64>) -> Matrix3<f64> {
        let speed = velocity.norm();
        if speed == 0.0 {
            return Matrix3::zeros();
        }
        let along = velocity * velocity.transpose() / speed;
        self.drag * wetted.part * (Matrix3::from_diagonal_element(speed) + along)
    }

    /// Slope −∂f/∂z of the drag with respect to height [N/m].
    pub fn drag_slope_with_height(&self, wetted: Wetted, velocity: Vector3<f64>) -> Vector3<f64> {
        self.drag * wetted.slope * velocity.norm() * velocity
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::{assert_columns, central};
    use approx::assert_relative_eq;

    fn sphere() -> Sphere {
        Sphere::new([2.0, 1.5, 0.5], 1025.0, 9.81).unwrap()
    }

    const HEIGHTS: [f64; 7] = [-5.0, -0.7, -0.3, 0.0, 0.2, 0.75, 4.0];

    #[test]
    fn half_a_sphere_is_wet_at_the_surface_all_below_and_none_above() {
        let parts = [-9.0, 0.0, 9.0].map(|z| sphere().wetted(z).part);
        assert_eq!(parts, [1.0, 0.5, 0.0]);
    }

    #[test]
    fn the_wet_part_is_that_of_a_spherical_cap() {
        let r = sphere().radius;
        assert_relative_eq!(4.0 / 3.0 * PI * r.powi(3), 2.0, max_relative = 1e-14);
        for depth in [0.1, 0.6, 1.1] {
            let cap = PI * depth * depth * (3.0 * r - depth) / 3.0;
            let part = sphere().wetted(r - depth).part;
            assert_relative_eq!(2.0 * part, cap, max_relative = 1e-13);
        }
    }

    #[test]
    fn the_wet_part_between_two_heights_is_what_the_energy_changes_by() {
        let s = sphere();
        for (from, to) in HEIGHTS.into_iter().flat_map(|a| HEIGHTS.map(|b| (a, b))) {
            let way = s.wetted_between(from, to);
            let change = s.energy(to) - s.energy(from);
            let work = s.buoyancy * way.part * (from - to);
            assert_relative_eq!(work, change, epsilon = 1e-9);
            if [from, to].map(|z| z.abs() < s.radius) == [true; 2] {
                let slope = central(1e-6, |by| s.wetted_between(from, to + by).part);
                assert_relative_eq!(way.slope, slope, epsilon = 1e-8);
            }
        }
        for height in HEIGHTS {
            let part = s.wetted(height).part;
            let still = s.wetted_between(height, height).part;
            assert_relative_eq!(still, part, epsilon = 1e-15);
        }
    }

    #[test]
    fn slopes_and_the_force_of_the_energy_equal_central_differences() {
        let (s, v) = (sphere(), Vector3::new(0.4, -1.1, 0.7));
        for z in HEIGHTS {
            let at = s.wetted(z);
            assert_relative_eq!(
                at.slope,
                central(1e-6, |by| s.wetted(z + by).part),
                epsilon = 1e-8
            );
            let push = -central(1e-6, |by| s.energy(z + by));
            assert_relative_eq!(push, s.buoyancy * at.part, epsilon = 1e-3);
            let sunk = -central(1e-6, |by| s.drag(s.wetted(z + by), v));
            assert_relative_eq!(s.drag_slope_with_height(at, v), sunk, epsilon = 1e-5);
            assert_columns(&s.drag_slope(at, v), 1e-6, 1e-5, |by| -s.drag(at, v + by));
        }
    }

    #[test]
    fn drag_takes_energy_and_vanishes_at_rest() {
        let (s, v) = (sphere(), Vector3::new(1.0, 2.0, -3.0));
        let under = s.wetted(-9.0);
        let most = 0.5 * 1025.0 * 1.5 * v.norm_squared();
        assert_relative_eq!(s.drag(under, v).norm(), most, max_relative = 1e-14);
        assert!(s.drag(under, v).dot(&v) < 0.0);
        assert_eq!(s.drag(under, Vector3::zeros()), Vector3::zeros());
        assert_eq!(s.drag_slope(under, Vector3::zeros()), Matrix3::zeros());
    }

    #[test]
    fn without_volume_and_drag_area_the_water_does_nothing() {
        assert_eq!(Sphere::new([0.0, 0.0, 0.5], 1025.0, 9.81), None);
        let plate = Sphere::new([0.0, PI, 0.5], 1025.0, 9.81).unwrap();
        assert_eq!((plate.radius, plate.buoyancy), (1.0, 0.0));
    }
}
