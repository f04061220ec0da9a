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
//! Across a turn by α, LK is sin α along the axis of the turn, and Γ₃ on an unstretched arc is sin α/α. The law uses the strains
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
//! plain ones: ΔK* = [h̄ I + 2L² h[u₀,u₁] K̄ K̄ᵀ] ΔK, ΔΓ₃* = ΔΓ₃ + 2L² p[v₀,v₁] (K̄₁ΔK₁ + K̄₂ΔK₂), with bars for means over the step.
//!
//! Source: strains by Simo (1985), Comput. Methods Appl. Mech. Eng. 49, 55-70; directors interpolated as in Romero & Armero (2002),
//! Int. J. Numer. Methods Eng. 54, 1683-1716, and Betsch & Steinmann (2002), ibid. 54, 1775-1788; discrete gradients by Gonzalez (1996),
//! J. Nonlinear Sci. 6, 449-467; starred strains and slopes derived here, checked by differences. Valid for small strain; neighbouring
//! sections must differ by less than a quarter turn, at which K goes through its maximum.

use nalgebra::{Matrix3, Vector3, Vector6};

use crate::math::real::{Real, RealVector};
use crate::math::triad::{Triad, componentwise, each, repeated};

/// Cross-section, or its mean over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Position φ [m].
    pub position: Vector3<f64>,
    /// Directors d₁, d₂, d₃ as columns [-].
    pub frame: Matrix3<f64>,
}

/// Six components of a section: Γ or N as the first three, K or M as the last three.
pub type Sextuple = Vector6<f64>;

/// Stiffness or damping of a section along its directors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionLaw {
    /// Shear stiffness GA, the same across both directors [N], or its damping [N s].
    pub shear: f64,
    /// Axial stiffness EA [N], or its damping [N s].
    pub axial: f64,
    /// Bending stiffness EI, the same about both directors [N m²], or its damping [N m² s].
    pub bending: f64,
    /// Torsional stiffness GJ [N m²], or its damping [N m² s].
    pub torsion: f64,
}

/// Strain energy by kind.
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

/// Cross-section, or one in every lane.
#[derive(Debug, Clone, Copy)]
pub struct Station<V> {
    /// Position φ [m].
    pub position: V,
    /// Directors d₁, d₂, d₃ [-].
    pub directors: Triad<V>,
}

/// Strain (Γ, K) or stress (N, M) of one section, or of one in every lane.
pub type Pair<V> = [V; 2];

impl<V: RealVector> Station<V> {
    /// Mean of two sections; its directors are neither of unit length nor orthogonal.
    #[inline(always)]
    pub fn mean(&self, other: &Station<V>) -> Station<V> {
        let half = V::Real::splat(0.5);
        Station {
            position: (self.position + other.position).scaled(half),
            directors: (self.directors + other.directors).scaled(half),
        }
    }
}

impl From<&Section> for Station<Vector3<f64>> {
    #[inline(always)]
    fn from(section: &Section) -> Self {
        Station {
            position: section.position,
            directors: Triad(each!(i in [0, 1, 2] => section.frame.column(i).into_owned())),
        }
    }
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
    #[inline(always)]
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

/// Weights of the strains before and after a step in its stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mixture {
    /// Fraction of the change of strain over the step that acts [-]: ½; in statics, where both ends are the same, 1.
    pub share: f64,
    /// 1/Δt [1/s]; 0 in statics.
    pub rate: f64,
}

/// Element over a step or at rest, or one in every lane.
#[derive(Debug, Clone, Copy)]
pub struct StepStrain<V: RealVector> {
    /// Stiffness and damping of the section, each as the numbers that multiply Γ and K.
    pub laws: [Pair<V>; 2],
    /// Unstretched length [m].
    pub length: V::Real,
    /// Plain strains before and after the step.
    pub strains: [Pair<V>; 2],
    /// Starred strains without stress.
    pub rest: Pair<V>,
    /// Weights of both strains.
    pub mixture: Mixture,
}

