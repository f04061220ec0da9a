//! Folders of results: created where they are missing, and written by one process at a time.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};

use super::OutputError;

/// File that is locked while a process writes into its folder.
const LOCK: &str = ".moorline.lock";

/// Folder into which this value alone writes, until it is dropped: other processes are refused.
#[derive(Debug)]
pub struct ResultsFolder {
    path: PathBuf,
    /// Locked until it is closed, which the system does if the process is killed.
    _lock: File,
}

impl ResultsFolder {
    /// Creates a folder and its parents if they are missing, and locks it. On a file system without locks, the folder is not protected.
    ///
    /// # Errors
    /// As for [`make_folder`], and if no file can be written there or another process writes into the folder.
    pub fn open(path: &Path) -> Result<ResultsFolder, OutputError> {
        make_folder(path)?;
        let path = path.to_path_buf();
        let mut options = OpenOptions::new();
        let file = options.write(true).create(true).truncate(false);
        loop {
            let lock = file.open(path.join(LOCK)).map_err(|source| OutputError::Closed {
                path: path.clone(),
                source,
            })?;
            match lock.try_lock() {
                // after it was opened here, the process that wrote before removed it
                Ok(()) if !path.join(LOCK).exists() => {}
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(ResultsFolder { path, _lock: lock }),
                Err(TryLockError::WouldBlock) => return Err(OutputError::InUse { path }),
            }
        }
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Removes the locked file of a folder, for a process that ends without dropping the value.
    pub fn abandon(path: &Path) {
        let _ = fs::remove_file(path.join(LOCK)); // a file that stays is not locked, and does no harm
    }
}

impl Drop for ResultsFolder {
    fn drop(&mut self) {
        ResultsFolder::abandon(&self.path);
    }
}

/// Creates a folder and its parents, if they are missing.
///
/// # Errors
/// A file has this name, or the operating system refuses the folder.
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    if path.exists() && !path.is_dir() {
        return Err(OutputError::NotAFolder {
            path: path.to_path_buf(),
        });
    }
    fs::create_dir_all(path).map_err(|source| OutputError::Folder {
        path: path.to_path_buf(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_in_place_of_a_folder_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken");
        fs::write(&path, "").unwrap();
        let message = make_folder(&path).unwrap_err().to_string();
        assert!(message.ends_with("taken is no folder: give the name of one"));
    }

    #[test]
    fn a_folder_is_open_once_at_a_time_and_a_file_left_by_a_killed_process_does_not_close_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results");
        fs::create_dir(&path).unwrap();
        fs::write(path.join(LOCK), "").unwrap();
        let first = ResultsFolder::open(&path).unwrap();
        let second = ResultsFolder::open(&path).unwrap_err();
        assert!(matches!(second, OutputError::InUse { .. }), "{second}");
        drop(first);
        assert_eq!(fs::read_dir(&path).unwrap().count(), 0);
        ResultsFolder::open(&path).unwrap();
    }
}
