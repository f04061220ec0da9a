//! Decks of MoorDyn and MAP++: what is read of them, what is refused and where, and that a converted deck is the same system.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use moorline::model::Model;
use moorline::scene::{
    Friction, LoadError, LoadedScene, PointKind, Scene, Supplement, TimeFunction, load, load_with,
};
use moorline::simulation::Simulation;

const OPENFAST: &str = include_str!("decks/openfast_v2.dat");
const VERSION_1: &str = include_str!("decks/moordyn_v1.dat");
const C_STYLE: &str = include_str!("decks/moordyn_c.txt");
const FARM: &str = include_str!("decks/farm.dat");
const MAP: &str = include_str!("decks/oc3.map");

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/decks")
        .join(name)
}

fn read(name: &str) -> LoadedScene {
    load(&deck(name)).unwrap_or_else(|error| panic!("{}", error.list()))
}

/// What the host of the decks that leave something out would give.
fn supplement() -> Supplement {
    let at = |name: &str, x| (name.to_string(), [x, 0.0, 0.0]);
    Supplement {
        depth: Some(320.0),
        positions: [at("turbine1", 0.0), at("turbine2", 1000.0)].into(),
    }
}

/// What the host of the MAP++ deck would give.
fn deep() -> Supplement {
    Supplement {
        depth: Some(320.0),
        ..Supplement::default()
    }
}

/// A deck as bytes of a file with a name that says nothing.
fn load_bytes(bytes: &[u8], supplement: &Supplement) -> Result<LoadedScene, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("input");
    fs::write(&path, bytes).unwrap();
    load_with(&path, supplement)
}

fn load_text(text: &str) -> Result<LoadedScene, LoadError> {
    load_bytes(text.as_bytes(), &Supplement::default())
}

/// Every mistake on a line, without the folder: `input:7:32: …`.
fn said(text: &str) -> String {
    let error = load_text(text).expect_err("the deck is wrong");
    let listed = error.list();
    let lines = listed
        .lines()
        .map(|line| line.rsplit_once("/input").map_or(line, |(_, rest)| rest));
    lines.map(|line| format!("input{line}\n")).collect()
}

/// The deck with one part of its text replaced, which must be there.
fn with(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{old:?} is not in the deck");
    text.replacen(old, new, 1)
}

fn notes(loaded: &LoadedScene) -> String {
    loaded
        .notes
        .iter()
        .map(|note| format!("{note}\n"))
        .collect()
}

fn point<'s>(scene: &'s Scene, name: &str) -> &'s moorline::scene::Point {
    let mut points = scene.points.iter();
    points
        .find(|point| point.name == name)
        .unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn an_openfast_deck_is_read_as_three_lines_on_a_vessel() {
    let LoadedScene { scene, format, .. } = read("openfast_v2.dat");
    assert_eq!(format, "MoorDyn v2");
    assert_eq!(
        scene.title,
        "Three catenaries on a barge, in the style of OpenFAST"
    );
    let chain = &scene.line_types["chain"];
    assert_eq!((chain.mass, chain.diameter), (Some(113.35), Some(0.0766)));
    assert_eq!(chain.axial_stiffness, Some(7.536e8));
    assert_eq!(
        (chain.axial_damping, chain.damping_ratio),
        (None, Some(0.8))
    );
    assert_eq!(
        (chain.drag_normal, chain.drag_tangential),
        (Some(2.0), Some(0.4))
    );
    assert_eq!(chain.added_mass_normal, Some(0.8));
    assert_eq!(chain.added_mass_tangential, Some(0.25));
    assert_eq!(chain.bending_stiffness, None);
    let wire = &scene.line_types["wire"];
    assert_eq!((wire.axial_damping, wire.damping_ratio), (Some(0.5), None));
    assert_eq!(scene.vessels.len(), 1);
    assert_eq!(scene.vessels[0].name, "vessel");
    assert_eq!(scene.vessels[0].position, [0.0; 3]);
    for name in ["point4", "point5", "point6"] {
        assert_eq!(point(&scene, name).kind, PointKind::Coupled);
        assert_eq!(point(&scene, name).on.as_deref(), Some("vessel"));
    }
    for name in ["point1", "point2", "point3"] {
        assert_eq!(point(&scene, name).kind, PointKind::Fixed);
    }
    let third = &scene.lines[2];
    assert_eq!(
        (third.name.as_str(), third.from.as_str(), third.to.as_str()),
        ("line3", "point3", "point6")
    );
    assert_eq!(third.sections[0].line_type, "wire");
    assert_eq!(
        (third.sections[0].length, third.sections[0].elements),
        (330.0, Some(16))
    );
    let seabed = scene.seabed.unwrap();
    assert_eq!(
        (seabed.depth, seabed.stiffness, seabed.damping),
        (100.0, 2e6, 1e5)
    );
    assert_eq!(scene.water.unwrap().density, 1025.0);
    let channels = [
        "FairTen1",
        "FairTen2",
        "FAIRTEN3",
        "AnchTen1",
        "L1N10T",
        "L3N16Px",
        "Line2NAPz",
        "Con4Fx",
        "Point4Fy",
        "P4Fz",
    ];
    assert_eq!(scene.output.channels, channels);
}

