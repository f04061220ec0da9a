//! Scenes damaged as users and disks damage files. Each is either refused with the place of the fault, or is
//! still a scene; then it has an equilibrium of finite numbers, or a message with the reason why not. None panics
//! or hangs.
//!
//! Mutations come from a generator with a fixed seed, so the files are the same every time.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use crate::common::Chance;
use moorline::scene::{LoadError, load};
use moorline::simulation::{Error, Simulation};

/// Time limit for one file in a busy test run [s]; most take milliseconds.
const PATIENCE: Duration = Duration::from_secs(120);

/// A system with a variety of features: a vessel, sections, a clump, a surface-piercing line, a motion.
const SYSTEM: &str = include_str!("../scenes/barge.toml");

/// Replacement values: not numbers, out of range, or of types that no key accepts.
const VALUES: &str = "nan|inf|-inf|1e300|-1e300|1e-300|1e-15|1e-6|0|-1|-0.08|1e999|99999999999999999999|100001|1e12|\
    true|\"\"|\"x\"|\"anchor1\"|\"\\u0000\"|[]|[1.0]|[nan, 0.0, 0.0]|[[0.0, 0.0]]|{}|{ type = 1 }|0x|";

/// Returns the first `count` of these values.
fn values(count: usize) -> Vec<&'static str> {
    VALUES.split('|').take(count).collect()
}

/// Returns the shipped scenes that solve fast, and the system above.
fn seeds() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let shipped = ["oc3_catenary", "demo", "collar", "point_load", "power_cable"];
    let read = |name: &&str| fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
    shipped.iter().map(read).chain([SYSTEM.to_string()]).collect()
}

/// Indices of the lines with an assignment `key = value`.
fn assignments(lines: &[String]) -> Vec<usize> {
    let is_one = |line: &String| line.contains(" = ") && !line.trim_start().starts_with('#');
    (0..lines.len()).filter(|&i| is_one(&lines[i])).collect()
}

/// Indices of the assignments with a digit: lengths, coefficients, positions.
fn numbers(lines: &[String]) -> Vec<usize> {
    let digits = |&i: &usize| lines[i].contains(|c: char| c.is_ascii_digit());
    assignments(lines).into_iter().filter(digits).collect()
}

/// Replaces one of the numbers in a line.
fn with_number(chance: &mut Chance, line: &str, new: &str) -> String {
    let begins = |&(at, c): &(usize, char)| {
        let before = line[..at].chars().next_back().unwrap_or('=');
        (c.is_ascii_digit() || c == '-') && " [,=".contains(before)
    };
    let starts: Vec<usize> = line.char_indices().filter(begins).map(|(at, _)| at).collect();
    let Some(&start) = starts.get(chance.below(starts.len())) else {
        return line.to_string();
    };
    let rest = &line[start..];
    let ends = |c: char| !(c.is_ascii_alphanumeric() || "+-._".contains(c));
    let length = rest.find(ends).unwrap_or(rest.len());
    format!("{}{new}{}", &line[..start], &rest[length..])
}

/// Returns the file after one mutation.
fn mutated(chance: &mut Chance, seed: &str, kind: usize) -> Vec<u8> {
    let mut lines: Vec<String> = seed.lines().map(str::to_string).collect();
    let of_keys = *chance.one_of(&assignments(&lines));
    match kind {
        0 => drop(lines.remove(of_keys)),
        1 => {
            let (key, _) = lines[of_keys].split_once(" = ").unwrap();
            lines[of_keys] = format!("{key} = {}", chance.one_of(&values(28)));
        }
        2 | 3 => {
            let line = *chance.one_of(&numbers(&lines));
            let new = *chance.one_of(&values(15));
            lines[line] = with_number(chance, &lines[line], new);
        }
        4 => {
            // a name is replaced by that of another object
            let keys = ["name =", "from =", "to =", "on =", "type ="];
            let named = |i: &usize| keys.iter().any(|key| lines[*i].contains(key));
            let names: Vec<usize> = assignments(&lines).into_iter().filter(named).collect();
            let name = |line: usize| lines[line].split('"').nth(1).unwrap_or("x").to_string();
            let (line, other) = (*chance.one_of(&names), *chance.one_of(&names));
            lines[line] = lines[line].replacen(&name(line), &name(other), 1);
        }
        5 => {
            // a table is removed or repeated
            let heads: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].starts_with('[')).collect();
            let start = *chance.one_of(&heads);
            let end = heads.iter().find(|&&head| head > start);
            let table = start..end.copied().unwrap_or(lines.len());
            match chance.below(2) {
                0 => drop(lines.drain(table)),
                _ => drop(lines.splice(table.end..table.end, lines[table].to_vec())),
            }
        }
        6 => lines[of_keys].insert(0, 'x'),
        7 => return chance.swapped(seed).into_bytes(),
        _ => return chance.damaged(seed.as_bytes().to_vec()),
    }
    lines.join("\n").into_bytes()
}

/// Outcome of a file.
#[derive(Debug)]
enum Fate {
    /// Refused with its place, or with the reason why it is not text.
    Refused,
    /// Solved in equilibrium and for two steps, with finite outputs.
    Solved,
    /// Reported the reason why the equilibrium or a step failed.
    Unsolved,
}

