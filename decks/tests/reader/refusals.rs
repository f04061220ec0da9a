//! Every mistake once: what is written instead, and how the list of mistakes begins.

use crate::*;

/// What is written instead, and how the list of mistakes begins.
const REFUSALS: &[(&str, &str, &str)] = &[
    (
        "-0.8      0.0   2.0",
        "-0.8   2.0",
        "input:7:1: LINE TYPES, row 1: 9 columns, expected 10 (Name Diam",
    ),
    (
        "0.0766  113.35",
        "0.0766m  113.35",
        "input:7:10: LINE TYPES, row 1, Diam: expected a number [m], found \"0.0766m\"",
    ),
    (
        "0.0766  113.35",
        "NaN  113.35",
        "input:7:10: LINE TYPES, row 1, Diam: expected a finite number [m], found \"NaN\"",
    ),
    (
        "0.0766  113.35",
        "1e999  113.35",
        "input:7:10: LINE TYPES, row 1, Diam: \"1e999\" is beyond all numbers",
    ),
    (
        "0.0766  113.35",
        "-0.0766  113.35",
        "input:7:10: line type chain, Diam: -0.0766 m is not positive",
    ),
    (
        "0.0766  113.35",
        "1e300  113.35",
        "input:7:10: line type chain, Diam: 1e300 m is beyond the limit of 100 m",
    ),
    (
        "7.536D8 ",
        "0 ",
        "input:7:29: line type chain, EA: 0 N is not positive",
    ),
    (
        "7.536D8 ",
        "7e8|9e8|0.1 ",
        "input:7:29: line type chain, EA: a dynamic stiffness that grows with the mean tension",
    ),
    (
        "7.536D8 ",
        "7e8|9e8 ",
        "input:7:41: line type chain, BA/-zeta: a damping ratio has no meaning for the slow part",
    ),
    (
        "-0.8      0.0",
        "4E9|11e6      0.0",
        "input:7:41: line type chain, BA/-zeta: two dampings belong",
    ),
    (
        "-0.8      0.0",
        "ba.txt      0.0",
        "input:7:41: line type chain, BA/-zeta: a damping from \"ba.txt\"",
    ),
    (
        "-0.8      0.0",
        "-0.8      ei.txt",
        "input:7:51: line type chain, EI: only a constant EI",
    ),
    (
        "0.4    0.25",
        "0.4    0.25 0.7",
        "input:7:82: line type chain, Cl: vortex-induced vibration is not modelled",
    ),
    (
        "chain    0.0766",
        "wire    0.0766",
        "input:8:1: line type wire: a second line type wire",
    ),
    (
        "1    fixed      330.0",
        "one    fixed      330.0",
        "input:12:1: POINTS, row 1, ID: expected a whole number from 1 on, found \"one\"",
    ),
    (
        "1    fixed      330.0",
        "2    fixed      330.0",
        "input:13:1: point 2: a second point 2",
    ),
    (
        "1    fixed      330.0",
        "1    moored     330.0",
        "input:12:6: POINTS, row 1, Attachment: expected Fixed, Coupled",
    ),
    (
        "1    fixed      330.0",
        "1    Body1      330.0",
        "input:12:6: point 1: no body has the number 1",
    ),
    (
        "1    fixed      330.0      0.0    -100.0",
        "1    fixed      330.0      0.0",
        "input:12:1: POINTS, row 1: 8 columns, expected 9 (ID",
    ),
    (
        "1        chain        1",
        "1        chian        1",
        "input:21:10: LINES, row 1, LineType: no line type is called \"chian\"",
    ),
    (
        "1        chain        1",
        "1        Chain        1",
        "input:21:10: LINES, row 1, LineType: no line type is called \"Chain\", did you mean \"chain\"?",
    ),
    (
        "1        chain        1         4",
        "1        chain        1         9",
        "input:21:33: LINES, row 1, AttachB: no point has the number 9",
    ),
    (
        "1        chain        1         4",
        "1        chain        4         4",
        "input:21:33: line 1, AttachB: both ends are at `point4`",
    ),
    (
        "1        chain        1         4",
        "1        chain        1         R1A",
        "input:21:33: LINES, row 1, AttachB: no rod has the number 1",
    ),
    (
        "340.0       20       -",
        "-340.0       20       -",
        "input:21:40: line 1, UnstrLen: -340 m is not positive",
    ),
    (
        "340.0       20       -",
        "340.0       0       -",
        "input:21:52: LINES, row 1, NumSegs: expected a whole number from 1 on, found \"0\"",
    ),
    (
        "340.0       20       -",
        "340.0       999999999       -",
        "input:21:52: line 1, NumSegs: 999999999 is not between 1 and 100000",
    ),
    (
        "340.0       20       -",
        "340.0       20",
        "input:21:1: LINES, row 1: 6 columns, expected 7 (ID",
    ),
    (
        "2.0e6    kbot",
        "kbot    2.0e6",
        "input:26:9: OPTIONS: an option is written as value and key",
    ),
    (
        "2.0e6    kbot",
        "-2.0e6    kbot",
        "input:26:1: OPTIONS, kBot: -2e6 Pa/m is not positive",
    ),
    (
        "2.0e6    kbot",
        "1 WaveKin",
        "input:26:1: OPTIONS, WaveKin: only WaveKin 7 (components of wave_frequencies.txt)",
    ),
    (
        "2.0e6    kbot",
        "bed.txt WtrDpth",
        "input:26:1: OPTIONS, bathymetry: ",
    ),
    (
        "2.0e6    kbot",
        "bed.txt SeafloorFile",
        "input:26:1: OPTIONS, bathymetry: ",
    ),
    (
        "(-)       (-)        (m)       (-)      (-)       (-)      (-)\n",
        "",
        "input:20:1: LINES: the two lines below a section's header",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- SOLVER CHOICES -----",
        "input:24:1: unknown section \"SOLVER CHOICES\"; known are",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- LINES -----",
        "input:24:1: LINES: a second section LINES",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- FAILURE -----\na b c d\n(-) (-) (-) (-)\n1 2 0 1e5\n----- SOLVER OPTIONS -----",
        "input:27:1: FAILURE: breaks are not read from decks",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- CONTROL -----\na b\n(-) (-)\n1 2\n----- SOLVER OPTIONS -----",
        "input:27:1: CONTROL: lines whose length",
    ),
    (
        "----- SOLVER OPTIONS -----",
        "----- EXTERNAL LOADS -----\na b\n(-) (-)\n1 2\n----- SOLVER OPTIONS -----",
        "input:27:1: EXTERNAL LOADS: ",
    ),
];

