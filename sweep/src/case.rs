//! Reads cases from a base and a file CASES, and checks all of them as scenes before any runs.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use moorline::scene::units::factor_to;
use moorline::scene::{Drive, LoadError, LoadedScene, Note, Scene, SceneError, TOML, folder_of, load_text};
use moorline_decks::{Supplement, load_with};
use rayon::prelude::*;
use sha2::{Digest, Sha256};
use toml::Value;

use crate::key::Place;
use crate::kind::{Kind, Severity, ramp, severity, system};
use crate::sheet::{Column, Draft, Entry, Sheet, mistake};

/// Maximum number of mistakes of CASES that are reported [-].
const MISTAKES_MAX: usize = 20;
/// Column with motion files, which move bodies as those of `run --motion` do.
const MOTION: &str = "motion";
/// Key of the duration, which takes precedence over the duration of a motion file.
const DURATION: &str = "output.duration";

/// Scene or deck whose keys the cases set.
#[derive(Debug)]
pub struct Base {
    loaded: LoadedScene,
    document: Value,
    /// Notes on the document, under the paths that cases have: cases do not repeat them.
    known: Vec<Note>,
}

impl Base {
    /// Reads and checks a scene or a deck.
    ///
    /// # Errors
    /// The reason why it cannot be read, or all mistakes in it.
    pub fn load(path: &Path, supplement: &Supplement) -> Result<Base, LoadError> {
        let mut loaded = load_with(path, supplement)?;
        let note = loaded.scene.without_host().map(|note| loaded.locate_note(note));
        loaded.notes.extend(note);
        let (text, known) = match loaded.format {
            TOML => (loaded.text.clone(), loaded.notes.clone()),
            _ => {
                let text = loaded.scene.to_toml();
                let known = load_text(&loaded.path, text.clone())?.notes;
                (text, known)
            }
        };
        let document = text.parse().map(Value::Table);
        let document = document.expect("the reader of scenes has read the same text");
        Ok(Base {
            loaded,
            document,
            known,
        })
    }

    /// Remarks on the base itself.
    pub fn notes(&self) -> &[Note] {
        &self.loaded.notes
    }
}

/// Input of one simulation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Input {
    /// The base, whose folder contains its files.
    pub base: Arc<PathBuf>,
    /// The scene as TOML.
    pub document: String,
    /// Motion file instead of the scene's motion, with the duration if the case sets it.
    pub drive: Drive,
}

impl Input {
    /// Reads the scene.
    pub(crate) fn load(&self) -> Result<LoadedScene, LoadError> {
        let mut loaded = load_text(&self.base, self.document.clone())?;
        if self.drive.is_empty() {
            return Ok(loaded);
        }
        let mut scene = loaded.scene.clone();
        scene.drive(&self.drive).map_err(|problem| LoadError::Scene {
            path: loaded.path.clone(),
            text: String::new(),
            mistakes: vec![SceneError::new(MOTION, problem)],
        })?;
        let notes = loaded.change(scene);
        loaded.notes.extend(notes);
        Ok(loaded)
    }
}

/// A case of a sweep.
#[derive(Debug, Clone)]
pub struct Case {
    /// Number, from 1 in the order of CASES.
    pub number: usize,
    /// Keys as in CASES, each with its unit and its value; `None` if the case keeps the value of the base.
    pub values: Vec<(Arc<Key>, Option<Value>)>,
    /// Line of CASES [-], from 1.
    pub line: usize,
    /// Time from which results count [s]; by default the end of the ramps.
    pub from: f64,
    /// Remarks on the scene that do not apply to the base.
    pub notes: Vec<Note>,
    pub(crate) input: Input,
    pub(crate) kind: Arc<Kind>,
}

/// A key that cases set.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// Path as written.
    pub path: String,
    /// Unit of the values in cases, if the key has one.
    pub unit: Option<String>,
}

impl Case {
    /// Scene of the case, with its discretisation.
    ///
    /// # Errors
    /// A file of the scene that can no longer be read.
    pub fn scene(&self) -> Result<Scene, LoadError> {
        let mut scene = self.input.load()?.scene;
        self.kind.discretise(&mut scene);
        Ok(scene)
    }

