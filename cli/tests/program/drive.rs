//! `moorline run` of a deck that is moved from the command line: motion file, regular motion, duration, depth, places.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fs;

use tempfile::TempDir;

use super::{columns, done, err, moorline, refused};

const DECK: &str = include_str!("../../../decks/tests/decks/openfast_v2.dat");
const C_STYLE: &str = include_str!("../../../decks/tests/decks/moordyn_c.txt");
const VERSION_1: &str = include_str!("../../../decks/tests/decks/moordyn_v1.dat");
const FARM: &str = include_str!("../../../decks/tests/decks/farm.dat");

const RUN: [&str; 4] = ["run", "deck.txt", "-o", "out"];

/// A folder with a deck and files beside it.
fn folder(deck: &str, files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("deck.txt", deck)].iter().chain(files) {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Columns of the results of a run of `deck` with `files` beside it and further arguments.
fn run(deck: &str, files: &[(&str, &str)], arguments: &[&str]) -> BTreeMap<String, Vec<f64>> {
    columns(folder(deck, files).path(), &[&RUN, arguments].concat())
}

/// Message of a run that must be refused.
fn refusal(deck: &str, files: &[(&str, &str)], arguments: &[&str]) -> String {
    let output = moorline(folder(deck, files).path(), &[&RUN, arguments].concat());
    assert_eq!(output.status.code(), Some(2), "{}", err(&output));
    err(&output)
}

/// A table of a heave and pitch that grow, every 0.1 s for `end` seconds.
fn heave_and_pitch(header: &str, end: f64) -> String {
    let count = (end / 0.1).round() as usize;
    let row = |i: usize| {
        let t = 0.1 * i as f64;
        let grown = 0.5 * (1.0 - (TAU * t / (2.0 * end)).cos());
        let (z, pitch) = (
            grown * (TAU * t / 6.0).sin(),
            0.02 * grown * (TAU * t / 5.0).cos(),
        );
        match header {
            "time,x,y,z,roll,pitch,yaw" => format!("{t:.1},0,0,{z},0,{pitch},0"),
            _ => format!("{t:.1},{z},{pitch}"),
        }
    };
    let rows: Vec<String> = (0..=count).map(row).collect();
    format!("{header}\n{}\n", rows.join("\n"))
}

#[test]
fn a_motion_file_moves_the_vessel_of_a_deck_for_as_long_as_it_lasts() {
    let motion = heave_and_pitch("time,x,y,z,roll,pitch,yaw", 4.0);
    let columns = run(DECK, &[("motion.csv", &motion)], &["--motion", "motion.csv"]);
    assert_eq!(*columns["time"].last().unwrap(), 4.0);
    assert!(columns["vessel.z"].iter().any(|z| z.abs() > 0.3));
    assert!(columns["vessel.pitch"].iter().any(|a| a.abs() > 0.01));
    let tension = &columns["FairTen1"];
    let (low, high) = tension.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), t| {
        (low.min(*t), high.max(*t))
    });
    assert!(high > 1.01 * low && low > 0.0);
    let named = heave_and_pitch("t [s],vessel.z [m],vessel.pitch [rad]", 4.0);
    let same = run(DECK, &[("motion.csv", &named)], &["--motion", "motion.csv"]);
    assert_eq!(same, columns);
}

#[test]
fn regular_motion_of_a_deck_is_that_of_a_scene_that_says_it() {
    let by_flag = run(
        DECK,
        &[],
        &[
            "--move",
            "vessel.x=1.5,8",
            "--move",
            "vessel.pitch=0.02,6,0.5",
            "--ramp",
            "3",
            "--duration",
            "4",
        ],
    );
    let folder = folder(DECK, &[]);
    done(folder.path(), &["convert", "deck.txt", "-o", "scene.toml"]);
    let scene = fs::read_to_string(folder.path().join("scene.toml")).unwrap();
    let motion = "[motion]\nvessel = { x = [[1.5, 8.0]], pitch = [[0.02, 6.0, 0.5]], ramp = 3.0 }\n";
    fs::write(folder.path().join("scene.toml"), format!("{scene}\n{motion}")).unwrap();
    let by_scene = columns(
        folder.path(),
        &["run", "scene.toml", "-o", "out", "--duration", "4"],
    );
    assert_eq!(by_scene, by_flag);
    assert_eq!(*by_flag["time"].last().unwrap(), 4.0);
}

#[test]
fn coupled_points_of_a_deck_move_as_the_one_vessel_that_is_given() {
    let words = ["4    vessel ", "5    Vessel ", "6    VES    "];
    let points = words.iter().fold(DECK.to_string(), |deck, word| {
        assert!(deck.contains(word));
        deck.replace(word, &format!("{}    Coupled ", &word[..1]))
    });
    let moved = [
        "--move",
        "barge.pitch=0.02,6",
        "--move",
        "barge.z=0.5,8",
        "--duration",
        "2",
    ];
    let said = refusal(&points, &[], &moved);
    assert!(
        said.contains("`barge` is no vessel or coupled point") && said.contains("use --vessel barge"),
        "{said}"
    );
    let said = refusal(&points, &[], &["--move", "point4.pitch=0.02,6"]);
    assert!(
        said.contains("`point4` is a point, and points do not turn") && said.contains("use --vessel NAME"),
        "{said}"
    );
    let joined = run(&points, &[], &[moved.as_slice(), &["--vessel", "barge"]].concat());
    let given = moved.map(|word| word.replace("barge", "vessel"));
    let own = run(DECK, &[], &given.each_ref().map(String::as_str));
    assert!(joined["barge.my"].iter().any(|moment| *moment != 0.0));
    assert_eq!(joined["barge.my"], own["vessel.my"]);
    assert_eq!(joined["FairTen1"], own["FairTen1"]);
}

