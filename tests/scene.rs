//! Scenes as a user writes them: every refusal once with its place, files that are no scenes, text that is anything.

use std::fs;
use std::path::Path;

use moorline::scene::{InitialShape, LoadError, MotionPath, Scene, TimeFunction, load};
use proptest::prelude::*;

/// A scene without a mistake that has a little of everything.
const SCENE: &str = r#"title = "a scene"
gravity = 9.81

[water]
density = 1025.0

[seabed]
depth = 50.0

[line_types.chain]
mass = 100.0
diameter = 0.1
axial_stiffness = 1.0e8
drag_normal = 1.2

[[points]]
name = "anchor"
position = [100.0, 0.0, -50.0]
kind = "fixed"

[[points]]
name = "buoy"
position = [20.0, 0.0, -20.0]
kind = "free"

[[points]]
name = "fairlead"
position = [0.0, 0.0, 0.0]
kind = "coupled"

[[lines]]
name = "line1"
from = "anchor"
to = "buoy"
sections = [{ type = "chain", length = 80.0 }]

[[lines]]
name = "line2"
from = "buoy"
to = "fairlead"
sections = [{ type = "chain", length = 150.0, elements = 10 }]

[motion]
fairlead = { x = [[1.0, 10.0]] }

[output]
duration = 60.0
interval = 0.1
"#;

