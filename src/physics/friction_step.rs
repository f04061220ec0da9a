//! Normal contact and Coulomb friction of a node over a step of the leapfrogs, both implicit.
//!
//! Without contact the node would leave the step with the velocity u. With M = m_n I + (m_t − m_n) t tᵀ, the seabed's
//! normal n and its plane's axes a, b, the actual velocity v and the impulses λ obey
//!
//! ```text
//! M (v − u) = λ_n n + λ_a a + λ_b b,   λ_n = a − b v_n ≥ 0,   (λ_a, λ_b) in the ellipse of λ_n
//! ```
//!
//! A node that sticks leaves with v_a = v_b = 0 to the last digit and does not drift. λ_n of the ellipse is that of a
//! sticking node, which is exact where the line lies in the plane of the seabed.
//!
//! Source: backward Euler on Coulomb's law, as in Moreau (1988), Unilateral contact and dry friction in finite freedom
//! dynamics, CISM 302; friction by [`super::friction`]. Stable for any stiffness; valid as `seabed` is.

use super::friction::{Axes, Friction, slide};
use super::slender::Slender;
use crate::math::real::{Real, RealVector, choose};

/// Node, or one in every lane, with its contact with the seabed.
#[derive(Debug, Clone, Copy)]
pub struct Landing<V: RealVector> {
    /// Inverse mass across the line, and its excess along the line [1/kg].
    pub inverse_mass: Slender<V::Real>,
    /// Direction t of the line [-].
    pub tangent: V,
    /// Normal n of the seabed [-].
    pub normal: V,
    /// Impulse a of the seabed's spring and damper on a node that does not leave it [N s].
    pub spring: V::Real,
    /// Loss b of that impulse with the velocity at which the node leaves the seabed [kg].
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

impl<V: RealVector> Landing<V> {
    /// Motion after the step of a node that would have the velocity `free` [m/s] without seabed.
    #[inline(always)]
    pub fn solve(&self, free: V, friction: Option<&Friction>) -> Landed<V> {
        let one = V::Real::splat(1.0);
        let (spring, resistance) = (self.spring, self.resistance);
        let rise = self.normal.inner(free);
        let response = self.inverse_mass.times(self.normal, self.tangent);
        let push = (spring - resistance * rise) * (one + resistance * self.normal.inner(response)).recip();
        let landed = Landed {
            velocity: choose(push, free + response.scaled(push), free),
            friction: V::of([V::Real::splat(0.0); 3]),
            pushed: push,
        };
        match friction {
            Some(friction) if landed.pushed.any_positive() => self.rub(free, friction, landed),
            _ => landed,
        }
    }

    /// The same with friction, where the seabed pushes a node that sticks; `smooth` is the motion without.
    #[inline(always)]
    fn rub(&self, free: V, friction: &Friction, smooth: Landed<V>) -> Landed<V> {
        let (spring, resistance) = (self.spring, self.resistance);
        let Slender { across: m, excess } = self.inverse_mass.inverted();
        let axes = Axes::new(self.normal, self.tangent);
        let upright = self.normal.inner(self.tangent);
        let lying = axes.along.inner(self.tangent);
        let momentum = Slender { across: m, excess }.times(free, self.tangent);
        let driven = self.normal.inner(momentum) + spring;
        let softness = (m + excess * upright * upright + resistance).recip();
        let push = spring - resistance * driven * softness; // of a node that sticks
        let coupling = excess * upright * lying;
        let along = m + excess * lying * lying - coupling * coupling * softness;
        let drive = axes.along.inner(momentum) - coupling * driven * softness;
        let zero = V::Real::splat(0.0);
        let holding = [zero - drive, zero - m * axes.across.inner(free)];
        let compliance = [along.recip(), self.inverse_mass.across];
        let slide = slide(holding, compliance, friction.limits(axes.share, push));
        let slid = [0, 1].map(|i| {
            let moved = (slide.force[i] - holding[i]) * compliance[i];
            slide.slides.choose(moved, zero)
        });
        let sinking = (driven - coupling * slid[0]) * softness;
        let pushes = smooth
            .pushed
            .choose(push.choose(spring - resistance * sinking, zero), zero);
        Landed {
            velocity: choose(
                pushes,
                axes.combine(slid) + self.normal.scaled(sinking),
                smooth.velocity,
            ),
            friction: choose(pushes, axes.combine(slide.force), smooth.friction),
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

    fn landing() -> Landing<Vector3<f64>> {
        Landing {
            inverse_mass: Slender::inverse([120.0, 100.0]),
            tangent: Vector3::new(0.9, 0.2, 0.15).normalize(),
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
        let mass = node.inverse_mass.inverted().matrix(node.tangent);
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
            tangent: turn * node.tangent,
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
            tangent: each(&|_| node.tangent),
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
