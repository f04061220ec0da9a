//! Coulomb friction between a line and the seabed it lies on, with stick.
//!
//! In the plane of the seabed, with the axes a along the line and b across it and the normal force N, the friction (f_a, f_b) stays in an ellipse,
//!
//! ```text
//! (f_a/D_a)² + (f_b/D_b)² ≤ 1,   D_a = N √(μ_a² s² + μ_b² (1 − s²)),   D_b = μ_b N
//! ```
//!
//! with s the part of the line's tangent that lies in the plane: for a line normal to the seabed, every direction is across. Inside the ellipse
//! nothing slides. On it the line slides in the direction of maximum dissipation, v_i ∝ −f_i/D_i², so that the friction is D_a against a line dragged
//! along its axis, D_b across. With the velocity v⁰ at which a node would slide without friction, and the compliance C_i of sliding to force along
//! the axes,
//!
//! ```text
//! f_i = −v⁰_i m_i² N/(C_i m_i² N + γ),   v_i = v⁰_i γ/(C_i m_i² N + γ),   m_i = D_i/N,   γ ≥ 0 such that f lies in the ellipse.
//! ```
//!
//! A node sticks with γ = 0. Neither the force that would hold it, −v⁰_i/C_i, nor the sign of v⁰ is required: the square of v⁰ suffices, and axes of
//! any length give it without a square root.
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

/// Axes in the plane of the seabed, of the same length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes<V: RealVector = Vector3<f64>> {
    /// Along the line.
    pub along: V,
    /// Across the line.
    pub across: V,
    /// Square of the length of the axes.
    pub square: V::Real,
    /// Square of the part s of the line's tangent that lies in the plane [-].
    pub share: V::Real,
}

/// In-plane part of the tangent below which a line is treated as normal to the seabed [-].
const STANDING: f64 = 1e-9;
/// Relative distance from the ellipse within which nodes slide, so that rounding of their positions does not decide [-].
const BORDER: f64 = 1e-7;
/// Relative error of the size of the ellipse that one more correction of γ, which squares it, reduces to rounding [-].
const NEAR: f64 = 1e-8;
/// Maximum number of iterations for γ.
const ITERATIONS_MAX: usize = 30;

impl<V: RealVector> Axes<V> {
    /// Axes of a line along the vector `line`, of any length, on a seabed with the unit normal `normal`; `inverse_square` is 1/|line|². The axes are
    /// as long as the in-plane part of `line`, except for a line normal to the seabed.
    #[inline(always)]
    pub fn new(normal: V, line: V, inverse_square: V::Real) -> Axes<V> {
        let [zero, one] = [0.0, 1.0].map(V::Real::splat);
        let mut along = line - normal.scaled(normal.inner(line));
        let mut square = along.inner(along);
        let share = square * inverse_square;
        let lies = share - V::Real::splat(STANDING * STANDING);
        if (zero - lies).any_positive() {
            let leans = normal.components()[0].abs() - V::Real::splat(0.7);
            let level = choose(leans, V::of([zero, one, zero]), V::of([one, zero, zero]));
            let level = normal.crossed(level);
            along = choose(lies, along, level);
            square = lies.choose(square, level.inner(level));
        }
        Axes {
            along,
            across: normal.crossed(along),
            square,
            share,
        }
    }

    /// Vector from its components along the axes, each divided by the length of the axes.
    #[inline(always)]
    pub fn combine(&self, [along, across]: [V::Real; 2]) -> V {
        self.along.scaled(along) + self.across.scaled(across)
    }
}

impl Axes {
    /// Unit axes of a line along the unit vector `tangent` on a seabed with the unit normal `normal`.
    pub fn unit(normal: Vector3<f64>, tangent: Vector3<f64>) -> Axes {
        let axes = Axes::new(normal, tangent, 1.0);
        let along = axes.along * axes.square.sqrt().recip();
        Axes {
            along,
            across: normal.cross(&along),
            square: 1.0,
            share: axes.share,
        }
    }

    /// Components of a vector along the axes, in the unit of the vector [-].
    pub fn components(&self, vector: &Vector3<f64>) -> Vector2<f64> {
        Vector2::new(self.along.dot(vector), self.across.dot(vector))
    }

    /// Vector with these components along the axes, in their unit [-].
    pub fn vector(&self, components: &Vector2<f64>) -> Vector3<f64> {
        components.x * self.along + components.y * self.across
    }
}

impl Friction {
    /// Larger of the coefficients [-].
    pub fn greatest(&self) -> f64 {
        self.axial.max(self.transverse)
    }

    /// Squares of the semi-axes of the ellipse per normal force [-], along and across a line; `share` is the square of the in-plane part of its
    /// tangent [-].
    #[inline(always)]
    pub fn squares<R: Real>(&self, share: R) -> [R; 2] {
        let one = R::splat(1.0);
        let lying = (share - one).choose(one, share);
        let [axial, transverse] = [self.axial, self.transverse].map(|part| R::splat(part * part));
        [lying * axial + (one - lying) * transverse, transverse]
    }

