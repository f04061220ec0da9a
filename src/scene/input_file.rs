//! Input files: regular files or standard input, opened once and read up to a maximum size.
//!
//! Reading a device may never end, and opening a named pipe may never return: both kinds are refused before they are opened.

use std::fmt::Write;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Maximum size of a scene, and of a table that is not a motion file [bytes].
pub const SIZE_MAX: u64 = 64 << 20;
/// Maximum size of a motion file [bytes], which is read as a stream.
pub(crate) const MOTION_SIZE_MAX: u64 = 4 << 30;
/// Hint in the message on a missing file to which a scene or a deck refers.
pub(super) const RELATIVE: &str = " (a relative path starts at the folder of the file that names it)";
/// Names of standard input.
const STANDARD_INPUT: [&str; 3] = ["/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"];

/// Reason why a file was not opened, in words that follow its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unopened {
    /// True if there is no such file.
    pub is_missing: bool,
    /// The reason.
    pub problem: String,
}

impl Unopened {
    fn because(problem: String) -> Unopened {
        Unopened {
            is_missing: false,
            problem,
        }
    }

    /// Returns the file's name and the reason, followed by `hint` if there is no such file.
    pub fn at(&self, path: &Path, hint: &str) -> String {
        let mut text = path.display().to_string();
        let colon = if self.is_missing { ":" } else { "" };
        let hint = if self.is_missing { hint } else { "" };
        // writing to a String cannot fail
        let _ = write!(text, "{colon} {}{hint}", self.problem);
        text
    }
}

/// A file that is being read.
#[derive(Debug)]
pub struct InputFile {
    source: Source,
    /// Number of bytes that may still be read.
    left: u64,
    size_max: u64,
}

#[derive(Debug)]
enum Source {
    File(File),
    StandardInput(io::Stdin),
}

/// Opens a file that should be `noun`, such as "a CSV file", and no longer than `size_max` [bytes].
///
/// # Errors
/// A file that is missing, cannot be opened, is too long, or is neither a regular file nor standard input.
pub fn open(path: &Path, noun: &str, size_max: u64) -> Result<InputFile, Unopened> {
    let standard = STANDARD_INPUT.iter().any(|name| path == Path::new(name));
    let unopened = |error: io::Error| match error.kind() {
        ErrorKind::NotFound => Unopened {
            is_missing: true,
            problem: "no such file".into(),
        },
        _ => Unopened::because(format!("cannot be opened: {error}")),
    };
    let source = if standard {
        Source::StandardInput(io::stdin())
    } else {
        check_kind(&fs::metadata(path).map_err(unopened)?, noun, size_max)?;
        let file = File::open(path).map_err(unopened)?;
        check_kind(&file.metadata().map_err(unopened)?, noun, size_max)?;
        Source::File(file)
    };
    Ok(InputFile {
        source,
        left: size_max,
        size_max,
    })
}

fn check_kind(metadata: &fs::Metadata, noun: &str, size_max: u64) -> Result<(), Unopened> {
    if metadata.is_dir() {
        return Err(Unopened::because(format!("is a folder, not {noun}")));
    }
    if !metadata.is_file() {
        return Err(Unopened::because(format!(
            "is a device or a pipe, not {noun}: give a regular file or /dev/stdin"
        )));
    }
    match metadata.len() > size_max {
        true => Err(Unopened::because(format!("is {}", too_long(size_max)))),
        false => Ok(()),
    }
}

fn too_long(size_max: u64) -> String {
    format!("longer than {} MiB", size_max >> 20)
}

impl Read for InputFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = match &mut self.source {
            Source::File(file) => file.read(buffer)?,
            Source::StandardInput(input) => input.read(buffer)?,
        };
        self.left = self
            .left
            .checked_sub(count as u64)
            .ok_or_else(|| io::Error::other(too_long(self.size_max)))?;
        Ok(count)
    }
}

/// Reads the whole of a table, described by `noun`, that another file refers to.
///
/// # Errors
/// The name of the file and the reason.
pub(crate) fn read_table(path: &Path, noun: &str) -> Result<Vec<u8>, String> {
    let mut file = open(path, noun, SIZE_MAX).map_err(|unopened| unopened.at(path, RELATIVE))?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)
        .map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_too_long_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("long.csv");
        let size = (1 << 20) + 2;
        fs::write(&path, vec![b'x'; size]).unwrap();
        let problem = open(&path, "a CSV file", 1 << 20).unwrap_err();
        assert_eq!(problem.problem, "is longer than 1 MiB");
        assert_eq!(read_table(&path, "a table").unwrap().len(), size);
    }

    #[test]
    fn a_file_that_grows_beyond_its_limit_while_it_is_read_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grows");
        fs::write(&path, "a").unwrap();
        let mut file = open(&path, "a table", 1 << 20).unwrap();
        fs::write(&path, vec![b'\n'; (1 << 20) + 1]).unwrap();
        let problem = file.read_to_end(&mut Vec::new()).unwrap_err();
        assert_eq!(problem.to_string(), "longer than 1 MiB");
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_folders_are_refused_before_they_are_read() {
        let read = |path: &str| read_table(Path::new(path), "a table");
        let problem = read("/dev/zero").unwrap_err();
        assert!(problem.starts_with("/dev/zero is a device or a pipe, not a table"));
        assert_eq!(read("/").unwrap_err(), "/ is a folder, not a table");
        let problem = read("/nowhere").unwrap_err();
        assert_eq!(problem, format!("/nowhere: no such file{RELATIVE}"));
    }
}
