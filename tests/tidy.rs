//! Rules of the house that the compiler does not check: layers, length of functions, units, no loose ends.
//!
//! The rules operate on tokens, without types; each violation is reported with file and line.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};

/// Maximum number of lines of a function [-].
const FUNCTION_LINES_MAX: usize = 70;

/// Layers from the lowest up: each may use those before it.
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

/// Packages of the workspace, each with those that it may use: the library uses none; the program and the code of an FMU
/// are at the top.
const PACKAGES: [(&str, &[&str]); 13] = [
    (".", &[]),
    ("accuracy", &["moorline", "moorline-host"]),
    ("boundary", &["moorline"]),
    ("capi", &["moorline", "moorline-boundary", "moorline-decks"]),
    (
        "capi/moordyn",
        &["moorline", "moorline-boundary", "moorline-system"],
    ),
    ("capi/system", &["moorline", "moorline-decks"]),
    (
        "cli",
        &[
            "moorline",
            "moorline-accuracy",
            "moorline-decks",
            "moorline-host",
            "moorline-sweep",
            "moorline-fmu",
        ],
    ),
    ("decks", &["moorline"]),
    ("fmu", &["moorline", "moorline-boundary", "moorline-host"]),
    ("fmu/conformance", &["moorline-host"]),
    ("fmu/host", &["moorline"]),
    (
        "python",
        &[
            "moorline",
            "moorline-cli",
            "moorline-decks",
            "moorline-sweep",
            "moorline-system",
        ],
    ),
    ("sweep", &["moorline", "moorline-decks"]),
];

/// A word, sign, literal or bracket, and its line.
struct Token {
    text: String,
    line: usize,
}

/// A source file.
struct Source {
    /// Path from the root of the repository, with forward slashes.
    path: String,
    text: String,
    /// Tokens of the text. Comments are not tokens, except doc comments, which are attributes.
    tokens: Vec<Token>,
}

/// Adds the tokens of a stream, brackets included.
fn flatten(stream: TokenStream, tokens: &mut Vec<Token>) {
    let token = |text: &str, span: Span| Token {
        text: text.to_string(),
        line: span.start().line,
    };
    for tree in stream {
        match tree {
            TokenTree::Group(group) => {
                let [open, close] = match group.delimiter() {
                    Delimiter::Parenthesis => ["(", ")"],
                    Delimiter::Brace => ["{", "}"],
                    Delimiter::Bracket => ["[", "]"],
                    Delimiter::None => ["", ""],
                };
                tokens.push(token(open, group.span_open()));
                flatten(group.stream(), tokens);
                tokens.push(token(close, group.span_close()));
            }
            other => tokens.push(token(&other.to_string(), other.span())),
        }
    }
}

impl Source {
    fn new(path: String, text: String) -> Source {
        let stream: TokenStream = text.parse().unwrap_or_else(|error| panic!("{path}: {error}"));
        let mut tokens = Vec::new();
        flatten(stream, &mut tokens);
        Source { path, text, tokens }
    }

    fn is_under(&self, folder: &str) -> bool {
        self.path.starts_with(&format!("{folder}/"))
    }

