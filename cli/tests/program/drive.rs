//! `moorline run` of a deck that is moved from the command line: motion file, regular motion, duration, depth, positions.

use std::f64::consts::TAU;

use super::*;

/// Folder with a deck and a motion file.
fn driven(deck: &str, motion: &str) -> Folder {
    folder_with(&[("deck.txt", deck), ("motion.csv", motion)])
}

/// Columns of the results of a run of `deck`, with a motion file next to it and further arguments.
fn run(deck: &str, motion: &str, arguments: &str) -> BTreeMap<String, Vec<f64>> {
    driven(deck, motion).columns(&format!("run deck.txt -o out {arguments}"))
}

/// Table of growing heave and pitch motions, every 0.1 s for `end` seconds.
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
    let columns = run(OPENFAST, &motion, "--motion motion.csv");
    assert_eq!(*columns["time"].last().unwrap(), 4.0);
    assert!(columns["vessel.z"].iter().any(|z| z.abs() > 0.3));
    assert!(columns["vessel.pitch"].iter().any(|a| a.abs() > 0.01));
    let tension = &columns["FairTen1"];
    let (low, high) = tension.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), t| {
        (low.min(*t), high.max(*t))
    });
    assert!(high > 1.01 * low && low > 0.0);
    let named = heave_and_pitch("t [s],vessel.z [m],vessel.pitch [rad]", 4.0);
    let same = run(OPENFAST, &named, "--motion motion.csv");
    assert_eq!(same, columns);
}

#[test]
fn a_run_does_not_write_over_the_motion_that_it_reads() {
    let folder = driven(OPENFAST, "");
    let motion = heave_and_pitch("time,x,y,z,roll,pitch,yaw", 4.0);
    folder.write("results.csv", &motion);
    folder.refused(
        "run deck.txt -o . --motion results.csv",
        &["results.csv is the file that is read"],
    );
    assert_eq!(folder.read("results.csv"), motion);
}

#[test]
fn regular_motion_of_a_deck_is_that_of_a_scene_that_says_it() {
    let moved = "--move vessel.x=1.5,8 --move vessel.pitch=0.02,6,0.5 --ramp 3 --duration 4";
    let by_flag = run(OPENFAST, "", moved);
    let folder = driven(OPENFAST, "");
    folder.done("convert deck.txt -o scene.toml");
    let motion = "[motion]\nvessel = { x = [[1.5, 8.0]], pitch = [[0.02, 6.0, 0.5]], ramp = 3.0 }\n";
    folder.write("scene.toml", format!("{}\n{motion}", folder.read("scene.toml")));
    let by_scene = folder.columns("run scene.toml -o out --duration 4");
    assert_eq!(by_scene, by_flag);
    assert_eq!(*by_flag["time"].last().unwrap(), 4.0);
}

#[test]
fn coupled_points_of_a_deck_move_as_the_one_vessel_that_is_given() {
    let words = ["4    vessel ", "5    Vessel ", "6    VES    "];
    let points = words.iter().fold(OPENFAST.to_string(), |deck, word| {
        assert!(deck.contains(word));
        deck.replace(word, &format!("{}    Coupled ", &word[..1]))
    });
    let moved = "--move barge.pitch=0.02,6 --move barge.z=0.5,8 --duration 2";
    let folder = driven(&points, "");
    let parts = ["`barge` is no vessel or coupled point", "use --vessel barge"];
    folder.refused(&format!("run deck.txt -o out {moved}"), &parts);
    let parts = ["`point4` is a point, and points do not turn", "use --vessel NAME"];
    folder.refused("run deck.txt -o out --move point4.pitch=0.02,6", &parts);
    let joined = run(&points, "", &format!("{moved} --vessel barge"));
    let own = run(OPENFAST, "", &moved.replace("barge", "vessel"));
    assert!(joined["barge.my"].iter().any(|moment| *moment != 0.0));
    assert_eq!(joined["barge.my"], own["vessel.my"]);
    assert_eq!(joined["FairTen1"], own["FairTen1"]);
}

