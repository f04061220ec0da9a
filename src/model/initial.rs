//! Initial shapes of a line that are given in closed form; equilibria and catenaries are found by `statics`.

use nalgebra::Vector3;

use super::Line;
use crate::scene::InitialShape;

impl Line {
    /// Node positions [m] of the user's initial shape, between ends at `a` and `b` [m]; `None` for the static one and
    /// for the catenary.
    pub fn given_shape(&self, a: Vector3<f64>, b: Vector3<f64>) -> Option<Vec<Vector3<f64>>> {
        let length = self.unstretched_length();
        let on_chord = |sag: f64| {
            self.nodes
                .arc
                .iter()
                .map(|arc| {
                    let u = arc / length;
                    a + u * (b - a) - 4.0 * sag * u * (1.0 - u) * Vector3::z()
                })
                .collect()
        };
        match &self.initial {
            InitialShape::Static | InitialShape::Catenary => None,
            InitialShape::Straight => Some(on_chord(0.0)),
            InitialShape::Parabola(sag) => Some(on_chord(*sag)),
            InitialShape::Nodes(nodes) => Some(nodes.iter().map(|node| Vector3::from(*node)).collect()),
        }
    }
}
