//! Rows -> typed cells: every table of a deck, read by column position.

use moorline::scene::rows::{Row, number, shown};

use super::deck::{Attachment, Body, Deck, Line, LineEnd, LineType, Point, Property, Rod, RodType, Version};
use super::options;
use super::sections::{Kind, Section, Sections};
use crate::findings::{Findings, Placed};
use crate::table::{self, Cells, Column, ROWS_MAX, check_unique, column, is_one_of, placed_text};

const TYPE_NAME: Column = column("Name", "-", "NAME TYPENAME LINETYPE TYPE");
const DIAMETER: Column = column("Diam", "m", "DIAM DIAMETER D");
const EA: Column = column("EA", "N", "EA");
const BA: Column = column(
    "BA/-zeta",
    "N s, or a ratio with a minus sign",
    "BA/-ZETA BA CINTDAMP BA/-Z",
);

/// LINE TYPES of version 2.
const LINE_TYPES_2: &[Column] = &[
    TYPE_NAME,
    DIAMETER,
    column("Mass", "kg/m", "MASS MASS/M MASSDEN MASSDENINAIR MASS/LENGTH"),
    EA,
    BA,
    column("EI", "N m²", "EI"),
    column("Cd", "-", "CD CDN"),
    column("Ca", "-", "CA CAN"),
    column("CdAx", "-", "CDAX CDT"),
    column("CaAx", "-", "CAAX CAT"),
    column("Cl", "-", "CL"),
    column("dF", "-", "DF"),
    column("cF", "-", "CF"),
];

/// LINE TYPES of version 1.
const LINE_TYPES_1: &[Column] = &[
    TYPE_NAME,
    DIAMETER,
    column("MassDen", "kg/m", "MASS MASS/M MASSDEN MASSDENINAIR MASS/LENGTH"),
    EA,
    BA,
    column("Can", "-", "CAN"),
    column("Cat", "-", "CAT"),
    column("Cdn", "-", "CDN"),
    column("Cdt", "-", "CDT"),
];

const ROD_TYPES: &[Column] = &[
    column("Name", "-", "NAME TYPENAME"),
    column("Diam", "m", "DIAM DIAMETER"),
    column("Mass", "kg/m", "MASS MASS/M MASSDEN"),
    column("Cd", "-", "CD"),
    column("Ca", "-", "CA"),
    column("CdEnd", "-", "CDEND"),
    column("CaEnd", "-", "CAEND"),
];

const BODIES: &[Column] = &[
    column("ID", "-", "ID"),
    column("Attachment", "-", "ATTACHMENT TYPE"),
    column("X0", "m", "X0 X"),
    column("Y0", "m", "Y0 Y"),
    column("Z0", "m", "Z0 Z"),
    column("r0", "deg", "R0"),
    column("p0", "deg", "P0"),
    column("y0", "deg", "Y0"),
    column("Mass", "kg", "MASS M"),
    column("CG", "m", "CG"),
    column("I", "kg m²", "I"),
    column("Volume", "m³", "VOLUME V"),
    column("CdA", "m²", "CDA"),
    column("Ca", "-", "CA"),
];

const RODS: &[Column] = &[
    column("ID", "-", "ID"),
    column("RodType", "-", "RODTYPE"),
    column("Attachment", "-", "ATTACHMENT"),
    column("Xa", "m", "XA"),
    column("Ya", "m", "YA"),
    column("Za", "m", "ZA"),
    column("Xb", "m", "XB"),
    column("Yb", "m", "YB"),
    column("Zb", "m", "ZB"),
    column("NumSegs", "-", "NUMSEGS"),
    column("RodOutputs", "-", "RODOUTPUTS OUTPUTS"),
];

/// POINTS with nine columns.
const POINTS_9: &[Column] = &[
    column("ID", "-", "ID NODE POINT"),
    column("Attachment", "-", "ATTACHMENT TYPE"),
    column("X", "m", "X"),
    column("Y", "m", "Y"),
    column("Z", "m", "Z"),
    column("Mass", "kg", "MASS M"),
    column("Volume", "m³", "VOLUME V"),
    column("CdA", "m²", "CDA"),
    column("Ca", "-", "CA"),
];