/// Slope of a stress with respect to the plain strains at the end of a step: [[C, EA ẑ s₁ᵀ], [s₀ EA ẑᵀ, H + s₀ EA s₁ᵀ]], with the s of the step and
/// of its end.
pub struct Slope<V> {
    /// C, diagonal [N].
    forces: V,
    /// s₀ and s₁ [m].
    shortening: [V; 2],
    /// H [N m²].
    moments: Triad<V>,
}

/// Starred strains (Γ*, K*) of plain ones (Γ, K) over an unstretched length [m].
#[inline(always)]
pub fn starred<V: RealVector>(strain: Pair<V>, length: V::Real) -> Pair<V> {
    let number = V::Real::splat;
    let ([stretch, curvature], (u, v)) = (strain, turns(strain, length));
    let shortening = v * (number(1.0 / 6.0) + number(17.0 / 360.0) * v);
    [
        stretch + along_axis(shortening),
        curvature.scaled(number(1.0) + u * (number(1.0 / 6.0) + number(0.075) * u)),
    ]
}

/// Starred strains of one section, as from [`starred`].
pub fn corrected(strain: &Sextuple, length: f64) -> Sextuple {
    let [stretch, curvature] = starred(split(strain).into(), length);
    join(stretch, curvature)
}

/// a ẑ.
#[inline(always)]
fn along_axis<V: RealVector>(a: V::Real) -> V {
    let zero = V::Real::splat(0.0);
    V::of([zero, zero, a])
}

/// Vector without its third component.
#[inline(always)]
fn across_axis<V: RealVector>(v: V) -> V {
    let [x, y, _] = v.components();
    V::of([x, y, V::Real::splat(0.0)])
}

/// u and v: squares of the sine of the turn, and of its part about the first two directors.
#[inline(always)]
fn turns<V: RealVector>([_, curvature]: Pair<V>, length: V::Real) -> (V::Real, V::Real) {
    let [x, y, z] = curvature.scaled(length).components();
    let v = x * x + y * y;
    (v + z * z, v)
}

/// D = [[I, ẑ sᵀ], [0, H]], H = h I + τ K̄ K̄ᵀ: its product with the change of the plain strains is the change of the starred ones.
#[derive(Clone, Copy)]
struct Correction<V: RealVector> {
    /// h [-].
    plain: V::Real,
    /// τ [m²].
    turning: V::Real,
    /// K̄ [1/m].
    curvature: V,
    /// s [m].
    shortening: V,
}

impl<V: RealVector> Correction<V> {
    #[inline(always)]
    fn new(before: Pair<V>, now: Pair<V>, length: V::Real) -> Correction<V> {
        let number = V::Real::splat;
        let ((u0, v0), (u1, v1)) = (turns(before, length), turns(now, length));
        let curvature = (before[1] + now[1]).scaled(number(0.5));
        let twice = number(2.0) * length * length;
        let shortening = twice * (number(1.0 / 6.0) + number(17.0 / 360.0) * (v0 + v1));
        Correction {
            plain: number(1.0) + number(1.0 / 12.0) * (u0 + u1) + number(0.0375) * (u0 * u0 + u1 * u1),
            turning: twice * (number(1.0 / 6.0) + number(0.075) * (u0 + u1)),
            curvature,
            shortening: across_axis(curvature).scaled(shortening),
        }
    }

    /// H x, and Hᵀ x.
    #[inline(always)]
    fn turned(&self, x: V) -> V {
        x.scaled(self.plain) + self.curvature.scaled(self.turning * self.curvature.inner(x))
    }

    /// D E.
    #[inline(always)]
    fn times(&self, [stretch, curvature]: Pair<V>) -> Pair<V> {
        let shortened = along_axis(self.shortening.inner(curvature));
        [stretch + shortened, self.turned(curvature)]
    }

    /// Dᵀ S.
    #[inline(always)]
    fn tr_times(&self, [n, m]: Pair<V>) -> Pair<V> {
        let [_, _, axial] = n.components();
        [n, self.turned(m) + self.shortening.scaled(axial)]
    }
}

