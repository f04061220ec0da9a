//! Assertions on texts: parts that they contain, and tables of cases.
//!
//! A table lists changes of a base text, each `old => new`, and below them, indented, the expected answer:
//!
//! ```text
//! # Claim of the cases below.
//!
//! mass = 100.0 => mass = -100.0
//!     11:8: line_types.chain.mass: -100 kg/m is negative
//! ```
//!
//! A line without `=>` is inserted before the base text; it is the whole text if the base is empty. `\n` means a line break. Answers that continue over
//! several lines are joined by blanks.
#![allow(dead_code)] // each test binary uses some of it

/// Asserts that a text contains all of these parts.
pub fn assert_says(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "`{part}` is not in: {text}");
    }
}

/// A case of a table.
struct Case {
    /// Heading above the case.
    claim: String,
    changes: Vec<[String; 2]>,
    words: String,
}

/// The cases of a table.
fn cases(table: &str) -> Vec<Case> {
    let mut claim = String::new();
    let mut found: Vec<Case> = Vec::new();
    for line in table.lines().filter(|line| !line.is_empty()) {
        if let Some(heading) = line.strip_prefix("# ") {
            claim = heading.to_string();
        } else if let Some(words) = line.strip_prefix("    ") {
            let last = &mut found.last_mut().expect("a change above its words").words;
            *last += if last.is_empty() { "" } else { " " };
            *last += &words.replace("\\n", "\n");
        } else {
            let (old, new) = line.split_once("=>").unwrap_or(("", line));
            let change = [old, new].map(|part| part.trim().replace("\\n", "\n"));
            match found.last_mut().filter(|case| case.words.is_empty()) {
                Some(case) => case.changes.push(change),
                None => found.push(Case {
                    claim: claim.clone(),
                    changes: vec![change],
                    words: String::new(),
                }),
            }
        }
    }
    found
}

/// Asserts that the answer to each case of a table begins with the expected words.
pub fn assert_answers(base: &str, table: &str, answer: impl Fn(&str) -> String) {
    let wrong = wrong_answers(base, table, answer);
    assert!(wrong.is_empty(), "{wrong}");
}

/// Returns the cases of a table with a different answer, with the expected and the actual words.
pub fn wrong_answers(base: &str, table: &str, answer: impl Fn(&str) -> String) -> String {
    let mut wrong = String::new();
    for Case {
        claim,
        changes,
        words,
    } in cases(table)
    {
        let changed = changes.iter().fold(base.to_string(), |text, [old, new]| {
            assert!(text.contains(old), "{claim}: {old:?} is not in the text");
            text.replacen(old, new, 1)
        });
        let found = answer(&changed);
        if !found.starts_with(&words) {
            wrong += &format!("{claim}\n  {changes:?}\n  found:  {found}\n  wanted: {words}\n");
        }
    }
    wrong
}
