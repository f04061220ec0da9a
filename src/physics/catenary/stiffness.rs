//! Derivatives of the end forces of a solved catenary with respect to the displacements of its ends, in the vertical plane through them.
//!
//! A line in free flight under end forces (H, V) spans (X, Z). Every element ds turns and stretches under a change of them, so that
//! with t the direction of the tension T and p the unit vector across it
//!
//! C = ∂(X, Z)/∂(H, V) = ∫ (p pᵀ/T + 1/EA) ds,   ∂(H, V)/∂(X, Z) = C⁻¹.
//!
//! C is set up along and across the mean direction of the tension: a taut line is far stiffer along than across, and in other axes the difference
//! would be lost to rounding. Where the direction varies little over a section, ∫ is a Gauss rule; elsewhere, with T² = H² + V², V' = w,
//!
//! ∫ H²/T³ ds = (1/w) [V/T],   ∫ HV/T³ ds = −(H/w) [1/T],   ∫ V²/T³ ds = (1/w) [asinh(V/H) − V/T].
//!
//! Source: derived here. Valid for any weights, including H = 0, where a folded line has no stiffness across and w/2 along. A line that touches the
//! seabed is solved again with its ends slightly displaced instead.

use nalgebra::{Matrix2, Vector2};

use super::{Catenary, Section};

/// Weight of a section, relative to its smaller end tension, below which it is treated as nearly straight [-].
const STRAIGHT: f64 = 0.5;

/// Points in 0 … 1 and weights of the four-point Gauss rule [-].
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_7, 0.173_927_422_568_726_9),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_1),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
    (0.930_568_155_797_026_2, 0.173_927_422_568_726_9),
];

/// ∂(H, V)/∂(X, Z) of a line in free flight [N/m].
pub fn in_flight(sections: &[Section], solved: &Catenary) -> Matrix2<f64> {
    let (horizontal, mut vertical) = (solved.horizontal_a(), solved.vertical_a());
    if horizontal == 0.0 {
        return hanging_vertically(sections, vertical);
    }
    let mean = Vector2::new(horizontal, 0.5 * (vertical + solved.vertical_b())).normalize();
    let frame = Matrix2::new(mean.x, mean.y, -mean.y, mean.x); // rows: along, across
    let mut compliance = Matrix2::zeros();
    for section in sections {
        let end = vertical + section.weight * section.length;
        let stretch = section.length / section.axial_stiffness;
        compliance += turning(section, horizontal, [vertical, end], &frame) + Matrix2::identity() * stretch;
        vertical = end;
    }
    let stiffness = compliance.try_inverse().unwrap_or_else(Matrix2::zeros);
    frame.transpose() * stiffness * frame
}

/// ∫ p pᵀ/T ds along and across [m/N]: the turning of a section's elements.
fn turning(section: &Section, h: f64, [start, end]: [f64; 2], frame: &Matrix2<f64>) -> Matrix2<f64> {
    let weight = section.weight * section.length;
    let tensions = [h.hypot(start), h.hypot(end)];
    if weight.abs() < STRAIGHT * tensions[0].min(tensions[1]) {
        let at = |(u, share): (f64, f64)| {
            let pull = frame * Vector2::new(h, start + u * weight); // T t
            let across = Vector2::new(-pull.y, pull.x); // T p
            share * section.length / pull.norm().powi(3) * across * across.transpose()
        };
        return GAUSS.into_iter().map(at).sum();
    }
    let [zz, xz, inverse] = integrals(section, h, [start, end], tensions);
    frame * Matrix2::new(inverse - zz, -xz, -xz, zz) * frame.transpose()
}

/// ∫ H²/T³ ds, ∫ HV/T³ ds and ∫ ds/T of a section with non-zero weight [m/N].
fn integrals(section: &Section, h: f64, [v0, v1]: [f64; 2], [t0, t1]: [f64; 2]) -> [f64; 3] {
    let (l, w) = (section.length, section.weight);
    let sum = v0 + v1;
    let zz = if v0 * v1 > 0.0 {
        h * h * l * sum / (t0 * t1 * (v1 * t0 + v0 * t1))
    } else {
        (v1 / t1 - v0 / t0) / w
    };
    let xz = h * l * sum / (t0 * t1 * (t0 + t1));
    // asinh(V/H) without the cancellation of V + T for negative V
    let log = |v: f64, t: f64| ((v.abs() + t) / h).ln().copysign(v);
    [zz, xz, (log(v1, t1) - log(v0, t0)) / w]
}

