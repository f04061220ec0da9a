//! Text -> what a MAP++ file says, in its own terms.

use std::collections::BTreeMap;

use crate::scene::nearest::nearest;
use crate::scene::rows::{
    Cells, Column, Field, Findings, Placed, ROWS_MAX, Row, compare_header, number, shown,
};

/// A whole deck.
#[derive(Debug, Default)]
pub(super) struct Deck {
    pub title: String,
    pub line_types: Vec<LineType>,
    pub nodes: Vec<Node>,
    pub lines: Vec<Line>,
    /// Angles by which the whole is repeated about z [deg].
    pub repeat: Vec<Placed<f64>>,
    /// Options that need nothing here.
    pub unneeded: Vec<Placed<String>>,
}

/// A row of LINE DICTIONARY.
#[derive(Debug)]
pub(super) struct LineType {
    pub name: Placed<String>,
    /// Diam [m].
    pub diameter: Placed<f64>,
    /// MassDenInAir [kg/m].
    pub mass: Placed<f64>,
    /// EA [N].
    pub stiffness: Placed<f64>,
    /// CB, friction on the bed [-].
    pub friction: Placed<f64>,
}

/// Who moves a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Fix,
    Connect,
    Vessel,
}

/// A coordinate of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Coordinate {
    /// Metres; a first guess where the forces decide [m].
    Given(f64),
    /// The bed.
    Depth,
}

/// A row of NODE PROPERTIES.
#[derive(Debug)]
pub(super) struct Node {
    pub id: Placed<usize>,
    pub kind: Placed<Kind>,
    pub position: [Placed<Coordinate>; 3],
    /// M [kg].
    pub mass: Placed<f64>,
    /// B [m³].
    pub volume: Placed<f64>,
    /// FX, FY, FZ [N], of nodes that the forces move.
    pub force: [Placed<f64>; 3],
}

/// A row of LINE PROPERTIES.
#[derive(Debug)]
pub(super) struct Line {
    pub id: Placed<usize>,
    pub line_type: Placed<String>,
    /// UnstrLen [m].
    pub length: Placed<f64>,
    /// NodeAnch, NodeFair.
    pub ends: [Placed<usize>; 2],
    /// The line meets no bed.
    pub omits_contact: Option<Placed<String>>,
}

const LINE_TYPES: &[Column] = &[
    column("LineType", "-", &["LINETYPE"]),
    column("Diam", "m", &["DIAM"]),
    column("MassDenInAir", "kg/m", &["MASSDENINAIR", "MASSDEN"]),
    column("EA", "N", &["EA"]),
    column("CB", "-", &["CB"]),
    column("CIntDamp", "-", &["CINTDAMP"]),
    column("Ca", "-", &["CA"]),
    column("Cdn", "-", &["CDN"]),
    column("Cdt", "-", &["CDT"]),
];

const NODES: &[Column] = &[
    column("Node", "-", &["NODE"]),
    column("Type", "-", &["TYPE"]),
    column("X", "m", &["X"]),
    column("Y", "m", &["Y"]),
    column("Z", "m", &["Z"]),
    column("M", "kg", &["M"]),
    column("B", "m³", &["B", "V"]),
    column("FX", "N", &["FX"]),
    column("FY", "N", &["FY"]),
    column("FZ", "N", &["FZ"]),
];

const LINES: &[Column] = &[
    column("Line", "-", &["LINE", "ELEMENT"]),
    column("LineType", "-", &["LINETYPE"]),
    column("UnstrLen", "m", &["UNSTRLEN"]),
    column("NodeAnch", "-", &["NODEANCH"]),
    column("NodeFair", "-", &["NODEFAIR"]),
];

/// Flags in capitals that choose what MAP++ writes.
const OUTPUT_FLAGS: &[&str] = &[
    "PLOT",
    "GX_POS",
    "GY_POS",
    "GZ_POS",
    "GX_A_POS",
    "GY_A_POS",
    "GZ_A_POS",
    "GX_FORCE",
    "GY_FORCE",
    "GZ_FORCE",
    "H_FAIR",
    "H_ANCH",
    "V_FAIR",
    "V_ANCH",
    "TENSION_FAIR",
    "TENSION_ANCH",
    "X_EXCURSION",
    "Z_EXCURSION",
    "AZIMUTH",
    "ALTITUDE",
    "ALTITUDE_ANCH",
    "ALTITUDE_A",
    "LINE_TENSION",
    "LAY_LENGTH",
    "DIAGNOSTIC",
    "X_POS",
    "Y_POS",
    "Z_POS",
    "X_FORCE",
    "Y_FORCE",
    "Z_FORCE",
    "FAIR_TENSION",
    "ANCH_TENSION",
];

