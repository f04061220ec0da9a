//! Mass of a piece of line, which differs across and along the line.
//!
//! M = M_n I + (M_t − M_n) t tᵀ,   M⁻¹ = (1/M_n) I + (1/M_t − 1/M_n) t tᵀ,   ½ vᵀM v = ½ M_n v² + ½ (M_t − M_n)(v·t)²,
//!
//! with the unit tangent t. The mass of the water that follows an acceleration of the water around the line (Froude-Krylov force and
//! added mass) has the same form.
//!
//! Source: Sherman & Morrison (1950), Ann. Math. Stat. 21, 124-127, for the inverse.

use nalgebra::{Matrix3, Vector3};

use crate::math::real::{Real, RealVector};

/// a I + b t tᵀ: a mass [kg] or an inverse mass [1/kg] of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slender<R> {
    /// a: part in all directions.
    pub across: R,
    /// b: excess of the part along the line over a.
    pub excess: R,
}

impl<R: Real> Slender<R> {
    /// Returns the tensor of the values across and along the line.
    #[inline(always)]
    pub fn new([across, along]: [R; 2]) -> Slender<R> {
        Slender {
            across,
            excess: along - across,
        }
    }

    /// Returns the inverse, from the masses across and along the line [kg].
    #[inline(always)]
    pub fn inverse(masses: [R; 2]) -> Slender<R> {
        Slender::new(masses.map(R::recip))
    }

    /// Returns the inverse of this matrix.
    #[inline(always)]
    pub fn inverted(self) -> Slender<R> {
        Slender::inverse([self.across, self.across + self.excess])
    }

    /// (a I + b t tᵀ) x.
    #[inline(always)]
    pub fn times<V: RealVector<Real = R>>(self, x: V, tangent: V) -> V {
        x.scaled(self.across) + tangent.scaled(self.excess * x.inner(tangent))
    }

    /// xᵀ(a I + b t tᵀ)x: twice the kinetic energy, for a mass and a velocity.
    #[inline(always)]
    pub fn square<V: RealVector<Real = R>>(self, x: V, tangent: V) -> R {
        let along = x.inner(tangent);
        self.across * x.inner(x) + self.excess * along * along
    }
}

impl Slender<f64> {
    /// Matrix a I + b t tᵀ [kg] or [1/kg].
    pub fn matrix(self, tangent: Vector3<f64>) -> Matrix3<f64> {
        Matrix3::from_diagonal_element(self.across) + self.excess * tangent * tangent.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_inverse_undoes_the_mass_and_the_square_is_the_product() {
        let (tangent, x) = (Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.3, -1.2, 0.5));
        let masses = [3.0, 5.0];
        let momentum = Slender::new(masses).times(x, tangent);
        assert_relative_eq!(
            Slender::inverse(masses).times(momentum, tangent),
            x,
            epsilon = 1e-15
        );
        assert_relative_eq!(
            Slender::new(masses).square(x, tangent),
            x.dot(&momentum),
            epsilon = 1e-14
        );
    }
}