/// Slope of Dᵀ S with respect to the plain strains at the end of the step, at constant S = `stress`.
#[inline(always)]
fn correction_curvature<V: RealVector>(
    [before, now]: [Pair<V>; 2],
    [force, m]: Pair<V>,
    length: V::Real,
) -> Triad<V> {
    let number = V::Real::splat;
    let ((u0, v0), (u1, v1)) = (turns(before, length), turns(now, length));
    let (mean, last) = ((before[1] + now[1]).scaled(number(0.5)), now[1]);
    let ([_, _, n], square) = (force.components(), length * length);
    let along = mean.inner(m);
    let turning = square * (number(1.0 / 6.0) + number(0.075) * (u0 + u1));
    let shortening = square * n * (number(1.0 / 6.0) + number(17.0 / 360.0) * (v0 + v1));
    let bending = number(17.0 / 90.0) * square * square * n;
    let with_last = m.scaled(square * (number(1.0 / 6.0) + number(0.15) * u1))
        + mean.scaled(number(0.3) * square * square * along);
    let plain = turning * along;
    let [bent, bent_last] = [across_axis(mean), across_axis(last)];
    Triad::dyad(with_last, last)
        + Triad::dyad(mean.scaled(turning), m)
        + Triad::dyad(bent.scaled(bending), bent_last)
        + Triad::diagonal(V::of([plain + shortening, plain + shortening, plain]))
}

impl<V: RealVector> StepStrain<V> {
    /// Mean stress conjugate to the starred strains.
    #[inline(always)]
    fn starred(&self) -> Pair<V> {
        let number = V::Real::splat;
        let [law, damping] = self.laws;
        let [start, end] = each!(end in [0, 1] => starred(self.strains[end], self.length));
        each!(k in [0, 1] => {
            let strained = (start[k] + end[k]).scaled(number(0.5)) - self.rest[k];
            let rate = (end[k] - start[k]).scaled(number(self.mixture.rate));
            componentwise(law[k], strained) + componentwise(damping[k], rate)
        })
    }

    /// Mean stress: its product with the change of the plain strains is the work on an element, per length.
    #[inline(always)]
    pub fn stress(&self) -> Pair<V> {
        let [before, now] = self.strains;
        Correction::new(before, now, self.length).tr_times(self.starred())
    }

    /// Sum of [`StepStrain::stress`] and the stress of the dampers at a rate of the plain strains [1/s], [1/(m s)].
    pub fn stress_at_rate(&self, rate: Pair<V>) -> Pair<V> {
        let [before, now] = self.strains;
        let correction = Correction::new(before, now, self.length);
        let (starred, rate) = (self.starred(), correction.times(rate));
        correction.tr_times(each!(k in [0, 1] => starred[k] + componentwise(self.laws[1][k], rate[k])))
    }

    /// Slope of the stress with respect to the plain strains at the end of the step.
    #[inline(always)]
    pub fn slope(&self) -> Slope<V> {
        let number = V::Real::splat;
        let ([law, damping], [before, now]) = (self.laws, self.strains);
        let Mixture { share, rate } = self.mixture;
        let [forces, moments] =
            each!(k in [0, 1] => law[k].scaled(number(share)) + damping[k].scaled(number(rate)));
        let [mean, end] = each!(from in [before, now] => Correction::new(from, now, self.length));
        let turn = Triad::diagonal(repeated(end.plain))
            + Triad::dyad(end.curvature, end.curvature.scaled(end.turning));
        let turned = Triad(each!(j in [0, 1, 2] => mean.turned(componentwise(moments, turn.0[j]))));
        let curved = correction_curvature([before, now], self.starred(), self.length);
        Slope {
            forces,
            shortening: [mean.shortening, end.shortening],
            moments: turned + curved.scaled(number(2.0 * share)),
        }
    }
}

/// Strain (Γ, K) of a straight beam without stress.
pub fn straight() -> Sextuple {
    Sextuple::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
}

