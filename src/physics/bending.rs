//! Bending of a line between two successive directions, without rotations or torsion.
//!
//! Between unit vectors q₁ and q₂ with c = q₁·q₂, over the material length l̄ that the turn belongs to, the curvature vector is
//! κb/l̄ with κb = 2 q₁×q₂/(1 + c), |κb| = 2 tan(φ/2) at the angle φ, and the energy
//!
//! W = ½ B (|κb| − k₀)²,   B = EI/l̄ [N m];   without rest curvature W = 2B f,   f = |κb|²/4 = (1 − c)/(1 + c).
//!
//! 1 − c is computed as ½|q₂ − q₁|², without cancellation. The slopes with respect to c are f' = −2/(1 + c)² and f'' = 4/(1 + c)³. With the
//! end-to-end vectors e₁ and e₂ of the two segments of lengths l₁ and l₂, and P = I − q qᵀ,
//!
//! ∂c/∂e₁ = P₁q₂/l₁ = u₁,   ∂²c/∂e₁² = −(q₁u₁ᵀ + u₁q₁ᵀ + c P₁/l₁)/l₁,   ∂²c/∂e₁∂e₂ = P₁P₂/(l₁l₂).
//!
//! Where the stiffness changes between two segments, their halves bend in series: 1/B = l₁/(2EI₁) + l₂/(2EI₂); B = 0 if either is a hinge. A clamp is
//! a fixed direction.
//!
//! Under a tension T a line leaves a clamp in a bend of length λ = √(EI/T), with the moment M = EI Θ/λ at the angle Θ between the clamp and the line
//! beyond. In a chain of equal segments of length l, the deviation of each direction from that of the line beyond is r times the previous one, r +
//! 1/r = 2 + l²/λ²; that is r = e^(−2x) with sinh x = l/2λ = u. The chain acts on the clamp as a stiffness (EI/l)(1/r − 1) in series with B, and M is
//! that of the continuous line on every mesh if
//!
//! B = (2EI/l)/(1 − tanh ½x),   tanh ½x = u/(1 + √(1 + u²)):
//!
//! B tends to 2EI/l, the stiffness of half a segment, for short segments, and to √(EI T) for long ones. T is the tension at rest. At another tension
//! T', M has a relative error of 0.05 (l/λ)² ln(T'/T) where l < λ, and of 0.15 ln(T'/T) at l = 2λ.
//!
//! A moment M on an end of a line turns its last segment, of the end-to-end vector e and direction q. A turn δθ = q ×
//! δq across the line does the work M·δθ = (M × q)·δe/l. M is therefore a couple of forces ± f on the segment's two
//! nodes,
//!
//! f = M × e/|e|²,   ∂f/∂e = ([M]ₓ − 2 (M × q) qᵀ)/l²,
//!
//! which bends a line by M/EI there, with an error of the order of (κl)². The part of M along the line does no work, since no torsional stiffness is
//! modelled. ∂f/∂e is unsymmetric, as for a load without a potential.
//!
//! The module also holds EI of a solid round section and of a bundle of loose fibres, and the compression a segment can carry. A bundle of N equal
//! loose strands of area A/N, d' = d/√N each, that slide on each other has N·(A/N)²E/4π = EI/N. The alternative definition, EI/N², is the stiffness
//! of a single strand. A chain of segments of length l buckles in its shortest wave, a zigzag, at 4EI/l²: the bending energy of a zigzag of amplitude
//! a is ½(EI/l)(4a/l)² per node, and a compression P gives ½P(2a)²/l. The mesh cannot resolve the shape under a larger compression, so a segment
//! carries no more. Without EI it carries no compression.
//!
//! Source: Bergou, Wardetzky, Robinson, Audoly & Grinspun (2008), Discrete Elastic Rods, ACM Trans. Graph. 27(3), eq. 1 and section 4.2 (κb and the
//! bending energy); second derivatives, series stiffness, couple, fibres, zigzag and B of a clamp are derived here. The compression limit corresponds
//! to OrcaFlex's "segment Euler load", π²EI/l² there. Valid for slender lines, l̄ well below the radius of curvature, and for φ < 180°, where the
//! energy is infinite. A rest curvature has a magnitude but no direction, as in a line that is free to twist: its force is not smooth where the line
//! is straight.

