//! All keys and words of the scene format, for tests and pages.

use super::Scene;
use super::table::{Key, Kind, Table};
pub use super::table::{Schema, Words};

/// Every table of the scene format, from the scene itself inwards; each once.
pub fn tables() -> Vec<Schema> {
    let mut found = Vec::new();
    collect(Scene::SCHEMA, &mut found);
    found
}

fn collect(schema: Schema, found: &mut Vec<Schema>) {
    if found.iter().any(|known| known.name == schema.name) {
        return;
    }
    found.push(schema);
    for key in schema.keys {
        if let Kind::Table(inner) | Kind::ByName(inner) | Kind::NumberOrTable(inner) = key.kind() {
            collect(inner, found);
        }
    }
}

/// Every choice of words of the scene format with a key that takes it; each once.
pub fn choices() -> Vec<(&'static Key, Words)> {
    let mut found: Vec<(&Key, Words)> = Vec::new();
    for key in tables().iter().flat_map(|table| table.keys) {
        if let Kind::Words(words) = key.kind()
            && found.iter().all(|(_, known)| known.name != words.name)
        {
            found.push((key, words));
        }
    }
    found
}

/// Table with a header such as `line_types.chain.rayleigh`; the scene for an empty header.
pub(super) fn table(header: &str) -> Option<Schema> {
    let mut table = Scene::SCHEMA;
    let mut steps = header.split('.').filter(|step| !step.is_empty());
    while let Some(step) = steps.next() {
        table = match table.key(step)?.kind() {
            Kind::Table(inner) | Kind::NumberOrTable(inner) => inner,
            Kind::ByName(inner) => {
                steps.next()?;
                inner
            }
            _ => return None,
        };
    }
    Some(table)
}
