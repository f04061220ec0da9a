//! Rotations in space by the Cayley transform, and orthonormal frames.
//!
//! cay(θ) = I + (θ̂ + ½ θ̂²)/(1 + ¼|θ|²) turns by α about θ/|θ| with |θ| = 2 tan(α/2), so that R = cay(θ) moves every vector by
//! R d − d = θ × ½(d + R d), exactly. Its differential is the spin δω = T(θ) δθ, δR = δω̂ R, T = (I + ½ θ̂)/(1 + ¼|θ|²), T⁻¹ = I + ¼ θθᵀ − ½ θ̂.
//!
//! Source: Simo, Tarnow & Doblaré (1995), Int. J. Numer. Methods Eng. 38, 1431-1473, section 4; checked here by differences. Valid for
//! α < π. Frames are 3×3 matrices whose columns are orthonormal and right-handed.

use nalgebra::{Matrix3, Vector3};

use super::real::{Real, RealVector};
use super::triad::{Triad, each};

/// v̂, the matrix of v ×.
#[inline(always)]
pub fn skew(v: Vector3<f64>) -> Matrix3<f64> {
    v.cross_matrix()
}

/// The vector v of the skew part of a matrix: v̂ = ½(m − mᵀ).
#[inline(always)]
pub fn axial(m: &Matrix3<f64>) -> Vector3<f64> {
    0.5 * Vector3::new(
        m[(2, 1)] - m[(1, 2)],
        m[(0, 2)] - m[(2, 0)],
        m[(1, 0)] - m[(0, 1)],
    )
}

/// Rotation matrix of the Cayley vector θ [-].
#[inline(always)]
pub fn cayley(theta: Vector3<f64>) -> Matrix3<f64> {
    let hat = skew(theta);
    Matrix3::identity() + (hat + 0.5 * hat * hat) / (1.0 + 0.25 * theta.norm_squared())
}

/// Cayley vector of a rotation matrix [-]; unbounded as the angle approaches half a turn.
pub fn cayley_vector(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let twice_cosine_half_squared = 0.5 * (1.0 + rotation.trace()); // 2cos²(α/2)
    2.0 * axial(rotation) / twice_cosine_half_squared.max(f64::MIN_POSITIVE)
}

/// Directors turned by cay(θ).
#[inline(always)]
pub fn turned_by_cayley<V: RealVector>(theta: V, directors: &Triad<V>) -> Triad<V> {
    let number = V::Real::splat;
    let factor = (number(1.0) + number(0.25) * theta.inner(theta)).recip();
    Triad(each!(d in [directors.0[0], directors.0[1], directors.0[2]] => {
        d + theta.crossed(d + theta.crossed(d).scaled(number(0.5))).scaled(factor)
    }))
}

/// T(θ)⁻¹ s = s + ¼ θ (θ·s) − ½ θ × s: change of the Cayley vector that produces the spin s.
#[inline(always)]
pub fn cayley_of_spin<V: RealVector>(theta: V, spin: V) -> V {
    let number = V::Real::splat;
    let along = theta.scaled(number(0.25) * theta.inner(spin));
    spin + along - theta.crossed(spin).scaled(number(0.5))
}

/// Frame whose third column is the unit vector `direction` [-] and whose first column is as close to `reference` as possible.
pub fn frame_along(direction: Vector3<f64>, reference: Vector3<f64>) -> Matrix3<f64> {
    let across = |v: Vector3<f64>| {
        let rest = v - v.dot(&direction) * direction;
        (rest.norm() > 1e-8 * v.norm()).then(|| rest.normalize())
    };
    let smallest = direction.abs().imin();
    let axis = Vector3::from_fn(|i, _| f64::from(u8::from(i == smallest)));
    let first = across(reference)
        .or_else(|| across(axis))
        .unwrap_or_else(Vector3::x);
    Matrix3::from_columns(&[first, direction.cross(&first), direction])
}