/// What is written instead, and the beginning of what is said about it: line, column, key, problem.
type Refusal = (&'static str, &'static str, &'static str);

/// What reading a text says: line, column, key and problem of the first mistake, or `fine`.
fn said(text: &str) -> String {
    match Scene::from_toml(text) {
        Ok(_) => "fine".to_string(),
        Err(mistake) => {
            let (line, column) = mistake.line_column(text);
            format!("{line}:{column}: {mistake}")
        }
    }
}

fn assert_refused(refusals: &[Refusal]) {
    for (right, wrong, message) in refusals {
        assert!(SCENE.contains(right), "{right} is not in the scene");
        let said = said(&SCENE.replacen(right, wrong, 1));
        assert!(
            said.starts_with(message),
            "{wrong}\n  said:   {said}\n  wanted: {message}"
        );
    }
}

#[test]
fn the_scene_that_the_mistakes_are_made_in_is_right() {
    assert_eq!(said(SCENE), "fine");
}

#[test]
fn a_slip_in_syntax_a_key_or_a_type_is_refused_with_what_is_accepted() {
    assert_refused(SLIPS);
}

const SLIPS: &[Refusal] = &[
    (
        "gravity = 9.81",
        "gravity = 9.81 m",
        "2:11: not TOML: string values must be quoted, expected literal string",
    ),
    (
        "gravity = 9.81",
        "gravity =",
        "2:10: not TOML: string values must be quoted, expected literal string",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nmass = 2.0",
        "12:1: not TOML: duplicate key",
    ),
    (
        "[water]",
        "water]",
        "4:6: not TOML: key with no value, expected `=`",
    ),
    (
        "gravity = 9.81",
        "gravit = 9.81",
        "2:1: gravit: unknown key `gravit`, did you mean `gravity`?",
    ),
    (
        "diameter = 0.1",
        "diamter = 0.1",
        "12:1: line_types.chain.diamter: unknown key `diamter`, did you mean `diameter`?",
    ),
    (
        "axial_stiffness = 1.0e8",
        "EA = 1.0e8",
        "13:1: line_types.chain.EA: unknown key `EA`, did you mean `axial_stiffness`?",
    ),
    (
        "length = 150.0",
        "lenght = 150.0",
        "41:31: lines[1].sections[0].lenght: unknown key `lenght`, did you mean `length`? (known keys: type, length, elements)",
    ),
    (
        "[seabed]",
        "[bodies]\n[seabed]",
        "7:2: bodies: unknown key `bodies`",
    ),
    (
        "mass = 100.0",
        r#"mass = "100""#,
        r#"11:8: line_types.chain.mass: expected a number [kg/m], found the string "100""#,
    ),
    (
        "mass = 100.0",
        "mass = nan",
        "11:8: line_types.chain.mass: nan is not a finite number",
    ),
    (
        "mass = 100.0",
        "mass = 1e999",
        "11:8: line_types.chain.mass: 1e999 is not a finite number",
    ),
    (
        "mass = 100.0",
        "mass = true",
        "11:8: line_types.chain.mass: expected a number [kg/m], found true",
    ),
    (
        "mass = 100.0",
        "mass = 1979-05-27",
        "11:8: line_types.chain.mass: expected a number [kg/m], found a date",
    ),
    (
        "mass = 100.0",
        "mass = [100.0]",
        "11:8: line_types.chain.mass: expected a number [kg/m], found an array",
    ),
    (
        "axial_stiffness = 1.0e8\n",
        "",
        "10:1: line_types.chain: missing key `axial_stiffness` [N]",
    ),
    (
        "name = \"anchor\"\n",
        "",
        "16:1: points[0]: missing key `name`",
    ),
    (
        "position = [100.0, 0.0, -50.0]",
        "position = [100.0, 0.0]",
        "18:12: points[0].position: expected an array of 3 numbers [m], found an array of 2",
    ),
    (
        "position = [100.0, 0.0, -50.0]",
        r#"position = [100.0, 0.0, "deep"]"#,
        r#"18:25: points[0].position[2]: expected a number [m], found the string "deep""#,
    ),
    (
        "position = [100.0, 0.0, -50.0]",
        "position = 100.0",
        "18:12: points[0].position: expected an array of 3 numbers [m], found 100.0",
    ),
    (
        r#"kind = "fixed""#,
        r#"kind = "fixd""#,
        "19:8: points[0].kind: unknown value `fixd`, did you mean `fixed`? (known values: fixed, coupled, prescribed, free)",
    ),
    (
        r#"kind = "fixed""#,
        "kind = 1",
        "19:8: points[0].kind: expected one of `fixed`, `coupled`, `prescribed`, `free`, found 1",
    ),
    (
        "[seabed]",
        "[seabed]\ncontact = \"soft\"",
        "8:11: seabed.contact: unknown value `soft` (known values: regularised, as_given)",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nstrain = \"gren\"",
        "12:10: line_types.chain.strain: unknown value `gren`, did you mean `green`? (known values: engineering, green, logarithmic)",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nstrain = \"logarithmic\"",
        "12:10: line_types.chain.strain: `logarithmic` needs a value: write { logarithmic = … }",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nstrain = { green = 0.5 }",
        r#"12:12: line_types.chain.strain: `green` takes no value: write "green""#,
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nstrain = { logarithmic = \"0.5\" }",
        r#"12:26: line_types.chain.strain.logarithmic: expected a number [-], found the string "0.5""#,
    ),
    (
        "elements = 10",
        "elements = 1.5",
        "41:58: lines[1].sections[0].elements: expected a whole number, not negative, found 1.5",
    ),
    (
        "elements = 10",
        "elements = -3",
        "41:58: lines[1].sections[0].elements: expected a whole number, not negative, found -3",
    ),
    (
        "elements = 10",
        "elements = 10 }]\ninitial = [{ parabola = 2.0",
        "42:11: lines[1].initial: expected one of `static`, `straight`, `parabola`, `nodes`, found an array",
    ),
    (
        "elements = 10",
        "elements = 10 }]\ninitial = { parabola = \"2.0\" }\n#",
        r#"42:24: lines[1].initial.parabola: expected a number [m], found the string "2.0""#,
    ),
    (
        "[water]\ndensity = 1025.0",
        "[water]",
        "4:1: water: missing key `density` [kg/m³]",
    ),
    (
        "[water]\ndensity = 1025.0\n",
        "water = 1025.0\n",
        "4:9: water: expected a table, found 1025.0",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = \"20\" }",
        r#"25:15: points[1].force.x: expected a number [N], { step = [t0, f0, t1, f1] }, { ramp = [t0, f0, t1, f1] } or { table = [[t, f], …] }, found the string "20""#,
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = { stp = [0.0, 0.0, 5.0, 20.0] } }",
        "25:15: points[1].force.x: unknown key `stp`, did you mean `step`? (known keys: constant, step, ramp, table)",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = { step = [0.0, 0.0, 5.0] } }",
        "25:24: points[1].force.x.step: expected an array of 4 numbers, found an array of 3",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = {} }",
        "25:15: points[1].force.x: expected a number [N], { step = [t0, f0, t1, f1] }, { ramp = [t0, f0, t1, f1] } or { table = [[t, f], …] }, found an empty table",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = { step = [0, 0, 5, 20], ramp = [0, 0, 5, 20] } }",
        "25:15: points[1].force.x: `step` and `ramp` cannot both be given: a load has one function of time",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { w = 3.0 }",
        "25:11: points[1].force.w: unknown key `w` (known keys: x, y, z)",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = 3.0",
        r#"44:12: motion.fairlead: expected { x = [[amplitude, period], …], z = …, ramp = … }, { table = [[t, x, y, z], …] } or { file = "motion.csv" }, found 3.0"#,
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = {}",
        "44:12: motion.fairlead: a motion needs `x`, `y` or `z`, or `table`, or `file`",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        r#"fairlead = { file = "a.csv", table = [[0.0, 0.0, 0.0, 0.0]] }"#,
        "44:12: motion.fairlead: `file` and `table` cannot both be given",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        r#"fairlead = { file = "a.csv", ramp = 2.0 }"#,
        "44:12: motion.fairlead: `x`, `y`, `z`, `roll`, `pitch`, `yaw` and `ramp` cannot be given beside `file` or `table`",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { table = [[0.0, 1.0, 2.0]] }",
        "44:23: motion.fairlead.table[0]: expected an array of 4 numbers (t, x, y, z), or of 7 (with roll, pitch, yaw of a vessel), found an array of 3",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        r#"fairlead = { file = "a.csv" }"#,
        "44:21: motion.fairlead.file: a scene that comes as text cannot read files: write the rows as `table = [[t, x, y, z], …]`",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { surge = [[1.0, 10.0]] }",
        "44:14: motion.fairlead.surge: unknown key `surge` (known keys: file, table, x, y, z, roll, pitch, yaw, ramp)",
    ),
];

#[test]
fn surroundings_out_of_range_are_refused() {
    assert_refused(SURROUNDINGS);
}

