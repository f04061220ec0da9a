//! Coulomb friction between a line and the seabed it lies on, with stick.
//!
//! In the plane of the seabed, with the axes a along the line and b across it and the normal force N, the friction (f_a, f_b) stays in an ellipse,
//!
//! ```text
//! (f_a/D_a)² + (f_b/D_b)² ≤ 1,   D_a = N √(μ_a² s² + μ_b² (1 − s²)),   D_b = μ_b N
//! ```
//!
//! with s the part of the line's tangent that lies in the plane: a line that stands on the seabed is across it all around. Inside the
//! ellipse nothing slides. On it the line slides in the direction of greatest dissipation, v_i ∝ −f_i/D_i², so that
//! the friction is D_a against a line dragged along its axis, D_b across.
//! With the force f* that would hold a node, and the compliance W_i of sliding to force along the axes,
//!
//! ```text
//! f_i = f*_i W_i D_i²/(W_i D_i² + γ),   γ ≥ 0 such that f lies in the ellipse.
//! ```
//!
//! Source: maximal dissipation for anisotropic friction, Michałowski & Mróz (1978), Archives of Mechanics 30, 259-276; γ by the
//! iteration of Moré & Sorensen (1983), SIAM J. Sci. Stat. Comput. 4, 553-572. Valid for a seabed that keeps its shape: no embedment.

use nalgebra::{Matrix2, Vector2, Vector3};

use crate::math::real::{Real, RealVector, choose};

/// Coefficients of friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Along the line [-].
    pub axial: f64,
    /// Across the line [-].
    pub transverse: f64,
}

/// Axes in the plane of the seabed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes<V: RealVector = Vector3<f64>> {
    /// Along the line [-].
    pub along: V,
    /// Across the line [-].
    pub across: V,
    /// Part s of the line's tangent that lies in the plane [-].
    pub share: V::Real,
}

/// Part of the tangent below which a line stands on the seabed [-].
const STANDING: f64 = 1e-9;
/// Nodes closer to the ellipse than this slide: rounding of their places must not decide [-].
const BORDER: f64 = 1e-7;
/// Iterations for γ.
const ITERATIONS_MAX: usize = 30;

impl<V: RealVector> Axes<V> {
    /// Axes of a line along the unit vector `tangent` on a seabed with the unit normal `normal`.
    #[inline(always)]
    pub fn new(normal: V, tangent: V) -> Axes<V> {
        let [zero, one] = [0.0, 1.0].map(V::Real::splat);
        let flat = tangent - normal.scaled(normal.inner(tangent));
        let share = flat.inner(flat).sqrt();
        let lies = share - V::Real::splat(STANDING);
        let mut along = flat.scaled(lies.choose(share, one).recip());
        if (zero - lies).any_positive() {
            let leans = normal.components()[0].abs() - V::Real::splat(0.7);
            let level = choose(leans, V::of([zero, one, zero]), V::of([one, zero, zero]));
            let level = normal.crossed(level);
            along = choose(lies, along, level.scaled(level.inner(level).sqrt().recip()));
        }
        Axes {
            along,
            across: normal.crossed(along),
            share,
        }
    }

    /// The vector of components along the axes, in their unit [-].
    #[inline(always)]
    pub fn combine(&self, [along, across]: [V::Real; 2]) -> V {
        self.along.scaled(along) + self.across.scaled(across)
    }
}

impl Axes {
    /// Components of a vector along the axes, in its unit [-].
    pub fn components(&self, vector: &Vector3<f64>) -> Vector2<f64> {
        Vector2::new(self.along.dot(vector), self.across.dot(vector))
    }

    /// The vector of components along the axes, in their unit [-].
    pub fn vector(&self, components: &Vector2<f64>) -> Vector3<f64> {
        components.x * self.along + components.y * self.across
    }
}

impl Friction {
    /// Greater of the coefficients [-].
    pub fn greatest(&self) -> f64 {
        self.axial.max(self.transverse)
    }

