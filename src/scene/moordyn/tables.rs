//! Rows -> typed cells: every table of a deck by the place of its columns.

use std::collections::BTreeMap;

use super::deck::{Attachment, Body, Deck, Line, LineEnd, LineType, Point, Property, Rod, RodType, Version};
use super::options;
use super::sections::{Kind, Section, Sections};
use crate::scene::rows::{Cells, Column, Findings, Placed, ROWS_MAX, Row, number, shown};

macro_rules! columns {
    ($($name:literal [$unit:literal] $($spelling:literal)*),* $(,)?) => {
        &[$(Column { name: $name, unit: $unit, spellings: &[$($spelling),*] }),*]
    };
}

/// LINE TYPES of version 2.
const LINE_TYPES_2: &[Column] = columns![
    "Name" ["-"] "NAME" "TYPENAME" "LINETYPE" "TYPE",
    "Diam" ["m"] "DIAM" "DIAMETER" "D",
    "Mass" ["kg/m"] "MASS" "MASS/M" "MASSDEN" "MASSDENINAIR" "MASS/LENGTH",
    "EA" ["N"] "EA",
    "BA/-zeta" ["N s, or a ratio with a minus sign"] "BA/-ZETA" "BA" "CINTDAMP" "BA/-Z",
    "EI" ["N m²"] "EI",
    "Cd" ["-"] "CD" "CDN",
    "Ca" ["-"] "CA" "CAN",
    "CdAx" ["-"] "CDAX" "CDT",
    "CaAx" ["-"] "CAAX" "CAT",
    "Cl" ["-"] "CL",
    "dF" ["-"] "DF",
    "cF" ["-"] "CF",
];

/// LINE TYPES of version 1.
const LINE_TYPES_1: &[Column] = columns![
    "Name" ["-"] "NAME" "TYPENAME" "LINETYPE" "TYPE",
    "Diam" ["m"] "DIAM" "DIAMETER" "D",
    "MassDen" ["kg/m"] "MASS" "MASS/M" "MASSDEN" "MASSDENINAIR" "MASS/LENGTH",
    "EA" ["N"] "EA",
    "BA/-zeta" ["N s, or a ratio with a minus sign"] "BA/-ZETA" "BA" "CINTDAMP" "BA/-Z",
    "Can" ["-"] "CAN",
    "Cat" ["-"] "CAT",
    "Cdn" ["-"] "CDN",
    "Cdt" ["-"] "CDT",
];

const ROD_TYPES: &[Column] = columns![
    "Name" ["-"] "NAME" "TYPENAME",
    "Diam" ["m"] "DIAM" "DIAMETER",
    "Mass" ["kg/m"] "MASS" "MASS/M" "MASSDEN",
    "Cd" ["-"] "CD",
    "Ca" ["-"] "CA",
    "CdEnd" ["-"] "CDEND",
    "CaEnd" ["-"] "CAEND",
];

const BODIES: &[Column] = columns![
    "ID" ["-"] "ID",
    "Attachment" ["-"] "ATTACHMENT" "TYPE",
    "X0" ["m"] "X0" "X",
    "Y0" ["m"] "Y0" "Y",
    "Z0" ["m"] "Z0" "Z",
    "r0" ["deg"] "R0",
    "p0" ["deg"] "P0",
    "y0" ["deg"] "Y0",
    "Mass" ["kg"] "MASS" "M",
    "CG" ["m"] "CG",
    "I" ["kg m²"] "I",
    "Volume" ["m³"] "VOLUME" "V",
    "CdA" ["m²"] "CDA",
    "Ca" ["-"] "CA",
];

const RODS: &[Column] = columns![
    "ID" ["-"] "ID",
    "RodType" ["-"] "RODTYPE",
    "Attachment" ["-"] "ATTACHMENT",
    "Xa" ["m"] "XA",
    "Ya" ["m"] "YA",
    "Za" ["m"] "ZA",
    "Xb" ["m"] "XB",
    "Yb" ["m"] "YB",
    "Zb" ["m"] "ZB",
    "NumSegs" ["-"] "NUMSEGS",
    "RodOutputs" ["-"] "RODOUTPUTS" "OUTPUTS",
];