/// Options in capitals that choose how MAP++ solves.
const UNNEEDED: &[&str] = &[
    "HELP",
    "INNER_FTOL",
    "INNER_GTOL",
    "INNER_XTOL",
    "INNER_MAX_ITS",
    "OUTER_MAX_ITS",
    "OUTER_TOL",
    "OUTER_EPSILON",
    "OUTER_BD",
    "OUTER_CD",
    "OUTER_FD",
    "INTEGRATION_DT",
    "KB_DEFAULT",
    "CB_DEFAULT",
    "LM_MODEL",
    "PG_COOKED",
    "KRYLOV_ACCELERATOR",
    "REF_POSITION",
    "WAVE_KINEMATICS",
    "SEG_SIZE",
    "MSQS_TOL",
    "FD_EPSILON",
];

const fn column(name: &'static str, unit: &'static str, spellings: &'static [&'static str]) -> Column {
    Column {
        name,
        unit,
        spellings,
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Table {
    LineTypes,
    Nodes,
    Lines,
    Options,
    /// No section of MAP++.
    Other,
}

impl Table {
    const NEEDED: [Table; 3] = [Table::LineTypes, Table::Nodes, Table::Lines];

    fn of_header(row: &Row<'_>) -> Option<Table> {
        if !row.text.contains("---") {
            return None;
        }
        let upper = row.text.to_uppercase();
        let has = |words: &[&str]| words.iter().any(|word| upper.contains(word));
        Some(if has(&["LINE DICTIONARY", "LINE TYPES"]) {
            Table::LineTypes
        } else if has(&["NODE PROPERTIES", "NODES"]) {
            Table::Nodes
        } else if has(&["LINE PROPERTIES", "LINES", "ELEMENT PROPERTIES"]) {
            Table::Lines
        } else if has(&["OPTIONS"]) {
            Table::Options
        } else {
            Table::Other
        })
    }

    fn name(self) -> &'static str {
        match self {
            Table::LineTypes => "LINE DICTIONARY",
            Table::Nodes => "NODE PROPERTIES",
            Table::Lines => "LINE PROPERTIES",
            Table::Options => "SOLVER OPTIONS",
            Table::Other => "",
        }
    }
}

/// A header and the rows below it.
struct Section<'t> {
    table: Table,
    header: Row<'t>,
    rows: Vec<Row<'t>>,
}

/// Cuts a text at its headers; what stands above the first is the title.
fn sections(text: &str) -> (Vec<Row<'_>>, Vec<Section<'_>>) {
    let mut title = Vec::new();
    let mut sections: Vec<Section<'_>> = Vec::new();
    for row in Row::all(text) {
        if let Some(table) = Table::of_header(&row) {
            sections.push(Section {
                table,
                header: row,
                rows: Vec::new(),
            });
        } else if let Some(section) = sections.last_mut() {
            section.rows.push(row);
        } else {
            title.push(row);
        }
    }
    (title, sections)
}

/// Whether a text is a MAP++ file: its nodes have the ten columns that only MAP++ has.
pub(in crate::scene) fn is_deck(text: &str) -> bool {
    let (_, sections) = sections(text);
    let nodes = sections.iter().find(|section| section.table == Table::Nodes);
    let Some(nodes) = nodes.filter(|section| section.header.text.trim_start().starts_with("---")) else {
        return false;
    };
    let mut options = sections.iter().filter(|section| section.table == Table::Options);
    let key_first = |row: &Row<'_>| {
        let key = row.fields().first().map(|field| field.text.to_uppercase());
        key.is_some_and(|key| key == "REPEAT" || UNNEEDED.contains(&key.as_str()))
    };
    let options_of_map = options.any(|section| section.rows.iter().any(key_first));
    options_of_map || nodes.rows.iter().skip(2).take(ROWS_MAX).any(is_node_of_map)
}

