//! TOML text -> Scene, scene file -> Scene, Scene -> TOML text.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use miette::NamedSource;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::notes::Note;
use super::{LoadError, MotionPath, Scene, SceneError, document, motion_file, path};

/// Longest scene file that is read [bytes].
const SIZE_MAX: u64 = 256 << 20;

/// A scene and the file it came from.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    /// The scene, checked, with its motion files read.
    pub scene: Scene,
    /// The text of the file.
    pub text: String,
    /// The file.
    pub path: PathBuf,
    /// What is no mistake but may surprise.
    pub notes: Vec<Note>,
}

impl Scene {
    /// Reads and checks a scene. Files it speaks of are not read: a motion must be written out.
    ///
    /// # Errors
    /// The first mistake, with its key path and its bytes in the text.
    pub fn from_toml(text: &str) -> Result<Scene, SceneError> {
        let document = Document::parse(text)?;
        let scene = document.scene()?;
        match document.place(scene.mistakes()).into_iter().next() {
            Some(first) => Err(first),
            None => Ok(scene),
        }
    }

    /// The scene as TOML that needs no other file and is read back to the same numbers, bit for bit.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("every scene can be written as TOML")
    }
}

/// Reads and checks a scene file and the motion files it names, which stand relative to its folder.
///
/// # Errors
/// What keeps the file from being read, or all mistakes in it.
pub fn load(path: &Path) -> Result<LoadedScene, LoadError> {
    let text = read_text(path)?;
    match scene_of(&text, path) {
        Ok(scene) => Ok(LoadedScene {
            notes: scene.notes(),
            scene,
            text,
            path: path.to_path_buf(),
        }),
        Err(mistakes) => Err(LoadError::Scene {
            source_text: Box::new(NamedSource::new(path.display().to_string(), text)),
            mistakes,
        }),
    }
}

fn scene_of(text: &str, path: &Path) -> Result<Scene, Vec<SceneError>> {
    let document = Document::parse(text).map_err(|mistake| vec![mistake])?;
    let mut scene = document.scene().map_err(|mistake| vec![mistake])?;
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut mistakes = read_motions(&mut scene, folder);
    for mistake in scene.mistakes() {
        if mistakes.iter().all(|known| known.at != mistake.at) {
            mistakes.push(mistake);
        }
    }
    if mistakes.is_empty() {
        Ok(scene)
    } else {
        Err(document.place(mistakes))
    }
}

/// Reads every motion file of the scene; returns what is wrong with them.
fn read_motions(scene: &mut Scene, folder: &Path) -> Vec<SceneError> {
    let of_points = scene
        .points
        .iter_mut()
        .enumerate()
        .filter_map(|(i, point)| {
            let motion = point.motion.as_mut()?;
            Some((format!("points[{i}].motion.file"), motion))
        });
    let of_run = scene
        .motion
        .iter_mut()
        .map(|(name, motion)| (format!("motion.{}.file", path::quoted(name)), motion));
    let mut mistakes = Vec::new();
    for (at, motion) in of_points.chain(of_run) {
        if let MotionPath::File(file) = motion {
            match motion_file::read(&folder.join(&file.file)) {
                Ok(rows) => file.rows = rows,
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
        let table = DeTable::parse(text).map_err(|error| syntax_mistake(text, &error))?;
        let span = table.span();
        Ok(Document {
            root: Spanned::new(span, DeValue::Table(table.into_inner())),
        })
    }

    fn scene(&self) -> Result<Scene, SceneError> {
        document::deserialize(&self.root)
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

/// What the TOML parser says, or that this is another program's file.
fn syntax_mistake(text: &str, error: &toml::de::Error) -> SceneError {
    if let Some(start) = moordyn_section(text) {
        return SceneError {
            at: String::new(),
            problem: "this is a MoorDyn file, and only TOML scenes are read: write the lines as `[[lines]]`, \
                      the points as `[[points]]` and the types as `[line_types.name]`"
                .into(),
            span: Some(start..start + 3),
        };
    }
    SceneError {
        at: String::new(),
        problem: format!("not TOML: {}", error.message().replace('\n', ", ")),
        span: Some(error.span().unwrap_or(0..0)),
    }
}

/// First byte of a line such as `---------------------- LINE TYPES -----`, which heads a section of MoorDyn's files.
fn moordyn_section(text: &str) -> Option<usize> {
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let title = line.trim();
        if title.starts_with("---")
            && title
                .trim_start_matches('-')
                .chars()
                .any(char::is_alphabetic)
        {
            return Some(start);
        }
        start += line.len();
    }
    None
}

fn read_text(path: &Path) -> Result<String, LoadError> {
    let unreadable = |problem: String| LoadError::Unreadable {
        path: path.to_path_buf(),
        problem,
    };
    if path.is_dir() {
        return Err(unreadable("is a folder, not a scene file".into()));
    }
    let file = File::open(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => unreadable("no such file".into()),
        _ => unreadable(format!("cannot be opened: {error}")),
    })?;
    let mut bytes = Vec::new();
    file.take(SIZE_MAX + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| unreadable(format!("cannot be read: {error}")))?;
    if let Some(byte) = bytes.iter().position(|byte| *byte == 0) {
        return Err(LoadError::NotText {
            path: path.to_path_buf(),
            byte,
            problem: format!("a binary file (byte {byte} is 0), not a TOML scene"),
        });
    }
    if bytes.len() as u64 > SIZE_MAX {
        return Err(unreadable(format!(
            "longer than {} MiB: no scene",
            SIZE_MAX >> 20
        )));
    }
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..byte]).into_owned();
        let (line, column) = path::line_column(&before, byte);
        LoadError::NotText {
            path: path.to_path_buf(),
            byte,
            problem: format!(
                "not UTF-8 text: byte {byte} (line {line}, column {column}) is 0x{:02X}; save the file as UTF-8",
                error.as_bytes()[byte]
            ),
        }
    })
}
