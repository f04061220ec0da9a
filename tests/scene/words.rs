//! The scenes of the repository, and the description of a valid scene.

use std::fs;
use std::path::Path;

use moorline::scene::{LineEnd, Scene};

use crate::SCENE;
use crate::common::{assert_says, assert_written_and_read, draft, in_words};

/// Text and name of every scene of the repository.
fn repository_scenes() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut scenes: Vec<(String, String)> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
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
        assert_written_and_read(&scene);
    }
}

#[test]
fn words_say_what_is_modelled_and_what_is_not() {
    let words = in_words(&Scene::from_toml(SCENE).unwrap());
    // (100 − 1025·π/4·0.1²)·9.81 = 902.03 N/m
    let weight = "weight 902.03 N/m in water";
    let drag = "normal drag coefficient 1.2,";
    let absent = "no tangential drag, no normal added mass, no tangential added mass";
    assert_says(&words, &["still water, 1025 kg/m³", weight, drag, absent]);
    let dry = SCENE
        .replace("[water]\ndensity = 1025.0\n", "")
        .replace("[seabed]\ndepth = 50.0\n", "");
    let scene = Scene::from_toml(&dry).unwrap();
    let words = in_words(&scene);
    assert_says(&words, &["no water", "weight 981 N/m in air"]);
    let absent = words.split("not modelled").nth(1).unwrap();
    assert_says(
        absent,
        &["buoyancy, drag and added mass", "contact with a seabed"],
    );
    let notes = scene
        .notes()
        .iter()
        .map(|note| format!("{note}\n"))
        .collect::<String>();
    assert_says(
        &notes,
        &["line_types.chain: without [water], `drag_normal` changes nothing\n"],
    );
}

