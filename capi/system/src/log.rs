//! Messages of a system, to the console and to a file.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use crate::failure::{Code, Failure, Outcome};

/// Level that disables all messages.
pub const NONE: i32 = 4096;
/// Level of errors.
pub const ERROR: i32 = 3;
/// Level of warnings.
pub const WARNING: i32 = 2;
/// Level of messages.
pub const MESSAGE: i32 = 1;

/// Destinations of messages, each with the lowest level that it accepts.
#[derive(Debug)]
pub struct Log {
    console: i32,
    file: Option<File>,
    file_level: i32,
}

impl Default for Log {
    fn default() -> Self {
        Log {
            console: MESSAGE,
            file: None,
            file_level: MESSAGE,
        }
    }
}

impl Log {
    /// Returns a log that writes messages from a level on to the console.
    pub fn from_level(console: i32) -> Log {
        Log {
            console,
            ..Log::default()
        }
    }

    /// Sets the lowest level written to the console.
    pub fn set_console(&mut self, level: i32) {
        self.console = level;
    }

    /// Sets the lowest level written to the file.
    pub fn set_file_level(&mut self, level: i32) {
        self.file_level = level;
    }

    /// Creates a log file; an existing one is overwritten.
    ///
    /// # Errors
    /// The operating system refuses the file.
    pub fn set_file(&mut self, path: &Path) -> Outcome {
        let refuse = |error| {
            Failure::new(
                Code::InvalidOutputFile,
                format!("cannot write {}: {error}", path.display()),
            )
        };
        self.file = Some(File::create(path).map_err(refuse)?);
        Ok(())
    }

    /// Writes a message at a level. A failure to write to the console or file is ignored.
    pub fn write(&mut self, level: i32, message: &str) {
        let word = match level {
            ERROR.. => "error: ",
            WARNING => "warning: ",
            _ => "",
        };
        if level >= self.console {
            let _ = writeln!(std::io::stderr(), "moorline: {word}{message}");
        }
        if level >= self.file_level
            && let Some(file) = &mut self.file
        {
            let _ = writeln!(file, "{word}{message}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_takes_messages_from_its_level_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.txt");
        let mut log = Log::from_level(NONE);
        log.set_file(&path).unwrap();
        log.set_file_level(WARNING);
        log.write(MESSAGE, "small");
        log.write(WARNING, "notable");
        log.write(ERROR, "wrong");
        assert_eq!(
            std::fs::read_to_string(&path).unwrap(),
            "warning: notable\nerror: wrong\n"
        );
        assert_eq!(
            log.set_file(folder.path()).unwrap_err().code,
            Code::InvalidOutputFile
        );
    }
}
