//! Closed forms, published figures and invariants.

use super::random::{CLASSES, Dice};
use super::{Line, seabed};
use crate::common::bisect;
use moorline::statics::catenary::{FlatSeabed, Section, is_laid_from_b, solve};

fn assert_near(value: f64, wanted: f64, tolerance: f64) {
    assert!(
        (value - wanted).abs() <= tolerance,
        "{value} is not {wanted} within {tolerance:e}"
    );
}

#[test]
fn seafem_case_11_has_the_exact_sag_and_reactions() {
    let line = Line::uniform([14.1421, 0.49, 2505.0], [14.1421, 0.0], None).solve();
    assert_near(line.horizontal(), 17.00889855, 5e-9);
    assert_near(line.vertical_b(), 3.4648145, 1e-12);
    assert_near(line.vertical_a(), -3.4648145, 1e-12);
    assert_near(line.sag(), 0.717_777_465_4, 5e-11);
}

fn oc3(friction: f64) -> Line {
    // MAP++ prints 698.094 N/m but computes with all digits: 77.7066 kg/m, 0.09 m, in 1025 kg/m³
    let weight = 9.80665 * (77.7066 - 1025.0 * std::f64::consts::PI * 0.09 * 0.09 / 4.0);
    Line::uniform([902.2, weight, 384.243e6], [848.67, 250.0], seabed(0.0, friction))
}

#[test]
fn the_oc3_line_has_the_tension_map_prints_with_its_friction_and_less_without() {
    let line = oc3(0.001).solve();
    assert_near(line.tension_b(), 911_089.46, 5e-3);
    assert_near(line.horizontal(), 736_939.29, 5e-3);
    assert_near(line.vertical_b(), 535_727.99, 5e-3);
    let frictionless = Line::uniform([902.2, 698.094, 384.243e6], [848.67, 250.0], oc3(0.0).seabed).solve();
    assert_near(frictionless.tension_b(), 911_088.356_868_612_6, 1e-6);
    assert_eq!(frictionless.horizontal_a(), frictionless.horizontal());
}

#[test]
fn friction_takes_its_share_of_the_laid_weight_and_no_more_than_all() {
    let line = oc3(0.5).solve();
    let share = 0.5 * oc3(0.5).weights() / 902.2 * line.laid_length();
    assert_near(line.horizontal() - line.horizontal_a(), share, 1e-6);
    assert_eq!(line.friction(), 0.5);
    let long = Line {
        span: 800.0,
        ..oc3(0.9)
    }
    .solve();
    assert_eq!(long.tension_a(), 0.0);
    assert!(long.horizontal() > 0.0);
}

#[test]
fn swapping_the_ends_mirrors_the_line() {
    let mut dice = Dice(11);
    for (name, make) in CLASSES.iter().flat_map(|class| [class; 200]) {
        let mut line = make(&mut dice);
        // a line that lies on the seabed with both ends, or with none, has the friction of a line laid from end A
        let (rise, length) = (line.rise, line.length());
        let slides = |seabed: FlatSeabed| {
            let [a, b] = [-seabed.height, rise - seabed.height];
            is_laid_from_b([a, b], length) || is_laid_from_b([b, a], length)
        };
        line.seabed = line
            .seabed
            .and_then(|old| seabed(old.height, if slides(old) { old.friction } else { 0.0 }));
        let swapped_seabed = line
            .seabed
            .and_then(|old| seabed(old.height - rise, old.friction));
        let sections = line.sections.iter().rev().copied().collect();
        let swapped = Line::of(sections, line.span, -rise, swapped_seabed);
        let (there, back) = (line.solve(), swapped.solve());
        let tolerance = line.rounding(&there);
        assert!(
            (there.horizontal() - back.horizontal_a()).abs() <= tolerance,
            "{name}: {line:?}"
        );
        assert!(
            (there.vertical_a() + back.vertical_b()).abs() <= tolerance,
            "{name}: {line:?}"
        );
    }
}

#[test]
fn cutting_a_line_into_like_sections_changes_nothing() {
    let mut dice = Dice(12);
    for (name, make) in CLASSES.iter().flat_map(|class| [class; 50]) {
        let line = make(&mut dice);
        let half = |s: &Section| Section {
            length: 0.5 * s.length,
            ..*s
        };
        let halves = line
            .sections
            .iter()
            .flat_map(|section| [half(section); 2])
            .collect();
        let cut = Line {
            sections: halves,
            ..line.clone()
        };
        let (whole, cut) = (line.solve(), cut.solve());
        let apart = (whole.tension_b() - cut.tension_b()).abs();
        assert!(apart <= line.rounding(&whole), "{name}: {line:?}");
        let apart = (whole.laid_length() - cut.laid_length()).abs();
        assert!(apart <= 1e-8 * line.length(), "{name}: {line:?}");
    }
}

