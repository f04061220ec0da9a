//! The manners of the house that a compiler does not check: layers, length of functions, units, no loose ends.
//!
//! Rules read source text with comments and literals blanked out, so they see no types; each names file and line.

use std::fs;
use std::path::{Path, PathBuf};

/// Longest function, in lines.
const FUNCTION_LINES_MAX: usize = 70;

/// The layers from the ground up: each may use those before it.
const LAYERS: [&str; 11] = [
    "math",
    "physics",
    "scene",
    "model",
    "elements",
    "statics",
    "dynamics",
    "simulation",
    "discretisation",
    "interface",
    "output",
];

/// The packages of the workspace, each with those it may use: the library uses none, the program and what goes into an FMU stand
/// on top.
const PACKAGES: [(&str, &[&str]); 7] = [
    (".", &[]),
    ("accuracy", &["moorline"]),
    (
        "cli",
        &["moorline", "moorline-accuracy", "moorline-decks", "moorline-host"],
    ),
    ("decks", &["moorline"]),
    ("fmu", &["moorline", "moorline-host"]),
    ("fmu/conformance", &["moorline-host"]),
    ("fmu/host", &["moorline"]),
];

/// A source file, as it is and without comments and literals.
struct Source {
    /// Path from the root of the repository, with forward slashes.
    path: String,
    text: String,
    /// The same text, with the inside of comments, strings and characters replaced by blanks.
    code: String,
}

impl Source {
    fn line_of(&self, byte: usize) -> usize {
        self.text[..byte].matches('\n').count() + 1
    }

    fn place(&self, byte: usize) -> String {
        format!("{}:{}", self.path, self.line_of(byte))
    }

    fn is_under(&self, folder: &str) -> bool {
        self.path.starts_with(&format!("{folder}/"))
    }
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Files of the repository with one of these extensions, without what builds and tools leave behind.
fn files(folder: &Path, extensions: &[&str], found: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for path in entries.map(|entry| entry.unwrap().path()) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let hidden = name.starts_with('.') && name != ".ci";
        if hidden || ["target", "out", "__pycache__", "node_modules"].contains(&name.as_str()) {
            continue;
        }
        if path.is_dir() {
            files(&path, extensions, found);
        } else if path
            .extension()
            .is_some_and(|e| extensions.iter().any(|wanted| e == *wanted))
        {
            found.push(path);
        }
    }
}

fn relative(path: &Path) -> String {
    let path = path.strip_prefix(root()).unwrap();
    path.to_string_lossy().replace('\\', "/")
}

/// All Rust files of the workspace.
fn sources() -> Vec<Source> {
    let mut found = Vec::new();
    files(&root(), &["rs"], &mut found);
    found.sort();
    let sources: Vec<Source> = found
        .iter()
        .map(|path| {
            let text = fs::read_to_string(path).unwrap();
            Source {
                path: relative(path),
                code: blanked(&text),
                text,
            }
        })
        .collect();
    assert!(sources.iter().any(|source| source.path == "src/lib.rs"));
    sources
}

/// The same bytes, but comments and the inside of literals are blanks; line breaks stay.
fn blanked(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut code = bytes.to_vec();
    let mut at = 0;
    while at < bytes.len() {
        let end = literal_end(text, at);
        match end {
            Some(end) => {
                for byte in &mut code[at..end] {
                    if *byte != b'\n' {
                        *byte = b' ';
                    }
                }
                at = end;
            }
            None => at += 1,
        }
    }
    String::from_utf8(code).unwrap_or_else(|error| {
        // Bytes outside ASCII occur in code only as whole characters, which blanking leaves whole.
        panic!("blanking split a character: {error}")
    })
}

/// End of the comment or literal that starts at this byte, where one does.
fn literal_end(text: &str, at: usize) -> Option<usize> {
    let rest = &text.as_bytes()[at..];
    let previous_is_name = at > 0 && is_name_byte(text.as_bytes()[at - 1]);
    match rest {
        [b'/', b'/', ..] => Some(text[at..].find('\n').map_or(text.len(), |n| at + n)),
        [b'/', b'*', ..] => Some(block_comment_end(text, at)),
        [b'"', ..] => Some(string_end(text, at + 1)),
        [b'r', b'"' | b'#', ..] if !previous_is_name => raw_string_end(text, at + 1),
        [b'b', b'r', b'"' | b'#', ..] if !previous_is_name => raw_string_end(text, at + 2),
        [b'\'', ..] => char_end(text, at),
        _ => None,
    }
}

