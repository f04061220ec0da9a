//! Small decks with common traps: each is read and solved on its own mesh, and a note reports its trap.

use moorline::scene::PointKind;

use crate::*;

/// Maximum relative deviation of the tension at end B from the closed form [-].
const DEVIATION_MAX: f64 = 5e-3;

/// A deck in `tests/decks/traps`: file, values from its host, number of lines with a closed form, and a condition on the scene. A line has no
/// closed form if its tension is a table, or if a free point joins it to another.
type Trap = (&'static str, fn() -> Supplement, usize, fn(&Scene) -> bool);

/// Parts of the expected notes on each deck, each from a different note.
const NOTES: &str = include_str!("traps.txt");

fn nothing() -> Supplement {
    Supplement::default()
}

fn deep_116() -> Supplement {
    Supplement {
        depth: Some(116.0),
        ..Supplement::default()
    }
}

fn joined() -> Supplement {
    Supplement {
        vessel: Some("barge".to_string()),
        ..Supplement::default()
    }
}

fn depth(scene: &Scene) -> f64 {
    scene.seabed.as_ref().unwrap().depth
}

const TRAPS: &[Trap] = &[
    ("repeated_option.txt", nothing, 1, |scene| {
        let seabed = scene.seabed.as_ref().unwrap();
        scene.water.as_ref().unwrap().density == 1025.0 && seabed.stiffness == 3e6
    }),
    ("unknown_option.txt", nothing, 1, |scene| {
        scene.seabed.as_ref().unwrap().stiffness == 3e6
    }),
    ("unknown_channel.txt", nothing, 1, |scene| {
        scene.output.channels == ["FairTen1"]
    }),
    ("numbered_attachment.txt", nothing, 2, |scene| {
        point(scene, "point4").kind == PointKind::Coupled && scene.vessels.is_empty()
    }),
    ("state_file.txt", nothing, 1, |_| true),
    ("table_below_zero.txt", nothing, 0, |scene| {
        let table = scene.line_types["rope"].tension_strain.as_ref().unwrap();
        table.rows[..2] == [[0.0, 0.0], [0.01, 2e5]]
    }),
    ("anchor_below_depth.txt", nothing, 1, |scene| depth(scene) == 97.5),
    ("version_1.txt", nothing, 1, |scene| {
        scene.line_types["chain"].drag_normal == Some(1.3)
    }),
    ("length_first.txt", nothing, 1, |scene| {
        scene.lines[0].sections[0].length == 234.5
    }),
    ("fortran_exponents.txt", nothing, 1, |scene| {
        scene.line_types["chain"].axial_stiffness == Some(3.1e8)
    }),
    ("latin_1.txt", nothing, 1, |scene| {
        scene.title.starts_with("Chaîne posée à la côte")
    }),
    ("damping_ratio.txt", nothing, 2, |_| true),
    ("outputs_in_a_row.txt", nothing, 1, |scene| {
        scene.output.channels == ["FairTen1", "AnchTen1", "L1N20T", "L1N20Pz", "Point2Fx"]
    }),
    ("no_depth.txt", nothing, 2, |scene| depth(scene) == 111.0),
    ("tabs.txt", nothing, 1, |scene| {
        point(scene, "point2").position == [12.0, 0.0, -10.0]
    }),
    ("comments.txt", nothing, 1, |scene| {
        scene.lines.len() == 1 && depth(scene) == 67.0
    }),
    ("small_and_great_letters.txt", nothing, 1, |scene| {
        scene.vessels.len() == 1 && depth(scene) == 93.0
    }),
    ("free_clump.txt", nothing, 0, |scene| {
        point(scene, "point2").mass == Some(4000.0)
    }),
    ("bar_diameter.txt", nothing, 1, |_| true),
    ("friction_options.txt", nothing, 1, |scene| {
        scene.seabed.as_ref().unwrap().friction.axial == 0.6
    }),
    ("coupled_points.txt", joined, 3, |scene| {
        let rides = |name| point(scene, name).on.as_deref() == Some("barge");
        let vessel = &scene.vessels[0];
        let at_origin = vessel.position == [0.0; 3] && vessel.attitude == [0.0; 3];
        scene.vessels.len() == 1 && at_origin && ["point4", "point5", "point6"].into_iter().all(rides)
    }),
    ("quasi_static.map", deep_116, 2, |scene| scene.lines.len() == 2),
    ("unknown_words.map", deep_116, 2, |scene| scene.seabed.is_some()),
];

/// Returns the parts of the expected notes on a deck.
fn notes_on(file: &str) -> Vec<&'static str> {
    let mut lines = NOTES.lines();
    assert!(lines.any(|line| line == file), "no notes on {file}");
    lines.map_while(|line| line.strip_prefix("    ")).collect()
}

