//! Division of a deck into sections at its headers.

use moorline::scene::rows::{Row, shown};

use crate::findings::{Findings, Placed};
use crate::table::{begins_section, check_heading, is_one_of};

/// Kind of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    LineTypes,
    RodTypes,
    Bodies,
    Rods,
    Points,
    Lines,
    Failure,
    Control,
    ExternalLoads,
    Options,
    Outputs,
}

/// Marks of comments, which reach to the end of the row.
const COMMENTS: [char; 3] = ['#', '!', '%'];

/// Kinds, their names in messages, and the words of their headers in capitals; the first match counts, as in MoorDyn.
const KINDS: [(Kind, &str, &[&str]); 11] = [
    (Kind::LineTypes, "LINE TYPES", &["LINE DICTIONARY", "LINE TYPES"]),
    (Kind::RodTypes, "ROD TYPES", &["ROD DICTIONARY", "ROD TYPES"]),
    (
        Kind::Bodies,
        "BODIES",
        &["BODIES", "BODY LIST", "BODY PROPERTIES"],
    ),
    (Kind::Rods, "RODS", &["RODS", "ROD LIST", "ROD PROPERTIES"]),
    (
        Kind::Points,
        "POINTS",
        &[
            "POINTS",
            "POINT LIST",
            "POINT PROPERTIES",
            "CONNECTION",
            "NODE PROPERTIES",
            "NODE LIST",
        ],
    ),
    (Kind::Lines, "LINES", &["LINES", "LINE LIST", "LINE PROPERTIES"]),
    (Kind::ExternalLoads, "EXTERNAL LOADS", &["EXTERNAL LOADS"]),
    (Kind::Control, "CONTROL", &["CONTROL"]),
    (Kind::Failure, "FAILURE", &["FAILURE"]),
    (Kind::Options, "OPTIONS", &["OPTIONS"]),
    (Kind::Outputs, "OUTPUTS", &["OUTPUT"]),
];

impl Kind {
    /// Name in messages.
    pub(super) fn name(self) -> &'static str {
        let mut kinds = KINDS.iter();
        kinds
            .find(|(kind, ..)| *kind == self)
            .map_or("", |(_, name, _)| name)
    }

    /// Returns whether the two lines below the header name columns and units.
    fn is_table(self) -> bool {
        !matches!(self, Kind::Options | Kind::Outputs)
    }

    /// Returns the column that has a number in every row of a table.
    fn numbered(self) -> usize {
        match self {
            Kind::LineTypes | Kind::RodTypes => 1, // below the name of the type
            _ => 0,
        }
    }
}

/// Header and the rows below it, without comments.
#[derive(Debug)]
pub(super) struct Section<'t> {
    pub kind: Kind,
    pub header: Row<'t>,
    /// Number of rows, which decks of version 1 state below the header.
    count: Option<Placed<Option<usize>>>,
    /// Line with the names of the columns of a table.
    pub names: Option<Row<'t>>,
    /// Line with their units.
    pub units: Option<Row<'t>>,
    pub rows: Vec<Row<'t>>,
}

impl Section<'_> {
    /// Returns whether the lines below the header still lack the names or units of columns.
    fn lacks_units(&self) -> bool {
        self.kind.is_table() && self.units.is_none()
    }
}

/// Deck divided into sections.
#[derive(Debug, Default)]
pub(super) struct Sections<'t> {
    /// Rows above the first section.
    pub preamble: Vec<Row<'t>>,
    pub list: Vec<Section<'t>>,
}

impl<'t> Sections<'t> {
    /// Returns the section of a kind.
    pub(super) fn get(&self, kind: Kind) -> Option<&Section<'t>> {
        self.list.iter().find(|section| section.kind == kind)
    }

    /// Returns the rows of a kind; empty if the section is missing.
    pub(super) fn rows(&self, kind: Kind) -> &[Row<'t>] {
        self.get(kind).map_or(&[], |section| &section.rows)
    }
}

/// Returns the row without its comment. In the names and units of columns, a mark within a word, such as `(#)`, begins no comment.
fn without_comment<'t>(row: &Row<'t>, heads_columns: bool) -> Row<'t> {
    if !heads_columns {
        return row.before(&COMMENTS);
    }
    let mut fields = row.fields().into_iter();
    let comment = fields.find(|field| field.text.starts_with(COMMENTS));
    let end = comment.map_or(row.text.len(), |field| field.span.start - row.start);
    Row {
        text: row.text[..end].trim_end(),
        start: row.start,
    }
}