    /// Text of a token; empty beyond the last one.
    fn at(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| &token.text)
    }

    /// Indices of a word or sign.
    fn places(&self, word: &str) -> impl Iterator<Item = usize> {
        (0..self.tokens.len()).filter(move |i| self.tokens[*i].text == word)
    }

    /// Lines in which a macro is called, with the macro's name.
    fn calls(&self, name: &str) -> impl Iterator<Item = (usize, String)> {
        let calls = self.places(name).filter(|i| self.at(i + 1) == "!");
        calls.map(move |i| (self.tokens[i].line, format!("{name}!")))
    }

    /// Index of the bracket that closes the one at `open`.
    fn closing(&self, open: usize) -> usize {
        let mut depth = 0;
        let closes = |i: &usize| {
            match self.at(*i) {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
            depth == 0
        };
        (open..self.tokens.len()).find(closes).expect("a closing bracket")
    }

    /// Index of the brace or semicolon that ends the head of a function.
    fn head_end(&self, start: usize) -> usize {
        let mut at = start;
        while !["{", ";", ""].contains(&self.at(at)) {
            at = if ["(", "["].contains(&self.at(at)) {
                self.closing(at) + 1
            } else {
                at + 1
            };
        }
        at
    }

    /// First and last line of every function with a body; a type such as `fn(f64) -> f64` has no name and is skipped.
    fn functions(&self) -> impl Iterator<Item = [usize; 2]> {
        let named = self.places("fn").filter(|i| is_name(self.at(i + 1)));
        let bodies = named.map(|start| (start, self.head_end(start)));
        let bodies = bodies.filter(|(_, open)| self.at(*open) == "{");
        bodies.map(|(start, open)| [start, self.closing(open)].map(|i| self.tokens[i].line))
    }

    /// Layers named after `crate::` or within `crate::{…}`, with their lines.
    fn layers_used(&self) -> Vec<(usize, usize)> {
        let mut used = Vec::new();
        for at in self.places("crate").filter(|i| self.at(i + 1) == ":") {
            let mut names = vec![at + 3];
            if self.at(at + 3) == "{" {
                let mut inside = at + 4;
                names = vec![inside];
                while inside < self.closing(at + 3) {
                    inside = if self.at(inside) == "{" {
                        self.closing(inside) + 1
                    } else {
                        inside + 1
                    };
                    names.extend((self.at(inside) == ",").then_some(inside + 1));
                }
            }
            let layer = |name: &usize| LAYERS.iter().position(|layer| *layer == self.at(*name));
            used.extend(
                names
                    .iter()
                    .filter_map(layer)
                    .map(|layer| (self.tokens[at].line, layer)),
            );
        }
        used
    }

    /// Documentation of the item that begins at a token; other attributes are skipped.
    fn documentation(&self, item: usize) -> String {
        let (mut at, mut lines) = (item, String::new());
        while at > 0 && self.at(at - 1) == "]" {
            let open = (0..at)
                .rev()
                .find(|i| self.at(*i) == "[" && self.closing(*i) == at - 1);
            let open = open.expect("an opening bracket");
            if self.at(open + 1) == "doc" {
                lines.insert_str(0, self.at(open + 3));
            }
            at = open - 1;
        }
        lines
    }

    /// Public fields and functions whose type contains f64: token index and name.
    fn public_numbers(&self) -> Vec<(usize, &str)> {
        let mut found = Vec::new();
        for at in self.places("pub") {
            let start = if self.at(at + 1) == "const" {
                at + 2
            } else {
                at + 1
            };
            let (name, declared) = match (self.at(start), self.at(start + 1), self.at(start + 2)) {
                ("fn", name, _) => {
                    let arrow = |i: &usize| self.at(*i) == "-" && self.at(i + 1) == ">";
                    let end = self.head_end(start);
                    (name, (start..end).find(arrow).unwrap_or(end)..end)
                }
                (name, ":", next) if is_name(name) && next != ":" => {
                    let same_line = |i: &usize| self.tokens[*i].line == self.tokens[start].line;
                    (
                        name,
                        start
                            ..(start..self.tokens.len())
                                .take_while(same_line)
                                .last()
                                .unwrap_or(start),
                    )
                }
                _ => continue,
            };
            if declared.into_iter().any(|i| self.at(i) == "f64") {
                found.push((at, name));
            }
        }
        found
    }
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Files of the repository with one of these extensions, without output of builds and tools.
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
static SOURCES: LazyLock<Vec<Source>> = LazyLock::new(|| {
    let mut found = Vec::new();
    files(&root(), &["rs"], &mut found);
    found.sort();
    let read = |path: &PathBuf| Source::new(relative(path), fs::read_to_string(path).unwrap());
    let sources: Vec<Source> = found.iter().map(read).collect();
    assert!(sources.iter().any(|source| source.path == "src/lib.rs"));
    sources
});

fn assert_none(complaints: &[String], rule: &str) {
    assert!(complaints.is_empty(), "{rule}\n  {}", complaints.join("\n  "));
}

/// Asserts that no source breaks a rule; `breaks` returns the lines that do, with a description.
fn assert_kept(rule: &str, breaks: impl Fn(&Source) -> Vec<(usize, String)>) {
    let of = |source: &'static Source| {
        let broken = breaks(source).into_iter();
        broken.map(|(line, words)| format!("{}:{line}: {words}", source.path))
    };
    assert_none(&SOURCES.iter().flat_map(of).collect::<Vec<_>>(), rule);
}

/// The layer to which a file of the library belongs.
fn layer_of(path: &str) -> Option<usize> {
    let inside = path.strip_prefix("src/")?;
    let name = inside.split(['/', '.']).next()?;
    LAYERS.iter().position(|layer| *layer == name)
}

#[test]
fn layers_use_only_the_layers_below_them() {
    assert_kept("layers point one way (DESIGN, section 3)", |source| {
        let Some(layer) = layer_of(&source.path) else {
            return Vec::new();
        };
        // the scene does not use laws
        let forbidden = |used: usize| used > layer || (LAYERS[layer], LAYERS[used]) == ("scene", "physics");
        let used = source
            .layers_used()
            .into_iter()
            .filter(|(_, used)| forbidden(*used));
        used.map(|(line, used)| (line, format!("{} uses {}", LAYERS[layer], LAYERS[used])))
            .collect()
    });
}

/// Names of the dependencies in a manifest, including development dependencies.
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

#[test]
fn a_function_fits_a_screen() {
    let rule = format!("a function has at most {FUNCTION_LINES_MAX} lines");
    assert_kept(&rule, |source| {
        let lines = source.functions().map(|[start, end]| (start, end - start + 1));
        let long = lines.filter(|(_, lines)| *lines > FUNCTION_LINES_MAX);
        long.map(|(start, lines)| (start, format!("{lines} lines")))
            .collect()
    });
}

