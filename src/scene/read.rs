//! TOML text -> Scene, file of any kind -> Scene, Scene -> TOML text.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use miette::NamedSource;
use toml::Spanned;
use toml::de::DeValue;

use super::document::Node;
use super::notes::Note;
use super::places::Places;
use super::rows::{Findings, MISTAKES_MAX};
use super::slips::slip;
use super::table::Value;
use super::{
    LoadError, MotionPath, Scene, SceneError, WaveComponents, bathymetry_file, document, input_file, map,
    moordyn, motion_file, path, tension_strain, water_file,
};

/// A scene and the file it came from.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    /// The scene, checked, with its motion files read.
    pub scene: Scene,
    /// The text of the file.
    pub text: String,
    /// The file.
    pub path: PathBuf,
    /// Remarks on the scene.
    pub notes: Vec<Note>,
    /// Kind of file.
    pub format: &'static str,
    /// Places of the scene's parts in a file that is not TOML.
    pub places: Places,
}

impl LoadedScene {
    /// Gives a note that was found later its place in the file.
    pub fn locate_note(&self, note: Note) -> Note {
        if self.format != TOML {
            return self.places.locate_note(&self.text, note);
        }
        with_lines(&self.text, vec![note]).remove(0)
    }

    /// Gives a mistake that was found later its place in the file.
    pub fn locate(&self, mistake: SceneError) -> SceneError {
        if self.format != TOML {
            return self.places.locate(mistake);
        }
        match Document::parse(&self.text) {
            Ok(document) => document.place(vec![mistake.clone()]).pop().unwrap_or(mistake),
            Err(_) => mistake,
        }
    }
}

/// Data that a deck of another program leaves to its host.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Supplement {
    /// Depth of the water [m], where the deck gives none.
    pub depth: Option<f64>,
    /// Reference positions [m] of vessels by name, such as those of the turbines of a farm.
    pub positions: BTreeMap<String, [f64; 3]>,
    /// Name of the one vessel that all coupled points of the deck ride on, its origin at (0, 0, 0) and its axes the global ones.
    pub vessel: Option<String>,
}

impl Supplement {
    /// Returns whether nothing is given.
    pub fn is_empty(&self) -> bool {
        *self == Supplement::default()
    }
}

/// Result of reading a deck.
pub(super) struct Reading {
    /// Kind of file.
    pub format: &'static str,
    /// The scene; `None` where there are mistakes.
    pub scene: Option<Scene>,
    pub places: Places,
    pub findings: Findings,
}

/// Kind of file of moorline's own scenes.
pub const TOML: &str = "TOML";

impl Scene {
    /// Reads and checks a scene. Files it speaks of are not read: a motion must be written out.
    ///
    /// # Errors
    /// The first mistake, with its key path and its bytes in the text.
    pub fn from_toml(text: &str) -> Result<Scene, SceneError> {
        let document = Document::parse(text)?;
        let scene = document.read::<Scene>()?;
        match document.place(scene.mistakes()).into_iter().next() {
            Some(first) => Err(first),
            None => Ok(scene),
        }
    }

    /// The scene as TOML that needs no other file and is read back to the same numbers, bit for bit.
    pub fn to_toml(&self) -> String {
        toml::to_string(&self.write()).expect("every scene can be written as TOML")
    }
}

/// Reads a part of a scene from TOML text: the keys of a motion, a current or a load.
///
/// # Errors
/// The first mistake, with its key path and its bytes in the text.
pub fn part<T: Value>(text: &str) -> Result<T, SceneError> {
    Document::parse(text)?.read()
}

/// Reads and checks a file: a scene and the motion files it names, which stand relative to its folder, or a deck of MoorDyn
/// or MAP++. The kind of file is found from its content.
///
/// # Errors
/// The reason why the file cannot be read, or all mistakes in it.
pub fn load(path: &Path) -> Result<LoadedScene, LoadError> {
    load_with(path, &Supplement::default())
}

