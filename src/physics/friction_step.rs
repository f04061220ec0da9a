//! Normal contact and Coulomb friction of a node over a step of the leapfrogs, both implicit.
//!
//! Without contact the node would leave the step with the velocity u. With M = m_n I + (m_t − m_n) t tᵀ, the normal n of the seabed and the axes a, b
//! of its plane, the actual velocity v and the impulses λ obey
//!
//! ```text
//! M (v − u) = λ_n n + λ_a a + λ_b b,   λ_n = a − b v_n ≥ 0,   (λ_a, λ_b) in the ellipse of λ_n
//! ```
//!
//! A sticking node leaves the step with v_a = v_b = 0 to the last digit and does not drift. λ_n of the ellipse is that of a sticking node, which is
//! exact where the line lies in the plane of the seabed.
//!
//! a is along the in-plane part of the line, so that t has no part along b. In these axes W = M⁻¹ has a block of n and a with the determinant 1/(m_n
//! m_t), and 1/m_n for b. W gives v without M:
//!
//! ```text
//! sticks    v_n = (W_aa u_n − W_na u_a + a/(m_n m_t))/(W_aa + b/(m_n m_t))
//! smooth    λ_n = (a − b u_n)/(1 + b W_nn),   v_a = u_a + W_na λ_n,   to λ_a with the compliance (W_aa + b/(m_n m_t))/(1 + b W_nn)
//! ```
//!
//! Source: backward Euler on Coulomb's law, as in Moreau (1988), Unilateral contact and dry friction in finite freedom
//! dynamics, CISM 302; friction by [`super::friction`]. Stable for any stiffness; valid where `seabed` is.

use super::friction::{Axes, Friction, Slide, slide};
use super::slender::Slender;
use crate::math::real::{Real, RealVector, choose};

/// Node in contact with the seabed, or one in every lane.
#[derive(Debug, Clone, Copy)]
pub struct Landing<V: RealVector> {
    /// Inverse mass across the line, and its excess along the line [1/kg].
    pub inverse_mass: Slender<V::Real>,
    /// Vector along the line [m].
    pub chord: V,
    /// 1 over the square of its length [1/m²].
    pub inverse_square: V::Real,
    /// Normal n of the seabed [-].
    pub normal: V,
    /// Impulse a of the seabed's spring and damper on a node that does not leave it [N s].
    pub spring: V::Real,
    /// Reduction b of that impulse per velocity at which the node leaves the seabed [kg].
    pub resistance: V::Real,
}

/// Motion of a node after the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landed<V: RealVector> {
    /// Velocity [m/s].
    pub velocity: V,
    /// Impulse of friction [N s].
    pub friction: V,
    /// Positive where the seabed pushes.
    pub pushed: V::Real,
}

/// Inverse mass W of a node in the axes of the seabed under it.
#[derive(Debug, Clone, Copy)]
pub struct Footing<V: RealVector> {
    /// Axes in the plane.
    pub axes: Axes<V>,
    /// 1 over the square of the length of the axes.
    pub inverse_square: V::Real,
    /// W_aa and W_bb along and across the line [1/kg].
    pub yields: [V::Real; 2],
    /// W_na divided by the length of the axes, and multiplied by it [1/kg].
    pub coupling: [V::Real; 2],
    /// Determinant of the block of n and a [1/kg²].
    pub determinant: V::Real,
}

impl<V: RealVector> Footing<V> {
    /// Footing of a node with an inverse mass [1/kg], on a line along the vector `line`, of any length; `inverse_square` is 1/|line|².
    #[inline(always)]
    pub fn new(inverse: Slender<V::Real>, normal: V, line: V, inverse_square: V::Real) -> Footing<V> {
        let Slender { across, excess } = inverse;
        let axes = Axes::new(normal, line, inverse_square);
        let (square, lying) = (axes.square.recip(), line.inner(axes.along));
        let along = excess * inverse_square * lying; // b (t·A) t
        let lean = along * normal.inner(line);
        Footing {
            axes,
            inverse_square: square,
            yields: [across + along * lying * square, across],
            coupling: [lean * square, lean],
            determinant: across * (across + excess),
        }
    }

    /// 1 over W_aa + b/(m_n m_t) [kg] of nodes on a seabed that resists with `resistance` b [kg].
    #[inline(always)]
    pub fn stuck(&self, resistance: V::Real) -> V::Real {
        (self.yields[0] + self.determinant * resistance).recip()
    }

