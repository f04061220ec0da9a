use super::*;
use crate::math::rotation::turned_to;
use crate::model::BeamElement;
use crate::physics::section::{SectionLaw, Sextuple, corrected, join, straight, strain};
use approx::assert_relative_eq;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{FRAC_PI_4, TAU};

/// Axial and shear stiffness so high compared with bending that the elastica's closed form holds.
const STIFF: f64 = 1e8;

fn clamped() -> BeamEnd {
    BeamEnd {
        held: [true; 6],
        ..BeamEnd::default()
    }
}

/// Weightless beam on given sections, free of stress there.
struct Bench {
    elements: Vec<BeamElement>,
    sections: Vec<Section>,
    rest: Vec<Sextuple>,
}

impl Bench {
    fn case(&self, ends: [BeamEnd; 2]) -> BeamCase<'static> {
        BeamCase {
            elements: self.elements.clone(),
            rest: self.rest.clone(),
            weight: vec![0.0; self.sections.len()],
            seabed: Vec::new(),
            ends,
            bodies: [None; 2],
        }
    }
}

fn law(axial: f64, bending: f64) -> SectionLaw {
    SectionLaw {
        shear: axial,
        axial,
        bending,
        torsion: bending,
    }
}

fn none() -> SectionLaw {
    law(0.0, 0.0)
}

fn bench(sections: Vec<Section>, length: f64, law: SectionLaw, rests: bool) -> Bench {
    let n = sections.len() - 1;
    let element = BeamElement {
        length: length / n as f64,
        law,
        damping: none(),
    };
    Bench {
        rest: (0..n)
            .map(|i| {
                if rests {
                    corrected(
                        &strain(&sections[i], &sections[i + 1], element.length),
                        element.length,
                    )
                } else {
                    straight()
                }
            })
            .collect(),
        sections,
        elements: vec![element; n],
    }
}

/// Straight beam along x from the origin.
fn straight_bench(n: usize, length: f64, law: SectionLaw) -> Bench {
    let frame = turned_to(&Matrix3::identity(), Vector3::x());
    let at = |i: usize| Section {
        position: Vector3::x() * length * i as f64 / n as f64,
        frame,
    };
    bench((0..=n).map(at).collect(), length, law, true)
}

/// Sections of a beam clamped at A and loaded at B.
fn loaded(bench: &Bench, force: Vector3<f64>, moment: Vector3<f64>) -> Vec<Section> {
    let tip = BeamEnd {
        load: join(force, moment),
        ..BeamEnd::default()
    };
    let case = bench.case([clamped(), tip]);
    let mut sections = bench.sections.clone();
    BeamStatics::default().solve(&case, &mut sections).unwrap();
    sections
}

