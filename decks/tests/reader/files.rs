//! Decks and scenes that refer to other files: waves, currents, soundings of the seabed, tension tables.
//!
//! claim: the contents of a file are in the scene, the converted scene is the same, and mistakes are refused with file and line.

use std::f64::consts::PI;

use approx::assert_relative_eq;
use moorline::scene::{AngleOrder, Drive, MotionPath, Note};
use nalgebra::Vector3;
use tempfile::tempdir;

use crate::*;

/// Writes a file and the files that it refers to into a folder, and loads it.
fn with_files(folder: &Path, text: &str, files: &[(&str, &str)]) -> Result<LoadedScene, LoadError> {
    for (name, text) in files.iter().chain(&[("mooring.dat", text)]) {
        fs::write(folder.join(name), text).unwrap();
    }
    load(&folder.join("mooring.dat"))
}

/// Asserts that a loaded scene is converted to the same scene.
fn assert_converted(loaded: &LoadedScene) {
    let text = loaded.to_commented_toml();
    assert_eq!(Scene::from_toml(&text).unwrap(), loaded.scene, "{text}");
}

/// A MoorDyn deck of a buoyed line with waves and a current.
fn in_waves() -> String {
    VERSION_1.replace("80     WtrDpth", "80     WtrDpth\n7  WaveKin\n1  Currents")
}

const WAVES: (&str, &str) = (
    "wave_frequencies.txt",
    "0.0 0.0 0.0\n0.6 0.0 1.2\n0.9 0.4 0.0 0.5\n",
);
const CURRENT: (&str, &str) = (
    "current_profile.txt",
    "--- steady currents ---\nprofile\nz ux uy uz\n-80.0 0.1 0.0 0\n0.0 0.7 0.2 0\n",
);

#[test]
fn a_deck_of_moordyn_brings_its_waves_and_current_from_files() {
    let folder = tempdir().unwrap();
    let loaded = with_files(folder.path(), &in_waves(), &[WAVES, CURRENT]).unwrap();
    let current = loaded.scene.water.as_ref().unwrap().current.as_ref().unwrap();
    assert_eq!(current.profile, Some(vec![[-80.0, 0.1, 0.0], [0.0, 0.7, 0.2]]));
    let mut simulation = Simulation::new(&loaded.scene).unwrap();
    let waves = simulation.model().waves.clone().unwrap();
    for t in [0.0, 2.0, 31.0] {
        // MoorDyn's elevation: Σ |A| sin(ωt + arg A) at the origin
        let expected = 1.2 * (0.6 * t + 0.5 * PI).sin() + 0.4 * (0.9_f64 * t).sin();
        assert_relative_eq!(waves.elevation(0.0, 0.0, t), expected, epsilon = 1e-12);
    }
    simulation.advance(0.1).unwrap();
    assert_converted(&loaded);
    assert!(loaded.notes.iter().any(|note| note.text.contains(WAVES.0)));
    let left = loaded.locate_note(Note::new("water.current.profile", "left"));
    assert_eq!(left.to_string(), "file line 24, OPTIONS, Currents: left");
}

#[test]
fn a_deck_whose_files_are_wrong_is_refused_with_file_and_line() {
    let folder = tempdir().unwrap();
    let files = [(WAVES.0, "0.6 0.0\n"), CURRENT];
    let refusal = format!(
        "{:?}",
        with_files(folder.path(), &in_waves(), &files).unwrap_err()
    );
    assert_says(
        &refusal,
        &["wave_frequencies.txt, line 1: expected 3 or 4 numbers"],
    );
}

#[test]
fn a_deck_with_bathymetry_and_friction_is_read_and_converted_with_them() {
    let folder = tempdir().unwrap();
    let soundings = "--- MoorPy Bathymetry Input File v1.0 ---\nnGridX 2\nnGridY 2\n-900 900\n-900 100 110\n900 100 110\n";
    let options = "seabed.txt WtrDpth\n0.7 mu_kT\n0.3 mu_kA\n200 FricDamp\n1.5 StatDynFricScale";
    let deck = OPENFAST.replace("2.0e6    kbot", options);
    let loaded = with_files(folder.path(), &deck, &[("seabed.txt", soundings)]).unwrap();
    let seabed = loaded.scene.seabed.as_ref().unwrap();
    assert_eq!((seabed.friction.transverse, seabed.friction.axial), (0.7, 0.3));
    assert_eq!(
        seabed.grid.as_ref().unwrap().depth,
        [[100.0, 110.0], [100.0, 110.0]]
    );
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    let notes = notes.join("\n");
    let scale = "static friction of 1.5 times the kinetic is not modelled";
    assert_says(&notes, &[scale, "here friction holds up to its limit"]);
    assert_converted(&loaded);
}

