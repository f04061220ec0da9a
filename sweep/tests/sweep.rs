//! Sweeps from file to table: refusals with their places, resumption to the same bytes, failures among results.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use moorline::output::folder::ResultsFolder;
use moorline::scene::{LoadError, Note};
use moorline_decks::Supplement;
use moorline_sweep::{Base, Case, JOURNAL, Row, Sweep, SweepError, cases, run_case, shortfalls, table};
use tempfile::TempDir;

/// A hanging line in still air, quick to run.
const ROPE: &str = include_str!("../../tests/scenes/rope.toml");
/// A vessel and a buoy in regular waves, with a ramp of 20 s.
const PLATFORM: &str = include_str!("../../tests/scenes/platform.toml");

struct Folder(TempDir);

impl Folder {
    /// A folder with a base and a file of cases.
    fn with(base: &str, name: &str, cases: &str) -> Folder {
        let base = base.replace("duration = 1.0", "duration = 3.0");
        let folder = Folder(tempfile::tempdir().unwrap());
        fs::create_dir(folder.path("cases")).unwrap();
        folder.write("base.toml", &base);
        folder.write(&format!("cases/{name}"), cases);
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn base(&self) -> Base {
        Base::load(&self.path("base.toml"), &Supplement::default()).unwrap()
    }

    fn cases(&self, name: &str) -> Result<Arc<[Case]>, LoadError> {
        cases(&self.base(), &self.path(&format!("cases/{name}")), None)
    }

    /// Mistakes in a file of cases, one on a line.
    fn refusal(&self, name: &str) -> String {
        self.cases(name).unwrap_err().list()
    }
}

fn refused(base: &str, name: &str, text: &str, parts: &[&str]) {
    let folder = Folder::with(base, name, text);
    let said = folder.refusal(name);
    for part in parts {
        assert!(said.contains(part), "{part:?} is not in\n{said}");
    }
}

fn open(cases: &Arc<[Case]>, folder: &Path, series: bool) -> Result<Sweep, SweepError> {
    Sweep::open(cases, ResultsFolder::open(folder)?, series)
}

/// Runs a sweep until a number of cases have ended; returns whether all have.
fn run(cases: &Arc<[Case]>, folder: &Path, most: usize) -> bool {
    let mut sweep = open(cases, folder, false).unwrap();
    let count = AtomicUsize::new(0);
    let stops = || count.load(Ordering::Relaxed) >= most;
    let state = sweep.run(&stops, &|_, _| {
        count.fetch_add(1, Ordering::Relaxed);
    });
    state.unwrap().done == cases.len()
}

fn tables(folder: &Path) -> [Vec<u8>; 3] {
    ["cases.csv", "cases.parquet", "cases.units.csv"].map(|name| fs::read(folder.join(name)).unwrap())
}

/// Cases of the rope: all combinations of lengths and periods of its motion.
const ROPES: &str =
    "lines.line1.length = [14.2, 14.3, 14.4]\n\"motion.fairlead.x[0][1]\" = [2.0, 3.0, 4.0, 5.0]\n";

#[test]
fn wrong_keys_units_values_and_files_are_refused_at_their_line_and_column() {
    let header = "line_types.chian.mass,lines.line1.length,output.duration [m]\n1,2,3\n";
    let said = [
        "cases.csv:1:1: line_types.chian.mass: nothing of `line_types` is called `chian`, did you mean `chain`?",
        "cases.csv:1:23: lines.line1.length: `lines[0].sections` has 2 parts",
        "cases.csv:1:42: output.duration: unknown unit \"m\": one of s, ms, min, h would be right",
    ];
    refused(PLATFORM, "cases.csv", header, &said);
    let values =
        "output.duration,lines.line2.length,water.waves.regular.height\n60,450,4\n60,-450,4\n60,x,4\n";
    let said = [
        "cases.csv:3:4: lines.line2.length: ",
        "cases.csv:4:4: lines.line2.length: expected a number [m], found the string \"x\"",
    ];
    refused(PLATFORM, "cases.csv", values, &said);
    let said = [
        "cases.toml:1:26: motion.platform.file: ",
        "nowhere.csv: no such file",
    ];
    refused(
        PLATFORM,
        "cases.toml",
        "motion.platform.file = [ \"nowhere.csv\"]\n",
        &said,
    );
    let said = ["cases.csv:2:1: motion: ", "nowhere.csv: no such file"];
    refused(PLATFORM, "cases.csv", "motion\nnowhere.csv\n", &said);
    let said = [
        "cases.csv:2:1: ",
        "the ramps end, from where results count, from t = 20 s",
    ];
    refused(PLATFORM, "cases.csv", "output.duration\n15\n", &said);
}

#[test]
fn a_mistake_that_many_cases_share_is_reported_once() {
    let text = "seed = [1, 2, 3]\nwater.density = [-5.0]\n";
    let base = PLATFORM.replace(
        "regular = { height = 4.0, period = 10.0, direction = 0.5 }",
        "spectrum = \"jonswap\"\nsignificant_height = 2.0\npeak_period = 8.0",
    );
    let folder = Folder::with(&base, "cases.toml", text);
    let said = folder.refusal("cases.toml");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("cases.toml:2:18: water.density: "), "{said}");
}