const SURROUNDINGS: &[Refusal] = &[
    (
        r#"title = "a scene""#,
        r#"title = "a\nscene""#,
        "1:9: title: the title holds a line break or another control character: write one line",
    ),
    (
        "gravity = 9.81",
        "gravity = -9.81",
        "2:11: gravity: -9.81 m/s² is negative: gravity is a magnitude, downwards along z",
    ),
    (
        "gravity = 9.81",
        "gravity = inf",
        "2:11: gravity: inf is not a finite number",
    ),
    (
        "density = 1025.0",
        "density = 0.0",
        "5:11: water.density: 0 kg/m³ is not positive",
    ),
    (
        "depth = 50.0",
        "depth = -50.0",
        "8:9: seabed.depth: -50 m is negative: the depth counts downwards from z = 0",
    ),
    (
        "depth = 50.0",
        "depth = 1.0e6",
        "8:9: seabed.depth: 1e6 m is beyond the limit of 100000 m: is the unit or the power of ten right?",
    ),
    (
        "[seabed]",
        "[seabed]\nstiffness = 0.0",
        "8:13: seabed.stiffness: 0 Pa/m is not positive",
    ),
    (
        "[seabed]",
        "[seabed]\ndamping = -1.0",
        "8:11: seabed.damping: -1 Pa s/m is negative",
    ),
    (
        "[seabed]",
        "[seabed]\nfriction = -0.1",
        "8:12: seabed.friction: -0.1 is negative",
    ),
];

#[test]
fn line_types_that_make_no_sense_are_refused() {
    assert_refused(LINE_TYPES);
}

const LINE_TYPES: &[Refusal] = &[
    (
        "[line_types.chain]",
        r#"[line_types."my chain"]"#,
        r#"10:1: line_types."my chain": "my chain" holds ' '"#,
    ),
    (
        "mass = 100.0\n",
        "",
        "10:1: line_types.chain: no mass: give `mass` [kg/m], or `weight` [N/m] (the mass is then weight/gravity)",
    ),
    (
        "mass = 100.0",
        "mass = -100.0",
        "11:8: line_types.chain.mass: -100 kg/m is negative",
    ),
    (
        "mass = 100.0",
        "mass = 1.0e300",
        "11:8: line_types.chain.mass: 1e300 kg/m is beyond the limit of 1e6 kg/m: is the unit or the power of ten right?",
    ),
    (
        "mass = 100.0",
        "weight = -5.0",
        "11:10: line_types.chain.weight: the mass would be weight/gravity, and -5 N/m is not positive: give `mass` [kg/m] too",
    ),
    (
        "diameter = 0.1\n",
        "",
        "10:1: line_types.chain: no diameter: the buoyancy in the water needs `diameter` [m], or give the `weight` in water [N/m]",
    ),
    (
        "diameter = 0.1",
        "diameter = 0.0",
        "12:12: line_types.chain.diameter: 0 m is not positive",
    ),
    (
        "axial_stiffness = 1.0e8",
        "axial_stiffness = 0.0",
        "13:19: line_types.chain.axial_stiffness: 0 N is not positive",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\naxial_damping = -1.0",
        "12:17: line_types.chain.axial_damping: -1 N s is negative",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\naxial_damping = 1.0\ndamping_ratio = 0.1",
        "13:17: line_types.chain.damping_ratio: `axial_damping` is given too: give one of them",
    ),
    (
        "drag_normal = 1.2",
        "drag_normal = -1.2",
        "14:15: line_types.chain.drag_normal: -1.2 is negative",
    ),
    (
        "drag_normal = 1.2",
        "added_mass_tangential = -1",
        "14:25: line_types.chain.added_mass_tangential: -1 is negative",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nstrain = { logarithmic = 0.6 }",
        "12:26: line_types.chain.strain.logarithmic: 0.6 is not between 0 and 0.5",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nrayleigh = { ratios = [0.1, -0.1], frequencies = [1.0, 10.0] }",
        "12:29: line_types.chain.rayleigh.ratios[1]: -0.1 is negative",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nrayleigh = { ratios = [0.1, 0.1], frequencies = [1.0, 1.0] }",
        "12:49: line_types.chain.rayleigh.frequencies: the two circular frequencies are equal: the ratios hold at two different ones",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nrayleigh = { ratios = [0.1, 0.1], frequencies = [1.0, 0.0] }",
        "12:55: line_types.chain.rayleigh.frequencies[1]: 0 rad/s is not positive",
    ),
    (
        "mass = 100.0",
        "mass = 100.0\nrayleigh = { ratios = [0.1, 2.0], frequencies = [1.0, 10.0] }",
        "12:23: line_types.chain.rayleigh.ratios: the ratios ask for negative damping of mass or stiffness: their quotient must lie between 0.1000 and 10.0000, that of the frequencies and its inverse",
    ),
];

#[test]
fn points_that_make_no_sense_are_refused() {
    assert_refused(POINTS);
}