#[test]
fn a_seafloor_file_of_moordyn_c_is_read_as_heights_of_the_seabed() {
    let folder = tempdir().unwrap();
    let deck = OPENFAST.replace("2.0e6    kbot", "110 WtrDpth\nseabed.txt SeafloorFile");
    let axes = "2 2\n-900 900\n-900 900\n-900 -900 -100\n";
    let heights = format!("{axes}-900 900 -100\n900 -900 -110\n900 900 -110\n");
    let found = with_files(folder.path(), &deck, &[("seabed.txt", &heights)]);
    let grid = found
        .unwrap_or_else(|error| panic!("{}", error.list()))
        .scene
        .seabed
        .unwrap()
        .grid
        .unwrap();
    assert_eq!((grid.x, grid.y), (vec![-900.0, 900.0], vec![-900.0, 900.0]));
    assert_eq!(grid.depth, [[100.0, 110.0], [100.0, 110.0]]);
    for (anchors, depth) in [("-100.0 ", 100.0), ("0.0 ", 110.0)] {
        let deck = deck.replace("110 WtrDpth\n", "").replace("-100.0 ", anchors);
        let found = with_files(folder.path(), &deck, &[("seabed.txt", &heights)]).unwrap();
        assert_eq!(found.scene.seabed.unwrap().depth, depth);
        assert!(
            found
                .notes
                .iter()
                .all(|note| !note.text.contains("no water depth")),
            "{:?}",
            found.notes
        );
    }
    let shallow = deck.replace("110 WtrDpth", "90 WtrDpth");
    let found = with_files(folder.path(), &shallow, &[("seabed.txt", &heights)]).unwrap();
    let said: Vec<&str> = found.notes.iter().map(|note| &note.text[..]).collect();
    assert!(!said.join("\n").contains("deep everywhere"), "{said:?}");
    let error = with_files(folder.path(), &deck, &[("seabed.txt", axes)]).unwrap_err();
    let lack = "seabed.txt: no height at x = 900 m, y = -900 m";
    assert_says(&error.list(), &["mooring.dat:27:1: OPTIONS, bathymetry: ", lack]);
}

/// A deck with one rope, with these entries for EA and BA.
fn rope(ea: &str, ba: &str) -> String {
    format!(
        "MoorDyn input\n---- LINE TYPES ----\nName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx\n(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)\n\
         rope 0.15 22.0 {ea} {ba} 0.0 1.2 1.0 0.2 0.0\n\
         ---- POINTS ----\nID Attachment X Y Z M V CdA Ca\n(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n\
         1 Fixed 200.0 0.0 -100.0 0 0 0 0\n2 Coupled 0.0 0.0 -10.0 0 0 0 0\n\
         ---- LINES ----\nID LineType AttachA AttachB UnstrLen NumSegs Outputs\n(-) (-) (-) (-) (m) (-) (-)\n\
         1 rope 1 2 218.0 10 -\n---- OPTIONS ----\n100.0 WtrDpth\n---- need this line ----\n"
    )
}

#[test]
fn decks_say_static_and_dynamic_stiffness_or_name_a_table() {
    let folder = tempdir().unwrap();
    let load = |ea: &str, ba: &str| with_files(folder.path(), &rope(ea, ba), &[]);
    let both = load("1.424e8|1.586e8", "4E9|11e6").unwrap();
    let kind = &both.scene.line_types["rope"];
    assert_eq!(
        kind.static_stiffness.zip(kind.dynamic_stiffness),
        Some((1.424e8, 1.586e8))
    );
    assert_eq!(
        kind.static_damping.zip(kind.dynamic_damping),
        Some((4.0e9, 1.1e7))
    );
    assert_converted(&both);
    Simulation::new(&both.scene).unwrap();
    let missing = format!("{:?}", load("polyester.txt", "-0.8").unwrap_err());
    assert_says(&missing, &["polyester.txt: no such file"]);
    let table = "----Polyester----\nStrain Tension\n(-) (N)\n0.0 0.0\n0.01 1.0e6\n0.02 3.0e6\n";
    fs::write(folder.path().join("polyester.txt"), table).unwrap();
    let read = load("polyester.txt", "-0.8").unwrap();
    let of = |scene: &Scene| scene.line_types["rope"].tension_strain.clone().unwrap().rows;
    assert_eq!(of(&read.scene).len(), 3);
    let converted = Scene::from_toml(&read.to_commented_toml()).unwrap();
    assert_eq!(of(&converted), of(&read.scene));
    let model = Model::new(&read.scene).unwrap();
    let of_moordyn = 0.8 * (218.0 / 10.0) * (3.0e6_f64 / 0.02 * 22.0).sqrt(); // the last tension over the last strain
    assert_relative_eq!(
        model.lines[0].segments.axial_damping[3],
        of_moordyn,
        max_relative = 1e-9
    );
}

#[test]
fn recorded_angles_move_a_vessel_of_a_deck_to_where_they_were_recorded() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("deck.dat");
    fs::write(&path, OPENFAST).unwrap();
    let mut scene = load(&path).unwrap().scene;
    let vessel = scene.vessels[0].name.clone();
    let order = scene.vessels[0].motion_angles;
    assert!(!order.is_zyx());
    let angles = Vector3::new(0.35, -0.52, 0.70);
    let results = folder.path().join("results.csv");
    let axes = ["x", "y", "z", "roll", "pitch", "yaw"].map(|axis| format!("{vessel}.{axis}"));
    let header = format!("time,{},solver.substeps", axes.join(","));
    let row = |t: f64| format!("{t},0,0,0,{},{},{},1", angles.x, angles.y, angles.z);
    fs::write(&results, format!("{header}\n{}\n{}\n", row(0.0), row(1.0))).unwrap();
    scene
        .drive(&Drive {
            file: Some(results),
            ..Drive::default()
        })
        .unwrap();
    let MotionPath::Table(rows) = &scene.motion[&vessel] else {
        panic!("{:?}", scene.motion[&vessel]);
    };
    let moved = order.rotation(Vector3::from_row_slice(&rows[0][4..]));
    let recorded = AngleOrder::Zyx.rotation(angles);
    assert!(moved.angle_to(&recorded) < 1e-12, "{rows:?}");
}
