//! The page of the scene format is the whole format: its keys are the reader's, and the reader's are on it.

use std::collections::{BTreeMap, BTreeSet};

use moorline::scene::keys::{Known, choices, tables};

const PAGE: &str = include_str!("../../docs/scene.md");

/// What the page calls the tables and choices of the reader.
const NAMES: &[(&str, &str)] = &[
    ("Scene", "the scene"),
    ("Water", "`[water]`"),
    ("Current", "`current`"),
    ("Sea", "`waves`, each sea"),
    ("RegularWave", "`regular`"),
    ("Seabed", "`[seabed]`"),
    ("DepthGrid", "`grid`"),
    ("Directions", "`friction`"),
    ("LineType", "`[line_types.NAME]`"),
    ("TensionStrain", "`tension_strain`"),
    ("SolidSection", "`solid_section`"),
    ("Rayleigh", "`rayleigh`"),
    ("Point", "`[[points]]`"),
    ("PointForce", "`force`"),
    ("PointMoment", "`moment`"),
    ("TimeFunction", "a function of time"),
    ("MotionText", "a motion"),
    ("Vessel", "`[[vessels]]`"),
    ("Line", "`[[lines]]`"),
    ("Section", "`sections`, each"),
    ("Break", "`break`"),
    ("Winch", "`winch`"),
    ("Solver", "`[solver]`"),
    ("Bossak", "`bossak`"),
    ("Output", "`[output]`"),
    ("LineModel", "`model`"),
    ("FibreLaw", "`fibre_law`"),
    ("Strain", "`strain`"),
    ("PointKind", "`kind`"),
    ("Axis", "`free`"),
    ("RestShape", "`rest_shape`"),
    ("InitialShape", "`initial`"),
    ("Integrator", "`integrator`"),
    ("Reconstruction", "`input_reconstruction`"),
    ("AngleOrder", "`motion_angles`"),
    ("ContactLaw", "`contact`"),
    ("SpectrumKind", "`spectrum`"),
    ("LineEnd", "an end"),
];

/// Words in backticks.
fn code(text: &str) -> BTreeSet<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// The rows of the tables under "Every key": what they are about, and the words in them.
fn listed() -> BTreeMap<&'static str, BTreeSet<&'static str>> {
    let (_, list) = PAGE.split_once("\n## Every key\n").expect("the page has a list");
    let rows = list.lines().filter(|line| line.starts_with("| "));
    let cells = rows.filter_map(|row| row.trim_matches(['|', ' ']).split_once(" | "));
    cells
        .filter(|(_, keys)| keys.starts_with('`'))
        .map(|(of, keys)| (of, code(keys)))
        .collect()
}

fn of_the_reader() -> Vec<Known> {
    tables().into_iter().chain(choices()).collect()
}

#[test]
fn the_keys_of_the_page_are_those_of_the_reader() {
    let (listed, known) = (listed(), of_the_reader());
    assert_eq!(listed.len(), known.len(), "tables on the page, and of the reader");
    for (table, keys) in known {
        let name = NAMES.iter().find(|(of, _)| *of == table);
        let (_, name) = name.unwrap_or_else(|| panic!("{table} has no row on the page"));
        // `dynamics` is another name of `integrator`
        let keys: BTreeSet<&str> = keys.iter().copied().filter(|key| *key != "dynamics").collect();
        assert_eq!(listed[name], keys, "{table}, \"{name}\" on the page");
    }
}

#[test]
fn every_key_of_the_reader_is_explained_on_the_page_before_it_is_listed() {
    let (text, _) = PAGE.split_once("\n## Every key\n").unwrap();
    for (table, keys) in of_the_reader() {
        for key in keys {
            let given = [
                format!("{key} = "),
                format!("`{key}`"),
                format!("\"{key}\""),
                format!("[{key}"),
                format!("{key}]"),
            ];
            let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
            assert!(
                given.iter().any(|form| text.contains(form.as_str()))
                    || words.into_iter().any(|word| word == *key),
                "{table}.{key}"
            );
        }
    }
}

#[test]
fn every_key_in_an_example_of_the_page_is_one_of_the_reader() {
    let known: BTreeSet<&str> = of_the_reader()
        .into_iter()
        .flat_map(|(_, keys)| keys)
        .copied()
        .collect();
    let blocks = PAGE
        .split("```toml\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next());
    for line in blocks.flat_map(str::lines) {
        let commented = line.trim_start_matches("# ");
        let code = commented.split('#').next().unwrap_or_default();
        for before in code.split('=').rev().skip(1) {
            let key = before.rsplit([' ', '{', ',', '.']).find(|word| !word.is_empty());
            let key = key.unwrap_or_default();
            // a motion is given by the name of what moves
            assert!(
                known.contains(key) || ["fairlead", "platform"].contains(&key),
                "{line}"
            );
        }
    }
}
