//! Broken decks by the hundred.

use moorline::math::random::Random;

use crate::*;

/// Choices from a seed: the same decks every time.
struct Chance(Random);

impl Chance {
    fn new(seed: u64) -> Chance {
        Chance(Random::new(seed))
    }

    /// A number below `count`.
    fn below(&mut self, count: usize) -> usize {
        (self.0.bits() >> 33) as usize % count.max(1)
    }
}

/// Cells of the tables that hold numbers: line of the text and number of the word.
fn number_cells(text: &str) -> Vec<(usize, usize)> {
    let mut cells = Vec::new();
    let mut inside = false;
    for (number, line) in text.lines().enumerate() {
        if line.contains("---") {
            let upper = line.to_uppercase();
            inside = [
                "TYPES",
                "DICTIONARY",
                "POINT",
                "CONNECTION",
                "LINES",
                "LINE PROP",
                "NODE PROP",
            ]
            .iter()
            .any(|word| upper.contains(word));
        } else if inside {
            let words = line.split('#').next().unwrap().split_whitespace();
            let numbers = words.enumerate().filter(|(_, word)| word.parse::<f64>().is_ok());
            cells.extend(numbers.map(|(word, _)| (number, word)));
        }
    }
    cells
}

/// The text with one word of one line replaced; an empty word takes the column out.
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

/// Mutations that no deck survives.
#[test]
fn two_hundred_broken_decks_are_refused_with_file_and_line() {
    let decks = [OPENFAST, VERSION_1, C_STYLE, FARM, MAP];
    let mut chance = Chance::new(20_240_229);
    let breaks = ["", "NaN", "1e999", "x", "inf", "--3", "1,5", "0x1"];
    for trial in 0..250 {
        let text = decks[chance.below(decks.len())];
        let cells = number_cells(text);
        let broken = with_word(
            text,
            cells[chance.below(cells.len())],
            breaks[trial % breaks.len()],
        );
        let mut supplement = supplement();
        if text != FARM {
            supplement.positions.clear();
        }
        let error = match load_bytes(broken.as_bytes(), &supplement) {
            Err(error) => error.list(),
            // Words that MAP++ does not use may be anything, and comments behind a row too.
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
    let decks = [OPENFAST, VERSION_1, C_STYLE, FARM, MAP];
    let mut chance = Chance::new(7);
    let extremes = [
        "1e300",
        "-1e300",
        "-1",
        "0",
        "99",
        "100000",
        "18446744073709551616",
        "1e-300",
        "Free",
        "R1A",
        "Body1",
        "#",
    ];
    for _ in 0..400 {
        let mut bytes = decks[chance.below(decks.len())].as_bytes().to_vec();
        match chance.below(5) {
            0 => bytes.truncate(chance.below(bytes.len())),
            1 => {
                for _ in 0..=chance.below(20) {
                    let at = chance.below(bytes.len());
                    bytes[at] = u8::try_from(chance.below(256)).unwrap();
                }
            }
            2 => {
                let text = String::from_utf8(bytes).unwrap();
                let mut lines: Vec<&str> = text.lines().collect();
                let (a, b) = (chance.below(lines.len()), chance.below(lines.len()));
                lines.swap(a, b);
                bytes = lines.join("\n").into_bytes();
            }
            3 => {
                let text = String::from_utf8(bytes).unwrap();
                let lines: Vec<&str> = text.lines().collect();
                let drop = chance.below(lines.len());
                let kept = lines.iter().enumerate().filter(|(number, _)| *number != drop);
                bytes = kept
                    .map(|(_, line)| *line)
                    .collect::<Vec<_>>()
                    .join("\n")
                    .into_bytes();
            }
            _ => {
                let text = String::from_utf8(bytes).unwrap();
                let cells = number_cells(&text);
                let cell = cells[chance.below(cells.len())];
                bytes = with_word(&text, cell, extremes[chance.below(extremes.len())]).into_bytes();
            }
        }
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
        assert!(error.contains("input"), "{error}");
    }
    let loops = with(
        OPENFAST,
        "1        chain        1         4",
        "1        chain        1         1",
    );
    assert!(said(&loops).contains("both ends are at `point1`"));
    let loose = with(
        OPENFAST,
        "4    vessel      20.0      0.0     -10.0    0     0    0    0",
        "4 vessel 20 0 -10 0 0 0 0\n9 Free 0 0 -5 1 0 0 0",
    );
    assert!(
        said(&loose).starts_with("input:16:1: point 9: no line ends at this free point"),
        "{}",
        said(&loose)
    );
    let adrift = with(OPENFAST, "4    vessel ", "4    free ");
    let adrift = with(&adrift, "1    fixed ", "1    free ");
    assert!(
        said(&adrift).starts_with("input:21:1: line 1: nothing holds this line"),
        "{}",
        said(&adrift)
    );
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