#[test]
fn motion_files_stand_beside_the_file_of_cases_and_take_the_place_of_the_motion() {
    let text = "motion.fairlead.file,motion\na.csv,\n,a.csv\n";
    let folder = Folder::with(ROPE, "cases.csv", text);
    folder.write("cases/a.csv", "time,x,y,z\n0,0,0,0\n1,0.1,0,0\n2,0,0,0\n");
    let cases = folder.cases("cases.csv").unwrap();
    let [named, driven] = [0, 1].map(|index| cases[index].scene().unwrap());
    let rows = |scene: &moorline::scene::Scene| scene.motion["fairlead"].rows().map(<[_]>::len);
    assert_eq!((rows(&named), rows(&driven)), (Some(3), Some(3)));
    assert_eq!(driven.output.duration, 2.0);
}

#[test]
fn files_within_the_values_of_cases_stand_beside_the_file_of_cases_too() {
    let folder = Folder::with(ROPE, "cases.toml", "motion.fairlead = [{ file = \"a.csv\" }]\n");
    folder.write("cases/a.csv", "time,x,y,z\n0,0,0,0\n1,0.1,0,0\n2,0,0,0\n");
    let cases = folder.cases("cases.toml").unwrap();
    let scene = cases[0].scene().unwrap();
    assert_eq!(scene.motion["fairlead"].rows().map(<[_]>::len), Some(3));
}

#[test]
fn the_duration_of_a_case_is_kept_beside_a_motion_file() {
    let folder = Folder::with(ROPE, "cases.csv", "motion,output.duration\na.csv,1.5\na.csv,\n");
    folder.write("cases/a.csv", "time,x,y,z\n0,0,0,0\n1,0.1,0,0\n2,0,0,0\n");
    let cases = folder.cases("cases.csv").unwrap();
    let duration = |index: usize| cases[index].scene().unwrap().output.duration;
    assert_eq!((duration(0), duration(1)), (1.5, 2.0));
}

#[test]
fn two_keys_that_set_the_same_value_are_refused_in_one_case_and_not_in_two() {
    for [first, second] in [
        ["lines.line1.length", "\"lines[0].sections[0].length\""],
        ["solver.integrator", "solver.dynamics"],
        ["points.anchor.position", "\"points.anchor.position[2]\""],
        ["motion.fairlead.ramp", "motion.fairlead.file"],
        ["motion.fairlead.file", "motion.fairlead.ramp"],
        ["motion", "motion.fairlead.ramp"],
        ["motion.fairlead.ramp", "motion"],
    ] {
        let header = format!("{first},{second}\n").replace('"', "");
        let said = format!(
            "`{}` of this case sets or replaces the same part",
            first.replace('"', "")
        );
        refused(
            ROPE,
            "cases.csv",
            &format!("{header}1,2\n"),
            &["cases.csv:2:3: ", &said],
        );
    }
    let folder = Folder::with(
        ROPE,
        "cases.csv",
        "lines.line1.length,lines[0].sections[0].length\n14.2,\n,14.3\n",
    );
    let cases = folder.cases("cases.csv").unwrap();
    let length = |index: usize| cases[index].scene().unwrap().lines[0].sections[0].length;
    assert_eq!((length(0), length(1)), (14.2, 14.3));
}

#[test]
fn values_with_units_are_those_in_si_units() {
    let folder = Folder::with(
        ROPE,
        "cases.csv",
        "lines.line1.length [km],output.duration [min]\n0.015,0.1\n",
    );
    let scene = folder.cases("cases.csv").unwrap()[0].scene().unwrap();
    assert_eq!(
        (scene.lines[0].sections[0].length, scene.output.duration),
        (15.0, 6.0)
    );
}