    /// Semi-axes of the ellipse [N] along and across a line with these axes, under a normal force [N].
    pub fn limits(&self, axes: &Axes, normal_force: f64) -> Vector2<f64> {
        Vector2::from(self.squares(axes.share)).map(|square| square.sqrt() * normal_force)
    }
}

/// Friction at a node along and across the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slide<R> {
    /// Friction against the frictionless velocity, per unit of that velocity [N s/m, or kg for impulses].
    pub grip: [R; 2],
    /// Remaining fraction of that velocity [-]; 0 where the node sticks.
    pub left: [R; 2],
    /// Positive where the node slides.
    pub slides: R,
    /// γ of nodes that slide [m/s].
    pub multiplier: R,
}

/// Friction at a node that would slide without it, from values along and across the line: squares of the frictionless velocities [m²/s²], compliances
/// [m/(N s), or 1/kg for impulses] and squares of the semi-axes per normal force [-].
#[inline(always)]
pub fn slide<R: Real>(velocity: [R; 2], compliance: [R; 2], squares: [R; 2], normal_force: R) -> Slide<R> {
    let [zero, one] = [0.0, 1.0].map(R::splat);
    let firm = [squares[0] * normal_force, squares[1] * normal_force];
    let yields = [compliance[0] * firm[0], compliance[1] * firm[1]]; // C m² N
    let (a, b) = (yields[0].choose(yields[0], one), yields[1].choose(yields[1], one));
    let weights = [velocity[0] * squares[0], velocity[1] * squares[1]];
    let both = a * b;
    let outside =
        weights[0] * b * b + weights[1] * a * a - R::splat((1.0 - BORDER) * (1.0 - BORDER)) * both * both;
    let (mut gamma, mut open) = (zero, outside);
    for _ in 0..ITERATIONS_MAX {
        if !open.any_positive() {
            break;
        }
        // Newton's method on 1/|f/D|, which is nearly linear in γ, with one square root and one quotient that do not depend on each other
        let (p, q) = (a + gamma, b + gamma);
        let (along, across) = (weights[0] * q * q, weights[1] * p * p);
        let slope = (along * q + across * p).max(R::splat(f64::MIN_POSITIVE));
        let square = along + across;
        let excess = square.sqrt() - p * q;
        let change = square * excess * slope.recip();
        gamma = open.choose((gamma + change).max(zero), gamma);
        open = open.choose(excess.abs() - R::splat(NEAR) * p * q, zero);
    }
    let (p, q) = (a + gamma, b + gamma);
    let softness = (p * q).recip();
    let over = [q * softness, p * softness];
    let left = [
        yields[0].choose(gamma * over[0], one),
        yields[1].choose(gamma * over[1], one),
    ];
    // without friction along an axis, any force causes sliding
    let free = [
        yields[0].choose(zero, velocity[0]),
        yields[1].choose(zero, velocity[1]),
    ];
    Slide {
        grip: [firm[0] * over[0], firm[1] * over[1]],
        left,
        slides: outside.max(free[0].max(free[1])),
        multiplier: gamma,
    }
}

/// Friction at one node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeFriction {
    /// Friction along and across the line [N].
    pub force: Vector2<f64>,
    /// γ, in the unit of W D² [N² m/N, N² m/(N s)]; `None` where the node sticks.
    pub multiplier: Option<f64>,
}

/// Friction of one node by [`slide`]: the force `holding` [N] that would hold it, limited to the ellipse of the semi-axes `limits` [N].
pub fn node_friction(holding: Vector2<f64>, compliance: Vector2<f64>, limits: Vector2<f64>) -> NodeFriction {
    let (speed, squares) = (holding.component_mul(&compliance), limits.component_mul(&limits));
    let velocity = speed.component_mul(&speed);
    let found = slide::<f64>(velocity.into(), compliance.into(), squares.into(), 1.0);
    let slides = found.slides > 0.0;
    let force = Vector2::from(found.grip).component_mul(&speed);
    NodeFriction {
        force: if slides { force } else { holding },
        multiplier: slides.then_some(found.multiplier),
    }
}

impl NodeFriction {
    /// Slope of the friction with respect to the holding force [-], at constant limits and unit compliances.
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
        let axes = Axes::unit(Vector3::z(), Vector3::z());
        assert_relative_eq!(friction.limits(&axes, 10.0), Vector2::new(7.0, 7.0));
        let lying = Axes::unit(Vector3::z(), Vector3::y());
        assert_relative_eq!(friction.limits(&lying, 10.0), Vector2::new(4.0, 7.0));
        assert_relative_eq!(axes.along.dot(&Vector3::z()), 0.0);
    }
}
