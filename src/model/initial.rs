//! Initial shapes of a line that are given in closed form; equilibria and catenaries are found by `statics`.

use nalgebra::Vector3;

use super::Line;
use crate::scene::InitialShape;

/// Number of bisections for the place of a node on a parabola [-]: to the resolution of a number.
const HALVINGS: usize = 54;

impl Line {
    /// Node positions [m] of the user's initial shape, between the ends of the line [m]; `None` for the static one and
    /// for the catenary.
    pub fn given_shape(&self, ends: [Vector3<f64>; 2]) -> Option<Vec<Vector3<f64>>> {
        match &self.initial {
            InitialShape::Static | InitialShape::Catenary => None,
            InitialShape::Straight => Some(self.parabola(ends, 0.0).collect()),
            InitialShape::Parabola(sag) => Some(self.along_parabola(ends, *sag)),
            InitialShape::Nodes(nodes) => Some(nodes.iter().map(|node| Vector3::from(*node)).collect()),
        }
    }

    /// Node positions [m] on a parabola with a sag [m] between two ends [m]; the fractions of its length are those of the unstretched length, so that all
    /// segments are strained alike.
    ///
    /// With the chord e, horizontally h, and x = 4 sag (1 − 2u) − e_z at the fraction u of the chord, the length from x on is proportional to
    /// x√(x² + h²) + h² asinh(x/h).
    fn along_parabola(&self, [a, b]: [Vector3<f64>; 2], sag: f64) -> Vec<Vector3<f64>> {
        let (chord, slope) = (b - a, 4.0 * sag);
        let horizontal = chord.xy().norm();
        if slope == 0.0 || horizontal == 0.0 {
            return self.parabola([a, b], sag).collect();
        }
        let length = |u: f64| {
            let x = slope * (1.0 - 2.0 * u) - chord.z;
            x * x.hypot(horizontal) + horizontal * horizontal * (x / horizontal).asinh()
        };
        let [first, last] = [0.0, 1.0].map(length);
        let whole = self.unstretched_length();
        let at = |arc: &f64| {
            let wanted = arc / whole;
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let u = 0.5 * (low + high);
                match (length(u) - first) / (last - first) < wanted {
                    true => low = u,
                    false => high = u,
                }
            }
            let u = match wanted {
                0.0 | 1.0 => wanted,
                _ => 0.5 * (low + high),
            };
            a + u * chord - slope * u * (1.0 - u) * Vector3::z()
        };
        self.nodes.arc.iter().map(at).collect()
    }

    /// Node positions [m] on a parabola with a sag [m] between two ends [m]; the fractions of the chord are those of the unstretched length.
    pub(crate) fn parabola(
        &self,
        [a, b]: [Vector3<f64>; 2],
        sag: f64,
    ) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let length = self.unstretched_length();
        self.nodes.arc.iter().map(move |arc| {
            let u = arc / length;
            a + u * (b - a) - 4.0 * sag * u * (1.0 - u) * Vector3::z()
        })
    }
}