/// POINTS with nine columns.
const POINTS_9: &[Column] = columns![
    "ID" ["-"] "ID" "NODE" "POINT",
    "Attachment" ["-"] "ATTACHMENT" "TYPE",
    "X" ["m"] "X",
    "Y" ["m"] "Y",
    "Z" ["m"] "Z",
    "Mass" ["kg"] "MASS" "M",
    "Volume" ["m³"] "VOLUME" "V",
    "CdA" ["m²"] "CDA",
    "Ca" ["-"] "CA",
];

/// POINTS with twelve columns.
const POINTS_12: &[Column] = columns![
    "ID" ["-"] "ID" "NODE" "POINT",
    "Type" ["-"] "ATTACHMENT" "TYPE",
    "X" ["m"] "X",
    "Y" ["m"] "Y",
    "Z" ["m"] "Z",
    "M" ["kg"] "MASS" "M",
    "V" ["m³"] "VOLUME" "V",
    "FX" ["N"] "FX",
    "FY" ["N"] "FY",
    "FZ" ["N"] "FZ",
    "CdA" ["m²"] "CDA",
    "Ca" ["-"] "CA",
];

/// LINES of version 2.
const LINES_2: &[Column] = columns![
    "ID" ["-"] "ID" "LINE",
    "LineType" ["-"] "LINETYPE" "TYPE",
    "AttachA" ["-"] "ATTACHA" "NODEA" "NODEANCH",
    "AttachB" ["-"] "ATTACHB" "NODEB" "NODEFAIR",
    "UnstrLen" ["m"] "UNSTRLEN" "LENGTH",
    "NumSegs" ["-"] "NUMSEGS",
    "Outputs" ["-"] "OUTPUTS" "LINEOUTPUTS" "FLAGS/OUTPUTS",
];