    /// Files that the scene names, and the files of units next to motion files.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let mut names = Vec::new();
        let document = self.input.document.parse().map(Value::Table);
        let mut document = document.expect("a document that was written");
        for_each_file(&mut document, &mut |name| names.push(name.clone()));
        let folder = folder_of(&self.input.base);
        let named = names.iter().map(|name| folder.join(name));
        let files = named.chain(self.input.drive.file.clone());
        let with_units = |file: PathBuf| {
            let units = Some(file.with_extension("units.csv")).filter(|units| units.is_file());
            [Some(file), units]
        };
        files.flat_map(with_units).flatten().collect()
    }
}

/// Calls a function with each text under a key named `file`.
fn for_each_file(value: &mut Value, call: &mut impl FnMut(&mut String)) {
    match value {
        Value::Table(table) => {
            for (key, value) in table.iter_mut() {
                match value {
                    Value::String(name) if key == "file" => call(name),
                    value => for_each_file(value, call),
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(|value| for_each_file(value, call)),
        _ => {}
    }
}

/// Column of CASES and its place in the scene.
struct Target {
    key: Arc<Key>,
    /// Place in the scene; `None` for the column `motion`.
    place: Option<Place>,
    /// Factor to SI units [-], if the heading gives a unit.
    factor: Option<f64>,
}

impl Target {
    /// Returns whether only one of two columns can have a value in a case.
    fn excludes(&self, other: &Target) -> bool {
        match (&self.place, &other.place) {
            (Some(one), Some(other)) => one.excludes(other),
            (Some(place), None) | (None, Some(place)) => place.is_motion(),
            (None, None) => true,
        }
    }
}

/// Reads the cases of a file and checks each of them as a scene. `from` is the time from which results count [s], instead of the end of the
/// ramps.
///
/// # Errors
/// All mistakes in the file, with their places: paths without a key, units, values that the scene refuses, files that are missing.
pub fn cases(base: &Base, path: &Path, from: Option<f64>) -> Result<Arc<[Case]>, LoadError> {
    let sheet = Sheet::read(path)?;
    let builder = Builder::new(base, &sheet, from)?;
    let checked: Vec<Result<Checked, Vec<SceneError>>> = (0..sheet.cases.len())
        .into_par_iter()
        .map(|index| builder.check(index))
        .collect();
    let mut mistakes = Vec::new();
    let mut good = Vec::new();
    for case in checked {
        match case {
            Ok(case) => good.push(case),
            Err(found) => mistakes.extend(found),
        }
    }
    if !mistakes.is_empty() {
        return Err(refused(&sheet, mistakes));
    }
    Ok(with_kinds(good))
}

/// The mistakes in the order of the text, without duplicates.
fn refused(sheet: &Sheet, mut mistakes: Vec<SceneError>) -> LoadError {
    mistakes.sort_by_key(|mistake| mistake.span.as_ref().map_or(0, |span| span.start));
    mistakes.dedup();
    mistakes.truncate(MISTAKES_MAX);
    LoadError::Scene {
        path: sheet.path.clone(),
        text: sheet.text.clone(),
        mistakes,
    }
}

/// A case whose scene can be used.
struct Checked {
    case: Case,
    /// Fingerprint of the kind of system.
    system: [u8; 32],
    severity: Severity,
}

/// Assigns the same discretisation to cases of one kind of system.
fn with_kinds(checked: Vec<Checked>) -> Arc<[Case]> {
    let mut members: BTreeMap<[u8; 32], Vec<usize>> = BTreeMap::new();
    for (index, case) in checked.iter().enumerate() {
        members.entry(case.system).or_default().push(index);
    }
    let mut kinds = vec![None; checked.len()];
    for indices in members.values() {
        let candidates: Vec<(Severity, &Input)> = indices
            .iter()
            .map(|&index| (checked[index].severity, &checked[index].case.input))
            .collect();
        let kind = Arc::new(Kind::of(&candidates));
        indices
            .iter()
            .for_each(|&index| kinds[index] = Some(kind.clone()));
    }
    let cases = checked.into_iter().zip(kinds);
    cases
        .map(|(checked, kind)| Case {
            kind: kind.expect("every case belongs to a kind"),
            ..checked.case
        })
        .collect()
}

/// Builder of cases from the rows of CASES.
struct Builder<'b> {
    base: &'b Base,
    sheet: &'b Sheet,
    targets: Vec<Target>,
    from: Option<f64>,
    base_path: Arc<PathBuf>,
    open: Arc<Kind>,
}

impl<'b> Builder<'b> {
    fn new(base: &'b Base, sheet: &'b Sheet, from: Option<f64>) -> Result<Builder<'b>, LoadError> {
        let (mut targets, mut mistakes) = (Vec::new(), Vec::new());
        for column in &sheet.columns {
            match target(base, column) {
                Ok(target) => targets.push(target),
                Err(mistake) => mistakes.push(mistake),
            }
        }
        if !mistakes.is_empty() {
            return Err(refused(sheet, mistakes));
        }
        Ok(Builder {
            base,
            sheet,
            targets,
            from,
            base_path: Arc::new(base.loaded.path.clone()),
            open: Arc::new(Kind::default()),
        })
    }

    /// The case of a row, read as a scene.
    fn check(&self, index: usize) -> Result<Checked, Vec<SceneError>> {
        let draft = &self.sheet.cases[index];
        let mistakes = self.replaced(draft);
        if !mistakes.is_empty() {
            return Err(mistakes);
        }
        let input = self.input(draft)?;
        let mut values: Vec<(Arc<Key>, Option<Value>)> = self
            .targets
            .iter()
            .map(|target| (target.key.clone(), None))
            .collect();
        for entry in &draft.entries {
            values[entry.column].1 = Some(entry.value.clone());
        }
        let loaded = input.load().map_err(|error| self.located(draft, error))?;
        let from = self.start(draft, &loaded.scene)?;
        let mut notes = loaded.notes;
        let known = |note: &Note| {
            self.base
                .known
                .iter()
                .any(|known| (&known.at, &known.text) == (&note.at, &note.text))
        };
        notes.retain(|note| !known(note));
        let before = &self.sheet.text[..draft.span.start];
        Ok(Checked {
            system: Sha256::digest(system(&loaded.scene)).into(),
            severity: severity(&loaded.scene),
            case: Case {
                number: index + 1,
                values,
                line: before.matches('\n').count() + 1,
                from,
                notes,
                input,
                kind: self.open.clone(),
            },
        })
    }

    /// Mistakes in a case: values that are replaced by another key of the case.
    fn replaced(&self, draft: &Draft) -> Vec<SceneError> {
        let target = |entry: &Entry| &self.targets[entry.column];
        let mut mistakes = Vec::new();
        for (index, entry) in draft.entries.iter().enumerate() {
            let mut earlier = draft.entries[..index].iter();
            if let Some(other) = earlier.find(|other| target(other).excludes(target(entry))) {
                let path = &target(other).key.path;
                let problem = format!(
                    "`{path}` of this case sets or replaces the same part of the scene: leave one of them out"
                );
                mistakes.push(mistake(&target(entry).key.path, problem, &entry.span));
            }
        }
        mistakes
    }

    /// The base with the values of a case.
    fn input(&self, draft: &Draft) -> Result<Input, Vec<SceneError>> {
        let mut document = self.base.document.clone();
        let (mut file, mut duration) = (None, None);
        let mut mistakes = Vec::new();
        for entry in &draft.entries {
            let target = &self.targets[entry.column];
            match (in_si(target, &entry.value, &entry.span), &target.place) {
                (Err(mistake), _) => mistakes.push(mistake),
                (Ok(value), None) => file = value.as_str().map(|name| self.beside(name)),
                (Ok(mut value), Some(place)) => {
                    let mut move_beside = |name: &mut String| *name = self.beside(name).display().to_string();
                    match &mut value {
                        Value::String(name) if place.is_file() => move_beside(name),
                        value => for_each_file(value, &mut move_beside),
                    }
                    if place.path() == DURATION {
                        duration = value.as_float().or(value.as_integer().map(|value| value as f64));
                    }
                    place.set(&mut document, value);
                }
            }
        }
        if !mistakes.is_empty() {
            return Err(mistakes);
        }
        Ok(Input {
            base: self.base_path.clone(),
            document: toml::to_string(&document).expect("a document that was read can be written"),
            drive: Drive {
                duration: duration.filter(|_| file.is_some()), // otherwise that of the document
                file,
                ..Drive::default()
            },
        })
    }

    /// A file that CASES names, relative to the folder of CASES.
    fn beside(&self, file: &str) -> PathBuf {
        let path = folder_of(&self.sheet.path).join(file);
        std::path::absolute(&path).unwrap_or(path)
    }

    /// Time from which results count [s].
    fn start(&self, draft: &Draft, scene: &Scene) -> Result<f64, Vec<SceneError>> {
        let from = self.from.unwrap_or_else(|| ramp(scene));
        let duration = scene.output.duration;
        if from < duration {
            return Ok(from);
        }
        let what = match self.from {
            Some(_) => "results count",
            None => "the ramps end, from where results count,",
        };
        let problem = format!(
            "{what} from t = {from} s, but the run ends at {duration} s: a longer output.duration would be right"
        );
        Err(vec![mistake("", problem, &draft.span)])
    }

    /// Mistakes in the scene of a case, located at the cells that cause them.
    fn located(&self, draft: &Draft, error: LoadError) -> Vec<SceneError> {
        let LoadError::Scene { mistakes, .. } = error else {
            return vec![mistake("", error.to_string(), &draft.span)];
        };
        let place = |found: SceneError| {
            let entries = draft.entries.iter().rev();
            let set = |entry: &&Entry| match &self.targets[entry.column].place {
                Some(place) => is_within(&found.at, &place.path()),
                None => found.at.starts_with(MOTION),
            };
            let above = |entry: &&Entry| match &self.targets[entry.column].place {
                Some(place) => is_within(&place.path(), &found.at),
                None => false,
            };
            let entry = entries.clone().find(set).or_else(|| entries.clone().find(above));
            match entry {
                Some(entry) => mistake(
                    &self.targets[entry.column].key.path,
                    found.problem.clone(),
                    &entry.span,
                ),
                None => mistake(
                    &found.at,
                    format!("{}, in the scene of this case", found.problem),
                    &draft.span,
                ),
            }
        };
        mistakes.into_iter().map(place).collect()
    }
}

/// Returns whether a key path is equal to another one or below it.
fn is_within(path: &str, holder: &str) -> bool {
    let rest = path.strip_prefix(holder);
    rest.is_some_and(|rest| holder.is_empty() || rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Place of a column in the scene.
fn target(base: &Base, column: &Column) -> Result<Target, SceneError> {
    let refuse = |problem: String| mistake(&column.path, problem, &column.span);
    let place = match column.path.as_str() {
        MOTION => None,
        path => Some(Place::find(&base.document, path).map_err(refuse)?),
    };
    let si = place.as_ref().and_then(|place| place.unit);
    let factor = match (&column.unit, si) {
        (None, _) => None,
        (Some(unit), Some(si)) => Some(factor_to(si, unit).map_err(refuse)?),
        (Some(unit), None) => return Err(refuse(format!("the key has no unit: leave out [{unit}]"))),
    };
    let unit = column.unit.clone().or(si.map(str::to_string));
    Ok(Target {
        key: Arc::new(Key {
            path: column.path.clone(),
            unit,
        }),
        place,
        factor,
    })
}

/// A value in SI units.
fn in_si(target: &Target, value: &Value, span: &Range<usize>) -> Result<Value, SceneError> {
    let refuse = |problem: &str| Err(mistake(&target.key.path, problem, span));
    if target.place.is_none() && !value.is_str() {
        return refuse(
            "expected the name of a motion file; single motions have paths such as motion.NAME.x[0][0]",
        );
    }
    match (target.factor, value) {
        (None, value) => Ok(value.clone()),
        (Some(1.0), value @ Value::Integer(_)) => Ok(value.clone()),
        (Some(factor), Value::Integer(number)) => Ok(Value::Float(*number as f64 * factor)),
        (Some(factor), Value::Float(number)) => Ok(Value::Float(number * factor)),
        (Some(_), _) => refuse("expected a number, since the heading gives a unit"),
    }
}
