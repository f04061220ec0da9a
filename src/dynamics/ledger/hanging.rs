//! Energy of a line on its closed-form catenary.
//!
//! Of every piece that hangs free, with the weight w per length, the upward part V = V₀ + w s of the tension T and its horizontal part H,
//!
//!   ∫ T² ds = h (H² + (V₀² + V₀V₁ + V₁²)/3),
//!   ∫ z ds  = z₀ h + ∫ (T − T₀)/w ds + ∫ (V² − V₀²)/(2 EA w) ds,
//!
//! to which comes what lies on the bed under the mean of the squares of its ends' tensions.
//!
//! Source: integrals of the elastic catenary, derived here, checked by sums. Valid as `physics::catenary` is.

use super::Energy;
use crate::model::{ClosedForm, Line, LineState};

/// Energy of a whole line on its closed form.
pub(super) fn catenary_energy(line: &Line, shape: &LineState, closed_form: &ClosedForm) -> Energy {
    let (segments, n) = (&line.segments, line.segment_count());
    let mut section_end = 0.0;
    let mut ends = line.sections.iter().map(|section| {
        section_end += section.length;
        (section_end, section.weight)
    });
    let (mut end, mut weight) = ends.next().unwrap_or((0.0, 0.0));
    let pull = closed_form.end_force[0];
    let horizontal = pull.xy().norm();
    let mut vertical = pull.z; // upward part of the tension from A to B [N]
    let mut energy = Energy::default();
    for i in 0..n {
        let (h, ea) = (segments.length[i], segments.axial_stiffness[i]);
        while line.nodes.arc[i] + 0.5 * h > end {
            (end, weight) = ends.next().unwrap_or((f64::INFINITY, weight));
        }
        let [low, high] = [i, i + 1].map(|node| {
            let contact = line.nodes.contact.as_ref();
            let height = shape.position[node].z;
            let lies = contact.is_some_and(|contact| height <= contact.bed);
            (height, closed_form.tension[node], lies)
        });
        let rising = (high.1 * high.1 - horizontal * horizontal).max(0.0).sqrt();
        let hanging = match (low.2, high.2) {
            (true, true) => 0.0,
            (true, false) => rising / weight,
            (false, true) => -vertical / weight,
            (false, false) => h,
        };
        let part = Hanging {
            length: if weight == 0.0 {
                0.0
            } else {
                hanging.clamp(0.0, h)
            },
            weight,
            axial_stiffness: ea,
            horizontal,
            vertical: if low.2 { 0.0 } else { vertical },
        };
        let rest = h - part.length;
        let squares = part.squared_tension() + 0.5 * rest * (low.1 * low.1 + high.1 * high.1);
        energy.axial += squares / (2.0 * ea);
        let mean = if weight == 0.0 || low.2 {
            low.0
        } else {
            high.0
        };
        energy.gravitational += weight * (part.height(low.0) + rest * mean);
        vertical = part.vertical + weight * part.length;
    }
    energy
}

/// A piece of an elastic catenary that hangs free.
struct Hanging {
    /// Unstretched length [m].
    length: f64,
    /// Weight [N/m], not 0 unless there is no length.
    weight: f64,
    /// EA [N].
    axial_stiffness: f64,
    /// Horizontal tension [N].
    horizontal: f64,
    /// Upward part of the tension at its start [N].
    vertical: f64,
}

impl Hanging {
    fn end(&self) -> f64 {
        self.vertical + self.weight * self.length
    }

    /// ∫ T² ds [N² m].
    fn squared_tension(&self) -> f64 {
        let (v0, v1) = (self.vertical, self.end());
        self.length * (self.horizontal.powi(2) + (v0 * v0 + v0 * v1 + v1 * v1) / 3.0)
    }

    /// ∫ z ds [m²] from a height [m] at its start: z = z₀ + (T − T₀)/w + (V² − V₀²)/(2 EA w).
    fn height(&self, start: f64) -> f64 {
        if self.length == 0.0 {
            return 0.0;
        }
        let (h, w, v0, v1) = (self.length, self.weight, self.vertical, self.end());
        let tension = |v: f64| self.horizontal.hypot(v);
        let turned = |v: f64| match self.horizontal > 0.0 {
            true => self.horizontal.powi(2) * (v / self.horizontal).asinh(),
            false => 0.0,
        };
        let area = |v: f64| v * tension(v) + turned(v);
        let tensions = (area(v1) - area(v0)) / (2.0 * w); // ∫ T ds
        let squares = h * (v0 * v0 + v0 * v1 + v1 * v1) / 3.0; // ∫ V² ds
        let stretched = (squares - v0 * v0 * h) / (2.0 * self.axial_stiffness * w);
        start * h + (tensions - tension(v0) * h) / w + stretched
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_integrals_of_a_hanging_piece_are_those_of_its_shape() {
        for weight in [3.0, -2.0] {
            let piece = Hanging {
                length: 8.0,
                weight,
                axial_stiffness: 400.0,
                horizontal: 5.0,
                vertical: -7.0,
            };
            let count = 200_000;
            let step = piece.length / f64::from(count);
            let (mut height, mut squares, mut heights) = (1.5, 0.0, 0.0);
            for i in 0..count {
                let v = piece.vertical + weight * step * (f64::from(i) + 0.5);
                let tension = piece.horizontal.hypot(v);
                let rise = step * (1.0 + tension / piece.axial_stiffness) * v / tension;
                squares += step * tension * tension;
                heights += step * (height + 0.5 * rise);
                height += rise;
            }
            assert_relative_eq!(piece.squared_tension(), squares, max_relative = 1e-8);
            assert_relative_eq!(piece.height(1.5), heights, max_relative = 1e-8);
        }
    }
}
