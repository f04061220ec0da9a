//! The command line on decks.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::*;

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
    assert!(said.starts_with("written to farm.toml\nnote: file"), "{said}");
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
    let header: Vec<String> = table.headers().unwrap().iter().map(str::to_string).collect();
    let rows: Vec<Vec<f64>> = table.deserialize().map(Result::unwrap).collect();
    let column = |name: &str| {
        let index = header
            .iter()
            .position(|known| known == name)
            .unwrap_or_else(|| panic!("{name}: {header:?}"));
        rows.iter().map(|row| row[index]).collect::<Vec<f64>>()
    };
    assert_eq!(rows.len(), 13);
    // The tension of the last segment; the force on the point has half a segment's weight besides, save what the seabed carries.
    let apart = |channel: &str, force: &str| column(channel)[0] / column(force)[0] - 1.0;
    assert!((-0.05..-1e-6).contains(&apart("FairTen2", "line2.tension_b")));
    assert!(apart("AnchTen1", "line1.tension_a").abs() < 0.05);
    assert!(column("L2N0Px").iter().all(|x| (x - 60.0).abs() < 40.0));
    assert!(column("Point2Pz").iter().all(|z| *z < 0.0));
    assert!(column("Con3Fx").iter().all(|force| *force > 0.0));
    assert!(column("L1NBVz").iter().all(|speed| speed.abs() < 1e-3));
}

#[test]
fn a_map_deck_runs_through_equilibria_without_trials_of_elements() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("oc3.map"), MAP).unwrap();
    let motion = "time,x,y,z\n0,0,0,0\n10,4,0,0\n20,4,0,0\n";
    fs::write(folder.path().join("motion.csv"), motion).unwrap();
    let moved = ["--depth", "320", "--motion", "motion.csv"];
    let arguments = [&["run", "oc3.map", "-o", "out"], &moved[..]].concat();
    let (code, said, error) = moorline(folder.path(), &arguments);
    assert_eq!(code, 0, "{error}");
    assert!(error.contains("quasi-static, as MAP++ is"), "{error}");
    let report = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(
        !report.contains("tried on") && !said.contains("tried on"),
        "{said}"
    );
    let mut table = csv::Reader::from_path(folder.path().join("out/results.csv")).unwrap();
    let header = table.headers().unwrap().clone();
    let index = header.iter().position(|name| name == "line1.tension_b");
    let last = table.records().last().unwrap().unwrap();
    let tension: f64 = last[index.unwrap()].parse().unwrap();
    let mut moved = deep();
    moved.positions.insert("vessel".to_string(), [4.0, 0.0, 0.0]);
    let there = load_bytes(MAP.as_bytes(), &moved).unwrap_or_else(|e| panic!("{}", e.list()));
    let exact = Simulation::new(&there.scene).unwrap();
    let exact = exact.catenary(0).unwrap().tension_b();
    assert!((tension / exact - 1.0).abs() < 1e-6, "{tension} {exact}");
}
