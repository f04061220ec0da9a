//! `moorline sweep`: exit codes, messages, killed and resumed sweeps.

use super::*;

fn sweep_folder(cases: &str) -> Folder {
    let folder = folder();
    folder.write("long.toml", SCENE.replace("duration = 1.0", "duration = 3.0"));
    folder.write("cases.toml", cases);
    folder
}

const LENGTHS: &str = "lines.line1.length = [14.2, 14.3, 14.4]\n";

#[test]
fn a_sweep_writes_its_tables_and_goes_on_without_a_word_of_resuming() {
    let folder = sweep_folder(LENGTHS);
    folder.shows(
        "sweep long.toml cases.toml -o out",
        &["3 cases in", "in steps", "written to out"],
    );
    let table = folder.read("out/cases.csv");
    assert_eq!(table.lines().count(), 4);
    folder.shows(
        "sweep long.toml cases.toml -o out",
        &["3 of 3 cases are done already"],
    );
    assert_eq!(folder.read("out/cases.csv"), table);
}

#[test]
fn wrong_cases_are_refused_with_their_place_before_anything_is_written() {
    let folder = sweep_folder("lines.lin1.length = [14.2]\n");
    let output = folder.run("sweep long.toml cases.toml -o out");
    assert_eq!(output.status.code(), Some(2));
    assert_says(&err(&output), &["cases.toml:1:12", "did you mean `line1`?"]);
    assert!(!folder.path("out").exists());
    let output = folder.run("sweep long.toml nowhere.csv -o out");
    assert_eq!(output.status.code(), Some(2));
    assert_says(&err(&output), &["nowhere.csv: no such file"]);
}

#[test]
fn a_failed_case_is_listed_and_the_exit_code_is_1() {
    let folder = sweep_folder("\"motion.fairlead.x[0][0]\" = [0.05, 1e7]\n");
    let output = folder.run("sweep long.toml cases.toml -o out");
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    assert_says(
        &err(&output),
        &[
            "1 of 2 cases failed, the others have results",
            "case 2 (cases.toml:1): ",
        ],
    );
    let rows = folder.read("out/cases.csv");
    assert_eq!(rows.lines().count(), 3);
}

#[test]
fn the_folder_of_another_sweep_is_refused_by_the_program() {
    let folder = sweep_folder(LENGTHS);
    folder.done("sweep long.toml cases.toml -o out");
    folder.write("cases.toml", "lines.line1.length = [14.2, 14.3]\n");
    let output = folder.run("sweep long.toml cases.toml -o out");
    assert_eq!(output.status.code(), Some(2));
    assert_says(
        &err(&output),
        &[
            "sweep.journal: it holds a sweep of 3 cases, which are 2 here",
            "give another folder",
        ],
    );
}

/// Kills a sweep at given moments and compares its table with that of an uninterrupted one.
fn killed(seeds: usize, moments: &[u64]) {
    let scene = include_str!("../../../examples/sweep/semi.toml");
    let quick = scene.replace("duration = 600.0", "duration = 100.0");
    let folder = folder_with(&[("semi.toml", &quick)]);
    let seeds: Vec<String> = (1..=seeds).map(|seed| seed.to_string()).collect();
    folder.write(
        "cases.toml",
        format!("solver.elements = 10\nseed = [{}]\n", seeds.join(", ")),
    );
    folder.done("sweep semi.toml cases.toml -o whole");
    for moment in moments {
        let mut child = folder
            .command("sweep semi.toml cases.toml -o parts")
            .spawn()
            .unwrap();
        std::thread::sleep(std::time::Duration::from_millis(*moment));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    folder.done("sweep semi.toml cases.toml -o parts");
    for name in ["cases.csv", "cases.parquet", "cases.units.csv"] {
        let [whole, parts] = ["whole", "parts"].map(|out| fs::read(folder.path(out).join(name)).unwrap());
        assert!(whole == parts, "{name} differs after {moments:?} ms");
    }
}

#[test]
fn a_sweep_that_is_killed_and_called_again_has_the_same_table() {
    killed(6, &[40, 90]);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_sweep_that_is_killed_at_many_moments_has_the_same_table() {
    let moments: Vec<u64> = (0..20_u64).map(|i| 10 + (i * i * 7919) % 310).collect();
    killed(60, &moments);
}
