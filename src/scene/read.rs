//! Reads scenes from TOML text and from files, and writes them as TOML.

use std::io::Read;
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::DeValue;

use super::document::Node;
use super::notes::Note;
use super::places::Places;
use super::rows::Row;
use super::slips::slip;
use super::table::Value;
use super::{
    LoadError, MotionPath, Scene, SceneError, WaveComponents, bathymetry_file, document, input_file,
    motion_file, path, tension_strain, water_file,
};

/// A scene and the file it came from.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    /// Checked scene; the files that it names have been read.
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
    /// Adds the place in the file to a note that was found after loading.
    pub fn locate_note(&self, note: Note) -> Note {
        if self.format != TOML {
            return self.places.locate_note(&self.text, note);
        }
        match Document::parse(&self.text) {
            Ok(document) => document.place_note(&self.text, note),
            Err(_) => note,
        }
    }

    /// Replaces the scene by a changed one and drops the remarks that no longer apply. Returns the new remarks, without places in the file.
    pub fn change(&mut self, scene: Scene) -> Vec<Note> {
        let (before, mut now) = (self.scene.notes(), scene.notes());
        let past = before.iter().filter(|note| !now.contains(note));
        // remarks of earlier changes have no place
        let with_place = |note: &Note| [note.clone(), self.locate_note(note.clone())];
        let past: Vec<Note> = past.flat_map(with_place).collect();
        self.notes.retain(|note| !past.contains(note));
        now.retain(|note| !before.contains(note));
        self.scene = scene;
        now
    }

    /// Adds the place in the file to a mistake that was found after loading.
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

/// Kind of file of moorline's own scenes.
pub const TOML: &str = "TOML";

impl Scene {
    /// Reads and checks a scene. Files that it names are not read: a motion must be written out.
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

    /// Reads the files that a scene names, relative to a folder; returns the mistakes in them.
    pub fn read_files(&mut self, folder: &Path) -> Vec<SceneError> {
        let mut files = Files {
            folder,
            mistakes: Vec::new(),
        };
        read_motions(self, &mut files);
        read_water(self, &mut files);
        for (name, line_type) in &mut self.line_types {
            let at = || format!("line_types.{}.tension_strain", path::quoted(name));
            if let Some(table) = &mut line_type.tension_strain
                && let Some(rows) = files.read(table.file.as_deref(), at, tension_strain::read)
            {
                table.rows = rows;
            }
        }
        // a seabed with both a grid and a file is refused by the checks
        if let Some(seabed) = self.seabed.as_mut().filter(|seabed| seabed.grid.is_none())
            && let Some(grid) = files.read(
                seabed.file.as_deref(),
                || "seabed.file".into(),
                bathymetry_file::read,
            )
        {
            (seabed.grid, seabed.file) = (Some(grid), None);
        }
        files.mistakes
    }

    /// Mistakes in the files of a scene, and those in the scene that are not due to them.
    pub fn mistakes_with(&self, mut of_files: Vec<SceneError>) -> Vec<SceneError> {
        for mistake in self.mistakes() {
            if of_files.iter().all(|known| known.at != mistake.at) {
                of_files.push(mistake);
            }
        }
        of_files
    }
}

/// Reads a part of a scene from TOML text: the keys of a motion, a current or a load.
///
/// # Errors
/// The first mistake, with its key path and its bytes in the text.
pub fn part<T: Value + Default>(text: &str) -> Result<T, SceneError> {
    Document::parse(text)?.read()
}

/// Reads and checks a scene file and the files it names, relative to its folder.
///
/// # Errors
/// The reason why the file cannot be read, or all mistakes in it.
pub fn load(path: &Path) -> Result<LoadedScene, LoadError> {
    load_text(path, read_text(path, |_| false)?)
}

/// As [`load`], for a file whose text has been read.
///
/// # Errors
/// All mistakes in it.
pub fn load_text(path: &Path, text: String) -> Result<LoadedScene, LoadError> {
    match scene_of(&text, folder_of(path)) {
        Ok((scene, notes)) => Ok(LoadedScene {
            notes,
            scene,
            text,
            path: path.to_path_buf(),
            format: TOML,
            places: Places::default(),
        }),
        Err(mistakes) => Err(LoadError::Scene {
            path: path.to_path_buf(),
            text,
            mistakes,
        }),
    }
}

/// Returns whether a text is valid TOML, be it a scene or not.
pub fn is_toml(text: &str) -> bool {
    Document::parse(text).is_ok()
}

/// The scene of a text and the notes on it.
fn scene_of(text: &str, folder: &Path) -> Result<(Scene, Vec<Note>), Vec<SceneError>> {
    let document = Document::parse(text).map_err(|mistake| vec![mistake])?;
    let mut scene = document.read::<Scene>().map_err(|mistake| vec![mistake])?;
    let of_files = scene.read_files(folder);
    let mistakes = scene.mistakes_with(of_files);
    if mistakes.is_empty() {
        let notes = scene.notes().into_iter();
        let notes = notes.map(|note| document.place_note(text, note)).collect();
        Ok((scene, notes))
    } else {
        Err(document.place(mistakes))
    }
}

/// The folder to which the paths of a scene's files are relative.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new("."))
}

/// Reader of the files that a scene names.
struct Files<'f> {
    folder: &'f Path,
    mistakes: Vec<SceneError>,
}

