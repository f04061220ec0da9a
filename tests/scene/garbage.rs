//! Arbitrary text.

use moorline::scene::{InitialShape, MotionPath, Scene, TimeFunction};
use proptest::prelude::*;

use crate::{SCENE, said};

/// Fails if reading the text panics, or refuses it without a place in the text.
fn assert_read_or_refused_with_a_place(text: &str) {
    if let Err(mistake) = Scene::from_toml(text) {
        let span = mistake.span.as_ref();
        let span = span.unwrap_or_else(|| panic!("no place: {mistake}\n{text}"));
        assert!(
            text.get(span.clone()).is_some(),
            "{span:?} is not in the text: {mistake}"
        );
        assert!(!mistake.problem.is_empty());
    }
}

/// Returns a text with many of the keys of the format.
fn rich_text() -> String {
    SCENE
        .replace(
            "kind = \"free\"",
            "kind = \"free\"\nfree = [\"x\", \"z\"]\nmass = 3.0\nforce = { x = { step = [0, 0, 5, 20] }, z = 3.0 }",
        )
        .replace(
            "mass = 100.0",
            "mass = 100.0\nstrain = { logarithmic = 0.3 }\nrayleigh = { ratios = [0.1, 0.1], frequencies = [1.0, 9.0] }",
        )
        .replace("elements = 10 }]", "elements = 10 }]\ninitial = { parabola = 2.0 }")
        .replace("[output]", "[solver]\nintegrator = \"bossak\"\nbossak = { alpha = -0.1 }\n\n[output]")
}

#[test]
fn a_text_cut_off_anywhere_is_read_or_refused_with_a_place() {
    let text = rich_text();
    assert_eq!(said(&text), "fine");
    for end in 0..text.len() {
        assert_read_or_refused_with_a_place(&text[..end]);
    }
}

#[test]
fn a_text_without_any_one_line_is_read_or_refused_with_a_place() {
    let text = rich_text();
    let lines: Vec<&str> = text.lines().collect();
    for gone in 0..lines.len() {
        let left = [&lines[..gone], &lines[gone + 1..]].concat();
        assert_read_or_refused_with_a_place(&left.join("\n"));
    }
}

#[test]
fn a_text_with_any_one_value_replaced_is_read_or_refused_with_a_place() {
    let text = rich_text();
    let starts = text.char_indices().filter(|(at, c)| {
        c.is_ascii_digit() && !text[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '.')
    });
    for (start, _) in starts {
        let rest = &text[start..];
        let length = rest
            .find(|c: char| !(c.is_ascii_digit() || c == '.' || c == 'e'))
            .unwrap();
        for value in [
            "nan",
            "-inf",
            "1e300",
            "1e999",
            "-1",
            "0",
            "\"x\"",
            "[]",
            "{}",
            "true",
            "",
            "1979-05-27",
        ] {
            let changed = format!("{}{value}{}", &text[..start], &rest[length..]);
            assert_read_or_refused_with_a_place(&changed);
        }
    }
}

#[test]
fn brackets_nested_without_end_are_refused() {
    for opening in ["[", "{a=", "[{a="] {
        assert_read_or_refused_with_a_place(&format!("title = {}", opening.repeat(50_000)));
        assert_read_or_refused_with_a_place(&opening.repeat(50_000));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn junk_is_refused_with_a_place(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        assert_read_or_refused_with_a_place(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn a_text_with_junk_anywhere_is_read_or_refused_with_a_place(
        at in any::<prop::sample::Index>(), length in 0_usize..20, junk in ".{0,8}",
    ) {
        let text = rich_text();
        let start = at.index(text.len());
        let end = (start + length).min(text.len());
        assert_read_or_refused_with_a_place(&format!("{}{junk}{}", &text[..start], &text[end..]));
    }

    #[test]
    fn numbers_survive_being_written_bit_for_bit(
        x in -1e7..1e7_f64, tiny in prop::num::f64::SUBNORMAL | prop::num::f64::ZERO, sag in 1e-300..1e6_f64,
        t in 0.0..1e9_f64, f in -1e15..1e15_f64,
    ) {
        let mut scene = Scene::from_toml(SCENE).unwrap();
        scene.points[0].position = [x, tiny, -0.0];
        scene.lines[1].initial = InitialShape::Parabola(sag);
        scene.points[1].force = Some(moorline::scene::PointForce {
            x: Some(TimeFunction::Constant(f)),
            y: Some(TimeFunction::Ramp([-1.0, f, t, -f])),
            z: Some(TimeFunction::Table(vec![[-t - 1.0, f], [t, x]])),
        });
        scene.motion.insert("fairlead".into(), MotionPath::Table(vec![[t, x, tiny, -0.0, 0.0, 0.0, 0.0]]));
        let read = Scene::from_toml(&scene.to_toml()).unwrap();
        let bits = |scene: &Scene| scene.points[0].position.map(f64::to_bits);
        prop_assert_eq!(bits(&read), bits(&scene));
        prop_assert_eq!(&read, &scene);
    }
}