fn is_name_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

fn block_comment_end(text: &str, start: usize) -> usize {
    let bytes = text.as_bytes();
    let mut depth = 0;
    let mut at = start;
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => {
                depth += 1;
                at += 2;
            }
            b"*/" => {
                depth -= 1;
                at += 2;
                if depth == 0 {
                    return at;
                }
            }
            _ => at += 1,
        }
    }
    bytes.len()
}

fn string_end(text: &str, inside: usize) -> usize {
    let mut escaped = false;
    for (offset, byte) in text.as_bytes()[inside..].iter().enumerate() {
        if *byte == b'"' && !escaped {
            return inside + offset + 1;
        }
        escaped = *byte == b'\\' && !escaped;
    }
    text.len()
}

fn raw_string_end(text: &str, after_r: usize) -> Option<usize> {
    let rest = &text[after_r..];
    let hashes = rest.len() - rest.trim_start_matches('#').len();
    let inside = rest[hashes..].strip_prefix('"')?;
    let closing = format!("\"{}", "#".repeat(hashes));
    let length = inside.find(&closing).map_or(inside.len(), |n| n + closing.len());
    Some(after_r + hashes + 1 + length)
}

/// End of a character; a lifetime is none.
fn char_end(text: &str, at: usize) -> Option<usize> {
    let inside = &text[at + 1..];
    if inside.starts_with('\\') {
        let closing = inside[2..].find('\'')?;
        return Some(at + 1 + 2 + closing + 1);
    }
    let character = inside.chars().next()?;
    let after = &inside[character.len_utf8()..];
    after.starts_with('\'').then(|| at + 1 + character.len_utf8() + 1)
}

/// Places where a whole word stands in code.
fn words<'t>(code: &'t str, word: &'t str) -> impl Iterator<Item = usize> + 't {
    code.match_indices(word).map(|(at, _)| at).filter(move |at| {
        let bytes = code.as_bytes();
        let after = at + word.len();
        let free_before = *at == 0 || !is_name_byte(bytes[at - 1]);
        free_before && bytes.get(after).is_none_or(|byte| !is_name_byte(*byte))
    })
}

fn assert_none(complaints: &[String], rule: &str) {
    assert!(complaints.is_empty(), "{rule}\n  {}", complaints.join("\n  "));
}

/// The layer a file of the library belongs to.
fn layer_of(path: &str) -> Option<usize> {
    let inside = path.strip_prefix("src/")?;
    let name = inside.split(['/', '.']).next()?;
    LAYERS.iter().position(|layer| *layer == name)
}

/// Layers named after `crate::` or within `crate::{…}`, with their places.
fn layers_used(code: &str) -> Vec<(usize, usize)> {
    let mut used = Vec::new();
    for at in words(code, "crate") {
        let Some(path) = code[at..].strip_prefix("crate::") else {
            continue;
        };
        let names: Vec<&str> = match path.strip_prefix('{') {
            Some(group) => outer_names(group),
            None => vec![path],
        };
        for name in names {
            let end = name.bytes().position(|byte| !is_name_byte(byte));
            let name = &name[..end.unwrap_or(name.len())];
            if let Some(layer) = LAYERS.iter().position(|layer| *layer == name) {
                used.push((at, layer));
            }
        }
    }
    used
}

/// Beginnings of the parts of a group in braces, without groups inside it.
fn outer_names(group: &str) -> Vec<&str> {
    let mut depth = 0;
    let mut names = vec![group.trim_start()];
    for (at, byte) in group.bytes().enumerate() {
        match byte {
            b'{' => depth += 1,
            b'}' if depth == 0 => break,
            b'}' => depth -= 1,
            b',' if depth == 0 => names.push(group[at + 1..].trim_start()),
            _ => {}
        }
    }
    names
}

