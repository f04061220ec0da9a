//! The folder that a command writes into: made and tried before any work, and gone again where nothing came to be in it.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use moorline::output::{open_folder, remove_partial};

use crate::failure::Failure;

/// Exit code of a program that Ctrl-C ends, as shells have it: 128 and the signal's number.
const INTERRUPTED: i32 = 130;

/// A folder for results.
#[derive(Debug, Clone)]
struct Place {
    path: PathBuf,
    /// Folders that were not there before, the innermost first.
    made: Vec<PathBuf>,
}

/// A folder that is open for results as long as this lives.
#[derive(Debug)]
pub struct Folder(Place);

impl Folder {
    /// Makes a folder where it is missing, and checks that it takes files. From now on Ctrl-C names what is kept in it.
    pub fn open(path: &Path) -> Result<Folder, Failure> {
        let above = path.ancestors();
        let missing = above.take_while(|path| !path.as_os_str().is_empty() && !path.exists());
        let folder = Folder(Place {
            path: path.to_path_buf(),
            made: missing.map(Path::to_path_buf).collect(),
        });
        open_folder(path)?;
        let place = folder.0.clone();
        // Without a handler, Ctrl-C ends the program as it ends any other.
        let _ = ctrlc::set_handler(move || place.interrupt());
        Ok(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        self.0.remove_empty();
    }
}

impl Place {
    /// Removes the folders that were made for nothing.
    fn remove_empty(&self) {
        for folder in &self.made {
            // The system keeps one that has something in it.
            if fs::remove_dir(folder).is_err() {
                break;
            }
        }
    }

    /// Ends the program with a message on what is kept.
    fn interrupt(&self) -> ! {
        remove_partial(&self.path);
        self.remove_empty();
        let holds = fs::read_dir(&self.path).is_ok_and(|mut entries| entries.next().is_some());
        let kept = match holds {
            true => format!("{} holds what was written before", self.path.display()),
            false => "nothing was written".to_string(),
        };
        // A message that cannot be written changes nothing.
        let _ = writeln!(io::stderr(), "interrupted: {kept}");
        std::process::exit(INTERRUPTED)
    }
}