/// Reads a file and solves its statics if it is a scene.
fn fate(path: &Path) -> Result<Fate, String> {
    let loaded = match load(path) {
        Ok(loaded) => loaded,
        Err(error) => return refused(&error),
    };
    match Simulation::new(&loaded.scene) {
        Ok(mut simulation) => {
            finite(&simulation).map_err(|problem| format!("at rest, {problem}"))?;
            moved(&mut simulation).map_err(|problem| format!("in motion, {problem}"))
        }
        Err(Error::Scene(mistake)) => {
            let placed = loaded.locate(mistake);
            let said = placed.span.is_some() && !placed.problem.is_empty();
            if said {
                Ok(Fate::Refused)
            } else {
                Err(format!("{placed:?} has no place"))
            }
        }
        Err(Error::Statics(error)) if error.to_string().len() > 10 => Ok(Fate::Unsolved),
        Err(Error::Statics(error)) => Err(format!("{error:?} says nothing")),
    }
}

/// Checks that a refusal names the file, and the line if the file is text.
fn refused(error: &LoadError) -> Result<Fate, String> {
    let list = error.list();
    let first = list.lines().next().unwrap_or("");
    let Some((_, rest)) = first.split_once("scene.toml") else {
        return Err(format!("no file in {list:?}"));
    };
    let line = rest
        .strip_prefix(':')
        .and_then(|rest| rest.split(':').next()?.parse::<usize>().ok());
    match error {
        LoadError::Scene { .. } if line.is_none_or(|line| line == 0) => Err(format!("no line in {list:?}")),
        _ if rest.len() < 10 => Err(format!("{list:?} says nothing")),
        _ => Ok(Fate::Refused),
    }
}

/// Makes two short steps; a step may fail with a reason.
fn moved(simulation: &mut Simulation) -> Result<Fate, String> {
    for _ in 0..2 {
        match simulation.advance(0.01) {
            Ok(()) => finite(simulation)?,
            Err(error) if error.to_string().len() > 10 => return Ok(Fate::Unsolved),
            Err(error) => return Err(format!("{error:?} says nothing")),
        }
    }
    Ok(Fate::Solved)
}

/// Checks that all outputs are finite.
fn finite(simulation: &Simulation) -> Result<(), String> {
    for line in 0..simulation.model().lines.len() {
        let ends = [
            simulation.tension_a(line),
            simulation.tension_b(line),
            simulation.tension_max(line),
        ];
        let lengths = [
            simulation.laid_length(line),
            simulation.sag(line),
            simulation.stretched_length(line),
        ];
        let numbers = [&ends[..], &lengths, simulation.tensions(line)].concat();
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(format!("line {line}: {numbers:?}"));
        }
    }
    let forces = (0..simulation.model().points.len()).map(|point| simulation.end_force(point));
    match forces
        .enumerate()
        .find(|(_, force)| force.iter().any(|part| !part.is_finite()))
    {
        Some((point, force)) => Err(format!("point {point}: {force:?}")),
        None => Ok(()),
    }
}

/// Returns the fate of bytes as a file, within [`PATIENCE`]; a panic is reported as an error.
fn fate_of(bytes: &[u8]) -> Result<Fate, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, bytes).unwrap();
    let (tell, told) = mpsc::channel();
    thread::spawn(move || {
        let fate = catch_unwind(AssertUnwindSafe(|| fate(&path)));
        let _ = tell.send(fate.unwrap_or_else(|_| Err("it panicked".to_string())));
    });
    told.recv_timeout(PATIENCE)
        .unwrap_or_else(|_| Err(format!("no answer within {PATIENCE:?}")))
}

#[test]
fn three_hundred_mutated_scenes_are_refused_with_their_place_or_solved() {
    let seeds = seeds();
    let mut chance = Chance::new(20_261_121);
    let mut counts = [0; 3];
    let mut wrong = Vec::new();
    for trial in 0..300 {
        let seed = chance.one_of(&seeds).clone();
        let bytes = mutated(&mut chance, &seed, trial % 10);
        match fate_of(&bytes) {
            Ok(Fate::Refused) => counts[0] += 1,
            Ok(Fate::Solved) => counts[1] += 1,
            Ok(Fate::Unsolved) => counts[2] += 1,
            Err(problem) => wrong.push(format!("trial {trial}: {problem}\n{}", difference(&seed, &bytes))),
        }
    }
    assert!(wrong.is_empty(), "{counts:?}\n{}", wrong.join("\n"));
    // Most are mistakes; some, such as a missing coefficient, are still scenes.
    assert!(counts[0] >= 150 && counts[1] >= 20, "{counts:?}");
}

/// Lines changed by the mutation, for the message.
fn difference(seed: &str, bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let known: Vec<&str> = seed.lines().collect();
    let new: Vec<&str> = text.lines().filter(|line| !known.contains(line)).collect();
    let is_gone = |line: &&&str| !text.lines().any(|other| other == **line);
    let gone: Vec<&&str> = known.iter().filter(is_gone).collect();
    format!("  title {:?}, new {new:?}, gone {gone:?}", known.first())
}

#[test]
fn files_that_are_no_text_or_nothing_are_refused() {
    let latin = SYSTEM.replace("a barge", "a b\u{e4}rge");
    let latin: Vec<u8> = latin.chars().map(|c| u8::try_from(c as u32).unwrap()).collect();
    let utf_16: Vec<u8> = SYSTEM.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let noise: Vec<u8> = (0..4096_u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8)
        .collect();
    let deep = format!("a = {}", "[".repeat(100_000));
    let long = format!("title = \"{}\"", "x".repeat(1 << 20));
    let files: [&[u8]; 9] = [
        b"",
        b"\n\n\n",
        b"# nothing but words\n",
        b"\x7fELF\x02\x01\x01\0\0",
        &latin,
        &utf_16,
        &noise,
        deep.as_bytes(),
        long.as_bytes(),
    ];
    for (number, bytes) in files.into_iter().enumerate() {
        match fate_of(bytes) {
            Ok(Fate::Refused) => {}
            other => panic!("file {number}: {other:?}"),
        }
    }
}
