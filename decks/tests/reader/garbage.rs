//! Hundreds of broken decks.

use crate::chance::Chance;
use crate::*;

const DECKS: [&str; 5] = [OPENFAST, VERSION_1, C_STYLE, FARM, MAP];

/// Cells of the tables that contain numbers: line index and word index.
fn number_cells(text: &str) -> Vec<(usize, usize)> {
    let mut cells = Vec::new();
    let mut inside = false;
    for (number, line) in text.lines().enumerate() {
        if line.contains("---") {
            let upper = line.to_uppercase();
            let heads = "TYPES DICTIONARY POINT CONNECTION LINES LINE_PROP NODE_PROP".split(' ');
            inside = heads
                .map(|head| head.replace('_', " "))
                .any(|head| upper.contains(&head));
        } else if inside {
            let words = line.split('#').next().unwrap().split_whitespace();
            let numbers = words.enumerate().filter(|(_, word)| word.parse::<f64>().is_ok());
            cells.extend(numbers.map(|(word, _)| (number, word)));
        }
    }
    cells
}

/// Replaces one word in one line of the text; an empty word removes the cell.
fn with_word(text: &str, (line, word): (usize, usize), new: &str) -> String {
    let rewritten = text.lines().enumerate().map(|(number, old)| {
        if number != line {
            return old.to_string();
        }
        let before_comment = old.split('#').next().unwrap();
        let mut words: Vec<&str> = before_comment.split_whitespace().collect();
        words[word] = new;
        words.retain(|word| !word.is_empty());
        words.join("  ")
    });
    rewritten.collect::<Vec<_>>().join("\n")
}

/// Every mutation breaks the deck.
#[test]
fn two_hundred_broken_decks_are_refused_with_file_and_line() {
    let mut chance = Chance::new(20_240_229);
    let breaks = ["", "NaN", "1e999", "x", "inf", "--3", "1,5", "0x1"];
    for trial in 0..250 {
        let text = *chance.one_of(&DECKS);
        let cell = *chance.one_of(&number_cells(text));
        let broken = with_word(text, cell, breaks[trial % breaks.len()]);
        let mut supplement = supplement();
        if text != FARM {
            supplement.positions.clear();
        }
        let error = match load_bytes(broken.as_bytes(), &supplement) {
            Err(error) => error.list(),
            // Words that MAP++ does not use, and comments after a row, may be anything.
            Ok(_) if text == MAP => continue,
            Ok(_) => panic!("trial {trial} is no mistake:\n{broken}"),
        };
        let place = error.lines().next().unwrap().split("/input:").nth(1);
        let line = place.and_then(|rest| rest.split(':').next()?.parse::<usize>().ok());
        assert!(line.is_some_and(|line| line >= 1), "trial {trial}: {error}");
    }
}

#[test]
fn decks_cut_swapped_and_scrambled_never_panic_and_never_hang() {
    let mut chance = Chance::new(7);
    let extremes = "1e300 -1e300 -1 0 99 100000 18446744073709551616 1e-300 Free R1A Body1 #";
    let extremes: Vec<&str> = extremes.split(' ').collect();
    for _ in 0..400 {
        let deck = *chance.one_of(&DECKS);
        let bytes = match chance.below(5) {
            0 | 1 => chance.damaged(deck.as_bytes().to_vec()),
            2 => chance.swapped(deck).into_bytes(),
            3 => {
                let mut lines: Vec<&str> = deck.lines().collect();
                lines.remove(chance.below(lines.len()));
                lines.join("\n").into_bytes()
            }
            _ => {
                let cell = *chance.one_of(&number_cells(deck));
                let extreme: &&str = chance.one_of(&extremes);
                with_word(deck, cell, extreme).into_bytes()
            }
        };
        match load_bytes(&bytes, &supplement()) {
            Ok(loaded) => drop(Model::new(&loaded.scene)),
            Err(error) => assert!(error.list().contains("input"), "{error}"),
        }
    }
}

#[test]
fn files_that_are_nothing_are_refused() {
    for bytes in [
        &b""[..],
        b"\n\n",
        b"\0\x01\x02",
        b"\xff\xfe-\0-\0-\0",
        b"--- LINES ---",
        b"--- POINTS ---\n1 2",
        b"---",
        b"\x89PNG\r\n",
    ] {
        let error = load_bytes(bytes, &Supplement::default()).unwrap_err().list();
        assert_says(&error, &["input"]);
    }
}

#[test]
fn a_table_without_end_is_refused_at_once() {
    let rows: String = (10..200_000)
        .map(|id| format!("{id} Fixed 0 0 -50 0 0 0 0\n"))
        .collect();
    let text = with(
        OPENFAST,
        "1    fixed      330.0",
        &format!("{rows}1    fixed      330.0"),
    );
    assert!(said(&text).contains("more than 5000 rows in POINTS"));
}
