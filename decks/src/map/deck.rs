//! Text -> typed rows of a MAP++ file.

use moorline::scene::rows::{Field, Row, number, shown};

use crate::findings::{Findings, Placed};
use crate::table::{
    Cells, Column, ROWS_MAX, begins_section, check_heading, check_unique, check_units, column,
    compare_header, is_one_of, left_out, placed_text, read_rows, title,
};

/// A whole deck.
#[derive(Debug, Default)]
pub(super) struct Deck {
    pub title: String,
    pub line_types: Vec<LineType>,
    pub nodes: Vec<Node>,
    pub lines: Vec<Line>,
    /// Angles by which the repetitions of the whole system are turned about z, from y to x [deg].
    pub repeat: Vec<Placed<f64>>,
    /// Options that have no effect here.
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
    /// CB, friction on the seabed [-].
    pub friction: Placed<f64>,
}

/// Kind of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Fix,
    Connect,
    Vessel,
}

/// A coordinate of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Coordinate {
    /// Coordinate [m]; an initial guess if forces determine it.
    Given(f64),
    /// z of the seabed.
    Depth,
}

/// A row of NODE PROPERTIES.
#[derive(Debug)]
pub(super) struct Node {
    pub id: Placed<usize>,
    pub kind: Kind,
    pub position: [Placed<Coordinate>; 3],
    /// M [kg].
    pub mass: Placed<f64>,
    /// B [m³].
    pub volume: Placed<f64>,
    /// FX, FY, FZ [N] of a node moved by forces; otherwise 0.
    pub force: [f64; 3],
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
    /// Flag of a line without seabed contact.
    pub omits_contact: Option<Placed<String>>,
}

const LINE_TYPES: &[Column] = &[
    column("LineType", "-", "LINETYPE"),
    column("Diam", "m", "DIAM"),
    column("MassDenInAir", "kg/m", "MASSDENINAIR MASSDEN"),
    column("EA", "N", "EA"),
    column("CB", "-", "CB"),
    column("CIntDamp", "-", "CINTDAMP"),
    column("Ca", "-", "CA"),
    column("Cdn", "-", "CDN"),
    column("Cdt", "-", "CDT"),
];

const NODES: &[Column] = &[
    column("Node", "-", "NODE"),
    column("Type", "-", "TYPE"),
    column("X", "m", "X"),
    column("Y", "m", "Y"),
    column("Z", "m", "Z"),
    column("M", "kg", "M"),
    column("B", "m³", "B V"),
    column("FX", "N", "FX"),
    column("FY", "N", "FY"),
    column("FZ", "N", "FZ"),
];

const LINES: &[Column] = &[
    column("Line", "-", "LINE ELEMENT"),
    column("LineType", "-", "LINETYPE"),
    column("UnstrLen", "m", "UNSTRLEN"),
    column("NodeAnch", "-", "NODEANCH"),
    column("NodeFair", "-", "NODEFAIR"),
];

/// Flags, in capitals, that control the output of MAP++.
const OUTPUT_FLAGS: &str = "PLOT GX_POS GY_POS GZ_POS GX_A_POS GY_A_POS GZ_A_POS GX_FORCE GY_FORCE GZ_FORCE H_FAIR H_ANCH \
    V_FAIR V_ANCH TENSION_FAIR TENSION_ANCH X_EXCURSION Z_EXCURSION AZIMUTH ALTITUDE ALTITUDE_ANCH \
    ALTITUDE_A LINE_TENSION LAY_LENGTH DIAGNOSTIC X_POS Y_POS Z_POS X_FORCE Y_FORCE Z_FORCE \
    FAIR_TENSION ANCH_TENSION";
/// Flag of a line without seabed contact.
const OMIT_CONTACT: &str = "OMIT_CONTACT";