#[test]
fn beams_among_cables_are_described_as_modelled() {
    let beam = "\n[line_types.rod]\nmodel = \"beam\"\nmass = 10.0\ndiameter = 0.1\naxial_stiffness = 1.0e7\nshear_stiffness = 1.0e6\n\
                bending_stiffness = 1.0e4\ntorsional_stiffness = 1.0e4\nrotary_inertia = 0.1\n\n[[points]]\nname = \"foot\"\n\
                position = [0.0, 5.0, -50.0]\nkind = \"fixed\"\n\n[[points]]\nname = \"head\"\nposition = [0.0, 5.0, -10.0]\nkind = \"fixed\"\n\n\
                [[lines]]\nname = \"riser\"\nfrom = \"foot\"\nto = \"head\"\nsections = [{ type = \"rod\", length = 40.0 }]\n";
    let words = in_words(&Scene::from_toml(&format!("{SCENE}{beam}")).unwrap());
    assert_says(
        &words,
        &[
            "lines carry no compression: the tension of a slack line is zero, except for beams",
            "bending, torsion and shear of lines other than beams",
        ],
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
    let notes: String = scene.notes().iter().map(|note| format!("\n{note}")).collect();
    let strained = "it is 40 m long unstretched: it is strained by at least 114 %";
    assert_says(
        &notes,
        &[
            "\nline_types.spare: no line uses this line type",
            &format!("\nlines[0]: its ends are 85.44003745317531 m apart, and {strained}"),
            "\npoints[2].position: above z = 0",
            "\noutput.interval: the duration of 60 s is not a whole number of intervals",
        ],
    );
}

#[test]
fn the_stiffness_on_a_vessel_is_noted_where_a_line_may_come_off() {
    let vessel = "\n[[vessels]]\nname = \"ship\"\nposition = [0.0, 0.0, 0.0]\n";
    let mut scene = Scene::from_toml(&format!("{SCENE}{vessel}")).unwrap();
    scene.output.stiffness = true;
    let is_noted = |scene: &Scene| scene.notes().iter().any(|note| note.at == "output.stiffness");
    assert!(!is_noted(&scene));
    scene.lines[0].release = Some(LineEnd::B);
    assert!(is_noted(&scene));
}

#[test]
fn a_flow_from_the_host_is_described_and_noted_where_no_host_gives_it_or_it_acts_on_nothing() {
    let hosted = |text: &str| {
        let text = text.replace("density = 1025.0", "density = 1025.0\nflow = \"host\"");
        Scene::from_toml(&text).unwrap()
    };
    let scene = hosted(SCENE);
    let words = in_words(&scene);
    assert_says(
        &words,
        &["its velocity and acceleration at the nodes are inputs of the host"],
    );
    assert!(
        !words.contains("still water") && !words.contains("in addition to the current"),
        "{words}"
    );
    let remark = scene.without_host().unwrap().to_string();
    assert!(
        remark.starts_with("water.flow: no host gives the flow in this run"),
        "{remark}"
    );
    assert!(scene.notes().iter().all(|note| note.at != "water"));
    let thin = SCENE
        .replace("mass = 100.0\ndiameter = 0.1\n", "weight = 900.0\n")
        .replace("drag_normal = 1.2\n", "")
        .replace("[seabed]\ndepth = 50.0\n", "");
    let notes: String = hosted(&thin).notes().iter().map(ToString::to_string).collect();
    assert_says(
        &notes,
        &["water: no line has a `diameter` and no point a `volume` or `drag_area`: `flow` changes nothing"],
    );
}

#[test]
fn rows_that_look_written_twice_or_closed_by_mistake_are_noted() {
    let rope = "line_types.rope = { mass = 1.0, axial_stiffness = 1e4 }";
    let ends = draft(rope)
        .fixed("a", [0.0; 3])
        .fixed("A", [9.0, 0.0, 0.0])
        .fixed("c", [9.0, 0.0, 1e-9]);
    let lines = ends
        .line("one", ["a", "A"], "rope", 10.0, 4)
        .line("two", ["a", "c"], "rope", 10.0, 4)
        .line("longer", ["a", "c"], "rope", 11.0, 4)
        .line("loop", ["A", "c"], "rope", 10.0, 4);
    let notes = lines.scene().notes();
    let notes: Vec<String> = notes.iter().map(ToString::to_string).collect();
    let wanted = [
        "lines[3]: both ends are at the same place: the line hangs in a loop",
        "points[1].name: \"A\" and \"a\" differ only in case",
        "lines[1]: same ends and sections as one: their forces add up",
    ];
    for part in wanted {
        assert_eq!(
            notes.iter().filter(|note| *note == part).count(),
            1,
            "{part}: {notes:?}"
        );
    }
    assert!(
        !notes.iter().any(|note| note.starts_with("lines[2]")),
        "{notes:?}"
    );
}

#[test]
fn a_motion_is_described_with_its_rotations_whatever_it_is_made_of() {
    let with = |motion: &str| {
        let rope = "line_types.rope = { mass = 1.0, axial_stiffness = 1e4 }\nvessels = [{ name = 'ship' }]";
        let ends = draft(format!(
            "{rope}\nmotion.ship = {motion}\noutput = {{ duration = 1.0, interval = 0.1 }}"
        ));
        let ends = ends
            .fixed("a", [0.0; 3])
            .coupled("b", [9.0, 0.0, 0.0])
            .with("on = 'ship'");
        in_words(&ends.line("l", ["a", "b"], "rope", 10.0, None).scene())
    };
    for (motion, said) in [
        (
            "{ pitch = [[0.05, 10.0]] }",
            "it oscillates by 0.05 rad every 10 s in pitch",
        ),
        (
            "{ x = [[2.5, 12.0]], pitch = [[0.05, 10.0]] }",
            "it oscillates by 2.5 m every 12 s in x, 0.05 rad every 10 s in pitch",
        ),
        (
            "{ table = [[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0]] }",
            "it follows a table of 2 rows: pitch from 0 to 0.1 rad",
        ),
    ] {
        let words = with(motion);
        assert_says(&words, &[said]);
        assert!(!words.contains("stays at rest"), "{words}");
    }
}