    /// Velocity at which a sticking node leaves the seabed [m/s], from its velocity `free` without contact [m/s], the impulse `spring` [N s] and
    /// [`Self::stuck`].
    #[inline(always)]
    pub fn sinking(&self, free: V, normal: V, spring: V::Real, stuck: V::Real) -> V::Real {
        let [rise, along] = [normal.inner(free), self.axes.along.inner(free)];
        (self.yields[0] * rise - self.coupling[0] * along + self.determinant * spring) * stuck
    }

    /// Friction of a node whose frictionless velocity has the components `sliding` [m/s, times the length of the axes].
    #[inline(always)]
    pub fn slide(
        &self,
        sliding: [V::Real; 2],
        along: V::Real,
        friction: &Friction,
        push: V::Real,
    ) -> Slide<V::Real> {
        let [a, b] = sliding;
        let velocity = [a * a * self.inverse_square, b * b * self.inverse_square];
        let squares = friction.squares(self.axes.share);
        slide(velocity, [along, self.yields[1]], squares, push)
    }

    /// Vector with these components [times the length of the axes], each multiplied by a factor.
    #[inline(always)]
    pub fn combine(&self, [a, b]: [V::Real; 2], factors: [V::Real; 2]) -> V {
        let scale = self.inverse_square;
        self.axes
            .combine([a * factors[0] * scale, b * factors[1] * scale])
    }
}

impl<V: RealVector> Landing<V> {
    /// Motion after the step of a node that would have the velocity `free` [m/s] without the seabed.
    #[inline(always)]
    pub fn solve(&self, free: V, friction: Option<&Friction>) -> Landed<V> {
        let (spring, resistance) = (self.spring, self.resistance);
        let Slender { across, excess } = self.inverse_mass;
        let rise = self.normal.inner(free);
        let lean = self.normal.inner(self.chord);
        let along = excess * self.inverse_square * lean;
        let response = self.normal.scaled(across) + self.chord.scaled(along);
        let yields = across + along * lean; // W_nn
        let softness = (V::Real::splat(1.0) + resistance * yields).recip();
        let push = (spring - resistance * rise) * softness;
        let smooth = Landed {
            velocity: choose(push, free + response.scaled(push), free),
            friction: V::of([V::Real::splat(0.0); 3]),
            pushed: push,
        };
        match friction {
            Some(friction) if push.any_positive() => {
                self.with_friction((free, friction), [yields, softness], smooth)
            }
            _ => smooth,
        }
    }

