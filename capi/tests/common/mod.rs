//! Shared parts of the tests of both C libraries: headers, compilers, the libraries that Cargo built.
#![allow(dead_code, reason = "each test uses a part of it")]

use std::collections::BTreeSet;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A compiler and its switches.
pub struct Language {
    pub compiler: &'static str,
    pub switches: &'static [&'static str],
    pub ending: &'static str,
}

/// Strict C and C++.
pub const LANGUAGES: [Language; 3] = [
    Language {
        compiler: "gcc",
        switches: &["-std=c99"],
        ending: "c",
    },
    Language {
        compiler: "gcc",
        switches: &["-std=c17"],
        ending: "c",
    },
    Language {
        compiler: "g++",
        switches: &["-std=c++11"],
        ending: "cpp",
    },
];

/// Warnings that are errors.
pub const STRICT: [&str; 4] = ["-Wall", "-Wextra", "-pedantic", "-Werror"];

/// A header that cbindgen writes.
pub struct Header {
    /// Folder of the package.
    pub package: &'static str,
    /// Header in it.
    pub path: &'static str,
    pub guard: &'static str,
    pub title: &'static str,
    pub note: &'static str,
    /// Name of the library.
    pub library: &'static str,
}

impl Header {
    fn text(&self) -> String {
        let config = cbindgen::Config {
            language: cbindgen::Language::C,
            cpp_compat: true,
            include_guard: Some(self.guard.to_string()),
            header: Some(format!("/* {}\n *\n * {}\n */", self.title, self.note)),
            documentation_style: cbindgen::DocumentationStyle::C99,
            line_length: 140,
            usize_is_size_t: true,
            no_includes: true,
            sys_includes: vec!["stddef.h".to_string(), "stdint.h".to_string()],
            ..cbindgen::Config::default()
        };
        let builder = cbindgen::Builder::new().with_config(config);
        // the modules are found from here, each once
        let builder = builder.with_src(Path::new(self.package).join("src/lib.rs"));
        let mut text = Vec::new();
        builder.generate().unwrap().write(&mut text);
        String::from_utf8(text).unwrap()
    }

    fn file(&self) -> PathBuf {
        Path::new(self.package).join(self.path)
    }

    /// Claims that the committed header is the one that cbindgen writes; `MOORLINE_UPDATE=1` writes it.
    pub fn assert_current(&self) {
        let text = self.text();
        if std::env::var_os("MOORLINE_UPDATE").is_some() {
            std::fs::write(self.file(), &text).unwrap();
        }
        let committed = std::fs::read_to_string(self.file()).unwrap_or_default();
        assert!(
            committed == text,
            "{} is old: MOORLINE_UPDATE=1 cargo test writes it",
            self.path
        );
    }

    /// Claims that a source with nothing but a header compiles without a warning.
    pub fn assert_clean(&self, language: Language, name: &str) {
        if !has(language.compiler) {
            return;
        }
        let folder = tempfile::tempdir().unwrap();
        let source = folder.path().join(format!("one.{}", language.ending));
        std::fs::write(
            &source,
            format!("#include \"{name}\"\nint main(void) {{ return 0; }}\n"),
        )
        .unwrap();
        let mut command = Command::new(language.compiler);
        command.args(language.switches).args(STRICT).arg("-fsyntax-only");
        command.arg("-I").arg(self.file().parent().unwrap()).arg(&source);
        run(&mut command);
    }

    /// Claims that the library exports the functions of the header, each declared once, and no others.
    pub fn assert_symbols(&self) {
        if !cfg!(target_os = "linux") || !has("nm") {
            return;
        }
        let text = std::fs::read_to_string(self.file()).unwrap();
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let code = text
            .split("*/")
            .map(|part| part.split("/*").next().unwrap_or_default());
        let code: String = code.collect::<Vec<_>>().join("\n");
        let declarations: Vec<String> = code
            .match_indices('(')
            .filter_map(|(at, _)| code[..at].rsplit(|c| !is_name(c)).next())
            .filter(|name| !name.is_empty() && !["defined"].contains(name))
            .map(ToString::to_string)
            .collect();
        let declared: BTreeSet<String> = declarations.iter().cloned().collect();
        assert_eq!(declarations.len(), declared.len());
        let listed = run(Command::new("nm")
            .args(["-D", "--defined-only"])
            .arg(library(self.library)));
        let exported = listed.lines().filter_map(|line| line.split_whitespace().nth(2));
        let exported: BTreeSet<String> = exported.map(ToString::to_string).collect();
        assert_eq!(exported, declared);
    }
}

/// Path of a library that Cargo built for this test.
pub fn library(name: &str) -> PathBuf {
    let program = std::env::current_exe().unwrap();
    let folder = program.parent().and_then(Path::parent).unwrap();
    let file = format!("{DLL_PREFIX}{name}{DLL_SUFFIX}");
    let places = [folder.join("deps").join(&file), folder.join(&file)];
    let newest = places.into_iter().filter(|path| path.is_file());
    let newest = newest.max_by_key(|path| path.metadata().and_then(|data| data.modified()).unwrap());
    newest.unwrap_or_else(|| panic!("no {file} in {}: cargo build makes it", folder.display()))
}

/// Returns whether a tool is on this machine; prints that a test is skipped where not.
pub fn has(tool: &str) -> bool {
    let found = Command::new(tool).arg("--version").output().is_ok();
    if !found {
        println!("skipped: there is no {tool} on this machine");
    }
    found
}

/// Runs a command and returns its output; fails the test with all it wrote where it fails.
pub fn run(command: &mut Command) -> String {
    let done = command
        .output()
        .unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let [out, err] = [&done.stdout, &done.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert!(
        done.status.success(),
        "{command:?}: {}\n{out}\n{err}",
        done.status
    );
    out
}