#[test]
fn the_traps_of_a_deck_are_named_with_their_lines() {
    let said = notes(&read("openfast_v2.dat"));
    for (line, part) in [
        ("file line 19: ", "the header calls column 3 \"UnstrLen\""),
        ("file line 7: ", "is a damping ratio of 0.8"),
        ("file line 7: ", "fit a chain whose bar has this diameter"),
        ("file line 8: ", "BA 0.5 N s is next to none"),
        ("file line 8: ", "more than steel"),
        ("file: ", "damping within a line acts in compression too"),
        ("file: ", "taken from the deepest fixed point, 100 m"),
        ("file line 25: ", "dtM, dtIC, TmaxIC, CdScaleIC, threshIC"),
        ("file line 23: ", "no files of single lines"),
        ("file line 38: ", "\"fx\" names no object"),
    ] {
        let found = said
            .lines()
            .any(|note| note.starts_with(line) && note.contains(part));
        assert!(found, "{line}{part}\n{said}");
    }
    let said = notes(&read("moordyn_v1.dat"));
    assert!(
        said.contains("file line 6: chain: the header has Pa s above the damping"),
        "{said}"
    );
    assert!(said.contains("read as MoorDyn v1"), "{said}");
}

#[test]
fn the_words_for_a_deck_tell_of_its_vessel_and_of_where_points_are_on_it() {
    let words = read("moordyn_c.txt").scene.in_words();
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("body1: moved by the host, its origin at (0, 0, -20) m, at roll 0 rad, pitch 0 rad, yaw 1.5708 rad"),
        "{words}"
    );
    assert!(
        words.contains("carries point7; in `run` it stays where it is"),
        "{words}"
    );
    assert!(
        words.contains("point7: rides on body1, at (5, 0, 15) m in its frame"),
        "{words}"
    );
    // In its body's frame the point is above z = 0, but the body lies deep, and turned.
    assert!(!notes(&read("moordyn_c.txt")).contains("above z = 0"));
    assert!(
        words.contains(
            "line1: from rod1a to point7, 160 m of cable in 16 elements; 27.902 m longer"
        ),
        "{words}"
    );
}

#[test]
fn the_two_versions_of_a_deck_are_the_same_scene() {
    let one = read("moordyn_v1.dat");
    let two = read("moordyn_v2_same.dat");
    assert_eq!((one.format, two.format), ("MoorDyn v1", "MoorDyn v2"));
    assert_eq!(one.scene, two.scene);
    let buoy = point(&one.scene, "point2");
    assert_eq!(buoy.kind, PointKind::Free);
    assert_eq!((buoy.mass, buoy.volume), (Some(500.0), Some(2.0)));
    assert_eq!((buoy.drag_area, buoy.added_mass), (Some(1.5), Some(0.6)));
    let force = buoy.force.as_ref().unwrap();
    assert_eq!(
        (&force.x, &force.z),
        (&None, &Some(TimeFunction::Constant(1e3)))
    );
    assert_eq!(one.scene.output.interval, 0.02);
}

