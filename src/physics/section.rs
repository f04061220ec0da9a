//! Cross-sections of a geometrically exact beam: strains between two of them, stress, energy, exact slopes.
//!
//! A section has a position φ and an orthonormal frame Λ = [d₁ d₂ d₃], d₃ along the unstrained axis. Between two sections a, b an
//! unstretched length L apart, with φ' = (φ_b − φ_a)/L and directors interpolated linearly, the middle has
//!
//!   Γ_i = ½(d_i^a + d_i^b)·φ',    K_k = ½ ε_kij d_j'·d_i (a sign off) = ½ ε_kij d_i^b·d_j^a / L,
//!
//! so that Γ = (0, 0, 1) and K = 0 for a straight beam, and K is the axial vector of ΛᵀΛ'. With spins s, δd = s × d, they change by
//! δΓ = Λ_mᵀ δφ' + ½ Λ_aᵀ (φ' × s_a) + ½ Λ_bᵀ (φ' × s_b) and L δK_k = q_k·(s_b − s_a), q_k = ½ ε_kij d_i^b × d_j^a. They are
//! bilinear in positions and directors: over a step, their change is exactly their gradient at the mean of both ends of the step times the
//! change of positions and directors.
//!
//! Across a turn by α, LK is sin α along the axis of the turn, and Γ₃ on an unstretched arc is sin α/α. The law takes the strains
//!
//!   K* = h(u) K,  u = L²|K|²,      Γ₃* = Γ₃ + p(v),  v = L²(K₁² + K₂²),
//!   h = 1 + u/6 + 3u²/40,          p = v/6 + 17v²/360,
//!
//! which a circular arc and a uniform twist have exactly up to terms in α⁴ and α⁶ (h and p are the series of α/sin α and 1 − sin α/α in sin² α).
//! Under a moment, elements of 0.2 rad bend 2.2 % too far without h and p and 0.002 % with them. From the rest values Γ⁰, K⁰,
//!
//!   N = C_Γ (Γ* − Γ⁰),  M = C_K (K* − K⁰),  U = ½ L [N·(Γ* − Γ⁰) + M·(K* − K⁰)],  C_Γ = (GA, GA, EA),  C_K = (EI, EI, GJ).
//!
//! Polynomials have exact divided differences, so that the change of the starred strains, too, is a discrete gradient D times that of the
//! plain ones: ΔK* = [h̄ I + 2L² h[u₀,u₁] K̄ K̄ᵀ] ΔK, ΔΓ₃* = ΔΓ₃ + 2L² p[v₀,v₁] (K̄₁ΔK₁ + K̄₂ΔK₂), bars for means over the step.
//!
//! Source: strains by Simo (1985), Comput. Methods Appl. Mech. Eng. 49, 55-70; directors interpolated as in Romero & Armero (2002),
//! Int. J. Numer. Methods Eng. 54, 1683-1716, and Betsch & Steinmann (2002), ibid. 54, 1775-1788; discrete gradients by Gonzalez (1996),
//! J. Nonlinear Sci. 6, 449-467; starred strains and slopes derived here, checked by differences. Valid for small strain; neighbouring
//! sections must differ by less than a quarter turn, at which K goes through its maximum.

use nalgebra::{Matrix3, Vector3, Vector6};

use crate::math::rotation::{axial, skew};

/// A cross-section, or the mean of one over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Position φ [m].
    pub position: Vector3<f64>,
    /// Directors d₁, d₂, d₃ as columns [-].
    pub frame: Matrix3<f64>,
}

/// Six components of a section: Γ or N in the place of forces, K or M in the place of moments.
pub type Sextuple = Vector6<f64>;

/// Stiffness or damping of a section along its directors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionLaw {
    /// Shear stiffness GA, alike across both directors [N], or its damping [N s].
    pub shear: f64,
    /// Axial stiffness EA [N], or its damping [N s].
    pub axial: f64,
    /// Bending stiffness EI, alike about both directors [N m²], or its damping [N m² s].
    pub bending: f64,
    /// Torsional stiffness GJ [N m²], or its damping [N m² s].
    pub torsion: f64,
}

