//! Folder into which a command writes: created, tested and locked before any work, and removed again if it stays empty. Also the message on the results
//! that an interrupted command leaves.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, PoisonError};

use moorline::output::folder::ResultsFolder;
use moorline::output::remove_partial;

use crate::failure::Failure;

/// Exit code of a program ended by Ctrl-C, by the convention of shells: 128 plus the signal's number.
pub(crate) const INTERRUPTED: u8 = 130;

/// Interrupts end the program.
const ENDS: u8 = 0;
/// The next interrupt is left to the command.
const LISTENS: u8 = 1;
/// An interrupt was received, after which the command ends.
const STOPS: u8 = 2;
static INTERRUPTS: AtomicU8 = AtomicU8::new(ENDS);

/// Folder into which the command is writing.
static OPEN: Mutex<Option<Place>> = Mutex::new(None);

/// Folder into which files are written.
#[derive(Debug, Clone)]
struct Place {
    path: PathBuf,
    /// Folders that were created, innermost first.
    made: Vec<PathBuf>,
    /// True if the folder is for results alone; false for the folder of one file.
    is_own: bool,
}

/// Folder that is open for results until this value is dropped.
#[derive(Debug)]
pub(crate) struct Folder {
    place: Place,
    /// Lock of a folder for results, until it is handed over.
    results: Option<ResultsFolder>,
}

impl Folder {
    /// Creates a folder if it is missing, checks that files can be written into it, and refuses other processes. The message of an interrupted
    /// command names the results in it.
    pub(crate) fn open(path: &Path) -> Result<Folder, Failure> {
        let above = path.ancestors();
        let missing = above.take_while(|path| !path.as_os_str().is_empty() && !path.exists());
        let made = missing.map(Path::to_path_buf).collect();
        let results = ResultsFolder::open(path)?;
        Ok(Folder::of(path, made, Some(results)))
    }

    /// Returns the folder of one file, whose incomplete content an interrupted command removes.
    pub(crate) fn of_file(target: &Path) -> Folder {
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
        Folder::of(folder.unwrap_or(Path::new(".")), Vec::new(), None)
    }

    fn of(path: &Path, made: Vec<PathBuf>, results: Option<ResultsFolder>) -> Folder {
        let (path, is_own) = (path.to_path_buf(), results.is_some());
        let place = Place { path, made, is_own };
        set_open(Some(place.clone()));
        Folder { place, results }
    }

    /// Moves the lock to a value that is dropped before this one.
    pub(crate) fn take(&mut self) -> ResultsFolder {
        self.results.take().expect("a folder for results, taken once")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        set_open(None);
        self.results = None;
        self.place.remove_empty();
    }
}

/// While this value exists, the first interrupt is left to the command, which polls it and ends by itself. The second one ends the program.
#[derive(Debug)]
pub(crate) struct Listener(());

impl Listener {
    /// Begins to leave interrupts to the command.
    pub(crate) fn new() -> Listener {
        INTERRUPTS.store(LISTENS, Ordering::SeqCst);
        Listener(())
    }

    /// Returns whether an interrupt was received.
    pub(crate) fn is_interrupted(&self) -> bool {
        INTERRUPTS.load(Ordering::Relaxed) == STOPS
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        INTERRUPTS.store(ENDS, Ordering::SeqCst);
    }
}

/// Refuses to write results to the file from which the input is read.
pub(crate) fn check_apart(input: &Path, target: &Path) -> Result<(), Failure> {
    let [read, written] = [input, target].map(|path| fs::canonicalize(path).ok());
    if read.is_some() && read == written {
        let text = format!(
            "{} is the file that is read: give another name to write",
            target.display()
        );
        return Err(Failure::Argument(text));
    }
    Ok(())
}

/// Sets the folder into which the command writes; returns the previous one.
fn set_open(place: Option<Place>) -> Option<Place> {
    let mut open = OPEN.lock().unwrap_or_else(PoisonError::into_inner);
    std::mem::replace(&mut open, place)
}

impl Place {
    /// Removes the created folders that are empty.
    fn remove_empty(&self) {
        for folder in &self.made {
            // The system does not remove a folder that is not empty.
            if fs::remove_dir(folder).is_err() {
                break;
            }
        }
    }

    /// Removes incomplete files; returns whether any results remain.
    fn clear(&self) -> bool {
        remove_partial(&self.path);
        if self.is_own {
            ResultsFolder::abandon(&self.path);
        }
        self.remove_empty();
        self.is_own && fs::read_dir(&self.path).is_ok_and(|mut entries| entries.next().is_some())
    }
}

/// Installs a handler for Ctrl-C and termination requests such as SIGTERM: they end the program with a message on the results kept, or are left to a
/// [`Listener`].
pub(crate) fn end_on_interrupt() {
    // If the handler cannot be installed, they end the program without a message.
    let _ = ctrlc::set_handler(|| {
        let left = INTERRUPTS.compare_exchange(LISTENS, STOPS, Ordering::SeqCst, Ordering::SeqCst);
        if left.is_ok() {
            return;
        }
        let kept = match set_open(None).filter(Place::clear) {
            Some(place) => format!("{} holds what was written before", place.path.display()),
            None => "nothing was written".to_string(),
        };
        // A failure to write the message is ignored.
        let _ = writeln!(io::stderr(), "interrupted: {kept}");
        std::process::exit(INTERRUPTED.into())
    });
}