/// Stiffness of a line that hangs straight down, straight up or folded: H = 0.
fn hanging_vertically(sections: &[Section], mut vertical: f64) -> Matrix2<f64> {
    let mut compliance = Vector2::zeros();
    for section in sections {
        let (start, w) = (vertical, section.weight);
        vertical += w * section.length;
        let stretch = section.length / section.axial_stiffness;
        let swing = match (start * vertical > 0.0, w == 0.0) {
            (true, true) => section.length / start.abs(),
            (true, false) => (vertical / start).ln() / w * start.signum(),
            _ => f64::INFINITY,
        };
        let striping = match (start * vertical > 0.0, w == 0.0) {
            (true, _) => 0.0,
            (_, true) => f64::INFINITY,
            _ => 2.0 / w.abs(),
        };
        compliance += Vector2::new(swing + stretch, striping + stretch);
    }
    Matrix2::from_diagonal(&compliance.map(|c| 1.0 / c))
}

#[cfg(test)]
mod tests {
    use super::super::{section, solve as solve_line};
    use super::{Catenary, Section, in_flight};
    use nalgebra::Matrix2;

    fn solve(sections: &[Section], span: f64, rise: f64) -> Catenary {
        solve_line(sections, span, rise, None).unwrap()
    }

    #[test]
    fn the_stiffness_is_the_slope_of_the_closed_form() {
        let chain = section(12.0, 30.0, 1e6);
        let lines: [&[Section]; 5] = [
            std::slice::from_ref(&chain),
            &[section(12.0, 0.1, 1e4)],
            &[section(12.0, -30.0, 1e6)],
            &[chain, section(5.0, -3.0, 1e5), section(4.0, 100.0, 1e7)],
            &[section(12.0, 0.0, 1e4)],
        ];
        for sections in lines {
            let length: f64 = sections.iter().map(|s| s.length).sum();
            for (x, z) in [
                (0.1, 0.0),
                (0.5, 0.4),
                (0.7, -0.6),
                (0.95, 0.0),
                (0.1, 0.99),
                (0.8, 0.61),
                (1.0, 0.02),
            ] {
                let (x, z, step) = (x * length, z * length, 1e-6 * length);
                let exact = in_flight(sections, &solve(sections, x, z));
                let slope = |dx: f64, dz: f64| {
                    let [up, down] = [1.0, -1.0].map(|s| solve(sections, x + s * dx, z + s * dz));
                    [
                        up.horizontal() - down.horizontal(),
                        up.vertical_b() - down.vertical_b(),
                    ]
                    .map(|d| d / (2.0 * step))
                };
                let (by_x, by_z) = (slope(step, 0.0), slope(0.0, step));
                let measured = Matrix2::new(by_x[0], by_z[0], by_x[1], by_z[1]);
                let error = (exact - measured).norm();
                assert!(
                    error < 1e-5 * measured.norm() + 1e-9,
                    "{sections:?} {x} {z}: {exact} {measured}"
                );
            }
        }
    }

    #[test]
    fn the_stiffness_of_a_vertical_line_is_the_limit_of_a_narrow_one() {
        let line = [section(10.0, 3.0, 500.0)];
        for rise in [-12.0, -4.0, 0.0, 9.0, 14.0] {
            let vertical = in_flight(&line, &solve(&line, 0.0, rise));
            let narrow = in_flight(&line, &solve(&line, 1e-100, rise));
            assert!(
                (vertical - narrow).norm() < 0.01 * vertical.norm(),
                "{rise}: {vertical} {narrow}"
            );
        }
    }

    #[test]
    fn a_taut_line_of_extreme_stiffness_keeps_both_stiffnesses() {
        let line = [section(10.0, 1e-8, 1e13)];
        let stiffness = in_flight(&line, &solve(&line, 6.0 * (1.0 + 1e-12), 8.0 * (1.0 + 1e-12)));
        let [along, across] = stiffness.symmetric_eigenvalues().into();
        let (along, across) = if along > across {
            (along, across)
        } else {
            (across, along)
        };
        assert!((along / 1e12 - 1.0).abs() < 1e-5, "{along}");
        assert!((across - 1.0).abs() < 0.1, "{across}");
    }
}