const POINTS: &[Refusal] = &[
    (
        r#"name = "anchor""#,
        r#"name = """#,
        "17:8: points[0].name: the name is empty",
    ),
    (
        r#"name = "anchor""#,
        r#"name = "anchor 1""#,
        r#"17:8: points[0].name: "anchor 1" holds ' '"#,
    ),
    (
        r#"name = "anchor""#,
        r#"name = "1anchor""#,
        r#"17:8: points[0].name: "1anchor" starts with a digit or -"#,
    ),
    (
        r#"name = "anchor""#,
        r#"name = "solver""#,
        "17:8: points[0].name: `solver` is the name of variables of every FMU: take another",
    ),
    (
        r#"name = "anchor""#,
        r#"name = "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa""#,
        "17:8: points[0].name: the name has 65 characters, 64 at most",
    ),
    (
        r#"name = "buoy""#,
        r#"name = "anchor""#,
        "22:8: points[1].name: the name `anchor` is taken by points[0]: take another",
    ),
    (
        r#"name = "line1""#,
        r#"name = "anchor""#,
        "32:8: lines[0].name: the name `anchor` is taken by points[0]: take another",
    ),
    (
        "position = [100.0, 0.0, -50.0]",
        "position = [1.0e8, 0.0, -50.0]",
        "18:13: points[0].position[0]: 1e8 m is beyond the limit of 1e7 m: is the unit or the power of ten right?",
    ),
    (
        "position = [100.0, 0.0, -50.0]",
        "position = [100.0, 0.0, -50.1]",
        "18:25: points[0].position[2]: z = -50.1 m lies below the seabed at z = -50 m",
    ),
    (
        r#"kind = "fixed""#,
        "kind = \"fixed\"\nfree = [\"x\"]",
        r#"20:8: points[0].free: only a free point has `free`, and this one is fixed: leave it out or write kind = "free""#,
    ),
    (
        r#"kind = "fixed""#,
        "kind = \"fixed\"\nmass = 3.0",
        r#"20:8: points[0].mass: only a free point has `mass`, and this one is fixed: leave it out or write kind = "free""#,
    ),
    (
        r#"kind = "fixed""#,
        "kind = \"fixed\"\nvolume = 3.0",
        r#"20:10: points[0].volume: only a free point has `volume`, and this one is fixed: leave it out or write kind = "free""#,
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nmass = -3.0",
        "25:8: points[1].mass: -3 kg is negative",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nvolume = -3.0",
        "25:10: points[1].volume: -3 m³ is negative",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nfree = []",
        r#"25:8: points[1].free: free along no axis: write kind = "fixed""#,
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nfree = [\"x\", \"x\"]",
        "25:14: points[1].free[1]: the axis is given twice",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nfree = [\"w\"]",
        "25:9: points[1].free[0]: unknown value `w` (known values: x, y, z)",
    ),
    (
        r#"kind = "fixed""#,
        "kind = \"fixed\"\nmotion = { x = [[1.0, 10.0]] }",
        r#"20:10: points[0].motion: a fixed point has no motion of its own: write kind = "prescribed""#,
    ),
    (
        r#"kind = "coupled""#,
        "kind = \"coupled\"\nmotion = { x = [[1.0, 10.0]] }",
        r#"30:10: points[2].motion: the host moves a coupled point; for `run` write it under [motion] as `fairlead = …`, or write kind = "prescribed""#,
    ),
    (
        r#"kind = "fixed""#,
        r#"kind = "prescribed""#,
        r#"16:1: points[0]: a prescribed point needs its `motion`; one that never moves is kind = "fixed""#,
    ),
    (
        r#"kind = "fixed""#,
        "kind = \"prescribed\"\nmotion = { file = \"a.csv\" }",
        "20:19: points[0].motion.file: a scene that comes as text cannot read files: write the rows as `table = [[t, x, y, z], …]`",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "farlead = { x = [[1.0, 10.0]] }",
        "44:11: motion.farlead: no coupled point or vessel is called `farlead`, did you mean `fairlead`? (coupled points and vessels: fairlead)",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "anchor = { x = [[1.0, 10.0]] }",
        "44:10: motion.anchor: `anchor` is fixed, and [motion] moves coupled points and vessels only",
    ),
];

const STIFF: &[Refusal] = &[
    (
        "drag_normal = 1.2",
        "bending_stiffness = -1.0",
        "14:21: line_types.chain.bending_stiffness: -1 N m² is negative",
    ),
    (
        "drag_normal = 1.2",
        "fibres = 0\nbending_stiffness = 5.0",
        "14:10: line_types.chain.fibres: 0 fibres: a section has 1 or more of them",
    ),
    (
        "drag_normal = 1.2",
        "fibres = 20",
        "14:10: line_types.chain.fibres: fibres share a bending stiffness: give `bending_stiffness` [N m²] or `solid_section` too",
    ),
    (
        "drag_normal = 1.2",
        "solid_section = { diameter = 0.1, youngs_modulus = 0.0 }",
        "14:52: line_types.chain.solid_section.youngs_modulus: 0 Pa is not positive",
    ),
    (
        "drag_normal = 1.2",
        "solid_section = { diameter = 0.1 }",
        "14:17: line_types.chain.solid_section: missing key `youngs_modulus` [Pa]",
    ),
    (
        "drag_normal = 1.2",
        "shear_stiffness = 1.0e4",
        "14:19: line_types.chain.shear_stiffness: only a beam has it: write model = \"beam\" or leave it out",
    ),
    (
        "drag_normal = 1.2",
        "model = \"rod\"",
        "14:9: line_types.chain.model: unknown value `rod` (known values: cable, beam)",
    ),
    (
        "drag_normal = 1.2",
        "model = \"beam\"",
        "10:1: line_types.chain: a beam needs `bending_stiffness` [N m²], or a `solid_section` that it follows from",
    ),
    (
        "to = \"buoy\"",
        "to = \"buoy\"\nclamped_a = [0.0, 0.0, 1.0]",
        "35:13: lines[0].clamped_a: a perfectly flexible line cannot be clamped: give its type a `bending_stiffness` [N m²]",
    ),
    (
        "to = \"buoy\"",
        "to = \"buoy\"\nclamped_b = [0.0, 0.0, 0.0]",
        "35:13: lines[0].clamped_b: [0, 0, 0] is no direction",
    ),
    (
        "kind = \"fixed\"",
        "kind = \"fixed\"\nmoment = { x = 3.0 }",
        "20:10: points[0].moment: a moment turns the end of a beam at a free point, and this one is fixed",
    ),
];

#[test]
fn stiffnesses_and_clamps_that_make_no_sense_are_refused() {
    assert_refused(STIFF);
}

const VESSELS: &[Refusal] = &[
    (
        "kind = \"coupled\"",
        "kind = \"coupled\"\non = \"platform\"",
        "30:6: points[2].on: no vessel is called `platform`",
    ),
    (
        "kind = \"fixed\"",
        "kind = \"fixed\"\non = \"ship\"\n[[vessels]]\nname = \"ship\"",
        "20:6: points[0].on: a point on a vessel moves with it, and this one is fixed: write kind = \"coupled\"",
    ),
    (
        "kind = \"fixed\"",
        "kind = \"fixed\"\n[[vessels]]\nname = \"fairlead\"",
        "21:8: vessels[0].name: the name `fairlead` is taken by points[2]: take another",
    ),
    (
        "kind = \"fixed\"",
        "kind = \"fixed\"\n[[vessels]]\nname = \"ship\"\nattitude = [0.0, 180.0, 0.0]",
        "22:18: vessels[0].attitude[1]: 180 rad is beyond the limit of",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { pitch = [[0.1, 10.0]] }",
        "44:12: motion.fairlead: a point does not turn: only vessels have `roll`, `pitch` and `yaw`",
    ),
];

#[test]
fn vessels_and_motions_that_make_no_sense_are_refused() {
    assert_refused(VESSELS);
}

#[test]
fn functions_of_time_that_make_no_sense_are_refused() {
    assert_refused(FUNCTIONS);
}

const FUNCTIONS: &[Refusal] = &[
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = {}",
        "25:9: points[1].force: no force along `x`, `y` or `z`",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = 1.0e20 }",
        "25:15: points[1].force.x: 1e20 N is beyond the limit of 1e15 N: is the unit or the power of ten right?",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = { step = [5.0, 0.0, 5.0, 20.0] } }",
        "25:24: points[1].force.x.step: it ends at 5 s, not after its start at 5 s: write [t0, f0, t1, f1] with t1 > t0",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = { ramp = [5.0, 0.0, 1.0, 20.0] } }",
        "25:24: points[1].force.x.ramp: it ends at 1 s, not after its start at 5 s: write [t0, f0, t1, f1] with t1 > t0",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = { table = [[0.0, 1.0], [2.0, 1.0], [1.0, 1.0]] } }",
        "25:51: points[1].force.x.table[2][0]: time 1 s does not come after 2 s: write the rows in ascending time",
    ),
    (
        r#"kind = "free""#,
        "kind = \"free\"\nforce = { x = { table = [] } }",
        "25:25: points[1].force.x.table: the table has no rows",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { table = [[0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]] }",
        "44:46: motion.fairlead.table[1][0]: time 0 s does not come after 0 s: write the rows in ascending time",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { table = [] }",
        "44:22: motion.fairlead.table: the table has no rows",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { x = [[1.0]] }",
        "44:19: motion.fairlead.x[0]: expected [amplitude [m], period [s]] or [amplitude, period, phase [rad]], found 1 numbers",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { x = [[1.0, 0.0]] }",
        "44:25: motion.fairlead.x[0][1]: 0 s is not positive",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { x = [[1.0e9, 1.0]] }",
        "44:20: motion.fairlead.x[0][0]: 1e9 m is beyond the limit of 1e7 m: is the unit or the power of ten right?",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { x = [[1.0, 10.0, 1.0e9]] }",
        "44:31: motion.fairlead.x[0][2]: 1e9 rad is beyond the limit of 1e6 rad: is the unit or the power of ten right?",
    ),
    (
        "fairlead = { x = [[1.0, 10.0]] }",
        "fairlead = { x = [[1.0, 10.0]], ramp = 0.0 }",
        "44:40: motion.fairlead.ramp: 0 s is not positive",
    ),
];