/// Reads a file as [`load`] does, with the data that a deck leaves to its host.
///
/// # Errors
/// As [`load`]; and where the file is a scene, which leaves nothing to its host.
pub fn load_with(path: &Path, supplement: &Supplement) -> Result<LoadedScene, LoadError> {
    let text = read_text(path)?;
    let loaded = match deck_of(&text) {
        Some(read) => deck_scene(read(&text, supplement), &text, folder_of(path)),
        None => scene_of(&text, path).map(|scene| {
            let notes = with_lines(&text, scene.notes());
            (scene, notes, TOML, Places::default())
        }),
    };
    match loaded {
        Ok((.., TOML, _)) if !supplement.is_empty() => Err(LoadError::NotADeck {
            path: path.to_path_buf(),
            problem: match (supplement.depth, &supplement.vessel) {
                (Some(_), _) => {
                    "a scene gives the depth of its water itself, as `seabed.depth`: a depth beside it is for decks"
                }
                (None, Some(_)) => {
                    "a scene gives its vessels itself, as [[vessels]] and `on` of its points: a vessel beside it is for decks"
                }
                (None, None) => {
                    "a scene gives the places of its vessels itself, as `position`: places beside it are for decks"
                }
            },
        }),
        Ok((scene, notes, format, places)) => Ok(LoadedScene {
            scene,
            text,
            path: path.to_path_buf(),
            notes,
            format,
            places,
        }),
        Err(mistakes) => Err(LoadError::Scene {
            source_text: Box::new(NamedSource::new(path.display().to_string(), text)),
            mistakes,
        }),
    }
}

type ReadDeck = fn(&str, &Supplement) -> Reading;

/// The reader of a deck; `None` of TOML and of what is no deck.
fn deck_of(text: &str) -> Option<ReadDeck> {
    // Banners of dashes stand in comments and strings of scenes too.
    if Document::parse(text).is_ok() {
        None
    } else if map::is_deck(text) {
        Some(map::read)
    } else if moordyn::is_deck(text) {
        Some(moordyn::read)
    } else {
        None
    }
}

type Checked = (Scene, Vec<Note>, &'static str, Places);

/// Checks the scene that was read from a deck.
fn deck_scene(reading: Reading, text: &str, folder: &Path) -> Result<Checked, Vec<SceneError>> {
    let Reading {
        format,
        scene,
        places,
        findings,
    } = reading;
    let in_order = |mut mistakes: Vec<SceneError>| {
        mistakes.sort_by_key(|mistake| mistake.span.as_ref().map_or(0, |span| span.start));
        mistakes.truncate(MISTAKES_MAX);
        mistakes
    };
    let Some(mut scene) = scene.filter(|_| findings.mistakes.is_empty()) else {
        return Err(in_order(findings.mistakes));
    };
    let mut of_files = read_water(&mut scene, folder);
    of_files.extend(read_tables(&mut scene, folder));
    of_files.extend(read_soundings(&mut scene, folder));
    let cut = cut_tables(&mut scene);
    let mistakes = all_mistakes(&scene, of_files);
    let mistakes: Vec<SceneError> = mistakes
        .into_iter()
        .map(|mistake| places.locate(mistake))
        .collect();
    if !mistakes.is_empty() {
        return Err(in_order(mistakes));
    }
    let mut notes = findings.notes(text);
    // the reader of MoorDyn's decks notes diameters itself, with narrower limits
    let noted = |note: &Note| format.starts_with("MoorDyn") && note.at.ends_with(".diameter");
    let of_scene = scene.notes().into_iter().filter(|note| !noted(note));
    let of_scene = cut.into_iter().chain(of_scene);
    notes.extend(of_scene.map(|note| places.locate_note(text, note)));
    Ok((scene, notes, format, places))
}

fn scene_of(text: &str, path: &Path) -> Result<Scene, Vec<SceneError>> {
    let document = Document::parse(text).map_err(|mistake| vec![mistake])?;
    let mut scene = document.read::<Scene>().map_err(|mistake| vec![mistake])?;
    let folder = folder_of(path);
    let mut of_files = read_motions(&mut scene, folder);
    of_files.extend(read_water(&mut scene, folder));
    of_files.extend(read_tables(&mut scene, folder));
    of_files.extend(read_soundings(&mut scene, folder));
    let mistakes = all_mistakes(&scene, of_files);
    if mistakes.is_empty() {
        Ok(scene)
    } else {
        Err(document.place(mistakes))
    }
}

/// Notes on a scene with the lines of its text where their keys stand.
fn with_lines(text: &str, mut notes: Vec<Note>) -> Vec<Note> {
    if let Ok(document) = Document::parse(text) {
        for note in &mut notes {
            let span = path::locate(&document.root, &note.at);
            note.line = span.map(|span| path::line_column(text, span.start).0);
        }
    }
    notes
}

/// The folder that a scene's files stand in.
fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new("."))
}