#[test]
fn a_deck_in_the_style_of_moordyn_c_is_read_with_its_body_rod_and_coupled_point() {
    let LoadedScene { scene, .. } = read("moordyn_c.txt");
    assert_eq!(
        (scene.gravity, scene.water.as_ref().unwrap().density),
        (9.81, 1028.0)
    );
    assert_eq!(
        scene.seabed.as_ref().unwrap().friction,
        Friction::isotropic(0.4)
    );
    let body = &scene.vessels[0];
    assert_eq!(
        (body.name.as_str(), body.position),
        ("body1", [0.0, 0.0, -20.0])
    );
    assert!((body.attitude[2] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert_eq!(point(&scene, "point7").on.as_deref(), Some("body1"));
    let coupled = point(&scene, "point2");
    assert_eq!((coupled.kind, &coupled.on), (PointKind::Coupled, &None));
    // The line leaves the rod's end A, away from its end B.
    assert_eq!(point(&scene, "rod1a").position, [120.0, 0.0, -60.0]);
    assert_eq!(scene.lines[0].clamped_a, Some([1.0, 0.0, 0.0]));
    assert_eq!(scene.lines[0].clamped_b, None);
    assert_eq!(scene.line_types["cable"].bending_stiffness, Some(1.2e4));
    assert!(scene.line_types.contains_key("type2inch"));
}

#[test]
fn a_line_is_clamped_as_it_runs_along_or_against_its_rod() {
    let direction = |end: &str, line: &str| {
        let deck = with(C_STYLE, "118    0    -60   0 ", "118    0    -60   4 ");
        let deck = with(&deck, "cable      R1A      7  ", line);
        let scene = load_text(&deck)
            .unwrap_or_else(|error| panic!("{}", error.list()))
            .scene;
        let clamped = (scene.lines[0].clamped_a, scene.lines[0].clamped_b);
        assert!(scene.points.iter().any(|point| point.name == end));
        clamped
    };
    let (along, against) = (Some([-1.0, 0.0, 0.0]), Some([1.0, 0.0, 0.0]));
    assert_eq!(direction("rod1b", "cable Rod1B 7 "), (along, None));
    assert_eq!(direction("rod1a", "cable R1A 7 "), (against, None));
    assert_eq!(direction("rod1a", "cable 7 R1A "), (None, along));
    assert_eq!(direction("rod1b", "cable 7 R1B "), (None, against));
}

#[test]
fn a_clamp_on_a_turned_body_is_a_direction_in_global_axes() {
    let rod = "1    clamp     Fixed      120   0    -60   118    0    -60   0";
    let deck = with(C_STYLE, rod, "1 clamp Body1 5 0 0 3 0 0 0");
    let scene = load_text(&deck)
        .unwrap_or_else(|error| panic!("{}", error.list()))
        .scene;
    assert_eq!(point(&scene, "rod1a").on.as_deref(), Some("body1"));
    let [x, y, z] = scene.lines[0].clamped_a.unwrap();
    assert!(
        x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15 && z == 0.0,
        "{x} {y} {z}"
    );
}

#[test]
fn points_on_a_fixed_body_are_fixed_where_it_has_them() {
    let deck = with(
        C_STYLE,
        "1    Coupled     0      0    -20",
        "1    Fixed     10      0    -20",
    );
    let scene = load_text(&deck)
        .unwrap_or_else(|error| panic!("{}", error.list()))
        .scene;
    assert!(scene.vessels.is_empty());
    let held = point(&scene, "point7");
    assert_eq!(held.kind, PointKind::Fixed);
    let [x, y, z] = held.position;
    assert!(
        (x - 10.0).abs() < 1e-12 && (y - 5.0).abs() < 1e-12 && z == -5.0,
        "{x} {y} {z}"
    );
}

#[test]
fn a_farm_stands_where_its_host_says() {
    let said = said(FARM);
    assert!(said.starts_with("input:10:6: Turbine1: "), "{said}");
    assert!(said.contains("\ninput:11:6: Turbine2: "), "{said}");
    assert!(said.contains("--at turbine1=X,Y,Z"), "{said}");
    let scene = load_with(&deck("farm.dat"), &supplement()).unwrap().scene;
    let stands: Vec<_> = scene
        .vessels
        .iter()
        .map(|v| (v.name.as_str(), v.position))
        .collect();
    assert_eq!(
        stands,
        [("turbine1", [0.0; 3]), ("turbine2", [1000.0, 0.0, 0.0])]
    );
    let mut wrong = supplement();
    wrong.positions.insert("turbine3".into(), [0.0; 3]);
    let error = load_with(&deck("farm.dat"), &wrong).unwrap_err();
    assert!(
        error.list().contains("a position is given for `turbine3`"),
        "{}",
        error.list()
    );
}

/// Source: MAP++ summary of OC3 Hywind in the regression tests of OpenFAST: fairlead tension 911 089.46 N with friction 0.001.
#[test]
fn a_map_deck_repeats_its_lines_and_has_the_published_tension_of_oc3() {
    let error = load(&deck("oc3.map")).unwrap_err().list();
    assert!(
        error.contains("oc3.map:8:32: NODE PROPERTIES, Z: "),
        "{error}"
    );
    let loaded = load_with(&deck("oc3.map"), &deep()).unwrap();
    assert_eq!(loaded.format, "MAP++");
    let scene = &loaded.scene;
    let names: Vec<&str> = scene.lines.iter().map(|line| line.name.as_str()).collect();
    assert_eq!(names, ["line1", "line2", "line3"]);
    let turned = point(scene, "point3").position;
    assert!((turned[0] + 0.5 * 853.87).abs() < 1e-9 && turned[2] == -320.0);
    assert_eq!(point(scene, "point6").on.as_deref(), Some("vessel"));
    assert_eq!(scene.seabed.as_ref().unwrap().friction.axial, 0.001);
    let simulation = Simulation::new(scene).unwrap();
    for line in 0..3 {
        let tension = simulation.catenary(line).unwrap().tension_b();
        assert!((tension / 911_089.46 - 1.0).abs() < 1e-5, "{tension}");
    }
    let said = notes(&loaded);
    assert!(
        said.contains("file line 17: \"inner_ftol 1e-6\" is a comment"),
        "{said}"
    );
}

#[test]
fn a_nodes_mass_volume_and_force_in_a_map_deck_reach_the_scene() {
    let deck = with(
        MAP,
        "2     Vessel    5.2     0.0    -70.0     0     0        #     #     #",
        "2 Vessel 5.2 0 -70 0 0 # # #\n3 connect #400 #0 #-200 1000 2 0 0 -5e3",
    );
    let deck = with(
        &deck,
        "902.2       1         2 ",
        "600 1 3\n2 Material 350 3 2 ",
    );
    let deck = with(&deck, "repeat 120 240\n", "");
    let scene = load_bytes(deck.as_bytes(), &deep())
        .unwrap_or_else(|e| panic!("{}", e.list()))
        .scene;
    let node = point(&scene, "point3");
    assert_eq!(
        (node.kind, node.position),
        (PointKind::Free, [400.0, 0.0, -200.0])
    );
    assert_eq!((node.mass, node.volume), (Some(1000.0), Some(2.0)));
    assert_eq!(
        node.force.as_ref().unwrap().z,
        Some(TimeFunction::Constant(-5e3))
    );
}

#[test]
fn the_content_of_a_file_tells_what_it_is_and_its_name_does_not() {
    let folder = tempfile::tempdir().unwrap();
    for (text, format) in [
        (OPENFAST, "MoorDyn v2"),
        (VERSION_1, "MoorDyn v1"),
        (MAP, "MAP++"),
    ] {
        for name in ["a.toml", "b", "c.map", "d.dat"] {
            let path = folder.path().join(name);
            fs::write(&path, text).unwrap();
            assert_eq!(load_with(&path, &deep()).unwrap().format, format, "{name}");
        }
    }
}

#[test]
fn dashes_in_comments_and_strings_of_a_scene_are_no_deck() {
    let scene =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/demo.toml")).unwrap();
    let text = format!("# ------ LINE TYPES ------\n{scene}");
    assert_eq!(load_text(&text).unwrap().format, "TOML");
}

#[test]
fn latin_1_utf_8_marks_and_all_ends_of_lines_are_read_alike() {
    let plain = load_text(OPENFAST).unwrap().scene;
    let accented = with(OPENFAST, "# next to no damping", "# hält nichts, 5 µm, ½");
    let latin: Vec<u8> = accented
        .chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect();
    assert!(std::str::from_utf8(&latin).is_err());
    let dos = OPENFAST.replace('\n', "\r\n");
    let marked = format!("\u{feff}{OPENFAST}");
    let tabs = OPENFAST.replace("  ", "\t");
    for bytes in [
        latin.as_slice(),
        accented.as_bytes(),
        dos.as_bytes(),
        marked.as_bytes(),
        tabs.as_bytes(),
    ] {
        assert_eq!(
            load_bytes(bytes, &Supplement::default()).unwrap().scene,
            plain
        );
    }
}

#[test]
fn a_converted_deck_is_the_same_scene_and_the_same_equilibrium_bit_for_bit() {
    for name in [
        "openfast_v2.dat",
        "moordyn_v1.dat",
        "moordyn_c.txt",
        "farm.dat",
        "oc3.map",
    ] {
        let supplement = match name {
            "farm.dat" => supplement(),
            "oc3.map" => deep(),
            _ => Supplement::default(),
        };
        let loaded = load_with(&deck(name), &supplement).unwrap_or_else(|e| panic!("{}", e.list()));
        let text = loaded.to_commented_toml();
        assert!(text.starts_with(&format!("# {name}, a M")), "{text}");
        let back = Scene::from_toml(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(back, loaded.scene, "{name}");
        if name == "moordyn_c.txt" {
            continue; // its cable bends, which has tests of its own
        }
        let (first, second) = (
            Simulation::new(&loaded.scene).unwrap(),
            Simulation::new(&back).unwrap(),
        );
        assert_eq!(first.snapshot(), second.snapshot(), "{name}");
    }
}

#[test]
fn a_converted_deck_says_units_and_lines_of_the_file() {
    let text = read("openfast_v2.dat").to_commented_toml();
    for part in [
        "[line_types.chain]  # file line 7\n",
        "mass = 113.35  # kg/m\n",
        "name = \"point4\"",
        "[[lines]]  # file line 21\n",
        "length = 340.0  # m\n",
        "depth = 100.0  # m\n",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

/// What is written instead, and how the list of mistakes begins.
const REFUSALS: &[(&str, &str, &str)] = &[
    (
        "-0.8      0.0   2.0",
        "-0.8   2.0",
        "input:7:1: LINE TYPES, row 1: 9 columns, expected 10 (Name Diam",
    ),
    (
        "0.0766  113.35",
        "0.0766m  113.35",
        "input:7:10: LINE TYPES, row 1, Diam: expected a number [m], found \"0.0766m\"",
    ),
    (
        "0.0766  113.35",
        "NaN  113.35",
        "input:7:10: LINE TYPES, row 1, Diam: expected a finite number [m], found \"NaN\"",
    ),
    (
        "0.0766  113.35",
        "1e999  113.35",
        "input:7:10: LINE TYPES, row 1, Diam: \"1e999\" is beyond all numbers",
    ),
    (
        "0.0766  113.35",
        "-0.0766  113.35",
        "input:7:10: line type chain, Diam: -0.0766 m is not positive",
    ),
    (
        "0.0766  113.35",
        "1e300  113.35",
        "input:7:10: line type chain, Diam: 1e300 m is beyond the limit of 100 m",
    ),
    (
        "7.536D8 ",
        "0 ",
        "input:7:29: line type chain, EA: 0 N is not positive",
    ),
    (
        "7.536D8 ",
        "7e8|9e8|0.1 ",
        "input:7:29: line type chain, EA: a dynamic stiffness that grows with the mean tension",
    ),
    (
        "7.536D8 ",
        "7e8|9e8 ",
        "input:7:41: line type chain, BA/-zeta: a damping ratio has no meaning for the slow part",
    ),
    (
        "-0.8      0.0",
        "4E9|11e6      0.0",
        "input:7:41: line type chain, BA/-zeta: two dampings belong",
    ),
    (
        "-0.8      0.0",
        "ba.txt      0.0",
        "input:7:41: line type chain, BA/-zeta: a damping from \"ba.txt\"",
    ),
    (
        "-0.8      0.0",
        "-0.8      ei.txt",
        "input:7:51: line type chain, EI: only a constant EI",
    ),
    (
        "0.4    0.25",
        "0.4    0.25 0.7",
        "input:7:82: line type chain, Cl: vortex-induced vibration is not modelled",
    ),
    (
        "chain    0.0766",
        "wire    0.0766",
        "input:8:1: line type wire: a second line type wire",
    ),
    (
        "1    fixed      330.0",
        "one    fixed      330.0",
        "input:12:1: POINTS, row 1, ID: expected a whole number from 1 on, found \"one\"",
    ),
    (
        "1    fixed      330.0",
        "2    fixed      330.0",
        "input:13:1: point 2: a second point 2",
    ),
    (
        "1    fixed      330.0",
        "1    moored     330.0",
        "input:12:6: POINTS, row 1, Attachment: expected Fixed, Coupled",
    ),
    (
        "1    fixed      330.0",
        "1    Body1      330.0",
        "input:12:6: point 1: no body has the number 1",
    ),
    (
        "1    fixed      330.0      0.0    -100.0",
        "1    fixed      330.0      0.0",
        "input:12:1: POINTS, row 1: 8 columns, expected 9 (ID",
    ),
    (
        "1        chain        1",
        "1        chian        1",
        "input:21:10: LINES, row 1, LineType: no line type is called \"chian\"",
    ),
    (
        "1        chain        1",
        "1        Chain        1",
        "input:21:10: LINES, row 1, LineType: no line type is called \"Chain\", did you mean \"chain\"?",
    ),
    (
        "1        chain        1         4",
        "1        chain        1         9",
        "input:21:33: LINES, row 1, AttachB: no point has the number 9",
    ),
    (
        "1        chain        1         4",
        "1        chain        4         4",
        "input:21:33: line 1, AttachB: both ends are at `point4`",
    ),
    (
        "1        chain        1         4",
        "1        chain        1         R1A",
        "input:21:33: LINES, row 1, AttachB: no rod has the number 1",
    ),
    (
        "340.0       20       -",
        "-340.0       20       -",
        "input:21:40: line 1, UnstrLen: -340 m is not positive",
    ),
    (
        "340.0       20       -",
        "340.0       0       -",
        "input:21:52: LINES, row 1, NumSegs: expected a whole number from 1 on, found \"0\"",
    ),
    (
        "340.0       20       -",
        "340.0       999999999       -",
        "input:21:52: line 1, NumSegs: 999999999 elements are more than 100000",
    ),
    (
        "340.0       20       -",
        "340.0       20",
        "input:21:1: LINES, row 1: 6 columns, expected 7 (ID",
    ),
    (
        "2.0e6    kbot",
        "kbot    2.0e6",
        "input:26:9: OPTIONS: an option is written as value and key",
    ),
    (
        "2.0e6    kbot",
        "-2.0e6    kbot",
        "input:26:1: OPTIONS, kBot: -2e6 Pa/m is not positive",
    ),
    (
        "2.0e6    kbot",
        "2.0e6    kbto",
        "input:26:10: OPTIONS: unknown option \"kbto\", did you mean KBOT?",
    ),
    (
        "2.0e6    kbot",
        "0.2    cbot",
        "input:27:10: OPTIONS: a second value of cbot",
    ),
    (
        "2.0e6    kbot",
        "2.0e6",
        "input:26:12: OPTIONS: unknown option \"-\"",
    ),
    (
        "2.0e6    kbot",
        "1 WaveKin",
        "input:26:1: OPTIONS, WaveKin: only WaveKin 7 (components of wave_frequencies.txt)",
    ),
    (
        "2.0e6    kbot",
        "bed.txt WtrDpth",
        "input:26:1: OPTIONS, bathymetry: ",
    ),
    (
        "2.0e6    kbot",
        "bed.txt SeafloorFile",
        "input:26:1: OPTIONS, bathymetry: ",
    ),
    (
        "2.0e6    kbot",
        "50 WtrDpth",
        "input:12:35: point 1, Z: z = -100 m lies below the seabed at z = -50 m",
    ),
    (
        "AnchTen1",
        "AnchTen9",
        "input:34:1: OUTPUTS, AnchTen9: no line is called `line9`",
    ),
    (
        "AnchTen1",
        "AnkTen1",
        "input:34:1: OUTPUTS, AnkTen1: unknown output channel `AnkTen1`; known are FairTen1",
    ),
    (
        "L1N10T",
        "L1N21T",
        "input:35:1: OUTPUTS, L1N21T: node 21 of a line of 20 elements",
    ),
    (
        "L1N10T",
        "FairTen1",
        "input:35:1: OUTPUTS, FairTen1: the channel `FairTen1` is given twice",
    ),
    (
        "(-)       (-)        (m)       (-)      (-)       (-)      (-)\n",
        "",
        "input:20:1: LINES: the two lines below a section's header",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- SOLVER CHOICES -----",
        "input:24:1: unknown section \"SOLVER CHOICES\"; known are",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- LINES -----",
        "input:24:1: LINES: a second section LINES",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- FAILURE -----\na b c d\n(-) (-) (-) (-)\n1 2 0 1e5\n----- SOLVER OPTIONS -----",
        "input:27:1: FAILURE: breaks are not read from decks",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- CONTROL -----\na b\n(-) (-)\n1 2\n----- SOLVER OPTIONS -----",
        "input:27:1: CONTROL: lines whose length",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- EXTERNAL LOADS -----\na b\n(-) (-)\n1 2\n----- SOLVER OPTIONS -----",
        "input:27:1: EXTERNAL LOADS: ",
    ),
];

/// Each replacement alone must be refused with a list of mistakes that begins as given.
fn assert_refused(deck: &str, refusals: &[(&str, &str, &str)]) {
    let wrong: Vec<String> = refusals
        .iter()
        .map(|(old, new, begins)| (old, new, begins, said(&with(deck, old, new))))
        .filter(|(_, _, begins, said)| !said.starts_with(*begins))
        .map(|(old, new, begins, said)| format!("{old:?} -> {new:?}\n  {begins}\n  {said}"))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_refusal_names_file_line_and_column_and_what_would_be_right() {
    assert_refused(OPENFAST, REFUSALS);
}

#[test]
fn a_count_of_rows_that_is_wrong_is_refused_as_moordyn_v1_would_lose_some() {
    assert_refused(
        VERSION_1,
        &[
            (
                "2   NLines",
                "1   NLines",
                "input:15:1: LINES: 1 rows are announced, and there are 2",
            ),
            (
                "3   NConnects",
                "x   NConnects",
                "input:8:1: POINTS: expected the number of rows below",
            ),
        ],
    );
}

#[test]
fn bodies_and_rods_that_move_are_refused_with_what_to_do() {
    let refusals = [
        (
            "1    Coupled     0",
            "1    Free     0",
            "input:15:6: body 1: a free body is not modelled",
        ),
        (
            "1    Coupled     0",
            "1    CoupledPinned     0",
            "input:15:6: body 1: a body that is coupled but free to turn",
        ),
        (
            "90      0    0|0|0",
            "90      7e3    0|0|0",
            "input:15:61: body 1: the mass of a coupled body belongs to the host",
        ),
        (
            "0|0|0",
            "0|0",
            "input:15:66: BODIES, row 1, CG: 2 numbers joined by |",
        ),
        (
            "clamp     Fixed",
            "clamp     Free",
            "input:19:16: rod 1: a rod that can move is not modelled",
        ),
        (
            "clamp     Fixed",
            "clamp     Pinned",
            "input:19:16: rod 1: a rod that can move is not modelled",
        ),
        (
            "clamp     Fixed      120   0    -60   118    0    -60   0",
            "clamp     Body1      120   0    -60   118    0    -60   3",
            "input:19:16: rod 1: the weight and drag of a rod",
        ),
        (
            "1    clamp     Fixed",
            "1    cramp     Fixed",
            "input:19:6: rod 1: no rod type is called \"cramp\"",
        ),
        (
            "118    0    -60   0",
            "120    0    -60   0",
            "input:19:44: rod 1: the two ends of the rod are the same point",
        ),
    ];
    assert_refused(C_STYLE, &refusals);
}

#[test]
fn a_wrong_map_deck_is_refused_at_its_place() {
    for (old, new, part) in [
        (
            "1     Fix ",
            "1     Fiks ",
            "NODE PROPERTIES, row 1, Type: expected fix, connect or vessel",
        ),
        (
            "902.2       1         2",
            "902.2       1         7",
            "line 1: no node has the number 7",
        ),
        (
            "tension_fair",
            "OMIT_CONTCAT",
            "unknown flag \"OMIT_CONTCAT\", did you mean OMIT_CONTACT?",
        ),
        (
            "tension_fair",
            "LINEAR_SPRING",
            "a line as a linear spring is not modelled",
        ),
        (
            "tension_fair",
            "DAMAGE_TIME",
            "lines that come off are not modelled",
        ),
        (
            "outer_tol 1e-5",
            "outer_tolerance 1e-5",
            "SOLVER OPTIONS: unknown option \"outer_tolerance\", did you mean OUTER_TOL?",
        ),
        (
            "repeat 120 240",
            "repeat 120 x",
            "repeat: expected a number, found \"x\"",
        ),
        (
            "77.7066",
            "77,7066",
            "MassDenInAir: expected a number [kg/m], found \"77,7066\"",
        ),
        (
            "902.2 ",
            "-902.2 ",
            "line 1, UnstrLen: -902.2 m is not positive",
        ),
    ] {
        let error = load_bytes(with(MAP, old, new).as_bytes(), &deep())
            .unwrap_err()
            .list();
        assert!(error.contains(part), "{old:?} -> {new:?}\n{error}");
    }
}

#[test]
fn mistakes_of_a_stage_are_reported_together_in_the_order_of_the_file() {
    let text = with(OPENFAST, "113.35", "heavy");
    let text = with(&text, "1    fixed", "1    moored");
    let text = with(&text, "2.0e6    kbot", "2.0e6    kbto");
    let said = said(&text);
    let places: Vec<&str> = said
        .lines()
        .map(|line| &line[..line.find(": ").unwrap()])
        .collect();
    assert_eq!(
        places,
        ["input:7:18", "input:12:6", "input:26:10"],
        "{said}"
    );
}

#[test]
fn a_scene_of_moorline_is_still_told_from_a_deck_by_text() {
    let mistake = Scene::from_toml(OPENFAST).unwrap_err();
    assert!(
        mistake.to_string().starts_with("this is a MoorDyn file"),
        "{mistake}"
    );
}

fn moorline(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_moorline"))
        .args(arguments)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        done.status.code().unwrap(),
        text(&done.stdout),
        text(&done.stderr),
    )
}

#[test]
fn the_command_line_converts_a_deck_with_what_its_host_would_give() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("farm.dat"), FARM).unwrap();
    let (code, _, error) = moorline(folder.path(), &["convert", "farm.dat", "-o", "farm.toml"]);
    assert_eq!(code, 2, "{error}");
    let placed = [
        "convert",
        "farm.dat",
        "-o",
        "farm.toml",
        "--at",
        "turbine1=0,0,0",
        "--at",
        "turbine2=1000,0,0",
    ];
    let (code, said, error) = moorline(folder.path(), &placed);
    assert_eq!((code, error.as_str()), (0, ""), "{said}");
    assert!(
        said.starts_with("written to farm.toml\nnote: file"),
        "{said}"
    );
    let (code, _, error) = moorline(folder.path(), &["convert", "farm.toml", "-o", "again.toml"]);
    assert_eq!(code, 2);
    assert!(error.contains("is a scene of moorline already"), "{error}");
}

#[test]
fn a_run_of_a_deck_writes_its_channels_beside_moorlines_columns() {
    let folder = tempfile::tempdir().unwrap();
    let text = with(
        VERSION_1,
        "FairTen2 AnchTen1",
        "FairTen2 AnchTen1 L2N0Px Point2Pz Con3Fx L1NBVz",
    );
    let text = with(&text, "0.02   dtOut", "5.0   dtOut");
    fs::write(folder.path().join("deck.dat"), text).unwrap();
    let (code, _, error) = moorline(folder.path(), &["run", "deck.dat", "-o", "out"]);
    assert_eq!(code, 0, "{error}");
    let mut table = csv::Reader::from_path(folder.path().join("out/results.csv")).unwrap();
    let header: Vec<String> = table
        .headers()
        .unwrap()
        .iter()
        .map(str::to_string)
        .collect();
    let rows: Vec<Vec<f64>> = table.deserialize().map(Result::unwrap).collect();
    let column = |name: &str| {
        let index = header
            .iter()
            .position(|known| known == name)
            .unwrap_or_else(|| panic!("{name}: {header:?}"));
        rows.iter().map(|row| row[index]).collect::<Vec<f64>>()
    };
    assert_eq!(rows.len(), 13);
    assert_eq!(column("FairTen2"), column("line2.tension_b"));
    assert_eq!(column("AnchTen1"), column("line1.tension_a"));
    assert!(column("L2N0Px").iter().all(|x| (x - 60.0).abs() < 40.0));
    assert!(column("Point2Pz").iter().all(|z| *z < 0.0));
    assert!(column("Con3Fx").iter().all(|force| *force > 0.0));
    assert!(column("L1NBVz").iter().all(|speed| speed.abs() < 1e-3));
}

/// A generator of numbers from a seed: Knuth's multiplier and increment of the linear congruential kind, upper bits.
struct Chance(u64);

impl Chance {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % count.max(1)
    }
}

/// Cells of the tables that hold numbers: line of the text and number of the word.
fn number_cells(text: &str) -> Vec<(usize, usize)> {
    let mut cells = Vec::new();
    let mut inside = false;
    for (number, line) in text.lines().enumerate() {
        if line.contains("---") {
            let upper = line.to_uppercase();
            inside = [
                "TYPES",
                "DICTIONARY",
                "POINT",
                "CONNECTION",
                "LINES",
                "LINE PROP",
                "NODE PROP",
            ]
            .iter()
            .any(|word| upper.contains(word));
        } else if inside {
            let words = line.split('#').next().unwrap().split_whitespace();
            let numbers = words
                .enumerate()
                .filter(|(_, word)| word.parse::<f64>().is_ok());
            cells.extend(numbers.map(|(word, _)| (number, word)));
        }
    }
    cells
}

/// The text with one word of one line replaced; an empty word takes the column out.
fn with_word(text: &str, (line, word): (usize, usize), new: &str) -> String {
    let rewritten = text.lines().enumerate().map(|(number, old)| {
        if number != line {
            return old.to_string();
        }
        let before_comment = old.split('#').next().unwrap();
        let mut words: Vec<&str> = before_comment.split_whitespace().collect();
        words[word] = new;
        words.retain(|word| !word.is_empty());
        words.join("  ")
    });
    rewritten.collect::<Vec<_>>().join("\n")
}

/// Mutations that no deck survives.
#[test]
fn two_hundred_broken_decks_are_refused_with_file_and_line() {
    let decks = [OPENFAST, VERSION_1, C_STYLE, FARM, MAP];
    let mut chance = Chance(20_240_229);
    let breaks = ["", "NaN", "1e999", "x", "inf", "--3", "1,5", "0x1"];
    for trial in 0..250 {
        let text = decks[chance.below(decks.len())];
        let cells = number_cells(text);
        let broken = with_word(
            text,
            cells[chance.below(cells.len())],
            breaks[trial % breaks.len()],
        );
        let mut supplement = supplement();
        if text != FARM {
            supplement.positions.clear();
        }
        let error = match load_bytes(broken.as_bytes(), &supplement) {
            Err(error) => error.list(),
            // Words that MAP++ does not use may be anything, and comments behind a row too.
            Ok(_) if text == MAP => continue,
            Ok(_) => panic!("trial {trial} is no mistake:\n{broken}"),
        };
        let place = error.lines().next().unwrap().split("/input:").nth(1);
        let line = place.and_then(|rest| rest.split(':').next()?.parse::<usize>().ok());
        assert!(line.is_some_and(|line| line >= 1), "trial {trial}: {error}");
    }
}

#[test]
fn decks_cut_swapped_and_scrambled_never_panic_and_never_hang() {
    let decks = [OPENFAST, VERSION_1, C_STYLE, FARM, MAP];
    let mut chance = Chance(7);
    let extremes = [
        "1e300",
        "-1e300",
        "-1",
        "0",
        "99",
        "100000",
        "18446744073709551616",
        "1e-300",
        "Free",
        "R1A",
        "Body1",
        "#",
    ];
    for _ in 0..400 {
        let mut bytes = decks[chance.below(decks.len())].as_bytes().to_vec();
        match chance.below(5) {
            0 => bytes.truncate(chance.below(bytes.len())),
            1 => {
                for _ in 0..=chance.below(20) {
                    let at = chance.below(bytes.len());
                    bytes[at] = u8::try_from(chance.below(256)).unwrap();
                }
            }
            2 => {
                let text = String::from_utf8(bytes).unwrap();
                let mut lines: Vec<&str> = text.lines().collect();
                let (a, b) = (chance.below(lines.len()), chance.below(lines.len()));
                lines.swap(a, b);
                bytes = lines.join("\n").into_bytes();
            }
            3 => {
                let text = String::from_utf8(bytes).unwrap();
                let lines: Vec<&str> = text.lines().collect();
                let drop = chance.below(lines.len());
                let kept = lines
                    .iter()
                    .enumerate()
                    .filter(|(number, _)| *number != drop);
                bytes = kept
                    .map(|(_, line)| *line)
                    .collect::<Vec<_>>()
                    .join("\n")
                    .into_bytes();
            }
            _ => {
                let text = String::from_utf8(bytes).unwrap();
                let cells = number_cells(&text);
                let cell = cells[chance.below(cells.len())];
                bytes = with_word(&text, cell, extremes[chance.below(extremes.len())]).into_bytes();
            }
        }
        match load_bytes(&bytes, &supplement()) {
            Ok(loaded) => drop(Model::new(&loaded.scene)),
            Err(error) => assert!(error.list().contains("input"), "{error}"),
        }
    }
}

#[test]
fn files_that_are_nothing_are_refused() {
    for bytes in [
        &b""[..],
        b"\n\n",
        b"\0\x01\x02",
        b"\xff\xfe-\0-\0-\0",
        b"--- LINES ---",
        b"--- POINTS ---\n1 2",
        b"---",
        b"\x89PNG\r\n",
    ] {
        let error = load_bytes(bytes, &Supplement::default())
            .unwrap_err()
            .list();
        assert!(error.contains("input"), "{error}");
    }
    let loops = with(
        OPENFAST,
        "1        chain        1         4",
        "1        chain        1         1",
    );
    assert!(said(&loops).contains("both ends are at `point1`"));
    let loose = with(
        OPENFAST,
        "4    vessel      20.0      0.0     -10.0    0     0    0    0",
        "4 vessel 20 0 -10 0 0 0 0\n9 Free 0 0 -5 1 0 0 0",
    );
    assert!(
        said(&loose).starts_with("input:16:1: point 9: no line ends at this free point"),
        "{}",
        said(&loose)
    );
    let adrift = with(OPENFAST, "4    vessel ", "4    free ");
    let adrift = with(&adrift, "1    fixed ", "1    free ");
    assert!(
        said(&adrift).starts_with("input:21:1: line 1: nothing holds this line"),
        "{}",
        said(&adrift)
    );
}

#[test]
fn a_table_without_end_is_refused_at_once() {
    let rows: String = (10..200_000)
        .map(|id| format!("{id} Fixed 0 0 -50 0 0 0 0\n"))
        .collect();
    let text = with(
        OPENFAST,
        "1    fixed      330.0",
        &format!("{rows}1    fixed      330.0"),
    );
    assert!(said(&text).contains("more than 5000 rows in POINTS"));
}