use nalgebra::{Matrix3, Vector3};

use crate::math::circle;
use crate::math::real::{Real, RealVector};

/// |κb| below which the direction of a rest curvature fades [-].
const REST_FADE: f64 = 1e-6;

/// Direction of a segment, as used by the bending law.
#[derive(Debug, Clone, Copy, Default)]
pub struct Direction<V: RealVector = Vector3<f64>> {
    /// Unit vector q [-].
    pub along: V,
    /// 1/l [1/m]; 0 for a direction that is prescribed.
    pub per_length: V::Real,
}

/// Minimum length of a segment [m], against division by zero where nodes coincide.
const LENGTH_MIN: f64 = 1e-9;

impl Direction {
    /// Direction of a segment, from its end-to-end vector `chord` and its length [m]; zero where both nodes coincide.
    #[inline(always)]
    pub fn new(chord: Vector3<f64>, length: f64) -> Direction {
        let per_length = 1.0 / length.max(LENGTH_MIN);
        Direction {
            along: per_length * chord,
            per_length,
        }
    }
}

/// Energy and its slopes with respect to the end-to-end vectors e₁ and e₂ of the two segments.
#[derive(Debug, Clone, Copy)]
pub struct Bend {
    /// W [J].
    pub energy: f64,
    /// ∂W/∂e₁ and ∂W/∂e₂ [N].
    pub slope: [Vector3<f64>; 2],
}

/// Second derivatives of the energy [N/m].
#[derive(Debug, Clone, Copy)]
pub struct Hessian {
    /// ∂²W/∂e₁² [N/m].
    pub first: Matrix3<f64>,
    /// ∂²W/∂e₁∂e₂, row of e₁ [N/m].
    pub mixed: Matrix3<f64>,
    /// ∂²W/∂e₂² [N/m].
    pub second: Matrix3<f64>,
}

impl Hessian {
    /// Returns the second derivatives times a factor.
    #[inline(always)]
    pub fn times(&self, factor: f64) -> Hessian {
        Hessian {
            first: factor * self.first,
            mixed: factor * self.mixed,
            second: factor * self.second,
        }
    }

    /// Returns the sum of two Hessians.
    #[inline(always)]
    pub fn plus(&self, other: &Hessian) -> Hessian {
        Hessian {
            first: self.first + other.first,
            mixed: self.mixed + other.mixed,
            second: self.second + other.second,
        }
    }

    /// Changes of the slopes [N] due to changes of e₁ and e₂ [m].
    #[inline(always)]
    pub fn product(&self, [v1, v2]: [Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
        [
            self.first * v1 + self.mixed * v2,
            self.mixed.tr_mul(&v1) + self.second * v2,
        ]
    }
}

/// Turn from one direction to the next.
#[derive(Debug, Clone, Copy)]
pub struct Turn<V: RealVector = Vector3<f64>> {
    first: Direction<V>,
    second: Direction<V>,
    /// q₁·q₂.
    cosine: V::Real,
    /// 1/(1 + c), with the sum kept away from zero.
    per_sum: V::Real,
    /// f = |κb|²/4.
    square: V::Real,
    /// u₁ and u₂.
    gradient: [V; 2],
}

impl<V: RealVector> Turn<V> {
    /// Turn from `first` to `second`.
    #[inline(always)]
    pub fn new(first: Direction<V>, second: Direction<V>) -> Turn<V> {
        let real = V::Real::splat;
        let (q1, q2) = (first.along, second.along);
        let turned = q2 - q1;
        let rest = real(0.5) * turned.inner(turned); // 1 − c
        let per_sum = (real(2.0) - rest).max(real(1e-9)).recip();
        Turn {
            first,
            second,
            cosine: real(1.0) - rest,
            per_sum,
            square: rest * per_sum,
            gradient: [
                (turned + q1.scaled(rest)).scaled(first.per_length),
                (q2.scaled(rest) - turned).scaled(second.per_length),
            ],
        }
    }

