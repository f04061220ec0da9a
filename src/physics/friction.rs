//! Coulomb friction between a line and the bed it lies on, with stick.
//!
//! In the plane of the bed, with the axes a along the line and b across it and the normal force N, the friction (f_a, f_b) stays in an ellipse,
//!
//! ```text
//! (f_a/D_a)² + (f_b/D_b)² ≤ 1,   D_a = N √(μ_a² s² + μ_b² (1 − s²)),   D_b = μ_b N
//! ```
//!
//! with s the part of the line's tangent that lies in the plane: a line that stands on the bed is across it all around. Inside the
//! ellipse nothing slides. On it the line slides where dissipation is greatest, v_i ∝ −f_i/D_i², so that the friction is D_a against a line dragged along itself, D_b across.
//! With the force f* that would hold a node, and the compliance W_i of sliding to force along the axes,
//!
//! ```text
//! f_i = f*_i W_i D_i²/(W_i D_i² + γ),   γ ≥ 0 such that f lies in the ellipse.
//! ```
//!
//! Source: maximal dissipation for anisotropic friction, Michałowski & Mróz (1978), Archives of Mechanics 30, 259-276; γ by the
//! iteration of Moré & Sorensen (1983), SIAM J. Sci. Stat. Comput. 4, 553-572. Valid for a bed that keeps its shape: no embedment.

use nalgebra::{Matrix2, Vector2, Vector3};

/// Coefficients of friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Along the line [-].
    pub axial: f64,
    /// Across the line [-].
    pub transverse: f64,
}

/// Axes in the plane of the bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes {
    /// Along the line [-].
    pub along: Vector3<f64>,
    /// Across the line [-].
    pub across: Vector3<f64>,
    /// Part s of the line's tangent that lies in the plane [-].
    pub share: f64,
}

/// Part of the tangent below which a line stands on the bed [-].
const STANDING: f64 = 1e-9;
/// Nodes closer to the ellipse than this slide: rounding of their places must not decide [-].
const BORDER: f64 = 1e-7;
/// Iterations for γ.
const ITERATIONS_MAX: usize = 30;

impl Axes {
    /// Of a line along the unit vector `tangent` on a bed with the unit normal `normal`.
    pub fn new(normal: Vector3<f64>, tangent: Vector3<f64>) -> Axes {
        let flat = tangent - normal.dot(&tangent) * normal;
        let share = flat.norm();
        let along = if share > STANDING {
            flat / share
        } else {
            let level = if normal.x.abs() < 0.7 {
                Vector3::x()
            } else {
                Vector3::y()
            };
            normal.cross(&level).normalize()
        };
        Axes {
            along,
            across: normal.cross(&along),
            share,
        }
    }

    /// Components of a vector along the axes, in its unit [-].
    pub fn components(&self, vector: &Vector3<f64>) -> Vector2<f64> {
        Vector2::new(self.along.dot(vector), self.across.dot(vector))
    }

    /// The vector of components along the axes, in their unit [-].
    pub fn vector(&self, components: &Vector2<f64>) -> Vector3<f64> {
        components.x * self.along + components.y * self.across
    }
}

/// Friction at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// Along and across the line [N].
    pub force: Vector2<f64>,
    /// γ, in the unit of W D² [N² m/N, N² m/(N s)]; `None` where the node sticks.
    pub multiplier: Option<f64>,
}

impl Friction {
    /// The greater of the coefficients [-].
    pub fn greatest(&self) -> f64 {
        self.axial.max(self.transverse)
    }

    /// The axes of the ellipse [N] under a normal force [N].
    pub fn limits(&self, axes: &Axes, normal_force: f64) -> Vector2<f64> {
        let lying = (axes.share * axes.share).min(1.0);
        let along = lying * self.axial * self.axial + (1.0 - lying) * self.transverse * self.transverse;
        Vector2::new(along.sqrt(), self.transverse) * normal_force
    }
}

/// The friction at a node that `holding` [N] would hold, in the ellipse of the axes `limits` [N].
pub fn held(holding: Vector2<f64>, compliance: Vector2<f64>, limits: Vector2<f64>) -> Held {
    let border = (1.0 - BORDER) * (1.0 - BORDER);
    let rough = limits.x > 0.0 && limits.y > 0.0;
    if rough && holding.component_div(&limits).norm_squared() <= border {
        return Held {
            force: holding,
            multiplier: None,
        };
    }
    let stiffness = compliance.component_mul(&limits.component_mul(&limits)); // W D²
    let scaled = holding.component_mul(&compliance).component_mul(&limits);
    let acts = |i: usize| limits[i] > 0.0 && scaled[i] != 0.0;
    let sum = |gamma: f64, power: i32| -> f64 {
        (0..2)
            .filter(|&i| acts(i))
            .map(|i| scaled[i] * scaled[i] / (stiffness[i] + gamma).powi(power))
            .sum()
    };
    let unlimited = (0..2).all(|i| limits[i] > 0.0 || holding[i] == 0.0);
    if sum(0.0, 2) <= border {
        let force = Vector2::from_fn(|i, _| if limits[i] > 0.0 { holding[i] } else { 0.0 });
        return Held {
            force,
            multiplier: (!unlimited).then_some(0.0),
        };
    }
    let mut gamma = 0.0;
    for _ in 0..ITERATIONS_MAX {
        let size = sum(gamma, 2);
        let excess = size.sqrt() - 1.0;
        gamma += (size * excess / sum(gamma, 3)).max(-gamma);
        if excess.abs() <= 4.0 * f64::EPSILON {
            break;
        }
    }
    let force = |i: usize| match acts(i) {
        true => holding[i] * stiffness[i] / (stiffness[i] + gamma),
        false => 0.0,
    };
    Held {
        force: Vector2::from_fn(|i, _| force(i)),
        multiplier: Some(gamma),
    }
}