/// POINTS with twelve columns.
const POINTS_12: &[Column] = &[
    column("ID", "-", "ID NODE POINT"),
    column("Type", "-", "ATTACHMENT TYPE"),
    column("X", "m", "X"),
    column("Y", "m", "Y"),
    column("Z", "m", "Z"),
    column("M", "kg", "MASS M"),
    column("V", "m³", "VOLUME V"),
    column("FX", "N", "FX"),
    column("FY", "N", "FY"),
    column("FZ", "N", "FZ"),
    column("CdA", "m²", "CDA"),
    column("Ca", "-", "CA"),
];

/// LINES of version 2.
const LINES_2: &[Column] = &[
    column("ID", "-", "ID LINE"),
    column("LineType", "-", "LINETYPE TYPE"),
    column("AttachA", "-", "ATTACHA NODEA NODEANCH"),
    column("AttachB", "-", "ATTACHB NODEB NODEFAIR"),
    column("UnstrLen", "m", "UNSTRLEN LENGTH"),
    column("NumSegs", "-", "NUMSEGS"),
    column("Outputs", "-", "OUTPUTS LINEOUTPUTS FLAGS/OUTPUTS"),
];

/// LINES of version 1.
const LINES_1: &[Column] = &[
    column("Line", "-", "ID LINE"),
    column("LineType", "-", "LINETYPE TYPE"),
    column("UnstrLen", "m", "UNSTRLEN LENGTH"),
    column("NumSegs", "-", "NUMSEGS"),
    column("NodeAnch", "-", "ATTACHA NODEA NODEANCH"),
    column("NodeFair", "-", "ATTACHB NODEB NODEFAIR"),
    column("Outputs", "-", "OUTPUTS LINEOUTPUTS FLAGS/OUTPUTS"),
];

/// Reads all tables and lists of a deck.
pub(super) fn read(sections: &Sections<'_>, findings: &mut Findings) -> Deck {
    for section in &sections.list {
        check_size(section, findings);
    }
    let version = version(sections);
    let mut deck = Deck {
        version,
        title: title(sections),
        line_types: line_types(sections, version, findings),
        rod_types: rod_types(sections, findings),
        bodies: bodies(sections, findings),
        rods: rods(sections, findings),
        points: points(sections, findings),
        failures: whole_rows(sections, Kind::Failure),
        controls: whole_rows(sections, Kind::Control),
        loads: whole_rows(sections, Kind::ExternalLoads),
        options: options::read(sections.rows(Kind::Options), findings),
        outputs: outputs(sections),
        ..Deck::default()
    };
    deck.lines = lines(sections, &deck, findings);
    missing_sections(sections, findings);
    check_unique(deck.points.iter().map(|p| &p.id), "point", findings);
    check_unique(deck.lines.iter().map(|l| &l.id), "line", findings);
    check_unique(deck.rods.iter().map(|r| &r.id), "rod", findings);
    check_unique(deck.bodies.iter().map(|b| &b.id), "body", findings);
    let names = deck.line_types.iter().map(|kind| &kind.name);
    check_unique(names, "line type", findings);
    deck
}