/// A row of nodes that MoorDyn cannot mean: the bed as a word, or forces to be found.
fn is_node_of_map(row: &Row<'_>) -> bool {
    let fields = row.fields();
    let text = |column: usize| fields.get(column).map_or("", |field: &Field<'_>| field.text);
    let depth = text(4).eq_ignore_ascii_case("depth");
    let iterated = [2, 3, 4].iter().any(|column| text(*column).starts_with('#'));
    let forces = fields.len() >= 10 && [7, 8, 9].iter().all(|column| text(*column).starts_with('#'));
    depth || iterated || forces
}

/// Reads a deck.
pub(super) fn read(text: &str, findings: &mut Findings) -> Deck {
    let (title, sections) = sections(text);
    let words = title.iter().flat_map(Row::fields).map(|field| field.text);
    let title: String = words.collect::<Vec<_>>().join(" ");
    let mut deck = Deck {
        title: title.chars().filter(|c| !c.is_control()).take(200).collect(),
        ..Deck::default()
    };
    for table in Table::NEEDED {
        let found = sections.iter().filter(|section| section.table == table);
        if found.clone().all(|section| section.rows.len() <= 2) {
            let problem = format!("no rows of {}: a file needs them", table.name());
            findings.mistake("", 0..0, problem);
        } else if let Some(second) = found.clone().nth(1) {
            let problem = format!("a second section {}", table.name());
            findings.mistake("", second.header.span(), problem);
        }
    }
    for section in &sections {
        if let Some(row) = section.rows.get(ROWS_MAX) {
            let problem = format!("more than {ROWS_MAX} rows in {}", section.table.name());
            findings.mistake("", row.span(), problem);
        }
        match section.table {
            Table::Options => options(section, &mut deck, findings),
            Table::Other => unknown_section(section, &sections, findings),
            _ => table(section, &mut deck, findings),
        }
    }
    check_numbers(&deck, findings);
    deck
}

/// Rows below a header that heads nothing, save the first, which may be a title.
fn unknown_section(section: &Section<'_>, all: &[Section<'_>], findings: &mut Findings) {
    let first = all.first().is_some_and(|first| std::ptr::eq(first, section));
    if !first && !section.rows.is_empty() {
        let problem =
            "unknown section; known are LINE DICTIONARY, NODE PROPERTIES, LINE PROPERTIES and SOLVER OPTIONS";
        findings.mistake("", section.header.span(), problem);
    }
}

fn table(section: &Section<'_>, deck: &mut Deck, findings: &mut Findings) {
    let columns = match section.table {
        Table::LineTypes => LINE_TYPES,
        Table::Nodes => NODES,
        _ => LINES,
    };
    if let Some(header) = section.rows.first() {
        compare_header(header, columns, findings);
    }
    for (index, row) in section.rows.iter().skip(2).take(ROWS_MAX).enumerate() {
        let fields = row.fields();
        let place = format!("{}, row {}", section.table.name(), index + 1);
        if fields.len() < columns.len() {
            let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
            let problem = format!(
                "{} columns, expected {} ({})",
                fields.len(),
                columns.len(),
                names.join(" ")
            );
            findings.mistake(place, row.span(), problem);
            continue;
        }
        let mut cells = Cells {
            place,
            fields: &fields,
            columns,
            findings,
        };
        match section.table {
            Table::LineTypes => deck.line_types.push(line_type(&mut cells)),
            Table::Nodes => deck.nodes.push(node(&mut cells)),
            _ => deck.lines.push(line(&mut cells)),
        }
    }
}

fn line_type(cells: &mut Cells<'_, '_>) -> LineType {
    LineType {
        name: cells.word(0),
        diameter: cells.number(1),
        mass: cells.number(2),
        stiffness: cells.number(3),
        friction: cells.number(4),
    }
}

fn node(cells: &mut Cells<'_, '_>) -> Node {
    let word = cells.word(1);
    let kind = match word.value.to_uppercase().as_str() {
        "FIX" | "FIXED" => Kind::Fix,
        "CONNECT" => Kind::Connect,
        "VESSEL" => Kind::Vessel,
        _ => {
            cells.wrong(
                1,
                format!("expected fix, connect or vessel, found {}", shown(&word.value)),
            );
            Kind::Fix
        }
    };
    let force = if kind == Kind::Connect {
        [7, 8, 9].map(|column| iterated(cells, column))
    } else {
        // What holds the node finds these.
        [7, 8, 9].map(|column| Placed {
            value: 0.0,
            span: cells.span(column),
        })
    };
    Node {
        id: cells.count(0, 1),
        kind: Placed {
            value: kind,
            span: word.span,
        },
        position: [2, 3, 4].map(|column| coordinate(cells, column)),
        mass: iterated(cells, 5),
        volume: iterated(cells, 6),
        force,
    }
}

/// A number with or without the sign that it is to be found; nothing but the sign is zero.
fn iterated(cells: &mut Cells<'_, '_>, column: usize) -> Placed<f64> {
    let text = cells.fields[column].text;
    let value = match text.strip_prefix('#') {
        Some("") => Ok(0.0),
        Some(rest) => number(rest),
        None => number(text),
    };
    Placed {
        value: value.unwrap_or_else(|problem| {
            cells.wrong(column, problem);
            0.0
        }),
        span: cells.span(column),
    }
}