/// The parts of the strain energy.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StrainEnergy {
    /// Strain energy of stretching [J].
    pub axial: f64,
    /// Strain energy of shear [J].
    pub shear: f64,
    /// Strain energy of bending [J].
    pub bending: f64,
    /// Strain energy of torsion [J].
    pub torsion: f64,
}

impl Section {
    /// Mean of two sections; its directors are neither of unit length nor orthogonal.
    pub fn mean(&self, other: &Section) -> Section {
        Section {
            position: 0.5 * (self.position + other.position),
            frame: 0.5 * (self.frame + other.frame),
        }
    }
}

impl SectionLaw {
    /// C, as the diagonal that multiplies a strain.
    pub fn diagonal(&self) -> Sextuple {
        let (ga, ea, ei, gj) = (self.shear, self.axial, self.bending, self.torsion);
        Sextuple::new(ga, ga, ea, ei, ei, gj)
    }

    /// Energy of a strain from rest over an unstretched length [m].
    pub fn energy(&self, strain: &Sextuple, length: f64) -> StrainEnergy {
        let parts = 0.5 * length * self.diagonal().component_mul(&strain.component_mul(strain));
        StrainEnergy {
            shear: parts[0] + parts[1],
            axial: parts[2],
            bending: parts[3] + parts[4],
            torsion: parts[5],
        }
    }
}

impl StrainEnergy {
    /// Sum of all parts [J].
    pub fn total(&self) -> f64 {
        self.axial + self.shear + self.bending + self.torsion
    }

    /// Adds another energy, kind by kind.
    pub fn add(&mut self, other: StrainEnergy) {
        self.axial += other.axial;
        self.shear += other.shear;
        self.bending += other.bending;
        self.torsion += other.torsion;
    }
}

/// Weights of the strains at both ends of a step in its stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mixture {
    /// Part of the change of strain over the step that acts [-]: ½; in statics, where both ends are the same, 1.
    pub share: f64,
    /// 1/Δt [1/s]; 0 in statics.
    pub rate: f64,
}

/// Slopes of forces and moments (rows) with stretches and curvatures, or with positions and spins (columns).
pub type Blocks = [[Matrix3<f64>; 2]; 2];

/// An element over a step, or at rest.
#[derive(Debug, Clone, Copy)]
pub struct StepStrain<'a> {
    /// Stiffness and damping of the section.
    pub laws: [&'a SectionLaw; 2],
    /// Unstretched length [m].
    pub length: f64,
    /// Plain strains before and after the step.
    pub strains: [&'a Sextuple; 2],
    /// Starred strains without stress.
    pub rest: &'a Sextuple,
    /// Weights of both strains.
    pub mixture: Mixture,
}

/// Starred strains (Γ*, K*) of plain ones (Γ, K) over an unstretched length [m].
#[inline(always)]
pub fn corrected(strain: &Sextuple, length: f64) -> Sextuple {
    let (u, v) = turns(strain, length);
    let (mut stretch, curvature) = split(strain);
    stretch.z += v / 6.0 + 17.0 / 360.0 * v * v;
    join(stretch, (1.0 + u / 6.0 + 0.075 * u * u) * curvature)
}

/// u and v: squares of the sine of the turn, and of its part about the first two directors.
#[inline(always)]
fn turns(strain: &Sextuple, length: f64) -> (f64, f64) {
    let v = length * length * (strain[3] * strain[3] + strain[4] * strain[4]);
    (v + length * length * strain[5] * strain[5], v)
}

/// D = [[I, ẑ sᵀ], [0, H]]: its product with the change of the plain strains is the change of the starred ones.
struct Correction {
    /// H.
    turn: Matrix3<f64>,
    /// s.
    shortening: Vector3<f64>,
}

impl Correction {
    #[inline(always)]
    fn new(before: &Sextuple, now: &Sextuple, length: f64) -> Correction {
        let ((u0, v0), (u1, v1)) = (turns(before, length), turns(now, length));
        let curvature = split(&(0.5 * (before + now))).1;
        let h = 1.0 + (u0 + u1) / 12.0 + 0.0375 * (u0 * u0 + u1 * u1);
        let twice = 2.0 * length * length;
        let turning = twice * (1.0 / 6.0 + 0.075 * (u0 + u1));
        let shortening = twice * (1.0 / 6.0 + 17.0 / 360.0 * (v0 + v1));
        Correction {
            turn: Matrix3::from_diagonal_element(h) + turning * curvature * curvature.transpose(),
            shortening: shortening * Vector3::new(curvature.x, curvature.y, 0.0),
        }
    }

    /// Dᵀ S.
    #[inline(always)]
    fn tr_mul(&self, stress: &Sextuple) -> Sextuple {
        let (n, m) = split(stress);
        join(n, self.turn.tr_mul(&m) + n.z * self.shortening)
    }
}

/// Change of Dᵀ S with the plain strains at the end of the step, at constant S = `stress`.
#[inline(always)]
fn correction_curvature(before: &Sextuple, now: &Sextuple, stress: &Sextuple, length: f64) -> Matrix3<f64> {
    let ((u0, v0), (u1, v1)) = (turns(before, length), turns(now, length));
    let (mean, last) = (split(&(0.5 * (before + now))).1, split(now).1);
    let (n, m) = (stress[2], split(stress).1);
    let square = length * length;
    let along = mean.dot(&m);
    let turning = 1.0 / 6.0 + 0.075 * (u0 + u1);
    let shortening = 1.0 / 6.0 + 17.0 / 360.0 * (v0 + v1);
    let [bent, bent_last] = [mean, last].map(|k| Vector3::new(k.x, k.y, 0.0));
    square * (1.0 / 6.0 + 0.15 * u1) * m * last.transpose()
        + square * turning * (Matrix3::from_diagonal_element(along) + mean * m.transpose())
        + 0.3 * square * square * along * mean * last.transpose()
        + square * shortening * n * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0))
        + 17.0 / 90.0 * square * square * n * bent * bent_last.transpose()
}