/// Frame turned by the smallest rotation that takes its third column to the unit vector `direction` [-], without twist. A rotation by half a turn is
/// about the first column.
pub fn turned_to(frame: &Matrix3<f64>, direction: Vector3<f64>) -> Matrix3<f64> {
    let from = frame.column(2).into_owned();
    let cosine = from.dot(&direction);
    if cosine < -1.0 + 1e-12 {
        return frame_along(direction, frame.column(0).into_owned());
    }
    // θ = 2 tan(α/2) n with from × direction = sin α n
    let turned = cayley(2.0 * from.cross(&direction) / (1.0 + cosine)) * frame;
    frame_along(direction, turned.column(0).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const THETA: Vector3<f64> = Vector3::new(0.4, -1.3, 0.7);

    #[test]
    fn cayley_turns_by_twice_the_arc_tangent_of_half_its_vector() {
        let angle: f64 = 1.1;
        let rotation = cayley(Vector3::z() * 2.0 * (0.5 * angle).tan());
        let turned = rotation * Vector3::x();
        let expected = Vector3::new(angle.cos(), angle.sin(), 0.0);
        assert_relative_eq!(turned, expected, epsilon = 1e-15);
    }

    #[test]
    fn a_rotation_moves_a_vector_by_theta_across_the_mean() {
        let before = Vector3::new(0.3, 0.5, -0.8);
        let after = cayley(THETA) * before;
        let across = THETA.cross(&(0.5 * (before + after)));
        assert_relative_eq!(after - before, across, epsilon = 1e-15);
        assert_relative_eq!(after.norm(), before.norm(), max_relative = 1e-15);
    }

    #[test]
    fn the_cayley_vector_of_a_rotation_gives_it_back() {
        assert_relative_eq!(cayley_vector(&cayley(THETA)), THETA, epsilon = 1e-14);
        assert_eq!(cayley_vector(&Matrix3::identity()), Vector3::zeros());
    }

    #[test]
    fn the_change_of_the_cayley_vector_that_results_in_a_spin_equals_central_differences() {
        let rotation = cayley(THETA);
        for axis in 0..3 {
            let spin = Vector3::ith(axis, 1.0);
            let change = cayley_of_spin(THETA, spin);
            let rate = crate::math::tests::central(1e-6, |by| cayley(THETA + by * change));
            assert_relative_eq!(rate, skew(spin) * rotation, epsilon = 1e-9);
        }
    }

    #[test]
    fn directors_turn_by_the_rotation_matrix() {
        let columns = |m: &Matrix3<f64>| Triad(each!(i in [0, 1, 2] => m.column(i).into_owned()));
        let frame = cayley(Vector3::new(0.2, 0.5, -0.1));
        let turned = columns(&(cayley(THETA) * frame));
        let found = turned_by_cayley(THETA, &columns(&frame));
        (0..3).for_each(|i| assert_relative_eq!(found.0[i], turned.0[i], epsilon = 1e-15));
    }

    #[test]
    fn frames_are_orthonormal_and_right_handed_along_any_direction() {
        let oblique = Vector3::new(0.6, 0.0, 0.8);
        for direction in [Vector3::x(), -Vector3::x(), -Vector3::z(), oblique] {
            let frame = turned_to(&Matrix3::identity(), direction);
            assert_relative_eq!(frame.transpose() * frame, Matrix3::identity(), epsilon = 1e-15);
            assert_relative_eq!(frame.determinant(), 1.0, epsilon = 1e-15);
            assert_relative_eq!(frame.column(2).into_owned(), direction, epsilon = 1e-15);
        }
    }

    #[test]
    fn turning_without_twist_keeps_what_is_across_the_plane_of_the_turn() {
        let frame = turned_to(&Matrix3::identity(), Vector3::new(0.6, 0.0, 0.8));
        assert_relative_eq!(frame.column(1).into_owned(), Vector3::y(), epsilon = 1e-15);
    }
}