#[test]
fn a_note_on_a_motion_beside_a_scene_names_its_file_or_argument() {
    let pitched = "time,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0,0,0,0,2.0,0\n";
    let folder = driven(OPENFAST, pitched);
    let remarks = |moved: &str| folder.remarks(&format!("run deck.txt -o out --duration 1 {moved}"));
    let turned = "note: motion.csv: motion.vessel.table: pitch of 2 rad is a turn by";
    assert_says(&remarks("--motion motion.csv"), &[turned]);
    let short = "note: --move: motion.vessel.x: a period of 0.05 s is unusual";
    assert_says(&remarks("--move vessel.x=0.01,0.05"), &[short]);
    let moved = "run scene.toml -o out --move fairlead.x=0.01,0.05 --duration 1";
    let said = folder_of("oc3_catenary").remarks(moved);
    assert_says(&said, &["note: --move: motion.fairlead.x: a period"]);
}

#[test]
fn without_a_motion_a_deck_stays_at_rest() {
    let columns = run(OPENFAST, "", "--duration 3");
    let tension = &columns["FairTen2"];
    assert!(tension.iter().all(|t| (t / tension[0] - 1.0).abs() < 1e-6));
}

#[test]
fn without_vessels_a_file_without_names_moves_all_coupled_points_alike() {
    let motion = "time,x,y,z\n0,0,0,0\n1,0.2,0,0.1\n2,0.5,0,0.2\n";
    let deck = VERSION_1.replace("3     Fairlead ", "3     Coupled  ");
    let columns = run(&deck, motion, "--motion motion.csv");
    assert_eq!(*columns["point3.x"].last().unwrap(), 0.5);
    assert_eq!(*columns["point3.z"].last().unwrap(), 0.2);
}

#[test]
fn a_farm_runs_with_its_places_and_the_motion_of_one_of_its_vessels() {
    let places = "--at turbine1=0,0,0 --at turbine2=1000,0,0";
    let columns = run(FARM, "", &format!("{places} --move turbine2.x=1,8 --duration 2"));
    assert!(columns["turbine1.x"].iter().all(|x| *x == 0.0));
    assert!(columns["turbine2.x"].iter().any(|x| *x > 0.5));
    let folder = driven(FARM, "");
    for command in ["check", "statics"] {
        folder.refused(&format!("{command} deck.txt"), &["turbine"]);
        folder.done(&format!("{command} deck.txt {places}"));
    }
}

#[test]
fn what_cannot_move_or_be_read_is_refused_with_file_line_and_what_would_be_right() {
    let refused = |deck: &str, motion: &str, moved: &str, parts: &[&str]| {
        driven(deck, motion).refused(&format!("run deck.txt -o out {moved}"), parts);
    };
    let flag = "--motion motion.csv";
    for (text, words) in [
        (
            "time,ship.x\n0,0\n",
            "line 1: `ship` is no vessel or coupled point: what moves is vessel",
        ),
        ("time,point1.x\n0,0\n", "`point1` is no vessel or coupled point"),
        (
            "time,x,y,z\n1,0,0,0\n1,0,0,0\n",
            "line 3: time 1 s does not come after 1 s",
        ),
        ("time,x,y,z\n0,1e300,0,0\n", "beyond the limit"),
    ] {
        refused(OPENFAST, text, flag, &["error: motion", words]);
    }
    refused(OPENFAST, "", "--motion m.csv", &["m.csv: no such file"]);
    let turning = "time,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n";
    let points = VERSION_1.replace("3     Fairlead ", "3     Coupled  ");
    refused(
        &points,
        turning,
        flag,
        &["points do not turn", "use --vessel NAME"],
    );
    let names = "the columns must name what moves, such as body1.x";
    refused(C_STYLE, "time,x,y,z\n0,0,0,0\n", flag, &[names]);
    let still = "time,x,y,z\n0,0,0,0\n1,1,0,0\n";
    let twice = "--motion motion.csv --move vessel.x=1,8";
    refused(OPENFAST, still, twice, &["moves by the file already"]);
    refused(OPENFAST, "", "--move vessel.x=1", &["BODY.AXIS=AMPLITUDE,PERIOD"]);
}