#[test]
fn lines_that_make_no_sense_are_refused() {
    assert_refused(LINES);
}

const LINES: &[Refusal] = &[
    (
        r#"from = "anchor""#,
        r#"from = "anchr""#,
        "33:8: lines[0].from: no point is called `anchr`, did you mean `anchor`? (points: anchor, buoy, fairlead)",
    ),
    (
        r#"to = "buoy""#,
        r#"to = "anchor""#,
        "34:6: lines[0].to: both ends are at `anchor`: a line joins two points (which may have the same position)",
    ),
    (
        r#"type = "chain", length = 150.0"#,
        r#"type = "chian", length = 150.0"#,
        "41:22: lines[1].sections[0].type: no line type is called `chian`, did you mean `chain`? (line types: chain)",
    ),
    (
        r#"sections = [{ type = "chain", length = 80.0 }]"#,
        "sections = []",
        "35:12: lines[0].sections: no sections: write sections = [{ type = …, length = … }]",
    ),
    (
        "length = 150.0",
        "length = 0.0",
        "41:40: lines[1].sections[0].length: 0 m is not positive",
    ),
    (
        "length = 150.0",
        "length = 1.0e7",
        "41:40: lines[1].sections[0].length: 1e7 m is beyond the limit of 1e6 m: is the unit or the power of ten right?",
    ),
    (
        "elements = 10",
        "elements = 0",
        "41:58: lines[1].sections[0].elements: 0 elements: give 1 or more, or leave it out to have it chosen",
    ),
    (
        "elements = 10",
        "elements = 100001",
        "41:58: lines[1].sections[0].elements: 100001 elements are more than 100000",
    ),
    (
        "elements = 10 }]",
        "elements = 10 }]\ninitial = { parabola = -2.0 }",
        "42:24: lines[1].initial.parabola: -2 m is negative: a positive sag hangs below the chord",
    ),
    (
        "elements = 10 }]",
        "elements = 10 }]\ninitial = { parabola = 0.0 }",
        "42:24: lines[1].initial.parabola: 0 m is not positive",
    ),
    (
        "elements = 10 }]",
        "elements = 10 }]\ninitial = { nodes = [[20.0, 0.0, -20.0], [0.0, 0.0, 0.0]] }",
        "42:21: lines[1].initial.nodes: 2 nodes, but a line of 10 elements has 11",
    ),
    (
        "length = 80.0 }]",
        "length = 80.0 }]\ninitial = { nodes = [[100.0, 0.0, -50.0], [20.0, 0.0, -20.0]] }",
        "36:21: lines[0].initial.nodes: given nodes need `elements` in every section of the line",
    ),
    (
        "length = 80.0 }]",
        "length = 80.0, elements = 1 }]\ninitial = { nodes = [[100.0, 0.0, -50.0], [21.0, 0.0, -20.0]] }",
        "36:43: lines[0].initial.nodes[1]: the node is not at the line's end, [20, 0, -20] m",
    ),
    (
        "length = 80.0 }]",
        "length = 80.0 }]\ninitial = \"straigt\"",
        "36:11: lines[0].initial: unknown value `straigt`, did you mean `straight`? (known values: static, straight, parabola, nodes)",
    ),
];