impl StepStrain<'_> {
    /// Mean stress conjugate to the starred strains.
    #[inline(always)]
    fn starred(&self) -> Sextuple {
        let [law, damping] = self.laws;
        let [start, end] = self.strains.map(|strain| corrected(strain, self.length));
        let elastic = law.diagonal().component_mul(&(0.5 * (start + end) - self.rest));
        elastic + (self.mixture.rate * damping.diagonal()).component_mul(&(end - start))
    }

    /// Mean stress: its product with the change of the plain strains is the work on an element, per length.
    #[inline(always)]
    pub fn stress(&self) -> Sextuple {
        let [before, now] = self.strains;
        Correction::new(before, now, self.length).tr_mul(&self.starred())
    }

    /// Slope of the stress with the plain strains at the end of the step: stiffness [N] for forces over stretches, and so on.
    #[inline(always)]
    pub fn slope(&self) -> Blocks {
        let ([law, damping], [before, now], length) = (self.laws, self.strains, self.length);
        let share = self.mixture.share;
        let stiffness = share * law.diagonal() + self.mixture.rate * damping.diagonal();
        let (forces, moments) = split(&stiffness);
        let [mean, end] = [before, now].map(|from| Correction::new(from, now, length));
        let mut turned = mean.turn.transpose() * Matrix3::from_diagonal(&moments) * end.turn;
        turned += forces.z * mean.shortening * end.shortening.transpose();
        turned += 2.0 * share * correction_curvature(before, now, &self.starred(), length);
        let axial = forces.z * Vector3::z();
        [
            [
                Matrix3::from_diagonal(&forces),
                axial * end.shortening.transpose(),
            ],
            [mean.shortening * axial.transpose(), turned],
        ]
    }
}

/// Strain (Γ, K) of a straight beam without stress.
pub fn straight() -> Sextuple {
    Sextuple::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
}

/// Strain (Γ, K) between two sections an unstretched length [m] apart.
#[inline(always)]
pub fn strain(a: &Section, b: &Section, length: f64) -> Sextuple {
    let stretch = 0.5 * (a.frame + b.frame).tr_mul(&(b.position - a.position));
    let turn = axial(&a.frame.tr_mul(&b.frame));
    join(stretch, turn) / length
}

