//! Small decks after the traps of the field: each is read, solved at its own mesh, and its trap is named in a note.

use moorline::scene::PointKind;

use crate::*;

/// Deviation of the force at end B from that of the closed form [-].
const DEVIATION_MAX: f64 = 5e-3;

/// A deck of `tests/decks/traps`.
struct Trap {
    file: &'static str,
    supplement: fn() -> Supplement,
    /// Lines with a closed form; where not all have one, why.
    closed: Result<usize, &'static str>,
    /// Parts of notes, each of another note.
    notes: &'static [&'static str],
    /// What the scene must be.
    holds: fn(&Scene) -> bool,
}

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
    Trap {
        file: "repeated_option.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[
            "file line 16: rhoW 1000 is given again below: the last value, 1025, counts",
            "file line 18: kBot 2.5e6 is given again below: the last value, 3.0e6, counts",
        ],
        holds: |scene| {
            let bed = scene.seabed.as_ref().unwrap();
            scene.water.as_ref().unwrap().density == 1025.0 && bed.stiffness == 3e6
        },
    },
    Trap {
        file: "unknown_option.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[
            "the option \"kbto\" is not known and left out, did you mean KBOT?",
            "the option \"tidalRange\" is not known and left out",
        ],
        holds: |scene| scene.seabed.as_ref().unwrap().stiffness == 3e6,
    },
    Trap {
        file: "unknown_channel.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[
            "the output \"Body1fx\" is left out: the channel `Body1fx` of a body or rod is not written",
            "the output \"Body1Px\" is left out",
            "the output \"L1N31T\" is left out: node 31 of a line of 30 elements",
            "the output \"FairTen7\" is left out: no line is called `line7`",
            "the output \"FairTen1\" is left out: it stands there already",
            "the output \"Rod2Fz\" is left out",
        ],
        holds: |scene| scene.output.channels == ["FairTen1"],
    },
    Trap {
        file: "numbered_attachment.txt",
        supplement: nothing,
        closed: Ok(2),
        notes: &[
            "\"Fixed1\" is read as Fixed",
            "\"Coupled1\" is read as Coupled, as in MoorDyn, where the number 1 behind it means nothing",
            "\"Anchor2\" is read as Fixed",
            "\"Coupled2\" is read as Coupled",
        ],
        holds: |scene| point(scene, "point4").kind == PointKind::Coupled && scene.vessels.is_empty(),
    },
    Trap {
        file: "state_file.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[
            "ICfile start.ic: the state in this file is not read; the run starts from equilibrium",
            "are found without them: genDynamicIC",
        ],
        holds: |_| true,
    },
    Trap {
        file: "table_below_zero.txt",
        supplement: nothing,
        closed: Err("a table of tension has no closed form"),
        notes: &["rows below zero strain in the table of tension, 2 of them, are left out"],
        holds: |scene| {
            let table = scene.line_types["rope"].tension_strain.as_ref().unwrap();
            table.rows[..2] == [[0.0, 0.0], [0.01, 2e5]]
        },
    },
    Trap {
        file: "anchor_below_depth.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[
            "WtrDpth 90 m is less than the depth of point1, 97.5 m: the water is taken to be 97.5 m deep everywhere",
        ],
        holds: |scene| depth(scene) == 97.5,
    },
    Trap {
        file: "version_1.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &["read as MoorDyn v1"],
        holds: |scene| scene.line_types["chain"].drag_normal == Some(1.3),
    },
    Trap {
        file: "length_first.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &["the header calls column 3 \"AttachA\""],
        holds: |scene| scene.lines[0].sections[0].length == 234.5,
    },
    Trap {
        file: "fortran_exponents.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[],
        holds: |scene| scene.line_types["chain"].axial_stiffness == Some(3.1e8),
    },
    Trap {
        file: "latin_1.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &["the line type \"chaîne\" is called cha_ne here"],
        holds: |scene| scene.title.starts_with("Chaîne posée à la côte"),
    },
    Trap {
        file: "damping_ratio.txt",
        supplement: nothing,
        closed: Ok(2),
        notes: &[
            "chain: BA/-zeta -0.7 is a damping ratio of 0.7",
            "wire: BA 0.7 N s is next to none; a damping ratio is written with a minus sign, -0.7",
        ],
        holds: |_| true,
    },
    Trap {
        file: "outputs_in_a_row.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &["no files of single lines are written"],
        holds: |scene| scene.output.channels == ["FairTen1", "AnchTen1", "L1N20T", "L1N20Pz", "Point2Fx"],
    },
    Trap {
        file: "no_depth.txt",
        supplement: nothing,
        closed: Ok(2),
        notes: &[
            "no water depth in the file, for the host gives it: taken from the deepest fixed point, 111 m",
        ],
        holds: |scene| depth(scene) == 111.0,
    },
    Trap {
        file: "tabs.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[],
        holds: |scene| point(scene, "point2").position == [12.0, 0.0, -10.0],
    },
    Trap {
        file: "comments.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[],
        holds: |scene| scene.lines.len() == 1 && depth(scene) == 67.0,
    },
    Trap {
        file: "small_and_great_letters.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[],
        holds: |scene| scene.vessels.len() == 1 && depth(scene) == 93.0,
    },
    Trap {
        file: "free_clump.txt",
        supplement: nothing,
        closed: Err("lines that a free point joins have no closed form each"),
        notes: &[],
        holds: |scene| point(scene, "point2").mass == Some(4000.0),
    },
    Trap {
        file: "bar_diameter.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &["fit a chain whose bar has this diameter"],
        holds: |_| true,
    },
    Trap {
        file: "friction_options.txt",
        supplement: nothing,
        closed: Ok(1),
        notes: &[
            "it needs no damping to fade in with",
            "static friction of 1.5 times the kinetic is not modelled",
        ],
        holds: |scene| scene.seabed.as_ref().unwrap().friction.axial == 0.6,
    },
    Trap {
        file: "coupled_points.txt",
        supplement: joined,
        closed: Ok(3),
        notes: &[],
        holds: |scene| {
            let rides = |name| point(scene, name).on.as_deref() == Some("barge");
            let vessel = &scene.vessels[0];
            let at_origin = vessel.position == [0.0; 3] && vessel.attitude == [0.0; 3];
            scene.vessels.len() == 1 && at_origin && ["point4", "point5", "point6"].into_iter().all(rides)
        },
    },
    Trap {
        file: "quasi_static.map",
        supplement: deep_116,
        closed: Ok(2),
        notes: &["\"outer_fd inner only\" is a comment"],
        holds: |scene| scene.lines.len() == 2,
    },
    Trap {
        file: "unknown_words.map",
        supplement: deep_116,
        closed: Ok(2),
        notes: &[
            "the option \"outer_tolerance\" is not known and left out, did you mean OUTER_TOL?",
            "the flag \"OMIT_CONTCAT\" is not known and left out, did you mean OMIT_CONTACT?",
            "the flag \"colour\" is not known and left out",
        ],
        holds: |scene| scene.seabed.is_some(),
    },
];