/// Strain (Γ, K) between two sections an unstretched length [m] apart.
#[inline(always)]
pub fn strain_between<V: RealVector>(a: &Station<V>, b: &Station<V>, length: V::Real) -> Pair<V> {
    let per_length = V::Real::splat(0.5) * length.recip();
    let stretch = (a.directors + b.directors).tr_times(b.position - a.position);
    let (a, b) = (&a.directors.0, &b.directors.0);
    let turn = V::of([
        b[1].inner(a[2]) - b[2].inner(a[1]),
        b[2].inner(a[0]) - b[0].inner(a[2]),
        b[0].inner(a[1]) - b[1].inner(a[0]),
    ]);
    [stretch.scaled(per_length), turn.scaled(per_length)]
}

/// Strain (Γ, K) between two single sections, as from [`strain_between`].
pub fn strain(a: &Section, b: &Section, length: f64) -> Sextuple {
    let [stretch, curvature] = strain_between(&a.into(), &b.into(), length);
    join(stretch, curvature)
}

/// L ∂(Γ, K)/∂(φ, spin) of sections a and b, given by its rows: ā_i·(δφ_b − δφ_a) + r_i^a·s_a + r_i^b·s_b and q_k·(s_b − s_a).
#[derive(Debug, Clone, Copy)]
pub struct StrainGradient<V> {
    /// ā_i = ½ (d_i^a + d_i^b) [-].
    along: Triad<V>,
    /// r_i = ½ d_i × (φ_b − φ_a) of both sections [m].
    swept: [Triad<V>; 2],
    /// q_k [-].
    turn: Triad<V>,
}

impl<V: RealVector> StrainGradient<V> {
    /// Gradient between two sections.
    #[inline(always)]
    pub fn new(a: &Station<V>, b: &Station<V>) -> StrainGradient<V> {
        let half = V::Real::splat(0.5);
        let chord = (b.position - a.position).scaled(half);
        let (d_a, d_b) = (&a.directors.0, &b.directors.0);
        let swept = each!(d in [d_a, d_b] => Triad(each!(i in [0, 1, 2] => d[i].crossed(chord))));
        let turn = each!(pair in [(1, 2), (2, 0), (0, 1)] => {
            let (i, j) = pair;
            (d_b[i].crossed(d_a[j]) - d_b[j].crossed(d_a[i])).scaled(half)
        });
        StrainGradient {
            along: (a.directors + b.directors).scaled(half),
            swept,
            turn: Triad(turn),
        }
    }

    /// Change of the strains, times the length, due to changes of positions and spins of both sections.
    #[inline(always)]
    pub fn times(&self, [[shift_a, spin_a], [shift_b, spin_b]]: [Pair<V>; 2]) -> Pair<V> {
        let stretch = self.along.tr_times(shift_b - shift_a)
            + self.swept[0].tr_times(spin_a)
            + self.swept[1].tr_times(spin_b);
        [stretch, self.turn.tr_times(spin_b - spin_a)]
    }

    /// Forces [N] and moments [N m] of a stress on both sections.
    #[inline(always)]
    pub fn tr_times(&self, [n, m]: Pair<V>) -> [Pair<V>; 2] {
        let (pull, moment) = (self.along.times(n), self.turn.times(m));
        [
            [
                repeated::<V>(V::Real::splat(0.0)) - pull,
                self.swept[0].times(n) - moment,
            ],
            [pull, self.swept[1].times(n) + moment],
        ]
    }

    /// Rows r_i of both sections for the starred strains, of which Γ₃ also contains s·K.
    #[inline(always)]
    fn shortened(&self, shortening: V) -> [Triad<V>; 2] {
        let change = self.turn.times(shortening);
        let [[a1, a2, a3], [b1, b2, b3]] = [self.swept[0].0, self.swept[1].0];
        [Triad([a1, a2, a3 - change]), Triad([b1, b2, b3 + change])]
    }