    /// Motion with friction where the seabed pushes a sticking node; `smooth` is the motion without friction, `yields` W_nn and `softness` 1/(1 + b
    /// W_nn).
    #[inline(always)]
    fn with_friction(
        &self,
        (free, friction): (V, &Friction),
        [yields, softness]: [V::Real; 2],
        smooth: Landed<V>,
    ) -> Landed<V> {
        let (zero, spring, resistance) = (V::Real::splat(0.0), self.spring, self.resistance);
        let footing = Footing::new(self.inverse_mass, self.normal, self.chord, self.inverse_square);
        let hard = footing.yields[0] + footing.determinant * resistance;
        let sinking = footing.sinking(free, self.normal, spring, hard.recip());
        let push = spring - resistance * sinking; // of a node that sticks
        let sliding = [
            footing.axes.along.inner(free) + footing.coupling[1] * smooth.pushed,
            footing.axes.across.inner(free),
        ];
        let found = footing.slide(sliding, hard * softness, friction, push);
        let rise = self.normal.inner(free) - found.grip[0] * sliding[0] * footing.coupling[0];
        let pressed = (spring - resistance * rise) * softness;
        let pushes = smooth.pushed.choose(push.choose(pressed, zero), zero);
        let velocity = footing.combine(sliding, found.left) + self.normal.scaled(rise + yields * pressed);
        let against = [zero - found.grip[0], zero - found.grip[1]];
        Landed {
            velocity: choose(pushes, velocity, smooth.velocity),
            friction: choose(pushes, footing.combine(sliding, against), smooth.friction),
            pushed: smooth.pushed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::{Rotation3, Vector3};

    use crate::math::lanes::{LANES, Lanes, Vectors};

    const CHORD: Vector3<f64> = Vector3::new(0.9, 0.2, 0.15);

    fn landing() -> Landing<Vector3<f64>> {
        Landing {
            inverse_mass: Slender::inverse([120.0, 100.0]),
            chord: CHORD,
            inverse_square: 1.0 / CHORD.norm_squared(),
            normal: Vector3::z(),
            spring: 10.0,
            resistance: 85.0,
        }
    }

    const ROUGH: Friction = Friction {
        axial: 0.4,
        transverse: 0.7,
    };

    /// Impulse of the seabed excluding friction [N s].
    fn push(node: &Landing<Vector3<f64>>, free: Vector3<f64>, landed: &Landed<Vector3<f64>>) -> Vector3<f64> {
        let mass = node.inverse_mass.inverted().matrix(node.chord.normalize());
        mass * (landed.velocity - free) - landed.friction
    }

    #[test]
    fn what_the_node_leaves_with_is_in_balance_with_the_laws() {
        let node = landing();
        for free in [[0.0, 0.0, -0.1], [0.05, -0.3, -0.2], [2.0, 1.0, 0.1]] {
            let free = Vector3::from(free);
            for friction in [None, Some(&ROUGH)] {
                let landed = node.solve(free, friction);
                let impulse = (node.spring - node.resistance * landed.velocity.z) * Vector3::z();
                assert_relative_eq!(push(&node, free, &landed), impulse, epsilon = 1e-10);
            }
        }
    }

    #[test]
    fn a_node_that_sticks_does_not_move_along_the_seabed_by_a_digit() {
        let velocity = landing()
            .solve(Vector3::new(1e-3, 2e-3, 0.0), Some(&ROUGH))
            .velocity;
        assert_eq!((velocity.x, velocity.y), (0.0, 0.0));
    }

    #[test]
    fn a_rotated_world_rotates_what_happens() {
        let (node, free) = (landing(), Vector3::new(0.4, -0.3, -0.05));
        let turn = Rotation3::from_euler_angles(0.3, -0.8, 1.2);
        let turned = Landing {
            chord: turn * node.chord,
            normal: turn * node.normal,
            ..node
        };
        let here = node.solve(free, Some(&ROUGH));
        let there = turned.solve(turn * free, Some(&ROUGH));
        assert_relative_eq!(turn * here.velocity, there.velocity, epsilon = 1e-14);
        assert_relative_eq!(turn * here.friction, there.friction, epsilon = 1e-12);
    }

    #[test]
    fn the_seabed_never_pulls() {
        let rises = Vector3::new(0.0, 0.0, 5.0);
        let landed = landing().solve(rises, Some(&ROUGH));
        assert!(landed.velocity == rises && landed.friction == Vector3::zeros());
        let above = Landing {
            spring: -10.0,
            ..landing()
        };
        assert_eq!(
            above.solve(Vector3::zeros(), Some(&ROUGH)).velocity,
            Vector3::zeros()
        );
    }

    #[test]
    fn four_nodes_at_once_move_as_each_alone() {
        let frees = [
            [0.0, 0.0, -0.1],
            [0.05, -0.3, -0.2],
            [2.0, 1.0, 0.1],
            [0.0, 0.0, 5.0],
        ]
        .map(Vector3::from);
        let each = |f: &dyn Fn(usize) -> Vector3<f64>| {
            let mut all = Vectors::zero();
            (0..LANES).for_each(|lane| all.set(lane, f(lane)));
            all
        };
        let node = landing();
        let lanes = Landing {
            inverse_mass: Slender {
                across: Lanes::splat(node.inverse_mass.across),
                excess: Lanes::splat(node.inverse_mass.excess),
            },
            chord: each(&|_| node.chord),
            inverse_square: Lanes::splat(node.inverse_square),
            normal: each(&|_| node.normal),
            spring: Lanes::splat(node.spring),
            resistance: Lanes::splat(node.resistance),
        };
        let together = lanes.solve(each(&|lane| frees[lane]), Some(&ROUGH));
        for (lane, free) in frees.into_iter().enumerate() {
            let alone = node.solve(free, Some(&ROUGH));
            assert_eq!(together.velocity.get(lane), alone.velocity);
            assert_eq!(together.friction.get(lane), alone.friction);
        }
    }
}
