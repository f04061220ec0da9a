//! Scenes broken in every way that hands and disks break files: each is refused with its place, or is still a scene and then has an
//! equilibrium of finite numbers, or a message that says why not. None panics, none hangs.
//!
//! Mutations come from a generator with a fixed seed: the same files every time.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use crate::common::{Chance, assert_says};
use moorline::scene::{LoadError, load};
use moorline::simulation::{Error, Simulation};

/// Longest that one file may take in a busy test run [s]; most take milliseconds.
const PATIENCE: Duration = Duration::from_secs(120);

/// A system with a bit of everything: a vessel, sections, a clump, a line through the surface, a motion.
const SYSTEM: &str = r#"title = "a barge on two lines, one of them with a clump"
gravity = 9.81

[water]
density = 1025.0

[water.waves]
spectrum = "jonswap"
significant_height = 4.0
peak_period = 9.0
seed = 3
components = 20

[seabed]
depth = 100.0
stiffness = 3.0e6
damping = 3.0e5

[line_types.chain]
mass = 113.35
diameter = 0.0766
axial_stiffness = 753.6e6
axial_damping = 2.0e6
drag_normal = 2.0
drag_tangential = 0.4
added_mass_normal = 0.8
added_mass_tangential = 0.25

[line_types.wire]
mass = 40.0
diameter = 0.08
axial_stiffness = 3.0e8
damping_ratio = 0.1
drag_normal = 1.2

[[vessels]]
name = "barge"
position = [0.0, 0.0, 0.0]
attitude = [0.0, 0.0, 0.1]

[[points]]
name = "anchor1"
position = [330.0, 0.0, -100.0]
kind = "fixed"

[[points]]
name = "clump"
position = [150.0, 0.0, -80.0]
kind = "free"
mass = 8.0e3
volume = 1.0
drag_area = 2.0
added_mass = 0.5

[[points]]
name = "bow"
position = [20.0, 0.0, 4.0]
kind = "coupled"
on = "barge"

[[points]]
name = "anchor2"
position = [-330.0, 0.0, -100.0]
kind = "fixed"

[[points]]
name = "stern"
position = [-20.0, 0.0, -7.0]
kind = "coupled"
on = "barge"

[[lines]]
name = "lower"
from = "anchor1"
to = "clump"
sections = [{ type = "chain", length = 190.0, elements = 12 }]

[[lines]]
name = "upper"
from = "clump"
to = "bow"
sections = [{ type = "wire", length = 100.0, elements = 6 }, { type = "chain", length = 50.0, elements = 4 }]

[[lines]]
name = "aft"
from = "anchor2"
to = "stern"
sections = [{ type = "chain", length = 340.0, elements = 12 }]

[solver]
tolerance = 0.02
time_step_max = 0.05

[motion]
barge = { x = [[2.0, 12.0]], pitch = [[0.05, 10.0]], ramp = 10.0 }

[output]
duration = 10.0
interval = 0.1
"#;

/// Replacements of values: no numbers, sizes out of range, types that no key takes.
const VALUES: &str = "nan|inf|-inf|1e300|-1e300|1e-300|1e-15|1e-6|0|-1|-0.08|1e999|99999999999999999999|100001|1e12|\
    true|\"\"|\"x\"|\"anchor1\"|\"\\u0000\"|[]|[1.0]|[nan, 0.0, 0.0]|[[0.0, 0.0]]|{}|{ type = 1 }|0x|";

/// The first `count` of these values.
fn values(count: usize) -> Vec<&'static str> {
    VALUES.split('|').take(count).collect()
}

/// The shipped scenes that solve fast, and the system above.
fn seeds() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let shipped = ["oc3_catenary", "demo", "collar", "point_load", "power_cable"];
    let read = |name: &&str| fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
    shipped.iter().map(read).chain([SYSTEM.to_string()]).collect()
}

/// Numbers of the lines that hold `key = value`.
fn assignments(lines: &[String]) -> Vec<usize> {
    let is_one = |line: &String| line.contains(" = ") && !line.trim_start().starts_with('#');
    (0..lines.len()).filter(|&i| is_one(&lines[i])).collect()
}

/// Numbers of the lines that hold a number: lengths, coefficients, positions.
fn numbers(lines: &[String]) -> Vec<usize> {
    let digits = |&i: &usize| lines[i].contains(|c: char| c.is_ascii_digit());
    assignments(lines).into_iter().filter(digits).collect()
}

/// The line with one of its numbers replaced.
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

/// The file after one mutation.
fn mutated(chance: &mut Chance, seed: &str, kind: usize) -> Vec<u8> {
    let mut lines: Vec<String> = seed.lines().map(str::to_string).collect();
    match kind {
        0 => {
            // A key is missing.
            let keys = assignments(&lines);
            lines.remove(*chance.one_of(&keys));
        }
        1 => {
            // A value is another.
            let line = *chance.one_of(&assignments(&lines));
            let (key, _) = lines[line].split_once(" = ").unwrap();
            lines[line] = format!("{key} = {}", chance.one_of(&values(28)));
        }
        2 | 3 => {
            // A number is another.
            let line = *chance.one_of(&numbers(&lines));
            let new = *chance.one_of(&values(15));
            lines[line] = with_number(chance, &lines[line], new);
        }
        4 => {
            // A name is another's, or nobody's.
            let keys = ["name =", "from =", "to =", "on =", "type ="];
            let named = |i: &usize| keys.iter().any(|key| lines[*i].contains(key));
            let names: Vec<usize> = assignments(&lines).into_iter().filter(named).collect();
            let (line, other) = (*chance.one_of(&names), *chance.one_of(&names));
            let taken = lines[other].split('"').nth(1).unwrap_or("x").to_string();
            let own = lines[line].split('"').nth(1).unwrap_or("x").to_string();
            lines[line] = lines[line].replacen(&own, &taken, 1);
        }
        5 => {
            // A table is missing or comes twice.
            let heads: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].starts_with('[')).collect();
            let start = *chance.one_of(&heads);
            let end = heads.iter().find(|&&head| head > start);
            let end = end.copied().unwrap_or(lines.len());
            if chance.below(2) == 0 {
                lines.drain(start..end);
            } else {
                let table: Vec<String> = lines[start..end].to_vec();
                lines.splice(end..end, table);
            }
        }
        6 => {
            // A key is misspelt.
            let line = *chance.one_of(&assignments(&lines));
            lines[line] = format!("x{}", lines[line]);
        }
        7 => {
            // Two lines have changed places.
            let (a, b) = (chance.below(lines.len()), chance.below(lines.len()));
            lines.swap(a, b);
        }
        _ => return damaged(chance, seed.as_bytes().to_vec()),
    }
    lines.join("\n").into_bytes()
}

