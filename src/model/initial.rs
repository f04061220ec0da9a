//! Initial shapes of a line that are given in closed form; equilibria and catenaries are found by `statics`.

use nalgebra::Vector3;

use super::Line;
use crate::scene::InitialShape;

impl Line {
    /// Node positions [m] of the user's initial shape, between the ends of the line [m]; `None` for the static one and
    /// for the catenary.
    pub fn given_shape(&self, ends: [Vector3<f64>; 2]) -> Option<Vec<Vector3<f64>>> {
        match &self.initial {
            InitialShape::Static | InitialShape::Catenary => None,
            InitialShape::Straight => Some(self.parabola(ends, 0.0).collect()),
            InitialShape::Parabola(sag) => Some(self.parabola(ends, *sag).collect()),
            InitialShape::Nodes(nodes) => Some(nodes.iter().map(|node| Vector3::from(*node)).collect()),
        }
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
