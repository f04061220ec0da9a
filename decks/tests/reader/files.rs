//! Files beside a deck: bathymetry, waves and currents, tables of tension.

use std::f64::consts::PI;

use crate::*;

#[test]
fn a_deck_with_bathymetry_and_friction_is_read_and_converted_with_them() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bathymetry");
    fs::create_dir_all(&folder).unwrap();
    let soundings = "--- MoorPy Bathymetry Input File v1.0 ---\nnGridX 2\nnGridY 2\n-900 900\n-900 100 110\n900 100 110\n";
    fs::write(folder.join("bed.txt"), soundings).unwrap();
    let options = "bed.txt WtrDpth\n0.7 mu_kT\n0.3 mu_kA\n200 FricDamp\n1.5 StatDynFricScale";
    let deck = OPENFAST.replace("2.0e6    kbot", options);
    fs::write(folder.join("deck.dat"), deck).unwrap();
    let loaded = load(&folder.join("deck.dat")).unwrap();
    let bed = loaded.scene.seabed.as_ref().unwrap();
    assert_eq!((bed.friction.transverse, bed.friction.axial), (0.7, 0.3));
    assert_eq!(bed.grid.as_ref().unwrap().depth, [[100.0, 110.0], [100.0, 110.0]]);
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    let notes = notes.join("\n");
    assert!(
        notes.contains("static friction of 1.5 times the kinetic is not modelled"),
        "{notes}"
    );
    assert!(notes.contains("it needs no damping to fade in with"), "{notes}");
    let converted = Scene::from_toml(&loaded.to_commented_toml()).unwrap();
    assert_eq!(converted, loaded.scene);
}

#[test]
fn a_seafloor_file_of_moordyn_c_is_read_as_heights_of_the_bed() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("seafloor_c");
    fs::create_dir_all(&folder).unwrap();
    let deck = OPENFAST.replace("2.0e6    kbot", "110 WtrDpth\nbed.txt SeafloorFile");
    fs::write(folder.join("deck.dat"), deck).unwrap();
    let heights = "2 2\n-900 900\n-900 900\n-900 -900 -100\n-900 900 -100\n900 -900 -110\n900 900 -110\n";
    fs::write(folder.join("bed.txt"), heights).unwrap();
    let loaded = load(&folder.join("deck.dat")).unwrap_or_else(|error| panic!("{}", error.list()));
    let grid = loaded.scene.seabed.unwrap().grid.unwrap();
    assert_eq!((grid.x, grid.y), (vec![-900.0, 900.0], vec![-900.0, 900.0]));
    assert_eq!(grid.depth, [[100.0, 110.0], [100.0, 110.0]]);
    fs::write(
        folder.join("bed.txt"),
        "2 2\n-900 900\n-900 900\n-900 -900 -100\n",
    )
    .unwrap();
    let error = load(&folder.join("deck.dat")).unwrap_err();
    let said = error.list();
    assert!(said.contains("deck.dat:27:1: OPTIONS, bathymetry: "), "{said}");
    assert!(
        said.contains("bed.txt: no height at x = 900 m, y = -900 m"),
        "{said}"
    );
}

/// A MoorDyn deck of a buoyed line that asks for waves and a current, with files of these beside it.
fn deck_with_water(folder: &Path, waves: &str, current: &str) -> PathBuf {
    let deck = VERSION_1;
    let options = "80     WtrDpth\n7  WaveKin\n1  Currents";
    let path = folder.join("mooring.dat");
    fs::write(&path, deck.replace("80     WtrDpth", options)).unwrap();
    fs::write(folder.join("wave_frequencies.txt"), waves).unwrap();
    fs::write(folder.join("current_profile.txt"), current).unwrap();
    path
}

const DECK_WAVES: &str = "0.0 0.0 0.0\n0.6 0.0 1.2\n0.9 0.4 0.0 0.5\n";
const DECK_CURRENT: &str = "--- steady currents ---\nprofile\nz ux uy uz\n-80.0 0.1 0.0 0\n0.0 0.7 0.2 0\n";

