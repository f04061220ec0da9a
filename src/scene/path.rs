//! Key paths such as `lines[0].sections[1].length`, and the bytes of the text that they refer to.

use std::fmt::Write;
use std::ops::Range;

use toml::Spanned;
use toml::de::DeValue;

/// One step from a table or array to a value in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Step<'s> {
    /// A key of a table.
    Key(&'s str),
    /// An index in an array, from 0.
    Index(usize),
}

fn is_bare(key: &str) -> bool {
    !key.is_empty()
        && key
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// A key as written in TOML: quoted where necessary.
pub fn quoted(key: &str) -> String {
    if is_bare(key) {
        key.to_string()
    } else {
        format!("{key:?}")
    }
}

/// Appends a step to a path.
pub(super) fn push(path: &mut String, step: Step<'_>) {
    match step {
        Step::Key(key) if path.is_empty() => *path = quoted(key),
        Step::Key(key) => {
            path.push('.');
            path.push_str(&quoted(key));
        }
        Step::Index(index) => write!(path, "[{index}]").expect("a String takes all"),
    }
}

/// Keys whose values may be read from the `file` of the same table.
const IN_FILE: [&str; 3] = [".profile", ".components", ".grid"];

/// Path of the `file` that holds the value at a path, if the text gives the file instead of the value.
pub(super) fn file_of(root: &Spanned<DeValue<'_>>, path: &str) -> Option<String> {
    let holder = IN_FILE
        .iter()
        .find_map(|key| path.split_once(key))
        .map(|(holder, _)| holder)?;
    let held = |key: &str| locate(root, &format!("{holder}{key}"));
    let (own, file) = (held(&path[holder.len()..]), held(".file"));
    (file != own && own == locate(root, holder)).then(|| format!("{holder}.file"))
}

/// Bytes of the value at a path; if there is none, those of the last value on the way.
pub(super) fn locate(root: &Spanned<DeValue<'_>>, path: &str) -> Option<Range<usize>> {
    let mut span = None;
    let mut table = root.get_ref().as_table();
    let mut array = None;
    let mut rest = path;
    while let Some((key, index, after)) = next_step(rest) {
        rest = after;
        let found: Option<&Spanned<DeValue<'_>>> = match index {
            None => table.and_then(|table| table.get(key.as_str())),
            Some(index) => array.and_then(|array: &toml::de::DeArray<'_>| array.get(index)),
        };
        let Some(value) = found else { break };
        span = Some(value.span());
        table = value.get_ref().as_table();
        array = value.get_ref().as_array();
    }
    span
}

/// Splits the first step off a path: a key, or an index with an empty key.
fn next_step(path: &str) -> Option<(String, Option<usize>, &str)> {
    let path = path.strip_prefix('.').unwrap_or(path);
    if let Some(inside) = path.strip_prefix('[') {
        let (index, rest) = inside.split_once(']')?;
        return Some((String::new(), Some(index.parse().ok()?), rest));
    }
    if path.starts_with('"') {
        let (key, rest) = split_quoted(path)?;
        return Some((key, None, rest));
    }
    let end = path.find(['.', '[']).unwrap_or(path.len());
    (end > 0).then(|| (path[..end].to_string(), None, &path[end..]))
}

/// Splits a quoted key off a path and reverses [`quoted`]: TOML has the same escapes.
fn split_quoted(path: &str) -> Option<(String, &str)> {
    let mut escaped = false;
    let end = path.char_indices().skip(1).find_map(|(at, c)| {
        let closes = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        closes.then_some(at + 1)
    })?;
    let value = DeValue::parse(&path[..end]).ok()?;
    Some((value.get_ref().as_str()?.to_string(), &path[end..]))
}

/// Line and column of a byte of the text, both from 1; columns count characters.
pub fn line_column(text: &str, byte: usize) -> (usize, usize) {
    let mut byte = byte.min(text.len());
    while !text.is_char_boundary(byte) {
        byte -= 1;
    }
    let before = &text[..byte];
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count());
    (line, column + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_finds_the_value_it_names() {
        let text = "[a]\nb = [1, { c = 2.5 }]\n\"x.y\" = 7\n";
        let table = toml::de::DeTable::parse(text).unwrap();
        let root = Spanned::new(table.span(), DeValue::Table(table.into_inner()));
        let at = |path: &str| locate(&root, path).map(|span| &text[span]);
        assert_eq!(at("a.b[1].c"), Some("2.5"));
        assert_eq!(at("a.\"x.y\""), Some("7"));
        assert_eq!(at("a.b[0]"), Some("1"));
        assert_eq!(at("a.b[1].missing"), Some("{ c = 2.5 }"));
        assert_eq!(at("nowhere"), None);
    }

    #[test]
    fn a_rendered_path_is_read_back() {
        let steps = [
            Step::Key("a b"),
            Step::Index(3),
            Step::Key("q\"\\"),
            Step::Key("plain"),
        ];
        let mut path = String::new();
        steps.into_iter().for_each(|step| push(&mut path, step));
        let mut rest = path.as_str();
        for step in steps {
            let (key, index, after) = next_step(rest).unwrap();
            match step {
                Step::Key(known) => assert_eq!((key.as_str(), index), (known, None)),
                Step::Index(known) => assert_eq!(index, Some(known)),
            }
            rest = after;
        }
        assert!(next_step(rest).is_none());
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(line_column("a\nü x", 4), (2, 2));
        assert_eq!(line_column("", 5), (1, 1));
    }
}