/// What is wrong with a deck, if anything.
fn slips(trap: &Trap) -> Vec<String> {
    let path = deck("traps").join(trap.file);
    let loaded = match load_with(&path, &(trap.supplement)()) {
        Ok(loaded) => loaded,
        Err(error) => return vec![error.list()],
    };
    let mut slips = Vec::new();
    let mut unsaid: Vec<String> = loaded.notes.iter().map(|note| note.to_string()).collect();
    for part in trap.notes {
        match unsaid.iter().position(|note| note.contains(part)) {
            Some(index) => drop(unsaid.remove(index)),
            None => slips.push(format!("no note {part:?} in\n  {}", unsaid.join("\n  "))),
        }
    }
    if !(trap.holds)(&loaded.scene) {
        slips.push(format!("read as {:?}", loaded.scene));
    }
    let solved = Simulation::new(&loaded.scene).and_then(|made| made.in_equilibrium());
    let simulation = match solved {
        Ok(simulation) => simulation,
        Err(error) => return [slips, vec![error.to_string()]].concat(),
    };
    let count = loaded.scene.lines.len();
    let catenaries = (0..count).filter_map(|line| Some((line, simulation.catenary(line)?)));
    let mut closed = 0;
    for (line, catenary) in catenaries {
        closed += 1;
        let (found, exact) = (simulation.tension_b(line), catenary.tension_b());
        if (found / exact - 1.0).abs() > DEVIATION_MAX {
            slips.push(format!("line {}: {found} N for {exact} N", line + 1));
        }
    }
    if closed != trap.closed.unwrap_or(0) {
        slips.push(format!("{closed} lines of {count} have a closed form"));
    }
    slips
}

#[test]
fn every_trap_is_read_solved_as_the_closed_form_has_it_and_named() {
    let wrong: Vec<String> = TRAPS
        .iter()
        .map(|trap| (trap.file, slips(trap)))
        .filter(|(_, slips)| !slips.is_empty())
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
    assert_says(&note, &[read]);
}

#[test]
fn the_quasi_static_lines_of_map_have_no_note_on_drag() {
    let said = notes(&load_with(&deck("oc3.map"), &deep()).unwrap());
    assert!(!said.contains("drag_normal"), "{said}");
}

#[test]
fn every_deck_of_a_trap_is_in_the_table() {
    let files = fs::read_dir(deck("traps")).unwrap();
    for file in files.map(|entry| entry.unwrap().file_name().into_string().unwrap()) {
        let known = TRAPS.iter().any(|trap| trap.file == file);
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
