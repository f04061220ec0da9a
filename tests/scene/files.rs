//! Files that are not scenes, and files that a scene refers to.

use std::fs;
use std::path::Path;

use crate::common::{assert_says, draft, start};
use moorline::scene::{LoadError, LoadedScene, MotionPath, Note, Scene, load};
use tempfile::tempdir;

use crate::{SCENE, said};

#[test]
fn a_deck_is_refused_as_one() {
    let text = "--------- MoorDyn Input File ---------\nMooring system\n----- LINE TYPES -----\nName Diam\n";
    assert!(said(text).starts_with("1:1: not TOML: rows of dashes head the tables of a deck"));
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
    assert!(matches!(&latin, LoadError::NotText { byte: 15, .. }), "{latin}");
    assert!(
        latin.to_string().contains("byte 15 (line 2, column 4) is 0xFC"),
        "{latin}"
    );
    let binary = refused("binary.toml", b"\x7fELF\x02\x00\x01");
    assert!(matches!(&binary, LoadError::NotText { byte: 5, .. }), "{binary}");
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
        is_folder.to_string().ends_with("is a folder, not a scene file"),
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
    assert_says(
        &list,
        &["scene.toml:34:6: lines[0].to: no point is called `bouy`, did you mean `buoy`?"],
    );
    assert!(error.to_string().ends_with("(and 3 mistakes more)"));
}

/// Loads a scene whose fairlead follows a motion file with these contents.
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
    let cases: [(&[u8], &str); 3] = [
        (b"", "line 1: the header must be \"time,x,y,z\" [s, m]"),
        (
            b"time,x,y,z\n1,0,0,0\n1,0,0,0\n",
            "line 3: time 1 s does not come after 1 s",
        ),
        (b"time,x,y,z\n1,0,0,\xff\n", "line 2 is not UTF-8 text"),
    ];
    for (csv, message) in cases {
        let said = load_with_motion_file(folder.path(), csv).unwrap_err();
        assert_says(&said, &["scene.toml:44:21: motion.fairlead.file: "]);
        assert!(said.contains(message), "{said}\n  wanted: {message}");
    }
    fs::remove_file(folder.path().join("motion.csv")).unwrap();
    let said = load(&folder.path().join("scene.toml")).unwrap_err().list();
    assert!(
        said.ends_with("no such file (a relative path starts at the folder of the file that names it)"),
        "{said}"
    );
}

const WAVES: (&str, &str) = (
    "wave_frequencies.txt",
    "0.0 0.0 0.0\n0.6 0.0 1.2\n0.9 0.4 0.0 0.5\n",
);
const CURRENT: (&str, &str) = (
    "current_profile.txt",
    "--- steady currents ---\nprofile\nz ux uy uz\n-80.0 0.1 0.0 0\n0.0 0.7 0.2 0\n",
);

/// Writes a scene and its files to a folder and loads it.
fn written(folder: &Path, text: &str, files: &[(&str, &str)]) -> Result<LoadedScene, LoadError> {
    for (name, text) in files.iter().chain(&[("scene.toml", text)]) {
        fs::write(folder.join(name), text).unwrap();
    }
    load(&folder.join("scene.toml"))
}

#[test]
fn a_scene_names_files_of_waves_and_current_as_a_deck_does() {
    let folder = tempdir().unwrap();
    let text = draft(
        "water = { density = 1025.0, current = { file = 'current_profile.txt' }, waves = { file = 'wave_frequencies.txt' } }
        seabed = { depth = 100.0 }
        line_types.chain = { mass = 120.0, diameter = 0.12, axial_stiffness = 2e8, drag_normal = 1.6 }",
    )
    .fixed("anchor", [-260.0, 0.0, -100.0])
    .coupled("left", [0.0, 15.0, -10.0])
    .line("chain", ["anchor", "left"], "chain", 290.0, 24)
    .text();
    let scene = written(folder.path(), &text, &[WAVES, CURRENT]).unwrap().scene;
    let current = scene.water.as_ref().unwrap().current.as_ref().unwrap();
    assert_eq!(current.profile.as_ref().unwrap().len(), 2);
    assert_eq!(
        start(&scene).model().waves.as_ref().unwrap().components().len(),
        2
    );
    fs::remove_file(folder.path().join(WAVES.0)).unwrap();
    let refusal = format!("{:?}", written(folder.path(), &text, &[]).unwrap_err());
    assert_says(&refusal, &["no such file"]);
}

#[test]
fn soundings_above_the_water_are_refused_by_file_and_place() {
    let folder = tempdir().unwrap();
    let text = SCENE.replace("depth = 50.0", "depth = 50.0\nfile = \"seabed.csv\"");
    fs::write(folder.path().join("scene.toml"), text).unwrap();
    let load = |soundings: &str| {
        fs::write(folder.path().join("seabed.csv"), soundings).unwrap();
        load(&folder.path().join("scene.toml"))
    };
    let error = load("y/x, 0, 200\n0, -50, -60\n").unwrap_err().list();
    let said = "scene.toml:9:8: seabed.file: ";
    let place = "seabed.csv: the depth at x = 0 m, y = 0 m is -50 m, above the water: depths count downwards";
    assert_says(&error, &[said, place]);
    assert!(load("y/x, 0, 200\n0, 50, 60\n").is_ok());
    let error = load("x/y, 0, 200\n0, 50, 60\n").unwrap_err().list();
    assert_says(&error, &["line 1: \"x/y\" has x downwards"]);
}

/// Loads the scene with the current of a file that has these lines.
fn load_with_current(lines: &str) -> Result<LoadedScene, LoadError> {
    let folder = tempdir().unwrap();
    let current = "density = 1025.0\ncurrent = { file = \"current.txt\" }";
    let text = SCENE.replace("density = 1025.0", current);
    fs::write(folder.path().join("scene.toml"), text).unwrap();
    fs::write(folder.path().join("current.txt"), lines).unwrap();
    load(&folder.path().join("scene.toml"))
}

#[test]
fn a_row_of_a_current_among_its_headings_is_refused() {
    let lines = "current\n(m) (m/s) (m/s) (m/s)\n0 0.5 0 0\n-50 0.1 0 0\n";
    let error = load_with_current(lines).unwrap_err().list();
    assert_says(
        &error,
        &["line 3: this row of numbers is among the three lines of headings"],
    );
}

#[test]
fn a_note_on_what_stands_in_a_file_names_the_key_of_the_file() {
    let loaded = load_with_current("a\nb\n(m) (m/s) (m/s) (m/s)\n0 0.5 0 0\n-50 50 0 0\n").unwrap();
    let note = loaded
        .notes
        .iter()
        .find(|note| note.text.contains("50 m/s is unusual"));
    let note = note.unwrap_or_else(|| panic!("{:?}", loaded.notes));
    assert_eq!((note.at.as_str(), note.line), ("water.current.file", Some(6)));
    let left = loaded.locate_note(Note::new("water.current.profile", "left"));
    assert_eq!(left.at, "water.current.file");
    let elsewhere = loaded.locate_note(Note::new("seabed.grid", "left"));
    assert_eq!(elsewhere.at, "seabed.grid");
}

#[test]
fn a_scene_without_lines_is_refused() {
    assert_eq!(
        said(""),
        "1:1: lines: no line: a scene needs at least one `[[lines]]`\n"
    );
}