    /// Slopes of the energy with respect to e₁ and e₂ [N] for a stiffness B [N m] and a rest bend k₀ [-].
    #[inline(always)]
    pub fn slope(&self, stiffness: V::Real, rest: V::Real) -> [V; 2] {
        let [slope, _] = self.slopes(stiffness, rest);
        self.gradient.map(|u| u.scaled(slope))
    }

    /// dW/dc and d²W/dc² [J].
    #[inline(always)]
    fn slopes(&self, stiffness: V::Real, rest: V::Real) -> [V::Real; 2] {
        let real = V::Real::splat;
        let d1 = real(-2.0) * self.per_sum * self.per_sum; // f'
        let d2 = real(-2.0) * self.per_sum * d1; // f''
        let twice = stiffness + stiffness;
        if !rest.any_positive() {
            return [twice * d1, twice * d2];
        }
        let per_root = (self.square + real(REST_FADE * REST_FADE)).sqrt().recip();
        // W = 2B (f − k₀√f) + ½Bk₀²
        let along = real(1.0) - real(0.5) * rest * per_root;
        let across = real(0.25) * rest * per_root * per_root * per_root;
        [twice * along * d1, twice * (along * d2 + across * d1 * d1)]
    }
}

impl Turn {
    /// |κb| = 2 tan(φ/2) [-]: curvature times material length.
    pub fn bend(&self) -> f64 {
        2.0 * self.square.sqrt()
    }

    /// Energy and slopes for a stiffness B [N m] and a rest bend k₀ [-].
    #[inline(always)]
    pub fn energy(&self, stiffness: f64, rest: f64) -> Bend {
        let bend = self.bend() - rest;
        Bend {
            energy: 0.5 * stiffness * bend * bend,
            slope: self.slope(stiffness, rest),
        }
    }

    /// Moment [N m] on the support of the first direction, if that is prescribed; it turns the first direction towards the second.
    pub fn moment_on_first(&self, stiffness: f64, rest: f64) -> Vector3<f64> {
        let [slope, _] = self.slopes(stiffness, rest);
        -slope * self.first.along.cross(&self.second.along)
    }

    /// Exact second derivatives.
    #[inline(always)]
    pub fn hessian(&self, stiffness: f64, rest: f64) -> Hessian {
        let [d1, d2] = self.slopes(stiffness, rest);
        let ([u1, u2], [q1, q2]) = (self.gradient, [self.first.along, self.second.along]);
        // d₂ u uᵀ − d₁/l (q uᵀ + u qᵀ + c/l P)
        let own = |u: Vector3<f64>, direction: &Direction| {
            let (q, l) = (direction.along, d1 * direction.per_length);
            let isotropic = l * self.cosine * direction.per_length;
            let turned = 0.5 * isotropic * q - l * u;
            from_columns(|j| {
                let mut column = d2 * u[j] * u + turned[j] * q + q[j] * turned;
                column[j] -= isotropic;
                column
            })
        };
        // d₂ u₁ u₂ᵀ + d₁/(l₁l₂) P₁ P₂
        let lengths = d1 * self.first.per_length * self.second.per_length;
        let mixed = from_columns(|j| {
            let along = [lengths * q1[j] - lengths * self.cosine * q2[j], lengths * q2[j]];
            let mut column = d2 * u2[j] * u1 - along[0] * q1 - along[1] * q2;
            column[j] += lengths;
            column
        });
        Hessian {
            first: own(u1, &self.first),
            mixed,
            second: own(u2, &self.second),
        }
    }

    /// B JᵀJ with the slopes J of k = (q₂ − q₁)√(2/(1 + c)), |k| = |κb|: positive semi-definite, and exact where the line is straight.
    #[inline(always)]
    pub fn convex_hessian(&self, stiffness: f64) -> Hessian {
        let [j1, j2] = self.bend_slopes();
        Hessian {
            first: stiffness * j1.transpose() * j1,
            mixed: stiffness * j1.transpose() * j2,
            second: stiffness * j2.transpose() * j2,
        }
    }