fn missing_sections(sections: &Sections<'_>, findings: &mut Findings) {
    if sections.rows(Kind::Lines).is_empty() {
        let has = |kind: Kind| !sections.rows(kind).is_empty();
        let what = match (has(Kind::Rods), has(Kind::Bodies)) {
            (true, true) => "rods and bodies",
            (true, false) => "rods",
            (false, true) => "bodies",
            (false, false) => "",
        };
        if !what.is_empty() {
            let problem = format!(
                "no lines in LINES: {what} without lines are a deck of MoorDyn, but moorline models lines, and what they hang on \
                 only with them"
            );
            let span = sections.get(Kind::Lines).map_or(0..0, |s| s.header.span());
            return findings.mistake("", span, problem);
        }
    }
    for kind in [Kind::LineTypes, Kind::Points, Kind::Lines] {
        let problem = match sections.get(kind) {
            None => format!("no section {}: a deck needs it", kind.name()),
            Some(section) if section.rows.is_empty() => {
                format!("no rows in {} below names and units", kind.name())
            }
            Some(_) => continue,
        };
        // LINES may be attached to rods only.
        if kind == Kind::Points && !sections.rows(Kind::Rods).is_empty() {
            continue;
        }
        let span = sections.get(kind).map_or(0..0, |s| s.header.span());
        findings.mistake("", span, problem);
    }
}

fn check_size(section: &Section<'_>, findings: &mut Findings) {
    if let Some(row) = section.rows.get(ROWS_MAX) {
        let problem = format!("more than {ROWS_MAX} rows in {}", section.kind.name());
        findings.mistake(section.kind.name(), row.span(), problem);
    }
}

/// Returns the words above the first section, without rules and the echo flag.
fn title(sections: &Sections<'_>) -> String {
    table::title(sections.preamble.iter().filter(|row| {
        let fields = row.fields();
        let echo = fields.get(1).is_some_and(|f| f.text.eq_ignore_ascii_case("echo"));
        let upper = row.text.to_uppercase();
        let kind = upper.contains("MOORDYN") && upper.contains("INPUT FILE") && fields.len() <= 5;
        !row.text.contains("---") && !echo && !kind
    }))
}

/// Returns the version: version 1 has nine columns of line types, without EI.
fn version(sections: &Sections<'_>) -> Version {
    let Some(section) = sections.get(Kind::LineTypes) else {
        return Version::Two;
    };
    let named = section.names.as_ref().is_some_and(|names| {
        let mut fields = names.fields().into_iter();
        fields.any(|field| field.text.eq_ignore_ascii_case("EI"))
    });
    let first = section.rows.first();
    match first.map(|row| row.fields().len()) {
        Some(9) if !named => Version::One,
        _ => Version::Two,
    }
}

