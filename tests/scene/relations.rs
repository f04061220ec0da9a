//! Mistakes that lie in how parts go together.

use crate::{SCENE, said};

/// What is said after several changes.
fn said_after(changes: &[(&str, &str)]) -> String {
    let mut text = SCENE.to_string();
    for (old, new) in changes {
        assert!(text.contains(old), "{old} is not in the scene");
        text = text.replacen(old, new, 1);
    }
    said(&text)
}

#[test]
fn a_weight_needs_gravity_to_tell_the_mass() {
    let said = said_after(&[("gravity = 9.81", "gravity = 0"), ("mass = 100.0", "weight = 5")]);
    assert_eq!(
        said,
        "11:10: line_types.chain.weight: the mass would be weight/gravity, but gravity is 0: give `mass` [kg/m] too"
    );
}

#[test]
fn drag_without_a_diameter_is_refused() {
    let said = said_after(&[("mass = 100.0", "weight = 5.0"), ("diameter = 0.1\n", "")]);
    assert!(said.contains("no diameter: the seabed's stiffness"), "{said}");
    let said = said_after(&[
        ("mass = 100.0", "weight = 5.0"),
        ("diameter = 0.1\n", ""),
        ("[seabed]\ndepth = 50.0\n", ""),
    ]);
    assert_eq!(
        said,
        "11:15: line_types.chain.drag_normal: the water acts on the diameter: give `diameter` [m] too"
    );
}

#[test]
fn lines_that_nothing_holds_are_refused() {
    let said = said_after(&[
        ("kind = \"fixed\"", "kind = \"free\""),
        ("kind = \"coupled\"", "kind = \"free\""),
        ("[motion]\nfairlead = { x = [[1.0, 10.0]] }\n", ""),
    ]);
    assert!(
        said.starts_with("31:1: lines[0]: nothing holds this line"),
        "{said}"
    );
}

#[test]
fn a_free_point_without_a_line_is_refused() {
    let extra = "[[points]]\nname = \"loose\"\nposition = [0, 0, 0]\nkind = \"free\"\n\n[[lines]]";
    let said = said_after(&[("[[lines]]", extra)]);
    assert_eq!(
        said,
        "31:1: points[3]: no line ends at this free point, so nothing holds it"
    );
}

#[test]
fn a_straight_start_needs_ends_apart() {
    let said = said_after(&[
        ("[20.0, 0.0, -20.0]", "[0.0, 0.0, 0.0]"),
        ("elements = 10 }]", "elements = 10 }]\ninitial = \"straight\""),
    ]);
    assert!(
        said.starts_with("42:11: lines[1].initial: the two ends have the same position"),
        "{said}"
    );
}

#[test]
fn a_scene_without_lines_is_refused() {
    assert_eq!(
        said(""),
        "1:1: lines: no line: a scene needs at least one `[[lines]]`"
    );
}