    /// Semi-axes of the ellipse [N] along and across a line of which a part `share` [-] lies in the plane, under a
    /// normal force [N].
    #[inline(always)]
    pub fn limits<R: Real>(&self, share: R, normal_force: R) -> [R; 2] {
        let one = R::splat(1.0);
        let square = share * share;
        let lying = (square - one).choose(one, square);
        let [axial, transverse] = [self.axial, self.transverse].map(|part| R::splat(part * part));
        let along = lying * axial + (one - lying) * transverse;
        [
            along.sqrt() * normal_force,
            R::splat(self.transverse) * normal_force,
        ]
    }
}

/// Friction from the force that would hold a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slide<R> {
    /// Along and across the line [N].
    pub force: [R; 2],
    /// Positive where the node slides.
    pub slides: R,
    /// γ of nodes that slide, in the unit of W D² [N² m/N, N² m/(N s)].
    pub multiplier: R,
}

/// Terms of the ellipse: those of the force that acts along axes with friction, times W D, and W D².
#[derive(Clone, Copy)]
struct Ellipse<R> {
    scaled: [R; 2],
    stiffness: [R; 2],
}

impl<R: Real> Ellipse<R> {
    /// Force over the semi-axis i, and 1/(W D² + γ).
    #[inline(always)]
    fn part(&self, i: usize, gamma: R) -> [R; 2] {
        let softness = (self.stiffness[i] + gamma)
            .max(R::splat(f64::MIN_POSITIVE))
            .recip();
        [self.scaled[i] * softness, softness]
    }

    /// Square of the force over the semi-axes, and minus half its slope with γ.
    #[inline(always)]
    fn size(&self, gamma: R) -> [R; 2] {
        let ([a, soft_a], [b, soft_b]) = (self.part(0, gamma), self.part(1, gamma));
        [a * a + b * b, a * a * soft_a + b * b * soft_b]
    }
}

/// Friction at a node that `holding` [N] would hold, within the ellipse of the semi-axes `limits` [N].
#[inline(always)]
pub fn slide<R: Real>(holding: [R; 2], compliance: [R; 2], limits: [R; 2]) -> Slide<R> {
    let [zero, one] = [0.0, 1.0].map(R::splat);
    let rough = [limits[0].choose(one, zero), limits[1].choose(one, zero)];
    let acting = [rough[0] * holding[0], rough[1] * holding[1]];
    let yields = [compliance[0] * limits[0], compliance[1] * limits[1]]; // W D
    let ellipse = Ellipse {
        scaled: [acting[0] * yields[0], acting[1] * yields[1]],
        stiffness: [yields[0] * limits[0], yields[1] * limits[1]],
    };
    // the ellipse without quotients: (h_a D_b)² + (h_b D_a)² over (D_a D_b)²
    let axes = [limits[0].choose(limits[0], one), limits[1].choose(limits[1], one)];
    let (a, b, both) = (acting[0] * axes[1], acting[1] * axes[0], axes[0] * axes[1]);
    let outside = a * a + b * b - R::splat((1.0 - BORDER) * (1.0 - BORDER)) * both * both;
    let mut gamma = zero;
    let mut force = acting;
    if outside.any_positive() {
        for _ in 0..ITERATIONS_MAX {
            let [size, slope] = ellipse.size(gamma);
            let excess = size.sqrt() - one;
            let open = outside.choose(excess.abs() - R::splat(4.0 * f64::EPSILON), zero);
            if !open.any_positive() {
                break;
            }
            let change = size * excess * slope.max(R::splat(f64::MIN_POSITIVE)).recip();
            gamma = open.choose((gamma + change).max(zero), gamma);
        }
        let kept = [0, 1].map(|i| ellipse.part(i, gamma)[1] * ellipse.stiffness[i] * acting[i]);
        force = [
            outside.choose(kept[0], force[0]),
            outside.choose(kept[1], force[1]),
        ];
    }
    // without friction along an axis any force slides
    let unheld = (holding[0] - acting[0]).abs().max((holding[1] - acting[1]).abs());
    Slide {
        force,
        slides: outside.max(unheld),
        multiplier: gamma,
    }
}