/// Returns the errors in the reading or the solution of a deck.
fn slips((file, supplement, closed, holds): &Trap) -> Vec<String> {
    let path = deck("traps").join(file);
    let loaded = match load_with(&path, &supplement()) {
        Ok(loaded) => loaded,
        Err(error) => return vec![error.list()],
    };
    let mut slips = Vec::new();
    let mut unsaid: Vec<String> = loaded.notes.iter().map(|note| note.to_string()).collect();
    for part in notes_on(file) {
        match unsaid.iter().position(|note| note.contains(part)) {
            Some(index) => drop(unsaid.remove(index)),
            None => slips.push(format!("no note {part:?} in\n  {}", unsaid.join("\n  "))),
        }
    }
    if !holds(&loaded.scene) {
        slips.push(format!("read as {:?}", loaded.scene));
    }
    let solved = Simulation::new(&loaded.scene).and_then(|made| made.in_equilibrium());
    let simulation = match solved {
        Ok(simulation) => simulation,
        Err(error) => return [slips, vec![error.to_string()]].concat(),
    };
    let count = loaded.scene.lines.len();
    let catenaries = (0..count).filter_map(|line| Some((line, simulation.catenary(line)?)));
    let mut found = 0;
    for (line, catenary) in catenaries {
        found += 1;
        let (tension, exact) = (simulation.tension_b(line), catenary.tension_b());
        if (tension / exact - 1.0).abs() > DEVIATION_MAX {
            slips.push(format!("line {}: {tension} N for {exact} N", line + 1));
        }
    }
    if found != *closed {
        slips.push(format!("{found} lines of {count} have a closed form"));
    }
    slips
}

#[test]
fn every_trap_is_read_solved_as_the_closed_form_has_it_and_named() {
    let found = TRAPS.iter().map(|trap| (trap.0, slips(trap)));
    let wrong = found.filter(|(_, slips)| !slips.is_empty());
    let wrong: Vec<String> = wrong
        .map(|(file, slips)| format!("{file}: {}", slips.join("\n  ")))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn a_state_file_without_time_to_come_to_rest_is_one_note() {
    let text = fs::read_to_string(deck("traps").join("state_file.txt")).unwrap();
    let at_once = with(&text, "----- need this", "0 TmaxIC\n----- need this");
    let said = notes(&load_text(&at_once).unwrap());
    let start: Vec<&str> = said
        .lines()
        .filter(|note| note.contains("runs start") || note.contains("start.ic"))
        .collect();
    let [note] = start[..] else {
        panic!("{start:#?}");
    };
    let read = "ICfile start.ic: the state in this file is not read; TmaxIC 0: runs start with free points where the file has them";
    assert_says(note, &[read]);
}

#[test]
fn every_deck_of_a_trap_is_in_the_table() {
    let files = fs::read_dir(deck("traps")).unwrap();
    for file in files.map(|entry| entry.unwrap().file_name().into_string().unwrap()) {
        let known = TRAPS.iter().any(|trap| trap.0 == file);
        assert!(known || file.ends_with(".csv"), "{file}");
    }
}

fn joined_as(text: &str, name: &str, at: Option<[f64; 3]>) -> Result<LoadedScene, LoadError> {
    let supplement = Supplement {
        vessel: Some(name.to_string()),
        positions: at.map(|at| (name.to_string(), at)).into_iter().collect(),
        ..Supplement::default()
    };
    load_bytes(text.as_bytes(), &supplement)
}

#[test]
fn a_vessel_of_all_coupled_points_takes_those_on_the_decks_own_vessel_too() {
    let text = with(OPENFAST, "4    vessel ", "4    coupled ");
    let scene = joined_as(&text, "barge", None).unwrap().scene;
    assert_eq!(scene.vessels.len(), 1);
    for name in ["point4", "point5", "point6"] {
        assert_eq!(point(&scene, name).on.as_deref(), Some("barge"));
    }
    let map = Supplement {
        vessel: Some("barge".to_string()),
        ..deep()
    };
    let scene = load_with(&deck("oc3.map"), &map).unwrap().scene;
    assert_eq!(scene.vessels[0].name, "barge");
}

#[test]
fn a_vessel_of_all_coupled_points_must_be_another_and_have_some() {
    for (text, name, at, part) in [
        (C_STYLE, "body1", None, "which the file has already"),
        (
            OPENFAST,
            "barge",
            Some([1.0, 0.0, 0.0]),
            "give no position for it",
        ),
        (
            &VERSION_1.replace("3     Fairlead ", "3     Fixed  "),
            "barge",
            None,
            "but the file has none",
        ),
        (
            OPENFAST,
            "point4",
            None,
            "cannot be `point4`, which the file has already",
        ),
        (
            OPENFAST,
            "line1",
            None,
            "cannot be `line1`, which the file has already",
        ),
        (
            OPENFAST,
            "a barge",
            None,
            "the vessel given for all coupled points: \"a barge\" holds ' '",
        ),
    ] {
        let error = joined_as(text, name, at).expect_err(part).list();
        assert!(error.contains(part) && !error.contains(":1:1"), "{error}");
    }
}

#[test]
fn a_deck_of_rods_or_bodies_alone_is_told_so() {
    let start = C_STYLE.find("---------------------- LINES").unwrap();
    let end = C_STYLE.find("---------------------- OPTIONS").unwrap();
    let mut text = C_STYLE.to_string();
    text.replace_range(start..end, "");
    let error = said(&text);
    assert_says(&error, &["no lines in LINES: rods and bodies without lines"]);
    assert_eq!(error.lines().count(), 1, "{error}");
}