/// Reads the rows of a table whose number of cells matches one of the lists of columns.
fn read_rows<T>(
    sections: &Sections<'_>,
    kind: Kind,
    lists: &[&'static [Column]],
    findings: &mut Findings,
    read: impl Fn(&mut Cells<'_, '_>) -> T,
) -> Vec<T> {
    table::read_rows(kind.name(), sections.rows(kind), lists, findings, |cells| {
        let widest = cells.columns.len();
        if let Some(extra) = cells.fields.get(widest) {
            let text = format!("{}: what stands behind column {widest} is not read", kind.name());
            cells.findings.remark_at(extra.span.start, text);
        }
        read(cells)
    })
}

fn line_types(sections: &Sections<'_>, version: Version, findings: &mut Findings) -> Vec<LineType> {
    let of_two = LINE_TYPES_2;
    let lists = match version {
        Version::One => &[LINE_TYPES_1][..],
        Version::Two => &[&of_two[..10], &of_two[..11], of_two],
    };
    // Version 1 has the four coefficients in a different order, and no EI.
    let [drag, added_mass, drag_along, added_mass_along] = match version {
        Version::One => [7, 5, 8, 6],
        Version::Two => [6, 7, 8, 9],
    };
    read_rows(sections, Kind::LineTypes, lists, findings, |cells| LineType {
        name: cells.word(0),
        diameter: cells.number(1),
        mass: cells.number(2),
        stiffness: property(cells, 3),
        damping: property(cells, 4),
        bending: (version == Version::Two).then(|| property(cells, 5)),
        drag_normal: cells.number(drag),
        added_mass_normal: cells.number(added_mass),
        drag_tangential: cells.number(drag_along),
        added_mass_tangential: cells.number(added_mass_along),
        lift: (cells.columns.len() > 10).then(|| cells.number(10)),
    })
}

/// Reads EA, BA or EI: a number, numbers joined by bars, or a name.
fn property(cells: &mut Cells<'_, '_>, column: usize) -> Placed<Property> {
    let value = word_property(cells.fields[column].text);
    cells.read(column, value, Property::Number(0.0))
}

/// Converts a word to a property.
pub(super) fn word_property(word: &str) -> Result<Property, String> {
    let problem = match number(word) {
        Ok(value) => return Ok(Property::Number(value)),
        Err(problem) => problem,
    };
    let parts: Result<Vec<f64>, String> = word.split('|').map(number).collect();
    if let Ok(parts) = parts {
        return Ok(Property::Parts(parts));
    }
    // A word that begins like a number is a typing error, not a file name.
    let name = word.starts_with(char::is_alphabetic) || word.contains(['/', '\\', '|']);
    let not_finite = ["nan", "inf", "infinity"].contains(&word.to_lowercase().as_str());
    match name && !not_finite {
        true => Ok(Property::Named(word.to_string())),
        false => Err(problem),
    }
}

fn rod_types(sections: &Sections<'_>, findings: &mut Findings) -> Vec<RodType> {
    read_rows(sections, Kind::RodTypes, &[ROD_TYPES], findings, |cells| {
        for column in 1..ROD_TYPES.len() {
            cells.number(column);
        }
        RodType { name: cells.word(0) }
    })
}

fn bodies(sections: &Sections<'_>, findings: &mut Findings) -> Vec<Body> {
    read_rows(sections, Kind::Bodies, &[BODIES], findings, |cells| Body {
        id: cells.count(0, 1),
        attachment: attachment(cells, 1),
        position: cells.vector(2),
        attitude: cells.vector(5),
        mass: cells.number(8),
        volume: cells.number(11),
        parts: [
            parts(cells, 9, &[1, 3]),
            parts(cells, 10, &[1, 3]),
            parts(cells, 12, &[1, 2, 3, 6]),
            parts(cells, 13, &[1, 3]),
        ],
    })
}

/// Reads one number, or several joined by bars.
fn parts(cells: &mut Cells<'_, '_>, column: usize, counts: &[usize]) -> Placed<Vec<f64>> {
    let numbers: Result<Vec<f64>, String> = cells.fields[column].text.split('|').map(number).collect();
    let numbers = numbers.and_then(|numbers| match counts.contains(&numbers.len()) {
        true => Ok(numbers),
        false => {
            let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
            let counts = counts.join(" or ");
            Err(format!(
                "{} numbers joined by |, expected {counts}",
                numbers.len()
            ))
        }
    });
    cells.read(column, numbers, vec![0.0])
}

fn rods(sections: &Sections<'_>, findings: &mut Findings) -> Vec<Rod> {
    read_rows(sections, Kind::Rods, &[RODS], findings, |cells| Rod {
        id: cells.count(0, 1),
        rod_type: cells.word(1),
        attachment: attachment(cells, 2),
        ends: [cells.vector(3), cells.vector(6)],
        segments: cells.count(9, 0),
    })
}

fn points(sections: &Sections<'_>, findings: &mut Findings) -> Vec<Point> {
    read_rows(
        sections,
        Kind::Points,
        &[POINTS_9, POINTS_12],
        findings,
        |cells| {
            let forced = cells.columns.len() == 12;
            let last = cells.columns.len() - 2;
            Point {
                id: cells.count(0, 1),
                attachment: attachment(cells, 1),
                position: cells.vector(2),
                mass: cells.number(5),
                volume: cells.number(6),
                force: forced.then(|| cells.vector(7)),
                drag_area: cells.number(last),
                added_mass: cells.number(last + 1),
            }
        },
    )
}

/// Splits a word into letters, number and letters: "Body1Pinned" -> "BODY", 1, "PINNED".
fn decomposed(word: &str) -> (String, Option<usize>, String) {
    let upper = word.to_uppercase();
    let first = upper.find(|c: char| c.is_ascii_digit()).unwrap_or(upper.len());
    let (letters, rest) = upper.split_at(first);
    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (digits, tail) = rest.split_at(digits);
    (letters.to_string(), digits.parse().ok(), tail.to_string())
}

/// Reads an attachment.
fn attachment(cells: &mut Cells<'_, '_>, column: usize) -> Placed<Attachment> {
    let word = cells.fields[column].text;
    let (letters, id, tail) = decomposed(word);
    let pinned = ["PINNED", "PIN"].contains(&tail.as_str());
    // A number after one of these words has no meaning.
    let unnumbered = match letters.as_str() {
        "FIXED" | "FIX" | "ANCHOR" => Some((Attachment::Fixed, "Fixed")),
        "COUPLED" | "CPLD" => Some((Attachment::Coupled, "Coupled")),
        "VESSEL" | "VES" | "FAIRLEAD" => Some((Attachment::Vessel, "Vessel")),
        "FREE" | "CONNECT" | "CONNECTION" | "POINT" | "CON" | "P" | "C" => Some((Attachment::Free, "Free")),
        _ => None,
    };
    if let (Some((value, name)), "") = (unnumbered, tail.as_str()) {
        if let Some(id) = id {
            let text = format!(
                "{}: {word:?} is read as {name}, as in MoorDyn, where the number {id} behind it means nothing",
                cells.place
            );
            cells.findings.remark_at(cells.fields[column].span.start, text);
        }
        return cells.placed(column, value);
    }
    let value = match (letters.as_str(), id, tail.as_str()) {
        ("PINNED" | "PIN", None, "") => Ok(Attachment::Pinned(None)),
        ("VESSELPINNED" | "VESPIN" | "COUPLEDPINNED" | "CPLDPIN", None, "") => Ok(Attachment::CoupledPinned),
        ("BODY" | "B", Some(id), "") => Ok(Attachment::Body(id)),
        ("BODY" | "B", Some(id), _) if pinned => Ok(Attachment::Pinned(Some(id))),
        ("TURBINE" | "T", Some(id), "") => Ok(Attachment::Turbine(id)),
        _ => Err(format!(
            "expected Fixed, Coupled, Vessel, Free, Body1 or Turbine1, found {}",
            shown(word)
        )),
    };
    cells.read(column, value, Attachment::Fixed)
}

/// Converts "3", "Point3", "Con3" or "R1A" to a line end.
fn line_end(word: &str) -> Option<LineEnd> {
    let (letters, id, tail) = decomposed(word);
    match (letters.as_str(), id?, tail.as_str()) {
        ("" | "P" | "POINT" | "C" | "CON", id, "") => Some(LineEnd::Point(id)),
        ("R" | "ROD", id, "A") => Some(LineEnd::Rod(id, false)),
        ("R" | "ROD", id, "B") => Some(LineEnd::Rod(id, true)),
        _ => None,
    }
}

fn exists(end: LineEnd, deck: &Deck) -> bool {
    match end {
        LineEnd::Point(id) => deck.points.iter().any(|point| point.id.value == id),
        LineEnd::Rod(id, _) => deck.rods.iter().any(|rod| rod.id.value == id),
    }
}

/// Returns whether rows of LINES have the length before the ends (version 1). Decides by the contents of the columns, then by the header, then
/// by the version of the line types.
fn length_comes_first(section: &Section<'_>, deck: &Deck) -> bool {
    let fits = |row: &&Row<'_>, ends: usize, length: usize, count: usize| {
        let fields = row.fields();
        let text = |column: usize| fields.get(column).map_or("", |field| field.text);
        let end = |column| line_end(text(column)).is_some_and(|end| exists(end, deck));
        let sizes = number(text(length)).is_ok() && text(count).parse::<usize>().is_ok();
        end(ends) && end(ends + 1) && sizes
    };
    let rows = || section.rows.iter().take(ROWS_MAX);
    let ends_first = rows().filter(|row| fits(row, 2, 4, 5)).count();
    let length_first = rows().filter(|row| fits(row, 4, 2, 3)).count();
    if ends_first != length_first {
        return length_first > ends_first;
    }
    let names = section.names.as_ref().map(|names| names.fields());
    let named = names.and_then(|names| {
        let mut names = names.iter();
        names.position(|name| is_one_of(name.text, LINES_1[2].spellings))
    });
    match named {
        Some(column) => column == 2,
        None => deck.version == Version::One,
    }
}