    /// Slope of [`StrainGradient::tr_times`] with respect to positions and spins, from the `slope` of the stress and the gradient `now` of the
    /// strains at the end of the step.
    #[inline(always)]
    pub fn stiffness(&self, slope: &Slope<V>, now: &StrainGradient<V>, length: V::Real) -> Stiffness<V> {
        let forces = slope.forces.scaled(length.recip());
        let along = self.along.weighted(forces);
        let left = self.shortened(slope.shortening[0]);
        let left = each!(x in [0, 1] => left[x].weighted(forces));
        let right = now.shortened(slope.shortening[1]);
        let moments = slope.moments.scaled(length.recip());
        let bent = Triad::outer(&self.turn.product(&moments), &now.turn);
        let [[aa, ab], [ba, bb]] =
            each!(x in [0, 1] => each!(y in [0, 1] => Triad::outer(&left[x], &right[y])));
        Stiffness {
            shift: Triad::outer(&along, &now.along),
            pulled: each!(y in [0, 1] => Triad::outer(&along, &right[y])),
            swept: each!(x in [0, 1] => Triad::outer(&left[x], &now.along)),
            turned: [[aa + bent, ab - bent], [ba - bent, bb + bent]],
        }
    }
}

/// w_i, with which the moment m of both sections is ½ Σ d_i^b × w_i: Σ_jk ε_kij m_k d_j^a.
#[inline(always)]
fn arms<V: RealVector>(a: &Station<V>, moment: V) -> Triad<V> {
    let ([d1, d2, d3], [x, y, z]) = (a.directors.0, moment.components());
    Triad([
        d2.scaled(z) - d3.scaled(y),
        d3.scaled(x) - d1.scaled(z),
        d1.scaled(y) - d2.scaled(x),
    ])
}

/// (Σ u_i·v_i) I.
#[inline(always)]
fn trace<V: RealVector>(u: &Triad<V>, v: &Triad<V>) -> Triad<V> {
    let sum = u.0[0].inner(v.0[0]) + u.0[1].inner(v.0[1]) + u.0[2].inner(v.0[2]);
    Triad::diagonal(repeated(sum))
}

/// Slopes of the forces and moments on both sections of an element with respect to their positions and spins. Forces on a and b are opposite, and
/// positions enter by their difference b − a.
pub struct Stiffness<V> {
    /// Slope of the force on b with respect to the difference of the positions [N/m].
    pub shift: Triad<V>,
    /// Slopes of the force on b with respect to the spins of a and b [N].
    pub pulled: [Triad<V>; 2],
    /// Slopes of the moments on a and b with respect to the difference of the positions [N].
    pub swept: [Triad<V>; 2],
    /// Slopes of the moments on a and b (rows) with respect to the spins of a and b (columns) [N m].
    pub turned: [[Triad<V>; 2]; 2],
}

impl<V: RealVector> Stiffness<V> {
    /// Adds the slope of [`StrainGradient::tr_times`] at the sections `mean` with respect to positions and spins of the sections `now` after the
    /// step, at constant stress; the mean sections follow by the fraction `share` [-] of the change.
    #[inline(always)]
    pub fn add_geometric(
        &mut self,
        mean: [&Station<V>; 2],
        now: [&Station<V>; 2],
        [n, m]: Pair<V>,
        share: f64,
    ) {
        let half = V::Real::splat(0.5 * share);
        let (pull, moment) = (n.scaled(half), m.scaled(half));
        let chord = mean[1].position - mean[0].position;
        for x in 0..2 {
            let (held, turned) = (mean[x].directors.times(pull), now[x].directors.times(pull));
            self.pulled[x] = self.pulled[x] - Triad::skew(turned);
            self.swept[x] = self.swept[x] + Triad::skew(held);
            self.turned[x][x] = self.turned[x][x] + Triad::dyad(turned, chord)
                - Triad::diagonal(repeated(turned.inner(chord)));
        }
        let (by_a, by_b) = (arms(now[0], moment), arms(mean[0], moment));
        let (d_mean, d_now) = (&mean[1].directors, &now[1].directors);
        let turned = [
            trace(d_mean, &by_a) - Triad::outer(&by_a, d_mean),
            Triad::outer(d_now, &by_b) - trace(d_now, &by_b),
        ];
        let [at_a, at_b] = &mut self.turned;
        for ((at_a, at_b), turned) in at_a.iter_mut().zip(at_b).zip(turned) {
            *at_a = *at_a - turned;
            *at_b = *at_b + turned;
        }
    }
}