#[test]
fn a_note_on_a_motion_beside_a_scene_names_its_file_or_argument() {
    let folder = folder(
        DECK,
        &[(
            "m.csv",
            "time,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0,0,0,0,2.0,0\n",
        )],
    );
    let remarks = |arguments: &[&str]| {
        let arguments = [&RUN, arguments, &["--duration", "1"]].concat();
        err(&moorline(folder.path(), &arguments))
    };
    let said = remarks(&["--motion", "m.csv"]);
    assert!(
        said.contains("note: m.csv: motion.vessel.table: pitch of 2 rad is a turn by"),
        "{said}"
    );
    let said = remarks(&["--move", "vessel.x=0.01,0.05"]);
    assert!(
        said.contains("note: --move: motion.vessel.x: a period of 0.05 s is unusual"),
        "{said}"
    );
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/oc3_catenary.toml");
    let moved = [
        "run",
        scene,
        "-o",
        "out",
        "--move",
        "fairlead.x=0.01,0.05",
        "--duration",
        "1",
    ];
    let said = err(&moorline(folder.path(), &moved));
    assert!(
        said.contains("note: --move: motion.fairlead.x: a period"),
        "{said}"
    );
}

#[test]
fn without_a_motion_a_deck_stays_at_rest() {
    let columns = run(DECK, &[], &["--duration", "3"]);
    let tension = &columns["FairTen2"];
    assert!(tension.iter().all(|t| (t / tension[0] - 1.0).abs() < 1e-6));
}

#[test]
fn without_vessels_a_file_without_names_moves_all_coupled_points_alike() {
    let motion = "time,x,y,z\n0,0,0,0\n1,0.2,0,0.1\n2,0.5,0,0.2\n";
    let deck = VERSION_1.replace("3     Fairlead ", "3     Coupled  ");
    let columns = run(&deck, &[("motion.csv", motion)], &["--motion", "motion.csv"]);
    assert_eq!(*columns["point3.x"].last().unwrap(), 0.5);
    assert_eq!(*columns["point3.z"].last().unwrap(), 0.2);
}

#[test]
fn a_farm_runs_with_its_places_and_the_motion_of_one_of_its_vessels() {
    let arguments = [
        "--at",
        "turbine1=0,0,0",
        "--at",
        "turbine2=1000,0,0",
        "--move",
        "turbine2.x=1,8",
        "--duration",
        "2",
    ];
    let columns = run(FARM, &[], &arguments);
    assert!(columns["turbine1.x"].iter().all(|x| *x == 0.0));
    assert!(columns["turbine2.x"].iter().any(|x| *x > 0.5));
    let folder = folder(FARM, &[]);
    for command in ["check", "statics"] {
        refused(folder.path(), &[command, "deck.txt"], 2, &["turbine"]);
        done(folder.path(), &[&[command, "deck.txt"], &arguments[..4]].concat());
    }
}

#[test]
fn what_cannot_move_or_be_read_is_refused_with_file_line_and_what_would_be_right() {
    let flag = ["--motion", "m.csv"];
    let with_file = |deck: &str, text: &str| refusal(deck, &[("m.csv", text)], &flag);
    for (text, words) in [
        ("time,u\n0,0\n", "line 1: the header must be"),
        ("time,x,y,z,roll\n0,0,0,0,0\n", "line 1: the header must be"),
        ("x,y,z\n0,0,0\n", "line 1: the header must be"),
        ("time,vessel.u\n0,0\n", "line 1: the header must be"),
        ("time,vessel.x,vessel.x\n0,0,0\n", "two columns vessel.x"),
        (
            "time,ship.x\n0,0\n",
            "line 1: `ship` is no vessel or coupled point: what moves is vessel",
        ),
        ("time,point1.x\n0,0\n", "`point1` is no vessel or coupled point"),
        (
            "time,x,y,z\n0,0,0,0\n1,0,0\n",
            "line 3: expected 4 numbers (time, x, y, z), found 3",
        ),
        (
            "time,x,y,z\n0,0,nan,0\n",
            "line 2: column y: expected a finite number",
        ),
        (
            "time,vessel.x\n0,0\n1,x\n",
            "line 3: column vessel.x: expected a finite number",
        ),
        (
            "time,x,y,z\n1,0,0,0\n1,0,0,0\n",
            "line 3: time 1 s does not come after 1 s",
        ),
        ("time,x,y,z\n", "no rows below the header"),
        ("time,x,y,z\n0,1e300,0,0\n", "beyond the limit"),
    ] {
        let said = with_file(DECK, text);
        assert!(
            said.contains("error: m") && said.contains(words),
            "{text:?}: {said}"
        );
    }
    let missing = refusal(DECK, &[], &flag);
    assert!(missing.contains("m.csv: no such file"), "{missing}");
    let turning = "time,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n";
    let points = VERSION_1.replace("3     Fairlead ", "3     Coupled  ");
    let said = with_file(&points, turning);
    assert!(
        said.contains("points do not turn") && said.contains("use --vessel NAME"),
        "{said}"
    );
    let several = with_file(C_STYLE, "time,x,y,z\n0,0,0,0\n");
    assert!(
        several.contains("the columns must name what moves, such as body1.x"),
        "{several}"
    );
    let twice = refusal(
        DECK,
        &[("m.csv", "time,x,y,z\n0,0,0,0\n1,1,0,0\n")],
        &["--motion", "m.csv", "--move", "vessel.x=1,8"],
    );
    assert!(twice.contains("moves by the file already"), "{twice}");
    let wrong = refusal(DECK, &[], &["--move", "vessel.x=1"]);
    assert!(wrong.contains("BODY.AXIS=AMPLITUDE,PERIOD"), "{wrong}");
}