#[test]
fn a_sweep_that_is_stopped_anywhere_ends_with_the_same_bytes() {
    let folder = Folder::with(ROPE, "cases.toml", ROPES);
    let cases = folder.cases("cases.toml").unwrap();
    assert_eq!(cases.len(), 12);
    assert!(run(&cases, &folder.path("whole"), usize::MAX));
    let whole = tables(&folder.path("whole"));
    let parts = folder.path("parts");
    while !run(&cases, &parts, 3) {}
    assert_eq!(tables(&parts), whole);
    assert!(
        run(&cases, &parts, usize::MAX),
        "all cases are done, and nothing is left to run"
    );
    assert_eq!(tables(&parts), whole);
    // by another scheduler, in any order, sent as bytes
    let sent = |row: Row| Row::of_bytes(&row.to_bytes(), &cases).unwrap();
    let mut rows: Vec<Row> = cases.iter().rev().map(run_case).map(sent).collect();
    assert_eq!(Row::of_bytes(b"no row", &cases), None);
    rows.swap(2, 7);
    table(&rows).write(&folder.path("cases")).unwrap();
    assert_eq!(tables(&folder.path("cases")), whole);
}

#[test]
fn a_journal_that_was_cut_or_damaged_anywhere_costs_only_the_cases_behind() {
    let folder = Folder::with(ROPE, "cases.toml", "lines.line1.length = [14.2, 14.3, 14.4]\n");
    let cases = folder.cases("cases.toml").unwrap();
    let out = folder.path("out");
    assert!(run(&cases, &out, usize::MAX));
    let (whole, journal) = (tables(&out), fs::read(out.join(JOURNAL)).unwrap());
    let done = |bytes: &[u8]| {
        fs::write(out.join(JOURNAL), bytes).unwrap();
        open(&cases, &out, false).unwrap().rows().len()
    };
    let mut before = 0;
    for length in (0..=journal.len()).step_by(97).chain([journal.len()]) {
        let now = done(&journal[..length]);
        assert!(
            now >= before,
            "{length} bytes hold {now} rows, fewer bytes {before}"
        );
        before = now;
    }
    assert_eq!(before, 3);
    let mut damaged = journal.clone();
    *damaged.last_mut().unwrap() ^= 1;
    assert_eq!(done(&damaged), 2);
    assert!(run(&cases, &out, usize::MAX));
    assert_eq!(tables(&out), whole);
}

#[test]
fn the_folder_of_another_sweep_is_refused() {
    let folder = Folder::with(
        ROPE,
        "cases.toml",
        "lines.line1.length = [14.2, 14.3]\nmotion.fairlead.file = \"a.csv\"\n",
    );
    folder.write("cases/a.csv", "time,x,y,z\n0,0,0,0\n1,0.1,0,0\n");
    let out = folder.path("out");
    let cases = || folder.cases("cases.toml").unwrap();
    assert!(run(&cases(), &out, usize::MAX));
    let refusal = |cases: &Arc<[Case]>, series: bool| match open(cases, &out, series) {
        Err(SweepError::Other { problem, .. }) => problem,
        other => panic!("{other:?}"),
    };
    assert!(refusal(&cases(), true).contains("other options"));
    folder.write("cases/a.csv", "time,x,y,z\n0,0,0,0\n1,0.2,0,0\n");
    assert!(refusal(&cases(), false).contains("other content"));
    folder.write("cases/a.csv", "time,x,y,z\n0,0,0,0\n1,0.1,0,0\n");
    folder.write("cases/a.units.csv", "name,unit\nx,ft\n");
    assert!(refusal(&cases(), false).contains("other content"));
    folder.write(
        "cases/cases.toml",
        "lines.line1.length = [14.2, 14.4]\nmotion.fairlead.file = \"a.csv\"\n",
    );
    assert!(refusal(&cases(), false).contains("another base or other cases"));
    folder.write(
        "cases/cases.toml",
        "lines.line1.length = 14.2\nmotion.fairlead.file = \"a.csv\"\n",
    );
    assert!(refusal(&cases(), false).contains("a sweep of 2 cases, which are 1 here"));
    fs::write(out.join(JOURNAL), "something else").unwrap();
    assert!(refusal(&cases(), false).contains("no journal of a sweep"));
}

#[test]
fn a_case_that_fails_is_a_row_with_its_reason_and_the_others_are_as_without_it() {
    let two = Folder::with(ROPE, "cases.csv", "motion.fairlead.x[0][0]\n0.1\n0.2\n");
    let three = Folder::with(ROPE, "cases.csv", "motion.fairlead.x[0][0]\n0.1\n1e7\n0.2\n");
    let rows = |folder: &Folder| {
        folder
            .cases("cases.csv")
            .unwrap()
            .iter()
            .map(run_case)
            .collect::<Vec<_>>()
    };
    let (two, three) = (rows(&two), rows(&three));
    let reason = three[1].results.as_ref().unwrap_err();
    assert!(reason.contains("t = "), "{reason}");
    assert_eq!(two[0].results, three[0].results);
    assert_eq!(two[1].results, three[2].results);
}