/// Reads the soundings that the seabed names a file for; returns the mistakes in them.
fn read_soundings(scene: &mut Scene, folder: &Path) -> Option<SceneError> {
    let bed = scene.seabed.as_mut()?;
    if bed.grid.is_some() {
        return None; // two shapes are refused by the checks
    }
    match bathymetry_file::read(&folder.join(bed.file.as_ref()?)) {
        Ok(grid) => {
            bed.grid = Some(grid);
            bed.file = None;
            None
        }
        Err(problem) => Some(SceneError::new("seabed.file", problem)),
    }
}

/// Mistakes in the files of a scene, and all others.
fn all_mistakes(scene: &Scene, mut of_files: Vec<SceneError>) -> Vec<SceneError> {
    for mistake in scene.mistakes() {
        if of_files.iter().all(|known| known.at != mistake.at) {
            of_files.push(mistake);
        }
    }
    of_files
}

/// Reads every table of tension over strain that stands in a file; returns the mistakes in them.
fn read_tables(scene: &mut Scene, folder: &Path) -> Vec<SceneError> {
    let mut mistakes = Vec::new();
    for (name, line_type) in &mut scene.line_types {
        let Some(table) = &mut line_type.tension_strain else {
            continue;
        };
        if let Some(file) = &table.file {
            match tension_strain::read(&folder.join(file)) {
                Ok(rows) => table.rows = rows,
                Err(problem) => {
                    let at = format!("line_types.{}.tension_strain", path::quoted(name));
                    mistakes.push(SceneError::new(at, problem));
                }
            }
        }
    }
    mistakes
}

/// Tables of decks may say what MoorDyn does not use: rows below zero strain. Returns a note for each that has some.
fn cut_tables(scene: &mut Scene) -> Vec<Note> {
    let mut notes = Vec::new();
    for (name, line_type) in &mut scene.line_types {
        let table = line_type.tension_strain.as_mut();
        let below = table.map_or(0, |table| table.cut_below_zero());
        if below > 0 {
            let text = format!(
                "rows below zero strain in the table of tension, {below} of them, are left out: a slack line carries nothing"
            );
            let at = format!("line_types.{}.tension_strain", path::quoted(name));
            notes.push(Note::new(at, text));
        }
    }
    notes
}

/// Reads the files of waves and current, whose rows take their place; returns the mistakes in them.
fn read_water(scene: &mut Scene, folder: &Path) -> Vec<SceneError> {
    let mut mistakes = Vec::new();
    let Some(water) = &mut scene.water else {
        return mistakes;
    };
    if let Some(current) = &mut water.current
        && current.profile.is_none()
        && let Some(file) = &current.file
    {
        match water_file::profile(&folder.join(file)) {
            Ok(rows) => (current.profile, current.file) = (Some(rows), None),
            Err(problem) => mistakes.push(SceneError::new("water.current.file", problem)),
        }
    }
    let Some(waves) = &mut water.waves else {
        return mistakes;
    };
    let count = waves.seas.len();
    for (i, sea) in waves.seas.iter_mut().enumerate() {
        let Some(file) = sea.file.as_ref().filter(|_| sea.components.is_none()) else {
            continue;
        };
        match water_file::components(&folder.join(file)) {
            Ok(rows) => (sea.components, sea.file) = (Some(WaveComponents::Rows(rows)), None),
            Err(problem) => {
                let at = match count {
                    1 => "water.waves.file".to_string(),
                    _ => format!("water.waves[{i}].file"),
                };
                mistakes.push(SceneError::new(at, problem));
            }
        }
    }
    mistakes
}

