//! The command line on decks.

use moorline::simulation::Simulation;
use moorline_decks::{Supplement, load_with};

use super::*;

#[test]
fn the_command_line_converts_a_deck_with_what_its_host_would_give() {
    let folder = folder_with(&[("farm.dat", FARM)]);
    folder.refused("convert farm.dat -o farm.toml", &["--at turbine1=X,Y,Z"]);
    let output = folder.run("convert farm.dat -o farm.toml --at turbine1=0,0,0 --at turbine2=1000,0,0");
    assert_eq!(
        (output.status.code(), err(&output).as_str()),
        (Some(0), ""),
        "{output:?}"
    );
    let said = out(&output);
    assert!(said.starts_with("written to farm.toml\nnote: file"), "{said}");
    folder.refused(
        "convert farm.toml -o again.toml",
        &["is a scene of moorline already"],
    );
}

#[test]
fn a_run_of_a_deck_writes_its_channels_beside_moorlines_columns() {
    let channels = "FairTen2 AnchTen1 L2N0Px Point2Pz Con3Fx L1NBVz";
    let text = VERSION_1
        .replace("FairTen2 AnchTen1", channels)
        .replace("0.02   dtOut", "5.0   dtOut");
    let folder = folder_with(&[("deck.dat", &text)]);
    let columns = folder.columns("run deck.dat -o out");
    let column = |name: &str| columns.get(name).unwrap_or_else(|| panic!("{name}: {columns:?}"));
    assert_eq!(column("time").len(), 13);
    // This is the tension of the last segment; the force on the point also includes half a segment's weight, except the part supported by the seabed.
    let apart = |channel: &str, force: &str| column(channel)[0] / column(force)[0] - 1.0;
    assert!(apart("FairTen2", "line2.tension_b").abs() < 1e-6);
    assert!(apart("AnchTen1", "line1.tension_a").abs() < 1e-6);
    assert!(column("L2N0Px").iter().all(|x| (x - 60.0).abs() < 40.0));
    assert!(column("Point2Pz").iter().all(|z| *z < 0.0));
    assert!(column("Con3Fx").iter().all(|force| *force > 0.0));
    assert!(column("L1NBVz").iter().all(|speed| speed.abs() < 1e-3));
}

#[test]
fn a_map_deck_runs_through_equilibria_without_trials_of_elements() {
    let motion = "time,x,y,z\n0,0,0,0\n10,4,0,0\n20,4,0,0\n";
    let folder = folder_with(&[("oc3.map", MAP), ("motion.csv", motion)]);
    let output = folder.run("run oc3.map -o out --depth 320 --motion motion.csv");
    let (said, remarks) = (out(&output), err(&output));
    assert_eq!(output.status.code(), Some(0), "{remarks}");
    assert_says(&remarks, &["quasi-static, as MAP++ is"]);
    let report = folder.read("out/report.html");
    assert!(
        !report.contains("by trials") && !said.contains("by trials"),
        "{said}"
    );
    let (names, rows) = table(&folder.path("out/results.csv"));
    let index = names.iter().position(|name| name == "line1.tension_b").unwrap();
    let tension = rows[rows.len() - 1][index];
    let moved = Supplement {
        depth: Some(320.0),
        positions: [("vessel".to_string(), [4.0, 0.0, 0.0])].into(),
        ..Supplement::default()
    };
    let there = load_with(&folder.path("oc3.map"), &moved).unwrap_or_else(|e| panic!("{}", e.list()));
    let exact = Simulation::new(&there.scene).unwrap();
    let exact = exact.catenary(0).unwrap().tension_b();
    assert!((tension / exact - 1.0).abs() < 1e-6, "{tension} {exact}");
}