#[test]
fn solver_and_output_settings_that_make_no_sense_are_refused() {
    assert_refused(SETTINGS);
}

const SETTINGS: &[Refusal] = &[
    (
        "[output]",
        "[solver]\ntolerance = 0.0\n[output]",
        "47:13: solver.tolerance: 0 is not between 1e-12 and 0.5",
    ),
    (
        "[output]",
        "[solver]\ntime_step_max = -1.0\n[output]",
        "47:17: solver.time_step_max: -1 s is not positive",
    ),
    (
        "[output]",
        "[solver]\nthreads = 0\n[output]",
        "47:11: solver.threads: 0 is not between 1 and 256",
    ),
    (
        "[output]",
        "[solver]\nintegrator = \"generalised_alpha\"\nspectral_radius = 1.1\n[output]",
        "48:19: solver.spectral_radius: 1.1 is not between 0 and 1",
    ),
    (
        "[output]",
        "[solver]\nintegrator = \"axial_implicit\"\nspectral_radius = 0.0\n[output]",
        "48:19: solver.spectral_radius: 0 is not between 0.5 and 1",
    ),
    (
        "[output]",
        "[solver]\nintegrator = \"leapfrog\"\nspectral_radius = 0.5\n[output]",
        r#"48:19: solver.spectral_radius: the integrator is "leapfrog", and a spectral radius belongs to "generalised_alpha" and "axial_implicit""#,
    ),
    (
        "[output]",
        "[solver]\nbossak = { alpha = -0.1 }\n[output]",
        r#"47:10: solver.bossak: the integrator is "auto": write integrator = "bossak" or leave these parameters out"#,
    ),
    (
        "[output]",
        "[solver]\nintegrator = \"bossak\"\nbossak = { alpha = 0.1 }\n[output]",
        "48:20: solver.bossak.alpha: 0.1 is not between -1/3 and 0",
    ),
    (
        "[output]",
        "[solver]\nintegrator = \"bossak\"\nbossak = { alpha = -0.1, gamma = 0.2 }\n[output]",
        "48:34: solver.bossak.gamma: 0.2 is not between 0.5 and 1.5",
    ),
    (
        "[output]",
        "[solver]\nintegrator = \"bossak\"\nbossak = {}\n[output]",
        "48:10: solver.bossak: missing key `alpha` [-]",
    ),
    (
        "[output]",
        "[solver]\nintegrator = \"rk4\"\n[output]",
        "47:14: solver.integrator: unknown value `rk4` (known values: auto, leapfrog, axial_implicit, generalised_alpha, bossak, beam, quasi_static)",
    ),
    (
        "[output]",
        "[solver]\ninput_reconstruction = \"smoth\"\n[output]",
        "47:24: solver.input_reconstruction: unknown value `smoth`, did you mean `smooth`? (known values: smooth, jump)",
    ),
    (
        "duration = 60.0",
        "duration = 0.0",
        "47:12: output.duration: 0 s is not positive",
    ),
    (
        "interval = 0.1",
        "interval = -0.1",
        "48:12: output.interval: -0.1 s is not positive",
    ),
    (
        "interval = 0.1",
        "interval = 100.0",
        "48:12: output.interval: 100 s is longer than the duration of 60 s",
    ),
    (
        "interval = 0.1",
        "interval = 1.0e-6",
        "48:12: output.interval: 60 s in steps of 1e-6 s is more than 1e7 steps: give a longer interval or a shorter duration",
    ),
];

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
    let said = said_after(&[
        ("gravity = 9.81", "gravity = 0"),
        ("mass = 100.0", "weight = 5"),
    ]);
    assert_eq!(
        said,
        "11:10: line_types.chain.weight: the mass would be weight/gravity, but gravity is 0: give `mass` [kg/m] too"
    );
}