/// Reads every motion file of the scene; returns the mistakes in them.
fn read_motions(scene: &mut Scene, folder: &Path) -> Vec<SceneError> {
    let of_points = scene.points.iter_mut().enumerate().filter_map(|(i, point)| {
        let motion = point.motion.as_mut()?;
        Some((format!("points[{i}].motion.file"), &point.name, motion))
    });
    let of_run = scene
        .motion
        .iter_mut()
        .map(|(name, motion)| (format!("motion.{}.file", path::quoted(name)), name, motion));
    let mut mistakes = Vec::new();
    for (at, body, motion) in of_points.chain(of_run) {
        if let MotionPath::File(file) = motion {
            match motion_file::read(&folder.join(&file.file), body) {
                Ok((rows, columns)) => (file.rows, file.columns) = (rows, columns),
                Err(problem) => mistakes.push(SceneError::new(at, problem)),
            }
        }
    }
    mistakes
}

/// Text that is TOML.
struct Document<'t> {
    root: Spanned<DeValue<'t>>,
}

impl<'t> Document<'t> {
    fn parse(text: &'t str) -> Result<Self, SceneError> {
        let root = document::parse(text).map_err(|error| syntax_mistake(text, &error))?;
        Ok(Document { root })
    }

    fn read<T: Value>(&self) -> Result<T, SceneError> {
        let mut value = T::blank();
        value.read(&Node::root(&self.root))?;
        Ok(value)
    }

    /// Gives mistakes their place in the text and puts them in its order.
    fn place(&self, mut mistakes: Vec<SceneError>) -> Vec<SceneError> {
        for mistake in &mut mistakes {
            if mistake.span.is_none() {
                mistake.span = path::locate(&self.root, &mistake.at).or(Some(0..0));
            }
        }
        mistakes.sort_by_key(|mistake| mistake.span.as_ref().map_or(0, |span| span.start));
        mistakes
    }
}

/// Mistake in the syntax, or a file of another program.
fn syntax_mistake(text: &str, error: &toml::de::Error) -> SceneError {
    if let Some(span) = moordyn::first_header(text) {
        return SceneError {
            at: String::new(),
            problem: "this is a MoorDyn file, and TOML is expected here: give the file itself, or what \
                      `moorline convert` makes of it"
                .into(),
            span: Some(span),
        };
    }
    let span = error.span().unwrap_or(0..0);
    let said = slip(text, span.start).unwrap_or_else(|| error.message().replace('\n', ", "));
    SceneError {
        at: String::new(),
        problem: format!("not TOML: {said}"),
        span: Some(span),
    }
}

fn read_text(path: &Path) -> Result<String, LoadError> {
    let unreadable = |problem: String| LoadError::Unreadable {
        path: path.to_path_buf(),
        problem,
    };
    let mut file = input_file::open(path, "a scene file", input_file::SIZE_MAX)
        .map_err(|unopened| unreadable(unopened.problem))?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)
        .map_err(|error| unreadable(format!("cannot be read: {error}")))?;
    if let Some(byte) = bytes.iter().position(|byte| *byte == 0) {
        return Err(LoadError::NotText {
            path: path.to_path_buf(),
            byte,
            problem: format!("a binary file (byte {byte} is 0), not a TOML scene"),
        });
    }
    String::from_utf8(bytes).or_else(|error| {
        let latin: String = error.as_bytes().iter().map(|byte| char::from(*byte)).collect();
        if deck_of(&latin).is_some() {
            return Ok(latin);
        }
        let byte = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..byte]).into_owned();
        let (line, column) = path::line_column(&before, byte);
        Err(LoadError::NotText {
            path: path.to_path_buf(),
            byte,
            problem: format!(
                "not UTF-8 text: byte {byte} (line {line}, column {column}) is 0x{:02X}; save the file as UTF-8",
                error.as_bytes()[byte]
            ),
        })
    })
}