/// Returns whether a doc comment contains a unit in brackets, such as `[m]`; links to items in backticks do not count.
fn says_a_unit(doc: &str) -> bool {
    doc.split('[').skip(1).any(|inside| {
        let unit = inside.split(']').next().unwrap_or("");
        inside.contains(']') && !unit.is_empty() && !unit.contains('`') && unit.chars().count() <= 24
    })
}

#[test]
fn every_public_number_says_its_unit() {
    let layers = [
        "src/physics",
        "src/model",
        "src/scene",
        "capi/system/src",
        "decks/src",
        "sweep/src",
    ];
    assert_kept(
        "the docs of a public f64 name its unit, as in [m] or [-]",
        |source| {
            if !layers.iter().any(|layer| source.is_under(layer)) {
                return Vec::new();
            }
            let numbers = source.public_numbers().into_iter();
            let silent = numbers.filter(|(at, _)| !says_a_unit(&source.documentation(*at)));
            silent
                .map(|(at, name)| (source.tokens[at].line, format!("`{name}` says no unit")))
                .collect()
        },
    );
}

#[test]
fn only_the_libraries_that_a_host_loads_are_unsafe() {
    assert_kept("`unsafe` stands in boundary/, fmu/ and capi/ only", |source| {
        let unsafe_folders = ["boundary", "fmu", "capi"];
        let is_safe =
            !unsafe_folders.iter().any(|folder| source.is_under(folder)) || source.is_under("capi/system");
        let places = source.places("unsafe").filter(|_| is_safe);
        places
            .map(|i| (source.tokens[i].line, "unsafe".to_string()))
            .collect()
    });
}

#[test]
fn only_the_command_line_prints() {
    let libraries = [
        "src",
        "accuracy/src",
        "boundary/src",
        "capi/src",
        "capi/moordyn/src",
        "capi/system/src",
        "decks/src",
        "fmu/src",
        "python/src",
        "sweep/src",
    ];
    assert_kept("the library does not print", |source| {
        let printing = ["print", "println", "eprint", "eprintln", "dbg"];
        let calls = printing.iter().flat_map(|name| source.calls(name));
        calls
            .filter(|_| libraries.iter().any(|folder| source.is_under(folder)))
            .collect()
    });
}

#[test]
fn nothing_is_left_to_be_done() {
    let marks = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")];
    assert_kept("all that is merged is done", |source| {
        let mut left: Vec<_> = ["todo", "unimplemented"]
            .iter()
            .flat_map(|name| source.calls(name))
            .collect();
        for (number, line) in source.text.lines().enumerate() {
            let mut words = line.split(|c: char| !c.is_alphanumeric() && c != '_');
            left.extend(
                words
                    .find(|word| marks.contains(word))
                    .map(|mark| (number + 1, mark.to_string())),
            );
        }
        left
    });
}

/// Laws identified by a part of their code that only their own file contains: law, fingerprint, file. Blanks are ignored.
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
    let mut complaints = Vec::new();
    for (law, fingerprint, home) in FINGERPRINTS {
        let dense = |source: &Source| {
            let code = source.tokens.iter().filter(|token| !token.text.contains('"'));
            code.map(|token| token.text.as_str()).collect::<String>()
        };
        let library = SOURCES.iter().filter(|source| source.is_under("src"));
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

/// Folders that exist only on individual machines.
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
                // Inside a longer path or address it is a different folder.
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
    let source = |text: &str| Source::new("src/model/x.rs".into(), text.into());
    let text = "fn a<'a>(x: &'a str) -> char {\n  // } unsafe\n  let s = r#\"} \" {\"#;\n  '}' /* { /* } */ */\n}\nfn b();\n";
    let one = source(text);
    assert!(one.places("unsafe").next().is_none());
    assert_eq!(one.functions().collect::<Vec<_>>(), [[1, 5]]);

    let used = source("use crate::{math::x, output::{self, y}};\nuse crate::model;\n").layers_used();
    let names: Vec<&str> = used.iter().map(|(_, layer)| LAYERS[*layer]).collect();
    assert_eq!(names, ["math", "output", "model"]);
    assert_eq!(
        layer_of("src/simulation.rs").map(|layer| LAYERS[layer]),
        Some("simulation")
    );

    let fields = source(
        "struct A {\n/// Length [m].\npub length: f64,\n/// See [`Line`].\n#[serde(default)]\npub mass: Option<f64>,\npub name: String,\n}",
    );
    let numbers = fields.public_numbers();
    assert_eq!(
        numbers.iter().map(|(_, name)| *name).collect::<Vec<_>>(),
        ["length", "mass"]
    );
    let silent = numbers
        .iter()
        .filter(|(at, _)| !says_a_unit(&fields.documentation(*at)));
    assert_eq!(silent.map(|(_, name)| *name).collect::<Vec<_>>(), ["mass"]);
    let function =
        source("/// Mass [kg].\npub fn mass(x: f64) -> Option<f64> {\n}\npub fn name(x: f64) -> String {}");
    assert_eq!(function.public_numbers().len(), 1);
}
