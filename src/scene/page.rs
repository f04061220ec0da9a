//! The reference in `docs/scene.md`: a section for every table and a row for every key, written from the property table.

use super::check::{Bounds, number};
use super::keys::{self, Schema};
use super::table::{Key, Kind};

/// Returns the reference as Markdown.
pub fn reference() -> String {
    let tables = keys::tables();
    let mut sections: Vec<String> = tables.iter().map(section).collect();
    for (key, choice) in keys::choices() {
        let rows = choice
            .words
            .iter()
            .map(|(word, meaning)| row(&[&format!("`{word}`"), meaning.trim()]));
        let rows: String = rows.collect();
        sections.push(format!(
            "### Words of `{}`\n\n| word | meaning |\n|---|---|\n{rows}",
            key.name()
        ));
    }
    sections.join("\n")
}

fn section(table: &Schema) -> String {
    let about: Vec<&str> = table.doc.iter().map(|line| line.trim()).collect();
    let defaults = (table.defaults)();
    let rows = table.keys.iter().zip(&defaults).map(|(key, default)| {
        let alias = key
            .rule
            .alias
            .map_or_else(String::new, |alias| format!(", `{alias}`"));
        let default = default.as_ref().filter(|_| !key.is_required());
        let name = format!("`{}`{alias}", key.name());
        row(&[&name, &value(key, default), &meaning(key)])
    });
    let rows: String = rows.collect();
    let (title, about) = (table.title, about.join(" "));
    format!("### In {title}\n\n{about}\n\n| key | value | meaning |\n|---|---|---|\n{rows}")
}

fn row(cells: &[&str]) -> String {
    let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}

/// Type, unit, bounds and default of a key.
fn value(key: &Key, default: Option<&toml::Value>) -> String {
    let kind = match key.kind() {
        Kind::Number => "number",
        Kind::Numbers => "numbers",
        Kind::Count => "whole number",
        Kind::Truth => "true or false",
        Kind::Text => "text",
        Kind::Words(_) => "word",
        Kind::Table(_) => "table",
        Kind::ByName(_) => "tables by name",
        Kind::NumberOrTable(_) => "number or table",
    };
    let unit = key.unit().map_or_else(String::new, |unit| format!(" [{unit}]"));
    let bounds = match key.rule.bounds {
        Bounds::Positive(limit) => format!(", above 0, up to {}", number(limit)),
        Bounds::NotNegative(limit) => format!(", 0 to {}", number(limit)),
        Bounds::Magnitude(limit) => format!(", -{0} to {0}", number(limit)),
        Bounds::Within(least, most) => format!(", {} to {}", number(least), number(most)),
        Bounds::Finite | Bounds::Elsewhere => String::new(),
    };
    let default = match default {
        None | Some(toml::Value::Table(_)) => String::new(),
        Some(default) => format!("; default `{default}`"),
    };
    let required = if key.is_required() { "; required" } else { "" };
    format!("{kind}{unit}{bounds}{required}{default}")
}

/// Doc comment of a key, the usual range, names in other programs and the role in the FMU.
fn meaning(key: &Key) -> String {
    let mut text = key.text();
    if let Some((_, note)) = key.rule.usual {
        text += &format!(" In moorings, {note}.");
    }
    if !key.rule.spellings.is_empty() {
        let names: Vec<String> = key
            .rule
            .spellings
            .iter()
            .map(|name| format!("`{name}`"))
            .collect();
        text += &format!(" Called {} in other programs.", names.join(", "));
    }
    if key.rule.is_parameter {
        text += " A parameter of the FMU.";
    }
    text
}
