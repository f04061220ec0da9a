//! Energy balance of the leapfrogs, over the steps since the state was loaded. It does not change the motion.
//!
//! Work on the free nodes in a step, with the velocities v of t_{n−½} and t_{n+½}:
//!
//!   ½ Δt Σ [−T q·Δ(v_{n−½} + v_{n+½}) + (p − w ẑ)·(v_{n−½} + v_{n+½})]
//!
//! with the tension T, the Froude-Krylov force p and the weight w. This work and the work of the drag on the moving water are dissipated, except for the
//! kinetic energy at the end of the steps ([`crate::dynamics::energy_balance`]). The [`super::Kernel`]s add the work, and define the elastic part of T.

use nalgebra::Vector3;

use super::{ENDS, LeapfrogLine};
use crate::dynamics::energy_balance::Flow;
use crate::math::lanes::Lanes;

/// Work and dissipation since the state was loaded.
#[derive(Debug, Clone)]
pub(super) struct LineBalance {
    /// Work on the free nodes, and work of an implicit tension on dampers [J].
    pub work: Lanes,
    /// Work of the moving water [J].
    pub water_work: Lanes,
    /// Algorithmic dissipation by the averaging of tensions [J].
    pub algorithmic: Lanes,
    /// Work of prescribed ends, of releases and of the winch [J].
    pub external_work: f64,
    /// Work on dampers next to the ends, and of viscoelastic dampers; kinetic energy that external work has supplied [J].
    pub dissipation: f64,
    /// Positions of the ends at t_n − Δt/2 [m].
    pub half_places: [Vector3<f64>; 2],
    /// Forces of the end springs on the ends at t_n [N], if the tension is explicit.
    pub springs: [Vector3<f64>; 2],
}

impl Default for LineBalance {
    fn default() -> LineBalance {
        let (zero, nowhere) = (Lanes::splat(0.0), [Vector3::zeros(); 2]);
        LineBalance {
            work: zero,
            water_work: zero,
            algorithmic: zero,
            external_work: 0.0,
            dissipation: 0.0,
            half_places: nowhere,
            springs: nowhere,
        }
    }
}

impl<K> LeapfrogLine<K> {
    /// Energy flow since the state was loaded [J]. The dissipation includes the kinetic energy. Zero without an energy balance.
    pub(super) fn flow(&self) -> Flow {
        let Some(balance) = &self.balance else {
            return Flow::default();
        };
        let lifted = self.layout.surface.as_ref().map_or(0.0, |surface| surface.lifted);
        Flow {
            external_work: balance.external_work + balance.water_work.sum() + lifted,
            dissipation: balance.work.sum() + balance.dissipation,
            algorithmic_dissipation: balance.algorithmic.sum(),
        }
    }

    pub(super) fn clear_balance(&mut self) {
        if let Some(balance) = &mut self.balance {
            let half_places = balance.half_places;
            *balance = LineBalance {
                half_places,
                ..LineBalance::default()
            };
        }
        if let Some(surface) = &mut self.layout.surface {
            surface.lifted = 0.0;
        }
    }

    /// Records the positions of the ends `lag` [s] ago.
    pub(super) fn set_out(&mut self, lag: f64) {
        if let Some(balance) = &mut self.balance {
            let ends = ENDS.map(|end| self.layout.end_slot(end));
            balance.half_places = ends.map(|at| self.layout.place_before(at, lag));
        }
    }

    /// Adds external work [J], and the part of it that is kinetic energy [J].
    pub(super) fn supply(&mut self, [energy, kinetic]: [f64; 2]) {
        if let Some(balance) = &mut self.balance {
            balance.external_work += energy;
            balance.dissipation += kinetic;
        }
    }
}