#[test]
fn a_taut_line_tends_to_its_stiffness_times_its_strain() {
    let errors = [1.0, 0.1, 0.01, 0.001].map(|weight| {
        let line = Line::uniform([100.0, weight, 1e5], [61.2, 81.6], None).solve();
        0.5 * (line.tension_a() + line.tension_b()) - 1e5 * 0.02
    });
    // the effect of sag is quadratic in weight over tension
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log10();
        assert!((order - 2.0).abs() < 0.1, "order {order} of {errors:?}");
    }
}

#[test]
fn a_slack_line_hangs_vertically_and_pulls_with_the_weight_of_its_hanging_part() {
    let line = Line::uniform([100.0, 20.0, 1e9], [30.0, 40.0], seabed(0.0, 0.3)).solve();
    assert_eq!((line.horizontal(), line.tension_a()), (0.0, 0.0));
    // T + T²/2EAw·w = w·40, including the stretch of the hanging part
    assert_near(line.vertical_b() + line.vertical_b().powi(2) / 2e9, 800.0, 1e-9);
    assert_near(line.at(100.0).x, 30.0, 1e-12);
}

#[test]
fn a_weightless_line_longer_than_its_chord_pulls_nothing() {
    for length in [50.0, 60.0, 1e4] {
        let line = Line::uniform([length, 0.0, 1e6], [30.0, -40.0], None).solve();
        assert_eq!((line.tension_a(), line.tension_b()), (0.0, 0.0));
        assert_near(line.at(length).z, -40.0, 1e-11);
    }
    let taut = Line::uniform([40.0, 0.0, 1e6], [30.0, -40.0], None).solve();
    assert_near(taut.tension_b(), 1e6 * 0.25, 1e-8);
}

#[test]
fn a_buoyant_line_is_a_heavy_one_upside_down_and_leaves_the_seabed_alone() {
    let heavy = Line::uniform([120.0, 7.0, 1e6], [90.0, 20.0], None).solve();
    let buoyant = Line::uniform([120.0, -7.0, 1e6], [90.0, -20.0], seabed(-20.0, 0.7)).solve();
    assert_eq!(buoyant.horizontal(), heavy.horizontal());
    assert_eq!(buoyant.vertical_b(), -heavy.vertical_b());
    assert_eq!((buoyant.laid_length(), buoyant.sag()), (0.0, 0.0));
}

#[test]
fn a_line_just_off_the_seabed_and_one_just_on_it_pull_alike() {
    // span at which V at A is zero
    let lift_off = bisect([850.0, 868.0], |span| {
        Line {
            span,
            seabed: None,
            ..oc3(0.0)
        }
        .solve()
        .vertical_a()
    });
    for friction in [0.0, 1.0] {
        let at = |step: f64| {
            Line {
                span: lift_off + step,
                ..oc3(friction)
            }
            .solve()
        };
        let [before, after] = [-1e-9, 1e-9].map(at);
        assert!(before.laid_length() < 1e-3 && after.laid_length() == 0.0);
        assert_near(before.tension_b() / after.tension_b(), 1.0, 1e-8);
    }
}

#[test]
fn sections_and_ends_that_make_no_line_are_refused_with_the_place_and_the_reason() {
    let good = Section {
        length: 10.0,
        weight: 1.0,
        axial_stiffness: 1e5,
    };
    let short = Section { length: 0.0, ..good };
    let soft = Section {
        axial_stiffness: -5.0,
        ..good
    };
    let odd = Section {
        weight: f64::NAN,
        ..good
    };
    for (sections, [span, rise], seabed, message) in [
        (
            &[][..],
            [1.0, 0.0],
            None,
            "sections: a line needs at least one section, there is none",
        ),
        (
            &[good, short],
            [1.0, 0.0],
            None,
            "sections[1].length: 0 m is not positive and finite",
        ),
        (
            &[soft],
            [1.0, 0.0],
            None,
            "sections[0].axial_stiffness: -5 N is not positive and finite",
        ),
        (
            &[odd],
            [1.0, 0.0],
            None,
            "sections[0].weight: NaN N/m is not finite",
        ),
        (
            &[good],
            [-1.0, 0.0],
            None,
            "span: -1 m is not at least 0 and finite",
        ),
        (&[good], [1.0, f64::INFINITY], None, "rise: inf m is not finite"),
        (
            &[good],
            [1.0, 0.0],
            seabed(0.0, -0.1),
            "seabed.friction: -0.1 [-] is not at least 0 and finite",
        ),
        (
            &[good],
            [1.0, -3.0],
            seabed(-2.0, 0.0),
            "seabed.height: the seabed at z = -2 m is above end B at z = -3 m; it must be at or below both ends",
        ),
    ] {
        assert_eq!(
            solve(sections, span, rise, seabed)
                .expect_err("it is no line")
                .to_string(),
            message
        );
    }
}