fn kind_of(text: &str) -> Option<Kind> {
    let upper = text.to_uppercase();
    let mut kinds = KINDS.iter();
    let known = kinds.find(|(.., words)| words.iter().any(|words| upper.contains(words)));
    known.map(|(kind, ..)| *kind)
}

/// Returns whether a text is a MoorDyn file, that is, has a header of such files.
pub(crate) fn is_deck(text: &str) -> bool {
    let mut rows = Row::all(text).map(|row| row.before(&COMMENTS));
    rows.any(|row| {
        let rule = row.text.trim_start().starts_with("---");
        rule && (kind_of(row.text).is_some() || row.text.to_uppercase().contains("MOORDYN"))
    })
}

/// Divides a deck at its headers.
pub(super) fn split<'t>(text: &'t str, findings: &mut Findings) -> Sections<'t> {
    let mut sections = Sections::default();
    // All rows below an unknown header count as one mistake.
    let mut unknown: Option<Row<'t>> = None;
    for whole in Row::all(text) {
        let heads_columns = sections.list.last().is_some_and(Section::lacks_units);
        let row = without_comment(&whole, heads_columns);
        if row.text.trim().is_empty() {
            continue;
        }
        let has_rule = row.text.contains("---");
        if has_rule && row.text.to_uppercase().contains("NEED THIS LINE") {
            break;
        }
        if has_rule && !sections.list.is_empty() && !begins_section(&row, |front| kind_of(front).is_some()) {
            let problem = "MoorDyn ends the section at a row with `---`, and neither this row nor those below it \
                           would be read: take the dashes out, or begin a header with them";
            findings.mistake("", row.span(), problem);
        } else if has_rule {
            unknown = begin(&mut sections, row, findings);
        } else if let Some(header) = &unknown {
            let problem = format!(
                "unknown section {}; known are LINE TYPES, ROD TYPES, BODIES, RODS, POINTS, LINES, FAILURE, CONTROL, \
                 EXTERNAL LOADS, OPTIONS and OUTPUTS",
                shown(header.text.trim_matches(['-', ' ']))
            );
            findings.mistake("", header.span(), problem);
            unknown = None;
        } else {
            match sections.list.last_mut() {
                None => sections.preamble.push(whole),
                Some(section) => add(section, row),
            }
        }
    }
    for section in &sections.list {
        for heading in [&section.names, &section.units].into_iter().flatten() {
            check_heading(section.kind.name(), heading, section.kind.numbered(), findings);
        }
        check_count(section, findings);
    }
    sections
}

/// Begins a section; returns the header if it is unknown.
fn begin<'t>(sections: &mut Sections<'t>, header: Row<'t>, findings: &mut Findings) -> Option<Row<'t>> {
    let Some(kind) = kind_of(header.text) else {
        // The title of the file looks like a header as well.
        return (!sections.list.is_empty()).then_some(header);
    };
    if sections.get(kind).is_some() {
        let problem = format!("a second section {}: write all of its rows in one", kind.name());
        findings.mistake(kind.name(), header.span(), problem);
    }
    sections.list.push(Section {
        kind,
        header,
        count: None,
        names: None,
        units: None,
        rows: Vec::new(),
    });
    None
}

/// Reads a row such as `3  NLines - number of lines`.
fn count(row: &Row<'_>) -> Option<Placed<Option<usize>>> {
    let fields = row.fields();
    let [value, key, ..] = fields.as_slice() else {
        return None;
    };
    let counted = "NTYPES NLINETYPES NCONNECTS NCONNECTIONS NPOINTS NLINES";
    is_one_of(key.text, counted).then(|| Placed {
        value: value.text.parse().ok(),
        span: value.span.clone(),
    })
}

fn add<'t>(section: &mut Section<'t>, row: Row<'t>) {
    let first = section.names.is_none() && section.count.is_none();
    if !section.kind.is_table() {
        section.rows.push(row);
    } else if let Some(count) = first.then(|| count(&row)).flatten() {
        section.count = Some(count);
    } else if section.names.is_none() {
        section.names = Some(row);
    } else if section.units.is_none() {
        section.units = Some(row);
    } else {
        section.rows.push(row);
    }
}

/// Checks the stated number of rows; MoorDyn v1 reads no rows beyond it.
fn check_count(section: &Section<'_>, findings: &mut Findings) {
    let Some(count) = &section.count else {
        return;
    };
    let problem = match count.value {
        Some(value) if value == section.rows.len() => return,
        Some(value) => {
            let rows = section.rows.len();
            format!("{value} rows are announced, and there are {rows}")
        }
        None => "expected the number of rows below".to_string(),
    };
    findings.wrong(section.kind.name(), count, problem);
}