#[test]
fn the_rows_of_a_kind_whose_mesh_could_not_be_tried_say_so() {
    let open = ROPE.replace(", elements = 8", "");
    let folder = Folder::with(&open, "cases.csv", "motion.fairlead.x[0][0]\n0.05\n1e7\n");
    let cases = folder.cases("cases.csv").unwrap();
    assert!(shortfalls(&cases).is_empty());
    let words = "the error of this mesh is unknown, since no trial could be run";
    for row in cases.iter().map(run_case) {
        assert!(
            row.notes.iter().any(|note| note.contains(words)),
            "{:?}",
            row.notes
        );
    }
    let [(case, note)] = shortfalls(&cases)[..] else {
        panic!("one remark for one kind");
    };
    assert!(case.number == 1 && note.contains(words), "{note}");
}

#[test]
fn statistics_are_those_of_the_rows_after_the_ramp() {
    let folder = Folder::with(PLATFORM, "cases.csv", "output.duration\n30\n");
    let cases = folder.cases("cases.csv").unwrap();
    assert_eq!(cases[0].from, 20.0);
    let out = folder.path("out");
    let mut sweep = open(&cases, &out, true).unwrap();
    sweep.run(&|| false, &|_, _| {}).unwrap();
    let results = sweep.rows()[0].results.clone().unwrap();
    let series = parquet_columns(&out.join("series/case-000001.parquet"));
    let time = &series["time"];
    assert_eq!((time[0], time.len()), (0.0, 301));
    let tension = &series["line1.tension_b"][200..];
    let place = results
        .quantities
        .iter()
        .position(|quantity| quantity.name == "line1.tension_b")
        .unwrap();
    let [mean, deviation, least, greatest] = results.figures[place];
    assert_eq!(least, tension.iter().copied().fold(f64::INFINITY, f64::min));
    assert_eq!(
        greatest,
        tension.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    );
    let inner: f64 = tension.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).sum();
    assert!((mean / (inner / 100.0) - 1.0).abs() < 1e-9, "{mean}");
    assert!(deviation > 0.0 && deviation < greatest - least);
    assert!(series.contains_key("platform.x") && series.contains_key("waves.elevation"));
}

/// Columns of numbers of a Parquet file.
fn parquet_columns(path: &Path) -> std::collections::BTreeMap<String, Vec<f64>> {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    let file = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let mut columns = std::collections::BTreeMap::<String, Vec<f64>>::new();
    for row in file.get_row_iter(None).unwrap() {
        for (name, field) in row.unwrap().get_column_iter() {
            let value = match field {
                Field::Double(value) => *value,
                Field::Long(value) => *value as f64,
                other => panic!("{name}: {other}"),
            };
            columns.entry(name.clone()).or_default().push(value);
        }
    }
    columns
}

#[test]
fn the_table_has_keys_reasons_and_four_figures_of_every_output() {
    let folder = Folder::with(
        ROPE,
        "cases.csv",
        "lines.line1.length,solver.integrator\n15,leapfrog\n14.5,\n",
    );
    let cases = folder.cases("cases.csv").unwrap();
    let rows: Vec<Row> = cases.iter().map(run_case).collect();
    table(&rows).write(folder.0.path()).unwrap();
    let text = fs::read_to_string(folder.path("cases.csv")).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap();
    assert!(
        header.starts_with("case,lines.line1.length,solver.integrator,failure,notes,"),
        "{header}"
    );
    for ending in ["mean", "std", "min", "max"] {
        assert!(header.contains(&format!(",line1.tension_b.{ending}")), "{header}");
    }
    for begins in ["1,15.0,leapfrog,,,", "2,14.5,,,,"] {
        let line = lines.next().unwrap();
        assert!(line.starts_with(begins), "{line}");
    }
    let units = fs::read_to_string(folder.path("cases.units.csv")).unwrap();
    assert!(units.contains("lines.line1.length,m,") && units.contains("line1.tension_b.std,N,"));
}

#[test]
fn a_deck_is_a_base_too() {
    let deck = include_str!("../../decks/tests/decks/moordyn_c.txt");
    let folder = Folder::with(ROPE, "cases.csv", "lines.line2.length\n150\n");
    folder.write("deck.txt", &deck.replace("9.81 ", "32.2 "));
    let base = Base::load(&folder.path("deck.txt"), &Supplement::default()).unwrap();
    let found = cases(&base, &folder.path("cases/cases.csv"), None).unwrap();
    assert_eq!(found[0].scene().unwrap().lines[1].sections[0].length, 150.0);
    let gravity = |notes: &[Note]| notes.iter().any(|note| note.text.contains("32.2 m/s²"));
    assert!(gravity(base.notes()) && !gravity(&found[0].notes));
}
