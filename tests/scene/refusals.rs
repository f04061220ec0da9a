//! Every mistake once: what is written instead, and what is said about it.

use crate::{Refusal, SCENE, assert_refused, said};

#[test]
fn a_slip_in_syntax_a_key_or_a_type_is_refused_with_what_is_accepted() {
    assert_refused(SLIPS);
}

const SLIPS: &[Refusal] = &[
    (
        "gravity = 9.81",
        "gravity = 9.81 m",
        "2:11: not TOML: `9.81 m` has a unit: numbers stand alone",
    ),
    (
        "gravity = 9.81",
        "gravity = 9,81",
        "2:12: not TOML: `9,81` has a decimal comma: numbers have a point, 9.81",
    ),
    (
        "density = 1025.0",
        "density = 1.025,0",
        "5:16: not TOML: `1.025,0` has a decimal comma: numbers have a point, 1025.0, and nothing between thousands",
    ),
    (
        "density = 1025.0",
        "density = 1025.0\nsurface = yes",
        "6:11: not TOML: `yes` is written `true`",
    ),
    (
        "position = [100.0, 0.0, -50.0]",
        "position = 100.0, 0.0, -50.0",
        "18:17: not TOML: several numbers stand in brackets, [100.0, 0.0, -50.0], and a single one",
    ),
    (
        "position = [100.0, 0.0, -50.0]",
        "position = [100,0, 0,0, -50,0]",
        "18:12: points[0].position: expected an array of 3 numbers [m], found an array of 6: if these are decimal commas, write points, \
         [100.0, 0.0, -50.0]",
    ),
    (
        "position = [100.0, 0.0, -50.0]",
        "position = [100.5, 0.0, -50.0, 1, 2, 3]",
        "18:12: points[0].position: expected an array of 3 numbers [m], found an array of 6",
    ),
    (
        "[[1.0, 10.0]]",
        "[[1,0, 10,0]]",
        "44:19: motion.fairlead.x[0]: expected [amplitude [m], period [s]] or [amplitude, period, phase [rad]], found 4 numbers: if these \
         are decimal commas, write points, [1.0, 10.0]",
    ),
    (
        "x = [[1.0, 10.0]]",
        "table = [[0,0, 1,0, 0,0, 0,5]]",
        "44:23: motion.fairlead.table[0]: expected an array of 4 numbers (t, x, y, z), or of 7 (with roll, pitch, yaw of a vessel), found \
         an array of 8: if these are decimal commas, write points, [0.0, 1.0, 0.0, 0.5]",
    ),
    (
        "kind = \"fixed\"",
        "kind = fixed",
        "19:8: not TOML: `fixed` is a word without quotes: write \"fixed\"",
    ),
    (
        "gravity = 9.81",
        "gravity =",
        "2:10: not TOML: no value stands after `gravity =`",
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
        "41:31: lines[1].sections[0].lenght: unknown key `lenght`, did you mean `length`? (known keys: type, length, elements, damping_elements)",
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
    ("name = \"anchor\"\n", "", "16:1: points[0]: missing key `name`"),
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
        "42:11: lines[1].initial: expected one of `static`, `catenary`, `straight`, `parabola`, `nodes`, found an array",
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
        "25:17: points[1].force.x.stp: unknown key `stp`, did you mean `step`? (known keys: constant, step, ramp, table)",
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
        r#"20:8: points[0].mass: a fixed point has no `mass`, which would act on the ground alone: leave it out or write kind = "free""#,
    ),
    (
        r#"kind = "fixed""#,
        "kind = \"fixed\"\nvolume = 3.0",
        r#"20:10: points[0].volume: a fixed point has no `volume`, which would act on the ground alone: leave it out or write kind = "free""#,
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
        "44:11: motion.farlead: no vessel or coupled point is called `farlead`; there is `fairlead`",
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
        "14:10: line_types.chain.fibres: 0 is not between 1 and 1e9",
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
        "20:10: points[0].moment: a moment turns the end of a line that bends at a free point, and this one is fixed",
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
        "41:58: lines[1].sections[0].elements: 0 is not between 1 and 100000",
    ),
    (
        "elements = 10",
        "elements = 100001",
        "41:58: lines[1].sections[0].elements: 100001 is not between 1 and 100000",
    ),
    (
        "elements = 10 }]",
        "elements = 10 }]\ninitial = { parabola = -2.0 }",
        "42:24: lines[1].initial.parabola: -2 m is not positive: a positive sag hangs below the chord",
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
        "36:11: lines[0].initial: unknown value `straigt`, did you mean `straight`? (known values: static, catenary, straight, parabola, nodes)",
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
        "47:24: solver.input_reconstruction: unknown value `smoth`, did you mean `smooth`? (known values: smooth, jump, interpolate)",
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

#[test]
fn a_motion_under_a_name_that_nothing_has_says_what_there_is() {
    let text = SCENE
        .replace("kind = \"coupled\"", "kind = \"coupled\"\non = \"semi\"")
        .replace(
            "fairlead = { x = [[1.0, 10.0]] }",
            "platform = { x = [[1.0, 10.0]], pitch = [[0.1, 10.0]] }",
        )
        + "[[vessels]]\nname = \"semi\"\n";
    let wanted = "motion.platform: no vessel or coupled point is called `platform`; there is `semi`";
    assert!(said(&text).ends_with(wanted), "{}", said(&text));
}

#[test]
fn a_moment_that_nothing_takes_is_refused() {
    let moment = "kind = \"free\"\nmoment = { y = 3.0 }";
    let loose = SCENE.replace("kind = \"free\"", moment);
    assert!(said(&loose).contains("points[1].moment: no line that bends ends at this point"));
    let stiff = "axial_stiffness = 1.0e8\nbending_stiffness = 1.0e3";
    let two = loose.replace("axial_stiffness = 1.0e8", stiff);
    assert!(said(&two).contains("`line1` and `line2` both bend and end at this point"));
}
