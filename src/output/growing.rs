//! File that grows at its end and is complete after every write.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{OutputError, create, target_of};

/// Number of bytes before the mark that are compared when a file is continued [-].
const TAIL: usize = 4096;

/// File that grows. Each write appends data and then an ending, such as the footer of a format; the next write replaces the ending.
#[derive(Debug)]
pub(super) struct Growing {
    path: PathBuf,
    file: File,
    mark: Mark,
}

/// Position in a file up to which it is kept when the run continues.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Mark {
    /// Number of data bytes.
    end: u64,
    /// Last data bytes.
    tail: Vec<u8>,
    /// Ending after the data.
    ending: Vec<u8>,
}

impl Growing {
    /// Creates a file, replacing an old one of the same name; if this is a link, its target is replaced.
    pub(super) fn create(path: &Path) -> Result<Growing, OutputError> {
        let file = target_of(path).and_then(|target| create(&target));
        Ok(Growing {
            path: path.to_path_buf(),
            file: file.map_err(|source| OutputError::of_file(path, source))?,
            mark: Mark::default(),
        })
    }

    /// Continues a file after a mark; data after the mark are removed.
    ///
    /// # Errors
    /// The file is missing or has other data at the mark.
    pub(super) fn reopen(path: &Path, mark: Mark) -> Result<Growing, OutputError> {
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .open(path)
            .map_err(|source| OutputError::of_file(path, source))?;
        let mut tail = vec![0; mark.tail.len()];
        let start = mark.end - mark.tail.len() as u64;
        let read = file
            .seek(SeekFrom::Start(start))
            .and_then(|_| file.read_exact(&mut tail));
        if read.is_err() || tail != mark.tail {
            let changed = "it has been changed since the run was interrupted: run the scene from the start";
            return Err(OutputError::of_file(
                path,
                io::Error::new(io::ErrorKind::InvalidInput, changed),
            ));
        }
        let path = path.to_path_buf();
        let ending = mark.ending.clone();
        let mut growing = Growing { path, file, mark };
        growing.append(&[], ending)?;
        let length = growing.mark.end + growing.mark.ending.len() as u64;
        let cut = growing.file.set_len(length);
        cut.map_err(|source| OutputError::of_file(&growing.path, source))?;
        Ok(growing)
    }

    /// Appends data and an ending, in one write.
    pub(super) fn append(&mut self, data: &[u8], ending: Vec<u8>) -> Result<(), OutputError> {
        let mark = &mut self.mark;
        let place = self.file.seek(SeekFrom::Start(mark.end));
        let written = place.and_then(|_| match ending.is_empty() {
            true => self.file.write_all(data),
            false => self.file.write_all(&[data, &ending].concat()),
        });
        if let Err(source) = written {
            // the first failure is reported
            let _ = self.restore();
            return Err(OutputError::of_file(&self.path, source));
        }
        mark.end += data.len() as u64;
        mark.tail.extend(&data[data.len().saturating_sub(TAIL)..]);
        mark.tail.drain(..mark.tail.len().saturating_sub(TAIL));
        mark.ending = ending;
        Ok(())
    }

    /// Removes the part of a write that failed, such as half a row.
    fn restore(&mut self) -> io::Result<()> {
        let Mark { end, ending, .. } = &self.mark;
        self.file.set_len(*end)?;
        self.file.seek(SeekFrom::Start(*end))?;
        self.file.write_all(ending)
    }

    /// Returns the mark up to which the file is written, after the data are stored on the disk.
    pub(super) fn mark(&mut self) -> Result<Mark, OutputError> {
        let stored = self.file.sync_data();
        stored.map_err(|source| OutputError::of_file(&self.path, source))?;
        Ok(self.mark.clone())
    }

    /// Number of data bytes [-]; 0 for a new file.
    pub(super) fn end(&self) -> u64 {
        self.mark.end
    }

    /// Ending after the data.
    pub(super) fn ending(&self) -> &[u8] {
        &self.mark.ending
    }

    /// Converts an error of the encoder to an error of this file.
    pub(super) fn failure(&self, source: io::Error) -> OutputError {
        OutputError::of_file(&self.path, source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_is_whole_after_every_write_and_continues_behind_a_mark() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let mut file = Growing::create(&path).unwrap();
        file.append(b"one ", b"end".to_vec()).unwrap();
        let mark = file.mark().unwrap();
        file.append(b"two and more ", b"END!".to_vec()).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one two and more END!");
        let mut file = Growing::reopen(&path, mark.clone()).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one end");
        file.append(b"2 ", b"end".to_vec()).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one 2 end");
        for changed in ["ono ", "on"] {
            fs::write(&path, changed).unwrap();
            let refused = Growing::reopen(&path, mark.clone()).unwrap_err().to_string();
            assert!(refused.contains("has been changed since"), "{refused}");
            assert_eq!(fs::read_to_string(&path).unwrap(), changed);
        }
    }
}