/// ∂(Γ, K)/∂(φ, spin) of sections a and b, K [1/m] over φ [m] and spin [rad]: [[∓A, R], [0, ∓Q]] with the upper signs for a.
#[derive(Debug, Clone, Copy)]
pub struct StrainGradient {
    /// A = ½ (Λ_a + Λ_b)ᵀ/L [1/m].
    along: Matrix3<f64>,
    /// R = ½ Λᵀ (φ' ×) of both sections [-].
    swept: [Matrix3<f64>; 2],
    /// Q, of the rows q_k/L [1/m].
    turn: Matrix3<f64>,
}

/// Returns the values for sections a and b; `map` of an array would move these matrices through memory.
#[inline(always)]
fn both<T>(value: impl Fn(usize) -> T) -> [T; 2] {
    [value(0), value(1)]
}

/// Signs of A and Q for sections a and b.
const SIGNS: [f64; 2] = [-1.0, 1.0];

impl StrainGradient {
    /// Gradient between two sections an unstretched length [m] apart.
    #[inline(always)]
    pub fn new(a: &Section, b: &Section, length: f64) -> StrainGradient {
        let per_length = 1.0 / length;
        let slope = skew(0.5 * per_length * (b.position - a.position)); // ½ φ' ×
        StrainGradient {
            along: 0.5 * per_length * (a.frame + b.frame).transpose(),
            swept: [a.frame.tr_mul(&slope), b.frame.tr_mul(&slope)],
            turn: per_length * turn_gradient(a, b),
        }
    }

    /// Change of the strains due to changes of positions and spins of both sections.
    pub fn times(&self, [a, b]: [Sextuple; 2]) -> Sextuple {
        let [(shift_a, spin_a), (shift_b, spin_b)] = [split(&a), split(&b)];
        let stretch = self.along * (shift_b - shift_a) + self.swept[0] * spin_a + self.swept[1] * spin_b;
        join(stretch, self.turn * (spin_b - spin_a))
    }

    /// Forces and moments per length of a stress on both sections.
    #[inline(always)]
    pub fn tr_mul(&self, stress: &Sextuple) -> [Sextuple; 2] {
        let (n, m) = split(stress);
        let (pull, moment) = (self.along.tr_mul(&n), self.turn.tr_mul(&m));
        both(|side| {
            join(
                SIGNS[side] * pull,
                self.swept[side].tr_mul(&n) + SIGNS[side] * moment,
            )
        })
    }

    /// Change of [`StrainGradient::tr_mul`] with positions and spins of the sections at which the strains change by the gradient `now`, with the
    /// `slope` of the stress.
    #[inline(always)]
    pub fn stiffness(&self, slope: &Blocks, now: &StrainGradient) -> Stiffness {
        let shift = both(|part| slope[part][0] * now.along);
        let turn = both(|part| slope[part][1] * now.turn);
        let spin =
            |part: usize, column: usize| slope[part][0] * now.swept[column] + SIGNS[column] * turn[part];
        let force = both(|column| spin(0, column));
        Stiffness {
            stretched: self.along.tr_mul(&shift[0]),
            bent: self.turn.tr_mul(&shift[1]),
            pulled: both(|column| self.along.tr_mul(&force[column])),
            twisted: both(|column| self.turn.tr_mul(&spin(1, column))),
            swept: both(|row| self.swept[row].tr_mul(&shift[0])),
            turned: both(|row| both(|column| self.swept[row].tr_mul(&force[column]))),
        }
    }
}

/// Products of strain gradients and the slope of a stress, from which the blocks of an element's tangent are composed.
pub struct Stiffness {
    stretched: Matrix3<f64>,
    bent: Matrix3<f64>,
    pulled: [Matrix3<f64>; 2],
    twisted: [Matrix3<f64>; 2],
    swept: [Matrix3<f64>; 2],
    turned: [[Matrix3<f64>; 2]; 2],
}

impl Stiffness {
    /// Change of force and moment on the section `row` with position and spin of the section `column`.
    #[inline(always)]
    pub fn block(&self, row: usize, column: usize) -> Blocks {
        let (up, across) = (SIGNS[row], SIGNS[column]);
        [
            [up * across * self.stretched, up * self.pulled[column]],
            [
                across * (self.swept[row] + up * self.bent),
                self.turned[row][column] + up * self.twisted[column],
            ],
        ]
    }
}