fn lines(sections: &Sections<'_>, deck: &Deck, findings: &mut Findings) -> Vec<Line> {
    let Some(section) = sections.get(Kind::Lines) else {
        return Vec::new();
    };
    let first = length_comes_first(section, deck);
    let (ends, length, columns) = if first { (4, 2, LINES_1) } else { (2, 4, LINES_2) };
    read_rows(sections, Kind::Lines, &[columns], findings, |cells| Line {
        id: cells.count(0, 1),
        line_type: known_type(cells, deck),
        ends: [attached(cells, ends, deck), attached(cells, ends + 1, deck)],
        length: cells.number(length),
        segments: cells.count(length + 1, 1),
        outputs: cells.word(6),
    })
}

fn known_type(cells: &mut Cells<'_, '_>, deck: &Deck) -> Placed<String> {
    let word = cells.word(1);
    let mut types = deck.line_types.iter().map(|kind| kind.name.value.as_str());
    if types.clone().all(|name| name != word.value) {
        let meant = types.find(|name| name.eq_ignore_ascii_case(&word.value));
        let meant = meant.map_or(String::new(), |name| format!(", did you mean {name:?}?"));
        cells.wrong(1, format!("no line type is called {}{meant}", shown(&word.value)));
    }
    word
}

fn attached(cells: &mut Cells<'_, '_>, column: usize, deck: &Deck) -> Placed<LineEnd> {
    let word = cells.fields[column].text;
    let end = match line_end(word) {
        Some(end) if exists(end, deck) => Ok(end),
        Some(LineEnd::Point(id)) => Err(format!("no point has the number {id}")),
        Some(LineEnd::Rod(id, _)) => Err(format!("no rod has the number {id}")),
        None => Err(format!(
            "expected the number of a point, or a rod's end such as R1A, found {}",
            shown(word)
        )),
    };
    cells.read(column, end, LineEnd::Point(0))
}

