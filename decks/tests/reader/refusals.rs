//! Every mistake once: `tests/decks/refusals` contains the first mistakes listed for each changed deck.

use crate::*;

#[test]
fn every_mistake_in_a_deck_is_refused_with_file_line_column_and_what_would_be_right() {
    let tables = [
        (OPENFAST, include_str!("../decks/refusals/openfast_v2.txt")),
        (VERSION_1, include_str!("../decks/refusals/moordyn_v1.txt")),
        (C_STYLE, include_str!("../decks/refusals/moordyn_c.txt")),
    ];
    let of_map = include_str!("../decks/refusals/oc3.txt");
    let wrong = tables
        .map(|(deck, table)| wrong_answers(deck, table, said))
        .concat();
    let wrong = wrong + &wrong_answers(MAP, of_map, |text| said_by(load_deep(text)));
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_unit_above_a_column_that_has_none_or_only_zeros_is_read() {
    let other = with(VERSION_1, "(kg)  (m^3)", "(-)  (#)");
    let zeros = with(
        &with(VERSION_1, "1e3   1.5", "0     1.5"),
        "(N)   (N)  (N) ",
        "(kN)  (kN) (kN)",
    );
    assert!(load_text(&other).is_ok() && load_text(&zeros).is_ok());
}

#[test]
fn a_unit_of_another_quantity_or_an_unknown_one_is_noted() {
    let force = with(OPENFAST, "(kg/m)", "(N/m)");
    let said = notes(&loaded(&with(&force, "(N) ", "(lbf)")));
    assert_says(
        &said,
        &[
            "the header has \"(N/m)\" over Mass, but numbers there are read in kg/m",
            "the header has \"(lbf)\" over EA, but numbers there are read in N\n",
        ],
    );
    assert!(!notes(&loaded(OPENFAST)).contains("the header has"));
}

#[test]
fn a_deck_may_end_at_any_row_of_dashes() {
    let (deck, _) = OPENFAST.split_once("END\n").unwrap();
    let expected = loaded(deck).scene;
    for end in [
        "------- END ----",
        "---",
        "need this line ---",
        "--- NEED THIS LINE ---\nrest ---\n",
    ] {
        assert_eq!(loaded(&format!("{deck}{end}")).scene, expected, "{end}");
    }
}

#[test]
fn a_free_body_is_not_refused_as_if_a_host_moved_it() {
    let deck = with(C_STYLE, "1    Coupled     0", "1    Free     0");
    let said = said(&with(&deck, "90      0    0|0|0", "90      7e3    0|0|0"));
    assert_says(&said, &["a free body is not modelled"]);
    assert!(!said.contains("host that moves it"), "{said}");
}

#[test]
fn advice_on_what_a_deck_leaves_to_its_host_is_that_of_every_command() {
    let depth = load_text(MAP).unwrap_err().list();
    assert_says(&depth, &["add `--depth 320` to the command"]);
    let place = load_text(FARM).unwrap_err().list();
    assert_says(&place, &["add `--at turbine1=X,Y,Z` to the command"]);
    assert!(!depth.contains("convert") && !place.contains("convert"));
}

#[test]
fn a_mistake_in_a_row_that_a_map_deck_repeats_is_said_once() {
    for (right, wrong) in [
        ("902.2", "-902.2"),
        ("2     Vessel    5.2     0.0    -70.0", "2 Vessel 853.87 0 -320"),
    ] {
        let said = said_by(load_deep(&with(MAP, right, wrong)));
        assert_eq!(said.trim_end().lines().count(), 1, "{said}");
    }
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