impl Held {
    /// Slope of the force with what would hold the node [-], the limits held; all compliances being 1.
    pub fn slope(&self, limits: Vector2<f64>) -> Matrix2<f64> {
        let Some(gamma) = self.multiplier else {
            return Matrix2::identity();
        };
        let square = limits.component_mul(&limits);
        let per = |i: usize, value: f64| {
            if square[i] > 0.0 {
                value / (square[i] + gamma)
            } else {
                0.0
            }
        };
        let radial = Matrix2::from_diagonal(&Vector2::from_fn(|i, _| per(i, square[i])));
        let toward = Vector2::from_fn(|i, _| per(i, self.force[i]));
        let bulge: f64 = (0..2)
            .filter(|&i| square[i] > 0.0)
            .map(|i| self.force[i] * toward[i] / square[i])
            .sum();
        if bulge > 0.0 {
            radial - toward * toward.transpose() / bulge
        } else {
            radial
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::central;
    use approx::assert_relative_eq;

    const LIMITS: Vector2<f64> = Vector2::new(40.0, 70.0);
    const ONES: Vector2<f64> = Vector2::new(1.0, 1.0);

    fn size(force: &Vector2<f64>) -> f64 {
        force.component_div(&LIMITS).norm()
    }

    #[test]
    fn a_node_sticks_inside_the_ellipse_and_slides_on_it() {
        let inside = Vector2::new(20.0, -50.0);
        assert_eq!(held(inside, ONES, LIMITS).force, inside);
        assert_eq!(held(inside, ONES, LIMITS).multiplier, None);
        for outside in [[41.0, 0.0], [-3.0, 300.0], [1e6, 1e-3], [-60.0, -60.0]] {
            let slides = held(outside.into(), Vector2::new(0.3, 0.2), LIMITS);
            assert_relative_eq!(size(&slides.force), 1.0, max_relative = 1e-12);
            assert!(slides.multiplier.is_some());
        }
    }

    #[test]
    fn the_friction_along_each_axis_is_its_limit() {
        let force = |holding: [f64; 2]| held(holding.into(), ONES, LIMITS).force;
        assert_relative_eq!(force([-900.0, 0.0]), Vector2::new(-40.0, 0.0));
        assert_relative_eq!(force([0.0, 900.0]), Vector2::new(0.0, 70.0));
    }

    #[test]
    fn sliding_dissipates_the_most() {
        let (holding, compliance) = (Vector2::new(-500.0, 300.0), Vector2::new(0.2, 0.25));
        let slides = held(holding, compliance, LIMITS);
        let velocity = (slides.force - holding).component_mul(&compliance);
        let most = velocity.component_mul(&LIMITS).norm();
        assert_relative_eq!(-slides.force.dot(&velocity), most, max_relative = 1e-12);
    }

    #[test]
    fn without_friction_along_the_line_only_the_other_axis_holds() {
        let force = |holding: [f64; 2], limits: [f64; 2]| held(holding.into(), ONES, limits.into()).force;
        assert_eq!(force([30.0, 50.0], [0.0, 70.0]), Vector2::new(0.0, 50.0));
        assert_relative_eq!(force([30.0, 90.0], [0.0, 70.0]), Vector2::new(0.0, 70.0));
        assert_eq!(force([3.0, 4.0], [0.0; 2]), Vector2::zeros());
    }

    #[test]
    fn the_slope_equals_central_differences() {
        for holding in [[20.0, -50.0], [50.0, 60.0], [-300.0, 10.0], [5.0, 500.0]] {
            let holding = Vector2::from(holding);
            let slope = held(holding, ONES, LIMITS).slope(LIMITS);
            for axis in 0..2 {
                let force = |h: f64| held(holding + h * Vector2::ith(axis, 1.0), ONES, LIMITS).force;
                let difference = central(1e-4, force);
                assert_relative_eq!(slope.column(axis).into_owned(), difference, epsilon = 1e-8);
            }
        }
    }

    #[test]
    fn a_line_that_stands_on_the_bed_is_across_it_all_around() {
        let friction = Friction {
            axial: 0.4,
            transverse: 0.7,
        };
        let axes = Axes::new(Vector3::z(), Vector3::z());
        assert_relative_eq!(friction.limits(&axes, 10.0), Vector2::new(7.0, 7.0));
        let lying = Axes::new(Vector3::z(), Vector3::y());
        assert_relative_eq!(friction.limits(&lying, 10.0), Vector2::new(4.0, 7.0));
        assert_relative_eq!(axes.along.dot(&Vector3::z()), 0.0);
    }
}