#[test]
fn a_deck_of_moordyn_brings_its_waves_and_current_from_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = deck_with_water(folder.path(), DECK_WAVES, DECK_CURRENT);
    let loaded = load(&path).unwrap();
    let water = loaded.scene.water.as_ref().unwrap();
    let current = water.current.as_ref().unwrap();
    let profile = vec![[-80.0, 0.1, 0.0], [0.0, 0.7, 0.2]];
    assert_eq!(current.profile.as_ref().unwrap(), &profile);
    let mut simulation = Simulation::new(&loaded.scene).unwrap();
    let waves = simulation.model().waves.clone().unwrap();
    for t in [0.0, 2.0, 31.0] {
        // MoorDyn's sum: |A| sin(ωt + arg A) at the origin
        let expected = 1.2 * (0.6 * t + 0.5 * PI).sin() + 0.4 * (0.9_f64 * t).sin();
        assert!((waves.elevation(0.0, 0.0, t) - expected).abs() < 1e-12);
    }
    simulation.advance(0.1).unwrap();
    let text = loaded.to_commented_toml();
    assert_eq!(Scene::from_toml(&text).unwrap(), loaded.scene, "{text}");
    assert!(
        loaded
            .notes
            .iter()
            .any(|note| note.text.contains("wave_frequencies.txt"))
    );
}

#[test]
fn a_deck_whose_files_are_wrong_is_refused_with_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = deck_with_water(folder.path(), "0.6 0.0\n", DECK_CURRENT);
    let refusal = format!("{:?}", load(&path).unwrap_err());
    assert!(
        refusal.contains("wave_frequencies.txt, line 1: expected 3 or 4 numbers"),
        "{refusal}"
    );
}

/// A deck with one rope whose EA and BA are these words.
fn deck_with_rope(ea: &str, ba: &str) -> String {
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
    let folder = tempfile::tempdir().unwrap();
    let read = |ea: &str, ba: &str| {
        let path = folder.path().join("mooring.dat");
        fs::write(&path, deck_with_rope(ea, ba)).unwrap();
        load(&path)
    };
    let both = read("1.424e8|1.586e8", "4E9|11e6").unwrap();
    let kind = &both.scene.line_types["rope"];
    assert_eq!(
        kind.static_stiffness.zip(kind.dynamic_stiffness),
        Some((1.424e8, 1.586e8))
    );
    assert_eq!(
        kind.static_damping.zip(kind.dynamic_damping),
        Some((4.0e9, 1.1e7))
    );
    let converted = Scene::from_toml(&both.to_commented_toml()).unwrap();
    assert_eq!(converted, both.scene);
    Simulation::new(&converted).unwrap();
    let missing = format!("{:?}", read("polyester.txt", "-0.8").unwrap_err());
    assert!(missing.contains("polyester.txt: no such file"), "{missing}");
    let table = "----Polyester----\nStrain Tension\n(-) (N)\n0.0 0.0\n0.01 1.0e6\n0.02 3.0e6\n";
    fs::write(folder.path().join("polyester.txt"), table).unwrap();
    let found = read("polyester.txt", "-0.8").unwrap();
    let rows = &found.scene.line_types["rope"]
        .tension_strain
        .as_ref()
        .unwrap()
        .rows;
    assert_eq!(rows.len(), 3);
    let converted = Scene::from_toml(&found.to_commented_toml()).unwrap();
    assert_eq!(
        converted.line_types["rope"].tension_strain.as_ref().unwrap().rows,
        *rows
    );
    for (ea, ba, said) in [
        ("1e8|2e8|0.1", "1e9|1e6", "grows with the mean tension"),
        ("1e8|2e8", "-0.8", "no meaning"),
        ("1e8", "1e9|1e6", "belong to a viscoelastic line"),
        ("1e8", "damping.txt", "not modelled"),
    ] {
        let refused = format!("{:?}", read(ea, ba).unwrap_err());
        assert!(refused.contains(said), "{refused}");
    }
}