/// Order of convergence: slope of ln(error) over −ln n, by least squares.
fn order(points: &[(usize, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(n, e)| (-(*n as f64).ln(), e.ln())).collect();
    let count = logs.len() as f64;
    let (mx, my) = (
        logs.iter().map(|p| p.0).sum::<f64>() / count,
        logs.iter().map(|p| p.1).sum::<f64>() / count,
    );
    logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>()
        / logs.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>()
}

fn assert_order(expected: f64, meshes: &[usize], error: impl Fn(usize) -> f64) {
    let points: Vec<(usize, f64)> = meshes.iter().map(|&n| (n, error(n))).collect();
    let slope = order(&points);
    assert!((slope - expected).abs() < 0.1, "order {slope:.3}: {points:?}");
}

#[test]
fn a_cantilever_under_a_dead_load_tends_to_the_elastica_at_second_order() {
    // Bisshopp & Drucker (1945): PL²/EI, deflection/L, shortening/L
    for (alpha, deflection, shortening) in [
        (1.0, 0.301_720_773_799_813_5, 0.056_433_236_283_376_88),
        (5.0, 0.713_791_523_611_912_7, 0.387_628_360_724_429_9),
        (10.0, 0.810_609_024_880_296_4, 0.554_995_597_753_751_3),
    ] {
        assert_order(2.0, &[10, 20, 40, 80], |n| {
            let bench = straight_bench(n, 1.0, law(STIFF, 1.0));
            let tip = loaded(&bench, alpha * Vector3::y(), Vector3::zeros())[n].position;
            (tip - Vector3::new(1.0 - shortening, deflection, 0.0)).norm()
        });
    }
}

#[test]
fn an_end_moment_rolls_a_cantilever_up_to_a_circle_at_the_sixth_order_of_its_curvature() {
    // The strains of elements are corrected for an arc: no other error remains here.
    let length = 10.0;
    let ei = 100.0;
    assert_order(6.0, &[16, 32, 64, 128], |n| {
        let bench = straight_bench(n, length, law(STIFF, ei));
        let moment = TAU * ei / length * Vector3::z();
        loaded(&bench, Vector3::zeros(), moment)[n].position.norm() / length
    });
}

#[test]
fn a_uniform_moment_makes_the_same_curvature_in_every_element_and_tends_to_it_over_ei() {
    assert_order(6.0, &[12, 24, 48, 96], |n| {
        let bench = straight_bench(n, 3.0, law(1e4, 5.0));
        let sections = loaded(&bench, Vector3::zeros(), 4.0 * Vector3::z());
        let curvature: Vec<f64> = sections
            .windows(2)
            .zip(&bench.rest)
            .map(|(pair, rest)| bench.elements[0].strain(&pair[0], &pair[1], rest))
            .map(|strain| split(&strain).1.norm())
            .collect();
        for other in &curvature {
            assert_relative_eq!(*other, curvature[0], max_relative = 1e-9);
        }
        (curvature[0] - 4.0 / 5.0).abs()
    });
}

#[test]
fn the_bend_of_45_degrees_tends_to_its_published_tip_at_second_order() {
    // Bathe & Bolourchi (1979), Int. J. Numer. Methods Eng. 14, 961-986, of a beam with R = 100, E = 1e7, G = 5e6, A = 1
    let reference = Vector3::new(15.684_800_5, 47.150_438_6, 53.474_858_8);
    let square = SectionLaw {
        shear: 5e6,
        axial: 1e7,
        bending: 1e7 / 12.0,
        torsion: 5e6 / 6.0,
    };
    assert_order(2.0, &[8, 16, 32, 64], |n| {
        let at = |i: usize| {
            let angle = FRAC_PI_4 * i as f64 / n as f64;
            let (sin, cos) = angle.sin_cos();
            Section {
                position: 100.0 * Vector3::new(1.0 - cos, sin, 0.0),
                frame: turned_to(&Matrix3::identity(), Vector3::new(sin, cos, 0.0)),
            }
        };
        let bench = bench((0..=n).map(at).collect(), 100.0 * FRAC_PI_4, square, true);
        let tip = loaded(&bench, 600.0 * Vector3::z(), Vector3::zeros())[n].position;
        (tip - reference).norm()
    });
}

#[test]
fn a_torque_along_the_axis_twists_by_gj_alone() {
    let bench = straight_bench(8, 2.0, law(1e4, 3.0));
    let sections = loaded(&bench, Vector3::zeros(), 0.3 * Vector3::x());
    assert_relative_eq!(sections[8].position, 2.0 * Vector3::x(), epsilon = 1e-9);
    let turn = sections[0].frame.tr_mul(&sections[8].frame);
    let angle = f64::atan2(turn[(1, 0)], turn[(0, 0)]);
    assert_relative_eq!(angle, 0.3 / 3.0 * 2.0, max_relative = 1e-3);
}

#[test]
fn a_beam_bent_far_from_rest_springs_back() {
    let bench = straight_bench(20, 10.0, law(1e4, 100.0));
    let n = 20;
    let angle = |i: usize| 4.0 * i as f64 / n as f64;
    let mut sections: Vec<Section> = (0..=n)
        .map(|i| {
            let (sin, cos) = angle(i).sin_cos();
            Section {
                position: 2.5 * Vector3::new(sin, 1.0 - cos, 0.0),
                frame: turned_to(&Matrix3::identity(), Vector3::new(cos, sin, 0.0)),
            }
        })
        .collect();
    let case = bench.case([clamped(), BeamEnd::default()]);
    BeamStatics::default().solve(&case, &mut sections).unwrap();
    assert_relative_eq!(sections[n].position, 10.0 * Vector3::x(), epsilon = 1e-7);
}

#[test]
fn a_beam_that_nothing_holds_is_refused_and_left_where_it_was() {
    let bench = straight_bench(6, 1.0, law(1e4, 1.0));
    let tip = BeamEnd {
        load: join(Vector3::y(), Vector3::zeros()),
        ..BeamEnd::default()
    };
    let case = bench.case([BeamEnd::default(), tip]);
    let mut sections = bench.sections.clone();
    assert!(BeamStatics::default().solve(&case, &mut sections).is_err());
    assert_eq!(sections, bench.sections);
}

#[test]
fn an_equilibrium_that_folds_its_elements_is_refused() {
    let bench = straight_bench(2, 1.0, law(1e4, 1.0));
    let mut sections = bench.sections.clone();
    let (sin, cos) = 2.6_f64.sin_cos(); // two elements of 75° each
    sections[1].frame = turned_to(&sections[0].frame, Vector3::new(0.27, 0.96, 0.0).normalize());
    sections[2].frame = turned_to(&sections[1].frame, Vector3::new(cos, sin, 0.0));
    sections[1].position = Vector3::new(0.4, 0.2, 0.0);
    sections[2].position = Vector3::new(0.2, 0.6, 0.0);
    let start = sections.clone();
    let case = bench.case([clamped(), clamped()]);
    let refused = BeamStatics::default().solve(&case, &mut sections);
    assert!(
        matches!(refused, Err(StaticsError::BeamFolded { .. })),
        "{refused:?}"
    );
    assert_eq!(sections, start);
}
