//! `moorline convert`: a deck of another program as a scene.

use std::io::Write;
use std::path::Path;

use moorline::model::Model;
use moorline::output::{check_file, write_file};
use moorline::scene::TOML;
use moorline_decks::{Supplement, load_with};

use crate::failure::Failure;
use crate::folder::{Folder, check_apart};
use crate::terminal::print;

/// Reads a deck with the data that it leaves to its host, and writes the same system as a scene with comments.
pub(crate) fn convert(path: &Path, target: &Path, supplement: &Supplement) -> Result<(), Failure> {
    check_file(target)?;
    check_apart(path, target)?;
    let _open = Folder::of_file(target);
    let loaded = load_with(path, supplement)?;
    if loaded.format == TOML {
        let text = format!("{} is a scene of moorline already", path.display());
        return Err(Failure::Argument(text));
    }
    // A scene that cannot be discretised is refused.
    Model::new(&loaded.scene).map_err(|mistake| Failure::of_scene(mistake, &loaded))?;
    let text = loaded.to_commented_toml();
    write_file(target, |out: &mut dyn Write| out.write_all(text.as_bytes()))?;
    let mut said = format!("written to {}\n", target.display());
    for note in &loaded.notes {
        said.push_str(&format!("note: {note}\n"));
    }
    print(&said)
}