/// Components of a strain or stress that belong to forces [N] and to moments [N m].
#[inline(always)]
pub fn split(both: &Sextuple) -> (Vector3<f64>, Vector3<f64>) {
    (
        both.fixed_rows::<3>(0).into_owned(),
        both.fixed_rows::<3>(3).into_owned(),
    )
}

/// Inverse of [`split`].
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

    #[test]
    fn the_stress_at_a_rate_of_the_strains_is_that_of_a_short_step() {
        let [law, damping] =
            [[7.0, 9.0, 5.0, 3.0], [0.4, 0.9, 0.3, 0.7]].map(|[shear, axial, bending, torsion]| {
                let law = SectionLaw {
                    shear,
                    axial,
                    bending,
                    torsion,
                };
                let pair: Pair<Vector3<f64>> = split(&law.diagonal()).into();
                pair
            });
        let strain: Pair<Vector3<f64>> = [Vector3::new(0.02, -0.01, 1.03), Vector3::new(0.4, -0.3, 0.2)];
        let rate = [Vector3::new(0.3, 0.1, -0.2), Vector3::new(-0.5, 0.7, 0.4)];
        let stress = |dt: f64| {
            let moved = |by: f64| [0, 1].map(|k| strain[k] + by * rate[k]);
            let step = StepStrain {
                laws: [law, damping],
                length: LENGTH,
                strains: [moved(-0.5 * dt), moved(0.5 * dt)],
                rest: split(&straight()).into(),
                mixture: Mixture {
                    share: 0.5,
                    rate: if dt > 0.0 { 1.0 / dt } else { 0.0 },
                },
            };
            match dt > 0.0 {
                true => step.stress(),
                false => step.stress_at_rate(rate),
            }
        };
        for (found, exact) in stress(0.0).iter().zip(stress(1e-5)) {
            assert_relative_eq!(*found, exact, max_relative = 1e-8);
        }
    }

    /// Sections with one of the twelve unknowns moved: position, then spin, of section a, then of b.
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

    /// Column of the six by twelve blocks of an element: rows of the section `row`, one unknown of both sections.
    fn column_of(stiffness: &Stiffness<Vector3<f64>>, row: usize, unknown: usize) -> Sextuple {
        let (of, column, signs) = (unknown / 6, unknown % 3, [-1.0, 1.0]);
        match unknown % 6 < 3 {
            true => {
                signs[of]
                    * join(
                        signs[row] * stiffness.shift.0[column],
                        stiffness.swept[row].0[column],
                    )
            }
            false => join(
                signs[row] * stiffness.pulled[of].0[column],
                stiffness.turned[row][of].0[column],
            ),
        }
    }

    fn stations(sections: &[Section; 2]) -> [Station<Vector3<f64>>; 2] {
        sections.each_ref().map(Station::from)
    }

    fn gradient(sections: &[Section; 2]) -> StrainGradient<Vector3<f64>> {
        let [a, b] = stations(sections);
        StrainGradient::new(&a, &b)
    }

    fn actions(sections: &[Section; 2], stress: &Sextuple) -> [Sextuple; 2] {
        gradient(sections)
            .tr_times(split(stress).into())
            .map(|[force, moment]| join(force, moment))
    }

    fn pair_of(strain: &Sextuple) -> Pair<Vector3<f64>> {
        split(strain).into()
    }

    fn strain_of([a, b]: [Section; 2]) -> Sextuple {
        strain(&a, &b, LENGTH)
    }

    #[test]
    fn the_strain_gradient_equals_central_differences() {
        for unknown in 0..12 {
            let difference = central(1e-6, |by| strain_of(moved(pair(), unknown, by)));
            let mut unit = [[Vector3::zeros(); 2]; 2];
            unit[unknown / 6][unknown % 6 / 3][unknown % 3] = 1.0;
            let [stretch, turn] = gradient(&pair()).times(unit);
            assert_relative_eq!(join(stretch, turn) / LENGTH, difference, epsilon = 1e-8);
        }
    }

    #[test]
    fn the_stiffness_of_an_element_over_a_step_equals_central_differences() {
        let (before, now) = (pair(), later());
        let step = |now: [Section; 2]| StepStrain {
            laws: [&LAW, &DAMPING].map(|law| split(&law.diagonal()).into()),
            length: LENGTH,
            strains: [strain_of(before), strain_of(now)].map(|strain| pair_of(&strain)),
            rest: pair_of(&straight()),
            mixture: Mixture {
                share: 0.5,
                rate: 3.0,
            },
        };
        let loads = |now: [Section; 2]| {
            let [stretch, turn] = step(now).stress();
            actions(&means(&before, &now), &join(stretch, turn))
        };
        let [mean, end] = [means(&before, &now), now];
        let mut stiffness = gradient(&mean).stiffness(&step(now).slope(), &gradient(&end), LENGTH);
        let ([a, b], [c, d]) = (stations(&mean), stations(&end));
        stiffness.add_geometric([&a, &b], [&c, &d], step(now).stress(), 0.5);
        for unknown in 0..12 {
            for row in 0..2 {
                let difference = central(1e-6, |by| loads(moved(now, unknown, by))[row]);
                let column = column_of(&stiffness, row, unknown);
                assert_relative_eq!(column, difference, epsilon = 1e-7);
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
        let moved = [0, 1].map(|i| [now[i].position - before[i].position, thetas[i]]);
        let [stretch, turn] = gradient(&means(&before, &now)).times(moved);
        let change = join(stretch, turn) / LENGTH;
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
        let [at_a, at_b] = actions(&pair(), &STRESS).map(|action| split(&action));
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
                laws: [&LAW, damping].map(|law| pair_of(&law.diagonal())),
                length: LENGTH,
                strains: [pair_of(&before), pair_of(&now)],
                rest: pair_of(&rest),
                mixture: Mixture { share, rate },
            };
            let [force, moment] = step.stress();
            join(force, moment)
        };
        let (at, damped) = (by(&law([0.0; 4])), by(&DAMPING));
        let work = LENGTH * at.dot(&(now - before));
        assert_relative_eq!(work, energy(&now) - energy(&before), epsilon = 1e-13);
        assert!((damped - at).dot(&(now - before)) > 0.0);
    }

    #[test]
    fn the_slope_of_the_stress_equals_central_differences() {
        let [before, now] = strains();
        for (share, rate, still) in [(0.5, 3.0, false), (1.0, 0.0, true)] {
            let at = |now: Sextuple| {
                let from = if still { now } else { before };
                StepStrain {
                    laws: [&LAW, &DAMPING].map(|law| pair_of(&law.diagonal())),
                    length: LENGTH,
                    strains: [pair_of(&from), pair_of(&now)],
                    rest: pair_of(&straight()),
                    mixture: Mixture { share, rate },
                }
            };
            let Slope {
                forces,
                shortening: [mean, end],
                moments,
            } = at(now).slope();
            let axis = forces.z * Vector3::z();
            for unknown in 0..6 {
                let difference = central(1e-6, |h| {
                    let [force, moment] = at(now + h * Sextuple::ith(unknown, 1.0)).stress();
                    join(force, moment)
                });
                let i = unknown % 3;
                let column = match unknown < 3 {
                    true => join(forces[i] * Vector3::ith(i, 1.0), axis[i] * mean),
                    false => join(end[i] * axis, moments.0[i] + forces.z * end[i] * mean),
                };
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