#[test]
fn layers_use_only_the_layers_below_them() {
    let mut complaints = Vec::new();
    for source in sources() {
        let Some(layer) = layer_of(&source.path) else {
            continue;
        };
        for (at, used) in layers_used(&source.code) {
            // The scene uses no law.
            let scene_and_physics = LAYERS[layer] == "scene" && LAYERS[used] == "physics";
            if used > layer || scene_and_physics {
                let place = source.place(at);
                complaints.push(format!("{place}: {} uses {}", LAYERS[layer], LAYERS[used]));
            }
        }
    }
    assert_none(&complaints, "layers point one way (DESIGN, section 3)");
}

/// Names of the dependencies of a manifest, development ones included.
fn dependencies(manifest: &str) -> Vec<&str> {
    let mut inside = false;
    let mut names = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            inside = line.ends_with("dependencies]");
        } else if let Some((name, _)) = line.split_once(" = ").filter(|_| inside) {
            names.push(name);
        }
    }
    names
}

#[test]
fn packages_use_only_the_packages_below_them() {
    let manifest = |folder: &str| fs::read_to_string(root().join(folder).join("Cargo.toml")).unwrap();
    let workspace = manifest(".");
    let members = workspace.lines().find(|line| line.starts_with("members = "));
    let known = PACKAGES.map(|(folder, _)| format!("{folder:?}"));
    assert_eq!(
        members,
        Some(format!("members = [{}]", known.join(", ")).as_str())
    );
    let mut complaints = Vec::new();
    for (folder, allowed) in PACKAGES {
        let manifest = manifest(folder);
        let own = dependencies(&manifest);
        let own = own.into_iter().filter(|name| name.starts_with("moorline"));
        let forbidden = own.filter(|name| !allowed.contains(name));
        complaints.extend(forbidden.map(|name| format!("{folder}/Cargo.toml: {name}")));
    }
    assert_none(&complaints, "packages point one way (DESIGN, section 3)");
}

/// First and last byte of every function with a body.
fn functions(code: &str) -> Vec<(usize, usize)> {
    words(code, "fn")
        .filter_map(|start| {
            let rest = &code[start..];
            // A type such as `fn(f64) -> f64` has no name.
            rest[2..]
                .trim_start()
                .bytes()
                .next()
                .filter(|byte| is_name_byte(*byte))?;
            let open = body_start(rest)?;
            Some((start, start + open + block_length(&rest[open..])?))
        })
        .collect()
}

/// First byte of the body; a declaration without one ends in a semicolon first.
fn body_start(code: &str) -> Option<usize> {
    let mut depth = 0;
    for (at, byte) in code.bytes().enumerate() {
        match byte {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth -= 1,
            b'{' if depth == 0 => return Some(at),
            b';' if depth == 0 => return None,
            _ => {}
        }
    }
    None
}

fn block_length(code: &str) -> Option<usize> {
    let mut depth = 0;
    for (at, byte) in code.bytes().enumerate() {
        match byte {
            b'{' => depth += 1,
            b'}' => {
                depth -= 1;
                if depth == 0 {
                    return Some(at);
                }
            }
            _ => {}
        }
    }
    None
}

#[test]
fn a_function_fits_a_screen() {
    let mut complaints = Vec::new();
    for source in sources() {
        for (start, end) in functions(&source.code) {
            let lines = source.line_of(end) - source.line_of(start) + 1;
            if lines > FUNCTION_LINES_MAX {
                let place = source.place(start);
                complaints.push(format!("{place}: {lines} lines"));
            }
        }
    }
    let rule = format!("a function has at most {FUNCTION_LINES_MAX} lines");
    assert_none(&complaints, &rule);
}

/// Returns true where a doc comment names a unit in brackets, such as `[m]`; links to items in backticks are none.
fn says_a_unit(doc: &str) -> bool {
    doc.split('[').skip(1).any(|inside| {
        let unit = inside.split(']').next().unwrap_or("");
        inside.contains(']') && !unit.is_empty() && !unit.contains('`') && unit.chars().count() <= 24
    })
}

/// The doc comment above the line that starts at this byte; attributes in between do not matter.
fn doc_above(text: &str, line_start: usize) -> String {
    let lines = text[..line_start].lines().rev().map(str::trim);
    let mut doc: Vec<&str> = lines
        .take_while(|line| line.starts_with("///") || line.starts_with("#["))
        .filter(|line| line.starts_with("///"))
        .collect();
    doc.reverse();
    doc.join("\n")
}