/// The file after a disk or an editor has spoilt it.
fn damaged(chance: &mut Chance, mut bytes: Vec<u8>) -> Vec<u8> {
    match chance.below(3) {
        0 => bytes.truncate(chance.below(bytes.len())),
        1 => {
            for _ in 0..=chance.below(12) {
                let at = chance.below(bytes.len());
                bytes[at] = u8::try_from(chance.below(256)).unwrap();
            }
        }
        _ => {
            let at = chance.below(bytes.len());
            bytes.insert(at, *chance.one_of(b"\0\xff\xc3[]{}\"=#\n."));
        }
    }
    bytes
}

/// Outcome of a file.
#[derive(Debug)]
enum Fate {
    /// Refused with its place, or with why it cannot be read as text.
    Refused,
    /// In equilibrium and through two steps, all numbers finite.
    Solved,
    /// Said why there is no equilibrium, or no step.
    Unsolved,
}

/// Reads a file and solves its statics where it is a scene.
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

/// Checks that every refusal names the file, and the line where the file is text.
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

/// Steps twice by a small step; a step may fail if it says why.
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
        let numbers = [
            simulation.tension_a(line),
            simulation.tension_b(line),
            simulation.tension_max(line),
            simulation.laid_length(line),
            simulation.sag(line),
            simulation.stretched_length(line),
        ];
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(format!("line {line}: {numbers:?}"));
        }
        if simulation
            .tensions(line)
            .iter()
            .any(|tension| !tension.is_finite())
        {
            return Err(format!("line {line}: a tension is no number"));
        }
    }
    for point in 0..simulation.model().points.len() {
        let force = simulation.end_force(point);
        if force.iter().any(|part| !part.is_finite()) {
            return Err(format!("point {point}: {force:?}"));
        }
    }
    Ok(())
}

/// The fate of bytes as a file, within [`PATIENCE`]; a panic is reported as one.
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
    let mut chance = Chance(20_261_121);
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
    // Most are mistakes; some, such as a coefficient left out, are scenes still.
    assert!(counts[0] >= 150 && counts[1] >= 20, "{counts:?}");
}

/// Lines that the mutation changed, for the message.
fn difference(seed: &str, bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let known: Vec<&str> = seed.lines().collect();
    let new: Vec<&str> = text.lines().filter(|line| !known.contains(line)).collect();
    let is_gone = |line: &&&str| !text.lines().any(|other| other == **line);
    let gone: Vec<&&str> = known.iter().filter(is_gone).collect();
    format!("  title {:?}, new {new:?}, gone {gone:?}", known.first())
}

/// The list of mistakes of a scene that is refused.
fn refusal(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    load(&path).expect_err("the scene is refused").list()
}

#[test]
fn the_commonest_mistakes_of_users_are_refused_at_their_lines() {
    let cases = [
        ("diameter = 0.0766", "diameter = -0.0766", 21, "not positive"),
        ("mass = 113.35", "mass = nan", 20, "not a finite number"),
        ("to = \"clump\"", "to = \"clamp\"", 75, "clump"),
        ("to = \"clump\"", "to = \"anchor1\"", 75, "both ends"),
        ("elements = 12 }]", "elements = 0 }]", 76, "elements"),
        (
            "elements = 12 }]",
            "elements = 100000000 }]",
            76,
            "is not between 1 and",
        ),
        ("length = 190.0", "length = 1e300", 76, "beyond the limit"),
        ("type = \"wire\"", "type = \"rope\"", 82, "rope"),
        ("kind = \"fixed\"", "kind = \"nailed\"", 44, "nailed"),
        ("on = \"barge\"", "on = \"ship\"", 59, "ship"),
        ("depth = 100.0", "depht = 100.0", 15, "depth"),
        ("interval = 0.1", "interval = 1e-12", 99, "steps"),
    ];
    for (old, new, line, word) in cases {
        assert!(SYSTEM.contains(old), "{old:?} is not in the system");
        let list = refusal(&SYSTEM.replacen(old, new, 1));
        assert_says(&list, &[&format!("scene.toml:{line}:"), word]);
    }
}

#[test]
fn points_that_no_line_holds_and_loops_of_free_points_are_refused() {
    let point = "[[points]]\nname = \"loose\"\nposition = [0.0, 0.0, -5.0]\nkind = \"free\"\nmass = 1.0\n";
    assert_says(
        &refusal(&format!("{SYSTEM}\n{point}")),
        &["no line ends at this free point"],
    );
    let free = "kind = \"free\"\nmass = 10.0";
    let adrift = SYSTEM
        .replace("kind = \"fixed\"", free)
        .replace("kind = \"coupled\"\non = \"barge\"", free);
    assert_says(&refusal(&adrift), &["nothing holds"]);
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
