//! The reference of the scene format in `docs/scene.md` is generated from the property table. After an intended change, regenerate it:
//! `MOORLINE_UPDATE=1 cargo test --test keys page`.

use std::collections::BTreeSet;
use std::path::Path;

use moorline::scene::keys::{choices, tables};
use moorline::scene::page::reference;
use moorline::scene::table::Kind;

const HEADING: &str = "\n## Every key\n";

fn page() -> (std::path::PathBuf, String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene.md");
    let text = std::fs::read_to_string(&path).unwrap();
    (path, text)
}

#[test]
fn the_reference_of_the_page_is_that_of_the_property_table() {
    let (path, text) = page();
    let (before, committed) = text.split_once(HEADING).expect("the page has the heading");
    let written = format!("\n{}", reference());
    if std::env::var_os("MOORLINE_UPDATE").is_some() {
        std::fs::write(&path, format!("{before}{HEADING}{written}")).unwrap();
        return;
    }
    for (committed, written) in committed.lines().zip(written.lines()) {
        assert_eq!(committed, written);
    }
    assert_eq!(committed.len(), written.len(), "lines are missing at the end");
}

#[test]
fn every_key_has_a_text_and_a_row_and_every_number_a_unit() {
    let page = reference();
    for table in tables() {
        for key in table.keys {
            let (name, text) = (key.name(), key.text());
            let place = format!("{}.{name}", table.name);
            assert!(text.len() > 5 && text.contains(['.', ';']), "{place}: {text:?}");
            assert!(page.contains(&format!("| `{name}`")), "{place}");
            let numeric = matches!(
                key.kind(),
                Kind::Number | Kind::Numbers | Kind::Count | Kind::NumberOrTable(_)
            );
            // the numbers of a function of time have the unit of the load that it describes
            let has_unit = key.unit().is_some() || table.name == "FunctionText";
            assert!(!numeric || has_unit, "{place} has no unit");
        }
    }
    for (key, choice) in choices() {
        assert!(!choice.words.is_empty(), "{}", key.name()); // `flow` has only one so far
        assert!(choice.words.iter().all(|(_, meaning)| !meaning.trim().is_empty()));
    }
}

#[test]
fn every_key_in_an_example_of_the_page_is_one_of_the_reader() {
    let keys = tables().into_iter().flat_map(|table| table.keys);
    let keys = keys.flat_map(|key| [Some(key.name()), key.rule.alias]).flatten();
    let words = choices()
        .into_iter()
        .flat_map(|(_, choice)| choice.words)
        .map(|(word, _)| *word);
    let known: BTreeSet<&str> = keys.chain(words).collect();
    let (_, text) = page();
    let blocks = text
        .split("```toml\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next());
    for line in blocks.flat_map(str::lines) {
        let commented = line.trim_start_matches("# ");
        let code = commented.split('#').next().unwrap_or_default();
        for before in code.split('=').rev().skip(1) {
            let key = before.rsplit([' ', '{', ',', '.']).find(|word| !word.is_empty());
            let key = key.unwrap_or_default();
            // a motion has the name of the point or vessel that it moves
            assert!(
                known.contains(key) || ["fairlead", "platform"].contains(&key),
                "{line}"
            );
        }
    }
}