/// Each replacement alone must be refused with a list of mistakes that begins as given.
fn assert_refused(deck: &str, refusals: &[(&str, &str, &str)]) {
    let wrong: Vec<String> = refusals
        .iter()
        .map(|(old, new, begins)| (old, new, begins, said(&with(deck, old, new))))
        .filter(|(_, _, begins, said)| !said.starts_with(*begins))
        .map(|(old, new, begins, said)| format!("{old:?} -> {new:?}\n  {begins}\n  {said}"))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_refusal_names_file_line_and_column_and_what_would_be_right() {
    assert_refused(OPENFAST, REFUSALS);
}

#[test]
fn a_count_of_rows_that_is_wrong_is_refused_as_moordyn_v1_would_lose_some() {
    assert_refused(
        VERSION_1,
        &[
            (
                "2   NLines",
                "1   NLines",
                "input:15:1: LINES: 1 rows are announced, and there are 2",
            ),
            (
                "3   NConnects",
                "x   NConnects",
                "input:8:1: POINTS: expected the number of rows below",
            ),
        ],
    );
}

#[test]
fn a_free_body_is_not_refused_as_if_a_host_moved_it() {
    let deck = with(C_STYLE, "1    Coupled     0", "1    Free     0");
    let said = said(&with(&deck, "90      0    0|0|0", "90      7e3    0|0|0"));
    assert!(said.contains("a free body is not modelled"), "{said}");
    assert!(!said.contains("host that moves it"), "{said}");
}

#[test]
fn bodies_and_rods_that_move_are_refused_with_what_to_do() {
    let refusals = [
        (
            "1    Coupled     0",
            "1    Pinned     0",
            "input:15:6: body 1: a body is Fixed, Coupled or Vessel\n",
        ),
        (
            "1    Coupled     0",
            "1    Free     0",
            "input:15:6: body 1: a free body is not modelled",
        ),
        (
            "1    Coupled     0",
            "1    CoupledPinned     0",
            "input:15:6: body 1: a body that is coupled but free to turn",
        ),
        (
            "90      0    0|0|0",
            "90      7e3    0|0|0",
            "input:15:61: body 1: the mass of a coupled body belongs to the host",
        ),
        (
            "0|0|0",
            "0|0",
            "input:15:66: BODIES, row 1, CG: 2 numbers joined by |",
        ),
        (
            "clamp     Fixed",
            "clamp     Free",
            "input:19:16: rod 1: a rod that can move is not modelled",
        ),
        (
            "clamp     Fixed",
            "clamp     Pinned",
            "input:19:16: rod 1: a rod that can move is not modelled",
        ),
        (
            "clamp     Fixed      120   0    -60   118    0    -60   0",
            "clamp     Body1      120   0    -60   118    0    -60   3",
            "input:19:16: rod 1: the weight and drag of a rod",
        ),
        (
            "1    clamp     Fixed",
            "1    cramp     Fixed",
            "input:19:6: rod 1: no rod type is called \"cramp\"",
        ),
        (
            "118    0    -60   0",
            "120    0    -60   0",
            "input:19:44: rod 1: the two ends of the rod are the same point",
        ),
    ];
    assert_refused(C_STYLE, &refusals);
}

#[test]
fn a_wrong_map_deck_is_refused_at_its_place() {
    for (old, new, part) in [
        (
            "1     Fix ",
            "1     Fiks ",
            "NODE PROPERTIES, row 1, Type: expected fix, connect or vessel",
        ),
        (
            "902.2       1         2",
            "902.2       1         7",
            "line 1: no node has the number 7",
        ),
        (
            "tension_fair",
            "LINEAR_SPRING",
            "a line as a linear spring is not modelled",
        ),
        (
            "tension_fair",
            "DAMAGE_TIME",
            "lines that come off are not modelled",
        ),
        (
            "repeat 120 240",
            "repeat 120 x",
            "repeat: expected a number, found \"x\"",
        ),
        (
            "77.7066",
            "77,7066",
            "MassDenInAir: expected a number [kg/m], found \"77,7066\"",
        ),
        ("902.2 ", "-902.2 ", "line 1, UnstrLen: -902.2 m is not positive"),
    ] {
        let error = load_bytes(with(MAP, old, new).as_bytes(), &deep())
            .unwrap_err()
            .list();
        assert!(error.contains(part), "{old:?} -> {new:?}\n{error}");
    }
}

#[test]
fn a_unit_above_a_column_that_it_is_not_read_in_is_refused_with_the_one_that_is() {
    let read = |old: &str, new: &str| said(&with(VERSION_1, old, new));
    for (old, new, part) in [
        (
            "(N)   (N)  (N) ",
            "(kN)  (kN) (kN)",
            "input:10:59: the header has (kN) over FZ, but numbers there are read in N",
        ),
        (
            "(m)    (kg/m) ",
            "(mm)   (kg/m) ",
            "the header has (mm) over Diam, but numbers there are read in m",
        ),
        (
            "(kg/m)         (N) ",
            "(t/m)          (N) ",
            "the header has (t/m) over MassDen, but numbers there are read in kg/m",
        ),
        ("(Pa-s/-)", "(kN-s/-)", "the header has (kN-s/-) over BA/-zeta"),
    ] {
        assert!(
            read(old, new).contains(part),
            "{old} -> {new}\n{}",
            read(old, new)
        );
    }
    let other = with(VERSION_1, "(kg)  (m^3)", "(-)  (#)");
    assert!(load_text(&other).is_ok());
    let of_zeros = with(
        &with(VERSION_1, "1e3   1.5", "0     1.5"),
        "(N)   (N)  (N) ",
        "(kN)  (kN) (kN)",
    );
    assert!(load_text(&of_zeros).is_ok());
    let map = with(MAP, "(N)           (-)   (Pa-s)", "(kN)          (-)   (Pa-s)");
    let error = load_bytes(map.as_bytes(), &deep()).unwrap_err().list();
    assert!(
        error.contains("the header has (kN) over EA, but numbers there are read in N"),
        "{error}"
    );
}

#[test]
fn advice_on_what_a_deck_leaves_to_its_host_is_that_of_every_command() {
    let depth = load_text(MAP).unwrap_err().list();
    assert!(depth.contains("add `--depth 320` to the command"), "{depth}");
    let place = load_text(FARM).unwrap_err().list();
    assert!(
        place.contains("add `--at turbine1=X,Y,Z` to the command"),
        "{place}"
    );
    assert!(!depth.contains("convert") && !place.contains("convert"));
}

#[test]
fn mistakes_of_a_stage_are_reported_together_in_the_order_of_the_file() {
    let text = with(OPENFAST, "113.35", "heavy");
    let text = with(&text, "1    fixed", "1    moored");
    let text = with(&text, "2.0e6    kbot", "2.0e6x    kbot");
    let said = said(&text);
    let places: Vec<&str> = said
        .lines()
        .map(|line| &line[..line.find(": ").unwrap()])
        .collect();
    assert_eq!(places, ["input:7:18", "input:12:6", "input:26:1"], "{said}");
}

#[test]
fn a_scene_of_moorline_is_still_told_from_a_deck_by_text() {
    let mistake = Scene::from_toml(OPENFAST).unwrap_err();
    assert!(
        mistake
            .to_string()
            .starts_with("not TOML: rows of dashes head the tables of a deck"),
        "{mistake}"
    );
}