fn whole_rows(sections: &Sections<'_>, kind: Kind) -> Vec<Placed<String>> {
    let rows = sections.rows(kind).iter().take(ROWS_MAX);
    rows.map(|row| placed_text(row.text.trim(), &row.span()))
        .collect()
}

/// Reads the names of channels, one or several per row, up to END.
fn outputs(sections: &Sections<'_>) -> Vec<Placed<String>> {
    let mut names = Vec::new();
    for row in sections.rows(Kind::Outputs).iter().take(ROWS_MAX) {
        for field in row.split(|c| c.is_whitespace() || [',', '"', '\'', ';'].contains(&c)) {
            if field.text.eq_ignore_ascii_case("END") {
                return names;
            }
            names.push(placed_text(field.text, &field.span));
        }
    }
    names
}

/// Returns the columns by which rows of a section are read, if there are alternatives.
pub(super) fn columns_of(section: &Section<'_>, deck: &Deck) -> Option<&'static [Column]> {
    Some(match section.kind {
        Kind::LineTypes if deck.version == Version::One => LINE_TYPES_1,
        Kind::LineTypes => LINE_TYPES_2,
        Kind::RodTypes => ROD_TYPES,
        Kind::Bodies => BODIES,
        Kind::Rods => RODS,
        Kind::Points if deck.points.iter().any(|point| point.force.is_some()) => POINTS_12,
        Kind::Points => POINTS_9,
        Kind::Lines if length_comes_first(section, deck) => LINES_1,
        Kind::Lines => LINES_2,
        _ => return None,
    })
}
