//! The scenes of the repository, and what is said about a scene that is right.

use std::fs;
use std::path::Path;

use moorline::scene::Scene;

use crate::SCENE;

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
        let written = scene.to_toml();
        assert_eq!(Scene::from_toml(&written).unwrap(), scene, "{name}\n{written}");
    }
}

#[test]
fn words_say_what_is_modelled_and_what_is_not() {
    let words = Scene::from_toml(SCENE).unwrap().in_words();
    assert!(words.contains("still water of 1025 kg/m³"));
    // (100 − 1025·π/4·0.1²)·9.81 = 902.03 N/m
    assert!(words.contains("weight 902.03 N/m in water"), "{words}");
    let flat = words.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("normal drag coefficient 1.2,")
            && flat.contains("no tangential drag, no normal added mass, no tangential added mass"),
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
    assert!(absent.contains("contact with a\n      seabed") || absent.contains("contact with a seabed"));
    let notes = scene.notes();
    let note = notes
        .iter()
        .find(|note| note.text.contains("without [water]"))
        .unwrap();
    assert_eq!(
        note.to_string(),
        "line_types.chain: without [water], `drag_normal` changes nothing"
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

#[test]
fn a_motion_is_described_with_its_rotations_whatever_it_is_made_of() {
    let with = |motion: &str| {
        let text = format!(
            "[line_types.rope]\nmass = 1.0\naxial_stiffness = 1e4\n\
             [[vessels]]\nname = \"ship\"\n\
             [[points]]\nname = \"a\"\nposition = [0.0, 0.0, 0.0]\nkind = \"fixed\"\n\
             [[points]]\nname = \"b\"\nposition = [9.0, 0.0, 0.0]\nkind = \"coupled\"\non = \"ship\"\n\
             [[lines]]\nname = \"l\"\nfrom = \"a\"\nto = \"b\"\nsections = [{{ type = \"rope\", length = 10.0 }}]\n\
             [motion]\nship = {motion}\n[output]\nduration = 1.0\ninterval = 0.1\n"
        );
        let words = Scene::from_toml(&text).unwrap().in_words();
        words.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for (motion, said) in [
        (
            "{ pitch = [[0.05, 10.0]] }",
            "it swings by 0.05 rad every 10 s in pitch",
        ),
        (
            "{ x = [[2.5, 12.0]], pitch = [[0.05, 10.0]] }",
            "it swings by 2.5 m every 12 s along x and 0.05 rad every 10 s in pitch",
        ),
        (
            "{ table = [[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0]] }",
            "it follows a table of 2 rows: pitch from 0 to 0.1 rad",
        ),
    ] {
        let words = with(motion);
        assert!(words.contains(said), "{said}\n{words}");
        assert!(!words.contains("stays where it is"), "{words}");
    }
}