    /// Slopes of k with respect to e₁ and e₂ [1/m].
    #[inline(always)]
    fn bend_slopes(&self) -> [Matrix3<f64>; 2] {
        let scale = (2.0 * self.per_sum).sqrt();
        let growth = -0.5 * scale * self.per_sum * (self.second.along - self.first.along);
        let [u1, u2] = self.gradient;
        [
            -scale * self.first.per_length * across(&self.first) + growth * u1.transpose(),
            scale * self.second.per_length * across(&self.second) + growth * u2.transpose(),
        ]
    }

    /// Damping matrix [N s/m] of a damper of `damping` [N m s] on the rate of k across the line, for a section that does not spin about its axis.
    /// Rotation of the line as a whole is not damped.
    #[inline(always)]
    pub fn damper(&self, damping: f64) -> Hessian {
        let mean = (self.first.along + self.second.along).normalize();
        let [j1, j2] = self.bend_slopes().map(|j| j - mean * (mean.transpose() * j));
        Hessian {
            first: damping * j1.transpose() * j1,
            mixed: damping * j1.transpose() * j2,
            second: damping * j2.transpose() * j2,
        }
    }
}

/// Moment on an end of a line, as forces on the two nodes of its segment.
#[derive(Debug, Clone, Copy)]
pub struct Couple {
    /// Force on the second node; the first takes its negative [N].
    pub force: Vector3<f64>,
    /// ∂f/∂e [N/m].
    pub slope: Matrix3<f64>,
}

impl Couple {
    /// Couple of a moment M [N m] on a segment with the end-to-end vector e [m].
    pub fn new(moment: Vector3<f64>, chord: Vector3<f64>) -> Couple {
        let per_square = 1.0 / chord.norm_squared().max(f64::MIN_POSITIVE);
        let turned = per_square * moment.cross(&chord);
        Couple {
            force: turned,
            slope: per_square * (moment.cross_matrix() - 2.0 * turned * chord.transpose()),
        }
    }
}

#[inline(always)]
fn from_columns(column: impl Fn(usize) -> Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_columns(&[column(0), column(1), column(2)])
}

/// P = I − q qᵀ.
#[inline(always)]
fn across(direction: &Direction) -> Matrix3<f64> {
    Matrix3::identity() - direction.along * direction.along.transpose()
}

/// EI [N m²] of a solid round section with this diameter [m] and Young's modulus [Pa].
pub fn solid_round(diameter: f64, youngs_modulus: f64) -> f64 {
    youngs_modulus * circle::second_moment(diameter)
}

/// EI [N m²] of a section of loose strands: that of the solid section, divided by the number of strands to the power of 1 or, in the alternative
/// definition, 2.
pub fn of_strands(solid: f64, strands: usize, power: i32) -> f64 {
    solid / (strands as f64).powi(power)
}

/// B [N m] of two half segments in series, from length [m] and EI [N m²] of each segment.
pub fn in_series(halves: [(f64, f64); 2]) -> f64 {
    let [(l1, ei1), (l2, ei2)] = halves;
    if ei1 > 0.0 && ei2 > 0.0 {
        2.0 / (l1 / ei1 + l2 / ei2)
    } else {
        0.0
    }
}

/// B [N m] of a clamp at the end of a chain of equal segments, from their EI [N m²], length [m] and tension [N].
pub fn of_clamp(stiffness: f64, length: f64, tension: f64) -> f64 {
    let u = 0.5 * length * (tension / stiffness).sqrt();
    let cosh = (1.0 + u * u).sqrt();
    2.0 * stiffness / length * (1.0 + cosh) / (1.0 + 1.0 / (cosh + u)) // without the cancellation of 1 − tanh ½x
}

/// Maximum compression [N] that a segment of this EI [N m²] and length [m] carries.
pub fn compression_max(stiffness: f64, length: f64) -> f64 {
    4.0 * stiffness / (length * length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::{along, assert_columns, central};
    use approx::assert_relative_eq;

    fn direction(e: Vector3<f64>) -> Direction {
        Direction {
            along: e.normalize(),
            per_length: 1.0 / e.norm(),
        }
    }

    /// Clamp at an angle from x [rad].
    fn clamp(angle: f64) -> Direction {
        Direction {
            along: Vector3::new(angle.cos(), angle.sin(), 0.0),
            per_length: 0.0,
        }
    }

    fn turn(e: [Vector3<f64>; 2]) -> Turn {
        Turn::new(direction(e[0]), direction(e[1]))
    }

    const PAIRS: [[Vector3<f64>; 2]; 3] = [
        [Vector3::new(0.7, 0.1, -0.2), Vector3::new(0.5, 0.3, 0.4)],
        [Vector3::new(1.0, 0.0, 0.0), Vector3::new(1.0, 1e-3, 0.0)],
        [Vector3::new(0.0, 0.3, 0.1), Vector3::new(0.8, -0.1, 0.2)],
    ];

    fn moved(mut e: [Vector3<f64>; 2], side: usize, by: Vector3<f64>) -> Turn {
        e[side] += by;
        turn(e)
    }

    #[test]
    fn slopes_are_those_of_the_energy() {
        for (e, rest) in PAIRS.into_iter().zip([0.0, 0.0, 0.4]) {
            let slope = turn(e).energy(3.0, rest).slope;
            for (side, axis) in (0..2).flat_map(|side| (0..3).map(move |axis| (side, axis))) {
                let difference = along(axis, 1e-6, |by| moved(e, side, by).energy(3.0, rest).energy);
                assert_relative_eq!(slope[side][axis], difference, epsilon = 1e-8);
            }
        }
    }

    #[test]
    fn second_derivatives_are_those_of_the_slopes() {
        for (e, rest) in PAIRS.into_iter().zip([0.0, 0.0, 0.4]) {
            let exact = turn(e).hessian(3.0, rest);
            let mixed = exact.mixed.transpose();
            for (side, row, block) in [
                (0, 0, exact.first),
                (0, 1, mixed),
                (1, 0, exact.mixed),
                (1, 1, exact.second),
            ] {
                let slope = |by| moved(e, side, by).energy(3.0, rest).slope[row];
                for axis in 0..3 {
                    let (column, difference) = (block.column(axis).into_owned(), along(axis, 1e-6, slope));
                    assert_relative_eq!(column, difference, epsilon = 1e-7, max_relative = 1e-7);
                }
            }
        }
    }

    #[test]
    fn a_couple_does_the_work_of_its_moment_and_none_about_the_line() {
        let (moment, e) = (Vector3::new(3.0, -1.0, 2.0), PAIRS[0][0]);
        let couple = Couple::new(moment, e);
        let spin = Vector3::new(0.2, 0.5, -0.4);
        let across = spin - spin.dot(&e) / e.norm_squared() * e;
        let work = couple.force.dot(&across.cross(&e));
        assert_relative_eq!(work, moment.dot(&across), max_relative = 1e-14);
        assert!(couple.force.dot(&e).abs() < 1e-14);
        assert!(Couple::new(e, e).force.norm() < 1e-15);
        assert_columns(&couple.slope, 1e-6, 1e-8, |by| Couple::new(moment, e + by).force);
    }

    #[test]
    fn a_clamp_takes_no_force_along_its_own_direction() {
        let bend = Turn::new(clamp(0.0), direction(PAIRS[0][1])).energy(2.0, 0.0);
        assert_eq!(bend.slope[0], Vector3::zeros());
        assert!(bend.slope[1].norm() > 0.0);
    }

    #[test]
    fn the_convex_second_derivatives_are_exact_on_a_straight_line_and_positive_on_a_bent_one() {
        let straight = turn([Vector3::new(0.3, 0.4, 0.0), Vector3::new(0.6, 0.8, 0.0)]);
        let (exact, convex) = (straight.hessian(5.0, 0.0), straight.convex_hessian(5.0));
        assert_relative_eq!(exact.first, convex.first, epsilon = 1e-12);
        assert_relative_eq!(exact.mixed, convex.mixed, epsilon = 1e-12);
        for e in PAIRS {
            for h in [turn(e).convex_hessian(5.0), turn(e).damper(5.0)] {
                let mut full = nalgebra::Matrix6::zeros();
                full.fixed_view_mut::<3, 3>(0, 0).copy_from(&h.first);
                full.fixed_view_mut::<3, 3>(0, 3).copy_from(&h.mixed);
                full.fixed_view_mut::<3, 3>(3, 0).copy_from(&h.mixed.transpose());
                full.fixed_view_mut::<3, 3>(3, 3).copy_from(&h.second);
                let least = full.symmetric_eigenvalues().min();
                assert!(least > -1e-11 * full.norm());
            }
        }
    }

    #[test]
    fn what_turns_as_a_whole_across_its_axis_is_not_damped() {
        let e = PAIRS[0];
        let t = turn(e);
        let mean = (t.first.along + t.second.along).normalize();
        let spin = Vector3::new(0.3, -0.5, 0.8);
        let spin = spin - spin.dot(&mean) * mean;
        let [v1, v2] = e.map(|e| spin.cross(&e));
        let h = t.damper(1.0);
        assert_relative_eq!(h.first * v1 + h.mixed * v2, Vector3::zeros(), epsilon = 1e-14);
    }

    #[test]
    fn the_moment_on_a_clamp_is_minus_the_slope_of_the_energy_with_its_rotation() {
        let held = |angle| Turn::new(clamp(angle), direction(PAIRS[0][1]));
        let moment = held(0.2).moment_on_first(3.0, 0.0);
        let difference = central(1e-6, |h| held(0.2 + h).energy(3.0, 0.0).energy);
        assert_relative_eq!(moment.z, -difference, epsilon = 1e-8);
    }

    #[test]
    fn strands_side_by_side_share_the_stiffness() {
        let strand = solid_round(0.1 / 20.0_f64.sqrt(), 2e11);
        let solid = solid_round(0.1, 2e11);
        assert_relative_eq!(20.0 * strand, of_strands(solid, 20, 1), max_relative = 1e-14);
        assert_relative_eq!(strand, of_strands(solid, 20, 2), max_relative = 1e-14);
    }

    #[test]
    fn a_small_turn_has_the_energy_of_a_beam_bent_to_a_circle() {
        let (angle, length, ei) = (1e-4_f64, 0.5, 7.0);
        let (q1, q2) = (Vector3::x(), Vector3::new(angle.cos(), angle.sin(), 0.0));
        let turn = turn([length * q1, length * q2]);
        assert_relative_eq!(turn.bend(), angle, max_relative = 1e-8);
        let energy = turn.energy(ei / length, 0.0).energy;
        let beam = 0.5 * ei * (angle / length).powi(2) * length;
        assert_relative_eq!(energy, beam, max_relative = 1e-8);
    }

    #[test]
    fn stiffness_in_series_is_that_of_a_uniform_line_and_nothing_at_a_hinge() {
        assert_relative_eq!(in_series([(0.5, 8.0), (0.5, 8.0)]), 16.0);
        assert_eq!(in_series([(0.5, 8.0), (0.5, 0.0)]), 0.0);
    }

    #[test]
    fn a_clamp_on_a_chain_takes_the_moment_of_a_line_on_every_mesh() {
        let (ei, tension, angle): (f64, f64, f64) = (7.0, 30.0, 0.01);
        for length in [1e-3, 0.3, 1.0, 4.0] {
            let square = length * length * tension / ei;
            let r = 1.0 + 0.5 * square - (square + 0.25 * square * square).sqrt();
            let (clamp, beyond) = (of_clamp(ei, length, tension), ei / length * (1.0 / r - 1.0));
            let moment = angle / (1.0 / clamp + 1.0 / beyond);
            assert_relative_eq!(moment, (ei * tension).sqrt() * angle, max_relative = 1e-9);
        }
        assert_relative_eq!(of_clamp(ei, 0.5, 0.0), 4.0 * ei);
        assert_relative_eq!(of_clamp(1.0, 0.5, 1e24), 1e12, max_relative = 1e-11);
    }

    #[test]
    fn the_solid_rod_of_the_collar_has_the_published_stiffness() {
        assert_relative_eq!(solid_round(5.6955e-3, 2.1e11), 10.85, max_relative = 1e-3);
    }
}
