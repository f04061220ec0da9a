//! Normal contact and Coulomb friction of a node over a step of the leapfrogs, both implicit.
//!
//! The node would leave the step with the velocity u. With M = m_n I + (m_t − m_n) t tᵀ, the bed's normal n and its
//! plane's axes a, b, the velocity v it does leave with and the impulses λ obey
//!
//! ```text
//! M (v − u) = λ_n n + λ_a a + λ_b b,   λ_n = Δt (k p − (k Δt + c) v_n) ≥ 0,   (λ_a, λ_b) in the ellipse of λ_n
//! ```
//!
//! A node that sticks leaves with v_a = v_b = 0 to the last digit: it does not creep. λ_n of the ellipse is that of the node if it stuck, which is
//! the same where the line lies in the plane of the bed.
//!
//! Source: backward Euler on Coulomb's law, as in Moreau (1988), Unilateral contact and dry friction in finite freedom
//! dynamics, CISM 302; friction by [`super::friction`]. Stable for any stiffness; valid as `seabed` is.

use nalgebra::{Vector2, Vector3};

use super::friction::{Axes, Friction, held};
use super::seabed::ContactCoefficients;

/// A node and how it meets the bed.
#[derive(Debug, Clone, Copy)]
pub struct Landing {
    /// Mass across and along the line [kg].
    pub mass: [f64; 2],
    /// Direction t of the line [-].
    pub tangent: Vector3<f64>,
    /// Normal n of the bed [-].
    pub normal: Vector3<f64>,
    /// Distance p below the level from which the bed pushes [m].
    pub penetration: f64,
    /// Spring and damper.
    pub coefficients: ContactCoefficients,
    /// Δt of the velocities and of the positions [s].
    pub steps: [f64; 2],
}

/// What a node leaves the step with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landed {
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Impulse of the bed [N s].
    pub impulse: Vector3<f64>,
    /// The part of it in the plane of the bed [N s].
    pub rub: Vector3<f64>,
}

impl Landing {
    /// What a node leaves the step with that would have the velocity `free` [m/s]; `None` where the bed does not push.
    pub fn solve(&self, free: Vector3<f64>, friction: Option<&Friction>) -> Option<Landed> {
        let [normal_mass, along_mass] = self.mass;
        let [kick, drift] = self.steps;
        let k = self.coefficients;
        let resistance = kick * (k.stiffness * drift + k.damping);
        let rise = self.normal.dot(&free);
        let upright = self.normal.dot(&self.tangent);
        let excess = 1.0 / along_mass - 1.0 / normal_mass;
        let response = self.normal / normal_mass + excess * upright * self.tangent; // M⁻¹n
        let spring = kick * k.stiffness * self.penetration;
        let push = (spring - resistance * rise) / (1.0 + resistance * self.normal.dot(&response));
        if self.penetration - drift * rise <= 0.0 || push <= 0.0 {
            return None;
        }
        let rubbed = friction.and_then(|friction| self.rub(free, spring, resistance, friction));
        Some(rubbed.unwrap_or(Landed {
            velocity: free + push * response,
            impulse: push * self.normal,
            rub: Vector3::zeros(),
        }))
    }

    /// With friction; `None` where the bed would not push a node that sticks.
    fn rub(&self, free: Vector3<f64>, spring: f64, resistance: f64, friction: &Friction) -> Option<Landed> {
        let [m, along_mass] = self.mass;
        let axes = Axes::new(self.normal, self.tangent);
        let (upright, excess) = (self.normal.dot(&self.tangent), along_mass - m);
        let lying = axes.along.dot(&self.tangent);
        let momentum = m * free + excess * self.tangent.dot(&free) * self.tangent;
        let driven = self.normal.dot(&momentum) + spring;
        let stiff = m + excess * upright * upright + resistance;
        let push = spring - resistance * driven / stiff; // of a node that sticks
        if push <= 0.0 {
            return None;
        }
        let coupling = excess * upright * lying;
        let along = m + excess * lying * lying - coupling * coupling / stiff;
        let drive = axes.along.dot(&momentum) - coupling * driven / stiff;
        let across = axes.across.dot(&free);
        let holding = Vector2::new(-drive, -m * across);
        let compliance = Vector2::new(1.0 / along, 1.0 / m);
        let held = held(holding, compliance, friction.limits(&axes, push));
        let slid = match held.multiplier {
            None => Vector2::zeros(),
            Some(_) => (held.force - holding).component_mul(&compliance),
        };
        let sinking = (driven - coupling * slid.x) / stiff;
        let rub = axes.vector(&held.force);
        let push = spring - resistance * sinking;
        (push > 0.0).then(|| Landed {
            velocity: axes.vector(&slid) + sinking * self.normal,
            impulse: push * self.normal + rub,
            rub,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::{Matrix3, Rotation3};

    fn landing() -> Landing {
        Landing {
            mass: [120.0, 100.0],
            tangent: Vector3::new(0.9, 0.2, 0.15).normalize(),
            normal: Vector3::z(),
            penetration: 0.01,
            coefficients: ContactCoefficients {
                stiffness: 5e4,
                damping: 3e3,
            },
            steps: [0.02, 0.025],
        }
    }

    const ROUGH: Friction = Friction {
        axial: 0.4,
        transverse: 0.7,
    };

    fn balance(node: &Landing, free: Vector3<f64>, landed: &Landed) -> Vector3<f64> {
        let [m, along] = node.mass;
        let t = node.tangent;
        let mass = m * Matrix3::identity() + (along - m) * t * t.transpose();
        mass * (landed.velocity - free) - landed.impulse
    }

    #[test]
    fn what_the_node_leaves_with_is_in_balance_with_the_laws() {
        let node = landing();
        for free in [[0.0, 0.0, -0.1], [0.05, -0.3, -0.2], [2.0, 1.0, 0.1]] {
            let free = Vector3::from(free);
            for friction in [None, Some(&ROUGH)] {
                let landed = node.solve(free, friction).unwrap();
                assert_relative_eq!(balance(&node, free, &landed), Vector3::zeros(), epsilon = 1e-10);
                let k = node.coefficients;
                let resistance = k.stiffness * node.steps[1] + k.damping;
                let push = k.stiffness * node.penetration - resistance * landed.velocity.z;
                assert_relative_eq!(landed.impulse.z, node.steps[0] * push, epsilon = 1e-10);
            }
        }
    }

    #[test]
    fn a_node_that_sticks_does_not_move_along_the_bed_by_a_digit() {
        let landed = landing().solve(Vector3::new(1e-3, 2e-3, 0.0), Some(&ROUGH));
        let velocity = landed.unwrap().velocity;
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
        let here = node.solve(free, Some(&ROUGH)).unwrap();
        let there = turned.solve(turn * free, Some(&ROUGH)).unwrap();
        assert_relative_eq!(turn * here.velocity, there.velocity, epsilon = 1e-14);
        assert_relative_eq!(turn * here.impulse, there.impulse, epsilon = 1e-12);
    }

    #[test]
    fn the_bed_never_pulls() {
        assert_eq!(landing().solve(Vector3::new(0.0, 0.0, 5.0), Some(&ROUGH)), None);
        let above = Landing {
            penetration: -0.01,
            ..landing()
        };
        assert_eq!(above.solve(Vector3::zeros(), Some(&ROUGH)), None);
    }
}