/// Public fields and functions that carry an f64 in the open.
fn public_numbers(source: &Source) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for at in words(&source.code, "pub") {
        let rest = source.code[at + 3..].trim_start();
        let rest = rest.strip_prefix("const ").unwrap_or(rest);
        let declaration = if rest.starts_with("fn ") {
            let body = rest.find(['{', ';']).unwrap_or(rest.len());
            let head = &rest[..body];
            head.split_once("->").map_or("", |(_, output)| output)
        } else if is_field(rest) {
            let line = rest.lines().next().unwrap_or("");
            line.split_once(':').map_or("", |(_, kind)| kind)
        } else {
            continue;
        };
        if words(declaration, "f64").next().is_some() {
            let name = rest.strip_prefix("fn ").unwrap_or(rest);
            let end = name.bytes().position(|byte| !is_name_byte(byte)).unwrap_or(0);
            found.push((at, name[..end].to_string()));
        }
    }
    found
}

/// `name: type`, but not `NAME: type = …`, nor `use`, `struct` and the like.
fn is_field(declaration: &str) -> bool {
    let name_end = declaration.bytes().position(|byte| !is_name_byte(byte));
    name_end.is_some_and(|end| {
        end > 0 && declaration[end..].starts_with(':') && !declaration[end..].starts_with("::")
    })
}

#[test]
fn every_public_number_says_its_unit() {
    let mut complaints = Vec::new();
    let layers = ["src/physics", "src/model", "src/scene", "decks/src"];
    for source in sources() {
        if !layers.iter().any(|layer| source.is_under(layer)) {
            continue;
        }
        for (at, name) in public_numbers(&source) {
            let line_start = source.text[..at].rfind('\n').map_or(0, |n| n + 1);
            if !says_a_unit(&doc_above(&source.text, line_start)) {
                let place = source.place(at);
                complaints.push(format!("{place}: `{name}` says no unit"));
            }
        }
    }
    assert_none(
        &complaints,
        "the docs of a public f64 name its unit, as in [m] or [-]",
    );
}

#[test]
fn only_the_fmu_is_unsafe() {
    let mut complaints = Vec::new();
    for source in sources() {
        if !source.is_under("fmu") {
            complaints.extend(words(&source.code, "unsafe").map(|at| source.place(at)));
        }
    }
    assert_none(&complaints, "`unsafe` stands in fmu/ only");
}

#[test]
fn only_the_command_line_prints() {
    let mut complaints = Vec::new();
    let printing = ["print", "println", "eprint", "eprintln", "dbg"];
    for source in sources() {
        let libraries = ["src", "accuracy/src", "decks/src", "fmu/src"];
        if !libraries.iter().any(|folder| source.is_under(folder)) {
            continue;
        }
        for name in printing {
            for at in words(&source.code, name) {
                if source.code[at + name.len()..].starts_with('!') {
                    complaints.push(format!("{}: {name}!", source.place(at)));
                }
            }
        }
    }
    assert_none(&complaints, "the library does not print");
}

#[test]
fn nothing_is_left_to_be_done() {
    let mut complaints = Vec::new();
    for source in sources() {
        for name in ["todo", "unimplemented"] {
            for at in words(&source.code, name) {
                if source.code[at + name.len()..].starts_with('!') {
                    complaints.push(format!("{}: {name}!", source.place(at)));
                }
            }
        }
        for mark in [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")] {
            let marks = words(&source.text, mark).map(|at| format!("{}: {mark}", source.place(at)));
            complaints.extend(marks);
        }
    }
    assert_none(&complaints, "what is merged is done");
}

/// Laws by a part of their code that no other file has: law, fingerprint, home. Blanks do not count.
const FINGERPRINTS: [(&str, &str, &str); 9] = [
    ("area of a circle", "0.25*PI", "math/circle.rs"),
    ("second moment of area, of EI", "/64.0", "math/circle.rs"),
    (
        "drag of a slender cylinder",
        "0.5*density*diameter",
        "physics/morison.rs",
    ),
    (
        "resistance by drag coefficients",
        "fnresistance",
        "physics/morison.rs",
    ),
    (
        "tension of spring and damper",
        "fntotal_tension",
        "physics/stretch.rs",
    ),
    (
        "matrix of a slender node",
        "x.scaled(self.across)+tangent",
        "physics/slender.rs",
    ),
    ("ellipse of friction", "fnslide<", "physics/friction.rs"),
    (
        "contact over a leapfrog step with friction",
        "fnsolve(&self,free:V",
        "physics/friction_step.rs",
    ),
    (
        "normal force of the seabed",
        "fnnormal_force",
        "physics/seabed.rs",
    ),
];