/// Options, in capitals, that control the solution of MAP++.
const UNNEEDED: &str = "HELP INNER_FTOL INNER_GTOL INNER_XTOL INNER_MAX_ITS OUTER_MAX_ITS OUTER_TOL OUTER_EPSILON \
    OUTER_BD OUTER_CD OUTER_FD INTEGRATION_DT KB_DEFAULT CB_DEFAULT LM_MODEL PG_COOKED \
    KRYLOV_ACCELERATOR REF_POSITION WAVE_KINEMATICS SEG_SIZE MSQS_TOL FD_EPSILON";
/// Option that repeats the whole system about z.
const REPEAT: &str = "REPEAT";

/// Kind of a section, in the order in which headers are matched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Table {
    LineTypes,
    Nodes,
    Lines,
    Options,
    /// Not a section of MAP++.
    Other,
}

/// Kinds of sections, their names, and the words of their headers in capitals; the first match counts.
const HEADERS: [(Table, &str, &[&str]); 4] = [
    (
        Table::LineTypes,
        "LINE DICTIONARY",
        &["LINE DICTIONARY", "LINE TYPES"],
    ),
    (Table::Nodes, "NODE PROPERTIES", &["NODE PROPERTIES", "NODES"]),
    (
        Table::Lines,
        "LINE PROPERTIES",
        &["LINE PROPERTIES", "LINES", "ELEMENT PROPERTIES"],
    ),
    (Table::Options, "SOLVER OPTIONS", &["OPTIONS"]),
];

/// Header and the rows below it; the first two rows name columns and units.
struct Section<'t> {
    table: Table,
    name: &'static str,
    header: Row<'t>,
    rows: Vec<Row<'t>>,
}

impl<'t> Section<'t> {
    /// Returns the section that a row begins; `None` if the row is not a header.
    fn begun_by(row: &Row<'t>) -> Option<Section<'t>> {
        if !begins_section(row, |front| known_header(front).is_some()) {
            return None;
        }
        let (table, name) = known_header(row.text).unwrap_or((Table::Other, ""));
        Some(Section {
            table,
            name,
            header: row.clone(),
            rows: Vec::new(),
        })
    }

    /// Returns the rows below the names and units of the columns.
    fn body(&self) -> &[Row<'t>] {
        self.rows.get(2..).unwrap_or_default()
    }

    /// Checks that the two rows above the body are not part of it.
    fn check_headings(&self, findings: &mut Findings) {
        let numbered = match self.table {
            Table::LineTypes => 1, // below the name of the type
            _ => 0,
        };
        for heading in self.rows.iter().take(2) {
            let key = heading.fields().first().map(|field| field.text.to_uppercase());
            if self.table != Table::Options {
                check_heading(self.name, heading, numbered, findings);
            } else if key.is_some_and(|key| is_option(&key)) {
                let problem = "the two lines below the header are a heading and are never read, and this one holds an \
                               option: write two lines above the options, such as Option and (-)";
                findings.mistake(self.name, heading.span(), problem);
            }
        }
    }
}

/// Returns whether a word in capitals is an option of MAP++.
fn is_option(key: &str) -> bool {
    key == REPEAT || is_one_of(key, UNNEEDED)
}

/// Returns the kind and name of the section whose header a text contains.
fn known_header(text: &str) -> Option<(Table, &'static str)> {
    let upper = text.to_uppercase();
    let mut known = HEADERS.iter();
    let known = known.find(|(.., words)| words.iter().any(|words| upper.contains(words)));
    known.map(|(table, name, _)| (*table, *name))
}

/// Divides a text at its headers; the rows above the first header are the title.
fn sections(text: &str) -> (Vec<Row<'_>>, Vec<Section<'_>>) {
    let mut title = Vec::new();
    let mut sections: Vec<Section<'_>> = Vec::new();
    for row in Row::all(text) {
        match (Section::begun_by(&row), sections.last_mut()) {
            (Some(section), _) => sections.push(section),
            (None, Some(section)) => section.rows.push(row),
            (None, None) => title.push(row),
        }
    }
    (title, sections)
}

/// Returns whether a text is a MAP++ file, that is, has options or node entries that only MAP++ has.
pub(crate) fn is_deck(text: &str) -> bool {
    let (_, sections) = sections(text);
    let nodes = sections.iter().find(|section| section.table == Table::Nodes);
    let Some(nodes) = nodes.filter(|section| section.header.text.trim_start().starts_with("---")) else {
        return false;
    };
    let mut options = sections.iter().filter(|section| section.table == Table::Options);
    let key_first = |row: &Row<'_>| {
        let key = row.fields().first().map(|field| field.text.to_uppercase());
        key.is_some_and(|key| is_option(&key))
    };
    let options_of_map = options.any(|section| section.rows.iter().any(key_first));
    options_of_map || nodes.body().iter().take(ROWS_MAX).any(is_node_of_map)
}

