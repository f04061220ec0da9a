//! `moorline run` of a deck that is moved from the command line: motion file, regular motion, duration, depth, places.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{assert_says, greatest};
use tempfile::{TempDir, tempdir};

const DECK: &str = include_str!("../decks/openfast_v2.dat");
const C_STYLE: &str = include_str!("../decks/moordyn_c.txt");
const VERSION_1: &str = include_str!("../decks/moordyn_v1.dat");
const FARM: &str = include_str!("../decks/farm.dat");

type Columns = BTreeMap<String, Vec<f64>>;

/// Runs the command line in a folder, which must end with this exit code; its words on standard error.
fn moorline(folder: &Path, arguments: &[&str], code: i32) -> String {
    let mut program = Command::new(env!("CARGO_BIN_EXE_moorline"));
    let done = program.args(arguments).current_dir(folder).output().unwrap();
    let error = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(code), "{error}");
    error
}

fn results(folder: &Path) -> Columns {
    let mut table = csv::Reader::from_path(folder.join("results.csv")).unwrap();
    let names: Vec<String> = table.headers().unwrap().iter().map(String::from).collect();
    let rows: Vec<Vec<f64>> = table.deserialize().map(Result::unwrap).collect();
    let column = |index: usize| rows.iter().map(|row| row[index]).collect();
    let columns = names.iter().enumerate();
    columns
        .map(|(index, name)| (name.clone(), column(index)))
        .collect()
}

/// Runs `deck` with `files` beside it and the further arguments in a folder: its words on standard error.
fn ran(folder: &TempDir, deck: &str, files: &[(&str, &str)], arguments: &[&str], code: i32) -> String {
    for (name, text) in files.iter().chain(&[("deck.txt", deck)]) {
        fs::write(folder.path().join(name), text).unwrap();
    }
    moorline(
        folder.path(),
        &[&["run", "deck.txt", "-o", "out"], arguments].concat(),
        code,
    )
}

/// The columns of a run.
fn run(deck: &str, files: &[(&str, &str)], arguments: &[&str]) -> Columns {
    let folder = tempdir().unwrap();
    ran(&folder, deck, files, arguments, 0);
    results(&folder.path().join("out"))
}

/// The message of a run that must not start.
fn refused(deck: &str, files: &[(&str, &str)], arguments: &[&str]) -> String {
    ran(&tempdir().unwrap(), deck, files, arguments, 2)
}

/// Arguments of a command line without quotes.
fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
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
    let (low, high) = (
        tension.iter().copied().fold(f64::INFINITY, f64::min),
        greatest(tension.iter().copied()),
    );
    assert!(high > 1.01 * low && low > 0.0);
    let named = heave_and_pitch("t [s],vessel.z [m],vessel.pitch [rad]", 4.0);
    let same = run(DECK, &[("motion.csv", &named)], &["--motion", "motion.csv"]);
    assert_eq!(same, columns);
}

#[test]
fn regular_motion_of_a_deck_is_that_of_a_scene_that_says_it() {
    let flags = "--move vessel.x=1.5,8 --move vessel.pitch=0.02,6,0.5 --ramp 3 --duration 4";
    let by_flag = run(DECK, &[], &words(flags));
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("deck.txt"), DECK).unwrap();
    moorline(folder.path(), &["convert", "deck.txt", "-o", "scene.toml"], 0);
    let scene = fs::read_to_string(folder.path().join("scene.toml")).unwrap();
    assert!(scene.contains("[motion]\n"));
    let motion = "[motion]\nvessel = { x = [[1.5, 8.0]], pitch = [[0.02, 6.0, 0.5]], ramp = 3.0 }\n";
    let scene = scene.replace("[motion]\n", motion);
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    moorline(
        folder.path(),
        &["run", "scene.toml", "-o", "out", "--duration", "4"],
        0,
    );
    assert_eq!(results(&folder.path().join("out")), by_flag);
    assert_eq!(*by_flag["time"].last().unwrap(), 4.0);
}

#[test]
fn coupled_points_of_a_deck_move_as_the_one_vessel_that_is_given() {
    let kinds = ["4    vessel ", "5    Vessel ", "6    VES    "];
    let points = kinds.iter().fold(DECK.to_string(), |deck, word| {
        assert!(deck.contains(word));
        deck.replace(word, &format!("{}    Coupled ", &word[..1]))
    });
    let moved = "--move barge.pitch=0.02,6 --move barge.z=0.5,8 --duration 2";
    let said = refused(&points, &[], &words(moved));
    assert_says(
        &said,
        &["`barge` is no vessel or coupled point", "use --vessel barge"],
    );
    let said = refused(&points, &[], &["--move", "point4.pitch=0.02,6"]);
    assert_says(
        &said,
        &["`point4` is a point, and points do not turn", "use --vessel NAME"],
    );
    let joined = run(&points, &[], &words(&format!("{moved} --vessel barge")));
    let own = run(DECK, &[], &words(&moved.replace("barge", "vessel")));
    assert!(joined["barge.my"].iter().any(|moment| *moment != 0.0));
    assert_eq!(joined["barge.my"], own["vessel.my"]);
    assert_eq!(joined["FairTen1"], own["FairTen1"]);
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
    let at = "--at turbine1=0,0,0 --at turbine2=1000,0,0";
    let columns = run(
        FARM,
        &[],
        &words(&format!("{at} --move turbine2.x=1,8 --duration 2")),
    );
    assert!(columns["turbine1.x"].iter().all(|x| *x == 0.0));
    assert!(columns["turbine2.x"].iter().any(|x| *x > 0.5));
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("farm.dat"), FARM).unwrap();
    for command in ["check", "statics"] {
        moorline(folder.path(), &[command, "farm.dat"], 2);
        moorline(
            folder.path(),
            &[&[command, "farm.dat"], &words(at)[..]].concat(),
            0,
        );
    }
}

#[test]
fn what_cannot_move_or_be_read_is_refused_with_file_line_and_what_would_be_right() {
    let flag = ["--motion", "m.csv"];
    let with_file = |deck: &str, text: &str| refused(deck, &[("m.csv", text)], &flag);
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
        assert_says(&with_file(DECK, text), &["error: m", words]);
    }
    assert_says(&refused(DECK, &[], &flag), &["m.csv: no such file"]);
    let turning = "time,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n";
    let points = VERSION_1.replace("3     Fairlead ", "3     Coupled  ");
    assert_says(
        &with_file(&points, turning),
        &["points do not turn", "use --vessel NAME"],
    );
    let several = with_file(C_STYLE, "time,x,y,z\n0,0,0,0\n");
    assert_says(&several, &["the columns must name what moves, such as body1.x"]);
    let file = [("m.csv", "time,x,y,z\n0,0,0,0\n1,1,0,0\n")];
    let twice = refused(DECK, &file, &words("--motion m.csv --move vessel.x=1,8"));
    assert_says(&twice, &["moves by the file already"]);
    let wrong = refused(DECK, &[], &["--move", "vessel.x=1"]);
    assert_says(&wrong, &["BODY.AXIS=AMPLITUDE,PERIOD"]);
}