fn coordinate(cells: &mut Cells<'_, '_>, column: usize) -> Placed<Coordinate> {
    let text = cells.fields[column].text;
    if column == 4 && text.trim_start_matches('#').eq_ignore_ascii_case("depth") {
        return Placed {
            value: Coordinate::Depth,
            span: cells.span(column),
        };
    }
    let number = iterated(cells, column);
    Placed {
        value: Coordinate::Given(number.value),
        span: number.span,
    }
}

fn line(cells: &mut Cells<'_, '_>) -> Line {
    let mut omits_contact = None;
    for flag in &cells.fields[LINES.len()..] {
        let upper = flag.text.to_uppercase();
        let at = format!("{}, flags", cells.place);
        match upper.as_str() {
            "OMIT_CONTACT" => {
                omits_contact = Some(Placed {
                    value: flag.text.to_string(),
                    span: flag.span.clone(),
                });
            }
            "LINEAR_SPRING" => {
                let problem = "a line as a linear spring is not modelled: give its EA and length";
                cells.findings.mistake(at, flag.span.clone(), problem);
            }
            "DAMAGE_TIME" => {
                let problem = "lines that come off are not modelled: take the flag and its time out";
                cells.findings.mistake(at, flag.span.clone(), problem);
            }
            _ if OUTPUT_FLAGS.contains(&upper.as_str()) => {}
            _ => {
                let known = OUTPUT_FLAGS.iter().copied().chain(["OMIT_CONTACT"]);
                let meant =
                    nearest(&upper, known).map_or(String::new(), |flag| format!(", did you mean {flag}?"));
                let problem = format!("unknown flag {}{meant}", shown(flag.text));
                cells.findings.mistake(at, flag.span.clone(), problem);
            }
        }
    }
    Line {
        id: cells.count(0, 1),
        line_type: cells.word(1),
        length: cells.number(2),
        ends: [cells.count(3, 1), cells.count(4, 1)],
        omits_contact,
    }
}

fn options(section: &Section<'_>, deck: &mut Deck, findings: &mut Findings) {
    for row in section.rows.iter().skip(2).take(ROWS_MAX) {
        if row.text.starts_with([' ', '\t', '!', '#']) {
            let text = format!(
                "{} is a comment, as it begins with a blank or a mark",
                shown(row.text.trim())
            );
            findings.remark(row.span().start, text);
            continue;
        }
        let fields = row.fields();
        let [key, values @ ..] = fields.as_slice() else {
            continue;
        };
        let upper = key.text.to_uppercase();
        if upper == "REPEAT" {
            for value in values {
                match number(value.text) {
                    Ok(angle) => deck.repeat.push(Placed {
                        value: angle,
                        span: value.span.clone(),
                    }),
                    Err(problem) => findings.mistake("repeat", value.span.clone(), problem),
                }
            }
        } else if UNNEEDED.contains(&upper.as_str()) {
            deck.unneeded.push(Placed {
                value: key.text.to_string(),
                span: key.span.clone(),
            });
        } else {
            let known = UNNEEDED.iter().copied().chain(["REPEAT"]);
            let meant = nearest(&upper, known).map_or(String::new(), |key| format!(", did you mean {key}?"));
            let problem = format!("unknown option {}{meant}", shown(key.text));
            findings.mistake("SOLVER OPTIONS", key.span.clone(), problem);
        }
    }
}

/// Numbers and names that differ, and those that lines speak of.
fn check_numbers(deck: &Deck, findings: &mut Findings) {
    let mut nodes = BTreeMap::new();
    for node in &deck.nodes {
        if nodes.insert(node.id.value, ()).is_some() {
            let problem = format!("a second node {}: take another number", node.id.value);
            findings.mistake(format!("node {}", node.id.value), node.id.span.clone(), problem);
        }
    }
    let mut types = BTreeMap::new();
    for kind in &deck.line_types {
        if types.insert(kind.name.value.as_str(), ()).is_some() {
            let problem = format!("a second line type {}", shown(&kind.name.value));
            findings.mistake("LINE DICTIONARY", kind.name.span.clone(), problem);
        }
    }
    let mut lines = BTreeMap::new();
    for line in &deck.lines {
        let at = format!("line {}", line.id.value);
        if lines.insert(line.id.value, ()).is_some() {
            let problem = format!("a second line {}: take another number", line.id.value);
            findings.mistake(at.clone(), line.id.span.clone(), problem);
        }
        if !types.contains_key(line.line_type.value.as_str()) {
            let problem = format!("no line type is called {}", shown(&line.line_type.value));
            findings.mistake(at.clone(), line.line_type.span.clone(), problem);
        }
        for end in line.ends.iter().filter(|end| !nodes.contains_key(&end.value)) {
            let problem = format!("no node has the number {}", end.value);
            findings.mistake(at.clone(), end.span.clone(), problem);
        }
    }
}