/// Friction at one node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeFriction {
    /// Along and across the line [N].
    pub force: Vector2<f64>,
    /// γ, in the unit of W D² [N² m/N, N² m/(N s)]; `None` where the node sticks.
    pub multiplier: Option<f64>,
}

/// Friction of one node by [`slide`].
pub fn node_friction(holding: Vector2<f64>, compliance: Vector2<f64>, limits: Vector2<f64>) -> NodeFriction {
    let Slide {
        force,
        slides,
        multiplier,
    } = slide::<f64>(holding.into(), compliance.into(), limits.into());
    NodeFriction {
        force: force.into(),
        multiplier: (slides > 0.0).then_some(multiplier),
    }
}

impl NodeFriction {
    /// Slope of the friction with the holding force [-], at constant limits and unit compliances.
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
        assert_eq!(node_friction(inside, ONES, LIMITS).force, inside);
        assert_eq!(node_friction(inside, ONES, LIMITS).multiplier, None);
        for outside in [[41.0, 0.0], [-3.0, 300.0], [1e6, 1e-3], [-60.0, -60.0]] {
            let slides = node_friction(outside.into(), Vector2::new(0.3, 0.2), LIMITS);
            assert_relative_eq!(size(&slides.force), 1.0, max_relative = 1e-12);
            assert!(slides.multiplier.is_some());
        }
    }

    #[test]
    fn the_friction_along_each_axis_is_its_limit() {
        let force = |holding: [f64; 2]| node_friction(holding.into(), ONES, LIMITS).force;
        assert_relative_eq!(force([-900.0, 0.0]), Vector2::new(-40.0, 0.0));
        assert_relative_eq!(force([0.0, 900.0]), Vector2::new(0.0, 70.0));
    }

    #[test]
    fn sliding_dissipates_the_most() {
        let (holding, compliance) = (Vector2::new(-500.0, 300.0), Vector2::new(0.2, 0.25));
        let slides = node_friction(holding, compliance, LIMITS);
        let velocity = (slides.force - holding).component_mul(&compliance);
        let most = velocity.component_mul(&LIMITS).norm();
        assert_relative_eq!(-slides.force.dot(&velocity), most, max_relative = 1e-12);
    }

    #[test]
    fn without_friction_along_the_line_only_the_other_axis_holds() {
        let force =
            |holding: [f64; 2], limits: [f64; 2]| node_friction(holding.into(), ONES, limits.into()).force;
        assert_eq!(force([30.0, 50.0], [0.0, 70.0]), Vector2::new(0.0, 50.0));
        assert_relative_eq!(force([30.0, 90.0], [0.0, 70.0]), Vector2::new(0.0, 70.0));
        assert_eq!(force([3.0, 4.0], [0.0; 2]), Vector2::zeros());
    }

    #[test]
    fn the_slope_equals_central_differences() {
        for holding in [[20.0, -50.0], [50.0, 60.0], [-300.0, 10.0], [5.0, 500.0]] {
            let holding = Vector2::from(holding);
            let slope = node_friction(holding, ONES, LIMITS).slope(LIMITS);
            for axis in 0..2 {
                let force = |h: f64| node_friction(holding + h * Vector2::ith(axis, 1.0), ONES, LIMITS).force;
                let difference = central(1e-4, force);
                assert_relative_eq!(slope.column(axis).into_owned(), difference, epsilon = 1e-8);
            }
        }
    }

    #[test]
    fn a_line_that_stands_on_the_seabed_is_across_it_all_around() {
        let friction = Friction {
            axial: 0.4,
            transverse: 0.7,
        };
        let axes = Axes::new(Vector3::z(), Vector3::z());
        assert_relative_eq!(
            Vector2::from(friction.limits(axes.share, 10.0)),
            Vector2::new(7.0, 7.0)
        );
        let lying = Axes::new(Vector3::z(), Vector3::y());
        assert_relative_eq!(
            Vector2::from(friction.limits(lying.share, 10.0)),
            Vector2::new(4.0, 7.0)
        );
        assert_relative_eq!(axes.along.dot(&Vector3::z()), 0.0);
    }
}