/// Rows q_k = ½ ε_kij d_i^b × d_j^a.
#[inline(always)]
fn turn_gradient(a: &Section, b: &Section) -> Matrix3<f64> {
    let director = |section: &Section, i: usize| section.frame.column(i).into_owned();
    let row = |i: usize, j: usize| {
        0.5 * (director(b, i).cross(&director(a, j)) - director(b, j).cross(&director(a, i)))
    };
    Matrix3::from_columns(&[row(1, 2), row(2, 0), row(0, 1)]).transpose()
}

/// Change of the forces and moments of both sections, [`StrainGradient::tr_mul`] at the mean sections times the length, with positions and spins
/// of the sections after the step, at constant stress; the mean sections follow by a part of the change.
pub struct GeometricStiffness {
    carried: [Matrix3<f64>; 2],
    turned: [Matrix3<f64>; 2],
    moment: [Matrix3<f64>; 2],
    swept: [Matrix3<f64>; 2],
}

impl GeometricStiffness {
    /// For the sections `mean` and `now`, a `stress`, and the part `share` [-].
    #[inline(always)]
    pub fn new(mean: [&Section; 2], now: [&Section; 2], stress: &Sextuple, share: f64) -> GeometricStiffness {
        let (n, m) = split(stress);
        let half = 0.5 * share;
        let chord = skew(mean[1].position - mean[0].position);
        let turned = both(|i| skew(half * now[i].frame * n));
        let moment = skew(half * m);
        let by_b = now[1].frame * moment * mean[0].frame.transpose();
        let by_a = mean[1].frame * moment * now[0].frame.transpose();
        GeometricStiffness {
            carried: both(|i| skew(half * mean[i].frame * n)), // ν ×
            moment: [
                Matrix3::from_diagonal_element(by_a.trace()) - by_a.transpose(),
                by_b - Matrix3::from_diagonal_element(by_b.trace()),
            ],
            swept: both(|i| chord * turned[i]),
            turned,
        }
    }

    /// Change of force and moment on the section `row` with position and spin of the section `column`.
    #[inline(always)]
    pub fn block(&self, row: usize, column: usize) -> Blocks {
        let (up, across) = (SIGNS[row], SIGNS[column]);
        let mut turn = -up * self.moment[column];
        if row == column {
            turn += self.swept[row];
        }
        [
            [Matrix3::zeros(), -up * self.turned[column]],
            [across * self.carried[row], turn],
        ]
    }
}

/// The parts of a strain or stress that belong to forces [N] and to moments [N m].
#[inline(always)]
pub fn split(both: &Sextuple) -> (Vector3<f64>, Vector3<f64>) {
    (
        both.fixed_rows::<3>(0).into_owned(),
        both.fixed_rows::<3>(3).into_owned(),
    )
}

