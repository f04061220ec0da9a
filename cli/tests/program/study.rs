//! `moorline accuracy`: studies of short scenes, and peers that cannot run.

use super::*;

/// Folder with the scene and a short one in water.
fn short_study() -> Folder {
    let folder = folder();
    let wet = format!(
        "[water]\ndensity = 1025.0\n\n{}",
        SCENE.split_once('\n').unwrap().1
    );
    let sea = "mass = 20.0\ndiameter = 0.1\ndrag_normal = 1.2\nadded_mass_normal = 1.0";
    folder.write(
        "short.toml",
        wet.replace(", elements = 8", "").replace("mass = 0.05", sea),
    );
    folder
}

const STUDIED: [&str; 6] = [
    "accuracy.csv",
    "in_host.svg",
    "overview.svg",
    "short.svg",
    "summary.md",
    "verdicts.csv",
];

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_study_is_written_to_its_end_whatever_becomes_of_standard_output() {
    let folder = short_study();
    let output = folder.piped("accuracy short.toml -o out", |child| drop(child.stdout.take()));
    let remarks = err(&output);
    assert!(output.status.success(), "{remarks}");
    assert!(
        remarks.lines().all(|line| line.starts_with("note: ")),
        "{remarks}"
    );
    assert_eq!(folder.names_in("out"), STUDIED);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn default_settings_keep_their_tolerance_in_a_host_of_short_steps() {
    let folder = folder_with(&[(
        "rope.toml",
        include_str!("../../../tests/scenes/pulled_rope.toml"),
    )]);
    let text = folder.done("accuracy rope.toml -o out");
    assert_says(
        &text,
        &[
            "rope in a host, steps of 0.05 s",
            "rope in a host, steps of 0.01 s",
        ],
    );
    let table = folder.read("out/accuracy.csv");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let head = reader.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let column = |name: &str| head.iter().position(|key| key == name).unwrap();
    let in_host = |step: &str| -> Vec<f64> {
        let hosted = rows.iter().filter(|row| &row[column("host_step")] == step);
        let hosted = hosted.inspect(|row| assert_eq!(&row[column("code")], "moorline, default settings"));
        hosted
            .map(|row| row[column("tension_rms")].parse().unwrap())
            .collect()
    };
    let errors = in_host("0.01");
    let kept = errors
        .iter()
        .zip([0.05, 0.02, 0.01, 0.005])
        .all(|(error, tolerance)| *error <= tolerance);
    assert!(kept, "{errors:?}");
    assert_eq!((errors.len(), in_host("0.05").len()), (4, 4));
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_study_without_title_or_seabed_speaks_of_neither_and_is_added_to_those_of_the_same_processor() {
    let folder = short_study();
    let text = folder.done("accuracy short.toml -o out");
    assert_says(&text, &["\nshort\nconverged solution"]);
    assert!(!text.contains("seabed"), "{text}");
    let before = folder.read("out/accuracy.csv").replace(",short,", ",earlier,");
    folder.write("out/accuracy.csv", &before);
    folder.done("accuracy short.toml -o out --add");
    let table = folder.read("out/accuracy.csv");
    assert!(
        table.starts_with(&before) && table[before.len()..].contains(",short,"),
        "{table}"
    );
    assert_says(&folder.read("out/summary.md"), &["| earlier, ", "| short, "]);
    let processor = table.lines().nth(1).unwrap().split(',').next().unwrap();
    folder.write("out/accuracy.csv", before.replace(processor, "another one"));
    folder.refused(
        "accuracy short.toml -o out --add",
        &["out/accuracy.csv", "another one"],
    );
}

#[test]
fn a_study_takes_decks_and_motion_as_a_run_does() {
    let folder = short_study();
    for (given, part) in [
        (
            "short.toml -o out --move buoy.x=1,5",
            "short: `buoy` is no vessel",
        ),
        ("short.toml -o out --motion none.csv", "none.csv"),
        ("short.toml -o out --depth 300", "`seabed.depth`"),
        ("--depth 300", "--depth, --at and --vessel"),
    ] {
        folder.refused(&format!("accuracy {given}"), &[part]);
    }
    assert_eq!(folder.names(), ["scene.toml", "short.toml"]);
}

#[cfg(unix)]
#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn peers_that_give_nothing_are_a_computation_that_failed_after_all_else_is_written() {
    use std::os::unix::fs::PermissionsExt;
    let folder = short_study();
    // replies to `-c` as a Python interpreter with the peers does, and to nothing else
    folder.write("python", "#!/bin/sh\n[ \"$1\" = -c ] && echo ready\n");
    fs::set_permissions(folder.path("python"), fs::Permissions::from_mode(0o755)).unwrap();
    let output = folder.run("accuracy short.toml -o out --peers ./python");
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    assert_says(&err(&output), &["no peer gave a result"]);
    assert_says(&out(&output), &["no result: peers: "]);
    let mut written = STUDIED.to_vec();
    written.insert(3, "peers.py");
    assert_eq!(folder.names_in("out"), written);
}

#[cfg(unix)]
#[test]
fn what_is_no_python_is_refused_at_once() {
    let folder = folder();
    for program in ["true", "false", "echo"] {
        let arguments = format!("accuracy scene.toml -o out --peers /bin/{program}");
        folder.refused(&arguments, &["no Python interpreter"]);
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}