#[test]
fn each_law_is_written_in_one_file() {
    let sources = sources();
    let mut complaints = Vec::new();
    for (law, fingerprint, home) in FINGERPRINTS {
        let dense = |source: &Source| source.code.replace(char::is_whitespace, "");
        let library = sources.iter().filter(|source| source.is_under("src"));
        let homes = library.filter(|source| dense(source).contains(fingerprint));
        let homes: Vec<&str> = homes.map(|source| source.path.as_str()).collect();
        if homes != [format!("src/{home}")] {
            complaints.push(format!(
                "{law}: {fingerprint} is in {homes:?}, its home is src/{home}"
            ));
        }
    }
    assert_none(&complaints, "one law, one home");
}

/// Folders that exist on somebody's machine only.
const MACHINE_FOLDERS: [&str; 5] = [
    concat!("/ho", "me/"),
    concat!("/ro", "ot/"),
    concat!("/wo", "rk/"),
    concat!("/Us", "ers/"),
    concat!("C:\\", "Users"),
];

#[test]
fn no_file_names_a_folder_of_one_machine() {
    let extensions = [
        "rs", "toml", "py", "md", "sh", "yml", "yaml", "json", "xml", "csv", "txt", "html",
    ];
    let mut found = Vec::new();
    files(&root(), &extensions, &mut found);
    let mut complaints = Vec::new();
    for path in found {
        let Ok(text) = fs::read_to_string(&path) else {
            continue;
        };
        for (number, line) in text.lines().enumerate() {
            for folder in MACHINE_FOLDERS {
                // Inside a longer path or address it is some other folder.
                let alone = |at: usize| {
                    let before = line[..at].chars().next_back();
                    before.is_none_or(|c| !c.is_alphanumeric() && !"._-}$~".contains(c))
                };
                if line.match_indices(folder).any(|(at, _)| alone(at)) {
                    let place = format!("{}:{}", relative(&path), number + 1);
                    complaints.push(format!("{place}: {folder}"));
                }
            }
        }
    }
    assert_none(&complaints, "paths of one machine help nobody else");
}

#[test]
fn the_rules_find_what_they_look_for() {
    let text = "fn a<'a>(x: &'a str) -> char {\n  // } unsafe\n  let s = r#\"} \" {\"#;\n  '}' /* { /* } */ */\n}\nfn b();\n";
    let code = blanked(text);
    assert_eq!(code.len(), text.len());
    assert!(words(&code, "unsafe").next().is_none());
    let found = functions(&code);
    assert_eq!(found.len(), 1);
    assert_eq!(&text[found[0].1..found[0].1 + 1], "}");
    assert_eq!(text[..found[0].1].matches('\n').count(), 4);

    let used = layers_used("use crate::{math::x, output::{self, y}};\nuse crate::model;\n");
    let names: Vec<&str> = used.iter().map(|(_, layer)| LAYERS[*layer]).collect();
    assert_eq!(names, ["math", "output", "model"]);
    assert_eq!(
        layer_of("src/simulation.rs"),
        LAYERS.iter().position(|l| *l == "simulation")
    );

    let text = "/// Length [m].\npub length: f64,\n/// See [`Line`].\n#[serde(default)]\npub mass: Option<f64>,\npub name: String,\n";
    let source = Source {
        path: "src/model/x.rs".into(),
        text: text.into(),
        code: blanked(text),
    };
    let numbers = public_numbers(&source);
    let silent: Vec<&str> = numbers
        .iter()
        .filter(|(at, _)| !says_a_unit(&doc_above(text, *at)))
        .map(|(_, name)| name.as_str())
        .collect();
    assert_eq!(numbers.len(), 2);
    assert_eq!(silent, ["mass"]);
}
