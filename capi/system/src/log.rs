//! Messages of a system, to the console and to a file.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use crate::failure::{Code, Failure, Outcome};

/// Level from which on nothing is written.
pub const NONE: i32 = 4096;
/// Level of errors.
pub const ERROR: i32 = 3;
/// Level of warnings.
pub const WARNING: i32 = 2;
/// Level of messages.
pub const MESSAGE: i32 = 1;

/// Receivers of messages, each with the least level that it takes.
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
    /// A log that writes to the console from a level on.
    pub fn from_level(console: i32) -> Log {
        Log {
            console,
            ..Log::default()
        }
    }

    /// Sets the least level of the console.
    pub fn set_console(&mut self, level: i32) {
        self.console = level;
    }

    /// Sets the least level of the file.
    pub fn set_file_level(&mut self, level: i32) {
        self.file_level = level;
    }

    /// Begins a file, in place of an older one.
    ///
    /// # Errors
    /// The operating system refuses.
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

    /// Writes a message of a level. A console or file that takes none is no failure of the call.
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