/// Returns whether a row of nodes cannot be MoorDyn's: it has the word `depth`, or coordinates or forces to be found by iteration.
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
    let (above, sections) = sections(text);
    let mut deck = Deck {
        title: title(above.iter()),
        ..Deck::default()
    };
    for (table, name, _) in &HEADERS[..3] {
        let found = sections.iter().filter(|section| section.table == *table);
        if found.clone().all(|section| section.body().is_empty()) {
            findings.mistake("", 0..0, format!("no rows of {name}: a file needs them"));
        } else if let Some(second) = found.clone().nth(1) {
            findings.mistake("", second.header.span(), format!("a second section {name}"));
        }
    }
    for (index, section) in sections.iter().enumerate() {
        if let Some(row) = section.rows.get(ROWS_MAX) {
            let problem = format!("more than {ROWS_MAX} rows in {}", section.name);
            findings.mistake("", row.span(), problem);
        }
        match section.table {
            Table::LineTypes => deck.line_types.extend(table(section, LINE_TYPES, findings, line_type)),
            Table::Nodes => deck.nodes.extend(table(section, NODES, findings, node)),
            Table::Lines => deck.lines.extend(table(section, LINES, findings, line)),
            Table::Options => options(section, &mut deck, findings),
            // Rows below the first header, which may be the title, are not a section.
            Table::Other if index == 0 || section.rows.is_empty() => {}
            Table::Other => findings.mistake(
                "",
                section.header.span(),
                "unknown section; known are LINE DICTIONARY, NODE PROPERTIES, LINE PROPERTIES and SOLVER OPTIONS",
            ),
        }
    }
    check_numbers(&deck, findings);
    deck
}

/// Reads the rows of a table and compares its header with the columns by which they are read.
fn table<T>(
    section: &Section<'_>,
    columns: &'static [Column],
    findings: &mut Findings,
    read: fn(&mut Cells<'_, '_>) -> T,
) -> Vec<T> {
    section.check_headings(findings);
    if let Some(header) = section.rows.first() {
        compare_header(header, columns, findings);
    }
    if let Some(units) = section.rows.get(1) {
        check_units(units, columns, section.body(), findings);
    }
    read_rows(section.name, section.body(), &[columns], findings, read)
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
    let word = cells.word(1).value;
    let kind = match word.to_uppercase().as_str() {
        "FIX" | "FIXED" => Ok(Kind::Fix),
        "CONNECT" => Ok(Kind::Connect),
        "VESSEL" => Ok(Kind::Vessel),
        _ => Err(format!("expected fix, connect or vessel, found {}", shown(&word))),
    };
    let kind = cells.read(1, kind, Kind::Fix).value;
    let force = match kind {
        Kind::Connect => [7, 8, 9].map(|column| iterated(cells, column).value),
        Kind::Fix | Kind::Vessel => [0.0; 3], // MAP++ computes these forces
    };
    Node {
        id: cells.count(0, 1),
        kind,
        position: [2, 3, 4].map(|column| coordinate(cells, column)),
        mass: iterated(cells, 5),
        volume: iterated(cells, 6),
        force,
    }
}

