//! Tensions along a line at rest, one end of which moves rapidly along the line.
//!
//! At frequencies far above those of transverse waves, the tensions T_i of the segments are the only forces that move the nodes, a_i = M_i⁻¹(T_i t_i
//! − T_{i−1} t_{i−1}), with the unit vectors t_i of the segments. A segment with stiffness k and damping b is stretched by T_i/(k + iωb), so that
//!
//! −ω² T_i/(k + iωb) = t_i·(a_{i+1} − a_i),
//!
//! one equation per segment in three neighbouring tensions. Where the line bends, its transverse mass resists too: a node between segments at an
//! angle transmits less. The axial modes of hanging lines are therefore much higher than those of straight ones: 2.4 Hz instead of 1.3 Hz on
//! `lazy_wave`.
//!
//! Source: derived here; the limit of vanishing angles is the wave equation of a rod.

use nalgebra::Complex;

/// Equation of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TensionRow {
    /// Inverse masses of both nodes along the segment, t_iᵀ(M_i⁻¹ + M_{i+1}⁻¹)t_i; that of a node with prescribed motion is zero [1/kg].
    pub inverse_masses: f64,
    /// Inverse mass t_{i−1}ᵀ M_i⁻¹ t_i, which couples the segment to the previous one [1/kg].
    pub coupling: f64,
    /// Stiffness EA/l [N/m].
    pub stiffness: f64,
    /// Damping BA/l [N s/m].
    pub damping: f64,
}

impl TensionRow {
    /// Diagonal element [1/kg] after elimination of all previous segments, at a circular frequency [rad/s]. `before` is the diagonal element of the
    /// previous segment [1/kg], `loss` the loss factor of the stiffness [-].
    pub fn eliminated(&self, before: Option<Complex<f64>>, frequency: f64, loss: f64) -> Complex<f64> {
        let modulus = Complex::new(self.stiffness, loss * self.stiffness + frequency * self.damping);
        let own = self.inverse_masses - frequency * frequency * modulus.inv();
        match before {
            Some(before) => own - self.coupling * self.coupling * before.inv(),
            None => own,
        }
    }
}

/// Impedance [N s/m] of the end of a line, from the diagonal element of its last segment [1/kg] and the mass of its half node [kg].
pub fn impedance(last: Complex<f64>, mass: f64, frequency: f64) -> f64 {
    frequency * (last.inv() + mass).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTH: f64 = 200.0;
    const STIFFNESS: f64 = 2.5e8;
    /// Masses per length across and along the line [kg/m].
    const MASSES: [f64; 2] = [180.0, 115.0];

    /// Impedance relative to √(EA m_t) at the end of an arc of `count` segments whose other end is fixed, at a frequency [rad/s].
    fn relative(curvature: f64, frequency: f64, count: usize) -> f64 {
        let l = LENGTH / count as f64;
        let half_angle = 0.5 * curvature * l;
        let [across, along] = MASSES.map(|mass| 1.0 / (mass * l));
        let parts = [
            along * half_angle.cos().powi(2),
            across * half_angle.sin().powi(2),
        ];
        let row = |i: usize| TensionRow {
            inverse_masses: (parts[0] + parts[1]) * if i == 0 || i + 1 == count { 1.0 } else { 2.0 },
            coupling: parts[0] - parts[1],
            stiffness: STIFFNESS / l,
            damping: 0.0,
        };
        let rows = (0..count).map(row);
        let last = rows.fold(None, |before, row| Some(row.eliminated(before, frequency, 0.0)));
        impedance(last.unwrap(), 0.5 * MASSES[1] * l, frequency) / (STIFFNESS * MASSES[1]).sqrt()
    }

    #[test]
    fn a_straight_line_has_the_impedance_of_a_fixed_rod() {
        for frequency in [3.0, 10.0, 17.0, 30.0] {
            let phase = frequency * LENGTH * (MASSES[1] / STIFFNESS).sqrt();
            let (found, exact) = (relative(0.0, frequency, 400), (1.0 / phase.tan()).abs());
            assert!((found / exact - 1.0).abs() < 1e-3, "{frequency}: {found} {exact}");
        }
    }

    #[test]
    fn an_arc_has_the_impedance_of_a_softer_rod_and_passes_no_waves_below_its_ring_frequency() {
        let (curvature, ring) = (0.02, 0.02 * (STIFFNESS / MASSES[0]).sqrt());
        for frequency in [0.5 * ring, 1.2 * ring, 2.5 * ring] {
            let share: f64 = 1.0 - (ring / frequency).powi(2);
            let phase = frequency * LENGTH * (MASSES[1] * share.abs() / STIFFNESS).sqrt();
            let response = match share > 0.0 {
                true => (1.0 / phase.tan()).abs(),
                false => 1.0 / phase.tanh(),
            };
            let exact = response / share.abs().sqrt();
            let error = |count: usize| (relative(curvature, frequency, count) / exact - 1.0).abs();
            let [coarse, fine] = [400, 800].map(error);
            assert!(
                coarse < 0.02 && fine < 0.55 * coarse,
                "{frequency}: {coarse} {fine}"
            );
        }
    }
}