#[test]
fn drag_without_a_diameter_is_refused() {
    let said = said_after(&[("mass = 100.0", "weight = 5.0"), ("diameter = 0.1\n", "")]);
    assert!(
        said.contains("no diameter: the seabed's stiffness"),
        "{said}"
    );
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
        (
            "elements = 10 }]",
            "elements = 10 }]\ninitial = \"straight\"",
        ),
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

#[test]
fn a_moordyn_file_is_refused_as_one() {
    let text = "--------- MoorDyn Input File ---------\nMooring system\n----- LINE TYPES -----\nName Diam\n";
    assert!(said(text).starts_with("1:1: this is a MoorDyn file"));
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_are_read() {
    let text = format!("\u{feff}{}", SCENE.replace('\n', "\r\n"));
    assert_eq!(said(&text), "fine");
}

#[test]
fn a_file_that_is_no_text_is_refused_with_the_byte() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        load(&path).unwrap_err()
    };
    let latin = refused("latin.toml", b"title = \"a\"\n# M\xfcller\n");
    assert!(
        matches!(&latin, LoadError::NotText { byte: 15, .. }),
        "{latin}"
    );
    assert!(
        latin
            .to_string()
            .contains("byte 15 (line 2, column 4) is 0xFC"),
        "{latin}"
    );
    let binary = refused("binary.toml", b"\x7fELF\x02\x00\x01");
    assert!(
        matches!(&binary, LoadError::NotText { byte: 5, .. }),
        "{binary}"
    );
}

#[test]
fn a_file_that_cannot_be_read_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let missing = load(&folder.path().join("missing.toml")).unwrap_err();
    assert!(
        missing.to_string().ends_with("missing.toml: no such file"),
        "{missing}"
    );
    let is_folder = load(folder.path()).unwrap_err();
    assert!(
        is_folder
            .to_string()
            .ends_with("is a folder, not a scene file"),
        "{is_folder}"
    );
}

#[test]
fn all_mistakes_are_listed_in_the_order_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let text = SCENE
        .replace("depth = 50.0", "depth = -50.0")
        .replace("to = \"buoy\"", "to = \"bouy\"")
        .replace("interval = 0.1", "interval = 0.0")
        .replace("mass = 100.0", "mass = -1.0");
    fs::write(&path, &text).unwrap();
    let error = load(&path).unwrap_err();
    let list = error.list();
    let keys: Vec<&str> = error
        .mistakes()
        .iter()
        .map(|mistake| mistake.at.as_str())
        .collect();
    assert_eq!(
        keys,
        [
            "seabed.depth",
            "line_types.chain.mass",
            "lines[0].to",
            "output.interval"
        ]
    );
    assert!(
        list.contains(
            "scene.toml:34:6: lines[0].to: no point is called `bouy`, did you mean `buoy`?"
        )
    );
    assert!(error.to_string().ends_with("(and 3 mistakes more)"));
    let mut shown = String::new();
    miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::none())
        .render_report(&mut shown, &error)
        .unwrap();
    assert!(
        shown.contains("depth = -50.0") && shown.contains("to = \"bouy\""),
        "{shown}"
    );
}

/// Loads a scene whose fairlead follows a motion file with this text.
fn load_with_motion_file(folder: &Path, csv: &[u8]) -> Result<Scene, String> {
    let motion = "fairlead = { file = \"motion.csv\" }";
    let text = SCENE.replace("fairlead = { x = [[1.0, 10.0]] }", motion);
    fs::write(folder.join("scene.toml"), text).unwrap();
    fs::write(folder.join("motion.csv"), csv).unwrap();
    match load(&folder.join("scene.toml")) {
        Ok(loaded) => Ok(loaded.scene),
        Err(error) => Err(error.list()),
    }
}

#[test]
fn a_motion_file_is_read_beside_the_scene_and_packed_into_its_text() {
    let folder = tempfile::tempdir().unwrap();
    let csv = b"time [s], x [m], y [m], z [m]\n0, 0, 0, 0\n0.1, 1e-3, 0.3, -7\n";
    let scene = load_with_motion_file(folder.path(), csv).unwrap();
    let rows = vec![[0.0; 7], [0.1, 1e-3, 0.3, -7.0, 0.0, 0.0, 0.0]];
    assert_eq!(scene.motion["fairlead"].rows(), Some(rows.as_slice()));
    let packed = Scene::from_toml(&scene.to_toml()).unwrap();
    assert_eq!(packed.motion["fairlead"], MotionPath::Table(rows));
}

