//! Converts decks of MoorDyn (versions 1 and 2, in the styles of OpenFAST and MoorDyn-C) and of MAP++ to scenes of moorline.
//!
//! [`load`] reads a scene or a deck and identifies the format by the content. A deck leaves some values to its host, such as the depth
//! of the water: [`load_with`] takes them as a [`Supplement`].
//!
//! ```no_run
//! # fn main() -> Result<(), moorline::scene::LoadError> {
//! use moorline_decks::{Supplement, load_with};
//!
//! let supplement = Supplement { depth: Some(320.0), ..Supplement::default() };
//! let loaded = load_with("oc3.map".as_ref(), &supplement)?;
//! println!("{} file: {} lines", loaded.format, loaded.scene.lines.len());
//! # Ok(()) }
//! ```
#![forbid(unsafe_code)]

mod draft;
mod findings;
mod map;
mod moordyn;
mod table;

use std::collections::BTreeMap;
use std::path::Path;

use moorline::physics::tension_table::TensionTable;
use moorline::scene::path::quoted;
use moorline::scene::{
    LineType, LoadError, LoadedScene, Note, Scene, SceneError, TensionStrain, folder_of, is_toml, load_text,
    read_text,
};

pub use moordyn::lists::{BodyRow, Carrier, LineRow, Lists, RodRow, lists as moordyn_lists};

use draft::Draft;
use findings::MISTAKES_MAX;

/// Values that a deck of another program leaves to its host.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Supplement {
    /// Depth of the water [m], if the deck does not specify it.
    pub depth: Option<f64>,
    /// Reference positions [m] of vessels by name, such as those of the turbines of a farm.
    pub positions: BTreeMap<String, [f64; 3]>,
    /// Name of the only vessel, which carries all coupled points of the deck. Its origin is (0, 0, 0) and its axes are the global ones.
    pub vessel: Option<String>,
}

impl Supplement {
    /// Returns whether no value is given.
    pub fn is_empty(&self) -> bool {
        *self == Supplement::default()
    }

    /// Reason why a supplement cannot be used with a scene.
    fn problem_of_scene(&self) -> &'static str {
        match (self.depth, &self.vessel) {
            (Some(_), _) => {
                "a scene gives the depth of its water itself, as `seabed.depth`: the option is for decks"
            }
            (None, Some(_)) => {
                "a scene gives its vessels itself, as [[vessels]] and `on` of its points: the option is for decks"
            }
            (None, None) => {
                "a scene gives the places of its vessels itself, as `position`: the option is for decks"
            }
        }
    }
}

/// Reads and checks a file: a scene, or a deck of MoorDyn or MAP++. Names of other files in it are relative to its folder.
///
/// # Errors
/// The file cannot be read, or contains mistakes, all of which are listed.
pub fn load(path: &Path) -> Result<LoadedScene, LoadError> {
    load_with(path, &Supplement::default())
}

/// Works like [`load`], with the values that a deck leaves to its host.
///
/// # Errors
/// As [`load`], and if the file is a scene but a supplement is given.
pub fn load_with(path: &Path, supplement: &Supplement) -> Result<LoadedScene, LoadError> {
    let text = read_text(path, |text| reader(text).is_some())?;
    let Some(read) = reader(&text) else {
        let loaded = load_text(path, text)?;
        return match supplement.is_empty() {
            true => Ok(loaded),
            false => Err(LoadError::Unreadable {
                path: loaded.path,
                problem: supplement.problem_of_scene().to_string(),
            }),
        };
    };
    let mut draft = read(&text, supplement);
    let path = path.to_path_buf();
    if !draft.findings.of_supplement.is_empty() {
        let problem = draft.findings.of_supplement.join("; ");
        return Err(LoadError::Unreadable { path, problem });
    }
    match finish(&mut draft, folder_of(&path)) {
        Ok(notes) => Ok(LoadedScene {
            notes: [draft.findings.notes(&text), located(&draft.places, &text, notes)].concat(),
            scene: draft.scene,
            text,
            path,
            format: draft.format,
            places: draft.places,
        }),
        Err(mut mistakes) => {
            mistakes.sort_by_key(|mistake| mistake.span.as_ref().map_or(0, |span| span.start));
            mistakes.truncate(MISTAKES_MAX);
            Err(LoadError::Scene { path, text, mistakes })
        }
    }
}

