//! Work of the shipped scenes at their default settings: elements, linear solves of the equilibrium, internal steps, solves of the motion.
//! `tests/reference/work.csv` contains the earlier counts. Counts do not depend on the machine, so a change in cost
//! is visible.
//!
//! After an intended change, write the table again, so that the commit shows the difference with its reason:
//!
//! ```text
//! cargo test --test guard -- --ignored write_the_table_of_work
//! ```

mod common;

use std::fmt;
use std::path::PathBuf;

use common::*;
use moorline::discretisation::discretised;
use moorline::elements::Workspace;
use moorline::simulation::Simulation;
use moorline::statics::equilibrium;

/// Maximum duration of a run [s].
const SPAN: f64 = 20.0;
/// Fraction of iterations that rounding on another machine may add or save [-].
const ROUNDING: f64 = 0.01;

/// Columns after the scene's name.
const COLUMNS: [&str; 5] = ["elements", "statics", "steps", "substeps", "solves"];

/// Work of a scene, by column.
#[derive(Debug, Clone, PartialEq)]
struct Work {
    scene: String,
    counts: [usize; 5],
}

impl Work {
    /// Counts the work of a shipped scene: its equilibrium, and its own motion for its duration or [`SPAN`].
    fn of(name: &str) -> Work {
        let scene = discretised(&shipped(name)).into_owned();
        let mut simulation = following(&scene);
        let lines = &simulation.model().lines;
        let elements = lines.iter().map(|line| line.segment_count()).sum();
        let steps = (scene.output.duration.min(SPAN) / scene.output.interval).round() as usize;
        let history = History::record(&mut simulation, scene.output.interval, steps);
        Work {
            scene: name.to_string(),
            counts: [
                elements,
                statics(&simulation),
                steps,
                history.substeps,
                history.solves,
            ],
        }
    }

    /// Returns the columns that differ by more than rounding.
    fn differences(&self, before: &Work) -> Vec<String> {
        let pairs = COLUMNS.iter().zip(self.counts.iter().zip(&before.counts));
        pairs
            .filter(|(column, (now, before))| {
                let band = match **column {
                    "statics" => 1.0,
                    "solves" => ROUNDING * **before as f64,
                    _ => 0.0,
                };
                now.abs_diff(**before) as f64 > band
            })
            .map(|(column, (now, before))| {
                let change = 100.0 * (*now as f64 / *before as f64 - 1.0);
                format!(
                    "{}: {before} {column} before, {now} now ({change:+.1} %)",
                    self.scene
                )
            })
            .collect()
    }
}

impl fmt::Display for Work {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.scene)?;
        self.counts.iter().try_for_each(|count| write!(f, ",{count}"))
    }
}

/// Number of linear solves of the equilibrium at the reference positions [-]; zero for lines with given shapes.
fn statics(simulation: &Simulation) -> usize {
    let model = simulation.model();
    let mut work = Workspace::new(model);
    let points = resting(&at_reference(model));
    equilibrium::solve(model, &points, 0.0, &mut work).expect("a shipped scene has an equilibrium");
    work.take_counters().solves
}

/// Names of the shipped scenes.
fn scenes() -> Vec<String> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .filter_map(|entry| {
            let name = entry.unwrap().file_name().into_string().unwrap();
            Some(name.strip_suffix(".toml")?.to_string())
        })
        .collect();
    names.sort();
    names
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference/work.csv")
}

fn read() -> Vec<Work> {
    let text = std::fs::read_to_string(path()).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let row = |line: &str| {
        let (scene, counts) = line.split_once(',').unwrap();
        let counts: Vec<usize> = counts.split(',').map(|count| count.parse().unwrap()).collect();
        Work {
            scene: scene.to_string(),
            counts: counts.try_into().unwrap(),
        }
    };
    lines.map(row).collect()
}

#[test]
fn the_shipped_scenes_take_the_work_they_took_before() {
    let before = read();
    let names: Vec<&str> = before.iter().map(|work| work.scene.as_str()).collect();
    assert_eq!(
        scenes(),
        names,
        "the table has a row for every scene of the folder"
    );
    let pairs = before.iter().map(|before| (Work::of(&before.scene), before));
    let differences: Vec<String> = pairs.flat_map(|(now, before)| now.differences(before)).collect();
    assert!(
        differences.is_empty(),
        "{}\nif that is meant, write the table anew and say why: see the top of tests/guard.rs",
        differences.join("\n")
    );
}

#[test]
#[ignore = "writes tests/reference/work.csv"]
fn write_the_table_of_work() {
    let mut text = format!(
        "# moorline {}: cargo test --test guard -- --ignored write_the_table_of_work\n\
         # work of every scene at its default settings: elements, linear solves of the equilibrium, communication steps (of the duration, at\n\
         # most {SPAN} s), internal steps and solves in them\nscene,{}\n",
        env!("CARGO_PKG_VERSION"),
        COLUMNS.join(",")
    );
    for name in scenes() {
        text += &format!("{}\n", Work::of(&name));
    }
    std::fs::write(path(), text).unwrap();
}