impl Files<'_> {
    /// Returns the content of a file; `None` if no file is given, or if there is a mistake in it, which is stored with its key path.
    fn read<T>(
        &mut self,
        file: Option<&str>,
        at: impl Fn() -> String,
        read: impl Fn(&Path) -> Result<T, String>,
    ) -> Option<T> {
        let content = read(&self.folder.join(file?));
        content
            .map_err(|problem| self.mistakes.push(SceneError::new(at(), problem)))
            .ok()
    }
}

/// Reads the files of waves and current, and replaces their paths by the rows.
fn read_water(scene: &mut Scene, files: &mut Files<'_>) {
    let Some(water) = &mut scene.water else {
        return;
    };
    if let Some(current) = water.current.as_mut().filter(|current| current.profile.is_none()) {
        let at = || "water.current.file".to_string();
        if let Some(rows) = files.read(current.file.as_deref(), at, water_file::profile) {
            (current.profile, current.file) = (Some(rows), None);
        }
    }
    let Some(waves) = &mut water.waves else {
        return;
    };
    for i in 0..waves.seas.len() {
        let (at, sea) = (format!("{}.file", waves.path(i)), &mut waves.seas[i]);
        let file = sea.file.as_deref().filter(|_| sea.components.is_none());
        if let Some(rows) = files.read(file, || at.clone(), water_file::components) {
            (sea.components, sea.file) = (Some(WaveComponents::Rows(rows)), None);
        }
    }
}

/// Reads every motion file of the scene.
fn read_motions(scene: &mut Scene, files: &mut Files<'_>) {
    let of_points = scene.points.iter_mut().enumerate().filter_map(|(i, point)| {
        let motion = point.motion.as_mut()?;
        Some((format!("points[{i}].motion.file"), &point.name, motion))
    });
    let of_run = scene
        .motion
        .iter_mut()
        .map(|(name, motion)| (format!("motion.{}.file", path::quoted(name)), name, motion));
    for (at, body, motion) in of_points.chain(of_run) {
        let MotionPath::File(file) = motion else {
            continue;
        };
        let read = |path: &Path| motion_file::read(path, body);
        if let Some(read) = files.read(Some(&file.file), || at.clone(), read) {
            let mut vessels = scene.vessels.iter();
            let vessel = vessels.find(|vessel| vessel.name == *body && read.is_recorded);
            file.rows = match vessel {
                Some(vessel) => vessel.in_own_order(read.rows),
                None => read.rows,
            };
            file.columns = read.columns;
        }
    }
}

/// Parsed TOML text.
struct Document<'t> {
    root: Spanned<DeValue<'t>>,
}

impl<'t> Document<'t> {
    fn parse(text: &'t str) -> Result<Self, SceneError> {
        let root = document::parse(text).map_err(|error| syntax_mistake(text, &error))?;
        Ok(Document { root })
    }

    fn read<T: Value + Default>(&self) -> Result<T, SceneError> {
        Node::root(&self.root).read()
    }

    /// Sets the line of a note to that of its key in the text.
    fn place_note(&self, text: &str, mut note: Note) -> Note {
        if let Some(file) = path::file_of(&self.root, &note.at) {
            note.at = file;
        }
        let span = path::locate(&self.root, &note.at);
        note.line = span.map(|span| path::line_column(text, span.start).0);
        note
    }

    /// Sets the places of mistakes in the text and sorts them by place.
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

/// Mistake for a text that is not TOML: a syntax error, or a file of another program.
fn syntax_mistake(text: &str, error: &toml::de::Error) -> SceneError {
    let mistake = |span, problem: &str| SceneError {
        at: String::new(),
        problem: format!("not TOML: {problem}"),
        span: Some(span),
    };
    if let Some(rule) = Row::all(text).find(|row| row.text.trim_start().starts_with("---")) {
        let problem = "rows of dashes head the tables of a deck of another program; give the deck itself, or the scene that \
                       `moorline convert` makes of it";
        return mistake(rule.span(), problem);
    }
    let span = error.span().unwrap_or(0..0);
    match slip(text, span.start) {
        Some(problem) => mistake(span, &problem),
        None => mistake(span, &error.message().replace('\n', ", ")),
    }
}

/// Reads a text file; bytes that are not UTF-8 are read as Latin-1 if `is_latin_1` accepts the resulting text.
///
/// # Errors
/// The reason why the file cannot be read, or the first byte that is not text.
pub fn read_text(path: &Path, is_latin_1: impl Fn(&str) -> bool) -> Result<String, LoadError> {
    let unreadable = |problem: String| LoadError::Unreadable {
        path: path.to_path_buf(),
        problem,
    };
    let not_text = |byte: usize, problem: String| LoadError::NotText {
        path: path.to_path_buf(),
        byte,
        problem,
    };
    let mut file = input_file::open(path, "a scene file", input_file::SIZE_MAX)
        .map_err(|unopened| unreadable(unopened.problem))?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)
        .map_err(|error| unreadable(format!("cannot be read: {error}")))?;
    if let Some(byte) = bytes.iter().position(|byte| *byte == 0) {
        let problem = format!("a binary file (byte {byte} is 0), not a TOML scene");
        return Err(not_text(byte, problem));
    }
    String::from_utf8(bytes).or_else(|error| {
        let latin: String = error.as_bytes().iter().map(|byte| char::from(*byte)).collect();
        if is_latin_1(&latin) {
            return Ok(latin);
        }
        let byte = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..byte]).into_owned();
        let (line, column) = path::line_column(&before, byte);
        let problem = format!(
            "not UTF-8 text: byte {byte} (line {line}, column {column}) is 0x{:02X}; save the file as UTF-8",
            error.as_bytes()[byte]
        );
        Err(not_text(byte, problem))
    })
}
