//! Scenes read from decks.

use std::fs;

use moorline::scene::{Drive, InitialShape, LoadedScene, PointKind, Scene, TimeFunction};

use crate::*;

/// The expected scenes are in `tests/decks/converted`; `MOORLINE_UPDATE=1` writes them again.
#[test]
fn a_deck_is_converted_to_the_scene_that_is_kept_with_units_and_lines_and_rests_the_same_to_the_last_bit() {
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
        let loaded = load_with(&deck(name), &supplement).unwrap_or_else(|error| panic!("{}", error.list()));
        let text = loaded.to_commented_toml();
        let kept = deck("converted").join(name).with_extension("toml");
        if std::env::var_os("MOORLINE_UPDATE").is_some() {
            fs::write(&kept, &text).unwrap();
        }
        assert_eq!(text, fs::read_to_string(&kept).unwrap(), "{name}");
        let back = Scene::from_toml(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(back, loaded.scene, "{name}");
        if name != "moordyn_c.txt" {
            // the cable in this deck has bending stiffness, which has its own tests
            let [first, second] = [&loaded.scene, &back].map(|scene| Simulation::new(scene).unwrap());
            assert_eq!(first.snapshot(), second.snapshot(), "{name}");
        }
    }
}

#[test]
fn a_diameter_that_is_too_large_or_too_small_for_the_mass_is_noted_and_that_of_oc3_is_not() {
    let of = |wire: &str| {
        let deck = with(OPENFAST, "0.09     77.7 ", wire);
        let said = notes(&load_text(&deck).unwrap());
        let line = |note: &&str| note.starts_with("file line 8, line type wire, Diam: ");
        said.lines().filter(line).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(of("0.09     77.7 "), "");
    let light = "give a density of 12.214 kg/m³: 200 to 12 000 kg/m³ is usual, with the diameter in m";
    assert!(of("0.09  0.0777  ").contains(light), "{}", of("0.09  0.0777  "));
    assert!(of("90.0     77.7 ").contains("with the diameter in m"));
    assert!(of("0.009    77.7 ").contains("more than steel"));
    let map = with(MAP, "77.7066 ", "0.077707");
    let said = notes(&load_deep(&map).unwrap());
    assert_says(&said, &["line type Material, Diam: a mass of 0.07771 kg/m"]);
}

#[test]
fn the_words_for_a_deck_tell_of_its_vessel_and_of_where_points_are_on_it() {
    let words = in_words(&read("moordyn_c.txt").scene);
    assert_says(
        &words,
        &["body1: driven by the host, origin at (0, 0, -20) m, roll 0 rad, pitch 0 rad, yaw 1.5708 rad"],
    );
    assert_says(&words, &["carries point7; in `run` it stays at rest"]);
    assert_says(
        &words,
        &["point7: carried by body1, at (5, 0, 15) m in the frame of the vessel"],
    );
    // Relative to its body the point is above z = 0, but the body is deep below the surface, and rotated.
    assert!(!notes(&read("moordyn_c.txt")).contains("above z = 0"));
    assert_says(
        &words,
        &["line1: from rod1a to point7, 160 m of cable in 16 elements; 27.902 m longer"],
    );
}

#[test]
fn the_two_versions_of_a_deck_are_the_same_scene() {
    let one = read("moordyn_v1.dat");
    let two = read("moordyn_v2_same.dat");
    assert_eq!((one.format, two.format), ("MoorDyn v1", "MoorDyn v2"));
    assert_eq!(one.scene, two.scene);
}

#[test]
fn a_line_is_clamped_as_it_runs_along_or_against_its_rod() {
    let direction = |end: &str, line: &str| {
        let deck = with(C_STYLE, "118    0    -60   0 ", "118    0    -60   4 ");
        let deck = with(&deck, "cable      R1A      7  ", line);
        let scene = loaded(&deck).scene;
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
    let scene = loaded(&deck).scene;
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
    let scene = loaded(&deck).scene;
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
    assert_says(&said, &["\ninput:11:6: Turbine2: ", "--at turbine1=X,Y,Z"]);
    let mut wrong = supplement();
    wrong.positions.insert("turbine3".into(), [0.0; 3]);
    let error = load_with(&deck("farm.dat"), &wrong).unwrap_err();
    assert_says(&error.list(), &["a position is given for `turbine3`"]);
}

/// Source: MAP++ summary of OC3 Hywind in the regression tests of OpenFAST: fairlead tension 911 089.46 N with friction 0.001.
#[test]
fn a_map_deck_repeats_its_lines_and_has_the_published_tension_of_oc3() {
    let error = load(&deck("oc3.map")).unwrap_err().list();
    assert_says(&error, &["oc3.map:8:32: NODE PROPERTIES, Z: "]);
    let loaded = load_with(&deck("oc3.map"), &deep()).unwrap();
    let simulation = Simulation::new(&loaded.scene).unwrap();
    for line in 0..3 {
        let tension = simulation.catenary(line).unwrap().tension_b();
        assert!((tension / 911_089.46 - 1.0).abs() < 1e-5, "{tension}");
    }
}

/// Source: `expand_node_position_z` in mapinit.c of MAP++: x' = x cos + y sin.
#[test]
fn a_map_deck_is_repeated_from_y_to_x() {
    let scene = load_deep(&with(MAP, "repeat 120 240", "repeat 90"))
        .unwrap()
        .scene;
    let [x, y, _] = point(&scene, "point4").position;
    assert!(x.abs() < 1e-12 && y == -5.2, "{x} {y}");
}

#[test]
fn a_map_line_whose_anchor_is_above_the_seabed_is_noted() {
    let named = |deck: &str| {
        let loaded = load_deep(deck).unwrap_or_else(|error| panic!("{}", error.list()));
        let level = |note: &&moorline::scene::Note| note.text.contains("the level of its NodeAnch");
        loaded.notes.iter().filter(level).count()
    };
    let anchor = MAP.lines().find(|row| row.contains("depth")).unwrap();
    assert_eq!(
        [
            named(MAP),
            named(&with(MAP, anchor, &anchor.replace("depth", "-250")))
        ],
        [0, 1]
    );
}

#[test]
fn a_map_node_whose_number_is_not_that_of_its_row_is_noted() {
    let noted = |deck: &str| notes(&load_deep(deck).unwrap()).contains("numbers of rows");
    let swapped = with(MAP, "1     Fix", "2     Fix").replace("2     Vessel", "1     Vessel");
    assert_eq!([noted(MAP), noted(&swapped)], [false, true]);
}

#[test]
fn a_map_deck_that_is_repeated_by_an_angle_twice_is_noted() {
    for (angles, twins) in [
        ("repeat 120 240", 0),
        ("repeat 120 120", 1),
        ("repeat 0", 1),
        ("repeat 360", 1),
    ] {
        let loaded = load_deep(&with(MAP, "repeat 120 240", angles)).unwrap();
        let alike = |note: &&moorline::scene::Note| note.text.contains("same ends and sections as");
        assert_eq!(loaded.notes.iter().filter(alike).count(), twins, "{angles}");
    }
}

#[test]
fn the_words_for_a_map_deck_say_that_it_is_quasi_static() {
    assert_says(
        &load_deep(MAP).unwrap().scene.in_words(),
        &["quasi-static: an equilibrium"],
    );
}

#[test]
fn a_nodes_mass_volume_and_force_in_a_map_deck_reach_the_scene() {
    let deck = with(
        MAP,
        "2     Vessel    5.2     0.0    -70.0     0     0        #     #     #",
        "2 Vessel 5.2 0 -70 0 0 # # #\n3 connect #400 #0 #-200 1000 2 0 0 -5e3",
    );
    let deck = with(&deck, "902.2       1         2 ", "600 1 3\n2 Material 350 3 2 ");
    let deck = with(&deck, "repeat 120 240\n", "");
    let scene = load_deep(&deck).unwrap_or_else(|e| panic!("{}", e.list())).scene;
    let node = point(&scene, "point3");
    assert_eq!(
        (node.kind, node.position),
        (PointKind::Free, [400.0, 0.0, -200.0])
    );
    assert_eq!((node.mass, node.volume), (Some(1000.0), Some(2.0)));
    assert_eq!(node.force.as_ref().unwrap().z, Some(TimeFunction::Constant(-5e3)));
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
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/demo.toml")).unwrap();
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
        assert_eq!(load_bytes(bytes, &Supplement::default()).unwrap().scene, plain);
    }
}

#[test]
fn mass_of_a_coupled_point_in_a_deck_reaches_the_force_on_what_moves_it() {
    let text = with(
        C_STYLE,
        "2     Coupled   -30.0   0.0     -8.0    0      0 ",
        "2     Coupled   -30.0   0.0     -8.0   9000   0.9",
    );
    let text = with(&text, "5.0     0.0     15.0    0      0 ", "5.0 0.0 15.0 400 0.1");
    let text = with(
        &text,
        "3     Fixed     -120.0  0.0     -60.0   0      0 ",
        "3 Fixed -120 0 -60 700 0",
    );
    let (light, heavy) = (loaded(C_STYLE), loaded(&text));
    let coupled = point(&heavy.scene, "point2");
    assert_eq!((coupled.mass, coupled.volume), (Some(9000.0), Some(0.9)));
    assert_eq!(point(&heavy.scene, "point7").mass, Some(400.0));
    assert_eq!(point(&heavy.scene, "point3").mass, None);
    let said = notes(&heavy);
    assert_says(&said, &["point 3: mass, volume and drag of a fixed point"]);
    assert!(!said.contains("point 2: mass"), "{said}");
    let force = |loaded: &LoadedScene| {
        let simulation = Simulation::new(&loaded.scene).unwrap();
        let index = simulation.model().point_index("point2").unwrap();
        simulation.end_force(index)[2]
    };
    let own = force(&heavy) - force(&light);
    assert!((own + (9000.0 - 1028.0 * 0.9) * 9.81).abs() < 1e-6, "{own} N");
    let words = in_words(&heavy.scene);
    assert_says(
        &words,
        &["act on the driving body in addition to those of the lines"],
    );
}

#[test]
fn a_deck_that_gives_no_time_to_come_to_rest_starts_from_its_positions() {
    let buoy = "ID      LineType   UnstrLen";
    let free =
        "7 free 150 0 -60 500 0.2 0 0\n---------------------- LINES --------------------------------------\n";
    let text = with(
        OPENFAST,
        "---------------------- LINES --------------------------------------\n",
        free,
    );
    assert_says(&text, &[buoy]);
    let text = with(
        &text,
        "1        chain        1         4      340.0 ",
        "1 chain 1 7 195",
    );
    let text = with(
        &text,
        "2        chain        2 ",
        "4 chain 7 4 150 10 -\n2 chain 2 ",
    );
    let text = with(&text, "L1N10T", "L1N9T");
    let at_once = loaded(&with(&text, "60.0     TmaxIC", "0 TmaxIC"));
    let rested = loaded(&text);
    let start = |loaded: &LoadedScene| {
        let simulation = Simulation::new(&loaded.scene).unwrap();
        let index = simulation.model().point_index("point7").unwrap();
        let place: [f64; 3] = simulation.state().points[index].position.into();
        (place, simulation)
    };
    assert_ne!(start(&rested).0, [150.0, 0.0, -60.0]);
    let (place, simulation) = start(&at_once);
    assert_eq!(place, [150.0, 0.0, -60.0]);
    let lines = &at_once.scene.lines;
    assert!(lines.iter().all(|line| line.initial == InitialShape::Catenary));
    // a line between fixed or coupled points lies on its closed-form catenary
    let line = simulation.model().line_index("line2").unwrap();
    let catenary = simulation.catenary(line).unwrap();
    for node in simulation.profile(line) {
        let z = -100.0 + catenary.at(node.s).z;
        assert!((node.z - z).abs() < 1e-9, "{} {z}", node.z);
    }
    let said = notes(&at_once);
    assert_says(
        &said,
        &["TmaxIC 0: runs start with free points where the file has them"],
    );
    assert!(!said.contains("dtIC, TmaxIC"), "{said}");
    let words = in_words(&at_once.scene);
    assert_says(&words, &["starts on the catenary between its ends"]);
    let converted = Scene::from_toml(&at_once.to_commented_toml()).unwrap();
    assert_eq!(converted, at_once.scene);
}

type Matrix = [[f64; 3]; 3];

fn product(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Rotation matrices of roll, pitch and yaw [rad] about x, y and z.
fn elementary([roll, pitch, yaw]: [f64; 3]) -> [Matrix; 3] {
    let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
    [
        [[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]],
        [[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]],
        [[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]],
    ]
}

#[test]
fn the_motion_of_a_decks_vessel_turns_it_as_moordyn_does_and_an_fmu_as_it_says() {
    let turned = with(
        C_STYLE,
        "1    Coupled     0      0    -20     0       0      90 ",
        "1    Coupled     0      0    -20     10     -20     90 ",
    );
    let reference = [10.0, -20.0, 90.0].map(f64::to_radians);
    let motion = [20.0, -30.0, 40.0].map(f64::to_radians);
    let arm = [5.0, 0.0, 15.0];
    let placed = |turn: Matrix| -> [f64; 3] {
        let at = [2.0, 0.0, -20.0];
        std::array::from_fn(|i| at[i] + (0..3).map(|k| turn[i][k] * arm[k]).sum::<f64>())
    };
    let [x, y, z] = elementary(std::array::from_fn(|i| reference[i] + motion[i]));
    let expected = placed(product(x, product(y, z)));
    let mut loaded = loaded(&turned);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("motion.csv");
    let [roll, pitch, yaw] = motion;
    let named = "time,body1.x,body1.roll,body1.pitch,body1.yaw\n";
    let row = |t: u8| format!("{t},2,{roll},{pitch},{yaw}\n");
    fs::write(&file, format!("{named}{}{}", row(0), row(9))).unwrap();
    let drive = Drive {
        file: Some(file),
        ..Drive::default()
    };
    loaded.scene.drive(&drive).unwrap();
    for line in &mut loaded.scene.lines {
        line.initial = InitialShape::Straight; // the position of the body does not depend on an equilibrium
    }
    let mut simulation = Simulation::new(&loaded.scene).unwrap();
    let index = simulation.model().point_index("point7").unwrap();
    let near = |simulation: &Simulation, wanted: [f64; 3]| {
        let place = simulation.state().points[index].position;
        for axis in 0..3 {
            assert!((place[axis] - wanted[axis]).abs() < 1e-9, "{place} {wanted:?}");
        }
    };
    simulation.follow_scene().unwrap();
    near(&simulation, expected);
    simulation.advance(0.1).unwrap();
    near(&simulation, expected);
    // the moment is that of the force at this position
    let force = simulation.end_force(index);
    let [_, _, _, mx, ..] = simulation.vessel_force(0);
    let origin = [2.0, 0.0, -20.0];
    let moment = (expected[1] - origin[1]) * force[2] - (expected[2] - origin[2]) * force[1];
    assert!(
        (mx - moment).abs() < 1e-6 * moment.abs().max(1.0),
        "{mx} {moment}"
    );
    // a host that gives the same attitude in the FMU's order
    let mut host = Simulation::new(&loaded.scene).unwrap();
    for moving in host.model().moving(0.0) {
        host.set_body(moving.body, moving.pose, [None; 6]);
    }
    host.restart(0.0).unwrap();
    near(&host, expected);
    let attitude = loaded.scene.vessels[0].attitude;
    host.set_pose(0, [2.0, 0.0, 0.0, roll, pitch, yaw]);
    host.restart(0.0).unwrap();
    let [x, y, z] = elementary(std::array::from_fn(|i| attitude[i] + motion[i]));
    near(&host, placed(product(z, product(y, x))));
}

#[test]
fn the_words_for_a_deck_name_both_orders_of_angles() {
    let words = in_words(&loaded(C_STYLE).scene);
    assert_says(
        &words,
        &[
            "Rx(roll)·Ry(pitch)·Rz(yaw), as in MoorDyn",
            "of the FMU of Rz(yaw)·Ry(pitch)·Rx(roll)",
        ],
    );
}