/// LINES of version 1.
const LINES_1: &[Column] = columns![
    "Line" ["-"] "ID" "LINE",
    "LineType" ["-"] "LINETYPE" "TYPE",
    "UnstrLen" ["m"] "UNSTRLEN" "LENGTH",
    "NumSegs" ["-"] "NUMSEGS",
    "NodeAnch" ["-"] "ATTACHA" "NODEA" "NODEANCH",
    "NodeFair" ["-"] "ATTACHB" "NODEB" "NODEFAIR",
    "Outputs" ["-"] "OUTPUTS" "LINEOUTPUTS" "FLAGS/OUTPUTS",
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
    unique(deck.points.iter().map(|p| &p.id), "point", findings);
    unique(deck.lines.iter().map(|l| &l.id), "line", findings);
    unique(deck.rods.iter().map(|r| &r.id), "rod", findings);
    unique(deck.bodies.iter().map(|b| &b.id), "body", findings);
    let names = deck.line_types.iter().map(|kind| &kind.name);
    unique(names, "line type", findings);
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
        // LINES may hang on rods alone.
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

/// Names and numbers that must differ.
fn unique<'d, T: Ord + std::fmt::Display + 'd>(
    names: impl Iterator<Item = &'d Placed<T>>,
    what: &str,
    findings: &mut Findings,
) {
    let mut seen = BTreeMap::new();
    for name in names {
        if seen.insert(&name.value, ()).is_some() {
            let problem = format!("a second {what} {}: take another", name.value);
            findings.mistake(format!("{what} {}", name.value), name.span.clone(), problem);
        }
    }
}

/// The words above the first section that are neither rules nor the echo flag.
fn title(sections: &Sections<'_>) -> String {
    let rows = sections.preamble.iter().filter(|row| {
        let fields = row.fields();
        let echo = fields.get(1).is_some_and(|f| f.text.eq_ignore_ascii_case("echo"));
        let upper = row.text.to_uppercase();
        let kind = upper.contains("MOORDYN") && upper.contains("INPUT FILE") && fields.len() <= 5;
        !row.text.contains("---") && !echo && !kind
    });
    let words = rows.flat_map(|row| row.fields()).map(|field| field.text);
    let title: String = words.collect::<Vec<_>>().join(" ");
    title.chars().filter(|c| !c.is_control()).take(200).collect()
}

/// Version 1 has nine columns of line types, none of them EI.
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

/// Rows of a table as cells, where they have one of the accepted numbers of columns.
fn read_rows<T>(
    rows: &[Row<'_>],
    kind: Kind,
    accepted: &[usize],
    columns: impl Fn(usize) -> &'static [Column],
    findings: &mut Findings,
    mut read: impl FnMut(&mut Cells<'_, '_>) -> T,
) -> Vec<T> {
    let mut table = Vec::new();
    for (index, row) in rows.iter().take(ROWS_MAX).enumerate() {
        let fields = row.fields();
        let place = format!("{}, row {}", kind.name(), index + 1);
        let widest = accepted.iter().copied().max().unwrap_or(0);
        let Some(&width) = accepted
            .iter()
            .rfind(|width| fields.len() == **width || (**width == widest && fields.len() > widest))
        else {
            let names: Vec<String> = accepted
                .iter()
                .map(|width| {
                    let names: Vec<&str> = columns(*width).iter().take(*width).map(|c| c.name).collect();
                    format!("{width} ({})", names.join(" "))
                })
                .collect();
            let problem = format!("{} columns, expected {}", fields.len(), names.join(" or "));
            findings.mistake(place, row.span(), problem);
            continue;
        };
        if let Some(extra) = fields.get(widest) {
            let text = format!("{}: what stands behind column {widest} is not read", kind.name());
            findings.remark(extra.span.start, text);
        }
        table.push(read(&mut Cells {
            place,
            fields: &fields,
            columns: columns(width),
            findings,
        }));
    }
    table
}

fn line_types(sections: &Sections<'_>, version: Version, findings: &mut Findings) -> Vec<LineType> {
    let rows = sections.rows(Kind::LineTypes);
    match version {
        Version::One => read_rows(
            rows,
            Kind::LineTypes,
            &[9],
            |_| LINE_TYPES_1,
            findings,
            |cells| LineType {
                name: cells.word(0),
                diameter: cells.number(1),
                mass: cells.number(2),
                stiffness: property(cells, 3),
                damping: property(cells, 4),
                bending: None,
                added_mass_normal: cells.number(5),
                added_mass_tangential: cells.number(6),
                drag_normal: cells.number(7),
                drag_tangential: cells.number(8),
                lift: None,
            },
        ),
        Version::Two => read_rows(
            rows,
            Kind::LineTypes,
            &[10, 11, 13],
            |_| LINE_TYPES_2,
            findings,
            |cells| {
                let lift = cells.fields.len() > 10;
                LineType {
                    name: cells.word(0),
                    diameter: cells.number(1),
                    mass: cells.number(2),
                    stiffness: property(cells, 3),
                    damping: property(cells, 4),
                    bending: Some(property(cells, 5)),
                    drag_normal: cells.number(6),
                    added_mass_normal: cells.number(7),
                    drag_tangential: cells.number(8),
                    added_mass_tangential: cells.number(9),
                    lift: lift.then(|| cells.number(10)),
                }
            },
        ),
    }
}

/// EA, BA or EI: a number, numbers joined by bars, or a name.
fn property(cells: &mut Cells<'_, '_>, column: usize) -> Placed<Property> {
    let word = cells.word(column);
    let value = word_property(&word.value).unwrap_or_else(|problem| {
        cells.wrong(column, problem);
        Property::Number(0.0)
    });
    Placed {
        value,
        span: word.span,
    }
}

/// What a word in a column of properties says.
pub(super) fn word_property(word: &str) -> Result<Property, String> {
    if let Ok(value) = number(word) {
        return Ok(Property::Number(value));
    }
    if word.contains('|') {
        let parts: Result<Vec<f64>, String> = word.split('|').map(number).collect();
        return Ok(match parts {
            Ok(parts) => Property::Parts(parts),
            Err(_) => Property::Named(word.to_string()),
        });
    }
    // What begins like a number is a slip, not a name of a file.
    let name = word.chars().next().is_some_and(char::is_alphabetic) || word.contains(['/', '\\']);
    let not_finite = ["nan", "inf", "infinity"].contains(&word.to_lowercase().as_str());
    match number(word) {
        Err(problem) if !name || not_finite => Err(problem),
        _ => Ok(Property::Named(word.to_string())),
    }
}

fn rod_types(sections: &Sections<'_>, findings: &mut Findings) -> Vec<RodType> {
    let rows = sections.rows(Kind::RodTypes);
    read_rows(
        rows,
        Kind::RodTypes,
        &[7],
        |_| ROD_TYPES,
        findings,
        |cells| {
            for column in 1..ROD_TYPES.len() {
                cells.number(column);
            }
            RodType { name: cells.word(0) }
        },
    )
}

fn bodies(sections: &Sections<'_>, findings: &mut Findings) -> Vec<Body> {
    let rows = sections.rows(Kind::Bodies);
    read_rows(
        rows,
        Kind::Bodies,
        &[14],
        |_| BODIES,
        findings,
        |cells| Body {
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
        },
    )
}

/// One number or several joined by bars.
fn parts(cells: &mut Cells<'_, '_>, column: usize, counts: &[usize]) -> Placed<Vec<f64>> {
    let word = cells.word(column);
    let numbers: Result<Vec<f64>, String> = word.value.split('|').map(number).collect();
    let value = match numbers {
        Ok(numbers) if counts.contains(&numbers.len()) => numbers,
        Ok(numbers) => {
            let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
            let problem = format!(
                "{} numbers joined by |, expected {}",
                numbers.len(),
                counts.join(" or ")
            );
            cells.wrong(column, problem);
            vec![0.0]
        }
        Err(problem) => {
            cells.wrong(column, problem);
            vec![0.0]
        }
    };
    Placed {
        value,
        span: word.span,
    }
}

fn rods(sections: &Sections<'_>, findings: &mut Findings) -> Vec<Rod> {
    let rows = sections.rows(Kind::Rods);
    read_rows(
        rows,
        Kind::Rods,
        &[11],
        |_| RODS,
        findings,
        |cells| Rod {
            id: cells.count(0, 1),
            rod_type: cells.word(1),
            attachment: attachment(cells, 2),
            ends: [cells.vector(3), cells.vector(6)],
            segments: cells.count(9, 0),
        },
    )
}

fn points(sections: &Sections<'_>, findings: &mut Findings) -> Vec<Point> {
    let rows = sections.rows(Kind::Points);
    let columns = |width| if width == 12 { POINTS_12 } else { POINTS_9 };
    read_rows(rows, Kind::Points, &[9, 12], columns, findings, |cells| {
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
    })
}

/// Words and numbers by turns: "Body1Pinned" -> "BODY", 1, "PINNED".
fn decomposed(word: &str) -> (String, Option<usize>, String) {
    let upper = word.to_uppercase();
    let first = upper.find(|c: char| c.is_ascii_digit()).unwrap_or(upper.len());
    let (letters, rest) = upper.split_at(first);
    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (digits, tail) = rest.split_at(digits);
    (letters.to_string(), digits.parse().ok(), tail.to_string())
}

/// The words for attachments, in capitals, without numbers.
fn attachment(cells: &mut Cells<'_, '_>, column: usize) -> Placed<Attachment> {
    let word = cells.word(column);
    let (letters, id, tail) = decomposed(&word.value);
    let pinned = ["PINNED", "PIN"].contains(&tail.as_str());
    let value = match (letters.as_str(), id, tail.as_str()) {
        ("FIXED" | "FIX" | "ANCHOR", _, "") => Some(Attachment::Fixed),
        ("COUPLED" | "CPLD", _, "") => Some(Attachment::Coupled),
        ("VESSEL" | "VES" | "FAIRLEAD", _, "") => Some(Attachment::Vessel),
        ("FREE" | "CONNECT" | "CONNECTION" | "POINT" | "CON" | "P" | "C", _, "") => Some(Attachment::Free),
        ("PINNED" | "PIN", None, "") => Some(Attachment::Pinned(None)),
        ("VESSELPINNED" | "VESPIN" | "COUPLEDPINNED" | "CPLDPIN", None, "") => {
            Some(Attachment::CoupledPinned)
        }
        ("BODY" | "B", Some(id), "") => Some(Attachment::Body(id)),
        ("BODY" | "B", Some(id), _) if pinned => Some(Attachment::Pinned(Some(id))),
        ("TURBINE" | "T", Some(id), "") => Some(Attachment::Turbine(id)),
        _ => None,
    };
    let value = value.unwrap_or_else(|| {
        let problem = format!(
            "expected Fixed, Coupled, Vessel, Free, Body1 or Turbine1, found {}",
            shown(&word.value)
        );
        cells.wrong(column, problem);
        Attachment::Fixed
    });
    let numbered = match value {
        Attachment::Fixed => "Fixed",
        Attachment::Coupled => "Coupled",
        Attachment::Vessel => "Vessel",
        Attachment::Free => "Free",
        _ => "",
    };
    if let Some(id) = id.filter(|_| !numbered.is_empty()) {
        let text = format!(
            "{}: {:?} is read as {numbered}, as in MoorDyn, where the number {id} behind it means nothing",
            cells.place, word.value
        );
        cells.findings.remark(word.span.start, text);
    }
    Placed {
        value,
        span: word.span,
    }
}

/// "3", "Point3", "Con3" or "R1A".
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

/// Whether rows of LINES have the length before the ends (version 1): what the columns hold tells, then the header, then the
/// version of the line types.
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
        names.position(|name| LINES_1[2].spellings.contains(&name.text.to_uppercase().as_str()))
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
    read_rows(
        &section.rows,
        Kind::Lines,
        &[7],
        |_| columns,
        findings,
        |cells| Line {
            id: cells.count(0, 1),
            line_type: known_type(cells, deck),
            ends: [attached(cells, ends, deck), attached(cells, ends + 1, deck)],
            length: cells.number(length),
            segments: cells.count(length + 1, 1),
            outputs: cells.word(6),
        },
    )
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
    let word = cells.word(column);
    let end = line_end(&word.value);
    match end {
        None => {
            let problem = format!(
                "expected the number of a point, or a rod's end such as R1A, found {}",
                shown(&word.value)
            );
            cells.wrong(column, problem);
        }
        Some(end) if !exists(end, deck) => {
            let what = match end {
                LineEnd::Point(id) => format!("no point has the number {id}"),
                LineEnd::Rod(id, _) => format!("no rod has the number {id}"),
            };
            cells.wrong(column, what);
        }
        Some(_) => {}
    }
    Placed {
        value: end.unwrap_or(LineEnd::Point(0)),
        span: word.span,
    }
}

fn whole_rows(sections: &Sections<'_>, kind: Kind) -> Vec<Placed<String>> {
    let rows = sections.rows(kind).iter().take(ROWS_MAX);
    rows.map(|row| Placed {
        value: row.text.trim().to_string(),
        span: row.span(),
    })
    .collect()
}

/// Names of channels, several in a row perhaps, up to END.
fn outputs(sections: &Sections<'_>) -> Vec<Placed<String>> {
    let mut names = Vec::new();
    for row in sections.rows(Kind::Outputs).iter().take(ROWS_MAX) {
        for field in row.split(|c| c.is_whitespace() || [',', '"', '\'', ';'].contains(&c)) {
            if field.text.eq_ignore_ascii_case("END") {
                return names;
            }
            names.push(Placed {
                value: field.text.to_string(),
                span: field.span,
            });
        }
    }
    names
}

/// The columns that rows of a section are read by, where there is a choice.
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