#[test]
fn a_motion_file_with_a_mistake_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&[u8], &str); 8] = [
        (
            b"",
            "line 1: the header must be \"time,x,y,z\" [s, m] or \"time,x,y,z,roll,pitch,yaw\" [s, m, rad], found \"\"",
        ),
        (
            b"0,0,0,0\n1,0,0,0\n",
            "line 1: the header must be \"time,x,y,z\" [s, m] or \"time,x,y,z,roll,pitch,yaw\" [s, m, rad], found \"0,0,0,0\"",
        ),
        (b"time,x,y,z\n", "motion.csv: no rows below the header"),
        (
            b"time,x,y,z\n0,0,0\n",
            "line 2: expected 4 numbers (time, x, y, z), found 3",
        ),
        (
            b"time,x,y,z\n0,0,0,0\n1,0,,0\n",
            "line 3: column y: expected a finite number, found \"\"",
        ),
        (
            b"time,x,y,z\n0,0,0,nan\n",
            "line 2: column z: expected a finite number, found \"nan\"",
        ),
        (
            b"time,x,y,z\n1,0,0,0\n1,0,0,0\n",
            "line 3: time 1 s does not come after 1 s",
        ),
        (b"time,x,y,z\n1,0,0,\xff\n", "line 2 is not UTF-8 text"),
    ];
    for (csv, message) in cases {
        let said = load_with_motion_file(folder.path(), csv).unwrap_err();
        assert!(
            said.contains("scene.toml:44:21: motion.fairlead.file: "),
            "{said}"
        );
        assert!(said.contains(message), "{said}\n  wanted: {message}");
    }
    fs::remove_file(folder.path().join("motion.csv")).unwrap();
    let said = load(&folder.path().join("scene.toml")).unwrap_err().list();
    assert!(
        said.ends_with("no such file (it is looked for beside the scene)"),
        "{said}"
    );
}

/// Text and name of every scene of the repository.
fn repository_scenes() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut scenes: Vec<(String, String)> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            (name, fs::read_to_string(path).unwrap())
        })
        .collect();
    scenes.sort();
    scenes
}

#[test]
fn every_scene_of_the_repository_is_right_and_survives_being_written() {
    let scenes = repository_scenes();
    assert!(scenes.len() >= 9);
    for (name, text) in scenes {
        let scene = Scene::from_toml(&text).unwrap_or_else(|mistake| panic!("{name}: {mistake}"));
        let written = scene.to_toml();
        assert_eq!(
            Scene::from_toml(&written).unwrap(),
            scene,
            "{name}\n{written}"
        );
    }
}

#[test]
fn words_say_what_is_modelled_and_what_is_not() {
    let words = Scene::from_toml(SCENE).unwrap().in_words();
    assert!(words.contains("still water of 1025 kg/m³"));
    // (100 − 1025·π/4·0.1²)·9.81 = 902.03 N/m
    assert!(words.contains("weight 902.03 N/m in water"), "{words}");
    assert!(
        words.contains("drag (normal 1.2, tangential none), no added mass"),
        "{words}"
    );
    let dry = SCENE
        .replace("[water]\ndensity = 1025.0\n", "")
        .replace("[seabed]\ndepth = 50.0\n", "");
    let scene = Scene::from_toml(&dry).unwrap();
    let words = scene.in_words();
    let absent = words.split("not modelled").nth(1).unwrap();
    assert!(
        words.contains("no water") && words.contains("weight 981 N/m in air"),
        "{words}"
    );
    assert!(absent.contains("buoyancy, drag and added mass"), "{words}");
    assert!(
        absent.contains("contact with a\n      seabed") || absent.contains("contact with a seabed")
    );
    let notes = scene.notes();
    let note = notes
        .iter()
        .find(|note| note.text.contains("without [water]"))
        .unwrap();
    assert_eq!(
        note.to_string(),
        "line_types.chain: without [water], drag_normal change nothing"
    );
}

#[test]
fn notes_speak_of_what_is_unused_or_strange() {
    let text = SCENE
        .replace("[[points]]\nname = \"buoy\"", "[line_types.spare]\nmass = 1.0\ndiameter = 0.1\naxial_stiffness = 1.0\n\n[[points]]\nname = \"buoy\"")
        .replace("length = 80.0", "length = 40.0")
        .replace("position = [0.0, 0.0, 0.0]", "position = [0.0, 0.0, 1.0]")
        .replace("density = 1025.0", "density = 1025.0\nsurface = false")
        .replace("interval = 0.1", "interval = 0.7");
    let scene = Scene::from_toml(&text).unwrap();
    let notes: Vec<String> = scene.notes().iter().map(ToString::to_string).collect();
    for beginning in [
        "line_types.spare: no line uses this line type",
        "lines[0]: its ends are 85.44003745317531 m apart, and it is 40 m long unstretched: it is strained by at least 114 %",
        "points[2].position: above z = 0",
        "output.interval: the duration of 60 s is not a whole number of intervals",
    ] {
        assert!(
            notes.iter().any(|note| note.starts_with(beginning)),
            "{beginning}\n{notes:#?}"
        );
    }
}

/// Fails where reading the text panics, or refuses it without a place in it.
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

/// A text with much of what the format allows.
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
fn a_mistake_at_the_very_end_of_a_file_can_be_shown() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    for text in [
        "",
        "gravity =",
        "gravity =\n",
        "title = \"",
        "[",
        "\u{feff}\u{fc} = ",
    ] {
        fs::write(&path, text).unwrap();
        let error = load(&path).unwrap_err();
        let mut shown = String::new();
        miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::none())
            .render_report(&mut shown, &error)
            .unwrap();
        assert!(
            shown.contains("scene.toml:") && !shown.contains("Failed"),
            "{shown}"
        );
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