/// The inverse of [`split`].
#[inline(always)]
pub fn join(force: Vector3<f64>, moment: Vector3<f64>) -> Sextuple {
    Sextuple::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rotation::cayley;
    use crate::math::tests::central;
    use approx::assert_relative_eq;

    const LENGTH: f64 = 0.7;
    const STRESS: Sextuple = Sextuple::new(3.0, -2.0, 5.0, 0.7, 1.1, -0.9);

    fn section(position: Vector3<f64>, frame: Matrix3<f64>) -> Section {
        Section { position, frame }
    }

    fn pair() -> [Section; 2] {
        [
            section(Vector3::new(0.1, -0.2, 0.3), cayley(Vector3::new(0.3, 0.1, -0.5))),
            section(Vector3::new(0.2, 0.1, 0.9), cayley(Vector3::new(0.5, -0.3, 0.1))),
        ]
    }

    fn later() -> [Section; 2] {
        let (turn, shift) = (cayley(Vector3::new(-0.2, 0.9, 0.4)), Vector3::new(0.0, 0.1, 0.2));
        pair().map(|old| section(1.1 * old.position + shift, turn * old.frame))
    }

    fn means(before: &[Section; 2], now: &[Section; 2]) -> [Section; 2] {
        [before[0].mean(&now[0]), before[1].mean(&now[1])]
    }

    /// One of the twelve unknowns moved: position, then spin, of section a, then b.
    fn moved(sections: [Section; 2], unknown: usize, by: f64) -> [Section; 2] {
        let mut sections = sections;
        let section = &mut sections[unknown / 6];
        let mut step = Vector3::zeros();
        step[unknown % 3] = by;
        if unknown % 6 < 3 {
            section.position += step;
        } else {
            section.frame = cayley(step) * section.frame;
        }
        sections
    }

    fn column_of(blocks: &Blocks, unknown: usize) -> Sextuple {
        let part = |row: usize| blocks[row][unknown / 3].column(unknown % 3).into_owned();
        join(part(0), part(1))
    }

    fn strain_of([a, b]: [Section; 2]) -> Sextuple {
        strain(&a, &b, LENGTH)
    }

    #[test]
    fn the_strain_gradient_equals_central_differences() {
        let [a, b] = pair();
        let gradient = StrainGradient::new(&a, &b, LENGTH);
        for unknown in 0..12 {
            let difference = central(1e-6, |by| strain_of(moved(pair(), unknown, by)));
            let mut unit = [Sextuple::zeros(); 2];
            unit[unknown / 6][unknown % 6] = 1.0;
            let column = gradient.times(unit);
            assert_relative_eq!(column, difference, epsilon = 1e-8);
        }
    }

    #[test]
    fn the_geometric_stiffness_equals_central_differences() {
        let before = pair();
        let loads = |now: [Section; 2]| {
            let mean = means(&before, &now);
            let gradient = StrainGradient::new(&mean[0], &mean[1], LENGTH);
            gradient.tr_mul(&STRESS).map(|action| LENGTH * action)
        };
        let now = later();
        let mean = means(&before, &now);
        let [m, n] = [[&mean[0], &mean[1]], [&now[0], &now[1]]];
        let stiffness = GeometricStiffness::new(m, n, &STRESS, 0.5);
        for unknown in 0..12 {
            for row in 0..2 {
                let difference = central(1e-6, |by| loads(moved(now, unknown, by))[row]);
                let column = column_of(&stiffness.block(row, unknown / 6), unknown % 6);
                assert_relative_eq!(column, difference, epsilon = 1e-8);
            }
        }
    }

    #[test]
    fn the_gradient_at_the_mean_times_the_change_is_the_change_of_strain() {
        let (before, thetas) = (
            pair(),
            [Vector3::new(0.4, -0.7, 0.2), Vector3::new(0.1, 0.3, 1.2)],
        );
        let shift = |i: usize| Vector3::new(0.2, i as f64, -0.3);
        let now = [0, 1].map(|i| section(before[i].position + shift(i), cayley(thetas[i]) * before[i].frame));
        let mean = means(&before, &now);
        let gradient = StrainGradient::new(&mean[0], &mean[1], LENGTH);
        let change = gradient.times([0, 1].map(|i| join(now[i].position - before[i].position, thetas[i])));
        assert_relative_eq!(change, strain_of(now) - strain_of(before), epsilon = 1e-14);
    }

    #[test]
    fn rotating_and_moving_the_world_changes_no_strain() {
        let turn = cayley(Vector3::new(1.0, -2.0, 0.5));
        let shift = Vector3::new(10.0, 20.0, -30.0);
        let turned = pair().map(|old| section(turn * old.position + shift, turn * old.frame));
        assert_relative_eq!(strain_of(turned), strain_of(pair()), epsilon = 1e-13);
    }

    #[test]
    fn forces_and_moments_of_a_stress_are_in_balance() {
        let [a, b] = pair();
        let actions = StrainGradient::new(&a, &b, LENGTH).tr_mul(&STRESS);
        let [at_a, at_b] = actions.map(|action| split(&(LENGTH * action)));
        assert_relative_eq!(at_a.0 + at_b.0, Vector3::zeros(), epsilon = 1e-14);
        let moment = at_a.1 + at_b.1 + (b.position - a.position).cross(&at_b.0);
        assert_relative_eq!(moment, Vector3::zeros(), epsilon = 1e-14);
    }

    #[test]
    fn a_straight_beam_has_no_curvature_and_an_arc_has_its_own() {
        let first = section(Vector3::zeros(), Matrix3::identity());
        let to = |frame| strain_of([first, section(LENGTH * Vector3::z(), frame)]);
        assert_relative_eq!(to(Matrix3::identity()), straight(), epsilon = 1e-15);
        let angle: f64 = 1e-4; // about d₁ by an angle over the length
        let arc = to(cayley(angle * Vector3::x()));
        assert_relative_eq!(arc[3], angle / LENGTH, max_relative = 1e-8);
    }

    const fn law([shear, axial, bending, torsion]: [f64; 4]) -> SectionLaw {
        SectionLaw {
            shear,
            axial,
            bending,
            torsion,
        }
    }

    const LAW: SectionLaw = law([2.0, 3.0, 5.0, 7.0]);
    const DAMPING: SectionLaw = law([0.1, 0.2, 0.3, 0.4]);

    fn strains() -> [Sextuple; 2] {
        [strain_of(pair()), strain_of(later())].map(|s| s + 0.3 * STRESS / 5.0)
    }

    #[test]
    fn the_stress_of_a_step_does_the_work_that_the_energy_changes_by() {
        let [before, now] = strains();
        let rest = straight();
        let energy = |plain: &Sextuple| {
            let strain = corrected(plain, LENGTH) - rest;
            LAW.energy(&strain, LENGTH).total()
        };
        let (share, rate) = (0.5, 3.0);
        let by = |damping| {
            let step = StepStrain {
                laws: [&LAW, damping],
                length: LENGTH,
                strains: [&before, &now],
                rest: &rest,
                mixture: Mixture { share, rate },
            };
            step.stress()
        };
        let (at, damped) = (by(&law([0.0; 4])), by(&DAMPING));
        let work = LENGTH * at.dot(&(now - before));
        assert_relative_eq!(work, energy(&now) - energy(&before), epsilon = 1e-13);
        assert!((damped - at).dot(&(now - before)) > 0.0);
    }

    #[test]
    fn the_slope_of_the_stress_equals_central_differences() {
        let [before, now] = strains();
        let rest = straight();
        for (share, rate, still) in [(0.5, 3.0, false), (1.0, 0.0, true)] {
            let at = |now: Sextuple| {
                let from = if still { now } else { before };
                let step = StepStrain {
                    laws: [&LAW, &DAMPING],
                    length: LENGTH,
                    strains: [&from, &now],
                    rest: &rest,
                    mixture: Mixture { share, rate },
                };
                (step.stress(), step.slope())
            };
            for unknown in 0..6 {
                let difference = central(1e-6, |h| at(now + h * Sextuple::ith(unknown, 1.0)).0);
                let column = column_of(&at(now).1, unknown);
                assert_relative_eq!(column, difference, epsilon = 1e-7);
            }
        }
    }

    #[test]
    fn the_starred_strains_of_an_arc_are_its_own_to_fourth_order() {
        for (angle, tolerance) in [(0.1_f64, 1e-7), (0.2, 4e-6), (0.4, 2.6e-4)] {
            let radius = LENGTH / angle;
            let at = |turn: f64| {
                let place = radius * Vector3::new(0.0, turn.cos() - 1.0, turn.sin());
                section(place, cayley(2.0 * (0.5 * turn).tan() * Vector3::x()))
            };
            let starred = corrected(&strain_of([at(0.0), at(angle)]), LENGTH);
            assert_relative_eq!(starred[3] * LENGTH, angle, max_relative = tolerance);
            assert_relative_eq!(starred[2], 1.0, max_relative = tolerance);
        }
    }

    #[test]
    fn the_energy_is_the_sum_of_its_parts() {
        let law = LAW;
        let total = 0.5 * LENGTH * STRESS.dot(&law.diagonal().component_mul(&STRESS));
        assert_relative_eq!(law.energy(&STRESS, LENGTH).total(), total, max_relative = 1e-15);
    }
}