type Reader = for<'s> fn(&str, &'s Supplement) -> Draft<'s>;

/// Returns the reader of a deck; `None` for TOML and for texts that are not decks.
fn reader(text: &str) -> Option<Reader> {
    let reader = match map::is_deck(text) {
        true => Some(map::read as Reader),
        false => moordyn::is_deck(text).then_some(moordyn::read as Reader),
    };
    // Lines of dashes also occur in comments and strings of scenes.
    reader.filter(|_| !is_toml(text))
}

/// Reads the files that a deck refers to and checks the scene like any other scene. Returns notes on the scene.
fn finish(draft: &mut Draft<'_>, folder: &Path) -> Result<Vec<Note>, Vec<SceneError>> {
    let mistakes = std::mem::take(&mut draft.findings.mistakes);
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
    let of_files = draft.scene.read_files(folder);
    sound_depth(&mut draft.scene);
    let mut notes = cut_tables(&mut draft.scene);
    let mistakes = draft.scene.mistakes_with(of_files).into_iter();
    let mut mistakes: Vec<SceneError> = mistakes.map(|mistake| draft.places.locate(mistake)).collect();
    drop_repeated(&mut mistakes);
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
    draft.scene.line_types.values_mut().for_each(scale_damping_ratio);
    notes.extend(draft.scene.notes());
    Ok(notes)
}

/// Removes repeated mistakes, such as those of a row that the deck repeats.
fn drop_repeated(mistakes: &mut Vec<SceneError>) {
    let mut known: Vec<SceneError> = Vec::new();
    mistakes.retain(|mistake| {
        let is_new = !known.contains(mistake);
        if is_new {
            known.push(mistake.clone());
        }
        is_new
    });
}

/// Sets the depth for waves to the greatest of the soundings if the deck does not specify it.
fn sound_depth(scene: &mut Scene) {
    if let Some(seabed) = &mut scene.seabed
        && seabed.depth == 0.0
        && let Some(grid) = &seabed.grid
    {
        seabed.depth = grid.depth.iter().flatten().copied().fold(0.0, f64::max);
    }
}

fn located(places: &moorline::scene::Places, text: &str, notes: Vec<Note>) -> Vec<Note> {
    let notes = notes.into_iter();
    notes.map(|note| places.locate_note(text, note)).collect()
}

/// Removes the rows below zero strain from tension tables, since MoorDyn does not use them. Returns a note for each table with such rows.
fn cut_tables(scene: &mut Scene) -> Vec<Note> {
    let mut notes = Vec::new();
    for (name, line_type) in &mut scene.line_types {
        let below = line_type.tension_strain.as_mut().map_or(0, cut_below_zero);
        if below > 0 {
            let text = format!(
                "rows below zero strain in the table of tension, {below} of them, are left out: a slack line carries nothing"
            );
            let at = format!("line_types.{}.tension_strain", quoted(name));
            notes.push(Note::new(at, text));
        }
    }
    notes
}

/// Refers the damping ratio of a line type with a table to MoorDyn's stiffness, the last tension over the last strain.
fn scale_damping_ratio(line_type: &mut LineType) {
    if let (Some(table), Some(ratio)) = (&line_type.tension_strain, &mut line_type.damping_ratio)
        && let Some([strain, tension]) = table.rows.last()
    {
        let (_, steepest) = TensionTable::through(&table.rows);
        *ratio *= (tension / strain / steepest).sqrt();
    }
}

/// Removes the rows below zero strain and returns their number [-]. If no row is at zero strain, one is added there by linear interpolation
/// between the adjacent rows.
fn cut_below_zero(table: &mut TensionStrain) -> usize {
    let below = table.rows.iter().take_while(|row| row[0] < 0.0).count();
    if below == 0 {
        return 0;
    }
    let last = table.rows[below - 1];
    table.rows.drain(..below);
    if let Some(&[strain, tension]) = table.rows.first()
        && strain > 0.0
    {
        let at_zero = last[1] - last[0] * (tension - last[1]) / (strain - last[0]);
        let rounding = 1e-9 * tension.abs().max(last[1].abs());
        let at_zero = if at_zero.abs() > rounding { at_zero } else { 0.0 };
        table.rows.insert(0, [0.0, at_zero]);
    }
    below
}