/// Reads a number with or without the mark `#` of an unknown; the mark alone means zero.
fn iterated(cells: &mut Cells<'_, '_>, column: usize) -> Placed<f64> {
    let text = cells.fields[column].text;
    let value = match text.strip_prefix('#') {
        Some("") => Ok(0.0),
        Some(rest) => number(rest),
        None => number(text),
    };
    cells.read(column, value, 0.0)
}

fn coordinate(cells: &mut Cells<'_, '_>, column: usize) -> Placed<Coordinate> {
    let text = cells.fields[column].text;
    if column == 4 && text.trim_start_matches('#').eq_ignore_ascii_case("depth") {
        return cells.placed(column, Coordinate::Depth);
    }
    let number = iterated(cells, column);
    number.with(Coordinate::Given(number.value))
}

fn line(cells: &mut Cells<'_, '_>) -> Line {
    let mut omits_contact = None;
    for flag in &cells.fields[LINES.len()..] {
        let upper = flag.text.to_uppercase();
        let problem = match upper.as_str() {
            OMIT_CONTACT => {
                omits_contact = Some(placed_text(flag.text, &flag.span));
                continue;
            }
            known if is_one_of(known, OUTPUT_FLAGS) => continue,
            "LINEAR_SPRING" => {
                "a line as a linear spring is not modelled: give its EA and length".to_string()
            }
            "DAMAGE_TIME" => {
                "lines that come off are not modelled: take the flag and its time out".to_string()
            }
            _ => {
                let known = OUTPUT_FLAGS.split(' ').chain([OMIT_CONTACT]);
                let text = left_out("flag", flag.text, known);
                cells.findings.remark_at(flag.span.start, text);
                continue;
            }
        };
        let at = format!("{}, flags", cells.place);
        cells.findings.mistake(at, flag.span.clone(), problem);
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
    section.check_headings(findings);
    for row in section.body().iter().take(ROWS_MAX) {
        let fields = row.fields();
        let [key, values @ ..] = fields.as_slice() else {
            continue;
        };
        let upper = key.text.to_uppercase();
        if row.text.starts_with([' ', '\t', '!', '#']) {
            let comment = shown(row.text.trim());
            let text = format!("{comment} is a comment, as it begins with a blank or a mark");
            findings.remark_at(row.span().start, text);
        } else if upper == REPEAT {
            for Field { text, span } in values {
                match (number(text), span.clone()) {
                    (Ok(value), span) => deck.repeat.push(Placed { value, span }),
                    (Err(problem), span) => findings.mistake("repeat", span, problem),
                }
            }
        } else if is_one_of(&upper, UNNEEDED) {
            deck.unneeded.push(placed_text(key.text, &key.span));
        } else {
            let known = UNNEEDED.split(' ').chain([REPEAT]);
            findings.remark_at(key.span.start, left_out("option", key.text, known));
        }
    }
}

/// Checks that numbers and names are unique, and that lines refer to existing nodes and line types.
fn check_numbers(deck: &Deck, findings: &mut Findings) {
    check_unique(deck.nodes.iter().map(|node| &node.id), "node", findings);
    check_unique(
        deck.line_types.iter().map(|kind| &kind.name),
        "line type",
        findings,
    );
    check_unique(deck.lines.iter().map(|line| &line.id), "line", findings);
    for line in &deck.lines {
        let at = format!("line {}", line.id.value);
        let name = &line.line_type;
        if deck.line_types.iter().all(|kind| kind.name.value != name.value) {
            let problem = format!("no line type is called {}", shown(&name.value));
            findings.wrong(at.clone(), name, problem);
        }
        for end in &line.ends {
            if deck.nodes.iter().all(|node| node.id.value != end.value) {
                let problem = format!("no node has the number {}", end.value);
                findings.wrong(at.clone(), end, problem);
            }
        }
    }
}
